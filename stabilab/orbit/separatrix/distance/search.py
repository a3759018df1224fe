"""The least distance over boxes of a chart, by bisection with proved bounds and Newton steps.

Smooth functions below the squared distance over a box, and their least values.

The squared distance of a state from the point (t, y) of a branch is D = R + (sqrt(phi) - w0)^2, with R in the
plane of the orbit and phi = W^2. Its root is taken out by duality: for every multiplier k < 1 and all phi >=
0

    D >= R + k phi + min over s >= 0 of [(1 - k) s^2 - 2 w0 s + w0^2],

and the right-hand side is smooth in (t, y), where W = 0 too; with k = 1 - w0/sqrt(phi) it touches D.

The nearest point of the branches of a separatrix: branch and bound over their parameters, with a proved lower
bound.

A box is done with when its second-order Taylor bound (`forms`) exceeds the least distance found; where the
Hessian is positive definite all over the box the bound is that of the convex quadratic, so no cluster of
boxes gathers about the nearest point: a rectangle with that point in its middle is tried first, and what lies
within it needs no boxes. A point whose rounding in doubles would decide is looked at in balls; a nearest
point that lies between doubles is gone round in offsets from an exact place (`beside`).
"""
from __future__ import annotations

import heapq
import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any, NamedTuple

# --- The neighbourhood of a point of a branch that no doubles of t and y name: a chart in offsets from it,
# with points in balls
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
        """The neighbourhood at whose edge the squared distance is some times the least one; None where it has
        no size."""
        p = chart.exact_point(t, y)
        w = math.sqrt(max(p.phi, 0.0))
        (tt, _), _, (yy, _), (f_tt, _), _, (f_yy, _) = chart.bends(float(t), 0.0, float(y), 0.0)
        k = p.gap / w if w > 0 else 0.0
        sizes = [math.sqrt(2 * FAR * goal / bend) if bend > 0 else math.inf
                 for bend in (tt + k * f_tt, yy + k * f_yy)]
        inner = sizes
        sizes = [min(max(size, COARSE * (abs(at) + high - low)), high - low)
                 for size, at, (low, high) in zip(sizes, (float(t), float(y)), (chart.t, chart.y))]
        return (Beside(chart, t, y, *sizes, inner) if min(sizes) > 0 and all(map(math.isfinite, sizes))
                else None)

    def boxes(self):
        """The box about the place where squared distances are some times the least, and frames about it, each
        sixteen times as wide: a box that reaches far beyond would lose the least distance to rounding."""
        (t, y), last = self.inner, None
        while True:
            (t0, t1), (y0, y1) = ((max(-size, low), min(size, high)) for size,
                                  (low, high) in zip((t, y), (self.t, self.y)))
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

    def on_branch(self, t, y):
        """The chart that this one is a part of, and where on it a point lies to doubles."""
        return self.chart.on_branch(*self._on_chart(t, y))

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


class Form(NamedTuple):
    """A function below D over a box: value and slopes at its middle, the Hessian's entries (middle, radius)
    over it, rounding."""

    value: float
    t: float
    y: float
    bends: Sequence[Any]
    off: float

    def least(self, dt, dy):
        return under(self.value, self.t, self.y, *self.bends, dt, dy) - self.off

    def way(self, dt, dy):
        """The side of the box that the bound loses most by."""
        tt, _, yy = self.bends
        return (0 if (abs(self.t) + (abs(tt[0]) + tt[1]) * dt) * dt
                >= (abs(self.y) + (abs(yy[0]) + yy[1]) * dy) * dy else 1)


