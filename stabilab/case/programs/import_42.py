"""The spacecraft description file of NASA's simulator 42 (SC_*.txt) as a case: a value and its label a line,
in titled sections.

42 states rates in deg/s, products of inertia as positive integrals, and puts thrusters at nodes whose places
are in a file of their own; a thruster without a place cannot be used and is listed.

Several bodies become one rigid body, their joints locked where they are. Of a joint from body i to body o, 42
(InitSpacecraft in 42init.c, MapStateVectorToBodyStates in 42dynamics.c) turns components by C_oi = C(Go to
Bo) C(angles) C(Bi to Gi), each from angles and a sequence, "312" first about axis 3; the origin of o is at
(position wrt inner) + C(Bi to Gi)^T (displacements) - C_oi^T (position wrt outer) from that of i. Angles and
displacements beyond the joint's degrees of freedom count as zero. A body's moments are about its mass centre,
or about its origin (REFPT_JOINT).
"""
from __future__ import annotations

import re
from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...errors import InputError, printable
from .imported import LOCKED, Craft, listed
from .orbit_42 import Unknown, add_orbit, from_quaternion, name_orbit
from .parts import ONE, Joint, Part, decimals, joined, parallel, places, rows_of, turn

if TYPE_CHECKING:
    from pathlib import Path

_TITLE = re.compile(r"\s*([*=<]{3,})\s*(.*?)\s*[*=>]*\s*")
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
# files beside that of a spacecraft, by what their first line holds
OTHERS = {"Orbit Description": "an orbit file", "Mostly Harmless": "the simulation file"}
USED = {"mass", "moments of inertia", "products of inertia", "location of mass center",
        "constant embedded momentum", "initial momentum",
        "wheel axis", "thrust force", "thrust axis", "ang vel ", "quaternion", "angles (", "description",
        "label",
        "body"}
PLACED = {"inner, outer", "rotdof, seq", "trndof, seq", "initial angles", "initial displacements", "bi to gi",
          "go to bo", "position wrt"}
COUNTS = {1: "a number", 2: "two numbers", 3: "three numbers", 4: "three angles and a sequence"}


class Entry(NamedTuple):
    section: str
    block: str
    value: str
    label: str
    line: int


def read(text: str, path: Path, body: str | None = None) -> Craft:
    """What the file says of all its bodies as one, or of one of them alone, in that body's frame. Raises
    InputError where it says no inertia."""
    other = next((words for phrase, words in OTHERS.items() if phrase in text[:200]), "")
    if other:
        raise InputError(f"{printable(str(path))}: {other} of 42, which describes no spacecraft: import the "
                         "SC_*.txt beside it, with which its orbit is read where that is circular")
    entries = _used(_entries(text))
    craft = Craft(_value(entries, "", "description") or "spacecraft")
    bodies = ([rows for _, rows in _blocks(entries, "body")]
              or [[e for e in entries if e.section.startswith("body")]])
    number = int(body) if body is not None and re.fullmatch(r"[0-9]+", body) else None
    if body is not None and (number is None or number >= len(bodies)):
        raise InputError(
            f"--body {printable(body)}: no such body; the file has "
            f"{f'bodies 0 to {len(bodies) - 1}' if len(bodies) > 1 else 'body 0 alone'}")
    where = _places(entries, len(bodies), path)
    alone, full = bodies[number or 0], number is None and len(bodies) > 1
    craft.rate, craft.rate_unit = _numbers(entries, "ang vel (", 3, path), "deg/s"
    if number and craft.rate:
        craft.rate = decimals(where[number][0] @ [Fraction(v) for v in craft.rate])
    if full:
        parts = [_part(rows, _at_joint(entries), path) for rows in bodies]
        if sum(part.mass for part in parts) <= 0:
            raise InputError(
                f"{path}: {len(parts)} bodies without a mass have no common mass centre; --body N takes one "
                "alone")
        _together(craft, joined(parts, where), len(bodies))
        moving = [block for block, rows in _blocks(entries, "joint") if _moves(rows, path)]
        craft.caveats += [LOCKED.format(listed(moving))] if moving else []
    else:
        _alone(craft, alone, _at_joint(entries), path)
    for block, rows in _blocks(entries, "wheel"):
        _wheel(craft, block, rows, where, number, path)
    for block, rows in _blocks(entries, "thr"):
        on = _on(rows, len(bodies), path)
        if full or on == (number or 0):
            _thruster(craft, block, rows, where[on] if full else None, path)
    _relative(craft, entries, where[number or 0], path)
    craft.omitted += _left(entries)
    return craft


def _alone(craft: Craft, rows: Sequence[Entry], at_joint: bool, path: Path):
    """One body as the file writes it."""
    craft.mass = (_numbers(rows, "mass", 1, path) or [None])[0]
    craft.inertia = _moments(rows, path)
    craft.products = _acting(_numbers(rows, "products of inertia", 3, path))
    craft.centre = _numbers(rows, "location of mass center", 3, path)
    craft.momentum = _acting(_numbers(rows, "constant embedded momentum", 3, path))
    if at_joint and _acting(craft.centre):
        craft.inertia, craft.products = rows_of(_part(rows, at_joint, path)), None
        craft.said.append("moments about the body's origin (REFPT_JOINT) are brought to its mass centre")


