"""Numbers of a case as a person reads them: six digits at most, with their unit; plain numbers where the variables are scaled."""
from __future__ import annotations

import math
import re
from dataclasses import dataclass

from ...terminal.letters import ALPHABET, INDICES, greek
from ...units import Units

DIGITS = 5
SIGNS = ((r"\^2(?!\d)", "²"), (r"\^3(?!\d)", "³"), (r"\^4(?!\d)", "⁴"), (r"\bsqrt(?=\()", "√"), (r"<=", "≤"), (r">=", "≥"), (r"(?<=\s)x(?=\s[\w(]+\s=)", "×"),
         (r"(?<![\w)])-inf\b", "−∞"), (r"\binf\b", "∞"), (r"(?<![\w)\]-])-(?=[\d.])|(?<=[ (])-(?=[\w(])", "−"), (r"(?<=[\w)²³]) - (?=[\w(])", " − "),
         (r"(?<=[\w)]) \. (?=[\w(])", " · "), (r"\b(?<=[MHωλγ])\.(?=[(MHDωλγ])", "·"), (r"\+-", "±"), (r"-\+", "∓"), (r"\^T\b", "ᵀ"))


@dataclass(frozen=True)
class Measures:
    """The units in which a page tells rates and times of a case: those that the case asks for, none where the variables are scaled."""

    units: Units

    @property
    def physical(self) -> bool:
        """Whether numbers have a dimension."""
        return not self.units.scaled

    @property
    def rate_unit(self) -> tuple[str, float]:
        """(name, how many of it make one in the case's own variables)."""
        return self.units.rates

    def time_unit(self, longest: float) -> tuple[str, float]:
        """(name, how many of it make one) for times up to the longest."""
        return self.units.times(longest) if self.physical else ("τ", 1.0)

    def reason(self, words: str) -> str:
        """What the analysis says, in the letters of a page and with rates and times in its units."""
        return spoken(self.units.words(words))

    def rate(self, value) -> str:
        """A rate with its unit."""
        unit, one = self.rate_unit
        return told(value * one, unit)

    def time(self, value) -> str:
        """A time with its unit."""
        unit, one = self.time_unit(value)
        return told(value * one, "of τ" if unit == "τ" else unit)

    def moment(self, value) -> str:
        """A point in time with its unit."""
        return self.time(value) if self.physical else f"τ = {told(value)}"

    def energy(self, value) -> str:
        """An energy with its unit."""
        return told(value, "J" if self.physical else "")


def told(value, unit: str = "", digits: int = DIGITS) -> str:
    """A number and its unit."""
    if value is None:
        return "unknown"
    if math.isinf(value):
        return "no end" if value > 0 else "no end downwards"
    number = re.sub(r"e([+-])0*", lambda sign: "e" + sign[1].strip("+"), f"{float(value) + 0.0:.{digits}g}")
    return f"{number} {unit}".rstrip().replace("-", "−")


def vector(values, digits: int = DIGITS) -> str:
    """Numbers in parentheses."""
    return f"({', '.join(told(v, digits=digits) for v in values)})"


def spoken(name: str) -> str:
    """Words with Greek letters in place of their names (ω1, λ3, γ2), with the signs that a book sets (², √, ≤, −), with no number of more than
    six digits, and with spans as one says them. What stands between backquotes is a command and stays as it is."""
    parts = re.split(r"(`[^`]*`)", name)
    return "".join(part if part.startswith("`") else _spoken(part) for part in parts)


def _spoken(name):
    name = re.sub(r"\b(s|tau) in \[([^],]+), ([^]]+)\]", lambda span: f"{span[2]} to {span[3]} {'s' if span[1] == 's' else 'of τ'}", name)
    for plain, letter in ALPHABET.items():
        name = re.sub(rf"(?<![\w-]){plain}(?=\d|_[ijk]\b|\b(?!-))", letter, name)
    name = re.sub(r"(?<=\w)_([ijk])\b", lambda index: INDICES[index[1]], name)
    name = re.sub(r"\b(kg m|rad/s|m/s|s)\^2\b", r"\1²", name)
    name = re.sub(r"(?<![\w.])\d+\.\d{6,}(?:e[+-]?\d+)?", lambda number: f"{float(number[0]):.6g}", name)
    for plain, sign in SIGNS:
        name = re.sub(plain, sign, name)
    return greek(name)
