"""Barriers and wells along the orbits of many states at once, on circles, hyperbolas and parabolas."""
from __future__ import annotations

import itertools
import math
from functools import lru_cache

import numpy as np

from ..numbers.constants import TURN
from .landscape_base import EPS, LOST, ConicLandscape, Landscape
from .reduction import reduce

DOUBLE_ROOT = 1e-10  # share of a cubic's discriminant: two roots 1e-7 apart, hardly told in doubles, leave 1e-14 of it and more
ROUNDINGS = 64  # units of rounding allowed for in the error bound of a margin: some thirty operations, each counted twice
CENTRE = 1e-10  # of the asymptotes' distance from a hyperbola's centre: nearer to it the conic's doubles place no equilibrium


def angle_between(place, spot):
    """theta from one place on a circle to another, the short way round: in [-pi, pi]."""
    return np.arctan2(spot[0] * place[1] - spot[1] * place[0], spot[0] * place[0] + spot[1] * place[1])


def _discriminant(a, b, c, d):
    """The terms of the discriminant of a cubic, highest power first."""
    return 18 * a * b * c * d, -4 * b**3 * d, b**2 * c**2, -4 * a * c**3, -27 * a**2 * d**2


def _real_roots(a, b, c, d):
    """(n, 3) the real roots of cubics, to the rounding of their coefficients: three, or one and NaN. Those that a cosine gives, or Cardano's formula
    in the order that does not cancel; eigenvalues of companion matrices would cost ten times as much."""
    with np.errstate(all="ignore"):
        middle = -b / (3 * a)
        p, q = (c + b * middle) / a, (d + middle * (c + 2 * b * middle / 3)) / a
        three = 4 * p**3 + 27 * q * q < 0
        reach = np.sqrt(-p / 3)
        third = np.arccos(np.clip(-q / (2 * reach**3), -1, 1)) / 3
        roots = np.array([2 * reach * np.cos(third - k * TURN / 3) for k in range(3)])
        one = -np.copysign(np.cbrt(0.5 * np.abs(q) + np.sqrt(np.maximum(0.25 * q * q + p**3 / 27, 0))), q)
        other = np.where(one == 0, 0.0, -p / (3 * one))
        alone = np.where(p > 0, -q / (one * one + p / 3 + other * other), one + other)  # where p > 0 the sum would cancel
        lone = np.array([np.where((p == 0) & (q == 0), 0.0, alone), *np.full((2, *alone.shape), np.nan)])
        return (middle + np.where(three, roots, lone)).T


class CircleLandscape(ConicLandscape):
    """place = (X, Z)."""

    base = "circle"
    turn = TURN

    @property
    def may_rotate(self) -> bool:  # type: ignore[override]  # a constant of the other geometries
        """Without a torque a motion over all barriers goes round for ever."""
        return self.sense == 0

    def _exact_place(self, x, z, size, states):
        return self._exactly(np.hypot(x, z) < LOST * size, states, (x, z), lambda ex, ez: (ex, ez))

    def invariant(self, place):
        return place[0] ** 2 + place[1] ** 2

    def located(self, place, Q, x, z, exists):
        with np.errstate(all="ignore"):
            scale = np.sqrt(Q / (x * x + z * z))
            spot = np.where(exists, x * scale, place[0]), np.where(exists, z * scale, place[1])
            spot = self.polished(spot)
            offset = angle_between(place, spot)
        return np.where(offset > 0, offset, offset + TURN), spot, exists

    def way(self, spot, place, near):
        angle = angle_between(spot, place)
        return angle + TURN * np.round((near - angle) / TURN)

    def unrolled(self, place, offset, spot):
        # a turn more would cost the energy over a well just behind its digits
        return np.where(offset > np.pi, angle_between((place[0][:, None], place[1][:, None]), spot), offset)

    def repeated(self, offset, spot, energy, barrier):
        behind, fall = offset <= 0, TURN * self.potential.mu  # one turn earlier the tilt has lifted the potential by 2 pi mu
        offset = np.concatenate([offset - TURN * ~behind, offset + TURN * behind], axis=1)
        energy = np.concatenate([energy - fall * ~behind, energy + fall * behind], axis=1)
        return offset, np.concatenate([spot, spot], axis=2), energy, np.concatenate([barrier, barrier], axis=1)


