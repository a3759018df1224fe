"""Sheets of the separatrix of a body with two equal moments, where orbits are parabolas and the potential is a quartic.

With D_k = D_i (p = 0, q = -kappa, rho = -q0) let q = kappa omega_j + rho and N = kappa omega_k + sigma. Then q grows by kappa a y
along the orbit (a = p0), equilibria have q N = K := sigma rho - kappa m, and from a saddle (s, N), a N > s^2,

    W^2 = 2 (V_saddle - V) = y^2 [a N - (s + kappa a y/2)^2],  kappa omega_k + sigma = N - kappa s y - kappa^2 a y^2/2.

So there is a separatrix wherever a is not zero: the valley of the quartic has a barrier between two wells for all |N| beyond
the fold |a| |N|^3 = K^2. With D_j = D_i instead the two components change roles.
"""
from __future__ import annotations

import math
from fractions import Fraction

from ...potential import Parabola
from ..result import NO_SEPARATRIX, Apart
from .charts.bends import Span
from .charts.loop_chart import Chart
from .charts.sharp import parabola_place
from .point import UNIT, Point, gap_of, seen_as, square_of
from .search import nearest


class ParabolaChart(Chart):
    """One branch of saddles: N = sign exp(t) with a N > 0, y round the loops of both sides."""

    def __init__(self, seen, t, y):
        super().__init__(seen, None, t, y)

    def _saddle(self, t):
        g = self.here
        N = math.copysign(math.exp(t), g["a"])
        return N, g["K"] / N

    def misses(self, t, dt, y, dy, upper):
        return False

    def place(self, t, y):
        """(first, second) rate less the state's, and |omega_i + s|."""
        p, (N, s) = self.here, self._saddle(t)
        half = 0.5 * p["kappa"] * p["a"] * y
        u, v = s + 2 * half - p["u"], N - p["kappa"] * y * (s + half) - p["v"]
        return u / p["kappa"], v / p["kappa"], math.sqrt(max(self.point(t, y).phi, 0.0))

    def point(self, t, y) -> Point:
        g = self.here
        N, s = self._saddle(t)
        kappa, a, half = g["kappa"], g["a"], 0.5 * g["kappa"] * g["a"] * y
        u, v = s + 2 * half - g["u"], N - kappa * y * (s + half) - g["v"]
        lift = s + half
        phi = y * y * (a * N - lift * lift)
        phi_t, phi_y = y * y * (a * N + 2 * lift * s), 2 * y * (a * N - lift * lift) - y * y * kappa * a * lift
        u_t, u_y, v_t, v_y = -s, kappa * a, N + kappa * y * s, -kappa * (s + 2 * half)
        k2 = kappa * kappa
        tall, wide, long = abs(a * N) + (abs(s) + abs(half)) ** 2, abs(s) + abs(half), abs(kappa * y)
        off_phi = UNIT * y * y * tall
        mN = abs(N) + long * wide
        off_u, off_v = UNIT * (wide + abs(g["u"])), UNIT * (mN + abs(g["v"]))
        apart, off = square_of(u, v, off_u, off_v, 1 / k2, 1 / k2)
        gap, off_w = gap_of(phi, off_phi, g["w"])
        rough = (4 * (off_u * abs(s) + abs(u) * UNIT * abs(s) + off_v * mN + abs(v) * UNIT * mN) / k2,
                 4 * (off_u * abs(kappa * a) + abs(u) * UNIT * abs(kappa * a) + (off_v + abs(v) * UNIT) * abs(kappa) * 2 * wide) / k2,
                 4 * UNIT * y * y * tall, 8 * UNIT * (abs(y) * tall + y * y * abs(kappa * a) * wide))
        return Point(apart, 2 * (u * u_t + v * v_t) / k2, 2 * (u * u_y + v * v_y) / k2, phi, phi_t, phi_y, gap, (off, off_phi, off_w), rough)

    def sharp(self, numbers, g, t, y):
        return parabola_place(g, t, y)

    @staticmethod
    def metric(g):
        return 1, 1

    def bends(self, t, dt, y, dy):
        g = self.here
        kappa, a, k2 = g["kappa"], g["a"], g["kappa"] ** 2
        N, s = self._saddle(t)
        wide, y = Span(math.cosh(dt), math.sinh(dt)), Span(y, dy)
        N, s = N * wide, s * wide
        half = (0.5 * kappa * a) * y
        lift = s + half
        u, v = s + 2 * half - g["u"], N - kappa * y * lift - g["v"]
        u_t, v_t, v_y = -s, N + kappa * y * s, -kappa * (s + 2 * half)
        tt = u_t * u_t + u * s + v_t * v_t + v * (N - kappa * y * s)
        ty = u_t * (kappa * a) + v_t * v_y + v * (kappa * s)
        yy = (kappa * a) ** 2 + v_y * v_y - v * (k2 * a)
        aN, y2 = a * N, y * y
        f_tt = y2 * (aN - 2 * s * s - 2 * lift * s)
        f_ty = 2 * y * (aN + 2 * lift * s) + y2 * (kappa * a * s)
        f_yy = 2 * (aN - lift * lift) - (4 * kappa * a) * y * lift - y2 * (0.5 * (kappa * a) ** 2)
        return tuple(n.pair() for n in ((2 / k2) * tt, (2 / k2) * ty, (2 / k2) * yy, f_tt, f_ty, f_yy))


