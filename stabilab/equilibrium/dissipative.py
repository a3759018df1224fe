"""Equilibria of a body that something outside takes energy from: medium, linear damper, eddy currents; all
of them, and their stability.

Medium and linear damper take omega . R omega, R = c D + C positive definite (`Content.drag`). All solutions
of (D omega + Lambda) x omega - R omega + M = 0 are found, and their stability; also what a field or a
liquid beside them changes.

Given omega_e of one axis e the other two components solve two linear equations, whose determinant is q(t),
t = omega_e: by c alone c^2 + ((D_e - D_i) t + Lambda_e)((D_e - D_j) t + Lambda_e)/(D_i D_j). Put into the
third equation they leave one polynomial P(t) of degree five at most, with exact coefficients: Sturm's theorem
gives all its real roots. The axis is chosen so that q has no real root at which the two equations are
solvable. Stability: the Jacobian has the characteristic polynomial z^3 + p2 z^2 + p1 z + p0, p2 = tr D^-1 R
> 0, and by Routh and Hurwitz all roots lie on the left iff p0 > 0 and p2 p1 - p0 > 0. A sign at a root of P
is decided exactly: by distance, and where that is not enough by the common divisor. Everywhere T' =
M . omega - omega . R omega.

`liquid` has the balance with a liquid, which does no work against rest, and for Lambda = 0 only takes energy:
T' <= M . omega - 2 c T.

Eddy currents in a field at rest in space: the equilibria are rotations about the field.

T' = -k B^2 |omega across the field|^2, and p = H . gamma stays. Where T stays, omega = s gamma; then gamma' =
gamma x omega = 0, and D omega' = s^2 D gamma x gamma has the product s' gamma . D gamma = 0 with gamma: s
stays, and gamma is a principal axis or s = 0. So the equilibria are these alone, and every motion tends to
them (LaSalle). At one p the least T is p^2/(2 D1), of rotation about an axis of the largest moment D1, for
T >= |H|^2/(2 D1) >= p^2/(2 D1)."""
from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import cos, inf, sin
from typing import Any

from ..numbers.balls import MANY_BITS, working
from ..numbers.exact import floats
from ..numbers.polynomial import Poly, real_roots
from ..numbers.principal import SLACK, principal_minors
from ..numbers.vectors import CYCLE, Exact3, Float3, Number, cross, cross_matrix, dot
from ..physics.coefficients import Content
from ..physics.scene import ZERO3, QuadraticForm, euler_form
from ..reasons import Axis, Formula, Power, Reason, Sentence, Unit
from .damper import damped_equilibria
from .description import ANGLE, RATE, Description
from .field_balance import Field, blocks, rotations_at
from .field_states import ANGLE_IN_PLANE, around
from .liquid import balanced_equilibria, liquid_equilibria
from .result import CurveSegment, Equilibria, EquilibriumCurve, EquilibriumPoint, T, Verdict
from .stability import eigenvalues, ordered, sign_at

# --- Eddy currents
REASON = Sentence(
    "eddy-complete",
    "eddy currents take energy wherever ω is across the field: only rotations about a principal axis along "
    "the field, in either direction, and rest in every attitude are equilibria, and every motion tends to "
    "them (LaSalle)")()
EQUAL = Sentence("eddy-equal-moments", "of two equal moments every axis in their plane is one")()
LEAST = Verdict("stable", Sentence(
    "eddy-least-energy",
    "the kinetic energy is least here at its angular momentum along the field, which stays, and it only "
    "falls")())
MORE = Verdict("unstable", Sentence(
    "eddy-more-energy",
    "at its angular momentum along the field, which stays, rotation about the axis of the largest moment "
    "has less energy, and so have states next to this one: they leave, for energy only falls")())
LOST = Verdict("unstable", Sentence(
    "eddy-rest-left",
    "next to it are states with some angular momentum along the field: they end in rotation about a "
    "principal axis along it, however slow (open where the axis of the largest moment is along it)")())
SPHERE = Verdict("stable", Sentence(
    "eddy-sphere",
    "all moments are equal: rotation across the field decays, and the attitude moves no further than it")())
SLOWED = Verdict("stable", Sentence(
    "eddy-and-resistance-rest",
    "T' ≤ -ω . R ω, R = c D + C, positive definite, of what resists: every rate decays exponentially, and "
    "the attitude moves no further than it")())
