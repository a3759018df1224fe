"""Steady states of a body in a field under a constant torque along a principal axis, as curves.

The notation is that of `field_states`.

With a torque (S gamma + b) x gamma = -M asks for M . gamma = 0. With M along axis i, and neither wheel nor
weight along it, gamma = (0, cos t, sin t) on the axes (i, j, k) solves all but one equation, a quadratic in
Omega:

    A (Omega^2 - N) + B Omega + C = 0,   A = (D_j - D_k) cos t sin t,   C = s_j sin t - s_k cos t + M_i,
    B = Lambda_j sin t - Lambda_k cos t -+ E cos t sin t    (- where j is axis 3, + where k is)

So the steady states are two closed curves over t, real where the discriminant, a polynomial in tau =
tan(t/2), is not negative. Linear motion: z^2 (z^4 + e2 z^2 - e3 z + e4), for |gamma| is kept, the state lies
on a curve of others, and the flow keeps volume (no z^3 term). The four roots sum to zero, so any root off the
imaginary axis brings one with positive real part. The verdict changes along them
only at zeros in tau of resultants with e3, e4 and e2^2 - 4 e4 (e2 where one of these vanishes all along).
"""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import atan, pi, tan

from flint import Ordering, arb, arb_mat, fmpq_mpoly_ctx

from ..errors import InputError
from ..numbers.balls import MANY_BITS, rational, working
from ..numbers.polynomial import Poly, real_roots
from ..numbers.vectors import CYCLE, cross_matrix
from ..physics.coefficients import Content
from ..reasons import Axis, Formula, Quantity, Sentence
from .description import ANGLE, FOR_ANGLES, GREATER, LESSER, Description
from .field_balance import Field, blocks, changes, roots_in, separated
from .result import (
    CurveSegment,
    Equilibria,
    EquilibriumCurve,
    EquilibriumPoint,
    Verdict,
    sample_parameters,
    values_inside,
)
from .stability import ordered

ACROSS_TORQUE = Sentence(
    "gamma-across-torque",
    "torque . γ = 0 puts γ across {axis}, and one quadratic in Ω remains; the intervals where it is real are "
    "those of a polynomial in tan(t/2) with exact coefficients")
THERE_ARE_NONE = Sentence("there-are-none", "there are none")()
STEADY = Sentence("steady-in-field", "{across} = 0, A (Ω² - N) + B Ω + C = 0")
GAMMA_TURNED = Sentence("gamma-turned", "{first} = cos t, {second} = sin t")
WITH_LESSER = Sentence("with-lesser-root", "ω = Ω γ with the lesser root Ω")()
WITH_GREATER = Sentence("with-greater-root", "ω = Ω γ with the greater root Ω")()
COS, SIN, ONE = Poly((1, 0, -1)), Poly((0, 2)), Poly((1, 0, 1))  # times 1 + tau^2
OFF_AXIS = Sentence(
    "field-torque-off-axis",
    "undecided: a constant torque off the principal axes, or one with a wheel or weight along it, holds a "
    "turning body only where three equations in Ω and γ meet; no closed form is known")()
SKEW = Verdict("unstable", Sentence(
    "steady-skew",
    "e3 != 0 in z⁴ + e2 z² - e3 z + e4: the four roots sum to zero and are not all imaginary, so one has "
    "positive real part")())
PAIR = Verdict("unstable", Sentence(
    "steady-pair",
    "e4 < 0, e2 < 0 or e2² < 4 e4 in z⁴ + e2 z² - e3 z + e4: roots off the imaginary axis, whose sum is "
    "zero")())
CENTRE = Verdict("undecided", Sentence(
    "steady-centre",
    "all eigenvalues are imaginary, and with a torque that does work no integral is known that would decide "
    "the full motion")())
OPEN = Verdict("undecided", Sentence(
    "steady-coefficient-vanishes",
    "a coefficient of the spectrum vanishes here: the next order decides")())


@dataclass(frozen=True)
class Plane:
    """The quadratic in Omega for a torque along axis i, in tau = tan(t/2): coefficients times (1 + tau^2)^2.
    """

    i: int
    square: Poly
    linear: Poly
    constant: Poly

    @property
    def discriminant(self) -> Poly:
        return self.linear * self.linear - 4 * self.square * self.constant


