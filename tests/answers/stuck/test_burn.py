"""Burns: what is left at closing and the latest closing time, against runs of Euler's equations by SciPy's
DOP853, written here, which share no code with the package."""
import math
from fractions import Fraction
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab
from stabilab.answers.stuck.burn import largest_after
from stabilab.case.sections import Burn, segments
from stabilab.errors import InputError
from tests.oracles import model, taylor
from tests.oracles.rigid import euler
from tests.shared import later

CASE = """body.inertia = {inertia}
motion.angular_velocity = {rates}
motion.span = [0, {span}]
"""


def case_of(folder, inertia, rates, thrusters, span=100.0, more=""):
    """The case of thrusters, each (torque, keys of its schedule)."""
    text = CASE.format(inertia=inertia, rates=rates, span=span) + more
    for torque, keys in thrusters:  # a force of size 1 at a place across it, so that arm x force is the torque
        torque = np.array(torque)
        arm = np.cross(np.eye(3)[np.argmin(np.abs(torque))], torque)
        arm /= np.linalg.norm(arm)
        force = np.cross(torque, arm)  # arm x (torque x arm) = torque, the arm of length 1 across it
        text += (f"[[thrusters]]\nposition = {arm.tolist()}\ndirection = {force.tolist()}\n"
                 f"force = {float(np.linalg.norm(force))!r}\n{keys}\n")
    path = folder / "burn.toml"
    path.write_text(text)
    return path


def run(D, torque, w, length, lam=(0.0, 0.0, 0.0), dense=False):
    found = solve_ivp(euler(D, lam, torque), (0, length), w, method="DOP853", rtol=1e-13, atol=1e-15,
                      dense_output=dense)
    return found if dense else found.y[:, -1]


def largest(D, w, lam=(0.0, 0.0, 0.0)):
    """|omega| at the most of the free motion from w, by sampling a long run: some periods."""
    found = solve_ivp(euler(D, lam), (0, 150 / np.linalg.norm(w)), w, method="DOP853", rtol=1e-9,
                      atol=1e-13, dense_output=True)  # sampled to 2e-6
    return np.linalg.norm(found.sol(np.linspace(0, found.t[-1], 15_000)), axis=0).max()


def random_body(rng):
    a, b = rng.uniform(1, 3, 2)
    D = rng.permutation([a, b, abs(a - b) + (a + b - abs(a - b)) * rng.uniform(0.1, 0.9)])
    return [float(f"{v:.6g}") for v in D], [float(f"{v:.6g}") for v in rng.normal(0, 0.05, 3)]


def wheels(lam):
    return "".join(f"[[wheels]]\naxis = {np.eye(3)[n].tolist()}\nmomentum = {lam[n]}\n" for n in range(3) if lam[n])


def check_latest_with_wheels(folder, seed):
    """The latest closing time of a random gyrostat: by DOP853 over long runs, sampled, the free motion from a little
    before it stays below the limit, that from a little after it does not, and none from closing times before."""
    rng = np.random.default_rng([34, seed])
    D, w = random_body(rng)
    lam = [float(f"{v:.6g}") for v in rng.normal(0, 0.1, 3) * [1, 1, seed % 2]]
    torque = np.array([float(f"{v:.6g}") for v in rng.normal(0, 0.02, 3)])
    most = largest(D, w, lam) * rng.uniform(1.3, 3)
    found = stabilab.burn(case_of(folder, D, w, [(torque, "stop = 2000")], more=wheels(lam)), below=most).latest
    assert found.level == "run" and found.low < found.high < found.low * (1 + 1e-8)
    assert found.surely[0] <= found.low and found.high <= found.surely[1]
    after = lambda end: largest(D, run(D, torque, w, end, lam), lam)
    assert after(found.low * (1 - 1e-4)) < most < after(found.high * (1 + 1e-4))
    assert all(after(found.low * share) < most for share in (0.3, 0.9))
    along = run(D, torque, w, found.surely[0], lam, dense=True).sol(np.linspace(0, found.surely[0], 200))
    assert (np.array(D) @ along**2 <= min(D) * most**2 * (1 + 1e-12)).all()  # so that |omega| stays below it
    assert np.linalg.norm(run(D, torque, w, found.surely[1], lam)) == pytest.approx(most, rel=1e-9)


