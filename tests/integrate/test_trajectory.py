"""Trajectories against an independent high-precision Taylor integration, symmetries, laws and failures."""
import sys
from fractions import Fraction

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene, trajectory
from stabilab.answers.simulate import METHODS
from stabilab.errors import InputError
from stabilab.integrate import to_heyoka
from stabilab.integrate import trajectory as trajectories
from stabilab.integrate.to_heyoka import heyoka_available
from stabilab.integrate.trajectory import SCIPY_METHODS
from stabilab.papers.cost_effects import ladder
from stabilab.physics.effects import effect_class
from stabilab.physics.effects.base import Effect
from stabilab.physics.equations import derive
from stabilab.physics.to_numpy import form
from tests.oracles import model, taylor
from tests.shared import SCALED_MINOR

BODY = Body((2000, 1500, 1000))
TORQUED = Scene(BODY, Gyrostat((100, 0, 0)), ConstantTorque((0, 0, "204.1")))
OFF_AXIS = Scene(Body(("1.000000000001", 1, "0.5")), Gyrostat(("0.1", "0.3", 0)),
                 ConstantTorque((0, 1, "0.1")))
CASES = [
    (TORQUED, model.physical((2000, 1500, 1000), (100, 0, 0), (0, 0, "204.1")), (0.5, 2.6, 0.06)),
    (TORQUED, model.physical((2000, 1500, 1000), (100, 0, 0), (0, 0, "204.1")), (1.0, 2.0, 1.0)),
    (OFF_AXIS, model.physical(("1.000000000001", 1, "0.5"), ("0.1", "0.3", 0), (0, 1, "0.1")),
     (1.0, 2.0, 1.0)),
    (ScaledGyrostat("0.2", "0.4", (0, 0, 1)), model.scaled("0.2", "0.4", (0, 0, 1)), (2.5, 4.0, 0.1)),
    (ScaledGyrostat(0, "0.1", (1, 0, 0)), model.scaled(0, "0.1", (1, 0, 0)), (0.0, -1.0, 5.0)),
    (Scene(BODY, Gyrostat((1, -700, 300))), model.physical((2000, 1500, 1000), (1, -700, 300)),
     (1.0, 2.0, -1.0)),
]
needs_heyoka = pytest.mark.skipif(not heyoka_available(), reason="heyoka is not installed")


@pytest.fixture
def without_heyoka(monkeypatch):
    monkeypatch.setitem(sys.modules, "heyoka", None)


def reference(case, times):
    return np.array([[float(v) for v in row] for row in taylor.integrate(case[1], case[2], times, digits=30)])


@pytest.mark.one_in(3)
@needs_heyoka
@pytest.mark.parametrize("case", CASES)
def test_states_agree_with_thirty_digit_integration(case):
    for times in ([0.7, 3.0, 15.0], [-0.7, -6.0]):
        run = trajectory(case[0], case[2], times)
        exact = reference(case, times)
        assert np.abs(run.states - exact).max() <= 2e-13 * np.abs(exact).max()
        assert run.status == "reached" and max(run.invariant_drift.values()) < 1e-14


@pytest.mark.slow
@needs_heyoka
def test_spin_up_over_a_long_time_keeps_its_phase():
    """The phase is about t^2/2; forty ulps of it are allowed, the rounding of some thousand steps."""
    case, t = CASES[3], 40.0
    run, exact = trajectory(case[0], (1.0, 1.0, 1.0),
                            [t]), taylor.integrate(case[1], (1.0, 1.0, 1.0), [t], digits=22)
    assert run.states[0] == pytest.approx([float(v) for v in exact[0]], abs=40 * 2.2e-16 * t * t / 2)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("case", CASES[:4])
def test_without_heyoka_dop853_takes_over_and_says_so(case, without_heyoka):
    assert not heyoka_available()
    run = trajectory(case[0], case[2], [-2.0, 0.5, 10.0])
    assert run.method == "DOP853" and "heyoka is not installed" in run.because and run.status == "reached"
    exact = np.vstack([reference(case, [-2.0]), reference(case, [0.5, 10.0])])
    assert np.abs(run.states - exact).max() <= 2e-11 * np.abs(exact).max()


@pytest.mark.one_in(2)
@pytest.mark.parametrize("method", SCIPY_METHODS)
def test_scipy_methods_agree_within_their_tolerance(method):
    """Global error against the tolerance: 1e3 local tolerances over some twenty swings (more for low order).
    """
    case, times = CASES[0], [2.0, 5.0]
    exact = reference(case, times)
    for rtol in (1e-6, 1e-8):
        run = trajectory(case[0], case[2], times, method.lower(), rtol)
        assert run.method == method and run.rtol == rtol
        error = np.abs(run.states - exact).max()
        assert error < 1e3 * rtol
        assert max(run.invariant_drift.values()) < 1e3 * rtol
        assert run.counters["rate evaluations"] > run.counters["steps"] > 5


