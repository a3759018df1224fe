"""Closed forms of the charged, nearly axisymmetric body: against the equations in arbitrary precision, and in
print."""
import math

import numpy as np
import pytest

from stabilab.errors import InputError
from stabilab.theories.charged import (
    BEYOND,
    MISPRINTS,
    WITHIN,
    circle,
    corrected,
    formulas,
    printed,
    solution,
)
from stabilab.theories.charged_modes import (
    ChargedBody,
    horizon,
    largest_tilt,
    modes,
    pointing,
    resonances,
    spin_drift,
    tilt_parts,
)

flint = pytest.importorskip("flint")
from tests.oracles.axisymmetric import BITS, OUTPUTS, conditioned  # noqa: E402 - after importorskip

ALLOWED = 20  # times the effect of half a unit in the last place of the inputs
TIMES = (1e-12, 1e-6, 1e-3, 0.3, 7.0, 50.0, 1e3, 1e6, 1e9)
NEAR = (0.0, *(sign * 10.0**-n for n in range(2, 15, 2) for sign in (1, -1)))
START = dict(M1=0.3, M2=-0.2, p0=0.1, q0=-0.25, psi0=0.03, phi0=0.01, theta0=0.4, f1=0.2, f2=-0.7, f3=3.0,
             m=10.0,
             v1=0.1, v2=-0.2, v3=0.3, x1=1.0, x2=-2.0, x3=0.5)
D1, D2, D3, R0, K = 8.75, 8.5, 11.0, 0.25, 0.3125  # binary fractions: the resonances are met exactly
RESONANT = {  # lambda3 that meets the resonance, by the definitions of a, b, X, Y
    "a = 0": K - (D3 - D2) * R0, "b = 0": K - (D3 - D1) * R0, "X = 0": K - D3 * R0,
    "Y = 0": K - (D3 - D1 - D2) * R0,
    "a = -b": K - R0 * ((D3 - D2) * D2 + (D3 - D1) * D1) / (D1 + D2)}  # the middle of the unstable band
PAPER = dict(inertia=(8.7, 8.6, 11.1), spin=2.7 * 2 * math.pi / 60, mass=10.0, force=(0.0, 0.0, 3.0))


def near_resonance(name, distance, t):
    if name == "r0 = 0":
        return START | dict(D1=D1, D2=D2, D3=D3, k=K, lambda3=1.25, r0=distance, t=t)
    v = START | dict(D1=D1, D2=D2, D3=D3, k=K, r0=R0, lambda3=RESONANT[name] * (1 + distance), t=t)
    m = modes(body_of(v))
    # exp(300) is still a double
    return v | dict(t=min(t, 300 / abs(float(m.root)))) if m.unstable else v


def body_of(v):
    get = lambda *names: [v[n] for n in names]
    return ChargedBody(get("D1", "D2", "D3"), v["r0"], v["lambda3"], v["k"], get("M1", "M2"), get("p0", "q0"),
                       get("psi0", "phi0", "theta0"), get("f1", "f2", "f3"), v["m"], get("v1", "v2", "v3"),
                       get("x1", "x2", "x3"))


def twelve(motion):
    return [*motion.omega[:2], *motion.angles[:2], *motion.momentum[:2], *motion.velocity, *motion.position]


def worst(v, values):
    """Largest error of the twelve outputs over the effect of half a unit in the last place of the inputs."""
    exact, effect = conditioned(v)
    with flint.ctx.workprec(BITS):
        error = {name: float(abs(flint.arb(float(x)) - e).mid()) for name, x,
                 e in zip(OUTPUTS, values, exact)}
    assert all(s > 0 for s in effect)
    return max(error[name] / s for name, s in zip(OUTPUTS, effect))


