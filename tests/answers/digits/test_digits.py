"""Digits asked for: extremes, period, fate and states have them, say how many were shown, and cost more where
more are wanted."""
import json
from dataclasses import replace
from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest

from stabilab import extremes, fate, period, trajectory
from stabilab.answers import digits as precision_questions
from stabilab.answers import digits_run as precision_digits
from stabilab.answers.digits import ask, ask_all
from stabilab.answers.digits_asked import Told
from stabilab.answers.digits_run import best_reached
from stabilab.errors import InputError, ToleranceNotMet
from tests.oracles import energy
from tests.oracles.model import physical, scaled
from tests.shared import CASES, case


def model(one):
    """The oracle's equations of a case (tests/oracles/model.py, shared with nothing in the package)."""
    s = one.scene
    return (scaled(*s.exact_ab, s.exact_mu) if one.variables == "scaled"
            else physical(s.body.exact, s.vector("gyrostat"), s.vector("constant_torque")))


def apart(told, exact):
    """Largest distance relative to the component's size; decimals are read in 60 digits where there are some.
    """
    with mp.workdps(60):
        rows = told.decimals if told.decimals is not None else told.values
        worst = mp.mpf(0)
        for row, pair in zip(np.atleast_2d(np.array(rows, dtype=object)),
                             np.atleast_2d(np.array(exact, dtype=object))):
            size = max(abs(v) for v in pair if mp.isfinite(v))
            worst = max([worst, *(abs(mp.mpf(v) - e) / size for v, e in zip(row, pair) if mp.isfinite(e))])
        return worst


@pytest.mark.one_in(3)
@pytest.mark.parametrize("digits", [3, 12, 30, *(pytest.param(n, marks=pytest.mark.slow) for n in (9, 15))])
@pytest.mark.parametrize("name", ["minor-axis-100", "middle-axis-double-well", "two-wheels-minor-axis"])
def test_extremes_period_and_margin_have_the_digits_asked_for(name, digits):
    # the reduced potential in mpmath (tests/oracles/energy.py)
    one = case(name)
    exact = {"extremes": energy.extremes(model(one), one.state, digits=60),
             "fate": energy.margin(model(one), one.state, digits=60),
             "period": energy.period(model(one), one.state, digits=60, nodes=60)}
    for question, value in exact.items():
        told = ask(question, one.scene, one.start, digits)
        assert told.enough and told.digits >= digits, question
        assert apart(told, value) <= mp.mpf(10) ** -digits, question
        assert (told.decimals is None) == (digits
                                           <= 15) and told.method == ("formulas" if digits <= 11 else "balls")


def test_formulas_that_fall_short_leave_the_answer_to_balls():
    # what motion found is spoilt in the ninth digit: six digits are still told of it, ten come from elsewhere
    one = case("minor-axis-100")
    good = ask("period", one.scene, one.start, 10)
    from stabilab.answers.motion import motion
    spoilt = replace(motion(one.scene, one.start), period=good.values * (1 + 3e-9))
    coarse, fine = ask("period", one.scene, one.start, 6, None,
                       spoilt), ask("period", one.scene, one.start, 10, None, spoilt)
    assert coarse.method == "formulas" and 8.4 < coarse.digits < 8.6
    assert fine.method == "balls" and fine.values == pytest.approx(good.values, rel=1e-15)


def test_extremes_without_a_reduction_agree_with_many_digits_over_the_span():
    # off the axes: the same span in the oracle's arithmetic is the run in many digits itself, at another
    # precision
    one = case("off-axis-two")
    told, many = (ask("extremes", one.scene, one.start, n, one.span) for n in (10, 20))
    assert told.method == "run" and many.method == "many digits" and many.digits >= 20
    assert apart(told, [[mp.mpf(v) for v in row] for row in many.decimals]) <= 10.0**-10
    assert apart(told, [[mp.mpf(v) for v in row] for row in many.decimals]) <= 10.0**-told.digits


