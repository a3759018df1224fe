"""Rates and whole states over time."""
from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from ...answers.simulate import trajectory
from ...answers.uncertain.box import box_of
from ...theories.comparison import side_by_side
from .. import style
from ..text import comparison
from ..text.headline import headline
from . import subject as canvas
from . import subject as which
from .path import SEEN, SOLID, band, path, turning
from .subject import Subject, measures, subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes


# --- The rates of a motion over time: components and size, with limits, extremes and period marked
COMPONENTS = ({"color": style.BLUE, "linewidth": 1.3}, {"color": style.ORANGE, "linewidth": 1.3},
              {"color": style.GREEN, "linewidth": 1.3})
SIZE_LOOK = {"color": style.BLACK, "linewidth": 2.2}
EXTREME = {"linestyle": (0, (1, 2)), "linewidth": 1.1}
LIMIT = {"color": style.VERMILION, "linestyle": "--", "linewidth": 1.5}
REACHED = {"marker": "o", "color": style.VERMILION, "markersize": 6.5, "linestyle": "none"}
PERIOD = {"color": style.GREY, "linestyle": "-", "linewidth": 0.8}
ALIKE = 0.004  # of the height of all curves: no more than the width of a line
THIN = 0.02  # of the height of all curves: as high as a few lines
# dashes of a curve over one or two others: each leaves some of those below
BROKEN = ((0, (6, 6)), (0, (3, 9)))
FEW, EVEN = 4, 1001  # uncertain numbers of which all corners are followed; times of each of these motions
MARKED = 30  # ends of periods at most


def time(case: Any, state: Any = None, ax: Axes | None = None, span: Any = None, units: str | None = None,
         size: tuple[float, float] | None = None,
         legend: bool = True) -> Axes:
    """Draw the rates of a motion over time, and return the axes.

    case: a Case, or a scene with `state`, three rates (or a dict of blocks). The three components along the
    principal axes and |omega| in deg/s, over seconds, minutes or hours (units="si": rad/s and s; scaled
    scenes have x and tau), under the answer in one line where there is a case. Dotted: least and greatest
    value of each component over all time, where they are known. Grey: the ends of the periods. Dashed: the
    limits of the case, and a point where one is reached first. Of limits about axes of a file that are not
    the principal ones, the components along those axes are drawn instead. span: (from, to) or the end; None:
    the case's own, at most ten periods, and past the time at which a limit is reached.
    """
    one = subject(case, state, span)
    which.check("time", one)
    scale = measures(one, units)
    low, high = one.seen
    t, omega = path(one, low, high)
    turned = file_axes(one)
    omega = omega if turned is None else omega @ turned.T
    (time_unit, per_time), (rate_unit, per_rate) = scale.time(_measured(one, low, high)), scale.rate
    names = scale.names if turned is None else tuple(rf"$\omega_{axis}$" for axis in "xyz")
    with canvas.on(ax, size) as target:
        length = np.linalg.norm(omega, axis=1)
        height = (max(omega.max(), length.max()) - omega.min()) * per_rate
        looks = told_apart(COMPONENTS, list(omega.T))
        rows = list(zip(names, looks))
        rows.insert(0, (scale.size or "$|x|$", SIZE_LOOK))  # so wide that a component on it leaves its edges
        _curve(target, t * per_time, length * per_rate, SIZE_LOOK, height)
        for values, look in zip(omega.T, looks):
            _curve(target, t * per_time, values * per_rate, look, height)
        rows += _samples(target, one, t, per_time, per_rate, looks) if turned is None else []
        rows += _extremes(target, one, per_rate) if turned is None else []
        rows += _periods(target, one, low, high, per_time, scale)
        rows += _limits(target, one, t, omega, (time_unit, per_time), scale.rate)
        target.set_xlim(t[0] * per_time, t[-1] * per_time)
        target.margins(y=0.06)
        target.set_xlabel(scale.label("time", time_unit) if scale.size else time_unit)
        target.set_ylabel(scale.label("rate" + (", axes of the file" if turned is not None else ""),
                                      rate_unit) if scale.size else "$x$")
        canvas.title(target, one.heading, "" if one.case is None else _answer(one, scale))
        if legend:
            canvas.legend(target, rows, ax is None)
    return target


