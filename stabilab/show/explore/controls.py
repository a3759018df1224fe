"""The sliders of a case: torque and its tilt, wheel momentum, start, in the units in which the case is told."""
from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any

from ...case.read import Case
from ...physics.scene import Scene
from ..units import Units

ROOM = 2.5  # of the case's own number: how far a slider goes
TILTED = 10.0  # deg, the least length of the slider of a tilt
STILL = 0.05  # rad/s: a body that no number moves turns so fast on the sliders


@dataclass(frozen=True)
class Control:
    """One slider. name: as in a request; value, low, high: in its unit; words: for people."""

    name: str
    words: str
    unit: str
    value: float
    low: float
    high: float


def groups(case: Case, units: Units) -> list[dict[str, Any]]:
    """The groups of sliders as a page takes them: {title, axis of the torque where it is of that, controls}."""
    axis, size, tilt, azimuth = direction(vector(case, "torque"))
    strength = Control("size", f"about {units.axes.short(axis)}", units.plain("N m")[0], size, *_around(abs(size) or _torque(case)))
    torque = [strength, Control("tilt", "tilt off the axis", "deg", tilt, 0.0, nice(max(TILTED, ROOM * tilt))),
              Control("azimuth", "towards", "deg", azimuth, -180.0, 180.0)]
    return [{"title": "Torque", "axis": axis, "controls": _plain(torque)},
            {"title": "Wheel momentum" if not units.scaled else "Wheel and moments", "axis": None, "controls": _plain(_wheel(case, units))},
            {"title": "Start", "axis": None, "controls": _plain(_start(case, units))}]


def vector(case: Case, name: str) -> tuple[float, ...]:
    """The torque, the wheel momentum or the start, principal axes, SI or scaled; a and b stand for the wheel of a scaled case."""
    scene = case.scene
    if name == "start":
        return tuple(case.state or (0.0, 0.0, 0.0))
    if scene.variables == "scaled":
        return tuple(map(float, scene.mu)) if name == "torque" else (float(scene.a), float(scene.b))
    return tuple(map(float, scene.vector("constant_torque" if name == "torque" else "gyrostat")))


def direction(torque: tuple[float, ...]) -> tuple[int, float, float, float]:
    """(axis 1 to 3 that it is nearest to, its size signed by its sense along that, tilt off it and azimuth of the tilt in deg)."""
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
    for n, share in ((axis - 1, cos_t), (axis % 3, sin_t * cos_a), ((axis + 1) % 3, sin_t * sin_a)):
        out[n] = size * share
    return tuple(out)


def _turned(degrees: float) -> tuple[float, float]:
    quarter, rest = divmod(degrees, 90.0)
    if not rest:
        return ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[int(quarter) % 4]
    return math.cos(math.radians(degrees)), math.sin(math.radians(degrees))


def _wheel(case: Case, units: Units) -> list[Control]:
    values = vector(case, "wheel")
    if not isinstance(case.scene, Scene):
        high = nice(ROOM * max(1.0, *map(abs, values)))
        return [Control(f"wheel{n}", name, "", value, -high, high) for n, (name, value) in enumerate(zip("ab", values))]
    size = max(max(map(abs, values)), max(case.scene.body.inertia) * (math.hypot(*vector(case, "start")) or STILL) / ROOM)
    return [Control(f"wheel{n}", f"about {units.axes.short(n + 1)}", "N m s", value, *_around(size)) for n, value in enumerate(values)]


def _start(case: Case, units: Units) -> list[Control]:
    values = vector(case, "start")
    name, one = units.rates
    size = max(map(abs, values)) * one or (1.0 if units.scaled else STILL * one)
    words = [component.replace("omega", "ω") for component in case.scene.components]
    return [Control(f"start{n}", words[n], name, value * one, *_around(size)) for n, value in enumerate(values)]


def _torque(case: Case) -> float:
    """A torque for a case that has none: it changes the rates of the start within some radians of turn, and is no larger than that of the weight."""
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


def _plain(controls: list[Control]) -> list[dict[str, Any]]:
    """With six digits at most, as a person reads a slider; the case keeps all of its own."""
    return [asdict(one) | {"value": float(f"{one.value:.6g}")} for one in controls]
