"""Equilibria of a body with a liquid in a cavity, without torque and resistance and with them.

Without torque and resistance they are permanent rotations. With a = D^-1 (D omega + Lambda) x omega and A =
da/domega the rates are (D + kappa L) a, L = A + [omega x]. So a = 0, the permanent rotations without liquid,
are equilibria; any other needs det(D + kappa L) = 0, where the liquid's torque is no longer small against the
body's (its derivation fails); for Lambda = 0 the energy

    T' = -kappa/(D1 D2 D3) sum (Di - Dj)^2 (Di + Dj - Dk) omega_i^2 omega_j^2

excludes even these. At a = 0 the Jacobian is J = (1 + kappa D^-1 L) A, whose determinant is 0 as that of A
is: z (z^2 + c2 z + c1). c1, c2 > 0: the curve of equilibria attracts its neighbourhood (it is its own centre
manifold), so each point of it is stable and neighbouring motions tend to neighbouring points. c1 < 0 or c2 <
0: a root with positive real part.

Under a torque, in a resisting medium, or both they are zeros of three polynomials of third degree in omega.
With x = sqrt(2 T) the work of all torques gives

    x' <= m - (c - kappa alpha) x + kappa beta x^2,      m = sqrt(M . D^-1 M),

because the liquid's work has a part of fourth degree that is never positive, and parts of second and third
degree (from wheel and charge; none where Lambda = 0) of at most alpha x^2 + beta x^3. Between the roots x1 <
x2 of the right side energy falls: there is no equilibrium, and what starts below x2 stays below max(x, x1).
All equilibria below x2 lie in the box of x1, where exclusion and Krawczyk's test find every one.
"""
from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import partial
from math import inf, sqrt
from types import SimpleNamespace

from flint import Ordering, arb, arb_mat, fmpq_mpoly_ctx

from ..numbers.balls import MANY_BITS, evaluated, fraction, rational, working
from ..numbers.exact import sqrt_fraction
from ..numbers.polynomial import Poly, real_roots
from ..numbers.vectors import cross, cross_matrix, dot
from ..physics.coefficients import Content, gyrostat_scene, linear_rates, liquid_torque
from ..reasons import Energy, Quantity, Rate, Reason, Sentence
from .result import (
    CurveSegment,
    Equilibria,
    EquilibriumCurve,
    EquilibriumPoint,
    RationalCurve,
    Verdict,
)
from .stability import ordered, pencil
from .torque_free import torque_free_curves

THE_LIQUID = Sentence("the-liquid", "the liquid")()
PRINTED_TORQUE = Sentence(
    "printed-torque-of-liquid",
    "the printed torque of the liquid leaves out terms of its own order where a wheel or a charge acts, so "
    "it vanishes on no permanent rotation: undecided; choose torque = \"consistent\"")()
PRINCIPAL_ALONE = Sentence(
    "principal-rotations-alone",
    "{inner} takes energy at every rotation that is not about a principal axis, so the equilibria are the "
    "permanent rotations of the free body and no others")
INVERTIBLE_BELOW = Sentence(
    "invertible-below",
    "momentum along rotation: the rates are (D + κ L) a with a the rates without liquid, and D + κ L is "
    "invertible wherever |ω| < {limit}, so there are no others; beyond that the torque of the liquid is as "
    "large as the body's own and its derivation does not hold")
INVERTIBLE_IN_LIMIT = Sentence(
    "invertible-in-limit",
    "momentum along rotation: the rates are (D + κ L) a with a the rates without liquid, and D + κ L is "
    "invertible only in the limit of small κ, so there are no others; beyond that the torque of the liquid "
    "is as large as the body's own and its derivation does not hold")()
ATTRACTING = Verdict("stable", Sentence(
    "curve-attracts",
    "c1, c2 > 0 in z (z² + c2 z + c1): the curve of permanent rotations attracts, so this rotation is "
    "stable and every motion from nearby tends to a permanent rotation of the curve")())
REPELLED = Verdict("unstable", Sentence(
    "curve-repels",
    "c1 < 0 or c2 < 0 in z (z² + c2 z + c1): a root with positive real part")())
LARGEST = Verdict("stable", Sentence(
    "largest-attracts",
    "asymptotically stable at its angular momentum |H|: {inner} keeps |H|, and on the sphere of constant "
    "|H| the energy is least here and falls everywhere else (LaSalle): motions from nearby tend to "
    "rotation about this axis")(inner=THE_LIQUID))