def _answer(one, scale):
    """The answer in one line; of uncertain numbers only their middles are drawn."""
    told = headline(one.case, one.motion, scale.system)
    return told + ("; for the middles of the uncertain numbers" if one.case.uncertain else "")


def _samples(ax, one, t, per_time, per_rate, looks):
    """Bands between the least and the greatest rates of motions at corners of the box of uncertain numbers,
    all where there are few."""
    if one.case is None or not one.case.uncertain or not one.scene.plain:
        return []
    box = box_of(one.case)
    if box.frame is not None:  # each corner has principal axes of its own
        return []
    corners = np.array(list(product((-1, 1), repeat=min(len(box.places), FEW))))
    if len(box.places) > FEW:
        corners = np.random.default_rng(0).choice((-1, 1), (len(corners), len(box.places)))
    times = np.linspace(t[0], t[-1], EVEN)
    runs = [np.asarray(trajectory(*box.at(corner.tolist()), times, laws=False).states) for corner in corners]
    runs = np.array([run for run in runs if len(run) == EVEN])
    if not len(runs):
        return []
    for values, look in zip((*np.moveaxis(runs, 2, 0), np.linalg.norm(runs, axis=2)), (*looks, SIZE_LOOK)):
        ax.fill_between(times * per_time, values.min(axis=0) * per_rate, values.max(axis=0) * per_rate,
                        color=look["color"], alpha=0.2, linewidth=0, zorder=1)
    return [(f"between {len(runs)} samples of the uncertain numbers",
             {"facecolor": style.GREY, "alpha": 0.35, "linewidth": 0})]


def told_apart(looks: Sequence[dict[str, Any]], curves: Sequence[np.ndarray]) -> list[dict[str, Any]]:
    """The looks of curves (n,) in the order in which they are drawn: one that lies on an earlier one is
    broken, so that both are seen."""
    near = ALIKE * (max(values.max() for values in curves) - min(values.min() for values in curves))
    told = []
    for n, (look, values) in enumerate(zip(looks, curves)):
        below = sum(bool(np.abs(values - earlier).max() <= near) for earlier in curves[:n])
        told.append(look | {"linestyle": BROKEN[below - 1]} if below else look)
    return told


def _curve(ax, t, values, look, height):
    """A rate over time; one that turns more often than a picture has columns as the band that it fills.
    height: of all curves."""
    if turning(values) <= SOLID:
        ax.plot(t, values, **look)
        return
    times, low, high = band(t, values)
    if (high - low).max() < height * THIN:  # a band that would be too narrow to be seen is the curve itself
        ax.plot(times, (low + high) / 2, **look)
    else:
        ax.fill_between(times, low, high, color=look["color"], alpha=0.45, linewidth=0.3)


def _extremes(ax, one, per_rate):
    """Dotted lines at the least and greatest value of each component; the row of the legend."""
    found = one.motion.extremes
    if found is None or one.motion.extremes_over != "all time":
        return []
    drawn = [(value, look) for pair, look in zip(found, COMPONENTS) for value in set(pair)
             if value is not None and math.isfinite(value)]
    for value, look in drawn:
        ax.axhline(value * per_rate, color=look["color"], zorder=1.5, **EXTREME)
    return [("extremes for ever", {"color": style.GREY, **EXTREME})] if drawn else []


def _marked(one, low, high) -> bool:
    """Whether the ends of the periods are drawn: there are some, and not so many that they would be a grey
    ground."""
    period = one.motion.period
    return bool(period) and period <= high - low <= MARKED * period


def _measured(one, low, high):
    """The time whose unit is that of the axis: of the period where its ends are marked, else of the picture.
    """
    return one.motion.period if _marked(one, low, high) else high - low


