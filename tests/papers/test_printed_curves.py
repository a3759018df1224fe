"""The dashed curves of the figures are the printed equations, evaluated here as they stand in print, and their
captions say how far these are from the truth, worked out here in another way."""
import re

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar
from scipy.spatial import cKDTree

from stabilab.papers.figures.catalogue import figure
from stabilab.show import style

A, B = 0.2, 0.4  # a and b of the paper for lambda1 = 100


@pytest.fixture
def plt():
    with style.drawing() as found:
        yield found


def dashed(ax, colour=style.SAGE):
    """The data of the dashed lines of a colour in a panel."""
    return [np.array(line.get_data_3d() if ax.name == "3d" else line.get_data(), float)
            for line in ax.lines if line.get_linestyle() == "--" and line.get_color() == colour]


def numbers(pattern, text):
    return [float(value) for value in re.search(pattern, text).groups()]


def to_nearest(points, others):
    """The distance of each column of `points` from the nearest column of `others`."""
    points, others = (found[:, np.isfinite(found).all(axis=0)] for found in (points, others))
    return cKDTree(others.T).query(points.T)[0]


def printed_25(alpha, radius, wheel):
    """The left side of (25) without x^2/2; in truth the same with A and b - a for F and b."""
    return radius**2 * np.cos(alpha) - 4 * radius * wheel * np.sin(alpha / 2) - 2 * alpha


def top_near(alpha, radius, wheel):
    """The height of the saddle next to alpha."""
    return -minimize_scalar(lambda v: -printed_25(v, radius, wheel), bounds=(alpha - 0.8, alpha + 0.8)).fun


def test_dashed_separatrices_of_figures_2_and_3_obey_the_printed_26_and_27(plt):
    printed, true = (np.hypot(2.5, 4), B), (np.hypot(2.5 + A, 4), B - A)
    for number in (2, 3):
        curves = dashed(figure(number).draw(plt).axes[0])
        said = numbers(r"off by up to ([\d.]+) at α = ([-\d.]+) on the left one and ([\d.]+) at α = ([-\d.]+)",
                       figure(number).caption.replace("−", "-"))
        assert len(curves) == 4
        for turn, (alpha, x), (off, place) in zip((0, 2 * np.pi), curves[::2], (said[:2], said[2:])):
            seen = np.isfinite(x)
            levels = [top_near(turn - 0.15, *constants) for constants in (printed, true)]
            assert np.abs(x**2 / 2 + printed_25(alpha, *printed) - levels[0])[seen].max() < 1e-3
            squares = [2 * (level - printed_25(alpha, *constants))
                       for level, constants in zip(levels, (printed, true))]
            both = seen & (squares[1] >= 0) & (squares[0] >= 0)
            apart = np.abs(np.sqrt(squares[0][both]) - np.sqrt(squares[1][both]))
            # a root ends in a vertical tangent: samples stay below (test_differences has the value by mpmath)
            assert apart.max() <= off + 0.005 and off - apart.max() < 0.4
            assert place == pytest.approx(alpha[both][apart.argmax()], abs=0.01)


def printed_31(x1, x2, x3, side):
    """The left side of (31), its signs as at the left and at the right saddle."""
    F2, turn = x1**2 + x2**2, np.arctan2(x1, x2) - (np.pi if side == "right" else 0)
    root = np.sqrt(F2**2 - 4)
    return (2 * x3**2 + x2**2 - x1**2 - 4 * B * x1 - root - 2 * np.arcsin(2 / F2) - 4 * turn
            + (1 if side == "right" else -1) * 4 * B / np.sqrt(2) * np.sqrt(F2 - root))


def test_dashed_loops_of_figure_5_obey_the_printed_31(plt):
    for ax, loops in zip(figure(5).draw(plt).axes, (6, 2)):
        drawn = dashed(ax)
        assert len(drawn) == loops + 1
        radii = set()
        for x1, x2, x3 in drawn[:-1]:
            radius = np.hypot(x1, x2)
            assert np.ptp(radius) < 1e-12 and np.abs(x3).max() > 0.3
            side = "left" if x1[100] < 0 else "right"
            assert np.abs(printed_31(x1, x2, x3, side)).max() < 1e-9 * radius[0]**2
            radii.add((round(radius[0], 9), side))
        assert len(radii) == loops
        x1, x2, x3 = drawn[-1]
        assert np.allclose(x1**2 + x2**2, 2, atol=1e-12) and not x3.any()


