"""Stuck thrusters and burns in words, JSON and CSV: the answer first, in the units of engineers."""
from __future__ import annotations

import math
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal

from ...errors import printable
from ...orbit.result import HEADS, OUTCOMES, Fate
from ...representation import values_of
from .. import limiting
from ..axes import axes_of, direction
from ..data import Endless
from ..units import DIGITS, SHORT, Units, bracket, number, vector
from .classification import what_changes
from .headline import REST
from .motion import in_file
from .motion import row as entry
from .questions import reached, tilt_dict
from .scene import counted

COLUMNS = ("case", "thrusters", "torque_x", "torque_y", "torque_z", "torque_1", "torque_2", "torque_3",
           "fate", "level", "axis", "axis_name", "sense", "limit", "time_low", "time_high", "largest_rate",
           "margin_rate", "margin_wheel", "margin_torque")
MARGIN_LABELS = {"rate": "rate", "wheel": "wheel momentum", "torque": "torque"}
# bounded is not for ever here: another torque may come
FATES = HEADS | {Fate.BOUNDED.word: OUTCOMES[Fate.BOUNDED].does.upper()}
PRECISE = Context(prec=40)  # digits in which ends are rounded
FIRST = 5  # lines of the answer at most
SOON = 2  # times a margin: the fate is back before a change as great


def as_dict(case, found) -> dict:
    """One object of `stabilab stuck --json`: SI units, rates in rad/s; axes are those of "principal"."""
    return {"schema": "stabilab.stuck/2", "case": found.case, "rows": [_row(row, case) for row in found.rows],
            "principal": values_of(found.principal, "moments axes")}


def _row(row, case) -> dict:
    wheels = [{"wheel": w.wheel, "keeps_bounded": [list(map(Endless, pair)) for pair in w.keeps_bounded],
               **values_of(w, "now axis best best_time gain searched because"),
               "reason": w.reason.as_dict()} for w in row.wheels]
    margins = row.margins.items()
    return {**values_of(row, "thrusters torque torque_principal fate level"),
            "torque_size": math.hypot(*row.torque),
            **axes_of(case).key(row.axis), **values_of(row, "sense limit time_to_limit largest_rate"),
            "margin": _margin_sizes(row), "wheel_intervals": wheels,
            "because": row.because, "reason": row.reason.as_dict(), "tilt": tilt_dict(row.tilt),
            **values_of(row, "direction never time_level"),
            "margin_direction": {name: margin.direction for name, margin in margins},
            "margin_until": {name: margin.until and Endless(margin.until) for name, margin in margins},
            "margin_because": {name: margin.because for name, margin in margins},
            "margin_reason": {name: margin.reason.as_dict() if margin.reason else None
                              for name, margin in margins},
            "helpers": [values_of(h, "thrusters duty effect torque_left fate time_to_limit")
                        for h in row.helpers]} | limiting.key(case, row.caveats)


def lines(case, found):
    """A line of CSV a row, SI units; empty where a number does not exist."""
    for row in found.rows:
        limit = "/".join(map(repr, row.limit)) if isinstance(row.limit, tuple) else row.limit
        yield limiting.Line((printable(case.name), printable("+".join(row.thrusters)), *row.torque,
                             *row.torque_principal, row.fate, row.level, row.axis,
                             axes_of(case).key(row.axis)["axis_name"], row.sense, limit,
                             *(row.time_to_limit or (None, None)), row.largest_rate,
                             *_margin_sizes(row).values()), row.caveats)


CSV = COLUMNS, lines


def _margin_sizes(row) -> dict:
    return {name: row.margins[name].size if name in row.margins else None for name in MARGIN_LABELS}


