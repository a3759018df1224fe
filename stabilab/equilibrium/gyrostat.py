"""All equilibria of a body with a gyrostatic moment under a constant torque, in closed form.

Source: derived here (docs/mathematics/equilibria.md, docs/mathematics/stability.md); Amer et al. 2024
treats lambda along axis 1 and torques on one axis.

At an equilibrium (D y + lambda) x y + M = 0; dotting with y and with D y + lambda gives M.y = 0 and M.(D y +
lambda) = 0, two linear conditions, and what is left is at most one quadratic. Existence (parallel vectors,
signs of discriminants, conics that fall apart into lines) is decided with exact rationals; coordinates are
rounded once.

A torque off every eigenvector of the inertia: none, one, two, or a whole line. The two conditions are planes
that meet in a line y0 + t v, v = M x D M, on which q(t) = det(D y + lambda, y, M)/M.M + 1 = 0 remains.

A torque along an eigenvector of the inertia, D M = d M: the two conditions are one plane if lambda.M = 0 and
contradict each other otherwise. With orthogonal eigenvectors P, Q of D in it (P x Q = w M), y = alpha P +
beta Q:

    (d_P - d_Q) alpha beta + l_P beta - l_Q alpha + 1/w = 0,   l_P = lambda.P/P.P,  l_Q = lambda.Q/Q.Q,

a hyperbola; two crossing lines where it passes through its own centre; one line y = lambda x M/lambda^2 + t
lambda, or nothing, where d_P = d_Q. A torque oblique in a plane of equal moments is as good as one on a
principal axis.

`torque_free` has those without a torque.
"""
from __future__ import annotations

from fractions import Fraction

from ..numbers.exact import sqrt_fraction
from ..numbers.polynomial import Poly
from ..numbers.vectors import CYCLE, Exact3, Number, Triple, cross, dot
from ..physics.coefficients import Content, gyrostat_scene
from ..physics.scene import AnyScene, QuadraticForm
from ..reasons import Coefficient, Formula, Power, Reason, Sentence
from .description import (
    ARBITRARY,
    HYPERBOLA,
    IS,
    LINE,
    LINE_ALONG,
    OBLIQUE_PLANE,
    PRODUCT_IS,
    RATE,
    RATE_SQUARED,
    Description,
    clauses,
    component,
    line_text,
    over_parameter,
    shifted,
)
from .result import (
    ONE_POLY,
    Equilibria,
    EquilibriumPoint,
    Grounds,
    RationalCurve,
    T,
    Verdict,
    size_of,
    straight_line,
)
from .stability import ONE, ZERO, Isolated, Pencil, curve_with_verdicts, isolated_point, pencil, unit
from .torque_free import torque_free_equilibria

LEAD = "M is no eigenvector of D: the planes of the two balance conditions meet in a line, "
WHOLE_LINE = Sentence("whole-line", LEAD + "and every point of it is an equilibrium")()
ON_LINE_NOTHING = Sentence(
    "on-line-no-solution",
    LEAD + "and on it the remaining condition has no solution (its coefficients of t² and t vanish)")()
ON_LINE_LINEAR = Sentence(
    "on-line-linear", LEAD + "on which the remaining condition is linear: one isolated equilibrium")()
ON_LINE_NONE = Sentence(
    "on-line-no-roots",
    LEAD + "on which a quadratic without real roots remains (discriminant {discriminant})")
ON_LINE_FOLD = Sentence(
    "on-line-fold",
    LEAD + "on which a quadratic with a double root remains: one equilibrium, the fold of two")()
ON_LINE_TWO = Sentence(
    "on-line-two",
    LEAD + "on which a quadratic with a positive discriminant remains: two isolated equilibria")()
SCALED_CONTRADICTION = Sentence(
    "scaled-conditions-contradict",
    "an equilibrium needs μ1 (x1+a) = 0 and μ1 (x1+b) = 0: impossible, as μ1 is not zero and a differs from "
    "b")()
WHEEL_ALONG_TORQUE = Sentence(
    "conditions-contradict",
    "an equilibrium needs M.ω = 0 and M.(D ω + λ) = 0; M is an eigenvector of D, so these contradict each "
    "other unless λ.M = 0, and here λ.M = {product}")
