"""Scenes for the tests of spin-up, and Euler's equations written anew."""
from __future__ import annotations

import math
import random
from fractions import Fraction

import pytest

from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.numbers.numba_door import installed

numba = pytest.mark.skipif(not installed(), reason="needs numba")
EXAMPLE = Scene(Body((1.4, 1, 0.6)), Gyrostat((0.2, 0.1, -0.3)), ConstantTorque((0.5, 0.6, 0.62)))


def euler(D, l, M, w):
    """omega' from D omega' = M - omega x (D omega + l), in any kind of number."""
    H = [d * v + e for d, v, e in zip(D, w, l)]
    turned = [w[1] * H[2] - w[2] * H[1], w[2] * H[0] - w[0] * H[2], w[0] * H[1] - w[1] * H[0]]
    return [(m - t) / d for m, t, d in zip(M, turned, D)]


def rates_of(scene):
    """omega'(omega) of a physical scene in floats."""
    D, l, M = ([float(v) for v in vector]
               for vector in (scene.body.exact, scene.vector("gyrostat"), scene.vector("constant_torque")))
    return lambda w: euler(D, l, M, w)


def random_scene(rng: random.Random, wheel: float | None = None):
    """A body of random second moments, a torque of unit size, a wheel of size `wheel` (None: 0, 0.1, 1 or
    10)."""
    a, b, c = (Fraction(rng.uniform(.05, 1)) for _ in range(3))
    size = rng.choice((0, .1, 1, 10)) if wheel is None else wheel
    return Scene(Body((b + c, a + c, a + b)), Gyrostat(sphere(rng, size)), ConstantTorque(sphere(rng)))


def sphere(rng, size=1.0):
    """A random vector of a size."""
    v = [rng.gauss(0, 1) for _ in range(3)]
    return tuple(size * x / math.hypot(*v) for x in v)


def run(rate, start, times, rtol=1e-11):
    """States (n, 3) of a motion by SciPy's DOP853."""
    import numpy as np
    from scipy.integrate import solve_ivp
    return solve_ivp(lambda _, y: np.array(rate(y.tolist())), (times[0], times[-1]), start, "DOP853", times,
                     rtol=rtol, atol=1e-12).y.T
