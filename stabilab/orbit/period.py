"""Period of one motion, and times along it, in balls: every digit returned is certain.

Without a torque, and on a parabola, the period is that of an elliptic curve. Else it is the
integral of dtheta/W between the turning points: to the digits of a double by the double-exponential rule, cut
at every equilibrium that the motion passes, where the rate is least or largest (balls bound its rounding, two
steps that agree show that it has converged); beyond by a sum whose remainder is proved (`period_sum`), or cut
in the middle: from a turning point y1 on, with y = y1 +- s^2 and F the mean force over the way,

    W^2 = 2 (y - y1) F(y1, y),    dt = 2 ds/sqrt(2 |F|),

where nothing is singular any more. F is a formula without cancellation (`BallConic.mean_force`), and arb's
integral encloses it: Gauss and Legendre's rule on pieces that are halved until an ellipse about each shows
that its remainder is small enough (Johansson, Numerical integration in arbitrary-precision ball arithmetic,
2018)."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import lru_cache, partial
from typing import TYPE_CHECKING, Any

from ..numbers.balls import (
    Digits,
    Unclear,
    narrowed,
    polynomial,
    real_roots_of,
    settled,
    sharpened,
    sign,
    working,
)
from ..numbers.polynomial import Poly
from ..numbers.vectors import Number, dot
from .extremes import turning_points
from .one_orbit import BallConic, BallOrbit, Orbit
from .period_sum import MAX_NODES, plan, summed
from .reduction import Reduction
from .result import Fate, without_return

if TYPE_CHECKING:
    from flint import acb, arb, fmpq_poly

DIGITS = 14
DOUBLE_DIGITS = 17  # that a double is rounded from
AGREED = 9  # digits to which two steps of the double-exponential rule agree for a double: the next has twice
TRIED_BITS = 1024  # of that rule, before it is left
FEW_DIGITS = 20  # up to which the double-exponential rule serves
SPARE_BITS = 8  # by which the remainder of an integral is larger than the rounding of its function
EVALUATIONS = 100  # of an integral, for each bit
MOST_BITS = 1 << 14  # at least, in which a period is tried


def precise_period(orbit: Orbit, label: int) -> float:
    """Period of one state with the given `Fate` label: inf where the motion does not repeat, 0 at an
    equilibrium, NaN where it is undecided."""
    return without_return(label) if label != Fate.BOUNDED else float(period_ball(orbit, AGREED).mid())


def period_ball(orbit: Orbit, digits: int = DIGITS, tell: Callable[[float], None] | None = None) -> arb:
    """Period of a bounded motion as a ball that is 10^-digits of it wide at most. tell: is given the seconds
    that it will take, before a long sum."""
    r = orbit.reduction
    if not r.geometry.centred:
        parabola: Callable[[Any], Any] = lambda result: result.taylor
        taylor = orbit.settled(parabola)
        return real_period(quartic_on_parabola(r, orbit.state, taylor), max(digits, DOUBLE_DIGITS))
    if not r.sense:
        return real_period(quartic_without_torque(r, orbit.state), max(digits, DOUBLE_DIGITS))
    if digits <= DIGITS:
        return orbit.settled(partial(_in_doubles, digits=digits), bits_for(digits))
    return sharpened(orbit.settled, partial(_libration, digits=digits, tell=tell), digits, MOST_BITS)


def _in_doubles(orbit: BallOrbit, digits: int) -> arb:
    result = by_double_exponential(orbit, *turning_points(orbit), digits)
    if not 10 ** digits * result.rad() < result:
        raise Unclear
    return result


def _libration(orbit: Any, digits: int, tell: Callable[[float], None] | None = None) -> arb:
    """Once to and fro between the turning points, which is all that a torque leaves: by a sum (`period_sum`)
    where few terms serve, else by the double-exponential rule, or, to many digits, twice the integral between
    them."""
    from flint import ctx
    left, right = turning_points(orbit)
    by = plan(orbit, left, right, ctx.prec)
    if by is not None and (nodes := by.nodes(ctx.prec)) <= MAX_NODES:
        return summed(orbit, left, right, by, nodes, tell)
    if digits <= FEW_DIGITS:
        try:
            return by_double_exponential(orbit, left, right, digits)
        except Unclear:
            if ctx.prec < TRIED_BITS + 8 * digits:
                raise  # more bits may serve, beyond these its steps do not
    middle = ((left + right) / 2).mid()
    return 2 * (time_from_turn(orbit, left, middle) + time_from_turn(orbit, right, middle))


def time_from_turn(orbit: BallConic, turn: arb, place: arb) -> arb:
    """Time from a turning point to a place before the other one."""
    side = 1 if sign(place - turn) > 0 else -1
    length = (side * (place - turn)).sqrt()

    def rate(s: acb, analytic: bool) -> acb:
        return 2 * length / (2 * side * orbit.mean_force(turn, side * (length * s) ** 2)).sqrt(analytic)
    return _integral(rate)


def time_between(orbit: BallConic, place: arb) -> arb:
    """Time from the state to a place, where the motion turns at neither nor between."""
    square = 2 * orbit.energy

    def rate(s: acb, analytic: bool) -> acb:
        way = place * s
        return abs(place) / (square + 2 * way * orbit.mean_force(square * 0, way)).sqrt(analytic)
    return _integral(rate)


def _integral(rate: Any) -> arb:
    """Integral from 0 to 1 of a function that is positive there."""
    from flint import acb, arb, ctx
    sizes = [rate(acb(arb(part) / 4), False).real for part in (0, 2, 4)]
    if not all(size > 0 for size in sizes):
        raise Unclear
    # pieces below the rounding of the function would be halved for ever
    accuracy = arb(2) ** (SPARE_BITS - min(size.rel_accuracy_bits() for size in sizes))
    value = acb.integral(rate, 0, 1, rel_tol=accuracy, abs_tol=accuracy * sizes[1].mid(),
                         eval_limit=EVALUATIONS * ctx.prec).real
    if not value.is_finite():
        raise Unclear
    return value


# --- The real period of an elliptic curve
# A motion without a torque keeps two quadrics, A and B, of its three rates, and x' = c grad A x grad B: it is
# the differential of their curve, whose periods are those of dz/sqrt(g), g = det(z A - B) a quartic with
# rational coefficients, over c (docs/mathematics/periods.md). On a parabola W^2 is a quartic of the offset.
ROOT_BITS = 256  # of the first balls about the roots of the cubic; Newton's method narrows them


def free_quartic(D: Sequence[Fraction], wheel: Sequence[Fraction], omega: Sequence[Number]) -> Poly:
    """det(z A - B)/(D_1 D_2 D_3)^2 of a body with wheels, A = |D omega + wheel|^2 and B = omega . D omega,
    each less its value: the period of dz/sqrt of it is that of the motion."""
    omega = [Fraction(w) for w in omega]
    momentum = [d * w + l for d, w, l in zip(D, omega, wheel)]
    square, twice = dot(momentum, momentum), dot(D, [w * w for w in omega])
    a, b, c = (Poly((-1, d)) for d in D)  # the diagonal over D_i
    u, v, w = (Poly((0, 0, d * l * l)) for d, l in zip(D, wheel))  # squares of the border over D_i
    corner = Poly((twice, dot(wheel, wheel) - square))
    scale = 1 / (D[0] * D[1] * D[2])
    return (corner * a * b * c - u * b * c - v * a * c - w * a * b) * scale


def quartic_without_torque(r: Reduction, omega: Sequence[Number]) -> Poly:
    """The same of a reduction with circles or hyperbolas and no torque: A = q U^2 - p V^2, B = w^2 - (kappa
    U^2 + 2 rho U)/p - 2 sigma V/q, of the components from the conic's centre."""
    (sj, sk), (rho, sigma), p, q = r.centre, r.across, r.p, r.q
    U, V, w = Fraction(omega[r.j]) + sj, Fraction(omega[r.k]) + sk, Fraction(omega[r.axis]) + r.s
    first, second = q * U * U - p * V * V, w * w - (r.kappa * U + 2 * rho) * U / p - 2 * sigma * V / q
    a, b, corner = Poly((r.kappa / p, q)), Poly((0, -p)), Poly((second, -first))
    return (a * (b * corner - Poly(((sigma / q) ** 2,))) - b * (rho / p) ** 2) * Fraction(-1)


