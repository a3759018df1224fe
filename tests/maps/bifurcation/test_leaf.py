"""Equilibria on the curve that a motion keeps to: counted by brute force on both sides of every event of
random scenes."""
from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import stabilab
from tests.maps.bifurcation.leaf import sign_changes
from tests.maps.bifurcation.test_line import written

# of the range: the pair that has just met is some 1e-3 apart, wider than the grid of the brute force
NEAR = 1e-5


def numbers(rng, size):
    return [Fraction(int(v), size) for v in rng.integers(-2 * size, 2 * size + 1, 3)]


@pytest.fixture
def check(tmp_path):
    def one(seed):
        """Events of one random scene, both sides of each counted."""
        rng = np.random.default_rng(seed)
        i = int(rng.integers(3))
        rows = {"inertia": [Fraction(int(v), 32) for v in rng.integers(36, 60, 3)],
                "momentum": numbers(rng, 8), "torque": [Fraction(0)] * 3,
                "angular_velocity": numbers(rng, 8)}
        if rng.random() < 0.15:
            rows["inertia"][(i + 1) % 3] = rows["inertia"][i]  # a parabola
        rows["momentum"][i], rows["torque"][i] = Fraction(0), Fraction(int(rng.integers(1, 9)), 16)
        if len(set(rows["inertia"])) < 2 or rows["inertia"][(i + 1) % 3] == rows["inertia"][(i + 2) % 3]:
            return 0
        name = list(rows)[int(rng.integers(4))]
        n = i if name == "torque" else int(rng.choice([m for m in range(3) if m != i]))
        row, width = rows[name], Fraction(1, 16) if name == "inertia" else 3
        if name == "inertia" and len(set(row)) < 3:
            return 0
        low, high = row[n] - width, row[n] + width
        path = written(tmp_path, rows["inertia"], rows["momentum"], rows["torque"], rows["angular_velocity"])
        found = stabilab.bifurcation(path, {f"{name}[{n + 1}]": (low, high)})
        for piece in found.pieces:
            off = NEAR * float(high - low)
            if piece.high - piece.low < 4 * off:
                continue
            for value in (piece.low + off, piece.low + 0.38 * (piece.high - piece.low), piece.high - off):
                row[n] = Fraction(value)
                counted = sign_changes(rows["inertia"], rows["momentum"], rows["torque"],
                                       rows["angular_velocity"], i)
                assert counted == piece.count, (seed, name, n, value, [event.value for event in found.events])
        return len(found.events)
    return one


@pytest.mark.slow
@pytest.mark.parametrize("seeds", [range(40), pytest.param(range(40, 1100), marks=pytest.mark.long)])
def test_equilibria_on_a_motions_curve_are_those_that_brute_force_counts(check, seeds):
    assert sum(check(seed) for seed in seeds) > len(seeds) // 3


def test_a_piece_whose_end_is_rounded_outward_is_followed(check):
    assert check(2067) > 0  # two saddles were asked for one double beyond their fold
