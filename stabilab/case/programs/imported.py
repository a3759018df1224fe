"""A spacecraft that another program describes, written as a case: what is common to all formats."""
from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from ...errors import InputError, printable
from ..read import load_orbiting, read_all
from ..write import exact_text, plain, text_of

if TYPE_CHECKING:
    from pathlib import Path

# names of another program: a dictionary that has one of them is its own
ELSEWHERE = {"mHub", "r_BcB_B", "IHubPntBc_B", "omega_BN_BInit", "omega_BN_B", "thrLoc_B", "thrDir_B",
             "MaxThrust",
             "maxThrust", "gsHat_B", "Omega", "ModelTag"}
LARGEST = 12  # names in a sentence
LOCKED = "of one rigid body, with the joints of the imported file locked in the position that it gives: {}"


@dataclass
class Craft:
    """What a file says of a spacecraft, every number as it is written there.

    inertia: three texts, or three rows of three; products: texts xy, xz, yz whose integrals are positive, or
    None; thrusters and wheels: {key of the case: text or three texts}; orbit: the line of
    [circular_orbit]; attitude: 3-1-2 angles, rad; torques: {name, torque: three texts, N m, caveat: what is
    to be said where it does not act} that act where they are stuck; caveats: what limits every answer, in
    words; omitted: what has no counterpart in a case, in words; said: what was done with the rest.
    """

    title: str
    mass: str | None = None
    inertia: list = field(default_factory=list)
    products: list | None = None
    centre: list | None = None
    momentum: list | None = None
    thrusters: list = field(default_factory=list)
    wheels: list = field(default_factory=list)
    rate: list | None = None
    rate_unit: str = ""
    orbit: str | None = None
    attitude: list | None = None
    torques: list = field(default_factory=list)
    caveats: list = field(default_factory=list)
    omitted: list = field(default_factory=list)
    said: list = field(default_factory=list)


def case_text(craft: Craft, path, stuck=()) -> str:
    """The case as TOML. stuck: names of the thrusters, and of torques, that are."""
    names = [t["name"] for t in (*craft.thrusters, *craft.torques)]
    for name in stuck:
        if name not in names:
            raise InputError(
                f"--stuck {printable(name)}: no such thruster{' or maneuver' * bool(craft.torques)}; the "
                f"file has {', '.join(map(printable, names)) or 'none that can be used'}")
    lines = [f"title = {_text(craft.title)}",
             f"source = {_text('imported from ' + os.path.basename(os.fspath(path)))}"]
    caveats = [*craft.caveats, *(t["caveat"] for t in craft.torques if t["name"] not in stuck)]
    lines += [f"caveats = {_list(map(_text, caveats))}"] if caveats else []
    lines += ["", "[body]"]
    rows = [_list(row) for row in craft.inertia] if isinstance(craft.inertia[0], list) else None
    lines.append(f"inertia = [{', '.join(rows)}]" if rows else f"inertia = {_list(craft.inertia)}")
    if craft.products:
        pairs = ", ".join(f"{name} = {value}" for name, value in zip(("xy", "xz", "yz"), craft.products))
        lines.append(f'products = {{{pairs}, convention = "positive"}}')
    lines += [f"mass = {craft.mass}"] if craft.mass else []
    lines += [f"centre_of_mass = {_list(craft.centre)}"] if craft.centre else []
    lines += ["", "[effects.gyrostat]", f"momentum = {_list(craft.momentum)}"] if craft.momentum else []
    acting = [t["torque"] for t in craft.torques if t["name"] in stuck]
    if acting:
        total = [exact_text(sum(map(Fraction, parts), Fraction(0))) for parts in zip(*acting)]
        lines += ["", "[effects.constant_torque]", f"torque = {_list(map(str, total))}"]
    for thruster in craft.thrusters:
        lines += ["", "[[thrusters]]", *_pairs(thruster),
                  *(["stuck = true"] if thruster["name"] in stuck else [])]
    for wheel in craft.wheels:
        lines += ["", "[[wheels]]", *_pairs(wheel)]
    lines += ["", "[circular_orbit]", craft.orbit] if craft.orbit else []
    if craft.rate or craft.attitude:
        lines += ["", "[motion]"]
    if craft.rate:
        rate = [_text(f"{v} {craft.rate_unit}") for v in craft.rate] if craft.rate_unit else craft.rate
        lines.append(f"angular_velocity = {_list(rate)}")
    lines += [f"attitude = {_list(craft.attitude)}"] if craft.attitude else []
    return "\n".join(lines) + "\n"


def case_of_tables(data: Any, path) -> str | None:
    """The case as TOML where data are the tables of one, None where they are something else."""
    if not isinstance(data, dict):
        return None
    body = data.get("body")
    if not ("scaled" in data or isinstance(body, dict) and "inertia" in body):
        return None
    names = {str(key) for key in _keys(data)}
    return None if names & ELSEWHERE else text_of(plain(data, printable(str(path))))


def _keys(data: Any) -> Iterator[Any]:
    if isinstance(data, dict):
        for key, value in data.items():
            yield key
            yield from _keys(value)
    elif isinstance(data, list):
        for value in data:
            yield from _keys(value)


def faults_of(text: str, path: Path) -> list[str]:
    """What a reader of the case would refuse."""
    try:
        if "\n[circular_orbit]" in text:
            load_orbiting(text)
        else:
            read_all(os.fspath(path), text)
    except InputError as error:
        return str(error).split("\n")
    return []


def _pairs(part: Mapping[str, Any]):
    return [f"{key} = {_text(value) if key == 'name' else _list(value) if isinstance(value, list) else value}"
            for key, value in part.items()]


def _list(values: Sequence[str] | map[str]) -> str:
    return f"[{', '.join(values)}]"


def _text(text: str) -> str:
    return json.dumps(printable(text), ensure_ascii=False)


def listed(names: Sequence[str]) -> str:
    """Names for a sentence; of many the first, and how many more there are."""
    more = f" and {len(names) - LARGEST} more" if len(names) > LARGEST else ""
    return ", ".join(map(printable, names[:LARGEST])) + more
