"""The motion that follows a hand, beside the Taylor series of heyoka, which shares no code with it."""
import numpy as np
import pytest

from stabilab import load, trajectory
from stabilab.integrate.quadratic_series import INSIDE, STEPS, followed


@pytest.mark.parametrize("name, until", [("minor-axis-100", 9.0), ("thruster-stuck-major-axis", 120.0),
                                         ("off-axis-two", 20.0), ("torque-free-gyrostat", 60.0)])
def test_a_drawn_motion_is_the_motion(name, until):
    case = load(f"cases/{name}.toml")
    times, states = followed(case.scene.quadratic(), case.state, until, steps=400)
    exact = trajectory(case.scene, case.state, times[1:], laws=False).states
    assert times[-1] == until and np.abs(np.array(states)[1:] - exact).max() < 1e-5 * np.abs(exact).max()


def test_a_drawn_motion_ends_after_so_many_steps():
    case = load("cases/torque-free-gyrostat.toml")
    times, states = followed(case.scene.quadratic(), case.state, 1e9)
    assert times[-1] < 1e9 and len(times) == len(states) == 1 + INSIDE * STEPS


def test_a_body_at_rest_stays_and_a_torque_sets_it_going():
    still = load("cases/torque-free-body.toml").scene.quadratic()
    assert followed(still, (0.0, 0.0, 0.0), 5.0)[1][-1] == (0.0, 0.0, 0.0)
    # D1 = 12, M1 = 0.02: the first step of omega1 is M1 t/D1
    case = load("cases/thruster-stuck-major-axis.toml")
    times, states = followed(case.scene.quadratic(), (0.0, 0.0, 0.0), 1e-3)
    assert states[-1][0] == pytest.approx(0.02 / 12 * 1e-3, rel=1e-6)
