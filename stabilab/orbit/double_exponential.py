"""The period of a motion by the double-exponential rule, in balls, where no strip proves that few equal steps
are enough (`period_sum`): cut at every equilibrium that the motion passes, where the rate is least or
largest.

Balls bound the rounding; that the rule has converged is seen by two steps that agree, whose changes fall at a
rate."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

from ..numbers.balls import Unclear, sign, working
from .one_orbit import BallOrbit

if TYPE_CHECKING:
    from flint import arb

SPARE = 8  # digits beyond those: terms that are smaller are left out
# digits that the last step must have beyond those in which it agrees with the one before, by the rate at
# which the steps draw together
LEFT = 5
WEIGHT = 1.7  # log(pi cosh t)/pi, which the weights of the last nodes have beside an exponential
FINEST = 9  # halvings of the step; the seventh serves a double


def bits_for(digits: int) -> int:
    """Bits for so many digits: of the first two rows of nodes, whole steps from 0 and from a half, the last
    stands up to a step beyond where terms vanish, and so near a turning point E - V, which goes with the
    square of the distance, must keep its digits."""
    vanishing = math.asinh((digits + SPARE) * math.log(10) / math.pi + WEIGHT)
    last = max(math.ceil(vanishing), math.ceil(vanishing - 0.5) + 0.5)
    return int(2 * math.pi * math.sinh(last) / math.log(2) + 3.33 * (digits + 2 * SPARE))


def by_double_exponential(orbit: BallOrbit, left: arb, right: arb, digits: int):
    """The period of a motion between two turning points: twice the time between them; y = middle - half
    cos(phi) removes the roots at both ends. Two steps of the rule agree to so many digits."""
    from flint import arb
    half, middle = (right - left) / 2, (right + left) / 2
    inside = [s.y for s in orbit.all_spots if s.y > left and s.y < right]
    knots = [arb(0), *(((middle - y) / half).acos() for y in inside), arb.pi()]

    def integrand(nearby: arb, a: arb, b: arb):
        """At phi = a + near (near > 0) or b + near (near < 0), accurate next to both ends of [0, pi]."""
        phi = ((a if nearby > 0 else b) + nearby).mid()
        y = middle - half * phi.cos()
        return half * phi.sin() / _rate(orbit, y)
    period = 2 * _sum_over(integrand, knots, digits)
    return period + arb(0, (period * arb(10) ** (-digits - LEFT // 2)).abs_upper())  # beside its rounding


def _rate(orbit: BallOrbit, y: arb):
    kinetic = orbit.energy - orbit.height(y)
    if sign(kinetic) <= 0:
        raise Unclear
    return (2 * kinetic).sqrt()


def _sum_over(integrand: Callable[[arb, arb, arb], arb], knots: Sequence[arb], digits: int):
    return sum(_tanh_sinh(integrand, a.mid(), b.mid(), digits) for a, b in zip(knots, knots[1:]))


def _tanh_sinh(integrand: Callable[[arb, arb, arb], arb], a: arb, b: arb, digits: int):
    """Integral over (a, b); the step is halved until two results agree, each row goes on until its terms
    vanish."""
    from flint import arb
    length, rows, before, changes = (b - a).mid(), arb(0), None, []
    smallest, agree = arb(10) ** -(digits + SPARE), arb(10) ** -digits
    for level in range(FINEST + 1):
        for row in _rows(level, digits):
            for nearby, weight in row:
                term = weight * integrand((nearby * length).mid(), a, b)
                rows += term
                if term < smallest * rows:
                    break
            else:
                raise Unclear
        now = rows * arb(2) ** -level
        if before is not None:
            change = abs(now - before)
            # less than ten times what the rows leave out says nothing
            changes.append(_power_of_ten((change / now).mid(), 1 - digits - SPARE))
            if level > 2 and change <= agree * now and power_of_error(*changes[-3:]) <= -digits - LEFT:
                return now * length
        before = now
    raise Unclear


def _power_of_ten(value: arb, smallest: int) -> float:
    return max(smallest, float(value.log_base(10))) if value > 0 else smallest


def power_of_error(first: float, middle: float, last: float) -> float:
    """Power of ten of the error of a sum over nodes, given the powers of ten of its last three changes as its
    nodes were doubled.

    The error is C r^n for n nodes, but its sign goes round, and two sums may agree by chance. So the rate is
    given by either ratio of changes, the size by its own change or by the one before, and the largest error
    counts; as `converged` in `arc_kernel`, which needs NumPy.
    """
    a, b, c = first, middle, last
    return max(3 * c - 2 * b, c + 4 * (b - a), b + 2 * (c - a), 7 * b - 6 * a)


@lru_cache(maxsize=64)
def _nodes(level: int, side: int, digits: int):
    """Nodes as (distance from the nearer end / length, signed by the end; weight), outward from the middle.
    """
    from flint import arb
    step, nodes = arb(2) ** -level, []
    with working(int(3.33 * 2 * (digits + 2 * SPARE)) + 128):
        for k in range(0 if side > 0 else 1, 12 * 2**level):
            if level and k % 2 == 0:
                continue
            t = k * step
            e = (arb.pi() * t.sinh()).exp()  # x = 1/(1 + exp(-pi sinh t)): 1 - x = 1/(1 + e)
            far = 1 / (1 + e)
            weight = arb.pi() * t.cosh() * far * (1 - far)
            nodes.append((-side * far.mid(), weight))
            if far < arb(10) ** -300:
                break
    return tuple(nodes)


def _rows(level: int, digits: int):
    return _nodes(level, 1, digits), _nodes(level, -1, digits)
