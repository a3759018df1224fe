"""Fates of large arrays: the table of barriers against the oracle and the general formula."""
from __future__ import annotations

import importlib
import tracemalloc
from functools import lru_cache

import numpy as np
import pytest

import stabilab
from stabilab.answers.fate import fate_grid
from stabilab.errors import InputError
from stabilab.orbit.fate.by_table import label_by_table
from stabilab.orbit.fate.table import barrier_table
from tests.oracles import energy, pairs
from tests.oracles.pairs import WORDS, assert_margin, axis_of, brink, physical, scaled
from tests.orbit.fate.test_fate import ELLIPTIC, FAMILIES, sample
from tests.shared import later

module = importlib.import_module("stabilab.orbit.fate.arrays")
TABLED = [name for name in FAMILIES if barrier_table(FAMILIES[name][0]) is not None]


@pytest.fixture
def tables_always(monkeypatch):
    """Small arrays take the way of large ones."""
    monkeypatch.setattr(module, "TABLE_FROM", 0)


def general(scene, states):
    """Columns by the general formula, whatever the array's size."""
    found = module.in_chunks(module.labeller(scene), states)
    return {name: getattr(found, name) for name in module.empty_columns(0)}


def near_the_separatrix(problem, rng, distances, spread=2.0):
    states = []
    while len(states) < len(distances):
        state = brink(problem, rng.normal(size=2) * spread, distances[len(states)], rng.choice([-1, 1]))
        if state is not None:
            states.append(state)
    return np.array(states)


def test_every_family_with_curved_equilibria_and_a_torque_has_a_table():
    assert set(FAMILIES) - set(TABLED) == set()


@lru_cache
def hard_states(name):
    """(states at relative distances 1e-3 to 1e-15 on both sides of the separatrix, their labels by the
    oracle)."""
    distances = [side * 10.0 ** -p for p in (3, 8, 12, 14, 15) for side in (-1, 1)]
    states = near_the_separatrix(FAMILIES[name][1], np.random.default_rng(ELLIPTIC.index(name)), distances)
    return states, [WORDS[energy.label(FAMILIES[name][1], s)] for s in states.tolist()]


@pytest.mark.one_in(4)
@pytest.mark.parametrize("name", [n for n in ELLIPTIC if "a=b" not in n])
def test_labels_next_to_the_separatrix_equal_the_oracle(name, tables_always):
    states, expected = hard_states(name)
    result = stabilab.fate(FAMILIES[name][0], states)
    np.testing.assert_array_equal(result.labels, expected)
    assert result.precise >= 2  # 1e-15 of the speed is less than the rounding of the energy's terms


@pytest.mark.parametrize("name", FAMILIES)
def test_the_table_answers_as_the_general_formula_and_leaves_little_to_it(name):
    scene, problem = FAMILIES[name]
    states, table = sample(name, 20000), barrier_table(scene)
    fast, slow = module.empty_columns(len(states)), general(scene, states)
    rest = label_by_table(table, states, fast)
    assert len(rest) <= 0.03 * len(states) and table.gaps <= 0.01
    sure = np.ones(len(states), bool)
    sure[rest] = False
    for column in ("labels", "reasons", "axis", "sense"):
        np.testing.assert_array_equal(fast[column][sure], slow[column][sure], err_msg=column)
    finite = sure & np.isfinite(slow["margins"])
    np.testing.assert_array_equal(fast["margins"][sure & ~finite], slow["margins"][sure & ~finite])
    kinetic = 0.5 * float(problem.weight[axis_of(problem)]) * states[:, axis_of(problem)] ** 2
    terms = np.abs(slow["margins"][finite] + kinetic[finite]) + kinetic[finite]
    assert np.all(np.abs(fast["margins"][finite] - slow["margins"][finite]) <= 1e-12 * terms)


