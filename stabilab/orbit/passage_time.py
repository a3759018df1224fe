"""The time at which a motion with one degree of freedom passes a place, in balls.

Under a torque round circles and hyperbolas it is arb's integral (`period.time_between`, `time_from_turn`).
Without one, and on a parabola, W^2 is a quartic: of the offset on a parabola, else of t = tan(y/2) or
tanh(y/2), y from a place between, times (1 - e t^2)^2. The integral between two places is then

    2 R_F(U12^2, U13^2, U14^2),  U_ij = (X_i X_j Y_k Y_l + Y_i Y_j X_k X_l)/(x - y),

X_i and Y_i the roots of the linear factors at both ends (Carlson; DLMF 19.29.4)."""
from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ..numbers.balls import Unclear, sign
from .extremes import solve, turning_point
from .one_orbit import BallConic, BallOrbit
from .period import time_between, time_from_turn

if TYPE_CHECKING:
    from flint import acb, arb


MAX_TURNS = 1000  # of a circle that are climbed against the torque
LOST_BITS = 16  # of the coefficients' accuracy, in the roots of a quartic


def heading(orbit: BallOrbit) -> int:
    """In which sense of the offset the motion sets out."""
    return sign(orbit.w) or (1 if orbit.force_here * orbit.flip > 0 else -1)


def squared_rate(orbit: BallOrbit, y: arb) -> arb:
    """W^2 at a place."""
    return 2 * (orbit.energy - orbit.height(y))


def time_at(orbit: BallOrbit, place: arb, turns: int) -> arb:
    """When the motion is at a place for the first time after so many turning points (0, 1 or 2)."""
    ends = [_end(orbit, n) for n in range(turns)]
    if isinstance(orbit, BallConic) and orbit.r.sense:
        before = time_of_turn(orbit, turns - 1) if turns else orbit.energy * 0
        if not turns and not orbit.w.is_zero():
            return time_between(orbit, place)
        return before + time_from_turn(orbit, ends[-1] if turns else before, place)
    stops = [orbit.energy * 0, *ends, place]
    return sum((_by_quartic(orbit, a, b) for a, b in zip(stops, stops[1:])), stops[0])


def turn_ahead(orbit: BallOrbit, turns: int) -> arb | None:
    """The turning point that is the next one after so many; None where the motion never turns."""
    side = heading(orbit) * (-1) ** turns
    end = turning_point(orbit, side)
    return end if end is not None or side > 0 or not orbit.closed or not orbit.r.sense else _uphill(orbit)


def _uphill(orbit: BallOrbit) -> arb:
    """On a circle against the torque, beyond the turn behind: each turn is higher than the one before."""
    turn = 2 * orbit.numbers.pi()
    inner, ahead = orbit.energy * 0, [spot.y for spot in orbit.spots[::-1]]
    for back in range(1, MAX_TURNS):
        for outer in [y - back * turn for y in ahead] or [orbit.energy * 0 - 2**back]:
            if not outer < 0:
                continue
            if sign(orbit.height(outer) - orbit.energy) > 0:
                return solve(orbit, inner, outer)
            inner = outer
    raise Unclear


def time_of_turn(orbit: BallOrbit, turns: int) -> arb:
    """When the motion comes to the turning point after so many before (0 or 1)."""
    zero, ends = orbit.energy * 0, [_end(orbit, n) for n in range(turns + 1)]
    if not (isinstance(orbit, BallConic) and orbit.r.sense):
        return time_at(orbit, ends[-1], turns)
    first = _whole(orbit, zero, ends[0]) if orbit.w.is_zero() else time_from_turn(orbit, ends[0], zero)
    return first + _whole(orbit, *ends) if turns else first


def _end(orbit: BallOrbit, turns: int) -> arb:
    end = turn_ahead(orbit, turns)
    if end is None:
        raise Unclear
    return end


