"""Percentiles over uncertain numbers, against closed formulas of the uncertain number."""
from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import beta, binom, norm

import stabilab
from stabilab.case.read import load
from stabilab.errors import InputError
from stabilab.maps.percentiles import binomial, distribution, of_case_drawn, percentiles, ranks
from stabilab.maps.plan import planned
from stabilab.show.report import one_case

# spin-up about z from rest but for 0.02 rad/s: t = (limit - w0) I/M, falling in M and rising in I
SPIN_UP = ('[body]\ninertia = [12, 9, 5]\n[effects.constant_torque]\ntorque = [0, 0, "{}"]\n'
           '[motion]\nangular_velocity = [0, 0, "0.02"]\n[limits]\nrate = "0.5"\n')
FREE = '[body]\ninertia = [12, 9, 5]\n[motion]\nangular_velocity = [0, 0, "{}"]\n'


def time(torque):
    return (0.5 - 0.02) * 5 / torque  # by hand


@pytest.mark.slow
def test_quantiles_of_a_monotone_map_are_the_map_of_the_quantiles():
    """Within their 95 % bounds at 8 of 10 seeds at least for each, 26 of 30 together (fewer have a probability of
    1.2 % and 1.6 % by the binomial distribution; the seeds are fixed)."""
    exact = {p: time(norm.ppf(1 - p / 100, 0.02, 0.001)) for p in (5, 50, 95)}
    inside = dict.fromkeys(exact, 0)
    case = stabilab.load(SPIN_UP.format("0.02, sigma 5 %"))
    for seed in range(10):
        found = case.percentiles(200, seed, largest=False, workers=1)
        for q in found.time.quantiles:
            inside[q.percent] += q.least <= exact[q.percent] <= q.greatest
            assert q.high == pytest.approx(exact[q.percent], rel=0.05)
    assert min(inside.values()) >= 8 and sum(inside.values()) >= 26


def test_each_draw_has_the_time_of_the_formula():
    case = stabilab.load(SPIN_UP.format("0.018 to 0.022, uniform"))
    drawn = planned(case, (), samples=15, seed=7).sampled.values(0, 15)[:, 0]
    found = case.percentiles(15, 7, largest=False).time
    assert found.low == pytest.approx(time(drawn), rel=1e-12) and found.unit == "s"


@pytest.mark.slow
def test_the_share_that_reaches_a_limit_has_the_exact_probability_within_its_bounds():
    """A free rotation about z at a normal rate reaches 0.1 rad/s where it starts there: P = 1 - Phi(1)."""
    probability, inside = 1 - norm.cdf(1), 0
    case = stabilab.load(FREE.format("0.09, sigma 0.01"))
    for seed in range(10):
        found = case.percentiles(300, seed, rate="0.1", largest=False, workers=1)
        reached = found.reached["reached"]
        assert reached.count + found.reached["never"].count == reached.number == 300
        inside += reached.low <= probability <= reached.high
    assert inside >= 8  # of 10 with 0.95 each: P(fewer) = 1.2 %, seeds are fixed


def test_the_largest_rate_of_rotations_about_an_axis_is_that_of_the_draw():
    found = stabilab.percentiles(FREE.format("0.09, sigma 0.01"), 200)
    exact = norm.ppf([0.05, 0.5, 0.95], 0.09, 0.01)
    for q, value in zip(found.largest.quantiles, exact):
        assert q.least <= value <= q.greatest and q.low == q.high
    assert list(found.outcomes) == ["equilibrium"] and found.time is None and not found.reached


@pytest.mark.parametrize("n", [1, 2, 5, 20, 59, 60, 300, 1000])
@pytest.mark.parametrize("p", [0.05, 0.5, 0.95])
def test_ranks_enclose_a_quantile_with_the_confidence_that_is_stated(n, p):
    """P(x_r <= q <= x_s) = P(r <= B < s) of a binomial B, by SciPy's own distribution; the neighbours inside
    would not do on their side."""
    r, s = ranks(n, p)
    assert 0 <= r < s <= n + 1
    assert binom.cdf(r - 1, n, p) <= 0.025 + 1e-12 and binom.sf(s - 1, n, p) <= 0.025 + 1e-12
    assert binom.cdf(r, n, p) > 0.025 - 1e-12 and (s == 1 or binom.sf(s - 2, n, p) > 0.025 - 1e-12)


