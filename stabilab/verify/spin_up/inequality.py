"""The inequality of spin-up: true at one time, it is true for ever.

In the normal form (`normal_form`), let M > 0. Energy and amplitude are corrected by terms c zeta^j zeta*^k X^-n: adding -c/(i om (j - k))
zeta^j zeta*^k X^-(n+1) takes an oscillating term (j != k) of degree n out of a rate, at the price of what the rest of d/dt makes of the
added term. One after another, lowest degree first, up to a degree:

    Y = X^2/2 + (added),                     Y' = M X + m + (left),      m constant, what is left of degree 0 and more;
    B = |zeta|^2 (1 + m/(M X)) + (added),    B' = (left),                all of degree 2 and more.

Let e, k, b be the sums of |c| A^(j+k) z^-n over Y's added, Y's left and B's added terms, and r that of |c| A^(j+k) z^(1-n)/(n - 1) over
what is left of B'. If

    X > z, |zeta| < A,    Y > z^2/2 + e,    eta = M - (max(0, -m) + k)/z > 0,    [B + b + r/eta]/(1 + min(0, m)/(M z)) < A^2

at one time, then as long as |zeta| < A and X > z: Y' > 0, so y = sqrt(2 (Y - e)) <= X stays above z and y y' = Y' >= M y - max(0, -m) - k
gives X >= y >= z + eta t; so the integral of X^-n is at most z^(1-n)/(eta (n - 1)), and |zeta|^2 stays below A^2 with the margin it began
with. So both hold for ever, and X grows at least at the rate eta.
"""
from __future__ import annotations

from dataclasses import dataclass
from operator import add

from ..numbers import ball

MOST_ORDER = 18
MOST_TERMS = 20_000


class Unsuited(Exception):
    """The form or the orders have no such inequality: why."""


@dataclass(frozen=True)
class Ledger:
    """Terms {(j, k, n): acb} added to a quantity and left of its rate."""

    added: dict
    left: dict


class Inequality:
    """The inequality of a form at two orders, that of Y and that of B."""

    def __init__(self, form, orders):
        if not form.M > 0:
            raise Unsuited("the torque's component does not have the sense of the spin")
        if not (0 <= orders[0] <= MOST_ORDER and 1 <= orders[1] <= MOST_ORDER):
            raise Unsuited(f"orders up to {MOST_ORDER} are worked out here")
        self.form, self.M = form, ball(form.M)
        self.spin_rate = _spin_rate(form)
        energy = self._corrected(product({(0, 0, -1): 1}, {key: c for key, c in self.spin_rate.items() if key[0] + key[1]}), orders[0], {})
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

    def _corrected(self, rate, order, added):
        added = dict(added)
        while True:
            moving = [key for key in rate if key[0] != key[1] and key[2] <= order]
            if not moving:
                return Ledger(added, rate)
            lowest = min(n for _, _, n in moving)
            now = {(j, k, n + 1): -rate.pop((j, k, n)) / (_i() * self.form.om * (j - k)) for j, k, n in moving if n == lowest}
            added, rate = total(added, now), total(rate, self._price(now))
            if len(rate) > MOST_TERMS:
                raise Unsuited("more terms than are worked out here")

    def _price(self, terms):
        """What the rates make of terms, apart from the turning."""
        i, form, out = _i(), self.form, {}
        for (j, k, n), c in terms.items():
            for to, value in (((j - 1, k + 1, n), j * c * i * form.h), ((j - 1, k, n), j * c * form.mu),
                              ((j + 1, k - 1, n), -k * c * i * form.h), ((j, k - 1, n), k * c * conjugate(form.mu))):
                if min(to[:2]) >= 0:
                    out[to] = out[to] + value if to in out else value
        steeper = {(j, k, n + 1): -n * c for (j, k, n), c in terms.items() if n}
        return total(out, product(steeper, self.spin_rate))

    def faults(self, state, A, z):
        """(what does not hold, in words, and whether it surely does not; eta as a ball) for the state (balls) and the exact numbers A, z;
        nothing where all holds."""
        X, zeta = self.form.place(state)
        A, z, size = ball(A), ball(z), abs(zeta)
        faults = [compared(X, z, "X > z"), compared(A, size, "|zeta| < A")]
        e, k = _bound(self.energy.added, A, z), _bound(self.energy.left, A, z)
        m = self.m
        eta = self.M - ((-m).max(ball(0)) + k) / z
        energy = X * X / 2 + _value(self.energy.added, X, zeta)
        faults += [compared(energy, z * z / 2 + e, "the energy is high enough"), compared(eta, ball(0), "the spin grows")]
        low = 1 + m.min(ball(0)) / (self.M * z)
        faults.append(compared(low, ball(0), "the weight is positive"))
        if eta > 0 and low > 0:
            r = sum((abs(c) * A**(j + k) * z**(1 - n) / (n - 1) for (j, k, n), c in self.amplitude.left.items()), ball(0))
            start = size * size * (1 + m / (self.M * X)) + _value(self.amplitude.added, X, zeta)
            faults.append(compared(A * A, (start + _bound(self.amplitude.added, A, z) + r / eta) / low, "the amplitude stays below A"))
        return [fault for fault in faults if fault], eta


def compared(greater, less, words: str):
    """None where it holds; (words, whether it surely does not) else."""
    return None if greater > less else (words, bool(greater <= less))


def _i():
    from flint import acb
    return acb(0, 1)


def conjugate(c):
    """c*."""
    from flint import acb
    return acb(c.real, -c.imag)


def _spin_rate(form):
    """X' as terms."""
    from flint import acb
    half, i = ball(1) / 2, _i()
    return {(0, 0, 0): acb(ball(form.M)), (2, 0, 0): -i * form.g * half, (0, 2, 0): i * form.g * half, (1, 0, 0): conjugate(form.kap) * half,
            (0, 1, 0): form.kap * half}


def total(*tables):
    """The sum of tables of terms."""
    out: dict = {}
    for table in tables:
        for key, c in table.items():
            out[key] = out[key] + c if key in out else c
    return out


def product(one, other):
    """The product of two tables of terms, keys of any length added up."""
    out: dict = {}
    for here, c in one.items():
        for there, d in other.items():
            key = tuple(map(add, here, there))
            out[key] = out[key] + c * d if key in out else c * d
    return {key: c for key, c in out.items() if not c.is_zero()}


def _bound(terms, A, z):
    """Sum of |c| A^(j+k) z^-n."""
    return sum((abs(c) * A**(j + k) / z**n for (j, k, n), c in terms.items()), ball(0))


def _value(terms, X, zeta):
    """The value of terms, which is real."""
    star = conjugate(zeta)
    return sum((c * zeta**j * star**k / X**n for (j, k, n), c in terms.items()), _i() * 0).real
