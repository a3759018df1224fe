"""G1, G2, G3 against an integration of the paper's own equations (5) by DOP853, and against a scan of the turn."""
import math
from itertools import permutations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar

import stabilab
from stabilab.physics.coefficients import to_scaled

SEEDS = range(30)


def drawn(seed, axis):
    """A scaled scene and a state of it, of all sizes of the wheel."""
    rng = np.random.default_rng(9000 + seed)
    a, b = rng.normal(size=2) * 10 ** rng.uniform(-1, 0.7) * (1, 3 if axis == 1 else 1)
    mu = [0, 0, 0]
    mu[axis] = 1
    return stabilab.ScaledGyrostat(a, b, mu), rng.normal(size=3) * rng.choice([0.7, 1.5, 4.0])


def followed(scene, state, angle, rate_of):
    """(state, angle) after two units of tau, by equation (5) and angle' = rate_of(x): no code in common."""
    a, b, (m1, m2, m3) = scene.a, scene.b, scene.mu

    def rates(_, y):
        x1, x2, x3 = y[:3]
        return [x2 * x3 + m1, -x3 * (x1 + a) + m2, x2 * (x1 + b) + m3, rate_of(y[:3])]

    end = solve_ivp(rates, (0, 2), [*state, angle], "DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    return end[:3], end[3]


def saddle(height, start, stop):
    """The highest local maximum of a height between two angles, by a scan; None where there is none."""
    at = np.linspace(start, stop, 20001)
    values = height(at)
    inner = np.flatnonzero((values[1:-1] > values[:-2]) & (values[1:-1] >= values[2:])) + 1
    return max((-minimize_scalar(lambda v: -height(v), bounds=(at[n - 1], at[n + 1]), method="bounded",
                                 options={"xatol": 1e-12}).fun for n in inner), default=None)


def agree(found, name, value, on_separatrix, later):
    scale = 1 + abs(value) + abs(on_separatrix or 0)
    assert found.name == name
    assert found.value == pytest.approx(value, abs=1e-12 * scale)
    assert later == pytest.approx(value, abs=1e-7 * scale)  # DOP853's error, which grows off an unstable plane
    if on_separatrix is None:
        assert found.on_separatrix is None
        assert found.difference is None
    else:
        assert found.on_separatrix == pytest.approx(on_separatrix, abs=1e-9 * scale)
        assert found.difference == pytest.approx(on_separatrix - value, abs=1e-9 * scale)


@pytest.mark.one_in(3)
@pytest.mark.parametrize("seed", SEEDS)
def test_G1_is_the_corrected_25_along_an_integration_of_the_papers_equations(seed):
    scene, x = drawn(seed, 2)
    a, b = scene.a, scene.b
    A, alpha = math.hypot(x[0] + a, x[1]), 2 * math.atan2(x[0] + a, x[1])
    height = lambda v: A * A * np.cos(v) - 4 * A * (b - a) * np.sin(v / 2) - 2 * v
    end, turned = followed(scene, x, alpha, lambda y: 2 * y[2])
    agree(stabilab.motion(scene, x).energy_integral, "G1", 2 * x[2] ** 2 + height(alpha),
          saddle(height, alpha, alpha + 4 * math.pi), 2 * end[2] ** 2 + height(turned))


@pytest.mark.one_in(3)
@pytest.mark.parametrize("seed", SEEDS)
def test_G2_is_the_corrected_66_along_an_integration_of_the_papers_equations(seed):
    scene, x = drawn(seed, 1)
    a, b, Y = scene.a, scene.b, x[0] + scene.b
    inside = abs(Y) > abs(x[2])
    gamma = 2 * math.atanh(x[2] / Y if inside else Y / x[2])
    N, sign = abs(Y * Y - x[2] ** 2) / 2, math.copysign(1, Y if inside else x[2])
    along = np.cosh if inside else np.sinh  # of x1 + b
    height = lambda v: 2 * N * np.cosh(v) - 4 * sign * (b - a) * math.sqrt(2 * N) * along(v / 2) - 2 * v
    end, turned = followed(scene, x, gamma, lambda y: 2 * y[1])
    agree(stabilab.motion(scene, x).energy_integral, "G2", 2 * x[1] ** 2 + height(gamma),
          saddle(height, -40, 40), 2 * end[1] ** 2 + height(turned))


@pytest.mark.one_in(3)
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("side", (1, -1))
def test_G3_is_the_corrected_79_on_both_planes(seed, side):
    scene, x = drawn(seed, 1)
    a, b = (round(v * 64) / 64 for v in (scene.a, scene.b))  # so that the plane is met exactly
    x3 = round(x[2] * 64) / 64 or 1.0
    scene, x = stabilab.ScaledGyrostat(a, b, (0, 1, 0)), (side * x3 - b, x[1], x3)
    angle = side * math.log(abs(x3))
    height = lambda v: np.exp(2 * side * v) / 2 - side * (b - a) * math.copysign(1, x3) * np.exp(side * v) - v
    end, turned = followed(scene, x, angle, lambda y: y[1])
    agree(stabilab.motion(scene, x).energy_integral, "G3", x[1] ** 2 / 2 + height(angle),
          saddle(height, angle, 30), end[1] ** 2 / 2 + height(turned))


def same(found, other):
    assert found.name == other.name
    assert found.value == pytest.approx(other.value, rel=1e-9)
    assert (found.difference is None) == (other.difference is None)
    assert found.difference is None or found.difference == pytest.approx(other.difference, rel=1e-9)


@pytest.mark.one_in(6)
@pytest.mark.parametrize("seed", SEEDS)
def test_an_SI_body_has_the_integral_of_its_scaled_twin_in_any_order_of_its_axes(seed):
    rng = np.random.default_rng(9100 + seed)
    D = np.sort(rng.uniform(1.0, 1.9, 3))[::-1]
    axis = seed % 2 + 1
    torque, wheel = np.zeros(3), np.array([rng.normal(), 0, 0])
    torque[axis] = rng.normal()
    omega = rng.normal(size=3)
    scene = stabilab.Scene(stabilab.Body(D), stabilab.Gyrostat(wheel), stabilab.ConstantTorque(torque))
    found = stabilab.motion(scene, omega).energy_integral
    if torque[axis] > 0:
        twin, change = to_scaled(scene)
        there = stabilab.motion(twin, change.to_scaled(omega)).energy_integral
        same(found, there)
    for order in permutations(range(3)):
        odd = np.linalg.det(np.eye(3)[list(order)]) < 0  # then the torque's axis turns round: a right-handed frame
        signs = np.where((np.arange(3) == axis) & odd, -1, 1)
        turned = [(np.array(v) * signs)[list(order)] for v in (wheel, torque, omega)]
        there = stabilab.motion(stabilab.Scene(stabilab.Body(D[list(order)]), stabilab.Gyrostat(turned[0]),
                                               stabilab.ConstantTorque(turned[1])), turned[2]).energy_integral
        same(there, found)


@pytest.mark.parametrize("case", ("off-axis-one", "torque-free-body", "symmetric-body", "major-axis-100"))
def test_a_scene_without_such_an_integral_has_none(case):
    assert stabilab.motion(stabilab.load(f"cases/{case}.toml")).energy_integral is None


def test_the_difference_is_exact_beside_the_separatrix():
    scene = stabilab.ScaledGyrostat("1/5", "2/5", (0, 0, 1))
    edge = stabilab.motion(scene, (2.5, 4, 0.1))
    x3 = math.sqrt(0.1**2 + edge.energy_integral.difference / 2)  # 2 x3^2 is all of G1 that changes
    near = [stabilab.motion(scene, (2.5, 4, x3 + n * 1e-13)).energy_integral.difference for n in (-3, 3)]
    assert near[0] - near[1] == pytest.approx(4 * x3 * 6e-13, rel=1e-2)
    assert near[0] > 0 > near[1]


# --- A torque in the negative direction: docs/mathematics/reduction.md writes these formulas
NEGATIVE = {
    0: lambda x, a, b: 2 * x[0]**2 + x[1]**2 - x[2]**2 - 4 * math.atan2(x[2], -x[1]),
    1: lambda x, a, b: (2 * x[1]**2 + (x[0] + b)**2 + x[2]**2 - 4 * (b - a) * (x[0] + b)
                        + 2 * math.log(abs((x[0] + b + x[2]) / (x[0] + b - x[2])))),
    2: lambda x, a, b: (2 * x[2]**2 + x[1]**2 - (x[0] + a)**2 - 4 * (b - a) * (x[0] + a)
                        - 4 * math.atan2(x[0] + a, -x[1]))}


@pytest.mark.one_in(2)
@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("seed", range(4))
def test_a_negative_torque_has_the_integral_of_the_state_turned_by_half(seed, axis):
    """The formula is constant along DOP853's run of (5), but for the turns of its angle, and is that of the state
    turned by half about the axis that the answer names, under a positive torque."""
    scene, x = drawn(seed, axis)
    a, b = (scene.a, scene.b) if axis else (0, 0)
    torque = [0, 0, 0]
    torque[axis] = -1
    found = stabilab.motion(stabilab.ScaledGyrostat(a, b, torque), x.tolist()).energy_integral
    value, scale = NEGATIVE[axis](x, a, b), 1 + abs(found.value)
    assert found.value == pytest.approx(value, abs=1e-12 * scale)
    end, _ = followed(stabilab.ScaledGyrostat(a, b, torque), x, 0.0, lambda y: 0.0)
    apart = (NEGATIVE[axis](end, a, b) - value) / (8 * math.pi)  # by full turns of the angle on circles
    assert abs(apart - (round(apart) if axis != 1 else 0)) < 1e-7 * scale
    assert found.turned_about == (3 if axis == 0 else 1)
    turned = [v if n + 1 == found.turned_about else -v for n, v in enumerate(x.tolist())]
    positive = stabilab.ScaledGyrostat(a, b, [-v for v in torque])
    same = stabilab.motion(positive, turned).energy_integral
    assert same.turned_about is None and same.value == pytest.approx(found.value, abs=1e-12 * scale)
    if found.difference is not None:
        assert same.difference == pytest.approx(found.difference, rel=1e-9)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("order", [*permutations((12, 9, 5))])
@pytest.mark.parametrize("axis", range(3))
def test_a_body_turned_by_half_with_its_wheels_has_the_same_integral(order, axis):
    """The half turn is a change of axes, which changes no integral; in every order of the moments."""
    wheel, torque, x = [0.8, -0.5, 0.3], [0, 0, 0], [0.4, -0.7, 0.9]
    wheel[axis], torque[axis] = 0, -0.02
    scene = lambda m, t: stabilab.Scene(stabilab.Body(order), stabilab.Gyrostat(m), stabilab.ConstantTorque(t))
    found = stabilab.motion(scene(wheel, torque), x).energy_integral
    turned = [[v if n + 1 == found.turned_about else -v for n, v in enumerate(row)] for row in (wheel, torque, x)]
    same = stabilab.motion(scene(*turned[:2]), turned[2]).energy_integral
    assert found.turned_about != axis + 1 and same.turned_about is None
    assert (same.name, same.value) == (found.name, pytest.approx(found.value, rel=1e-12))


@pytest.mark.parametrize("side", [1, -1])
def test_a_negative_torque_has_the_integral_of_a_plane_that_the_page_writes(side):
    """On x1 + b = side x3 by hand; b - a = 0.6."""
    scene = stabilab.ScaledGyrostat("0.6", "1.2", (0, -1, 0))
    x2, x3 = 0.4, 2.5 * side
    found = stabilab.motion(scene, ("1.3", "0.4", f"{2.5 * side}")).energy_integral
    assert found.name == "G3" and found.turned_about == 1
    assert found.value == pytest.approx((x2**2 + x3**2) / 2 - side * 0.6 * x3 + side * math.log(abs(x3)), rel=1e-14)


def test_text_json_and_data_say_that_the_state_is_turned():
    from stabilab.show.results import kinds
    from stabilab.show.text.motion import energy_integral
    from stabilab.show.units import SCALED
    case = stabilab.load(stabilab.ScaledGyrostat("0.6", "1.2", (0, 0, -1)), (1, 2, 3))
    (name, text), = energy_integral(case.motion(), SCALED)
    assert name == "energy integral G1" and "turned by half about axis 1, as the torque is negative" in text
    assert "turned_about" in str(kinds._motion(case.motion()))
