"""Motions followed until a certificate of spin-up holds: the one loop that serves one state and many.

Beside each motion runs a twin that started a small distance away. Their distance says by how much the way magnifies a small
change (`condition`), and with it how far the run's rounding may have carried the motion from the true one: a certificate counts
when it holds for the whole ball of that radius about the state, and for the twin.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .fields import Tests
from .runs import Runs

APART = 2.0**-36  # of the twin, relative to the state or to the natural rate
LOST = 2.0**-4  # twins farther apart than this, in the same measure, tell no growth any more: nothing is certified
STAGE, MOST = 1.15, 2000  # steps between tests: a share of those before, at most so many
# Which tests a stage asks: (every so many stages, from so many steps on, name in `Tests`), the last that applies. What costs more comes later.
PLAN = ((1, 0, "often"), (3, 6, "high"), (4, 100, "all"), (16, 5000, "last"))


@dataclass
class Chased:
    """Columns (n,): which test fired (-1 none) as index into `tests.last`, time, steps, condition, state there; constants (6, n) of it."""

    tests: Tests
    fired: np.ndarray
    t: np.ndarray
    steps: np.ndarray
    condition: np.ndarray
    states: np.ndarray
    constants: np.ndarray


def chase(scene, tests: Tests, starts, t_max: float, budget: int, after: float = 0.0, tell=None) -> Chased:
    """Follow the motions from starts (n, 3) of a scene in natural units, each until a test fires at a time no earlier than `after`,
    t_max, or `budget` steps. tell(least time, steps, motions left): called after every stage."""
    n = len(starts)
    runs = _with_twins(scene, starts)
    out = Chased(tests, np.full(n, -1), np.zeros(n), np.zeros(n, int), np.ones(n), np.array(starts, float), np.full((6, n), np.nan))
    open_, stage, begun = np.arange(n), 0, _distance(runs, n, np.arange(n))
    while open_.size:
        _measure(out, runs, n, open_, begun)
        ready = out.t[open_] >= after
        which = [name for every, since, name in PLAN if stage % every == 0 and runs.steps_done >= since][-1]
        left = _tested(out, runs, n, open_[ready], getattr(tests, which))
        open_ = np.union1d(open_[~ready], left)
        ended = (out.t[open_] >= t_max) | (runs.steps_done >= budget) | ~np.isfinite(out.states[open_]).all(axis=1)
        if ended.any():  # the last word is that of all tests
            _tested(out, runs, n, open_[ended & (out.t[open_] >= after)], tests.last)
        open_ = open_[~ended]
        if open_.size:
            steps = int(min(max(3, runs.steps_done * (STAGE - 1)), MOST, budget - runs.steps_done))
            runs.advance(_paired(open_, n), steps, t_max, after)
            if tell:
                tell(float(out.t[open_].min()), runs.steps_done, open_.size)
        stage += 1
    return out


def _with_twins(scene, starts):
    starts = np.asarray(starts, float)
    size = np.maximum(np.abs(starts).max(axis=1, initial=0.0), 1.0)
    return Runs(scene, np.concatenate([starts, starts + APART * size[:, None] * np.array([1.0, -1.0, 1.0])]))


def _paired(rows, n):
    """Rows and their twins next to each other."""
    return np.stack([rows, rows + n], axis=1).ravel()


def _distance(runs, n, rows):
    """How far the twins are at the times of their motions: each takes its own steps, so the little time between goes off."""
    with np.errstate(all="ignore"):
        ahead = (runs.times[rows + n] - runs.times[rows])[:, None] * runs.rates(rows)
        return np.abs(runs.states[rows + n] - runs.states[rows] - ahead).max(axis=1)


def _measure(out, runs, n, rows, begun):
    with np.errstate(all="ignore"):
        now = _distance(runs, n, rows) / begun[rows]
    out.condition[rows] = np.fmax(out.condition[rows], now)
    out.t[rows], out.states[rows], out.steps[rows] = runs.times[rows], runs.states[rows], runs.steps_done


def _tested(out, runs, n, rows, which):
    """The rows that no test decides; the others are written down."""
    for field, orders in which:
        if not rows.size:
            break
        rows = _test(out, runs, n, rows, field, orders)
    return rows


def _test(out, runs, n, rows, field, orders):
    with np.errstate(all="ignore"):
        x = field.place(out.states[rows])[0]
    ahead = x > 0
    candidates = rows[ahead]
    if not candidates.size:
        return rows
    test = out.tests.certifier(field, orders)
    size = np.maximum(np.abs(out.states[candidates]).max(axis=1), 1.0)
    near = runs.step_error * (1 + runs.steps_done) * out.condition[candidates] * size if runs.steps_done else np.zeros(len(candidates))
    near[out.condition[candidates] * APART > LOST] = np.inf
    found = test(out.states[candidates], near)
    good = found.good.copy()
    if good.any():
        good[good] = test(runs.states[candidates[good] + n]).good
    done = candidates[good]
    out.fired[done] = out.tests.last.index((field, orders))
    out.constants[:, done] = np.array([found.A, found.z, found.eta, found.z_up, found.eta_up, found.k])[:, good]
    return np.setdiff1d(rows, done, assume_unique=True)