A_HUNDRED = pytest.mark.parametrize("seed", [1, *later((0, *range(2, 100)))])


@A_HUNDRED
def test_the_latest_closing_time_with_wheels_parts_the_free_motions(tmp_path, seed):
    check_latest_with_wheels(tmp_path, seed)


def test_a_wheel_along_the_axis_of_a_symmetric_body_leaves_a_closed_form(tmp_path):
    """Its free motion keeps |omega|, so that closing is too late once the burn itself reaches the limit: the first
    crossing of |omega|, by the bisection of an own run."""
    D, w, torque, lam, most = [2.0, 2.0, 3.0], [0.01, 0.02, -0.03], np.array([0.05, 0.02, 0.04]), [0, 0, 0.5], 0.2
    found = stabilab.burn(case_of(tmp_path, D, w, [(torque, "stop = 99")], more=wheels(lam)), below=most).latest
    assert found.level == "proved" and found.high == math.nextafter(found.low, math.inf)
    before, after = (np.linalg.norm(run(D, torque, w, end, lam)) for end in (found.low - 1e-9, found.high + 1e-9))
    assert before < most < after and found.surely is None


def test_a_wheel_across_the_axis_of_a_flat_symmetric_body_has_its_closing_time_where_the_bound_is_reached(tmp_path):
    """The free motion comes nearest to 2T/D1 there, so that the root lies at the end of the first interval looked at,
    which begins with the burn: by sampled runs of DOP853."""
    D, w, torque, lam, most = [2.0, 2.0, 3.0], [0.01, 0.02, -0.03], np.array([0.1, 0, 0]), [0.5, 0, 0], 0.2
    found = stabilab.burn(case_of(tmp_path, D, w, [(torque, "stop = 99")], more=wheels(lam)), below=most).latest
    before, after = (largest(D, run(D, torque, w, end, lam), lam) for end in (found.low - 1e-4, found.high + 1e-4))
    assert before < most < after and found.high < found.low + 1e-9
    assert found.surely[0] <= found.low <= found.high <= found.surely[1]


def check_latest(folder, seed):
    """The latest closing time of a random burn, pulsed in every second one: at the double that is given the
    free motion stays below the limit, at the next double it does not, by Taylor series in 40 digits of
    another code (`tests.oracles.taylor`); and nothing before it passes the limit, by a run of DOP853."""
    rng = np.random.default_rng(seed)
    D, w = random_body(rng)
    torque = [float(f"{v:.6g}") for v in rng.normal(0, 0.02, 3)]
    begun = largest_after(stabilab.Scene(stabilab.Body(D)), w)
    limit = f"{begun * rng.uniform(1.2, 4):.8g}"
    pulses = "start = 1\nperiod = 4\non_time = 3\n" if seed % 2 else ""
    burning = stabilab.load_burning(case_of(folder, D, w, [(torque, f"{pulses}stop = 2000")]))
    exactly = burning.craft.thrusters[0].torque  # of arm and force as the file has them, in all digits
    assert np.abs(np.array(exactly, float) - torque).max() < 1e-15
    found = stabilab.burn(burning, below=limit)
    low, high = found.latest.low, found.latest.high
    assert found.latest.level == "proved" and high == math.nextafter(low, math.inf) < 2000
    with mp.workdps(40):
        D, state, most = [Fraction(repr(v)) for v in D], [Fraction(repr(v)) for v in w], mp.mpf(limit) ** 2
        for length, firing in spans(Fraction(low), bool(seed % 2)):
            before = state
            state = taylor_end(D, exactly if firing else (0, 0, 0), before, length)
        later = taylor_end(D, exactly, before, length + Fraction(high) - Fraction(low))
        assert firing and least_square(D, state) < most <= least_square(D, later)
    D, size = list(map(float, D)), float(limit)
    assert largest(D, list(map(float, state))) == pytest.approx(size, rel=1e-5)  # the run is sampled
    state = np.array(w)
    for length, firing in spans(Fraction(low), bool(seed % 2)):
        along = run(D, np.array(torque) * firing, state, float(length), dense=True)
        assert np.linalg.norm(along.sol(np.linspace(0, float(length), 500)), axis=0).max() < size * (1 + 1e-9)
        state = along.y[:, -1]
    assert found.closed_latest.largest_rate == pytest.approx(size, rel=1e-9)


