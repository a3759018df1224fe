"""First times against brute force in long doubles (`tests.oracles.first_crossing`), which shares no code with
the program."""
from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab
from stabilab.errors import InputError
from stabilab.integrate import events as event_run
from stabilab.physics.coefficients import to_scaled
from tests.oracles.first_crossing import REAL, first_crossing
from tests.oracles.rigid import euler, with_a_direction

FAR = 60.0  # how far brute force looks, in natural units


def random_question(rng):
    """(scene, state, question, the same for brute force): moments of a mass distribution, torque and wheel of
    any direction or along an axis."""
    moments = rng.dirichlet((1.0, 1.0, 1.0)) + 0.02
    D = moments.sum() - moments
    torque = rng.normal(size=3)
    torque /= np.linalg.norm(torque)
    wheel = rng.normal(size=3) * rng.choice([0.0, 0.1, 1.0])
    if rng.random() < 0.3:  # a torque on an axis, the wheel across it or absent
        axis = rng.integers(3)
        torque = np.eye(3)[axis] * rng.choice([-1, 1])
        wheel[axis] *= rng.random() < 0.2
    state = rng.normal(size=3) * rng.choice([0.1, 1.0, 3.0])
    scene = stabilab.Scene(stabilab.Body(tuple(D)), stabilab.Gyrostat(tuple(wheel)),
                           stabilab.ConstantTorque(tuple(torque)))
    size = np.linalg.norm(state)
    kind, nothing = rng.choice(["rate", "component", "energy", "tilt"]), np.zeros(3)
    if kind == "rate":
        most = float(size * rng.uniform(1.05, 1.5) + rng.uniform(0, 2))
        return scene, state, {"rate": most}, (np.ones(3), nothing, REAL(most) ** 2)
    if kind == "component":
        axis = int(rng.integers(3))
        most = float(abs(state[axis]) * 1.05 + rng.uniform(0.1, 2) * max(size, 0.5))
        return scene, state, {"component": (axis + 1, most)}, (np.eye(3)[axis], nothing, REAL(most) ** 2)
    if kind == "energy":
        most = float(0.5 * state @ (np.array(scene.body.inertia) * state) * rng.uniform(1.1, 2.5) + 0.1)
        return scene, state, {"energy": most}, (0.5 * np.array(scene.body.inertia), nothing, most)
    axis, angle = int(rng.integers(3)), float(rng.uniform(0.05, 2.5))
    return scene, state, {"tilt": (axis + 1, angle)}, (nothing, np.eye(3)[axis], np.cos(REAL(angle)))


def judged(rng):
    """(relative width or None, level) of one random question, the answer held against brute force."""
    scene, state, question, limit = random_question(rng)
    found = stabilab.time_to(scene, state, **question, t_max=FAR)
    true = first_crossing(scene.body.inertia, np.array(scene.vector("gyrostat"), float),
                          np.array(scene.vector("constant_torque"), float), state, limit, FAR)
    if true is None:
        assert found.high == math.inf or (math.isnan(found.high)
                                          and found.low >= FAR * (1 - 1e-12)), (question, found)
        return None, found.level
    # what brute force in long doubles may be off by: its unit 1e-19 times the growth of an error on the way
    slack = 1e-13 * true
    assert found.low - slack <= true <= found.high + slack, (question, found, true)
    return (found.high - found.low) / found.low, found.level


def crossings_of(seed, count):
    rng = np.random.default_rng(seed)
    rows = [judged(rng) for _ in range(count)]
    widths = [width for width, _ in rows if width is not None]
    assert len(widths) > count / 3
    assert np.median(widths) <= 1e-9
    return rows


@pytest.mark.slow
@pytest.mark.parametrize("seed, scenes", [(1, 150), pytest.param(2, 1000, marks=pytest.mark.long)])
def test_first_times_of_random_scenes_hold_those_of_brute_force(seed, scenes):
    pytest.importorskip("heyoka")
    rows = crossings_of(seed, scenes)
    assert sum(level in ("proved", "exact") for _, level in rows) >= 0.88 * scenes


BODY, WHEEL = stabilab.Body((12, 9, 5)), stabilab.Gyrostat(("0.8", 0, 0))
TILTED = stabilab.Scene(BODY, WHEEL, stabilab.ConstantTorque(("0.001", 0, "0.02")))
ON_AXIS = stabilab.Scene(BODY, WHEEL, stabilab.ConstantTorque((0, 0, "0.02")))


