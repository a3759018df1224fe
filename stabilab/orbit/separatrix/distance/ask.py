"""How far a state is from the separatrix: the smallest change of the three rates that reaches it, with a
proof and a witness, on circles, hyperbolas and parabolas.

The separatrix is the set of states whose fate is to tend to a saddle of the reduced potential: the loops of
all saddles, swept along the curves of saddles. Branch and bound over its branches (`search`) brings a
proved lower bound and a point of the separatrix together; what the number of boxes does not close is a
bracket.

Of a branch only those points part bounded motions from spin-up whose saddle no higher barrier stands beside
(`Shade`): on a circle under a torque the fate is that of the highest barrier within one turn ahead. A loop
counts as far as no place between it and its saddle, and none ahead of the saddle, is higher than the saddle:
there the branch ends on the loop on which two barriers are as high, and the other barrier's goes on.
Where two branches meet so, they form a notch that points into the bounded motions, and the nearest point may
lie in it: a bound that uses both heights at once closes there.

Without a torque the states of an invariant plane whose energy exceeds that of the resting centre tend to a
rotation about the axis and are on the separatrix too: a flat piece, bounded by the loops' limit n^2 W^2/2 =
u(xi, eta). Its distance is that of the plane where the foot of the perpendicular has the energy; else the
nearest point is on that limit, where the branches end. With a torque no point of the planes is a limit of
branches but the curve of each saddle on them: a branch beside a plane keeps eta = eta* exp(-(n^2 W^2/2 +
...)/mu) > 0 at every rate W.

With two equal moments orbits are parabolas and the potential is a quartic. With D_k = D_i (p = 0, q = -kappa,
rho = -q0) let q = kappa omega_j + rho and N = kappa omega_k + sigma. Then q grows by kappa a y along the
orbit (a = p0), equilibria have q N = K := sigma rho - kappa m, and from a saddle (s, N), a N > s^2,

    W^2 = 2 (V_saddle - V) = y^2 [a N - (s + kappa a y/2)^2],  kappa omega_k + sigma = N - kappa s y - kappa^2
    a y^2/2.

So there is a separatrix wherever a is not zero: the valley of the quartic has a barrier between two wells for
all |N| beyond the fold |a| |N|^3 = K^2. With D_j = D_i instead the two components change roles.
"""
from __future__ import annotations

import math
from fractions import Fraction
from itertools import pairwise
from typing import Any, NamedTuple

from ....numbers.balls import FIRST_BITS, Unclear
from ....physics.scene import aligned
from ...conic import conic_of
from ...fate.one_state import decide, on_separatrix
from ...one_orbit import Orbit
from ...potential import Parabola, slope_at
from ...reduction import reduce
from ..circle import moved, others, slope
from ..result import ENDED, NO_SEPARATRIX, UNKNOWN, Apart
from .bends import Span, parabola_place
from .curves import UNIT, Hyperbola, Point, Seen, Straight, gap_of, seen_as, square_of, within
from .long_loops import loops_of, planes_met
from .loop_charts import Chart, OppositeChart, TurnedChart, mirrored
from .search import nearest


