"""Brute force: Euler's equations with a wheel, a constant torque and a direction at rest in space, typed in
here once more, by heyoka in long doubles. Shares no code with stabilab."""
from __future__ import annotations

from functools import lru_cache

import numpy as np

REAL = np.longdouble


@lru_cache(maxsize=1)
def _integrator():
    import heyoka
    w, n, p = heyoka.make_vars("w1", "w2", "w3"), heyoka.make_vars("n1", "n2", "n3"), heyoka.par
    H = [p[i] * w[i] + p[3 + i] for i in range(3)]
    rates = [(p[6 + i] + H[j] * w[k] - H[k] * w[j]) / p[i] for i,
             (j, k) in enumerate(((1, 2), (2, 0), (0, 1)))]
    turns = [n[j] * w[k] - n[k] * w[j] for j, k in ((1, 2), (2, 0), (0, 1))]
    excess = sum(p[9 + i] * w[i]**2 for i in range(3)) + sum(p[12 + i] * n[i] for i in range(3)) - p[15]
    stop = heyoka.t_event(excess, fp_type=REAL)
    return heyoka.taylor_adaptive(list(zip([*w, *n], rates + turns)), np.zeros(6, REAL), t_events=[stop],
                                  fp_type=REAL)


def first_crossing(D, wheel, torque, start, limit, t_max):
    """The first time in (0, t_max] at which sum c_i w_i^2 + k . n, n = k at the start, is the limit's value;
    None where there is none.

    limit: (c, k, value), three numbers, three numbers, one.
    """
    c, k, value = limit
    ta = _integrator()
    ta.reset_cooldowns()
    ta.pars[:] = np.array([*D, *wheel, *torque, *c, *k, value], REAL)
    ta.time = REAL(0)
    ta.state[:] = np.array([*start, *k], REAL)
    outcome = ta.propagate_until(REAL(t_max))[0]
    return None if outcome.name == "time_limit" else ta.time
