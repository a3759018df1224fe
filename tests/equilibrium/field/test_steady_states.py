"""Tests of `equilibrium/field/steady_states.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import numpy as np
import pytest

from stabilab import Scene
from stabilab.answers.equilibria import equilibria
from stabilab.errors import InputError
from tests.shared import case


def test_a_curve_of_steady_states_has_no_point_at_its_ends():
    attitude = case("charged-body-attitude")
    turning = Scene(attitude.scene.body, *(e for e in attitude.scene.effects if e.name != "body_force"))
    curve = equilibria(turning).curves[0]
    low, high = curve.segments[0].t
    assert len(curve.point(0.5 * (low + high))) == 6
    for end in (low, high, high + 1):
        with pytest.raises(InputError, match="lies at an end"):
            curve.point(end)


@pytest.mark.parametrize("e2, e3, e4", [(5, 0, 4), (5, 0, 6.25), (2, 0, 3), (1, 0, -1), (-5, 0, 4), (-2, 0, 1), (3, 0, 0), (5, 1, 4),
                                        (5, -1, 4), (0, 0, 0)])
def test_steady_states_of_a_torque_are_told_by_their_quartic(e2, e3, e4):
    from flint import arb

    from stabilab.equilibrium.field_states import _verdict
    roots = np.roots([1, 0, e2, -e3, e4])
    simple = min(abs(a - b) for n, a in enumerate(roots) for b in roots[:n]) > 1e-3
    word = "unstable" if roots.real.max() > 1e-3 else "stable" if simple else "degenerate"
    assert _verdict(arb(e2), arb(e3), arb(e4))[0] == word
