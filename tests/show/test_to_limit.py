"""The time to a limit against the tilt of a torque and the momentum of a wheel, and the body as a sketch."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab
from stabilab import errors
from stabilab.answers.tilt import by_angle
from stabilab.answers.when import limit_of
from stabilab.show.plot import over_time
from tests.oracles.rigid import euler
from tests.shared import case as load


def first_at(case, torque, limit):
    """s, by SciPy's DOP853 on Euler's equations written out here."""
    D, wheel = (np.array([float(v) for v in row])
                for row in (case.scene.body.exact, case.scene.vector("gyrostat")))
    over = lambda t, w: np.linalg.norm(w) - limit
    over.terminal = True
    run = solve_ivp(euler(D, wheel, torque), (0, 500), case.state, "DOP853",
                    rtol=1e-10, atol=1e-13, events=over, max_step=1.0)
    return run.t_events[0][0]


def test_the_earliest_and_the_latest_time_under_a_tilted_force_are_those_of_its_six_directions():
    """cubesat-3u: the force of its thruster, and the ends of its tolerance of 5 %, turned by 2 deg about six
    directions, the arm as the case has it."""
    case, angle = load("cubesat-3u"), np.radians(2.0)
    (thruster,) = case.thrusters
    axes = np.array([[float(v) for v in row] for row in case.frame.axes])
    force, arm = (np.array([float(v) for v in row]) for row in (thruster.direction, thruster.arm))
    first = np.cross(np.eye(3)[np.argmin(np.abs(force))], force)
    first /= np.linalg.norm(first)
    times = []
    for turn in np.arange(6) * np.pi / 3:
        aside = np.cos(turn) * first + np.sin(turn) * np.cross(force, first)
        tilted = float(thruster.force) * (np.cos(angle) * force + np.sin(angle) * aside)
        times += [first_at(case, size * (axes @ np.cross(arm, tilted)), np.radians(60))
                  for size in (0.95, 1.0, 1.05)]
    found = by_angle(case.scene, case.state, np.array([angle]), case, limit_of(case))
    assert found.earliest[0] == pytest.approx(min(times), rel=1e-5)
    assert found.latest[0] == pytest.approx(max(times), rel=1e-5)


def test_a_bounded_motion_is_lost_after_a_time_like_one_over_the_tilt_and_not_before_what_is_proved():
    """The drift of the integrals is of first order in the tilt (docstring of answers.tilt): a tenth of it
    takes ten times as long."""
    case = load("thruster-stuck-major-axis")
    found = by_angle(case.scene, case.state, np.radians([0.3, 3.0]))
    assert found.earliest[0] / found.earliest[1] == pytest.approx(10, rel=0.1)
    assert (0 < found.not_before).all() and (found.not_before < found.earliest).all()


def test_more_angles_are_looked_at_where_the_times_bend():
    """Of times like one over the tilt (as above) the middles alone; cubesat-3u: at 10 deg the latest grows
    without end, so most angles are there. Every interval follows its ends to 2 %."""
    angles = np.radians(np.geomspace(0.1, 10, 4))
    straight, bent = (by_angle(case.scene, case.state, angles, case, case.limits and limit_of(case), closer=True)
                      for case in map(load, ("thruster-stuck-major-axis", "cubesat-3u")))
    assert len(straight.angles) < 11 <= len(bent.angles) < 26 and set(angles) <= set(bent.angles)
    assert np.median(bent.angles) > np.radians(1.0) and (np.diff(bent.angles) > 0).all()


@pytest.mark.slow
def test_the_best_momentum_of_a_wheel_is_that_of_stuck_and_now_is_no_gain():
    case = load("cubesat-3u")
    ax = stabilab.plot.wheel(case)
    (answer,) = stabilab.stuck(case).rows[0].wheels
    momenta, gain = ax.get_lines()[0].get_data()
    assert momenta[np.nanargmax(gain)] == answer.best and np.nanmax(gain) == pytest.approx(answer.gain)
    # a run with the momentum of the case, by SciPy
    now = first_at(case, np.array([float(v) for v in case.scene.vector("constant_torque")]), np.radians(60))
    assert f"now: {now:.4g} s" in [text.get_text() for text in ax.figure.legends[0].get_texts()]


@pytest.mark.parametrize("kind, name, words", [
    ("tilt", "phone", "no constant torque acts"), ("tilt", "off-axis-two", "states no limit"),
    ("tilt", "minor-axis-100", "a body with wheels"), ("wheel", "two-wheels-minor-axis", "the case has no wheel"),
    ("wheel", "top-fast", "a body with wheels")])
def test_a_plot_that_a_case_does_not_have_is_refused_with_the_reason(kind, name, words):
    with pytest.raises(errors.InputError, match=words):
        getattr(stabilab.plot, kind)(load(name))


def test_scaled_variables_alone_have_no_body():
    with pytest.raises(errors.InputError, match="scaled variables have no body"):
        stabilab.plot.body(stabilab.ScaledGyrostat(0.5, 1, (0, 1, 0)), (1, 2, 3))


def test_the_body_has_its_thrusters_at_their_arms_and_the_axes_of_its_file():
    """geostationary-22n: arms (0.938, 0.888, -1.26) m and (-0.962, 0.888, -1.26) m from the centre of mass,
    by hand; both as far out as the picture goes or nearer, in the directions of the arms."""
    case = load("geostationary-22n")
    ax = stabilab.plot.body(case)
    places = [np.ravel(line.get_data_3d()) for line in ax.get_lines() if line.get_marker() == "o"]
    turn = np.array([[float(v) for v in row] for row in case.frame.axes])
    for place, arm in zip(places, ((0.938, 0.888, -1.26), (-0.962, 0.888, -1.26)), strict=True):
        along = turn @ np.array(arm)
        assert place @ along == pytest.approx(np.linalg.norm(place) * np.linalg.norm(arm))
    assert {"x", "y", "z", "1, major", "3, minor"} <= {text.get_text().strip() for text in ax.texts}
    names = [text.get_text() for text in ax.figure.legends[0].get_texts()]
    assert "force of R3 on the body, 22 N, stuck" in names and "axes of the file" in names


def test_where_the_line_of_a_tilt_begins_is_marked(monkeypatch):
    """By made times: of four tilts the first two reach nothing within the steps of their runs."""
    case = load("thruster-stuck-major-axis")
    exact = over_time.by_angle

    def short(*given, **named):
        found = exact(*given, **named)
        none = np.arange(len(found.angles)) < 2
        return replace(found, earliest=np.where(none, np.inf, found.earliest))
    monkeypatch.setattr(over_time, "by_angle", short)
    monkeypatch.setattr(over_time, "ANGLES", np.radians([1.0, 2.0, 5.0, 10.0]))
    ax = stabilab.plot.tilt(case)
    line, upright, marks = ax.lines[:3]
    assert len(marks.get_xdata()) == 2 and max(marks.get_xdata()) < line.get_xdata()[0]
    assert list(upright.get_xdata()) == [line.get_xdata()[0]] * 2
    assert "assumed" in ax.get_ylabel()