class HyperbolaLandscape(ConicLandscape):
    """place = (xi, eta) = (X + Z, X - Z)."""

    base = "hyperbola"

    def _exact_place(self, x, z, size, states):
        xi, eta = x + z, x - z
        close = np.minimum(np.abs(xi), np.abs(eta)) < LOST * size
        return self._exactly(close, states, (xi, eta), lambda ex, ez: (ex + ez, ex - ez))

    def _settle_plane(self, first, second, index, state):
        if self.reduction.exact_invariant_sign(state) == 0:  # 240-bit roots may leave a remainder where there is none
            small = first if abs(first[index]) < abs(second[index]) else second
            small[index] = 0.0

    def xz(self, place):
        return 0.5 * (place[0] + place[1]), 0.5 * (place[0] - place[1])

    def invariant(self, place):
        return -place[0] * place[1]

    def located(self, place, Q, x, z, exists):
        xi, eta = x + z, x - z
        big = np.abs(xi) >= np.abs(eta)
        with np.errstate(all="ignore"):
            xi = np.where(big, xi, -Q / eta)
            eta = np.where(big, -Q / xi, eta)
            exists = exists & (np.sign(xi) == np.sign(place[0])) & (np.sign(eta) == np.sign(place[1]))  # both 0 on a plane
            spot = np.where(exists, xi, place[0]), np.where(exists, eta, place[1])
            spot = self.polished(spot)
            offset = np.where(big, np.log(spot[0] / place[0]), -np.log(spot[1] / place[1]))
        return offset, spot, exists

    def way(self, spot, place, near):
        big = np.abs(place[0]) >= np.abs(place[1])
        return np.where(big, np.log(np.abs(place[0] / spot[0])), -np.log(np.abs(place[1] / spot[1])))

    def blurred(self, spot, place, size):
        wide, largest = size[0] + size[1], np.maximum(np.abs(place[0]), np.abs(place[1]))
        beside = np.abs(place[0] * place[1] - spot[0] * spot[1]) / ((np.abs(place[0]) + np.abs(place[1])) * wide)
        return self.potential.mu * wide / largest, beside  # the tilt falls by mu times the logarithm of the place

    def beside_fold(self, place):
        """(n,) True where rounding of the place may make or unmake a pair of equilibria of its orbit."""
        Q, beside = self.invariant(place), np.zeros(np.shape(place[0]), bool)
        for edge in self.conic.fold_invariants + self.conic.tangents:
            beside |= np.abs(Q - edge) <= ROUNDINGS * EPS * (np.abs(Q) + abs(edge))
        return beside

    def roughness(self, size):
        """Magnitude of the potential's terms, whose rounding limits a height."""
        pot, s = self.potential, size[0] + size[1]
        return np.abs(pot.G) * s * s + pot.slopes * s + pot.mu

    def beside_centre(self, place):
        """(n,) True where an equilibrium may stand so near the centre of a place's hyperbola that the conic, which is known by its
        distance from its asymptotes, loses or invents it."""
        near = self._near_centre()
        if near is None:
            return np.zeros(np.shape(place[0]), bool)
        return np.sqrt(np.abs(place[0])) * np.sqrt(np.abs(place[1])) <= near

    @property
    def least_invariant(self) -> float:
        """The size of Q, in canonical units, above which a place is not `beside_centre`; 0 where none is."""
        return (self._near_centre() or 0.0) ** 2

    def _near_centre(self):
        """How near the centre the conic is not to be trusted; None where no equilibrium stands there."""
        if not self.conic.pieces:
            return None
        c, d, G = (abs(getattr(self.conic, name)) for name in ("c", "d", "G"))
        near = CENTRE * (c + d) / G  # the force of the wheel there is at most (c + d) times as much
        return near if self.conic.mu <= (c + d) * near else None


