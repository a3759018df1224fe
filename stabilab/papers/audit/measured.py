"""Claims that no formula says, measured: how a quantity of a family of motions goes, on which side of zero it
is, what figures show, which equilibria there are and how stable. TESTS: name -> (residual of the printed
claim, of the corrected one), with the arguments that a row gives."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache

import numpy as np

from ...answers.simulate import trajectory
from ...equilibrium.stability import invariants
from ...physics.coefficients import scaling
from ...physics.effects.gyrostat import Gyrostat
from ...physics.scene import Body, Scene
from ...theories.cavity import polar
from ...theories.cavity_normal_form import constants
from ...theories.charged import body_of, circle, one_frequency, solution
from ...theories.follow import follow
from .. import table as paper
from ..families import FAMILIES, SPANS, sweep, with_wheel
from ..figures import cavity
from ..printed_integrals import height

# --- How a quantity goes as a number grows, and on which side of zero it is
GOES = {"rises": lambda change, size: change > size, "falls": lambda change, size: change < -size,
        "stays": lambda change, size: abs(change) <= size}
ROUNDING = 1e-9  # a smaller relative change is none
# paper -> the model that its texts speak of, whose motions are measured
MODELS = {"constant-torque": "exact", "charged": "linear", "cavity": "averaged1", "top": "printed"}


def _slope(t, x):
    return np.polyfit(t, x, 1)


MEASURES = {"amplitude": lambda t, x: np.ptp(x) / 2, "end": lambda t, x: x[-1],
            "size at the end": lambda t, x: abs(x[-1]), "least": lambda t, x: x.min(),
            "growth": lambda t, x: _slope(t, x)[0],
            "amplitude about its growth": lambda t, x: np.ptp(x - np.polyval(_slope(t, x), t)) / 2,
            "turns": lambda t, x: (np.diff(np.sign(np.diff(x))) != 0).sum(),
            "sign changes": lambda t, x: (np.diff(np.sign(x)) != 0).sum(),
            "fall at the end": lambda t, x: x.max() - x[-1]}


def missed(values: Sequence[float], goes: str, within: float = ROUNDING) -> int:
    """How many steps between neighbouring values do not go as the word says; within: of a value, a smaller
    change is none."""
    return sum(not GOES[goes](after - before, within * max(abs(before), abs(after)))
               for before, after in zip(values, values[1:]))


@lru_cache(maxsize=128)
def _run(paper_name, file, variant, model, wheel):
    case, times = sweep(file)[variant], SPANS[paper_name].times
    if wheel is not None:
        case = with_wheel(case, wheel)
    run = follow(case, times, model)
    if paper_name != "cavity" or model != "exact":
        return run
    return replace(run, state=run.state | polar(case.scene, case.state, run.t))


def measured(family: str, part: str, measure: str, axis: int | None = None, only=(), model: str | None = None,
             wheel: float | None = None) -> list[float]:
    """A measure of a part of the state, or of one component of it, for each motion of a family ("charged e")
    over the time of the paper's figures; only: the values that are taken; model: of `theories.follow`, else
    that of MODELS; wheel: gyrostatic moment about axis 3 in place of the cases' own, N m s."""
    paper_name, name = family.split(" ", 1)
    runs = [_run(paper_name, *case, model or MODELS[paper_name], wheel)
            for value, case in FAMILIES[paper_name][name].cases.items() if not only or value in only]
    parts = [np.asarray(run.state[part]) for run in runs]
    return [float(MEASURES[measure](run.t, x[:, axis - 1] if axis else x))
            for run, x in zip(runs, parts)]


def axes_of(axis: int | list[int] | None) -> list:
    """The components that a claim names: one, several, or the part as a whole."""
    return axis if isinstance(axis, list) else [axis]


def _trend(family, part, measure, goes, axis=None, truth="", only=(), model=None, wheels=(None,),
           within=ROUNDING):
    """Steps of a family at which a measure does not go as a claim says; as it goes in truth. axis: one or
    several; wheels: all the wheels that the text leaves open."""
    rows = [measured(family, part, measure, item, only, model, wheel)
            for item in axes_of(axis) for wheel in wheels]
    return tuple(sum(missed(values, word, within) for values in rows) for word in (goes, truth or goes))


