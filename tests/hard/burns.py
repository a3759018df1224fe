"""Burns: by when thrusters must close."""
from __future__ import annotations

from fractions import Fraction

import mpmath as mp
from scipy.integrate import solve_ivp

import stabilab
from tests.hard.row import numbers
from tests.oracles import model, taylor

D, TORQUE, START = (3, 2, Fraction(3, 2)), (0, Fraction(3, 50), Fraction(-9, 200)), (0.0625, -0.125, 0.03125)
FIRES, PERIOD = 3, 4  # s
CASE = """body.inertia = [3, 2, 1.5]
motion.angular_velocity = {}
[[thrusters]]
position = [1, 0, 0]
direction = [0, -3, -4]
force = 0.075
period = 4
on_time = 3
stop = 60
"""


def largest(w):
    """g of a free motion through w, at whose passage of omega2 = 0 (axis 2 is the middle one) energy and
    momentum leave two squares."""
    energy, momentum = (sum(mp.mpf(d) ** n * v * v for d, v in zip(map(float, D), w)) for n in (1, 2))
    a, _, c = map(mp.mpf, (3, 2, 1.5))
    return mp.sqrt((energy * (a + c) - momentum) / (a * c))


def follow(w, length, torque):
    return taylor.integrate(model.physical(D, torque=torque), w, [length], digits=30)[0]


def closing(limit):
    """The latest closing time: g(t) = limit. Naive: |omega| = limit along a run at SciPy's tolerances, for the
    rate at closing is what a gyroscope shows."""
    def ask(*start):
        """In 30 digits: over the whole periods, then the root in the pulse."""
        with mp.workdps(40):
            for _ in range(int(near // PERIOD)):
                start = follow(follow(start, FIRES, TORQUE), PERIOD - FIRES, (0, 0, 0))
            late = lambda t: largest(follow(start, t, TORQUE)) - limit
            within = near % PERIOD
            return near - within + mp.findroot(late, (within - 1e-6, within + 1e-6), tol=1e-50)

    def rates(t, w):
        fires = t % PERIOD < FIRES
        return [(m * fires + (D[j] - D[k]) * w[j] * w[k]) / D[i]
                for i, (m, j, k) in enumerate(zip(map(float, TORQUE), (1, 2, 0), (2, 0, 1)))]
    shown = lambda t, w: sum(v * v for v in w) - limit**2
    run = solve_ivp(rates, (0, 60), START, max_step=0.1, events=shown)
    near = stabilab.burn(CASE.format(list(START)), below=limit).latest.low
    return numbers(f"thrusters in pulses, limit {limit:g} rad/s", "latest closing time",
                   "the rate at closing, not the largest one of the motion after it",
                   run.t_events[0][0], near, ask, START)
