"""Answers as JSON and CSV: equilibria, fates, extremes, periods, trajectories; every digit of a double."""
from __future__ import annotations

import math
from dataclasses import asdict, replace

from ...physics.scene import ATTITUDES, PARTS
from ...representation import values_of
from .. import limiting
from ..axes import axes_of
from ..files import comma
from . import frame, when

# numbers by JSON's grammar, beyond all doubles: Python, JavaScript and MATLAB read them as infinite
ENDLESS = {math.inf: "1e999", -math.inf: "-1e999"}
MARK = "\0 endless "  # before such a number in the text until its quotes are taken off


class Endless(float):
    """The end of an interval that may have none: infinite, it is told as such, where null would stand for
    what is not known."""


def as_json(value) -> str:
    """JSON with every digit of a double; what does not exist (and infinity, unless it is an end that is told
    as `Endless`) is null."""
    import json
    text = json.dumps(plain(value), allow_nan=False, ensure_ascii=False, indent=1)
    for told in ENDLESS.values():
        text = text.replace(json.dumps(MARK + told), told)
    return text


def plain(value):
    """The value in lists, dicts, floats and None: complex numbers as [re, im], infinities and NaN as None.
    What is `Endless` is a marked string where it is infinite."""
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if isinstance(value, complex):
        return [plain(value.real), plain(value.imag)]
    if isinstance(value, Endless) and value in ENDLESS:
        return MARK + ENDLESS[value]
    if isinstance(value, float):
        return float(value) + 0.0 if math.isfinite(value) else None
    if hasattr(value, "tolist"):  # NumPy scalars and arrays
        return plain(value.tolist())
    return value


def classification(case, equilibria, motion) -> dict:
    """One object of `stabilab classify --json`."""
    return {"schema": "stabilab.classify/1", "case": case.name, "variables": case.variables,
            "equilibria": {"kind": equilibria.kind, "reason": equilibria.reason,
                           "points": [_point(case, p) | _input(case, p.at) for p in equilibria.points],
                           "curves": [_curve(case, c) for c in equilibria.curves]},
            "motion": None if motion is None else _motion(case, motion) | _input(case, motion.at)
            } | ({} if motion is None else limiting.key(case, motion.caveats)) | frame.key(case)


def _input(case, at) -> dict:
    """The same vector in the frame of the file, where that is another one."""
    found = frame.back(case, at[:3])
    return {} if found is None else {"at_input": found}


def _point(case, p) -> dict:
    """With the Jacobian, row by row, where the state is the three rates alone, and the coefficients of its
    characteristic polynomial, highest power first."""
    jacobian = case.scene.quadratic().jacobian(tuple(map(float, p.at))) if case.scene.plain else None
    return {"at": p.at, "jacobian": jacobian} | values_of(
        p, "characteristic eigenvalues linear verdict because")


def _curve(case, c) -> dict:
    return values_of(c, "name equation parametrisation") | {
        "samples": [_point(case, p) for p in c.samples], "folds": c.folds,
        "segments": [values_of(s, "t linear verdict because") for s in c.segments]}


def _motion(case, m) -> dict:
    return {"at": m.at, "fate": m.fate.word, **axes_of(case).key(m.axis), "because": m.because,
            "margin": {"energy": m.margin_energy, "angular_velocity": m.margin_velocity,
                       "bounds": m.velocity_bounds,
                       "witness": m.velocity_witness, "because": m.velocity_because or None},
            **values_of(m, "period extremes invariants"),
            "energy_integral": None if m.energy_integral is None else asdict(m.energy_integral),
            "sense": m.sense or None, **values_of(m, "extremes_over evidence"),
            "tilt": when.tilt_dict(m.tilt)} | followed(m)


def followed(m) -> dict:
    """How well a fate is known; of a motion that was followed also when its certificate held (null: it did
    not), what was seen on the way, and the bounds of the rates for all times (null in them: unbounded)."""
    known = {"level": m.level}
    if m.cause:
        known |= {"t": m.evidence.get("t_certificate"), "cause": m.cause, "bounds": m.bounds}
    return known


