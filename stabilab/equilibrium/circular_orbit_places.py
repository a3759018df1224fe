"""The attitudes at rest on a circular orbit: isolated ones, families, and the stability of each.

The isolated ones are algebraic numbers, by one polynomial of degree 12.

With w = n a2 the torques balance where a1 . I a3 = 0, a1 . (n I a2 + h) = 0 and 4 n a2 . I a3 + a3 . h = 0.
Let X be a vector along a3 and N = X x I X, which is along a1. Where N is not zero it fixes the attitude,

    n a2 = 4 n^2 (X x N)/((X . h) |X|^2),

and what is left are two homogeneous equations in X (the squared length of a1, and the second condition):

    F = 16 n^2 N . N - (X . h)^2 |X|^2 = 0,     G = 4 n^2 N . I (X x N) + (X . h)(N . h) |X|^2 = 0.

By Bezout they have 4 x 5 common points. Four of these count twice: |X|^2 = X . I X = 0, none of them real.
The 12 others are lines along +-a3, so that there are 24 equilibria at the most. A real common point with
X . h = 0 has N = 0: it is a principal axis, and then a2 is found in the plane across it,
(w x (I w + h)) = 0, by a polynomial of degree 4.

Only n^2 and h enter, so that the answer is exact for any rational n^2. F and G are eliminated along a
direction in which no two points are in line and none is at infinity, which is tested; each real root of the
resultant then stands for one line exactly.

Continuous families have bodies with equal moments and a wheel along their axis of symmetry, and one
momentum of a wheel along an axis of three different moments.

Each family here is given by one attitude of it, an algebraic one; a turn about an axis of the body leads to
the others. Those of a body with one axis of symmetry are its cylindrical (the axis normal to the orbit),
hyperbolic (across the vertical) and conical (across the velocity) equilibria (Likins 1965, Pringle 1966).

Stability: Lyapunov's function, and the exact spectrum.

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
family: where K is positive definite across it, the Jacobi integral has a strict minimum on it."""
from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import Any, NamedTuple, TypeAlias

from flint import Ordering, arb, arb_poly, fmpq_mpoly, fmpq_mpoly_ctx, fmpq_poly

from ..numbers.algebraic import Algebraic, coefficients, univariate
from ..numbers.balls import (
    START_BITS,
    Digits,
    Unclear,
    fraction,
    rational,
    real_roots_of,
    settled,
    sign,
    working,
)
from ..numbers.vectors import CYCLE, Exact3, Number, Triple, cross, dot
from ..physics.circular_orbit import Satellite
from ..reasons import Reason, Sentence

# --- Isolated attitudes at rest
Matrix: TypeAlias = tuple[tuple[int, ...], ...]


DIRECTIONS = 60  # of elimination that are tried


@dataclass(frozen=True)
class Line:
    """A line along a3 for each real root t of an irreducible polynomial; the angular velocity n a2 there is
    omega/denominator, rad/s. All are polynomials in t."""

    polynomial: fmpq_poly
    vertical: Triple
    omega: Triple
    denominator: fmpq_poly
    _known: dict[int, list[arb]] = field(default_factory=dict, repr=False, compare=False)

    def roots(self, bits: int) -> list[arb]:
        """The real roots, rising, in balls of so many bits, made once."""
        if bits not in self._known:
            with working(bits):
                self._known[bits] = [root for root, _ in real_roots_of(self.polynomial)]
        return self._known[bits]

    def at(self, root: arb) -> tuple[Triple, Triple, arb]:
        """(a vector along a3, n a2, 1/square of the first) in balls."""
        X, omega = (tuple(arb_poly(c)(root) for c in row) for row in (self.vertical, self.omega))
        bottom = arb_poly(self.denominator)(root)
        return X, tuple(c / bottom for c in omega), 1 / dot(X, X)

    @cached_property
    def exact(self) -> tuple[Triple, Triple, fmpq_poly]:
        """The same in elements of the field of t, for all roots alike."""
        number = Algebraic(self.polynomial, 0)
        bottom = number.inverse(self.denominator)
        return (self.vertical, tuple(number.reduced(c * bottom) for c in self.omega),
                number.inverse(number.reduced(dot(self.vertical, self.vertical))))


