"""Polynomials in one variable with exact coefficients and all their real roots; roots of functions in
doubles.

The exact roots are python-flint's, which knows no Fraction. Functions in doubles have Newton's method
inside a bracket, for arrays and for floats; least values are found by the golden section, or by steps that
are halved."""
from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from functools import lru_cache, reduce
from operator import mul
from typing import TYPE_CHECKING

from .balls import Digits, Unclear, fraction, polynomial, rational, real_roots_of, settled
from .vectors import Number

if TYPE_CHECKING:
    import numpy as np
    from flint import fmpq, fmpq_poly

class Poly:
    """Polynomial with rational coefficients, lowest power first; joins with rationals. flint: the library's
    own."""

    __slots__ = ("flint",)

    def __init__(self, coefficients: Iterable[Number] = ()) -> None:
        self.flint: fmpq_poly = polynomial(*coefficients)

    @classmethod
    def of(cls, flint: fmpq_poly) -> Poly:
        """That of the library."""
        built = cls.__new__(cls)
        built.flint = flint
        return built

    def __reduce__(self) -> tuple[type, tuple[tuple[Fraction, ...]]]:
        return Poly, (self.c,)  # the library's own goes to no other process

    @property
    def c(self) -> tuple[Fraction, ...]:
        """Its coefficients; the zero polynomial has none."""
        return tuple(map(fraction, self.flint.coeffs()))

    @property
    def degree(self) -> int:
        return int(self.flint.degree())

    def __bool__(self) -> bool:
        return self.degree >= 0

    def __call__(self, t: Fraction) -> Fraction:
        return fraction(self.flint(rational(t)))

    def __add__(self, other: Number) -> Poly:
        return Poly.of(self.flint + _flint(other))

    def __mul__(self, other: Number) -> Poly:
        return Poly.of(self.flint * _flint(other))

    def __neg__(self) -> Poly:
        return Poly.of(-self.flint)

    def __sub__(self, other: Number) -> Poly:
        return Poly.of(self.flint - _flint(other))

    def __rsub__(self, other: Number) -> Poly:
        return -self + other

    def __floordiv__(self, other: Poly) -> Poly:
        return Poly.of(self.flint // other.flint)

    __radd__, __rmul__ = __add__, __mul__

    def derivative(self) -> Poly:
        return Poly.of(self.flint.derivative())

    def gcd(self, other: Poly) -> Poly:
        """The greatest common divisor, monic."""
        return Poly.of(self.flint.gcd(other.flint))

    def without_root(self, root: Fraction) -> Poly:
        """The polynomial with every factor (t - root) divided out."""
        out = self
        while out.degree > 0 and not out(root):
            out = out // Poly((-root, 1))
        return out


def _flint(value: Number) -> fmpq_poly | fmpq:
    return value.flint if isinstance(value, Poly) else rational(value)


def rounded_ratios(numerators: Iterable[Poly], denominator: Poly, t: Fraction) -> tuple[float, ...]:
    """numerators(t)/denominator(t), each rounded once: without fractions of Python in between, which take
    most of the time. ZeroDivisionError at a zero of the denominator, OverflowError beyond the doubles."""
    at = rational(t)
    bottom = denominator.flint(at)
    ratios = [numerator.flint(at) / bottom for numerator in numerators]
    return tuple(int(ratio.p) / int(ratio.q) for ratio in ratios)


def real_roots(p: Poly, bits: int = 160) -> list[Fraction]:
    """Every real root of a nonzero polynomial once, rising, within 2**-bits relative, rational ones exactly;
    none is missed and none is invented."""
    from flint import arb
    factors = [factor for factor, _ in p.flint.factor()[1]]
    if not factors:
        return []
    simple = reduce(mul, factors)
    exact = sorted(-factor[0] / factor[1] for factor in factors if factor.degree() == 1)

    def found(digits: Digits) -> list[Fraction]:
        balls = [ball for ball, _ in real_roots_of(simple)]
        if not all(first < second for first, second in zip(balls, balls[1:])):
            raise Unclear
        resolved = [next((root for root in exact if ball.overlaps(arb(root))), None) for ball in balls]
        if [root for root in resolved if root is not None] != exact:
            raise Unclear  # a rational as a ball meets those of two roots
        return [fraction(ball.mid().fmpq() if root is None else root) for ball, root in zip(balls, resolved)]
    return settled(found, bits + 8)


EPS = 2.0**-52
MOST_STEPS = 4000  # bisection alone takes no more than 2200, over all doubles


def bracketed_newton(fun: Callable[..., tuple[np.ndarray, np.ndarray]], lo: np.ndarray, hi: np.ndarray,
                     start: np.ndarray,
                     args: Sequence[np.ndarray] = (), rising: bool | np.ndarray = True, iterations: int = 200,
                     enough: float = 2 * EPS) -> np.ndarray:
    """Roots of monotone functions, one per element.

    fun(x, *args) -> (value, slope), all arrays (n,); lo, hi, start: arrays (n,), the root lies in [lo, hi]
    (ends may be any way round the root's side is decided by `rising`, a bool or array). Newton steps that
    leave the bracket are replaced by bisection, so it converges for every continuous monotone function; it
    stops at two units in the last place, or after a Newton step shorter than `enough`, relative (1e-9 leaves
    1e-18 where it converges quadratically). Returns (n,).
    """
    import numpy as np
    x = np.array(start, float)
    lo, hi = np.array(np.broadcast_to(lo, x.shape), float), np.array(np.broadcast_to(hi, x.shape), float)
    upward = np.broadcast_to(np.asarray(rising), x.shape)
    args = tuple(np.broadcast_to(a, x.shape) for a in args)
    out = x.copy()
    live = np.arange(x.size)
    last = np.full(x.shape, np.inf)  # size of the step before: Newton must at least halve it, else bisect
    for round_ in range(iterations):
        with np.errstate(all="ignore"):
            value, slope = fun(x, *args)
            step = value / slope
        right = (value > 0) == upward  # the root is on the low side of x
        hi = np.where(right, x, hi)
        lo = np.where(right, lo, x)
        new = x - step
        inside = (new >= lo) & (new <= hi) & ((np.abs(step) < 0.5 * last) | (round_ < 3))
        # at the root: rounding alone may point outside or fail to halve
        inside |= np.abs(step) <= enough * np.abs(x)
        middle = 0.5 * (lo + hi)
        new = np.where(inside, new, middle)
        move = np.abs(new - x)
        last = np.where(inside, np.abs(step), np.abs(hi - lo))
        new = np.where(value == 0, x, new)
        done = (value == 0) | (move <= np.where(inside, enough, 2 * EPS) * np.abs(new))
        done |= hi - lo <= 2 * EPS * np.maximum(np.abs(lo), np.abs(hi))
        out[live] = new
        if done.all():
            break
        if round_ >= 4:  # most are done by now: go on with the rest only
            keep = ~done
            live, x, lo, hi, last, upward = live[keep], new[keep], lo[keep], hi[keep], last[keep], upward[
                keep]
            args = tuple(a[keep] for a in args)
        else:
            x = new
    return out


def golden_section(size_of: Callable[[float], float], low: float, high: float,
                   steps: int) -> tuple[tuple[float, float], tuple[float, float]]:
    """Two places close together, each with its size, after so many steps towards the least size between low
    and high."""
    golden = (math.sqrt(5) - 1) / 2
    a, b = high - golden * (high - low), low + golden * (high - low)
    at_a, at_b = size_of(a), size_of(b)
    for _ in range(steps):
        if at_a < at_b:
            high, b, at_b = b, a, at_a
            a = high - golden * (high - low)
            at_a = size_of(a)
        else:
            low, a, at_a = a, b, at_b
            b = low + golden * (high - low)
            at_b = size_of(b)
    return (a, at_a), (b, at_b)


def compass_search(size_of: Callable[[float], float], tried: list[tuple[float, float]], step: float,
                   halvings: int, inside: Callable[[float], float]) -> list[tuple[float, float]]:
    """The (size, place) that were tried, and more of them beside the least yet, closer and closer: each step
    is half of the one before (Hooke and Jeeves 1961, in one dimension). Sizes may be infinite.

    inside(place): the place itself, or where it is in the range that is searched.
    """
    for _ in range(halvings):
        best = min(tried)[1]
        places = [inside(best + shift) for shift in (-step, step)]
        tried = [*tried, *((size_of(location), location) for location in places)]
        step /= 2
    return tried


def held_newton(look: Callable[[float], tuple[float, float, bool | None]], low: float, high: float,
                part: float, enough: float, start: float | None = None) -> float:
    """The root between two floats, to a double or its neighbour: Newton's method held in a bracket.

    look(x) -> (value, slope, whether x lies beyond the root; None where it is the root). part: of the
    bracket, the longest step that is taken; enough: the last step, relative; start: where the search begins.
    """
    x = between(low, high) if start is None else start
    for _ in range(MOST_STEPS):
        value, slope, beyond = look(x)
        if beyond is None:
            break
        low, high = (low, x) if beyond else (x, high)
        new = x - value / slope if slope else low
        if not low < new < high or abs(new - x) > part * (high - low):
            new = between(low, high)
        if not low < new < high or abs(new - x) <= enough * abs(x):
            return new
        x = new
    return x


def halved(value: Callable[[float], float], low: float, high: float) -> float:
    """The root of a function between two floats at which its signs differ, or at one of which it is 0, by
    halving, to some last places of the larger."""
    rising, enough = value(high) > 0 or value(low) < 0, 2 * EPS * max(abs(low), abs(high))
    while high - low > enough:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if (value(middle) > 0) == rising else (middle, high)
    return 0.5 * (low + high)


def between(lo: float, hi: float) -> float:
    """A point inside (lo, hi), geometric where the ends differ by orders of magnitude."""
    if lo * hi > 0 and not 0.01 < abs(lo / hi) < 100:
        return math.copysign(math.sqrt(abs(lo)) * math.sqrt(abs(hi)), lo)
    if lo == 0 or hi == 0:
        return (lo + hi) * 2.0**-16
    return 0.5 * lo + 0.5 * hi


# --- real roots of polynomials in floats, highest power first
def _value(c: Sequence[float], t: float) -> float:
    value = 0.0
    for a in c:
        value = value * t + a
    return value


def _derivative(c: Sequence[float]) -> list[float]:
    return [a * (len(c) - 1 - i) for i, a in enumerate(c[:-1])]


def roots_in_doubles(c: Sequence[float]) -> list[float]:
    """Real roots of odd multiplicity, ascending: between those of the derivative, by Newton's method in a
    bracket. A pair that rounding hides lies where the polynomial is flat to rounding."""
    if len(c) < 2:
        return []
    if len(c) == 2:
        return [-c[1] / c[0]]
    # Fujiwara: no root exceeds twice the largest |a_i/a_0|^(1/i)
    bound = 2.0 * max(abs(a / c[0]) ** (1 / i) for i, a in enumerate(c) if i) or 1.0
    ends = [-bound, *(t for t in roots_in_doubles(_derivative(c)) if abs(t) < bound), bound]
    return [_crossing(c, low, high) for low, high in zip(ends, ends[1:])
            if (_value(c, low) > 0) != (_value(c, high) > 0)]


def _crossing(c: Sequence[float], low: float, high: float) -> float:
    """The root between low and high, where the signs differ."""
    slopes, rising = _derivative(c), _value(c, high) > 0

    def look(x: float) -> tuple[float, float, bool | None]:
        value = _value(c, x)
        return value, _value(slopes, x), (value > 0) == rising if value else None
    return held_newton(look, low, high, 0.5, EPS)


# --- Bernstein coefficients on [0, 1]: a polynomial lies between the least and the greatest of them, and has
# no more zeros there than they change sign
@lru_cache(maxsize=4)
def bernstein(degree: int) -> np.ndarray:
    """(degree + 1, degree + 1): from coefficients of powers, lowest first, to Bernstein's."""
    import numpy as np
    return np.array([[math.comb(i, k) / math.comb(degree, k) if k <= i else 0.0 for k in range(degree + 1)]
                     for i in range(degree + 1)])


def bernstein_halves(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The coefficients on [0, 1/2] and on [1/2, 1], by means (de Casteljau)."""
    import numpy as np
    left, right = [values[0]], [values[-1]]
    while len(values) > 1:
        values = 0.5 * (values[1:] + values[:-1])
        left.append(values[0])
        right.append(values[-1])
    return np.array(left), np.array(right[::-1])
