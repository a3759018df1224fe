"""Numbers within a radius of a middle, in doubles: for bounds of derivatives over boxes, where every radius is a box's own."""
from __future__ import annotations

MORE = 2.0**-40  # of a middle: what the rounding of a dozen operations stays far below


class Span:
    """All numbers within r of m."""

    __slots__ = ("m", "r")

    def __init__(self, m, r=0.0):
        self.m, self.r = m, r

    def __add__(self, other):
        if isinstance(other, Span):
            return Span(self.m + other.m, self.r + other.r + MORE * (abs(self.m) + abs(other.m)))
        return Span(self.m + other, self.r + MORE * (abs(self.m) + abs(other)))

    def __neg__(self):
        return Span(-self.m, self.r)

    def __sub__(self, other):
        return self + -other

    def __rsub__(self, other):
        return -self + other

    def __mul__(self, other):
        if isinstance(other, Span):
            m = self.m * other.m
            return Span(m, abs(self.m) * other.r + self.r * (abs(other.m) + other.r) + MORE * abs(m))
        m = self.m * other
        return Span(m, self.r * abs(other) + MORE * abs(m))

    __radd__, __rmul__ = __add__, __mul__

    def inverse(self):
        """One over it; a radius of inf where it holds zero."""
        least = abs(self.m) - self.r
        if not least > 0:
            return Span(0.0, float("inf"))
        m = 1 / self.m
        return Span(m, self.r * abs(m) / least + MORE * abs(m))

    def pair(self):
        return self.m, self.r * (1 + 1e-9)
