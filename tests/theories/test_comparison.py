"""Tests of `theories/theory.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import numpy as np

import stabilab
from stabilab.theories.theory import side_by_side


def liquid_case(folder, torque):
    path = folder / "case.toml"
    path.write_text("[body]\ninertia = [9.2, 9.1, 9]\n[effects.gyrostat]\nmomentum = [0, 0, "
                    "0.1]\n[effects.resistance]\ncoefficient = 0.001\n"
                    f"[effects.constant_torque]\ntorque = {torque}\n[motion]\nangular_velocity = [1, 0.2, "
                    f"1]\nspan = [0, 20]\n")
    return stabilab.load(path)


def test_a_model_that_does_not_fit_is_named_with_its_reason_beside_those_that_do(tmp_path):
    times = np.linspace(0, 20, 9)
    runs, refused = side_by_side(liquid_case(tmp_path, [500, 300, 0]), times)
    assert "exact" in runs
    assert all("small disturbances" in refused[model].text() for model in ("averaged1", "averaged2"))
    runs, _ = side_by_side(liquid_case(tmp_path, [0, 0, -0.006]), times)
    exact, gaps = runs["exact"].state["omega"], {}
    for name in ("averaged1", "averaged2"):
        gaps[name] = np.abs(np.hypot(*(runs[name].state["omega"] - exact)[:, :2].T)).max()
    assert gaps["averaged2"] < 0.2 * gaps["averaged1"] < 0.1  # eps = 0.03: each order is worth a factor of it
