"""Barriers and wells along the orbits of many states at once."""
from __future__ import annotations

from functools import lru_cache

import numpy as np

from ..numbers.constants import TURN
from .conic import Conic
from .potential import Hyperbolic, potential
from .reduction import reduce

ONE_STEP, MOST_STEPS = 3e-9, 8  # a Newton step as small leaves its square; from half a radian five are enough, but at a fold
LOST = 1e-3  # of the terms: a sum that is smaller than this share has lost more than three digits
CENTRE = 1e-10  # of the asymptotes' distance from a hyperbola's centre: nearer to it the conic's doubles place no equilibrium


def angle_between(place, spot):
    """theta from one place on a circle to another, the short way round: in [-pi, pi]."""
    return np.arctan2(spot[0] * place[1] - spot[1] * place[0], spot[0] * place[0] + spot[1] * place[1])


@lru_cache(maxsize=64)
def landscape(scene) -> Landscape | None:
    """The landscape of a scene's reduction (cached), or None where the scene has none."""
    reduction = reduce(scene)
    return None if reduction is None else Landscape(reduction)


class Landscape:
    """A reduction with its potential and its curve of equilibria.

    start(states) gives places (arrays), W and the size of rounding in the place; critical(place) the equilibria on
    each orbit: offsets theta_c - theta_0 (n, m), places (n, m) and which are barriers; missing ones have offset nan.
    """

    def __init__(self, reduction):
        self.reduction, self.e = reduction, reduction.e
        self.potential = potential(reduction)
        self.conic = Conic(reduction) if self.e else None
        self.sense = reduction.sense

    def start(self, states):
        """(place, W, size): place a pair of arrays, size a pair with the magnitudes whose rounding limits the place."""
        r = self.reduction
        if self.e == 0:
            place = states[..., r.j], states[..., r.k]
            return place, states[..., r.axis] + float(r.s), tuple(np.abs(v) for v in place)
        x, z, w = r.canonical(states)
        g = r.constants
        size = np.abs(x) + abs(g["sj"] / g["rx"]), np.abs(z) + abs(g["sk"] / g["rz"])
        return (self._circle if self.e < 0 else self._light_cone)(x, z, size[0] + size[1], states), w, size

    def _circle(self, x, z, size, states):
        """(X, Z): from exact arithmetic next to the circle's centre, where the shift leaves a few digits of the angle."""
        return self._exactly(np.hypot(x, z) < LOST * size, states, (x, z), lambda ex, ez: (ex, ez))

    def _light_cone(self, x, z, size, states):
        """(xi, eta) = (X + Z, X - Z) with full relative accuracy: from exact arithmetic near a plane or the centre."""
        xi, eta = x + z, x - z
        close = np.minimum(np.abs(xi), np.abs(eta)) < LOST * size
        return self._exactly(close, states, (xi, eta), lambda ex, ez: (ex + ez, ex - ez))

    def _exactly(self, close, states, place, of):
        """The place with the rows of `close` formed anew by `of` from exact (X, Z)."""
        if not close.any():
            return place
        first, second = (np.array(v) for v in place)
        for index in zip(*np.nonzero(close)):
            ex, ez, _ = self.reduction.canonical_exact(states[index])
            first[index], second[index] = map(float, of(ex, ez))
            if self.e > 0 and self.reduction.exact_invariant_sign(states[index]) == 0:
                # exactly on a plane: 240-bit roots may leave a remainder where there is none
                small = first if abs(first[index]) < abs(second[index]) else second
                small[index] = 0.0
        return first, second

    def invariant(self, place):
        """Q of each place; elliptic and hyperbolic."""
        return place[0] ** 2 + place[1] ** 2 if self.e < 0 else -place[0] * place[1]

    def components(self, place, w):
        """States (..., 3) at places with rate W."""
        r = self.reduction
        out = np.empty(np.shape(w) + (3,))
        if self.e == 0:
            out[..., r.j], out[..., r.k], out[..., r.axis] = place[0], place[1], w - float(r.s)
            return out
        x, z = place if self.e < 0 else (0.5 * (place[0] + place[1]), 0.5 * (place[0] - place[1]))
        out[..., r.j], out[..., r.k] = r.component_j(x), r.component_k(z)
        out[..., r.axis] = r.component_i(w)
        return out

    def critical(self, place, barriers_only=False):
        """Equilibria on the orbits of places (n,): (offsets (n, m), place (2, n, m), barrier (n, m) bool).

        Elliptic offsets lie in (0, 2 pi]; the same equilibrium recurs every turn.
        """
        if self.e == 0:
            return self._critical_parabolic(place)
        Q = self.invariant(place)
        hits = self.conic.critical_places(Q, True if barriers_only else None)
        n, m = Q.size, len(hits)
        offsets, places, barrier = np.full((n, m), np.nan), np.zeros((2, n, m)), np.zeros((n, m), bool)
        locate = self._locate_circle if self.e < 0 else self._locate_hyperbola
        for column, (x, z, exists, is_barrier) in enumerate(hits):
            offset, spot, exists = locate(place, Q, x, z, exists)
            offsets[:, column] = np.where(exists, offset, np.nan)
            places[:, :, column] = spot
            barrier[:, column] = (self.potential.slope(spot) > 0 if is_barrier is None else is_barrier) & exists
        return offsets, places, barrier

    def beside_centre(self, place):
        """(n,) True where an equilibrium may stand so near the centre of a place's hyperbola that the conic, which is known by its
        distance from its asymptotes, loses or invents it."""
        if self.e <= 0 or not self.conic.pieces:
            return np.zeros(np.shape(place[0]), bool)
        c, d, G = (abs(getattr(self.conic, name)) for name in ("c", "d", "G"))
        near = CENTRE * (c + d) / G  # the force of the wheel there is at most (c + d) times as much
        if not self.conic.mu <= (c + d) * near:
            return np.zeros(np.shape(place[0]), bool)
        return np.sqrt(np.abs(place[0])) * np.sqrt(np.abs(place[1])) <= near

    def _locate_circle(self, place, Q, x, z, exists):
        with np.errstate(all="ignore"):
            scale = np.sqrt(Q / (x * x + z * z))
            spot = np.where(exists, x * scale, place[0]), np.where(exists, z * scale, place[1])
            spot = self._polish(spot)
            offset = angle_between(place, spot)
        return np.where(offset > 0, offset, offset + TURN), spot, exists

    def _locate_hyperbola(self, place, Q, x, z, exists):
        xi, eta = x + z, x - z
        big = np.abs(xi) >= np.abs(eta)
        with np.errstate(all="ignore"):
            xi = np.where(big, xi, -Q / eta)
            eta = np.where(big, -Q / xi, eta)
            exists = exists & (np.sign(xi) == np.sign(place[0])) & (np.sign(eta) == np.sign(place[1]))  # both 0 on a plane
            spot = np.where(exists, xi, place[0]), np.where(exists, eta, place[1])
            spot = self._polish(spot)
            offset = np.where(big, np.log(spot[0] / place[0]), -np.log(spot[1] / place[1]))
        return offset, spot, exists

    def _polish(self, spot):
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

    def _critical_parabolic(self, place):
        force = self.potential.force(place)
        first, second, third = self.potential.derivatives(place)
        n = np.size(force)
        cubic = np.array(np.broadcast_arrays(third / 6, second / 2, first, force), float)
        if not np.any(cubic[0]):
            with np.errstate(all="ignore"):
                roots = np.where(cubic[2] != 0, -cubic[3] / cubic[2], np.nan)[:, None]
        else:
            companion = np.zeros((n, 3, 3))
            companion[:, 0, :] = -(cubic[1:] / cubic[0]).T
            companion[:, 1, 0] = companion[:, 2, 1] = 1
            eigen = np.linalg.eigvals(companion)
            real = np.abs(eigen.imag) <= 1e-7 * np.abs(eigen)
            real[np.arange(n), np.argmin(np.abs(eigen.imag), axis=1)] = True  # a cubic has a real root
            roots = np.where(real, eigen.real, np.nan)
            for _ in range(3):
                value = ((cubic[0][:, None] * roots + cubic[1][:, None]) * roots + cubic[2][:, None]) * roots + cubic[3][:, None]
                slope = (3 * cubic[0][:, None] * roots + 2 * cubic[1][:, None]) * roots + cubic[2][:, None]
                with np.errstate(all="ignore"):
                    step = value / slope
                roots = roots - np.where(np.isfinite(step) & (np.abs(step) <= 0.1 * np.abs(roots)), step, 0)
        spot = np.array(self.potential.move(tuple(v[:, None] for v in place), np.where(np.isnan(roots), 0.0, roots)))
        barrier = (self.potential.slope(tuple(spot)) > 0) & ~np.isnan(roots)
        return roots, spot, barrier

    @property
    def is_hyperbolic(self) -> bool:
        return isinstance(self.potential, Hyperbolic)
