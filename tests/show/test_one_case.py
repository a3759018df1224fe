"""The sections of a case's page: what applies is there, what does not is said."""
import base64
import math
import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab
from stabilab.answers.equilibria import equilibria
from stabilab.answers.motion import motion
from stabilab.case.read import load, load_all, read_text
from stabilab.show import style
from stabilab.show.plot.in_space import space_of
from stabilab.show.plot.path import thinned
from stabilab.show.plot.subject import subject
from stabilab.show.report import one_case
from stabilab.show.report.one_case import sections
from stabilab.show.report.tables import equilibrium_table as table
from stabilab.show.space.box import Box
from stabilab.show.terminal import printed
from stabilab.show.text import headline
from stabilab.show.units import DEG, units_of
from tests.oracles.rigid import euler
from tests.shared import CASES, in_one_line

MINOR = CASES / "minor-axis-100.toml"


# by hand: (x1 + 1 + x3)' = x2 (x1 + 1 + x3)
UNSTABLE_PLANE = "[scaled]\na = 0.5\nb = 1\nmu = [0, 1, 0]\n[motion]\nx = [5, 0, -6]\ntau = [0, 8]\n"


def _space(case):
    moved = motion(case.scene, case.start, case.span, exact=case.exact_state)
    one = replace(subject(case), known=moved)
    return moved, one_case.space(one, equilibria(case.scene), units_of(case))


def _places(packed):
    return np.frombuffer(base64.b64decode(packed), "<i2").reshape(-1, 3) / 4095.0


SATELLITE = (np.array([100.0, 90, 40]), np.array([3.0, 0, 0]))  # moments, momentum of its wheel


def test_the_tiles_have_the_outcome_when_the_largest_rate_and_the_distance(tmp_path, undrawn):
    """Time and rate by SciPy's DOP853 on Euler's equations written out here."""
    text = ("[body]\ninertia = [100, 90, 40]\n[effects.gyrostat]\nmomentum = [3, 0, 0]\n"
            "[effects.constant_torque]\ntorque = {torque}\n[motion]\nangular_velocity = [0.1, 0, 0.01]\n"
            "[limits]\nrate = \"12 deg/s\"\n")

    def rates(torque, end, limit=math.inf):
        moments, wheel = SATELLITE
        over = lambda t, w: np.hypot(np.hypot(*w[:2]), w[2]) - limit
        over.terminal = True
        return solve_ivp(euler(moments, wheel, torque), (0, end),
                         [0.1, 0, 0.01], "DOP853", rtol=1e-11, atol=1e-13, events=over,
                         t_eval=np.linspace(0, end, 4001))
    found = {}
    for name, torque in (("leaves", [0.0, 0, 3]), ("stays", [0.0, 0, 0.001])):
        case = read_text(f"{name}.toml", text.format(torque=torque))
        page = sections(case, tmp_path, name, deep=False)
        found[name] = {what: rest for what, *rest in page["tiles"]}
        reached = "; reaches 12 deg/s after " in page["headline"]
        assert reached == (name == "leaves") == (next(iter(found[name])) == "when")
    run = rates([0, 0, 3], 50, math.radians(12))
    (value, unit), note = found["leaves"]["when"][0].split(" "), found["leaves"]["when"][1]
    assert found["leaves"]["outcome"][0] == "Spins up" and found["leaves"]["largest rate"][0] == "without end"
    assert unit == "s" and float(value) == pytest.approx(run.t_events[0][0], rel=2e-4) and "limit" in note
    size = np.linalg.norm(rates([0, 0, 0.001], 2000).y, axis=0).max()
    assert found["stays"]["outcome"] == ["Bounded", "only while the torque is exactly along z (minor axis)"]
    assert found["stays"]["when"][0] == "never"
    assert float(re.search(r"= (\S+) deg/s", found["stays"]["largest rate"][0])[1]) == pytest.approx(
        math.degrees(size), rel=1e-3)
    assert found["stays"]["to another outcome"][0].endswith(" deg/s")