def spans(end, pulsed):
    """(length, whether it fires) up to a time: one burn from 0 on, or from 1 s on 3 s of every 4 s."""
    if not pulsed:
        return [(end, True)]
    edges = [Fraction(0), *(Fraction(n) for n in range(1, 2000) if n % 4 in (0, 1) and n < end), end]
    return [(b - a, a % 4 == 1) for a, b in zip(edges, edges[1:])]


def taylor_end(D, torque, w, length):
    return taylor.integrate(model.physical(D, torque=torque), w, [length], digits=40)[0]


def least_square(D, w):
    """g^2 by the plane omega2 = 0 of the polhode: two linear equations for the squares of the other two,
    written here from energy and momentum."""
    D = [mp.mpf(d.numerator) / d.denominator for d in map(Fraction, D)]
    (one, _, three), T2 = sorted(D), sum(d * v**2 for d, v in zip(D, w))
    H2 = sum(d**2 * v**2 for d, v in zip(D, w))
    return ((three**2 - one**2) * T2 - (three - one) * H2) / (one * three * (three - one))


@A_HUNDRED
def test_the_latest_closing_time_is_the_last_double_that_stays_below(tmp_path, seed):
    check_latest(tmp_path, seed)


def test_pulses_and_propellant_are_those_of_a_piecewise_run(tmp_path):
    """The pulses of two thrusters are written out here by hand: A fires 0.5 s of every 2 s from t = 1 on, for
    1.25 s in all (0.5 g at 0.4 g/s); B from 2.25 s to 4 s."""
    D, w, lam = [3.0, 2.0, 1.5], [0.01, -0.02, 0.03], (0.3, -0.1, 0.2)
    a, b = [0.05, 0.02, -0.04], [-0.01, 0.08, 0.03]
    path = case_of(tmp_path, D, w, [
        (a, 'start = "1 s"\nperiod = "2 s"\nduty = 0.25\npropellant = "0.5 g"\nmass_flow = "0.4 g/s"'),
        (b, 'start = "2.25 s"\nstop = "4 s"')],
        more="".join(f"[[wheels]]\naxis = {np.eye(3)[n].tolist()}\nmomentum = {lam[n]}\n" for n in range(3)))
    found = stabilab.burn(stabilab.load_burning(path))
    spans = [(1, ()), (0.5, (a,)), (0.75, ()), (0.75, (b,)), (0.5, (a, b)), (0.5, (b,)), (1, ()), (0.25, (a,))]
    state = np.array(w)
    for length, firing in spans:
        state = run(D, np.sum([*firing, (0, 0, 0)], axis=0), state, length, lam)
    assert found.closed.time == 5.25 and found.closed.fired == (1.25, 1.75)
    assert found.closed.used[0] == pytest.approx(0.0005, rel=1e-15) and found.closed.used[1] is None
    assert np.abs(found.closed.rates - state).max() < 1e-13
    assert [one.time for one in found.switches] == [0, 1, 1.5, 2.25, 3, 3.5, 4, 5]
    assert found.closed.motion.fate == stabilab.Fate.BOUNDED
    assert found.closed.largest_rate == pytest.approx(found.closed.motion.largest, rel=1e-8)  # eight digits


def test_a_braking_burn_is_below_the_limit_again_later(tmp_path):
    """A torque about one axis against the second of two burns: up to 0.2 rad/s and back to 0.05 rad/s."""
    path = case_of(tmp_path, [3.0, 2.0, 1.5], [0, 0, 0.05], [([0, 0, 0.15], "stop = 1.5"),
                                                             ([0, 0, -0.15], "start = 2\nstop = 3.5")])
    latest = stabilab.burn(stabilab.load_burning(path), below="0.1").latest
    assert latest.low <= 0.5 <= latest.high  # 0.05 + 0.1 t
    (begin, end), = latest.again
    assert begin == pytest.approx(3.0, abs=0.01) and end == 3.5


