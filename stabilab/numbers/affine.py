"""Numbers over a box of uncertain parameters: middle, linear part and a bound on all the rest, for many boxes
at once.

A number is c + sum_k g_k e_k + r with |e_k| <= 1 for every parameter and |r| <= e: the mean-value form,
carried through every operation, so that its surplus is quadratic in the box's width. The bound e takes in
rounding (of doubles; functions are taken to err by less than four units in the last place). What is undefined
somewhere in the box has e = inf or NaN, and then no comparison with it holds. Source: affine arithmetic, de
Figueiredo and Stolfi, Numerical Algorithms 37 (2004).
"""
from __future__ import annotations

from fractions import Fraction

import numpy as np

from .vectors import Number

EPS = 2.0**-52
ROUNDINGS = 8 * EPS  # of the sum of the terms' sizes: each operation rounds no more than four times
LEAST = 1e-300       # what underflow may lose


class Affine:
    """c (...,), g (..., parameters), e (...,); batches broadcast. Exactly zero numbers stay the plain number
    0."""

    __slots__ = ("c", "g", "e")
    __array_ufunc__ = None  # arrays leave the arithmetic to this class

    def __init__(self, c: Number, g: np.ndarray, e: Number) -> None:
        self.c, self.g, self.e = c, g, e

    @property
    def reach(self) -> np.ndarray:
        """How far from c the number may be, over the box."""
        return (np.abs(self.g).sum(-1) + self.e) * (1 + 64 * EPS)

    @property
    def low(self) -> np.ndarray:
        """A lower bound over the box."""
        reach = self.reach
        return self.c - reach - ROUNDINGS * (np.abs(self.c) + reach)

    @property
    def high(self) -> np.ndarray:
        """An upper bound over the box."""
        reach = self.reach
        return self.c + reach + ROUNDINGS * (np.abs(self.c) + reach)

    @property
    def sign(self) -> np.ndarray:
        """-1 or 1 where the whole box has that sign, else 0."""
        return np.where(self.low > 0, 1, np.where(self.high < 0, -1, 0))

    def __add__(self, other: Number) -> Affine:
        if _nothing(other):
            return self
        other = lifted(other)
        c, g, e = self.c + other.c, self.g + other.g, self.e + other.e
        return Affine(c, g, e + ROUNDINGS * (np.abs(c) + self.reach + other.reach) + LEAST)

    def __mul__(self, other: Number) -> Affine | Fraction:
        if _nothing(other):
            return Fraction(0)
        other = lifted(other)
        first, second = np.abs(self.c), np.abs(other.c)
        r1, r2 = self.reach, other.reach
        e = first * other.e + second * self.e + r1 * r2
        return Affine(self.c * other.c, _times(self.c, other.g) + _times(other.c, self.g),
                      e + ROUNDINGS * (first * second + first * r2 + second * r1 + e) + LEAST)

    def square(self) -> Affine:
        """self * self, whose second-order part has one sign."""
        size, r = np.abs(self.c), self.reach
        half = 0.5 * r * r
        e = 2 * size * self.e + half
        return Affine(self.c * self.c + half, _times(2 * self.c, self.g),
                      e + ROUNDINGS * (size * size + 2 * size * r + half + e) + LEAST)

    def __neg__(self) -> Affine:
        return Affine(-self.c, -self.g, self.e)

    def __sub__(self, other: Number) -> Affine:
        return self + -other

    def __rsub__(self, other: Number) -> Affine:
        return -self + other

    __radd__, __rmul__ = __add__, __mul__

    def __truediv__(self, other: Number) -> Number:
        return self * (1 / other if isinstance(other, Affine) else 1 / Fraction(other))

    def __rtruediv__(self, other: Number) -> Number:
        smallest = np.abs(self.c) - self.reach
        smallest = np.where(smallest > 0, smallest, np.nan)
        c = 1 / self.c
        return self._image(c, -c * c, 2 / (smallest * smallest * smallest)) * other

    def sqrt(self) -> Affine:
        """The square root; undefined where the box reaches zero."""
        smallest = self.c - self.reach
        smallest = np.where(smallest > 0, smallest, np.nan)
        c = np.sqrt(np.where(self.c > 0, self.c, np.nan))
        return self._image(c, 0.5 / c, 0.25 / (smallest * np.sqrt(smallest)))

    def sin_cos(self) -> tuple[Affine, Affine]:
        """(sine, cosine)."""
        s, c = np.sin(self.c), np.cos(self.c)
        return self._image(s, c, 1.0, 1.0), self._image(c, -s, 1.0, 1.0)

    def _image(self, value: Number, slope: Number, bend: Number, size: float = 0.0) -> Affine:
        """A function with this value and slope at c and a second derivative of at most `bend` over the box;
        size: of what its library rounds inside."""
        r, steep = self.reach, np.abs(slope)
        e = steep * self.e + 0.5 * bend * r * r
        return Affine(value, _times(slope, self.g),
                      e + ROUNDINGS * (np.abs(value) + size * (1 + r) + steep * r + e) + LEAST)


def lifted(value: Number) -> Affine:
    """A certain number as one over any box."""
    if isinstance(value, Affine):
        return value
    c = float(value)
    return Affine(np.float64(c), np.zeros(1), 0.0 if Fraction(c) == value else EPS * abs(c))


def squared(value: Number) -> Number:
    """The square of a number of either kind."""
    return value.square() if isinstance(value, Affine) else value * value


def root(value: Number) -> Number:
    """The square root of a number of either kind."""
    return 0 if _nothing(value) else lifted(value).sqrt()


def sign_over(value: Number) -> np.ndarray | np.int64:
    """-1, 0 or 1 over each box; of a certain number, its own."""
    return value.sign if isinstance(value, Affine) else np.int64((value > 0) - (value < 0))


def _nothing(value: Number) -> bool:
    return not isinstance(value, Affine) and value == 0


def _times(factor: Number, g: np.ndarray) -> np.ndarray:
    return np.asarray(factor)[..., None] * g
