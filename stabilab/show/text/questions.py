"""The answer to one question (`when`, `fate`, `extremes`, `period`) in words, JSON and CSV.

With how many digits were checked, or, for a limit, what a tilt of the torque does to a bounded motion."""
from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

from ...errors import printable
from ...orbit.result import Fate, Motion, no_period
from ...reasons import broad
from ...representation import values_of
from .. import ending, frame, limiting
from ..axes import axes_of
from ..terminal import lettered, listed
from ..units import DIGITS, Units, bracket, number
from .headline import before, cause, directions, flips, largest, outcome, rate_margin, verdict
from .motion import (
    bound_lines,
    energy_margin,
    extreme_lines,
    flips_dict,
    followed,
    numbers,
    row,
    tilt_lines,
    top_key,
    top_rows,
    why,
)

if TYPE_CHECKING:
    from ...answers.digits_asked import Told
    from ...answers.passage import TimeTo
    from ...case.limit_options import StatedLimit
    from ...case.read import Case

# --- When a limit is reached
ANSWER_HEADS = {"yes": "reached by", "unknown": "NOT KNOWN of", "never": "NEVER by"}
FALLING = ("below", "nutation_below")  # kinds of limits to which something falls
COLUMNS = ("case", "quantity", "limit", "time_low", "time_high", "level")


def as_dict(case, limit, result) -> dict:
    """One object of `stabilab when --json`: SI units. time: [low, high], null where it is never reached or
    not known; reached: "yes", "never" or "unknown"; not_before: the limit is not reached before, null where
    it never is."""
    low, high = float(result.low), float(result.high)
    return {"schema": "stabilab.when/1", "case": case.name, "variables": case.variables, "kind": limit.kind,
            "quantities": limit.names, "limits": limit.limits, "reached": reached(low, high),
            "time": [low, high] if math.isfinite(high) else None, "not_before": low,
            "level": str(result.level), "because": str(result.words),
            "reason": result.reason.as_dict(), "tilt": tilt_dict(result.tilt),
            **({} if result.decimals is None else {"decimals": result.decimals})
            } | ending.key(case, result.ending)


def lines(case, limit, result):
    """A line of CSV, SI units; inf: never reached, an empty upper end: not known."""
    ends = (None if math.isnan(v) else float(v) for v in (result.low, result.high))
    return [limiting.Line((case.name, "/".join(limit.names), "/".join(map(repr, limit.limits)), *ends,
                           str(result.level)), ending=result.ending)]


CSV = COLUMNS, lines


def text(case, limit, result, units: Units) -> str:
    """The answer in one line with its two ends, and the reason; `as_dict` has all digits of the ends."""
    low, high = float(result.low), float(result.high)
    tilted = "BUT " * varies(result) + limiting.tilted(result.caveats, units)
    answer = limiting.fitted(lambda short: "; ".join(filter(None, [
        _answer(limit, result, low, high, units, short), tilted])), before(case, result))
    printed = f"{printable(case.name)}: {answer}\n"
    if result.decimals is not None:
        printed += f"  {result.decimals} {lettered(result.scene.time_unit)}, each digit proved\n"
    printed += f"  {units.said(result.reason)}"
    end = ending.line(result.ending, units)
    return f"{printed}\n  in the end: {lettered(end)}" if end else printed


def swept(answers, units: Units):
    """(the answer in a line, columns, rows) of a sweep: whether, when and how well known."""
    kinds = [reached(float(result.low), float(result.high)) for *_, result in answers]
    counts = "; ".join(f"{head} {kinds.count(kind)}" for kind, head in ANSWER_HEADS.items() if kind in kinds)
    counts += limiting.shared([out.caveats for kind, (*_, out) in zip(kinds, answers) if kind == "never"],
                              units)
    ends = [float(result.high) for *_, result in answers if math.isfinite(result.high)]
    name, item = units.times(max(ends, default=0.0))
    printed = (f"{asked(answers[0][1], units)}: {counts}"
            + (f"; first in {units.time(min(ends), 4)}" if ends else ""))
    rows = [[kind, number(float(result.high) * item, DIGITS) if kind == "yes" else "", str(result.level)]
            for kind, (*_, result) in zip(kinds, answers)]
    return printed, [("reached", ""), ("time", name), ("level", "")], rows


def unknown(result: TimeTo) -> bool:
    """Whether the limit may be reached at a time that is not known."""
    return reached(float(result.low), float(result.high)) == "unknown"


def varies(result: TimeTo) -> bool:
    """Whether some force within its tolerance reaches the limit, and another does not."""
    return result.tilt is not None and result.tilt.varies


def reached(low: float, high: float):
    """Whether a limit is reached, by the ends of the time: "yes", "never" or "unknown"."""
    return "yes" if math.isfinite(high) else "never" if math.isinf(low) else "unknown"


