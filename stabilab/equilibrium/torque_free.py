"""All equilibria of a free body with a gyrostatic moment, in closed form.

Without a torque: momentum parallel to rotation, D y + lambda = s y: the curve y(s) = lambda/(s - D) between
its poles and, for each D_i with lambda_i = 0, a line y_i arbitrary at s = D_i. With s = D_p + 1/t for one
axis p that carries lambda the curve is rational and whole. lambda = 0: the principal axes, planes for equal
moments, everything for a sphere.
"""
from __future__ import annotations

from fractions import Fraction

from ..numbers.exact import sign_of
from ..numbers.polynomial import Poly
from ..numbers.vectors import CYCLE, Exact3
from ..reasons import Axis, Coefficient, Sentence
from .description import (
    ALONG_ROTATION,
    ALONG_ROTATION_EQUATION,
    ALONG_ROTATION_RUN,
    ARBITRARY,
    AXIS_LINE,
    IS,
    LINE_ALONG_WHEEL,
    PLANE,
    RATE,
    TURNS,
    Description,
    clauses,
    component,
    line_text,
)
from .result import (
    ONE_POLY,
    CurveSegment,
    Equilibria,
    EquilibriumCurve,
    EquilibriumPoint,
    Grounds,
    RationalCurve,
    T,
    Verdict,
    sample_parameters,
    size_of,
    straight_line,
)
from .stability import ONE, ZERO, Pencil, curve_with_verdicts, unit

ALL_STATES_STAY = Sentence(
    "all-states-stay",
    "no torque, no gyrostatic moment and three equal moments: every rate of rotation is constant, so every "
    "state is an equilibrium, and stable: it stays where it is put")()
PARALLEL = Sentence(
    "momentum-along-rotation",
    "without a torque a state is an equilibrium exactly where momentum and rotation are parallel")()
CASIMIR = Grounds(
    positive=Verdict("stable", Sentence(
        "casimir-extremum",
        "energy-Casimir: on its momentum sphere the energy has a non-degenerate extremum (m > 0); where the "
        "momentum or the rotation vanishes, that integral is itself definite")()),
    odd=Verdict("unstable", Sentence(
        "casimir-inflection",
        "fold: on its momentum sphere the energy has an inflection here, no extremum, and motions leave "
        "along it")()),
    minimum=Verdict("stable", Sentence(
        "casimir-degenerate-extremum",
        "energy-Casimir: on its momentum sphere the energy has a degenerate but strict extremum (m > 0 on "
        "both sides along the curve)")()),
    maximum=Verdict("unstable", Sentence(
        "casimir-degenerate-saddle",
        "on its momentum sphere the energy has a degenerate saddle (m < 0 on both sides along the curve)")()))
CROSSING = {
    1: Verdict("stable", Sentence(
        "crossing-extremum",
        "crossing of two curves of equilibria; energy-Casimir: on its momentum sphere the energy has a "
        "quartic but strict extremum")()),
    -1: Verdict("unstable", Sentence(
        "crossing-saddle",
        "crossing of two curves of equilibria; on its momentum sphere the energy has a degenerate saddle")())}
REST = Verdict("stable", Sentence(
    "integrals-definite",
    "a positive definite combination of the integrals is stationary here (for a body at rest: the energy)")())
SYMMETRY_AXIS = Verdict("stable", Sentence(
    "both-rates-constant",
    "the rate about the axis of symmetry and the size of the rate across it are both constant")())
DRIFT = Verdict("unstable", Sentence(
    "circle-drifts",
    "m = n = 0: with any small change of the rate along the symmetry axis the state runs round the circle "
    "of equilibria, so neighbours leave")())


def torque_free_curves(p: Pencil) -> tuple[list[RationalCurve], list[EquilibriumCurve]]:
    """(exact curves, planes of equilibria) for M = 0, for anything but lambda = 0 on a sphere."""
    axes = [_axis_line(p, i) for i in range(3) if not p.lam[i] and p.D.count(p.D[i]) == 1]
    planes = [_plane(p, d) for d in plane_moments(p)]
    if not any(p.lam):
        return axes, planes
    return [_main_curve(p), *axes], planes


def _line_sign(p: Pencil, i: int) -> int:
    """Sign of m on the line y_i arbitrary, s = D_i, away from the crossing: that of (D_j - D_i)(D_k - D_i) up
    to the sign that the change of variables x -> y carries."""
    j, k = CYCLE[i]
    e = p.form
    return -sign_of(e.kappa[j] * e.kappa[k])


def _axis_line(p: Pencil, i: int) -> RationalCurve:
    """The line y_i arbitrary, D_i simple and lambda_i = 0."""
    y = tuple(ZERO if n == i else p.lam[n] / (p.D[i] - p.D[n]) for n in range(3))
    start = tuple(ZERO if n == i else v for n, v in enumerate(p.state(y)))
    meeting = -p.u[i] / p.A[i]
    about = Description(AXIS_LINE(component=component(p.names[i])), *line_text(p.names, start, unit(i)))
    return RationalCurve(about, straight_line(start, unit(i)), CASIMIR,
                         crossings={meeting: _crossing(p, i)}, scale=size_of(start, (meeting,)))


def _crossing(p: Pencil, i: int) -> Verdict:
    return CROSSING[_line_sign(p, i)] if any(p.lam) else REST