def test_a_limit_that_no_closing_reaches_and_one_that_is_passed_at_the_start(tmp_path):
    path = case_of(tmp_path, [3.0, 2.0, 1.5], [0, 0, 0.05], [([0, 0, 0.15], "stop = 1.5")])
    burning = stabilab.load_burning(path)
    assert stabilab.burn(burning, below=1).latest.low == math.inf
    assert stabilab.burn(burning, below="0.05").latest.high == 0.0
    assert stabilab.burn(burning, stop="1").closed.rates == pytest.approx((0, 0, 0.15), abs=1e-16)


def test_switching_times_are_exact():
    third = Fraction(1, 3)
    burn = Burn(third, None, third, third / 10, Fraction(1), Fraction(7))
    windows = list(burn.windows())
    assert sum(b - a for a, b in windows) == Fraction(1, 7) and windows[2][0] == 1
    assert [one.firing for one in segments([burn, None])][:3] == [(), (0,), ()]


@pytest.mark.parametrize("keys, key, words", [
    ("start = 5\nstop = 3", "stop", "stops at 3 s and starts at 5 s"),
    ('propellant = "1 kg"', "propellant", "add mass_flow"),
    ("stop = 9\nperiod = 2\nduty = 1.5", "duty", "above 0 and at most 1"),
    ("stop = 9\nperiod = 2\nduty = 0", "duty", "above 0 and at most 1"),
    ("stop = 9\nperiod = 2\non_time = 3", "on_time", "at most the period"),
    ("stop = 9\nperiod = 2", "period", "add duty"), ("stop = 9\nduty = 0.5", "duty", "add period"),
    ("start = -1\nstop = 9", "start", "not negative"), ("stop = 9\nstuck = true", "stuck", "fires for ever"),
    ("stop = 9e9\nperiod = 2\nduty = 0.5", "period", "more than the 10000")])
def test_a_burn_that_cannot_be_is_one_fault_with_its_line_and_a_cure(tmp_path, keys, key, words):
    path = case_of(tmp_path, [3.0, 2.0, 1.5], [0, 0, 0.05], [([0, 0, 0.15], keys)])
    line = next(n for n, text in enumerate(path.read_text().split("\n"), 1) if text.startswith(f"{key} ="))
    with pytest.raises(stabilab.InputError) as caught:
        stabilab.load_burning(path)
    assert str(caught.value).startswith(f"{path}:{line}: thrusters.{key}: ") and words in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("load", [stabilab.load_burning, stabilab.load_orbiting], ids=["burn", "orbit"])
def test_a_fault_of_a_file_is_named_and_not_what_it_hides(load):
    """A misspelled key leaves the thruster without a schedule."""
    text = CASE.format(inertia=[3, 2, 1], rates=[0, 0, 1], span=9) + (
        '[[thrusters]]\nposition = [1, 0, 0]\ndirection = [0, 1, 0]\nforce = 1\nstrat = 3\n')
    with pytest.raises(stabilab.InputError) as caught:
        load(text)
    (problem,) = caught.value.problems
    assert (problem.key, problem.message) == ("thrusters.strat", "unknown key; did you mean start?")


def test_questions_of_a_constant_torque_refuse_a_burn_and_name_the_command(tmp_path):
    path = case_of(tmp_path, [3.0, 2.0, 1.5], [0, 0, 0.05], [([0, 0, 0.15], "stop = 9")])
    with pytest.raises(stabilab.InputError, match=r"thrusters\.stop: .*`stabilab burn`"):
        stabilab.load(path)
    for ask in (stabilab.fate, stabilab.stuck, stabilab.simulate, stabilab.motion, stabilab.equilibria):
        with pytest.raises(stabilab.InputError, match="on a schedule: ask its burn, simulate or when"):
            ask(stabilab.load_burning(path))


def test_a_stuck_thruster_beside_a_burn_goes_on_after_it(tmp_path):
    """Both about axis 3: 0.05 + (0.15 + 0.03) t/1.5 up to 3 s, then 0.03/1.5 for ever."""
    path = case_of(tmp_path, [3.0, 2.0, 1.5], [0, 0, 0.05], [([0, 0, 0.15], "stop = 3"),
                                                             ([0, 0, 0.03], "stuck = true")])
    closed = stabilab.burn(stabilab.load_burning(path)).closed
    assert closed.rates == pytest.approx((0, 0, 0.05 + 0.18 / 1.5 * 3), abs=1e-15)
    assert closed.motion.fate == stabilab.Fate.SPIN_UP and closed.attitude is None
    assert closed.fired == (3.0, None) and closed.largest_rate is None