NOT_LARGEST = Verdict("unstable", Sentence(
    "not-largest-leaves",
    "the energy on the sphere of constant |H| is not least here and {inner} makes it fall wherever the "
    "motion is no permanent rotation: states of less energy next to this one leave and do not come "
    "back")(inner=THE_LIQUID))
REST = Verdict("stable", Sentence(
    "liquid-rest",
    "the kinetic energy is positive definite and never grows")())
EDGE = Verdict("undecided", Sentence(
    "liquid-edge",
    "the linear motion is degenerate (c1 c2 = 0): a term of higher order decides")())
PLANE_ATTRACTS = Verdict("stable", Sentence(
    "plane-attracts",
    "the plane of permanent rotations attracts (the third eigenvalue is negative), so each of its points is "
    "stable and motions from nearby tend to a point of the plane")())
PLANE_REPELS = Verdict("unstable", Sentence(
    "plane-repels", "the eigenvalue across the plane of permanent rotations is positive")())


def liquid_equilibria(parts: Content) -> Equilibria:
    """Every permanent rotation of a body with a liquid (no torque, no resistance), with its stability."""
    if parts.printed and any(parts.Lambda):
        return Equilibria("undecided", reason=PRINTED_TORQUE)
    p = pencil(gyrostat_scene(parts))
    exact, planes = torque_free_curves(p)
    curves = (*(_judged(parts, curve) for curve in exact), *(_plane(parts, plane) for plane in planes))
    return Equilibria("curves", curves=curves, reason=_reason(parts))


def _reason(parts: Content) -> Reason:
    if not any(parts.Lambda):
        return PRINCIPAL_ALONE(inner=THE_LIQUID)
    limit = validity(parts)
    return INVERTIBLE_BELOW(limit=Rate(float(limit)).lower) if limit > 0 else INVERTIBLE_IN_LIMIT


def validity(parts: Content) -> Fraction:
    """|omega| below which |kappa D^-1 L| < 1 for sure: |L a| <= ((2 d + 1) |omega| + |Lambda|/Dmin) |a|, d =
    Dmax/Dmin."""
    smallest, largest = min(parts.D), max(parts.D)
    moment = sqrt_fraction(sum((v * v for v in parts.Lambda), Fraction(0)))
    return (smallest / parts.kappa - moment / smallest) / (2 * largest / smallest + 1)


def jacobian(parts: Content, omega, w=1):
    """Rows of w^2 J at the permanent rotation omega / w."""
    A = linear_rates(parts.D, omega, [x * d + w * l for d, x, l in zip(parts.D, omega, parts.Lambda)])
    turn, zero = cross_matrix(omega), omega[0] * 0
    factor = [[(A[i][j] + turn[i][j]) * (parts.kappa / parts.D[i]) + (w if i == j else 0) for j in range(3)]
              for i in range(3)]
    return [[sum((factor[i][n] * A[n][j] for n in range(3)), zero) for j in range(3)] for i in range(3)]


def coefficients(J):
    """(c2, c1) of the characteristic polynomial z (z^2 + c2 z + c1) of rows with determinant 0."""
    c2 = -(J[0][0] + J[1][1] + J[2][2])
    c1 = sum((J[i][i] * J[j][j] - J[i][j] * J[j][i] for i, j in ((0, 1), (0, 2), (1, 2))), J[0][0] * 0)
    return c2, c1


def roots(c2: Fraction, c1: Fraction) -> tuple[complex, ...]:
    """0 and the roots of z^2 + c2 z + c1, each part rounded once."""
    half, square = -c2 / 2, c2 * c2 / 4 - c1
    gap = sqrt_fraction(abs(square))
    if square < 0:
        return 0j, complex(float(half), float(gap)), complex(float(half), -float(gap))
    far = half + gap if half > 0 else half - gap
    return 0j, complex(float(far), 0.0), complex(float(c1 / far) if far else 0.0, 0.0)


def _word(c2, c1) -> str:
    if c2 > 0 and c1 > 0:
        return "stable"
    return "unstable" if c2 < 0 or c1 < 0 else "degenerate"


