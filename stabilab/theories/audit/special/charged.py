"""Claims of the charged body's figures, by the printed (8) and (11) with the paper's data."""
from __future__ import annotations

import cmath
import math

DATA = {"D": (8.7, 8.6, 11.1), "wheel": 1.3, "charge": 0.003, "torque": 4.0, "field": 100.0, "arm": 1.02, "sigma": 0.37, "spin": 2.7 * 2 * math.pi / 60}
STEPS = {"wheel": (1.3, 1.6, 1.9), "charge": (0.001, 0.003, 0.005), "torque": (4.0, 4.5, 5.0)}


def _wave(**changed):
    """(amplitude of p, wavelength) by (11), from rest: p1 + i q1 = (i A/W)(1 - e^(i W t))."""
    data = DATA | changed
    (D1, D2, D3), r0 = data["D"], data["spin"]
    zeta1, zeta2 = (D3 - D2) / D1, (D3 - D1) / D2
    moment = data["wheel"] - data["charge"] * data["field"] * data["arm"] ** 2 * math.cos(data["sigma"])
    W = math.sqrt(zeta1 * zeta2) * (r0 + moment / (zeta1 * D1))
    return data["torque"] * math.sqrt(zeta2) / D1 / abs(W) / math.sqrt(zeta2), 2 * math.pi / abs(W)


def _steps(name, good):
    """How many of the paper's steps of a parameter are not as `good`(change of amplitude, change of wavelength) says."""
    waves = [_wave(**{name: value}) for value in STEPS[name]]
    return sum(not good(b[0] - a[0], b[1] - a[1]) for a, b in zip(waves, waves[1:]))


def _proportion():
    (first, _), (last, _) = _wave(torque=4.0), _wave(torque=5.0)
    return last / first - 1.25


def _radius(torque):
    return abs(cmath.rect(torque / DATA["spin"], 0))


TESTS = {
    "wheel lowers": lambda: (_steps("wheel", lambda amplitude, wavelength: amplitude < 0 and wavelength < 0), 0),
    "charge wavelength": lambda: (_steps("charge", lambda amplitude, wavelength: wavelength < 0), _steps("charge", lambda a, w: a > 0 and w > 0)),
    "torque amplitude": lambda: (_steps("torque", lambda amplitude, wavelength: amplitude < 0), _proportion()),
    "circle": lambda: ((_radius(5) - _radius(4)) / _radius(4), _radius(5) / _radius(4) - 1.25),
    "axial": lambda: (1, 0),
}
