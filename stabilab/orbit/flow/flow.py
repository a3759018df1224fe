"""The reduced motion of a state at any time.

An ordinary motion in plain doubles: one well inside its well, or well above every barrier, on a circle or a
hyperbola.

About the state itself, with y = theta - theta_0 and places (X, Z) on the conic, what the force does from a to
a + d is

    V(a) - V(a + d) = d [mu + (G X Z cos(d/2) + c Z + d_ X) sin(d/2)/(d/2)],   X, Z at a + d/2,

(cosh, sinh on a hyperbola): no energies are subtracted. The orbit is searched for its turning points by steps
that no zero of the kinetic energy W^2/2 can hide in, as |V''| is bounded. Where rounding could cost digits
(`LOST`) or the way there takes too many steps, `ordinary` gives None, and balls take over (`relief`).

The state of a motion with one degree of freedom at any time, at a cost that does not grow with the time.

A torque along a principal axis (or none) leaves a particle in a potential: what repeats is folded by its
period (`repeating_motion`), what spins up is summed over its turns in closed form (`spin_up_motion`). Nothing
is stepped.
"""
from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from ...errors import InputError
from ...physics.coefficients import effective
from ...physics.states import checked_states
from ..far_states import own
from ..one_orbit import Orbit
from ..period import period_of
from ..potential import slope_at
from ..reduction import reduce
from ..result import Fate
from .periodic import (
    DIP,
    ROTATION_SAMPLES,
    SAMPLES,
    TOO_FINE,
    Around,
    Between,
    ByPanels,
    BySeries,
    InOwnUnit,
    Resting,
    Rotation,
    by_samples,
    exponent,
    tabulated,
)
from .profile import TURN, Relief, relief
from .spin_up import POINTS, Panels, Passing, SpinUp, Turn, Turning, turning_offset

# terms of the force or the energy against what is left of them: roundings that count in the answer
LOST = 24.0
STEPS = 40  # of the search to one side
REACH = 0.5  # longest step on a hyperbola, over which its speed grows less than twofold
KANTOROVICH = 0.5  # of 1, below which Newton's method surely converges (Kantorovich's theorem)
SMALL = 1e-6  # Halley's step, against the way, that leaves its cube


class Constants:
    """The reduction of a scene as doubles, each rounded once from the exact constant."""

    def __init__(self, reduction):
        self.reduction, self.e, g = reduction, reduction.e, reduction.constants
        self.axes = reduction.axis, reduction.j, reduction.k
        self.mu, self.G, self.c, self.d = g["mu"], g["G"], g["c"], g["d"]
        self.sj, self.sk, self.s = g["sj"], g["sk"], float(reduction.s)
        self.jx, self.kz, self.n = g["flip"] * g["rx"], g["rz"], g["flip"] * g["n"]
        self.spin = 1 / self.n, self.s
        self.shift = abs(self.sj / self.jx) + abs(self.sk / self.kz)
        self.slopes = abs(self.c) + abs(self.d)


@lru_cache(maxsize=64)
def constants(scene):
    """(the scene's reduction or None, its `Constants` or None on a parabola)."""
    reduction = reduce(effective(scene))
    return reduction, Constants(reduction) if reduction is not None and reduction.geometry.centred else None


