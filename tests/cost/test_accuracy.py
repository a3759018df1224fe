"""What accuracy costs: the reference knows its own error, counters are exact, and outputs say what was
measured."""
import csv
import json
import math
from dataclasses import replace
from types import SimpleNamespace

import mpmath as mp
import numpy as np
import pytest

from stabilab import load
from stabilab.answers import digits_run as precision_digits
from stabilab.answers.digits_run import best_reached
from stabilab.cost import accuracy as measuring
from stabilab.cost.accuracy import Point, digit_price, pareto, precision
from stabilab.cost.methods import methods, problem
from stabilab.integrate.reference import reference, relative_errors
from stabilab.physics.body import Body
from stabilab.physics.effects.gyrostat import Gyrostat
from stabilab.physics.equations import derive
from stabilab.physics.scene import Scene
from stabilab.processes import machine
from stabilab.show import precision as precision_page
from stabilab.show import precision as shown
from stabilab.show import precision_overview, style
from tests.oracles.model import physical
from tests.oracles.taylor import integrate_checked
from tests.shared import CASES, case

FREE = load(CASES / "torque-free-body.toml")


def sums(found):
    """States of a reference as mpmath numbers."""
    return [[mp.mpf(float(a)) + mp.mpf(float(b)) for a, b in zip(*rows)]
            for rows in zip(found.states, found.rest)]


# -- the reference


def test_reference_of_a_sphere_with_a_wheel_turns_at_the_wheels_rate():
    # D omega' = lambda x omega: a turn at the rate |lambda|/D about lambda, a circle in closed form.
    times = np.array([0.25, 7.0, 1e6])  # the last is folded by the period
    found = reference(Scene(Body((2, 2, 2)), Gyrostat((0, 0, 3))), (1.0, 0.5, 0.25), times, orbit=True)
    with mp.workdps(45):
        for t, state in zip(times, sums(found)):
            c, s = mp.cos(mp.mpf(3) / 2 * float(t)), mp.sin(mp.mpf(3) / 2 * float(t))
            exact = [c - s / 2, s + c / 2, mp.mpf(1) / 4]
            assert max(abs(a - b) for a, b in zip(state, exact)) <= 10 * max(found.error.max(), 1e-31)
        assert found.error.max() < 1e-22 and found.work < 1e5
        high, low, error = found.period
        assert abs(mp.mpf(high) + mp.mpf(low) - 4 * mp.pi / 3) <= 10 * max(error, 1e-31) * high
        top = mp.sqrt(mp.mpf(5) / 4)
        for component, (low, high) in enumerate(((-top, top), (-top, top), (mp.mpf(1) / 4,) * 2)):
            for side, exact in enumerate((low, high)):
                value = (mp.mpf(found.extremes[component, side, 0])
                         + mp.mpf(found.extremes[component, side, 1]))
                assert abs(value - exact) <= 10 * max(found.extremes_error, 1e-31)


def test_reference_agrees_with_another_taylor_series_on_a_spin_up():
    # tests/oracles/taylor.py: mpmath, its own recursion and equations.
    scene, start, times = case("thruster-negative-minor-axis").scene, (0.5, -0.25,
                                                                       0.125), np.array([2.0, 5.0])
    found = reference(scene, start, times)
    lam, torque = (tuple(scene.vector(name)) for name in ("gyrostat", "constant_torque"))
    with mp.workdps(50):
        states, gap = integrate_checked(physical(scene.body.exact, lam, torque), start, times, 30)
        worst = max(abs(a - b) for xs, ys in zip(states, sums(found)) for a, b in zip(xs, ys))
        assert worst <= gap + 10 * max(found.error.max(), 1e-31) * np.abs(found.states).max()


