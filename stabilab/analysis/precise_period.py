"""The period of one state in ball arithmetic: the integral of dtheta/W by the double-exponential rule, cut at every
equilibrium that the motion passes, where the rate is least or largest."""
from __future__ import annotations

from functools import lru_cache

from .precise import PreciseOrbit, Unclear, settled, sign
from .precise_extremes import turning_points
from .results import Fate

BITS = 256  # nodes come within 1e-40 of the turning points, where E - V must keep its digits
FINEST = 7  # halvings of the step
AGREE = 1e-14  # two steps agree to this; the rule doubles its digits with every halving, so the second is exact


def precise_period(reduction, state, label: int) -> float:
    """Period of one state with the given `Fate` label: inf where the motion does not repeat, 0 at an equilibrium."""
    if label == Fate.EQUILIBRIUM:
        return 0.0
    if label != Fate.BOUNDED:
        return float("inf")

    def question(bits):
        orbit = PreciseOrbit(reduction, state)
        ends = turning_points(orbit)
        return _rotation(orbit) if ends is None else _libration(orbit, *ends)
    return settled(question, BITS)


def _libration(orbit, left, right):
    """Twice the time between the turning points; y = middle - half cos(phi) removes the roots at both ends."""
    from flint import arb
    half, middle = (right - left) / 2, (right + left) / 2
    inside = [s.y for s in orbit.all_spots if s.y > left and s.y < right]
    knots = [arb(0), *(((middle - y) / half).acos() for y in inside), arb.pi()]

    def integrand(near, a, b):
        """At phi = a + near (near > 0) or b + near (near < 0), accurate next to both ends of [0, pi]."""
        phi = ((a if near > 0 else b) + near).mid()
        y = middle - half * phi.cos()
        return half * phi.sin() / _rate(orbit, y)
    return 2 * _sum_over(integrand, knots)


def _rotation(orbit):
    """Once round the circle without torque."""
    from flint import arb
    spots = [s.y for s in orbit.spots]
    knots = [*spots, spots[0] + 2 * arb.pi()] if spots else [arb(0), 2 * arb.pi()]
    return _sum_over(lambda near, a, b: 1 / _rate(orbit, (a if near > 0 else b) + near), knots)


def _rate(orbit, y):
    kinetic = orbit.energy - orbit.height(y)
    if sign(kinetic) <= 0:
        raise Unclear
    return (2 * kinetic).sqrt()


def _sum_over(integrand, knots) -> float:
    total = 0.0
    for a, b in zip(knots, knots[1:]):
        total += _tanh_sinh(integrand, a.mid(), b.mid())
    return total


def _tanh_sinh(integrand, a, b) -> float:
    """Integral over (a, b); the step is halved until two results agree, each row goes on until its terms vanish."""
    length, rows, before = (b - a).mid(), 0.0, None
    for level in range(FINEST + 1):
        for row in _rows(level):
            for near, weight in row:
                term = float((weight * integrand((near * length).mid(), a, b)).mid())
                rows += term
                if term < 1e-22 * rows:
                    break
            else:
                raise Unclear
        now = rows * 2.0**-level
        if before is not None and level > 2 and abs(now - before) <= AGREE * now:
            return now * float(length)
        before = now
    raise Unclear


@lru_cache(maxsize=2 * FINEST + 2)
def _nodes(level, side):
    """Nodes as (distance from the nearer end / length, signed by the end; weight), outward from the middle."""
    from flint import arb, ctx
    step, nodes = arb(2) ** -level, []
    with ctx.workprec(BITS):
        for k in range(0 if side > 0 else 1, 7 * 2**level):
            if level and k % 2 == 0:
                continue
            t = k * step
            e = (arb.pi() * t.sinh()).exp()  # x = 1/(1 + exp(-pi sinh t)): 1 - x = 1/(1 + e)
            far = 1 / (1 + e)
            weight = arb.pi() * t.cosh() * far * (1 - far)
            nodes.append((-side * far.mid(), weight))
            if far < 1e-300:
                break
    return tuple(nodes)


def _rows(level):
    return _nodes(level, 1), _nodes(level, -1)
