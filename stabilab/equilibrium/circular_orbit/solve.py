"""All equilibria of a satellite on a circular orbit, with their stability."""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from math import hypot, sqrt
from typing import Any, NamedTuple

from flint import arb, fmpq_poly

from ...numbers.balls import Digits, Unclear, rational, settled
from ...numbers.vectors import cross, dot
from ...physics.circular_orbit import Satellite
from .elimination import Line, isolated
from .families import Family, along_curve, symmetry, turned
from .result import OrbitEquilibria, OrbitEquilibrium
from .stability import FLAT, Signs, coefficients, signs_at, verdict_of

BITS = 256  # of the numbers behind the doubles of an answer, at first
NOTHING, ENOUGH = 2.0**-150, 2.0**-100  # of a number of the size of 1; of a ball's width, relative
ORDER = ("stable", "undecided", "unstable")
EVERY = "all moments are equal and there is no wheel momentum: no torque acts, every attitude is an " \
        "equilibrium"
COMPLETE = "each line of the vertical is a real root of polynomials with exact coefficients, none is " \
           "missed; a half turn about the orbit normal leads to the other of each pair"
SPREAD = "turns about an axis of the body change nothing"
ON_CURVE = "on a curve of equilibria, or next to one"
LEAST = "the dynamic potential is flat to second order here, but less than at any other equilibrium: the " \
        "Jacobi integral is a Lyapunov function"
CURVED = "the equations have a common factor at exactly this wheel momentum"


class _Solved(NamedTuple):
    """An equilibrium with the exact signs behind its verdict and a ball about its dynamic potential."""

    one: OrbitEquilibrium
    signs: Signs
    potential: arb


def orbit_equilibria(satellite: Satellite) -> OrbitEquilibria:
    """Every equilibrium in the orbital frame, none missed and none invented."""
    k = symmetry(satellite)
    if k == 3 and not any(satellite.momentum):
        return OrbitEquilibria("all", EVERY)
    if k is not None:
        return OrbitEquilibria("curves", f"{SPREAD}; {COMPLETE}", (), _of(satellite, turned(satellite, k)))
    places = isolated(satellite)
    points = [one for line in places.lines for one in _solved(satellite, line)]
    families = () if places.curve is None else _of(satellite, along_curve(satellite, *places.curve))
    if families:
        on = [replace(solved.one, family=ON_CURVE) for solved in points if not solved.signs.determinant]
        families, points = _sorted([*on, *families]), [one for one in points if one.signs.determinant]
    else:
        points = [_with_least(solved, points) for solved in points]
    return OrbitEquilibria("curves" if families else "points",
                           f"{CURVED}; {COMPLETE}" if families else COMPLETE,
                           tuple(other for one in _sorted([solved.one for solved in points])
                                 for other in (one, _half_turned(one))), families)


def _of(satellite: Satellite, families: Iterable[Family]) -> tuple[OrbitEquilibrium, ...]:
    return _sorted([solved.one for family in families for solved in _solved(satellite, family.line, family)])


def _sorted(found: Iterable[OrbitEquilibrium]) -> tuple[OrbitEquilibrium, ...]:
    return tuple(sorted(found, key=lambda one: (ORDER.index(one.verdict), one.potential)))


def _with_least(solved: _Solved, points: Iterable[_Solved]) -> _Solved:
    """Stable where the dynamic potential, flat to second order, is less than at all others: it is least
    somewhere on the compact set of attitudes, and an isolated place of that kind is a strict minimum."""
    if solved.one.because != FLAT or not all(solved.potential < other.potential for other in points
                                             if other is not solved):
        return solved
    return solved._replace(one=replace(solved.one, verdict="stable", because=LEAST))


def _half_turned(one: OrbitEquilibrium) -> OrbitEquilibrium:
    """The other one of a pair: turned about the orbit normal by half a turn."""
    back = lambda v: tuple(0.0 - c for c in v)
    return replace(one, velocity=back(one.velocity), vertical=back(one.vertical))


