"""How a motion that loses energy ends, and when: one answer for every view.

Inside a free body something takes energy and keeps the angular momentum: `flat_spin` has the end and its
times. From outside a torque takes both. Then a function that only falls along the motion tells when it is
near its end, so that each time is the one root of a monotone function:

    T/T(0), where it tends to rest,
    (T - E)/(T(0) - E), E = (H . gamma)^2/(2 D1), under eddy currents alone (`equilibrium.dissipative`),
    V/V(0), V = delta . D delta/2, where one equilibrium draws every motion, delta the departure from it.

The body is within a share s of its end once that function is s^2. Elsewhere a run is followed until its rates
stay: at a state whose eigenvalues are zero or on the left, and each of those fast against the time for which
the rates were seen to stay."""
from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ...equilibrium.dissipative import decay, drawn_to
from ...errors import InputError, Kind, refusal_of
from ...integrate.trajectory import root_between
from ...numbers.vectors import Float3, dot
from ...orbit.result import Fate, Motion
from ...physics.coefficients import Content, content, loses
from ...physics.scene import AnyScene, later, slices
from ...physics.states import equations_and_start, moved_row, start_of
from ...physics.to_numpy import System, to_numpy
from ...reasons import Axis, Momentum, Rate, Reasoned, Sentence
from ...representation import Compared, Shown
from ...unreduced.bounds import OPEN_DIRECTION, OPEN_ROTATION, TAKES_ALL
from ..passage import MOVED, WIDER
from ..simulate import trajectory
from . import gyrostat as gyrostats
from . import mass
from .flat_spin import ACROSS, POSITIVE, SECOND_RTOL, UNDECIDED, FlatSpin, of_case
from .gyrostat import GyrostatSpin
from .spinner import Spinner
from .time_constants import TimeConstant, near_rest_across, time_constants
from .times import Time

if TYPE_CHECKING:
    from ...case.read import Case

WITHIN = math.radians(5)  # of the nutation angle
HUGE = 1e100  # rad/s, and one over it: rates beyond it have squares and fourth powers that are no doubles
END_REACHED = 0.01  # of the rates, or of the departure from the end
RUN_STEPS = 2_000_000  # of a run of a body that something outside acts on
FEWER = 100_000  # of one that is followed until its rates stay, whatever they do
POLISHED = 5  # steps of Newton to the equilibrium by which they stay
ENOUGH = 20_000  # steps, by which a pace is known
FORECAST = 4  # times RUN_STEPS: a run that would need more is given up at once
SAMPLES = 400  # of a part of a run
STAYS = 1e-4  # of the largest rate: what is left of a change
STILL = 1e-9  # of the fastest eigenvalue: one that is zero
FADED = 8.0  # time constants for which the rates stay
NO_MOMENTUM = Sentence("no-angular-momentum", "the angular momentum is zero and stays, and the energy falls "
                       "until all is at rest")()
TOO_FAR = Sentence("no-run-of-such-rates",
                   "no run is made of rates of {rate}, of which squares are no doubles")
ENERGY_FALLS = Sentence("energy-only-falls",
                        "the kinetic energy only falls, and the motion tends to rest")()
ONE_EQUILIBRIUM = Sentence("one-equilibrium-draws", "one equilibrium draws every motion")()
ABOUT_FIELD = Sentence(
    "ends-about-the-field", "H . γ = {momentum} stays and the energy falls to the least at it, of rotation "
    "about the field and {axis}, that of the largest moment, but for a set of measure zero (LaSalle)")
RUN_TURNS = Sentence("run-ends-turning", "a run ends turning in its {side} direction")
RESTS_UNSEEN = Sentence("rest-not-met", "it tends to rest; a run did not come near it")()
NO_REST = Sentence("rates-do-not-stay", "where it tends is not proved, and the rates of a run of {steps} "
                   "steps do not stay")
RESTS_SEEN = Sentence("rest-met", "it tends to rest; a run says when it is near")()
RUN_RESTS = Sentence("run-rests", "a run comes to rest")()
RUN_STAYS = Sentence("run-stays", "a run comes to rates that stay, next to which no eigenvalue is on the "
                     "right")()


