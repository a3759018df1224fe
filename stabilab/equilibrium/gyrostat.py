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

Without a torque: momentum parallel to rotation, D y + lambda = s y: the curve y(s) = lambda/(s - D) between
its poles and, for each D_i with lambda_i = 0, a line y_i arbitrary at s = D_i. With s = D_p + 1/t for one
axis p that carries lambda the curve is rational and whole. lambda = 0: the principal axes, planes for equal
moments, everything for a sphere."""
from __future__ import annotations

from fractions import Fraction

from ..numbers.exact import sign_of, sqrt_fraction
from ..numbers.polynomial import Poly
from ..numbers.vectors import CYCLE, Exact3, Number, Triple, cross, dot
from ..physics.coefficients import Content, gyrostat_scene
from ..physics.scene import AnyScene, QuadraticForm
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
    decimal,
    line_text,
    sample_parameters,
    shifted,
    size_of,
    straight_line,
    sum_of,
)
from .stability import ONE, ZERO, Isolated, Pencil, curve_with_verdicts, isolated_point, pencil, unit

# Line of equilibria along axis 1 (x1 = X, the others at y2, y3): deltas obey d2' = -P(X) d3, d3' = Q(X) d2,
# X' = e d2 d3 + f d2 + g d3 with P, Q linear in X and m = P Q. Removing the terms linear in d from X' by X ->
# X - (f/Q) d3 + (g/P) d2 leaves a mean drift X' = const f g (Q'P - P'Q) r^2; the bracket is lambda1 (D3 -
# D2)/(D2 D3), f g ~ (D2-D1)(D1-D3) y2 y3. At a zero of P or Q (not of both: the bracket is not zero) one
# Jordan block is left, and m = -b z + ... along the line, b != 0: `stability.isolated_verdict` has the
# argument.
DRIFTING = Grounds(
    positive=("unstable",
              "line of equilibria with eigenvalues 0, +-i sqrt(m): at second order in the amplitude r the "
              "mean motion is X' = k r^2 along the line with k != 0 (three different moments), r' = O(r^3), "
              "so neighbours travel a finite way along it"),
    odd=("unstable",
         "triple zero eigenvalue on a line of equilibria, where m changes sign: z''' = b z z' + ... with b "
         "!= 0, and blown up with weights 2, 3, 4 it has a motion z ~ 12/(b t^2) that comes out of the "
         "point"),
    minimum=("undecided", "triple zero eigenvalue on a line of equilibria: no proof is given"),
    maximum=("undecided", "triple zero eigenvalue on a line of equilibria: no proof is given"))
# Two equal moments D1 = D2: with alpha' = d3, p(alpha) = d3^2 obeys p'' = -((D1-D3)/D1)^2 p - 2 m(X0 + c
# alpha), linear, so the motion is that of one degree of freedom in the potential -p/2: concave p (m > 0)
# turns, a cubic p escapes.
CONCAVE = Grounds(
    positive=("stable",
              "symmetric body: d3^2 = p(alpha) with alpha' = d3 and p'' = -k^2 p - 2 m < 0 near the line, so "
              "alpha turns back and neighbours stay"),
    odd=("unstable",
         "symmetric body: d3^2 = p(alpha) with alpha' = d3 has a cubic term here, and motions run off on its "
                     "rising side"),
    minimum=("undecided", "triple zero eigenvalue on a line of equilibria: no proof is given"),
    maximum=("undecided", "triple zero eigenvalue on a line of equilibria: no proof is given"))


def off_axis_equilibria(p: Pencil) -> tuple[str, list[EquilibriumPoint], list[RationalCurve]]:
    """(reason, isolated points, curves) for M != 0 not an eigenvector of D."""
    reason, states, curves = isolated_states(p)
    return reason, sorted((isolated_point(p.form, x) for x in states), key=lambda e: e.at), curves


def isolated_states(p: Pencil) -> tuple[str, list[Isolated], list[RationalCurve]]:
    """The same with each isolated equilibrium before its verdict."""
    start, v = meeting_line(p)
    q2, q1, q0 = quadratic_on_line(p, start, v)
    lead = "M is no eigenvector of D: the planes of the two balance conditions meet in a line, "
    P = Poly((q0, q1, q2))
    if not P:
        return lead + "and every point of it is an equilibrium", [], [_whole_line(p, start, v)]
    found = Isolated.all_of(p.state(straight_line(start, v)), P)
    if P.degree == 0:
        why = "and on it the remaining condition has no solution (its coefficients of t^2 and t vanish)"
    elif P.degree == 1:
        why = "on which the remaining condition is linear: one isolated equilibrium"
    else:
        why = (f"on which a quadratic without real roots remains (discriminant "
               f"{decimal(q1 * q1 - 4 * q2 * q0)})",
               "on which a quadratic with a double root remains: one equilibrium, the fold of two",
               "on which a quadratic with a positive discriminant remains: two isolated equilibria"
               )[len(found)]
    return lead + why, found, []


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
    return RationalCurve("equilibrium line", *line_text(p.names, x, v), straight_line(x, v), grounds,
                         scale=size_of(x) / size_of(v))


WELL = Grounds(
    positive=("stable",
              "non-degenerate minimum of the reduced potential (U'' = m > 0): energy keeps nearby motions in "
              "the well, and the well persists as the invariant changes"),
    odd=("unstable",
         "fold: the reduced potential has an inflection here (its first non-zero derivative is of odd "
         "order), and motions released on its downhill side run away"),
    minimum=("stable",
             "degenerate but strict minimum of the reduced potential (m > 0 on both sides along the curve): "
             "its walls stand for nearby values of the invariant too"),
    maximum=("unstable", "degenerate maximum of the reduced potential (m < 0 on both sides along the curve)"))


def balance_fails(p: Pencil) -> str | None:
    """Why a torque along an eigenvector of D has no equilibrium at all; None where it has some."""
    if dot(p.lam, p.M):
        if p.scaled:
            return ("an equilibrium needs mu1 (x1+a) = 0 and mu1 (x1+b) = 0: impossible, as mu1 is not zero "
                    "and a differs from b")
        return ("an equilibrium needs M.omega = 0 and M.(D omega + lambda) = 0; M is an eigenvector of D, so "
                "these "
                "contradict each other unless lambda.M = 0, and here lambda.M = " + decimal(dot(p.lam, p.M)))
    first, second, _ = plane_basis(p)
    if first[1] == second[1] and not any(p.lam):
        return ("across the torque the two moments of inertia are equal and there is no gyrostatic moment: "
                "nothing balances the torque, and the rate about its axis grows steadily")
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
    return RationalCurve("equilibrium line", *line_text(p.names, start, direction),
                         straight_line(start, direction), WELL,
                         scale=scale)


class _Plane:
    """The plane across the torque, in coordinates (u, v) of the state: components along P and Q."""

    def __init__(self, p: Pencil, P: Exact3, Q: Exact3, alpha0: Fraction, beta0: Fraction) -> None:
        self.p, self.P, self.Q = p, P, Q
        self.oblique = sum(map(bool, P)) > 1
        jp, jq = P.index(max(P, key=abs)), Q.index(max(Q, key=abs))
        self.stretch = (ONE, ONE) if self.oblique else (p.A[jp], p.A[jq])
        shift = (ZERO, ZERO) if self.oblique else (p.u[jp], p.u[jq])
        self.centre = tuple((c - s) / f for c, s, f in zip((alpha0, beta0), shift, self.stretch))
        self.names = ("alpha", p.names[jq]) if self.oblique else (p.names[jp], p.names[jq])
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

    def plane_text(self) -> str:
        """The plane in symbols."""
        if self.oblique:
            k = self.p.names[self.Q.index(ONE)]
            return f"omega = alpha N + {k} e, N = e x M = ({', '.join(map(decimal, self.P))})"
        i = next(n for n in range(3) if not self.P[n] and not self.Q[n])
        return f"{self.p.names[i]} = {decimal(-self.p.u[i] / self.p.A[i])}"

    def hyperbola(self, power: Fraction) -> RationalCurve:
        """(u - u0)(v - v0) = K with t the distance of one component from its centre."""
        K = power / (self.stretch[0] * self.stretch[1])
        lead, other = self.leading, 1 - self.leading
        parts = [T * T + T * self.centre[lead], T * self.centre[other] + K]
        if lead:
            parts.reverse()
        text = ["", ""]
        text[lead] = sum_of(self.centre[lead], "t")
        text[other] = sum_of(self.centre[other], f"{decimal(K)}/t")
        left = " ".join(shifted(n, c) for n, c in zip(self.names, self.centre))
        return RationalCurve("equilibrium hyperbola", f"{self.plane_text()}, {left} = {decimal(K)}",
                             ", ".join([self.plane_text(),
                                        *(f"{n} = {v}" for n, v in zip(self.names, text))]),
                             self.state(parts[0], parts[1], T), WELL, T, (ZERO,), {},
                             sqrt_fraction(abs(K), 60))

    def crossing_lines(self) -> list[RationalCurve]:
        """The two lines u = u0 and v = v0 of a conic through its own centre."""
        meeting = tuple(c(ZERO) for c in self.state(*(Poly((v,)) for v in self.centre)))
        verdict = crossing_verdict(self.p.form, meeting, self.p.M)
        lines = []
        for free in (0, 1):
            parts = [Poly((v,)) for v in self.centre]
            parts[free] = T
            fixed = f"{self.names[1 - free]} = {decimal(self.centre[1 - free])}"
            lines.append(RationalCurve(
                f"equilibrium line along {self.names[free]}",
                f"{self.plane_text()}, {fixed}, {self.names[free]} arbitrary",
                f"{self.plane_text()}, {fixed}, {self.names[free]} = t", self.state(*parts), WELL,
                crossings={self.centre[free]: verdict}, scale=size_of(self.centre)))
        return lines


def crossing_verdict(form: QuadraticForm, x: Exact3, e: Exact3) -> Verdict:
    """The verdict where two lines of equilibria cross (m = 0): by the first non-zero derivative of the
    reduced potential along its own curve dx/dalpha = J(x) e, U' = -e.x' (a power series with exact
    coefficients)."""
    for power, slope in enumerate(_potential_slope(form, x, e, 8)):
        if slope:
            order = f"U ~ {'+' if slope > 0 else '-'}alpha^{power + 1} along the motion's own curve"
            if power % 2 and slope > 0:
                return ("stable",
                        f"crossing of two lines of equilibria; {order}: a degenerate but strict minimum")
            return ("unstable",
                    f"crossing of two lines of equilibria; {order}: no minimum of the reduced potential")
    return ("undecided",
            "crossing of two lines of equilibria; the reduced potential is flat to the eighth order")


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


CASIMIR = Grounds(
    positive=("stable",
              "energy-Casimir: on its momentum sphere the energy has a non-degenerate extremum (m > 0); "
              "where the momentum or the rotation vanishes, that integral is itself definite"),
    odd=("unstable",
         "fold: on its momentum sphere the energy has an inflection here, no extremum, and motions leave "
         "along it"),
    minimum=("stable",
             "energy-Casimir: on its momentum sphere the energy has a degenerate but strict extremum (m > 0 "
             "on both sides along the curve)"),
    maximum=("unstable",
             "on its momentum sphere the energy has a degenerate saddle (m < 0 on both sides along the "
             "curve)"))
CROSSING = {
    1: ("stable",
        "crossing of two curves of equilibria; energy-Casimir: on its momentum sphere the energy has a "
        "quartic but strict extremum"),
    -1: ("unstable",
         "crossing of two curves of equilibria; on its momentum sphere the energy has a degenerate saddle")}
REST = ("stable",
        "a positive definite combination of the integrals is stationary here (for a body at rest: the "
        "energy)")
SYMMETRY_AXIS = ("stable",
                 "the rate about the axis of symmetry and the size of the rate across it are both constant")
DRIFT = ("unstable",
         "m = n = 0: with any small change of the rate along the symmetry axis the state runs round the "
         "circle of equilibria, so neighbours leave")


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
    return RationalCurve(f"line along {p.names[i]}", *line_text(p.names, start, unit(i)),
                         straight_line(start, unit(i)), CASIMIR,
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
    name = p.names[lead]
    return RationalCurve(
        "curve of momentum along rotation", "D omega + lambda = s omega",
        f"omega_i = lambda_i/(s - D_i), s = D{lead + 1} + 1/t, t = {name}/lambda{lead + 1}",
        tops, CASIMIR, bottom, poles, crossings,
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
    return RationalCurve("line along the gyrostatic moment", *line_text(p.names, start, direction),
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
    height = start[k]
    centre_verdict = plane_centre(p)
    rays = [unit(i), unit(j),
            tuple(Fraction(3, 5) * a + Fraction(4, 5) * b for a, b in zip(unit(i), unit(j)))]
    curve = RationalCurve("", "", "", straight_line(start, rays[0]), CASIMIR)
    zero = (0j, 0j, 0j)
    at = lambda ray, t: tuple(float(s + t * r) for s, r in zip(start, ray))
    half = sample_parameters(ZERO, None, size_of((height,)))
    outer = [EquilibriumPoint(at(ray, t), zero, "degenerate", *DRIFT) for ray in rays
             for t in (*(-v for v in half), *half)]
    middle = EquilibriumPoint(at(rays[0], ZERO), zero, "degenerate", *centre_verdict)
    segments = tuple(CurveSegment(t, "degenerate", *DRIFT)
                     for t in ((float("-inf"), 0.0), (0.0, float("inf"))))
    names = p.names
    return EquilibriumCurve(
        f"plane {names[k]} = {decimal(height)}",
        f"{names[k]} = {decimal(height)}, {names[i]} and {names[j]} arbitrary",
        f"{names[i]} = t, {names[j]} = 0, {names[k]} = {decimal(height)} and its turns about axis {k + 1}",
        curve.rounded_point, segments, (middle.at,), (*outer, middle))


def twin_equilibria(parts: Content) -> Equilibria:
    """Equilibria of a scene whose effects turn the body as a wheel and a constant torque do."""
    return gyrostat_equilibria(gyrostat_scene(parts))


def gyrostat_equilibria(scene: AnyScene) -> Equilibria:
    """Every equilibrium of a Scene (body, gyrostat, constant torque) or ScaledGyrostat, each with its
    stability, as `answers.equilibria` tells them. Raises InputError for other effects."""
    p = pencil(scene)
    if not any(p.M):
        return _torque_free(p)
    if p.torque_axis_moment() is None:
        reason, points, curves = off_axis_equilibria(p)
        exact = tuple(curve_with_verdicts(p.form, c) for c in curves)
        return Equilibria("curves" if exact else "points" if points else "none", reason, tuple(points), exact)
    missing = balance_fails(p)
    if missing:
        return Equilibria("none", missing)
    conic = tuple(curve_with_verdicts(p.form, c) for c in conic_curves(p))
    return Equilibria("curves",
                      "the torque is along an eigenvector of D with no gyrostatic moment along it: the two "
                      "balance conditions are one plane, and in it one conic remains", curves=conic)


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


def _torque_free(p: Pencil) -> Equilibria:
    if not any(p.lam) and len(set(p.D)) == 1:
        return Equilibria("all",
                          "no torque, no gyrostatic moment and three equal moments: every rate of rotation "
                          "is constant, so every state is an equilibrium, and stable: it stays where "
                          "it is put")
    exact, planes = torque_free_curves(p)
    curves = (*(curve_with_verdicts(p.form, c) for c in exact), *planes)
    return Equilibria("curves",
                      "without a torque a state is an equilibrium exactly where momentum and rotation are "
                      "parallel",
                      curves=curves)
