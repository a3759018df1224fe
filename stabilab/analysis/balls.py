"""Balls: numbers that surely hold the true value, in doubles first and in as many digits as a question needs.

A question that the balls leave open raises `Unclear`, and `settled` asks it again with twice the bits. A question asked
from DOUBLE_BITS on is tried with balls of doubles first (`double_balls`), which need no library.
"""
from __future__ import annotations

from fractions import Fraction

from .double_balls import Doubles, Unclear

DOUBLE_BITS = 53
START_BITS = 128


class Digits:
    """Where python-flint's balls come from, at its working precision; `double_balls.Doubles` has the same interface."""

    @staticmethod
    def ball(value):
        from flint import arb
        return arb(rational(Fraction(value)))

    @staticmethod
    def pi():
        from flint import arb
        return arb.pi()

    @staticmethod
    def around(middle, width):
        """The ball about the middle of one, as wide as `width` can be."""
        from flint import arb
        return arb(middle.mid(), width.abs_upper())

    @staticmethod
    def upper(value):
        from flint import arb
        return arb(value.abs_upper())

    @staticmethod
    def lower(value):
        from flint import arb
        return arb(value.abs_lower())

    @staticmethod
    def angle(y, x):
        """atan2(y, x)."""
        from flint import arb
        return arb.atan2(y, x) if not (0 in y and not x > 0) else arb.pi() + arb.atan2(-y, -x)

    @staticmethod
    def real_roots(coefficients) -> list:
        """(root, multiplicity) of the real roots of a polynomial with rational coefficients, lowest first; certified."""
        from flint import arb, fmpq_poly
        poly = fmpq_poly([rational(Fraction(c)) for c in coefficients])
        if poly.degree() < 1:
            return []
        found = [(arb(root.real), many) for root, many in poly.complex_roots() if root.imag.is_zero()]
        return sorted(found, key=lambda one: one[0].mid())  # flint lists them multiplicity by multiplicity


_numbers = Digits


def numbers():
    """The kind of balls in use: `Digits`, or `Doubles` while `settled` tries with these."""
    return _numbers


def settled(question, bits: int = START_BITS, most: int = 1 << 17):
    """question(bits), with more bits as long as it is `Unclear`; the last Unclear when `most` are not enough.

    bits: at first. DOUBLE_BITS: with balls of doubles, then from START_BITS on, unless DOUBLE_BITS is also the `most`.
    """
    global _numbers
    if bits == DOUBLE_BITS:
        _numbers = Doubles
        try:
            return question(bits)
        except (Unclear, ArithmeticError):
            if most == DOUBLE_BITS:
                raise Unclear from None
            bits = START_BITS
        finally:
            _numbers = Digits
    from flint import ctx
    while True:
        try:
            with ctx.workprec(bits):
                return question(bits)
        except Unclear:
            if bits >= most:
                raise
            bits *= 2


def ball(value):
    """The ball of a rational number."""
    return _numbers.ball(value)


def rational(value):
    """A Fraction, or flint's own rational or integer, as flint's rational."""
    from flint import fmpq
    return fmpq(value.numerator, value.denominator) if isinstance(value, Fraction) else fmpq(value)


def sign(number) -> int:
    """Sign of a ball; Unclear where it holds zero and more."""
    if number > 0:
        return 1
    if number < 0:
        return -1
    if number.is_zero():
        return 0
    raise Unclear
