"""Facts that small faults in the analysis break; each was added because such a fault went unseen."""
from __future__ import annotations

import math
import random
from fractions import Fraction as F

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Fate, Gyrostat, ScaledGyrostat, Scene
from stabilab.orbit.fate import table_kernel as barrier_heights
from stabilab.orbit.fate.table import barrier_table
from stabilab.equilibrium.spectrum import eigenvalues
from stabilab.orbit.fate.reasons import Reason, REASONS
from stabilab.orbit.reduction import reduce
from stabilab.equilibrium.stability import isolated_verdict
from stabilab.equilibrium.curve import sample_parameters
from stabilab.orbit.fate.by_table import label_by_table

from tests.oracles import energy
from tests.oracles.pairs import physical, scaled, WORDS
from tests.test_extremes import assert_extremes
from tests.test_fate import axis_of, ELLIPTIC, FAMILIES, sample

INTERVALS = [(None, None), (F(-3), None), (F(0), None), (F(2, 7), None), (F(-3), F(2)), (F(0), F(1, 3)), (F(1, 1000), F(1000)),
             (F(1, 10), F(20)), (F(1), F(50)), (F(5), F(6)), (F(1), F(100)),
             (F(1, 10**9), F(10**9)), (F(-2), F(3, 10**7)), (F(0), F(10**7))]


@pytest.mark.parametrize("n", [1e-3, 2.0, -1e-3, -7.0])
@pytest.mark.parametrize("m", [-3, 0, 5])
def test_the_words_about_an_isolated_equilibrium_are_those_of_its_cubic(m, n):
    """NumPy's roots of z^3 + m z + n say what sign the real root has."""
    roots = np.roots([1, 0, m, n])
    real = [z.real for z in roots if abs(z.imag) < 1e-9]
    word, because = isolated_verdict((m > 0) - (m < 0), (n > 0) - (n < 0))
    assert word == "unstable" and because.startswith(f"n {'>' if n > 0 else '<'} 0")
    assert ("negative real root" in because) == (n > 0) and (n < 0 or min(real) < 0) and (n > 0 or max(real) > 0)


@pytest.mark.parametrize("lo, hi", INTERVALS)
def test_samples_lie_inside_their_interval_rising_and_mirrored(lo, hi):
    for a, b in ((lo, hi), tuple(None if end is None else -end for end in (hi, lo))):
        samples = sample_parameters(a, b, F(1))
        assert len(samples) >= 4 and all(F(float(t)) == t for t in samples)
        assert samples == sorted(set(samples)) and (a is None or samples[0] > a) and (b is None or samples[-1] < b)
        assert samples == [-t for t in reversed(sample_parameters(None if b is None else -b, None if a is None else -a, F(1)))]


@pytest.mark.parametrize("lo, hi", [(F(1, 1000), F(1000)), (F(1, 10**9), F(10**9)), (F(3), F(301)), (F(1, 10), F(20)),
                                    (F(7), F(7000))])
def test_samples_of_a_wide_interval_are_spread_over_its_decades(lo, hi):
    places = [math.log(t / lo) / math.log(hi / lo) for t in sample_parameters(lo, hi, F(1))]
    assert places[0] < 0.1 and places[-1] > 0.9 and max(b - a for a, b in zip(places, places[1:])) < 0.5


def test_samples_next_to_a_pole_at_zero_reach_four_decades_towards_it():
    samples = sample_parameters(F(0), F(5), F(1))
    assert 1e-5 < samples[0] / 5 < 1e-3 and samples[-1] / 5 > 0.5


@pytest.mark.parametrize("start, size", [(F(0), 7), (F(3), 3), (F(-3), 3)])
def test_samples_towards_infinity_go_in_decades_of_the_size_of_the_near_end(start, size):
    away = [(t - start) / size for t in sample_parameters(start, None, F(7))]
    assert away[0] <= F(1, 50) and away[-1] >= 1000 and any(F(1, 2) <= t <= 2 for t in away)


