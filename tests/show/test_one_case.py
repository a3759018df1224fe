"""The sections of a case's page: what applies is there, what does not is said."""
import base64
import math
import re
from dataclasses import replace
from pathlib import Path

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
from stabilab.show.report.one_case import pictures as drawn
from stabilab.show.report.one_case import space, sweep
from stabilab.show.report.one_case.page import equations, facts, sections
from stabilab.show.report.one_case.tables import equilibrium_table as table
from stabilab.show.space import Box
from stabilab.show.terminal.letters import printed
from stabilab.show.text import law
from stabilab.show.units import DEG, units_of

CASES = Path(__file__).parents[2] / "cases"
MINOR = CASES / "minor-axis-100.toml"


# by hand: (x1 + 1 + x3)' = x2 (x1 + 1 + x3)
UNSTABLE_PLANE = "[scaled]\na = 0.5\nb = 1\nmu = [0, 1, 0]\n[motion]\nx = [5, 0, -6]\ntau = [0, 8]\n"


def _sections(name, tmp_path):
    return sections(load(CASES / f"{name}.toml"), tmp_path, name, deep=False)


def _facts(name):
    case = load(CASES / f"{name}.toml")
    return dict(facts(case, subject(case).motion, units_of(case)))


def _space(case):
    moved = motion(case.scene, case.start, case.span, exact=case.exact_state)
    one = replace(subject(case), known=moved)
    return moved, space.space(one, equilibria(case.scene), units_of(case))


@pytest.fixture
def undrawn(monkeypatch):
    """A page without its pictures, which take most of its time."""
    monkeypatch.setattr("stabilab.show.report.one_case.page.pictures", lambda *given: [])


def _places(packed):
    return np.frombuffer(base64.b64decode(packed), "<i2").reshape(-1, 3) / 4095.0


def test_a_top_has_its_fate_and_says_that_it_has_no_phase_plane(tmp_path):
    """Its state has the vertical too: bounded by the energy (|gamma| = 1 bounds the potential)."""
    page = _sections("top-fast", tmp_path)
    assert page["fate"] == "bounded" and [picture["title"]
                                          for picture in page["pictures"]] == ["Rates over time",
                                                                               "Analytic models beside the "
                                                                               "exact motion"]
    assert all((tmp_path / picture["file"]).exists() for picture in page["pictures"])
    assert [what for what, _ in page["absent"]] == [
        "Phase plane, Reduced potential", "The surface on which the motion stays",
        "Time to the limit against the tilt, Time gained by another momentum of a wheel"]
    assert page["space"]["reason"].startswith("no separatrix is drawn: ")


@pytest.mark.parametrize("name, title", [
    ("cubesat-3u-detumbling", None), ("vanguard-1", "Every part of the state over time")])
def test_a_state_beside_which_there_is_no_theory_says_so_and_shows_what_the_rates_do_not(tmp_path, name, title):
    shown = {one["kind"]: one["title"] for one in _sections(name, tmp_path)["pictures"]}
    assert shown.get("state") == title and "time" in shown


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
        return solve_ivp(lambda t, w: (np.cross(moments * w + wheel, w) + torque) / moments, (0, end),
                         [0.1, 0, 0.01], "DOP853", rtol=1e-11, atol=1e-13, events=over, max_step=end / 2000)
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


def test_a_torque_off_the_axes_is_certified_and_has_no_margins(tmp_path):
    page = _sections("off-axis-two", tmp_path)
    assert page["headline"].startswith("SPINS UP about z (minor axis), positive direction (certified)") and [
        one["kind"] for one in page["pictures"]] == ["time"]
    assert page["sensitivity"]["rows"] == [] and "no separatrix is known" in page["sensitivity"]["reason"]
    assert "no end" in page["extremes"][2]["within"]


