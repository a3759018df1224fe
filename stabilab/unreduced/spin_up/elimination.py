"""Taking away what oscillates: corrected energy and corrected amplitude of a form, to any order.

Quantities are sums of c zeta^j zeta*^k p^(-a/4) q^(-b/4), kept as {(j, k, a, b): c}; p and q are linear in the spin x (about the
fixed centre p = X and there is no q). Along the motion, with `Algebra`'s names,

    zeta' = i om p^(-turn_a/4) q^(-turn_b/4) zeta + rest + x' carried,        x' = x_rate,
    d/dt  = i Om (zeta d - zeta* d*) + [along rest] + x' [d/dx + along carried].

An oscillating term c zeta^j zeta*^k f(x) of a rate (j != k) is taken away by adding -c/(i Om (j - k)) zeta^j zeta*^k f(x) to the quantity:
its rate then holds -c zeta^j zeta*^k f(x) and the price, what the rest of d/dt makes of the added term, smaller by at least one
power of the spin. What does not oscillate (j = k) stays. Level of a term: the power of 1/x with which it falls.

Rounding. The same elimination is done with the absolute values of all numbers and no subtraction (`majorant`): a coefficient
is a sum of products, its majorant the sum of the same products' sizes, and each product is formed by fewer than 2^14 roundings
(orders below 40: some 10 to a level and a sum of fewer than 300 terms at each), so a coefficient in doubles errs by less than 2^-38
of its majorant. `Corrected.sizes` holds |c| + ROUNDING * majorant, ROUNDING = 2^-32, which covers that 64 times over.
"""
from __future__ import annotations

from dataclasses import dataclass, replace

from .form import NormalForm

ROUNDING = 2.0**-32


@dataclass(frozen=True)
class Algebra:
    """What the time derivative of a form is made of.

    lift: i/om; turn: (a, b) of the turning rate Om = om p^(-a/4) q^(-b/4); fall: the factors of d/dx, -slope/4 of p and of q;
    x_rate: terms of x'; rest, carried: terms of zeta'. power: (a, b) -> level times 4.
    """

    lift: object
    turn: tuple
    fall: tuple
    x_rate: dict
    rest: dict
    carried: dict
    weights: tuple = (1, 1)  # what p and q count in the level: 0 for a q that is constant
    absolute: bool = False

    def level(self, key) -> int:
        """Four times the power of 1/x with which a term falls."""
        return self.weights[0] * key[2] + self.weights[1] * key[3]

    def majorant(self) -> Algebra:
        """The same with the sizes of all numbers."""
        sizes = lambda terms: {key: abs(c) for key, c in terms.items()}  # noqa: E731
        return replace(self, lift=abs(self.lift), fall=tuple(map(abs, self.fall)), x_rate=sizes(self.x_rate),
                       rest=sizes(self.rest), carried=sizes(self.carried), absolute=True)

    def rest_of_rate(self, terms) -> dict:
        """The rate of a quantity apart from what turning makes of it."""
        out, inner, fp, fq = {}, {}, *self.fall
        for (j, k, a, b), c in terms.items():
            if a and fp:
                _add(inner, (j, k, a + 4, b), c * (fp * (abs(a) if self.absolute else a)))
            if b and fq:
                _add(inner, (j, k, a, b + 4), c * (fq * (abs(b) if self.absolute else b)))
        _along(terms, self.rest, out)
        _along(terms, self.carried, inner)
        return product(inner, self.x_rate, out)

    def removed(self, key, c):
        """What is added to a quantity to take an oscillating term out of its rate."""
        j, k, a, b = key
        return (j, k, a - self.turn[0], b - self.turn[1]), c * self.lift / (abs(j - k) if self.absolute else j - k)


@dataclass(frozen=True)
class Corrected:
    """A quantity with what was added to it, and what is left of its rate; terms (j, k, a, b) -> coefficient.

    Of the rate of an energy the driving terms are left out (`energy`). sizes_*: bounds of the true coefficients' sizes.
    """

    added: dict
    rate: dict
    sizes_added: dict
    sizes_rate: dict
    majorant: dict  # of the added terms: their coefficients err by less than 2^-38 of it


def product(one, other, out=None) -> dict:
    """The product of two sums of terms, added to `out`."""
    out = {} if out is None else out
    for (j, k, a, b), c in one.items():
        for (l, m, e, f), g in other.items():
            _add(out, (j + l, k + m, a + e, b + f), c * g)
    return out


def conjugated(terms) -> dict:
    """The complex conjugate of a sum of terms."""
    return {(k, j, a, b): c.conjugate() for (j, k, a, b), c in terms.items()}


def _along(terms, direction, out):
    """The derivative of terms along zeta' = direction, added to `out`."""
    for (j, k, a, b), c in terms.items():
        for (l, m, e, f), g in direction.items():
            if j:
                _add(out, (j - 1 + l, k + m, a + e, b + f), j * c * g)
            if k:
                _add(out, (j + m, k - 1 + l, a + e, b + f), k * c * g.conjugate())


def _add(out, key, c):
    out[key] = out[key] + c if key in out else c