class Box(NamedTuple):
    """A box |t - middle| <= dt, |y - middle| <= dy of a chart: its middle y (0 where no saddle stands at y =
    0), the point there, bounds of the second derivatives of R and phi, and the least and greatest W =
    sqrt(phi) of it; swing: how far phi goes from the middle's."""

    y: float
    dt: float
    dy: float
    p: Any
    r: tuple
    f: tuple
    swing: float
    w_low: float
    w_high: float

    def flat(self, w0) -> Form:
        """R and the least (W - w0)^2 of the box."""
        beside = max(self.w_low - w0, w0 - self.w_high, 0.0)
        return Form(self.p.apart + beside * beside, self.p.apart_t, self.p.apart_y, self.r, self._off_r())

    def forms(self, w0):
        for k, part, touch in self._multipliers(w0):
            yield self._form(w0, k, part, touch)
        # beside the saddle: W <= sqrt(m) |y|, as phi and its slope vanish there
        if self.y and abs(self.y) == self.dy:
            p, m = self.p, 0.5 * max(self.f[2][0] + self.f[2][1], 0.0)
            pull = 2 * w0 * math.sqrt(m) * (1 + 1e-12)
            yield Form(p.apart + w0 * w0 - pull * abs(self.y), p.apart_t,
                       p.apart_y - math.copysign(pull, self.y), self.r,
                       self._off_r() + 4e-16 * (w0 * w0 + pull * abs(self.y)))

    def _form(self, w0, k, part, touch):
        """That of the multiplier k with its least at W = s = w0 + part."""
        p, s = self.p, w0 + part
        # phi - s^2 without cancellation
        over = (p.gap - part) * (2 * w0 + p.gap + part) if p.phi > 0 else p.phi - s * s
        off_over = (min(p.off[1], p.off[2] * (2 * w0 + 2 * abs(p.gap) + abs(part) + p.off[2])) if p.phi > 0
                    else p.off[1])
        off = (self._off_r() + abs(k) * (off_over + p.rough[2] * self.dt + p.rough[3] * self.dy)
               + 2e-15 * (part * part + abs(k * over)) + (4e-16 * abs(k) * s * s if not p.phi > 0 else 0.0))
        bends = [(a[0] + k * b[0], a[1] + abs(k) * b[1]) for a, b in zip(self.r, self.f)]
        if touch and w0 > 0:  # the root is concave: its curvature over the box bends D upward
            bends = self._bent(bends, 0.25 * w0 / (self.w_high * self.w_high * self.w_high))
        return Form(p.apart + part * part + k * over, p.apart_t + k * p.phi_t, p.apart_y + k * p.phi_y, bends,
                    off)

    def _off_r(self):
        return self.p.off[0] + self.p.rough[0] * self.dt + self.p.rough[1] * self.dy

    def _multipliers(self, w0):
        """(k, W - w0 at the least of its form, whether the form touches D at the middle)."""
        p = self.p
        low, high = self.w_low - w0, self.w_high - w0
        if w0 == 0:
            yield 1.0, p.gap, False
        elif p.phi > 0:
            yield p.gap / (w0 + p.gap), p.gap, True
            part = min(max(self._least_gap(w0), low), high)
            if part != p.gap and w0 + part > 0:
                yield part / (w0 + part), part, False
        a, b = p.phi_t * self.dt, p.phi_y * self.dy
        square = a * a + b * b
        if square > 0:
            k = min(-(p.apart_t * self.dt * a + p.apart_y * self.dy * b) / square, 0.999 if w0 else 1.0)
            yield k, min(max(k * w0 / (1 - k), low), high) if k < 1 else high, False

    def _least_gap(self, w0):
        """W - w0 where the model with R quadratic and W linear over the box is least."""
        p, w = self.p, w0 + self.p.gap
        wt, wy = 0.5 * p.phi_t / w, 0.5 * p.phi_y / w
        (tt, _), (ty, _), (yy, _) = self.r
        a, m, b = tt + 2 * wt * wt, ty + 2 * wt * wy, yy + 2 * wy * wy
        g1, g2 = p.apart_t + 2 * p.gap * wt, p.apart_y + 2 * p.gap * wy
        det = a * b - m * m
        if not (a > 0 and b > 0 and det > 0):
            return p.gap
        t, y = (m * g2 - b * g1) / det, (m * g1 - a * g2) / det
        if abs(t) > self.dt:
            t = math.copysign(self.dt, t)
            y = -(g2 + m * t) / b
        if abs(y) > self.dy:
            y = math.copysign(self.dy, y)
            t = min(max(-(g1 + m * y) / a, -self.dt), self.dt)
        return p.gap + wt * t + wy * y

    def _bent(self, bends, c):
        """The Hessian with c (phi - phi_c)^2 added, c >= 0."""
        ((tt, rtt), (ty, rty), (yy, ryy)), p, dt, dy, swing = self.f, self.p, self.dt, self.dy, self.swing
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
    a, b, most = a - ra, b - rb, rm * d1 * d2
    box = max(_crossed(g1, g2, a, b, m, d1, d2), _crossed(g2, g1, b, a, m, d2, d1)) - most
    if d1 > 0 and d2 > 0:
        box = max(box, _convex(g1, g2, a - rm * d2 / d1, b - rm * d1 / d2, m, d1, d2))
    return value + box


