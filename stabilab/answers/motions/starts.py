"""The starts that a question is asked for: one, which goes into its case as it was written, or many, an
array of doubles."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ...case.given import (
    Given,
    Span,
    Start,
    Starts,
    as_case,
    in_numbers,
    is_one,
    started,
    turning,
    with_start,
)
from ...case.read import Case
from ...errors import InputError
from ...numbers.units import NONE, RATE
from ...physics.coefficients import effective
from ...physics.states import checked_states, float_array, row_of


def asked_of(supplied: Given, state: Start | None, states: Starts | None, span: Span | None, question: str,
             frame: str = "principal") -> tuple[Case, np.ndarray]:
    """(case, starts): of one start a row (N,) and the case that starts there; of many (..., N) and the case
    as it was given. Raises InputError where no start is given and the case has none."""
    if state is not None and states is not None:
        raise InputError(f"{question}: state is one start and states are many: give one of them")
    name: str = "state" if states is None else "states"
    wanted: Any = state if states is None else states
    if wanted is None or is_one(wanted):
        case = with_start(as_case(supplied, wanted, span, frame), question)
        return case, np.array(case.start, float)
    case = as_case(supplied, None, span)
    if isinstance(wanted, (list, tuple)) and all(isinstance(item, Mapping) for item in wanted) and wanted:
        return case, np.array([whole(started(case, item, frame)) for item in wanted])
    numbers = in_numbers(wanted, NONE if case.variables == "scaled" else RATE, name)
    if effective(case.scene).plain:
        array, axes = checked_states(numbers), turning(case, frame)
        return case, array if axes is None else array @ np.array(axes.axes, float).T
    return case, _rows(case, numbers, frame)


def whole(case: Case) -> np.ndarray:
    """The start of a case as a row of all that its scene needs."""
    return np.array(with_start(case, "fate").start, float)


def whole_rows(case: Case, array: np.ndarray) -> np.ndarray:
    """The starts (..., N) of `asked_of` with all blocks of the state in order, as a run takes them."""
    if case.scene.blocks == ("omega",):
        return array
    built = [started(case, row) for row in array.reshape(-1, array.shape[-1])]
    return np.array([row_of(item.scene, item.state or (), item.blocks) for item in built]).reshape(
        *array.shape[:-1], -1)


def _rows(case: Case, numbers: Any, frame: str) -> np.ndarray:
    """Rows of whole states, or of rates beside the other blocks of the case."""
    array = float_array(numbers, "states", "numbers in rows")
    if array.ndim < 2:
        raise InputError(f"states: expected rows of numbers, got the shape {array.shape}")
    built = [whole(started(case, row, frame)) for row in array.reshape(-1, array.shape[-1])]
    return np.array(built).reshape(*array.shape[:-1], -1)
