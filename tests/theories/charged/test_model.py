"""The charged body's models: which scenes have them, and which numbers have no meaning in the typed one."""
from __future__ import annotations

import numpy as np
import pytest

import stabilab
from stabilab.errors import InputError
from stabilab.theories.charged import printed
from stabilab.theories.charged_modes import ChargedBody
from stabilab.theories.follow import models_of
from stabilab.theories.theory import side_by_side


def followed(tmp_path, effect, rates):
    """(case, times, its models' runs) of one body with this effect from these rates."""
    path = tmp_path / "case.toml"
    path.write_text(
        f"[body]\ninertia = [8, 8, 10]\nmass = 5\n{effect}[motion]\nangular_velocity = {rates}\nspan = "
        f"[0, 3]\n")
    case, times = stabilab.load(path), np.linspace(0, 3, 7)
    return case, times, side_by_side(case, times)[0]


def test_a_charged_body_without_an_attitude_has_the_linear_models_rates(tmp_path):
    """p + iq of D1 = D2 = 8, D3 = 10, r = 2, k = 0.3 turns at n = ((10 - 8) 2 - 0.3)/8: Euler's equations
    with Lambda = -k."""
    case, times, runs = followed(tmp_path, "[effects.charge]\ncharge = 0.3\nfield = 1\narm = 1\nangle = 0\n",
                                 [0.02, 0.01, 2])
    assert "linear" in models_of(case.scene) and set(runs) >= {"exact", "linear"}
    turned = (0.02 + 0.01j) * np.exp(1j * (4 - 0.3) / 8 * times)
    for name in ("exact", "linear"):
        omega = runs[name].state["omega"]
        np.testing.assert_allclose(omega[:, 0] + 1j * omega[:, 1], turned, rtol=1e-12, atol=1e-14)


def test_a_pushed_body_without_a_charge_has_the_linear_models_path(tmp_path):
    _, times, runs = followed(tmp_path, "[effects.body_force]\nforce = [0, 0, 3]\n", [0, 0, 2])
    for name in {"exact", "linear"} & set(runs):  # a spin about axis 3 pushed along it: z = F t^2/(2 m)
        np.testing.assert_allclose(runs[name].state["position"][:, 2], 0.3 * times**2, rtol=1e-10, atol=1e-12)
    assert "linear" in runs


@pytest.mark.parametrize("change, words",
                         [({"mass": None}, "mass"), ({"inertia": (11.1, 8.7, 9.0)}, "exceed")])
def test_typed_formulas_are_refused_where_they_have_no_meaning(change, words):
    data = {"inertia": (8.7, 8.9, 11.1), "spin": 1.5, "gyrostat": 1.3, "charge_moment": 0.29,
            "torque": (0.4, -0.2), "rates": (0.1, 0.2),
            "attitude": (0.02, 0.01, 0.3), "force": (1.0, 2.0, 3.0), "mass": 10.0} | change
    with pytest.raises(InputError, match=words):
        printed(ChargedBody(**data), np.linspace(0, 1, 5))
