"""How far a state is from the separatrix: the smallest change of the three rates that reaches it, with a
proof and a witness, on circles, hyperbolas and parabolas.

The separatrix is the set of states whose fate is to tend to a saddle of the reduced potential: the loops of
all saddles, swept along the curves of saddles. Branch and bound over its branches (`nearest`) brings a
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
"""
from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING

from ...numbers.balls import FIRST_BITS, START_BITS, Digits, Unclear, settled
from ...physics.scene import AnyScene, aligned
from ..conic import Line, conic_of, planes_touched
from ..fate import decide, on_separatrix
from ..one_orbit import Orbit
from ..potential import Circle, slope_at
from ..reduction import Reduction, reduce
from .charts import (
    OFFSET_CHART,
    Chart,
    FromAnchor,
    Hyperbola,
    HyperbolaChart,
    Logarithmic,
    LoopChart,
    ParabolaChart,
    Straight,
)
from .homoclinic import ENDED, NO_SEPARATRIX, TURN, UNKNOWN, Apart, others
from .nearest import FINE, INF, Form, Search, double, ends_of

if TYPE_CHECKING:
    import numpy as np
    from flint import arb

    from ...numbers.vectors import Number

BITS = START_BITS  # of the first try; the places of two nearly equal moments cancel
MOST_BITS = 2048
SAMPLES = 16  # saddles of a branch that a first upper bound comes from
WIDER = 1 + 1e-9


def seen_from(reduction: Reduction, state: Sequence[float | Fraction]) -> dict:
    """The exact constants of the force and the metric, and the place (X, Z, |W|/n) of a state."""
    g, r = reduction.exact_constants, reduction
    u, v, speed = (Fraction(state[axis]) for axis in (r.j, r.k, r.axis))
    return {"G": g["G"], "c": g["c"], "d": g["d"], "mu": g["mu"], "k": 2 / g["n"] ** 2, "a": g["rx"] ** 2,
            "b": g["rz"] ** 2, "X": g["flip"] * (u + g["sj"]) / g["rx"], "Z": (v + g["sk"]) / g["rz"],
            "w": abs(speed + r.s), "K": g["c"] * g["d"] / g["G"] - g["mu"] if g["G"] else Fraction(0)}


class _Seen:
    """A reduction with circles or hyperbolas seen from a state: exact constants, doubles and balls."""

    def __init__(self, numbers, reduction, state):
        self.numbers, self.reduction, self.e = numbers, reduction, reduction.e
        self.exact = seen_from(reduction, state)
        self.plain = {name: float(value) for name, value in self.exact.items()}
        self.g = g = {name: numbers.ball(value) for name, value in self.exact.items()}
        a, b = self.plain["a"], self.plain["b"]
        g |= {"radius": (g["X"] ** 2 + g["Z"] ** 2).sqrt(), "least": min(a, b) * (1 - 1e-14),
              "metric": (a, b), "rate": self.plain["k"]}
        self.size, self.w = math.hypot(self.plain["X"], self.plain["Z"]), self.plain["w"]

    def branches(self, reach: float):
        """(curve, least t, greatest t) of the saddles on the orbits with |Q| <= reach^2."""
        conic = conic_of(self.reduction)
        for piece in conic.pieces:
            if piece.barrier:
                yield Hyperbola(self.g, piece.sign), *self._ends(*conic.sharp_ends(piece), reach)
        for line in conic.lines:
            yield from self._on_line(line, reach)

    def _ends(self, inner: float | Fraction, outer: float | Fraction, reach: float):
        """log |h| of the ends of a piece, no farther out than all solutions are (as of `conic`)."""
        G, c, d, K = (abs(self.plain[name]) for name in "GcdK")
        far = 4 * WIDER * (reach + c / G + d / G + math.sqrt(K / G)) + 1e-300
        low, high = max(inner, K / (far * G)), min(outer, far)
        return tuple(self.numbers.ball(end).log() for end in (low, high))

    def _on_line(self, line: Line, reach: float):
        g, e, ball = self.exact, self.e, self.numbers.ball
        G, c, d, mu, cross = g["G"], g["c"], g["d"], g["mu"], None
        if not G:
            square = c * c + d * d
            base, route = (-mu * d / square, -mu * c / square), (-c, d)
        elif line.dz:
            base, route, cross = (-c / G, Fraction(0)), (Fraction(0), Fraction(1)), -d / G
        else:
            base, route, cross = (Fraction(0), -d / G), (Fraction(1), Fraction(0)), -c / G
        # Q = bend t^2 + 2 tilt t + Q0
        bend, tilt = route[1] ** 2 - e * route[0] ** 2, base[1] * route[1] - e * base[0] * route[0]
        foot, Q0 = -tilt / bend if bend else Fraction(0), base[1] ** 2 - e * base[0] ** 2
        if bend:
            wide = math.sqrt((reach * reach + abs(float(Q0 - bend * foot * foot))) / abs(float(bend)))
        else:
            wide = (reach * reach + abs(float(Q0))) / abs(float(2 * tilt)) if tilt else reach
        knots = sorted({foot, *([cross] if cross is not None else [])})
        far = Fraction(WIDER * wide + 1e-300) + max(abs(t - foot) for t in knots)
        curve = Straight(tuple(map(ball, base)), tuple(map(ball, route)))
        for low, high in pairwise((foot - far, *knots, foot + far)):
            x, z = (p + (low + high) / 2 * q for p, q in zip(base, route))
            if low < high and slope_at(G, c, d, e, x, z) > 0:
                yield curve, ball(low), ball(high)

    def first_points(self, reach: float, number: int = SAMPLES, hidden: Shade | None = None):
        """(distance, (u, v, w)) of so many saddles of each branch that count."""
        g = self.g
        for curve, low, high in self.branches(reach):
            chart = LoopChart(g, curve, (low, high), None, self.e)
            for n in range(number + 1):
                t = low + (high - low) * n / number
                x, z = curve.at(t)[:2]
                u, v = x - g["X"], z - g["Z"]
                apart = ends_of(g["a"] * u * u + g["b"] * v * v)[1]
                if not hidden or not hidden.hides(chart, t.mid(), 0.0):
                    yield math.sqrt(apart + self.w**2) * (1 + FINE), (u, v, 0.0)


