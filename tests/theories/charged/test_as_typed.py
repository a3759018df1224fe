"""Tests of `theories/charged/as_typed.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import numpy as np
import pytest

from stabilab.errors import InputError
from stabilab.theories.charged.model import printed
from stabilab.theories.charged.modes import ChargedBody


@pytest.mark.parametrize("change, words",
                         [({"mass": None}, "mass"), ({"inertia": (11.1, 8.7, 9.0)}, "exceed")])
def test_typed_formulas_are_refused_where_they_have_no_meaning(change, words):
    data = {"inertia": (8.7, 8.9, 11.1), "spin": 1.5, "gyrostat": 1.3, "charge_moment": 0.29,
            "torque": (0.4, -0.2), "rates": (0.1, 0.2),
            "attitude": (0.02, 0.01, 0.3), "force": (1.0, 2.0, 3.0), "mass": 10.0} | change
    with pytest.raises(InputError, match=words):
        printed(ChargedBody(**data), np.linspace(0, 1, 5))