@pytest.mark.parametrize("wheel", [(0, 0, 0), (0.3, -0.2, 0.5)])
def test_an_energy_above_that_of_the_burn_is_never_reached(tmp_path, wheel):
    """DOP853: the largest energy while the thruster fires; without a torque it stays, with wheels too."""
    D, rates, torque = [3.0, 2.0, 1.5], [0.1, 0.2, 0.05], [0.02, 0.01, 0.05]
    path = case_of(tmp_path, D, rates, [(torque, "stop = 9")], more=wheels(wheel) if any(wheel) else "")
    times = np.linspace(0, 9, 2001)
    energy = (run(D, torque, rates, 9, wheel, dense=True).sol(times) ** 2 * np.array([D]).T).sum(axis=0) / 2
    burning = stabilab.load_burning(path)
    above, below = (burning.when(energy=share * energy.max()) for share in (1.001, 0.999))
    assert (above.low, above.level) == (math.inf, "proved") and 0 < below.low < below.high <= 9


def test_a_stuck_thruster_alone_is_one_that_opens_at_the_start(tmp_path):
    stuck = case_of(tmp_path, [3.0, 2.0, 1.5], [0.1, 0.2, 0.05], [([0.01, 0, 0.15], "stuck = true")])
    case, text = stabilab.load(stuck), stuck.read_text()
    found, scheduled = case.burn(stop="3 s"), stabilab.burn(text.replace("stuck = true", "start = 0"), stop=3)
    assert found.closed.rates == scheduled.closed.rates == stabilab.burn(stuck, stop=3).closed.rates
    assert found.closed.rates == pytest.approx(case.simulate([0, 3]).state["omega"][-1], abs=1e-14)
    with pytest.raises(stabilab.InputError, match="no thruster fires on a schedule"):
        stabilab.load("cases/torque-free-body.toml").burn(stop=3)


def test_a_closing_before_the_start_leaves_the_motion_as_it_was(tmp_path):
    path = case_of(tmp_path, [3.0, 2.0, 1.5], [0.1, 0.2, 0.05], [([0, 0, 0.15], "start = 5\nstop = 9")])
    closed = stabilab.burn(stabilab.load_burning(path), stop=2).closed
    assert closed.rates == (0.1, 0.2, 0.05) and closed.fired == (0.0,)


def test_what_burn_cannot_answer_it_says(tmp_path):
    wheel = "[[wheels]]\naxis = [1, 0, 0]\nmomentum = 1\n"
    path = case_of(tmp_path, [3.0, 2.0, 1.5], [0, 0, 0.05], [([0, 0, 0.15], "stop = 9")], more=wheel)
    stays = '[[thrusters]]\nposition = [1, 0, 0]\ndirection = [0, 1, 0]\nforce = 1\nstuck = true\n'
    with pytest.raises(stabilab.InputError, match="below: a torque stays"):
        stabilab.burn(path.read_text() + stays, below=1)
    with pytest.raises(stabilab.InputError, match="stop: expected a positive number"):
        stabilab.burn(stabilab.load_burning(path), stop=-1)
    path.write_text("body.inertia = [3, 2, 1.5]\nmotion.angular_velocity = [0, 0, 1]\n")
    with pytest.raises(stabilab.InputError, match="no thruster fires on a schedule"):
        stabilab.load_burning(path)


def test_a_burn_takes_a_path_or_a_text_and_text_with_units(tmp_path):
    path = case_of(tmp_path, [3.0, 2.0, 1.5], [0.1, 0.0, 0.2], [([0, 0, 0.05], "stop = 20")])
    text = Path(path).read_text(encoding="utf-8")
    one, other = stabilab.burn(path, stop=12), stabilab.burn(text, stop="0.2 min")
    assert one.closed.rates == other.closed.rates and one.closed.time == 12
    with pytest.raises(InputError, match="stop: expected time"):
        stabilab.burn(path, stop="3 deg")
    with pytest.raises(InputError, match="burn: expected a case whose thrusters"):
        stabilab.burn(3)