def cubics():
    """(m, n) of every kind: three real roots, one, double, triple, on the axes, over many decades."""
    rng = random.Random(11)
    for _ in range(150):
        yield tuple(F(rng.randint(-10**6, 10**6)) * F(10) ** rng.randint(-12, 12) for _ in range(2))
    for _ in range(100):  # roots a, b, -a - b: three real ones; a = b among them
        a = F(rng.randint(-99, 99), rng.randint(1, 99))
        b = rng.choice([a, a + F(1, 10**15), F(rng.randint(-99, 99), rng.randint(1, 99))])
        yield a * b - (a + b) ** 2, a * b * (a + b)
    yield from [(F(0), F(0)), (F(2), F(0)), (F(-2), F(0)), (F(1, 10**40), F(0)), (F(0), F(5)), (F(0), F(-1, 10**30)),
                (F(-3), F(2)), (F(-3), F(-2)), (F(-1), F(1, 10**70)), (F(-1), F(-1, 10**70))]


def test_the_three_eigenvalues_together_have_the_coefficients_of_their_cubic():
    """Vieta, exactly: z1 + z2 + z3 = 0, z1 z2 + z1 z3 + z2 z3 = m, z1 z2 z3 = -n, to the rounding of each root."""
    for m, n in cubics():
        roots = [(F(z.real), F(z.imag)) for z in eigenvalues(m, n)]
        times = lambda p, q: (p[0] * q[0] - p[1] * q[1], p[0] * q[1] + p[1] * q[0])  # noqa: E731
        size = [abs(a) + abs(b) for a, b in roots]
        pairs = [(0, 1), (0, 2), (1, 2)]
        products = [times(roots[i], roots[k]) for i, k in pairs]
        whole = times(products[0], roots[2])
        eps = F(1, 2**51)
        for part in (0, 1):
            assert abs(sum(r[part] for r in roots)) <= eps * max(size)
            second = sum(p[part] for p in products) - (0 if part else m)
            assert abs(second) <= 2 * eps * sum(size[i] * size[k] for i, k in pairs)
            assert abs(whole[part] + (0 if part else n)) <= 3 * eps * size[0] * size[1] * size[2]


@pytest.mark.parametrize("mu, word, e", [((0, 0, 1), "elliptic", -1), ((0, 1, 0), "hyperbolic", 1)])
def test_the_minor_axis_is_elliptic_and_the_middle_axis_hyperbolic(mu, word, e):
    r = reduce(ScaledGyrostat("0.2", "0.4", mu))
    assert (r.kind, r.e) == (word, e)


def test_a_body_with_two_equal_moments_is_parabolic_about_a_transverse_axis():
    r = reduce(Scene(Body((2, 2, 1)), Gyrostat((0, "0.25", "0.5")), ConstantTorque(("0.5", 0, 0))))
    assert (r.kind, r.e, r.parabolic_shift_size) == ("parabolic", 0, 0.0)


families = pytest.mark.parametrize("name", FAMILIES)


@families
def test_generic_states_need_no_many_digits(name, monkeypatch):
    """Error bounds that are too wide change no answer, only the cost: the counters tell."""
    from stabilab.orbit.extremes import balls as precise_extremes
    monkeypatch.setattr(precise_extremes, "precise_extremes", lambda *a: pytest.fail("a generic state went to ball arithmetic"))
    scene, states = FAMILIES[name][0], sample(name, 300)
    assert stabilab.fate(scene, states).precise == 0
    stabilab.extremes(scene, states, fast=False)


@families
def test_the_reason_is_whether_a_barrier_stands_ahead_and_how_high(name):
    """The potential at 60 digits: no barrier, one below the energy, one above it; on hyperbolas walls hold everything."""
    scene, problem = FAMILIES[name]
    states = sample(name, 30)
    found = stabilab.fate(scene, states)
    for state, reason, label in zip(states.tolist(), found.reasons, found.labels):
        margin = energy.margin(problem, state, digits=60)
        expected = (Reason.WALLS if name not in ELLIPTIC else Reason.NO_BARRIER if margin is None
                    else Reason.BELOW_BARRIER if margin > 0 else Reason.ABOVE_BARRIER)
        assert reason == expected and (label == Fate.BOUNDED) == (expected in (Reason.WALLS, Reason.BELOW_BARRIER))
    words = found.because
    assert words.shape == (30,)
    assert words[3] == stabilab.fate(scene, states[3]).because == REASONS[Reason(int(found.reasons[3]))]


