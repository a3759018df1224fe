"""The reduced potential of many states at once: equilibria, barriers, wells; and their places to 30
digits.

Thirty digits are for circles and hyperbolas whose centre stands far off, where doubles lose what a small
motion depends on."""
from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..numbers.double_double import TURN, Twofold
from .barriers_arrays import Orbits, orbits_of
from .conic import Conic, conic_of
from .potential import potential
from .reduction import Reduction, reduce

if TYPE_CHECKING:
    from ..numbers.vectors import Number
    from ..physics.scene import AnyScene

# --- Places to 30 digits
SURE = 1e-20  # of the terms: a sum that is smaller may be zero, which exact arithmetic decides


class TwofoldCentre(NamedTuple):
    """The centre of a reduction's orbits, and the factors of its canonical variables, to 32 digits."""

    sj: Twofold
    sk: Twofold
    over_x: Twofold  # flip over rx
    over_z: Twofold


def twofold_centre(reduction: Reduction) -> TwofoldCentre:
    """That of a reduction to circles or hyperbolas."""
    g = reduction.exact_constants
    return TwofoldCentre(*map(twofold_constant, (g["sj"], g["sk"], g["flip"] / g["rx"], 1 / g["rz"])))


def twofold_constant(value: Fraction) -> Twofold:
    """A rational, or an exact root of many bits, to 32 digits."""
    high = float(value)
    # a double broadcasts as an array does
    return Twofold(np.float64(high), np.float64(float(value - Fraction(high))))  # type: ignore[arg-type]


# --- Barriers and wells along the orbits of many states at once: what the three geometries have in common,
# and circle and hyperbola
# a Newton step as small leaves its square; from half a radian five are enough, but at a fold
ONE_STEP, MOST_STEPS = 3e-9, 8
LOST = 1e-3  # of the terms: a sum that is smaller than this share has lost more than three digits


class Landscape:
    """A reduction with its potential and its curve of equilibria, on one of the three geometries.

    start(states) gives places (arrays), W and the size of rounding in the place. Places are (X, Z) on a
    circle, (X + Z, X - Z) on a hyperbola, (omega_j, omega_k) on a parabola.
    """

    conic: Conic | None = None
    base = "parabola"  # the curve that the two rates across the axis stay on
    unit = 1.0  # turn about the axis per theta, signed as the reflection
    turn = np.inf  # after so much theta an orbit comes to the same place again

    def __init__(self, reduction: Reduction):
        self.reduction, self.e = reduction, reduction.e
        self.potential = potential(reduction)
        self.sense = reduction.sense

    @property
    def may_rotate(self) -> bool:
        """Whether a motion may pass over all barriers and stay bounded."""
        return False

    @cached_property
    def orbits(self) -> Orbits:
        """What margins of many states are formed with."""
        return orbits_of(self.reduction)

    @cached_property
    def kernel_input(self):
        """(axes, high and low parts (10, 2) of the constants as `arc_kernel` names them, arc of a full circle
        or inf, what K changes by a radian of it)."""
        r = self.reduction
        exact = r.p, r.p0, r.q, r.q0, r.kappa, r.rho, r.sigma, r.m, r.p * r.q, r.s
        fine = np.array([(float(number), float(number - Fraction(float(number)))) for number in exact])
        return (r.j, r.k, r.axis), fine, self.turn * abs(self.unit), float(r.torque)

    def start(self, states: np.ndarray):
        """(place, W, size): place a pair of arrays, size a pair with the magnitudes whose rounding limits the
        place."""
        raise NotImplementedError

    def invariant(self, place: np.ndarray | Sequence[float | np.ndarray]):
        """Q of each place; of circles and hyperbolas."""
        raise NotImplementedError

    def components(self, place: np.ndarray | Sequence[float | np.ndarray], w: np.ndarray):
        """States (..., 3) at places with rate W."""
        r = self.reduction
        out = np.empty(np.shape(w) + (3,))
        out[..., r.j], out[..., r.k] = self.pair(place)
        out[..., r.axis] = self.rate(w)
        return out

    def pair(self, place: np.ndarray | Sequence[float | np.ndarray]):
        """(omega_j, omega_k) at places."""
        raise NotImplementedError

    def rate(self, w: Number):
        """omega_i of canonical W."""
        raise NotImplementedError

    def may_have_barriers(self) -> bool:
        """False where no orbit has a barrier."""
        return True

    def nearly_flat(self, states: np.ndarray):
        """(n,) True where the force along a parabola may not change at all; False on other reductions."""
        return np.zeros(len(states), bool)

    def polished(self, spot: Sequence[np.ndarray]):
        """Newton steps along the orbit: whatever the conic lost, the force regains. Most need one tiny step.
        """
        step = self._newton_step(spot)
        first, second = self.potential.move(spot, step)
        rows = np.nonzero(np.abs(step) >= ONE_STEP)
        for _ in range(MOST_STEPS if rows[0].size else 0):
            item = first[rows], second[rows]
            step = self._newton_step(item)
            first[rows], second[rows] = self.potential.move(item, step)
            rows = tuple(r[np.abs(step) >= ONE_STEP] for r in rows)
        return first, second

    def _newton_step(self, point: Sequence[np.ndarray]):
        with np.errstate(all="ignore"):
            step = -self.potential.force(point) / self.potential.slope(point)
            return np.where(np.abs(step) < 0.5, step, 0.0)  # false for nan too


