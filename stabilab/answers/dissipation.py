"""What internal dissipation makes of a spin: when a body tumbles from its minor axis, and about which
direction of the major axis it ends.

The body is free but for what takes energy from it. It is exact at its start, and followed from one level of
its energy to the next.

A damper or a liquid keeps the angular momentum H and takes kinetic energy T. With D1 > D2 > D3 the principal
moments of the whole,

    |H|^2/(2 D1) <= H . D^-1 H/2 <= T,

since T is least, at given H, where nothing turns relative to the body. So once 2 T D2 < |H|^2 (past the
separatrix) H . D^-1 H < |H|^2/D2 for ever: H stays in the cone about +axis 1 or in that about -axis 1, and as
T falls at every motion but the permanent rotations it tends to that axis (LaSalle). T crosses any level once:
each of the times below is the one root of a monotone function. The polhode of the same T and |H| goes from
an axis at most by the angle theta,

    sin^2 theta = (2T/|H|^2 - 1/D1)/(1/D2 - 1/D1)  from the major axis,
                  (1/D3 - 2T/|H|^2)/(1/D3 - 1/D2)  from the minor axis: the nutation angle of an energy sink.

Which cone it is depends on the phase: while H circles the minor axis its component along axis 1 changes sign
every half turn, and the separatrix is crossed within one of them. Turned by pi about the minor axis a motion
ends in the other direction (the equations are symmetric), so that the two directions share the phases in
equal parts; in the nutation angle, or in the strength of the damper, the bands shrink with the damping."""
from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property, reduce
from operator import getitem
from typing import Any

import numpy as np

from ..case.read import with_data
from ..case.source import parsed
from ..errors import Caveat, InputError, Kind
from ..integrate.trajectory import root_between
from ..numbers.exact import sqrt_fraction
from ..numbers.units import ANGLE, in_si
from ..numbers.vectors import Float3, cross, dot
from ..physics.effects.base import effect_words
from ..physics.scene import Scene, slices
from ..physics.states import body_momentum, equations_and_start, moved_row, start_of
from ..physics.to_numpy import to_numpy
from ..reasons import old
from ..representation import Compared, Shown
from ..validation import checked_case
from .caveats import of_law
from .passage import MOVED, WIDER
from .simulate import trajectory

# --- The body, and its motion from one level of the energy to the next
TAKE = ("viscous_damper", "liquid_cavity")  # energy, and keep the angular momentum
TAKE_BOTH = ("resistance", "rate_damper", "eddy_currents")
STEPS = 5_000_000  # of a run: some ten seconds
PATIENCE = 4  # times STEPS: a forecast beyond that ends a run
POINTS = 200  # of a part of a run


