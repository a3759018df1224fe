"""Tests of `answers/equilibria.py`: what once went wrong there, and its edges."""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

import numpy as np
import pytest

import stabilab
from stabilab import Body, Scene
from stabilab.answers.equilibria import equilibria, other_equilibria
from stabilab.answers.motion import motion
from stabilab.answers.simulate import trajectory
from stabilab.errors import InputError
from stabilab.physics.coefficients import content
from stabilab.physics.effects.base import Effect
from stabilab.theories.follow import models_of


@dataclass(frozen=True)
class Drift(Effect):
    """A torque along axis 1 that grows with omega_2: of no paper."""

    name: ClassVar[str] = "drift"

    def parameters(self):
        return {"drift": Fraction(1, 4)}

    def torque(self, omega, p):
        return (p["drift"] * omega[1], 0, 0)


def test_an_effect_that_is_not_known_is_run_and_not_judged():
    scene = Scene(Body((3, 2, 1)), Drift())
    assert content(scene) is None and other_equilibria(scene) is None
    for question in (equilibria, lambda scene: motion(scene, (1.0, 0.5, 0.25)),
                     lambda scene: stabilab.fate(scene, np.ones(3))):
        with pytest.raises(InputError):
            question(scene)
    assert list(models_of(scene)) == ["exact"]
    run = trajectory(scene, (1.0, 0.5, 0.25), [0.0, 1e-4])
    rate = (run.states[1] - run.states[0]) / 1e-4
    np.testing.assert_allclose(rate, [(0.5 * 0.25 + 0.25 * 0.5) / 3, -2 * 0.25 * 1 / 2, 1 * 0.5], rtol=1e-3)
