"""How far a box must be stretched until an answer changes: a search along rays from its middle.

The rays go to corners, along single numbers, against the gradient where there is one; the nearest change is then drawn nearer
by moving one number at a time. What it finds is a change that is really there, so the stretch is an upper bound of the least
one; nothing found is no proof. Seeded: the same box gives the same answer.
"""
from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import product
from typing import Any, NamedTuple, TypeAlias

import numpy as np

MOST = 100.0          # times the stated uncertainty
LADDER = np.concatenate([10.0 ** np.arange(-9, -2), 2.0 ** np.arange(-6, 7) * (MOST / 64)])
CORNERS, CHUNK = 256, 4096
HALVINGS, ROUNDS, NEAREST = 14, 4, 16
Codes: TypeAlias = Callable[[np.ndarray], np.ndarray]  # points (m, n) of a box -> what is known there as an int each, (m,)
Answer: TypeAlias = Callable[[np.ndarray], Any]  # one point of a box -> what the ordinary exact code answers there
UNKNOWN = -9          # the code of a point where there is no body, or nothing is known


class Change(NamedTuple):
    """An answer changes along `direction` (largest entry 1 in size): another at `stretch`, still the same at `before`."""

    direction: np.ndarray
    stretch: float
    before: float


def rays(n: int, favoured: Iterable[np.ndarray] = ()) -> np.ndarray:
    """Directions (rays, n) to be tried."""
    rng = np.random.default_rng(5)
    if 2**n <= CORNERS:
        corners = np.array(list(product((-1.0, 1.0), repeat=n)))
    else:
        corners = rng.choice((-1.0, 1.0), (CORNERS, n))
    single = np.concatenate([np.eye(n), -np.eye(n)])
    return np.unique(np.concatenate([*(np.reshape(f, (-1, n)) for f in favoured), single, corners]), axis=0)


def nearest_change(codes: Codes, here: int, n: int, favoured: Iterable[np.ndarray] = (), most: float = MOST) -> Change | None:
    """The nearest change found of codes(points (m, n)) -> (m,) ints from `here`; None where none is found up to `most`."""
    ladder = LADDER[LADDER <= most * 1.0001]
    directions = rays(n, favoured)
    first = _first_change(codes, here, directions, ladder)
    if not np.isfinite(first).any():
        return None
    chosen = np.argsort(first, kind="stable")[:NEAREST]
    chosen = chosen[np.isfinite(first[chosen])]
    directions, ends = directions[chosen], first[chosen]
    starts = np.array([ladder[ladder < end][-1] if (ladder < end).any() else 0.0 for end in ends])
    starts, ends = _bisected(codes, here, directions, starts, ends)
    best = int(ends.argmin())
    direction, start, end = directions[best], starts[best], ends[best]
    for _ in range(ROUNDS):
        moved = _moved(direction)
        near = codes(moved * (0.995 * end))
        moved = moved[(near != here) & (near != UNKNOWN)]
        if not len(moved):
            break
        starts, ends = _bisected(codes, here, moved, np.zeros(len(moved)), np.full(len(moved), 0.995 * end))
        best = int(ends.argmin())
        direction, start, end = moved[best], starts[best], ends[best]
    return Change(direction, float(end), float(start))


def _first_change(codes: Codes, here: int, directions: np.ndarray, ladder: np.ndarray) -> np.ndarray:
    """The first rung at which each ray has changed, inf where none."""
    points = (directions[:, None, :] * ladder[None, :, None]).reshape(-1, directions.shape[1])
    found = np.concatenate([codes(points[i:i + CHUNK]) for i in range(0, len(points), CHUNK)]).reshape(len(directions), -1)
    changed = (found != here) & (found != UNKNOWN)
    return np.where(changed.any(1), ladder[changed.argmax(1)], np.inf)


def _bisected(codes: Codes, here: int, directions: np.ndarray, starts: np.ndarray, ends: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    for _ in range(HALVINGS):
        middle = np.where(starts > 0, np.sqrt(starts * ends), ends / 2)
        found = codes(directions * middle[:, None])
        changed = (found != here) & (found != UNKNOWN)
        starts, ends = np.where(changed, starts, middle), np.where(changed, middle, ends)
    return starts, ends


def _moved(direction: np.ndarray) -> np.ndarray:
    """The ray with one number changed at a time."""
    n = len(direction)
    out = [np.where(np.arange(n) == k, value, direction) for k in range(n) for value in (-1.0, -0.5, 0.0, 0.5, 1.0)]
    return np.unique(np.array([d for d in out if np.abs(d).max() == 1.0]), axis=0)


def confirmed(change: Change, answer: Answer, here: Any, halvings: int = 20) -> Change | None:
    """The change with its stretch settled by answer(point), of any kind, that differs from `here`; None where the answer is
    still `here` a thousandth farther."""
    end = next((end for end in (change.stretch * (1 + push) for push in (0.0, 1e-9, 1e-6, 1e-4, 1e-3))
                if answer(change.direction * end) != here), None)
    if end is None:
        return None
    start = min(change.before, end)
    if answer(change.direction * start) != here:
        start = 0.0
    for _ in range(halvings):
        middle = 0.5 * (start + end)
        if middle in (start, end) or end - start <= 1e-6 * end:
            break
        start, end = (start, middle) if answer(change.direction * middle) != here else (middle, end)
    return Change(change.direction, end, start)