def text(case, found, units: Units) -> str:
    """The answer in five lines at most, then the details."""
    if found.ranked:  # a line a thruster, the worst first
        head = [f"{printable(row_name(row))} {answer_line(row, units)}" for row in found.rows]
        if len(head) > FIRST:
            head[FIRST - 1:] = [f"and {len(head) - FIRST + 1} more below, none of them sooner"]
    else:
        head = _first(found.rows[0], units)
    lines = [f"{printable(case.name)}: {head[0]}", *head[1:FIRST]]
    for row in found.rows:
        lines += ["", *_details(row, units)]
    names = [units.axes.name(n) for n in (1, 2, 3)]
    lines += ["", "principal axes, unit vectors in the frame of the file:"]
    wide = max(map(len, names))
    lines += [f"  {name:<{wide}}  moment {number(moment, DIGITS)} kg m²  {vector(axis)}"
              for name, moment, axis in zip(names, found.principal.moments, found.principal.axes)]
    return "\n".join(lines)


def swept(answers, units: Units):
    """(the answer in a line, columns, rows) of a sweep: the fate, its axis, when the limit is reached."""
    rows = [found.rows[0] for _, found in answers]
    counts = counted([(row.fate, row.caveats) for row in rows], FATES, units, "; ")
    ends = [row.time_to_limit[1] for row in rows if row.time_to_limit]
    name, one = units.times(max(ends, default=0.0))
    cells = [[row.fate, units.axes.signed(row.axis, row.sense),
              number(row.time_to_limit[1] * one, DIGITS) if row.time_to_limit else ""] for row in rows]
    return counts + (f"; the first limit is reached in {units.time(min(ends), SHORT)}" if ends
                     else ""), [("fate", ""), ("axis", ""), ("limit in", name)], cells


def _first(row, units):
    torque = f"torque {number(math.hypot(*row.torque))} N m, {vector(row.torque)} in the frame of the file"
    if row.largest_rate is not None and row.fate == "spin-up":
        torque += f"; largest rate until then {units.rate(row.largest_rate, SHORT)}"
    wheel = next((w for w in row.wheels if w.keeps_bounded),
                 next((w for w in row.wheels if w.best is not None), None))
    more = (_margins(row, units), wheel and _wheel(wheel, units),
            row.helpers and _helper(row.helpers[0], units))
    return [answer_line(row, units), f"  {torque}", *(f"  {line}" for line in more if line)]


def row_name(row) -> str:
    """The thrusters of a row."""
    return " and ".join(row.thrusters) or "torque"


def answer_line(row, units) -> str:
    """What becomes of the motion, in one line."""
    return "; ".join(filter(None, [_answer(row, units), limiting.tilted(row.caveats, units),
                                   what_changes(row.box, units)]))


def _answer(row, units):
    when, known = _when(row, units), f" ({row.level})" if row.time_to_limit is None else ""
    if row.fate == "spin-up":
        about = "without bound"
        if row.axis:
            about = f"about {units.axes.whole(row.axis)}, {direction(row.sense)}"
        elif row.direction:
            about = f"about the direction {vector(row.direction)} of the file's frame"
        return f"{FATES[row.fate]} {about}{', ' + when if when else ''}{known}"
    if row.fate == "undecided":
        if when:
            return f"UNDECIDED, but {when}"
        until = units.time(row.followed, SHORT, -1)
        return (f"UNDECIDED: followed for {until}" if row.limit is None
                else f"UNDECIDED: not at {_limit(row.limit, units)} before {until} ({row.time_level})")
    words = FATES[row.fate]
    if row.fate == "equilibrium":
        departs = limiting.unstable(row.caveats, units)
        words = f"{words if row.largest_rate else REST}: {departs or 'every rate stays as it is'}"
    while_ = limiting.condition(row.caveats, units)
    if when:
        return f"{words}{while_}, but {when}{known}"
    largest = "" if row.largest_rate is None else f", |ω| at most {units.rate(row.largest_rate, SHORT, 1)}"
    below = ", never at its limit" if row.never and row.limit is not None else ""
    return (f"{words}{while_}{largest}{below}{known}" if row.tilt is None
            else f"{words}{largest}{below}{known},{while_}")


def _when(row, units) -> str:
    if row.time_to_limit is None:
        return ""
    name, one = units.times(row.time_to_limit[1])
    low, high = row.time_to_limit
    if high == 0:
        return f"starts at its limit, {_limit(row.limit, units)}"
    a, b = bracket(low, high, one)
    return (f"reaches {_limit(row.limit, units)} in {number((low + high) / 2 * one)} {name} "
            f"({row.time_level} {a} "
            f"to {b})")


