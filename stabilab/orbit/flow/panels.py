"""Time along a motion in one degree of freedom: passages over hills and away from turning points, panel by panel.

A motion is a chain of passages, each in a coordinate in which dt/dx is smooth: the offset from a hill that it passes, or
the root of the way from the point where it turns. A passage is cut into panels until Gauss's rule sees the end of its own
series on each; next to a separatrix the panels shrink towards the hill, some forty of them for a distance of 1e-12.
"""
from __future__ import annotations

import math
from bisect import bisect_right
from functools import lru_cache

import numpy as np

from ...errors import InputError
from .profile import EPS, TURN, Arrays, Plain

POINTS = 16
FIXED = TURN / 8  # longest panel
SETTLED = 4e-15  # last coefficients against the first: some ten times what rounding leaves of them
DEEPEST = 80  # halvings of a passage; 1e-12 from a separatrix takes 20
CROWD = 200  # panels of one size that are still cut: then it is rounding that keeps them from settling
NEWTON = 12
EARLY = -0.9  # of -1 to 1: nearer to the beginning of the first panel its series loses more than a digit of the way from there


class Passing:
    """Over a spot with kinetic energy `kinetic` there; x is the offset from it, from lo to hi; at: that
    of the spot from the state."""

    def __init__(self, spot, kinetic, lo, hi, at=None):
        self.spot, self.kinetic, self.at_zero = spot, kinetic, spot.at if at is None else at
        self.cuts = (lo, 0.0, hi) if lo < 0 < hi else (lo, hi)  # about the spot panels shrink, and keep their digits

    def energy(self, x, f):
        return self.kinetic + x * self.spot.share(0.0, x, f)

    def rate(self, x):
        """dt/dx."""
        return 1 / np.sqrt(2 * self.energy(x, Arrays))

    def offset(self, x):
        return x

    def at(self, x, f):
        """(offset, W)."""
        return x, f.sqrt(2 * self.energy(x, f))

    def x_of(self, y, w):
        return y


class Turning:
    """From (sense 1) or to (sense -1) the turning point at offset a of a spot: offset a + sense x^2, to `far`; at: as
    of `Passing`."""

    def __init__(self, spot, a, sense, far, at=None):
        self.spot, self.a, self.sense, self.at_zero = spot, a, sense, spot.at if at is None else at
        reach = math.sqrt(max(sense * (far - a), 0.0))
        self.cuts = (0.0, reach) if sense > 0 else (-reach, 0.0)

    def _share(self, x, f):
        return 2 * self.sense * self.spot.share(self.a, self.sense * x * x, f)

    def rate(self, x):
        return 2 / np.sqrt(self._share(x, Arrays))

    def at(self, x, f):
        return self.a + self.sense * x * x, abs(x) * f.sqrt(self._share(x, f))

    def x_of(self, y, w):
        """From the rate, which keeps its digits next to the turning point."""
        share = self._share(math.sqrt(max(self.sense * (y - self.a), 0.0)), Plain)
        return self.sense * abs(w) / math.sqrt(share)


class Turn:
    """The passages of one turn of a circle, each over a hill from well to well (on a circle without hills, one from the state
    round to itself). Passage m * hills + h is over hill h of turn m, the turn ahead of the state being 0."""

    def __init__(self, relief):
        self.relief, half = relief, len(relief.spots) // 2
        self.hills = [s for s in relief.spots[half:] if s.kind > 0] or [relief.here]
        self.behind = [s.at for s in relief.spots[:half] if s.kind > 0] or [-TURN]
        wells = [s.at for s in relief.spots[half:] if s.kind < 0]
        wells = [w + n * TURN for n in (-1, 0, 1) for w in wells]
        self.sides = [(hill.at - max(w for w in wells if w < hill.at), min(w for w in wells if w > hill.at) - hill.at)
                      if wells else (0.0, TURN) for hill in self.hills]

    def where(self):
        """(number of the passage that the state is in, offset of the state there)."""
        count = len(self.hills)
        found = [(m * count + h, -at) for m, row in ((0, [hill.at for hill in self.hills]), (-1, self.behind))
                 for h, at in enumerate(row)]
        outside = [max(-y - self.sides[n % count][0], y - self.sides[n % count][1]) for n, y in found]
        return found[outside.index(min(outside))]

    def passing(self, number, lo=None) -> Passing:
        """Passage `number`, from offset lo on or from its beginning."""
        turn, h = divmod(number, len(self.hills))
        behind, ahead = self.sides[h]
        return Passing(self.hills[h], self.hills[h].kinetic + turn * self.relief.turn, -behind if lo is None else lo, ahead,
                       self.hills[h].at + turn * TURN)