def test_a_case_without_a_motion_has_its_equilibria_alone(tmp_path):
    case = read_text("still.toml",
                     "[body]\ninertia = [3, 2, 1]\n[effects.constant_torque]\ntorque = [0, 0, 0.1]\n")
    page = sections(case, tmp_path, "still")
    assert page["headline"].startswith("No motion is given") and page["equilibria"] and page["space"]
    assert [what for what, _ in page["absent"]] == ["Motion"] and list(tmp_path.iterdir()) == []


@pytest.mark.slow
@pytest.mark.parametrize("name", [
    "upper-stage", "cubesat-3u", "liquid-base", "charged-body", "charged-body-attitude",
    "torque-free-gyrostat", "torque-free-body", "sphere-wheel",
    "symmetric-spin-up", "uncertain-separatrix", "middle-axis-double-well", "geostationary-22n"])
def test_every_kind_of_case_has_its_page(name, tmp_path):
    page = _sections(name, tmp_path)
    assert page["headline"] and page["pictures"] and page["space"] and page["equations"] and page[
        "equilibria"]


def test_words_have_the_letters_and_signs_of_a_page():
    assert printed("omega1 lambda3 |gamma| alpha_i: 0.26666666666666666") == "ω1 λ3 |γ| αᵢ: 0.266667"
    assert printed("1.5e-12 - x, -inf, 5e+20") == "1.5e−12 − x, −∞, 5e20"
    assert printed(words := "gammas omegaX, `plot --kind time`") == words


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
    (curve,) = [c for c in found["drawn"]["curves"] if c["kind"] == "this motion"]
    size = np.linalg.norm(_places(curve["at"]) * found["drawn"]["half"] + found["drawn"]["middle"],
                          axis=1).max()
    one, first = units_of(case).rates[1], math.hypot(*case.start[:3])
    if name == "charged-body":  # bounded, and its largest rate is fourteen times that of its start
        assert size > 3 * first * one
        assert size == pytest.approx(max(abs(v) for row in moved.extremes for v in row) * one, rel=2e-2)
    else:
        assert size < 4 * max(first, moved.margin_velocity or 0.0) * one


def test_a_motion_that_turns_often_is_drawn_as_it_is_and_not_by_chords_across_it():
    """The rates of liquid-sensible go round axis 3 at 5.7 deg/s and more: even chords would cut across, down
    to less than half of that."""
    case = load(CASES / "liquid-sensible.toml")
    one = subject(case)
    across = np.hypot(*(line := np.degrees(space_of(one, "123", ("", 1.0)).path))[:, :2].T)
    middle = np.hypot(*(line[1:, :2] + line[:-1, :2]).T / 2)
    assert len(line) <= 6000 and across.min() > 5.7 and middle.min() > 5.5 and across.max() > 9


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


@pytest.mark.parametrize("plain, told", [
    ("omega = Omega gamma, (Omega^2 - N) D", "ω = Ω γ, (Ω² − N) D"),
    ("from -inf to -291.942", "from −∞ to −291.942"), ("sqrt(-m) <= 2", "√(−m) ≤ 2"),
    ("`stabilab fate CASE --tilt \"1 deg\"` at 3-1-2", "`stabilab fate CASE --tilt \"1 deg\"` at 3-1-2"),
    ("period 1.804 tau", "period 1.804 τ")])
def test_formulas_in_words_have_the_signs_of_a_book_and_commands_stay(plain, told):
    assert printed(plain) == told


def test_the_first_line_of_a_page_says_what_the_uncertain_numbers_change_and_the_page_has_one_unit_of_rates(
    tmp_path, undrawn):
    """The file's 1.7 +- 0.02 rad/s are 97.403 +- 1.1459 deg/s by hand."""
    page = sections(load(CASES / "uncertain-separatrix.toml"), tmp_path, "x", deep=False)
    assert page["headline"].endswith(
        "; BUT within the uncertainties also spin-up about the z axis, positive direction") and page[
            "fate"] == "undecided"
    told = page["uncertain"]
    assert "motion.angular_velocity[3] = 97.4028 ± 1.14592 deg/s" in told and "20 ± 0.2 kg m²" in told
    assert "rad/s" not in told and "^2" not in told and "state = 11.4592, 8.59437, 97.4028 deg/s" in told
    held = sections(load(CASES / "uncertain-minor-axis.toml"), tmp_path, "y", deep=False)
    assert held["headline"].endswith(
        "; the fate is the same for all that the uncertain numbers may be") and held["fate"] == "bounded"


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


