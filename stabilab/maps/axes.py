"""The numbers of a case that a map varies, by name, and their values or ranges."""
from __future__ import annotations

import copy
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Context, Decimal, localcontext
from difflib import SequenceMatcher, get_close_matches
from fractions import Fraction
from functools import cached_property
from typing import Any, NamedTuple

from ..case.source import SWEPT
from ..case.table import Written
from ..case.uncertain import states_uncertainty
from ..errors import InputError, printable
from ..numbers.exact import exact
from ..numbers.units import NAMES, NONE, dimension_of, in_dimension, quantity, split

# --- The numbers of a case that a map varies, by name, and their values
# --- The numbers of a case file by name: "effects.constant_torque.torque[3]", "wheels.pitch.speed",
# "body.inertia[1][2]"
MANY = 12  # names in a message


class Key(NamedTuple):
    """One number of a case. name: as one writes it, components counted from 1; paths: where it stands in the
    file's data, two places for a product of inertia, which stands on both sides of a tensor's diagonal."""

    name: str
    paths: tuple[tuple[Any, ...], ...]


def keys_of(data: dict[str, Any]) -> dict[str, Key]:
    """Every number of a case's data by its name."""
    def mirrored(path: tuple[Any, ...]) -> tuple[Any, ...]:
        return (*path[:2], path[3], path[2]) if path[:2] == ("body", "inertia") and len(path) == 4 else path
    return {name: Key(name, tuple(sorted({path, mirrored(path)}))) for table in SWEPT if table in data
            for name, path in _numbers(data[table], table, (table,))}


def key_of(data: dict[str, Any], text: str) -> Key:
    """The number that is meant: its whole name, or the end of one where no other number ends so. Raises
    InputError with what is near otherwise."""
    resolved, request = keys_of(data), _tight(text)
    if text.strip() in resolved:
        return resolved[text.strip()]
    same = [name for name in resolved if _tight(name) == request]
    ending = same or [name for name in resolved if _tight(name).endswith(f".{request}")]
    if len(ending) == 1:
        return resolved[ending[0]]
    if ending:
        raise InputError(f"vary {printable(text)[:80]}: may be {_names_in_words(ending)}: write one of them")
    parts = [name for name in resolved if f".{request}[" in f".{_tight(name)}"]
    if parts:
        raise InputError(
            f"vary {printable(text)[:80]}: has several numbers: vary one of them, {_names_in_words(parts)}")
    raise InputError(f"vary {printable(text)[:80]}: this case has no such number{_near(request, resolved)}")


def _tight(text: str) -> str:
    """Without blanks, which a wheel's name may have and a key may be typed with."""
    return "".join(text.split())


def value_at(data: Mapping[str, Any], path: Iterable[Any]) -> Any:
    """What stands there."""
    for part in path:
        data = data[part]
    return data


def with_values(data: dict[str, Any], values: Iterable[tuple[Key, Any]]) -> dict[str, Any]:
    """A copy of a case's data in which other values stand for these numbers."""
    changed = copy.deepcopy(data)
    for key, value in values:
        for *tables, last in key.paths:
            value_at(changed, tables)[last] = value
            if last == "force":  # the value stands for itself, as one does for "2 +- 0.1"
                value_at(changed, tables).pop("force_tolerance", None)
    return changed


def _numbers(value: Any, name: str, path: tuple[Any, ...]) -> Iterator[tuple[str, tuple[Any, ...]]]:
    """(name, path) of every number of a table, a list or a number."""
    if isinstance(value, dict):
        for key, part in value.items():
            yield from _numbers(part, f"{name}.{key}", (*path, key))
    elif isinstance(value, list):
        tables = bool(value) and all(isinstance(part, dict) for part in value)
        for n, part in enumerate(value):
            own = part.get("name") if tables else None
            yield from _numbers(part, f"{name}.{own}" if isinstance(own, str) else f"{name}[{n + 1}]",
                                (*path, n))
    elif (isinstance(value, (int, Written)) and not isinstance(value, bool)
          or isinstance(value, str) and (states_uncertainty(value) or split(value) is not None)):
        yield name, path