def _answer(limit: StatedLimit, result: TimeTo, low: float, high: float, units: Units, short: bool):
    aim = asked(limit, units)
    reaches = "has" if limit.kind in FALLING else "reaches"
    if math.isinf(low):
        holds = limiting.condition(result.caveats, units, short=short)
        departs = limiting.unstable(result.caveats, units)
        declared = " with the force as stated" * varies(result)
        return (f"NEVER {reaches} {aim}{' if undisturbed' * bool(departs)}{declared} ({result.level})"
                f"{',' * bool(holds)}{holds}{'; ' * bool(departs)}{departs}")
    if math.isnan(high):
        return f"NOT KNOWN when it {reaches} {aim}; not before {units.time(low, side=-1)} ({result.level})"
    if high == 0:
        return f"starts at or beyond {aim}"
    if result.decimals is not None:  # they have a line of their own
        time = number(float(result.decimals), SHOWN)
        return f"reaches {aim} in {time} {lettered(result.scene.time_unit)} ({result.level})"
    name, item = units.times(high)
    a, b = bracket(low, high, item)
    after = "after" if limit.kind in FALLING else "in"
    if broad(low, high):
        return f"{reaches} {aim} {after} {a} to {b} {name} ({result.level})"
    return f"{reaches} {aim} {after} {number((low + high) / 2 * item)} {name} ({result.level} {a} to {b})"


def asked(limit, units):
    """A limit in words: "|ω| = 60 deg/s", of several "|ωx| or |ωy| = 5 deg/s" where it is one number."""
    unit = {"energy": units.of("J"), "tilt": units.angles, "nutation": units.angles,
            "nutation_below": units.angles}.get(limit.kind, units.rates)
    # the rate about an axis as everywhere else: "|omega 3|" is |ω3|, and "|omega z|" |ωz|
    names = [lettered(name).replace(" ", "") if limit.kind == "component"
             else lettered(units.axes.sentence(name)) for name in limit.names]
    printed = [units.told(upper, unit, DIGITS) for upper in limit.limits]
    if len(set(printed)) == 1:
        return f"{listed(names, 'or')} {'<' if limit.kind in FALLING else '='} {printed[0]}"
    return " or ".join(f"{name} = {upper}" for name, upper in zip(names, printed))


def tilt_dict(result) -> dict | None:
    """The key "tilt" of a motion in JSON: SI units."""
    if result is None:
        return None
    if result.ranges:
        return values_of(result, "angle of directions limit earliest latest level") | _within_dict(result) | {
            "fates": dict(result.fates), "because": result.because}
    return values_of(result, "angle of limit") | {
        "limit_stated": result.stated, "not_before": result.not_before,
        "time": [result.low, result.high] if result.ends else None,
        "level": result.level if result.ends else None
        } | values_of(result, "azimuth torque azimuths times untilted") | _within_dict(result) | {
            "forces": tilt_dict(result.forces)}


def _within_dict(result) -> dict:
    """Which forces have which tolerance: in words, and with the numbers."""
    return {"within": "" if result.within is None else result.within.text(),
            "tolerances": result.within and result.within.as_dict()}


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
    rows = [row(name, phrase) for name, phrase in margins if phrase]
    bounds = bound_lines(case, replace(motion, extremes=None), units)
    return "\n".join([f"{case.name}: {verdict(case, motion, units)}", *rows, *bounds,
                      *(row(*fact) for fact in top_rows(motion.top, units)),
                      *tilt_lines(case, motion, units, proofs),
                      *why(case, motion, units, proofs), *frame.note(case),
                      *([_said(told, units, " of the margin, energy")] * say)])


def extremes(case: Case, motion: Motion, told: Told, units: Units, all_digits: bool, say: bool,
             proofs: bool = False) -> str:
    """The largest rate and the fate, a line a component, and bounds for all times."""
    shown = _with(motion, told)
    def line(short: bool) -> str:
        upper = [largest(shown, units, short)]
        parts = [*outcome(shown, units, short), cause(shown, units)]
        parts = [*parts, *upper] if motion.fate.word in ("spin-up", "equilibrium") else [*upper, *parts]
        return "; ".join(filter(None, [*parts, *directions(shown, units)]))
    rows = [f"  extremes: {units.said(shown.over)}"]
    if shown.extremes is not None:
        rows = _all_digits(case, shown, told) if all_digits else extreme_lines(case, shown, units)
    return "\n".join([f"{case.name}: {limiting.fitted(line, before(case, motion))}", *rows,
                      *bound_lines(case, motion, units),
                      *(why(case, motion, units, proofs) if proofs else ()), *frame.note(case),
                      *([_said(told, units)] * (say and told.reason != shown.over))])


