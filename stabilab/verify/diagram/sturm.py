"""Real zeros of polynomials with rational coefficients by Sturm's sequences: how many there are, where, and the sign of another polynomial at one."""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction

from ..numbers import Malformed, exact_sign, fraction, q
from .work import Work

HALVINGS = 20_000  # of one bracket; two zeros of polynomials of a certificate are farther apart


def sequence(f, work: Work) -> list:
    """Sturm's sequence of a polynomial without double zeros."""
    out = [f, f.derivative()]
    while out[-1].degree() > 0:
        work.division(out[-2], out[-1])
        rest = -(out[-2] % out[-1])
        if rest == 0:
            break
        out.append(rest / abs(rest.leading_coefficient()))
    return out


def sign_at(f, at: Fraction, work: Work) -> int:
    """The sign of a polynomial at a rational number."""
    work.value(f, at)
    return exact_sign(f(q(at)))


def changes(chain: Sequence, at: Fraction, work: Work) -> int:
    """Changes of sign of a sequence at a place."""
    signs = [s for f in chain if (s := sign_at(f, at, work))]
    return sum(a != b for a, b in zip(signs, signs[1:]))


class Root:
    """A real zero of an irreducible polynomial: the only one in (low, high), or the rational number low = high itself."""

    def __init__(self, polynomial, low: Fraction, high: Fraction, work: Work):
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

    def sign(self, f) -> int:
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
            if not chain or (sign_at(chain[0], self.low, self.work) and changes(chain, self.low, self.work) == changes(chain, self.high, self.work)):
                return sign_at(f, self.high, self.work)
            self.halve()
        raise Malformed(f"a sign that {HALVINGS} halvings do not tell")

    def within(self, low: Fraction, high: Fraction) -> bool:
        """Whether the zero lies in [low, high]."""
        for _ in range(HALVINGS):
            if low <= self.low and self.high <= high:
                return True
            if self.high < low or high < self.low or (not self.rational and (self.high == low or high == self.low)):
                return False
            self.halve()
        raise Malformed(f"a bracket whose end {HALVINGS} halvings do not tell from a zero")


def roots(polynomials: Iterable, low: Fraction, high: Fraction, work: Work) -> list[Root]:
    """The different real zeros in [low, high] of polynomials that are not zero, rising, their brackets apart from one another and from the ends."""
    factors = {}
    for p in polynomials:
        if p.degree() > 0:
            work.factors(p)
            factors |= {str(f / f.leading_coefficient()): f / f.leading_coefficient() for f, _ in p.factor()[1]}
    found = [root for f in factors.values() for root in _of(f, low, high, work)]
    for _ in range(HALVINGS):
        found.sort(key=lambda root: (root.low, root.high))
        near = {n for n, (a, b) in enumerate(zip(found, found[1:])) if a.high >= b.low}
        near |= {n + 1 for n in near} | {n for n, root in enumerate(found) if not root.rational and (root.low == low or root.high == high)}
        if not near:
            return found
        for n in near:
            found[n].halve()
    raise Malformed(f"two values that {HALVINGS} halvings do not tell apart")


def _of(f, low: Fraction, high: Fraction, work: Work) -> list[Root]:
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


class Between:
    """A place between two zeros, or at an end of the range: a rational number."""

    def __init__(self, at: Fraction, work: Work):
        self.at, self.work = at, work

    @property
    def polynomial(self):
        """t less this number."""
        from flint import fmpq_poly
        return fmpq_poly([q(-self.at), 1])

    def sign(self, f) -> int:
        """The sign of a polynomial there."""
        return sign_at(f, self.at, self.work)