class Here:
    """The state's own place as the spot that its motion is told from: at, kinetic, share, energy, state as of
    `relief.Spot`."""

    at, kind = 0.0, 0
    __slots__ = "k", "x", "z", "w", "kinetic", "base", "size"

    def __init__(self, k: Constants, state):
        i, j, l = k.axes
        self.k, self.base = k, (state[j], state[l])
        self.x, self.z = (state[j] + k.sj) / k.jx, (state[l] + k.sk) / k.kz
        self.w = k.n * (state[i] + k.s)
        self.kinetic = 0.5 * self.w * self.w
        self.size = abs(self.x) + abs(self.z)

    def share(self, a, d, f):
        """(V(a) - V(a + d))/d."""
        k, half = self.k, 0.5 * d
        sine, cosine, x, z = self._midway(half, a + half, f)
        return k.mu + f.over(sine, half) * ((k.G * x * cosine + k.c) * z + k.d * x)

    def _midway(self, half, middle, f):
        """(sin, cos of half the way, or sinh and cosh; X, Z in the middle of it)."""
        raise NotImplementedError

    def _swing(self, y, f):
        """(sin y, cos y - 1), or (sinh y, cosh y - 1)."""
        raise NotImplementedError

    def energy(self, y, f):
        return self.kinetic + y * self.share(0.0, y, f)

    def state(self, y, w, f):
        k, out = self.k, [None] * 3
        s, b = self._swing(y, f)
        i, j, l = k.axes
        out[j] = self.base[0] + k.jx * (self.z * s + self.x * b)
        out[l] = self.base[1] + k.kz * (b * self.z - k.e * -s * self.x)
        out[i] = k.spin[0] * w - k.spin[1]
        return out

    # --- the way to the turning points
    def _look(self, y):
        """(kinetic energy, force, its slope, bound of that within `REACH`, size of the energy's terms) at
        offset y."""
        k, x0, z0 = self.k, self.x, self.z
        x, z, span, steep, bound, slope = self._bent(y)
        value = self.kinetic + k.mu * y + (x - x0) * (0.5 * k.G * (x + x0) + k.c) + k.e * k.d * (z - z0)
        terms = self.kinetic + k.mu * (1 + abs(y)) + steep * span
        return value, k.mu + (k.G * x + k.c) * z + k.d * x, slope, bound, terms

    def _bent(self, y):
        """(X, Z, their size, steepness of the potential, bound of the force's slope within `REACH`, that
        slope) at offset y."""
        raise NotImplementedError

    def turning(self, sense, reach=math.inf):
        """(offset of the first turning point on the side `sense`, slope of the kinetic energy there), or
        (`reach`, least kinetic energy seen on the way) where none comes before it, and the energy's terms;
        None where doubles may lose digits."""
        y, longest, least = 0.0, self.longest, math.inf
        for _ in range(STEPS):
            value, force, slope, bound, terms = self._look(sense * y)
            force *= sense
            if force < 0 and 2 * value * bound < KANTOROVICH * force * force:  # the zero is next
                return self._polished(sense, y, value, force, slope, terms)
            least = min(least, value)
            root = math.sqrt(force * force + 2 * bound * max(value, 0.0))
            y += min(2 * value / (root - force) if force < 0 else (root + force) / bound, longest)
            if y >= reach:
                return reach, least, terms
        return None

    def _polished(self, sense, y, value, force, slope, terms):
        """`turning` from a place so near that Halley's method (Newton's with the second derivative)
        converges."""
        for _ in range(STEPS):
            step = 2 * value * force / (2 * force * force - value * slope)
            y -= step
            if abs(step) <= SMALL * y or not step:
                return sense * y, force, terms
            value, force, slope, _, terms = self._look(sense * y)
            force *= sense
        return None


class OnCircle(Here):
    """A state on a circle."""

    longest, turn = math.inf, TURN

    def _midway(self, half, middle, f):
        s, c = f.sin(middle), f.cos(middle)
        return f.sin(half), f.cos(half), self.x * c + self.z * s, self.z * c - self.x * s

    def _swing(self, y, f):
        half = f.sin(0.5 * y)
        return f.sin(y), -2 * half * half

    def _bent(self, y):
        k, s, c = self.k, math.sin(y), math.cos(y)
        x, z, span = self.x * c + self.z * s, self.z * c - self.x * s, self.size
        steep = abs(k.G) * span + k.slopes
        return x, z, span, steep, steep * span, slope_at(k.G, k.c, k.d, -1, x, z)


class OnHyperbola(Here):
    """A state on a hyperbola."""

    longest, turn = REACH, math.inf

    def _midway(self, half, middle, f):
        s, c = f.sinh(middle), f.cosh(middle)
        return f.sinh(half), f.cosh(half), self.x * c + self.z * s, self.z * c + self.x * s

    def _swing(self, y, f):
        half = f.sinh(0.5 * y)
        return f.sinh(y), 2 * half * half

    def _bent(self, y):
        k, s, c = self.k, math.sinh(y), math.cosh(y)
        x, z, span = self.x * c + self.z * s, self.z * c + self.x * s, self.size * (abs(s) + c)
        near = 2 * (abs(x) + abs(z))
        steep = abs(k.G) * 0.5 * near + k.slopes  # what rounding of the place costs in energy
        return x, z, span, steep, (abs(k.G) * near + k.slopes) * near, slope_at(k.G, k.c, k.d, 1, x, z)


