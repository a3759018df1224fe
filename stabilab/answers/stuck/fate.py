"""The fate of a motion with a stuck thruster, the time to its limit, and the momenta of a wheel that keep
it bounded.

The thruster gives one torque of any direction. Where that lasts, all intervals of a wheel's momentum that
keep the motion bounded are found by roots; where there are none, the momentum that delays the limit most."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeAlias, cast

import numpy as np

from ...errors import InputError
from ...numbers.exact import sqrt_fraction
from ...numbers.polynomial import golden_section
from ...numbers.principal import (
    IDENTITY,
    NOTHING,
    PrincipalAxes,
    clearly_oblique,
    summed,
    without_trace,
)
from ...numbers.vectors import Exact3, Float3, Number, cross, dot
from ...orbit.fate import REASONS, Basis
from ...orbit.reduction import Reduction
from ...orbit.result import Fate, Motion
from ...physics.body import Body
from ...physics.effects import effect_class
from ...physics.scene import Scene, rests
from ...reasons import Reason, Reasoned, Sentence
from ...unreduced.enclosure import proved
from ...unreduced.spin_up.follow import spin_up, spin_up_many
from ...validation import came
from ..kinds import kind_of, one
from ..limit import Limit, asked
from ..never_reached import NEVER_AT_REST
from ..passage import Found, largest_rate, run_once
from ..time_to import of_one
from ..when import limit_of
from .line import EVERY, INF, Family, Intervals, Line, candidates, family_of, own_momentum, pieces

if TYPE_CHECKING:
    from ...unreduced.spin_up.result import SpinUp


NO_TORQUE = Sentence(
    "wheel-without-torque", "no torque acts: the energy is constant, whatever the wheel does")()
LEFT_ALONG = Sentence(
    "momentum-left-along", "with any momentum left along the torque |H|²/2 - D T grows for ever; at one "
    "momentum none is left")()
OTHERS_ALONG = Sentence(
    "momentum-of-others-along", "momentum of the others lies along the torque: |H|²/2 - D T then grows for "
    "ever, whatever this wheel does")()
SPHERE_ACROSS = Sentence(
    "sphere-bounded-across", "three equal moments: bounded where the wheels' momentum is across the torque "
    "and not zero")()
ONLY_EQUILIBRIA = Sentence(
    "off-axes-only-equilibria", "the torque is off the principal axes, and no bounded motion is known there "
    "but equilibria")()
NOT_ISOLATED = Sentence(
    "momenta-not-isolated", "not known: the balls did not isolate the momenta at which the start lies on a "
    "separatrix")()
ENDS_ARE_TIES = Sentence(
    "momenta-end-on-separatrix", "the ends are momenta at which the start lies on a separatrix: of "
    "{candidates} candidates, isolated as roots, those where the exact fate changes")
WALLED = Sentence(
    "walls-bound-all", "the torque is on {where}: the potential has walls on both sides, so every motion is "
    "bounded but for a set of measure zero")
ALWAYS_LOOSE = Sentence(
    "walls-never-hold", "not known: {walls}, in which the start lies with every momentum of this wheel")


# --- A case with its thrusters stuck one way or another: what turns the body then
@dataclass(frozen=True)
class Scenario:
    """What a case says, ready to be asked with any torque and any wheel momentum; vectors exact, along the
    scene's axes.

    state: rad/s; base: torque of the case without its thrusters, N m; wheel: N m s; limit: rad/s, a number,
    three (frame of the file) or None; thrusters, wheels: as the case holds them, in the frame of the file.
    """

    case: Any
    body: Body
    axes: PrincipalAxes
    state: Exact3
    base: Exact3
    wheel: Exact3
    limit: float | Float3 | None

    def scene(self, torque: Sequence[Fraction], wheel: Sequence[Fraction] | None = None) -> Scene:
        """The scene under a torque (N m), with another wheel momentum (N m s) where one is given."""
        wheel = without_trace(tuple(self.wheel if wheel is None else wheel), tuple(torque))
        return Scene(self.body, effect_class("gyrostat")(wheel),
                     effect_class("constant_torque")(tuple(torque)))

    @cached_property
    def free(self) -> Scene:
        """The body alone, of runs with any torque and momentum."""
        return Scene(self.body)

    @cached_property
    def _arms(self) -> dict[str, Exact3]:
        return {t.name: self.axes.turned(t.torque) for t in self.case.thrusters}

    def arm(self, thruster: Any) -> Exact3:
        """The torque of one thruster of the case, along the scene's axes."""
        return self._arms[thruster.name]

    def torque(self, thrusters: Sequence[Any]) -> Exact3:
        """The whole torque while these thrusters fire, along the scene's axes."""
        return summed([self.base, *map(self.arm, thrusters)])

    def torque_in_file(self, thrusters: Sequence[Any]) -> Float3:
        """The same in the frame of the file; what a thruster alone gives is rounded once."""
        full = ([sum(column) for column in zip(*(t.torque for t in thrusters))] if thrusters
                 else [Fraction(0)] * 3)
        base = self.in_file(self.base) if any(self.base) else (0.0,) * 3
        return tuple(float(a) + b for a, b in zip(full, base))

    def in_file(self, vector: Sequence[Number]) -> Float3:
        """A vector along the scene's axes in the frame of the file."""
        result = self.axes.back([Fraction(v) for v in vector])
        smallest = max(map(abs, result)) * NOTHING
        return tuple(float(v) + 0.0 if abs(v) > smallest else 0.0 for v in result)

    @cached_property
    def held(self) -> tuple[int, ...]:
        """Principal axes about which a torque leaves bounded motions: no wheel momentum is along them."""
        families = [Family(self.body, i, Fraction(1), self.wheel, self.state) for i in range(3)]
        return tuple(family.axis for family in families if family.reduction(self.wheel) is not None)

    @cached_property
    def exact_limit(self) -> Limit:
        """The limit of the case along the scene's axes, exactly, where it has one."""
        result = asked(self.scene(self.base), **cast(dict[str, Any], limit_of(self.case)))
        if result.kind == "component":
            return replace(result, label="components in the frame of the file")
        return result

    @cached_property
    def begins_at_limit(self) -> bool:
        """Whether the limit is reached by the state."""
        return self.exact_limit.reached_by(self.state)

    @property
    def start(self) -> Float3:
        """The state in doubles."""
        return tuple(map(float, self.state))

    @property
    def rows(self) -> list[list[float]]:
        """Axis n of the file's frame along the scene's axes."""
        return [[float(self.axes.axes[i][n]) for i in range(3)] for n in range(3)]