@dataclass(frozen=True, eq=False, repr=False)
class Ending(Shown, Compared, Reasoned):
    """How a motion ends that loses energy, and when.

    kind: "flat spin", "nutation dies out", "rest", "rotation about the field", "steady rotation" or
    "undecided". level: of the kind and the rates, "exact", "run" or "undecided"; reason: how it is known.
    axis: 1 to 3, about which it ends turning, 0 across all or at rest; minor: the axis of the least moment of
    a free body, else 0; sense: +1 or -1 of the turn, 0 where undecided. rate: |omega| in the end, rad/s;
    rates: along the principal axes, None where undecided. within: how near "settles" is: rad of nutation of a
    free body, of one with wheels of the angle of H to its end in the body (`angular`), else a share of its
    rates or of its departure from the end. times: (name, `Time`) in their order, of those that lie ahead:
    "leaves" (the nutation exceeds `within` from the minor axis), "crosses" (the separatrix), "settles" (it
    is within `within` of its end, where it stays), "tenth" (the nutation is a
    tenth of that at the start, where it stays). nutation: rad, at the start, where it dies out; growth,
    decay: s, time constants of the nutation. at_the_latest: s, proved, by when it has settled; estimate: s,
    where a run to "settles" would take too many steps: at the pace that it goes at first. constants: time
    constants of small departures from the end, the longest first; empty where the end is not known.
    displacement: m, of a damper's mass in the end, None where there is none.
    """

    kind: str
    level: str
    axis: int = 0
    minor: int = 0
    sense: int = 0
    rate: float | None = None
    rates: Float3 | None = None
    within: float = END_REACHED
    times: tuple[tuple[str, Time], ...] = ()
    nutation: float | None = None
    growth: float | None = None
    decay: float | None = None
    at_the_latest: float | None = None
    estimate: float | None = None
    constants: tuple[TimeConstant, ...] = ()
    angular: bool = False
    displacement: float | None = None

    def time(self, name: str) -> float | None:
        """One of its times, s."""
        return dict(self.times)[name].at if name in dict(self.times) else None

    @property
    def until(self) -> float | None:
        """By when all is over that the times tell of, s."""
        return max((item.at for _, item in self.times), default=None)


def with_end(case: Case, motion: Motion) -> Motion:
    """The motion of a case with how it ends; its reason no longer says that a direction, or a rotation, is
    open which a run shows."""
    result, reason = ending(case, motion), motion.reason
    if result is not None and result.sense:
        reason = reason.without(OPEN_DIRECTION)
    if result is not None and result.kind != "undecided":
        reason = reason.without(OPEN_ROTATION)
    if result is not None and result.reason == NO_MOMENTUM:  # exactly; in doubles a little may be left
        reason = TAKES_ALL(part="the damper")
    return replace(motion, ending=result, reason=reason)


def ending(case: Any, motion: Motion) -> Ending | None:
    """How the bounded motion of a case ends, at times counted from its start; None where nothing takes energy
    from it, or it is an equilibrium. motion: what else is known of it."""
    scene = case.scene
    if motion.fate != Fate.BOUNDED or case.variables != "physical" or not loses(scene):
        return None
    parts = content(scene)
    if parts is None or not parts.dissipative:
        return None
    size = math.hypot(*case.state[:3])
    if size and not 1 / HUGE < size < HUGE:
        return Ending("undecided", "undecided", reason=TOO_FAR(rate=Rate(size)))
    if _free(parts):
        if any(parts.Lambda):
            return _among_rotations(case, gyrostats.of_case(case, WITHIN))
        return _inside(case)
    if (result := _with_mass(case, parts)) is not None:
        return result
    start = equations_and_start(scene, start_of(scene, case.state, case.blocks))[1]
    return _outside(scene, parts, start, motion)


def _free(parts: Content) -> bool:
    """Whether a body alone carries what takes its energy, with an angular momentum that it keeps."""
    if parts.movers and (parts.displaced or not parts.all_is_damped):
        return False
    return not _from_outside(parts) and (parts.damper_inside if any(parts.Lambda) else len(set(parts.D)) > 1)


def _from_outside(parts: Content) -> bool:
    """Whether something acts on the body that may change its angular momentum."""
    return bool(any(parts.M) or any(parts.u) or parts.c or parts.damped or parts.directed or parts.charged)


# --- Inside a free body
def _inside(case: Any) -> Ending:
    if not any(Spinner.made(case).momentum):
        return Ending("rest", "exact", reason=NO_MOMENTUM, rate=0.0, rates=(0.0,) * 3)
    try:
        result = of_spin(of_case(case, WITHIN, spans=False))
        return replace(result, constants=_about_major(case))
    except InputError as error:  # a liquid in moments that no rigid body has
        return Ending("undecided", "undecided", reason=refusal_of(error))