def _on_circles(numbers: Digits, reduction: Reduction, state: Sequence[float | Fraction],
                held: bool) -> Apart:
    noted = _Seen(numbers, reduction, state)
    hidden = Shade(noted.reduction) if held else None
    for number in (SAMPLES, 16 * SAMPLES):
        first = min(noted.first_points(4 * noted.size + noted.w, number, hidden), key=_first, default=None)
        if first or not hidden:
            break
    if first is None:
        return NO_SEPARATRIX
    if first[0] == 0:  # at the end of a branch
        return Apart(0.0, 0.0, _three(state))
    reach = (noted.size + first[0] / math.sqrt(noted.g["least"])) * WIDER
    turn = TURN * WIDER
    ends = tuple(map(numbers.ball, (-turn, 0) if reduction.sense else (-turn / 2, turn / 2)))
    charts = [LoopChart(noted.g, curve, (low, high), ends, -1) for curve, low, high in noted.branches(reach)]
    return _answer(noted, state, Search(noted.g["w"], first[0], hidden), charts, first[1])


def _three(rates: Sequence[float | Fraction]):
    first, second, third = map(float, rates)
    return first, second, third


def _first(point: tuple[float, tuple[arb, arb, float]]):
    return point[0]


def _on_hyperbolas(numbers: Digits, reduction: Reduction, state: Sequence[float | Fraction],
                   held: bool) -> Apart:
    noted = _Seen(numbers, reduction, state)
    g, plain = noted.g, noted.plain
    flat = [] if reduction.sense else _flat_pieces(plain)
    first = min([*noted.first_points(4 * noted.size + noted.w), *flat], key=_first, default=None)
    if first is None:
        return NO_SEPARATRIX
    if first[0] == 0:
        return Apart(0.0, 0.0, _three(state))
    wide = first[0] * sum(1 / math.sqrt(plain[name]) for name in "ab") * WIDER
    # of the window about the state
    reach = math.sqrt(math.prod(abs(plain["X"] + flip * plain["Z"]) + wide for flip in (1, -1)))
    nearby: tuple = (numbers.ball(-OFFSET_CHART), numbers.ball(OFFSET_CHART))
    charts: list[Chart] = []
    for curve, low, high in noted.branches(reach):
        charts.append(LoopChart(g, curve, (low, high), nearby, 1))
        for flip in (1, -1):
            xi0 = g["X"] + g["Z"] * flip
            for along, ends in _about_planes(noted, curve, low, high, flip, first[0] + noted.w, reach + wide):
                for sign in (1, -1):
                    y = tuple(max(xi0 * sign + side * wide, numbers.ball(0)) for side in (-1, 1))
                    if y[1] > 0:
                        charts.append(HyperbolaChart(g, along, ends, y, sign, flip))
    return _answer(noted, state, Search(g["w"], first[0]), charts, first[1])