REST_ALONE = Sentence(
    "eddy-and-resistance", "eddy currents and what resists both take energy at every rotation but rest")()
EDDY_BESIDE = Sentence(
    "eddy-beside",
    "undecided: of eddy currents beside wheels without resistance, a torque, a damper inside, a liquid or "
    "another field not all equilibria are known")()
ALONG_FIELD = Sentence("rotation-along-field", "rotation about {axis} along the field")
AGAINST_FIELD = Sentence("rotation-against-field", "rotation about {axis} against the field")
TURNS_WITH_FIELD = Sentence("turns-with-field", "{component} = {sign}, ω = t γ")
RATE_ABOUT_FIELD = Sentence("rate-about-field", "t: rate about the field, {unit}")
REST_EVERYWHERE = Sentence("rest-in-every-attitude", "rest in every attitude")()
AT_REST = Sentence("rates-vanish", "ω = 0")()


def eddy_equilibria(parts: Content) -> Equilibria:
    """Rotations about the field and rest, of the body alone; rest alone where resistance or a linear damper
    takes energy at every rotation, beside wheels too; undecided beside anything else."""
    slowed = bool(decay(parts))
    if (any(parts.M) or any(parts.u) or any(parts.s) or parts.N or parts.E or parts.damper_inside
            or parts.kappa or not slowed and (any(parts.Lambda) or parts.damped)):
        return Equilibria("undecided", reason=EDDY_BESIDE)
    if slowed:
        return Equilibria("curves", curves=(_eddy_rest(parts, SLOWED),),
                          reason=REST_ALONE.then(ONLY_REST, ", "))
    rest = SPHERE if len(set(parts.D)) == 1 else LOST
    curves = [_rotations(parts, i, sign) for i in range(3) for sign in (1, -1)]
    return Equilibria("curves", curves=(*curves, _eddy_rest(parts, rest)),
                      reason=REASON.then(EQUAL if len(set(parts.D)) < 3 else None))


def _rotations(parts: Content, i: int, sign: int) -> EquilibriumCurve:
    """About axis i, which points along the field or against it, over the rate."""
    def at(t: float) -> tuple[float, ...]:
        gamma = tuple(float(sign * (n == i)) for n in range(3))
        return (*(t * g for g in gamma), *gamma)
    verdict = LEAST if parts.D[i] == max(parts.D) else MORE
    samples = tuple(EquilibriumPoint(at(t), _eddy_spectrum(parts, at(t)), verdict.word, verdict.word,
                                     reason=verdict.reason) for t in (-1.0, 1.0))
    about = Description((ALONG_FIELD if sign > 0 else AGAINST_FIELD)(axis=Axis(i + 1)),
                        TURNS_WITH_FIELD(component=Formula((f"γ{i + 1}",)), sign=sign),
                        RATE_ABOUT_FIELD(unit=Unit(RATE)))
    return EquilibriumCurve(about, at, (CurveSegment.like(samples[0], (-inf, inf)),), (), samples)


def _eddy_rest(parts: Content, verdict: Verdict) -> EquilibriumCurve:
    def at(t: float) -> tuple[float, ...]:
        return (0.0, 0.0, 0.0, cos(t), sin(t), 0.0)
    sample = EquilibriumPoint(at(0.5), _eddy_spectrum(parts, at(0.5)), "degenerate", verdict.word,
                              reason=verdict.reason)
    run = ANGLE_IN_PLANE(first=Formula(("γ1",)), second=Formula(("γ2",)))
    return EquilibriumCurve(Description(REST_EVERYWHERE, AT_REST, run, unit=ANGLE), at,
                            (CurveSegment.like(sample, (-inf, inf)),), (), (sample,))