def test_tighter_tolerance_costs_more_and_errs_less():
    case, exact = CASES[0], reference(CASES[0], [5.0])
    loose, tight = (trajectory(case[0], case[2], [5.0], "RK45", r) for r in (1e-5, 1e-9))
    assert tight.counters["rate evaluations"] > 3 * loose.counters["rate evaluations"]
    assert np.abs(tight.states - exact).max() < 1e-2 * np.abs(loose.states - exact).max()


def test_drift_shows_a_law_broken():
    """A loose run departs from the laws by about its error, a tight one does not."""
    loose = trajectory(TORQUED, (0.5, 2.6, 0.06), [15.0], "RK23", 1e-3)
    assert max(loose.invariant_drift.values()) > 1e-4


def test_quadratures_do_not_steer_the_steps():
    """A torque-free scene has laws of rate zero, a torqued one not; a torque far below the last place leaves
    the run as it is."""
    free = trajectory(Scene(BODY), (1, 2, 3), [20.0], "DOP853")
    named = trajectory(Scene(BODY, ConstantTorque((0, 0, "1e-100"))), (1, 2, 3), [20.0], "DOP853")
    assert free.counters["steps"] == named.counters["steps"] and (free.states == named.states).all()


@pytest.mark.parametrize("method", ["taylor", "DOP853"])
def test_times_may_run_either_way_and_skip_zero(method):
    up = trajectory(TORQUED, (1, 2, 1), [-3, -1, 0, 2, 4], method)
    down = trajectory(TORQUED, (1, 2, 1), [4, 2, 0, -1, -3], method)
    assert (up.states == down.states[::-1]).all() and (up.t == down.t[::-1]).all()
    assert up.states[2].tolist() == [1, 2, 1]
    assert trajectory(TORQUED, (1, 2, 1), [2], method).states[0] == pytest.approx(up.states[3], rel=1e-8)


@needs_heyoka
@pytest.mark.parametrize("case", CASES)
def test_running_back_returns_to_the_start(case):
    end = trajectory(case[0], case[2], [8.0]).states[0]
    assert trajectory(case[0], end, [-8.0]).states[0] == pytest.approx(case[2], abs=2e-13 * np.abs(end).max())


def test_units_of_rate_and_time_scale_out():
    """D -> D, lambda -> s lambda, M -> s^2 M, omega -> s omega, t -> t/s; s a power of two, so bit for bit in
    exact arithmetic."""
    s = 2.0**20
    one = trajectory(TORQUED, (1, 2, 1), [3.0]).states[0]
    other = trajectory(Scene(BODY, Gyrostat((100 * 2**20, 0, 0)),
                             ConstantTorque((0, 0, Fraction("204.1") * 2**40))),
                       (s, 2 * s, s), [3.0 / s]).states[0]
    assert other / s == pytest.approx(one, rel=1e-13)


class Cubic(Effect):
    """A torque against the cube of each rate."""

    name = "cubic"
    acts = True

    def torque(self, omega, p):
        return tuple(-w**3 for w in omega)


def test_powers_of_a_rate_that_is_zero_are_followed():
    """w' = -w^3 of a sphere has the solution w0/sqrt(1 + 2 w0^2 t); the other rates stay zero."""
    run = trajectory(Scene(Body((1, 1, 1)), Cubic()), (0.5, 0.0, 0.0), [0, 2])
    assert run.states[-1] == pytest.approx((0.5 / 2**0.5, 0, 0), abs=1e-15)


def test_equilibrium_stays_where_it_is():
    run = trajectory(Scene(BODY), (0, 3, 0), [5.0, 50.0])
    assert (run.states == [0, 3, 0]).all() and max(run.invariant_drift.values()) == 0


@pytest.mark.parametrize("method", METHODS)
def test_overflow_stops_the_run_with_a_reason_and_no_nan(method):
    run = trajectory(TORQUED, (1e200, 1e200, 1.0), [0.0, 1.0, 2.0], method)
    assert run.status == "stopped" and run.reason
    assert np.isfinite(run.states).all() and len(run.t) == len(run.states) == 1


def test_a_step_that_fails_stops_a_run_whose_law_is_watched_along_its_steps():
    """A torque speeds the body up beyond a tolerance that is relative to a start near zero: no step is short
    enough, and SciPy has no interpolant of one that failed."""
    scene = Scene(Body((3, 2, "1.5")), ConstantTorque(("0.1", "0.2", "0.1")),
                  effect_class("liquid_cavity")("0.05", 1000, "0.01"))
    run = trajectory(scene, (6e-201, -3e-201, -5e-201), [5.0], "DOP853")
    assert run.status == "stopped" and "step size" in run.because and run.validity.value >= 0


