"""How motions that lose energy end, and when: against SciPy's DOP853 on equations written here, closed forms, and
in every view."""
import csv
import io
import json
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stabilab import Body, LiquidCavity, Scene, ViscousDamper, flat_spin, load, motion, when
from stabilab.answers.dissipation import flat_spin as flat_spins
from stabilab.show.space.span import seen
from tests.oracles.rigid import damped, euler, with_a_direction

CASE = """[body]
inertia = {D}
{effects}
[motion]
angular_velocity = {omega}
{more}
"""


def case(D, omega, more="", **effects):
    tables = "\n".join(f"[effects.{name}]\n" + "\n".join(f"{key} = {value}" for key, value in keys.items())
                       for name, keys in effects.items())
    return load(CASE.format(D=list(D), omega=list(omega), effects=tables, more=more))


def followed(rates, start, until, below=None):
    """A run of DOP853; below: a function that ends it where it falls through zero."""
    if below is not None:
        below.terminal, below.direction = True, -1
    return solve_ivp(rates, (0, until), start, method="DOP853", rtol=1e-11, atol=1e-13, events=below)


# --- From outside
def test_a_medium_brings_a_body_to_rest_as_an_exponential():
    """torque -c D omega: T = T(0) exp(-2 c t), so that the rates are 1 % after ln(100)/c (by hand)."""
    found = motion(case((3, 2, 1), (0.3, 0.2, 1), resistance={"coefficient": 0.05})).ending
    assert (found.kind, found.level, found.rates) == ("rest", "exact", (0, 0, 0))
    assert found.time("settles") == pytest.approx(math.log(100) / 0.05, rel=1e-9)
    assert found.at_the_latest == pytest.approx(math.log(100) / 0.05, rel=1e-12)


@pytest.mark.parametrize("seed", range(3))
def test_a_linear_damper_brings_a_body_to_rest_when_scipy_says(seed):
    rng = np.random.default_rng(seed)
    D, C, w = np.array([3.0, 2.0, 1.5]), rng.uniform(0.01, 0.2, 3), rng.uniform(-1, 1, 3)
    found = motion(case(D.tolist(), w.tolist(), rate_damper={"coefficient": C.tolist()})).ending
    T = lambda w: w @ (D * w) / 2
    run = followed(euler(D, damping=C), w, 1e4, lambda t, x: T(x) / T(w) - 1e-4)
    assert found.kind == "rest" and found.time("settles") == pytest.approx(run.t_events[0][0], rel=1e-6)
    assert found.time("settles") <= found.at_the_latest


def eddy(seed):
    """(moments, k B^2, start, direction of the field) of a scene with one axis of the largest moment."""
    rng = np.random.default_rng(seed)
    D = np.sort(rng.uniform(1.0, 2.0, 3))[rng.permutation(3)]
    g = rng.normal(size=3)
    return D, float(rng.uniform(0.1, 0.6)), rng.uniform(-0.5, 0.5, 3), g / np.linalg.norm(g)


def end_of(seed):
    """Whether the end under eddy currents is that of a run of SciPy, in axis, direction and rate; None where
    that run has not come near an end."""
    D, k, w, g = eddy(seed)
    found = motion(case(D.tolist(), w.tolist(), f"vertical = {g.tolist()}",
                        eddy_currents={"coefficient": k, "field": 1})).ending
    run = solve_ivp(with_a_direction(D, eddy=k), (0, 4000), [*w, *g], method="DOP853", rtol=1e-9, atol=1e-12)
    end = run.y[:3, -1]
    axis = int(np.argmax(np.abs(end)))
    if np.delete(np.abs(end), axis).max() > 1e-3 * abs(end[axis]) or found.rates is None:
        return None
    assert found.kind == "rotation about the field" and found.axis == axis + 1 == np.argmax(D) + 1
    return found.rates == pytest.approx(end.tolist(), abs=2e-3 * abs(end[axis]))


@pytest.mark.parametrize("count, least", [(2, 1), pytest.param(24, 16, marks=pytest.mark.slow), pytest.param(
    300, 200, marks=[pytest.mark.slow, pytest.mark.long])])
def test_eddy_currents_end_in_the_direction_that_scipy_shows(count, least):
    ends = [end_of(seed) for seed in range(count)]
    assert ends.count(True) >= least and False not in ends


def test_eddy_currents_settle_when_scipy_says():
    """T falls to (H . gamma)^2/(2 D1); 1e-4 of what is above it is left then."""
    D, k, w, g = eddy(1)
    found = motion(case(D.tolist(), w.tolist(), f"vertical = {g.tolist()}",
                        eddy_currents={"coefficient": k, "field": 1})).ending
    least = ((D * w) @ g) ** 2 / (2 * D.max())
    above = lambda w: w @ (D * w) / 2 - least
    run = followed(with_a_direction(D, eddy=k), [*w, *g], 1e4, lambda t, y: above(y[:3]) / above(w) - 1e-4)
    assert found.time("settles") == pytest.approx(run.t_events[0][0], rel=1e-5)


