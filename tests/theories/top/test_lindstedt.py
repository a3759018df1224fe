"""The fast top: its periodic motion by order, against hand derivation, the paper's equations in many digits,
exact motion."""
import math
from itertools import product
from pathlib import Path

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, Scene, trajectory
from stabilab.errors import InputError
from stabilab.integrate.to_heyoka import heyoka_available
from stabilab.physics.effects.gravity import Gravity
from stabilab.physics.effects.newtonian_field import NewtonianField
from stabilab.theories.euler_angles import euler_angles, mean_precession
from stabilab.theories.top import paper_numbers, printed
from stabilab.theories.top_lindstedt import lindstedt

CASES = Path(__file__).parents[3] / "cases"
R0, START = 150.0, {"omega": (0.0, 0.0, 150.0), "gamma": (0.8, 0.0, 0.6)}
MOMENTS, WEIGHT, ARM, FIELD = (16.2, 16.05, 11.0), 2943.0, (0.7, 0.3, 0.1), 200.0
needs_heyoka = pytest.mark.skipif(not heyoka_available(), reason="heyoka is not installed")


def top(h=1.0, lx=30.0, lz=30.0, arm=ARM, moments=MOMENTS, field=FIELD):
    """A top whose small parameters are h times those of the first one, at the same spin."""
    return Scene(Body(moments), Gravity(WEIGHT * h * h, arm), NewtonianField(field * h * h),
                 Gyrostat((lx * h, 0, lz)))


def on_periodic(scene, start=START):
    """(start on the periodic motion to rounding, its period)."""
    motion = lindstedt(scene, start, [0.0], 16)
    return {"omega": motion.omega[0],
            "gamma": motion.gamma[0] / np.linalg.norm(motion.gamma[0])}, motion.period


# The expansion itself

def test_first_two_orders_are_those_of_a_derivation_by_hand():
    # Derived by hand from eq. (5) with C* for C + l_z/r0; s = nu tau.
    scene = top(0.1)
    motion = lindstedt(scene, START, [0.0], 2)
    A, B, C = MOMENTS
    g0, M3, y1 = 0.6, 0.8 / 0.6, 30 * 0.1 / (motion.epsilon * C * R0)
    L = math.hypot(*ARM)
    x, y, z = (v / L for v in ARM)
    c2 = WEIGHT * 0.01 * L / C
    e, k, a, b = math.sqrt(c2 * g0) / R0, FIELD * 0.01 * g0 / c2, A / C, B / C
    star = C + 30 / R0
    alpha, beta, A1, B1, C1 = (star - B) / A, (A - star) / B, (C - B) / A, (A - C) / B, (B - A) / C
    Omega2, X, P0 = -alpha * beta, 1 / alpha, y1 * C / (star - A)
    lam = alpha * x / (b * Omega2)
    lam1 = (z * (alpha / b - 1 / a) + k * (A1 + alpha * B1)) / (1 - Omega2)
    lam2 = lam1 + z / a - k * A1
    nu2 = -x * M3 - k * C1 * M3**2 / 4 + (X * lam2 - lam1 + P0**2) / 2
    s = np.linspace(0, 6.3, 40)
    cos, sin = np.cos(s), np.sin(s)
    wanted = {  # (order, field): the paper's scaled quantity times its power of epsilon
        (0, 0): P0 + 0 * s, (1, 0): e * (lam + lam1 * M3 * cos), (0, 1): 0 * s,
        (1, 1): e * X * (y / a + lam2 * M3 * sin),
        (0, 2): 1 + 0 * s, (1, 2): 0 * s,
        (2, 2): e**2 * (M3 * (x * (cos - 1) - y * sin) - k * C1 * M3**2 * sin**2 / 2),
        (0, 3): M3 * np.exp(-1j * s), (1, 3): e * P0 * (1 - cos + 1j * sin), (0, 4): 1 + 0 * s,
        (1, 4): e * P0 * M3 * (1 - cos),
        (2, 4): e**2 * (X * y * M3 * sin / a + M3**2 * (lam1 + X * lam2) * sin**2 / 2
                        + (lam * M3 - P0**2) * (1 - cos))}
    series = motion.expansion
    K = series.fields.shape[-1] // 2
    waves = np.exp(1j * np.outer(np.arange(-K, K + 1), s))
    # p, q over c sqrt(gamma0''), gamma over gamma0''
    unit = (series.size / e, series.size / e, 1, 1 / g0, 1 / g0)
    for (n, part), value in wanted.items():
        got = series.fields[n, part] @ waves * series.size**n * unit[part]
        assert np.abs(got - value).max() <= 1e-13 * max(np.abs(value).max(), e**n), (n, part)
    assert series.nu[1] == 0 and series.nu[2] * series.size**2 == pytest.approx(e**2 * nu2, rel=1e-12)
    assert motion.epsilon == pytest.approx(e, rel=1e-14) and motion.Omega2 == pytest.approx(Omega2, rel=1e-14)


