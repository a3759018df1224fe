"""The rates of a gyrostat from the certificate's numbers."""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from flint import arb, fmpq_poly

from .numbers import Malformed, ball, field, hull, number, numbers, q, sign

# --- The rates of the three components, from the numbers of a scene: x_i' = kappa x_j x_k + rho x_k + sigma
# x_j + m
AHEAD = ((1, 2), (2, 0), (0, 1))


@dataclass(frozen=True)
class Rates:
    """Coefficients (each a list of three fractions), and two affine conditions (normal, constant) that every
    equilibrium meets: normal . x + constant = 0. torque: whether any component of it acts. integrals: two
    functions sum (a_i x_i^2/2 + b_i x_i), each as (a, b), whose rates along the motion are these
    conditions."""

    kappa: list
    rho: list
    sigma: list
    m: list
    conditions: tuple
    torque: bool
    integrals: tuple
    parallel: tuple | None = None  # (D, lambda) of a body: without torque D x + lambda is parallel to x

    @classmethod
    def of_scene(cls, scene) -> Rates:
        """The rates of the certificate's scene."""
        kind = field(scene, "variables", "scene", str)
        if kind == "physical":
            D, lam, M = (numbers(field(scene, key, "scene"), f"scene.{key}", 3)
                         for key in ("inertia", "momentum", "torque"))
            if min(D) <= 0:
                raise Malformed("scene.inertia: expected positive moments")
            return cls.of_body(D, lam, M)
        if kind == "scaled":
            a, b = (number(field(scene, key, "scene"), f"scene.{key}") for key in "ab")
            return cls.of_scaled(a, b, numbers(field(scene, "mu", "scene"), "scene.mu", 3))
        raise Malformed(f"scene.variables: expected 'physical' or 'scaled', got {kind!r}")

    @classmethod
    def of_body(cls, D, lam, M) -> Rates:
        """D x' = (D x + lambda) x x + M, written out."""
        kappa = [(D[j] - D[k]) / D[i] for i, (j, k) in enumerate(AHEAD)]
        rho = [lam[j] / D[i] for i, (j, k) in enumerate(AHEAD)]
        sigma = [-lam[k] / D[i] for i, (j, k) in enumerate(AHEAD)]
        m = [M[i] / D[i] for i in range(3)]
        conditions = ((list(M), Fraction(0)),
                      ([d * t for d, t in zip(D, M)], sum(l * t for l, t in zip(lam, M))))
        integrals = (D, [Fraction(0)] * 3), ([d * d for d in D], [d * l for d, l in zip(D, lam)])
        return cls(kappa, rho, sigma, m, conditions, any(M), integrals, (D, lam))

    @classmethod
    def of_scaled(cls, a, b, mu) -> Rates:
        """x1' = x2 x3 + mu1, x2' = -x3 (x1 + a) + mu2, x3' = x2 (x1 + b) + mu3."""
        o, one = Fraction(0), Fraction(1)
        conditions = (([mu[0], mu[1], o], mu[0] * a), ([mu[0], o, -mu[2]], mu[0] * b))
        integrals = ([one, one, o], [a, o, o]), ([one, o, -one], [b, o, o])
        return cls([one, -one, one], [o, o, b], [o, -a, o], list(mu), conditions, any(mu), integrals)

    def at(self, x, w=1):
        """The rates at x/w, times w^2: fractions, balls or polynomials alike."""
        kappa, rho, sigma, m = self._lifted(x)
        return [kappa[i] * x[j] * x[k] + (rho[i] * x[k] + sigma[i] * x[j]) * w + m[i] * w * w
                for i, (j, k) in enumerate(AHEAD)]

    def jacobian(self, x, w=1):
        """Rows of derivatives of the rates at x/w, times w."""
        kappa, rho, sigma, _ = self._lifted(x)
        rows = [[x[0] * 0] * 3 for _ in AHEAD]
        for i, (j, k) in enumerate(AHEAD):
            rows[i][j], rows[i][k] = kappa[i] * x[k] + sigma[i] * w, kappa[i] * x[j] + rho[i] * w
        return rows

    def _lifted(self, x):
        """The coefficients in the arithmetic of x."""
        lift = q if isinstance(x[0], fmpq_poly) else ball if isinstance(x[0], arb) else Fraction
        return [[lift(v) for v in row] for row in (self.kappa, self.rho, self.sigma, self.m)]


def characteristic(J):
    """(m, n) of z^3 + m z + n for a matrix with zero diagonal."""
    m = -(J[0][1] * J[1][0] + J[0][2] * J[2][0] + J[1][2] * J[2][1])
    n = -(J[0][1] * J[1][2] * J[2][0] + J[0][2] * J[1][0] * J[2][1])
    return m, n


def excluded(rates, box) -> bool:
    """Whether a rate has one sign all over the box."""
    return any(sign(v) in (1, -1) for v in rates.at([hull(a, b) for a, b in box]))
