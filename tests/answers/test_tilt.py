"""What a tilt of the torque does to a bounded motion: bounds and times against brute force in long doubles,
which shares no code."""
from __future__ import annotations

import json
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab as package
from stabilab.answers.passage import stays_below
from stabilab.answers.tilt import Cone, cone_of, spread, tilt
from stabilab.errors import InputError
from tests.oracles.first_crossing import REAL, first_crossing
from tests.oracles.rigid import euler
from tests.shared import CASES, MOVING, craft_file, in_one_line

BODY, WHEEL, STATE = package.Body((12, 9, 5)), package.Gyrostat(("0.8", 0, 0)), [0.1, 0.05, 0.02]
ON_AXIS = package.Scene(BODY, WHEEL, package.ConstantTorque((0, 0, "0.02")))  # the satellite of README.md


def true_time(scene, torque, state, rate, t_max):
    """Of |omega| = rate, by the oracle."""
    limit = np.ones(3), np.zeros(3), REAL(rate) ** 2
    return first_crossing(scene.body.inertia, np.array(scene.vector("gyrostat"), float), torque, state, limit,
                          t_max)


def bounded_motion(rng):
    """(scene, state, size of the torque) of a bounded motion under a torque on the major or the minor axis.
    """
    while True:
        moments = rng.dirichlet((1.0, 1.0, 1.0)) + 0.02
        D, axis = moments.sum() - moments, 0
        axis = int(rng.choice([np.argmax(D), np.argmin(D)]))
        wheel = rng.normal(size=3) * rng.choice([0.0, 0.3, 1.0])
        wheel[axis] = 0
        torque = np.eye(3)[axis] * rng.choice([-1, 1]) * rng.choice([0.1, 1.0])
        state = rng.normal(size=3)
        scene = package.Scene(package.Body(tuple(D)), package.Gyrostat(tuple(wheel)),
                              package.ConstantTorque(tuple(torque)))
        if package.Fate(package.fate(scene, state).labels).word == "bounded":
            return scene, state, torque


def held(rng):
    """Whether a bound that says something is kept by a random torque of its cone; the bound over the time
    found."""
    scene, state, torque = bounded_motion(rng)
    angle = rng.choice([0.003, 0.03, 0.2])
    rate = float(np.linalg.norm(np.abs(package.extremes(scene, state)).max(axis=-1)) * rng.uniform(1.1, 3))
    size, axis = np.abs(torque).max(), int(np.argmax(np.abs(torque)))
    bound = stays_below(scene, state, rate, size * math.sin(angle),
                        tuple(sorted((torque[axis], torque[axis] * math.cos(angle)))))
    tilted, azimuth = angle * rng.choice([1.0, 1.0, 0.5]), rng.uniform(0, 2 * math.pi)
    across = [n for n in range(3) if n != axis]
    actual = torque * math.cos(tilted)
    actual[across] = size * math.sin(tilted) * np.array([math.cos(azimuth), math.sin(azimuth)])
    true = true_time(scene, actual, state, rate, 12 * bound + 50)
    assert true is None or true > bound
    return bound, true


@pytest.mark.slow
@pytest.mark.parametrize("cones", [60, pytest.param(1500, marks=pytest.mark.long)])
def test_no_torque_of_many_cones_reaches_the_limit_before_the_bound(cones):
    pytest.importorskip("heyoka")
    rng = np.random.default_rng(4)
    assert sum(true is not None for _, true in (held(rng) for _ in range(cones))) > cones // 10


def test_the_bound_grows_as_one_over_the_tilt():
    bounds = [stays_below(ON_AXIS, STATE, 2.0, 0.02 * math.sin(a), (0.02 * math.cos(a), 0.02))
              for a in (1e-4, 1e-3, 1e-2)]
    assert np.allclose(np.array(bounds) * [1e-4, 1e-3, 1e-2] / bounds[0] / 1e-4, 1, rtol=0.05)


