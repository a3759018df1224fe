"""Taking away what oscillates about a moving centre: corrected energy and corrected amplitude, to any order.

Quantities are sums of c zeta^j zeta*^k p^(-a/4) q^(-b/4), many terms at a time in arrays (`Terms`); p and q
are linear in the spin x. Along the motion, with `Algebra`'s names,

    zeta' = i om p^(-turn_a/4) q^(-turn_b/4) zeta + x' carried,        x' = x_rate,
    d/dt  = i Om (zeta d - zeta* d*) + x' [d/dx + along carried].

An oscillating term c zeta^j zeta*^k f(x) of a rate (j != k) is taken away by adding -c/(i Om (j - k)) zeta^j
zeta*^k f(x) to the quantity: its rate then holds -c zeta^j zeta*^k f(x) and the price, what the rest of d/dt
makes of the added term, smaller by at least one power of the spin. What does not oscillate (j = k) stays.
Level of a term: four times the power of 1/x with which it falls. (About a fixed centre p = X, there is no q,
and `fixed_kernel` does the same in loops over dense tables.)

Rounding. Beside each coefficient goes its majorant, formed by the same operations on sizes, without
subtraction: a coefficient is a sum of products, its majorant the sum of the same products' sizes. Each
product is formed by fewer than 2^14 roundings (orders below 40: some ten to a level, and sums of fewer than
300 terms at each), so a coefficient in doubles errs by less than 2^-38 of its majorant. `sizes` gives |c| +
ROUNDING majorant, ROUNDING = 2^-32, which covers that 64 times over.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

ROUNDING = 2.0**-32
_A, _K, _J = 1 << 16, 1 << 32, 1 << 40
_MIDDLE = (1 << 15) + (1 << 15) * _A


def packed(j, k, a, b):
    """(j, k, a, b) in one integer, linearly: the key of a product is the sum of the keys. j, k below 256, a
    and b between -2^15 and 2^15."""
    return j * _J + k * _K + a * _A + b


@dataclass(frozen=True)
class Terms:
    """keys: (n,) integers, no two alike; c: (n,) coefficients; m: (n,) what the sizes of all that was added
    up in c come to."""

    keys: np.ndarray
    c: np.ndarray
    m: np.ndarray

    @property
    def powers(self):
        """(j, k, a, b), (n,) each."""
        keys = self.keys + _MIDDLE
        return keys >> 40, keys >> 32 & 255, (keys >> 16 & _A - 1) - (1 << 15), (keys & _A - 1) - (1 << 15)

    @property
    def apart(self):
        """j - k, (n,)."""
        keys = self.keys + _MIDDLE
        return (keys >> 40) - (keys >> 32 & 255)

    def __getitem__(self, rows):
        return Terms(self.keys[rows], self.c[rows], self.m[rows])

    def times(self, factor):
        """Each coefficient times a number or an array of numbers."""
        return Terms(self.keys, self.c * factor, self.m * np.abs(factor))

    def over(self, divisors):
        """Each coefficient over a number of its own."""
        return Terms(self.keys, self.c / divisors, self.m / np.abs(divisors))

    def moved(self, key):
        """Times one monomial."""
        return Terms(self.keys + key, self.c, self.m)

    def conjugate(self):
        """The conjugate of the sum: zeta^j zeta*^k becomes zeta^k zeta*^j."""
        return Terms(self.keys - self.apart * (_J - _K), self.c.conjugate(), self.m)

    def half(self):
        """Of a real sum, whose terms come with their conjugates, those with j >= k."""
        return self[self.apart >= 0]

    def whole(self):
        """The real sum of which `half` is left."""
        return gathered(self, self[self.apart > 0].conjugate())

    def real(self):
        """The half of the sum and its conjugate, like keys not yet added up."""
        apart = self.apart
        keys = self.keys - np.minimum(apart, 0) * (_J - _K)
        mirrored = self.c.conjugate()
        c = np.where(apart < 0, mirrored, np.where(apart > 0, self.c, self.c + mirrored))
        return Terms(keys, c, np.where(apart == 0, self.m + self.m, self.m))


def terms_of(table: dict) -> Terms:
    """Terms from {(j, k, a, b): c}."""
    c = np.array(list(table.values()), complex)
    return Terms(np.array([packed(*key) for key in table], np.int64), c, np.abs(c))


def gathered(*parts: Terms) -> Terms:
    """The sum of sums of terms."""
    parts = tuple(part for part in parts if len(part.keys))
    if not parts:
        return terms_of({})
    keys, c, m = (np.concatenate([getattr(part, name) for part in parts]) for name in ("keys", "c", "m"))
    order = np.argsort(keys, kind="stable")
    keys = keys[order]
    first = np.flatnonzero(np.append(True, keys[1:] != keys[:-1]))
    return Terms(keys[first], np.add.reduceat(c[order], first), np.add.reduceat(m[order], first))


def product(one: Terms, other: Terms) -> Terms:
    """The product of two sums of terms, like keys not yet added up."""
    return Terms((one.keys[:, None] + other.keys).ravel(), (one.c[:, None] * other.c).ravel(),
                 (one.m[:, None] * other.m).ravel())


def sizes(terms: Terms):
    """(n,) bounds of the true coefficients' sizes."""
    return np.abs(terms.c) + ROUNDING * terms.m