def turning_offset(spot, sense, reach=None) -> float | None:
    """Offset from the spot, on the side `sense`, at which W = 0; reach: no further than that (None: search outwards).

    The spot is a well with kinetic energy, or a hill without enough. None where the motion does not turn.
    """
    rising = spot.kinetic < 0

    def beyond(t):
        try:
            value = spot.energy(sense * t, Plain)
        except OverflowError:
            value = -math.inf
        return value, (value > 0) == rising

    if reach is None:
        reach = 1.0
        while not beyond(reach)[1]:
            reach *= 2
            if reach > 1e160 or (type(spot).__name__ == "OnHyperbola" and reach > 2000):
                return None
    low, high = 0.0, reach
    bend = abs(spot.bend) or 1.0
    t = min(math.sqrt(2 * abs(spot.kinetic) / bend), 0.5 * reach)
    for _ in range(200):
        value, past = beyond(t)
        low, high = (low, t) if past else (t, high)
        slope = sense * spot.share(sense * t, 0.0, Plain) if math.isfinite(value) else 0.0
        new = t - value / slope if slope else low
        if not low < new < high:
            new = 0.5 * (low + high)
        if abs(new - t) <= EPS * t or high - low <= EPS * high:
            return sense * new
        t = new
    return sense * t


@lru_cache(maxsize=32)
def rule(points):
    """(nodes and weights of Gauss, matrix to the Chebyshev coefficients of the integrand, matrix to those of its integral from
    -1); both matrices act on rows from the right."""
    cheb = np.polynomial.chebyshev
    nodes, weights = np.polynomial.legendre.leggauss(points)
    forward = np.linalg.inv(cheb.chebvander(nodes, points - 1))
    return nodes, weights, forward.T.copy(), cheb.chebint(forward, lbnd=-1).T.copy()


def _edges(cuts):
    """The cuts and what divides the ways between them into parts no longer than `FIXED`."""
    parts = [np.linspace(a, b, math.ceil((b - a) / FIXED) + 1)[:-1] for a, b in zip(cuts, cuts[1:])]
    return np.concatenate([*parts, cuts[-1:]])


def clenshaw(c, x):
    """Sum of c[k] T_k(x): floats, or rows of arrays."""
    one = two = 0.0
    double = 2 * x
    for coefficient in c[:0:-1]:
        one, two = double * one - two + coefficient, one
    return x * one - two + c[0]


def inverted(integral, rate, half, wanted, f):
    """xi in [-1, 1] at which half * (the integral's series) = wanted; coefficients as of `clenshaw`."""
    whole = half * sum(integral)
    xi = 2 * wanted / whole - 1
    for _ in range(NEWTON):
        step = (half * clenshaw(integral, xi) - wanted) / (half * clenshaw(rate, xi))
        new = min(max(xi - step, -1.0), 1.0) if f is Plain else np.clip(xi - step, -1, 1)
        moved = abs(new - xi) if f is Plain else np.abs(new - xi).max(initial=0.0)
        xi = new
        if moved <= 1e-8:  # the next step would square that
            return xi
    return xi


