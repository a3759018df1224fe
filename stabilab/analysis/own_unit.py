"""A motion in its own unit of time, in which its rates are of order one.

The step control of Taylor series is relative to the state above size 1 but absolute below: rates of 1e-5 rad/s would lose
five digits, and coefficients of a series in t underflow for slower ones still. Euler's equations with a gyrostatic moment
and a constant torque are homogeneous: with omega = u y and t = s/u, y obeys them with moment/u and torque/u^2. For u a power
of two the change is exact.
"""
from __future__ import annotations

import math
from fractions import Fraction

from ..effects.constant_torque import ConstantTorque
from ..effects.gyrostat import Gyrostat
from ..scene import Scene, ScaledGyrostat

SLOW, FAST = 2.0**-4, 2.0**20  # between these the unit stays: the control is at most 16 times coarser than asked


def own_unit(scene, state, rates) -> float:
    """The power of two near the size of a motion's rates, 1 where they are ordinary or the scene has other effects.

    The size is that of the state (three numbers) or of what its rates make of it, the root of omega'.
    """
    if not getattr(scene, "plain", False):  # equations without their scene, too
        return 1.0
    size = max(*map(abs, state), math.sqrt(max(map(abs, rates))))
    return 1.0 if not 0 < size < math.inf or SLOW <= size <= FAST else 2.0 ** math.frexp(size)[1]


def in_unit(scene, unit: float):
    """The scene whose rates are those of `scene` over `unit`, in a time that runs `unit` times as fast."""
    u = Fraction(unit)
    if scene.variables == "scaled":
        a, b = scene.exact_ab
        return ScaledGyrostat(a / u, b / u, tuple(m / (u * u) for m in scene.exact_mu))
    return Scene(scene.body, Gyrostat(tuple(v / u for v in scene.vector("gyrostat"))),
                 ConstantTorque(tuple(v / (u * u) for v in scene.vector("constant_torque"))))
