"""Spectra and verdicts against NumPy, mpmath and short independent integrations."""
from __future__ import annotations

import math
from fractions import Fraction as F

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene, equilibria
from stabilab.equilibrium.stability import ROOT_BITS, eigenvalues, sign_at
from stabilab.numbers.polynomial import Poly, real_roots


def physical(D, lam, M) -> Scene:
    return Scene(Body(D), Gyrostat(lam), ConstantTorque(M))


def rates(scene):
    """x' written out here anew, for SciPy."""
    if scene.variables == "scaled":
        a, b, mu = scene.a, scene.b, scene.mu
        return lambda t, x: [x[1] * x[2] + mu[0], -x[2] * (x[0] + a) + mu[1], x[1] * (x[0] + b) + mu[2]]
    D, lam, M = (np.array([float(v) for v in u]) for u in
                 (scene.body.inertia, scene.vector("gyrostat"), scene.vector("constant_torque")))
    return lambda t, w: (np.cross(D * w + lam, w) + M) / D


def jacobian(scene, x):
    """Complex step: derivative free of cancellation."""
    f, out = rates(scene), np.empty((3, 3))
    for k in range(3):
        z = np.array(x, complex)
        z[k] += 1e-30j
        out[:, k] = np.imag(f(0.0, z)) / 1e-30
    return out


def excursion(scene, start, centre, span, limit=math.inf):
    """Largest distance from `centre` of the motion from `start` (stops at `limit`)."""
    away = lambda t, x: np.linalg.norm(np.asarray(x) - centre) - limit
    away.terminal = True
    run = solve_ivp(rates(scene), (0, span), start, method="DOP853", rtol=1e-10, atol=1e-13,
                    events=away if math.isfinite(limit) else None)
    return float(np.max(np.linalg.norm(run.y.T - centre, axis=1)))


def everything(found):
    return [*found.points, *(s for c in found.curves for s in c.samples)]


SCENES = [
    ScaledGyrostat("0.2", "0.4", (0, 0, 1)), ScaledGyrostat("0.2", "3.4", (0, 1, 0)),
    ScaledGyrostat(0, 0, (1, 0, 0)),
    ScaledGyrostat("0.2", "0.4", (1, 1, 0)), ScaledGyrostat("0.2", "0.4", (1, 1, 1)),
    ScaledGyrostat("0.2", "0.4", (0, 0, 0)),
    physical((5, 4, 2), (2, 3, 0), (0, 0, 1)), physical((5, 4, 2), (1, 2, 3), (0, 0, 0)),
    physical((2, 2, 1), (2, 1, 3), (1, -2, 0)),
    physical((3, 3, 3), (1, 2, 3), (3, 0, -1)), physical((5, 4, 2), (2, 3, 0), (0, 0, -6)),
    physical((4, 3, 2), (1, 5, 14), (0, 7, -5))]


@pytest.mark.parametrize("scene", SCENES)
def test_eigenvalues_are_those_of_the_jacobian(scene):
    """NumPy's QR eigenvalues; a nearly double root costs it half its digits, hence 1e-7."""
    for p in everything(equilibria(scene)):
        J = jacobian(scene, p.at)
        expected, size = np.linalg.eigvals(J), np.linalg.norm(J)
        for z in p.eigenvalues:
            tolerance = 1e-4 if p.linear == "degenerate" else 1e-7  # cube root of rounding at a triple zero
            assert min(abs(z - expected)) <= tolerance * size
        if p.because.startswith(("n > 0", "n < 0")):  # an isolated one: the real root has the sign of -n
            assert (min(p.eigenvalues, key=lambda z: abs(z.imag)).real > 0) == (p.because[2] == "<")


@settings(max_examples=200, deadline=None)
@given(st.integers(-10**6, 10**6), st.integers(-12, 12), st.integers(-10**6, 10**6), st.integers(-12, 12))
def test_cubic_roots_are_correct_to_the_last_digits(m0, me, n0, ne):
    """mpmath's polyroots at 80 digits; each real and imaginary part to 1 ulp."""
    import mpmath as mp
    m, n = F(m0) * F(10) ** me, F(n0) * F(10) ** ne
    found = eigenvalues(m, n)
    with mp.workdps(120):
        if not (m or n):
            expected = [mp.mpc(0)] * 3
        else:
            expected = mp.polyroots([1, 0, mp.mpf(m.numerator) / m.denominator,
                                     mp.mpf(n.numerator) / n.denominator],
                                    maxsteps=500, extraprec=400)
        for z in found:
            best = min(expected, key=lambda e: abs(e - mp.mpc(z)))
            tiny = mp.mpf(10) ** -50 * max(abs(e) for e in expected)
            for part, true in ((z.real, best.real), (z.imag, best.imag)):
                assert abs(part - true) <= 2**-52 * abs(true) + tiny


