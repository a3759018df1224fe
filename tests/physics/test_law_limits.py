"""How far approximate laws hold: the numbers, their values along a motion, and that every command and result carries them."""
import json
from fractions import Fraction
from pathlib import Path

import mpmath
import numpy as np
import pytest

import stabilab
from stabilab.answers.digits_run import best_reached
from stabilab.answers.simulate import simulate
from stabilab.case.read import load_all
from stabilab.physics.body import Body
from stabilab.physics.coefficients import content, liquid_torque
from stabilab.physics.effects.body_force import BodyForce
from stabilab.physics.effects.charge import Charge
from stabilab.physics.effects.constant_torque import ConstantTorque
from stabilab.physics.effects.damper_wheel import DamperWheel
from stabilab.physics.effects.gravity import Gravity
from stabilab.physics.effects.gyrostat import Gyrostat
from stabilab.physics.effects.liquid_cavity import NEXT_TERM, LiquidCavity, pace
from stabilab.physics.effects.newtonian_field import NewtonianField
from stabilab.physics.effects.resistance import Resistance
from stabilab.physics.law_limits import along
from stabilab.physics.scene import Scene
from stabilab.show.text import headline
from stabilab.theories.follow import follow
from tests.shared import in_one_line

CASES = Path(__file__).parents[2] / "cases"
WATER = """
[body]
inertia = [6000, 5500, 5000]
[effects.liquid_cavity]
density = 1000
viscosity = {viscosity}
radius = 1.2
[effects.constant_torque]
torque = [0, 0, 439.5]
[motion]
angular_velocity = [0.052, 0, 0]
span = [0, 20]
"""


def water(tmp_path, viscosity):
    path = tmp_path / "water.toml"
    path.write_text(WATER.format(viscosity=viscosity), encoding="utf-8")
    return path


def ball(viscosity, *more):
    """Three equal moments: the undisturbed motion is constant, so the pace of the motion is |omega| itself."""
    return Scene(Body((5000, 5000, 5000)), LiquidCavity.of_sphere(1000, viscosity, "1.2"), *more)


# -- the numbers


def share(z):
    """Angular momentum of the liquid in an oscillating sphere over that of rigid rotation: 5 i2(z)/(z i1(z)), z^2 = h^2 s/nu."""
    i = lambda n: mpmath.sqrt(mpmath.pi / (2 * z)) * mpmath.besseli(n + mpmath.mpf(1) / 2, z)
    return 5 * i(2) / (z * i(1))


def test_series_of_the_liquids_angular_momentum_has_the_law_as_second_term_and_the_next_at_two_forty_fifths():
    with mpmath.workdps(60):  # Stokes flow in an oscillating sphere, solved exactly
        series = mpmath.taylor(lambda x: share(mpmath.sqrt(x)), mpmath.mpf("1e-9"), 2)
    liquid = LiquidCavity.of_sphere(1000, "0.5", "1.2")
    assert float(-series[1]) * liquid.moment * liquid.radius**2 / 0.5 == pytest.approx(float(liquid.exact), rel=1e-8)
    assert float(-series[2] / series[1]) == pytest.approx(NEXT_TERM, rel=1e-6)


@pytest.mark.parametrize("seed", range(20))
def test_pace_bounds_the_second_rate_of_the_undisturbed_motion_as_seen_from_space(seed):
    random = np.random.default_rng(seed)
    D = tuple(Fraction(int(v)) for v in random.integers(600, 1000, 3))
    scene = Scene(Body(D), Gyrostat(tuple(int(v) for v in random.integers(-400, 400, 3))), LiquidCavity(1, 1, 1), Charge("0.3", 200, 1, 0))
    omega = tuple(Fraction(v).limit_denominator(10**6) for v in random.normal(size=3))
    parts = content(scene)
    H = [d * w + l for d, w, l in zip(D, omega, parts.Lambda)]
    first = np.cross(np.array(H, float), np.array(omega, float)) / np.array(D, float)
    second = np.array(liquid_torque(parts, omega), float)  # omega'' + omega x omega' by the analysis' exact rates
    rate = pace(scene, {"omega": tuple(map(float, omega))}, scene.effect("liquid_cavity"))
    assert np.linalg.norm(second) <= rate * np.linalg.norm(first) * (1 + 1e-12)
    assert rate <= 10 * (np.linalg.norm(np.array(omega, float)) + np.linalg.norm(np.array(parts.Lambda, float)) / 600)