def _near(request: str, resolved: dict[str, Key]) -> str:
    wholes, tails = ({part(name).lower(): name for name in resolved}
                     for part in (str, lambda name: name.rpartition(".")[2]))
    phrase = request[:80].lower()
    rows = [(SequenceMatcher(None, text, match).ratio(), names[match])
             for text, names in ((phrase, wholes), (phrase.rpartition(".")[2], tails), (phrase, tails))
             for match in get_close_matches(text, names, n=1)]
    if rows:
        return f"; did you mean {printable(max(rows, key=lambda item: item[0])[1])}?"
    return f"; it has {_names_in_words(list(resolved))}" if resolved else "; it has none that may vary"


def _names_in_words(names: list[str]) -> str:
    shown = [printable(name) for name in names[:MANY]]
    return ", ".join(shown) + (f" and {len(names) - MANY} more" if len(names) > MANY else "")


# --- The values that a swept number takes: "0:30:31 deg/s", "0.1:10:21:log", "1, 2, 5"
MAX_POINTS = 100_000_000  # points of a sweep
# of the decimals in which a logarithmic range is divided: the same doubles on every machine
RANGE_DIGITS = 40
_COUNT = re.compile(r"\s*([+-]?\d+)\s*([^\s.\d].*|)", re.DOTALL)
_LOG = re.compile(r"\s*log\b\s*(.*)", re.DOTALL)
EXPECTED = (
    'expected start:stop:count such as "0:30:31 deg/s", start:stop:count:log, or a list such as "1, 2, 5"')


class _Varied:
    """What an axis and a span share."""

    key: Key
    unit: str

    @property
    def shown_unit(self) -> str:
        """The unit of the values in words: "1" where they have none."""
        return self.unit or si_unit(self.key.paths[0]) or "1"


@dataclass(frozen=True)
class Axis(_Varied):
    """key: the number that varies; values: doubles in `unit`, in order; unit: as it was written, "" for the
    SI unit (or none) of the key."""

    key: Key
    values: tuple[float, ...]
    unit: str = ""

    def written(self, number: int) -> str | Written:
        """A value as a case file would give it: the shortest decimal of the double, with its unit."""
        text = repr(self.values[number])
        return f"{text} {self.unit}" if self.unit else Written(text)

    @cached_property
    def si(self) -> tuple[float, ...]:
        """The values in SI units, as a case file that gives them would be read."""
        of = dimension_of(self.key.paths[0])
        return (tuple(float(quantity(self.written(n), of)[0]) for n in range(len(self.values))) if self.unit
                else self.values)


def si_unit(path: tuple[Any, ...]) -> str:
    """The SI unit of the number at a path; "" where it has none."""
    of = dimension_of(path)
    return "" if of == NONE else NAMES.get(of, "").partition("(")[2].rstrip(")")


def axis_of(key: Key, request: str) -> Axis:
    """The values asked for: a text, or numbers in SI units. Raises InputError that names the key."""
    try:
        values, unit = _of_text(request) if isinstance(request, str) else (_of_numbers(request), "")
        if unit:
            in_dimension(unit, dimension_of(key.paths[0]), request)
        _judge(values)
    except InputError as error:
        raise InputError(f"vary {printable(key.name)}: {error}") from None
    return Axis(key, tuple(values), unit)


def _of_numbers(request: str) -> list[float]:
    try:
        return [_double(exact(value)) for value in request]
    except TypeError:
        raise InputError(f"{EXPECTED}, got {request!r:.60}") from None


def _of_text(text: str) -> tuple[list[float], str]:
    if ":" not in text:
        return _listed(text)
    parts = text.split(":")
    if len(parts) not in (3, 4):
        raise InputError(f'{EXPECTED}, got "{printable(text)[:60]}"')
    result, log = _COUNT.fullmatch(parts[2]), _LOG.fullmatch(parts[3]) if len(parts) == 4 else None
    if result is None or (len(parts) == 4 and (log is None or result[2])):
        raise InputError(f'{EXPECTED}, got "{printable(text)[:60]}"')
    (start, stop), unit = _with_one_unit([parts[0], parts[1]], (log[1] if log else result[2]).strip(), text)
    return _spread(start, stop, int(result[1]), log is not None), unit


def _listed(text: str) -> tuple[list[float], str]:
    phrases = [word for word in text.split(",") if word.strip()]
    values, unit = _with_one_unit(phrases, "", text)
    return [_double(value) for value in values], unit


