"""What is refused, and the least that is answered: single samples, empty spans, constants, numbers beside the range."""
import math
from dataclasses import dataclass
from fractions import Fraction
from types import SimpleNamespace
from typing import ClassVar

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene
from stabilab.cost import effects as effect_cost
from stabilab.answers.digits import run as precision_digits
from stabilab.integrate import trajectory as trajectories
from stabilab.numbers.balls import Digits, DOUBLE_BITS, settled
from stabilab.orbit.separatrix.circle_kernel import force, moved, real_cubic, settled as settled_on_circle
from stabilab.numbers.double_ball import Unclear
from stabilab.answers.equilibria import equilibria, other_equilibria
from stabilab.physics.coefficients import content
from stabilab.orbit.landscape import landscape
from stabilab.orbit.separatrix.homoclinic import settled_on
from stabilab.theories.follow import models_of
from stabilab.answers.motion import motion
from stabilab.unreduced.bounds import motion as other_motion
from stabilab.physics.motion_units import in_unit
from stabilab.numbers.polynomial import Poly, real_roots
from stabilab.cost.methods import problem
from stabilab.answers.digits.ask import ask, ask_all
from stabilab.answers.digits.checked import digits_of
from stabilab.theories.top.euler_angles import euler_angles
from stabilab.orbit.flow.table import tabulated
from stabilab.answers.trajectory import trajectory
from stabilab.physics.effects.base import Effect
from stabilab.physics.effects.resistance import Resistance
from stabilab.errors import InputError

MINOR = ScaledGyrostat("0.2", "0.4", (0, 0, 1))


# -- Euler's angles of samples


def spinning(t):
    """Samples of a body that turns at rate 2 about axis 3, tilted by 0.3: gamma turns back in the body, psi' = 0."""
    t = np.asarray(t, float)
    gamma = np.stack([math.sin(0.3) * np.sin(2 * t), math.sin(0.3) * np.cos(2 * t), np.full(t.shape, math.cos(0.3))], axis=-1)
    return t, np.tile([0.0, 0.0, 2.0], (t.size, 1)), gamma


def test_samples_that_are_none_are_refused():
    t, omega, gamma = spinning(np.linspace(0, 1, 9))
    for bad in ((t, omega[:-1], gamma), (t[:, None], omega, gamma), (t[:0], omega[:0], gamma[:0]), (t, omega, gamma[:, :2])):
        with pytest.raises(InputError, match="shapes"):
            euler_angles(*bad)
    for times in (t[::-1], np.zeros(9)):
        with pytest.raises(InputError, match="increasing"):
            euler_angles(times, omega, gamma)
    with pytest.raises(InputError, match="other than zero"):
        euler_angles(t, omega, 0 * gamma)


def test_angles_of_one_sample_and_of_a_pure_spin():
    one, many = (euler_angles(*spinning(t), psi0=0.5) for t in ([0.25], np.linspace(0.25, 3, 56)))
    for found in (one, many):
        np.testing.assert_allclose(found.psi, 0.5, atol=1e-9)  # omega along axis 3 alone turns phi, not psi
        np.testing.assert_allclose(found.theta, 0.3, rtol=1e-12)
    np.testing.assert_allclose(np.diff(many.phi), 0.1, rtol=1e-9)


# -- separatrices


def test_a_mesh_that_cannot_be_made_is_refused_and_a_parabola_has_none():
    for wrong in ({"shape": (2, 9)}, {"shape": (9, 4)}, {"reach": 1.0}, {"reach": -2}, {"shape": (9, 9), "accuracy": 1e-3}, {"accuracy": 0.0}):
        with pytest.raises(InputError):
            stabilab.separatrix(MINOR, **wrong)
    found = stabilab.separatrix(Scene(Body((2, 2, 1)), ConstantTorque((1, 0, 0))))
    assert not found.sheets and "parabolic" in found.reason


@pytest.mark.parametrize("roots", [(1.0, 2.0, 4.0), (-3.0, 0.5, 0.5 + 1e-3), (2.0,), (-1.0, 5.0), ()])
def test_real_roots_of_cubics_and_of_what_is_left_of_them(roots):
    pairs = {0: [0.0, 1.0, 0.0, 1.0], 1: [0.0, 0.0, 3.0, -6.0]}  # t^2 + 1 and 3 t - 6
    c = pairs[len(roots)] if len(roots) < 2 else [*([0.0] * (3 - len(roots))), *np.poly(roots)]
    found = sorted(t for t in real_cubic(*c) if not math.isnan(t))
    np.testing.assert_allclose(found, roots, rtol=1e-9)
    assert sorted(t for t in real_cubic(1.0, 0.0, 1.0, -2.0) if not math.isnan(t)) == pytest.approx([1.0])  # (t - 1)(t^2 + t + 2)
    assert all(map(math.isnan, real_cubic(0.0, 0.0, 0.0, 1.0))) and 0.0 in real_cubic(0.0, 1.0, 0.0, 0.0)


