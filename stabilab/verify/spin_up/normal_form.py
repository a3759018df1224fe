"""The normal form of the rates about an axis whose spin turns the other two, from the coefficients of the rates alone.

Along the axis called 1 (cyclic relabelling; turned by half a turn about axis 2 where the sense is negative) the other two rates obey
x2' = (kappa2 x1 + sigma2) x3 + rho2 x1 + m2 and x3' = (kappa3 x1 + rho3) x2 + sigma3 x1 + m3. About c2 = -sigma3/kappa3, c3 = -rho2/kappa2, with U = x2 - c2,
V = x3 - c3 and zeta = U + i q V, q^2 = -kappa2/kappa3 (they turn where kappa2 kappa3 < 0), q of the sign of -kappa2,

    zeta' = i om X zeta + i h zeta* + mu,   X' = M + g Im zeta^2 + Re(kap* zeta),   om = sqrt(-kappa2 kappa3),   X = x1 + shift,

by inserting U = (zeta + zeta*)/2, V = (zeta - zeta*)/(2 i q): om shift = (q rho3 - sigma2/q)/2, h = (q rho3 + sigma2/q)/2, mu = m2 + sigma2
c3 + i q (m3 + rho3 c2), M = m1 + kappa1 c2 c3 + rho1 c3 + sigma1 c2, g = kappa1/(2 q), kap = kappa1 c3 + sigma1 + i (kappa1 c2 + rho1)/q.
"""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from ..numbers import ball


@dataclass(frozen=True)
class Form:
    """order: the axes that are called 1, 2, 3; signs: of the turned frame; M exact; the rest balls (arb, acb)."""

    order: tuple
    signs: tuple
    centre: tuple
    q: object
    shift: object
    om: object
    h: object
    mu: object
    M: Fraction
    g: object
    kap: object

    def place(self, state):
        """(X, zeta) of three balls."""
        from flint import acb
        x1, x2, x3 = (state[n] * s for n, s in zip(self.order, self.signs))
        return x1 + self.shift, acb(x2 - ball(self.centre[0]), self.q * (x3 - ball(self.centre[1])))


def turned(rates, axis: int, sense: int):
    """(order, signs, kappa, rho, sigma, m) with an axis (0, 1, 2) called 1, turned by half a turn about axis 2 where the sense is -1."""
    order, signs = (axis, (axis + 1) % 3, (axis + 2) % 3), (sense, 1, sense)
    pick = lambda row, of: tuple(row[n] * signs[i] * of(i) for i, n in enumerate(order))
    ahead, later = lambda i: signs[(i + 1) % 3], lambda i: signs[(i + 2) % 3]
    return (order, signs, pick(rates.kappa, lambda i: ahead(i) * later(i)), pick(rates.rho, later), pick(rates.sigma, ahead), pick(rates.m, lambda i: 1))


def form_about(rates, axis: int, sense: int) -> Form | None:
    """The form about an axis (0, 1, 2) in a sense (+1, -1); None where the spin about it does not turn the other two."""
    from flint import acb
    order, signs, (k1, k2, k3), (r1, r2, r3), (s1, s2, s3), (m1, m2, m3) = turned(rates, axis, sense)
    if not k2 * k3 < 0:
        return None
    c2, c3 = -s3 / k3, -r2 / k2
    q = ball(-k2 / k3).sqrt() * (1 if k2 < 0 else -1)
    om = ball(-k2 * k3).sqrt()
    turn, beat = (q * ball(r3) - ball(s2) / q) / 2, (q * ball(r3) + ball(s2) / q) / 2
    return Form(order, signs, (c2, c3), q, turn / om, om, beat, acb(ball(m2 + s2 * c3), q * ball(m3 + r3 * c2)), m1 + k1 * c2 * c3 + r1 * c3 + s1 * c2,
                ball(k1) / (2 * q), acb(ball(k1 * c3 + s1), ball(k1 * c2 + r1) / q))
