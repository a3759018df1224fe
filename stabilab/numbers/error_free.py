"""Sums and products without error: what rounding leaves behind, as a second double.

Twofold numbers, pairs of a high and a low part, serve kernels that numba compiles (`numba_door`) and arrays
(`double_double`).

Error-free sum of Knuth and product of Dekker, as in Shewchuk (1997) and in Hida, Li and Bailey (2001)."""
from __future__ import annotations

from .vectors import Number

Pair = tuple[Number, Number]

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


def add(a: Pair, b: Pair) -> Pair:
    s, e = exact_sum(a[0], b[0])
    t, f = exact_sum(a[1], b[1])
    s, e = exact_sum(s, e + t)
    return exact_sum(s, e + f)


def less(a: Pair, b: Pair) -> Pair:
    return add(a, (-b[0], -b[1]))


def times(a: Pair, b: Pair) -> Pair:
    p, e = exact_product(a[0], b[0])
    return exact_sum(p, e + (a[0] * b[1] + a[1] * b[0]))


def scaled(a: Pair, factor: Number) -> Pair:
    """A twofold number times a double."""
    p, e = exact_product(a[0], factor)
    return exact_sum(p, e + a[1] * factor)


def value(a: Pair) -> Number:
    """The nearest double."""
    return a[0] + a[1]