@dataclass(frozen=True)
class Spinner:
    """A scene and its start, one row; order: axes of the greatest, the intermediate and the least moment."""

    scene: Scene
    start: np.ndarray
    omega: tuple[Fraction, ...]
    sigma: tuple[Fraction, ...]
    order: tuple[int, int, int]

    @classmethod
    def of(cls, case: Any) -> Spinner:
        scene = case.scene
        if case.state is None or case.variables != "physical":
            raise InputError("flat-spin: give the start as [motion] angular_velocity, in rad/s")
        others = [one.with_article for one in scene.effects if one.name not in TAKE]
        if outside := [effect_words(one.name) for one in scene.effects if one.name in TAKE_BOTH]:
            raise InputError(f"flat-spin: {' and '.join(outside)}: a torque from outside, which changes the "
                             "angular momentum, too, so that no flat spin need be the end: `stabilab "
                             "classify` says where the motion tends")
        if others or not scene.effects:
            raise InputError(
                f"flat-spin: it is known of a free body; this one has {', '.join(others)} besides" if others
                else "flat-spin: nothing takes energy here, and a rigid body turns about its minor axis for "
                     "ever: give [effects.viscous_damper], with inertia and coefficient")
        D = scene.body.exact
        if D[0] == D[1] == D[2]:
            raise InputError("flat-spin: all moments are equal: every axis is a major axis")
        if 2 * max(D) > sum(D) and scene.effect("liquid_cavity"):
            raise InputError("flat-spin: a liquid takes energy for the moments of a rigid body alone, and no "
                             "rigid body has these")
        own = {name: value for name, value in case.blocks.items() if name in scene.blocks}
        start = equations_and_start(scene, start_of(scene, case.state, own))[1]
        sigma = case.blocks.get("damper", (0.0,) * 3) if "damper" in scene.blocks else (0.0,) * 3
        found = cls(scene, start, tuple(case.exact_state), tuple(map(Fraction, sigma)),
                    tuple(sorted(range(3), key=lambda i: -D[i])))  # type: ignore[arg-type]
        if not any(found.momentum):
            raise InputError("state: the angular momentum is zero, so that the body comes to rest; give an "
                             "angular_velocity")
        return found

    @cached_property
    def inside(self) -> Fraction:
        """The moment of inertia of what turns inside the body."""
        damper = self.scene.effect("viscous_damper")
        return damper.exact[0] if damper else Fraction(0)

    @cached_property
    def momentum(self) -> tuple[Fraction, ...]:
        """H, exact."""
        return tuple(d * w + self.inside * s
                     for d, w, s in zip(self.scene.body.exact, self.omega, self.sigma))

    @cached_property
    def energy(self) -> Fraction:
        """T, exact."""
        return (sum(d * w * w for d, w in zip(self.scene.body.exact, self.omega)) / 2
                + self.inside * (dot(self.omega, self.sigma) + dot(self.sigma, self.sigma) / 2))

    @cached_property
    def moments(self) -> tuple[Fraction, Fraction, Fraction]:
        """D1 >= D2 >= D3."""
        D = self.scene.body.exact
        return tuple(D[i] for i in self.order)  # type: ignore[return-value]

    @cached_property
    def inverses(self) -> tuple[float, float, float]:
        return tuple(float(1 / d) for d in self.moments)  # type: ignore[return-value]

    @cached_property
    def ratio(self) -> Fraction:
        """2 T/|H|^2 at the start, exact: between 1/D1 and 1/D3 but for what turns inside."""
        return 2 * self.energy / dot(self.momentum, self.momentum)

    @cached_property
    def size(self) -> float:
        """|H|, N m s."""
        return float(sqrt_fraction(dot(self.momentum, self.momentum)))

    @cached_property
    def constants(self) -> tuple[float | None, float | None]:
        """Time constants of the nutation near the minor and the major axis, s, by eigenvalues."""
        one, two, three = self.inverses

        def largest(place: int, still: int) -> float:
            """The largest real part of the eigenvalues at the rotation about an axis, but for those that are
            zero."""
            at = np.zeros(len(self.start))
            at[self.order[place]] = self.size * self.inverses[place]
            values = sorted(np.linalg.eigvals(to_numpy(self.scene).jacobian(at)), key=abs)[still:]
            found = float(max(value.real for value in values))
            return found if abs(found) > 1e-13 * max(map(abs, values)) else 0.0
        minor = largest(2, 1) if three > two else 0.0
        major = largest(0, 2 if one == two else 1)
        return 1 / minor if minor > 0 else None, -1 / major if major < 0 else None

    def ahead(self, ratio: float, level: float) -> float:
        """About how long it takes to fall from one 2 T/|H|^2 to another, s, at the pace of the nutation near
        the axes; 0 where none is known."""
        one, two, three = self.inverses
        near_minor = level >= two > one
        tau = self.constants[0 if near_minor else 1]
        gaps = ((three - level, three - ratio) if near_minor else (ratio - one, level - one))
        return tau / 2 * math.log(max(1.0, gaps[0] / gaps[1])) if tau and gaps[1] > 0 else 0.0

    def ratios(self, states: np.ndarray) -> np.ndarray:
        """2 T/|H|^2 of states (..., N)."""
        laws = to_numpy(self.scene).invariants(states)
        return laws["energy"] / laws["momentum"]

    def direction(self, state: np.ndarray) -> int:
        """The sign of H along the major axis."""
        blocks = {name: state[part] for name, part in slices(self.scene.blocks).items()}
        return int(np.sign(body_momentum(self.scene, blocks)[self.order[0]]))

    def levels(self, angle: float) -> dict[str, float]:
        """2 T/|H|^2 at which the polhode goes from the minor axis by an angle, at the separatrix, and from
        the major axis (two greatest moments equal: from their plane) by the angle; inf: there is none."""
        D1, D2, D3 = self.moments
        (one, two, three), share = self.inverses, math.sin(angle) ** 2
        return {"leaves": three - share * float(1 / D3 - 1 / D2) if D2 > D3 else math.inf,
                "crosses": two if D1 > D2 else math.inf,
                "settles": one + share * float(1 / (D2 if two > one else D3) - 1 / D1)}