@pytest.mark.parametrize("off", [0.0, 1e-9, 1e-3, 0.05])
def test_a_place_near_an_equilibrium_moves_onto_it_and_no_other(off):
    land = landscape(MINOR)
    pot = land.potential
    g = pot.G, pot.c, pot.d, pot.mu
    # an equilibrium on the conic G X Z + c Z + d X + mu = 0 at Z = 2
    z = 2.0
    x = -(pot.c * z + pot.mu) / (pot.G * z + pot.d)
    start = moved(x, z, off)
    found = settled_on_circle(g, *start)
    assert abs(force(g, *found)) < 1e-9 and math.hypot(*found) == pytest.approx(math.hypot(x, z), rel=1e-12)
    np.testing.assert_allclose(found, (x, z), atol=1e-8)
    np.testing.assert_allclose(settled_on(pot, start), (x, z), atol=1e-8)
    flat = (0.05, 0.05)  # A^2 < 2: no equilibrium on this circle
    np.testing.assert_allclose(math.hypot(*settled_on_circle(g, *flat)), math.hypot(*flat), rtol=1e-9)
    assert settled_on(pot, flat) == flat


# -- many digits


def test_a_question_that_stays_unclear_is_unclear_in_the_end():
    asked = []

    def never(numbers):
        asked.append(numbers.bits)
        raise Unclear
    with pytest.raises(Unclear):
        settled(never, 128, 512)
    assert asked == [128, 256, 512]
    with pytest.raises(Unclear):
        settled(never, DOUBLE_BITS, DOUBLE_BITS)
    assert asked[3:] == [DOUBLE_BITS] and Digits.real_roots([Fraction(3)]) == [] and Digits.real_roots([]) == []


def test_digits_of_an_error_are_its_negative_logarithm_within_what_numbers_hold():
    assert digits_of(1e-7) == pytest.approx(7) and digits_of(0.0) > 15 and digits_of(math.nan) == digits_of(5.0) == 0.0


