"""Motions that only numbers can follow: one against heyoka and SciPy, many against heyoka's batch mode."""
from __future__ import annotations

import math
import time
from functools import partial

import numpy as np

from stabilab import (
    Body,
    Charge,
    ConstantTorque,
    Gravity,
    Gyrostat,
    LiquidCavity,
    Resistance,
    Scene,
    ensemble,
    trajectory,
)
from stabilab.integrate.reference import reference, relative_errors
from stabilab.integrate.to_heyoka import TAYLOR_TOLERANCE

from .contestants import BatchRuns, ScalarRuns, off_axis_rates, with_effects
from .rows import Row, against
from .timing import side_by_side

# no axis or plane is singled out
INERTIA, MOMENT, TORQUE = (3.0, 2.0, 1.5), (0.3, -0.2, 0.5), (0.1, 0.2, 0.1)
OFF_AXIS = Scene(Body(INERTIA), Gyrostat(("0.3", "-0.2", "0.5")), ConstantTorque(("0.1", "0.2", "0.1")))
PLAIN = OFF_AXIS.effects
LIQUID, CHARGE, CENTRE = LiquidCavity("0.05", 1000, "0.01"), 0.2, (0.3, 0.1, 0.2)
OTHERS = {  # what they do besides -> (scene, what the rates by hand need)
    "with a charge": (Scene(Body(INERTIA), *PLAIN, Charge(CHARGE, 1, 1, "0.5")),
                      {"moment": (0.3, -0.2, 0.5 - CHARGE * math.cos(0.5))}),
    "with a charge that follows the attitude": (Scene(Body(INERTIA), *PLAIN,
                                                      Charge(CHARGE, 1, 1, "attitude")), {"turning": CHARGE}),
    "in a resisting medium": (Scene(Body(INERTIA), *PLAIN, Resistance("0.01")), {"c": 0.01}),
    "with a liquid in a resisting medium": (Scene(Body(INERTIA), *PLAIN, LIQUID, Resistance("0.01")),
                                            {"c": 0.01, "kappa": float(LIQUID.exact)}),
    "with weight": (Scene(Body(INERTIA), *PLAIN, Gravity(1, CENTRE)), {"centre": CENTRE}),
    "with weight, liquid and medium": (Scene(Body(INERTIA), *PLAIN, Gravity(1, CENTRE), LIQUID,
                                             Resistance("0.01")),
                                       {"c": 0.01, "kappa": float(LIQUID.exact), "centre": CENTRE})}
START = (0.1, 0.2, 0.3)
SCIPY_RTOL = 1e-12
PACE = "processor time of one thread; eight motions of like pace are integrated together"


def measurements(small=False):
    if small:
        return [partial(against_heyoka, 20.0, 5, 1, 2), partial(against_scipy, 5.0, 1, 2),
                partial(against_batch, 20, 5.0, 3, 2),
                *(partial(with_other_effects, name, 20, 2.0, 3, 2) for name in OTHERS)]
    return [partial(against_heyoka, 1000.0, 1000, 1), partial(against_heyoka, 100.0, 100, 20), against_scipy,
            against_batch, *(partial(with_other_effects, name) for name in OTHERS)]


def against_heyoka(span, count, repeats, rounds=7) -> list[Row]:
    """`trajectory` without and with the laws against heyoka as written by hand, at the same tolerance and
    times."""
    times, raw = np.linspace(0, span,
                             count), ScalarRuns(off_axis_rates(INERTIA, MOMENT, TORQUE), TAYLOR_TOLERANCE)
    found, theirs = [], raw(START, times)
    for laws in (False, True):
        run = trajectory(OFF_AXIS, START, times, laws=laws)
        timed = side_by_side(lambda laws=laws: [trajectory(OFF_AXIS, START, times, laws=laws)
                                                for _ in range(repeats)],
                             lambda: [raw(START, times) for _ in range(repeats)], repeats, repeats, rounds,
                             time.thread_time)
        apart = np.abs(run.states - theirs).max() / np.abs(theirs).max()
        found.append(against(f"trajectory-{'long' if span >= 1000 else 'short'}{'-laws' * laws}",
                             f"trajectory off the axes, {span:g} s, {count} times, {run.counters['steps']} "
                             f"steps, laws {'' if laws else 'un'}checked", timed, "heyoka by hand",
                             f"same tolerance and steps; states {apart:.0e} apart",
                             1 / 1.15 if span >= 1000 else 1 / 1.3,
                             "the laws' integrals are integrated with the motion and compared at every time"
                             if laws else "processor time of one thread; a short run is mostly the reading "
                             "and checking of its input" if span < 1000 else "processor time of one thread"))
    return found


