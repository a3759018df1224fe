"""Where the two conditions meet in a line: the exact zeros of the rates on it, and whether the boxes hold each of them once."""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import isqrt

from ..numbers import exact_sign, q


@dataclass(frozen=True)
class Place:
    """An equilibrium on the line, exactly: x_i = middle[i] + reach[i] sqrt(root)."""

    middle: tuple[Fraction, ...]
    reach: tuple[Fraction, ...]
    root: Fraction

    @property
    def rational(self):
        """The three components where the surd is not there; else None."""
        return None if self.root and any(self.reach) else list(self.middle)

    def within(self, box) -> bool:
        """Whether it lies in the box of three closed brackets, by exact signs."""
        return all(self._side(i, low) >= 0 >= self._side(i, high) for i, (low, high) in enumerate(box))

    def _side(self, i, end) -> int:
        """Sign of x_i - end."""
        plain, surd = self.middle[i] - end, self.reach[i]
        one, two = exact_sign(plain), exact_sign(surd) * exact_sign(self.root)
        if one * two >= 0:
            return one or two
        return one * exact_sign(plain * plain - surd * surd * self.root)

    def box(self, bits):
        """Three brackets about it, of so many bits."""
        top, bottom = self.root.numerator, self.root.denominator
        shift = bits + abs(top.bit_length() - bottom.bit_length())
        below, step = Fraction(isqrt((top << 2 * shift) // bottom), 1 << shift), Fraction(1, 1 << shift)
        ends = below - step, below + 2 * step
        return [tuple(sorted(m + r * e for e in ends)) for m, r in zip(self.middle, self.reach)]


@dataclass(frozen=True)
class Line:
    """The line where the two conditions meet. places: the equilibria on it, or None where all of it is at rest."""

    places: tuple[Place, ...] | None


def line_of(rates) -> Line | None:
    """The equilibria of a torque whose two conditions meet in one line; None where they do not."""
    if not rates.torque or _rank([n for n, _ in rates.conditions]) < 2:
        return None
    foot, v = _line(rates)
    g = _common_factor(rates, foot, v)
    return Line(tuple(_place(foot, v, *t) for t in _roots(g)) if g else None)


def _place(foot, v, middle, reach, root) -> Place:
    """The point foot + (middle + reach sqrt(root)) v."""
    return Place(tuple(f + middle * c for f, c in zip(foot, v)), tuple(reach * c for c in v), root)


def contradictory(rates) -> bool:
    """Whether the two linear conditions exclude each other."""
    return _rank([[*n, c] for n, c in rates.conditions]) > _rank([n for n, _ in rates.conditions])


def _roots(g):
    """(middle, reach, root) of the distinct real zeros middle + reach sqrt(root) of a polynomial of degree 2 or less."""
    if len(g) < 3:
        return [(-g[0] / g[1], Fraction(0), Fraction(0))] if len(g) == 2 else []
    root = g[1] * g[1] - 4 * g[2] * g[0]
    middle, reach = -g[1] / (2 * g[2]), 1 / (2 * g[2])
    return [(middle, s * reach, root) for s in ((-1, 1) if root else (0,))] if root >= 0 else []


def whole_line(kind, points, curves, places):
    """(status, reason): equilibria of a torque whose two conditions meet in a line. places: those on it (`Line`)."""
    if places is None:
        whole = kind == "curves" and len(curves) == 1 and not points and curves[0].straight
        return ("proved" if whole else "refuted"), "the rates vanish all along the line where the two conditions meet"
    once = len(points) == len(places) and all(sum(place.within(p.box) for p in points) == 1 for place in places)
    right = once and not curves and kind == ("points" if places else "none")
    why = f"on the line where the two conditions meet the rates have {len(places)} common zeros"
    return ("proved" if right else "refuted"), f"{why}, {'' if once else 'not '}each in a box of its own"


def _rank(rows):
    """Rank of rows of fractions."""
    rows, rank = [list(r) for r in rows], 0
    for column in range(len(rows[0])):
        pivot = next((r for r in rows[rank:] if r[column]), None)
        if pivot is None:
            continue
        rows.remove(pivot)
        rows.insert(rank, pivot)
        for i in range(rank + 1, len(rows)):
            factor = rows[i][column] / pivot[column]
            rows[i] = [a - factor * b for a, b in zip(rows[i], pivot)]
        rank += 1
    return rank


def _line(rates):
    """(foot, direction) of the line where the two conditions meet."""
    (a, ca), (b, cb) = rates.conditions
    v = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    size = sum(c * c for c in v)
    # the foot of the line: x = (ca (v x b) + cb (a x v)) / |v|^2 with a . x = -ca, b . x = -cb
    vb = [v[1] * b[2] - v[2] * b[1], v[2] * b[0] - v[0] * b[2], v[0] * b[1] - v[1] * b[0]]
    av = [a[1] * v[2] - a[2] * v[1], a[2] * v[0] - a[0] * v[2], a[0] * v[1] - a[1] * v[0]]
    foot = [(ca * s + cb * t) / size for s, t in zip(vb, av)]
    if any(sum(n * x for n, x in zip(normal, foot)) + c for normal, c in rates.conditions):
        raise ArithmeticError("the foot of the line where the two conditions meet is not on both")
    return foot, v


def _common_factor(rates, foot, v) -> list[Fraction]:
    """Coefficients, lowest first, of the greatest common divisor of the rates on the line; [] where all vanish."""
    from flint import fmpq_poly
    line = [fmpq_poly([q(f), q(d)]) for f, d in zip(foot, v)]
    total = fmpq_poly([])
    for p in rates.at(line):
        total = total.gcd(p)
    return [Fraction(int(c.p), int(c.q)) for c in total.coeffs()]
