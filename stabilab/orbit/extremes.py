"""Extremes of one motion, in balls: every digit returned is certain."""
from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from ..numbers.balls import FIRST_BITS, START_BITS, Unclear, sign, working
from .fate import as_double, scaled_double
from .one_orbit import TIE_BITS, BallCircle, BallOrbit, Orbit
from .result import Fate

if TYPE_CHECKING:
    from flint import arb

# --- Extremes
CERTAIN_BITS = 56  # the balls of the extremes are this much narrower than the component is large
# A root's ball in units of the height's over the slope: y is exact, so its height may be much narrower than
# its neighbours'.
WIDER = 4, 64, 4096
NEWTON_STEPS = 128  # of Newton's method, after which a bracket's ends count by their powers of two
MOST_BITS = 1 << 13  # a component that is still not settled is zero to this precision


def precise_extremes(orbit: Orbit, label: int):
    """(3, 2) array of one state with the given `Fate` label, in the scene's variables."""
    import numpy as np
    return np.array([[float(v if isinstance(v, float) else v.mid()) for v in pair]
                     for pair in extreme_balls(orbit, label)])


def extreme_balls(orbit: Orbit, label: int, certain: int = CERTAIN_BITS):
    """[(least, greatest)] of the three components as balls, 2^-certain of the component's size wide at most;
    floats (infinite) where unbounded."""
    if label == Fate.EQUILIBRIUM:
        with working(START_BITS) as numbers:
            return [(numbers.ball(v), numbers.ball(v)) for v in orbit.state]
    how = {Fate.SPIN_UP: _unbounded, Fate.SEPARATRIX: _asymptotic, Fate.BOUNDED: _bounded}[Fate(label)]

    def question(orbit):
        return _ranges(orbit, *how(orbit), certain)
    start = FIRST_BITS if certain <= CERTAIN_BITS else certain + START_BITS
    return orbit.settled(question, max(start, TIE_BITS) if label == Fate.SEPARATRIX else start)


def turning_points(orbit: BallOrbit):
    """Offsets of both turning points as balls; None for a torque-free rotation over all barriers."""
    ends = [turning_point(orbit, side) for side in (-1, 1)]
    return None if None in ends else ends


def turning_point(orbit, side, tie=False):
    """Offset of the turning point on one side (-1, +1); None where every barrier of a circle is lower.

    tie: the motion is on the separatrix, so that a barrier that cannot be distinguished from the energy is
    where it ends.
    """
    zero = orbit.energy * 0
    if orbit.energy.is_zero() and (orbit.force_here > 0) - (orbit.force_here < 0) == -side * orbit.flip:
        return zero  # at rest in this coordinate, pushed away from this side
    inner = zero
    for toward in _spots_towards(orbit, side):
        over = orbit.height(toward.y) - orbit.energy
        if tie and 0 in over:
            return toward.y
        if sign(over) >= 0:
            return solve(orbit, inner, toward.y)
        inner = toward.y
    outer = orbit.wall(inner, side)
    return None if outer is None else solve(orbit, inner, outer)


def _spots_towards(orbit: BallOrbit, side: int):
    """The equilibria on one side, nearest first."""
    ahead = [s for s in orbit.all_spots if (s.y > 0 if side > 0 else s.y < 0)]
    return ahead if side > 0 else ahead[::-1]


def solve(orbit: BallOrbit, inner: arb, outer: arb):
    """The offset between inner (potential below the energy) and outer (above) where they are equal, as a
    ball.

    Newton's method held in a bracket on the middles of the balls; the ball that is returned has a change of
    sign.
    """
    balls = orbit.numbers
    lo, hi = inner.mid(), outer.mid()
    side = 1 if hi > lo else -1
    y, last = (lo + hi).mid() / 2, None
    for step in range(4000):
        value = orbit.height(y) - orbit.energy
        if 0 in value:
            break
        if value < 0:
            lo = y
        else:
            hi = y
        slope = -orbit.force(y)
        new = (y - value / slope).mid() if 0 not in slope else None
        far = _between_scales(lo, hi, step - NEWTON_STEPS) if step >= NEWTON_STEPS else None
        if far is not None:
            new = far
        elif (new is None or not (lo < new < hi or hi < new < lo)
              or (last is not None and 2 * abs(new - y) > last)):
            new = ((lo + hi) / 2).mid()
        last = abs(new - y).mid()
        if new == y:
            break
        y = new.mid()
    slope = orbit.force(y)
    if 0 in slope:
        raise Unclear
    over = orbit.height(y) - orbit.energy
    if over.is_zero():
        return y  # the root itself: no width about it would have a height of both signs to show but its own
    reach = balls.upper(over) / balls.lower(slope)
    for times in WIDER:
        width = balls.upper(times * reach)
        below, above = orbit.height(y - side
                                    * width) - orbit.energy, orbit.height(y + side * width) - orbit.energy
        if below < 0 and above > 0:
            return balls.around(y, width)
    raise Unclear


def _between_scales(lo, hi, times):
    """A point of a bracket that many steps have not narrowed, where the root may be any number of powers of
    two nearer to zero than an end: next to a double root Newton's method gains one a step, as halving does.
    None where the ends are of one size."""
    if lo.is_zero() or hi.is_zero():
        return ((lo + hi) / (1 << (1 << min(times, 9)))).mid()
    within = (abs(lo).sqrt() * abs(hi).sqrt()).mid() * (1 if hi > 0 else -1)
    return (within if 2 * abs(lo) < abs(within) < abs(hi) / 2 or 2 * abs(hi) < abs(within) < abs(lo) / 2
            else None)


def _bounded(orbit: BallOrbit):
    ends = turning_points(orbit)
    return _round_the_circle(orbit) if ends is None else _between(orbit, *ends)