def _flat_pieces(g: Mapping[str, float]):
    """[(distance, foot)] of the planes of a hyperbola without torque, where the foot of the perpendicular is
    on the separatrix."""
    rows = []
    for flip in (1.0, -1.0):  # Z = flip X
        x = (g["a"] * g["X"] + flip * g["b"] * g["Z"]) / (g["a"] + g["b"])
        energy = g["w"] ** 2 / g["k"] - x * (0.5 * g["G"] * x + g["c"] + flip * g["d"])
        if energy >= 0:
            apart = abs(g["X"] - flip * g["Z"]) * math.sqrt(g["a"] * g["b"] / (g["a"] + g["b"]))
            rows.append((apart * (1 + FINE), (x - g["X"], flip * x - g["Z"], g["w"])))
    return rows


def _about_planes(seen: _Seen, curve: Hyperbola, low: arb, high: arb, flip: int, fastest: float, size: float):
    """(curve by (r, E), its range of the parameter): the branch from low to high cut between the places where
    r = x + flip z vanishes, by the logarithm of the distance to these where a torque acts; fastest, size:
    rates and places beyond them do not matter."""
    places, plain = _zeros(seen, curve, flip), seen.plain
    cuts = [low, *((a + b) / 2 for (a, _), (b, _) in pairwise(places)), high]
    if not plain["mu"]:
        return [(along, (low - at, high - at)) for at, along in places[:1]]
    rows = []
    for n, (at, along) in enumerate(places):
        if along.r0 != 0:
            return [(along, (low - at, high - at))]
        left, right = max(cuts[n], low) - at, min(cuts[n + 1], high) - at
        for side, start, end in ((1, left, right), (-1, -right, -left)):
            if end > 0:
                largest = -start.log() if start > 0 else _longest(seen, along, end, fastest, size) - end.log()
                rows.append((Logarithmic(along, side), (-end.log(), largest)))
    return rows


def _longest(visited: _Seen, along: FromAnchor, end: arb, fastest: float, size: float):
    """How far the logarithm of r/r(end) goes, beside a plane, at places that matter. With |eta| <= |xi| <=
    size an offset y = log(xi/r) = log(E/eta) is at least half of log(E/r), and beyond some y W is too great,
    or none is left."""
    g, E, r = visited.plain, along.at(0 * end)[1], along.at(end)[0]
    G, e = abs(g["G"]), abs(g["c"]) + abs(g["d"])
    height = sum(G * v * v / 4 + e * v for v in (size, abs(double(E)[0])))
    largest = (fastest**2 / g["k"] + height) / g["mu"] + 64
    return 2 * visited.numbers.ball(largest * WIDER) + abs(abs(E / r).log())


def _zeros(visited, curve, flip):
    """[(t, the curve by (r, E) from there)] of the places where r = x + flip z vanishes, in rising order;
    where it does not, of one place."""
    g, zero = visited.g, visited.numbers.ball(0)
    if isinstance(curve, Straight):
        along = curve.seen_along(flip)
        (r, E), (dr, dE) = along.base, along.direction
        along.r0 = r
        if not dr != 0:
            return [(zero, along)] if r != 0 else []
        at = -r / dr
        from_there = Straight((zero, E + at * dE), along.direction)
        from_there.r0 = zero
        return [(at, from_there)]
    # flip h^2 - pull h + k = 0
    pull, k, sign = (g["c"] + g["d"] * flip) / g["G"], g["K"] / g["G"], curve.sign
    square = pull * pull - 4 * k * flip

    def at(h, exact=True):
        rising = h * flip
        falling = rising if touched else k / h
        return (h * sign).log(), FromAnchor(rising, falling, zero if exact else falling + rising - pull,
                                            falling - rising - (g["c"] - g["d"] * flip) / g["G"], touched)
    touched = flip in planes_touched(visited.reduction)
    if touched:
        roots = [pull * flip / 2]
    elif square > 0:
        roots = [(pull + side * square.sqrt()) * flip / 2 for side in (-1, 1)]
    elif square < 0:
        roots = []
    else:
        raise Unclear
    roots = [h for h in roots if h * sign > 0]
    if not roots:  # from where r is stationary
        touched = False
        return [at((k * flip).sqrt() * sign if k * flip > 0 else zero + sign, False)]
    return sorted((at(h) for h in roots), key=lambda location: float(location[0].mid()))


def _nearest(search: Search, charts: Sequence[Chart], location: tuple[Number, Number, float]):
    """(what a search found, (u, v, |W|) of its point in doubles); location: that of the first point."""
    result = search.run(charts)
    if result.at is not None:
        chart, *at = result.at
        location = *chart.place(*at), math.sqrt(max(float(chart.point(*at)[3].mid()), 0.0))
    return result, tuple(v if isinstance(v, float) else float(v.mid()) for v in location)


