"""Sheets in plain floats: the branches of the arrays, and every place lies on the separatrix."""
from pathlib import Path

import numpy as np
import pytest

from stabilab import load, separatrix, trajectory
from stabilab.orbit.separatrix.saddles import plain_separatrix

CASES = [path for path in sorted((Path(__file__).parents[3] / "cases").glob("*.toml"))
         if load(path).scene.plain]


@pytest.mark.parametrize("path", CASES, ids=lambda p: p.stem)
def test_there_are_the_branches_of_the_arrays_and_their_words(path):
    scene = load(path).scene
    found, words = plain_separatrix(scene, rows=6, half=5)
    arrays = separatrix(scene, shape=(6, 9))
    assert words == arrays.reason and [branch.name
                                       for branch in found] == [branch.name for branch in arrays.branches]
    for branch in found:
        assert len(branch.points) == branch.rows * branch.columns and branch.columns == 9 and branch.rows > 1


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name", ["minor-axis-100", "thruster-stuck-major-axis", "middle-axis-double-well",
                                  "torque-free-gyrostat", "torque-free-body"])
def test_the_motion_from_every_place_all_but_rests_at_a_saddle(name):
    """Followed by an integrator, which knows of no surface: a motion on the separatrix tends to an
    equilibrium, where the rates stand still."""
    scene = load(f"cases/{name}.toml").scene
    form = scene.quadratic()
    for branch in plain_separatrix(scene)[0]:
        for point in branch.points[len(branch.points) // 2 + 3::97]:
            size = np.linalg.norm(point)
            states = trajectory(scene, point, np.linspace(0, 200 / size, 6000)[1:], laws=False).states
            speeds = (np.linalg.norm(form.rate(state)) for state in states.tolist())
            assert min(speeds) < 1e-5 * size**2, point


def test_a_row_runs_once_round_its_loop_and_the_first_is_the_fold():
    branch, *_ = plain_separatrix(load("cases/minor-axis-100.toml").scene, rows=5, half=7)[0]
    rows = np.array(branch.points).reshape(branch.rows, branch.columns, 3)
    assert np.ptp(rows[0],
                  axis=0).max() < 1e-6 and np.allclose(rows[1:, 0],
                                                       rows[1:, -1]) and np.ptp(rows[-1], axis=0).min() > 0.1
