"""When a limit is reached, in words, JSON and CSV: the answer first, in the units of engineers; what a tilt of the torque does to a bounded motion."""
from __future__ import annotations

import math

from ...errors import printable
from ...physics.alignment import torque_axis
from ..files import comma
from . import frame
from .engineering import ENGINEERING, SI, bracket, number

CSV = ("case", "quantity", "limit", "time_low", "time_high", "level")


def as_dict(case, limit, found) -> dict:
    """One object of `stabilab when --json`: SI units. time: [low, high], null where it is never reached or not known; reached: "yes", "never" or
    "unknown"; not_before: the limit is not reached before, null where it never is."""
    low, high = float(found.low), float(found.high)
    known = math.isfinite(high)
    return {"schema": "stabilab.when/1", "case": case.name, "variables": case.variables, "kind": limit.kind, "quantities": list(limit.names),
            "limits": list(limit.limits), "reached": _reached(low, high), "time": [low, high] if known else None,
            "not_before": low if math.isfinite(low) else None, "level": str(found.level), "because": str(found.words)} | frame.key(case)


def csv(answers) -> str:
    """A line a case, SI units: inf where the limit is never reached, an empty upper end where it is not known."""
    rows = [(case.name, "/".join(limit.names), "/".join(map(repr, limit.limits)), *(None if math.isnan(v) else float(v) for v in (found.low, found.high)),
             str(found.level)) for case, limit, found in answers]
    return comma.lines([CSV, *rows])[:-1]


def text(case, limit, found, si: bool = False) -> str:
    """The answer in one line, then its two ends with all digits and the reason."""
    units = SI if si else ENGINEERING
    low, high, unit = float(found.low), float(found.high), case.scene.time_unit
    lines = [f"{printable(case.name)}: {_answer(case, limit, found, low, high, units)}"]
    if math.isfinite(high):
        lines += [f"  between   {low!r} {unit}", f"      and   {high!r} {unit}"]
    return "\n".join([*lines, f"  {found.words}"])


def unknown(found) -> bool:
    """Whether the limit may be reached at a time that is not known."""
    return _reached(float(found.low), float(found.high)) == "unknown"


def _reached(low, high):
    return "yes" if math.isfinite(high) else "never" if math.isinf(low) else "unknown"


def _answer(case, limit, found, low, high, units):
    asked = _asked(case, limit, units)
    if math.isinf(low):
        return f"NEVER reaches {asked} ({found.level})"
    name, one = ("tau", 1.0) if case.variables == "scaled" else units.time
    if math.isnan(high):
        return f"NOT KNOWN when it reaches {asked}: not before {number(low * one, 6)} {name} ({found.level})"
    if high == 0:
        return f"starts at or beyond {asked}"
    a, b = bracket(low * one, high * one)
    return f"reaches {asked} in {number((low + high) / 2 * one)} {name} ({found.level} {a} to {b})"


def _asked(case, limit, units):
    unit, one = {"energy": ("J", 1.0), "tilt": units.angle}.get(limit.kind, ("", 1.0) if case.variables == "scaled" else units.rate)
    return " or ".join(f"{name} = {number(most * one, 6)} {unit}".rstrip() for name, most in zip(limit.names, limit.limits))


def while_on_axis(case, motion) -> str:
    """What the word "bounded" rests on under a torque along an axis, and what is known of a tilt; empty for other motions."""
    axis = torque_axis(case.scene) if motion.fate.word == "bounded" else 0
    if not axis:
        return ""
    words, found = f"while {'mu' if case.variables == 'scaled' else 'the torque'} is exactly along axis {axis}", motion.tilt
    if found is None:
        return f" {words}"
    if found.untilted:
        return f" {words}, and even so it reaches {number(found.limit, 6)} rad/s after {number(found.untilted[0], 6)} s"
    if found.ends:
        return f" only {words}: tilted by {_degrees(found.angle)} it reaches {number(found.limit, 6)} rad/s after {number(found.low, 6)} s"
    return f" {words}; tilted by {_degrees(found.angle)} it was not found to reach {number(found.limit, 6)} rad/s within {number(found.followed)} s"


def tilt_lines(case, motion) -> list[str]:
    """The tilt in full, or how to ask for it."""
    found = motion.tilt
    if found is None:
        asked = case.variables != "scaled" and while_on_axis(case, motion)
        return ['  off that axis           any tilt of the torque may end this: --tilt "1 deg" says how soon'] if asked else []
    limit = f"|omega| = {number(found.limit, 9)} rad/s{'' if found.stated else ', twice the largest of this motion (no limit is stated)'}"
    lines = [f"  tilted by {_degrees(found.angle)}: {printable(found.of)}, to {limit}"]
    if found.ends:
        lines.append(f"    shortest time found   {found.low:.12g} to {found.high:.12g} s ({found.level}), at azimuth {_degrees(found.azimuth)}, torque "
                     f"({', '.join(f'{v:.9g}' for v in found.torque)}) N m")
    else:
        lines.append(f"    shortest time found   none: {len(found.times)} azimuths were followed for {number(found.followed, 6)} s or more")
    return [*lines, f"    not before            {found.not_before:.9g} s, whatever the azimuth and for any smaller tilt (proved)"]


def tilt_dict(found) -> dict | None:
    """The key "tilt" of a motion in JSON: SI units."""
    if found is None:
        return None
    return {"angle": found.angle, "of": found.of, "limit": found.limit, "limit_stated": found.stated, "not_before": found.not_before,
            "time": [found.low, found.high] if found.ends else None, "level": found.level if found.ends else None, "azimuth": found.azimuth,
            "torque": found.torque, "azimuths": found.azimuths, "times": found.times, "untilted": found.untilted}


def _degrees(angle) -> str:
    return f"{number(math.degrees(angle), 6)} deg"
