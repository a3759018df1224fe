"""Attitudes at rest on a circular orbit: slow librations where equilibria are about to meet or two moments are
nearly equal."""
from __future__ import annotations

from fractions import Fraction

import mpmath as mp
import numpy as np

from stabilab.equilibrium.circular_orbit import orbit_equilibria
from stabilab.physics.circular_orbit import Satellite
from tests.hard.row import Verdict, numbers
from tests.oracles import energy


def stiffness(A, B, C, h):
    """Of roll and yaw, and the gyroscopic number between them, where A is along the velocity, B along the normal
    with the wheel, C up, n = 1 (DeBra and Delp 1961, and the wheel by hand)."""
    return 4 * (B - C) + h, B - A + h, A - B + C - h


def slowest(A, B, C, h):
    """(A z^2 + roll)(C z^2 + yaw) + g^2 z^2 = 0: the smaller root."""
    with mp.workdps(80):
        roll, yaw, g = (energy.num(v) for v in stiffness(A, B, C, h))
        A, C = energy.num(A), energy.num(C)
        b, c = A * yaw + C * roll + g**2, A * C
        return mp.sqrt(2 * roll * yaw / (b + mp.sqrt(b**2 - 4 * c * roll * yaw)))


def matrix(A, B, C, h, n=1.0):
    """Of the linear motion: roll, yaw and their rates; h over n."""
    roll, yaw, g = stiffness(A, B, C, h)
    return np.array([[0, 0, 1, 0], [0, 0, 0, 1], [-roll / A * n**2, 0, 0, -g / A * n],
                     [0, -yaw / C * n**2, g / C * n, 0]], float)


def upright(A, B, C, h, n=Fraction(1)):
    """The equilibrium with B along the normal and C up, as the program has it."""
    one = Satellite(tuple(map(Fraction, (A, B, C))), (Fraction(0), Fraction(h) * n, Fraction(0)), n**2)
    return next(point for point in orbit_equilibria(one).points
                if point.normal[1] == 1 and abs(point.vertical[2]) == 1)


def wheel_by_a_pitchfork(share):
    """A wheel against the normal holds yaw no more where its momentum is n (B - A)."""
    h = share - 1.0
    naive = float(np.abs(np.linalg.eigvals(matrix(2.0, 3.0, 1.0, h))).min())
    return numbers(f"a wheel {share:.0e} from where attitudes meet on an orbit", "the slowest libration",
                   "eigenvalues of a matrix with entries of order 1", naive,
                   upright(2, 3, 1, h).frequencies[0], lambda h: slowest(2, 3, 1, h), (h,))


def wheel_beyond_a_pitchfork(share):
    """The same beyond it: roll and yaw have one positive and one negative stiffness, so z = 0 lies between real
    roots."""
    return _beyond(f"a wheel {share:.0e} beyond where attitudes meet on an orbit", 2, 3, 1,
                   -1 - Fraction(share))


def nearly_equal_moments(gap):
    """Yaw is held by the difference of the moments along the normal and the velocity alone: the larger one along
    the velocity is unstable."""
    return _beyond(f"moments {gap:.0e} from equal, the larger one along the velocity", 3 + Fraction(gap), 3, 1, 0)


def _beyond(case, A, B, C, h):
    n = Fraction(1, 1000)  # rad/s, of a low orbit
    roll, yaw, _ = stiffness(A, B, C, h)
    found = np.linalg.eigvals(matrix(*map(float, (A, B, C, h, n)))).real.max()
    return Verdict(case, "stability", "`max Re < 1e-9` of computed eigenvalues, 1/s",
                   "stable" if found < 1e-9 else "unstable", upright(A, B, C, h, n).verdict,
                   "unstable" if roll * yaw < 0 else "stable")
