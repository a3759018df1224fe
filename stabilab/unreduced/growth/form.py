"""Torque along a principal axis and a gyrostatic component along it: the law of growth, and the standard form

    u' = y2 y3 + 1,   y2' = -y3 (u - c/2),   y3' = y2 (u + c/2)

of the extreme (major or minor) axis, one number c. Differences of moments and offsets are exact before rounding.
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

from ...numbers.vectors import CYCLE, Float3


@dataclass(frozen=True)
class StandardForm:
    """x[axes] = rates * (u - shift, y2, y3), t = time * tau; axes 0-based, first the torque's."""

    c: float
    axes: tuple[int, int, int]
    rates: Float3
    shift: Fraction
    time: float

    def to_standard(self, x):
        """State of the scene -> (u, y2, y3); the shift is added before rounding."""
        i, p, q = self.axes
        return (float(Fraction(float(x[i])) + self.shift) / self.rates[0], x[p] / self.rates[1], x[q] / self.rates[2])


def standard_form(scene) -> StandardForm | None:
    """The change to standard form, or None where there is none (torque on a middle axis, a gyrostatic component across it,
    equal moments).

    x_i' = kappa_i x_p x_q + m,  x_p' = kappa_p x_q (x_i + alpha),  x_q' = kappa_q x_p (x_i + beta): with kappa_i kappa_q > 0 >
    kappa_p kappa_q the rates r_i^2 = |m|/g, r_p^2 = g |m|/(kappa_i kappa_q), r_q^2 = g |m|/|kappa_i kappa_p|, g^2 = |kappa_p kappa_q|, and
    the time 1/sqrt(g |m|) bring it to standard form; r_i has the sign of m, r_q that of m kappa_i.
    """
    form = scene.quadratic()
    i = _torque_axis(form)
    if i is None or form.rho[i] or form.sigma[i]:
        return None
    j, k = CYCLE[i]
    if form.sigma[k] or form.rho[j] or not form.kappa[j] * form.kappa[k] < 0 or not form.kappa[i]:
        return None
    alpha = {j: form.sigma[j] / form.kappa[j], k: form.rho[k] / form.kappa[k]}
    p, q = (j, k) if form.kappa[i] * form.kappa[k] > 0 else (k, j)
    kappa, m = form.kappa, abs(form.m[i])
    if alpha[p] == alpha[q]:
        return None
    g = math.sqrt(abs(kappa[p] * kappa[q]))
    sign = 1 if form.m[i] > 0 else -1
    r = math.sqrt(m / Fraction(g)) * sign
    rates = (r, math.sqrt(Fraction(g) * m / (kappa[i] * kappa[q])),
             math.sqrt(Fraction(g) * m / abs(kappa[i] * kappa[p])) * sign * (1 if kappa[i] > 0 else -1))
    return StandardForm(float((alpha[q] - alpha[p]) / Fraction(r)), (i, p, q), rates, (alpha[p] + alpha[q]) / 2,
                        1 / math.sqrt(Fraction(g) * m))


def _torque_axis(form):
    acting = [i for i in range(3) if form.m[i]]
    return acting[0] if len(acting) == 1 else None


def growth_law(scene):
    """(axis 0-based, J(state), J_rate): the law of `growth` with its exact rate; None where it does not
    apply (torque not along one principal axis, or no gyrostatic component along it)."""
    if scene.variables == "scaled":
        (a, b), mu = scene.exact_ab, scene.exact_mu
        if not mu[0] or mu[1] or mu[2] or a == b:
            return None
        c = b - a
        return 0, lambda x: float(Fraction(x[1])**2 + Fraction(x[2])**2 - 2 * c * Fraction(x[0])), float(-2 * c * mu[0])
    D, lam, M = scene.body.exact, scene.vector("gyrostat"), scene.vector("constant_torque")
    i = next((n for n in range(3) if M[n]), None)
    if i is None or any(M[n] for n in range(3) if n != i) or not lam[i]:
        return None

    def J(x):
        x = [Fraction(v) for v in x]
        return float(sum((d * v + h)**2 - D[i] * d * v * v for d, v, h in zip(D, x, lam)) / 2)
    return i, J, float(lam[i] * M[i])
