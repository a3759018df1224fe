"""Claims that no formula says of a gyrostat under a torque, measured: what figures show, which equilibria
there are and how stable. TESTS: name -> (residual of the printed claim, of the corrected one), of all papers,
with the arguments that a row gives."""
from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction

import numpy as np

from ...answers.simulate import trajectory
from ...equilibrium.stability import invariants
from ...physics.body import Body
from ...physics.coefficients import scaling
from .. import table as paper
from ..printed_integrals import height
from .other_papers import TESTS as OTHERS
from .trends import missed, side, trend


# --- A gyrostat under a torque of any direction
def spectrum_is_stable(x, a: float, b: float) -> bool:
    """Whether no eigenvalue of the Jacobian at x has a positive real part; x away from the folds."""
    jacobian = [[0, x[2], x[1]], [-x[2], 0, -(x[0] + a)], [x[1], x[0] + b, 0]]
    return bool(np.linalg.eigvals(jacobian).real.max() < 1e-7)


def misjudged(rule, equilibria, a: float, b: float) -> float:
    """Share of the equilibria at which `rule(x)` differs from the spectrum."""
    return sum(bool(rule(x)) != spectrum_is_stable(x, a, b) for x in equilibria) / len(equilibria)


HEIGHTS = (-3, -1.5, -0.7, -0.3, 0.3, 0.7, 1.5, 3)


def minor_equilibria(b: float, heights=HEIGHTS):
    """True equilibria of the minor axis: x2 = h, x1 + b = -1/h, x3 = 0."""
    return [(-1 / h - b, h, 0.0) for h in heights]


def middle_equilibria(a: float, heights=HEIGHTS):
    """True equilibria of the middle axis: x3 = g, x1 + a = 1/g, x2 = 0."""
    return [(1 / g - a, 0.0, g) for g in heights]


def three_torque_equilibria(a, b, mu):
    """All equilibria for three nonzero torques: X = x1 + a solves X (X + b - a) = mu2 mu3 / mu1."""
    mean, product = (b - a) / 2, mu[1] * mu[2] / mu[0]
    square = mean * mean + product
    if square < 0:
        return []
    roots = {-mean - math.sqrt(square), -mean + math.sqrt(square)}
    return [(X - a, -mu[2] / (X + b - a), mu[1] / X) for X in roots]


def _largest_rate(points, a, b, mu):
    return max(max(abs(x2 * x3 + mu[0]), abs(-x3 * (x1 + a) + mu[1]), abs(x2 * (x1 + b) + mu[2]))
               for x1, x2, x3 in points)


def _printed_eight():
    """Largest rate at the eight points of (9), and at the two true ones; mu = (1, 2, 2)/3, a = 0.2, b =
    0.4."""
    a, b, mu = 0.2, 0.4, (1 / 3, 2 / 3, 2 / 3)
    true = three_torque_equilibria(a, b, mu)
    printed = [(x1, s2 * math.sqrt(mu[2] * mu[0] * (x1 + a) / (mu[1] * (x1 + b))),
                s3 * math.sqrt(mu[0] * mu[1] * (x1 + b) / (mu[2] * (x1 + a))))
               for x1, _, _ in true for s2 in (1, -1) for s3 in (1, -1)]
    return _largest_rate(printed, a, b, mu), _largest_rate(true, a, b, mu)


def _exists_below_zero():
    """Two equilibria with mu1 mu2 mu3 < 0: the printed rule counts none. Number missed; rate at the true
    ones."""
    a, b, mu = 0.2, 0.4, (0.95, 0.05, -0.1)
    points = three_torque_equilibria(a, b, mu)
    return len(points), _largest_rate(points, a, b, mu)


