"""The nearest point of the loops of a separatrix: branch and bound over their parameters, with a proved lower
bound.

The loops of a branch of saddles are a surface over two parameters, t of the saddle and y along its loop; a
chart (`charts`) gives of a point the squared distance R in the plane of the orbit and phi = W^2, as balls,
with their derivatives. From a state at the rate w0 the squared distance is D = R + (sqrt(phi) - w0)^2. Its
root is taken out by duality: for every multiplier k < 1 and all phi >= 0

    D >= R + k phi + min over s >= 0 of [(1 - k) s^2 - 2 w0 s + w0^2],

and the right-hand side is smooth in (t, y), where W = 0 too; with k = 1 - w0/sqrt(phi) it touches D. A box is
done with when the second-order Taylor bound of one of these exceeds the least distance found.
"""
from __future__ import annotations

import heapq
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from ...numbers.balls import Unclear

if TYPE_CHECKING:
    from flint import arb

CLOSE = 2e-10  # of the distance: lower bound and witness are brought so near
FINE = 2.0**-44  # of the squared distance: the balls of a point must be so narrow
MAX_BOXES = 12000  # boxes; what is not closed by then is a bracket
STEPS = 20
SLACK = 1e-14  # relative: what some tens of roundings stay far below
INF = math.inf


class Found(NamedTuple):
    """The distance lies in [lower, upper]; at: (chart, t, y) of the point at `upper`, None for the first one
    known."""

    lower: float
    upper: float
    at: Any
    boxes: int


class Values(NamedTuple):
    """R and phi at a point with their slopes in t and y, and W less the state's, in doubles."""

    apart: float
    apart_t: float
    apart_y: float
    phi: float
    phi_t: float
    phi_y: float
    gap: float

    @property
    def square(self):
        """D."""
        return self.apart + self.gap * self.gap


class Form(NamedTuple):
    """A function below D over a box: value and slopes at its middle, and (middle, radius) of its second
    derivatives tt, ty, yy over it."""

    value: float
    t: float
    y: float
    bends: Any

    def least(self, dt: float, dy: float):
        return least_of(self.value, self.t, self.y, *self.bends, dt, dy)

    def side(self, dt: float, dy: float):
        """0 or 1: the side of the box that the bound loses most by."""
        tt, _, yy = self.bends
        return (0 if (abs(self.t) + (abs(tt[0]) + tt[1]) * dt) * dt
                >= (abs(self.y) + (abs(yy[0]) + yy[1]) * dy) * dy else 1)


