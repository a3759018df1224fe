"""The form about the moving centre, from the coefficients of the rates alone: about a body axis, or along the equator of a body of revolution.

With the frame, signs and letters of `normal_form`, let P = -tau (kappa2 x + sigma2) and Q = tau (kappa3 x + rho3) be positive, not falling (x = x1, tau = +-1):

    x2' = -tau P x3 + rho2 x + m2,   x3' = tau Q x2 + sigma3 x + m3   vanish at   c2 = N2/Q, c3 = N3/P,   N2 = -tau (sigma3 x + m3), N3 = tau (rho2 x + m2).

With u = x2 - c2, v = x3 - c3, w = (Q/P)^(1/4) and zeta = w u + i tau v/w,

    zeta' = i sqrt(P Q) zeta + x' (r zeta* + f),   x' = G + g Im zeta^2 + Re(k* zeta),   r = w'/w = (Q'/Q - P'/P)/4,   f = -w c2' - i tau c3'/w,
    g = tau kappa1/2,   k = (kappa1 c3 + sigma1)/w + i tau w (kappa1 c2 + rho1),   G = m1 + kappa1 c2 c3 + rho1 c3 + sigma1 c2   (' of x alone is d/dx).

Re(k* f) = -(kappa1 c3 + sigma1) c2' - (kappa1 c2 + rho1) c3' = -G': the mean drift of |zeta|^2 G vanishes. All is written in powers of P^(1/4)
and Q^(1/4); of the ways to write a quotient in them the one is taken that leaves P or Q beside a constant, for large parts cancel in others.

Equator. The axis i has kappa_i = 0 and its two others, j and k, turn alike: kappa_k = -kappa_j, rho_k = -sigma_j. Along (-sigma_k, rho_j), the wheel's
part in the equator, sigma3 vanishes if rho_i rho_j = sigma_i sigma_k, so Q is constant; the sense along it is that in which Q is positive.
"""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from ..numbers import ball, q
from .normal_form import turned


@dataclass(frozen=True)
class MovingForm:
    """rows: the frame, three vectors of balls; P, Q: (slope, value at 0), balls, the slope of a constant Q exactly 0; N2, N3 likewise; M: the limit of G
    for great x; G, k, f: {(a, b): c} of c P^(-a/4) Q^(-b/4), r of P^-1 Q^-1; g. quotient: Q/P where it is constant."""

    rows: tuple
    tau: int
    P: tuple
    Q: tuple
    N2: tuple
    N3: tuple
    M: Any
    G: dict
    k: dict
    f: dict
    r: Any
    g: Any
    quotient: Any = None

    def place(self, state):
        """(x, zeta) of three balls where P and Q are positive there; zeta is not finite else."""
        from flint import acb
        x, x2, x3 = (sum((a * v for a, v in zip(row, state)), ball(0)) for row in self.rows)
        P, Q = self.at(x)
        w = (Q / P).root(4)
        return x, acb(w * (x2 - value(self.N2, x) / Q), self.tau * (x3 - value(self.N3, x) / P) / w)

    def at(self, x):
        """(P, Q) at a ball."""
        return value(self.P, x), value(self.Q, x)


def value(line, x):
    """A linear function, (slope, value at 0), at x."""
    return line[0] * x + line[1]


def moving_form(rates, axis: int, sense: int) -> MovingForm | None:
    """The form about a body axis (0, 1, 2) in a sense (+1, -1); None where the spin about it does not turn the other two."""
    order, signs, *numbers = turned(rates, axis, sense)
    rows = tuple(tuple(ball(sign * (n == m)) for m in range(3)) for sign, n in zip(signs, order))
    return _form(rows, *([q(v) for v in three] for three in numbers)) if numbers[0][1] * numbers[0][2] < 0 else None


def equator(rates) -> MovingForm | None:
    """The form along the equator; None where the body is not one of revolution, has no wheel in the equator, or the torque is against it."""
    axes = [i for i in range(3) if rates.kappa[i] == 0]
    if len(axes) != 1:
        return None
    i = axes[0]
    j, k = (i + 1) % 3, (i + 2) % 3
    kappa, rho, sigma, m = rates.kappa, rates.rho, rates.sigma, rates.m
    if kappa[k] != -kappa[j] or rho[k] != -sigma[j] or rho[i] * rho[j] != sigma[i] * sigma[k] or not (rho[j] or sigma[k]):
        return None
    size = ball(rho[j] ** 2 + sigma[k] ** 2).sqrt()
    pull = -sigma[k] * rho[i] - rho[j] * sigma[i]  # the coefficient of x2 in x3', times the size
    tau = 1 if kappa[j] > 0 else -1                # kappa2 = -kappa_j
    if not pull:
        return None
    sign = tau if pull > 0 else -tau
    c, s = (sign * ball(v) / size for v in (-sigma[k], rho[j]))
    rows, nothing = [[ball(0)] * 3 for _ in range(3)], q(Fraction(0))
    rows[0][j], rows[0][k], rows[1][j], rows[1][k], rows[2][i] = c, s, -s, c, ball(1)
    return _form(tuple(map(tuple, rows)), (q(kappa[j]), q(-kappa[j]), nothing), (nothing, q(-sigma[j]), sign * ball(pull) / size),
                 (q(sigma[j]), -sign * size, nothing), (c * ball(m[j]) + s * ball(m[k]), c * ball(m[k]) - s * ball(m[j]), ball(m[i])))


