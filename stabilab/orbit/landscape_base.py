"""Barriers and wells along the orbits of many states at once: what the three geometries have in common, and circle and hyperbola."""
from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..numbers.double_double import Twofold
from .conic import Conic, conic_of
from .fine.places import SURE, TwofoldConstants, twofold_constants, twofold_places
from .potential import potential

EPS = 2.0**-52
ONE_STEP, MOST_STEPS = 3e-9, 8  # a Newton step as small leaves its square; from half a radian five are enough, but at a fold
LOST = 1e-3  # of the terms: a sum that is smaller than this share has lost more than three digits


class Landscape:
    """A reduction with its potential and its curve of equilibria, on one of the three geometries.

    start(states) gives places (arrays), W and the size of rounding in the place; critical(place) the equilibria on
    each orbit: offsets theta_c - theta_0 (n, m), places (n, m) and which are barriers; missing ones have offset nan.
    Places are (X, Z) on a circle, (X + Z, X - Z) on a hyperbola, (omega_j, omega_k) on a parabola.
    """

    conic: Conic | None = None
    base = "parabola"  # the curve that the two rates across the axis stay on
    unit = 1.0  # turn about the axis per theta, signed as the reflection
    turn = np.inf  # after so much theta an orbit comes to the same place again

    def __init__(self, reduction):
        self.reduction, self.e = reduction, reduction.e
        self.potential = potential(reduction)
        self.sense = reduction.sense

    @property
    def may_rotate(self) -> bool:
        """Whether a motion may pass over all barriers and stay bounded."""
        return False

    def start(self, states):
        """(place, W, size): place a pair of arrays, size a pair with the magnitudes whose rounding limits the place."""
        raise NotImplementedError

    def critical(self, place, barriers_only=False):
        """Equilibria on the orbits of places (n,): (offsets (n, m), place (2, n, m), barrier (n, m) bool).

        Offsets on a circle lie in (0, 2 pi]; the same equilibrium recurs every turn.
        """
        raise NotImplementedError

    def invariant(self, place):
        """Q of each place; of circles and hyperbolas."""
        raise NotImplementedError

    def components(self, place, w):
        """States (..., 3) at places with rate W."""
        r = self.reduction
        out = np.empty(np.shape(w) + (3,))
        out[..., r.j], out[..., r.k] = self.pair(place)
        out[..., r.axis] = self.rate(w)
        return out

    def pair(self, place):
        """(omega_j, omega_k) at places."""
        raise NotImplementedError

    def rate(self, w):
        """omega_i of canonical W."""
        raise NotImplementedError

    def xz(self, place):
        """The two coordinates at places whose ranges are those of the components."""
        return place

    def energy_terms(self, place, w):
        """(n,) size of the energy's terms, canonical."""
        raise NotImplementedError

    def unrolled(self, place, offset, spot):
        """Offsets of equilibria as near to the state as a turn allows; (n, m)."""
        return offset

    def repeated(self, offset, spot, energy, barrier):
        """Equilibria along the orbit, on a circle those of one turn behind and of one ahead."""
        return offset, spot, energy, barrier

    def may_have_barriers(self) -> bool:
        """False where no orbit has a barrier."""
        return True

    def nearly_flat(self, states, place=None):
        """(n,) True where the force along a parabola may not change at all; False on other reductions."""
        return np.zeros(len(states), bool)

    def beside_centre(self, place):
        """(n,) True where the doubles do not hold the orbit's own size."""
        return np.zeros(np.shape(place[0]), bool)

    def polished(self, spot):
        """Newton steps along the orbit: whatever the conic lost, the force regains. Most need one tiny step."""
        first, second = spot
        step = self._newton_step(spot)
        first, second = self.potential.nudge(spot, np.where(np.abs(step) < ONE_STEP, step, 0.0))
        far = np.abs(step) >= ONE_STEP
        if far.any():
            one = tuple(v[far] for v in spot)
            for _ in range(MOST_STEPS):
                step = self._newton_step(one)
                one = self.potential.move(one, step)
                if (np.abs(step) < ONE_STEP).all():
                    break
            first[far], second[far] = one
        return first, second

    def _newton_step(self, spot):
        with np.errstate(all="ignore"):
            step = -self.potential.force(spot) / self.potential.slope(spot)
            return np.where(np.abs(step) < 0.5, step, 0.0)  # false for nan too


@dataclass(frozen=True)
class Spots:
    """Equilibria along the orbit, ascending in offset (n, m): places (2, n, m), energy above each (n, m) =
    E - V(spot), barrier or well; `there` marks the real ones (the rest are padding at +inf)."""

    offset: np.ndarray
    place: np.ndarray
    energy: np.ndarray
    barrier: np.ndarray
    there: np.ndarray


