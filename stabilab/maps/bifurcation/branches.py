"""The branches of a diagram as rows of points to be drawn or tabulated: each point solved by itself, dense where two branches meet."""
from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from ...numbers.balls import Unclear, rational, settled
from ...numbers.vectors import Float3
from .choice import chosen
from .eliminated import Eliminated
from .parts import Part, followed, parts
from .result import Diagram, Piece
from .verdicts import ball_form, state_of

POINTS = 64  # of a branch, closer towards both ends as a fold's parabola needs it


@dataclass(frozen=True)
class Branch:
    """A branch of one piece, or of a part of it between seams: rows (value, state in the case's variables), the verdict that all of it has, and which
    branch of which piece it is."""

    piece: int
    number: int
    verdict: str
    values: tuple[float, ...]
    states: tuple[Float3, ...]


def branches(diagram: Diagram, points: int = POINTS) -> list[Branch]:
    """Every branch of every piece."""
    system = chosen(diagram.family, diagram.kind == "borders")[2]
    if system is None:
        return []
    eliminated = Eliminated(diagram.family, system)
    return [branch for n, piece in enumerate(diagram.pieces) if piece.count for branch in _of_piece(diagram, eliminated, n, piece, points)]


def _of_piece(diagram: Diagram, eliminated: Eliminated, n: int, piece: Piece, points: int) -> Iterator[Branch]:
    """The branches of a piece, each part of it by itself; a branch keeps its number across a seam."""
    numbers, last = list(range(piece.count)), None
    for part in parts(diagram.family, diagram.kind, eliminated, piece):
        rows = [(float(value), states) for value in _spread(part, points) if (states := _solved(diagram, eliminated, value, piece.count)) is not None]
        if rows and last is not None:
            numbers = [numbers[k] for k in followed(last, rows[0][1])]
        for place, number in enumerate(numbers):
            yield Branch(n, number, part.states[place].verdict, tuple(value for value, _ in rows), tuple(states[place] for _, states in rows))
        last = rows[-1][1] if rows else last


def _spread(part: Part, points: int) -> list[Fraction]:
    """Values inside, ends left out."""
    low, high = Fraction(part.low), Fraction(part.high)
    shares = [Fraction(0.5 - 0.5 * math.cos(math.pi * k / points)) for k in range(1, points)]
    ends = [Fraction(1, 10**6), 1 - Fraction(1, 10**6)]
    return sorted(low + (high - low) * share for share in {*shares, *ends})


def _solved(diagram: Diagram, eliminated: Eliminated, value: Fraction, count: int) -> list[Float3] | None:
    try:
        states = settled(lambda digits: [_state(diagram, root.y, value) for root in eliminated.at_general((value,))], most=1024)
    except Unclear:
        return None
    return states if len(states) == count else None


def _state(diagram: Diagram, y, value: Fraction) -> Float3:
    u = ball_form(diagram.family, [rational(value)])[1] if diagram.family.scaled else []
    return tuple(float(v.mid()) + 0.0 for v in state_of(diagram.family, y, u))
