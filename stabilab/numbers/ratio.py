"""Exact ratios in no lowest terms, which take most of the time of a fraction to find: for formulas of some
tens of operations, after which the numbers are rounded once."""
from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction


class Ratio:
    """n/d of whole numbers, d > 0, with the operations of a fraction; whole numbers may be mixed in."""

    __slots__ = "d", "n"

    def __init__(self, n: int, d: int = 1):
        self.n, self.d = n, d

    def as_integer_ratio(self) -> tuple[int, int]:
        """(n, d)."""
        return self.n, self.d

    def __float__(self) -> float:
        return self.n / self.d  # rounded once, in lowest terms or not

    def __bool__(self) -> bool:
        return self.n != 0

    def __neg__(self) -> Ratio:
        return Ratio(-self.n, self.d)

    def __abs__(self) -> Ratio:
        return Ratio(abs(self.n), self.d)

    def __add__(self, other: Ratio) -> Ratio:
        if self.d == other.d:
            return Ratio(self.n + other.n, self.d)
        return Ratio(self.n * other.d + other.n * self.d, self.d * other.d)

    def __sub__(self, other: Ratio) -> Ratio:
        return self + -other

    def __mul__(self, other: Ratio | int) -> Ratio:
        if isinstance(other, int):
            return Ratio(self.n * other, self.d)
        return Ratio(self.n * other.n, self.d * other.d)

    __rmul__ = __mul__

    def __truediv__(self, other: Ratio | int) -> Ratio:
        n, d = (other, 1) if isinstance(other, int) else (other.n, other.d)
        if not n:
            raise ZeroDivisionError("a ratio over 0")
        return Ratio(self.n * d, self.d * n) if n > 0 else Ratio(-self.n * d, -self.d * n)

    def __rtruediv__(self, other: int) -> Ratio:
        return Ratio(other) / self

    def __lt__(self, other: int) -> bool:
        return self.n < other * self.d

    def __gt__(self, other: int) -> bool:
        return self.n > other * self.d


def ratios(numbers: Sequence[Fraction | float]) -> tuple[Ratio, ...]:
    """Of exact numbers (floats at their word), over a common denominator: sums leave it as it is."""
    pairs = [number.as_integer_ratio() for number in numbers]
    d = math.lcm(*(pair[1] for pair in pairs))
    return tuple(Ratio(n * (d // own), d) for n, own in pairs)