def scenario_of(case: Any) -> Scenario:
    """The scenario of a case. InputError where it has no body, no motion, or effects that no stuck thruster
    is answered with."""
    if not hasattr(case, "thrusters"):
        raise InputError(f"stuck: expected a case, as of stabilab.load(...), got {came(case)}")
    if case.variables == "scaled" or case.physical is None:
        raise InputError("the motion is in scaled variables; for a stuck thruster give the body in kg m^2 "
                         "and angular_velocity in rad/s")
    if case.state is None:
        raise InputError(
            "motion: expected angular_velocity in [motion]; what a stuck thruster does depends on it")
    case.scene.quadratic()  # says which effect is not covered
    case = case if case.frame else replace(case, frame=PrincipalAxes(case.scene.body.exact, IDENTITY, True))
    axes = case.frame
    fixed = [axes.turned(t.torque) for t in case.thrusters if t.stuck]
    torque = case.scene.vector("constant_torque")
    base = tuple(m - sum(t[i] for t in fixed) for i, m in enumerate(torque))
    limits = case.limits
    limit = (None if limits is None else float(limits.rate) if limits.rate is not None
             else tuple(map(float, limits.rates)))
    return Scenario(case, case.scene.body, axes, case.exact_state, base, case.scene.vector("gyrostat"), limit)


# --- The fate and the time under one torque
# steps of a run that looks for the largest rate, and of each of many that are compared
BUDGET, SEARCHED = 100_000, 20_000
LITTLE, FEW = 2_000_000, 3_000  # multiplications and compiled steps: some tenths of a second
NEVER_AFTER = 100  # times the time without a change: a limit that is not reached by then counts as never
TURN = 1.001  # of a period: a motion that repeats is followed for so long
EXACT = ("axis", "law")  # certificates of growth that are closed solutions


