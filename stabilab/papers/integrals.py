"""The paper's integrals F, N, G1, G2, G3 of a motion, by the true equations, and the equilibria beside it:
the centre that it turns about and the saddle that decides its fate, each with its eigenvalue."""
from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..answers.motion import motion
from ..case.read import Case
from ..equilibrium.stability import invariants
from ..orbit.phase_plane import PhasePlane, phase_plane
from ..orbit.result import Motion

Place = tuple[float, float, float]
DIGITS = 12  # of places and eigenvalues: the last ones of a double hang on the processor's sines


@dataclass(frozen=True)
class Equilibrium:
    """at: x1, x2, x3; eigenvalue: the size s of the pair, ±s at a saddle and ±i s at a centre; the third
    eigenvalue is 0, for equilibria lie on a curve."""

    at: Place
    eigenvalue: float


@dataclass(frozen=True)
class Integrals:
    """Of one motion, dimensionless (scaled variables), None where it has no such integral.

    F: sqrt((x1 + a)^2 + x2^2), torque on the minor axis; N: ((x1 + b)^2 - x3^2)/2, torque on the intermediate
    axis, 0 on an invariant plane. G: "G1", "G2" or "G3" -> value. on_separatrix: the value of the same G at
    the saddle. centre, saddle: on the circle, hyperbola or plane of the motion.
    """

    F: float | None
    N: float | None
    G: dict[str, float]
    on_separatrix: float | None
    centre: Equilibrium | None
    saddle: Equilibrium | None


def integrals(case: Case, answer: Motion | None = None) -> Integrals:
    """Of a motion of the scaled system with a torque along one axis; answer: what is known of it already."""
    answer = answer or motion(case)
    energy, Q = answer.energy_integral, answer.invariants.get("Q")
    if energy is None or Q is None:
        return Integrals(None, None, {}, None, None, None)
    plane = phase_plane(case.scene, case.state)
    centre, saddle = (None, None) if plane is None else beside(plane)
    round_circle = energy.name == "G1"
    return Integrals(math.sqrt(Q) if round_circle else None, None if round_circle else Q / 2,
                     {energy.name: energy.value}, energy.on_separatrix,
                     *(None if y is None or plane is None else _equilibrium(case, plane, y)
                       for y in (centre, None if energy.on_separatrix is None else saddle)))


def beside(plane: PhasePlane) -> tuple[float | None, float | None]:
    """(centre that the motion turns about, saddle that decides its fate) as places y, None where there is
    none. On a circle the saddle is the highest ahead within one turn, else that nearest in height; of several
    centres within the motion the lowest is taken."""
    energy, turn = plane.W0**2 / 2, plane.land.turn
    above = lambda y: float(plane.height(y)) - energy
    if math.isinf(turn):
        saddles, centres = plane.saddles, plane.centres
        saddle = min(saddles, key=lambda y: abs(above(y)), default=None)
    else:
        saddles, centres = (plane.repeated(places, -turn, turn) for places in (plane.saddles, plane.centres))
        saddle = max((y for y in saddles if y >= 0), key=above, default=None)
    walls = [y for y in saddles if above(y) > 0]
    low = max((y for y in walls if y < 0), default=-math.inf)
    high = min((y for y in walls if y > 0), default=math.inf)
    inside = [y for y in centres if low < y < high and above(y) <= 0]
    return min(inside, key=above, default=None), saddle


def _equilibrium(case: Case, plane: PhasePlane, y: float) -> Equilibrium:
    at = plane.states(np.array(y), np.array(0.0)) + 0.0
    m, _ = invariants(case.scene.quadratic(), at.tolist())
    decimals = DIGITS - 1 - math.floor(math.log10(np.abs(at).max() or 1.0))
    place = (np.round(at, decimals) + 0.0).tolist()
    return Equilibrium(tuple(place), float(f"{math.sqrt(abs(m)):.{DIGITS}g}"))
