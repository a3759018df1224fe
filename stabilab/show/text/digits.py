"""Extremes, period and fate with the digits that were checked, as JSON and text."""
from __future__ import annotations

import math
from dataclasses import replace

from . import answers, frame, when

SHOWN = 12  # digits of a number in text where no more were asked for


def as_dict(told) -> dict:
    """What is said of the digits; reached: null where there is no number to judge. decimals: the answer written out."""
    shown = None if told.digits is None else min(told.digits, 99.0)
    return {"asked": told.asked, "reached": shown, "method": told.method, "because": told.because, "decimals": told.decimals}


def extremes(case, motion, told) -> dict:
    """One object of `stabilab extremes --json`."""
    return answers.extremes(case, _with(motion, told)) | {"digits": as_dict(told)}


def _with(motion, told):
    return motion if told.values is None else replace(motion, extremes=tuple(tuple(map(float, pair)) for pair in told.values))


def extremes_csv(answered) -> str:
    """As of `answers.extremes_csv`, every digit that was asked for."""
    return answers.extremes_csv([(case, motion, told.decimals or _with(motion, told).extremes) for case, motion, told in answered])


def extremes_text(case, motion, told, say: bool) -> str:
    """Case, a line per component, and, where `say`, the digits."""
    lines = [f"{case.name}: {motion.fate.word}, extremes over {motion.extremes_over}{answers.known_as(motion)}"]
    unit, wide = answers.UNITS[case.variables][0], max(24, told.asked + 8)
    pairs = told.decimals or [[_number(v, told.asked) for v in pair] for pair in (_with(motion, told).extremes or ((None, None),) * 3)]
    lines += [f"  {name:<8}{_word(low):>{wide}}{_word(high):>{wide}}  {unit}".rstrip() for name, (low, high) in zip(case.scene.components, pairs)]
    return "\n".join(lines + answers.bound_lines(case, motion) + frame.note(case) + [_said(told)] * say)


def _word(text) -> str:
    return "unbounded" if text in ("inf", "-inf") else text


def _number(value, digits) -> str:
    if value is None:
        return "unknown"
    return "unbounded" if math.isinf(value) else f"{float(value) + 0.0:.{max(SHOWN, digits)}g}"


def _said(told) -> str:
    if told.digits is None:
        return f"  {told.because}"
    return f"  exact: {told.because}" if math.isinf(told.digits) else f"  {min(told.digits, 99.0):.1f} digits: {told.because}"


def fate(case, motion, told) -> dict:
    """One object of `stabilab fate --json`; margin: barrier minus energy, null where no barrier stands ahead."""
    margin = motion.margin_energy if told.values is None else told.values
    return {"schema": "stabilab.fate/1", "case": case.name, "variables": case.variables, "at": motion.at, "fate": motion.fate.word,
            "axis": motion.axis or None, "sense": motion.sense or None, "because": motion.because, "margin": margin,
            "digits": as_dict(told), "tilt": when.tilt_dict(motion.tilt)} | answers.followed(motion) | frame.key(case)


def fate_text(case, motion, told, say: bool) -> str:
    """The fate, why, and the margin in energy."""
    spin = f" about axis {motion.axis}, {'positive' if motion.sense > 0 else 'negative'} sense" if motion.axis else ""
    unit = answers.UNITS[case.variables][2]
    margin = [] if told.values is None else [f"  margin, energy  {told.decimals or _number(told.values, told.asked)} {unit}".rstrip()]
    bounds = answers.bound_lines(case, replace(motion, extremes=None))
    head = f"{case.name}: {answers.verb(motion)}{spin}{answers.known_as(motion)}{when.while_on_axis(case, motion)}"
    return "\n".join([head, f"  {motion.because}", *margin, *bounds,
                      *(when.tilt_lines(case, motion) if motion.tilt else ()),
                      *frame.note(case), *([_said(told)] * say)])


def period(case, motion, told) -> dict:
    """One object of `stabilab period --json`; null where the motion does not repeat."""
    return {"schema": "stabilab.period/1", "case": case.name, "variables": case.variables, "at": motion.at, "fate": motion.fate.word,
            "period": told.values, "time": case.scene.time_unit, "digits": as_dict(told)} | frame.key(case)


def period_text(case, motion, told, say: bool) -> str:
    """The period with its unit."""
    value = f"the motion does not repeat ({motion.fate.word})" if told.values is None else (
        f"period {told.decimals or _number(told.values, told.asked)} {case.scene.time_unit}")
    return "\n".join([f"{case.name}: {value}", *([_said(told)] * (say and told.values is not None))])
