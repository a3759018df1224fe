"""Twofold numbers: unevaluated sums of two doubles, 32 digits, for the few differences that decide a small
divisor.

Whole arrays at once, no fused multiply-add needed. Magnitudes must stay within 1e-140 ... 1e140, so that no
partial product is lost.
"""
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .error_free import add, exact_sum, times

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


def twofold(x: ArrayLike | Twofold) -> Twofold:
    """A double, or an array of them, as a twofold number."""
    if isinstance(x, Twofold):
        return x
    x = np.asarray(x, float)
    return Twofold(x, np.zeros_like(x))


@dataclass(frozen=True, eq=False)
class Twofold:
    """high + low with |low| at most half a unit in the last place of high; arrays broadcast as NumPy's do."""

    high: np.ndarray
    low: np.ndarray

    def __add__(self, other: ArrayLike | Twofold) -> Twofold:
        other = twofold(other)
        return Twofold(*add((self.high, self.low), (other.high, other.low)))

    def __mul__(self, other: ArrayLike | Twofold) -> Twofold:
        other = twofold(other)
        return Twofold(*times((self.high, self.low), (other.high, other.low)))

    def __truediv__(self, other: ArrayLike | Twofold) -> Twofold:
        other = twofold(other)
        first = self.high / other.high
        rest = self - other * first
        return (Twofold(*exact_sum(first, rest.high / other.high))
                + (rest - other * (rest.high / other.high)).high / other.high)

    def __neg__(self) -> Twofold:
        return Twofold(-self.high, -self.low)

    def __sub__(self, other: ArrayLike | Twofold) -> Twofold:
        return self + -twofold(other)

    def __rsub__(self, other: ArrayLike | Twofold) -> Twofold:
        return -self + other

    __radd__, __rmul__ = __add__, __mul__

    def value(self) -> np.ndarray:
        """The nearest double."""
        return self.high + self.low
