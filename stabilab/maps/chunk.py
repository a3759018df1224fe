"""The answers for a chunk of points, in rows of one record each."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from ..answers.caveats import HOLDS, STEADY, condition
from ..answers.chaos import chaos, long_enough, row_of
from ..answers.equilibria import equilibria
from ..answers.extremes import extremes, period
from ..answers.fate import fate
from ..answers.kinds import KINDS, kind_of
from ..answers.motion import motion
from ..answers.time_to import time_to
from ..case.read import Case, blamed_on
from ..equilibrium.gyrostat import number_of_equilibria
from ..errors import CaseError, InputError
from ..numbers.numba_door import installed
from ..orbit.extremes_and_periods import extremes_and_periods
from ..orbit.result import Fate
from ..physics.coefficients import effective
from ..physics.states import start_of
from .columns import ENDLESS, LEVELS, LIMIT_LEVELS, NO_CASE, NONE, OPEN, record
from .plan import Chunk, Plan
from .points import case_of, states_of

COMPILED = 200  # states for which loading numba's code pays: half a second, of librations in plain Python
POINTED_WORK = 100_000  # multiplications for the proof of a time in an atlas: it leaves long motions to compiled steps, which prove them sooner
NO_CASE_VALUES = {"fate": NO_CASE, "level": -1, "reason": -1, "when_level": -1, "chaos": -1, "equilibria": NONE, "stable": NONE, "unstable": NONE, "open": NONE}

PERIODS = {Fate.EQUILIBRIUM: 0.0, Fate.SPIN_UP: np.inf, Fate.SEPARATRIX: np.inf}  # of motions that have none


def answered(plan: Plan, number: int) -> np.ndarray:
    """(points,) of `columns.record`: the answers for a chunk, in the inner order."""
    chunk = plan.chunks[number]
    rows = np.zeros(chunk.points, record(plan.answers))
    size = chunk.high - chunk.low
    for n, scene in enumerate(range(chunk.first, chunk.last)):
        _scene(plan, scene, chunk, rows[n * size:(n + 1) * size])
    return rows


def _scene(plan: Plan, scene: int, chunk: Chunk, out: np.ndarray) -> None:
    try:
        case = case_of(plan, scene)
    except CaseError:
        for name in out.dtype.names:
            if out.dtype[name].base.kind == "f":
                out[name] = np.nan
            elif name in NO_CASE_VALUES:
                out[name] = NO_CASE_VALUES[name]
        return
    out["valid"] = 1
    with blamed_on(case):
        if case.state is not None:
            states = states_of(plan, case, chunk.low, chunk.high)
            if set(plan.answers) - {"chaos"}:
                (_many if effective(case.scene).plain else _single)(plan, case, states, out)
            if "chaos" in plan.answers:
                _chaos(plan, case, states, out)
        if "equilibria" in plan.answers or "verdict" in plan.answers:
            _equilibria(case, out)
    if "caveats" in out.dtype.names:
        out["caveats"] = _caveats(case, out)


def _caveats(case: Case, out: np.ndarray) -> np.ndarray:
    """Of each point, by its place in `columns.CAVEATS`."""
    steady = np.isin(out["fate"], STEADY) if "fate" in out.dtype.names else np.zeros(len(out), bool)
    if "when_low" in out.dtype.names:
        steady |= np.isposinf(out["when_low"])
    unphysical = any(one.kind == "unphysical" for one in case.caveats)
    return np.where(steady, condition(case.scene), 0) + len(HOLDS) * unphysical


def _many(plan: Plan, case: Case, states: np.ndarray, out: np.ndarray) -> None:
    """The states of a scene whose answers come in arrays."""
    asked, scene = plan.answers, case.scene
    if {"fate", "level", "reason", "island", "margin", "distance"} & set(asked):
        found = fate(scene, states, **_following(plan, case))
        columns: dict[str, Callable[[], Any]] = {
            "fate": lambda: found.labels, "spin_axis": lambda: found.axis * found.sense, "reason": lambda: found.reasons, "margin": lambda: found.margins,
            "level": lambda: found.level_numbers(LEVELS), "distance": lambda: found.velocity_margins,
            "island": lambda: 0 if found.followed is None else found.followed.islands}
        for name, column in columns.items():
            if name in out.dtype.names:
                out[name] = column()
    if {"extremes", "period"} & set(asked):
        box, times = _extremes_and_periods(case, states, "extremes" in asked, "period" in asked)
        if box is not None:
            out["least"], out["greatest"] = box[..., 0], box[..., 1]
        if times is not None:
            out["period"] = times
    if "when" in asked:
        limit = plan.limit_of(case)
        brief: dict[str, Any] = {} if plan.pointed is None or plan.pointed.certify else {"work": POINTED_WORK}
        _times(time_to(scene, states, **limit.ask, t_max=limit.until, **brief), out)


def _following(plan: Plan, case: Case) -> dict[str, Any]:
    """How motions of an atlas are followed: each is alone in its scene, and all of them together are worth the compiler."""
    if plan.pointed is None or not KINDS[kind_of(effective(case.scene))].follows:
        return {"follow": plan.longest}
    return {"follow": plan.longest, "fast": installed() or None, "proof": plan.pointed.certify}


def _chaos(plan: Plan, case: Case, states: np.ndarray, out: np.ndarray) -> None:
    """All followed as long as the case's own motion is, whatever their company."""
    end = long_enough(plan.case.scene, row_of(plan.case.scene, plan.case.state, plan.case.blocks))
    rows = np.array([row_of(case.scene, state, case.blocks) for state in states.tolist()])
    found = chaos(case.scene, rows, end if plan.longest is None else plan.longest)
    out["chaos"], out["megno"], out["lyapunov"] = found.labels, found.megno, found.lyapunov


