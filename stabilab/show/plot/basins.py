"""Basins as a picture: a colour for each, and the boundary, drawn from the exact separatrix where there is
one."""
from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import InputError, told
from ...maps.basins import BOUNDED, NO_AXIS, UNDECIDED, Basins
from ...packages import demand
from .. import limiting, style
from ..axes import axes_of
from ..maps.basins import basin_name, cells_of
from ..maps.shades import drawn, hatched, limits_of, look_of, mark_own, own_value, said, spinning
from ..units import units_of
from . import canvas

if TYPE_CHECKING:
    from matplotlib.axes import Axes

AREAS = {BOUNDED: style.FILL["bounded"], UNDECIDED: style.FILL["undecided"],
         NO_AXIS: spinning(0)}
SPUN = (1, 2, 3, -1, -2, -3)  # labels: the axis with its sense
AREAS |= {axis: spinning(axis) for axis in SPUN}
FINE = 150  # points across the map of hatches, or up to twice as many


def basin(found: Basins, ax: Axes | None = None, size: tuple[float, float] | None = None,
          legend: bool = True) -> Axes:
    """Draw basins onto Matplotlib axes, or a figure of its own, and return the axes: a colour for each basin,
    the case's own state, and the boundary. The boundary is a line where the scene reduces (found by halving
    between states of different fate), else the finest cells are black. Raises InputError for anything but
    basins: a case has as many as there are planes through its rates."""
    if not isinstance(found, Basins):
        raise InputError(f"plot.basin: expected the basins of a plane, got {told(found)}: "
                         'found = stabilab.basin(case, {"angular_velocity[1]": "-60:60 deg/s", '
                         '"angular_velocity[3]": "-60:60 deg/s"}), then stabilab.plot.basin(found)')
    demand(*style.PACKAGES)
    with canvas.on(ax, size or canvas.SQUARE) as target:
        rows = _areas(target, found) + _line(target, found)
        target.grid(False)
        for setter, axis, name in zip((target.set_xlabel, target.set_ylabel), found.plan.axes,
                                      said([axis.key.name for axis in found.plan.axes])):
            setter(drawn(name) + ("" if axis.shown_unit == "1" else f" ({axis.shown_unit})"))
        for setter, axis, (_, text) in zip((target.set_xscale, target.set_yscale), found.plan.axes,
                                           found.plan.vary):
            setter("log" if text.count(":") == 3 and axis.values[0] > 0 else "linear")
        rows += mark_own(target, [own_value(found.plan, n) for n in range(2)]).items()
        rough = found.dimension
        edge = ("" if math.isnan(rough.value)
                else f"boundary: box dimension {rough.value:.3f} ± {rough.uncertainty:.3f}")
        return canvas.explained(target, rows if legend else [], ax is None,
                                found.plan.case.title or found.plan.case.name, edge,
                                notes=limiting.notes(limits_of(found.plan.case, found.records), edge,
                                                     units_of(found.plan.case)))


def write(result: Basins, out: str | Path, size: tuple[float, float] | None = None,
          dpi: float | None = None) -> Path:
    """Draw basins and write the picture, whole or not at all; the same basins give the same bytes."""
    return style.write(out, lambda plt: basin(result, size=size).figure, dpi)


def _areas(ax: Axes, result: Basins) -> list[tuple[str, dict[str, Any]]]:
    """The cells in the colours of their lower corners, and what these mean."""
    from matplotlib.collections import PolyCollection
    cells = cells_of(result)
    (left, right), (below, above) = (
        (np.array(axis.values)[cells[name]], np.array(axis.values)[cells[name] + cells["width"]])
        for axis, name in zip(result.plan.axes, ("first", "second")))
    corners = np.array([[left, below], [right, below], [right, above], [left, above]])
    labels = np.array(list(result.shares))
    order = np.argsort(labels)
    colours = np.array([AREAS[label] for label in labels[order].tolist()])
    shown = colours[np.searchsorted(labels[order], cells["label"])]
    black = not result.exact and len(result.boundary)
    if black:
        number = result.mesh.number(result.mesh.depth, cells["first"], cells["second"])
        shown[(cells["width"] == 1) & np.isin(number, result.boundary)] = 0.0
    ax.add_collection(PolyCollection(list(np.moveaxis(corners, 2, 0)), facecolors=shown, edgecolors="none",
                                     antialiaseds=False, rasterized=True))
    ax.set(xlim=(corners[:, 0].min(), corners[:, 0].max()), ylim=(corners[:, 1].min(), corners[:, 1].max()))
    _hatches(ax, result, cells)
    rows = [(basin_name(result, label), look_of(label if label in SPUN else 0) if label in (*SPUN, NO_AXIS)
             else {"facecolor": AREAS[label], "edgecolor": style.GREY}) for label in result.shares]
    return (rows + ([("finest cells on the boundary", {"facecolor": "black", "edgecolor": "black"})] if black
                    else []))


def _hatches(ax: Axes, result: Basins, cells: Mapping[str, np.ndarray]) -> None:
    """The hatch and the letter of the axis about which each basin of spin-up turns."""
    across, up = (np.array(axis.values) for axis in result.plan.axes)
    step = max(1, max(len(across), len(up)) // FINE)
    labels = np.full((len(up), len(across)), UNDECIDED)
    for first, second, width, label in zip(*(cells[name].tolist()
                                             for name in ("first", "second", "width", "label"))):
        labels[second:second + width + 1, first:first + width + 1] = label
    axes = axes_of(result.plan.case)
    letters = {label: axes.signed(abs(label), label).partition(" ")[0].replace("-", "\u2212")
               for label in SPUN}
    hatched(ax, across[::step], up[::step], labels[::step, ::step],
            {label: (style.HATCH[abs(label)], letters[label]) for label in SPUN}
            | {NO_AXIS: (style.HATCH[0], "")})


def _line(ax: Axes, result: Basins) -> list[tuple[str, dict[str, Any]]]:
    from matplotlib.collections import LineCollection
    pieces = result.separatrix()
    if not len(pieces):
        return []
    look: dict[str, Any] = style.MEANING["separatrix"] | {"linewidth": 1.2}
    ax.add_collection(LineCollection(list(pieces), color=look["color"], linewidth=look["linewidth"],
                                     capstyle="round"))
    return [("separatrix (exact)", look)]
