"""The part of a certificate for motions with a closed solution: no torque, spheres, bodies of revolution
without a transverse wheel.

`unreduced.spin_up.symmetric` has the solutions. Told are the law, the exact direction along which the rates
grow, how fast they do at least, and how large what lies across that direction (or, bounded, the whole rate)
ever becomes at most. docs/certificate.md has the form.
"""
from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from ..numbers.exact import sqrt_fraction
from ..numbers.vectors import dot
from ..orbit.result import Fate
from ..physics.scene import AnyScene
from ..unreduced.spin_up.symmetric import axis_of_symmetry, exactly

# relative, of what is told of gain and size: another's rounding of the roots in them
ROOM = Fraction(1, 10**9)


def closed_motion(scene: AnyScene, state: Sequence[Fraction]) -> dict[str, Any] | None:
    """Fate, axis, sense and the claims of the closed solution from a state (three Fractions); None for scenes
    that have none."""
    found = exactly(scene, state)
    if found is None:
        return None
    # found of bodies alone
    D, l, M = scene.body.exact, scene.vector("gyrostat"), scene.vector("constant_torque")  # type: ignore[union-attr]
    law, direction, gain, most = (_free(D, state) if not any(M) else _sphere(D[0], l, M, state)
                                  if len(set(D)) == 1 else _symmetric(D, l, M, state))
    claims = {"law": law, "direction": direction and list(map(str, direction)),
              "gain": gain and str(gain * (1 - ROOM)), "most": str(most * (1 + ROOM))}
    grows = found.fate is Fate.SPIN_UP
    return {"fate": found.fate.word, "axis": found.axis if grows else 0, "sense": found.sense if grows else 0,
            "closed": claims}


def _free(D: Any, state: Any) -> Any:
    return "free", None, None, sqrt_fraction(dot(D, [v * v for v in state]) / min(D))


def _sphere(D: Any, l: Any, M: Any, state: Any) -> Any:
    if not any(l):
        return "sphere", M, _size(M) / D, _across(state, M)
    along = dot(l, M)
    across = _across(state, l) + 2 * _across(M, l) / _size(l)
    if not along:
        return "sphere", None, None, across + abs(dot(state, l)) / _size(l)
    return "sphere", [v if along > 0 else -v for v in l], abs(along) / _size(l) / D, across


def _symmetric(D: Any, l: Any, M: Any, state: Any) -> Any:
    i: Any = axis_of_symmetry(D)
    j = (i + 1) % 3
    law, flat = "axis of symmetry", [v * (n != i) for n, v in enumerate(M)]
    push, cone = _size(flat) / D[j], _size([v * (n != i) for n, v in enumerate(state)])
    if M[i]:
        turning = abs(D[i] - D[j]) * abs(M[i]) / (D[i] * D[j])  # of the turn's own rate
        return law, [Fraction((n == i) * (1 if M[i] > 0 else -1))
                     for n in range(3)], abs(M[i]) / D[i], cone + 8 * push / sqrt_fraction(turning)
    turn = ((D[i] - D[j]) * state[i] + l[i]) / D[j]
    if not turn:
        return law, flat, push, _across(state, flat)
    return law, None, None, cone + 2 * push / abs(turn) + abs(state[i])


def _size(vector: Any) -> Fraction:
    return sqrt_fraction(Fraction(dot(vector, vector)))


def _across(vector: Any, along: Any) -> Fraction:
    """The size of the part of a vector across another."""
    return sqrt_fraction(Fraction(dot(vector, vector))
                         - Fraction(dot(vector, along)) ** 2 / dot(along, along))
