"""What an uncertain box does to a verdict, and how far the box must be stretched until the verdict changes.

The nearest change is looked for along rays from the middle of the box, to corners, along single numbers, and
against the gradient where there is one. What is found is a change that is really there, so its stretch is an
upper bound of the least one; that nothing is found is no proof. Seeded: the same box gives the same answer.
"""
from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import product
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from ...numbers.bracket import Bracket, halved_each, narrowed, side
from ...orbit.result import Fate
from ...reasons import Quantity, Reason, Reasoned, Sentence
from .boxes import Box, Numbers, Point
from .branch_and_bound import Proof
from .verdicts import ALSO_ANOTHER, joined, reason_of

EACH_VERDICT = Sentence("so-many-points", "{count}: {verdict}")
ONE_VERDICT = Sentence("all-points", "all: {verdict}")
SAMPLED = Sentence("sampled-points", "of {number} sampled points (seed {seed}) {verdicts}")
CONFIDENCE = Sentence("share-otherwise",
                      "with 95 % confidence at most {percent} % of the box does otherwise")
ALL_CORNERS = Sentence("all-corners", "so do all {corners} corners of the box")
SOME_CORNERS = Sentence("some-corners", "so do the {corners} corners of the box")
OTHER_POINTS = Sentence("other-points", "and {others} other points, looked at near the middle and towards "
                        "the least margin")
QUANTILES = Sentence("margin-quantiles",
                     "margins in energy: 5, 50 and 95 % quantiles {low}, {median}, {high}")
ALSO = Sentence("also-elsewhere", "also {verdicts}")
DEPARTS = Sentence("departs-from-rotation", "it departs from this rotation by up to {departure} ({middle})")
TURNS_OVER = Sentence("departs-and-turns-over",
                      "it departs from this rotation by up to {departure} and turns over ({middle})")
MIDDLE_STABLE = Sentence("middle-stable", "the middle itself is stable")()
BOTH_SIDES = Sentence("both-sides", "{middle} at the middle, {elsewhere} elsewhere in the box")
NEITHER = Sentence("neither-proof-nor-contrary",
                   "neither a proof in {parts} parts of the box nor a contrary case was found")

MAX_STRETCH = 100.0          # times the stated uncertainty
LADDER = np.concatenate([10.0 ** np.arange(-9, -2), 2.0 ** np.arange(-6, 7) * (MAX_STRETCH / 64)])
CORNERS, CHUNK = 512, 4096  # of so many corners all are tried, of more as many at random
HALVINGS, ROUNDS, NEAREST = 14, 8, 16
NEXT = 2.5  # times the first rung at which a ray changes: those that change by then are bisected
NEARER_STILL = 0.995  # of a change: how near one must be at least that takes its place
SETTLED, SETTLING = Fraction(1, 10**6), 20  # of a change, by the exact answers; and halvings at most
# points (m, n) of a box -> what is known there as an int each, (m,)
Codes: TypeAlias = Callable[[np.ndarray], np.ndarray]
# one point of a box -> what the ordinary exact code answers there, None where there is no such body
Answer: TypeAlias = Callable[[np.ndarray], Any]
UNKNOWN = -9          # the code of a point where there is no body, or nothing is known
PARTS, FEWER = 60_000, 2_500  # of the box: for the question asked, and for each try to prove more
# shares of a change that is there, tried as proved stretches until one fails
NEARER = (0.5, 0.75, 0.9, 0.99, 0.999)
SMALLER = (0.3, 0.15, 0.05, 0.01, 0.001)  # tried where even the first of these fails
UNDECIDED = "undecided"  # as the signature of equilibria begins and ends where nothing is known of them
Look: TypeAlias = Callable[[Point], tuple[str | None, float]]  # the answer, and a margin in energy or NaN
STRETCHES = (1e-6, 1e-3, 1.0)  # at which single points are tried
FARTHER = (2.0, 5.0, 10.0, 30.0, MAX_STRETCH)


