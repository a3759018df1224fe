"""The parts of a piece in which branches keep their order: branches are numbered by one component, and two may pass one above the other."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial

from ...numbers.balls import settled
from ...numbers.vectors import Float3
from .critical import between
from .eliminated import Eliminated
from .family import Family
from .result import Piece, State
from .verdicts import general_states


@dataclass(frozen=True)
class Part:
    """low, high: its ends, an end of the piece or a seam; states: the equilibria at a value inside, in the order of this part."""

    low: float
    high: float
    states: tuple[State, ...]


def parts(family: Family, kind: str, eliminated: Eliminated, piece: Piece) -> list[Part]:
    """The parts between the seams of a piece, rising."""
    ends = (piece.low, *piece.seams, piece.high)
    out = []
    for low, high in zip(ends, ends[1:]):
        inside = low < piece.sample < high
        states = piece.states if inside else settled(partial(general_states, family, kind, eliminated, between(Fraction(low), Fraction(high))))
        out.append(Part(low, high, states))
    return out


def followed(before: Sequence[Float3], after: Sequence[Float3]) -> list[int]:
    """For each state after a seam the place of the one before it that it goes on from: the nearest."""
    apart = sorted((sum((u - v) ** 2 for u, v in zip(a, b)), n, k) for n, a in enumerate(after) for k, b in enumerate(before))
    found: dict[int, int] = {}
    for _, n, k in apart:
        if n not in found and k not in found.values():
            found[n] = k
    return [found[n] for n in range(len(after))]