@pytest.mark.parametrize("order", range(1, 7))
@pytest.mark.parametrize("lx", [30.0, 0.0])
def test_residual_is_one_order_above_the_expansion(order, lx):
    sizes = (0.6, 0.3, 0.15)
    residuals = [lindstedt(top(h, lx), START, [0.0], order).residual for h in sizes]
    slopes = np.log2(np.array(residuals[:-1]) / residuals[1:])
    assert np.abs(slopes - (order + 1)).max() < 0.2
    assert residuals[-1] > 1e-13  # the slope is not that of rounding


def test_conditions_of_solvability_hold_by_the_integrals():
    assert lindstedt(top(), START, [0.0], 12).expansion.defect < 1e-13


def test_a_gyrostat_across_both_axes_is_expanded_too():
    scene = Scene(Body(MOMENTS), Gravity(30, ARM), Gyrostat((10, -25, 30)))
    slopes = [math.log2(lindstedt(scene, START, [0.0],
                                  n).residual / lindstedt(Scene(Body(MOMENTS), Gravity(7.5, ARM),
                                                                Gyrostat((5, -12.5, 30))), START, [0.0],
                                                          n).residual) for n in (1, 3)]
    assert slopes == pytest.approx([2, 4], abs=0.2)


def test_motion_solves_the_papers_equation_5_in_many_digits():
    # Eq. (5) typed from the paper and integrated by mpmath's Taylor series; no code is shared.
    import mpmath as mp
    scene = top(0.2)
    motion = lindstedt(scene, START, [0.0], 14)
    with mp.workdps(20):
        A, B, C = (mp.mpf(v) for v in MOMENTS)
        g0, lx, lz, r0, N, W = (mp.mpf(v)
                                for v in (0.6, 30 * 0.2, 30, 150, FIELD * 0.2 * 0.2, WEIGHT * 0.2 * 0.2))
        L = mp.sqrt(sum(mp.mpf(v)**2 for v in ARM))
        x, y, z = (mp.mpf(v) / L for v in ARM)
        c = mp.sqrt(W * L / C)
        e, k, a, b = c * mp.sqrt(g0) / r0, N * g0 / c**2, A / C, B / C
        A1, B1, C1, A0, B0, C0 = (C - B) / A, (A
                                               - C) / B, (B - A) / C, 1 / (A * r0), 1 / (B * r0), 1 / (C * r0)

        def rates(_, v):
            p, q, r, g1, g2, g3 = v
            return [-A1 * q * r - A0 * q * lz + e * ((y * g3 - z * g2) / a + k * A1 * g2 * g3),
                    -B1 * r * p + B0 * (p * lz - r * lx / e) + e * ((z * g1 - x * g3) / b + k * B1 * g1 * g3),
                    -e**2 * C1 * p * q + e * C0 * q * lx + e**2 * (x * g2 - y * g1 + k * C1 * g1 * g2),
                    r * g2 - e * q * g3, e * p * g3 - r * g1, e * (q * g1 - p * g2)]
        scale = c * mp.sqrt(g0)
        units = [scale, scale, r0, g0, g0, g0]
        start = [mp.mpf(float(v)) / u for v, u in zip([*motion.omega[0], *motion.gamma[0]], units)]
        end = mp.mpf(5)
        found = [float(v * u) for v, u in zip(mp.odefun(rates, 0, start)(end), units)]
    omega, gamma = motion.at([float(end) / R0])
    assert np.abs(omega[0] - found[:3]).max() < 2e-13 * R0 and np.abs(gamma[0] - found[3:]).max() < 2e-13


