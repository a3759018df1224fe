"""The sliders of the explorer, and the case that they changed, as the text of a case file.

What the page shows is always the answer for that very text, so a case that is saved is the one that was seen.
Numbers that no slider changed stay as the file has them. Sliders count along principal axes; where the file's
tensor is not diagonal, the new text stands along these.
"""
from __future__ import annotations

import math
from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from ...case.observed import plainly
from ...case.read import Case, read_text
from ...case.table import Written
from ...case.write import data_of, data_of_scene, exact_text, text_of
from ...errors import CaseError, InputError
from ...physics.scene import Scene
from ...verify.numbers import shown
from ..units import Units

# --- The sliders of a case: moments of inertia, torque and its tilt, wheel momentum, start, in the units
# of the case
ROOM = 2.5  # of the case's own number: how far a slider goes
TILTED = 10.0  # deg, the least length of the slider of a tilt
LARGER, SLENDER = 1.5, 100.0  # the largest moment of a slider: times that of the case, times its least
STILL = 0.05  # rad/s: a body that no number moves turns so fast on the sliders


def slider(name: str, text: str, unit: str, value: float, low: float, high: float, axis: int = 0
           ) -> dict[str, Any]:
    """One slider. name: as in a request; value, low, high: in its unit, the value with six digits at most, as
    a person reads it; text: for people, empty where it is named by its principal axis (1 to 3)."""
    return {"name": name, "words": text, "unit": unit, "value": float(f"{value:.6g}"), "low": low,
            "high": high, "axis": axis}


def groups(case: Case, units: Units) -> list[dict[str, Any]]:
    """The groups of sliders as a page takes them: {title, axis of the torque where it is its, controls}."""
    axis, size, tilt, azimuth = direction(vector(case, "torque"))
    torque = [slider("size", "size", units.of("N m")[0], size,
                      *_around(abs(size) or _usual_torque(case))),
              slider("tilt", "tilt off it", "deg", tilt, 0.0, nice(max(TILTED, ROOM * tilt))),
              slider("azimuth", "towards", "deg", azimuth, -180.0, 180.0)]
    if own := off_axes(case):  # about axes that the user did not write an angle would say little
        axis, torque = 0, _in_file(case, own, units)
    result = [("Torque along" if axis else "Torque, axes of the file", axis or None, torque),
             ("Wheel and moments" if units.scaled else "Wheel momentum about axis", None, _wheel(case)),
             ("Rates at the start", None, _start(case, units)),
             ("Moments of inertia about axis", None, _moments(case))]
    return [{"title": title, "axis": along, "controls": rows} for title, along, rows in result if rows]


def vector(case: Case, name: str) -> tuple[float, ...]:
    """The torque, wheel momentum or start along the principal axes, SI or scaled (the wheel: a and b)."""
    scene = case.scene
    if name == "start":
        return tuple(case.state or (0.0, 0.0, 0.0))
    if scene.variables == "scaled":
        return tuple(map(float, scene.mu)) if name == "torque" else (float(scene.a), float(scene.b))
    return tuple(map(float, scene.vector("constant_torque" if name == "torque" else "gyrostat")))


def off_axes(case: Case) -> tuple[Any, ...]:
    """A body's torque off its principal axes, which is set by its components in the file; () of any other."""
    own = case.scene.vector("constant_torque") if isinstance(case.scene, Scene) else ()
    return tuple(own) if sum(v != 0 for v in own) > 1 else ()


def _in_file(case: Case, own: tuple[Any, ...], units: Units) -> list[dict[str, Any]]:
    values = tuple(map(float, own if case.frame is None else case.frame.back(own)))
    low, high = _around(max(map(abs, values)))
    return [slider(f"torque{n}", letter, units.of("N m")[0], value, low, high)
            for n, (letter, value) in enumerate(zip("xyz", values), 1)]


def direction(torque: tuple[float, ...]) -> tuple[int, float, float, float]:
    """(axis 1 to 3 that it is nearest to, its size signed by its sense along that, tilt off it and azimuth of
    the tilt in deg)."""
    if not any(torque):
        return 3, 0.0, 0.0, 0.0
    i = max(range(3), key=lambda n: abs(torque[n]))
    j, k = (i + 1) % 3, (i + 2) % 3
    size = math.copysign(math.hypot(*torque), torque[i])
    across = math.hypot(torque[j], torque[k])
    azimuth = math.degrees(math.atan2(torque[k] / size, torque[j] / size)) if across else 0.0
    return i + 1, size, math.degrees(math.atan2(across, abs(torque[i]))), azimuth


def torque_of(axis: int, size: float, tilt: float, azimuth: float) -> tuple[float, ...]:
    """The inverse of `direction`: components are exactly zero at right angles."""
    (cos_t, sin_t), (cos_a, sin_a) = _turned(tilt), _turned(azimuth)
    out = [0.0] * 3
    for n, fraction in ((axis - 1, cos_t), (axis % 3, sin_t * cos_a), ((axis + 1) % 3, sin_t * sin_a)):
        out[n] = size * fraction
    return tuple(out)


