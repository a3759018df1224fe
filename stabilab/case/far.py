"""What is said where a question of a case leaves the range of doubles: which of its numbers is to blame.

Most questions are answered in a motion's own unit, or in exact numbers, however large its numbers are. Where
one is not, its arithmetic ends in an error, which is one of the case if the case has a number so far from 1
that powers of it are no doubles, and a fault of the program otherwise."""
from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction
from typing import Any

from ..errors import InputError

HUGE = Fraction(10) ** 30  # products of some ten such numbers and their inverses are doubles


@contextmanager
def in_doubles(case: Any, location: str = "") -> Iterator[None]:
    """Context of an answer to a question of a case: InputError that names the number by which it leaves the
    range of doubles. location: what stands before the message."""
    try:
        yield
    except ArithmeticError:
        worst = farthest(case)
        if worst is None:
            raise
        key, value = worst
        raise InputError(f"{location}{key} = {value}: this question takes powers of its numbers, which leave "
                         "the range of doubles (2e-308 to 1.8e308); expected 0, or a size between "
                         f"{float(1 / HUGE):.0e} and {float(HUGE):.0e}: check its exponent and unit, or "
                         "choose other units") from None


def farthest(case: Any) -> tuple[str, str] | None:
    """(key, value) of the number of a case that is farthest from 1, in SI units; None where all are of a size
    that can be computed with."""
    rows = [(abs(_log(value)), key, value) for key, value in _numbers(case) if value]
    size, key, value = max(rows, default=(0.0, "", Fraction(1)))
    return (key, f"{_decimal(value)}") if size > _log(HUGE) else None


def _numbers(case: Any) -> Iterator[tuple[str, Fraction]]:
    scene = case.scene
    if scene.variables == "scaled":
        yield from (("[scaled] a, b", Fraction(v)) for v in scene.exact_ab)
        yield from (("[scaled] mu", Fraction(v)) for v in scene.exact_mu)
    else:
        yield from (("[body] inertia", Fraction(v)) for v in scene.body.exact)
        for effect in scene.effects:
            yield from ((f"[effects.{effect.name}] {name}", Fraction(value))
                        for name, value in effect.parameters().items())
    key = "[motion] x" if scene.variables == "scaled" else "[motion] angular_velocity"
    yield from ((key, Fraction(v)) for v in case.exact_state or case.state or ())
    for name, row in case.blocks.items():
        yield from ((f"[motion] {name}", Fraction(v)) for v in row)
    yield from (("[motion] span", Fraction(v)) for v in case.span or () if math.isfinite(v))


def _log(value: Fraction) -> float:
    """The decimal logarithm of its size, whatever that is."""
    return math.log10(abs(value.numerator)) - math.log10(value.denominator)


def _decimal(value: Fraction) -> str:
    power = math.floor(_log(value))
    return f"{float(value / Fraction(10) ** power):.4g}e{power:+03d}"
