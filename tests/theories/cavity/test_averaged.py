"""Averaged motion of a body with a liquid: the derived equations, observed orders, passages, attractors, the
printed polynomials."""
import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene, load, trajectory
from stabilab.errors import InputError
from stabilab.physics.effects.charge import Charge
from stabilab.physics.effects.gravity import Gravity
from stabilab.physics.effects.liquid_cavity import LiquidCavity
from stabilab.physics.effects.resistance import Resistance
from stabilab.theories import cavity as averaging
from stabilab.theories.cavity import averaged, printed
from stabilab.theories.cavity_normal_form import NAMES, attractors, constants, normal_form

CASES = Path(__file__).parents[3] / "cases"
J0 = 9.0


def body(e, d=4.0, split=3.0, g=-10.0, kappa=10.0, zeta=2.0, M=(1.0, -0.5, -6.0), law="consistent"):
    """A scene whose smallness is e in the sense of the paper's (4)-(6), with D1 - D2 = 2 e^2 split."""
    return Scene(Body((J0 + e * d + e * e * split, J0 + e * d - e * e * split, J0)), Gyrostat((0, 0, e * g)),
                 LiquidCavity(1, 1, e * kappa, law), Resistance(e * e * zeta),
                 ConstantTorque(tuple(e * e * m for m in M)))


def rates_by_hand(scene):
    """Exact rates from equations written here: share no code with the package's derivation.

    D w' + w x (D w + G e3) = kappa (w0'' + w x w0') - c D w + M with w0' = D^-1 [(D w + G e3) x w], w0'' its
    derivative along itself.
    """
    D, G = np.array(scene.body.inertia), scene.effect("gyrostat").moment[2]
    liquid, M = scene.effect("liquid_cavity"), np.array(scene.effect("constant_torque").vector)
    kappa, c = liquid.density * liquid.P0 / liquid.viscosity, scene.effect("resistance").coefficient
    D1, D2, D3 = D

    def free(p, q, r):
        return ((D2 - D3) * r - G) * q / D1, ((D3 - D1) * r + G) * p / D2, (D1 - D2) * p * q / D3

    def rates(t, w):
        p, q, r = map(float, w)
        a, b, s = free(p, q, r)
        second = ((((D2 - D3) * r - G) * b + (D2 - D3) * s * q) / D1,
                  (((D3 - D1) * r + G) * a + (D3 - D1) * s * p) / D2,
                  (D1 - D2) * (a * q + p * b) / D3)
        u, v, w3 = second[0] + q * s - r * b, second[1] + r * a - p * s, second[2] + p * b - q * a
        return [a + (kappa * u + M[0]) / D1 - c * p, b + (kappa * v + M[1]) / D2 - c * q,
                s + (kappa * w3 + M[2]) / D3 - c * r]

    return rates


def by_hand(scene, state, times, rtol=1e-11):
    """Exact motion at times (n,) from `rates_by_hand`, by SciPy: shares no code with the package's
    integrators either."""
    run = solve_ivp(rates_by_hand(scene), (0, times[-1]), state, "DOP853", t_eval=times, rtol=rtol,
                    atol=1e-14)
    assert run.success
    return run.y.T


def errors(e, order, span, phases=(0.3, 1.9, 3.4, 5.0), **numbers):
    """Largest errors in A, r, phase over tau in [0, span(e)/e...], for starts A = r = 1 at several phases."""
    scene, t = body(e, **numbers), np.linspace(0, span(e), 60)
    worst = np.zeros(3)
    for phase in phases:
        state = (math.cos(phase), -math.sin(phase), 1.0)
        exact, answer = _exact(e, span, phase,
                               tuple(sorted(numbers.items()))), averaged(scene, state, t, order=order)
        assert answer.status == "reached" and answer.t == pytest.approx(t)
        Z, X = (w[:, 0] - 1j * w[:, 1] for w in (answer.omega, exact))
        found = np.abs(np.abs(Z)
                       - np.abs(X)).max(), np.abs(answer.omega[:, 2]
                                                  - exact[:, 2]).max(), np.abs(
                                                      np.unwrap(np.angle(Z / X))).max()
        worst = np.maximum(worst, found)
    return worst


