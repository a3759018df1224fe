"""Equilibria on a circular orbit: how many, where, and how stable."""
from fractions import Fraction
from math import pi, sqrt

import numpy as np
import pytest
import sympy

from stabilab.equilibrium.circular_orbit import orbit_equilibria, yaw_pitch_roll
from stabilab.physics.circular_orbit import Satellite
from tests.equilibrium.orbit import newton


def satellite(moments, momentum, rate_squared=1):
    return Satellite(tuple(map(Fraction, moments)), tuple(map(Fraction, momentum)), Fraction(rate_squared))


def random_satellite(seed):
    """Moments of a possible body, momenta of up to five times those at which the number changes."""
    rng = np.random.default_rng(seed)
    x, y, z = (Fraction(int(v), 1000) for v in rng.integers(50, 1000, 3))
    size = 5 * 10.0 ** rng.uniform(-2, 0)
    momentum = [Fraction(int(v), 10**6) for v in 1e6 * size * rng.normal(size=3)]
    for axis in range(3):
        if seed % 4 == axis:  # some wheels in a principal plane
            momentum[axis] = Fraction(0)
    return satellite((y + z, z + x, x + y), momentum)


def frames(points):
    return np.array([(one.velocity, one.normal, one.vertical) for one in points])


def agrees(one):
    """Count, places, and eigenvalues as Newton's method and differences find them."""
    moments, momentum = ([float(v) for v in row] for row in (one.moments, one.momentum))
    found, other = orbit_equilibria(one), newton.equilibria(moments, momentum, 1.0)
    ours = frames(found.points)
    assert found.kind == "points" and len(ours) == len(other)
    for point, frame in zip(found.points, ours):
        assert np.abs(other - frame).max(axis=(1, 2)).min() < 1e-7
        eigenvalues = newton.growth(moments, momentum, 1.0, frame)
        if point.linear == "unstable":
            assert eigenvalues.real.max() > 1e-4
        else:
            assert eigenvalues.real.max() < 1e-4  # differences are good to 1e-9 and roots of them to 3e-5
        for z in (*point.eigenvalues, *(1j * f for f in point.frequencies)):  # the rate of the orbit is 1
            assert np.abs(eigenvalues - z).min() < 1e-4


@pytest.mark.one_in(2)
@pytest.mark.parametrize("seed", [*range(8), *(
    pytest.param(n, marks=[pytest.mark.slow, *([pytest.mark.long] if n >= 100 else [])])
    for n in range(8, 500))])
def test_newtons_method_from_many_starts_finds_the_same_equilibria(seed):
    agrees(random_satellite(seed))


def test_without_a_wheel_there_are_24_and_4_of_them_stable():
    # Likins and Roberson 1966: all principal axes along the orbital frame; Beletskii: the stable ones have the
    # largest moment along the normal and the smallest along the vertical
    found = orbit_equilibria(satellite((3, 2, 1), (0, 0, 0)))
    assert (found.kind, len(found.points), found.count("stable")) == ("points", 24, 4)
    for one in found.points[:4]:
        assert np.abs(one.normal[0]) == 1 and np.abs(one.vertical[2]) == 1 and one.minimum


def test_librations_have_the_frequencies_of_delp_and_debra():
    # pitch n sqrt(3 (I_roll - I_yaw)/I_pitch); roll and yaw: the quartic with sigma's, from DeBra and Delp 1961
    roll, pitch, yaw = 0.6, 0.9, 0.5
    n = sqrt(1.21e-6)
    found = orbit_equilibria(satellite(("0.6", "0.9", "0.5"), (0, 0, 0), "1.21e-6")).points[0]
    a, b = (pitch - yaw) / roll, (pitch - roll) / yaw
    linear, constant = 1 + 3 * a + a * b, 4 * a * b
    roots = [sqrt((linear + s * sqrt(linear**2 - 4 * constant)) / 2) for s in (-1, 1)]
    expected = sorted([sqrt(3 * (roll - yaw) / pitch), *roots])
    assert found.frequencies == pytest.approx([n * v for v in expected], rel=1e-14)


