"""Uncertain numbers where the geometry of the motion is degenerate: pure spins, parabolas, invariant planes,
equal moments.

The truths are exact solutions and proofs named on the lines; single points are asked of the ordinary
command's code.
"""
import numpy as np
import pytest

from stabilab.answers.uncertain.boxes import box_of
from stabilab.answers.uncertain.branch_and_bound import Proof
from stabilab.answers.uncertain.equilibria import signature_at
from stabilab.answers.uncertain.fate import fate_over, look_at, uncertain
from stabilab.answers.uncertain.result import bracketed
from stabilab.case.read import load
from tests.answers.uncertain.test_verdicts import BODY, case_of, sampled

SPIN_2 = "spin-up about axis 2, positive direction"


def fate_of(folder, **numbers):
    return uncertain(case_of(folder, **numbers), ("fate",)).fate


# -- the fate


def test_a_box_without_a_motion_has_no_fate(tmp_path):
    path = tmp_path / "case.toml"
    text = BODY.format(inertia='"20 +- 1 %", 15, 10', momentum="0, 0, 0", torque_key="torque",
                       torque="0, 0, 1", state_key="x", state="")
    path.write_text(text.split("[motion]")[0])
    case = load(path)
    assert fate_over(box_of(case)) is None and uncertain(case).fate is None and uncertain(
        case).equilibria.answer == "holds"


def test_where_a_moment_is_not_positive_there_is_no_verdict(tmp_path):
    box = box_of(case_of(tmp_path, inertia='"20 +- 0.4", 10, "10.9 +- 0.4"', state="0, 0, 1"))
    assert look_at(box, np.array([1.0, -30.0]))[0] is None  # 10.9 - 12 < 0
    # 21.2 > 10 + 9.7: Euler's equations hold all the same
    assert look_at(box, np.array([3.0, -3.0]))[0] == "spin-up about axis 3, positive direction"


@pytest.mark.parametrize("inertia, axis", [("20, 15, 10", 2), ("20, 20, 10", 1)])
def test_a_pure_spin_along_the_torque_spins_up_for_any_torque_of_one_sign(tmp_path, inertia, axis):
    """omega = (omega0 + M t/D) e_axis solves Euler's equations: about the middle axis, and about one of two
    equal ones."""
    torque, state = ["0"] * 3, ["0"] * 3
    torque[axis - 1], state[axis - 1] = '"1 +- 10 %"', '"-0.5 +- 0.2"'
    over = fate_of(tmp_path, inertia=inertia, torque=", ".join(torque), state=", ".join(state))
    assert (over.answer, over.verdict) == ("holds", SPIN_2.replace("2", str(axis))) and over.proved == 1


def test_a_pure_spin_that_may_have_a_rate_across_it_depends(tmp_path):
    # about the middle axis the potential grows on both sides of every other orbit: bounded off the invariant
    # planes
    over = fate_of(tmp_path, torque='0, "1 +- 10 %", 0', state='0, 1, "0 +- 0.1"')
    assert over.answer == "depends" and {w.verdict for w in over.witnesses} == {SPIN_2, "bounded"}


def test_on_a_parabola_motions_stay_between_walls_but_where_the_force_is_constant(tmp_path):
    """Equal moments 1 and 2, torque about 1: omega_3 = const - (lambda_2 ...) is linear in the angle, so U
    grows like its fourth power."""
    over = fate_of(tmp_path, inertia="20, 20, 10", momentum='0, "3 +- 1 %", 1', torque='"1 +- 10 %", 0, 0',
                   state="0.1, 0.2, 0.3")
    assert (over.answer, over.verdict) == ("holds", "bounded") and "parabola" in over.but