def _side(family, part, axis, lies, only=(), model=None):
    """How far the least of a component lies on the other side of zero than the word says; than its
    opposite."""
    value = min(measured(family, part, "least", axis, only, model))
    below, above = max(0.0, -value), max(0.0, value)
    return (below, above) if lies == "above" else (above, below)


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
    """The printed rule on the line of equilibria that a = b has: x1 = -a, x2 x3 = -1."""
    points = [(-0.2, -1 / g, g) for g in (-3, -1.6, -0.6, -0.3, 0.3, 0.6, 1.6, 3)]
    return (misjudged(lambda x: x[2] > 1, points, 0.2, 0.2),
            misjudged(lambda x: abs(x[2]) > abs(x[1]), points, 0.2, 0.2))


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
    """Equilibria close to the folds, at c = 1 (lambda1 = 500), that the printed line x1 + x2 = 0 misjudges
    (it calls the side |x1| > |x2| of the hyperbola stable), and that the curve does."""
    a, b = 1.0, 2.0
    points = minor_equilibria(b, (-1.3, -1.1, -0.95, -0.85, -0.75, 0.75, 0.9, 1.1, 1.15, 1.3))
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


# --- The charged body, in the linear model that its paper solves
def _waves(name):
    """Amplitudes of p and wavelengths by (11) of a family, from rest: p1 + i q1 = (i A/W)(1 - e^(i W t))."""
    bodies = [body_of(case) for case in FAMILIES["charged"][name].members]
    rates = [abs(float(one_frequency(body).root)) for body in bodies]
    return ([body.torque[0] / body.inertia[0] / rate for body, rate in zip(bodies, rates)],
            [2 * math.pi / rate for rate in rates])


def _wheel_lowers():
    amplitudes, lengths = _waves("lambda3")
    return missed(amplitudes, "falls") + missed(lengths, "falls"), 0


def _charge_wavelength():
    amplitudes, lengths = _waves("e")
    return missed(lengths, "falls"), missed(amplitudes, "rises") + missed(lengths, "rises")


def _torque_amplitude():
    amplitudes, _ = _waves("M1")
    return missed(amplitudes, "falls"), amplitudes[-1] / amplitudes[0] - 1.25


def _radii(name):
    """Of the circle (35), of each motion of a family."""
    bodies = [body_of(case) for case in FAMILIES["charged"][name].members]
    return [float(np.hypot(*circle(body, np.array(math.pi / body.spin)))) for body in bodies]


def _circle_stays(family: str):
    return (missed(_radii(family), "stays"),) * 2


def _circle_of_35():
    """Change of the radius between M1 = 4 and 5; its departure from proportionality."""
    radii = _radii("M1")
    return radii[-1] / radii[0] - 1, radii[-1] / radii[0] - 1.25


def _axial(names, goes):
    """At the end: at how many steps of the families axial velocity and displacement do not both go as said;
    their largest relative change."""
    steps, largest = 0, 0.0
    for name in names:
        ends = [measured(f"charged {name}", part, "end", 3) for part in ("velocity", "position")]
        for pairs in zip(*(zip(values, values[1:]) for values in ends)):
            steps += any(missed(pair, goes) for pair in pairs)
            largest = max(largest, *(abs(after / before - 1) for before, after in pairs))
    return steps, largest


def _pointing():
    """Mean direction of the velocity at 1e5 s less M1/(D3 r0^2), as printed, and less M1/(r0 (D3 r0 + lambda3
    - charge's moment)), relative."""
    body = body_of(FAMILIES["charged"]["M1"].members[0])
    velocity = solution(body, np.linspace(0.9e5, 1e5, 2001)).velocity
    visited = float((velocity[:, 1] / velocity[:, 2]).mean())
    M1, D3, r0 = body.torque[0], body.inertia[2], body.spin
    momentum = D3 * r0 + body.gyrostat - body.charge_moment
    return visited / (M1 / (D3 * r0**2)) - 1, visited / (M1 / (r0 * momentum)) - 1


# --- The liquid in a cavity
def _frequency(scene: Scene) -> float:
    """omega of (11) at the start, r = 1 rad/s; an imaginary one by its size."""
    n = {name: float(value) for name, value in constants(scene).items()}
    first, second = (n["d"] + sign * n["h"] - n["Gamma"] for sign in (1, -1))
    return math.sqrt(abs(first * second)) / n["J0"]