def test_a_torque_against_a_strong_damper_ends_at_the_one_equilibrium():
    """(delta . D delta) is 1e-4 of that at the start then; the equilibrium by SciPy's run itself."""
    D, C, M, w = np.array([3.0, 2.5, 2.0]), np.array([4.0, 4.0, 4.0]), np.array([0.4, 0.2, -0.1]), np.zeros(3)
    w = np.array([0.5, -0.3, 0.2])
    found = motion(case(D.tolist(), w.tolist(), rate_damper={"coefficient": C.tolist()},
                        constant_torque={"torque": M.tolist()})).ending
    rates = euler(D, torque=M, damping=C)
    end = followed(rates, w, 60).y[:, -1]
    far = lambda x: (x - end) @ (D * (x - end))
    run = followed(rates, w, 60, lambda t, x: far(x) / far(w) - 1e-4)
    assert (found.kind, found.level) == ("steady rotation", "exact")
    assert found.rates == pytest.approx(end.tolist(), abs=1e-9)
    assert found.time("settles") == pytest.approx(run.t_events[0][0], rel=1e-6)


def test_a_dual_spin_craft_settles_where_scipy_does():
    """A wheel beside the damper: (D - k) w' = (D w + l) x w + c s, s' = -c s/k - w x s - w'."""
    D, k, c, l, w = np.array([3.0, 2.0, 1.5]), 0.1, 0.3, np.array([0.0, 0.0, 2.0]), np.array([0.1, 0.05, 0.5])
    found = motion(case(D.tolist(), w.tolist(), viscous_damper={"inertia": k, "coefficient": c},
                        gyrostat={"momentum": l.tolist()})).ending
    rates = damped(D, k, c, l)
    # H is along axis 3 in the end (the moment there is over (3 - 1.5) w); 5 deg from it E is least where its
    # component across is along axis 1, of the largest moment
    H = np.linalg.norm(D * w + l)
    at = np.array([H * math.sin(math.radians(5)), 0, H * math.cos(math.radians(5))])
    level = ((at - l) ** 2 / D).sum() / 2
    def energy(t, y):
        w, s = np.array(y[:3]), np.array(y[3:])
        return (D * w ** 2).sum() / 2 + k * (w @ s + s @ s / 2) - level
    energy.terminal = True
    run = solve_ivp(rates, (0, 1e4), [*w, 0, 0, 0], method="DOP853", rtol=1e-10, atol=1e-13, events=energy)
    assert (found.kind, found.level, found.angular) == ("steady rotation", "exact", True)
    assert found.rates == pytest.approx([0, 0, (H - 2) / 1.5], rel=1e-14)
    assert found.time("settles") == pytest.approx(run.t_events[0][0], rel=1e-6)


# --- Inside a free body
@pytest.mark.one_in(3)
@pytest.mark.parametrize("order", [(2, 1, 0), (1, 0, 2), (0, 2, 1)])
def test_a_spinner_about_its_major_axis_is_no_flat_spin(order, tmp_path, stabilab):
    """Its nutation dies out: the angles are those of the energy of a run of two bodies' equations."""
    D, w = np.array([1000.0, 1500.0, 2000.0]), np.array([0.3, 0.0, 1.5])
    D, w, k, c = D[list(order)], w[list(order)], 18.0, 30.0
    found = motion(case(D.tolist(), w.tolist(), viscous_damper={"inertia": k, "coefficient": c})).ending
    rates = damped(D, k, c)

    def angle(y):  # of the polhode, from the major axis: sin^2 = (2T/H^2 - 1/D1)/(1/D2 - 1/D1)
        w, s = y[:3], y[3:]
        H, T = D * w + k * s, w @ (D * w) / 2 + k * (w @ s + s @ s / 2)
        one, two = sorted(1 / D)[:2]
        return math.asin(math.sqrt(max(0.0, (2 * T / (H @ H) - one) / (two - one))))
    start = np.array([*w, 0, 0, 0])
    assert found.kind == "nutation dies out" and found.axis == 1 + int(np.argmax(D)) and found.sense == 1
    assert found.nutation == pytest.approx(angle(start), rel=1e-12)
    for name, target in (("settles", math.radians(5)), ("tenth", angle(start) / 10)):
        run = followed(rates, start, 1e4, lambda t, y, target=target: angle(y) - target)
        assert found.time(name) == pytest.approx(run.t_events[0][0], rel=1e-6)
    path = tmp_path / "major.toml"
    path.write_text(CASE.format(D=D.tolist(), omega=w.tolist(), more="", effects=(
        "[effects.viscous_damper]\ninertia = 18\ncoefficient = 30")))
    for command in ("flat-spin", "fate"):
        text = stabilab(command, path)[1]
        assert "NUTATION DIES OUT about +" in text and "FLAT SPIN" not in text and "past at the start" not in text
        assert "below 5 deg after 106.4 s" in text