def _periods(ax, one, low, high, per_time, scale):
    period = one.motion.period
    if not period or high - low < period:
        return []
    unit, per = scale.time(period)
    words = f"period {period * per:.5g} {unit}"
    if not _marked(one, low, high):
        return [(words, {"linestyle": "none"})]
    for end in np.arange(math.ceil(low / period), math.floor(high / period) + 1) * period:
        ax.axvline(end * per_time, zorder=1, **PERIOD)
    return [(words, PERIOD)]


def file_axes(one: Subject):
    """Rows that turn rates to the axes of the file, where limits are about those and they are not the
    principal ones."""
    case = one.case
    stated = case is not None and case.limits is not None and case.limits.rate is None
    if not stated or case.frame is None or case.frame.as_given:
        return None
    return np.array([[float(v) for v in axis] for axis in case.frame.axes]).T


def _limits(ax, one, t, omega, time_unit, rate_unit):
    """Dashed lines at the limits, a point where one is reached first; the rows of the legend."""
    if one.motion.first is None:
        return []
    _, reached = one.motion.first
    (second, per_time), (name, per_rate) = time_unit, rate_unit
    rate, rates = one.case.limits.rate, [float(v) for v in one.case.limits.rates or ()]
    same = len(set(rates)) == 1
    if rate is not None:
        ax.axhline(float(rate) * per_rate, **LIMIT)
    for most, look in zip(rates, COMPONENTS):
        for sign in (1, -1):
            ax.axhline(sign * most * per_rate, **LIMIT | ({} if same else {"color": look["color"]}))
    of, most = ("|ω|", float(rate)) if rate is not None else ("each", rates[0])
    rows = [(f"limit of {of}, {most * per_rate:.4g} {name}" if rate is not None or same else "limits", LIMIT)]
    when = float(reached.low + reached.high) / 2
    if not t[0] <= when <= t[-1]:
        return rows
    values = np.array([np.interp(when, t, column) for column in omega.T])
    at = np.linalg.norm(values) if rate is not None else values[np.argmax(np.abs(values) / np.array(rates))]
    ax.plot([when * per_time], [at * per_rate], zorder=5, **REACHED)
    return [*rows, (f"reached after {when * per_time:.4g} {second}", REACHED)]


# --- Every part of a longer state over time, the analytic models beside the exact motion
POINTS = 801
CROWDED = 24  # turns of a rate: more of them are shown over the first so many, unless a span is asked for


def state(case: Any, start: Any = None, span: Any = None, size: tuple[float, float] | None = None,
          units: str | None = None) -> Any:
    """Draw every part of the state over time, a row a part and a column a component, and return the figure:
    rates, direction of the vertical, attitude, momentum, velocity, place, as far as the scene has them; the
    analytic models that apply are beside the exact motion. Of a case whose rates turn very often over its
    span the first turns are shown. size: (width, height) in inches; None: as many as the rows need. units:
    "deg" or "si", None for those of the case."""
    import matplotlib
    from matplotlib import pyplot as plt
    one = subject(case, start, span)
    which.check("state", one)
    scale = measures(one, units)
    begin, end = one.asked or (one.seen[0], max(*one.seen, *(one.span or ())))  # slow parts need all
    runs, _ = side_by_side(one, np.linspace(begin, end, POINTS))
    if span is None and (turns := _turns(runs["exact"].state["omega"])) > CROWDED:
        runs, _ = side_by_side(one, np.linspace(begin, begin + (end - begin) * CROWDED / turns, POINTS))
    parts = [name for name in comparison.NAMES if name in runs["exact"].state]
    law = runs["exact"].validity
    with matplotlib.rc_context(style.RC | style.letters(size)):
        figure = comparison.picture(plt, one, runs, parts, size, scale.system)
        if law is not None and not law.held:
            figure.suptitle(style.literal(f"{one.heading}\n{law.short}"), fontsize=10 * style.share(),
                            wrap=True)
    return figure


def _turns(rates: Any) -> int:
    """How often the rate turns that turns most; of one that all but stays the rounding is not counted."""
    still = SEEN * np.abs(rates).max()
    return max((turning(row) for row in np.asarray(rates).T if np.ptp(row) > still), default=0)
