"""Twofold numbers, and divided differences of the exponential that need them.

Twofold numbers are unevaluated sums of two doubles, 32 digits, for the few differences that decide a small
divisor.

Whole arrays at once, no fused multiply-add needed. Magnitudes must stay within 1e-140 ... 1e140, so that no
partial product is lost.

Divided differences of the exponential are the response of a chain of oscillators and integrators at any
small divisor.

D[x0 ... xn](t) = t^n exp[x0 t, ..., xn t], that is the inverse Laplace transform of 1/((s - x0) ... (s -
xn)). Partial fractions divide by every difference of two nodes, and lose all digits where two of them meet;
here nodes closer than a few units (times t) form a cluster, treated by Taylor's series about one of them, and
the recursion D[S] = (D[S - i] - D[S - j]) / (xj - xi) runs only between the two farthest nodes of a set
(McCurdy, Ng and Parlett 1984, Math. Comp. 43, 501-528, for real nodes). Every subset of the nodes is needed
anyway, by the recursion and by the caller."""
from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import combinations, product
from math import factorial
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from ..errors import InputError
from .error_free import add, exact_product, exact_sum, times

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

EPS = float(np.finfo(float).eps)
TURN = 2 * np.pi


def twofold(x: ArrayLike | Twofold) -> Twofold:
    """A double, or an array of them, as a twofold number."""
    if isinstance(x, Twofold):
        return x
    x = np.asarray(x, float)
    return Twofold(x, np.zeros_like(x))


@dataclass(frozen=True, eq=False)
class Twofold:
    """high + low with |low| at most half a unit in the last place of high; arrays broadcast as NumPy's do."""

    high: np.ndarray
    low: np.ndarray

    def __add__(self, other: ArrayLike | Twofold) -> Twofold:
        other = twofold(other)
        return Twofold(*add((self.high, self.low), (other.high, other.low)))

    def __mul__(self, other: ArrayLike | Twofold) -> Twofold:
        other = twofold(other)
        return Twofold(*times((self.high, self.low), (other.high, other.low)))

    def __truediv__(self, other: ArrayLike | Twofold) -> Twofold:
        other = twofold(other)
        first = self.high / other.high
        rest = self - other * first
        return (Twofold(*exact_sum(first, rest.high / other.high))
                + (rest - other * (rest.high / other.high)).high / other.high)

    def __neg__(self) -> Twofold:
        return Twofold(-self.high, -self.low)

    def __sub__(self, other: ArrayLike | Twofold) -> Twofold:
        return self + -twofold(other)

    def __rsub__(self, other: ArrayLike | Twofold) -> Twofold:
        return -self + other

    __radd__, __rmul__ = __add__, __mul__

    def value(self) -> np.ndarray:
        """The nearest double."""
        return self.high + self.low


Counts: TypeAlias = tuple[int, ...]  # how often each node is taken
LARGEST_EXPONENT = 700.0  # exp(709.78) is the largest double; the rest is room for the sums
MOST_TERMS = 100  # reached by no cluster narrower than 30


def divided_differences(nodes: Sequence[complex], counts: Iterable[Counts], t: ArrayLike,
                        low: Sequence[complex]) -> dict[Counts, np.ndarray]:
    """D over several multisets of the same nodes, sharing their parts, at times t (an array of any shape).

    nodes: 1/s. counts: one tuple per answer: how often it takes each node. low: what the nodes lost to
    rounding, so that a difference of two is known better than the nodes themselves. Answers {counts: complex
    array of the shape of t}. For imaginary nodes the error is of the size that half a unit in the last place
    of nodes and t causes (measured: tests). Raises InputError where exp overflows.
    """
    times = np.asarray(t, float)
    largest = max((float(np.max(complex(x).real * times)) for x in nodes), default=0.0) if times.size else 0.0
    if largest > LARGEST_EXPONENT:
        raise InputError(f"the motion grows like exp({largest:.6g}), beyond the largest double (exp(709)): "
                         "ask for shorter times")
    table = _Table(list(map(complex, nodes)), low, times.ravel())
    return {c: (table.scaled(c) * table.t ** (sum(c) - 1)).reshape(times.shape) for c in map(tuple, counts)}


