"""Facts about fates that small faults break: the parts of the arrays' paths, each asked for by itself."""
from __future__ import annotations

import importlib
import tracemalloc
from functools import lru_cache

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Fate, Scene
from stabilab.answers.fate import fate_grid
from stabilab.errors import InputError
from stabilab.orbit.fate import REASONS, Basis, fate_of
from stabilab.orbit.landscape import landscape
from stabilab.orbit.one_orbit import Orbit
from stabilab.orbit.reduction import reduce
from tests.oracles import energy
from tests.oracles.pairs import WORDS, assert_extremes, assert_margin, axis_of, brink, physical, scaled
from tests.shared import ELLIPTIC, FAMILIES, PARABOLIC, sample

fate = importlib.import_module("stabilab.orbit.fate_arrays")
COLUMNS = ("labels", "margins", "axis", "sense", "reasons")


def never(what):
    return lambda *_: pytest.fail(what)


def same(one, other):
    assert all(getattr(one, name).tobytes() == getattr(other, name).tobytes() for name in COLUMNS)
    assert one.precise == other.precise


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_flat_parabolas_are_told_from_nearly_flat_ones_at_every_scale(scale, monkeypatch):
    """D = (2, 2, 1), torque on axis 1: D3 w3' = 0 and D1 w1' = M1 + w2 w3, D2 w2' = -w3 w1, so flat iff w3 =
    0."""
    scene = physical((2 * scale, 2 * scale, scale), (0, 0, 0), (scale, 0, 0))[0]
    states = np.array([[0.5, 0, 0], [-2, 0, 0], [1, 1e-12, 0], [1, 0, 1e-14], [1, 1e-200, 0],
                       [0, -1e-9, 1e-9], [0, 0, 1e-200]])
    found = stabilab.fate(scene, states)
    np.testing.assert_array_equal(found.labels == Fate.SPIN_UP, [True, True, True, False, True, False, False])
    np.testing.assert_array_equal(found.axis, [1, 1, 1, 0, 1, 0, 0])
    monkeypatch.setattr(fate, "_is_flat", never("a state that is far from flat was asked exactly"))
    for name in ("first axis", "second axis", "third axis", "oblate"):
        assert (stabilab.fate(PARABOLIC[name][0], np.random.default_rng(3).normal(size=(50, 3))).labels
                == Fate.BOUNDED).all()


@pytest.mark.parametrize("name", ["minor scaled +", "middle scaled -, |c| above the cusp"])
def test_long_arrays_are_answered_in_chunks_and_any_chunk_gives_the_same_bytes(name, monkeypatch):
    scene, problem = FAMILIES[name]
    states = sample(name, 60)
    near = [brink(problem, pair, 1e-15)
            for pair in ((-1.25, -1.25), (-1.875, -0.75))] if name.startswith("middle") else [
        brink(problem, pair, 1e-15) for pair in ((3.0, 1.0), (-3.0, 1.0))]
    states[[7, 31]] = near
    whole = stabilab.fate(scene, states)
    assert whole.precise == 0  # twofold numbers settle both
    monkeypatch.setattr("stabilab.orbit.fate_arrays.CHUNK", 7)
    same(stabilab.fate(scene, states), whole)


@pytest.mark.one_in(3)
@pytest.mark.parametrize("a, b, sign", [(0.25, 0.5, 1), (0.25, 0.5, -1), (0.0, 3.0, 1), (0.0, -3.0, 1),
                                        (0.5, 0.5, 1), (0.0, -3.0, -1), (0.0, 3.0, -1)])