class Search:
    """From a state at a rate w0 (a ball) and a known upper bound of the distance. hidden: the `Shade` of the
    points of charts that are no part of the separatrix, None where all are."""

    def __init__(self, rate, upper, hidden=None):
        self.rate, self.w0, self.hidden, self.at, self.boxes = rate, float(rate.mid()), hidden, None, 0
        self.set_upper(upper)

    def set_upper(self, upper: float):
        self.upper, self.goal = upper, (upper * (1 - CLOSE)) ** 2

    def run(self, charts) -> Found:
        """Halve the most promising box until none is."""
        heap: list[Any] = []
        for box in ((chart, *box) for chart in charts for box in chart.boxes()):
            self._push(heap, 0.0, box)
        while heap and heap[0][0] < self.goal:
            low, _, side, (chart, t, dt, y, dy) = heapq.heappop(heap)
            if self.boxes > MAX_BOXES:
                return Found(math.sqrt(max(low, 0.0)), self.upper, self.at, self.boxes)
            for middle, half in chart.halves(*((t, dt), (y, dy))[side]) if side else halves(t, dt):
                self._push(heap, low, (chart, t, dt, middle, half) if side else (chart, middle, half, y, dy))
        return Found(min(self.upper * (1 - CLOSE), self.upper), self.upper, self.at, self.boxes)

    def _push(self, heap, low, box):
        self.boxes += 1
        bound, side = self.bound(*box)
        if not bound >= self.goal:
            heapq.heappush(heap, (max(low, bound), self.boxes, side, box))

    def values(self, chart, t, y) -> Values:
        point = chart.point(t, y)
        off, (phi, off_phi) = double(point[0])[1], double(point[3])
        scale = math.sqrt(self.goal)
        if off > FINE * self.goal or off_phi > FINE * scale * max(math.sqrt(max(phi, 0.0)), scale):
            raise Unclear
        gap = (point[3].sqrt() if phi > 0 else 0) - self.rate
        return Values(*(float(value.mid()) for value in (*point, gap)))

    def offer(self, chart, t, y, p=None) -> bool:
        """Take the point if it is nearer."""
        if not chart.holds(t, y):
            return False
        p = p or self.values(chart, t, y)
        if p.phi < 0:
            return False
        distance = math.sqrt(p.square)
        if not distance < self.upper or (self.hidden and self.hidden.hides(chart, t, y)):
            return False
        self.at = chart, t, y
        self.set_upper(distance * (1 + 4 * FINE))
        return True

    def descend(self, chart, t, y):
        """Steps of Newton's method from a point as long as they come nearer."""
        for _ in range(STEPS):
            p, resolved = self.values(chart, t, y), chart.ranges(t, y, INF)
            if not p.phi > 0 or resolved is None or resolved.parts is None:
                return
            r, f = chart.bends(resolved.parts)
            w = math.sqrt(p.phi)
            k, c = p.gap / w, 0.5 * self.w0 / w**3
            slopes = p.apart_t + k * p.phi_t, p.apart_y + k * p.phi_y
            (a, m, b) = (x[0] + k * z[0] + c * s for x, z, s in
                         zip(r, f, (p.phi_t * p.phi_t, p.phi_t * p.phi_y, p.phi_y * p.phi_y)))
            free = [_free(*item) for item in zip((t, y), slopes, (chart.t, chart.y))]
            steps = _newton_step(slopes, a, m, b, free)
            for fraction in (1.0, 0.25, 0.0625):
                at = [min(max(v + fraction * step, low), high) for v, step, (low, high) in
                      zip((t, y), steps, (chart.t, chart.y))]
                if self.offer(chart, *at):
                    break
            else:
                return
            small = sum(abs(g * float(v - old)) for g, v, old in zip(slopes, at, (t, y)))
            t, y = at
            if small < 1e-10 * self.goal:
                return

    def bound(self, chart, t, dt, y, dy):
        """(lower bound of D over a box, inf where it holds no point; 0 or 1: the side that is better halved).
        """
        resolved = chart.ranges(widened(t, dt), widened(y, dy), self.goal)
        if resolved is None or resolved.phi[1] < 0:
            return INF, 0
        best = resolved.apart + self._beside(*resolved.phi) ** 2
        if best >= self.goal or resolved.parts is None:
            return best, resolved.side
        bends = chart.bends(resolved.parts)
        if not all(math.isfinite(m) and math.isfinite(n) for three in bends for m, n in three):
            return best, resolved.side
        p = self.values(chart, t, y)
        if p.phi > 0 and p.square < self.goal and self.offer(chart, t, y, p):
            self.descend(chart, t, y)
        r, f = bends
        swing = (abs(p.phi_t) * dt + abs(p.phi_y) * dy + 0.5 * (abs(f[0][0]) + f[0][1]) * dt * dt
                 + (abs(f[1][0]) + f[1][1]) * dt * dy + 0.5 * (abs(f[2][0]) + f[2][1]) * dy * dy)
        swing += SLACK * (abs(p.phi) + swing)
        low, high = max(resolved.phi[0], p.phi - swing), min(resolved.phi[1], p.phi + swing)
        if high < 0:
            return INF, 0
        w_low, w_high, gaps = math.sqrt(max(low, 0.0)), math.sqrt(high), self._gaps(p, low, high)
        form = flat = Form(p.apart + max(gaps[0], -gaps[1], 0.0) ** 2, p.apart_t, p.apart_y, r)
        best = max(best, flat.least(dt, dy))
        for k in self._multipliers(p, dt, dy) if best < self.goal else ():
            new = self._form(p, r, f, k, *gaps)
            if (bound := new.least(dt, dy)) > best:
                best, form = bound, new
        if self.hidden and best < self.goal:
            best = max(best, self.hidden.bound(self, form, chart, t, dt, y, dy))
        if 4 * self.w0 < w_high and 4 * w_low < w_high and self.w0 * w_high > 0.1 * CLOSE * self.goal:
            # W goes from near zero to far above the state's own: the root of phi decides
            along, across = (abs(s) * d + 0.5 * (abs(m) + n) * d * d for s, (m, n), d in
                             ((p.phi_t, f[0], dt), (p.phi_y, f[2], dy)))
            return best, 0 if along >= across else 1
        if form is flat or self.w0 > 2 * w_high:  # this bound loses by the range of W as well
            w = math.sqrt(max(p.phi, 0.0))
            part = (abs(w - self.w0) + w_high - w_low) / (w_high + 1e-300)
            form = Form(0.0, abs(p.apart_t) + part * abs(p.phi_t), abs(p.apart_y) + part * abs(p.phi_y),
                        [(abs(a[0]) + a[1] + part * (abs(b[0]) + b[1]), 0.0) for a, b in zip(r, f)])
        return best, form.side(dt, dy)

    def _beside(self, low: float, high: float):
        """The least |W - w0| for W^2 between two numbers."""
        smallest, largest = math.sqrt(max(low, 0.0)), math.sqrt(high)
        return max(smallest - self.w0 - SLACK * smallest, self.w0 - largest - SLACK * self.w0, 0.0)

    def _gaps(self, p: Values, low: float, high: float):
        """The least and greatest W - w0 for W^2 between two numbers about that of the middle."""
        if not p.phi > 0:
            return math.sqrt(max(low, 0.0)) - self.w0, math.sqrt(high) - self.w0
        w = self.w0 + p.gap
        return tuple(p.gap + (max(end, 0.0) - p.phi) / (math.sqrt(max(end, 0.0)) + w) for end in (low, high))

    def _multipliers(self, p: Values, dt: float, dy: float):
        """That of the middle, and that with which the slopes nearly vanish."""
        if self.w0 == 0 or p.phi > 0:
            yield p.gap / (self.w0 + p.gap) if self.w0 else 1.0
        a, b = p.phi_t * dt, p.phi_y * dy
        if square := a * a + b * b:
            yield min(-(p.apart_t * dt * a + p.apart_y * dy * b) / square, 0.999 if self.w0 else 1.0)

    def _form(self, p: Values, r: Sequence[tuple[float, float]], f: Sequence[tuple[float, float]], k: float,
              smallest: float, largest: float):
        """R + k phi + the least of (1 - k) s^2 - 2 w0 s + w0^2 over the rates s = w0 + gap of a box."""
        gap = min(max(k * self.w0 / (1 - k), smallest), largest) if k < 1 else largest if k > 1 else smallest
        s = self.w0 + gap
        over = (p.gap - gap) * (s + self.w0 + p.gap) if p.phi > 0 else p.phi - s * s  # phi - s^2
        size = p.apart + gap * gap + abs(k * over) + (0.0 if p.phi > 0 else abs(k) * s * s)
        return Form(p.apart + gap * gap + k * over - SLACK * size, p.apart_t + k * p.phi_t,
                    p.apart_y + k * p.phi_y, [(a[0] + k * b[0], a[1] + abs(k) * b[1]) for a, b in zip(r, f)])


