"""What is given up of motions that no run can follow, how early, and what is not given up."""
import math
import tracemalloc
from fractions import Fraction

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene, trajectory
from stabilab.answers.tabulated import tabulated
from stabilab.integrate import events, guard
from stabilab.integrate import trajectory as trajectories
from stabilab.integrate.events import roots_of_rates
from stabilab.integrate.guard import Guard
from stabilab.integrate.integer_flow import IntegerFlow
from stabilab.integrate.reference import reference
from stabilab.physics.effects import effect_class
from tests.shared import CASES, case

needs_heyoka = pytest.mark.skipif(not stabilab.integrate.to_heyoka.heyoka_available(), reason="needs heyoka")
BODY, WHEEL = Body((3, 2, 1)), Gyrostat((0.3, 0.2, 0.1))
FAST = ScaledGyrostat(1, 2, ("1e300", 1, 0))  # turns some 1e149 times a unit of time
EXPLORER = case("explorer-1-damped")


# --- The forecast
def given_up(course, end, steps=10**6, settled=10**4):
    """After how many steps a motion that is at course(n) after n of them is given up; None where it is not."""
    one, n = Guard(end, steps, settled), 0
    while course(n) < end and n < steps:
        n += one.next(n)
        if course(n) < end and one.look(n, course(n)):
            return n
    return None


def test_a_motion_of_one_pace_is_given_up_as_soon_as_it_shows_that_it_comes_nowhere():
    """By hand: 400 steps weigh (400/1e4)^2; beyond 5e6 left over that the first look ends the run, beyond
    5e6 the look after all 1e4 steps does."""
    assert given_up(lambda n: n, 1.01 * 5e6 / 0.04**2) == guard.FIRST
    assert given_up(lambda n: n, 5.2e6) == 10**4
    assert given_up(lambda n: n, 4.9e6) is None


@pytest.mark.parametrize("power", [1, 1.5, 2, 3])
def test_a_motion_that_slows_down_is_not_given_up_earlier_than_its_settled_pace_says(power):
    """By hand, t = n^p: after S steps L = end/S^(p - 1), if the mean pace until then counts; a cubic loss makes
    the rates t^(-1/2), so steps lengthen as t^(1/2) and p = 2."""
    assert given_up(lambda n: float(n) ** power, 4.9e6 * 10.0 ** (4 * (power - 1))) is None


# --- Runs
@needs_heyoka
def test_zeros_of_a_motion_of_endless_turns_are_looked_for_in_a_few_steps():
    found = roots_of_rates(FAST, (1.7, 1.1, -0.2), 15.0)
    assert found.steps == guard.FIRST and "given up after 400 steps" in str(found.reason)
    assert 0 < found.t_reached < 1e-140 and len(found.t) == len(found.states) == len(found.component) > 0


@needs_heyoka
def test_the_zeros_of_many_steps_are_rows_of_numbers():
    """Twice 8 (N + 2) bytes a zero, N = 6: its columns before and after they are put in order."""
    roots_of_rates(EXPLORER.scene, EXPLORER.start, 1.0)  # compiles
    tracemalloc.start()
    found = roots_of_rates(EXPLORER.scene, EXPLORER.start, 200.0)
    size = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert len(found.t) > 10_000 and not found.reason
    assert size < 3.5 * 8 * 8 * len(found.t)


def test_zeros_that_fill_the_memory_allowed_end_the_search(monkeypatch):
    monkeypatch.setattr(guard, "BYTES", 8 * (3 + 2) * 100)
    found = roots_of_rates(Scene(BODY, WHEEL), (0.5, 1, 2), 1e4)
    assert "fill the memory allowed" in str(found.reason) and 100 < len(found.t) < 10_000


@needs_heyoka
@pytest.mark.parametrize("scene, start", [
    (Scene(BODY, WHEEL), (0.5, 1.0, 2.0)), (EXPLORER.scene, EXPLORER.start),
    (Scene(BODY, effect_class("gravity")(3, (0.1, 0.2, 0.3))), {"omega": (0.5, 1.0, 2.0), "gamma": (0, 0.6, 0.8)})])
def test_of_a_time_beyond_any_run_and_one_within_the_last_is_answered(scene, start):
    run, alone = trajectory(scene, start, [1.0, 1e30]), trajectory(scene, start, [1.0])
    assert run.status == "stopped" and "the rest would take some" in run.because and run.t.tolist() == [1.0]
    assert (run.states == alone.states).all() and run.counters["steps"] < 1000
    backwards = trajectory(Scene(BODY, WHEEL), (0.5, 1.0, 2.0), [-1.0, -1e30])
    assert backwards.t.tolist() == [-1.0]


@needs_heyoka
def test_a_short_first_step_is_no_reason_to_give_up():
    """A liquid that settles in 1e-7 of the span; then the rates are 0 but for rounding, and steps without end
    (closed form: omega = exp(-c t) of three equal moments)."""
    scene = Scene(Body((2, 2, 2)), effect_class("resistance")(1000))
    run = trajectory(scene, (1.0, 2.0, -1.0), [1e-3, 1e4])
    assert run.status == "reached" and np.allclose(run.states[0], np.array([1, 2, -1]) / math.e, rtol=1e-13)