def _between(orbit: BallOrbit, left: arb, right: arb):
    """Offsets and rates that bound a motion between two turning points."""
    top = (2 * _fastest(orbit, left, right)).sqrt()
    return [left, right, *_tops_between(orbit, left, right), orbit.energy * 0], (-top, top)


def _asymptotic(orbit):
    """A motion on the separatrix: it tends to an equilibrium (or, without torque, along an invariant plane to
    a permanent rotation) straight away, or after one turn."""
    towards = sign(orbit.w) or (1 if orbit.force_here * orbit.flip > 0 else -1)
    ahead = _asymptote(orbit, towards)
    if ahead is not None:
        end, last = ahead
        low, high = sorted((orbit.energy * 0, end), key=lambda y: y.mid())
        slow, fast = orbit.energy.min(last), _fastest(orbit, low, high).max(last)
        for point in orbit.all_spots:
            if low < point.y and point.y < high:
                slow = slow.min(orbit.energy - orbit.height(point.y))
        rates = sorted((towards * (2 * slow).sqrt(), towards * (2 * fast).sqrt()), key=lambda w: w.mid())
        return [low, high, *_tops_between(orbit, low, high)], tuple(rates)
    turn = turning_point(orbit, towards, True)
    behind = _asymptote(orbit, -towards)
    if turn is None or behind is None:
        return _round_the_circle(orbit)
    end, last = behind
    low, high = sorted((turn, end), key=lambda y: y.mid())
    there = (2 * _fastest(orbit, *sorted((orbit.energy * 0, turn), key=lambda y: y.mid()))).sqrt()
    back = (2 * _fastest(orbit, low, high).max(last)).sqrt()
    # on the way to the turning point only what lies before it counts
    rates = (-back, there) if towards > 0 else (-there, back)
    return [low, high, *_tops_between(orbit, low, high), orbit.energy * 0], rates


def _asymptote(orbit: BallCircle, side: int):
    """(offset, W^2/2 there) of the equilibrium or plane's end that the motion would tend to on that side, or
    None."""
    zero = orbit.energy * 0
    for toward in _spots_towards(orbit, side):
        over = orbit.height(toward.y) - orbit.energy
        if 0 in over:
            return toward.y, zero
        if over > 0:
            return None
    return orbit.end_of_plane(side)


def _fastest(orbit: BallOrbit, low: arb, high: arb):
    """Largest W^2/2 between two offsets, the state's own included."""
    fastest = orbit.energy
    for point in orbit.all_spots:
        if not (point.y < low or point.y > high):
            fastest = fastest.max(orbit.energy - orbit.height(point.y))
    return fastest


def _tops_between(orbit, low, high):
    return [y for y in orbit.tops() if not (y < low or y > high)]


def _round_the_circle(orbit):
    """Torque-free rotation: the whole circle, one sign of W."""
    slow = fast = orbit.energy
    for point in orbit.spots:
        value = orbit.energy - orbit.height(point.y)
        slow, fast = slow.min(value), fast.max(value)
    turn = sign(orbit.w)
    return [orbit.energy * 0, *orbit.tops()], (turn * (2 * slow).sqrt(), turn * (2 * fast).sqrt())


def _unbounded(orbit):
    """Spin-up: all of the orbit's conic that it passes, and W from its least value to infinity."""
    zero = orbit.energy * 0
    if orbit.spins_purely:
        return [zero], (orbit.w, None)
    smallest, left = orbit.w, None
    if sign(orbit.w) < 0:
        left = turning_point(orbit, -1)
        # wells more than a turn behind are higher by the torque's tilt
        smallest = -(2 * _fastest(orbit, zero - 7 if left is None else left, zero)).sqrt()
    else:
        for point in orbit.spots:
            if point.y > 0:
                smallest = smallest.min((2 * (orbit.energy - orbit.height(point.y))).sqrt())
    return orbit.swept(left), (smallest, None)


def _ranges(orbit, offsets, rates, certain):
    """[(least, greatest)] per component; Unclear unless the balls are narrow against the component's size."""
    r, bits = orbit.r, orbit.numbers.bits
    out = [None] * 3
    pairs = [orbit.components(y) for y in offsets]
    for row, axis in enumerate((r.j, r.k)):
        out[axis] = _range([pair[row] for pair in pairs], certain, bits)
    low, high = _range([orbit.component_i(w) for w in rates if w is not None], certain, bits)
    if rates[1] is None:
        low, high = (low, float("inf")) if r.sense > 0 else (float("-inf"), high)
    out[r.axis] = low, high
    return out


def _range(values: Sequence[arb], certain: int, bits: int):
    """(least, largest) of balls."""
    low = high = values[0]
    for value in values[1:]:
        low, high = low.min(value), high.max(value)
    size, width = abs(low).mid().max(abs(high).mid()), low.rad().max(high.rad())
    # nor is a root of both signs a number
    if not width <= size * (size * 0 + 2) ** -certain and bits < max(MOST_BITS, 2 * certain):
        raise Unclear
    return low, high


# --- The extremes of one state's motion, without arrays
def extremes_of(orbit: Orbit, label: Fate, k: int = 0) -> tuple:
    """((least, greatest),) * 3 over t >= 0 in units 2^-k of the orbit's; +-inf where unbounded, NaN where
    larger than any double."""
    here = [as_double(Fraction(v) * Fraction(2) ** k) for v in orbit.state]
    if label == Fate.EQUILIBRIUM:
        return tuple((v, v) for v in here)
    balls = extreme_balls(orbit, label)
    # rounding must not exclude the state itself
    return tuple((min(scaled_double(low, k), v), max(scaled_double(high, k), v)) for (low, high),
                 v in zip(balls, here))
