"""The band of a motion of many turns, and the turns of it that are drawn as lines."""
import math

import numpy as np
import pytest

from stabilab.show.plot.in_space import space_of
from stabilab.show.plot.subject import subject
from stabilab.show.space.box import Box, shifted
from stabilab.show.turns import band
from tests.oracles.rigid import euler
from tests.shared import case as load

DEG = ("deg/s", 180 / math.pi)


def modulated(turns, amplitude, drift, places=60):
    """(n, 3): once round the third axis a turn, at a radius of 2 + amplitude cos(turn/2.7), rising by drift a
    turn."""
    turn = np.arange(turns * places + 1) / places
    radius = 2 + amplitude * np.cos(2 * np.pi * turn / 2.7)
    return np.column_stack([radius * np.cos(2 * np.pi * turn), radius * np.sin(2 * np.pi * turn), drift * turn])


def test_a_band_reaches_from_the_least_to_the_greatest_radius_of_its_turns():
    """Oracle: the formula of the motion, radii 1.7 to 2.3; straight pieces between 60 places a turn are nearer to
    the axis by 1 - cos(pi/60) = 0.14 % at the most, and a beat of 2.7 turns is hit to cos(0.5/2.7 turns)."""
    path = modulated(120, 0.3, 0.0)
    stretches = [path[n:n + 481].tolist() for n in range(0, len(path) - 481, 180)]
    (grid,) = band.skins(stretches, "band")
    radii = np.hypot(*np.array(grid.points)[:, :2].T).reshape(grid.rows, grid.columns)
    assert (grid.rows, grid.columns) == (2 * len(stretches) + 2, 49)
    assert 1.695 < radii.min() < 1.75 and 2.25 < radii.max() < 2.301
    inner, outer = radii[1:len(stretches) + 1], radii[len(stretches) + 2:]
    assert inner.max() < 1.8 and outer.min() > 2.2  # a beat is in every stretch of eight turns


def test_turns_that_drift_are_one_skin_from_the_first_turn_to_the_last():
    path = modulated(100, 0.0, 0.1)
    (grid,) = band.skins([path[n:n + 181].tolist() for n in range(0, 5820, 120)], "band")
    points = np.array(grid.points).reshape(grid.rows, grid.columns, 3)
    assert np.hypot(points[..., 0], points[..., 1]) == pytest.approx(np.full(points.shape[:2], 2.0), rel=2e-3)
    assert (np.diff(points[:-1].mean(axis=1)[:, 2]) > 0).all()  # the turn at the beginning of each stretch
    assert points[..., 2].min() < 0.11 and points[..., 2].max() > 9.7  # by the formula: 0 to 9.9


def test_turns_are_counted_by_the_slowest_rate_that_goes_round_and_one_turn_closes():
    turn = np.arange(4001) / 100
    path = np.column_stack([np.cos(2 * np.pi * turn), np.sin(2 * np.pi * turn), np.cos(4 * np.pi * turn)])
    assert band.often(path.tolist()) == 40  # the third rate turns twice as often
    assert band.often(modulated(31, 0, 0.1).tolist()) == 31
    (first, last) = (band.one_turn(path[a:b].tolist(), back) for a, b, back in ((0, 160, False), (-160, 4001, True)))
    assert 99 <= len(first) - 1 <= 101 and 99 <= len(last) - 1 <= 101
    assert first[0] == pytest.approx(path[0]) and last[-1] == pytest.approx(path[-1])


def test_what_tumbles_has_no_band():
    """A line that goes to and fro encloses nothing."""
    turn = np.arange(2001) / 50
    path = np.column_stack([np.cos(2 * np.pi * turn), np.cos(2 * np.pi * turn), np.cos(2 * np.pi * turn)]).tolist()
    assert band.skins([path[n:n + 150] for n in range(0, 1800, 100)], "band") == ()


@pytest.mark.slow
def test_the_band_of_a_spin_up_is_where_another_integrator_goes_and_its_limit_stands_on_a_turn():
    """Oracle: SciPy's DOP853 on Euler's equations written here, over the time that the picture shows; the limit of
    120 deg/s of the file, whose turn goes about that."""
    from scipy.integrate import solve_ivp
    item = subject(load("upper-stage"))
    found = space_of(item, "123", DEG)
    (grid,) = [part for words, _, part in found.veils if words.startswith("least to greatest, samples of 12")]
    texts = [text for _, text in found.times]
    assert sorted(texts)[1:] == ["limit, 9.833 min", "start, 0 min"] and len(found.lines) == len(found.arrows) == 3
    D, M = (np.array([float(v) for v in row]) for row in (item.scene.body.inertia, item.scene.vector("constant_torque")))
    end = 60 * float(min(texts, key=len).removesuffix(" min"))
    run = solve_ivp(euler(D, torque=M), (0, end), item.state, "DOP853", rtol=1e-10,
                    atol=1e-12, max_step=0.3)
    points = np.array(grid.points)
    swing = np.ptp(run.y, axis=1)
    assert (np.abs(points.min(axis=0) - run.y.min(axis=1)) < 0.02 * swing).all()
    assert (np.abs(points.max(axis=0) - run.y.max(axis=1)) < 0.02 * swing).all()
    limit = found.lines[1]
    assert np.degrees(np.linalg.norm(limit, axis=1)) == pytest.approx(np.full(len(limit), 120.0), rel=0.01)


def test_a_band_ends_at_exact_extremes_where_these_are_known():
    """Those of toy-top are exact over its span of 2 s (roots of rates along the run, which know no band)."""
    item = subject(load("toy-top"))
    found = space_of(item, "123", DEG)
    points = np.concatenate([part.points for words, _, part in found.veils if words == "least to greatest of 47 turns"])
    for n, (least, greatest) in enumerate(item.motion.extremes):
        assert (points[:, n].min(), points[:, n].max()) == pytest.approx((least, greatest), rel=1e-12)


@pytest.mark.parametrize("ticks, told, name", [
    ([4499.94, 4499.96, 4499.98, 4500.0, 4500.02], [-0.06, -0.04, -0.02, 0, 0.02], "ω3 − 4500 (deg/s)"),
    ([-4500.02, -4500.0, -4499.98], [-0.02, 0, 0.02], "ω3 + 4500 (deg/s)"),
    ([8985, 8990, 8995, 9000, 9005], [8985, 8990, 8995, 9000, 9005], "ω3 (deg/s)")])
def test_ticks_that_differ_in_their_last_digits_alone_are_differences(ticks, told, name):
    values, named = shifted(ticks, "ω3 (deg/s)")
    assert values == pytest.approx(told, abs=1e-9) and named == name


def test_times_near_each_other_are_written_at_one_place():
    box = Box((0.0,) * 3, (1.0,) * 3)
    from stabilab.show.space.drawing import _beside
    ring = lambda r, z: [(r * math.cos(a), r * math.sin(a), z) for a in np.linspace(0, 6.2, 40)]
    out = _beside([(ring(0.8, 0), "start"), (ring(0.01, 0), "later"), (ring(0.012, 0), "end")], box, (22, -55))
    assert sorted(text for _, text in out) == ["later; end", "start"]