def major_axis_ideal(a, b):
    """1 where the equilibrium equations of a torque on axis 1 contradict each other (Groebner basis {1}),
    else 0."""
    import sympy as sp
    x1, x2, x3 = sp.symbols("x1:4")
    basis = sp.groebner([x2 * x3 + 1, x3 * (x1 + sp.Rational(a)), x2 * (x1 + sp.Rational(b))], x1, x2, x3)
    return float(basis.exprs == [1])


def _contradiction():
    """Whether the equations of a torque along the wheel contradict each other: at a != b, and at a = b."""
    return major_axis_ideal("1/5", "2/5"), major_axis_ideal("1/5", "1/5")


def _characteristic():
    """How far the printed coefficients of zeta^3 + m zeta + n are from those of the Jacobian, at a rational
    state."""
    scene = paper.printed_scene("major", 100)
    a, b = scene.exact_ab
    x1, x2, x3 = state = tuple(map(Fraction, ("7/5", "3/4", "5/6")))
    m, n = invariants(scene.quadratic(), state)
    return max(abs(m - (x1 + a) * (x1 + b) + x2**2 - x3**2), abs(n - x2 * x3 * (2 * x1 + a + b))), 0.0


# --- On the major and on the middle axis
# Figs 8-11: ranges of x2 and x3 over tau in [0, 15] from (4.5, 1.8, 3.4), a pair for each lambda1: printed in
# the text
RANGES_PRINTED = [((-4, 4), (-4.1, 4)), ((-4.2, 4), (-5, 4)), ((-4.5, 4), (-6, 4))]


def ranges(axis: int) -> list[tuple[float, float]]:
    """Range of a component of the motions of Fig. 8 over tau in [0, 15], by wheel."""
    out = []
    for lam in paper.LAMBDAS:
        run = trajectory(paper.printed_scene("major", lam), paper.START_MAJOR, np.linspace(0, 15, 60001))
        x = np.asarray(run.states)[:, axis - 1]
        out.append((float(x.min()), float(x.max())))
    return out


def _ranges():
    """Largest distance of the printed ranges from those of the motion; how many steps of the wheel do not
    narrow that of x2 and widen that of x3."""
    true = [ranges(2), ranges(3)]
    worst = max(abs(end - said) for axis, pairs in enumerate(true) for pair, row in zip(pairs, RANGES_PRINTED)
                for end, said in zip(pair, row[axis]))
    x2, x3 = ([high - low for low, high in pairs] for pairs in true)
    return worst, missed(x2, "falls") + missed(x3, "rises")


def _spins_up():
    """How many of the motions of Fig. 8 do not gain 100 of x1, to 1 %, over tau from 300 to 400."""
    runs = [trajectory(paper.printed_scene("major", lam), paper.START_MAJOR, (0.0, 300.0, 400.0)).states
            for lam in paper.LAMBDAS]
    return sum(abs(states[2][0] - states[1][0] - 100) > 1 for states in runs), 0


def _capture():
    """x2^2 + x3^2 - 2 c x1 of the end of Fig. 12, lambda1 = 100, less that of its start: a stable motion
    would keep it; plus 2 c tau, the law that forbids a bounded motion."""
    c = 0.2
    run = trajectory(paper.printed_scene("major", 100), paper.START_CAPTURED, paper.SPAN)
    first, last = (x2 * x2 + x3 * x3 - 2 * c * x1 for x1, x2, x3 in (run.states[0], run.states[-1]))
    return last - first, last - first + 2 * c * 15


def _major_rule():
    """Whether there is no equilibrium at a != b; at a = b, where the line x1 = -a, x2 x3 = -1 is of them, how
    often x3 > 1 is not stable or |x2| > 1 not unstable."""
    points = [(-0.2, -1 / g, g) for g in (-3, -1.6, -0.6, -0.3, 0.3, 0.6, 1.6, 3)]
    wrong = [(x[2] > 1 and not stable) or (abs(x[1]) > 1 and stable)
             for x, stable in ((x, spectrum_is_stable(x, 0.2, 0.2)) for x in points)]
    return major_axis_ideal("1/5", "2/5"), sum(wrong) + misjudged(lambda x: abs(x[2]) > abs(x[1]), points,
                                                                  0.2, 0.2)


