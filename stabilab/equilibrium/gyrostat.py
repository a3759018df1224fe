"""All equilibria of a body with a gyrostatic moment under a constant torque, in closed form.

At an equilibrium (D omega + lambda) x omega + M = 0; dotting with omega and with D omega + lambda gives M.omega = 0 and
M.(D omega + lambda) = 0, two linear conditions, and what is left is at most one quadratic. Existence (parallel vectors,
signs of discriminants, conics that fall apart into lines) is decided with exact rationals; coordinates are rounded once.
Source: derived here; Amer et al. 2024 treats lambda along axis 1 and torques on one axis.
"""
from __future__ import annotations

from ..physics.coefficients import Content, gyrostat_scene
from ..physics.scene import AnyScene
from .balance import Pencil, pencil
from .conics import balance_fails, conic_curves
from .isolated import isolated_states, off_axis_equilibria
from .result import Equilibria
from .stability import curve_with_verdicts
from .torque_free import torque_free_curves


def twin_equilibria(parts: Content) -> Equilibria:
    """Equilibria of a scene whose effects turn the body as a wheel and a constant torque do."""
    return gyrostat_equilibria(gyrostat_scene(parts))


def gyrostat_equilibria(scene: AnyScene) -> Equilibria:
    """Every equilibrium of a Scene (body, gyrostat, constant torque) or ScaledGyrostat, each with its stability, as `answers.equilibria`
    tells them. Raises InputError for other effects."""
    p = pencil(scene)
    if not any(p.M):
        return _torque_free(p)
    if p.torque_axis_moment() is None:
        reason, points, curves = off_axis_equilibria(p)
        exact = tuple(curve_with_verdicts(p.form, c) for c in curves)
        return Equilibria("curves" if exact else "points" if points else "none", reason, tuple(points), exact)
    missing = balance_fails(p)
    if missing:
        return Equilibria("none", missing)
    conic = tuple(curve_with_verdicts(p.form, c) for c in conic_curves(p))
    return Equilibria("curves", "the torque is along an eigenvector of D with no gyrostatic moment along it: the two balance "
                                "conditions are one plane, and in it one conic remains", curves=conic)


def number_of_equilibria(scene: AnyScene) -> int | None:
    """How many equilibria there are, exactly and without their stability, where they are isolated under a wheel and a torque off the
    principal axes; None where they are not, or other effects act."""
    if not scene.plain:
        return None
    p = pencil(scene)
    if not any(p.M) or p.torque_axis_moment() is not None:
        return None
    _, points, curves = isolated_states(p)
    return None if curves else len(points)


def _torque_free(p: Pencil) -> Equilibria:
    if not any(p.lam) and len(set(p.D)) == 1:
        return Equilibria("all", "no torque, no gyrostatic moment and three equal moments: every rate of rotation is constant, "
                                 "so every state is an equilibrium, stable in the sense that it stays where it is put")
    exact, planes = torque_free_curves(p)
    curves = (*(curve_with_verdicts(p.form, c) for c in exact), *planes)
    return Equilibria("curves", "without a torque a state is an equilibrium exactly where momentum and rotation are parallel",
                      curves=curves)