def test_pace_of_a_ball_is_its_rate_and_a_medium_adds_its_decay():
    plain, damped = ball(1), ball(1, Resistance(2))
    assert pace(plain, {"omega": (3.0, 0.0, 4.0)}, plain.effect("liquid_cavity")) == 5
    # derivative of -c omega: c on the diagonal
    assert pace(damped, {"omega": (3.0, 0.0, 4.0)}, damped.effect("liquid_cavity")) == pytest.approx(5 + 2 * 3**0.5, rel=1e-14)


def test_liquid_of_more_moment_than_its_body_is_told():
    found = stabilab.validity(stabilab.load(CASES / "liquid-base.toml").scene, (1, 0, 1))  # theory: 25 t of liquid in a body of 9 kg m^2
    radius = (525 * 1.9 / (8 * np.pi)) ** (1 / 7)
    assert found.value == pytest.approx(0.4 * (4 / 3 * np.pi * radius**3 * 1250) * radius**2 / 9, rel=1e-12)  # (2/5) m h^2
    assert not found.holds and "moment of the liquid" in found.words


def test_liquid_of_sensible_size_is_within_its_law():
    case = stabilab.load(CASES / "liquid-sensible.toml")
    found = stabilab.validity(case.scene, case.state)
    assert found.holds and found.words.startswith("within the law: liquid cavity: Reynolds number")
    assert 0.2 < found.value < 0.22  # omega h^2/viscosity = 0.2, as the case says; the wheel adds a little


def test_near_centre_of_attraction_is_beyond_the_law_of_the_field():
    scene = lambda R: Scene(Body((4, 5, 6), 1.5), NewtonianField(1, R))
    assert stabilab.validity(scene(100), (0, 0, 1)).value == pytest.approx(0.02, rel=1e-14)  # sqrt(6/1.5) = 2 m
    assert not stabilab.validity(scene(10), (0, 0, 1)).holds
    assert stabilab.validity(Scene(Body((4, 5, 6), 1.5), NewtonianField(1)), (0, 0, 1)) is None  # nothing is known of its distance


def test_weight_tells_the_mass_that_the_field_needs():
    found = stabilab.validity(Scene(Body((4, 5, 6)), NewtonianField(3, 10), Gravity(15, (0, 0, 1))), (0, 0, 1))
    assert found.value == pytest.approx(0.2, rel=1e-14)  # g = N R/3 = 10, mass 1.5


def test_constant_angle_of_a_charge_is_judged_where_the_attitude_is_known():
    scene = Scene(Body((8, 8, 11)), Charge("0.1", 1, 1, 0), ConstantTorque((4, 0, 0)))
    open_ = stabilab.validity(scene, (0, 0, 1))  # None would read as: all its laws are exact
    assert open_.status == "law not judged" and open_.value is None and open_.holds is None and open_.held
    half = np.deg2rad(60) / 2
    tilted = {"omega": (0, 0, 1), "attitude": (np.cos(half), np.sin(half), 0, 0)}
    found = stabilab.validity(scene, tilted)
    assert found.value == pytest.approx(0.5, rel=1e-14) and not found.holds  # cos 60 degrees against cos 0
    along = {"omega": (0, 0, 1), "gamma": (0, np.sin(np.deg2rad(60)), 0.5)}  # axis 3 of space in the body, as that attitude has it
    assert stabilab.validity(scene, along).value == pytest.approx(0.5, rel=1e-14)
    assert stabilab.validity(Scene(Body((8, 8, 11)), Charge("0.1", 1, 1, "attitude")), tilted) is None


def test_a_number_that_is_not_known_leaves_the_law_open_unless_another_is_exceeded():
    charge, radius = Charge("0.1", 1, 1, 0), LiquidCavity("0.001", 10, "0.0001")
    scene = Scene(Body((8, 8, 11)), charge, radius)
    slow, fast = stabilab.validity(scene, (0, 0, 1e-9)), stabilab.validity(scene, (0, 0, 1e9))
    assert slow.holds is None and slow.value is not None and [v.value for v in slow.also if v.effect == "charge"] == [None]
    assert fast.holds is False and fast.status == "beyond the law"
    several = stabilab.validity(scene, np.array([[0, 0, 1e-9], [0, 0, 1e9]]))
    assert several.holds.tolist() == [True, False]  # of the first row no known number is exceeded


# -- along a motion


def test_value_of_a_run_is_the_largest_on_the_way_and_not_at_the_times_asked_for():
    scene = ball(1000, ConstantTorque((0, 0, -500)))
    run = stabilab.trajectory(scene, (0, 0, 2), [60])  # omega3 = 2 - t/10, exactly: 2 at the start, -4 at the end
    assert run.validity.value == pytest.approx(1.44 * 4 / 1000, rel=1e-12)
    back = stabilab.trajectory(scene, (0, 0, 2), [20])  # at rest at the end
    assert back.validity.value == pytest.approx(1.44 * 2 / 1000, rel=1e-12)


