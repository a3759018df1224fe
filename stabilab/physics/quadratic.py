"""Quadratic rate equations of a gyrostat under constant torque, with exact coefficients.

    x_i' = kappa_i x_j x_k + rho_i x_k + sigma_i x_j + m_i        (i, j, k cyclic)

Physical and scaled variables both have this form, so one analysis serves both. Coefficients are exact rationals:
differences such as D1 - D2 or b - a are formed before the one rounding to double.
"""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from functools import cached_property

from ..numbers.vectors import CYCLE, Exact3, Number, Triple
from ..record import record


@record
class QuadraticForm:
    """Coefficients of the rates; `symbol` is the letter of the state ("omega" or "x")."""

    kappa: Exact3
    rho: Exact3
    sigma: Exact3
    m: Exact3
    symbol: str = "omega"

    @cached_property
    def coefficients(self) -> tuple[tuple[float, ...], ...]:
        """(kappa, rho, sigma, m), each rounded once to double."""
        return tuple(tuple(float(v) for v in row) for row in (self.kappa, self.rho, self.sigma, self.m))

    def rate(self, x: Sequence[Number]) -> list[Number]:
        """x' for one state: three numbers of any type (floats, fractions, balls) -> list of three."""
        rows: tuple[Triple, ...] = (self.kappa, self.rho, self.sigma, self.m)
        if isinstance(x[0], float):
            rows = self.coefficients
        kappa, rho, sigma, m = rows
        return [kappa[i] * x[j] * x[k] + rho[i] * x[k] + sigma[i] * x[j] + m[i] for i, (j, k) in enumerate(CYCLE)]

    def jacobian(self, x: Sequence[Number]) -> list[list[Number]]:
        """3 x 3 nested list: derivative of rate i by component; entries of the type of x."""
        kappa, rho, sigma, _ = self.coefficients if isinstance(x[0], float) else (self.kappa, self.rho, self.sigma, 0)
        rows = []
        for i, (j, k) in enumerate(CYCLE):
            row = [x[0] * 0] * 3
            row[j] = kappa[i] * x[k] + sigma[i]
            row[k] = kappa[i] * x[j] + rho[i]
            rows.append(row)
        return rows


def euler_form(inertia: Exact3, momentum: Exact3, torque: Exact3) -> QuadraticForm:
    """D omega' = (D omega + lambda) x omega + M as rates of omega (theory: Euler's equations of a gyrostat)."""
    D, lam = inertia, momentum
    return QuadraticForm(
        kappa=tuple((D[j] - D[k]) / D[i] for i, (j, k) in enumerate(CYCLE)),
        rho=tuple(lam[j] / D[i] for i, (j, k) in enumerate(CYCLE)),
        sigma=tuple(-lam[k] / D[i] for i, (j, k) in enumerate(CYCLE)),
        m=tuple(torque[i] / D[i] for i in range(3)), symbol="omega")


def scaled_form(a: Fraction, b: Fraction, mu: Exact3) -> QuadraticForm:
    """x1' = x2 x3 + mu1, x2' = -x3 (x1 + a) + mu2, x3' = x2 (x1 + b) + mu3 (Amer et al. 2024, eqs (3), (5))."""
    zero, one = Fraction(0), Fraction(1)
    return QuadraticForm(kappa=(one, -one, one), rho=(zero, zero, b), sigma=(zero, -a, zero), m=tuple(mu), symbol="x")


def rests(form: QuadraticForm, state: Iterable[Number]) -> bool:
    """Whether every rate vanishes at the state (floats or Fractions, taken as exact), exactly."""
    return not any(form.rate([Fraction(v) for v in state]))