@pytest.mark.parametrize("axis", (0, 1, 2))
def test_a_wheel_along_an_axis_leaves_8_at_last(axis):
    # a wheel that outweighs everything: its momentum along or against the normal, the other axes in the orbital
    # frame four ways each
    momentum = [0, 0, 0]
    momentum[axis] = 100
    found = orbit_equilibria(satellite((3, 2, "1.5"), momentum))
    assert len(found.points) == 8 and {abs(one.normal[axis]) for one in found.points} == {1.0}


def test_at_a_fold_exactly_the_merged_equilibrium_counts_once_and_has_a_zero_eigenvalue():
    # in the plane across axis 3 the balance is (B - A) x y = p y - q x on x^2 + y^2 = 1: two roots merge on the
    # astroid p^(2/3) + q^(2/3) = (A - B)^(2/3); (27, 64, 125) lies on it
    merged = orbit_equilibria(satellite((225, 100, 200), (27, 64, 0)))
    less = orbit_equilibria(satellite((225, 100, 200), ("26.999", "63.999", 0)))
    more = orbit_equilibria(satellite((225, 100, 200), ("27.001", "64.001", 0)))
    assert len(less.points) - len(merged.points) == len(merged.points) - len(more.points) == 2
    assert [sum(0 in one.eigenvalues for one in found.points) for found in (less, merged, more)] == [0, 2, 0]


def test_the_least_dynamic_potential_is_stable_though_it_is_flat():
    # at h = (A - B) n along the largest axis A the minimum splits; the dynamic potential still has one there
    found = orbit_equilibria(satellite((3, 2, 1), (0, 1, 0)))
    (first, second), rest = found.points[:2], found.points[2:]
    assert first.linear == "degenerate" and first.verdict == "stable"
    assert "less than at any other" in first.because and len(first.frequencies) == 2
    assert min(one.potential for one in rest) > first.potential == second.potential


def test_a_curve_of_equilibria_at_one_wheel_momentum_of_three_different_moments():
    # with h^2 = 4 n^2 (B - A)(B - C) along B the vertical may move with (A - s)(C - s) = 3 p^2, by hand
    found = orbit_equilibria(satellite((30, 55, 51), (0, 20, 0)))
    assert found.kind == "curves" and "common factor" in found.because and len(found.points) == 8
    for one in found.families:
        (pull,) = newton.torque(np.array([30., 55, 51]), np.array([0, 20., 0]), 1.0, frames([one]))
        assert np.abs(pull).max() < 1e-12


@pytest.mark.parametrize("moments, momentum, words, verdicts", [
    ((2, 2, 2), (0, 0, 0), "", []),
    # Likins, Pringle: an axis of symmetry along the vertical, normal, or along the velocity
    ((3, 3, 1), (0, 0, 0), "along the vertical", ["stable"] * 2 + ["unstable"] * 4),
    # the same with a wheel: 16 n^2 (C - A)^2 > h^2, conical; h^2 < n^2 (C - A)^2, hyperbolic
    ((3, 3, 1), (0, 0, "0.5"), "across the velocity", ["stable"] * 2 + ["unstable"] * 4),
    # a sphere turns with its wheel normal to the orbit; the other way up by gyroscopic stability
    ((2, 2, 2), (1, 2, 2), "normal to the orbit", ["stable", "undecided"]),
])
def test_bodies_with_equal_moments_have_families(moments, momentum, words, verdicts):
    found = orbit_equilibria(satellite(moments, momentum))
    assert found.kind == ("curves" if verdicts else "all") and not found.points
    assert [one.verdict for one in found.families] == verdicts
    assert all(words in one.family for one in found.families[:1])
    for one in found.families:
        assert newton.torque(*map(np.array, ([float(v) for v in moments], [float(v) for v in momentum])), 1.0,
                             frames([one])) == pytest.approx(np.zeros((1, 3)), abs=1e-14)


@pytest.mark.parametrize("gap", ("1e-3", "1e-9", "1e-15"))
def test_nearly_equal_moments_have_24_and_equal_ones_a_family(gap):
    near = orbit_equilibria(satellite((3, 3 - Fraction(gap), 1), (0, 0, 0)))
    assert (near.kind, len(near.points), near.count("stable")) == ("points", 24, 4)
    assert orbit_equilibria(satellite((3, 3, 1), (0, 0, 0))).kind == "curves"


