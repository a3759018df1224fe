"""Polynomials in one variable with exact coefficients, and all their real roots."""
from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from math import gcd

from .vectors import Number


class Poly:
    """Polynomial with rational coefficients, lowest power first; the zero polynomial has none."""

    __slots__ = ("c",)

    def __init__(self, coefficients: Iterable[Number]) -> None:
        c = [Fraction(v) for v in coefficients]
        while c and not c[-1]:
            c.pop()
        self.c = tuple(c)

    @property
    def degree(self) -> int:
        return len(self.c) - 1

    def __bool__(self) -> bool:
        return bool(self.c)

    def __call__(self, t: Number) -> Number:
        value = Fraction(0)
        for v in reversed(self.c):
            value = value * t + v
        return value

    def __add__(self, other: Number) -> Poly:
        a, b = self.c, _poly(other).c
        if len(a) < len(b):
            a, b = b, a
        return Poly([v + b[i] if i < len(b) else v for i, v in enumerate(a)])

    def __mul__(self, other: Number) -> Poly:
        b = _poly(other).c
        out = [Fraction(0)] * max(0, len(self.c) + len(b) - 1)
        for i, v in enumerate(self.c):
            for j, w in enumerate(b):
                out[i + j] += v * w
        return Poly(out)

    def __neg__(self) -> Poly:
        return Poly([-v for v in self.c])

    def __sub__(self, other: Number) -> Poly:
        return self + -_poly(other)

    def __rsub__(self, other: Number) -> Poly:
        return -self + other

    __radd__, __rmul__ = __add__, __mul__

    def derivative(self) -> Poly:
        return Poly([i * v for i, v in enumerate(self.c)][1:])

    def divmod(self, other: Poly) -> tuple[Poly, Poly]:
        """Quotient and remainder."""
        rest, lead, n = list(self.c), other.c[-1], len(other.c)
        quotient = [Fraction(0)] * max(0, len(rest) - n + 1)
        for i in range(len(quotient) - 1, -1, -1):
            quotient[i] = factor = rest[i + n - 1] / lead
            for j, v in enumerate(other.c):
                rest[i + j] -= factor * v
        return Poly(quotient), Poly(rest[:n - 1])

    def without_root(self, root: Fraction) -> Poly:
        """The polynomial with every factor (t - root) divided out."""
        out = self
        while out.degree > 0 and not out(root):
            out = out.divmod(Poly((-root, 1)))[0]
        return out


def _poly(value: Number) -> Poly:
    return value if isinstance(value, Poly) else Poly((value,))