def true_surface(branch):
    """Points of the true separatrix surface, from the equations (13) by hand: on each circle X^2 + x2^2 = A^2,
    X = x1 + a, the loop of the saddle x2 = h, X = -c - 1/h with the sign of h given."""
    c, found = B - A, []
    for radius in np.arange(1.3, 8.5, 0.02):
        roots = np.roots([1, 0, c * c - radius**2, 2 * c, 1])  # h^2 (h^2 + (c + 1/h)^2 - A^2) = 0
        heights = sorted(r.real for r in roots if abs(r.imag) < 1e-9 and np.sign(r.real) == branch)
        if len(heights) < 2:
            continue
        h = max(heights, key=abs)
        saddle = np.arctan2(-c - 1 / h, h)
        turn = saddle - np.linspace(0, 2 * np.pi, 3001)
        energy = turn + (radius * np.sin(turn))**2 / 2 + c * radius * np.sin(turn)  # x3^2/2 - energy constant
        room = energy - energy[0]
        end = int(np.argmax(room[5:] < 0)) + 5
        x3 = np.sqrt(2 * np.maximum(room[:end], 0))
        loop = np.array([radius * np.sin(turn[:end]) - A, radius * np.cos(turn[:end]), x3])
        found += [loop, loop * [[1], [1], [-1]]]
    return np.concatenate(found, axis=1)


@pytest.mark.slow
def test_figure_5_says_how_far_31_is_from_the_true_surface(plt):
    three = r"([\d.]+), ([\d.]+) and ([\d.]+)"
    said = numbers(rf"up to {three} on the left and {three} on the right", figure(5).caption)
    surfaces = {"left": true_surface(1), "right": true_surface(-1)}
    loops = sorted(dashed(figure(5).draw(plt).axes[0])[:-1],
                   key=lambda loop: (loop[0, 100] > 0, np.hypot(*loop[:2, 0])))
    found = [to_nearest(loop, surfaces["left" if loop[0, 100] < 0 else "right"]).max() for loop in loops]
    assert np.abs(np.array(found) - said).max() < 0.011
    folds = [h.real for h in np.roots([1, 0, 0, A - B, -1]) if abs(h.imag) < 1e-9]
    true = np.array([(-B - 1 / h, h) for h in folds])
    off = [np.hypot(*(true - point).T).min() for point in ((1, -1), (-1, 1))]
    assert numbers(r"are up to ([\d.]+) off", figure(5).caption)[0] == pytest.approx(max(off), abs=0.005)


def run(rates, start, end=15.0):
    return solve_ivp(lambda t, x: rates(*x), (0, end), start, rtol=1e-10, atol=1e-12, method="DOP853",
                     dense_output=True).sol(np.linspace(0, end, 40001))


def test_figure_7_draws_the_printed_circles_and_how_far_the_motion_is_from_its_own(plt):
    for ax in figure(7).draw(plt).axes:
        fold, own = dashed(ax)[:2]
        assert np.allclose(np.hypot(*fold[:2])**2, 2) and np.allclose(np.hypot(*own[:2])**2, 2.5**2 + 4**2)
    x = run(lambda x1, x2, x3: (x2 * x3, -x3 * (x1 + A), 1 + x2 * (x1 + B)), (2.5, 4, 0.1))  # (13)
    far = np.hypot(*x[:2])
    away, least = numbers(r"is up to ([\d.]+) away.*stays ([\d.]+) and more", figure(7).caption)
    assert away == pytest.approx(np.abs(far - np.hypot(2.5, 4)).max(), abs=6e-4)
    assert least == pytest.approx(far.min(), abs=6e-3)


def printed_71(x1, x3, a, b):
    """The left side of (71) without 2 x2^2, and what stands under tanh^-1."""
    under = 2 * x1**2 * x3**2 / (x1**2 + x3**2)
    return (x1**2 + x3**2) * (1 + 2 * (a + b) / np.sqrt(x1**2 - x3**2)) - 2 * np.arctanh(under), under


def test_dashed_curves_of_figure_16_obey_the_printed_53_and_71(plt):
    ax = figure(16).draw(plt).axes[0]
    start = 2 * 1.1**2 + printed_71(1.7, -0.2, A, B)[0]
    paths, sections = [], []
    for x1, x3, x2 in dashed(ax):  # the axes of the torque stand upright
        (paths if np.ptp(x2) > 0 else sections).append(np.array([x1, x2, x3]))
    for x1, x2, x3 in paths:
        assert np.allclose(x1**2 - x3**2, 1.7**2 - 0.2**2)
        assert np.allclose(2 * x2**2 + printed_71(x1, x3, A, B)[0], start, atol=1e-9)
    assert len(paths) == 2 and sections
    _obeys_393(sections, A, B)
    true = run(lambda x1, x2, x3: (x2 * x3, 1 - x3 * (x1 + A), x2 * (x1 + B)), (1.7, 1.1, -0.2))  # (44)
    said = numbers(r"up to ([\d.]+) away from the true motion", figure(16).caption)[0]
    assert said == pytest.approx(max(to_nearest(path, true).max() for path in paths), abs=0.006)