def test_a_tiny_wheel_moves_the_24_by_its_share():
    found = orbit_equilibria(satellite((3, 2, 1), ("1e-9", "2e-9", "1e-9")))
    assert (len(found.points), found.count("stable")) == (24, 4)
    assert np.abs(np.abs(frames(found.points)).max(axis=2) - 1).max() < 1e-15  # cos of an angle of 1e-9


def test_the_dynamic_potential_and_the_linear_motion_follow_from_the_equations_of_motion():
    """In symbols: the torque at rest in the orbital frame is the slope of the dynamic potential, and the part of
    the rates linear in a small turn s gives I s'' + g x s' + K s = 0."""
    I, h, a2, a3, s, v = (sympy.Matrix(sympy.symbols(f"{name}1:4")) for name in ("D", "h", "b", "c", "s", "v"))
    n, e = sympy.symbols("n e")
    D = sympy.diag(*I)

    def potential(normal, up):
        return (3 * n**2 * up.dot(D * up) - n**2 * normal.dot(D * normal)) / 2 - n * h.dot(normal)

    def torque(w, up):
        return (D * w + h).cross(w) + 3 * n**2 * up.cross(D * up)
    moved = [a + e * a.cross(s) for a in (a2, a3)]  # the body turns by e s
    slope = sympy.diff(potential(*moved), e).subs(e, 0)
    assert sympy.expand(slope + s.dot(torque(n * a2, a3))) == 0
    w = n * a2
    g = I.dot(sympy.ones(3, 1)) * w - 2 * D * w - h
    cross = lambda u: sympy.Matrix([[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0]])
    K = cross(w) * D * cross(w) - cross(D * w + h) * cross(w) + 3 * n**2 * (
        cross(D * a3) * cross(a3) - cross(a3) * D * cross(a3))
    # omega = s' + n a2, turned, and its rate s'' + n a2 x s' in the body
    linear = sympy.diff(torque(w + e * (v + w.cross(s)), a3 + e * a3.cross(s)), e).subs(e, 0)
    assert (linear - D * w.cross(v) + g.cross(v) + K * s).expand() == sympy.zeros(3, 1)


@pytest.mark.parametrize("seed", (7, *(pytest.param(n, marks=pytest.mark.slow) for n in (3, *range(19, 39)))))
def test_long_runs_stay_at_stable_equilibria_and_leave_unstable_ones(seed):
    """By SciPy; sixteen orbits."""
    body = random_satellite(seed)
    moments, momentum = ([float(v) for v in row] for row in (body.moments, body.momentum))
    times, moved = np.linspace(0, 100, 50), np.array([1e-7, 1e-7, -1e-7])
    found = orbit_equilibria(body)
    for one in (found.points[0], found.points[-1]):
        _, cosines = newton.run(moments, momentum, 1.0, np.array(one.normal) + moved, frames([one])[0], times)
        away = np.abs(cosines - frames([one])[0]).max()
        assert away < 1e-4 if one.verdict == "stable" else away > 1e-4


def test_yaw_pitch_and_roll_turn_the_flight_frame_to_the_body():
    def about(axis, angle):
        c, s = np.cos(angle), np.sin(angle)
        i, j = ((1, 2), (2, 0), (0, 1))[axis]
        r = np.eye(3)
        r[i, i] = r[j, j] = c
        r[i, j], r[j, i] = s, -s
        return r
    yaw, pitch, roll = 0.7, -0.4, 2.1
    body = about(0, roll) @ about(1, pitch) @ about(2, yaw)  # components of that frame's axes in its columns
    assert yaw_pitch_roll(body[:, 0], -body[:, 1], -body[:, 2]) == pytest.approx((yaw, pitch, roll), abs=1e-15)
    straight = about(0, roll) @ about(1, pi / 2) @ about(2, yaw)
    found = yaw_pitch_roll(straight[:, 0], -straight[:, 1], -straight[:, 2])
    assert found == pytest.approx((yaw - roll, pi / 2, 0.0), abs=1e-12)
