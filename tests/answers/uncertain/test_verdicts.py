"""Uncertain numbers: what is said of a whole box is true of every point that other code can look at."""
import json
import re
from fractions import Fraction

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from stabilab.answers.uncertain.boxes import box_of
from stabilab.answers.uncertain.equilibria import signature_at
from stabilab.answers.uncertain.fate import uncertain
from stabilab.case.read import load
from stabilab.errors import CaseError
from stabilab.numbers.affine import Affine, root
from stabilab.show.text import classification as shown
from tests.oracles.rigid import euler
from tests.shared import CASES

BODY = """
[body]
inertia = [{inertia}]
[effects.gyrostat]
momentum = [{momentum}]
[effects.constant_torque]
{torque_key} = [{torque}]
[motion]
{state_key} = [{state}]
"""


def case_of(folder, inertia="20, 15, 10", momentum="0, 0, 0", torque="0, 0, 1", state="0, 0, 0",
            torque_key="torque",
            state_key="angular_velocity"):
    path = folder / "case.toml"
    path.write_text(BODY.format(**{k: v for k, v in locals().items() if k not in ("folder", "path")}))
    return load(path)


def listed(middles, share):
    """Numbers with a relative uncertainty as a case file states them; zeros stay certain."""
    return ", ".join(f'"{m!r} +- {100 * share} %"' if m else "0" for m in middles)


def random_case(folder, seed, share, axis):
    """A body with a torque on a principal axis, a wheel across it and a state, every non-zero number
    uncertain."""
    rng = np.random.default_rng(seed)
    D = np.sort(rng.uniform(1, 2, 3))[::-1] * (20, 15, 10) / 15
    D[0] = min(D[0], 0.9 * (D[1] + D[2]))
    lam, torque = rng.normal(0, 3, 3), np.zeros(3)
    lam[axis], torque[axis] = 0, rng.choice((-1, 1)) * 10 ** rng.uniform(-2, 0.3)
    state = rng.normal(0, 0.6, 3)
    numbers = [[float(f"{v:.6g}") for v in row] for row in (D, lam, torque, state)]
    return case_of(folder, *(listed(row, share) for row in numbers))


def sampled(box, count, seed):
    """Points of the box, a third of them corners."""
    points = np.random.default_rng(seed).uniform(-1, 1, (count, len(box.places)))
    points[::3] = np.sign(points[::3])
    return points


def numbers_at(box, points):
    """(D, lambda, M, omega), (points, 3) each, of a box in physical variables."""
    out = {name: np.tile([float(v) for v in values], (len(points), 1)) for name, values in box.middle.items()}
    for column, (name, i) in zip(points.T, box.places):
        out[name][:, i] += column * float(box.half[name][i])
    return out["inertia"], out["momentum"], out["torque"], out["state"]


def walls_ahead(box, points, axis, turns=1500):
    """max over one turn ahead of U - E, J, from Euler's equations in physical variables on a grid of the
    angle: the linear pair of omega_j, omega_k solved by cosine and sine, U from the work-energy law. Shares
    no code with the program."""
    D, lam, M, w = numbers_at(box, points)
    i, j, k = axis, (axis + 1) % 3, (axis + 2) % 3
    p, q = (D[:, k] - D[:, i]) / D[:, j], (D[:, i] - D[:, j]) / D[:, k]
    n = np.sqrt(-p * q)
    sk, sj = lam[:, k] / (D[:, k] - D[:, i]), lam[:, j] / (D[:, j] - D[:, i])
    u, v, best = w[:, j] + sj, w[:, k] + sk, np.full(len(points), -np.inf)
    towards = np.sign(M[:, i])
    for angle in np.arange(1, turns + 1) * (2 * np.pi / turns):
        alpha = towards * angle / n
        cos, sin = np.cos(n * alpha), np.sin(n * alpha)
        wj, wk = u * cos + p / n * v * sin - sj, v * cos + q / n * u * sin - sk
        rise = 0.5 * (D[:, j] * (wj**2 - w[:, j]**2) + D[:, k] * (wk**2 - w[:, k]**2)) - M[:, i] * alpha
        best = np.maximum(best, rise - 0.5 * D[:, i] * w[:, i]**2)
    return best


