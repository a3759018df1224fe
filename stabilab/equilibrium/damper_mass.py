"""Rotations of a free body about its principal axes that leave the spring of a damper's mass relaxed.

With J(x) = D + x J1 + x^2 J2 of `effects.damper_mass`, wheels along axis i alone and J1_ii = 0, omega =
Omega e_i, x = 0 is an equilibrium at every Omega: H = h e_i, h = D_i Omega + lambda, and omega . J1 omega =
0. At constant |H| the energy (H - lambda) . J^-1 (H - lambda)/2 + k x^2/2 has there, for eta across H and
with a_j = h - D_j Omega, the second variation

    sum a_j eta_j^2/(h D_j) - 2 x Omega sum J1_ij eta_j/D_j + x^2 (k + Omega^2 (sum J1_ij^2/D_j - J2_ii)),

positive definite where a_j/h > 0 for both j and k > Omega^2 J2_ii + Omega^3 sum J1_ij^2/a_j. The dashpot
takes c v^2, and v vanishes along a linear motion of the body alone only where the force on the mass, b . w =
Omega sum J1_ij w_j - mu q . w', does: not where b and its derivative along the nutation are independent. Then
the rotation attracts where the variation is positive definite, and is unstable where it is not degenerate
otherwise (Krasovskii). All these are polynomials in Omega, whose real roots are isolated."""
from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from functools import partial
from typing import Any, NamedTuple

from ..numbers.polynomial import Poly, real_roots
from ..numbers.vectors import CYCLE, cross
from ..physics.coefficients import Content, gyrostat_scene
from ..reasons import Sentence
from .description import AXIS_LINE, Description, component, line_text
from .result import (
    CurveSegment,
    Equilibria,
    EquilibriumCurve,
    EquilibriumPoint,
    RationalCurve,
    Verdict,
    straight_line,
)
from .stability import ordered, pencil, unit
from .torque_free import CASIMIR

RELAXED = Sentence(
    "damper-mass-relaxed",
    "known are the rotations about principal axes that leave the spring of the damper's mass relaxed; those "
    "that displace the mass are not among these: flat-spin has all at one |H|")()
LEAST = Verdict("stable", Sentence(
    "damper-mass-least",
    "asymptotically stable at its |H|: the energy of body, mass and spring has a strict minimum at constant "
    "|H| here, and the dashpot takes energy at every other motion nearby")())
STAYS = Verdict("stable", Sentence(
    "damper-mass-least-alone",
    "the energy of body, mass and spring has a strict minimum at constant |H| here; the nutation does not "
    "move the mass, so that it goes on")())
NOT_LEAST = Verdict("unstable", Sentence(
    "damper-mass-not-least",
    "the energy of body, mass and spring has no minimum at constant |H| here, and the dashpot takes energy "
    "at every motion nearby but at equilibria (Krasovskii)")())
NO_MOMENTUM = Verdict("stable", Sentence(
    "damper-mass-no-momentum",
    "the angular momentum is zero and stays, and the energy of body, mass and spring is least here")())
OPEN = Verdict("undecided", Sentence(
    "damper-mass-open",
    "the second variation of the energy at constant |H| is degenerate here, or the nutation does not move "
    "the mass: a term of higher order decides")())


class _Axis(NamedTuple):
    """Of one axis, polynomials in Omega: h, the two a_j; condition: a_j a_k times (k - Omega^2 J2_ii - ..);
    moving: zero where the nutation does not move the mass. matrices: (left, right) of left (w', x', v') =
    right (w, x, v) at an Omega, linear about the rotation."""

    h: Poly
    a: tuple[Poly, Poly]
    condition: Poly
    moving: Poly
    matrices: Callable[[float], tuple[Any, Any]]

    @property
    def all(self) -> tuple[Poly, ...]:
        return self.h, *self.a, self.condition, self.moving


def relaxed_equilibria(parts: Content) -> Equilibria:
    """Those of a free body with one damper mass and nothing else that moves inside; kind "undecided", since
    others displace the mass."""
    p = pencil(gyrostat_scene(parts))
    curves = []
    for i in range(3):
        polynomials = _of_axis(parts, i)
        if polynomials is not None:
            line = RationalCurve(Description(AXIS_LINE(component=component(p.names[i])),
                                             *line_text(p.names, (Fraction(0),) * 3, unit(i))),
                                 straight_line((Fraction(0),) * 3, unit(i)), CASIMIR)
            curves.append(_judged(line, polynomials, bool(parts.movers[0].exact[1])))
    return Equilibria("undecided", curves=tuple(curves), reason=RELAXED)


