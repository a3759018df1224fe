"""The nearest point of the sheets of a separatrix: branch and bound over their parameters, with a proved lower bound.

A box is done with when its second-order Taylor bound (`forms`) exceeds the least distance found; where the Hessian is positive
definite all over the box the bound is that of the convex quadratic, so no cluster of boxes gathers about the nearest point: a
rectangle with that point in its middle is tried first, and what lies within it needs no boxes.
A point whose rounding in doubles would decide is looked at in balls; a nearest point that lies between doubles is gone round
in offsets from an exact place (`beside`).
"""
from __future__ import annotations

import heapq
import math
from typing import Any, NamedTuple

from .beside import Beside
from .forms import Box
from .newton import descent

CLOSE = 4e-10  # of the distance: lower bound and witness are brought so near
INF = math.inf
TINY = 2.0**-50  # of a parameter: boxes are not halved further
MOST = 6000  # boxes; what is not closed by then is told as a bracket
TRIES, SHRUNK = 6, 0.4  # rectangles about the nearest point found, each so much smaller than the one before


class Nearest(NamedTuple):
    """The distance lies in [lower, upper]; upper: of the point (t, y) of the chart; boxes: how many were looked at."""

    lower: float
    upper: float
    chart: Any
    t: float
    y: float
    boxes: int

    @property
    def closed(self):
        return self.upper - self.lower <= 2 * CLOSE * self.upper


def nearest(charts, state_w, upper, most=MOST, genuine=None, start=None) -> Nearest:
    """Branch and bound over charts, from a known upper bound of the distance; start: (chart, t, y) of a point as near, if on a chart.

    genuine: the `shade.Shade` that tells which points of the rectangles belong to the separatrix (None: all do).
    """
    charts = list(charts)
    search = _Search(state_w, upper, genuine, start)
    found = search.run(charts, most)
    if found.closed or found.chart is None:
        return found
    again = search.round_the_witness()
    if again is None:
        return found
    closer = search.run([*charts, again], most, again)
    return closer._replace(lower=max(found.lower, closer.lower), boxes=found.boxes + closer.boxes)


