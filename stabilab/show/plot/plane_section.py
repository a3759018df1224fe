"""The Poincaré section of a motion: where it passes a plane of the space of rates, again and again."""
from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import InputError
from ...orbit.reduction import reduce
from ...orbit.result import Fate
from ...physics.states import checked_states
from ...unreduced.periodic import Periodic, Section, in_the_middle
from ...unreduced.section import LEAST, crossed, neighbours_of, one_place, returns
from .. import style
from ..units import number
from . import canvas, which
from .measures import Measures, measures
from .subject import Subject, subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes

DOT = {"marker": ".", "linestyle": "none", "markersize": 5}
THIS, OTHER = DOT | {"color": style.ORANGE, "markersize": 7}, DOT | {"color": style.PURPLE}
STAYS, LEAVES = DOT | {"color": style.SKY}, DOT | {"color": style.VERMILION, "marker": "x", "markersize": 3.5}
MIDDLE = style.MARKER["centre"]
PASSAGES, MOST = 300, 20_000
FAN = 500       # neighbours at most
BESIDE = 150    # passages of each neighbour, if it does not leave
ROUND = 1000    # passages, at most, for the sake of going round
GONE = 3        # times the farthest of this motion's passages: a neighbour that far has left
MARGIN, CLOSE = 0.08, 0.01  # of the picture around its points; half its side at least, of the size of the rates


def section(case: Any, states: Any = None, ax: Axes | None = None, units: str | None = None, size: tuple[float, float] | None = None,
            legend: bool = True, neighbours: int = 0, passages: int | None = None) -> Axes:
    """Draw the Poincaré section of a motion, and return the axes.

    case: a Case, or a scene with `states`: three rates, or (n, 3) of several motions, the first of which is this one. The plane is that on which one rate
    has its mean value over the motion, and grows; the axes are the two other rates, in deg/s (units="si": rad/s; scaled scenes have x). Each passage
    is a root of a Taylor series. A periodic motion is one point, one on a torus fills closed curves, one that leaves scatters. passages: how
    many of this motion (None: 300, or about an elliptic periodic motion as many as go round it); of one that spins up, those before that is
    certain. neighbours: how many motions beside it, from the middle to twice as far. Where it stays in an island about an elliptic periodic motion,
    that is marked. Raises InputError for a body with a liquid, in a medium or in a field, a motion at rest, and one that spins up before it has passed
    any plane often enough.
    """
    one, rest = _motions(case, states)
    which.check("section", one)
    fan = neighbours or one.neighbours
    _check("neighbours", fan, 0, FAN)
    _check("passages", PASSAGES if passages is None else passages, 1, MOST)
    scale, until = measures(one, units), which.certain_from(one)
    orbit, plane = plane_of(one, until)
    count, followed = passages or _round(PASSAGES, orbit), _round(BESIDE, orbit)
    times, places = returns(one.twin, one.state, plane, count, until)
    sets = [(THIS, "this motion", places)]
    sets += [(OTHER, "the other states", found) for found in [_together([returns(one.twin, row, plane, count)[1] for row in rest])] if len(found)]
    stay, leave = _fan(one.twin, orbit, plane, places, min(followed, len(places)), fan)
    sets += [(STAYS, "neighbours", stay)] * bool(len(stay))
    with canvas.on(ax, size or canvas.SQUARE) as target:
        rows = _draw(target, sets, leave, orbit, plane, scale)
        canvas.title(target, one.heading, _plane_words(plane, scale), *_passed(one, times, places, until, scale, orbit))
        if legend:
            canvas.legend(target, rows, ax is None)
    return target


def _motions(case: Any, states: Any) -> tuple[Subject, np.ndarray]:
    """The subject of the first motion, and the states (n, 3) of the others."""
    if states is None or isinstance(states, dict):
        return subject(case, states), np.empty((0, 3))
    rows = checked_states(states).reshape(-1, 3)
    if not len(rows):
        raise InputError("states: expected three rates, or an array (n, 3) of at least one state, got none")
    return subject(case, rows[0].tolist()), rows[1:]


def _check(name: str, value: Any, least: int, most: int) -> None:
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or not least <= value <= most:
        raise InputError(f"{name}: expected a whole number from {least} to {most}, got {value!r:.40}")


def _may_have_an_island(one: Subject) -> bool:
    """Whether no integral of motion is known, and the motion is not known to leave: where there is one, periodic motions are never isolated."""
    return one.motion.fate == Fate.UNDECIDED and reduce(one.twin) is None and not which.free(one)


