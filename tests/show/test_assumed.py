"""The limit that pictures are drawn to where a case states none."""
from __future__ import annotations

import math

import numpy as np
import pytest
from matplotlib import pyplot as plt
from scipy.integrate import solve_ivp

from stabilab import Body, ConstantTorque, Scene, load, plot
from stabilab.answers import tilt
from stabilab.show.assumed import TWICE, Assumed, assumed
from stabilab.show.explore.pictures import unframed
from stabilab.show.explore.session import Session
from stabilab.show.plot.subject import subject
from stabilab.show.plot.turning import turn
from stabilab.show.report.one_case import facts
from stabilab.show.units import units_of

SPINS_UP = load("cases/symmetric-spin-up.toml")


def test_a_spin_up_is_drawn_past_twice_its_first_rate():
    """By hand: |(0.3, 0.4, -1)| = sqrt(1.25); its time by DOP853 from Euler's equations."""
    item = subject(SPINS_UP)
    a, b, c = map(float, item.scene.body.inertia)
    torque = [float(v) for v in item.scene.vector("constant_torque")]

    def rates(t, w):
        return ((b - c) * w[1] * w[2] + torque[0]) / a, ((c - a) * w[2] * w[0] + torque[1]) / b, (
            (a - b) * w[0] * w[1] + torque[2]) / c

    def reached(t, w):
        return math.hypot(*w) - 2 * math.sqrt(1.25)
    run = solve_ivp(rates, (0, 200), item.state, "DOP853", rtol=1e-10, atol=1e-12, events=reached)
    assert item.assumed.rate == pytest.approx(2 * math.sqrt(1.25), rel=1e-12)
    assert item.assumed.time == pytest.approx(run.t_events[0][0], rel=1e-7)
    assert item.seen[1] == pytest.approx(1.25 * item.assumed.time) and SPINS_UP.span[1] < item.assumed.time


def test_of_a_bounded_motion_it_is_that_of_a_tilt():
    case = load("cases/thruster-stuck-major-axis.toml")
    item = subject(case)
    assert TWICE == tilt.TWICE
    assert item.assumed == Assumed(pytest.approx(tilt.tilt(case.scene, case.state, 0.01).limit, rel=1e-12))


def test_a_stated_limit_is_no_assumed_one_and_rest_takes_the_torque():
    """By hand: 0.06 N m on moments of mean 6 kg m^2 gives sqrt(0.01) rad/s in its own time; twice that."""
    assert subject(load("cases/cubesat-3u.toml")).assumed is None
    scene = Scene(Body((8, 6, 4)), ConstantTorque((0, 0, 0.06)))
    assert assumed(None, scene, (0.0, 0.0, 0.0), None).rate == pytest.approx(0.2, rel=1e-12)
    assert assumed(None, scene, (0.0, 3.0, 4.0), None) == Assumed(10.0)
    assert assumed(None, Scene(Body((8, 6, 4))), (0.0, 0.0, 0.0), None) is None


def test_every_view_of_a_spin_up_says_that_it_is_assumed():
    """128.1 deg/s is twice sqrt(1.25) rad/s, reached after 95.38 s (as above)."""
    item = subject(SPINS_UP)
    for draw in (plot.time, plot.space):
        names = [text.get_text() for text in draw(SPINS_UP).figure.legends[0].get_texts()]
        assert any(name.startswith("assumed limit") and name.endswith("128.1 deg/s") for name in names), names
    plt.close("all")
    answer, _ = unframed(Session(SPINS_UP).answer({}))
    assert answer["time"]["assumed"] and answer["time"]["limits"] == [pytest.approx(128.1, abs=0.05)]
    assert answer["time"]["reached"] == pytest.approx(95.38, abs=0.005) and answer["film"]["assumed"]
    assert any(text.startswith("assumed limit of |ω|, 128.1 deg/s") for text, _ in answer["space"]["legend"])
    row = "none in the file; pictures assume 128.1 deg/s, twice the rate at the start, reached after 95.38 s (by a run)"
    assert ["limit", row.replace("95.38 s", "1.59 min")] in answer["rows"] or ["limit", row] in answer["rows"]
    assert dict(facts(item, item.motion, units_of(SPINS_UP)))["limit"] == dict(answer["rows"])["limit"]
    film = turn(item, 20, item.assumed)
    assert film.assumed and film.share == pytest.approx(
        np.linalg.norm(film.omega, axis=1) / (2 * math.sqrt(1.25)), rel=1e-12)


@pytest.mark.parametrize("span, reaches", [(None, True), (50, False)])
def test_a_film_reaches_the_assumed_limit_or_says_that_it_ends_before(span, reaches):
    """95.38 s as above; a span that is asked for is kept."""
    item = subject(SPINS_UP, span=span)
    film = turn(item, 40, item.assumed)
    text = film.part(units_of(SPINS_UP))
    assert (film.t[-1] > 95.38) == reaches and (film.later is None) == reaches
    assert ("It ends before what matters: assumed limit, 95.38 s." in text or "1.59 min." in text) == (not reaches)
    assert (film.moment is not None and film.moment[1] == "assumed limit") == reaches


def test_a_motion_not_known_to_spin_up_is_followed_to_the_limit_over_its_span():
    """The time by DOP853 from the equations of Galal et al., charged body, written here: twice the first rate,
    0.09 pi rad/s, is passed at 1.067 s and the picture marks it."""
    case = load("cases/charged-body-attitude.toml")
    a, b, c = case.scene.body.inertia
    wheel, torque, spin = 1.3, 4.0, 0.09 * math.pi
    k = 0.003 * 100 * 1.02**2  # N m s: charge, field, square of the arm; its torque is k cos(sigma) omega x e3

    def rates(t, y):
        w, up = y[:3], y[3:]
        h = np.array([a * w[0], b * w[1], c * w[2] + wheel])
        own = np.array([torque + k * up[2] * w[1], -k * up[2] * w[0], 0.0])
        return [*((np.cross(h, w) + own) / (a, b, c)), *np.cross(up, w)]

    def reached(t, y):
        return np.linalg.norm(y[:3]) - 2 * spin
    run = solve_ivp(rates, (0, 5), [0, 0, spin, 0, 0, 1], "DOP853", rtol=1e-10, atol=1e-12, events=reached)
    item = subject(case)
    assert item.assumed.time == pytest.approx(run.t_events[0][0], rel=1e-6)
    names = [text.get_text() for text in plot.time(item).figure.legends[0].get_texts()]
    plt.close("all")
    assert "reached after 1.067 s" in names, names
