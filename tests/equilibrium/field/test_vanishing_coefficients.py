"""No verdict is left open, and none is wrong, because a coefficient of a spectrum, or a difference of its squares,
vanishes at a point, all along a branch, or all round a circle.

Independent means: the equations D omega' = (D omega + Lambda) x omega + s x gamma + N gamma x D gamma
+ E gamma3 omega x e3 + M, gamma' = gamma x omega and their derivatives, written here, with NumPy's eigenvalues;
Lagrange's criterion by hand; SciPy's runs.
"""
import random
from fractions import Fraction
from math import isfinite

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.answers.equilibria import equilibria
from stabilab.equilibrium.field_balance import Field, judged, rotations_at
from stabilab.numbers.balls import MANY_BITS, working
from stabilab.physics.coefficients import content
from stabilab.physics.effects.charge import Charge
from stabilab.physics.effects.gravity import Gravity
from stabilab.physics.effects.newtonian_field import NewtonianField

FEW = (1, 1, 2, Fraction(3, 2))  # moments that are equal or in simple ratios
SMALL = 3e-3                     # of the largest eigenvalue: less may be a small number or a rounded zero


def scene_of(D, wheel, weight, N, E, M):
    effects = [Gyrostat(wheel), Gravity(1, weight)]
    effects += [NewtonianField(N)] * bool(N) + [Charge(E, 1, 1, "attitude")] * bool(E)
    return Scene(Body(D), *effects, *[ConstantTorque(M)] * any(M))