class ConicLandscape(Landscape):
    """Circle or hyperbola: orbits of the canonical plane, and a conic of equilibria in it."""

    def __init__(self, reduction: Reduction):
        super().__init__(reduction)
        self.conic = conic_of(reduction)
        self.unit = reduction.constants["flip"] / reduction.constants["n"]

    def start(self, states: np.ndarray):
        g = self.reduction.constants
        x, z, w = self.reduction.canonical(states)
        size = np.abs(x) + abs(g["sj"] / g["rx"]), np.abs(z) + abs(g["sk"] / g["rz"])
        return self._exact_place(x, z, size[0] + size[1], states), w, size

    def _exact_place(self, x: float | np.ndarray, z: float | np.ndarray, size: float | np.ndarray,
                     states: np.ndarray):
        """The place of (X, Z), from exact arithmetic where the shift leaves a few digits of it."""
        raise NotImplementedError

    @cached_property
    def twofold(self) -> TwofoldCentre:
        """What a place is formed with in 32 digits."""
        return twofold_centre(self.reduction)

    def _exactly(self, close: np.ndarray, states: np.ndarray, location: Sequence[float | np.ndarray],
                 of: Callable[[Number, Number], tuple[Number, Number]]):
        """The place with the rows of `close` formed anew by `of` from (X, Z) to 30 digits; from exact ones
        where these may leave nothing."""
        if not close.any():
            return location
        first, second = (np.array(v) for v in location)
        some = states[close]
        k = self.twofold
        x = (k.sj + some[:, self.reduction.j]) * k.over_x
        z = (k.sk + some[:, self.reduction.k]) * k.over_z
        with np.errstate(all="ignore"):
            rows = [v.value() if isinstance(v, Twofold) else v for v in of(x, z)]
            sure = (np.minimum(*np.abs(rows)) > SURE
                    * (np.abs(some).sum(axis=1) + self.reduction.parabolic_shift_size) / self.least_scale)
        first[close], second[close] = rows
        indices = np.argwhere(close)
        for index in map(tuple, indices[~sure]):  # () where one state is asked for
            ex, ez, _ = self.reduction.canonical_exact(states[index])
            first[index], second[index] = map(float, of(ex, ez))
            self._settle_plane(first, second, index, states[index])
        return first, second

    @property
    def least_scale(self) -> float:
        """The least factor of a component over its canonical variable."""
        return min(abs(self.reduction.constants[name]) for name in ("rx", "rz"))

    def _settle_plane(self, first: np.ndarray, second: np.ndarray, index: Sequence[int], state: np.ndarray):
        """What is exactly on an invariant plane gets exactly there."""

    def pair(self, place: np.ndarray | Sequence[float | np.ndarray]):
        x, z = self.potential.xz(place)
        return self.reduction.component_j(x), self.reduction.component_k(z)

    def rate(self, w: Number):
        return self.reduction.component_i(w)

    def way(self, spot: Sequence[np.ndarray], place: Sequence[np.ndarray], near: np.ndarray):
        """theta from a place to another on its orbit, which is rounded; on a circle the turn is that of
        `near`."""
        raise NotImplementedError

    def blurred(self, spot: Sequence[np.ndarray], place: Sequence[np.ndarray], size: Sequence[np.ndarray]):
        """(what rounding of a place, of that size of terms, may cost in energy besides; how far, of its size,
        it lies off the orbit of a spot)."""
        return 0.0, 0.0

    def may_have_barriers(self) -> bool:
        return any(p.barrier for p in self.conic.pieces) or bool(self.conic.lines)


# --- The same on circles, hyperbolas and parabolas, one class each
def angle_between(index: Sequence[np.ndarray], point: Sequence[np.ndarray] | np.ndarray):
    """theta from one place on a circle to another, the short way round: in [-pi, pi]."""
    return np.arctan2(point[0] * index[1] - point[1] * index[0], point[0] * index[0] + point[1] * index[1])


