"""The end of a gyrostat with a damper: against body, sphere and wheel integrated in space, and starts that are
worked by hand."""
import json
import math

import numpy as np
import pytest

from stabilab import Body, Gyrostat, InputError, LiquidCavity, Scene, ViscousDamper, flat_spin, load
from stabilab.answers.dissipation import gyrostat
from tests.oracles.two_bodies import brute


def made(D, k, c, wheel, omega, damper=(0, 0, 0)):
    scene = Scene(Body(D), ViscousDamper(k, c), Gyrostat(wheel))
    return load(scene, {"omega": omega, "damper": damper})


def drawn(seed):
    """A gyrostat with a damper whose time constant is some turns, and any start."""
    rng = np.random.default_rng(seed)
    D = np.sort(rng.uniform(1, 3, 3))[rng.permutation(3)]
    while max(D) > sum(D) - max(D) or np.diff(np.sort(D)).min() < 0.15:
        D = rng.uniform(1, 3, 3)
    k, omega = float(rng.uniform(0.1, 0.3) * min(D)), rng.normal(size=3)
    c = float(k * 10 ** rng.uniform(-0.3, 0.3))
    wheel = rng.normal(size=3) * 10 ** rng.uniform(-1.5, 0.3)
    return tuple(D.tolist()), k, c, tuple(wheel.tolist()), tuple(omega.tolist())


def agrees(seed):
    """How the end is known; the end is that of the brute force, at its time."""
    D, k, c, wheel, omega = drawn(seed)
    found = flat_spin(made(D, k, c, wheel, omega))
    if found.end is None:
        return found.level
    end = np.array(found.rotations[found.end].momentum)
    decay = found.rotations[found.end].decay
    if found.crosses is not None:
        (t,), H, _ = brute(D, k, c, wheel, omega, 2 * found.crosses.at, found.barrier)
        assert found.crosses.at == pytest.approx(t, rel=1e-6)
    until = (found.crosses.at if found.crosses else 0) + 25 * decay
    _, H, T = brute(D, k, c, wheel, omega, min(until, 3000.0), rtol=1e-9)
    if until < 3000:
        assert end == pytest.approx(H, abs=1e-3 * found.momentum), seed
        assert found.final_energy == pytest.approx(T, rel=1e-5, abs=1e-6 * found.energy)
    if found.settles is not None and found.settles.at < 1500:
        angle = lambda H: math.acos(min(1.0, float(np.dot(H, end)) / found.momentum ** 2))
        for times in (1.0, 1.3, 2.0):
            _, H, _ = brute(D, k, c, wheel, omega, times * found.settles.at, rtol=1e-9)
            assert angle(H) <= found.within * (1 + 1e-6)
    return found.level


def test_gyrostats_with_a_damper_end_as_bodies_in_space_do():
    assert {agrees(seed) for seed in (4, 11)} <= {"exact", "run"}


@pytest.mark.slow
@pytest.mark.parametrize("first", [0, *(pytest.param(n, marks=pytest.mark.long) for n in range(25, 500, 25))])
def test_five_hundred_gyrostats_end_as_bodies_in_space_do(first):
    levels = [agrees(seed) for seed in range(first, first + 25)]
    assert levels.count("undecided") <= 1


D, K, C = (2000.0, 1500.0, 1000.0), 18.0, 30.0


def craft(wheel=30.0, turn=0.0):
    """The spacecraft of Rahn and Barba with a small wheel on its minor axis, and a start turned about that."""
    return made(D, K, C, (0, 0, wheel), (0.3 * math.cos(turn), 0.4 * math.sin(turn), 1.5))


def test_on_both_sides_of_the_separatrix_it_ends_as_a_run_in_space_does():
    """The phase at which the end changes, to 1e-3: on either side the other one, by the brute force."""
    ends = {}
    ask = lambda turn: flat_spin(craft(turn=turn)).end
    low, high = 0.0, math.pi
    assert ask(low) != ask(high)  # half a turn about the wheel's axis is a symmetry of the equations
    first = ask(low)
    while high - low > 1e-3:
        middle = (low + high) / 2
        low, high = (middle, high) if ask(middle) == first else (low, middle)
    for turn in (low, high):
        found = flat_spin(craft(turn=turn))
        _, H, _ = brute(D, K, C, (0.0, 0.0, 30.0), (0.3 * math.cos(turn), 0.4 * math.sin(turn), 1.5),
                        2 * found.crosses.at, found.barrier)
        assert np.sign(H[0]) == np.sign(found.rates[0])
        ends[found.end] = turn
    assert len(ends) == 2