def steady_states(parts: Content) -> Equilibria:
    """All steady states of a body in a field with a constant torque, where they have a closed form."""
    acting = [i for i in range(3) if parts.M[i]]
    i = acting[0]
    if len(acting) > 1 or parts.s[i] or parts.Lambda[i]:
        return Equilibria("undecided", reason=OFF_AXIS)
    plane = _plane(parts, i)
    cuts, sides = _changes(parts, plane), (-1, 1) if plane.square else (-1,)
    curves = tuple(_steady_curve(parts, plane, lo, hi, side, cuts) for lo, hi in _pieces(plane)
                   for side in sides)
    reason = ACROSS_TORQUE(axis=Axis(i + 1))
    return (Equilibria("curves", curves=curves, reason=reason) if curves
            else Equilibria("none", reason=reason.then(THERE_ARE_NONE, ": ")))


def _plane(parts: Content, i: int) -> Plane:
    j, k = CYCLE[i]
    product, side = COS * SIN, (j == 2) - (k == 2)
    square = (parts.D[j] - parts.D[k]) * product
    linear = (parts.Lambda[j] * SIN - parts.Lambda[k] * COS) * ONE - parts.E * side * product
    constant = (parts.s[j] * SIN - parts.s[k] * COS) * ONE + parts.M[i] * ONE * ONE - parts.N * square
    return Plane(i, square, linear, constant)


def _pieces(plane: Plane):
    """Intervals of tau on which the quadratic has two real roots (one where D_j = D_k)."""
    cuts = {t for p in (plane.discriminant, plane.square, plane.linear if not plane.square else Poly(()))
            if p.degree > 0 for t in real_roots(p, MANY_BITS)}
    ends = [None, *separated({*cuts, Fraction(0)}), None]
    for lo, hi in zip(ends, ends[1:]):
        middle = values_inside(lo, hi, Fraction(1))
        if plane.discriminant(middle) > 0:
            yield lo, hi


def _omega(plane: Plane, tau: Fraction, side: int):
    """The root Omega at tau, where there is one, as a ball."""
    a, b, c = (rational(p(tau)) for p in (plane.square, plane.linear, plane.constant))
    if a == 0:
        return arb(-c / b)
    root = arb(b * b - 4 * a * c).sqrt()
    # the root without cancellation is near/a, the other c/near
    nearby = -(b + root) / 2 if b >= 0 else (root - b) / 2
    first, second = nearby / a, c / nearby if nearby != 0 else nearby / a
    low, high = (first, second) if first < second else (second, first)
    return low if side < 0 else high


def _state(plane: Plane, tau: Fraction, side: int):
    """(Omega, gamma) as balls."""
    j, k = CYCLE[plane.i]
    gamma = [arb(0)] * 3
    gamma[j], gamma[k] = (arb(rational(p(tau) / ONE(tau))) for p in (COS, SIN))
    return _omega(plane, tau, side), tuple(gamma)


def _point(parts: Content, plane: Plane, tau: Fraction, side: int) -> EquilibriumPoint:
    Omega, gamma = _state(plane, tau, side)
    _, _, e4, e3, e2, *_ = arb_mat(_jacobian(Field.of(parts), Omega, gamma)).charpoly().coeffs()
    e3 = -e3
    at = tuple(float(v.mid()) for v in (*(Omega * g for g in gamma), *gamma))
    linear, verdict = _verdict(e2, e3, e4)
    return EquilibriumPoint(at, _eigenvalues(e2, e3, e4), linear, verdict.word, reason=verdict.reason)


def _jacobian(field: Field, Omega, gamma, q=1):
    """Rows of q times the derivative of the rates of (omega, gamma) at gamma/q."""
    A, B = blocks(field, Omega, gamma, q)
    return ([[*a, *b] for a, b in zip(A, B)]
            + [[*row, *(-Omega * v for v in row)] for row in cross_matrix(gamma)])


def _verdict(e2: arb, e3: arb, e4: arb) -> tuple[str, Verdict]:
    """(linear, verdict) by the coefficients of the spectrum."""
    if e3 != 0:  # a ball without 0
        return "unstable", SKEW
    if e4 < 0 or e2 < 0 or e2 * e2 < 4 * e4:
        return "unstable", PAIR
    if e4 > 0 and e2 > 0 and e2 * e2 > 4 * e4:
        return "stable", CENTRE
    return "degenerate", OPEN


