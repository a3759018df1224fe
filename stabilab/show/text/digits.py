"""Extremes, period and fate with the digits that were checked, as JSON and CSV."""
from __future__ import annotations

from dataclasses import replace

from .. import limiting
from ..axes import axes_of
from . import answers, frame, when


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


def fate(case, motion, told) -> dict:
    """One object of `stabilab fate --json`; margin: barrier minus energy, null where no barrier stands ahead."""
    margin = motion.margin_energy if told.values is None else told.values
    return {"schema": "stabilab.fate/1", "case": case.name, "variables": case.variables, "at": motion.at, "fate": motion.fate.word,
            **axes_of(case).key(motion.axis), "sense": motion.sense or None, "because": motion.because, "margin": margin,
            "digits": as_dict(told), "tilt": when.tilt_dict(motion.tilt)} | answers.followed(motion) | limiting.key(case, motion.caveats) | frame.key(case)


def period(case, motion, told) -> dict:
    """One object of `stabilab period --json`; null where the motion does not repeat, or is undecided (see fate, digits.because)."""
    return {"schema": "stabilab.period/1", "case": case.name, "variables": case.variables, "at": motion.at, "fate": motion.fate.word,
            "period": told.values, "time": case.scene.time_unit, "digits": as_dict(told)} | limiting.key(case, motion.caveats) | frame.key(case)