def test_the_numbers_of_an_equation_have_the_unit_of_its_rates():
    """(0.6 rad/s)(180/pi) = 34.3775 deg/s, and −0.26 (180/pi)² = −853.53, by hand."""
    (curve,) = table(equilibria(load(CASES / "two-wheels-minor-axis.toml").scene), DEG)["curves"]
    assert curve[1] == "ω3 = 0, (ω1 + 34.3775) (ω2 − 22.9183) = −853.53 (ω in deg/s)"


def test_folds_of_a_field_are_told_as_rates_without_the_vertical_behind_them():
    found = equilibria(load(CASES / "top-fast.toml").scene)
    told = table(found, DEG)
    folds = [row["where"] for row in told["rows"] if row["where"].startswith("fold")]
    assert folds and all(where.count(",") == 2 for where in folds)
    # one equation, told once
    assert len(told["curves"]) == 1 and told["curves"][0][0] == "branch 1 to branch 10"


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
                               ["γᵢ = −bᵢ/(Sᵢ − μ)"])]


def test_a_parameter_that_is_a_rate_or_an_angle_has_its_unit():
    (hyperbola,) = equilibria(load(CASES / "thruster-stuck-major-axis.toml").scene).curves
    assert table(equilibria(load(CASES / "thruster-stuck-major-axis.toml").scene),
                 DEG)["rows"][0]["where"] == \
        "equilibrium hyperbola, t below −1.75199 deg/s" and hyperbola.segments[0].t[1] == pytest.approx(
            -0.03058, abs=1e-5)
    told = table(equilibria(load(CASES / "charged-body-attitude.toml").scene), DEG)
    assert any(row["where"] == "lesser Ω, t from −180 to −90 deg" for row in told["rows"])
    assert [names for names,
            *_ in told["curves"]] == ["lesser Ω and greater Ω"] and "rad" not in str(told["rows"][0]["where"])


@pytest.mark.parametrize("name, expected", [
    ("torque-free-gyrostat", {"meeting point at (−34.3775, 0, 0) deg/s": "unstable",
                              "meeting point at (−17.1887, 0, 0) deg/s": "stable"}),
    ("torque-free-body", {"meeting point at (0, 0, 0) deg/s": "stable"}),
    ("two-wheels-minor-axis", {"fold at (−16.1737, −23.9692, 0) deg/s": "unstable",
                               "fold at (−59.1336, 57.3959, 0) deg/s": "unstable"})])
def test_a_point_between_two_pieces_of_a_curve_is_told_once_with_its_verdict(name, expected):
    """docs/mathematics/stability.md: rest of a free body is stable, a fold of a hyperbola is not; a pitchfork
    as m on the rest of its line. At the two points of the gyrostat the wheel's line meets the lines of the
    middle and of the minor axis."""
    rows = table(equilibria(load(CASES / f"{name}.toml").scene), DEG)["rows"]
    points = [row for row in rows if " at (" in row["where"]]
    assert {row["where"]: row["verdict"] for row in points} == expected and len(points) == len(expected)
    assert all(row["because"] for row in points)


def test_the_curve_of_a_motion_on_an_unstable_plane_stays_on_it():
    """By hand: x1 + 1 + x3 = 0 for ever, where a run in doubles has x3 = 15 at the end."""
    case = read_text("plane.toml", UNSTABLE_PLANE)
    drawn = _space(case)[1]["drawn"]
    (row,) = (curve for curve in drawn["curves"] if curve["kind"] == "this motion")
    x = np.array(drawn["middle"]) + drawn["half"] * _places(row["at"])
    assert np.abs(x[:, 0] + 1 + x[:, 2]).max() < max(drawn["half"]) / 4095 * 1.01 and x[-1, 1] > 12