def test_the_period_of_a_closed_motion_without_a_reduction_is_its_return_in_many_digits():
    # a wheel along all three axes; the return of tests/oracles/taylor.py is its own recursion in mpmath
    from stabilab.physics.body import Body
    from stabilab.physics.effects.gyrostat import Gyrostat
    from stabilab.physics.scene import Scene
    from tests.oracles.taylor import integrate_checked
    scene, start = Scene(Body((2, 3, 4)), Gyrostat((0.5, 0.25, 1.0))), (1.0, 0.5, 0.25)
    told = ask("period", scene, start, 20)
    with mp.workdps(40):
        (back,), gap = integrate_checked(physical((2, 3, 4), (0.5, 0.25, 1.0)), start,
                                         [mp.mpf(told.decimals)], 25)
        assert max(abs(a - mp.mpf(b)) for a, b in zip(back, start)) < 1e-18 + gap
    assert ask("period", scene, start, 10).method == told.method == "balls"
    assert ask("extremes", scene, start, 20).method == "many digits"


def test_arrays_are_checked_on_a_sample_and_redone_where_it_falls_short():
    one = case("minor-axis-100")
    states = np.asarray(one.state) + np.random.default_rng(3).normal(size=(40, 3)) * 0.05
    told = ask_all("period", one.scene, states, 9, period(one.scene, states))
    assert told.values.shape == (40,) and "16 of 40 states checked" in told.because
    assert np.array_equal(extremes(one.scene, states, digits=9), extremes(one.scene, states))
    fine = period(one.scene, states[:3], digits=14)
    for state, value in zip(states[:3], fine):
        assert float(abs(energy.period(model(one), tuple(state), digits=40) - value)) <= 1e-14 * value
    assert ask_all("fate", one.scene, states[0], 20, fate(one.scene, states[0]).margins).decimals.shape == ()
    decided = fate(one.scene, states[:3], digits=15)
    assert (decided.labels == fate(one.scene, states[:3]).labels).all()
    for state, margin in zip(states[:3], decided.margins):
        assert abs(energy.margin(model(one), tuple(state), digits=40) - margin) <= 1e-15 * abs(margin)


def test_digits_that_are_not_reached_raise():
    with pytest.raises(ToleranceNotMet, match="12 digits asked for, 7 reached"):
        Told("period", 1.0, 12, 7.0, "run", reason="a check").required()
    for wrong in (0, 10_001, 2.5, True, "30"):
        with pytest.raises(InputError, match="digits"):
            period(case("minor-axis-100").scene, case("minor-axis-100").state, digits=wrong)


# -- commands


def test_commands_tell_digits_and_write_out_what_doubles_cannot_hold(stabilab):
    path = CASES / "minor-axis-100.toml"
    # of the decimals as written
    exact = energy.period(model(case("minor-axis-100")), case("minor-axis-100").exact_state, digits=60,
                          nodes=60)
    answer = json.loads(stabilab("period", path, "--digits", "30", "--json")[1])[0]
    with mp.workdps(60):
        assert answer["schema"] == "stabilab.period/1"
        assert abs(mp.mpf(answer["digits"]["decimals"]) - exact) < mp.mpf(10) ** -29
    code, out, err = stabilab("period", path, "--digits", "30")
    assert code == 0 and answer["digits"]["decimals"] in out and "digits: ball" in out and not err
    answer = json.loads(stabilab("fate", path, "--json")[1])[0]
    assert answer["schema"] == "stabilab.fate/1" and answer["fate"] == "bounded" and answer["digits"][
        "reached"] >= 10
    rows = stabilab("extremes", path, "--digits", "20", "--csv")[1].splitlines()
    assert len(rows) == 4 and all(len(cell.strip("-").replace(".", "")) >= 19 for row in rows[1:]
                                  for cell in row.split(",")[2:4])


def test_ten_digits_are_the_default_and_cost_nothing_where_formulas_bound_their_error(stabilab, monkeypatch):
    monkeypatch.setattr(precision_questions, "ask", lambda *_: pytest.fail("checked"))
    for command in ("extremes", "period"):
        told = json.loads(stabilab(command, CASES / "minor-axis-100.toml", "--json")[1])[0]["digits"]
        assert told["asked"] == 10 and told["reached"] >= 11 and "bound" in told["because"]