@pytest.mark.one_in(3)
@pytest.mark.parametrize("seed", [0, 1, 2, *(pytest.param(n, marks=pytest.mark.slow) for n in range(3, 13))])
@pytest.mark.parametrize("axis", (0, 2))
def test_no_sampled_point_contradicts_what_holds_or_what_is_proved(tmp_path, seed, axis):
    case = random_case(tmp_path, 100 * axis + seed, 0.01, axis)
    box, over = box_of(case), uncertain(case, ("fate",)).fate
    assert over.answer in ("holds", "depends")
    safe = 0.9999 * over.proved
    excess = walls_ahead(box, safe * sampled(box, 300, seed), axis)
    # half a step of the grid, at most, lies between it and the top: a few parts in 10^5 of the height of the
    # waves
    doubt = 1e-4 * (np.abs(excess).max() + 1)
    assert ((excess > -doubt) if over.verdict == "bounded" else (excess < doubt)).all()
    assert (np.abs(excess) > doubt).mean() > 0.9


@pytest.mark.one_in(2)
@pytest.mark.parametrize("seed", range(4))
def test_a_change_that_is_reported_is_there_and_lies_beyond_what_is_proved(tmp_path, seed):
    case = random_case(tmp_path, 40 + seed, 0.01, 2)
    box, over = box_of(case), uncertain(case, ("fate",)).fate
    assert over.proved > 0
    if over.changes_at is not None:
        assert over.proved < over.changes_at
        assert [w.verdict for w in over.witnesses] == [over.verdict,
                                                       *{w.verdict for w in over.witnesses} - {over.verdict}]
        for name, index in box.places:
            away = over.witnesses[1].values[name][index] - box.middle[name][index]
            assert abs(away) <= Fraction(over.changes_at) * box.half[name][index] * (1 + Fraction(1, 10**12))


def test_a_box_across_the_separatrix_has_a_witness_on_each_side_that_the_ordinary_command_confirms(
    tmp_path, stabilab):
    case = load(CASES / "uncertain-separatrix.toml")
    over = uncertain(case, ("fate",)).fate
    assert over.answer == "depends" and over.changes_at < 1 and over.proved > 0.9 * over.changes_at
    words = []
    for witness in shown.uncertain_dict(uncertain(case, ("fate",)))["uncertain"]["fate"]["witnesses"]:
        quoted = {name: ", ".join(f'"{v}"' for v in witness[name])
                  for name in ("inertia", "momentum", "torque", "state")}
        case_of(tmp_path, **quoted)
        code, out, _ = stabilab("fate", str(tmp_path / "case.toml"), "--json")
        answer = json.loads(out)[0]
        assert code == 0 and "uncertain" not in answer
        words.append(answer["fate"])
    assert words == ["bounded", "spin-up"]


def test_the_nearest_change_is_the_square_root_law_of_a_single_uncertain_rate(tmp_path):
    # With omega_3 alone uncertain the flip is at the barrier's own speed: margin in energy = D3 (w^2 -
    # w0^2)/2.
    case = case_of(tmp_path, momentum="3, 2, 0", torque="0, 0, 0.1", state='0.2, 0.15, "1.7 +- 0.001"')
    from stabilab.answers.motion import motion
    margin = motion(case.scene, case.state).margin_energy
    speed = np.sqrt(1.7**2 + 2 * margin / 10)
    over = uncertain(case, ("fate",)).fate
    assert over.answer == "holds" and over.changes_at == pytest.approx((speed - 1.7) / 0.001, rel=1e-5)
    assert over.proved > 0.99 * over.changes_at


