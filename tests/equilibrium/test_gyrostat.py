"""Equilibria in the cases of the theory, and to the last digit where numbers nearly meet; that none is missed
or wrong is held on random scenes (`test_random_scenes`)."""
from __future__ import annotations

import math
from fractions import Fraction as F

import pytest

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene, equilibria
from stabilab.errors import InputError
from stabilab.reasons import decimal


def physical(D, lam, M) -> Scene:
    return Scene(Body(D), Gyrostat(lam), ConstantTorque(M))


# D, lambda, M: hyperbola, lines that cross, one line, oblique torque on a symmetric body, torque-free
CURVED = [
    ((2000, 1500, 1000), (100, 0, 0), (0, 0, 204)), ((5, 4, 2), (2, 3, 0), (0, 0, -6)),
    ((5, 4, 2), (2, 3, 0), (0, 0, 6)),
    ((5, 4, 5), (2, 3, 0), (0, 0, -6)), ((2, 2, 1), (1, 2, 0), (0, 0, 1)), ((2, 2, 1), (2, 1, 3), (1, -2, 0)),
    ((3, 3, 3), (1, 2, 3), (3, 0, -1)), ((5, 4, 2), (1, 2, 3), (0, 0, 0)), ((5, 4, 2), (1, 0, 3), (0, 0, 0)),
    ((5, 4, 2), (0, 1, 0), (0, 0, 0)), ((4, 4, 2), (1, 2, 3), (0, 0, 0)), ((4, 4, 2), (1, 2, 0), (0, 0, 0)),
    ((5, 4, 2), (0, 0, 0), (0, 0, 0)), ((3, 3, 3), (1, 2, 3), (0, 0, 0)), ((5, 4, 2), (0, 1, 2), (3, 0, 0))]


def test_coordinates_are_correct_to_the_last_digit_for_nearly_equal_moments():
    """Against 60-digit roots of the same conditions (mpmath), D1 - D2 = 1e-12 D1 and a torque off the axes.
    """
    import mpmath as mp
    with mp.workdps(60):
        D = [mp.mpf(1), 1 - mp.mpf(10) ** -12, mp.mpf(1) / 2]
        lam, M = [mp.mpf(1), mp.mpf(2), mp.mpf(-1)], [mp.mpf(3) / 7, mp.mpf(-2) / 3, mp.mpf(1)]
        w = lambda s: rotated(D, lam, M, s)
        f = lambda s: w(s)[1]
        c, a1, b1 = f(mp.mpf(0)), f(mp.mpf(1)), f(mp.mpf(-1))
        A, B = (a1 + b1) / 2 - c, (a1 - b1) / 2
        disc = B * B - 4 * A * c
        expected = (sorted(tuple(map(float, w((-B + s * mp.sqrt(disc)) / (2 * A))[0])) for s in (1, -1))
                    if disc >= 0 else [])
    scene = physical(("1", 1 - F(1, 10**12), "1/2"), (1, 2, -1), (F(3, 7), F(-2, 3), 1))
    assert [p.at for p in equilibria(scene).points] == expected


def rotated(D, lam, M, s):
    """(omega, remaining condition) at parameter s of the line M.omega = 0 = M.(D omega + lambda), plain
    mpmath algebra."""
    import mpmath as mp
    solve = mp.matrix([[M[0], M[1]], [D[0] * M[0], D[1] * M[1]]])
    right = mp.matrix([-M[2] * s, -sum(l * m for l, m in zip(lam, M)) - D[2] * M[2] * s])
    x = mp.lu_solve(solve, right)
    omega = [x[0], x[1], s]
    H = [d * v + l for d, v, l in zip(D, omega, lam)]
    return omega, H[0] * omega[1] - H[1] * omega[0] + M[2]


def test_torque_a_billionth_off_the_axis_has_its_isolated_equilibrium_far_away():
    """mu2 = 0: (-a, -mu3/c, mu1 c/mu3) by hand from the two linear conditions, here with c = 1e-8."""
    found = equilibria(ScaledGyrostat("0.2", "0.20000001", ("1e-9", 0, 1)))
    (point,) = found.points
    assert point.at == (-0.2, -1e8, 1e-17) and point.verdict == "unstable"


def test_large_gyrostats_with_a_small_difference_keep_every_digit():
    """x1 = -(a+b)/2 +- sqrt(c^2/4 + p), p = mu2 mu3/mu1 = 2, c = 1, by hand: roots -b+2 and -b-1."""
    found = equilibria(ScaledGyrostat(10**8, 10**8 + 1, (1, 2, 1)))
    assert [p.at[0] for p in found.points] == [-(1e8 + 2), -(1e8 - 1)]


