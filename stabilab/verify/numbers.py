"""Numbers of certificates read exactly, balls and their precision, the zero of a monotone function.

python-flint's precision belongs to the whole process, which may run the analysis in another thread meanwhile.
So whoever needs it holds one lock, and the lock stands on the library: the one thing that checker and
analysis share, and neither has to know the other. """
from __future__ import annotations

import re
import reprlib
from contextlib import contextmanager
from fractions import Fraction
from threading import RLock

from flint import arb, ctx, fmpq

# --- Exact numbers, brackets and balls as a certificate writes them
# of a whole number, and of an exponent's value: Python's own limit; longer is an attack, not a certificate
DIGITS = 4300
MOST = 64  # entries of a list: no scene has nearly as many equilibria, curves, pieces or coefficients
NUMBER = re.compile(r"[-+]?([0-9]+(/[0-9]+)?|([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]{1,5})?)")
LINEAR, VERDICT = ("stable", "unstable", "degenerate"), ("stable", "unstable", "undecided")


class Malformed(ValueError):
    """The certificate is not of the form that docs/certificate.md describes."""


def shown(value) -> str:
    """A value for a message: short, without control characters, however long or deep it is."""
    try:
        return f"{reprlib.repr(value):.80}"
    except ValueError:  # a whole number of more digits than Python prints
        return type(value).__name__


def number(text, where: str) -> Fraction:
    """The exact value of "p/q", an integer or a decimal, in plain digits."""
    if not isinstance(text, str):
        raise Malformed(f"{where}: expected a number as a string, got {shown(text)}")
    _, _, exponent = text.lower().partition("e")
    plain = len(text) <= 2 * DIGITS + 2 and NUMBER.fullmatch(text)
    if not plain or max(map(len, re.findall("[0-9]+",
                                            text))) > DIGITS or (exponent and abs(int(exponent)) > DIGITS):
        raise Malformed(
            f"{where}: expected an integer, a decimal or p/q of at most {DIGITS} digits, got {shown(text)}")
    try:
        return Fraction(text)
    except (ValueError, ZeroDivisionError):
        raise Malformed(f"{where}: expected an integer, a decimal or p/q, got {shown(text)}") from None


def numbers(values, where: str, count: int | None = None) -> list[Fraction]:
    """A list of exact numbers."""
    if not isinstance(values, list) or len(values) > MOST or (count is not None and len(values) != count):
        raise Malformed(
            f"{where}: expected a list of {count or f'at most {MOST}'} numbers, got {shown(values)}")
    return [number(v, f"{where}[{i}]") for i, v in enumerate(values)]


def bracket(values, where: str) -> tuple[Fraction, Fraction]:
    """(lo, hi), lo <= hi."""
    low, high = numbers(values, where, 2)
    if low > high:
        raise Malformed(f"{where}: expected a bracket [lo, hi], got lo > hi")
    return low, high


def brackets(values, where: str) -> list[tuple[Fraction, Fraction]]:
    """Three of them."""
    if not isinstance(values, list) or len(values) != 3:
        raise Malformed(f"{where}: expected three brackets, got {shown(values)}")
    return [bracket(ends, f"{where}[{i}]") for i, ends in enumerate(values)]


def whole(value, where: str, known) -> int:
    """One of the whole numbers that are known (a range, or a tuple); truth values are none."""
    if type(value) is not int or value not in known:
        words = f"{known[0]} to {known[-1]}" if isinstance(known, range) else ", ".join(map(str, known))
        raise Malformed(f"{where}: expected a whole number, {words}; got {shown(value)}")
    return value


def optional(table: dict, key: str, read):
    """What is read of table[key]; None where it is missing or null."""
    value = table.get(key)
    return None if value is None else read(value)


def field(table, key: str, where: str, kind=None):
    """table[key], of a given type."""
    if not isinstance(table, dict) or key not in table:
        raise Malformed(f"{where}: {key} is missing")
    if kind is not None and not isinstance(table[key], kind):
        raise Malformed(f"{where}.{key}: expected {getattr(kind, '__name__', kind)}, got {shown(table[key])}")
    return table[key]


def word(table, key: str, where: str, known: tuple) -> str:
    """table[key], one of the words that are known."""
    value = field(table, key, where)
    if not isinstance(value, str) or value not in known:
        raise Malformed(f"{where}.{key}: expected one of {', '.join(known)}, got {shown(value)}")
    return value


def entries(table, key: str, where: str) -> list:
    """table[key], a list; [] where it is missing or null."""
    if isinstance(table, dict) and table.get(key) is None:
        return []
    if len(field(table, key, where, list)) > MOST:
        raise Malformed(f"{where}.{key}: expected at most {MOST} entries, got {len(table[key])}")
    return table[key]


def brief(value: Fraction) -> str:
    """A number of any size in nine digits."""
    try:
        return f"{float(value):.9g}"
    except OverflowError:
        return ball(value).str(9, radius=False)


def q(value: Fraction):
    """flint's rational."""
    value = Fraction(value)
    return fmpq(value.numerator, value.denominator)


def fraction(value) -> Fraction:
    """The same number as Python's fraction."""
    return Fraction(int(value.p), int(value.q))


def ball(value):
    """The ball of an exact number at the working precision."""
    return arb(q(value))


def hull(low, high):
    """The ball that holds [low, high]."""
    return ball(low).union(ball(high))


def sign(value) -> int | None:
    """Sign of a ball; None where it is open."""
    return 1 if value > 0 else -1 if value < 0 else 0 if value.is_zero() else None


def exact_sign(value) -> int:
    """Sign of a rational."""
    return (value > 0) - (value < 0)


@contextmanager
def working(bits: int):
    """Context in which python-flint works with so many bits, for this thread alone."""
    import flint
    with vars(flint).setdefault("stabilab_lock", RLock()), flint.ctx.workprec(bits):
        yield


# --- The zero of a function on an interval where it is monotone
SPLIT = Fraction(489, 1000)  # off the middle: a zero is less often where an interval is cut


class Open(Exception):
    """Not decided at this precision."""


def narrowed(f, df, a: Fraction, b: Fraction):
    """The ball of the one zero of a function that is monotone on [a, b] and changes sign there: interval
    Newton."""
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
    for _ in range(2000):
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