@needs_heyoka
def test_what_a_run_notes_of_its_steps_is_bounded(monkeypatch):
    monkeypatch.setattr(trajectories, "REPORT", 100)
    monkeypatch.setattr(guard, "BYTES", 8 * trajectories.NOTED * 500)
    ends = []
    run = trajectory(Scene(BODY, WHEEL), (0.5, 1, 2), [1e4], steps=ends)
    assert run.status == "stopped" and "memory allowed" in run.because and 500 < len(ends) < 1000
    assert trajectory(Scene(BODY, WHEEL), (0.5, 1, 2), [1e3]).status == "reached"  # nothing is noted


# --- Many digits
@pytest.mark.parametrize("turns", [1e12, 1e150])
def test_many_digits_of_a_time_out_of_reach_are_given_up_for_a_little_of_their_work(turns):
    scene = Scene(BODY, effect_class("resistance")("0.001"), WHEEL)
    found = reference(scene, (0.5, 1.0, 2.0), [turns], work=60_000_000)
    assert found.status == "stopped" and not len(found.t) and found.work < 10_000_000


def test_many_digits_within_reach_come_before_one_out_of_reach():
    found = reference(Scene(BODY, WHEEL), (0.5, 1.0, 2.0), [1.0, 1e30])
    assert found.t.tolist() == [1.0]
    np.testing.assert_allclose(found.states[0], trajectory(Scene(BODY, WHEEL), (0.5, 1, 2), [1.0]).states[0],
                               rtol=1e-13)


@pytest.mark.parametrize("inertia, wheel, torque, start", [
    ((3, 2, 1), ("1e150", 2, 1), (1, 2, 0), ("1e-150", 1, 2)), ((3, 2, "1e-300"), (1, 2, 0), (1, 0, 0), (1, 1, 2)),
    ((1, 1, "1e-320"), (1, 2, 0), (1, 0, 0), (1, 1, 2)), ((3, 2, 1), (1, 2, 3), ("1e300", 0, 1), (1, 2, 3))])
def test_numbers_too_far_apart_for_integers_are_said_to_be(inertia, wheel, torque, start):
    exact = [Fraction(v) for v in start]
    found = tabulated(Scene(Body(inertia), Gyrostat(wheel), ConstantTorque(torque)), [float(v) for v in exact],
                      exact, [Fraction(1)], 15, work=2_000_000)
    assert not found.reached and not found.t and found.because


def test_the_steps_of_ordinary_numbers_are_those_of_before():
    """1/32 of the start's size, as it has always been: bytes of proofs rest on it."""
    scene = Scene(BODY, WHEEL)
    flow = IntegerFlow(scene.quadratic(), scene.body.exact, [Fraction(1), Fraction(2), Fraction(1, 2)], 112)
    assert flow.h == events.LONGEST / 1e6 / 32 / 2 and not flow.apart


# --- What a question says whose numbers leave the range of doubles
@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # of products that overflow on the way
@pytest.mark.parametrize("key, value, question", [
    ("charge", "1e300", ("compare",)), ("field", "1e300", ("compare",)), ("charge", "1e300", ("plot", "--out", "far.png"))])
def test_a_number_by_which_a_question_leaves_the_range_of_doubles_is_named(key, value, question, tmp_path, capsys,
                                                                            monkeypatch):
    """By the linear model, whose angles overflow."""
    from stabilab.cli import main
    monkeypatch.chdir(tmp_path)
    text = (CASES / "charged-body.toml").read_text(encoding="utf-8")
    line = next(line for line in text.splitlines() if line.startswith(f"{key} ="))
    file = tmp_path / "far.toml"
    file.write_text(text.replace(line, f"{key} = {value}"), encoding="utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("sys.argv", ["stabilab", question[0], str(file), *question[1:]])
        with pytest.raises(SystemExit) as left:
            main()
    assert left.value.code == 2
    assert "[effects.charge] k = " in (said := capsys.readouterr().err) and "range of doubles" in said


def test_a_fault_of_the_arithmetic_of_ordinary_numbers_stays_a_fault():
    from stabilab.case.far import in_doubles
    with pytest.raises(ZeroDivisionError), in_doubles(case("charged-body")):
        1 / 0  # noqa: B018


# --- States of which nothing is known
@pytest.mark.parametrize("method", [None, "reduced"])
def test_of_a_time_at_which_no_digit_is_known_there_is_no_state(method):
    """A start in doubles is known to 1e-16, so that a period is, and after 1e16 of them the phase is not."""
    from stabilab.answers.digits_run import best_reached
    one = case("minor-axis-100")
    if method is None:
        found = best_reached(one, [1.0, 1e30], 5)
        assert not found.enough and found.run.status == "stopped"
        run, states = found.run, found.run.state["x"]
    else:
        run = trajectory(one.scene, one.state, [1.0, 1e30], method="reduced")
        states = run.states
    assert run.t.tolist() == [1.0] and "no digit of the state is known at t = 1e+30" in run.because
    assert run.reason.code in ("no-digit-known", "no-digit-at") and run.reason.as_dict()["time"] == 1e30
    exact = trajectory(one.scene, one.state, [1.0]).states
    np.testing.assert_allclose(states, exact, rtol=1e-12 if method else 1e-5)  # five digits are asked for
