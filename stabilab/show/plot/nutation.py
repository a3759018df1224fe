"""The nutation over time: the angle of a body axis to the angular momentum, or of a top's axis to the upward
vertical."""
from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from ...answers.attitude import attitude
from ...answers.limit import Momentum
from ...answers.motions.angles import Leaning, for_all_time, leaning
from ...answers.motions.nutation import BodyAxis, axis_at_start, axis_named, between, nutation_of
from ...case.given import Given
from ...errors import InputError
from ...numbers.vectors import Exact3
from ...physics.symmetric_top import SymmetricTop
from .. import style
from ..units import SHORT, as_bound, number, with_unit
from . import canvas
from . import subject as subjects
from .over_time import EXTREME
from .path import FINE, SOLID, band, path, turning
from .subject import Measures, Subject, measures, momentum_at_start, subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes

NUTATION: dict[str, Any] = {"color": style.VIOLET, "linewidth": 1.6}
POINTING: dict[str, Any] = {"color": style.BLACK, "linewidth": 1.0}
BOUNDS: dict[str, Any] = {"color": style.VIOLET, **EXTREME}
POINTING_BOUND: dict[str, Any] = {"color": style.BLACK, **EXTREME}
END: dict[str, Any] = {"color": style.BLUE, "linewidth": 1.2, "linestyle": "--"}
FOLD: dict[str, Any] = {"color": style.GREY, "linewidth": 1.3, "linestyle": (0, (4, 2))}
TIMES: dict[str, tuple[str, dict[str, Any]]] = {
    "leaves": ("beyond {angle} from the minor axis", {"color": style.GREY, "linestyle": ":"}),
    "crosses": ("separatrix crossed", {"color": style.BLACK, "linestyle": "-."}),
    "settles": ("within {angle} of its end", {"color": style.GREY, "linestyle": "-"}),
    "tenth": ("a tenth of the departure", {"color": style.GREY, "linestyle": (0, (5, 1, 1, 1))})}
DIGITS = 5  # of a bound, unless more are needed to tell two apart
SMALL = 0.2  # rad, of a departure that a time constant belongs to
FLAT, AROUND = 1e-7, 0.02  # rad: an angle that varies by less stays; what is shown about it


def nutation(case: Given | Subject, state: Any = None, ax: Axes | None = None, span: Any = None,
             units: str | None = None, size: tuple[float, float] | None = None, legend: bool = True,
             axis: str | None = None) -> Axes:
    """Draw the angle of a body axis to the angular momentum over time, and return the axes; of a symmetric
    top in a field that of its axis to the upward vertical, the lean.

    case: in any form, or a scene with `state`. axis: "x", "y", "z" of the file or "1", "2", "3", "-" before
    it for its opposite direction; None: that of [motion] axis, else the principal axis that is nearest to the
    angular momentum at the start. Under a torque also the angle to the direction of the axis at the start.
    Dotted: bounds for ever, where a law gives them; dashed: the end of a motion that loses energy, and the
    time constants of small departures; upright: when it is over. Raises InputError where there is no such
    angle: scaled variables, no angular momentum, an equilibrium.
    """
    item = subject(case, state, span)
    subjects.check("nutation", item)
    axis = axis or item.axis
    scale, of = measures(item, units), _axis_of(item, axis)
    top = None if axis else SymmetricTop.of(item.scene)
    vector = of.along if top is None else top.direction
    name = _name(item, of) if top is None else "axis of the top"
    low, high = item.seen
    run = _leaning(item, vector, np.linspace(low, high, FINE), top is not None)
    (time_unit, per_time), (angle_unit, per) = scale.time(high - low), scale.angle
    with canvas.on(ax, size) as target:
        t, rows = run.t * per_time, []
        if run.apart is not None:
            rows.append((f"{name} to its direction at the start", POINTING))
            _curve(target, t, run.apart * per, POINTING)
        to = "angular momentum" if top is None else "upward vertical"
        rows.insert(0, (f"this motion: {name} to the {to}", NUTATION))
        _curve(target, t, run.angle * per, NUTATION)
        rows += _bounds(target, item, vector, top, run, (angle_unit, per))
        rows += _end(target, item, vector, run, scale, per_time) if top is None else []
        target.set_xlim(t[0], t[-1])
        _room(target, run, per)
        target.set_xlabel(with_unit("time", time_unit))
        label = "angle" if run.apart is not None else "nutation" if top is None else "lean"
        target.set_ylabel(with_unit(label, angle_unit))
        return canvas.explained(target, rows if legend else [], ax is None,
                                item.heading, canvas.answer(item, scale), notes=canvas.notes(item, scale))


