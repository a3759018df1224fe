"""Periods in balls, to the digits asked for, against Euler's equations: after a period a motion is where it
was."""
from __future__ import annotations

import random
from fractions import Fraction

import mpmath as mp
import numpy as np

import stabilab
from stabilab import Fate
from stabilab.orbit.one_orbit import Orbit
from stabilab.orbit.period import period_ball
from stabilab.orbit.reduction import reduce
from tests.hunt.disagreements import BITS, ELEVEN_DIGITS, MOST_TURNS, NO_QUESTION, number_of, series_of, worst

ASKED = (9, 14, 20, 30, 45)  # digits
LOST = 24  # digits that a series loses at most: of a motion that passes a saddle within 1e-17, and seven more


def returns(scene, problem, state):
    """The ball of a period, at a number of digits that the state picks, has these; the period in doubles has
    eleven."""
    if reduce(scene) is None or int(stabilab.fate(scene, np.array(state)).labels) != Fate.BOUNDED:
        return NO_QUESTION
    rate = max(abs(float(r)) for r in problem.rate(state))
    time = float(stabilab.period(scene, np.array(state)))
    if not 0 < time * rate < MOST_TURNS * max(map(abs, state)):
        return NO_QUESTION  # the series would take minutes
    sizes = np.abs(stabilab.extremes(scene, np.array(state)))
    if not sizes[sizes > 0].min(initial=1.0) > 10.0**-LOST * sizes.max():
        # beside a plane the series would lose as many digits as the least rate has zeros: of 1e-167 beside
        # 200, some 340
        return NO_QUESTION
    digits = random.Random(repr(state)).choice(ASKED)
    ball = period_ball(Orbit(reduce(scene), state), digits)
    bits = int(3.33 * 2 * (digits + LOST)) + 64
    with mp.workprec(bits):
        middle = mp.mpf(ball.mid().str(2 * digits + LOST, radius=False))
        off = abs(lateness(problem, state, middle, bits) / middle)
        words = (
            f"{digits} digits asked: {mp.nstr(middle, digits + 3)} is off by {mp.nstr(off, 3)} of itself; in "
            f"doubles {time!r}")
        return worst((float(off * mp.mpf(10) ** digits), words),
                     (float(abs(time - middle) / middle) / ELEVEN_DIGITS, words))


def lateness(problem, state, time, bits=BITS):
    """By how much of the time a motion is beyond its start after `time`, told from its way and its rate
    there; by a Taylor series of so many bits. A multiple of the period would pass."""
    import heyoka as hy
    with mp.workprec(bits):
        series = series_of(problem, bits)
        series.time, series.state[:] = number_of(0, bits), [number_of(v, bits) for v in state]
        series.propagate_until(hy.real(mp.nstr(mp.mpf(time), int(bits / 3.3)), bits))
        way = [mp.mpf(str(v)) - mp.mpf(x) for v, x in zip(series.state, state)]
        rate = [mp.mpf(r.numerator) / r.denominator for r in problem.rate([Fraction(v) for v in state])]
        return sum(a * b for a, b in zip(way, rate)) / sum(b * b for b in rate)