def _about_major(case: Any) -> tuple[TimeConstant, ...]:
    """The time constants next to rotation about the axis of the largest moment, or one of two."""
    spinner = Spinner.made(case)
    at = [Fraction(0)] * len(spinner.start)
    at[spinner.order[0]] = Fraction(spinner.size) / spinner.moments[0]
    return time_constants(case.scene, at)


def of_spin(result: FlatSpin) -> Ending:
    """The same of a free body whose angular momentum stays."""
    names = ("leaves", "crosses", "settles", "tenth")
    ahead = [(name, item) for name in names if (item := getattr(result, name)) is not None]
    sense = 0 if result.outcome in (UNDECIDED, ACROSS) else 1 if result.outcome == POSITIVE else -1
    reason = result.reason
    for drawn in (caveat.reason for caveat in result.caveats if caveat.kind is Kind.UNCERTAIN):
        reason = reason.then(drawn)
    kind = "flat spin" if result.nutation is None else "nutation dies out"
    axis = 0 if result.outcome == ACROSS else result.axis
    times = tuple(sorted(ahead, key=lambda entry: entry[1].at))
    return Ending(kind, result.level, axis, result.minor, sense,
                  result.final_rate, result.rates, result.within, times, result.nutation, result.growth,
                  result.decay, reason=reason)


def _with_mass(case: Any, parts: Content) -> Ending | None:
    """The same of a body with a damper's mass that rotations displace; None where these are not all known."""
    if not parts.movers or not parts.displaced or _from_outside(parts):
        return None
    if not any(Spinner.made(case).momentum):
        return Ending("rest", "exact", reason=NO_MOMENTUM, rate=0.0, rates=(0.0,) * 3)
    try:
        result = mass.of_case(case, WITHIN)
    except InputError:  # wheels beside it, or no spring: a run says where it tends
        return None
    return None if result is None else _among_rotations(case, result)


def _among_rotations(case: Any, result: GyrostatSpin) -> Ending:
    """The same of a body with wheels, or a damper's mass, among the rotations at its angular momentum."""
    reason = result.reason
    for drawn in (caveat.reason for caveat in result.caveats if caveat.kind is Kind.UNCERTAIN):
        reason = reason.then(drawn)
    if result.end is None:
        return Ending("undecided", "undecided", reason=reason, within=result.within, angular=True)
    end = result.rotations[result.end]
    rate = math.hypot(*end.rates)
    ahead = (("crosses", result.crosses), ("settles", result.settles), ("tenth", result.tenth))
    times = tuple(sorted(((name, item) for name, item in ahead if item is not None),
                         key=lambda entry: entry[1].at))
    constants = () if result.rates is None else _about(case, result.rates, end.displacement)
    return Ending("steady rotation" if rate else "rest", result.level, end.axis, rate=rate,
                  rates=result.rates, within=result.within, times=times, decay=end.decay, reason=reason,
                  constants=constants, angular=True, displacement=end.displacement)


def _about(case: Any, rates: Float3, displacement: float | None) -> tuple[TimeConstant, ...]:
    """The time constants next to a rotation at which a damper's mass, if any, is displaced, m."""
    at: list[float] = [0.0] * len(Spinner.made(case).start)
    at[:3] = rates
    if displacement:
        at[slices(case.scene.blocks)["damper_mass"].start] = displacement
    return time_constants(case.scene, at, exact=False)


# --- From outside
def _outside(scene: AnyScene, parts: Content, start: np.ndarray, motion: Motion) -> Ending:
    """By a function that only falls where one is known, else by a run until the rates stay."""
    D = [float(d) for d in parts.D]
    energy = lambda states: states[:, :3] ** 2 @ np.array(D) / 2
    first = float(energy(start[None])[0])
    rests = motion.invariants.get("late_rate_bound") == 0.0
    if rests and not parts.directed and not parts.damper_inside and first > 0:
        result = Ending("rest", "exact", reason=ENERGY_FALLS, rate=0.0, rates=(0.0,) * 3)
        slowest = float(decay(parts))
        latest = math.log(1 / END_REACHED) / slowest if slowest and not any(parts.M) else None
        result = replace(result, constants=time_constants(scene, [0] * len(start)))
        return _timed(replace(result, at_the_latest=latest), scene, start, lambda y: energy(y) / first)[0]
    if _field_alone(parts):
        return _about_the_field(scene, parts, start, energy, first)
    end = drawn_to(parts)
    if end is not None:
        apart = lambda y: (y[:, :3] - np.array(end)) ** 2 @ np.array(D) / 2
        begun = float(apart(start[None])[0])
        result = Ending("steady rotation", "exact", reason=ONE_EQUILIBRIUM,
                       rate=math.hypot(*end), rates=end,
                       constants=time_constants(scene, (*end, *[0.0] * (len(start) - 3)), exact=False))
        return _timed(result, scene, start, lambda y: apart(y) / begun)[0] if begun > 0 else result
    return _settled(scene, start, rests)


