"""Faults that a review found, each kept as the fact that it broke."""
from __future__ import annotations

import json
import subprocess
import sys
from fractions import Fraction

import pytest

from stabilab import Body, ConstantTorque, Fate, Gyrostat, load, motion, ScaledGyrostat, Scene
from stabilab.answers.certificate import certificate
from stabilab.answers.digits.run import best_reached
from stabilab.verify import verify
from stabilab.verify.numbers import Malformed

OBLIQUE = Scene(Body((3, 2, "1.5")), ConstantTorque(("0.1", "0.2", "0.1")))  # two equilibria (cases/off-axis-two.toml)
SPINNING = Scene(Body((3, 2, 1)), ConstantTorque((0, 0, 1)))


def written(scene, *state):
    """A certificate as it comes from its file."""
    return json.loads(json.dumps(certificate(scene, *state)))


@pytest.mark.parametrize("scene", [Scene(Body((3, 2, 1)), Gyrostat((1, 2, 3))), ScaledGyrostat(0.2, 0.4, (0, 0, 0))], ids=["physical", "scaled"])
@pytest.mark.parametrize("kind", ["none", "all", "points"])
def test_curves_without_a_torque_are_not_proved_under_another_name(scene, kind):
    claimed = written(scene)
    claimed["equilibria"]["kind"] = kind
    assert verify(claimed).status == "refuted"
    claimed["equilibria"]["kind"] = "some"
    with pytest.raises(Malformed, match="kind"):
        verify(claimed)


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


TIE = """
title = "tie of decimals"
source = "3 omega1 = 4 omega3 is the separatrix: D1 (D1 - D2) = 9, D3 (D2 - D3) = 16"
[body]
inertia = [9, 8, 4]
[motion]
angular_velocity = [0.4, 0.7, 0.3]
span = [0, 20]
"""
TENTH = """
title = "a state that no double holds"
source = "own"
[scaled]
a = 0.2
b = 0.4
mu = [0, 0, 1]
[motion]
x = [2.5, 4.0, 0.1]
tau = [0, 1]
"""
# mpmath in 60 digits from x1' = x2 x3, x2' = -x3 (x1 + a), x3' = 1 + x2 (x1 + b) on the circle x1 + a = A sin, x2 = A cos:
# midpoint rule between the turning points, bisected; barrier by findroot. With the double nearest to 0.1 the 18th digit differs.
PERIOD, MARGIN = "1.804312247500545757485173072956", "1.632183021364656117174097282608"


def answer(command, folder, text, *options):
    """What a command says of a case file, as JSON."""
    path = folder / "case.toml"
    path.write_text(text)
    done = subprocess.run([sys.executable, "-m", "stabilab", command, str(path), "--json", *options], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def test_a_tie_of_written_decimals_is_the_separatrix(tmp_path):
    path = tmp_path / "tie.toml"
    path.write_text(TIE)
    case = load(path)
    assert case.state != case.exact_state  # the doubles lie beside it
    assert motion(case.scene, case.state).fate == Fate.BOUNDED
    assert motion(case.scene, case.state, exact=case.exact_state).fate == Fate.SEPARATRIX
    for options in ((), ("--digits", "30")):
        assert '"separatrix"' in json.dumps(answer("fate", tmp_path, TIE, *options))


@pytest.mark.parametrize("question, expected", [("period", PERIOD), ("fate", MARGIN)])
def test_thirty_digits_are_those_of_the_decimals_as_written(question, expected, tmp_path):
    assert expected in json.dumps(answer(question, tmp_path, TENTH, "--digits", "30"))


def test_a_motion_in_many_digits_starts_from_the_decimals(tmp_path):
    path = tmp_path / "tie.toml"
    path.write_text(TIE)
    case = load(path)
    found = best_reached(case, [150.0], 15, measured=False)
    # On the separatrix omega3/omega1 stays 3/4: twice the energy times D2 equals |H|^2 along the motion.
    omega = found.run.state["omega"][0]
    assert found.enough and omega[2] / omega[0] == pytest.approx(0.75, rel=1e-13)