def corrected(algebra: Algebra, rate: dict, sizes: dict, order: int, added=None, sizes_added=None) -> Corrected:
    """Everything oscillating up to level `order` taken out of a rate. sizes: the majorant of the rate; added: what was added before."""
    exact = _eliminated(algebra, rate, order, added or {})
    bound = _eliminated(algebra.majorant(), sizes, order, sizes_added or {})
    inflated = [{key: abs(terms.get(key, 0.0)) + ROUNDING * c for key, c in all_.items() if c}
                for terms, all_ in zip(exact, bound)]
    return Corrected(*exact, *inflated, {key: c for key, c in bound[0].items() if c})


def _eliminated(algebra, rate, order, added):
    rate, added = dict(rate), dict(added)
    while oscillating := [key for key in rate if key[0] != key[1] and algebra.level(key) <= 4 * order]:
        level = min(map(algebra.level, oscillating))
        moved = {}
        for key in oscillating:
            if algebra.level(key) == level:
                _add(moved, *algebra.removed(key, rate.pop(key)))
        for key, c in moved.items():
            _add(added, key, c)
        for key, c in algebra.rest_of_rate(moved).items():
            _add(rate, key, c)
    return added, rate


def fixed_algebra(form: NormalForm) -> Algebra:
    """The algebra of the normal form about its fixed centre: p = X."""
    return Algebra(form.kind.i / form.om, (-4, 0), (-1.0 / 4, 0.0), {key: c * (1 / form.D1) for key, c in acceleration(form).items()},
                   {(0, 1, 0, 0): form.kind.i * form.h, (0, 0, 0, 0): form.mu}, {})


def acceleration(form: NormalForm) -> dict:
    """D1 X' = G = M1 + gam Im zeta^2 + Re(kap* zeta)."""
    i, half = form.kind.i, 0.5
    return {(0, 0, 0, 0): form.M1, (2, 0, 0, 0): -half * i * form.gam, (0, 2, 0, 0): half * i * form.gam,
            (1, 0, 0, 0): half * form.kap.conjugate(), (0, 1, 0, 0): half * form.kap}


def corrected_energy(form: NormalForm, order: int) -> Corrected:
    """D1 X^2/2 with everything oscillating up to X^-order taken out of its rate X G = M1 X + m* + what is left.

    Order 0 is E + Im(...)/X of the classical form: D1 X^2/2 + (gam/2om) Re zeta^2 - Im(kap* zeta)/om - Im(nu zeta)/(om^2 X): the term at X^1
    takes away X(G - M1) whole, the one at X^0 what h and mu make of it, Re(nu zeta)/om, and leaves m* exactly (the drive; it is
    -Im(kap* mu)/om, formed exactly in `form.drag`, and left out here with M1 X).
    """
    start = {(j, k, a - 4, b): c for (j, k, a, b), c in acceleration(form).items() if j + k}
    found = corrected(fixed_algebra(form), start, {key: abs(c) for key, c in start.items()}, order)
    drive = (0, 0, 0, 0)
    return Corrected(found.added, {key: c for key, c in found.rate.items() if key != drive}, found.sizes_added,
                     {key: c for key, c in found.sizes_rate.items() if key != drive}, found.majorant)


def corrected_amplitude(form: NormalForm, order: int, weighted: bool = True) -> Corrected:
    """|zeta|^2 (1 + m*/(M1 X)) (without the weight: |zeta|^2) corrected up to X^-order; every term left falls as X^-2 or faster.

    It starts from |zeta|^2 + R/(om X), R = h Re zeta^2 - 2 Im(mu* zeta), which takes out of (|zeta|^2)' = 2 h Im zeta^2 + 2 Re(mu* zeta) all of X^0. The price at
    X^-1 is [along i h zeta* + mu] of R, and that vanishes identically: h Re zeta^2 gives 2 h Re(zeta (i h zeta* + mu)) = 2 h Re(mu zeta), and
    -2 Im(mu* zeta) gives -2 Im(mu* (i h zeta* + mu)) = -2 h Re(mu* zeta*) = -2 h Re(mu zeta). So the rate is -X' R/(om X^2) and it is written
    down so, with no term at X^-1 at all. The weight (which does not stand among the added terms) adds (m*/M1) (|zeta|^2/X)', whose mean part -m* |zeta|^2/(D1 X^2) cancels
    that of -X' R/(om X^2), + m* |zeta|^2/(D1 X^2), up to rounding (which `sizes_rate` holds): the flow keeps volume, so its mean does.
    """
    algebra, i = fixed_algebra(form), form.kind.i
    R = {(2, 0, 4, 0): 0.5 * form.h / form.om, (0, 2, 4, 0): 0.5 * form.h / form.om,
         (1, 0, 4, 0): i * form.mu.conjugate() / form.om, (0, 1, 4, 0): -i * form.mu / form.om}
    weight = {(1, 1, 4, 0): form.drag / form.M1} if weighted else {}
    results = []
    for alg, R_, w, sign in ((algebra, R, weight, -1), (algebra.majorant(), *({key: abs(c) for key, c in t.items()} for t in (R, weight)), 1)):
        falling = {(j, k, a + 4, b): c * sign for (j, k, a, b), c in R_.items()}
        rate = product(falling, alg.x_rate)
        for key, c in alg.rest_of_rate(w).items():
            _add(rate, key, c)
        results.append((rate, R_))
    (rate, added), (sizes, sizes_added) = results
    return corrected(algebra, rate, sizes, order, added, sizes_added)
