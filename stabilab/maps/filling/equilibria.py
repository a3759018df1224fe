"""The equilibria of a sweep's scenes, counted, by their verdicts."""
from __future__ import annotations

import numpy as np

from ...answers.equilibria import equilibria
from ...case.read import Case
from ...equilibrium.gyrostat import number_of_equilibria
from ..columns import ENDLESS, OPEN
from ..plan import Plan

of_one = None  # they are those of the scene


def of_many(plan: Plan, case: Case, states: np.ndarray) -> dict[str, int]:
    """The number of equilibria, and of each verdict where that is asked, by the names of the columns."""
    if "verdict" not in plan.answers and (number := number_of_equilibria(case.scene)) is not None:
        return {"equilibria": number}
    result = equilibria(case)
    verdicts = ([point.verdict for point in result.points]
                + [piece.verdict for curve in result.curves for piece in curve.segments])
    number = {"none": 0, "points": len(result.points), "undecided": OPEN}.get(result.kind, ENDLESS)
    stable, unstable = verdicts.count("stable"), verdicts.count("unstable")
    return {"equilibria": number, "stable": stable, "unstable": unstable,
            "open": len(verdicts) - stable - unstable}
