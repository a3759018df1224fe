"""Equilibria of a torque along an eigenvector of the inertia: a conic in the plane across it.

With D M = d M the two conditions M.y = 0 and M.(D y + lambda) = 0 are one plane if lambda.M = 0 and contradict each
other otherwise. In the plane, with orthogonal eigenvectors P, Q of D (P x Q = w M), y = alpha P + beta Q:

    (d_P - d_Q) alpha beta + l_P beta - l_Q alpha + 1/w = 0,   l_P = lambda.P/P.P,  l_Q = lambda.Q/Q.Q,

a hyperbola; two crossing lines where it passes through its own centre; one line y = lambda x M/lambda^2 + t lambda, or
nothing, where d_P = d_Q. A torque oblique in a plane of equal moments is as good as one on a principal axis.

On the conic the reduced potential has U' = 0 and U'' = m, and (alpha, invariant of the flow, rate about M) are coordinates near every
equilibrium: so its centres are stable (docs/mathematics/equilibria.md, docs/mathematics/stability.md).
"""
from __future__ import annotations

from fractions import Fraction

from ..numbers.exact import sqrt_fraction
from ..numbers.polynomial import Poly
from ..numbers.vectors import CYCLE, Exact3, Number, Triple, cross, dot
from ..physics.quadratic import QuadraticForm
from .balance import ONE, ZERO, Pencil, unit
from .curve import Grounds, RationalCurve, T, Verdict, size_of, straight_line
from .curve_text import decimal, line_text, shifted, sum_of

WHOLE = Poly((1,))  # the denominator of what has none

WELL = Grounds(
    positive=("stable", "non-degenerate minimum of the reduced potential (U'' = m > 0): energy keeps nearby motions in the "
                        "well, and the well persists as the invariant changes"),
    odd=("unstable", "fold: the reduced potential has an inflection here (its first non-zero derivative is of odd order), "
                     "and motions released on its downhill side run away"),
    minimum=("stable", "degenerate but strict minimum of the reduced potential (m > 0 on both sides along the curve): its "
                       "walls stand for nearby values of the invariant too"),
    maximum=("unstable", "degenerate maximum of the reduced potential (m < 0 on both sides along the curve)"))


def balance_fails(p: Pencil) -> str | None:
    """Why a torque along an eigenvector of D has no equilibrium at all; None where it has some."""
    if dot(p.lam, p.M):
        if p.scaled:
            return ("an equilibrium needs mu1 (x1+a) = 0 and mu1 (x1+b) = 0: impossible, as mu1 is not zero and a differs "
                    "from b")
        return ("an equilibrium needs M.omega = 0 and M.(D omega + lambda) = 0; M is an eigenvector of D, so these "
                "contradict each other unless lambda.M = 0, and here lambda.M = " + decimal(dot(p.lam, p.M)))
    first, second, _ = plane_basis(p)
    if first[1] == second[1] and not any(p.lam):
        return ("across the torque the two moments of inertia are equal and there is no gyrostatic moment: nothing "
                "balances the torque, and the rate about its axis grows steadily")
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
    return RationalCurve("equilibrium line", *line_text(p.names, start, direction), straight_line(start, direction), WELL,
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

    def state(self, u: Number, v: Number, bottom: Number = WHOLE) -> Triple:
        """Polynomials (or numbers over bottom = 1) of the state from its two plane components over `bottom`."""
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
                             ", ".join([self.plane_text(), *(f"{n} = {v}" for n, v in zip(self.names, text))]),
                             self.state(parts[0], parts[1], T), WELL, T, (ZERO,), {}, sqrt_fraction(abs(K), 60))

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
                f"equilibrium line along {self.names[free]}", f"{self.plane_text()}, {fixed}, {self.names[free]} arbitrary",
                f"{self.plane_text()}, {fixed}, {self.names[free]} = t", self.state(*parts), WELL,
                crossings={self.centre[free]: verdict}, scale=size_of(self.centre)))
        return lines


def crossing_verdict(form: QuadraticForm, x: Exact3, e: Exact3) -> Verdict:
    """The verdict where two lines of equilibria cross (m = 0): by the first non-zero derivative of the reduced potential
    along its own curve dx/dalpha = J(x) e, U' = -e.x' (a power series with exact coefficients)."""
    for power, slope in enumerate(_potential_slope(form, x, e, 8)):
        if slope:
            order = f"U ~ {'+' if slope > 0 else '-'}alpha^{power + 1} along the motion's own curve"
            if power % 2 and slope > 0:
                return "stable", f"crossing of two lines of equilibria; {order}: a degenerate but strict minimum"
            return "unstable", f"crossing of two lines of equilibria; {order}: no minimum of the reduced potential"
    return "undecided", "crossing of two lines of equilibria; the reduced potential is flat to the eighth order"


def _potential_slope(form: QuadraticForm, x: Exact3, e: Exact3, terms: int) -> list[Fraction]:
    """Coefficients of U'(alpha), times a positive constant."""
    series = [tuple(x)]
    for n in range(terms):
        c = series[-1]
        step = [form.kappa[i] * (c[j] * e[k] + c[k] * e[j]) + (form.rho[i] * e[k] + form.sigma[i] * e[j] if n == 0 else 0)
                for i, (j, k) in enumerate(CYCLE)]
        series.append(tuple(v / (n + 1) for v in step))
    slope = []
    for n in range(terms):
        pairs = [(series[a], series[n - a]) for a in range(n + 1)]
        slope.append(-sum((e[i] * (form.kappa[i] * sum(a[j] * b[k] for a, b in pairs) + form.rho[i] * series[n][k]
                                   + form.sigma[i] * series[n][j] + (form.m[i] if n == 0 else 0))
                           for i, (j, k) in enumerate(CYCLE)), Fraction(0)))
    return slope