@pytest.mark.parametrize("method", ["DOP853", "Radau"])
def test_value_of_a_run_by_scipy_is_the_same(method):
    run = stabilab.trajectory(ball(1000, ConstantTorque((0, 0, -500))), (0, 0, 2), [60], method)
    assert run.validity.value == pytest.approx(1.44 * 4 / 1000, rel=1e-6)


@pytest.mark.slow
def test_every_result_carries_it():
    scene = ball("1e-6", ConstantTorque((0, 0, 500)))
    states = np.array([[0, 0, 0], [0, 0, 0.1]])
    assert stabilab.motion(scene, states[1]).validity.value == np.inf  # it spins up
    assert not stabilab.fate(scene, states).validity.holds.any()
    many = stabilab.ensemble(scene, states, [1, 10]).validity
    assert many.value == pytest.approx([1.44e6 * 1.0, 1.44e6 * 1.1], rel=1e-12) and many.holds.shape == (2,)
    still = stabilab.validity(ball("1e-6"), states)
    assert still.value == pytest.approx([0, 1.44e5], rel=1e-12) and still.holds.tolist() == [True, False]
    thick = stabilab.validity(ball(1000), states)
    assert thick.holds.all() and thick.status == "within the law"
    case = stabilab.load(CASES / "liquid-base.toml")
    assert not stabilab.equilibria(case.scene).validity.holds
    assert not simulate(case.scene, case.state, [0, 1]).validity.holds
    assert not follow(case, [0, 1], "averaged1").validity.holds
    assert not best_reached(case, [1.0], 12).run.validity.holds


def test_exact_laws_have_none():
    scene = Scene(Body((3, 4, 5)), Gyrostat((1, 0, 0)), ConstantTorque((0, 0, 1)))
    state = (0.1, 0.2, 0.3)
    found = (stabilab.motion(scene, state), stabilab.fate(scene, [state]), stabilab.equilibria(scene), stabilab.trajectory(scene, state, [1]),
             stabilab.ensemble(scene, [state], [1]), simulate(scene, state, [1]))
    assert all(one.validity is None for one in found)
    assert stabilab.validity(scene, state) is None
    assert stabilab.validity(Scene(Body((3, 4, 5), 2), BodyForce((1, 0, 0)), Resistance(1), Gravity(1, (0, 0, 1))), (0, 0, 1)) is None


# -- commands

# of these commands; others on every case: tests/recorded
COMMANDS = [pytest.param("precision --quick --until 2", marks=pytest.mark.slow), "fate", "compare",
            "plot --out picture.png"]


