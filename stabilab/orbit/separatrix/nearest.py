"""The nearest point of the sheets of a separatrix: branch and bound over their parameters, with a proved lower bound.

The squared distance of a state from the point (t, y) of a sheet is D = R + (sqrt(phi) - w0)^2, with R in the plane of the orbit
and phi = W^2 (`sheet_chart`). Its root is taken out by duality: for every multiplier k < 1 and all phi >= 0

    D >= R + k phi + min over s >= 0 of [(1 - k) s^2 - 2 w0 s + w0^2],

and the right-hand side is smooth in (t, y), where W = 0 too; with k = 1 - w0/sqrt(phi) it touches D. A box is done with when
its second-order Taylor bound exceeds the least distance found; where the Hessian is positive definite all over the box the
bound is that of the convex quadratic, so no cluster of boxes gathers about the nearest point.
"""
from __future__ import annotations

import heapq
import math
from typing import Any, NamedTuple

CLOSE = 4e-10  # of the distance: lower bound and witness are brought so near
INF = math.inf
TINY = 2.0**-50  # of a parameter: boxes are not halved further
MOST = 6000  # boxes; what is not closed by then is told as a bracket


class Nearest(NamedTuple):
    """The distance lies in [lower, upper]; upper: of the point (t, y) of the chart; boxes: how many were looked at."""

    lower: float
    upper: float
    chart: Any
    t: float
    y: float
    boxes: int


def nearest(charts, state_w, upper, most=MOST, start=None, genuine=None) -> Nearest:
    """Branch and bound over charts, from a known upper bound of the distance (start: its chart, t and y).

    genuine: the `shade.Shade` that tells which points of the rectangles belong to the separatrix (None: all do).
    """
    search = _Search(state_w, upper, start, genuine)
    heap: list[Any] = []
    boxes, stuck = 0, INF
    for box in (box for chart in charts for box in chart.boxes()):
        low, way = search.bound(*box)
        boxes += 1
        heapq.heappush(heap, (low, boxes, way, box))
    while heap and heap[0][0] < search.goal:
        low, _, way, (chart, t, dt, y, dy) = heapq.heappop(heap)
        if boxes > most:
            return search.found(low, boxes)
        if dt <= TINY * (abs(t) + dt) and dy <= TINY * (abs(y) + dy) or low < 0 and dt + dy < 1e-12:
            stuck = min(stuck, low)  # no smaller box: rounding hides the rest
            continue
        for side in (-0.5, 0.5):
            box = (chart, t + side * dt, 0.5 * dt, y, dy) if way == 0 else (chart, t, dt, y + side * dy, 0.5 * dy)
            low, new = search.bound(*box)
            boxes += 1
            if low < search.goal:
                heapq.heappush(heap, (low, boxes, new, box))
    return search.found(min(stuck, search.goal), boxes)