@pytest.mark.parametrize("count, number", [(0, 10), (1, 10), (5, 10), (10, 10), (983, 1000)])
def test_bounds_of_a_share_are_those_of_clopper_and_pearson(count, number):
    low = 0.0 if not count else beta.ppf(0.025, count, number - count + 1)
    high = 1.0 if count == number else beta.ppf(0.975, count + 1, number - count)
    assert binomial(count, number) == pytest.approx((low, high), abs=1e-12)


def test_draws_that_never_come_there_and_draws_that_are_not_known_widen_the_quantiles():
    low = np.array([*range(1, 91), *[math.inf] * 8, 3.5, 3.5])
    high = np.array([*range(1, 91), *[math.inf] * 10])
    five, median, last = distribution(low, high, "s").quantiles
    assert (five.low, five.high) == (3.5, 5) and (median.low, median.high) == (48, 50)  # counted by hand
    assert last.low == last.high == math.inf and last.greatest == math.inf
    assert math.isfinite(last.least)


@pytest.mark.slow
def test_the_answer_is_the_same_for_any_number_of_workers_and_by_the_seed_alone():
    case = stabilab.load(SPIN_UP.format("0.02, sigma 5 %"))
    one, two, again = (of_case_drawn(case, 24, 3, workers, True, False) for workers in (1, 2, 1))
    assert one == two == again and one.time.low.tobytes() == two.time.low.tobytes()
    assert one != of_case_drawn(case, 24, 4, 1, True, False)
    assert replace(one, seed=4) != one


def test_draws_that_are_no_body_are_left_out_and_counted():
    """A moment of 5 with sigma 1.66 is not positive with P = Phi(-3.01) = 0.13 %."""
    text = '[body]\ninertia = ["5, sigma 1.66", 4, 2]\n[motion]\nangular_velocity = [0.1, 0.2, 0.3]\n'
    case = stabilab.load(text)
    drawn = planned(case, (), samples=9, seed=1).sampled
    seed = next(n for n in range(10_000) if (replace(drawn, seed=n).values(0, 9) <= 0).any())
    found = case.percentiles(9, seed, rate="1", largest=False)
    assert (found.draws, found.number) == (9, 8)
    assert any("left out" in item.words for item in found.caveats)


@pytest.mark.parametrize("command, keys", [
    ("when", {"reached", "time"}), ("extremes", {"outcomes", "largest"}), ("fate", {"outcomes", "largest"}),
    ("stuck", {"outcomes", "largest", "reached", "time"})])
def test_commands_give_percentiles_in_every_view(stabilab, case_file, command, keys):
    path = case_file(SPIN_UP.format("0.02, sigma 5 %"))
    options = (command, path, "--samples", "10", "--seed", "2", "--workers", "1")
    text, told = stabilab(*options)[1], json.loads(stabilab(*options, "--json")[1])
    told = (told[0] if isinstance(told, list) else told)["percentiles"]
    assert "10 draws" in text and "samples, no proof" in text and told["number"] == 10 and told["seed"] == 2
    assert {name for name in ("reached", "outcomes", "time", "largest") if told[name]} == keys
    if told["time"]:
        median = told["time"]["quantiles"][1]
        assert median["least"] < median["high"] < median["greatest"] and f"median {median['high'] / 60:.4g}" in text
        assert sum(told["time"]["histogram"]["counts"]) + told["time"]["histogram"]["beyond"] == 10
    if command in ("when", "extremes", "stuck"):
        rows = stabilab(*options, "--csv")[1]
        assert rows.startswith("case,quantity,of,low,high,least,greatest,caveats\n") and "no proof" in rows


def test_one_draw_is_one_and_a_seed_is_whole(stabilab, case_file):
    options = ("when", case_file(SPIN_UP.format("0.02, sigma 5 %")), "--samples", "1", "--workers", "1", "--seed", "12345")
    text, told = stabilab(*options)[1], json.loads(stabilab(*options, "--json")[1])
    assert "1 draw of" in text and "1 draws" not in text and "seed 12345" in text
    seeds = [row["seed"] for row in told[0]["percentiles"]["caveats"] if "seed" in row]
    assert seeds == [12345] and type(seeds[0]) is int


def test_draws_between_ends_far_apart_stand_in_no_bar():
    """A tenth of the greater end is near: of 1 to 2 a middle would say more than is known."""
    edges, counts, beyond = distribution(np.array([1.0, 1.0, 1.0, 3.0]), np.array([1.05, 2.0, math.inf, 3.0]), "s").histogram()
    assert sum(counts) == 2 and beyond == 2 and edges[0] == 1.025 and edges[-1] == 3