def plane_of(one: Subject, until: float) -> tuple[Periodic | None, Section]:
    """The periodic motion in the middle, where there is one, and the plane that the motion passes."""
    orbit = in_the_middle(one.twin, one.state) if _may_have_an_island(one) else None
    if orbit is not None and len(returns(one.twin, one.state, orbit.section, LEAST)[0]) == LEAST:
        return orbit, orbit.section
    plane = crossed(one.twin, one.state, until)
    if plane is None:
        raise InputError("plot section: the motion passes no plane often enough")
    return None, plane


def _together(sets: list[np.ndarray]) -> np.ndarray:
    """(n, 3) of several sets of places, none of them included."""
    return np.concatenate([np.empty((0, 3)), *sets])


def _round(count: int, orbit: Periodic | None) -> int:
    """So many passages, and more where they go round an elliptic periodic motion slowly (away from it up to twice as slowly), ROUND at most."""
    return count if orbit is None else max(count, min(ROUND, math.ceil(2 * 2 * math.pi / orbit.angle)))


def _fan(scene: Any, orbit: Periodic | None, plane: Section, places: np.ndarray, count: int, number_of: int) -> tuple[np.ndarray, np.ndarray]:
    """Passages (n, 3) of the neighbours that stay as long as they are followed, and of those that leave, or pass no more within the steps of a search."""
    kept: dict[bool, list[np.ndarray]] = {True: [], False: []}
    if number_of:
        middle = np.array(orbit.state) if orbit is not None else places.mean(axis=0)
        reach = GONE * float(np.linalg.norm(places, axis=1).max())
        for start in neighbours_of(middle, places[0], plane, number_of):
            _, found = returns(scene, start, plane, count, reach=reach)
            kept[len(found) == count].append(np.vstack([start, found]))
    return _together(kept[True]), _together(kept[False])


def _draw(ax: Any, sets: list, leave: np.ndarray, orbit: Periodic | None, plane: Section, scale: Measures) -> list:
    """Draw the sets of passages, the nearer ones above; the rows of the legend."""
    j, k = plane.across
    per_rate, rows = scale.rate[1], []
    if len(leave):
        ax.plot(leave[:, j] * per_rate, leave[:, k] * per_rate, zorder=2, **LEAVES)
    for level, (look, name, places) in enumerate(sets):
        if one_place(places):
            look = look | {"markersize": 22}  # a halo, where the periodic motion in the middle is this one
        ax.plot(places[:, j] * per_rate, places[:, k] * per_rate, zorder=5 - level, **look)
        rows.append((name, look | {"markersize": max(9, look["markersize"])}))
    if len(leave):
        rows.append(("neighbours that leave, or pass no more", LEAVES | {"markersize": 6}))
    if orbit is not None:
        ax.plot([orbit.state[j] * per_rate], [orbit.state[k] * per_rate], zorder=6, **MIDDLE)
        rows.append(("periodic motion in the middle (elliptic)", MIDDLE))
    every = np.concatenate([places for _, _, places in sets] + ([np.array([orbit.state])] if orbit is not None else []))
    least = CLOSE * float(np.abs(every).max())
    for axis, setter, labels in ((j, ax.set_xlim, ax.set_xlabel), (k, ax.set_ylim, ax.set_ylabel)):
        low, high = float(every[:, axis].min()), float(every[:, axis].max())
        half = max((high - low) * (0.5 + MARGIN), least)
        setter((low + high) / 2 * per_rate - half * per_rate, (low + high) / 2 * per_rate + half * per_rate)
        labels(scale.label(scale.names[axis], scale.rate[0]))
    return rows


def _plane_words(plane: Section, scale: Measures) -> str:
    unit, per_rate = scale.rate
    return f"where {scale.plain(plane.axis)} = {number(plane.level * per_rate)} {unit}".rstrip() + " and grows"


def _passed(one: Subject, times: np.ndarray, places: np.ndarray, until: float, scale: Measures, orbit: Periodic | None) -> list[str]:
    """Lines on the passages, and on what they go round."""
    turn = "" if orbit is None else f"neighbours turn about it by {number(math.degrees(orbit.angle))} deg a passage"
    if len(places) > 1 and one_place(places):
        return [f"all {len(places)} passages at one place: periodic, {_time(float(times[1] - times[0]), scale)}", turn]
    passed = f"{len(places)} passages in {_time(float(times[-1]), scale)}"
    if math.isfinite(until):
        passed += f", until spin-up about {one.axes.short(one.motion.axis)} is certain"
    return [passed, "" if orbit is None else f"in the middle: period {_time(orbit.period, scale)}, {turn}"]


def _time(value: float, scale: Measures) -> str:
    unit, per = scale.time(value)
    return f"{number(value * per)} {unit if scale.size else 'τ'}"
