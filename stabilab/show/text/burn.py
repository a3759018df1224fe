"""What a burn leaves and by when it must close: as text and as JSON."""
from __future__ import annotations

import math

from ...representation import values_of
from .. import limiting
from ..units import DIGITS, Units, bracket, number, vector
from .attitude import in_file
from .motion import reason, row
from .when import reached

SHOWN = 12  # switches in text; JSON has them all


def as_dict(case, found) -> dict:
    """The object of `stabilab burn --json`: SI units, vectors in the frame of the file."""
    return {"schema": "stabilab.burn/1", "case": case.name, "thrusters": found.thrusters,
            "switches": [{"time": one.time, "firing": one.firing,
                          "torque": in_file(case, one.torque), "rates": in_file(case, one.rates)}
                         for one in found.switches],
            "closed": _closed(case, found.closed), "latest": _latest(found.latest),
            "closed_latest": _closed(case, found.closed_latest)} | limiting.key(case, found.caveats)


def _closed(case, one) -> dict | None:
    if one is None:
        return None
    turn = one.attitude
    return {"time": one.time, "rates": in_file(case, one.rates), "error": one.error,
            "momentum": in_file(case, one.momentum), "energy": one.energy,
            "largest_rate": one.largest_rate, "largest_rate_before": one.largest_before,
            "fate": one.motion.fate.word, "because": one.motion.because,
            "mode": turn and turn.mode, "rotation_period": turn and turn.rotation_period,
            "precession_period": turn and turn.precession_period,
            "fired": one.fired, "propellant_used": one.used}


def _latest(one) -> dict | None:
    """time: [low, high], null where no closing is too late or it is not known; not_before: any closing up to
    then is early enough, null where all are; surely: as of `Latest`, its second null where not known."""
    if one is None:
        return None
    return {"limit": one.limit, "reached": reached(one.low, one.high),
            "time": [one.low, one.high] if math.isfinite(one.high) else None, "not_before": one.low,
            **values_of(one, "level because again surely")}


def text(case, found, units: Units) -> str:
    """The answer first, then what is left, the switches and why."""
    lines = [f"{case.name}: {_headline(found, units)}"]
    if found.latest is not None:
        lines += _of_latest(found, units)
    lines += _of_closed(case, found, found.closed, units)
    for one in found.switches[:SHOWN]:
        firing = ", ".join(one.firing) or "none"
        lines.append(row(units.moment(one.time), f"firing: {firing}; rates "
                                                 f"{units.vector(_seen(case, one.rates), units.rates)}"))
    if len(found.switches) > SHOWN:
        lines.append(row("", f"and {len(found.switches) - SHOWN} more switches, in --json"))
    words = "\n".join([*lines, f"why: {reason(found.closed.motion.because, units)}"])
    return limiting.noted(found.caveats, words, units)


def _headline(found, units: Units) -> str:
    one, latest = found.closed, found.latest
    if latest is None:
        after = ("largest rate not known" if one.largest_rate is None
                 else f"never above {units.rate(one.largest_rate)}")
        return f"CLOSED at {units.moment(one.time)}, then {one.motion.fate.word.upper()}, {after}"
    aim = f"|ω| below {units.rate(latest.limit)}"
    if math.isinf(latest.low):
        return f"NO CLOSING IS TOO LATE for {aim} ({latest.level})"
    if math.isnan(latest.high):
        return f"NOT KNOWN by when to close for {aim}: up to {units.time(latest.low)} it is early enough"
    if not latest.high:
        return f"TOO LATE AT THE START for {aim}: the motion before the burn reaches it already"
    name, size = units.times(latest.high)
    low, high = bracket(latest.low * size, latest.high * size)
    return (f"CLOSE BY {low} {name} to keep {aim} "
            f"({latest.level} {low} to {high})")


def _of_latest(found, units: Units):
    latest, early = found.latest, found.closed_latest
    if early is not None:
        yield row("closed then", f"{_turning(early, units)}; largest rate before "
                                 f"{_rate(early.largest_before, units)}")
    if latest.surely is not None:
        early_enough, late = latest.surely
        yield row("bounded by", f"early enough up to {units.time(early_enough)}"
                  + (f", too late from {units.time(late)} on" if math.isfinite(late) else ""))
    for begin, end in latest.again:
        yield row("below it again", f"closed between {units.time(begin)} and {units.time(end)} (seen at 2000 "
                                    "times, no proof)")


def _rate(value, units: Units) -> str:
    return "not known" if value is None else units.rate(value)


def _turning(one, units: Units) -> str:
    """What follows, in a line."""
    parts = [one.motion.fate.word]
    if one.largest_rate is not None:
        parts.append(f"largest rate for ever {units.rate(one.largest_rate)}")
    if one.attitude is not None and one.attitude.mode:
        parts.append(f"{one.attitude.mode} mode" if "axis" in one.attitude.mode else one.attitude.mode)
    return ", ".join(parts)


def _of_closed(case, found, one, units: Units):
    yield row("last closing", units.time(one.time))
    yield row("rates then", f"{units.vector(_seen(case, one.rates), units.rates)}, known to "
                            f"{units.rate(one.error, 2)}")
    yield row("angular momentum", f"{number(math.hypot(*one.momentum), DIGITS)} N m s, "
                                  f"{vector(_seen(case, one.momentum))}")
    yield row("energy", units.energy(one.energy))
    yield row("largest rate before", _rate(one.largest_before, units))
    yield row("after it", _turning(one, units))
    for name, fired, used in zip(found.thrusters, one.fired, one.used):
        if fired is None:
            continue
        mass = "" if used is None else f", {number(used, DIGITS)} kg of propellant"
        yield row(name, f"fired {units.time(fired)}{mass}")


def _seen(case, along):
    """A vector in the frame of the file, 0 where a component is only the rounding of the others."""
    values = in_file(case, along)
    least = 4 * math.ulp(max(map(abs, values)))
    return [float(v) if abs(v) > least else 0.0 for v in values]