def test_motions_that_surely_lie_on_an_invariant_plane_are_left_to_samples(tmp_path):
    """D = (9, 5, 4) about axis 2: p = (D1 - D2)/D3 = 1 and q = (D2 - D3)/D1 = 1/9, so omega_1^2 = omega_3^2/9
    is the plane."""
    over = fate_of(tmp_path, inertia="9, 5, 4", torque='0, "1 +- 10 %", 0', state='1, "0.5 +- 0.1", 3')
    other = fate_of(tmp_path, inertia="9, 5, 4", torque='0, "1 +- 10 %", 0', state='-1, "0.5 +- 0.1", 3')
    assert {over.verdict, other.verdict} == {"bounded", SPIN_2}  # one plane grows ahead, the other decays
    assert all(one.answer == "sampled" for one in (over, other))
    assert "every motion of the box lies on an invariant plane" in (over if over.verdict == "bounded"
                                                                    else other).because
    beside = fate_of(tmp_path, inertia="9, 5, 4", torque='0, "1 +- 10 %", 0', state='1, "0.5 +- 0.1", 4')
    assert (beside.answer, beside.verdict, beside.but) == ("holds", "bounded", "")


def test_rest_on_a_saddle_is_bounded_and_nothing_around_it_is(tmp_path):
    """D = (20, 15, 10), M3 = 5: 5 omega_1 omega_2 + 5 = 0 holds at (0.5, -2, 0), a saddle; with any spin
    about axis 3 the energy is above the one barrier that stands ahead within a turn, so every other point of
    the box spins up."""
    over = fate_of(tmp_path, torque="0, 0, 5", state='0.5, -2, "0 +- 0.1"')
    assert over.verdict == "bounded" and over.answer == "depends" and over.changes_at == 0
    assert [w.verdict for w in over.witnesses] == ["bounded", "spin-up about axis 3, positive direction"]
    assert over.neighbours.verdict == "unstable"
    box = box_of(case_of(tmp_path, torque="0, 0, 5", state='0.5, -2, "0 +- 0.1"'))
    assert {look_at(box, np.array([p]))[0]
            for p in (-1, -1e-6, 1e-9, 1)} == {"spin-up about axis 3, positive direction"}
    assert fate_of(tmp_path, torque="0, 0, 5", state='"0.5 +- 0.1", -2, 0').answer == "depends"


def test_proofs_end_where_the_moments_may_become_equal(tmp_path):
    over = fate_of(tmp_path, inertia='"20 +- 0.1", "15 +- 1", "10 +- 1"', torque="0, 0, 0.01",
                   state="3, 0.1, 0.1")
    # 15 - 2.5 = 10 + 2.5
    assert (over.answer, over.verdict) == ("holds", "bounded") and 1 <= over.proved <= 2.5


# -- what brackets an answer: a line with its change at a half, known exactly


class Line:
    places = (("x", 0),)

    @staticmethod
    def values(point):
        return tuple(map(float, point))


def at(point):
    return "left" if point[0] < 0.5 else "right"


def test_a_contradiction_that_a_proof_meets_is_a_change_where_the_ordinary_code_confirms_it():
    def attempt(stretch, most):
        return Proof(False, 1, (0.7,)) if stretch >= 0.7 else Proof(stretch < 0.5 or None, 1)
    over = bracketed(Line, "left", at, None, attempt, "")
    assert over.answer == "depends" and over.changes_at == 0.7
    assert [w.verdict for w in over.witnesses] == ["left", "right"]
    assert 0 < over.proved < 0.5


@pytest.mark.parametrize("point", [(0.0,), (0.3,)])
def test_a_contradiction_that_the_ordinary_code_denies_proves_nothing(point):
    over = bracketed(Line, "left", at, None, lambda stretch, most: Proof(False, 1, point), "")
    assert over.answer == "undecided" and over.proved == 0 and not over.witnesses


# -- equilibria


def equilibria_of(folder, **numbers):
    case = case_of(folder, state="0.1, 0.2, 0.3", **numbers)
    return uncertain(case, ("equilibria",)).equilibria, box_of(case)


def test_without_a_torque_a_wheel_leaves_the_equilibria_to_samples(tmp_path):
    over, _ = equilibria_of(tmp_path, momentum='"3 +- 1 %", 1, 2', torque="0, 0, 0")
    assert over.answer == "sampled" and "without a torque" in over.because and over.samples.number == 64


def test_a_torque_in_the_plane_of_two_equal_moments_is_left_to_samples(tmp_path):
    over, _ = equilibria_of(tmp_path, inertia="20, 20, 10", torque='"1 +- 10 %", 2, 0')
    assert over.answer == "sampled" and "two equal moments" in over.because and over.samples.number == 64


