"""The motion of one state: one orbit answers all its questions."""
import collections
import math
from fractions import Fraction

import pytest

import stabilab
from stabilab import Body, ConstantTorque, Fate, Gyrostat, ScaledGyrostat, Scene
from stabilab.orbit.one_orbit import BallOrbit
from tests.shared import PARABOLIC


def body(inertia, wheel, torque):
    return Scene(Body(inertia), Gyrostat(wheel), ConstantTorque(torque))

ASKED = {
    "circle, bounded": (body((12, 9, 5), ("0.8", 0, 0), (0, 0, "0.02")), (0.1, 0.05, 0.02), Fate.BOUNDED),
    "circle, spin-up": (body((12, 9, 5), ("0.8", 0, 0), (0, 0, "0.02")), (0.1, 0.05, 0.9), Fate.SPIN_UP),
    "hyperbola": (ScaledGyrostat("0.2", "0.4", (0, 1, 0)), (0.5, 0.3, 0.2), Fate.BOUNDED),
    "parabola": (PARABOLIC["first axis"][0], (0.3, 0.2, 0.1), Fate.BOUNDED),
    "rates beyond the squares of doubles": (body((12, 9, 5), ("0.8", 0, 0), (0, 0, "0.02")),
                                            (1e200, 3e200, 2e200), Fate.SPIN_UP),
    "exact rates": (body((12, 9, 5), ("0.8", 0, 0), (0, 0, "0.02")),
                    (Fraction(1, 10), Fraction(1, 20), Fraction(1, 50)), Fate.BOUNDED),
    "torque between equal axes": (body((9, 9, 5), (0, 0, "0.8"), (3, 4, 0)), (0.1, 0.05, 0.02), Fate.BOUNDED)}


@pytest.mark.parametrize("name", ASKED)
def test_the_orbit_of_a_state_is_built_once_in_each_kind_of_number(name, monkeypatch):
    scene, state, label = ASKED[name]
    built, build = collections.Counter(), BallOrbit.__init__

    def counted(self, reduction, state, numbers):
        built[reduction, state, numbers.bits] += 1
        build(self, reduction, state, numbers)
    monkeypatch.setattr(BallOrbit, "__init__", counted)
    exact = state if isinstance(state[0], Fraction) else None
    found = stabilab.motion(scene, tuple(map(float, state)), exact=exact)
    assert found.fate == label and set(built.values()) == {1} and len({(r, s) for r, s, _ in built}) == 1


def test_a_motion_that_the_first_bits_leave_open_builds_one_orbit_more_for_each_number_of_bits(monkeypatch):
    scene = ScaledGyrostat("0.2", "0.4", (0, 0, 1))
    # the scaled energy is x3^2/2 + U
    edge = math.sqrt(2 * stabilab.motion(scene, (2.0, 1.0, 0.0)).margin_energy)
    bits, build = [], BallOrbit.__init__

    def counted(self, reduction, state, numbers):
        bits.append(numbers.bits)
        build(self, reduction, state, numbers)
    monkeypatch.setattr(BallOrbit, "__init__", counted)
    stabilab.motion(scene, (2.0, 1.0, edge * (1 - 1e-13)))
    assert len(bits) == len(set(bits)) > 1
