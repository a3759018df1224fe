"""The averaged models of a body with a liquid or a resistance, as models of a case."""
from __future__ import annotations

import numpy as np

from ...answers.simulate import Simulation
from ...errors import InputError
from .averaged import AveragedMotion, averaged
from .normal_form import check
from .printed import PrintedMotion, printed

MODELS = ("averaged1", "averaged2", "printed")


def applies(scene) -> bool:
    """Whether averaging covers the scene."""
    if not {e.name for e in scene.effects} & {"liquid_cavity", "resistance"}:
        return False
    try:
        check(scene)
    except InputError:
        return False
    return True


def follow(model, case, times, order=None) -> Simulation:
    """The case's motion by an averaged model, or by the paper's polynomials."""
    run: PrintedMotion | AveragedMotion
    error = {}
    if model == "printed":
        run = printed(case.scene, case.state, times)
        how, reason = "Galal et al. (24)-(26)", run.reason
    else:
        found = run = averaged(case.scene, case.state, times, order=int(model[-1]))
        error = {"omega": np.array(found.floor), "amplitude": np.array(found.floor[0]),
                 "spin": np.array(found.floor[2])}
        how, reason = (f"averaged equations of order {found.order}, eps = {found.eps:.6g}",
                       f"{found.reason}; {found.horizon}")
    state = {"omega": run.omega, "amplitude": run.amplitude, "spin": run.spin, "phase": run.phase}
    return Simulation(np.asarray(run.t), state, model, how, None, status=run.status, reason=reason,
                      error=error)