@pytest.mark.parametrize("plane", [-1, 1])
def test_motions_on_an_invariant_plane_tell_axis_sense_reason_margin_and_extremes(a, b, sign, plane):
    """Labels, heights and extremes from the potential at 60 digits: x3 = -(x1 + b) decays in the torque's
    direction, where the one barrier ahead counts, and x3 = x1 + b grows."""
    scene, problem = scaled(a, b, (0, sign, 0))
    states = [(y - b, w, plane * y) for y in (-4.0, -1.25, -0.5, 0.5, 1.25, 4.0)
              for w in (-3.0, -0.75, 0.0, 2.5)]
    found, boxes = stabilab.fate(scene, np.array(states)), stabilab.extremes(scene, np.array(states))
    for n, state in enumerate(states):
        assert_extremes(boxes[n], energy.extremes(problem, state, digits=60), 1e-11)
        word = energy.label(problem, state, digits=60)
        assert found.labels[n] == WORDS[word]
        assert (found.axis[n], found.sense[n]) == ((2, sign) if word == "spin-up" else (0, 0))
        height = energy.margin(problem, state, digits=60)
        if plane * sign > 0:
            assert (found.margins[n], found.reasons[n]) == (np.inf, Basis.WALLS)
        else:
            assert found.reasons[n] == (Basis.PLANE_CAPTURED if word == "bounded" else Basis.PLANE_ESCAPES)
            assert found.margins[n] == pytest.approx(-np.inf if height is None else float(height), rel=1e-13)


@pytest.mark.parametrize("sign", [-1, 1])
def test_pure_spin_about_the_middle_axis_grows_with_the_torque_and_rests_without(sign):
    found = stabilab.fate(scaled(0.25, 0.5, (0, sign, 0))[0], np.array([(-0.5, 0.75, 0.0)]))
    assert [list(found.labels), list(found.axis), list(found.sense), list(found.reasons)] == [
        [Fate.SPIN_UP], [2], [sign], [Basis.PURE_SPIN]] and found.margins[0] == -np.inf
    # wheels balance the middle spin
    free = stabilab.fate(physical((6, 5, 3), (0.5, 0, 1))[0], np.array([-0.5, 0.75, 0.5]))
    assert (free.labels, free.axis, free.sense, free.reasons) == (Fate.EQUILIBRIUM, 0, 0, Basis.AT_REST)


families = pytest.mark.parametrize("name", FAMILIES)


@families
def test_generic_states_need_no_many_digits(name, monkeypatch):
    """Error bounds that are too wide change no answer, only the cost: the counters tell."""
    monkeypatch.setattr("stabilab.orbit.extremes_arrays.precise_extremes",
                        lambda *a: pytest.fail("a generic state went to ball arithmetic"))
    scene, states = FAMILIES[name][0], sample(name, 300)
    assert stabilab.fate(scene, states).precise == 0
    stabilab.extremes(scene, states)


@pytest.mark.one_in(4)
@families
def test_the_reason_is_whether_a_barrier_stands_ahead_and_how_high(name):
    """The potential at 60 digits: no barrier, one below the energy, one above it; on hyperbolas walls hold
    everything."""
    scene, problem = FAMILIES[name]
    states = sample(name, 30)
    found = stabilab.fate(scene, states)
    for state, reason, label in zip(states.tolist(), found.reasons, found.labels):
        margin = energy.margin(problem, state, digits=60)
        expected = (Basis.WALLS if name not in ELLIPTIC else Basis.NO_BARRIER if margin is None
                    else Basis.BELOW_BARRIER if margin > 0 else Basis.ABOVE_BARRIER)
        assert reason == expected and (label
                                       == Fate.BOUNDED) == (expected in (Basis.WALLS, Basis.BELOW_BARRIER))
    words = found.because
    assert words.shape == (30,)
    for n, one in enumerate(states[:8]):
        about = f"; it spins up about axis {found.axis[n]}" if found.labels[n] == Fate.SPIN_UP else ""
        assert words[n] == str(REASONS[Basis(int(found.reasons[n]))]) + about
        assert stabilab.fate(scene, one).because == words[n]