def _eddy_spectrum(parts: Content, at: tuple[float, ...]) -> tuple[complex, ...]:
    """Eigenvalues of the linear motion next to an equilibrium omega = s gamma: at omega + u, gamma + v it is
    D u' = D u x omega + (D omega + Lambda) x u - R u + k B^2 ((u - s v) x gamma) x gamma, v' = gamma x (u -
    s v)."""
    import numpy as np
    D, w, g = np.diag([float(d) for d in parts.D]), np.array(at[:3]), np.array(at[3:])
    turn = lambda v: np.array(cross_matrix(v))
    s, slow = float(w @ g), float(parts.eddy) * (turn(g) @ turn(g))
    wheels, drag = np.array(floats(parts.Lambda)), np.array([floats(row) for row in parts.drag])
    J: Any = np.block([[np.linalg.solve(D, turn(D @ w + wheels) - turn(w) @ D - drag + slow),
                        -s * np.linalg.solve(D, slow)],
                       [turn(g), -s * turn(g)]])
    return ordered(np.linalg.eigvals(J))


# --- Medium and linear damper
BITS = 256
GLOBAL = Sentence("every-motion-tends-to-it", "every motion tends to it")()
REST = GLOBAL.then(Sentence(
    "energy-decays",
    "T' = -2 c T without a torque, so the energy and with it every rate decays as exp(-c t)")(), ": ")
ALL_LEFT = Sentence(
    "medium-all-left",
    "asymptotically stable: p0 > 0 and p2 p1 - p0 > 0 in z³ + p2 z² + p1 z + p0 (Routh and Hurwitz), so all "
    "roots lie on the left")()
SADDLE = Sentence("medium-saddle", "p0 < 0: the product of the roots is positive, so one of them is")()
FOCUS = Sentence("medium-focus", "p2 p1 - p0 < 0 (Routh and Hurwitz): a root with positive real part")()
RUBBED = Sentence(
    "resisted-without-torque",
    "T' = -ω . R ω without a torque, R = c D + C, positive definite, of what resists")()
PARTLY = Sentence(
    "damper-partly",
    "undecided: the damper resists rotation about some axes alone, and about others it may go on")()
DIES_OUT = Sentence(
    "damper-dies-out",
    "T' = -ω . C ω vanishes about one axis alone, about which no rotation goes on by itself, so that the "
    "motion tends to rest (LaSalle)")()
RESISTANCE_ALONE = Sentence("resistance-alone", "resistance without a torque: T' = -2 c T")()
ONLY_REST = Sentence("only-rest", "so only rest is an equilibrium")()
NOT_DETERMINED = Sentence(
    "rates-not-determined",
    "undecided: on every axis the elimination meets a rate at which the other two are not determined")()
ONE_POLYNOMIAL = Sentence(
    "one-polynomial",
    "{component} determines the other two rates, and it is a root of a polynomial of degree {degree} with "
    "exact coefficients, whose real roots are {roots} by Sturm's theorem")
NEGATIVE_FORM = Sentence(
    "negative-form",
    "V = δ . D δ/2, δ the departure, has V' = -δ . R δ + ω* . (δ x D δ), a negative definite form")()
IMAGINARY_PAIR = Sentence("imaginary-pair",
                          "a pair of eigenvalues on the imaginary axis: the next order decides")()
DOUBLE_ZERO = Sentence("double-zero", "a double zero eigenvalue: the next order decides")()
FOLD = Sentence(
    "medium-fold",
    "fold: eigenvalue 0, the others on the left; on the centre manifold z' = a z{power} + ...")
EVEN_POWER = Sentence("even-power", "with an even power: motions leave on one side")()
RESTORING_POWER = Sentence("restoring-power", "with an odd power that restores")()
DRIVING_POWER = Sentence("driving-power", "with an odd power that drives away")()


def resisted_equilibria(parts: Content) -> Equilibria:
    """All equilibria with resistance or a linear damper (and no liquid), each with its stability."""
    if not decay(parts):
        return _left_free(parts)
    form = euler_form(parts.D, parts.Lambda, parts.M)
    if not any(parts.M):
        return (_rest_alone(parts, RUBBED, GLOBAL.then(RUBBED, ": ")) if parts.damped
                else _rest_alone(parts, RESISTANCE_ALONE, REST))
    chosen = next((out for e in _axes(parts.D) if (out := elimination(parts, form, e)) is not None), None)
    if chosen is None:
        return Equilibria("undecided", reason=NOT_DETERMINED)
    numerators, q, P, e = chosen
    points = [_point(parts, form, numerators, q, P, t) for t in real_roots(P, BITS)]
    return Equilibria("points", tuple(points), reason=ONE_POLYNOMIAL(
        component=Formula((f"ω{e + 1}",)), degree=P.degree, roots=len(points)))