def parabola_seen(reduction, state):
    """The reduction seen from a state (three floats or Fractions), None where no orbit has a barrier."""
    r = reduction
    u, v = (Fraction(state[axis]) for axis in (r.j, r.k))
    p0, rho, sigma = r.p0, r.rho, r.sigma
    if r.p:  # D_j = D_i: the components change roles
        u, v, p0, rho, sigma = v, u, r.q0, r.sigma, r.rho
    if not r.kappa or not p0:
        return None
    exact = {"kappa": r.kappa, "a": p0, "K": sigma * rho - r.kappa * r.m, "u": r.kappa * u + rho, "v": r.kappa * v + sigma,
             "w": abs(Fraction(state[r.axis]) + r.s)}
    return seen_as(Parabola, exact)


def rectangle(g, upper):
    """((t_low, t_high), (y_low, y_high)) outside which every point is farther than `upper`; None where nothing is left."""
    kappa, a, K = g["kappa"], g["a"], g["K"]
    far = abs(kappa) * upper * (1 + 1e-9)
    q_low, q_high, v_most = g["u"] - far, g["u"] + far, abs(g["v"]) + far
    q2 = max(q_low * q_low, q_high * q_high)
    fold = (K * K / abs(a)) ** (1 / 3) * (1 - 1e-13)
    s_most = abs(K) / fold if fold else 0.0
    most = v_most + 0.5 * (q2 + s_most * s_most) / abs(a)
    least = fold if fold else most * 1e-40
    if not least < most:
        return None
    reach = 2 * (math.sqrt(abs(a) * most) + s_most) / abs(kappa * a)  # phi >= 0 there
    span = (max(abs(q_low), abs(q_high)) + s_most) / abs(kappa * a)
    reach = min(reach, span) * (1 + 1e-9)
    return (math.log(least), math.log(most)), (-reach, reach)


def on_parabolas(reduction, state) -> Apart:
    """The distance of a state of a body with two equal moments, whose orbits are parabolas."""
    seen = parabola_seen(reduction, state)
    if seen is None:
        return NO_SEPARATRIX
    g = seen.plain
    fold = (g["K"] ** 2 / abs(g["a"])) ** (1 / 3) or abs(g["v"]) or abs(g["a"])
    upper = math.inf
    for n in range(-8, 60):
        N = math.copysign(fold * 2 ** (n / 4 if n > 0 else n if not g["K"] else 0), g["a"])
        upper = min(upper, math.sqrt(((g["K"] / N - g["u"]) ** 2 + (N - g["v"]) ** 2) / g["kappa"] ** 2 + g["w"] ** 2))
    t, y = rectangle(g, upper)
    found = nearest([ParabolaChart(seen, t, y)], g["w"], upper * (1 + 1e-12))
    witness = None if found.chart is None else _rates(reduction, found.chart.place(found.t, found.y), state)
    return Apart(found.lower, found.upper, witness, "", found.boxes)


def _rates(reduction, place, state):
    """The three rates at a place, with omega_i + s of the sign of the state's."""
    r, (first, second, w) = reduction, place
    if r.p:
        first, second = second, first
    out = [0.0] * 3
    out[r.j], out[r.k] = float(state[r.j] + Fraction(first)), float(state[r.k] + Fraction(second))
    out[r.axis] = float((1 if state[r.axis] + r.s >= 0 else -1) * Fraction(w) - r.s)
    return tuple(out)
