"""Seams of a branch: where the loop of a saddle reaches a second saddle as high, behind which it opens a
second well.

At the seam the far end of the loop jumps: on one side the loop turns back before the second saddle, on the
other it passes over it. The branch is smooth on both sides, W^2 = 2 (V_saddle - V) being a saddle surface
itself next to the second saddle, but rows of a grid are level curves of it: they must crowd towards the seam
like squares, and columns towards the second saddle, where loops are pinched. So a strip is cut there, and
each part graded by itself.
"""
from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from .homoclinic import loop_end, others, settled

# of its length, by which a loop grows at least where a seam is; so near to it a smooth far end moves by less
# than a millionth
JUMP = 1e-3
# halvings, after which a smooth far end, which begins like a root of s, moves by a quarter of JUMP at most
# between the ends
LOOK = 24
BEGIN = 1e-9   # s next to the fold
# of s: so far from the seam the second saddle's height is known beside the first one's, and the parts' edges
# lie within a millionth of the loop
BESIDE = 1e-12
PINCH = 0.02      # of a lobe's length: no bend at the second saddle is resolved below


class Part(NamedTuple):
    """The rows low <= s <= high of a branch's loops on one side; seam: -1 where `low` is one, +1 where `high`
    is, 0 without; over: whether the loops pass over a second saddle. number: of the part among those of its
    strip, 0 for a whole one."""

    branch: Any
    side: int
    low: float = 0.0
    high: float = 1.0
    seam: int = 0
    over: bool = False
    number: int = 0

    def rows(self, t):
        """s at parameters t in [0, 1], of which the distance from the seam is the square; without a seam they
        are s itself."""
        if not self.seam:
            return t
        return (self.low + (self.high - self.low) * t * t if self.seam < 0
                else self.high - (self.high - self.low) * (1 - t) ** 2)

    def parameters(self, s):
        """t at rows s: the inverse of `rows`."""
        if not self.seam:
            return s
        share = np.clip((np.asarray(s) - self.low) / (self.high - self.low), 0.0, 1.0)
        return np.sqrt(share) if self.seam < 0 else 1 - np.sqrt(1 - share)


def parted(land, strips, first) -> list[Part]:
    """The parts of strips, pairs (branch, side), whose rows begin at first (k,)."""
    found = []
    for (branch, side), start in zip(strips, first):
        seam = seam_of(land, branch, side)
        if seam is None or not start < seam[0]:
            found.append(Part(branch, side))
            continue
        before, behind, over = seam
        found += [Part(branch, side, float(start), before, 1, over < 0, 1),
                  Part(branch, side, behind, 1.0, -1, over > 0, 2)]
    return found


def seam_of(land, branch, side) -> tuple[float, float, int] | None:
    """(s just before the seam of a strip, s just behind it, +1 where loops pass over the second saddle behind
    it, -1 where before), or None.

    Circles with a torque alone have seams. Where the second saddle appears below the first one's height, no
    far end jumps, and there is none.
    """
    if len(land.conic.sides(land.sense)) > 1:
        return None
    low, high, pot = BEGIN, 1.0, land.potential
    before, behind = (_passes(pot, branch, side, s) for s in (low, high))
    if before == behind:
        return None
    halvings = 0
    while low < (middle := 0.5 * (low + high)) < high:
        low, high = (middle, high) if _passes(pot, branch, side, middle) == before else (low, middle)
        halvings += 1
        if halvings == LOOK and not _jumps(land, branch, side, low, high):
            return None  # as of most strips: the second half of the halvings is for seams alone
    low, high = low * (1 - BESIDE), high * (1 + BESIDE)
    return (low, high, 1 if behind else -1) if high < 1 and _jumps(land, branch, side, low, high) else None


def _jumps(land, branch, side, low, high) -> bool:
    """Whether the far end of the loop jumps between two rows."""
    ends = [_far_end(land, branch, side, s) for s in (low, high)]
    return abs(ends[1] - ends[0]) > JUMP * max(ends)


def _far_end(land, branch, side, s) -> float:
    saddle = settled(land.potential, tuple(map(float, branch.place(s))))
    found = loop_end(land.potential, land.sense, saddle, side)
    return found[0] if found else 0.0


def _passes(pot, branch, side, s) -> bool:
    """Whether a loop passes over a second saddle: the first one ahead is below its own."""
    saddle = settled(pot, tuple(map(float, branch.place(s))))
    ahead = _barrier(pot, saddle, side)
    return ahead is not None and pot.rise(side * ahead, saddle) < 0


def pinched_shares(pot, saddle, end, side, u):
    """(n, m) shares of the way to the far ends (n,) at which columns u (m,), 0 to 1, stand: half of them
    before the second saddle and half behind it, crowded towards it as hyperbolas W^2 = K (e^2 + t^2) at
    distance t bend, with e the half width of the pinch; towards the far end as a parabola bends.

    saddle: (2, n).
    """
    rows = [_second(pot, place, side, abs(far)) for place,
            far in zip(zip(*(v.tolist() for v in saddle)), end.tolist())]
    at, width = np.array(rows).T[:, :, None]
    whole, v = np.abs(end)[:, None], np.clip(2 * u, 0, 1)
    behind, v2 = whole - at, np.clip(2 * u - 1, 0, 1)
    first = _crowded(1 - v, np.maximum(width / at, PINCH))
    second = _crowded(1 - (1 - v2) ** 2, np.maximum(width / behind, PINCH))
    shares = np.where(u <= 0.5, at * (1 - first), at + behind * second) / whole
    shares[:, 0], shares[:, -1] = 0.0, 1.0  # exactly, as the ends are
    return shares


def _crowded(x, width):
    """Shares x in [0, 1] moved towards 0, as sinh(q x)/sinh(q) with width sinh(q) = 1."""
    q = np.arcsinh(1 / width)
    return np.sinh(q * x) * width


def _second(pot, saddle, side, end):
    """(distance of the second saddle, half width of the pinch there); without one the middle of the loop, and
    no pinch."""
    t = _barrier(pot, saddle, side)
    if t is None or not t < end:
        return 0.5 * end, end
    return t, max(-2 * float(pot.rise(side * t, saddle)) / pot.slope(pot.move(saddle, side * t)), 0.0) ** 0.5


def _barrier(pot, saddle, side):
    """The distance to the first barrier on one side of a saddle; None where there is none within a turn."""
    return next((t for t in others(pot, saddle, side) if pot.slope(pot.move(saddle, side * t)) > 0), None)
