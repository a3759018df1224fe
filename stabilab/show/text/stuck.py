"""Stuck thrusters and burns in words, JSON and CSV: the answer first, in the units of engineers."""
from __future__ import annotations

import math
from dataclasses import replace
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal

from ...errors import printable
from ...orbit.result import HEADS, OUTCOMES, Fate
from ...reasons import broad
from ...representation import values_of
from .. import limiting
from ..axes import axes_of, direction
from ..data import Endless
from ..units import DIGITS, SHORT, Units, bracket, number, vector
from .classification import what_changes
from .headline import REST
from .motion import Row, in_columns, in_file
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


def as_dict(case, out) -> dict:
    """One object of `stabilab stuck --json`: SI units, rates in rad/s; axes are those of "principal"."""
    return {"schema": "stabilab.stuck/2", "case": out.case, "rows": [_row(row, case) for row in out.rows],
            "principal": values_of(out.principal, "moments axes")}


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


def lines(case, result):
    """A line of CSV a row, SI units; empty where a number does not exist."""
    for row in result.rows:
        limit = "/".join(map(repr, row.limit)) if isinstance(row.limit, tuple) else row.limit
        yield limiting.Line((printable(case.name), printable("+".join(row.thrusters)), *row.torque,
                             *row.torque_principal, row.fate, row.level, row.axis,
                             axes_of(case).key(row.axis)["axis_name"], row.sense, limit,
                             *(row.time_to_limit or (None, None)), row.largest_rate,
                             *_margin_sizes(row).values()), row.caveats)


CSV = COLUMNS, lines


def _margin_sizes(row) -> dict:
    return {name: row.margins[name].size if name in row.margins else None for name in MARGIN_LABELS}


def text(case, result, units: Units) -> str:
    """The answer in five lines at most, then the details."""
    if result.ranked:  # a line a thruster, the worst first
        names = [printable(row_name(row)) for row in result.rows]
        head = [f"{name} {answer_line(row, units, len(case.name) + len(name) + 3)}"
                for name, row in zip(names, result.rows)]
        if len(head) > FIRST:
            head[FIRST - 1:] = [f"and {len(head) - FIRST + 1} more below, none of them sooner"]
    else:
        head = _first(result.rows[0], units, len(case.name) + 2)
    lines = [f"{printable(case.name)}: {head[0]}", *head[1:FIRST]]
    for row in result.rows:
        lines += ["", *_details(row, units)]
    names = [units.axes.name(n) for n in (1, 2, 3)]
    lines += ["", "principal axes, unit vectors in the frame of the file:"]
    wide = max(map(len, names))
    lines += [f"  {name:<{wide}}  moment {number(moment, DIGITS)} kg m²  {vector(axis)}"
              for name, moment, axis in zip(names, result.principal.moments, result.principal.axes)]
    return "\n".join(lines)


def swept(answers, units: Units):
    """(the answer in a line, columns, rows) of a sweep: the fate, its axis, when the limit is reached."""
    rows = [result.rows[0] for _, result in answers]
    counts = counted([(row.fate, row.caveats) for row in rows], FATES, units, "; ")
    ends = [row.time_to_limit[1] for row in rows if row.time_to_limit]
    name, item = units.times(max(ends, default=0.0))
    cells = [[row.fate, units.axes.signed(row.axis, row.sense),
              number(row.time_to_limit[1] * item, DIGITS) if row.time_to_limit else ""] for row in rows]
    return counts + (f"; the first limit is reached in {units.time(min(ends), SHORT)}" if ends
                     else ""), [("fate", ""), ("axis", ""), ("limit in", name)], cells


def _first(row, units, before):
    torque = f"torque {number(math.hypot(*row.torque))} N m, {vector(row.torque)} in the frame of the file"
    if row.largest_rate is not None and row.fate == "spin-up":
        torque += f"; largest rate until then {units.rate(row.largest_rate, SHORT)}"
    wheel = next((w for w in row.wheels if w.keeps_bounded),
                 next((w for w in row.wheels if w.best is not None), None))
    more = (_margins(row, units), wheel and _wheel(wheel, units),
            row.helpers and _helper(row.helpers[0], units))
    return [answer_line(row, units, before), f"  {torque}", *(f"  {line}" for line in more if line)]


def row_name(row) -> str:
    """The thrusters of a row."""
    return " and ".join(row.thrusters) or "torque"


def answer_line(row, units, before: int = 0) -> str:
    """What becomes of the motion, in one line. before: as of `limiting.fitted`."""
    return limiting.fitted(lambda short: "; ".join(filter(None, [
        _answer(row, units, short), limiting.tilted(row.caveats, units), what_changes(row.box, units),
        units.axes.direction_clause(row.axis)])), before, 1 + (row.time_to_limit is not None))


