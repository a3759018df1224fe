"""The charts of the loops of a hyperbola's branch of saddles: by the place on the branch near the saddle, by xi or eta far along.

xi = x + z of a saddle is stationary along the hyperbola at h^2 = K/G, eta = x - z at h^2 = -K/G, and on a line where its
direction is theirs. Next to such a place the chart of the branch itself goes on as far as loops reach.
"""
from __future__ import annotations

import math
from fractions import Fraction

from ..curves import Hyperbola
from .far_chart import FarChart, Reach, Tube
from .loop_chart import OpenChart
from .root_chart import RootChart
from .turn import Turn
from .turn_chart import TurnChart

NEAR = 1.0  # the way along loops up to which the place on the branch is a good parameter
SHORT = 3.0  # loops that reach no farther need no other
ZONE = 0.25  # of s, about the log of h, beside the place where xi is stationary
SHARE = 1 / 64  # of the xi that matter: a tube about that place, as wide
NOWHERE = 1e-90  # of a place beside a plane: nearer makes no difference
ZERO = 1e-9  # of the parameter log|h|: what rounding leaves between a turn and a fold that are one
NO_END = 720.0  # e^-y is gone in doubles


def planes_met(seen, curve, low, high):
    """(distance, place) of the planes that the loops of a branch come exponentially near to, where the foot of the perpendicular
    is reached at the state's own rate after a way so long that nothing in doubles is left of eta."""
    for flip in (-1, 1):
        side = Side(seen, curve, flip, math.inf, low, high)
        yield from (found for a, b, turning in side.pieces() if not turning and (found := side.on_plane(a, b)))


def loops_of(seen, curve, low, high, upper):
    """Charts of all loops of the branch t from low to high that may come within `upper` of the state."""
    ends, far = [], []
    for flip in (-1, 1):  # against the orbit eta grows, along it xi
        side = Side(seen, curve, flip, upper, low, high)
        way = side.way(low, high)
        ends.append(way if way <= SHORT else NEAR)
        if way > SHORT:
            far += side.charts()
    yield OpenChart(seen, curve, (low, high), (-ends[0], ends[1]))
    yield from far