def test_the_spin_of_a_symmetric_body_reaches_a_limit_when_the_torque_has_gathered_it():
    scene = stabilab.Scene(stabilab.Body((4, 4, 5)), stabilab.ConstantTorque(("0.1", "-0.2", "0.5")))
    found = stabilab.time_to(scene, [0.5, -1.0, 0.25], component=(3, 2))
    # D3 omega3' = M3: (2 - 1/4) 5/0.5
    assert found.low <= 17.5 <= found.high and found.high - found.low < 1e-14
    assert found.level == "proved"


def test_a_limit_far_beyond_any_run_is_told_by_the_clock_of_the_spin_up():
    scene = stabilab.Scene(stabilab.Body((4, 4, 5)), stabilab.ConstantTorque(("0.1", "-0.2", "0.5")))
    found = stabilab.time_to(scene, [0.5, -1.0, 0.25], component=(3, 20000))
    true = (20000 - 0.25) * 10  # the same law
    assert found.low <= true <= found.high and found.high - found.low < 1e-9 * true


def test_the_clock_brackets_what_a_run_finds():
    found = stabilab.time_to(TILTED, [0.1, 0.05, 0.9], rate=2)
    early, late = stabilab.spin_up(TILTED, [0.1, 0.05, 0.9]).trap.clock(2.0)
    # |omega| passes 2 before the spin alone does, by less than the clock's width
    assert early < found.low <= found.high < late


def test_both_sides_of_the_largest_rate_of_a_bounded_motion_are_told_apart():
    state = [0.1, 0.05, 0.02]
    for axis, (low, high) in enumerate(stabilab.extremes(ON_AXIS, state, digits=14), 1):
        # by quadrature and roots of the reduced potential, checked to 14 digits
        largest = max(abs(low), abs(high))
        below, above = (stabilab.time_to(ON_AXIS, state, component=(axis, largest * (1 + step)))
                        for step in (-1e-10, 1e-10))
        assert below.high < 33 and below.level == "proved"  # the period is 32.84 s
        assert above.low == above.high == math.inf


def test_a_tilt_is_the_angle_that_a_run_of_the_attitude_shows():
    found = stabilab.time_to(TILTED, [0.1, 0.05, 0.9], tilt=((1, 2, 2), "0.75"))
    run = stabilab.trajectory(TILTED, {"omega": [0.1, 0.05, 0.9], "attitude": [1, 0, 0, 0]},
                              [found.low / 2, found.low])
    axis = np.array([1, 2, 2]) / 3
    w, q = run.block("attitude")[:, :1], run.block("attitude")[:, 1:]
    turned = axis + 2 * np.cross(q, np.cross(q, axis) + w * axis)  # of a unit quaternion
    angles = np.arccos(turned @ axis)
    assert angles[0] < 0.75 and abs(angles[1] - 0.75) < 1e-12


def test_of_three_components_the_first_to_reach_its_limit_counts():
    state = [0.1, 0.05, 0.9]
    each = [stabilab.time_to(TILTED, state, component=(axis, most)).low for axis,
            most in ((1, "0.2"), (2, "0.2"), (3, 1))]
    both = stabilab.time_to(TILTED, state, rate=("0.2", "0.2", 1))
    assert both.low == min(each) < sorted(each)[1]


def test_scaled_variables_answer_as_their_body_does():
    scene = stabilab.Scene(stabilab.Body((5, 4, 2)), stabilab.Gyrostat((1, 0, 0)),
                           stabilab.ConstantTorque((0, 0, "0.5")))
    scaled, change = to_scaled(scene)
    state, most = (0.25, 0.5, 2.0), 4
    found = stabilab.time_to(scene, state, component=(3, most))
    other = stabilab.time_to(scaled, change.to_scaled(state), component=(3, most / change.rate[2]))
    assert other.level == "proved" and abs(other.low * float(change.time) / found.low - 1) < 1e-13


def test_a_limit_that_the_start_has_reached_takes_no_time():
    found = stabilab.time_to(TILTED, [[0, 0, 2], [0, 0, 1.5]], rate=2)
    assert found.low.tolist() == [0.0, found.low[1]] and found.high[0] == 0 and found.low[1] > 0


def test_an_equilibrium_never_reaches_a_limit():
    point = stabilab.Scene(BODY, WHEEL)
    found = stabilab.time_to(point, [0.5, 0, 0], rate=2)
    assert found.low == math.inf and found.level == "exact"


def test_a_search_that_ends_says_until_when_the_limit_is_not_reached():
    found = stabilab.time_to(TILTED, [0.1, 0.05, 0.9], rate=2, t_max=100)
    assert found.low == 100 and math.isnan(
        found.high) and found.level == "proved" and "not reached" in found.words