NOTHING_BALANCES = Sentence(
    "nothing-balances-torque",
    "across the torque the two moments of inertia are equal and there is no gyrostatic moment: nothing "
    "balances the torque, and the rate about its axis grows steadily")()
ONE_CONIC = Sentence(
    "one-conic",
    "the torque is along an eigenvector of D with no gyrostatic moment along it: the two balance conditions "
    "are one plane, and in it one conic remains")()
CROSSING_MINIMUM = Sentence(
    "crossing-minimum",
    "crossing of two lines of equilibria; U ~ {sign}α{power} along the motion's own curve: a degenerate but "
    "strict minimum")
CROSSING_NO_MINIMUM = Sentence(
    "crossing-no-minimum",
    "crossing of two lines of equilibria; U ~ {sign}α{power} along the motion's own curve: no minimum of the "
    "reduced potential")
CROSSING_FLAT = Verdict("undecided", Sentence(
    "crossing-flat",
    "crossing of two lines of equilibria; the reduced potential is flat to the eighth order")())
UNPROVED = Verdict("undecided", Sentence(
    "line-triple-zero", "triple zero eigenvalue on a line of equilibria: no proof is given")())
# Line of equilibria along axis 1 (x1 = X, the others at y2, y3): deltas obey d2' = -P(X) d3, d3' = Q(X) d2,
# X' = e d2 d3 + f d2 + g d3 with P, Q linear in X and m = P Q. Removing the terms linear in d from X' by X ->
# X - (f/Q) d3 + (g/P) d2 leaves a mean drift X' = const f g (Q'P - P'Q) r^2; the bracket is lambda1 (D3 -
# D2)/(D2 D3), f g ~ (D2-D1)(D1-D3) y2 y3. At a zero of P or Q (not of both: the bracket is not zero) one
# Jordan block is left, and m = -b z + ... along the line, b != 0: `stability.isolated_verdict` has the
# argument.
DRIFTING = Grounds(
    positive=Verdict("unstable", Sentence(
        "line-drifts",
        "line of equilibria with eigenvalues 0, ±i √(m): at second order in the amplitude r the mean motion "
        "is X' = k r² along the line with k != 0 (three different moments), r' = O(r³), so neighbours "
        "travel a finite way along it")()),
    odd=Verdict("unstable", Sentence(
        "line-changes-sign",
        "triple zero eigenvalue on a line of equilibria, where m changes sign: z''' = b z z' + ... with b "
        "!= 0, and blown up with weights 2, 3, 4 it has a motion z ~ 12/(b t²) that comes out of the "
        "point")()),
    minimum=UNPROVED, maximum=UNPROVED)
# Two equal moments D1 = D2: with alpha' = d3, p(alpha) = d3^2 obeys p'' = -((D1-D3)/D1)^2 p - 2 m(X0 + c
# alpha), linear, so the motion is that of one degree of freedom in the potential -p/2: concave p (m > 0)
# turns, a cubic p escapes.
CONCAVE = Grounds(
    positive=Verdict("stable", Sentence(
        "line-turns-back",
        "symmetric body: d3² = p(α) with α' = d3 and p'' = -k² p - 2 m < 0 near the line, so α turns back "
        "and neighbours stay")()),
    odd=Verdict("unstable", Sentence(
        "line-runs-off",
        "symmetric body: d3² = p(α) with α' = d3 has a cubic term here, and motions run off on its rising "
        "side")()),
    minimum=UNPROVED, maximum=UNPROVED)
WELL = Grounds(
    positive=Verdict("stable", Sentence(
        "well-minimum",
        "non-degenerate minimum of the reduced potential (U'' = m > 0): energy keeps nearby motions in the "
        "well, and the well persists as the invariant changes")()),
    odd=Verdict("unstable", Sentence(
        "well-inflection",
        "fold: the reduced potential has an inflection here (its first non-zero derivative is of odd "
        "order), and motions released on its downhill side run away")()),
    minimum=Verdict("stable", Sentence(
        "well-degenerate-minimum",
        "degenerate but strict minimum of the reduced potential (m > 0 on both sides along the curve): its "
        "walls stand for nearby values of the invariant too")()),
    maximum=Verdict("unstable", Sentence(
        "well-degenerate-maximum",
        "degenerate maximum of the reduced potential (m < 0 on both sides along the curve)")()))


