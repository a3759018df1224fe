"""Exact numbers: what the user wrote, before any rounding."""
from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from fractions import Fraction
from numbers import Integral, Rational, Real
from threading import RLock
from types import ModuleType
from typing import Any

from ..errors import InputError
from .vectors import Exact3

_DIGITS = r"\d+(?:_\d+)*"  # one way only to match: else a long wrong number would be tried in exponentially many
_DECIMAL = re.compile(rf"\s*[+-]?(?:{_DIGITS}(?:\.(?:{_DIGITS})?)?|\.{_DIGITS})(?:[eE][+-]?\d{{1,4}})?\s*", re.ASCII)
_RATIO = re.compile(r"\s*[+-]?\d+\s*/\s*\d+\s*", re.ASCII)


def exact(value: object) -> Fraction:
    """The rational number that `value` denotes: int, float (its binary value), Fraction, or a string holding a
    decimal or a ratio ("0.1", "2/3"). Raises InputError for anything else, and where the double nearest to the
    value would be infinite or would lose a nonzero value to zero."""
    number = _parse(value)
    try:
        rounded = float(number)
    except OverflowError:
        raise InputError(f"{_short(value)} is larger than the largest double (about 1.8e308)") from None
    if number and not rounded:
        raise InputError(f"{_short(value)} is smaller than the smallest double (about 4.9e-324); write 0 if zero is meant")
    return number


def _short(value: object) -> str:
    """The number as it came, or that it is a long one."""
    return repr(value) if len(repr(value)) <= 60 else "the number"


def _parse(value: Any) -> Fraction:
    if isinstance(value, bool):
        raise InputError(f"expected a number, got the truth value {str(value).lower()}")
    if isinstance(value, (Integral, Rational)):
        return Fraction(int(value.numerator), int(value.denominator)) if isinstance(value, Rational) else Fraction(int(value))
    if isinstance(value, Real):
        if not math.isfinite(value):
            raise InputError(f"expected a finite number, got {float(value)}")
        return Fraction(float(value))
    if isinstance(value, str):
        if len(value) <= 400 and (_DECIMAL.fullmatch(value) or _RATIO.fullmatch(value)):
            try:
                return Fraction("".join(value.replace("_", "").split()))
            except ZeroDivisionError:
                raise InputError(f'"{value}" divides by zero') from None
        raise InputError(f'expected a decimal or a ratio such as "0.1" or "2/3", got "{value[:60]}"')
    raise InputError(f"expected a number, got {type(value).__name__}")


def exact_vector(values: Iterable[object], name: str) -> Exact3:
    """Three exact numbers; InputError names `name` otherwise."""
    try:
        items = list(values) if not isinstance(values, str) else None
    except TypeError:
        items = None
    if items is None or len(items) != 3:
        came = type(values).__name__ if items is None else f"{len(items)} of them"
        raise InputError(f"{name}: expected three numbers, got {came}")
    try:
        return tuple(exact(v) for v in items)
    except InputError as error:
        raise InputError(f"{name}: {error}") from None


def sqrt_fraction(value: Fraction, bits: int = 240) -> Fraction:
    """A rational within 2**-bits relative of the square root of a non-negative rational; exact for exact squares."""
    n, d = value.numerator, value.denominator
    rn, rd = math.isqrt(n), math.isqrt(d)
    if rn * rn == n and rd * rd == d:
        return Fraction(rn, rd)
    shift = max(0, bits + (d.bit_length() - n.bit_length()) // 2 + d.bit_length())
    return Fraction(math.isqrt((n << (2 * shift)) // d), 1 << shift)


@contextmanager
def mpmath_alone() -> Iterator[ModuleType]:
    """Context giving mpmath to this thread alone: its precision, and the digits of pi that it keeps, belong to the process."""
    import mpmath
    with _MPMATH:
        yield mpmath


_MPMATH = RLock()


def precise(name: str, *arguments: Fraction, bits: int = 240) -> Fraction:
    """A rational within about 2**-bits of a function of rationals ("cos", "sqrt") or of a constant ("pi")."""
    with mpmath_alone() as mpmath, mpmath.workprec(bits + 20):
        values = [mpmath.mpf(a.numerator) / a.denominator for a in arguments]
        number = getattr(mpmath.mp, name)
        value = number(*values) if values else +number
        man, exp = value.man_exp  # of the size alone
    return Fraction(-man if value < 0 else man) * Fraction(2) ** exp


def floats(values: Iterable[Any]) -> tuple[float, ...]:
    """Each exact number rounded once, to the nearest double."""
    return tuple(float(v) for v in values)