@pytest.mark.parametrize(("times", "attract"), [(0.999, 2), (1.001, 1)])
def test_the_threshold_has_both_sides(times, attract):
    """At the spin of the start, h = (2000 - 1000) 1.5; at its |H|, |H|/2: by hand, h D1 = (D1 - D) |H|."""
    found = flat_spin(made(D, K, C, (0, 0, 30), (0, 0.01, 1.5))).threshold
    assert found.at_rate == pytest.approx(1500, rel=1e-15)
    assert flat_spin(made(D, K, C, (0, 0, times * 1500), (0, 0, 1.5))).stable == attract
    size = math.hypot(15, 1530)
    assert found.moment == pytest.approx(size / 2, rel=1e-14)
    scene = Scene(Body(D), ViscousDamper(K, C), Gyrostat((0, 0, times * size / 2)))
    assert flat_spin(load(scene), momentum=size).stable == attract


def test_a_flywheel_on_the_intermediate_axis_holds_the_spin_from_300_rpm_on():
    """(400 - 350) 2 pi N m s over 10 kg m^2 is 10 pi rad/s."""
    text = """[body]
inertia = [350, 300, 400]
[[wheels]]
name = "fly"
axis = [1, 0, 0]
inertia = 10
speed = "{} rpm"
[effects.viscous_damper]
inertia = 5
coefficient = 5
[motion]
angular_velocity = ["60 rpm", 0, 0]
"""
    for speed, nature in ((299, "saddle"), (301, "minimum")):
        found = flat_spin(text.format(speed))
        assert found.threshold.at_rate_wheels == (("fly", pytest.approx(10 * math.pi, rel=1e-14)),)
        own = min(found.rotations, key=lambda item: math.dist(item.rates, (2 * math.pi, 0, 0)))
        assert own.nature == nature and own.rates == pytest.approx((2 * math.pi, 0, 0))


def test_a_start_on_the_level_of_the_pass_is_decided_exactly():
    """D = (4, 2, 4/3), l = 1/2 along axis 3: the pass is at m = 1/2, H = (0, 2.449, 3/2) for |H|^2 = 33/4, and
    E - E_pass = ((H3 - 3/2)^2 - H1^2)/8: zero at H = (1, 1, 5/2), by hand."""
    case = made((4, 2, "4/3"), 0.1, 0.2, (0, 0, 0.5), (0.25, 0.5, 1.5))
    found = flat_spin(case)
    assert found.level == "exact" and found.energy == found.barrier and found.rates[0] > 0
    _, H, _ = brute((4.0, 2.0, 4 / 3), 0.1, 0.2, (0.0, 0.0, 0.5), (0.25, 0.5, 1.5), 600.0, rtol=1e-8)
    assert H == pytest.approx(found.rotations[found.end].momentum, abs=0.1)


@pytest.mark.one_in(2)
@pytest.mark.parametrize(("moments", "wheel", "outcome"), [
    ((2, 2, 1), (0, 0, 0.1), "circle of rotations"), ((2, 1, 1), (0.1, 0, 0), "steady rotation"),
    ((2, 2, 1), (0.1, 0.2, 0.1), "steady rotation"), ((2, 2, 2), (0.1, 0.2, 0.3), "steady rotation"),
    ((1, 2, 2), (0, 0.3, 0), "steady rotation"), ((2, 1, 2), (0, 3, 0), "steady rotation")], ids=str)
def test_equal_moments_end_as_bodies_in_space_do(moments, wheel, outcome):
    omega = (0.3, 0.1, 0.8)
    found = flat_spin(made(moments, 0.2, 0.2, wheel, omega))
    assert (found.outcome, found.level) == (outcome, "exact")
    _, H, T = brute(tuple(map(float, moments)), 0.2, 0.2, tuple(map(float, wheel)), omega, 500.0, rtol=1e-9)
    assert T == pytest.approx(found.final_energy, rel=1e-4)
    end = found.rotations[found.end]
    if not end.axis:
        assert H == pytest.approx(end.momentum, abs=0.03)
    else:
        assert H[end.axis - 1] == pytest.approx(end.momentum[end.axis - 1], abs=0.01)


def test_without_momentum_it_ends_where_the_body_cancels_its_wheels():
    """H1 = 3 (-9/8) + 3/8 + 3 = 0."""
    found = flat_spin(made((3, 2, 1), 0.125, 0.2, (3, 2, 1), (-1.125, -1, -1), (3, 0, 0)))
    assert found.momentum == 0 and found.rates == (-1, -1, -1) and found.level == "exact"


def test_next_to_no_momentum_it_ends_there_too():
    """H1 = 3 (-1.1) + 0.3 + 3 is 0 but for the rounding of its decimals."""
    found = flat_spin(made((3, 2, 1), 0.1, 0.2, (3, 2, 1), (-1.1, -1, -1), (3, 0, 0)))
    assert found.momentum < 1e-15 and found.rates == pytest.approx((-1, -1, -1)) and found.level == "exact"


