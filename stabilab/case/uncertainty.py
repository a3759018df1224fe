"""Uncertain numbers as a case file writes them: "2000 +- 20"."""
from __future__ import annotations
from fractions import Fraction
import re
from ..errors import InputError
from ..numbers.exact import exact

_PLUS_MINUS = re.compile(r"([^±]*?)(?:\+-|±)([^±%]*)(%?)\s*")


def states_uncertainty(text: str) -> bool:
    """Whether a text is meant as a number with an uncertainty, well formed or not."""
    return "±" in text or "+-" in text


def plus_minus(text: str) -> tuple[Fraction, Fraction]:
    """(middle, half-width), exact, of "2000 +- 20" or "1500 ± 1 %" (per cent of the middle). Raises InputError."""
    parts = _PLUS_MINUS.fullmatch(text) if len(text) <= 400 else None
    if parts is None:
        raise InputError(f'expected a number and its uncertainty such as "2000 +- 20" or "1500 +- 1 %", got "{text[:60]}"')
    try:
        middle, half = exact(parts[1]), exact(parts[2])
    except InputError as error:
        raise InputError(f'expected a number and its uncertainty such as "2000 +- 20" or "1500 +- 1 %": {error}') from None
    if half < 0:
        raise InputError(f'the uncertainty is a half-width and not negative, got "{text[:60]}"')
    if not parts[3]:
        return middle, half
    if not middle and half:
        raise InputError("a percentage of zero is zero: give the uncertainty as a number")
    return middle, abs(middle) * half / 100
