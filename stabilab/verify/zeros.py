"""All zeros of a function on an interval, enclosed: cells without a zero, and cells where the function is monotone."""
from __future__ import annotations

from fractions import Fraction

from .numbers import ball, hull, sign

CELLS = 20_000  # for one orbit: some ten seconds; scenes of the tests take up to a few thousand
SPLIT = Fraction(489, 1000)  # off the middle: a zero is less often where a cell is cut


class Open(Exception):
    """Not decided at this precision."""


class Spent(Exception):
    """Not decided with as much work as one question may take: more bits would not help."""


class Purse:
    """How many cells may still be looked at for one question, over all intervals and precisions."""

    def __init__(self, cells):
        self.cells = cells

    def spend(self):
        """One cell. Raises `Spent` when there are none left."""
        if not self.cells:
            raise Spent
        self.cells -= 1


def zeros(f, df, low: Fraction, high: Fraction, at_low=False, at_high=False, purse=None, multiple=(), bend=None):
    """Balls that hold one zero of f each, rising, and no zero on (low, high) is elsewhere but those of even order in `multiple`.

    multiple: (ball, order) of zeros of higher order, by algebra, all of them; bend: then, the derivative of an order over a ball.
    at_low, at_high: f is known to vanish exactly at that end; such a zero is not listed. purse: pays for the cells.
    """
    purse = purse or Purse(CELLS)
    from flint import ctx
    found, stack = [], [(low, high)]
    smallest = (high - low) / 2**ctx.prec
    while stack:
        a, b = stack.pop()
        purse.spend()
        if b - a < smallest:
            raise Open
        cell = hull(a, b)
        if sign(f(cell)):
            continue
        if not sign(df(cell)):
            at_end = at_low and a == low or at_high and b == high
            known = _multiple(multiple, bend, a, b, at_end)
            if known:  # that derivative has one sign, so nothing else vanishes
                if known[1] % 2 and not at_end:
                    found.append(known[0])
                continue
            c = a + (b - a) * SPLIT
            stack += [(c, b), (a, c)]
            continue
        if (at_low and a == low) or (at_high and b == high):
            continue  # monotone: the zero at the end is the only one
        ends = sign(f(ball(a))), sign(f(ball(b)))
        if None in ends or 0 in ends:
            raise Open
        if ends[0] != ends[1]:
            found.append(narrowed(f, df, a, b))
    return found


def _multiple(multiple, bend, a, b, at_end):
    """The (ball, order) of the only zero of a cell, if it is one of higher order: within it, or at its end zero, where f is known to vanish."""
    for spot, order in multiple:
        inside = a < below(spot) and above(spot) < b or at_end and 0 in (a, b) and 0 in spot
        if inside and order < 4 and sign(bend(hull(a, b), order)):
            return spot, order
    return None


def narrowed(f, df, a: Fraction, b: Fraction):
    """The ball of the one zero of a function that is monotone on [a, b] and changes sign there: interval Newton."""
    from flint import ctx
    x = hull(a, b)
    for _ in range(4 * ctx.prec.bit_length() + 40):
        centre = x.mid()
        slope = df(x)
        if not sign(slope):
            return _bisected(f, df, a, b)
        new = centre - f(centre) / slope
        if not new.overlaps(x):
            raise Open
        new = new.intersection(x)
        if not new.rad() < x.rad() * 0.9:
            return new
        x = new
    return x


def _bisected(f, df, a, b):
    """Halve the bracket until Newton's step may be tried again."""
    left = sign(f(ball(a)))
    for _ in range(200):
        c = a + (b - a) * SPLIT
        middle = sign(f(ball(c)))
        if not left or not middle:
            raise Open
        a, b = (c, b) if middle == left else (a, c)
        if sign(df(hull(a, b))):
            return narrowed(f, df, a, b)
    raise Open


def below(value) -> Fraction:
    """The lower end of a ball, exactly."""
    return _exact(value.mid()) - _exact(value.rad())


def above(value) -> Fraction:
    """The upper end of a ball, exactly."""
    return _exact(value.mid()) + _exact(value.rad())


def _exact(value) -> Fraction:
    """An exact ball as a fraction."""
    value = value.mid() if value.is_exact() else value.upper()
    mantissa, exponent = (int(v) for v in value.man_exp())
    return Fraction(mantissa) * Fraction(2) ** exponent