def _limit(limit, units) -> str:
    name, one = units.rates
    if isinstance(limit, tuple):
        if len(set(limit)) == 1:
            return f"{number(limit[0] * one)} {name} in a component"
        return f"the limit of a component ({', '.join(number(v * one) for v in limit)} {name})"
    return f"{number(limit * one)} {name}"


def _margins(row, units) -> str:
    known = {name: m for name, m in row.margins.items() if m.size is not None}
    if not known:
        reason = next((row.margins[name].reason for name in ("wheel", "rate", "torque")
                       if name in row.margins), None)
        return f"no distance to a separatrix, as {units.said(reason)}" if reason else ""
    ends = {name: _ends(name, m, units) for name, m in known.items()}
    told = [" or ".join(f"{ends[name][0]} of {MARGIN_LABELS[name]}" for name, m in known.items()
                        if (m.beyond or name == "torque") == beyond) for beyond in (True, False)]
    changes = [words + sizes for words, sizes in zip(
        ("the outcome changes with ", "only on a separatrix the outcome is another, nearest "), told)
        if sizes]
    return "; ".join([*changes, *(f"beyond {back} of {MARGIN_LABELS[name]} it is again as now"
                                  for name, (_, back) in ends.items() if back)])


def _ends(name, margin, units) -> tuple[str, str]:
    """(the size of a margin, the size at which the fate turns back, where that is soon)."""
    if margin.until is None or not margin.size < margin.until < SOON * margin.size:
        return amount(name, margin.size, units, SHORT), ""
    unit, one = _unit(name, units)
    low, high = bracket(margin.size, margin.until, one)
    return f"{low} {unit}", f"{high} {unit}"


def amount(name, size, units, digits=DIGITS, side=0) -> str:
    """The size of a change with its unit."""
    return units.told(size, _unit(name, units), digits, side)


def holds_for(margin, units) -> str:
    """What a margin holds for, in words; empty where nothing is to be said."""
    return units.said(margin.reason) if margin.reason else ""


def _unit(name, units):
    return {"rate": units.rates, "wheel": ("N m s", 1.0), "torque": ("N m", 1.0)}[name]


def _wheel(wheel, units) -> str:
    name = printable(wheel.wheel)
    if wheel.keeps_bounded:
        momenta = [_span_of(low, high) + "".join(f" but {number(s, 12)} N m s" for s in without)
                   for low, high, without in merged(wheel.keeps_bounded)]
        return f"wheel {name}, now {number(wheel.now)} N m s, keeps it bounded at {' or '.join(momenta)}"
    if wheel.best is None:
        return f"wheel {name}: no momentum is known to keep it bounded: {units.said(wheel.reason)}"
    later = ("not reached while followed" if wheel.best_time is None
             else f"{units.time(wheel.best_time[0], SHORT)}")
    gain = "" if wheel.gain is None else f", {units.time(wheel.gain, SHORT)} later"
    low, high = wheel.searched
    most = "delays the limit most of all" if wheel.most else "delays the limit, perhaps not most of all,"
    return (f"wheel {name}, now {number(wheel.now)} N m s: {number(wheel.best)} N m s {most} within "
            f"{number(low)} to {number(high)}: {later}{gain}")


def merged(intervals):
    """[(low, high, momenta between that do not keep it bounded)]: intervals a single number apart are one."""
    out = []
    for low, high in intervals:
        one = math.nextafter(low, -math.inf)
        if out and math.nextafter(out[-1][1], math.inf) == one:
            out[-1] = out[-1][0], high, (*out[-1][2], one)
        else:
            out.append((low, high, ()))
    return out


