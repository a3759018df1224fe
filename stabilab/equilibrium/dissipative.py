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
from ..numbers.polynomial import Poly, real_roots
from ..numbers.principal import SLACK, principal_minors
from ..numbers.vectors import CYCLE, Exact3, Number, cross, cross_matrix, dot
from ..physics.coefficients import Content
from ..physics.scene import ZERO3, QuadraticForm, euler_form
from .field_balance import Field, blocks, rotations_at
from .field_states import around
from .liquid import balanced_equilibria, damped_equilibria, liquid_equilibria
from .result import CurveSegment, Equilibria, EquilibriumCurve, EquilibriumPoint, T
from .stability import eigenvalues, ordered, sign_at

# --- Eddy currents
REASON = ("eddy currents take energy wherever omega is across the field: only rotations about a principal "
          "axis along the field, in either direction, and rest in every attitude are equilibria, and every "
          "motion tends to them (LaSalle)")
EQUAL = "; of two equal moments every axis in their plane is one"
LEAST = ("the kinetic energy is least here at its angular momentum along the field, which stays, and it only "
         "falls")
MORE = ("at its angular momentum along the field, which stays, rotation about the axis of the largest moment "
        "has less energy, and so have states next to this one: they leave, for energy only falls")
LOST = ("next to it are states with some angular momentum along the field: they end in rotation about a "
        "principal axis along it, however slow (open where the axis of the largest moment is along it)")
SPHERE = "all moments are equal: rotation across the field decays, and the attitude moves no further than it"


def eddy_equilibria(parts: Content) -> Equilibria:
    """Rotations about the field and rest, of the body alone; undecided beside anything else."""
    if (any(parts.M) or any(parts.Lambda) or parts.c or parts.damped or parts.inside or parts.kappa
            or any(parts.s) or parts.N or parts.E):
        return Equilibria("undecided", "undecided: of eddy currents beside wheels, a torque, a medium, a "
                                       "damper, a liquid or another field not all equilibria are known")
    curves = [_rotations(parts, i, sign) for i in range(3) for sign in (1, -1)]
    reason = REASON + EQUAL if len(set(parts.D)) < 3 else REASON
    return Equilibria("curves", reason, curves=(*curves, _eddy_rest(parts)))


def _rotations(parts: Content, i: int, sign: int) -> EquilibriumCurve:
    """About axis i, which points along the field or against it, over the rate."""
    def at(t: float) -> tuple[float, ...]:
        gamma = tuple(float(sign * (n == i)) for n in range(3))
        return (*(t * g for g in gamma), *gamma)
    verdict = ("stable", LEAST) if parts.D[i] == max(parts.D) else ("unstable", MORE)
    segment = CurveSegment((-inf, inf), verdict[0], *verdict)
    samples = tuple(EquilibriumPoint(at(t), _eddy_spectrum(parts, at(t)), verdict[0], *verdict)
                    for t in (-1.0, 1.0))
    name = f"rotation about axis {i + 1} {'along' if sign > 0 else 'against'} the field"
    return EquilibriumCurve(name, f"gamma{i + 1} = {sign}, omega = t gamma",
                            "t: rate about the field, rad/s", at, (segment,), (), samples)


def _eddy_rest(parts: Content) -> EquilibriumCurve:
    verdict = ("stable", SPHERE) if len(set(parts.D)) == 1 else ("unstable", LOST)

    def at(t: float) -> tuple[float, ...]:
        return (0.0, 0.0, 0.0, cos(t), sin(t), 0.0)
    sample = EquilibriumPoint(at(0.5), _eddy_spectrum(parts, at(0.5)), "degenerate", *verdict)
    return EquilibriumCurve("rest in every attitude", "omega = 0", "t: angle in the plane of gamma1, gamma2",
                            at, (CurveSegment((-inf, inf), "degenerate", *verdict),), (), (sample,))


