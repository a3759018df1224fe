"""Amer et al. 2024: torque on the major axis (eqs (41)-(43), Figs 8-15) and on the middle axis (eqs (44)-(84))."""
from __future__ import annotations

import math

from ...physics.body import Body
from ...physics.scaling import scaling
from ...physics.scene import ScaledGyrostat
from .general import major_axis_ideal
from .published import Published, drift, generic, middle_equilibria, misjudged, number, parse, symbols

# Figs 8-11: ranges of x2 and x3 over tau in [0, 15] from (4.5, 1.8, 3.4); lambda1 -> ((x2), (x3)); printed in the
# text, and from the equations (Taylor integration; the smallest and largest value of the dense output).
RANGES_PRINTED = {100: ((-4, 4), (-4.1, 4)), 300: ((-4.2, 4), (-5, 4)), 500: ((-4.5, 4), (-6, 4))}
RANGES_TRUE = {100: ((-3.8126, 3.8127), (-3.8591, 3.8642)), 300: ((-3.7568, 3.7571), (-3.8839, 3.8946)),
               500: ((-3.7127, 3.7123), (-3.9075, 3.9206))}


def _ranges(table):
    """Largest distance of the table's ranges from those of the motion."""
    import numpy as np

    from ...answers.trajectory import trajectory
    worst = 0.0
    for lam, limits in table.items():
        run = trajectory(ScaledGyrostat(lam / 500, lam / 250, (1, 0, 0)), (4.5, 1.8, 3.4), np.linspace(0, 15, 60001))
        for row, (low, high) in zip((1, 2), limits):
            states = np.asarray(run.states)[:, row]
            worst = max(worst, abs(states.min() - low), abs(states.max() - high))
    return worst


def _capture():
    """J of the end state minus J of the start, plus 2 c tau: the law that forbids a bounded motion. Fig. 12,
    lambda1 = 100: the print's "stable" would keep J; start (0, -1, 5), tau = 15."""
    from ...answers.trajectory import trajectory
    c = 0.2
    run = trajectory(ScaledGyrostat(0.2, 0.4, (1, 0, 0)), (0.0, -1.0, 5.0), (0.0, 15.0))
    first, last = (x2 * x2 + x3 * x3 - 2 * c * x1 for x1, x2, x3 in (run.states[0], run.states[-1]))
    return last - first, last - first + 2 * c * 15


def _major_rule():
    """The printed rule on the line of equilibria that a = b has: x1 = -a, x2 x3 = -1."""
    points = [(-0.2, -1 / g, g) for g in (-3, -1.6, -0.6, -0.3, 0.3, 0.6, 1.6, 3)]
    return (misjudged(lambda x: x[2] > 1, points, 0.2, 0.2), misjudged(lambda x: abs(x[2]) > abs(x[1]), points, 0.2, 0.2))


def _solution(x1, x3):
    """Mismatch of x1(alpha), x3(alpha) with dx1/dalpha = x3, dx3/dalpha = x1 + b and with their start."""
    import sympy as sp
    al, p, r, b = sp.Symbol("alpha"), sp.Symbol("p"), sp.Symbol("r"), symbols()["b"]
    u, v = parse(x1, alpha=al, p=p, r=r), parse(x3, alpha=al, p=p, r=r)
    tests = (u.diff(al) - v, v.diff(al) - u - b, u.subs(al, 0) - p, v.subs(al, 0) - r)
    point = {al: sp.Rational(3, 5), p: sp.Rational(17, 10), r: sp.Rational(-1, 5), b: sp.Rational(2, 5)}
    return max(abs(number(t, point)) for t in tests)


def _second_derivative(formula):
    """alpha'' of the true motion minus the formula, from x(0) = (1.7, 1.1, -0.2), alpha = 0.6, a = 0.2, b = 0.4."""
    import sympy as sp
    al, p, r = sp.Rational(3, 5), sp.Rational(17, 10), sp.Rational(-1, 5)
    a, b = sp.Rational(1, 5), sp.Rational(2, 5)
    Y = (p + b) * sp.cosh(al) + r * sp.sinh(al)
    x3 = (p + b) * sp.sinh(al) + r * sp.cosh(al)
    return float((1 - x3 * (Y - b + a) - formula(sp, al, p, r, a, b, Y, x3)).evalf(30))


def _own_52(argument):
    """Printed (51) minus (52) with the given argument of the last sinh."""
    p, r, al, a, b = 1.7, -0.2, 0.6, 0.2, 0.4
    L, M, N = (p * p + r * r) / 2, p * r, (p * p - r * r) / 2
    psi = math.atanh(M / L)
    eq51 = 1 - L * math.sinh(2 * al) - M * math.cosh(2 * al) - (a + b) * (p * math.sinh(al) + r * math.cosh(al))
    return eq51 - (1 - math.sqrt(L * L - M * M) * math.sinh(2 * al + psi)
                   - (a + b) * math.sqrt(2 * N) * math.sinh(argument(al, psi)))