def _convex(g1, g2, a, b, m, d1, d2):
    """The same of g.d + d.H.d/2 as a convex quadratic, made one where it is nearly one: where two nearest
    points merge, it bends by nothing one way."""
    if not (a > 0 and b > 0):
        return -math.inf
    det, loss = a * b - m * m, 0.0
    if not det > 1e-9 * a * b:
        more = abs(m) / math.sqrt(a * b) * (1 + 1e-8) - 1
        if more > 0.25:
            return -math.inf
        loss, a, b = 0.5 * more * (a * d1 * d1 + b * d2 * d2), a * (1 + more), b * (1 + more)
        det = a * b - m * m
    t, y = (m * g2 - b * g1) / det, (m * g1 - a * g2) / det
    if abs(t) <= d1 and abs(y) <= d2:
        return -0.5 * (b * g1 * g1 - 2 * m * g1 * g2 + a * g2 * g2) / det - loss
    # the least is on an edge; from a place near it, by the tangent plane there, which a convex function stays
    # above
    best = -math.inf
    t, y = math.copysign(d1, t), math.copysign(d2, y)
    for s, z in ((t, min(max(-(g2 + m * t) / b, -d2), d2)), (min(max(-(g1 + m * y) / a, -d1), d1), y)):
        u, v = g1 + a * s + m * z, g2 + m * s + b * z
        best = max(best, 0.5 * ((g1 + u) * s + (g2 + v) * z) - u * s - v * z - abs(u) * d1 - abs(v) * d2)
    return best - loss


def _crossed(g1, g2, a, b, m, d1, d2):
    """The least over the second of (g2 + m d1) d2 + b d2^2/2, at an edge unless b bends up, then over the
    first."""
    bend = 0.5 * b * d2 * d2 if b < 0 else 0.0
    return min(g2 * d2 + _least(g1 + m * d2, a, d1), _least(g1 - m * d2, a, d1) - g2 * d2) + bend


def _least(g, h, d):
    if h > 0 and abs(g) < h * d:
        return -0.5 * g * g / h
    return -abs(g) * d + 0.5 * h * d * d


# --- Newton's method for the nearest point of a branch
def descent(chart, t, y, w0, steps=30, exact=False):
    """Places on the way of Newton's method for the conditions of a least distance in (t, y, W - w0, k):
    stationary R + (W - w0)^2 on phi = W^2, which are regular where W = 0 too; it stays in the rectangle and
    yields each place.

    exact: with points in balls and places as Fractions; the slopes' own slopes in doubles cost steps, not
    digits.
    """
    (t0, t1), (y0, y1) = chart.t, chart.y
    point, step_of = (chart.exact_point, Fraction) if exact else (chart.point, float)
    t, y, p = step_of(t), step_of(y), point(t, y)
    gap = p.gap
    k = gap / (w0 + gap) if w0 + gap > 0 else 0.0
    last = math.inf
    for _ in range(steps):
        rows = _conditions(p, chart.bends(float(t), 0.0, float(y), 0.0), w0, gap, k)
        gt, gy = -rows[0][4], -rows[1][4]
        free_t = not ((t <= t0 and gt > 0) or (t >= t1 and gt < 0)) and t1 > t0
        free_y = not ((y <= y0 and gy > 0) or (y >= y1 and gy < 0))
        keep = [n for n, free in enumerate((free_t, free_y, True, True)) if free]
        moves = _solved([[rows[i][j] for j in (*keep, 4)] for i in keep])
        if moves is None:
            return
        step = [0.0] * 4
        for n, move in zip(keep, moves):
            step[n] = move
        share = min(1.0, 0.25 * (t1 - t0) / abs(step[0]) if step[0] else 1.0,
                    0.25 * (y1 - y0) / abs(step[1]) if step[1] else 1.0)
        if not math.isfinite(share * (step[0] + step[1])):
            return
        t, y = min(max(t + step_of(share * step[0]), t0), t1), min(max(y + step_of(share * step[1]), y0), y1)
        gap, k = gap + share * step[2], k + share * step[3]
        gap = gap if w0 + gap >= 0 else -2 * w0 - gap
        if chart.folded(float(t), 0.0, float(y), 0.0):
            return
        p = point(t, y)
        if not all(map(math.isfinite, (gap, k, p.apart, p.phi))):
            return
        yield t, y
        size = abs(step[0]) / (abs(t1 - t0) + 1e-300) + abs(step[1]) / (abs(y1 - y0) + 1e-300)
        if size < (1e-40 if exact else 1e-15) or (size >= last and size < 1e-10):
            return
        last = size


