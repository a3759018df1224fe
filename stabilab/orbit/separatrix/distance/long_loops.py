"""The charts of the loops of a hyperbola's branch of saddles: by the place on the branch near the saddle, by xi or eta far along.

xi = x + z of a saddle is stationary along the hyperbola at h^2 = K/G, eta = x - z at h^2 = -K/G, and on a line where its
direction is theirs. Next to such a place the chart of the branch itself goes on as far as loops reach.
"""
from __future__ import annotations

import math

from .curves import Hyperbola
from .far_chart import FarChart, Reach
from .loop_chart import OpenChart
from .turn_chart import TurnChart

NEAR = 1.0  # the way along loops up to which the place on the branch is a good parameter
SHORT = 3.0  # loops that reach no farther need no other
ZONE = 0.25  # of the parameter log|h| beside the place where xi is stationary
NOWHERE = 1e-90  # of a place beside a plane: nearer makes no difference
NO_END = 720.0  # e^-y is gone in doubles


def planes_met(seen, curve, low, high):
    """(distance, place) of the planes that the loops of a branch come exponentially near to, where the foot of the perpendicular
    is reached at the state's own rate after a way so long that nothing in doubles is left of eta."""
    for flip in (-1, 1):
        side = _Side(seen, curve, flip, 0.0)
        yield from (found for piece in side.pieces(low, high) if (found := side.on_plane(*piece)))


def loops_of(seen, curve, low, high, upper):
    """Charts of all loops of the branch t from low to high that may come within `upper` of the state."""
    ends, far = [], []
    for flip in (-1, 1):  # against the orbit eta grows, along it xi
        side = _Side(seen, curve, flip, upper)
        way = side.way(low, high)
        ends.append(way if way <= SHORT else NEAR)
        if way > SHORT:
            far += side.charts(low, high)
    yield OpenChart(seen, curve, (low, high), (-ends[0], ends[1]))
    yield from far