def off_axis_equilibria(p: Pencil) -> tuple[Reason, list[EquilibriumPoint], list[RationalCurve]]:
    """(reason, isolated points, curves) for M != 0 not an eigenvector of D."""
    reason, states, curves = isolated_states(p)
    return reason, sorted((isolated_point(p.form, x) for x in states), key=lambda e: e.at), curves


def isolated_states(p: Pencil) -> tuple[Reason, list[Isolated], list[RationalCurve]]:
    """The same with each isolated equilibrium before its verdict."""
    start, v = meeting_line(p)
    q2, q1, q0 = quadratic_on_line(p, start, v)
    P = Poly((q0, q1, q2))
    if not P:
        return WHOLE_LINE, [], [_whole_line(p, start, v)]
    result = Isolated.all_of(p.state(straight_line(start, v)), P)
    if P.degree < 2:
        return ON_LINE_LINEAR if P.degree else ON_LINE_NOTHING, result, []
    if not result:
        return ON_LINE_NONE(discriminant=Coefficient(q1 * q1 - 4 * q2 * q0)), result, []
    return (ON_LINE_FOLD, ON_LINE_TWO)[len(result) - 1], result, []


def meeting_line(p: Pencil) -> tuple[Exact3, Exact3]:
    """(y0, v): the foot in span(M, D M) and the direction M x D M of the line where the two planes meet."""
    M, DM = p.M, p.turned(p.M)
    v = cross(M, DM)
    load, area = dot(p.lam, M), dot(v, v)
    first, second = load * dot(M, DM) / area, -load * dot(M, M) / area
    return tuple(first * a + second * b for a, b in zip(M, DM)), v


def quadratic_on_line(p: Pencil, start: Exact3, v: Exact3) -> tuple[Fraction, Fraction, Fraction]:
    """(q2, q1, q0) of the one condition left on the line."""
    Dv, H = p.turned(v), tuple(a + b for a, b in zip(p.turned(start), p.lam))
    normal = dot(p.M, p.M)
    triple = lambda a, b: dot(cross(a, b), p.M) / normal
    return triple(Dv, v), triple(Dv, start) + triple(H, v), triple(H, start) + 1


def _whole_line(p: Pencil, start: Exact3, v: Exact3) -> RationalCurve:
    along = [i for i in range(3) if v[i]]
    x = p.state(start)
    if len(along) == 1:
        v = unit(along[0])
        x = tuple(Fraction(0) if i == along[0] else c for i, c in enumerate(x))
    grounds = DRIFTING if len(set(p.D)) == 3 else CONCAVE
    return RationalCurve(Description(LINE, *line_text(p.names, x, v)), straight_line(x, v), grounds,
                         scale=size_of(x) / size_of(v))


def balance_fails(p: Pencil) -> Reason | None:
    """Why a torque along an eigenvector of D has no equilibrium at all; None where it has some."""
    if dot(p.lam, p.M):
        return SCALED_CONTRADICTION if p.scaled else WHEEL_ALONG_TORQUE(
            product=Coefficient(dot(p.lam, p.M)))
    first, second, _ = plane_basis(p)
    if first[1] == second[1] and not any(p.lam):
        return NOTHING_BALANCES
    return None


def plane_basis(p: Pencil) -> tuple[tuple[Exact3, Fraction], tuple[Exact3, Fraction], Fraction]:
    """((P, d_P), (Q, d_Q), w) with P x Q = w M, D P = d_P P and D Q = d_Q Q, all exact."""
    support = [i for i in range(3) if p.M[i]]
    if len(support) == 1:
        i, (j, k) = support[0], CYCLE[support[0]]
        return (unit(j), p.D[j]), (unit(k), p.D[k]), 1 / p.M[i]
    if len(support) == 2:
        k = 3 - sum(support)
        return (cross(unit(k), p.M), p.D[support[0]]), (unit(k), p.D[k]), ONE
    return (p.M, p.D[0]), (p.M, p.D[0]), ONE  # a sphere: only the equality of the moments is used


