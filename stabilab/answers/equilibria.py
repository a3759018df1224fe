"""All equilibria of a scene, whatever acts on the body: which analysis answers which scene."""
from __future__ import annotations

from dataclasses import replace

from ..asked import checked_scene
from ..equilibrium.damped.dissipative import dissipative_equilibria, rest_positions
from ..equilibrium.field.permanent_rotations import permanent_rotations
from ..equilibrium.field.steady_states import steady_states
from ..equilibrium.gyrostat import gyrostat_equilibria
from ..equilibrium.result import Equilibria
from ..physics.coefficients import Content, content, gyrostat_scene


def equilibria(scene) -> Equilibria:
    """Every equilibrium of a Scene (body, gyrostat, constant torque) or ScaledGyrostat, each with its stability.

    States are in the scene's variables: rad/s in the principal axes, or the dimensionless x. kind is "none" (the reason
    says why), "points" (isolated), "curves" or "all". A plane of equilibria (equal moments) is one entry of `curves`
    named "plane ...": its point(t) runs along one line through the centre, its samples lie on several. Folds are also
    among the samples, with their verdicts. Scenes with charge, liquid, resistance, gravity, Newtonian field or body
    force are answered too; there a point may be (omega, gamma), and kind "undecided" says that not all equilibria
    are known. Raises InputError for effects this analysis does not cover.
    """
    found = _found(checked_scene(scene))
    if not scene.approximate:
        return found
    from ..physics.law_limits import at_equilibria
    return replace(found, validity=at_equilibria(scene, found))


def _found(scene) -> Equilibria:
    found = None if scene.plain else other_equilibria(scene)
    return gyrostat_equilibria(scene) if found is None else found


def other_equilibria(scene) -> Equilibria | None:
    """The equilibria of a scene of known effects; None where it has one that is not known here.

    A constant charge and a force at the centre of mass leave the gyrostat's own analysis; a liquid or resistance:
    `dissipative`; gravity, a Newtonian field, a charge that follows the attitude: `permanent_rotations`, whose states are
    (omega, gamma). Where not all equilibria are known, kind is "undecided" and the reason says why.
    """
    parts = content(scene)
    if parts is None:
        return None
    found = BY_KIND[parts.kind](parts)
    return replace(found, reason=f"{found.reason}; {parts.note}") if parts.note else found


def _gyrostat(parts: Content) -> Equilibria:
    return gyrostat_equilibria(gyrostat_scene(parts))


def _dissipative(parts: Content) -> Equilibria:
    return dissipative_equilibria(parts)


def _directed(parts: Content) -> Equilibria:
    if any(parts.M):
        return steady_states(parts)
    return permanent_rotations(parts)


def _directed_dissipative(parts: Content) -> Equilibria:
    if parts.kappa:
        return Equilibria("undecided", "undecided: where the body carries a liquid, the torque of a field or of a turning charge enters the liquid's own "
                                       "torque, and equilibria beyond those of the body without liquid are not excluded")
    if any(parts.M):
        return Equilibria("undecided", "undecided: a constant torque and a field hold a turning body against the medium only where four equations in omega "
                                       "and gamma meet; no closed form is known")
    return rest_positions(parts)


BY_KIND = {"gyrostat": _gyrostat, "dissipative": _dissipative, "directed": _directed,
           "directed and dissipative": _directed_dissipative}
