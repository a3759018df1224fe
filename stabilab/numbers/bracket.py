"""Where an outcome changes along one number: a change is bracketed, and its bracket is narrowed.

An outcome (bounded or not, one direction or the other) is known at single places. One at which it is as
before and one at which it is another bracket a change. What is proved of the outcome at the two ends is all
that is proved: places between were not looked at, and of several changes in a bracket one is found.
"""
from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple, TypeAlias

import numpy as np

from .vectors import Number

# a place -> a margin: positive where the outcome is as before, negative where it is another, infinite where
# no more is known than that, NaN where not even that is
Judge: TypeAlias = Callable[[Fraction], float]
LAST_PLACE = Fraction(1, 1 << 51)  # of the greater end, about: places are doubles
MOST = 400  # halvings or doublings: doubles have 2,098 binary orders, these outcomes a few
HALF = Fraction(1, 2)


class Bracket(NamedTuple):
    """same: a place at which the outcome is as before; other: one at which it is another; margins: there."""

    same: Fraction
    other: Fraction
    margins: tuple[float, float] = (math.inf, -math.inf)


def side(same: bool) -> float:
    """The margin of an outcome of which no more is known than whether it is as before."""
    return math.inf if same else -math.inf


def first_bracket(judge: Judge, first: Number, most: Number | None = None,
                  least: Number = 0) -> Bracket | None:
    """The change that is met first by sizes that grow from `first` twofold, or, where the outcome is another
    there, by those that shrink.

    most: the greatest size that is tried (None: after MOST doublings); None where all are as before. least:
    where the outcome is another down to it the bracket begins at 0, which is not tried.
    """
    size, end = Fraction(first), Fraction(first) * (1 << MOST) if most is None else Fraction(most)
    margin = judge(size)
    while not margin > 0:
        smaller = size / 2
        before = judge(smaller)
        if before > 0:
            return Bracket(smaller, size, (before, margin))
        size, margin = smaller, before
        if size <= least:
            return Bracket(Fraction(0), size, (math.inf, margin))
    while size < end:
        larger = min(2 * size, end)
        beyond = judge(larger)
        if not beyond > 0:
            return Bracket(size, larger, (margin, beyond))
        size, margin = larger, beyond
    return None


def narrowed(judge: Judge, bracket: Bracket, near: Fraction = LAST_PLACE, scale: Number = 0,
             steps: int = MOST) -> Bracket:
    """The bracket no wider than `near` of its greater end, or of LAST_PLACE of `scale` if that is more.

    Where both margins are finite the next place is where the line through them vanishes, at least the
    resolution away from either end, the margin of an end that stays halved (the Illinois rule, Dowell and
    Jarratt 1971); every fourth time, and otherwise, it is the middle. Where the outcome is open at a place
    both ends are that place: the change cannot be distinguished from it.
    """
    (same, other, margins), last = bracket, 0.0
    for n in range(steps):
        smallest = near * max(abs(same), abs(other), scale * LAST_PLACE)
        if abs(other - same) <= smallest:
            break
        fraction = _share(margins, smallest / abs(other - same)) if n % 4 < 3 else HALF
        # doubles: numbers do not grow while an interval is halved
        tried = [Fraction(float(same + part * (other - same))) for part in (fraction, HALF)]
        location = next((item for item in tried if min(same, other) < item < max(same, other)), None)
        if location is None:
            break
        margin = judge(location)
        if math.isnan(margin):
            return Bracket(location, location, (margin, margin))
        if margin > 0:
            same, margins = location, (margin, margins[1] / (2 if last > 0 else 1))
        else:
            other, margins = location, (margins[0] / (2 if last < 0 else 1), margin)
        last = margin
    return Bracket(same, other, margins)


def _share(margins: tuple[float, float], edge: Fraction) -> Fraction:
    """Where the line through two margins vanishes, as a share of the bracket, at least `edge` from either
    end."""
    a, b = margins
    if not (a > 0 > b and math.isfinite(a - b)):
        return HALF
    edge = min(HALF, edge)
    return min(max(Fraction(a / (a - b)), edge), 1 - edge)


def halved_each(same_at: Callable[[np.ndarray], np.ndarray], same: np.ndarray, other: np.ndarray,
                steps: int, by_ratio: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Brackets (n,), (n,) of changes along n lines, halved so many times, all at once.

    same_at(places (n,)): (n,) whether the outcomes are as before; by_ratio: at the geometric mean, where no
    end is 0.
    """
    for _ in range(steps):
        location = 0.5 * (same + other)
        if by_ratio:
            location = np.where(same > 0, np.sqrt(same * other), location)
        retained = same_at(location)
        same, other = np.where(retained, location, same), np.where(retained, other, location)
    return same, other
