"""The rotations of a free gyrostat at its angular momentum: against Newton's method from all over the sphere, the
eigenvalues of the damped equations written here, and cases worked by hand."""
from fractions import Fraction as F
from itertools import pairwise

import numpy as np
import pytest

from stabilab.equilibrium.momentum_sphere import MomentumSphere


def drawn(seed):
    """(D, wheel, |H|^2) as fractions with few digits, wheels from none to more than |H|, some along axes."""
    rng = np.random.default_rng(seed)
    D = [F(int(v), 8) for v in rng.integers(4, 33, 3)]
    size = 10 ** rng.uniform(-1.5, 0.7)
    wheel = [F(round(float(v) * 64), 64) for v in rng.normal(size=3) * size * (rng.random(3) < 0.8)]
    return tuple(D), tuple(wheel), F(int(rng.integers(1, 400)), 16)


def searched(D, wheel, size, points=900):
    """Critical points (n, 4) of H and the multiplier, by Newton's method on D^-1 (H - l) = m H, |H| = size, from
    points all over the sphere."""
    D, l = np.array(D, float), np.array(wheel, float)
    n = np.arange(points) + 0.5
    z, turn = 1 - 2 * n / points, np.pi * (1 + 5 ** 0.5) * n
    H = size * np.stack([np.sqrt(1 - z * z) * np.cos(turn), np.sqrt(1 - z * z) * np.sin(turn), z], axis=1)
    m = (H * (H - l) / D).sum(axis=1) / size ** 2
    x, moving = np.column_stack([H, m]), n >= 0
    for _ in range(60):
        H, m = x[moving, :3], x[moving, 3]
        J = np.zeros((len(m), 4, 4))
        J[:, :3, :3] = np.diag(1 / D) - m[:, None, None] * np.eye(3)
        J[:, :3, 3], J[:, 3, :3] = -H, H
        f = np.concatenate([(H - l) / D - m[:, None] * H, ((H * H).sum(axis=1)[:, None] - size ** 2) / 2], axis=1)
        step = (np.linalg.pinv(J, rcond=1e-13) @ f[..., None])[..., 0]
        x[moving] -= step
        moving[moving] = np.linalg.norm(step, axis=1) > 1e-14 * (size + 1)  # the others have converged
    H, m = x[:, :3], x[:, 3]
    rest = np.linalg.norm((H - l) / D - m[:, None] * H, axis=1) + abs(np.linalg.norm(H, axis=1) - size)
    found = []
    for row in np.column_stack([H, m])[rest < 1e-11 * (size + 1)]:
        if all(np.linalg.norm(row[:3] - other[:3]) > 1e-5 * size for other in found):
            found.append(row)
    return np.array(found)


def damped_growth(D, wheel, omega, k, c):
    """The largest real part of the eigenvalues of (w, s) but for that of |H|: derivatives by central
    differences, of (D - k) w' = (D w + l) x w + c s, s' = -c s/k - w x s - w'."""
    D, l = np.array(D, float), np.array(wheel, float)

    def rates(y):
        w, s = y[:3], y[3:]
        turn = (np.cross(D * w + l, w) + c * s) / (D - k)
        return np.concatenate([turn, -c * s / k - np.cross(w, s) - turn])
    at, h = np.array([*omega, 0, 0, 0], float), 1e-6 * (1 + np.abs(omega).max())
    J = np.stack([(rates(at + h * e) - rates(at - h * e)) / (2 * h) for e in np.eye(6)], axis=1)
    values = sorted(np.linalg.eigvals(J), key=abs)[1:]
    return max(v.real for v in values) / max(map(abs, values))


def agrees(seed):
    D, wheel, square = drawn(seed)
    sphere, size = MomentumSphere(D, wheel, square), float(square) ** 0.5
    ours = [r for r in sphere.rotations if not r.axis]
    theirs = searched(D, wheel, size)
    at = np.array([[float(v) for v in r.momentum] for r in ours])
    for row in theirs:  # none is missing, but for the points of circles
        near = np.linalg.norm(at - row[:3], axis=1).min() if len(at) else np.inf
        assert near < 1e-6 * size or any(abs(float(r.multiplier) - row[3]) < 1e-6 for r in sphere.rotations
                                         if r.axis), (seed, row)
    for r, H in zip(ours, at):  # and each of ours is one
        A = np.diag([1 / float(d) for d in D]) - float(r.multiplier) * np.eye(3)
        assert A @ H == pytest.approx([float(l / d) for l, d in zip(wheel, D)], abs=1e-9 * (1 + size))
        across = np.linalg.svd(H[None])[2][1:]
        low, high = np.linalg.eigvalsh(across @ A @ across.T)
        nature = "minimum" if low > 0 else "maximum" if high < 0 else "saddle"
        if min(abs(low), abs(high)) > 1e-9:
            assert r.nature == nature, seed
            growth = damped_growth(D, wheel, [float(v) for v in r.omega], float(min(D)) / 5, 0.3)
            if abs(growth) > 1e-7:
                assert (growth < 0) == (r.nature == "minimum"), (seed, r.nature, growth)
    if len(set(D)) == 3:
        kinds = [r.nature for r in ours]
        assert kinds.count("minimum") + kinds.count("maximum") - kinds.count("saddle") == 2  # Poincare and Hopf
        assert (kinds.count("minimum") == 2) == bool(sphere.passes)
    return len(ours)


def test_all_rotations_of_random_gyrostats_are_those_of_a_search_over_the_sphere():
    assert {agrees(seed) for seed in range(8)} >= {2, 4}


