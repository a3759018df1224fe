"""A mass on a spring with a dashpot in a body: against Newton's equations of the two bodies in space, with the
force between them as an unknown, which share no equation with the package."""
import math

import numpy as np
import pytest
import sympy
from scipy.integrate import solve_ivp

import stabilab
from stabilab import Body, DamperMass, Gyrostat, InputError, Scene, load, trajectory
from stabilab.orbit.result import Fate
from stabilab.physics.coefficients import content
from stabilab.physics.to_numpy import to_numpy
from tests.shared import CASES

D, M = np.array([2.0, 1.5, 1.2]), 10.0


def newtons_rates(D, m, place, line, k, c, wheel=(0, 0, 0), whole=M):
    """(rates of (omega, x, v), n, r, B, mu), by a linear system in the unknowns of each step. The rest of the body has the mass M - m and about its own mass centre
    the moments B; r is the place from there. Unknowns of each step, in the body's axes: the acceleration A of that
    centre, omega', x'' and the force f on the mass, of
    (M - m) A = -f,  B omega' + omega x (B omega + wheel) = rho x (-f),  m a = f,  f . n = -k x - c v,
    a = A + omega' x rho + omega x (omega x rho) + 2 omega x v n + x'' n,  rho = r + x n."""
    n = np.array(line, float) / np.linalg.norm(line)
    r, wheel = np.array(place, float) * whole / (whole - m), np.array(wheel, float)
    mu = m * (whole - m) / whole
    B = np.diag(D) - mu * (r @ r * np.eye(3) - np.outer(r, r))
    turn = lambda u: np.array([[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0]])

    def rate(t, y):
        w, x, v = y[:3], y[3], y[4]
        rho = r + x * n
        left, right = np.zeros((10, 10)), np.zeros(10)  # A, omega', x'', f
        left[:3, :3], left[:3, 7:] = (whole - m) * np.eye(3), np.eye(3)
        left[3:6, 3:6], left[3:6, 7:], right[3:6] = B, turn(rho), -np.cross(w, B @ w + wheel)
        left[6:9, :3], left[6:9, 3:6], left[6:9, 6], left[6:9, 7:] = m * np.eye(3), -m * turn(rho), m * n, -np.eye(3)
        right[6:9] = -m * (np.cross(w, np.cross(w, rho)) + 2 * np.cross(w, v * n))
        left[9, 7:], right[9] = n, -k * x - c * v
        solved = np.linalg.solve(left, right)
        return [*solved[3:6], v, solved[6]]
    return rate, n, r, B, mu


def newton(m, place, line, k, c, omega, x, v, times, wheel=(0, 0, 0)):
    """(omega, (x, v), energy, |H|) by DOP853."""
    rate, n, r, B, mu = newtons_rates(D, m, place, line, k, c, wheel)
    y = solve_ivp(rate, (0, times[-1]), [*omega, x, v], "DOP853", times, rtol=1e-12, atol=1e-13).y.T
    w, x, v = y[:, :3], y[:, 3], y[:, 4]
    rho = r + x[:, None] * n
    moving = v[:, None] * n + np.cross(w, rho)  # relative to the centre of the rest
    energy = ((w @ B) * w).sum(axis=1) / 2 + mu * (moving**2).sum(axis=1) / 2 + k * x**2 / 2
    H = w @ B + mu * np.cross(rho, moving) + wheel
    return w, y[:, 3:], energy, np.linalg.norm(H, axis=1)


@pytest.mark.parametrize("place, line, wheel", [
    ((0.4, 0, 0), (0, 0, 1), (0, 0, 0)),
    pytest.param((0.3, 0.1, -0.2), (1, 0, 2), (0.2, 0, 0.5), marks=pytest.mark.slow),
    pytest.param((0.4, 0.1, 0.2), (-1, 2, 2), (0, 0, 0), marks=pytest.mark.slow)])
def test_runs_as_newtons_equations_of_two_bodies_do(place, line, wheel):
    m, k, c = 0.5, 2.0, 0.3
    scene = Scene(Body(D.tolist(), M), DamperMass(m, place, line, k, c, M), *([Gyrostat(wheel)] if any(wheel) else []))
    omega, times = np.array([0.3, 0.2, 1.0]), np.array([0.0, 2, 9, 30])
    w, moved, energy, size = newton(m, place, line, k, c, omega, 0.05, 0.1, times, wheel)
    run = trajectory(scene, {"omega": omega, "damper_mass": [0.05, 0.1]}, times)
    assert run.states[:, :3] == pytest.approx(w, abs=1e-9) and run.states[:, 3:] == pytest.approx(moved, abs=1e-9)
    laws = to_numpy(scene).invariants(run.states)
    assert laws["energy"] == pytest.approx(energy, rel=1e-10) and (np.diff(energy) < 0).all()
    # the law leaves out what is constant, |wheel|^2
    assert 2 * laws["momentum"] + np.dot(wheel, wheel) == pytest.approx(size**2, rel=1e-10) and np.ptp(size) < 1e-10


