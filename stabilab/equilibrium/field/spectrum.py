"""Small motions about a permanent rotation omega = Omega gamma of a body in a field: spectrum and second variation.

On |gamma| = 1 the amended potential at constant Omega is U = -gamma . S gamma/2 - b . gamma with
S = (Omega^2 - N) D - Omega E e3 e3^T, b = Omega Lambda + s; a permanent rotation is a critical point, (S - mu) gamma = -b.
At constant area integral A it gains a positive term of rank one: its second variation on the tangent plane is
K = mu - S + v v^T/I with v = dU'/dOmega = -(S' gamma + Lambda), I = gamma . D gamma.
Linear motion: z^2 (z^4 + a z^2 + b), the two zeros from |gamma| and from the curve of permanent rotations;
a = -tr(J^2)/2 and b = I det K/(D1 D2 D3).
  K positive definite: stable (energy at constant area has a strict minimum, and it persists as the area changes).
  det K < 0: b < 0, a positive eigenvalue.
  K negative definite: the spectrum decides instability; where it is a centre (a > 0, a^2 > 4 b) energy does not decide.
Written for any scalars, with gamma as a ratio gamma/q, so that the same lines serve balls and polynomials.
"""
from __future__ import annotations

from dataclasses import dataclass

from ...numbers.balls import rational
from ...numbers.vectors import Number, cross, dot
from ...physics.coefficients import linear_rates


@dataclass(frozen=True)
class Field:
    """The coefficients of `gyroscopic.Content` as flint rationals."""

    D: tuple
    Lambda: tuple
    s: tuple
    N: Number
    E: Number

    @classmethod
    def of(cls, parts):
        return cls(*(tuple(map(rational, row)) for row in (parts.D, parts.Lambda, parts.s)), rational(parts.N), rational(parts.E))

    def stiffness(self, Omega):
        """Diagonal of S."""
        W = Omega * Omega - self.N
        return (W * self.D[0], W * self.D[1], W * self.D[2] - Omega * self.E)

    def pull(self, Omega):
        """b = Omega Lambda + s."""
        return tuple(Omega * l + s for l, s in zip(self.Lambda, self.s))


def second_variation(field: Field, Omega, mu, gamma, q=1):
    """(q^4 I det K, q^4 I tr K) at gamma/q."""
    n = [k - mu for k in field.stiffness(Omega)]
    slope = (Omega * 2 * field.D[0], Omega * 2 * field.D[1], Omega * 2 * field.D[2] - field.E)
    v = [-(d * g + q * l) for d, g, l in zip(slope, gamma, field.Lambda)]
    squares = [g * g for g in gamma]
    spread = dot(field_inertia(field, gamma), gamma)
    plane = n[1] * n[2] * squares[0] + n[2] * n[0] * squares[1] + n[0] * n[1] * squares[2]
    across = cross(v, gamma)
    determinant = spread * plane - sum((n[i] * across[i] * across[i] for i in range(1, 3)), n[0] * across[0] * across[0])
    trace = dot(across, across) - spread * dot(n, [q * q - x for x in squares])
    return determinant, trace


def field_inertia(field: Field, gamma):
    """D gamma."""
    return tuple(g * d for d, g in zip(field.D, gamma))


def blocks(field: Field, Omega, gamma, q=1):
    """Rows of q A, q B with delta omega' = A delta omega + B delta gamma at gamma/q."""
    omega = tuple(Omega * g for g in gamma)
    H = [w * d + q * l for d, w, l in zip(field.D, omega, field.Lambda)]
    H[2] = H[2] - gamma[2] * field.E
    A = linear_rates(field.D, omega, H)
    spread = field_inertia(field, gamma)
    s = [q * x for x in field.s]
    B = []
    for i, (j, k) in enumerate(((1, 2), (2, 0), (0, 1))):  # (s x g + N (g x D gamma + gamma x D g))_i
        row = [omega[0] * 0] * 3
        row[j] = (-s[k] + (spread[k] - gamma[k] * field.D[j]) * field.N) * (1 / field.D[i])
        row[k] = (s[j] + (gamma[j] * field.D[k] - spread[j]) * field.N) * (1 / field.D[i])
        B.append(row)
    B[0][2] = B[0][2] + omega[1] * (field.E / field.D[0])   # E g3 omega x e3
    B[1][2] = B[1][2] - omega[0] * (field.E / field.D[1])
    return A, B


def coefficients(field: Field, Omega, mu, gamma, q=1):
    """(q^2 a, q^4 b) of z^4 + a z^2 + b."""
    A, B = blocks(field, Omega, gamma, q)
    x, y, z = gamma
    turn = [[x * 0, -z, y], [z, x * 0, -x], [-y, x, x * 0]]  # gamma x
    pairs = [(i, j) for i in range(3) for j in range(3)]
    square = sum((A[i][j] * A[j][i] + B[i][j] * turn[j][i] * 2 for i, j in pairs), x * 0)
    a = Omega * Omega * q * q - square * _half()
    determinant, _ = second_variation(field, Omega, mu, gamma, q)
    return a, determinant * (1 / (field.D[0] * field.D[1] * field.D[2]))


def _half():
    from flint import fmpq
    return fmpq(1, 2)
