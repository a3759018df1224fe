"""Ball arithmetic in doubles: what one state of an ordinary motion needs, without loading a library for many digits.

A ball is a double and a bound on its error, carried through every operation; it has the interface of python-flint's `arb`
as far as the reduced potential uses it. So the mechanics of one state are written once (`orbit.ball_orbit`), are asked in doubles
first, and in many digits where the doubles say `Unclear`. Standard functions are taken to err by less than one unit in
the last place (as those of the C libraries do: Zimmermann et al., "Accuracy of mathematical functions", 2024).
"""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from .roots import held_newton
from .vectors import Number

EPS = 2.0**-52  # a whole unit in the last place: twice what one rounding costs, so the bounds' own rounding is paid for
LARGEST, LEAST = 1e290, 1e-290  # beyond these a double's relative accuracy ends
# A polynomial is left to many digits where, against the size of its terms, it is closer to zero than FLAT at a turn, or its
# slope at a root is less than SIMPLE: then roots are not clearly single, or rounding moves them too far.
FLAT, SIMPLE = 1e-9, 1e-6


class Unclear(Exception):
    """The balls overlap at this precision."""


class Ball:
    """All numbers within r of m."""

    __slots__ = ("m", "r")

    def __init__(self, m: float, r: float = 0.0) -> None:
        if not -LARGEST < m < LARGEST or (0 < abs(m) < LEAST) or not r < LARGEST:
            raise Unclear
        self.m, self.r = m, r

    def __add__(self, other: Number) -> Ball:
        if not isinstance(other, Ball):
            other = Ball(float(other))
        m = self.m + other.m
        return Ball(m, self.r + other.r + EPS * (abs(m) + self.r + other.r))

    def __neg__(self) -> Ball:
        return Ball(-self.m, self.r)

    def __sub__(self, other: Number) -> Ball:
        if not isinstance(other, Ball):
            other = Ball(float(other))
        m = self.m - other.m
        return Ball(m, self.r + other.r + EPS * (abs(m) + self.r + other.r))

    def __rsub__(self, other: Number) -> Ball:
        return Ball(float(other)) - self

    def __mul__(self, other: Number) -> Ball:
        if not isinstance(other, Ball):
            other = Ball(float(other))
        m = self.m * other.m
        if not m and self.m and other.m:
            raise Unclear
        r = abs(self.m) * other.r + self.r * (abs(other.m) + other.r)
        return Ball(m, r + EPS * (abs(m) + r))

    __radd__, __rmul__ = __add__, __mul__

    def __truediv__(self, other: Number) -> Ball:
        if not isinstance(other, Ball):
            other = Ball(float(other))
        least = abs(other.m) - other.r
        if not least > 0:
            raise Unclear
        m = self.m / other.m
        if not m and self.m:
            raise Unclear
        r = (self.r + abs(m) * other.r) / least
        return Ball(m, r + 2 * EPS * (abs(m) + r))

    def __rtruediv__(self, other: Number) -> Ball:
        return Ball(float(other)) / self

    def __abs__(self) -> Ball:
        if abs(self.m) >= self.r:
            return Ball(abs(self.m), self.r)
        top = self.abs_upper()
        return Ball(top / 2, top / 2)

    # --- what is certain
    def __gt__(self, other: Number) -> bool:
        gap = self - other
        return gap.m > gap.r

    def __lt__(self, other: Number) -> bool:
        gap = self - other
        return -gap.m > gap.r

    def __ge__(self, other: Number) -> bool:
        gap = self - other
        return gap.m >= gap.r

    def __le__(self, other: Number) -> bool:
        gap = self - other
        return -gap.m >= gap.r

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Ball) and not self.r and not other.r and self.m == other.m

    __hash__ = None  # type: ignore[assignment]  # balls that overlap are neither equal nor different

    def __contains__(self, number: float) -> bool:
        return abs(self.m - number) <= self.r

    def is_zero(self) -> bool:
        return not self.m and not self.r

    def overlaps(self, other: Number) -> bool:
        return 0 in self - other

    # --- parts
    def __float__(self) -> float:
        return self.m

    def mid(self) -> Ball:
        return Ball(self.m)

    def rad(self) -> float:
        return self.r

    def abs_upper(self) -> float:
        return (abs(self.m) + self.r) * (1 + EPS)

    def abs_lower(self) -> float:
        return max(0.0, (abs(self.m) - self.r) * (1 - EPS))

    def rel_accuracy_bits(self) -> float:
        if not self.r:
            return math.inf
        return math.log2(abs(self.m) / self.r) if self.m else -math.inf

    def min(self, other: Ball) -> Ball:
        return _hull(self, other, min)

    def max(self, other: Ball) -> Ball:
        return _hull(self, other, max)

    # --- functions
    def sqrt(self) -> Ball:
        low = self.m - self.r
        if low < 0:
            raise Unclear
        root = math.sqrt(self.m)
        return Ball(root, (self.r / (root + math.sqrt(low)) if self.r else 0.0) * (1 + EPS) + EPS * root)

    def sin_cos(self) -> tuple[Ball, Ball]:
        s, c = math.sin(self.m), math.cos(self.m)
        return Ball(s, self.r * min(1.0, abs(c) + self.r) + EPS * abs(s)), Ball(c, self.r * min(1.0, abs(s) + self.r) + EPS * abs(c))

    def sin(self) -> Ball:
        return self.sin_cos()[0]

    def cos(self) -> Ball:
        return self.sin_cos()[1]

    def sinh(self) -> Ball:
        if abs(self.m) + self.r > 600:
            raise Unclear
        value = math.sinh(self.m)
        return Ball(value, self.r * math.cosh(abs(self.m) + self.r) * (1 + 4 * EPS) + 2 * EPS * abs(value))

    def exp(self) -> Ball:
        try:
            value = math.exp(self.m)
            if value < LEAST:
                return Ball(0.0, LEAST)
            return Ball(value, value * (math.expm1(self.r) * (1 + EPS) + 2 * EPS))
        except OverflowError:
            raise Unclear from None

    def log(self) -> Ball:
        low = self.m - self.r
        if not low > 0:
            raise Unclear
        value = math.log(self.m)
        return Ball(value, self.r / low * (1 + EPS) + EPS * abs(value))

    def atan(self) -> Ball:
        value, least = math.atan(self.m), self.abs_lower()
        return Ball(value, self.r / (1 + least * least) * (1 + EPS) + EPS * abs(value))


