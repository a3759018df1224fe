"""Where the fate changes along the lines of a map: on the separatrix itself where states alone vary, else where the margin is zero."""
from __future__ import annotations

import numpy as np

from ..answers.fate import fate
from ..orbit.result import Fate
from ..physics.coefficients import effective
from .plan import Plan
from .points import case_of, states_between

HALVINGS = 40  # of a line between two points of a map


def known_exactly(plan: Plan, first: int, second: int) -> bool:
    """Whether states alone vary along the two dimensions, in a scene whose fates come in arrays."""
    return {first, second} <= set(plan.inner) and effective(plan.case.scene).plain and all(n < len(plan.axes) for n in plan.inner)


def changes(plan: Plan, index: tuple[int, ...], dimension: int, lower: np.ndarray, spun: np.ndarray, halvings: int = HALVINGS) -> np.ndarray:
    """(lines,): at what share of the way from a point to the next along `dimension` the fate changes.

    index: the place along every dimension of the points, in rows (lines, dimensions) by `lower`; spun: whether the lower point spins up. By halving
    the line, each half asked for its fate: to the last digits of a picture and beyond.
    """
    case = case_of(plan, _scene(plan, index))
    low, high = np.zeros(len(lower)), np.ones(len(lower))
    for _ in range(halvings):
        middle = 0.5 * (low + high)
        same = (fate(case.scene, states_between(plan, case, lower, dimension, middle)).labels == Fate.SPIN_UP) == spun
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return 0.5 * (low + high)


def _scene(plan: Plan, index: tuple[int, ...]) -> int:
    shape = [plan.shape[n] for n in plan.outer]
    return int(np.ravel_multi_index([index[n] for n in plan.outer], shape)) if shape else 0
