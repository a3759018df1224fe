"""How far a state is from the separatrix: the smallest change of the three rates that reaches it, with a proof and a witness.

The separatrix is the set of states whose fate is to tend to a saddle of the reduced potential: the loops of all saddles, on a
circle under a torque of those that no higher barrier stands beside (`shade`), swept along the branches of saddles. Branch and
bound over these sheets (`nearest`) brings a proved lower bound and a point of the separatrix together; where the doubles or the
number of boxes do not reach that far, both are told as a bracket. A sheet that nears an invariant plane is followed in coordinates of
its own (`plane_chart`).

Without a torque the states of an invariant plane whose energy exceeds that of the resting centre tend to a rotation about the
axis and are on the separatrix too: a flat piece, bounded by the loops' limit n^2 W^2/2 = u(xi, eta). Its distance is that of
the plane where the foot of the perpendicular has the energy; else the nearest point is on that limit, where the sheets end.
With a torque no point of the planes is a limit of sheets but the curve of each saddle on them: a sheet beside a plane keeps
eta = eta* exp(-(n^2 W^2/2 + ...)/mu) > 0 at every rate W.
"""
from __future__ import annotations

import math
from fractions import Fraction
from typing import Any, NamedTuple

from ...numbers.balls import DOUBLE_BITS
from ...numbers.double_ball import Unclear
from ...numbers.vectors import Float3
from ...physics.alignment import aligned
from ..ball_orbit import Orbit
from ..conic import Conic
from ..fate.balls import decide
from ..reduction import reduce
from .nearest import nearest
from .parabola_chart import ParabolaChart, parabola_seen, rectangle
from .plane_chart import PlaneChart, plane_roots
from .saddles import foot
from .shade import Shade
from .sheet_chart import EPS, ROUNDINGS, Chart, Hyperbola, Seen, Straight

AGREE = 1e-9  # relative: nearer than that, lower bound and witness are one number
LEAST_SHARE = 1e-90  # of a place beside a plane: nearer, and the chart of the loops themselves goes on alone
INF = math.inf


class Apart(NamedTuple):
    """The distance of a state from the separatrix lies in [lower, upper]; witness: a point of it (three rates) at `upper`.

    inf, inf, None where the scene has no separatrix. because: why the two are apart by more than AGREE, else empty.
    """

    lower: float
    upper: float
    witness: Float3 | None
    because: str = ""
    boxes: int = 0

    @property
    def value(self) -> float:
        """The distance where it is known to AGREE, else what it certainly is not below."""
        return self.upper if self.settled else self.lower

    @property
    def settled(self) -> bool:
        return self.upper == self.lower or self.upper - self.lower <= AGREE * self.upper


NO_SEPARATRIX = Apart(INF, INF, None)
UNKNOWN = Apart(0.0, INF, None, "the numbers of this scene are beyond what the search for the nearest point of the separatrix holds")
ENDED = "the search ended before its proved lower bound met the nearest point found"


def separatrix_distance(scene, states):
    """Euclidean distance (...,) of states (..., 3) from the nearest point of the scene's separatrix, in the unit of the
    states: to 1e-9, or a proved lower bound; inf where the scene has none, NaN where it is not known.

    A torque in a plane of equal moments: the distance of the turned state in the turned scene, as a turn keeps distances. Not known:
    a free gyrostat without a reduction (its separatrix is known by its energy on each momentum sphere, not as sheets), and a torque
    off the axes. A gyrostatic moment along the torque leaves no equilibrium (|H|^2/2 - D T grows steadily), so no separatrix: inf.
    """
    import numpy as np
    array = np.asarray(states, float)
    asked = _asker(scene)
    flat = [asked(state) for state in array.reshape(-1, 3).tolist()]
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
    """Whether a scene without a reduction, its torque on one axis or none, has no saddle for sure: a gyrostatic moment along the torque
    leaves no equilibrium, and with equal moments the kinetic energy is a linear function on each momentum sphere."""
    acting = sum(m != 0 for m in scene.quadratic().m)
    return acting == 1 or not acting and not any(scene.quadratic().kappa)


