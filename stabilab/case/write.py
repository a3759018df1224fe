"""A case as TOML text: numbers as they were written, or exactly as a scene holds them."""
from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Mapping
from decimal import Decimal, localcontext
from fractions import Fraction
from typing import Any

from ..errors import InputError
from ..physics.scene import Scene
from .table import Written

DECIMALS = 20  # an exact decimal of so many digits is written as one, any other number as a ratio
# a ratio with more letters is one of 240 bits, of axes that are irrational: it is rounded to so many digits
RATIO, DIGITS = 120, 36


def data_of(text: str) -> dict[str, Any]:
    """The data of a case file."""
    return tomllib.loads(text, parse_float=Written)


def exact_text(value: Fraction) -> Written | str:
    """A rational as a case takes it: a decimal, or a ratio in quotes; numbers that were enclosed, not given,
    are rounded."""
    places, rest = 0, value.denominator
    for prime in (2, 5):
        power = 0
        while rest % prime == 0:
            rest, power = rest // prime, power + 1
        places = max(places, power)
    digits = f"{abs(value.numerator) * 10**places // value.denominator:0{places + 1}d}" if rest == 1 else ""
    if not digits or len(digits) > DECIMALS:
        ratio = f"{value.numerator}/{value.denominator}"
        return ratio if len(ratio) <= RATIO else Written(f"{_rounded(value):e}")
    full, fraction = (digits[:-places], digits[-places:]) if places else (digits, "0")
    return Written(f"{'-' if value < 0 else ''}{full}.{fraction}")


def _rounded(value: Fraction) -> Decimal:
    with localcontext() as context:
        context.prec = DIGITS
        return Decimal(value.numerator) / Decimal(value.denominator)


def text_of(data: dict[str, Any], head: str = "") -> str:
    """TOML text; head: a comment above it."""
    lines = [f"# {line}" for line in head.splitlines()]
    _table(lines, (), data)
    return "\n".join(lines).strip("\n") + "\n"


def _table(lines: list[str], path: tuple[str, ...], table: dict[str, Any], brackets: str = "[%s]") -> None:
    plain = {k: v for k, v in table.items() if not _is_table(v)}
    if path and (plain or not table or brackets != "[%s]"):
        lines += ["", brackets % ".".join(map(_key, path))]
    lines += [f"{_key(k)} = {_value(v)}" for k, v in plain.items()]
    for key, value in table.items():
        if isinstance(value, dict):
            _table(lines, (*path, key), value)
        elif _is_table(value):
            for row in value:
                _table(lines, (*path, key), row, "[[%s]]")


def _is_table(value: Any) -> bool:
    return (isinstance(value, dict) or isinstance(value, list) and bool(value)
            and all(isinstance(item, dict) for item in value))


def _key(key: str) -> str:
    return key if re.fullmatch(r"[A-Za-z0-9_-]+", key) else _quoted(key)


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Written) or not isinstance(value, (str, list, dict)):
        return str(value)
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, list):
        return f"[{', '.join(map(_value, value))}]"
    return f"{{{', '.join(f'{_key(k)} = {_value(v)}' for k, v in value.items())}}}"


# --- What Python gives in place of a file: a dict of tables, or a scene with a state
STATES = {"omega": "angular_velocity", "x": "x", "gamma": "vertical", "attitude": "attitude",
          "velocity": "velocity", "position": "position",
          "damper": "damper", "wheel": "wheel", "damper_wheel": "damper_wheel",
          "sprung_wheel": "sprung_wheel",
          "damper_mass": "damper_mass"}  # block of a state: its key in [motion]


def plain(value: Any, name: str = "load") -> Any:
    """The tables, lists and numbers of a dict as a file holds them: tuples and arrays as lists, rationals as
    they stand. Raises InputError for what no file holds."""
    if isinstance(value, Mapping):
        return {str(key): plain(item, f"{name}: {key}") for key, item in value.items()}
    if hasattr(value, "tolist"):  # an array, or a number of one
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [plain(item, name) for item in value]
    if isinstance(value, Fraction):
        return exact_text(value)
    if isinstance(value, Decimal):
        return Written(value)
    if isinstance(value, (str, bool, int, float)):
        return value
    raise InputError(f"{name}: expected a number, a text, a list or a dict, got {type(value).__name__}")


def data_of_scene(scene: Any, state: Any = None, span: Any = None) -> dict[str, Any]:
    """The tables of a case file with this scene and this motion, along its principal axes. state: three rates
    in the scene's variables, or blocks by name ("omega", "gamma", "attitude" in 3-1-2 angles ...); span:
    (from, to) in the scene's time."""
    scaled = not isinstance(scene, Scene)
    if scaled:
        data: dict[str, Any] = {"scaled": dict(zip(("a", "b", "mu"), (*scene.exact_ab, scene.exact_mu)))}
    else:
        body = {"inertia": scene.body.exact, "mass": scene.body.mass}
        data = {"body": {key: value for key, value in body.items() if value is not None},
                "effects": {effect.name: effect.written() for effect in scene.effects}}
    if state is not None:
        blocks = state if isinstance(state, Mapping) else {"omega": state}
        unknown = [name for name in blocks if name not in STATES]
        if unknown:
            raise InputError(
                f"state: expected the blocks {', '.join(STATES)}, got {', '.join(map(str, unknown))}")
        data["motion"] = {"x" if scaled and name == "omega" else STATES[name]: value
                          for name, value in blocks.items()}
        if span is not None:
            data["motion"]["tau" if scaled else "span"] = span
    return plain({key: table for key, table in data.items() if table})
