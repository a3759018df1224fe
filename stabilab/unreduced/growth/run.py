"""A run that looks for a certificate of growth."""
from __future__ import annotations

import math

from .certificates import certificate

# Units of rounding by which a step of the run (a Taylor polynomial of 20 terms) may move the motion: generous, for the boundary is met seldom.
STEP_ROUNDINGS = 64
# Steps of the search: several seconds where the fate hangs on it, one or two where only the time of release does.
STEP_BUDGET, RELEASE_BUDGET = 5_000_000, 2_000_000


def search_certificate(c, y, t_max):
    """(certificate or "none", its time, state there, last reversal of the turn, steps): run until one holds."""
    if found := certificate(c, y):
        return found, 0.0, y, 0.0, 0
    if not math.isfinite(sum(v * v for v in y) * (1 + c * c)):
        return "none", None, y, 0.0, 0
    from .steps import runner
    run, t, last, steps = runner(c, y), 0.0, 0.0, 0
    budget = STEP_BUDGET if c < 0 else RELEASE_BUDGET
    while t < t_max and steps < budget:
        t = min(t_max, t + max(1.0 / (1 + abs(c) + max(map(abs, y))), 0.2 * t))
        t, y, reversal, taken = run(t, budget - steps)
        last, steps = reversal if reversal is not None else last, steps + taken
        if not all(map(math.isfinite, y)):
            break
        if found := certificate(c, y):
            return found, t, y, last, steps
    return "none", None, y, last, steps


def nearest_other(c, y, t_max, name, steps):
    """The relative change of the state within the run's rounding that leads to another end; None where there is none."""
    reach = STEP_ROUNDINGS * 2.0**-52 * (steps + 1)
    length = reach * (max(map(abs, y)) + abs(c))
    for i in range(3):
        for move in (-length, length):
            if search_certificate(c, (*y[:i], y[i] + move, *y[i + 1:]), t_max)[0] != name:
                return reach
    return None