@cache
def _exact(e, span, phase, numbers):
    return by_hand(body(e, **dict(numbers)), (math.cos(phase), -math.sin(phase), 1.0),
                   np.linspace(0, span(e), 60))


def slopes(order, span, sizes=(0.02, 0.01, 0.005), **numbers):
    """Observed orders in A, r, phase: least-squares slope of log error against log e."""
    table = np.log([errors(e, order, span, **numbers) for e in sizes])
    return np.polyfit(np.log(sizes), table, 1)[0]


def one(e):
    """tau = e t up to 1."""
    return 1 / e


def long(e):
    """tau = e t up to 1/e, the time of the slow change."""
    return 1 / e**2


# --- the derived equations

def full_scene():
    return Scene(Body(("9.51", "9.3", "9")), Gyrostat((0, 0, "0.1")), Charge("0.01", 100, "0.01", "0.3"),
                 LiquidCavity(1250, 1000, "1.9"), Resistance("0.02"), ConstantTorque((0, 0, "-0.06")))


def test_first_order_is_the_known_one():
    # Averaging (3) by hand with the consistent liquid torque, in t: A' = A [kappa r (d r - Gamma)/J0^2 -
    # zeta],
    # r' = -kappa A^2 (d r - Gamma)/J0^2 - zeta r + M3/J0, phi' = (d r - Gamma)/J0 to leading order. In tau =
    # e t that is
    # e J0 L r (d r - g) with L = kappa/(e J0^3): the liquid comes with one e, as resistance and torque do.
    form = normal_form(full_scene())
    J, d, h, G, kappa, zeta, M1, M2, M3 = form.symbols
    r, S = form.variables[2], sp.Symbol("S", real=True)
    assert sp.expand(sp.re(sp.expand(form.turn[0])) - (kappa * r * (d * r - G) / J**2 - zeta)) == 0
    assert sp.expand(form.spin[0] - (-kappa * S * (d * r - G) / J**2 - zeta * r + M3 / J)) == 0
    assert sp.expand(form.frequency - (d * r - G) / J) == 0
    # the paper's (21), D1' = D2': phi' = nu (1 - (D1' + D2')/(2 J0))
    assert sp.expand(sp.im(sp.expand(form.turn[0])) + d / J * form.frequency) == 0


def test_first_order_of_the_printed_torque_is_the_papers_but_for_a_factor():
    # (18), (17) averaged by hand for D1' = D2' = d: a' = kappa a r^2 d/J0^2 - zeta a, r' = -kappa r a^2
    # d/J0^2 - ...;
    # the extra term of (20) vanishes with D1' - D2', so nothing of its missing a^2/2 is left.
    full = full_scene()
    scene = Scene(full.body,
                  *(LiquidCavity(1250, 1000, "1.9", "printed") if x.name == "liquid_cavity" else x
                    for x in full.effects))
    form = normal_form(scene)
    J, d, h, G, kappa, zeta, *M = form.symbols
    r, S = form.variables[2], sp.Symbol("S", real=True)
    assert sp.expand(sp.re(sp.expand(form.turn[0])) - (kappa * d * r**2 / J**2 - zeta)) == 0
    assert sp.expand(form.spin[0] - (-kappa * S * d * r / J**2 - zeta * r + M[2] / J)) == 0


def test_two_orders_of_the_symmetric_body_leave_the_fourth_power():
    # At D1 = D2, M1 = M2 = 0 nothing depends on the phase, so the exact A', r' (equations by hand) are the
    # averaged ones:
    # what two orders leave out must be of order e^4 in t (X0, Y1, Y2 are e, e^2, e^3).
    sizes, left = (0.04, 0.02, 0.01), []
    for e in sizes:
        scene, A, r = body(e, split=0.0, M=(0, 0, -6.0)), 0.7, 1.3
        form, numbers = normal_form(scene), [float(constants(scene)[n]) for n in NAMES]
        put = dict(zip(form.symbols, numbers)) | {form.variables[2]: r, sp.Symbol("S", real=True): A * A}
        exact = rates_by_hand(scene)(0, (A, 0.0, r))
        left.append([abs(A * complex(sum(form.turn).subs(put)).real - exact[0]),
                     abs(complex(sum(form.spin).subs(put)).real - exact[2])])
    assert np.polyfit(np.log(sizes), np.log(left), 1)[0] == pytest.approx([4, 4], abs=0.2)


