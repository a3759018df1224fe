"""Tests of `theories/cavity.py`: amplitude and phase of a liquid's motion far below the rounding of
its spin."""
from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stabilab import Gyrostat, Scene
from stabilab.errors import InputError
from stabilab.papers.figures.catalogue import figure
from stabilab.papers.figures.figure import differences
from stabilab.theories.cavity import averaged, polar
from tests.shared import case
from tests.theories.cavity.test_averaged import body, rates_by_hand

# (phase in rad, amplitude in rad/s) at 20 s: the exact equations in p, q, r written by hand, as power series
# of order 36 in 60 digits
# (python-flint), 800 steps, the angle of (p, -q) counted step by step.
BY_SERIES = {"liquid-charge-1e4": (203.468960052804, 3.590956444e-212),
             "liquid-lambda3-25": (-52.3925824053315, 4.847391487e-21),
             "liquid-lambda3-15": (-31.0965670438834, 2.289684265e-9),
             "liquid-base": (0.455168759009056, 0.787228549)}


def uncharged(scene):
    """The scene with the charge's moment taken off the wheel, which turns alike: of what `rates_by_hand`
    knows."""
    wheel = scene.effect("gyrostat").moment[2] - scene.effect("charge").strength
    return Scene(scene.body, Gyrostat((0, 0, wheel)),
                 *(e for e in scene.effects if e.name not in ("gyrostat", "charge")))


@pytest.mark.parametrize("name", BY_SERIES)
def test_phase_and_amplitude_are_those_of_many_digits(name):
    one, (phase, amplitude) = case(name), BY_SERIES[name]
    found = polar(one.scene, one.state, [0.0, 20.0])
    assert found["phase"] == pytest.approx([0, phase], abs=2e-10)
    assert found["amplitude"] == pytest.approx([1, amplitude], rel=1e-9)


def test_the_whole_way_is_that_of_equations_by_hand():
    """Independent: log A, phi and r by `rates_by_hand`, with SciPy's LSODA."""
    one, times = case("liquid-lambda3-25"), np.linspace(0, 20, 41)
    rates = rates_by_hand(uncharged(one.scene))

    def slow(t, y):
        A, c, s = math.exp(y[0]), math.cos(y[1]), math.sin(y[1])
        p, q, r = rates(t, (A * c, -A * s, y[2]))
        return (p * c - q * s) / A, -(p * s + q * c) / A, r
    run = solve_ivp(slow, (0, 20), (0, 0, 1), "LSODA", t_eval=times, rtol=1e-12, atol=1e-12)
    found = polar(one.scene, one.state, times)
    assert np.abs(np.log(found["amplitude"])
                  - run.y[0]).max() < 1e-8 and np.abs(found["phase"] - run.y[1]).max() < 1e-8


def test_a_motion_without_a_phase_is_refused():
    with pytest.raises(InputError, match="off that axis"):
        polar(body(0.05, M=(0, 0, -6.0)), (0, 0, 1), [0.0, 1.0])
    with pytest.raises(InputError, match="no torque across axis 3"):
        polar(body(0.05), (1, 0, 1), [0.0, 1.0])


def test_figure_11_tells_the_printed_phase_from_the_true_one():
    """The printed phase at 20 s is 203.054 rad by (25), 0.415 off; lost in p and q, the angle of noise was
    54.6 off."""
    last = [d for d in differences(figure(11, "cavity")) if "varphi" in d.quantity][-1]
    assert last.column.startswith("$e=10000$") and 0.41 < last.largest < 0.44
    (phase, columns), (amplitude, _) = (figure(11, "cavity").lines()[n] for n in (2, 0))
    t, drawn = phase.pick(columns[2].runs["exact"])
    assert t[-1] == 20 and drawn[-1] == pytest.approx(203.46896, abs=1e-5) and (np.diff(drawn) > 0).all()
    assert amplitude.pick(columns[2].runs["exact"])[1][-1] == pytest.approx(3.590956e-212, rel=1e-6)


def test_the_averaged_amplitude_keeps_its_digits_below_the_rounding_of_the_spin():
    """Independent: the averaged equations of first order by hand, A'/A = kappa r nu/J0 - zeta, solved for log
    A by RK45."""
    one = case("liquid-lambda3-25")
    (_, _, D3), G = one.scene.body.inertia, 25 - one.scene.effect("charge").strength
    d = (9.51 + 9.3) / 2 - D3
    kappa, zeta, M = 1250 * 1.9 / 1000, 0.02, -0.06

    def slow(_, y):
        turn = (d * y[1] - G) / D3
        return kappa * y[1] * turn / D3 - zeta, -kappa * math.exp(2 * y[0]) * turn / D3 - zeta * y[1] + M / D3
    run = solve_ivp(slow, (0, 400), (0.0, 1.0), "RK45", rtol=1e-11, atol=1e-11)
    assert float(averaged(one.scene, one.state, [0.0, 400.0],
                          order=1).amplitude[-1]) == pytest.approx(math.exp(run.y[0, -1]), rel=1e-6)


def test_an_averaged_motion_that_outgrows_doubles_stops():
    """Backwards a resistance feeds the amplitude: e^2000 after 1e5 s at 0.02 1/s."""
    found = averaged(Scene(body(0.05, d=4.0).body,
                           *(e for e in body(0.05, M=(0, 0, 0)).effects if e.name == "resistance")),
                     (1, 0, 1), [0.0, -1e6])
    assert found.status == "stopped" and "run stopped at" in found.because and found.t.tolist() == [0.0]
