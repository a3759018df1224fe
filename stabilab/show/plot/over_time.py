"""Rates and whole states over time, and the time to a limit against what changes it.

Rates are also those after thrusters that are stuck. What changes the time is the tilt of the torque, or the
momentum of a wheel."""
from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...answers.caveats import STEADY
from ...answers.simulate import trajectory
from ...answers.stuck.fate import NEVER_AFTER, scenario_of, times_over
from ...answers.tilt import SIDES, by_angle
from ...answers.uncertain.boxes import box_of
from ...answers.when import limit_of
from ...errors import InputError, Kind
from ...numbers.principal import without_trace
from ...reasons import broad
from ...theories.theory import side_by_side
from .. import style
from ..assumed import Assumed
from ..space.span import limit_time
from ..text import cost
from ..text.stuck import answer_line, row_name
from ..units import SHORT, Units, bracket, number, with_unit
from . import canvas
from . import subject as subjects
from .path import SOLID, band, path, turning
from .subject import Measures, Subject, measures, subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ...answers.stuck.margins import Stuck
    from ...case.given import Given
    from ...case.read import Case

# --- The rates of a motion over time: components and size, with limits, extremes and period marked
COMPONENTS = tuple({"color": colour, "linewidth": 1.3} for colour in style.AXES)
SIZE_LOOK = {"color": style.BLACK, "linewidth": 2.2}
EXTREME = {"linestyle": (0, (1, 2)), "linewidth": 1.1}
LIMIT: dict[str, Any] = {"color": style.VERMILION, "linestyle": "--", "linewidth": 1.5}
SUPPOSED = LIMIT | {"linestyle": (0, (2, 3))}  # of a case that states none
REACHED = {"marker": "o", "color": style.VERMILION, "markersize": 6.5, "linestyle": "none"}
BETWEEN = {"facecolor": style.VERMILION, "alpha": 0.18, "linewidth": 0}  # the ends of its time are far apart
PERIOD = {"color": style.GREY, "linestyle": "-", "linewidth": 0.8}
ALIKE = 0.004  # of the height of all curves: no more than the width of a line
THIN = 0.02  # of the height of all curves: as high as a few lines
# dashes of a curve over one or two others: each leaves some of those below
BROKEN = ((0, (6, 6)), (0, (3, 9)))
FEW, EVEN = 4, 1001  # uncertain numbers of which all corners are followed; times of each of these motions
IN_FILE = tuple(rf"$\omega_{axis}$" for axis in "xyz")
MARKED = 30  # ends of periods at most


def time(case: Any, state: Any = None, ax: Axes | None = None, span: Any = None, units: str | None = None,
         size: tuple[float, float] | None = None,
         legend: bool = True) -> Axes:
    """Draw the rates of a motion over time, and return the axes.

    case: a Case, or a scene with `state`, three rates (or a dict of blocks). The three components along the
    principal axes and |omega| in deg/s, over seconds, minutes or hours (units="si": rad/s and s; scaled
    scenes have x and tau), under the answer in one line where there is a case. Dotted: least and greatest
    value of each component over all time, where they are known. Grey: the ends of the periods. Dashed: the
    limits of the case, and a point where one is reached first. Of a burn: across the switches of its
    thrusters and after the last closing (`switches.rates`). Of limits about axes of a file that are not
    the principal ones, the components along those axes are drawn instead. span: (from, to) or the end; None:
    the case's own, at most ten periods, and past the time at which a limit is reached.
    """
    item = subject(case, state, span)
    subjects.check("time", item)
    if (own := subjects.elsewhere("time", item)) is not None:
        return own(item, ax, units, size, legend)
    scale = measures(item, units)
    low, high = item.seen
    t, omega = path(item, low, high)
    turned = file_axes(item)
    omega = omega if turned is None else omega @ turned.T
    (time_unit, per_time), (rate_unit, per_rate) = scale.time(_measured(item, low, high)), scale.rate
    names = scale.names if turned is None else IN_FILE
    with canvas.on(ax, size) as target:
        rows, looks = components(target, t, omega, names, scale, (time_unit, per_time))
        rows += _samples(target, item, t, per_time, per_rate, looks) if turned is None else []
        rows += _extremes(target, item, per_rate) if turned is None else []
        rows += _periods(target, item, low, high, per_time, scale)
        if item.motion.first is not None:
            reached, declared = item.motion.first[1], item.case.limits
            limit = declared.rate if declared.rate is not None else declared.rates
            rows += limit_marks(target, limit, (float(reached.low), float(reached.high)), t, omega,
                                (time_unit, per_time), scale.rate)
        if item.assumed is not None:
            rows += _assumed(target, item.assumed, t, omega, (time_unit, per_time), scale)
        if turned is not None:
            target.set_ylabel(with_unit("rate, axes of the file", rate_unit))
        return canvas.explained(target, rows if legend else [], ax is None,
                                item.heading, canvas.answer(item, scale), notes=canvas.notes(item, scale))