@pytest.mark.one_in(3)
@pytest.mark.parametrize("every", [3, pytest.param(1, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", ["r0 = 0", *RESONANT])
def test_at_and_around_every_resonance_no_digit_is_lost(name, every):
    for number, distance in list(enumerate(NEAR))[::every]:
        v = near_resonance(name, distance, TIMES[(2 * number + len(name)) % len(TIMES)])
        assert worst(v, twelve(solution(body_of(v), v["t"]))) <= ALLOWED, (name, distance, v["t"])


@pytest.mark.one_in(2)
@pytest.mark.parametrize("shape", [(8.7, 8.6, 11.1), (8.7, 8.7, 11.1), (8.7, 8.6, 0.3), (5.0, 1.0, 5.5)],
                         ids=["oblate", "symmetric", "rod", "flat"])
def test_ordinary_bodies_keep_every_digit_from_1e_minus_12_to_1e9_s(shape):
    for t in TIMES:
        v = START | dict(zip(("D1", "D2", "D3"), shape)) | dict(r0=-0.283, lambda3=-1.3, k=0.29, t=t)
        assert worst(v, twelve(solution(body_of(v), v["t"]))) <= ALLOWED, t


@pytest.mark.parametrize("changes", [
    dict(D1=2.4, D2=0.0024, D3=2.399, r0=0.0, lambda3=0.604, k=0.0, p0=0.0, t=1.2984),
    dict(D1=2.4, D2=0.0024, D3=2.399, r0=0.0, lambda3=0.548, k=0.0, p0=0.0, t=1.1187),
    dict(D1=3.1, D2=3.1, D3=0.0003, r0=1.0, lambda3=0.0, k=0.0, M1=0.0, M2=0.0, psi0=0.0, phi0=0.0, f3=0.0,
         v1=0.0, v2=0.0, v3=0.0,
         t=2 * math.pi * 3.1 / 0.0003)],  # needs r0 + w to more digits than r0 and w have
    ids=["a far below b", "a far below b, slower", "rod after a turn of its cone"])
def test_extreme_shapes_keep_every_digit(changes):
    v = START | changes
    assert worst(v, twelve(solution(body_of(v), v["t"]))) <= ALLOWED


def random_bodies(count, seed=7):
    u = lambda *size: rng.uniform(-1, 1, size or None)
    rng = np.random.default_rng(seed)
    return [ChargedBody(8 + u(3), u(), u(), u(), u(2), u(2), 0.1 * u(3), u(3), 10 + u(), u(3), u(3))
            for _ in range(count)]


def test_the_motion_satisfies_its_differential_equations():
    h = 1e-4
    for body in random_bodies(40):
        early, now, late = (solution(body, 3.0 + x) for x in (-h, 0.0, h))
        (p, q, r), (psi, phi, theta), (A, B, C) = now.omega, now.angles, body.inertia
        Lam, (M1, M2), (f1, f2, f3) = body.gyrostat - body.charge_moment, body.torque, body.force
        push = np.exp(1j * theta) * (f1 + 1j * f2 - 1j * (psi + 1j * phi) * f3)
        wanted = {"omega": ((M1 - ((C - B) * r + Lam) * q) / A, (M2 + ((C - A) * r + Lam) * p) / B, 0),
                  "angles": (p + r * phi, q - r * psi, r),
                  "velocity": np.array((push.real, push.imag, f3 - phi * f1 + psi * f2)) / body.mass,
                  "position": now.velocity}
        for name, rate in wanted.items():
            # h^2 times a third derivative near 10
            np.testing.assert_allclose((getattr(late, name) - getattr(early, name)) / (2 * h), rate, atol=3e-7)


def test_equal_transverse_moments_make_the_papers_model_exact():
    body = ChargedBody((8.7, 8.7, 11.1), 0.283, 1.3, 0.29, (4.0, 1.0), (0.1, 0.2), (0.1, 0.2, 0.3),
                       (1.0, 2.0, 3.0), 10.0)
    t = np.linspace(0, 50, 501)
    exact, paper = solution(body, t), corrected(body, t)
    for part in ("omega", "angles", "velocity", "position"):
        np.testing.assert_array_equal(getattr(paper, part), getattr(exact, part))  # bit for bit
    # (33) against the balance of momentum
    np.testing.assert_allclose(paper.momentum, exact.momentum, atol=1e-13)


def test_without_gyrostat_and_charge_the_papers_model_is_exact_too():
    body = ChargedBody((8.7, 8.6, 11.1), 0.283, torque=(4.0, 1.0), rates=(0.1, 0.2))
    t = np.linspace(0, 50, 51)
    np.testing.assert_allclose(corrected(body, t).angles, solution(body, t).angles, rtol=1e-13, atol=1e-13)


def test_the_papers_frequency_shifts_the_phase_on_its_own_data_whatever_the_amplitude():
    for torque in (4.0, 4e-6):
        body = ChargedBody(**PAPER, gyrostat=1.3, charge_moment=0.003 * 100 * 1.02**2 * math.cos(0.37),
                           torque=(torque, 0.0))
        t = np.linspace(0, 50, 5001)
        exact, paper = solution(body, t), corrected(body, t)
        off = np.abs(paper.omega - exact.omega).max(axis=0)[:2] / np.abs(exact.omega).max(axis=0)[:2]
        assert 0.11 < off[0] < 0.12  # (W - sqrt(ab)) 50 s = 0.118 rad of phase


def typed(gyrostat=1.3, **changes):
    data = (PAPER | dict(gyrostat=gyrostat, charge_moment=0.29, torque=(0.4, -0.2), rates=(0.1, 0.2),
                         attitude=(0.02, 0.01, 0.3)))
    return ChargedBody(**(data | changes))


def test_the_typed_tilt_is_the_one_frequency_model():
    t = np.linspace(0, 50, 101)
    # (11)-(13), (20)-(26), (33) hold misprints of the frequency only
    for part in ("omega", "angles", "momentum"):
        np.testing.assert_allclose(getattr(printed(typed(), t), part), getattr(corrected(typed(), t), part),
                                   atol=1e-12)


def test_the_typed_translation_is_right_where_print_is():
    """D1 = D2 removes (46) and (61); f1 = f2 = 0 removes (50), (51), (64)-(66) and the sign in (58)."""
    body, t = typed(inertia=(8.7, 8.7, 11.1)), np.linspace(0, 50, 101)
    for part in ("velocity", "position"):
        np.testing.assert_allclose(getattr(printed(body, t), part), getattr(corrected(body, t), part),
                                   atol=1e-9)


def test_the_printed_translation_is_what_the_paper_prints():
    """(43)-(46), (58)-(61) typed a second time, from rest with f1 = f2 = 0: Pi10 = Gamma0 = 0, plain complex
    numbers."""
    from cmath import exp
    D1, D2, D3, M1, f3, m, r0, t = 8.7, 8.6, 11.1, 4.0, 3.0, 10.0, PAPER["spin"], 7.0
    Lam = 1.3 - 0.29
    zeta1, zeta2 = (D3 - D2) / D1, (D3 - D1) / D2
    zeta = math.sqrt(zeta1 * zeta2)
    W = zeta * (r0 + Lam / (zeta1 * D1))
    A, plus, minus = M1 * math.sqrt(zeta2) / D1, r0 + W, r0 - W
    spin = 1j / r0 * (1 - exp(1j * r0 * t)) - t
    I1 = A / W * (spin / r0 - (1j * (1 - exp(1j * t * plus)) / plus - t) / plus)
    I2 = (-A / W
          * (spin / r0 - (1j * (exp(1j * t * (r0 - zeta * (r0 + zeta * Lam / (zeta1 * D1)))) - 1) / minus - t)
             / minus))
    both = lambda a, b: ((math.sqrt(zeta1) + math.sqrt(zeta2)) * a
                         + (math.sqrt(zeta1) - math.sqrt(zeta2)) * b) / (2 * zeta)
    omega = -1j * f3 * both(I1, I2) / m
    inner = 1j / r0 * (t - 1j / r0 * (1 - exp(1j * r0 * t))) - t**2 / 2
    J1 = A / W * (inner / r0 - (-t**2 / 2 + 1j / plus * (t + 1j * (exp(1j * t * plus) - 1) / plus)) / plus)
    J2 = (-A / W * (inner / r0 - (-t**2 / 2 + 1j / minus * (t + 1j * (1 - exp(1j * t * minus) - 1) / minus))
                    / minus))
    eta = -1j * f3 * both(J1, J2) / m
    run = printed(ChargedBody(**PAPER, gyrostat=1.3, charge_moment=0.29, torque=(M1, 0.0)), t)
    assert run.velocity == pytest.approx([omega.real, omega.imag, f3 * t / m], rel=1e-12)
    assert run.position == pytest.approx([eta.real, eta.imag, f3 * t**2 / (2 * m)], rel=1e-12)


@pytest.mark.parametrize("number, integral, integrand, back", [
    ("(45)", "I1w_45", "I1G_24", False), ("(46)", "I2w_46", "I2G_25", False),
    ("(50), (51)", "I4w_50", "I1G_24", True),
    ("(50), (51)", "I5w_51", "I2G_25", True), ("(60)", "I1e_60", "I1w_45", False),
    ("(61)", "I2e_61", "I2w_46", False)])
def test_a_typed_integral_differs_from_what_it_integrates_exactly_if_listed_as_misprinted(number, integral,
                                                                                          integrand, back):
    r0, h = 0.28, 1e-4
    values = {"r0": r0, "zeta1": 0.8, "zeta2": 0.9, "D1": 2.0, "Lam": -0.15, "P10": 0.1 + 0.2j,
              "A": 0.3 - 0.1j}
    at = lambda name, t: formulas()(name, values, t=t)
    slope = (at(integral, 2 + h) - at(integral, 2 - h)) / (2 * h)
    meant = at(integrand, 2.0) * (np.exp(-2j * r0) if back else 1)
    assert (abs(slope - meant) > 1e-3) == (number in MISPRINTS), (slope, meant)


def test_with_the_printed_data_the_small_angles_end_after_0_66_s():
    body = ChargedBody(**PAPER, gyrostat=1.3, charge_moment=0.003 * 100 * 1.02**2 * math.cos(0.37),
                       torque=(4.0, 0.0))
    assert horizon(body) == pytest.approx(math.sqrt(2 * 0.1 / (4 / 8.7)),
                                               rel=1e-14) == pytest.approx(0.66, abs=0.001)
    motion = solution(body, np.linspace(0, 50, 501))
    assert motion.status == BEYOND and "0.1 rad" in motion.because
    assert solution(body, np.linspace(0, 0.65, 9)).status == WITHIN


def test_before_the_horizon_a_symmetric_body_keeps_its_tilt_small():
    rng = np.random.default_rng(8)
    for _ in range(50):
        D = rng.uniform(2, 9)
        body = ChargedBody((D, D, rng.uniform(0.1, 2 * D)), *rng.uniform(-3, 3, 3), rng.uniform(-1, 1, 2),
                           rng.uniform(-0.1, 0.1, 2),
                           rng.uniform(-0.05, 0.05, 3))
        until = min(horizon(body), 1e4)
        assert np.max(solution(body, until * np.linspace(0, 1, 200)).tilt) <= 0.1 * (1 + 1e-12)


@pytest.mark.parametrize("D3_, Lam", [(11.1, 1.3), (4.0, 0.0), (4.0, 0.5), (11.1, -8.0)])
def test_the_largest_tilt_from_rest_divides_by_the_two_smallest_of_three_rates(D3_, Lam):
    r0, D, M = 0.9, 8.7, 1e-3
    w = ((D3_ - D) * r0 + Lam) / D
    small, next_, _ = sorted(map(abs, (r0, w, r0 + w)))
    body = ChargedBody((D, D, D3_), r0, Lam, torque=(M, 0.0))
    assert largest_tilt(body) == pytest.approx(2 * M / D / (small * next_), rel=1e-13)
    reached = solution(body, np.linspace(0, 20000, 100001)).tilt.max()
    assert 0.999 * largest_tilt(body) < reached <= largest_tilt(body) * (1 + 1e-12)


def test_four_rotating_parts_make_the_tilt():
    t, told = 17.0, 0
    for body in random_bodies(60):
        if (z := tilt_parts(body)) is None:
            continue
        Gamma = (z.steady + z.coning * np.exp(-1j * body.spin * t) + z.B * np.exp(1j * z.frequency * t)
                 + z.C * np.exp(-1j * z.frequency * t))
        assert abs(Gamma - complex(*solution(body, t).angles[:2])) < 1e-9
        told += 1
    assert told > 40


def test_mean_velocity_points_where_the_corrected_53_and_54_say():
    M1, M2, r0, Lam, C = 0.3, -0.2, 0.9, 1.3, 11.1
    body = ChargedBody((8.7, 8.6, C), r0, Lam, torque=(M1, M2), force=(0.0, 0.0, 3.0), mass=10.0)
    assert complex(pointing(body).velocity_ratio) == pytest.approx(1j * (M1 + 1j * M2)
                                                                   / (r0 * (C * r0 + Lam)), rel=1e-13)
    # (53)-(54) as printed: Lambda = 0
    plain = ChargedBody((8.7, 8.6, C), r0, torque=(M1, M2), force=(0.2, 0.5, 3.0), mass=10.0)
    bracket = 1 + M1 * 0.5 / 3 / ((C - 8.6) * r0**2) - M2 * 0.2 / 3 / ((C - 8.7) * r0**2)
    assert complex(pointing(plain).velocity_ratio) == pytest.approx(1j * (M1 + 1j * M2) / (C * r0**2)
                                                                    / bracket, rel=1e-13)
    velocity = solution(plain, 1e9).velocity
    assert (velocity[0] + 1j
            * velocity[1]) / velocity[2] == pytest.approx(complex(pointing(plain).velocity_ratio), rel=1e-7)


def test_mean_angular_momentum_is_the_average_of_the_motion():
    body = ChargedBody((8.7, 8.6, 11.1), 0.9, 1.3, 0.4, (0.3, -0.2), (0.05, 0.02), (0.01, 0.03, 0.5))
    t = np.linspace(0, 6000, 60001)
    window = np.hanning(t.size)
    G = solution(body, t).momentum
    mean = np.average(G[:, 0] + 1j * G[:, 1], weights=window)
    assert mean == pytest.approx(complex(pointing(body).momentum), abs=1e-5)
    assert pointing(body).momentum_error == pytest.approx(math.atan2(abs(mean), G[0, 2]), abs=1e-5)


@pytest.mark.one_in(3)
@pytest.mark.parametrize("torque, rates",
                         [((0.0, 0.0), (0.5, -0.3)), ((1.0, 0.0), (0.5, -0.3)), ((0.0, 1.0), (0.0, 0.0))])
def test_the_spin_angle_drifts_as_the_nonlinear_equations_do(torque, rates):
    """Euler's equations and the 3-1-2 kinematics (14), integrated by SciPy, minus r0 t; error of fourth order
    in 0.01."""
    from scipy.integrate import solve_ivp
    small, (A, B, C), Lam, r0 = 0.01, (8.7, 6.1, 11.1), 1.01, 0.9
    body = ChargedBody((A, B, C), r0, 1.3, 0.29, [small * x for x in torque], [small * x for x in rates],
                       (0.4 * small, -0.3 * small, 0.0))

    def rate(t, y):
        p, q, r, psi, phi, _ = y
        along = r * math.cos(phi) - p * math.sin(phi)
        return [(small * torque[0] - ((C - B) * r + Lam) * q) / A,
                (small * torque[1] + ((C - A) * r + Lam) * p) / B, (A - B) * p * q / C,
                p * math.cos(phi) + r * math.sin(phi), q - along * math.tan(psi), along / math.cos(psi)]
    t = np.linspace(0, 1200, 12001)
    y = (solve_ivp(rate, (0, 1200), [*body.rates, r0, *body.attitude], "DOP853", t, rtol=1e-11,
                   atol=1e-13).y[5] - r0 * t)
    slope = np.polyfit(t, y, 1, w=np.hanning(t.size))[0]
    assert slope == pytest.approx(float(spin_drift(body).rate), rel=1e-3)
    assert spin_drift(body).acceleration == pytest.approx(0.0, abs=1e-15)


def test_two_torques_on_unequal_moments_accelerate_the_spin():
    # mean of p q is that of the equilibrium, -(M1/D1)(M2/D2)/(ab): D3 r' = (D1 - D2) p q
    body = ChargedBody((8.7, 6.1, 11.1), 0.9, 1.3, 0.29, (0.01, 0.007), (0.003, 0.001))
    a, b = modes(body).a, modes(body).b
    wanted = (8.7 - 6.1) / 11.1 * -(0.01 / 8.7) * (0.007 / 6.1) / (a * b)
    assert spin_drift(body).acceleration == pytest.approx(wanted, rel=1e-12)


@pytest.mark.parametrize("name, word", [("r0 = 0", "r0 = 0"), ("a = 0", "omega = 0"), ("b = 0", "omega = 0"),
                                        ("X = 0", "r0 = -omega"),
                                        ("Y = 0", "r0 = omega"), ("a = -b", "unstable band")])
def test_resonances_are_named(name, word):
    met = resonances(body_of(near_resonance(name, 0.0, 1.0)))
    assert len(met) == 1 and str(met[0]).startswith(word)
    assert resonances(body_of(near_resonance("r0 = 0", 0.3, 1.0))) == ()


def test_the_meeting_of_frequencies_at_Y_0_makes_nothing_grow_and_X_0_does():
    quiet, growing = (body_of(near_resonance(n, 0.0, 1.0) | dict(M1=0.0, M2=0.0)) for n in ("Y = 0", "X = 0"))
    assert solution(quiet, 1e8).tilt < 5 and largest_tilt(quiet) < 5
    assert solution(growing,
                    1e8).tilt > 1e6 and np.isinf(largest_tilt(growing)) and np.isinf(
                        pointing(growing).momentum_error)


def test_without_a_mass_there_is_no_translation():
    motion = solution(ChargedBody((8.7, 8.6, 11.1), 0.3), 1.0)
    assert motion.velocity is None and motion.position is None and motion.because.startswith(
        "the tilt stays below")


@pytest.mark.parametrize("changes, said", [
    (dict(inertia=(8.7, 8.6)), "3 components"), (dict(inertia=(1.0, 1.0, -1.0)), "positive"),
    (dict(mass=0.0), "mass"), (dict(spin=math.nan), "finite"), (dict(torque="x"), "torque"),
    (dict(spin=[1.0, 2.0]), "one number")])
def test_impossible_bodies_are_refused_in_one_sentence(changes, said):
    with pytest.raises(InputError, match=said):
        ChargedBody(**(dict(inertia=(8.7, 8.6, 11.1), spin=0.3) | changes))


def test_questions_without_an_answer_are_refused():
    with pytest.raises(InputError, match="finite"):
        solution(typed(), [0.0, math.inf])
    with pytest.raises(InputError, match="shorter times"):
        solution(body_of(near_resonance("a = -b", 0.0, 1.0)), 1e9)
    with pytest.raises(InputError, match="need D3 above both"):
        corrected(typed(inertia=(8.7, 8.0, 8.3)), 1.0)
    with pytest.raises(InputError, match="divide by zero"):
        printed(typed(spin=0.0), 1.0)
    with pytest.raises(InputError, match="W = 0"):
        printed(typed(spin=0.0, gyrostat=0.29), 1.0)
    assert printed(typed(spin=0.0), 1.0, ["omega"]).angles is None  # (11) does not divide by r0
    with pytest.raises(InputError, match="r0 = 0"):
        circle(typed(spin=0.0), 1.0)
