"""The answer to one question (`when`, `fate`, `extremes`, `period`) in words, JSON and CSV.

With how many digits were checked, or, for a limit, what a tilt of the torque does to a bounded motion."""
from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from ...errors import printable
from ...orbit.result import Fate, Motion, no_period
from ...representation import values_of
from .. import ending, frame, limiting
from ..axes import axes_of
from ..terminal import lettered, listed
from ..units import DIGITS, Units, bracket, number
from .headline import cause, flips, largest, outcome, rate_margin, verdict
from .motion import (
    bound_lines,
    energy_margin,
    extreme_lines,
    flips_dict,
    followed,
    numbers,
    row,
    tilt_lines,
    why,
)

if TYPE_CHECKING:
    from ...answers.digits_asked import Told
    from ...answers.passage import TimeTo
    from ...case.limit_options import StatedLimit
    from ...case.read import Case

# --- When a limit is reached
ANSWER_HEADS = {"yes": "reached by", "unknown": "NOT KNOWN of", "never": "NEVER by"}
COLUMNS = ("case", "quantity", "limit", "time_low", "time_high", "level")


def as_dict(case, limit, found) -> dict:
    """One object of `stabilab when --json`: SI units. time: [low, high], null where it is never reached or
    not known; reached: "yes", "never" or "unknown"; not_before: the limit is not reached before, null where
    it never is."""
    low, high = float(found.low), float(found.high)
    return {"schema": "stabilab.when/1", "case": case.name, "variables": case.variables, "kind": limit.kind,
            "quantities": limit.names, "limits": limit.limits, "reached": reached(low, high),
            "time": [low, high] if math.isfinite(high) else None, "not_before": low,
            "level": str(found.level), "because": str(found.words),
            "reason": found.reason.as_dict(), "tilt": tilt_dict(found.tilt)
            } | ending.key(case, found.ending)


def lines(case, limit, found):
    """A line of CSV, SI units; inf: never reached, an empty upper end: not known."""
    ends = (None if math.isnan(v) else float(v) for v in (found.low, found.high))
    return [limiting.Line((case.name, "/".join(limit.names), "/".join(map(repr, limit.limits)), *ends,
                           str(found.level)), ending=found.ending)]


CSV = COLUMNS, lines


def text(case, limit, found, units: Units) -> str:
    """The answer in one line with its two ends, and the reason; `as_dict` has all digits of the ends."""
    low, high = float(found.low), float(found.high)
    parts = [_answer(limit, found, low, high, units),
             "BUT " * varies(found) + limiting.tilted(found.caveats, units)]
    told = f"{printable(case.name)}: {'; '.join(filter(None, parts))}\n  {units.said(found.reason)}"
    end = ending.line(found.ending, units)
    return f"{told}\n  in the end: {lettered(end)}" if end else told


def swept(answers, units: Units):
    """(the answer in a line, columns, rows) of a sweep: whether, when and how well known."""
    kinds = [reached(float(found.low), float(found.high)) for *_, found in answers]
    counts = "; ".join(f"{words} {kinds.count(kind)}" for kind, words in ANSWER_HEADS.items() if kind in kinds)
    counts += limiting.shared([found.caveats for kind, (*_, found) in zip(kinds, answers) if kind == "never"],
                              units)
    ends = [float(found.high) for *_, found in answers if math.isfinite(found.high)]
    name, one = units.times(max(ends, default=0.0))
    told = (f"{asked(answers[0][1], units)}: {counts}"
            + (f"; first in {units.time(min(ends), 4)}" if ends else ""))
    rows = [[kind, number(float(found.high) * one, DIGITS) if kind == "yes" else "", str(found.level)]
            for kind, (*_, found) in zip(kinds, answers)]
    return told, [("reached", ""), ("time", name), ("level", "")], rows


def unknown(found: TimeTo) -> bool:
    """Whether the limit may be reached at a time that is not known."""
    return reached(float(found.low), float(found.high)) == "unknown"


def varies(found: TimeTo) -> bool:
    """Whether some force within its tolerance reaches the limit, and another does not."""
    return found.tilt is not None and found.tilt.varies


def reached(low: float, high: float):
    """Whether a limit is reached, by the ends of the time: "yes", "never" or "unknown"."""
    return "yes" if math.isfinite(high) else "never" if math.isinf(low) else "unknown"


