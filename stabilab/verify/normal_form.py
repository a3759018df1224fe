"""The rates about a fixed or a moving centre of spin-up in the variables of the inequality, from their
coefficients alone.

About a fixed centre. Along the axis called 1 (cyclic relabelling; turned by half a turn about axis 2 where
the sense is negative) the other two rates obey x2' = (kappa2 x1 + sigma2) x3 + rho2 x1 + m2 and x3' = (kappa3
x1 + rho3) x2 + sigma3 x1 + m3. About c2 = -sigma3/kappa3, c3 = -rho2/kappa2, with U = x2 - c2, V = x3 - c3
and zeta = U + i q V, q^2 = -kappa2/kappa3 (they turn where kappa2 kappa3 < 0), q of the sign of -kappa2,

    zeta' = i om X zeta + i h zeta* + mu,   X' = M + g Im zeta^2 + Re(kap* zeta),   om = sqrt(-kappa2 kappa3),
      X = x1 + shift,

by inserting U = (zeta + zeta*)/2, V = (zeta - zeta*)/(2 i q): om shift = (q rho3 - sigma2/q)/2, h = (q rho3 +
sigma2/q)/2, mu = m2 + sigma2 c3 + i q (m3 + rho3 c2), M = m1 + kappa1 c2 c3 + rho1 c3 + sigma1 c2, g =
kappa1/(2 q), kap = kappa1 c3 + sigma1 + i (kappa1 c2 + rho1)/q.

About a moving centre: a body axis, or the equator of a body of revolution. With the frame, signs and letters
of `normal_form`, let P = -tau (kappa2 x + sigma2) and Q = tau (kappa3 x + rho3) be positive, not falling (x =
x1, tau = +-1):

    x2' = -tau P x3 + rho2 x + m2,   x3' = tau Q x2 + sigma3 x + m3   vanish at   c2 = N2/Q, c3 = N3/P,   N2 =
    -tau (sigma3 x + m3), N3 = tau (rho2 x + m2).

With u = x2 - c2, v = x3 - c3, w = (Q/P)^(1/4) and zeta = w u + i tau v/w,

    zeta' = i sqrt(P Q) zeta + x' (r zeta* + f),   x' = G + g Im zeta^2 + Re(k* zeta),   r = w'/w = (Q'/Q -
    P'/P)/4,   f = -w c2' - i tau c3'/w,
    g = tau kappa1/2,   k = (kappa1 c3 + sigma1)/w + i tau w (kappa1 c2 + rho1),   G = m1 + kappa1 c2 c3 +
    rho1 c3 + sigma1 c2   (' of x alone is d/dx).

Re(k* f) = -(kappa1 c3 + sigma1) c2' - (kappa1 c2 + rho1) c3' = -G': the mean drift of |zeta|^2 G vanishes.
All is written in powers of P^(1/4) and Q^(1/4); of the ways to write a quotient in them the one is taken that
leaves P or Q beside a constant, for large parts cancel in others.

Equator. The axis i has kappa_i = 0 and its two others, j and k, turn alike: kappa_k = -kappa_j, rho_k =
-sigma_j. Along (-sigma_k, rho_j), the wheel's part in the equator, sigma3 vanishes if rho_i rho_j = sigma_i
sigma_k, so Q is constant; the sense along it is that in which Q is positive.
"""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from flint import acb, arb, fmpq

from .numbers import Rates, ball, q


@dataclass(frozen=True)
class Form:
    """order: the axes that are called 1, 2, 3; signs: of the turned frame; M exact; the rest balls (arb,
    acb)."""

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

    def place(self, state: Sequence[arb]):
        """(X, zeta) of three balls."""
        x1, x2, x3 = (state[n] * s for n, s in zip(self.order, self.signs))
        return x1 + self.shift, acb(x2 - ball(self.centre[0]), self.q * (x3 - ball(self.centre[1])))


def turned(rates: Rates, axis: int, sense: int):
    """(order, signs, kappa, rho, sigma, m) with an axis (0, 1, 2) called 1, turned by half a turn about axis
    2 where the sense is -1."""
    order, signs = (axis, (axis + 1) % 3, (axis + 2) % 3), (sense, 1, sense)
    pick = lambda row, of: tuple(row[n] * signs[i] * of(i) for i, n in enumerate(order))
    ahead, later = lambda i: signs[(i + 1) % 3], lambda i: signs[(i + 2) % 3]
    return (order, signs, pick(rates.kappa, lambda i: ahead(i) * later(i)), pick(rates.rho, later),
            pick(rates.sigma, ahead), pick(rates.m, lambda i: 1))


def form_about(rates: Rates, axis: int, sense: int) -> Form | None:
    """The form about an axis (0, 1, 2) in a sense (+1, -1); None where the spin about it does not turn the
    other two."""
    order, signs, (k1, k2, k3), (r1, r2, r3), (s1, s2, s3), (m1, m2, m3) = turned(rates, axis, sense)
    if not k2 * k3 < 0:
        return None
    c2, c3 = -s3 / k3, -r2 / k2
    q = ball(-k2 / k3).sqrt() * (1 if k2 < 0 else -1)
    om = ball(-k2 * k3).sqrt()
    turn, beat = (q * ball(r3) - ball(s2) / q) / 2, (q * ball(r3) + ball(s2) / q) / 2
    return Form(order, signs, (c2, c3), q, turn / om, om, beat,
                acb(ball(m2 + s2 * c3), q * ball(m3 + r3 * c2)), m1 + k1 * c2 * c3 + r1 * c3 + s1 * c2,
                ball(k1) / (2 * q), acb(ball(k1 * c3 + s1), ball(k1 * c2 + r1) / q))


