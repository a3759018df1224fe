"""Real zeros of polynomials with rational coefficients by Sturm's sequences: how many there are, where, and the sign of another polynomial at one."""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction

from ..numbers import Malformed, exact_sign, fraction, q

HALVINGS = 20_000  # of one bracket; two zeros of polynomials of a certificate are farther apart


def sequence(f) -> list:
    """Sturm's sequence of a polynomial without double zeros."""
    out = [f, f.derivative()]
    while out[-1].degree() > 0:
        rest = -(out[-2] % out[-1])
        if rest == 0:
            break
        out.append(rest / abs(rest.leading_coefficient()))
    return out


def changes(chain: Sequence, at: Fraction) -> int:
    """Changes of sign of a sequence at a place."""
    here = q(at)
    signs = [s for f in chain if (s := exact_sign(f(here)))]
    return sum(a != b for a, b in zip(signs, signs[1:]))


class Root:
    """A real zero of an irreducible polynomial: the only one in (low, high), or the rational number low = high itself."""

    def __init__(self, polynomial, low: Fraction, high: Fraction):
        self.polynomial, self.low, self.high = polynomial, low, high
        self.rising = 0 if low == high else exact_sign(polynomial(q(high)))

    @property
    def rational(self) -> bool:
        return self.low == self.high

    def halve(self) -> None:
        """Half the bracket; a zero that is rational has none."""
        if not self.rational:
            middle = (self.low + self.high) / 2
            if exact_sign(self.polynomial(q(middle))) == self.rising:
                self.high = middle
            else:
                self.low = middle

    def sign(self, f) -> int:
        """The sign of a polynomial at the zero."""
        if self.rational:
            return exact_sign(f(q(self.low)))
        if f % self.polynomial == 0:
            return 0
        f = f % self.polynomial
        chain = sequence(f / f.gcd(f.derivative())) if f.degree() > 0 else []
        for _ in range(HALVINGS):
            if not chain or (exact_sign(chain[0](q(self.low))) and changes(chain, self.low) == changes(chain, self.high)):
                return exact_sign(f(q(self.high)))
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


def roots(polynomials: Iterable, low: Fraction, high: Fraction) -> list[Root]:
    """The different real zeros in [low, high] of polynomials that are not zero, rising, their brackets apart from one another and from the ends."""
    factors = {str(f / f.leading_coefficient()): f / f.leading_coefficient() for p in polynomials if p.degree() > 0 for f, _ in p.factor()[1]}
    found = [root for f in factors.values() for root in _of(f, low, high)]
    for _ in range(HALVINGS):
        found.sort(key=lambda root: (root.low, root.high))
        near = {n for n, (a, b) in enumerate(zip(found, found[1:])) if a.high >= b.low}
        near |= {n + 1 for n in near} | {n for n, root in enumerate(found) if not root.rational and (root.low == low or root.high == high)}
        if not near:
            return found
        for n in near:
            found[n].halve()
    raise Malformed(f"two values that {HALVINGS} halvings do not tell apart")


def _of(f, low: Fraction, high: Fraction) -> list[Root]:
    if f.degree() == 1:
        exact = -fraction(f[0] / f[1])
        return [Root(f, exact, exact)] if low <= exact <= high else []
    chain, out = sequence(f), []
    todo = [(low, high, changes(chain, low), changes(chain, high))]
    while todo:
        a, b, first, last = todo.pop()
        if first - last == 1:
            out.append(Root(f, a, b))
        elif first - last > 1:
            c = (a + b) / 2
            middle = changes(chain, c)
            todo += [(a, c, first, middle), (c, b, middle, last)]
    return out


class Between:
    """A place between two zeros, or at an end of the range: a rational number."""

    def __init__(self, at: Fraction):
        self.at = at

    @property
    def polynomial(self):
        """t less this number."""
        from flint import fmpq_poly
        return fmpq_poly([q(-self.at), 1])

    def sign(self, f) -> int:
        """The sign of a polynomial there."""
        return exact_sign(f(q(self.at)))
