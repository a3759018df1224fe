"""What to write in place of a value of another form than its key takes."""
from __future__ import annotations

import re
from typing import Any

from .aliases import ATTITUDE, ENTRIES, bare, cure_of_tensor, of_rows, shown


def cure_of_number(path: tuple[Any, ...], key: str, value: Any) -> str:
    """What to write where one number is due and something else came; "" where nothing is known."""
    table = ".".join(p for p in path if isinstance(p, str))
    if isinstance(value, list):
        flat = _flat(value)
        if len(flat) == 1:
            return f"write {key} = {shown(flat[0])}"
        if table == "thrusters" and key == "force" and len(flat) == 3:
            return f'write its size alone, such as force = "1 N", and direction = {shown(value)}'
        if table == "wheels" and key in ("momentum", "speed") and len(flat) == 3:
            return (f"write its size along the axis alone, and axis = {shown(value)}; or, without a wheel, "
                    f"[effects.gyrostat] momentum = [x, y, z]")
        if key == "misalignment":
            return 'write the half-angle of the cone, such as misalignment = "1 deg"'
        return f"write one number, such as {key} = {shown(flat[0])}" if flat else ""
    if isinstance(value, bool):
        return f"write a number, or take {key} away"
    if isinstance(value, dict) and set(value) & {"value", "unit", "units"}:
        unit = value.get("unit", value.get("units", ""))
        return f"write {key} = {shown(value.get('value', '..'), str(unit))}"
    if isinstance(value, dict) and set(value) & {"min", "max", "nominal", "tolerance", "sigma", "plus_minus"}:
        return (f'write the middle and the half-width, such as {key} = "12 +- 0.5", where it takes an '
                'uncertainty')
    return ""


def cure_of_numbers(path: tuple[Any, ...], key: str, value: Any, count: int) -> str:
    """What to write where a list of numbers is due; "" where nothing is known."""
    if isinstance(value, dict):
        return _of_table(key, value, count)
    if not isinstance(value, list):
        axis = _axis(value) if key in ("axis", "direction", "vertical") else ""
        if axis:
            return f"write {key} = {axis}"
        if isinstance(value, bool) or type(value) is str and not re.fullmatch(r"\s*[-+]?[\d.][^,;]*",
                                                                                      value):
            return f"write {key} = [x, y, z] with numbers" if count == 3 else ""
        if count == 2:
            return f"write {key} = [0, {shown(value)}]"
        if key == "inertia":
            return f"of a sphere write inertia = [{', '.join([shown(value)] * 3)}]"
        return f"write all three, such as {key} = [0, 0, {shown(value)}]"
    flat = _flat(value)
    if len(flat) == count and flat != value:
        return f"write {key} = {shown(flat)}"
    if key == "inertia" and count == 3:
        if len(flat) == 9:
            return f"write three rows, inertia = {shown([flat[:3], flat[3:6], flat[6:]])}"
        if len(flat) == 6:
            return ("six numbers stand in several orders: write inertia = [[xx, xy, xz], [xy, yy, yz], [xz, "
                    "yz, zz]], or "
                    'inertia = [xx, yy, zz] and products = {xy = .., xz = .., yz = .., convention = '
                    '"positive"} (integrals '
                    'of x y dm) or "negative" (entries of the tensor)')
    if key == "inertia" and any(isinstance(item, list) for item in value):
        return "write three rows of three, inertia = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]"
    if len(flat) == 2 * count and all(re.fullmatch(r"[-+]?\d+", str(item)) for item in flat):
        pairs = ", ".join(f"{a}.{b}" for a, b in zip(flat[::2], flat[1::2]))
        return f"where commas were meant as points of decimals write {key} = [{pairs}]"
    if len(flat) == 4 and count == 3 and key == "attitude":
        return ATTITUDE
    if len(flat) == count + 1 and type(flat[-1]) is str and not re.search(r"\d", flat[-1].partition("^")[0]):
        return f"write {key} = [{', '.join(_united(item, flat[-1]) for item in flat[:-1])}]"
    if len(flat) == 1 and count == 2:
        return f"write {key} = [0, {shown(flat[0])}]"
    if count == 2 and len(flat) > 2:
        return f"write the begin and the end alone, {key} = [{shown(flat[0])}, {shown(flat[-1])}]"
    if key == "rate":
        return f"write one, of the size of the rates, {key} = {shown(flat[0])}, or three" if flat else ""
    if len(flat) == 2 and count == 3:
        return f"write all three, such as {key} = [{shown(flat[0])}, {shown(flat[1])}, 0]"
    return ""


