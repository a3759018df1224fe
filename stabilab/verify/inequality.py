"""The inequality of spin-up, about a fixed and about a moving centre: true at one time, it is true for ever
(proof: docs/mathematics/spin-up.md).

About a fixed centre. In the normal form (`normal_form`), let M > 0. Energy and amplitude are corrected by
terms c zeta^j zeta*^k X^-n: adding -c/(i om (j - k)) zeta^j zeta*^k X^-(n+1) takes an oscillating term (j !=
k) of degree n out of a rate, at the price of what the rest of d/dt makes of the added term. One after
another, lowest degree first, up to a degree:

    Y = X^2/2 + (added),                     Y' = M X + m + (left),      m constant, what is left of degree 0
    and more;
    B = |zeta|^2 (1 + m/(M X)) + (added),    B' = (left),                all of degree 2 and more.

Let e, k, b be the sums of |c| A^(j+k) z^-n over Y's added, Y's left and B's added terms, and r that of |c|
A^(j+k) z^(1-n)/(n - 1) over what is left of B'. If

    X > z, |zeta| < A,    Y > z^2/2 + e,    eta = M - (max(0, -m) + k)/z > 0,    [B + b + r/eta]/(1 + min(0,
    m)/(M z)) < A^2

at one time, then for ever, and X grows at least at the rate eta: while it holds Y' > 0, and y = sqrt(2 (Y -
e)) <= X has y y' = Y' >= M y - max(0, -m) - k.

About a moving centre. In the form of `moving_form` let M > 0, z such that P, Q > 0 from z on, and Om = sqrt(P
Q), which rises and is concave there, as P and Q do not fall and are linear. By adding -c/(i (j - k)) zeta^j
zeta*^k P^-(a+2)/4 Q^-(b+2)/4 an oscillating term (j != k) is taken out of a rate, at the price of x' times
what d/dx and r zeta* + f make of the added term; one after another, those that fall slowest first:

    Y = int Om dx + (added),           Y' = Om G + (left);         B = (G/M) |zeta|^2 + (added),    B' =
    (left).

M times the rate of (G/M) |zeta|^2, with x' = G + g Im zeta^2 + Re(k* zeta) and without the mean part, which
vanishes (`moving_form`), is

    (x' - G) G' |zeta|^2 + 2 G [x' r Re zeta^2 + (G + g Im zeta^2) Re(f* zeta) + Re(k* f* zeta^2)/2],

where g Im zeta^2 r Re zeta^2 = (g r/2) Im zeta^4 is written so. The factor P^(-a/4) Q^(-b/4) of a term is at
most its greatest value from z on, and there is a falling majorant with an integral from z on: both from P, Q
and the quotient, which is monotone. With e, k, b, r of these factors, Y's left over Om, and G_ <= G from z
on, what is tried at one time is

    x > z,  |zeta| < A,  (x - z) (Om(x) + Om(z))/2 + (Y's added) > e,  eta = G_ - k > 0,  [B + b + r/eta] M/G_
    < A^2.
"""
from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from operator import add
from typing import TYPE_CHECKING, Any

from flint import acb, arb

from .normal_form import MovingForm
from .numbers import ball

if TYPE_CHECKING:
    from fractions import Fraction

MOST_ORDER = 18
MOST_TERMS = 20_000


class Unsuited(Exception):
    """The form or the orders have no such inequality: why."""


@dataclass(frozen=True)
class Ledger:
    """Terms {(j, k, n): acb} added to a quantity and left of its rate."""

    added: dict
    left: dict


def _corrected(rate, added, largest, degree, over_turning, price) -> Ledger:
    """The oscillating terms taken out of a rate by terms added to those of a quantity, lowest degree first up
    to the most; over_turning: of terms over the rate at which zeta turns; price: what else the added terms
    bring."""
    while True:
        degrees = [degree(key) for key in rate if key[0] != key[1]]
        if not degrees or (lowest := min(degrees)) > largest:
            return Ledger(added, rate)
        moving = [key for key in rate if key[0] != key[1] and degree(key) == lowest]
        now = over_turning({key: -rate.pop(key) / (_i() * (key[0] - key[1])) for key in moving})
        added, rate = total(added, now), total(rate, price(now))
        if len(rate) > MOST_TERMS:
            raise Unsuited("more terms than are worked out here")