def _together(craft: Craft, full: Part, count: int):
    """Several bodies as one."""
    craft.mass, craft.inertia = decimals([full.mass])[0], rows_of(full)
    craft.centre, craft.momentum = decimals(full.centre), _acting(decimals(full.momentum))
    craft.said.append(f"{count} bodies are combined into one rigid body about their common mass centre, in "
                      "the frame of body 0, the joints locked as the file places them (--body N takes one "
                      "alone)")


def _moments(rows: Sequence[Entry], path: Path) -> list[str]:
    result = _numbers(rows, "moments of inertia", 3, path)
    if result is None:
        raise InputError(
            f"{path}: expected a line with three numbers and the label Moments of Inertia in the section "
            "Body Parameters")
    return result


def _part(rows, at_joint: bool, path) -> Part:
    """A body in exact numbers."""
    mass, = _exact(rows, "mass", 1, path)
    x, y, z = (Fraction(v) for v in _moments(rows, path))
    xy, xz, yz = -_exact(rows, "products of inertia", 3, path)
    centre = _exact(rows, "location of mass center", 3, path)
    tensor = np.array([(x, xy, xz), (xy, y, yz), (xz, yz, z)])
    return Part(mass, tensor - parallel(mass, centre) if at_joint else tensor, centre,
                _exact(rows, "constant embedded momentum", 3, path))


def _exact(rows: Sequence[Entry], label: str, count: int, path: Path) -> np.ndarray:
    """The numbers of a line, zeros where it is missing."""
    return np.array([Fraction(v) for v in _numbers(rows, label, count, path) or ["0"] * count])


def _at_joint(entries: Sequence[Entry]) -> bool:
    return _value(entries, "dynamics", "mass props") == "REFPT_JOINT"


def _places(entries: Sequence[Entry], count: int, path: Path):
    """Of every body, what turns components of body 0 to its own, and its origin. Raises InputError where no
    joint leads to it."""
    result = (places([_joint(rows, path) for _, rows in _blocks(entries, "joint")], count) if count > 1
             else places((), 1))
    missing = [str(n) for n in range(count) if n not in result]
    if missing:
        raise InputError(
            f"{path}: no joint of the section Joint Parameters ties body {', '.join(missing)} to body 0; "
            "--body N takes one body alone")
    return result


def _joint(rows, path) -> Joint:
    """The joint that a block of the section Joint Parameters describes, locked where it is."""
    inner, outer = (int(v) for v in _exact(rows, "inner, outer", 2, path))
    (free, sequence), (slides, along) = (_exact(rows, label, 2, path)
                                         for label in ("rotdof, seq", "trndof, seq"))
    angles = _exact(rows, "initial angles", 3, path)[:int(free)]
    before, after = (_static(rows, label, path) for label in ("bi to gi", "go to bo"))
    slid = 0 * ONE[0]
    for axis, route in zip(str(along), _exact(rows, "initial displacements", 3, path)[:int(slides)]):
        slid[int(axis) - 1] += route
    turned = after @ turn(angles, str(sequence)) @ before
    inside, outside = (_exact(rows, f"position wrt {word}", 3, path) for word in ("inner", "outer"))
    return Joint(inner, outer, turned, inside + before.T @ slid - turned.T @ outside)


def _moves(rows: Sequence[Entry], path: Path) -> bool:
    """Whether a joint has a degree of freedom that the file does not lock."""
    for kind in ("rotdof", "trndof"):
        count = int(_exact(rows, f"{kind}, seq", 2, path)[0])
        flags = (_value(rows, "", f"{kind} locked") or "").upper().split()
        if count and flags[:count] != ["TRUE"] * count:
            return True
    return False


def _static(rows, label, path):
    *angles, sequence = _exact(rows, label, 4, path)
    return turn(angles, str(sequence))


def _on(rows: Sequence[Entry], count: int, path: Path) -> int:
    """The body that a wheel or a thruster stands on."""
    result = int(_exact(rows, "body", 1, path)[0])
    if not 0 <= result < count:
        raise InputError(
            f"{path}:{next(e.line for e in rows if e.label.lower().startswith('body'))}: Body: the file has "
            f"no body {result}")
    return result


def _wheel(craft: Craft, block, rows, where, body, path):
    momentum = _numbers(rows, "initial momentum", 1, path)
    if momentum is None:
        return
    on = _on(rows, len(where), path)
    if body is not None and on != body:
        return
    try:
        axis = _numbers(rows, "wheel axis", 3, path)
    except InputError as error:
        if float(momentum[0]):
            raise
        craft.said.append(
            f"line {str(error).removeprefix(f'{path}:')}; {block} has no momentum and is left out")
        return
    if axis:
        craft.wheels.append({"name": block, "axis": axis if not on or body else _turned(where[on], axis),
                             "momentum": momentum[0]})


