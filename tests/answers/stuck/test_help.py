"""Margins, other thrusters, and wheels that only delay: what is told is checked by changing just that."""
import json
import math
from fractions import Fraction

import numpy as np
import pytest

import stabilab
from stabilab import load, stuck
from tests.answers.stuck.brute import Craft
from tests.answers.stuck.energy import fate as energy_fate
from tests.shared import craft_file, in_one_line

CASE = """title = "On an axis"
[body]
inertia = [12.0, 9.0, 5.0]
centre_of_mass = [0, 0, 0]
[[thrusters]]
name = "A"
position = [1, 0, 0]
direction = [0, 1, 0]
force = "20 mN"
stuck = true
[[thrusters]]
name = "B"
position = [1, 0, 0]
direction = [0, -1, 0]
force = "50 mN"
[[thrusters]]
name = "C"
position = [1, 0, 0.5]
direction = [0, -1, 0]
force = "30 mN"
[[thrusters]]
name = "D"
position = [1, 0, -0.5]
direction = [0, -1, 0]
force = "15 mN"
[[wheels]]
name = "W1"
axis = [1, 0, 0]
momentum = "0.8 N m s"
[limits]
rate = "60 deg/s"
[motion]
angular_velocity = [0.1, 0.05, {spin}]
"""
OFF = CASE.replace("inertia = [12.0, 9.0, 5.0]",
                   "inertia = [[12.0, 0.3, 0.1], [0.3, 9.0, -0.2], [0.1, -0.2, 5.0]]")


@pytest.fixture
def asked(case_file):
    def ask(text, spin="0.9"):
        path = case_file(text.replace("{spin}", spin), "own")
        return stabilab.stuck(stabilab.load(path))
    return ask


def test_about_the_middle_axis_no_change_of_rate_is_said_to_change_the_fate(asked, stabilab, tmp_path):
    """By brute force: from 1 % beyond the margin it turns no faster in a second run as long as the first."""
    text = CASE.replace('[limits]\nrate = "60 deg/s"\n', "")
    text = text.replace("[12.0, 9.0, 5.0]",
                        "[12.0, 5.0, 9.0]").replace("[0.1, 0.05, {spin}]", "[0.02, -0.1, 0.01]")
    row, craft = asked(text).rows[0], Craft(text)
    margin = row.margins["rate"]
    assert row.fate == "bounded" and margin.size and not margin.beyond
    assert "beyond it the motion is bounded again" in margin.because
    craft.start = craft.start + 1.01 * margin.size * np.array(margin.direction)
    _, craft.start, first = craft.run(200.0, limit=False, rtol=1e-8)
    assert craft.run(200.0, limit=False, rtol=1e-8)[2] < 1.01 * first
    code, out, _ = stabilab("stuck", tmp_path / "own.toml")
    assert code == 0 and "only on a separatrix the outcome is another, nearest " in out
    assert "the outcome changes with" not in out


def test_thrusters_that_leave_no_torque_are_found_alone_and_in_pairs(asked):
    """B pushes the other way with 50 mN for 20 mN: 40 %; C and D pass above and below: 30 u + 15 v = 20 and
    15 u = 7.5 v, by hand."""
    alone, pair = asked(CASE).rows[0].helpers
    assert (alone.thrusters, alone.effect) == (("B",),
                                               "zero") and alone.duty == pytest.approx((0.4,), rel=1e-12)
    assert (pair.thrusters, pair.effect) == (("C", "D"),
                                             "zero") and pair.duty == pytest.approx((1 / 3, 2 / 3), rel=1e-12)


@pytest.mark.slow
def test_a_helper_that_leaves_an_axis_torque_keeps_it_bounded(asked):
    """E takes the part across axis 3 away and leaves a small one along it, below which the start is captured.
    """
    stuck = CASE.replace('position = [1, 0, 0]\ndirection = [0, 1, 0]\nforce = "20 mN"',
                         'position = [1, 0, -1]\ndirection = [0, 1, 0]\nforce = "20 mN"', 1)
    text = stuck.split("[[thrusters]]")
    text = "[[thrusters]]".join(text[:2]) + ('[[thrusters]]\nname = "E"\nposition = [0.9, 0, -1]\ndirection '
                                             '= [0, -1, 0]\nforce = "40 mN"\n'
                                             + stuck[stuck.index("[[wheels]]"):])
    row = asked(text, "0.02").rows[0]
    assert row.fate == "spin-up" and row.torque == pytest.approx((0.02, 0, 0.02))
    (helper,) = row.helpers
    assert (helper.effect, helper.fate) == ("bounded", "bounded") and helper.duty == pytest.approx((0.5,))
    assert helper.torque_left == pytest.approx(0.002, rel=1e-9)