def components(ax: Axes, t: np.ndarray, omega: np.ndarray, names: Sequence[str], scale: Measures,
           time_unit: tuple[str, float]):
    """Draw the size and the components (n, 3) of rates over times (n,); the rows of the legend, and the looks
    of the components."""
    (unit, per_time), (rate_unit, per_rate) = time_unit, scale.rate
    length = np.linalg.norm(omega, axis=1)
    height = (max(omega.max(), length.max()) - omega.min()) * per_rate
    looks = told_apart(COMPONENTS, list(omega.T))
    # the size so wide that a component on it leaves its edges
    for values, look in zip((length, *omega.T), (SIZE_LOOK, *looks)):
        _curve(ax, t * per_time, values * per_rate, look, height)
    ax.set_xlim(t[0] * per_time, t[-1] * per_time)
    ax.margins(y=0.06)
    ax.set_xlabel(with_unit("time", unit) if scale.size else unit)
    ax.set_ylabel(with_unit("rate", rate_unit) if scale.size else "$x$")
    return [(scale.size or "$|x|$", SIZE_LOOK), *zip(names, looks)], looks


def _samples(ax, item, t, per_time, per_rate, looks):
    """Bands between the least and the greatest rates of motions at corners of the box of uncertain numbers,
    all where there are few."""
    if item.case is None or not item.case.uncertain or not item.scene.plain:
        return []
    box = box_of(item.case)
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
    return [(f"between {len(runs)} uncertain samples",
             {"facecolor": style.GREY, "alpha": 0.35, "linewidth": 0})]


def told_apart(looks: Sequence[dict[str, Any]], curves: Sequence[np.ndarray]) -> list[dict[str, Any]]:
    """The looks of curves (n,) in the order in which they are drawn: one that lies on an earlier one is
    broken, so that both are seen."""
    nearby = ALIKE * (max(values.max() for values in curves) - min(values.min() for values in curves))
    printed = []
    for n, (look, values) in enumerate(zip(looks, curves)):
        below = sum(bool(np.abs(values - earlier).max() <= nearby) for earlier in curves[:n])
        printed.append(look | {"linestyle": BROKEN[below - 1]} if below else look)
    return printed


def _curve(ax: Axes, t: np.ndarray, values: np.ndarray, look: Mapping[str, Any], height: float):
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


def _extremes(ax, item, per_rate):
    """Dotted lines at the least and greatest value of each component; the row of the legend."""
    result = item.motion.extremes
    if result is None or not item.motion.for_all_time:
        return []
    drawn = [(value, look) for pair, look in zip(result, COMPONENTS) for value in set(pair)
             if value is not None and math.isfinite(value)]
    for value, look in drawn:
        ax.axhline(value * per_rate, color=look["color"], zorder=1.5, **EXTREME)
    return [("extremes for ever", {"color": style.GREY, **EXTREME})] if drawn else []


def _marked(item: Subject, low: float, high: float) -> bool:
    """Whether the ends of the periods are drawn: there are some, and not so many that they would be a grey
    ground."""
    period = item.motion.period
    return bool(period) and period <= high - low <= MARKED * period


def _measured(item: Subject, low: float, high: float):
    """The time whose unit is that of the axis: of the period where its ends are marked, else of the picture.
    """
    return item.motion.period if _marked(item, low, high) else high - low


def _periods(ax, item, low, high, per_time, scale):
    period = item.motion.period
    if not period or high - low < period:
        return []
    unit, per = scale.time(period)
    text = f"period {number(period * per, 5)} {unit}"
    if not _marked(item, low, high):
        return [(text, {"linestyle": "none"})]
    for end in np.arange(math.ceil(low / period), math.floor(high / period) + 1) * period:
        ax.axvline(end * per_time, zorder=1, **PERIOD)
    return [(text, PERIOD)]


