"""A free body that something inside takes energy from, exact at its start, and its motion from one level of
its energy to the next. The theory is in the text of `answers.dissipation.flat_spin`."""
from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any, Self

import numpy as np

from ...errors import InputError
from ...integrate.trajectory import root_between
from ...numbers.exact import sqrt_fraction
from ...numbers.vectors import CYCLE, dot
from ...physics.coefficients import Content, added_inside, content
from ...physics.effects.base import effect_words
from ...physics.scene import INSIDE, NO_MOTION, Scene, slices
from ...physics.states import body_momentum, equations_and_start, start_of
from ...physics.to_numpy import to_numpy
from ...reasons import Quantity, Reason, Sentence, Time
from ..simulate import trajectory

RUN_STEPS = 5_000_000  # of a run: some ten seconds
FORECAST_LIMIT = 4  # times RUN_STEPS: a forecast beyond that ends a run
SAMPLES = 200  # of a part of a run
ENDED = Sentence("run-ended", "it ended before")()
TOO_LONG = Sentence("run-too-long", "it would take some {steps} steps, {time} of the motion")
NOT_ENOUGH = Sentence("run-not-enough", "{steps} steps, to t = {time}, were not enough: 2 T/|H|² is still "
                      "{above} above the level")


def _not_known_of(parts: Content) -> str:
    """Why the end is not known with the dampers of a scene."""
    if parts.displaced:
        return ("flat-spin: a rotation displaces the mass of the damper, so that the rotations of body and "
                "mass are others than those of the body: `stabilab simulate` and `stabilab when` follow it")
    if parts.rest_of_moments <= 0:
        return "flat-spin: together the dampers may take more than the moments of the body hold"
    return ("flat-spin: some rotation that is not permanent leaves the wheel of the damper at rest in the "
            "body, as the nutation of a symmetric body does one about its axis: give the wheel another axis")


@dataclass(frozen=True)
class Spinner:
    """A scene and its start, one row; blocks: what moves inside, by name; order: axes of the greatest, the
    intermediate and the least moment."""

    scene: Scene
    start: np.ndarray
    omega: tuple[Fraction, ...]
    blocks: dict[str, tuple[Fraction, ...]]
    order: tuple[int, int, int]

    @classmethod
    def of(cls, case: Any, displaced: bool = False) -> Self:
        """displaced: whether a damper may have a mass that rotations displace."""
        scene = case.scene
        if case.state is None or case.variables != "physical":
            raise InputError("flat-spin: give the start as [motion] angular_velocity, in rad/s")
        wheel = any(scene.vector("gyrostat"))
        others = [effect.with_article for effect in scene.effects
                  if effect.takes != "inside" and effect.name != "gyrostat"]
        if outside := [effect_words(effect.name) for effect in scene.effects if effect.takes == "outside"]:
            raise InputError(f"flat-spin: {' and '.join(outside)}: a torque from outside, which changes the "
                             "angular momentum, too, so that no flat spin need be the end: `stabilab "
                             "classify` says where the motion tends")
        if others or not any(effect.takes for effect in scene.effects):
            raise InputError(
                f"flat-spin: it is known of a free body; this one has {', '.join(others)} besides" if others
                else "flat-spin: nothing takes energy here, and a rigid body turns about its minor axis for "
                     "ever: give [effects.viscous_damper], with inertia and coefficient; its rotations at "
                     'one angular momentum: --momentum "100 N m s"')
        D = scene.body.exact
        if D[0] == D[1] == D[2] and not wheel and not displaced:
            raise InputError("flat-spin: all moments are equal: every axis is a major axis")
        parts = content(scene)
        if not displaced and parts is not None and parts.movers and (
                parts.displaced or parts.rest_of_moments <= 0 or not parts.all_is_damped and not parts.kappa):
            raise InputError(_not_known_of(parts))
        if 2 * max(D) > sum(D) and scene.effect("liquid_cavity"):
            raise InputError("flat-spin: a liquid takes energy for the moments of a rigid body alone, and no "
                             "rigid body has these")
        result = cls.made(case)
        if not wheel and not any(result.momentum):
            raise InputError("state: the angular momentum is zero, so that the body comes to rest; give an "
                             "angular_velocity")
        return result

    @classmethod
    def made(cls, case: Any) -> Self:
        """Of a case that is known to be asked for."""
        scene = case.scene
        D = scene.body.exact
        own = {name: value for name, value in case.blocks.items() if name in scene.blocks}
        start = equations_and_start(scene, start_of(scene, case.state, own))[1]
        blocks = {name: tuple(map(Fraction, case.blocks.get(name, NO_MOTION[name])))
                  for name in INSIDE if name in scene.blocks}
        return cls(scene, start, tuple(case.exact_state), blocks,
                   tuple(sorted(range(3), key=lambda i: -D[i])))  # type: ignore[arg-type]

    @property
    def right_handed(self) -> bool:
        """Whether the major, the intermediate and the minor axis, each in its positive direction, are."""
        return self.order[1] == CYCLE[self.order[0]][0]

    @cached_property
    def inside(self) -> Fraction:
        """The moment of inertia of a sphere that turns inside the body."""
        damper = self.scene.effect("viscous_damper")
        return damper.exact[0] if damper else Fraction(0)

    @property
    def moves_inside(self) -> bool:
        """Whether something moves inside the body at the start."""
        return any(map(any, self.blocks.values()))

    @cached_property
    def added(self) -> Any:
        """(momentum, energy) of that, exact."""
        return added_inside(self.scene.effects, self.omega, self.blocks)

    @cached_property
    def momentum(self) -> tuple[Fraction, ...]:
        """H, exact."""
        return tuple(d * w + h for d, w, h in zip(self.scene.body.exact, self.omega, self.added[0]))

    @cached_property
    def energy(self) -> Fraction:
        """T, exact."""
        own = sum((d * w * w for d, w in zip(self.scene.body.exact, self.omega)), Fraction(0)) / 2
        return own + self.added[1]

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
        item, two, three = self.inverses

        def largest(location: int, still: int) -> float:
            """The largest real part of the eigenvalues at the rotation about an axis, but for those that are
            zero."""
            at = np.zeros(len(self.start))
            at[self.order[location]] = self.size * self.inverses[location]
            values = sorted(np.linalg.eigvals(to_numpy(self.scene).jacobian(at)), key=abs)[still:]
            result = float(max(value.real for value in values))
            return result if abs(result) > 1e-13 * max(map(abs, values)) else 0.0
        minor = largest(2, 1) if three > two else 0.0
        major = largest(0, 2 if item == two else 1)
        return 1 / minor if minor > 0 else None, -1 / major if major < 0 else None

    def ahead(self, ratio: float, level: float) -> float:
        """About how long it takes to fall from one 2 T/|H|^2 to another, s, at the pace of the nutation near
        the axes; 0 where none is known."""
        item, two, three = self.inverses
        near_minor = level >= two > item
        tau = self.constants[0 if near_minor else 1]
        gaps = ((three - level, three - ratio) if near_minor else (ratio - item, level - item))
        return tau / 2 * math.log(max(1.0, gaps[0] / gaps[1])) if tau and gaps[1] > 0 else 0.0

    def ratios(self, states: np.ndarray) -> np.ndarray:
        """2 T/|H|^2 of states (..., N)."""
        laws = to_numpy(self.scene).invariants(states)
        return laws["energy"] / laws["momentum"]

    def direction(self, state: np.ndarray) -> int:
        """The sign of H along the major axis."""
        blocks = {name: state[part] for name, part in slices(self.scene.blocks).items()}
        return int(np.sign(body_momentum(self.scene, blocks)[self.order[0]]))

    def directions(self, states: np.ndarray) -> np.ndarray:
        """The signs (n,) of H along the major axis of states (n, N)."""
        blocks = {name: states[:, part] for name, part in slices(self.scene.blocks).items()}
        return np.sign(body_momentum(self.scene, blocks)[:, self.order[0]]).astype(int)

    def levels(self, angle: float) -> dict[str, float]:
        """2 T/|H|^2 at which the polhode goes from the minor axis by an angle, at the separatrix, and from
        the major axis (two greatest moments equal: from their plane) by the angle; inf: there is none."""
        D1, D2, D3 = self.moments
        (item, two, three), fraction = self.inverses, math.sin(angle) ** 2
        return {"leaves": three - fraction * float(1 / D3 - 1 / D2) if D2 > D3 else math.inf,
                "crosses": two if D1 > D2 else math.inf,
                "settles": item + fraction * float(1 / (D2 if two > item else D3) - 1 / D1)}


