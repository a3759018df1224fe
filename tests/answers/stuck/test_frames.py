"""The same spacecraft in ten frames: the same physical answers to rounding."""
import random
from pathlib import Path

import numpy as np
import pytest

import stabilab
from tests.answers.stuck.brute import Craft

ROOT = Path(__file__).parents[3]
TURNED = """[body]
inertia = [[{J[0][0]!r}, {J[0][1]!r}, {J[0][2]!r}], [{J[0][1]!r}, {J[1][1]!r}, {J[1][2]!r}], [{J[0][2]!r}, {J[1][2]!r}, {J[2][2]!r}]]
[effects.constant_torque]
torque = {M!r}
[effects.gyrostat]
momentum = {l!r}
[limits]
rate = {limit!r}
[motion]
angular_velocity = {start!r}
"""


def a_rotation(numbers) -> np.ndarray:
    """From four normal numbers as a quaternion, by the formula of Rodrigues."""
    w, x, y, z = (q := np.array([numbers.gauss(0, 1) for _ in range(4)])) / np.linalg.norm(q)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", ["upper-stage", "cubesat-3u"])
def test_ten_frames_give_one_answer(tmp_path, name):
    """A rotation of the whole file changes no moment, no fate, no time and no rate; vectors turn with it."""
    craft = Craft((ROOT / "cases" / f"{name}.toml").read_text())
    limit = min(craft.limit, 0.3)

    def asked(R):
        path = tmp_path / "turned.toml"
        path.write_text(TURNED.format(J=(R @ craft.J @ R.T).tolist(), M=(R @ craft.torque()).tolist(),
                                      l=(R @ craft.l).tolist(), limit=limit,
                                      start=(R @ craft.start).tolist()))
        return stabilab.stuck(stabilab.load(path))
    given, numbers = asked(np.eye(3)), random.Random(13)
    row, axes = given.rows[0], np.array(given.principal.axes)
    for _ in range(10):
        R = a_rotation(numbers)
        found = asked(R)
        other = found.rows[0]
        assert (other.fate, other.level, other.axis) == (row.fate, row.level, row.axis)
        assert found.principal.moments == pytest.approx(given.principal.moments, rel=1e-12)
        # rows, in the frame of the first file: the same axes but for their sense
        turned = np.array(found.principal.axes) @ R
        assert np.abs(np.sum(turned * axes, axis=1)) == pytest.approx(1, abs=1e-10)
        assert R.T @ np.array(other.direction) == pytest.approx(row.direction, abs=1e-10)
        assert other.sense * np.array(found.principal.axes[other.axis
                                                           - 1]) == pytest.approx(other.direction, abs=1e-12)
        assert R.T @ np.array(other.torque) == pytest.approx(row.torque, rel=1e-9, abs=1e-15)
        assert np.abs(other.torque_principal) == pytest.approx(np.abs(row.torque_principal), rel=1e-8)
        assert other.time_to_limit == pytest.approx(row.time_to_limit,
                                                    rel=1e-9) and other.largest_rate == pytest.approx(
                                                        row.largest_rate, rel=1e-9)