def conic_curves(p: Pencil) -> list[RationalCurve]:
    """The curves of equilibria of a torque along an eigenvector of D (balance_fails(p) is None)."""
    (P, dP), (Q, dQ), w = plane_basis(p)
    if dP == dQ:
        return [_single_line(p)]
    gap = dP - dQ
    alpha0, beta0 = -dot(p.lam, P) / dot(P, P) / gap, dot(p.lam, Q) / dot(Q, Q) / gap
    power = alpha0 * beta0 - 1 / (w * gap)  # (alpha - alpha0)(beta - beta0)
    plane = _Plane(p, P, Q, alpha0, beta0)
    return [plane.hyperbola(power)] if power else plane.crossing_lines()


def _single_line(p: Pencil) -> RationalCurve:
    squared = dot(p.lam, p.lam)
    start = tuple(v / squared for v in cross(p.lam, p.M))
    along = [i for i in range(3) if p.lam[i]]
    direction = unit(along[0]) if len(along) == 1 else p.lam
    scale = size_of(start) / size_of(direction)
    return RationalCurve(Description(LINE, *line_text(p.names, start, direction)),
                         straight_line(start, direction), WELL, scale=scale)


class _Plane:
    """The plane across the torque, in coordinates (u, v) of the state: components along P and Q."""

    def __init__(self, p: Pencil, P: Exact3, Q: Exact3, alpha0: Fraction, beta0: Fraction) -> None:
        self.p, self.P, self.Q = p, P, Q
        self.oblique = sum(map(bool, P)) > 1
        jp, jq = P.index(max(P, key=abs)), Q.index(max(Q, key=abs))
        self.stretch = (ONE, ONE) if self.oblique else (p.A[jp], p.A[jq])
        shift = (ZERO, ZERO) if self.oblique else (p.u[jp], p.u[jq])
        self.centre = tuple((c - s) / f for c, s, f in zip((alpha0, beta0), shift, self.stretch))
        self.names = ("α", p.names[jq]) if self.oblique else (p.names[jp], p.names[jq])
        # the parameter is the component that theory and paper use: the second axis if it lies in the plane
        self.leading = 1 if self.oblique or jq == 1 or (jp != 1 and jq == 2) else 0

    def state(self, u: Number, v: Number, bottom: Number = ONE_POLY) -> Triple:
        """Polynomials (or numbers over bottom = 1) of the state from its two plane components over `bottom`.
        """
        a, b = u * self.stretch[0], v * self.stretch[1]
        if not self.oblique:
            shift = [self.p.u[i] if self.P[i] or self.Q[i] else ZERO for i in range(3)]
            a, b = a + bottom * dot(shift, self.P), b + bottom * dot(shift, self.Q)
        y = [a * P + b * Q for P, Q in zip(self.P, self.Q)]
        return tuple((c - bottom * s) * (1 / f) for c, s, f in zip(y, self.p.u, self.p.A))

    def plane_text(self) -> Reason:
        """The plane in symbols."""
        if self.oblique:
            first, second, third = map(Coefficient, self.P)
            return OBLIQUE_PLANE(component=component(self.p.names[self.Q.index(ONE)]),
                                 normal=Formula(("(", first, ", ", second, ", ", third, ")")))
        i = next(n for n in range(3) if not self.P[n] and not self.Q[n])
        return IS(component=component(self.p.names[i]), value=Coefficient(-self.p.u[i] / self.p.A[i], RATE))

    def hyperbola(self, power: Fraction) -> RationalCurve:
        """(u - u0)(v - v0) = K with t the distance of one component from its centre."""
        K = power / (self.stretch[0] * self.stretch[1])
        lead, other = self.leading, 1 - self.leading
        parts = [T * T + T * self.centre[lead], T * self.centre[other] + K]
        if lead:
            parts.reverse()
        along = {lead: over_parameter(self.centre[lead], ONE),
                 other: over_parameter(self.centre[other], K, "/t", RATE_SQUARED)}
        first, second = (shifted(n, c) for n, c in zip(self.names, self.centre))
        product = PRODUCT_IS(first=first, second=second, product=Coefficient(K, RATE_SQUARED))
        run = [IS(component=component(name), value=along[n]) for n, name in enumerate(self.names)]
        about = Description(HYPERBOLA, clauses([self.plane_text(), product]),
                            clauses([self.plane_text(), *run]))
        return RationalCurve(about, self.state(parts[0], parts[1], T), WELL, T, (ZERO,), {},
                             sqrt_fraction(abs(K), 60))

    def crossing_lines(self) -> list[RationalCurve]:
        """The two lines u = u0 and v = v0 of a conic through its own centre."""
        meeting = tuple(c(ZERO) for c in self.state(*(Poly((v,)) for v in self.centre)))
        verdict = crossing_verdict(self.p.form, meeting, self.p.M)
        lines = []
        for free in (0, 1):
            parts = [Poly((v,)) for v in self.centre]
            parts[free] = T
            along, across = component(self.names[free]), component(self.names[1 - free])
            fixed = [self.plane_text(), IS(component=across, value=Coefficient(self.centre[1 - free], RATE))]
            about = Description(LINE_ALONG(component=along), clauses([*fixed, ARBITRARY(component=along)]),
                                clauses([*fixed, IS(component=along, value=component("t"))]))
            lines.append(RationalCurve(about, self.state(*parts), WELL,
                                       crossings={self.centre[free]: verdict}, scale=size_of(self.centre)))
        return lines


