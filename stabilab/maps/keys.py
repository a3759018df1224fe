"""The numbers of a case file by name: "effects.constant_torque.torque[3]", "wheels.pitch.speed", "body.inertia[1][2]"."""
from __future__ import annotations

from collections.abc import Iterator
from difflib import SequenceMatcher, get_close_matches
from typing import Any, NamedTuple

from ..case.sweep import SWEPT
from ..case.table import Written
from ..case.uncertainty import states_uncertainty
from ..case.units import split
from ..errors import InputError, printable

MANY = 12  # names in a message


class Key(NamedTuple):
    """One number of a case. name: as one writes it, components counted from 1; paths: where it stands in the file's data, two places for a product of
    inertia, which stands on both sides of a tensor's diagonal."""

    name: str
    paths: tuple[tuple[Any, ...], ...]


def keys_of(data: dict[str, Any]) -> dict[str, Key]:
    """Every number of a case's data by its name."""
    return {name: Key(name, _both_sides(data, path)) for table in SWEPT if table in data for name, path in _numbers(data[table], table, (table,))}


def key_of(data: dict[str, Any], text: str) -> Key:
    """The number that is meant: its whole name, or the end of one where no other number ends so. Raises InputError with what is near otherwise."""
    known, asked = keys_of(data), _tight(text)
    if text.strip() in known:
        return known[text.strip()]
    same = [name for name in known if _tight(name) == asked]
    ending = same or [name for name in known if _tight(name).endswith(f".{asked}")]
    if len(ending) == 1:
        return known[ending[0]]
    if ending:
        raise InputError(f"vary {printable(text)[:80]}: may be {_listed(ending)}: write one of them")
    parts = [name for name in known if f".{asked}[" in f".{_tight(name)}"]
    if parts:
        raise InputError(f"vary {printable(text)[:80]}: has several numbers: vary one of them, {_listed(parts)}")
    raise InputError(f"vary {printable(text)[:80]}: this case has no such number{_near(asked, known)}")


def _tight(text: str) -> str:
    """Without blanks, which a wheel's name may have and a key may be typed with."""
    return "".join(text.split())


def value_at(data: Any, path: tuple[Any, ...]) -> Any:
    """What stands there."""
    for part in path:
        data = data[part]
    return data


def put(data: Any, path: tuple[Any, ...], value: Any) -> None:
    """Let the value stand there."""
    value_at(data, path[:-1])[path[-1]] = value


def _numbers(value: Any, name: str, path: tuple[Any, ...]) -> Iterator[tuple[str, tuple[Any, ...]]]:
    """(name, path) of every number of a table, a list or a number."""
    if isinstance(value, dict):
        for key, part in value.items():
            yield from _numbers(part, f"{name}.{key}", (*path, key))
    elif isinstance(value, list):
        tables = bool(value) and all(isinstance(part, dict) for part in value)
        for n, part in enumerate(value):
            own = part.get("name") if tables else None
            yield from _numbers(part, f"{name}.{own}" if isinstance(own, str) else f"{name}[{n + 1}]", (*path, n))
    elif _is_number(value):
        yield name, path


def _is_number(value: Any) -> bool:
    if isinstance(value, str) and not isinstance(value, Written):
        return states_uncertainty(value) or split(value) is not None
    return isinstance(value, (int, Written)) and not isinstance(value, bool)


def _both_sides(data: dict[str, Any], path: tuple[Any, ...]) -> tuple[tuple[Any, ...], ...]:
    if path[:2] == ("body", "inertia") and len(path) == 4 and path[2] != path[3]:
        mirrored = (*path[:2], path[3], path[2])
        return (min(path, mirrored), max(path, mirrored))
    return (path,)


def _near(asked: str, known: dict[str, Key]) -> str:
    tails = {name.rpartition(".")[2].lower(): name for name in known}
    words = asked[:80].lower()
    found = [_closest(words, {name.lower(): name for name in known}), _closest(words.rpartition(".")[2], tails), _closest(words, tails)]
    _, near = max((one for one in found if one), key=lambda one: one[0], default=(0, None))
    return f"; did you mean {printable(near)}?" if near else f"; it has {_listed(list(known))}" if known else "; it has none that may vary"


def _closest(asked: str, names: dict[str, str]) -> tuple[float, str] | None:
    """(how near, the name) of the nearest; None where none is near."""
    return next(((SequenceMatcher(None, asked, found).ratio(), names[found]) for found in get_close_matches(asked, names, n=1, cutoff=0.6)), None)


def _listed(names: list[str]) -> str:
    shown = [printable(name) for name in names[:MANY]]
    return ", ".join(shown) + (f" and {len(names) - MANY} more" if len(names) > MANY else "")