def test_the_end_is_what_flat_spin_says(monkeypatch):
    monkeypatch.setattr(flat_spins, "SPAN_STEPS", 0)
    one = case((2000, 1500, 1000), (0.1224, 0, 2.99), viscous_damper={"inertia": 18, "coefficient": 30})
    found, spin = motion(one).ending, flat_spin(one)
    assert found.kind == "flat spin" and found.sense == -1 and found.rates == spin.rates
    assert (found.time("crosses"), found.time("settles")) == (spin.crosses.at, spin.settles.at)
    assert "undecided" not in motion(one).because


def test_a_small_nutation_says_when_a_tenth_is_left():
    """1 deg and below 5 deg at the start: by the linear time constant, exp(-t/tau) = 1/10."""
    one = case((1, 1.5, 2), (0.0349, 0, 1.5), viscous_damper={"inertia": 0.02, "coefficient": 0.03})
    found = motion(one).ending
    assert found.time("settles") is None and found.kind == "nutation dies out"
    assert found.time("tenth") == pytest.approx(found.decay * math.log(10), rel=0.02)  # to the nutation squared


def test_a_body_without_angular_momentum_comes_to_rest():
    """D omega + k sigma = 0 at the start."""
    one = case((3, 2, 1), (0.1, 0.1, 0.1), "damper = [-3, -2, -1]",
               viscous_damper={"inertia": 0.1, "coefficient": 0.3})
    assert motion(one).ending.kind == "rest" and motion(one).reason.code == "takes-all-energy"


@pytest.mark.parametrize("omega", [(0, 0, 0), (0, 0, 1e-12)])
def test_a_damper_that_turns_in_a_body_at_rest_brings_it_into_a_flat_spin(omega):
    """DOP853: which way it ends, and |H|/D1."""
    end = motion(case((3, 2, 1), omega, "damper = [1, 2, 3]", viscous_damper={"inertia": 0.1, "coefficient": 0.1})).ending
    run = followed(damped((3, 2, 1), 0.1, 0.1), [*omega, 1, 2, 3], 2200)
    assert (end.kind, end.sense) == ("flat spin", np.sign(run.y[0, -1]))
    assert end.rate == pytest.approx(abs(run.y[0, -1]), rel=1e-2)


def test_json_has_the_bound_of_all_time_where_extremes_are_of_a_span(tmp_path, stabilab):
    """The bound of the linear damper by hand: one moment, c = C/D, |omega| <= max(|omega(0)|, M/C)."""
    path = tmp_path / "slow.toml"
    path.write_text(CASE.format(D=[2, 2, 2], omega=[0.1, 0.2, 0.2], more="span = [0, 5]", effects=(
        "[effects.rate_damper]\ncoefficient = 0.5\n[effects.constant_torque]\ntorque = [0.04, 0, 0.03]")))
    (row,) = json.loads(stabilab("fate", path, "--json")[1])
    assert row["numbers"]["largest_rate"]["value"] == pytest.approx(0.3, rel=1e-9)


def test_what_loses_nothing_has_no_end():
    assert motion(case((3, 2, 1), (0.1, 0.1, 1))).ending is None
    scene = Scene(Body((3, 2, 1)), ViscousDamper("0.1", 1))
    assert motion(load(scene, (1, 0, 0))).ending is None  # at rest in its least energy


def test_a_liquid_has_an_end_too():
    scene = Scene(Body((12, 9, 5)), LiquidCavity.of_sphere(10_000, "0.01", "0.12"))
    found = motion(load(scene, (0.02, 0.01, 0.1))).ending
    assert found.kind == "flat spin" and found.axis == 1 and found.sense


def test_a_slow_loss_is_given_up_and_says_at_which_pace_it_goes():
    """Eddy currents so weak that a run would take days: the estimate is 1/k times that of k times as strong ones,
    to what a pace at first is worth."""
    weak, strong = (motion(case((1, 1.5, 2), (0.3, 0.2, 1), "vertical = [0.6, 0, 0.8]",
                                eddy_currents={"coefficient": k, "field": 1})).ending for k in (1e-7, 1e-3))
    assert not weak.times and strong.time("settles") > 0
    assert 0.2 < weak.estimate / (1e4 * strong.time("settles")) < 5


