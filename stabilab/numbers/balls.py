"""Balls: numbers that surely hold the true value, in doubles first and in as many digits as a question needs.

The kind of ball is a value: a question takes it as its argument and hands it on to whatever computes. One that the balls
leave open raises `Unclear`, and `settled` asks it again with twice the bits. A question asked from DOUBLE_BITS on is tried
with balls of doubles first (`double_balls`), which need no library.
"""
from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from fractions import Fraction
from threading import RLock
from typing import TYPE_CHECKING, Any, TypeVar

from .double_ball import Doubles, Unclear
from .vectors import Number

if TYPE_CHECKING:
    from flint import arb, fmpq

T = TypeVar("T")
DOUBLE_BITS = Doubles.bits
START_BITS = 128


@contextmanager
def working(bits: int, terms: int = 10) -> Iterator[Digits]:
    """Context in which python-flint works with so many bits, for this thread alone; gives the kind of number, `Digits`. terms: of a power series, at
    the most; flint leaves out what lies beyond without a word.

    flint's precision belongs to the process: whoever forms balls from inexact ones holds the one lock that goes with it. It
    stands on the library itself, where the checker of certificates, which imports nothing from here, finds it too.
    """
    import flint
    with vars(flint).setdefault("stabilab_lock", RLock()), flint.ctx.workprec(bits):
        before, flint.ctx.cap = flint.ctx.cap, terms
        try:
            yield Digits(bits)
        finally:
            flint.ctx.cap = before


@dataclass(frozen=True)
class Digits:
    """Where python-flint's balls come from, to be used while it is `working` with so many bits; `double_balls.Doubles` has
    the same interface."""

    bits: int

    @staticmethod
    def ball(value: Number) -> arb:
        from flint import arb
        return arb(rational(Fraction(value)))

    @staticmethod
    def pi() -> arb:
        from flint import arb
        return arb.pi()

    @staticmethod
    def around(middle: arb, width: arb) -> arb:
        """The ball about the middle of one, as wide as `width` can be."""
        from flint import arb
        return arb(middle.mid(), width.abs_upper())

    @staticmethod
    def upper(value: arb) -> arb:
        from flint import arb
        return arb(value.abs_upper())

    @staticmethod
    def lower(value: arb) -> arb:
        from flint import arb
        return arb(value.abs_lower())

    @staticmethod
    def angle(y: arb, x: arb) -> arb:
        """atan2(y, x)."""
        from flint import arb
        return arb.atan2(y, x) if not (0 in y and not x > 0) else arb.pi() + arb.atan2(-y, -x)

    @staticmethod
    def real_roots(coefficients: Sequence[Number]) -> list[tuple[arb, int]]:
        """(root, multiplicity) of the real roots of a polynomial with rational coefficients, lowest first; certified."""
        from flint import arb, fmpq_poly
        poly = fmpq_poly([rational(Fraction(c)) for c in coefficients])
        if poly.degree() < 1:
            return []
        roots: list[Any] = poly.complex_roots()  # flint's own types leave the multiplicities out
        found = [(arb(root.real), many) for root, many in roots if root.imag.is_zero()]
        return sorted(found, key=lambda one: one[0].mid())  # flint lists them multiplicity by multiplicity


DOUBLES = Doubles()


def settled(question: Callable[[Doubles | Digits], T], bits: int = START_BITS, most: int = 1 << 17) -> T:
    """question(numbers), with more bits as long as it is `Unclear`; the last Unclear when `most` are not enough.

    numbers: the kind, a `Doubles` or a `Digits`, with its `bits`. bits: at first. DOUBLE_BITS: with balls of doubles, then
    from START_BITS on, unless DOUBLE_BITS is also the `most`.
    """
    if bits == DOUBLE_BITS:
        try:
            return question(DOUBLES)
        except (Unclear, ArithmeticError):
            if most == DOUBLE_BITS:
                raise Unclear from None
            bits = START_BITS
    while True:
        try:
            with working(bits) as numbers:
                return question(numbers)
        except Unclear:
            if bits >= most:
                raise
            bits *= 2


def rational(value: Number) -> fmpq:
    """A Fraction, or flint's own rational or integer, as flint's rational."""
    from flint import fmpq
    return fmpq(value.numerator, value.denominator) if isinstance(value, Fraction) else fmpq(value)


def sign(number: Number) -> int:
    """Sign of a ball; Unclear where it holds zero and more."""
    if number > 0:
        return 1
    if number < 0:
        return -1
    if number.is_zero():
        return 0
    raise Unclear

BITS = 320


def many_digits() -> AbstractContextManager[Digits]:
    """Context in which flint works with `BITS` bits."""
    return working(BITS)