def _eddy_spectrum(parts: Content, at: tuple[float, ...]) -> tuple[complex, ...]:
    """Eigenvalues of the linear motion next to an equilibrium omega = s gamma: at omega + u, gamma + v it is
    D u' = D u x omega + D omega x u + k B^2 ((u - s v) x gamma) x gamma, v' = gamma x (u - s v)."""
    import numpy as np
    D, w, g = np.diag([float(d) for d in parts.D]), np.array(at[:3]), np.array(at[3:])
    turn = lambda v: np.array(cross_matrix(v))
    s, slow = float(w @ g), float(parts.eddy) * (turn(g) @ turn(g))
    J: Any = np.block([[np.linalg.solve(D, turn(D @ w) - turn(w) @ D + slow), -s * np.linalg.solve(D, slow)],
                       [turn(g), -s * turn(g)]])
    return ordered(np.linalg.eigvals(J))


# --- Medium and linear damper
BITS = 256
GLOBAL = "every motion tends to it: "
REST = (GLOBAL + "T' = -2 c T without a torque, so the energy and with it every rate decays as exp(-c t)")
ALL_LEFT = (
    "asymptotically stable: p0 > 0 and p2 p1 - p0 > 0 in z^3 + p2 z^2 + p1 z + p0 (Routh and Hurwitz), so "
    "all roots lie on the left")
SADDLE = "p0 < 0: the product of the roots is positive, so one of them is"
FOCUS = "p2 p1 - p0 < 0 (Routh and Hurwitz): a root with positive real part"
RUBBED = "T' = -omega . R omega without a torque, R = c D + C, positive definite, of what resists"
PARTLY = "undecided: the damper resists rotation about some axes alone, and about others it may go on"
DIES_OUT = ("T' = -omega . C omega vanishes about one axis alone, about which no rotation goes on by "
            "itself, so that the motion tends to rest (LaSalle)")


def resisted_equilibria(parts: Content) -> Equilibria:
    """All equilibria with resistance or a linear damper (and no liquid), each with its stability."""
    if not decay(parts):
        return _left_free(parts)
    form = euler_form(parts.D, parts.Lambda, parts.M)
    if not any(parts.M):
        return (_rest_alone(parts, RUBBED, f"{GLOBAL}{RUBBED}") if parts.damped
                else _rest_alone(parts, "resistance without a torque: T' = -2 c T", REST))
    chosen = next((found for e in _axes(parts.D) if (found := elimination(parts, form, e)) is not None), None)
    if chosen is None:
        return Equilibria("undecided",
                          "undecided: on every axis the elimination meets a rate at which the other two are "
                          "not determined")
    numerators, q, P, e = chosen
    points = [_point(parts, form, numerators, q, P, t) for t in real_roots(P, BITS)]
    reason = (f"omega{e + 1} determines the other two rates, and it is a root of a polynomial of degree "
              f"{P.degree} with exact coefficients, whose real roots are {len(points)} by Sturm's theorem")
    return Equilibria("points", reason, tuple(points))


def _rest_alone(parts: Content, reason: str, because: str, linear: str = "stable") -> Equilibria:
    """Those of a body whose motions all tend to rest."""
    J = _jacobian(parts, euler_form(parts.D, parts.Lambda, parts.M), ZERO3, Fraction(1))
    rest = EquilibriumPoint((0.0,) * 3, _spectrum_of(J), linear, "asymptotically stable", because)
    return Equilibria("points", f"{reason}, so only rest is an equilibrium", (rest,))


def _left_free(parts: Content) -> Equilibria:
    """Of a linear damper that resists rotation about some axes alone."""
    axis = None if any(parts.M) else free_axis(parts)
    if axis is None or goes_on(parts, axis) != ():
        return Equilibria("undecided", PARTLY)
    return _rest_alone(parts, DIES_OUT, f"{GLOBAL}{DIES_OUT}",
                       "stable" if any(cross(parts.Lambda, axis)) else "degenerate")