def test_a_case_without_a_motion_has_its_equilibria_alone(tmp_path):
    case = read_text("still.toml",
                     "[body]\ninertia = [3, 2, 1]\n[effects.constant_torque]\ntorque = [0, 0, 0.1]\n")
    page = sections(case, tmp_path, "still")
    assert page["headline"].startswith("No motion is given") and page["equilibria"] and page["space"]
    assert [what for what, _ in page["absent"]] == ["Motion"] and [item.name for item in tmp_path.iterdir()] == [
        "still-small.png"]


@pytest.mark.parametrize("plain, shown", [
    ("omega1 lambda3 |gamma| alpha_i: 0.26666666666666666", "ω1 λ3 |γ| αᵢ: 0.266667"),
    ("1.5e-12 - x, -inf, 5e+20", "1.5e−12 − x, −∞, 5e20"),
    ("gammas omegaX, `plot --kind time`", "gammas omegaX, `plot --kind time`"),
    ("omega = Omega gamma, (Omega^2 - N) D", "ω = Ω γ, (Ω² − N) D"),
    ("from -inf to -291.942", "from −∞ to −291.942"), ("sqrt(-m) <= 2", "√(−m) ≤ 2"),
    ("`stabilab fate CASE --tilt \"1 deg\"` at 3-1-2", "`stabilab fate CASE --tilt \"1 deg\"` at 3-1-2"),
    ("period 1.804 tau", "period 1.804 τ"), ("0.04 kg m^2, lambda3 in rad/s^2", "0.04 kg m², λ3 in rad/s²")])
def test_words_have_the_letters_and_signs_of_a_book_and_commands_stay(plain, shown):
    assert printed(plain) == shown


def test_the_box_of_the_space_holds_the_motion_and_what_is_nearest_of_the_separatrix():
    case = stabilab.load(MINOR)
    moved, found = _space(case)
    drawn = found["drawn"]
    (curve,) = [c for c in drawn["curves"] if c["kind"] == "this motion"]
    places = _places(curve["at"]) * drawn["half"] + drawn["middle"]
    for axis, (low, high) in enumerate(moved.extremes):
        near = 2e-3 * drawn["half"][axis]
        assert abs(places[:, axis].min() - low) < near and abs(places[:, axis].max() - high) < near
    assert {"start", "nearest point of the separatrix"} <= {p["kind"] for p in drawn["points"]}


@pytest.mark.parametrize("name", ["charged-body", "major-axis-captured"])
def test_the_space_draws_all_of_a_bounded_motion_and_of_a_spin_up_what_is_near_the_separatrix(name):
    case = load(CASES / f"{name}.toml")
    moved, found = _space(case)
    curves = [c for c in found["drawn"]["curves"] if c["kind"] == "this motion"]
    assert len(curves) == (1 if name == "charged-body" else 3)  # the other one has 56 turns: three are lines
    size = max(np.linalg.norm(_places(curve["at"]) * found["drawn"]["half"] + found["drawn"]["middle"],
                              axis=1).max() for curve in curves)
    one, first = units_of(case).rates[1], math.hypot(*case.start[:3])
    if name == "charged-body":  # bounded, and its largest rate is fourteen times that of its start
        assert size > 3 * first * one
        assert size == pytest.approx(max(abs(v) for row in moved.extremes for v in row) * one, rel=2e-2)
    else:
        assert size < 4 * max(first, moved.margin_velocity or 0.0) * one