def _turned(location, vector) -> list[str]:
    """A vector of a body in the frame of body 0."""
    return decimals(location[0].T @ [Fraction(v) for v in vector])


def _thruster(craft, block, rows, where, path):
    axis, force = _numbers(rows, "thrust axis", 3, path), _numbers(rows, "thrust force", 1, path)
    location = _numbers(rows, "location", 3, path)
    if axis and where:
        axis = _turned(where, axis)
    if location and where:
        location = decimals([a + Fraction(b) for a, b in zip(where[1], _turned(where, location))])
    if axis and force and location:
        craft.thrusters.append({"name": block, "position": location, "direction": axis, "force": force[0]})
    elif axis and force:
        craft.omitted.append(f"{block}: {force[0]} N along [{', '.join(axis)}] at node "
                             f"{_value(rows, '', 'node')}, whose place is in a node file: add it as "
                             "[[thrusters]] with its position")


def _entries(text: str) -> list[Entry]:
    section = block = ""
    rows = []
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
            rows.append(Entry(section, block, value.strip().strip('"'), label.strip(), number))
    return rows


def _used(entries: Sequence[Entry]):
    """Without the samples that follow a number of none, and joints of a single body."""
    none = {e.section for e in entries if e.label.lower().startswith("number of") and e.value == "0"}
    item = any(e.label.lower().startswith("number of bodies") and e.value == "1" for e in entries)
    return [e for e in entries
            if not (e.block and (e.section in none or (item and e.section.startswith("joint"))))]


def _blocks(entries: Sequence[Entry], kind: str):
    """(title, entries) of every block of the section that begins so."""
    titles = dict.fromkeys(e.block for e in entries if e.section.startswith(kind) and e.block)
    return [(title, [e for e in entries if e.section.startswith(kind) and e.block == title])
            for title in titles]


def _value(entries: Sequence[Entry], section: str, label: str):
    return next((e.value for e in entries if e.section.startswith(section)
                 and e.label.lower().startswith(label)), None)


def _numbers(entries: Sequence[Entry], label: str, count: int, path: Path):
    entry = next((e for e in entries if e.label.lower().startswith(label)), None)
    if entry is None:
        return None
    text = entry.value.split()
    numbers = all(_NUMBER.fullmatch(word) for word in text[:count])
    if len(text) < count or not numbers or (len(text) > count and _NUMBER.fullmatch(text[count])):
        raise InputError(
            f"{path}:{entry.line}: {entry.label}: expected {COUNTS[count]}, got \"{entry.value[:60]}\"")
    return [_written(word) for word in text[:count]]


def _written(word: str) -> str:
    """As TOML writes it: digits on both sides of the point, no plus and no needless zero in front."""
    mantissa, mark, power = re.fullmatch(r"\+?([^eE]*)([eE]?)(.*)", word).groups()
    sign, digits = ("-", mantissa[1:]) if mantissa.startswith("-") else ("", mantissa)
    full, point, rest = digits.partition(".")
    return f"{sign}{full.lstrip('0') or '0'}{f'.{rest or 0}' if point else ''}{mark}{power}"


def _acting(vector: Sequence[str] | None):
    return vector if vector and any(float(v) for v in vector) else None


def _relative(craft: Craft, entries: Sequence[Entry], location: Sequence[np.ndarray], path: Path) -> None:
    """Rates relative to the orbit frame as those relative to inertial space; where these are not known the
    craft has no motion and every answer says why. location: of the body of the case, from body 0."""
    frames = (_value(entries, "", "ang vel wrt") or "").strip().upper()
    if not craft.rate or not frames or frames.startswith("N"):
        name_orbit(craft, path)
        return
    try:
        if len(frames) < 3 or frames[2] != "L":
            raise Unknown(f"its attitude is not relative to the orbit frame ({frames})")
        attitude = (from_quaternion(_numbers(entries, "quaternion", 4, path) or ("0", "0", "0", "1"))
                    if frames[1] == "Q" else _static(entries, "angles", path))
        add_orbit(craft, path, location[0] @ attitude)
    except Unknown as error:
        craft.caveats.append(
            f"no motion: the imported file gives an angular velocity of [{', '.join(craft.rate)}] deg/s "
            f"relative to the orbit frame (Ang Vel wrt L), and {error}; write [motion] angular_velocity "
            "relative to inertial space")
        craft.rate = None


def _left(entries: Sequence[Entry]) -> list[str]:
    """What was not used, a line a section."""
    sections: dict[str, Any] = {}
    for e in entries:
        if not e.label.lower().startswith((*USED, *PLACED, "mass props",
                                           "number of")) and e.value not in ("0", "NONE"):
            sections.setdefault(e.section or "head", []).append(e.label.split("(")[0].split(",")[0].strip())
    return [f"{section}: {', '.join(dict.fromkeys(labels))}" for section, labels in sections.items()]
