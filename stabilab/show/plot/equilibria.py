"""All equilibria of a scene in the space of rates."""
from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...answers.equilibria import equilibria as all_of
from ...answers.equilibria import once_stopped
from ...equilibrium.result import Equilibria
from ...errors import InputError
from .. import style
from ..space.box import Box
from ..space.drawing import Space, look, marks_of
from ..space.drawing import space as drawn_in
from ..space.reach import curves_of, spread
from ..units import number as in_digits
from . import canvas, in_space
from . import subject as subjects
from .in_space import EQUILIBRIUM_LOOKS, disc, holds, marker, plane_of
from .subject import Subject, measures, subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes


# places on a piece of a curve, to find what is in the box and to draw it: of a formula, or by a search each
MANY, FEW = (90, 600), (40, 90)
FLAT = 1e-9  # of the picture: equilibria nearer than this to a plane across an axis are drawn in it
BEYOND = 2.4  # times the farthest fold, or the nearest point of a curve without one: how far a curve is shown
TICKS = 5  # across, at most and one: a square in a broad figure has no room for more long numbers
FOLD: dict[str, Any] = style.MARKER["degenerate"]


def equilibria(case: Any, state: Any = None, ax: Axes | None = None, units: str | None = None,
               size: tuple[float, float] | None = None,
               legend: bool = True) -> Axes:
    """Draw all equilibria of a scene, and return the axes.

    Stable ones are full lines and dots, unstable ones dashed lines and circles, undecided ones dotted lines
    and diamonds; open diamonds mark where a curve changes its stability. Where all lie in a plane across an
    axis (a torque on an axis) that plane is drawn, else the space of rates; axes that are given decide it
    themselves. A state, given or of the case, is marked. Of scenes with a direction of space (top) the rates
    of the permanent rotations are drawn; of a satellite on a circular orbit the body at each attitude at rest
    (`orbital.attitudes`). Raises InputError where there is none.
    """
    item = subject(case, state)
    if (own := subjects.elsewhere("equilibria", item)) is not None:
        return own(item, ax, units, size, legend)
    result = all_of(item.case or item.scene)
    if not result.points and not result.curves:
        raise InputError(f"plot equilibria: there is nothing to draw: {result.reason}")
    scale, per = measures(item, units), measures(item, units).rate[1]
    planes = [curve for curve in result.curves if curve.plane]
    bent = replace(result, curves=tuple(curve for curve in result.curves if curve not in planes))
    folds = np.array([fold[:3] for curve in bent.curves for fold in curve.folds], float).reshape(-1, 3)
    number = MANY if item.twin.plain else FEW
    box = _box(result, folds, item, number[0])
    drawn = drawn_in(scale.names, scale.rate, box, (), [], marks_of(item.state, None, result),
                     curves_of(bent, box, *number), "")
    spatial = planes or getattr(ax, "name", "") == "3d"
    flat = None if spatial else _flat_axis(drawn, result)
    rows = {phrase: look(phrase) for phrase, _ in drawn.curves}
    with canvas.on(ax, size, space=flat is None) as target:
        for plane in planes:
            kinds = [style.kind_of(segment) for segment in plane.segments]
            kind = max(kinds, key=kinds.count)
            colour = str(style.MEANING[kind]["color"])
            in_space.polygon(target, disc(plane_of(plane), box.half[0] * per), colour, 0.3)
            rows[f"plane of {style.EQUILIBRIA[kind]}"] = {"facecolor": colour, "alpha": 0.35}
        if flat is None:
            for axis in np.eye(3):
                in_space.line(target, np.outer((-1, 1), axis) * box.half[0] * per, in_space.THIN)
            in_space.draw(target, drawn)
            in_space.line(target, folds[holds(box, folds)] * per, FOLD, zorder=9)
        else:
            _in_plane(target, drawn, folds, flat)
        rows |= {f"{kind} equilibrium": EQUILIBRIUM_LOOKS[kind] for kind in map(style.kind_of, result.points)}
        rows |= {"change of stability": FOLD} if len(folds) else {}
        if item.state is not None:
            rows["start of the motion" if flat is None
                 else "start of the motion, seen along the axis"] = style.MARKER["start"]
        constant = ("" if flat is None else f"all have {scale.plain(flat)} = "
                 f"{in_digits(drawn.curves[0][1][0][flat] * per)} {scale.rate[0]}".rstrip())
        stopped = once_stopped(result)
        text = "; ".join(filter(None, (constant, stopped and stopped.text(letters=True))))
        return canvas.explained(target, list(rows.items()) if legend else [], ax is None, item.heading, text,
                                notes=canvas.notes(item, scale, answered=False))


def _box(result: Equilibria, folds: np.ndarray, item: Subject, number: int) -> Box:
    """What to show: all points and folds, the start, and of curves as much again."""
    marks = [at for _, at in marks_of(item.state, None, result)] + folds.tolist()
    bent = [curve for curve in result.curves if not curve.plane]
    ends = [abs(t) for curve in bent for segment in curve.segments for t in segment.t if math.isfinite(t)]
    unit = max((*(abs(v) for at in marks for v in at), *ends), default=0.0) or 1.0
    nearby = [min(size for t in spread(*segment.t, number, unit)
                  if math.isfinite(size := math.hypot(*curve.point(t)[:3])))
              for curve in bent for segment in curve.segments]
    size = max([*(abs(v) for at in marks for v in at), *nearby], default=0.0) or 1.0
    return Box((0.0,) * 3, (size * (BEYOND if result.curves else 1.1),) * 3)


def _flat_axis(drawn: Space, result: Equilibria) -> int | None:
    """The axis across which all equilibria lie in one plane; None where they do not, or lie on one line."""
    places = np.array([*(at for _, curve in drawn.curves for at in curve if drawn.box.holds(at)),
                       *(point.at[:3] for point in result.points)], float)
    if len(places) < 3:
        return None
    flat = [axis for axis in range(3) if np.ptp(places[:, axis]) < FLAT * drawn.box.half[0]]
    return flat[0] if len(flat) == 1 else None


def _in_plane(ax: Axes, drawn: Space, folds: np.ndarray, flat: int) -> None:
    first, second = (n for n in range(3) if n != flat)
    per, box = drawn.rate, drawn.box.scaled(drawn.rate)
    for text, places in drawn.curves:
        ax.plot(*(per * np.array(places))[:, [first, second]].T, **look(text))
    for text, at in drawn.marks:
        ax.plot(per * at[first], per * at[second], zorder=5, **marker(text))
    ax.plot(folds[:, first] * per, folds[:, second] * per, zorder=5, **FOLD)
    ax.axhline(0, color=style.GREY, linewidth=0.6, zorder=1)
    ax.axvline(0, color=style.GREY, linewidth=0.6, zorder=1)
    ax.set(xlabel=drawn.names[first], ylabel=drawn.names[second],
           xlim=(box.low[first], box.high[first]), ylim=(box.low[second], box.high[second]))
    ax.set_aspect("equal", adjustable="box")
    ax.locator_params(axis="x", nbins=TICKS)
