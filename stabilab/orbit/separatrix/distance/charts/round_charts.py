"""Where a loop on a circle comes round to its saddle again, and where it passes opposite to it: charts with y told from there.

On a circle much wider than the distance no doubles near pi and 2 pi tell its places apart. After a whole turn a loop has the same place, and
phi is less by 2 |mu| 2 pi/n^2. Opposite to the saddle the place (X, Z) is that of the chart turned by pi: with (X', Z') = -(X, Z) and y from
there

    phi = phi of the chart at (X', Z') + (2/n^2) [mu (y - y') - 2 c X' + 2 d Z'],

and its distance from the state is that of (X', Z') from the state's mirror image in the centre, from which the branch of saddles is told.
"""
from __future__ import annotations

import math

from ..point import UNIT, Point, Seen, gap_of, seen_as
from .bends import loop_bends, turned, widened
from .loop_chart import Chart
from .sharp import opposite_place


class TurnedChart(Chart):
    """A sheet beside the saddles, after a whole turn back."""

    from_saddle, turns = False, -1

    def on_sheet(self, t, y):
        return Chart(self.seen, self.curve, self.t, (-2 * math.pi, 0.0)), t, y - 2 * math.pi


class OppositeChart(Chart):
    """A sheet beside the places opposite to the saddles, after half a turn back; `seen` and the curve are of the state's mirror image."""

    from_saddle, turns = False, -0.5

    def on_sheet(self, t, y):
        return _FromSaddle(self.seen, self.curve, self.t, self.y), t, y - math.pi

    def place(self, t, y):
        u, v, w = super().place(t, y)
        return -u, -v, w

    def point(self, t, y) -> Point:
        p, g = super().point(t, y), self.here
        c, d, k = g["c"], g["d"], 4 / g["n2"]
        at = self.curve.at(t)
        s, half = self.seen.geometry.turn(y)
        q = 1 - 2 * half * half
        X, Z, Xt, Zt = at.x * q + at.z * s, at.z * q - at.x * s, at.xt * q + at.zt * s, at.zt * q - at.xt * s
        phi = p.phi + k * (d * Z - c * X)
        C, D, size, slopes = abs(c), abs(d), at.sx + at.sz, abs(at.xt) + abs(at.zt)
        off_phi = p.off[1] + k * UNIT * (C + D) * size + UNIT * abs(p.phi)
        gap, off_w = gap_of(phi, off_phi, g["w"])
        rough = (*p.rough[:2], p.rough[2] + k * UNIT * (C + D) * slopes, p.rough[3] + k * UNIT * (C + D) * size)
        return Point(p.apart, p.apart_t, p.apart_y, phi, p.phi_t + k * (d * Zt - c * Xt), p.phi_y - k * (d * X + c * Z), gap,
                     (p.off[0], off_phi, off_w), rough)

    def sharp(self, numbers, g, t, y):
        return opposite_place(g, self.seen.geometry, self.curve.sharp(numbers, g, t), y, -numbers.pi())

    def bends(self, t, dt, y, dy):
        g = self.here
        c, d, k = g["c"], g["d"], 4 / g["n2"]
        x, rx, z, rz, x1, rx1, z1, rz1, x2, rx2, z2, rz2 = self.curve.over(t, dt)[:12]
        s, q, _, rs, rq = self.seen.geometry.turns(y, dy)
        turn = s, q, rs, rq
        X, rX, Z, rZ = turned(-1, turn, x, rx, z, rz)
        X1, rX1, Z1, rZ1 = turned(-1, turn, x1, rx1, z1, rz1)
        X2, rX2, Z2, rZ2 = turned(-1, turn, x2, rx2, z2, rz2)
        C, D = abs(c), abs(d)
        more = ((d * Z2 - c * X2, D * rZ2 + C * rX2), (-d * X1 - c * Z1, D * rX1 + C * rZ1), (c * X - d * Z, C * rX + D * rZ))
        own = loop_bends(self.seen, self.curve, t, dt, y, dy)
        return (*own[:3], *widened((m + k * n, r + k * o + 1e-15 * k * abs(n)) for (m, r), (n, o) in zip(own[3:], more)))


class _FromSaddle(Chart):
    """The loops of the opposite chart from their saddles on, which a shade asks for phi."""

    def at_one(self, t, y):
        return OppositeChart(self.seen, self.curve, (t, t), self.y), t, y + math.pi


def mirrored(seen: Seen) -> Seen:
    """The reduction seen from the state's mirror image in the centre of the circles."""
    return seen_as(seen.geometry, seen.exact | {"X": -seen.exact["X"], "Z": -seen.exact["Z"]}, seen.touched)