# of the default suite; all pairs are slow
FEW = {((0.8, 0, 0.6), 30.0), ((0.28, -0.96, 0), 1e-10), ((0, 0, 1), 30.0)}


@pytest.mark.one_in(3)
@needs_heyoka
@pytest.mark.parametrize("gamma, lx",
                         [pytest.param(*pair, marks=() if pair in FEW else pytest.mark.slow)
                          for pair in product(
    ((0.8, 0, 0.6), (0.28, -0.96, 0), (-0.48, 0.64, -0.6), (0, 0, 1), (1e-9, 0, 1), (0, 0, -1), (1, 0, 1e-6)),
    (30.0, 1e-10))])
def test_high_order_is_the_exact_motion_at_every_tilt(gamma, lx):
    scene, start = top(0.5, lx), {"omega": START["omega"], "gamma": gamma}
    motion = lindstedt(scene, start, [0.0], 12)
    times = np.array([0.3, 1.0, 20.0, 280.0]) * motion.period
    run = trajectory(scene, {"omega": motion.omega[0], "gamma": motion.gamma[0]}, times)
    omega, gamma = motion.at(times)
    assert motion.status == "asymptotic" and np.abs(gamma - run.block("gamma")).max() < 1e-10
    assert np.abs(omega - run.block("omega")).max() < 1e-10 * R0 and omega[0, 2] != R0


def test_start_sets_spin_and_vertical_and_the_rest_is_said():
    motion = lindstedt(top(), START, [0.0], 4)
    assert motion.omega[0, 2] == pytest.approx(R0, rel=1e-15)
    assert motion.gamma[0] == pytest.approx(START["gamma"], abs=1e-15)
    assert motion.departure == pytest.approx(-motion.omega[0, :2])
    assert "is not on the periodic motion" in motion.because
    start = {"omega": motion.omega[0], "gamma": START["gamma"]}
    assert "lies on the periodic motion" in lindstedt(top(), start, [0.0], 4).because


@needs_heyoka
def test_start_off_the_periodic_motion_wobbles_about_it_by_the_departure():
    """The free wobble p'' = -Omega^2 r0^2 p of the undisturbed top, to leading order."""
    scene = top(0.1)
    times = np.linspace(0, 0.5, 400)
    motion, run = lindstedt(scene, START, times,
                            4), trajectory(scene, START, np.maximum(times, 1e-12 * (times == 0)))
    away, size = run.block("omega") - motion.omega, np.hypot(*motion.departure)
    assert np.abs(away[:, :2]).max() == pytest.approx(size, rel=0.1)
    assert np.abs(away[:, 2]).max() < 0.02 * size


def test_l_x_tilts_the_spin_axis_by_l_x_over_C_star_minus_A():
    A, _, C = MOMENTS
    for h in (0.1, 0.05):
        scene = top(h)
        motion = lindstedt(scene, START, np.linspace(0, 1, 200), 3)
        tilt = 30 * h / (C + 30 / R0 - A)
        assert motion.omega[:, 0].mean() == pytest.approx(tilt, rel=0.5 * h)
        # the paper drops it
        assert abs(printed(scene, START, motion.t).omega[:, 0].mean()) < 0.5 * h * abs(tilt)


# Resonances and instability

def near(Omega, lx=30.0, moments=(12.0, 11.0, 6.0), h=0.01):
    """A top with the given Omega by its l_z, and the wheel's moment."""
    a, b = moments[0] / moments[2], moments[1] / moments[2]
    spin = (a + b + math.sqrt((a - b)**2 + 4 * a * b * Omega**2)) / 2
    return top(h, lx, (spin - 1) * moments[2] * R0, moments=moments)


