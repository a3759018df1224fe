"""Uncertain numbers by their distribution, and correlations, as a case file states them."""
from __future__ import annotations

import json
import math
from fractions import Fraction

import numpy as np
import pytest

from stabilab.case.read import load
from stabilab.case.uncertain import uncertain_number
from stabilab.errors import InputError
from stabilab.maps.plan import planned
from stabilab.numbers.units import FORCE

BODY = "[body]\ninertia = [{}, {}, {}]\n[motion]\nangular_velocity = [0.1, 0.2, 0.3]\n"
PAIR = '[[correlations]]\nof = ["{}", "{}"]\nvalue = {}\n'


@pytest.mark.parametrize("text, middle, half, law, sigma", [  # by hand: the box of a normal number is 3 sigma
    ("2 N, sigma 5 %", 2, "0.3", "normal", "0.1"), ("2 N, sigma 0.1 N", 2, "0.3", "normal", "0.1"),
    ("2 N; σ = 100 mN", 2, "0.3", "normal", "0.1"), ("2, sigma 0.1", 2, "0.3", "normal", "0.1"),
    ("2 N, 3 sigma 0.3 N", 2, "0.3", "normal", "0.1"), ("2 N, 2-sigma 10 %", 2, "0.3", "normal", "0.1"),
    ("2 N +- 5 %, uniform", 2, "0.1", "uniform", None), ("1.9 to 2.1 N, uniform", 2, "0.1", "uniform", None),
    ("1900 mN to 2.1 N uniform", 2, "0.1", "uniform", None), ("2 N +- 5 %", 2, "0.1", "tolerance", None)])
def test_a_number_is_read_with_its_distribution(text, middle, half, law, sigma):
    number = uncertain_number(text, FORCE)
    assert (number.middle, number.half, number.law) == (middle, Fraction(half), law)
    assert number.sigma == (sigma and Fraction(sigma)) and number.sharp


@pytest.mark.parametrize("text, cure", [
    ("2 +- 0.1, sigma 0.2", "a mean and its standard deviation"), ("2, sigma", "a mean and its standard"),
    ("2, sigma 0", "sigma is above zero"), ("2, sigma -1", 'half-width and not negative, got "2, sigma -1"'),
    ("3 to 2, uniform", "the lower end first"), ("2, uniform", "a number and its uncertainty"),
    ("2, sigma 1 kg", "expected force"), ("0, sigma 5 %", "a percentage of zero")])
def test_what_is_no_distribution_is_refused_with_a_cure(text, cure):
    with pytest.raises(InputError, match=cure):
        uncertain_number(text, FORCE)


@pytest.mark.parametrize("tables, cure", [
    (PAIR.format("inertia[1]", "inertia[3]", "1.2"), "from -1 to 1"),
    (PAIR.format("inertia[1]", "inertia[1]", "0.5"), "not correlated with itself"),
    (PAIR.format("inertia[1]", "angular_velocity[2]", "0.5"), "is no number with an uncertainty"),
    (PAIR.format("inertia[1]", "inertia", "0.5"), "is no number with an uncertainty"),
    (PAIR.format("inertia[1]", "inertia[2]", "0.5") + PAIR.format("inertia[2]", "inertia[1]", "0.5"),
     "keep one of them"),
    (PAIR.format("inertia[1]", "inertia[2]", "0.99"), "at most the correlation 0.977"),
    # x = y and y = z exclude x = -z
    ("".join(PAIR.format(f"inertia[{a}]", f"inertia[{b}]", v)
             for a, b, v in ((1, 3, "0.9"), (1, 2, "0.9"), (2, 3, "-0.9"))), "not positive semidefinite"),
    ('[[correlations]]\nof = ["inertia[1]"]\nvalue = 0.5\n', "the keys of two"),
    ('[[correlations]]\nof = ["inertia[1]", "inertia[2]"]\n', "add their correlation")])
def test_a_correlation_that_is_none_is_refused_at_its_line(tmp_path, tables, cure):
    text = BODY.format('"12, sigma 1 %"', '"9 +- 0.2"', '"5, sigma 0.1"')
    (tmp_path / "case.toml").write_text(text + tables)
    with pytest.raises(InputError, match=cure) as error:
        load(tmp_path / "case.toml")
    line = int(str(error.value).split("case.toml:")[1].split(":")[0])
    assert line > text.count("\n")


def sampled(text, count, seed=1):
    return planned(load(text), (), samples=count, seed=seed).sampled


def test_draws_have_the_moments_and_the_correlations_that_are_stated():
    """Means, deviations, correlations of 20,000 draws within five standard errors; a uniform number has the
    deviation half-width/sqrt(3)."""
    text = BODY.format('"12, sigma 0.12"', '"9 +- 0.09"', '"4.9 to 5.1, uniform"') + PAIR.format(
        "inertia[1]", "inertia[2]", "0.8") + PAIR.format("inertia[2]", "inertia[3]", "-0.5")
    n = 20_000
    draws = sampled(text, n).values(0, n)
    deviation = np.array([0.12, 0.09 / math.sqrt(3), 0.1 / math.sqrt(3)])
    assert np.all(abs(draws.mean(0) - [12, 9, 5]) < 5 * deviation / math.sqrt(n))
    assert np.all(abs(draws.std(0) / deviation - 1) < 5 / math.sqrt(2 * n))
    wanted = np.array([[1, 0.8, 0.0], [0.8, 1, -0.5], [0, -0.5, 1]])
    assert np.all(abs(np.corrcoef(draws.T) - wanted)[np.triu_indices(3, 1)] < 5 / math.sqrt(n))
    assert draws[:, 1].min() >= 8.91 and draws[:, 1].max() <= 9.09  # the bounds of a tolerance are bounds


@pytest.mark.parametrize("value", [1, -1])
def test_numbers_with_the_correlation_one_move_together(value):
    draws = sampled(BODY.format('"12, sigma 0.1"', 9, '"5, sigma 0.2"')
                    + PAIR.format("inertia[1]", "inertia[3]", value), 100).values(0, 100)
    assert np.allclose(draws[:, 1] - 5, value * 2 * (draws[:, 0] - 12), rtol=0, atol=1e-12)


def test_a_draw_depends_on_its_number_and_the_seed_alone():
    text = BODY.format('"12, sigma 0.1"', '"9 +- 0.1"', 5) + PAIR.format("inertia[1]", "inertia[2]", "0.3")
    all_of = sampled(text, 50).values(0, 50)
    assert sampled(text, 900).values(20, 30).tobytes() == all_of[20:30].tobytes()
    assert not np.array_equal(sampled(text, 50, seed=2).values(0, 50), all_of)


def test_every_view_says_how_far_the_box_of_a_normal_number_reaches(stabilab, case_file):
    path = case_file(BODY.format('"12, sigma 1 %"', '"9 +- 0.1"', 5)
                     + PAIR.format("inertia[1]", "inertia[2]", "0.3"))
    for command, *options in (("fate",), ("extremes",), ("extremes", "--csv"), ("period", "--json"),
                              ("when", "--rate", "1")):
        out = stabilab(command, path, *options)[1]
        assert "3 sigma" in out and "0.3" in out, (command, out)
    told = json.loads(stabilab("fate", path, "--json")[1])
    told = told[0] if isinstance(told, list) else told
    rows = told["uncertain"]["numbers"]
    assert [(row["distribution"], row["sigma"]) for row in rows] == [("normal", "0.12"), ("tolerance", None)]
    assert "all that the uncertain numbers may be within 3 sigma" in stabilab("fate", path)[1]