def worst(margins: Callable[[np.ndarray], np.ndarray], n: int) -> np.ndarray:
    """Corners (corners, n) at which a margin is least: of more corners than are all tried, those that no
    change of one number makes less, from a few of the least on. margins: points -> (m,), NaN where there is
    no body."""
    if 2**n <= CORNERS:
        return np.zeros((0, n))
    smallest = lambda points: np.nan_to_num(margins(points), nan=np.inf)
    tried = corners(n)
    result = tried[np.argsort(smallest(tried), kind="stable")[:NEAREST]]
    flips = 1 - 2 * np.eye(n)
    for _ in range(n):
        nearby = (result[:, None, :] * flips).reshape(-1, n)
        heights = smallest(nearby).reshape(len(result), n)
        lower = heights.min(1) < smallest(result)
        if not lower.any():
            break
        result[lower] = nearby.reshape(len(result), n, n)[lower, heights[lower].argmin(1)]
    return np.unique(result, axis=0)


class Change(NamedTuple):
    """An answer changes along `direction` (largest entry 1 in size): another at `stretch`, still the same at
    `before`."""

    direction: np.ndarray
    stretch: float
    before: float


def rays(n: int, favoured: Iterable[np.ndarray] = ()) -> np.ndarray:
    """Directions (rays, n) to be tried."""
    single = np.concatenate([np.eye(n), -np.eye(n)])
    return np.unique(np.concatenate([*(np.reshape(f, (-1, n)) for f in favoured), single, corners(n)]),
                     axis=0)


def corners(n: int, largest: int = CORNERS) -> np.ndarray:
    """All 2^n corners of a box of n numbers, (corners, n), or so many at random where there are more."""
    if 2**n <= largest:
        return np.array(list(product((-1.0, 1.0), repeat=n)))
    return np.random.default_rng(5).choice((-1.0, 1.0), (largest, n))


def nearest_change(box: Box, codes: Codes, answer: Answer, here: Any,
                   favoured: Iterable[np.ndarray] = ()) -> Change | None:
    """The nearest change of the codes that is found, where the exact answers confirm it. here: the answer at
    the middle. Within the box a change at a body that is rigid goes before one at moments that none has.
    """
    favoured = list(favoured)
    rigid = lambda points: np.where(box.rigid(points), codes(points), UNKNOWN)
    out = _nearest(box, rigid, answer, here, favoured)
    return out if out is not None and out.stretch <= 1 else _nearest(box, codes, answer, here, favoured)


def _nearest(box: Box, codes: Codes, answer: Answer, here: Any,
             favoured: Iterable[np.ndarray]) -> Change | None:
    """The nearest change of the codes.

    Rungs of growing stretch show where the code first changes on each ray; the rays that change first are
    bisected, and the nearest change is drawn nearer by moving one number at a time.
    """
    n = len(box.places)
    middle = int(codes(np.zeros((1, n)))[0])
    directions = rays(n, favoured)
    # the first rung at which each ray has changed, inf where none
    changed = _changed(codes, middle, (directions[:, None, :] * LADDER[None, :, None]).reshape(-1, n))
    changed = changed.reshape(len(directions), -1)
    first = np.where(changed.any(1), LADDER[changed.argmax(1)], np.inf)
    chosen = np.flatnonzero((first <= NEXT * first.min()) & np.isfinite(first))
    if not len(chosen):
        return None
    before = np.array([max(LADDER[LADDER < end], default=0.0) for end in first[chosen]])
    beam = _halved(codes, middle, directions[chosen], before, first[chosen])
    for _ in range(ROUNDS):
        nearer = NEARER_STILL * beam[0].stretch
        moved = np.unique(np.concatenate([_moved(item.direction) for item in beam]), axis=0)
        moved = moved[_changed(codes, middle, moved * nearer)]
        if not len(moved):  # two numbers at a time
            moved = np.unique(np.concatenate(list(map(_moved, _moved(beam[0].direction)))), axis=0)
            moved = moved[_changed(codes, middle, moved * nearer)]
        if not len(moved):
            break
        beam = _halved(codes, middle, moved, np.zeros(len(moved)), np.full(len(moved), nearer))
    return confirmed(beam[0], answer, here)


def _changed(codes: Codes, here: int, points: np.ndarray) -> np.ndarray:
    """(m,): whether another code than `here` is known at points (m, n)."""
    result = np.concatenate([codes(points[i:i + CHUNK]) for i in range(0, max(1, len(points)), CHUNK)])
    return (result != here) & (result != UNKNOWN)