def test_the_jacobian_of_a_mass_on_an_oblique_line_is_that_of_newtons_equations(monkeypatch):
    """By central differences of Newton's rates. No quotient is expanded, which takes minutes."""
    poly = sympy.Poly

    def spied(expression, *state):
        assert expression.is_polynomial(*state)
        return poly(expression, *state)
    monkeypatch.setattr(sympy, "Poly", spied)
    place, line = (-0.39, 0.27, 0.13), (-0.54, 0.58, 0.36)
    at = np.array([0.3, -0.2, 1.0, 0.02, 0.1])
    rate = newtons_rates(D, 0.5, place, line, 1.11, 0.3)[0]
    steps = np.eye(5) * 1e-5
    slopes = np.transpose([(np.subtract(rate(0, at + h), rate(0, at - h))) / 2e-5 for h in steps])
    scene = Scene(Body(D.tolist(), M), DamperMass(0.5, place, line, 1.11, 0.3, M))
    assert to_numpy(scene).jacobian(at) == pytest.approx(slopes, abs=1e-8)  # the error of differences: h^2 and 1e-16/h


@pytest.mark.slow
def test_a_mass_beside_the_spin_axis_damps_the_nutation_at_the_rate_of_the_linear_system():
    """On a line along the axis of the spin its spring stays relaxed there (by hand: omega . J' omega vanishes), so that
    the rotation stays; the fit of a run by Newton's equations has the time constant of the linearised system."""
    scene = Scene(Body((1.2, 1.5, 2), M), DamperMass(1, ("0.4", 0, 0), (0, 0, 1), 2, 1, M))
    assert stabilab.motion(load(scene, (0, 0, 1))).fate == Fate.EQUILIBRIUM
    from stabilab.answers.dissipation.time_constants import time_constants
    longest = time_constants(scene, [0, 0, 1, 0, 0])[0].time
    global D
    before, D = D, np.array([1.2, 1.5, 2.0])
    try:
        times = np.linspace(0, 2 * longest, 400)
        w, *_ = newton(1.0, (0.4, 0, 0), (0, 0, 1), 2.0, 1.0, np.array([1e-3, 0, 1]), 0.0, 0.0, times)
    finally:
        D = before
    across = np.log(np.hypot(w[:, 0] * 1.2, w[:, 1] * 1.5))
    late = times > longest / 2
    assert -1 / np.polyfit(times[late], across[late], 1)[0] == pytest.approx(longest, rel=3e-2)


def test_file_and_faults():
    text = ("[body]\ninertia = [2, 1.5, 1.2]\nmass = 10\n[effects.damper_mass]\nmass = \"500 g\"\nplace = [0.4, 0, 0]\n"
            "line = [0, 0, 1]\nstiffness = 2\ncoefficient = 0.3\n"
            "[motion]\nangular_velocity = [0.1, 0.2, 1]\ndamper_mass = [0.05, 0]\nspan = [0, 10]\n")
    case = load(text)
    assert case.start == (0.1, 0.2, 1.0, 0.05, 0.0)
    again = load(stabilab.case.write.data_of_scene(case.scene, {"omega": case.state, **case.blocks}))
    assert again.start == case.start and again.scene == case.scene
    stated = load(text.replace("[0.05, 0]", '["5 cm", "12 mm/s"]'))  # each number in its own unit: by hand
    assert stated.blocks["damper_mass"] == (0.05, 0.012)
    with pytest.raises(InputError, match=r"number 2: expected velocity \(m/s\), got length"):
        load(text.replace("[0.05, 0]", '["5 cm", "12 mm"]'))
    started = stabilab.fate(case, {"omega": case.state, "damper_mass": ["5 cm", "12 mm/s"]})
    assert started.states[-2:].tolist() == [0.05, 0.012]
    with pytest.raises(InputError, match="give body.mass"):
        load(text.replace("mass = 10\n", "", 1))
    with pytest.raises(InputError, match="the rest would have none above zero"):
        load(text.replace("0.4, 0, 0", "4, 0, 0"))
    assert stabilab.equilibria(case).kind == "undecided"


def test_a_wheel_on_a_spring_starts_at_an_angle_in_degrees():
    """By hand: 90 deg are pi/2, 60 rpm 2 pi rad/s."""
    case = load({"body": {"inertia": [2, "1.5", "1.2"]}, "effects": {"damper_wheel": {
        "inertia": "0.05", "coefficient": "0.02", "stiffness": "0.05", "axis": [1, 0, 0]}},
        "motion": {"angular_velocity": [0, 0, 1], "sprung_wheel": ["90 deg", "60 rpm"]}})
    assert case.blocks["sprung_wheel"] == pytest.approx((math.pi / 2, 2 * math.pi), rel=1e-15)