GEOMETRIES = {-1: OnCircle, 1: OnHyperbola}


def ordinary(k: Constants, state, nodes=None, backwards=False):
    """The motion from a state (three floats), as of `reduced_motion`; None where doubles may lose digits."""
    try:
        return _ordinary(k, state, nodes, backwards)
    except (ArithmeticError, InputError):  # beyond the range of doubles, or of panels for them
        return None


def _ordinary(k, state, nodes, backwards):
    here = GEOMETRIES[k.e](k, state)
    if not k.shift <= LOST * here.size or not here.size:
        return None
    ahead = here.turning(1, here.turn)
    if ahead is None:
        return None
    if ahead[0] == TURN:
        return _round(here, ahead, nodes, backwards)
    behind = here.turning(-1)
    if behind is None:
        return None
    (a, slope_a, terms_a), (b, slope_b, terms_b) = behind, ahead
    width = 0.5 * LOST * (b - a)
    if not (terms_a <= width * -slope_a and terms_b <= width * -slope_b):
        return None
    return by_samples(BySeries, Between(here, a, here, b), here.w, nodes, SAMPLES[:2])


def _round(here, ahead, nodes, backwards):
    """The motion of a state that nothing turns back within a turn ahead."""
    _, least, terms = ahead
    if not terms <= LOST * least:
        return None
    if here.k.mu and here.w > 0 and not backwards:
        return SpinUp.from_here(here, here.w, TURN * here.k.mu, nodes or POINTS)
    if not here.k.mu:
        return by_samples(Rotation, Around(here, math.copysign(1.0, here.w)), here.w, nodes,
                          ROTATION_SAMPLES[:2])
    return None


PERIODS_AGREE = 1e-10  # ten times what either is off by
MANY = 2000  # times that are worth a table
DIGITS = 1e-11  # rounding of the potential about an equilibrium beyond which doubles are not enough


def reduced_motion(scene, state, nodes: int | None = None, backwards: bool = False):
    """The motion from `state` (three numbers), a `repeating_motion.Motion`.

    nodes: samples a turn of the phase (repeating) or points a panel (spin-up); None: as many as it takes.
    backwards: times before 0 are wanted too. Raises InputError where the scene has no reduction, on a
    separatrix, for spin-up other than round a circle, and where doubles do not hold the answer.
    """
    if not (type(state) is tuple and len(state) == 3
            and all(type(v) is float and math.isfinite(v) for v in state)):
        state = checked_states(state).reshape(3).tolist()
    reduction, plain = constants(scene)
    if reduction is None:
        raise InputError("the scene has no reduction to one degree of freedom: its torque is off the "
                         "principal axes, or the "
                         "gyrostatic moment has a component along it; take method taylor")
    k = exponent(scene, state)
    motion = ordinary(plain, state, nodes, backwards) if plain and k is None else None
    if motion is None:
        orbit = Orbit(reduction, tuple(state))
        orbit = orbit if k is None else own(orbit, k)
        with np.errstate(all="ignore"):
            motion = _motion(relief(orbit), orbit.state, nodes, backwards)
        if motion.period != motion.period:
            raise InputError(TOO_FINE)
        if nodes is None and isinstance(motion, ByPanels) and not motion.sense:
            _refuse_another_period(motion, orbit)
        # its swing is below the doubles, its period is not
        if isinstance(motion, Resting) and orbit.settled(lambda one: one.force_here) != 0:
            motion.period = period_of(orbit, Fate.BOUNDED)
        motion = motion if k is None else InOwnUnit(motion, k)
    motion.axis, motion.spin = reduction.axis, plain.spin if plain else (1.0, float(reduction.s))
    return motion