def _answer(limit: StatedLimit, found: TimeTo, low: float, high: float, units: Units):
    aim = asked(limit, units)
    if math.isinf(low):
        holds, departs = limiting.condition(found.caveats, units), limiting.unstable(found.caveats, units)
        stated = " with the force as stated" * varies(found)
        return f"{departs}; undisturbed it " * bool(departs) + (
            f"NEVER reaches {aim}{stated} ({found.level}){',' * bool(holds)}{holds}")
    if math.isnan(high):
        return f"NOT KNOWN when it reaches {aim}: not before {units.time(low, side=-1)} ({found.level})"
    if high == 0:
        return f"starts at or beyond {aim}"
    name, one = units.times(high)
    a, b = bracket(low, high, one)
    return f"reaches {aim} in {number((low + high) / 2 * one)} {name} ({found.level} {a} to {b})"


def asked(limit, units):
    """A limit in words: "|ω| = 60 deg/s", of several "|ωx| or |ωy| = 5 deg/s" where it is one number."""
    unit = {"energy": units.of("J"), "tilt": units.angles}.get(limit.kind, units.rates)
    # the rate about an axis as everywhere else: "|omega 3|" is |ω3|, and "|omega z|" |ωz|
    names = [lettered(name).replace(" ", "") if limit.kind == "component"
             else lettered(units.axes.sentence(name)) for name in limit.names]
    told = [units.told(most, unit, DIGITS) for most in limit.limits]
    if len(set(told)) == 1:
        return f"{listed(names, 'or')} = {told[0]}"
    return " or ".join(f"{name} = {most}" for name, most in zip(names, told))


def tilt_dict(found) -> dict | None:
    """The key "tilt" of a motion in JSON: SI units."""
    if found is None:
        return None
    if found.ranges:
        return values_of(found, "angle of directions limit earliest latest level within") | {
            "fates": dict(found.fates), "because": found.because}
    return values_of(found, "angle of limit") | {
        "limit_stated": found.stated, "not_before": found.not_before,
        "time": [found.low, found.high] if found.ends else None,
        "level": found.level if found.ends else None
        } | values_of(found, "azimuth torque azimuths times untilted within") | {
            "forces": tilt_dict(found.forces)}


# --- `fate`, `extremes` and `period`
SHOWN = 12  # digits of a number that is not written out, where more than a table's were asked for


def fate(case: Case, motion: Motion, told: Told, units: Units, all_digits: bool, say: bool,
         proofs: bool = False) -> str:
    """The fate, margins, bounds for all times, what a tilt does, and why."""
    def size(value: float) -> str:
        if not all_digits:
            return units.energy(value)
        decimals = told.decimals or number(told.values, max(SHOWN, told.asked))
        return f"{decimals.removeprefix('-')} {units.of('J')[0]}".rstrip()
    margin = "" if told.values is None else energy_margin(told.values, size)
    margins = (("margin, rate", rate_margin(motion, units, DIGITS)), ("margin, energy", margin))
    rows = [row(name, words) for name, words in margins if words]
    bounds = bound_lines(case, replace(motion, extremes=None), units)
    return "\n".join([f"{case.name}: {verdict(case, motion, units)}", *rows, *bounds,
                      *tilt_lines(case, motion, units, proofs),
                      *why(case, motion, units, proofs), *frame.note(case),
                      *([_said(told, units, " of the margin, energy")] * say)])


def extremes(case: Case, motion: Motion, told: Told, units: Units, all_digits: bool, say: bool,
             proofs: bool = False) -> str:
    """The largest rate and the fate, a line a component, and bounds for all times."""
    shown = _with(motion, told)
    parts, most = [*outcome(shown, units), cause(shown, units)], [largest(shown, units)]
    parts = [*parts, *most] if motion.fate.word in ("spin-up", "equilibrium") else [*most, *parts]
    rows = [f"  extremes: {units.said(shown.over)}"]
    if shown.extremes is not None:
        rows = _all_digits(case, shown, told) if all_digits else extreme_lines(case, shown, units)
    return "\n".join([f"{case.name}: {'; '.join(filter(None, parts))}", *rows,
                      *bound_lines(case, motion, units),
                      *(why(case, motion, units, proofs) if proofs else ()), *frame.note(case),
                      *([_said(told, units)] * (say and told.reason != shown.over))])


