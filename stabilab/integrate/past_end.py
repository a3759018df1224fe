"""A run past the time at which an effect stops acting: the scene without it goes on from the state there; and
the roots of the rates along it."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from ..physics.coefficients import limits_of
from ..physics.ending import stopped, time_left
from ..physics.scene import slices
from ..physics.states import checked_times, equations_and_start


def through_the_end(scene: Any, state: Any, times: Any, follow: Callable[..., Any],
                    steps: list[float] | None) -> Any:
    """The run at times of which some are later than the end of an effect; None where there is no such effect
    or time. follow(scene, state, times, steps): a run in which all effects act."""
    equations, row = equations_and_start(scene, state)
    parts, times = slices(equations.blocks), checked_times(times)
    start = {name: row[part] for name, part in parts.items()}
    left = time_left(scene, start)
    if left is None or not times.max() > left:
        return None
    rising = np.sort(times)
    early, late = rising[rising <= left], rising[rising > left]
    before = follow(scene, start, np.unique([0.0, *early, left]), steps)
    if before.status != "reached":
        return _at(before, early, times)
    there = {name: before.block(name)[-1] for name in equations.blocks}
    passed: list[float] | None = None if steps is None else []
    without, kept = stopped(scene, there)
    after = follow(without, kept, [0.0, *(late - left)], passed)
    if steps is not None:
        steps += [left + t for t in passed or ()]
    limits = limits_of(scene)
    states, drifts = np.tile(before.states[-1], (len(after.t) - 1, 1)), (before, after)
    for name in kept:
        states[:, parts[name]] = after.block(name)[1:]
    names = before.invariant_drift | after.invariant_drift
    whole = replace(
        after, t=np.concatenate([before.t, late[:len(states)]]),
        states=np.concatenate([before.states, states]),
        invariant_drift={name: max(run.invariant_drift.get(name, 0.0) for run in drifts) for name in names},
        counters={name: before.counters.get(name, 0) + n for name, n in after.counters.items()},
        blocks=before.blocks, validity=limits and limits.larger(before.validity, after.validity))
    return _at(whole, rising, times)


def _at(run: Any, rising: Any, times: Any) -> Any:
    """The run at these of its times alone, in the order of the times that were asked for."""
    keep = np.isin(run.t, rising)
    way = 1 if times.size < 2 or times[1] > times[0] else -1
    return replace(run, t=run.t[keep][::way], states=np.ascontiguousarray(run.states[keep][::way]))


def roots_through_the_end(scene: Any, equations: Any, row: Any, t_end: float,
                          search: Callable[..., Any]) -> Any:
    """The roots of the rates up to `t_end`, later than the end of an effect, where all rates count as roots:
    they jump there. None where there is no such effect or time. search(scene, state, t_end): while all act.
    """
    parts = slices(equations.blocks)
    left = time_left(scene, {name: row[part] for name, part in parts.items()})
    if left is None or not t_end > left:
        return None
    first = search(scene, row, left)
    if first.reason:
        return first
    without, kept = stopped(scene, {name: first.end[part] for name, part in parts.items()})
    later = search(without, kept, t_end - left)
    places = np.concatenate([np.arange(row.size)[parts[name]] for name in kept])

    def whole(states: Any) -> Any:
        out = np.tile(first.end, (len(states), 1))
        out[:, places] = states
        return out
    return replace(
        later, t=np.concatenate([first.t, np.full(row.size, left), left + later.t]),
        component=np.concatenate([first.component, np.arange(row.size), places[later.component]]),
        states=np.concatenate([first.states, whole(first.end[None, places].repeat(row.size, 0)),
                               whole(later.states)]),
        start=first.start, end=whole(later.end[None])[0], t_reached=left + later.t_reached,
        steps=first.steps + later.steps)
