"""Steady states omega = Omega gamma of a body in a field under a constant torque along a principal axis.

(S gamma + b) x gamma = -M asks for M . gamma = 0. With M along axis i, and neither wheel nor weight along it, gamma =
(0, cos t, sin t) on the axes (i, j, k) solves all but one equation, a quadratic in Omega:

    A (Omega^2 - N) + B Omega + C = 0,   A = (D_j - D_k) cos t sin t,   C = s_j sin t - s_k cos t + M_i,
    B = Lambda_j sin t - Lambda_k cos t -+ E cos t sin t    (- where j is axis 3, + where k is)

So the steady states are two closed curves over t, real where the discriminant, a polynomial in tau = tan(t/2), is not
negative. Linear motion: z^2 (z^4 + e2 z^2 - e3 z + e4), for |gamma| is kept, the state lies on a curve of others, and the flow keeps
volume (no z^3 term). The four roots sum to zero, so any root off the imaginary axis brings one with positive real part.
"""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import tan

from ...errors import InputError
from ...numbers.balls import many_digits, rational
from ...numbers.polynomial import Poly, real_roots
from ...numbers.vectors import CYCLE
from ...physics.coefficients import Content
from ..curve import sample_parameters, values_inside
from ..result import CurveSegment, Equilibria, EquilibriumCurve, EquilibriumPoint
from .permanent_rotations import permanent_rotations
from .spectrum import Field, blocks

TAU = Poly((0, 1))
COS, SIN, ONE = Poly((1, 0, -1)), Poly((0, 2)), Poly((1, 0, 1))  # times 1 + tau^2
OFF_AXIS = ("undecided: a constant torque off the principal axes, or one with a wheel or weight along it, holds a turning body only where "
            "three equations in Omega and gamma meet; no closed form is known")
SKEW = ("unstable", "e3 != 0 in z^4 + e2 z^2 - e3 z + e4: the four roots sum to zero and are not all imaginary, so one has positive real part")
PAIR = ("unstable", "e4 < 0, or e2 < 0 < e4, or e2^2 < 4 e4 in z^4 + e2 z^2 + e4: roots off the imaginary axis, whose sum is zero")
CENTRE = ("undecided", "all eigenvalues are imaginary, and with a torque that does work no integral is known that would decide the full motion")
OPEN = ("undecided", "a coefficient of the spectrum vanishes here: the next order decides")


@dataclass(frozen=True)
class Plane:
    """The quadratic in Omega for a torque along axis i, in tau = tan(t/2): coefficients times (1 + tau^2)^2."""

    i: int
    square: Poly
    linear: Poly
    constant: Poly

    @property
    def discriminant(self) -> Poly:
        return self.linear * self.linear - 4 * self.square * self.constant


def directed_equilibria(parts: Content) -> Equilibria:
    """Equilibria in a field or with a charge that follows the attitude: permanent rotations, and under a constant torque the steady states."""
    return steady_states(parts) if any(parts.M) else permanent_rotations(parts)


def steady_states(parts: Content) -> Equilibria:
    """All steady states of a body in a field with a constant torque, where they have a closed form."""
    acting = [i for i in range(3) if parts.M[i]]
    i = acting[0]
    if len(acting) > 1 or parts.s[i] or parts.Lambda[i]:
        return Equilibria("undecided", OFF_AXIS)
    plane = _plane(parts, i)
    curves = tuple(_curve(parts, plane, lo, hi, side) for lo, hi in _pieces(plane) for side in (-1, 1))
    reason = (f"torque . gamma = 0 puts gamma across axis {i + 1}, and one quadratic in Omega remains; the intervals where it is real are those of "
              "a polynomial in tan(t/2) with exact coefficients")
    return Equilibria("curves", reason, curves=curves) if curves else Equilibria("none", reason + ": there are none")


def _plane(parts: Content, i: int) -> Plane:
    j, k = CYCLE[i]
    product, side = COS * SIN, (j == 2) - (k == 2)
    square = (parts.D[j] - parts.D[k]) * product
    linear = (parts.Lambda[j] * SIN - parts.Lambda[k] * COS) * ONE - parts.E * side * product
    constant = (parts.s[j] * SIN - parts.s[k] * COS) * ONE + parts.M[i] * ONE * ONE - parts.N * square
    return Plane(i, square, linear, constant)


def _pieces(plane: Plane):
    """Intervals of tau on which the quadratic has two real roots (one where D_j = D_k)."""
    cuts = {t for p in (plane.discriminant, plane.square, plane.linear if not plane.square else Poly(())) if p.degree > 0 for t in real_roots(p)}
    cuts |= {Fraction(0)}
    ends = [None, *sorted(cuts), None]
    for lo, hi in zip(ends, ends[1:]):
        middle = values_inside(lo, hi, Fraction(1))
        if plane.discriminant(middle) > 0:
            yield lo, hi