def _extremes_and_periods(case: Case, states: np.ndarray, box: bool, times: bool) -> tuple[np.ndarray | None, np.ndarray | None]:
    """(extremes or None, periods or None). Whether numba serves hangs on the number of states alone, not on what this process did before: its last
    digits are not those of plain Python."""
    kind = kind_of(effective(case.scene))
    if kind == "orbit":
        return extremes_and_periods(case.scene, states, box=box, period=times, by_numba=len(states) >= COMPILED)
    return _extremes(case, states, KINDS[kind].follows) if box else None, period(case.scene, states) if times else None


def _extremes(case: Case, states: np.ndarray, follows: bool) -> np.ndarray:
    try:
        return extremes(case.scene, states, case.span)
    except InputError:
        if follows:  # no state of this scene has bounds
            return np.full((*states.shape, 2), np.nan)
        raise


def _times(found, out: np.ndarray) -> None:
    out["when_low"], out["when_high"] = found.low, found.high
    out["when_level"] = [LIMIT_LEVELS.index(word) if word in LIMIT_LEVELS else 0 for word in np.ravel(found.level)]


def _single(plan: Plan, case: Case, states: np.ndarray, out: np.ndarray) -> None:
    """States that are answered one by one: liquid, medium, field."""
    for n, state in enumerate(states.tolist()):
        here = replace(case, state=tuple(state)) if tuple(state) != case.state else case
        brief = not {"distance", "period"} & set(plan.answers)
        found = motion(here.scene, here.start, here.span, brief, here.exact_state, plan.longest)
        pairs = found.extremes or ((np.nan, np.nan),) * 3
        known = lambda value: np.nan if value is None else value
        columns = {"fate": found.fate, "spin_axis": found.axis * found.sense, "level": LEVELS.index(found.level), "reason": -1,
                   "margin": known(found.margin_energy), "distance": known(found.margin_velocity), "least": [low for low, _ in pairs],
                   "greatest": [high for _, high in pairs],
                   "period": PERIODS.get(found.fate, np.nan) if found.period is None else found.period}
        for name, value in columns.items():
            if name in out.dtype.names:
                out[name][n] = value
        if "when" in plan.answers:
            limit = plan.limit_of(here)
            _times(time_to(here.scene, start_of(here.scene, here.state, here.blocks), **limit.ask, t_max=limit.until), out[n:n + 1])


def _equilibria(case: Case, out: np.ndarray) -> None:
    if "stable" not in out.dtype.names and (number := number_of_equilibria(case.scene)) is not None:
        out["equilibria"] = number
        return
    found = equilibria(case.scene)
    verdicts = [point.verdict for point in found.points] + [piece.verdict for curve in found.curves for piece in curve.segments]
    number = {"none": 0, "points": len(found.points), "undecided": OPEN}.get(found.kind, ENDLESS)
    counts = {"equilibria": number, "stable": verdicts.count("stable"), "unstable": verdicts.count("unstable")}
    for name, value in (counts | {"open": len(verdicts) - counts["stable"] - counts["unstable"]}).items():
        if name in out.dtype.names:
            out[name] = value