def distance_of(reduction, state, orbit: Orbit | None = None) -> Apart:
    """The distance of one state (three floats or Fractions) of a scene with this reduction (None: it has none).

    orbit: the state's, where that is at hand.
    """
    if reduction is None:
        return NO_SEPARATRIX
    state = tuple(v if isinstance(v, Fraction) else float(v) for v in state)
    try:
        found = _on_conic(reduction, state, orbit or Orbit(reduction, state)) if reduction.e else _on_parabolas(reduction, state)
    except (Unclear, ArithmeticError, ValueError):  # a logarithm of what has vanished in doubles is a ValueError
        return UNKNOWN
    if found.upper != found.upper or found.lower != found.lower:
        return UNKNOWN
    return found if found.settled else found._replace(because=ENDED)


# --- circles and hyperbolas
def _on_conic(reduction, state, orbit) -> Apart:
    seen, conic = Seen.of(reduction, state), Conic(reduction)
    arcs = list(_arcs(conic, seen))
    if not arcs and not (seen.e > 0 and reduction.sense == 0):
        return NO_SEPARATRIX
    shade = _shade(orbit, arcs)
    flat = _flat_pieces(seen, reduction.sense)
    start = min([_first(seen, arc, shade) for arc in arcs] + flat, key=lambda one: one[0], default=None)
    if start is None:
        return NO_SEPARATRIX
    charts = [chart for arc in arcs for chart in arc.charts(seen, reduction.sense, arcs, start[0])]
    if seen.e > 0:
        charts += _plane_charts(seen, conic, arcs, start[0])
    found = nearest(charts, seen.plain["w"], start[0] * (1 + 1e-14) + 1e-300, genuine=shade)
    place = start[1] if found.chart is None else found.chart.place(found.t, found.y)
    return Apart(found.lower, found.upper, _rates(reduction, seen, place, state), "", found.boxes)


class _Arc(NamedTuple):
    """A branch of saddles: t from low to high (inf: open) along a curve."""

    curve: Any
    low: float
    high: float

    def window(self, seen, upper):
        """The part of [low, high] whose saddles' orbits come within `upper` of the state."""
        g = seen.plain
        reach = math.hypot(g["X"], g["Z"]) + upper * (1 + 1e-9) / math.sqrt(min(g["a"], g["b"]))
        if seen.e > 0:
            return self.low, self.high  # the saddles of a hyperbola lie within a circle
        low, high = self.curve.window(reach)
        return max(self.low, low), min(self.high, high)

    def charts(self, seen, sense, arcs, upper):
        t = self.window(seen, upper)
        if not t[0] <= t[1]:
            return
        if seen.e < 0:
            y = (-2 * math.pi, 0.0) if sense else (-math.pi, math.pi)
        else:
            y = _ways(seen, self, arcs, upper)
        yield Chart(seen, self.curve, t, y)


def _arcs(conic, seen):
    """The branches of saddles."""
    for piece in conic.pieces:
        if piece.barrier:
            curve = Hyperbola(seen, *conic.sharp_ends(piece), piece.sign)
            yield _Arc(curve, curve.low, curve.high)
    for line in conic.lines:
        curve = Straight(seen, line)
        knots = sorted({-INF, *_knots(conic, line), INF})
        for low, high in zip(knots, knots[1:]):
            if _slope(seen, *curve.at(_between(low, high))[:2]) > 0:
                yield _Arc(curve, low, high)


def _knots(conic, line):
    yield foot(conic, line)
    if conic.G:  # where the two lines cross
        yield -conic.d / conic.G - line.z0 if line.dz else -conic.c / conic.G - line.x0


def _between(low, high):
    if low == -INF:
        return high - 1 - abs(high) if high < INF else 0.0
    return low + 1 + abs(low) if high == INF else 0.5 * (low + high)


def _slope(seen, x, z):
    g, e = seen.plain, seen.e
    return g["G"] * (z * z + e * x * x) + e * g["c"] * x + g["d"] * z


def _shade(orbit, arcs):
    """What may shade a sheet: only a state that a barrier holds sees the difference, and only where there are two barriers."""
    reduction = orbit.reduction
    if reduction.e > 0 or not reduction.sense or len(arcs) < 2:
        return None
    if decide(orbit, DOUBLE_BITS).sign < 0:
        return None
    g = reduction.constants
    return Shade((g["G"], g["c"], g["d"], g["mu"]))


