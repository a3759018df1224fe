"""A motion in its own unit of time, in which its rates are of order one.

The step control of Taylor series is relative to the state above size 1 but absolute below: rates of 1e-5 rad/s would lose
five digits, and coefficients of a series in t underflow for slower ones still. Euler's equations with a gyrostatic moment, a
constant torque and a resisting medium are homogeneous: with omega = u y and t = s/u, y obeys them with moment/u, torque/u^2 and
resistance/u. For u a power of two the change is exact. So is a unit of mass, which leaves the motion as it is, but not the squares in its laws.
"""
from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from ..errors import InputError
from ..physics.body import Body
from ..physics.effects.base import Effect
from ..physics.scene import AnyScene, ScaledGyrostat, Scene

SLOW, FAST = 2.0**-4, 2.0**20  # between these the unit stays: the control is at most 16 times coarser than asked

LIGHT, HEAVY = 2.0**-200, 2.0**200  # moments whose squares underflow beside `compiled.FEATHER`, or overflow

POWERS = {"gyrostat": (1, 1), "constant_torque": (2, 1), "resistance": (1, 0)}  # of the units of rate and of mass in an effect's strength


def own_unit(scene: AnyScene, state: Sequence[float], rates: Sequence[float]) -> float:
    """The power of two near the size of a motion's rates, 1 where they are ordinary or the scene has other effects.

    The size is that of the state (three numbers) or of what its rates make of it, the root of omega'.
    """
    if not _homogeneous(scene):
        return 1.0
    size = max(*map(abs, state), math.sqrt(max(map(abs, rates))))
    return 1.0 if not 0 < size < math.inf or SLOW <= size <= FAST else 2.0 ** math.frexp(size)[1]


def mass_unit(scene: AnyScene) -> float:
    """The power of two near the largest moment of a body, 1 where it is ordinary or the scene has other effects or no body."""
    if scene.variables == "scaled" or not _homogeneous(scene):
        return 1.0
    size = max(scene.body.inertia)
    return 1.0 if LIGHT <= size <= HEAVY else 2.0 ** math.frexp(size)[1]


def _homogeneous(scene: AnyScene) -> bool:
    """Whether a change of units is known here; not for equations without their scene, either."""
    if getattr(scene, "plain", False):
        return True
    return hasattr(scene, "effects") and all(e.name in POWERS for e in scene.effects)


def in_unit(scene: AnyScene, unit: float | Fraction, mass: float | Fraction = 1.0) -> AnyScene:
    """The scene whose rates are those of `scene` over `unit`, in a time that runs `unit` times as fast; its moments over `mass`.

    Raises InputError where torque or wheel are no doubles beside rates of this size.
    """
    try:
        return _changed(scene, unit, mass)
    except InputError as error:
        raise InputError(f"state: in the unit of rates of this size, {unit:.1e}, a number of the scene leaves the range of doubles, and a run in "
                         f"doubles does not follow the motion ({error})") from None


def _changed(scene: AnyScene, unit: float | Fraction, mass: float | Fraction) -> AnyScene:
    u, m = Fraction(unit), Fraction(mass)
    if scene.variables == "scaled":
        a, b = scene.exact_ab
        return ScaledGyrostat(a / u, b / u, tuple(v / (u * u) for v in scene.exact_mu))
    return Scene(Body(tuple(d / m for d in scene.body.exact)), *(_divided(effect, u, m) for effect in scene.effects))


def _divided(effect: Any, u: Fraction, m: Fraction) -> Effect:
    """The effect with its strength in the units."""
    rate, mass = POWERS[effect.name]
    unit = u**rate * m**mass
    return type(effect)(tuple(v / unit for v in effect.exact) if isinstance(effect.exact, tuple) else effect.exact / unit)
