"""The branches of a separatrix in plain floats: coarse, while a slider moves and in a browser without NumPy.

Saddles, loops and heights are those of `branches`, which grades its rows and columns by the bend; here rows
are dense towards the fold and columns towards both ends of a loop.
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ...physics.coefficients import effective
from ...physics.scene import AnyScene
from ..conic import conic_of
from ..potential import potential
from ..reduction import reduce
from .homoclinic import loop_end, settled
from .saddles import NO_REDUCTION, limit_of, saddle_branches, what_it_parts, why_none, why_parabolic

REACH = 4.0  # as of `branches.separatrix`


@dataclass(frozen=True)
class PlainBranch:
    """points: rows x columns places, row by row from the fold outward, each once round a loop from the saddle
    back to it."""

    name: str
    rows: int
    columns: int
    points: list[tuple[float, ...]]


def plain_separatrix(scene: AnyScene, reach: float = REACH, rows: int = 20,
                     half: int = 21) -> tuple[tuple[PlainBranch, ...], str]:
    """(branches, what they part or why there are none) of a scene; reach: as of `separatrix`; half: columns
    from the saddle to the far end of a loop."""
    r = reduce(effective(scene))
    if r is None:
        return (), NO_REDUCTION
    if not r.geometry.centred:
        return (), why_parabolic(r)
    try:
        pot, conic = potential(r), conic_of(r)
        branches = saddle_branches(conic, pot, limit_of(conic, reach))
    except (ArithmeticError, ValueError):
        return (), "the numbers of this scene are beyond what doubles hold of its surface"
    found = []
    for number, branch in enumerate(branches, 1):
        strips = [(word, points) for side,
                  word in conic.sides(r.sense) if len(points := _strip(r, pot, branch, side, rows, half)) > 1]
        found += [PlainBranch(f"branch {number}{word if len(strips) > 1 else ''}", len(points), 2 * half - 1,
                             sum(points, [])) for word, points in strips]
    return tuple(found), what_it_parts(pot, r.sense) if found else why_none(conic, r.sense)


def _strip(r: Any, pot: Any, branch: Any, side: int, rows: int, half: int) -> list[list[tuple[float, ...]]]:
    """The loops of a branch on one side, a row each; the fold is a point."""
    made = []
    for n in range(rows):
        s = (n / (rows - 1)) ** 2
        saddle = tuple(map(float, branch.place(s)))
        saddle = settled(pot, saddle) if n else saddle
        found = loop_end(pot, r.sense, saddle, side)
        if found and not (found[2] and side > 0):
            made.append(_loop(r, pot, saddle, side * found[0], half))
        elif n == 0:
            made.append([_state(r, pot, saddle, 0.0)] * (2 * half - 1))
    return made


def _loop(r, pot, saddle, end, half):
    """The places of one loop: out above the saddle's rate, and back mirrored below."""
    out, back = [], []
    for n in range(half):
        y = end * (1 - math.cos(math.pi * n / (half - 1))) / 2
        w = math.sqrt(2 * max(-pot.rise(y, saddle), 0.0)) if 0 < n < half - 1 else 0.0
        place = pot.move(saddle, y)
        out.append(_state(r, pot, place, w))
        back.append(_state(r, pot, place, -w))
    return out + back[-2::-1]


def _state(r, pot, place, w):
    x, z = pot.xz(place)
    state = [0.0] * 3
    state[r.j], state[r.k], state[r.axis] = float(r.component_j(x)), float(r.component_k(z)), float(
        r.component_i(w))
    return tuple(state)