@dataclass(frozen=True)
class Found:
    """lines: of equilibria that are isolated; curve: a common factor of F and G, in two unknowns, whose zeros
    are a curve of equilibria, with the direction of elimination; None where there is none."""

    lines: tuple[Line, ...]
    curve: tuple[fmpq_mpoly, Matrix] | None = None


def isolated(satellite: Satellite) -> Found:
    """Every line, for a satellite without a continuous symmetry (see `families`)."""
    axes = eigenvectors(satellite)
    result, curve = _oblique(satellite)
    return Found((*(line for k in range(3) for line in across(satellite, axes, k)), *result), curve)


def eigenvectors(satellite: Satellite) -> tuple[Exact3, ...]:
    """Three directions across each other along principal axes; of two equal moments one along the part of the
    momentum in their plane. Not of length 1."""
    A, h = satellite.moments, satellite.momentum
    units = [tuple(Fraction(i == j) for j in range(3)) for i in range(3)]
    for i, j in CYCLE:
        if A[i] == A[j] and h[i]:
            units[i] = tuple(h[n] if n in (i, j) else Fraction(0) for n in range(3))
            units[j] = tuple({i: -h[j], j: h[i]}.get(n, Fraction(0)) for n in range(3))
    return tuple(units)


def across(satellite: Satellite, axes: Sequence[Exact3], k: int) -> Iterator[Line]:
    """Those with a3 along the axis k, which the momentum must be across."""
    i, j = CYCLE[k]
    if dot(satellite.momentum, axes[k]):
        return
    item, ((A, p, a), (B, q, b)) = fmpq_poly([1]), (about(satellite, axes[n]) for n in (i, j))
    for polynomial, x, y in plane(A, B, p, q, a, b, satellite.rate_squared):
        omega = tuple(rational(u) * x + rational(v) * y for u, v in zip(axes[i], axes[j]))
        yield Line(polynomial, tuple(rational(v) * item for v in axes[k]), omega, item)


def about(satellite: Satellite, axis: Exact3) -> tuple[Fraction, Fraction, Fraction]:
    """(moment of inertia about a principal axis, component of the momentum along it in units of the axis,
    square of the axis)."""
    square = dot(axis, axis)
    return (dot(axis, turned_by(satellite.moments, axis)) / square, dot(satellite.momentum, axis) / square,
            square)


def plane(A: Number, B: Number, p: Number, q: Number, a: Number, b: Number,
          n2: Number) -> Iterator[tuple[fmpq_poly, fmpq_poly, fmpq_poly]]:
    """(polynomial, x, y): w = x u + y v with x (B y + q) = y (A x + p) and a x^2 + b y^2 = n^2, for moments A
    and B, momentum p u + q v, a = u . u, b = v . v, u . v = 0. Not both A = B and p = q = 0."""
    A, B, p, q, a, b, n2 = map(rational, (A, B, p, q, a, b, n2))
    t, zero, D = fmpq_poly([0, 1]), fmpq_poly([0]), B - A
    if q == 0 and (D != 0 or p != 0):  # y (D x - p) = 0
        yield from _rooted(a * t**2 - n2, lambda t: (t, zero))
        if D != 0 and a * (p / D)**2 < n2:
            yield from _rooted(b * t**2 - (n2 - a * (p / D)**2), lambda t: (zero + p / D, t))
    elif p == 0:  # x (D y + q) = 0
        yield from _rooted(b * t**2 - n2, lambda t: (zero, t))
        if D != 0 and b * (q / D)**2 < n2:
            yield from _rooted(a * t**2 - (n2 - b * (q / D)**2), lambda t: (t, zero - q / D))
    else:
        slope = D * t - p  # of y = -q x/(D x - p), zero nowhere on it
        for factor, _ in ((a * t**2 - n2) * slope**2 + b * q**2 * t**2).factor()[1]:
            yield factor, t % factor, -q * t * Algebraic(factor, 0).inverse(slope % factor) % factor