HURTS = """[body]
inertia = [[100, 2, -1], [2, 90, 3], [-1, 3, 40]]
[[wheels]]
name = "W"
axis = [0, 0, 1]
momentum = 6.283
[[thrusters]]
name = "A1"
position = [0.6, 0.1, 0]
direction = [0, 0.1, 1]
force = 1
stuck = true
[[thrusters]]
name = "B1"
position = [-0.6, 0.1, 0]
direction = [0, 0, {}]
force = 1
[limits]
rate = 0.5
[motion]
angular_velocity = [0, 0, 0]
"""


def test_what_leaves_the_least_torque_is_no_help_where_the_limit_comes_sooner(asked):
    """B1 takes two thirds of the torque away for 94.13 % of the time, and the limit comes sooner; less of it
    delays, by DOP853 in the frame of the file."""
    text = HURTS.format(1)
    row, craft = asked(text).rows[0], Craft(text)
    (helper,) = row.helpers
    without = craft.run(1e4)[0]
    with_b1 = lambda duty: craft.run(1e4, torque=craft.torque() + duty * craft.torque(["B1"]))[0]
    assert with_b1(0.9413) < without < helper.time_to_limit[0] == pytest.approx(with_b1(helper.duty[0]),
                                                                                rel=1e-8)
    assert (helper.thrusters, helper.effect) == (("B1",), "slower")


def test_a_helper_that_brings_the_limit_sooner_is_said_not_to_help(asked, stabilab, tmp_path):
    """B1 ahead of the centre takes a third of a per cent away, at best: any share of that brings the limit
    sooner, by DOP853."""
    text = HURTS.format(1).replace("[-0.6, 0.1, 0]", "[0, -0.5, 0]").replace("rate = 0.5", "rate = 0.2")
    row, craft = asked(text).rows[0], Craft(text)
    (helper,) = row.helpers
    assert (helper.thrusters, helper.effect) == (("B1",), "none")
    least = -craft.torque() @ craft.torque(["B1"]) / (craft.torque(["B1"]) @ craft.torque(["B1"]))
    times = [craft.run(1e4, torque=craft.torque() + share * least * craft.torque(["B1"]))[0]
             for share in (1, 0.75, 0.5, 0.25)]
    assert max(times) < craft.run(1e4)[0] and helper.time_to_limit[0] == pytest.approx(max(times), rel=1e-8)
    code, out, _ = stabilab("stuck", tmp_path / "own.toml")
    assert code == 0 and out.count(": does not help\n") == 2


@pytest.mark.slow
def test_no_torque_is_no_help_where_the_free_motion_comes_to_the_limit_sooner(asked):
    """Near the middle axis, which it leaves: 22 s without the torque, 72 s with it, by DOP853."""
    text = CASE.replace("[0.1, 0.05, {spin}]", "[0.08, 0.72, -0.54]").replace('"60 deg/s"', "0.98944")
    row, craft = asked(text).rows[0], Craft(text)
    (helper,) = row.helpers  # none of the four that leave no torque
    delayed = craft.run(1e3, torque=craft.torque() + helper.duty[0] * craft.torque(helper.thrusters))[0]
    free, now = (craft.run(100.0, torque=torque)[0] for torque in (np.zeros(3), None))
    assert helper.effect == "slower" and helper.time_to_limit[0] == pytest.approx(delayed, rel=1e-8)
    assert free < now < delayed


def test_a_wheel_that_only_delays_delays_by_what_is_told(asked):
    row = asked(OFF).rows[0]
    (wheel,) = row.wheels
    assert wheel.keeps_bounded == () and wheel.best is not None and wheel.searched == (
        -1.6, 1.6) and wheel.searched[0] <= wheel.best <= wheel.searched[1]
    craft = Craft(OFF.replace("{spin}", "0.9"))
    now, _, _ = craft.run(1e3)
    best, _, _ = craft.run(1e3, l=np.array([wheel.best, 0, 0]))
    assert now == pytest.approx(row.time_to_limit[0],
                                rel=1e-8) and best - now == pytest.approx(wheel.gain, rel=1e-5)
    assert all(craft.run(1e3, l=np.array([s, 0, 0]))[0] <= best * (1 + 1e-9)
               for s in np.linspace(-1.6, 1.6, 9))