def test_the_change_of_variables_and_the_means_belong_together(monkeypatch):
    # Away from nu = 0 the derived U, Y must satisfy F(y + U) = (1 + DU) Y up to e^3 terms that average out
    # over the
    # phase, so the phase average of the rest is of order e^4 in t. F is written by hand; DU Y is taken by
    # differences.
    monkeypatch.setattr(averaging, "SHARE", 1e-3)
    monkeypatch.setattr(averaging, "GUARD", 0.0)
    sizes, left = (0.01, 0.005, 0.0025), []
    for e in sizes:
        scene, A, r, step = body(e, d=2.0, split=12.0, g=-4.0, kappa=2.0, zeta=0.2,
                                 M=(6.0, -4.0, -3.0)), 0.8, 1.2, 1e-4
        numbers, exact = constants(scene), rates_by_hand(scene)
        model = averaging._Model(scene, numbers, np.array([A, 0, r]), 2)
        nu = model.slope * r - model.offset
        turn, spin = model.means(A * A, r, *model.removal(nu), *model.parameters)
        rest = []
        for unit in np.exp(2j * math.pi * np.arange(16) / 16):
            Y = A * unit * (1j * nu + turn), spin
            omega, ahead, behind = (model.outward(np.array([A * unit + s * Y[0]]),
                                                  np.array([r + s * spin]))[0] for s in (0, step, -step))
            gap = np.array(exact(0, omega)) - (ahead - behind) / (2 * step)
            rest.append([(gap[0] - 1j * gap[1]) / unit, gap[2]])
        left.append(np.abs(np.mean(rest, axis=0)))
    assert np.polyfit(np.log(sizes), np.log(left), 1)[0] == pytest.approx([4, 4], abs=0.2)


@pytest.mark.parametrize("change, words", [
    (lambda: ScaledGyrostat(0.2, 0.4, (0, 0, 1)), "physical scene"),
    (lambda: Scene(Body((9.2, 9.1, 9)), Charge(0.01, 100, 0.01, "attitude")), "constant angle"),
    (lambda: Scene(Body((9.2, 9.1, 9)), Gravity(10, (0, 0, 1))), "gravity"),
    (lambda: Scene(Body((9.2, 9.1, 9)), Gyrostat((0.1, 0, 1))), "along axis 3"),
    (lambda: Scene(Body((9.2, 9.1, 9)), Resistance(0.01), ConstantTorque((0, 0, 50))), None),
    (lambda: Scene(Body((9.2, 9.1, 9)), ConstantTorque((50, 0, 0))), "torque"),
    (lambda: Scene(Body((18, 10, 9))), "D3"),
    (lambda: Scene(Body((9.5, 8.5, 9))), "splitting"),
    (lambda: Scene(Body((9.2, 9.1, 9)), LiquidCavity(1250, 0.01, 1.9)), "liquid"),
])
def test_a_scene_outside_the_assumptions_is_refused_with_the_reason(change, words):
    if words is None:  # a large torque balanced by resistance at a fast spin is within them
        assert averaged(change(), (1, 0, 1), [1.0]).status == "reached"
        return
    with pytest.raises(InputError, match=words):
        averaged(change(), (1, 0, 1), [1.0])


@pytest.mark.parametrize("state, times, order",
                         [((1, 0), [1.0], 1), ((1, 0, math.nan), [1.0], 1), ((1, 0, 1), [], 1),
                          ((1, 0, 1), [1.0], 3)])
def test_bad_requests_are_refused(state, times, order):
    with pytest.raises(InputError):
        averaged(full_scene(), state, times, order=order)