def _form(rows, kappa, rho, sigma, m) -> MovingForm | None:
    """From the coefficients in the frame: flint's rationals, or balls where they are none."""
    from flint import acb, arb
    (k1, k2, k3), (r1, r2, r3), (s1, s2, s3), (m1, m2, m3) = kappa, rho, sigma, m
    tau = -1 if k2 > 0 else 1
    P, Q, N2, N3 = (-tau * k2, -tau * s2), (tau * k3, tau * r3), (-tau * s3, -tau * m3), (tau * r2, tau * m2)
    flat = Q[0] == 0
    if flat and (N2[0] != 0 or not Q[1] > 0):
        return None
    M, G = _drive(k1, r1, s1, m1, m2 * m3, P, Q, N2, N3, flat)
    h, t = _beside((k1 * N3[0] + s1 * P[0], s1 * P[1]), P if flat else Q)
    k = {(3, 1): h + k1 * N3[1], (-1, 1) if flat else (3, -3): t}
    h, t = _beside((k1 * N2[0] + r1 * Q[0], r1 * Q[1]), P)
    side = acb(0, tau)
    k = _balls(k) | {key: side * arb(c) for key, c in (((1, 3), h + k1 * N2[1]), ((-3, 3), t))}
    f = {(1, 7): acb(arb(_wronskian(Q, N2))), (7, 1): side * arb(_wronskian(P, N3))}
    seen = lambda terms: {key: c for key, c in terms.items() if not c.is_zero()}
    P_, Q_, N2_, N3_ = (tuple(map(arb, line)) for line in (P, Q, N2, N3))
    return MovingForm(rows, tau, P_, Q_, N2_, N3_, arb(M), seen(_balls({(0, 0): M} | G)), seen(k), seen(f),
                      arb((Q[0] * P[1] - P[0] * Q[1]) / 4), tau * arb(k1) / 2, None if flat or Q[0] * P[1] != P[0] * Q[1] else arb(Q[0] / P[0]))


def _wronskian(line, other):
    """line' other - line other' of two linear functions, a constant: -(other/line)' line^2."""
    return line[0] * other[1] - line[1] * other[0]


def _drive(k1, r1, s1, m1, beat, P, Q, N2, N3, flat):
    """(the limit of G, its other terms): the quadratic kappa1 N2 N3 + rho1 N3 Q + sigma1 N2 P over P Q, split into 1, 1/Q, 1/P and 1/(P Q), the last
    with -kappa1 m2 m3, which a body has there."""
    product = lambda a, b: (a[0] * b[0], a[0] * b[1] + a[1] * b[0], a[1] * b[1])
    n2, n1, n0 = (k1 * a + r1 * b + s1 * c for a, b, c in zip(product(N2, N3), product(N3, Q), product(N2, P)))
    if flat:
        return m1 + n1 / (P[0] * Q[1]), {(4, 4): n0 - n1 / P[0] * P[1]}
    top = n2 / (P[0] * Q[0])
    wide = product(P, Q)
    n1, n0, last = n1 - top * wide[1], n0 - top * wide[2] + k1 * beat, -k1 * beat
    det = P[0] * Q[1] - Q[0] * P[1]
    if det == 0:
        return m1 + top, {(0, 4): n1 / P[0], (4, 4): last + n0 - n1 / P[0] * P[1]}
    return m1 + top, {(0, 4): (n1 * Q[1] - n0 * Q[0]) / det, (4, 0): (P[0] * n0 - P[1] * n1) / det, (4, 4): last}


def _beside(line, other):
    """(h, t): the linear function is h + t other."""
    t = line[0] / other[0]
    return line[1] - t * other[1], t


def _balls(terms):
    from flint import acb, arb
    return {key: acb(arb(c)) for key, c in terms.items()}
