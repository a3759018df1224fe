"""The balance of torques at an equilibrium of a gyrostat, and its spectrum and stability (proofs:
docs/mathematics/stability.md).

Euler's equations D w' = H x w + M and the scaled system x' = h x g + mu (with g = (x1+a, x2, 0), h = (x1+b,
0, -x3)) have one form. Replacing g by g + h leaves g x h alone and turns the scaled system, for every a and
b, into

    (D y + lambda) x y + M = 0,   y = A x + u,   D = (1/2, 0, 1), lambda = ((b-a)/2, 0, 0), A = (2, 1, -1), u
    = (a+b, 0, 0).

So the equilibria of both are those of one Euler balance, with exact coefficients; D need not be positive.

The characteristic polynomial is z^3 + m z + n. Signs of m and n are those of rationals or of p + q sqrt(d),
never of rounded numbers. A zero of m on a regular curve of equilibria that is the critical set of a
one-degree-of-freedom potential: one of odd order is unstable, one of even order stable where m > 0 on both
sides and unstable where m < 0.
"""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from functools import partial
from typing import NamedTuple

from ..errors import InputError
from ..numbers.exact import sign_of, sqrt_fraction
from ..numbers.polynomial import Poly, real_roots
from ..numbers.vectors import Exact3, Number, Triple
from ..physics.scene import AnyScene, QuadraticForm
from ..reasons import Sentence
from .result import (
    CurveSegment,
    EquilibriumCurve,
    EquilibriumPoint,
    RationalCurve,
    Verdict,
    float_ends,
    sample_parameters,
    values_inside,
)

ONE, ZERO = Fraction(1), Fraction(0)
POSITIVE_EIGENVALUE = Verdict("unstable", Sentence(
        "positive-eigenvalue",
        "n = 0 and m < 0 in z³ + m z + n: the eigenvalue √(-m) is positive")())
N_POSITIVE = Verdict("unstable", Sentence(
    "n-positive",
    "n > 0 in z³ + m z + n, whose roots sum to zero: a negative real root, so the other two have a positive "
    "real part, whatever m is")())
N_NEGATIVE = Verdict("unstable", Sentence(
    "n-negative",
    "n < 0 in z³ + m z + n, whose roots sum to zero: a real root with a positive real part, whatever m is")())
FOLD_WITH_CENTRE = Verdict("unstable", Sentence(
    "fold-with-centre",
    "fold of two isolated equilibria, eigenvalues 0, ±i √(m): the averaged motion is z' = a z² + b r², "
    "r' = -a z r with a != 0, and V = z² - k² r² is a Chetaev function")())
FOLD_TRIPLE_ZERO = Verdict("unstable", Sentence(
    "fold-triple-zero",
    "fold of two isolated equilibria with a triple zero eigenvalue: z''' = a z² + ... with a != 0, and "
    "blown up with weights 3, 4, 5 it has a motion z ~ -60/(a t³) that comes out of the point")())
DEGENERATE_CURVE = Verdict("undecided", Sentence(
    "degenerate-curve",
    "m and n vanish all along this curve: the linear motion is degenerate and no proof is known here")())


class Pencil(NamedTuple):
    """(D y + lam) x y + M = 0 with x_i = (y_i - u_i)/A_i; `form` gives the rates of x."""

    D: Exact3
    lam: Exact3
    M: Exact3
    A: Exact3
    u: Exact3
    form: QuadraticForm
    scaled: bool

    @property
    def names(self) -> tuple[str, ...]:
        """Letters of the three components of the state."""
        return tuple(f"{'x' if self.scaled else 'ω'}{i}" for i in (1, 2, 3))

    def turned(self, y: Sequence[Number]) -> Exact3:
        """D y."""
        return tuple(d * v for d, v in zip(self.D, y))

    def state(self, y: Sequence[Number]) -> Triple:
        """x from y; entries of any exact type."""
        return tuple((v + -u) * (1 / a) for v, u, a in zip(y, self.u, self.A))

    def torque_axis_moment(self) -> Fraction | None:
        """d with D M = d M where M is an eigenvector of D, None where it is not."""
        moments = {d for d, m in zip(self.D, self.M) if m}
        return moments.pop() if len(moments) == 1 else None


def pencil(scene: AnyScene) -> Pencil:
    """The balance of a Scene or ScaledGyrostat. Raises InputError for effects outside gyrostat and constant
    torque."""
    form = scene.quadratic()
    if scene.variables == "scaled":
        a, b = scene.exact_ab
        return Pencil((ONE / 2, ZERO, ONE), ((b - a) / 2, ZERO, ZERO), scene.exact_mu, (2 * ONE, ONE, -ONE),
                      (a + b, ZERO, ZERO), form, True)
    return Pencil(scene.body.exact, scene.vector("gyrostat"), scene.vector("constant_torque"), (ONE,) * 3,
                  (ZERO,) * 3,
                  form, False)


