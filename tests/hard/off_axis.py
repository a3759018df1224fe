"""A torque a hair off a principal axis: isolated equilibria, far away, unstable at rates below rounding
(group 10)."""
from __future__ import annotations

from fractions import Fraction

import mpmath as mp
import numpy as np

import stabilab
from tests.hard.row import Verdict, numbers
from tests.oracles import energy, model


def jacobian(a, b, x):
    return [[0, x[2], x[1]], [-x[2], 0, -(x[0] + a)], [x[1], x[0] + b, 0]]


def determinant(J):
    return sum(J[0][i] * (J[1][(i + 1) % 3] * J[2][(i + 2) % 3] - J[1][(i + 2) % 3] * J[2][(i + 1) % 3])
               for i in range(3))


def verdict(off):
    """10. Torque (off, 1, 0) by the middle axis, c = 1/4: x1 = -b, x2 = off c, x3 = -1/c, exactly. det J = -n
    is not zero, so one root of z^3 + m z + n, whose roots sum to zero, has a positive real part, about n/(2
    m)."""
    a, b = 0.0, 0.25
    x = (-Fraction(b), Fraction(off) / 4, Fraction(-4))
    problem = model.scaled(a, b, (off, 1, 0))
    J = jacobian(Fraction(a), Fraction(b), x)
    exact = "unstable" if problem.rate(x) == [0, 0, 0] and determinant(J) != 0 else "none"
    found = np.linalg.eigvals(np.array(J, float)).real.max()
    point, = stabilab.equilibria(stabilab.ScaledGyrostat(a, b, (off, 1, 0))).points
    return Verdict(f"torque {off:g} rad off the intermediate axis", "stability of its equilibrium",
                   "`max Re < 1e-9` of computed eigenvalues", "stable" if found < 1e-9 else "unstable",
                   point.verdict, exact)


def growth_rate(off):
    """10. The real part of that equilibrium's eigenvalues."""
    a, b = 0.0, 0.25

    def ask(off):
        with mp.workdps(120):
            x = (Fraction(-1, 4), off / 4, Fraction(-4))
            J = jacobian(Fraction(a), Fraction(b), x)
            m = sum(J[i][i] * J[j][j] - J[i][j] * J[j][i] for i, j in ((0, 1), (0, 2), (1, 2)))
            roots = mp.polyroots([1, 0, energy.num(m), energy.num(-determinant(J))], maxsteps=500,
                                 extraprec=400)
            return max(mp.re(z) for z in roots)
    J = np.array(jacobian(a, b, (-b, off / 4, -4.0)))
    naive = float(np.linalg.eigvals(J).real.max())
    point, = stabilab.equilibria(stabilab.ScaledGyrostat(a, b, (off, 1, 0))).points
    ours = max(z.real for z in point.eigenvalues)
    return numbers(f"torque {off:g} rad off the intermediate axis", "growth rate of its equilibrium",
                   "eigenvalues of a matrix with entries of order 1", naive, ours, ask, (off,))


def far_away(off):
    """10. Torque (off^3, off, 1) by the minor axis, b - a = 1: (x1 + a)(x1 + b) = 1/off^2, so x1 is about
    +-1/off; searched for by Newton's method from a box of starts, as one does who knows no closed form."""
    a, b, mu = 0.0, 1.0, (off * off * off, off, 1.0)
    distance = float(1 / Fraction(off))  # (x1 + a)(x1 + b) = off/off^3

    def newton(x):
        for _ in range(50):
            f = np.array([x[1] * x[2] + mu[0], mu[1] - x[2] * (x[0] + a), x[1] * (x[0] + b) + mu[2]])
            try:
                x = x - np.linalg.solve(np.array(jacobian(a, b, x)), f)
            except np.linalg.LinAlgError:
                return None
            if not np.abs(x).max() < 10:
                return None
        return x if np.abs(f).max() < 1e-9 else None
    starts = np.random.default_rng(10).uniform(-10, 10, (60, 3))
    found = {tuple(np.round(x, 6)) for x in map(newton, starts) if x is not None}
    points = stabilab.equilibria(stabilab.ScaledGyrostat(a, b, mu)).points
    near = [p for p in points if abs(abs(p.at[0]) / distance - 1) < 1e-6]
    problem = model.scaled(a, b, mu)
    # against terms of size off^3, off and 1
    rest = [[abs(float(v)) for v in problem.rate(p.at)] for p in near]
    small = all(f <= 4e-16 * term for row in rest for f, term in zip(row, mu))
    exact = 2 if Fraction(b - a) ** 2 / 4 + Fraction(mu[1]) * Fraction(mu[2]) / Fraction(mu[0]) > 0 else 0
    return Verdict(f"torque {off:g} rad off the minor axis", "number of equilibria",
                   "Newton's method from a box of starts",
                   str(len(found)), str(len(near) if small else "wrong places"), str(exact))
