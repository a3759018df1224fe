"""Taking away what oscillates: corrected energy and corrected amplitude of a form, to any order.

Quantities are sums of c zeta^j zeta*^k p^(-a/4) q^(-b/4) (`terms`); p and q are linear in the spin x (about the fixed centre p = X and there
is no q). Along the motion, with `Algebra`'s names,

    zeta' = i om p^(-turn_a/4) q^(-turn_b/4) zeta + rest + x' carried,        x' = x_rate,
    d/dt  = i Om (zeta d - zeta* d*) + [along rest] + x' [d/dx + along carried].

An oscillating term c zeta^j zeta*^k f(x) of a rate (j != k) is taken away by adding -c/(i Om (j - k)) zeta^j zeta*^k f(x) to the quantity:
its rate then holds -c zeta^j zeta*^k f(x) and the price, what the rest of d/dt makes of the added term, smaller by at least one
power of the spin. What does not oscillate (j = k) stays. Level of a term: four times the power of 1/x with which it falls.

Rounding. Beside each coefficient goes its majorant, formed by the same operations on sizes, without subtraction: a coefficient is a
sum of products, its majorant the sum of the same products' sizes. Each product is formed by fewer than 2^14 roundings (orders
below 40: some ten to a level, and sums of fewer than 300 terms at each), so a coefficient in doubles errs by less than 2^-38 of its
majorant. `sizes` gives |c| + ROUNDING majorant, ROUNDING = 2^-32, which covers that 64 times over.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...numbers.vectors import Number
from .form import NormalForm
from .terms import Terms, gathered, packed, product, terms_of

ROUNDING = 2.0**-32


@dataclass(frozen=True)
class Algebra:
    """What the time derivative of a form is made of.

    lift: i/om; turn: (a, b) of the turning rate Om = om p^(-a/4) q^(-b/4); fall: the factors of d/dx, -slope/4 of p and of q;
    x_rate: terms of x'; rest, carried: terms of zeta'; weights: what p and q count in the level, 0 for a q that is constant.
    """

    lift: Number
    turn: tuple
    fall: tuple
    x_rate: Terms
    rest: Terms
    carried: Terms
    weights: tuple = (1, 1)

    def levels(self, terms: Terms):
        """Four times the powers of 1/x with which terms fall."""
        _, _, a, b = terms.powers
        return self.weights[0] * a + self.weights[1] * b

    def rest_of_rate(self, terms: Terms) -> Terms:
        """The rate of a quantity apart from what turning makes of it."""
        return gathered(*self._rest(terms))

    def rest_of_half(self, terms: Terms) -> list[Terms]:
        """What adds up to the half of the rate, apart from what turning makes of it, of a real quantity of which the half is given; j > k in it."""
        return [part.real() for part in self._rest(terms)]

    def _rest(self, terms):
        inner = gathered(self.slope(terms), *_along(terms, self.carried))
        return [product(inner, self.x_rate), *_along(terms, self.rest)]

    def slope(self, terms: Terms) -> Terms:
        """d/dx of terms at constant zeta."""
        _, _, a, b = terms.powers
        return gathered(*(terms.moved(packed(0, 0, *step)).times(n).times(fall)[n != 0]
                          for step, fall, n in (((4, 0), self.fall[0], a), ((0, 4), self.fall[1], b)) if fall))

    def removed(self, terms: Terms) -> Terms:
        """What is added to a quantity to take oscillating terms out of its rate."""
        j, k, _, _ = terms.powers
        return terms.moved(-packed(0, 0, *self.turn)).times(self.lift).over(j - k)


def _along(terms, direction):
    """The derivative of terms along zeta' = direction."""
    if not len(direction.keys):
        return []
    j, k, a, b = direction.powers
    mirrored = Terms(packed(k, j, a, b), direction.c.conjugate(), direction.m)
    j, k, _, _ = terms.powers
    return [product(terms.moved(-packed(*step)).times(n)[n != 0], toward)
            for step, n, toward in (((1, 0, 0, 0), j, direction), ((0, 1, 0, 0), k, mirrored))]


@dataclass(frozen=True)
class Corrected:
    """What was added to a quantity, and what is left of its rate (of an energy: without the drive)."""

    added: Terms
    rate: Terms


def sizes(terms: Terms):
    """(n,) bounds of the true coefficients' sizes."""
    return np.abs(terms.c) + ROUNDING * terms.m