def test_a_tilt_of_one_degree_ends_the_bounded_motion_of_the_readme():
    pytest.importorskip("heyoka")
    found = tilt(ON_AXIS, STATE, math.radians(1), rate=2)
    true = true_time(ON_AXIS, found.torque, STATE, 2, 10000)
    assert found.ends and found.low <= true <= found.high
    assert 0.15 * found.low < found.not_before < found.low == pytest.approx(found.times.min(), rel=1e-9)
    assert found.untilted is None and abs(math.hypot(*found.torque) - 0.02) < 1e-15  # turned, not longer
    assert math.degrees(math.atan2(math.hypot(*found.torque[:2]), found.torque[2])) == pytest.approx(1)


def test_a_limit_that_the_bounded_motion_reaches_by_itself_is_told_so():
    found = tilt(ON_AXIS, STATE, rate="0.13")
    assert found.untilted[0] == package.time_to(ON_AXIS, STATE,
                                                rate="0.13").low and found.not_before <= found.untilted[0]


def test_a_component_that_a_spin_up_never_has_is_reached_once_the_torque_is_tilted():
    """DOP853 from the equations, all azimuths in steps of 30 deg, is the reference."""
    case = package.load({"body": {"inertia": [12, 9, 5]}, "effects": {"constant_torque": {"torque": [0, 0, "0.02"]}},
                         "motion": {"angular_velocity": [0, 0, "0.1"]}})
    limit = 0.02 * math.pi / 180
    found = case.when(component="x = 0.02 deg/s")
    assert found.high == math.inf  # about the torque's own axis the body spins up, without any other rate
    D = np.array([12.0, 9, 5])

    def first(torque):
        event = lambda t, w: abs(w[0]) - limit
        event.terminal = True
        run = solve_ivp(lambda t, w: (np.cross(D * w, w) + torque) / D, (0, 200), [0, 0, 0.1], "DOP853",
                        events=event, rtol=1e-10, atol=1e-14)
        return float(run.t_events[0][0]) if len(run.t_events[0]) else math.inf
    assert found.tilt.low == pytest.approx(first(np.array(found.tilt.torque)), rel=1e-4)  # a run of doubles
    edge = [0.02 * np.array([math.sin(math.pi / 180) * math.cos(a), math.sin(math.pi / 180) * math.sin(a),
                             math.cos(math.pi / 180)]) for a in np.arange(12) * math.pi / 6]
    assert found.tilt.low <= min(map(first, edge)) * (1 + 1e-4)


@pytest.mark.parametrize("scene, state, words", [
    (package.Scene(BODY, WHEEL, package.ConstantTorque(("0.001", 0, "0.02"))), STATE,
     "a torque along one of its principal axes"),
    (ON_AXIS, [0.1, 0.05, 0.9], "not bounded"),
    (package.ScaledGyrostat("0.2", "0.4", (0, 0, 1)), [0.1, 0.2, 0.1], "expected a body"),
])
def test_what_no_tilt_can_be_asked_of_is_refused(scene, state, words):
    with pytest.raises(InputError, match=words):
        tilt(scene, state)


@pytest.mark.slow
@pytest.mark.parametrize("degrees", [0.1, *(pytest.param(n, marks=pytest.mark.long) for n in (0.5, 1, 5))])
def test_the_times_of_tilted_torques_in_the_documentation_are_those_of_brute_force(degrees):
    """docs/spacecraft.md has these times in minutes, and what no torque of the cone does before."""
    pytest.importorskip("heyoka")
    pytest.importorskip("numba")
    told = {row[0]: row[1:] for row in _table()}
    angle, column = math.radians(degrees), [0.1, 0.5, 1, 5].index(degrees)
    bound = stays_below(ON_AXIS, STATE, 2, 0.02 * math.sin(angle), (0.02 * math.cos(angle), 0.02))
    assert float(told["any, not before"][column]) == pytest.approx(bound / 60, abs=0.01)
    assert float(told["any, not before"][column]) <= bound / 60
    proved = 0
    for azimuth in range(0, 360, 30):
        phi = math.radians(azimuth)
        torque = (0.02 * np.array([math.sin(angle) * math.cos(phi), math.sin(angle) * math.sin(phi),
                                   math.cos(angle)]))
        found = package.time_to(package.Scene(BODY, WHEEL, package.ConstantTorque(tuple(torque))), STATE,
                                rate=2)
        assert found.low > bound
        proved += found.level == "proved"
        word = told[f"{azimuth} deg"][column]
        if word.startswith(">"):
            assert found.low / 60 >= float(word.removeprefix(">"))
            continue
        true = true_time(ON_AXIS, torque, STATE, 2, 1.1 * found.high)
        assert found.low - 1e-13 * true <= true <= found.high + 1e-13 * true  # what the oracle may be off by
        assert float(word) == pytest.approx(true / 60, abs=0.006)
    assert proved >= 5


