"""Faults that a search from outside found, each with the smallest case that showed it."""
from fractions import Fraction as F

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Fate, Gyrostat, Scene
from stabilab.numbers.balls import Digits
from stabilab.unreduced.growth import captured_fate
from stabilab.orbit.fate.free_margin import free_margin
from stabilab.equilibrium.curve_text import decimal
from stabilab.physics.effects.resistance import Resistance
from stabilab.errors import InputError


def test_real_roots_stand_in_order_where_some_are_multiple():
    product = np.polynomial.polynomial.polyfromroots([1, 2, 2, 3])  # oracle: the roots it is made from
    assert [(float(root.mid()), many) for root, many in Digits.real_roots(product.tolist())] == [(1, 1), (2, 2), (3, 1)]


def test_a_momentum_sphere_that_touches_its_fold_has_a_margin():
    D, lam, w = (3, 5, 6), (F(8, 3), F(-1), F(1, 3)), (F(5, 3), F(-3, 2), F(1, 3))
    squared, energy = float(sum((d * v + m) ** 2 for d, v, m in zip(D, w, lam))), float(sum(d * v * v for d, v in zip(D, w)) / 2)
    energies, D, lam = [], np.array(D, float), np.array(lam, float)
    speeds = np.linspace(-40.0, 60.0, 2_000_001)  # oracle: sign changes of |H|^2 - h^2 on a grid, and the Hessian of T on the sphere
    speeds = speeds[np.abs(speeds[:, None] - D).min(axis=1) > 1e-3]

    def excess(s):
        return (s[..., None] ** 2 * lam**2 / (s[..., None] - D) ** 2).sum(axis=-1) - squared
    values = excess(speeds)
    for n in np.nonzero(values[:-1] * values[1:] < 0)[0]:
        low, high = speeds[n], speeds[n + 1]
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if excess(middle) * excess(low) > 0 else (low, middle)
        bend, H = 1 / D - 1 / low, low * lam / (low - D)
        if sum(H[i] ** 2 * bend[i - 1] * bend[i - 2] for i in range(3)) < 0:
            energies.append((D * (lam / (low - D)) ** 2).sum() / 2)
    nearest = min((e - energy for e in energies), key=abs)
    assert float(free_margin(Scene(Body((3, 5, 6)), Gyrostat((F(8, 3), -1, F(1, 3)))), w)) == pytest.approx(nearest, rel=1e-9)


@pytest.mark.parametrize("unit", [2.0**-40, 2.0**-330, 2.0**330])
def test_a_free_gyrostat_of_any_pace_returns(unit):
    """Law: with moment and rates times u the motion is the same in a time 1/u as long; u a power of two rounds nothing."""
    def asked(u):
        scene, state = Scene(Body((3, 2, 1.5)), Gyrostat((0.3 * u, -0.4 * u, u))), [0.3 * u, 2 * u, -u]
        return float(stabilab.period(scene, state)) * u, stabilab.extremes(scene, state) / u
    (period, extremes), (expected, wanted) = asked(unit), asked(1.0)
    assert period == pytest.approx(expected, rel=1e-13)
    assert np.abs(extremes - wanted).max() < 1e-13


def test_a_discriminant_beyond_the_doubles_is_still_told():
    u = F(10) ** 60
    scene = Scene(Body((4, 2, 3)), Gyrostat((-u * 3 / 10, 4 * u, 2 * u)), ConstantTorque((-u * u, 2 * u * u, -4 * u * u)))
    assert stabilab.equilibria(scene).kind == "none"  # law: as for u = 1
    assert decimal(F(10) ** 400 * F(-2, 3)) == "-6.66667e+399" and decimal(F(10) ** -400 / 7) == "1.42857e-401"


@pytest.mark.parametrize("mass", [1.0, 1e-140, 1e-160, 1e150])
def test_the_laws_of_a_very_light_or_heavy_body_hold_in_its_run(mass):
    """A unit of mass changes no motion, so no drift."""
    scene = Scene(Body((3 * mass, 2 * mass, 1.5 * mass)), Gyrostat((mass, 2 * mass, -3 * mass)), ConstantTorque((mass, 0, 0)))
    assert max(stabilab.trajectory(scene, (0.1, 0.2, 0.3), [0, 1, 5]).invariant_drift.values()) < 1e-14


@pytest.mark.parametrize("torque", [(0, 0, 0), (1e160, 0, 0), (1e160, 0, 1e160)])
def test_moments_whose_squares_are_beyond_the_doubles_are_refused(torque):
    scene = Scene(Body((3e160, 2e160, 1.5e160)), Gyrostat((1e160, 2e160, -3e160)), ConstantTorque(torque))
    with pytest.raises(InputError, match="choose other units"):
        stabilab.motion(scene, (0.1, 0.2, 0.3), (0, 5))


def test_a_temporary_capture_whose_swing_dies_out_is_no_spin_up():
    """Oracle: without the 1e-14 across the torque the spin-up about axis 1 is proved, after a release at t = 14,619 s."""
    scene = Scene(Body((2, 1, 1.5)), Gyrostat((F(4862117930819083, 2**58), 1e-14, 0)), ConstantTorque((F(6340252040850999, 2**50), 0, 0)))
    found = captured_fate(scene, (-0.029033100610280364, 52.89864997290313, -0.0026971012632171962), t_max=7000)
    assert found.axis in (0, 1) and found.fate in (Fate.UNDECIDED, Fate.SPIN_UP)


@pytest.mark.parametrize("unit", [2.0**-40, 2.0**-130, 2.0**40])
def test_a_resisted_body_of_any_pace_keeps_its_digits(unit):
    """Law: with moment, rates and resistance times u the motion is the same in a time 1/u as long; u a power of two rounds nothing."""
    def asked(u):
        scene = Scene(Body((3, 2, 1.5)), Gyrostat((0, 0.1 * u, 0)), Resistance(0.3 * u))
        return np.array(stabilab.motion(scene, (0.3 * u, 2 * u, -u), (0, 5 / u)).extremes) / u
    assert np.abs(asked(unit) - asked(1.0)).max() < 1e-14