def _answer(row, units, short: bool = False):
    when, resolved = _when(row, units, short), f" ({row.level})" if row.time_to_limit is None else ""
    if row.fate == "spin-up":
        about = "without bound"
        if row.axis:
            about = f"about {units.axes.head(row.axis)}, {direction(row.sense)}"
        elif row.direction:
            about = f"about the direction {vector(row.direction)} of the file's frame"
        return f"{FATES[row.fate]} {about}{resolved}{'; ' + when if when else ''}"
    if row.fate == "undecided":
        if when:
            return f"UNDECIDED; BUT {when}"
        until = units.time(row.followed, SHORT, -1)
        return (f"UNDECIDED: followed for {until}" if row.limit is None
                else f"UNDECIDED: not at {_limit(row.limit, units)} before {until} ({row.time_level})")
    phrase = FATES[row.fate]
    if row.fate == "equilibrium":
        departs = limiting.unstable(row.caveats, units)
        phrase = f"{phrase if row.largest_rate else REST}: {departs or 'every rate stays as it is'}"
    phrase += limiting.condition(row.caveats, units, alone=True, short=short)
    if when:
        return f"{phrase}{resolved}; BUT {when}"
    largest = "" if row.largest_rate is None else f"|ω| at most {units.rate(row.largest_rate, SHORT, 1)}"
    below = "never at its limit" if row.never and row.limit is not None else ""
    return "; ".join(filter(None, [f"{phrase}{resolved}", ", ".join(filter(None, (largest, below))),
                                   *limiting.tilts(row.caveats, units)]))


def _when(row, units, short: bool = False) -> str:
    """When it reaches its limit. short: with both ends of the time as a clause of their own."""
    if row.time_to_limit is None:
        return ""
    name, item = units.times(row.time_to_limit[1])
    low, high = row.time_to_limit
    if high == 0:
        return f"starts at its limit, {_limit(row.limit, units)}"
    a, b = bracket(low, high, item)
    if broad(low, high):
        return f"reaches {_limit(row.limit, units)} in {a} to {b} {name} ({row.time_level})"
    time = f"{number((low + high) / 2 * item)} {name}"
    reached = f"reaches {_limit(row.limit, units)} in {time} ({row.time_level}"
    return f"{reached}); that is {a} to {b} {name}" if short else f"{reached} {a} to {b})"


def _limit(limit, units) -> str:
    name, item = units.rates
    if isinstance(limit, tuple):
        if len(set(limit)) == 1:
            return f"{number(limit[0] * item)} {name} in a component"
        return f"the limit of a component ({', '.join(number(v * item) for v in limit)} {name})"
    return f"{number(limit * item)} {name}"


def _margins(row, units) -> str:
    resolved = {name: m for name, m in row.margins.items() if m.size is not None}
    if not resolved:
        reason = next((row.margins[name].reason for name in ("wheel", "rate", "torque")
                       if name in row.margins), None)
        return f"no distance to a separatrix, as {units.said(reason)}" if reason else ""
    ends = {name: _ends(name, m, units) for name, m in resolved.items()}
    printed = [" or ".join(f"{ends[name][0]} of {MARGIN_LABELS[name]}" for name, m in resolved.items()
                        if (m.beyond or name == "torque") == beyond) for beyond in (True, False)]
    changes = [phrase + sizes for phrase, sizes in zip(
        ("the outcome changes with ", "only on a separatrix the outcome is another, nearest "), printed)
        if sizes]
    return "; ".join([*changes, *(f"beyond {back} of {MARGIN_LABELS[name]} it is again as now"
                                  for name, (_, back) in ends.items() if back)])


def _ends(name, margin, units) -> tuple[str, str]:
    """(the size of a margin, the size at which the fate turns back, where that is soon)."""
    if margin.until is None or not margin.size < margin.until < SOON * margin.size:
        return amount(name, margin.size, units, SHORT), ""
    unit, item = _unit(name, units)
    low, high = bracket(margin.size, margin.until, item)
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
    largest = "delays the limit most of all" if wheel.most else "delays the limit, perhaps not most of all,"
    return (f"wheel {name}, now {number(wheel.now)} N m s: {number(wheel.best)} N m s {largest} within "
            f"{number(low)} to {number(high)}: {later}{gain}")


def merged(intervals):
    """[(low, high, momenta between that do not keep it bounded)]: intervals a single number apart are one."""
    out = []
    for low, high in intervals:
        item = math.nextafter(low, -math.inf)
        if out and math.nextafter(out[-1][1], math.inf) == item:
            out[-1] = out[-1][0], high, (*out[-1][2], item)
        else:
            out.append((low, high, ()))
    return out