@pytest.mark.slow
def test_a_column_of_a_sweep_that_says_nothing_is_left_out(tmp_path):
    """A charged body's motion has no separatrix to be apart from: a column of empty margins was shown."""
    page = sweep.sections(load_all(CASES / "charged-sweep.toml")[:2], tmp_path, "charged-sweep")
    assert page["heads"] == ["fate", "largest rate (deg/s)", "period (s)"]
    assert all(len(row["told"]) == 3 and all(row["told"]) for row in page["rows"])


def test_the_rates_of_a_sweep_on_an_unstable_plane_stay_on_it(tmp_path, monkeypatch):
    """By hand: the plane x1 + 1 + x3 = 0 is one of every a, x3 dies out on it and x2 grows with the time: |x|
    goes along with it."""
    file = tmp_path / "plane.toml"
    file.write_text(UNSTABLE_PLANE + "[sweep]\n\"scaled.a\" = [0.5, 0.25]\n", encoding="utf-8")
    cases = load_all(file)
    kept = []
    save = style.save
    monkeypatch.setattr(style, "save", lambda figure,
                        path: kept.extend(line.get_xydata() for line in figure.axes[0].lines)
                        or save(figure, path))
    sweep.sections(cases, tmp_path, "plane")
    assert len(kept) == 2
    for t, size in (rows.T for rows in kept):
        late = t > 3
        assert t[-1] == 8 and np.abs(np.diff(size[late]) / np.diff(t[late]) - 1).max() < 0.02


def test_the_dot_of_a_rate_is_above_its_letter():
    page = equations(load(CASES / "minor-axis-100.toml"))["equations"]
    assert all(f"<msub><mover><mi>x</mi><mo>&#x2D9;</mo></mover><mi>{n}</mi></msub><mo>=</mo>" in line for n,
               line in enumerate(page, 1))


def test_a_long_sum_goes_on_in_the_next_line_with_its_sign():
    from sympy import Add, Symbol, sympify

    from stabilab.show.report import typeset
    short, long = sympify("a + b"), Add(*(sympify(f"1.2345678*w{n}**2")
                                          for n in range(6))) - 9 * Symbol("z") ** 2
    assert "<mtr>" not in typeset.in_lines(short)
    lines = typeset.in_lines(long).split("<mtr>")[1:]
    assert len(lines) > 1 and sum(line.count("1.2345678") for line in lines) == 6
    assert all(line.split("<mrow>",
                          1)[1].startswith(("<mo>+</mo>", "<mo>&#x2212;</mo>", "<mrow><mo>&#x2212;</mo>"))
               for line in lines[1:])


def test_parameters_whose_names_are_products_are_set_as_products_and_minus_is_a_minus():
    from sympy import Integer, Symbol

    from stabilab.show.report import typeset
    assert typeset.inner(
        Symbol("Mgx")) == "<mrow><mi>M</mi><mi>g</mi><msub><mi>x</mi><mi>c</mi></msub></mrow>"
    # 2 is a power, no index
    assert typeset.inner(Symbol("eHl2")) == (
        charge := "<mrow><mi>e</mi><mi>H</mi><msup><mi>l</mi><mi>2</mi></msup></mrow>")
    assert f"<msup><mrow><mo>(</mo>{charge}<mo>)</mo></mrow><mn>2</mn></msup>" in typeset.inner(
        Symbol("eHl2") ** 2)
    assert f"<mfrac>{charge}<mn>2</mn></mfrac>" in typeset.inner(
        Symbol("eHl2") / 2) and "<mrow><mo>(" not in typeset.inner(Symbol("Mgx") / 2)
    assert typeset.inner(Integer(-3)) == "<mn>&#x2212;3</mn>" or "-" not in typeset.inner(Integer(-3))