def _table():
    """The rows of the table of tilted torques."""
    text = (CASES.parent / "docs" / "spacecraft.md").read_text(encoding="utf-8")
    lines = text[text.index("| azimuth |"):].split("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


THRUSTER = craft_file([12.0, 9.0, 5.0], ([0.6, 0.0, 0.25], [0, 1, 0], "0.04 N"), [([1, 0, 0], 0.8)],
                      [0.10, 0.05, 0.02], [0.1, 0.0, 0.25], misalignment="2 deg")


def test_the_cone_of_a_thruster_is_that_of_its_force(case_file):
    path = case_file(THRUSTER, "thruster")
    case = package.load(path)
    cone, arm, force = cone_of(case.scene, case), np.array([0.5, 0, 0]), np.array([0, 0.04, 0])
    side, (low, high) = cone.reach()
    assert np.allclose(cone.torque, [0, 0, 0.02]) and cone.subject == "the force of A"
    for azimuth in np.linspace(0, 6, 7):
        torque = cone.at(azimuth)
        # arm x F' = torque has the solutions F' = (torque x arm)/arm^2 + c arm; the one in the cone has |F'|
        # = |F|
        across = np.cross(torque, arm) / (arm @ arm)
        along = math.sqrt(max(0.0, force @ force - across @ across))
        assert abs(torque @ arm) < 1e-17
        assert min(abs((across + sign * along * arm / 0.5) @ force / (force @ force)
                       - math.cos(math.radians(2))) for sign in (1, -1)) < 1e-12
        assert math.hypot(*torque[:2]) <= side and low <= torque[2] <= high


@pytest.mark.one_in(3)
@pytest.mark.parametrize("command", ["fate", "stuck"])
def test_the_headline_says_the_longer_of_what_is_proved_and_what_was_followed(stabilab, case_file, command):
    """A bound of days was told as "not found within hours" in the first line."""
    text = MOVING + "[limits]\nrate = 11.75\n"
    for old, new in (("12, 9, 5", "28.5, 28.45, 33.42"), ("[0.8, 0, 0]", "[0.0145, 0, -0.104]"),
                     ("[0, 0, 0.02]", "[0, -0.0136, 0]"), ("[0.1, 0.05, 0.02]", "[0.789, -3.57, -2.77]")):
        text = text.replace(old, new)
    path = case_file(text, "near")
    answer = json.loads(stabilab(command, path, "--json")[1])
    found = answer["rows"][0]["tilt"] if command == "stuck" else answer[0]["tilt"]
    first = in_one_line(stabilab(command, path, "--units", "si")[1].split("\nwhy")[0])
    assert found["time"] is None and found["not_before"] > 1e4
    assert "does not reach 11.75 rad/s before " in first and "(proved)" in first and "not found" not in first
    assert float(first.split(" before ")[1].split()[0]) == pytest.approx(found["not_before"], rel=1e-3)


@pytest.mark.slow
def test_a_stated_limit_or_misalignment_brings_the_tilt_by_itself(stabilab, case_file):
    path = case_file(MOVING + '[limits]\nrate = "2 rad/s"\n', "limit")
    code, out, _ = stabilab("fate", path)
    assert code == 0
    assert "BOUNDED only while the torque is exactly along z (minor axis); tilted by 1 deg it reaches 114.592 deg/s after 1" in in_one_line(out)
    row = json.loads(stabilab("fate", path, "--json")[1])[0]["tilt"]
    assert row["limit"] == 2 and row["limit_stated"] and row["time"][0] <= row["time"][1] and 0 < row[
        "not_before"] < row["time"][0]
    path.write_text(THRUSTER)
    out = stabilab("fate", path)[1]
    assert "BOUNDED only while" in out.splitlines()[
        0] and "tilted by 2 deg: the force of A" in out and "no limit is stated" in out


def test_a_tilt_may_be_asked_for(stabilab, case_file):
    path = case_file(MOVING, "plain")
    assert "tilted by 0.5 deg it reaches" in stabilab("classify", path, "--tilt", "0.5 deg")[1]
    code, _, err = stabilab("classify", path, "--tilt", "95 deg")
    assert code == 2 and "--tilt: expected an angle below 90 deg" in err


def test_a_steady_rotation_is_not_told_to_be_at_rest():
    """M = omega x (D omega + l) with omega = (1, 2, 3), l = (0, 0, 7), D = (3, 2, 1.5), by hand; a cone of no
    width."""
    scene = package.Scene(package.Body((3, 2, "1.5")), package.Gyrostat((0, 0, 7)),
                          package.ConstantTorque((11, "-2.5", -2)))
    found = spread(scene, (1.0, 2.0, 3.0), Cone(np.array([11, -2.5, -2]), (), "the torque", 0.0), None)
    assert found.fates == (("is an equilibrium", 13),)


@pytest.mark.parametrize("torque", [[0.0, 0.0, 0.02], [0.001, 0.0, 0.02]])
def test_rates_whose_squares_are_no_doubles_are_answered_in_words(stabilab, case_file, torque):
    path = case_file(MOVING.replace("[0, 0, 0.02]",
                                  str(torque)).replace("[0.1, 0.05, 0.02]", "[1e160, 2e159, 1e158]"), "fast")
    code, out, err = stabilab("fate", path, "--tilt", "1 deg")
    assert code == 0 and "not looked at with rates whose squares are no doubles" in out
    assert "Warning" not in err
    code, out, _ = stabilab("when", path, "--rate", "3e160 rad/s")
    assert code == 0 and ("NEVER reaches" in out or "proved not to be reached" in out)


@pytest.mark.slow
def test_runs_that_end_before_the_untilted_time_do_not_read_as_if_a_tilt_helped(monkeypatch):
    """The time of the torque itself by DOP853 from Euler's equations."""
    monkeypatch.setattr("stabilab.answers.tilt.AZIMUTH_STEPS", 40)
    inertia, torque = np.array([2.0, 3.0, 1.0]), np.array([0.0, 0.0, 0.02])
    start, limit = np.array([0.3, 0.06, 1.0]), 4
    scene = package.Scene(package.Body(inertia.tolist()), package.ConstantTorque(torque.tolist()))
    found = spread(scene, start, cone_of(scene, angle=math.radians(0.5)), {"rate": limit})

    def there(t, w):
        return w @ w - limit**2
    there.terminal = True
    run = solve_ivp(euler(inertia, torque=torque), (0, 1000), start,
                    method="DOP853", rtol=1e-10, atol=1e-12, events=there)
    assert found.earliest is None and found.followed < run.t[-1]
    assert found.untilted[0] <= run.t[-1] * (1 + 1e-8) and run.t[-1] * (1 - 1e-8) <= found.untilted[1]
    assert "may reach 4 rad/s earlier or later: runs end after" in str(found.reason)
    assert f"untilted it is there after {sum(found.untilted) / 2:.6g} s" in str(found.reason)
    monkeypatch.setattr("stabilab.answers.tilt.AZIMUTH_STEPS", 4000)
    through = spread(scene, start, cone_of(scene, angle=math.radians(0.5)), {"rate": limit})
    assert through.untilted is None and through.earliest[0] < run.t[-1] < through.latest[1]