class _Search:
    def __init__(self, w, upper, start, genuine):
        self.w, self.upper, self.genuine = w, upper, genuine
        self.at = start or (None, 0.0, 0.0)
        self.goal = (upper * (1 - CLOSE)) ** 2

    def found(self, square, boxes):
        """square: a bound that no point's squared distance is below."""
        lower = min(math.sqrt(max(square, 0.0)) * (1 - 1e-15), self.upper)
        return Nearest(lower, self.upper, *self.at, boxes)

    def better(self, chart, t, y):
        """Take the point, and where Newton's method leads from it, if it is nearer."""
        here = self._take(chart, t, y)
        if here:
            for lower_t, lower_y in descent(chart, t, y, self.w):
                self._take(chart, lower_t, lower_y)
        return here

    def _take(self, chart, t, y):
        p = chart.point(t, y)
        if p.phi < -p.off[1]:
            return False
        distance = math.sqrt(p.apart + p.off[0] + p.gap * p.gap + self._off_gap(p))
        if not distance < self.upper or (self.genuine and not self.genuine(chart, t, y)):
            return False
        self.upper, self.at = distance, (chart, t, y)
        self.goal = (distance * (1 - CLOSE)) ** 2
        return True

    def _off_gap(self, p):
        """Error of the square of p.gap: next to W = 0 it is that of phi - 2 w0 sqrt(phi), where the root's own is large."""
        off = p.off[2]
        return min(2 * abs(p.gap) * off + off * off, p.off[1] + 2 * self.w * off)

    def bound(self, chart, t, dt, y, dy):
        """(lower bound of D over a box, inf where it holds no point; 0 or 1: the side that is better halved)."""
        if chart.misses(t, dt, y, dy, self.upper):
            return INF, 0
        p = chart.point(t, y)
        off_r, off_phi, _ = p.off
        if p.phi > 0 and p.apart + p.gap * p.gap < self.goal:
            self.better(chart, t, y)
        r, f = (bends := chart.bends(t, dt, y, dy))[:3], bends[3:]
        swing = (abs(p.phi_t) * dt + abs(p.phi_y) * dy + 0.5 * (abs(f[0][0]) + f[0][1]) * dt * dt
                 + (abs(f[1][0]) + f[1][1]) * dt * dy + 0.5 * (abs(f[2][0]) + f[2][1]) * dy * dy + off_phi)
        high = p.phi + swing
        if high < 0:
            return INF, 0
        w0, w_low, w_high = self.w, math.sqrt(max(p.phi - swing, 0.0)), math.sqrt(high)
        beside = max(w_low - w0, w0 - w_high, 0.0)
        form = first = _Form(p.apart + beside * beside, p.apart_t, p.apart_y, r, off_r)
        best = form.least(dt, dy)
        if best < self.goal:
            for other in self._forms(p, r, f, swing, w_low, w_high, t, dt, y, dy):
                if (new := other.least(dt, dy)) > best:
                    best, form = new, other
                if best >= self.goal:
                    break
            else:
                if self.genuine is not None:
                    best = self.genuine.bound(self, form, best, chart, t, dt, y, dy)
        if self._far_reaching(w_low, w_high):
            along, across = (abs(s) * d + 0.5 * (abs(m) + n) * d * d for s, (m, n), d in ((p.phi_t, f[0], dt), (p.phi_y, f[2], dy)))
            return best, 0 if along >= across else 1
        if form is not first:
            return best, form.way(dt, dy)
        # this bound loses by the range of W as well: D changes by (W - w0)/W times phi
        share = (abs(p.gap) + w_high - w_low) / (w_high + 1e-300)
        return best, form._replace(t=abs(p.apart_t) + share * abs(p.phi_t), y=abs(p.apart_y) + share * abs(p.phi_y), bends=[
            (abs(a[0]) + a[1] + share * (abs(b[0]) + b[1]), 0.0) for a, b in zip(r, f)]).way(dt, dy)

    def _far_reaching(self, w_low, w_high):
        """Whether W goes from near zero to far above the state's own over a box: near a cone's tip or a fold the root of phi then
        decides the bound, and halving the side that phi changes along comes to the state's own W in a few steps."""
        return 4 * self.w < w_high and 4 * w_low < w_high and self.w * w_high > 0.1 * CLOSE * self.goal

    def _forms(self, p, r, f, swing, w_low, w_high, t, dt, y, dy):
        """Smooth functions below D over the box."""
        w0, root = self.w, math.sqrt(max(p.phi, 0.0))
        off_r, off_phi, _ = p.off
        for k in self._multipliers(p, root, dt, dy):
            s = min(max(w0 / (1 - k), w_low), w_high) if k < 1 else w_high
            touch = p.phi > 0 and abs(s - root) <= 1e-15 * s
            value = p.apart + (p.gap * p.gap if touch else (s - w0) ** 2 + k * (p.phi - s * s))
            off = off_r + abs(k) * off_phi + (self._off_gap(p) if touch else
                                              8e-16 * ((s + w0) * abs(s - w0) + abs(k) * (s * s + abs(p.phi))))
            bends = [(a[0] + k * b[0], a[1] + abs(k) * b[1]) for a, b in zip(r, f)]
            if touch and w0 > 0 and abs(s * (1 - k) - w0) <= 1e-14 * w0:  # the root is concave: its curvature over the box bends D upward
                bends = _bent(bends, p, f, swing, 0.25 * w0 / (w_high * w_high * w_high), dt, dy)
            yield _Form(value, p.apart_t + k * p.phi_t, p.apart_y + k * p.phi_y, bends, off)
        if y and abs(y) == dy:  # beside the saddle: W <= sqrt(m) |y|, as phi and its slope vanish there
            m = 0.5 * max(f[2][0] + f[2][1], 0.0)
            pull = 2 * w0 * math.sqrt(m) * (1 + 1e-12)
            yield _Form(p.apart + w0 * w0 - pull * abs(y), p.apart_t, p.apart_y - math.copysign(pull, y), r,
                        off_r + 4e-16 * (w0 * w0 + pull * abs(y)))

    def _multipliers(self, p, root, dt, dy):
        if self.w == 0:
            yield 1.0
        elif root > 0:
            yield 1 - self.w / root
        a, b = p.phi_t * dt, p.phi_y * dy
        square = a * a + b * b
        if square > 0:
            k = -(p.apart_t * dt * a + p.apart_y * dy * b) / square
            yield min(k, 0.999 if self.w else 1.0)


class _Form(NamedTuple):
    """A function below D over a box: value and slopes at its middle, the Hessian's entries (mid, radius) over it, rounding."""

    value: float
    t: float
    y: float
    bends: list
    off: float

    def least(self, dt, dy):
        return under(self.value, self.t, self.y, *self.bends, dt, dy) - self.off

    def way(self, dt, dy):
        """The side of the box that the bound loses most by."""
        tt, _, yy = self.bends
        return 0 if (abs(self.t) + (abs(tt[0]) + tt[1]) * dt) * dt >= (abs(self.y) + (abs(yy[0]) + yy[1]) * dy) * dy else 1