NO_LIMIT = Sentence("no-limit", "no limit is asked for")()
TIME_TO_LIMIT = Sentence("time-to-limit", "the limit: {known}")


@dataclass(frozen=True)
class Outcome(Reasoned):
    """What becomes of one motion: fate, level, axis (1, 2, 3 of the scene or 0), sense, direction (scene's
    axes) and reason as in `SpinUp`.

    motion: of a scene with an orbit or a law, None elsewhere; when: what is known of the time to the limit,
    without one that it is not reached; largest: |omega| up to the limit, or for ever, rad/s, None where
    unbounded or unknown.
    """

    fate: Fate
    level: str
    axis: int
    sense: int
    direction: Float3 | None
    motion: Any
    when: Found
    largest: float | None

    @property
    def followed(self) -> float:
        """Up to where the limit is known not to be reached, s."""
        if self.motion is not None and self.fate != Fate.SPIN_UP and self.motion.period is not None:
            return math.inf
        return self.when.high if self.when.time else self.when.low


def outcome_of(scenario: Scenario, torque: Sequence[Fraction]) -> Outcome:
    """What becomes of the scenario's motion under a torque."""
    scene = scenario.scene(torque)
    if rests(scene.quadratic(), scenario.state):
        never = Found(math.inf, math.inf, "exact", reason=NEVER_AT_REST)
        return Outcome(Fate.EQUILIBRIUM, "exact", 0, 0, None, None, never,
                       math.hypot(*scenario.start), reason=REASONS[Basis.AT_REST])
    return _off_axis(scenario, scene) if kind_of(scene) == "off axis" else _by_law(scenario, scene)


def fate_under(scenario: Scenario, torque: Sequence[Fraction]) -> Fate:
    """The fate of the scenario's motion under a torque, as `outcome_of` has it, without the proof of the
    motion up to there, its time and its largest rate, which cost many times as much."""
    scene = scenario.scene(torque)
    if rests(scene.quadratic(), scenario.state):
        return Fate.EQUILIBRIUM
    if kind_of(scene) == "off axis":
        return Fate(spin_up_many(scene, [scenario.start]).fate[0])
    return one(scene).motion(scene, scenario.start, None, scenario.state).fate


def time_under(scenario: Scenario, torque: Sequence[Fraction],
               wheel: Sequence[Fraction]) -> tuple[float, float] | None:
    """The bracket of the time to the limit under a torque and a wheel momentum, s; None where it is never
    within what is known. A motion that a wheel holds up goes on for long: it is enclosed where little work
    does that, else followed by a run."""
    return _when(scenario, scenario.scene(torque, wheel), None, LITTLE, FEW).time


def first_time(scenario: Scenario, torque: Sequence[Fraction], wheel: Sequence[Fraction] | None,
               t_max: float) -> float:
    """The time at which a plain run comes to the limit, s, for searches; inf where not until t_max, and where
    its steps end before that, the time it got to."""
    if scenario.begins_at_limit:
        return 0.0
    # a run is one in doubles: long fractions would cost more than the run
    moment, momentum = (tuple(map(float, vector)) for vector in (torque, wheel or scenario.wheel))
    scene, vectors = scenario.free, [moment, momentum]
    if not clearly_oblique(momentum, moment):  # a scene drops what roundings leave of right angles
        scene, vectors = scenario.scene(*(tuple(map(Fraction, vector)) for vector in vectors)), []
    t, until = run_once(scene, scenario.start, scenario.exact_limit, t_max, SEARCHED, *vectors)
    return t if until >= t_max else until


def _off_axis(scenario: Scenario, scene: Scene) -> Outcome:
    certified = spin_up(scene, scenario.start)
    noted = proved(scene, scenario.state, certified)
    spins = noted.fate == Fate.SPIN_UP
    when = _when(scenario, scene, None if spins or noted.fate == Fate.BOUNDED else noted.t, spun=certified)
    axis, sense, direction = (noted.axis, noted.sense, noted.direction) if spins else (0, 0, None)
    return Outcome(noted.fate, "run" if noted.level == "undecided" else noted.level, axis, sense, direction,
                   None, when, _largest(scenario, scene, when, None if spins else noted.t),
                   reason=noted.reason.then(_unsure(when)))