def _span_of(low, high) -> str:
    if low == high:
        return f"{number(low, 12)} N m s alone"
    if math.isinf(low) and math.isinf(high):
        return "any momentum"
    for digits in (DIGITS, 9, 12):
        smallest, largest = _inward(low, ROUND_CEILING, digits), _inward(high, ROUND_FLOOR, digits)
        if not float(smallest) > float(largest):
            break
    if math.isinf(low):
        return f"up to {largest} N m s"
    return f"{smallest} N m s or more" if math.isinf(high) else f"{smallest} to {largest} N m s"


def _inward(value: float, route: str, digits: int) -> str:
    """A number of so many digits that is inside an interval with this end."""
    if not value or math.isinf(value):
        return str(value)
    exact = Decimal(value)
    return number(float(exact.quantize(Decimal(1).scaleb(exact.adjusted() + 1 - digits), route,
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
    rows = [("torque, principal axes", f"{vector(row.torque_principal)} N m"),
             ("torque, frame of file", f"{vector(row.torque)} N m"),
             ("fate", f"{row.fate} ({row.level})"), ("because", units.said(row.reason))]
    margins = {}
    for name, margin in row.margins.items():
        printed = holds_for(margin, units)
        if margin.size is not None:
            along = f" along {vector(margin.direction)}" if margin.direction else ""
            printed = f"{amount(name, margin.size, units)}{along}" + (f": {printed}" if printed else "")
        margins[name] = printed
    if len(margins) > 1 and len(set(margins.values())) == 1:  # nothing is known of any, for one reason
        rows.append(("margins", printed))
    else:
        rows += [(f"margin, {name}", shown) for name, shown in margins.items()]
    if row.tilt is not None and not row.tilt.ranges:
        rows.append(("tilted, not before", f"{units.time(row.tilt.not_before, side=-1)}, whatever the "
                                            "azimuth and "
                                            "for any smaller tilt (proved)"))
    return [printable(row_name(row)), *(f"  {name:<24} {shown}" for name, shown in rows),
            *(f"  {line}" for line in means(row, units))]


def means(row, units) -> list[str]:
    """What a wheel or another thruster can do, a line each."""
    wheels = [_wheel(w, units)
              + (f" ({units.said(w.reason)})" if w.keeps_bounded or w.best is not None else "")
              for w in row.wheels]
    return wheels + [_helper(h, units) for h in row.helpers]


# --- Burns
SHOWN = 12  # switches in text; JSON has them all


def burn_dict(case, result) -> dict:
    """The object of `stabilab burn --json`: SI units, vectors in the frame of the file."""
    return {"schema": "stabilab.burn/1", "case": case.name, "thrusters": result.thrusters,
            "switches": [{"time": switch.time, "firing": switch.firing, "levels": switch.levels,
                          "torque": in_file(case, switch.torque), "rates": in_file(case, switch.rates)}
                         for switch in result.switches],
            "closed": _closed(case, result.closed), "latest": _latest(result.latest),
            "closed_latest": _closed(case, result.closed_latest)}


def burn_undecided(result) -> bool:
    """Whether the motion that it leaves, or by when to close, is undecided."""
    late = result.latest is not None and result.latest.level == "undecided"
    return late or result.closed.motion.fate.word == "undecided"


def _closed(case, item) -> dict | None:
    if item is None:
        return None
    turn = item.attitude
    return {"time": item.time, "rates": in_file(case, item.rates), "error": item.error,
            "momentum": in_file(case, item.momentum), "momentum_size": math.hypot(*item.momentum),
            "energy": item.energy,
            "largest_rate": item.largest_rate, "largest_rate_before": item.largest_before,
            "fate": item.motion.fate.word, "because": item.motion.because,
            "reason": item.motion.reason.as_dict(),
            "mode": turn and turn.mode, "rotation_period": turn and turn.rotation_period,
            "precession_period": turn and turn.precession_period,
            "fired": item.fired, "propellant_used": item.used}


def _latest(item) -> dict | None:
    """time: [low, high], null where no closing is too late or it is not known; not_before: any closing up to
    then is early enough, null where all are; surely: as of `Latest`, its second null where not known."""
    if item is None:
        return None
    return {"limit": item.limit, "reached": reached(item.low, item.high),
            "time": [item.low, item.high] if math.isfinite(item.high) else None, "not_before": item.low,
            **values_of(item, "level because again surely within forces"), "reason": item.reason.as_dict(),
            "stated": _latest(item.stated)}


def burn_text(case, result, units: Units) -> str:
    """The answer first, then what is left, the switches and why."""
    return "\n".join([f"{case.name}: {burn_headline(result, units)}",
                      *in_columns(burn_rows(case, result, units))])


def burn_rows(case, result, units: Units) -> list[str | Row]:
    """What stands below the answer: rows, and a sentence without a name."""
    rows: list[str | Row] = [] if result.latest is None else [*_of_latest(result, units)]
    rows += _of_closed(case, result, result.closed, units)
    for switch in result.switches[:SHOWN]:
        levels = switch.levels or (1.0,) * len(switch.firing)
        firing = ", ".join(name if level == 1 else f"{name} at {number(100 * level)} %"
                           for name, level in zip(switch.firing, levels)) or "none"
        rows.append((units.moment(switch.time), f"firing: {firing}; rates "
                                                f"{units.vector(_seen(case, switch.rates), units.rates)}"))
    if len(result.switches) > SHOWN:
        more = len(result.switches) - SHOWN
        rows.append(("", f"and {more} more switch{'es' * (more > 1)}, in --json"))
    return [*rows, f"why: {units.said(result.closed.motion.reason)}"]


def burn_motion(result):
    """The motion after the last closing with all that limits the answer on the burn."""
    return replace(result.closed.motion, caveats=result.caveats)


def burn_two_lines(result, units: Units) -> tuple[str, str]:
    """(what pages and cards show large, the rest of the headline) of a burn without a latest closing;
    the time at which it passes the limit of its case stands before its largest rate."""
    item, limit = result.closed, limiting.reached(result.caveats, units)
    closed = f"CLOSED at {units.moment(item.time)}, then {item.motion.fate.word.upper()}"
    after = ("largest rate not known" if item.largest_rate is None
             else f"never above {units.rate(item.largest_rate, side=1)}")
    return (f"{closed}; {limit}", after) if limit else (f"{closed}, {after}", "")


def burn_headline(result, units: Units) -> str:
    """The answer of a burn in one line."""
    latest = result.latest
    if latest is None:
        return "; ".join(filter(None, burn_two_lines(result, units)))
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


def _of_latest(result, units: Units):
    latest, early = result.latest, result.closed_latest
    if (declared := latest.stated) is not None:
        resolved = ("never too late" if math.isinf(declared.low) else f"close by {units.time(declared.low)}")
        yield ("forces as stated", f"{resolved} ({declared.level})")
    if early is not None:
        yield ("closed then", f"{_turning(early, units)}; largest rate before "
                                   f"{_rate(early.largest_before, units)}")
    if latest.surely is not None:
        early_enough, late = latest.surely
        yield ("bounded by", f"early enough up to {units.time(early_enough, side=-1)}"
                    + (f", too late from {units.time(late, side=1)} on" if math.isfinite(late) else ""))
    for begin, end in latest.again:
        yield ("below it again", f"closed between {units.time(begin, side=1)} and "
                                      f"{units.time(end, side=-1)} "
                                      "(seen at 2000 times, no proof)")


def _rate(value, units: Units) -> str:
    return "not known" if value is None else units.rate(value)


def _turning(item, units: Units) -> str:
    """What follows, in a line."""
    parts = [item.motion.fate.word]
    if item.largest_rate is not None:
        parts.append(f"largest rate for ever {units.rate(item.largest_rate)}")
    if item.attitude is not None and item.attitude.mode:
        parts.append(f"{item.attitude.mode} mode" if "axis" in item.attitude.mode else item.attitude.mode)
    return ", ".join(parts)


def _of_closed(case, result, item, units: Units):
    yield ("last closing", units.time(item.time))
    yield ("rates then", f"{units.vector(_seen(case, item.rates), units.rates)}, known to "
                            f"{units.rate(item.error, 2, 1)}")
    yield ("angular momentum", f"{number(math.hypot(*item.momentum), DIGITS)} N m s, "
                                  f"{vector(_seen(case, item.momentum))}")
    yield ("energy", units.energy(item.energy))
    yield ("largest rate before", _rate(item.largest_before, units))
    yield ("after it", _turning(item, units))
    for name, fired, used in zip(result.thrusters, item.fired, item.used):
        if fired is None:
            continue
        mass = "" if used is None else f", {number(used, DIGITS)} kg of propellant"
        yield (name, f"fired {units.time(fired)}{mass}")


def _seen(case, along):
    """A vector in the frame of the file, 0 where a component is only the rounding of the others."""
    values = in_file(case, along)
    smallest = 4 * math.ulp(max(map(abs, values)))
    return [float(v) if abs(v) > smallest else 0.0 for v in values]
