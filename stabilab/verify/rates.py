"""The rates of a gyrostat from the certificate's numbers."""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from flint import arb, fmpq_mpoly, fmpq_poly

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
            rows = [numbers(field(scene, key, "scene"), f"scene.{key}", 3)
                    for key in ("inertia", "momentum", "torque")]
            if min(rows[0]) <= 0:
                raise Malformed("scene.inertia: expected positive moments")
        elif kind == "scaled":
            rows = [[number(field(scene, key, "scene"), f"scene.{key}")] for key in "ab"]
            rows.append(numbers(field(scene, "mu", "scene"), "scene.mu", 3))
        else:
            raise Malformed(f"scene.variables: expected 'physical' or 'scaled', got {kind!r}")
        return cls.of(kind, *rows)

    @classmethod
    def of(cls, variables, first, second, torque) -> Rates:
        """Those of `written_out`, over their weights."""
        weights, *terms, conditions, integrals = written_out(variables, first, second, torque)
        kappa, rho, sigma, m = ([c / w for c, w in zip(row, weights)] for row in terms)
        return cls(kappa, rho, sigma, m, conditions, any(torque), integrals,
                   (first, second) if variables == "physical" else None)

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
        lift = q if isinstance(x[0], (fmpq_poly, fmpq_mpoly)) else ball if isinstance(x[0], arb) else Fraction
        return [[lift(v) for v in row] for row in (self.kappa, self.rho, self.sigma, self.m)]


def written_out(variables: str, first, second, torque) -> tuple:
    """(w, kappa, rho, sigma, m, conditions, integrals) of w_i x_i' = kappa_i x_j x_k + rho_i x_k + sigma_i
    x_j + m_i, the last two as of `Rates`. first, second: moments and momentum of a body, D x' = (D x +
    lambda) x x + M; [a] and [b] of the scaled system x1' = x2 x3 + mu1, x2' = -x3 (x1 + a) + mu2, x3' = x2
    (x1 + b) + mu3. Of numbers of any kind."""
    o = 0 * torque[0]
    one = o + 1
    if variables == "scaled":
        (a,), (b,), mu = first, second, torque
        conditions = ([mu[0], mu[1], o], mu[0] * a), ([mu[0], o, -mu[2]], mu[0] * b)
        integrals = ([one, one, o], [a, o, o]), ([one, o, -one], [b, o, o])
        return [one] * 3, [one, -one, one], [o, o, b], [o, -a, o], mu, conditions, integrals
    D, lam = first, second
    times = lambda v: [d * c for d, c in zip(D, v)]
    conditions = (torque, o), (times(torque), sum((l * t for l, t in zip(lam, torque)), o))
    integrals = (D, [o] * 3), (times(D), times(lam))
    return (D, [D[j] - D[k] for j, k in AHEAD], [lam[j] for j, _ in AHEAD], [-lam[k] for _, k in AHEAD],
            torque, conditions, integrals)


def characteristic(J):
    """(m, n) of z^3 + m z + n for a matrix with zero diagonal."""
    m = -(J[0][1] * J[1][0] + J[0][2] * J[2][0] + J[1][2] * J[2][1])
    n = -(J[0][1] * J[1][2] * J[2][0] + J[0][2] * J[1][0] * J[2][1])
    return m, n


def excluded(rates, box) -> bool:
    """Whether a rate has one sign all over the box."""
    return any(sign(v) in (1, -1) for v in rates.at([hull(a, b) for a, b in box]))
