"""The rate equations x_i' = kappa_i x_j x_k + rho_i x_k + sigma_i x_j + m_i, coefficients exact, for every
oracle here.

Written from Euler's equations D w' = (D w + lambda) x w + M and from x1' = x2 x3 + mu1, x2' = -x3 (x1 + a) +
mu2, x3' = x2 (x1 + b) + mu3 (Amer et al. 2024, eqs (1), (3), (5)); floats are taken at their exact binary
value.
"""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

CYCLE = ((1, 2), (2, 0), (0, 1))


@dataclass(frozen=True)
class Model:
    """weight_i turns 1/2 x_i^2 into the energy that margins are measured in: D_i, or 1 for the scaled system.
    """

    kappa: tuple
    rho: tuple
    sigma: tuple
    m: tuple
    weight: tuple

    def rate(self, x):
        return [self.kappa[i] * x[j] * x[k] + self.rho[i] * x[k] + self.sigma[i] * x[j] + self.m[i]
                for i, (j, k) in enumerate(CYCLE)]


def _exact(values):
    return tuple(Fraction(v) for v in values)


def physical(inertia, momentum=(0, 0, 0), torque=(0, 0, 0)) -> Model:
    """Body with principal moments, gyrostatic moment and constant torque; numbers or exact strings."""
    D, lam, M = _exact(inertia), _exact(momentum), _exact(torque)
    # component i of (D w + lam) x w is (D_j w_j + lam_j) w_k - (D_k w_k + lam_k) w_j
    return Model(kappa=tuple((D[j] - D[k]) / D[i] for i, (j, k) in enumerate(CYCLE)),
                 rho=tuple(lam[j] / D[i] for i, (j, k) in enumerate(CYCLE)),
                 sigma=tuple(-lam[k] / D[i] for i, (j, k) in enumerate(CYCLE)),
                 m=tuple(M[i] / D[i] for i in range(3)), weight=D)


def scaled(a, b, mu) -> Model:
    """The dimensionless system."""
    a, b, mu, one, zero = Fraction(a), Fraction(b), _exact(mu), Fraction(1), Fraction(0)
    return Model(kappa=(one, -one, one), rho=(zero, zero, b), sigma=(zero, -a, zero), m=mu, weight=(one,) * 3)