def _turned(degrees: float) -> tuple[float, float]:
    quarter, rest = divmod(degrees, 90.0)
    if not rest:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[int(quarter) % 4]
    return math.cos(math.radians(degrees)), math.sin(math.radians(degrees))


def _moments(case: Case) -> list[dict[str, Any]]:
    """A moment may come to exceed the sum of the others: the page says then that no rigid body has it."""
    if not isinstance(case.scene, Scene):
        return []
    moments = case.scene.body.inertia
    high = nice(LARGER * max(moments))
    low = min(high / SLENDER, min(moments) / 2)
    return [slider(f"inertia{n}", "", "kg m²", value, low, high, n + 1) for n, value in enumerate(moments)]


def _wheel(case: Case) -> list[dict[str, Any]]:
    values = vector(case, "wheel")
    if not isinstance(case.scene, Scene):
        high = nice(ROOM * max(1.0, *map(abs, values)))
        return [slider(f"wheel{n}", "ab"[n], "", value, -high, high) for n, value in enumerate(values)]
    size = max(max(map(abs, values)),
               max(case.scene.body.inertia) * (math.hypot(*vector(case, "start")) or STILL) / ROOM)
    return [slider(f"wheel{n}", "", "N m s", value, *_around(size), n + 1) for n, value in enumerate(values)]


def _start(case: Case, units: Units) -> list[dict[str, Any]]:
    values = vector(case, "start")
    name, item = units.rates
    size = max(map(abs, values)) * item or (1.0 if units.scaled else STILL * item)
    phrases = [component.replace("omega", "ω") for component in case.scene.components]
    return [slider(f"start{n}", phrases[n], name, value * item, *_around(size))
            for n, value in enumerate(values)]


def _usual_torque(case: Case) -> float:
    """A torque for a case that has none: it changes the rates of the start within some radians of turn, and
    is no larger than that of the weight."""
    if not isinstance(case.scene, Scene):
        return 1.0
    rate = math.hypot(*vector(case, "start")) or STILL
    turning, weight = sum(case.scene.body.inertia) / 3 * rate * rate / 4, case.scene.vector("gravity")
    return min(turning, math.hypot(*map(float, weight))) if any(weight) else turning


def _around(size: float) -> tuple[float, float]:
    high = nice(ROOM * size)
    return -high, high


def nice(value: float) -> float:
    """The least of 1, 2, 3, 5, 8 times a power of ten that is not below the value."""
    ten = 10.0 ** math.floor(math.log10(value))
    return float(f"{next(n for n in (1, 2, 3, 5, 8, 10, 20) if n * ten >= value * (1 - 1e-12)) * ten:.6g}")


SPOKEN_FOR = ("expect", "sweep")  # tables that speak of the file's own numbers
LENGTH = 40  # letters of a number at most
SMALLEST = 1e-300  # but zero: what is drawn of smaller ones has fewer digits than doubles
LARGEST = 1e8  # beyond it doubles that are drawn run into overflows and lost digits; no body has such numbers


def changed(case: Case, query: dict[str, Any], units: Units) -> tuple[Case, str]:
    """(the case with the changes of a request, words on what was left out). query: {"torque": None, {axis,
    size, tilt, azimuth} or {file: three components along the axes of the file}, "inertia", "wheel" and
    "start": a number in text, or None for the case's own, for each slider}. Raises InputError for what is no
    such request."""
    scaled = case.scene.variables == "scaled"
    torque, inertia, start = query.get("torque"), _numbers(query, "inertia", 3), _numbers(query, "start", 3)
    wheel = _numbers(query, "wheel", 2 if scaled else 3)
    if all(item is None for item in (torque, inertia, wheel, start)) and case.state is not None:
        return case, ""
    base = _base(case)
    if inertia is not None:
        _set_inertia(base, case, inertia)
    if torque is not None:
        _set_torque(base, torque, case)
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
    text = f"The start is beyond the limit of the case, which is left out here. {left}".rstrip()
    return read_text(case.path, text_of(base, head)), text


def _left_out(case: Case, fires: bool) -> str:
    """What cannot be stated along principal axes; fires: whether thrusters still give the torque."""
    if case.frame is None or case.frame.as_given:
        return ""
    rows = [text for text,
             there in (("limits about the axes of the file",
                        case.limits is not None and case.limits.rates is not None),
                                        ("the misalignment of thrusters",
                                         fires and any(thruster.stuck and thruster.misalignment
                                                       for thruster in case.thrusters))) if there]
    return (f"Left out of a changed case, which stands along the principal axes: {' and '.join(rows)}."
            if rows else "")


