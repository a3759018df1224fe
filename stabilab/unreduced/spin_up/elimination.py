"""Elimination of what oscillates in the rate of a quantity (the fields are those of `centres`): a corrected
energy and a corrected amplitude, to any order, take away what oscillates about the centre.

Quantities are sums of c zeta^j zeta*^k p^(-a/4) q^(-b/4), many terms at a time in arrays (`Terms`); p and q
are linear in the spin x. Along the motion, with `Algebra`'s names,

    zeta' = i om p^(-turn_a/4) q^(-turn_b/4) zeta + x' carried + drift,        x' = x_rate,
    d/dt  = i Om (zeta d - zeta* d*) + x' [d/dx + along carried] + along drift.

An oscillating term c zeta^j zeta*^k f(x) of a rate (j != k) is taken away by adding -c/(i Om (j - k)) zeta^j
zeta*^k f(x) to the quantity: its rate then holds -c zeta^j zeta*^k f(x) and the price, what the rest of d/dt
makes of the added term, smaller by at least one power of the spin. What does not oscillate (j = k) stays.
Level of a term: four times the power of 1/x with which it falls.

Rounding. Beside each coefficient goes its majorant, formed by the same operations on sizes, without
subtraction: a coefficient is a sum of products, its majorant the sum of the same products' sizes. Each
product is formed by fewer than 2^14 roundings (orders below 40: some ten to a level, and sums of fewer than
300 terms at each), so a coefficient in doubles errs by less than 2^-38 of its majorant. `sizes` gives |c| +
ROUNDING majorant, ROUNDING = 2^-32, which covers that 64 times over.

Exponents and numbers are apart: which terms there are, which of them coincide and in what order they stand
follows from exponents alone, and those are the same for nearly all scenes. A `Shape` holds the exponents of a
sum, and what follows from them is worked out once for all scenes (`worked_out`); a scene has the arithmetic
of its coefficients alone."""
from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

ROUNDING = 2.0**-32
_A, _K, _J = 1 << 16, 1 << 32, 1 << 40
_MIDDLE = (1 << 15) + (1 << 15) * _A
MAX_BYTES = 3 << 24  # of what was worked out from exponents: beyond it all of that is forgotten


def packed(j: int, k: int, a: float, b: float):
    """(j, k, a, b) in one integer, linearly: the key of a product is the sum of the keys. j, k below 256, a
    and b between -2^15 and 2^15."""
    return j * _J + k * _K + a * _A + b


class Shape:
    """The exponents of a sum of terms, an integer each (`packed`), (n,). Shapes are compared by identity."""

    def __init__(self, keys: np.ndarray):
        self.keys = keys

    @property
    def powers(self) -> tuple[np.ndarray, ...]:
        """(j, k, a, b), (n,) each."""
        keys = self.keys + _MIDDLE
        return keys >> 40, keys >> 32 & 255, (keys >> 16 & _A - 1) - (1 << 15), (keys & _A - 1) - (1 << 15)

    @property
    def apart(self) -> np.ndarray:
        """j - k, (n,)."""
        keys = self.keys + _MIDDLE
        return (keys >> 40) - (keys >> 32 & 255)


_WORKED_OUT: dict[Hashable, Any] = {}
_BYTES = [0]


def worked_out(work: Callable[..., Any], *shapes: Any) -> Any:
    """work(*shapes), of shapes and other hashable things, from an earlier time where there was one. work: a
    function of a module, which needs nothing else; its result is shared, and nobody changes it."""
    key = work, shapes
    result = _WORKED_OUT.get(key)
    if result is None:
        result = work(*shapes)
        _BYTES[0] += _bytes(result)
        if _BYTES[0] > MAX_BYTES:
            _WORKED_OUT.clear()
            _BYTES[0] = 0
        _WORKED_OUT[key] = result
    return result


def _bytes(result: Any) -> int:
    if isinstance(result, Shape):
        return result.keys.nbytes
    return sum(map(_bytes, result)) if isinstance(result, tuple) else getattr(result, "nbytes", 0)