def _verdict(parts: Content, word: str) -> Verdict:
    if any(parts.Lambda):
        return {"stable": ATTRACTING, "unstable": REPELLED, "degenerate": EDGE}[word]
    return {"stable": LARGEST, "unstable": NOT_LARGEST, "degenerate": EDGE}[word]


def point(parts: Content, omega, verdict: Verdict | None = None) -> EquilibriumPoint:
    """A permanent rotation (exact) with spectrum and verdict."""
    c2, c1 = coefficients(jacobian(parts, omega))
    word = _word(c2, c1)
    verdict = verdict or _verdict(parts, word)
    return EquilibriumPoint(tuple(float(v) for v in omega), roots(c2, c1), word, verdict.word,
                            reason=verdict.reason)


def _judged(parts: Content, curve: RationalCurve) -> EquilibriumCurve:
    """Segments, folds and samples of one curve: cut at its poles, at crossings, and where a vanishing c1 or
    c2 leaves the linear verdict open (any other change of sign does not change it)."""
    both = [p if isinstance(p, Poly) else Poly((p,))
            for p in coefficients(jacobian(parts, curve.numerators, curve.denominator))]
    for t in (*curve.poles, *curve.crossings):
        both = [p.without_root(t) for p in both]
    inner = sorted({t for p in both if p.degree > 0 for t in real_roots(p)}
                   - {*curve.poles, *curve.crossings})
    fixed = {t: _cut(parts, curve, t) for t in (*curve.crossings, *inner) if t not in curve.poles}
    cuts = sorted({*curve.poles, *curve.crossings, *(t for t in inner if fixed[t].linear == "degenerate")})

    def judge(t: Fraction) -> tuple[str, Verdict]:
        word = _word(*coefficients(jacobian(parts, curve.exact_point(t))))
        return word, _verdict(parts, word)
    sample = lambda t, *_: point(parts, curve.exact_point(t))
    return curve.cut(cuts, partial(curve.segment, judge=judge, point=sample), lambda t, *_: fixed[t])


def _cut(parts, curve, t) -> EquilibriumPoint:
    """The equilibrium between two segments; a root of c1 or c2 is known to 2**-160, so its vanishing
    coefficient is set to 0."""
    omega = curve.exact_point(t)
    at_rest = not any(omega)
    c2, c1 = coefficients(jacobian(parts, omega))
    if t in curve.crossings or at_rest:
        return point(parts, omega, REST if at_rest and not any(parts.Lambda) else None)
    nearby = [Fraction(0) if abs(v) < Fraction(1, 2**120) * scale else v
            for v, scale in zip((c2, c1), _sizes(parts, omega))]
    word = _word(*nearby)
    verdict = _verdict(parts, word)
    return EquilibriumPoint(tuple(float(v) for v in omega), roots(*nearby), word, verdict.word,
                            reason=verdict.reason)


def _sizes(parts, omega):
    """Sizes of the terms of c2 and c1, against which a rounded root's residue is small."""
    J = jacobian(parts, omega)
    largest = max(abs(v) for row in J for v in row) or Fraction(1)
    return largest, largest * largest


def _plane(parts: Content, plane: EquilibriumCurve) -> EquilibriumCurve:
    """A plane of equilibria (two equal moments): eigenvalues 0, 0 along it and one across it, q t^2 at
    distance t from its centre."""
    centre = REST if not any(parts.Lambda) else EDGE

    def judged(at):
        omega = tuple(Fraction(v) for v in at)
        if at == plane.folds[0]:
            return EquilibriumPoint(at, (0j, 0j, 0j), "degenerate", centre.word, reason=centre.reason)
        trace = -coefficients(jacobian(parts, omega))[0]
        verdict = PLANE_REPELS if trace > 0 else PLANE_ATTRACTS
        return EquilibriumPoint(at, (0j, 0j, complex(float(trace), 0.0)), verdict.word, verdict.word,
                                reason=verdict.reason)
    samples = tuple(judged(s.at) for s in plane.samples)
    side = next(s for s in samples if s.linear != "degenerate")
    segments = tuple(CurveSegment.like(side, s.t) for s in plane.segments)
    return replace(plane, segments=segments, samples=samples)


ROUND = 1 + 1e-9  # more than all roundings of a bound
RADIUS = 1e-45    # relative radius of the ball in which the sharpened zero is proved to lie
EVERYWHERE = Sentence(
    "energy-falls-below",
    "the kinetic energy T lies below the value from which it falls (above it there is none)")()
