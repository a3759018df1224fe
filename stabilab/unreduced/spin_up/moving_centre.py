"""The form about the moving centre: for nearly equal moments with a wheel, and for spin-up in the equator of a symmetric body.

Axis 1, frame and names as in `form`; d2, d3 need not share a sign where one vanishes. With P = d3 x + l1, Q = d2 x + l1 (x = omega1), p = s P > 0 and
q = s Q > 0, the transverse rates oscillate about w2* = (l2 x - M3)/Q, w3* = (l3 x + M2)/P, where omega2' and omega3' would vanish. Put
rho = (q/p)^(1/4), u = omega2 - w2*, v = omega3 - w3*, eta = sqrt(D2) rho u + i s sqrt(D3) v/rho. From D2 u' = -P v - D2 x' dw2*/dx and
D3 v' = Q u - D3 x' dw3*/dx, with dw2*/dx = n3/Q^2, n3 = d2 M3 + l1 l2, dw3*/dx = -n2/P^2, n2 = d3 M2 - l1 l3, exactly

    eta' = i Om eta + x' (r eta* + f),   D1 x' = G0 + g Im eta^2 + Re(k* eta),   Om = sqrt(p q/(D2 D3)),
    r = rho'/rho = s l1 (a2 - a3)/(4 p q),   f = -sqrt(D2) rho n3/q^2 + i s sqrt(D3) n2/(rho p^2),   g = s eps/(2 sqrt(D2 D3)),  eps = d3 - d2,
    k = (eps M2 - l3 Q)/(P sqrt(D2) rho) + i s rho (l2 P - eps M3)/(Q sqrt(D3)),   G0 = M1 + l2 M2/Q + l3 M3/P - eps M2 M3/(P Q).

(U V of the mean motion gives G0: eps w2* w3* + l2 w3* - l3 w2*, and eps x + Q = P.) All coefficients are sums of monomials p^(-a/4) q^(-b/4).

Mean drift. The flow keeps volume: the divergence of (x', eta') is dx'/dx + 2 Re of d eta'/d eta = [G0' + ... + Re(k* f)]/D1 + oscillating, so
Re(k* f) = -G0', exactly (shown by symbols in the tests). The rate of w |eta|^2, w = G0/M1, therefore has no mean term G0 G0' |eta|^2
+ G0 Re(k* f) |eta|^2, which is left out, and nothing like g Im eta^2 r Re eta^2 but Im eta^4: the products are written down by hand.

Equatorial spin-up (D2 = D3 of the body, cyclic triple (2, 3, 1), the wheel's transverse part along the form's axis 1): d2 = 0, q = s l1 is
constant, l2 = 0 and n3 = 0; every term of the rate of the amplitude that is left must fall faster than 1/x, and `tails` is infinite where one does not.
"""
from __future__ import annotations

from fractions import Fraction

import numpy as np

from .elimination import Algebra, corrected
from .fixed_centre import BLUR
from .form import signed_square
from .terms import Terms, gathered, packed, product, terms_of

CONDITION = 2.0**8  # rounding of p and q over themselves: 2^-44 at most, 2^-36 in the powers that occur

FIRST_ORDERS = {"energy": 4, "amplitude": 6}