class _Search:
    def __init__(self, w, upper, genuine, start):
        self.w, self.upper, self.genuine, self.hole = w, upper, genuine, None
        self.at = start or (None, 0.0, 0.0)
        self.clear: tuple = (None, 0.0, 0.0)  # (at, dt, dy): the rectangle about the witness `at` that holds nothing nearer
        self.goal = (upper * (1 - CLOSE)) ** 2

    def run(self, charts, most, hole=None):
        """Halve the most promising box until none is; hole: a `Beside` that covers a part of its chart."""
        self.hole = hole
        heap, boxes, stuck = [], 0, INF
        for box in (box for chart in charts for box in chart.boxes()):
            low, way = self.bound(*box)
            boxes += 1
            heapq.heappush(heap, (low, boxes, way, box))
        while heap and heap[0][0] < self.goal:
            low, _, way, (chart, t, dt, y, dy) = heapq.heappop(heap)
            if boxes > most:
                return self.found(min(low, stuck), boxes)
            if self.clear[0] is not self.at and self.at[0] is chart and hole is None:
                boxes += self.clear_about_the_witness(chart, dt, dy)
            if not chart.sharpest and (dt <= TINY * (abs(t) + dt) and dy <= TINY * (abs(y) + dy) or low < 0 and dt + dy < 1e-12):
                stuck = min(stuck, low)  # no smaller box: doubles of t and y do not tell the rest apart
                continue
            if (dt, dy)[way] <= TINY * (abs((t, y)[way]) + (dt, dy)[way]):  # no double lies between
                way = 1 - way
            for side in (-0.5, 0.5):
                box = (chart, t + side * dt, 0.5 * dt, y, dy) if way == 0 else (chart, t, dt, y + side * dy, 0.5 * dy)
                low, new = self.bound(*box)
                boxes += 1
                if low < self.goal:
                    heapq.heappush(heap, (low, boxes, new, box))
        return self.found(min(stuck, self.goal), boxes)

    def clear_about_the_witness(self, chart, dt, dy) -> int:
        """Look for a rectangle about the nearest point, at most 2 dt by 2 dy, that holds nothing nearer; the number of boxes looked at."""
        at = _, t, y = self.at
        self.clear = at, 0.0, 0.0
        dy = min(dy, abs(y)) if chart.from_saddle else dy
        for tried in range(1, TRIES + 1 if dy else 1):
            if self.bound(chart, t, dt, y, dy)[0] >= self.goal:
                self.clear = at, dt, dy
                return tried
            dt, dy = SHRUNK * dt, SHRUNK * dy
        return TRIES

    def cleared(self, chart, t, dt, y, dy) -> bool:
        """Whether a box lies within the rectangle about the nearest point."""
        at, wide, high = self.clear
        return at is self.at and chart is at[0] and abs(t - at[1]) + dt <= wide and abs(y - at[2]) + dy <= high

    def found(self, square, boxes):
        """square: a bound that no point's squared distance is below."""
        lower = min(math.sqrt(max(square, 0.0)) * (1 - 1e-15), self.upper)
        return Nearest(lower, self.upper, *self.at, boxes)

    def round_the_witness(self):
        """The neighbourhood of the nearest point, in exact arithmetic."""
        chart, t, y = self.at
        for place in descent(chart, t, y, self.w, steps=12, exact=True):
            t, y = place
        again = Beside.of(chart, t, y, self.w, self.goal)
        if again is not None:
            self._take(again, 0.0, 0.0)
        return again

    def better(self, chart, t, y):
        """Take the point, and where Newton's method leads from it, if it is nearer."""
        here = self._take(chart, t, y)
        if here:
            for place in descent(chart, t, y, self.w):
                self._take(chart, *place)
        return here

    def _take(self, chart, t, y):
        if not chart.holds(t, y):
            return False
        p = chart.point(t, y)
        if p.phi < -p.off[1] or p.apart - p.off[0] > self.goal:
            return False
        if p.off[0] + p.off_square(self.w) > 0.05 * CLOSE * self.goal and not chart.sharpest:  # rounding would tell how near it is
            p = chart.exact_point(t, y)
            if p.phi < -p.off[1]:
                return False
        distance = math.sqrt(p.apart + p.off[0] + p.gap * p.gap + p.off_square(self.w)) * (1 + 4e-16)
        if not distance < self.upper or (self.genuine and not self.genuine(*chart.on_sheet(t, y))):
            return False
        self.upper, self.at = distance, (chart, t, y)
        self.goal = (distance * (1 - CLOSE)) ** 2
        return True

    def bound(self, chart, t, dt, y, dy):
        """(lower bound of D over a box, inf where it holds no point; 0 or 1: the side that is better halved)."""
        if (self.hole is not None and self.hole.covers(chart, t, dt, y, dy) or self.cleared(chart, t, dt, y, dy)
                or chart.misses(t, dt, y, dy, self.upper)):
            return INF, 0
        if chart.folded(t, dt, y, dy):
            return chart.coarse(t, dt, y, dy), 0 if chart.steep(t, dt, y, dy) else 1
        p = chart.point(t, y)
        if p.phi > 0 and p.apart + p.gap * p.gap < self.goal:
            self.better(chart, t, y)
        bends = chart.bends(t, dt, y, dy)
        if not math.isfinite(sum(abs(middle) + radius for middle, radius in bends)):  # beyond the doubles nothing is known but D >= 0
            return 0.0, 0 if chart.steep(t, dt, y, dy) else 1
        low, way, rough = self._bound(chart, t, dt, y, dy, p, bends)
        if low < self.goal and rough and not chart.sharpest:
            low, way, _ = self._bound(chart, t, dt, y, dy, chart.exact_point(t, y), bends)
        return low, way

    def _bound(self, chart, t, dt, y, dy, p, bends):
        w0, r, f = self.w, bends[:3], bends[3:]
        swing = ((abs(p.phi_t) + p.rough[2]) * dt + (abs(p.phi_y) + p.rough[3]) * dy + 0.5 * (abs(f[0][0]) + f[0][1]) * dt * dt
                 + (abs(f[1][0]) + f[1][1]) * dt * dy + 0.5 * (abs(f[2][0]) + f[2][1]) * dy * dy + p.off[1])
        high = p.phi + swing
        if high < 0:
            return INF, 0, False
        box = Box(y if chart.from_saddle else 0.0, dt, dy, p, r, f, swing, math.sqrt(max(p.phi - swing, 0.0)), math.sqrt(high))
        form = first = box.flat(w0)
        best = form.least(dt, dy)
        if best < self.goal:
            for other in box.forms(w0):
                if (new := other.least(dt, dy)) > best:
                    best, form = new, other
                if best >= self.goal:
                    break
            else:
                if self.genuine is not None:
                    on, at_t, at_y = chart.on_sheet(t, y)
                    best = self.genuine.bound(self, form, best, on, at_t, dt, at_y, dy)
        # without the rounding at the middle the box might be done with, or hold no rate at all
        rough = best + 4 * form.off >= self.goal or p.off[1] > 0.25 * swing
        return best, self._way(box, form, form is first), rough

    def _way(self, box, form, flat):
        """The side of a box that is better halved."""
        p, dt, dy = box.p, box.dt, box.dy
        if self._far_reaching(box):
            along, across = (abs(s) * d + 0.5 * (abs(m) + n) * d * d for s, (m, n), d in ((p.phi_t, box.f[0], dt), (p.phi_y, box.f[2], dy)))
            return 0 if along >= across else 1
        if not flat and self.w <= 2 * box.w_high:
            return form.way(dt, dy)
        # this bound loses by the range of W as well: D changes by (W - w0)/W times phi, and where W stays far below the state's own that is most of it
        share = (abs(p.gap) + box.w_high - box.w_low) / (box.w_high + 1e-300)
        return form._replace(t=abs(p.apart_t) + share * abs(p.phi_t), y=abs(p.apart_y) + share * abs(p.phi_y), bends=[
            (abs(a[0]) + a[1] + share * (abs(b[0]) + b[1]), 0.0) for a, b in zip(box.r, box.f)]).way(dt, dy)

    def _far_reaching(self, box):
        """Whether W goes from near zero to far above the state's own over a box: near a cone's tip or a fold the root of phi then
        decides the bound, and halving the side that phi changes along comes to the state's own W in a few steps."""
        return 4 * self.w < box.w_high and 4 * box.w_low < box.w_high and self.w * box.w_high > 0.1 * CLOSE * self.goal
