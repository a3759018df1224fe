"""The real period of an elliptic curve, by the arithmetic-geometric mean; in balls.

A motion without a torque keeps two quadrics, A and B, of its three rates, and x' = c grad A x grad B: it is
the differential of their curve, whose periods are those of

    dz/sqrt(det(z A - B)),    a quartic g(z) with rational coefficients,

over c (docs/mathematics/periods.md). On a parabola W^2 is itself a quartic of the offset. With the invariants
of g = a z^4 + 4 b z^3 + 6 c z^2 + 4 d z + e,

    g2 = a e - 4 b d + 3 c^2,    g3 = a c e + 2 b c d - a d^2 - b^2 e - c^3,

and e1 > e2 > e3 the roots of 4 t^3 - g2 t - g3, the least real period is pi/agm(sqrt(e1 - e3), sqrt(e1 -
e2)); where e1 alone is real, 2 pi/agm(2 sqrt(h), sqrt(2 h + 3 e1)), h = sqrt(3 e1^2 - g2/4)."""
from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from ..numbers.balls import Digits, Unclear, narrowed, polynomial, real_roots_of, settled, sharpened, working
from ..numbers.polynomial import Poly
from ..numbers.vectors import Number, dot
from .reduction import Reduction

if TYPE_CHECKING:
    from flint import arb, fmpq_poly

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
    """The least real period of dz/sqrt(quartic), as a ball 10^-digits of it wide at most."""
    e, d, c, b, a = (Fraction(v) for v in (*quartic.c, *(0,) * (5 - len(quartic.c))))
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
