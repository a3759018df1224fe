"""The cases and states of a sweep's points: a case for every scene, rows of rates for the states of one."""
from __future__ import annotations

import copy
from typing import Any

import numpy as np

from ..case.lines import KeyLines
from ..case.read import Case, with_data
from ..case.table import Faults, Table, Written
from .keys import put
from .plan import Plan

Puts = list[tuple[tuple[Any, ...], Any]]  # (path, what stands there in a case file)


def case_of(plan: Plan, scene: int) -> Case:
    """The case of a scene, with the first of its states. Raises CaseError where its numbers make none."""
    if plan.pointed is not None:
        return plan.pointed.case(plan.case, scene)
    data = copy.deepcopy(plan.data)
    places = np.unravel_index(scene, [plan.shape[n] for n in plan.outer]) if plan.outer else ()
    for dimension, at in zip(plan.outer, places):
        _put_all(data, puts(plan, dimension, int(at)))
    return with_data(plan.path, plan.text, data)


def case_at(plan: Plan, index: tuple[int, ...]) -> Case:
    """The case of one point, told by its place along every dimension."""
    data = copy.deepcopy(plan.data)
    for dimension, at in enumerate(index):
        _put_all(data, puts(plan, dimension, at))
    return with_data(plan.path, plan.text, data)


def puts(plan: Plan, dimension: int, at: int) -> Puts:
    """What a place along a dimension puts into the case."""
    if dimension < len(plan.axes):
        axis = plan.axes[dimension]
        text = axis.written(at)
        return [(path, text if axis.unit else Written(text)) for path in axis.key.paths]
    row = plan.sampled.values(at, at + 1)[0].tolist()
    return [(path, Written(repr(value))) for key, value in zip(plan.sampled.keys, row) for path in key.paths]


def _put_all(data, rows: Puts) -> None:
    for path, value in rows:
        put(data, path, value)


def states_of(plan: Plan, case: Case, low: int, high: int) -> np.ndarray:
    """(high - low, 3): states of a scene in its own variables, along its principal axes."""
    return _turned(case, _as_written(plan, low, high)) if plan.inner else np.array([case.state], float)


def states_between(plan: Plan, case: Case, index: np.ndarray, dimension: int, share: np.ndarray) -> np.ndarray:
    """(n, 3): the same of places between points: rows of `index` (n, dimensions), each moved by a share of the way to the next along a dimension."""
    states = np.tile(_base(plan), (len(index), 1))
    for n in plan.inner:
        axis, at = plan.axes[n], index[:, n]
        values = np.array(axis.si)
        here = values[at]
        states[:, axis.key.paths[0][2]] = here + (values[np.minimum(at + 1, len(values) - 1)] - here) * share if n == dimension else here
    return _turned(case, states)


def _turned(case: Case, written: np.ndarray) -> np.ndarray:
    frame = case.frame
    if frame is None or frame.as_given:
        return written
    rows = [[float(part) for part in axis] for axis in frame.axes]  # sums in one order, whatever library would multiply matrices
    return np.stack([(row[0] * written[:, 0] + row[1] * written[:, 1]) + row[2] * written[:, 2] for row in rows], axis=1)


def _as_written(plan: Plan, low: int, high: int) -> np.ndarray:
    """The same in the frame of the file."""
    states = np.tile(_base(plan), (high - low, 1))
    asked = plan.places(low, high)
    places = np.unravel_index(np.arange(low, high) if isinstance(asked, range) else np.array(asked), [plan.shape[n] for n in plan.inner])
    for dimension, at in zip(plan.inner, places):
        if dimension < len(plan.axes):
            axis = plan.axes[dimension]
            states[:, axis.key.paths[0][2]] = np.array(axis.si)[at]
        else:
            begin = int(at.min())
            rows = plan.sampled.values(begin, int(at.max()) + 1)[at - begin]
            for n, sampled in enumerate(plan.sampled.keys):
                states[:, sampled.paths[0][2]] = rows[:, n]
    return states


def _base(plan: Plan) -> list[float]:
    """The rates as the file gives them."""
    first = plan.inner[0]
    varied = plan.axes[first].key if first < len(plan.axes) else plan.sampled.keys[0]
    return [float(value) for value in Table(("motion",), plan.data["motion"], Faults(KeyLines())).vector(varied.paths[0][1])]