def _axis(value: Any) -> str:
    """The vector of an axis that is given by its letter or number."""
    result = re.fullmatch(r"\s*([-+]?)\s*([xyzXYZ123])\s*(?:-?axis)?\s*", str(value))
    if not result or isinstance(value, bool):
        return ""
    at = "xyz123".index(result[2].lower()) % 3
    return str([(-1 if result[1] == "-" else 1) * (n == at) for n in range(3)])


def _united(value: Any, unit: str) -> str:
    return f'"{value} {unit}"'


def cure_of_units(word: str) -> str:
    """Of [output] units: "; ..." with the word that is known."""
    resolved = {"degree": "deg", "degrees": "deg", "deg per s": "deg/s", "rad": "si", "rad/s": "si",
             "radian": "si",
             "radians": "si", "metric": "si", "rev/min": "rpm", "rps": "rev/s", "hz": "rev/s", "mks": "si"}
    return f'; write units = "{resolved[word]}"' if word in resolved else ""


def _of_table(key: str, value: dict[str, Any], count: int) -> str:
    names = ("x", "y", "z") if count == 3 else ("start", "end")
    entries = {ENTRIES.get(bare(name), bare(name)): item for name, item in value.items()}
    if key == "inertia" and {"xx", "yy", "zz"} <= set(entries):
        return cure_of_tensor(value)
    if set(names) <= set(entries):
        return f"write {key} = [{', '.join(shown(entries[name]) for name in names)}]"
    if {"from", "to"} <= set(entries) and count == 2:
        return f"write {key} = [{shown(entries['from'])}, {shown(entries['to'])}]"
    if "value" in value:
        return f"write {key} = {shown(value['value'], str(value.get('unit', value.get('units', ''))))}"
    return f"write {key} = [{', '.join(names)}] with numbers"


def _flat(value: list[Any]) -> list[Any]:
    return [entry for item in value for entry in (_flat(item) if isinstance(item, list) else [item])]


def cure_of_truth(key: str, value: Any) -> str:
    """What to write where true or false is due."""
    text = bare(str(value)) if isinstance(value, (str, int)) else ""
    if text in ("yes", "on", "true", "1", "y", "open", "stuck", "stuckon", "stuckopen"):
        return f"write {key} = true"
    if text in ("no", "off", "false", "0", "n", "closed"):
        return f"write {key} = false, or take it away"
    return f"write {key} = true"


def cure_of_title(path: tuple[Any, ...], key: str, value: Any) -> str:
    """What to write where a table is due and something else came."""
    title = ".".join([p for p in path if isinstance(p, str)] + [key])
    if of_rows(value):
        return f"write [{title}] in single brackets, once"
    if title == "body.products":
        if not isinstance(value, list) or len(value) != 3:
            return 'write products = {xy = .., xz = .., yz = .., convention = "positive"}'
        pairs = ", ".join(f"{name} = {shown(item)}" for name, item in zip(("xy", "xz", "yz"), value))
        return (f'write products = {{{pairs}, convention = "positive"}} (integrals of x y dm) or "negative" '
                '(entries of '
                "the tensor), each with its own name: their order differs from one program to another")
    first = {"body": "inertia", "motion": "angular_velocity", "limits": "rate", "circular_orbit": "altitude",
             "output": "units",
             "effects.gyrostat": "momentum", "effects.constant_torque": "torque",
             "effects.body_force": "force",
             "effects.resistance": "coefficient", "effects.rate_damper": "coefficient"}.get(title)
    if first:
        fits = isinstance(value, list) == (first in ("inertia", "angular_velocity", "momentum", "torque",
                                                     "force"))
        return (f"write [{title}] and below it {first} = "
                f"{shown(value) if fits and not isinstance(value, bool) else '..'}")
    return f"write [{title}] and its keys below it"
