"""What is counted, as polynomials in the unknowns that are zero together: rates, the law that a motion keeps, where stability changes.

Coefficients are polynomials in t; a body's rates stand times its moments, w_i x_i' = kappa_i x_j x_k + rho_i x_k + sigma_i x_j + m_i with w = D (1 for the
scaled system). Equilibria satisfy two linear conditions besides (`rates.Rates`), which are sums of the rates.
"""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..rates import AHEAD
from .claims import Claims
from .ideal import Polynomial, added, times

UNITS = ((1, 0, 0), (0, 1, 0), (0, 0, 1))


@dataclass(frozen=True)
class Equations:
    """weights: w_i; rates, conditions: polynomials in three unknowns; integrals: (a, b) of the sums a_i x_i^2/2 + b_i x_i whose rates are the conditions."""

    weights: list[Any]
    rates: list[Polynomial]
    conditions: list[Polynomial]
    integrals: tuple[tuple[list[Any], list[Any]], ...]

    @classmethod
    def of(cls, claims: Claims) -> Equations:
        """Those of a certificate's scene."""
        zero = claims.scene["mu" if "mu" in claims.scene else "torque"][0] * 0
        one = zero + 1
        if claims.variables == "scaled":
            (a,), (b,), mu = claims.scene["a"], claims.scene["b"], claims.scene["mu"]
            weights, kappa, rho, sigma, m = [one] * 3, [one, -one, one], [zero, zero, b], [zero, -a, zero], mu
            conditions = ([mu[0], mu[1], zero], mu[0] * a), ([mu[0], zero, -mu[2]], mu[0] * b)
            integrals = ([one, one, zero], [a, zero, zero]), ([one, zero, -one], [b, zero, zero])
        else:
            D, lam, m = claims.scene["inertia"], claims.scene["momentum"], claims.scene["torque"]
            weights, kappa = D, [D[j] - D[k] for j, k in AHEAD]
            rho, sigma = [lam[j] for j, _ in AHEAD], [-lam[k] for _, k in AHEAD]
            conditions = (m, zero), ([d * t for d, t in zip(D, m)], sum((l * t for l, t in zip(lam, m)), zero))
            integrals = (D, [zero] * 3), ([d * d for d in D], [d * l for d, l in zip(D, lam)])
        rates = []
        for i, (j, k) in enumerate(AHEAD):
            both = tuple(int(n != i) for n in range(3))
            rates.append(_without_zeros({both: kappa[i], UNITS[k]: rho[i], UNITS[j]: sigma[i], (0, 0, 0): m[i]}))
        rows = [_without_zeros({**dict(zip(UNITS, normal)), (0, 0, 0): constant}) for normal, constant in conditions]
        return cls(weights, rates, rows, integrals)

    def slope(self, i: int, j: int) -> Polynomial:
        """The derivative of w_i x_i' by x_j."""
        return _without_zeros({tuple(p - (n == j) for n, p in enumerate(powers)): c for powers, c in self.rates[i].items() if powers[j]})

    @property
    def m(self) -> Polynomial:
        """m of the characteristic polynomial z^3 + m z + n, times all weights."""
        out: Polynomial = {}
        for i, (j, k) in enumerate(AHEAD):
            out = added(out, times(times(self.slope(j, k), self.slope(k, j)), _constant(self.weights[i])), less=True)
        return out

    @property
    def n(self) -> Polynomial:
        """n of it, times all weights."""
        first = times(times(self.slope(0, 1), self.slope(1, 2)), self.slope(2, 0))
        second = times(times(self.slope(0, 2), self.slope(1, 0)), self.slope(2, 1))
        return added(added({}, first, less=True), second, less=True)

    def torque(self, axis: int) -> Any:
        """Its part about an axis: without any, equilibria lie on curves in other planes too."""
        return self.rates[axis].get((0, 0, 0), self.weights[0] * 0)

    def along(self, axis: int) -> bool:
        """Whether all over the range the torque lies on principal axis `axis` (0, 1, 2) and no wheel along it keeps equilibria away: the rates and the
        conditions vanish in the plane across it but for the rate about it."""
        others = [f for n, f in enumerate(self.rates) if n != axis] + self.conditions
        return not any(self.across(axis, f) for f in others)

    def across(self, axis: int, f: Polynomial) -> Polynomial:
        """A polynomial in the plane across the axis where equilibria lie, x_axis = -shift, in the two other unknowns."""
        out: Polynomial = {}
        for powers, c in f.items():
            for _ in range(powers[axis]):
                c = c * -self.shift(axis)
            out = added(out, {tuple(p for n, p in enumerate(powers) if n != axis): c} if c != 0 else {})
        return out

    def shift(self, axis: int) -> Any:
        """The scaled system's a about the first axis; zero else."""
        return self.integrals[0][1][axis]

    @property
    def scaled(self) -> bool:
        return self.integrals[0][0][2] == 0

    def kept(self, axis: int) -> Polynomial | None:
        """A sum a_i x_i^2/2 + b_i x_i that every motion keeps and that leaves the axis out of its squares; None where it is none."""
        (a, b), (c, d) = self.integrals
        if self.scaled:
            first, second = ((1, -1), (0, 1), (1, 0))[axis]
        else:
            first, second = -self.weights[axis], 1
        squares, lines = ([u * first + v * second for u, v in zip(*rows)] for rows in ((a, c), (b, d)))
        law: Polynomial = {}
        for n in range(3):
            law = added(law, _without_zeros({tuple(2 * p for p in UNITS[n]): squares[n] / 2, UNITS[n]: lines[n]}))
        return law if not self.drift(law) else None

    def drift(self, law: Polynomial) -> Polynomial:
        """The rate of a polynomial along every motion, times all weights."""
        total: Polynomial = {}
        for i, (j, k) in enumerate(AHEAD):
            slope = _without_zeros({tuple(p - (n == i) for n, p in enumerate(powers)): c * powers[i] for powers, c in law.items() if powers[i]})
            total = added(total, times(times(slope, self.rates[i]), _constant(self.weights[j] * self.weights[k])))
        return total


def value(f: Polynomial, at: list[Any]) -> Any:
    """A polynomial at a state whose components are polynomials in t."""
    total = at[0] * 0
    for powers, c in f.items():
        for component, power in zip(at, powers):
            for _ in range(power):
                c = c * component
        total = total + c
    return total


def _constant(c: Any) -> Polynomial:
    return _without_zeros({(0, 0, 0): c})


def _without_zeros(f: Polynomial) -> Polynomial:
    return {powers: c for powers, c in f.items() if c != 0}
