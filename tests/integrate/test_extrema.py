"""Tests of `integrate/events.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import numpy as np
import pytest

from stabilab import Body, ScaledGyrostat, Scene
from stabilab.integrate import events as rate_roots


def test_roots_of_rates_without_a_run_or_a_compiler_are_those_of_the_start(monkeypatch):
    scene, state = ScaledGyrostat("0.2", "0.4", (0, 0, 1)), np.array([2.5, 4.0, 0.1])
    fast = rate_roots.roots_of_rates(scene, state, 3.0)
    monkeypatch.setattr(rate_roots, "heyoka_available", lambda: False)
    slow, none = rate_roots.roots_of_rates(scene, state, 3.0), rate_roots.roots_of_rates(scene, state, 0.0)
    assert fast.method == "taylor" and slow.method == "DOP853" and not len(
        none.t) and none.end.tolist() == state.tolist()
    np.testing.assert_allclose(slow.t, fast.t, rtol=1e-8)
    np.testing.assert_allclose(slow.end, fast.end, rtol=1e-8)


@pytest.mark.parametrize("compiled", [True, False])
def test_a_run_whose_numbers_overflow_is_stopped(compiled, monkeypatch):
    if not compiled:
        monkeypatch.setattr(rate_roots, "heyoka_available", lambda: False)
    with np.errstate(all="ignore"):
        # rates of 1e400
        found = rate_roots.roots_of_rates(Scene(Body((3, 2, 1))), np.array([1e200, 1e200, 1e200]), 1.0)
    assert "stopped" in found.reason and found.t_reached < 1 and np.isfinite(found.end).all()