def unit(i: int) -> Exact3:
    """Unit vector of axis i."""
    return tuple(ONE if n == i else ZERO for n in range(3))


BITS = 220  # working precision; far above double, so that each printed part is rounded once
ROOT_BITS = 256  # of the roots at which signs are asked, and far more where these bits leave them open


def invariants(form: QuadraticForm, x: Sequence[Number], w: Number = 1) -> tuple[Number, Number]:
    """(m, n) of the characteristic polynomial z^3 + m z + n of the Jacobian at x / w, times w^2 and w^3.

    form: QuadraticForm. x, w: rationals, or polynomials (a rational curve, w its denominator).
    """
    return coefficients(form.jacobian(x, w))


def coefficients(J: Sequence[Sequence[Number]]) -> tuple[Number, Number]:
    """(m, n) of the characteristic polynomial z^3 + m z + n of a Jacobian without a diagonal."""
    return (-(J[0][1] * J[1][0] + J[0][2] * J[2][0] + J[1][2] * J[2][1]),
            -(J[0][1] * J[1][2] * J[2][0] + J[0][2] * J[1][0] * J[2][1]))


def eigenvalues(m: Fraction, n: Fraction, shift: Fraction = Fraction(0)) -> tuple[complex, ...]:
    """Roots of z^3 + m z + n, all moved by `shift`, each part correct to rounding; where that is 0, sums of
    real parts are zero by structure.

    n = 0 gives an exact 0 and an exactly real or exactly imaginary pair; a complex pair is exactly conjugate.
    """
    if not m and not n:
        return (complex(float(shift), 0.0),) * 3
    real = lambda value: complex(float(shift + value), 0.0)
    if not n:
        root = sqrt_fraction(abs(m))
        return (real(Fraction(0)), *((complex(float(shift), float(root)), complex(float(shift), -float(root)))
                                     if m > 0 else (real(root), real(-root))))
    r = max(real_roots(Poly((n, m, 0, 1)), BITS), key=abs)  # a simple one, of the sign of -n
    # the other two are -r/2 +- half their distance, whose square times (3 r^2 + m)^2 is the discriminant
    kind = -4 * m**3 - 27 * n * n
    if not kind:
        double = real(-3 * n / (2 * m))
        return real(3 * n / m), double, double
    half, gap = -r / 2, sqrt_fraction(abs(kind) / (4 * (3 * r * r + m)**2))
    if kind < 0:
        middle = real(half).real
        return real(r), complex(middle, float(gap)), complex(middle, -float(gap))
    far = half + gap if half > 0 else half - gap
    return real(r), real(far), real(-n / (r * far))


def ordered(values: Iterable[complex]) -> tuple[complex, ...]:
    """Eigenvalues found in doubles, real ones first, then by size: the order in which LAPACK finds them
    depends on the processor."""
    return tuple(sorted(map(complex, values), key=lambda z: (z.imag != 0, abs(z), -z.real, -z.imag)))


def linear_word(m_sign: int, n_sign: int) -> str:
    """The linear verdict from exact signs: "stable" (centre with a simple zero), "unstable" or "degenerate".
    """
    if n_sign or m_sign < 0:
        return "unstable"
    return "stable" if m_sign else "degenerate"


def isolated_verdict(m_sign: int, n_sign: int) -> Verdict:
    """The nonlinear verdict on an isolated equilibrium of a torque off the eigenvectors of D; n = 0 is a
    fold.

    A fold is unstable: with m > 0 by Chetaev's theorem, with m = 0 by blowing up with the weights 3, 4, 5.
    Proofs: docs/mathematics/stability.md.
    """
    if n_sign:
        return N_POSITIVE if n_sign > 0 else N_NEGATIVE
    if m_sign < 0:
        return POSITIVE_EIGENVALUE
    return FOLD_WITH_CENTRE if m_sign > 0 else FOLD_TRIPLE_ZERO


class Isolated(NamedTuple):
    """An isolated equilibrium x(t), polynomials, at the root of P that t approximates to 2**-ROOT_BITS."""

    x: tuple[Poly, ...]
    P: Poly
    t: Fraction

    @classmethod
    def all_of(cls, x: tuple[Poly, ...], P: Poly) -> list[Isolated]:
        """Those at all real roots of P, rising."""
        return [cls(x, P, t) for t in real_roots(P, ROOT_BITS)]

    @property
    def at(self) -> Exact3:
        """Its components, good to some hundred bits; exact where t is the root itself."""
        return tuple(v(self.t) for v in self.x)

    @property
    def exact(self) -> bool:
        """Whether t is the root itself."""
        return not self.P(self.t)