def file_axes(item: Subject):
    """Rows that turn rates to the axes of the file, where limits are about those and they are not the
    principal ones."""
    case = item.case
    declared = case is not None and case.limits is not None and case.limits.rate is None
    if not declared or case.frame is None or case.frame.as_given:
        return None
    return np.array([[float(v) for v in axis] for axis in case.frame.axes]).T


def limit_marks(ax, limit, when, t, omega, time_unit, rate_unit, look=None):
    """Dashed lines at a limit of |omega| (a number) or of the components (three), and a point where it is
    reached, between the ends of `when` or never (None), a band where these are far apart; the rows of the
    legend. look: of the lines, None for that of a stated limit."""
    drawn = look or LIMIT
    (second, per_time), (name, per_rate) = time_unit, rate_unit
    alone = not isinstance(limit, (tuple, list))
    limits = [float(v) for v in ([limit] if alone else limit)]
    same = len(set(limits)) == 1
    for largest, look in zip(limits, COMPONENTS):
        for sign in (1,) if alone else (1, -1):
            ax.axhline(sign * largest * per_rate, **drawn | ({} if same else {"color": look["color"]}))
    printed = f"limit of {'|ω|' if alone else 'each'}, {number(limits[0] * per_rate)} {name}"
    rows = [(printed if same else "limits", drawn)]
    low, high = when or (math.nan, math.nan)
    if not (t[0] <= high < math.inf and low <= t[-1]):
        return rows
    if broad(low, high):
        ax.axvspan(max(low, t[0]) * per_time, min(high, t[-1]) * per_time, **BETWEEN)
        return [*rows, (f"reached after {' to '.join(bracket(low, high, per_time))} {second}", BETWEEN)]
    middle = (low + high) / 2
    values = np.array([np.interp(middle, t, column) for column in omega.T])
    at = np.linalg.norm(values) if alone else values[np.argmax(np.abs(values) / np.array(limits))]
    ax.plot([middle * per_time], [at * per_rate], zorder=5, **REACHED)
    return [*rows, (f"reached after {number(middle * per_time)} {second}", REACHED)]


def _assumed(ax: Axes, limit: Assumed, t: np.ndarray, omega: np.ndarray, time_unit: tuple[str, float],
             scale: Measures) -> list[tuple[str, dict[str, Any]]]:
    """The limit of a case that states none: as `limit_marks` where the motion comes so far; else said alone,
    as room for its line would be taken from the curves."""
    rate, per_rate = scale.rate
    text = f"assumed limit, {number(limit.rate * per_rate)} {rate}".rstrip()
    if np.linalg.norm(omega, axis=1).max() < limit.rate:
        return [(f"{text}: not reached", {"linestyle": "none"})]
    when = None if limit.time is None else (limit.time, limit.time)
    (_, look), *rest = limit_marks(ax, limit.rate, when, t, omega, time_unit, scale.rate, SUPPOSED)
    return [(text, look), *rest]


# --- The rates after each thruster that is stuck open: a panel a row of the answer
BEYOND = 1.25  # of the time to the limit: how far a panel goes
NATURAL = 15  # units of the motion's own time, where nothing else says how far
MOST_PANELS = 4


def write_stuck(case: Case, result: Stuck, units: Units, path: str | Path) -> Path:
    """Draw the answer of `stuck` and write the picture."""
    return style.write(path, lambda plt: stuck(case, result, units, plt))


def stuck(case: Case, found: Stuck, units: Units, plt: Any) -> Any:
    """The figure of an answer (`answers.stuck`): the rates about the axes of the file after each of the first
    four thrusters or sets of them, with its limit."""
    scenario, scale = scenario_of(case), measures(subject(case), units.name)
    rows = found.rows[:MOST_PANELS]
    figure, axes = plt.subplots(len(rows), 1, figsize=(7.6, 1.0 + 3.4 * len(rows)), layout="constrained",
                                squeeze=False)
    printed: dict[str, Any] = {}
    for ax, row in zip(axes[:, 0], rows):
        scene = scenario.scene(scenario.torque([t for t in case.thrusters if t.name in row.thrusters]))
        until = _until(scenario, row, scene)
        t, omega = path(subject(scene, scenario.start), 0.0, until)
        omega, time_unit = omega @ np.array(scenario.rows).T, units.times(until)
        drawn, _ = components(ax, t, omega, IN_FILE, scale, time_unit)
        if row.limit is not None:
            drawn += limit_marks(ax, row.limit, row.time_to_limit, t, omega, time_unit, scale.rate)
        ax.set_ylabel(with_unit("rate, axes of the file", scale.rate[0]))
        clauses = answer_line(row, units).split("; ")[:1 + (row.time_to_limit is not None)]
        became = "; ".join(clauses).rsplit(" (", 1)[0]  # without how well that is known
        canvas.title(ax, "", f"{row_name(row)}: {became}")
        printed |= {text.partition(" after ")[0]: look for text, look in drawn}
    style.over(figure, case.heading)
    canvas.legend(axes[-1, 0], list(printed.items()), True)
    return figure