def _solved(satellite: Satellite, line: Line, family: Family | None = None) -> list[_Solved]:
    """One attitude for each real root of the line's polynomial."""
    return [_attitude(satellite, line, index, family) for index in range(len(line.roots(BITS)))]


def _attitude(satellite: Satellite, line: Line, index: int, family: Family | None) -> _Solved:
    signs = signs_at(satellite, line, index, family is not None)
    linear, verdict, because = verdict_of(signs, family is not None)
    axis = None if family is None or family.axis is None else tuple(map(float, family.axis))
    size = rational(satellite.rate_squared * max(satellite.moments))

    def asked(digits: Digits) -> _Solved:
        X, omega, reciprocal = line.at(line.roots(digits.bits)[index])
        scale, rate = arb(reciprocal).sqrt(), arb(rational(satellite.rate_squared)).sqrt()
        up, normal = tuple(v * scale for v in X), tuple(w / rate for w in omega)
        potential = _potential(satellite, up, omega)
        _, cubic = coefficients(satellite, omega, X, reciprocal)
        squares = _squares(satellite, cubic, signs)
        return _Solved(OrbitEquilibrium(
            _doubles(cross(normal, up)), _doubles(normal), _doubles(up), linear, verdict, because,
            signs.minimum, _eigenvalues(squares),
            tuple(sorted(sqrt(-m.real) for m in squares if not m.imag and m.real < 0)),
            _doubles([potential / size])[0] * float(size), family.words if family else "",
            axis and tuple(v / hypot(*axis) for v in axis)), signs, potential)
    return settled(asked, BITS)


def _potential(satellite: Satellite, up: tuple[arb, ...], omega: tuple[arb, ...]) -> arb:
    """3/2 n^2 a3 . I a3 - w . I w/2 - h . w with w = n a2."""
    A, h = (tuple(map(rational, row)) for row in (satellite.moments, satellite.momentum))
    drawn, spun = (sum((d * v * v for d, v in zip(A, row)), arb(0)) for row in (up, omega))
    return 3 * rational(satellite.rate_squared) * drawn / 2 - spun / 2 - dot(h, omega)


def _doubles(values: Iterable[arb]) -> tuple[float, ...]:
    """Numbers of the size of 1 as doubles; below `NOTHING` they are zero. Unclear of a ball that is too wide.
    """
    return tuple(float(v.mid()) for v in map(_narrow, values))


def _narrow(value: arb) -> arb:
    """The ball's middle, where it has more digits than a double or is as good as zero."""
    if abs(value) < NOTHING:
        return arb(0)
    if not value.rad() < ENOUGH * abs(value):
        raise Unclear
    return value.mid()


def _squares(satellite: Satellite, cubic: Sequence[arb], signs: Signs) -> list[complex]:
    """The squares of the eigenvalues, 1/s^2: real ones exactly real, the one of a zero determinant zero."""
    n2, product = rational(satellite.rate_squared), cubic[0]
    scaled = [_narrow(arb(c) / product / n2**k) for k, c in enumerate(cubic)]
    if not signs.determinant:
        scaled[3] = arb(0)
    roots: list[Any] = fmpq_poly([c.fmpq() for c in reversed(scaled)]).complex_roots()
    real, size = signs.discriminant >= 0, float(n2)
    return [complex(float(root.real.mid()) * size, 0.0 if real else float(root.imag.mid()) * size)
            for root, times in roots for _ in range(times)]


def _eigenvalues(squares: list[complex]) -> tuple[complex, ...]:
    """Both roots of each, exactly real or imaginary where the square is real."""
    out = []
    for m in sorted(squares, key=lambda m: (m.imag != 0, m.real, m.imag)):
        root = m**0.5 if m.imag else complex(sqrt(m.real)) if m.real > 0 else complex(0.0, sqrt(-m.real))
        out += [root, complex(0.0 - root.real, 0.0 - root.imag)]
    return tuple(out)