def undecided(equilibria, motion) -> bool:
    """True where a verdict or the fate is undecided."""
    parts = [*equilibria.points, *(part for c in equilibria.curves for part in (*c.segments, *c.samples))]
    unknown = equilibria.kind == "undecided" or any(p.verdict == "undecided" for p in parts)
    return unknown or (motion is not None and motion.fate.word == "undecided")


def digits(told) -> dict:
    """What is said of the digits; reached: null where there is no number to judge."""
    shown = None if told.digits is None else min(told.digits, 99.0)
    return {"asked": told.asked, "reached": shown} | values_of(told, "method because decimals")


def extremes(case, motion, told) -> dict:
    """One object of `stabilab extremes --json`; null where a component is unbounded or unknown (see fate)."""
    motion = _with(motion, told)
    found = {"schema": "stabilab.extremes/1", "case": case.name, "variables": case.variables, "at": motion.at,
             "fate": motion.fate.word, "components": case.scene.components, "extremes": motion.extremes,
             "over": motion.extremes_over}
    return found | followed(motion) | _around(case, motion) | {"digits": digits(told)}


def _around(case, motion) -> dict:
    """The caveats and the frame."""
    return limiting.key(case, motion.caveats) | frame.key(case)


def _with(motion, told):
    return (motion if told.values is None
            else replace(motion, extremes=tuple(tuple(map(float, pair)) for pair in told.values)))


def fate(case, motion, told) -> dict:
    """One object of `stabilab fate --json`; margin: barrier minus energy, null where none stands ahead."""
    margin = motion.margin_energy if told.values is None else told.values
    return {"schema": "stabilab.fate/1", "case": case.name, "variables": case.variables, "at": motion.at,
            "fate": motion.fate.word,
            **axes_of(case).key(motion.axis), "sense": motion.sense or None, "because": motion.because,
            "margin": margin, "digits": digits(told), "tilt": when.tilt_dict(motion.tilt)
            } | followed(motion) | _around(case, motion)


def period(case, motion, told) -> dict:
    """One object of `stabilab period --json`; null where the motion does not repeat, or is undecided (see
    fate, digits.because)."""
    return {"schema": "stabilab.period/1", "case": case.name, "variables": case.variables, "at": motion.at,
            "fate": motion.fate.word, "period": told.values, "time": case.scene.time_unit,
            "digits": digits(told)} | _around(case, motion)


def simulation(case, run) -> dict:
    """The object of `stabilab simulate --json`."""
    return {"schema": "stabilab.simulate/1", "case": case.name, "model": run.model,
            "time": case.scene.time_unit,
            **values_of(run, "t state error invariant_drift counters method rtol status reason"),
            **{name: PARTS[name].words for name in ATTITUDES if name in run.state}
            } | frame.rows(case, run) | frame.key(case)


def columns(run) -> tuple[list[str], list[list[float]]]:
    """Names and rows of everything a run has, time left out."""
    import numpy as np
    names: list[str] = []
    parts: list[np.ndarray] = []
    for name, values in run.state.items():
        values = np.asarray(values, float)
        names += PARTS[name].components
        parts.append(values.reshape(len(run.t), int(np.prod(values.shape[1:]))))
    return names, np.hstack(parts).tolist()


def errors(run) -> list[float]:
    """The error of each of the columns, 0 where none is known."""
    import numpy as np
    return [float(v) for name, values in run.state.items()
            for v in np.broadcast_to(run.error.get(name, 0.0), np.shape(values)[1:]).ravel()]


def lost(t: float, value: float, error: float) -> bool:
    """Whether a number is no more than its error: rounding. What a start gives is known."""
    return t != 0 and 0 < abs(value) <= error


def extremes_csv(answered) -> str:
    """A line a component of (case, motion, digits), every digit asked for; inf: unbounded, empty: unknown."""
    rows = [(case.name, name, *pair, moved.extremes_over, limiting.cell(case, moved.caveats))
            for case, moved, told in answered for pairs in [told.decimals or _with(moved, told).extremes]
            for name, pair in zip(case.scene.components, pairs or ((None, None),) * 3)]
    return comma.lines([("case", "component", "min", "max", "over", "caveats"), *rows])[:-1]