class Shade:
    """The barriers beside a saddle; constants: (G, c, d, mu) of the force."""

    def __init__(self, constants):
        self.g = constants

    def _places(self, chart, t):
        """Offsets of the other barriers within a turn on either side."""
        x, z = chart.curve.at(t)[:2]
        for side in (1, -1):
            for q in others(self.g, x, z, side):
                if q < math.inf and slope(self.g, *moved(x, z, side * q)) > 0:
                    yield side * q

    def __call__(self, chart, t, y) -> bool:
        """Whether the point counts."""
        return not any((at > 0 or at > y) and _barrier(chart, t, at).phi < 0 for at in self._places(chart, t))

    def bound(self, search, form, best, chart, t, dt, y, dy):
        """A better lower bound over a box by what may shade it: inf where it is shaded for certain."""
        for at in self._places(chart, t):
            if at < 0 and not at > y + dy:
                continue
            p, bends = _barrier(chart, t, at), chart.bends(t, dt, at, 0.0)[3]
            if p.phi + abs(p.phi_t) * dt + 0.5 * (abs(bends[0]) + bends[1]) * dt * dt + p.off[1] < 0:
                return math.inf
            share = form.t / p.phi_t if p.phi_t else 0.0
            if share > 0:  # points that count have p.phi >= 0, so this much may be taken off
                (tt, rtt), *rest = form.bends
                new = form._replace(value=form.value - share * p.phi, t=0.0, off=form.off + share * p.off[1],
                                    bends=[(tt - share * bends[0], rtt + share * bends[1]), *rest])
                best = max(best, new.least(dt, dy))
            if best < search.goal and p.phi * p.phi < (p.phi_t * dt) ** 2 and dt < 0.1:
                self._notch(search, chart, t, y, at)
        return best

    def _notch(self, search, chart, t, y, at):
        """Try the loop on which the two barriers are as high."""
        for _ in range(6):
            p = _barrier(chart, t, at)
            step = -p.phi / p.phi_t if p.phi_t else 0.0
            t = min(max(t + step, chart.t[0]), chart.t[1])
            near = [place for place in self._places(chart, t) if (place > 0) == (at > 0)]
            if not near:
                return
            at = min(near, key=lambda place: abs(place - at))
            if abs(step) < 1e-15 * (1 + abs(t)):
                break
        p = _barrier(chart, t, at)
        t += math.copysign(4e-16 * (1 + abs(t)) + (p.off[1] / abs(p.phi_t) if p.phi_t else 0.0), p.phi_t)
        search.better(*chart.at_one(t, y))


def _barrier(chart, t, at):
    """The point of a branch at another barrier: phi is below zero where that is higher than the saddle. Two
    barriers of a wide circle may be as high but for the last digits of what they rise above the centre, which
    doubles lose, with those of the barrier's place: then a step of Newton's method in balls leads to it."""
    p, (bend, _) = chart.point(t, at), chart.bends(t, 0.0, at, 0.0)[5]
    if not bend > 0 or abs(p.phi) > 4 * (p.off[1] + (abs(p.phi_y) + p.rough[3]) ** 2 / bend):
        return p
    p = chart.exact_point(t, at)
    return chart.exact_point(t, Fraction(at) - Fraction(p.phi_y / bend))


INF = math.inf
QUARTER = 0.5 * math.pi * (1 + 1e-15)


def on_conic(reduction, state, orbit) -> Apart:
    """The distance of a state whose orbit is a circle or a hyperbola."""
    seen, way = Seen.of(reduction, state), GEOMETRIES[reduction.e]
    arcs = list(_arcs(way, conic_of(reduction), seen))
    shade = way.shade(orbit, arcs)
    start = min([_first(seen, arc, shade) for arc in arcs] + way.flat(seen, reduction.sense, arcs),
                key=lambda one: one[0], default=None)
    if start is None:
        return NO_SEPARATRIX
    if start[0] == 0:  # at the end of a branch
        return Apart(0.0, 0.0, (float(state[0]), float(state[1]), float(state[2])))
    charts = [chart for arc in arcs for chart in arc.charts(seen, reduction.sense, start[0])]
    charts += way.opposite(lambda other: _arcs(way, conic_of(reduction), other), seen, start[0])
    found = nearest(charts, seen.plain["w"], start[0] * (1 + 1e-14) + 1e-300, genuine=shade,
                    start=_on_chart(charts, *start[2:]))
    place = start[1] if found.chart is None else found.chart.place(found.t, found.y)
    return Apart(found.lower, found.upper, _rates_on_conic(reduction, seen, place, state), "", found.boxes)


def _on_chart(charts, saddle=None):
    """(chart, t, y) of a saddle (branch, t)."""
    on = [chart for chart in charts if saddle and chart.from_saddle and chart.curve is saddle[0]
          and chart.t[0] <= saddle[1] <= chart.t[1]
          and chart.y[0] <= 0 <= chart.y[1]]
    return (on[0], saddle[1], 0.0) if on else None