def _always_stable():
    """Equilibria with c = 2.5 (a = 0.5, b = 3): share that "all are stable" misjudges."""
    points = middle_equilibria(0.5, (-3, -2, -1.5, -1, -0.8, -0.5, 0.5, 1.5))
    return (misjudged(lambda x: True, points, 0.5, 3.0),
            misjudged(lambda x: (x[0] + 0.5) * (x[0] + 3) + x[2] ** 2 > 0, points, 0.5, 3.0))


def _middle_line():
    """Share of the paper's equilibria that the printed line misjudges; that "all are stable" does."""
    total = np.zeros(2)
    for lam in paper.LAMBDAS:
        a, b = lam / 500, lam / 250
        total += [misjudged(rule, middle_equilibria(a), a, b) / 3
                  for rule in (lambda x: x[0] > x[2], lambda x: True)]
    return tuple(total)


def _seconds():
    """1 less the root of k; the seconds of one tau, from the scaling of the package (u = 1), less its
    inverse."""
    return 1 - math.sqrt(1 / 12), float(scaling(Body(paper.INERTIA), Fraction(1)).time) - math.sqrt(12)


def _off_the_planes():
    """Of the bounded motion from (2.5, 4, 2.9), lambda1 = 300: the farthest of the extremes of x1 and x2 from
    the planes x3 = 0 and x2 = 0; with x1 = -a in the place of x2 = 0 for those of x2."""
    a = 0.6
    run = trajectory(paper.printed_scene("minor", 300), (2.5, 4.0, 2.9), np.linspace(0, 20, 40001))
    x = np.asarray(run.states)
    at = [np.nonzero(np.diff(np.sign(np.diff(x[:, n]))))[0] + 1 for n in (0, 1)]
    of_planes, of_own = np.abs(x[:, [2, 1]]).min(axis=1), np.minimum(np.abs(x[:, 2]), np.abs(x[:, 0] + a))
    return (max(float(of_planes[part].max()) for part in at),
            max(float(of_planes[at[0]].max()), float(of_own[at[1]].max())))


# --- On the minor axis. The circle of a start has the radius A = hypot(x1 + a, x2), and c = b - a; the places
# on it are alpha = 2 atan2(x1 + a, x2)
A, C = math.hypot(2.7, 4), 0.2  # of the paper's start, lambda1 = 100
def _circle(lam):
    """(A, c) of the paper's start."""
    return math.hypot(2.5 + lam / 500, 4), lam / 500


def _fig4(table, turns=0, as_printed=False):
    """Largest residual of the equilibrium condition at the places of a table, so many turns on; as_printed:
    of the paper's own (23)."""
    worst = 0.0
    for lam, (saddles, centres) in table.items():
        radius, offset = (math.hypot(2.5, 4), -lam / 250) if as_printed else _circle(lam)
        for half in (alpha / 2 + math.pi * turns for alpha in (*saddles, *centres)):
            worst = max(worst, abs(1 + radius * math.cos(half) * (radius * math.sin(half) + offset)))
    return worst