@pytest.mark.parametrize("seed", later(range(40)))
def test_a_hundred_thousand_states_of_random_scenes_answer_as_the_general_formula(seed):
    rng = np.random.default_rng(seed)
    scene, _ = (pairs.random_problem(rng, seed % 3) if seed % 2
                else pairs.random_problem(rng, 1 + seed % 4 // 2, "scaled"))
    states = rng.normal(size=(50_000, 3)) * 10.0 ** rng.uniform(-2, 2)
    np.testing.assert_array_equal(stabilab.fate(scene, states).labels,
                                  general(scene, states)["labels"])


def test_equilibria_and_centres_in_a_large_array_are_recognised():
    """X1 = 0, X2 = -1/b is an equilibrium of the scaled minor-axis system (rates by hand); the axis X1 = -a,
    X2 = 0 is the centre of every circle: pure spin."""
    scene = scaled(0.25, 0.5, (0, 0, 1))[0]
    states = sample("minor scaled +", 6000)
    states[17], states[5999] = (0.0, -2.0, 0.0), (-0.25, 0.0, 0.3)
    result = stabilab.fate(scene, states)
    assert result.labels[17] == stabilab.Fate.EQUILIBRIUM and result.axis[17] == result.sense[17] == 0
    assert result.labels[5999] == stabilab.Fate.SPIN_UP and result.margins[5999] == -np.inf


NEARLY_EQUAL = [((0.544, 2.2, 2.199), (-1.021, 2.296, 0), (0, 0, -0.0843)),
                ((2.705, 2.701, 0.145), (0.207, 0, 0), (0, 0.0933, 0)),
                ((6.973, 9.358, 9.348), (-0.316, 1.387, 0), (0, 0, -0.1215)),
                ((3.681, 0.291, 3.679), (0.159, -2.973, 0), (0, 0, 0.2086)),
                ((2.2, 2.1999, 0.544), (2.296, 0, -1.021), (0, 0.0843, 0)),
                ((1.0 + 2.0**-16, 1.0, 0.5), (0.4, 0, 0.3), (0, 0.02, 0))]


@pytest.mark.parametrize("body", NEARLY_EQUAL)
def test_margins_on_wide_hyperbolas_keep_twelve_digits(body, tables_always):
    """Of nearly equal moments heights are sums of terms a thousand and more times as large: a third of the
    rows take the general formula."""
    scene, problem = physical(*body)
    rng, axis = np.random.default_rng(3), axis_of(problem)
    states = rng.normal(size=(2000, 3)) * 10.0 ** rng.uniform(-1, 1, (2000, 1))
    result, half_weight = stabilab.fate(scene, states), 0.5 * float(problem.weight[axis])
    height = result.margins + half_weight * states[:, axis] ** 2
    high = rng.permutation(np.nonzero(np.isfinite(height) & (height > 0))[0])[:8]
    near = states[high]
    near[:, axis] = np.sqrt(height[high] / half_weight) * (1 + 10.0 ** -np.arange(2, 2 + len(high)))
    for state in [*near, *states[rng.permutation(np.nonzero(np.isfinite(height))[0])[:12]]]:
        assert_margin(problem, tuple(state.tolist()), stabilab.fate(scene, np.array([state] * 5)).margins[0])


def test_random_states_need_no_ball_arithmetic_and_ties_do(tables_always):
    scene, problem = FAMILIES["minor scaled +"]
    assert stabilab.fate(scene, sample("minor scaled +", 20000)).precise == 0
    ties = near_the_separatrix(problem, np.random.default_rng(8), [0.0] * 3)
    assert stabilab.fate(scene, ties).precise == 3


def test_a_fate_map_takes_less_memory_than_three_times_its_input():
    scene, states = FAMILIES["minor scaled +"][0], np.random.default_rng(1).uniform(-5, 5, (400_000, 3))
    stabilab.fate(scene, states[:6000])
    tracemalloc.start()
    try:
        stabilab.fate(scene, states)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak + states.nbytes <= 3 * states.nbytes


@pytest.mark.parametrize("name", ["minor scaled +", "middle scaled -, |c| above the cusp", "minor on axis 1",
                                  "major physical",
                                  "minor physical"])
def test_a_grid_has_the_labels_of_its_states(name):
    scene, _ = FAMILIES[name]
    rng = np.random.default_rng(3)
    # 17: zero is among them
    axes = [np.linspace(-4, 4, 17), np.sort(rng.normal(size=23)) * 2, rng.normal(size=19) * 2]
    states = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    labels = fate_grid(scene, axes)
    assert labels.dtype == np.int8
    np.testing.assert_array_equal(labels,
                                  general(scene, states.reshape(-1, 3))["labels"].reshape(labels.shape))


def test_a_grid_through_ties_equilibria_and_the_centre_has_the_labels_of_its_states():
    scene, problem = scaled(0.25, 0.5, (0, 0, 1))
    tie = near_the_separatrix(problem, np.random.default_rng(2), [0.0])[0]
    speeds = [np.nextafter(tie[2], -np.inf), tie[2], np.nextafter(tie[2], np.inf), 0.0]
    axes = [np.array([tie[0], -0.25, 0.0]), np.array([tie[1], 0.0, -2.0]), np.array(speeds)]
    labels = fate_grid(scene, axes)
    expected = [WORDS[energy.label(problem, s)] for s in [(tie[0], tie[1], w) for w in speeds]]
    np.testing.assert_array_equal(labels[0, 0], expected)
    assert labels[2, 2, 3] == stabilab.Fate.EQUILIBRIUM and (labels[1, 1] == stabilab.Fate.SPIN_UP).all()


def test_a_grid_of_a_scene_without_a_table_has_the_labels_of_its_states():
    scene = physical((3.0, 2.0, 1.5))[0]
    axes = [np.linspace(-1, 1, 4)] * 3
    states = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    np.testing.assert_array_equal(fate_grid(scene, axes), stabilab.fate(scene, states).labels)


@pytest.mark.parametrize("axes", [[[0.0], [1.0]], [[0.0], [1.0], [[2.0]]], [[0.0], [np.nan], [1.0]],
                                  [["x"], [0], [0]]])
def test_grid_axes_that_are_not_three_rows_of_finite_numbers_are_refused(axes):
    with pytest.raises(InputError):
        fate_grid(FAMILIES["minor scaled +"][0], axes)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("gap",
                         [0.0, 1e-15, 1e-10, 1e-4,
                          *(pytest.param(gap, marks=pytest.mark.slow) for gap in (1e-14, 1e-12, 1e-8, 1e-6))])
def test_tables_hold_however_nearly_equal_two_moments_are(gap):
    """The curve of equilibria led from a point 1e15 away to the well instead of the barrier: spin-up for
    bounded."""
    scene, problem = physical((21.500084290532417, 24.358784335374747, 21.500084290532417 * (1 + gap)),
                              (-1.3709072194035352, 0.0, 0.09621494789491448),
                              (0.0, -0.10920909535513186, 0.0))
    rng = np.random.default_rng(4)
    states = rng.normal(size=(5000, 3)) * (1, 0.5, 0.3)
    states[0] = -0.6078189955764939, 1.3931012988621379e-12, 0.14338820960207116
    many, few = stabilab.fate(scene, states), stabilab.fate(scene, states[:2500])
    np.testing.assert_array_equal(many.labels[:2500], few.labels)
    for n in range(20):
        state = states[n].tolist()
        assert WORDS[energy.label(problem, state, digits=150)] == many.labels[n]
        exact = energy.margin(problem, state, digits=150)
        if exact is not None:
            size = abs(float(exact)) + float(problem.weight[1]) * state[1] ** 2
            assert abs(many.margins[n] - float(exact)) <= 2e-12 * size