@pytest.mark.parametrize("name, claims", [("top-fast", False), ("symmetric-body", True)])
def test_a_certificate_without_claims_is_not_said_to_be_checked(name, claims, tmp_path, undrawn):
    from stabilab.show.report import html
    page = sections(load(CASES / f"{name}.toml"), tmp_path, name, deep=False, certify=True)
    text = html.render("case.html", case=page, surface=None, pictures="", extra=(), command="", versions=())
    assert bool(page["certificate"]["findings"]) is claims
    assert ("checked by code that shares nothing" in text) is claims and (
        "makes no claim that could be checked" in text) is not claims


def test_the_imaginary_unit_and_the_base_of_the_exponential_are_plain_letters():
    from sympy import I, Symbol, exp

    from stabilab.show.report import typeset
    told = typeset.inner(exp(I * Symbol("t")))
    assert "<mi>e</mi>" in told and "<mi>i</mi>" in told and "ExponentialE" not in told
    assert "ImaginaryI" not in told


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", ["top-fast", "liquid-base", "charged-body-attitude"])
def test_every_parameter_of_the_equations_has_its_unit(name, tmp_path):
    assert [str(symbol) for symbol, value in equations(load(CASES / f"{name}.toml"))["parameters"]
            if " " not in value] == []


def test_a_page_tells_scaled_numbers_as_x_and_a_law_that_needs_no_run_has_no_steps(tmp_path, undrawn):
    page = _sections("major-axis-captured", tmp_path)
    facts = dict(page["facts"])
    assert facts["start"] == "(−1, 0, 3) at τ = 0"
    assert "|x| at the start" in facts and not any("ω" in name
                                                   for name in facts) and "steps of the run" not in facts
    assert page["over"] == "the finite ones over 0 to 50 τ" and facts["J changes by"] == "2 per unit of τ"


@pytest.mark.slow
def test_moments_certificates_limits_and_the_reduced_energy_are_told_as_what_they_are(tmp_path):
    """The kinetic energy of the gyrostat is (2000·0.1² + 1500·0.2² + 1000·0.05²)/2 = 41.25 J; that of its
    reduced motion is another number."""
    # so short a span that the release at tau = 60 is not followed
    text = (CASES / "major-axis-spin3-100.toml").read_text(encoding="utf-8")
    late = sections(read_text("late.toml", text.replace("tau = [0.0, 15.0]", "tau = [0.0, 1.0]")), tmp_path, "x",
                    deep=False)
    facts = dict(late["facts"])
    assert late["pictures"][0]["caption"].endswith(
        f" The spin-up begins later: the turn reverses for the last time at "
        f"{facts['last reversal of the turn']}.")
    assert facts["certificate holds from"].startswith("τ = 6") and facts[
        "last reversal of the turn"].startswith("τ = 6")
    assert "(proved from τ = 6" in facts["because"] and facts[
        "how it is certified"] == "the turn can reverse no more"
    assert sections(load(CASES / "major-axis-spin3-500.toml"), tmp_path, "v",
                    deep=False)["pictures"][0]["caption"].endswith("principal axes.")
    assert dict(sections(load(CASES / "major-axis-100.toml"), tmp_path, "u",
                         deep=False)["facts"])["last reversal of the turn"] == "none after the start"
    captured = dict(sections(load(CASES / "major-axis-captured.toml"), tmp_path, "y", deep=False)["facts"])
    assert captured["how it is certified"] == "the barrier ahead outgrows the energy"
    free = sections(load(CASES / "torque-free-gyrostat.toml"), tmp_path, "z", deep=False)
    assert "energy" not in dict(free["facts"]) and dict(free["facts"])["energy, reduced motion"].startswith(
        "−398.7")
    small = sections(load(CASES / "cubesat-3u.toml"), tmp_path, "w", deep=False)
    assert any(words.startswith("The limit of the case, |ω| = 60 deg/s, is reached after 16.9")
               for words in small["sensitivity"]["words"])


