"""Numbers of other tools against ours: each source's values, the causes, the enclosures against Taylor series
of another code, the page of docs."""
from __future__ import annotations

import json
import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import mpmath as mp
import pytest

from stabilab import load
from stabilab.errors import InputError
from stabilab.numbers.balls import working
from stabilab.papers.validation import comparison as shown
from stabilab.papers.validation import findings, source, sources
from stabilab.papers.validation.comparison import Source
from stabilab.papers.validation.quantities import ab2, at, rk4, run
from stabilab.show.terminal import written
from tests.oracles import taylor
from tests.oracles.pairs import physical

PAGE = Path(__file__).parents[2] / "docs" / "validation.md"


@pytest.fixture(scope="module")
def validated():
    return {name: (source(name), findings(source(name))) for name in sources()}


@pytest.fixture(scope="module")
def by_tool(validated):
    return lambda tool, time: [one for _, found in validated.values() for one in found
                               if one.printed.tool == tool and one.time == time]


def test_every_value_agrees_or_its_difference_is_explained(validated):
    assert {name: shown.counts(found) for name, (_, found) in validated.items()} == {
        "42": "no values are printed", "apophis": "1 agrees", "dual-spin": "3 agree", "tc3": "2 agree",
        "jeod": "1 agrees, 1 differs for a known cause", "moon": "2 agree", "basilisk": "15 agree, 3 differ for a known cause",
        "nesc": "10 agree, 35 differ for a known cause", "orekit": "3 agree", "shell": "1 agrees"}


def test_sources_name_repository_commit_and_licence_or_the_publication(validated):
    for one, found in validated.values():
        if one.commit:
            assert re.fullmatch(r"[0-9a-f]{40}", one.commit) and one.repository.count("/") == 1
        elif one.repository.startswith("closed form"):  # of no publication, evaluated in a test
            assert all(v.printed.file == "in closed form" for v in found)
        else:
            assert re.search(r"\((19|20)\d\d\)$", one.repository)
            assert all(one.url(v.printed.file).startswith(("https://doi.org/10.", "https://smallsats.org/"))
                       for v in found)
        assert one.licence
        assert all(v.printed.tolerance_is and v.printed.file for v in found)


def test_ours_are_known_far_better_than_any_tolerance(validated):
    """Six digits more; of a craft with a wheel four, whose attitude is known to 1e-11 of itself."""
    assert all(one.bound < (2e-5 if name == "dual-spin" else 1e-6) * one.tolerance
               for name, (_, found) in validated.items() for one in found)


def test_the_tumbling_brick_is_that_of_a_taylor_series_in_many_digits(by_tool):
    # Taylor series of another code, in 40 digits
    _, model = physical((1894220, 6211019, 7194665))
    with mp.workdps(50):
        (row,) = taylor.integrate(model, [mp.radians(v) for v in (10, 20, 30)], [30], digits=40)
        for one, value in zip(by_tool("tool 04", "30"), row):
            assert abs(mp.degrees(value) - mp.mpf(one.ours)) < mp.mpf(10) ** -16


def test_the_attitude_under_a_torque_is_what_the_rates_integrate_to(by_tool):
    # the rule of order four at 0.025 s: its error is 2^-8 of that at 0.1 s, 3e-7, and shrinks as the fourth
    # power
    found = by_tool("external torque", "600")
    left = {step: max(abs(a - float(one.ours)) for a, one in zip(_sigma(found[0].printed, step), found))
            for step in ("0.1", "0.05")}
    assert 14 < left["0.1"] / left["0.05"] < 18


def _sigma(printed, step):
    from stabilab.papers.validation.quantities import reproduced
    return reproduced(replace(printed, scheme={"method": "rk4", "step": step}), 600.0)


def test_the_angular_momentum_of_driven_wheels_and_body_rests_in_space():
    # no torque from outside: balls of the momentum in space at the start and after a second overlap, and are
    # narrow
    motion = next(p.motion for p in source("basilisk").printed if p.motion.wheels)
    wheels = motion.wheels
    (found,) = at(motion, [Fraction(1)])
    with working(256) as numbers:
        own = numbers.ball(wheels.momentum) / (200 * numbers.pi())
        start = [numbers.ball(m) * numbers.ball(w) + own * numbers.ball(s) * numbers.pi() / 30 for m, w,
                 s in zip(motion.inertia, motion.omega, wheels.speed)]
        wheel = [own * (numbers.ball(s) * numbers.pi() / 30 + numbers.ball(w)) + numbers.ball(u) / 2
                 for s, w, u in zip(wheels.speed, motion.omega, wheels.motor)]
        body = [(numbers.ball(m) - own) * w + h for m, w, h in zip(motion.inertia, found.omega, wheel)]
        space = [sum(found.turned[i][k] * body[i] for i in range(3)) for k in range(3)]
        assert all(a.overlaps(b) and float(b.rad()) < 1e-60 for a, b in zip(start, space))


