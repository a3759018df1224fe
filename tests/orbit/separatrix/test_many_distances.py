"""Distances from the separatrix on many scenes: bound and witness agree, images agree, and points found by
integration are no nearer."""
from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stabilab.orbit.reduction import reduce
from stabilab.orbit.separatrix.distance import distance_of
from tests.oracles.pairs import physical
from tests.orbit.separatrix.test_branches import random_scene


def images_agree(number, seed):
    """Scenes and their images under signed permutations of the axes (all quantities are axial vectors): lower
    bound and witness agree to 1e-9, and so do a scene and its image, as an isometry keeps distances."""
    rng, known = np.random.default_rng(seed), 0
    while known < number:
        moments, wheel, torque, state = random_scene(rng)
        order, image = rng.permutation(3), np.zeros((3, 3))
        image[range(3), order] = rng.choice([-1, 1], 3)
        image *= round(np.linalg.det(image))
        one = reduce(physical(moments, wheel, torque)[0])
        other = reduce(physical(moments[order], image @ wheel, image @ torque)[0])
        if one is None:
            assert other is None
            continue
        first, second = distance_of(one, state.tolist()), distance_of(other, (image @ state).tolist())
        if first.witness is None:
            assert second.witness is None
            continue
        known += 1
        what = moments, wheel, torque, state, order
        assert first.settled and second.settled, what
        assert abs(first.upper - second.upper) <= 1.1e-9 * first.upper, what


@pytest.mark.parametrize("number", [15, pytest.param(1000, marks=[pytest.mark.slow, pytest.mark.long])])
def test_a_scene_and_its_image_have_one_distance_known_to_1e_9(number):
    images_agree(number, 8)


def test_a_body_without_effects_is_as_far_from_its_separatrix_as_from_two_planes():
    """Euler's top: |H|^2 = 2 T D2 is D1 (D1 - D2) w1^2 = D3 (D2 - D3) w3^2, D1 > D2 > D3 (Landau and
    Lifshitz, section 37)."""
    rng = np.random.default_rng(4)
    for _ in range(12):
        moments, state = np.sort(rng.uniform(1, 2, 3))[::-1], rng.normal(size=3) * 10.0 ** rng.uniform(-3, 3)
        p, q = np.sqrt(moments[0]
                       * (moments[0] - moments[1])), np.sqrt(moments[2] * (moments[1] - moments[2]))
        exact = min(abs(p * state[0] - s * q * state[2]) for s in (-1, 1)) / np.hypot(p, q)
        order = rng.permutation(3)
        found = distance_of(reduce(physical(moments[order])[0]), state[order].tolist())
        assert found.settled and found.lower * (1 - 1e-12) <= exact <= found.upper * (1 + 1e-12)


def loops(moments, wheel, torque, axis, rng):
    """Points of the loops of a random saddle with no rate about an axis, by integration from it along its
    unstable and stable directions, and how far from the separatrix they may be; None where the place is no
    saddle."""
    rate = lambda w: (np.cross(moments * w + wheel, w) + torque) / moments  # Euler's equations
    j, k = (axis + 1) % 3, (axis + 2) % 3
    saddle = np.zeros(3)
    saddle[j] = rng.normal() * 2
    zero, one = (rate(saddle + v * np.eye(3)[k])[axis] for v in (0.0, 1.0))  # linear in the other component
    if zero == one:
        return None
    saddle[k] = zero / (zero - one)
    # exact: the rates are quadratic
    jacobian = np.array([(rate(saddle + h) - rate(saddle - h)) / 2 for h in np.eye(3)]).T
    values, vectors = np.linalg.eig(jacobian)
    growth, size = np.abs(values.real).max(), np.linalg.norm(saddle)
    if np.abs(values.imag).max() > 1e-9 * growth or growth < 0.02 * size or size > 20:
        return None
    start, found = 1e-6 * size, []
    for n in np.argsort(-np.abs(values.real))[:2]:
        for side in (-1, 1):
            run = solve_ivp(lambda t, w: rate(w), (0, np.sign(values[n].real) * 18 / growth),
                            saddle + side * start * vectors[:, n].real, "DOP853",
                            rtol=1e-11, atol=1e-13, dense_output=True)
            found.append(run.sol(np.linspace(0, run.t[-1], 300)).T)
    points = np.concatenate(found)
    return points, 30 * start * (1 + np.abs(points).max() / size)


def check_loops(number, seed):
    """No torque, or one about the middle axis: there both sides of a saddle are loops. States are about
    points of the loops."""
    rng, known = np.random.default_rng(seed), 0
    while known < number:
        moments, wheel, torque = rng.uniform(1, 2, 3), rng.normal(size=3), np.zeros(3)
        axis = int(rng.integers(3))
        wheel[axis] = 0
        if rng.random() < 0.5:
            axis = int(np.argsort(moments)[1])
            wheel[axis], torque[axis] = 0, rng.normal()
        made = loops(moments, wheel, torque, axis, rng)
        reduction = reduce(physical(moments, wheel, torque)[0])
        if made is None or reduction is None:
            continue
        points, off = made
        state = points[rng.integers(len(points))] + rng.normal(size=3) * 10.0 ** rng.uniform(-2.5, 0.5)
        found = distance_of(reduction, state.tolist())
        assert found.settled, (moments, wheel, torque, state)
        assert np.linalg.norm(points - state,
                              axis=1).min() >= found.lower - off, (moments, wheel, torque, state)
        known += 1


@pytest.mark.slow
@pytest.mark.parametrize("number", [12, pytest.param(300, marks=pytest.mark.long)])
def test_no_point_of_a_loop_that_is_integrated_is_nearer_than_the_lower_bound(number):
    check_loops(number, 9)
