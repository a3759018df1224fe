"""The periodic motion of a fast top as a model of a case: expanded to any order, and the printed first order.
"""
from __future__ import annotations

from ...answers.simulate import Simulation
from .lindstedt import LindstedtMotion, lindstedt
from .printed import PrintedMotion, printed

MODELS = ("lindstedt", "printed")
ORDER = 4
COVERED = {"gravity", "newtonian_field", "gyrostat"}


def applies(scene) -> bool:
    """Whether the expansion covers the scene: gravity or a Newtonian field, a gyrostat perhaps, nothing else.
    """
    names = {e.name for e in scene.effects}
    return (names <= COVERED and bool(names & {"gravity", "newtonian_field"})
            and "attitude" not in scene.blocks)


def state_of(case) -> dict:
    """The start as the expansion takes it."""
    return {"omega": case.state, "gamma": case.blocks.get("gamma", (0.0, 0.0, 1.0))}


def follow(model, case, times, order=None) -> Simulation:
    """The case's motion by the expansion (order 4 unless asked for otherwise), or as printed."""
    state = state_of(case)
    run: PrintedMotion | LindstedtMotion
    if model == "printed":
        run = printed(case.scene, state, times)
        how, reason = "Amer et al. 2023, first order", run.reason
    else:
        found = run = lindstedt(case.scene, state, times, ORDER if order is None else order)
        how, reason = f"expansion of order {found.order}", f"{found.status}: {found.reason}"
    reached = "reached" if len(run.t) == len(times) else "stopped"
    return Simulation(run.t, {"omega": run.omega, "gamma": run.gamma}, model, how, None, status=reached,
                      reason=reason)