class Run:
    """A motion followed forward, from one level of 2 T/|H|^2 to the next."""

    def __init__(self, spinner: Spinner, state: np.ndarray, rtol: float | None,
                 most: int = RUN_STEPS, pace: float | None = None) -> None:
        self.spinner, self.state, self.rtol, self.most = spinner, state, rtol, most
        self.t, self.steps, self.validity = 0.0, 0, None
        self.why: Reason | None = None
        # a body at rest round something that turns is soon as fast as at its end
        self.length = 100 / (max(float(np.linalg.norm(state[:3])), spinner.size / float(spinner.moments[0]))
                             if pace is None else pace)

    def over(self, state: np.ndarray, times: np.ndarray) -> Any:
        return trajectory(self.spinner.scene, state, times, rtol=self.rtol, laws=False)

    def falls(self, level: float) -> float | None:
        """The time at which the level is reached; None, with why, where the run ends before."""
        while self.steps < self.most:
            times = np.linspace(0.0, self.length, SAMPLES + 1)
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
            if (more := wait * taken / self.length) > FORECAST_LIMIT * self.most:
                self.why = TOO_LONG(steps=Quantity(more, digits=1), time=Time(wait, digits=1))
                return None
            self.length *= min(2.0, max(0.1, (self.most - self.steps) / taken))
        ahead = float(self.spinner.ratios(self.state)) - level
        self.why = NOT_ENOUGH(steps=self.steps, time=Time(self.t),
                              above=Quantity(ahead, "1/(kg m^2)", digits=3))
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


PASSED = 4  # samples of half a turn about the minor axis, at least


def after_the_separatrix(spinner: Spinner, state: np.ndarray, until: float) -> tuple[int, int]:
    """(the side on which a motion is past the separatrix, how often its angular momentum changed sides along
    the major axis before); (0, 0) where it is not past it. until: about when it crosses, s."""
    run, span, passed = Run(spinner, state, None), 1.02 * until, 0
    item, two, three = spinner.inverses
    quick = spinner.size * math.sqrt((three - item) * (three - two))
    side = spinner.direction(state)
    for _ in range(60):
        samples = 1 + math.ceil(span * quick / math.pi * PASSED)
        states = run.over(state, np.linspace(0.0, span, samples + 1)[1:]).states
        sides = [side, *filter(None, spinner.directions(states).tolist())]
        passed += sum(a != b for a, b in zip(sides, sides[1:]) if a)
        state, side = states[-1], sides[-1]
        if float(spinner.ratios(state)) < two:
            return side, passed
        span = span * 0.05 if span > until else span * 1.5
    return 0, 0
