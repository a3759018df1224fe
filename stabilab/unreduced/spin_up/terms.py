"""Sums of terms c zeta^j zeta*^k p^(-a/4) q^(-b/4), many at a time: keys, coefficients and their majorants in arrays.

A key packs (j, k, a, b) into one integer, linearly: the key of a product is the sum of the keys.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

_A, _K, _J = 1 << 16, 1 << 32, 1 << 40
_MIDDLE = (1 << 15) + (1 << 15) * _A


def packed(j, k, a, b):
    """The key of (j, k, a, b); exponents j, k below 256, a and b between -2^15 and 2^15."""
    return j * _J + k * _K + a * _A + b


@dataclass(frozen=True)
class Terms:
    """keys: (n,) integers, no two alike; c: (n,) coefficients; m: (n,) what the sizes of all that was added up in c come to."""

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
        """Each coefficient times a number or an array of whole numbers."""
        return Terms(self.keys, self.c * self._like(factor), self.m * np.abs(self._like(factor)))

    def over(self, divisors):
        """Each coefficient over a whole number of its own."""
        return Terms(self.keys, self.c / self._like(divisors), self.m / np.abs(self._like(divisors)))

    def _like(self, numbers):
        """Whole numbers as Python's own where the coefficients are no doubles: other kinds of number know those."""
        return numbers.astype(object) if isinstance(numbers, np.ndarray) and self.c.dtype == object else numbers

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
        return Terms(keys, np.where(apart < 0, mirrored, np.where(apart > 0, self.c, self.c + mirrored)), np.where(apart == 0, self.m + self.m, self.m))

    def as_dict(self) -> dict:
        """{(j, k, a, b): c}."""
        return dict(zip(zip(*(v.tolist() for v in self.powers)), self.c.tolist()))


def terms_of(table: dict, majorant: dict | None = None) -> Terms:
    """Terms from {(j, k, a, b): c} and, where some of c are sums, their majorants."""
    keys = [key for key in (table if majorant is None else majorant)]
    c = [table.get(key, 0.0) for key in keys]
    array = np.array(c, complex if all(isinstance(v, (int, float, complex)) for v in c) else object)
    sizes = np.abs(array) if majorant is None else np.array([majorant[key] for key in keys])
    return Terms(np.array([packed(*key) for key in keys], np.int64), array, sizes)


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
    return Terms((one.keys[:, None] + other.keys).ravel(), (one.c[:, None] * other.c).ravel(), (one.m[:, None] * other.m).ravel())