class _Arc(NamedTuple):
    """A branch of saddles: t from low to high (inf: open) along a curve."""

    curve: Any
    low: float
    high: float


class _OnCircles(_Arc):
    """Of circles."""

    def charts(self, seen, sense, upper):
        """Charts of the loops that come within `upper` of the state, beside their saddles."""
        for piece in self._pieces(seen, upper):
            yield Chart(seen, self.curve, piece, (-QUARTER, 0.0 if sense else QUARTER))
            if sense:
                yield TurnedChart(seen, self.curve, piece, (0.0, QUARTER))

    @staticmethod
    def opposite(arcs_of, seen, upper):
        """Charts of the same loops opposite to their saddles; arcs_of: the branches as told from another
        place."""
        image = mirrored(seen)
        return [OppositeChart(image, arc.curve, piece, (-QUARTER, QUARTER)) for arc in arcs_of(image)
                for piece in arc._pieces(image, upper)]

    def _pieces(self, seen, upper):
        g = seen.plain
        reach = math.hypot(g["X"], g["Z"]) + upper * (1 + 1e-9) / math.sqrt(min(g["a"], g["b"]))
        low, high = self.curve.window(reach)
        low, high = max(self.low, low), min(self.high, high)
        return within(seen, self.curve, low, high, upper) if low <= high else []

    @staticmethod
    def flat(seen, sense, arcs):
        """[(distance, foot)] of what belongs to the separatrix besides the loops."""
        return []

    @staticmethod
    def shade(orbit, arcs):
        """What may shade a branch: only a state that a barrier holds sees the difference, and only where
        there are two barriers."""
        reduction = orbit.reduction
        if not reduction.sense or len(arcs) < 2 or decide(orbit, FIRST_BITS).sign < 0:
            return None
        g = reduction.constants
        return Shade((g["G"], g["c"], g["d"], g["mu"]))


class _OnHyperbolas(_Arc):
    """Of hyperbolas, whose saddles lie within a circle."""

    def charts(self, seen, sense, upper):
        if self.low <= self.high:
            yield from loops_of(seen, self.curve, self.low, self.high, upper)

    @staticmethod
    def opposite(arcs_of, seen, upper):
        """Nothing: no hyperbola comes round."""
        return []

    @staticmethod
    def flat(seen, sense, arcs):
        return ([] if sense
                else _flat_pieces(seen)) + [place for arc in arcs
                                            for place in planes_met(seen, arc.curve, arc.low, arc.high)]

    @staticmethod
    def shade(orbit, arcs):
        return None


GEOMETRIES: dict[int, type[_OnCircles] | type[_OnHyperbolas]] = {-1: _OnCircles, 1: _OnHyperbolas}


def _arcs(way, conic, seen):
    """The branches of saddles."""
    for piece in conic.pieces:
        if piece.barrier:
            curve = Hyperbola(seen, *conic.sharp_ends(piece), piece.sign)
            yield way(curve, curve.low, curve.high)
    for line in conic.lines:
        curve = Straight(seen, ("x" if line.dz else "z") if conic.G else None)
        for low, high in pairwise((-INF, *curve.knots, INF)):
            if slope_at(*(seen.plain[n] for n in ("G", "c", "d")), seen.e,
                        *curve.at(_between(low, high))[:2]) > 0:
                yield way(curve, low, high)


def _between(low, high):
    if low == -INF:
        return high - 1 - abs(high) if high < INF else 0.0
    return low + 1 + abs(low) if high == INF else 0.5 * (low + high)