# --- observed orders


def test_orders_over_one_unit_of_slow_time():
    assert slopes(1, one) == pytest.approx([1, 1, 1], abs=0.2)
    assert slopes(2, one) == pytest.approx([2, 2, 2], abs=0.2)


@pytest.mark.slow
def test_orders_over_the_time_of_the_slow_change():
    # an error e^k in r turns into a phase error e^k (1/e): one order less
    assert slopes(1, long) == pytest.approx([1, 1, 0], abs=0.2)
    assert slopes(2, long) == pytest.approx([2, 2, 1], abs=0.2)


PASSAGE = {"g": 2.0, "M": (1.0, -0.5, -6.0), "split": 2.0}


@pytest.mark.slow
def test_orders_through_zero_frequency():
    # r falls from 1 through d r = g (r = 1/2), where M1, M2 and D1 - D2 push in step: a jump of sqrt(e) that
    # depends on the
    # phase there. First order knows no phase: nominal 1/2. Second order has it to order e: nominal 1 + 1/2.
    fall = _exact(0.005, long, 0.0, tuple(sorted(PASSAGE.items())))
    assert fall[0, 2] == 1 and fall[-1, 2] < 0.4
    phases = tuple(k * math.pi / 4 for k in range(8))
    assert slopes(1, long, (0.01, 0.005, 0.0025), phases=phases,
                  **PASSAGE)[:2] == pytest.approx([0.5, 0.5], abs=0.2)
    assert slopes(2, long, (0.01, 0.005, 0.0025), phases=phases,
                  **PASSAGE)[:2] == pytest.approx([1.5, 1.5], abs=0.2)


# --- regular where polar coordinates are not

@pytest.mark.parametrize("state", [(0, 0, 1), (0, 0, -1), (1, 0.3, -1), (0, 0, 0), (1, 0, 0.5)], ids=str)
def test_amplitude_zero_negative_spin_rest_and_resonance_are_regular(state):
    # (1, 0, 0.5) starts on d r = g of this scene; the bound is the second order of the test above with a
    # factor of 100
    numbers = {"g": 2.0, "split": 1.0}
    e, t = 0.01, np.linspace(0, 100, 11)
    answer = averaged(body(e, **numbers), state, t, order=2)
    assert answer.status == "reached" and all(np.isfinite(x).all()
                                              for x in (answer.omega, answer.phase, answer.amplitude))
    assert answer.omega == pytest.approx(by_hand(body(e, **numbers), state, t), abs=100 * e**2 / 9)


def test_spin_without_amplitude_stays_exactly_on_the_axis():
    # M1 = M2 = 0: r' = -c r + M3/J0 exactly (the liquid turns with the body), r = r* + (r0 - r*) exp(-c t)
    e, t = 0.1, np.linspace(0, 100, 7)
    scene = body(e, M=(0, 0, -6.0))
    c, end = e * e * 2.0, -6.0 / (2.0 * J0)
    for order in (1, 2):
        answer = averaged(scene, (0, 0, 1), t, order=order)
        assert (answer.amplitude == 0).all() and (answer.omega[:, :2] == 0).all()
        assert answer.spin == pytest.approx(end + (1 - end) * np.exp(-c * t), rel=1e-9)


def test_the_motion_depends_neither_on_the_form_of_the_state_nor_on_the_order_of_the_times():
    scene, t = body(0.05), np.array([40.0, -10.0, 0.0, 3.0])
    for order in (1, 2):
        one_way, other = (averaged(scene, state, t, order=order)
                          for state in ((1, 0.2, 1), {"omega": (1, 0.2, 1)}))
        assert (one_way.omega == other.omega).all()
        back = averaged(scene, (1, 0.2, 1), np.sort(t), order=order)
        assert one_way.omega[np.argsort(t)] == pytest.approx(back.omega, rel=1e-12)
        assert one_way.omega[2] == pytest.approx((1, 0.2, 1), abs=1e-13)  # the given state at t = 0


def test_eps_is_the_largest_departure_of_a_moment():
    assert averaged(full_scene(), (1, 0, 1), [1.0]).eps == pytest.approx(0.51 / 9, rel=1e-15)


