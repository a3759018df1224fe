"""Middle axis: next to and on the invariant planes, just above the cusp (groups 5, 8, 11); saddles as initial
states (8)."""
from __future__ import annotations

import math

import numpy as np

import stabilab
from tests.hard.row import Verdict, numbers
from tests.oracles import energy, model
from tests.oracles.pairs import PAPER_BODY, physical, scaled


def off_the_plane(C):
    """5. Largest x2 from x1 + b = 1 + C/2, x3 = -1, x2 = 0 (a = 0, b = C/2); the state's numbers are exact.
    """
    digits, tiny = int(60 - 1.2 * math.log10(C)), C / 2
    ask = lambda b: energy.extremes(model.scaled(0, b, (0, 1, 0)), (1, 0, -1), digits=digits)[1][1]
    ours = float(stabilab.extremes(scaled(0.0, tiny, (0, 1, 0))[0], np.array([1.0, 0.0, -1.0]))[1, 1])
    rounded = (1.0 + tiny) ** 2 - 1.0  # zero in doubles: on the plane, where the motion spins up
    return numbers(f"C = {C:g}, intermediate axis", "largest x2", "x1 + b rounds: on the plane, spin-up for ever",
                   math.inf if rounded == 0 else math.nan, ours, ask, (tiny,))


def runs(rates, axis, state, until):
    """What a run by Runge-Kutta of order 8 at the tolerance 1e-10 shows: "equilibrium" if it stays, "bounded"
    if it comes to spin against the torque after it spun with it, else "spin-up"."""
    from scipy.integrate import solve_ivp
    run = solve_ivp(rates, (0, until), state, "DOP853", rtol=1e-10, atol=1e-12, max_step=0.5).y
    if np.abs(run.T - state).max() < 1e-3:
        return "equilibrium"
    senses = np.sign(run[axis][abs(run[axis]) > 1e-3])
    return "bounded" if (np.diff(senses) < 0).any() else "spin-up"


def on_the_plane(y):
    """8. Initial state on the invariant plane x1 + b = -x3, which a run leaves."""
    a, b = 0.25, 0.75
    state, (scene, problem) = (y - b, 0.5, -y), scaled(a, b, (0, 1, 0))
    rates = lambda t, x: (x[1] * x[2], 1 - x[2] * (x[0] + a), x[1] * (x[0] + b))
    return Verdict(f"on the invariant plane x1 + b = -x3 = {y:g}", "outcome",
                   "a run leaves the plane as exp(x2^2/2)",
                   runs(rates, 1, state, 100.0), fate_word(scene, state), energy.label(problem, state))


def fate_word(scene, state):
    return stabilab.Fate(int(stabilab.fate(scene, np.array(state)).labels)).word


def exact_saddle(wk):
    """8. An exact equilibrium, unstable, whose rates in doubles are not zero: a run leaves it as exp(t). On
    the second line of a conic of two lines: w1 = -1/4, any w2; the torque -l2/4 balances exactly."""
    D, l2 = np.array(PAPER_BODY), 62.3
    momentum, torque, state = np.array([125.0, l2, 0.0]), np.array([0.0, 0.0, -l2 / 4]), (-0.25, wk, 0.0)
    scene, problem = physical(PAPER_BODY, momentum, torque)
    rates = lambda t, w: (np.cross(D * w + momentum, w) + torque) / D
    return Verdict(f"exact saddle w2 = {wk:g} as initial state", "outcome",
                   "rates of rounding grow as exp(t)",
                   runs(rates, 2, state, 400.0), fate_word(scene, state), energy.label(problem, state))


def above_the_cusp(c):
    """11. A double well for a small window of the invariant: the margin of a state in it, against a scan of
    the potential at a hundred places a radian."""
    g = -3 ** -0.25
    state = (1 / g, 2.0 ** -30, g)
    ask = lambda c, *x: energy.margin(model.scaled(0, c, (0, 1, 0)), x, digits=60)
    ours = float(stabilab.fate(scaled(0.0, c, (0, 1, 0))[0], np.array(state)).margins)
    Y, z, t = state[0] + c, state[2], 0.003 + np.arange(-500, 501) / 100
    height = lambda t: (Y * np.cosh(t) + z * np.sinh(t)) ** 2 / 2 - c * (Y * np.cosh(t) + z * np.sinh(t)) - t
    found = height(t)
    tops = found[1:-1][(found[1:-1] > found[:-2]) & (found[1:-1] > found[2:])]
    naive = float(tops.max() - height(0.0) - state[1] ** 2 / 2) if tops.size else math.nan
    return numbers(f"c = {c:g}, above the cusp 1.75477", "margin",
                   "a scan of the potential misses the barrier", naive,
                   ours, ask, (c, *state))


def separatrix_above_the_cusp(c):
    """11. Is there a separatrix at all? c > 4 3^(-3/4), the proof of theory, against a scan of the invariant
    in steps of 1e-3, each level judged by the real roots of its quartic."""
    def has_saddle(invariant):  # x3 = g, Y = c + 1/g: Y^2 - g^2 = invariant; saddles have g^4 + c g + 1 < 0
        g = np.roots([1, 0, invariant - c * c, -2 * c, -1])
        g = g[abs(g.imag) < 1e-9].real
        return (g ** 4 + c * g + 1 < 0).any()
    naive = "yes" if any(has_saddle(v) for v in np.arange(-3000, 3001) / 1000) else "no"
    ours = "yes" if len(stabilab.separatrix(scaled(0.0, c, (0, 1, 0))[0]).branches) else "no"
    return Verdict(f"c = {c:g}, above the cusp 1.75477", "is there a separatrix?",
                   "a scan of the invariant in steps of 1e-3", naive, ours,
                   "yes" if c > 4 * 3 ** -0.75 else "no")