def _rest_alone(parts: Content, why: Reason, reason: Reason, linear: str = "stable") -> Equilibria:
    """Those of a body whose motions all tend to rest."""
    J = _jacobian(parts, euler_form(parts.D, parts.Lambda, parts.M), ZERO3, Fraction(1))
    rest = EquilibriumPoint((0.0,) * 3, _spectrum_of(J), linear, "asymptotically stable", reason=reason)
    return Equilibria("points", (rest,), reason=why.then(ONLY_REST, ", "))


def _left_free(parts: Content) -> Equilibria:
    """Of a linear damper that resists rotation about some axes alone."""
    axis = None if any(parts.M) else free_axis(parts)
    if axis is None or goes_on(parts, axis) != ():
        return Equilibria("undecided", reason=PARTLY)
    return _rest_alone(parts, DIES_OUT, GLOBAL.then(DIES_OUT, ": "),
                       "stable" if any(cross(parts.Lambda, axis)) else "degenerate")


def free_axis(parts: Content) -> Exact3 | None:
    """The only direction about which a linear damper takes nothing, C v = 0; None where there is none or a
    plane of them, and where irrational axes leave it open whether a rotation about it goes on."""
    size = lambda vector: max(map(abs, vector))
    v, largest = max((cross(parts.C[i], parts.C[j]) for i, j in CYCLE), key=size), max(map(size, parts.C))
    if parts.c or size(v) <= SLACK * largest**2 or any(abs(dot(v, row)) > SLACK * size(v) * largest
                                                    for row in parts.C):
        return None
    momentum = [d * x for d, x in zip(parts.D, v)]
    across, wheel = cross(momentum, v), cross(parts.Lambda, v)
    small = ((across, size(momentum) * size(v)), (wheel, size(parts.Lambda) * size(v)),
             (cross(across, wheel), size(across) * size(wheel)))
    return None if any(0 < size(vector) <= SLACK * of for vector, of in small) else v


def goes_on(parts: Content, axis: Exact3) -> tuple[Fraction, ...] | None:
    """The s but 0 for which the rotation s v about the free axis goes on without a torque; None: all of them.

    Where nothing is taken for ever omega = s(t) v, and s' D v = s^2 D v x v + s Lambda x v. Both terms on the
    right are across v, and v . D v > 0: so s' = 0, and the right side vanishes."""
    across, wheel = cross([d * v for d, v in zip(parts.D, axis)], axis), cross(parts.Lambda, axis)
    if not any(across):
        return () if any(wheel) else None
    size = -dot(across, wheel) / dot(across, across)
    return (size,) if any(wheel) and not any(cross(across, wheel)) else ()


def minors(rows: Sequence[Sequence[Poly | Fraction]]):
    """Sums of the principal minors of a 3 x 3 matrix of any numbers, of the orders 1, 2 and 3."""
    result = list(principal_minors(rows))
    return [sum(v for n, v in result if n == order) for order in (1, 2, 3)]


def _jacobian(parts: Content, form: QuadraticForm, x: Sequence[Number], q: Number):
    """Rows of q times the derivative of omega' at omega = x/q, in any numbers."""
    return [[free - q * (v / d) for free, v in zip(rates, row)]
            for rates, row, d in zip(form.jacobian(x, q), parts.drag, parts.D)]


def _spectrum_of(J: Sequence[list[Fraction]]):
    """The eigenvalues of a matrix of fractions: roots of (z - s)^3 + m (z - s) + n, 3 s its trace."""
    item, two, three = minors(J)
    s = item / 3
    return eigenvalues(two - 3 * s * s, s * two - three - 2 * s**3, s)


def _axes(D: Sequence[Fraction]):
    """Axes of the largest and smallest moment first: there q > 0 where the axis carries no gyrostatic moment.
    """
    order = sorted(range(3), key=lambda i: D[i])
    return order[2], order[0], order[1]


