"""The neighbourhood of a point of a sheet that no doubles of t and y name: a chart in offsets from it, with points in balls."""
from __future__ import annotations

import math
from fractions import Fraction

EPS = 2.0**-52
COARSE = 2.0**-24  # of a parameter and its range: what doubles tell apart easily
FAR = 8.0  # squared distances at the edge of the neighbourhood, in units of the least one


class Beside:
    """Offsets from the exact place (t, y) of a chart, within its rectangle."""

    sharpest, from_saddle = True, False

    def __init__(self, chart, t, y, dt, dy, inner):
        self.chart, self.t0, self.y0, self.seen, self.inner = chart, t, y, chart.seen, inner
        self.near = float(t), float(y)
        self.t, self.y = _within(t, dt, *chart.t), _within(y, dy, *chart.y)

    @staticmethod
    def of(chart, t, y, w0, goal):
        """The neighbourhood at whose edge the squared distance is some times the least one; None where it has no size."""
        p = chart.exact_point(t, y)
        w = math.sqrt(max(p.phi, 0.0))
        (tt, _), _, (yy, _), (f_tt, _), _, (f_yy, _) = chart.bends(float(t), 0.0, float(y), 0.0)
        k = p.gap / w if w > 0 else 0.0
        sizes = [math.sqrt(2 * FAR * goal / bend) if bend > 0 else math.inf for bend in (tt + k * f_tt, yy + k * f_yy)]
        inner = sizes
        sizes = [min(max(size, COARSE * (abs(at) + high - low)), high - low)
                 for size, at, (low, high) in zip(sizes, (float(t), float(y)), (chart.t, chart.y))]
        return Beside(chart, t, y, *sizes, inner) if min(sizes) > 0 and all(map(math.isfinite, sizes)) else None

    def boxes(self):
        """The box about the place where squared distances are some times the least, and frames about it, each sixteen times as wide: a
        box that reaches far beyond would lose the least distance to rounding."""
        (t, y), last = self.inner, None
        while True:
            (t0, t1), (y0, y1) = ((max(-size, low), min(size, high)) for size, (low, high) in zip((t, y), (self.t, self.y)))
            if last is None:
                yield self._of(t0, t1, y0, y1)
            else:
                (a0, a1), (b0, b1) = last
                for sides in ((t0, a0, y0, y1), (a1, t1, y0, y1), (a0, a1, y0, b0), (a0, a1, b1, y1)):
                    if sides[0] < sides[1] and sides[2] < sides[3]:
                        yield self._of(*sides)
            if (t0, t1) == self.t and (y0, y1) == self.y:
                return
            last, t, y = ((t0, t1), (y0, y1)), 16 * t, 16 * y

    def _of(self, t0, t1, y0, y1):
        return self, 0.5 * (t0 + t1), 0.5 * (t1 - t0), 0.5 * (y0 + y1), 0.5 * (y1 - y0)

    def covers(self, chart, t, dt, y, dy):
        """Whether a box of the chart lies in the neighbourhood."""
        if chart is not self.chart:
            return False
        (t0, t1), (y0, y1) = self.t, self.y
        return (t0 <= float(t - dt - self.t0) and float(t + dt - self.t0) <= t1
                and y0 <= float(y - dy - self.y0) and float(y + dy - self.y0) <= y1)

    def on_sheet(self, t, y):
        """The chart that this one is a part of, and where on it a point lies to doubles."""
        return self.chart.on_sheet(*self._on_chart(t, y))

    def _on_chart(self, t, y):
        return self.near[0] + t, self.near[1] + y

    def exact_point(self, t, y):
        return self.chart.exact_point(self.t0 + Fraction(t), self.y0 + Fraction(y))

    point = exact_point

    def place(self, t, y):
        return self.chart.exact_place(self.t0 + Fraction(t), self.y0 + Fraction(y))

    def _box(self, t, dt, y, dy):
        t, y = self._on_chart(t, y)
        return t, dt + 2 * EPS * abs(t), y, dy + 2 * EPS * abs(y)

    def bends(self, t, dt, y, dy):
        return self.chart.bends(*self._box(t, dt, y, dy))

    def misses(self, t, dt, y, dy, upper):
        return self.chart.misses(*self._box(t, dt, y, dy), upper)

    def folded(self, t, dt, y, dy):
        return self.chart.folded(*self._box(t, dt, y, dy))

    def coarse(self, t, dt, y, dy):
        return self.chart.coarse(*self._box(t, dt, y, dy))

    def steep(self, t, dt, y, dy):
        return self.chart.steep(*self._box(t, dt, y, dy))

    def holds(self, t, y):
        return self.chart.holds(*self._on_chart(t, y))


def _within(place, size, low, high):
    """The offsets from the place, no farther than the size, that stay within [low, high]."""
    return max(-size, float(low - place)), min(size, float(high - place))