def _all_digits(case: Case, motion: Motion, shown: Told):
    """A line a component, every digit that was asked for; in rad/s, in which they were checked."""
    unit = "" if case.variables == "scaled" else "rad/s"
    pairs = shown.decimals or [[number(v, max(SHOWN, shown.asked)) for v in pair] for pair in motion.extremes]
    wide, word = max(24, shown.asked + 8), lambda end: "unbounded" if end in ("inf", "-inf") else end
    rows = (f"  {lettered(name):<8}{word(low):>{wide}}{word(high):>{wide}}  {unit}".rstrip()
            for name, (low, high) in zip(case.scene.components, pairs))
    return [f"  over {motion.extremes_over}, least and greatest:", *rows]


def _said(printed: Told, units: Units, of: str = "") -> str:
    """How many digits were checked, of what, and how."""
    because, digits = units.said(printed.reason), printed.digits
    if digits is None:
        return f"  {because}"
    return f"  exact: {because}" if math.isinf(digits) else (
        f"  {f'{digits:.1f}'.removesuffix('.0')} digits{of}: {because}")


def period(case: Case, motion: Motion, told: Told, units: Units, all_digits: bool, say: bool,
           proofs: bool = False) -> str:
    """The period with its unit."""
    if told.values is None:
        value = (units.said(no_period(motion.fate))
                 + (f" ({motion.fate.word})" if motion.fate in (Fate.SPIN_UP, Fate.SEPARATRIX, Fate.BOUNDED)
                    else ""))
    elif all_digits:
        value = (
            f"period {told.decimals or number(told.values, max(SHOWN, told.asked))} "
            f"{lettered(case.scene.time_unit)}")
    else:
        value = f"period {units.time(told.values)}"
    rest = [flips(motion, units), limiting.unstable(motion.caveats, units),
            limiting.reached(motion.caveats, units), limiting.tilted(motion.caveats, units)]

    def line(short: bool) -> str:
        holds = limiting.condition(motion.caveats, units, short=short)
        return "; ".join(filter(None, [value + (holds and f",{holds}"), *rest]))
    lines = [f"{case.name}: {limiting.fitted(line, before(case, motion))}",
             *(why(case, motion, units, proofs) if proofs else ())]
    return "\n".join([*lines, *([_said(told, units)] * (say and told.values is not None))])


# --- As JSON and CSV
def _object(question, case, motion, printed, result) -> dict:
    """What all objects have, and what was found; digits.reached: null where there is no number to judge."""
    exact = printed.digits is not None and math.isinf(printed.digits)
    shown = max(99.0, printed.asked) if exact else printed.digits
    return ({"schema": f"stabilab.{question}/1", "case": case.name, "variables": case.variables,
             "at": motion.at, "fate": motion.fate.word} | result
            | {"digits": {"asked": printed.asked, "reached": shown}
               | values_of(printed, "method because decimals") | {"reason": printed.reason.as_dict()}}
            | {"reason": motion.reason.as_dict(), "numbers": numbers(motion),
               "flips": flips_dict(case, motion)} | ending.key(case, motion.ending))


def extremes_dict(case: Case, motion: Motion, printed: Told) -> dict:
    """One object of `stabilab extremes --json`; null where a component is unbounded or unknown (see fate)."""
    motion = _with(motion, printed)
    return _object("extremes", case, motion, printed, {
        "components": case.scene.components, "extremes": motion.extremes, "over": motion.extremes_over,
        **followed(motion)})


def _with(motion, printed):
    return (motion if printed.values is None
            else replace(motion, extremes=tuple(tuple(map(float, pair)) for pair in printed.values)))


def fate_dict(case: Case, motion: Motion, printed: Told) -> dict:
    """One object of `stabilab fate --json`; margin: barrier minus energy, null where none stands ahead."""
    margin = motion.margin_energy if printed.values is None else printed.values
    return _object("fate", case, motion, printed, {
        **axes_of(case).key(motion.axis), "sense": motion.sense or None, "because": motion.because,
        "margin": margin, "tilt": tilt_dict(motion.tilt), **followed(motion),
        **top_key(motion.top)})


def period_dict(case: Case, motion: Motion, printed: Told) -> dict:
    """One object of `stabilab period --json`; period: null where there is none or it is not known."""
    return _object("period", case, motion, printed,
                   {"period": printed.values, "time": case.scene.time_unit})


def extremes_lines(case, motion, printed):
    """A line of CSV a component, every digit asked for; inf: unbounded, empty: unknown."""
    pairs = printed.decimals or _with(motion, printed).extremes or ((None, None),) * 3
    return [limiting.Line((case.name, name, *pair, motion.extremes_over), ending=motion.ending)
            for name, pair in zip(case.scene.components, pairs)]


EXTREMES_CSV = ("case", "component", "min", "max", "over"), extremes_lines