def quartic_on_parabola(r: Reduction, omega: Sequence[Number], taylor: Sequence[Fraction]) -> Poly:
    """W^2 as a polynomial of the offset; taylor: of the force."""
    w, (f0, f1, f2, f3) = Fraction(omega[r.axis]) + r.s, taylor
    return Poly((w * w, 2 * f0, f1, 2 * f2 / 3, f3 / 2))


def real_period(quartic: Poly, digits: int) -> arb:
    """The least real period of dz/sqrt(quartic), as a ball 10^-digits of it wide at most.

    With the invariants of g = a z^4 + 4 b z^3 + 6 c z^2 + 4 d z + e,

        g2 = a e - 4 b d + 3 c^2,    g3 = a c e + 2 b c d - a d^2 - b^2 e - c^3,

    and e1 > e2 > e3 the roots of 4 t^3 - g2 t - g3 it is pi/agm(sqrt(e1 - e3), sqrt(e1 - e2)); where e1
    alone is real, 2 pi/agm(2 sqrt(h), sqrt(2 h + 3 e1)), h = sqrt(3 e1^2 - g2/4).
    """
    e, d, c, b, a = (*quartic.c, *(Fraction(0),) * (5 - len(quartic.c)))
    b, c, d = b / 4, c / 6, d / 4
    g2, g3 = a * e - 4 * b * d + 3 * c * c, a * c * e + 2 * b * c * d - a * d * d - b * b * e - c**3
    cubic = polynomial(-g3, -g2, 0, 4)

    def question(numbers: Digits) -> Any:
        real, root = _root(cubic)
        square, pi = numbers.ball(g2), numbers.pi()
        if real > 1:  # two where the other two are one
            between = _sqrt(square - 3 * root * root) if real == 3 else root * 0
            nearby = (3 * abs(root) - between) / 2  # from the root to the nearer of them
            far = nearby + between
            return pi / _sqrt(far).agm(_sqrt(between if root < 0 else nearby))
        h = _sqrt(3 * root * root - square / 4)
        return 2 * pi / (2 * _sqrt(h)).agm(_sqrt(2 * h + 3 * root))
    return sharpened(settled, question, digits)


def _sqrt(ball: arb) -> arb:
    if not ball > 0:
        raise Unclear
    return ball.sqrt()


def _root(cubic: fmpq_poly) -> tuple[int, arb]:
    """(how many real roots there are, the one farthest from the others)."""
    from flint import arb, arb_poly, ctx
    with working(min(ROOT_BITS, ctx.prec)):
        rows = real_roots_of(cubic)
        simple = [root for root, many in rows if many == 1]
        if not simple:
            raise Unclear  # all three are one: no period
        last = len(rows) == 3 and rows[2][0] - rows[1][0] > rows[1][0] - rows[0][0]
        root = simple[-1 if last else 0]
    value, slope, bits = arb_poly(cubic), arb_poly(cubic.derivative()), ROOT_BITS
    root = arb(root)
    while bits < ctx.prec:
        bits = min(2 * bits, ctx.prec)
        with working(bits):
            root = narrowed(value, slope, root)
    return len(rows), root


# --- The double-exponential rule
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
    return period + arb(0, (period * arb(10) ** (-digits - 1)).abs_upper())  # beside its rounding


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