def _all_digits(case: Case, motion: Motion, told: Told):
    """A line a component, every digit that was asked for; in rad/s, in which they were checked."""
    unit = "" if case.variables == "scaled" else "rad/s"
    pairs = told.decimals or [[number(v, max(SHOWN, told.asked)) for v in pair] for pair in motion.extremes]
    wide, word = max(24, told.asked + 8), lambda end: "unbounded" if end in ("inf", "-inf") else end
    rows = (f"  {lettered(name):<8}{word(low):>{wide}}{word(high):>{wide}}  {unit}".rstrip()
            for name, (low, high) in zip(case.scene.components, pairs))
    return [f"  over {motion.extremes_over}, least and greatest:", *rows]


def _said(told: Told, units: Units, of: str = "") -> str:
    """How many digits were checked, of what, and how."""
    because, digits = units.said(told.reason), told.digits
    if digits is None:
        return f"  {because}"
    return f"  exact: {because}" if math.isinf(digits) else (
        f"  {f'{min(digits, 99.0):.1f}'.removesuffix('.0')} digits{of}: {because}")


def period(case: Case, motion: Motion, told: Told, units: Units, all_digits: bool, say: bool,
           proofs: bool = False) -> str:
    """The period with its unit."""
    if told.values is None:
        value = (no_period(motion.fate)
                 + (f" ({motion.fate.word})" if motion.fate in (Fate.SPIN_UP, Fate.SEPARATRIX, Fate.BOUNDED)
                    else ""))
    elif all_digits:
        value = (
            f"period {told.decimals or number(told.values, max(SHOWN, told.asked))} {case.scene.time_unit}")
    else:
        value = f"period {units.time(told.values)}"
    holds = limiting.condition(motion.caveats, units)
    parts = [value + (holds and f",{holds}"), flips(motion, units),
             limiting.unstable(motion.caveats, units), limiting.reached(motion.caveats, units),
             limiting.tilted(motion.caveats, units)]
    lines = [f"{case.name}: {'; '.join(filter(None, parts))}",
             *(why(case, motion, units, proofs) if proofs else ())]
    return "\n".join([*lines, *([_said(told, units)] * (say and told.values is not None))])


# --- As JSON and CSV
def _object(question, case, motion, told, found) -> dict:
    """What all objects have, and what was found; digits.reached: null where there is no number to judge."""
    shown = None if told.digits is None else min(told.digits, 99.0)
    return ({"schema": f"stabilab.{question}/1", "case": case.name, "variables": case.variables,
             "at": motion.at, "fate": motion.fate.word} | found
            | {"digits": {"asked": told.asked, "reached": shown}
               | values_of(told, "method because decimals") | {"reason": told.reason.as_dict()}}
            | {"reason": motion.reason.as_dict(), "numbers": numbers(motion),
               "flips": flips_dict(case, motion)} | ending.key(case, motion.ending))


def extremes_dict(case: Case, motion: Motion, told: Told) -> dict:
    """One object of `stabilab extremes --json`; null where a component is unbounded or unknown (see fate)."""
    motion = _with(motion, told)
    return _object("extremes", case, motion, told, {
        "components": case.scene.components, "extremes": motion.extremes, "over": motion.extremes_over,
        **followed(motion)})


def _with(motion, told):
    return (motion if told.values is None
            else replace(motion, extremes=tuple(tuple(map(float, pair)) for pair in told.values)))


def fate_dict(case: Case, motion: Motion, told: Told) -> dict:
    """One object of `stabilab fate --json`; margin: barrier minus energy, null where none stands ahead."""
    margin = motion.margin_energy if told.values is None else told.values
    return _object("fate", case, motion, told, {
        **axes_of(case).key(motion.axis), "sense": motion.sense or None, "because": motion.because,
        "margin": margin, "tilt": tilt_dict(motion.tilt), **followed(motion)})


def period_dict(case: Case, motion: Motion, told: Told) -> dict:
    """One object of `stabilab period --json`; period: null where there is none or it is not known."""
    return _object("period", case, motion, told,
                   {"period": told.values, "time": case.scene.time_unit})


def extremes_lines(case, motion, told):
    """A line of CSV a component, every digit asked for; inf: unbounded, empty: unknown."""
    pairs = told.decimals or _with(motion, told).extremes or ((None, None),) * 3
    return [limiting.Line((case.name, name, *pair, motion.extremes_over), ending=motion.ending)
            for name, pair in zip(case.scene.components, pairs)]


EXTREMES_CSV = ("case", "component", "min", "max", "over"), extremes_lines
