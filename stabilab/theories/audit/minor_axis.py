"""Amer et al. 2024: torque on the minor axis (eqs (13)-(40), Figs 2-7)."""
from __future__ import annotations

import math

from .published import Published, drift, minor_equilibria, misjudged, number, parse

# Saddles and centres of Fig. 4 in alpha = 2 atan2(x1 + a, x2): lambda1 -> (left saddle, right saddle, left centre,
# right centre); printed, and roots of 1 + A cos(alpha/2) (A sin(alpha/2) + c) = 0.
FIG4_PRINTED = {100: (0.0, 6.2, -3.0, 3.3), 300: (0.19, 6.15, -3.1, 3.29), 500: (0.32, 5.8, -3.13, 3.28)}
FIG4_TRUE = {100: (-0.16926911783859, 6.28019631200926, -3.05188202440815, 3.22414013741707),
             300: (-0.31754628012639, 6.44213532039449, -3.05286555265963, 3.21146181957111),
             500: (-0.45279697640931, 6.58903191561815, -3.05425914964370, 3.20120951761444)}
G1_PRINTED = 2.54


def _fig4(table, pull: bool):
    """Largest residual of the equilibrium condition over the table; with `pull` the paper's own (23) is tried."""
    worst = 0.0
    for lam, angles in table.items():
        a, b = lam / 500, lam / 250
        radius, offset = (math.hypot(2.5, 4), -b) if pull else (math.hypot(2.5 + a, 4), b - a)
        for alpha in angles:
            worst = max(worst, abs(1 + radius * math.cos(alpha / 2) * (radius * math.sin(alpha / 2) + offset)))
    return worst


def _fold_radius():
    """Circles x2^2 + (x1+a)^2 = A^2 that carry an equilibrium: smallest A found on the hyperbola, against the printed
    root of 2 and against the true smaller fold radius, for c = 0.2 (lambda1 = 100)."""
    import numpy as np
    c = 0.2
    heights = np.concatenate([-np.geomspace(0.1, 10, 40001), np.geomspace(0.1, 10, 40001)])
    smallest = np.sqrt(np.min(heights**2 + (c + 1 / heights) ** 2))
    folds = [h.real for h in np.roots([1, 0, 0, -c, -1]) if abs(h.imag) < 1e-12]
    least = min(math.sqrt(h * h + h**6) for h in folds)
    return smallest - math.sqrt(2), smallest - least


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


def _reduced_rate(formula):
    """alpha1'' - formula at theta = 0.7, with the circle of the true invariant; a = 0.2, b = 0.4, A = 3."""
    a, b, radius, theta = 0.2, 0.4, 3.0, 0.7
    x1, x2 = radius * math.sin(theta) - a, radius * math.cos(theta)
    return x2 * (x1 + b) + 1 - formula(a, b, radius, theta)


def _saddle_energy(printed: bool):
    """Rate x' at the saddle used in (26): alpha_s with sin = -2/A^2, or the root of the full condition; c = 0.2."""
    from math import asin, cos, sin
    A, c = math.hypot(2.7, 4), 0.2
    alpha = -asin(2 / A**2) if printed else FIG4_TRUE[100][0]
    return 2 + 2 * A * cos(alpha / 2) * (A * sin(alpha / 2) + c)


def _contact_points(shifted: bool):
    """x2 (x1 + b) + 1 at the merging points of saddle and centre, b = 0.4."""
    if not shifted:
        return (-1 + 0.4) * 1 + 1
    import numpy as np
    c = 0.2
    folds = [h.real for h in np.roots([1, 0, 0, -c, -1]) if abs(h.imag) < 1e-12]
    slope = [(-1 / h) * (-1 / h - c) - h * h for h in folds]  # (x1+b)(x1+a) - x2^2 vanishes at a fold
    return max(abs(v) for v in slope)


def _slope(formula):
    """dx1/dx3 along the motion minus the formula, at the generic state."""
    return number(parse("x2*x3/(x2*(x1+b)+1)") - parse(formula))


