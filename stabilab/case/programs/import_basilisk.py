"""A spacecraft in Basilisk's names, as JSON or as a dictionary in Python: hub, thrusters, reaction wheels.

Numbers are SI; a direction is that of the force on the body; Omega is relative to the body, rad/s. A Python
file is read, not run.
"""
from __future__ import annotations

import ast
import json
import re
from collections.abc import Sequence
from decimal import Decimal
from typing import TYPE_CHECKING, Any

from ...errors import InputError, printable
from ..formats import BY_HAND, FORMATS, READ, seems
from .imported import Craft, case_of_tables

if TYPE_CHECKING:
    from pathlib import Path

HUB = {"mass": ("mHub", "mass"), "centre": ("r_BcB_B",), "inertia": ("IHubPntBc_B", "inertia"),
       "rate": ("omega_BN_BInit", "omega_BN_B", "angular_velocity", "omega")}
THRUSTERS = ("thrusters", "thruster", "thrs")
WHEELS = ("reactionWheels", "reaction_wheels", "wheels", "RWs", "rws", "RW")
THRUSTER = {"name": ("label", "name"), "position": ("thrLoc_B", "location"),
            "direction": ("thrDir_B", "direction"), "force": ("MaxThrust", "maxThrust")}
MOTION = re.compile("omega|rate|angvel|velocity|spin|motion", re.IGNORECASE)  # of names that state one
WHEEL = {"name": ("label", "name"), "axis": ("gsHat_B",), "inertia": ("Js",), "speed": ("Omega",)}


def read(text: str, path: Path, body: None = None) -> Craft | str:
    """The craft, or the case as TOML of a file that has the tables of one."""
    data = dictionary(text, printable(str(path)))
    own = case_of_tables(data, path)
    return from_dictionary(data, path) if own is None else own


def from_dictionary(data: dict, path: str | Path = "the dictionary") -> Craft:
    """The same of a dictionary."""
    if not isinstance(data, dict):
        raise InputError(f"{path}: expected a dictionary with Basilisk's names, got {type(data).__name__}")
    craft, flat = Craft(str(_first(data, ("ModelTag", "name", "title")) or "spacecraft")), _flat(data)
    inertia = _found(flat, HUB["inertia"])
    if inertia is None:
        raise InputError(f"{path}: expected the inertia of the hub about its mass centre under the name "
                         "IHubPntBc_B (or a NASA 42 spacecraft file); found "
                         f"{', '.join(list(flat)[:20]) or 'nothing'}")
    craft.inertia = _tensor(inertia[1], path)
    mass, centre, rate = (_found(flat, HUB[key]) for key in ("mass", "centre", "rate"))
    craft.mass = mass and _one(mass[1], mass[0], path)
    craft.centre, craft.rate = (pair and _three(pair[1], pair[0], path) for pair in (centre, rate))
    used = {pair[0] for pair in (inertia, mass, centre, rate) if pair}
    for kind, names, keys, parts in (("thruster", THRUSTERS, THRUSTER, craft.thrusters),
                                     ("wheel", WHEELS, WHEEL, craft.wheels)):
        pair = _found(flat, names)
        if pair:
            used.add(pair[0])
            named = (pair[1].items() if isinstance(pair[1], dict)
                     else ((f"{kind} {i}", item) for i, item in enumerate(pair[1], 1)))
            for name, item in named:
                _part(craft, parts, str(name), keys, item, path)
    if craft.wheels:
        craft.omitted.append(
            "the wheels' own mass and inertia: the tensor is that of the hub alone, so add them to it where "
            "they matter")
    left = [name for name in flat if name not in used and name not in ("ModelTag", "name", "title")]
    craft.omitted += left
    turning = [] if rate else [name for name in left if MOTION.search(name)]
    if turning:
        craft.caveats.append(f"the motion that the imported file states ({', '.join(turning)}) is not read: "
                             "its name or its unit is not known; write it as [motion] angular_velocity")
    return craft


