"""How a motion that loses energy ends, and when, in text and JSON."""
from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from .frame import back
from .units import SHORT, Units

if TYPE_CHECKING:
    from ..answers.dissipation.ending import Ending
    from ..case.read import Case

ENDING_HEADS = {"flat spin": "FLAT SPIN", "nutation dies out": "NUTATION DIES OUT", "rest": "COMES TO REST",
         "rotation about the field": "TENDS TO ROTATION ABOUT THE FIELD",
         "steady rotation": "TENDS TO STEADY ROTATION"}


def words(one: Ending | None, units: Units) -> tuple[str, str] | None:
    """(how it ends; about which axis and how fast, and how well that is known); None where nothing is lost,
    or no end is known."""
    if one is None or one.kind == "undecided":
        return None
    rate = "" if not one.rate else f" at {units.rate(one.rate, SHORT)}"
    known = " (by a run)" * (one.level == "run" and one.kind in ("steady rotation", "rest"))
    if one.kind == "steady rotation" and one.rates:
        rate = f" at {units.vector(units.axes.in_file(one.rates), units.rates, SHORT)}"
    return ENDING_HEADS[one.kind], f"{about(one, units)}{',' * bool(rate and about(one, units))}{rate}{known}"


def about(one: Ending, units: Units) -> str:
    """About which axis it ends turning, in which direction; empty at rest and where it has no axis."""
    if not one.axis:
        return f" about an axis across {units.axes.name(one.minor)}" if one.minor else ""
    name = units.axes.name(one.axis)
    if one.sense:
        return f" about {'+' if one.sense > 0 else '-'}{name}"
    return f" about +{name} or -{name}"


def when(one: Ending | None, units: Units) -> str:
    """The times of an end, empty where there is none."""
    return "" if one is None or one.kind == "undecided" else ", ".join(_times(one, units))


def first(one: Ending, units: Units) -> tuple[str, str]:
    """(the time by which it has ended, all times in words) of a page at a glance."""
    value = (units.time(one.until, SHORT) if one.until is not None else
             f"about {units.time(one.estimate, 2)}" if one.estimate is not None else "not known")
    return value, when(one, units) or units.said(one.reason)


def _times(one: Ending, units: Units) -> list[str]:
    near = units.angle(one.within, SHORT) if one.minor else f"{100 * one.within:g} %"
    end = (f"below {near}" if one.nutation is not None else
           f"{near} of its rate" if one.kind == "rest" else f"within {near} of it")
    told = {"leaves": f"nutation over {near}", "crosses": "separatrix crossed", "settles": end,
            "tenth": "a tenth of that at the start"}
    parts = [] if one.nutation is None else [f"nutation {units.angle(one.nutation, SHORT)} at the start"]
    parts += [f"{told[name]} after {units.time(time.at, SHORT)}" for name, time in one.times]
    if not dict(one.times) and one.estimate is not None:
        parts.append(f"{told['settles']} after about {units.time(one.estimate, 2)}, at its first pace")
    if not dict(one.times) and one.at_the_latest is not None:
        latest = units.time(one.at_the_latest, SHORT, 1)
        parts.append(f"{told['settles']} after {latest} at the latest (proved)")
    if one.minor and "settles" not in dict(one.times) and "tenth" not in dict(one.times):
        known = one.decay if one.nutation is not None else one.growth
        verb = "falls" if one.nutation is not None else "grows"
        parts += [] if known is None else [f"nutation {verb} e-fold in {units.time(known, SHORT)}"]
    return parts


COLUMNS = ("ending", "ending_time")  # of a CSV


def beside(rows: Sequence[Sequence[Any]], ends: Sequence[Ending | None]) -> list[tuple[Any, ...]]:
    """The rows of a CSV, below a head, with two columns more where something loses energy: how a motion ends,
    and by when, s; empty where it loses nothing or it is not known."""
    head, *others = rows
    if not any(ends):
        return [tuple(row) for row in rows]
    cells = [(None, None) if one is None else (one.kind, one.until) for one in ends]
    return [(*head, *COLUMNS), *((*row, *more) for row, more in zip(others, cells))]


def line(one: Ending | None, units: Units) -> str:
    """All of it in a sentence; empty where nothing is lost."""
    if one is None:
        return ""
    if (found := words(one, units)) is None:
        return units.said(one.reason)
    return "; ".join(filter(None, ("".join(found), when(one, units))))


def key(case: Case, one: Ending | None) -> dict[str, Any]:
    """The key "ending" of a JSON object: null where nothing takes energy; SI units, rates in the frame of the
    file, times as [s, error in s], null where past at the start or not reached."""
    if one is None:
        return {"ending": None}
    times = dict(one.times)
    known = {name: [times[name].at, times[name].error] if name in times else None
             for name in ("leaves", "crosses", "settles", "tenth")}
    return {"ending": {
        "kind": one.kind, "level": one.level, "because": one.because,
        "reason": one.reason.as_dict(), "axis": one.axis or None,
        "sense": one.sense or None, "rate": one.rate,
        "rates": one.rates and (back(case, one.rates) or list(one.rates)), "within": one.within, **known,
        "nutation": one.nutation, "growth_time": one.growth, "decay_time": one.decay,
        "at_the_latest": one.at_the_latest, "estimate": one.estimate}}