def test_a_start_on_the_separatrix_depends_with_both_sides(case_file):
    # scaled minor axis, a = b = 0: equilibria X = -1/h, x2 = h, centre iff h^4 < 1 (theory: h^4 - c h - 1 <
    # 0)
    path = case_file('[scaled]\na = 0\nb = 0\nmu = [0, 0, "1 +- 1 %"]\n[motion]\nx = ["0.5 +- 1 %", -2, 0]\n')
    over = uncertain(load(path), ("fate",)).fate  # h = -2: a saddle, at rest
    assert over.answer == "depends" and {w.verdict.split()[0]
                                         for w in over.witnesses} == {"bounded", "spin-up"}
    assert over.changes_at < 1e-3


@pytest.mark.one_in(2)
@pytest.mark.parametrize("scale", (1e-6, 1e6))
def test_units_do_not_matter(tmp_path, scale):
    """Moments, momentum and torque in another unit of mass, and rates in another unit of time: the same
    dimensionless box."""
    def answer(mass, rate):
        rows = ([20, 15, 10], [3, 2, 0], [0, 0, 0.1], [0.2, 0.15, 1.6])
        factors = (mass, mass * rate, mass * rate**2, rate)
        scaled = [listed([float(v * f) for v in row], 0.01) for row, f in zip(rows, factors)]
        return uncertain(case_of(tmp_path, *scaled), ("fate",)).fate
    one, other = answer(1, 1), answer(scale, 1 / scale)
    assert (other.answer, other.verdict) == (one.answer, one.verdict)
    assert other.changes_at == pytest.approx(one.changes_at,
                                             rel=1e-4) and other.proved == pytest.approx(one.proved, rel=1e-3)


def test_affine_numbers_shrink_to_rounding_without_width_and_are_open_where_undefined():
    point = Affine(np.array([3.0]), np.zeros((1, 1)), np.zeros(1))
    assert 0 < (point * point / 7).high[0] - 9 / 7 < 1e-13
    across = Affine(np.array([0.1]), np.array([[0.2]]), np.zeros(1))
    for undefined in (1 / across, root(across), root(across - 1)):  # zero is among them, or all are negative
        assert not undefined.low[0] > -1e300 or np.isnan(undefined.low[0])
        assert undefined.sign[0] == 0


# -- geometry and class of scene


def test_between_walls_everything_is_bounded_but_for_a_set_of_measure_zero(tmp_path):
    # middle axis: hyperbolas; a start far from and across the invariant planes
    rest = {"torque": '0, "1 +- 10 %", 0', "inertia": listed((20.0, 15.0, 10.0), 0.01)}
    far = uncertain(case_of(tmp_path, state='0.5, 0, "0.1 +- 10 %"', **rest), ("fate",)).fate
    assert (far.answer, far.verdict, far.but) == ("holds", "bounded", "")
    near = uncertain(case_of(tmp_path, state='"0 +- 0.5", 0, 0.1', **rest), ("fate",)).fate
    assert near.answer == "holds" and "invariant plane" in near.but


def test_a_wheel_along_the_torque_leaves_nothing_bounded_and_may_not_vanish(tmp_path):
    always = uncertain(case_of(tmp_path, momentum='"3 +- 10 %", 0, 0', torque="1, 0, 0",
                               state="0.1, 0, 0")).fate
    assert (always.answer, always.verdict) == ("holds", "unbounded")
    maybe = uncertain(case_of(tmp_path, momentum='"0 +- 0.1", 5, 0', torque="0.01, 0, 0",
                              state="0, 0, 0")).fate
    assert maybe.answer in ("depends", "sampled") and "may vanish" in maybe.because