def _refuse_another_period(motion, orbit):
    """InputError where the panels of a libration do not add up to its period, which is known by other means.
    """
    expected = period_of(orbit, Fate.BOUNDED)
    if not abs(motion.period - expected) <= PERIODS_AGREE * expected:
        raise InputError(TOO_FINE)


def _motion(ground: Relief, state, nodes, backwards):
    if ground.here.force == 0 and ground.w == 0:
        return Resting(state)
    if ground.turn and not any(s.kind > 0 and s.at > 0 and s.kinetic < 0 for s in ground.spots):
        _refuse_ties(ground, ground.spots)
        return SpinUp(ground, nodes or POINTS, backwards)
    if ground.closed and not any(s.kind > 0 and s.kinetic < 0 for s in ground.spots):
        _refuse_ties(ground, ground.spots)
        return _rotation(ground, nodes)
    return _libration(ground, nodes)


def _refuse_ties(ground, spots):
    """InputError where the energy is a hill's, or the relief is flatter than doubles tell."""
    if any(s.kind > 0 and s.kinetic == 0 for s in spots):
        raise InputError("the motion is on a separatrix: it tends to an equilibrium, and its reduced form "
                         "takes for ever; take "
                         "method taylor")
    if any(s.blur > DIGITS for s in spots):
        raise InputError(
            "about an equilibrium the reduced potential is flatter than doubles tell; take method taylor")


def axis_way(motion, times):
    """(states (n, 3), integral of the rate about the torque's axis since time 0 (n,), that axis) at times of
    any sign."""
    times = np.asarray(times, float)
    motion = tabulated(motion) if len(times) >= MANY else motion
    states, way = motion.follow(times)
    scale, shift = motion.spin
    return states, scale * way - shift * times, motion.axis


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
    _refuse_ties(ground, [s for s in (left, *inner, right) if s])
    start, a = _turn(left, inner[0], -1)
    end, b = _turn(right, inner[-1], 1)
    hills = [s for s in inner if s.kind > 0]
    if all(s.kinetic > DIP * inner[0].kinetic for s in hills):
        if (motion := by_samples(BySeries, Between(start, a, end, b), ground.w, nodes, SAMPLES)) is not None:
            return motion
    chain = [Turning(start, a, 1, inner[0].at - start.at),
             *(Passing(hill, hill.kinetic, inner[n - 1].at - hill.at, inner[n + 1].at - hill.at)
               for n, hill in enumerate(inner) if hill.kind > 0),
             Turning(end, b, -1, inner[-1].at - end.at)]
    number = sum(s.at < 0 for s in inner if s.kind < 0)  # the chain changes hands at the wells
    return _by_panels(chain, number, -chain[number].spot.at, ground.w, 0.0)


def _turn(hill, well, sense):
    """(spot, offset) of the turning point beyond a well on one side, told from whichever equilibrium is
    nearer in height."""
    reach = None if hill is None else abs(hill.at - well.at)
    near = hill if hill is not None and -hill.kinetic < well.kinetic else well
    offset = turning_offset(near, sense if near is well else -sense, reach)
    if offset is None:
        raise InputError(
            "the motion does not turn back: it spins up on an invariant plane; take method taylor")
    return near, offset


def _rotation(ground: Relief, nodes):
    spots = [s for s in ground.spots if s.kind]
    hills = [s for s in spots if s.kind > 0]
    sense = 1.0 if ground.w > 0 else -1.0
    if all(s.kinetic > DIP * max(s.kinetic for s in spots) for s in hills):
        path = Around(min(hills, key=lambda s: s.kinetic, default=ground.here), sense)
        if (motion := by_samples(Rotation, path, ground.w, nodes, ROTATION_SAMPLES)) is not None:
            return motion
    turn = Turn(ground)
    number, y = turn.where()
    return _by_panels([turn.passing(n) for n in range(len(turn.hills))], number % len(turn.hills), y,
                      ground.w, sense)


def _by_panels(chain, number, y, w, sense):
    panels = Panels(chain)
    start = panels.time_at(number, chain[number].x_of(y, w))
    motion = ByPanels(panels, start if sense or w >= 0 else -start, sense)
    motion.evaluations = panels.evaluations
    return motion