def _obeys_393(curves, a, b):
    for curve in curves:
        x1, x3 = curve[[0, -1]]
        seen = np.isfinite(x1)
        if not seen.any():
            continue
        with np.errstate(invalid="ignore", divide="ignore"):
            energy, under = printed_71(x1[seen], x3[seen], a, b)
        clear = under < 0.99  # beyond, a last digit of a place is much in tanh^-1
        assert np.abs(energy - 3.93)[clear].max(initial=0) < 0.01


def true_fourth(a, b):
    """Y^2 + x3^2 - 4 c Y - 4 atanh(x3/Y) = 3.93 by its slope x3/Y = tanh v: a quadratic in Y = x1 + b."""
    points = []
    for v in np.sinh(np.linspace(-4, 4, 4001)):
        s = np.tanh(v)
        for Y in np.roots([1 + s * s, -4 * (b - a), -4 * v - 3.93]):
            if abs(Y.imag) < 1e-12:
                points.append((Y.real - b, s * Y.real))
    return np.array(points).T


@pytest.mark.slow
def test_figure_17_has_the_fourth_surface_as_printed_and_how_far_it_is_off(plt):
    panels = figure(17).draw(plt).axes
    said = numbers(r"up to ([\d.]+), ([\d.]+) and ([\d.]+) off", figure(17).caption)
    for ax, lam, value in zip(panels, (100, 300, 500), said):
        a, b = lam / 500, lam / 250
        curves = dashed(ax)
        _obeys_393(curves, a, b)
        points = np.concatenate(curves, axis=1)
        inside = (points[0] >= -8) & (points[0] <= 4.5) & (np.abs(points[1]) <= 6.25)
        true = true_fourth(a, b)
        # the drawn vertices stand up to 0.1 apart where they leave the panel
        assert 0 <= value - to_nearest(points[:, inside], true).max() < 0.1
        drawn = np.concatenate([line.get_data() for line in ax.lines if line.get_color() == style.WINE], axis=1)
        Y, x3 = drawn[:, np.isfinite(drawn[0])] + [[b], [0]]
        Y, x3 = (part[np.abs(x3 / Y) < 0.999] for part in (Y, x3))
        energy = Y**2 + x3**2 - 4 * (b - a) * Y - 2 * np.log((Y + x3) / (Y - x3))
        assert len(Y) > 1000 and np.abs(energy - 3.93).max() < 1e-8


def fourth_of_6(shift, wheel):
    """x2^2 - X^2 - 4 wheel X - 4 atan(X/x2) = 0, X = x1 + shift, along each direction from X = x2 = 0: a
    quadratic in the distance."""
    turn = np.linspace(-np.pi, np.pi, 100002)
    principal = np.arctan(np.tan(turn))
    k = np.cos(2 * turn)
    found = []
    for sign in (1, -1):
        with np.errstate(invalid="ignore"):
            r = (2 * wheel * np.sin(turn) + sign * np.sqrt((2 * wheel * np.sin(turn))**2 + 4 * k * principal)) / k
        r[~(r > 0)] = np.nan
        found.append(np.array([r * np.sin(turn) - shift, r * np.cos(turn)]))
    return np.concatenate(found, axis=1)


def test_figure_6_has_the_fourth_surface_as_printed_and_how_far_it_is_off(plt):
    printed, true = fourth_of_6(0, B), fourth_of_6(A, B - A)
    inside = np.abs(printed).max(axis=0) <= 6
    said = numbers(r"as printed: up to ([\d.]+) off", figure(6).caption)[0]
    assert said == pytest.approx(to_nearest(printed[:, inside], true).max(), abs=0.006)
    for ax in figure(6).draw(plt).axes[:2]:
        solid = [np.array(line.get_data()) for line in ax.lines if line.get_color() == style.WINE]
        for curves, shift, wheel in ((dashed(ax, style.SAGE), 0, B), (solid, A, B - A)):
            assert len(curves) >= 3
            for x1, x2 in curves:
                x1, x2 = x1[np.abs(x2) > 0.02] + shift, x2[np.abs(x2) > 0.02]
                assert np.abs(x2**2 - x1**2 - 4 * wheel * x1 - 4 * np.arctan(x1 / x2)).max() < 0.01