class Inequality:
    """The inequality of a form at two orders, that of Y and that of B."""

    def __init__(self, form, orders):
        if not form.M > 0:
            raise Unsuited("the torque's component does not have the direction of the spin")
        if not (0 <= orders[0] <= MOST_ORDER and 1 <= orders[1] <= MOST_ORDER):
            raise Unsuited(f"orders up to {MOST_ORDER} are worked out here")
        self.form, self.M = form, ball(form.M)
        self.spin_rate = _spin_rate(form)
        energy = self._corrected(product({(0, 0, -1): 1},
                                         {key: c for key, c in self.spin_rate.items() if key[0] + key[1]}),
                                 orders[0], {})
        self.m = energy.left.pop((0, 0, 0), ball(0) * 0)
        self.m = getattr(self.m, "real", self.m)
        self.energy = energy
        i, half = _i(), ball(1) / 2
        R = {(2, 0, 1): form.h * half / form.om + 0 * i, (0, 2, 1): form.h * half / form.om + 0 * i,
             (1, 0, 1): i * conjugate(form.mu) / form.om, (0, 1, 1): -i * form.mu / form.om}
        # the rate of |zeta|^2 + R is -X' R/X exactly: what h and mu make of R at degree 1 vanishes
        rate = {(j, k, n + 1): -c for (j, k, n), c in product(R, self.spin_rate).items()}
        weight = {(1, 1, 1): self.m / self.M + 0 * i}
        if min((n for _, _, n in (*energy.left, *energy.added)), default=0) < 0:
            raise Unsuited("a term of the energy grows with the spin")
        self.amplitude = self._corrected(total(rate, self._price(weight)), orders[1], R)
        if min((n for _, _, n in self.amplitude.left), default=2) < 2:
            raise Unsuited("a term of the amplitude's rate does not fall fast enough")

    def _corrected(self, rate: Mapping[tuple[int, ...], acb], order: int,
                   added: Mapping[tuple[int, ...], acb]):
        return _corrected(rate, added, order, lambda key: key[2], self._over_turning, self._price)

    def _over_turning(self, terms):
        return {(j, k, n + 1): c / self.form.om for (j, k, n), c in terms.items()}

    def _price(self, terms):
        """What the rates make of terms, apart from the turning."""
        i, form, out = _i(), self.form, {}
        for (j, k, n), c in terms.items():
            for to, value in (((j - 1, k + 1, n), j * c * i * form.h), ((j - 1, k, n), j * c * form.mu),
                              ((j + 1, k - 1, n), -k * c * i * form.h),
                              ((j, k - 1, n), k * c * conjugate(form.mu))):
                if min(to[:2]) >= 0:
                    out[to] = out[to] + value if to in out else value
        steeper = {(j, k, n + 1): -n * c for (j, k, n), c in terms.items() if n}
        return total(out, product(steeper, self.spin_rate))

    def faults(self, state: Sequence[arb], A: Fraction, z: Fraction):
        """(what does not hold, in words, and whether it surely does not; eta as a ball) for the state (balls)
        and the exact numbers A, z; nothing where all holds."""
        X, zeta = self.form.place(state)
        A, z, size = ball(A), ball(z), abs(zeta)
        faults = [compared(X, z, "X > z"), compared(A, size, "|zeta| < A")]
        e, k = _bound(self.energy.added, A, z), _bound(self.energy.left, A, z)
        m = self.m
        eta = self.M - ((-m).max(ball(0)) + k) / z
        energy = X * X / 2 + _value(self.energy.added, X, zeta)
        faults += [compared(energy, z * z / 2 + e, "the energy is high enough"),
                   compared(eta, ball(0), "the spin grows")]
        low = 1 + m.min(ball(0)) / (self.M * z)
        faults.append(compared(low, ball(0), "the weight is positive"))
        if eta > 0 and low > 0:
            r = sum((abs(c) * A**(j + k) * z**(1 - n) / (n - 1)
                     for (j, k, n), c in self.amplitude.left.items()), ball(0))
            start = size * size * (1 + m / (self.M * X)) + _value(self.amplitude.added, X, zeta)
            faults.append(compared(A * A, (start + _bound(self.amplitude.added, A, z) + r / eta) / low,
                                   "the amplitude stays below A"))
        return [fault for fault in faults if fault], eta