def sign_at(R: Poly, P: Poly, t: Fraction, bits: int = ROOT_BITS) -> int:
    """Exact sign of R at the root of P that t approximates to 2**-bits relative."""
    radius = abs(t) / 2**(bits - 2)
    value = R(t)
    slack = radius * sum(n * abs(v) * (abs(t) + radius)**(n - 1) for n, v in enumerate(R.c) if n)
    if abs(value) > slack or not radius:
        return (value > 0) - (value < 0)
    common = P.gcd(R)
    if common.degree > 0 and any(abs(r - t) <= 4 * radius for r in real_roots(common, bits)):
        return 0
    finer = min(real_roots(P, 2 * bits), key=lambda r: abs(r - t))
    return sign_at(R, P, finer, 2 * bits)


def isolated_point(form: QuadraticForm, point: Isolated) -> EquilibriumPoint:
    """An isolated equilibrium with spectrum and verdicts."""
    both = invariants(form, point.x)
    signs = [sign_at(v, point.P, point.t) for v in both]
    verdict = isolated_verdict(*signs)
    try:
        at = tuple(map(float, point.at))
        spectrum = eigenvalues(*(v(point.t) if sign else ZERO for v, sign in zip(both, signs)))
    except OverflowError:
        raise InputError(
            "an equilibrium or its eigenvalues lie beyond the largest double: choose other units") from None
    return EquilibriumPoint(at, spectrum, linear_word(*signs), verdict.word, reason=verdict.reason)


def curve_with_verdicts(form: QuadraticForm, curve: RationalCurve) -> EquilibriumCurve:
    """Folds, segments and samples of a curve of equilibria (n = 0 along it)."""
    return curve.cut(cuts_of(form, curve), partial(_segment, form, curve), partial(_fold, curve))


def cuts_of(form: QuadraticForm, curve: RationalCurve) -> list[Fraction]:
    """The parameters, rising, where stability may change: poles and crossings exactly, zeros of m to 160
    bits."""
    m, _ = invariants(form, curve.numerators, curve.denominator)
    for t in (*curve.poles, *curve.crossings):
        m = m.without_root(t)
    return sorted({*curve.poles, *curve.crossings, *(real_roots(m) if m.degree > 0 else ())})


def _segment(form: QuadraticForm, curve: RationalCurve, lo: Fraction | None,
             hi: Fraction | None) -> tuple[CurveSegment, list[EquilibriumPoint]]:
    """The segment between two neighbouring cuts (None: infinite) and its samples."""
    middle = values_inside(lo, hi, curve.scale)
    m_sign = sign_of(_m_at(form, curve, middle))
    word, verdict = linear_word(m_sign, 0), _regular_verdict(curve, m_sign)
    samples = []
    for t in sample_parameters(lo, hi, curve.scale) or [middle]:
        try:
            at = tuple(float(v) for v in curve.exact_point(t))
            samples.append(EquilibriumPoint(at, eigenvalues(_m_at(form, curve, t), Fraction(0)), word,
                                            verdict.word, reason=verdict.reason))
        except OverflowError:  # a far sample beyond the largest double is left out
            continue
    return CurveSegment(float_ends(lo, hi), word, verdict.word, reason=verdict.reason), samples


def _regular_verdict(curve: RationalCurve, m_sign: int) -> Verdict:
    if m_sign < 0:
        return POSITIVE_EIGENVALUE
    return curve.grounds.positive if m_sign > 0 else DEGENERATE_CURVE


def _fold(curve: RationalCurve, t: Fraction, before: CurveSegment, after: CurveSegment) -> EquilibriumPoint:
    """The equilibrium at a zero of m: three exact zero eigenvalues."""
    signs = {before.linear, after.linear}
    if t in curve.crossings:
        verdict = curve.crossings[t]
    elif len(signs) == 2:
        verdict = curve.grounds.odd
    else:
        verdict = curve.grounds.minimum if signs == {"stable"} else curve.grounds.maximum
    at = tuple(float(v) for v in curve.exact_point(t))
    return EquilibriumPoint(at, (0j, 0j, 0j), "degenerate", verdict.word, reason=verdict.reason)


def _m_at(form: QuadraticForm, curve: RationalCurve, t: Fraction) -> Fraction:
    return invariants(form, curve.exact_point(t))[0]
