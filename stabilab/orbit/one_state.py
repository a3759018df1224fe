"""The motion of one state of a scene with an orbit: fate, extremes, margins, period, invariants; no arrays.
"""
from __future__ import annotations

import math

from ..physics.coefficients import three_floats
from .extremes.one_state import extremes_of
from .far_states import far_exponent, far_fate, in_scene_unit, own
from .fate.one_state import fate_of
from .one_orbit import Orbit
from .period import precise_period
from .reduction import reduce
from .result import Fate, Motion, finite, judged, repeats
from .separatrix.distance import distance_of


def motion(scene, state, span=None, exact=None, brief: bool = False) -> Motion:
    """See `answers.motion`; the scene has a reduction, and `span` is not needed."""
    state = three_floats(state)
    orbit = Orbit(reduce(scene), exact or state)
    far = far_exponent(scene, orbit.state)
    if far is None:
        return _reduced(orbit, state, fate_of(scene, orbit), brief)
    near = own(orbit, far)
    decided = far_fate(scene, orbit, far, near)
    return in_scene_unit(_reduced(near, tuple(map(float, near.state)), decided, brief, far), far, state,
                         decided.margin)


def _reduced(orbit, state, decided, brief, k=0) -> Motion:
    """All that is known of a motion with this orbit and fate; state: the doubles of its start. The extremes
    are in units 2^-k of the orbit's."""
    fields = judged(state, decided)
    fields |= {"margin_energy": finite(decided.margin), "tolerance": 1e-12,
               "extremes": extremes_of(orbit, decided.label, k)}
    return Motion(**fields,
                  **({"period": _period(orbit, decided)} if brief else _rest(orbit, state, decided)))


def _rest(orbit, state, decided) -> dict:
    return {**apart_fields(orbit, state, decided), "period": _period(orbit, decided),
            "invariants": orbit.invariants()}


def _period(orbit, decided) -> float | None:
    return repeats(precise_period(orbit, decided.label))


def apart_fields(orbit: Orbit, state, decided) -> dict:
    """The fields of a Motion that tell the distance from the separatrix; state: the doubles of the orbit's.
    """
    if decided.label == Fate.SEPARATRIX or decided.margin == 0:
        return {"margin_velocity": 0.0, "velocity_bounds": (0.0, 0.0), "velocity_witness": state}
    found = distance_of(orbit.reduction, orbit.state, orbit)
    if not math.isfinite(found.upper):
        return {"velocity_because": found.because}
    return {"margin_velocity": found.value, "velocity_bounds": (found.lower, found.upper),
            "velocity_witness": found.witness,
            "velocity_because": found.because}