def test_a_precision_needs_a_motion(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text("[scaled]\na = 0.2\nb = 0.4\nmu = [0, 0, 1]\n")
    with pytest.raises(InputError, match="motion"):
        problem(stabilab.load(path), 5)


# -- runs


@pytest.mark.parametrize("state", [{"gamma": (0, 0, 1)}, {"omega": (1, 0, 0), "spin": 3}, {}])
def test_a_start_in_blocks_names_the_rate_and_no_others(state):
    with pytest.raises(InputError, match="omega"):
        trajectory(MINOR, state, [1.0])


def test_a_run_beyond_its_steps_stops_and_says_so(monkeypatch):
    monkeypatch.setattr(trajectories, "STEP_LIMIT", 7)
    run = trajectory(MINOR, (2.5, 4.0, 0.1), [100.0], method="DOP853")
    assert run.status == "stopped" and "7 steps" in run.reason


def test_a_scene_in_another_unit_of_time_has_the_rates_of_the_first():
    scene, u, x = ScaledGyrostat("0.25", "-1.5", (0.5, 0, 2)), 8.0, [0.75, -2.0, 1.25]
    plain, fast = scene.quadratic().rate(x), in_unit(scene, u).quadratic().rate([v / u for v in x])
    assert [r / u**2 for r in plain] == fast  # x = u y, t = s/u: y' = x'/u^2; powers of two, so exactly


def test_scenes_without_a_family_of_models_have_the_exact_one():
    rod = Scene(Body((3, 2, 1)), Resistance("0.1"), Gyrostat((1, 2, 0)))  # averaging needs the wheel on axis 3 and moments that are alike
    assert [list(models_of(scene)) for scene in (MINOR, rod)] == [["exact"]] * 2


class Circling:
    """A toy motion, (cos, sin, sharp) of one period: `sharp` is smooth, or has a corner that no table resolves."""

    evaluations, sense, spin, axis = 0, 1.0, (1.0, 0.0), 0

    def __init__(self, period, sharp):
        self.period, self.sharp = period, sharp

    def follow(self, times):
        t = np.asarray(times) * (2 * np.pi / self.period)
        return np.stack([np.cos(t), np.sin(t), self.sharp(t)], axis=1), np.sin(t)


def test_a_motion_is_tabulated_where_it_repeats_smoothly():
    smooth, corner, never = Circling(3.0, lambda t: np.cos(2 * t)), Circling(3.0, lambda t: np.abs(np.sin(7.3 * t))), Circling(math.inf, np.cos)
    assert tabulated(corner) is corner and tabulated(never) is never
    table, times = tabulated(smooth), np.linspace(0, 2.9, 57)
    np.testing.assert_allclose(table.follow(times)[0], smooth.follow(times)[0], atol=1e-12)


def test_an_effect_that_is_not_there_has_no_cost():
    with pytest.raises(KeyError):
        effect_cost.imported("phlogiston")


@pytest.mark.parametrize("gap", [Fraction(1, 10**6), Fraction(1, 2**300), Fraction(1, 2**900)])
def test_rational_roots_however_close_are_each_found(gap):
    wanted = [Fraction(-7, 3), Fraction(0), Fraction(10, 7), Fraction(10, 7) + gap]
    p = Poly((1,))
    for root in wanted:
        p = p * Poly((-root, 1))
    found = real_roots(p, 64)
    assert len(found) == 4 and all(abs(f - w) <= abs(w) / 2**64 for f, w in zip(found, wanted)) and found == sorted(found)
    assert real_roots(Poly((5,))) == [] and real_roots(Poly((0, 0, 3))) == [0]


# -- digits


def test_digits_that_no_way_gives_are_told(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text("[scaled]\na = 0.2\nb = 0.4\nmu = [0, 0, 1]\n[motion]\nx = [2.5, 4.0, 0.1]\ntau = [0, 5]\n")
    case = stabilab.load(path)
    assert precision_digits._many_digits(case, np.array([-1.0, 1.0]), 20) is None  # one run goes one way
    with pytest.raises(InputError, match="from time 0 on"):
        precision_digits._reduced(case, np.array([-1.0, 1.0]), "reduced", 16)
    run = SimpleNamespace(status="stopped", reason="it ran out of steps")
    words = [precision_digits.missed(case, SimpleNamespace(run=one, asked=12, digits=3.25, because="a check")) for one in
             (run, SimpleNamespace(status="reached", reason=""))]
    assert words[0].endswith("it ran out of steps") and "12 digits asked for, 3.2 reached (a check)" in words[1]


def test_what_has_no_number_is_told_for_states_and_rows_alike():
    one = ask("period", MINOR, (0.5, 0.5, 0.0), 20)  # A^2 < 2: it spins up
    assert one.values is None and "does not repeat" in one.because
    rows = ask_all("period", MINOR, np.array([[0.5, 0.5, 0.0], [2.5, 4.0, 0.1]]), 20)
    assert rows.values[0] == np.inf and rows.values[1] == pytest.approx(float(stabilab.period(MINOR, np.array([2.5, 4.0, 0.1]))), rel=1e-12)


# -- effects that no analysis knows


@dataclass(frozen=True)
class Drift(Effect):
    """A torque along axis 1 that grows with omega_2: of no paper."""

    name: ClassVar[str] = "drift"

    def parameters(self):
        return {"drift": Fraction(1, 4)}

    def torque(self, omega, p):
        return (p["drift"] * omega[1], 0, 0)


def test_an_effect_that_is_not_known_is_run_and_not_judged():
    scene = Scene(Body((3, 2, 1)), Drift())
    assert content(scene) is None and other_equilibria(scene) is None and other_motion(scene, (1.0, 0.5, 0.25)) is None
    for question in (equilibria, lambda scene: motion(scene, (1.0, 0.5, 0.25)), lambda scene: stabilab.fate(scene, np.ones(3))):
        with pytest.raises(InputError):
            question(scene)
    assert list(models_of(scene)) == ["exact"]
    run = trajectory(scene, (1.0, 0.5, 0.25), [0.0, 1e-4])
    rate = (run.states[1] - run.states[0]) / 1e-4
    np.testing.assert_allclose(rate, [(0.5 * 0.25 + 0.25 * 0.5) / 3, -2 * 0.25 * 1 / 2, 1 * 0.5], rtol=1e-3)


def test_a_sphere_has_a_line_of_equilibria_where_its_wheel_lies_across_the_torque():
    """D equal: lambda x omega + M = 0 is solved by (lambda x M)/|lambda|^2 + s lambda iff lambda . M = 0."""
    wheel, torque = np.array([3.0, 0.0, -1.0]), np.array([1.0, 2.0, 3.0])
    (line,) = equilibria(Scene(Body((2, 2, 2)), Gyrostat(wheel), ConstantTorque(torque))).curves
    for sample in line.samples:
        foot = np.cross(wheel, torque) / 10
        np.testing.assert_allclose(np.cross(np.array(sample.at) - foot, wheel), 0, atol=1e-12 * (1 + np.abs(sample.at).max()))
    assert equilibria(Scene(Body((2, 2, 2)), Gyrostat((3, 0, 1)), ConstantTorque(torque))).kind == "none"