def _wheel_frequency():
    """Share of the paper's steps of lambda3 at which the frequency does not grow; at which it does other than
    whether Gamma is above d r says."""
    falls = parted = steps = 0
    for name in ("small", "large"):
        scenes = [case.scene for case in FAMILIES["cavity"][name].members]
        for scene, other in zip(scenes, scenes[1:]):
            n = {key: float(value) for key, value in constants(scene).items()}
            grows = _frequency(other) > _frequency(scene)
            falls, parted = falls + (not grows), parted + (grows != (n["Gamma"] > n["d"] + abs(n["h"])))
            steps += 1
    return falls / steps, parted / steps


def _liquid_mass():
    """Moment of inertia of the frozen liquid as a sphere over the body's, less 1; how far the liquid's is
    below the body's, which holds it."""
    scene = sweep("liquid-base")[""].scene
    liquid = scene.effect("liquid_cavity")
    share = 2 / 5 * cavity.liquid_mass(liquid) * cavity.radius(liquid)**2 / float(scene.body.inertia[2])
    return share - 1, max(0.0, 1 - share)


def _liquid_charge():
    """Relative change of the frequency from e = 0.01 to 10,000 C; of that with the charge's moment taken off
    the wheel instead."""
    plain, _, charged = (case.scene for case in FAMILIES["cavity"]["e"].members)
    instead = Scene(plain.body, Gyrostat((0, 0, constants(charged)["Gamma"])))
    return tuple(abs(_frequency(charged) / _frequency(other) - 1) for other in (plain, instead))


def _turns_back(family: str, model: str | None = None):
    """How many motions of a family have their largest phase at the end; how many have not."""
    grown = [fall == 0 for fall in measured(f"cavity {family}", "phase", "fall at the end", model=model)]
    return sum(grown), len(grown) - sum(grown)


# --- The fast top
def _lambda1(C: float) -> tuple[float, float]:
    """(lambda1 of (10), Omega^2) of a top with A = 1, B = 1.1, z0' = 0.1, k = 0.2 and no l_z."""
    A1, B1 = C - 1.1, (1 - C) / 1.1
    square = -A1 * B1
    return (0.1 * (A1 / (1.1 / C) - C) + 0.2 * (A1 - square)) / (1 - square), square


def _poles():
    """Size of lambda1 where C is 1e-9 short of A + B over that at C = 1.4, less one; the residue of the pole
    seen 1e-6 short of it against 1e-9, relative."""
    (nearby, at), (closer, there), (far, _) = _lambda1(2.1 - 1e-6), _lambda1(2.1 - 1e-9), _lambda1(1.4)
    return abs(closer / far) - 1, closer * (1 - there) / (nearby * (1 - at)) - 1


def _closed(model=None):
    """Least distance of (p, q, r, gamma) from its start after 0.1 s, over its distance at most: a closed
    curve comes back; how many of the motions do so to 1 %."""
    shares = []
    for case in FAMILIES["top"]["lx"].cases.values():
        run = _run("top", *case, model or MODELS["top"], None)
        states = np.hstack([run.state["omega"], run.state["gamma"]])[::2]  # one each millisecond
        away = np.linalg.norm(states - states[0], axis=1)
        shares.append(float(away[100:].min() / away.max()))
    return max(shares), sum(fraction < 1e-2 for fraction in shares)


TESTS: dict[str, Callable[..., tuple]] = {
    "trend": _trend, "side": _side,
    # of a gyrostat under a torque
    "existence": _exists_below_zero, "eight": _printed_eight, "characteristic": _characteristic,
    "contradiction": _contradiction, "major stability": _major_rule, "spin-up": _spins_up,
    "ranges": _ranges, "capture": _capture,
    "seconds": _seconds, "always stable": _always_stable, "middle dividing line": _middle_line,
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
    # of the other papers
    "wheel lowers": _wheel_lowers, "charge wavelength": _charge_wavelength,
    "torque amplitude": _torque_amplitude, "circle stays": _circle_stays, "circle": _circle_of_35,
    "pointing": _pointing,
    "axial by wheel": lambda: _axial(("lambda3",), "falls"),
    "axial by charge and torque": lambda: _axial(("e", "M1"), "rises"),
    "turns back": _turns_back, "mass": _liquid_mass, "wheel frequency": _wheel_frequency,
    "charge": _liquid_charge, "poles": _poles, "closed": _closed,
}