def _base(case: Case) -> dict[str, Any]:
    """The data of the case to be changed, along principal axes."""
    data = {key: value for key, value in data_of(case.text).items() if key not in SPOKEN_FOR}
    scaled = case.scene.variables == "scaled"
    if not scaled and (case.frame is None or case.frame.as_given):
        return data | ({"motion": plainly(case, data["motion"], exact_text)} if case.observed else {})
    built = data_of_scene(case.scene, case.exact_state)
    if "motion" in built:
        built["motion"] |= _kept(data.get("motion", {}), *(("x", "tau") if scaled else ("span",)))
    if not scaled:
        built["body"] |= _kept(data["body"], "mass")
        for name in built.get("effects", {}).keys() - {"gyrostat", "constant_torque"}:
            built["effects"][name] = data["effects"][name]  # alike along all axes (`pictures.check`)
        if case.limits is not None and case.limits.rate is not None:
            built |= _kept(data, "limits")
    built |= _kept(data, "title", "source", "output")
    return _kept(built, "title", "source", "scaled", "body", "effects", "limits", "output", "motion")


def _kept(data: dict[str, Any], *keys: str) -> dict[str, Any]:
    return {key: data[key] for key in keys if key in data}


def _set_inertia(base: dict[str, Any], case: Case, values: list[Any]) -> None:
    if not isinstance(case.scene, Scene):
        raise InputError("inertia: scaled variables have no moments of inertia")
    if wrong := next((value for value in values if value is not None and not float(value) > 0), None):
        raise InputError(f"inertia: expected a number above 0, got {wrong}")
    old, supplied = base["body"], [exact_text(v) for v in case.scene.body.exact]
    base["body"] = {"inertia": [own if new is None else Written(new) for own, new in zip(supplied, values)],
                    **_kept(old, "mass", "centre_of_mass")}


def _set_torque(base: dict[str, Any], query: Mapping[str, Any], case: Case) -> None:
    scaled = case.scene.variables == "scaled"
    axis = query.get("axis") if isinstance(query, dict) else None
    if isinstance(query, dict) and "file" in query and not scaled:
        _set_body_torque(base, _from_file(query, case))
        return
    if type(axis) is not int or axis not in (1, 2, 3):  # neither true nor 1.0
        raise InputError(f"torque: expected an axis of 1, 2 or 3, got {shown(axis)}")
    torque = torque_of(axis, *(float(number(query.get(name), name)) for name in ("size", "tilt", "azimuth")))
    numbers = [Written(f"{v + 0.0:.12g}") for v in torque]
    if scaled:
        base["scaled"]["mu"] = numbers
        return
    _set_body_torque(base, numbers)


def _from_file(query: Mapping[str, Any], case: Case) -> list[Any]:
    """The components along the principal axes of a torque by those along the axes of the file; null: the
    case's own."""
    scene: Any = case.scene
    own = scene.vector("constant_torque")
    changed = _numbers(dict(query), "file", 3) or [None] * 3
    values = [old if new is None else Fraction(new)
              for old, new in zip(own if case.frame is None else case.frame.back(own), changed)]
    if case.frame is None or case.frame.as_given:
        return [exact_text(v) for v in values]
    return [Written(f"{float(v) + 0.0:.12g}") for v in case.frame.turned(values)]


def _set_body_torque(base: dict[str, Any], numbers: list[Any]) -> None:
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
    base.setdefault("effects",
                    {})["gyrostat"] = {"momentum": [exact_text(v) if new is None else Written(new) for v,
                                                    new in zip(own, values)]}


def _set_start(base: dict[str, Any], case: Case, values: list[Any], scaled: bool, units: Units) -> None:
    motion = base.setdefault("motion", {})
    key = "x" if scaled else "angular_velocity"
    own = motion.get(key) or [exact_text(Fraction(v)) for v in case.exact_state or (0, 0, 0)]
    unit = units.rates[0]
    motion[key] = [old if new is None else Written(new) if scaled or unit == "rad/s" else f"{new} {unit}"
                   for old, new in zip(own, values)]


def _numbers(request: dict[str, Any], name: str, count: int) -> list[Any] | None:
    """The changed numbers of a group, None for one that stays; None where all do."""
    values = request.get(name)
    if values is not None and (not isinstance(values, list) or len(values) != count):
        raise InputError(f"{name}: expected a list of {count} numbers or nulls, got {shown(values)}")
    if values is None or not any(value is not None for value in values):
        return None
    return [None if value is None else number(value, name) for value in values]


def number(value: str | int, name: str) -> str:
    """A decimal in text."""
    try:
        result = float(value) if isinstance(value, str) and len(value) <= LENGTH else math.nan
    except ValueError:
        result = math.nan
    if not math.isfinite(result):
        raise InputError(f"{name}: expected a number, got {shown(value)}")
    if result and not SMALLEST <= abs(result) <= LARGEST:
        raise InputError(
            f"{name}: expected 0 or a number of {SMALLEST:g} to {LARGEST:g}, which can still be drawn, got "
            f"{value}")
    return f"{result:.12g}"