def _first(seen, arc, shade):
    """(distance, (X, Z, W)) of the nearest of some saddles of a branch that count."""
    g = seen.plain
    size = math.hypot(g["X"], g["Z"])
    places = [0.0] if isinstance(arc.curve, Hyperbola) and arc.low <= 0 <= arc.high else []
    ends = [t for t in (arc.low, arc.high) if math.isfinite(t)]
    near = arc.curve.window(2 * size + 1e-300)
    for low, high in ((arc.low, arc.high), near, (ends[0] - 1, ends[-1] + 1) if ends else near):
        low, high = max(low, arc.low), min(high, arc.high)
        if math.isfinite(low) and math.isfinite(high) and low <= high:
            places += [low + (high - low) * n / 8 for n in range(9)]
    best = INF, None
    for t in places:
        at = arc.curve.at(t)
        u, v = abs(at.u) + ROUNDINGS * EPS * at.su, abs(at.v) + ROUNDINGS * EPS * at.sv
        distance = math.sqrt(g["a"] * u * u + g["b"] * v * v + g["w"] ** 2)
        if distance < best[0] and (shade is None or shade(Chart(seen, arc.curve, (t, t), (0.0, 0.0)), t, 0.0)):
            best = distance, (at.u, at.v, 0.0)
    return best


def _ways(seen, arc, arcs, upper):
    """(y_low, y_high) of the loops of a branch on a hyperbola, up to where the charts beside the planes take over."""
    g = seen.plain
    ends = []
    for flip in (-1.0, 1.0):  # against the orbit eta grows, along it xi
        most = max(map(abs, _window_of(g, flip, upper)))
        gap, meets = _beside(g, arc, flip)
        gap = _taken_over(g, arcs, flip) if meets else gap
        ends.append(max(math.log(most / gap), 0.0) + 0.01 if most else 0.01)
    return -ends[0], ends[1]


def _taken_over(g, arcs, flip):
    """Size of X + flip Z below which the saddles of the branches that meet this plane are left to the chart beside it."""
    return max(min((share for share, meets in (_beside(g, arc, flip) for arc in arcs) if meets), default=0.0), LEAST_SHARE)


def _window_of(g, flip, upper):
    """Least and greatest xi = X + flip Z within `upper` of the state."""
    xi = g["X"] + flip * g["Z"]
    wide = upper * (1 / math.sqrt(g["a"]) + 1 / math.sqrt(g["b"])) * (1 + 1e-9)
    return xi - wide, xi + wide


def _beside(g, arc, flip):
    """(size, meets): a branch either meets the plane xi = X + flip Z = 0, with saddles that are smooth functions of xi up to the
    size, or it does not, and keeps that far from it."""
    curve, values = arc.curve, []
    spots = [arc.low, arc.high]
    if isinstance(curve, Hyperbola):
        K, c, G, shift = curve.plain
        turn = flip * K / G  # xi = K/(h G) + flip h - ... is stationary at h^2 = flip K/G
        if turn > 0:
            spots.insert(1, min(max(curve.to(math.sqrt(turn)), arc.low), arc.high))
    for t in spots:
        x, z = curve.at(t)[:2]
        values.append(x + flip * z)
    values = [0.0 if abs(v) <= 1e-13 * (abs(g["c"]) + abs(g["d"])) / abs(g["G"]) else v for v in values]
    if min(values) > 0 or max(values) < 0:
        return min(map(abs, values)), False
    return min([_regular_up_to(g, flip)] + [0.5 * abs(v) for v in (values[0], values[-1]) if v]), True


def _regular_up_to(g, flip):
    """|xi| up to which the saddles beside the plane xi = 0 are smooth functions of xi."""
    e1, e2 = 0.5 * (g["c"] + flip * g["d"]), 0.5 * (flip * g["d"] - g["c"])
    rate2, G = e2 * e2 + g["G"] * flip * g["mu"], abs(g["G"])
    if rate2 <= 0:
        return 0.0
    return min(0.125 * rate2 / (G * abs(e1)) if e1 else INF, 0.7 * math.sqrt(rate2) / G)


