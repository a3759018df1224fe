"""Real zeros of polynomials with rational coefficients, isolated by Sturm's sequences, with the work that a
check may take.

Work is bits times operations, counted before each, so that the same file has the same end everywhere."""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction

from flint import fmpq_poly

from .numbers import Malformed, exact_sign, fraction, q

MOST_BITS = 2_000_000_000  # some five seconds at the most; the certificates of the tests take up to a tenth


class TooLarge(Exception):
    """More work than a certificate may ask for."""


class Work:
    """What is left of it."""

    def __init__(self, left: int | None = None):
        self.left = MOST_BITS if left is None else left

    def spend(self, count: int) -> None:
        """Raises `TooLarge` when it is used up."""
        self.left -= count
        if self.left < 0:
            raise TooLarge

    def division(self, f: fmpq_poly, g: fmpq_poly) -> None:
        """A remainder of two polynomials: their bits, once for each degree."""
        self.spend(OVERHEAD + (bits(f) + bits(g)) * (1 + max(f.degree(), 0) + max(g.degree(), 0)))

    def common(self, f: fmpq_poly, g: fmpq_poly) -> None:
        """The greatest common factor of two polynomials, which is formed modulo primes."""
        self.spend(OVERHEAD + (bits(f) + bits(g)) * (1 + max(f.degree(), 0) + max(g.degree(), 0)) // 4)

    def value(self, f: fmpq_poly, at: Fraction) -> None:
        """The value of a polynomial at a rational number."""
        degree = max(f.degree(), 0)
        self.spend(OVERHEAD + 4 * (1 + degree)
                   * (height(f) + degree * (at.numerator.bit_length() + at.denominator.bit_length())))

    def factors(self, f: fmpq_poly) -> None:
        """The irreducible factors of a polynomial."""
        degree = max(f.degree(), 0)
        self.spend(OVERHEAD + (1 + degree) ** 3 * height(f))


TOO_LARGE = (f"too large: degrees and digits ask for more than {MOST_BITS:,} operations on bits, and a file "
             "from a stranger is given no more")
OVERHEAD = 2000  # of a call: as long as so many bits take


def height(f: fmpq_poly) -> int:
    """The bits of the longest coefficient."""
    return int(f.numer().height_bits()) + int(f.denom().bit_length())


def bits(f: fmpq_poly) -> int:
    """The bits of all coefficients."""
    return height(f) * (1 + max(f.degree(), 0))


HALVINGS = 20_000  # of one bracket; two zeros of polynomials of a certificate are farther apart


def sequence(f: fmpq_poly, work: Work) -> list:
    """Sturm's sequence of a polynomial without double zeros."""
    out = [f, f.derivative()]
    while out[-1].degree() > 0:
        work.division(out[-2], out[-1])
        rest = -(out[-2] % out[-1])
        if rest == 0:
            break
        out.append(rest / abs(rest.leading_coefficient()))
    return out


def sign_at(f: fmpq_poly, at: Fraction, work: Work) -> int:
    """The sign of a polynomial at a rational number."""
    work.value(f, at)
    return exact_sign(f(q(at)))


def changes(chain: Sequence, at: Fraction, work: Work) -> int:
    """Changes of sign of a sequence at a place."""
    signs = [s for f in chain if (s := sign_at(f, at, work))]
    return sum(a != b for a, b in zip(signs, signs[1:]))


class Root:
    """A real zero of an irreducible polynomial: the only one in (low, high), or the rational number low =
    high itself."""

    def __init__(self, polynomial: fmpq_poly, low: Fraction, high: Fraction, work: Work):
        self.polynomial, self.low, self.high, self.work = polynomial, low, high, work
        self.rising = 0 if low == high else sign_at(polynomial, high, work)

    @property
    def rational(self) -> bool:
        return self.low == self.high

    def halve(self) -> None:
        """Half the bracket; a zero that is rational has none."""
        if not self.rational:
            middle = (self.low + self.high) / 2
            if sign_at(self.polynomial, middle, self.work) == self.rising:
                self.high = middle
            else:
                self.low = middle

    def sign(self, f: fmpq_poly) -> int:
        """The sign of a polynomial at the zero."""
        if self.rational:
            return sign_at(f, self.low, self.work)
        self.work.division(f, self.polynomial)
        f = f % self.polynomial
        if f == 0:
            return 0
        self.work.common(f, f)
        chain = sequence(f / f.gcd(f.derivative()), self.work) if f.degree() > 0 else []
        for _ in range(HALVINGS):
            if not chain or (sign_at(chain[0], self.low, self.work)
                             and changes(chain, self.low, self.work) == changes(chain, self.high, self.work)):
                return sign_at(f, self.high, self.work)
            self.halve()
        raise Malformed(f"a sign that {HALVINGS} halvings do not tell")

    def within(self, low: Fraction, high: Fraction) -> bool:
        """Whether the zero lies in [low, high]."""
        for _ in range(HALVINGS):
            if low <= self.low and self.high <= high:
                return True
            if self.high < low or high < self.low or (not self.rational
                                                      and (self.high == low or high == self.low)):
                return False
            self.halve()
        raise Malformed(f"a bracket whose end {HALVINGS} halvings do not tell from a zero")

    def before(self, other: Root) -> bool:
        """Whether it is less than a zero of another irreducible polynomial."""
        for _ in range(HALVINGS):
            if self.high < other.low or other.high < self.low:
                return self.high < other.low
            self.halve()
            other.halve()
        raise Malformed(f"two values that {HALVINGS} halvings do not tell apart")


def real_roots(f, work: Work) -> list[Root]:
    """All different real zeros of a polynomial that is not zero, rising."""
    largest = max(map(abs, f.coeffs()))  # Cauchy: none is as large
    bound = 1 + fraction(largest / abs(f.leading_coefficient()))
    return roots([f], -bound, bound, work)


def roots(polynomials: Iterable, low: Fraction, high: Fraction, work: Work) -> list[Root]:
    """The different real zeros in [low, high] of polynomials that are not zero, rising, their brackets apart
    from one another and from the ends."""
    factors = {}
    for p in polynomials:
        if p.degree() > 0:
            work.factors(p)
            factors |= {str(f / f.leading_coefficient()): f / f.leading_coefficient()
                        for f, _ in p.factor()[1]}
    rows = [root for f in factors.values() for root in _of(f, low, high, work)]
    for _ in range(HALVINGS):
        rows.sort(key=lambda root: (root.low, root.high))
        nearby = {n for n, (a, b) in enumerate(zip(rows, rows[1:])) if a.high >= b.low}
        nearby |= ({n + 1 for n in nearby} | {n for n, root in enumerate(rows) if not root.rational
                                          and (root.low == low or root.high == high)})
        if not nearby:
            return rows
        for n in nearby:
            rows[n].halve()
    raise Malformed(f"two values that {HALVINGS} halvings do not tell apart")


def _of(f: fmpq_poly, low: Fraction, high: Fraction, work: Work) -> list[Root]:
    if f.degree() == 1:
        exact = -fraction(f[0] / f[1])
        return [Root(f, exact, exact, work)] if low <= exact <= high else []
    chain, out = sequence(f, work), []
    todo = [(low, high, changes(chain, low, work), changes(chain, high, work))]
    while todo:
        a, b, first, last = todo.pop()
        if first - last == 1:
            out.append(Root(f, a, b, work))
        elif first - last > 1:
            c = (a + b) / 2
            middle = changes(chain, c, work)
            todo += [(a, c, first, middle), (c, b, middle, last)]
    return out
