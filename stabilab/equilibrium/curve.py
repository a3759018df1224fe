"""A curve of equilibria in exact form: rational in its parameter, cut where stability changes."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import field
from fractions import Fraction
from typing import NamedTuple

from ..errors import InputError
from ..numbers.polynomial import Poly
from ..numbers.vectors import Exact3, Float3
from ..record import record

T = Poly((0, 1))
ONE_POLY = Poly((1,))
Verdict = tuple[str, str]  # (word, because)


class Grounds(NamedTuple):
    """Why a curve's points are what they are: verdicts for m > 0 and for a zero of m by the signs of m beside it."""

    positive: Verdict
    odd: Verdict        # m changes sign
    minimum: Verdict    # m > 0 on both sides
    maximum: Verdict    # m < 0 on both sides


@record
class RationalCurve:
    """x_i(t) = numerators[i](t)/denominator(t). crossings: parameter where another curve meets this one -> verdict.
    poles: zeros of the denominator, rising, all rational. scale: a parameter size at which something happens."""

    name: str
    equation: str
    parametrisation: str
    numerators: tuple[Poly, ...]
    grounds: Grounds
    denominator: Poly = ONE_POLY
    poles: tuple[Fraction, ...] = ()
    crossings: dict[Fraction, Verdict] = field(default_factory=dict)
    scale: Fraction = Fraction(1)

    def exact_point(self, t: Fraction) -> Exact3:
        """The equilibrium at a rational t that is not a pole."""
        bottom = self.denominator(t)
        return tuple(n(t) / bottom for n in self.numerators)

    def float_point(self) -> Callable[[float], Float3]:
        """point(t) for a float t, each coordinate rounded once; InputError at a pole or a t that is not finite."""
        return self._rounded_point  # a method of its own, unlike a function made here, can be sent to another process

    def _rounded_point(self, t: float) -> Float3:
        try:
            return tuple(float(v) for v in self.exact_point(Fraction(t)))
        except (ZeroDivisionError, OverflowError, ValueError):
            raise InputError(f"t = {t!r} lies at an end of the curve ({self.name}): no equilibrium there") from None


def straight_line(start: Sequence[Fraction], direction: Sequence[Fraction]) -> tuple[Poly, ...]:
    """start + t direction as polynomials."""
    return tuple(Poly((s, d)) for s, d in zip(start, direction))


def size_of(*vectors: Sequence[Fraction]) -> Fraction:
    """The largest entry in size, 1 where all vanish: a scale for the parameter of a line."""
    return max((abs(v) for vector in vectors for v in vector), default=Fraction(0)) or Fraction(1)


def values_inside(lo: Fraction | None, hi: Fraction | None, scale: Fraction) -> Fraction:
    if lo is None:
        return Fraction(0) if hi is None else hi - (abs(hi) or scale)
    return lo + (abs(lo) or scale) if hi is None else (lo + hi) / 2


def sample_parameters(lo: Fraction | None, hi: Fraction | None, scale: Fraction) -> list[Fraction]:
    """Doubles (as fractions) inside the open interval, spread over it and log-spaced towards its infinite ends."""
    if lo is None:
        if hi is not None:
            return [-t for t in reversed(sample_parameters(-hi, None, scale))]
        raw = [f * scale for f in (-100, -1, 0, 1, 100)]
    elif hi is None:
        raw = [lo + (abs(lo) or scale) * f for f in (Fraction(1, 100), 1, 100, 10000)]
    elif lo == 0 or 0 < lo and hi > 100 * lo:
        ratio = float(hi / lo) if lo else 1e4
        raw = [hi / Fraction(ratio ** f) for f in (0.95, 0.7, 0.4, 0.1, 0.01)]
    elif hi == 0 or hi < 0 and lo < 100 * hi:
        return [-t for t in reversed(sample_parameters(-hi, -lo, scale))]
    else:
        raw = [lo + (hi - lo) * f for f in (Fraction(1, 1000), Fraction(1, 10), Fraction(1, 2), Fraction(9, 10), Fraction(999, 1000))]
    rounded = []
    for t in raw:
        try:
            rounded.append(Fraction(float(t)))
        except OverflowError:
            continue
    return [t for t in dict.fromkeys(rounded) if (lo is None or t > lo) and (hi is None or t < hi)]