def test_a_mass_along_a_rod_may_have_more_than_its_least_moment():
    """By hand: it has none about the rod itself, and mu r^2 = 0.5 (0.95) (0.6/0.95)^2 = 0.1895 kg m^2 across it. T >=
    rest_of_moments |omega|^2/2 is checked by eigenvalues of the rest."""
    rod = lambda place: Scene(Body(["1", "1", "0.1"], "10"), DamperMass("0.5", place, (0, 0, 1), "2", "0.3", "10"))
    moments = content(rod(("0", "0", "0.6"))).rest_of_moments
    assert 0 < moments <= 0.1  # of the rest about its own mass centre: 0.8105, 0.8105, 0.1
    with pytest.raises(InputError, match="none above zero"):
        rod(("0.5", "0", "0.6"))  # by hand: mu x^2 = 0.1316 about the rod
    with pytest.raises(InputError, match="none above zero"):
        rod(("0", "0", "1.4"))  # mu r^2 = 1.03 across it


def _growth(D, arguments, wheel, omega):
    """The largest real part of the eigenvalues but for the one of |H|, over the largest: central differences of
    Newton's equations at a rotation with the mass at its place; and whether it is an equilibrium."""
    rate = newtons_rates(np.array(D), *arguments, wheel)[0]
    at, h = np.array([*omega, 0, 0]), 1e-6
    rest = np.abs(rate(0, at)).max()
    values = np.linalg.eigvals(np.stack([(np.array(rate(0, at + h * e)) - rate(0, at - h * e)) / (2 * h)
                                         for e in np.eye(5)], axis=1))
    values = sorted(values, key=abs)[1:]
    return max(v.real for v in values), rest


@pytest.mark.first(8, 40)
@pytest.mark.parametrize("seed", range(120))
def test_rotations_that_leave_the_spring_relaxed_are_stable_where_newtons_equations_are(seed):
    """A place in a plane across the line, or along an axis: random bodies, with a wheel along an axis in half of them."""
    rng = np.random.default_rng([23, seed])
    D, r, n = rng.uniform(1.2, 2, 3), rng.normal(size=3) * 0.25, np.eye(3)[seed % 3]
    r[seed % 3] = 0.0
    if seed % 5 == 0:
        r, n = 0.25 * np.eye(3)[seed % 3], rng.normal(size=3) * (np.eye(3)[seed % 3] == 0)  # along no axis
    wheel = np.eye(3)[int(rng.integers(3))] * rng.normal() * (seed % 2)
    arguments = (0.5, r.tolist(), n.tolist(), float(10 ** rng.uniform(-1, 0.5)), 0.3)
    scene = Scene(Body(D.tolist(), M), DamperMass(*arguments, M), *([Gyrostat(wheel.tolist())] if any(wheel) else []))
    found, judged = stabilab.equilibria(scene), 0
    assert found.kind == "undecided" and "relaxed" in found.because
    for curve in found.curves:
        for segment in curve.segments:
            low, high = max(segment.t[0], -6.0), min(segment.t[1], 6.0)
            if low >= high:
                continue
            omega = curve.point(low + 0.4137 * (high - low))
            growth, rest = _growth(D, arguments, wheel, omega)
            assert rest < 1e-12
            if segment.verdict == "unstable":
                assert growth > 0
            elif segment.verdict == "stable":
                assert growth < 1e-7  # what fades slowly is at rounding
            judged += segment.verdict != "undecided"
    assert judged


def test_the_spin_of_a_published_nutation_damper_is_stable_up_to_a_rate():
    """By hand: about z, D3 greatest, k > W^2 (0 + mu^2 r^2/(D3 - D1)), J2_33 = 0, with r from the mass centre of the
    rest; the public example runs at 1 rad/s."""
    case = load(CASES / "dampers/mass.toml")
    mass, whole, D = 52.744, 5327.144, case.scene.body.inertia
    mu = mass * (1 - mass / whole)
    limit = math.sqrt(52.744 * (D[2] - D[0])) / mu
    curve = next(c for c in stabilab.equilibria(case).curves if "3" in str(c.description.name))
    stable = [s.t for s in curve.segments if s.verdict == "stable"]
    assert [*stable[0], *stable[-1]] == pytest.approx([-limit, 0, 0, limit], rel=1e-12) and limit > 1
    # the moments of the example, of the body about its own mass centre, from those of the whole
    assert np.array(D) - [0, mu, mu] == pytest.approx([1375.7, 1292.5, 1402.4], rel=1e-12)
