"""When a limit is reached, in words, JSON and CSV: the answer first, in the units of engineers; what a tilt
of the torque does to a bounded motion."""
from __future__ import annotations

import math
import re

from ...errors import printable
from ...representation import values_of
from .. import frame, limiting
from ..data import csv_lines
from ..terminal.letters import lettered, listed
from ..units import DIGITS, Units, bracket, number

WORDS = {"yes": "reached by", "unknown": "NOT KNOWN of", "never": "NEVER by"}
CSV = ("case", "quantity", "limit", "time_low", "time_high", "level", "caveats")


def as_dict(case, limit, found) -> dict:
    """One object of `stabilab when --json`: SI units. time: [low, high], null where it is never reached or
    not known; reached: "yes", "never" or "unknown"; not_before: the limit is not reached before, null where
    it never is."""
    low, high = float(found.low), float(found.high)
    return {"schema": "stabilab.when/1", "case": case.name, "variables": case.variables, "kind": limit.kind,
            "quantities": limit.names, "limits": limit.limits, "reached": reached(low, high),
            "time": [low, high] if math.isfinite(high) else None, "not_before": low,
            "level": str(found.level), "because": str(found.words)
            } | limiting.key(case, found.caveats) | frame.key(case)


def csv(answers) -> str:
    """A line a case, SI units; inf: never reached, an empty upper end: not known."""
    rows = [(case.name, "/".join(limit.names), "/".join(map(repr, limit.limits)),
             *(None if math.isnan(v) else float(v) for v in (found.low, found.high)),
             str(found.level), limiting.cell(case, found.caveats)) for case, limit, found in answers]
    return csv_lines([CSV, *rows])[:-1]


def text(case, limit, found, units: Units) -> str:
    """The answer in one line with its two ends, and the reason; `as_dict` has all digits of the ends."""
    low, high = float(found.low), float(found.high)
    parts = [_answer(limit, found, low, high, units), limiting.tilted(found.caveats, units)]
    # the limit stands above, in the units asked for
    reason = re.sub(r"^[^:]* = [^:]*: ", "", str(found.words))
    return f"{printable(case.name)}: {'; '.join(filter(None, parts))}\n  {lettered(units.words(reason))}"


def swept(answers, units: Units):
    """(the answer in a line, columns, rows) of a sweep: whether, when and how well known."""
    kinds = [reached(float(found.low), float(found.high)) for *_, found in answers]
    counts = "; ".join(f"{words} {kinds.count(kind)}" for kind, words in WORDS.items() if kind in kinds)
    counts += limiting.shared([found.caveats for kind, (*_, found) in zip(kinds, answers) if kind == "never"],
                              units)
    ends = [float(found.high) for *_, found in answers if math.isfinite(found.high)]
    name, one = units.times(max(ends, default=0.0))
    told = (f"{asked(answers[0][1], units)}: {counts}"
            + (f"; first in {units.time(min(ends), 4)}" if ends else ""))
    rows = [[kind, number(float(found.high) * one, DIGITS) if kind == "yes" else "", str(found.level)]
            for kind, (*_, found) in zip(kinds, answers)]
    return told, [("reached", ""), ("time", name), ("level", "")], rows


def unknown(found) -> bool:
    """Whether the limit may be reached at a time that is not known."""
    return reached(float(found.low), float(found.high)) == "unknown"


def reached(low, high):
    """Whether a limit is reached, by the ends of the time: "yes", "never" or "unknown"."""
    return "yes" if math.isfinite(high) else "never" if math.isinf(low) else "unknown"


def _answer(limit, found, low, high, units):
    aim = asked(limit, units)
    if math.isinf(low):
        holds = limiting.condition(found.caveats, units)
        return f"NEVER reaches {aim} ({found.level}){',' * bool(holds)}{holds}"
    if math.isnan(high):
        return f"NOT KNOWN when it reaches {aim}: not before {units.time(low)} ({found.level})"
    if high == 0:
        return f"starts at or beyond {aim}"
    name, one = units.times(high)
    a, b = bracket(low * one, high * one)
    return f"reaches {aim} in {number((low + high) / 2 * one)} {name} ({found.level} {a} to {b})"


def asked(limit, units):
    """A limit in words: "|omega| = 60 deg/s", of several "|ωx| or |ωy| = 5 deg/s" where it is one number."""
    unit = {"energy": units.of("J"), "tilt": units.angles}.get(limit.kind, units.rates)
    # the rate about an axis as everywhere else: "|omega 3|" is |ω3|, and "|omega z|" |ωz|
    names = [units.axes.sentence(re.sub(r"\|(omega|x) ([123xyz])\|", r"|\1\2|", name))
             for name in limit.names]
    told = [units.told(most, unit, DIGITS) for most in limit.limits]
    if len(set(told)) == 1:
        return f"{listed(names, 'or')} = {told[0]}"
    return " or ".join(f"{name} = {most}" for name, most in zip(names, told))


def tilt_dict(found) -> dict | None:
    """The key "tilt" of a motion in JSON: SI units."""
    if found is None:
        return None
    if found.ranges:
        return values_of(found, "angle of directions limit earliest latest level") | {
            "fates": dict(found.fates), "because": found.because}
    return values_of(found, "angle of limit") | {
        "limit_stated": found.stated, "not_before": found.not_before,
        "time": [found.low, found.high] if found.ends else None,
        "level": found.level if found.ends else None
        } | values_of(found, "azimuth torque azimuths times untilted")
