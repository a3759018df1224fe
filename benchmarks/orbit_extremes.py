"""Extremes of many bounded orbits."""
from __future__ import annotations

from functools import partial

import numpy as np

from stabilab import extremes, fate

from .contestants import EventExtremes
from .rows import SCENE, A, B, Row, against, random_states
from .timing import side_by_side

WANTED = 20  # times as fast as heyoka with events


def measurements(small=False):
    return [partial(against_events, *((100, 5, 2) if small else (200_000, 4000, 7))),
            partial(against_scipy, *((100, 2, 2) if small else (20_000, 10, 7))),
            partial(beside_the_separatrix, 2 if small else 40)]


def bounded_states(size):
    """States of the usual box that are bounded, and not closer to the separatrix than 1e-3 in energy."""
    states = random_states(int(3.3 * size) + 20)
    return states[fate(SCENE, states).margins > 1e-3][:size]


def against_events(size=20_000, sample=400, rounds=7) -> Row:
    """Extremes of bounded orbits against heyoka with events at the roots of the rates."""
    states = bounded_states(size)
    part = states[:sample]
    events = EventExtremes(A, B)
    timed = side_by_side(lambda: extremes(SCENE, states), lambda: events(part), len(states), len(part),
                         rounds)
    difference = np.abs(extremes(SCENE, part) - events(part)).max() / np.abs(part).max()
    return against("extremes", f"extremes of {len(states)} orbits", timed, "heyoka with events",
                   f"largest relative difference {difference:.1e}", WANTED)


class SciPyEvents:
    """Extremes and period with solve_ivp (DOP853): events at the zeros of each rate, dense output to place
    them, stopped at the third reversal of the turn, which ends a period."""

    def __init__(self, a, b, tolerance=1e-12):
        self.a, self.b, self.tolerance = a, b, tolerance
        rates = self.rates

        def zero_of(k):
            return lambda t, x: rates(t, x)[k]
        self.events = [zero_of(k) for k in range(3)] + [lambda t, x: x[2]]
        self.events[3].terminal = 3

    def rates(self, t, x):
        return x[1] * x[2], -x[2] * (x[0] + self.a), x[1] * (x[0] + self.b) + 1.0

    def __call__(self, states):
        """(extremes (n, 3, 2), periods (n,))."""
        from scipy.integrate import solve_ivp
        boxes, periods = np.empty((len(states), 3, 2)), np.empty(len(states))
        for n, state in enumerate(states):
            run = solve_ivp(self.rates, (0, 1e4), state, method="DOP853", rtol=self.tolerance,
                            atol=self.tolerance,
                            events=self.events)
            seen = np.concatenate([state[None], *(np.reshape(x, (-1, 3)) for x in run.y_events)])
            boxes[n] = np.stack([seen.min(axis=0), seen.max(axis=0)], axis=1)
            periods[n] = run.t_events[3][2] - run.t_events[3][0]
        return boxes, periods


def against_scipy(size, sample, rounds) -> Row:
    """Extremes of bounded orbits against SciPy with events."""
    states = bounded_states(size)
    part = states[:sample]
    events = SciPyEvents(A, B)
    timed = side_by_side(lambda: extremes(SCENE, states), lambda: events(part), len(states), len(part),
                         rounds)
    best = EventExtremes(A, B)(part)
    ours, theirs = (np.abs(box - best).max() / np.abs(part).max()
                    for box in (extremes(SCENE, part), events(part)[0]))
    return against("extremes-scipy", f"extremes of {len(states)} orbits", timed, "SciPy DOP853 with events",
                   f"differs from heyoka by {ours:.1e}, SciPy (1e-12) by {theirs:.1e}", 8000)


def brink(part, count):
    """Bounded states whose energy lies below the barrier's by `part` of it: by bisection in x3 on random
    circles."""
    rng, found = np.random.default_rng(20261121), []
    while len(found) < count:
        x1, x2 = rng.uniform(-4, 4, 2)
        still = fate(SCENE, np.array([x1, x2, 0.0]))
        if still.labels == 0 and np.isfinite(still.margins) and still.margins > 0.1:
            found.append((x1, x2, np.sqrt(2 * float(still.margins) * (1 - part))))
    return np.array(found)


def beside_the_separatrix(count) -> Row:
    """Errors at relative distances 1e-3 ... 1e-15 against ball arithmetic, and the time there against
    heyoka's."""
    from stabilab.orbit.extremes import precise_extremes
    from stabilab.orbit.extremes_arrays import extremes_and_periods
    from stabilab.orbit.landscape import landscape
    from stabilab.orbit.one_orbit import Orbit
    from stabilab.orbit.period import precise_period
    r, boxes_off, periods_off, states = landscape(SCENE).reduction, [], [], []
    for decade in (3, 6, 9, 12, 15):
        part = brink(10.0**-decade, count)
        part = part[fate(SCENE, part).labels == 0]
        got, periods = extremes_and_periods(SCENE, part, by_numba=True)
        exact = np.array([precise_extremes(Orbit(r, state), 0) for state in part])
        spans = np.array([precise_period(Orbit(r, state), 0) for state in part])
        boxes_off.append((np.abs(got - exact).max(axis=2) / np.abs(exact).max(axis=2)).max())
        periods_off.append(np.abs(periods / spans - 1).max())
        if decade <= 9:  # closer, heyoka's run may pass the barrier by rounding and then spin up without end
            states.append(part)
    states, events = np.concatenate(states), EventExtremes(A, B)
    timed = side_by_side(lambda: extremes(SCENE, states), lambda: events(states), len(states), len(states), 2)
    words = ", ".join(f"{x:.0e}/{t:.0e}" for x, t in zip(boxes_off, periods_off))
    return against("extremes-brink", "extremes next to the separatrix", timed, "heyoka with events",
                   f"of extremes/periods at 1e-3, -6, -9, -12, -15 of the barrier: {words}",
                   note="timed at 1e-3, 1e-6 and 1e-9 of the barrier alike")
