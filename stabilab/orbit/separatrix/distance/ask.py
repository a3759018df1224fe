"""How far a state is from the separatrix: the smallest change of the three rates that reaches it, with a proof and a witness.

The separatrix is the set of states whose fate is to tend to a saddle of the reduced potential: the loops of all saddles, on a
circle under a torque of those that no higher barrier stands beside (`shade`), swept along the branches of saddles. Branch and
bound over these sheets (`search`) brings a proved lower bound and a point of the separatrix together; what the number of boxes does
not close is told as a bracket.
"""
from __future__ import annotations

import math
from fractions import Fraction

from ....numbers.balls import Unclear
from ....physics.alignment import aligned
from ...ball_orbit import Orbit
from ...fate.on_separatrix import on_separatrix
from ...reduction import reduce
from ..result import ENDED, NO_SEPARATRIX, UNKNOWN, Apart
from .on_conics import on_conic
from .parabolas import on_parabolas

INF = math.inf


def separatrix_distance(scene, states):
    """Euclidean distance (...,) of states (..., 3) from the nearest point of the scene's separatrix, in the unit of the
    states: to 1e-9, or a proved lower bound; inf where the scene has none, NaN where it is not known.

    A torque in a plane of equal moments: the distance of the turned state in the turned scene, as a turn keeps distances. Not known:
    a free gyrostat without a reduction (its separatrix is known by its energy on each momentum sphere, not as sheets), and a torque
    off the axes. A gyrostatic moment along the torque leaves no equilibrium (|H|^2/2 - D T grows steadily), so no separatrix: inf.
    """
    import numpy as np
    array = np.asarray(states, float)
    asked = _asker(scene)
    flat = [asked(state) for state in array.reshape(-1, 3).tolist()]
    return np.array(flat, float).reshape(array.shape[:-1])


def _asker(scene):
    """The function of one state that gives its distance."""
    reduction, turn = reduce(scene), aligned(scene)
    if reduction is not None:
        return lambda state: distance_of(reduction, state).value
    if turn is not None:
        turned = reduce(turn.twin)
        return lambda state: distance_of(turned, turn(state)).value
    return lambda state: INF if has_no_saddle(scene) else math.nan


def has_no_saddle(scene) -> bool:
    """Whether a scene without a reduction, its torque on one axis or none, has no saddle for sure: a gyrostatic moment along the torque
    leaves no equilibrium, and with equal moments the kinetic energy is a linear function on each momentum sphere."""
    acting = sum(m != 0 for m in scene.quadratic().m)
    return acting == 1 or not acting and not any(scene.quadratic().kappa)


def distance_of(reduction, state, orbit: Orbit | None = None) -> Apart:
    """The distance of one state (three floats or Fractions) of a scene with this reduction (None: it has none).

    orbit: the state's, where that is at hand.
    """
    if reduction is None:
        return NO_SEPARATRIX
    state = tuple(v if isinstance(v, Fraction) else float(v) for v in state)
    try:
        orbit = orbit or Orbit(reduction, state)
        if on_separatrix(orbit):
            return Apart(0.0, 0.0, (float(state[0]), float(state[1]), float(state[2])))
        found = on_conic(reduction, state, orbit) if reduction.geometry.centred else on_parabolas(reduction, state)
    except (Unclear, ArithmeticError, ValueError):  # a logarithm of what has vanished in doubles is a ValueError
        return UNKNOWN
    if found.upper != found.upper or found.lower != found.lower:
        return UNKNOWN
    return found if found.settled else found._replace(because=ENDED)