def against_scipy(span=300.0, repeats=10, rounds=7) -> Row:
    """`trajectory`, laws unchecked, against SciPy's DOP853 with the rates as a Python function; errors
    against many digits."""
    from scipy.integrate import solve_ivp
    times = np.linspace(0, span, 101)
    (D1, D2, D3), (h1, h2, h3), (M1, M2, M3) = INERTIA, MOMENT, TORQUE

    def rates(_, w):
        a, b, c = D1 * w[0] + h1, D2 * w[1] + h2, D3 * w[2] + h3
        return (b * w[2] - c * w[1] + M1) / D1, (c * w[0] - a * w[2]
                                                 + M2) / D2, (a * w[1] - b * w[0] + M3) / D3

    slow = lambda: solve_ivp(rates, (0, span), START, "DOP853", times, rtol=SCIPY_RTOL, atol=SCIPY_RTOL).y.T
    fast = lambda: trajectory(OFF_AXIS, START, times, laws=False).states
    timed = side_by_side(lambda: [fast() for _ in range(repeats)], slow, repeats, 1, rounds)
    exact = reference(OFF_AXIS, START, times)
    errors = [relative_errors(states, exact.states, exact.rest, exact.slices).max()
              for states in (fast(), slow())]
    return against("trajectory-scipy", f"trajectory off the axes, {span:g} s, laws unchecked", timed,
                   "SciPy DOP853 at 1e-12 in Python",
                   "largest relative error: ours {:.0e}, theirs {:.0e}".format(*errors), 300)


def against_batch(size=256, span=200.0, count=21, rounds=7) -> list[Row]:
    """`ensemble` against heyoka's batch mode, rows of as many motions, in the order given."""
    states, times = np.random.default_rng(1).normal(size=(size, 3)) * 0.5, np.linspace(0, span, count)
    raw, found = BatchRuns(off_axis_rates(INERTIA, MOMENT, TORQUE), TAYLOR_TOLERANCE), []
    theirs, ours = raw(states, times), ensemble(OFF_AXIS, states, times).states
    apart = np.abs(ours - theirs).max() / np.abs(theirs).max()
    for workers in (1, 2):
        timed = side_by_side(lambda workers=workers: ensemble(OFF_AXIS, states, times, workers=workers),
                             lambda: raw(states, times),
                             size, size, rounds,
                             time.thread_time if workers == 1 else time.perf_counter)
        found.append(against(f"ensemble-{workers}", f"ensemble of {size} motions off the axes, {span:g} s, "
                             f"{count} times, {workers} worker{'s' * (workers > 1)}", timed,
                             "heyoka batch by hand", f"same tolerance; states {apart:.0e} apart", 1 / 1.1,
                             "elapsed time; one process by hand" if workers > 1 else PACE))
    return found


def with_other_effects(name, size=256, span=200.0, count=21, rounds=7) -> Row:
    """The same with one worker, of a scene with other effects; by hand with the rates of `with_effects`, in
    processor time of the one thread."""
    omega, times = np.random.default_rng(1).normal(size=(size, 3)) * 0.5, np.linspace(0, span, count)
    scene, by_hand = OTHERS[name]
    states = np.hstack([omega, np.tile((0.6, 0.0, 0.8), (size, 1))]) if "gamma" in scene.blocks else omega
    raw = BatchRuns(with_effects(**{"inertia": INERTIA, "moment": MOMENT, "torque": TORQUE} | by_hand),
                    TAYLOR_TOLERANCE)
    theirs, ours = raw(states, times), ensemble(scene, states, times).states
    apart = np.abs(ours - theirs).max() / np.abs(theirs).max()
    timed = side_by_side(lambda: ensemble(scene, states, times), lambda: raw(states, times), size, size,
                         rounds, time.thread_time)
    return against(f"ensemble-{name.replace(',', '').replace(' ', '-')}",
                   f"ensemble of {size} motions off the axes {name}, {span:g} s, {count} times, 1 worker",
                   timed, "heyoka batch by hand", f"same tolerance; states {apart:.0e} apart", 1 / 1.1, PACE)
