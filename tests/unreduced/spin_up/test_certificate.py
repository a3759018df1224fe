"""The inequality: what it says of one state holds for ever, for every state of a ball, in spite of rounding.
"""
import random

import numpy as np
import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.unreduced.spin_up import certificate
from stabilab.unreduced.spin_up.centres import FixedCentre, moving_centre
from stabilab.unreduced.spin_up.certificate import Certifier, equatorial
from stabilab.unreduced.spin_up.elimination import conjugate, product, total
from stabilab.unreduced.spin_up.form import forms_of

from .scenes import EXAMPLE, numba, random_scene, rates_of, run, sphere

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


def tables(scene, fast):
    """Each number of the tables of a scene's fields, in bytes."""
    form, round_ = forms_of(scene)[0], equatorial(scene)
    fields = [FixedCentre(form), moving_centre(form, scene)] + [round_] * bool(round_)
    return [np.asarray(item).tobytes() for field in fields
            for orders in ((0, 2), (4, 6), (6, 9)) for item in Certifier(field, orders, fast).numbers]


ROUND = Scene(Body((3, 2, 2)), Gyrostat((0.1, "1/2", 0)), ConstantTorque(("1/9", "-1/7", "1/5")))


@numba
@pytest.mark.parametrize("scene", [random_scene(random.Random(3), 1.0), random_scene(random.Random(4), 0.0), ROUND],
                         ids=["wheel", "no wheel", "equator"])
def test_tables_are_the_same_bytes_by_loops_and_by_numpy(scene):
    assert tables(scene, True) == tables(scene, False)


def sums_of(field, order, by):
    """{(j, k, a, b): (c, m)} of what is added to a quantity, and {(a, b): {degree: bound}} of what is left of
    its rate, by terms one by one in dicts: every product in turn, no grid and no half of a real sum."""
    algebra, quantity = field.algebra, getattr(field, by)
    lifted = -algebra.turn[0], -algebra.turn[1]
    half = {key: (c, m) for key, c, m in quantity.rate}
    rate = total(half, conjugate(half))
    added = {}
    while True:
        levels = {key: algebra.level(*key[2:]) for key in rate if key[0] != key[1]}
        lowest = min(levels.values(), default=np.inf)
        if lowest > 4 * order // algebra.unit:
            return added, rate
        taken = {key: rate.pop(key) for key, level in levels.items() if level == lowest}
        part = {(j, k, a + lifted[0], b + lifted[1]): (c * 1j * algebra.lift / (j - k), m * algebra.lift / abs(j - k))
                for (j, k, a, b), (c, m) in taken.items()}
        added |= part
        zeta = {(j - 1, k, a, b): (c * j, m * j) for (j, k, a, b), (c, m) in part.items() if j}
        other = {(j, k - 1, a, b): (c * k, m * k) for (j, k, a, b), (c, m) in part.items() if k}
        along = total(product(zeta, algebra.carried), product(other, conjugate(algebra.carried)), algebra.slope(part))
        rate = total(rate, product(along, algebra.x_rate), product(zeta, algebra.drift),
                     product(other, conjugate(algebra.drift)))


@pytest.mark.parametrize("scene", [random_scene(random.Random(5), 1.0), random_scene(random.Random(6), 0.0), ROUND],
                         ids=["wheel", "no wheel", "equator"])
@pytest.mark.parametrize("by", ["energy", "amplitude"])
def test_tables_hold_what_an_elimination_term_by_term_finds(scene, by):
    round_ = equatorial(scene)
    for field in [FixedCentre(forms_of(scene)[0]), moving_centre(forms_of(scene)[0], scene)] + [round_] * bool(round_):
        parts, quantity = field.parts, getattr(field, by)
        tables, (added, left) = quantity.to(4, parts), sums_of(field, 4, by)
        a, b, size = quantity.over
        if quantity.drive is not None:
            left.pop((0, 0, 0, 0), None)
        first = {(j, k, r - field.algebra.turn[0], s): (c, m) for (j, k, r, s), c, m in quantity.added}
        added |= first | conjugate(first)
        for entries, (exponents, sums), up, over in ((added, tables[:2], (0, 0), 1.0),
                                                     (left, tables[5:7], (-a, -b), size)):
            expected = {}
            for (j, k, r, s), (c, m) in entries.items():
                key = j + k, (r + up[0]) * parts // 4, (s + up[1]) * parts // 4
                expected[key] = expected.get(key, 0.0) + (abs(c) + 2.0**-32 * m) / over
            got = {(degree, *exponents[:, n].tolist()): value for degree, row in enumerate(sums.tolist())
                   for n, value in enumerate(row) if value}
            assert got.keys() == {key for key, value in expected.items() if value}
            # rounding of coefficients that cancel: 2^-32 of the majorant is in each sum, rounding is 2^-50 of it
            assert all(abs(got[key] - value) < 1e-5 * value for key, value in expected.items() if value)


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
