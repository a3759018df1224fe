"""The inequality: what it says of one state holds for ever, for every state of a ball, in spite of rounding.
"""
import random

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.unreduced.spin_up import certificate, elimination
from stabilab.unreduced.spin_up.centres import FixedCentre, moving_centre
from stabilab.unreduced.spin_up.certificate import Certifier
from stabilab.unreduced.spin_up.form import forms_of

from .scenes import EXAMPLE, random_scene, rates_of, run, sphere

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


def tables(scene):
    """Each number of the tables of a scene's fields, in bytes."""
    form = forms_of(scene)[0]
    fields = FixedCentre(form), moving_centre(form, scene)
    return [np.asarray(item).tobytes() for field in fields for item in Certifier(field, (4, 6)).numbers]


def test_a_second_scene_works_out_no_exponents_and_forgetting_them_changes_no_number(monkeypatch):
    first, second = (random_scene(random.Random(n), 1.0) for n in (3, 4))
    tables(first)
    count = len(elimination._WORKED_OUT)
    numbers = tables(second)
    assert len(elimination._WORKED_OUT) == count and numbers != tables(first)
    monkeypatch.setattr(elimination, "_WORKED_OUT", {})
    monkeypatch.setattr(elimination, "MAX_BYTES", 100_000)  # forgotten again and again
    assert tables(second) == numbers and 0 < len(elimination._WORKED_OUT) < count


def test_tables_are_of_one_type_also_where_they_hold_no_term():
    """A kernel is compiled once for each: without a wheel, the torque on an axis, an amplitude has no terms."""
    body, torques = Body((12, 9, 5)), (ConstantTorque((0, 0, "0.02")), ConstantTorque(("0.3", "0.5", "0.4")))
    scenes = [Scene(body, *wheel, torque) for wheel in ((), (Gyrostat((0, 0, "0.8")),)) for torque in torques]
    types = [[item.dtype for item in Certifier(field, (2, 4)).numbers if isinstance(item, np.ndarray)]
             for tests in map(certificate.tests_of, scenes) for field in tests.fixed + tests.moving]
    assert len(types) > 4 and all(item == types[0] for item in types)


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