class Panels:
    """Time from the start of a chain of passages; with fewer than `POINTS` points a panel none is cut further.

    evaluations: of dt/dx; starts: times at the panels' beginnings; owner: the passage of each; low, half: their ends and half
    lengths; values (n, points): dt/dx at the nodes; rates, integrals: Chebyshev coefficients of dt/dx and of t."""

    def __init__(self, chain, points=POINTS):
        self.chain, self.points, self.evaluations = chain, points, 0
        found = [self._cut(passage, points >= POINTS) for passage in chain]
        self.owner = [n for n, part in enumerate(found) for _ in part[0]]
        columns = found[0] if len(found) == 1 else [np.concatenate(column) for column in zip(*found)]
        self.low, self.half, self.values, self.rates = columns
        self.integrals = self.values @ rule(points)[3]
        ends = np.cumsum(self.half * self.integrals.sum(axis=1))
        self.total = float(ends[-1])
        self.starts = np.concatenate([[0.0], ends[:-1]])
        self._starts = self.starts.tolist()

    def _cut(self, passage, adaptive):
        """(low ends, half lengths, dt/dx (n, points), its coefficients (n, points)) of a passage's panels, in order."""
        nodes, _, forward, _ = rule(self.points)
        edges = _edges(passage.cuts)
        low, high, done = edges[:-1], edges[1:], []
        for depth in range(DEEPEST + 1):
            half, middle = 0.5 * (high - low), 0.5 * (low + high)
            x = middle[:, None] + half[:, None] * nodes
            with np.errstate(all="ignore"):
                values = passage.rate(x.ravel()).reshape(x.shape)
            self.evaluations += x.size
            if not np.isfinite(values).all():
                raise InputError("the reduced form of this motion takes more digits than doubles have")
            rate = values @ forward
            good = np.abs(rate[:, -2:]).max(axis=1) <= SETTLED * np.abs(rate[:, 0]) if adaptive else np.ones(len(low), bool)
            if good.all():
                done.append((low, half, values, rate))
                break
            if depth == DEEPEST or len(low) > CROWD:
                raise InputError("the reduced form of this motion takes more panels than it is set up for")
            done.append((low[good], half[good], values[good], rate[good]))
            low, middle, high = low[~good], middle[~good], high[~good]
            low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
        if len(done) == 1:
            return done[0]
        columns = [np.concatenate(column) for column in zip(*done)]
        order = np.argsort(columns[0])
        return [column[order] for column in columns]

    def time_at(self, number, x) -> float:
        """Time at coordinate x of passage `number`."""
        mine = [n for n, owner in enumerate(self.owner) if owner == number]
        n = mine[max(bisect_right(self.low[mine].tolist(), x) - 1, 0)]
        x = min(max(x, self.low[n]), self.low[n] + 2 * self.half[n])
        return float(self.starts[n] + self._integral(self.chain[number], self.low[n], np.array([x]))[0])

    def _integral(self, passage, low, x):
        """Times from coordinate low to x (n,), right to their last digits however short."""
        nodes, weights, *_ = rule(self.points)
        half = 0.5 * (x - low)
        self.evaluations += x.size * len(nodes)
        return half * (passage.rate((low + half[:, None] * (1 + nodes)).ravel()).reshape(len(x), -1) @ weights)

    def _sharpened(self, x, time):
        """Coordinates x (n,) of the first panel, rounded with the panel's own size, as times (n,) since its beginning demand."""
        passage, low = self.chain[0], self.low[0]
        return np.maximum(x + (time - self._integral(passage, low, x)) / passage.rate(x), low)

    def at(self, t):
        """(spot, offset, W) at one time in [0, total]."""
        n = max(bisect_right(self._starts, t) - 1, 0)
        half, low = float(self.half[n]), float(self.low[n])
        xi = inverted(self.integrals[n].tolist(), self.rates[n].tolist(), half, t - self._starts[n], Plain)
        passage, x = self.chain[self.owner[n]], low + half * (1 + xi)
        if n == 0 and xi < EARLY:
            x = float(self._sharpened(np.array([x]), t)[0])
        return (passage.spot, *passage.at(x, Plain))

    def follow(self, times, signs):
        """(states (n, 3) at times in [0, total], W times the signs; offsets of their places (n,))."""
        n = np.maximum(np.searchsorted(self.starts, times, side="right") - 1, 0)
        half, out, offsets = self.half[n], np.empty((len(times), 3)), np.empty(len(times))
        xi = inverted(self.integrals[n].T, self.rates[n].T, half, times - self.starts[n], Arrays)
        x, owner = self.low[n] + half * (1 + xi), np.array(self.owner)[n]
        early = np.nonzero((n == 0) & (xi < EARLY))[0]
        if len(early):
            x[early] = self._sharpened(x[early], times[early])
        for number, passage in enumerate(self.chain):
            mine = owner == number
            if mine.any():
                y, w = passage.at(x[mine], Arrays)
                out[mine] = np.array(passage.spot.state(y, w * signs[mine], Arrays)).T
                offsets[mine] = passage.at_zero + y
        return out, offsets
