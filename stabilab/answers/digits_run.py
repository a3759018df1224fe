"""A motion to as many digits as are asked for, checked afterwards.

The check needs no reference: the same motion at another tolerance, its start moved by a unit in its last
place, shows the error of the first run and what doubles can hold, for the price of one run more. What falls
short is done again in another way, at last in many digits, rounded once.
"""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from ..integrate.reference import reference
from ..integrate.to_heyoka import TAYLOR_TOLERANCE
from ..integrate.trajectory import FALLBACK_RTOL
from ..orbit.flow import reduced_motion
from ..physics.coefficients import limits_of
from ..physics.equations import derive
from ..physics.scene import AnyScene, time_left
from ..physics.states import (
    angles,
    as_quaternion,
    beyond,
    body_momentum,
    equations_and_start,
    moved_row,
    start_of,
    to_space,
)
from ..physics.to_numpy import to_numpy
from ..reasons import Moment, Quantity, Reason, Reasoned, Sentence
from .digits_asked import CAUTION, DEFAULT, DIGITS_MISSED, DOUBLE_DIGITS, checked_digits, digits_of, too_few
from .simulate import LOST, STIFF_METHOD, Simulation, errors_of, in_quaternions, simulated

if TYPE_CHECKING:
    from ..case.read import Case


ASK_FOR_LESS = Sentence("ask-for-fewer-or-shorter", "ask for fewer or for a shorter span")()
NO_DIGIT_AT = Sentence("no-digit-at", "no digit of the state is known at {time}")
NOR_LATER = Sentence("nor-at-others", "nor at {others} other times")
CHECK_STOPPED = Sentence("check-stopped", "the check of {method} stopped early")
FROM_MOVED_START = Sentence(
    "method-from-moved-start", "{method} with rtol {rtol} from a start moved in its last place differs by "
    "{error}")
MORE_NODES = Sentence("more-nodes", "reduced with {nodes} nodes differs by {error}, and a start moved in its "
                      "last place by {moved}")
TOO_FAR = Sentence("too-far-for-doubles", "the motion goes too far for its start in doubles")()
REDUCED_COORDINATE = Sentence("over-reduced-coordinate",
                              "time as an integral over the reduced coordinate, {nodes} nodes")
ROUNDED_SERIES = Sentence(
    "series-rounded-once", "Taylor series in {fewer} and {more} digits differ by {error}; rounded once")

# --- The reduced form as one of the ways to follow a motion: `reduced_motion` at a given resolution
GAUSS_POINTS = (2, 4, 6, 8, 12, 16)  # of Gauss's rule on each panel


def ladder(scene: AnyScene, state: np.ndarray | Sequence[float]) -> tuple[int, ...]:
    """Resolutions worth trying for this motion."""
    if reduced_motion(scene, state).period == 0:
        raise InputError("the state is an equilibrium: there is nothing to follow")
    return GAUSS_POINTS


MANY, REDUCED_FORM = "many digits", "reduced form"
# the finest Taylor series, which costs little more than a coarse one; Radau where the scene is stiff
OWN: tuple[Any, Any] = (None, None)  # method and tolerance as `simulate` chooses
STIFF_FINE = (STIFF_METHOD, 1e-12)
SAFETY = 1.0  # digits that a stiff run at its own tolerance must have to spare
LONG_TURN = 1e4  # radians or so from which the reduced form, whose cost does not grow, is cheaper than a run
# radians beyond which a run in many digits takes more than the work allowed (`integrate.reference.WORK`)
FARTHEST = 1e5
NODES = (-4, -1)  # which of the reduced form's resolutions are tried: one that mostly does, and the finest
# last places by which a start is moved to see what one does; the answer's share up to which it grows in
# proportion
SHIFT, STRAIGHT = 2.0**12, 0.01
COUNTED = 1.0  # rad: angles this near to those of a run in doubles have the same number of turns


@dataclass(frozen=True)
class Reached(Reasoned):
    """A motion, with the errors that the check showed, and its digits. reason: how they were checked. gaps:
    (n,) what the check differs by at each time, relative to the size of each part; None where it did not come
    so far."""

    run: Simulation
    asked: int
    digits: float
    gaps: np.ndarray | None = field(default=None, repr=False, compare=False)

    @property
    def enough(self) -> bool:
        return self.run.status == "reached" and self.digits >= self.asked


def missed(result: Any) -> str:
    """Why digits were not reached, in words."""
    if result.run.status != "reached":
        return result.run.because
    return too_few(result).then(ASK_FOR_LESS).text()