def crossing_verdict(form: QuadraticForm, x: Exact3, e: Exact3) -> Verdict:
    """The verdict where two lines of equilibria cross (m = 0): by the first non-zero derivative of the
    reduced potential along its own curve dx/dalpha = J(x) e, U' = -e.x' (a power series with exact
    coefficients)."""
    for power, slope in enumerate(_potential_slope(form, x, e, 8)):
        if slope:
            sign, exponent = "+" if slope > 0 else "-", Power(power + 1)
            if power % 2 and slope > 0:
                return Verdict("stable", CROSSING_MINIMUM(sign=sign, power=exponent))
            return Verdict("unstable", CROSSING_NO_MINIMUM(sign=sign, power=exponent))
    return CROSSING_FLAT


def _potential_slope(form: QuadraticForm, x: Exact3, e: Exact3, terms: int) -> list[Fraction]:
    """Coefficients of U'(alpha), times a positive constant."""
    series = [tuple(x)]
    for n in range(terms):
        c = series[-1]
        step = [form.kappa[i] * (c[j] * e[k] + c[k] * e[j])
                + (form.rho[i] * e[k] + form.sigma[i] * e[j] if n == 0 else 0)
                for i, (j, k) in enumerate(CYCLE)]
        series.append(tuple(v / (n + 1) for v in step))
    slope = []
    for n in range(terms):
        pairs = [(series[a], series[n - a]) for a in range(n + 1)]
        slope.append(-sum((e[i] * (form.kappa[i] * sum(a[j] * b[k] for a, b in pairs)
                                   + form.rho[i] * series[n][k]
                                   + form.sigma[i] * series[n][j] + (form.m[i] if n == 0 else 0))
                           for i, (j, k) in enumerate(CYCLE)), Fraction(0)))
    return slope


def twin_equilibria(parts: Content) -> Equilibria:
    """Equilibria of a scene whose effects turn the body as a wheel and a constant torque do."""
    return gyrostat_equilibria(gyrostat_scene(parts))


def gyrostat_equilibria(scene: AnyScene) -> Equilibria:
    """Every equilibrium of a Scene (body, gyrostat, constant torque) or ScaledGyrostat, each with its
    stability, as `answers.equilibria` tells them. Raises InputError for other effects."""
    p = pencil(scene)
    if not any(p.M):
        return torque_free_equilibria(p)
    if p.torque_axis_moment() is None:
        reason, points, curves = off_axis_equilibria(p)
        exact = tuple(curve_with_verdicts(p.form, c) for c in curves)
        return Equilibria("curves" if exact else "points" if points else "none", tuple(points), exact,
                          reason=reason)
    missing = balance_fails(p)
    if missing is not None:
        return Equilibria("none", reason=missing)
    conic = tuple(curve_with_verdicts(p.form, c) for c in conic_curves(p))
    return Equilibria("curves", curves=conic, reason=ONE_CONIC)


def number_of_equilibria(scene: AnyScene) -> int | None:
    """How many equilibria there are, exactly and without their stability, where they are isolated under a
    wheel and a torque off the principal axes; None where they are not, or other effects act."""
    if not scene.plain:
        return None
    p = pencil(scene)
    if not any(p.M) or p.torque_axis_moment() is not None:
        return None
    _, points, curves = isolated_states(p)
    return None if curves else len(points)