def _quartic(formula, circle):
    """The quartic in x2 at a true crossing of the equilibrium hyperbola and the circle it was derived from."""
    b, a, h = 0.4, 0.2, 1.3
    x1 = -1 / h - b
    F2 = x1**2 + h**2 if circle == "F" else (x1 + a) ** 2 + h**2
    return formula(h, a, b, F2)


def _double_angle(shift):
    x1, x2 = 3 * math.sin(0.7) - 0.2, 3 * math.cos(0.7)
    return (x2**2 - (x1 + shift) ** 2) / (x2**2 + (x1 + shift) ** 2) - math.cos(1.4)


def _g1(true: bool):
    x1, x2, x3, a, b = 2.5, 4.0, 0.1, 0.2, 0.4
    if true:
        return 2 * x3**2 + x2**2 - (x1 + a) ** 2 - 4 * (b - a) * (x1 + a) - 4 * math.atan2(x1 + a, x2)
    return 2 * x3**2 + x2**2 - x1**2 - 4 * b * x1 - 4 * math.atan2(x1, x2)


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
        return (A**2 * (math.cos(saddle) - math.cos(al)) + 4 * A * c * (math.sin(al / 2) - math.sin(saddle / 2))
                + 2 * (al - saddle))

    def invariant(al):
        x1, x2 = _circle(al)
        X = x1 + 0.2
        return x2**2 - X**2 - 4 * c * X - 2 * al

    return invariant(brentq(speed, -2 * math.pi, centre, xtol=1e-15)) - invariant(saddle)