def test_first_order_says_that_it_leaves_a_torque_across_a_ball_out():
    """With no turn the rates of a ball under M are those of omega' = M/J - c omega, in closed form: first
    order misses them."""
    scene, t = Scene(Body((5, 5, 5)), Resistance("0.1"), ConstantTorque(("0.1", "0.2", "0.3"))), 10.0
    true = 0.2 * (1 - math.exp(-1.0))
    first, second = (averaged(scene, (0, 0, 1), [t], order=order) for order in (1, 2))
    assert abs(first.omega[0, 0]
               - true) > 0.1 and "doubtful" in str(first.horizon) and "left out in first order" in str(first.horizon)
    assert second.omega[0, 0] == pytest.approx(true, abs=1e-9) and "doubtful" not in str(second.horizon)
    assert "doubtful" not in averaged(body(0.05), (1, 0.2, 1), [1.0]).horizon.text()


# --- where the motion ends

@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", ["base", "lambda3-15", "torque-9"])
def test_exact_motions_end_on_the_attracting_spin_at_its_rate(name):
    case = load(CASES / f"liquid-{name}.toml")
    found = attractors(case.scene)
    (spin,) = found.attracting
    M3, c = case.scene.effect("constant_torque").vector[2], case.scene.effect("resistance").coefficient
    assert spin.amplitude == 0 and spin.spin == pytest.approx(M3 / (9 * c), rel=1e-15)
    run = trajectory(case.scene, case.state, [300.0, 400.0, 1500.0]).states
    assert run[-1] == pytest.approx((0, 0, spin.spin), abs=1e-9)
    rate = math.log((run[1, 2] - spin.spin) / (run[0, 2] - spin.spin)) / 100
    assert rate == pytest.approx(spin.rates[1].real, rel=0.02)
    # the decay of A: eigenvalues of the exact Jacobian there, by differences of the equations written here
    if name == "base":
        scene = Scene(case.scene.body, Gyrostat((0, 0, 0.1 - case.scene.effect("charge").strength)),
                      *(x for x in case.scene.effects if x.name not in ("gyrostat", "charge")))
        f, at = rates_by_hand(scene), np.array([0, 0, spin.spin])
        J = np.array([(np.array(f(0, at + h)) - f(0, at - h)) / 2e-6 for h in 1e-6 * np.eye(3)]).T
        mean = np.linalg.eigvals(J[:2, :2]).real.mean()  # D1 != D2 splits nothing of the mean
        assert spin.rates[0].real == pytest.approx(mean, rel=2 * (0.405 / 9) ** 2 * 10)


def test_a_fed_precession_attracts_the_exact_motion():
    # kappa large enough that the spin M3/(zeta J0) cannot last: the motion goes to A > 0
    scene = body(0.02, split=0.0, g=1.0, kappa=30.0, M=(0, 0, 60.0))
    found = attractors(scene)
    assert sorted(p.kind for p in found.points) == ["attracting", "saddle"]
    (end,) = found.attracting
    run = by_hand(scene, (0.5, 0, 2.0), np.array([10000.0, 12000.0]))
    assert np.hypot(run[:, 0], run[:, 1]) == pytest.approx([end.amplitude] * 2, rel=1e-3)
    assert run[:, 2] == pytest.approx([end.spin] * 2, rel=1e-3)


def test_without_torque_and_resistance_there_are_families_not_points():
    found = attractors(body(0.05, zeta=0.0, g=1.0, M=(0, 0, 0)))
    assert not found.points and len(found.families) == 2
    every, stands = map(str, found.families)
    assert "any r" in every and "r = 0.25 rad/s and any A" in stands and "comes back" in stands
    none = attractors(body(0.05, zeta=0.0, g=0.0, M=(0, 0, 6.0)))
    assert not none.points and not none.families and "no resistance to balance it" in none.because


# --- the printed polynomials

