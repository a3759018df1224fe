"""Stability of an attitude at rest in the orbital frame: Lyapunov's function, and the exact spectrum.

A small turn s of the body moves as I s'' + g x s' + K s = 0, with w = n a2 and

    g = (tr I) w - 2 I w - h,     K = [w] I [w] - [I w + h] [w] + 3 n^2 ([I a3] [a3] - [a3] I [a3]),

where [v] s = v x s; K is the second derivative of the dynamic potential. Since det(M + [g] z) = det M +
z^2 g . M g for a symmetric M, the characteristic polynomial is a cubic in m = z^2,

    c3 m^3 + c2 m^2 + c1 m + c0 = det(I m + K) + m g . (I m + K) g.

  K positive definite: stable, the Jacobi integral is a Lyapunov function.
  Unstable: any root that is not real, or is positive, gives an eigenvalue with a positive real part. All
  three are real where the discriminant is not negative, and Descartes' rule then counts the positive ones.
  All roots negative and different, K indefinite: the spectrum is imaginary through gyroscopic torques alone;
  energy does not decide, and by Kelvin and Chetaev any complete dissipation makes such an attitude unstable.
  A zero root or a double one: undecided where K is not positive definite.

A continuous family of equilibria has one root m = 0, of turns along itself; the verdict then is on the
family: where K is positive definite across it, the Jacobi integral has a strict minimum on it.
"""
from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from flint import arb, fmpq_poly

from ...numbers.balls import START_BITS, Digits, Unclear, rational, settled, sign
from ...numbers.vectors import CYCLE, Number, Triple, dot
from ...physics.circular_orbit import Satellite
from .elimination import Line

LYAPUNOV = "the second variation of the dynamic potential is positive definite: the Jacobi integral is a " \
           "Lyapunov function"
SPREAD = "the second variation of the dynamic potential is positive definite across the family: the Jacobi " \
         "integral is a Lyapunov function of the family as a whole, along which the attitude may drift"
GROWING = "an eigenvalue of the linear motion has a positive real part"
GYROSCOPIC = "the dynamic potential has no minimum here, but all eigenvalues are imaginary and different: " \
             "gyroscopic stability, which energy does not prove and any complete dissipation destroys"
FLAT = "the second variation of the dynamic potential is singular and a frequency is zero: terms of " \
       "higher order decide"
DOUBLE = "the dynamic potential has no minimum here and two frequencies are equal: terms that linear " \
         "motion leaves out decide"


class Signs(NamedTuple):
    """Exact signs: of the sums of principal minors of K of the orders 1, 2, 3, of c1, c2, and of the
    discriminant."""

    trace: int
    minors: int
    determinant: int
    c1: int
    c2: int
    discriminant: int

    @property
    def minimum(self) -> bool:
        """Whether K is positive definite."""
        return self.trace > 0 and self.minors > 0 and self.determinant > 0

    @property
    def spread(self) -> bool:
        """Whether K has one zero and is positive definite besides."""
        return self.trace > 0 and self.minors > 0 and self.determinant == 0

    @property
    def growing(self) -> bool:
        """Whether the linear motion has an eigenvalue with a positive real part."""
        return self.discriminant < 0 or min(self.c2, self.c1, self.determinant) < 0


def verdict_of(signs: Signs, family: bool) -> tuple[str, str, str]:
    """(linear, verdict, because)."""
    if signs.growing:
        return "unstable", "unstable", GROWING
    if signs.minimum:
        return "stable", "stable", LYAPUNOV
    if family and signs.spread:
        return "stable", "stable", SPREAD
    if family and signs.c1 and signs.discriminant:
        return "stable", "undecided", GYROSCOPIC
    if not signs.determinant:
        return "degenerate", "undecided", FLAT
    return ("stable", "undecided", GYROSCOPIC) if signs.discriminant else ("degenerate", "undecided", DOUBLE)


