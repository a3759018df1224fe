"""Claims about the liquid's figures that no formula says, by the averaged frequency (d r - g)/J0 and the paper's data."""
from __future__ import annotations

import math

J0, EPS, FIELD, ARM, THETA = 9.0, 0.1, 100.0, 0.01, 0.3
D1, D2 = (9.51 - J0) / EPS, (9.3 - J0) / EPS


def _frequency(wheel, charge=0.01, r=1.0):
    """omega of (11) in the slow time; imaginary ones by their size."""
    g = (wheel - charge * FIELD * ARM**2 * math.cos(THETA)) / EPS
    return math.sqrt(abs((D2 * r - g) * (D1 * r - g))) / J0


def _wheel():
    """Steps of lambda3 in the paper's two sets at which the frequency does not grow, and those at which it grows although g stays below d r."""
    falls = rises_below = steps = 0
    for values in ((0.1, 0.15, 0.2), (15, 20, 25)):
        for a, b in zip(values, values[1:]):
            grows, above = _frequency(b) > _frequency(a), (a / EPS) > max(D1, D2)
            falls, rises_below, steps = falls + (not grows), rises_below + (grows != above), steps + 1
    return falls / steps, rises_below / steps


def _mass():
    """Moment of inertia of the liquid as a sphere, 2/5 m h^2, over the body's, less 1; the true statement: positive."""
    radius = (1.9 * 525 / (8 * math.pi)) ** (1 / 7)
    moment = 2 / 5 * 1250 * 4 / 3 * math.pi * radius**3 * radius**2
    return moment / J0 - 1, 0.0


TESTS = {
    "mass": _mass,
    "wheel frequency": _wheel,
    "resistance": lambda: (float(math.exp(-EPS * 1.5) > math.exp(-EPS * 2.5)), 0.0),
    "charge": lambda: (abs(_frequency(0.1, 1e4) / _frequency(0.1, 0.01) - 1), 0.0),
}
