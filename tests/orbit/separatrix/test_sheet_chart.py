"""The sheets of a separatrix seen from a state: rounding bounds of the charts, brackets where two moments are nearly equal."""
from __future__ import annotations

import mpmath
import numpy as np
import pytest

import stabilab
from stabilab.orbit.conic import Conic
from stabilab.orbit.reduction import reduce
from stabilab.orbit.separatrix.distance import distance_of
from stabilab.orbit.separatrix.sheet_chart import Chart, Hyperbola, Seen
from tests.oracles.pairs import physical


def test_the_chart_beside_a_state_errs_by_less_than_its_bounds_however_alike_two_moments_are():
    """Against the potential and the rotated saddle in 80 digits, from the exact constants."""
    rng, mp = np.random.default_rng(3), mpmath.mp.clone()
    mp.dps, seen_charts = 80, 0
    for gap in 10.0 ** np.arange(-14, 0):
        for pair in ((0, 1), (0, 2), (1, 2)):
            moments = rng.uniform(1.0, 1.3, 3)
            moments[pair[1]] = moments[pair[0]] * (1 + gap)
            wheel, torque, state = rng.normal(size=3), (0, 0, float(rng.normal())), rng.normal(size=3).tolist()
            reduction = reduce(physical(tuple(moments), (*wheel[:2], 0), torque)[0])
            seen, conic = Seen.of(reduction, state), Conic(reduction)
            for piece in conic.pieces:
                if not piece.barrier:
                    continue
                curve = Hyperbola(seen, *conic.sharp_ends(piece), piece.sign)
                chart = Chart(seen, curve, (-1.0, 1.0), (-3.0, 3.0))
                for _ in range(6):
                    t, y = (float(v) for v in rng.choice((-1, 1), 2) * 10.0 ** rng.uniform((-13, -10), 0))
                    p, (apart, phi) = chart.point(t, y), exact_point(mp, curve, t, y)
                    assert abs(p.apart - apart) <= p.off[0] and abs(p.phi - phi) <= p.off[1]
                    seen_charts += 1
    assert seen_charts > 200


def exact_point(mp, curve, t, y):
    """Squared distance in the plane of the orbit and W^2 of a loop of a hyperbola's sheet, in many digits."""
    seen, of = curve.seen, lambda v: mp.mpf(v.numerator) / v.denominator
    g = {name: of(value) for name, value in seen.exact.items()}
    h = of(curve.h0) * mp.exp(t)
    x, z = (of(curve.K) / h - g["c"]) / g["G"], h - of(curve.shift)
    C, S = (mp.cos(y), mp.sin(y)) if seen.e < 0 else (mp.cosh(y), mp.sinh(y))
    X, Z = x * C + z * S, z * C + seen.e * x * S
    # dX/dy = Z and F = mu + G X Z + c Z + d X = -V' with V = -mu y - G X^2/2 - c X - e d Z
    V = lambda y, X, Z: -g["mu"] * y - g["G"] * X * X / 2 - g["c"] * X - seen.e * g["d"] * Z
    return g["a"] * (X - g["X"]) ** 2 + g["b"] * (Z - g["Z"]) ** 2, 2 * (V(0, x, z) - V(mp.mpf(y), X, Z)) / g["n2"]


@pytest.mark.parametrize("lift", [1e-5, -1e-7, 1e-9, -1e-11, 1e-12])
@pytest.mark.parametrize("pair, state", [((0, 1), (0.4, 0.3, 0.5)), ((1, 0), (-1.0, 0.3, 2.0))])
def test_bound_and_witness_meet_however_alike_two_moments_are(lift, pair, state):
    """The doubles of loops told from the centre of the orbits used to leave brackets of up to 9 %. The witness is on the separatrix:
    the margin, which has no code in common with the search, changes its sign there."""
    moments = [1.2, 1.2, 1.0]
    moments[pair[1]] *= 1 + lift
    scene, state = physical(moments, (0.3, 0.2, 0), (0, 0, 0.1))[0], np.array(state)
    found = distance_of(reduce(scene), state.tolist())
    way = np.array(found.witness) - state
    assert found.settled and np.linalg.norm(way) == pytest.approx(found.upper, rel=2e-9)
    signs = [np.sign(stabilab.fate(scene, state + way * (1 + side)).margins) for side in (-1e-6, 1e-6)]
    assert signs[0] * signs[1] < 0


@pytest.mark.parametrize("inertia, wheel, torque, state", [
    ((1.49736644, 0.44230883, 1.49736648), (-1.367, 0, 0), (0, 0, 0), (0.0977, -0.00325, 0.2235)),
    ((1.6706906974740514, 1.6706906974740514, 1.236882267730723), (0.2887157196510496, 0.6707558503088299, 0), (0, 0, 0),
     (-0.005014297134250996, 0.006338772360293345, 0.0015443377386760225)),
    ((1.2118380149530614, 1.13074942401926, 1.276202384807355), (-1.3650447610137093, 0, -1.953706814412097), (0, 0, 0),
     (0.5646276455972182, 0.005992371043408872, 0.39077055411060624)),
    ((1.3514392022064112, 1.837516534734172, 1.3514017666271823), (0.7865822722196931, 0, 0), (0, 0, 0.3020370702905364),
     (-2.4811783407460117, 1.2515862632451265, -5.671545379657007))])
def test_bound_and_witness_meet_at_the_tips_of_cones_and_beside_the_folds_of_far_circles(inertia, wheel, torque, state):
    """There W grows like a root, and halving boxes by the slopes of smooth bounds used to leave brackets of 2e-8 to 4e-6."""
    found = distance_of(reduce(physical(inertia, wheel, torque)[0]), state)
    assert found.settled and np.linalg.norm(np.array(found.witness) - state) == pytest.approx(found.upper, rel=1e-9)