def _until(scenario, row, scene) -> float:
    """s: past the limit; else so long as the motion was followed, or some of its own units of time."""
    if row.time_to_limit and row.time_to_limit[1] > 0:
        return BEYOND * row.time_to_limit[1]
    torque, weight = math.hypot(*row.torque), sum(scene.body.inertia) / 3
    own = NATURAL * math.sqrt(weight / torque) if torque else NATURAL / (max(map(abs, scenario.start)) or 1.0)
    return min(own, row.followed) if row.followed > 0 else own


# --- Every part of a longer state over time, the analytic models beside the exact motion
TIMES = 801
ROWS = 2  # parts of a picture: six panels
# turns of a rate or of the vertical: of more of them the first are shown, unless a span is asked for
CROWDED, FEWER = 24, 0.95
STILL = 1e-9  # of the largest: what rounding leaves


def state(case: Any, start: Any = None, span: Any = None, size: tuple[float, float] | None = None,
          units: str | None = None, parts: Sequence[str] | None = None) -> Any:
    """Draw parts of the state over time, a row a part and a column a component, and return the figure; the
    analytic models that apply are beside the exact motion. Of a case whose rates turn very often over its
    span the first turns are shown. parts: one or two of omega, gamma, angles, momentum, velocity, position
    (rates, direction of the vertical, attitude, ...), as far as the scene has them; None: the first two.
    size: (width, height) in inches; None: as many as the rows need. units: "deg" or "si", None for those of
    the case."""
    return states(case, start, span, size, units, parts)[0]


def states(case: Any, start: Any = None, span: Any = None, size: tuple[float, float] | None = None,
           units: str | None = None, parts: Sequence[str] | None = None) -> list[Any]:
    """The figures of all parts of the state, two to a figure; arguments as of `state`."""
    import matplotlib
    from matplotlib import pyplot as plt
    item = subject(case, start, span)
    subjects.check("state", item)
    scale = measures(item, units)
    begin, end = item.asked or (item.seen[0], max(*item.seen, *(item.span or ())))  # slow parts need all
    runs, _ = side_by_side(item, np.linspace(begin, end, TIMES))
    # again where so few times hide some of the turns
    while span is None and (turns := _turns(runs["exact"].state)) > CROWDED:
        end = begin + FEWER * (end - begin) * CROWDED / turns
        runs, _ = side_by_side(item, np.linspace(begin, end, TIMES))
    exact = runs["exact"].state
    have = [name for name in cost.SYMBOLS if name in exact]
    if parts is not None and not (0 < len(parts) <= ROWS and set(parts) <= set(have)):
        raise InputError(f"parts: expected one or two of {', '.join(have)}, got {parts!r:.60}")
    shown, law = list(parts or have), runs["exact"].validity
    groups = [shown[n:n + ROWS] for n in range(0, len(shown), ROWS)]
    warned = law.short if law is not None and not law.held else ""
    with matplotlib.rc_context(style.RC | style.letters(size)):
        parted = [f"{n} of {len(groups)}" * (len(groups) > 1) for n in range(1, len(groups) + 1)]
        return [cost.picture(plt, item, runs, group, size, scale.system,
                             "; ".join(filter(None, (part, warned))))
                for part, group in zip(parted, groups)]


def _turns(state: Any) -> int:
    """How often the rate or the component of the vertical turns that turns most; of one that stays the
    rounding is not counted."""
    parts = [np.asarray(state[name]) for name in ("omega", "gamma") if name in state]
    return max((turning(row) for part in parts for row in part.T
                if np.ptp(row) > STILL * np.abs(part).max()), default=0)


