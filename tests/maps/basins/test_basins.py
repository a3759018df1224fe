"""Basins of planes whose boundary is known, and what is no plane of states."""
from __future__ import annotations

import numpy as np
import pytest

from stabilab.errors import InputError
from stabilab.maps import basins as ask
from stabilab.maps import basins as mesh
from stabilab.maps.basins import BOUNDED, UNDECIDED, basins
from stabilab.show.maps.basins import basin, dataset
from tests.shared import CASES

MINOR, PLANE = CASES / "minor-axis-100.toml", {"x[1]": "-4:4:12", "x[3]": "-3:3.1:11"}
A, B, TURN = 0.2, 0.4, np.linspace(0, 2 * np.pi, 20_001)[1:]


def height(x1):
    """(n,): what x3^2/2 must stay below for a bounded motion from (x1, 4, x3) of minor-axis-100, by hand: x1
    + a = r sin t, x2 = r cos t, t' = x3, x3' = 1 + x2 (x1 + b) = -V'(t); the highest V within a turn ahead,
    less V at the start. No turn farther ahead is as high: V falls by 2 pi a turn."""
    radius, start = np.hypot(x1 + A, 4.0), np.arctan2(x1 + A, 4.0)
    V = lambda t: -t - radius**2 * np.sin(t) ** 2 / 2 - (B - A) * radius * np.sin(t)
    return np.array([max(0.0,
                         _highest(lambda t: -t - r**2 * np.sin(t) ** 2 / 2 - (B - A) * r * np.sin(t), t0) - v)
                     for r, t0, v in zip(np.ravel(radius), np.ravel(start),
                                         np.ravel(V(start)))]).reshape(np.shape(x1))


def _highest(V, start):
    """The greatest value within a turn: on a grid, then by the parabola through the three highest places
    there."""
    values = V(start + TURN)
    n = int(values.argmax())
    if n == 0:  # it falls from the start on
        return values[0]
    low, mid, high = values[n - 1:n + 2]
    return mid + (high - low) ** 2 / 8 / (2 * mid - low - high)


@pytest.fixture(scope="module")
def minor():
    return basin(MINOR, PLANE, depth=6)


def test_each_finest_cell_on_the_boundary_holds_a_zero_of_the_exact_margin_and_none_is_missed(minor):
    """Oracle: the margin by hand at every place of the finest grid, 705 x 641: it is continuous, so a cell
    whose corners differ in its sign holds a zero."""
    x1, x3 = (np.array(axis.values) for axis in minor.plan.axes)
    margin = height(x1)[:, None] - x3**2 / 2
    assert margin.shape == (705, 641) and np.abs(margin).min() > 1e-9  # no corner is a tie
    bounded = margin > 0
    corners = np.stack([bounded[:-1, :-1], bounded[:-1, 1:], bounded[1:, :-1], bounded[1:, 1:]])
    expected = (corners != corners[0]).any(axis=0)
    found = np.zeros_like(expected)
    found[minor.mesh.at(6, minor.boundary)] = True
    assert (found
            == expected).all() and found.sum() == len(
                minor.boundary) > 1500 and minor.unclear == 0 and minor.exact


def test_the_line_that_is_drawn_lies_on_the_exact_separatrix(minor):
    """x3^2/2 is the height by hand there, to the halving of a side (3e-6, times the slope of the height, 6 at
    most)."""
    pieces = minor.separatrix()
    assert len(pieces) == len(minor.boundary)
    at = pieces[::9].reshape(-1, 2)
    assert np.abs(at[:, 1] ** 2 / 2 - height(at[:, 0])).max() < 2e-5


def test_shares_are_those_of_the_whole_grid_and_dimension_is_one(minor):
    x1, x3 = (np.linspace(axis.values[0], axis.values[-1], 901) for axis in minor.plan.axes)
    share = (height(x1)[:, None] > x3**2 / 2).mean()  # of 900 x 900 places
    assert abs(minor.shares[BOUNDED] - share) < minor.blur and sum(minor.shares.values()) == pytest.approx(1)
    assert abs(minor.dimension.value - 1) <= minor.dimension.uncertainty < 0.03


def test_a_state_is_asked_once_and_few_are(minor):
    assert len(np.unique(minor.mesh.keys)) == len(minor.records) < 0.02 * 705 * 641 + 121