STABLE = Verdict("asymptotically stable", Sentence(
    "liquid-all-left",
    "p2, p0 > 0 and p2 p1 > p0 in z³ + p2 z² + p1 z + p0 (Routh and Hurwitz): all roots lie on the "
    "left")())
UNSTABLE = Verdict("unstable", Sentence(
    "liquid-not-left",
    "p0 < 0, p2 < 0 or p2 p1 < p0 in z³ + p2 z² + p1 z + p0 (Routh and Hurwitz): a root with positive real "
    "part")())
OPEN = Verdict("undecided", Sentence(
    "liquid-roots-open",
    "Routh and Hurwitz leave the roots open: one of the conditions is an equality to some forty digits")())
REST_IS_ONE = Sentence("rest-is-one", "rest is one, as no torque acts on it")()
NOT_SETTLED = Sentence(
    "search-not-settled",
    "undecided: {boxes} boxes did not settle the search where {where}; the equilibria found are proved, "
    "others are not excluded")
EVERY_BOX = Sentence(
    "every-box-settled",
    "every box of angular velocities where {where} was proved empty or to hold exactly one equilibrium "
    "(Krawczyk)")
BELOW_ENERGY = Sentence(
    "below-energy", "T < {energy} (beyond it the torque of the liquid may outweigh the medium's)")
LIQUID_MAY_OUTWEIGH = Sentence(
    "liquid-may-outweigh",
    "undecided: the torque of the liquid may outweigh the body's own at every rate, and nothing bounds the "
    "equilibria")()
BELOW_RATES = Sentence(
    "below-rates",
    "|ωᵢ| < {reach} (where |ω| > {limit} the torque of the liquid may be as large as the body's own: its "
    "derivation does not hold there)")



def balanced_equilibria(parts: Content) -> Equilibria:
    """Equilibria with a liquid and resistance or torque: all of them below a bound that the reason names."""
    from ..numbers.krawczyk import zeros
    reach, where = _region(parts)
    torques = balance(parts)
    if reach is None:
        rest = () if any(parts.M) else (_point(parts, torques, (0.0, 0.0, 0.0)),)
        return Equilibria("undecided", rest, reason=where.then(REST_IS_ONE if rest else None))
    result = zeros([_dictionary(f) for f in torques], reach)
    points = tuple(_point(parts, torques, x) for x in sorted(map(tuple, result.points.tolist())))
    if not result.complete:
        return Equilibria("undecided", points,
                          reason=NOT_SETTLED(boxes=Quantity(result.boxes, digits=15), where=where))
    kind = "points" if points else "none" if where == EVERYWHERE else "undecided"
    return Equilibria(kind, points, reason=EVERY_BOX(where=where))


def _in_polynomials(parts: Content):
    """(omega as flint polynomials, the coefficients of the liquid's torque as flint's rationals)."""
    omega = fmpq_mpoly_ctx.get(("x", "y", "z"), Ordering.lex).gens()
    return omega, SimpleNamespace(D=tuple(map(rational, parts.D)), Lambda=tuple(map(rational, parts.Lambda)),
                                  printed=parts.printed)


def balance(parts: Content):
    """The three torques as flint polynomials in omega."""
    w, exact = _in_polynomials(parts)
    H = [d * x + l for d, x, l in zip(exact.D, w, exact.Lambda)]
    c, kappa = rational(parts.c), rational(parts.kappa)
    return [t + rational(m) - c * d * x + kappa * v
            for t, m, d, x, v in zip(cross(H, w), parts.M, exact.D, w, liquid_torque(exact, w))]


def _dictionary(polynomial) -> dict:
    return {tuple(map(int, powers)): fraction(v) for powers, v in polynomial.to_dict().items()}


def bounds(parts: Content) -> tuple[float, float]:
    """(alpha, beta): |part of degree 2|, |part of degree 3| of omega . (torque of the liquid)/kappa are at
    most alpha x^2, beta x^3."""
    w, exact = _in_polynomials(parts)
    work, out = _dictionary(dot(w, liquid_torque(exact, w))), {2: 0.0, 3: 0.0}
    for powers, value in work.items():
        # on |y| = 1, y_i = sqrt(D_i) omega_i, a monomial is at most prod (k_i/n)^(k_i/2)
        if sum(powers) in out:
            largest = 1.0
            for k, d in zip(powers, parts.D):
                largest *= (k / sum(powers) / float(d)) ** (k / 2) if k else 1.0
            out[sum(powers)] += abs(float(value)) * largest
    return out[2] * ROUND, out[3] * ROUND