@pytest.mark.slow
def test_a_motion_that_turns_often_is_drawn_as_it_is_and_not_by_chords_across_it():
    """The rates of liquid-sensible go round axis 3 at 5.7 deg/s and more: even chords would cut across, down
    to less than half of that."""
    found = space_of(subject(load(CASES / "liquid-sensible.toml")), "123", ("", 1.0))
    assert len(found.lines) == 3
    for line in map(np.degrees, found.lines):
        assert np.hypot(*line[:, :2].T).min() > 5.7 and np.hypot(*(line[1:, :2] + line[:-1, :2]).T / 2).min() > 5.5
    (band,) = [np.degrees(part.points) for words, _, part in found.veils if words.startswith("least to greatest of 301 turns")]
    across = np.hypot(*band[:, :2].T)
    assert across.min() > 5.7 and across.max() > 9


def test_a_thinned_line_is_near_every_point_that_it_leaves_out():
    angle = np.linspace(0, 2 * np.pi, 2001)
    circle = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    few = thinned(circle, 1e-3)
    middles = (few[1:] + few[:-1]) / 2
    assert 40 < len(few) < 160 and 1 - np.linalg.norm(middles, axis=1).min() < 1.01e-3


def test_the_branches_of_the_space_are_those_of_the_separatrix():
    """Oracle: the energy of the minor axis derived by hand, x3^2/2 - theta - X^2/2 - c X, is that of its
    saddle all along each loop."""
    case = stabilab.load(MINOR)
    _, found = _space(case)
    drawn, scene = found["drawn"], case.scene
    assert drawn["branches"]
    for branch in drawn["branches"]:
        places = _places(branch["at"])
        p = (places * drawn["half"] + drawn["middle"]).reshape(branch["rows"], branch["columns"], 3)
        # rows of which nothing was moved in
        inside = (np.abs(places) < 8).all(axis=1).reshape(p.shape[:2]).all(axis=1)
        X, x2, x3 = p[inside, :, 0] + scene.a, p[inside, :, 1], p[inside, :, 2]
        energy = x3**2 / 2 - np.unwrap(np.arctan2(X, x2), axis=1) - X**2 / 2 - (scene.b - scene.a) * X
        # places are rounded to 1/4095 of the box
        assert inside.any() and np.ptp(energy[2:], axis=1).max() < 2e-3 * (1 + np.abs(X).max() ** 2)


def test_a_sentence_of_a_page_has_a_capital_and_its_commands_are_code():
    from stabilab.show.report.html import sentence
    assert sentence(
        'the rest: `a --b <c>`') == 'The rest: <code>a <span class="nowrap">--b</span> &lt;c&gt;</code>'
    assert sentence("ω = Ω γ") == "ω = Ω γ" and sentence("omega1_x < 2") == "omega1_x &lt; 2"


def test_no_line_ends_between_a_number_and_its_unit_or_within_it():
    from stabilab.show.report.html import together
    assert together(
        "from 6.8587 N m s on; 0.1 N m (2 J)") == "from 6.8587\u00a0N\u00a0m\u00a0s on; 0.1\u00a0N\u00a0m (2\u00a0J)"
    assert together("5 deg/s and N m s") == "5\u00a0deg/s and N m s"


def test_pieces_of_branches_are_told_by_the_rate_about_the_vertical_in_the_unit_of_the_page():
    """Each end of a piece is a rotation at Omega about the vertical: by the file's numbers its rates, in
    deg/s, have the length that the row says."""
    found = equilibria(load(CASES / "top-fast.toml").scene)
    told = table(found, DEG)
    ends = [words for row in told["rows"]
            for words in re.findall(r"^branch 3, Ω below (.*) deg/s$", row["where"])]
    assert ends and "t from" not in str(told["rows"])
    rates = found.curves[2].point(found.curves[2].segments[0].t[1])[:3]
    assert float(ends[0].replace("−", "-")) == pytest.approx(-math.degrees(math.hypot(*rates)), rel=1e-3)
    assert any(row["where"].endswith(" to −1313.13 deg/s") for row in told["rows"])  # -22.9184 rad/s
    assert told["curves"] == [("branch 1 to branch 10", "ω = Ω γ, ((Ω² − N) D γ + Ω Λ + s) × γ = 0",
                               ["γᵢ = (Ω Λᵢ + sᵢ)/(μ − (Ω² − N) Dᵢ), μ by |γ| = 1"])]


