"""The first line of an answer: what becomes of the motion, in words and in the units of engineers."""
import math
import re

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stabilab import Body, Gyrostat, Scene, load, motion
from stabilab.show.plot.subject import subject
from stabilab.show.text.headline import FIRST, bracketed, headline, two_lines
from tests.oracles.rigid import euler
from tests.shared import MOVING

BODY, WHEEL, TORQUE = map(np.array, ([12.0, 9, 5], [0.8, 0, 0], [0, 0, 0.02]))
START = [0.1, 0.05, 0.02]


def followed(start, end):
    """A run of SciPy's DOP853 of Euler's equations written out here: rates at 20,001 times."""
    run = solve_ivp(euler(BODY, WHEEL, TORQUE), (0, end), start, "DOP853",
                    np.linspace(0, end, 20001), rtol=1e-11, atol=1e-13)
    return run.t, run.y


def told(case):
    return motion(case.scene, case.exact_state or case.start, case.span)


@pytest.fixture
def own(case_file):
    def written(start=(0.1, 0.05, 0.02)):
        return load(case_file(f"{MOVING}span = [0, 300]\n".replace("[0.1, 0.05, 0.02]", str(list(start))), "my"))
    return written


def test_a_bounded_motion_is_told_with_the_rate_and_the_period_that_a_run_has(own):
    case = own()
    line = headline(case, told(case))
    found = re.fullmatch(r"BOUNDED only while the torque is exactly along z \(minor axis\); largest rate "
                         r"\|ω\| = "
                         r"(\S+) deg/s \((\S+) deg/s about ([xyz])\); (\S+) deg/s from the separatrix \((\S+) J\); "
                         r"period "
                         r"(\S+) s", line)
    t, rates = followed(START, 40)
    largest = np.abs(rates).max(axis=1)
    assert found[3] == "xyz"[largest.argmax()] and float(found[2]) == pytest.approx(
        math.degrees(largest.max()), rel=5e-4)
    # the first of all: |omega|
    assert float(found[1]) == pytest.approx(math.degrees(np.linalg.norm(rates, axis=0).max()), rel=5e-4)
    back = np.abs(rates - np.array(START)[:, None]).max(axis=0)
    late = t > 20
    assert float(found[6]) == pytest.approx(t[late][back[late].argmin()], abs=5e-3)


def test_the_margin_as_a_rate_is_where_the_fate_of_a_run_changes(own):
    """From the state of the motion to the nearest one on the separatrix: 1 % nearer the run stays bounded, 1
    % farther it leaves."""
    found = told(own())
    margin = float(re.search(r"(\S+) deg/s from the separatrix", headline(own(), found))[1])
    step = np.array(found.velocity_witness) - START
    assert margin == pytest.approx(math.degrees(np.linalg.norm(step)), rel=5e-4)
    ends = [np.abs(followed(START + share * step, 400)[1]).max() for share in (0.99, 1.01)]
    assert ends[0] < 0.6 < 1.0 < ends[1]


def test_an_equilibrium_with_a_rate_is_a_steady_rotation_and_one_without_is_rest(own):
    # omega3 = 0 and (omega1 + 4/15) omega2 = -0.02/3: at omega1 = -1/15, omega2 = -1/30, by hand
    case = own(("-1/15", "-1/30", "0"))
    steady = ("STEADY ROTATION (stable) only while the torque is exactly along z (minor axis); "
              "every rate stays as it is; rates (-3.82, -1.91, 0) deg/s")
    assert headline(case, told(case)) == steady
    # without a torque and a rate nothing changes: D omega' = 0, by hand
    wheel = Scene(Body((3, 2, 1)), Gyrostat((0, 0, 1)))
    assert headline(case, motion(wheel, (0, 0, 0))).startswith("AT REST (stable); every rate stays as it is")


def test_proofs_and_algebra_stand_behind_why(stabilab, own):
    path = own().path
    short, long = (stabilab("classify", path, *option)[1] for option in ([], ["--why"]))
    for words in ("Q  ", "t from", "fold at"):
        assert words not in short and words in long
    assert long == stabilab("classify", path, "-v")[1] and short.splitlines()[0] == long.splitlines()[0]
    assert "(deg/s)²" in long and "\n  energy, reduced motion" in long and long.count(" J\n") == 2


@pytest.mark.parametrize("low, high, words",
                         [(5.7296, 11.459, "5.729 to 11.46 deg/s"),
                          (2483386930.5, 2483387077.2, "2.48338693e+09 to 2.48338708e+09 deg/s"),
                                              (0.0, 3.5, "0 to 3.5 deg/s"),
                          (4.625, 4.625, "4.625 to 4.625 deg/s")])
def test_open_bounds_are_rounded_outward_with_the_digits_that_tell_them_apart(low, high, words):
    """By hand: two digits of the difference, four digits at least."""
    assert bracketed(low, high, ("deg/s", 1.0), 4) == words


@pytest.mark.parametrize("name", ["cubesat-3u", "geostationary-22n", "thruster-stuck-major-axis", "charged-body"])
def test_two_lines_say_all_of_the_headline_and_the_first_has_at_most_sixty_letters(name):
    """Every clause of the headline stands in one of them (as text, by comparison; the outcome, in capitals, in the
    first alone), and so does each condition in the first: an axis that the torque lies along, a law that is left.
    What the first has in fewer words the second does not say again but for the rank of the axis."""
    case = load(f"cases/{name}.toml")
    found = subject(case).motion
    line, (large, small) = headline(case, found), two_lines(case, found)
    assert 0 < len(large) <= FIRST
    for clause in line.split("; "):
        said = re.sub("^(by that law: )?[A-Z]{4}[A-Z ]*", "", clause).removeprefix("reaches ").strip().lower()
        said = re.sub(r"^only while the torque is exactly along (\w+)(?: \((.+)\))?",
                      lambda found: f"{found[1]} is the {found[2]}" if found[2] else "", said)
        assert said in f"{large}\n{small}".lower() and "while the torque" not in small
    assert ("only" in large) == ("only while" in line)
    assert large.startswith("Beyond the law: ") == line.startswith("BEYOND THE LAW")
