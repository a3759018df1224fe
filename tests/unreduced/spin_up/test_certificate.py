"""The inequality: what it says of one state holds for ever, for every state of a ball, in spite of rounding.
"""
import random

import mpmath
import numpy as np
import pytest

from stabilab.unreduced.spin_up import moving_kernel
from stabilab.unreduced.spin_up.centres import FixedCentre, moving_centre
from stabilab.unreduced.spin_up.certificate import Certifier
from stabilab.unreduced.spin_up.form import forms_of

from .scenes import EXAMPLE, random_scene, rates_of, run, sphere
from .test_elimination import in_digits

STATE = np.array([6.0, 1.0, -1.0])


def places(field, states):
    """(x, zeta), (n,) each, of states (n, 3): as the docstring of `centres` has them."""
    w = np.asarray(states) @ field.basis.T
    if field.sharp:
        return w[:, 0] + field.form.shift, np.array([field.form.place(state)[1] for state in states])
    x, (l2, l3), (M2, M3), (r2, r3) = w[:, 0], field.wheel, field.torque, field.roots
    p, q = field.a3 * x + field.c, field.a2 * x + field.c
    rho = (q / p)**0.25
    u, v = w[:, 1] - field.s * (l2 * x - M3) / q, w[:, 2] - field.s * (l3 * x + M2) / p
    return x, r2 * rho * u + 1j * field.s * r3 / rho * v


def test_worked_example_is_trapped_within_the_printed_constants():
    field = FixedCentre(forms_of(EXAMPLE)[0])
    A, z, eta, z_up, eta_up, _ = Certifier(field, (0, 2)).constants(STATE)
    assert A < 1.193 and z > 6.276 and eta > 0.468  # printed for the simplified sums: ours are sharper
    times = np.linspace(0, 20, 801)
    X, zeta = places(field, run(rates_of(EXAMPLE), STATE, times))
    assert np.abs(zeta).max() < A  # DOP853
    assert (X >= z + eta * times / field.D1).all() and (X <= z_up + eta_up * times / field.D1).all()


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
            found = Certifier(field, (2, 4)).constants(state)
            if found is None or seen >= 20:
                continue
            seen += 1
            (A, z, eta, z_up, eta_up, _), times = found, np.linspace(0, 5, 201)
            x, zeta = places(field, run(rates_of(scene), state, times))
            assert np.abs(zeta).max() < A  # DOP853, another integrator than the package's own runs
            assert (x > z + eta * times / field.D1).all() and (x < z_up + eta_up * times / field.D1).all()
    assert seen > 10


def test_a_ball_is_certified_only_if_every_state_in_it_is():
    test = Certifier(FixedCentre(forms_of(EXAMPLE)[0]), (4, 6))
    generator = np.random.default_rng(1)
    for near in (1e-3, 1e-1, 1.0):
        ball = test.constants(STATE, near)
        ways = generator.normal(size=(100, 3))
        inside = STATE + near * ways / np.linalg.norm(ways, axis=1, keepdims=True)
        if ball:
            assert all(test.constants(state)[1] >= ball[1] * 0.999 for state in inside)
    assert test.constants(STATE, 1e-3) and not test.constants(STATE, 10.0)


def test_values_at_the_start_lie_within_their_blur():
    """Energy and amplitude of a state in doubles against the same in 60 digits."""
    scene, orders = random_scene(random.Random(8), 1), (12, 14)
    rough = forms_of(scene)[0]
    test = Certifier(FixedCentre(rough), orders)
    state = np.zeros(3)
    state[rough.axis], state[rough.order[1]] = rough.sense * 9.7, 0.7
    (x, zeta), dx, form = rough.place(state.tolist()), 2.0**-46, test.numbers[0]
    rows, powers = np.ones((4, 2 * moving_kernel.MIDDLE + 1)), np.zeros(test.degrees, complex)
    with mpmath.workdps(60):
        *quantities, place = in_digits(rough, scene, orders)
        X, z = place(state.tolist())
        for quantity, (exact, _) in zip(test.numbers[1:3], quantities):
            middle, blur = moving_kernel.blurred(quantity, zeta, abs(zeta) + dx, x, x - dx, dx, form, rows,
                                                 powers, np.zeros(test.columns))
            true = sum(c * z**j * z.conjugate()**k / X**n for (j, k, n), c in exact.items())
            assert abs(mpmath.re(true) - middle) <= blur < 1e-6


def test_spin_against_the_torque_is_never_certified():
    rng = random.Random(9)
    for _ in range(20):
        scene = random_scene(rng)
        for form in forms_of(scene):
            state = np.zeros(3)
            state[form.axis] = -form.sense * 30
            test = Certifier(FixedCentre(form), (4, 6))
            assert not test.constants(state)  # it slows down first: T' = M.w < 0


def test_higher_orders_hold_wherever_lower_ones_do_and_are_sharper():
    form = forms_of(EXAMPLE)[0]
    low, high = (Certifier(FixedCentre(form), orders).constants(STATE) for orders in ((0, 2), (12, 14)))
    assert high[0] < low[0] and high[1] > low[1] and high[2] > low[2]