@pytest.mark.parametrize("state", [(0.3, -0.4, -1.0), (0.3, -0.4, 2.0), (0.0, 0.0, 0.5)])
@pytest.mark.parametrize("moment", [0.5, -0.25])
@pytest.mark.parametrize("axis", [0, 2])
def test_spin_about_a_torque_that_no_other_rate_disturbs_grows_for_ever(axis, moment, state):
    """D = (2, 2, 1): with the torque on axis 3, D3 w3' = M3 whatever the rest; on axis 1 only if the rest is
    at rest."""
    state = (state[2], 0.0, 0.0) if axis == 0 else state
    scene = Scene(Body((2, 2, 1)), ConstantTorque(tuple(moment * (i == axis) for i in range(3))))
    sense = 1 if moment > 0 else -1
    found, box = stabilab.fate(scene, np.array(state)), stabilab.extremes(scene, np.array(state))
    reason = Basis.PURE_SPIN if axis == 0 else Basis.NO_BARRIER
    assert (found.labels, found.axis, found.sense, found.reasons) == (Fate.SPIN_UP, axis + 1, sense, reason)
    assert found.margins == -np.inf
    assert box[axis].tolist() == ([state[axis], np.inf] if sense > 0 else [-np.inf, state[axis]])
    if axis == 2:  # the other two turn on their circle
        assert box[:2] == pytest.approx(np.hypot(*state[:2]) * np.array([[-1, 1], [-1, 1]]), rel=1e-14)
    else:
        assert box[1:].tolist() == [[0, 0], [0, 0]]


def test_pure_spins_of_a_sphere_are_written_at_once(monkeypatch):
    """D (w1', w2', w3') = (0, M2, 0): all states spin up about axis 2, whatever their rates."""
    scene, states, calls = Scene(Body((2, 2, 2)), ConstantTorque((0, -0.5, 0))), sample("minor physical", 300), []
    write = fate.write_row
    monkeypatch.setattr(fate, "write_row", lambda out, index, *row: (calls.append(np.size(index)),
                                                                     write(out, index, *row)))
    found = stabilab.fate(scene, states)
    assert calls == [300] and found.precise == 0 and (found.margins == -np.inf).all()
    assert {(Fate.SPIN_UP, Basis.PURE_SPIN, 2, -1)} == set(zip(found.labels.tolist(), found.reasons.tolist(),
                                                              found.axis.tolist(), found.sense.tolist()))


def test_of_two_barriers_ahead_the_lower_one_may_lack_digits():
    """Moments equal to 2e-11: one barrier is 1e17 high on the far side of a huge circle, and rounding of that
    size leaves few digits to the other, nearly a turn ahead. The potential at 60 digits is the check."""
    scene, problem = physical((0.42, 3.095, 3.0949999999241946), (-1.57, 0, -0.0185), (0, -0.000407, 0))
    states = np.array([(-1.54061255, -0.71765329, 3.26808756), (-1.65229492, 0.07806115, 0.31658462),
                       (-1.98195141, 1.0919903, -6.32064863)])
    found = stabilab.fate(scene, states)
    assert found.precise == 0
    for state, margin in zip(states.tolist(), found.margins):
        assert margin > 1e17
        assert_margin(problem, state, margin)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name",
                         ["minor scaled +", "minor scaled -", "minor physical", "major physical, other sign",
                                  "middle scaled, |c| far above"])
def test_states_within_rounding_of_a_saddle_are_labelled_by_the_side_they_are_on(name):
    """Offsets from the barrier of some units in the last place, energies down to their squares: the potential
    at 100 digits."""
    (scene, problem), rng = FAMILIES[name], np.random.default_rng(6)
    saddles = [p.at for c in stabilab.equilibria(scene).curves for p in c.samples
               if p.linear == "unstable" and max(map(abs, p.at)) < 50]
    axis, states = axis_of(problem), []
    for at in saddles[:1]:
        for power in (-17, -16, -15.5, -15, -12, -8):
            state = [v * (1 + 2.0**-52 * int(rng.integers(-3, 4))) for v in at]
            state[axis] = float(rng.choice([-1, 1])) * 10.0**power * max(map(abs, at))
            states.append(state)
    found = stabilab.fate(scene, np.array(states))
    for state, label in zip(states, found.labels):
        word = energy.label(problem, tuple(state), digits=100)
        assert label == WORDS[word]