def free_axis(parts: Content) -> Exact3 | None:
    """The only direction about which a linear damper takes nothing, C v = 0; None where there is none or a
    plane of them, and where irrational axes leave it open whether a rotation about it goes on."""
    size = lambda vector: max(map(abs, vector))
    v, most = max((cross(parts.C[i], parts.C[j]) for i, j in CYCLE), key=size), max(map(size, parts.C))
    if parts.c or size(v) <= SLACK * most**2 or any(abs(dot(v, row)) > SLACK * size(v) * most
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
    found = list(principal_minors(rows))
    return [sum(v for n, v in found if n == order) for order in (1, 2, 3)]


def _jacobian(parts: Content, form: QuadraticForm, x: Sequence[Number], q: Number):
    """Rows of q times the derivative of omega' at omega = x/q, in any numbers."""
    return [[free - q * (v / d) for free, v in zip(rates, row)]
            for rates, row, d in zip(form.jacobian(x, q), parts.drag, parts.D)]


def _spectrum_of(J: Sequence[list[Fraction]]):
    """The eigenvalues of a matrix of fractions: roots of (z - s)^3 + m (z - s) + n, 3 s its trace."""
    one, two, three = minors(J)
    s = one / 3
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
    one, two, three = minors(_jacobian(parts, form, numerators, q))  # times q, q^2, q^3
    side = sign_at(q, P, t)
    p0 = side * sign_at(-three, P, t)
    hurwitz = side * sign_at(three - one * two, P, t)
    bottom = q(t)
    omega = tuple(top(t) / bottom for top in numerators)
    linear, verdict, because = _verdict(p0, hurwitz, side, P, t)
    if verdict == "asymptotically stable" and draws_all(parts, omega):
        because += ("; " + GLOBAL
                    + "V = delta . D delta/2, delta the departure, has V' = -delta . R delta + omega* . "
                      "(delta x D delta), a negative definite form")
    return EquilibriumPoint(tuple(float(v) for v in omega),
                            _spectrum_of(_jacobian(parts, form, omega, Fraction(1))), linear, verdict,
                            because)


def _verdict(p0: int, hurwitz: int, side: int, P: Poly, t: Fraction):
    if p0 < 0 or hurwitz < 0:
        return "unstable", "unstable", SADDLE if p0 < 0 else FOCUS
    if p0 and hurwitz:
        return "stable", "asymptotically stable", ALL_LEFT
    if not hurwitz:
        which = "a pair of eigenvalues on the imaginary axis" if p0 else "a double zero eigenvalue"
        return "degenerate", "undecided", f"{which}: the next order decides"
    order, slope = _crossing(P, t)
    words = f"fold: eigenvalue 0, the others on the left; on the centre manifold z' = a z^{order} + ... "
    if order % 2 == 0:
        return "degenerate", "unstable", words + "with an even power: motions leave on one side"
    # p0 = -det J and P' = (det J/det J_ij) q^2 ..., so p0 has the sign of -P' q near the root
    if -slope * side > 0:
        return "degenerate", "asymptotically stable", words + "with an odd power that restores"
    return "degenerate", "unstable", words + "with an odd power that drives away"


def _crossing(P: Poly, t) -> tuple[int, int]:
    """Multiplicity of the root t of P and the sign of the first derivative that does not vanish there."""
    derivative, order = P.derivative(), 1
    while not (found := sign_at(derivative, P, t)):
        derivative, order = derivative.derivative(), order + 1
    return order, found


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
    least = real_roots(det, BITS)[0]
    return least if least > SLACK * max(max(row) for row in parts.drag) / min(parts.D) else Fraction(0)


MINIMUM = ("asymptotically stable",
           "the potential energy has a strict minimum here and the medium takes energy at every rotation "
           "(LaSalle)")
NO_MINIMUM = ("unstable",
              "the potential energy is not least here and the medium takes energy at every rotation: states "
              "of less energy next to this one leave and do not come back")
CONTINUUM = ("stable",
             "rest positions of one energy, strictly least across them: they attract their neighbourhood "
             "(the others of the eigenvalues lie on the left), so each of them is stable")
OPEN = ("undecided",
        "the second variation of the potential energy is degenerate: a term of higher order decides")


def dissipative_equilibria(parts: Content) -> Equilibria:
    """Equilibria of the angular velocity with resistance, a liquid or both, a wheel, a constant charge and a
    torque."""
    if parts.inside:
        return damped_equilibria(parts)
    if not parts.kappa:
        return resisted_equilibria(parts)
    if parts.damped and (any(parts.M) or any(parts.Lambda) or not decay(parts)):
        return Equilibria("undecided", "undecided: a liquid beside a linear damper, a torque or a wheel")
    if parts.unproved_loss:
        return Equilibria("undecided", parts.unproved_loss)
    if not parts.c and not any(parts.M) and not parts.damped:
        return liquid_equilibria(parts)
    if not any(parts.M) and not any(parts.Lambda):
        takes = "T' <= -omega . R omega" if parts.damped else "T' <= -2 c T"
        other = "so does what resists" if parts.damped else "the medium takes 2 c T"
        return _rest_alone(parts, takes,
                           f"{GLOBAL}{takes}, since the liquid only takes energy and {other}")
    return balanced_equilibria(parts)


def held_in_a_field(parts: Content) -> Equilibria:
    """Equilibria of a body in a field that a liquid or a medium takes energy from."""
    if parts.inside:
        return Equilibria("undecided", "undecided: equilibria with a damper are known of a free body alone")
    if parts.kappa:
        return Equilibria("undecided",
                          "undecided: where the body carries a liquid, the torque of a field or of a turning "
                          "charge enters the liquid's own torque, and equilibria beyond those of the body "
                          "without liquid are not excluded")
    if parts.damped and not decay(parts):
        return Equilibria("undecided", PARTLY)
    if any(parts.M):
        return Equilibria("undecided",
                          "undecided: a constant torque and a field hold a turning body against the medium "
                          "only where four equations in omega and gamma meet; no closed form is known")
    return rest_positions(parts)


def rest_positions(parts: Content) -> Equilibria:
    """Rest positions of a body in a field with a resisting medium: (omega, gamma) with omega = 0."""
    with working(MANY_BITS):
        field = Field.of(parts)
        found = [(rotation, _rest(parts, field, rotation)) for rotation in rotations_at(field, Fraction(0))]
    points = tuple(point for rotation, point in found if not rotation.circle)
    curves = tuple(_continuum(rotation, point) for rotation, point in found if rotation.circle)
    reason = ("the medium takes energy at every rotation, so only rest is an equilibrium: gamma where the "
              "torque of the field vanishes, "
              "(N D + mu) gamma = s, by one polynomial in mu whose real roots are certified")
    return Equilibria("curves" if curves else "points", reason, points, curves)


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
    return EquilibriumPoint(at, _spectrum(parts, field, rotation), word, *verdict)


def _spectrum(parts, field, rotation):
    import numpy as np
    A, B = (np.array([[float(v) if not hasattr(v, "mid") else float(v.mid()) for v in row] for row in block])
            for block in blocks(field, 0 * field.N, rotation.gamma))
    turn = np.array(cross_matrix([float(g.mid()) for g in rotation.gamma]))
    R = np.array([[float(v / d) for v in row] for row, d in zip(parts.drag, parts.D)])
    J = np.block([[A - R, B], [turn, np.zeros((3, 3))]])
    return ordered(np.linalg.eigvals(J))


def _continuum(rotation, point: EquilibriumPoint) -> EquilibriumCurve:
    name = "every direction" if len(rotation.circle) == 3 else "circle of rest positions"
    segment = CurveSegment((float("-inf"), float("inf")), point.linear, point.verdict, point.because)
    equation, parametrisation, run = around(Fraction(0), rotation)
    return EquilibriumCurve(name, equation, parametrisation, run, (segment,), (), (point,))
