"""Which momenta of a wheel keep a motion bounded under a torque that lasts: all intervals, by roots; else the momentum that delays the limit most."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, TypeAlias

from ...numbers.exact import sqrt_fraction
from ...numbers.vectors import Exact3, dot
from ...orbit.reduction import Reduction
from ...physics.quadratic import rests
from ...physics.scene import Scene
from .family import STEADY, Family, change_between, family_of
from .wheel_roots import Circle, candidates

INF = math.inf
NEAR = Fraction(1, 10**9)  # of the unit: how near to a candidate its change of fate is looked for first
Intervals: TypeAlias = tuple[tuple[float, float], ...]
Answer: TypeAlias = tuple[Intervals, str]  # and because
EVERY = ((-INF, INF),)


def intervals(scene: Scene, state: Sequence[Fraction], axis: Exact3) -> Answer:
    """(((least, greatest) momentum along a wheel's axis that keeps the motion bounded, N m s), ...), because.

    scene: with the momentum of every other wheel in it, but not of this one; state: exact; axis: exact unit vector, scene's axes. An end is
    a number that keeps it bounded, to the last places of a double; -inf, inf where there is none.
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
        return _one_momentum(family, start, step, -start[i] / step[i])
    if start[i]:
        return (), "momentum of the others lies along the torque: |H|^2/2 - D T then grows for ever, whatever this wheel does"
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
    s = next(-w / a for w, a in zip(wheel, axis) if a)  # with this, if with any, the wheels have none together
    return EVERY if any(w + s * a for w, a in zip(wheel, axis)) else without([s]), words


def _off_axis(scene: Scene, state: Sequence[Fraction], axis: Exact3) -> Answer:
    """Off the axes only an equilibrium is known to be bounded: M - omega x (D omega + l) = s omega x a has one s or none."""
    form = scene.quadratic()
    words = "the torque is off the principal axes, and no bounded motion is known there but equilibria"
    rate = form.rate(list(state))
    D = scene.body.exact
    pull = [state[2] * axis[1] - state[1] * axis[2], state[0] * axis[2] - state[2] * axis[0], state[1] * axis[0] - state[0] * axis[1]]  # -(omega x a)
    which = next((n for n in range(3) if pull[n]), None)
    if which is None:
        return (EVERY if rests(form, state) else ()), words
    s = -rate[which] * D[which] / pull[which]
    resting = all(rate[n] * D[n] + s * pull[n] == 0 for n in range(3))
    return (((float(s),) * 2,) if resting else ()), words


def _one_momentum(family: Family, start: Sequence[Fraction], step: Sequence[Fraction], s: Fraction) -> Answer:
    """A wheel that is not across the torque: at one momentum alone it leaves none along it."""
    wheel = list(family.along(start, step, s))
    wheel[family.axis] = Fraction(0)
    words = "with any momentum left along the torque |H|^2/2 - D T grows for ever; at one momentum none is left"
    return (((float(s),) * 2,) if family.fate(wheel) in STEADY else ()), words


def across(family: Family, start: Sequence[Fraction], step: Sequence[Fraction]) -> Answer:
    """The intervals, and because, of momenta start + s step that have no part along the torque."""
    at_0: Any  # none has a part along the torque, so both have a reduction
    at_1: Any
    at_0, at_1 = (family.reduction(family.along(start, step, s)) for s in (Fraction(0), Fraction(1)))
    if at_0.geometry.walled:
        return _between_walls(family, start, step)
    found = candidates(Circle(at_0, at_1, family.state))
    if found is None:
        return (), "not known: the balls did not isolate the momenta at which the start lies on a separatrix"
    clearly = lambda s: family.clearly(wheel=family.along(start, step, s))
    return pieces(clearly, Fraction(family.momentum_unit), sorted(set(found))), ("the ends are momenta at which the start lies on a separatrix: "
                                                             f"of {len(found)} candidates, isolated as roots, those where the exact fate changes")


def _between_walls(family: Family, start: Sequence[Fraction], step: Sequence[Fraction]) -> Answer:
    """Every momentum but those at which the start lies in the set of measure zero that no wall holds: exact roots
    of a quadratic in s. A root that is not rational is no momentum that a number can give."""
    wheels = [family.along(start, step, Fraction(s)) for s in (-1, 0, 1)]
    reductions: Any = [family.reduction(wheel) for wheel in wheels]  # none has a part along the torque
    words = (f"the torque is on {reductions[0].geometry.where}: the potential has walls on both sides, so every motion "
             "is bounded but for a set of measure zero")
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


def pieces(clearly: Callable[[Fraction], tuple[bool, float]], unit: Fraction, cuts: Sequence[float]) -> Intervals:
    """The intervals of s in which a motion stays bounded, among the cuts: the fate is one and the same between two of them.

    clearly(s): whether it does, and how clearly (`Family.clearly`); unit: a size of s.
    """
    def holds(s: Fraction) -> bool:
        return clearly(s)[0]
    at = [Fraction(s) for s in cuts]
    if not at:
        return EVERY if holds(Fraction(0)) else ()
    samples = [at[0] - unit, *((a + b) / 2 for a, b in zip(at, at[1:])), at[-1] + unit]
    steady = [holds(s) for s in samples]
    out: list[tuple[float, float]] = []
    low = -INF if steady[0] else math.nan
    for n, cut in enumerate(at):
        if steady[n] == steady[n + 1]:
            continue
        inside, outside = (samples[n], samples[n + 1]) if steady[n] else (samples[n + 1], samples[n])
        near = cut + (1 if inside > cut else -1) * NEAR * unit, cut - (1 if inside > cut else -1) * NEAR * unit
        if holds(near[0]) and not holds(near[1]):
            inside, outside = near
        end = float(change_between(clearly, inside, outside, unit)[0])
        if steady[n]:
            out.append((low, end))
            low = math.nan
        else:
            low = end
    return tuple([*out, (low, INF)] if steady[-1] else out)
