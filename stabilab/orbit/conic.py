"""The curve of equilibria in the plane of the reduction, cut where the invariant Q = Z^2 - e X^2 is
stationary.

G X Z + c Z + d X + mu = 0 is a hyperbola, two lines or one line. Between its folds (points where it touches
an orbit) Q is monotone along it, so each piece meets an orbit at most once: that makes the search for all
barriers and wells of every orbit complete and vectorised.
"""
from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

from ..numbers.polynomial import Poly, bracketed_newton, real_roots

if TYPE_CHECKING:
    import numpy as np

    from .reduction import Reduction

SHORT = 1e-9  # a last step of Newton's method that leaves its square
FOLD_BITS = 200
CENTRE_WIDTH = 0.1  # of |h|: nearer to the centre of the orbits than that


class Piece(NamedTuple):
    """Part of the hyperbola X = (K/h - c)/G, Z = h - d/G with h between `inner` and `outer` in size (0 and
    inf at the open ends), of one sign; `rising`: Q grows with |h|. barrier: it holds saddles (maxima of the
    potential)."""

    sign: int
    inner: float
    outer: float
    rising: bool
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
        self.tangents: tuple[float, ...] = ()  # invariants of the orbits that a line of equilibria touches
        G, c, d, mu = g["G"], g["c"], g["d"], g["mu"]
        size = c * c + d * d
        self.limit = Line(float(-mu * d / size), float(-mu * c / size), float(-c), float(d)) if size else None
        if G == 0:
            self.lines = (self.limit,) if size else ()
            beside = c * c - self.e * d * d
            self.tangents = (float(mu * mu / beside),) if beside else ()
            self.K = self.shift = 0.0
            return
        # K through roots of rationals would miss an exact zero by 2^-240: recognise it in rational arithmetic
        K = Fraction(0) if _conic_degenerates(reduction) else c * d / G - mu
        self.K, self.shift = float(K), float(d / G)
        if K == 0:
            # from the feet: of two almost equal moments the crossing lies so far out that the way back would
            # cost all digits
            self.lines = (Line(float(-c / G), 0.0, 0.0, 1.0), Line(0.0, float(-d / G), 1.0, 0.0))
            self.tangents = float(-self.e * (c / G) ** 2), float((d / G) ** 2)
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
                (x, z), (far_x, far_z) = (exact_at(Fraction(sign * h)) for h in _inside(inner, outer))
                slope = G * (z * z + e * x * x) + e * c * x + d * z
                rising = far_z * far_z - e * far_x * far_x > z * z - e * x * x
                yield Piece(sign, inner, outer, rising, slope > 0)

    def critical_places(self, Q: np.ndarray, wanted: bool | None = None):
        """Every equilibrium on the orbits Q (n,): a list of (rows of Q, X, Z, barrier), of each branch of
        equilibria where it meets which of the orbits; barrier None where it is to be decided from the slope.
        wanted: True for barriers only."""
        import numpy as np
        result, thin = [], self._nearly_straight(Q)
        for piece in self.pieces:
            if wanted is None or piece.barrier == wanted:
                low, high = self.reach(piece)
                rows = np.nonzero((Q > low) & (Q < high) & ~thin)[0]
                result.append((rows, *self.at(piece.sign * self._solve(piece, Q[rows])), piece.barrier))
        lines = [(line, np.arange(len(Q))) for line in self.lines]
        if thin.any():
            lines.append((self.limit, np.nonzero(thin)[0]))
        for line, rows in lines:
            for x, z, exists in self._meet_line(line, Q[rows]):
                result.append((rows[exists], x[exists], z[exists], None))
        return result

    def _nearly_straight(self, Q: np.ndarray):
        """(n,) True where the conic differs so little from a line that the line is the better guess."""
        import numpy as np
        return np.zeros(Q.shape, bool)

    def reach(self, piece: Piece):
        """The invariants between which a piece meets an orbit."""
        at = lambda size: float(self.invariant(piece.sign * size))
        ends = (at(piece.inner) if piece.inner else -self.e * math.inf,
                at(piece.outer) if math.isfinite(piece.outer) else math.inf)
        return ends if piece.rising else ends[::-1]

    def _solve(self, piece: Piece, Q: np.ndarray):
        """|h| with invariant Q on a piece: plain Newton, longer next to a fold; the safe search for the rest.
        """
        import numpy as np
        size, rest = np.empty(Q.shape), np.arange(Q.size)
        for steps in (6, 14):
            size[rest], done = self._solve_fast(piece, Q[rest], steps)
            rest = rest[~done]
            if not rest.size:
                return size
        size[rest] = self._solve_safely(piece, Q[rest])
        return size

    def _solve_fast(self, piece: Piece, Q: np.ndarray, steps: int):
        """(|h|, converged) by a quicker way, where there is one."""
        import numpy as np
        return np.empty(Q.shape), np.zeros(Q.shape, bool)

    def _solve_safely(self, piece, Q):
        """|h| by bracketed Newton in log|h|, in which both ends of an open-ended piece are powers."""
        import numpy as np
        sign, K, c, G, s = piece.sign, self.K, self.c, self.G, self.shift
        root = np.sqrt(np.abs(Q))
        # bounds that no solution exceeds: |Z| and |X| are bounded by Q and by the other one's asymptote
        reach = root + abs(c / G) + abs(s) + np.sqrt(abs(K / G)) + 1e-300
        hi = np.minimum(piece.outer, 4 * reach)
        lo = np.maximum(piece.inner, abs(K) / (4 * reach * abs(G)))
        lo, hi = np.minimum(lo, hi), np.maximum(lo, hi)
        if np.isinf(piece.outer):
            start = np.clip(root + abs(s), lo, hi)
        elif piece.inner == 0:
            start = np.clip(abs(K) / (abs(G) * root + abs(c) + 1e-300), lo, hi)
        else:
            start = 0.5 * (lo + hi)

        # measured from the lower end by 1 and more: where log|h| itself is near 0, no step would ever be
        # short against it
        def fun(t: np.ndarray, Q: np.ndarray, lo: np.ndarray):
            h = sign * lo * np.exp(t - 1)
            x, z = (K / h - c) / G, h - s
            return self.invariant_at(x, z) - Q, 2 * (z * h + self.e * x * K / (h * G))
        ends = np.ones(Q.shape), 1 + np.log(hi / lo)
        t = bracketed_newton(fun, *ends, 1 + np.log(start / lo), (Q, lo), rising=piece.rising, enough=SHORT)
        h = sign * lo * np.exp(t - 1)
        nearby = np.hypot((K / h - c) / G, h - s) < CENTRE_WIDTH * np.abs(h)
        # there Q bends within the orbit's size, and a step that is short against h is none against that
        if nearby.any():
            some = tuple(v[nearby] for v in (*ends, t, Q, lo))
            t[nearby] = bracketed_newton(fun, *some[:3], some[3:], rising=piece.rising)
        return lo * np.exp(t - 1)

    def _meet_line(self, line: Line, Q: np.ndarray):
        """Both points of a line where the invariant is Q: a quadratic in t."""
        import numpy as np
        e = self.e
        a = line.dz**2 - e * line.dx**2
        b = line.z0 * line.dz - e * line.x0 * line.dx
        k = line.z0**2 - e * line.x0**2 - Q
        if a == 0:
            t = -k / (2 * b) if b else np.zeros(Q.shape)
            yield line.x0 + t * line.dx, line.z0 + t * line.dz, np.full(Q.shape, bool(b))
            return
        disc = b * b - a * k
        exists = disc > 0
        root = np.sqrt(np.where(exists, disc, 0))
        for side in (-1, 1):
            t = (-b + side * root) / a
            yield line.x0 + t * line.dx, line.z0 + t * line.dz, exists


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

    def _nearly_straight(self, Q: np.ndarray):
        """(n,) True where, inside the circle, the conic differs so little from a line that the line is the
        better guess (two moments equal to many digits): X = (K/h - c)/G would lose all digits. The caller
        polishes along the orbit."""
        import numpy as np
        if not self.pieces or self.limit is None:
            return super()._nearly_straight(Q)
        return abs(self.G) * np.sqrt(Q) < 1e-6 * np.hypot(self.c, self.d)

    def _solve_fast(self, piece: Piece, Q: np.ndarray, steps: int):
        """(|h|, converged) by Newton's method from the asymptote of an open-ended piece."""
        import numpy as np
        if (piece.inner > 0) == np.isfinite(piece.outer):
            return super()._solve_fast(piece, Q, steps)
        K, c, G, s = self.K, self.c, self.G, self.shift
        root = np.sqrt(Q)
        with np.errstate(all="ignore"):
            if piece.inner > 0:  # in Z = h - s: (h - s)^2 + (K/h - c)^2/G^2 = Q from h = s +- sqrt Q
                h = s + piece.sign * root
                scale = 1 / (G * G)
                for _ in range(steps):
                    ratio = K / h
                    x, z = ratio - c, h - s
                    step = (z * z + x * x * scale - Q) / (2 * (z - x * ratio / h * scale))
                    h = h - step
                last, size = np.abs(step) / np.minimum(np.abs(h), root), h * piece.sign
            else:  # in y = K/h: (K/y - s)^2 + (y - c)^2/G^2 = Q from y = c +- |G| sqrt Q
                side = piece.sign * (1 if K > 0 else -1)
                y = c + side * abs(G) * root
                scale = 1 / (G * G)
                for _ in range(steps):
                    ratio = K / y
                    z, x = ratio - s, y - c
                    step = (z * z + x * x * scale - Q) / (2 * (x * scale - z * ratio / y))
                    y = y - step
                last, size = np.abs(step) / np.minimum(np.abs(y), abs(G) * root), piece.sign * K / y
            # a last step of 1e-9, of the circle's radius too, leaves 1e-18 where convergence is quadratic, as
            # it is away from the fold
            return size, (last < 1e-9) & (size > piece.inner * (1 + 1e-4)) & (size < piece.outer * (1 - 1e-4))


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


def _inside(inner: float, outer: float):
    """Two points inside (inner, outer), the first nearer to `inner`."""
    if inner == 0 and math.isinf(outer):
        return 0.5, 2.0
    if inner == 0:
        return outer / 3, outer / 1.5
    if math.isinf(outer):
        return inner * 1.5, inner * 3
    return inner + (outer - inner) / 3, inner + (outer - inner) / 1.5


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
