"""The reduced potential of a motion, with its energy, its wells and the barrier ahead."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...orbit.phase_plane import PhasePlane, motion_curve, phase_plane, window
from .. import style
from ..units import SHORT, number, with_unit
from . import canvas
from . import subject as which
from .subject import measures, subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes

POINTS = 1200
ROOM = 0.6     # of the canonical angle, beyond a barrier that would stand outside
CLOSE = 1e-6   # relative: by this a barrier is known by its margin
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
    margin, energy = one.motion.margin_energy, plane.W0**2 / 2
    barrier = _barrier(plane, margin, up, (low, high))
    if barrier is not None:  # it may stand a turn ahead
        low, high = min(low, barrier - ROOM), max(high, barrier + ROOM)
    y = np.linspace(low, high, POINTS)
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
        if barrier is not None:
            _margin(target, margin, across * barrier, up * energy, " J" * bool(scale.size))
        target.set_xlim(*sorted((across * low, across * high)))
        i = plane.reduction.axis + 1
        target.set_xlabel(with_unit(rf"turn $\alpha_{i}$ about {one.axes.short(i)} from the start",
                                    scale.angle[0]))
        target.set_ylabel(with_unit("energy", "J" if scale.size else ""))
        return canvas.explained(target, rows if legend else [], ax is None,
                                one.heading, canvas.answer(one, scale))


def _barrier(plane: PhasePlane, margin: float | None, up: float, span: tuple[float, float]) -> float | None:
    """Where the barrier stands that a margin in energy is of, up to a turn outside of the span; None where
    there is none, or where the margin is of other motions (of a free body: with the same |H|)."""
    turn = plane.land.turn if np.isfinite(plane.land.turn) else 0.0
    above = {y: up * (float(plane.height(y)) - plane.W0**2 / 2)
             for y in plane.repeated(plane.saddles, span[0] - turn, span[1] + turn)} if margin else {}
    return min((y for y in above if abs(above[y] - margin) <= CLOSE * abs(margin)), key=abs, default=None)


def _margin(ax: Any, margin: float, place: float, energy: float, unit: str) -> None:
    """An arrow from the energy to the barrier."""
    ax.annotate("", (place, energy + margin), (place, energy),
                arrowprops={"arrowstyle": "<->", "color": style.VERMILION, "linewidth": 1.4})
    size = number(abs(margin), SHORT) + unit
    ax.annotate(f"margin in energy {size}" if margin > 0 else f"{size} above the barrier",
                (place, energy + margin / 2), (6, 0), textcoords="offset points", va="center",
                color=style.VERMILION,
                bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0, "alpha": 0.8})