REDUCED = {**FAMILIES, "free, gyrostat on the major axis": physical((3, 2, 1), (0.5, 0, 0)), "free": physical((3, 2, 1)),
           "free, gyrostat on the minor axis": physical((3, 2, 1), (0, 0, -0.25)),
           "free, scaled": scaled(0.25, 0.75, (0, 0, 0)),
           "wheel and torque on the symmetry axis": physical((3, 2, 2), (0.5, 0, 0), (0.25, 0, 0)),
           "wheel and torque on the symmetry axis, other signs": physical((2, 2, 1), (0, 0, -0.5), (0, 0, -0.25)),
           "wheel on the symmetry axis": physical((2, 3, 2), (0, 0.5, 0))}


@pytest.mark.parametrize("name", REDUCED)
def test_the_canonical_variables_move_as_the_module_says(name):
    """The exact rates, by the oracle's own coefficients: X' = Z W, Z' = e X W, W' = mu + G X Z + c Z + d X, mu >= 0."""
    scene, problem = REDUCED[name]
    r = reduce(scene)
    g, near = r.exact_constants, lambda a, b, size: abs(a - b) <= F(1, 10**50) * size
    for state in np.random.default_rng(8).normal(size=(8, 3)).tolist():
        rate = problem.rate([F(v) for v in state])
        x, z, w = r.canonical_exact(state)
        shifts = 1 + g["sj"] / g["rx"], 1 + g["sk"] / g["rz"], 1
        assert near(g["flip"] * rate[r.j] / g["rx"], z * w, abs(z * w))
        assert near(rate[r.k] / g["rz"], r.e * x * w, abs(x * w))
        terms = g["mu"], g["G"] * x * z, g["c"] * z, g["d"] * x
        assert near(g["flip"] * g["n"] * rate[r.axis], sum(terms), sum(map(abs, terms))) and g["mu"] >= 0
        assert r.exact_invariant_sign(state) == (1 if z * z > r.e * x * x else -1)
        for exact, rounded, size in zip((x, z, w), r.canonical(np.array(state)), shifts):
            assert float(exact) == pytest.approx(float(rounded), rel=1e-14, abs=1e-14 * abs(float(size)))
        back = r.component_i(float(w)), r.component_j(float(x)), r.component_k(float(z))
        assert back == pytest.approx([state[i] for i in (r.axis, r.j, r.k)], rel=1e-13, abs=1e-13)
    torque = F(scene.mu[r.axis]) if scene.variables == "scaled" else F(scene.vector("constant_torque")[r.axis])
    assert r.sense == (torque > 0) - (torque < 0)
    # weight W^2/(2 n^2) is the energy of omega_i: the unit is weight/|p q|
    assert r.energy_unit == pytest.approx(float(problem.weight[r.axis] / abs(r.p * r.q)), rel=1e-15)


@pytest.mark.parametrize("inertia, momentum, torque", [
    ((3, 2, 1), (0.5, 0, 0), (0.2, 0, 0)), ((3, 2, 1), (0, 0.5, 0), (0, 0.2, 0)), ((3, 2, 1), (0, 0, 0), (1, 1, 0)),
    ((3, 2, 2), (0.5, 0.1, 0), (0.2, 0, 0)), ((2, 2, 1), (0.5, 0, 0), (0.2, 0, 0)), ((3, 2, 1), (1, 1, 1), (0, 0, 0))])
def test_no_reduction_where_the_other_two_rates_share_no_factor(inertia, momentum, torque):
    """D_j w_j' = (D_k - D_i) w_k (w_i - s) ...: a wheel along the torque's axis asks for D_j = D_k and nothing across it."""
    assert reduce(physical(inertia, momentum, torque)[0]) is None