def test_a_limit_about_three_axes_is_named_once(tmp_path, stabilab, undrawn):
    """The limits of geostationary-22n are 5 deg/s about each axis of its file."""
    page = sections(load(CASES / "geostationary-22n.toml"), tmp_path, "x", deep=False)
    assert any(words.startswith("The limit of the case, |ωx|, |ωy| or |ωz| = 5 deg/s, is reached after 8.57")
               for words in page["sensitivity"]["words"])
    assert "reaches |ωx|, |ωy| or |ωz| = 5 deg/s in 8.579 s" in stabilab("when",
                                                                         CASES / "geostationary-22n.toml")[1]


def test_the_reason_of_an_undecided_fate_does_not_repeat_that_it_is_undecided():
    assert not _facts("charged-body-attitude")["because"].startswith("undecided")


@pytest.mark.slow
def test_limits_about_the_axes_of_the_file_have_a_caption_that_says_so(tmp_path):
    captions = {name: _sections(name, tmp_path)["pictures"][0]["caption"]
                for name in ("geostationary-22n", "cubesat-3u")}
    assert captions == {"geostationary-22n": "The rates along the axes of the file, about which its "
                                             "limits are.",
                        "cubesat-3u": "The rates along the principal axes."}


def test_the_legend_of_the_space_names_only_what_is_in_its_box():
    """The plane of unstable equilibria of this body, omega3 = 0, lies below the box about the motion at
    omega3 = 57 deg/s."""
    drawn = _space(load(CASES / "symmetric-body.toml"))[1]
    assert not any("unstable" in words for words, _ in drawn["legend"])
    assert all((np.abs(_places(row["at"])) <= 1.0).all(axis=-1).any() for row in drawn["drawn"]["curves"])


@pytest.mark.slow
def test_an_extreme_that_is_zero_but_for_rounding_is_told_as_zero(tmp_path, undrawn):
    """The start has omega2 = 0, where omega2' = 0 too, and the motion comes back to it from above: by hand
    the least omega2 is 0."""
    rows = _sections("charged-body", tmp_path)["extremes"]
    assert (rows[1]["name"], rows[1]["least"]) == ("ω2", "0 deg/s")


def test_a_page_of_a_sweep_begins_with_the_answer_of_the_commands_and_tells_the_farthest_of_its_laws(
    stabilab, tmp_path):
    path = CASES / "charged-sweep.toml"
    found = sweep.sections(load_all(path), tmp_path, "charged-sweep")
    first = stabilab("fate", path)[1].splitlines()[0]
    assert first.endswith(f"; by that law: charged-sweep: {found['headline']}")
    assert found["headline"].startswith(
        "27 combinations: each BOUNDED only while the torque is exactly along x ")
    assert law.of_cases(load_all(path)) == found["law"] and "27 of 27 combinations" in found["law"]


def test_the_legend_of_the_space_names_no_branch_of_which_the_box_holds_only_the_crest():
    """The two loops of a double well meet in its saddles, of which those in the box of this motion, in the
    left well, belong to both."""
    names = [name for name, _ in _space(load(CASES / "middle-axis-double-well.toml"))[1]["legend"]]
    assert "Branch 1, left loop of the separatrix" in names and not any("right loop" in name for name in names)
    assert "unstable equilibria" in names and "nearest point of the separatrix" in names


def test_equilibria_of_undecided_stability_are_not_drawn_as_stable():
    """Oracle: the verdicts of all pieces, which are undecided, though their linear ones are centres."""
    case = load(CASES / "charged-body-attitude.toml")
    found = equilibria(case.scene)
    assert {(piece.linear, piece.verdict) for curve in found.curves
            for piece in curve.segments} == {("stable", "undecided")}
    legend = dict(_space(case)[1]["legend"])
    assert "equilibria of undecided stability" in legend and "stable equilibria" not in legend


def test_the_trend_of_an_energy_tells_what_it_compares():
    """major-axis-spin3-500 spins up: its energy has turned before the end of the run, and yet is below that
    of the beginning."""
    for name, words in (("major-axis-spin3-500",
                         "lower in the last quarter of the run than ever in the first"),
                        ("off-axis-one", "up and down: the last quarter of the run overlaps with the first")):
        assert _facts(name)["the energy"] == words


