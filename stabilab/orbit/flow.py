"""The state of a motion with one degree of freedom at any time, at a cost that does not grow with the time.

A torque along a principal axis (or none) leaves a particle in a potential: what repeats is folded by its
period (`profile`), what spins up is summed over its turns in closed form (`spin_up`). Nothing is stepped."""
from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..errors import InputError
from ..physics.coefficients import effective
from ..physics.own_unit import far_exponent
from ..physics.states import checked_states
from .one_orbit import Orbit
from .one_state import own
from .period import precise_period
from .profile import TOO_FINE, ByPanels, InOwnUnit, Motion, Relief, Resting, Spot, relief
from .reduction import reduce
from .result import Fate
from .spin_up import NODES, Panels, Passing, SpinUp, Turn, Turning, turning_offset

PERIODS_AGREE = 1e-10  # ten times what either is off by
ROUNDING_LIMIT = 1e-11  # rounding of the potential about an equilibrium beyond which doubles are not enough


def reduced_motion(scene, state, nodes: int | None = None, backwards: bool = False):
    """The motion from `state` (three numbers), a `profile.Motion`.

    nodes: points a panel; None: as many as it takes.
    backwards: times before 0 are wanted too. Raises InputError where the scene has no reduction, on a
    separatrix, for spin-up other than round a circle, and where doubles do not hold the answer.
    """
    if not (type(state) is tuple and len(state) == 3
            and all(type(v) is float and math.isfinite(v) for v in state)):
        state = checked_states(state).reshape(3).tolist()
    scene = effective(scene)
    reduction = reduce(scene)
    if reduction is None:
        raise InputError("the scene has no reduction to one degree of freedom: its torque is off the "
                         "principal axes, or the gyrostatic moment has a component along it; take method "
                         "taylor")
    k = far_exponent(scene, state)
    orbit = Orbit(reduction, tuple(state))
    orbit = orbit if k is None else own(orbit, k)
    with np.errstate(all="ignore"):
        motion = _motion(relief(orbit), orbit.state, nodes, backwards)
    if motion.period != motion.period:
        raise InputError(TOO_FINE)
    if nodes is None and isinstance(motion, ByPanels) and not motion.sense:
        _refuse_another_period(motion, orbit)
    # its swing is below the doubles, its period is not
    if isinstance(motion, Resting) and orbit.settled(lambda item: item.force_here) != 0:
        motion.period = precise_period(orbit, Fate.BOUNDED)
    motion = motion if k is None else InOwnUnit(motion, k)
    scale = (1 / (reduction.constants["flip"] * reduction.constants["n"]) if reduction.geometry.centred
             else 1.0)
    motion.axis, motion.spin = reduction.axis, (scale, float(reduction.s))
    return motion


def _refuse_another_period(motion: ByPanels, orbit: Orbit):
    """InputError where the panels of a libration do not add up to its period, which is known by other means.
    """
    expected = precise_period(orbit, Fate.BOUNDED)
    if not abs(motion.period - expected) <= PERIODS_AGREE * expected:
        raise InputError(TOO_FINE)


def _motion(ground: Relief, state, nodes, backwards):
    if ground.here.force == 0 and ground.w == 0:
        return Resting(state)
    if ground.turn and not any(s.kind > 0 and s.at > 0 and s.kinetic < 0 for s in ground.spots):
        _refuse_ties(ground.spots)
        return SpinUp(ground, nodes or NODES, backwards)
    if ground.closed and not any(s.kind > 0 and s.kinetic < 0 for s in ground.spots):
        _refuse_ties(ground.spots)
        return _rotation(ground, nodes)
    return _libration(ground, nodes)


def _refuse_ties(spots: Sequence[Spot]):
    """InputError where the energy is a hill's, or the relief is flatter than doubles tell."""
    if any(s.kind > 0 and s.kinetic == 0 for s in spots):
        raise InputError("the motion is on a separatrix: it tends to an equilibrium, and its reduced form "
                         "takes for ever; take "
                         "method taylor")
    if any(s.blur > ROUNDING_LIMIT for s in spots):
        raise InputError(
            "about an equilibrium the reduced potential is flatter than doubles tell; take method taylor")


def axis_way(motion: Motion, times: np.ndarray):
    """(states (n, 3), integral of the rate about the torque's axis since time 0 (n,), that axis) at times of
    any sign."""
    times = np.asarray(times, float)
    states, route = motion.follow(times)
    scale, shift = motion.spin
    return states, scale * route - shift * times, motion.axis


def _libration(ground: Relief, nodes):
    spots = [s for s in ground.spots if s.kind]
    left = max((n for n, s in enumerate(spots) if s.kind > 0 and s.kinetic <= 0 and s.at < 0), default=None)
    right = min((n for n, s in enumerate(spots) if s.kind > 0 and s.kinetic <= 0 and s.at > 0), default=None)
    inner = spots[0 if left is None else left + 1:right]
    if not inner or inner[0].kind > 0 or inner[-1].kind > 0:
        raise InputError("the motion does not repeat: no well holds it (spin-up on an invariant plane, or "
                         "about the axis "
                         "itself); take method taylor")
    left, right = (None if n is None else spots[n] for n in (left, right))
    _refuse_ties([s for s in (left, *inner, right) if s])
    start, a = _turn(left, inner[0], -1)
    end, b = _turn(right, inner[-1], 1)
    chain = [Turning(start, a, 1, inner[0].at - start.at),
             *(Passing(hill, hill.kinetic, inner[n - 1].at - hill.at, inner[n + 1].at - hill.at)
               for n, hill in enumerate(inner) if hill.kind > 0),
             Turning(end, b, -1, inner[-1].at - end.at)]
    number = sum(s.at < 0 for s in inner if s.kind < 0)  # the chain changes hands at the wells
    return _by_panels(chain, nodes, number, -chain[number].spot.at, ground.w, 0.0)


def _turn(hill: Spot | None, well: Spot, sense: int):
    """(spot, offset) of the turning point beyond a well on one side, measured from whichever equilibrium is
    nearer in height."""
    reach = None if hill is None else abs(hill.at - well.at)
    nearby = hill if hill is not None and -hill.kinetic < well.kinetic else well
    offset = turning_offset(nearby, sense if nearby is well else -sense, reach)
    if offset is None:
        raise InputError(
            "the motion does not turn back: it spins up on an invariant plane; take method taylor")
    return nearby, offset


def _rotation(ground: Relief, nodes: int | None):
    sense = 1.0 if ground.w > 0 else -1.0
    turn = Turn(ground)
    number, y = turn.where()
    return _by_panels([turn.passing(n) for n in range(len(turn.hills))], nodes, number % len(turn.hills), y,
                      ground.w, sense)


def _by_panels(chain, nodes, number, y, w, sense):
    panels = Panels(chain, nodes or NODES)
    start = panels.time_at(number, chain[number].x_of(y, w))
    motion = ByPanels(panels, start if sense or w >= 0 else -start, sense)
    motion.evaluations = panels.evaluations
    return motion