def _plane_charts(seen, conic, arcs, upper):
    g = seen.plain
    for flip in (1.0, -1.0):
        roots = plane_roots(g, flip < 0)
        low, high = _window_of(g, flip, upper)
        e1 = 0.5 * (g["c"] + flip * g["d"])
        choices = [(root, low, high) for root in roots]
        if not g["mu"] and e1 and conic.pieces:  # saddles begin at the centre, on one side of the plane
            choices.append((0.0, max(low, 0.0) if e1 > 0 else low, min(high, 0.0) if e1 < 0 else high))
        share = _taken_over(g, arcs, flip)
        for root, low, high in choices:
            most = max(abs(low), abs(high))
            if not low < high or share == LEAST_SHARE:
                continue
            begin = max(math.log(most / share), 0.0) if most else 0.0
            end = _farthest(g, flip, root, most, upper)
            if begin < end:
                xi0 = g["X"] + flip * g["Z"]
                yield PlaneChart(seen, root, (low - xi0, high - xi0), (begin, end), flip < 0)


def _farthest(g, flip, root, most, upper):
    """The way y beyond which W is too great (or none is left); 720 where it makes no difference any more."""
    mu, G = flip * g["mu"], abs(g["G"])
    e1 = e2 = 0.5 * (abs(g["c"]) + abs(g["d"]))
    if not mu:
        return 720.0
    other = 2 * (most * (0.125 * G * most + e1) + 2 * abs(root) * (G * abs(root) + e2)) + e1 * most
    swing = 0.5 * g["n2"] * (g["w"] + upper) ** 2 if mu > 0 else 0.0
    return (swing + other) / abs(mu) * (1 + 1e-9) + 1


def _flat_pieces(seen, sense):
    """[(distance, foot)] of the planes of a hyperbola without torque, where the foot of the perpendicular is on the separatrix."""
    if seen.e < 0 or sense:
        return []
    g, found = seen.plain, []
    for flip in (1.0, -1.0):  # Z = flip X
        x = (g["a"] * g["X"] + flip * g["b"] * g["Z"]) / (g["a"] + g["b"])
        energy = 0.5 * g["n2"] * g["w"] ** 2 - x * (0.5 * g["G"] * x + g["c"] + flip * g["d"])
        if energy >= 0:
            apart = abs(g["X"] - flip * g["Z"]) * math.sqrt(g["a"] * g["b"] / (g["a"] + g["b"]))
            found.append((apart, (x - g["X"], flip * x - g["Z"], g["w"])))
    return found


def _rates(reduction, seen, place, state):
    """The three rates at (X, Z, |W|/n), X and Z less the state's, with W of the sign of the state's."""
    x, z, w = place
    r, g = reduction, reduction.constants
    out = [0.0] * 3
    out[r.j], out[r.k] = float(state[r.j]) + g["flip"] * g["rx"] * x, float(state[r.k]) + g["rz"] * z
    sign = 1.0 if Fraction(state[r.axis]) + r.s >= 0 else -1.0
    out[r.axis] = sign * w - float(r.s)
    return tuple(out)


# --- parabolas
def _on_parabolas(reduction, state) -> Apart:
    constants = parabola_seen(reduction, state)
    if constants is None:
        return NO_SEPARATRIX
    seen = Seen(0, *constants)
    g = seen.plain
    fold = (g["K"] ** 2 / abs(g["a"])) ** (1 / 3) or abs(g["v"]) or abs(g["a"])
    upper = INF
    for n in range(-8, 60):
        N = math.copysign(fold * 2 ** (n / 4 if n > 0 else n if not g["K"] else 0), g["a"])
        upper = min(upper, math.sqrt(((g["K"] / N - g["u"]) ** 2 + (N - g["v"]) ** 2) / g["kappa"] ** 2 + g["w"] ** 2))
    t, y = rectangle(g, upper)
    found = nearest([ParabolaChart(seen, t, y)], g["w"], upper * (1 + 1e-12))
    witness = None if found.chart is None else found.chart.rates(reduction, state, found.t, found.y)
    return Apart(found.lower, found.upper, witness, "", found.boxes)
