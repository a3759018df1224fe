"""A case with what the sliders changed: as the text of a case file, and as the case that this text states.

What the page shows is always the answer for that very text, so a case that is saved is the one that was seen. Numbers that no hand touched stay as
the file has them. Sliders count along principal axes; where the file's tensor is not diagonal, the new text stands along these.
"""
from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

from ...case.read import Case, read_text
from ...errors import CaseError, InputError
from ...verify.numbers import shown
from ..units import Units
from .controls import torque_of
from .toml import Written, data_of, exact_text, text_of

SPOKEN_FOR = ("expect", "sweep")  # tables that speak of the file's own numbers
LENGTH = 40  # letters of a number at most
SMALLEST = 1e-300  # but zero: what is drawn of smaller ones has fewer digits than doubles
LARGEST = 1e8  # beyond it doubles that are drawn run into overflows and lost digits; no body has such numbers


def changed(case: Case, asked: dict[str, Any], units: Units) -> tuple[Case, str]:
    """(the case with the changes of a request, words on what was left out). asked: {"torque": None or {axis, size, tilt, azimuth}, "wheel" and "start": a
    number in text, or None for the case's own, for each slider}. Raises InputError for what is no such request."""
    scaled = case.scene.variables == "scaled"
    torque, wheel, start = asked.get("torque"), _numbers(asked, "wheel", 2 if scaled else 3), _numbers(asked, "start", 3)
    if torque is None and wheel is None and start is None and case.state is not None:
        return case, ""
    base = _base(case)
    if torque is not None:
        _set_torque(base, _torque(torque), scaled)
    if wheel is not None:
        _set_wheel(base, case, wheel, scaled)
    if start is not None or case.state is None:
        _set_start(base, case, start or [None] * 3, scaled, units)
    head, left = f"{case.name}, changed with stabilab explore", _left_out(case, torque is None)
    try:
        return read_text(case.path, text_of(base, head)), left
    except CaseError as error:
        if not all(problem.key.startswith("limits") for problem in error.problems):
            raise
    base.pop("limits")
    return read_text(case.path, text_of(base, head)), f"The start is beyond the limit of the case, which is left out here. {left}".rstrip()


def _left_out(case: Case, fires: bool) -> str:
    """What of a file whose tensor is not diagonal cannot be stated along the principal axes; fires: whether its thrusters still give the torque."""
    if case.frame is None or case.frame.as_given:
        return ""
    found = [words for words, there in (("limits about the axes of the file", case.limits is not None and case.limits.rates is not None),
                                        ("the misalignment of thrusters", fires and any(one.stuck and one.misalignment for one in case.thrusters))) if there]
    return f"Left out of a changed case, which stands along the principal axes: {' and '.join(found)}." if found else ""


def _base(case: Case) -> dict[str, Any]:
    """The data of the case to be changed, along principal axes."""
    data = {key: value for key, value in data_of(case.text).items() if key not in SPOKEN_FOR}
    scene = case.scene
    if scene.variables == "scaled":
        motion = {key: value for key, value in data.get("motion", {}).items() if key in ("x", "tau")}
        own = {"a": exact_text(scene.exact_ab[0]), "b": exact_text(scene.exact_ab[1]), "mu": [exact_text(v) for v in scene.exact_mu]}
        return _kept(data, "title", "source") | {"scaled": own, **_kept(data, "output"), **({"motion": motion} if motion else {})}
    if case.frame is None or case.frame.as_given:
        return data
    body = {"inertia": [exact_text(v) for v in scene.body.exact]} | _kept(data["body"], "mass")
    vectors: Any = {effect.name: (type(effect).keys[0], scene.vector(effect.name)) for effect in scene.effects}
    effects = {name: {key: [exact_text(v) for v in vector]} for name, (key, vector) in vectors.items()}
    motion = {"angular_velocity": [exact_text(v) for v in case.exact_state or ()]} | _kept(data.get("motion", {}), "span")
    limits = {} if case.limits is None or case.limits.rate is None else _kept(data, "limits")
    return _kept(data, "title", "source") | {"body": body, "effects": effects, **limits, **_kept(data, "output"), "motion": motion}


def _kept(data: dict[str, Any], *keys: str) -> dict[str, Any]:
    return {key: data[key] for key in keys if key in data}


def _set_torque(base: dict[str, Any], vector: tuple[float, ...], scaled: bool) -> None:
    numbers = [Written(f"{v + 0.0:.12g}") for v in vector]
    if scaled:
        base["scaled"]["mu"] = numbers
        return
    for thruster in base.get("thrusters", ()):
        thruster["stuck"] = False  # its torque is in that of the slider
    base.setdefault("effects", {})["constant_torque"] = {"torque": numbers}


def _set_wheel(base: dict[str, Any], case: Case, values: list[Any], scaled: bool) -> None:
    if scaled:
        base["scaled"] |= {name: Written(value) for name, value in zip("ab", values) if value is not None}
        return
    scene: Any = case.scene
    own = scene.vector("gyrostat")
    base.pop("wheels", None)
    base.setdefault("effects", {})["gyrostat"] = {"momentum": [exact_text(v) if new is None else Written(new) for v, new in zip(own, values)]}


def _set_start(base: dict[str, Any], case: Case, values: list[Any], scaled: bool, units: Units) -> None:
    motion = base.setdefault("motion", {})
    key = "x" if scaled else "angular_velocity"
    own = motion.get(key) or [exact_text(Fraction(v)) for v in case.exact_state or (0, 0, 0)]
    unit = units.rates[0]
    motion[key] = [old if new is None else Written(new) if scaled or unit == "rad/s" else f"{new} {unit}" for old, new in zip(own, values)]


def _numbers(asked: dict[str, Any], name: str, count: int) -> list[Any] | None:
    """The changed numbers of a group, None for one that stays; None where all do."""
    values = asked.get(name)
    if values is not None and (not isinstance(values, list) or len(values) != count):
        raise InputError(f"{name}: expected a list of {count} numbers or nulls, got {shown(values)}")
    if values is None or not any(value is not None for value in values):
        return None
    return [None if value is None else number(value, name) for value in values]


def number(value: Any, name: str) -> str:
    """A decimal in text."""
    try:
        found = float(value) if isinstance(value, str) and len(value) <= LENGTH else math.nan
    except ValueError:
        found = math.nan
    if not math.isfinite(found):
        raise InputError(f"{name}: expected a number, got {shown(value)}")
    if found and not SMALLEST <= abs(found) <= LARGEST:
        raise InputError(f"{name}: expected 0 or a number of {SMALLEST:g} to {LARGEST:g}, which can still be drawn, got {value}")
    return f"{found:.12g}"


def _torque(asked: Any) -> tuple[float, ...]:
    axis = asked.get("axis") if isinstance(asked, dict) else None
    if type(axis) is not int or axis not in (1, 2, 3):  # neither true nor 1.0
        raise InputError(f"torque: expected an axis of 1, 2 or 3, got {shown(axis)}")
    return torque_of(axis, *(float(number(asked.get(name), name)) for name in ("size", "tilt", "azimuth")))