@pytest.mark.one_in(2)
@pytest.mark.parametrize("command", COMMANDS)
def test_commands_say_first_that_a_liquid_is_too_thin_for_its_law(stabilab, tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    name, *more = command.split()
    code, out, _ = stabilab(name, water(tmp_path, "1e-6"), *more)
    first = out.splitlines()[0]
    assert code == 0
    if name == "plot":  # its answer is the picture, which has it in its title
        assert first.startswith("BEYOND THE LAW: liquid cavity: Reynolds number n h²/ν of the liquid, ")
        assert "limit 1: " in first and stabilab(name, tmp_path / "water.toml", *more, "--strict")[0] == 3
        return
    answer, _, second = out.partition("\nlaw: liquid cavity: Reynolds number n h²/ν of the liquid, ")
    assert in_one_line(answer).startswith("BEYOND THE LAW; by that law: ") and "limit 1" not in answer
    assert "limit 1: " in second.splitlines()[0]
    code, out, _ = stabilab(name, tmp_path / "water.toml", *more, "--json", "--strict")
    told = json.loads(out)
    found = (told[0] if isinstance(told, list) else told)["validity"]
    assert (code, found["status"], found["holds"], found["limit"]) == (3, "beyond the law", False, 1)
    assert found["value"] > 1.44e6 * 0.052  # omega h^2/nu of the start, the least that n allows
    assert len(found["also"]) == 2


@pytest.mark.one_in(2)
@pytest.mark.parametrize("command", ["compare", "plot --out picture.png"])
def test_commands_say_first_that_a_thick_liquid_is_within_its_law(stabilab, tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    name, *more = command.split()
    code, out, _ = stabilab(name, water(tmp_path, "1000"), *more, "--strict")
    assert code == 0 and "within the law: liquid cavity: " in out
    exact = json.loads(stabilab("fate", CASES / "torque-free-body.toml", "--json")[1])
    assert exact[0]["validity"] is None


def test_surface_carries_it_in_its_summary(stabilab, tmp_path, monkeypatch):
    from stabilab.show import render_probe
    monkeypatch.setattr("stabilab.show.surface.probe", lambda: render_probe.Renderer(False, "none here"))  # loaded first, so that it is put back
    _, out, _ = stabilab("surface", CASES / "charged-body.toml", "--out", tmp_path / "s", "--json")
    assert json.loads(out)["validity"]["effect"] == "charge"


def test_section_of_a_report_says_it_first(tmp_path):
    from stabilab.case.read import load
    from stabilab.show.report.one_case import sections
    page = sections(load(water(tmp_path, "1e-6")), tmp_path, "water")
    assert page["law"].startswith("BEYOND THE LAW")  # the page has it below its verdict, before anything else


def test_one_reason_of_several_cases_is_one_line_that_names_them():
    assert headline.together(["no body (3) does (one)", "too fast (two)", "no body (3) does (three)"]) == ["no body (3) does (one, three)", "too fast (two)"]


def test_a_table_of_a_sweep_has_one_line_on_a_law_and_says_of_how_many_combinations(stabilab, tmp_path):
    """As the report of the same file; beside a file that has no place for it, on stderr."""
    _, out, err = stabilab("extremes", CASES / "charged-sweep.toml", "--csv")
    assert len(out.splitlines()) == 82 and out.count("BEYOND THE LAW: ") == 81 and not err
    line = headline.of_cases(load_all(CASES / "charged-sweep.toml"))
    assert line.count("BEYOND THE LAW") == 1 and "(charged-sweep: 27 of 27 combinations, the farthest of them given)" in line
    farthest = max(row["validity"]["value"] for row in json.loads(stabilab("extremes", CASES / "charged-sweep.toml", "--json")[1]))
    assert f"with the attitude, {farthest:.3g} along" in line
    _, _, err = stabilab("simulate", CASES / "liquid-base.toml", "--out", tmp_path / "run.csv")
    assert err.count("BEYOND THE LAW") == 1 and "s in [" not in err


def test_a_charge_is_judged_by_the_attitude_that_a_case_gives_in_every_question(stabilab):
    """At the start the attitude is the unit one, so cos sigma departs from the constant by 1/cos 0.37 - 1 = 0.0726; the body soon turns farther."""
    path = CASES / "charged-body.toml"
    _, soon, _ = stabilab("when", path, "--rate", "20 deg/s")
    _, late, _ = stabilab("when", path, "--rate", "100 deg/s", "--strict")
    assert "within the law" in soon and "0.0726 along the run" in soon
    assert in_one_line(late).startswith("BEYOND THE LAW; by that law: ") and "\nlaw: charge: " in late
    assert stabilab("when", path, "--rate", "100 deg/s", "--strict")[0] == 3
    _, modelled, _ = stabilab("simulate", path, "--at", "0,0.5", "--model", "corrected")
    assert "within the law" in modelled and "0.0726 at the times given" in modelled
    _, unknown, _ = stabilab("fate", CASES / "liquid-base.toml")
    assert "it needs the attitude, which is not given" in unknown


def test_a_law_beside_other_answers_is_judged_along_the_first_turns_of_a_motion_of_very_many():
    # proof: a rotation about a principal axis goes on as it is, and so does the number of its law
    scene = Scene(Body((3, 2, 1.5)), LiquidCavity.of_sphere(1000, 1, 0.05))
    case = stabilab.load({"body": {"inertia": [3, 2, 1.5]},
                          "effects": {"liquid_cavity": {"density": 1000, "viscosity": 1, "radius": 0.05}},
                          "motion": {"angular_velocity": [0, 0, "3e6 rad/s"], "span": [0, 15]}})
    found = headline.of_case(case)
    assert str(found.over) == "along the first 0.033 s of the run"
    assert found.value == pytest.approx(stabilab.validity(scene, (0, 0, 3e6)).value, rel=1e-9)
    assert "along the run" in headline.of_case(case, (0, 0.01)).words


def test_a_block_of_one_component_is_told_from_one_state():
    """Of a wheel's rates in many states each is a row of one number, which float() takes for a number on old NumPy."""
    scene = Scene(Body((6000, 5500, 5000)), LiquidCavity.of_sphere(1000, 1, "0.5"), DamperWheel(9, 2, (1, 2, 2)))
    states = np.array([[0.05, 0.02, 0.01, 0.3], [0.02, 0.07, 0.04, -0.1]])
    blocks = {"omega": states[:, :3], "damper_wheel": states[:, 3:]}
    found = along(scene, blocks, "these states")
    alone = [along(scene, {name: rows[n:n + 1] for name, rows in blocks.items()}, "one") for n in range(2)]
    assert found.value == max(one.value for one in alone) > 0
