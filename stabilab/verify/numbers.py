"""Exact numbers, brackets and balls as a certificate writes them."""
from __future__ import annotations

from fractions import Fraction

DIGITS = 20_000  # a longer number is an attack on the reader's memory, not a certificate


class Malformed(ValueError):
    """The certificate is not of the form that docs/certificate.md describes."""


def number(text, where: str) -> Fraction:
    """The exact value of "p/q", an integer or a decimal."""
    if not isinstance(text, str) or not 0 < len(text) <= DIGITS:
        raise Malformed(f"{where}: expected a number as a string, got {text!r:.80}")
    _, _, exponent = text.lower().partition("e")
    try:
        if exponent and abs(int(exponent)) > DIGITS:
            raise ValueError
        return Fraction(text)
    except (ValueError, ZeroDivisionError):
        raise Malformed(f"{where}: expected an integer, a decimal or p/q, got {text!r:.80}") from None


def numbers(values, where: str, count: int | None = None) -> list[Fraction]:
    """A list of exact numbers."""
    if not isinstance(values, list) or (count is not None and len(values) != count):
        raise Malformed(f"{where}: expected a list of {count or 'some'} numbers, got {values!r:.80}")
    return [number(v, f"{where}[{i}]") for i, v in enumerate(values)]


def bracket(values, where: str) -> tuple[Fraction, Fraction]:
    """(lo, hi), lo <= hi."""
    low, high = numbers(values, where, 2)
    if low > high:
        raise Malformed(f"{where}: expected a bracket [lo, hi], got lo > hi")
    return low, high


def field(table, key: str, where: str, kind=None):
    """table[key], of a given type."""
    if not isinstance(table, dict) or key not in table:
        raise Malformed(f"{where}: {key} is missing")
    if kind is not None and not isinstance(table[key], kind):
        raise Malformed(f"{where}.{key}: expected {getattr(kind, '__name__', kind)}, got {table[key]!r:.80}")
    return table[key]


def entries(table, key: str, where: str) -> list:
    """table[key], a list; [] where it is missing or null."""
    return field(table, key, where, list) if table.get(key) is not None else []


def q(value: Fraction):
    """flint's rational."""
    from flint import fmpq
    value = Fraction(value)
    return fmpq(value.numerator, value.denominator)


def fraction(value) -> Fraction:
    """The same number as Python's fraction."""
    return Fraction(int(value.p), int(value.q))


def ball(value):
    """The ball of an exact number at the working precision."""
    from flint import arb
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
