"""One state, checked and split into plain floats; no NumPy."""
from __future__ import annotations

import math
from typing import Any

from ..asked import real
from ..errors import InputError
from ..numbers.vectors import Float3
from .coefficients import Content


def split(parts: Content, state: Any) -> tuple[Float3, Float3 | None]:
    """(omega, gamma or None) as plain floats."""
    if isinstance(state, dict):
        rows = [state.get("omega", ()), state.get("gamma", ())]
    else:
        row = _row(state)
        rows = [row[:3], row[3:]]
    omega, gamma = (_row(row) if len(row) else () for row in rows)
    if len(omega) != 3 or len(gamma) not in (0, 3):
        raise InputError("state: expected three numbers (omega), or six (omega, gamma), or a dict of blocks")
    if not parts.directed:
        return omega, None
    if not gamma:
        raise InputError("state: an effect of this scene asks where the vertical is: give gamma too (six numbers, or a dict of blocks)")
    return omega, gamma


def _row(values: Any) -> tuple[float, ...]:
    """Finite floats in one row; InputError otherwise."""
    if isinstance(values, (tuple, list)) and values and all(type(v) is float and math.isfinite(v) for v in values):
        return tuple(values)
    from .states import numbers_in_a_row  # other kinds of numbers, and the words for what is none
    return tuple(map(float, numbers_in_a_row(values, "state")))


def three_floats(state: Any) -> Float3:
    """Three finite floats; InputError otherwise."""
    try:
        values = tuple(map(float, real(state, "states")))
        if len(values) == 3 and all(map(math.isfinite, values)):
            return values
    except (TypeError, ValueError, OverflowError):
        pass
    from .states import checked_states  # other shapes that hold one state, and the words for what is none
    array = checked_states(state)
    if array.size != 3:
        raise InputError(f"state: expected one state, three numbers, got the shape {array.shape}")
    return tuple(array.reshape(3).tolist())