def _rooted(polynomial: fmpq_poly, of_root: Any) -> Iterator[tuple[fmpq_poly, fmpq_poly, fmpq_poly]]:
    for factor, _ in polynomial.factor()[1]:
        x, y = of_root(fmpq_poly([0, 1]))
        yield factor, x % factor, y % factor


def turned_by(moments: Sequence[Number], v: Triple) -> Triple:
    """I v."""
    return tuple(d * x for d, x in zip(moments, v))


def forms(satellite: Satellite, X: Triple, scale: Number = 1) -> tuple[Number, Number]:
    """(F, G) at X, for a momentum whose square is `scale` times that of the satellite's."""
    A, h = (tuple(map(rational, row)) for row in (satellite.moments, satellite.momentum))
    n2 = rational(satellite.rate_squared)
    N, square = cross(X, turned_by(A, X)), dot(X, X)
    return (16 * n2 * dot(N, N) - scale * dot(h, X)**2 * square,
            4 * n2 * dot(N, turned_by(A, cross(X, N))) + scale * dot(h, X) * dot(h, N) * square)


def directions(satellite: Satellite) -> Iterator[Matrix]:
    """Matrices M for X = M (u, v, 1): the principal axes, the middle one last, so that no real u belongs to
    the four points that count twice; then such in no particular position."""
    first, middle, last = sorted(range(3), key=lambda n: satellite.moments[n])
    yield tuple(tuple(int(n == m) for m in (first, last, middle)) for n in range(3))
    yield from (((3 + k, 1, 2), (-1, 2 + k, 3), (2, -3 - k, 1 + k * k)) for k in range(DIRECTIONS))


def plane_of(matrix: Matrix, u: Number, v: Number) -> Triple:
    """X = M (u, v, 1)."""
    return tuple(row[0] * u + row[1] * v + row[2] for row in matrix)


def _oblique(satellite: Satellite) -> tuple[list[Line], tuple[fmpq_mpoly, Matrix] | None]:
    """Those with a3 off the principal axes."""
    if not any(satellite.momentum):
        return [], None  # F is N . N alone
    ring = fmpq_mpoly_ctx.get(("u", "v"), Ordering.lex)
    for matrix in directions(satellite):
        X = plane_of(matrix, *ring.gens())
        F, G = forms(satellite, X)
        if F.total_degree() < 4 or G.total_degree() in range(5):  # G may be zero
            continue  # all points at infinity are on one of them
        common = F.gcd(G)
        curve = None if common.is_constant() else (common, matrix)
        lines = _eliminated(satellite, matrix, F / common, G / common, common)
        if lines is not None:
            return lines, curve
    raise ArithmeticError("no direction of elimination tells the equilibria apart")


def _eliminated(satellite: Satellite, matrix: Matrix, F: fmpq_mpoly, G: fmpq_mpoly,
                common: fmpq_mpoly) -> list[Line] | None:
    """The real common points of F and G off the curve; None where the direction does not tell them apart."""
    if F.is_constant() or G.is_constant():
        return []
    rows = [coefficients(f, 1) for f in (F, G)]
    resultant = coefficients(F.resultant(G, "v"), 0)
    if (len(rows[0]) - 1 != F.total_degree() or len(resultant) - 1 != F.total_degree() * G.total_degree()):
        return None  # a point is at infinity
    full = fmpq_poly([c.leading_coefficient() if c != 0 else 0 for c in resultant])
    lines = []
    for factor, _ in full.factor()[1]:
        if not real_roots_of(factor):
            continue
        number = Algebraic(factor, 0)
        over = [number.trimmed([univariate(c) for c in row]) for row in rows]
        powers = number.powers(number.gcd(*over))
        if len(powers) != 1 or len(powers[0][0]) != 2:
            return None  # two points are in line
        v = -number.monic(powers[0][0])[0] % factor
        X = tuple(c % factor for c in plane_of(matrix, fmpq_poly([0, 1]), v))
        line = line_through(satellite, number, X)
        if line is not None and (common.is_constant() or _at(common, number, v) != 0):
            lines.append(line)
    return lines


