"""Equilibria on a motion's own curve counted by brute force: NumPy and Euler's equations, nothing of the
package.

With torque M on principal axis i and rates (x, y) about j and k, cyclic, an equilibrium has (Dj x + lj) y -
(Dk y + lk) x + M = 0, and dx/da = ((Dk - Di) y + lk)/Dj, dy/da = ((Di - Dj) x - lj)/Dk along the curve, so Dj
((Di - Dj) x^2 - 2 lj x) - Dk ((Dk - Di) y^2 + 2 lk y) stays.
"""
from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

POINTS = 40_001
FAR = 14.0  # of a hyperbola's parameter: the force grows like exp(2 FAR)


def sign_changes(D, lam, M, omega, i):
    """How often the force changes its sign along the curve of the motion from omega."""
    j, k = (i + 1) % 3, (i + 2) % 3
    D, lam, omega = (np.array([float(v) for v in row]) for row in (D, lam, omega))
    force = lambda x, y: (D[j] * x + lam[j]) * y - (D[k] * y + lam[k]) * x + float(M[i])
    a, c = D[j] * (D[i] - D[j]), -D[k] * (D[k] - D[i])
    b, d = -D[j] * lam[j], -D[k] * lam[k]  # a x^2 + 2 b x + c y^2 + 2 d y stays
    x0, y0 = omega[j], omega[k]
    level = a * x0**2 + 2 * b * x0 + c * y0**2 + 2 * d * y0
    if a and c:
        centre, rest = (-b / a, -d / c), level + b**2 / a + d**2 / c
        return sum(_changes(force(centre[0] + x, centre[1] + y), closed) for x, y,
                   closed in _branches(a, c, rest))
    t = np.concatenate([-np.logspace(7, -7, POINTS), np.logspace(-7, 7, POINTS)])
    if a and d:  # c = 0: y from x
        return _changes(force(t, (level - a * t**2 - 2 * b * t) / (2 * d)), False)
    if c and b:
        return _changes(force((level - c * t**2 - 2 * d * t) / (2 * b), t), False)
    if c:  # two lines, of one y each
        return sum(_changes(force(t, y), False) for y in {y0, -2 * d / c - y0})
    return sum(_changes(force(x, t), False) for x in {x0, -2 * b / a - x0})


def _branches(a, c, rest):
    """(x, y, whether it closes) along each branch of a x^2 + c y^2 = rest."""
    if a * c > 0:
        t = np.linspace(0, 2 * np.pi, POINTS)
        return [(np.sqrt(rest / a) * np.cos(t), np.sqrt(rest / c) * np.sin(t), True)] if rest / a > 0 else []
    t = np.linspace(-FAR, FAR, POINTS)
    grows, crosses = np.sqrt(abs(rest / a)), np.sqrt(abs(rest / c))
    if rest / a > 0:
        return [(s * grows * np.cosh(t), crosses * np.sinh(t), False) for s in (1, -1)]
    return [(grows * np.sinh(t), s * crosses * np.cosh(t), False) for s in (1, -1)]


def rises(D, lam, M, omega, i):
    """How much the potential T - M alpha rises from one saddle of the motion's ellipse to the next, both ways
    round; None but for two saddles.

    alpha is the angle of the turn: from the equations above in centred coordinates X = r cos(n a), Y = -(r
    n/p) sin(n a), p = (Dk - Di)/Dj.
    """
    j, k = (i + 1) % 3, (i + 2) % 3
    D, lam, omega = (np.array([float(v) for v in row]) for row in (D, lam, omega))
    p, q = (D[k] - D[i]) / D[j], (D[i] - D[j]) / D[k]
    if p * q >= 0:
        return None
    n, x0, y0 = np.sqrt(-p * q), lam[j] / (D[i] - D[j]), -lam[k] / (D[k] - D[i])
    r = np.hypot(omega[j] - x0, p * (omega[k] - y0) / n)
    place = lambda s: (x0 + r * np.cos(s), y0 - r * n / p * np.sin(s))
    height = lambda s: 0.5 * (D[j] * place(s)[0]**2 + D[k] * place(s)[1]**2) - float(M[i]) * s / n
    force = lambda s: (D[j] * place(s)[0]
                       + lam[j]) * place(s)[1] - (D[k] * place(s)[1] + lam[k]) * place(s)[0] + float(M[i])
    grid = np.linspace(0, 2 * np.pi, 4001)
    values = force(grid)
    # the force pushes away on both sides
    tops = [brentq(force, a, b) for a, b, u, v in zip(grid, grid[1:], values, values[1:]) if u < 0 < v]
    if len(tops) != 2:
        return None
    first, second = tops
    return height(second) - height(first), height(first + 2 * np.pi) - height(second)


def _changes(values, closed):
    signs = np.sign(values)
    return int((signs[1:] * signs[:-1] < 0).sum())