def test_off_the_axes_the_fate_is_sampled_and_says_why(tmp_path):
    over = uncertain(case_of(tmp_path, torque='0, "0 +- 0.1", 1', state="0, 0, 1"))
    assert over.fate.answer == "sampled" and "off the principal axes" in over.fate.because
    assert "no proof for the box; of 64 sampled points (seed 20261122) all: spin-up about axis 3, positive direction" in over.fate.because
    assert over.fate.samples.counts == {
        over.fate.verdict: 64} and over.fate.samples.otherwise == pytest.approx(1 - 0.05**(1 / 64))
    # the equilibria depend on the tilt, and that is said too
    assert [one.kind for one in over.caveats] == ["uncertain", "samples"] and over.equilibria.answer == "depends"
    assert over.fate.verdict == "spin-up about axis 3, positive direction"


def test_moments_that_may_be_equal_are_no_ground_for_a_proof(tmp_path):
    case = case_of(tmp_path, inertia='"20 +- 1", "20 +- 1", 10', torque="1, 0, 0", state="0.3, 0.2, 0.1",
                   momentum="0, 1, 1")
    over = uncertain(case, ("fate",)).fate
    assert over.answer == "depends" and "may be equal" in over.because and over.samples.counts[
        "bounded"] == 63
    for witness in over.witnesses:  # by DOP853: a spin-up passes every bound in the end, as omega' -> M/D
        D, h, M, w = (np.array([float(v) for v in witness.values[name]])
                      for name in ("inertia", "momentum", "torque", "state"))
        run = solve_ivp(euler(D, h, M), (0, 300), w,
                        method="DOP853", rtol=1e-9, atol=1e-10)
        assert (np.abs(run.y[0]).max() > 0.5 * 300 * M[0] / D[0]) == witness.verdict.startswith("spin-up")


def test_a_torque_of_either_sign_cannot_say_which_way_a_body_spins_up(tmp_path):
    over = uncertain(case_of(tmp_path, torque='0, 0, "0.1 +- 0.2"', state="0, 0, 1")).fate
    assert over.answer == "depends" and {w.verdict for w in over.witnesses} == {
        "spin-up about axis 3, positive direction", "spin-up about axis 3, negative direction"}
    assert over.changes_at == pytest.approx(0.5, rel=1e-3)


def test_without_a_torque_every_motion_is_bounded(tmp_path):
    over = uncertain(case_of(tmp_path, inertia=listed((20.0, 15.0, 10.0), 0.01), torque="0, 0, 0",
                             state="0.3, 0.2, 0.1"))
    assert (over.fate.answer, over.fate.verdict) == ("holds", "bounded")
    assert over.equilibria.answer == "holds"


# -- equilibria


@pytest.mark.one_in(6)
@pytest.mark.parametrize("seed", [0, 1, *(pytest.param(n, marks=pytest.mark.slow) for n in (2, 3))])
@pytest.mark.parametrize("axes", ((2,), (1,), (0, 1), (0, 1, 2)))
def test_sampled_bodies_have_the_equilibria_that_hold(tmp_path, seed, axes):
    rng = np.random.default_rng(10 * seed + len(axes))
    lam, torque = rng.normal(0, 3, 3), np.zeros(3)
    torque[list(axes)] = rng.choice((-1, 1), len(axes)) * rng.uniform(0.1, 1, len(axes))
    lam[axes[0]] = 0 if len(axes) == 1 else lam[axes[0]]
    rows = [[float(f"{v:.4g}") for v in row] for row in (lam, torque)]
    case = case_of(tmp_path, listed((20.0, 15.0, 10.0), 0.005), *(listed(row, 0.005) for row in rows),
                   "0.1, 0.2, 0.3")
    over, box = uncertain(case, ("equilibria",)).equilibria, box_of(case)
    if over.answer == "holds":
        for point in sampled(box, 6, seed):
            assert signature_at(box, 0.999 * over.proved * point) in (over.verdict, None)
    else:
        assert over.answer == "depends" and len({w.verdict for w in over.witnesses}) == 2
    if over.changes_at is not None:
        assert over.proved <= over.changes_at and over.witnesses[0].verdict != over.witnesses[1].verdict