def _axis_of(item: Subject, axis: str | None) -> BodyAxis:
    return (axis_at_start(item.case, momentum_at_start(item)) if axis is None
            else axis_named(item.case, axis))


def _name(item: Subject, of: BodyAxis) -> str:
    """As legends have it: "z", "−z", "the minor axis"."""
    if of.number and of.sense > 0:
        return item.axes.brief(of.number)
    return (item.axes.signed(of.number, -1) if of.number else of.name).replace("-", "−")


def _leaning(item: Subject, axis: Exact3, times: np.ndarray, vertical: bool) -> Leaning:
    """The angles at the times, or as many as a run reaches; without a torque by the rates that other pictures
    show, too, where doubles lose them as well."""
    scene: Any = item.scene
    if scene.plain and Momentum.made(scene).stays:
        t, omega = path(item, float(times[0]), float(times[-1]))
        return Leaning(t, nutation_of(scene, {"omega": omega}, axis))
    run = leaning(scene, item.state, item.blocks, times, axis, vertical)
    if len(run.t) < 2:
        raise InputError("plot: the motion cannot be followed: the run stopped at its start")
    return run


# --- The curve, and what is marked beside it
def _curve(ax: Axes, t: np.ndarray, values: np.ndarray, look: dict[str, Any]) -> None:
    """An angle over time; one that turns more often than a picture has columns as the band that it fills."""
    if turning(values) <= SOLID:
        ax.plot(t, values, **look)
        return
    times, low, high = band(t, values)
    ax.fill_between(times, low, high, color=look["color"], alpha=0.45, linewidth=1.0)


def _room(ax: Axes, run: Leaning, per: float) -> None:
    """Limits of the angles: none below zero, and no rounding blown up."""
    low, high = (v / per for v in ax.get_ylim())
    if high - low < FLAT + 0.1 * (high + low) and np.ptp(run.angle) < FLAT and run.apart is None:
        low, high = float(run.angle.min()) - AROUND, float(run.angle.max()) + AROUND
    ax.set_ylim(max(low, -0.02 * (high - max(low, 0.0))) * per, min(high, 1.02 * math.pi) * per)
    ax.ticklabel_format(axis="y", useOffset=False)


def _bounds(ax: Axes, item: Subject, axis: Exact3, top: SymmetricTop | None, run: Leaning,
            unit: tuple[str, float]) -> list[tuple[str, Any]]:
    """Dotted lines at the least and greatest angle for ever; rows of the legend."""
    name, per = unit
    pointing = None
    if top is not None:
        ends = _lean_of(item)
    elif item.scene.plain:
        exact = item.exact_state or tuple(map(Fraction, item.state or ()))
        law = for_all_time(item.scene, item.state, exact, [axis])
        ends = None if law is None else tuple(law[0][0].tolist())
        pointing = None if law is None or run.apart is None else float(law[1][0])
    else:
        ends = None
    rows: list[tuple[str, Any]] = []
    if ends is not None:
        for end in sorted(set(ends)):
            ax.axhline(end * per, zorder=1.5, **BOUNDS)
        low, high = (end * per for end in ends)
        digits = next((n for n in range(DIGITS, 17) if number(low, n) != number(high, n)), DIGITS)
        text = (f"for ever: {number(high, DIGITS)} {name}" if high - low < FLAT * per
                else f"least to greatest for ever: {number(low, digits)} to {number(high, digits)} {name}")
        rows.append((text, BOUNDS))
    if pointing is not None and pointing < math.pi:
        ax.axhline(pointing * per, zorder=1.5, **POINTING_BOUND)
        at_most = number(as_bound(pointing, per, DIGITS, 1), DIGITS)
        rows.append((f"at most {at_most} {name} from its start", POINTING_BOUND))
    return rows