def spots_along(land: Landscape, place, w) -> Spots:
    """All equilibria near the state along its orbit, on a circle those of one turn behind and one ahead."""
    offset, spot, barrier = land.critical(place)
    energy = np.full(offset.shape, np.nan)
    kinetic = 0.5 * w * w
    with np.errstate(all="ignore"):
        offset = land.unrolled(place, offset, spot)
        for column in range(offset.shape[1]):
            energy[:, column] = kinetic + land.potential.rise(-offset[:, column], spot[:, :, column])
        offset, spot, energy, barrier = land.repeated(offset, spot, energy, barrier)
    order = np.argsort(np.where(np.isnan(offset), np.inf, offset), axis=1, kind="stable")
    take = lambda a: np.take_along_axis(a, order, axis=1)
    offset = take(offset)
    there = ~np.isnan(offset)
    return Spots(np.where(there, offset, np.inf), np.stack([take(spot[0]), take(spot[1])]), take(energy),
                 take(barrier) & there, there)


class ConicLandscape(Landscape):
    """Circle or hyperbola: orbits of the canonical plane, and a conic of equilibria in it."""

    def __init__(self, reduction):
        super().__init__(reduction)
        self.conic = conic_of(reduction)
        self.unit = reduction.constants["flip"] / reduction.constants["n"]

    def start(self, states):
        g = self.reduction.constants
        x, z, w = self.reduction.canonical(states)
        size = np.abs(x) + abs(g["sj"] / g["rx"]), np.abs(z) + abs(g["sk"] / g["rz"])
        return self._exact_place(x, z, size[0] + size[1], states), w, size

    def _exact_place(self, x, z, size, states):
        """The place of (X, Z), from exact arithmetic where the shift leaves a few digits of it."""
        raise NotImplementedError

    @cached_property
    def twofold(self) -> TwofoldConstants:
        """The constants in 32 digits."""
        return twofold_constants(self.reduction)

    def _exactly(self, close, states, place, of):
        """The place with the rows of `close` formed anew by `of` from (X, Z) to 30 digits; from exact ones where these may leave nothing."""
        if not close.any():
            return place
        first, second = (np.array(v) for v in place)
        some = states[close]
        x, z = twofold_places(self.twofold, self.reduction.j, self.reduction.k, some)
        with np.errstate(all="ignore"):
            found = [v.value() if isinstance(v, Twofold) else v for v in of(x, z)]
            sure = np.minimum(*np.abs(found)) > SURE * (np.abs(some).sum(axis=1) + self.reduction.parabolic_shift_size) / self.least_scale
        first[close], second[close] = found
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

    def _settle_plane(self, first, second, index, state):
        """What is exactly on an invariant plane gets exactly there."""

    def pair(self, place):
        x, z = self.xz(place)
        return self.reduction.component_j(x), self.reduction.component_k(z)

    def rate(self, w):
        return self.reduction.component_i(w)

    def critical(self, place, barriers_only=False):
        Q = self.invariant(place)
        hits = self.conic.critical_places(Q, True if barriers_only else None)
        n, m = Q.size, len(hits)
        offsets, places, barrier = np.full((n, m), np.nan), np.zeros((2, n, m)), np.zeros((n, m), bool)
        for column, (x, z, exists, is_barrier) in enumerate(hits):
            offset, spot, exists = self.located(place, Q, x, z, exists)
            offsets[:, column] = np.where(exists, offset, np.nan)
            places[:, :, column] = spot
            barrier[:, column] = (self.potential.slope(spot) > 0 if is_barrier is None else is_barrier) & exists
        return offsets, places, barrier

    def located(self, place, Q, x, z, exists):
        """(offset, place, exists) of equilibria at (X, Z) on the orbits Q of places."""
        raise NotImplementedError

    def way(self, spot, place, near):
        """theta from a place to another on its orbit, which is rounded; on a circle the turn is that of `near`."""
        raise NotImplementedError

    def blurred(self, spot, place, size):
        """(what rounding of a place, of that size of terms, may cost in energy besides; how far, of its size, it lies off the orbit of a spot)."""
        return 0.0, 0.0

    def may_have_barriers(self) -> bool:
        return any(p.barrier for p in self.conic.pieces) or bool(self.conic.lines)

    def energy_terms(self, place, w):
        pot, size = self.potential, np.hypot(*place)
        return 0.5 * w * w + abs(pot.mu) + np.abs(pot.G) * size**2 + pot.slopes * size