def test_a_margin_to_other_bounded_motions_is_not_told_as_one_that_changes_the_fate(tmp_path, undrawn):
    """Without a torque, and about the middle axis with walls on both sides, every motion is bounded; beyond
    the barrier of a minor axis it spins up."""
    for name, same in (("torque-free-body", True), ("middle-axis-double-well", True),
                       ("minor-axis-100", False)):
        (row,) = _sections(name, tmp_path)["sensitivity"]["rows"]
        assert ("does not change the fate" in row["because"]) == same


@pytest.mark.parametrize("name, kinds", [
    ("cubesat-3u", {"time", "tilt", "wheel", "body"}), ("torque-free-body", {"time", "phase", "potential", "sphere",
                                                                             "equilibria"}),
    ("symmetric-spin-up", {"time", "phase", "potential", "body"})])
def test_a_page_has_the_pictures_that_no_other_part_of_it_makes_redundant(name, kinds, tmp_path, monkeypatch):
    """Of cubesat-3u two single equilibria stand in the table; the plane of symmetric-spin-up is what its
    cylinder would show; nothing acts on the body without a torque."""
    monkeypatch.setattr(drawn.to_file, "write_all", lambda one, path, *given, **named: [path])
    monkeypatch.setattr(drawn, "picture", lambda made, *given, **words: words)
    case = load(CASES / f"{name}.toml")
    found = drawn.pictures(subject(case), tmp_path, name, True, at_rest=equilibria(case.scene))
    assert {one["kind"] for one in found} == kinds


@pytest.mark.parametrize("name, limit", [("cubesat-3u", 60.0), ("upper-stage", 120.0), ("space-station", 0.5)])
def test_the_limit_is_a_sphere_of_its_size_about_zero_where_the_picture_comes_near_it(name, limit):
    """Oracle: the length of each place, in deg/s as the file states the limit."""
    found = space_of(subject(load(CASES / f"{name}.toml")), "123", ("deg/s", 180 / np.pi))
    arcs = [places for words, places in found.curves if words == f"limit of |ω|, {limit:g} deg/s"]
    places = np.degrees(np.concatenate(arcs))
    assert np.linalg.norm(places, axis=1) == pytest.approx(np.full(len(places), limit), rel=1e-12)
    assert found.box.holds(np.radians(places).max(axis=0), 1 + 1e-9) and found.box.holds(
        np.radians(places).min(axis=0), 1 + 1e-9)
    assert "limit" in str(found.legend)


def test_a_limit_far_from_the_motion_is_not_in_its_picture():
    """The wobble of half a degree a second about 1.7 deg/s is seen at its own size; the limit is at 40."""
    case = load(CASES / "thruster-stuck-major-axis.toml")
    text = case.text + '\n[limits]\nrate = "40 deg/s"\n'
    near, far = (space_of(subject(one), "123", ("deg/s", 180 / np.pi))
                 for one in (case, read_text("far.toml", text)))
    assert near.box == far.box and near.curves == far.curves
    wide = space_of(subject(read_text("wide.toml", text)), "123", ("", 1.0), most=math.inf)  # 700 deg/s
    assert not [words for words, _ in wide.curves if "limit" in words]


@pytest.mark.parametrize("middle, half, least, told", [
    (0.0, 54000.0, 3, [-40000, -20000, 0, 20000, 40000]), (0.0, 1.45e-4, 3, [-1e-4, 0, 1e-4]),
    (8550.0, 80.0, 3, [8500, 8550, 8600]), (8550.0, 80.0, 2, [8500, 8600])])
def test_numbers_at_an_edge_are_round_and_keep_off_the_corners(middle, half, least, told):
    box = Box((middle,) * 3, (half,) * 3)
    assert box.ticks(0, least) == pytest.approx(told)
