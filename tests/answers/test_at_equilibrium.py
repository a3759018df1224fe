"""A state of equilibrium carries its stability, in every view. Oracles: eigenvalues of difference quotients
of equations written out here, and runs of disturbed starts by SciPy's DOP853."""
from __future__ import annotations

import json
import math
from fractions import Fraction

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stabilab
from stabilab import Body, Scene
from stabilab.physics.effects.constant_torque import ConstantTorque
from stabilab.physics.effects.gravity import Gravity
from stabilab.physics.effects.gyrostat import Gyrostat
from stabilab.physics.effects.liquid_cavity import LiquidCavity
from stabilab.physics.effects.viscous_damper import ViscousDamper
from stabilab.show.text import headline
from tests.oracles.rigid import euler, with_a_direction


def growth_by_differences(rate, w):
    """The largest real part of the eigenvalues of the Jacobian by central differences."""
    w, h = np.array(w, float), 1e-6
    J = np.array([np.subtract(rate(0, w + h * e), rate(0, w - h * e)) / (2 * h) for e in np.eye(len(w))]).T
    return np.linalg.eigvals(J).real.max()


def departs(rate, w, until, push=1e-4):
    """How far disturbed motions go from the state, in units of the push (DOP853)."""
    w = np.array(w, float)
    far = 0.0
    for direction in np.random.default_rng(3).normal(size=(4, len(w))):
        run = solve_ivp(rate, (0, until), w + push * direction / np.linalg.norm(direction),
                        method="DOP853", rtol=1e-10, atol=1e-13)
        far = max(far, np.abs(run.y - w[:, None]).max())
    return far / push


GYROSTATS = [  # moments, wheel, torque, state, verdict
    ((3, 2, 1), (0, 0, 0), (0, 0, 0), (0, 1, 0), "unstable"),
    ((3, 2, 1), (0, 0, 0), (0, 0, 0), (1, 0, 0), "stable"),
    ((3, 2, 1), (0, 0, 0), (0, 0, 0), (0, 0, -2), "stable"),
    ((3, 2, 1), (0, 0, 0), (0, 0, 0), (0, 0, 0), "stable"),
    ((3, 2, 1), (0, 3, 0), (0, 0, 0), (0, 1, 0), "stable"),  # a wheel holds the intermediate axis
    ((3, 2, 1), (0, 0, 3), (0, 0, 0), (0, 0, -2), None),
    ((3, 2, 1), (0, 0, 3), (0, 0, 0), (0, 0, -1), None),
    ((2, 2, 2), (0, 0, 0), (0, 0, 0), (1, 2, 3), "stable"),
    ((3, 3, 1), (0, 0, 0), (0, 0, 0), ("3/10", "2/5", 0), "unstable"),  # drifts with the spin about axis 3
    ((3, 3, 1), (0, 0, 0), (0, 0, 0), (0, 0, 2), "stable"),
    ((3, 2, 1), (0, 0, 0), (0, 0, 2), (1, -2, 0), None),  # (D1 - D2) w1 w2 + M3 = 0
    ((3, 2, 1), (0, 0, 0), (0, 0, 2), (2, -1, 0), None),
    ((3, 2, 1), (0, 0, 0), (2, 0, 0), (0, 2, -1), None),  # (D2 - D3) w2 w3 + M1 = 0
    ((3, 2, 1), (0, 0, 0), (2, 0, 0), (0, 1, -2), None),
    ((3, 2, 1), (0, 0, 0), (0, 2, 0), (2, 0, "1/2"), None),  # (D3 - D1) w3 w1 + M2 = 0
    ((3, 2, 1), (0, 0, 0), (1, 2, 1), (1, -1, 1), None),  # all three
]


@pytest.mark.one_in(2)
@pytest.mark.parametrize("D, wheel, torque, state, verdict", GYROSTATS)
def test_a_state_of_equilibrium_of_a_gyrostat_has_its_stability_and_rate_of_growth(D, wheel, torque, state,
                                                                                   verdict):
    effects = [*([Gyrostat(wheel)] if any(wheel) else []), *([ConstantTorque(torque)] if any(torque) else [])]
    state = [float(Fraction(v)) for v in state]
    rate = euler(D, wheel, torque)
    found = stabilab.motion(Scene(Body(D), *effects), state)
    assert found.fate.word == "equilibrium"
    grows = growth_by_differences(rate, state)
    if verdict is None:
        verdict = "unstable" if grows > 1e-4 else "stable"
    assert found.stability.verdict == verdict
    if found.stability.growth is not None:
        assert found.stability.growth == pytest.approx(grows, rel=1e-6)
        time = min(12 / grows, 300)
        assert departs(rate, state, time) > 100
    else:
        assert grows < 1e-4
        if verdict == "stable":
            assert departs(rate, state, 200.0) < 30
    assert [one.kind for one in found.caveats if one.kind == "unstable"] == ["unstable"] * (verdict == "unstable")