def _field_alone(parts: Content) -> bool:
    """Whether eddy currents alone act on a body with one axis of the largest moment."""
    D = sorted(parts.D)
    return bool(parts.eddy) and D[1] < D[2] and not (
        any(parts.M) or any(parts.Lambda) or any(parts.u) or any(parts.s) or parts.N or parts.E or parts.c
        or parts.damped or parts.kappa or parts.damper_inside)


def _about_the_field(scene: AnyScene, parts: Content, start: np.ndarray, energy: Callable[..., np.ndarray],
                     first: float) -> Ending:
    """The end under eddy currents: rotation about the field, whose direction along the axis a run shows."""
    gamma = start[slices(scene.blocks)["gamma"]]
    p = float(dot([float(d) * w for d, w in zip(parts.D, start[:3])], gamma.tolist()))
    axis = max(range(3), key=lambda i: parts.D[i])
    largest = float(parts.D[axis])
    lowest, rate = p * p / (2 * largest), abs(p) / largest
    reason = ABOUT_FIELD(momentum=Momentum(p), axis=Axis(axis + 1))
    result = Ending("rotation about the field", "exact", axis + 1, reason=reason, rate=rate)
    if not p:
        return replace(result, kind="rest", rates=(0.0,) * 3, constants=near_rest_across(parts))
    at = [Fraction(0)] * len(start)
    at[axis], at[slices(scene.blocks)["gamma"].start + axis] = Fraction(rate), Fraction(1)
    result = replace(result, constants=time_constants(scene, at))
    if first <= lowest * (1 + 1e-12):
        return result
    result, late = _timed(result, scene, start, lambda y: (energy(y) - lowest) / (first - lowest))
    if late is None:
        return result
    sense = 1 if late[axis] > 0 else -1
    rates = tuple(sense * rate if i == axis else 0.0 for i in range(3))
    return replace(result, level="run", sense=sense, rates=rates,
                   reason=reason.then(RUN_TURNS(side="positive" if sense > 0 else "negative")))


def _timed(result: Ending, scene: AnyScene, start: np.ndarray, fraction: Callable[[np.ndarray], np.ndarray]
           ) -> tuple[Ending, np.ndarray | None]:
    """With the time at which a share that only falls is END_REACHED^2, by two runs, and the state there."""
    t, late = _falls(scene, start, fraction, None)
    if late is None:
        return replace(result, estimate=t), None
    again, other = _falls(scene, moved_row(start, MOVED), fraction, SECOND_RTOL)
    if other is None or again is None or t is None:
        return result, None
    return replace(result, times=(("settles", Time(t, WIDER * abs(t - again) + 1e-15 * t)),)), late


def _falls(scene: AnyScene, state: np.ndarray, part: Callable[[np.ndarray], np.ndarray], rtol: float | None
           ) -> tuple[float | None, np.ndarray | None]:
    """(the time at which the share is END_REACHED^2, the state then); (an estimate or None, None) where that
    takes too many steps."""
    level, t, steps, here, ahead = END_REACHED * END_REACHED, 0.0, 0, 1.0, math.inf
    length = _quick(to_numpy(scene).jacobian(state), state)
    over = lambda after, y, times: trajectory(later(scene, after), y, times, rtol=rtol, laws=False)
    while steps < RUN_STEPS:
        times = np.linspace(0.0, length, SAMPLES + 1)
        run = over(t, state, times)
        if run.status != "reached":
            return None, None
        shares = part(run.states)
        below = np.nonzero(shares < level)[0]
        if below.size:
            at = max(0, int(below[0]) - 1)
            begun = t + float(times[at])
            more, late = _root(run.states[at], float(times[at + 1] - times[at]), partial(over, begun),
                               lambda y: float(part(y[None])[0]) - level)
            return begun + more, late
        taken = max(1, run.counters["steps"])
        t, steps, state, before, here = t + length, steps + taken, run.states[-1], here, float(shares[-1])
        parts = math.log(here / level) / math.log(before / here) if here < before else math.inf
        ahead = t + length * parts
        if steps > ENOUGH and parts * taken > FORECAST * RUN_STEPS:
            break
        length *= 2.0
    return (ahead if math.isfinite(ahead) else None), None