# --- Every view
@pytest.fixture
def tumbling(tmp_path):
    path = tmp_path / "tumbling.toml"
    path.write_text(CASE.format(D=[2000, 1500, 1000], omega=[0.1224, 0, 2.99], more="span = [0, 10]", effects=(
        "[effects.viscous_damper]\ninertia = 18\ncoefficient = 30")))
    return path


def test_texts_tell_the_end_and_the_times(tumbling, stabilab):
    for command in (("fate",), ("classify",), ("extremes",), ("when", "--rate", "200 deg/s")):
        text = stabilab(command[0], tumbling, *command[1:])[1]
        assert "FLAT SPIN about -x (major), at 85.94 deg/s" in text
        assert "separatrix crossed after 7.84 min, within 5 deg of it after 15.43 min" in text
        assert "BOUNDED for ever" not in text


def test_json_and_csv_have_the_end_beside_the_old_keys(tumbling, stabilab):
    for command, old in ((("fate",), "bounded"), (("when", "--rate", "200 deg/s"), "never")):
        found = json.loads(stabilab(command[0], tumbling, *command[1:], "--json")[1])[0]
        assert found["ending"]["kind"] == "flat spin" and found["ending"]["settles"][0] == pytest.approx(926.07, abs=0.01)
        assert old in (found.get("fate"), found.get("reached"))
    assert json.loads(stabilab("classify", tumbling, "--json")[1])[0]["motion"]["ending"]["sense"] == -1
    rows = list(csv.DictReader(io.StringIO(stabilab("when", tumbling, "--rate", "200 deg/s", "--csv")[1])))
    assert rows[0]["ending"] == "flat spin" and float(rows[0]["ending_time"]) == pytest.approx(926.07, abs=0.01)


def test_python_has_the_end(tumbling):
    assert load(tumbling).motion().ending.kind == "flat spin"
    assert when(load(tumbling), rate="200 deg/s").ending.kind == "flat spin"


def test_pictures_go_past_the_end(tumbling):
    found = load(tumbling).motion()
    assert seen((0.0, 10.0), found, 1.0)[1] > found.ending.until == pytest.approx(926.07, abs=0.01)


def test_the_tiles_of_a_page_say_when(tumbling):
    from stabilab.show.report.tables import tiles
    from stabilab.show.units import units_of
    one = load(tumbling)
    found = {name: (value, note) for name, value, note in tiles(one.motion(), units_of(one))}
    assert found["when"][0] == "15.43 min" and "separatrix crossed" in found["when"][1]
    assert found["outcome"][0] == "Flat spin" and "at 85.94 deg/s" in found["outcome"][1]


def test_another_start_than_that_of_the_case_has_its_own_end(tumbling):
    one = load(tumbling)
    found = motion(one, (0.1, 0.2, 0.3)).ending
    assert found == motion(one.scene, (0.1, 0.2, 0.3)).ending != motion(one).ending


def test_a_limit_beyond_the_steps_of_a_first_run_is_followed_to_the_end(monkeypatch):
    """2 T/|H|^2 falls slowly: the component along the major axis passes 1.4 rad/s on the last turns alone; that
    time by DOP853."""
    from stabilab.answers import passage, time_to
    one = case((2000, 1500, 1000), (0.1224, 0, 2.99), viscous_damper={"inertia": 18, "coefficient": 30})
    D, k, c = np.array([2000.0, 1500, 1000]), 18.0, 30.0
    run = followed(damped(D, k, c), [0.1224, 0, 2.99, 0, 0, 0], 1200, lambda t, y: 1.4 - abs(y[0]))
    monkeypatch.setattr(time_to, "by_run", lambda scene, state, limit, last: passage.by_run(
        scene, state, limit, last, 1000))
    found = when(one, component="x = 1.4 rad/s")
    assert 0.5 * (found.low + found.high) == pytest.approx(run.t_events[0][0], rel=1e-7)


def test_a_tile_has_the_end_and_the_limit_that_is_not_reached(tmp_path):
    from stabilab.show.report.tables import tiles
    from stabilab.show.text.headline import judged
    from stabilab.show.units import units_of
    one = load(CASE.format(D=[2000, 1500, 1000], omega=[0.1224, 0, 2.99],
                           more='[limits]\nrate = "200 deg/s"',
                           effects="[effects.viscous_damper]\ninertia = 18\ncoefficient = 30"))
    found = {name: (value, note) for name, value, note in tiles(judged(one, one.motion()), units_of(one))}
    assert found["when"][0] == "15.43 min" and "the limit, 200 deg/s, is never reached (exact)" in found["when"][1]