def coefficients(satellite: Satellite, omega: Triple, X: Triple, reciprocal: Number) -> tuple[Triple, Triple]:
    """(sums of the principal minors of K of the orders 1, 2, 3; c3, c2, c1, c0). omega: n a2; X: along a3;
    reciprocal: 1/|X|^2; in balls, or in polynomials of an algebraic number."""
    A, h = (tuple(map(rational, row)) for row in (satellite.moments, satellite.momentum))
    pull, trace = 3 * rational(satellite.rate_squared) * reciprocal, sum(A, rational(0))
    H = [d * w + m for d, w, m in zip(A, omega, h)]
    g = [(trace - 2 * d) * w - m for d, w, m in zip(A, omega, h)]
    turning, drawn = dot(H, omega), sum(d * x * x for d, x in zip(A, X))
    K = [[-A[3 - i - j] * (pull * X[i] * X[j] - omega[i] * omega[j]) - H[j] * omega[i]
          + pull * A[j] * X[i] * X[j] if i != j else 0 for j in range(3)] for i in range(3)]
    for i, (j, k) in enumerate(CYCLE):
        K[i][i] = (turning - H[i] * omega[i] - A[j] * omega[k] * omega[k] - A[k] * omega[j] * omega[j]
                   + pull * (A[i] * X[i] * X[i] - drawn + A[j] * X[k] * X[k] + A[k] * X[j] * X[j]))
    minor = [K[j][j] * K[k][k] - K[j][k] * K[k][j] for j, k in CYCLE]
    det = K[0][0] * minor[0] + K[0][1] * (K[1][2] * K[2][0] - K[1][0] * K[2][2]) \
        + K[0][2] * (K[1][0] * K[2][1] - K[1][1] * K[2][0])
    # no powers: flint knows none of a ball about zero
    c2 = sum((K[i][i] * A[j] * A[k] for i, (j, k) in enumerate(CYCLE)), dot([d * v for d, v in zip(A, g)], g))
    c1 = sum(d * m for d, m in zip(A, minor)) + sum(g[i] * K[i][j] * g[j] for i in range(3) for j in range(3))
    return ((K[0][0] + K[1][1] + K[2][2], sum(minor), det), (A[0] * A[1] * A[2], c2, c1, det))


def deciding(minors: Sequence[Number], cubic: Sequence[Number], family: bool) -> tuple[Number, ...]:
    """The numbers whose `Signs` decide."""
    a, b, c, d = cubic
    if family:
        return (*minors[:2], 0 * d, c, b, b * b - 4 * a * c)
    return (*minors, c, b, 18 * a * b * c * d - 4 * b * b * b * d + b * b * c * c - 4 * a * c * c * c
            - 27 * a * a * d * d)


def signs_at(satellite: Satellite, line: Line, index: int, family: bool = False) -> Signs:
    """The exact signs at the real root of this index."""
    vanishing: list[bool] = []

    def asked(digits: Digits) -> Signs:
        X, omega, reciprocal = line.at(line.roots(digits.bits)[index])
        values = deciding(*coefficients(satellite, omega, X, reciprocal), family)
        if any(arb(v).contains(0) for v in values) and not vanishing:
            if digits.bits < 4 * START_BITS:
                raise Unclear  # more digits cost less than exact zeros
            vanishing.extend(_vanish(satellite, line, family))
        known = vanishing or [False] * len(values)
        return Signs(*(0 if zero else sign(arb(v)) for v, zero in zip(values, known)))
    return settled(asked, 2 * START_BITS)


def _vanish(satellite: Satellite, line: Line, family: bool) -> list[bool]:
    """Which of the deciding numbers are zero, exactly, at every root alike."""
    X, omega, reciprocal = line.exact
    values = deciding(*coefficients(satellite, omega, X, reciprocal), family)
    return [(fmpq_poly([0]) + v) % line.polynomial == 0 for v in values]