def test_printed_polynomials_are_the_taylor_polynomials_of_the_printed_averages():
    # (20)-(22) typed here and differentiated by SymPy along themselves; (24)-(26) typed in the package.
    scene, (a, r, phi) = full_scene(), sp.symbols("a r phi")
    n = {k: sp.Float(float(v), 30) for k, v in constants(scene).items()}
    J, g, zeta, M3 = n["J0"], n["Gamma"], n["zeta"], n["M3"]
    d1, d2, L = n["d"] + n["h"], n["d"] - n["h"], n["kappa"] / n["J0"] ** 3
    ratio = (d1 * r - g) / (d2 * r - g)
    rate = (L * a * (r**2 / 2 * (J * (d1 + d2) + (d1 - d2) ** 2)
                     + (d1 - d2) / 4 * ((J + d1 + 2 * d2) * ratio - (J + 2 * d1 + d2))) - zeta * a,
            -L * r * a**2 / 2 * (d2 * (J + 2 * d2 - d1) * ratio + d1 * (J + 2 * d1 - d2))
            - (zeta * r - M3 / J),
            sp.sqrt((d1 * r - g) * (d2 * r - g)) / J * (1 - (d1 + d2) / (2 * J)))
    second = [f.diff(a) * rate[0] + f.diff(r) * rate[1] for f in rate]
    at, t = {a: 1, r: 1, phi: 0}, np.array([0.5, 4.0, 17.0])
    expected = [float(x0) + float(f.subs(at)) * t + float(s.subs(at)) * t**2 / 2 for x0, f,
                s in zip((1, 1, 0), rate, second)]
    answer = printed(scene, (1, 0, 1), t)
    assert np.array([answer.amplitude, answer.spin,
                     answer.phase]) == pytest.approx(np.array(expected), rel=1e-12)


def test_printed_solution_ends_where_it_has_no_real_value():
    case = load(CASES / "liquid-lambda3-0_2.toml")
    answer = printed(case.scene, case.state, np.linspace(0, 20, 201))
    assert answer.status == "stopped" and "no real value" in answer.because and np.isfinite(answer.omega).all()
    with pytest.raises(InputError, match="does not exist"):
        printed(case.scene, (1, 0, 0.5), [1.0])  # d2 r < lambda3 < d1 r
    with pytest.raises(InputError):
        printed(case.scene, case.state, [2.0, 1.0])


@pytest.mark.one_in(3)
@pytest.mark.parametrize("path", sorted(CASES.glob("liquid-*.toml")), ids=lambda p: p.stem)
def test_every_liquid_case_runs_in_every_model(path):
    case = load(path)
    t = np.linspace(0, 20, 5)
    exact = trajectory(case.scene, case.state, t)
    assert exact.status == "reached" and max(exact.invariant_drift.values()) < 1e-11
    try:
        answer = averaged(case.scene, case.state, t, order=2)
    except InputError as error:  # e = 1e4: the liquid's torque is no small one
        assert path.stem == "liquid-charge-1e4" and "liquid" in str(error)
        return
    assert answer.status == "reached" and np.isfinite(answer.omega).all()
    assert case.scene.effect("liquid_cavity").law == "consistent"


def test_the_sensible_cavity_fits_in_the_body():
    case = load(CASES / "liquid-sensible.toml")
    liquid = case.scene.effect("liquid_cavity")
    radius = (liquid.P0 * 525 / (8 * math.pi)) ** (1 / 7)
    mass = 4 / 3 * math.pi * radius**3 * liquid.density
    assert radius == pytest.approx(0.2,
                                   rel=1e-12) and 0.4 * mass * radius**2 < 0.1 * min(case.scene.body.inertia)
    # Reynolds number: small, as the torque demands
    assert radius**2 * np.linalg.norm(case.state) / liquid.viscosity < 0.25
    answer = averaged(case.scene, case.state, [1e4], order=2)
    exact = trajectory(case.scene, case.state, [1e4]).states[0]
    assert np.hypot(*answer.omega[0, :2]) == pytest.approx(np.hypot(*exact[:2]), rel=0.02)
    assert answer.omega[0, 2] == pytest.approx(exact[2], rel=0.001)