def _lean_of(item: Subject) -> tuple[float, float] | None:
    start = item.case if item.case is not None else item.scene
    return attitude(start, None if item.case is not None else item.start).lean


def _end(ax: Axes, item: Subject, axis: Exact3, run: Leaning, scale: Measures, per_time: float
         ) -> list[tuple[str, Any]]:
    """The end of a motion that loses energy, the times that lead to it, and its time constants."""
    ending = item.motion.ending
    if ending is None or not Momentum.made(item.scene).stays:
        return []
    (name, per), units = scale.angle, scale.system
    rows: list[tuple[str, Any]] = []
    end = _angle_at_end(item, axis, ending)
    if end is not None:
        ax.axhline(end * per, zorder=1.5, **END)
        rows.append((f"steady at its end: {number(end * per, SHORT)} {name}", END))
    for key, when in ending.times:
        words, look = TIMES[key]
        if run.t[0] < when.at < run.t[-1] and (key != "settles" or ending.within):
            ax.axvline(when.at * per_time, zorder=1, linewidth=1.1, **look)
            text = words.format(angle=_within(ending, per, name))
            rows.append((f"{text} after {units.time(when.at, SHORT)}", look | {"linewidth": 1.1}))
    folds = _folds(ax, run, end, ending, per_time, per)
    return rows + [(f"{text} e-fold in {units.time(time, SHORT)}", FOLD) for text, time in folds]


def _within(ending: Any, per: float, name: str) -> str:
    """How near "settles" is: an angle, or a part of the rates."""
    if ending.kind in ("flat spin", "nutation dies out") or ending.angular:
        return f"{number(ending.within * per, SHORT)} {name}"
    return f"{number(100 * ending.within, SHORT)} %"


def _angle_at_end(item: Subject, axis: Exact3, ending: Any) -> float | None:
    """The angle of the axis to the angular momentum in the end, which is along the rates of a steady rotation
    or against them; None where that is not known."""
    if ending.rates is None or not any(ending.rates):
        across = ending.minor and not ending.axis and abs(axis[ending.minor - 1]) == 1
        return math.pi / 2 if across else None
    law, rates = Momentum.made(item.scene), np.array(ending.rates, float)
    H = np.array([float(d) * w + float(l) for d, w, l in zip(law.D, rates, law.wheel)])
    return float(between(rates if H @ rates > 0 else -rates, np.array([float(v) for v in axis])))


def _folds(ax: Axes, run: Leaning, end: float | None, ending: Any, per_time: float, per: float
           ) -> list[tuple[str, float]]:
    """Dashed curves: how a small departure grows at the start, and dies out at the end; their names and time
    constants."""
    rows: list[tuple[str, float]] = []
    decay = ending.decay or (ending.constants[0].time if ending.constants else None)
    if ending.growth and run.angle[0] < SMALL:
        inside = run.angle < SMALL
        until = int(np.argmin(inside)) if not inside.all() else len(run.t)
        rows += _fold(ax, run.t[:until], run.angle[:until], 0.0, ending.growth, per_time, per, "grows")
    if decay and end is not None:
        away = np.abs(run.angle - end)
        first = int(np.nonzero(away > SMALL)[0][-1]) + 1 if (away > SMALL).any() else 0
        rows += _fold(ax, run.t[first:], run.angle[first:], end, -decay, per_time, per, "decays")
    return rows


def _fold(ax: Axes, t: np.ndarray, angle: np.ndarray, end: float, constant: float, per_time: float,
          per: float, word: str) -> list[tuple[str, float]]:
    """The least curve of that time constant (negative: decay) beyond departures from an end, on the sides
    where there are some; its name and time."""
    away = np.abs(angle - end)
    sides = {float(side) for side in np.sign(angle - end)[away > FLAT].tolist()}
    if len(t) < 2 or not away.any() or t[-1] - t[0] < abs(constant) / 20:
        return []
    level = float((np.log(np.maximum(away, np.finfo(float).tiny)) - t / constant).max())
    curve = np.exp(level + t / constant)
    shown = curve < 2 * SMALL
    for sign in sides:
        ax.plot(t[shown] * per_time, (end + sign * curve[shown]) * per, zorder=1.6, **FOLD)
    return [(f"a small departure {word}", abs(constant))]
