"""Which momenta of a wheel keep a motion bounded under a torque that lasts: all intervals, by roots; else the
momentum that delays the limit most."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, TypeAlias

import numpy as np

from ...numbers.exact import sqrt_fraction
from ...numbers.roots import golden_section
from ...numbers.vectors import Exact3, Number, cross, dot
from ...orbit.reduction import Reduction
from ...physics.scene import Scene, rests
from .fate import PATIENCE, Scenario, first_time, time_under
from .line import EVERY, INF, Family, Intervals, Line, candidates, family_of, own_momentum, pieces

Answer: TypeAlias = tuple[Intervals, str]  # and because
Bracket: TypeAlias = tuple[float, float]
RANGE = 2  # times the momentum that the wheel has now, either way; one at rest is tried up to the body's own
PLACES, CLOSER = 41, 24  # momenta that are tried over the range, and nearer and nearer to the best of them
SAME = 1e-6  # relative: a run that ends so much sooner than the limit has not come to it


def intervals(scene: Scene, state: Sequence[Fraction], axis: Exact3) -> Answer:
    """(((least, greatest) momentum along a wheel's axis that keeps the motion bounded, N m s), ...), because.

    scene: with the momentum of every other wheel in it, but not of this one; state: exact; axis: exact unit
    vector, scene's axes. An end is a number that keeps it bounded, to the last places of a double; -inf, inf
    where there is none.
    """
    torque, wheel, D = scene.vector("constant_torque"), scene.vector("gyrostat"), scene.body.exact
    if not any(torque):
        return EVERY, "no torque acts: the energy is constant, whatever the wheel does"
    if D[0] == D[1] == D[2]:
        return _sphere(torque, wheel, axis)
    family = family_of(scene, state)
    if family is None:
        return _off_axis(scene, state, axis)
    start, step, i = family.wheel, list(family.turned(axis)), family.axis
    if not dot(torque, axis):
        step[i] = Fraction(0)  # a turn by rounded numbers leaves a trace
    if step[i]:
        s = -start[i] / step[i]
        left = [Fraction(0) if n == i else v for n, v in enumerate(family.along(start, step, s))]
        return (((float(s),) * 2,) if family.steady(left) else ()), (
            "with any momentum left along the torque |H|^2/2 - D T grows for ever; at one momentum none is "
            "left")
    if start[i]:
        return (), ("momentum of the others lies along the torque: |H|^2/2 - D T then grows for ever, "
                    "whatever this wheel does")
    return across(family, start, tuple(step))


def _sphere(torque: Sequence[Fraction], wheel: Exact3, axis: Exact3) -> Answer:
    """Three equal moments: bounded exactly if there is a wheel momentum and it is across the torque."""
    level, slope = dot(torque, wheel), dot(torque, axis)
    words = "three equal moments: bounded where the wheels' momentum is across the torque and not zero"
    if slope:
        s = -level / slope
        return (((float(s),) * 2,) if any(w + s * a for w, a in zip(wheel, axis)) else ()), words
    if level:
        return (), words
    # with this, if with any, the wheels have none together
    s = next(-w / a for w, a in zip(wheel, axis) if a)
    return EVERY if any(w + s * a for w, a in zip(wheel, axis)) else without([s]), words


def _off_axis(scene: Scene, state: Sequence[Fraction], axis: Exact3) -> Answer:
    """Off the axes only an equilibrium is known to be bounded: M - omega x (D omega + l) = s omega x a has
    one s or none."""
    form = scene.quadratic()
    words = "the torque is off the principal axes, and no bounded motion is known there but equilibria"
    rate = form.rate(list(state))
    D = scene.body.exact
    pull = cross(axis, state)
    if not any(pull):
        return (EVERY if rests(form, state) else ()), words
    s = next(-r * d / p for r, d, p in zip(rate, D, pull) if p)
    resting = all(r * d + s * p == 0 for r, d, p in zip(rate, D, pull))
    return (((float(s),) * 2,) if resting else ()), words


def across(family: Family, start: Sequence[Fraction], step: Sequence[Fraction]) -> Answer:
    """The intervals, and because, of momenta start + s step that have no part along the torque."""
    at_0: Any  # none has a part along the torque, so both have a reduction
    at_1: Any
    at_0, at_1 = (family.reduction(family.along(start, step, s)) for s in (Fraction(0), Fraction(1)))
    if at_0.geometry.walled:
        return _between_walls(family, start, step)
    found = candidates(Line(at_0, at_1, family.state, family.state))
    if found is None:
        return (), "not known: the balls did not isolate the momenta at which the start lies on a separatrix"
    clearly = lambda s: family.clearly(wheel=family.along(start, step, s))
    kept = pieces(clearly, Fraction(family.momentum_unit), sorted(set(found)))
    return kept, (f"the ends are momenta at which the start lies on a separatrix: of {len(found)} "
                  "candidates, isolated as roots, those where the exact fate changes")


def _between_walls(family: Family, start: Sequence[Fraction], step: Sequence[Fraction]) -> Answer:
    """Every momentum but those at which the start lies in the set of measure zero that no wall holds: exact
    roots of a quadratic in s. A root that is not rational is no momentum that a number can give."""
    wheels = [family.along(start, step, Fraction(s)) for s in (-1, 0, 1)]
    reductions: Any = [family.reduction(wheel) for wheel in wheels]  # none has a part along the torque
    words = (f"the torque is on {reductions[0].geometry.where}: the potential has walls on both sides, so "
             "every motion is bounded but for a set of measure zero")
    for before, at, after in zip(*(loose(reduction, family.state) for reduction in reductions)):
        a, b, c = (before + after) / 2 - at, (after - before) / 2, at
        if a or b or c:
            roots = _rational_roots(a, b, c)
            return without([s for s in roots if not family.steady(family.along(start, step, s))]), words
    return (), f"not known: {words}, in which the start lies with every momentum of this wheel"


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
        s, longest = min((s, -longest), *closer, key=lambda one: one[1])
        s, longest = float(s), -longest
    told = time_under(scenario, torque, [w + Fraction(s) * a for w, a in zip(others, axis)])
    gain = None if told is None else told[0] - time[0]
    if gain is not None and gain <= 0:
        return None
    return s, told, gain, (-reach, reach), told is None or not longest < told[0] * (1 - SAME)


def times_over(scenario: Scenario, torque: Sequence[Fraction], axis: Exact3, now: Fraction,
               time: Bracket) -> tuple[np.ndarray, np.ndarray]:
    """(momenta (n,) of a wheel, N m s; times (n,) at which runs with them come to the limit, s, inf where not
    within PATIENCE times that of now). Arguments as of `delayed`."""
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
        return first_time(scenario, torque, wheel, PATIENCE * time[0])
    return others, reach, until