def test_a_wheel_on_the_symmetry_axis_shifts_the_rate_about_it():
    """D2 w2' = (D3 - D1) w3 w1 - lambda1 w3 vanishes at w1 = -lambda1/(D1 - D3), D2 = D3: s = lambda1/(D1 - D3)."""
    r = reduce(REDUCED["wheel and torque on the symmetry axis"][0])
    assert (r.axis, r.s, r.weight) == (0, F(1, 2), 3)


# Two equal moments, the torque on a transverse axis: the orbit's pair of rates runs along a parabola or a straight line.
PARABOLIC = {
    "first axis": physical((2, 2, 1), (0, 0.25, 0.5), (0.5, 0, 0)),
    "first axis, other sign": physical((2, 2, 1), (0, -1.5, 0.7), (-0.8, 0, 0)),
    "second axis": physical((2, 2, 3), (0.4, 0, -0.9), (0, 0.3, 0)),
    "third axis": physical((1.5, 2, 2), (0.6, -0.3, 0), (0, 0, -0.4)),
    "oblate": physical((3, 2, 2), (1.5, 0.8, 0), (0, 0, 0.2)), "no gyrostat": physical((2, 2, 1), (0, 0, 0), (1, 0, 0)),
    "wheel on the symmetry axis": physical((2, 2, 1), (0, 0, 0.5), (0.5, 0, 0)),
    "a sphere": physical((2, 2, 2), (0, 0.5, 1), (0.5, 0, 0))}


@pytest.mark.parametrize("name", PARABOLIC)
def test_motions_along_parabolas_have_the_fate_and_extremes_of_the_potential(name):
    scene, problem = PARABOLIC[name]
    states = np.random.default_rng(4).normal(size=(12, 3)) * 2
    found, boxes, times = stabilab.fate(scene, states), stabilab.extremes(scene, states), stabilab.period(scene, states)
    for n, state in enumerate(states.tolist()):
        assert found.labels[n] == WORDS[energy.label(problem, state, digits=60)]
        margin = energy.margin(problem, state, digits=60)
        kinetic = 0.5 * float(problem.weight[reduce(scene).axis]) * state[reduce(scene).axis] ** 2
        if margin is None:
            assert np.isposinf(found.margins[n])
        else:
            assert abs(found.margins[n] - float(margin)) <= 1e-12 * (abs(float(margin) + kinetic) + kinetic)
        assert_extremes(boxes[n], energy.extremes(problem, state, digits=60), 1e-11)
        if n < 3:
            assert times[n] == pytest.approx(float(energy.period(problem, state)), rel=1e-11)


@pytest.mark.parametrize("state", [(0.3, -0.4, -1.0), (0.3, -0.4, 2.0), (0.0, 0.0, 0.5)])
@pytest.mark.parametrize("moment", [0.5, -0.25])
@pytest.mark.parametrize("axis", [0, 2])
def test_spin_about_a_torque_that_no_other_rate_disturbs_grows_for_ever(axis, moment, state):
    """D = (2, 2, 1): with the torque on axis 3, D3 w3' = M3 whatever the rest; on axis 1 only if the rest is at rest."""
    state = (state[2], 0.0, 0.0) if axis == 0 else state
    scene = Scene(Body((2, 2, 1)), ConstantTorque(tuple(moment * (i == axis) for i in range(3))))
    sense = 1 if moment > 0 else -1
    found, box = stabilab.fate(scene, np.array(state)), stabilab.extremes(scene, np.array(state))
    reason = Reason.PURE_SPIN if axis == 0 else Reason.NO_BARRIER
    assert (found.labels, found.axis, found.sense, found.reasons) == (Fate.SPIN_UP, axis + 1, sense, reason)
    assert found.margins == -np.inf and box[axis].tolist() == ([state[axis], np.inf] if sense > 0 else [-np.inf, state[axis]])
    if axis == 2:  # the other two turn on their circle
        assert box[:2] == pytest.approx(np.hypot(*state[:2]) * np.array([[-1, 1], [-1, 1]]), rel=1e-14)
    else:
        assert box[1:].tolist() == [[0, 0], [0, 0]]


@pytest.mark.parametrize("a, b, sign", [(0.25, 0.5, 1), (0.25, 0.5, -1), (0.0, 3.0, 1), (0.0, -3.0, 1), (0.5, 0.5, 1),
                                        (0.0, 3.0, -1)])