def _span_of(low, high) -> str:
    if low == high:
        return f"{number(low, 12)} N m s alone"
    if math.isinf(low) and math.isinf(high):
        return "any momentum"
    for digits in (DIGITS, 9, 12):
        least, most = _inward(low, ROUND_CEILING, digits), _inward(high, ROUND_FLOOR, digits)
        if not float(least) > float(most):
            break
    if math.isinf(low):
        return f"up to {most} N m s"
    return f"{least} N m s or more" if math.isinf(high) else f"{least} to {most} N m s"


def _inward(value: float, way: str, digits: int) -> str:
    """A number of so many digits that is inside an interval with this end."""
    if not value or math.isinf(value):
        return str(value)
    exact = Decimal(value)
    return number(float(exact.quantize(Decimal(1).scaleb(exact.adjusted() + 1 - digits), way,
                                        context=PRECISE)), digits)


def _helper(helper, units) -> str:
    fired = " and ".join(f"{printable(name)} for {number(100 * duty)} % of the time"
                         for name, duty in zip(helper.thrusters, helper.duty))
    rest = f"{number(helper.torque_left)} N m is left"
    left = {"zero": "no torque is left",
            "bounded": f"{rest}, and the motion stays bounded while that is exactly on its axis"}.get(
                helper.effect, rest)
    then = ("" if helper.time_to_limit is None
            else f", and the limit comes in {units.time(helper.time_to_limit[0], SHORT)}")
    return f"with {fired}, in the mean, {left}{then}{': does not help' if helper.effect == 'none' else ''}"


def _details(row, units) -> list[str]:
    found = [("torque, principal axes", f"{vector(row.torque_principal)} N m"),
             ("torque, frame of file", f"{vector(row.torque)} N m"),
             ("fate", f"{row.fate} ({row.level})"), ("because", units.said(row.reason))]
    margins = {}
    for name, margin in row.margins.items():
        told = holds_for(margin, units)
        if margin.size is not None:
            along = f" along {vector(margin.direction)}" if margin.direction else ""
            told = f"{amount(name, margin.size, units)}{along}" + (f": {told}" if told else "")
        margins[name] = told
    if len(margins) > 1 and len(set(margins.values())) == 1:  # nothing is known of any, for one reason
        found.append(("margins", told))
    else:
        found += [(f"margin, {name}", told) for name, told in margins.items()]
    if row.tilt is not None and not row.tilt.ranges:
        found.append(("tilted, not before", f"{units.time(row.tilt.not_before, side=-1)}, whatever the "
                                            "azimuth and "
                                            "for any smaller tilt (proved)"))
    return [printable(row_name(row)), *(f"  {name:<24} {told}" for name, told in found),
            *(f"  {line}" for line in means(row, units))]


def means(row, units) -> list[str]:
    """What a wheel or another thruster can do, a line each."""
    wheels = [_wheel(w, units)
              + (f" ({units.said(w.reason)})" if w.keeps_bounded or w.best is not None else "")
              for w in row.wheels]
    return wheels + [_helper(h, units) for h in row.helpers]


# --- Burns
SHOWN = 12  # switches in text; JSON has them all


def burn_dict(case, found) -> dict:
    """The object of `stabilab burn --json`: SI units, vectors in the frame of the file."""
    return {"schema": "stabilab.burn/1", "case": case.name, "thrusters": found.thrusters,
            "switches": [{"time": one.time, "firing": one.firing,
                          "torque": in_file(case, one.torque), "rates": in_file(case, one.rates)}
                         for one in found.switches],
            "closed": _closed(case, found.closed), "latest": _latest(found.latest),
            "closed_latest": _closed(case, found.closed_latest)}


def burn_undecided(found) -> bool:
    """Whether the motion that it leaves, or by when to close, is undecided."""
    late = found.latest is not None and found.latest.level == "undecided"
    return late or found.closed.motion.fate.word == "undecided"


def _closed(case, one) -> dict | None:
    if one is None:
        return None
    turn = one.attitude
    return {"time": one.time, "rates": in_file(case, one.rates), "error": one.error,
            "momentum": in_file(case, one.momentum), "energy": one.energy,
            "largest_rate": one.largest_rate, "largest_rate_before": one.largest_before,
            "fate": one.motion.fate.word, "because": one.motion.because,
            "reason": one.motion.reason.as_dict(),
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
            **values_of(one, "level because again surely within forces"), "reason": one.reason.as_dict(),
            "stated": _latest(one.stated)}


