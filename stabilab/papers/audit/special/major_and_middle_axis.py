"""Amer et al. 2024: torque on the major axis (eqs (41)-(43), Figs 8-15) and on the middle axis (eqs
(44)-(84))."""
from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from ....answers.simulate import trajectory
from ....physics.coefficients import scaling
from ....physics.scene import Body, ScaledGyrostat
from .any_torque import major_axis_ideal
from .constant_torque import middle_equilibria, misjudged
from .trend import side, trend

# Figs 8-11: ranges of x2 and x3 over tau in [0, 15] from (4.5, 1.8, 3.4); lambda1 -> ((x2), (x3)); printed in
# the
# text, and from the equations (Taylor integration; the smallest and largest value of the dense output).
RANGES_PRINTED = {100: ((-4, 4), (-4.1, 4)), 300: ((-4.2, 4), (-5, 4)), 500: ((-4.5, 4), (-6, 4))}
RANGES_TRUE = {100: ((-3.8126, 3.8127), (-3.8591, 3.8642)), 300: ((-3.7568, 3.7571), (-3.8839, 3.8946)),
               500: ((-3.7127, 3.7123), (-3.9075, 3.9206))}


def _ranges(table):
    """Largest distance of the table's ranges from those of the motion."""
    worst = 0.0
    for lam, limits in table.items():
        run = trajectory(ScaledGyrostat(lam / 500, lam / 250, (1, 0, 0)), (4.5, 1.8, 3.4),
                         np.linspace(0, 15, 60001))
        for row, (low, high) in zip((1, 2), limits):
            states = np.asarray(run.states)[:, row]
            worst = max(worst, abs(states.min() - low), abs(states.max() - high))
    return worst


STARTS = {"8": (4.5, 1.8, 3.4), "12": (0.0, -1.0, 5.0)}  # of Figs 8-11 and 12-15
QUANTITIES = {"least x1": lambda x: x[:, 0].min(), "least x3": lambda x: x[:, 2].min(),
              "width of x1": lambda x: np.ptp(x[:, 0]), "last x1": lambda x: x[-1, 0],
              "sign changes of x2": lambda x: int((np.diff(np.sign(x[:, 1])) != 0).sum())}


@lru_cache
def _quantity(name, figure, lambda1, end=15):
    """A quantity of the motion of Fig. 8 or 12 over tau in [0, end]."""
    run = trajectory(ScaledGyrostat(lambda1 / 500, lambda1 / 250, (1, 0, 0)), STARTS[figure],
                     np.linspace(0, end, 15001))
    return float(QUANTITIES[name](np.asarray(run.states)))


def _trend(quantity, figure, goes, truth="", wheels=(100, 300, 500)):
    return trend([_quantity(quantity, figure, lam) for lam in wheels], goes, truth)


def _side(quantity, figure, lambda1, lies):
    return side(_quantity(quantity, figure, lambda1), lies)


def _spins_up():
    """How many of the motions of Fig. 8 do not gain 100 of x1, to 1 %, over tau from 300 to 400."""
    gains = [_quantity("last x1", "8", lam, 400) - _quantity("last x1", "8", lam, 300)
             for lam in (100, 300, 500)]
    return sum(abs(gain - 100) > 1 for gain in gains), 0


def _capture():
    """J of the end state minus J of the start, plus 2 c tau: the law that forbids a bounded motion. Fig. 12,
    lambda1 = 100: the print's "stable" would keep J; start (0, -1, 5), tau = 15."""
    c = 0.2
    run = trajectory(ScaledGyrostat(0.2, 0.4, (1, 0, 0)), (0.0, -1.0, 5.0), (0.0, 15.0))
    first, last = (x2 * x2 + x3 * x3 - 2 * c * x1 for x1, x2, x3 in (run.states[0], run.states[-1]))
    return last - first, last - first + 2 * c * 15