def _conditions(p, bends, w0, gap, k):
    """Rows of the linear system for steps of (t, y, W - w0, k) to where L = R + (W - w0)^2 + k (phi - W^2) is
    stationary; the right-hand side last."""
    (r_tt, _), (r_ty, _), (r_yy, _), (f_tt, _), (f_ty, _), (f_yy, _) = bends
    w = w0 + gap
    # W^2 - phi without cancellation
    lift = (gap - p.gap) * (2 * w0 + gap + p.gap) if p.phi > 0 else w * w - p.phi
    return [[r_tt + k * f_tt, r_ty + k * f_ty, 0.0, p.phi_t, -(p.apart_t + k * p.phi_t)],
            [r_ty + k * f_ty, r_yy + k * f_yy, 0.0, p.phi_y, -(p.apart_y + k * p.phi_y)],
            [0.0, 0.0, 2 - 2 * k, -2 * w, -2 * gap + 2 * k * w], [p.phi_t, p.phi_y, -2 * w, 0.0, lift]]


def _solved(rows):
    """The solution of a small linear system, rows with the right-hand side last; None where it is singular.
    """
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


CLOSE = 4e-10  # of the distance: lower bound and witness are brought so near
INF = math.inf
TINY = 2.0**-50  # of a parameter: boxes are not halved further
MOST = 6000  # boxes; what is not closed by then is told as a bracket
TRIES, SHRUNK = 6, 0.4  # rectangles about the nearest point found, each so much smaller than the one before