OPEN_TOP = 10.0  # times the top of the picture: where a band ends that is open above
TALL = 8.0  # times the least: of times farther apart the logarithm is drawn
ANGLES = np.radians(np.geomspace(0.1, 10.0, 4))  # and more where times bend
EARLIEST = {"color": style.VERMILION, "linewidth": 2.0}
FEWER_STEPS = {"linewidth": 1.0, "linestyle": ":"}
BAND = {"facecolor": style.VERMILION, "alpha": 0.22, "linewidth": 0}
SURE = {"facecolor": style.BLUE, "alpha": 0.18, "linewidth": 0}
NOW = {"color": style.BLACK, "linestyle": "--", "linewidth": 1.2}
STATED = {"color": style.GREY, "linestyle": "-.", "linewidth": 1.2}
KEEPS = {"facecolor": style.BLUE, "alpha": 0.25, "linewidth": 0}
NEVER = {"marker": "^", "linestyle": "none", "markersize": 5}
WHEELS = [{"color": colour, "linewidth": 1.8, "linestyle": dashes} for colour, dashes in (
    (style.BLACK, "-"), (style.SAGE, "--"), (style.WINE, ":"), (style.GREY, "-."))]


def tilt(case: Any, state: Any = None, ax: Axes | None = None, units: str | None = None,
         size: tuple[float, float] | None = None, legend: bool = True) -> Axes:
    """Draw the time to the limit against the tilt of the torque, and return the axes.

    The band goes from the earliest to the latest time of runs at directions round the edge of each cone; it
    is open above where some run does not come to the limit. Blue: times before which no torque of the cone
    reaches it, which is proved. The limit is that of the case, else twice the largest rate of the bounded
    motion. Raises InputError where no constant torque acts, or nothing is to be reached.
    """
    item = subject(case, state)
    subjects.check("tilt", item)
    scale, supplied = measures(item, units), item.case
    scene: Any = item.scene  # physical: `which` refuses the others
    out = by_angle(scene, item.state, ANGLES, supplied,
                     None if supplied is None or supplied.limits is None else limit_of(supplied), closer=True)
    finite = np.concatenate([times[np.isfinite(times) & (times > 0)] for times in
                             (out.earliest, out.latest, out.not_before)])
    unit, per = scale.time(float(finite.max(initial=0.0)) or 1.0)
    degrees = np.degrees(out.angles)
    with canvas.on(ax, size) as target:
        target.set(xscale="log", yscale="log")
        rows: list[tuple[str, dict[str, Any]]] = [("earliest, by runs", EARLIEST)]
        ends = np.isfinite(out.latest).all()
        top = (1.2 if ends else 3.0) * per * float(finite.max(initial=0.0))
        reached = np.isfinite(out.earliest)
        if reached.any():
            target.fill_between(degrees, per * out.earliest, np.minimum(per * out.latest, OPEN_TOP * top),
                                where=reached, **BAND)
            target.plot(degrees[reached], per * out.earliest[reached], **EARLIEST)
            rows.append((f"to the latest of {SIDES} directions" + f", with {out.within}"
                         * bool(out.within), BAND))
            if not reached.all():  # where the line begins its runs have come to their last step
                begins = np.argmax(reached)
                target.plot(degrees[[begins, begins]], [per * out.earliest[begins], top],
                            **EARLIEST | FEWER_STEPS)
                target.plot(degrees[~reached], np.full((~reached).sum(), 0.93 * top), color=EARLIEST["color"],
                            **NEVER)
                rows.append(("not within the steps of a run", NEVER | {"color": EARLIEST["color"]}))
        if out.not_before.any():
            low = 0.3 * per * float(finite.min())
            target.fill_between(degrees, low, np.maximum(per * out.not_before, low), **SURE)
            target.set_ylim(bottom=low)
            rows.append(("not yet, proved", SURE))
        if (at := limit_time(item.motion)) is not None:
            first: Any = item.motion.first  # where there is a time there is a limit
            for end in {float(first[1].low), at} if broad(float(first[1].low), at) else (at,):
                target.axhline(per * end, **NOW)
            rows.append(("as it is", NOW))
        declared = [float(t.misalignment) for t in (() if supplied is None else supplied.thrusters)
                  if t.stuck and t.misalignment]
        if declared:
            target.axvline(np.degrees(max(declared)), **STATED)
            rows.append(("misalignment of the case", STATED))
        target.set_xlim(degrees[0], degrees[-1])
        target.set_ylim(top=top)
        if not out.not_before.any() and finite.max() < TALL * finite.min():
            target.set_yscale("linear")
            target.set_ylim(0.0, top)
        for axis in (target.xaxis, target.yaxis):
            axis.set_major_formatter("{x:g}")
            if target.get_yscale() == "log":
                axis.set_minor_formatter(_between_decades())
        target.set_xlabel(f"tilt of {out.of} (deg)")
        smallest = f"{number(out.limit.least_rate() * scale.rate[1], SHORT)} {scale.rate[0]}"
        reaches = r"$|\omega|$ =" if out.limit.kind == "rate" else "a component of"
        supposed = "an assumed " * (supplied is None or supplied.limits is None)
        target.set_ylabel(f"time to {supposed}{reaches} {smallest} ({unit})")
        looked_at = Kind.MISALIGNMENT, *([Kind.TOLERANCE] if out.within else [])
        return canvas.explained(target, rows if legend else [], ax is None, item.heading,
                                canvas.answer(item, scale), notes=canvas.notes(item, scale, shown=looked_at))