def cross_of(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def rates_and_jacobian(D, wheel, weight, N, E, M, at):
    D, wheel, weight, M = (np.array(v, float) for v in (D, wheel, weight, M))
    w, g, e3 = np.array(at[:3]), np.array(at[3:]), np.array([0, 0, 1.0])
    torque = (np.cross(D * w + wheel, w) + np.cross(weight, g) + N * np.cross(g, D * g)
              + E * g[2] * np.cross(w, e3) + M)
    by_w = cross_of(D * w + wheel) - cross_of(w) @ np.diag(D) - E * g[2] * cross_of(e3)
    by_g = (cross_of(weight) + N * (cross_of(g) @ np.diag(D) - cross_of(D * g))
            + E * np.outer(np.cross(w, e3), e3))
    rows = np.block([[by_w / D[:, None], by_g / D[:, None]], [cross_of(g), -cross_of(w)]])
    return np.concatenate([torque / D, np.cross(g, w)]), rows


def places(found, rng):
    """(state, linear, verdict) at every sample, and inside every segment at two places by chance."""
    for curve in found.curves:
        for point in curve.samples:
            yield point.at, point.linear, point.verdict
        for segment in curve.segments:
            low, high = segment.t
            low = low if isfinite(low) else high - 5 if isfinite(high) else -3.0
            high = high if isfinite(high) else low + 8
            for t in (rng.uniform(low, high) for _ in range(2)):
                yield curve.point(t), segment.linear, segment.verdict


def disagreements(parts, rng):
    wrong = []
    found = [one for one in places(equilibria(scene_of(*parts)), rng) if len(one[0]) == 6]
    for at, linear, verdict in found:  # of three rates: no field acts (a Newtonian one on a sphere, say)
        rates, rows = rates_and_jacobian(*parts, at)
        assert np.abs(rates).max() <= 1e-9 * (1 + np.abs(at).max() ** 2), (parts, at)
        values = np.linalg.eigvals(rows)
        grows, size = values.real.max(), 1 + np.abs(values).max()
        if grows > SMALL * size and (linear, verdict) != ("unstable", "unstable"):
            if not (verdict == "unstable" and linear == "degenerate"):
                wrong.append((parts, at, linear, verdict, grows))
        if verdict == "stable" and grows > SMALL * size:
            wrong.append((parts, at, linear, verdict, grows))
    return wrong


def chosen(rng):
    D = [rng.choice(FEW) for _ in range(3)]
    number = lambda: rng.choice((0, 0, 0, 1, -1, 2))
    wheel, weight = ([number() for _ in range(3)] if rng.random() < 0.5 else [0, 0, number()] for _ in range(2))
    M = [0, 0, 0]
    if rng.random() < 0.3:
        M[rng.randrange(3)] = rng.choice((1, Fraction(1, 10)))
    return D, wheel, weight, rng.choice((0, 0, 1, -1, 3)), rng.choice((0, 0, 0, 1, -2)), M


@pytest.mark.one_in(2)
@pytest.mark.parametrize("seed", [*range(2), *(pytest.param(n, marks=pytest.mark.slow) for n in range(2, 12))])
def test_no_place_whose_eigenvalues_grow_is_called_anything_but_unstable(seed):
    rng = random.Random(seed)
    parts = [chosen(rng) for _ in range(20)]
    assert not [one for each in parts if any(each[2]) or each[3] or each[4] for one in disagreements(each, rng)]


SPECIAL = [  # (D, wheel, weight, N, E, M) whose a, b or a^2 - 4 b vanishes all along a branch or round a circle
    ([1, 1, 2], [0, 0, 0], [0, 0, 1], 0, 0, [0, 0, 0]),       # a disc: a^2 = 4 b at every rate
    ([2, 1, 1], [0, 0, 0], [-1, 0, 0], 3, 0, [0, 0, 0]),      # the same on axis 1, in a Newtonian field
    ([1, 2, 1], [0, 0, -1], [0, 0, -1], -1, 0, [0, 0, 0]),    # a circle on which b has both signs
    ([2, Fraction(3, 2), 1], [0, 0, 0], [0, 0, 0], 3, -2, [0, 0, 0]),  # one at an irrational rate
    ([1, 1, 1], [0, 0, -1], [0, 0, 1], 1, -2, [1, 0, 0]),     # a torque; the quadratic in Omega is linear
    ([1, 2, Fraction(3, 2)], [0, 0, 2], [-1, 0, 2], 1, 0, [0, Fraction(1, 10), 0]),  # verdicts change along
]


@pytest.mark.parametrize("parts", SPECIAL)
def test_nor_where_a_coefficient_vanishes_all_along(parts):
    assert not disagreements(parts, random.Random(0))


def sleeping(A, C, weight, wheel=0, N=0, axis=2):
    """{side: segments} of rotations about the axis of symmetry, gamma along it (side 1) or against it."""
    turned = lambda v, others: [v if i == axis else others for i in range(3)]
    found = equilibria(scene_of(turned(C, A), turned(wheel, 0), turned(weight, 0), N, 0, [0, 0, 0]))
    return {round(curve.samples[0].at[3 + axis]): curve.segments for curve in found.curves
            if "circle" not in curve.name and abs(curve.samples[0].at[3 + axis]) == 1}


@pytest.mark.parametrize("A, C, weight, wheel, N, axis", [
    (1, 2, 1, 0, 0, 2), (3, 6, 2, 0, 0, 0), (2, 4, 1, 0, -1, 1), (1, 2, 1, 1, 0, 2), (1, 3, 1, 0, 0, 2),
    (Fraction(1, 2), 1, 1, 0, Fraction(1, 3), 2)])
def test_a_sleeping_top_is_unstable_below_lagranges_rate_and_there_alone(A, C, weight, wheel, N, axis):
    for side, segments in sleeping(A, C, weight, wheel, N, axis).items():
        # by hand: unstable where (C Omega + side wheel)^2 < 4 A (N (C - A) - side weight)
        critical = 4 * A * (N * (C - A) - side * weight)
        for segment in segments:
            low, high = segment.t
            t = (0.0 if (low, high) == (-np.inf, np.inf) else high - 1 if low == -np.inf else low + 1
                 if high == np.inf else (low + high) / 2)
            unstable = (float(C) * t + side * wheel) ** 2 < critical
            assert segment.verdict == ("unstable" if unstable else "stable"), (side, segment)
        if critical > 0:
            ends = sorted({end for segment in segments if segment.verdict == "unstable" for end in segment.t})
            bounds = [(sign * float(critical) ** 0.5 - side * wheel) / float(C) for sign in (-1, 1)]
            assert np.allclose([ends[0], ends[-1]], bounds, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("A, C, weight, N, verdict", [
    (1, 2, -1, 0, "stable"), (1, 2, -3, -2, "unstable"), (1, 3, Fraction(-9, 4), 0, "stable")])
def test_at_lagranges_rate_itself_the_next_term_decides_as_a_run_does(A, C, weight, N, verdict):
    # Omega = 1: 4 A (N (C - A) - weight) = C^2 exactly; rates and lean are perturbed by 1 per cent
    scene = scene_of([A, A, C], [0, 0, 0], [0, 0, weight], N, 0, [0, 0, 0])
    with working(MANY_BITS):
        field = Field.of(content(scene))
        points = [judged(field, Fraction(1), one) for one in rotations_at(field, Fraction(1))
                  if one.gamma[2] > 0 and not one.circle]
    assert {point.verdict for point in points} == {verdict}
    s, k, least = float(weight), 1 - C / A, 1.0

    def rates(t, y):  # of the symmetric body; the torque is s e3 x gamma + N gamma x D gamma
        p, q, r, a, b, c = y
        pull = s - N * (C - A) * c
        return [k * q * r - pull * b / A, -k * p * r + pull * a / A, 0, b * r - c * q, c * p - a * r, a * q - b * p]
    for turn in range(3):
        x = np.array([0.01 * np.cos(2 * turn), 0.01 * np.sin(2 * turn), 1, 0.01, 0, (1 - 1e-4) ** 0.5])
        run = solve_ivp(rates, (0, 150), x, method="DOP853", rtol=1e-9, atol=1e-11)
        least = min(least, run.y[5].min())
    assert (least < 0.9) == (verdict == "unstable"), least  # SciPy DOP853


def test_a_disc_as_a_sleeping_top_has_no_verdict_open():
    found = equilibria(Scene(Body((1, 1, 2)), Gravity("4.9", (0, 0, "0.05"))))
    assert {segment.verdict for curve in found.curves for segment in curve.segments} == {"stable", "unstable"}
    rates = {segment.t for curve in found.curves for segment in curve.segments
             if segment.verdict == "unstable" and isfinite(sum(segment.t)) and "circle" not in curve.name}
    assert min(low for low, _ in rates) == pytest.approx(-(0.245**0.5), rel=1e-12)  # 2 sqrt(A P)/C, by hand
    assert max(high for _, high in rates) == pytest.approx(0.245**0.5, rel=1e-12)