def test_apophis_is_given_the_energy_and_the_precession_that_are_published():
    """E over that of rotation about the axis of the largest moment at the same |H|, and P_phi = 27.38 h."""
    case = load(source("apophis").printed[0].motion.case)
    D, w = case.scene.body.inertia, case.state
    energy, momentum = (sum(d**n * x * x for d, x in zip(D, w)) for n in (1, 2))
    assert energy * max(D) / momentum == pytest.approx(1.024, abs=1e-9)
    assert case.attitude().precession_period == pytest.approx(27.38 * 3600, abs=1e-2)


def test_the_shell_has_the_spin_and_the_nutation_of_the_example():
    """Its precession is wp = C w/((A - C) cos theta) by steady precession, w being the spin beside it; the rates
    are wp sin theta across and wp cos theta + w along; (A, C) of a shell of 100 kg, 1 m and 3 m."""
    import math
    case = load(source("shell").printed[0].motion.case)
    A, C = 100 / 2 + 100 * 9 / 12, 100
    spin, nutation = 2 * math.pi / 60, math.radians(20)
    precession = C * spin / ((A - C) * math.cos(nutation))
    assert case.scene.body.inertia == (A, A, C)
    assert case.state == pytest.approx((precession * math.sin(nutation), 0, precession * math.cos(nutation) + spin),
                                       rel=1e-14)
    assert float(findings(source("shell"))[0].ours) == pytest.approx(math.pi / precession, rel=1e-10)


def test_the_asteroid_tc3_has_rates_with_the_periods_that_are_published():
    """Rotation and mean precession of Euler's equations by quadrature over w2 = s sin u, in 40 digits: with two
    integrals w1^2 and w3^2 are linear in w2^2, and the azimuth turns by H 2T/|H across the axis|^2."""
    case = load(source("tc3").printed[0].motion.case)
    with mp.workdps(40):
        w1, w3 = (mp.mpf(v.numerator) / v.denominator for v in (case.exact_state[0], case.exact_state[2]))
        D1, D2, D3 = (mp.mpf(v.numerator) / v.denominator for v in case.scene.body.exact)
        energy, square = D1 * w1**2 + D3 * w3**2, (D1 * w1)**2 + (D3 * w3)**2
        first, second = D2 * (D2 - D3) / (D1 * (D1 - D3)), D2 * (D1 - D2) / (D3 * (D1 - D3))
        most = w1**2 / first  # of w2^2: w1 changes its sign, so that the body goes round axis 3
        assert most < w3**2 / second

        def pace(u):
            return (D1 - D3) / D2 * mp.sqrt(first * (w3**2 - second * most * mp.sin(u)**2))

        def azimuth(u):
            along, middle = w1**2 - first * most * mp.sin(u)**2, most * mp.sin(u)**2
            return (D1 * along + D2 * middle) / (D1**2 * along + D2**2 * middle) / pace(u)
        quarter = [0, mp.pi / 4, mp.pi / 2]
        rotation = 4 * mp.quad(lambda u: 1 / pace(u), quarter)
        turned = 4 * mp.sqrt(square) * mp.quad(azimuth, quarter)
        assert energy > 0 and abs(rotation - mp.mpf("99.2")) < 1e-16
        assert abs(2 * mp.pi * rotation / turned - 97) < 1e-16


def test_the_dual_spin_craft_has_the_closed_forms_of_a_symmetric_gyrostat():
    """In the body the transverse rate turns at (h + (C - A) w3)/A, in space at |H|/A; tan of the cone is A w1/(h + C w3)."""
    from math import atan2, degrees, hypot, pi, radians
    A, C, h, across, along = 300, 250, 400, radians(0.5), radians(1)
    momentum = hypot(A * across, h + C * along)
    wanted = (2 * pi * A / (h + (C - A) * along), 2 * pi * A / momentum, degrees(atan2(A * across, h + C * along)))
    found = findings(source("dual-spin"))
    assert [float(one.ours) for one in found] == pytest.approx(wanted, rel=1e-10)  # the digits that are known
    assert [one.theirs for one in found] == [f"{value:.6g}" for value in wanted]


def test_the_cylinder_librates_as_debra_and_delp_say_on_the_orbit_of_the_log():
    """n by the energy of the first state of the log (log_state_ASCII.csv) with JEOD's 3.986004415e14 m^3/s^2; pitch n sqrt(3 k)
    and roll n sqrt(1 + 3 k), k = (12250 - 500)/12250. The description's periods are as sqrt(4/3), k = 1 of a rod."""
    from math import hypot, pi, sqrt
    r, v = hypot(-4292653.41, 955168.47, 5139356.57), hypot(109.649663, -7527.72649, 1484.521489)
    rate = sqrt(3.986004415e14 * (2 / r - v * v / 3.986004415e14)**3)
    k = (12250 - 500) / 12250
    found = findings(source("jeod"))
    assert [float(one.ours) for one in found] == pytest.approx([2 * pi / rate / sqrt(3 * k), 2 * pi / rate / sqrt(1 + 3 * k)], rel=1e-9)
    assert 3257.94 / 2821.46 == pytest.approx(sqrt(4 / 3), abs=1e-6)


