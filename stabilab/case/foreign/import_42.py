"""The spacecraft description file of NASA's simulator 42 (SC_*.txt): a value and its label a line, in titled sections.

42 states rates in deg/s, products of inertia as positive integrals, and puts thrusters at nodes whose places are in a file of their
own; a thruster without a place cannot be used and is listed.
"""
from __future__ import annotations

import re
from typing import Any, NamedTuple

from ...errors import InputError
from .imported import Craft

_TITLE = re.compile(r"\s*([*=<]{3,})\s*(.*?)\s*[*=>]*\s*")
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
USED = {"mass", "moments of inertia", "products of inertia", "location of mass center", "constant embedded momentum", "initial momentum",
        "wheel axis", "thrust force", "thrust axis", "ang vel (", "description", "label"}


class Entry(NamedTuple):
    section: str
    block: str
    value: str
    label: str
    line: int


def is_one(text: str) -> bool:
    """Whether a text is such a file."""
    return "42:" in text[:200] and "!" in text


def spacecraft(text: str, path) -> Craft:
    """What the file says. Raises InputError where it says no inertia."""
    entries = _used(_entries(text))
    craft = Craft(_value(entries, "", "description") or "spacecraft")
    body = [e for e in entries if e.section.startswith("body") and e.block in ("body 0", "")]
    craft.mass = (_numbers(body, "mass", 1, path) or [None])[0]
    craft.inertia = _numbers(body, "moments of inertia", 3, path)
    if craft.inertia is None:
        raise InputError(f"{path}: expected a line with three numbers and the label Moments of Inertia in the section Body Parameters")
    craft.products = _acting(_numbers(body, "products of inertia", 3, path))
    craft.centre = _numbers(body, "location of mass center", 3, path)
    craft.momentum = _acting(_numbers(body, "constant embedded momentum", 3, path))
    craft.rate, craft.rate_unit = _numbers(entries, "ang vel (", 3, path), "deg/s"
    for block, rows in _blocks(entries, "wheel"):
        axis, momentum = _numbers(rows, "wheel axis", 3, path), _numbers(rows, "initial momentum", 1, path)
        if axis and momentum:
            craft.wheels.append({"name": block, "axis": axis, "momentum": momentum[0]})
    for block, rows in _blocks(entries, "thr"):
        _thruster(craft, block, rows, path)
    craft.omitted += _warnings(entries) + _left(entries)
    return craft


def _thruster(craft, block, rows, path):
    axis, force = _numbers(rows, "thrust axis", 3, path), _numbers(rows, "thrust force", 1, path)
    place = _numbers(rows, "location", 3, path)
    if axis and force and place:
        craft.thrusters.append({"name": block, "position": place, "direction": axis, "force": force[0]})
    elif axis and force:
        craft.omitted.append(f"{block}: {force[0]} N along [{', '.join(axis)}] at node {_value(rows, '', 'node')}, whose place is in a node "
                             "file: add it as [[thrusters]] with its position")


def _entries(text: str) -> list[Entry]:
    section = block = ""
    found = []
    for number, line in enumerate(text.splitlines(), 1):
        title = _TITLE.fullmatch(line)
        if title:
            if title[1][0] == "=":
                block = title[2].lower()
            elif title[2]:
                section, block = title[2].lower(), ""
            continue
        value, mark, label = line.partition("!")
        if mark:
            found.append(Entry(section, block, value.strip().strip('"'), label.strip(), number))
    return found


def _used(entries):
    """Without the samples that follow a number of none, and joints of a single body."""
    none = {e.section for e in entries if e.label.lower().startswith("number of") and e.value == "0"}
    one = any(e.label.lower().startswith("number of bodies") and e.value == "1" for e in entries)
    return [e for e in entries if not (e.block and (e.section in none or (one and e.section.startswith("joint"))))]


def _blocks(entries, kind):
    """(title, entries) of every block of the section that begins so."""
    titles = dict.fromkeys(e.block for e in entries if e.section.startswith(kind) and e.block)
    return [(title, [e for e in entries if e.section.startswith(kind) and e.block == title]) for title in titles]


def _value(entries, section, label):
    return next((e.value for e in entries if e.section.startswith(section) and e.label.lower().startswith(label)), None)


def _numbers(entries, label, count, path):
    entry = next((e for e in entries if e.label.lower().startswith(label)), None)
    if entry is None:
        return None
    words = entry.value.split()
    if len(words) < count or not all(_NUMBER.fullmatch(word) for word in words[:count]):
        raise InputError(f"{path}:{entry.line}: {entry.label}: expected {'three numbers' if count == 3 else 'a number'}, got \"{entry.value[:60]}\"")
    return [_written(word) for word in words[:count]]


def _written(word: str) -> str:
    """As TOML writes it: digits on both sides of the point, no plus and no needless zero in front."""
    mantissa, mark, power = re.fullmatch(r"\+?([^eE]*)([eE]?)(.*)", word).groups()
    sign, digits = ("-", mantissa[1:]) if mantissa.startswith("-") else ("", mantissa)
    whole, point, rest = digits.partition(".")
    return f"{sign}{whole.lstrip('0') or '0'}{f'.{rest or 0}' if point else ''}{mark}{power}"


def _acting(vector):
    return vector if vector and any(float(v) for v in vector) else None


def _warnings(entries) -> list[str]:
    notes = []
    frame = _value(entries, "", "ang vel wrt")
    if frame and not frame.upper().startswith("N"):
        notes.append("the angular velocity is relative to the orbit frame (Ang Vel wrt L): it is taken as relative to inertial space")
    bodies = _value(entries, "body", "number of bodies")
    if bodies not in (None, "1"):
        notes.append(f"{bodies} bodies joined together: body 0 alone is taken, as one rigid body")
    if _value(entries, "dynamics", "mass props") not in (None, "REFPT_CM"):
        notes.append("mass properties that refer to a joint: the moments are taken as those about the mass centre")
    return notes


def _left(entries) -> list[str]:
    """What was not used, a line a section."""
    sections: dict[str, Any] = {}
    for e in entries:
        if not e.label.lower().startswith((*USED, "number of")) and e.value not in ("0", "NONE"):
            sections.setdefault(e.section or "head", []).append(e.label.split("(")[0].split(",")[0].strip())
    return [f"{section}: {', '.join(dict.fromkeys(labels))}" for section, labels in sections.items()]
