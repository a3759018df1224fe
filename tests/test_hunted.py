"""What the search of `make hunt` ever found, each kept by name; and the search itself, which must find what is there."""
from __future__ import annotations

import json
import math

import numpy as np
import pytest

import stabilab
import stabilab.errors
from stabilab.analysis.certificate import certificate
from stabilab.verify import verify

from .hunt.__main__ import Hunt, aim, evolve
from .hunt.disagreements import DISAGREEMENTS
from .hunt.problems import KNOBS, problem_of
from .oracles import energy
from .oracles.pairs import physical, scaled
from .test_extremes import assert_extremes


def exactly(*digits):
    return tuple(map(float.fromhex, digits))


# -- found -------------------------------------------------------------------------------------------------------------

def test_the_turning_point_on_a_large_circle_is_settled_in_some_number_of_bits():
    """The middle of the ball was exact, so its height's ball came out narrower than those of its neighbours, and four times
    that was never enough to see the sign change, at any precision: the certificate failed."""
    scene, problem = scaled(0.3769424341839118, 0.1628431382008905, (0, 0, -1))
    state = exactly("0x1.ab58ea425c626p+1", "-0x1.23cc00d9b9bbap+4", "0x1.43e7a7276f052p+1")
    made = certificate(scene, state)
    assert verify(json.loads(json.dumps(made))).status == "proved"
    assert_extremes(stabilab.extremes(scene, np.array(state)), energy.extremes(problem, state), 1e-11)


@pytest.mark.parametrize("off", [1e-8, 1e-12, 3e-15])
def test_next_to_the_centre_of_the_hyperbola_the_shift_costs_no_digits(off):
    """omega_j + lambda_j/(D_i - D_j) is some 1e-8 here and was formed from rounded parts: its logarithm is the way to the well,
    and eight digits of the largest omega_3 were lost."""
    scene, problem = physical((5.971849213055555, 0.2111990289374921, 5.838186057843126),
                              (-0.025648173771172383, 38.88062929746394, 0.0), (0.0, 0.0, -23.228124232441903))
    centre = problem.sigma[1] / problem.kappa[1], problem.rho[0] / problem.kappa[0]
    state = (float(-centre[0]) - off, float(-centre[1]) + off, 0.00125)
    assert_extremes(stabilab.extremes(scene, np.array(state)), energy.extremes(problem, state), 1e-11)
    assert float(stabilab.period(scene, np.array(state))) == pytest.approx(float(energy.period(problem, state)), rel=1e-11)


# -- the search --------------------------------------------------------------------------------------------------------

@pytest.mark.parametrize("how", [evolve, aim], ids=["differential evolution", "hypothesis"])
def test_the_search_finds_a_disagreement_that_was_put_there(how, tmp_path):
    """A function that exceeds its promise where |x1| is within a tenth of a decade of 10^2.5 only, with a slope towards it."""
    def planted(scene, problem, state):
        return 1.5 * math.exp(-8 * abs(math.log10(abs(state[0]) or 1e-9) - 2.5)), "planted"
    hunt = Hunt("planted", planted, tmp_path)
    hunt.go(how, 600, seed=3, questions=1000)
    assert hunt.kept
    kept = json.loads((tmp_path / "planted-0.json").read_text())
    assert kept["words"] == "planted" and 10**2.4 < abs(float.fromhex(kept["state"][0])) < 10**2.6


def test_an_answer_that_ends_in_a_traceback_is_found(tmp_path):
    def broken(scene, problem, state):
        raise ZeroDivisionError("here")
    hunt = Hunt("broken", broken, tmp_path)
    hunt.go(evolve, 600, seed=1, questions=3)
    assert "ZeroDivisionError: here" in hunt.kept[0]["words"] and hunt.kept[0]["size"] == math.inf


@pytest.mark.parametrize("name", DISAGREEMENTS)
def test_two_ways_to_an_answer_keep_their_promise_on_random_problems(name):
    rng, asked = np.random.default_rng(5), 0
    while asked < 4:
        try:
            scene, problem, state = problem_of(rng.random(KNOBS))
        except stabilab.errors.InputError:
            continue
        size, words = DISAGREEMENTS[name](scene, problem, state)
        assert size <= 1, words
        asked += 1
