"""Exact numbers: what the user wrote, before any rounding."""
from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import fields
from decimal import Decimal
from fractions import Fraction
from numbers import Integral, Rational, Real
from threading import RLock
from types import ModuleType
from typing import Any

from ..errors import InputError
from .balls import fraction, rational, working
from .vectors import Exact3

# one way only to match: else a long wrong number would be tried in exponentially many
_DIGITS = r"\d+(?:_\d+)*"
_DECIMAL = re.compile(rf"\s*[+-]?(?:{_DIGITS}(?:\.(?:{_DIGITS})?)?|\.{_DIGITS})(?:[eE][+-]?\d{{1,4}})?\s*",
                      re.ASCII)
_RATIO = re.compile(r"\s*[+-]?\d+\s*/\s*\d+\s*", re.ASCII)


def exact(value: object, name: str = "") -> Fraction:
    """The rational number that `value` denotes: int, float (its binary value), Fraction, Decimal, or a string
    holding a decimal or a ratio ("0.1", "2/3"). Raises InputError for anything else, and where the double
    nearest to the value would be infinite or would lose a nonzero value to zero; its words begin with `name`,
    where there is one."""
    if name:
        try:
            return exact(value)
        except InputError as error:
            raise InputError(f"{name}: {error}") from None
    number = _parse(value)
    try:
        rounded = float(number)
    except OverflowError:
        raise InputError(f"{_short(value)} is larger than the largest double (about 1.8e308)") from None
    if number and not rounded:
        raise InputError(
            f"{_short(value)} is smaller than the smallest double (about 4.9e-324); write 0 if zero is meant")
    return number


def _short(value: object) -> str:
    """The number as it came, or that it is a long one."""
    return repr(value) if len(repr(value)) <= 60 else "the number"


def _parse(value: Any) -> Fraction:
    if isinstance(value, bool):
        raise InputError(f"expected a number, got the truth value {str(value).lower()}")
    if isinstance(value, (Integral, Rational)):
        return (Fraction(int(value.numerator), int(value.denominator)) if isinstance(value, Rational)
                else Fraction(int(value)))
    if isinstance(value, Real):
        if not math.isfinite(value):
            raise InputError(f"expected a finite number, got {float(value)}")
        return Fraction(float(value))
    if isinstance(value, Decimal):
        if not value.is_finite():
            raise InputError(f"expected a finite number, got {value}")
        if value and abs(value.adjusted()) > 9999:  # as of text: else a power of ten without an end is built
            raise InputError(f"{_short(value)} is {'larger' if value.adjusted() > 0 else 'smaller'} than any "
                             "double but 0")
        return Fraction(value)
    if isinstance(value, str):
        if len(value) <= 400 and (_DECIMAL.fullmatch(value) or _RATIO.fullmatch(value)):
            try:
                return Fraction("".join(value.replace("_", "").split()))
            except ZeroDivisionError:
                raise InputError(f'"{value}" divides by zero') from None
        raise InputError(f'expected a decimal or a ratio such as "0.1" or "2/3", got "{value[:60]}"')
    raise InputError(f"expected a number, got {type(value).__name__}")


class Rounded:
    """A data class of exact numbers that prints them in so many digits as people read."""

    def __repr__(self) -> str:
        shown = [field.name for field in fields(self) if field.repr]  # type: ignore[arg-type]
        values = ((name, getattr(self, name)) for name in shown)
        return f"{type(self).__name__}({', '.join(f'{name}={_read(value)}' for name, value in values)})"


def _read(value: object) -> str:
    """A value as text, rationals and doubles in twelve digits."""
    if isinstance(value, (Fraction, float)):
        return f"{float(value):.12g}"
    if isinstance(value, tuple):
        return f"({', '.join(map(_read, value))}{',' * (len(value) == 1)})"
    return repr(value)


