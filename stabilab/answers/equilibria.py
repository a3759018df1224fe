"""All equilibria of a scene, whatever acts on the body: which analysis answers which scene."""
from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from importlib import import_module
from typing import Any

from ..case.given import Given, as_case
from ..equilibrium.gyrostat import gyrostat_equilibria
from ..equilibrium.result import Equilibria
from ..physics.coefficients import content, limits_of
from ..physics.effects import effect_class
from ..physics.scene import AnyScene, ScaledGyrostat, Scene
from ..reasons import Reason, Sentence
from .caveats import answered

# kind of a scene's torques -> (module of `equilibrium`, its function of their coefficients); one that no
# scene names is not loaded
BY_KIND = {
    "gyrostat": ("gyrostat", "twin_equilibria"),
    "dissipative": ("dissipative", "dissipative_equilibria"),
    "directed": ("field_states", "directed_equilibria"),
    "directed and dissipative": ("dissipative", "held_in_a_field"),
    "eddy currents": ("dissipative", "eddy_equilibria"),
    "wheel motor": ("wheel_motor", "equilibria_with_a_motor"),
}

STOPPED = Sentence(
    "once-motor-stopped",
    "of the body once the motor has stopped, where its wheel had the momentum of the gyrostat when it "
    "started")()
STARTED = Sentence(
    "once-motor-stopped-from-start",
    "of the body once the motor has stopped, from the momentum of its wheel in [motion] on")()


def once_stopped(result: Equilibria) -> Reason | None:
    """Of which body they are, where a motor stops; else None."""
    return next((item for item in (STOPPED, STARTED) if result.reason.says(item.sentence)), None)


def equilibria(scene: Given) -> Equilibria:
    """Every equilibrium of a scene, or of a case in any form, each with its stability.

    States are in the scene's variables: rad/s in the principal axes, or the dimensionless x. kind is "none"
    (the reason says why), "points" (isolated), "curves" or "all". A plane of equilibria (equal moments) is
    one entry of `curves` named "plane ...": its point(t) runs along one line through the centre, its samples
    lie on several. Folds are also among the samples, with their verdicts. Scenes with charge, liquid,
    resistance, gravity, Newtonian field or body force are answered too; there a point may be (omega, gamma),
    and kind "undecided" says that not all equilibria are known. Raises InputError for effects this analysis
    does not cover.
    """
    case = None if isinstance(scene, (Scene, ScaledGyrostat)) else as_case(scene)
    of: Any = scene if case is None else case.scene
    if case is not None and of.ending and any(supplied := case.blocks.get("wheel", ())):
        result = equilibria(_with_wheel(of, supplied))
        result = replace(result, reason=result.reason.without(STOPPED.sentence).then(STARTED))
        return answered(result, case, result.validity)
    result = (None if of.plain else other_equilibria(of)) or gyrostat_equilibria(of)
    limits = limits_of(of)
    result = replace(result, frame=of.frame, validity=limits.at_equilibria(of, result) if limits else None)
    return result if case is None else answered(result, case, result.validity)


def _with_wheel(scene: Any, momentum: Any) -> Scene:
    """The scene whose wheels have so much more momentum, N m s, at the start."""
    total = tuple(a + Fraction(b) for a, b in zip(scene.vector("gyrostat"), momentum))
    return Scene(scene.body, effect_class("gyrostat")(total),
                 *(effect for effect in scene.effects if effect.name != "gyrostat"))


def other_equilibria(scene: AnyScene) -> Equilibria | None:
    """The equilibria of a scene of known effects; None where it has one that is not known here.

    A constant charge and a force at the centre of mass leave the gyrostat's own analysis; a liquid or
    resistance: `dissipative`; gravity, a Newtonian field, a charge that follows the attitude:
    `permanent_rotations`, whose states are (omega, gamma). Where not all equilibria are known, kind is
    "undecided" and the reason says why.
    """
    parts = content(scene)
    if parts is None:
        return None
    stops = parts.duration is not None
    parts = parts.without_motor if stops else parts
    module, answer = BY_KIND[parts.kind]
    result = getattr(import_module(f"..equilibrium.{module}", __package__), answer)(parts)
    return replace(result, reason=result.reason.then(parts.note).then(STOPPED if stops else None))