ROWS = (
    Published("after eq. (13)", "equilibria X2 (X1+b) = −1", "the equilibrium hyperbola", "right", "",
              "rates on it", lambda: (max(abs(x2 * (x1 + 0.4) + 1) for x1, x2, _ in minor_equilibria(0.4)), 0.0)),
    Published("after eq. (13)", "stable for |X2| > 1, unstable for |X1+b| > 1", "stability of the equilibria", "wrong",
              "stable if and only if (X1+a)(X1+b) > X2²; with a = b that is |X2| < 1, the opposite of the print",
              "share of eight equilibria judged against their spectrum (λ1 = 100)", _stability_after_13),
    Published("eqs (17), (18)", "x1² + x2² = F²", "first integral", "wrong", "(x1+a)² + x2² = A²",
              "rate of change along the motion",
              lambda: (drift("x1**2+x2**2", "minor"), drift("(x1+a)**2+x2**2", "minor"))),
    Published("eq. (19)", "α1'' = 1 + F[(F/2) sin 2θ − b cos θ], θ = α1 + ψ1", "reduced equation", "wrong",
              "θ'' = 1 + A cos θ (A sin θ + b − a); the sign before b and the missing a are both in error",
              "θ'' minus the formula",
              lambda: (_reduced_rate(lambda a, b, A, t: 1 + A * (A / 2 * math.sin(2 * t) - b * math.cos(t))),
                       _reduced_rate(lambda a, b, A, t: 1 + A * math.cos(t) * (A * math.sin(t) + b - a)))),
    Published("after eq. (21)", "no equilibrium for F < √2", "fold radius", "right only for these data",
              "true for λ1 = 0. In general the folds h⁴ − c h − 1 = 0, c = b − a, give two radii A² = h² + h⁶, one on "
              "either side of √2", "smallest circle that carries an equilibrium, c = 0.2, minus the radius",
              _fold_radius, 1e-7),
    Published("eqs (25), (30)", "2x3² + x2² − x1² − 4b x1 − 4 atan(x1/x2) = G1", "second integral", "wrong",
              "2x3² + x2² − (x1+a)² − 4(b−a)(x1+a) − 4 atan2(x1+a, x2) is constant",
              "rate of change along the motion",
              lambda: (drift("2*x3**2+x2**2-x1**2-4*b*x1-4*atan(x1/x2)", "minor"),
                       drift("2*x3**2+x2**2-(x1+a)**2-4*(b-a)*(x1+a)-4*atan((x1+a)/x2)", "minor"))),
    Published("eqs (26)-(28), (31)", "saddle at sin α_s = −2/F², cos α_s = √(F⁴−4)/F²", "the separatrix through it",
              "right only for these data", "true for λ1 = 0 only; in general α_s solves 1 + A cos(α/2)(A sin(α/2) + b "
              "− a) = 0, and the separatrix is x²/2 = A²(cos α_s − cos α) + 4A(b−a)(sin(α/2) − sin(α_s/2)) + "
              "2(α − α_s)", "x' at the saddle (λ1 = 100)", lambda: (_saddle_energy(True), _saddle_energy(False)), 1e-11),
    Published("eq. (29)", "cos α = (x2² − x1²)/F²", "change of variable", "wrong",
              "cos α = (x2² − (x1+a)²)/A²", "difference at one state of the circle A = 3, α = 1.4",
              lambda: (_double_angle(0.0), _double_angle(0.2))),
    Published("Fig. 4, text", "saddles and centres at (0, 6.2, −3, 3.3), (0.19, 6.15, −3.1, 3.29), (0.32, 5.8, −3.13, "
              "3.28)", "positions for λ1 = 100, 300, 500", "wrong",
              "(−0.169, 6.280, −3.052, 3.224), (−0.318, 6.442, −3.053, 3.211), (−0.453, 6.589, −3.054, 3.201): the "
              "left saddle moves left as λ1 grows", "equilibrium condition at them (for the print: the paper's own (23))",
              lambda: (_fig4(FIG4_PRINTED, True), _fig4(FIG4_TRUE, False))),
    Published("before eq. (35)", "F = 4.72, G1 = 2.54", "constants of x(0) = (2.5, 4, 0.1), λ1 = 100", "wrong",
              "F = 4.7170 but the printed (30) gives G1 = 3.5357; the true invariants are A = 4.8260, G = 4.1950",
              "printed (30) at the data minus 2.54; true "
              "invariant at the data minus 4.195001333156914", lambda: (_g1(False) - G1_PRINTED, _g1(True) - 4.195001333156914), 1e-9),
    Published("Fig. 6", "the line x1 + x2 = 0 parts stable from unstable equilibria", "dividing line", "wrong",
              "the curve (x1+a)(x1+b) = x2² does (the line only where a = b = 0)",
              "share of ten equilibria near the folds misjudged (λ1 = 500)", _dividing),
    Published("Fig. 6, item 4", "x2² − x1² − 4b x1 − 4 atan(x1/x2) = 0", "meeting of separatrix and plane x3 = 0", "wrong",
              "U(x1, x2) = U(saddle on the same circle): the constant differs from circle to circle",
              "the expression at the saddle of the circle A = 4.826 (it lies on its own separatrix); true "
              "invariant at the loop's far end minus at the saddle",
              lambda: (_item4(), _loop_ends()), 1e-10),
    Published("after eq. (33)", "saddle and centre merge at (1, −1, 0) and (−1, 1, 0)", "fold points",
              "right only for these data", "true for λ1 = 0; in general at x2 = h, x1 = −b − 1/h with h⁴ − c h − 1 = 0",
              "rate x3' there (print), (x1+a)(x1+b) − x2² (corrected), λ1 = 100",
              lambda: (_contact_points(False), _contact_points(True))),
    Published("eq. (34)", "dx1/dx3 = x3/(x1+b)", "extremes of the components", "wrong",
              "dx1/dx3 = x2 x3/(x2 (x1+b) + 1): the torque is missing in print",
              "slope of the motion minus the formula",
              lambda: (_slope("x3/(x1+b)"), _slope("x2*x3/(x2*(x1+b)+1)"))),
    Published("eq. (40)", "x2⁴ + (b²−F²) x2² − 2b x2 + 1 = 0", "where x3 has its extremes", "wrong",
              "x2⁴ + (c²−A²) x2² + 2c x2 + 1 = 0 with c = b − a; the sign of the odd term is wrong even with the printed F",
              "the quartic at a true crossing",
              lambda: (_quartic(lambda h, a, b, F2: h**4 + (b * b - F2) * h * h - 2 * b * h + 1, "F"),
                       _quartic(lambda h, a, b, F2: h**4 + ((b - a)**2 - F2) * h * h + 2 * (b - a) * h + 1, "A"))),
)
