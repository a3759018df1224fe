"""The models a case can be followed with: the exact motion, and the analytic solutions that apply to its
scene."""
from __future__ import annotations

import difflib
from dataclasses import replace
from importlib import import_module
from typing import TYPE_CHECKING

from ..answers.simulate import Simulation, simulated
from ..errors import InputError
from ..physics.coefficients import limits_of
from ..physics.states import vertical

if TYPE_CHECKING:
    import numpy as np

    from ..case.read import Case
    from ..physics.scene import AnyScene

# model -> the modules that may have it, each with `applies(scene)` and `follow(model, case, times, order)`
FAMILIES = ("charged", "cavity", "top")
MODELS = ("exact", "linear", "corrected", "printed", "averaged1", "averaged2", "lindstedt")


def family(scene: AnyScene):
    """The module of analytic solutions that applies to a scene, or None."""
    if scene.variables == "scaled":
        return None
    for name in FAMILIES:
        module = import_module(f".{name}", __package__)
        if module.applies(scene):
            return module
    return None


def models_of(scene: AnyScene) -> tuple[str, ...]:
    """The models that apply to a scene, the exact one first."""
    result = family(scene)
    return ("exact",) if result is None else ("exact", *result.MODELS)


def follow(case: Case, times: np.ndarray, model: str = "exact", method: str | None = None,
           rtol: float | None = None, order: int | None = None) -> Simulation:
    """The motion of a case by one model at the given times.

    order: of the expansion, for "lindstedt" only. Raises InputError for a model that does not apply to the
    scene, with those that do, and as `simulate` does.
    """
    if model not in MODELS:
        close = difflib.get_close_matches(str(model), MODELS, 1)
        hint = f'; did you mean "{close[0]}"?' if close else ""
        raise InputError(f"model: there is no {model!r}; choose one of {', '.join(MODELS)}{hint}")
    if order is not None and model != "lindstedt":
        raise InputError(f"order: belongs to the model \"lindstedt\", not to {model!r}")
    if model == "exact":
        return simulated(case.scene, case.state, times, case.blocks, method, rtol)
    if model not in models_of(case.scene):
        raise InputError(
            f"model: {model!r} does not apply to this scene; it has {', '.join(models_of(case.scene))}")
    if method is not None or rtol is not None:
        raise InputError(
            f"method, rtol: the model {model!r} is a formula; they belong to the model \"exact\"")
    run = family(case.scene).follow(model, case, times, order)
    limits = limits_of(case.scene)
    if limits is None or "omega" not in run.state or not len(run.t):
        return run
    resolved = {"gamma": vertical(run.state["angles"])} if "angles" in run.state else {}
    return replace(run, validity=limits.along(case.scene, resolved | run.state, "at the times given"))