@pytest.mark.parametrize("distance", [1e-1, 1e-2, 1e-3, -1e-1, -1e-2, -1e-3])
@pytest.mark.parametrize("m", [1, 2])
def test_a_resonance_nearby_is_named_with_its_distance(m, distance):
    motion = lindstedt(near(m + distance), START, [0.0], 3)
    found = [r for r in motion.resonances if r.harmonic == m]
    assert len(found) == 1 and found[0].distance == pytest.approx(abs(distance), rel=1e-9)
    assert motion.status in ("near resonance", "diverging") and str(found[0].condition) in motion.because
    assert str(found[0].condition) == ("Omega = 1, C* = A + B" if m == 1 else "Omega = 2")
    wide = lindstedt(near(m + 3 * abs(distance) if abs(distance) > 0.05 else m + 0.2), START, [0.0], 3)
    assert not wide.resonances and wide.status == "asymptotic"


@needs_heyoka
@pytest.mark.parametrize("Omega", [0.999, 1.001, 1.999, 2.001])
def test_near_a_resonance_the_expansion_is_still_exact_for_a_small_enough_parameter(Omega):
    """Small divisors 1/500 to a power; with the parameter below 1e-3 they are tamed."""
    scene = near(Omega)
    motion = lindstedt(scene, START, [0.0], 8)
    times = np.array([0.3, 5.0]) * motion.period
    run = trajectory(scene, {"omega": motion.omega[0], "gamma": motion.gamma[0]}, times)
    omega, gamma = motion.at(times)
    assert motion.status == "near resonance" and np.abs(gamma - run.block("gamma")).max() < 2e-10
    assert np.abs(omega - run.block("omega")).max() < 2e-10 * R0


@pytest.mark.parametrize("lz, lx, order", [
    ((12 + 12 - 6) * R0, 30.0, 0),   # C* = A + B: Omega = 1
    (-6 * R0, 30.0, 0),              # C* = 0: Omega = 1 too
    # A = B = 2 C, C* = 3 A: Omega = 2, forced at order 2 by l_x and the field
    (30 * R0, 30.0, 1),
    (30 * R0, 0.0, 2),               # without l_x only at order 3
    (6 * R0, 30.0, -1),              # C* = A = B: no tilt balances l_x
    (6 * R0, 0.0, 0),                # C* = A = B, forced at order 1
])
def test_an_exact_resonance_ends_the_expansion_below_it(lz, lx, order):
    motion = lindstedt(top(0.01, lx, lz, moments=(12, 12, 6)), START, [0.0, 1.0], 5)
    assert motion.status == "resonant" and motion.order == order and "exact resonance" in motion.because
    assert motion.omega.shape == motion.gamma.shape == ((2, 3) if order >= 0 else (0, 3))
    assert len(motion.t) == len(motion.omega)
    assert np.isfinite(motion.omega).all()
    assert (motion.residual < 0.1 if order >= 0 else motion.residual == math.inf)


def test_omega_two_does_not_force_the_second_order_without_l_x():
    scene = top(0.01, 0.0, 30 * R0, moments=(12, 12, 6))
    assert lindstedt(scene, START, [0.0], 2).order == 2


@needs_heyoka
def test_middle_axis_is_called_unstable_and_neighbours_do_leave_at_the_said_rate():
    scene = top(0.02, moments=(15.0, 9.0, 12.0), lz=0.0)
    motion = lindstedt(scene, START, [0.0], 8)
    rate = R0 * math.sqrt(-motion.Omega2)
    assert motion.status == "unstable" and "Omega^2" in motion.because
    push = np.array([1e-8, 0, 0])
    run = [trajectory(scene, {"omega": motion.omega[0] + s * push, "gamma": motion.gamma[0]},
                      [6 / rate, 10 / rate]) for s in (1, -1)]
    apart = np.linalg.norm(run[0].block("omega") - run[1].block("omega"), axis=1)
    assert math.log(apart[1] / apart[0]) == pytest.approx(4, rel=0.02)


# Angles