def _answer(visited: _Seen, state: Sequence[float | Fraction], search: Search, charts: Sequence[Chart],
            location: tuple[arb, arb, float]) -> Apart:
    """On circles and hyperbolas."""
    result, (x, z, w) = _nearest(search, charts, location)
    r, g, rates = visited.reduction, visited.reduction.constants, [0.0] * 3
    rates[r.j], rates[r.k] = float(state[r.j]) + g["flip"] * g["rx"] * x, float(state[r.k]) + g["rz"] * z
    rates[r.axis] = (1.0 if Fraction(state[r.axis]) + r.s >= 0 else -1.0) * w - float(r.s)
    return Apart(result.lower, result.upper, _three(rates), None, result.boxes)


class Shade:
    """The barriers beside the saddles of circles under a torque."""

    def __init__(self, reduction: Reduction):
        self.potential = Circle(reduction)

    def _barriers(self, chart: LoopChart, t: arb, above: float | arb):
        """(offset, phi, its error, its slope in t) of the other barriers within a turn of a saddle, those
        between it and the offset `above` and those ahead."""
        pot, saddle = self.potential, tuple(float(v.mid()) for v in chart.curve.at(t)[:2])
        for at in (side * q for side in (1, -1) for q in others(pot, saddle, side)):
            bend = chart.g["rate"] * pot.slope(pot.move(saddle, at))
            if bend > 0 and (at > 0 or at > above):
                at = t * 0 + at
                point = chart.point(t, at)
                if abs(point[3]) < point[5] * point[5] / bend:  # doubles lose places of wide circles
                    at = (at - point[5] / bend).mid()
                    point = chart.point(t, at)
                yield at, *double(point[3]), float(point[4].mid())

    def hides(self, chart: LoopChart, t: arb, y: float) -> bool:
        """Whether a higher barrier takes the place of a point's."""
        return any(phi < 0 for _, phi, _, _ in self._barriers(chart, t, y))

    def bound(self, search: Search, form: Form, chart: LoopChart, t: arb, dt: float, y: arb, dy: float):
        """A lower bound over a box by what may hide it: inf where it is hidden for certain."""
        from flint import arb
        best = -INF
        for at, phi, off, slope_t in self._barriers(chart, t, y + dy):
            resolved = chart.ranges(t + arb(0, dt), at, INF)
            (bend, radius), *_ = chart.bends(resolved.parts)[1]
            if phi + abs(slope_t) * dt + 0.5 * (abs(bend) + radius) * dt * dt + off < 0:
                return INF
            fraction = form.t / slope_t if slope_t else 0.0
            if fraction > 0:  # points that count have phi >= 0 there, so this much may be taken off
                (tt, radius_tt), *rest = form.bends
                best = max(best, Form(form.value - fraction * (phi + off), 0.0, form.y, [
                    (tt - fraction * bend, radius_tt + fraction * radius), *rest]).least(dt, dy))
            if best < search.goal and phi * phi < (slope_t * dt) ** 2 and dt < 0.1:
                self._notch(search, chart, t, y, at)
        return best

    def _notch(self, search: Search, chart: LoopChart, t: arb, y: arb, at: arb):
        """Try the loop on which the two barriers are as high."""
        for _ in range(6):
            nearby = [item for item in self._barriers(chart, t, min(at, y)) if (item[0] > 0) == (at > 0)]
            if not nearby:
                return
            at, phi, _, slope_t = min(nearby, key=lambda item: float(abs(item[0] - at).mid()))
            step = -phi / slope_t if slope_t else 0.0
            t = min(max(t + step, chart.t[0]), chart.t[1])
            if abs(step) < 1e-15 * (1 + abs(t)):
                break
        search.offer(chart, t + math.copysign(1e-12, slope_t), y)