def _with_one_unit(phrase: list[str], unit: str, text: str,
                   expected: str = EXPECTED) -> tuple[list[Fraction], str]:
    """The numbers, and the one unit that any of them has."""
    parts = [split(word.strip()) for word in phrase]
    if None in parts:
        raise InputError(f'{expected}, got "{printable(text)[:60]}"')
    # none is None
    units = dict.fromkeys(own for own in (*(own for _, own in parts), unit) if own)  # type: ignore[misc]
    if len(units) > 1:
        raise InputError(f'expected one unit, at the end, got {" and ".join(map(printable, units))} in '
                         f'"{printable(text)[:60]}"')
    return [exact(number) for number, _ in parts], next(iter(units), "")  # type: ignore[misc]


def _spread(start: Fraction, stop: Fraction, count: int, log: bool) -> list[float]:
    if not 0 < count <= MAX_POINTS:
        raise InputError(f"expected at least one point and at most {MAX_POINTS:,}, got {count}")
    if count == 1:
        if start != stop:
            raise InputError(
                "one point cannot reach from start to stop: give the value alone, or a count of two or more")
        return [_double(start)]
    if not log:
        return [_double(start + (stop - start) * n / (count - 1)) for n in range(count)]
    if start * stop <= 0:
        raise InputError("a logarithmic range needs two ends of one sign, neither zero")
    with localcontext(Context(prec=RANGE_DIGITS)):
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
    visited: set[float] = set()
    # add gives None
    again = next((value for value in values
                  if value in visited or visited.add(value)), None)  # type: ignore[func-returns-value]
    if again is not None:
        raise InputError(f"the value {again!r} comes twice: give each once (a range of fewer points, where "
                         "doubles cannot tell them apart)")


# --- The range of a number that varies without steps: "0:1.5 N m", from one end to the other, both counted
EXPECTED_RANGE = 'expected from:to such as "0:0.5 N m"'


@dataclass(frozen=True)
class Span(_Varied):
    """key: the number that varies; low < high: its ends in `unit`, exact; unit: as it was written, "" for the
    SI unit (or none) of the key."""

    key: Key
    low: Fraction
    high: Fraction
    unit: str = ""

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
        raise InputError(f"expected one or two numbers that vary, got {len(vary)}: a diagram has no more; "
                         "stabilab sweep takes up to four")
    spans = tuple(span_of(key_of(data, name), request) for name, request in vary)
    each_once(span.key for span in spans)
    return spans


def each_once(keys: Iterable[Key]) -> None:
    """InputError where a number varies twice."""
    taken: dict[Any, str] = {}
    for key in keys:
        if again := next((path for path in key.paths if path in taken), None):
            raise InputError(f"vary {printable(key.name)}: this number varies already, as "
                             f"{printable(taken[again])}: give it once")
        taken |= dict.fromkeys(key.paths, key.name)


def span_of(key: Key, request: str) -> Span:
    """The range of one number: a text, or two numbers in SI units. Raises InputError that names the key."""
    try:
        low, high, unit = _range_of(request)
        if unit:
            in_dimension(unit, dimension_of(key.paths[0]), request)
        if low >= high:
            raise InputError(f"{EXPECTED_RANGE}, the lower end first, got {float(low)!r} and {float(high)!r}")
    except InputError as error:
        raise InputError(f"vary {printable(key.name)}: {error}") from None
    return Span(key, low, high, unit)


def _range_of(request: Any) -> tuple[Fraction, Fraction, str]:
    if not isinstance(request, str):
        if not isinstance(request, (tuple, list)) or len(request) != 2:
            raise InputError(f"{EXPECTED_RANGE} or two numbers, got {request!r:.60}")
        return exact(request[0]), exact(request[1]), ""
    text, parts = request, request.split(":")
    if len(parts) in (3, 4):
        raise InputError(f'{EXPECTED_RANGE}, got "{printable(text)[:60]}": a diagram is exact and has no '
                         'number of steps (stabilab sweep has)')
    if len(parts) != 2:
        raise InputError(f'{EXPECTED_RANGE}, got "{printable(text)[:60]}"')
    (low, high), unit = _with_one_unit(parts, "", text, EXPECTED_RANGE)
    return low, high, unit