def compared(greater, less, text: str):
    """None where it holds; (words, whether it surely does not) else."""
    return None if greater > less else (text, bool(greater <= less))


def _i():
    return acb(0, 1)


def conjugate(c: acb):
    """c*."""
    return acb(c.real, -c.imag)


def _spin_rate(form):
    """X' as terms."""
    half, i = ball(1) / 2, _i()
    return {(0, 0, 0): acb(ball(form.M)), (2, 0, 0): -i * form.g * half, (0, 2, 0): i * form.g * half,
            (1, 0, 0): conjugate(form.kap) * half,
            (0, 1, 0): form.kap * half}


def total(*tables):
    """The sum of tables of terms."""
    out: dict = {}
    for table in tables:
        for key, c in table.items():
            out[key] = out[key] + c if key in out else c
    return out


def product(item: Mapping[tuple[int, ...], Any], other: Mapping[tuple[int, ...], acb]):
    """The product of two tables of terms, keys of any length added up."""
    out: dict = {}
    for here, c in item.items():
        for there, d in other.items():
            key = tuple(map(add, here, there))
            out[key] = out[key] + c * d if key in out else c * d
    return {key: c for key, c in out.items() if not c.is_zero()}


def _bound(terms, A, z):
    """Sum of |c| A^(j+k) z^-n."""
    return sum((abs(c) * A**(j + k) / z**n for (j, k, n), c in terms.items()), ball(0))


def _value(terms: Mapping[tuple[int, ...], acb], X: arb, zeta: acb):
    """The value of terms, which is real."""
    star = conjugate(zeta)
    return sum((c * zeta**j * star**k / X**n for (j, k, n), c in terms.items()), _i() * 0).real


MOST_MOVING_ORDER = 10


