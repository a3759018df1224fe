"""Accuracy over units and strengths, measured by what half a unit in the last place of every input does (the
condition)."""
from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

import stabilab
from tests.hard.row import UNIT, distance, half_units
from tests.oracles import energy, model
from tests.oracles.pairs import WORDS, physical, random_body
from tests.shared import later

# times the condition, and times half a unit in the last place of the distance to the centre of the conic
ALLOWED = 8
DIGITS = 60


class Problem:
    """One body, torque on one axis, gyrostatic moment across it, one state; asks the oracle and the program
    the same."""

    def __init__(self, seed, strengths=0.0):
        """Units of inertia, rate and so of momentum and torque, 1e-12 ... 1e12 each; beyond them gyrostat and
        torque are 10^u, |u| <= strengths, times as strong as the body's own."""
        rng = np.random.default_rng(seed)
        mass, rate = 10.0 ** rng.uniform(-12, 12, 2)
        strong = 10.0 ** rng.uniform(-strengths, strengths, 2)
        self.axis = seed % 3
        self.j, self.k = (self.axis + 1) % 3, (self.axis + 2) % 3
        inertia = [d * mass for d in random_body(rng)]
        pair = rng.normal(size=2) * mass * rate * strong[0]
        torque = rng.choice([-1, 1]) * 10.0 ** rng.uniform(-1, 1) * mass * rate ** 2 * strong[1]
        self.state = tuple((rng.normal(size=3) * rate).tolist())
        self.inputs = tuple(map(float, (*inertia, *pair, torque, *self.state)))
        self.scene, self.problem = physical(*self.parts(self.inputs, 0.0))

    def parts(self, inputs, zero):
        momentum, torque = [zero] * 3, [zero] * 3
        momentum[self.j], momentum[self.k], torque[self.axis] = inputs[3:6]
        return inputs[:3], momentum, torque

    def asked(self, question):
        """The oracle's answer as a function of the nine inputs."""
        def ask(*inputs):
            problem = model.physical(*self.parts(inputs, Fraction(0)))
            if question == "margin":
                return energy.margin(problem, inputs[6:], digits=DIGITS)
            if question == "period":
                return energy.period(problem, inputs[6:], digits=40, nodes=16)
            return finite(energy.extremes(problem, inputs[6:], digits=DIGITS))
        return ask

    def answer(self, question, **options):
        value = getattr(stabilab,
                        {"margin": "fate"}.get(question,
                                               question))(self.scene, np.array(self.state), **options)
        if question == "extremes":
            return finite(value.tolist())
        return float(value.margins if question == "margin" else value)

    @property
    def reach(self):
        """How far out the centre of the circle or hyperbola lies, in units of the state. Heights
        in canonical doubles lose this factor; from 1e4 on margins come from the twofold numbers of `equilibria_kernel`."""
        D, i = self.inputs, self.axis
        centre = max(abs(D[3] / (D[self.j] - D[i])), abs(D[4] / (D[self.k] - D[i])))
        return min(centre / max(map(abs, self.state)), 1e4)

    def errors(self, question, **options):
        """(error of the answer, condition), relative to the exact answer; None where it is none or infinite.
        """
        ask = self.asked(question)
        exact = ask(*map(Fraction, self.inputs))
        if exact is None or exact == []:
            return None
        size = distance(exact, [0] * len(exact) if isinstance(exact, list) else 0)
        error = distance(self.answer(question, **options), exact)
        return float(error / size), float(half_units(ask, self.inputs, exact) / size) + UNIT


def finite(box):
    return [v for row in box for v in row if not math.isinf(v)]


def checked(seed, questions, strengths=0.0, **options):
    """How many questions had a number for an answer; each within its bound, and the label right."""
    scene = Problem(seed, strengths)
    word = energy.label(scene.problem, scene.state, digits=DIGITS)
    assert stabilab.fate(scene.scene, np.array(scene.state)).labels == WORDS[word]
    found = [scene.errors(q, **options) for q in questions if q != "period" or word == "bounded"]
    for error, condition in filter(None, found):
        away = 0.0 if options else scene.reach
        assert error <= ALLOWED * (condition + UNIT * away), (seed, error, condition, scene.reach)
    return sum(f is not None for f in found)


@pytest.mark.parametrize("seed", [0, 1, 2, *later(range(3, 60))])
def test_units_of_any_size_cost_no_digit_of_extremes_and_margin(seed):
    assert checked(seed, ("extremes", "margin")) >= 1


@pytest.mark.parametrize("seed", later(range(100, 118)))
def test_units_of_any_size_cost_no_digit_of_the_period(seed):
    checked(seed, ("period",))


@pytest.mark.parametrize("seed", later(range(200, 260)))
def test_gyrostats_and_torques_of_any_strength_lose_no_more_than_the_centre_is_far(seed):
    checked(seed, ("extremes", "margin"), strengths=6)


@pytest.mark.parametrize("seed", later(range(200, 212)))
def test_digits_asked_for_are_all_that_the_inputs_hold_at_any_strength(seed):
    checked(seed, ("extremes",), strengths=6, digits=17)


@pytest.mark.parametrize("power", [-40, 40])
def test_powers_of_two_as_units_change_no_bit_of_rates_and_periods(power):
    """Rates in units of 2^power: every product and root scales exactly, so the answers do."""
    unit = 2.0 ** power
    body, state = (3.0, 2.0, 1.5), np.array([0.3, -0.2, 0.4])
    one, _ = physical(body, (0.4, -0.7, 0.0), (0.0, 0.0, 0.2))
    other, _ = physical(body, (0.4 * unit, -0.7 * unit, 0.0), (0.0, 0.0, 0.2 * unit ** 2))
    np.testing.assert_array_equal(stabilab.extremes(other, state * unit),
                                  stabilab.extremes(one, state) * unit)
    assert stabilab.period(other, state * unit) == stabilab.period(one, state) / unit
    assert stabilab.fate(other, state * unit).margins == stabilab.fate(one, state).margins * unit ** 2