class Run:
    """A motion followed forward, from one level of 2 T/|H|^2 to the next."""

    def __init__(self, spinner: Spinner, state: np.ndarray, rtol: float | None) -> None:
        self.spinner, self.state, self.rtol = spinner, state, rtol
        self.t, self.steps, self.why, self.validity = 0.0, 0, "", None
        self.length = 100 / float(np.linalg.norm(state[:3]))

    def over(self, state: np.ndarray, times: np.ndarray) -> Any:
        return trajectory(self.spinner.scene, state, times, rtol=self.rtol, laws=False)

    def falls(self, level: float) -> float | None:
        """The time at which the level is reached; None, with why, where the run ends before."""
        while self.steps < STEPS:
            times = np.linspace(0.0, self.length, POINTS + 1)
            run = self.over(self.state, times)
            if run.status != "reached":
                self.why = run.reason
                return None
            taken = max(1, run.counters["steps"])
            self.steps, self.validity = self.steps + taken, run.validity
            below = np.nonzero(self.spinner.ratios(run.states) < level)[0]
            if below.size:
                return self._land(run.states, times, max(0, int(below[0]) - 1), level)
            self.t, self.state = self.t + self.length, run.states[-1]
            wait = self.spinner.ahead(float(self.spinner.ratios(self.state)), level)
            if (more := wait * taken / self.length) > PATIENCE * STEPS:
                self.why = f"it would take some {more:.1g} steps, {wait:.1g} s of the motion"
                return None
            self.length *= min(2.0, max(0.1, (STEPS - self.steps) / taken))
        ahead = float(self.spinner.ratios(self.state)) - level
        self.why = (f"{self.steps} steps, to t = {self.t:.6g} s, were not enough: 2 T/|H|^2 is still "
                    f"{ahead:.3g}/(kg m^2) above the level")
        return None

    def _land(self, states: np.ndarray, times: np.ndarray, at: int, level: float) -> float:
        """The root between two times of a part, and the state there."""
        state = states[at]
        here = lambda t: self.over(state, np.array([t])).states[-1] if t else state
        height = lambda y: float(self.spinner.ratios(y)) - level
        span = float(times[min(at + 1, len(times) - 1)] - times[at])
        t = root_between(height, here, 0.0, span) if height(state) > 0 else 0.0
        self.t, self.state = self.t + float(times[at]) + t, here(t)
        return self.t


# --- The answer
POSITIVE, NEGATIVE = "positive major axis", "negative major axis"
ACROSS, UNDECIDED = "across the minor axis", "undecided"


@dataclass(frozen=True)
class Time:
    """A time, s, known to `error`, s: what a second run from a start moved in its last places, with a coarser
    tolerance, differs by."""

    at: float
    error: float


@dataclass(frozen=True)
class Span:
    """How far one number of the start, or of the damper, may go down and up before the outcome is another;
    their sum is the width of the band of one outcome. name: "phase" (rad: the transverse angular momentum
    turned about the minor axis along the polhode), "nutation" (relative, of the sine of the nutation angle)
    or "damping" (relative, of the strength of what takes energy)."""

    name: str
    down: float
    up: float


@dataclass(frozen=True, eq=False, repr=False)
class FlatSpin(Shown, Compared):
    """What internal dissipation makes of a spin.

    outcome: "positive major axis", "negative major axis", "across the minor axis" (two greatest moments are
    equal: about some axis in their plane) or "undecided"; because: how it is known, or why it is not; level:
    "exact", "run" (a run and a second one agree) or "undecided". axis: of the greatest moment, 1 to 3, and
    minor: of the least; momentum: |H|, N m s; final_rate: |H|/(greatest moment), rad/s; rates: rad/s, along
    the principal axes, at the end, None where it is undecided or across. energy, final_energy: J, now and at
    the end.

    The nutation angle is that of the polhode: the largest angle between the angular momentum and an axis in
    the free motion of the same T and |H|. leaves: when it exceeds `within`, rad, from the minor axis;
    crosses: when the separatrix is crossed, 2 T D2 = |H|^2, D2 the intermediate moment; settles: when it is
    at most `within` from the major axis, which it then stays. Each None where it is past at the start, or not
    reached. growth, decay: s, time constants of the nutation near the minor and the major axis, by
    eigenvalues, None where there are none. spans: by how much the start may change. steps: of the first run.
    """

    outcome: str
    because: str
    level: str
    axis: int
    minor: int
    momentum: float
    final_rate: float
    rates: Float3 | None
    energy: float
    final_energy: float
    within: float
    leaves: Time | None = None
    crosses: Time | None = None
    settles: Time | None = None
    growth: float | None = None
    decay: float | None = None
    spans: tuple[Span, ...] = ()
    steps: int = 0
    caveats: tuple[Caveat, ...] = field(default=(), repr=False)

    @property
    def lost(self) -> float:
        """The energy that is lost in all, J."""
        return self.energy - self.final_energy

    @property
    def passage(self) -> float | None:
        """From leaving the minor axis to settling at the major one, s."""
        return None if self.leaves is None or self.settles is None else self.settles.at - self.leaves.at


