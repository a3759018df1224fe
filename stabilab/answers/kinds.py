"""Which way answers a scene: a row a kind; each module answers the same questions.

One state: `motion(scene, state, span, exact, brief)` -> Motion. Many: `fates(scene, states, fast)` -> FateResult,
`extremes(scene, states, span, fast)` -> (n, 3, 2), `periods(scene, states, fast)` -> (n,), for rows (n, 3).
"""
from __future__ import annotations

from importlib import import_module

from ..orbit.reduction import reduce
from ..physics.alignment import aligned

# kind -> (module for one state, module for many)
KINDS = {
    "orbit": ("orbit.one_state", "orbit.many"),
    "aligned": ("unreduced.aligned", "unreduced.aligned"),  # a torque in the plane of two equal moments
    "free": ("unreduced.free_gyrostat", "unreduced.free_gyrostat"),  # no torque, a wheel with no zero component
    "growth": ("unreduced.growth", "unreduced.growth"),  # a wheel along the torque
    "off axis": ("unreduced.off_axis", "unreduced.off_axis"),
    "bounds": ("unreduced.bounds", "orbit.many"),  # liquid, medium, field: rows are refused there, with the effect's name
}


def kind_of(scene) -> str:
    """The kind of a scene, a key of KINDS; `physics.coefficients.effective` first, where other effects may turn as a wheel does."""
    if not scene.plain:
        return "bounds"
    if reduce(scene) is not None:
        return "orbit"
    acting = sum(m != 0 for m in scene.quadratic().m)
    if acting < 2:
        return "growth" if acting else "free"
    return "off axis" if aligned(scene) is None else "aligned"


def one(scene):
    """The module that answers for one state of this scene."""
    return _module(scene, 0)


def many(scene):
    """The module that answers for many states of this scene."""
    return _module(scene, 1)


def _module(scene, column):
    return import_module(f"..{KINDS[kind_of(scene)][column]}", __package__)
