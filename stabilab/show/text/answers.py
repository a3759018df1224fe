"""Answers as JSON, CSV and plain text: equilibria, fates, extremes, trajectories."""
from __future__ import annotations

import math

from ...physics.blocks import PARTS
from ..files import comma
from . import frame, when

UNITS = {"physical": ("rad/s", "s", "J"), "scaled": ("", "tau", "")}


ENDLESS = {math.inf: "1e999", -math.inf: "-1e999"}  # numbers by JSON's grammar, beyond all doubles: Python, JavaScript and MATLAB read them as infinite
MARK = "\0 endless "  # before such a number in the text until its quotes are taken off


class Endless(float):
    """The end of an interval that may have none: infinite, it is told as such, where null would stand for what is not known."""


def as_json(value) -> str:
    """JSON with every digit of a double; what does not exist (and infinity, unless it is an end that is told as `Endless`) is null."""
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
                           "points": [_point(p) | _input(case, p.at) for p in equilibria.points],
                           "curves": [_curve(c) for c in equilibria.curves]},
            "motion": None if motion is None else _motion(motion) | _input(case, motion.at)} | frame.key(case)


def _input(case, at) -> dict:
    """The same vector in the frame of the file, where that is another one."""
    found = frame.back(case, at[:3])
    return {} if found is None else {"at_input": found}


def _point(p) -> dict:
    return {"at": p.at, "eigenvalues": p.eigenvalues, "linear": p.linear, "verdict": p.verdict, "because": p.because}


def _curve(c) -> dict:
    return {"name": c.name, "equation": c.equation, "parametrisation": c.parametrisation,
            "samples": [_point(p) for p in c.samples], "folds": c.folds,
            "segments": [{"t": s.t, "linear": s.linear, "verdict": s.verdict, "because": s.because} for s in c.segments]}


def _motion(m) -> dict:
    return {"at": m.at, "fate": m.fate.word, "axis": m.axis or None, "because": m.because,
            "margin": {"energy": m.margin_energy, "angular_velocity": m.margin_velocity, "bounds": m.velocity_bounds,
                       "witness": m.velocity_witness, "because": m.velocity_because or None},
            "period": m.period, "extremes": m.extremes, "invariants": m.invariants,
            "sense": m.sense or None, "extremes_over": m.extremes_over, "evidence": m.evidence, "tilt": when.tilt_dict(m.tilt)} | followed(m)


def followed(m) -> dict:
    """How well a fate is known; of a motion that was followed also when its certificate held (null: it did not), what was seen on the way,
    and the bounds of the rates for all times (null in them: unbounded)."""
    known = {"level": m.level}
    if m.cause:
        known |= {"t": m.evidence.get("t_certificate"), "cause": m.cause, "bounds": m.bounds}
    return known


def undecided(equilibria, motion) -> bool:
    """True where a verdict or the fate is undecided."""
    parts = [*equilibria.points, *(part for c in equilibria.curves for part in (*c.segments, *c.samples))]
    unknown = equilibria.kind == "undecided" or any(p.verdict == "undecided" for p in parts)
    return unknown or (motion is not None and motion.fate.word == "undecided")


def extremes(case, motion) -> dict:
    """One object of `stabilab extremes --json`; null where a component is unbounded or unknown (see fate)."""
    return {"schema": "stabilab.extremes/1", "case": case.name, "variables": case.variables, "at": motion.at,
            "fate": motion.fate.word, "components": case.scene.components, "extremes": motion.extremes,
            "over": motion.extremes_over} | followed(motion) | frame.key(case)


def simulation(case, run) -> dict:
    """The object of `stabilab simulate --json`."""
    return {"schema": "stabilab.simulate/1", "case": case.name, "model": run.model, "time": case.scene.time_unit,
            "t": run.t, "state": run.state, "invariant_drift": run.invariant_drift, "counters": run.counters,
            "method": run.method, "rtol": run.rtol, "status": run.status, "reason": run.reason} | frame.rows(case, run) | frame.key(case)


def columns(run) -> tuple[list[str], list[list[float]]]:
    """Names and rows of everything a run has, time left out."""
    import numpy as np
    names: list[str] = []
    parts: list[np.ndarray] = []
    for name, values in run.state.items():
        values = np.asarray(values, float)
        names += PARTS[name].components
        parts.append(values.reshape(len(run.t), values.shape[-1] if values.ndim == 2 else 1))
    return names, np.hstack(parts).tolist()


def extremes_csv(answered) -> str:
    """One line per case, motion and pairs (numbers or decimals; None where unknown) and component; inf where unbounded, empty where unknown."""
    return comma.lines([("case", "component", "min", "max", "over"), *(
        (case.name, name, *pair, m.extremes_over) for case, m, pairs in answered for name, pair in zip(case.scene.components, _pairs(pairs)))])[:-1]


def _pairs(extremes):
    """Least and greatest of every component, None where unknown."""
    return ((None, None),) * 3 if extremes is None else extremes