def _by_law(scenario: Scenario, scene: Scene) -> Outcome:
    motion = one(scene).motion(scene, scenario.start, None, scenario.state)
    spins = motion.fate == Fate.SPIN_UP
    when = _when(scenario, scene, None)
    repeats = None if spins or motion.period is None else TURN * motion.period
    largest = _largest(scenario, scene, when, repeats)
    if largest is None and not spins and motion.extremes is not None and motion.for_all_time:
        bound = math.hypot(*(max(map(abs, pair)) for pair in motion.extremes))
        largest = bound if math.isfinite(bound) else None
    certificate = motion.evidence.get("certificate") if kind_of(scene) == "growth" else "law"
    level = ("run" if motion.fate == Fate.UNDECIDED or certificate in ("evidence", "none") else
             "exact" if certificate in EXACT else "certified")
    return Outcome(motion.fate, level, motion.axis, motion.sense,
                   _direction(scene, motion) if spins else None, motion, when, largest,
                   reason=motion.reason.then(_unsure(when)))


def _when(scenario: Scenario, scene: Scene, t_max: float | None, *work: Any,
          spun: SpinUp | None = None) -> Found:
    """When the limit is reached, by `time_to`; t_max: how far an undecided motion was followed, s; work,
    spun: as of `time_to.of_one`."""
    if scenario.limit is None:
        return Found(t_max or 0.0, math.nan, "run", reason=NO_LIMIT)
    end = None if t_max is None else Fraction(t_max)
    # work is no more than two
    return of_one(scene, scenario.start, scenario.state, scenario.exact_limit,  # type: ignore[misc]
                  end, *work, spun=spun, steps_first=in_steps(scene))


def in_steps(scene: Scene) -> bool:
    """Whether times are enclosed in compiled steps first: off the axes, where the proof of a fate takes these
    too."""
    return kind_of(scene) == "off axis"


def _unsure(when: Found) -> Reason | None:
    """Why no more is known of the time to the limit."""
    return None if when.time or when.never or when.reason is NO_LIMIT else TIME_TO_LIMIT(known=when.reason)


def _largest(scenario: Scenario, scene: Scene, when: Found, otherwise: float | None) -> float | None:
    """|omega| at the most until the limit is reached, or until another time (None: not given)."""
    if when.time is not None and isinstance(scenario.limit, float) and when.time[1] > 0:
        return scenario.limit
    until = when.time[1] if when.time is not None else otherwise
    if until is None:
        return None
    largest, reached = largest_rate(scene, scenario.start, until, BUDGET)
    return largest if reached >= until * (1 - 1e-12) else None


def _direction(scene: Scene, motion: Motion) -> Float3 | None:
    """Along which the rate grows: an axis; or the torque, where it lies between two equal moments."""
    if motion.axis:
        return tuple(float(motion.sense * (n == motion.axis - 1)) for n in range(3))
    torque = scene.vector("constant_torque")
    if any(scene.vector("gyrostat")) and dot(scene.vector("gyrostat"), torque):
        return None
    size = math.hypot(*map(float, torque))
    return tuple(float(m) / size for m in torque)


# --- Momenta of a wheel that keep the motion bounded
Answer: TypeAlias = tuple[Intervals, Reason]
Bracket: TypeAlias = tuple[float, float]


RANGE = 2  # times the momentum that the wheel has now, either way; one at rest is tried up to the body's own
PLACES, CLOSER = 41, 24  # momenta that are tried over the range, and nearer and nearer to the best of them
SAME = 1e-6  # relative: a run that ends so much sooner than the limit has not come to it