def test_regular_precession_of_the_symmetric_top_is_met_order_by_order():
    # Exact: A cos(theta) P^2 - (C r + l_z) P - M g z = 0 for the steady precession P about the weight, slow
    # root.
    A, C, lz, arm = 16.0, 11.0, 30.0, 0.5
    slow = 2 * -WEIGHT * arm / ((s := C * R0 + lz) + math.sqrt(s * s + 4 * A * 0.6 * WEIGHT * arm))
    scene = Scene(Body((A, A, C)), Gravity(WEIGHT, (0, 0, arm)), Gyrostat((0, 0, lz)))
    off = [abs(mean_precession(lindstedt(scene, START, [0.0], n)) / slow - 1) for n in (2, 6, 16)]
    assert off[0] < 1e-2 and off[1] < 1e-6 and off[2] < 1e-13
    motion = lindstedt(scene, START, np.linspace(0, 5, 2001), 16)
    angles = euler_angles(motion.t, motion.omega, motion.gamma)
    assert angles.psi == pytest.approx(slow * motion.t, rel=1e-11) and np.ptp(angles.theta) < 1e-12


def test_an_axis_that_never_leaves_the_vertical_has_no_precession():
    # psi and phi turn about the same line: by phi's samples the precession came out as the spin
    scene = Scene(Body((16.0, 16.0, 11.0)), Gravity(WEIGHT, (0, 0, 0.5)), Gyrostat((0, 0, 30.0)))
    upright = {**START, "gamma": (1e-9, 0.0, math.sqrt(1 - 1e-18))}
    with pytest.raises(InputError, match="vertical"):
        mean_precession(lindstedt(scene, upright, [0.0], 4))


@pytest.mark.one_in(3)
@needs_heyoka
@pytest.mark.parametrize("gamma", [(0.8, 0, 0.6), (0.8, 0, -0.6), (0, 1, 0)])
def test_precession_and_nutation_are_those_of_the_axis_in_space(gamma):
    """Independent: axis 3 carried by the integrated quaternion, its azimuth about the weight."""
    start, period = on_periodic(top(), {"omega": START["omega"], "gamma": gamma})
    times = np.linspace(0, 12 * period, 12 * 60 + 1)[1:]
    run = trajectory(top(), start | {"attitude": (1.0, 0, 0, 0)}, times)
    w, x, y, z = run.block("attitude").T
    axis = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], -1)
    up = np.array(start["gamma"])
    across = np.array([0, 0, 1.0]) - up[2] * up
    across /= np.linalg.norm(across)
    azimuth = np.unwrap(np.arctan2(axis @ np.cross(up, across), axis @ across))
    motion = lindstedt(top(), start, times, 16)
    exact, periodic = (euler_angles(times, omega, gamma) for omega, gamma in
                       ((run.block("omega"), run.block("gamma")), (motion.omega, motion.gamma)))
    assert exact.psi - exact.psi[0] == pytest.approx(azimuth - azimuth[0], abs=1e-7)
    assert exact.status == "regular"
    assert periodic.psi == pytest.approx(azimuth - azimuth[0], abs=1e-7)
    assert exact.theta == pytest.approx(np.arccos(axis @ up), abs=1e-9)
    assert periodic.theta == pytest.approx(exact.theta, abs=1e-9)
    assert exact.phi == pytest.approx(periodic.phi, abs=1e-8) and abs(exact.phi[-1] - exact.phi[0]) > 60
    assert exact.error < 1e-6


def test_angles_pass_the_pole_by_their_sum():
    # Closed form: rotation about a body axis across the weight, theta = |t|, then phi jumps by half a turn
    # and psi back.
    t = np.linspace(-1, 1, 41)
    gamma = np.stack([0 * t, np.sin(t), np.cos(t)], -1)
    omega = np.stack([1 + 0 * t, 0 * t, 0 * t], -1)  # gamma' = gamma x omega
    angles = euler_angles(t, omega, gamma)
    assert angles.status == "singular" and "t = 0 s" in angles.because.replace("-0 s", "0 s")
    assert angles.theta == pytest.approx(np.abs(t), abs=1e-14)
    assert angles.psi + angles.phi == pytest.approx(np.full(41, angles.phi[0]), abs=1e-12)
    assert abs(angles.phi[-1] - angles.phi[0]) == pytest.approx(math.pi)


def test_samples_too_far_apart_for_the_precession_are_called_coarse():
    motion = lindstedt(top(), START, np.linspace(0, 1, 30), 6)
    assert euler_angles(motion.t, motion.omega, motion.gamma).status == "coarse"


# --- what the words follow from