def _extreme_lines(case, pairs) -> list[str]:
    unit = UNITS[case.variables][0]
    return [f"  {name:<8}{_number(low):>24}{_number(high):>24}  {unit}".rstrip()
            for name, (low, high) in zip(case.scene.components, _pairs(pairs))]


def classification_text(case, equilibria, motion) -> str:
    """What `stabilab classify` prints for one case."""
    head = [f"{case.name}: {case.title}" if case.title else case.name, f"variables: {case.variables}",
            *frame.lines(case), f"equilibria: {equilibria.kind}", f"  {equilibria.reason}"]
    points = [line for p in equilibria.points for line in _point_lines(p)]
    curves = [line for c in equilibria.curves for line in _curve_lines(c)]
    return "\n".join(head + points + curves + ([] if motion is None else _motion_lines(case, motion)))


def _point_lines(p) -> list[str]:
    roots = ", ".join(_complex(z) for z in p.eigenvalues)
    return [f"  at {_triple(p.at)}: {p.verdict} (linear: {p.linear}; eigenvalues {roots})", f"    {p.because}"]


def _curve_lines(c) -> list[str]:
    lines = [f"  {c.name}: {c.equation}", f"    {c.parametrisation}"]
    for s in c.segments:
        lines += [f"    t from {_number(s.t[0])} to {_number(s.t[1])}: {s.verdict} (linear: {s.linear})", f"      {s.because}"]
    return lines + [f"    fold at {_triple(f)}" for f in c.folds]


def _motion_lines(case, m) -> list[str]:
    rate, time, energy = UNITS[case.variables]
    spin = f" about axis {m.axis}, sense {m.sense:+d}" if m.axis else ""
    head = f"{verb(m)}{spin}{known_as(m)}{when.while_on_axis(case, m)}"
    rows = [("margin, energy", _known(m.margin_energy), energy), ("margin, rate", _distance(m), rate),
            ("period", _known(m.period), time)]
    lines = [f"motion from {_triple(m.at)}: {head}", f"  {m.because}"]
    lines += [f"  {name:<24}{words} {unit}".rstrip() for name, words, unit in rows if words]
    if m.velocity_because:
        lines.append(f"  {'' if m.velocity_bounds else 'margin, rate unknown: '}{m.velocity_because}")
    lines += [f"  {_spaced(name):<24}{_number(value)}" for name, value in m.invariants.items()]
    lines += [f"  {_spaced(name):<24}{_number(value) if isinstance(value, float) else value}"
              for name, value in m.evidence.items() if value is not None]
    lines += [f"  least and greatest over {m.extremes_over}:"] + _extreme_lines(case, m.extremes) if m.extremes is not None else []
    return lines + bound_lines(case, m) + when.tilt_lines(case, m)


def verb(m) -> str:
    """The fate as the first words of an answer: a spin-up that was found by following the motion is the news itself."""
    return "SPINS UP" if m.cause and m.fate.word == "spin-up" else m.fate.word


def known_as(m) -> str:
    """How well a fate is known, where that is not a matter of course."""
    return f" ({m.level})" if m.cause and m.fate.word != "undecided" else ""


def bound_lines(case, m) -> list[str]:
    """The bounds of the rates for all times, where they are not the extremes told already."""
    if m.bounds is None or m.bounds == m.extremes:
        return []
    return ["  bounds for all times:", *_extreme_lines(case, m.bounds)]


def _known(value) -> str:
    return "" if value is None else _number(value)


def _distance(m) -> str:
    """The distance from the separatrix: a number where it is one to 1e-9, else its bounds."""
    if m.velocity_because and m.velocity_bounds:
        low, high = m.velocity_bounds
        return f"between {_number(low)} and {_number(high)}"
    return _known(m.margin_velocity)


def simulation_text(case, run) -> str:
    """Times and states in columns, then the departures from the laws of motion."""
    names, rows = columns(run)
    head = "".join(f"{name:>25}" for name in (case.scene.time_unit, *names))
    lines = ["".join(f"{v:>25.16g}" for v in (t, *row)) for t, row in zip(run.t, rows)]
    laws = [f"# {name}: largest relative departure {value:.3g}" for name, value in run.invariant_drift.items()]
    how = f"# {run.method}, rtol {run.rtol:.3g}" if run.rtol else f"# {run.model}: {run.method}"
    notes = [f"# {run.reason}"] if run.reason and run.reason != "all times reached" else []
    return "\n".join([head, *lines, how, *laws, *notes, *(f"# {line.strip()}" for line in frame.note(case))])


def _number(value) -> str:
    if value is None:
        return "unknown"
    return "unbounded" if math.isinf(value) else f"{float(value) + 0.0:.12g}"


def _spaced(name: str) -> str:
    return name.replace("_", " ")


def _triple(at) -> str:
    return "(" + ", ".join(f"{float(v) + 0.0:.12g}" for v in at) + ")"


def _complex(z) -> str:
    z = complex(z)
    if z.imag == 0:
        return f"{z.real + 0.0:.6g}"
    return f"{z.imag:+.6g}i" if z.real == 0 else f"{z.real:.6g}{z.imag:+.6g}i"
