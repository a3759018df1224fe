"""Uncertain numbers as a case file writes them: "2000 +- 20", "12.0 +- 3 %", "12 +- 0.5 N"."""
from __future__ import annotations

import re
from fractions import Fraction

from ..errors import InputError
from ..numbers.exact import exact
from .units import NONE, Dimension, in_dimension, quantity, split

_PLUS_MINUS = re.compile(r"([^±%]*?)(?:\+-|±)([^±%]*)(%?)([^±%]*)")
_BRACKETS = re.compile(r"\s*\(([^()]*)\)\s*([^()]*)")


def states_uncertainty(text: str) -> bool:
    """Whether a text is meant as a number with an uncertainty, well formed or not."""
    return "±" in text or "+-" in text


def plus_minus(text: str, wanted: Dimension = NONE) -> tuple[Fraction, Fraction, bool]:
    """(middle, half-width, whether both are exact) in SI units, of "2000 +- 20", "1500 ± 1 %" (per cent of the middle) or
    "12 +- 0.5 N". A unit at the end is that of both. Raises InputError."""
    if len(text) > 400 or text.count("±") + text.count("+-") != 1:
        raise InputError(f'{_example(wanted)}, got "{text[:60]}"')
    bracketed = _BRACKETS.fullmatch(text)
    parts = _PLUS_MINUS.fullmatch(" ".join(bracketed.groups()) if bracketed else text)
    if parts is None or (parts[4].strip() and not parts[3]):
        raise InputError(f'{_example(wanted)}, got "{text[:60]}"')
    left, right = split(parts[1]) or (parts[1], ""), split(parts[2]) or (parts[2], "")
    after = parts[4].strip() if parts[3] else right[1]
    if parts[3] and right[1]:
        raise InputError(f'{_example(wanted)}, got "{text[:60]}"')
    if left[1] and not after and not parts[3]:
        raise InputError(f'the uncertainty has no unit in "{text[:60]}"; write "{left[0]} +- {right[0]} {left[1]}"')
    try:
        middle, sharp = quantity(f"{left[0]} {left[1] or after}", wanted)
        half, sharp_half = (exact(right[0]), True) if parts[3] else quantity(f"{right[0]} {after}", wanted)
    except InputError as error:
        raise InputError(str(error) if left[1] or after else f"{_example(wanted)}: {error}") from None
    if after and left[1]:
        in_dimension(after, wanted, text)
    if half < 0:
        raise InputError(f'the uncertainty is a half-width and not negative, got "{text[:60]}"')
    if not parts[3]:
        return middle, half, sharp and sharp_half
    if not middle and half:
        raise InputError("a percentage of zero is zero: give the uncertainty as a number")
    return middle, abs(middle) * half / 100, sharp


def _example(wanted) -> str:
    units = "" if wanted == NONE else ' or "12 +- 0.5" with a unit at the end'
    return f'expected a number and its uncertainty such as "2000 +- 20" or "1500 +- 1 %"{units}'
