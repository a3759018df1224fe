"""Uncertain numbers as a case file states them.

A number has a tolerance ("2000 +- 20", "12.0 +- 3 %", "12 +- 0.5 N"), which says nothing of how often each
value occurs; or it is uniform ("12 +- 0.5 N, uniform", "11.5 to 12.5 N, uniform"); or normal ("2 N, sigma 5
%", "2 N, 3 sigma 0.3 N"). A normal number has no bounds: the box over which something is proved reaches to
`SIGMAS` standard deviations, and samples are drawn from the distribution itself."""
from __future__ import annotations

import re
from fractions import Fraction
from typing import NamedTuple

from ..errors import InputError, printable
from ..numbers.exact import exact
from ..numbers.miswritten import typed
from ..numbers.units import NONE, Dimension, in_dimension, quantity, split

SIGMAS = 3  # standard deviations to which the box of a normal number reaches
BEYOND = 0.0026997960632602  # of the draws of a normal number lie outside: 2 Phi(-3), rounded up
TOLERANCE, UNIFORM, NORMAL = "tolerance", "uniform", "normal"
_PLUS_MINUS = re.compile(r"([^±%]*?)(?:\+-|±)([^±%]*)(%?)([^±%]*)")
_BRACKETS = re.compile(r"\s*\(([^()]*)\)\s*([^()]*)")
_UNIFORM = re.compile(r"(.*?)[\s,;]+uniform(?:ly)?\s*", re.IGNORECASE)
_ENDS = re.compile(r"(.*?)\s+to\s+(.*)", re.IGNORECASE)
_SIGMA = re.compile(r"([^,;]*?)(?:[,;]\s*(?:(\d+(?:\.\d+)?)[\s-]*)?|\s+)(?:sigma|σ)\s*[=:]?\s*(.*)",
                    re.IGNORECASE)
_NUMBER_FIRST = re.compile(r"\s*[(+-]?\s*[\d.].*(?:sigma|σ|\buniform)", re.IGNORECASE | re.DOTALL)


class Uncertain(NamedTuple):
    """A number known within bounds, or by its distribution: its path in the file (with the list index), the
    middle and the half-width of its box, exact; name: of the key in words, where the path has an index before
    its end. law: "tolerance", "uniform" or "normal"; sigma: standard deviation of a normal number, else None.
    """

    path: tuple
    middle: Fraction
    half: Fraction
    name: str = ""
    law: str = TOLERANCE
    sigma: Fraction | None = None

    @property
    def key(self) -> str:
        """The key of the case file, with the place in its list counted from one."""
        *path, last = self.path
        if self.name:
            return printable(self.name)
        return ".".join(path) + f"[{last + 1}]" if isinstance(last, int) else ".".join(self.path)


class Correlation(NamedTuple):
    """value: correlation of two uncertain numbers, by their keys."""

    first: str
    second: str
    value: Fraction


class Stated(NamedTuple):
    """An uncertain number as it is written, in SI units: middle, half-width, whether both are exact; law,
    sigma: as of `Uncertain`."""

    middle: Fraction
    half: Fraction
    sharp: bool
    law: str = TOLERANCE
    sigma: Fraction | None = None


def states_uncertainty(text: str) -> bool:
    """Whether a text is meant as a number with an uncertainty, well formed or not."""
    return "±" in text or "+-" in text or "+/-" in text or bool(_NUMBER_FIRST.match(text[:400]))


def uncertain_number(text: str, wanted: Dimension = NONE) -> Stated:
    """What a text states of an uncertain number. Raises InputError."""
    if result := _SIGMA.fullmatch(text.strip()):
        return _normal(text, result, wanted)
    result = _UNIFORM.fullmatch(text)
    if result is None:
        return Stated(*plus_minus(text, wanted))
    ends = _ENDS.fullmatch(result[1])
    if ends is None:
        return Stated(*plus_minus(result[1], wanted), UNIFORM)
    return _between(text, ends[1], ends[2], wanted)


def _between(text: str, first: str, last: str, wanted: Dimension) -> Stated:
    """Of "11.5 to 12.5 N, uniform"."""
    parts = split(first)
    unit = (split(last) or ("", ""))[1]
    low, sharp = quantity(f"{first} {unit}" if parts and not parts[1] else first, wanted)
    high, sharp_too = quantity(last, wanted)
    if not low < high:
        raise InputError(f'expected the lower end first, as in "11.5 to 12.5, uniform", got "{text[:60]}"')
    return Stated((low + high) / 2, (high - low) / 2, sharp and sharp_too, UNIFORM)


def _normal(text: str, result: re.Match[str], wanted: Dimension) -> Stated:
    """Of "2 N, sigma 5 %": the deviation in per cent of the mean, or with its unit."""
    mean, count, size = result[1], Fraction(result[2] or 1), result[3]
    if states_uncertainty(mean) or not split(mean) or not size.strip() or not count:
        raise InputError('expected a mean and its standard deviation such as "2 N, sigma 5 %" or "2 N, sigma '
                         f'0.1 N", got "{text[:60]}"')
    joined = f"{mean} +- {size}"
    try:
        middle, deviation, sharp = plus_minus(joined, wanted)
    except InputError as error:  # with what the file says
        raise InputError(str(error).replace(joined[:60], text[:60])) from None
    if not deviation:
        raise InputError(f'sigma is above zero; of a number that is certain write "{mean.strip()[:40]}"')
    sigma = deviation / count
    return Stated(middle, SIGMAS * sigma, sharp, NORMAL, sigma)


def plus_minus(text: str, wanted: Dimension = NONE) -> tuple[Fraction, Fraction, bool]:
    """(middle, half-width, whether both are exact) in SI units, of "2000 +- 20", "1500 ± 1 %" (per cent of
    the middle) or "12 +- 0.5 N". A unit at the end is that of both. Raises InputError."""
    text = typed(text).replace("+/-", "+-")
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
        raise InputError(
            f'the uncertainty has no unit in "{text[:60]}"; write "{left[0]} +- {right[0]} {left[1]}"')
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


def _example(wanted: Dimension) -> str:
    units = "" if wanted == NONE else ' or "12 +- 0.5" with a unit at the end'
    return (f'expected a number and its uncertainty such as "2000 +- 20", "1500 +- 1 %"{units}; of a normal '
            'number "2000, sigma 20"')