@pytest.mark.slow
def test_a_bounded_motion_never_reaches_a_limit_above_its_largest_rate(asked):
    """The largest |omega| of a run over two periods by DOP853."""
    row = asked(CASE, "0.02").rows[0]
    assert row.fate == "bounded" and row.time_to_limit is None and row.never and row.level == "exact"
    _, _, largest = Craft(CASE.replace("{spin}", "0.02")).run(70.0, limit=False)
    assert row.largest_rate == pytest.approx(largest, rel=1e-3) and row.largest_rate >= largest * (1 - 1e-10)
    low = asked(CASE.replace("60 deg/s", "7 deg/s"), "0.02").rows[0]
    t, _, _ = Craft(CASE.replace("{spin}", "0.02").replace("60 deg/s", "7 deg/s")).run(70.0)
    assert low.fate == "bounded" and not low.never and low.time_to_limit[0] == pytest.approx(t, rel=1e-8)


@pytest.mark.slow
def test_the_headline_of_a_bounded_motion_says_what_a_tilt_does(asked, stabilab, tmp_path):
    """The tilted torque that is told, followed by brute force in the frame of the file, reaches the limit
    when it is told to."""
    text = CASE.replace('force = "20 mN"\n',
                        'force = "20 mN"\nmisalignment = "5 deg"\n').replace("60 deg/s", "12 deg/s")
    row = asked(text, "0.02").rows[0]
    assert row.fate == "bounded" and row.tilt.angle == pytest.approx(
        math.radians(5)) and row.tilt.of == "the force of A"
    t, _, _ = Craft(text.replace("{spin}", "0.02")).run(2 * row.tilt.high, torque=np.array(row.tilt.torque))
    assert row.tilt.low * (1 - 1e-8) < t < row.tilt.high * (1 + 1e-8)
    assert 0 <= row.tilt.not_before <= row.tilt.low
    code, out, _ = stabilab("stuck", tmp_path / "own.toml")
    first = in_one_line(out)
    assert code == 0
    assert "STAYS BOUNDED only while the torque is exactly along z (minor axis)" in first
    assert "tilted by 5 deg it reaches 12 deg/s after " in first
    assert asked(CASE.replace('[limits]\nrate = "60 deg/s"\n', ""), "0.02").rows[0].tilt is None


def test_a_terminal_is_told_what_is_being_asked_and_a_pipe_is_not(stabilab, case_file, monkeypatch):
    import sys

    from stabilab.show import progress
    path = case_file(CASE.replace("{spin}", "0.02").replace('[limits]\nrate = "60 deg/s"\n', ""), "own")
    assert stabilab("stuck", path)[2] == ""
    with progress.told() as tell:
        assert tell is None
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    words = []
    monkeypatch.setattr(sys.stderr, "write", words.append)
    with progress.told() as tell:
        stuck(load(path), progress=tell)
    assert any("own: A ..." in word for word in words) and words[-1].endswith("\x1b[K")


@pytest.mark.slow
def test_a_margin_into_a_narrow_gap_between_two_separatrices_says_where_the_fate_is_back(stabilab, tmp_path):
    """Beside the tip of a wedge of spin-up: by the balance of energy, whose least value ahead of the start
    has the sign of the fate."""
    text = craft_file([[0.74352, 0, 0.14064], [0, 0.887, 0], [0.14064, 0, 0.66148]],
                      ([1.1, -0.2, 0.7], [0.6, 0, -0.8], 0.166), [([1.092, 0, -0.62], 0.643)],
                      [-0.137, 0.305, -0.346], [0.3, -0.2, 0.1])
    (tmp_path / "own.toml").write_text(text)
    craft, margin = Craft(text), stuck(load(tmp_path / "own.toml")).rows[0].margins["wheel"]
    assert 1 < margin.until / margin.size < 1.0001 and "it is bounded again" in margin.because
    middle = math.sqrt(margin.size * margin.until)
    for size, fate in ((margin.size * (1 - 1e-9), "bounded"), (middle, "spin-up"),
                       (margin.until * (1 + 1e-9), "bounded"), (1.01 * margin.size, "bounded")):
        l = craft.l + size * np.array(margin.direction)
        assert energy_fate(craft.J, craft.torque(), l, craft.start)[0] == fate == craft.fate(l=l)
    code, out, _ = stabilab("stuck", tmp_path / "own.toml")
    assert code == 0 and " or 0.350597 N m s of wheel momentum or " in out
    assert "; beyond 0.350601 N m s of wheel momentum it is again as now" in in_one_line(out)