def _sinh_psi(function):
    L, M = (1.7**2 + 0.2**2) / 2, -0.34
    return function(math.atanh(M / L)) - M / L


def _printed_71():
    """Drift of the printed (71) at a state where its atanh is real."""
    import sympy as sp
    s = symbols()
    at = {**generic(), s["x3"]: sp.Rational(1, 2)}
    return drift("2*x2**2+(x1**2+x3**2)*(1+2*(a+b)/sqrt(x1**2-x3**2))-2*atanh(2*x1**2*x3**2/(x1**2+x3**2))", "middle", at)


def _first_equilibrium():
    """(X1+b)^2 - X3^2 - I at the point (61), (62) of Table 3's data (lambda1 = 100), and at the root of the quartic."""
    from scipy.optimize import brentq
    a, b, N = 0.2, 0.4, (1.7**2 - 0.2**2) / 2
    printed = (a / (a + b) * math.sqrt(N / 2), (a + b) / (a * (math.sqrt(N / 2) + a + b)))
    invariant = (1.7 + b) ** 2 - 0.2**2
    g = brentq(lambda g: (1 / g + b - a) ** 2 - g * g - invariant, 0.05, 5, xtol=1e-15)
    return tuple((x1 + b) ** 2 - x3**2 - invariant for x1, x3 in (printed, (1 / g - a, g)))


def _always_stable():
    """Equilibria with c = 2.5 (a = 0.5, b = 3): share that "all are stable" misjudges."""
    points = middle_equilibria(0.5, (-3, -2, -1.5, -1, -0.8, -0.5, 0.5, 1.5))
    return (misjudged(lambda x: True, points, 0.5, 3.0),
            misjudged(lambda x: (x[0] + 0.5) * (x[0] + 3) + x[2] ** 2 > 0, points, 0.5, 3.0))


def _paper_data_all_stable(line):
    """Share of equilibria misjudged for the paper's data (lambda1 = 100, 300, 500)."""
    total = 0.0
    for lam in (100, 300, 500):
        a, b = lam / 500, lam / 250
        rule = (lambda x: x[0] > x[2]) if line else (lambda x: True)
        total += misjudged(rule, middle_equilibria(a), a, b) / 3
    return total


def _plane_rate(shift):
    """Rate of x1 + shift b - x3 in the plane where it is zero, x2 = 1.3, x3 = 2.5, b = 0.4."""
    b, x2, x3 = 0.4, 1.3, 2.5
    x1 = x3 - shift * b
    return x2 * x3 - x2 * (x1 + b)


def _plane_integral(formula):
    """Drift in the invariant plane x3 = x1 + b."""
    s = symbols()
    at = generic()
    at[s["x3"]] = at[s["x1"]] + at[s["b"]]
    return drift(formula, "middle", at)


def _limit_x1(value):
    """x1 minus the value on x1 + b = (x1(0)+b) exp(-alpha), alpha = 40, start 2.5, b = 0.4."""
    return (2.5 + 0.4) * math.exp(-40.0) - 0.4 - value


def _plane_equilibria(factor):
    """(76) tried on its plane: x1 + factor b - x3 and x3 (x1 + a) - 1 at X3 = (c' + sqrt(c'^2 + 4))/2."""
    a, b = 0.2, 0.4
    offset = -a if factor == 0 else b - a
    x3 = (offset + math.sqrt(offset**2 + 4)) / 2
    x1 = x3 - factor * b
    return max(abs(x3 * (x1 + a) - 1), abs(x1 + b - x3))


def _time_scale():
    """Seconds in one tau, from the scaling of the package (u = 1)."""
    return float(scaling(Body((2000, 1500, 1000)), 1).time)


def _least_quartic(c):
    """Smallest g^4 + c g + 1; zero or less where a saddle exists."""
    import numpy as np
    g = np.cbrt(-c / 4)
    return float(g**4 + c * g + 1)


def _own_76():
    """Largest rate at the printed (76), a = 0.2, b = 0.4."""
    x = (-0.2 + math.sqrt(0.2**2 + 4)) / 2
    return abs(1 - x * (x + 0.2))


def _spin_plane_rate(c):
    """Largest rate at x3 = -(c + sqrt(c^2-4))/2, x1 + b = -x3, with a = 0, b = c."""
    x3 = -(c + math.sqrt(c * c - 4)) / 2
    x1 = -x3 - c
    return abs(1 - x3 * x1)