def _shape_of(keys: tuple[int, ...]) -> Shape:
    return Shape(np.array(keys, np.int64))


def _moved(shape: Shape, key: int) -> Shape:
    return Shape(shape.keys + key)


def _conjugate(shape: Shape) -> Shape:
    return Shape(shape.keys - shape.apart * (_J - _K))


def _part(shape: Shape, rows: Callable[..., np.ndarray], *options: Hashable) -> tuple[Shape, np.ndarray]:
    """(exponents of the rows that a function of a module chooses, these rows)."""
    chosen = np.flatnonzero(rows(shape, *options))
    return Shape(shape.keys[chosen]), chosen


def _gathered(shapes: Sequence[Shape], halves: Sequence[Shape]) -> tuple[Shape, *tuple[np.ndarray, ...]]:
    """(exponents of the sum of all, no two alike, rising; order of the terms; where each begins in it; to
    which each belongs; by what the real and the imaginary part of each are multiplied: 2 and 0 of one for
    twice its real part, 1 and -1 of one for its conjugate)."""
    keys = np.concatenate([shape.keys for shape in (*shapes, *halves)])
    begin, apart = sum(len(shape.keys) for shape in shapes), Shape(keys).apart
    real, imaginary = np.ones((2, len(keys)))
    real[begin:] += apart[begin:] == 0
    imaginary[begin:] = np.sign(apart[begin:])
    keys -= np.minimum(apart, 0) * (np.arange(len(keys)) >= begin) * (_J - _K)
    order = keys.argsort(kind="stable")
    keys = keys[order]
    new = np.ones(len(keys), bool)
    np.not_equal(keys[1:], keys[:-1], out=new[1:])
    which = np.empty_like(order)
    which[order] = new.cumsum() - 1
    return Shape(keys[new]), order, new.nonzero()[0], which, real, imaginary


def _product(shape: Shape, other: Shape) -> Shape:
    return Shape((shape.keys[:, None] + other.keys).ravel())


def _not_below(shape: Shape) -> np.ndarray:
    return shape.apart >= 0


def _above(shape: Shape) -> np.ndarray:
    return shape.apart > 0


def _lowering(shape: Shape, which: int, step: int) -> tuple[Shape, np.ndarray, np.ndarray]:
    """(exponents of the terms in which one of them, 0 to 3 for j, k, a, b, is not 0, times a monomial; which
    terms these are; that exponent of each)."""
    powers = shape.powers[which]
    chosen = np.flatnonzero(powers)
    return Shape(shape.keys[chosen] + step), chosen, powers[chosen]


def _derivative(shape: Shape, *parts: Shape) -> tuple[Shape, np.ndarray, np.ndarray, np.ndarray]:
    """(exponents; which term; which of what stands for the four exponents; the exponent) of the products of a
    `_Derivative`."""
    columns, begin = [], 0
    for powers, rate in zip(shape.powers, parts):
        chosen, n = np.flatnonzero(powers), len(rate.keys)
        columns.append((np.add.outer(shape.keys[chosen], rate.keys).ravel(), chosen.repeat(n),
                        np.tile(begin + np.arange(n), chosen.size), powers[chosen].repeat(n)))
        begin += n
    keys, term, part, power = map(np.concatenate, zip(*columns))
    return Shape(keys), term, part, power.astype(float)