def _halved(codes: Codes, here: int, directions: np.ndarray, starts: np.ndarray,
              ends: np.ndarray) -> list[Change]:
    """The nearest of the changes along directions, each between a start and an end; the nearest first."""
    same_at = lambda stretches: ~_changed(codes, here, directions * stretches[:, None])
    starts, ends = halved_each(same_at, starts, ends, HALVINGS, by_ratio=True)
    return [Change(directions[k], float(ends[k]), float(starts[k]))
            for k in np.argsort(ends, kind="stable")[:NEAREST]]


def _moved(direction: np.ndarray) -> np.ndarray:
    """The ray with one number changed at a time."""
    n = len(direction)
    out = [np.where(np.arange(n) == k, value, direction) for k in range(n)
           for value in (-1.0, -0.5, 0.0, 0.5, 1.0)]
    return np.unique(np.array([d for d in out if np.abs(d).max() == 1.0]), axis=0)


def confirmed(change: Change, answer: Answer, here: Any) -> Change | None:
    """The change with its stretch settled by answer(point), of any kind, that differs from `here`; None where
    the answer is still `here` a thousandth farther."""
    other = lambda stretch: answer(change.direction * stretch) not in (None, here)
    end = next((end for end in (change.stretch * (1 + push) for push in (0.0, 1e-9, 1e-6, 1e-4, 1e-3))
                if other(end)), None)
    if end is None:
        return None
    start = min(change.before, end)
    around = Bracket(Fraction(0.0 if other(start) else start), Fraction(end))
    start, end = map(float, narrowed(lambda stretch: side(not other(float(stretch))), around, SETTLED,
                                     steps=SETTLING)[:2])
    return Change(change.direction, end, start)


@dataclass(frozen=True)
class Witness:
    """A point of the box: its verdict by the ordinary exact code, and all numbers there (name -> exact
    numbers)."""

    verdict: str
    values: Numbers = field(repr=False)


@dataclass(frozen=True)
class Sampled:
    """What points of the box, drawn uniformly at random, do. number: of points with an answer; seed: of
    NumPy's default generator; counts: verdict -> how many, most first; margins: the 5, 50 and 95 % quantiles
    of barrier minus energy (J; scaled energy), None where a motion has none."""

    number: int
    seed: int
    counts: dict[str, int]
    margins: tuple[float, float, float] | None = None
    corners: int = 0
    every: bool = False
    others: int = 0

    @property
    def otherwise(self) -> float:
        """The share of the box that may do otherwise though all points agree: 95 % confidence, 1 -
        0.05^(1/n)."""
        return 1 - float(0.05 ** (1 / self.number))

    @property
    def reason(self) -> Reason:
        """The counts, and what they leave open or how the margins spread."""
        agree = len(self.counts) == 1
        verdicts = joined((ONE_VERDICT(verdict=reason_of(word)) if agree
                           else EACH_VERDICT(count=count, verdict=reason_of(word))
                           for word, count in self.counts.items()), ", ")
        result = SAMPLED(number=self.number, seed=Quantity(self.seed, digits=12), verdicts=verdicts)
        if agree:
            result = result.then(CONFIDENCE(percent=Quantity(100 * self.otherwise, digits=2).upper))
        if self.corners:
            result = result.then(ALL_CORNERS(corners=self.corners) if self.every
                               else SOME_CORNERS(corners=self.corners))
        if self.others:
            result = result.then(OTHER_POINTS(others=self.others), " ")
        if self.margins:
            low, median, high = (Quantity(v, digits=4) for v in self.margins)
            result = result.then(QUANTILES(low=low, median=median, high=high))
        return result

    @property
    def words(self) -> str:
        """The same in words."""
        return self.reason.text()

    @property
    def points(self) -> str:
        """How many points they are, in words."""
        return f"{self.number} sampled points" + (f" and {self.corners} corners" if self.corners else "")


