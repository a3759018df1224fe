"""Late times: a million turns of a swing and of a spin-up, capture before release (group 9)."""
from __future__ import annotations

import math
from fractions import Fraction

import mpmath as mp
import numpy as np

import stabilab
from stabilab.unreduced.growth import captured_fate
from tests.hard.row import Verdict, numbers
from tests.oracles import energy, taylor
from tests.oracles.pairs import scaled
from tests.orbit.flow.test_flow import MINOR, SPINNING, summed_time

A, B, MU = 0.25, 0.75, (0, 0, 1)
SWING = (2.75, 1.125, 1.0)


def rates(t, x):
    return (x[1] * x[2], -x[2] * (x[0] + A), x[1] * (x[0] + B) + 1)


def swing(turns, case, goes_wrong, naive):
    """The state after many periods. Exact: the period in 60 digits, and a Taylor series over what is left of
    the time."""
    scene, problem = scaled(A, B, MU)
    time = float(turns * energy.period(problem, SWING, digits=60)) + 1.0

    def ask(t, *x):
        with mp.workdps(60):
            rest = energy.num(t) - turns * energy.period(problem, x, digits=60)
            return taylor.integrate(problem, x, [rest], digits=40)[0]
    ours = stabilab.trajectory(scene, SWING, [time], "reduced").states[0].tolist()
    return numbers(case, "state", goes_wrong, naive(time), ours, ask, (time, *SWING))


def swings(turns):
    """9. The state folded by a period that a run measured."""
    return swing(turns, f"swing after {turns:g} periods", "an error of the period times the number of turns",
                 after_measured_periods)


def stepped(turns):
    """9. The state by an explicit method at its usual tolerance."""
    from scipy.integrate import solve_ivp
    run = lambda time: solve_ivp(rates, (0, time), SWING, "RK45", rtol=1e-6, atol=1e-9).y[:, -1].tolist()
    return swing(turns, f"swing followed for {turns:g} periods",
                 "RK45 at 1e-6: the energy drifts with every step", run)


def after_measured_periods(time):
    """The state at `time` folded by a period that a run at the tolerance 1e-10 measures."""
    from scipy.integrate import solve_ivp
    returned = lambda t, x: x[2]
    returned.direction = 1
    run = solve_ivp(rates, (0, 60), SWING, "DOP853", rtol=1e-10, atol=1e-12, events=returned)
    period = run.t_events[0][1] - run.t_events[0][0]
    return solve_ivp(rates, (0, time % period), SWING, "DOP853", rtol=1e-10, atol=1e-12).y[:, -1].tolist()


def spun_up(state, time):
    """x1, x2 at `time` of a spin-up: the angle theta on the circle from summed_time(theta) = time by the
    secant method."""
    from flint import arb, ctx
    with ctx.workprec(120):
        exact = lambda v: arb(Fraction(v).numerator) / arb(Fraction(v).denominator)
        x1, x2, x3 = state = tuple(map(exact, state))
        time, X = exact(time), x1 + arb(1) / 5
        radius, start = (X * X + x2 * x2).sqrt(), arb.atan2(X, x2)
        late = lambda theta: summed_time(state, theta) - time
        theta, ahead = start + time * time / 2 + x3 * time, start + time * time / 2 + x3 * time + 1
        behind, now = late(theta), late(ahead)
        while abs(float((ahead - theta).mid())) > 1e-26 * float(ahead):
            theta, ahead = ahead, arb((ahead - now * (ahead - theta) / (now - behind)).mid())
            behind, now = now, late(ahead)
        return [mp.mpf(v.str(30, radius=False))
                for v in (radius * ahead.sin() - arb(1) / 5, radius * ahead.cos())]


def spins_up(time):
    """9. The place on the circle of a spin-up at a late time, t^2/(4 pi) turns on."""
    ask = lambda t, *x: spun_up(x, t)
    ours = stabilab.trajectory(MINOR, SPINNING, [time], "reduced").states[0, :2].tolist()
    naive = stabilab.trajectory(MINOR, SPINNING, [time], rtol=1e-12).states[0, :2].tolist()
    return numbers(f"spin-up after {time ** 2 / (4 * math.pi):.0e} turns", "x1, x2",
                   "steps at a tolerance of 1e-12: the phase errs by its share of t^2/2", naive, ours, ask,
                   (time, *SPINNING))


def released(c):
    """9. Captured about axis 3 for 10/c units of time before it spins up about axis 1: J = J0 - 2 c t holds
    exactly, so no motion is bounded and, for c > 0, x1 grows beyond all bounds (proof in theory of the major
    axis)."""
    from scipy.integrate import solve_ivp
    flow = lambda t, x: (x[1] * x[2] + 1, -x[2] * x[0], x[1] * (x[0] + c))
    run = solve_ivp(flow, (0, 1000), (0.0, -1.0, 5.0), "DOP853", rtol=1e-10, atol=1e-12)
    naive = ("bounded" if np.abs(run.y[:, run.t > 500]).max() <= 1.01 * np.abs(run.y[:, run.t < 500]).max()
             else "spin-up")
    answer = captured_fate(stabilab.ScaledGyrostat(0.0, c, (1, 0, 0)), (0.0, -1.0, 5.0))
    return Verdict(f"major axis, c = {c:g}", "outcome and axis",
                   "a run over 1000 units stays within its bounds",
                   naive,
                   f"{answer.fate.word} about axis {answer.axis}", "spin-up about axis 1")