def test_reference_says_where_its_digits_end():
    # the work allowed reaches no further; what is returned agrees, what does not is left out
    whole = reference(FREE.scene, FREE.state, np.linspace(1, 60, 12))
    short = reference(FREE.scene, FREE.state, np.linspace(1, 60, 12), work=whole.work // 2)
    assert whole.status == "agrees" and len(whole.t) == 12 and whole.work > 0
    # a third of the work is the first run's, so that the second can confirm what it reached
    assert short.status == "stopped" and 0 < len(short.t) < 12 and "60" in short.because
    assert np.array_equal(short.states, whole.states[:len(short.t)]) and (short.error <= 1e-19).all()
    assert reference(FREE.scene, FREE.state, [1.0], work=10).t.size == 0


def test_reference_runs_backwards_too():
    there = reference(FREE.scene, FREE.state, [5.0])
    back = reference(FREE.scene, there.states[0], [-5.0])
    assert np.abs(back.states[0] - FREE.state).max() < 1e-14  # the state at 5, rounded once, went back


# -- the methods


def test_scipy_counters_are_scipys_own():
    from scipy.integrate import solve_ivp
    task = problem(FREE, 4)
    rk = next(m for m in methods(task) if m.name == "RK45")
    answer = rk.prepare(task, 1e-6)(task.times[-1:])
    size = max(abs(v) for v in task.start)
    run = solve_ivp(lambda t, y: task.system(y), (0, task.times[-1]), task.start, method="RK45", rtol=1e-6,
                    atol=1e-9 * size)
    assert (answer.steps, answer.evaluations) == (len(run.t) - 1, run.nfev)
    assert np.allclose(answer.parts["omega"][-1], run.y[:, -1], rtol=0, atol=1e-15)


def test_taylor_counts_steps_times_order():
    pytest.importorskip("heyoka")
    task = problem(FREE, 4)
    both = {m.name: m.prepare(task, 1e-9)(task.times) for m in methods(task) if m.name.startswith("taylor")}
    one, batch = both["taylor"], both["taylor-batch"]
    assert one.steps > 1 and one.evaluations % one.steps == 0 and one.evaluations // one.steps > 5
    assert np.abs(one.parts["omega"] - batch.parts["omega"]).max() < 1e-7  # the lane that is the motion


def test_every_model_of_a_case_is_among_the_methods():
    names = {m.name for m in methods(problem(case("top-fast"), 4))}
    assert {"lindstedt", "printed", "RK45", "Radau", "LSODA"} <= names and "reduced" not in names


# -- the measurement


@pytest.fixture(scope="module")
def measured():
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(measuring.EFFORTS, "quick", replace(measuring.EFFORTS["quick"], evaluations=3000))
        return precision(FREE, "quick")


@pytest.mark.slow
def test_every_question_of_a_periodic_motion_is_measured(measured):
    assert measured.questions == ["span", "end", "extremes", "period"]
    for question in ("span", "end"):
        assert {"RK45", "RK23", "DOP853", "Radau", "BDF", "LSODA",
                "reduced"} <= {p.method for p in measured.of(question)}
    assert {"reduced", "balls"} <= {p.method for p in measured.of("period")}
    assert [f.word for f in measured.fates if f.method == "energy"] == ["bounded"]


def test_tighter_tolerances_leave_smaller_errors_for_more_evaluations(measured):
    for name in ("RK45", "RK23", "DOP853"):
        points = measured.of("span", name)
        assert len(points) >= 2
        assert all(a.error > b.error and a.evaluations < b.evaluations for a, b in zip(points, points[1:]))


def test_no_error_is_below_the_references_own(measured):
    assert all(p.error >= measured.reference.error.max() for p in measured.of("span"))
    best = min(p.error for p in measured.points)
    assert 1e-18 < best < 1e-14  # doubles


def test_settings_that_would_cost_too_much_are_named(measured):
    assert measured.left_out and all(value < 1e-3 and "evaluations" in why for _, value,
                                     why in measured.left_out)


def test_sensitivity_is_that_of_the_phase():
    # D = (1, 1, 2): omega1, omega2 turn at the rate omega3, so a change of omega3 by d turns them by d t:
    # shift d t against
    # the length sqrt 2; largest components are within sqrt 2 of lengths.
    body, start = Scene(Body((1, 1, 2))), np.array([1.0, 1.0, 1.0])
    task = SimpleNamespace(start=start, equations=derive(body), slices={"omega": slice(0, 3)})
    late, early = (measuring._sensitivity(task, reference(body, start, [t])) for t in (100.0, 0.01))
    assert 50 < late < 200 and 0.4 < early < 2.5


def point(digits, seconds, **other):
    fields = {"question": "end", "method": "RK45", "setting": "rtol", "value": 1.0, "error": 10.0**-digits,
              "steps": 1, "evaluations": 1,
              "seconds": seconds, "slowest": seconds, "repeats": 1, "compile": 0.0}
    return Point(**(fields | other))


def test_front_keeps_what_no_other_beats():
    a, b, worse, c, nothing = point(3, 1.0), point(6, 2.0), point(5, 3.0), point(9, 4.0), point(-1, 0.1)
    assert pareto([worse, c, b, nothing, a]) == [a, b, c]
    assert nothing.digits == 0 and point(0, 1.0, error=math.inf).digits == 0


def test_price_of_a_digit_is_the_slope_of_the_logarithm():
    assert digit_price([point(d, 1e-3 * 1.5**d) for d in (2, 4, 7, 11)]) == pytest.approx(1.5, rel=1e-9)
    assert digit_price([point(5, 1.0)]) is None and digit_price([point(5, 1.0), point(5.5, 9.0)]) is None
    # a rung at the floor of rounding buys nothing and is no part of the slope
    assert digit_price([point(2, 4.0), point(4, 16.0), point(4.01, 900.0)]) == pytest.approx(2.0)


# -- outputs


def test_words_tell_price_reference_and_limit(measured):
    said = " ".join(shown.words(measured))
    assert "digits cost" in said and "Taylor series run in 30 and in 42 digits" in said
    assert "One more digit" in said
    assert "nan" not in said.lower() and "inf " not in said


def test_csv_has_a_line_for_every_point(measured):
    rows = list(csv.DictReader(shown.csv(measured).splitlines()))
    assert len(rows) == len(measured.points) and set(rows[0]) == {*shown.COLUMNS, "caveats"}
    for row, p in zip(rows, measured.points):
        assert (row["method"], float(row["error"]), float(row["seconds"])) == (p.method, p.error, p.seconds)


def test_the_table_by_digits_has_the_cheapest_and_the_second_best_of_the_points(measured):
    """By a search of its own through the points; 30 digits only the reference has, which is none of them."""
    rows = {row["digits"]: row for row in shown.by_digits(measured)}
    states = [p for p in measured.of("span") if p.lanes == 1 and not p.parts]
    for digits in (3, 6, 9, 12):
        times = {}
        for p in states:
            if p.digits >= digits:
                times[p.method] = min(p.seconds, times.get(p.method, math.inf))
        if not times:
            assert rows[digits]["method"] == "reference"
            continue
        first, *others = sorted(times, key=times.__getitem__)
        assert rows[digits]["method"] == first and rows[digits]["seconds"] == times[first]
        assert (rows[digits]["second"] or {}).get("method") == (others[0] if others else None)
        assert rows[digits]["relative"] == times[first] / rows[3]["seconds"]
    assert rows[30]["method"] == "reference" and rows[30]["seconds"] == measured.reference_seconds > 0
    for digits in (3, 6, 9, 12):  # a first run: import, compiling and the run, by a search of its own
        firsts = [p.loading + p.compile + max(p.opening, p.seconds) for p in states if p.digits >= digits]
        once = rows[digits]["once"]
        assert once["first_seconds"] == min([*firsts, *[measured.reference_seconds] * (len(firsts) < 1)])
        assert once["first_seconds"] >= once["seconds"]
    assert shown.as_dict(measured)["by_digits"] == list(rows.values())
    assert " first run " in shown.text(measured) and " again " in shown.text(measured) and "  method " not in shown.text(measured)
    assert len(shown.text(measured).splitlines()) < 22
    assert " first run " in shown.text(measured, True) and "  method " in shown.text(measured, True)


def test_page_has_words_of_every_case_and_a_picture_of_every_kind(tmp_path, monkeypatch, measured):
    one = replace(measured, points=tuple(measured.of("span")))  # a small picture
    efforts, told = [], []
    monkeypatch.setattr("stabilab.cost.accuracy.precision", lambda case,
                        effort: efforts.append(effort) or replace(one, case=case))
    other = replace(FREE, state=(0.3, 0.2, 0.1), title="the same equations")
    path = precision_page.page([FREE, other, replace(FREE, span=None)], tmp_path, told.append)
    html = path.read_text(encoding="utf-8")
    assert path == tmp_path / "precision.html" and told[0] == "precision of torque-free-body" and efforts == [
        "brief", "glance"]
    assert "six digits cost" in html and html.count("<img") == 2 and "no motion with a span" in html
    assert (tmp_path / "precision" / "torque-free-body.png").stat().st_size > 5000
    assert (tmp_path
            / "precision" / "torque-free-body.csv").exists() and "precision/torque-free-body.csv" in html
    assert f"{measured.reference.error.max():.0e}".replace("-", "−") in html  # the reference's own error


def test_command_answers_in_strict_json(stabilab, monkeypatch, tmp_path, measured):
    monkeypatch.setattr("stabilab.commands.one_case.measure", lambda case, effort, until=None: measured)

    def refuse(word):
        raise AssertionError(word)
    points = tmp_path / "p.csv"
    code, out, err = stabilab("precision", CASES / "torque-free-body.toml", "--quick", "--json", "--out",
                              points)
    answer = json.loads(out, parse_constant=refuse)
    assert code == 0 and answer["schema"] == "stabilab.precision/1" and str(
        points) in err and points.read_text() == shown.csv(measured) + "\n"
    assert len(answer["points"]) == len(measured.points) and answer["reference"]["status"] == "agrees"
    assert {"processor", "cores", "system"} <= answer["machine"].keys() and answer["versions"]["stabilab"]


def test_command_takes_another_end_of_the_span(stabilab, monkeypatch, measured):
    given = []
    monkeypatch.setattr("stabilab.commands.one_case.measure", lambda case, effort,
                        until=None: given.append((effort, until)) or measured)
    code, out, _ = stabilab("precision", CASES / "torque-free-body.toml", "--until", "1500", "--csv")
    assert code == 0 and given == [("full", 1500.0)] and out.startswith("case,question,method")


def test_a_case_without_a_span_is_measured_over_three_periods(stabilab, monkeypatch, tmp_path, case_file, measured):
    """A body of revolution: in the body its rates go round at (C - A) omega3/A."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    given = []
    monkeypatch.setattr("stabilab.commands.one_case.measure", lambda case, effort, until: given.append(until)
                        or measured)
    path = case_file("body.inertia = [2, 2, 3]\nmotion.angular_velocity = [0.1, 0, 0.5]\n", "own")
    assert stabilab("precision", path)[0] == 0 and given == [pytest.approx(3 * 2 * np.pi / 0.25)]


# -- digits asked for


@pytest.fixture(scope="module")
def judged():
    """Case name -> (case, times, reference) of the paper's motions."""
    found = {}
    for name in ("minor-axis-100", "middle-axis-300", "major-axis-500", "major-axis-captured"):
        one, times = case(name), np.array([0.0, 2.0, 6.0])
        found[name] = one, times, reference(one.scene, one.state, times)
    return found


@pytest.mark.one_in(3)
@pytest.mark.parametrize("digits", [3, 6, 9, 12, 15])
def test_digits_asked_for_are_reached(judged, digits):
    # against the reference in many digits, which the check itself does not use below 15
    for name, (one, times, exact) in judged.items():
        reached = best_reached(one, times, digits)
        error = relative_errors(reached.run.state["x"], exact.states, exact.rest, exact.slices).max()
        assert error <= 10.0**-digits and reached.digits >= digits, name
        assert error <= 10.0**-reached.digits * 1.01 + 2.0**-53, name  # what it says of itself holds


def test_digits_that_nothing_reaches_end_with_5_after_the_states_that_come_nearest(stabilab,
                                                                                   monkeypatch):
    # off an unstable plane by rounding: not one digit is sure, so it is no answer whether or not digits were
    # asked for
    # those that this motion takes cost seconds
    monkeypatch.setattr("stabilab.integrate.reference.RUN_DIGITS", (30, 42))
    for options, wanted in (((), 5), (("--digits", "10"), 5)):
        code, out, err = stabilab("simulate", CASES / "middle-axis-spin-up.toml", "--at", "0,20", "--json",
                                  *options)
        told = json.loads(out)
        assert code == wanted and "no digit of the state is known at t = 20" in err
        assert told["digits"]["asked"] == 10 and told["digits"]["reached"] < 3
        assert told["t"] == [0.0] and len(told["state"]["x"]) == 1


def test_an_attitude_is_followed_in_many_digits_too():
    # against the closed form of a ball that spins about axis 3 without torque: theta = 2 t, many turns of it
    ball = replace(case("charged-body"), scene=Scene(Body((2, 2, 2), mass=1)), state=(0.0, 0.0, 2.0),
                   blocks={"attitude": (0.0, 0.0, 0.0), "velocity": (1.0, 0.0, 0.0),
                           "position": (0.0, 0.0, 0.0)})
    times = np.array([0.0, 1.0, 30.0])
    found = precision_digits._many_digits(ball, times, 15)
    assert np.abs(found.run.state["angles"][:, 2] - 2 * times).max() < 1e-14 and found.digits >= 15
    assert np.abs(found.run.state["position"][:, 0]
                  - times).max() < 1e-14 and list(found.run.state)[:3] == ["omega", "angles", "momentum"]


def test_models_are_judged_on_the_attitude():
    # a model whose angles are the exact ones, given with the other sign of the quaternion, has no error in
    # the attitude
    one = case("charged-body-small-torque")
    task = problem(one, 2)
    exact = reference(one.scene, task.start, task.times, task.equations.blocks, work=60_000_000)
    answer = SimpleNamespace(parts={"attitude": -exact.states[:, task.slices["attitude"]]})
    assert measuring._state_error(task, answer, exact, 2) < 1e-15
    wrong = SimpleNamespace(parts={"attitude": exact.states[::-1, task.slices["attitude"]]})
    assert measuring._state_error(task, wrong, exact, 2) > 1e-3
    linear = next(m for m in methods(task) if m.name == "linear")
    assert "attitude" in linear.prepare(task, 1)(task.times).parts


def test_simulate_tells_the_digits_and_how_they_were_checked(stabilab):
    path = CASES / "minor-axis-100.toml"
    code, out, _ = stabilab("simulate", path, "--at", "0,5", "--digits", "9", "--json")
    told = json.loads(out)["digits"]
    assert code == 0 and told["asked"] == 9 and told["reached"] >= 9 and "last place" in told["because"]
    code, out, _ = stabilab("simulate", path, "--at", "0,5", "--digits", "9")
    assert code == 0 and "digits: " in out.splitlines()[-1]
    told = json.loads(stabilab("simulate", path, "--at", "0,5", "--json")[1])["digits"]
    assert told["asked"] == 10 and told["reached"] >= 10
    assert json.loads(stabilab("simulate", path, "--at", "0,5", "--json", "--rtol",
                               "1e-4")[1])["digits"] is None


@pytest.mark.parametrize("options",
                         [("--digits", "16"), ("--digits", "0"), ("--digits", "6", "--rtol", "1e-3"),
                                     ("--digits", "6", "--method", "RK45")])
def test_digits_that_make_no_sense_are_refused(stabilab, options):
    code, out, err = stabilab("simulate", CASES / "minor-axis-100.toml", "--at", "1", *options)
    assert code == 2 and not out and "digits" in err


@pytest.mark.slow
def test_a_start_on_an_unstable_plane_is_beyond_doubles_but_not_beyond_many_digits(monkeypatch):
    # On the plane x1 + b = -x3 (a law of the equations, see `show`) the distance from pure spin obeys u' =
    # -x2 u: it dies out.
    # Off it by rounding, the distance grows as fast.
    one = case("middle-axis-spin-up")
    reached = best_reached(one, np.array([0.0, 12.0]), 10)
    assert reached.run.method == "many digits"
    x1, x2, x3 = reached.run.state["x"][-1]
    assert abs(x1 + one.scene.b) < 1e-20 and abs(x3) < 1e-20 and x2 > 5
    monkeypatch.setattr("stabilab.integrate.reference.RUN_DIGITS", (30, 42))  # too few
    assert not best_reached(one, np.array([0.0, 20.0]), 10).enough


def test_a_first_run_pays_for_the_start_of_its_integrator_and_a_formula_does_not(measured):
    """The start is measured once a process: the same for all settings of SciPy."""
    from stabilab.cost.loading import loading
    assert loading("reduced") == loading("balls") == 0.0
    assert loading("DOP853") == loading("RK45") > 0.0
    for p in measured.points:
        assert p.loading == loading(p.method) and p.first >= p.loading + p.compile + p.seconds


def test_the_overview_has_at_most_five_curves_and_no_name_of_a_machine(measured, tmp_path):
    curves = precision_overview.drawn(measured)
    assert 3 <= len(curves) <= precision_overview.MANY and "reference" in curves
    for method, rows in curves.items():
        assert rows == sorted(rows) and all(0 < again <= once for _, again, once in rows), method
        if method != "reference":
            points = {(p.digits, p.seconds, p.first) for p in measured.of("span", method)}
            assert set(rows) <= points
    with style.drawing() as plt:
        figure = precision_overview.picture(plt, measured)
        ax, = figure.axes
        texts = [text.get_text() for text in ax.texts if text.get_text()]  # without lines that lead to names
        assert {"1 ms", "1 s", *(precision_overview.CURVES[name][1] for name in curves)} == set(texts)
        assert len(ax.lines) == 2 * len(curves) - 1 + 2  # again and first, one point, two rules
        printed = " ".join([*texts, ax.get_title(), *(t.get_text() for t in figure.legends[0].texts)])
        assert "30 digits" in ax.get_title() and machine()["processor"] not in printed
    assert machine()["processor"] not in str(shown.meanings(measured))
    assert precision_overview.write(measured, tmp_path / "x.svg").stat().st_size > 1000


def test_overview_wants_a_picture(stabilab):
    code, _, err = stabilab("precision", CASES / "torque-free-body.toml", "--overview")
    assert code == 2 and "--out FILE.png" in err