def intervals(scene: Scene, state: Sequence[Fraction], axis: Exact3) -> Answer:
    """(((least, greatest) momentum along a wheel's axis that keeps the motion bounded, N m s), ...), reason.

    scene: with the momentum of every other wheel in it, but not of this one; state: exact; axis: exact unit
    vector, scene's axes. An end is a number that keeps it bounded, to the last places of a double; -inf, inf
    where there is none.
    """
    torque, wheel, D = scene.vector("constant_torque"), scene.vector("gyrostat"), scene.body.exact
    if not any(torque):
        return EVERY, NO_TORQUE
    if D[0] == D[1] == D[2]:
        return _sphere(torque, wheel, axis)
    family = family_of(scene, state)
    if family is None:
        return _wheel_off_axis(scene, state, axis)
    start, step, i = family.wheel, list(family.turned(axis)), family.axis
    if not dot(torque, axis):
        step[i] = Fraction(0)  # a turn by rounded numbers leaves a trace
    if step[i]:
        s = -start[i] / step[i]
        left = [Fraction(0) if n == i else v for n, v in enumerate(family.along(start, step, s))]
        return (((float(s),) * 2,) if family.steady(left) else ()), LEFT_ALONG
    if start[i]:
        return (), OTHERS_ALONG
    return across(family, start, tuple(step))


def _sphere(torque: Sequence[Fraction], wheel: Exact3, axis: Exact3) -> Answer:
    """Three equal moments: bounded exactly if there is a wheel momentum and it is across the torque."""
    level, slope = dot(torque, wheel), dot(torque, axis)
    if slope:
        s = -level / slope
        return (((float(s),) * 2,) if any(w + s * a for w, a in zip(wheel, axis)) else ()), SPHERE_ACROSS
    if level:
        return (), SPHERE_ACROSS
    # with this, if with any, the wheels have none together
    s = next(-w / a for w, a in zip(wheel, axis) if a)
    return EVERY if any(w + s * a for w, a in zip(wheel, axis)) else without([s]), SPHERE_ACROSS


def _wheel_off_axis(scene: Scene, state: Sequence[Fraction], axis: Exact3) -> Answer:
    """Off the axes only an equilibrium is known to be bounded: M - omega x (D omega + l) = s omega x a has
    one s or none."""
    form = scene.quadratic()
    rate = form.rate(list(state))
    D = scene.body.exact
    pull = cross(axis, state)
    if not any(pull):
        return (EVERY if rests(form, state) else ()), ONLY_EQUILIBRIA
    s = next(-r * d / p for r, d, p in zip(rate, D, pull) if p)
    resting = all(r * d + s * p == 0 for r, d, p in zip(rate, D, pull))
    return (((float(s),) * 2,) if resting else ()), ONLY_EQUILIBRIA


def across(family: Family, start: Sequence[Fraction], step: Sequence[Fraction]) -> Answer:
    """The intervals, and the reason, of momenta start + s step that have no part along the torque."""
    at_0: Any  # none has a part along the torque, so both have a reduction
    at_1: Any
    at_0, at_1 = (family.reduction(family.along(start, step, s)) for s in (Fraction(0), Fraction(1)))
    if at_0.geometry.walled:
        return _between_walls(family, start, step)
    result = candidates(Line(at_0, at_1, family.state, family.state))
    if result is None:
        return (), NOT_ISOLATED
    clearly = lambda s: family.clearly(wheel=family.along(start, step, s))
    retained = pieces(clearly, Fraction(family.momentum_unit), sorted(set(result)))
    return retained, ENDS_ARE_TIES(candidates=len(result))


def _between_walls(family: Family, start: Sequence[Fraction], step: Sequence[Fraction]) -> Answer:
    """Every momentum but those at which the start lies in the set of measure zero that no wall holds: exact
    roots of a quadratic in s. A root that is not rational is no momentum that a number can give."""
    wheels = [family.along(start, step, Fraction(s)) for s in (-1, 0, 1)]
    reductions: Any = [family.reduction(wheel) for wheel in wheels]  # none has a part along the torque
    reason = WALLED(where=reductions[0].geometry.where)
    for before, at, after in zip(*(loose(reduction, family.state) for reduction in reductions)):
        a, b, c = (before + after) / 2 - at, (after - before) / 2, at
        if a or b or c:
            roots = _rational_roots(a, b, c)
            return without([s for s in roots if not family.steady(family.along(start, step, s))]), reason
    return (), ALWAYS_LOOSE(walls=reason)


