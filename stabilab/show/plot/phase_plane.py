"""The phase plane of a motion that reduces to one degree of freedom."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...orbit.phase_plane import PhasePlane, motion_curve, phase_plane, window
from .. import style
from . import canvas, which
from .measures import measures
from .subject import subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def phase(case: Any, state: Any = None, ax: Axes | None = None, units: str | None = None, size: tuple[float, float] | None = None,
          legend: bool = True) -> Axes:
    """Draw the phase plane of a motion, and return the axes.

    case: a Case, or a scene with `state`. Across: the turn about the axis of the torque since the start; up: the rate about it. The reduced
    potential decides all lines: this motion, the separatrices through the saddles, and the motions of other energies at the same value of the
    invariant. units: "deg" or "si". Raises InputError where the motion has no such plane; it names the kinds of plot that there are.
    """
    one = subject(case, state)
    which.check("phase", one)
    scale, plane = measures(one, units), phase_plane(one.twin, one.state)
    i = plane.reduction.axis
    with canvas.on(ax, size) as target:
        factors = {"scale": plane.unit * scale.angle[1], "rate_scale": scale.rate[1]}
        small = _small(plane)
        draw(target, plane, start=not small, **factors)
        if small:
            _enlarged(target, plane, factors)
        target.set_xlabel(scale.label(rf"turn $\alpha_{i + 1}$ about {one.axes.short(i + 1)} from the start", scale.angle[0]))
        target.set_ylabel(scale.label(scale.names[i], scale.rate[0]))
        canvas.title(target, one.heading)
        if legend:
            present = {"separatrix": bool(plane.saddles), "saddle (unstable)": bool(plane.saddles), "centre (stable)": bool(plane.centres)}
            canvas.legend(target, [row for row in ROWS if present.get(row[0], True)], ax is None)
    return target


RESTING = 1e-4  # of the walls: a motion below it would be a line, and the grid may miss the bottom of its well
SMALL, AROUND = 0.07, 1.6  # of the picture's height: a motion below it is shown enlarged, in a window so much larger than itself
INSET = (0.34, 0.34)  # of the axes: width and height of that window
NUMBERS = (0.065, 0.06)  # of the axes: the room of its numbers, left and below
CLOSED = 1e-3  # of the largest W: more of it at its ends has a motion that leaves the picture; at a turning point rounding of the place leaves some 1e-6


def _small(plane) -> bool:
    """Whether a motion that turns back is too small to be seen beside its separatrix: the mark of its start would hide it."""
    span = window(plane)
    _, Ws = motion_curve(plane, *span)
    return 0 < Ws.max() < SMALL * highest(plane, *span) and bool(Ws[[0, -1]].max() <= CLOSED * Ws.max())


def _enlarged(ax, plane, factors):
    """A window with this motion alone and its start, on a ground of its own."""
    from matplotlib.patches import Rectangle
    ys, Ws = motion_curve(plane, *window(plane))
    right = plane.unit * (ys[0] + ys[-1]) < plane.unit * sum(window(plane))  # the emptier side
    (wide, tall), (left, below) = INSET, NUMBERS
    at = (0.64 if right else 0.01 + left, 0.62)
    ax.add_patch(Rectangle((at[0] - left, at[1] - below), wide + left + 0.01, tall + below + 0.02, transform=ax.transAxes,
                           facecolor="white", edgecolor=style.GREY, linewidth=0.8, zorder=4.5))
    inset = ax.inset_axes((*at, *INSET))
    middle, half = (ys[0] + ys[-1]) / 2, AROUND * (ys[-1] - ys[0]) / 2
    draw(inset, plane, span=(middle - half, middle + half), levels=14, top=AROUND * float(Ws.max()), **factors)
    inset.tick_params(labelsize=7)
    for label in (*inset.get_xticklabels(), *inset.get_yticklabels()):  # they stand on the lines of the picture
        label.set_bbox({"facecolor": "white", "edgecolor": "none", "pad": 0.8})
    inset.set_in_layout(False)  # it lies inside; the layout would keep room for it below
    ax.indicate_inset_zoom(inset, edgecolor=style.BLACK)


ROWS: list[tuple[str, dict]] = [
    ("this motion", style.MEANING["this motion"]), ("start", style.MARKER["start"]), ("separatrix", style.MEANING["separatrix"]),
    ("other energies", style.MEANING["level"]), ("centre (stable)", style.MARKER["centre"]), ("saddle (unstable)", style.MARKER["saddle"])]


def draw(ax, plane: PhasePlane, scale=1.0, offset=0.0, rate_scale=1.0, span=None, levels=22, motion=True, separatrices=True, start=True,
         top=None):
    """Draw level curves, separatrices, equilibria and the motion on `ax`; x axis: offset + scale*y. separatrices: False where the caller
    draws them himself, each in a look of its own. start: mark where the motion begins. top: the largest W, None for what is worth drawing."""
    low, high = span or window(plane)
    y = np.linspace(low, high, 700)
    heights, top = plane.height(y), highest(plane, low, high) if top is None else top
    W = np.linspace(-top, top, 500)
    energy = W[:, None] ** 2 / 2 + heights[None, :]
    limits = np.linspace(energy.min(), np.quantile(energy, 0.93), levels + 1)[1:]
    ax.contour(offset + scale * y, rate_scale * plane.rate(W), energy, levels=limits, colors=style.MEANING["level"]["color"],
               linewidths=0.5, linestyles="solid")
    for saddle in plane.repeated(plane.saddles, low, high) if separatrices else ():
        ys, Ws = plane.separatrix(saddle, low, high)
        for sign in (1.0, -1.0):
            ax.plot(offset + scale * ys, rate_scale * plane.rate(sign * Ws), **style.MEANING["separatrix"])
    if motion:
        ys, Ws = motion_curve(plane, low, high)
        for sign in ways(plane, Ws):
            ax.plot(offset + scale * ys, rate_scale * plane.rate(sign * Ws), **style.MEANING["this motion"])
        if start:
            ax.plot([offset], [rate_scale * plane.rate(plane.W0)], zorder=5, **style.MARKER["start"])
    for kind, places in (("centre", plane.centres), ("saddle", plane.saddles)):
        shown = np.array(plane.repeated(places, low, high))
        if len(shown):  # an empty line that is not clipped lies at the corner of the picture for a layout, which keeps room for it
            ax.plot(offset + scale * shown, rate_scale * plane.rate(np.zeros(shown.shape)), zorder=5, clip_on=False, **style.MARKER[kind])
    ax.set_xlim(*sorted((offset + scale * low, offset + scale * high)))
    ends = rate_scale * plane.rate(np.array([-top, top]))
    ax.set_ylim(min(ends), max(ends))


def highest(plane: PhasePlane, low: float, high: float) -> float:
    """The largest W worth drawing between two places: above this motion and all separatrices; about a motion that all but rests in a single well,
    a third of the way up its walls."""
    tops = [float(plane.height(s)) for s in plane.repeated(plane.saddles, low, high)]
    heights = plane.height(np.linspace(low, high, 700))
    lift, walls = max(plane.W0**2 / 2, *(tops or [0.0])) - float(np.min(heights)), float(np.ptp(heights))
    return float(np.sqrt(2 * (lift if lift > RESTING * walls else walls / 3)) * 1.12 + 1e-12)


def ways(plane: PhasePlane, W: np.ndarray) -> tuple[float, ...]:
    """Signs of the rate that a motion has: one where it goes right round without a torque and never turns."""
    return (float(np.sign(plane.W0)),) if plane.land.may_rotate and W.min() > 0 else (1, -1)
