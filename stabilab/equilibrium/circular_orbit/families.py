"""Continuous families of equilibria on a circular orbit: of bodies with equal moments and a wheel along their
axis of symmetry, and of one wheel momentum along an axis of three different moments.

Each family here is given by one attitude of it, an algebraic one; a turn about an axis of the body leads to
the others. Those of a body with one axis of symmetry are its cylindrical (the axis normal to the orbit),
hyperbolic (across the vertical) and conical (across the velocity) equilibria (Likins 1965, Pringle 1966).
"""
from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import Any, NamedTuple

from flint import fmpq_mpoly, fmpq_poly

from ...numbers.algebraic import Algebraic, coefficients, univariate
from ...numbers.balls import START_BITS, fraction, rational, real_roots_of
from ...numbers.vectors import CYCLE, Exact3, cross, dot
from ...physics.circular_orbit import Satellite
from .elimination import Line, Matrix, line_through, plane, plane_of


class Family(NamedTuple):
    """One for each real root of the line's polynomial, which stands for one attitude of it; axis: of the
    body, about which it turns, None of a curve that is no turn."""

    line: Line
    axis: Exact3 | None
    words: str


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
        least = min(range(3), key=lambda n: abs(wheel[n]))
        vertical = cross(wheel, tuple(rational(n == least) for n in range(3)))
        for polynomial, _ in (dot(wheel, wheel) * t**2 - n2).factor()[1]:
            yield Family(Line(polynomial, tuple(v * one for v in vertical),
                              tuple(v * t % polynomial for v in wheel), one), satellite.momentum,
                         "the wheel's momentum normal to the orbit, any turn about it")
        return
    (i, j), h = CYCLE[k], rational(satellite.momentum[k])
    A, C = (rational(satellite.moments[n]) for n in (i, k))
    axis = _placed({k: Fraction(1)})
    for polynomial, x, y in plane(C, A, h, 0, 1, 1, n2):
        words = "normal to the orbit" if y == 0 else "across the vertical"
        yield Family(Line(polynomial, _placed({j: one}, one * 0), _placed({k: x, i: y}, one * 0), one), axis,
                     f"the axis of symmetry {words}, any turn about it")
    along = "the axis of symmetry along the vertical, any turn about it"
    if h == 0:
        for polynomial, _ in (t**2 - n2).factor()[1]:
            yield Family(Line(polynomial, _placed({k: t % polynomial}, one * 0),
                              _placed({i: t % polynomial}, one * 0), one), axis, along)
    elif 16 * n2 * (C - A)**2 > h**2:
        for polynomial, _ in (h**2 * (1 + t**2) - 16 * n2 * (C - A)**2).factor()[1]:
            X = _placed({i: one, k: t % polynomial}, one * 0)
            line = line_through(satellite, Algebraic(polynomial, 0), X)
            if line is not None:
                yield Family(line, axis, "the axis of symmetry across the velocity, any turn about it")


def _placed(parts: dict[int, Any], zero: Any = Fraction(0)) -> tuple[Any, ...]:
    """A vector with these components, zero besides."""
    return tuple(parts.get(n, zero) for n in range(3))


def along_curve(satellite: Satellite, common: fmpq_mpoly, matrix: Matrix) -> Iterator[Family]:
    """Attitudes of the curves of equilibria where `common` is zero, one unknown rational: one of each piece
    between two places where their number changes."""
    for factor, _ in common.factor()[1]:
        if factor.degrees()[1] < 1:
            continue
        cuts = [univariate(c) for c in (factor.discriminant("v"), coefficients(factor, 1)[-1])]
        found = sorted(fraction(root.mid().fmpq()) for c in cuts if c.degree() > 0
                       for root, _ in real_roots_of(c))
        ends = [found[0] - 1, *found, found[-1] + 1] if found else [Fraction(-1), Fraction(1)]
        for low, high in zip(ends, ends[1:]):
            u = rational(((low + high) / 2).limit_denominator(1000))
            for piece, _ in fmpq_poly([univariate(c)(u) for c in coefficients(factor, 1)]).factor()[1]:
                X = tuple(v % piece for v in plane_of(matrix, fmpq_poly([u]), fmpq_poly([0, 1])))
                line = line_through(satellite, Algebraic(piece, 0), X)
                if line is not None and line.roots(START_BITS):
                    yield Family(line, None, "one of a curve of equilibria that is no turn about an axis")