def _first(seen, arc, shade):
    """(distance, (X, Z, W), (branch, t)) of the nearest of some saddles of a branch that count."""
    g = seen.plain
    size = math.hypot(g["X"], g["Z"])
    places = [0.0] if isinstance(arc.curve, Hyperbola) and arc.low <= 0 <= arc.high else []
    ends = [t for t in (arc.low, arc.high) if math.isfinite(t)]
    near = arc.curve.window(2 * size + 1e-300)
    for low, high in ((arc.low, arc.high), near, (ends[0] - 1, ends[-1] + 1) if ends else near):
        low, high = max(low, arc.low), min(high, arc.high)
        if math.isfinite(low) and math.isfinite(high) and low <= high:
            places += [low + (high - low) * n / 8 for n in range(9)]
    best = INF, None, None
    for t in places:
        at = arc.curve.at(t)
        u, v = abs(at.u) + UNIT * at.su, abs(at.v) + UNIT * at.sv
        distance = math.sqrt(g["a"] * u * u + g["b"] * v * v + g["w"] ** 2)
        if distance < best[0] and (shade is None
                                   or shade(Chart(seen, arc.curve, (t, t), (0.0, 0.0)), t, 0.0)):
            best = distance, (at.u, at.v, 0.0), (arc.curve, t)
    return best


def _flat_pieces(seen):
    """[(distance, foot)] of the planes of a hyperbola without torque, where the foot of the perpendicular is
    on the separatrix."""
    g, found = seen.plain, []
    for flip in (1.0, -1.0):  # Z = flip X
        x = (g["a"] * g["X"] + flip * g["b"] * g["Z"]) / (g["a"] + g["b"])
        energy = 0.5 * g["n2"] * g["w"] ** 2 - x * (0.5 * g["G"] * x + g["c"] + flip * g["d"])
        if energy >= 0:
            apart = abs(g["X"] - flip * g["Z"]) * math.sqrt(g["a"] * g["b"] / (g["a"] + g["b"]))
            found.append((apart, (x - g["X"], flip * x - g["Z"], g["w"])))
    return found


def _rates_on_conic(reduction, seen, place, state):
    """The three rates at (X, Z, |W|/n), X and Z less the state's, with W of the sign of the state's."""
    x, z, w = place
    r, g = reduction, reduction.constants
    out = [0.0] * 3
    out[r.j], out[r.k] = float(state[r.j]) + g["flip"] * g["rx"] * x, float(state[r.k]) + g["rz"] * z
    sign = 1.0 if Fraction(state[r.axis]) + r.s >= 0 else -1.0
    out[r.axis] = sign * w - float(r.s)
    return tuple(out)


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
        phi_t, phi_y = y * y * (a * N
                                + 2 * lift * s), 2 * y * (a * N - lift * lift) - y * y * kappa * a * lift
        u_t, u_y, v_t, v_y = -s, kappa * a, N + kappa * y * s, -kappa * (s + 2 * half)
        k2 = kappa * kappa
        tall, wide, long = abs(a * N) + (abs(s) + abs(half)) ** 2, abs(s) + abs(half), abs(kappa * y)
        off_phi = UNIT * y * y * tall
        mN = abs(N) + long * wide
        off_u, off_v = UNIT * (wide + abs(g["u"])), UNIT * (mN + abs(g["v"]))
        apart, off = square_of(u, v, off_u, off_v, 1 / k2, 1 / k2)
        gap, off_w = gap_of(phi, off_phi, g["w"])
        rough = (4 * (off_u * abs(s) + abs(u) * UNIT * abs(s) + off_v * mN + abs(v) * UNIT * mN) / k2,
                 4 * (off_u * abs(kappa * a) + abs(u) * UNIT * abs(kappa * a)
                      + (off_v + abs(v) * UNIT) * abs(kappa) * 2 * wide) / k2,
                 4 * UNIT * y * y * tall, 8 * UNIT * (abs(y) * tall + y * y * abs(kappa * a) * wide))
        return Point(apart, 2 * (u * u_t + v * v_t) / k2, 2 * (u * u_y + v * v_y) / k2, phi, phi_t, phi_y,
                     gap, (off, off_phi, off_w), rough)

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
    exact = {"kappa": r.kappa, "a": p0, "K": sigma * rho - r.kappa * r.m, "u": r.kappa * u + rho,
             "v": r.kappa * v + sigma,
             "w": abs(Fraction(state[r.axis]) + r.s)}
    return seen_as(Parabola, exact)