def line_through(satellite: Satellite, number: Algebraic, X: Triple) -> Line | None:
    """The line through X, None of a principal axis across the momentum."""
    A, h = (tuple(map(rational, row)) for row in (satellite.moments, satellite.momentum))
    along, square = number.reduced(dot(h, X)), number.reduced(dot(X, X))
    if along == 0:
        return None
    N = tuple(map(number.reduced, cross(X, turned_by(A, X))))
    across = tuple(4 * rational(satellite.rate_squared) * number.reduced(c) for c in cross(X, N))
    return Line(number.polynomial, X, across, number.reduced(along * square))


def _at(f: fmpq_mpoly, number: Algebraic, v: fmpq_poly) -> fmpq_poly:
    """f(t, v) in the field of t."""
    total = number.polynomial * 0
    for c in reversed(coefficients(f, 1)):
        total = number.reduced(total * v + univariate(c))
    return total


# --- Continuous families
class Family(NamedTuple):
    """One for each real root of the line's polynomial, which stands for one attitude of it; axis: of the
    body, about which it turns, None of a curve that is no turn; consists: of what."""

    line: Line
    axis: Exact3 | None
    consists: Reason


WHEEL_NORMAL = Sentence("family-wheel-normal",
                        "the wheel's momentum normal to the orbit, any turn about it")()
AXIS_NORMAL = Sentence("family-cylindrical",
                       "the axis of symmetry normal to the orbit, any turn about it")()
AXIS_ACROSS_VERTICAL = Sentence("family-hyperbolic",
                                "the axis of symmetry across the vertical, any turn about it")()
AXIS_ALONG_VERTICAL = Sentence("family-along-vertical",
                               "the axis of symmetry along the vertical, any turn about it")()
AXIS_ACROSS_VELOCITY = Sentence("family-conical",
                                "the axis of symmetry across the velocity, any turn about it")()
NO_TURN = Sentence("family-no-turn", "one of a curve of equilibria that is no turn about an axis")()


def symmetry(satellite: Satellite) -> int | None:
    """The axis about which a turn of the body changes nothing: 0, 1 or 2; 3 for all three of a sphere, None
    where there is none."""
    A, h = satellite.moments, satellite.momentum
    if A[0] == A[1] == A[2]:
        return 3
    return next((k for k, (i, j) in enumerate(CYCLE) if A[i] == A[j] and not h[i] and not h[j]), None)


def turned(satellite: Satellite, k: int) -> Iterator[Family]:
    """The families of a body with the axis of symmetry k, or of a sphere (3) with a wheel."""
    t, one, n2 = fmpq_poly([0, 1]), fmpq_poly([1]), rational(satellite.rate_squared)
    if k == 3:
        wheel = tuple(map(rational, satellite.momentum))
        smallest = min(range(3), key=lambda n: abs(wheel[n]))
        vertical = cross(wheel, tuple(rational(n == smallest) for n in range(3)))
        for polynomial, _ in (dot(wheel, wheel) * t**2 - n2).factor()[1]:
            yield Family(Line(polynomial, tuple(v * one for v in vertical),
                              tuple(v * t % polynomial for v in wheel), one), satellite.momentum,
                         WHEEL_NORMAL)
        return
    (i, j), h = CYCLE[k], rational(satellite.momentum[k])
    A, C = (rational(satellite.moments[n]) for n in (i, k))
    axis = _placed({k: Fraction(1)})
    for polynomial, x, y in plane(C, A, h, 0, 1, 1, n2):
        yield Family(Line(polynomial, _placed({j: one}, one * 0), _placed({k: x, i: y}, one * 0), one), axis,
                     AXIS_NORMAL if y == 0 else AXIS_ACROSS_VERTICAL)
    if h == 0:
        for polynomial, _ in (t**2 - n2).factor()[1]:
            yield Family(Line(polynomial, _placed({k: t % polynomial}, one * 0),
                              _placed({i: t % polynomial}, one * 0), one), axis, AXIS_ALONG_VERTICAL)
    elif 16 * n2 * (C - A)**2 > h**2:
        for polynomial, _ in (h**2 * (1 + t**2) - 16 * n2 * (C - A)**2).factor()[1]:
            X = _placed({i: one, k: t % polynomial}, one * 0)
            line = line_through(satellite, Algebraic(polynomial, 0), X)
            if line is not None:
                yield Family(line, axis, AXIS_ACROSS_VELOCITY)


