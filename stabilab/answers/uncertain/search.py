"""A verdict over a box where no proof of it is known: what single points say, by the ordinary code.

All corners are looked at while their number is bounded, else as many at random; then a search goes on from
the point of the least margin, one number at a time; and points drawn uniformly at random say which share of
the box may still do otherwise. A point that does otherwise is a witness, drawn towards the middle. That none
is found is no proof, and the answer is "sampled".
"""
from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...orbit.result import Fate
from ...reasons import Reason
from .boxes import Box, Point
from .result import (
    CORNERS,
    STRETCHES,
    UNDECIDED,
    Change,
    Look,
    Over,
    Sampled,
    Witness,
    confirmed,
    corners,
)

# points of the box drawn at random; so many that stay undecided end a search: each may cost a second
SAMPLE, TIRED, SEED = 64, 4, 20261122
FEW = 64  # corners where each point takes some hundredths of a second: a motion that has to be followed
OPEN = (Fate.UNDECIDED.word, UNDECIDED)
MOVES = (-1.0, -0.5, 0.0, 0.5, 1.0)  # of one number, in half-widths
PASSES = 4  # over all numbers
Words = dict[str, int]


class Looks:
    """Points of a box that were looked at. look: point -> (verdict or None, margin in energy or NaN); here:
    the verdict at the middle."""

    def __init__(self, box: Box, here: Any, look: Look) -> None:
        self.box, self.here, self.look = box, here, look
        self.open, self.number = 0, 0
        self.least: tuple[float, Point] = (np.inf, np.zeros(len(box.places)))
        margin = look(self.least[1])[1]
        self.side = -1.0 if margin < 0 else 1.0
        self.settled = here is not None and here not in OPEN

    def other(self, point: Point) -> str | None:
        """The verdict at a point where it is another than the middle's."""
        word, margin = self.look(point) if self.box.rigid(np.array([point]))[0] else (None, np.nan)
        if word is None:
            return None
        self.number += 1
        self.open += word in OPEN
        if self.side * margin < self.least[0]:
            self.least = self.side * margin, np.array(point)
        return None if word == self.here or word in OPEN else word

    def first(self, points: Any) -> Point | None:
        """The first of the points that does otherwise."""
        start = self.open
        for point in points:
            if self.open - start >= TIRED:
                return None
            if self.other(point):
                return np.array(point)
        return None

    def descended(self) -> Point | None:
        """A point that does otherwise, looked for from the least margin so far by moving one number at a
        time; None where none is met before the margin falls no further."""
        for _ in range(PASSES if np.isfinite(self.least[0]) else 0):
            before = self.least[0]
            for k in range(len(self.box.places)):
                at = self.least[1]
                moved = [np.where(np.arange(len(at)) == k, value, at) for value in MOVES if value != at[k]]
                if (result := self.first(moved)) is not None:
                    return result
            if not self.least[0] < before:
                break
        return None


def by_trial(box: Box, here: Any, look: Look, reason: Reason, change: Change | None = None,
             most: int = CORNERS) -> Over:
    """Points near the middle first, along single numbers and the diagonal, where a verdict may change at
    once; then as `by_sample`. change: one that a search over arrays has found and the ordinary code has
    confirmed."""
    looks = Looks(box, here, look)
    if change is not None and change.stretch <= 1:
        return _depends(looks, reason, change.direction * change.stretch, settled=True)
    n = len(box.places)
    trial = np.concatenate([np.eye(n), -np.eye(n), np.ones((1, n)), -np.ones((1, n))])
    result = (looks.first(direction * stretch for stretch in STRETCHES for direction in trial)
             if looks.settled else None)
    return _looked(looks, reason, most) if result is None else _depends(looks, reason, result)


def by_sample(box: Box, here: Any, look: Look, reason: Reason, largest: int = CORNERS) -> Over:
    """Corners (most: so many), a search from the least margin, and points drawn at random."""
    return _looked(Looks(box, here, look), reason, largest)


def _looked(looks: Looks, reason: Reason, largest: int) -> Over:
    n, before = len(looks.box.places), looks.number
    tried = corners(n, largest)
    result = looks.first(tried) if looks.settled else None
    at_corners = looks.number - before
    result = looks.descended() if looks.settled and result is None else result
    if result is not None:
        return _depends(looks, reason, result)
    samples, places = _drawn(looks, at_corners, len(tried) == 2**n)
    if samples is None or looks.here is None:
        return Over("undecided", looks.here, reason=reason)
    other = next((word for word in places if word != looks.here and word not in OPEN), None)
    if looks.settled and other is not None:
        return _depends(looks, reason, places[other])
    reason = reason.then(samples.reason)
    agree = looks.settled and not looks.open and set(samples.counts) == {looks.here}
    return Over("sampled" if agree else "undecided", looks.here, reason=reason, samples=samples)


def _drawn(looks: Looks, at_corners: int = 0, every: bool = False) -> tuple[Sampled | None, dict[str, Point]]:
    """What points of the box drawn at random say, and a point for each verdict."""
    box = looks.box
    counts: Words = {}
    places: dict[str, Point] = {}
    margins = []
    points = np.random.default_rng(SEED).uniform(-1, 1, (SAMPLE, len(box.places)))
    for point in points[box.rigid(points)]:
        if sum(counts.get(word, 0) for word in set(OPEN)) >= TIRED:
            break
        word, margin = looks.look(point)
        if word:
            counts[word] = counts.get(word, 0) + 1
            places.setdefault(word, point)
            margins.append(margin)
    if not counts:
        return None, places
    spread = tuple(np.quantile(margins, (0.05, 0.5, 0.95)).tolist()) if np.isfinite(margins).all() else None
    return Sampled(len(margins), SEED, dict(sorted(counts.items(), key=lambda pair: -pair[1])), spread,
                   at_corners, every, looks.number - at_corners), places


def _depends(looks: Looks, reason: Reason, point: Point, settled: bool = False) -> Over:
    """The answer from a point that does otherwise, drawn towards the middle unless that is settled; with what
    points drawn at random do."""
    answer: Callable[[Point], Any] = lambda index: None if (word := looks.look(index)[0]) in OPEN else word
    size = float(np.abs(point).max())
    if not settled and size:
        result = confirmed(Change(point / size, size, 0.0), answer, looks.here)
        size, point = (result.stretch, result.direction * result.stretch) if result else (size, point)
    witnesses = tuple(Witness(answer(location), looks.box.values(location))
                      for location in (np.zeros(len(point)), point))
    samples, _ = _drawn(looks)
    reason = reason.then(samples.reason) if samples else reason
    return Over("depends", looks.here, reason=reason, changes_at=size, witnesses=witnesses, samples=samples)