def _on_parabolas(numbers, reduction, state, held) -> Apart:
    """The distance of a state of a body with two equal moments, whose orbits are parabolas."""
    r = reduction
    u, v = (Fraction(state[axis]) for axis in (r.j, r.k))
    p0, rho, sigma = r.p0, r.rho, r.sigma
    if r.p:  # D_j = D_i: the components change roles
        u, v, p0, rho, sigma = v, u, r.q0, r.sigma, r.rho
    if not r.kappa or not p0:
        return NO_SEPARATRIX
    exact = {"kappa": r.kappa, "a": p0, "K": sigma * rho - r.kappa * r.m, "u": r.kappa * u + rho,
             "v": r.kappa * v + sigma, "ka": r.kappa * p0, "k2": 1 / r.kappa**2}
    rate = abs(Fraction(state[r.axis]) + r.s)
    g, w = {name: float(value) for name, value in exact.items()}, float(rate)
    fold = (g["K"] ** 2 / abs(g["a"])) ** (1 / 3) or abs(g["v"]) or abs(g["a"])
    sizes = [fold * 2 ** (n / 4 if n > 0 else n if not g["K"] else 0) for n in range(-8, 60)]
    starts = [((g["K"] / N - g["u"]) / g["kappa"], (N - g["v"]) / g["kappa"], 0.0)
              for N in (math.copysign(size, g["a"]) for size in sizes)]
    upper, start = min((math.hypot(*item, w) * (1 + FINE), item) for item in starts)
    balls = {name: numbers.ball(value) for name, value in exact.items()} | {"sign": 1 if p0 > 0 else -1}
    t, y = (tuple(map(numbers.ball, pair)) for pair in _rectangle(g, upper))
    zero = numbers.ball(0)
    charts = [ParabolaChart(balls, None, t, side) for side in ((y[0], zero), (zero, y[1]))]
    result, (first, second, turning) = _nearest(Search(numbers.ball(rate), upper), charts, start)
    if r.p:
        first, second = second, first
    rates = [0.0] * 3
    rates[r.j], rates[r.k] = (float(Fraction(state[axis]) + Fraction(more)) for axis, more in
                              ((r.j, first), (r.k, second)))
    rates[r.axis] = float((1 if state[r.axis] + r.s >= 0 else -1) * Fraction(turning) - r.s)
    return Apart(result.lower, result.upper, _three(rates), None, result.boxes)


def _rectangle(g: Mapping[str, float], upper: float):
    """((t_low, t_high), (y_low, y_high)) outside which every point is farther than `upper`."""
    kappa, a, K = g["kappa"], g["a"], g["K"]
    far = abs(kappa) * upper * WIDER
    q_low, q_high, v_most = g["u"] - far, g["u"] + far, abs(g["v"]) + far
    q2 = max(q_low * q_low, q_high * q_high)
    fold = (K * K / abs(a)) ** (1 / 3) * (1 - 1e-13)
    s_most = abs(K) / fold if fold else 0.0
    largest = v_most + 0.5 * (q2 + s_most * s_most) / abs(a)
    smallest = fold if fold else largest * 1e-40
    reach = 2 * (math.sqrt(abs(a) * largest) + s_most) / abs(kappa * a)  # phi >= 0 there
    span = (max(abs(q_low), abs(q_high)) + s_most) / abs(kappa * a)
    reach = min(reach, span) * WIDER
    return (math.log(smallest), math.log(largest)), (-reach, reach)


GEOMETRIES = {-1: _on_circles, 1: _on_hyperbolas, 0: _on_parabolas}


def separatrix_distance(scene: AnyScene, states: np.ndarray):
    """Euclidean distance (...,) of states (..., 3) from the nearest point of the scene's separatrix, in the
    unit of the states: to 1e-6, or a proved lower bound; inf where the scene has none, NaN where it is not
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


def _asker(scene: AnyScene):
    """The function of one state that gives its distance."""
    reduction, turn = reduce(scene), aligned(scene)
    if reduction is not None:
        return lambda state: distance_of(reduction, state).value
    if turn is not None:
        turned = reduce(turn.twin)
        return lambda state: distance_of(turned, turn(state)).value
    return lambda state: INF if has_no_saddle(scene) else math.nan


def has_no_saddle(scene: AnyScene) -> bool:
    """Whether a scene without a reduction, its torque on one axis or none, has no saddle for sure: a
    gyrostatic moment along the torque leaves no equilibrium, and with equal moments the kinetic energy is a
    linear function on each momentum sphere."""
    acting = sum(m != 0 for m in scene.quadratic().m)
    return acting == 1 or not acting and not any(scene.quadratic().kappa)


def distance_of(reduction: Reduction | None, state: Sequence[float | Fraction],
                orbit: Orbit | None = None) -> Apart:
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
            return Apart(0.0, 0.0, _three(state))
        # only a state that a barrier holds sees which of two is higher
        held = bool(reduction.sense) and reduction.e < 0 and decide(orbit, FIRST_BITS).sign >= 0
        result = settled(lambda numbers: GEOMETRIES[reduction.e](numbers, reduction, state, held), BITS,
                        MOST_BITS)
    except (Unclear, ArithmeticError, ValueError):  # the last: of a logarithm of what has vanished in doubles
        return UNKNOWN
    if result.upper != result.upper or result.lower != result.lower:
        return UNKNOWN
    return result if result.settled else result._replace(reason=ENDED)
