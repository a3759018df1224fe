"""Period of one motion, and times along it, in balls: every digit returned is certain.

Without a torque, and on a parabola, the period is that of an elliptic curve (`elliptic`). Else it is the
integral of dtheta/W between the turning points, cut in their middle: from a turning point y1 on, with y = y1
+- s^2 and F the mean force over the way,

    W^2 = 2 (y - y1) F(y1, y),    dt = 2 ds/sqrt(2 |F|),

where nothing is singular any more. F is a formula without cancellation (`BallConic.mean_force`), and arb's
integral encloses it: Gauss and Legendre's rule on pieces that are halved until an ellipse about each shows
that its remainder is small enough (Johansson, Numerical integration in arbitrary-precision ball arithmetic,
2018)."""
from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

from ..numbers.balls import Unclear, sharpened, sign
from .double_exponential import by_double_exponential
from .elliptic import quartic_on_parabola, quartic_without_torque, real_period
from .extremes import turning_points
from .one_orbit import BallConic, BallOrbit, Orbit
from .period_sum import MAX_NODES, plan, summed
from .result import Fate, without_return

if TYPE_CHECKING:
    from flint import acb, arb

DIGITS = 14
DOUBLE_PERIOD = 17  # digits that a double is rounded from
TRIED_BITS = 1024  # of that rule, before it is left
FEW_DIGITS = 20  # up to which the double-exponential rule serves
SPARE_BITS = 8  # by which the remainder of an integral is larger than the rounding of its function
EVALUATIONS = 100  # of an integral, for each bit
MOST_BITS = 1 << 14  # at least, in which a period is tried


def precise_period(orbit: Orbit, label: int) -> float:
    """Period of one state with the given `Fate` label: inf where the motion does not repeat, 0 at an
    equilibrium, NaN where it is undecided."""
    return without_return(label) if label != Fate.BOUNDED else float(period_ball(orbit, DOUBLE_PERIOD).mid())


def period_ball(orbit: Orbit, digits: int = DIGITS, tell: Callable[[float], None] | None = None) -> arb:
    """Period of a bounded motion as a ball that is 10^-digits of it wide at most. tell: is given the seconds
    that it will take, before a long sum."""
    r = orbit.reduction
    if not r.geometry.centred:
        taylor = orbit.settled(lambda result: result.taylor)
        return real_period(quartic_on_parabola(r, orbit.state, taylor), digits)
    if not r.sense:
        return real_period(quartic_without_torque(r, orbit.state), digits)
    return sharpened(orbit.settled, partial(_libration, digits=digits, tell=tell), digits, MOST_BITS)


def _libration(orbit: BallOrbit, digits: int, tell: Callable[[float], None] | None = None) -> arb:
    """Once to and fro between the turning points, which is all that a torque leaves: by a sum (`period_sum`)
    where few terms serve, else by the double-exponential rule, or, to many digits, twice the integral between
    them."""
    from flint import ctx
    left, right = turning_points(orbit)
    by = plan(orbit, left, right, ctx.prec)
    if by is not None and (nodes := by.nodes(ctx.prec)) <= MAX_NODES:
        return summed(orbit, left, right, by, nodes, tell)
    if digits <= FEW_DIGITS:
        try:
            return by_double_exponential(orbit, left, right, digits)
        except Unclear:
            if ctx.prec < TRIED_BITS + 8 * digits:
                raise  # more bits may serve, beyond these its steps do not
    middle = ((left + right) / 2).mid()
    return 2 * (time_from_turn(orbit, left, middle) + time_from_turn(orbit, right, middle))


def time_from_turn(orbit: BallConic, turn: arb, place: arb) -> arb:
    """Time from a turning point to a place before the other one."""
    side = 1 if sign(place - turn) > 0 else -1
    length = (side * (place - turn)).sqrt()

    def rate(s: acb, analytic: bool) -> acb:
        return 2 * length / (2 * side * orbit.mean_force(turn, side * (length * s) ** 2)).sqrt(analytic)
    return _integral(rate)


def time_between(orbit: BallConic, place: arb) -> arb:
    """Time from the state to a place, where the motion turns at neither nor between."""
    square = 2 * orbit.energy

    def rate(s: acb, analytic: bool) -> acb:
        way = place * s
        return abs(place) / (square + 2 * way * orbit.mean_force(square * 0, way)).sqrt(analytic)
    return _integral(rate)


def _integral(rate: Any) -> arb:
    """Integral from 0 to 1 of a function that is positive there."""
    from flint import acb, arb, ctx
    sizes = [rate(acb(arb(part) / 4), False).real for part in (0, 2, 4)]
    if not all(size > 0 for size in sizes):
        raise Unclear
    # pieces below the rounding of the function would be halved for ever
    accuracy = arb(2) ** (SPARE_BITS - min(size.rel_accuracy_bits() for size in sizes))
    value = acb.integral(rate, 0, 1, rel_tol=accuracy, abs_tol=accuracy * sizes[1].mid(),
                         eval_limit=EVALUATIONS * ctx.prec).real
    if not value.is_finite():
        raise Unclear
    return value
