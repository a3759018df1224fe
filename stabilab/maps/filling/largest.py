"""The largest rate |omega| of a sweep's motions."""
from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...answers.motion import Needs, motion
from ...case.read import Case
from ...orbit.result import Fate, Motion
from ..plan import Plan


class Largest(NamedTuple):
    """rate: (n,) |omega| at the most over all time, inf where it grows without end, NaN where it is not
    known; size: |omega| at the start."""

    rate: np.ndarray
    size: np.ndarray


def of_many(plan: Plan, case: Case, states: np.ndarray) -> Largest:
    """Of the states (n, 3) of a scene, one after the other."""
    pairs = [_of_motion(motion(case.scene, tuple(state), case.span, Needs.RETURN | Needs.LARGEST,
                               follow=plan.longest)) for state in states.tolist()]
    return Largest(np.array([rate for rate, _ in pairs]), np.array([size for _, size in pairs]))


def of_one(plan: Plan, case: Case) -> Largest:
    """Of the start of a case."""
    rate, size = _of_motion(motion(case.scene, case.start, case.span, Needs.RETURN | Needs.LARGEST,
                                   case.exact_state, plan.longest))
    return Largest(np.array(rate), np.array(size))


def _of_motion(result: Motion) -> tuple[float, float]:
    size = math.hypot(*result.at[:3])
    if result.fate == Fate.SPIN_UP:
        return math.inf, size
    return (math.nan if result.largest is None else result.largest), size