def places(lam: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """(left and right saddle, left and right centre) of Fig. 4, alpha, of a turn from -6 pi/5 on."""
    radius, c = _circle(lam)
    alphas: tuple[list[float], list[float]] = ([], [])
    for h in heights_on(radius, c):
        alpha = 2 * math.atan2(-1 / h - c, h)
        alphas[not _is_saddle(h, c)].append((alpha + 1.2 * math.pi) % (4 * math.pi) - 1.2 * math.pi)
    saddles, centres = (tuple(sorted(part)) for part in alphas)
    return saddles, centres


def _true_places() -> dict:
    return {lam: places(lam) for lam in paper.LAMBDAS}


def heights_on(radius, c):
    """x2 of the equilibria on a circle: h^2 + (c + 1/h)^2 = radius^2."""
    roots = np.roots([1, 0, c * c - radius * radius, 2 * c, 1])
    return [float(h.real) for h in roots if abs(h.imag) < 1e-9]


def _is_saddle(h, c):
    return h**4 - c * h - 1 > 0


def _wells(radius, c):
    """x2 of the centres on a circle."""
    return [h for h in heights_on(radius, c) if not _is_saddle(h, c)]


def _fold_radius():
    """The smallest radius found on the hyperbola, c = 0.2, less the printed root of 2; less the true one."""
    heights = np.concatenate([-np.geomspace(0.1, 10, 40001), np.geomspace(0.1, 10, 40001)])
    smallest = np.sqrt(np.min(heights**2 + (C + 1 / heights) ** 2))
    return smallest - math.sqrt(2), smallest - paper.fold_radii(C)[0]


def _dividing():
    """Equilibria close to the folds, lambda1 = 100, that the printed line x1 + x2 = 0 misjudges (it calls the
    side |x1| > |x2| of the hyperbola stable), and that the curve does."""
    a, b = 0.2, 0.4
    points = minor_equilibria(b, (-1.1, -0.97, -0.93, -0.85, -0.7, 0.9, 1.02, 1.08, 1.15, 1.3))
    return (misjudged(lambda x: abs(x[0]) > abs(x[1]), points, a, b),
            misjudged(lambda x: (x[0] + a) * (x[0] + b) > x[1] ** 2, points, a, b))


def _stability_after_13():
    points = minor_equilibria(0.4)
    return (misjudged(lambda x: abs(x[1]) > 1, points, 0.2, 0.4),
            misjudged(lambda x: (x[0] + 0.2) * (x[0] + 0.4) > x[1] ** 2, points, 0.2, 0.4))


def _merging():
    """x2 (x1 + b) + 1 at the printed merging point of saddle and centre, b = 0.4; at the true ones
    (x1 + b)(x1 + a) - x2^2, which vanishes at a fold."""
    return (-1 + 0.4) * 1 + 1, max(abs((-1 / h) * (-1 / h - C) - h * h) for h in paper.folds(C))


def _item4():
    """The printed expression at the left saddle, and the true invariant at the far end of its loop less that
    at the saddle."""
    from scipy.optimize import brentq
    (saddle, _), (centre, _) = places(100)
    true = height(A, C)
    end = brentq(lambda alpha: true(saddle) - true(alpha), -2 * math.pi, centre, xtol=1e-15)

    def invariant(alpha):
        X, x2 = A * math.sin(alpha / 2), A * math.cos(alpha / 2)
        return x2**2 - X**2 - 4 * C * X - 2 * alpha
    x1, x2 = A * math.sin(saddle / 2) - 0.2, A * math.cos(saddle / 2)
    return (x2**2 - x1**2 - 4 * 0.4 * x1 - 4 * math.atan2(x1, x2), invariant(end) - invariant(saddle))


def loop_area(lam: float, side: int) -> float:
    """The area of a loop in the plane (alpha, x); side 0: left, 1: right."""
    from scipy.integrate import quad
    from scipy.optimize import brentq
    true, (saddle, centre) = height(*_circle(lam)), (pair[side] for pair in places(lam))
    square = lambda alpha: 2 * (true(saddle) - true(alpha))  # of x, by the corrected (25)
    end = brentq(square, centre - math.pi, centre)
    return 2 * quad(lambda alpha: math.sqrt(max(square(alpha), 0.0)), end, saddle)[0]


def _loop_order(lambda1, smaller):
    """By how much the loop named ("left", "right") is larger than the other; by how much it is smaller."""
    left, right = (loop_area(lambda1, side) for side in (0, 1))
    return (max(0.0, left - right), max(0.0, right - left))[::1 if smaller == "left" else -1]


def _saddles():
    """How many saddles less than two, or more, the circles of Fig. 4 carry."""
    rows = [sum(_is_saddle(h, c) for h in heights_on(radius, c)) for radius, c in map(_circle, paper.LAMBDAS)]
    return sum(abs(number - 2) for number in rows), 0


def _stable_parts():
    """How many more or fewer than two parts of the hyperbola are stable, lambda1 = 100."""
    h = np.linspace(1e-3, 5, 5000)
    parts = 0
    for branch in (-h[::-1], h):  # the two do not meet at h = 0
        stable = (1 / branch) * (1 / branch + C) > branch * branch
        parts += int((np.diff(np.concatenate([[0], stable.astype(int), [0]])) == 1).sum())
    return abs(parts - 2), 0


def _arc(inside):
    """Turns of (x1 + a, x2) on its circle, lambda1 = 100: beyond one whole turn, and short of it. inside:
    from (2.5, 4, 0.1), in a loop; else from (2.5, 4, 6), the other way round."""
    start = (2.5, 4.0, 0.1 if inside else 6.0)
    run = trajectory(paper.printed_scene("minor", 100), start, np.linspace(0, 40, 8001))
    x = np.asarray(run.states)
    turns = float(np.ptp(np.unwrap(np.arctan2(x[:, 0] + 0.2, x[:, 1])))) / (2 * math.pi)
    return (max(0.0, turns - 1), max(0.0, 1 - turns))[::1 if inside else -1]


def _directions(lambda1):
    """Share of motions outside the loops, from either direction, that turn with x3 > 0 in the end: what a
    claim of two directions denies; share of the others."""
    ends = [trajectory(paper.printed_scene("minor", lambda1), (2.5, 4.0, x3), (0.0, 60.0)).states[-1][2]
            for x3 in (-9.0, -7.0, 6.0, 8.0)]
    up = sum(end > 0 for end in ends) / len(ends)
    return up, 1 - up


def _where_separatrices_end():
    """Radius of the circle of a separatrix's end less that of its start, for the print's end on the circle of
    radius sqrt(2), and for the saddles of the circle itself (lambda1 = 100)."""
    ends = [math.hypot(h, C + 1 / h) for h in heights_on(A, C) if _is_saddle(h, C)]
    return A - math.sqrt(2), max(abs(end - A) for end in ends)


TESTS: dict[str, Callable[..., tuple]] = {
    "trend": trend, "side": side, **OTHERS,
    # of a gyrostat under a torque
    "existence": _exists_below_zero, "eight": _printed_eight, "characteristic": _characteristic,
    "contradiction": _contradiction, "major stability": _major_rule, "spin-up": _spins_up,
    "ranges": _ranges, "capture": _capture,
    "seconds": _seconds, "extremes off the planes": _off_the_planes, "always stable": _always_stable,
    "middle dividing line": _middle_line,
    # on the minor axis
    "stability": _stability_after_13, "fold radius": _fold_radius, "dividing line": _dividing,
    "positions": lambda: (_fig4(paper.FIG4, as_printed=True), _fig4(_true_places())),
    "repetition": lambda: (_fig4(_true_places(), 1), _fig4(_true_places(), 2)),
    "loop areas": _loop_order, "two separatrices": _saddles, "stable parts": _stable_parts, "arc": _arc,
    "directions": _directions, "end of a separatrix": _where_separatrices_end, "merging": _merging,
    "figure 6 item 4": _item4,
    # centres missing on a circle of radius 1.2, and there
    "every radius": lambda: (1 - len(_wells(1.2, C)), len(_wells(1.2, C))),
    # a centre inside the circle of Figs 2 and 3: by how much
    "inside": lambda: (A - paper.fold_radii(C)[0], 0),
    # wells on the circle of radius sqrt(2): 1, on the right, x2 < 0
    "figure 7": lambda: (abs(sum(1 if h < 0 else 2 for h in _wells(math.sqrt(2), C)) - 1), 0),
}