# --- The question
LEAST = math.radians(0.01)  # of `within`: below, the energy in doubles does not tell the angle any more
DRAWN = 32  # motions from the box of uncertain numbers
SECOND_RTOL = 1e-13  # tolerance of the second run


def flat_spin(case: Any, within: Any = "5 deg") -> FlatSpin:
    """What becomes of a free body with a damper or a liquid: the direction of the major axis about which it
    ends, when it tumbles, and by how much its start decides that.

    case: with a viscous damper or a liquid cavity and nothing else that acts, and a start. within: the
    nutation angle, rad or text with a unit, from which the tumble is counted and to which it settles. Raises
    InputError for other scenes, a body at rest, equal moments, and an angle that is none.
    """
    case = checked_case(case)
    angle = float(in_si(within, ANGLE, "within"))
    if not LEAST <= angle < math.pi / 2:
        raise InputError('within: expected an angle from 0.01 deg to below 90 deg, such as "5 deg", got '
                         f"{math.degrees(angle):.6g} deg")
    found = _answered(Spinner.of(case), angle)
    own = [one for one in case.caveats if one.kind is not Kind.UNCERTAIN]
    found = replace(found, caveats=(*own, *found.caveats))
    return _over_the_box(case, found) if case.uncertain and found.outcome in (POSITIVE, NEGATIVE) else found