def edge_states(name):
    """States of every kind: far, near the fold, the planes, the centre, at rest."""
    scene, problem = FAMILIES[name]
    rng, axis, land = np.random.default_rng(12), axis_of(problem), landscape(scene)
    states = rng.normal(size=(220, 3)) * 10.0 ** rng.uniform(-3, 4, (220, 1))
    saddles = [p.at for c in stabilab.equilibria(scene).curves for p in c.samples
               if max(map(abs, p.at)) < 1e4]
    near = [np.array(at) * (1 + 10.0 ** rng.uniform(-13, -1)) + np.eye(3)[axis] * rng.normal()
            for at in saddles]
    r = land.reduction
    for edge in land.conic.fold_invariants:  # invariants at and beside a fold
        for off in (0.0, 1e-13, -1e-13, 1e-11, -1e-11, 1e-9, -1e-9, 1e-3, -1e-3):
            size, turn = np.sqrt(abs(edge * (1 + off))), rng.uniform(-3, 3)
            if r.e < 0:
                x, z = size * np.sin(turn), size * np.cos(turn)
            else:
                x, z = (np.sinh(turn), np.cosh(turn)) if edge > 0 else (np.cosh(turn), np.sinh(turn))
                x, z = size * x * rng.choice([-1, 1]), size * z * rng.choice([-1, 1])
            near.append(land.components((x, z) if r.e < 0 else (x + z, x - z), np.array(rng.normal())))
    for off in (1e-14, 1e-11, 1e-9, 1e-8, 1e-3):  # next to the centre and the planes
        for x, z in ((off, 0.5 * off), (1 + off, 1.0), (-1.0, 1 + off)):
            near.append(land.components((x, z) if r.e < 0 else (x + z, x - z), np.array(rng.normal())))
    return np.concatenate([states, np.array(near)])


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name", FAMILIES)
def test_arrays_agree_with_balls_at_every_edge(name):
    """At folds, planes, centres and barriers too: the potential in balls, one state after the other."""
    (scene, problem), states = FAMILIES[name], edge_states(name)
    found = stabilab.fate(scene, states)
    for n, state in enumerate(states.tolist()):
        one = fate_of(scene, Orbit(reduce(scene), state))
        assert (found.labels[n], found.reasons[n], found.axis[n], found.sense[n]) == (
            one.label, one.basis, one.axis, one.sense)
        kinetic = 0.5 * float(problem.weight[axis_of(problem)]) * state[axis_of(problem)] ** 2
        if np.isfinite(one.margin):
            assert abs(found.margins[n] - one.margin) <= 1e-12 * (abs(one.margin + kinetic) + kinetic)
        else:
            assert found.margins[n] == one.margin


def near_the_separatrix(problem, rng, distances, spread=2.0):
    states = []
    while len(states) < len(distances):
        state = brink(problem, rng.normal(size=2) * spread, distances[len(states)], rng.choice([-1, 1]))
        if state is not None:
            states.append(state)
    return np.array(states)


@lru_cache
def hard_states(name):
    """(states at relative distances 1e-3 to 1e-15 on both sides of the separatrix, their labels by the
    oracle)."""
    distances = [side * 10.0 ** -p for p in (3, 8, 12, 14, 15) for side in (-1, 1)]
    states = near_the_separatrix(FAMILIES[name][1], np.random.default_rng(ELLIPTIC.index(name)), distances)
    return states, [WORDS[energy.label(FAMILIES[name][1], s)] for s in states.tolist()]