def _part(craft, parts, otherwise, keys, item, path):
    if not isinstance(item, dict):
        raise InputError(f"{path}: {otherwise}: expected a dictionary, got {type(item).__name__}")
    pairs = {key: _found(item, names) for key, names in keys.items()}
    name = str(pairs["name"][1]) if pairs["name"] else otherwise
    missing = [keys[key][0] for key, pair in pairs.items() if pair is None and key != "name"]
    if missing:
        craft.omitted.append(f"{name}: no {' and no '.join(missing)}, so it is left out")
        return
    part = {"name": name}
    for key, pair in pairs.items():
        if key != "name":
            part[key] = (_three if key in ("position", "direction", "axis")
                         else _one)(pair[1], f"{name}: {pair[0]}", path)
    parts.append(part)
    craft.omitted += [f"{name}: {key}" for key in item
                      if key not in {pair[0] for pair in pairs.values() if pair}]


def dictionary(text: str, path: str) -> Any:
    """The dictionary of a text in JSON or Python. Raises InputError, with what the text seems to be, where it
    is neither."""
    format = seems(text)
    if format not in ("", "JSON", "Python", "a text of keywords"):
        raise InputError(f"{path}: this seems to be {format}, which is not read: {READ}; {BY_HAND}")
    if re.search(r"^\[\[?\w+(\.\w+)*\]\]?\s*$", text, re.M) and re.search(r"^\w+ *=", text, re.M):
        raise InputError(f"{path}: this seems to be a case already, or TOML: ask it as it is, `stabilab fate "
                         f"FILE`; {READ}")
    try:
        return json.loads(text, parse_float=Decimal)
    except ValueError as error:
        json_words = str(error)
    except RecursionError:
        raise InputError(f"{path}: nested too deeply to be read") from None
    try:
        tree = ast.parse(text)
        literals = (node.value for node in tree.body
                    if isinstance(node, (ast.Assign, ast.AnnAssign, ast.Expr))
                    and isinstance(node.value, ast.Dict))
        for node in literals:
            return _literal(node)
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise InputError(
            f"{path}: neither JSON ({json_words}) nor a dictionary of plain numbers in Python ({error}); "
            f"{READ}") from None
    raise InputError(
        f"{path}: expected {FORMATS}; JSON says: {json_words}")


def _literal(node):
    """The value of numbers, texts, lists and dictionaries as they are written; ValueError for anything that
    would have to be run."""
    if isinstance(node, ast.Constant):
        return node.value
    if isinstance(node, (ast.List, ast.Tuple)):
        return [_literal(item) for item in node.elts]
    if isinstance(node, ast.Dict) and None not in node.keys:
        return {str(_literal(key)): _literal(value) for key, value in zip(node.keys, node.values)}
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        value = _literal(node.operand)
        if isinstance(value, (int, float)):
            return -value
    raise ValueError(f"line {getattr(node, 'lineno', '?')} is none")


def _flat(data: dict) -> dict:
    """The names of the dictionary and of those inside it (hub, spacecraft); lists and parts stay whole."""
    flat = {}
    for key, value in data.items():
        if isinstance(value, dict) and key not in (*THRUSTERS, *WHEELS):
            flat.update(_flat(value))
        else:
            flat[str(key)] = value
    return flat


def _found(data: dict, names: Sequence[str]):
    return next(((name, data[name]) for name in names if name in data), None)


def _first(data: dict, names: Sequence[str]):
    pair = _found(data, names)
    return pair and pair[1]


def _plain(value):
    """Nested lists made flat: a column of Basilisk is [[x], [y], [z]]."""
    return [each for item in value for each in _plain(item)] if isinstance(value, (list, tuple)) else [value]


def _tensor(value: Sequence[int], path: Path | str):
    numbers = [_number(v, "IHubPntBc_B", path) for v in _plain(value)]
    if len(numbers) == 3:
        return numbers
    if len(numbers) != 9:
        raise InputError(
            f"{path}: IHubPntBc_B: expected nine numbers, or three principal moments, got {len(numbers)}")
    return [numbers[i:i + 3] for i in (0, 3, 6)]


def _three(value: Sequence[int | Decimal], name: str, path: Path | str):
    numbers = [_number(v, name, path) for v in _plain(value)]
    if len(numbers) != 3:
        raise InputError(f"{path}: {name}: expected three numbers, got {len(numbers)}")
    return numbers


def _one(value, name, path):
    return _number(value, name, path)


def _number(value, name, path) -> str:
    if isinstance(value, bool) or not isinstance(value, (int, float, Decimal)):
        raise InputError(f"{path}: {name}: expected a number, got {str(value)[:60]!r}")
    text = str(value).lower()
    return text if any(c in text for c in ".en") or isinstance(value, int) else f"{text}.0"