def _placed(parts: dict[int, Any], zero: Fraction | fmpq_poly = Fraction(0)) -> tuple[Any, ...]:
    """A vector with these components, zero besides."""
    return tuple(parts.get(n, zero) for n in range(3))


def along_curve(satellite: Satellite, common: fmpq_mpoly, matrix: Matrix) -> Iterator[Family]:
    """Attitudes of the curves of equilibria where `common` is zero, one unknown rational: one of each piece
    between two places where their number changes."""
    for factor, _ in common.factor()[1]:
        if factor.degrees()[1] < 1:
            continue
        cuts = [univariate(c) for c in (factor.discriminant("v"), coefficients(factor, 1)[-1])]
        result = sorted(fraction(root.mid().fmpq()) for c in cuts if c.degree() > 0
                       for root, _ in real_roots_of(c))
        ends = [result[0] - 1, *result, result[-1] + 1] if result else [Fraction(-1), Fraction(1)]
        for low, high in zip(ends, ends[1:]):
            u = rational(((low + high) / 2).limit_denominator(1000))
            for piece, _ in fmpq_poly([univariate(c)(u) for c in coefficients(factor, 1)]).factor()[1]:
                X = tuple(v % piece for v in plane_of(matrix, fmpq_poly([u]), fmpq_poly([0, 1])))
                line = line_through(satellite, Algebraic(piece, 0), X)
                if line is not None and line.roots(START_BITS):
                    yield Family(line, None, NO_TURN)


# --- Stability
LYAPUNOV = Sentence(
    "orbit-lyapunov",
    "the second variation of the dynamic potential is positive definite: the Jacobi integral is a Lyapunov "
    "function")()
SPREAD = Sentence(
    "orbit-lyapunov-family",
    "the second variation of the dynamic potential is positive definite across the family: the Jacobi "
    "integral is a Lyapunov function of the family as a whole, along which the attitude may drift")()
GROWING = Sentence("orbit-growing", "an eigenvalue of the linear motion has a positive real part")()
GYROSCOPIC = Sentence(
    "orbit-gyroscopic",
    "the dynamic potential has no minimum here, but all eigenvalues are imaginary and different: gyroscopic "
    "stability, which energy does not prove and any complete dissipation destroys")()
FLAT = Sentence(
    "orbit-flat",
    "the second variation of the dynamic potential is singular and a frequency is zero: terms of higher "
    "order decide")()
DOUBLE = Sentence(
    "orbit-two-frequencies",
    "the dynamic potential has no minimum here and two frequencies are equal: terms that linear motion "
    "leaves out decide")()


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


def verdict_of(signs: Signs, family: bool) -> tuple[str, str, Reason]:
    """(linear, verdict, reason)."""
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


def characteristic_coefficients(satellite: Satellite, omega: Triple, X: Triple,
                                reciprocal: Number) -> tuple[Triple, Triple]:
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
        values = deciding(*characteristic_coefficients(satellite, omega, X, reciprocal), family)
        if any(arb(v).contains(0) for v in values) and not vanishing:
            if digits.bits < 4 * START_BITS:
                raise Unclear  # more digits cost less than exact zeros
            vanishing.extend(_vanish(satellite, line, family))
        resolved = vanishing or [False] * len(values)
        return Signs(*(0 if zero else sign(arb(v)) for v, zero in zip(values, resolved)))
    return settled(asked, 2 * START_BITS)


def _vanish(satellite: Satellite, line: Line, family: bool) -> list[bool]:
    """Which of the deciding numbers are zero, exactly, at every root alike."""
    X, omega, reciprocal = line.exact
    values = deciding(*characteristic_coefficients(satellite, omega, X, reciprocal), family)
    return [(fmpq_poly([0]) + v) % line.polynomial == 0 for v in values]