@pytest.mark.one_in(4)
@pytest.mark.parametrize("name", [n for n in ELLIPTIC if "a=b" not in n])
def test_labels_next_to_the_separatrix_equal_the_oracle(name):
    states, expected = hard_states(name)
    result = stabilab.fate(FAMILIES[name][0], states)
    np.testing.assert_array_equal(result.labels, expected)
    # 1e-15 of the speed is less than the rounding of the energy's terms, but not of twofold ones
    assert result.precise == 0


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
def test_margins_on_wide_hyperbolas_keep_twelve_digits(body):
    """Of nearly equal moments heights are sums of terms a thousand and more times as large."""
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


def test_states_need_no_ball_arithmetic_but_where_a_barrier_stands():
    """Nor do those whose double is the nearest to the separatrix. X1 = 0, X2 = -1/b is a saddle of the scaled
    minor-axis system (rates by hand): a motion that passes it may have it ahead or behind."""
    scene, problem = FAMILIES["minor scaled +"]
    assert stabilab.fate(scene, sample("minor scaled +", 20000)).precise == 0
    ties = near_the_separatrix(problem, np.random.default_rng(8), [0.0] * 3)
    result = stabilab.fate(scene, ties)
    assert result.precise == 0
    np.testing.assert_array_equal(result.labels, [WORDS[energy.label(problem, s)] for s in ties.tolist()])
    scene = scaled(0.25, 0.5, (0, 0, 1))[0]
    assert stabilab.fate(scene, np.array([(0.0, -2.0, 0.3), (1.0, 2.0, 3.0)])).precise == 1


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


def test_a_grid_through_ties_equilibria_and_the_centre_has_the_labels_of_its_states():
    scene, problem = scaled(0.25, 0.5, (0, 0, 1))
    tie = near_the_separatrix(problem, np.random.default_rng(2), [0.0])[0]
    speeds = [np.nextafter(tie[2], -np.inf), tie[2], np.nextafter(tie[2], np.inf), 0.0]
    axes = [np.array([tie[0], -0.25, 0.0]), np.array([tie[1], 0.0, -2.0]), np.array(speeds)]
    labels = fate_grid(scene, axes)
    expected = [WORDS[energy.label(problem, s)] for s in [(tie[0], tie[1], w) for w in speeds]]
    np.testing.assert_array_equal(labels[0, 0], expected)
    assert labels[2, 2, 3] == stabilab.Fate.EQUILIBRIUM and (labels[1, 1] == stabilab.Fate.SPIN_UP).all()


@pytest.mark.parametrize("axes", [[[0.0], [1.0]], [[0.0], [1.0], [[2.0]]], [[0.0], [np.nan], [1.0]],
                                  [["x"], [0], [0]]])
def test_grid_axes_that_are_not_three_rows_of_finite_numbers_are_refused(axes):
    with pytest.raises(InputError):
        fate_grid(FAMILIES["minor scaled +"][0], axes)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("gap",
                         [0.0, 1e-15, 1e-10, 1e-4,
                          *(pytest.param(gap, marks=pytest.mark.slow) for gap in (1e-14, 1e-12, 1e-8, 1e-6))])
def test_fates_hold_however_nearly_equal_two_moments_are(gap):
    """The curve of equilibria led from a point 1e15 away to the well instead of the barrier: spin-up for
    bounded."""
    scene, problem = physical((21.500084290532417, 24.358784335374747, 21.500084290532417 * (1 + gap)),
                              (-1.3709072194035352, 0.0, 0.09621494789491448),
                              (0.0, -0.10920909535513186, 0.0))
    rng = np.random.default_rng(4)
    states = rng.normal(size=(5000, 3)) * (1, 0.5, 0.3)
    states[0] = -0.6078189955764939, 1.3931012988621379e-12, 0.14338820960207116
    many = stabilab.fate(scene, states)
    for n in range(20):
        state = states[n].tolist()
        assert WORDS[energy.label(problem, state, digits=150)] == many.labels[n]
        exact = energy.margin(problem, state, digits=150)
        if exact is not None:
            size = abs(float(exact)) + float(problem.weight[1]) * state[1] ** 2
            assert abs(many.margins[n] - float(exact)) <= 2e-12 * size