@pytest.mark.parametrize("options, cure", [
    (("when", "--samples", "0"), "at least one point"),
    (("stuck", "--samples", "9", "--all-thrusters"), "no thruster: describe each"),
    (("when", "--samples", "9", "--seed", "-1"), "not negative")])
def test_samples_that_are_none_are_bad_input(stabilab, case_file, options, cure):
    command, *rest = options
    code, _, error = stabilab(command, case_file(SPIN_UP.format("0.02, sigma 5 %")), *rest)
    assert code == 2 and cure in error
    code, _, error = stabilab("when", case_file(SPIN_UP.format("0.02"), "certain"), "--samples", "9")
    assert code == 2 and "gives no number with an uncertainty" in error


def test_percentiles_print_themselves_and_are_a_data_set():
    pytest.importorskip("xarray")
    found = stabilab.percentiles(SPIN_UP.format("0.02, sigma 5 %"), 20)
    assert "20 draws" in repr(found) and "no proof" in repr(found)
    data = found.to_xarray()
    assert data["time_high"].sel(percent=50) == found.time.quantiles[1].high and data.attrs["reached_share"] == 1
    with pytest.raises(InputError, match="nothing to find"):
        stabilab.percentiles(FREE.format("0.09 +- 0.01"), 20, largest=False)


THRUSTERS = """[body]
inertia = [12, 9, 5]
[[thrusters]]
name = "A"
position = [0.3, 0, 0]
direction = [0, 1, 0]
force = "0.1 N, sigma 5 %"
stuck = true
[[thrusters]]
name = "B"
position = [0, 0.3, 0]
direction = [-1, 0, 0]
force = "0.2 N +- 5 %"
[[thrusters]]
name = "C"
position = [0, 0.3, 0]
direction = [-1, 0, 0]
force = "0.2 N"
[limits]
rate = 0.5
[motion]
angular_velocity = [0, 0, 0.02]
"""


def test_each_thruster_alone_has_its_percentiles(stabilab, case_file):
    """About z, whose torque is 0.3 m times the force: the time of each draw by hand, as of `time`."""
    path, options = case_file(THRUSTERS), ("--samples", "3", "--seed", "2", "--workers", "1")
    text = stabilab("stuck", path, "--all-thrusters", *options)[1]
    told = json.loads(stabilab("stuck", path, "--all-thrusters", *options, "--json")[1])["percentiles"]
    assert [row["thruster"] for row in told] == ["A", "B"]
    assert "case: A, 3 draws" in text and "case: B, 3 draws" in text and "nothing is drawn of C" in text
    for name, force, row in (("A", 'force = "0.1 N, sigma 5 %"', told[0]), ("B", 'force = "0.2 N +- 5 %"', told[1])):
        alone = THRUSTERS.replace("stuck = true\n", "").replace(force, f"{force}\nstuck = true")
        drawn = planned(load(alone), (), samples=3, seed=2).sampled.values(0, 3)[:, 0]
        found = percentiles(THRUSTERS, 3, 2, thruster=name)
        assert found.time.low == pytest.approx(time(0.3 * drawn), rel=1e-11) and found.thruster == name
        assert row["time"]["quantiles"][1]["low"] == found.time.quantiles[1].low
    rows = stabilab("stuck", path, "--all-thrusters", *options, "--csv")[1]
    assert "\ncase: A,time,50 %," in rows and "\ncase: B,time,50 %," in rows
    with pytest.raises(InputError, match="no thruster D; it has A, B, C"):
        percentiles(THRUSTERS, 5, thruster="D")


@pytest.mark.slow
def test_a_page_has_the_percentiles_of_its_uncertain_numbers(tmp_path):
    case = load(SPIN_UP.format("0.02, sigma 5 %"))
    page = one_case.sections(case, tmp_path, "case")
    assert "200 draws" in page["percentiles"] and "median" in page["percentiles"] and "no proof" in page["percentiles"]
    assert "histogram" in [picture["kind"] for picture in page["pictures"]]
    certain = one_case.sections(load(SPIN_UP.format("0.02")), tmp_path, "certain")
    assert not certain["percentiles"] and "histogram" not in [picture["kind"] for picture in certain["pictures"]]
    assert not any("Draws" in what for what, _ in certain["absent"])