def elimination(parts: Content, form, e):
    """((numerators of omega), q, P, e) with omega = numerators(t)/q(t) and P(t) = 0; None where q has a real
    root at which the two linear equations are solvable."""
    i, j = CYCLE[e]
    R = [[v / d for v in row] for row, d in zip(parts.drag, parts.D)]
    # axis i has neighbours (j, e), axis j has (e, i), cyclic: rate_i = kappa_i x_j x_e + rho_i x_e + sigma_i
    # x_j + m_i - R_i . x
    # R_ii x_i = a x_j + b
    a, b = form.kappa[i] * T + form.sigma[i] - R[i][j], (form.rho[i] - R[i][e]) * T + form.m[i]
    # R_jj x_j = f x_i + g
    f, g = form.kappa[j] * T + form.rho[j] - R[j][i], (form.sigma[j] - R[j][e]) * T + form.m[j]
    q = R[i][i] * R[j][j] - a * f
    top_i, top_j = R[j][j] * b + a * g, R[i][i] * g + f * b
    common = q.gcd(top_i).gcd(top_j)
    if common.degree > 0 and real_roots(common):
        return None
    P = (form.kappa[e] * top_i * top_j + (form.rho[e] - R[e][j]) * top_j * q
         + (form.sigma[e] - R[e][i]) * top_i * q - R[e][e] * T * q * q + form.m[e] * q * q)
    tops = [None] * 3
    tops[i], tops[j], tops[e] = top_i, top_j, T * q
    return tuple(tops), q, _without_common(P, q), e


def _without_common(P: Poly, q: Poly) -> Poly:
    """P without the factors it shares with q (there the linear equations have no solution)."""
    while (common := P.gcd(q)).degree > 0:
        P = P // common
    return P


def _point(parts: Content, form: QuadraticForm, numerators: Sequence[Poly], q: Poly, P: Poly,
           t: Fraction) -> EquilibriumPoint:
    item, two, three = minors(_jacobian(parts, form, numerators, q))  # times q, q^2, q^3
    side = sign_at(q, P, t)
    p0 = side * sign_at(-three, P, t)
    hurwitz = side * sign_at(three - item * two, P, t)
    bottom = q(t)
    omega = tuple(top(t) / bottom for top in numerators)
    linear, verdict, reason = _verdict(p0, hurwitz, side, P, t)
    if verdict == "asymptotically stable" and draws_all(parts, omega):
        reason = reason.then(GLOBAL.then(NEGATIVE_FORM, ": "))
    return EquilibriumPoint(tuple(float(v) for v in omega),
                            _spectrum_of(_jacobian(parts, form, omega, Fraction(1))), linear, verdict,
                            reason=reason)


def _verdict(p0: int, hurwitz: int, side: int, P: Poly, t: Fraction) -> tuple[str, str, Reason]:
    """(linear, verdict, reason) by the signs of Routh and Hurwitz, and of P next to its root."""
    if p0 < 0 or hurwitz < 0:
        return "unstable", "unstable", SADDLE if p0 < 0 else FOCUS
    if p0 and hurwitz:
        return "stable", "asymptotically stable", ALL_LEFT
    if not hurwitz:
        return "degenerate", "undecided", IMAGINARY_PAIR if p0 else DOUBLE_ZERO
    order, slope = _crossing(P, t)
    fold = FOLD(power=Power(order))
    if order % 2 == 0:
        return "degenerate", "unstable", fold.then(EVEN_POWER, " ")
    # p0 = -det J and P' = (det J/det J_ij) q^2 ..., so p0 has the sign of -P' q near the root
    if -slope * side > 0:
        return "degenerate", "asymptotically stable", fold.then(RESTORING_POWER, " ")
    return "degenerate", "unstable", fold.then(DRIVING_POWER, " ")


def _crossing(P: Poly, t) -> tuple[int, int]:
    """Multiplicity of the root t of P and the sign of the first derivative that does not vanish there."""
    derivative, order = P.derivative(), 1
    while not (result := sign_at(derivative, P, t)):
        derivative, order = derivative.derivative(), order + 1
    return order, result


def draws_all(parts: Content, omega: Sequence[Fraction]) -> bool:
    """Whether -delta . R delta + omega . (delta x D delta) is negative definite (by principal minors)."""
    D, S = parts.D, [list(row) for row in parts.drag]
    for i, (j, k) in enumerate(CYCLE):  # (delta x D delta)_i = (D_k - D_j) delta_j delta_k
        S[j][k] = S[k][j] = S[j][k] - omega[i] * (D[k] - D[j]) / 2
    two = S[0][0] * S[1][1] - S[0][1]**2
    three = minors(S)[2]
    scale = S[0][0] * S[1][1] * S[2][2] / 2**100  # far above what the 2**-256 of omega can change
    return two * S[2][2] > scale and three > scale