def cluster_width(n: int) -> float:
    """Sets of n + 1 nodes no wider than this are summed by Taylor's series.

    The recursion multiplies errors by up to 2 n / width at each step down, the series by up to exp(width /
    2).
    """
    return max(1.5, 0.9 * n)


class _Table:
    """exp[x0 t, ...] of the sub-multisets asked for, each computed once; all arrays are flat and of one
    length."""

    def __init__(self, nodes: Sequence[complex], low: Sequence[complex], t: np.ndarray) -> None:
        self.t, self.exponential = t, [_accurate_exp(x, rest, t) for x, rest in zip(nodes, low)]
        self.gap = {(i, j): (nodes[j] - nodes[i]) + (low[j] - low[i])
                    for i, j in product(range(len(nodes)), repeat=2)}
        self.known: dict[Counts, np.ndarray] = {}

    def scaled(self, counts: Counts) -> np.ndarray:
        if counts not in self.known:
            self.known[counts] = self._compute(counts)
        return self.known[counts]

    def _compute(self, counts: Counts) -> np.ndarray:
        present = [i for i, c in enumerate(counts) if c]
        if len(present) == 1:
            return self.exponential[present[0]] / factorial(sum(counts) - 1)
        farthest = max(combinations(present, 2), key=lambda pair: abs(self.gap[pair]))
        nearby = np.abs(self.gap[farthest] * self.t) <= cluster_width(sum(counts) - 1)
        value = np.empty(self.t.size, complex)
        if nearby.any():
            value[nearby] = self._series(counts, present, nearby)
        if not nearby.all():
            value[~nearby] = self._recursion(counts, *farthest, ~nearby)
        return value

    def _recursion(self, counts: Counts, i: int, j: int, there: np.ndarray) -> np.ndarray:
        without = lambda k: self.scaled(tuple(c - (n == k) for n, c in enumerate(counts)))[there]
        return (without(i) - without(j)) / (self.gap[i, j] * self.t[there])

    def _series(self, counts: Counts, present: list[int], there: np.ndarray) -> np.ndarray:
        """Taylor's series about the node that has the others nearest, at the elements `there`."""
        centre = min(present, key=lambda r: sum(counts[i] * abs(self.gap[r, i]) for i in present))
        gaps = [self.gap[centre, i] * self.t[there] for i in present if i != centre for _ in range(counts[i])]
        return self.exponential[centre][there] * _homogeneous_series(gaps, sum(counts) - 1)


def _homogeneous_series(gaps: list[np.ndarray], n: int) -> np.ndarray:
    """sum over k of h_k(gaps) / (n + k)!, h_k the complete homogeneous polynomial (the other arguments are
    zero)."""
    partial = [np.ones_like(gaps[0]) for _ in gaps]  # h_k of the first 1, 2, ... gaps
    weight = 1.0 / factorial(n)
    terms = [np.full_like(gaps[0], weight)]
    reach = max(np.abs(g).max() for g in gaps)
    bound = 1.0
    for k in range(1, MOST_TERMS):
        weight /= n + k
        below = 0.0
        for r, gap in enumerate(gaps):
            partial[r] = below = below + gap * partial[r]
        terms.append(partial[-1] * weight)
        # |h_k| n! / (n + k)! <= reach^k / k!, as h_k of n + 1 arguments has (n + k)! / (n! k!) terms
        bound *= reach / k
        if bound < 1e-19 and reach < k:
            break
    total = terms.pop()
    while terms:
        total = terms.pop() + total  # smallest first
    return total


def _accurate_exp(x: complex, rest: complex, t: np.ndarray) -> np.ndarray:
    """exp((x + rest) t), the rounding of the product made good."""
    (re, re_low), (im, im_low) = exact_product(x.real, t), exact_product(x.imag, t)
    return np.exp(re + 1j * im) * np.exp(re_low + 1j * im_low + rest * t)