@pytest.mark.slow
def test_a_column_of_a_sweep_that_says_nothing_is_left_out(tmp_path):
    """A charged body's motion has no separatrix to be apart from: a column of empty margins was shown."""
    page = one_case.sections_of_sweep(load_all(CASES / "charged-sweep.toml")[:2], tmp_path, "charged-sweep")
    assert page["heads"] == ["fate", "largest rate (deg/s)", "period (s)"]
    assert all(len(row["told"]) == 3 and all(row["told"]) for row in page["rows"])


@pytest.mark.slow
def test_the_rates_of_a_sweep_on_an_unstable_plane_stay_on_it(tmp_path, case_file, monkeypatch):
    """By hand: the plane x1 + 1 + x3 = 0 is one of every a, x3 dies out on it and x2 grows with the time: |x|
    goes along with it."""
    file = case_file(UNSTABLE_PLANE + "[sweep]\n\"scaled.a\" = [0.5, 0.25]\n", "plane")
    cases = load_all(file)
    kept = []
    save = style.save

    def noted(figure, path, *rest, **more):
        if path.name == "plane-sweep.png":  # not the narrow one or that of the card
            kept.extend(line.get_xydata() for line in figure.axes[0].lines)
        return save(figure, path, *rest, **more)
    monkeypatch.setattr(style, "save", noted)
    one_case.sections_of_sweep(cases, tmp_path, "plane")
    assert len(kept) == 2
    for t, size in (rows.T for rows in kept):
        late = t > 3
        assert t[-1] == 8 and np.abs(np.diff(size[late]) / np.diff(t[late]) - 1).max() < 0.02


@pytest.mark.parametrize("name, claims", [("charged-body", False), ("symmetric-body", True)])
def test_a_certificate_without_claims_is_not_said_to_be_checked(name, claims, tmp_path, undrawn):
    from stabilab.show.report import html
    page = sections(load(CASES / f"{name}.toml"), tmp_path, name, deep=False, certify=True)
    text = html.render("case.html", case=page, surface=None, pictures="", extra=(), command="", versions=())
    assert bool(page["certificate"]["findings"]) is claims
    assert ("checked by code that shares nothing" in text) is claims and (
        "makes no claim that could be checked" in text) is not claims


def test_the_imaginary_unit_and_the_base_of_the_exponential_are_plain_letters():
    from sympy import I, Symbol, exp

    from stabilab.show.report import formulas
    told = formulas.inner(exp(I * Symbol("t")))
    assert "<mi>e</mi>" in told and "<mi>i</mi>" in told and "ExponentialE" not in told
    assert "ImaginaryI" not in told


def test_a_sum_is_broken_by_what_is_printed_of_it():
    """By hand: a whole number of six digits is six wide, for no zero is printed behind its point, and with
    its letter 7.3; six such terms fit into 46, a seventh does not. As formerly counted five did."""
    from sympy import Float, Symbol

    from stabilab.show.report import formulas
    terms = [Float(115120, 6) * Symbol(f"alpha{n}") for n in range(1, 8)]
    assert "<mtable" not in formulas.in_lines(sum(terms[:6]))
    assert formulas.in_lines(sum(terms)).count("<mtr>") == 2


def test_a_power_of_a_product_is_that_of_all_its_letters():
    """By hand: (k_d)^2 and not k_d^2; a product of another name stays a name."""
    from sympy import Symbol

    from stabilab.show.report import formulas
    product = "<mrow><mi>M</mi><mi>g</mi><msub><mi>x</mi><mi>c</mi></msub></mrow>"
    power = f"<msup><mrow><mo>(</mo>{product}<mo>)</mo></mrow><mn>2</mn></msup>"
    assert formulas.inner(Symbol("Mgx") ** 2) == power and formulas.inner(Symbol("Mgx")) == product
    assert formulas.inner(Symbol("Mgx") ** 2, products=False) == "<msup><mi>Mgx</mi><mn>2</mn></msup>"