def energy_bound(parts: Content, start: float) -> tuple[float, float]:
    """(largest sqrt(2 T) ever, its limit at late times) from `start`, that at the start, and from
    (sqrt(2 T))' <= -c sqrt(2 T) + sqrt(M . D^-1 M)."""
    push = sum(float(m) ** 2 / float(d) for m, d in zip(parts.M, parts.D)) ** 0.5 / float(decay(parts))
    return max(start, push), push


def decay(parts: Content) -> Fraction:
    """The largest c with omega . R omega >= c omega . D omega, 1/s: the least root of det(R - c D), all three
    of which are real; 0 where the damper leaves an axis free."""
    if not parts.damped:
        return parts.c
    det = minors([[v - (i == j) * parts.D[i] * T for j, v in enumerate(row)]
                  for i, row in enumerate(parts.drag)])[2]
    smallest = real_roots(det, BITS)[0]
    return smallest if smallest > SLACK * max(max(row) for row in parts.drag) / min(parts.D) else Fraction(0)


def drawn_to(parts: Content) -> Float3 | None:
    """The equilibrium that draws every motion under resistance and a torque; None where none is proved to."""
    if parts.damper_inside or parts.kappa or parts.directed or any(parts.u) or not decay(parts):
        return None
    points = [point for point in resisted_equilibria(parts).points if point.reason.says(GLOBAL.sentence)]
    return tuple(map(float, points[0].at[:3])) if points else None


MINIMUM = Verdict("asymptotically stable", Sentence(
        "rest-minimum",
        "the potential energy has a strict minimum here and the medium takes energy at every rotation "
        "(LaSalle)")())
NO_MINIMUM = Verdict("unstable", Sentence(
    "rest-no-minimum",
    "the potential energy is not least here and the medium takes energy at every rotation: states of less "
    "energy next to this one leave and do not come back")())
CONTINUUM = Verdict("stable", Sentence(
    "rest-continuum",
    "rest positions of one energy, strictly least across them: they attract their neighbourhood (the others "
    "of the eigenvalues lie on the left), so each of them is stable")())
OPEN = Verdict("undecided", Sentence(
    "rest-degenerate",
    "the second variation of the potential energy is degenerate: a term of higher order decides")())
LIQUID_BESIDE_DAMPER = Sentence("liquid-beside-damper",
                                "undecided: a liquid beside a linear damper, a torque or a wheel")()
TAKES_R = Sentence("takes-what-resists", "T' ≤ -ω . R ω")()
TAKES_C = Sentence("takes-what-medium-does", "T' ≤ -2 c T")()
SO_DOES_OTHER = Sentence("liquid-and-what-resists",
                         "since the liquid only takes energy and so does what resists")()
MEDIUM_TAKES = Sentence("liquid-and-medium",
                        "since the liquid only takes energy and the medium takes 2 c T")()
DAMPER_IN_FIELD = Sentence("damper-in-field",
                           "undecided: equilibria with a damper are known of a free body alone")()
LIQUID_IN_FIELD = Sentence(
    "equilibria-liquid-in-field",
    "undecided: where the body carries a liquid, the torque of a field or of a turning charge enters the "
    "liquid's own torque, and equilibria beyond those of the body without liquid are not excluded")()
TORQUE_IN_FIELD = Sentence(
    "torque-in-field-and-medium",
    "undecided: a constant torque and a field hold a turning body against the medium only where four "
    "equations in ω and γ meet; no closed form is known")()
REST_IN_FIELD = Sentence(
    "rest-in-field",
    "the medium takes energy at every rotation, so only rest is an equilibrium: γ where the torque of the "
    "field vanishes, (N D + μ) γ = s, by one polynomial in μ whose real roots are certified")()
EVERY_DIRECTION = Sentence("every-direction", "every direction")()
CIRCLE_OF_REST = Sentence("circle-of-rest", "circle of rest positions")()