@pytest.mark.parametrize(("omega", "nature"), [((0, 0, 2.0), "maximum"), ((0, 0, 0.2), "minimum")])
def test_a_start_that_is_a_rotation_itself(omega, nature):
    found = flat_spin(made((3, 2, 1), 0.1, 0.2, (0, 0, 1), omega))
    if nature == "minimum":
        assert found.rates == omega and found.level == "exact"
    else:
        assert found.outcome == "undecided" and nature in found.because


def test_a_start_on_the_saddle_is_undecided():
    """(0, 1, 1): H = (0, 2, 2), m = 1/2."""
    found = flat_spin(made((3, 2, 1), 0.1, 0.2, (0, 0, 1), (0, 1, 1)))
    assert found.outcome == "undecided" and "saddle" in found.because


def test_at_a_fold_what_is_below_it_is_decided_and_what_is_above_is_not():
    """The fold of the momentum sphere's tests: D = (4, 2, 3/2), l = (1, 0, 3), |H|^2 = 45."""
    high = made((4, 2, 1.5), 0.1, 0.2, (1, 0, 3), ((-6 - 1) / 4, 0, 0.0))
    assert high.scene is not None  # |H|^2 = 36 + 9
    found = flat_spin(high)
    assert found.momentum == pytest.approx(math.sqrt(45))
    assert (found.outcome == "undecided") == (found.energy > next(
        item.energy for item in found.rotations if item.nature == "inflection"))


def test_time_constants_are_those_of_a_run():
    """A small departure fades by e^-4 in four time constants, to 5 %: brute force, the angle of H to its end."""
    found = flat_spin(made(D, K, C, (0, 0, 1500), (1e-3, 0, 0.1)))
    tau = found.rotations[found.end].decay
    across = [math.hypot(*brute(D, K, C, (0.0, 0.0, 1500.0), (1e-3, 0.0, 0.1), n * tau, rtol=1e-12)[1][:2])
              for n in (2, 6)]
    assert math.log(across[0] / across[1]) == pytest.approx(4, rel=0.05)


def test_uncertain_numbers_that_leave_the_end_open():
    text = """[body]
inertia = [2000, 1500, 1000]
[effects.gyrostat]
momentum = [0, 0, {wheel}]
[effects.viscous_damper]
inertia = 18
coefficient = 30
[motion]
angular_velocity = [0.1, 0, 1.5]
"""
    sure = flat_spin(text.format(wheel='"2500 +- 10"'))
    assert sure.end is not None and any("samples, no proof" in str(caveat.reason) for caveat in sure.caveats)
    drawn = flat_spin(text.format(wheel='"30 +- 20"'))
    assert drawn.outcome == "undecided" and "motions drawn" in drawn.because


def test_a_liquid_beside_a_wheel_is_answered_as_far_as_any_loss_is():
    scene = Scene(Body((3, 2, 1.5)), Gyrostat((0, 0, 3)), LiquidCavity(1, 1, 0.1))
    found = flat_spin(load(scene, (0.1, 0, 0.5)))
    assert found.level == "exact" and found.settles is None and "of a liquid" in found.because
    small = Scene(Body((3, 2, 1.5)), Gyrostat((0, 0, 0.01)), LiquidCavity(1, 1, 0.1))
    found = flat_spin(load(small, (0.1, 0, 1.5)))
    assert found.outcome == "undecided" and found.stable == 2


def test_a_case_answers_as_the_function_does():
    case = craft()
    assert case.flat_spin().rates == flat_spin(case).rates
    assert case.flat_spin(momentum="2 N m s") == flat_spin(case, momentum=2)


def test_a_run_that_is_too_long_leaves_it_open(monkeypatch):
    monkeypatch.setattr(gyrostat, "RUN_STEPS", 50)
    found = flat_spin(craft())
    assert found.outcome == "undecided" and "by the end of the run" in found.because and found.stable == 2


@pytest.mark.parametrize(("momentum", "words"), [
    ("-1 N m s", "at least 0"), ("3 kg", "momentum"), ("fast", "momentum")])
def test_a_momentum_that_is_none_is_an_error(momentum, words):
    with pytest.raises(InputError, match=words):
        flat_spin(made(D, K, C, (0, 0, 30), (0, 0, 1)), momentum=momentum)


def test_the_rotations_at_a_momentum_need_no_start_and_no_losses(stabilab, tmp_path):
    path = tmp_path / "free.toml"
    path.write_text("[body]\ninertia = [3, 2, 1]\n[effects.gyrostat]\nmomentum = [0, 0, 1]\n")
    printed = json.loads(stabilab("flat-spin", path, "--momentum", "2.8 N m s", "--json")[1])
    natures = [item["nature"] for item in printed["rotations"]]
    assert natures == ["minimum", "minimum", "saddle", "saddle", "maximum", "maximum"]
    assert all(item["growth_time"] is None for item in printed["rotations"] if item["nature"] == "maximum")
    code, _, said = stabilab("flat-spin", path, "--momentum", "-1 N m s")
    assert code == 2 and "--momentum" in said