def _eigenvalues(e2, e3, e4):
    import numpy as np
    roots = np.roots([1.0, 0.0, *(float(v.mid()) for v in (e2, -e3, e4))])
    return (0j, 0j, *ordered(roots))


def _changes(parts: Content, plane: Plane) -> list[Fraction]:
    """The tau at which the verdict on a root Omega of the quadratic may change: zeros of resultants of
    its irreducible factors with e3, e4, e2^2 - 4 e4, and with e2 where one of these vanishes all along."""
    O, tau = fmpq_mpoly_ctx.get(("O", "tau"), Ordering.lex).gens()
    of = lambda p: sum((rational(c) * tau**n for n, c in enumerate(p.c)), 0 * tau)
    (j, k), q, gamma = CYCLE[plane.i], of(ONE), [0 * tau] * 3
    gamma[j], gamma[k] = of(COS), of(SIN)
    J = _jacobian(Field.of(parts), O, gamma, q)
    J2 = [[sum((J[i][n] * J[n][m] for n in range(6)), 0 * tau) for m in range(6)] for i in range(6)]
    # traces of its powers; that of J itself is 0
    second, third, fourth = (sum((first[i][n] * rows[n][i] for i in range(6) for n in range(6)), 0 * tau)
                             for first, rows in ((J, J), (J2, J), (J2, J2)))
    e2, e3, e4 = -second / 2, third / 3, second * second / 8 - fourth / 4
    result = changes(of(plane.square) * O * O + of(plane.linear) * O + of(plane.constant),
                    (e4, e2 * e2 - 4 * e4, e3), (e2,), "O")
    return [root for f in result for root in roots_in(f, 1)]


def _steady_curve(parts, plane: Plane, lo, hi, side, cuts) -> EquilibriumCurve:
    """One side of the quadratic over one interval of tau, in segments of one verdict."""
    j, k = CYCLE[plane.i]
    fixed = [t for t in (lo, hi) if t is not None]
    inner = [t for t in separated([*cuts, *fixed]) if (lo is None or t > lo) and (hi is None or t < hi)
             and len(separated([t, *fixed])) > len(fixed)]
    segments, samples = [], []
    with working(MANY_BITS):
        for low, high in pairwise([lo, *inner, hi]):
            rows = [_point(parts, plane, tau, side) for tau in _steady_samples(low, high)]
            middle = _point(parts, plane, values_inside(low, high, Fraction(1)), side)
            segments.append(CurveSegment.like(middle, (_angle(low, -1), _angle(high, 1))))
            samples += rows
        changed = tuple(_at_tau(plane, tau, side) for tau in inner)
    ends = _angle(lo, -1), _angle(hi, 1)

    def point(t: float):
        if not ends[0] < t < ends[1]:
            raise InputError(f"t = {t!r} lies at an end of this curve of steady states or outside it")
        with working(MANY_BITS):
            return _at_tau(plane, Fraction(tan(t / 2)), side)
    low, high = (Quantity(end, digits=6) for end in ends)
    gamma = [Formula((f"γ{n + 1}",)) for n in (plane.i, j, k)]
    about = Description((LESSER if side < 0 else GREATER).then(FOR_ANGLES(low=low, high=high), " "),
                        STEADY(across=gamma[0]),
                        GAMMA_TURNED(first=gamma[1], second=gamma[2]).then(
                            WITH_LESSER if side < 0 else WITH_GREATER, ", "), unit=ANGLE)
    return EquilibriumCurve(about, point, tuple(segments), changed, tuple(samples))


def _at_tau(plane: Plane, tau: Fraction, side: int):
    Omega, gamma = _state(plane, tau, side)
    return tuple(float(v.mid()) for v in (*(Omega * g for g in gamma), *gamma))


def _angle(tau, otherwise) -> float:
    return otherwise * pi if tau is None else 2 * atan(float(tau))


def _steady_samples(lo, hi):
    some = sample_parameters(lo, hi, Fraction(1)) or [values_inside(lo, hi, Fraction(1))]
    return sorted({some[0], some[len(some) // 2], some[-1]})