class _Side:
    """Loops along which xi = X + flip Z grows."""

    def __init__(self, seen, curve, flip, upper):
        self.seen, self.curve, self.flip, self.upper = seen, curve, flip, upper
        g = seen.plain
        self.wide = upper * (1 / math.sqrt(g["a"]) + 1 / math.sqrt(g["b"])) * (1 + 1e-9)
        self.most = abs(g["X"] + flip * g["Z"]) + self.wide

    def way(self, low, high):
        """How far along the loops of a piece of the branch |xi| stays below what it is within `upper` of the state."""
        least = self._least(low, high)
        if not least:
            return math.inf
        return max(math.log(self.most / least), 0.0) + 0.01 if self.most else 0.01

    def charts(self, low, high):
        for a, b, turning in self.pieces(low, high):
            way = self.way(a, b)
            if way > NEAR and turning:
                yield from self._beside_turn(a, b, way)
            elif way > NEAR:
                reach = self._reach(a, b)
                end = NO_END if self.on_plane(a, b, turning) else self._end(reach, way)
                if end > NEAR:
                    yield FarChart(self.seen, reach, (-self.wide, self.wide), (NEAR, end), self.flip)

    def _beside_turn(self, a, b, way):
        low, high = self._values(a, b, self.flip)
        if not isinstance(self.curve, Hyperbola) or not low * high > 0:
            way = min(way, max(math.log(self.most / NOWHERE), SHORT))
            yield OpenChart(self.seen, self.curve, (a, b), (-way, -NEAR) if self.flip < 0 else (NEAR, way))
            return
        chart = TurnChart(self.seen, self.curve, self.flip, (a, b))
        least = min(abs(low), abs(high)) * math.exp(NEAR) * (1 - 1e-9)
        ends = (max(chart.xi0 - self.wide, least), chart.xi0 + self.wide) if low > 0 else (chart.xi0 - self.wide, min(chart.xi0 + self.wide, -least))
        if ends[0] < ends[1]:
            yield chart.over(*ends)

    def pieces(self, low, high):
        """(a, b, turning): the branch cut beside places where xi is stationary."""
        turns = self._stationary(self.flip)
        if not turns or not low - ZONE < turns[0] < high + ZONE:
            return [(low, high, not self._moves())]
        t = turns[0]
        at = self.curve.at(t)
        zone = min(ZONE, math.acosh(1 + 0.25 * abs(at.x + self.flip * at.z) / abs(at.zt)))  # there xi stays above half of its value
        a, b = max(low, t - zone), min(high, t + zone)
        return [piece for piece in ((low, a, False), (a, b, True), (b, high, False)) if piece[0] < piece[1]]

    def _moves(self):
        """Whether xi changes along a line at all."""
        if isinstance(self.curve, Hyperbola):
            return True
        dx, dz = self.curve.way
        return abs(dx + self.flip * dz) * 10**6 > abs(dx) + abs(dz)

    def _stationary(self, flip):
        """t where X + flip Z of the saddles is stationary, on a hyperbola."""
        if not isinstance(self.curve, Hyperbola):
            return []
        K, _, G, _ = self.curve.plain
        square = flip * K / G
        return [self.curve.to(math.sqrt(square))] if square > 0 else []

    def _values(self, a, b, flip):
        """The least and the greatest X + flip Z of the saddles of a piece: where it ends in a fold beside a plane, how near decides."""
        spots = [a, b, *(t for t in self._stationary(flip) if a < t < b)]
        values = [float(x + flip * z) for x, z in map(self.curve.exact, spots)]
        return min(values), max(values)

    def _least(self, a, b):
        low, high = self._values(a, b, self.flip)
        return max(low, -high, 0.0)

    def _reach(self, a, b):
        r, E = self._values(a, b, self.flip), self._values(a, b, -self.flip)
        x, z = self.curve.exact(0.5 * (a + b))
        line = None
        if not isinstance(self.curve, Hyperbola):
            dx, dz = self.curve.way
            line = (dx - self.flip * dz) / (dx + self.flip * dz)
        exact = x + self.flip * z, x - self.flip * z
        return Reach(*map(float, exact), r[0], r[1], (0.5 * (E[0] + E[1]), 0.5 * (E[1] - E[0]) + 1e-15 * (abs(E[0]) + abs(E[1]))),
                     None if line is None else float(line), (*exact, line))

    def on_plane(self, a, b, turning):
        """(distance, place) of the foot on the plane eta = 0 if the loops of a piece reach it there, else None."""
        g, flip = self.seen.plain, self.flip
        if turning or not g["mu"] or self._least(a, b):
            return None
        reach = self._reach(a, b)
        chart = FarChart(self.seen, reach, (0.0, 0.0), (0.0, 0.0), flip)
        x = (g["a"] * g["X"] + flip * g["b"] * g["Z"]) / (g["a"] + g["b"])
        E = chart.root()
        energy = (0.5 * g["n2"] * g["w"] ** 2 - x * (0.5 * g["G"] * x + 2 * chart.e1) + E * (0.125 * g["G"] * E - chart.e2))
        if not (reach.low < 0 < reach.high and chart.mu > 0 and E * (0.5 * g["G"] * E - chart.e2) > 0 and energy > 1.01 * NO_END * chart.mu):
            return None
        apart = abs(chart.eta0) * math.sqrt(g["a"] * g["b"] / (g["a"] + g["b"]))
        return apart, (x - g["X"], flip * x - g["Z"], g["w"])

    def _end(self, reach, way):
        """The way beyond which W is too great, or none is left; NO_END where it makes no difference any more."""
        g = self.seen.plain
        mu, G, e = self.flip * g["mu"], abs(g["G"]), 0.5 * (abs(g["c"]) + abs(g["d"]))
        if not mu:
            return min(way, NO_END)
        tall = abs(reach.E[0]) + reach.E[1]
        other = 2 * self.most * (0.125 * G * self.most + e) + 2 * tall * (0.125 * G * tall + e)
        swing = 0.5 * g["n2"] * (g["w"] + self.upper) ** 2 if mu > 0 else 0.0
        return min(way, (swing + other) / abs(mu) * (1 + 1e-9) + 1)
