"""Limits of approximate laws along a gyrostat's motion, by power series in floats: against closed forms, and
against the compiled Taylor series' dense run."""
import math

import numpy as np
import pytest

import stabilab
from stabilab.integrate import limits_along
from stabilab.physics.body import Body
from stabilab.physics.effects.charge import Charge
from stabilab.physics.effects.constant_torque import ConstantTorque
from stabilab.physics.effects.gyrostat import Gyrostat
from stabilab.physics.effects.resistance import Resistance
from stabilab.physics.scene import Scene

CHARGE = Charge("0.1", 1, 1, "0.4")
BALL = Scene(Body((2, 2, 2)), CHARGE)


def by_heyoka(scene, omega, gamma, times):
    """The largest |gamma3/cos sigma - 1| at dense times of a run that carries the quaternion, not the
    direction: another state, another code."""
    axis = np.cross(gamma, (0, 0, 1))  # turns gamma to e3: body to space
    angle = math.atan2(np.linalg.norm(axis), gamma[2])
    unit = axis / (np.linalg.norm(axis) or 1.0)
    q = (math.cos(angle / 2), *(math.sin(angle / 2) * unit))
    run = stabilab.trajectory(scene, {"omega": omega, "attitude": q}, times)
    a, b, c, d = run.block("attitude").T
    return np.abs((a * a - b * b - c * c + d * d) / math.cos(0.4) - 1).max()


def test_uniform_turn_across_the_field_goes_from_one_pole_to_the_other():
    # the wheel outweighs the charge to 1e-17: gamma3 = cos(t)
    scene = Scene(Body((2, 2, 2)), CHARGE, Gyrostat((0, 0, 0.1 * math.cos(0.4))))
    for span, least in (((0, 1), math.cos(1)), ((-2, 1), math.cos(2)), ((0, 9.5), -1.0)):
        found = limits_along.law_along(scene, (1, 0, 0), (0, 0, 1), span)
        # a step is 1.85 rad long; the golden section ends within 7e-5 of a third of it, where the cosine is
        # 1e-9 off its peak at most
        assert found.value == pytest.approx(abs(least / math.cos(0.4) - 1),
                                            rel=1e-11 if least > -1 else 1e-9) and not found.holds


@pytest.mark.one_in(3)
@pytest.mark.parametrize("seed", range(8))
def test_largest_departure_is_that_of_the_compiled_series(seed):
    rng = np.random.default_rng(seed)
    D = np.sort(rng.uniform(2, 3, 3))[::-1]
    scene = Scene(Body(D), CHARGE, Gyrostat(rng.normal(size=3)), ConstantTorque(0.3 * rng.normal(size=3)))
    omega, gamma = rng.normal(size=3), rng.normal(size=3)
    gamma /= np.linalg.norm(gamma)
    span = (0.0, 6.0) if seed % 2 else (-4.0, 3.0)
    found = limits_along.law_along(scene, omega, gamma, span)
    times = np.linspace(*span, 40001)
    # places 1.5e-4 s apart miss a peak by (omega dt)^2/8 at most, here below 1e-6
    assert found.value == pytest.approx(by_heyoka(scene, omega, gamma, times), abs=1e-6)


def test_what_is_no_gyrostat_or_too_long_is_left_to_another_way():
    assert limits_along.law_along(Scene(Body((4, 3, 2)), CHARGE, Resistance("0.1")), (1, 0, 0), (0, 0, 1),
                                  (0, 1)) is None
    assert limits_along.law_along(BALL, (1e6, 0, 0), (0, 0, 1), (0, 1e6)) is None
    # its powers are beyond doubles
    assert limits_along.law_along(BALL, (1e200, 0, 0), (0, 0, 1), (0, 1)) is None
    torqued = Scene(Body((4, 3, 2)), CHARGE, ConstantTorque((1e150, 0, 0)))
    assert limits_along.law_along(torqued, (1, 0, 0), (0, 0, 1), (0, 1e300)) is None


def test_rest_stays_where_it_is():
    found = limits_along.law_along(BALL, (0, 0, 0), (0, 0, 1), (0, 100))
    assert found.value == pytest.approx(1 / math.cos(0.4) - 1, rel=1e-14) and found.holds
