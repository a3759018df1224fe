"""Charts of the loops of a separatrix: their points obey the laws of the motion, slopes are those of the values,
and ranges over a box hold all of its points."""
from __future__ import annotations

import mpmath
import numpy as np
import pytest
from flint import arb

from stabilab.numbers.balls import working
from stabilab.orbit.reduction import reduce
from stabilab.orbit.separatrix import distance
from stabilab.orbit.separatrix.charts import HyperbolaChart, LoopChart, ParabolaChart
from stabilab.orbit.separatrix.distance import distance_of
from tests.oracles.pairs import physical
from tests.orbit.separatrix.test_branches import random_scene

KINDS = {LoopChart, HyperbolaChart, ParabolaChart}


@pytest.fixture(scope="module")
def points():
    """(reduction, state, chart, t, y) of points of the charts that searches on random scenes go through."""
    found, rng = [], np.random.default_rng(11)

    class Recorded(distance.Search):
        def run(self, charts):
            made.extend(charts)
            return super().run(charts)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(distance, "Search", Recorded)
        while len(found) < 300:
            moments, wheel, torque, state = random_scene(rng)
            made = []
            reduction = reduce(physical(moments, wheel, torque)[0])
            distance_of(reduction, state.tolist())
            for chart in made:
                (t0, t1), (y0, y1) = ([float(v.mid()) for v in ends] for ends in (chart.t, chart.y))
                t, y = rng.uniform(t0, min(t1, t0 + 8)), rng.uniform(y0, y1)
                found.append((reduction, state.tolist(), chart, t, y))
    assert {type(one[2]) for one in found} == KINDS
    return found


def test_points_of_loops_have_the_orbit_and_the_energy_of_their_saddle(points):
    """By Q = Z^2 - e X^2 and E = W^2/2 + V, V = -mu theta - G X^2/2 - c X - e d Z, in 60 digits."""
    mp, seen = mpmath.mp.clone(), 0
    mp.dps = 60
    of = lambda v: mp.mpf(v.numerator) / v.denominator
    for reduction, state, chart, t, y in points:
        if not reduction.e:
            continue
        g, e = {name: of(value) for name, value in distance.seen_from(reduction, state).items()}, reduction.e
        with working(256):
            first, second = (mp.mpf(v.str(50, radius=False)) for v in chart.curve.at(arb(t))[:2])
            u, v = (mp.mpf(n.str(50, radius=False)) for n in chart.place(arb(t), arb(y)))
            phi = mp.mpf(chart.point(arb(t), arb(y))[3].str(50, radius=False))
        X, Z = u + g["X"], v + g["Z"]
        if type(chart) is LoopChart:
            x, z, way = first, second, mp.mpf(y)
        else:
            x, z = (first + second) / 2, chart.flip * (first - second) / 2
            if not (X + chart.flip * Z) * first > 0:
                continue
            way = chart.flip * mp.log((X + chart.flip * Z) / first)
        height = lambda a, b, way: -g["mu"] * way - g["G"] * a * a / 2 - g["c"] * a - e * g["d"] * b
        size = 1 + abs(g["mu"] * way) + abs(g["G"]) * (X * X + x * x) + abs(g["c"]) + abs(g["d"])
        assert abs(Z * Z - e * X * X - z * z + e * x * x) < 1e-25 * (X * X + Z * Z + x * x + z * z)
        assert abs(g["mu"] + g["G"] * x * z + g["c"] * z + g["d"] * x) < 1e-25 * (1 + abs(x)) * (1 + abs(z))
        assert abs(phi / g["k"] - height(x, z, 0) + height(X, Z, way)) < 1e-20 * size * (1 + abs(X) + abs(Z))
        seen += 1
    assert seen > 100


def test_slopes_and_second_derivatives_are_those_of_the_values(points):
    """Against differences over 1e-12 in 256 bits."""
    with working(256):
        h = arb(10) ** -12
        for _, _, chart, t, y in points:
            t, y = arb(t), arb(y)
            at, known = chart.point(t, y), chart.ranges(t, y, float("inf"))
            if known is None or known.parts is None:  # no loop goes there
                continue
            for first in (0, 3):
                along = [(chart.point(t + h, y)[first] - chart.point(t - h, y)[first]) / (2 * h),
                         (chart.point(t, y + h)[first] - chart.point(t, y - h)[first]) / (2 * h)]
                for slope, other in zip(at[first + 1:first + 3], along):
                    assert abs(slope - other) <= (abs(slope) + abs(at[first]) + 1) * 1e-10
            for first, bends in zip((0, 3), chart.bends(known.parts)):
                tt, ty = ((chart.point(t + h, y)[first + n] - chart.point(t - h, y)[first + n]) / (2 * h)
                          for n in (1, 2))
                yy = (chart.point(t, y + h)[first + 2] - chart.point(t, y - h)[first + 2]) / (2 * h)
                for (middle, radius), other in zip(bends, (tt, ty, yy)):
                    size = abs(float(other.mid())) + abs(float(at[first].mid())) + 1
                    assert abs(middle - float(other.mid())) <= radius + 1e-10 * size


def test_ranges_over_a_box_hold_the_points_of_the_box(points):
    rng = np.random.default_rng(5)
    with working(128):
        for _, _, chart, t, y in points:
            dt, dy = 10.0 ** rng.uniform(-3, 0.3), abs(y) * 10.0 ** rng.uniform(-3, -0.1)
            known = chart.ranges(arb(t, dt), arb(y, dy), float("inf"))
            bends = chart.bends(known.parts) if known and known.parts else None
            for _ in range(4):
                s, z = t + dt * rng.uniform(-1, 1), y + dy * rng.uniform(-1, 1)
                if not chart.holds(arb(s), arb(z)) or chart.ranges(arb(s), arb(z), float("inf")) is None:
                    continue
                point = [float(v.mid()) for v in chart.point(arb(s), arb(z))]
                assert known is not None and known.apart <= point[0] * (1 + 1e-12) + 1e-12
                if point[3] >= 0:
                    assert known.phi[0] <= point[3] * (1 + 1e-9) + 1e-9
                    assert point[3] <= known.phi[1] * (1 + 1e-9) + 1e-9
                here = chart.ranges(arb(s), arb(z), float("inf"))
                if bends and here.parts:
                    for box, single in zip(bends, chart.bends(here.parts)):
                        for (middle, radius), (value, off) in zip(box, single):
                            assert abs(middle - value) <= radius * (1 + 1e-9) + off + 1e-9 * abs(value)
