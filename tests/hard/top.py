"""The fast top: resonances, the printed tilt, angles where the axis stands upright, a vertical across the
axis."""
from __future__ import annotations

import math

import mpmath as mp
import numpy as np

from stabilab import Body, Gyrostat, Scene
from stabilab.errors import InputError
from stabilab.physics.effects.gravity import Gravity
from stabilab.theories.euler_angles import mean_precession
from stabilab.theories.top import printed
from stabilab.theories.top_lindstedt import lindstedt
from tests.hard.row import Verdict, numbers
from tests.oracles import energy, euler
from tests.theories.top.test_lindstedt import ARM, FIELD, MOMENTS, R0, START, WEIGHT, near, top


def resonance_nearby(distance):
    """Omega next to 1: C* next to A + B. How far, against sqrt(-alpha beta) - 1 in doubles."""
    moments = (12.0, 11.0, 6.0)
    scene = near(1 + distance, moments=moments)
    lz = float(scene.vector("gyrostat")[2])
    A, B, C = moments
    spin = C + lz / R0
    naive = abs(math.sqrt((spin - B) / A * (spin - A) / B) - 1)
    found = lindstedt(scene, START, [0.0], 2).resonances

    def ask(A, B, C, lz, r0):
        with mp.workdps(60):
            spin = C + lz / r0
            return abs(mp.sqrt(energy.num((spin - B) / A * (spin - A) / B)) - 1)
    return numbers(f"top {distance:g} from Omega = 1", "the small divisor",
                   "1 - Omega^2 from rounded moments", naive,
                   found[0].distance, ask, (*moments, lz, R0))


def exact_resonance(lz):
    """C* = A + B in decimals that are no binary fractions: doubles divide by what rounding leaves. Exact:
    rationals."""
    from fractions import Fraction
    A, B, C, r0 = "1.2", "1.1", "0.7", "150"
    alpha, beta = ((float(C) + float(lz) / 150 - float(B)) / float(A),
                   (float(A) - float(C) - float(lz) / 150) / float(B))
    divisor = 1 + alpha * beta
    spin = Fraction(C) + Fraction(lz) / Fraction(r0)
    scene = Scene(Body((A, B, C)), Gravity("0.5", ARM), Gyrostat(("0.1", 0, lz)))
    motion = lindstedt(scene, START, [0.0], 3)
    return Verdict(f"top with C* = A + B, l_z = {lz}", "does its expansion exist?",
                   "division by 1 - Omega^2 in doubles",
                   "yes" if divisor != 0 else "no",
                   "no" if motion.status == "resonant" and motion.order == 0 else "yes",
                   "no" if spin == Fraction(A) + Fraction(B) else "yes")


def tilted(gamma):
    """p, q after a third of a turn of the periodic motion; exact: the equations by hand in 25 digits from the
    same start."""
    scene = top(0.1)
    start = START | {"gamma": gamma}
    motion = lindstedt(scene, start, [0.0], 14)
    time = 0.3 * motion.period
    state = (*motion.omega[0].tolist(), *motion.gamma[0].tolist())

    def ask(*x):
        with mp.workdps(25):
            momentum, arm = [mp.mpf("3"), 0, 30], [mp.mpf(WEIGHT) / 100 * mp.mpf(v) for v in ARM]
            rates = euler.top([mp.mpf(v) for v in MOMENTS], momentum, arm, mp.mpf(FIELD) / 100)
            return euler.integrate(rates, [energy.num(v) for v in x], time, 8, columns=9, digits=25)[:2]
    try:
        naive = printed(scene, start, [time]).omega[0, :2].tolist()
    except InputError:  # its scaling divides by gamma0''
        naive = [math.inf, math.inf]
    ours = motion.at([time])[0][0, :2].tolist()
    return numbers(f"top with l_x, vertical {tuple(gamma)}", "p, q", "the printed solution (41)", naive, ours,
                   ask, state)


def upright(tilt):
    """Steady precession of the symmetric top at a small tilt: A cos(t) P^2 - (C r + l_z) P - M g z = 0, slow
    root."""
    A, C, lz, arm = 16.0, 11.0, 30.0, 0.5
    start = {"omega": START["omega"], "gamma": (tilt, 0.0, math.sqrt(1 - tilt * tilt))}
    motion = lindstedt(Scene(Body((A, A, C)), Gravity(WEIGHT, (0, 0, arm)), Gyrostat((0, 0, lz))), start,
                       [0.0], 16)
    p, q, _ = motion.omega[0]
    g1, g2, g3 = motion.gamma[0]
    with np.errstate(all="ignore"):
        naive = float(np.divide(p * g1 + q * g2, 1 - g3 ** 2))

    def ask(A, C, r, lz, weight, arm, tilt):
        with mp.workdps(60):
            A, C, r, lz, weight, arm, tilt = map(energy.num, (A, C, r, lz, weight, arm, tilt))
            spin = C * r + lz
            return [2 * -weight * arm
                    / (spin + mp.sqrt(spin * spin + 4 * A * mp.sqrt(1 - tilt * tilt) * weight * arm)), r]
    return numbers(f"top {tilt:g} rad from upright", "precession and spin", "psi' divides by 1 - gamma''^2",
                   [naive, R0],
                   [mean_precession(motion), R0], ask, (A, C, R0, lz, WEIGHT, arm, tilt))