def trap(parts: Content) -> tuple[float, float] | None:
    """(x1, x2): sqrt(2 T) falls between them (x2 may be inf); None where the liquid may outweigh the
    resistance."""
    push = sqrt(sum(float(m) ** 2 / float(d) for m, d in zip(parts.M, parts.D))) * ROUND
    alpha, beta = (float(parts.kappa) * v for v in bounds(parts))
    net = float(parts.c) - alpha
    if net <= 0 or net * net <= 4 * beta * push * ROUND:
        return None
    if beta == 0:
        return push / net * ROUND, inf
    root = sqrt(net * net - 4 * beta * push)
    return 2 * push / (net + root) * ROUND, (net + root) / (2 * beta) / ROUND


def _region(parts: Content) -> tuple[list[float] | None, Reason]:
    """(reach of omega, where that is), or (None, why not)."""
    result = trap(parts)
    if result is not None:
        x1, x2 = result
        if x1 == 0:
            x1 = min(1.0, x2 / 2)  # rest alone lies below x2; the search proves it again
        where = EVERYWHERE if x2 == inf else BELOW_ENERGY(energy=Energy(x2 * x2 / 2).lower)
        return [x1 / sqrt(float(d)) * ROUND for d in parts.D], where
    limit = max(float(validity(parts)), 0.0)
    balance = (sqrt(sum(float(m / d) ** 2 for m, d in zip(parts.M, parts.D))) / float(parts.c) if parts.c
               else 0.0)
    if not max(limit, balance):
        return None, LIQUID_MAY_OUTWEIGH
    reach = max(limit, 3 * balance)
    return [reach] * 3, BELOW_RATES(reach=Rate(reach).lower, limit=Rate(limit))


def _point(parts: Content, torques, x) -> EquilibriumPoint:
    """Spectrum and verdict at a proved zero, sharpened to some fifty digits and enclosed in balls."""
    import numpy as np
    with working(MANY_BITS):
        ball = _enclosed(torques, x)
        J = arb_mat([[evaluated(f, ball) / rational(d) for f in row]
                     for row, d in zip(_slopes(torques), parts.D)])
        middle = np.array([[float(v.mid()) for v in row] for row in J.tolist()])
        p0, p1, p2, _ = J.charpoly().coeffs()
        if p2 > 0 and p0 > 0 and p2 * p1 > p0:
            word, verdict = "stable", STABLE
        elif p2 < 0 or p0 < 0 or p2 * p1 < p0:
            word, verdict = "unstable", UNSTABLE
        else:
            word, verdict = "degenerate", OPEN
        at = tuple(0.0 if v.contains(0) else float(v.mid()) for v in ball)
    return EquilibriumPoint(at, ordered(np.linalg.eigvals(middle)), word, verdict.word, reason=verdict.reason)


def _slopes(torques):
    """Rows of their derivatives."""
    return [[f.derivative(k) for k in range(3)] for f in torques]


def _enclosed(torques, x):
    """A ball around the zero next to x in which Krawczyk's test holds."""
    at = lambda rows, location: arb_mat([[evaluated(f, location) for f in row] for row in rows])
    column, slopes, x = [[f] for f in torques], _slopes(torques), [arb(v) for v in x]
    inverse = at(slopes, x).inv().mid()
    for _ in range(12):  # the inverse at a double gains some thirteen digits a step
        x = [(v - step).mid() for v, step in zip(x, (inverse * at(column, x)).entries())]
    size = max(float(abs(v).upper()) for v in x) or 1.0
    radius = arb(0, size * RADIUS)
    box, item = [v + radius for v in x], arb_mat([[1, 0, 0], [0, 1, 0], [0, 0, 1]])
    steps = (item - inverse * at(slopes, box)) * arb_mat(3, 1, [radius] * 3) - inverse * at(column, x)
    if not all(abs(step) < size * RADIUS for step in steps.entries()):
        raise ArithmeticError("an equilibrium was not enclosed")
    return box
