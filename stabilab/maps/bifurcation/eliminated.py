"""A diagram's equations in one unknown: R(x; p, q) = 0, the values at which its number of real roots may
change, and its roots.

What is known at a point of the range is known exactly: p and q are rational there, or p is an algebraic
number and R is split into powers over the field of it. Two points one above another (equal x) would be taken
for one, so a point where anything may happen is looked at along several directions x - lean y: two points are
in line for one lean at the most, so the greatest number of roots is the number of points.
"""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import prod
from typing import NamedTuple

from flint import arb, fmpq_mpoly, fmpq_poly

from ...numbers.algebraic import Algebraic, Powers, coefficients, univariate
from ...numbers.balls import Unclear, evaluated, rational, real_roots_of
from .equations import LEANS, Conics, Family, OnLine, common_divisor

SPARE = 7  # leans looked at: of four points in the plane, complex ones counted, at most six pairs are in line
PROBES = (Fraction(37, 97), Fraction(53, 89))  # parts of the range where the general case is looked at


class Root(NamedTuple):
    """A ball about an unknown, how often it counts, and the state y in balls."""

    x: arb
    times: int
    y: tuple[arb, ...]


@dataclass(frozen=True)
class Leant:
    """R in x - lean y. guard: the constant coefficients of y^2 (of y, for lines); where both vanish points
    may be invented."""

    lean: Fraction
    f: fmpq_mpoly
    g: fmpq_mpoly
    R: fmpq_mpoly
    guard: tuple[fmpq_mpoly, ...]


@dataclass(frozen=True)
class Eliminated:
    """The one unknown's polynomial over a family, with all that may change the number of its real roots."""

    family: Family
    system: OnLine | Conics

    @cached_property
    def views(self) -> tuple[Leant, ...]:
        """R along several directions; of a line there is one."""
        if isinstance(self.system, OnLine):
            x, c = self.family.ring.gens()[0], self.system.coefficients
            return (Leant(Fraction(0), c[0], c[0], c[0] + x * c[1] + x * x * c[2],
                          (self.family.ring.constant(1),)),)
        return tuple(built for lean in LEANS if (built := self._leant(lean)) is not None)

    @cached_property
    def main(self) -> Leant:
        """The first view in which the general point has as many roots as in any."""
        at = tuple(span.low + (span.high - span.low) * part for span, part in zip(self.family.spans, PROBES))
        return max(self.views, key=lambda view: _distinct(univariate(at_rational(view.R, at))))

    @cached_property
    def reduced(self) -> fmpq_mpoly:
        """R of the main view, each of its factors once, without those that hold no unknown."""
        return self.once(self.main.R)

    @cached_property
    def critical(self) -> tuple[fmpq_mpoly, ...]:
        """Irreducible polynomials in the numbers that vary, one of which is zero wherever the number of real
        roots changes."""
        R = self.reduced
        parts = [coefficients(R, 0)[-1], common_divisor(self.main.guard)]
        if R.degrees()[0] > 1:
            parts.append(R.resultant(R.derivative("x"), "x"))
        parts += [f for f, _ in _factors(self.main.R) if f.degrees()[0] < 1]
        parts.append(self.system.special)
        entries = {str(factor): factor for part in parts for factor, _ in _factors(part)}
        return tuple(factor for factor in entries.values() if not factor.is_constant())

    def _leant(self, lean: Fraction) -> Leant | None:
        f, g = self.system.leant(lean)  # type: ignore[union-attr]  # a line is not asked
        # of two lines all over the range y itself has constant coefficients
        highest = 2 if any(powers[0] + powers[1] > 1 for h in (f, g) for powers in h.to_dict()) else 1
        guard = tuple(coefficients(h, 1, 3)[highest] for h in (f, g))
        if all(c.is_zero() for c in guard):
            return None
        if max(f.degrees()[1], g.degrees()[1]) < 1:
            return Leant(lean, f, g, f.gcd(g), guard)
        return Leant(lean, f, g, f * 0 if f.is_zero() or g.is_zero() else f.resultant(g, "y"), guard)

    def once(self, R: fmpq_mpoly) -> fmpq_mpoly:
        """The product of its different factors that hold the unknown."""
        return prod((factor for factor, _ in _factors(R) if factor.degrees()[0] > 0),
                    start=self.family.ring.constant(1))

    def at_general(self, values: tuple[Fraction, ...], view: Leant | None = None) -> list[Root]:
        """The same at a point where nothing happens, by one view, else the main one: rising in x, so that
        branches keep their numbers."""
        view, at = view or self.main, [rational(v) for v in values]
        return [Root(x, times, self.state(view, x, at))
                for x, times in real_roots_of(univariate(at_rational(view.R, values)))]

    def at_algebraic(self, number: Algebraic, bits: int) -> list[Root] | None:
        """The equilibria at an algebraic p (a family of one number), None where they are not isolated.
        Unclear where so many bits do not tell."""
        split = self._split(number)
        if split is None:
            return None
        view, powers = split
        return [Root(x, times, self.state(view, x, [number.ball(bits)]))
                for x, times in number.real_roots(powers, bits)]

    def _split(self, number: Algebraic) -> tuple[Leant, Powers] | None:
        """(view, R there in square-free factors with their powers), of the view with most roots; once for
        each number."""
        key = (str(number.polynomial), number.index)
        if key not in self._known:
            # the main view alone where it has no two points in line, else as many as tell
            apart = self.apart is not None and number.reduced(univariate(self.apart, 2)) != 0
            views = (self.main,) if apart and not _lost(self.main, number) else self.views[:SPARE + 1]
            built = [(view, number.powers(f)) for view in views if not _lost(view, number)
                    if (f := number.trimmed(over_field(view.R)))]
            self._known[key] = (max(built, key=lambda item: sum(len(factor) - 1 for factor, _ in item[1]))
                                if built else self._of_lines(number))
        return self._known[key]

    def _of_lines(self, number: Algebraic) -> tuple[Leant, Powers] | None:
        """As `_split` where both conics become lines at the number, f0 + f1 x + f2 y and g0 + g1 x + g2 y:
        these meet in one point, in none, or are one line (None); None for conics, too."""
        view = self.main
        zero = number.polynomial * 0
        rows = []
        for h in (view.f, view.g):
            at = [[number.reduced(c) for c in over_field(row, 1)] for row in coefficients(h, 0, 3)]
            if any(c != 0 for n, row in enumerate(at) for m, c in enumerate(row) if n + m > 1):
                return None
            rows.append((at[0][0], at[1][0], at[0][1] if len(at[0]) > 1 else zero))
        (f0, f1, f2), (g0, g1, g2) = rows
        across, constant, other = (number.reduced(c)
                                   for c in (f1 * g2 - g1 * f2, f0 * g2 - g0 * f2, f0 * g1 - g0 * f1))
        if across != zero:
            return view, [([constant, across], 1)]
        empty = any(row[0] != zero and row[1] == zero and row[2] == zero for row in rows)
        return (view, []) if empty or constant != zero or other != zero else None

    @cached_property
    def _known(self) -> dict[tuple[str, int], tuple[Leant, Powers] | None]:
        return {}

    @cached_property
    def apart(self) -> fmpq_mpoly | None:
        """A polynomial: where it is not zero the main view has one point at the most above each x, because f
        = a(x) + b(x) y and a, b share no root."""
        f = self.main.f
        if isinstance(self.system, OnLine):
            return self.family.ring.constant(1)
        if f.degrees()[1] != 1:
            return None
        a, b = coefficients(f, 1)
        return b if b.degrees()[0] < 1 else a if a.degrees()[0] < 1 else a.resultant(b, "x")

    def flat(self, number: Algebraic) -> bool:
        """Whether m vanishes too at the double root x = -c1/(2 c2) of a line, exactly: all three eigenvalues
        are zero there."""
        line = self.system
        if not isinstance(line, OnLine):
            return False
        _, c1, c2 = (number.reduced(univariate(c, 2)) for c in line.coefficients)
        x, total = number.reduced(number.inverse(2 * c2) * -c1), number.polynomial * 0
        for c in reversed(over_field(line.m(self.family))):
            total = number.reduced(total * x + c)
        return bool(total == 0)

    def state(self, view: Leant, x: arb, values: list) -> tuple[arb, ...]:
        """The state y above a root x, in balls, at values of the numbers that vary."""
        of = lambda polynomial, *unknowns: evaluated(polynomial,
                                                     [*unknowns, *([arb(0)] * (2 - len(unknowns))), *values])
        if isinstance(self.system, OnLine):
            below = of(self.system.below)
            return tuple((of(s) + x * of(a)) / below for s, a in zip(self.system.start, self.system.along))
        rows = [[of(c, x) for c in coefficients(h, 1, 3)] for h in (view.f, view.g)]
        y = _common(rows)
        location = {(self.system.axis + 1) % 3: x + y * rational(view.lean), (self.system.axis + 2) % 3: y}
        return tuple(location.get(n, arb(0)) for n in range(3))


