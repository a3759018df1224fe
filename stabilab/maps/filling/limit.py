"""When the states of a sweep reach a limit."""
from __future__ import annotations

from typing import Any

import numpy as np

from ...answers.time_to import time_to
from ...case.read import Case
from ...physics.states import start_of
from ..plan import Plan

# multiplications for the proof of a time in an atlas: it leaves long motions to compiled steps, which prove
# them sooner
POINTED_WORK = 100_000


def of_many(plan: Plan, case: Case, states: np.ndarray) -> Any:
    """The `TimeTo` of states (n, 3)."""
    limit = plan.limit_of(case)
    quick: dict[str, Any] = {} if plan.pointed is None or plan.pointed.certify else {"work": POINTED_WORK}
    quick |= {"work": 0} if plan.quick else {}
    return time_to(case.scene, states, **limit.ask, t_max=limit.until, **quick)


def of_one(plan: Plan, case: Case) -> Any:
    """The `TimeTo` of the start of a case."""
    limit = plan.limit_of(case)
    return time_to(case.scene, start_of(case.scene, case.state, case.blocks), **limit.ask, t_max=limit.until)
