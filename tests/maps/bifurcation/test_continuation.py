"""Folds of a generic continuation package (bice, pseudo-arclength) are folds of the diagram, and it meets
every fold of the diagram."""
from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import stabilab
from tests.maps.bifurcation.test_line import written

bice = pytest.importorskip("bice", reason="the extra strength brings it")
pytestmark = pytest.mark.slow
STEPS, STEP = 1500, 0.02


def followed(residual, start, parameter, low, high):
    """(turning points of the parameter, where the branch left) from a start to both sides: each a parabola
    through three steps."""
    from bice.continuation import PseudoArclengthContinuation

    class Balance(bice.Equation):
        def __init__(self):
            super().__init__()
            self.u = np.array(start, float)
            self.parameter = parameter

        def rhs(self, u):
            return residual(u, self.parameter)

    turns = []
    for sense in (1, -1):
        problem, equation = bice.Problem(), Balance()
        problem.add_equation(equation)
        problem.settings.use_sparse_matrices = False
        problem.continuation_parameter = (equation, "parameter")
        problem.continuation_stepper = PseudoArclengthContinuation(sense * STEP)
        problem.continuation_stepper.ds_max = STEP
        values = [parameter]
        for _ in range(STEPS):
            problem.continuation_stepper.step(problem)
            problem.history.update(history_type="continuation")
            values.append(equation.parameter)
            if not low < values[-1] < high or np.abs(problem.u).max() > 50:
                break
        for a, b, c in zip(values, values[1:], values[2:]):
            if (b - a) * (c - b) < 0 and low < b < high:
                turns.append(b + (a - c) ** 2 / (8 * (2 * b - a - c)) if 2 * b != a + c else b)
    return turns


def agree(found, residual, low, high):
    """Every turning point that any branch leads to is a fold, and every fold is such a turning point."""
    folds = [event.value for event in found.events if "fold" in event.kinds]
    seen = []
    for piece in found.pieces:
        for state in piece.states:
            seen += followed(residual, state.at, float(piece.sample), low, high)
    for turn in seen:
        assert min(abs(turn - fold) for fold in folds) < 2e-3, (turn, folds)
    for fold in folds:
        assert min(abs(turn - fold) for turn in seen) < 2e-3, (fold, seen)
    return len(folds)


@pytest.mark.parametrize("seed", range(8))
def test_folds_off_the_axes_are_those_of_a_continuation_package(tmp_path, seed):
    rng = np.random.default_rng(seed)
    D, M = (3, 2, Fraction(3, 2)), [Fraction(int(v), 8) for v in rng.choice([-3, -2, -1, 1, 2, 3], 3)]
    lam, i = [Fraction(int(v), 8) for v in rng.integers(-8, 9, 3)], int(rng.integers(3))
    low, high = -3, 3
    found = stabilab.bifurcation(written(tmp_path, D, lam, M), {f"momentum[{i + 1}]": (low, high)})
    moments, wheel, torque = (np.array([float(v) for v in row]) for row in (D, lam, M))

    def residual(u, parameter):
        own = wheel.copy()
        own[i] = parameter
        return np.cross(moments * u + own, u) + torque
    agree(found, residual, low, high)


@pytest.mark.parametrize("seed", range(8))
def test_folds_on_a_motions_circle_are_those_of_a_continuation_package(tmp_path, seed):
    rng = np.random.default_rng(seed)
    D, lam = (Fraction(3), Fraction(2),
              Fraction(3, 2)), [Fraction(int(v), 4) for v in rng.integers(-4, 5, 2)] + [Fraction(0)]
    omega = [Fraction(int(v), 4) for v in rng.integers(-6, 7, 3)]
    low, high = Fraction(1, 100), 4
    found = stabilab.bifurcation(written(tmp_path, D, lam, (0, 0, 1), omega), {"torque[3]": (low, high)})
    d, l, w = (np.array([float(v) for v in row]) for row in (D, lam, omega))
    # |H|^2 - 2 D3 T across axis 3, which is kept
    level = lambda u: ((d[:2] * u + l[:2]) ** 2).sum() - d[2] * (d[:2] * u * u).sum()
    residual = lambda u, torque: np.array([np.cross([*(d[:2] * u[:2] + l[:2]), 0], [*u[:2], 0])[2] + torque,
                                           level(u[:2]) - level(w[:2]), u[2]])
    assert agree(found, residual, float(low), high) >= 1 or len(found.pieces) == 1