@dataclass(frozen=True)
class Algebra:
    """What the time derivative of a form is made of.

    lift: i/om; turn: (a, b) of the turning rate Om = om p^(-a/4) q^(-b/4); fall: the factors of d/dx,
    -slope/4 of p and of q; x_rate: terms of x'; carried: terms of zeta' over x'; weights: what p and q count
    in the level, 0 for a q that is constant.
    """

    lift: complex
    turn: tuple
    fall: tuple
    x_rate: Terms
    carried: Terms
    weights: tuple = (1, 1)

    def levels(self, terms: Terms):
        """Four times the powers of 1/x with which terms fall."""
        _, _, a, b = terms.powers
        return self.weights[0] * a + self.weights[1] * b

    def rest_of_rate(self, terms: Terms) -> Terms:
        """The rate of a quantity apart from what turning makes of it, like keys not yet added up."""
        return product(gathered(self.slope(terms), *self._along_carried(terms)), self.x_rate)

    def _along_carried(self, terms):
        """The derivative of terms along zeta' = carried."""
        if not len(self.carried.keys):
            return []
        j, k, _, _ = terms.powers
        return [product(terms.moved(-packed(*step)).times(n)[n != 0], toward)
                for step, n, toward in (((1, 0, 0, 0), j, self.carried),
                                        ((0, 1, 0, 0), k, self.carried.conjugate()))]

    def slope(self, terms: Terms) -> Terms:
        """d/dx of terms at constant zeta."""
        _, _, a, b = terms.powers
        return gathered(*(terms.moved(packed(0, 0, *step)).times(n).times(fall)[n != 0]
                          for step, fall,
                          n in (((4, 0), self.fall[0], a), ((0, 4), self.fall[1], b)) if fall))

    def removed(self, terms: Terms) -> Terms:
        """What is added to a quantity to take oscillating terms out of its rate."""
        return terms.moved(-packed(0, 0, *self.turn)).times(self.lift).over(terms.apart)


@dataclass(frozen=True)
class Corrected:
    """What was added to a quantity, and what is left of its rate (of an energy: without the drive)."""

    added: Terms
    rate: Terms


def corrected(algebra: Algebra, rate: Terms, order: int, added: Terms | None = None) -> Corrected:
    """Everything oscillating up to x^-order taken out of a rate; added: what was added to the quantity
    before. Both are real: their terms come with their conjugates, so that half of them need be followed."""
    parts, rate = [] if added is None else [added.half()], rate.half()
    while True:
        levels = algebra.levels(rate)
        oscillating = (rate.apart != 0) & (levels <= 4 * order)
        if not oscillating.any():
            return Corrected(gathered(*parts).whole(), rate.whole())
        now = oscillating & (levels == levels[oscillating].min())
        parts.append(algebra.removed(rate[now]))
        rate = gathered(rate[~now], algebra.rest_of_rate(parts[-1]).real())
