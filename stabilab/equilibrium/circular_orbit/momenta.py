"""How many equilibria there are as the momentum of the wheels grows along one direction.

With a momentum s h the equations F = G = 0 of `elimination` are polynomials in s^2. The number of their real
common points, and of the roots of the balances across the principal axes, can change only where the resultant
R(u, s^2) gets a double root, loses its leading coefficient or vanishes: at roots of polynomials in s with
exact coefficients (discriminants, resultants of factors, leading coefficients, contents). They are all
isolated, and between two of them the equilibria at one rational s stand for all.
"""
from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations

from flint import Ordering, fmpq_mpoly, fmpq_mpoly_ctx, fmpq_poly

from ...numbers.algebraic import coefficients, cuts, gaps, univariate
from ...numbers.balls import rational
from ...numbers.vectors import CYCLE, dot
from ...physics.circular_orbit import Satellite
from .elimination import about, directions, eigenvectors, forms, plane_of
from .families import symmetry
from .solve import orbit_equilibria


@dataclass(frozen=True)
class MomentumSpan:
    """From `low` to `high`, in units of the satellite's own momentum: how many equilibria there are, and how
    many of them are minima of the dynamic potential, which are stable. Of a body with an axis of symmetry:
    how many families."""

    low: float
    high: float
    count: int
    minima: int
    families: bool = False


def spans(satellite: Satellite, most: Fraction) -> tuple[MomentumSpan, ...]:
    """The open intervals of s in (0, most), for a momentum s times the satellite's, which is not zero; the
    number is that of the whole interval and differs from the next one's, in all or in minima."""
    found = cuts((factor for f in _critical(satellite) for factor, _ in f.factor()[1]), Fraction(0), most)
    joined: list[MomentumSpan] = []
    for gap in gaps(found, Fraction(0), most):
        if gap is None:
            continue
        span = _counted(satellite, gap.low, gap.high, gap.sample)
        last = joined[-1] if joined else None
        if last and (last.count, last.minima) == (span.count, span.minima):
            joined[-1] = replace(last, high=span.high)
        else:
            joined.append(span)
    return tuple(joined)


def _counted(satellite: Satellite, low: float, high: float, s: Fraction) -> MomentumSpan:
    found = orbit_equilibria(replace(satellite, momentum=tuple(s * h for h in satellite.momentum)))
    every = found.points or found.families
    stable = [one for one in every if one.minimum or (one.family and one.verdict == "stable")]
    return MomentumSpan(low, high, len(every), len(stable), not found.points)


def _critical(satellite: Satellite) -> Iterator[fmpq_poly]:
    """Polynomials in s, one of which is zero wherever the number changes."""
    k, s2, n2 = symmetry(satellite), fmpq_poly([0, 0, 1]), rational(satellite.rate_squared)
    if k == 3:
        return
    if k is not None:
        C, A = (rational(satellite.moments[n]) for n in (k, CYCLE[k][0]))
        for times in (1, 16):
            yield rational(satellite.momentum[k])**2 * s2 - times * n2 * (C - A)**2
        return
    yield from _across(satellite)
    yield from (f(s2 / n2) for f in _oblique(replace(satellite, rate_squared=Fraction(1))))


def _across(satellite: Satellite) -> Iterator[fmpq_poly]:
    """Of the vertical along a principal axis: see `elimination.plane`."""
    axes, h, n2 = eigenvectors(satellite), satellite.momentum, rational(satellite.rate_squared)
    ring = fmpq_mpoly_ctx.get(("t", "s"), Ordering.lex)
    t, s = ring.gens()
    for k, (i, j) in enumerate(CYCLE):
        if dot(h, axes[k]):
            continue
        (A, p, a), (B, q, b) = (map(rational, about(satellite, axes[n])) for n in (i, j))
        D = B - A
        if p != 0 and q != 0:
            quartic = (a * t**2 - n2) * (D * t - p * s)**2 + b * q**2 * s**2 * t**2
            yield from _singular([quartic], "t")
        else:
            yield fmpq_poly([-n2 * D**2, 0, a * p**2 + b * q**2])


def _oblique(satellite: Satellite) -> list[fmpq_poly]:
    """Of the vertical off the principal axes, on an orbit of rate 1: polynomials in s^2."""
    ring = fmpq_mpoly_ctx.get(("u", "v", "s"), Ordering.lex)
    u, v, s = ring.gens()
    for matrix in directions(satellite):
        F, G = forms(satellite, plane_of(matrix, u, v), s)
        R = F.resultant(G, "v")
        factors = [(f, times) for f, times in R.factor()[1]]
        moving = [f for f, _ in factors if f.degrees()[0] and f.degrees()[2]]
        if R.degrees()[0] < 20 or F.degrees()[1] < 4 or any(times > 1 for f, times in factors if f in moving):
            continue  # a point is at infinity, or two are in line whatever s is
        resting = [f for f, _ in factors if f.degrees()[0] == 1 and not f.degrees()[2]]  # principal axes
        contents = [univariate(f, -1) for f, _ in factors if not f.degrees()[0]]
        return [*contents, *_singular([*moving, *resting], "u")]
    raise ArithmeticError("no direction of elimination tells the equilibria apart")


def _singular(factors: Iterable[fmpq_mpoly], variable: str) -> Iterator[fmpq_poly]:
    """Where one of them has a double root, two share one, or a root is at infinity; in the last variable."""
    every = list(factors)
    for f in every:
        yield univariate(coefficients(f, 0)[-1], -1)
        if f.degrees()[0] > 1:
            yield univariate(f.discriminant(variable), -1)
    for f, g in combinations(every, 2):
        yield univariate(f.resultant(g, variable), -1)