class ParabolaLandscape(Landscape):
    """place = (omega_j, omega_k)."""

    def start(self, states):
        r = self.reduction
        place = states[..., r.j], states[..., r.k]
        return place, states[..., r.axis] + float(r.s), tuple(np.abs(v) for v in place)

    def pair(self, place):
        return place

    def rate(self, w):
        return w - float(self.reduction.s)

    def energy_terms(self, place, w):
        return 0.5 * w * w

    def critical(self, place, barriers_only=False):
        force = self.potential.force(place)
        first, second, third = self.potential.derivatives(place)
        cubic = np.array(np.broadcast_arrays(third / 6, second / 2, first, force), float)
        if not np.any(cubic[0]):
            with np.errstate(all="ignore"):
                roots = np.where(cubic[2] != 0, -cubic[3] / cubic[2], np.nan)[:, None]
        else:
            roots = _real_roots(*cubic)
            for _ in range(3):
                value = ((cubic[0][:, None] * roots + cubic[1][:, None]) * roots + cubic[2][:, None]) * roots + cubic[3][:, None]
                slope = (3 * cubic[0][:, None] * roots + 2 * cubic[1][:, None]) * roots + cubic[2][:, None]
                with np.errstate(all="ignore"):
                    step = value / slope
                roots = roots - np.where(np.isfinite(step) & (np.abs(step) <= 0.1 * np.abs(roots)), step, 0)
        spot = np.array(self.potential.move(tuple(v[:, None] for v in place), np.where(np.isnan(roots), 0.0, roots)))
        barrier = (self.potential.slope(tuple(spot)) > 0) & ~np.isnan(roots)
        return roots, spot, barrier

    def beside_fold(self, place):
        """(n,) True where rounding of the place may make or unmake a pair of equilibria of its orbit."""
        pot, (first, second, third) = self.potential, self.potential.derivatives(place)
        steep, bent, _ = pot.derivative_terms(place)
        cubic = third / 6, second / 2, first, pot.force(place)
        blurred = cubic[0], *(np.abs(v) + ROUNDINGS * EPS * size for v, size in zip(cubic[1:], (bent / 2, steep, pot.terms(place))))
        terms, most = _discriminant(*cubic), sum(map(np.abs, _discriminant(*blurred)))
        size = sum(map(np.abs, terms))
        return (np.abs(sum(terms)) <= DOUBLE_ROOT * size + (most - size)) & (most > 0)

    def roughness(self, size):
        """Magnitude of the potential's terms, whose rounding limits a height."""
        pot, s = self.potential, size[0] + size[1]
        return np.abs(pot.kappa) * s * s + (abs(pot.rho) + abs(pot.sigma)) * s + abs(pot.m)

    def nearly_flat(self, states, place=None):
        if not self.sense:
            return super().nearly_flat(states)
        place = self.start(states)[0] if place is None else place
        first, _, third = self.potential.derivatives(place)
        size = abs(self.potential.kappa) + abs(self.potential.rho) + abs(self.potential.sigma)
        small = 1e-5 * size * (1 + np.abs(place[0]) + np.abs(place[1])) ** 2  # far above rounding: exact arithmetic tells the rest
        return (np.abs(first) <= small) & (np.abs(third) <= small)


GEOMETRIES = {-1: CircleLandscape, 1: HyperbolaLandscape, 0: ParabolaLandscape}


@lru_cache(maxsize=64)
def in_doubles(scene) -> bool:
    """Whether the constants of a scene's landscape, and their squares, are doubles; they are not where wheel and torque are hundreds of
    decades apart. Arrays of such a scene are answered one motion at a time."""
    try:
        land = landscape(scene)
    except OverflowError:
        return False
    if land is None or land.conic is None:
        return True
    conic = land.conic
    lines = conic.lines if conic.limit is None else (*conic.lines, conic.limit)
    return all(v * v < math.inf for v in (conic.K, conic.shift, *itertools.chain(*lines)))


def landscape_in_doubles(scene) -> Landscape | None:
    """`landscape`; raises OverflowError where `in_doubles` says no."""
    if not in_doubles(scene):
        raise OverflowError
    return landscape(scene)


@lru_cache(maxsize=64)
def landscape(scene) -> Landscape | None:
    """The landscape of a scene's reduction (cached), or None where the scene has none."""
    reduction = reduce(scene)
    return None if reduction is None else GEOMETRIES[reduction.e](reduction)