def loose(reduction: Reduction, state: Sequence[Fraction]) -> tuple[Fraction, ...]:
    """Numbers that all vanish where the walls need not hold a start: on a hyperbola the invariant Q; along a
    parabola the slopes of the component that is linear in the angle, and of the force."""
    r, u, v = reduction, state[reduction.j], state[reduction.k]
    if r.geometry.centred:
        sj, sk = r.centre
        return ((v + sk) ** 2 * abs(r.p) - (u + sj) ** 2 * abs(r.q),)
    if r.p:
        return r.q0, (r.kappa * v + r.sigma) * (r.p * v + r.p0)
    return r.p0, (r.kappa * u + r.rho) * (r.q * u + r.q0)


def _rational_roots(a: Fraction, b: Fraction, c: Fraction) -> list[Fraction]:
    """Those of a s^2 + b s + c."""
    if not a:
        return [-c / b] if b else []
    square = b * b - 4 * a * c
    root = sqrt_fraction(max(square, Fraction(0)))
    return sorted({(-b - root) / (2 * a), (-b + root) / (2 * a)}) if root * root == square else []


def without(momenta: Sequence[Fraction]) -> Intervals:
    """All momenta but these, rising: each between intervals that end at its neighbours among the doubles."""
    ends = [-INF, *(math.nextafter(float(s), end) for s in momenta for end in (-INF, INF)), INF]
    return tuple(zip(ends[::2], ends[1::2]))


def delayed(scenario: Scenario, torque: Sequence[Fraction], axis: Exact3, now: Fraction, time: Bracket | None
            ) -> tuple[float, Bracket | None, float | None, Bracket, bool] | None:
    """(best momentum, N m s, bracket of its time or None, gain in s or None, the range searched, whether its
    run came to the limit), or None where there is nothing to search, or nothing better was found.

    axis: exact unit vector of the wheel, scene's axes; now: its momentum; time: bracket of the limit as
    things are.
    """
    if scenario.limit is None or time is None or time[0] <= 0:
        return None
    others, reach, until = _runs(scenario, torque, axis, now, time)
    places, times = times_over(scenario, torque, axis, now, time)
    best = int(np.argmax(times))
    s, longest = float(places[best]), times[best]
    if math.isfinite(times[best]):
        closer = golden_section(lambda s: -until(s), places[max(best - 1, 0)],
                                places[min(best + 1, PLACES - 1)], CLOSER)
        s, longest = min((s, -longest), *closer, key=lambda item: item[1])
        s, longest = float(s), -longest
    printed = time_under(scenario, torque, [w + Fraction(s) * a for w, a in zip(others, axis)])
    gain = None if printed is None else printed[0] - time[0]
    if gain is not None and gain <= 0:
        return None
    return s, printed, gain, (-reach, reach), printed is None or not longest < printed[0] * (1 - SAME)


def times_over(scenario: Scenario, torque: Sequence[Fraction], axis: Exact3, now: Fraction,
               time: Bracket) -> tuple[np.ndarray, np.ndarray]:
    """(momenta (n,) of a wheel, N m s; times (n,) at which runs with them come to the limit, s, inf where not
    within NEVER_AFTER times that of now). Arguments as of `delayed`."""
    _, reach, until = _runs(scenario, torque, axis, now, time)
    places = np.linspace(-reach, reach, PLACES)
    return places, np.array([until(s) for s in places])


def _runs(scenario: Scenario, torque: Sequence[Fraction], axis: Exact3, now: Fraction, time: Bracket
          ) -> tuple[list[Fraction], float, Callable[[Number], float]]:
    """(momentum of the other wheels, the range of this one's, the time of a run with it)."""
    others = [w - now * a for w, a in zip(scenario.wheel, axis)]
    # of a wheel at rest: up to the momentum of the body itself
    reach = (RANGE * abs(float(now))
             or own_momentum(scenario.body, scenario.start, math.hypot(*map(float, torque))))

    def until(s: Number) -> float:
        wheel = [w + Fraction(float(s)) * a for w, a in zip(others, axis)]
        return first_time(scenario, torque, wheel, NEVER_AFTER * time[0])
    return others, reach, until