def rectangle(g, upper):
    """((t_low, t_high), (y_low, y_high)) outside which every point is farther than `upper`; None where
    nothing is left."""
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
        upper = min(upper,
                    math.sqrt(((g["K"] / N - g["u"]) ** 2 + (N - g["v"]) ** 2) / g["kappa"] ** 2
                              + g["w"] ** 2))
    t, y = rectangle(g, upper)
    found = nearest([ParabolaChart(seen, t, y)], g["w"], upper * (1 + 1e-12))
    witness = (None if found.chart is None
               else _rates_on_parabola(reduction, found.chart.place(found.t, found.y), state))
    return Apart(found.lower, found.upper, witness, "", found.boxes)


def _rates_on_parabola(reduction, place, state):
    """The three rates at a place, with omega_i + s of the sign of the state's."""
    r, (first, second, w) = reduction, place
    if r.p:
        first, second = second, first
    out = [0.0] * 3
    out[r.j], out[r.k] = float(state[r.j] + Fraction(first)), float(state[r.k] + Fraction(second))
    out[r.axis] = float((1 if state[r.axis] + r.s >= 0 else -1) * Fraction(w) - r.s)
    return tuple(out)


def separatrix_distance(scene, states):
    """Euclidean distance (...,) of states (..., 3) from the nearest point of the scene's separatrix, in the
    unit of the states: to 1e-9, or a proved lower bound; inf where the scene has none, NaN where it is not
    known.

    A torque in a plane of equal moments: the distance of the turned state in the turned scene, as a turn
    keeps distances. Not known: a free gyrostat without a reduction (its separatrix is known by its energy on
    each momentum sphere, not as branches), and a torque off the axes. A gyrostatic moment along the torque
    leaves no equilibrium (|H|^2/2 - D T grows steadily), so no separatrix: inf.
    """
    import numpy as np
    array = np.asarray(states, float)
    distance_from = _asker(scene)
    flat = [distance_from(state) for state in array.reshape(-1, 3).tolist()]
    return np.array(flat, float).reshape(array.shape[:-1])


def _asker(scene):
    """The function of one state that gives its distance."""
    reduction, turn = reduce(scene), aligned(scene)
    if reduction is not None:
        return lambda state: distance_of(reduction, state).value
    if turn is not None:
        turned = reduce(turn.twin)
        return lambda state: distance_of(turned, turn(state)).value
    return lambda state: INF if has_no_saddle(scene) else math.nan


def has_no_saddle(scene) -> bool:
    """Whether a scene without a reduction, its torque on one axis or none, has no saddle for sure: a
    gyrostatic moment along the torque leaves no equilibrium, and with equal moments the kinetic energy is a
    linear function on each momentum sphere."""
    acting = sum(m != 0 for m in scene.quadratic().m)
    return acting == 1 or not acting and not any(scene.quadratic().kappa)


def distance_of(reduction, state, orbit: Orbit | None = None) -> Apart:
    """The distance of one state (three floats or Fractions) of a scene with this reduction (None: it has
    none).

    orbit: the state's, where that is at hand.
    """
    if reduction is None:
        return NO_SEPARATRIX
    state = tuple(v if isinstance(v, Fraction) else float(v) for v in state)
    try:
        orbit = orbit or Orbit(reduction, state)
        if on_separatrix(orbit):
            return Apart(0.0, 0.0, (float(state[0]), float(state[1]), float(state[2])))
        found = (on_conic(reduction, state, orbit) if reduction.geometry.centred
                 else on_parabolas(reduction, state))
    except (Unclear, ArithmeticError,
            ValueError):  # a logarithm of what has vanished in doubles is a ValueError
        return UNKNOWN
    if found.upper != found.upper or found.lower != found.lower:
        return UNKNOWN
    return found if found.settled else found._replace(because=ENDED)