def test_the_basins_of_a_torque_off_the_axes_are_those_of_its_states(tmp_path):
    """Each place that was asked, asked again by itself."""
    import stabilab
    found = basin(island(tmp_path), {"angular_velocity[1]": "-2:0:5", "angular_velocity[3]": "0:2:5"},
                  depth=2, follow="300 s")
    assert set(found.shares) == {2, 3, UNDECIDED} and not found.exact and found.unclear
    assert found.separatrix().shape == (0, 2, 2)
    scene, values = found.plan.case.scene, [np.array(axis.values) for axis in found.plan.axes]
    row, column = found.mesh.places(found.mesh.keys)
    for n in range(0, len(row), 17):
        one = stabilab.fate(scene, [values[0][row[n]], 0.657, values[1][column[n]]], follow=300)
        label = UNDECIDED if int(one.labels) == 4 else int(one.axis) * int(one.sense)
        assert found.mesh.labels[n] == label


def island(folder):
    path = folder / "island.toml"
    path.write_text("[body]\ninertia = [1.2412, 0.3937, 1.3650]\n[effects.gyrostat]\nmomentum = [-0.5224, "
                    "0.8309, 0.1914]\n[effects.constant_torque]\n"
                    "torque = [0.0987, 0.8450, 0.5255]\n[motion]\nangular_velocity = [-1.572, 0.657, "
                    "0.738]\n")
    return path


def test_a_run_that_was_killed_goes_on_and_the_bytes_are_those_of_any_number_of_workers(tmp_path):
    whole = tmp_path / "whole.nc"
    basin(MINOR, PLANE, depth=4, out=whole, workers=2)
    with pytest.raises(KeyboardInterrupt), basins(MINOR, PLANE, 4, tmp_path / "again.nc"):
        raise KeyboardInterrupt  # all rounds are finished, the file is not written
    assert len(list(tmp_path.glob("again.nc*.parts"))) == 5
    with basins(MINOR, PLANE, 4, tmp_path / "again.nc") as found:
        assert found.resumed == len(found.records)
    basin(MINOR, PLANE, depth=4, out=tmp_path / "again.nc")
    assert (tmp_path / "again.nc").read_bytes() == whole.read_bytes() and not list(tmp_path.glob("*.parts"))


def test_a_plane_that_takes_too_many_states_ends_coarser_and_says_so(monkeypatch):
    monkeypatch.setattr(mesh, "MAX_PLACES", 1000)
    found = basin(MINOR, PLANE, depth=6)
    assert found.mesh.full and found.mesh.depth == 2 and found.asked == 6 and len(found.records) <= 1000
    assert found.plan.shape == (45, 41) and len(found.boundary)
    fresh = basin(MINOR, PLANE, depth=2)
    assert np.array_equal(fresh.mesh.keys, found.mesh.keys) and np.array_equal(fresh.boundary, found.boundary)
    assert int(dataset(found).attrs["complete"]) == 0


@pytest.mark.parametrize("vary, depth, words", [
    ({"x[1]": "-4:4"}, 3, "two rates of the initial state"),
    ({"x[1]": "-4:4", "momentum[1]": "1:3"}, 3, "momentum.* is no rate of the initial state"),
    ({"x[1]": "-4:4", "x[3]": "1, 2"}, 3, "expected a range"),
    ({"x[1]": "-4:4", "x[3]": [1, 2]}, 3, "expected a range"),
    ({"x[1]": "-4:4", "x[3]": "1:1:1"}, 3, "two points at least"),
    ({"x[1]": "-4:4", "motion.x[1]": "0:1"}, 3, "varies already"),
    ({"x[1]": "-4:4", "x[3]": "0:1"}, 15, "depth: expected a whole number from 0 to 14, got 15"),
    ({"x[1]": "-4:4", "x[3]": "0:1"}, True, "depth: expected a whole number"),
    ({"x[1]": "-4:4:5000", "x[3]": "0:1:5000"}, 1, "before any is refined")])
def test_what_is_no_plane_is_refused_with_the_reason(vary, depth, words):
    with pytest.raises(InputError, match=words):
        basin(MINOR, vary, depth)
    assert ask.DEEPEST == 14


def test_a_bad_follow_is_refused_before_anything_runs():
    for text, words in (("3 foo", "follow: "), ("-1", "above zero"), ("0", "above zero")):
        with pytest.raises(InputError, match=words):
            basin(MINOR, PLANE, 1, follow=text)