def dissipative_equilibria(parts: Content) -> Equilibria:
    """Equilibria of the angular velocity with resistance, a liquid or both, a wheel, a constant charge and a
    torque."""
    if parts.damper_inside:
        return damped_equilibria(parts)
    if not parts.kappa:
        return resisted_equilibria(parts)
    if parts.damped and (any(parts.M) or any(parts.Lambda) or not decay(parts)):
        return Equilibria("undecided", reason=LIQUID_BESIDE_DAMPER)
    if parts.unproved_loss is not None:
        return Equilibria("undecided", reason=parts.unproved_loss)
    if not parts.c and not any(parts.M) and not parts.damped:
        return liquid_equilibria(parts)
    if not any(parts.M) and not any(parts.Lambda):
        takes, other = (TAKES_R, SO_DOES_OTHER) if parts.damped else (TAKES_C, MEDIUM_TAKES)
        return _rest_alone(parts, takes, GLOBAL.then(takes, ": ").then(other, ", "))
    return balanced_equilibria(parts)


def held_in_a_field(parts: Content) -> Equilibria:
    """Equilibria of a body in a field that a liquid or a medium takes energy from."""
    if parts.damper_inside:
        return Equilibria("undecided", reason=DAMPER_IN_FIELD)
    if parts.kappa:
        return Equilibria("undecided", reason=LIQUID_IN_FIELD)
    if parts.damped and not decay(parts):
        return Equilibria("undecided", reason=PARTLY)
    if any(parts.M):
        return Equilibria("undecided", reason=TORQUE_IN_FIELD)
    return rest_positions(parts)


def rest_positions(parts: Content) -> Equilibria:
    """Rest positions of a body in a field with a resisting medium: (omega, gamma) with omega = 0."""
    with working(MANY_BITS):
        field = Field.of(parts)
        rows = [(rotation, _rest(parts, field, rotation)) for rotation in rotations_at(field, Fraction(0))]
    points = tuple(point for rotation, point in rows if not rotation.circle)
    curves = tuple(_continuum(rotation, point) for rotation, point in rows if rotation.circle)
    return Equilibria("curves" if curves else "points", points, curves, reason=REST_IN_FIELD)


def _rest(parts, field, rotation) -> EquilibriumPoint:
    """Verdict by the second variation of the potential energy on the tangent plane of |gamma| = 1."""
    n = [k - rotation.mu for k in field.stiffness(0 * field.N)]
    squares = [g * g for g in rotation.gamma]
    trace = -dot(n, [1 - x for x in squares])
    determinant = n[1] * n[2] * squares[0] + n[2] * n[0] * squares[1] + n[0] * n[1] * squares[2]
    at = (0.0, 0.0, 0.0, *(float(g.mid()) for g in rotation.gamma))
    if len(rotation.circle) == 3:
        word, verdict = "degenerate", CONTINUUM
    elif rotation.circle:
        word, verdict = "degenerate", CONTINUUM if trace > 0 else NO_MINIMUM if trace < 0 else OPEN
    elif determinant > 0 and trace > 0:
        word, verdict = "stable", MINIMUM
    elif determinant < 0 or trace < 0:
        word, verdict = "unstable", NO_MINIMUM
    else:
        word, verdict = "degenerate", OPEN
    return EquilibriumPoint(at, _spectrum(parts, field, rotation), word, verdict.word, reason=verdict.reason)


def _spectrum(parts, field, rotation):
    import numpy as np
    A, B = (np.array([[float(v) if not hasattr(v, "mid") else float(v.mid()) for v in row] for row in block])
            for block in blocks(field, 0 * field.N, rotation.gamma))
    turn = np.array(cross_matrix([float(g.mid()) for g in rotation.gamma]))
    R = np.array([[float(v / d) for v in row] for row, d in zip(parts.drag, parts.D)])
    J = np.block([[A - R, B], [turn, np.zeros((3, 3))]])
    return ordered(np.linalg.eigvals(J))


def _continuum(rotation, point: EquilibriumPoint) -> EquilibriumCurve:
    segment = CurveSegment.like(point, (-inf, inf))
    equation, run, at = around(Fraction(0), rotation)
    name = EVERY_DIRECTION if len(rotation.circle) == 3 else CIRCLE_OF_REST
    return EquilibriumCurve(Description(name, equation, run, unit=ANGLE), at, (segment,), (), (point,))
