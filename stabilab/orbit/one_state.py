"""The motion of one state of a scene with an orbit: fate, extremes, margins, period, invariants; no
arrays.

It is answered in the unit of rate in which its numbers are of order one, so that squares stay in the range
of doubles.

Rates and time change by a power of two (`own_unit`), which is exact; energies go with its square. What is no
double in the scene's own units in the end is NaN in arrays, and said in words of one motion."""
from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import contextmanager
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from ..errors import InputError
from ..physics.coefficients import three_floats
from ..physics.own_unit import ORDINARY, far_exponent, scene_exponent
from ..reasons import Sentence
from .extremes import extremes_of
from .fate import OneFate, fate_of, is_free
from .one_orbit import Orbit
from .period import precise_period
from .reduction import reduce
from .result import BOX, ROUND, Fate, Motion, Needs, finite, judged, repeats
from .separatrix.distance import distance_of

if TYPE_CHECKING:
    import numpy as np

    from ..physics.scene import AnyScene

# --- The unit of rate in which numbers are of order one
BEYOND = "beyond the range of doubles"
LOST = Sentence("beyond-doubles", "beyond the range of doubles: {what}")
NONE_IN_DOUBLES = Sentence("extremes-beyond-doubles", "none: beyond the range of doubles")()


@contextmanager
def in_range(what: str = "state"):
    """Context of an answer that has no unit of its own: InputError where its numbers leave the range of
    doubles."""
    try:
        yield
    except OverflowError:
        raise InputError(
            f"{what}: the squares of rates, moments or momenta this large are {BEYOND}: choose "
            f"other units") from None


def far_rows(scene: AnyScene, states: np.ndarray):
    """(n,) True for the states (n, 3) that `far_exponent` has a unit for."""
    import numpy as np
    own = scene_exponent(scene)
    # wheel or torque of ordinary size, and no larger rate: all of them are ordinary, known without a row's
    # own size
    within = len(states) and max(states.max(), -states.min()) < 2.0**ORDINARY
    if own is not None and abs(own) <= ORDINARY and within:
        return np.zeros(len(states), bool)
    sizes = np.abs(states).max(axis=1, initial=0.0)
    moving = sizes > 0
    exponents = np.where(moving, np.frexp(sizes)[1], ORDINARY if own is None else own)
    size = exponents if own is None else np.maximum(exponents, own)
    return (np.abs(size) > ORDINARY) & (moving if own is None else True)


def own(orbit: Orbit, k: int) -> Orbit:
    """The orbit in the unit 2^k."""
    u, reduction = Fraction(2) ** k, orbit.reduction
    nearby = replace(reduction, s=reduction.s / u, p0=reduction.p0 / u, q0=reduction.q0 / u,
                   rho=reduction.rho / u,
                   sigma=reduction.sigma / u, m=reduction.m / (u * u))
    return Orbit(nearby, tuple(Fraction(v) / u for v in orbit.state))


def powered(value: float, k: int) -> float:
    """value * 2^k; NaN where that is no double, or 0 where value is not."""
    try:
        result = math.ldexp(value, k)
    except OverflowError:
        return math.nan
    return result if result or not value else math.nan


def far_fate(scene: AnyScene, orbit: Orbit, k: int, nearby: Orbit | None = None):
    """The fate of one state of a scene, as an `OneFate`; nearby: its orbit in the unit 2^k, where that is at
    hand."""
    result = fate_of(scene, orbit, nearby or own(orbit, k))
    return result if is_free(scene) else result._replace(margin=powered(result.margin, 2 * k))


def in_scene_unit(result: Motion, k: int, state, margin: float) -> Motion:
    """A motion found in the unit 2^k, but for its extremes, in the scene's own; state: the doubles of its
    start; margin: of its fate, in the scene's unit."""
    lost = ["the margin in energy"] if math.isnan(margin) else []

    def told(name: str, value: float | None, power: int):
        if value is None or not math.isnan(number := powered(value, power * k)):
            return None if value is None else number
        lost.append(name)
    fields = {"margin_energy": finite(margin),
              "margin": margin, "returns": powered(result.returns, -k),
              "margin_velocity": told("the margin in angular velocity", result.margin_velocity, 1),
              "period": told("the period", result.period, -1)}
    invariants = {name: powered(value, 2 * k) for name, value in result.invariants.items()}
    pairs = result.extremes and _finite(result.extremes)
    if result.extremes and pairs is None:
        lost.append("an extreme")
    reason = result.reason.then(LOST(what=", ".join(lost)) if lost else None)
    return replace(result, at=state, reason=reason, extremes=pairs,
                   invariants={n: v for n, v in invariants.items() if not math.isnan(v)},
                   over=result.over if pairs or not result.extremes else NONE_IN_DOUBLES,
                   **fields)


def _finite(pairs: Sequence[tuple[float, float]]):
    """The pairs, or None where one is larger than any double."""
    return None if any(map(math.isnan, sum(pairs, ()))) else pairs


def far_numbers(scene: AnyScene, state: Sequence[float]):
    """((3, 2) extremes, period) of one state of a scene with a reduction, as rows of `extremes` and `period`
    have them; NaN where they are no doubles."""
    orbit, k = Orbit(reduce(scene), state), far_exponent(scene, state) or 0
    nearby = own(orbit, k)
    label = fate_of(scene, orbit, nearby).label
    return extremes_of(nearby, label, k), powered(precise_period(nearby, label), -k)


# --- The motion
def motion(scene: AnyScene, state: np.ndarray | Sequence[float | str], span: Sequence[float] | None = None,
           exact: Sequence[Fraction] | None = None, needs: Needs = Needs.ALL) -> Motion:
    """See `answers.motion`; the scene has a reduction, and `span` is not needed."""
    state = three_floats(state)
    orbit = Orbit(reduce(scene), exact or state)
    far = far_exponent(scene, orbit.state)
    if far is None:
        return _reduced(orbit, state, fate_of(scene, orbit), needs)
    nearby = own(orbit, far)
    decided = far_fate(scene, orbit, far, nearby)
    return in_scene_unit(_reduced(nearby, tuple(map(float, nearby.state)), decided, needs, far), far, state,
                         decided.margin)


def _reduced(orbit, state, decided, needs, k=0) -> Motion:
    """All that is known of a motion with this orbit and fate; state: the doubles of its start. The extremes
    are in units 2^-k of the orbit's."""
    fields = judged(state, decided)
    fields |= {"margin_energy": finite(decided.margin), "tolerance": 1e-12}
    if needs & BOX:
        fields["extremes"] = extremes_of(orbit, decided.label, k)
    if needs & Needs.DISTANCE:
        fields |= apart_fields(orbit, state, decided)
    if needs & Needs.INVARIANTS:
        fields["invariants"] = orbit.invariants()
    if needs & ROUND:
        fields["returns"] = precise_period(orbit, decided.label)
        fields["period"] = repeats(fields["returns"])
    return Motion(**fields)


def apart_fields(orbit: Orbit, state: Sequence[float], decided: OneFate) -> dict:
    """The fields of a Motion that tell the distance from the separatrix; state: the doubles of the orbit's.
    """
    if decided.label == Fate.SEPARATRIX or decided.margin == 0:
        return {"margin_velocity": 0.0, "velocity_bounds": (0.0, 0.0), "velocity_witness": state}
    result = distance_of(orbit.reduction, orbit.state, orbit)
    if not math.isfinite(result.upper):
        return {"velocity_reason": result.reason}
    return {"margin_velocity": result.value, "velocity_bounds": (result.lower, result.upper),
            "velocity_witness": result.witness,
            "velocity_reason": result.reason}