@pytest.mark.parametrize("inertia", ["15, 15, 10", "10, 10, 10"])
def test_a_line_of_equilibria_across_two_equal_moments_holds_where_the_points_say_so(tmp_path, inertia):
    """Equal moments across the torque on axis 3: lambda x omega + M = 0 leaves a line omega_3 = s (for three
    equal moments omega = (lambda x M)/|lambda|^2 + s lambda), whatever the size of the wheel across."""
    over, box = equilibria_of(tmp_path, inertia=inertia, momentum='"3 +- 10 %", 1, 0',
                              torque='0, 0, "2 +- 10 %"')
    assert over.answer == "holds" and over.proved >= 1
    assert {signature_at(box, point) for point in sampled(box, 9, 1)} == {over.verdict}
    vanishing, box = equilibria_of(tmp_path, inertia=inertia, momentum='"0 +- 1", 0, 0', torque="0, 0, 2")
    assert vanishing.answer == "depends"  # without a wheel across D3 omega_3' = M3: no equilibrium at all
    assert len({w.verdict for w in vanishing.witnesses}) == 2
    assert signature_at(box, np.zeros(1)) != signature_at(box, np.ones(1))


def test_without_a_wheel_a_torque_across_equal_moments_leaves_no_equilibrium(tmp_path):
    over, box = equilibria_of(tmp_path, inertia="15, 15, 10", torque='0, 0, "2 +- 10 %"')
    assert over.answer == "holds" and over.verdict == signature_at(box, np.ones(1))


# -- which boxes there are


def scaled_text(inertia, momentum, mu="mu = [0, 0, 1]"):
    return (f"[body]\ninertia = [{inertia}]\n[effects.gyrostat]\nmomentum = "
            f"[{momentum}]\n[effects.constant_torque]\n{mu}\n"
            "[motion]\nx = [2.5, 4.0, 0.1]\n")


@pytest.mark.parametrize("inertia, momentum, words", [
    ('1900, "1500 +- 300", "1000 +- 250"', "100, 0, 0", "falling order"),
    ("2000, 1500, 1000", '100, "0 +- 1", 0', "along axis 1")])
def test_scaled_variables_need_moments_in_falling_order_and_a_wheel_on_axis_1(case_file, inertia, momentum,
                                                                              words):
    path = case_file(scaled_text(inertia, momentum))
    over = uncertain(load(path))
    assert over.fate.answer == over.equilibria.answer == "undecided" and words in over.fate.because


def test_scaled_variables_of_uncertain_moments_hold_those_of_each_body(case_file):
    """a = lambda_1/((D1 - D3) sqrt(k1)), b = lambda_1/((D1 - D2) sqrt(k1)), k1 = (D2 - D3)/D1 with the torque
    as mu (Amer et al. 2024, (4))."""
    path = case_file(scaled_text('"2000 +- 10", 1500, 1000', '"100 +- 5", 0, 0'))
    box = box_of(load(path))
    numbers = box.numbers(np.zeros((1, 2)), np.ones((1, 2)))
    form = box.rates(numbers)
    for D1, wheel in ((1990, 95), (2000, 100), (2010, 105), (2005, 97)):
        strength = (500 / D1) ** 0.5
        a, b = wheel / ((D1 - 1000) * strength), wheel / ((D1 - 1500) * strength)
        assert form.rho[2].low[0] <= b <= form.rho[2].high[0] and form.sigma[1].low[0] <= -a <= form.sigma[
            1].high[0]
        scene, state = box.at(np.array([(D1 - 2000) / 10, (wheel - 100) / 5]))
        assert scene.a == pytest.approx(a, rel=1e-14) and scene.b == pytest.approx(b, rel=1e-14)
        assert state == (2.5, 4.0, 0.1)


def test_other_effects_are_not_followed_over_a_box(case_file):
    path = case_file('[body]\ninertia = ["8 +- 1 %", 5, 4]\n[effects.resistance]\ncoefficient = '
                     '0.5\n[motion]\nangular_velocity = [1, 1, 1]\n')
    over = uncertain(load(path))
    assert over.fate.answer == over.equilibria.answer == "undecided" and "other effects" in over.fate.because