@pytest.mark.parametrize("arguments, words", [
    (((1, 2), [1.0]), "three numbers"), (((1, 2, np.nan), [1.0]), "finite"),
    (((1, 2, 3), []), "finite numbers"),
    (((1, 2, 3), [1.0, 1.0]), "strictly"), (((1, 2, 3), [0, 2.0, 1.0]), "strictly"),
    (((1, 2, 3), [np.inf]), "finite"),
    ((("a", 2, 3), [1.0]), "numbers"), (((1, 2, 3), [1.0], "DOP835"), 'did you mean "DOP853"'),
    (((1, 2, 3), [1.0], "tailor"), 'did you mean "taylor"'), (((1, 2, 3), [1.0], "RK45", -1.0), "rtol")])
def test_bad_input_is_named(arguments, words):
    with pytest.raises(InputError, match=words):
        trajectory(TORQUED, *arguments)


def test_a_run_cut_into_stretches_is_the_run_in_one(monkeypatch):
    from stabilab.integrate import trajectory as trajectories
    scene, times = Scene(Body((12, 9, 5)), Gyrostat(("0.8", 0, 0)),
                         ConstantTorque((0, 0, "0.02"))), [0.0, 1.0, 50.0, 300.0]
    whole = trajectory(scene, (0.1, 0.05, 0.02), times)
    monkeypatch.setattr(trajectories, "REPORT", 7)
    cut = trajectory(scene, (0.1, 0.05, 0.02), times)
    assert cut.counters["steps"] > 20 and cut.status == "reached"
    np.testing.assert_allclose(cut.states, whole.states, rtol=0, atol=1e-14)
    assert max(cut.invariant_drift.values()) < 1e-14


def test_a_report_that_comes_where_the_last_time_is_met_but_for_its_last_place(monkeypatch):
    """The clock of the series has two doubles: after n steps the first of them may be the last time that was
    asked for, and the second one not zero. What is reported there is the state of the run in one."""
    from stabilab.integrate import trajectory as trajectories
    scene, start = Scene(Body((12, 9, 5)), Gyrostat(("0.8", 0, 0)),
                         ConstantTorque((0, 0, "0.02"))), (0.1, 0.05, 0.02)
    ends: list[float] = []
    trajectory(scene, start, [300.0], steps=ends)
    whole = trajectory(scene, start, ends[:40])
    for n in range(1, 41):
        monkeypatch.setattr(trajectories, "REPORT", n)
        cut = trajectory(scene, start, ends[:n])
        assert cut.status == "reached" and cut.t.tolist() == ends[:n]
        np.testing.assert_allclose(cut.states, whole.states[:n], rtol=0, atol=1e-14)


def test_a_run_that_would_crawl_for_ever_stops_and_says_what_is_left(monkeypatch):
    """Backwards in time the resistance spins the body up by e^20 a second, and the liquid's time shrinks as
    its square."""
    from stabilab.integrate import trajectory as trajectories
    from stabilab.physics.effects import effect_class
    scene = Scene(Body(("9.51", "9.3", 9)), effect_class("resistance")(20),
                  effect_class("liquid_cavity")(1250, 1000, "1.9"))
    monkeypatch.setattr(trajectories, "REPORT", 5_000)
    monkeypatch.setattr(trajectories, "STEP_LIMIT", 100_000)
    run = trajectory(scene, (1.0, 0.0, 1.0), [-0.25, -1.0, -1.5])
    assert run.status == "stopped" and run.t.tolist() == [-0.25] and "steps went from t =" in run.because
    assert 5_000 <= run.counters["steps"] <= 100_000


@pytest.mark.one_in(3)
@pytest.mark.parametrize("method", ["taylor", "DOP853"])
@pytest.mark.parametrize("case", CASES)
def test_leaving_the_laws_unchecked_leaves_steps_and_states(case, method):
    """Other expressions beside them let the compiler contract products differently: 100 ulps over some
    hundred steps."""
    checked, bare = (trajectory(case[0], case[2], [-3.0, 0.0, 8.0], method, laws=laws)
                     for laws in (True, False))
    assert np.abs(checked.states - bare.states).max() <= 100 * 2.2e-16 * np.abs(bare.states).max()
    assert checked.counters == bare.counters
    assert checked.invariant_drift and bare.invariant_drift == {}