class MovingInequality:
    """The inequality of a form at two orders, that of Y and that of B."""

    def __init__(self, form: MovingForm, orders):
        if not form.M > 0:
            raise Unsuited("the torque's component does not have the direction of the spin")
        if not max(orders) <= MOST_MOVING_ORDER:
            raise Unsuited(f"about the moving centre orders up to {MOST_MOVING_ORDER} are worked out")
        self.form = form
        self.alike = form.quotient is not None
        # Q is then no variable of its own
        self.root = (form.quotient.root(4) if self.alike else form.Q[1].root(4) if form.Q[0].is_zero()
                     else None)
        k, self.f = self._folded(form.k), self._folded(form.f)
        i, star = _i(), {key: conjugate(c) for key, c in k.items()}
        self.G = {(0, 0, *key): c for key, c in self._folded(form.G).items()}
        swing = {(2, 0, 0, 0): -i * form.g / 2, (0, 2, 0, 0): i * form.g / 2}
        beat = ({(1, 0, *key): c / 2 for key, c in star.items()}
                | {(0, 1, *key): c / 2 for key, c in k.items()})
        self.swing = total(swing, beat)  # x' - G
        self.spin_rate = total(self.G, self.swing)
        self.r = {} if form.r.is_zero() else self._folded({(4, 4): form.r + 0 * i})
        self.energy = self._corrected(self._over_turning(self.swing, -1), orders[0])
        self.amplitude = self._corrected(self._drift(star, swing, beat), orders[1])
        self.energy_added, self.amplitude_added = map(_Sizes, (self.energy.added, self.amplitude.added))
        self.energy_left = _Sizes(self._over_turning(self.energy.left))
        self.amplitude_left = _Sizes(self.amplitude.left)

    def _folded(self, terms: Mapping[tuple[int, int], acb]):
        """Terms {(a, b): c}; where Q is constant, or a multiple of P, its powers become part of the others.
        """
        return (terms if self.root is None
                else total(*({self._place(a, b): c * self.root**-b} for (a, b), c in terms.items())))

    def _place(self, a: float, b: float):
        return (a + b if self.alike else a, 0) if self.root is not None else (a, b)

    def _over_turning(self, terms: Mapping[tuple[int, ...], acb], power: int = 1):
        """Terms over a power of sqrt(P Q)."""
        m, n = self._place(2 * power, 2 * power)
        factor = 1 if self.root is None else self.root ** (-2 * power)
        return {(j, k, a + m, b + n): c * factor for (j, k, a, b), c in terms.items()}

    def _drift(self, star, swing, beat):
        """The rate of (G/M) |zeta|^2 without its mean part."""
        form, i = self.form, _i()
        real = lambda terms, n: total({(n, 0, *key[2:]): c / 2 for key, c in terms.items()},
                                      {(0, n, *key[2:]): conjugate(c) / 2 for key, c in terms.items()})
        f = {(0, 0, *key): conjugate(c) for key, c in self.f.items()}
        r = {(0, 0, *key): c for key, c in self.r.items()}
        turn, twice = real(r, 2), product({(4, 0, 0, 0): -i * form.g / 4, (0, 4, 0, 0): i * form.g / 4}, r)
        inner = total(product(total(self.G, beat), turn), twice, product(total(self.G, swing), real(f, 1)),
                      real({key: c / 2
                          for key, c in product({(0, 0, *key): c for key, c in star.items()}, f).items()}, 2))
        steeper = {(j + 1, k + 1, a, b): c for (j, k, a, b), c in self._slope(self.G).items()}
        rate = total(product(self.swing, steeper), product({key: 2 * c for key, c in self.G.items()}, inner))
        return {key: c / form.M for key, c in rate.items()}

    def _slope(self, terms: Mapping[tuple[int, ...], acb]):
        """d/dx of terms."""
        (p, _), (q, _) = self.form.P, self.form.Q
        parts = [{(j, k, a + 4, b): -a * c * p / 4 for (j, k, a, b), c in terms.items() if a}]
        if self.root is None:
            parts.append({(j, k, a, b + 4): -b * c * q / 4 for (j, k, a, b), c in terms.items() if b})
        return total(*parts)

    def _price(self, terms: Mapping[tuple[int, ...], acb]):
        """What x' makes of terms, by d/dx and along r zeta* + f."""
        parts = [self._slope(terms)]
        for (m, n), c in self.f.items():
            parts.append({(j - 1, k, a + m, b + n): j * v * c for (j, k, a, b), v in terms.items() if j})
            parts.append({(j, k - 1, a + m, b + n): k * v * conjugate(c)
                          for (j, k, a, b), v in terms.items() if k})
        for (m, n), c in self.r.items():
            parts.append({(j - 1, k + 1, a + m, b + n): j * v * c for (j, k, a, b), v in terms.items() if j})
            parts.append({(j + 1, k - 1, a + m, b + n): k * v * c for (j, k, a, b), v in terms.items() if k})
        return product(total(*parts), self.spin_rate)

    def _corrected(self, rate: Mapping[tuple[int, ...], acb], order: int) -> Ledger:
        return _corrected(rate, {}, 4 * order, lambda key: key[2] + key[3], self._over_turning, self._price)

    def faults(self, state: Sequence[arb], A: Fraction, z: Fraction):
        """As of `inequality.Inequality.faults`."""
        form = self.form
        x, zeta = form.place(state)
        A, z, size = ball(A), ball(z), abs(zeta)
        from_z = _Factors(form, z)
        faults = [compared(v, ball(0), "the form applies") for v in (*from_z.ends, *form.at(x))]
        if any(faults):
            return [fault for fault in faults if fault], ball(0)
        faults = [compared(x, z, "x > z"), compared(A, size, "|zeta| < A")]
        e, k, b = (sizes.bound(A, from_z)
                   for sizes in (self.energy_added, self.energy_left, self.amplitude_added))
        smallest = (form.M + sum((c.real.min(ball(0)) * from_z.greatest(a, b)
                               for (_, _, a, b), c in self.G.items() if a or b), ball(0)))
        eta = smallest - k
        mean = (x - z) * (_turning(form, x) + from_z.turning) / 2
        faults += [compared(mean + self._value(self.energy.added, x, zeta), e, "the energy is high enough"),
                   compared(eta, ball(0), "the spin grows")]
        if eta > 0 and smallest > 0:
            r = self.amplitude_left.bound(A, from_z, tails=True)
            weight = self._value(self.G, x, zeta) / form.M
            start = weight * size * size + self._value(self.amplitude.added, x, zeta)
            faults.append(compared(A * A, (start + b + r / eta) * form.M / smallest,
                                   "the amplitude stays below A"))
        return [fault for fault in faults if fault], eta

    def _value(self, terms: Mapping[tuple[int, ...], acb], x: arb, zeta: acb):
        """The value of terms, which is real."""
        star, factors, out = conjugate(zeta), _Factors(self.form, x), _i() * 0
        here = defaultdict(lambda: _i() * 0)
        for (j, k, a, b), c in terms.items():
            here[j, k] += c * factors.at(a, b)
        for (j, k), c in here.items():
            out += c * zeta**j * star**k
        return out.real


