"""Sums and products without error: what rounding leaves behind, as a second double."""
from __future__ import annotations

from .vectors import Number

SPLITTER = 134217729.0  # 2**27 + 1 cuts a 53-bit significand into two halves whose products are exact


def exact_sum(x: Number, y: Number) -> tuple[Number, Number]:
    """The rounded sum of two doubles and what rounding took away."""
    s = x + y
    back = s - x
    return s, (x - (s - back)) + (y - back)


def exact_product(x: Number, y: Number) -> tuple[Number, Number]:
    """The rounded product of two doubles and what rounding took away."""
    p = x * y
    (xh, xl), (yh, yl) = halves(x), halves(y)
    return p, ((xh * yh - p) + xh * yl + xl * yh) + xl * yl


def halves(x: Number) -> tuple[Number, Number]:
    big = SPLITTER * x
    high = big - (big - x)
    return high, x - high