def test_an_end_at_infinity_is_a_number_in_json_and_null_is_what_is_not_known(stabilab, tmp_path):
    """RFC 8259 has numbers of any exponent; IEEE 754 rounds 1e999 to infinity. A change of rate never leads
    back either: by the balance of energy."""
    (tmp_path / "own.toml").write_text(CASE.replace("{spin}", "0.9"))
    code, out, _ = stabilab("stuck", tmp_path / "own.toml", "--json")
    (row,) = json.loads(out, parse_constant=lambda word: pytest.fail(f"{word} is no JSON"))["rows"]
    (wheel,) = row["wheel_intervals"]
    (first, _), (_, last) = wheel["keeps_bounded"]
    assert code == 0 and first == -math.inf and last == math.inf and out.count(" -1e999") == 1
    # without the torque alone it is bounded: the smallest one against it spins it up too
    assert row["margin_until"] == {"rate": math.inf, "wheel": math.inf, "torque": 0.02}
    craft, change = Craft(CASE.replace("{spin}", "0.9")), np.array(row["margin_direction"]["rate"])
    assert energy_fate(craft.J, -1e-9 * craft.torque(), craft.l, craft.start)[0] == "spin-up"
    for s in row["margin"]["rate"] * np.array([1 - 1e-6, 1 + 1e-6, 1.1, 3, 30, 1e3]):
        fate = energy_fate(craft.J, craft.torque(), craft.l, craft.start + s * change)[0]
        assert (fate == row["fate"]) == (s < row["margin"]["rate"])
    (tmp_path / "tilted.toml").write_text(CASE.replace("{spin}",
                                                       "0.9").replace("direction = [0, 1, 0]",
                                                                      "direction = [0, 1, 1]"))
    (row,) = json.loads(stabilab("stuck", tmp_path / "tilted.toml", "--json")[1])["rows"]
    assert row["margin_until"] == {"rate": None, "wheel": None, "torque": None} == row["margin"]


@pytest.mark.parametrize("inertia", ["[5.0, 5.0, 9.0]", "[9.0, 9.0, 5.0]", "[12.0, 9.0, 5.0]"])
def test_a_wheel_along_the_torque_leaves_no_separatrix_about_an_axis_of_symmetry_either(asked, inertia):
    """By hand: with D1 = D2 and all momentum along axis 3, D3 omega3' = M. For three moments
    (|H|^2/2 - D3 T)' = M l, which does not end either."""
    text = CASE.replace("[12.0, 9.0, 5.0]", inertia).replace("axis = [1, 0, 0]", "axis = [0, 0, 1]")
    row = asked(text).rows[0]
    assert row.fate == "spin-up"
    for name in ("wheel", "torque"):
        assert row.margins[name].size is None and row.margins[name].reason.code == "wheel-along-torque"


def test_doubles_rank_pairs_and_miss_none_that_exact_numbers_would_list(asked, monkeypatch):
    """All pairs judged in exact numbers, one by one, against those that doubles put in front."""
    from stabilab.answers.stuck import ask
    rng = np.random.default_rng(11)
    text, tail = CASE[:CASE.index("[[thrusters]]")], CASE[CASE.index("[limits]"):]
    for i in range(14):
        place, line = rng.choice([-1, -0.5, 0.5, 1], 3).tolist(), np.roll([rng.choice([-1, 1]), 0, 0], i).tolist()
        text += (f'[[thrusters]]\nname = "T{i}"\nposition = {place}\ndirection = {line}\n'
                 f'force = "{rng.integers(1, 50)} mN"\n{"stuck = true" if i == 0 else ""}\n')
    judged, stops, ranked = [], ask._stops, ask._by_doubles
    monkeypatch.setattr(ask, "_stops", lambda scenario, torque, chosen: (judged.append(len(chosen) == 2),
                                                                         stops(scenario, torque, chosen))[1])
    few, judged_of_few = asked(text + tail).rows[0].helpers, sum(judged)
    monkeypatch.setattr(ask, "_by_doubles", lambda torque, sets, least: [
        (0.0, sets.chosen(number)) for number in range(len(sets.arms))])
    judged.clear()
    every = asked(text + tail).rows[0].helpers
    assert every == few and any(len(helper.thrusters) == 2 for helper in every)
    assert judged_of_few < sum(judged) / 2
    pair = ask.Sets([("a", (-1, 0, 0)), ("b", (0, 1, 0))], 2)
    assert list(ranked((1, 0, 0), pair, lambda *_: np.full(1, math.inf))) == []