def _main_curve(p: Pencil) -> RationalCurve:
    support = [i for i in range(3) if p.lam[i]]
    if len({p.D[i] for i in support}) == 1:
        return _along_lambda(p, support)
    lead = support[0]
    factors = {i: Poly((1, p.D[lead] - p.D[i])) for i in support}  # s - D_i, times t
    distinct = list({p.D[i]: f for i, f in factors.items() if f.degree}.values())
    bottom = ONE_POLY
    for f in distinct:
        bottom = bottom * f
    tops = tuple(bottom * T * p.lam[i] // factors[i] if i in factors else Poly(()) for i in range(3))
    poles = tuple(sorted({-f.c[0] / f.c[1] for f in distinct}))
    crossings = {1 / (p.D[i] - p.D[lead]): _crossing(p, i) for i in range(3) if not p.lam[i]
                 and p.D.count(p.D[i]) == 1}
    run = ALONG_ROTATION_RUN(number=lead + 1, component=component(p.names[lead]))
    return RationalCurve(
        Description(ALONG_ROTATION, ALONG_ROTATION_EQUATION, run, unit=""), tops, CASIMIR, bottom, poles,
        crossings,
        size_of(tuple(1 / (d - p.D[lead]) for d in p.D if d != p.D[lead])))


def _along_lambda(p: Pencil, support: list[int]) -> RationalCurve:
    """lambda in one eigenspace (moment d): the line through rest along lambda."""
    d, lead = p.D[support[0]], support[0]
    direction = unit(lead) if len(support) == 1 else p.lam
    start = tuple(ZERO if n == lead and len(support) == 1 else v for n, v in enumerate(p.state((ZERO,) * 3)))
    per_t = direction[lead] * p.A[lead]  # y_lead = per_t t + u_lead
    crossings = {}
    for i in range(3):
        if p.D[i] != d:
            where = (p.lam[lead] / (p.D[i] - d) - p.u[lead]) / per_t
            crossings[where] = _crossing(p, i) if p.D.count(p.D[i]) == 1 else SYMMETRY_AXIS
    scale = size_of(tuple(crossings)) if crossings else ONE
    return RationalCurve(Description(LINE_ALONG_WHEEL, *line_text(p.names, start, direction)),
                         straight_line(start, direction), CASIMIR, crossings=crossings, scale=scale)


def plane_moments(p: Pencil) -> list[Fraction]:
    """The moments that two axes share and that carry no gyrostatic moment: a plane of equilibria each."""
    return [d for d in sorted(set(p.D))
            if p.D.count(d) == 2 and not any(l for l, m in zip(p.lam, p.D) if m == d)]


def plane_of_equal_moments(p: Pencil, d: Fraction) -> tuple[int, int, int, Exact3]:
    """(i, j, k, centre): axes i and j span the plane of equilibria, k is the axis of symmetry, through the
    exact centre."""
    i, j = (n for n in range(3) if p.D[n] == d)
    k = 3 - i - j
    return i, j, k, tuple(p.lam[k] / (d - p.D[k]) if n == k else ZERO for n in range(3))


def plane_centre(p: Pencil) -> Verdict:
    """The verdict on the centre of such a plane."""
    return SYMMETRY_AXIS if any(p.lam) else REST


def _plane(p: Pencil, d: Fraction) -> EquilibriumCurve:
    """The plane of equilibria across the symmetry axis k of a body with two moments d. The curve's point(t)
    runs along one straight line through its centre; by the symmetry every other line through the centre is
    alike (samples lie on three)."""
    i, j, k, start = plane_of_equal_moments(p, d)
    middle_verdict = plane_centre(p)
    rays = [unit(i), unit(j),
            tuple(Fraction(3, 5) * a + Fraction(4, 5) * b for a, b in zip(unit(i), unit(j)))]
    names, height = p.names, Coefficient(start[k], RATE)
    at_height = IS(component=component(names[k]), value=height)
    run = [IS(component=component(names[i]), value=component("t")),
           IS(component=component(names[j]), value=Coefficient(ZERO, RATE)),
           at_height.then(TURNS(axis=Axis(k + 1)), " ")]
    about = Description(PLANE(component=component(names[k]), value=height), clauses(
        [at_height, ARBITRARY(component=component(f"{names[i]} and {names[j]}"))]), clauses(run))
    curve = RationalCurve(about, straight_line(start, rays[0]), CASIMIR)
    zero = (0j, 0j, 0j)
    at = lambda ray, t: tuple(float(s + t * r) for s, r in zip(start, ray))
    half = sample_parameters(ZERO, None, size_of((start[k],)))
    outer = [EquilibriumPoint(at(ray, t), zero, "degenerate", DRIFT.word, reason=DRIFT.reason)
             for ray in rays for t in (*(-v for v in half), *half)]
    middle = EquilibriumPoint(at(rays[0], ZERO), zero, "degenerate", middle_verdict.word,
                              reason=middle_verdict.reason)
    segments = tuple(CurveSegment(t, "degenerate", DRIFT.word, reason=DRIFT.reason)
                     for t in ((float("-inf"), 0.0), (0.0, float("inf"))))
    return EquilibriumCurve(about, curve.rounded_point, segments, (middle.at,), (*outer, middle))


def torque_free_equilibria(p: Pencil) -> Equilibria:
    """Every equilibrium without a torque, with its stability."""
    if not any(p.lam) and len(set(p.D)) == 1:
        return Equilibria("all", reason=ALL_STATES_STAY)
    exact, planes = torque_free_curves(p)
    curves = (*(curve_with_verdicts(p.form, c) for c in exact), *planes)
    return Equilibria("curves", curves=curves, reason=PARALLEL)
