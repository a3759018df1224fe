"""The memory that arrays of states take: their answer, one chunk, and a number a state."""
from __future__ import annotations

import tracemalloc

import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.orbit.fate_arrays import CHUNK

SCENE = Scene(Body((12, 9, 5)), Gyrostat((0.8, 0, 0)), ConstantTorque((0, 0, 0.02)))


def peak_of(question, count):
    """Bytes above the answer itself. States far from all orbits that librate: no row is one of plain Python."""
    states = np.random.default_rng(2).normal(size=(count, 3)) * [1, 1, 0.1] + [0, 0, 50]
    question(SCENE, states[:100])
    tracemalloc.start()
    try:
        answer = question(SCENE, states)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    return peak - np.asarray(getattr(answer, "values", answer.labels if hasattr(answer, "labels") else 0)).nbytes


@pytest.mark.parametrize("question, bytes_of_state", [
    (stabilab.fate, 24), (stabilab.extremes, 16), (stabilab.period, 24)], ids=["fate", "extremes", "period"])
def test_six_more_chunks_cost_no_more_than_some_numbers_a_state(question, bytes_of_state):
    """Counted by Python's allocator. A chunk's own arrays, some thirty of its size, are there once."""
    few, many = peak_of(question, 2 * CHUNK), peak_of(question, 8 * CHUNK)
    assert many - few < bytes_of_state * 6 * CHUNK, (many - few) / (6 * CHUNK)
