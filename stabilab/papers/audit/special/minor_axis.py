"""Amer et al. 2024: torque on the minor axis (eqs (13)-(40), Figs 2-7)."""
from __future__ import annotations

import math

import numpy as np

from ....answers.simulate import trajectory
from ....physics.scene import ScaledGyrostat
from .constant_torque import minor_equilibria, misjudged

# Saddles and centres of Fig. 4 in alpha = 2 atan2(x1 + a, x2): lambda1 -> (left saddle, right saddle, left
# centre, right centre); printed, and roots of 1 + A cos(alpha/2) (A sin(alpha/2) + c) = 0.
FIG4_PRINTED = {100: (0.0, 6.2, -3.0, 3.3), 300: (0.19, 6.15, -3.1, 3.29), 500: (0.32, 5.8, -3.13, 3.28)}
FIG4_TRUE = {100: (-0.16926911783859, 6.28019631200926, -3.05188202440815, 3.22414013741707),
             300: (-0.31754628012639, 6.44213532039449, -3.05286555265963, 3.21146181957111),
             500: (-0.45279697640931, 6.58903191561815, -3.05425914964370, 3.20120951761444)}


def _fig4(table, pull: bool):
    """Largest residual of the equilibrium condition over the table; with `pull` the paper's own (23) is
    tried."""
    worst = 0.0
    for lam, angles in table.items():
        a, b = lam / 500, lam / 250
        radius, offset = (math.hypot(2.5, 4), -b) if pull else (math.hypot(2.5 + a, 4), b - a)
        for alpha in angles:
            worst = max(worst,
                        abs(1 + radius * math.cos(alpha / 2) * (radius * math.sin(alpha / 2) + offset)))
    return worst


def _fold_radius():
    """Circles x2^2 + (x1+a)^2 = A^2 that carry an equilibrium: smallest A found on the hyperbola, against the
    printed root of 2 and against the true smaller fold radius, for c = 0.2 (lambda1 = 100)."""
    c = 0.2
    heights = np.concatenate([-np.geomspace(0.1, 10, 40001), np.geomspace(0.1, 10, 40001)])
    smallest = np.sqrt(np.min(heights**2 + (c + 1 / heights) ** 2))
    return smallest - math.sqrt(2), smallest - _fold_radius_of(c)


def _line(x):
    """The paper's dividing line x1 + x2 = 0: it calls the side |x1| > |x2| of the hyperbola stable."""
    return abs(x[0]) > abs(x[1])


def _dividing():
    """Equilibria close to the folds, at c = 1 (lambda1 = 500), where line and curve part."""
    a, b = 1.0, 2.0
    heights = [h for h in (-1.3, -1.1, -0.95, -0.85, -0.75, 0.75, 0.9, 1.1, 1.15, 1.3)]
    points = minor_equilibria(b, heights)
    return (misjudged(_line, points, a, b),
            misjudged(lambda x: (x[0] + a) * (x[0] + b) > x[1] ** 2, points, a, b))


def _stability_after_13():
    points = minor_equilibria(0.4)
    return (misjudged(lambda x: abs(x[1]) > 1, points, 0.2, 0.4),
            misjudged(lambda x: (x[0] + 0.2) * (x[0] + 0.4) > x[1] ** 2, points, 0.2, 0.4))


def _merging():
    """x2 (x1 + b) + 1 at the printed merging point of saddle and centre, b = 0.4; at the true ones
    (x1 + b)(x1 + a) - x2^2, which vanishes at a fold."""
    return (-1 + 0.4) * 1 + 1, max(abs((-1 / h) * (-1 / h - 0.2) - h * h) for h in _folds(0.2))


def _circle(alpha):
    """The point (x1, x2) of the circle A = 4.826 at alpha, lambda1 = 100."""
    A = math.hypot(2.7, 4)
    return A * math.sin(alpha / 2) - 0.2, A * math.cos(alpha / 2)


def _item4():
    x1, x2 = _circle(FIG4_TRUE[100][0])
    return x2**2 - x1**2 - 4 * 0.4 * x1 - 4 * math.atan2(x1, x2)


def _loop_ends():
    """The loop's far end from the printed (28) with A and c in their places, tried on the corrected (30)."""
    from scipy.optimize import brentq
    A, c, saddle, centre = math.hypot(2.7, 4), 0.2, FIG4_TRUE[100][0], FIG4_TRUE[100][2]

    def speed(al):
        return (A**2 * (math.cos(saddle) - math.cos(al))
                + 4 * A * c * (math.sin(al / 2) - math.sin(saddle / 2))
                + 2 * (al - saddle))

    def invariant(al):
        x1, x2 = _circle(al)
        X = x1 + 0.2
        return x2**2 - X**2 - 4 * c * X - 2 * al

    return invariant(brentq(speed, -2 * math.pi, centre, xtol=1e-15)) - invariant(saddle)


def _repeated(turns):
    """The equilibrium condition at every saddle and centre of Fig. 4, so many turns of alpha on."""
    moved = {lam: [alpha + 2 * math.pi * turns for alpha in angles] for lam, angles in FIG4_TRUE.items()}
    return _fig4(moved, False)