def burn_text(case, found, units: Units) -> str:
    """The answer first, then what is left, the switches and why."""
    lines = [f"{case.name}: {_headline(found, units)}"]
    if found.latest is not None:
        lines += _of_latest(found, units)
    lines += _of_closed(case, found, found.closed, units)
    for one in found.switches[:SHOWN]:
        firing = ", ".join(one.firing) or "none"
        lines.append(entry(units.moment(one.time), f"firing: {firing}; rates "
                                                 f"{units.vector(_seen(case, one.rates), units.rates)}"))
    if len(found.switches) > SHOWN:
        lines.append(entry("", f"and {len(found.switches) - SHOWN} more switches, in --json"))
    return "\n".join([*lines, f"why: {units.said(found.closed.motion.reason)}"])


def _headline(found, units: Units) -> str:
    one, latest = found.closed, found.latest
    if latest is None:
        after = ("largest rate not known" if one.largest_rate is None
                 else f"never above {units.rate(one.largest_rate, side=1)}")
        return f"CLOSED at {units.moment(one.time)}, then {one.motion.fate.word.upper()}, {after}"
    aim = f"|ω| below {units.rate(latest.limit)}"
    over = ("" if latest.stated is None else
            f", {units.said(latest.looked, SHORT)}: the least of {latest.forces} "
            "forces")
    if math.isinf(latest.low):
        return f"NO CLOSING IS TOO LATE for {aim} ({latest.level}){over}"
    if math.isnan(latest.high):
        early = units.time(latest.low, side=-1)
        return f"NOT KNOWN by when to close for {aim}: up to {early} it is early enough{over}"
    if not latest.high:
        return f"TOO LATE AT THE START for {aim}: the motion before the burn reaches it already"
    name, size = units.times(latest.high)
    low, high = bracket(latest.low, latest.high, size)
    return (f"CLOSE BY {low} {name} to keep {aim} "
            f"({latest.level} {low} to {high}){over}")


def _of_latest(found, units: Units):
    latest, early = found.latest, found.closed_latest
    if (stated := latest.stated) is not None:
        known = ("never too late" if math.isinf(stated.low) else f"close by {units.time(stated.low)}")
        yield entry("forces as stated", f"{known} ({stated.level})")
    if early is not None:
        yield entry("closed then", f"{_turning(early, units)}; largest rate before "
                                   f"{_rate(early.largest_before, units)}")
    if latest.surely is not None:
        early_enough, late = latest.surely
        yield entry("bounded by", f"early enough up to {units.time(early_enough, side=-1)}"
                    + (f", too late from {units.time(late, side=1)} on" if math.isfinite(late) else ""))
    for begin, end in latest.again:
        yield entry("below it again", f"closed between {units.time(begin, side=1)} and "
                                      f"{units.time(end, side=-1)} "
                                      "(seen at 2000 times, no proof)")


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
    yield entry("last closing", units.time(one.time))
    yield entry("rates then", f"{units.vector(_seen(case, one.rates), units.rates)}, known to "
                            f"{units.rate(one.error, 2, 1)}")
    yield entry("angular momentum", f"{number(math.hypot(*one.momentum), DIGITS)} N m s, "
                                  f"{vector(_seen(case, one.momentum))}")
    yield entry("energy", units.energy(one.energy))
    yield entry("largest rate before", _rate(one.largest_before, units))
    yield entry("after it", _turning(one, units))
    for name, fired, used in zip(found.thrusters, one.fired, one.used):
        if fired is None:
            continue
        mass = "" if used is None else f", {number(used, DIGITS)} kg of propellant"
        yield entry(name, f"fired {units.time(fired)}{mass}")


def _seen(case, along):
    """A vector in the frame of the file, 0 where a component is only the rounding of the others."""
    values = in_file(case, along)
    least = 4 * math.ulp(max(map(abs, values)))
    return [float(v) if abs(v) > least else 0.0 for v in values]
