"""The dimensionless variables of Amer et al. 2024, eqs (2)-(4), both ways.

With k1 = (D2-D3)/D1, k2 = (D1-D3)/D2, k3 = (D1-D2)/D3, k = k1 k2 k3 and a torque measure u:

    omega_j = sqrt(u k_j) x_j,   t = tau / sqrt(u k),   M_j = D_j u sqrt(k k_j) mu_j,
    a = lambda1 / ((D1-D3) sqrt(u k1)),   b = lambda1 / ((D1-D2) sqrt(u k1)).

The paper forgets the root of u in a and b, which is harmless only for its u = 1.
"""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction

from ..errors import InputError
from ..numbers.exact import exact_vector, sqrt_fraction
from ..numbers.vectors import Exact3, Float3, Number
from ..record import record
from .body import Body
from .scene import ScaledGyrostat, Scene


@record
class Scaling:
    """omega_j = rate[j] x_j and t = time tau; exact up to square roots kept to 240 bits."""

    rate: Exact3
    time: Fraction
    u: Fraction

    def to_scaled(self, omega: Iterable[float]) -> Float3:
        """omega (rad/s), a sequence of three floats -> x."""
        return tuple(float(Fraction(w) / r) for w, r in zip(map(float, omega), self.rate))


def shape_factors(body: Body) -> tuple[Fraction, Fraction, Fraction]:
    """k1, k2, k3 of eq. (2). Raises InputError where the scaling is undefined: it needs D1 > D2 > D3."""
    d1, d2, d3 = body.exact
    if not d1 > d2 > d3:
        raise InputError("the scaled variables need D1 > D2 > D3, three different moments in falling order; "
                         f"here D = ({float(d1):g}, {float(d2):g}, {float(d3):g}): use physical variables")
    return (d2 - d3) / d1, (d1 - d3) / d2, (d1 - d2) / d3


def torque_measure(body: Body, torque: Sequence[Fraction]) -> Fraction:
    """u of eq. (4): sqrt(k2 k3 u1^2 + k3 k1 u2^2 + k1 k2 u3^2)/k with u_j = M_j/D_j; 0 for no torque."""
    k1, k2, k3 = shape_factors(body)
    u1, u2, u3 = (m / d for m, d in zip(torque, body.exact))
    return sqrt_fraction(k2 * k3 * u1 * u1 + k3 * k1 * u2 * u2 + k1 * k2 * u3 * u3) / (k1 * k2 * k3)


def scaling(body: Body, u: Fraction) -> Scaling:
    """The change of variables for torque measure u > 0."""
    if u <= 0:
        raise InputError("the scaled variables are undefined without a torque (u = 0): use physical variables, "
                         "or give the torque as mu (then u = 1)")
    k1, k2, k3 = shape_factors(body)
    return Scaling(tuple(sqrt_fraction(u * k) for k in (k1, k2, k3)), 1 / sqrt_fraction(u * k1 * k2 * k3), u)


def torque_from_mu(body: Body, mu: Sequence[Number], u: Fraction = Fraction(1)) -> Exact3:
    """M (N m), exact to 240 bits, from the dimensionless torque; u = 1 is the paper's choice."""
    ks = shape_factors(body)
    k = ks[0] * ks[1] * ks[2]
    return tuple(d * u * sqrt_fraction(k * kj) * m for d, kj, m in zip(body.exact, ks, exact_vector(mu, "mu")))


def to_scaled(scene: Scene, mu: Sequence[Number] | None = None) -> tuple[ScaledGyrostat, Scaling]:
    """The scaled twin of a physical scene and the change of variables.

    mu: the dimensionless torque where the case gave it (u = 1, no rounding through M); otherwise u from the torque
    and mu of unit length. Raises InputError where undefined (equal or unordered moments, no torque, a gyrostatic
    moment off axis 1).
    """
    lam = scene.vector("gyrostat")
    if lam[1] or lam[2]:
        raise InputError("the scaled variables need the gyrostatic moment along axis 1; use physical variables")
    d1, d2, d3 = scene.body.exact
    torque = scene.vector("constant_torque")
    u = Fraction(1) if mu is not None else torque_measure(scene.body, torque)
    change = scaling(scene.body, u)
    k1, k2, k3 = shape_factors(scene.body)
    if mu is None:
        k = k1 * k2 * k3
        mu = tuple(m / (d * u * sqrt_fraction(k * kj)) for m, d, kj in zip(torque, scene.body.exact, (k1, k2, k3)))
    root = sqrt_fraction(u * k1)
    return ScaledGyrostat(lam[0] / ((d1 - d3) * root), lam[0] / ((d1 - d2) * root), tuple(mu)), change
