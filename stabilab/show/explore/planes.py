"""The two flat pictures of a page: the phase plane, and the rates over time."""
from __future__ import annotations

import math
from typing import Any

from ...case.read import Case
from ...errors import InputError
from ...orbit.result import Motion
from ...physics.scene import AnyScene
from ...verify.numbers import shown
from ..units import Units
from .bag import Bag
from .plane import plane_of

DIGITS = 9  # of a start that was clicked


def drawn(bag: Bag, scene: AnyScene, state: tuple[float, ...], units: Units) -> dict[str, Any] | None:
    """What the page needs of the phase plane: it draws each level curve W^2/2 + V = E itself. None where the motion has none."""
    plane = plane_of(scene, state)
    if plane is None:
        return None
    angle, rate = (("", 1.0), ("", 1.0)) if units.scaled else (units.angles, units.rates)
    across = plane.unit * angle[1]
    zero = plane.rate(0.0) * rate[1]
    axis = plane.reduction.axis + 1
    name = "x" if units.scaled else "ω"
    rests = [{"at": across * y, "height": v, "saddle": saddle} for y, v, saddle in plane.rests]
    return {"turns": bag.add("float32", [across * y for y in plane.y]), "heights": bag.add("float32", plane.heights),
            "rate": [zero, plane.rate(1.0) * rate[1] - zero], "start": plane.W0, "energy": plane.W0**2 / 2, "rests": rests,
            "rotates": plane.reduction.sense == 0 and not plane.reduction.geometry.walled,
            "x": labelled(f"turn about {units.axes.short(axis)}", angle[0]), "y": labelled(f"{name}{axis}", rate[0])}


def labelled(words: str, unit: str) -> str:
    """A label with its unit, where it has one."""
    return f"{words} ({unit})" if unit else words


def clicked(scene: AnyScene, state: tuple[float, ...], at: Any, units: Units) -> list[str]:
    """The start, in the unit of the sliders, of the motion through a point {turn, rate} of the phase plane of a state, in the units of the page."""
    plane = plane_of(scene, state)
    try:
        turn, rate = float(at["turn"]), float(at["rate"])
    except (KeyError, OverflowError, TypeError, ValueError):
        raise InputError(f"click: expected a turn and a rate, got {shown(at)}") from None
    if plane is None or not (math.isfinite(turn) and math.isfinite(rate)):
        raise InputError("click: this motion has no phase plane")
    angle = 1.0 if units.scaled else units.angles[1]
    one = units.rates[1]
    return [f"{v * one + 0.0:.{DIGITS}g}" for v in plane.state(turn / angle, rate / one)]


def over_time(bag: Bag, case: Case, motion: Motion | None, times: list[float], path: list[tuple[float, ...]], units: Units) -> dict[str, Any]:
    """Rates over time with the least and greatest of each component over all time, where these are known."""
    name, one = units.times(times[-1])
    label, rate = units.rates
    symbol = "x" if units.scaled else "ω"
    known = motion is not None and motion.extremes is not None and motion.extremes_over == "all time"
    extremes = [[v * rate for v in pair] for pair in motion.extremes] if known and motion is not None and motion.extremes is not None else None
    return {"times": bag.add("float32", [t * one for t in times]), "rates": [bag.add("float32", [x[n] * rate for x in path]) for n in range(3)],
            "extremes": extremes, "period": None if motion is None or motion.period is None else motion.period * one,
            "x": "time τ" if units.scaled else labelled("time", name), "y": labelled("x" if units.scaled else "rate", label),
            "names": [f"{symbol}{n}" for n in (1, 2, 3)]}
