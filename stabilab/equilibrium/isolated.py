"""Equilibria of a torque off every eigenvector of the inertia: none, one, two, or a whole line.

M.y = 0 and M.(D y + lambda) = 0 are two planes that meet in a line y0 + t v, v = M x D M. There (D y + lambda) x y is
parallel to M, so one quadratic remains:

    q(t) = det(D y + lambda, y, M)/M.M + 1 = q2 t^2 + q1 t + q0,   q2 = det(M, D M, D^2 M) up to a positive factor.

q2 vanishes where a component of M does or two moments are equal. All of q vanishes where lambda = (D_v - D) y0 + l v, with
D v = D_v v and M = l y0 x v: then D y + lambda = D_v y + l v, and the balance holds for every rate t about v.
"""
from __future__ import annotations

from fractions import Fraction

from ..numbers.surd import Surd
from ..numbers.vectors import Exact3, cross, dot
from .balance import Pencil, unit
from .curve import Grounds, RationalCurve, size_of, straight_line
from .curve_text import decimal, line_text
from .result import EquilibriumPoint
from .stability import isolated_point

# Line of equilibria along axis 1 (x1 = X, the others at y2, y3): deltas obey d2' = -P(X) d3, d3' = Q(X) d2, X' = e d2 d3
# + f d2 + g d3 with P, Q linear in X and m = P Q. Removing the terms linear in d from X' by X -> X - (f/Q) d3 + (g/P) d2
# leaves a mean drift X' = const f g (Q'P - P'Q) r^2; the bracket is lambda1 (D3 - D2)/(D2 D3), f g ~ (D2-D1)(D1-D3) y2 y3.
# At a zero of P or Q (not of both: the bracket is not zero) one Jordan block is left, and m = -b z + ... along the line, b != 0:
# `stability.isolated_verdict` has the argument.
DRIFTING = Grounds(
    positive=("unstable", "line of equilibria with eigenvalues 0, +-i sqrt(m): at second order in the amplitude r the mean "
                          "motion is X' = k r^2 along the line with k != 0 (three different moments), r' = O(r^3), so "
                          "neighbours travel a finite way along it"),
    odd=("unstable", "triple zero eigenvalue on a line of equilibria, where m changes sign: z''' = b z z' + ... with b != 0, and "
                     "blown up with weights 2, 3, 4 it has a motion z ~ 12/(b t^2) that comes out of the point"),
    minimum=("undecided", "triple zero eigenvalue on a line of equilibria: no proof is given"),
    maximum=("undecided", "triple zero eigenvalue on a line of equilibria: no proof is given"))
# Two equal moments D1 = D2: with alpha' = d3, p(alpha) = d3^2 obeys p'' = -((D1-D3)/D1)^2 p - 2 m(X0 + c alpha), linear,
# so the motion is that of one degree of freedom in the potential -p/2: concave p (m > 0) turns, a cubic p escapes.
CONCAVE = Grounds(
    positive=("stable", "symmetric body: d3^2 = p(alpha) with alpha' = d3 and p'' = -k^2 p - 2 m < 0 near the line, so alpha "
                        "turns back and neighbours stay"),
    odd=("unstable", "symmetric body: d3^2 = p(alpha) with alpha' = d3 has a cubic term here, and motions run off on its "
                     "rising side"),
    minimum=("undecided", "triple zero eigenvalue on a line of equilibria: no proof is given"),
    maximum=("undecided", "triple zero eigenvalue on a line of equilibria: no proof is given"))


def off_axis_equilibria(p: Pencil) -> tuple[str, list[EquilibriumPoint], list[RationalCurve]]:
    """(reason, isolated points, curves) for M != 0 not an eigenvector of D."""
    reason, states, curves = isolated_states(p)
    return reason, sorted((isolated_point(p.form, x) for x in states), key=lambda e: e.at), curves


def isolated_states(p: Pencil) -> tuple[str, list[tuple[Surd, Surd, Surd]], list[RationalCurve]]:
    """The same with each isolated equilibrium as three exact surds."""
    start, v = meeting_line(p)
    q2, q1, q0 = quadratic_on_line(p, start, v)
    lead = "M is no eigenvector of D: the planes of the two balance conditions meet in a line, "
    if not (q2 or q1 or q0):
        return lead + "and every point of it is an equilibrium", [], [_whole_line(p, start, v)]
    if not (q2 or q1):
        return lead + "and on it the remaining condition has no solution (its coefficients of t^2 and t vanish)", [], []
    if not q2:
        roots, why = [Surd(-q0 / q1)], "on which the remaining condition is linear: one isolated equilibrium"
    else:
        disc = q1 * q1 - 4 * q2 * q0
        if disc < 0:
            return lead + f"on which a quadratic without real roots remains (discriminant {decimal(disc)})", [], []
        middle, half = -q1 / (2 * q2), 1 / (2 * q2)
        roots = [Surd(middle)] if not disc else [Surd(middle, -half, disc), Surd(middle, half, disc)]
        why = ("on which a quadratic with a positive discriminant remains: two isolated equilibria" if disc else
               "on which a quadratic with a double root remains: one equilibrium, the fold of two")
    return lead + why, [p.state(tuple(r * d + s for s, d in zip(start, v))) for r in roots], []


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
    return RationalCurve("equilibrium line", *line_text(p.names, x, v), straight_line(x, v), grounds, scale=size_of(x) / size_of(v))
