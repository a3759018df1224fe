"""Smooth functions below the squared distance over a box, and their least values.

The squared distance of a state from the point (t, y) of a sheet is D = R + (sqrt(phi) - w0)^2, with R in the plane of the orbit
and phi = W^2. Its root is taken out by duality: for every multiplier k < 1 and all phi >= 0

    D >= R + k phi + min over s >= 0 of [(1 - k) s^2 - 2 w0 s + w0^2],

and the right-hand side is smooth in (t, y), where W = 0 too; with k = 1 - w0/sqrt(phi) it touches D.
"""
from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple


class Form(NamedTuple):
    """A function below D over a box: value and slopes at its middle, the Hessian's entries (middle, radius) over it, rounding."""

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
        return 0 if (abs(self.t) + (abs(tt[0]) + tt[1]) * dt) * dt >= (abs(self.y) + (abs(yy[0]) + yy[1]) * dy) * dy else 1


class Box(NamedTuple):
    """A box |t - middle| <= dt, |y - middle| <= dy of a chart: its middle y (0 where no saddle stands at y = 0), the point
    there, bounds of the second derivatives of R and phi, and the least and greatest W = sqrt(phi) of it; swing: how far phi goes from the middle's."""

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
        if self.y and abs(self.y) == self.dy:  # beside the saddle: W <= sqrt(m) |y|, as phi and its slope vanish there
            p, m = self.p, 0.5 * max(self.f[2][0] + self.f[2][1], 0.0)
            pull = 2 * w0 * math.sqrt(m) * (1 + 1e-12)
            yield Form(p.apart + w0 * w0 - pull * abs(self.y), p.apart_t, p.apart_y - math.copysign(pull, self.y), self.r,
                       self._off_r() + 4e-16 * (w0 * w0 + pull * abs(self.y)))

    def _form(self, w0, k, part, touch):
        """That of the multiplier k with its least at W = s = w0 + part."""
        p, s = self.p, w0 + part
        over = (p.gap - part) * (2 * w0 + p.gap + part) if p.phi > 0 else p.phi - s * s  # phi - s^2 without cancellation
        off_over = min(p.off[1], p.off[2] * (2 * w0 + 2 * abs(p.gap) + abs(part) + p.off[2])) if p.phi > 0 else p.off[1]
        off = (self._off_r() + abs(k) * (off_over + p.rough[2] * self.dt + p.rough[3] * self.dy)
               + 2e-15 * (part * part + abs(k * over)) + (4e-16 * abs(k) * s * s if not p.phi > 0 else 0.0))
        bends = [(a[0] + k * b[0], a[1] + abs(k) * b[1]) for a, b in zip(self.r, self.f)]
        if touch and w0 > 0:  # the root is concave: its curvature over the box bends D upward
            bends = self._bent(bends, 0.25 * w0 / (self.w_high * self.w_high * self.w_high))
        return Form(p.apart + part * part + k * over, p.apart_t + k * p.phi_t, p.apart_y + k * p.phi_y, bends, off)

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
    """The same of g.d + d.H.d/2 as a convex quadratic, made one where it is nearly one: where two nearest points merge, it bends by nothing one way."""
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
    # the least is on an edge; from a place near it, by the tangent plane there, which a convex function stays above
    best = -math.inf
    t, y = math.copysign(d1, t), math.copysign(d2, y)
    for s, z in ((t, min(max(-(g2 + m * t) / b, -d2), d2)), (min(max(-(g1 + m * y) / a, -d1), d1), y)):
        u, v = g1 + a * s + m * z, g2 + m * s + b * z
        best = max(best, 0.5 * ((g1 + u) * s + (g2 + v) * z) - u * s - v * z - abs(u) * d1 - abs(v) * d2)
    return best - loss


def _crossed(g1, g2, a, b, m, d1, d2):
    """The least over the second of (g2 + m d1) d2 + b d2^2/2, at an edge unless b bends up, then over the first."""
    bend = 0.5 * b * d2 * d2 if b < 0 else 0.0
    return min(g2 * d2 + _least(g1 + m * d2, a, d1), _least(g1 - m * d2, a, d1) - g2 * d2) + bend


def _least(g, h, d):
    if h > 0 and abs(g) < h * d:
        return -0.5 * g * g / h
    return -abs(g) * d + 0.5 * h * d * d
