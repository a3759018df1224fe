"""How a motion that loses energy ends, and when, in text and JSON."""
from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from .frame import back
from .units import SHORT, Units, number

if TYPE_CHECKING:
    from ..answers.dissipation.ending import Ending
    from ..case.read import Case

BY_RUN = " (by a run)"  # behind an end that a run alone shows
ENDING_HEADS = {"flat spin": "FLAT SPIN", "nutation dies out": "NUTATION DIES OUT", "rest": "COMES TO REST",
         "rotation about the field": "TENDS TO ROTATION ABOUT THE FIELD",
         "steady rotation": "TENDS TO STEADY ROTATION"}


def words(x: Ending | None, units: Units, short: bool = False) -> tuple[str, str] | None:
    """(how it ends; about which axis and how fast, and how well that is known); None where nothing is lost,
    or no end is known. short: without how fast."""
    if x is None or x.kind == "undecided":
        return None
    speed = "" if short else rate(x, units)
    speed = f"{',' * bool(speed and about(x, units))}{' ' * bool(speed)}{speed}"
    if x.kind == "steady rotation" and not x.rates and x.axis:
        return "TENDS TO A CIRCLE OF ROTATIONS", f" about {units.axes.short(x.axis)}{speed.lstrip(',')}"
    resolved = BY_RUN * (x.level == "run" and x.kind in ("steady rotation", "rest"))
    return ENDING_HEADS[x.kind], f"{about(x, units)}{speed}{resolved}"


def rate(x: Ending | None, units: Units) -> str:
    """How fast it turns in the end: "at 5 deg/s", or "at (1, 2, 3) deg/s"; empty where it has no end that
    turns."""
    if x is None or x.kind == "undecided":
        return ""
    if x.kind == "steady rotation" and x.rates:
        apart = f", its mass at {number(x.displacement, SHORT)} m" if x.displacement else ""
        return f"at {units.vector(units.axes.in_file(x.rates), units.rates, SHORT)}{apart}"
    return f"at {units.rate(x.rate, SHORT)}" if x.rate else ""


def about(item: Ending, units: Units) -> str:
    """About which axis it ends turning, in which direction; empty at rest and where it has no axis."""
    if not item.axis:
        return f" about an axis across {units.axes.name(item.minor)}" if item.minor else ""
    name = units.axes.name(item.axis)
    if item.sense:
        return f" about {'+' if item.sense > 0 else '-'}{name}"
    return f" about +{name} or -{name}"


def when(one: Ending | None, units: Units) -> str:
    """The times of an end, empty where there is none."""
    return "" if one is None or one.kind == "undecided" else ", ".join(_times(one, units))


def first(item: Ending, units: Units) -> tuple[str, str]:
    """(the time by which it has ended, all times in words) of a page at a glance."""
    value = (units.time(item.until, SHORT) if item.until is not None else
             f"about {units.time(item.estimate, 2)}" if item.estimate is not None else "not known")
    return value, when(item, units) or units.said(item.reason)


def _times(item: Ending, units: Units) -> list[str]:
    nearby = (units.angle(item.within, SHORT) if item.minor or item.angular else
              f"{100 * item.within:g} %")
    end = (f"below {nearby}" if item.nutation is not None else
           f"{nearby} of its rate" if item.kind == "rest" else f"within {nearby} of it")
    printed = {"leaves": f"nutation over {nearby}", "crosses": "separatrix crossed", "settles": end,
            "tenth": f"a tenth of {'its departure' if item.angular else 'that'} at the start"}
    parts = [] if item.nutation is None else [f"nutation {units.angle(item.nutation, SHORT)} at the start"]
    parts += [f"{printed[name]} after {units.time(time.at, SHORT)}" for name, time in item.times]
    if not dict(item.times) and item.estimate is not None:
        parts.append(f"{printed['settles']} after about {units.time(item.estimate, 2)}, at its first pace")
    if not dict(item.times) and item.at_the_latest is not None:
        latest = units.time(item.at_the_latest, SHORT, 1)
        parts.append(f"{printed['settles']} after {latest} at the latest (proved)")
    if item.angular and not dict(item.times) and item.decay is not None:
        parts.append(f"a departure decays e-fold in {units.time(item.decay, SHORT)}")
    if item.minor and "settles" not in dict(item.times) and "tenth" not in dict(item.times):
        resolved = item.decay if item.nutation is not None else item.growth
        verb = "falls" if item.nutation is not None else "grows"
        parts += [] if resolved is None else [f"nutation {verb} e-fold in {units.time(resolved, SHORT)}"]
    return parts


def constants(item: Ending | None, units: Units) -> str:
    """The time constants of the end in words, each once; empty where none are known."""
    printed = []
    for constant in () if item is None else item.constants:
        about = (f" about {units.axes.name(constant.axis)} across the field" if constant.axis else
                 f" turning at {units.rate(constant.turns, SHORT)}" if constant.turns else "")
        printed.append(f"{units.time(constant.time, SHORT)}{about}")
    return ", ".join(dict.fromkeys(printed))


COLUMNS = ("ending", "ending_time")  # of a CSV


def beside(rows: Sequence[Sequence[Any]], ends: Sequence[Ending | None]) -> list[tuple[Any, ...]]:
    """The rows of a CSV, below a head, with two columns more where something loses energy: how a motion ends,
    and by when, s; empty where it loses nothing or it is not known."""
    head, *others = rows
    if not any(ends):
        return [tuple(row) for row in rows]
    cells = [(None, None) if end is None else (end.kind, end.until) for end in ends]
    return [(*head, *COLUMNS), *((*row, *more) for row, more in zip(others, cells))]


def line(item: Ending | None, units: Units) -> str:
    """All of it in a sentence; empty where nothing is lost."""
    if item is None:
        return ""
    if (result := words(item, units)) is None:
        return units.said(item.reason)
    return "; ".join(filter(None, ("".join(result), when(item, units))))


def key(case: Case, item: Ending | None) -> dict[str, Any]:
    """The key "ending" of a JSON object: null where nothing takes energy; SI units, rates in the frame of the
    file, times as [s, error in s], null where past at the start or not reached."""
    if item is None:
        return {"ending": None}
    times = dict(item.times)
    info = {name: [times[name].at, times[name].error] if name in times else None
             for name in ("leaves", "crosses", "settles", "tenth")}
    return {"ending": {
        "kind": item.kind, "level": item.level, "because": item.because,
        "reason": item.reason.as_dict(), "axis": item.axis or None,
        "sense": item.sense or None, "rate": item.rate,
        "rates": item.rates and (back(case, item.rates) or list(item.rates)), "within": item.within, **info,
        "displacement": item.displacement,
        "nutation": item.nutation, "growth_time": item.growth, "decay_time": item.decay,
        "at_the_latest": item.at_the_latest, "estimate": item.estimate,
        "time_constants": [{"time": constant.time, "turns": constant.turns, "axis": constant.axis or None}
                           for constant in item.constants]}}