@pytest.mark.parametrize("plane", [-1, 1])
def test_motions_on_the_invariant_planes_have_the_fate_and_extremes_of_the_potential(a, b, sign, plane):
    """x3 = -(x1 + b) decays in the torque's direction, x3 = x1 + b grows; the oracle follows the one exponential left."""
    scene, problem = scaled(a, b, (0, sign, 0))
    states = [(y - b, w, plane * y) for y in (-4.0, -1.25, -0.5, 0.5, 1.25, 4.0) for w in (-3.0, -0.75, 0.0, 2.5)]
    found, boxes = stabilab.fate(scene, np.array(states)), stabilab.extremes(scene, np.array(states))
    for n, state in enumerate(states):
        assert found.labels[n] == WORDS[energy.label(problem, state, digits=60)], state
        assert_extremes(boxes[n], energy.extremes(problem, state, digits=60), 1e-11)


@pytest.mark.parametrize("name", ["minor scaled +", "minor scaled -", "minor physical", "major physical, other sign",
                                  "middle scaled, |c| far above"])
def test_states_within_rounding_of_a_saddle_are_labelled_by_the_side_they_are_on(name):
    """Offsets from the barrier of some units in the last place, energies down to their squares: the potential at 100 digits."""
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


@pytest.mark.parametrize("name", ["minor scaled +", "major physical, other sign", "middle scaled -, |c| above the cusp"])
def test_the_loops_for_the_compiler_run_as_plain_python_give_the_bytes_of_the_arrays(name):
    """Two ways to write the same arithmetic; 600 states are more than one block of the loops."""
    scene, states = FAMILIES[name][0], sample(name, 600)
    table, answers = barrier_table(scene), []
    for loops in (None, {-1: barrier_heights.circle_loop, 1: barrier_heights.hyperbola_loop}):
        out = {"margins": np.zeros(600), **{key: np.zeros(600, np.int8) for key in ("labels", "axis", "sense", "reasons")}}
        with np.errstate(all="ignore"):
            unsure = label_by_table(table, states, out, loops)
        certain = np.delete(np.arange(600), unsure)
        # reasons apart: two truth values add to 2 in machine code, to True in Python (test_fate_speed compares them compiled)
        answers.append((unsure.tobytes(), *(out[key][certain].tobytes() for key in ("margins", "labels", "axis", "sense"))))
    assert answers[0] == answers[1] and len(certain) > 500
    # and the general formula, which has no table, agrees
    np.testing.assert_array_equal(out["labels"][certain], stabilab.fate(scene, states).labels[certain])


def test_free_motions_on_an_invariant_plane_tend_to_the_pure_spin_exactly_where_their_energy_reaches_its():
    """D = (6, 5, 3), lambda = (1/2, 0, 1): p = q = 1/3, planes w3 - 1/2 = +-(w1 + 1/2). On them |H|^2 - 2 D2 T is that of the
    pure spin about axis 2 at w1 = -1/2, w3 = 1/2, whose least energy is (6/4 + 3/4)/2 = 9/8; less energy cannot go there."""
    scene, _ = physical((6, 5, 3), (0.5, 0, 1))
    states = [(y - 0.5, w, 0.5 + s * y) for y in (-2, -0.5, 0.25, 0.5, 1, 3) for s in (1, -1) for w in (0, 0.5, -2)]
    states.remove((0.0, 0, 0.0))  # at rest
    found = stabilab.fate(scene, np.array(states))
    over = [F(6 * x * x + 5 * y * y + 3 * z * z) / 2 - F(9, 8) for x, y, z in states]
    assert 0 in over and min(over) < 0
    np.testing.assert_array_equal(found.labels, [Fate.SEPARATRIX if o >= 0 else Fate.BOUNDED for o in over])
    # what tends to the pure spin has its energy at its momentum: margin 0; the others keep off every saddle
    np.testing.assert_array_equal(found.margins == 0, [o >= 0 for o in over])
    np.testing.assert_array_equal(found.reasons, [Reason.TIE if o >= 0 else Reason.TORQUE_FREE for o in over])
