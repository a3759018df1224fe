"""The forms in which spin-up is certified, about the fixed centre and about a moving one, and the
elimination of what oscillates there.

The forms are about the fixed centre, and about a moving one for nearly equal
moments with a wheel and for spin-up in the equator of a symmetric body.

In every such field x is the spin that grows and D1 x' = drive + what oscillates.

Fixed centre. x is the X of `form`, p = X, q = 1, zeta' = i om X zeta + i h zeta* + mu and D1 X' = G = M1 +
gam Im zeta^2 + Re(kap* zeta). The energy D1 X^2/2 has the rate X G = M1 X + m* + what is left. Order 0 is the
classical D1 X^2/2 + (gam/2om) Re zeta^2 - Im(kap* zeta)/om - Im(nu zeta)/(om^2 X): what is taken at X^1 is
all of X (G - M1), at X^0 what h and mu make of it, Re(nu zeta)/om, and m* = -Im(kap* mu)/om stays exactly. It
is formed exactly in `form.drag` and left out of the rate with M1 X: the drive.

The amplitude |zeta|^2 (1 + m*/(M1 X)) starts from |zeta|^2 + R/(om X), R = h Re zeta^2 - 2 Im(mu* zeta),
which takes out of (|zeta|^2)' = 2 h Im zeta^2 + 2 Re(mu* zeta) all there is at X^0. The price at X^-1 is
[along i h zeta* + mu] of R, and that vanishes identically: h Re zeta^2 gives 2 h Re(mu zeta), and -2 Im(mu*
zeta) gives -2 h Re(mu zeta). So the rate is -X' R/(om X^2), written down so, with no term at X^-1 at all, and
every term left falls as X^-2 or faster. The weight (which does not stand among the added terms) adds (m*/M1)
(|zeta|^2/X)', whose mean part -m* |zeta|^2/(D1 X^2) cancels that of -X' R/(om X^2) up to rounding (which the
sums hold): the flow keeps volume, so its mean does.

Moving centre. Axis 1, frame and names as in `form`; d2, d3 need not share a sign where one vanishes. With P =
d3 x + l1, Q = d2 x + l1 (x = omega1), p = s P > 0 and q = s Q > 0, the transverse rates oscillate about w2* =
(l2 x - M3)/Q, w3* = (l3 x + M2)/P, where omega2' and omega3' would vanish. Put rho = (q/p)^(1/4), u = omega2
- w2*, v = omega3 - w3*, eta = sqrt(D2) rho u + i s sqrt(D3) v/rho. From D2 u' = -P v - D2 x' dw2*/dx and D3
v' = Q u - D3 x' dw3*/dx, with dw2*/dx = n3/Q^2, n3 = d2 M3 + l1 l2, dw3*/dx = -n2/P^2, n2 = d3 M2 - l1 l3,
exactly

    eta' = i Om eta + x' (r eta* + f),   D1 x' = G0 + g Im eta^2 + Re(k* eta),   Om = sqrt(p q/(D2 D3)),
    r = rho'/rho = s l1 (a2 - a3)/(4 p q),   f = -sqrt(D2) rho n3/q^2 + i s sqrt(D3) n2/(rho p^2),   g = s
    eps/(2 sqrt(D2 D3)),  eps = d3 - d2,
    k = (eps M2 - l3 Q)/(P sqrt(D2) rho) + i s rho (l2 P - eps M3)/(Q sqrt(D3)),   G0 = M1 + l2 M2/Q + l3 M3/P
    - eps M2 M3/(P Q).

(U V of the mean motion gives G0: eps w2* w3* + l2 w3* - l3 w2*, and eps x + Q = P.) All coefficients are sums
of monomials p^(-a/4) q^(-b/4).

Mean drift. The flow keeps volume: the divergence of (x', eta') is dx'/dx + 2 Re of d eta'/d eta = [G0' + ...
+ Re(k* f)]/D1 + oscillating, so Re(k* f) = -G0', exactly (shown by symbols in the tests). The rate of w
|eta|^2, w = G0/M1, therefore has no mean term G0 G0' |eta|^2 + G0 Re(k* f) |eta|^2, which is left out, and
nothing like g Im eta^2 r Re eta^2 but Im eta^4: the products are written down by hand.

Equatorial spin-up (D2 = D3 of the body, cyclic triple (2, 3, 1), the wheel's transverse part along the form's
axis 1): d2 = 0, q = s l1 is constant, l2 = 0 and n3 = 0; every term of the rate of the amplitude that is left
must fall faster than 1/x, and its integral is infinite where one does not (`kernel.tail`)."""
from __future__ import annotations

from functools import cached_property

import numpy as np

from ...numbers.ratio import ratios
from .elimination import Algebra, Elimination, Terms, conjugate, half, product, terms_of, times, total
from .form import NormalForm, over_root