def _bent(bends, p, f, swing, c, dt, dy):
    """The Hessian with c (phi - phi_c)^2 added, c >= 0."""
    (tt, rtt), (ty, rty), (yy, ryy) = f
    a, b = p.phi_t, p.phi_y
    ra = (abs(tt) + rtt) * dt + (abs(ty) + rty) * dy
    rb = (abs(ty) + rty) * dt + (abs(yy) + ryy) * dy
    extra = ((a * a, ra * (2 * abs(a) + ra) + swing * (abs(tt) + rtt)),
             (a * b, ra * (abs(b) + rb) + abs(a) * rb + swing * (abs(ty) + rty)),
             (b * b, rb * (2 * abs(b) + rb) + swing * (abs(yy) + ryy)))
    return [(m + 2 * c * n, r + 2 * c * s) for (m, r), (n, s) in zip(bends, extra)]


def under(value, g1, g2, h11, h12, h22, d1, d2) -> float:
    """A lower bound of value + g.d + d.H.d/2 over |d1| <= d1, |d2| <= d2, for all H within the radii."""
    (a, ra), (m, rm), (b, rb) = h11, h12, h22
    box = _least(g1, a - ra, d1) + _least(g2, b - rb, d2) - (abs(m) + rm) * d1 * d2
    if d1 > 0 and d2 > 0:
        a, b = a - ra - rm * d2 / d1, b - rb - rm * d1 / d2
        det = a * b - m * m
        if a > 0 and det > 1e-9 * a * b:
            box = max(box, -0.5 * (b * g1 * g1 - 2 * m * g1 * g2 + a * g2 * g2) / det)
    return value + box


def _least(g, h, d):
    if h > 0 and abs(g) < h * d:
        return -0.5 * g * g / h
    return -abs(g) * d + 0.5 * h * d * d


def descent(chart, t, y, w0, steps=30):
    """Places on the way of Newton's method for the conditions of a least distance in (t, y, W, k): stationary R + (W - w0)^2 on
    phi = W^2, which are regular where W = 0 too; it stays in the rectangle and yields each place."""
    (t0, t1), (y0, y1) = chart.t, chart.y
    p = chart.point(t, y)
    w = math.sqrt(max(p.phi, 0.0))
    k = 1 - w0 / w if w > 0 else 0.0
    last = math.inf
    for _ in range(steps):
        (r_tt, _), (r_ty, _), (r_yy, _), (f_tt, _), (f_ty, _), (f_yy, _) = chart.bends(t, 0.0, y, 0.0)
        gt, gy = p.apart_t + k * p.phi_t, p.apart_y + k * p.phi_y
        free_t = not ((t <= t0 and gt > 0) or (t >= t1 and gt < 0)) and t1 > t0
        free_y = not ((y <= y0 and gy > 0) or (y >= y1 and gy < 0))
        # unknowns: t, y, W, k of L = R + (W - w0)^2 + k (phi - W^2)
        rows = [[r_tt + k * f_tt, r_ty + k * f_ty, 0.0, p.phi_t, -gt], [r_ty + k * f_ty, r_yy + k * f_yy, 0.0, p.phi_y, -gy],
                [0.0, 0.0, 2 - 2 * k, -2 * w, -2 * (w - w0) + 2 * k * w], [p.phi_t, p.phi_y, -2 * w, 0.0, w * w - p.phi]]
        keep = [n for n, free in enumerate((free_t, free_y, True, True)) if free]
        moves = _solved([[rows[i][j] for j in (*keep, 4)] for i in keep])
        if moves is None:
            return
        step = [0.0] * 4
        for n, move in zip(keep, moves):
            step[n] = move
        share = min(1.0, 0.25 * (t1 - t0) / abs(step[0]) if step[0] else 1.0, 0.25 * (y1 - y0) / abs(step[1]) if step[1] else 1.0)
        t, y = min(max(t + share * step[0], t0), t1), min(max(y + share * step[1], y0), y1)
        w, k = abs(w + share * step[2]), k + share * step[3]
        p = chart.point(t, y)
        if not all(map(math.isfinite, (w, k, p.apart, p.phi))):
            return
        yield t, y
        size = abs(step[0]) / (abs(t1 - t0) + 1e-300) + abs(step[1]) / (abs(y1 - y0) + 1e-300)
        if size < 1e-15 or (size >= last and size < 1e-10):
            return
        last = size


def _solved(rows):
    """The solution of a small linear system, rows with the right-hand side last; None where it is singular."""
    n = len(rows)
    for i in range(n):
        best = max(range(i, n), key=lambda r: abs(rows[r][i]))
        if not rows[best][i]:
            return None
        rows[i], rows[best] = rows[best], rows[i]
        for r in range(i + 1, n):
            f = rows[r][i] / rows[i][i]
            rows[r] = [a - f * b for a, b in zip(rows[r], rows[i])]
    out = [0.0] * n
    for i in reversed(range(n)):
        out[i] = (rows[i][n] - sum(rows[i][j] * out[j] for j in range(i + 1, n))) / rows[i][i]
    return out