def _free(v: arb, slope: float, ends: Sequence[arb]):
    """Whether a coordinate may move against the slope."""
    low, high = ends
    return not (v <= low and slope > 0 or v >= high and slope < 0)


def _newton_step(slopes: Sequence[float], a: float, m: float, b: float, free: Sequence[bool]):
    (gt, gy), det = slopes, a * b - m * m
    if all(free) and a > 0 and det > 0:
        return (m * gy - b * gt) / det, (m * gt - a * gy) / det
    return tuple(-g / abs(bend) if ok and bend else 0.0 for g, bend, ok in zip(slopes, (a, b), free))


def double(ball: arb):
    """(middle, radius)."""
    return float(ball.mid()), float(ball.rad())


def ends_of(ball: arb):
    """The least and the greatest number of a ball, as doubles."""
    middle, radius = double(ball)
    off = radius * (1 + SLACK) + SLACK * abs(middle)
    return middle - off, middle + off


def widened(middle: arb, half: float):
    """The ball about a middle."""
    from flint import arb
    return middle + arb(0, half)


def halves(middle: arb, half: float, fraction: float = 0.5):
    """The two parts of an interval, the first with a share of it, a power of two."""
    first = half * fraction
    return (middle - half + first, first), (middle + first, (half - first) * (1 + SLACK))


