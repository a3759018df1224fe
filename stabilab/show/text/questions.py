"""What `fate`, `extremes` and `period` print: the answer, its numbers, why, and how many digits were checked;
the same as JSON and CSV."""
from __future__ import annotations

import math
from dataclasses import replace

from ...orbit.result import Fate, no_period
from ...representation import values_of
from .. import frame, limiting
from ..axes import axes_of
from ..data import csv_lines
from ..terminal.letters import greek
from ..units import DIGITS, Units, number
from . import when
from .headline import cause, largest, outcome, rate_margin, verdict
from .motion import bound_lines, energy_margin, extreme_lines, followed, reason, row, tilt_lines, why

SHOWN = 12  # digits of a number that is not written out, where more than a table's were asked for


def fate(case, motion, told, units: Units, all_digits: bool, say: bool, proofs: bool = False) -> str:
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


def extremes(case, motion, told, units: Units, all_digits: bool, say: bool, proofs: bool = False) -> str:
    """The largest rate and the fate, a line a component, and bounds for all times."""
    shown = _with(motion, told)
    parts, most = [*outcome(shown, units), cause(shown, units)], [largest(shown, units)]
    parts = [*parts, *most] if motion.fate.word == "spin-up" else [*most, *parts]
    rows = [f"  extremes: {shown.extremes_over}"]
    if shown.extremes is not None:
        rows = _all_digits(case, shown, told) if all_digits else extreme_lines(case, shown, units)
    return "\n".join([f"{case.name}: {'; '.join(filter(None, parts))}", *rows,
                      *bound_lines(case, motion, units),
                      *(why(case, motion, units, proofs) if proofs else ()), *frame.note(case),
                      *([_said(told, units)] * (say and told.because != shown.extremes_over))])


def _all_digits(case, motion, told):
    """A line a component, every digit that was asked for; in rad/s, in which they were checked."""
    unit = "" if case.variables == "scaled" else "rad/s"
    pairs = told.decimals or [[number(v, max(SHOWN, told.asked)) for v in pair] for pair in motion.extremes]
    wide, word = max(24, told.asked + 8), lambda end: "unbounded" if end in ("inf", "-inf") else end
    rows = (f"  {greek(name):<8}{word(low):>{wide}}{word(high):>{wide}}  {unit}".rstrip()
            for name, (low, high) in zip(case.scene.components, pairs))
    return [f"  over {motion.extremes_over}, least and greatest:", *rows]


def _said(told, units, of: str = "") -> str:
    """How many digits were checked, of what, and how."""
    because, digits = reason(told.because, units), told.digits
    if digits is None:
        return f"  {because}"
    return f"  exact: {because}" if math.isinf(digits) else (
        f"  {f'{min(digits, 99.0):.1f}'.removesuffix('.0')} digits{of}: {because}")


def period(case, motion, told, units: Units, all_digits: bool, say: bool, proofs: bool = False) -> str:
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
    parts = [value + (holds and f",{holds}"), limiting.reached(motion.caveats, units),
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
               | values_of(told, "method because decimals")}
            | limiting.key(case, motion.caveats) | frame.key(case))


def extremes_dict(case, motion, told) -> dict:
    """One object of `stabilab extremes --json`; null where a component is unbounded or unknown (see fate)."""
    motion = _with(motion, told)
    return _object("extremes", case, motion, told, {
        "components": case.scene.components, "extremes": motion.extremes, "over": motion.extremes_over,
        **followed(motion)})


def _with(motion, told):
    return (motion if told.values is None
            else replace(motion, extremes=tuple(tuple(map(float, pair)) for pair in told.values)))


def fate_dict(case, motion, told) -> dict:
    """One object of `stabilab fate --json`; margin: barrier minus energy, null where none stands ahead."""
    margin = motion.margin_energy if told.values is None else told.values
    return _object("fate", case, motion, told, {
        **axes_of(case).key(motion.axis), "sense": motion.sense or None, "because": motion.because,
        "margin": margin, "tilt": when.tilt_dict(motion.tilt), **followed(motion)})


def period_dict(case, motion, told) -> dict:
    """One object of `stabilab period --json`; period: null where there is none or it is not known."""
    return _object("period", case, motion, told,
                   {"period": told.values, "time": case.scene.time_unit})


def extremes_csv(answered) -> str:
    """A line a component of (case, motion, digits), every digit asked for; inf: unbounded, empty: unknown."""
    rows = [(case.name, name, *pair, moved.extremes_over, limiting.cell(case, moved.caveats))
            for case, moved, told in answered for pairs in [told.decimals or _with(moved, told).extremes]
            for name, pair in zip(case.scene.components, pairs or ((None, None),) * 3)]
    return csv_lines([("case", "component", "min", "max", "over", "caveats"), *rows])[:-1]