def _of_axis(parts: Content, i: int) -> _Axis | None:
    """None where rotation about the axis displaces the mass, or the wheels turn it away."""
    mu, k, _, *vectors = parts.movers[0].exact
    r, n, D = vectors[:3], vectors[3:], parts.D
    one, two = CYCLE[i]
    along = sum(x * y for x, y in zip(r, n))
    if parts.Lambda[one] or parts.Lambda[two] or along != r[i] * n[i]:
        return None
    first = {j: -mu * (r[i] * n[j] + n[i] * r[j]) for j in (one, two)}  # J1_ij
    q, O = cross(r, n), Poly((0, 1))
    h = O * D[i] + parts.Lambda[i]
    a, b = h - O * D[one], h - O * D[two]
    stiff = Poly((k,)) - O * O * (mu * (1 - n[i] * n[i]))
    condition = a * b * stiff - O * O * O * (b * first[one]**2 + a * first[two]**2)
    # of w_one' = -b w_two/D_one, w_two' = a w_one/D_two
    alpha = O * first[one] - a * (mu * q[two] / D[two])
    beta = O * first[two] + b * (mu * q[one] / D[one])
    moving = alpha * alpha * b * (1 / D[one]) + beta * beta * a * (1 / D[two])
    return _Axis(h, (a, b), condition, moving, partial(_matrices, parts, i))


def _matrices(parts: Content, i: int, Omega: float) -> tuple[Any, Any]:
    """D w' + mu v' q = (D w + x Omega J1 e_i + mu v q) x Omega e_i + h e_i x w - v Omega J1 e_i, x' = v and
    mu (q . w' + v') = Omega e_i . J1 w + (Omega^2 J2_ii - k) x - c v."""
    import numpy as np
    mu, k, c, *vectors = map(float, parts.movers[0].exact)
    r, n, e = np.array(vectors[:3]), np.array(vectors[3:]), np.eye(3)[i]
    D, q = np.diag([float(d) for d in parts.D]), np.cross(r, n)
    first = mu * (2 * (r @ n) * np.eye(3) - np.outer(r, n) - np.outer(n, r))
    h = D[i, i] * Omega + float(parts.Lambda[i])
    turned = lambda a: Omega * np.cross(a, e)
    left, right = np.eye(5), np.zeros((5, 5))
    left[:3, :3], left[:3, 4], left[4, :3], left[4, 4] = D, mu * q, mu * q, mu
    right[:3, :3] = np.stack([turned(D[j]) + h * np.cross(e, np.eye(3)[j]) for j in range(3)], axis=1)
    right[:3, 3] = turned(Omega * first[i])
    right[:3, 4] = turned(mu * q) - Omega * first[i]
    right[3, 4] = 1.0
    right[4, :3], right[4, 3], right[4, 4] = Omega * first[i], Omega**2 * mu * (1 - n[i]**2) - k, -c
    return left, right


def _judged(line: RationalCurve, axis: _Axis, sprung: bool) -> EquilibriumCurve:
    cuts = sorted({root for f in axis.all if f.degree > 0 for root in real_roots(f)})
    segment = partial(line.segment, judge=partial(_verdict, axis), point=partial(_point, line, axis))
    return line.cut(cuts, segment, partial(_fold, line, axis, sprung))


def _verdict(axis: _Axis, Omega: Fraction) -> tuple[str, Verdict]:
    h, a, b, condition, moving = (f(Omega) for f in axis.all)
    if not (h and a and b and condition):
        return "degenerate", OPEN
    if a * h > 0 and b * h > 0 and condition > 0:
        return "stable", LEAST if moving else STAYS
    return ("unstable", NOT_LEAST) if moving else ("degenerate", OPEN)


def _fold(line: RationalCurve, axis: _Axis, sprung: bool, t: Fraction, before: CurveSegment,
          after: CurveSegment) -> EquilibriumPoint:
    rests = not axis.h(t) and sprung
    word, verdict = ("degenerate", NO_MOMENTUM) if rests else _verdict(axis, t)
    return _point(line, axis, t, word, verdict)


def _point(line: RationalCurve, axis: _Axis, t: Fraction, word: str, verdict: Verdict) -> EquilibriumPoint:
    import numpy as np
    left, right = axis.matrices(float(t))
    at = tuple(float(v) for v in line.exact_point(t))
    return EquilibriumPoint(at, ordered(np.linalg.eigvals(np.linalg.solve(left, right))), word, verdict.word,
                            reason=verdict.reason)