def test_without_work_for_a_proof_a_run_answers_the_same():
    proved, run = (stabilab.time_to(TILTED, [0.1, 0.05, 0.9], rate="1.5", work=work)
                   for work in (30_000_000, 0))
    assert run.level == "run" and run.low <= proved.low <= proved.high <= run.high < proved.high * (1 + 1e-11)


def test_without_heyoka_scipy_finds_the_same_root(monkeypatch):
    pytest.importorskip("heyoka")
    question = {"rate": "0.95", "work": 0}
    taylor = stabilab.time_to(TILTED, [0.1, 0.05, 0.9], **question)
    monkeypatch.setattr(event_run, "heyoka_available", lambda: False)
    scipy = stabilab.time_to(TILTED, [0.1, 0.05, 0.9], **question)
    assert scipy.low != taylor.low and abs(scipy.low - taylor.low) < 1e-8 and scipy.level == "run"


def test_other_effects_are_answered_by_a_run():
    from scipy.integrate import solve_ivp
    scene = stabilab.Scene(BODY, WHEEL, stabilab.ConstantTorque(("0.001", 0, "0.02")),
                           stabilab.Resistance("0.001"))
    found = stabilab.time_to(scene, [0.1, 0.05, 0.9], rate="0.95")

    def rates(_, w):  # Euler's equations with -c D omega, typed in by hand
        D, H = np.array([12, 9, 5.0]), np.array([12, 9, 5.0]) * np.array(w) + np.array([0.8, 0, 0])
        return (np.cross(H, w) + np.array([0.001, 0, 0.02])) / D - 0.001 * np.array(w)

    def passed(_, w):
        return np.dot(w, w) - 0.95**2
    passed.terminal = True
    true = solve_ivp(rates, (0, 1000), [0.1, 0.05, 0.9], method="DOP853", rtol=1e-12, atol=1e-14,
                     events=passed).t_events[0][0]
    assert found.level == "run" and abs(found.low - true) < 1e-8 and found.high - found.low < 1e-10


@pytest.mark.parametrize("effect, settles", [
    (stabilab.RateDamper("0.1"), 1.0), (stabilab.Resistance("0.05"), 0.5)])
def test_a_rate_at_which_a_motion_settles_is_not_said_to_be_reached(effect, settles):
    """By hand, from rest about axis 1: omega1 = w (1 - exp(-t M/(D1 w))), w = M/c or M/(c D1)."""
    scene = stabilab.Scene(stabilab.Body((4, 3, 2)), effect, stabilab.ConstantTorque((0.1, 0, 0)))
    time = lambda share: -math.log1p(-share) * 4 * settles / 0.1
    found = stabilab.time_to(scene, (0, 0, 0), rate=settles)
    assert found.level == "undecided" and math.isnan(found.high) and found.low > time(1 - 1e-6)
    for share in (0.5, 0.999, 1 - 1e-9):
        low, high = map(float, stabilab.time_to(scene, (0, 0, 0), rate=share * settles))
        assert low <= time(share) * (1 + 1e-6) and high >= time(share) * (1 - 1e-6)
        assert high - low < 1e-5 * high


def test_a_bound_of_the_rate_keeps_other_limits_from_being_reached():
    scene = stabilab.Scene(BODY, stabilab.Resistance("0.01"))
    found = stabilab.time_to(scene, [0.1, 0.05, 0.9], rate=2)  # T falls, and |omega|^2 <= 2 T / D3 < 1.5^2
    assert found.low == math.inf and "always" in found.words


@pytest.mark.parametrize("question, words", [
    ({}, "expected one of rate, component, energy, tilt, below, nutation and nutation_below, got none"),
    ({"rate": 2, "energy": 1}, "expected one of rate, component, energy, tilt, below, nutation and nutation_below, got rate, energy"),
    ({"rate": -2}, "expected a positive limit, got -2"),
    ({"rate": "30 deg"}, "rate: expected angular velocity (rad/s), got angle"),
    ({"component": 3}, "component: expected"),
    ({"component": (4, 1)}, "expected the axis 1, 2 or 3"),
    ({"component": ((0, 0, 0), 1)}, "expected a direction, got zero"),
    ({"tilt": (3, 4)}, "expected an angle below half a turn"),
    ({"rate": 2, "t_max": -1}, "t_max: expected a positive time"),
])
def test_limits_that_are_none_are_refused(question, words):
    with pytest.raises(InputError, match="time_to|limit|expected"):
        stabilab.time_to(TILTED, [0.1, 0.05, 0.9], **question)
    with pytest.raises(InputError) as raised:
        stabilab.time_to(TILTED, [0.1, 0.05, 0.9], **question)
    assert words in str(raised.value)


