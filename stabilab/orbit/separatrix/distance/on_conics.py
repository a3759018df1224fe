"""The distance from the separatrix of a scene whose orbits are circles or hyperbolas: its branches of saddles and their charts.

Without a torque the states of an invariant plane whose energy exceeds that of the resting centre tend to a rotation about the
axis and are on the separatrix too: a flat piece, bounded by the loops' limit n^2 W^2/2 = u(xi, eta). Its distance is that of
the plane where the foot of the perpendicular has the energy; else the nearest point is on that limit, where the sheets end.
With a torque no point of the planes is a limit of sheets but the curve of each saddle on them: a sheet beside a plane keeps
eta = eta* exp(-(n^2 W^2/2 + ...)/mu) > 0 at every rate W.
"""
from __future__ import annotations

import math
from fractions import Fraction
from itertools import pairwise
from typing import Any, NamedTuple

from ....numbers.balls import FIRST_BITS
from ...conic import conic_of
from ...fate.balls import decide
from ...potential import slope_at
from ..result import NO_SEPARATRIX, Apart
from .annulus import within
from .charts.long_loops import loops_of, planes_met
from .charts.loop_chart import Chart
from .charts.round_charts import OppositeChart, TurnedChart, mirrored
from .curves import Hyperbola, Straight
from .point import UNIT, Seen
from .search import nearest
from .shade import Shade

INF = math.inf
QUARTER = 0.5 * math.pi * (1 + 1e-15)


def on_conic(reduction, state, orbit) -> Apart:
    """The distance of a state whose orbit is a circle or a hyperbola."""
    seen, way = Seen.of(reduction, state), GEOMETRIES[reduction.e]
    arcs = list(_arcs(way, conic_of(reduction), seen))
    shade = way.shade(orbit, arcs)
    start = min([_first(seen, arc, shade) for arc in arcs] + way.flat(seen, reduction.sense, arcs), key=lambda one: one[0], default=None)
    if start is None:
        return NO_SEPARATRIX
    if start[0] == 0:  # at the end of a branch
        return Apart(0.0, 0.0, (float(state[0]), float(state[1]), float(state[2])))
    charts = [chart for arc in arcs for chart in arc.charts(seen, reduction.sense, start[0])]
    charts += way.opposite(lambda other: _arcs(way, conic_of(reduction), other), seen, start[0])
    found = nearest(charts, seen.plain["w"], start[0] * (1 + 1e-14) + 1e-300, genuine=shade, start=_on_chart(charts, *start[2:]))
    place = start[1] if found.chart is None else found.chart.place(found.t, found.y)
    return Apart(found.lower, found.upper, _rates(reduction, seen, place, state), "", found.boxes)


def _on_chart(charts, saddle=None):
    """(chart, t, y) of a saddle (branch, t)."""
    on = [chart for chart in charts if saddle and chart.from_saddle and chart.curve is saddle[0] and chart.t[0] <= saddle[1] <= chart.t[1]
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
        """Charts of the same loops opposite to their saddles; arcs_of: the branches as told from another place."""
        image = mirrored(seen)
        return [OppositeChart(image, arc.curve, piece, (-QUARTER, QUARTER)) for arc in arcs_of(image) for piece in arc._pieces(image, upper)]

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
        """What may shade a sheet: only a state that a barrier holds sees the difference, and only where there are two barriers."""
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
        return ([] if sense else _flat_pieces(seen)) + [place for arc in arcs for place in planes_met(seen, arc.curve, arc.low, arc.high)]

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
            if slope_at(*(seen.plain[n] for n in ("G", "c", "d")), seen.e, *curve.at(_between(low, high))[:2]) > 0:
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
        if distance < best[0] and (shade is None or shade(Chart(seen, arc.curve, (t, t), (0.0, 0.0)), t, 0.0)):
            best = distance, (at.u, at.v, 0.0), (arc.curve, t)
    return best


def _flat_pieces(seen):
    """[(distance, foot)] of the planes of a hyperbola without torque, where the foot of the perpendicular is on the separatrix."""
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