def best_reached(case: Case, times: np.ndarray, digits: int = DEFAULT, aim: bool = False) -> Reached:
    """The exact motion of a case at the times (as of `simulate`) to 1 to 15 decimal digits, relative to the
    largest size of each part of the state over the times. Where nothing reaches them, the motion that comes
    nearest.

    aim: nobody asked for the digits: the last `DIGITS_MISSED` of them may be missing, and many digits go no
    farther than LONG_TURN.
    """
    checked_digits(digits, DOUBLE_DIGITS)
    times = np.atleast_1d(np.asarray(times, float))
    best: Any = None  # `simulate`'s own way always has an answer
    turned, reduced = _turned(case, times), [("reduced", nodes) for nodes in _resolutions(case, times)]
    far = turned > (LONG_TURN if aim else FARTHEST)
    # what `simulate` chooses itself and many digits, with the reduced form before the one that costs more
    for method, value in [*reduced, OWN, (MANY, 0.0)] if turned > LONG_TURN else [OWN, *reduced, (MANY, 0.0)]:
        if best is not None and method != "reduced" and _hopeless(method, best, far):
            continue
        result = _checked(case, times, method, value, digits)
        if result is None:
            continue
        if result.run.status == "reached" and result.digits >= digits - DIGITS_MISSED * aim:
            return result
        best = max(best or result, result, key=lambda item: (item.run.status == "reached", item.digits))
    return best if best.digits >= 1 or best.run.status != "reached" else _known(best)


def _known(result: Reached) -> Reached:
    """A motion without the times at which not one digit of its state is known: such a state is none. Where
    the check did not come so far nothing is known of its digits, and it stays."""
    run, gaps = result.run, result.gaps
    if gaps is None or (gaps <= LOST).all():
        return result
    held = gaps <= LOST
    first = float(min(run.t[~held], key=abs))
    others = len(run.t) - int(held.sum()) - 1
    reason = NO_DIGIT_AT(time=Moment(first)).then(NOR_LATER(others=others) if others else None, ", ")
    state = {name: values[held] for name, values in run.state.items()}
    return replace(result, run=replace(run, t=run.t[held], state=state, status="stopped",
                                      reason=reason.then(result.reason, ": ")), gaps=gaps[held])


def _hopeless(method: str, best: Reached, far: bool) -> bool:
    """Whether steps are not worth trying after what was found: where steps stopped, or the reduced form,
    which makes none, has answered first; many digits where the way is far."""
    return best.run.status != "reached" or (far if method == MANY else best.run.method == REDUCED_FORM)


def _turned(case: Any, times: np.ndarray) -> float:
    """Radians or so that a motion goes through: its rates, or the roots of their rates where these are
    larger, times the longest time."""
    scene = case.scene
    row = np.array([*case.state,
                    *(v for name in scene.blocks[1:] for v in case.blocks.get(name, (0.0,) * 3))])
    if scene.blocks != ("omega",):
        return math.hypot(*row[:3]) * float(np.abs(times).max())
    with np.errstate(all="ignore"):
        rates = np.abs(to_numpy(derive(scene))(row)).max()
    return max(math.hypot(*row), math.sqrt(rates)) * float(np.abs(times).max())


def _resolutions(case: Any, times: np.ndarray) -> tuple[int, ...]:
    """Of the reduced form; none where it does not serve."""
    if case.blocks or case.scene.blocks != ("omega",) or (times < 0).any():
        return ()
    try:
        result = ladder(case.scene, case.state)
    except InputError:
        return ()
    return tuple(result[n] for n in NODES)


def _checked(case: Any, times: np.ndarray, method: str, value: Any, request: int) -> Reached | None:
    """The motion by one setting with the digits that the check shows; None where that way has no answer."""
    if method == MANY:
        return _many_digits(case, times, request)
    try:
        run = (_reduced if method == "reduced" else _integrated)(case, times, method, value)
    except InputError:
        if (method, value) == OWN:
            raise
        return None
    if (method, value) == OWN:
        method, value = run.method, run.rtol
        if method == STIFF_METHOD and value > STIFF_FINE[1] and request > -math.log10(value) - SAFETY:
            return _checked(case, times, *STIFF_FINE, request)
    if method == "reduced":
        return _checked_reduced(case, times, run, value, request)
    other_value = _other(method, value)
    other = _integrated(_moved(case), times, method, other_value) if run.status == "reached" else run
    if other.status != "reached":
        return Reached(run, request, 0.0, reason=CHECK_STOPPED(method=method))
    gaps = _distances(run, other)
    gap = float(gaps.max())
    return _told(run, request, CAUTION * gap,
                 FROM_MOVED_START(method=method, rtol=Quantity(other_value, digits=2),
                                  error=Quantity(gap, digits=2)), CAUTION * gaps)


def _told(run: Simulation, request: int, error: float, reason: Reason,
          gaps: np.ndarray | None = None) -> Reached:
    """A run whose parts are off by so much of their size; gaps: at each time."""
    digits = digits_of(error)
    resolved = replace(run, error=errors_of(run.state, 10.0**-digits)) if digits >= 1 else run
    return Reached(resolved, request, digits, gaps, reason=reason)


def _checked_reduced(case: Case, times: np.ndarray, run: Simulation, nodes: float,
                     request: int) -> Reached | None:
    """By twice the nodes, and from a start moved by so many last places that the period, rounded, moves with
    it: what a period is off by grows with the number of periods, and two runs that round it alike would not
    show that."""
    try:
        finer, moved = (_reduced(item, times, "reduced", 2 * nodes) for item in (case, _moved(case, SHIFT)))
    except InputError:
        return None
    apart, away = _distances(run, finer), _distances(finer, moved)
    own, far = float(apart.max()), float(away.max())
    gap = max(own, far / SHIFT) if far < STRAIGHT else 1.0
    return _told(run, request, CAUTION * gap,
                 MORE_NODES(nodes=int(2 * nodes), error=Quantity(own, digits=2),
                            moved=Quantity(far / SHIFT, digits=2)) if far < STRAIGHT else TOO_FAR,
                 CAUTION * np.where(away < STRAIGHT, np.maximum(apart, away / SHIFT), 1.0))


