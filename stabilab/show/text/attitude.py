"""How a motion turns in space: as text and as JSON."""
from __future__ import annotations

from ...representation import values_of
from .. import frame, limiting
from ..units import DIGITS, SHORT, Units, number, vector
from .motion import reason, row

HEADS = {"long-axis": "LONG-AXIS MODE", "short-axis": "SHORT-AXIS MODE", "separatrix": "ON THE SEPARATRIX",
         "steady": "STEADY ROTATION", "heavy top": "HEAVY TOP"}


def as_dict(answered) -> dict:
    """The object of `stabilab attitude --json`: a row a case, vectors in the frame of the file, s and rad."""
    return {"schema": "stabilab.attitude/1",
            "rows": [{"case": case.name} | row_of(case, found) for case, found in answered]}


def row_of(case, one) -> dict:
    """One motion; null is what it does not have."""
    return {"at": one.at, "fate": one.fate.word,
            **values_of(one, "rotation_period precession_period mode momentum"),
            "momentum_direction": in_file(case, one.momentum_direction),
            **values_of(one, "cone lean nutation_period turn_angle"),
            "turn_axis": in_file(case, one.turn_axis),
            **values_of(one, "error decimals because")} | limiting.key(case, one.caveats)


def in_file(case, along):
    """A vector along the principal axes in the frame of the file."""
    return frame.back(case, along) or along


def text(case, found, units: Units) -> str:
    """The answer first, then the numbers and why."""
    condition = limiting.condition(found.caveats, units)
    lines = [f"{case.name}: {', '.join(_answer(found, units))}{',' * bool(condition)}{condition}"]
    if found.momentum_direction is not None:
        lines.append(row("angular momentum", f"{number(found.momentum, DIGITS)} N m s along "
                                             f"{_vector(case, found.momentum_direction)}"))
    if found.cone is not None:
        low, high = (units.angle(angle) for angle in found.cone)
        named = (found.mode or "").partition("-")[0]
        lines.append(row("cone", f"{low} to {high} between it and the {named} axis"))
    if found.lean is not None:
        low, high = (units.angle(angle) for angle in found.lean)
        lines.append(row("lean", f"{low} to {high} from the upward vertical" if low != high else
                         f"{low} from the upward vertical, always"))
    if found.turn_angle is not None:
        about = f" about {_vector(case, found.turn_axis)}" if found.turn_axis else ""
        lines.append(row("turn after one period", units.angle(found.turn_angle) + about))
    for name, digits in (found.decimals or {}).items():
        lines.append(row(name.replace("_", " "), f"{digits} s"))
    if found.error is not None and found.decimals is None:
        lines.append(row("relative error", f"at most {found.error:.0e}"))
    words = "\n".join([*lines, f"why: {reason(found.because, units)}", *frame.note(case)])
    return limiting.noted(found.caveats, words, units)


def rows(found, units: Units) -> list[tuple[str, str]]:
    """(name, words) of the periods, for the lines of another answer; "found" None: nothing."""
    if found is None:
        return []
    times = (("rotation period", found.rotation_period), ("precession period", found.precession_period))
    return [*([("mode", found.mode)] if found.mode else []),
            *((name, units.time(time)) for name, time in times if time is not None)]


def _answer(found, units):
    yield HEADS.get(found.mode, "ROTATION PERIOD KNOWN" if found.rotation_period else "NO ROTATION PERIOD")
    if found.lean is not None:
        low, high = (units.angle(angle, SHORT) for angle in found.lean)
        yield f"leaning by {low} to {high}" if low != high else f"leaning by {low}"
    if found.rotation_period is not None:
        yield f"rotation period {units.time(found.rotation_period)}"
    if found.nutation_period is not None:
        yield f"nutation period {units.time(found.nutation_period)}"
    if found.precession_period is not None:
        yield f"mean precession period {units.time(found.precession_period)}"
    elif found.nutation_period is not None:
        yield "no precession, for its axis passes through the vertical"


def _vector(case, along) -> str:
    place = "in the frame of the file" if frame.back(case, along) else "along axes 1, 2, 3"
    return f"{vector(in_file(case, along))} {place}"