def half_unit(value: object) -> Fraction:
    """Half a unit of the last digit of a number as it was written, a double in its shortest digits; 0 of a
    ratio, of a Fraction, and of a whole number of less than four digits: whoever writes 2 or 100 means
    exactly that."""
    written = repr(float(value)) if isinstance(value, float) else str(value)  # NumPy repr: np.float64(0.1)
    digits, _, power = "".join(written.replace("_", "").split()).lower().partition("e")
    if isinstance(value, Fraction) or "/" in digits or ("." not in digits and len(digits.lstrip("+-")) < 4):
        return Fraction(0)
    return Fraction(10) ** (int(power or 0) - len(digits.partition(".")[2])) / 2


def exact_vector(values: Iterable[object], name: str, read: Callable[[Any], Fraction] = exact) -> Exact3:
    """Three exact numbers, each as `read` takes it; InputError names `name` otherwise."""
    try:
        items = list(values) if not isinstance(values, (str, bytes, bytearray)) else None
    except TypeError:
        items = None
    if items is None or len(items) != 3:
        came = type(values).__name__ if items is None else f"{len(items)} of them"
        raise InputError(f"{name}: expected three numbers, got {came}")
    try:
        return tuple(read(v) for v in items)
    except InputError as error:
        raise InputError(f"{name}: {error}") from None


def sqrt_fraction(value: Fraction, bits: int = 240) -> Fraction:
    """A rational within 2**-bits relative of the square root of a non-negative rational; exact for exact
    squares."""
    n, d = value.numerator, value.denominator
    rn, rd = math.isqrt(n), math.isqrt(d)
    if rn * rn == n and rd * rd == d:
        return Fraction(rn, rd)
    shift = max(0, bits + (d.bit_length() - n.bit_length()) // 2 + d.bit_length())
    return Fraction(math.isqrt((n << (2 * shift)) // d), 1 << shift)


def unit_vector(vector: Sequence[Fraction]) -> Exact3:
    """The vector in length 1: exactly where its length is rational, as along an axis, else good to 240 bits.
    ZeroDivisionError for zero."""
    length = sqrt_fraction(sum((v * v for v in vector), Fraction(0)))
    return tuple(v / length for v in vector)


@contextmanager
def mpmath_alone() -> Iterator[ModuleType]:
    """Context giving mpmath to this thread alone: its precision, and the digits of pi that it keeps, belong
    to the process."""
    import mpmath
    with _MPMATH:
        yield mpmath


_MPMATH = RLock()


GUARD = 64  # bits beyond those asked for, which rounding in between may spoil


def precise(name: str, *arguments: Fraction, bits: int = 240) -> Fraction:
    """The number of bits + 20 places nearest to the cosine of a rational ("cos") or to "pi"; of an angle with
    more places, to that of the angle rounded to them."""
    from flint import arb
    places, guard = bits + 20, GUARD
    angle = [_nearest(_nearest(Fraction(v.numerator), places) / v.denominator, places) for v in arguments]
    while True:
        with working(places + guard):
            ball = arb(rational(*angle)).cos() if angle else arb.pi()
            low, high = (_nearest(fraction(end.fmpq()), places) for end in (ball.lower(), ball.upper()))
        if low == high:
            return low
        guard *= 2


def _nearest(value: Fraction, places: int) -> Fraction:
    """The nearest number of so many bits, the even one of two that are as near."""
    if not value:
        return value
    n, d = value.numerator, value.denominator
    shift = places - (abs(n).bit_length() - d.bit_length())
    while True:
        scaled = Fraction(n << shift, d) if shift >= 0 else Fraction(n, d << -shift)
        if abs(scaled) < 1 << places:
            break
        shift -= 1
    return Fraction(round(scaled)) / Fraction(2) ** shift


def floats(values: Iterable[Any]) -> tuple[float, ...]:
    """Each exact number rounded once, to the nearest double."""
    return tuple(float(v) for v in values)


def sign_of(value: Fraction) -> int:
    """-1, 0 or 1."""
    return (value > 0) - (value < 0)