@pytest.mark.slow
def test_a_page_of_a_sweep_begins_with_the_answer_of_the_commands_and_tells_the_farthest_of_its_laws(
    stabilab, tmp_path):
    path = CASES / "charged-sweep.toml"
    found = one_case.sections_of_sweep(load_all(path), tmp_path, "charged-sweep")
    first = in_one_line(stabilab("fate", path)[1])
    assert first.startswith(f"BEYOND THE LAW; by that law: charged-sweep: {found['headline']}")
    assert found["headline"].startswith(
        "each of 27 BOUNDED only with torque exactly along x")
    assert headline.of_cases(load_all(path)) == found["law"] and "27 of 27 combinations" in found["law"]


@pytest.mark.parametrize("name, limit", [("cubesat-3u", 60.0), ("upper-stage", 120.0), ("space-station", 0.5)])
def test_the_limit_is_a_sphere_of_its_size_about_zero_where_the_picture_comes_near_it(name, limit):
    """Oracle: the length of each place, in deg/s as the file states the limit."""
    found = space_of(subject(load(CASES / f"{name}.toml")), "123", ("deg/s", 180 / np.pi))
    parts = [part for words, _, part in found.veils if words == f"limit of |ω|, {limit:g} deg/s"]
    places = np.degrees(np.concatenate([part.points for part in parts]))
    assert np.linalg.norm(places, axis=1) == pytest.approx(np.full(len(places), limit), rel=1e-12)
    assert all(any(map(found.box.holds, part.points)) and len(part.points) == part.rows * part.columns
               for part in parts)
    assert "limit" in str(found.legend)


def test_a_limit_far_from_the_motion_is_not_in_its_picture():
    """The wobble of half a degree a second about 1.7 deg/s is seen at its own size; the limit is at 40."""
    case = load(CASES / "thruster-stuck-major-axis.toml")
    text = case.text + '\n[limits]\nrate = "40 deg/s"\n'
    near, far = (space_of(subject(one), "123", ("deg/s", 180 / np.pi))
                 for one in (case, read_text("far.toml", text)))
    assert near.box == far.box and near.curves == far.curves and not far.veils
    wide = space_of(subject(read_text("wide.toml", text)), "123", ("", 1.0), most=math.inf)  # 700 deg/s
    assert not [words for words, *_ in wide.veils if "limit" in words]


@pytest.mark.parametrize("middle, half, least, told", [
    (0.0, 54000.0, 3, [-40000, -20000, 0, 20000, 40000]), (0.0, 1.45e-4, 3, [-1e-4, 0, 1e-4]),
    (8550.0, 80.0, 3, [8500, 8550, 8600]), (8550.0, 80.0, 2, [8500, 8600])])
def test_numbers_at_an_edge_are_round_and_keep_off_the_corners(middle, half, least, told):
    box = Box((middle,) * 3, (half,) * 3)
    assert box.ticks(0, least) == pytest.approx(told)


def test_the_page_of_a_dual_spin_craft_has_its_rotations_and_the_speed_from_which_one_alone_attracts():
    """At a spin of w1, by hand, (400 - 350) w1 N m s of the wheel: 5 w1 of its speed, w1 = 61 rpm."""
    item = subject(load(CASES / "dual-spin-damper.toml"))
    rows = one_case.facts(item, item.motion, units_of(item.case))
    assert [name for name, _ in rows if name.startswith("rotation ")] == [f"rotation {n}" for n in range(1, 5)]
    assert [text for name, text in rows if name == "one alone attracts from"][1].startswith(
        "319.395 N m s, flywheel at 305 rpm")