def test_a_pure_spin_far_from_its_limit_reaches_it_when_the_torque_has_turned_it():
    """omega2 = omega2(0) + M2 t/D2 and nothing else: |omega2| = 100 at t = (100 + 1.2) D2/|M2|, by hand. A
    series of two terms has no end of its own."""
    scene = stabilab.Scene(stabilab.Body((5, "14.25", 14)), stabilab.ConstantTorque((0, -1, 0)))
    for work in (0, 10**6):
        found = stabilab.time_to(scene, [0, 1.2, 0], rate=100, work=work)
        assert found.low <= 101.2 * 14.25 <= found.high < found.low * (1 + 1e-9)


def test_a_torque_between_equal_moments_that_spins_up_is_followed():
    """A wheel along the torque: no extremes over all time, and yet a first time."""
    scene = stabilab.Scene(stabilab.Body((5, 9, 9)), stabilab.Gyrostat((0, 1, 0)),
                           stabilab.ConstantTorque((0, -1, 1)))
    found = stabilab.time_to(scene, [0.3, 1.2, 0], rate=2)
    run = solve_ivp(euler((5, 9, 9), (0, 1, 0), (0, -1, 1)), (0, found.high * 1.01),
                    [0.3, 1.2, 0], "DOP853", rtol=1e-12, atol=1e-14,
                    dense_output=True)
    assert found.low < np.inf and np.linalg.norm(run.sol(found.low)) == pytest.approx(2, rel=1e-8)


def test_a_way_too_long_for_integers_is_enclosed_by_compiled_steps():
    pytest.importorskip("numba")
    a = math.radians(1)
    # the satellite of README.md, its thruster tilted by a degree
    torque = (-0.02 * math.sin(a), 0.0, 0.02 * math.cos(a))
    scene = stabilab.Scene(BODY, WHEEL, stabilab.ConstantTorque(torque))
    found = stabilab.time_to(scene, [0.1, 0.05, 0.02], rate=2, work=1_000_000)
    true = first_crossing((12, 9, 5), (REAL("0.8"), 0, 0), torque, [0.1, 0.05, 0.02],
                          (np.ones(3), np.zeros(3), REAL(4)), 1e4)
    assert found.level == "proved" and found.low <= true <= found.high < found.low * (1 + 1e-9)


def test_three_components_are_enclosed_by_compiled_steps_too():
    pytest.importorskip("numba")
    found, far = (stabilab.time_to(TILTED, [0.1, 0.05, 0.9], rate=("0.5", "0.5", most), work=1)
                  for most in ("1.5", 5))
    one = stabilab.time_to(TILTED, [0.1, 0.05, 0.9], component=(3, "1.5"))
    assert found.level == far.level == "proved" and found.low <= one.high and one.low <= found.high
    assert far.low > found.high


def by_dop853(scene, state, limit, end):
    """The first time by `end` at which sum c_i w_i^2 + k . n, n = k at the start, is the limit's value."""
    (c, k, value), D, l, M = limit, scene.body.inertia, scene.vector("gyrostat"), scene.vector("constant_torque")
    sign = -1 if np.any(k) else 1  # a tilt's cosine falls

    def passed(_, y):
        return sign * float(np.dot(c, np.square(y[:3])) + np.dot(k, y[3:]) - value)
    passed.terminal, passed.direction = True, 1
    run = solve_ivp(with_a_direction(D, l, M), (0, end), [*state, *k],
                    "DOP853", events=passed, rtol=1e-12, atol=1e-12, max_step=0.2 / max(1, np.abs(state).max()))
    return run.t_events[0][0] if run.t_events[0].size else math.inf


@pytest.mark.slow
@pytest.mark.parametrize("seed, scenes", [(3, 30), pytest.param(4, 1000, marks=pytest.mark.long)])
def test_compiled_steps_do_not_contradict_integers(seed, scenes):
    """Two enclosures of one motion meet; every tenth is held against SciPy."""
    pytest.importorskip("numba")
    rng, proved = np.random.default_rng(seed), 0
    for n in range(scenes):
        scene, state, question, limit = random_question(rng)
        one, two = (stabilab.time_to(scene, state, **question, t_max=FAR, work=work) for work in (30_000_000, 1))
        ends = [math.inf if math.isnan(found.high) else float(found.high) for found in (one, two)]
        assert max(one.low, two.low) <= min(ends), (question, one, two)
        proved += two.level in ("proved", "exact")
        if n % 10 == 0:
            true = by_dop853(scene, state, limit, FAR)
            assert (true == math.inf and two.low >= FAR * (1 - 1e-9)) or (
                two.low - 1e-7 * true <= true <= ends[1] + 1e-7 * true), (question, two, true)
    assert proved >= 0.95 * scenes
