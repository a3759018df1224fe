"""Regular or chaotic motion, by how a small change of its start grows: the mean exponential growth of nearby
orbits (MEGNO; Cincotta, Giordano, Simo 2003).

The change v obeys the variational equations v' = J(x) v, whose J is the symbolic derivative of the very
equations of motion. With L(t) = ln |v(t)|,

    Y(t) = 2 [L(t) - (1/t) integral of L over (0, t)],     MEGNO(T) = (1/T) integral of Y over (0, T).

Neighbours on tori part in proportion to time: MEGNO -> 2. Neighbours that keep their distance: -> 0; that
come together: to ever lower numbers. Where they part exponentially, at the rate s, it grows as s T / 2. A
number of a finite time: what stays regular for so long may be chaotic in the end.
"""
from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from ..integrate.to_heyoka import TAYLOR_TOLERANCE, borrowed_taylor, heyoka_available
from ..integrate.trajectory import STEP_LIMIT, stand_in
from ..physics.equations import Equations
from ..physics.own_unit import in_unit, own_unit
from ..physics.to_numpy import equations_of, form, to_numpy

if TYPE_CHECKING:
    from ..physics.scene import AnyScene, ScaledGyrostat

LANES = 8
STAGES = 6         # doublings of the time: 1/32 of it is the first
# of ln |v| in a turn; more than twice the faster swing of |v|, so that its mean is that of the motion
SAMPLES = 12
TURNS = 1000       # that a motion is followed unless a time is given
# steps between two samples from which on a motion is too stiff to be followed (one or two are ordinary); of
# SciPy's, each of which takes fifty times as long
CRAWL, SLOW_CRAWL = 300, 20


@dataclass(frozen=True)
class Growth:
    """times: (stages,) in the scene's time; megno: (n, stages), nan from where on a motion could not be
    followed; stiff: (n,), whether it was given up since its steps were too short."""

    times: np.ndarray
    megno: np.ndarray
    stiff: np.ndarray


def turn_of(scene: AnyScene, states: np.ndarray) -> float:
    """The time (scene's time) of a turn of a motion of middling pace among states (n, N): 2 pi over rate, or
    over the root of what changes it."""
    with np.errstate(all="ignore"):
        rates = np.abs(to_numpy(scene)(states)[:, :3]).max(axis=1)
    pace = np.maximum(np.abs(states[:, :3]).max(axis=1), np.sqrt(np.where(np.isfinite(rates), rates, 0.0)))
    result = float(np.median(pace))
    return 2 * math.pi / result if result > 0 else 1.0


def growth(scene: AnyScene, states: np.ndarray, until: float, turn: float,
           tell: Callable[[int], Any] | None = None) -> Growth:
    """MEGNO of motions from states (n, N) at `until` and at its halves; turn: `turn_of` them. tell(motions
    done)."""
    with np.errstate(all="ignore"):
        rates = np.abs(to_numpy(scene)(states)[:, :3])
    unit = own_unit(scene, np.abs(states[:, :3]).max(axis=0).tolist(),
                    np.where(np.isfinite(rates), rates, 0.0).max(axis=0).tolist())
    if unit != 1:
        result = growth(in_unit(scene, unit), states / unit, until * unit, turn * unit, tell)
        return replace(result, times=result.times / unit)
    times = until / 2.0 ** np.arange(STAGES - 1, -1, -1)
    first = max(SAMPLES, math.ceil(SAMPLES * times[0] / turn))
    out, stiff = np.full((len(states), STAGES), np.nan), np.zeros(len(states), bool)
    width = LANES if heyoka_available() else 1
    for low in range(0, len(states), width):
        rows = np.arange(low, min(low + width, len(states)))
        megno, slow = _together(scene, states[np.resize(rows, width)], times, first)
        out[rows], stiff[rows] = megno[:len(rows)], slow[:len(rows)]
        if tell is not None:
            tell(int(rows[-1]) + 1)
    return Growth(times, out, stiff)


def _together(scene: Any, states: np.ndarray, times: np.ndarray,
              first: int) -> tuple[np.ndarray, np.ndarray]:
    """`megno` and `stiff` of a few motions, on a grid of `first` samples up to times[0], as dense as that
    later."""
    step, megno = times[0] / first, np.full((len(states), len(times)), np.nan)
    x = np.concatenate([states, np.tile(_change(states.shape[1]), (len(states), 1))], axis=1)
    follow = _by_taylor if heyoka_available() else _by_scipy
    size, piece = states.shape[1], step * np.arange(first + 1)
    logs, grown, stiff = [np.zeros((1, len(states)))], np.zeros(len(states)), np.zeros(len(states), bool)
    for stage in range(len(times)):
        for _ in range(max(1, 1 << stage - 1) if stage else 1):  # so often the first time, to double it
            points, slow = follow(scene, x, piece)  # (samples, n, 2 N)
            stiff |= slow
            lengths = _lengths(points[:, :, size:])
            with np.errstate(all="ignore"):
                logs.append(grown + np.log(lengths[1:]))
            grown, x = logs[-1][-1], points[-1]
            x[:, size:] /= lengths[-1][:, None]
        megno[:, stage] = _megno(np.concatenate(logs), step)
        if not np.isfinite(x).all(axis=1).any():
            break
    return megno, stiff