@needs_heyoka
def test_a_second_run_compiles_and_copies_no_integrator(monkeypatch):
    """Two scenes of one structure share code and integrator; what the first left in it does not show in the
    second."""
    import copy
    one, other = (Scene(Body((9, 7, d)), Gyrostat((1, 2, 3)), ConstantTorque((1, "0.5", "0.2")))
                  for d in (4, 5))
    first = trajectory(other, (1, 2, 3), [4.0]).states
    trajectory(one, (1e200, 1e200, 1.0), [1.0])  # overflows
    before = (to_heyoka._integrator.cache_info().misses, to_heyoka._free.cache_info().misses)
    monkeypatch.setattr(copy, "copy", None)
    assert (trajectory(other, (1, 2, 3), [4.0]).states == first).all()
    assert (to_heyoka._integrator.cache_info().misses, to_heyoka._free.cache_info().misses) == before


@pytest.mark.parametrize("times", [[-3, -1, 0, 2, 4], [-3, -1], [2, 4], [0], [0.0, 1.5], [-2, 0], [-0.0, 1],
                                   [5.0], [-5.0]])
@pytest.mark.parametrize("way", [1, -1])
def test_times_are_parted_at_zero_and_each_part_leaves_from_there(times, way):
    before, after, still = trajectories.parted(np.array(times[::way], float))
    assert before.tolist() == [0, *sorted((t for t in times if t < 0), reverse=True)]
    assert after.tolist() == [0, *sorted(t for t in times if t > 0)]
    assert still == times.count(0) and not np.signbit(after[0])


def test_the_times_of_a_run_are_its_own():
    times = np.array([0.0, 1.0])
    run = trajectory(Scene(Body((3, 2, 1))), (1, 2, 3), times)
    times[1] = 7.0
    assert run.t.tolist() == [0.0, 1.0]


@pytest.mark.one_in(2)
@pytest.mark.parametrize("mass", [1.0, 1e-140, 1e-160, 1e150])
def test_the_laws_of_a_very_light_or_heavy_body_hold_in_its_run(mass):
    """A unit of mass changes no motion, so no drift."""
    scene = Scene(Body((3 * mass, 2 * mass, 1.5 * mass)), Gyrostat((mass, 2 * mass, -3 * mass)),
                  ConstantTorque((mass, 0, 0)))
    assert max(stabilab.trajectory(scene, (0.1, 0.2, 0.3), [0, 1, 5]).invariant_drift.values()) < 1e-14


@pytest.mark.parametrize("state", [{"gamma": (0, 0, 1)}, {"omega": (1, 0, 0), "spin": 3}, {}])
def test_a_start_in_blocks_names_the_rate_and_no_others(state):
    with pytest.raises(InputError, match="omega"):
        trajectory(SCALED_MINOR, state, [1.0])


def test_a_run_beyond_its_steps_stops_and_says_so(monkeypatch):
    monkeypatch.setattr(trajectories, "STEP_LIMIT", 7)
    run = trajectory(SCALED_MINOR, (2.5, 4.0, 0.1), [100.0], method="DOP853")
    assert run.status == "stopped" and "7 steps" in run.because


def test_a_second_short_run_reads_no_fractions_and_calls_few_functions():
    """Counted: what a run costs beside its steps. It was 480 calls, a quarter of them within fractions."""
    scene, times, counts = Scene(BODY, Gyrostat((100, 20, 0)), ConstantTorque((1, 0, "204.1"))), [0.0, 1.0, 2.0], {}

    def noted(frame, event, argument):
        if event == "call":
            file = frame.f_code.co_filename.rpartition("/")[2]
            counts[file] = counts.get(file, 0) + 1
    trajectory(scene, (0.5, 2.6, 0.06), times)
    sys.setprofile(noted)
    try:
        trajectory(scene, (0.5, 2.6, 0.06), times)
    finally:
        sys.setprofile(None)
    assert "fractions.py" not in counts and sum(counts.values()) < 200


@needs_heyoka
def test_the_series_of_many_effects_is_compiled_in_loops_and_gives_what_another_method_gives():
    """DOP853 shares the equations alone. Straight code of these rates took heyoka a minute."""
    scenes = [scene for _, scene in ladder()]
    many = next(scene for scene in scenes if to_heyoka.in_loops(rates_of(scene)))
    assert not to_heyoka.in_loops(rates_of(scenes[scenes.index(many) - 1]))
    state = derive(many).state
    start = np.linspace(0.1, 0.4, len(state)) * [str(item) not in ("h1", "h2", "h3") for item in state]
    one, other = (trajectory(many, start, [0, 0.5, 1.0], method) for method in ("taylor", "DOP853"))
    np.testing.assert_allclose(one.states, other.states, rtol=1e-9, atol=1e-9)


def rates_of(scene):
    equations = derive(scene)
    return form(equations, equations.rhs).expressions