class Side:
    """Loops along which xi = X + flip Z grows, of the branch t from low to high. turn: where xi is stationary on it or beside it, if anywhere;
    rooted: so near a plane that charts go with the root of xi there."""

    def __init__(self, seen, curve, flip, upper, low, high):
        self.seen, self.curve, self.flip, self.upper = seen, curve, flip, upper
        g = seen.plain
        self.wide = upper * (1 / math.sqrt(g["a"]) + 1 / math.sqrt(g["b"])) * (1 + 1e-9)
        self.most = abs(g["X"] + flip * g["Z"]) + self.wide
        turn = self._turn_of(flip)
        self.turn = turn if turn and low - ZONE < turn.t < high + ZONE else None
        self.tube = self._tube() if self.turn else None
        self.rooted = self.tube is not None
        if self.rooted and not turn.r:  # a fold on the plane, where the branch ends
            low, high = (turn.t if abs(end - turn.t) < ZERO else end for end in (low, high))
        self.low, self.high = low, high

    def _turn_of(self, flip):
        return Turn.of(self.seen, self.curve, flip) if isinstance(self.curve, Hyperbola) else None

    def way(self, low, high):
        """How far along the loops of a piece of the branch |xi| stays below what it is within `upper` of the state."""
        least = self._least(low, high)
        if not least:
            return math.inf
        return max(math.log(self.most / least), 0.0) + 0.01 if self.most else 0.01

    def charts(self):
        if self.rooted:
            yield from self._about_root()
        for a, b, turning in self.pieces():
            way = self.way(a, b)
            if way > NEAR and turning:
                yield from self._beside_turn(a, b, way)
            elif way > NEAR:
                reach = self._reach(a, b)
                end = NO_END if self.on_plane(a, b) else self._end(reach, way)
                if end > NEAR:
                    yield FarChart(self.seen, reach, (-self.wide, self.wide), (NEAR, end), self.flip)

    def _beside_turn(self, a, b, way):
        if self.turn is None:  # a line along which xi does not change
            way = min(way, max(math.log(self.most / NOWHERE), SHORT))
            yield OpenChart(self.seen, self.curve, (a, b), (-way, -NEAR) if self.flip < 0 else (NEAR, way))
            return
        yield from self._by_turn(*self._places(a, b), NEAR)

    def _places(self, a, b):
        """The least and greatest s of a piece, and the one of them next to the turn that s is told from, or zero."""
        turn = self.turn
        ends = [turn.s_of(turn.h if t == turn.t else self.curve.h_at(t)) for t in (a, b)]
        start = min(ends, key=abs)
        return *ends, start if abs(turn.H) * start * start <= abs(turn.r) else Fraction(0)

    def _by_turn(self, low, high, start, way):
        """The chart of saddles with s between two places, from a way on; xi has one sign there."""
        if not low < high:
            return
        turn = self.turn
        chart = TurnChart(self.seen, turn, (low, high, start), self.flip)
        values = [float(turn.r + turn.H * s * s) for s in (low, high, *([0] if low < 0 < high else []))]
        least = min(map(abs, values)) * math.exp(way) * (1 - 1e-9)
        ends = (max(chart.xi0 - self.wide, least), chart.xi0 + self.wide) if values[0] > 0 else (
            chart.xi0 - self.wide, min(chart.xi0 + self.wide, -least))
        if ends[0] < ends[1]:
            yield chart.over(*ends)

    def _about_root(self):
        """Charts of the saddles of the tube, where xi tells them badly: first, as long as eta still goes with the root of a small xi, a part of the
        branch, then those about the turn that xi is near for; when r e^y has become large beside that, xi and the place are good parameters."""
        turn, tube = self.turn, self.tube
        end = max(NO_END if self.on_plane(a, b) else self._end(self._reach(a, b), self.way(a, b)) for a, b, _ in self.pieces())
        low, high, start = self._places(self.low, self.high)
        for y0, y1, most in ((NEAR, min(tube.until, end), tube.zone * math.exp(0.5 * tube.until)), (tube.until, min(tube.turning, end), tube.sigma)):
            if y0 < y1:
                chart = RootChart(self.seen, turn, (low, high, start), self.flip, self.upper, (y0, y1), most)
                if chart.t[0] < chart.t[1]:
                    yield chart
        if tube.turning < end:
            thin = Fraction(tube.thin * (1 + 1e-9))
            yield from self._by_turn(max(low, -thin), min(high, thin), start, tube.turning)

    def _tube(self):
        """None where xi is far from the plane at the turn."""
        H, r = abs(float(self.turn.H)), abs(float(self.turn.r))
        if not self.most:
            return None
        sigma, thin = math.sqrt(SHARE * self.most / H), min(ZONE, math.sqrt(0.5 * r / H))
        turning = 2 * (math.log(sigma) - math.log(thin)) if r else math.inf
        if not (turning > NEAR and 8 * r < H):
            return None
        until = max(NEAR, math.log(H / self.most) / 3 + NEAR) if self.most < math.inf else NEAR
        return Tube(float(self.turn.r), float(self.turn.H), ZONE, until, sigma, max(turning, until), thin)

    def pieces(self):
        """(a, b, turning): the branch cut where xi is stationary, or beside such places if it is not near a plane there."""
        low, high, turn = self.low, self.high, self.turn
        if turn is None:
            return [(low, high, not self._moves())]
        # beside it xi stays above half of its value
        zone = 0.0 if self.rooted else min(ZONE, 2 * math.asinh(0.5 * math.sqrt(0.5 * abs(turn.r / turn.H))))
        a, b = max(low, turn.t - zone), min(high, turn.t + zone)
        return [piece for piece in ((low, min(a, high), False), (a, b, True), (max(b, low), high, False)) if piece[0] < piece[1]]

    def _moves(self):
        """Whether xi changes along the branch at all."""
        if isinstance(self.curve, Hyperbola):
            return True
        dx, dz = self.curve.way
        return abs(dx + self.flip * dz) * 10**6 > abs(dx) + abs(dz)

    def _values(self, a, b, flip):
        """The least and the greatest X + flip Z of the saddles of a piece: where it ends in a fold beside a plane, how near decides."""
        values = [self._value(t, flip) for t in (a, b)]
        turn = self.turn if flip == self.flip else self._turn_of(flip)
        if turn and a < turn.t < b:
            values.append(float(turn.r))
        return min(values), max(values)

    def _value(self, t, flip):
        if self.turn and flip == self.flip and t == self.turn.t:
            return float(self.turn.r)
        x, z = self.curve.exact(t)
        return float(x + flip * z)

    def _least(self, a, b):
        low, high = self._values(a, b, self.flip)
        return max(low, -high, 0.0)

    def _reach(self, a, b):
        r, E = self._values(a, b, self.flip), self._values(a, b, -self.flip)
        E = (0.5 * (E[0] + E[1]), 0.5 * (E[1] - E[0]) + 1e-15 * (abs(E[0]) + abs(E[1])))
        t = 0.5 * (a + b)
        if self.rooted:  # G E/2 - e2 = -G H sinh(tau)
            rising = -self.turn.H * self.seen.exact["G"] * (1 if t > self.turn.t else -1)
            exact = self.turn.r, self.turn.E
            return Reach(*map(float, exact), *r, E, None, (*exact, None), float(rising), self.tube)
        x, z = self.curve.exact(t)
        exact, line = (x + self.flip * z, x - self.flip * z), None
        if not isinstance(self.curve, Hyperbola):
            dx, dz = self.curve.way
            line = (dx - self.flip * dz) / (dx + self.flip * dz)
        g = self.seen.exact
        return Reach(*map(float, exact), *r, E, None if line is None else float(line), (*exact, line),
                     float(g["G"] * exact[1] - self.flip * g["d"] + g["c"]))

    def on_plane(self, a, b):
        """(distance, place) of the foot on the plane eta = 0 if the loops of a monotone piece reach it there, else None."""
        g, flip = self.seen.plain, self.flip
        if not g["mu"] or self._least(a, b):
            return None
        reach = self._reach(a, b)
        chart = FarChart(self.seen, reach, (0.0, 0.0), (0.0, 0.0), flip)
        x = (g["a"] * g["X"] + flip * g["b"] * g["Z"]) / (g["a"] + g["b"])
        if reach.low < 0 < reach.high:
            E = chart.root()
        elif self.rooted and self.turn.t in (a, b) and not self.turn.r and x * self.turn.H >= 0:  # loops on one side of it
            E = 2 * chart.e2 / g["G"]
        else:
            return None
        energy = (0.5 * g["n2"] * g["w"] ** 2 - x * (0.5 * g["G"] * x + 2 * chart.e1) + E * (0.125 * g["G"] * E - chart.e2))
        if not (chart.mu > 0 and E * (0.5 * g["G"] * E - chart.e2) > 0 and energy > 1.01 * NO_END * chart.mu):
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
