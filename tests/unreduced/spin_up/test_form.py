"""Normal forms: where there is none, that of a turned case, and wheels beyond the range of doubles."""
from functools import partial

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, InputError, Scene
from stabilab.unreduced.spin_up.form import forms_of, normal_form


@pytest.mark.parametrize("D, torque, axis", [((3, 2, 1.5), (1, 1, 1), 1), ((3, 2, 2), (1, 1, 1), 1),
                                             ((3, 2, 1.5), (0, 1, 1), 0)],
                         ids=["middle axis", "axis of two equal moments", "no torque about it"])
def test_no_form_where_none_exists(D, torque, axis):
    assert normal_form(D, (1, 1, 1), torque, axis) is None


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