class Nearest(NamedTuple):
    """The distance lies in [lower, upper]; upper: of the point (t, y) of the chart; boxes: how many were
    looked at."""

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
    """Branch and bound over charts, from a known upper bound of the distance; start: (chart, t, y) of a point
    as near, if on a chart.

    genuine: the `shade.Shade` that tells which points of the rectangles belong to the separatrix (None: all
    do).
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
        # (at, dt, dy): the rectangle about the witness `at` that holds nothing nearer
        self.clear: tuple = (None, 0.0, 0.0)
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
            if not chart.sharpest and (dt <= TINY * (abs(t) + dt) and dy <= TINY * (abs(y) + dy) or low < 0
                                       and dt + dy < 1e-12):
                stuck = min(stuck, low)  # no smaller box: doubles of t and y do not tell the rest apart
                continue
            if (dt, dy)[way] <= TINY * (abs((t, y)[way]) + (dt, dy)[way]):  # no double lies between
                way = 1 - way
            for side in (-0.5, 0.5):
                box = (chart, t + side * dt, 0.5 * dt, y,
                       dy) if way == 0 else (chart, t, dt, y + side * dy, 0.5 * dy)
                low, new = self.bound(*box)
                boxes += 1
                if low < self.goal:
                    heapq.heappush(heap, (low, boxes, new, box))
        return self.found(min(stuck, self.goal), boxes)

    def clear_about_the_witness(self, chart, dt, dy) -> int:
        """Look for a rectangle about the nearest point, at most 2 dt by 2 dy, that holds nothing nearer; the
        number of boxes looked at."""
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
        return (at is self.at and chart is at[0] and abs(t - at[1]) + dt <= wide
                and abs(y - at[2]) + dy <= high)

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
        # rounding would tell how near it is
        if p.off[0] + p.off_square(self.w) > 0.05 * CLOSE * self.goal and not chart.sharpest:
            p = chart.exact_point(t, y)
            if p.phi < -p.off[1]:
                return False
        distance = math.sqrt(p.apart + p.off[0] + p.gap * p.gap + p.off_square(self.w)) * (1 + 4e-16)
        if not distance < self.upper or (self.genuine and not self.genuine(*chart.on_branch(t, y))):
            return False
        self.upper, self.at = distance, (chart, t, y)
        self.goal = (distance * (1 - CLOSE)) ** 2
        return True

    def bound(self, chart, t, dt, y, dy):
        """(lower bound of D over a box, inf where it holds no point; 0 or 1: the side that is better halved).
        """
        if (self.hole is not None and self.hole.covers(chart, t, dt, y, dy)
            or self.cleared(chart, t, dt, y, dy)
                or chart.misses(t, dt, y, dy, self.upper)):
            return INF, 0
        if chart.folded(t, dt, y, dy):
            return chart.coarse(t, dt, y, dy), 0 if chart.steep(t, dt, y, dy) else 1
        p = chart.point(t, y)
        if p.phi > 0 and p.apart + p.gap * p.gap < self.goal:
            self.better(chart, t, y)
        bends = chart.bends(t, dt, y, dy)
        # beyond the doubles nothing is known but D >= 0
        if not math.isfinite(sum(abs(middle) + radius for middle, radius in bends)):
            return 0.0, 0 if chart.steep(t, dt, y, dy) else 1
        low, way, rough = self._bound(chart, t, dt, y, dy, p, bends)
        if low < self.goal and rough and not chart.sharpest:
            low, way, _ = self._bound(chart, t, dt, y, dy, chart.exact_point(t, y), bends)
        return low, way

    def _bound(self, chart, t, dt, y, dy, p, bends):
        w0, r, f = self.w, bends[:3], bends[3:]
        swing = ((abs(p.phi_t) + p.rough[2]) * dt + (abs(p.phi_y) + p.rough[3]) * dy
                 + 0.5 * (abs(f[0][0]) + f[0][1]) * dt * dt
                 + (abs(f[1][0]) + f[1][1]) * dt * dy + 0.5 * (abs(f[2][0]) + f[2][1]) * dy * dy + p.off[1])
        high = p.phi + swing
        if high < 0:
            return INF, 0, False
        box = Box(y if chart.from_saddle else 0.0, dt, dy, p, r, f, swing, math.sqrt(max(p.phi - swing, 0.0)),
                  math.sqrt(high))
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
                    on, at_t, at_y = chart.on_branch(t, y)
                    best = self.genuine.bound(self, form, best, on, at_t, dt, at_y, dy)
        # without the rounding at the middle the box might be done with, or hold no rate at all
        rough = best + 4 * form.off >= self.goal or p.off[1] > 0.25 * swing
        return best, self._way(box, form, form is first), rough

    def _way(self, box, form, flat):
        """The side of a box that is better halved."""
        p, dt, dy = box.p, box.dt, box.dy
        if self._far_reaching(box):
            along, across = (abs(s) * d + 0.5 * (abs(m) + n) * d * d for s, (m, n),
                             d in ((p.phi_t, box.f[0], dt), (p.phi_y, box.f[2], dy)))
            return 0 if along >= across else 1
        if not flat and self.w <= 2 * box.w_high:
            return form.way(dt, dy)
        # this bound loses by the range of W as well: D changes by (W - w0)/W times phi, and where W stays far
        # below the state's own that is most of it
        share = (abs(p.gap) + box.w_high - box.w_low) / (box.w_high + 1e-300)
        return form._replace(t=abs(p.apart_t) + share * abs(p.phi_t), y=abs(p.apart_y) + share * abs(p.phi_y),
                             bends=[
            (abs(a[0]) + a[1] + share * (abs(b[0]) + b[1]), 0.0) for a, b in zip(box.r, box.f)]).way(dt, dy)

    def _far_reaching(self, box):
        """Whether W goes from near zero to far above the state's own over a box: near a cone's tip or a fold
        the root of phi then decides the bound, and halving the side that phi changes along comes to the
        state's own W in a few steps."""
        return (4 * self.w < box.w_high and 4 * box.w_low < box.w_high
                and self.w * box.w_high > 0.1 * CLOSE * self.goal)