def _over_the_box(case: Any, found: FlatSpin) -> FlatSpin:
    """With what uncertain numbers do: undecided where motions drawn from their box end in both directions."""
    draws, ends = np.random.default_rng(1), {POSITIVE: 0, NEGATIVE: 0}
    drawn = max(4, min(DRAWN, SPAN_STEPS // max(1, found.steps)))
    for _ in range(drawn):
        data = parsed(case.path, case.text)[0]
        for one in case.uncertain:
            *tables, last = one.path
            share = Fraction(draws.uniform(-1, 1))
            reduce(getitem, tables, data)[last] = str(one.middle + one.half * share)
        spinner = Spinner.of(with_data(case.path, case.text, data))
        side = (spinner.momentum[found.axis - 1] if found.crosses is None
                else _side_of(spinner, spinner.start, found.crosses.at))
        ends[POSITIVE if side > 0 else NEGATIVE] += 1
    told = (f"of {drawn} motions drawn from their box {ends[POSITIVE]} end about the positive and "
            f"{ends[NEGATIVE]} about the negative side of axis {found.axis}")
    if all(ends.values()):
        return replace(found, outcome=UNDECIDED, level="undecided", rates=None,
                       because=f"the uncertain numbers leave it open: {told}")
    return replace(found, caveats=(*found.caveats, Caveat(
        Kind.UNCERTAIN, old(f"uncertain numbers: {told}; samples, no proof"))))


def _answered(spinner: Spinner, angle: float) -> FlatSpin:
    """The answer of one start: exactly where it rests or is past the separatrix, else by runs."""
    D1, D2, _ = spinner.moments
    size, axis = spinner.size, spinner.order[0]
    growth, decay = spinner.constants
    found = FlatSpin(
        UNDECIDED, "", "undecided", axis + 1, spinner.order[2] + 1, size, size / float(D1), None,
        float(spinner.energy), float(dot(spinner.momentum, spinner.momentum) / (2 * D1)), angle,
        growth=growth, decay=decay)
    if not any(spinner.sigma) and not any(cross(spinner.momentum, spinner.omega)):  # nothing changes
        return _at_rest(spinner, found)
    if spinner.ratio * D2 < 1 and D1 > D2:
        found = _ended(found, spinner.momentum[axis], "exact",
                       "2 T D2 < |H|^2 at the start: the separatrix is crossed already, with the angular "
                       "momentum on the {} side of axis {}, where it stays and tends to that axis")
    return _timed(spinner, found, angle)


def _ended(found: FlatSpin, direction: Fraction | int, level: str, words: str) -> FlatSpin:
    """With the rates at the end; words: why, with places for the side and the number of the axis."""
    sign, side = (1, "positive") if direction > 0 else (-1, "negative")
    rates = tuple(sign * found.final_rate if i == found.axis - 1 else 0.0 for i in range(3))
    return replace(found, outcome=POSITIVE if sign > 0 else NEGATIVE, rates=rates, level=level,
                   because=words.format(side, found.axis))


def _at_rest(spinner: Spinner, found: FlatSpin) -> FlatSpin:
    """A permanent rotation: of the greatest moment it stays for ever; any other is unstable."""
    D1, D2, _ = spinner.moments
    if spinner.ratio * D1 == 1:
        words = "the start is a permanent rotation about the greatest moment, the one with the least energy"
        if D1 == D2:
            return replace(found, outcome=ACROSS, level="exact", because=words,
                           rates=tuple(map(float, spinner.omega)))
        return _ended(found, spinner.momentum[spinner.order[0]], "exact", words)
    name = "minor" if spinner.ratio * spinner.moments[2] == 1 else "intermediate"
    return replace(found, because=(
        f"the start is exactly the rotation about the {name} axis, an equilibrium that is unstable: either "
        "direction of the major axis follows from a disturbance, however small; give a start with a nutation "
        "angle"))


def _timed(spinner: Spinner, found: FlatSpin, angle: float) -> FlatSpin:
    """The times of a motion that goes on, by two runs."""
    D1, D2, _ = spinner.moments
    ahead = {name: level for name, level in spinner.levels(angle).items() if float(spinner.ratio) >= level}
    runs = [Run(spinner, spinner.start, None),
            Run(spinner, moved_row(spinner.start, MOVED), SECOND_RTOL)]
    seen: list[dict[str, float]] = [{}, {}]
    directions = [0, 0]
    for n, run in enumerate(runs):
        for name in sorted(ahead, key=lambda name: -ahead[name]):
            if (t := run.falls(ahead[name])) is None:
                break
            seen[n][name] = t
            if name == "crosses":
                directions[n] = spinner.direction(run.state)
    first = runs[0]
    times: dict[str, Any] = {name: Time(t, WIDER * abs(t - seen[1][name]) + 1e-15 * t)
                             for name, t in seen[0].items() if name in seen[1]}
    found = replace(found, steps=first.steps, caveats=of_law(first.validity), **times)
    if found.outcome != UNDECIDED:
        return found
    why = first.why or runs[1].why
    if D1 == D2:
        return found if "settles" not in seen[0] else replace(
            found, outcome=ACROSS, level="run",
            because="two greatest moments are equal: the energy falls to that of rotation about an axis in "
                    "their plane, and which one hangs on the phase alone: the start turned about the minor "
                    "axis by an angle ends at an axis turned by that angle")
    if "crosses" not in seen[0] or "crosses" not in seen[1]:
        return replace(found, because=f"the separatrix is not crossed by the end of the run: {why}")
    if directions[0] != directions[1]:
        return replace(found, because=(
            "the start is within rounding of the boundary between the two directions: a run and a second "
            f"one, from a start moved by {MOVED:.0f} in its last place with tolerance {SECOND_RTOL:.0e}, end "
            "at opposite directions of the major axis"))
    words = ("2 T D2 falls below |H|^2 with the angular momentum on the {} side of axis {}; from then on it "
             "cannot cross, and tends to that axis; a second run, from a start moved by "
             f"{MOVED:.0f} in its last place with tolerance {SECOND_RTOL:.0e}, agrees")
    return replace(_ended(found, directions[0], "run", words), spans=_spans_of(spinner, directions[0], found))


# --- By how much the start, or what takes energy, may change before the spin ends in the other direction
SPAN_STEPS = 6_000_000  # of all runs that look for changes of the outcome
HALVINGS = 7  # of an interval with one change of the outcome: it is known to 1 %
RUNS = 12  # for one change, about
WEAKER = 0.5  # of nutation or damping: the least that is tried
FINEST = 2.0**-30  # of the first change tried: a closer one is the second run's


def _spans_of(spinner: Spinner, direction: int, found: FlatSpin) -> tuple[Span, ...]:
    """The bands of one outcome about the start, where the motion begins about the minor axis."""
    one, two, three = spinner.inverses
    parts = slices(spinner.scene.blocks)
    omega = spinner.start[parts["omega"]]
    D = np.array(spinner.scene.body.inertia)
    L = D * omega
    i, j, k = spinner.order
    weight = np.sqrt([three - one, three - two])
    across = weight * L[[i, j]]
    room = float(np.sqrt(weight[1] ** 2 * (L @ L) / max(across @ across, 1e-300)))  # times nutation
    if found.crosses is None or room <= 1 or not L[k]:
        return ()
    until = found.crosses.at
    # a stronger sphere must still fit into the body
    stronger = min(1.0, 0.99 * float(spinner.moments[2] / spinner.inside - 1)) if spinner.inside else 1.0

    def moved(angle: float = 0.0, share: float = 0.0) -> np.ndarray:
        """The start turned along its polhode by an angle, its nutation greater by a share."""
        c, s = math.cos(angle), math.sin(angle)
        turn = np.array([[c, -s], [s, c]])
        new, state = L.copy(), spinner.start.copy()
        new[[i, j]] = (1 + share) * (turn @ across) / weight
        new[k] = math.copysign(math.sqrt(max(0.0, L @ L - new[i] ** 2 - new[j] ** 2)), L[k])
        state[parts["omega"]] = new / D
        if "damper" in parts:
            sigma = spinner.start[parts["damper"]].copy()
            sigma[[i, j]] = turn @ sigma[[i, j]]
            state[parts["damper"]] = sigma
        return state

    def flips(state: np.ndarray, scene: Scene | None = None) -> bool:
        other = spinner if scene is None else replace(spinner, scene=scene)
        return _side_of(other, state, until) != direction

    steps = found.steps
    tried: list[tuple[str, Callable[[float], bool], float, float]] = [
        ("phase", lambda s: flips(moved(angle=s)), math.pi / 16, math.pi),
        ("nutation", lambda s: flips(moved(share=s)), 0.0, 0.99 * (room - 1)),
        ("damping", lambda s: flips(spinner.start, _stronger(spinner.scene, s)), 0.0, stronger)]
    turns = max(1.0, until * float(np.linalg.norm(omega)) / math.pi)
    spans: list[Span] = []
    for name, flipped, first, most in tried:
        if steps * RUNS * (1 if name == "phase" else 2) > SPAN_STEPS:
            continue
        first = first or min(most, 1.0) / turns
        up = _edge(flipped, first, most)
        down = (math.pi - up if name == "phase"
                else _edge(flipped, -first, min(most, WEAKER)))
        spans.append(Span(name, down, up))
    return tuple(spans)


def _stronger(scene: Scene, share: float) -> Scene:
    """The scene whose damper, inertia and coefficient, or liquid is stronger by a share."""
    more = 1 + Fraction(share)
    damper, liquid, changed = scene.effect("viscous_damper"), scene.effect("liquid_cavity"), []
    if damper is not None:
        changed.append(type(damper)(*(value * more for value in damper.exact)))
    if liquid is not None:
        changed.append(replace(liquid, P0=Fraction(liquid.P0) * more))
    return Scene(scene.body, *changed)


def _side_of(spinner: Spinner, state: np.ndarray, until: float) -> int:
    """The side on which a motion is past the separatrix."""
    run, times = Run(spinner, state, None), np.array([1.02 * until])
    for _ in range(60):
        state = run.over(state, times).states[-1]
        if float(spinner.ratios(state)) < spinner.inverses[1]:
            return spinner.direction(state)
        times = times * 0.05 if times[0] > until else times * 1.5
    return 0


def _edge(flips: Callable[[float], bool], first: float, most: float) -> float:
    """The size of the smallest change, of the sign of `first`, of which the outcome is another, to 1 %; inf
    where there is none up to `most`. Bands of one outcome are about equally wide, so that doubling the change
    passes over none."""
    sign = math.copysign(1.0, first)
    low = high = min(abs(first), most)
    if flips(sign * high):
        while flips(sign * (low := high / 2)):
            high = low
            if high < FINEST * abs(first):
                return high
    else:
        while not flips(sign * (high := min(2 * low, most))):
            if high >= most:
                return math.inf
            low = high
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (low, middle) if flips(sign * middle) else (middle, high)
    return (low + high) / 2
