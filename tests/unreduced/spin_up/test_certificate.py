"""The inequality: what it says of one state holds for ever, for every state of a ball, in spite of rounding."""
import random

import mpmath
import numpy as np
import pytest

from stabilab.unreduced.spin_up.certificate import Certifier
from stabilab.unreduced.spin_up.elimination import corrected_amplitude, corrected_energy
from stabilab.unreduced.spin_up.fixed_centre import FixedCentre
from stabilab.unreduced.spin_up.form import forms_of
from stabilab.unreduced.spin_up.moving_centre import moving_centre

from .scenes import EXAMPLE, random_scene, rates_of, run, sphere
from .test_elimination import Digits

STATE = np.array([[6.0, 1.0, -1.0]])


def test_worked_example_is_trapped_within_the_printed_constants():
    form = forms_of(EXAMPLE)[0]
    found = Certifier(FixedCentre(form), (0, 2))(STATE)
    assert found.good[0]
    assert found.A[0] < 1.193 and found.z[0] > 6.276 and found.eta[0] > 0.468  # printed for the simplified sums: ours are sharper
    times = np.linspace(0, 20, 801)
    states = run(rates_of(EXAMPLE), STATE[0], times)
    X, zeta, *_ = FixedCentre(form).place(states)
    assert np.abs(zeta).max() < found.A[0]  # DOP853
    assert (X >= found.z[0] + found.eta[0] * times / form.D1).all() and (X <= found.z_up[0] + found.eta_up[0] * times / form.D1).all()


@pytest.mark.one_in(2)
@pytest.mark.parametrize("of", ["fixed centre", "moving centre"])
def test_certified_states_of_random_scenes_stay_between_the_lines(of):
    rng, seen = random.Random(7), 0
    for _ in range(60):
        scene = random_scene(rng)
        for form in forms_of(scene):
            field = FixedCentre(form) if of == "fixed centre" else moving_centre(form, scene)
            state = np.array(sphere(rng, 2))
            state[form.axis] = form.sense * rng.choice((3, 6, 12))
            found = Certifier(field, (2, 4))(state[None])
            if not found.good[0] or seen >= 20:
                continue
            seen += 1
            times = np.linspace(0, 5, 201)
            x, zeta, *_ = field.place(run(rates_of(scene), state, times))
            assert np.abs(zeta).max() < found.A[0]  # DOP853, another integrator than the package's own runs
            assert (x > found.z[0] + found.eta[0] * times / field.D1).all() and (x < found.z_up[0] + found.eta_up[0] * times / field.D1).all()
    assert seen > 10


def test_a_ball_is_certified_only_if_every_state_in_it_is():
    test = Certifier(FixedCentre(forms_of(EXAMPLE)[0]), (4, 6))
    generator = np.random.default_rng(1)
    for near in (1e-3, 1e-1, 1.0):
        ball = test(STATE, np.array([near]))
        inside = STATE + near * (lambda v: v / np.linalg.norm(v, axis=1, keepdims=True))(generator.normal(size=(200, 3)))
        if ball.good[0]:
            assert test(inside).good.all()
            assert (test(inside).z >= ball.z * 0.999).all()
    assert test(STATE, np.array([1e-3])).good[0] and not test(STATE, np.array([10.0])).good[0]


def test_values_at_the_start_lie_within_their_blur():
    """Energy and amplitude of a state in doubles against the same in 40 digits."""
    scene = random_scene(random.Random(8), 1)
    form = forms_of(scene)[0]
    test = Certifier(FixedCentre(form), (12, 14))
    fine = forms_of(scene, Digits)[0]
    state = np.zeros(3)
    state[form.axis], state[form.order[1]] = form.sense * 9.7, 0.7
    from stabilab.unreduced.spin_up.certificate import _Start
    x, zeta, dx, dz = test.field.place(state[None])
    start = _Start(test, x, zeta, dx, dz)
    with mpmath.workdps(40):
        X, z = fine.place([mpmath.mpf(v) for v in state.tolist()])
        value = lambda terms: mpmath.re(sum(c * z**j * mpmath.conj(z)**k * X**(-mpmath.mpf(a) / 4) for (j, k, a, b), c in terms.as_dict().items()))
        energy = value(corrected_energy(fine, 12).added)
        amplitude = abs(z)**2 * (1 + fine.drag / fine.M1 / X) + value(corrected_amplitude(fine, 14).added)
        assert start.energy[0] <= energy <= start.energy_up[0] and amplitude <= start.amplitude[0]
        assert start.x[0] <= X and abs(z) <= start.size[0]


def test_spin_against_the_torque_is_never_certified():
    rng = random.Random(9)
    for _ in range(20):
        scene = random_scene(rng)
        for form in forms_of(scene):
            state = np.zeros((1, 3))
            state[0, form.axis] = -form.sense * 30
            assert not Certifier(FixedCentre(form), (4, 6))(state).good[0]  # it slows down first: T' = M.w < 0


def test_higher_orders_hold_wherever_lower_ones_do_and_are_sharper():
    form = forms_of(EXAMPLE)[0]
    low, high = (Certifier(FixedCentre(form), orders)(STATE) for orders in ((0, 2), (12, 14)))
    assert high.good[0] and high.A[0] < low.A[0] and high.z[0] > low.z[0] and high.eta[0] > low.eta[0]


def test_without_a_wheel_the_first_order_laws_of_the_scaled_body_agree():
    """V = (x2^2 + x3^2)/2 + (mu3 x2 - mu2 x3)/p and W = (p^2 + x2^2)/2 - mu2 x3/p: their rates are known in closed form, and they
    stay next to a start that is certified about x1."""
    from stabilab import ScaledGyrostat
    mu = (0.5, 0.3, -0.4)
    scene = ScaledGyrostat(0, 0, mu)
    state = np.array([12.0, 0.5, -0.3])
    found = Certifier(FixedCentre(forms_of(scene)[0]), (0, 2))(state[None])
    assert found.good[0]
    rate = lambda x: [x[1] * x[2] + mu[0], -x[2] * x[0] + mu[1], x[1] * x[0] + mu[2]]
    p, x2, x3 = run(rate, state, np.linspace(0, 40, 2001)).T
    V = (x2**2 + x3**2) / 2 + (mu[2] * x2 - mu[1] * x3) / p
    change = np.abs((mu[2] * x2 - mu[1] * x3) * (x2 * x3 + mu[0]) / p**2).max() * 40  # V' = -(...)(x2 x3 + mu1)/p^2
    assert np.abs(V - V[0]).max() <= change and (V < found.A[0]**2 / 2 + 0.5 * found.A[0] / p).all()
    W = (p**2 + x2**2) / 2 - mu[1] * x3 / p
    assert (np.diff(W) > 0).all() and (p > found.z[0]).all()  # W' = mu1 p - mu2 mu3/p + ... > 0