def _between_decades() -> Any:
    """What stands at ticks between powers of ten, where there are few of these: a number as elsewhere."""
    from matplotlib.ticker import LogFormatterSciNotation

    class Plain(LogFormatterSciNotation):
        def __call__(self, x: float, pos: int | None = None) -> str:
            return number(x) if super().__call__(x, pos) else ""
    return Plain()


def wheel(case: Given | Subject, ax: Axes | None = None, units: str | None = None,
          size: tuple[float, float] | None = None, legend: bool = True) -> Axes:
    """Draw by how much later the limit is reached with another momentum of a wheel, and return the axes.

    A line for each wheel of the case, the others left as they are, by runs; a triangle where a run does not
    reach the limit within PATIENCE times the time of now. Blue: momenta that keep the motion bounded.
    Raises InputError where the case has no wheel, or its motion does not reach a limit.
    """
    item = subject(case)
    subjects.check("wheel", item)
    scale, scenario, row = measures(item, units), scenario_of(item.case), item.stuck
    torque, first = scenario.torque([t for t in scenario.case.thrusters if t.stuck]), item.motion.first[1]
    time = float(first.low), float(first.high)
    curves = []
    for part, result in zip(scenario.case.wheels, row.wheels):
        axis = without_trace(scenario.axes.turned(part.axis), torque)
        curves.append((part, result, *times_over(scenario, torque, axis, part.momentum, time)))
    gains = [times - time[0] for *_, times in curves]
    unit, per = scale.time(max(float(np.abs(gain[np.isfinite(gain)]).max(initial=time[0])) for gain in gains))
    with canvas.on(ax, size) as target:
        rows: list[tuple[str, dict[str, Any]]] = []
        for (part, result, momenta, _), gain, look in zip(curves, gains, WHEELS):
            if result.gain is not None:
                after = int(np.searchsorted(momenta, result.best))
                momenta, gain = np.insert(momenta, after, result.best), np.insert(gain, after, result.gain)
            reached = np.isfinite(gain)
            target.plot(momenta, per * np.where(reached, gain, np.nan), **look)
            rows.append((f"wheel {part.name}", look))
            if not reached.all():
                top = per * float(gain[reached].max(initial=time[0]))
                target.plot(momenta[~reached], np.full((~reached).sum(), top), color=look["color"], **NEVER)
                rows.append((f"not within {NEVER_AFTER} times as long", NEVER | {"color": look["color"]}))
            if result.gain is not None:
                best, later = result.best, per * result.gain
                text = f"{number(best, SHORT)} N m s: {number(later, SHORT)} {unit}"
                side = ("left", "center", "right")[int(np.digitize(best / result.searched[1], (-0.5, 0.5)))]
                target.annotate(text.replace("-", "\u2212"), (best, later), (0, 6), ha=side,
                                textcoords="offset points", color=look["color"])
                target.plot(best, later, marker="o", color=look["color"], markersize=4)
            target.plot([float(part.momentum)], [0.0], zorder=5, **style.MARKER["start"])
            retained = () if item.motion.fate in STEADY else result.keeps_bounded
            for low, high in retained:
                target.axvspan(max(low, momenta[0]), min(high, momenta[-1]), **KEEPS)
            rows += [("keeps the motion bounded", KEEPS)] if retained else []
        now = scale.system.clock(*time) if broad(*time) else scale.system.time(time[0], SHORT)
        rows.append((f"now: {now}", style.MARKER["start"]))
        target.axhline(0.0, color=style.GREY, linewidth=0.8)
        target.margins(y=0.12)
        target.set_xlabel("momentum of the wheel along its axis (N m s)")
        target.set_ylabel(f"later by ({unit})")
        return canvas.explained(target, list(dict(rows).items()) if legend else [], ax is None,
                                item.heading, canvas.answer(item, scale), notes=canvas.notes(item, scale))