ROWS = (
    Published("after eq. (41)", "equilibria X2 X3 = −1", "torque on the major axis", "wrong",
              "none unless a = b; then X1 = −a with X2 X3 = −1",
              "whether the three equations contradict each other (Gröbner basis {1}): at a ≠ b; at a = b",
              lambda: (major_axis_ideal("1/5", "2/5"), major_axis_ideal("1/5", "1/5"))),
    Published("after eq. (41)", "stable for X3 > 1, unstable for |X2| > 1", "stability on it (a = b)", "wrong",
              "stable if and only if |X3| > |X2|, so also for X3 < −1",
              "share of eight equilibria judged against their spectrum", _major_rule),
    Published("eq. (43)", "dx1/dα − x2 = 0, dx2/dα + x1 + a = 0", "major axis in the variable α' = x1", "misprint",
              "it repeats (15); the true dx2/dα is −x3 (x1+a)/x1", "dx2/dα of the motion minus the formula",
              lambda: (number(parse("-x3*(x1+a)/x1") - parse("-x1-a")), number(parse("-x3*(x1+a)/x1 + x3*(1+a/x1)")))),
    Published("Figs 8-11, text", "x2 in [−4, 4], [−4.2, 4], [−4.5, 4]; x3 in [−4.1, 4], [−5, 4], [−6, 4]",
              "amplitude grows with λ1 = 100, 300, 500", "wrong",
              "x2 in ±3.8126, ±3.757, ±3.713; x3 in [−3.859, 3.864], [−3.884, 3.895], [−3.907, 3.921]: no growth",
              "largest distance from the ranges of the motion", lambda: (_ranges(RANGES_PRINTED), _ranges(RANGES_TRUE)),
              2e-4),
    Published("Fig. 12, text", "λ1 = 100: the body has a stable motion", "start (0, −1, 5) on the major axis", "wrong",
              "x2² + x3² − 2(b−a) x1 falls by exactly 2(b−a)τ: every motion with b > a leaves and spins up about axis "
              "1; this one at τ = 60.3, the run of the figure ends at 15",
              "change of that quantity over the run; change plus 2(b−a)τ", _capture, 1e-10),
    Published("captions of Figs 8-15", "τ in [0, 15] s", "time", "misprint", "τ is a number; t = τ/√k = 3.464 τ s",
              "1 − √k (seconds and τ coincide only for k = 1)",
              lambda: (1 - math.sqrt(1 / 12), _time_scale() - math.sqrt(12))),
    Published("after eq. (44)", "equilibria (X1+a) X3 = 1", "middle axis", "right", "", "rate on it",
              lambda: (max(abs(1 - x3 * (x1 + 0.2)) for x1, _, x3 in middle_equilibria(0.2)), 0.0)),
    Published("eq. (47)", "x1 = b + x3(0) sinh α + x1(0) cosh α, x3 = x3(0) cosh α + x1(0) sinh α", "solution",
              "wrong", "x1 = −b + (x1(0)+b) cosh α + x3(0) sinh α, x3 = (x1(0)+b) sinh α + x3(0) cosh α",
              "equations and start", lambda: (_solution("b+r*sinh(alpha)+p*cosh(alpha)", "r*cosh(alpha)+p*sinh(alpha)"),
              _solution("-b+(p+b)*cosh(alpha)+r*sinh(alpha)", "(p+b)*sinh(alpha)+r*cosh(alpha)"))),
    Published("eqs (48), (53)", "x1² − x3² = 2N", "first integral", "wrong", "(x1+b)² − x3² = I",
              "rate of change along the motion",
              lambda: (drift("x1**2-x3**2", "middle"), drift("(x1+b)**2-x3**2", "middle"))),
    Published("eqs (49), (51)", "α'' = 1 − (a+b)[x1(0) sinh α + x3(0) cosh α] − L sinh 2α − M cosh 2α",
              "reduced equation", "wrong", "α'' = 1 − x3 (x1 + a) with the corrected (47)", "α'' minus the formula",
              lambda: (_second_derivative(lambda sp, al, p, r, a, b, Y, x3: 1 - (a + b) * (p * sp.sinh(al) + r * sp.cosh(al))
                       - (p * p + r * r) / 2 * sp.sinh(2 * al) - p * r * sp.cosh(2 * al)),
                       _second_derivative(lambda sp, al, p, r, a, b, Y, x3: 1 - x3 * (Y + a - b)))),
    Published("eqs (52), (55)", "… − (a+b)√(2N) sinh(α + ψ2)", "(51) rewritten", "wrong",
              "the argument is α + ψ2/2, so that γ = 2α + ψ2 leaves sinh(γ/2)", "(51) minus (52)",
              lambda: (_own_52(lambda al, psi: al + psi), _own_52(lambda al, psi: al + psi / 2))),
    Published("eq. (57)", "sinh ψ2 = M/L", "from (53)", "misprint", "tanh ψ2 = M/L", "difference",
              lambda: (_sinh_psi(math.sinh), _sinh_psi(math.tanh))),
    Published("eqs (61), (62)", "X1 = a√(N/2)/(a+b), X3 = (a+b)/(a(√(N/2)+a+b))", "the centre for given invariants",
              "wrong", "the roots of X3 (X1+a) = 1 with (X1+b)² − X3² = I: a quartic",
              "(X1+b)² − X3² − I for Table 3's data", _first_equilibrium, 1e-11),
    Published("eqs (66), (70), (71)", "2x2² + (x1²+x3²)[1 + 2(a+b)√(2/N)] − 2 atanh(2x1²x3²/(x1²+x3²)) = G2",
              "second integral", "wrong", "x2² + (x1+a)² − 2 ln|x1 + b + x3| is constant",
              "rate of change along the motion",
              lambda: (_printed_71(),
                       drift("x2**2+(x1+a)**2-2*log(x1+b+x3)", "middle"))),
    Published("eq. (68)", "V'' > 0: every equilibrium off the planes is stable", "stability, middle axis",
              "right only for these data", "stable if and only if (X1+a)(X1+b) + X3² > 0; unstable ones exist when "
              "|b−a| > 4·3^(−3/4) = 1.7548", "share of eight equilibria misjudged at c = 2.5", _always_stable),
    Published("after eq. (71), Fig. 16", "separatrices cut space into three regions, one of them spin-up",
              "middle axis, λ1 = 100, 300, 500", "wrong", "no saddle, no separatrix for |b−a| < 1.7548: all motions "
              "are periodic except those on the plane x1 + b = −x3, which spin up",
              "saddle condition: the smallest of g⁴ + c g + 1 over all equilibria, c = 1, must reach 0",
              lambda: (_least_quartic(1.0), _least_quartic(4 * 3**-0.75)), 1e-9),
    Published("Fig. 17, items 1, 3", "the line x1 − x3 = 0 parts stable from unstable equilibria", "middle axis",
              "wrong", "for the paper's data every equilibrium is stable", "share misjudged (λ1 = 100, 300, 500)",
              lambda: (_paper_data_all_stable(True), _paper_data_all_stable(False))),
    Published("Fig. 17, item 1", "no equilibrium on x1² − x3² = 0", "middle axis", "wrong",
              "X1 = X3 = (−a ± √(a²+4))/2 lie on it, by the paper's own (76)",
              "rates at that point vanish: 1 if they do (print), rate (corrected)",
              lambda: (float(abs(_own_76()) < 1e-12), _own_76())),
    Published("eq. (72), Table 4", "x1(0) = x3(0) is kept", "invariant plane", "wrong", "x1 + b = x3 is kept",
              "rate of departure from the plane", lambda: (_plane_rate(0), _plane_rate(1))),
    Published("eq. (76)", "X1 = X3 = (−a ± √(a²+4))/2", "equilibria in the invariant plane", "wrong",
              "X3 = (c ± √(c²+4))/2, X1 = X3 − b, c = b − a; the printed points are equilibria outside it",
              "distance from equilibrium and plane", lambda: (_plane_equilibria(0), _plane_equilibria(1))),
    Published("eqs (78), (79)", "x1²/2 + x2²/2 + (a+b) x1 − ln x1 = G3", "integral in the plane", "wrong",
              "(x2² + x3²)/2 − (b−a) x3 − ln|x3| is constant for x3 = x1 + b", "rate of change in the plane",
              lambda: (_plane_integral("x1**2/2+x2**2/2+(a+b)*x1-log(x1)"),
                       _plane_integral("(x2**2+x3**2)/2-(b-a)*x3-log(x3)"))),
    Published("eqs (80), (84)", "x1 = b + x1(0) e^(−α), tends to 0", "spin-up plane", "wrong",
              "x1 = −b + (x1(0)+b) e^(−α), tends to −b", "x1 at α = 40 minus the limit",
              lambda: (_limit_x1(0.0), _limit_x1(-0.4))),
    Published("after eq. (82)", "no equilibrium in the spin-up plane", "x1 + b = −x3", "right only for these data",
              "true for |b−a| < 2; for |b−a| ≥ 2, X3 = −(c ± √(c²−4))/2", "discriminant c² − 4 must be negative: "
              "its positive part at c = 2.5; rate at the equilibrium",
              lambda: (max(0.0, 2.5**2 - 4), _spin_plane_rate(2.5))),
)