@dataclass(frozen=True)
class Over(Reasoned):
    """A verdict over a box.

    answer: "holds" (proved for the whole box), "depends" (with a witness on each side), "sampled" (no proof
    is to be had, and all points of `samples` do as the middle does) or "undecided". verdict: the middle's.
    reason: how it is known, or why not. exception: the set of
    measure zero that "holds" leaves out, None where it leaves out none; but: the same in words. Every change
    of the numbers by less than `proved` times the stated uncertainties is proved to leave the verdict;
    `changes_at` times these flips it (an upper bound of the least such factor: found by search and checked;
    None where none was found up to 100 times). parts: of the box, looked at. neighbours: what motions beside
    the middle do, where that is an equilibrium (`neighbours.Neighbours`), else None.
    """

    answer: str
    verdict: str | None
    exception: Reason | None = None
    proved: float = 0.0
    changes_at: float | None = None
    witnesses: tuple[Witness, ...] = ()
    parts: int = 0
    samples: Sampled | None = None
    neighbours: Any = None

    @property
    def but(self) -> str:
        """The set of measure zero that "holds" leaves out, in words; empty where it leaves out none."""
        return "" if self.exception is None else self.exception.text()

    @property
    def otherwise(self) -> tuple[str, ...]:
        """The verdicts of the witnesses that are not that of the first."""
        first = self.witnesses[0].verdict if self.witnesses else None
        return tuple(dict.fromkeys(w.verdict for w in self.witnesses[1:] if w.verdict != first))

    @property
    def elsewhere(self) -> Reason:
        """What the motion does elsewhere in the box, where the answer depends on that: a sentence's end."""
        nearby = self.neighbours
        if nearby is None or self.otherwise != (Fate.BOUNDED.word,):
            return (ALSO(verdicts=joined(map(reason_of, self.otherwise), " or ")) if self.otherwise
                    else ALSO_ANOTHER)
        middle = MIDDLE_STABLE if nearby.verdict == "stable" else nearby.reason
        return (TURNS_OVER(departure=nearby.departure, middle=middle) if nearby.turned
                else DEPARTS(departure=nearby.departure, middle=middle))


def bracketed(box: Box, here: Any, answer: Answer, change: Change | None,
              attempt: Callable[[float, int], Proof], reason: Reason) -> Over:
    """The answer from a change that was found (or None) and attempt(stretch, most) -> Proof, with [proved,
    changes_at]."""
    parts, proved = 0, 0.0
    if change is None or change.stretch > 1:
        proof = attempt(1.0, PARTS)
        parts += proof.parts
        if proof.holds is False:  # the ordinary code is to confirm it
            point = np.array(proof.point)
            if (size := float(np.abs(point).max())) and answer(point) not in (None, here):
                change = Change(point / size, size, 0.0)
        proved = 1.0 if proof.holds else 0.0
    more, looked = _farthest(change, attempt, proved)
    proved, parts = max(proved, more), parts + looked
    sides = () if change is None else _sides(box, answer, change.direction * change.stretch)
    result: dict[str, Any] = {"proved": proved, "changes_at": change and change.stretch, "witnesses": sides,
                             "parts": parts}
    if proved >= 1:
        return Over("holds", here, reason=reason, **result)
    if change is not None and change.stretch <= 1:
        return Over("depends", here, reason=BOTH_SIDES(middle=reason_of(sides[0].verdict),
                                                       elsewhere=reason_of(sides[1].verdict)), **result)
    return Over("undecided", here, reason=NEITHER(parts=parts), **result)


def _farthest(change: Change | None, attempt: Callable[[float, int], Proof],
              proved: float) -> tuple[float, int]:
    """(largest stretch proved, parts looked at): rising until a proof fails, and falling where the first one
    does."""
    looked, safe = 0, proved
    fraction = 1.0 if change is None else change.stretch
    rising = FARTHER if change is None else NEARER
    for stretch in (r * fraction for r in rising if r * fraction > proved):
        proof = attempt(stretch, FEWER)
        looked += proof.parts
        if not proof.holds:
            break
        safe = stretch
    for stretch in (s * fraction for s in SMALLER):
        if safe >= stretch:
            break
        proof = attempt(stretch, FEWER)
        looked += proof.parts
        safe = stretch if proof.holds else safe
    return safe, looked


def _sides(box: Box, answer: Answer, point: Point) -> tuple[Witness, ...]:
    """The middle, and a point that does otherwise."""
    return tuple(Witness(answer(p), box.values(p)) for p in (np.zeros(len(box.places)), point))