@pytest.mark.parametrize("third, spin", [(2, 0.3), (2, 0.55), (1.5, 0.6), (1.5, 0.7)])
def test_a_sleeping_top_is_unstable_below_its_critical_spin_and_says_how_fast(third, spin):
    """Lagrange: stable for (D3 spin)^2 > 4 D1 m g l."""
    D, m, g, l = (1, 1, third), 0.1, 9.8, 0.25
    scene = Scene(Body(D), Gravity(m * g, (0, 0, l)))
    found = stabilab.motion(scene, [0, 0, spin, 0, 0, -1])
    stable = (third * spin) ** 2 > 4 * D[0] * m * g * l
    assert found.fate.word == "equilibrium"
    assert found.stability.unstable != stable
    if not stable:
        # upright: gamma, the direction of the weight, is -e3
        grows = growth_by_differences(with_a_direction(D, arm=(0, 0, m * g * l)), [0, 0, spin, 0, 0, -1])
        assert found.stability.growth == pytest.approx(grows, rel=1e-4)


@pytest.mark.parametrize("effect", [LiquidCavity(1250, 1000, "1.9"), ViscousDamper("0.1", "0.2")])
@pytest.mark.parametrize("state, stable", [((1, 0, 0), True), ((0, 1, 0), False), ((0, 0, 1), False),
                                           ((0, 0, -0.163), False), ((0.7, 0, 0), True)])  # no samples of curves
def test_with_a_loss_of_energy_only_rotation_about_the_major_axis_is_stable(effect, state, stable):
    scale = 40 if isinstance(effect, LiquidCavity) else 1
    scene = Scene(Body([d * scale for d in (3, 2, 1)]), effect)
    start = [*state, 0, 0, 0] if isinstance(effect, ViscousDamper) else list(state)
    found = stabilab.motion(scene, start)
    assert found.fate.word == "equilibrium" and found.stability.unstable != stable
    assert (found.stability.growth is not None) == (not stable)


FILE = """[body]
inertia = [3, 2, 1]
[motion]
angular_velocity = [0, 1, 0]
span = [0, 10]
"""


def test_every_view_says_that_a_rotation_is_unstable(stabilab, case_file, tmp_path):
    """Exact: m = -w^2 (D1 - D2)(D2 - D3)/(D1 D3) = -1/3, so that a disturbance grows at 1/sqrt(3) 1/s."""
    case, words = case_file(FILE), "a disturbance grows by the factor e in 1.732 s"
    assert math.sqrt(3) == pytest.approx(1.732, abs=1e-3)
    for command in (("fate",), ("classify",), ("extremes",), ("period",), ("attitude",),
                    ("when", "--rate", "100 deg/s")):
        code, out, _ = stabilab(command[0], case, *command[1:])
        assert code == 0 and words in out and "UNSTABLE" in out.upper(), out
        assert out.count(words) == 1
        if command[0] in ("fate", "classify", "period", "extremes", "when"):
            found = json.loads(stabilab(command[0], case, *command[1:], "--json")[1])[0]
            (one,) = found["caveats"]
            assert one["kind"] == "unstable" and one["time"] == pytest.approx(math.sqrt(3), rel=1e-14)
    for command in (("extremes", "--csv"), ("when", "--rate", "2", "--csv")):
        assert "unstable: a disturbance grows by the factor e in 1.73205 s" in stabilab(command[0], case, *command[1:])[1]
    found = json.loads(stabilab("fate", case, "--json")[1])[0]
    assert found["stability"]["verdict"] == "unstable"
    out = stabilab("sweep", case, "--vary", "angular_velocity[2]=1,2", "--csv")[1]
    assert out.count("an equilibrium that is not known to be stable") == 2


def test_a_page_a_picture_and_the_explorer_say_that_a_rotation_is_unstable(case_file, tmp_path):
    from stabilab.show.explore.session import Session
    from stabilab.show.report import one_case
    from tests.show.explore.test_session import ask
    case = stabilab.load(case_file(FILE))
    words = "UNSTABLE: a disturbance grows by the factor e in 1.732 s"
    assert words in headline.headline(case, stabilab.motion(case))
    assert headline.look(stabilab.motion(case)) == "changes"
    assert words in ask(Session(case), moving=False)[0]["headline"]
    made = one_case.sections(case, tmp_path, "case", deep=False)
    assert words in made["headline"] and "Steady rotation, unstable" in made["tiles"][0][1]