def _other(method: str, value: float) -> float:
    """A setting fine enough to judge by, or, where there is none, a coarser one: the difference is then too
    large."""
    finest = TAYLOR_TOLERANCE if method == "taylor" else FALLBACK_RTOL
    return max(value / 1000, finest) if value > 4 * finest and method != STIFF_METHOD else value * 8


def _moved(case: Any, places: float = 1.0) -> Any:
    """The case with its start moved; what is zero throughout (rest at the origin) stays."""
    return replace(case, state=tuple(map(float, moved_row(case.state, places))),
                   blocks={name: tuple(map(float, moved_row(row, places)))
                           for name, row in case.blocks.items()})


def _distances(item: Simulation, two: Simulation) -> np.ndarray:
    """(n,) how far two runs are apart at each time, relative to the largest size of each part."""
    worst = np.zeros(len(item.t))
    for name, values in item.state.items():
        size = np.abs(values).max() or 1.0
        apart = np.abs(values - two.state[name]).reshape(len(values), -1)
        worst = np.maximum(worst, apart.max(axis=1) / size)
    return np.where(np.isfinite(worst), worst, math.inf)


def _integrated(case: Any, times: np.ndarray, method: str | None, rtol: float | None) -> Simulation:
    return simulated(case.scene, case.state, times, case.blocks, method, rtol)


def _reduced(case: Case, times: np.ndarray, method: str, nodes: float) -> Simulation:
    orbit = reduced_motion(case.scene, case.state, int(nodes))
    counters = {"evaluations": int(orbit.evaluations)}  # of the integrand in its preparation
    return Simulation(times, {_first(case): orbit.states(times)}, "exact", REDUCED_FORM, None,
                      counters=counters,
                      reason=REDUCED_COORDINATE(nodes=int(nodes)))


def _first(case: Case) -> str:
    return "x" if case.scene.variables == "scaled" else "omega"


def _many_digits(case: Any, times: np.ndarray, request: int) -> Reached | None:
    """The reference itself, rounded once; at times of one sign."""
    scaled = case.scene.variables == "scaled"
    equations, start = equations_and_start(case.scene, case.state if scaled
                                           else start_of(case.scene, case.state, case.blocks))
    left = time_left(case.scene)
    if times.min() < 0 < times.max() or (left is not None and left < times.max()):
        return None
    written = [*(case.exact_state or start[:3]), *start[3:]]  # the decimals
    order = np.argsort(np.abs(times), kind="stable")
    result = reference(case.scene, written, times[order], equations.blocks)
    if result.status != "agrees":
        return None
    states = np.empty_like(result.states)
    states[order] = result.states
    blocks: Any = {name: states[:, part] for name, part in result.slices.items()}
    limits = limits_of(case.scene)
    validity = limits.along(case.scene, blocks, "at the times given") if limits else None
    parts: Any = {_first(case) if name == "omega" else name: values for name, values in blocks.items()}
    error = float(result.error.max()) + 2.0**-53
    if as_quaternion(case.blocks.get("attitude", ())):
        parts = in_quaternions(case.scene, parts)
    elif "attitude" in parts:
        parts = _with_angles(case, times, parts)
        if parts is None:
            return None
        # phi and theta magnify the rounding of the quaternion
        error += 2.0**-51 / np.abs(np.cos(parts["angles"][:, 0])).min()
    reason = ROUNDED_SERIES(fewer=result.digits[0], more=result.digits[1],
                            error=Quantity(float(result.error.max()), digits=1))
    run = Simulation(times, parts, "exact", MANY, None, counters={"multiplications": result.work},
                     reason=reason, validity=validity)
    return _told(run, request, error, reason)


def _with_angles(case: Any, times: np.ndarray, parts: dict[str, np.ndarray]) -> dict[str, np.ndarray] | None:
    """Angles and momentum in place of the quaternion: turns counted by a run in doubles; None where it is too
    far off to count."""
    nearby, q = _integrated(case, times, *OWN), parts.pop("attitude")
    if nearby.status != "reached":
        return None
    ways = [out + 2 * np.pi * np.round((nearby.state["angles"] - out) / (2 * np.pi))
            for out in (angles(q), beyond(angles(q)))]
    gaps = [np.abs(route - nearby.state["angles"]).max(axis=1, keepdims=True) for route in ways]
    if np.minimum(*gaps).max() > COUNTED:
        return None
    result = np.where(gaps[0] <= gaps[1], *ways)
    first = {name: parts.pop(name) for name in ("omega", "gamma") if name in parts}
    return (first | {"angles": result, "momentum": to_space(q, body_momentum(case.scene, first | parts))}
            | parts)