def least_of(value: float, g1: float, g2: float, h11: Sequence[float], h12: Sequence[float],
             h22: Sequence[float], d1: float, d2: float) -> float:
    """A lower bound of value + g.d + d.H.d/2 over |d1| <= d1, |d2| <= d2, for all H within the radii."""
    (a, ra), (m, rm), (b, rb) = h11, h12, h22
    a, b, largest = a - ra, b - rb, rm * d1 * d2
    box = max(_crossed(g1, g2, a, b, m, d1, d2), _crossed(g2, g1, b, a, m, d2, d1)) - largest
    if d1 > 0 and d2 > 0:
        box = max(box, _convex(g1, g2, a - rm * d2 / d1, b - rm * d1 / d2, m, d1, d2))
    size = abs(g1) * d1 + abs(g2) * d2 + abs(a) * d1 * d1 + abs(b) * d2 * d2
    return value + box - SLACK * (abs(value) + abs(box) + size)


def _convex(g1: float, g2: float, a: float, b: float, m: float, d1: float, d2: float):
    """The same of g.d + d.H.d/2 where that is convex."""
    det = a * b - m * m
    if not (a > 0 and b > 0 and det > 1e-9 * a * b):
        return -INF
    # from a place near the least one, by the tangent plane there, which a convex function stays above: the
    # closed form loses digits where it bends little one way
    t, y = (m * g2 - b * g1) / det, (m * g1 - a * g2) / det
    places = [(t, y)]
    if not (abs(t) <= d1 and abs(y) <= d2):  # on an edge
        t, y = math.copysign(d1, t), math.copysign(d2, y)
        places = [(t, min(max(-(g2 + m * t) / b, -d2), d2)), (min(max(-(g1 + m * y) / a, -d1), d1), y)]
    best = -INF
    for s, z in places:
        u, v = g1 + a * s + m * z, g2 + m * s + b * z
        best = max(best, 0.5 * ((g1 + u) * s + (g2 + v) * z) - u * s - v * z - abs(u) * d1 - abs(v) * d2)
    return best


def _crossed(g1: float, g2: float, a: float, b: float, m: float, d1: float, d2: float):
    """The least over the second of (g2 + m d1) d2 + b d2^2/2, at an edge unless b bends up, then over the
    first."""
    bend = 0.5 * b * d2 * d2 if b < 0 else 0.0
    return min(g2 * d2 + _least(g1 + m * d2, a, d1), _least(g1 - m * d2, a, d1) - g2 * d2) + bend


def _least(g: float, h: float, d: float):
    if h > 0 and abs(g) < h * d:
        return -0.5 * g * g / h
    return -abs(g) * d + 0.5 * h * d * d