@dataclass(slots=True, eq=False)  # thousands are made for each scene
class Terms:
    """shape: of n terms, no two alike; c: (n,) coefficients; m: (n,) what the sizes of all that was added up
    in c come to."""

    shape: Shape
    c: np.ndarray
    m: np.ndarray

    @property
    def keys(self) -> np.ndarray:
        """(n,) integers of the exponents."""
        return self.shape.keys

    def part(self, rows: Callable[..., np.ndarray], *options: Hashable) -> Terms:
        """The terms that a function of their shape chooses."""
        shape, chosen = worked_out(_part, self.shape, rows, *options)
        return Terms(shape, self.c[chosen], self.m[chosen])

    def times(self, factor: complex | np.ndarray) -> Terms:
        """Each coefficient times a number or an array of numbers."""
        return Terms(self.shape, self.c * factor, self.m * np.abs(factor))

    def lowered(self, which: int, key: int, factor: float = 1) -> Terms:
        """Times one of the exponents (0 to 3: j, k, a, b), a factor and a monomial; without those where it is
        0."""
        shape, chosen, powers = worked_out(_lowering, self.shape, which, key)
        factors = powers * factor
        return Terms(shape, self.c[chosen] * factors, self.m[chosen] * np.abs(factors))

    def moved(self, key: int) -> Terms:
        """Times one monomial."""
        return Terms(worked_out(_moved, self.shape, key), self.c, self.m)

    def conjugate(self) -> Terms:
        """The conjugate of the sum: zeta^j zeta*^k becomes zeta^k zeta*^j."""
        return Terms(worked_out(_conjugate, self.shape), self.c.conjugate(), self.m)

    def half(self) -> Terms:
        """Of a real sum, whose terms come with their conjugates, those with j >= k."""
        return self.part(_not_below)

    def whole(self) -> Terms:
        """The real sum of which `half` is left."""
        return gathered(self, self.part(_above).conjugate())


def terms_of(table: dict) -> Terms:
    """Terms from {(j, k, a, b): c}."""
    c = np.array(list(table.values()), complex)
    return Terms(worked_out(_shape_of, tuple(packed(*key) for key in table)), c, np.abs(c))


def gathered(*parts: Terms, halves: Sequence[Terms] = ()) -> Terms:
    """The sum of sums of terms; halves: others, added with their conjugates, as half of a real sum."""
    full = *parts, *halves
    if not full:
        return terms_of({})
    shape, order, first, which, real, imaginary = worked_out(
        _gathered, tuple([part.shape for part in parts]), tuple([part.shape for part in halves]))
    c, m = np.concatenate([part.c for part in full]), np.concatenate([part.m for part in full])
    if halves:
        c.real *= real
        c.imag *= imaginary
        m *= real
    return Terms(shape, np.add.reduceat(c[order], first), np.bincount(which, m, len(first)))


def product(item: Terms, other: Terms) -> Terms:
    """The product of two sums of terms, like keys not yet added up."""
    return Terms(worked_out(_product, item.shape, other.shape), (item.c[:, None] * other.c).ravel(),
                 (item.m[:, None] * other.m).ravel())


def sizes(terms: Terms) -> np.ndarray:
    """(n,) bounds of the true coefficients' sizes."""
    return np.abs(terms.c) + ROUNDING * terms.m


class _Derivative:
    """A sum over the four exponents of a monomial, each times one of these sums of terms times the monomial.
    """

    def __init__(self, *parts: Terms):
        self.shapes = tuple(part.shape for part in parts)
        self.c, self.m = (np.concatenate(arrays) for arrays in zip(*((part.c, part.m) for part in parts)))

    def of(self, terms: Terms) -> Terms:
        """Of a sum of monomials; like keys not yet added up."""
        shape, term, part, power = worked_out(_derivative, terms.shape, *self.shapes)
        return Terms(shape, terms.c[term] * (power * self.c[part]),
                     terms.m[term] * (np.abs(power) * self.m[part]))


