"""The normal forms are Euler's equations, exactly."""
import random
from functools import partial

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, InputError, ScaledGyrostat, Scene
from stabilab.unreduced.spin_up.centres import moving_centre
from stabilab.unreduced.spin_up.form import forms_of, normal_form

from .scenes import random_scene, rates_of
from .test_certificate import places


def scaled_rates(scene):
    """Amer et al. 2024, eq. (5), written out."""
    a, b, mu = scene.a, scene.b, scene.mu
    return lambda x: [x[1] * x[2] + mu[0], -x[2] * (x[0] + a) + mu[1], x[1] * (x[0] + b) + mu[2]]


def gap(form, rate, w):
    """Relative departure of the form's rates from those of the motion; X and zeta are affine, so a difference
    gives theirs."""
    X, z = form.place(w)
    X1, z1 = form.place([a + b for a, b in zip(w, rate(w))])
    G = form.M1 + form.gam * (z * z).imag + (form.kap.conjugate() * z).real
    turned = 1j * form.om * X * z + 1j * form.h * z.conjugate() + form.mu
    return max(abs(X1 - X - G / form.D1) / (1 + abs(G)), abs(z1 - z - turned) / (1 + abs(turned)))


def test_normal_forms_move_as_eulers_equations_say():
    rng = random.Random(1)
    for _ in range(60):
        scene = random_scene(rng)
        rate, w = rates_of(scene), [rng.gauss(0, 3) for _ in range(3)]
        forms = forms_of(scene)
        assert len(forms) == 2  # major and minor axis
        # rounding; oracle: Euler's equations written out
        assert max(gap(form, rate, w) for form in forms) < 1e-11


def test_scaled_forms_move_as_the_paper_says_for_any_a_and_b():
    rng = random.Random(2)
    for _ in range(40):
        scene = ScaledGyrostat(rng.gauss(0, 2), rng.gauss(0, 2), tuple(rng.gauss(0, 1) for _ in range(3)))
        w = [rng.gauss(0, 3) for _ in range(3)]
        forms = forms_of(scene)
        assert [form.axis for form in forms] == [0, 2]
        assert max(gap(form, scaled_rates(scene), w) for form in forms) < 1e-12  # oracle: eq. (5)


def test_mean_drag_of_the_wheel_is_that_of_the_form():
    rng = random.Random(3)
    for _ in range(40):
        for form in forms_of(random_scene(rng)):
            drag = -(form.kap.conjugate() * form.mu).imag / form.om
            # off-axis identity m* = -Im(kap* mu)/om
            assert abs(form.drag - drag) < 1e-12 * (1 + abs(form.kap * form.mu) / form.om)


@pytest.mark.parametrize("D, torque, axis", [((3, 2, 1.5), (1, 1, 1), 1), ((3, 2, 2), (1, 1, 1), 1),
                                             ((3, 2, 1.5), (0, 1, 1), 0)],
                         ids=["middle axis", "axis of two equal moments", "no torque about it"])
def test_no_form_where_none_exists(D, torque, axis):
    assert normal_form(D, (1, 1, 1), torque, axis) is None


def test_moving_centre_moves_as_eulers_equations_say():
    rng = random.Random(4)
    for _ in range(30):
        scene = random_scene(rng, 1)
        rate, step = rates_of(scene), 1e-5
        for form in forms_of(scene):
            field = moving_centre(form, scene)
            w = np.array([rng.gauss(0, 1) for _ in range(3)])
            w[form.axis] = form.sense * rng.uniform(20, 40)
            place = lambda v: tuple(part[0] for part in places(field, np.array([v])))
            x = (field.basis @ w)[0]
            p, q = field.a3 * x + field.c, field.a2 * x + field.c
            if not (p > 0 and q > 0):
                continue
            z = place(w)[1]
            (xp, zp), (xm, zm) = place(w + step * np.array(rate(w))), place(w - step * np.array(rate(w)))
            value = lambda terms: sum(c * z**j * z.conjugate()**k * p**(-a / 4) * q**(-b / 4)
                                      for j, k, a, b, c in zip(*terms.powers, terms.c))
            swing = value(field.algebra.x_rate)
            turned = -1 / field.algebra.lift * (p * q)**0.5 * z + swing * value(field.algebra.carried)
            # central differences of Euler's equations
            assert abs((xp - xm) / (2 * step) - swing) < 1e-6 * (1 + abs(swing))
            assert abs((zp - zm) / (2 * step) - turned) < 1e-5 * (1 + abs(turned))


def test_a_turned_case_has_the_same_forms():
    """Half a turn about axis 2 turns torque, wheel and state: the form is that of the turned scene, sense
    reversed."""
    one = Scene(Body((3, 2, 1.5)), Gyrostat((.3, .2, .1)), ConstantTorque((1, .5, .2)))
    other = Scene(Body((3, 2, 1.5)), Gyrostat((-.3, .2, -.1)), ConstantTorque((-1, .5, -.2)))
    for a, b in zip(forms_of(one), forms_of(other)):
        assert a.sense == -b.sense and a.place((1, 2,
                                                3)) == b.place((-1, 2, -3)) and a.mu == b.mu or a.axis == 2


QUESTIONS = {"fate": stabilab.fate, "extremes": stabilab.extremes, "period": stabilab.period,
             "time to": partial(stabilab.time_to, rate=1.0),
             "spin-up": lambda scene, states: stabilab.spin_up(scene, states[0]), "motion": lambda scene,
             states: stabilab.motion(scene, states[0])}


@pytest.mark.one_in(2)
@pytest.mark.parametrize("question", QUESTIONS)
@pytest.mark.parametrize("moments", [(10, 10, 6), (10.1, 9.9, 6)])
@pytest.mark.parametrize("wheel", [1e160, 1e300])
def test_wheels_whose_squares_are_no_doubles_are_refused_by_every_question(question, moments, wheel):
    scene = Scene(Body(moments), Gyrostat((wheel, .1, .2)), ConstantTorque((.001, .01, .02)))
    with pytest.raises(InputError,
                       match="momenta this large are beyond the range of doubles: choose other units"):
        QUESTIONS[question](scene, np.array([[.05, .01, .01], [.1, 0, 0]]))