def corrected(algebra: Algebra, rate: Terms, order: int, added: Terms | None = None) -> Corrected:
    """Everything oscillating up to x^-order taken out of a rate; added: what was added to the quantity before. Both are real: their terms come with their
    conjugates, so that half of them need be followed."""
    parts, rate = [] if added is None else [added.half()], rate.half()
    while True:
        j, k, _, _ = rate.powers
        levels = algebra.levels(rate)
        oscillating = (j != k) & (levels <= 4 * order)
        if not oscillating.any():
            return Corrected(gathered(*parts).whole(), rate.whole())
        now = oscillating & (levels == levels[oscillating].min())
        parts.append(algebra.removed(rate[now]))
        rate = gathered(rate[~now], *algebra.rest_of_half(parts[-1]))


def fixed_algebra(form: NormalForm) -> Algebra:
    """The algebra of the normal form about its fixed centre: p = X."""
    i = form.kind.i
    return Algebra(i / form.om, (-4, 0), (-1.0 / 4, 0.0), terms_of(acceleration(form)).times(1 / form.D1),
                   terms_of({(0, 1, 0, 0): i * form.h, (0, 0, 0, 0): form.mu}), terms_of({}))


def acceleration(form: NormalForm) -> dict:
    """D1 X' = G = M1 + gam Im zeta^2 + Re(kap* zeta)."""
    i, half = form.kind.i, 0.5
    return {(0, 0, 0, 0): form.M1, (2, 0, 0, 0): -half * i * form.gam, (0, 2, 0, 0): half * i * form.gam,
            (1, 0, 0, 0): half * form.kap.conjugate(), (0, 1, 0, 0): half * form.kap}


def corrected_energy(form: NormalForm, order: int) -> Corrected:
    """D1 X^2/2 with everything oscillating up to X^-order taken out of its rate X G = M1 X + m* + what is left.

    Order 0 is the classical D1 X^2/2 + (gam/2om) Re zeta^2 - Im(kap* zeta)/om - Im(nu zeta)/(om^2 X): what is taken at X^1 is all of X (G - M1), at
    X^0 what h and mu make of it, Re(nu zeta)/om, and m* stays exactly. It is -Im(kap* mu)/om, formed exactly in `form.drag`, and
    left out of the rate here with M1 X: the drive.
    """
    start = {(j, k, a - 4, b): c for (j, k, a, b), c in acceleration(form).items() if j + k}
    found = corrected(fixed_algebra(form), terms_of(start), order)
    return Corrected(found.added, found.rate[found.rate.keys != 0])


def corrected_amplitude(form: NormalForm, order: int, weighted: bool = True) -> Corrected:
    """|zeta|^2 (1 + m*/(M1 X)) (without the weight: |zeta|^2) corrected up to X^-order; every term left falls as X^-2 or faster.

    It starts from |zeta|^2 + R/(om X), R = h Re zeta^2 - 2 Im(mu* zeta), which takes out of (|zeta|^2)' = 2 h Im zeta^2 + 2 Re(mu* zeta) all
    there is at X^0. The price at X^-1 is [along i h zeta* + mu] of R, and that vanishes identically: h Re zeta^2 gives
    2 h Re(zeta (i h zeta* + mu)) = 2 h Re(mu zeta), and -2 Im(mu* zeta) gives -2 Im(mu* (i h zeta* + mu)) = -2 h Re(mu* zeta*) = -2 h Re(mu zeta). So the
    rate is -X' R/(om X^2) and it is written down so, with no term at X^-1 at all. The weight (which does not stand among the
    added terms) adds (m*/M1) (|zeta|^2/X)', whose mean part -m* |zeta|^2/(D1 X^2) cancels that of -X' R/(om X^2), + m* |zeta|^2/(D1 X^2), up to
    rounding (which `sizes` holds): the flow keeps volume, so its mean does.
    """
    algebra, i = fixed_algebra(form), form.kind.i
    R = terms_of({(2, 0, 4, 0): 0.5 * form.h / form.om, (0, 2, 4, 0): 0.5 * form.h / form.om,
                  (1, 0, 4, 0): i * form.mu.conjugate() / form.om, (0, 1, 4, 0): -i * form.mu / form.om})
    rate = gathered(product(R.moved(packed(0, 0, 4, 0)).times(-1), algebra.x_rate))
    if weighted:
        rate = gathered(rate, algebra.rest_of_rate(terms_of({(1, 1, 4, 0): form.drag / form.M1})))
    return corrected(algebra, rate, order, R)