def _distinct(f: fmpq_poly) -> int:
    """The number of different roots, complex ones counted; more than any has where all numbers are roots."""
    return 9 if f.degree() < 0 else int(f.degree() - f.gcd(f.derivative()).degree()) if f.degree() else 0


def _common(rows: list[list[arb]]) -> arb:
    """The y that solves two quadratics a0 + a1 y + a2 y^2 at once: by the linear combination without y^2,
    else the one root that serves both."""
    (a0, a1, a2), (b0, b1, b2) = rows
    rate = b2 * a1 - a2 * b1
    if not rate.contains(0):
        return (a2 * b0 - b2 * a0) / rate
    for (c0, c1, c2), (d0, d1, d2) in (rows, rows[::-1]):
        candidates = [-c0 / c1] if c2.contains(0) and not c1.contains(0) else []
        if not c2.contains(0):
            half = (c1 * c1 - 4 * c2 * c0)
            root = half.nonnegative_part().sqrt()
            candidates = [(-c1 + s * root) / (2 * c2) for s in (1, -1)]
        fitting = [y for y in candidates if (d0 + d1 * y + d2 * y * y).contains(0)]
        if fitting:
            return fitting[0]
    raise Unclear


def _factors(f: fmpq_mpoly) -> list[tuple[fmpq_mpoly, int]]:
    return [] if f.is_zero() or f.is_constant() else f.factor()[1]


def at_rational(f: fmpq_mpoly, values: tuple[Fraction, ...]) -> fmpq_mpoly:
    """With rational numbers in the place of p (and q)."""
    return f.subs(dict(zip("pq", map(rational, values))))


def over_field(f: fmpq_mpoly, variable: int = 0) -> list[fmpq_poly]:
    """Coefficients of the powers of a variable, as polynomials in p."""
    return [univariate(c, 2) for c in coefficients(f, variable)]


def _lost(view: Leant, number: Algebraic) -> bool:
    """Whether its guard vanishes at the number."""
    return all(number.reduced(univariate(c, 2)) == 0 for c in view.guard)