# --- The fixed and the moving centre
class FixedCentre:
    """The normal form about its fixed centre: p = X, q = 1, and all powers are whole."""

    name, sharp, parts = "fixed centre", True, 1
    a2, a3, offsets, turn_size, least_fall = 0.0, 1.0, (1.0, 0.0), 1.0, 0.0

    def __init__(self, form: NormalForm):
        self.form = f = form
        self.D1, self.M1, self.axis, self.sense = f.D1, f.M1, f.axis, f.sense
        self.basis = np.zeros((3, 3))
        self.basis[range(3), f.order] = f.turn
        self.frame = (f.shift, *f.centre, *f.scale)
        self.G0 = {(0, 0, 0, 0): f.M1, (0, 0, 4, 0): f.drag}
        self.swing = _present({(2, 0, 0, 0): -0.5j * f.gam, (0, 2, 0, 0): 0.5j * f.gam,
                               (1, 0, 0, 0): 0.5 * f.kap.conjugate(), (0, 1, 0, 0): 0.5 * f.kap})
        x_rate = times(terms_of({(0, 0, 0, 0): f.M1} | self.swing), 1 / f.D1)
        drift = terms_of(_present({(0, 1, 0, 0): 1j * f.h, (0, 0, 0, 0): f.mu}))
        self.algebra = Algebra(1 / f.om, (-4, 0), (-0.25, 0.0), x_rate, {}, drift, 4, False)

    @cached_property
    def energy(self) -> Elimination:
        """D1 X^2/2, corrected; the drive M1 X + m* is left out of its rate."""
        return Elimination(self.algebra, times(terms_of(self.swing), 1, (0, 0, -4, 0)), drive=(0, 0, 0, 0),
                           over=(-4, 0, self.turn_size))

    @cached_property
    def amplitude(self) -> Elimination:
        """(1 + m*/(M1 X)) |zeta|^2, corrected from |zeta|^2 + R/(om X) on."""
        f, (x_rate, drift) = self.form, (self.algebra.x_rate, self.algebra.drift)
        first = terms_of(_present({(2, 0, 4, 0): 0.5 * f.h / f.om, (0, 2, 4, 0): 0.5 * f.h / f.om,
                                   (1, 0, 4, 0): 1j * f.mu.conjugate() / f.om,
                                   (0, 1, 4, 0): -1j * f.mu / f.om}))
        weight = f.drag / f.M1
        rate = [times(product(first, x_rate), -1, (0, 0, 4, 0))]
        if weight:
            turned = times(drift, weight, (0, 1, 4, 0))
            rate += [turned, conjugate(turned), times(x_rate, -weight, (1, 1, 8, 0))]
        return Elimination(self.algebra, total(*rate), first)

    def transverse(self, A: float, z: float):
        """((low, high), (low, high)) of omega2 and omega3 of the form while |zeta| <= A."""
        return tuple((c - A / abs(scale), c + A / abs(scale)) for c,
                     scale in zip(self.form.centre, self.form.scale))


def _present(table: dict) -> dict:
    """The terms that do not vanish."""
    return {key: c for key, c in table.items() if c}


