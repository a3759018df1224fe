"""The curve of equilibria in the plane of the reduction, cut where the invariant Q = Z^2 - e X^2 is
stationary.

G X Z + c Z + d X + mu = 0 is a hyperbola, two lines or one line. Between its folds (points where it touches
an orbit) Q is monotone along it, so each piece meets an orbit at most once, in barriers alone or in wells.
"""
from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

from ..numbers.polynomial import Poly, real_roots

if TYPE_CHECKING:
    import numpy as np

    from .reduction import Reduction

FOLD_BITS = 200


class Piece(NamedTuple):
    """Part of the hyperbola X = (K/h - c)/G, Z = h - d/G with h between `inner` and `outer` in size (0 and
    inf at the open ends), of one sign; barrier: it holds saddles (maxima of the potential)."""

    sign: int
    inner: float
    outer: float
    barrier: bool


class Line(NamedTuple):
    """Equilibria (x0 + t dx, z0 + t dz): a degenerate conic."""

    x0: float
    z0: float
    dx: float
    dz: float


class Conic:
    """The equilibria of a reduction with circles or hyperbolas, and their pieces. Exact constants decide
    degeneracy."""

    e: int  # of the invariant Z^2 - e X^2
    planes: tuple[float, ...] = ()  # invariants at which an orbit falls apart

    def __init__(self, reduction: Reduction):
        g, self.place = reduction.exact_constants, reduction.geometry.place
        self.G, self.c, self.d, self.mu = (reduction.constants[n] for n in ("G", "c", "d", "mu"))
        self.pieces: tuple[Piece, ...] = ()
        self.lines: tuple[Line, ...] = ()
        self.folds: tuple[float, ...] = ()
        self.fold_invariants: tuple[float, ...] = ()
        G, c, d, mu = g["G"], g["c"], g["d"], g["mu"]
        size = c * c + d * d
        self.limit = Line(float(-mu * d / size), float(-mu * c / size), float(-c), float(d)) if size else None
        if G == 0:
            self.lines = (self.limit,) if size else ()
            self.K = self.shift = 0.0
            return
        # K through roots of rationals would miss an exact zero by 2^-240: recognise it in rational arithmetic
        K = Fraction(0) if _conic_degenerates(reduction) else c * d / G - mu
        self.K, self.shift = float(K), float(d / G)
        if K == 0:
            # from the feet: of two almost equal moments the crossing lies so far out that the way back would
            # cost all digits
            self.lines = (Line(float(-c / G), 0.0, 0.0, 1.0), Line(0.0, float(-d / G), 1.0, 0.0))
            return
        # of two almost equal moments a fold's h lies far out, and one rounding of it would move its orbit
        quartic = Poly((self.e * K * K / G**2, -self.e * c * K / G**2, Fraction(0), -d / G, Fraction(1)))
        self.exact_folds = {float(h): h for h in real_roots(quartic, FOLD_BITS)}
        self.folds = tuple(self.exact_folds)

        def exact_at(h: Fraction):
            return (K / h - c) / G, h - d / G
        self.pieces = tuple(self._pieces(exact_at, G, c, d))
        exact_places = [exact_at(h) for h in self.exact_folds.values()]
        self.fold_invariants = tuple(float(z * z - self.e * x * x) for x, z in exact_places)

    def sharp_ends(self, piece: Piece):
        """|h| of the ends of a piece, those at folds to FOLD_BITS."""
        return tuple(abs(self.exact_folds[piece.sign * end]) if 0 < end < math.inf else end
                     for end in (piece.inner, piece.outer))

    def at(self, h: float | np.ndarray):
        """(X, Z) on the hyperbola."""
        return (self.K / h - self.c) / self.G, h - self.shift

    def invariant(self, h: float):
        return self.invariant_at(*self.at(h))

    def invariant_at(self, x: float | np.ndarray, z: float | np.ndarray):
        """Q of (X, Z), free of cancellation."""
        raise NotImplementedError

    def within(self, limit: float) -> tuple[float, ...]:
        """The invariants of size `limit`."""
        raise NotImplementedError

    def sides(self, sense: int) -> tuple[tuple[int, str], ...]:
        """Which way loops leave a saddle under a torque of this sense (0: none), and the word for it."""
        return (-1, ", left loop"), (1, ", right loop")

    def _pieces(self, exact_at: Callable[[Fraction], tuple[Fraction, Fraction]], G: Fraction, c: Fraction,
                d: Fraction):
        """The pieces by exact signs: of two almost equal moments the terms of the slope cancel to the last
        digit."""
        e = self.e
        for sign in (-1, 1):
            cuts = sorted(abs(f) for f in self.folds if f * sign > 0)
            for inner, outer in zip([0.0, *cuts], [*cuts, float("inf")]):
                x, z = exact_at(Fraction(sign * _inside(inner, outer)))
                slope = G * (z * z + e * x * x) + e * c * x + d * z
                yield Piece(sign, inner, outer, slope > 0)


class CircleConic(Conic):
    """The equilibria on circles."""

    e = -1

    def invariant_at(self, x: float | np.ndarray, z: float | np.ndarray):
        return z * z + x * x

    def within(self, limit: float):
        return (limit,)

    def sides(self, sense: int):
        """On a tilted circle against the torque alone."""
        return ((-1, ""),) if sense else super().sides(sense)


class HyperbolaConic(Conic):
    """The equilibria on hyperbolas."""

    e, planes = 1, (0.0,)

    def invariant_at(self, x: float | np.ndarray, z: float | np.ndarray):
        return (z - x) * (z + x)

    def within(self, limit: float):
        return limit, -limit


GEOMETRIES = {-1: CircleConic, 1: HyperbolaConic}


def conic_of(reduction: Reduction) -> Conic:
    """The equilibria of a reduction with circles or hyperbolas."""
    return GEOMETRIES[reduction.e](reduction)


def _inside(inner: float, outer: float) -> float:
    """A point inside (inner, outer)."""
    if math.isinf(outer):
        return inner * 1.5 if inner else 0.5
    return inner + (outer - inner) / 3


def _conic_degenerates(reduction: Reduction) -> bool:
    """True iff c d = G mu exactly: with cj = rho - kappa sj, ck = sigma - kappa sk, torque T this is cj ck =
    kappa T."""
    r = reduction
    across_j, across_k = r.across
    return across_j * across_k == r.kappa * r.torque


def planes_touched(reduction: Reduction) -> tuple[int, ...]:
    """(+1 or -1) or (): the hyperbola of equilibria touches the invariant plane Z = -X or Z = X, exactly: (c
    + flip d)^2 = 4 flip (c d - G mu).

    With cj, ck, T of `_conic_degenerates`, f the reflection and n = sqrt|p q| both sides without 2 flip c d
    are |p q| times cj^2 |q| + ck^2 |p| and flip f sgn(p) n (2 cj ck - 4 kappa T).
    """
    r = reduction
    (cj, ck), p, q = r.across, abs(r.p), abs(r.q)
    left, right = cj * cj * q + ck * ck * p, 2 * cj * ck - 4 * r.kappa * r.torque
    if not left or left * left != p * q * right * right:
        return ()
    return ((1 if right > 0 else -1) * (1 if r.p > 0 else -1) * (-1 if r.torque < 0 else 1),)
