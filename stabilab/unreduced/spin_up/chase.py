"""Motions followed until a certificate of spin-up holds: the one loop that serves one state and many.

Beside each motion its twin tells by how much the way magnifies a small change across it (`way.twins`), and with it how far the run's rounding may
have carried the motion from the true one: a certificate counts when it holds for the whole ball of that radius about the state. What rounding
does along the motion is a delay: it alters the time at which the inequality holds, told as the blur of the clock, and nothing else.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .compiled.runs import CompiledRuns
from .fields import Tests
from .way.drift import Leaps
from .way.runs import Runs

FIRST, EARLY, SHARES, MOST = 4, 600, (0.25, 0.1), 2000  # steps between tests: a share of those before (early, later), at least and at most so many
# Which tests a stage asks: (every so many stages, from so many steps on, name in `Tests`), the last that applies. What costs more comes later.
LAST = 20_000
PLAN = ((1, 0, "often"), (3, 48, "high"), (4, 3000, "all"), (8, LAST, "last"))


@dataclass
class Chased:
    """Columns (n,): which test fired (-1 none) as index into `tests.asked`, time, steps, condition, state there; constants (6, n) of it; largest and
    least (n, 48) size of the state at the stages of each doubling of the steps; passed: steps that the way takes one by one; blur: of the time;
    reach: how far from the state the rounding may have carried the true one."""

    tests: Tests
    fired: np.ndarray
    t: np.ndarray
    steps: np.ndarray
    condition: np.ndarray
    states: np.ndarray
    constants: np.ndarray
    largest: np.ndarray
    least: np.ndarray
    passed: np.ndarray
    blur: np.ndarray
    reach: np.ndarray


def chase(scene, tests: Tests, starts, t_max: float, budget: int, after: float = 0.0, tell=None, fast: bool = False) -> Chased:
    """Follow the motions from starts (n, 3) of a scene in natural units, each until a test fires at a time no earlier than `after`,
    t_max, or `budget` steps. tell(least time, steps, motions left): called after every stage. fast: compiled tests."""
    n = len(starts)
    runs = (CompiledRuns if fast else Runs)(scene, starts)
    out = Chased(tests, np.full(n, -1), runs.times, runs.steps, np.ones(n), runs.states, np.full((6, n), np.nan), np.zeros((n, 48)), np.full((n, 48), np.inf),
                 runs.rounded, runs.twins.blur, np.zeros(n))
    open_, stage, leaps, leapt = np.arange(n), 0, Leaps(runs), np.arange(0)
    while open_.size:
        runs.measure(open_, out)
        ready = open_ if after <= 0 else open_[out.t[open_] >= after]
        which = [name for every, since, name in PLAN if stage % every == 0 and runs.steps_done >= since][-1]
        far = np.intersect1d(ready, leapt) if leapt.size else leapt  # rows that have just leapt: a test costs less than what they passed
        for rows, asked in ((np.setdiff1d(ready, far) if far.size else ready, which), (far, "last")):
            if rows.size:
                _ask(out, rows, getattr(tests, asked), fast)
        open_ = open_[out.fired[open_] < 0]
        ended = runs.over(open_, t_max, budget)
        if ended.any():  # the last word is that of all tests that so much work is worth
            _ask(out, open_[ended & (out.t[open_] >= after)], tests.last if runs.steps_done >= LAST else tests.all, fast)
        open_ = open_[~ended]
        if open_.size:
            leapt = leaps.advance(open_, t_max, after)
            rows = np.setdiff1d(open_, leapt) if leapt.size else open_
            if rows.size:
                share = SHARES[runs.steps_done >= EARLY]
                runs.advance(rows, int(min(max(FIRST, runs.steps_done * share), MOST, max(1, budget - runs.steps[rows].min()))), t_max, after)
            if tell:
                tell(float(out.t[open_].min()), runs.steps_done, open_.size)
        stage += 1
    return out


def _ask(out, rows, which, fast):
    """Ask tests for rows, one after another for those that none has fired for; what fires is written down."""
    ahead = {}
    for field, orders in which:
        if not rows.size:
            break
        test = out.tests.certifier(field, orders, fast)
        number = out.tests.asked.index((field, orders))
        if fast:
            test.decide(rows, out.states, out.reach, out.fired, number, out.constants)
            rows = rows[out.fired[rows] < 0]
            continue
        if id(field) not in ahead:  # rows that spin in the sense of the form
            with np.errstate(all="ignore"):
                ahead[id(field)] = rows[field.place(out.states[rows])[0] > 0]
        candidates = ahead[id(field)][out.fired[ahead[id(field)]] < 0]
        if candidates.size:
            found = test(out.states[candidates], out.reach[candidates])
            done = candidates[found.good]
            out.fired[done] = number
            out.constants[:, done] = np.array([found.A, found.z, found.eta, found.z_up, found.eta_up, found.k])[:, found.good]
            rows = rows[out.fired[rows] < 0]