class MovingCentre:
    """The form about the moving centre."""

    name, sharp, parts = "moving centre", False, 4

    def __init__(self, D, wheel, torque, basis, s, axis=None, sense=1):
        """D, wheel, torque: exact numbers in the frame of the form, M1 > 0. basis: its three axes in
        principal axes of the body, rows. axis, sense: of the body where the form's axis 1 is one of its
        axes."""
        (D1, D2, D3), (l1, l2, l3), (M1, M2, M3) = D, wheel, torque
        d2, d3 = D1 - D2, D1 - D3
        self.basis, self.s, self.axis, self.sense = np.array(basis, float), s, axis, sense
        self.limits = (float(l2 / d2) if d2 else 0.0, float(l3 / d3))  # of w2*, w3* for great spins
        self.wheeled = any((l1, l2, l3))
        self.D1, self.M1, self.roots = float(D1), float(M1), (float(D2) ** 0.5, float(D3) ** 0.5)
        self.a2, self.a3, self.c = float(s * d2), float(s * d3), float(s * l1)
        self.wheel, self.torque = (float(l2), float(l3)), (float(M2), float(M3))
        self.offsets, eps = (self.c, self.c), d3 - d2
        self.frame = (s, *self.wheel, *self.torque, *self.roots, float(d3 * M2 - l1 * l3),
                      float(d2 * M3 + l1 * l2))
        self.G0 = self._folded({(0, 0, 0, 0): float(M1), (0, 0, 0, 4): float(s * l2 * M2),
                                (0, 0, 4, 0): float(s * l3 * M3),
                                (0, 0, 4, 4): float(-eps * M2 * M3)})
        g = over_root(s * eps / 2, D2 * D3)
        k = {(3, 1): over_root(s * eps * M2, D2), (3, -3): over_root(-l3, D2),
             (-3, 3): 1j * over_root(s * l2, D3), (1, 3): 1j * over_root(-eps * M3, D3)}
        self.swing = self._folded({(2, 0, 0, 0): -0.5j * g, (0, 2, 0, 0): 0.5j * g})
        self.pull = self._folded({(1, 0, *key): 0.5 * c.conjugate() for key, c in k.items()}
                                 | {(0, 1, *key): 0.5 * c for key, c in k.items()})
        self.k = self._folded({(0, 0, *key): complex(c) for key, c in k.items()})
        self.r = self._folded({(0, 0, 4, 4): float(s * l1 * s * (d2 - d3) / 4)})
        self.f = self._folded({(0, 0, 1, 7): -over_root(d2 * M3 + l1 * l2, 1 / D2),
                               (0, 0, 7, 1): 1j * s * over_root(d3 * M2 - l1 * l3, 1 / D3)})
        self.g = g
        rate = times(total(*map(terms_of, (self.G0, self.swing, self.pull))), 1 / self.D1)
        carried = terms_of({(0, 1, a, b): c for (_, _, a, b), c in self.r.items()} | self.f)
        om = 1 / (self.roots[0] * self.roots[1])
        # sqrt(p q): a constant q is part of the number
        (((_, _, *turn), self.turn_size),) = self._folded({(0, 0, -2, -2): 1.0}).items()
        # a constant q counts nothing in the level, which then goes in quarters
        self.algebra = Algebra(1 / (om * self.turn_size), tuple(turn), (-self.a3 / 4, -self.a2 / 4), rate,
                               carried, {}, 4 if self.a2 else 1, bool(self.a2))

    @property
    def least_fall(self) -> float | None:
        """S: every factor that falls, a monomial of level 1 or more in p and q, falls at least like 1/(x +
        S), the slower of 1/p and 1/q; None where q is constant."""
        return max(self.c / self.a3, self.c / self.a2) if self.a2 else None

    def _folded(self, terms):
        """Terms without those that vanish; a constant q becomes part of their numbers."""
        if self.a2:
            return _present(terms)
        out = {}
        for (j, k, a, b), c in terms.items():
            if c:
                out[j, k, a, 0] = out.get((j, k, a, 0), 0) + c * self.c ** (-b / 4)
        return out

    @cached_property
    def energy(self) -> Elimination:
        """D1 int sqrt(p q) dx, corrected; the drive sqrt(p q) G0 is left out of its rate."""
        a, b = self.algebra.turn
        start = times(terms_of(self.swing | self.pull), self.turn_size, (0, 0, a, b))
        return Elimination(self.algebra, start, over=(a, b, self.turn_size))

    @cached_property
    def amplitude(self) -> Elimination:
        """G0/M1 |eta|^2, corrected. D1 M1 times the rate, of which half is worked out, is (D1 x' - G0) G0'
        |eta|^2 + 2 G0 [...], each bracket's products of oscillating factors written out, without the mean
        part."""
        G0, swing, pull, k, r, f = map(terms_of, (self.G0, self.swing, self.pull, self.k, self.r, self.f))
        k, f = ({key: (c.conjugate(), m) for key, (c, m) in part.items()} for part in (k, f))
        # g Im eta^2 Re eta^2 = (g/2) Im eta^4
        twist = terms_of({(4, 0, 0, 0): -0.25j * self.g, (0, 4, 0, 0): 0.25j * self.g})
        inner = [product(total(G0, pull), _real(r, 2)), product(twist, r),
                 product(total(G0, swing), _real(f, 1)), times(_real(product(k, f), 2), 0.5)]
        around = times(product(half(total(swing, pull)), self.algebra.slope(G0)), 1, (1, 1, 0, 0))
        rate = total(product(times(G0, 2), half(total(*inner))), around)
        return Elimination(self.algebra, times(rate, 1 / (self.M1 * self.D1)))

    def transverse(self, A, z):
        """((low, high), (low, high)) of omega2 and omega3 of the form for x >= z, |eta| <= A: w* and rho are
        monotone in x."""
        p, q = self.a3 * z + self.c, self.a2 * z + self.c
        (l2, l3), (M2, M3), (r2, r3) = self.wheel, self.torque, self.roots
        first, last = (q / p) ** 0.25, (self.a2 / self.a3) ** 0.25
        u = A / (r2 * min(first, last)) if last else np.inf
        v = A * max(first, last) / r3
        ends = ((self.s * (l2 * z - M3) / q, self.limits[0] if self.a2 else self.s * (l2 * z - M3) / q),
                (self.s * (l3 * z + M2) / p, self.limits[1]))
        return tuple((min(end) - size, max(end) + size) for end, size in zip(ends, (u, v)))


def _real(terms: Terms, n: int) -> Terms:
    """Re(terms eta^n) of terms without eta."""
    part = times(terms, 0.5, (n, 0, 0, 0))
    return total(part, conjugate(part))


def moving_centre(form, scene) -> MovingCentre | None:
    """The moving centre about the axis of a normal form of a scene in physical variables; None for scaled
    ones."""
    if scene.variables == "scaled":
        return None
    vectors = [tuple(t * v[n] for t, n in zip(form.turn, form.order))
               for v in map(ratios, (scene.vector("gyrostat"), scene.vector("constant_torque")))]
    exact = scene.body.exact
    D = tuple(ratios(exact)[n] for n in form.order)
    basis = [[t * (n == m) for m in range(3)] for t, n in zip(form.turn, form.order)]
    s = 1 if exact[form.axis] > exact[form.order[1]] else -1
    return MovingCentre(D, *vectors, basis, s,  # type: ignore[call-arg]
                        form.axis, form.sense)