@pytest.mark.parametrize("a, b", [(1, 1), (-3, -3), (1, -2), (5, 2), (7, -7),
                                  (F(1, 3), F(1, 3) + F(1, 10**15))])
def test_three_real_roots_are_told_as_they_are(a, b):
    """(z - a)(z - b)(z + a + b); beside a double root of 1, one part in 1/h^2, a pair 1 +- h/sqrt(3) i."""
    found = eigenvalues(F(a * b - (a + b)**2), F(a * b * (a + b)))
    assert sorted(z.real for z in found) == sorted(map(float, (a, b, -a - b))) and not any(z.imag for z in found)
    for power in (20, 70, 300):
        beside = eigenvalues(F(-3), 2 + F(1, 10**power))
        assert beside[1].imag == pytest.approx(10.0 ** (-power // 2) / math.sqrt(3), rel=1e-9)


@settings(max_examples=200, deadline=None)
@given(st.fractions(max_denominator=10**6), st.fractions(max_denominator=10**6))
def test_conjugates_and_zeros_of_the_spectrum_are_exact(m, n):
    z = eigenvalues(m, n)
    if not n:
        assert z[0] == 0 and z[1] == -z[2] and (z[1].real == 0.0 or z[1].imag == 0.0)
    elif z[1].imag:
        assert z[1] == z[2].conjugate() and z[0].imag == 0.0 and z[1].real * z[0].real < 0
    assert max(v.real for v in z) > 0 or not n


@settings(max_examples=200, deadline=None)
@given(st.integers(-10**9, 10**9), st.integers(-10**4, 10**4), st.integers(0, 10**10))
def test_the_sign_at_a_root_is_that_of_the_value(p, q, d):
    """mpmath at 80 digits; d is often close to (p/q)^2, where rounding would decide wrongly."""
    import mpmath as mp
    for dd in {d, (p // q) ** 2 if q else 0, (p // q) ** 2 + 1 if q else 1}:
        with mp.workdps(80):
            value = p + q * mp.sqrt(dd)
            value = mp.mpf(0) if abs(value) < mp.mpf(10) ** -60 else value
            P = Poly((-dd, 0, 1))
            assert sign_at(Poly((p, q)), P, real_roots(P, ROOT_BITS)[-1]) == mp.sign(value)


def test_a_real_part_of_1e_18_is_still_unstable():
    """n = -mu1 c != 0 with mu1 = 1e-18: hard case of a torque a hair off the axis, beyond any tolerance."""
    (p,) = equilibria(ScaledGyrostat(0, 1, (F(1, 10**18), 0, F(1, 10)))).points
    assert p.verdict == "unstable" and max(z.real for z in p.eigenvalues) > 0
    assert p.at == (0.0, -0.1, 1e-17)


def stays(scene, at, span=60.0, seed=0):
    """Excursions for two sizes of disturbance, the largest of a few directions each."""
    rng, out = np.random.default_rng(seed), []
    for size in (1e-4, 1e-6):
        kicks = rng.normal(size=(3, 3))
        out.append(max(excursion(scene, np.array(at) + size * k / np.linalg.norm(k), np.array(at), span)
                       for k in kicks) / size)
    return out


STABLE = [SCENES[i] for i in (0, 1, 2, 6, 7, 8, 9)]


@pytest.mark.one_in(3)
@pytest.mark.parametrize("scene",
                         [*STABLE[::3], *(pytest.param(scene, marks=pytest.mark.slow) for n,
                                          scene in enumerate(STABLE) if n % 3)])
def test_neighbours_of_stable_points_stay_in_proportion(scene):
    """Excursion/disturbance stays of order one for both sizes: SciPy over 60 time units. Only samples of
    moderate size."""
    checked = 0
    for p in everything(equilibria(scene)):
        # a weak centre multiplies a disturbance by sqrt(m_fast/m_slow): compare only where the frequency is
        # of order one
        if p.verdict == p.linear == "stable" and max(map(abs, p.at)) < 10 and abs(p.eigenvalues[1]) > 0.5:
            large, fine = stays(scene, p.at)
            assert large < 100 and fine < 100
            checked += 1
    assert checked


LEFT = [  # scene, degenerate equilibrium, a motion of `span` from a disturbance of 0.01 goes further than 0.3
    (ScaledGyrostat(0, 0, (0, 0, 1)), (-1.0, 1.0, 0.0)),            # fold of the minor axis
    (ScaledGyrostat(0, 0, (1, 0, 0)), (0.0, 1.0, -1.0)),            # fold of the major axis, a = b
    (physical((5, 4, 2), (2, 3, 0), (0, 0, -6)), (-2.0, 3.0, 0.0)),  # two lines of equilibria cross
    (physical((3, 3, 2), (1, 0, 7), (0, 7, -5)), (-1.0, 5.0, 7.0)),  # fold on a line, symmetric body
    # plane of a symmetric body: drift round the circle
    (physical((2, 2, 1), (0, 0, 1), (0, 0, 0)), (1.0, 0.0, 1.0)),
    (ScaledGyrostat(0, 1, (0, 0, 0)), (-1.0, 0.0, 0.0))]             # crossing on the middle side


@pytest.mark.one_in(2)
@pytest.mark.parametrize("scene, at", LEFT)
def test_degenerate_equilibria_called_unstable_are_left(scene, at):
    (p, *_) = [s for s in everything(equilibria(scene)) if s.at == pytest.approx(at, abs=1e-15)]
    assert p.linear == "degenerate" and p.verdict == "unstable"
    rng, centre = np.random.default_rng(3), np.array(at)
    assert max(excursion(scene, centre + 0.01 * k / np.linalg.norm(k), centre, 400, limit=0.35)
               for k in rng.normal(size=(6, 3))) > 0.3


KEPT = [
    (ScaledGyrostat(0, 1, (0, 0, 0)), (0.0, 0.0, 0.0)),              # crossing on the minor side
    (ScaledGyrostat(0, 0, (0, 0, 0)), (0.0, 0.0, 0.0)),
    # two crossing lines, quartic minimum (if they cross)
    (physical((5, 4, 5), (2, 3, 0), (0, 0, 6)), None),
    (physical((5, 4, 5), (2, 3, 0), (0, 0, -6)), None),
    (physical((2, 2, 1), (0, 0, 1), (0, 0, 0)), (0.0, 0.0, 1.0)),    # spin of a symmetric body about its axis
    (physical((4, 4, 2), (1, 2, 0), (0, 0, 0)), (-0.5, -1.0, 0.0))]


@pytest.mark.parametrize("scene, at", KEPT)
def test_degenerate_equilibria_called_stable_keep_their_neighbours(scene, at):
    """A quartic well lets a disturbance d grow to about d^(1/2): 1e-4 must stay within 0.05."""
    degenerate = [s for s in everything(equilibria(scene)) if s.linear == "degenerate"
                  and s.verdict == "stable"]
    if at is not None:
        degenerate = [s for s in degenerate if s.at == pytest.approx(at, abs=1e-15)]
        assert degenerate
    rng = np.random.default_rng(4)
    for p in degenerate:
        for k in rng.normal(size=(4, 3)):
            assert excursion(scene, np.array(p.at) + 1e-4 * k / np.linalg.norm(k), np.array(p.at), 400) < 0.05


def test_crossing_lines_of_a_symmetric_body_meet_in_a_strict_minimum():
    """D1 = D3: U ~ alpha^4 with a positive factor (by hand: U'''' = -3 kappa_i kappa_k v_j^2 > 0)."""
    found = [equilibria(physical((5, 4, 5), (2, 3, 0), (0, 0, M))) for M in (6, -6)]
    (crossed,) = [f for f in found if len(f.curves) == 2]
    verdicts = {p.verdict for c in crossed.curves for p in c.samples if p.linear == "degenerate"
                and "crossing" in p.because}
    assert verdicts == {"stable"}


def test_a_line_of_equilibria_on_no_axis_is_left_by_slow_drift():
    """Three different moments: centres by their spectrum, yet X' = k r^2 for a disturbance r of omega2. By
    hand at omega1 = 0: k = (f g/2P)(Q'/Q - P'/P) with P = 1/3, P' = 2/3, Q = Q' = 1/2, f = -7/4, g = 5/2.
    SciPy measures the mean."""
    scene = physical((4, 3, 2), (1, 5, 14), (0, 7, -5))
    (curve,) = equilibria(scene).curves
    (p,) = [s for s in curve.samples if s.at == (0.0, 5.0, 7.0)]
    assert p.linear == "stable" and p.verdict == "unstable"
    k = (-7 / 4) * (5 / 2) / (2 / 3) * (1 - 2)
    for size in (1e-3, 2e-3):
        run = solve_ivp(rates(scene), (0, 400), np.array(p.at) + [0, size, 0], method="DOP853", rtol=1e-11,
                        atol=1e-14,
                        dense_output=True)
        period = 2 * math.pi / math.sqrt(1 / 6)
        early, late = (np.mean(run.sol(np.linspace(t, t + period, 4001)[:-1])[0]) for t in (0, 20 * period))
        # next order: k varies along the way
        assert (late - early) / (20 * period * size**2) == pytest.approx(k, rel=0.1)


def test_the_zero_hopf_fold_is_unstable_though_its_linear_motion_is_a_centre():
    scene = ScaledGyrostat(0, 2, (-3, 3, 1))  # c^2 + 4 mu2 mu3/mu1 = 0
    (p,) = equilibria(scene).points
    assert p.linear == "stable" and p.verdict == "unstable" and p.eigenvalues[0] == 0 and p.eigenvalues[
        1].real == 0.0
    values, vectors = np.linalg.eig(jacobian(scene, p.at))
    axis = np.real(vectors[:, int(np.argmin(abs(values)))])
    axis /= np.linalg.norm(axis)
    at = np.array(p.at)
    assert max(excursion(scene, at + s * 0.02 * axis, at, 2000, limit=0.3) for s in (1, -1)) > 0.29


# fold with m = 0: c^2 = -4 mu2 mu3/mu1 and m = 4 (mu2^2 - mu3^2)/c^2 - c^2/4 = 0 by hand: c = 2, mu2^2 -
# mu3^2 = 1
TRIPLE_ZERO = [
    (ScaledGyrostat(0, 2, (F(-15, 16), F(5, 4), F(3, 4))), (-1.0, -0.75, -1.25)),
    # a line of equilibria along omega1 on no axis: m = P Q, P = (1 + 2 omega1)/3 and Q = (1 + omega1)/2 by
    # hand
    (physical((4, 3, 2), (1, 5, 14), (0, 7, -5)), (-1.0, 5.0, 7.0)),
    (physical((4, 3, 2), (1, 5, 14), (0, 7, -5)), (-0.5, 5.0, 7.0))]


@pytest.mark.one_in(3)
@pytest.mark.parametrize("scene, at", TRIPLE_ZERO)
def test_a_triple_zero_eigenvalue_off_the_axes_is_unstable(scene, at):
    """SciPy: from ever nearer starts (t ~ r^(-1/3) or r^(-1/2) by the leading terms) the motion goes out to
    the same distance."""
    found = equilibria(scene)
    (p,) = {(s.linear, s.verdict, s.eigenvalues) for s in everything(found) if s.at == at}
    assert p == ("degenerate", "unstable", (0j, 0j, 0j))
    rng = np.random.default_rng(5)
    for size in (1e-3, 1e-5):
        starts = rng.normal(size=(3, 3))
        reached = [excursion(scene, np.array(at) + size * k / np.linalg.norm(k), np.array(at), 60 / size**0.5,
                             limit=0.1) for k in starts]
        assert max(reached) > 0.099, (size, reached)


def test_free_rotation_is_stable_about_the_major_and_minor_axes_only():
    """Euler 1758; at rest the energy is definite."""
    for curve in equilibria(Scene(Body((2, 3, 4)))).curves:
        words = {s.verdict for s in curve.samples if any(s.at)}
        assert words == ({"unstable"} if "omega2" in curve.name else {"stable"})
        assert [s.verdict for s in curve.samples if not any(s.at)] == ["stable"]


@pytest.mark.parametrize("lam", [(1, 2, 3), (1, 0, 0), (0, 2, 3)])
def test_a_gyrostat_at_rest_is_stable(lam):
    """The energy is definite there."""
    curve = equilibria(physical((5, 4, 2), lam, (0, 0, 0))).curves[0]
    assert curve.point(0.0) == (0.0, 0.0, 0.0)
    (around,) = [g for g in curve.segments if g.t[0] < 0 < g.t[1]]
    assert around.linear == around.verdict == "stable"