def _major_rule():
    """The printed rule on the line of equilibria that a = b has: x1 = -a, x2 x3 = -1."""
    points = [(-0.2, -1 / g, g) for g in (-3, -1.6, -0.6, -0.3, 0.3, 0.6, 1.6, 3)]
    return (misjudged(lambda x: x[2] > 1, points, 0.2, 0.2),
            misjudged(lambda x: abs(x[2]) > abs(x[1]), points, 0.2, 0.2))


def _always_stable():
    """Equilibria with c = 2.5 (a = 0.5, b = 3): share that "all are stable" misjudges."""
    points = middle_equilibria(0.5, (-3, -2, -1.5, -1, -0.8, -0.5, 0.5, 1.5))
    return (misjudged(lambda x: True, points, 0.5, 3.0),
            misjudged(lambda x: (x[0] + 0.5) * (x[0] + 3) + x[2] ** 2 > 0, points, 0.5, 3.0))


def _paper_data_all_stable(line):
    """Share of equilibria misjudged for the paper's data (lambda1 = 100, 300, 500)."""
    total = 0.0
    for lam in (100, 300, 500):
        a, b = lam / 500, lam / 250
        rule = (lambda x: x[0] > x[2]) if line else (lambda x: True)
        total += misjudged(rule, middle_equilibria(a), a, b) / 3
    return total


def _plane_rate(shift):
    """Rate of x1 + shift b - x3 in the plane where it is zero, x2 = 1.3, x3 = 2.5, b = 0.4."""
    b, x2, x3 = 0.4, 1.3, 2.5
    x1 = x3 - shift * b
    return x2 * x3 - x2 * (x1 + b)


def _time_scale():
    """Seconds in one tau, from the scaling of the package (u = 1)."""
    return float(scaling(Body((2000, 1500, 1000)), 1).time)


def _least_quartic(c):
    """Smallest g^4 + c g + 1; zero or less where a saddle exists."""
    g = np.cbrt(-c / 4)
    return float(g**4 + c * g + 1)


def _own_76():
    """Largest rate at the printed (76), a = 0.2, b = 0.4."""
    x = (-0.2 + math.sqrt(0.2**2 + 4)) / 2
    return abs(1 - x * (x + 0.2))


def _spin_plane_rate(c):
    """Largest rate at x3 = -(c + sqrt(c^2-4))/2, x1 + b = -x3, with a = 0, b = c."""
    x3 = -(c + math.sqrt(c * c - 4)) / 2
    x1 = -x3 - c
    return abs(1 - x3 * x1)


TESTS = {
    "major equilibria": lambda: (major_axis_ideal("1/5", "2/5"), major_axis_ideal("1/5", "1/5")),
    "major stability": _major_rule,
    "trend": _trend,
    "side": _side,
    "spin-up": _spins_up,
    # least x2' in the plane x1 + b = -x3, 1 - c^2/4 at c = 0.2: a closed path needs 0; the plane is kept
    "spin-up off the planes": lambda: (1 - 0.2**2 / 4, abs(1.3 * 2.5 + 1.3 * (-2.5 - 0.4 + 0.4))),
    "ranges": lambda: (_ranges(RANGES_PRINTED), _ranges(RANGES_TRUE)),
    "capture": _capture,
    "seconds": lambda: (1 - math.sqrt(1 / 12), _time_scale() - math.sqrt(12)),
    "always stable": _always_stable,
    "three regions": lambda: (_least_quartic(1.0), _least_quartic(4 * 3**-0.75)),
    "middle dividing line": lambda: (_paper_data_all_stable(True), _paper_data_all_stable(False)),
    "equilibria on the cone": lambda: (float(abs(_own_76()) < 1e-12), _own_76()),
    "plane": lambda: (_plane_rate(0), _plane_rate(1)),
    "no equilibrium in the plane": lambda: (max(0.0, 2.5**2 - 4), _spin_plane_rate(2.5)),
}
