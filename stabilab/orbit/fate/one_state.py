"""The fate of one state of a scene with a reduction, without arrays.

The mechanics is that of `ball_orbit` (the orbit, its equilibria, its turning points); it is asked with 64 bits first
and in many digits where these leave a question open. So a single state needs no NumPy,
every answer is certain to at least twelve digits, and near a separatrix there is no second formula to disagree with.
Answers are those of `fate`, `extremes` and `period` for arrays: the same labels and reasons, numbers to rounding.
"""
from __future__ import annotations

import math
from fractions import Fraction
from typing import NamedTuple

from ...numbers.balls import DOUBLE_BITS, FIRST_BITS, working
from ...physics.quadratic import rests
from ..ball_orbit import Orbit
from ..result import Fate
from .balls import decide
from .free_margin import free_margin, is_free
from .reasons import REASONS, Reason, margin_at_rest

INF = math.inf


class OneFate(NamedTuple):
    """Fate of one state: as in `result.FateResult`, the margin in the scene's energy."""

    label: Fate
    reason: Reason
    margin: float
    axis: int = 0
    sense: int = 0

    @property
    def because(self) -> str:
        return REASONS[self.reason]


def fate_of(scene, orbit: Orbit, near: Orbit | None = None) -> OneFate:
    """The fate of one state of a scene with this orbit.

    near: the orbit in a unit in which to compare energies; the margin is in it then.
    """
    reduction, state = orbit.reduction, orbit.state
    if is_free(scene):  # in the scene's unit, whatever its size
        found = free_fate(scene, state)
    else:
        found = {-1: _on_circle, 1: _on_hyperbola, 0: _on_parabola}[reduction.e](near or orbit)
        lost = found.margin == 0 and found.label != Fate.SEPARATRIX  # its sign is known, and it is too small for a double
        found = found._replace(margin=math.nan if lost else found.margin * reduction.energy_unit)
    return at_rest(scene, found) if rests(scene.quadratic(), state) else found


def at_rest(scene, found: OneFate) -> OneFate:
    """The fate of an equilibrium, given what its energy alone says."""
    return OneFate(Fate.EQUILIBRIUM, Reason.AT_REST, margin_at_rest(scene, found.margin))


def free_fate(scene, state) -> OneFate:
    """The fate without a torque: bounded, whatever the margin, or on a separatrix of the momentum sphere."""
    margin = free_margin(scene, state, doubles=True)
    return _tie() if margin.tie else OneFate(Fate.BOUNDED, Reason.TORQUE_FREE, margin.double)


def _spin_up(r, reason, margin) -> OneFate:
    return OneFate(Fate.SPIN_UP, reason, margin, r.axis + 1, r.sense)


def _tie() -> OneFate:
    return OneFate(Fate.SEPARATRIX, Reason.TIE, 0.0)


def _on_circle(orbit) -> OneFate:
    r = orbit.reduction
    if _shifted(orbit) == (0, 0):  # the circle is a point: pure spin, and nothing stands in its way
        found = None
    else:
        found = decide(orbit, FIRST_BITS)
        if found.sign == 0:
            return _tie()
    margin = -INF if found is None else found.margin
    if r.sense == 0:
        return OneFate(Fate.BOUNDED, Reason.TORQUE_FREE, margin)
    if found is not None and found.sign > 0:
        return OneFate(Fate.BOUNDED, Reason.BELOW_BARRIER, margin)
    return _spin_up(r, Reason.NO_BARRIER if margin == -INF else Reason.ABOVE_BARRIER, margin)


def _shifted(orbit) -> tuple[Fraction, Fraction]:
    """(omega_j + s_j, omega_k + s_k), exactly."""
    r, state = orbit.reduction, orbit.state
    sj, sk = r.centre
    return Fraction(state[r.j]) + sj, Fraction(state[r.k]) + sk


def _valley(orbit) -> OneFate:
    """Between walls: bounded on either side of a barrier, if there is one."""
    tie = decide(orbit, FIRST_BITS)
    if tie.sign == 0:
        return _tie()
    return OneFate(Fate.BOUNDED, Reason.WALLS, INF if tie.margin == -INF else tie.margin)


def _on_hyperbola(orbit) -> OneFate:
    r, (u, v) = orbit.reduction, _shifted(orbit)
    if v * v * abs(r.p) != u * u * abs(r.q):
        return _valley(orbit)
    if u == 0:
        return _spin_up(r, Reason.PURE_SPIN, -INF)
    if (u > 0) == (v > 0) and r.sense * r.p > 0 or (u > 0) != (v > 0) and r.sense * r.p < 0:
        return OneFate(Fate.BOUNDED, Reason.WALLS, INF)  # eta = 0: it grows ahead, and the torque's tilt rises behind
    tie = decide(orbit, FIRST_BITS)
    if tie.sign > 0:
        return OneFate(Fate.BOUNDED, Reason.PLANE_CAPTURED, tie.margin)
    return _tie() if tie.sign == 0 else _spin_up(r, Reason.PLANE_ESCAPES, tie.margin)


def _on_parabola(orbit) -> OneFate:
    if not any(orbit.settled(lambda found: found.taylor[1:], FIRST_BITS)):
        return _spin_up(orbit.reduction, Reason.PURE_SPIN, -INF)  # the force is the same all along the orbit
    return _valley(orbit)


def as_double(value: Fraction) -> float:
    try:
        return float(value)
    except OverflowError:
        return math.nan


def scaled_double(value, k: int) -> float:
    """The double nearest to 2^k times a ball or float; its own double may have underflowed in the other unit."""
    if not k or isinstance(value, float):
        return float(value)
    middle = float(value)
    if abs(middle) > 2.0**-900:
        return as_double(Fraction(middle) * Fraction(2) ** k)
    with working(DOUBLE_BITS) as numbers:
        return float(value * numbers.ball(Fraction(2) ** k))
