"""What is seen of a sweep's motions, regular or chaotic."""
from __future__ import annotations

import numpy as np

from ...answers.chaos import Chaos, chaos, long_enough, row_of
from ...case.read import Case
from ..plan import Plan

of_one = None  # arrays serve every scene


def of_many(plan: Plan, case: Case, states: np.ndarray) -> Chaos:
    """All followed as long as the case's own motion is, whatever their company."""
    end = long_enough(plan.case.scene, row_of(plan.case.scene, plan.case.state, plan.case.blocks))
    starts = np.array([row_of(case.scene, state, case.blocks) for state in states.tolist()])
    return chaos(case.scene, starts, end if plan.longest is None else plan.longest)