def integers(p: Poly) -> list[int]:
    """A positive multiple with coprime integer coefficients."""
    common = 1
    for v in p.c:
        common = common * v.denominator // gcd(common, v.denominator)
    whole = [int(v * common) for v in p.c]
    shared = gcd(*whole) or 1
    return [v // shared for v in whole]


def _square_free(p: Poly) -> Poly:
    a, b = p, p.derivative()
    while b:
        a, b = b, Poly(integers(a.divmod(b)[1]) if a.divmod(b)[1] else ())
    return p.divmod(a)[0]


def _sturm_chain(p: Poly) -> list[list[int]]:
    chain = [Poly(integers(p)), Poly(integers(p.derivative()))]
    while chain[-1].degree > 0:
        rest = -chain[-2].divmod(chain[-1])[1]
        chain.append(Poly(integers(rest)))
    return [[int(v) for v in q.c] for q in chain]


def _value_at(c: list[int], n: int, e: int) -> int:
    """The integer polynomial c at n / 2**e times 2**(e degree), by integers alone."""
    value, shift = 0, 0
    for v in reversed(c):
        value = value * n + (v << shift)
        shift += e
    return value


def _sign_at(c: list[int], n: int, e: int) -> int:
    """Sign of the integer polynomial c at n / 2**e."""
    value = _value_at(c, n, e)
    return (value > 0) - (value < 0)


def _variations(chain: list[list[int]], n: int, e: int) -> int:
    signs = [s for s in (_sign_at(c, n, e) for c in chain) if s]
    return sum(s != t for s, t in zip(signs, signs[1:]))


def _middle(a: int, b: int) -> int:
    """A dyadic point between a > 0 and b >= a + 2 (same denominator): near the geometric mean while they are far apart."""
    if b > 4 * a:
        return 1 << ((a.bit_length() + b.bit_length()) // 2)
    return (a + b) // 2


def _positive_roots(p: Poly, bits: int) -> list[Fraction]:
    if p.degree < 1:
        return []
    chain = _sturm_chain(p)
    lead, largest, last = abs(chain[0][-1]), max(map(abs, chain[0])), abs(chain[0][0])
    top = largest.bit_length() - lead.bit_length() + 3          # Cauchy's bound: every root is below 2**top
    bottom = largest.bit_length() - last.bit_length() + 3       # and, for 1/t, above 2**-bottom
    e = max(bottom, 0) + bits + 4
    roots, stack = [], [(1 << (e - bottom), 1 << (e + top), e)]
    while stack:
        a, b, e = stack.pop()
        va, vb = _variations(chain, a, e), _variations(chain, b, e)
        if va - vb == 1:
            roots.append(_refine(chain, a, b, e, bits))
        elif va > vb:
            if b - a < 2:
                a, b, e = a << 64, b << 64, e + 64
            middle = _middle(a, b)
            stack += [(a, middle, e), (middle, b, e)]
    return sorted(roots)


def _refine(chain: list[list[int]], a: int, b: int, e: int, bits: int) -> Fraction:
    """The one simple root in (a, b] / 2**e, to 2**-bits relative; exact where a trial point hits it."""
    c = chain[0]
    if not _sign_at(c, b, e):
        return Fraction(b, 1 << e)
    after = _sign_at(c, b, e)
    known: tuple[int, int, int] | None = None
    while (b - a) << bits > a:
        if b - a < 2:
            a, b, e = a << 64, b << 64, e + 64
        middle = _middle(a, b)
        if known is None and b <= 4 * a:
            known = _bracket(c, a, b, e, bits + 8)
        s = _side(known, middle, e) if known else 0
        s = s * after if s else _sign_at(c, middle, e)
        if not s:
            return Fraction(middle, 1 << e)
        a, b = (a, middle) if s == after else (middle, b)
    return Fraction(a + b, 1 << (e + 1))


def _side(known: tuple[int, int, int], n: int, e: int) -> int:
    """1 where n / 2**e lies above the root that is known to lie within (low, high) / 2**k, -1 below, 0 where that does not tell."""
    low, high, k = known
    if k >= e:
        n <<= k - e
    else:
        low, high = low << e - k, high << e - k
    return (n >= high) - (n <= low)


def _bracket(c: list[int], low: int, high: int, e: int, bits: int) -> tuple[int, int, int]:
    """(low, high, k): the one simple root in (low, high) / 2**e lies within (low, high) / 2**k, to 2**-bits relative or nearly a trial point.

    J. Abbott's quadratic interval refinement: the bracket is cut into 2**g cells, and the one that the secant names is tried. Where it
    holds the root, g doubles, otherwise it is halved: digits double at each step, where bisection wins one.
    """
    at_low, at_high, g, degree = _value_at(c, low, e), _value_at(c, high, e), 2, len(c) - 1
    while (high - low) << bits > low:
        cell, cells = high - low, 1 << g
        low, high, e = low << g, high << g, e + g
        at_low, at_high = at_low << g * degree, at_high << g * degree
        tried = low + cell * min(max(1, cells * at_low // (at_low - at_high)), cells - 1)
        found, won = _value_at(c, tried, e), False
        for _ in range(2):  # the trial point, and the one beyond it on the side where the root is
            if not found:
                return tried - 1, tried + 1, e
            if (found > 0) == (at_high > 0):
                high, at_high, tried = tried, found, tried - cell
            else:  # `low` itself may be the root before this one
                low, at_low, tried = tried, found, tried + cell
            won = high - low == cell
            if won or not low < tried < high:
                break
            found = _value_at(c, tried, e)
        g = 2 * g if won else max(1, g // 2)
    return low, high, e


def real_roots(p: Poly, bits: int = 160) -> list[Fraction]:
    """Every real root of a nonzero polynomial once, rising, within 2**-bits relative (Sturm's theorem, so none is
    missed and none is invented; zero is exact)."""
    p = _square_free(p)
    zero = [Fraction(0)] if p.degree > 0 and not p(Fraction(0)) else []
    p = p.without_root(Fraction(0))
    mirrored = Poly([v if i % 2 == 0 else -v for i, v in enumerate(p.c)])
    return [-r for r in reversed(_positive_roots(mirrored, bits))] + zero + _positive_roots(p, bits)
