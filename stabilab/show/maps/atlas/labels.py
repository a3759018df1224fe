"""How directions, axes and fates of an atlas are named, and the colour of each fate."""
from __future__ import annotations

from typing import Any

import numpy as np

from ....maps.atlas.pointed import AXES, OWN, Point
from ....maps.atlas.run import Atlas
from ....orbit.result import Fate
from ... import style
from ...axes import axes_of
from ..shades import FATES, light

# (axis, sense) of a spin-up -> its colour: a hue for each axis, the lighter one against it
SPINS = {(1, 1): light(style.BLUE, 0.95), (1, -1): light(style.BLUE, 0.5), (2, 1): light(style.GREEN, 0.95), (2, -1): light(style.GREEN, 0.45),
         (3, 1): light(style.VERMILION, 0.95), (3, -1): light(style.VERMILION, 0.5), (0, 0): light(style.PURPLE, 0.9)}
ISLANDS = {1: light(style.GREY, 0.75), 2: light(style.BLACK, 0.8)}  # of undecided cells: where one may exist, where one is seen
DOES = {Fate.BOUNDED: "stay bounded", Fate.SEPARATRIX: "lie on the separatrix", Fate.EQUILIBRIUM: "keep a steady rotation", Fate.UNDECIDED: "are undecided"}


def other_axis(atlas: Atlas) -> str:
    """About what a motion spins up that does so about no principal axis: of a sphere every axis is one, and the wheel or the torque chooses."""
    if len(set(atlas.asked.case.scene.body.exact)) > 1:  # type: ignore[union-attr]
        return "no principal axis"
    wheels = {any(wheel) for wheel in atlas.asked.wheels}
    return "the wheel's axis" if wheels == {True} else "the torque's axis" if wheels == {False} else "the axis of the wheel, or of the torque"


def point_name(atlas: Atlas, point: Point) -> str:
    """"+z" and "-z" for the axes (of a full tensor "+minor" and "-minor"), a thruster's name, "torque of the case"."""
    if point.level == AXES:
        return axes_of(atlas.asked.case).signed(point.number // 2 + 1, -1 if point.number % 2 else 1)
    return "torque of the case" if point.level == OWN else atlas.asked.case.thrusters[point.number].name


def shown_name(atlas: Atlas, point: Point) -> str:
    """The name of a direction for a picture: that of an axis has the minus of a book."""
    name = point_name(atlas, point)
    return name.replace("-", "−") if point.level == AXES else name


def kind_words(atlas: Atlas, fate: int, axis: int, island: int = 0) -> str:
    """What a cell does, for a legend: "spins up about −z (minor)"."""
    if fate == Fate.SPIN_UP:
        if not axis:
            return f"spins up about {other_axis(atlas)}"
        axes, sign = axes_of(atlas.asked.case), "−" if axis < 0 else "+"
        return f"spins up about {sign}{axes.name(abs(axis))}"
    return FATES[Fate(fate)][0] + ("", ", an island may exist", ", an island is seen")[island]


def kind_colour(fate: int, axis: int, island: int = 0) -> Any:
    """Red, green and blue, 0 to 1."""
    if fate == Fate.SPIN_UP:
        return SPINS[(abs(axis), int(np.sign(axis)))]
    return ISLANDS.get(island) or light(FATES[Fate(fate)][1], 0.8)


def kinds(atlas: Atlas, rows: np.ndarray | None = None) -> list[tuple[tuple[int, int, int], np.ndarray, float]]:
    """((fate, axis with its sense, island), rows of cells, share of the sphere and of the wheels) of all that occurs, the most first."""
    chosen = np.arange(len(atlas.records)) if rows is None else rows
    records = atlas.records[chosen]
    seen = np.where(records["fate"] == Fate.UNDECIDED, records["island"], 0)
    keys = np.stack([records["fate"].astype(int), records["spin_axis"].astype(int), seen], axis=1)
    found, which = np.unique(keys, axis=0, return_inverse=True)
    which = which.ravel()
    whole = atlas.share[chosen].sum()
    told = [((int(key[0]), int(key[1]), int(key[2])), chosen[which == n], float(atlas.share[chosen][which == n].sum() / whole))
            for n, key in enumerate(found)]
    return sorted(told, key=lambda one: (-one[2], one[0]))


def wheel_words(atlas: Atlas, number: int) -> str:
    """A wheel's momentum as it was asked: "0.5 N m s"."""
    return f"{atlas.asked.momenta[number]:.6g} {atlas.asked.unit}"


def direction_words(vector: Any) -> str:
    """Three digits of a direction."""
    return "(" + ", ".join(f"{v + 0.0:.3g}" if abs(v) >= 5e-4 else "0" for v in np.asarray(vector).tolist()) + ")"