@pytest.mark.first(0, 4)
@pytest.mark.parametrize("first", range(8, 508, 50))
def test_all_rotations_of_five_hundred_gyrostats_are_those_of_a_search(first):
    assert {agrees(seed) for seed in range(first, first + 50)} >= {2, 4, 6}


@pytest.mark.parametrize("seed", range(6))
def test_just_below_the_threshold_two_rotations_attract_and_just_above_it_one(seed):
    D, wheel, square = drawn(seed + 1000)
    if len(set(D)) < 3 or not any(wheel):
        pytest.skip("no threshold")
    factor = MomentumSphere(D, wheel, square).threshold.factor
    for times, minima in ((F(999, 1000), 2), (F(1001, 1000), 1)):
        scaled = tuple(times * factor * l for l in wheel)
        # by the search: A is positive across H
        found = searched(D, scaled, float(square) ** 0.5, 300)
        count = 0
        for *H, m in found:
            across = np.linalg.svd(np.array(H)[None])[2][1:]
            A = np.diag([1 / float(d) for d in D]) - m * np.eye(3)
            count += np.linalg.eigvalsh(across @ A @ across.T)[0] > 0
        assert count == minima


@pytest.mark.parametrize("axis", [1, 2])
def test_the_threshold_of_a_wheel_along_an_axis_is_that_of_likins_and_of_landon_and_iorillo(axis):
    """h > (D1 - D_k) Omega, with |H| = D_k Omega + h: h = |H| (1 - D_k/D1)."""
    D = (F(2000), F(1500), F(1000))
    wheel = tuple(F(100) if i == axis else F(0) for i in range(3))
    found = MomentumSphere(D, wheel, F(3000) ** 2).threshold
    assert found.moment == 3000 * (1 - D[axis] / max(D))
    assert found.moment == pytest.approx(float(max(D) - D[axis]) * found.omega[axis], abs=1e-9)


def test_a_wheel_on_the_major_axis_leaves_the_turn_against_it_until_it_is_as_fast_as_the_next_axis():
    """H = -3000 along axis 1: m = (3000 + h)/(2000 3000) < 1/1500 up to h = 1000."""
    found = MomentumSphere((F(2000), F(1500), F(1000)), (F(100), F(0), F(0)), F(3000) ** 2).threshold
    assert found.moment == 1000 and found.omega == pytest.approx((1, 0, 0))


def natures(D, wheel, square):
    return [r.nature for r in MomentumSphere(tuple(map(F, D)), tuple(map(F, wheel)), F(square)).rotations]


def test_at_the_threshold_of_a_wheel_on_the_minor_axis_the_energy_has_a_quartic_minimum():
    """D = (2, 3/2, 1), |H| = 2: two minima end in (0, 0, 2) where the wheel has 2 (1 - 1/2) = 1."""
    assert natures((2, "3/2", 1), (0, 0, "0.999"), 4).count("minimum") == 2
    # and there the saddles about axis 2 are gone, 1 > 2 (1 - 2/3)
    assert natures((2, "3/2", 1), (0, 0, 1), 4) == ["minimum", "maximum"]
    assert natures((2, "3/2", 1), (0, 0, "1.001"), 4) == ["minimum", "maximum"]


def test_a_fold_of_minimum_and_saddle_is_an_inflection():
    """D = (4, 2, 3/2), l = (1, 0, 3): at m = 1/3 l1^2 D1/(1 - m D1)^3 + l3^2 D3/(1 - m D3)^3 = -108 + 108, and
    |H|^2 = 9 + 36."""
    sphere = MomentumSphere((F(4), F(2), F(3, 2)), (F(1), F(0), F(3)), F(45))
    fold = [r for r in sphere.rotations if r.nature == "inflection"]
    assert [r.momentum for r in fold] == [(-3, 0, 6)] and fold[0] == sphere.trap and not sphere.passes
    assert sphere.threshold.factor == 1
    assert natures((4, 2, "3/2"), (1, 0, 3), "44.99").count("minimum") == 1
    assert natures((4, 2, "3/2"), (1, 0, 3), "45.01").count("minimum") == 2


@pytest.mark.parametrize(("D", "wheel", "expected"), [
    ((2, 2, 1), (0, 0, "0.1"), ["minimum", "maximum", "maximum"]),  # the circle of the two larger moments
    ((2, 1, 1), ("0.1", 0, 0), ["minimum", "minimum", "maximum"]),  # that of the smaller ones is highest
    ((2, 2, 1), ("0.1", 0, 0), ["minimum", "saddle", "maximum", "maximum"]),
    ((2, 2, 2), ("0.1", 0, "0.2"), ["minimum", "maximum"]), ((2, 2, 2), (0, 0, 0), ["minimum"]),
    ((3, 2, 1), (0, 0, 0), ["minimum", "minimum", "saddle", "saddle", "maximum", "maximum"])], ids=str)
def test_equal_moments_and_wheels_along_axes(D, wheel, expected):
    """By hand: the energy is quadratic in H on each circle of latitude."""
    assert natures(D, wheel, 1) == expected


def test_without_momentum_the_one_rotation_cancels_the_wheels():
    found, = MomentumSphere((F(3), F(2), F(1)), (F(3), F(0), F(1)), F(0)).rotations
    assert found.omega == (-1, 0, -1) and found.with_losses == found.without_losses == "stable"


def test_energies_rise_and_their_order_to_a_number_is_exact():
    D, wheel, square = drawn(3)
    sphere = MomentumSphere(D, wheel, square)
    assert all(one.energy <= two.energy for one, two in pairwise(sphere.rotations))
    for rotation in sphere.rotations:
        near = rotation.energy + F(1, 2**60), rotation.energy - F(1, 2**60)
        assert [sphere.above(T, rotation) for T in near] == [1, -1]