@dataclass(frozen=True)
class MovingForm:
    """rows: the frame, three vectors of balls; P, Q: (slope, value at 0), balls, the slope of a constant Q
    exactly 0; N2, N3 likewise; M: the limit of G for great x; G, k, f: {(a, b): c} of c P^(-a/4) Q^(-b/4), r
    of P^-1 Q^-1; g. quotient: Q/P where it is constant."""

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

    def place(self, state: Sequence[arb]):
        """(x, zeta) of three balls where P and Q are positive there; zeta is not finite else."""
        x, x2, x3 = (sum((a * v for a, v in zip(row, state)), ball(0)) for row in self.rows)
        P, Q = self.at(x)
        w = (Q / P).root(4)
        return x, acb(w * (x2 - value(self.N2, x) / Q), self.tau * (x3 - value(self.N3, x) / P) / w)

    def at(self, x: arb | Fraction):
        """(P, Q) at a ball."""
        return value(self.P, x), value(self.Q, x)


def value(line, x):
    """A linear function, (slope, value at 0), at x."""
    return line[0] * x + line[1]


def moving_form(rates: Rates, axis: int, sense: int) -> MovingForm | None:
    """The form about a body axis (0, 1, 2) in a sense (+1, -1); None where the spin about it does not turn
    the other two."""
    order, signs, *numbers = turned(rates, axis, sense)
    rows = tuple(tuple(ball(sign * (n == m)) for m in range(3)) for sign, n in zip(signs, order))
    return (_form(rows, *([q(v) for v in three] for three in numbers)) if numbers[0][1] * numbers[0][2] < 0
            else None)


def equator(rates: Rates) -> MovingForm | None:
    """The form along the equator; None where the body is not one of revolution, has no wheel in the equator,
    or the torque is against it."""
    axes = [i for i in range(3) if rates.kappa[i] == 0]
    if len(axes) != 1:
        return None
    i = axes[0]
    j, k = (i + 1) % 3, (i + 2) % 3
    kappa, rho, sigma, m = rates.kappa, rates.rho, rates.sigma, rates.m
    if kappa[k] != -kappa[j] or rho[k] != -sigma[j] or rho[i] * rho[j] != sigma[i] * sigma[k] or not (
        rho[j] or sigma[k]):
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
    return _form(tuple(map(tuple, rows)), (q(kappa[j]), q(-kappa[j]), nothing),
                 (nothing, q(-sigma[j]), sign * ball(pull) / size),
                 (q(sigma[j]), -sign * size, nothing),
                 (c * ball(m[j]) + s * ball(m[k]), c * ball(m[k]) - s * ball(m[j]), ball(m[i])))


def _form(rows, kappa, rho, sigma, m) -> MovingForm | None:
    """From the coefficients in the frame: flint's rationals, or balls where they are none."""
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
    noted = lambda terms: {key: c for key, c in terms.items() if not c.is_zero()}
    P_, Q_, N2_, N3_ = (tuple(map(arb, line)) for line in (P, Q, N2, N3))
    return MovingForm(rows, tau, P_, Q_, N2_, N3_, arb(M), noted(_balls({(0, 0): M} | G)), noted(k), noted(f),
                      arb((Q[0] * P[1] - P[0] * Q[1]) / 4), tau * arb(k1) / 2,
                      None if flat or Q[0] * P[1] != P[0] * Q[1] else arb(Q[0] / P[0]))


def _wronskian(line: tuple[fmpq, arb | fmpq], other: Sequence[fmpq | arb]):
    """line' other - line other' of two linear functions, a constant: -(other/line)' line^2."""
    return line[0] * other[1] - line[1] * other[0]


def _drive(k1: fmpq, r1: fmpq | arb, s1: fmpq | arb, m1: arb | fmpq, beat: arb | fmpq,
           P: tuple[fmpq, arb | fmpq], Q: tuple[fmpq, arb | fmpq], N2: Sequence[fmpq | arb],
           N3: Sequence[fmpq | arb], flat: bool):
    """(the limit of G, its other terms): the quadratic kappa1 N2 N3 + rho1 N3 Q + sigma1 N2 P over P Q, split
    into 1, 1/Q, 1/P and 1/(P Q), the last with -kappa1 m2 m3, which a body has there."""
    product = lambda a, b: (a[0] * b[0], a[0] * b[1] + a[1] * b[0], a[1] * b[1])
    n2, n1, n0 = (k1 * a + r1 * b + s1 * c
                  for a, b, c in zip(product(N2, N3), product(N3, Q), product(N2, P)))
    if flat:
        return m1 + n1 / (P[0] * Q[1]), {(4, 4): n0 - n1 / P[0] * P[1]}
    top = n2 / (P[0] * Q[0])
    wide = product(P, Q)
    n1, n0, last = n1 - top * wide[1], n0 - top * wide[2] + k1 * beat, -k1 * beat
    det = P[0] * Q[1] - Q[0] * P[1]
    if det == 0:
        return m1 + top, {(0, 4): n1 / P[0], (4, 4): last + n0 - n1 / P[0] * P[1]}
    return m1 + top, {(0, 4): (n1 * Q[1] - n0 * Q[0]) / det, (4, 0): (P[0] * n0 - P[1] * n1) / det,
                      (4, 4): last}


def _beside(line: Sequence[fmpq | arb], other: tuple[fmpq, arb | fmpq]):
    """(h, t): the linear function is h + t other."""
    t = line[0] / other[0]
    return line[1] - t * other[1], t


def _balls(terms: Mapping[tuple[int, int], Any]):
    return {key: acb(arb(c)) for key, c in terms.items()}