@pytest.mark.parametrize("name", ["top-lx30-lz30", "top-lx90-lz30", "top-lx30-lz90"])
@pytest.mark.parametrize("order", range(7))
def test_no_order_calls_the_data_of_table_1_a_periodic_motion(name, order):
    """By hand: M g L/(C r0^2) = 8.2 stands where a small number should, and eps delta1 = 4.5 of the paper, of
    order eps, at l_x = 30."""
    case = stabilab.load(CASES / f"{name}.toml")
    found = lindstedt(case.scene, {"omega": case.state, "gamma": case.blocks["gamma"]}, [0.0], order)
    assert found.status == "diverging" and "lies on" not in found.because and "not fast enough" in found.because
    assert found.size**2 == pytest.approx(8.22, abs=0.01)
    assert found.epsilon * 50 == pytest.approx(4.53, abs=0.01)


@pytest.mark.parametrize("order", range(9))
def test_a_valid_top_is_told_as_one_at_every_order_with_what_the_order_leaves_out(order):
    """What order 12 has at the start, no less than twice the departure told, is what the lower order leaves
    out."""
    case = stabilab.load(CASES / "top-fast.toml")
    state = {"omega": case.state, "gamma": case.blocks["gamma"]}
    found, best = (lindstedt(case.scene, state, [0.0], n) for n in (order, 12))
    assert found.status == "asymptotic" and found.residual < 0.1 * max(found.terms[-2:])
    assert case.state[2] >= 150 and (order < 8 or "lies on the periodic motion" in found.because)
    left = np.hypot(*(best.omega[0, :2] - found.omega[0, :2]))
    assert 0.5 * left < found.left_out < 2 * left


@pytest.mark.one_in(2)
@needs_heyoka
@pytest.mark.parametrize("h, status",
                         [(0.1, "asymptotic"), (0.3, "asymptotic"), (1.0, "asymptotic"), (3.0, "asymptotic"),
                                       (9.0, "diverging"), (15.0, "diverging")])
def test_asymptotic_series_follow_the_motion_for_a_revolution_and_diverging_ones_do_not(h, status):
    """Against a run of the exact equations from the series' own start."""
    for order in range(6):
        motion = lindstedt(top(h), START, [0.0], order)
        times = np.linspace(0, abs(motion.period), 40)
        omega, gamma = motion.at(times)
        run = trajectory(top(h), {"omega": omega[0], "gamma": gamma[0] / np.linalg.norm(gamma[0])}, times)
        error = np.abs(run.block("gamma") - gamma).max()
        assert motion.status == status, order
        assert error < 0.4 and error < 2 * np.pi * motion.residual if status == "asymptotic" else error > 1


# The paper's own solution

def test_printed_solution_is_right_to_its_order_without_gyrostat():
    drops = []
    for h in (0.2, 0.1):
        scene = top(h, 0.0, 0.0)
        motion = lindstedt(scene, START, np.linspace(0, 0.04, 40), 8)
        paper = printed(scene, START, motion.t)
        drops.append([np.abs(paper.omega - motion.omega).max(0), np.abs(paper.gamma - motion.gamma).max(0)])
    slopes = np.log2(np.array(drops[0]) / np.array(drops[1]))
    # p, q: epsilon of omega times epsilon^2 beyond (no even orders); r, gamma'': to second order; gamma,
    # gamma': the missing nu
    assert slopes == pytest.approx(np.array([[4, 4, 4], [2, 2, 4]]), abs=0.2)


@pytest.mark.parametrize("arm, order", [((0.7, 0, 0.1), 4), ((0, 0.3, 0.1), 2)])
def test_printed_angles_have_wrong_signs_where_y0_enters(arm, order):
    """Without y0 eq. (43) is right to second order; with it theta2 and psi2 are wrong there."""
    drops = []
    for h in (0.2, 0.1):
        scene = top(h, 0.0, 0.0, arm)
        motion = lindstedt(scene, START, np.linspace(0, 0.04, 40), 8)
        paper, angles = printed(scene, START, motion.t), euler_angles(motion.t, motion.omega, motion.gamma)
        theta0 = math.acos(START["gamma"][2])
        # csc(eps theta0) stands where csc theta0 is meant
        meant = paper.psi * math.sin(paper.epsilon * theta0) / math.sin(theta0)
        drops.append([np.abs(paper.theta - angles.theta).max(), np.abs(meant - angles.psi).max()])
        assert np.abs(paper.psi - angles.psi).max() > np.abs(angles.psi).max()
    assert np.log2(np.array(drops[0]) / np.array(drops[1])) == pytest.approx(order, abs=0.2)


