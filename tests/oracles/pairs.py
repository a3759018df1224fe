"""The same problem twice: as stabilab's scene and as an oracle's model. (The only file here that imports
stabilab.)"""
from __future__ import annotations

from functools import lru_cache

import mpmath as mp
import numpy as np
import pytest

import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, ScaledGyrostat, Scene
from stabilab.answers.motion import Needs
from stabilab.answers.motion import motion as known_of
from tests.oracles import energy, model
from tests.oracles.energy import motion_of

WORDS = {"bounded": 0, "spin-up": 1, "separatrix": 2, "equilibrium": 3, "undecided": 4}
PAPER_BODY = (2000.0, 1500.0, 1000.0)  # Amer et al. 2024, section "Numerical results"


def physical(inertia, momentum=(0.0, 0.0, 0.0), torque=(0.0, 0.0, 0.0)):
    """(scene, model) of a body in physical variables; an effect that is zero is left out of the scene."""
    inertia, momentum, torque = (tuple(map(float, v)) for v in (inertia, momentum, torque))
    effects = [Gyrostat(momentum)] if any(momentum) else []
    effects += [ConstantTorque(torque)] if any(torque) else []
    return Scene(Body(inertia), *effects), model.physical(inertia, momentum, torque)


def scaled(a, b, mu):
    """(scene, model) of the dimensionless system."""
    a, b, mu = float(a), float(b), tuple(map(float, mu))
    return ScaledGyrostat(a, b, mu), model.scaled(a, b, mu)


def model_of(scene):
    """The oracle's model of a scene, from its exact numbers."""
    if scene.variables == "scaled":
        return model.scaled(*scene.exact_ab, scene.exact_mu)
    return model.physical(scene.body.exact, scene.vector("gyrostat"), scene.vector("constant_torque"))


def paper(lambda1, mu):
    """The paper's body in its scaled variables: a = lambda1/500, b = lambda1/250 (u = 1)."""
    return scaled(lambda1 / 500, lambda1 / 250, mu)


def brink(problem, perpendicular, distance, sense=1, digits=60):
    """The double state nearest to relative distance `distance` from the separatrix in the torque axis's
    component, above the given perpendicular pair (j, k cyclic after the axis); None where no barrier stands
    ahead of it."""
    axis = axis_of(problem)
    state = [0.0, 0.0, 0.0]
    state[(axis + 1) % 3], state[(axis + 2) % 3] = perpendicular
    with mp.workdps(digits):
        height = barrier_ahead(problem, tuple(map(float, state)), digits)
        if height is None:
            return None
        state[axis] = float(sense * mp.sqrt(2 * height) * (1 + mp.mpf(distance)))
    return tuple(state)


@lru_cache(maxsize=512)
def barrier_ahead(problem, state, digits):
    """Height over a state without spin of the barrier in the torque's direction; None where none stands
    higher."""
    motion = motion_of(problem, state, digits, None)
    forward = 1 if motion.tilt > 0 else -1
    marks = motion._ahead(forward)[0] if motion.kind == "elliptic" else motion.stationary()
    heights = [-motion.W(t) for t, kind in marks if kind == "saddle"]
    return max(heights) if heights and max(heights) > 0 else None


def axis_of(problem):
    """The axis of the torque."""
    return next(i for i in range(3) if problem.m[i])


def assert_margin(problem, state, got, digits=60):
    """To 1e-12 of its two terms, the height of the barrier over the state and the kinetic energy; without a
    barrier nothing holds a motion on a circle or a pure spin, and walls hold every other."""
    exact, axis = energy.margin(problem, state, digits=digits), axis_of(problem)
    if exact is None:
        circle = problem.kappa[axis - 1] * problem.kappa[axis - 2] < 0
        held = not circle and not motion_of(problem, tuple(state), digits, None).at_centre
        assert got == (np.inf if held else -np.inf), state
        return
    exact, kinetic = float(exact), 0.5 * float(problem.weight[axis]) * float(state[axis]) ** 2
    assert abs(got - exact) <= 1e-12 * (abs(exact + kinetic) + kinetic), [float(v).hex() for v in state]


def assert_extremes(got, exact, tolerance):
    """Relative to the larger of a component's two finite extremes, or to the whole motion's where both nearly
    vanish."""
    exact = as_floats(exact)
    finite = np.isfinite(exact)
    np.testing.assert_array_equal(np.where(finite, 0.0, got), np.where(finite, 0.0, exact))
    for row in range(3):
        size = np.max(np.abs(exact[row][finite[row]]), initial=0.0)
        off = np.abs(got[row][finite[row]] - exact[row][finite[row]])
        assert np.all(off <= tolerance * size), (row, got[row], exact[row], off)


def agrees(pair, states, digits=120, tolerance=1e-11, extremes=True, period=True, margins=True):
    """Fates with axis and sense, margins, extremes and (bounded) periods of arrays, and the fate and extremes
    of each state alone, are the potential's. Returns the words."""
    scene, problem = pair
    states = np.atleast_2d(np.asarray(states, float))
    words = [energy.label(problem, tuple(s), digits=digits) for s in states.tolist()]
    found, free = stabilab.fate(scene, states), not any(problem.m)
    np.testing.assert_array_equal(found.labels, [WORDS[w] for w in words])
    if not free:
        axis, spins = axis_of(problem), found.labels == WORDS["spin-up"]
        np.testing.assert_array_equal(found.axis, np.where(spins, axis + 1, 0))
        np.testing.assert_array_equal(found.sense, np.where(spins, 1 if problem.m[axis] > 0 else -1, 0))
    assert not np.any(np.isnan(found.margins))
    boxes = stabilab.extremes(scene, states) if extremes else [None] * len(states)
    periods = stabilab.period(scene, states) if period and extremes else [None] * len(states)
    for state, word, margin, box, time in zip(states.tolist(), words, found.margins, boxes, periods):
        if margins and not free and word != "equilibrium":
            assert_margin(problem, state, margin, digits)
        alone = known_of(scene, state, needs=Needs.QUICK)
        assert alone.fate == WORDS[word]
        if extremes and word in ("bounded", "spin-up"):
            exact = energy.extremes(problem, state, digits=digits)
            assert_extremes(box, exact, tolerance)
            assert_extremes(np.array(alone.extremes), exact, tolerance)
        if time is not None and word == "bounded":
            exact = float(energy.period(problem, state, digits=digits))
            assert time == pytest.approx(exact, rel=tolerance), [v.hex() for v in state]
    return words


def as_floats(rows):
    """Nested list of mpf -> array of doubles."""
    return np.array([[float(v) for v in row] for row in rows])


def random_body(rng, decades=0.0):
    """Three moments obeying the triangle inequality strictly, in random order, over the given decades of
    shape."""
    parts = 10.0 ** rng.uniform(-decades / 2, decades / 2, 3) + rng.uniform(0.1, 1.0, 3)
    return tuple(float(parts.sum() - p) for p in parts)


def exactly(*digits):
    return tuple(map(float.fromhex, digits))
