"""The reduced potential of a motion, with its energy, its wells and the barrier ahead."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...orbit.phase_plane import PhasePlane, motion_curve, phase_plane, window
from .. import style
from ..units import SHORT, number
from . import subject as canvas
from . import subject as which
from .subject import measures, subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes

POINTS = 1200
ENERGY = style.MEANING["this motion"] | {"linestyle": "--", "linewidth": 1.2}


def potential(case: Any, state: Any = None, ax: Axes | None = None, units: str | None = None,
              size: tuple[float, float] | None = None, legend: bool = True) -> Axes:
    """Draw the reduced potential of a motion, and return the axes.

    case: a Case, or a scene with `state`. Across: the turn about the axis of the torque since the start; up:
    the potential less its value at the start, J (scaled: that of the reduced equation). Dashed: the energy
    of the motion; thick, where the motion is. Minima of the potential are centres, maxima saddles; an arrow
    leads from the energy to the barrier ahead, whose height above it is the margin of `fate`. Raises
    InputError where the motion does not reduce.
    """
    one = subject(case, state)
    which.check("potential", one)
    scale, plane = measures(one, units), phase_plane(one.twin, one.state)
    across, up = plane.unit * scale.angle[1], float(plane.reduction.energy_unit)
    low, high = window(plane)
    y, energy = np.linspace(low, high, POINTS), plane.W0**2 / 2
    with canvas.on(ax, size) as target:
        rows: list[tuple[str, dict[str, Any]]] = [("reduced potential", style.MEANING["separatrix"]),
                                                  ("energy of this motion", ENERGY)]
        target.plot(across * y, up * plane.height(y), **style.MEANING["separatrix"])
        target.axhline(up * energy, **ENERGY)
        ys, _ = motion_curve(plane, low, high)
        target.plot(across * ys[[0, -1]], [up * energy] * 2, **style.MEANING["this motion"])
        target.plot([0], [up * energy], zorder=5, **style.MARKER["start"])
        rows += [("where it is", style.MEANING["this motion"]), ("start", style.MARKER["start"])]
        for kind, name, places in (("centre", "well: centre (stable)", plane.centres),
                                   ("saddle", "barrier: saddle (unstable)", plane.saddles)):
            shown = np.array(plane.repeated(places, low, high))
            if len(shown):
                target.plot(across * shown, up * plane.height(shown), zorder=5, **style.MARKER[kind])
                rows.append((name, style.MARKER[kind]))
        _margin(target, one.motion, plane, (low, high), across, up, scale)
        target.set_xlim(*sorted((across * low, across * high)))
        i = plane.reduction.axis + 1
        target.set_xlabel(scale.label(rf"turn $\alpha_{i}$ about {one.axes.short(i)} from the start",
                                      scale.angle[0]))
        target.set_ylabel(scale.label("energy", "J" if scale.size else ""))
        canvas.title(target, one.heading, canvas.answer(one, scale))
        if legend:
            canvas.legend(target, rows, ax is None)
    return target


def _margin(ax: Any, motion: Any, plane: PhasePlane, span: tuple[float, float], across: float, up: float,
            scale: Any) -> None:
    """An arrow from the energy to the barrier that the margin is of, where that is in the picture."""
    margin, energy = motion.margin_energy, plane.W0**2 / 2
    saddles = plane.repeated(plane.saddles, *span)
    if not margin or not saddles:
        return
    above = {y: up * (float(plane.height(y)) - energy) for y in saddles}
    barrier = min(above, key=lambda y: (round(abs(above[y] / margin - 1), 6), abs(y)))
    if abs(above[barrier] - margin) > 1e-6 * abs(margin):
        return
    place = across * barrier
    ax.annotate("", (place, up * energy + margin), (place, up * energy),
                arrowprops={"arrowstyle": "<->", "color": style.VERMILION, "linewidth": 1.4})
    size = number(abs(margin), SHORT) + " J" * bool(scale.size)
    ax.annotate(f"margin {size}" if margin > 0 else f"{size} above the barrier",
                (place, up * energy + margin / 2), (6, 0), textcoords="offset points", va="center",
                color=style.VERMILION,
                bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0, "alpha": 0.8})
