"""The range of a number that varies without steps: "0:1.5 N m", from one end to the other, both counted."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from ..case.table import Written
from ..case.units import dimension_of, in_dimension, split
from ..errors import InputError, printable
from ..numbers.exact import exact
from .axes import Key, key_of, si_unit

EXPECTED = 'expected from:to such as "0:0.5 N m"'


@dataclass(frozen=True)
class Span:
    """key: the number that varies; low < high: its ends in `unit`, exact; unit: as it was written, "" for the
    SI unit (or none) of the key."""

    key: Key
    low: Fraction
    high: Fraction
    unit: str = ""

    @property
    def shown_unit(self) -> str:
        """The unit of the values in words: "1" where they have none."""
        return self.unit or si_unit(self.key.paths[0]) or "1"

    @property
    def label(self) -> str:
        """The last word of the key, as sentences name it."""
        return printable(self.key.name.rpartition(".")[2])

    def written(self, value: Fraction) -> str | Written:
        """A value as a case file would give it, exactly."""
        text = f"{value.numerator}/{value.denominator}"
        return f"{text} {self.unit}" if self.unit else Written(text)


def spans_of(data: dict[str, Any], vary: Sequence[tuple[str, Any]]) -> tuple[Span, ...]:
    """The one or two ranges asked for. Raises InputError for others, and for what is given twice."""
    if not vary:
        raise InputError('nothing varies: give --vary KEY=FROM:TO, such as --vary "torque[3]=0:0.5"')
    if len(vary) > 2:
        raise InputError(
            f"expected one or two numbers that vary, got {len(vary)}: a diagram has no more; stabilab sweep "
            f"takes up to four")
    spans = tuple(span_of(key_of(data, name), asked) for name, asked in vary)
    if len(spans) == 2 and set(spans[0].key.paths) & set(spans[1].key.paths):
        raise InputError(
            f"vary {printable(spans[1].key.name)}: this number varies already, as "
            f"{printable(spans[0].key.name)}: give it once")
    return spans


def span_of(key: Key, asked: Any) -> Span:
    """The range of one number: a text, or two numbers in SI units. Raises InputError that names the key."""
    try:
        low, high, unit = _of_text(asked) if isinstance(asked, str) else (*_of_numbers(asked), "")
        if unit:
            in_dimension(unit, dimension_of(key.paths[0]), asked)
        if low >= high:
            raise InputError(f"{EXPECTED}, the lower end first, got {float(low)!r} and {float(high)!r}")
    except InputError as error:
        raise InputError(f"vary {printable(key.name)}: {error}") from None
    return Span(key, low, high, unit)


def _of_numbers(asked: Any) -> tuple[Fraction, Fraction]:
    ends = list(asked) if isinstance(asked, (tuple, list)) else []
    if len(ends) != 2:
        raise InputError(f"{EXPECTED} or two numbers, got {asked!r:.60}")
    return exact(ends[0]), exact(ends[1])


def _of_text(text: str) -> tuple[Fraction, Fraction, str]:
    parts = text.split(":")
    if len(parts) in (3, 4):
        raise InputError(
            f'{EXPECTED}, got "{printable(text)[:60]}": a diagram is exact and has no number of steps '
            f'(stabilab sweep has)')
    read = [split(part.strip()) for part in parts]
    if len(read) != 2 or read[0] is None or read[1] is None:
        raise InputError(f'{EXPECTED}, got "{printable(text)[:60]}"')
    (low, first), (high, second) = read[0], read[1]
    if first and second and first != second:
        raise InputError(
            f'expected one unit, at the end, got {printable(first)} and {printable(second)} in '
            f'"{printable(text)[:60]}"')
    return exact(low), exact(high), second or first