def test_printed_solution_has_poles_though_the_text_denies_it():
    # l_z = 0 and C = A + B is a flat body; printed Omega^2 = (C-A)(C-B)/(A B) = 1
    scene = Scene(Body((5, 6, 11)), Gravity(WEIGHT, ARM))
    found = [printed(Scene(body, Gravity(WEIGHT, ARM)), START, [0.0])
             for body in (Body((12, 11, 11)), Body((11, 12, 11)))]
    assert all(p.status == "pole" and p.omega.shape == (0, 3) for p in found)
    assert abs(1 - paper_numbers(Scene(Body((5, 6, "10.999999")), Gravity(WEIGHT, ARM)), START)["Om"]) < 1e-5
    assert lindstedt(scene, START, [0.0], 2).status == "resonant"


@needs_heyoka
def test_spin_of_the_papers_data_reverses_within_a_tenth_of_a_second():
    case = stabilab.load(CASES / "top-lx30-lz30.toml")
    run = trajectory(case.scene, {"omega": case.state, **case.blocks}, [0.1])
    assert run.block("omega")[0, 2] == pytest.approx(-4.69, abs=0.01)


def test_cases_of_the_table_have_its_data():
    for lx, lz in ((30, 30), (60, 30), (90, 30), (30, 60), (30, 90)):
        case = stabilab.load(CASES / f"top-lx{lx}-lz{lz}.toml")
        A, B, C = case.scene.body.inertia
        state = {"omega": case.state, **case.blocks}
        epsilon = paper_numbers(case.scene, state)["ep"]
        assert (A, B, C) == pytest.approx((15 * (1 + 50 * epsilon), 15 * (1 + 45 * epsilon), 11), rel=1e-6)
        assert case.scene.vector("gyrostat") == (lx, 0, lz) and case.state[2] == 5
        assert printed(case.scene, state, [0.0]).omega[0] == pytest.approx(case.state, abs=1e-6)


@pytest.mark.parametrize("scene, state, order, words", [
    (Scene(Body(MOMENTS), ConstantTorque((0, 0, 1))), START, 2, "the scene has constant_torque"),
    (top(), {"omega": (1, 2, 0), "gamma": (0, 0, 1)}, 2, "third component is 0"),
    (top(), {"omega": (1, 2, 3), "gamma": (0, 1, 1)}, 2, "unit vector"),
    (top(), {"omega": (1, 2, 3)}, 2, "expected"),
    (top(), (1, 2, 3, 1, 0), 2, "got 3 and 2"),
    (top(), START, 1.5, "whole number from 0 to 24"),
    (top(), START, -1, "whole number from 0 to 24"),
    (top(), START, True, "whole number from 0 to 24"),
])
def test_bad_input_is_refused_in_words(scene, state, order, words):
    with pytest.raises(InputError, match=words):
        lindstedt(scene, state, [0.0], order)


@pytest.mark.parametrize("scene, gamma, words", [
    (Scene(Body(MOMENTS), NewtonianField(1)), (0.8, 0, 0.6), "needs gravity"),
    (top(), (0.8, 0, -0.6), "third component of gamma above 0"),
    (Scene(Body(MOMENTS), Gravity(1, ARM), Gyrostat((0, 1, 0))), (0.8, 0, 0.6), "second component"),
])
def test_printed_solution_refuses_what_its_scaling_cannot_hold(scene, gamma, words):
    with pytest.raises(InputError, match=words):
        printed(scene, {"omega": START["omega"], "gamma": gamma}, [0.0])


@pytest.mark.parametrize("times", [[np.nan], [[0.0, 1.0]], ["a"]])
def test_times_of_an_expansion_are_finite_numbers_in_a_row(times):
    with pytest.raises(InputError, match="times: expected"):
        lindstedt(Scene(Body(MOMENTS), Gravity(1, ARM)), START, times)