def _root(state: np.ndarray, length: float, over: Callable[[np.ndarray, np.ndarray], Any],
          height: Callable[[np.ndarray], float]) -> tuple[float, np.ndarray]:
    """(the time within this length at which the height is zero, the state then)."""
    def then(s: float) -> np.ndarray:
        return over(state, np.array([s])).states[-1] if s else state
    t = root_between(height, then, 0.0, length) if height(state) > 0 else 0.0
    return t, then(t)


def _settled(scene: AnyScene, start: np.ndarray, rests: bool) -> Ending:
    """Where the rates of a run stay, and from when on they are near that."""
    form, state = to_numpy(scene), start
    largest = float(np.linalg.norm(start[:3]))
    length, t, steps = _quick(form.jacobian(start), start), 0.0, 0
    times, rates = np.zeros(1), start[None, :3]
    while steps < FEWER:
        run = trajectory(later(scene, t), state, np.linspace(0.0, length, SAMPLES + 1)[1:], laws=False)
        if run.status != "reached":
            break
        steps, state, new = steps + max(1, run.counters["steps"]), run.states[-1], run.states[:, :3]
        largest = max(largest, float(np.linalg.norm(new, axis=1).max()))
        times, rates = np.append(times, t + np.asarray(run.t)), np.concatenate([rates, new])
        t += length
        end = np.zeros(3) if rests else new[-1]
        if float(np.abs(new - end).max()) < STAYS * largest and _attracts(form.jacobian(state), length):
            at = _polished(form, state, STAYS * largest)
            result = _stays(times, rates, end if rests else _rates_of(at), STAYS * largest, rests)
            return replace(result, constants=time_constants(scene, at.tolist(), exact=False))
        length = t  # as long again
    if rests:
        return Ending("rest", "exact", reason=RESTS_UNSEEN, rate=0.0, rates=(0.0,) * 3)
    return Ending("undecided", "undecided", reason=NO_REST(steps=steps))


def _stays(times: np.ndarray, rates: np.ndarray, end: np.ndarray, small: float, rests: bool) -> Ending:
    """The answer of rates (n, 3) that stay at an end; small: what is left of a change, rad/s."""
    size = float(np.linalg.norm(end))
    away = np.linalg.norm(rates - end, axis=1) > END_REACHED * max(float(np.linalg.norm(rates[0])), size)
    result: tuple[tuple[str, Time], ...] = ()
    if away.any():
        last = int(np.nonzero(away)[0][-1])
        low, high = times[last].item(), times[last + 1].item()
        result = (("settles", Time((low + high) / 2, (high - low) / 2)),)
    if rests or size <= small:
        level, reason = ("exact", RESTS_SEEN) if rests else ("run", RUN_RESTS)
        return Ending("rest", level, reason=reason, rate=0.0, rates=(0.0,) * 3, times=result)
    return Ending("steady rotation", "run", reason=RUN_STAYS, rate=size, rates=tuple(end.tolist()),
                  times=result)


def _polished(form: System, state: np.ndarray, small: float) -> np.ndarray:
    """The equilibrium next to a state, by Newton's method; itself where that goes elsewhere."""
    at = state
    for _ in range(POLISHED):
        at = at - np.linalg.lstsq(form.jacobian(at), form(at), rcond=1e-9)[0]
    return at if np.linalg.norm(at[:3] - state[:3]) < 10 * small else state


def _rates_of(state: np.ndarray) -> np.ndarray:
    """Its rates, those that are rounding as zeros."""
    end = state[:3]
    return np.where(np.abs(end) < 1e-9 * np.linalg.norm(end), 0.0, end)


def _quick(jacobian: np.ndarray, state: np.ndarray) -> float:
    """Some of the motion's own time, s: so many units of the fastest eigenvalue, or of the rates."""
    fastest = max(float(np.abs(np.linalg.eigvals(jacobian)).max()), float(np.linalg.norm(state[:3])))
    return 100 / max(fastest, 1e-300)


def _attracts(jacobian: np.ndarray, length: float) -> bool:
    """Whether eigenvalues are zero or on the left, and these have faded over this time."""
    values = np.linalg.eigvals(jacobian)
    largest = float(np.abs(values).max())
    return all(abs(z) <= STILL * largest or z.real * length < -FADED for z in values)