def test_the_moon_has_the_ratios_that_are_published_and_the_frequencies_of_debra_and_delp():
    """Pitch n sqrt(3 (B - A)/C); the roots of roll and yaw by the quadratic of DeBra and Delp 1961."""
    from math import sqrt
    A, B, C = (float(v) for v in re.findall(r'"([\d.]+)"', source("moon").printed[0].motion.case)[:3])
    assert ((C - A) / B, (B - A) / C) == pytest.approx((631.1e-6, 226.8e-6), abs=1e-12)
    roll, yaw = (C - A) / B, (C - B) / A  # the vertical is along A
    linear, constant = 1 + 3 * roll + roll * yaw, 4 * roll * yaw
    slow = sqrt(2 * constant / (linear + sqrt(linear**2 - 4 * constant)))
    month = 27.321661
    wobble, longitude = (float(one.ours) for one in findings(source("moon")))
    assert longitude == pytest.approx(month / sqrt(3 * (B - A) / C), rel=1e-9)
    assert wobble == pytest.approx(month / slow, rel=1e-6)


def test_rules_have_the_orders_that_they_are_named_for():
    # x' = x from 1 to t = 1: e, by its series
    rates = lambda x: [x[0]]
    error = lambda rule, n: abs(run(rates, [1.0], 1 / n, n, rule)[0] - 2.718281828459045)
    assert 15 < error(rk4, 20) / error(rk4, 40) < 17 and 3.7 < error(ab2, 200) / error(ab2, 400) < 4.3


def test_a_wrong_number_is_neither_agreed_with_nor_explained():
    given = source("nesc")
    planted = replace(given.printed[3],
                      values=(("10", "-2.41889", "-23.552576515835174", "28.128588284177358"),))
    assert [one.verdict
            for one in findings(replace(given, printed=(planted,)))] == ["differs", "explained", "explained"]


def test_a_difference_without_a_cause_ends_with_5(stabilab, monkeypatch):
    given = source("orekit")
    planted = replace(given.printed[0], values=(("1", "5.1e-4"),))
    monkeypatch.setattr("stabilab.papers.validation.source", lambda name: replace(given, printed=(planted,)))
    code, out, err = stabilab("validate", "orekit")
    assert code == 5 and "1 differs" in out and "local behaviour" in err


def test_unknown_source_is_bad_input(stabilab):
    with pytest.raises(InputError, match="known are 42, apophis, basilisk, dual-spin, jeod, moon, nesc, orekit, shell, tc3"):
        source("nase")
    assert stabilab("validate", "../x")[0] == 2


def test_json_names_file_value_and_cause(stabilab):
    code, out, _ = stabilab("validate", "orekit", "--json")
    data = json.loads(out)
    assert code == 0 and data["schema"] == "stabilab.validate/1" and data["sources"][0][
        "repository"] == "CS-SI/Orekit"
    assert set(data["sources"][0]["values"][0]) >= {"file", "url", "ours", "ours_within", "theirs",
                                                    "difference", "tolerance", "verdict", "cause"}


def test_the_page_shows_every_value(validated, tmp_path):
    text = shown.page(validated.values(), tmp_path / "page.html").read_text(encoding="utf-8")
    # as every page of the report writes a power of ten
    printed = lambda number: re.sub(r"e-0+", "e-", number).replace("-", "−")
    assert all(printed(number) in text for _,
               found in validated.values() for one in found for number in (one.ours, one.theirs))


def test_numbers_of_the_page_of_docs_are_those_of_the_findings(validated):
    """Every table row of docs/validation.md is what the program says of that tool, and below the table stands
    each cause."""
    page = PAGE.read_text(encoding="utf-8").splitlines()
    rows, causes = rows_of(validated)
    assert set(rows + causes) <= set(page) and len(causes) == 7


def rows_of(validated) -> tuple[list[str], list[str]]:
    """The rows of the table in docs/validation.md, a set of printed values each; the causes below it."""
    rows, causes = [], []
    for given, found in validated.values():
        for group in shown.grouped(found):
            worst, tool = max(group, key=lambda one: one.difference / one.tolerance), group[0].printed.tool
            off = f"{_power(f'{worst.difference:.1e}')} | {_power(f'{worst.tolerance:.0e}')}"
            rows.append(f"| {given.name} | {tool} | {len(group)} | {written(worst.component)} at "
                        f"{worst.time} s | "
                        f"{re.sub('^-', '−', worst.ours)} | {re.sub('^-', '−', worst.theirs)} | {off} | "
                        f"{worst.verdict} |")
            if cause := shown.cause(group):
                causes.append(f"- {given.name}, {tool}: {_power(written(cause))}")
    return rows, causes


def _power(words: str) -> str:
    """Powers of ten as the pages of docs write them: 4e-7."""
    return re.sub(r"(?<=\d)e-0*(?=\d)", "e-", words)


def test_a_source_without_numbers_says_why():
    given = source("42")
    assert isinstance(given, Source) and not given.printed and "no expected numbers" in given.about