class _Sizes:
    """Sums of |c| by degree and exponents."""

    def __init__(self, terms: Mapping[tuple[int, ...], acb]):
        self.rows = defaultdict(lambda: ball(0))
        for (j, k, a, b), c in terms.items():
            self.rows[j + k, a, b] += abs(c)

    def bound(self, A: arb | Fraction, factors: _Factors, tails: bool = False):
        """The sum of |c| A^(j+k) times the greatest factors, or times the integrals of falling majorants."""
        of = factors.tail if tails else factors.greatest
        return sum((c * A**n * of(a, b) for (n, a, b), c in self.rows.items()), ball(0))


class _Factors:
    """P^(-a/4) Q^(-b/4) at x, their greatest values and integrals from x on."""

    def __init__(self, form: MovingForm, x: arb | Fraction):
        (self.p, _), (self.q, _) = form.P, form.Q
        self.ends = P, Q = form.at(x)
        self.alone = form.Q[0].is_zero() or form.quotient is not None  # Q's powers are part of the others
        if P > 0 and Q > 0:
            self.roots = P.root(4), Q.root(4)
            self.turning = (P * Q).sqrt()
            if not self.alone:  # each quotient is monotone: its greatest value is at x or far off
                self.up, self.down = (Q / P).max(self.q
                                                 / self.p).root(4), (P / Q).max(self.p / self.q).root(4)
        self.known: dict = {}

    def at(self, a: int, b: int):
        """The factor itself."""
        if (a, b) not in self.known:
            self.known[a, b] = self.roots[0] ** -a * self.roots[1] ** -b
        return self.known[a, b]

    def greatest(self, a, b):
        """From x on. Where one exponent is below 0, a power of the quotient splits off."""
        if a + b < 0:
            raise Unsuited("a term grows with the spin")
        if a >= 0 and b >= 0:
            return self.at(a, b)
        return self.up ** -b * self.at(a + b, 0) if b < 0 else self.down ** -a * self.at(0, a + b)

    def tail(self, a, b):
        """The integral from x on of a majorant that falls: one factor stays at its value, or a power of the
        quotient splits off; the least of these."""
        P, Q = self.ends
        rows = []
        if a > 4 and b >= 0:
            rows.append(self.at(a, b) * P / (self.p * (ball(a) / 4 - 1)))
        if not self.alone:
            if b > 4 and a >= 0:
                rows.append(self.at(a, b) * Q / (self.q * (ball(b) / 4 - 1)))
            if a + b > 4:
                n = ball(a + b) / 4 - 1
                rows.append((self.down**b if b > 0 else self.up**-b) * self.at(a + b, 0) * P / (self.p * n))
                rows.append((self.up**a if a > 0 else self.down**-a) * self.at(0, a + b) * Q / (self.q * n))
        if not rows:
            raise Unsuited("a term of the amplitude's rate does not fall fast enough")
        return reduce(arb.min, rows)


def _turning(form: MovingForm, x: arb):
    P, Q = form.at(x)
    return (P * Q).sqrt()
