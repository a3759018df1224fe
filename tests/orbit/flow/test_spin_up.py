"""Tests of `orbit/spin_up.py`: what once went wrong there, and its edges."""
from __future__ import annotations

import numpy as np
import pytest

import stabilab.errors
from tests.hunt.disagreements import many_digits
from tests.oracles.pairs import exactly, physical, scaled


def test_a_spin_up_right_after_its_start_keeps_its_digits():
    """Times of 1e-5 were rounded as the first panel's, of 0.02: state and turning point alike."""
    pytest.importorskip("heyoka")
    scene, problem = scaled(9.479769349702506e-07, 0.10987514343463459, (0, 0, -1578.4457526491535))
    state, time = exactly("-0x1.8a6be3ad360dbp-10", "-0x1.e20214f3add70p-9",
                          "0x1.3c3a0fd9e7febp-8"), 9.170863574031019e-06
    for times in ([time], [1e-9, time, 1.0]):
        found = stabilab.trajectory(scene, state, times, "reduced", laws=False).states[times.index(time)]
        np.testing.assert_allclose(found, many_digits(problem, state, time), rtol=2e-15)


@pytest.mark.slow
def test_the_turn_of_a_weak_torque_is_found_however_far_the_closed_form_misses_it():
    """Kinetic energies that differ by 566 times a turn's work: the closed form put the state 34 turns off,
    and six steps were allowed, so that every time gave the same state."""
    pytest.importorskip("heyoka")
    scene, problem = physical((31.610784781597445, 0.12234569421294594, 31.669797485260553),
                              (-0.0008274331001740387, 0, -0.05664983777634915),
                              (0, 4.689574128199178e-10, 0))
    state = exactly("0x1.673b47b8eb863p-16", "-0x1.d16a694d0739bp-10", "0x1.da60250140c47p-10")
    times = [1.0, 1000.0, 2313.454285820329, 40000.0, 114717.5, 150000.0, 300000.0]
    many = stabilab.trajectory(scene, state, times, "reduced", laws=False).states
    for n, time in enumerate(times):
        one = stabilab.trajectory(scene, state, [time], "reduced", laws=False).states[0]
        exact = many_digits(problem, state, time)
        # rounding of the start counts as many times as there are turns of 2 pi, some fifty, on the way back
        # to rest
        np.testing.assert_allclose([one, many[n]], [exact, exact], rtol=0, atol=1e-12 * np.abs(exact).max())
