"""How fast a scene's motion goes: the rate by which the series behind an approximate law is judged."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import Any

from ...numbers.vectors import Number, Triple, dot
from .base import Effect


def pace(scene: Any, state: Mapping[str, Sequence[Number]], without: Effect) -> Number:
    """The fastest rate of the motion at a state, 1/s, for any shape of its components; `without`: the effect that asks.

    |omega| + |A| + sqrt(|tau|/D): A is the derivative of omega' by omega along the motion without that effect (Frobenius norm: wheel,
    charge, resistance, the body's own turning), tau the torque at omega = 0 of effects that are not small, D the least moment. So
    |omega'' + omega x omega'| is at most pace times |omega'| where nothing but omega sets the torque.
    """
    D = tuple(map(float, scene.body.inertia))
    omega = state["omega"]
    zero = omega[0] * 0.0
    carried, still, slope = [0.0] * 3, [zero] * 3, [[zero] * 3 for _ in range(3)]
    for effect in scene.effects:
        if effect is without or any(block not in state for block in effect.needs if block in ("gamma",)):
            continue
        p = {name: float(value) for name, value in effect.parameters().items()}
        carried = [a + b for a, b in zip(carried, effect.momentum(p) or (0.0,) * 3)]
        first = _torque(effect, D, state, (zero, zero, zero), p)
        still = still if effect.small else [a + b for a, b in zip(still, first)]
        for j in range(3):
            unit = tuple(zero + (i == j) for i in range(3))
            slope_j = _torque(effect, D, state, unit, p)
            for i in range(3):
                slope[i][j] = slope[i][j] + slope_j[i] - first[i]
    H = [d * w + h for d, w, h in zip(D, omega, carried)]
    for i, (j, k) in enumerate(((1, 2), (2, 0), (0, 1))):  # (H x omega)_i = H_j omega_k - H_k omega_j
        slope[i][j] = slope[i][j] + D[j] * omega[k] - H[k]
        slope[i][k] = slope[i][k] + H[j] - D[k] * omega[j]
    squares = sum((slope[i][j] / D[i]) * (slope[i][j] / D[i]) for i in range(3) for j in range(3))
    return dot(omega, omega) ** 0.5 + squares ** 0.5 + (dot(still, still) ** 0.5 / min(D)) ** 0.5


def _torque(effect: Effect, D: Sequence[float], state: Mapping[str, Sequence[Number]], omega: Sequence[Number], p: Mapping[str, Number]) -> Triple:
    """The torque of an effect that is linear in omega, in numbers."""
    return effect.torque_along(SimpleNamespace(**{**state, "omega": omega}, D=D), p) or (0.0,) * 3