def test_too_few_digits_end_with_5_after_the_answer(stabilab, monkeypatch):
    few = lambda q, scene, state, digits, span, known, exact=None, tell=None: Told(q, known.period, digits, 4.0, "run",
                                                                        reason="a check")
    monkeypatch.setattr(precision_questions, "ask", few)
    code, out, err = stabilab("period", CASES / "minor-axis-100.toml", "--digits", "12")
    assert code == 5 and "1.8043122475" in out and "12 digits asked for, 4 reached" in err


# -- far times, and digits that nobody asked for


def home(one, t):
    """The state at t by its period in balls of 40 digits: the times folded exactly, the rest followed."""
    told = ask("period", one.scene, one.start, 40, exact=tuple(map(Fraction, one.state)))
    P = Fraction(told.decimals)
    return trajectory(one.scene, one.state, [float(Fraction(t) - P * (Fraction(t) // P))]).states[0]


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name, t, digits", [("minor-axis-100", 1e6, 8), ("minor-axis-100", 1e8, 6),
                                             ("middle-axis-double-well", 1e8, 5),
                                             ("torque-free-body", 1e9, 6)])
def test_far_times_are_reached_by_the_reduced_form_and_its_digits_are_true(name, t, digits):
    one = case(name)
    found = best_reached(one, [t], digits)
    assert found.enough and found.run.method == "reduced form"
    exact = home(one, t)
    error = np.abs(next(iter(found.run.state.values()))[0] - exact).max() / np.abs(exact).max()
    assert error <= 10.0 ** -min(found.digits, 14)  # by the period in 40 digits


def test_a_check_of_the_reduced_form_sees_what_a_rounded_period_costs():
    # at t = 1e9 a period rounded to doubles, 1e-16 of it, is off by some 1e-7 of the time: no more than nine
    # digits can be true
    one = case("torque-free-body")
    assert best_reached(one, [1e9], 6).digits < 9.5 < best_reached(one, [1e5], 6).digits


def test_asking_too_much_of_far_times_ends_at_once(monkeypatch):
    monkeypatch.setattr(precision_digits, "_many_digits", lambda *_: pytest.fail("many digits"))
    found = best_reached(case("minor-axis-100"), [1e9], 14)
    assert not found.enough and found.run.status == "reached" and found.run.method == "reduced form"


def test_steps_that_stop_leave_the_reduced_form(monkeypatch):
    monkeypatch.setattr(precision_digits, "LONG_TURN", 1e300)  # the run is tried first
    monkeypatch.setattr("stabilab.integrate.trajectory.REPORT", 1000)
    monkeypatch.setattr("stabilab.integrate.trajectory.STEP_LIMIT", 1000)
    found = best_reached(case("minor-axis-100"), [1e6], 6)
    assert found.enough and found.run.method == "reduced form"


def test_digits_that_nobody_asked_for_are_an_aim_told_with_exit_0(stabilab, monkeypatch):
    real = precision_digits._checked

    def short(*arguments):
        found = real(*arguments)
        return found and replace(found, digits=9.4)
    monkeypatch.setattr(precision_digits, "_checked", short)
    monkeypatch.setattr(precision_digits, "_many_digits", lambda *_: pytest.fail("many digits"))
    path = CASES / "off-axis-two.toml"
    code, out, err = stabilab("simulate", path, "--at", "1")
    assert code == 0 and "checked to 9.4 digits" in out and not err
    monkeypatch.setattr(precision_digits, "_many_digits", lambda *_: None)
    code, out, err = stabilab("simulate", path, "--at", "1", "--digits", "10")
    assert code == 5 and "10 digits asked for, 9.4 reached" in err


def test_extremes_nearly_as_sharp_as_the_aim_are_told_with_exit_0(stabilab, monkeypatch):
    monkeypatch.setattr(precision_questions, "_apart", lambda *_: 10**-9.4 / 4)
    monkeypatch.setattr(precision_questions, "_many_digits", lambda *_: None)
    path = CASES / "off-axis-two.toml"
    code, out, err = stabilab("extremes", path)
    assert code == 0 and "9.4 digits" in out and not err
    assert json.loads(stabilab("extremes", path, "--json")[1])[0]["digits"]["reached"] == pytest.approx(9.4)
    assert stabilab("extremes", path, "--digits", "10")[0] == 5