def _hull(a: Ball, b: Ball, choose: Callable[[float, float], float]) -> Ball:
    """The ball of the smaller (greater) of two numbers."""
    low, high = choose(a.m - a.r, b.m - b.r), choose(a.m + a.r, b.m + b.r)
    if a.m == b.m and a.r == b.r or (low, high) == (a.m - a.r, a.m + a.r):
        return a
    if (low, high) == (b.m - b.r, b.m + b.r):
        return b
    m = 0.5 * (low + high)
    return Ball(m, 0.5 * (high - low) * (1 + EPS) + EPS * max(abs(low), abs(high)))


class Doubles:
    """Where numbers of this kind come from; `balls.Digits` is the same for python-flint's balls."""

    bits = 53

    @staticmethod
    def ball(value: Number) -> Ball:
        """The ball of a rational number."""
        m = float(value)
        return Ball(m, 0.0 if isinstance(value, float) or _is_double(value, m) else EPS * abs(m))

    @staticmethod
    def pi() -> Ball:
        return Ball(math.pi, 2.0**-52)

    @staticmethod
    def around(middle: Ball, width: Ball) -> Ball:
        """The ball about the middle of one, as wide as `width` can be."""
        return Ball(middle.m, width.abs_upper())

    @staticmethod
    def upper(value: Ball) -> Ball:
        return Ball(value.abs_upper())

    @staticmethod
    def lower(value: Ball) -> Ball:
        return Ball(value.abs_lower())

    @staticmethod
    def angle(y: Ball, x: Ball) -> Ball:
        """atan2(y, x)."""
        size2 = x.m * x.m + y.m * y.m
        wide = (abs(x.m) * y.r + abs(y.m) * x.r) * 2
        if not size2 > 4 * (x.r + y.r) ** 2 or (x.m < 0 and 0 in y and y.r):
            raise Unclear
        value = math.atan2(y.m, x.m)
        return Ball(value, wide / size2 + EPS * abs(value))

    @staticmethod
    def real_roots(coefficients: Sequence[Number]) -> list[tuple[Ball, int]]:
        """(root, multiplicity) of the real roots, lowest first, of a polynomial with rational coefficients, lowest power
        first. Unclear where two roots cannot be told from one or from none by a wide margin."""
        c = [float(v) for v in reversed(coefficients)]
        if any(v and abs(a) < LEAST for v, a in zip(reversed(coefficients), c)):
            raise Unclear  # underflow: without a coefficient it is another polynomial
        while c and not c[0]:
            c.pop(0)
        slopes = _derivative(c)
        for t in real_roots_of(slopes):
            value, size = _value_and_size(c, t)
            if not abs(value) > FLAT * size or not size < LARGEST:
                raise Unclear
        return [(_root_ball(c, slopes, t), 1) for t in real_roots_of(c)]


