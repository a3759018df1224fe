"""Body with a cavity of viscous liquid: slow and stiff damping, nearly degenerate roots, the printed torque,
amplitude zero."""
from __future__ import annotations

import math
from fractions import Fraction

import mpmath as mp
import numpy as np

import stabilab
from stabilab import Body, Gyrostat, Scene
from stabilab.physics.effects.liquid_cavity import LiquidCavity
from stabilab.theories.cavity import averaged
from tests.hard.row import Row, Verdict, numbers
from tests.oracles import energy, euler
from tests.theories.cavity.test_averaged import body as small_body
from tests.theories.cavity.test_averaged import by_hand

SHAPE, STATE = (9.5, 9.25, 9.0), (0.5, -0.25, 1.0)


def block(D, kappa, spin, axis=2):
    """The two rows of the Jacobian across a rotation, exact: five points give the derivative of rates of
    degree 4."""
    rates, step = euler.liquid(D, Fraction(0), kappa, Fraction(0), [Fraction(0)] * 3), Fraction(1, 8)

    def along(n):
        def at(k):
            x = [Fraction(0)] * 3
            x[axis] = spin
            x[n] += k * step
            return rates(x)
        return [(8 * (p - m) - (pp - mm)) / (12 * step) for p, m, pp, mm in zip(at(1), at(-1), at(2), at(-2))]
    j, k = ((1, 2), (2, 0), (0, 1))[axis]
    columns = along(j), along(k)
    return [[columns[0][j], columns[1][j]], [columns[0][k], columns[1][k]]]


def largest_rate(rows):
    """Largest real part of the eigenvalues of two rows, exact entries."""
    half = (rows[0][0] + rows[1][1]) / 2
    gap = half * half - (rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0])
    with mp.workdps(80):
        return energy.num(half) + (mp.sqrt(energy.num(gap)) if gap > 0 else 0)


def rotation(D, kappa, axis):
    """(the rotation about an axis that the program tells of with a spin next to 1, its spin, its two rows
    exact)."""
    points = [p for c in stabilab.equilibria(Scene(Body(D), LiquidCavity(1, 1, kappa))).curves
              for p in c.samples]
    about = [p for p in points if p.at[axis] and not any(v for n, v in enumerate(p.at) if n != axis)]
    point = min(about, key=lambda p: abs(math.log(abs(p.at[axis]))))
    return point, point.at[axis], block([Fraction(v) for v in D], Fraction(kappa), Fraction(point.at[axis]),
                                        axis)


def computed(rows):
    """Largest real part of the eigenvalues but 0 by NumPy, the body axes turned against the principal ones.
    """
    turn = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    J = np.zeros((3, 3))
    J[:2, :2] = np.array(rows, float)
    found = np.linalg.eigvals(turn @ J @ turn.T)
    return float(np.delete(found, np.abs(found).argmin()).real.max())


def damping_row(case, wrong, D, kappa, axis):
    point, spin, rows = rotation(D, kappa, axis)
    ask = lambda D1, D2, D3, kappa, spin: largest_rate(block((D1, D2, D3), kappa, spin, axis))
    ours = max(z.real for z in point.eigenvalues if z)
    return numbers(case, "growth rate of a rotation", wrong, computed(rows), ours, ask, (*D, kappa, spin))


def slow_damping(kappa):
    """The liquid's damping stands beside a frequency of order 1."""
    return damping_row(f"liquid, kappa = {kappa:g}", "the real part of computed eigenvalues", SHAPE, kappa, 0)


def nearly_degenerate(gap):
    """Two nearly equal moments: one root of z^2 + c2 z + c1 is far smaller than the other."""
    return damping_row(f"liquid, D2 = (1 - {gap:g}) D1", "the smaller of two roots that lie far apart",
                       (9.5, 9.5 * (1 - gap), 6.0), 4.0, 0)


def slow_growth(kappa):
    """A rotation about the least moment gains on the liquid: unstable, at a rate below rounding."""
    point, _, rows = rotation(SHAPE, kappa, 2)
    return Verdict(f"liquid, kappa = {kappa:g}", "stability of the least axis",
                   "`max Re < 1e-9` of computed eigenvalues",
                   "stable" if computed(rows) < 1e-9 else "unstable", point.verdict,
                   "unstable" if largest_rate(rows) > 0 else "stable")


def motion_row(case, wrong, kappa, gamma3, time, steps, naive):
    """The state at `time`; exact from the equations typed in by hand, in 30 digits."""
    def ask(D1, D2, D3, gamma3, kappa, *x):
        D, zero = [energy.num(v) for v in (D1, D2, D3)], mp.mpf(0)
        with mp.workdps(30):
            rates = euler.liquid(D, energy.num(gamma3), energy.num(kappa), zero, [zero] * 3)
            return euler.integrate(rates, [energy.num(v) for v in x], time, steps, columns=10, digits=30)
    scene = Scene(Body(SHAPE), Gyrostat((0, 0, gamma3)), LiquidCavity(1, 1, kappa))
    ours = stabilab.trajectory(scene, STATE, [time]).states[0].tolist()
    return numbers(case, "state", wrong, naive(), ours, ask, (*SHAPE, gamma3, kappa, *STATE))


def printed_torque(time):
    """The liquid's torque as printed holds for a body without rotor: with one its terms have the wrong sign
    and size."""
    scene = Scene(Body(SHAPE), Gyrostat((0, 0, 1.5)), LiquidCavity(1, 1, 1.0, "printed"))
    naive = lambda: stabilab.trajectory(scene, STATE, [time]).states[0].tolist()
    return motion_row(f"liquid and rotor at t = {time:g} s",
                      "the printed torque leaves terms of its own order out",
                      1.0, 1.5, time, 12, naive)


def stiff(kappa):
    """Decay in hundredths of a second, against classical Runge-Kutta steps of a tenth of a radian."""
    def naive():
        rates = euler.liquid(SHAPE, 1.5, kappa, 0.0, (0.0, 0.0, 0.0))
        x, h = np.array(STATE), 0.1
        f = lambda x: np.array(rates(list(x)))
        with np.errstate(all="ignore"):
            for _ in range(5):
                k1 = f(x)
                k2 = f(x + h / 2 * k1)
                k3 = f(x + h / 2 * k2)
                x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + f(x + h * k3))
        return x.tolist()
    return motion_row(f"liquid, kappa = {kappa:g}: stiff", "explicit steps of the size of the slow motion",
                      kappa, 1.5, 0.5, 40, naive)


def amplitude_zero(eps):
    """A = 0 on the way through d r = g with a torque across the axis: A and its phase have no rates of their
    own there. Judged against the exact motion, equations by hand; condition: eps^(3/2), what the second order
    leaves out."""
    scene, end = small_body(eps), 1 / eps
    exact = by_hand(scene, (0.0, 0.0, 1.0), np.array([0.0, end]), rtol=1e-12)[-1]
    found = averaged(scene, (0.0, 0.0, 1.0), [end], order=2).omega[0]
    M1, M2 = (float(v) for v in scene.vector("constant_torque")[:2])
    A, phi = 0.0, 0.0
    try:  # A' = (M1 cos - M2 sin)/J0, phi' = nu - (M1 sin + M2 cos)/(J0 A)
        naive = -(M1 * math.sin(phi) + M2 * math.cos(phi)) / (9.0 * A)
    except ZeroDivisionError:
        naive = math.inf
    return Row(f"averaged liquid, amplitude 0, small parameter {eps:g}", "state",
               "polar coordinates: division by 0", naive,
               float(np.abs(found - exact).max() / np.abs(exact).max()), eps ** 1.5)