class CircleLandscape(ConicLandscape):
    """place = (X, Z)."""

    base = "circle"
    turn = TURN

    @property
    def may_rotate(self) -> bool:  # type: ignore[override]  # a constant of the other geometries
        """Without a torque a motion over all barriers goes round for ever."""
        return self.sense == 0

    def _exact_place(self, x: float | np.ndarray, z: float | np.ndarray, size: float | np.ndarray,
                     states: np.ndarray):
        # of squares: numpy.hypot takes as long as ninety products
        close = np.asarray(x * x + z * z < (LOST * size)**2)
        return self._exactly(close, states, (x, z), lambda ex, ez: (ex, ez))

    def invariant(self, place: np.ndarray | Sequence[float | np.ndarray]):
        return place[0] ** 2 + place[1] ** 2

    def way(self, spot: Sequence[np.ndarray], place: Sequence[np.ndarray], near: np.ndarray):
        angle = angle_between(spot, place)
        return angle + TURN * np.round((near - angle) / TURN)


class HyperbolaLandscape(ConicLandscape):
    """place = (xi, eta) = (X + Z, X - Z)."""

    base = "hyperbola"

    def _exact_place(self, x: float | np.ndarray, z: float | np.ndarray, size: float | np.ndarray,
                     states: np.ndarray):
        xi, eta = x + z, x - z
        close = np.minimum(np.abs(xi), np.abs(eta)) < LOST * size
        return self._exactly(close, states, (xi, eta), lambda ex, ez: (ex + ez, ex - ez))

    def _settle_plane(self, first, second, index, state):
        # 240-bit roots may leave a remainder where there is none
        if self.reduction.exact_invariant_sign(state) == 0:
            small = first if abs(first[index]) < abs(second[index]) else second
            small[index] = 0.0

    def invariant(self, place: np.ndarray | Sequence[float | np.ndarray]):
        return -place[0] * place[1]

    def way(self, spot: Sequence[np.ndarray], place: Sequence[np.ndarray], near: np.ndarray):
        big = np.abs(place[0]) >= np.abs(place[1])
        return np.where(big, np.log(np.abs(place[0] / spot[0])), -np.log(np.abs(place[1] / spot[1])))

    def blurred(self, spot: Sequence[np.ndarray], place: Sequence[np.ndarray], size: Sequence[np.ndarray]):
        wide, largest = size[0] + size[1], np.maximum(np.abs(place[0]), np.abs(place[1]))
        beside = (np.abs(place[0] * place[1] - spot[0] * spot[1])
                  / ((np.abs(place[0]) + np.abs(place[1])) * wide))
        # the tilt falls by mu times the logarithm of the place
        return self.potential.mu * wide / largest, beside


class ParabolaLandscape(Landscape):
    """place = (omega_j, omega_k)."""

    def start(self, states: np.ndarray):
        r = self.reduction
        location = states[..., r.j], states[..., r.k]
        return location, states[..., r.axis] + float(r.s), tuple(np.abs(v) for v in location)

    def pair(self, place: np.ndarray | Sequence[float | np.ndarray]):
        return place

    def rate(self, w: Number):
        return w - float(self.reduction.s)

    def nearly_flat(self, states: np.ndarray):
        r = self.reduction
        # the third derivative is the same on all orbits
        if not self.sense or r.kappa * (r.q * r.p0 * r.p0 + r.p * r.q0 * r.q0):
            return super().nearly_flat(states)
        place = self.start(states)[0]
        # far above rounding: exact arithmetic decides
        return np.abs(self.potential.slope(place)) <= 1e-9 * self.potential.derivative_terms(place)[0]


GEOMETRIES = {-1: CircleLandscape, 1: HyperbolaLandscape, 0: ParabolaLandscape}


@lru_cache(maxsize=64)
def in_doubles(scene: AnyScene) -> bool:
    """Whether the constants of a scene's landscape, and their squares, are doubles; they are not where wheel
    and torque are hundreds of decades apart. Arrays of such a scene are answered one motion at a time."""
    try:
        land = landscape(scene)
    except OverflowError:
        return False
    if land is None or land.conic is None:
        return True
    conic = land.conic
    lines = conic.lines if conic.limit is None else (*conic.lines, conic.limit)
    return all(v * v < math.inf for v in (conic.K, conic.shift, *itertools.chain(*lines)))


def landscape_in_doubles(scene: AnyScene) -> Landscape | None:
    """`landscape`; raises OverflowError where `in_doubles` says no."""
    if not in_doubles(scene):
        raise OverflowError
    return landscape(scene)


@lru_cache(maxsize=64)
def landscape(scene: AnyScene) -> Landscape | None:
    """The landscape of a scene's reduction (cached), or None where the scene has none."""
    reduction = reduce(scene)
    return None if reduction is None else GEOMETRIES[reduction.e](reduction)
