"""The values that a swept number takes: "0:30:31 deg/s", "0.1:10:21:log", "1, 2, 5"."""
from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from decimal import Context, Decimal, localcontext
from fractions import Fraction
from functools import cached_property
from typing import Any

from ..case.units import NAMES, NONE, dimension_of, in_dimension, quantity, split
from ..errors import InputError, printable
from ..numbers.exact import exact
from .keys import Key

MOST = 100_000_000  # points of a sweep
DIGITS = 40  # of the decimals in which a logarithmic range is divided: the same doubles on every machine
_COUNT = re.compile(r"\s*([+-]?\d+)\s*([^\s.\d].*|)", re.DOTALL)
_LOG = re.compile(r"\s*log\b\s*(.*)", re.DOTALL)
EXPECTED = 'expected start:stop:count such as "0:30:31 deg/s", start:stop:count:log, or a list such as "1, 2, 5"'


@dataclass(frozen=True)
class Axis:
    """key: the number that varies; values: doubles in `unit`, in order; unit: as it was written, "" for the SI unit (or none) of the key."""

    key: Key
    values: tuple[float, ...]
    unit: str = ""

    def written(self, number: int) -> str:
        """A value as a case file would give it: the shortest decimal of the double, with its unit."""
        return f"{self.values[number]!r} {self.unit}".strip()

    @cached_property
    def si(self) -> tuple[float, ...]:
        """The values in SI units, as a case file that gives them would be read."""
        of = dimension_of(self.key.paths[0])
        return tuple(float(quantity(self.written(n), of)[0]) for n in range(len(self.values))) if self.unit else self.values

    @property
    def shown_unit(self) -> str:
        """The unit of the values in words: "1" where they have none."""
        return self.unit or si_unit(self.key.paths[0]) or "1"


def si_unit(path: tuple[Any, ...]) -> str:
    """The SI unit of the number at a path; "" where it has none."""
    of = dimension_of(path)
    return "" if of == NONE else NAMES.get(of, "").partition("(")[2].rstrip(")")


def axis_of(key: Key, asked: Any) -> Axis:
    """The values asked for: a text, or numbers in SI units. Raises InputError that names the key."""
    try:
        values, unit = _of_text(asked) if isinstance(asked, str) else (_of_numbers(asked), "")
        if unit:
            in_dimension(unit, dimension_of(key.paths[0]), asked)
        _judge(values)
    except InputError as error:
        raise InputError(f"vary {printable(key.name)}: {error}") from None
    return Axis(key, tuple(values), unit)


def _of_numbers(asked: Any) -> list[float]:
    try:
        numbers = list(asked) if isinstance(asked, Iterable) else None
    except TypeError:
        numbers = None
    if numbers is None:
        raise InputError(f"{EXPECTED}, got {asked!r:.60}")
    return [_double(exact(value)) for value in numbers]


def _of_text(text: str) -> tuple[list[float], str]:
    if ":" not in text:
        return _listed(text)
    parts = text.split(":")
    if len(parts) not in (3, 4):
        raise InputError(f'{EXPECTED}, got "{printable(text)[:60]}"')
    found, log = _COUNT.fullmatch(parts[2]), _LOG.fullmatch(parts[3]) if len(parts) == 4 else None
    if found is None or (len(parts) == 4 and (log is None or found[2])):
        raise InputError(f'{EXPECTED}, got "{printable(text)[:60]}"')
    (start, stop), unit = _with_one_unit([parts[0], parts[1]], (log[1] if log else found[2]).strip(), text)
    return _spread(start, stop, int(found[1]), log is not None), unit


def _listed(text: str) -> tuple[list[float], str]:
    words = [word for word in text.split(",") if word.strip()]
    values, unit = _with_one_unit(words, "", text)
    return [_double(value) for value in values], unit


def _with_one_unit(words: list[str], unit: str, text: str) -> tuple[list[Fraction], str]:
    """The numbers, and the one unit that any of them has."""
    parts = [split(word.strip()) for word in words]
    if None in parts:
        raise InputError(f'{EXPECTED}, got "{printable(text)[:60]}"')
    units = {own for _, own in parts if own} | ({unit} if unit else set())  # type: ignore[misc]  # none is None
    if len(units) > 1:
        raise InputError(f'expected one unit, at the end, got {" and ".join(sorted(map(printable, units)))} in "{printable(text)[:60]}"')
    return [exact(number) for number, _ in parts], next(iter(units), "")  # type: ignore[misc]


def _spread(start: Fraction, stop: Fraction, count: int, log: bool) -> list[float]:
    if not 0 < count <= MOST:
        raise InputError(f"expected at least one point and at most {MOST:,}, got {count}")
    if count == 1:
        if start != stop:
            raise InputError("one point cannot reach from start to stop: give the value alone, or a count of two or more")
        return [_double(start)]
    if not log:
        return [_double(start + (stop - start) * n / (count - 1)) for n in range(count)]
    if start * stop <= 0:
        raise InputError("a logarithmic range needs two ends of one sign, neither zero")
    with localcontext(Context(prec=DIGITS)):
        first, last = (Decimal(abs(v).numerator) / Decimal(abs(v).denominator) for v in (start, stop))
        step = (last / first).ln() / (count - 1)
        inner = [first * (step * n).exp() for n in range(1, count - 1)]
    sign = 1 if start > 0 else -1
    return [_double(start), *(sign * float(value) for value in inner), _double(stop)]


def _double(value: Fraction) -> float:
    return float(value) + 0.0  # minus zero is zero


def _judge(values: list[float]) -> None:
    if not values:
        raise InputError("expected at least one point, got none")
    seen: set[float] = set()
    again = next((value for value in values if value in seen or seen.add(value)), None)  # type: ignore[func-returns-value]  # add gives None
    if again is not None:
        raise InputError(f"the value {again!r} comes twice: give each once (a range of fewer points, where doubles cannot tell them apart)")