class MovingCentre:
    """The form about the moving centre as the certificate wants it (see `FixedCentre` for its methods)."""

    name, sharp = "moving centre", False

    def __init__(self, D, wheel, torque, basis, s, axis=None, sense=1):
        """D, wheel, torque: Fractions in the frame of the form, M1 > 0. basis: its three axes in principal axes of the body, rows.
        axis, sense: of the body where the form's axis 1 is one of its axes."""
        (D1, D2, D3), (l1, l2, l3), (M1, M2, M3) = D, wheel, torque
        d2, d3 = D1 - D2, D1 - D3
        self._kept = {}
        self.basis, self.s, self.axis, self.sense = np.array(basis, float), s, axis, sense
        self.limits = (float(l2 / d2) if d2 else 0.0, float(l3 / d3))  # of w2*, w3* for great spins
        self.wheeled = any((l1, l2, l3))
        self.D1, self.M1, self.roots = float(D1), float(M1), (float(D2) ** 0.5, float(D3) ** 0.5)
        self.a2, self.a3, self.c = float(s * d2), float(s * d3), float(s * l1)
        self.wheel, self.torque = (float(l2), float(l3)), (float(M2), float(M3))
        self.n2, self.n3, eps = float(d3 * M2 - l1 * l3), float(d2 * M3 + l1 * l2), d3 - d2
        self.G0 = self._folded({(0, 0, 0, 0): float(M1), (0, 0, 0, 4): float(s * l2 * M2), (0, 0, 4, 0): float(s * l3 * M3),
                                (0, 0, 4, 4): float(-eps * M2 * M3)})
        root = lambda value, square: (lambda sign, squared: sign * float(squared) ** 0.5)(*signed_square(value, square))
        g = root(s * eps / 2, D2 * D3)
        k = {(3, 1): root(s * eps * M2, D2), (3, -3): root(-l3, D2), (-3, 3): 1j * root(s * l2, D3), (1, 3): 1j * root(-eps * M3, D3)}
        self.swing = self._folded({(2, 0, 0, 0): -0.5j * g, (0, 2, 0, 0): 0.5j * g})
        self.pull = self._folded({(1, 0, *key): 0.5 * c.conjugate() for key, c in k.items()} | {(0, 1, *key): 0.5 * c for key, c in k.items()})
        self.k = self._folded({(0, 0, *key): complex(c) for key, c in k.items()})
        self.r = self._folded({(0, 0, 4, 4): float(s * l1 * s * (d2 - d3) / 4)})
        self.f = self._folded({(0, 0, 1, 7): -root(d2 * M3 + l1 * l2, 1 / D2), (0, 0, 7, 1): 1j * s * root(d3 * M2 - l1 * l3, 1 / D3)})
        self.g = g
        rate = gathered(*map(terms_of, (self.G0, self.swing, self.pull))).times(1 / self.D1)
        carried = terms_of({(0, 1, a, b): c for (_, _, a, b), c in self.r.items()} | self.f)
        om = 1 / (self.roots[0] * self.roots[1])
        (((_, _, *turn), self.turn_size),) = self._folded({(0, 0, -2, -2): 1.0}).items()  # sqrt(p q): a constant q is part of the number
        self.algebra = Algebra(1j / (om * self.turn_size), tuple(turn), (-self.a3 / 4, -self.a2 / 4), rate, terms_of({}), carried,
                               (1, 1 if self.a2 else 0))

    @property
    def least_fall(self) -> float | None:
        """S: every factor that falls, a monomial of level 1 or more in p and q, falls at least like 1/(x + S), the slower of 1/p and 1/q; None where
        q is constant."""
        return max(self.c / self.a3, self.c / self.a2) if self.a2 else None

    def _folded(self, terms):
        """Terms without those that vanish; a constant q becomes part of their numbers."""
        if self.a2:
            return {key: c for key, c in terms.items() if c}
        out = {}
        for (j, k, a, b), c in terms.items():
            if c:
                out[j, k, a, 0] = out.get((j, k, a, 0), 0) + c * self.c ** (-b / 4)
        return out

    def energy(self, order, by=corrected):
        """D1 int sqrt(p q) dx, corrected; the drive sqrt(p q) G0 is left out of its rate. by: `corrected`, or what stands for it."""
        a, b = self.algebra.turn
        start = {(j, k, m + a, n + b): c * self.turn_size for (j, k, m, n), c in (self.swing | self.pull).items()}
        return self._corrected("energy", terms_of(start), order, by)

    def amplitude(self, order, by=corrected):
        """G0/M1 |eta|^2, corrected. D1 M1 times its rate is (D1 x' - G0) G0' |eta|^2 + 2 G0 [...], each bracket's products of oscillating
        factors written out, without the mean part."""
        G0, swing, pull, k, r, f = map(terms_of, (self.G0, self.swing, self.pull, self.k, self.r, self.f))
        k, f = (Terms(part.keys, part.c.conjugate(), part.m) for part in (k, f))
        twist = terms_of({(4, 0, 0, 0): -0.25j * self.g, (0, 4, 0, 0): 0.25j * self.g})  # g Im eta^2 Re eta^2 = (g/2) Im eta^4
        inner = [product(G0, _real(r, 2)), product(twist, r), product(pull, _real(r, 2)), product(G0, _real(f, 1)),
                 product(swing, _real(f, 1)), _real(product(k, f), 2).times(0.5)]
        slope = self.algebra.slope(G0)
        around = product(product(gathered(swing, pull), slope), terms_of({(1, 1, 0, 0): 1.0}))
        rate = gathered(product(G0.times(2.0), gathered(*inner)), around).times(1 / (self.M1 * self.D1))
        return self._corrected("amplitude", rate, order, by)

    def _corrected(self, name, rate, order, by):
        """`corrected`, by way of the order that is asked first and kept: a higher one goes on from there."""
        if order < FIRST_ORDERS[name]:
            return by(self.algebra, rate, order)
        if (name, by) not in self._kept:  # apart from what others made, so that an answer does not depend on what was asked before
            self._kept[name, by] = by(self.algebra, rate, FIRST_ORDERS[name])
        kept = self._kept[name, by]
        return kept if order == FIRST_ORDERS[name] else by(self.algebra, kept.rate, order, kept.added)

    def _pq(self, x):
        return self.a3 * x + self.c, self.a2 * x + self.c

    def transverse(self, A, z):
        """((low, high), (low, high)) of omega2 and omega3 of the form for x >= z, |eta| <= A: w* and rho are monotone in x."""
        p, q = self._pq(z)
        (l2, l3), (M2, M3), (r2, r3) = self.wheel, self.torque, self.roots
        first, last = (q / p) ** 0.25, (self.a2 / self.a3) ** 0.25
        u = A / (r2 * min(first, last)) if last else np.inf
        v = A * max(first, last) / r3
        ends = ((self.s * (l2 * z - M3) / q, self.limits[0] if self.a2 else self.s * (l2 * z - M3) / q), (self.s * (l3 * z + M2) / p, self.limits[1]))
        return tuple((min(end) - size, max(end) + size) for end, size in zip(ends, (u, v)))

    def place(self, states, near=0.0):
        """As of `FixedCentre`; nan where the form does not apply."""
        with np.errstate(all="ignore"):
            return self._place(states, near)

    def _place(self, states, near):
        w = states @ self.basis.T
        x, (p, q), (l2, l3), (M2, M3), (r2, r3) = w[:, 0], self._pq(w[:, 0]), self.wheel, self.torque, self.roots
        rho = np.sqrt(np.sqrt(q / p))
        u, v = w[:, 1] - self.s * (l2 * x - M3) / q, w[:, 2] - self.s * (l3 * x + M2) / p
        eta = r2 * rho * u + 1j * self.s * r3 / rho * v
        rounding, near = BLUR * CONDITION, near + BLUR * np.abs(states).sum(axis=1)
        moved2 = rounding * (np.abs(states).sum(axis=1) + (abs(l2 * x) + abs(M3)) / q) + near * (1 + abs(self.n3) / q**2)
        moved3 = rounding * (np.abs(states).sum(axis=1) + (abs(l3 * x) + abs(M2)) / p) + near * (1 + abs(self.n2) / p**2)
        turned = near * abs(self.c * (self.a2 - self.a3)) / (4 * p * q)
        dz = 1.25 * (r2 * rho * moved2 + r3 / rho * moved3 + (turned + rounding) * np.abs(eta))
        near_enough = near * np.maximum(self.a3 / p, self.a2 / q) < 1 / 64
        return x, eta, np.where(near_enough, near, np.inf), dz

    def turning(self, x):
        p, q = self._pq(x)
        return np.sqrt(p * q)

    def drive(self, z):
        low = high = self.M1
        for (_, _, a, b), c in self.G0.items():
            if a or b:
                p, q = self._pq(z)
                value = c * p ** (-a / 4) * q ** (-b / 4)
                low, high = low + np.minimum(value, 0), high + np.maximum(value, 0)
        return low, high

    def most_weight(self, x, dx):
        """A bound of G0/M1 within dx of x, rounding included: each of its terms moves by its steepness at most."""
        total = 0.0
        for (_, _, a, b), c in self.G0.items():
            a, b = np.array([a]), np.array([b])
            least = np.maximum(x - dx, np.finfo(float).tiny)
            total = total + c * self.factors(a, b, x)[:, 0]
            total = total + abs(c) * self.factors(a, b, least)[:, 0] * (self.steepness(a, b, least)[:, 0] * dx + BLUR * CONDITION)
        return total / self.M1

    def least_weight(self, z):
        return self.drive(z)[0] / self.M1

    def factors(self, a, b, x):
        p, q = self._pq(x[:, None])
        return p ** (-a / 4) * q ** (-b / 4)

    def _ratios(self, p, q):
        """Greatest q/p and p/q from here on: each is monotone."""
        return np.maximum(q / p, self.a2 / self.a3), np.maximum(p / q, self.a3 / self.a2 if self.a2 else np.inf)

    def greatest(self, a, b, z):
        """A decreasing bound of the factors from z on: of mixed signs, a power of the ratio splits off."""
        p, q = self._pq(z[:, None])
        if not self.a2:
            return np.where(a >= 0, p ** (-a / 4), np.inf)
        up, down = self._ratios(p, q)
        plain = p ** (-a / 4) * q ** (-b / 4)
        by_p = np.where(a + b >= 0, up ** (np.maximum(-b, 0) / 4) * p ** (-(a + b) / 4), np.inf)
        by_q = np.where(a + b >= 0, down ** (np.maximum(-a, 0) / 4) * q ** (-(a + b) / 4), np.inf)
        return np.where((a >= 0) & (b >= 0), plain, np.where(b < 0, by_p, by_q))

    def steepness(self, a, b, x):
        p, q = self._pq(x[:, None])
        return (np.abs(a) * self.a3 / p + np.abs(b) * self.a2 / q) / 4

    def tails(self, a, b, z):
        """The least of four bounds: of factors that both fall, one stays at its value at z; or a power of the ratio splits off."""
        p, q = self._pq(z[:, None])
        n, never = (a + b) / 4, np.inf
        best = np.where((a > 4) & (b >= 0), q ** (-b / 4) * p ** (1 - a / 4) / (self.a3 * (a / 4 - 1)), never)
        if not self.a2:
            return best
        up, down = self._ratios(p, q)
        best = np.minimum(best, np.where((b > 4) & (a >= 0), p ** (-a / 4) * q ** (1 - b / 4) / (self.a2 * (b / 4 - 1)), never))
        split_p = np.where(b > 0, down ** (np.maximum(b, 0) / 4), up ** (np.maximum(-b, 0) / 4)) * p ** (1 - n) / (self.a3 * (n - 1))
        split_q = np.where(a > 0, up ** (np.maximum(a, 0) / 4), down ** (np.maximum(-a, 0) / 4)) * q ** (1 - n) / (self.a2 * (n - 1))
        return np.where(n > 1, np.minimum(best, np.minimum(split_p, split_q)), best)

    def valid(self, x):
        """Where p and q are positive, well formed, and x is."""
        p, q = self._pq(x)
        well = (p * CONDITION > self.a3 * np.abs(x) + abs(self.c)) & (q * CONDITION > self.a2 * np.abs(x) + abs(self.c))
        return (p > 0) & (q > 0) & well & (x > 0)


def _real(terms: Terms, n: int) -> Terms:
    """Re(terms eta^n) of terms without eta."""
    _, _, a, b = terms.powers
    return gathered(Terms(packed(n, 0, a, b), terms.c / 2, terms.m / 2), Terms(packed(0, n, a, b), terms.c.conjugate() / 2, terms.m / 2))


def moving_centre(form, scene) -> MovingCentre | None:
    """The moving centre about the axis of a normal form of a scene in physical variables; None for scaled ones."""
    if scene.variables == "scaled":
        return None
    vectors = [tuple(Fraction(t) * v[n] for t, n in zip(form.turn, form.order)) for v in (scene.vector("gyrostat"), scene.vector("constant_torque"))]
    D = tuple(scene.body.exact[n] for n in form.order)
    basis = [[t * (n == m) for m in range(3)] for t, n in zip(form.turn, form.order)]
    return MovingCentre(D, *vectors, basis, 1 if D[0] > D[1] else -1, form.axis, form.sense)  # type: ignore[call-arg]
