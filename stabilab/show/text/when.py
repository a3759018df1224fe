"""When a limit is reached, in words, JSON and CSV: the answer first, in the units of engineers."""
from __future__ import annotations

import math

from ...errors import printable
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