def test_two_equilibria_that_may_meet_depend_on_the_numbers(case_file):
    fold = load(CASES / "off-axis-fold.toml")  # exactly on the fold
    assert fold.scene.plain
    text = (CASES / "off-axis-fold.toml").read_text()
    path = case_file(re.sub(r"(momentum = \[)\s*([-\d.]+)", r'\1"\2 +- 1 %"', text, count=1)
                     if "momentum" in text else
                     re.sub(r"^a = ([-\d.]+)", r'a = "\1 +- 1 %"', text, count=1, flags=re.M))
    over = uncertain(load(path), ("equilibria",)).equilibria
    assert over.answer == "depends" and over.changes_at < 1e-3


def test_the_number_of_equilibria_is_one_only_where_the_third_torque_vanishes(tmp_path):
    torque = '"0.1 +- 1 %", "0.2 +- 1 %", {}'

    def ask(third):
        return uncertain(case_of(tmp_path, momentum="3, 2, 1", torque=torque.format(third)),
                         ("equilibria",)).equilibria
    across = ask('"0.005 +- 0.01"')
    assert across.answer == "holds" and "infinity" in across.but
    on_it = ask('"0 +- 0.01"')
    assert on_it.answer == "depends" and [w.verdict.split(":")[1].split()[0]
                                          for w in on_it.witnesses] == ["1", "2"]


def test_an_uncertain_start_has_no_part_in_the_equilibria(tmp_path):
    over = uncertain(case_of(tmp_path, state='"0 +- 1", 0, 0')).equilibria
    assert over.answer == "holds" and over.proved == np.inf and over.parts == 0


# -- case files and commands


BAD = {'"2000 +- "': "expected a number and its uncertainty", '"2000 +- -20"': "half-width",
       '"+- 20"': "expected a number",
       '"2000 +- 20 +- 3"': "expected a number", '"2000 ± x %"': "expected a number",
       '"0 +- 1 %"': "percentage of zero",
       '"2000 +- 1e400"': "larger than the largest double", '"2000 % +- 20"': "expected a number",
       '"nan +- 1"': "expected a number",
       '"2000 +- 3000"': "no rigid body"}


@pytest.mark.parametrize("text", BAD)
def test_a_malformed_uncertainty_is_told_with_line_and_key(tmp_path, text):
    with pytest.raises(CaseError) as error:
        case_of(tmp_path, inertia=f"{text}, 1500, 1000")
    first = str(error.value).splitlines()[0]
    assert first.startswith(f"{tmp_path / 'case.toml'}:3: body.inertia: number 1: ") and BAD[text] in first


def test_keys_that_are_no_measured_numbers_take_no_uncertainty(tmp_path):
    with pytest.raises(CaseError, match=r":10: motion.span: .*takes no uncertainty"):
        case_of(tmp_path, state='0, 0, 0]\nspan = [0, "1 +- 1"')


def test_uncertainties_are_read_exactly_in_both_spellings(tmp_path):
    case = case_of(tmp_path, inertia='"20.1 +- 0.1", "15 ± 1 %", " 10+-1e-1 "', momentum='"2/3 +- 1/3", 0, 0')
    assert [(u.path[-2:], u.middle, u.half) for u in case.uncertain] == [
        (("inertia", 0), Fraction("20.1"), Fraction("0.1")), (("inertia", 1), 15, Fraction("0.15")),
        (("inertia", 2), 10, Fraction("0.1")), (("momentum", 0), Fraction(2, 3), Fraction(1, 3))]
    assert case.scene.body.exact == (Fraction("20.1"), 15, 10)  # everything else has the middles


def test_a_half_width_of_zero_is_no_uncertainty(tmp_path):
    assert case_of(tmp_path, inertia='"20 +- 0", 15, 10').uncertain == ()


def test_an_ordinary_box_needs_few_parts():
    over = uncertain(load(CASES / "uncertain-minor-axis.toml"))
    assert over.fate.parts < 20_000 and over.equilibria.parts < 20_000
