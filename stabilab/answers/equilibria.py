"""Equilibria of scenes with more than a gyrostat and a constant torque: which analysis answers which scene."""
from __future__ import annotations

from dataclasses import replace

from ..physics.coefficients import Content, content, gyrostat_scene
from ..equilibrium.result import Equilibria


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
    from ..equilibrium.gyrostat import equilibria
    return equilibria(gyrostat_scene(parts))


def _dissipative(parts: Content) -> Equilibria:
    from ..equilibrium.damped.dissipative import dissipative_equilibria
    return dissipative_equilibria(parts)


def _directed(parts: Content) -> Equilibria:
    if any(parts.M):
        from ..equilibrium.field.steady_states import steady_states
        return steady_states(parts)
    from ..equilibrium.field.permanent_rotations import permanent_rotations
    return permanent_rotations(parts)


def _directed_dissipative(parts: Content) -> Equilibria:
    if parts.kappa:
        return Equilibria("undecided", "undecided: where the body carries a liquid, the torque of a field or of a turning charge enters the liquid's own "
                                       "torque, and equilibria beyond those of the body without liquid are not excluded")
    if any(parts.M):
        return Equilibria("undecided", "undecided: a constant torque and a field hold a turning body against the medium only where four equations in omega "
                                       "and gamma meet; no closed form is known")
    from ..equilibrium.damped.dissipative import rest_positions
    return rest_positions(parts)


BY_KIND = {"gyrostat": _gyrostat, "dissipative": _dissipative, "directed": _directed,
           "directed and dissipative": _directed_dissipative}