def test_arrays_of_pairs_leave_what_shares_in_fractions_leave():
    """Rational arms of few digits, so that some pairs are parallel, leave nothing or a torque on an axis
    alone; every pair is solved in fractions here, by Cramer's rule."""
    from stabilab.answers.stuck import ask
    rng = np.random.default_rng(12)

    def solved(p, q, r, s, x, y):
        det = p * s - q * r
        shares = ((x * s - q * y) / det, (p * y - r * x) / det) if det else (Fraction(2),) * 2
        return shares if all(0 <= u <= 1 for u in shares) else None
    arms, torque = rng.integers(-2, 3, (400, 2, 3)), rng.integers(-1, 2, 3)
    found = ask._left_by_pairs((0, 2), torque.astype(float), arms.astype(float))
    for (a, b), size in zip(arms.tolist(), found):
        a, b, m = (list(map(Fraction, v)) for v in (a, b, torque.tolist()))
        inner = lambda v, w: sum(x * y for x, y in zip(v, w))
        none = solved(inner(a, a), inner(a, b), inner(a, b), inner(b, b), -inner(a, m), -inner(b, m))
        left = lambda shares, m=m, a=a, b=b: [x + shares[0] * y + shares[1] * z for x, y, z in zip(m, a, b)]
        if none and not any(left(none)):
            expected = 0
        else:
            onto = [(i, solved(a[j], b[j], a[k], b[k], -m[j], -m[k])) for i, j, k in ((0, 1, 2), (2, 0, 1))]
            expected = min((abs(left(shares)[i]) for i, shares in onto if shares), default=math.inf)
        assert size == pytest.approx(float(expected), rel=1e-12, abs=1e-12)
    assert len(set(np.sign(found))) == 2 and np.isinf(found).any()


def test_doubles_leave_as_little_torque_in_the_box_of_shares_as_exact_numbers():
    """Random arms, some parallel, some that end inside and some on the border of the box."""
    from stabilab.answers.stuck import ask
    rng = np.random.default_rng(44)
    exact = lambda rows: [tuple(map(Fraction, row)) for row in rows.tolist()]
    inside = 0
    for many in (1, 2):
        torque, arms = rng.normal(size=3), rng.normal(size=(60, many, 3))
        arms[:5, -1] = -2 * arms[:5, 0]
        least = ask._left_in_the_box(torque, arms)
        for rows, size in zip(arms, least):
            (m,), rows = exact(torque[None]), exact(rows)
            shares = ask._in_the_box(m, rows)
            inside += len(shares) == 1 and many == 2
            assert size == pytest.approx(min(math.hypot(*map(float, ask._left(m, rows, duty)))
                                             for duty in shares), rel=1e-12)
    assert 0 < inside < 55


def test_a_helper_has_the_fate_that_the_whole_answer_has_and_a_time_that_integers_enclose_too(case_file):
    """Enclosures in compiled doubles and in integers share no arithmetic, so that their brackets meet."""
    from stabilab.answers.stuck.fate import fate_under, outcome_of, scenario_of
    from stabilab.answers.time_to import of_one
    scenario, rng = scenario_of(load(case_file(OFF.replace("{spin}", "0.9"), "off"))), np.random.default_rng(7)
    for torque in rng.normal(size=(2, 3)) / 20:
        torque = tuple(map(Fraction, torque.tolist()))
        noted = outcome_of(scenario, torque)
        assert fate_under(scenario, torque) == noted.fate and noted.when.level == "proved"
        assert "compiled" in of_one(scenario.scene(torque), scenario.start, scenario.state,
                                    scenario.exact_limit, None, steps_first=True).because
        integers = of_one(scenario.scene(torque), scenario.start, scenario.state, scenario.exact_limit, None)
        assert integers.level == "proved" and "compiled" not in integers.because
        assert (noted.when.low <= integers.high and integers.low <= noted.when.high
                and noted.when.high - noted.when.low < 1e-11 * noted.when.low)