def _loop_area(lam, side):
    """The area of a loop in the plane (alpha, x); side 0: left, 1: right."""
    from scipy.integrate import quad
    from scipy.optimize import brentq
    A, c = math.hypot(2.5 + lam / 500, 4), lam / 500
    saddle, centre = FIG4_TRUE[lam][side], FIG4_TRUE[lam][2 + side]

    def square(al):  # of x, by the corrected (25)
        return 2 * (A**2 * (math.cos(saddle) - math.cos(al))
                    + 4 * A * c * (math.sin(al / 2) - math.sin(saddle / 2)) + 2 * (al - saddle))

    end = brentq(square, centre - math.pi, centre)
    return 2 * quad(lambda al: math.sqrt(max(square(al), 0.0)), end, saddle)[0]


def _loop_order(lambda1, smaller):
    """By how much the order of the areas fails: the loop named ("left", "right") below the other, and above.
    """
    left, right = (_loop_area(lambda1, side) for side in (0, 1))
    return (max(0.0, left - right), max(0.0, right - left))[::1 if smaller == "left" else -1]


def _saddles():
    """How many saddles less than two, or more, the circles of Fig. 4 carry; roots in tan(alpha/4)."""
    found = []
    for lam in FIG4_TRUE:
        a, b = lam / 500, lam / 250
        A = math.hypot(2.5 + a, 4)
        found.append(sum(_is_saddle(h, b - a) for h in _heights(A, b - a)))
    return sum(abs(number - 2) for number in found), 0


def _heights(A, c):
    """x2 of the equilibria on the circle of radius A: h^2 + (c + 1/h)^2 = A^2."""
    roots = np.roots([1, 0, c * c - A * A, 2 * c, 1])
    return [float(h.real) for h in roots if abs(h.imag) < 1e-9]


def _is_saddle(h, c):
    return h**4 - c * h - 1 > 0


def _folds(c):
    """x2 of the points at which saddle and centre merge: (left, right)."""
    left, right = sorted((h.real for h in np.roots([1, 0, 0, -c, -1]) if abs(h.imag) < 1e-12), reverse=True)
    return left, right


def _fold_radius_of(c):
    """Radius of the smallest circle that carries an equilibrium."""
    return min(math.sqrt(h * h + h**6) for h in _folds(c))


def _wells(A, c):
    """x2 of the centres on the circle of radius A."""
    return [h for h in _heights(A, c) if not _is_saddle(h, c)]


def _stable_parts():
    """How many more or fewer than two parts of the hyperbola are stable, lambda1 = 100."""
    h = np.concatenate([np.linspace(-5, -1e-3, 5000), np.linspace(1e-3, 5, 5000)])
    stable = np.concatenate([[False], (1 / h) * (1 / h + 0.2) > h * h, [False]])
    stable = np.insert(stable, 5001, False)  # the two branches do not meet at h = 0
    return abs(int((np.diff(stable.astype(int)) == 1).sum()) - 2), 0


def _arc(inside):
    """Turns of (x1 + a, x2) on its circle, A = 4.826, lambda1 = 100: short of one whole turn, and beyond.
    inside: from (2.5, 4, 0.1), in a loop; else from (2.5, 4, 6)."""
    run = trajectory(ScaledGyrostat(0.2, 0.4, (0, 0, 1)), (2.5, 4.0, 0.1 if inside else 6.0),
                     np.linspace(0, 40, 8001))
    x = np.asarray(run.states)
    turns = float(np.ptp(np.unwrap(np.arctan2(x[:, 0] + 0.2, x[:, 1])))) / (2 * math.pi)
    return (max(0.0, turns - 1), max(0.0, 1 - turns))[::1 if inside else -1]


def _ways(lambda1):
    """Share of motions outside the loops, from either direction, that turn the same way in the end: what a
    claim of two ways denies; share of the others."""
    scene = ScaledGyrostat(lambda1 / 500, lambda1 / 250, (0, 0, 1))
    ends = [trajectory(scene, (2.5, 4.0, x3), (0.0, 60.0)).states[-1][2] for x3 in (-9.0, -7.0, 6.0, 8.0)]
    up = sum(end > 0 for end in ends) / len(ends)
    return up, 1 - up


def _where_separatrices_end():
    """Radius of the circle of a separatrix's end less that of its start, for the print's end on the circle
    of radius sqrt(2), and for the saddles of the circle itself (lambda1 = 100)."""
    A, c = math.hypot(2.7, 4), 0.2
    ends = [math.hypot(h, c + 1 / h) for h in _heights(A, c) if _is_saddle(h, c)]
    return A - math.sqrt(2), max(abs(end - A) for end in ends)


TESTS = {
    "stability": _stability_after_13,
    "fold radius": _fold_radius,
    "positions": lambda: (_fig4(FIG4_PRINTED, True), _fig4(FIG4_TRUE, False)),
    "repetition": lambda: (_repeated(1), _repeated(2)),
    "loop areas": _loop_order,
    "two separatrices": _saddles,
    "stable parts": _stable_parts,
    "arc": _arc,
    "ways": _ways,
    # centres missing on a circle of radius 1.2 (lambda1 = 100); smallest circle with one less the fold's
    "every radius": lambda: (1 - len(_wells(1.2, 0.2)), len(_wells(1.2, 0.2))),
    # a centre inside the circle of Figs 2 and 3: by how much
    "inside": lambda: (math.hypot(2.7, 4) - _fold_radius_of(0.2), 0),
    # wells on the circle of radius sqrt(2), lambda1 = 100: 1, on the right, x2 < 0
    "figure 7": lambda: (abs(sum(1 if h < 0 else 2 for h in _wells(math.sqrt(2), 0.2)) - 1), 0),
    "end of a separatrix": _where_separatrices_end,
    "dividing line": _dividing,
    "figure 6 item 4": lambda: (_item4(), _loop_ends()),
    "merging": _merging,
}
