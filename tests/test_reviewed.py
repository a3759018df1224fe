"""Faults that a review found, each kept as the fact that it broke."""
from __future__ import annotations

import json
from fractions import Fraction

import pytest

from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene
from stabilab.analysis.certificate import certificate
from stabilab.verify import verify
from stabilab.verify.numbers import Malformed

OBLIQUE = Scene(Body((3, 2, "1.5")), ConstantTorque(("0.1", "0.2", "0.1")))  # two equilibria (cases/off-axis-two.toml)
SPINNING = Scene(Body((3, 2, 1)), ConstantTorque((0, 0, 1)))


def written(scene, *state):
    """A certificate as it comes from its file."""
    return json.loads(json.dumps(certificate(scene, *state)))


@pytest.mark.parametrize("scene", [Scene(Body((3, 2, 1)), Gyrostat((1, 2, 3))), ScaledGyrostat(0.2, 0.4, (0, 0, 0))], ids=["physical", "scaled"])
@pytest.mark.parametrize("kind", ["none", "all", "points", "some"])
def test_curves_without_a_torque_are_not_proved_under_another_name(scene, kind):
    claimed = written(scene)
    claimed["equilibria"]["kind"] = kind
    assert verify(claimed).status == "refuted"


def test_a_box_beside_the_equilibrium_is_not_proved():
    claimed = written(OBLIQUE)
    assert verify(claimed).status == "proved"
    for point in claimed["equilibria"]["points"]:  # from just beside the zero (known to 2^-160) to 2^-110 away
        middles = [(Fraction(low) + Fraction(high)) / 2 for low, high in point["box"]]
        point["box"] = [[str(m + Fraction(1, 10**12 * 2**110)), str(m + Fraction(1, 2**110))] for m in middles]
    assert verify(claimed).status != "proved"


@pytest.mark.parametrize("part, key", [("motion", "extremes"), ("equilibria", "points"), ("equilibria", "curves")])
@pytest.mark.parametrize("nonsense", [5, True, "abc", {"a": 1}, [5], [[["1", "2"], ["1", "2"]]] * 4], ids=repr)
def test_nonsense_in_a_certificate_is_malformed(part, key, nonsense):
    claimed = written(SPINNING, (1, 1, 1))
    claimed[part][key] = nonsense
    with pytest.raises(Malformed):
        verify(claimed)