@dataclass(frozen=True)
class Algebra:
    """What the time derivative of a form is made of.

    lift: i/om; turn: (a, b) of the turning rate Om = om p^(-a/4) q^(-b/4); fall: the factors of d/dx,
    -slope/4 of p and of q; x_rate: terms of x'; carried: terms of zeta' over x'; drift: its other terms;
    weights: what p and q count in the level, 0 for a q that is constant.
    """

    lift: complex
    turn: tuple
    fall: tuple
    x_rate: Terms
    carried: Terms
    drift: Terms
    weights: tuple = (1, 1)

    @cached_property
    def _motion(self) -> tuple[tuple[_Derivative, Terms | None], ...]:
        """Derivatives whose sum is d/dt, but for turning, each with what it is multiplied with."""
        def along(zeta: Terms, x: Terms) -> _Derivative:
            falls = (x.times(fall).moved(packed(0, 0, *step)) if fall else terms_of({})
                     for step, fall in zip(((4, 0), (0, 4)), self.fall))
            return _Derivative(zeta.moved(-_J), zeta.conjugate().moved(-_K), *falls)
        if not len(self.carried.c):
            return (along(self.drift, self.x_rate), None),
        drifting = ((along(self.drift, terms_of({})), None),) if len(self.drift.c) else ()
        return (along(self.carried, terms_of({(0, 0, 0, 0): 1.0})), self.x_rate), *drifting

    def rest_of_rate(self, terms: Terms) -> list[Terms]:
        """The rate of a quantity apart from what turning makes of it, as sums that are not yet one, like keys
        not yet added up."""
        return [derivative.of(terms) if factor is None else product(gathered(derivative.of(terms)), factor)
                for derivative, factor in self._motion]

    def slope(self, terms: Terms) -> list[Terms]:
        """d/dx of terms at constant zeta, as sums that are not yet one."""
        return [terms.lowered(which, packed(0, 0, *step), fall)
                for step, fall, which in (((4, 0), self.fall[0], 2), ((0, 4), self.fall[1], 3)) if fall]


@dataclass(frozen=True)
class Corrected:
    """What was added to a quantity, and what is left of its rate (of an energy: without the drive)."""

    added: Terms
    rate: Terms


def _next(shape: Shape, weights: Sequence[int], order: int) -> np.ndarray:
    """The oscillating terms of the lowest level, four times the power of 1/x with which they fall, up to an
    order; none where there are none."""
    _, _, a, b = shape.powers
    levels = weights[0] * a + weights[1] * b
    oscillating = (shape.apart != 0) & (levels <= 4 * order)
    return oscillating & (levels == levels[oscillating].min(initial=4 * order))


def _removal(shape: Shape, weights: Sequence[int], order: int, step: int
             ) -> tuple[Shape, np.ndarray, np.ndarray, Shape, np.ndarray]:
    """(exponents of what takes the next oscillating terms out of a rate, which terms these are, their j - k;
    exponents of the others, which these are)."""
    rows = _next(shape, weights, order)
    chosen, others = np.flatnonzero(rows), np.flatnonzero(~rows)
    return (Shape(shape.keys[chosen] + step), chosen, shape.apart[chosen], Shape(shape.keys[others]),
            others)


class Elimination:
    """What oscillates taken out of a rate, which is real: its terms come with their conjugates, so that half
    of them need be followed. A higher order goes on where a lower one has ended."""

    def __init__(self, algebra: Algebra, rate: Terms):
        self.algebra = algebra
        # order, what was added, what is left; replaced as a whole, for threads may share it
        self.begun = self.reached = -1, tuple[Terms, ...](), rate.half()

    def to(self, order: int) -> Corrected:
        """Everything oscillating up to x^-order."""
        reached = self.reached
        _, parts, rate = reached if reached[0] <= order else self.begun
        algebra, step = self.algebra, -packed(0, 0, *self.algebra.turn)
        while True:
            shape, chosen, apart, left, others = worked_out(_removal, rate.shape, algebra.weights, order,
                                                            step)
            if not len(chosen):
                break
            factors = algebra.lift / apart
            added = Terms(shape, rate.c[chosen] * factors, rate.m[chosen] * np.abs(factors))
            parts = *parts, added
            rate = gathered(Terms(left, rate.c[others], rate.m[others]), halves=algebra.rest_of_rate(added))
        self.reached = order, parts, rate
        return Corrected(gathered(*parts).whole(), rate.whole())
