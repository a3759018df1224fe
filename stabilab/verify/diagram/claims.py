"""What a certificate of a diagram says, read, and what it is about: a scene whose numbers are polynomials in
one that varies."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from flint import fmpq_poly

from ..numbers import (
    MAX_ENTRIES,
    Malformed,
    bracket,
    brief,
    entries,
    field,
    number,
    numbers,
    q,
    quoted,
    shown,
    whole,
    word,
)

SCHEMA = "stabilab.diagram-certificate/1"
COUNTED = ("isolated", "motion", "borders")
# of the law by which a number of the scene depends on the one that varies; letters of a coefficient
DEGREE, LONGEST = 3, 400
PLACES = {"physical": (("inertia", 3), ("momentum", 3), ("torque", 3)),
          "scaled": (("a", 1), ("b", 1), ("mu", 3))}
KEYS = {"schema": None, "program": None, "uncertified": None, "number": None, "counted": None, "axis": None,
        "start": None, "range": None,
        "pieces": [dict.fromkeys(("equilibria", "stable"))], "events": [dict.fromkeys(("t", "equilibria"))]}


@dataclass(frozen=True)
class Event:
    """low <= value <= high: where something changes; count: equilibria at the value itself, None for endless
    ones."""

    low: Fraction
    high: Fraction
    count: int | None

    @property
    def claim(self) -> str:
        printed = ("endless equilibria" if self.count is None
                else f"{self.count} equilibri{'um' if self.count == 1 else 'a'}")
        return f"event near {brief((self.low + self.high) / 2)}: {printed} there"


@dataclass(frozen=True)
class Piece:
    """count, stable: equilibria for every value of a piece and how many of them are stable; None: endless,
    and not told."""

    count: int | None
    stable: int | None


@dataclass(frozen=True)
class Claims:
    """scene: name -> polynomials in t; start: the state's, or None; axis: of the torque, 0 where all
    equilibria are counted."""

    variables: str
    scene: dict[str, list[Any]]
    counted: str
    axis: int
    start: list[Any] | None
    low: Fraction
    high: Fraction
    pieces: tuple[Piece, ...]
    events: tuple[Event, ...]


def claims_of(table: Mapping[str, Any]) -> Claims:
    """The claims of a certificate. Raises `Malformed` where it is none."""
    scene = field(table, "scene", "", dict)
    variables = word(scene, "variables", "scene", tuple(PLACES))
    read = {name: _polynomials(field(scene, name, "scene"), f"scene.{name}", count)
            for name, count in PLACES[variables]}
    counted, axis = word(table, "counted", "", COUNTED), whole(field(table, "axis", ""), "axis", range(4))
    if (counted == "isolated") != (axis == 0):
        raise Malformed("axis: expected 0 where all equilibria are counted, else that of the torque")
    start = _polynomials(table["start"], "start", 3) if table.get("start") is not None else None
    if (counted == "motion") != (start is not None):
        raise Malformed("start: expected the state of a motion whose curve is counted on, and none else")
    low, high = bracket(field(table, "range", ""), "range")
    events = tuple(_event(e, f"events[{i}]") for i, e in enumerate(entries(table, "events", "")))
    pieces = tuple(_piece(p, f"pieces[{i}]", counted) for i, p in enumerate(entries(table, "pieces", "")))
    _in_order(events, pieces, low, high)
    return Claims(variables, read, counted, axis, start, low, high, pieces, events)


def _polynomials(value: Sequence[list[str]] | str | dict[str, Any], where: str, count: int) -> list[Any]:
    if not isinstance(value, list) or len(value) != count:
        raise Malformed(
            f"{where}: expected {count} list{'s' if count > 1 else ''} of coefficients, got {shown(value)}")
    rows = [numbers(row, f"{where}[{i}]") for i, row in enumerate(value)]
    if any(len(row) > DEGREE + 1 or not row for row in rows):
        raise Malformed(f"{where}: expected 1 to {DEGREE + 1} coefficients")
    if any(len(c) > LONGEST for row in value for c in row):
        raise Malformed(f"{where}: expected coefficients of at most {LONGEST} letters")
    return [fmpq_poly([q(c) for c in row]) for row in rows]


def _count(table: Mapping[str, Any], key: str, where: str) -> int | None:
    value = field(table, key, where)
    return None if value is None else whole(value, f"{where}.{key}", range(MAX_ENTRIES + 1))


def _event(table: Mapping[str, Any], where: str) -> Event:
    low, high = bracket(field(table, "t", where), f"{where}.t")
    return Event(low, high, _count(table, "equilibria", where))


def _piece(table: Mapping[str, int], where: str, counted: str) -> Piece:
    count, stable = _count(table, "equilibria", where), _count(table, "stable", where)
    if (stable is None) != (counted == "borders" or count is None):
        raise Malformed(f"{where}.stable: expected how many of the equilibria are stable, and none where "
                        "these are endless or changes of stability")
    return Piece(count, stable)


def _in_order(events: Sequence[Event], pieces: Sequence[Piece], low: Fraction, high: Fraction) -> None:
    if low >= high:
        raise Malformed("range: expected its lower end first")
    if any(event.high >= two.low
           for event, two in zip(events, events[1:])) or any(e.low < low or e.high > high for e in events):
        raise Malformed("events: expected them rising, apart from one another and inside the range")
    ends = sum(e.low == e.high == end for e in events for end in (low, high))
    if len(pieces) != len(events) + 1 - ends:
        raise Malformed(f"pieces: expected {len(events) + 1 - ends}, before, between and after the events, "
                        f"got {len(pieces)}")


def is_one(certificate: dict) -> bool:
    """Whether a certificate is of a diagram."""
    return certificate.get("schema") == SCHEMA


def about(certificate: dict) -> dict[str, Any]:
    """Its range, scene and start, as they stand in it, and the name that it gives to what varies, its own
    word; for one that `verify` has read without complaint."""
    scene = certificate["scene"]
    rows = {key: scene[key] for key, _ in PLACES[scene["variables"]]}
    name = certificate.get("number")
    return {**({"named_in_the_file": name} if isinstance(name, str) else {}), "range": certificate["range"],
            "variables": scene["variables"], **rows,
            **({"state": certificate["start"]} if certificate.get("start") else {})}


def line(printed: dict) -> str:
    """The line that `stabilab verify` prints first."""
    low, high = (brief(number(end, "range")) for end in printed["range"])
    keys = [key for key, _ in PLACES[printed["variables"]]] + (["state"] if "state" in printed else [])
    varying = [key for key in keys if any(len(row) > 1 for row in printed[key])]
    return (f"about: {', '.join(varying) or 'nothing'} as {_varying(printed)} goes from {low} to "
            f"{high}; {_fixed(printed, keys)}")


def _varying(printed: dict) -> str:
    """What varies: a number of which the scene alone says what it is."""
    name = printed.get("named_in_the_file")
    return "a number t" + (f" ({quoted(name)})" if name is not None else "")


def _fixed(printed: dict, keys: list[str]) -> str:
    parts = [f"{key} {' '.join(row[0] if len(row) == 1 else '*' for row in printed[key])}" for key in keys]
    return f"{', '.join(parts):.200}" + (" (* varies)" if any("*" in part for part in parts) else "")


def differences(text: dict, case: dict) -> list[str]:
    """What a certificate is about that a case is not: no value of the number, inside the range or not, makes
    the scene the case's."""
    if text["variables"] != case.get("variables"):
        return [
            f"variables: the certificate's {text['variables']}, the case's {case.get('variables') or 'none'}"]
    out, common = [], None
    for key in [key for key, _ in PLACES[text["variables"]]] + (["state"] if "state" in text else []):
        values = case.get(key) if isinstance(case.get(key), (list, tuple)) else [case.get(key)]
        for n, (row, value) in enumerate(zip(text[key], values), 1):
            apart = _apart(row, value)
            if apart is None or apart.degree() == 0:
                out.append(f"{key}[{n}]: the certificate's {' '.join(row):.80}, the case's "
                           f"{value if value is not None else 'none'}")
            elif apart != 0:
                common = apart if common is None else common.gcd(apart)
    if not out and common is not None and not any(factor.degree() == 1 for factor, _ in common.factor()[1]):
        out.append(f"{_varying(text)}: no value of it gives all the case's numbers")
    return out


def _apart(row: list[str], value: str | None) -> Any:
    """The polynomial less the case's number; None where the case has none."""
    if value is None:
        return None
    return fmpq_poly([q(number(c, "about")) for c in row]) - fmpq_poly([q(number(value, "about"))])