def _omega(plane: Plane, tau: Fraction, side: int):
    """The root Omega at tau as a ball; None where the quadratic is linear and this side has none."""
    from flint import arb
    a, b, c = (rational(p(tau)) for p in (plane.square, plane.linear, plane.constant))
    if a == 0:
        return arb(-c / b) if side < 0 and b != 0 else None
    root = arb(b * b - 4 * a * c).sqrt()
    near = -(b + root) / 2 if b >= 0 else (root - b) / 2  # the root without cancellation is near/a, the other c/near
    first, second = near / a, c / near if near != 0 else near / a
    low, high = (first, second) if first < second else (second, first)
    return low if side < 0 else high


def _state(plane: Plane, tau: Fraction, side: int):
    """(Omega, gamma) as balls."""
    from flint import arb
    j, k = CYCLE[plane.i]
    gamma = [arb(0)] * 3
    gamma[j], gamma[k] = (arb(rational(p(tau) / ONE(tau))) for p in (COS, SIN))
    return _omega(plane, tau, side), tuple(gamma)


def _point(parts: Content, plane: Plane, tau: Fraction, side: int) -> EquilibriumPoint | None:
    Omega, gamma = _state(plane, tau, side)
    if Omega is None:
        return None
    J = _jacobian(Field.of(parts), Omega, gamma)
    power, p = J, []
    for _ in range(3):
        power = [[sum(power[r][n] * J[n][c] for n in range(6)) for c in range(6)] for r in range(6)]
        p.append(sum(power[r][r] for r in range(6)))
    e2, e3, e4 = -p[0] / 2, p[1] / 3, (p[0] * p[0] / 2 - p[2]) / 4
    at = tuple(float(v.mid()) for v in (*(Omega * g for g in gamma), *gamma))
    return EquilibriumPoint(at, _eigenvalues(e2, e3, e4), *_verdict(e2, e3, e4))


def _jacobian(field: Field, Omega, gamma):
    A, B = blocks(field, Omega, gamma)
    x, y, z = gamma
    zero = x * 0
    turn = [[zero, -z, y], [z, zero, -x], [-y, x, zero]]
    return [[*A[r], *B[r]] for r in range(3)] + [[*turn[r], *(-Omega * v for v in turn[r])] for r in range(3)]


def _verdict(e2, e3, e4):
    if e3 != 0:  # a ball without 0
        return "unstable", *SKEW
    if e4 < 0 or e2 * e2 < 4 * e4 or (e2 < 0 and e4 > 0):
        return "unstable", *PAIR
    if e4 > 0 and e2 > 0 and e2 * e2 > 4 * e4:
        return "stable", *CENTRE
    return "degenerate", *OPEN


def _eigenvalues(e2, e3, e4):
    import numpy as np
    roots = np.roots([1.0, 0.0, *(float(v.mid()) for v in (e2, -e3, e4))])
    return (0j, 0j, *(complex(z) for z in roots))


def _curve(parts, plane: Plane, lo, hi, side) -> EquilibriumCurve:
    """One side of the quadratic over one interval of tau."""
    j, k = CYCLE[plane.i]
    ends = _angle(lo, -1), _angle(hi, 1)
    with many_digits():
        found = [_point(parts, plane, tau, side) for tau in _chosen(lo, hi)]
    samples = tuple(s for s in found if s is not None)
    words = {(s.linear, s.verdict, s.because) for s in samples}
    shared = words.pop() if len(words) == 1 else (
        "degenerate", "undecided", "the verdict changes along this piece, or was decided at the samples only: see them")
    if shared[1] == "unstable":
        shared = (shared[0], "undecided", "unstable at every sample; between them the signs were not followed")

    def point(t: float):
        if not ends[0] < t < ends[1]:
            raise InputError(f"t = {t!r} lies at an end of this curve of steady states or outside it")
        with many_digits():
            Omega, gamma = _state(plane, Fraction(tan(t / 2)), side)
            return tuple(float(v.mid()) for v in (*(Omega * g for g in gamma), *gamma))
    which = "lesser" if side < 0 else "greater"
    return EquilibriumCurve(
        f"{which} Omega for t in ({ends[0]:.6g}, {ends[1]:.6g})", f"gamma{plane.i + 1} = 0, A (Omega^2 - N) + B Omega + C = 0",
        f"gamma{j + 1} = cos t, gamma{k + 1} = sin t, omega = Omega gamma with the {which} root Omega", point,
        (CurveSegment(ends, *shared),), (), samples)


def _angle(tau, otherwise) -> float:
    from math import atan, pi
    return otherwise * pi if tau is None else 2 * atan(float(tau))


def _chosen(lo, hi):
    some = sample_parameters(lo, hi, Fraction(1)) or [values_inside(lo, hi, Fraction(1))]
    return sorted({some[0], some[len(some) // 2], some[-1]})
