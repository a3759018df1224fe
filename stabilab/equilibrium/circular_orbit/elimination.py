"""All attitudes at rest in the orbital frame, as algebraic numbers: by one polynomial of degree 12.

With w = n a2 the torques balance where a1 . I a3 = 0, a1 . (n I a2 + h) = 0 and 4 n a2 . I a3 + a3 . h = 0.
Let X be a vector along a3 and N = X x I X, which is along a1. Where N is not zero it fixes the attitude,

    n a2 = 4 n^2 (X x N)/((X . h) |X|^2),

and what is left are two homogeneous equations in X (the squared length of a1, and the second condition):

    F = 16 n^2 N . N - (X . h)^2 |X|^2 = 0,     G = 4 n^2 N . I (X x N) + (X . h)(N . h) |X|^2 = 0.

By Bezout they have 4 x 5 common points. Four of these count twice: |X|^2 = X . I X = 0, none of them real.
The 12 others are lines along +-a3, so that there are 24 equilibria at the most. A real common point with
X . h = 0 has N = 0: it is a principal axis, and then a2 is found in the plane across it,
(w x (I w + h)) = 0, by a polynomial of degree 4.

Only n^2 and h enter, so that all is exact for any rational n^2. F and G are eliminated along a direction in
which no two points are in line and none is at infinity, which is tested; each real root of the resultant
then stands for one line exactly.
"""
from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import Any, TypeAlias

from flint import Ordering, arb, arb_poly, fmpq_mpoly, fmpq_mpoly_ctx, fmpq_poly

from ...numbers.algebraic import Algebraic, coefficients, univariate
from ...numbers.balls import rational, real_roots_of, working
from ...numbers.vectors import CYCLE, Exact3, Number, Triple, cross, dot
from ...physics.circular_orbit import Satellite

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
    found, curve = _oblique(satellite)
    return Found((*(line for k in range(3) for line in across(satellite, axes, k)), *found), curve)


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
    one, ((A, p, a), (B, q, b)) = fmpq_poly([1]), (about(satellite, axes[n]) for n in (i, j))
    for polynomial, x, y in plane(A, B, p, q, a, b, satellite.rate_squared):
        omega = tuple(rational(u) * x + rational(v) * y for u, v in zip(axes[i], axes[j]))
        yield Line(polynomial, tuple(rational(v) * one for v in axes[k]), omega, one)


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
    whole = fmpq_poly([c.leading_coefficient() if c != 0 else 0 for c in resultant])
    lines = []
    for factor, _ in whole.factor()[1]:
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
