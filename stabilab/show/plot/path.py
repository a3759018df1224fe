"""The motion that a picture follows, and what pictures cost."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...answers.digits_run import best_reached
from ...answers.simulate import simulated, trajectory
from ...cost.accuracy import Precision, precision
from ...errors import InputError
from .. import style
from ..precision import meanings, panel, picture
from . import canvas
from . import subject as subjects
from .subject import Subject, subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ...physics.scene import AnyScene


# --- The rates of a motion at times close enough to be drawn as a line
FINE, FEWER = 20_001, 2001  # times of a line; those where each costs many digits
SEEN = 1e-3  # of the largest rate: what an eye tells apart
# last places by which a start is moved: it leaves every plane through two of its components
APART = (1, 2, 3)
# of a run in doubles' place, where these are lost; more than one of them is needed for a line
LOST_DIGITS = 4
BINS, SOLID = 700, 500  # a curve with more turning points than this is drawn as a band of so many pieces


def path(item: Subject, start: float, end: float) -> tuple[np.ndarray, np.ndarray]:
    """(times (n,), rates (n, 3)) of the motion from `start` to `end`, not to be changed: the pictures of an
    item share them; fewer where the run stops. InputError where it does not begin."""
    if (start, end) not in item.paths:
        t, states = along(item, np.linspace(start, end, FINE), np.linspace(start, end, FEWER))
        if len(t) < 2:
            raise InputError("plot: the motion cannot be followed: the run stopped at its start")
        for values in (t, states):
            values.flags.writeable = False
        item.paths[start, end] = t, states
    return item.paths[start, end]


def along(item: Subject, times: np.ndarray,
          fewer: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
    """(times (n,), rates (n, 3)) of the motion at the times, or as many as a run reaches. fewer: times enough
    for a line where doubles are not and each time costs many digits."""
    scene, start = (item.twin, item.state) if item.twin.plain else (item.scene, item.start)
    if not scene.plain:
        result = simulated(item.scene, item.state, times, item.blocks)
        return np.asarray(result.t), np.asarray(result.state["omega"])
    t, states = _run(scene, start, times)
    if _sure(scene, start, t, states):
        return t, states
    exact = _in_digits(replace(item, scene=scene, blocks={}), times if fewer is None else fewer)
    return exact or (t, states)


def _run(scene: AnyScene, start: np.ndarray | Sequence[float], times: np.ndarray):
    run = trajectory(scene, start, times, laws=False)
    return np.asarray(run.t), np.asarray(run.states)


def _sure(scene: AnyScene, start: Sequence[float], t: np.ndarray, states: np.ndarray) -> bool:
    """Whether a start moved in its last places leaves the line where it is: on an unstable plane rounding
    throws a run in doubles off."""
    later, moved = _run(scene, np.asarray(start, float) + APART * np.spacing(start), t)
    return (len(later) == len(t)
            and bool((np.abs(moved - states) <= SEEN * np.abs(states).max(initial=0.0)).all()))


def _in_digits(item, times):
    """(times, rates) by the cheapest way that is sure of them; None where none is known."""
    result = best_reached(item, times, LOST_DIGITS)
    if result.run.status != "reached" or result.digits <= 1:
        return None
    return result.run.t, result.run.state["x" if item.scene.variables == "scaled" else "omega"]


def turning(values: np.ndarray) -> int:
    """How often a curve turns."""
    steps = np.sign(np.diff(values))
    steps = steps[steps != 0]
    return int((steps[1:] != steps[:-1]).sum())


def band(t: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(times, least, greatest) in pieces of the curve, for one that turns more often than a picture has
    columns."""
    edges = np.linspace(t[0], t[-1], BINS + 1)
    first = np.clip(np.searchsorted(t, edges[:-1]), 0, len(t) - 1)
    smallest, largest = np.minimum.reduceat(values, first), np.maximum.reduceat(values, first)
    return 0.5 * (edges[:-1] + edges[1:]), smallest, largest


def thinned(points: np.ndarray, nearby: float) -> np.ndarray:
    """Of the points (n, d) of a line those without which it would be farther than `nearby` from some: of each
    stretch the farthest, until all are near."""
    retained = np.zeros(len(points), bool)
    retained[[0, -1]] = True
    stretches = [(0, len(points) - 1)]
    while stretches:
        low, high = stretches.pop()
        if high - low < 2:
            continue
        along, off = points[high] - points[low], points[low + 1:high] - points[low]
        fraction = np.clip(off @ along / max(float(along @ along), np.finfo(float).tiny), 0.0, 1.0)
        apart = np.linalg.norm(off - fraction[:, None] * along, axis=1)
        far = int(apart.argmax())
        if apart[far] > nearby:
            retained[low + 1 + far] = True
            stretches += [(low, low + 1 + far), (low + 1 + far, high)]
    return points[retained]


# --- What accuracy costs in time for one motion
EFFORTS = ("full", "quick", "brief", "glance")
SIZE = (7.6, 6.2)


def budget(case: Any, state: Any = None, ax: Axes | None = None, span: Any = None, question: str = "span",
           effort: str = "quick",
           size: tuple[float, float] | None = None, legend: bool = True) -> Axes:
    """Measure what the digits of a motion cost, draw time against error, and return the axes.

    A line a method; the grey band is the front: no method is both faster and more accurate. question: "span"
    (states along the span), "end" (the state at its end), "period" or "extremes", where the motion has them.
    effort: "full" (a minute), "quick", "brief" or "glance" (a second). The times are measured, so two runs
    differ; everything else in the picture does not.
    """
    out = measured(case, state, span, effort)
    if question not in out.questions:
        raise InputError(
            f"question: expected one of {', '.join(out.questions) or 'none: ' + out.reference.because}, "
            f"got {question!r:.40}")
    with canvas.on(ax, size or SIZE) as target:
        panel(target, out, question)
        if legend:
            canvas.legend(target, meanings(out, (question,)), ax is None)
    return target


def measured(case: Any, state: Any = None, span: Any = None, effort: str = "quick") -> Precision:
    """The measurement that a plot shows."""
    item = subject(case, state, span)
    subjects.check("budget", item)
    if effort not in EFFORTS:
        raise InputError(f"effort: expected one of {', '.join(EFFORTS)}, got {effort!r:.40}")
    return precision(item, effort)


def whole(case: Any, units: str | None = None, size: tuple[float, float] | None = None) -> list[Any]:
    """The figure with a panel for every question that the motion has, or for as many as a figure of this size
    has room for. units: of no use here."""
    import matplotlib
    from matplotlib import pyplot as plt
    with matplotlib.rc_context(style.RC | style.letters(size)):
        return [picture(plt, measured(case), size)]