def _is_double(value: Number, m: float) -> bool:
    """Whether a rational number is the double it rounds to."""
    return value.denominator & (value.denominator - 1) == 0 and value == m


# --- real roots of polynomials in floats, highest power first
def _value_and_size(c: Sequence[float], t: float) -> tuple[float, float]:
    """The value, and the sum of its terms' sizes, which its rounding is a share of."""
    value = size = 0.0
    for a in c:
        value, size = value * t + a, size * abs(t) + abs(a)
    return value, size


def _derivative(c: Sequence[float]) -> list[float]:
    return [a * (len(c) - 1 - i) for i, a in enumerate(c[:-1])]


def real_roots_of(c: Sequence[float]) -> list[float]:
    """Real roots of odd multiplicity, ascending: between those of the derivative, by Newton's method in a bracket. A pair
    that rounding hides lies where the polynomial is flat to rounding."""
    if len(c) < 2:
        return []
    if len(c) == 2:
        return [-c[1] / c[0]]
    # Fujiwara: no root exceeds twice the largest |a_i/a_0|^(1/i)
    bound = 2.0 * max(abs(a / c[0]) ** (1 / i) for i, a in enumerate(c) if i) or 1.0
    ends = [-bound, *(t for t in real_roots_of(_derivative(c)) if abs(t) < bound), bound]
    return [_crossing(c, low, high) for low, high in zip(ends, ends[1:])
            if (_value_and_size(c, low)[0] > 0) != (_value_and_size(c, high)[0] > 0)]


def _crossing(c: Sequence[float], low: float, high: float) -> float:
    """The root between low and high, where the signs differ."""
    slopes, rising = _derivative(c), _value_and_size(c, high)[0] > 0

    def look(x: float) -> tuple[float, float, bool | None]:
        value = _value_and_size(c, x)[0]
        return value, _value_and_size(slopes, x)[0], (value > 0) == rising if value else None
    return held_newton(look, low, high, 0.5, EPS)


def _root_ball(c: Sequence[float], slopes: Sequence[float], t: float) -> Ball:
    """The ball of a simple root next to t; over its width the slope hardly changes, as the root is far from flat."""
    value, size = _value_and_size(c, t)
    slope, _ = _value_and_size(slopes, t)
    if t and not abs(slope * t) > SIMPLE * size:
        raise Unclear
    return Ball(t, 2 * (abs(value) + 2 * len(c) * EPS * size) / abs(slope) if t or value else 0.0)
