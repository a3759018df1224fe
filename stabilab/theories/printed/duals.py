"""Numbers that carry a derivative along: value + slope e, e^2 = 0, over any mpmath context."""
from __future__ import annotations

import cmath


class Dual:
    """A value and its derivative by one real variable."""

    __slots__ = ("value", "slope")

    def __init__(self, value, slope):
        self.value, self.slope = value, slope

    def __add__(self, other):
        v, s = parts(other)
        return Dual(self.value + v, self.slope + s)

    def __mul__(self, other):
        v, s = parts(other)
        return Dual(self.value * v, self.slope * v + self.value * s)

    def __pow__(self, n: int):
        return Dual(self.value**n, n * self.value ** (n - 1) * self.slope if n else 0 * self.slope)

    __radd__, __rmul__ = __add__, __mul__


def parts(x):
    """(value, derivative) of a dual number or a constant."""
    return (x.value, x.slope) if isinstance(x, Dual) else (x, 0)


class DualNumbers:
    """The functions of an mpmath context, for dual numbers of its kind."""

    def __init__(self, numbers):
        self.plain = numbers

    def __getattr__(self, name):
        numbers = self.plain
        if name in ("pi", "mpf", "mpc"):
            return getattr(numbers, name)
        function = getattr(numbers, name, getattr(cmath, name, None))
        if name == "atan2":
            return lambda y, x: self._atan2(y, x)
        return lambda x: Dual(function(x.value),
                              SLOPES[name](numbers, x.value, function(x.value),
                                           x.slope)) if isinstance(x, Dual) else function(x)

    def _atan2(self, y, x):
        (a, da), (b, db) = parts(y), parts(x)
        return Dual(self.plain.atan2(a, b), (b * da - a * db) / (a * a + b * b))

    def power(self, base, exponent):
        (a, da), (b, db) = parts(base), parts(exponent)
        value = self.plain.power(a, b)
        return Dual(value, value * (db * self.plain.ln(a) + b * da / a)) if da or db else value


# name -> derivative, from (numbers, x, f(x), slope of x)
SLOPES = {
    "sin": lambda m, x, f, s: m.cos(x) * s, "cos": lambda m, x, f, s: -m.sin(x) * s, "tan": lambda m, x, f,
    s: (1 + f * f) * s,
    "cot": lambda m, x, f, s: -(1 + f * f) * s, "sec": lambda m, x, f, s: f * m.tan(x) * s,
    "sinh": lambda m, x, f, s: m.cosh(x) * s, "cosh": lambda m, x, f, s: m.sinh(x) * s, "tanh": lambda m, x,
    f, s: (1 - f * f) * s,
    "exp": lambda m, x, f, s: f * s, "ln": lambda m, x, f, s: s / x, "sqrt": lambda m, x, f, s: s / (2 * f),
    "asin": lambda m, x, f, s: s / m.sqrt(1 - x * x), "acos": lambda m, x, f, s: -s / m.sqrt(1 - x * x),
    "atan": lambda m, x, f, s: s / (1 + x * x),
    "asinh": lambda m, x, f, s: s / m.sqrt(1 + x * x), "atanh": lambda m, x, f, s: s / (1 - x * x),
    "conj": lambda m, x, f, s: m.conj(s), "re": lambda m, x, f, s: m.re(s), "im": lambda m, x, f, s: m.im(s),
    "fabs": lambda m, x, f, s: m.re(m.conj(x) * s) / f, "sign": lambda m, x, f, s: 0 * s,
}