@pytest.mark.parametrize("scale", (F(10) ** -12, F(10) ** -3, F(1), F(10) ** 12))
def test_folds_of_the_minor_axis_lie_on_the_fold_circle(scale):
    """h^4 - c h - 1 = 0 and A^2 = h^2 + h^6 (theory) for mu3 = 1; mu3 = scale^2 stretches both by scale."""
    c = F(1, 5)
    (curve,) = equilibria(ScaledGyrostat(scale * F(3, 10), scale * (F(3, 10) + c), (0, 0, scale**2))).curves
    assert len(curve.folds) == 2
    for x1, x2, x3 in curve.folds:
        h, X = x2 / float(scale), x1 / float(scale) + 0.3
        assert x3 == 0 and h**4 - 0.2 * h - 1 == pytest.approx(0, abs=4e-15)
        assert X * X + h * h == pytest.approx(h**2 + h**6, rel=1e-14)


@pytest.mark.parametrize("c, count", [(0, 0), (F("1.7547653505"), 0), (F("1.7547653507"), 2),
                                      (F("-1.7547653507"), 2), (9, 2)])
def test_the_middle_axis_has_folds_only_beyond_the_cusp(c, count):
    """|c| > 4 3^(-3/4) = 1.75476535060... (theory)."""
    (curve,) = equilibria(ScaledGyrostat(0, c, (0, 1, 0))).curves
    assert len(curve.folds) == count


def test_the_middle_axis_folds_are_the_roots_of_their_quartic():
    """g^4 + c g + 1 = 0 (theory) solved by mpmath."""
    import mpmath as mp
    (curve,) = equilibria(ScaledGyrostat(0, "1.76", (0, 1, 0))).curves
    with mp.workdps(50):
        roots = sorted(float(r.real)
                       for r in mp.polyroots([1, 0, 0, mp.mpf("1.76"), 1], maxsteps=200, extraprec=200)
                       if abs(r.imag) < mp.mpf(10) ** -30)
    assert [f[2] for f in curve.folds] == roots


def test_a_free_sphere_is_in_equilibrium_everywhere_and_a_free_symmetric_body_on_a_plane_and_an_axis():
    assert equilibria(Scene(Body((3, 3, 3)))).kind == "all"
    names = [c.name for c in equilibria(physical((2, 2, 1), (0, 0, 1), (0, 0, 0))).curves]
    assert names == ["line along the gyrostatic moment", "plane omega3 = 1"]


def test_torque_along_the_symmetry_axis_cannot_be_balanced():
    found = equilibria(physical((2, 2, 1), (0, 0, 0), (0, 0, 1)))
    assert found.kind == "none" and "nothing balances" in found.because


def test_curve_points_are_refused_at_a_pole():
    (curve,) = equilibria(ScaledGyrostat(0, 0, (0, 0, 1))).curves
    for t in (0.0, math.inf, math.nan):
        with pytest.raises(InputError):
            curve.point(t)


@pytest.mark.parametrize("inertia, momentum, words", [
    # rest is stable by the energy, its neighbours in the plane turn away
    ("3, 3, 2", "0, 0, 0", "plane ω3 = 0 (unstable but at single points)"),
    ("3, 3, 2", "0, 0, 1", "plane ω3 = 57.2958 deg/s (unstable but at single points)")])
def test_words_of_a_curve_leave_out_the_points_that_do_otherwise(stabilab, tmp_path, inertia, momentum,
                                                                 words):
    path = tmp_path / "round.toml"
    path.write_text(f"[body]\ninertia = [{inertia}]\n[effects.gyrostat]\nmomentum = [{momentum}]\n")
    assert words in stabilab("classify", path)[1]


def test_a_discriminant_beyond_the_doubles_is_still_told():
    u = F(10) ** 60
    scene = Scene(Body((4, 2, 3)), Gyrostat((-u * 3 / 10, 4 * u, 2 * u)),
                  ConstantTorque((-u * u, 2 * u * u, -4 * u * u)))
    assert stabilab.equilibria(scene).kind == "none"  # law: as for u = 1
    assert decimal(F(10) ** 400 * F(-2,
                                    3)) == "-6.66667e+399" and decimal(F(10) ** -400 / 7) == "1.42857e-401"
