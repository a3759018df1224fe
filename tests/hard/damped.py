"""Dampers: a slow decay beside fast ones, and rotations about axes of nearly equal moments."""
from __future__ import annotations

from fractions import Fraction

import mpmath as mp
import numpy as np

import stabilab
from tests.hard.row import Verdict, numbers
from tests.oracles import energy


def nearly_free(gap):
    """A linear damper that nearly leaves an axis free: C = [[1, o], [o, 1]] about the axes 1 and 2, of moments 3
    and 2: 6 c^2 - 5 c + 1 - o^2 = 0."""
    o = 1 - gap
    scene = stabilab.Scene(stabilab.Body((3, 2, 1)), stabilab.RateDamper(((1, o, 0), (o, 1, 0), (0, 0, 1))))
    naive = float(np.abs(np.linalg.eigvals(np.array([[1 / 3, o / 3], [o / 2, 1 / 2]]))).min())
    (rest,) = stabilab.equilibria(scene).points

    def slowest(o):
        with mp.workdps(60):
            left = energy.num(1 - o * o)
            return 2 * left / (5 + mp.sqrt(25 - 24 * left))
    return numbers(f"a linear damper {gap:.0e} from leaving an axis free", "the slowest decay",
                   "eigenvalues of a matrix with entries of order 1", naive, min(map(abs, rest.eigenvalues)),
                   slowest, (o,))


def sphere_in_a_fluid(gap):
    """Rotation at 1 rad/s about the second largest moment, with a sphere that takes energy (Rahn and Barba 1991):
    omega1, omega3, sigma1, sigma3, whose linear motion has the product of its roots below zero."""
    D, k, c = (Fraction(3), 3 - Fraction(gap), Fraction(1)), Fraction(1, 2), Fraction(1, 10)
    first, third = (D[1] - D[2]) / (D[0] - k), (D[0] - D[1]) / (D[2] - k)
    push = [c / (D[0] - k), c / (D[2] - k)]
    rows = [[0, first, push[0], 0], [third, 0, 0, push[1]],
            [0, -first, -c / k - push[0], -1], [-third, 0, 1, -c / k - push[1]]]
    found = stabilab.equilibria(stabilab.Scene(stabilab.Body(D), stabilab.ViscousDamper(k, c)))
    return _verdict(f"moments {gap:.0e} from equal, a sphere in a fluid", rows, found)


def in_a_field(gap):
    """The same of eddy currents, about the field: omega1, omega3, gamma1, gamma3."""
    D, k = (Fraction(3), 3 - Fraction(gap), Fraction(1)), Fraction(1, 10)
    rows = [[-k / D[0], (D[1] - D[2]) / D[0], k / D[0], 0], [(D[0] - D[1]) / D[2], -k / D[2], 0, k / D[2]],
            [0, 1, 0, -1], [-1, 0, 1, 0]]
    found = stabilab.equilibria(stabilab.Scene(stabilab.Body(D), stabilab.EddyCurrents(k, 1)))
    return _verdict(f"moments {gap:.0e} from equal, eddy currents", rows, found)


def _verdict(case, rows, found):
    naive = np.linalg.eigvals(np.array(rows, float)).real.max()
    with mp.workdps(60):
        product = mp.det(mp.matrix([[mp.mpf(v.numerator) / v.denominator for v in map(Fraction, row)]
                                    for row in rows]))
    words = {segment.verdict for curve in found.curves for segment in curve.segments
             if ("omega2 = t" in curve.parametrisation or "axis 2" in curve.name) and not segment.t == (0.0, 0.0)}
    (ours,) = {word for word in words if word != "undecided"}
    return Verdict(case, "stability of rotation about axis 2", "`max Re < 1e-9` of computed eigenvalues, 1/s",
                   "stable" if naive < 1e-9 else "unstable", ours, "unstable" if product < 0 else "not known")