def _lengths(change: np.ndarray) -> np.ndarray:
    """(...): of vectors (..., N), their largest parts taken out first; 1 of none."""
    largest = np.abs(change).max(axis=-1)
    with np.errstate(all="ignore"):
        result = largest * np.sqrt(((change / largest[..., None]) ** 2).sum(axis=-1))
    return np.where(largest == 0, 1.0, result)


def _megno(logs: np.ndarray, step: float) -> np.ndarray:
    """MEGNO at the end of ln |v| (samples, n), 0 at the first; by the rule of trapezes, which of what swings
    many times leaves nothing."""
    with np.errstate(all="ignore"):
        t = step * np.arange(len(logs))[:, None]
        area = np.concatenate([np.zeros((1, logs.shape[1])),
                               np.cumsum(0.5 * (logs[1:] + logs[:-1]), axis=0) * step])
        y = 2 * (logs - area / np.maximum(t, step))
        result = (0.5 * (y[1:] + y[:-1])).sum(axis=0) * step / t[-1, 0]
    return np.where(np.isfinite(result), result, np.nan)


def _change(size: int) -> np.ndarray:
    """A first change of length 1, along no axis and no plane of the body: it has a part across the motion and
    its tori."""
    raw = np.array([math.sqrt(n + 2) - 1 for n in range(size)]) * (-1.0) ** np.arange(size)
    return raw / np.linalg.norm(raw)


@lru_cache(maxsize=32)
def varied(equations: Equations) -> Equations:
    """The equations with those of a small change beside them: twice the state, its rates and J v."""
    from sympy import symbols
    n = len(equations.state)
    change = symbols(f"change1:{n + 1}", real=True)
    linear = tuple(sum((equations.jacobian[i, j] * change[j] for j in range(n)), 0 * change[0])
                   for i in range(n))
    return replace(equations, state=(*equations.state, *change), rhs=(*equations.rhs, *linear))


def _by_taylor(scene: AnyScene, x: np.ndarray, grid: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The states and changes at the times of `grid`, and which motions took too many steps."""
    equations = varied(equations_of(scene))
    forms = form(equations, equations.rhs)
    fast = _too_fast(scene, x, grid)
    x = np.where(fast[:, None], np.nan, x)
    with borrowed_taylor(forms, TAYLOR_TOLERANCE, LANES) as ta, np.errstate(all="ignore"):
        ta.set_time(0.0)
        ta.state[:] = np.where(np.isfinite(x), x, 0.0).T
        points = ta.propagate_grid(np.tile(grid[:, None], LANES),
                                   max_steps=min(STEP_LIMIT, CRAWL * grid.size))[1].transpose(0, 2, 1).copy()
        points[:, ~np.isfinite(x).all(axis=1)] = np.nan
        slow = np.array([outcome.name == "step_limit" for outcome, *_ in ta.propagate_res])
    return points, slow | fast


def _too_fast(scene: AnyScene, x: np.ndarray, grid: np.ndarray) -> np.ndarray:
    """Which motions change so fast beside the time between two samples that a power series would crawl, or
    overflow."""
    size = x.shape[1] // 2
    alive = np.isfinite(x).all(axis=1)
    pace = np.array([np.abs(to_numpy(scene).jacobian(row[:size])).max() if item else 0.0
                     for row, item in zip(x, alive)])
    return alive & (pace * grid[1] > 10 * CRAWL)


def _by_scipy(scene: ScaledGyrostat, x: np.ndarray, grid: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    system, size = to_numpy(scene), x.shape[1] // 2
    rate = lambda y: np.concatenate([system(y[:size]), system.jacobian(y[:size]) @ y[size:]])
    out, slow = np.full((len(grid), *x.shape), np.nan), np.zeros(len(x), bool)
    for n, start in enumerate(x):
        if np.isfinite(start).all():
            result, slow[n] = _stepped(rate, start, grid)
            out[:len(result), n] = result
    return out, slow


def _stepped(rate: Callable[[np.ndarray], np.ndarray], start: np.ndarray,
             grid: np.ndarray) -> tuple[list[np.ndarray], bool]:
    """The states at the times of `grid` that SciPy reaches, and whether it took too many steps."""
    solver, result, steps = stand_in(lambda y: rate(np.array(y)), start, grid[-1]), [start], 0
    while solver.status == "running":
        if steps >= SLOW_CRAWL * grid.size:
            return result, True
        solver.step()
        steps += 1
        if solver.status == "failed" or not np.isfinite(solver.y).all():
            break
        inside = grid[len(result):][grid[len(result):] <= solver.t]
        result += list(solver.dense_output()(inside).T) if inside.size else []
    return result, False