def _whole(orbit: BallConic, one: arb, two: arb) -> arb:
    """From a turning point to the other one."""
    middle = ((one + two) / 2).mid()
    return time_from_turn(orbit, one, middle) + time_from_turn(orbit, two, middle)


def _by_quartic(orbit: BallOrbit, a: arb, b: arb) -> arb:
    """Time between two places, W not zero between them."""
    from flint import acb_poly, arb
    low, high = sorted((a, b), key=lambda y: y.mid())
    if isinstance(orbit, BallConic):
        middle = ((low + high) / 2).mid()
        coefficients, factor = _about(orbit, middle), 2
        tangent = ((lambda y: (y / 2).tan()) if orbit.r.e < 0 else (lambda y: (y / 2).tanh()))
        low, high = tangent(low - middle), tangent(high - middle)
    else:
        f0, f1, f2, f3 = orbit.coefficients
        coefficients, factor = [2 * orbit.energy, 2 * f0, f1, 2 * f2 / 3, f3 / 2], 1
    while coefficients[-1].is_zero():
        coefficients.pop()
    if coefficients[-1].contains(0):
        raise Unclear
    try:
        accuracy = min(c.rel_accuracy_bits() for c in coefficients if not c.is_zero())
        roots = acb_poly(coefficients).roots(tol=arb(2) ** (LOST_BITS - accuracy))
    except ValueError:
        raise Unclear from None
    return factor * carlson(roots, abs(coefficients[-1]), low, high)


def _about(orbit: BallConic, middle: arb) -> list[arb]:
    """Coefficients of W^2 (1 - e t^2)^2, lowest power first."""
    from flint import arb, arb_poly
    (x, z), e = orbit.place(middle), orbit.r.e
    below = arb_poly([1, 0, -e])
    first, second = arb_poly([0, 2 * z, 2 * e * x]), arb_poly([0, 2 * e * x, 2 * e * z])
    result = squared_rate(orbit, middle) * below * below + 2 * (
        first * (orbit.G * arb_poly([x, z]) + orbit.c * below) + e * orbit.d * second * below)
    return [arb(result[n]) for n in range(5)]


def carlson(roots: Sequence[acb], leading: arb, low: arb, high: arb) -> arb:
    """Integral of dt/sqrt of a polynomial of degree four or less that is positive between two places, from
    its roots and the size of its leading coefficient."""
    from flint import acb
    pairs: list[tuple[Any, Any]] = []  # square roots of a factor at both ends
    for root in _conjugate_next(roots):
        if root.imag.is_zero():
            side = _side(root.real, low, high)
            pairs.append(tuple(acb((side * (end - root.real)).nonnegative_part()).sqrt()
                               for end in (high, low)))
        else:
            pairs.append(tuple((acb(end) - root).sqrt() for end in (high, low)))
    pairs += [(acb(1), acb(1))] * (4 - len(pairs))
    (a, p), (b, q), (c, r), (d, s) = pairs
    across = high - low
    u12, u13, u14 = ((i * j * n * o + l * m * k * t) / across for i, l, j, m, k, n, t, o in (
        (a, p, b, q, c, r, d, s), (a, p, c, r, b, q, d, s), (a, p, d, s, b, q, c, r)))
    value = 2 * acb.elliptic_rf(u12 * u12, u13 * u13, u14 * u14).real / leading.sqrt()
    if not value.is_finite():
        raise Unclear
    return value


def _side(root: arb, low: arb, high: arb) -> int:
    """1 where the root lies below both ends, -1 where above; one of them may be the root."""
    middle = (low + high) / 2
    return sign(middle - root)


def _conjugate_next(roots: Sequence[acb]) -> list[acb]:
    """The real ones, each exactly real, then pairs of conjugates."""
    from flint import acb
    real = [acb(root.real) for root in roots if root.imag.contains(0)]
    upper = [root for root in roots if root.imag > 0]
    if len(real) + 2 * len(upper) != len(roots):
        raise Unclear
    return [*(v for root in upper for v in (root, root.conjugate())), *real]
