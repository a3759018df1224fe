"""The period of one state in doubles: the integral of dtheta/W, with the energy's differences formed as
products.

A libration goes from y = l to y = r; with y = middle - half cos(phi) the roots at both ends cancel, the
integrand is analytic and periodic in phi, and the midpoint rule converges geometrically. E - V is the rise of
the potential from the nearer turning point, so it keeps its digits there. Where doubles cannot be sure (next
to a separatrix, minute orbits) or the rule is slow, `precise_period` answers in many digits.
"""
from __future__ import annotations

import math

from ...numbers.balls import FIRST_BITS, Unclear
from ...numbers.roots import EPS
from ..extremes.balls import turning_points
from ..one_orbit import Orbit
from ..potential import potential
from ..result import Fate, without_return
from .balls import power_of_error, precise_period

NODES = (4, 8, 16, 32, 64, 128, 256, 512)
AGREE = 1e-11  # two rules agree to this: the error of a geometric rule is squared by doubling its nodes
# power of ten of the error by the rate of three changes, for two rules may agree by chance; a change that is
# but rounding
LEFT, FLOOR = -13.0, 4e-15
# change of the force over the rounding of an end, as far as it tells on the period: next to a barrier it is
# the energy's
ENDS = 1e-11
SHARP = 1e-11  # relative error that rounding may leave in E - V, as for the periods of arrays


def period_of(orbit: Orbit, label: Fate) -> float:
    """Period of one state with this label, in the scene's time: inf where the motion does not repeat, 0 at
    rest, NaN where it is undecided."""
    if label != Fate.BOUNDED:
        return without_return(label)

    def question(orbit):
        ends = turning_points(orbit)
        return _rotation(orbit) if ends is None else _libration(orbit, *ends)
    try:
        return orbit.settled(question, FIRST_BITS, FIRST_BITS)
    except (Unclear, ArithmeticError):  # the integrand is formed in doubles
        return precise_period(orbit, label)


def _libration(orbit, left, right) -> float:
    pot = potential(orbit.r)
    half = 0.5 * float(right - left)
    for spot in orbit.all_spots:
        if spot.y > left and spot.y < right:
            _demand_sharp(orbit, spot)
    ends = [orbit.doubles_at(y) for y in (left, right)]
    forces = [pot.force(place) for place in ends]
    if any(8 * EPS * pot.terms(place) > SHARP * abs(force) for place, force in zip(ends, forces)):
        raise Unclear

    def kinetic(y, side):
        """E - V at y from the left end (side 0), or at -y from the right."""
        value = -pot.rise(-y if side else y, ends[side], forces[side])
        if not value > 0:
            raise Unclear
        return value
    one, other = kinetic(half, 0), kinetic(half, 1)
    if abs(one - other) > SHARP * one:
        raise Unclear
    for end, place, force in zip((left, right), ends, forces):
        # 0 in a parabolic well, whose period does not hang on its ends
        bent = min(1.0, abs(2 * one / (abs(force) * half) - 1))
        if bent * float(end.rad()) * abs(pot.slope(place)) > ENDS * abs(force):
            raise Unclear

    def integrand(phi):
        side = phi > 0.5 * math.pi
        y = 2 * half * (math.cos(0.5 * phi) if side else math.sin(0.5 * phi)) ** 2
        return half * math.sin(phi) / math.sqrt(2 * kinetic(y, side))
    return 2 * _midpoint(integrand, math.pi)


def _rotation(orbit) -> float:
    """Once round the circle without torque."""
    pot, place, energy = potential(orbit.r), orbit.doubles_at(orbit.energy * 0), float(orbit.energy)
    force = pot.force(place)
    for spot in orbit.spots:
        _demand_sharp(orbit, spot)

    def integrand(y):
        kinetic = energy - pot.rise(y, place, force)
        if not kinetic > 0:
            raise Unclear
        return 1 / math.sqrt(2 * kinetic)
    return _midpoint(integrand, 2 * math.pi)


def _demand_sharp(orbit, spot):
    kinetic = orbit.energy - orbit.height(spot.y)
    if not kinetic.rad() < SHARP * kinetic:
        raise Unclear


def _midpoint(integrand, length) -> float:
    before, changes = None, []
    for n in NODES:
        step = length / n
        now = step * math.fsum(integrand((k + 0.5) * step) for k in range(n))
        if before is not None:
            change = abs(now - before) / abs(now)
            changes.append(math.log10(change + FLOOR))
            if n > NODES[2] and change <= AGREE and power_of_error(*changes[-3:]) <= LEFT:
                return now
        before = now
    raise Unclear
