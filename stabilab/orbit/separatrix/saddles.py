"""The saddles of a separatrix as branches, why a scene has none, and a coarse surface in plain floats.

Each branch runs from its fold outward, and gives its places for floats and arrays alike. The coarse surface
is for a slider that moves, and for a browser without NumPy.

Saddles, loops and heights are those of `branches`, which grades its rows and columns by the bend; here rows
are dense towards the fold and columns towards both ends of a loop."""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

from ...numbers.polynomial import roots_in_doubles
from ...physics.coefficients import effective
from ...physics.scene import AnyScene
from ...reasons import Reason, Sentence
from ..conic import Conic, Line, Piece, conic_of
from ..potential import Circle, Hyperbola, potential
from ..reduction import Reduction, reduce
from .homoclinic import loop_end, settled

if TYPE_CHECKING:
    import numpy as np

# --- Branches of saddles
ON_PLANE = 1e-9  # of a branch's first invariant: below that its end lies on a plane Q = 0
OPEN, FOLD, PLANE = "open", "fold", "plane"


class Branch(NamedTuple):
    """Saddles for s in [0, 1], s = 0 at the fold (on a line at its inner end), in h along a piece of the
    hyperbola or in t along a line. far: what the branch ends in at s = 1, the limit (OPEN), another FOLD or
    an invariant PLANE Q = 0."""

    conic: Any
    line: Any  # None on the hyperbola
    start: float
    end: float
    far: str

    def at(self, s: float | np.ndarray):
        """(X, Z) of the saddle, a float or an array each."""
        t = self.start + (self.end - self.start) * s
        return self.conic.at(t) if self.line is None else on_line(self.line, t)

    def place(self, s: float | np.ndarray):
        """The same as a place of the reduced potential."""
        return self.conic.place(*self.at(s))


def limit_of(conic: Conic, reach: float) -> float:
    """The size of the invariant at `reach` times the radius sqrt|Q| of the outermost fold, or of the lines'
    feet."""
    base = [abs(q) for q in conic.fold_invariants]
    for line in conic.lines:
        x, z = on_line(line, foot(conic, line))
        base.append(abs(z * z - conic.e * x * x) or abs(conic.K / conic.G if conic.G and conic.K else 1.0))
    return max(base, default=1.0) * reach * reach


@lru_cache(maxsize=64)
def saddle_branches(conic: Conic, pot: Circle | Hyperbola, limit: float) -> tuple[Branch, ...]:
    """Return every branch of saddles of a conic of equilibria, as far out as |Q| = limit. They are kept, for
    the next surface of the same scene."""
    rows = [branch for piece in conic.pieces if piece.barrier for branch in _on_piece(conic, piece, limit)]
    for line in conic.lines:
        rows += [Branch(conic, line, start, end, OPEN) for start, end in _on_line(conic, pot, line, limit)]
    return tuple(rows)


def on_line(line: Line, t: float | np.ndarray):
    return line.x0 + t * line.dx, line.z0 + t * line.dz


def foot(conic: Conic, line: Line) -> float:
    """Return the place along a line at which the invariant is stationary."""
    a = line.dz**2 - conic.e * line.dx**2
    return -(line.z0 * line.dz - conic.e * line.x0 * line.dx) / a if a else 0.0


def _on_piece(conic: Conic, piece: Piece, limit: float):
    """Branches of a piece inside the limit on |Q|, starting at a fold, cut where Q = 0 (a plane)."""
    ends = [h for q in conic.within(limit) for h in _meet(conic, piece, q)]
    inner = piece.inner or min(ends, default=None)
    outer = piece.outer if math.isfinite(piece.outer) else max(ends, default=None)
    if inner is None or outer is None or not inner < outer:
        return
    cuts = [inner, *(h for q in conic.planes for h in _meet(conic, piece, q) if inner < h < outer), outer]
    folds = {piece.inner, piece.outer}
    for low, high in zip(cuts, cuts[1:]):
        start, end = (high, low) if high == piece.outer else (low, high)
        on_plane = (conic.planes and abs(conic.invariant(piece.sign * end)) < ON_PLANE
                    * abs(conic.invariant(piece.sign * start)))
        yield Branch(conic, None, piece.sign * start, piece.sign * end,
                     PLANE if on_plane else FOLD if end in folds else OPEN)


def _meet(conic: Conic, piece: Piece, q: float) -> list[float]:
    """|h| on a piece where the invariant is q: Z^2 - e X^2 = q times h^2, a quartic."""
    e, s, G = conic.e, conic.shift, conic.G
    c, K = conic.c / G, conic.K / G
    roots = roots_in_doubles([1.0, -2 * s, s * s - e * c * c - q, 2 * e * K * c, -e * K * K])
    return sorted(abs(h) for h in roots if h * piece.sign > 0 and piece.inner < abs(h) < piece.outer)


def _on_line(conic: Conic, pot: Circle | Hyperbola, line: Line, limit: float):
    """Intervals of t on a line where it holds saddles, each from its inner end outward."""
    knots = [foot(conic, line)]
    if conic.G:  # where the two lines cross
        knots.append(-conic.d / conic.G - line.z0 if line.dz else -conic.c / conic.G - line.x0)
    far = (2 * math.sqrt(limit) + abs(line.x0)
           + abs(line.z0)) / math.hypot(line.dx, line.dz) + max(map(abs, knots))
    knots = sorted({-far, *knots, far})
    for low, high in zip(knots, knots[1:]):
        if pot.slope(conic.place(*on_line(line, 0.5 * (low + high)))) > 0:
            yield (low, high) if abs(low) < abs(high) else (high, low)


# --- What a separatrix parts, or why there is none, in words
NO_REDUCTION = Sentence(
    "separatrix-without-reduction",
    "without a reduction to one degree of freedom the separatrix of this scene is not known in closed form")()
PARTS_ONE_FROM_TWO = Sentence(
    "separatrix-parts-one-from-two",
    "both sides of each branch are bounded: it parts oscillations about one centre from those around two")()
PARTS_INSIDE_FROM_OUTSIDE = Sentence(
    "separatrix-parts-inside-from-outside",
    "both sides of each branch are bounded: inside motions oscillate about a centre, outside about more of "
    "them or right round the axis")()
BOUNDS_OSCILLATIONS = Sentence(
    "separatrix-bounds-oscillations",
    "each branch bounds the motions that oscillate about the centres inside it")()
SINGLE_WELLS = Sentence(
    "no-separatrix-single-wells",
    "no equilibrium is a saddle of the reduced potential, each orbit has a single well, and there is no "
    "separatrix surface")()
NO_FORCE = Sentence(
    "no-separatrix-no-force",
    "no force acts along any orbit: the rate about the axis of symmetry is constant, and there is no saddle "
    "and no separatrix surface")()
NO_EQUILIBRIUM = Sentence(
    "no-separatrix-no-equilibrium",
    "there is no equilibrium, so there is no saddle and no separatrix surface")()
SURFACE_BEYOND_DOUBLES = Sentence(
    "surface-beyond-doubles",
    "the numbers of this scene are beyond what doubles hold of its surface")()
PARABOLIC = Sentence(
    "no-separatrix-parabolic", "parabolic reduction ({where}): {motions}; no branch bounds a spin-up")
ALL_BOUNDED = Sentence("parabolic-no-torque", "no torque acts, and every motion is bounded")()
ALL_BETWEEN_WALLS = Sentence(
    "parabolic-walls",
    "all motions are bounded by walls on both sides, except pure spin about the torque")()
ALL_SPIN_UP = Sentence(
    "parabolic-spin-up", "nothing turns the body out of the torque's way, and every motion spins up")()


def what_it_parts(potential: Circle | Hyperbola, sense: int) -> Reason:
    """Of a scene with a separatrix."""
    if potential.walled:
        return PARTS_ONE_FROM_TWO
    return BOUNDS_OSCILLATIONS if sense else PARTS_INSIDE_FROM_OUTSIDE


def why_none(conic: Conic, sense: int) -> Reason:
    """Of a scene on circles or hyperbolas without one."""
    if conic.pieces or conic.lines:
        return SINGLE_WELLS
    return NO_EQUILIBRIUM if sense else NO_FORCE


def why_parabolic(reduction: Reduction) -> Reason:
    """Of a scene on parabolas: no branches are drawn of it."""
    bent = reduction.kappa or reduction.rho or reduction.sigma
    motions = ALL_BOUNDED if reduction.sense == 0 else ALL_BETWEEN_WALLS if bent else ALL_SPIN_UP
    return PARABOLIC(where=reduction.geometry.where, motions=motions)


# --- A coarse surface in plain floats
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
                     half: int = 21) -> tuple[tuple[PlainBranch, ...], Reason]:
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
        return (), SURFACE_BEYOND_DOUBLES
    result = []
    for number, branch in enumerate(branches, 1):
        strips = [(word, points) for side,
                  word in conic.sides(r.sense) if len(points := _strip(r, pot, branch, side, rows, half)) > 1]
        result += [PlainBranch(f"branch {number}{word if len(strips) > 1 else ''}", len(points), 2 * half - 1,
                             sum(points, [])) for word, points in strips]
    return tuple(result), what_it_parts(pot, r.sense) if result else why_none(conic, r.sense)


def _strip(r: Reduction, pot: Circle, branch: Branch, side: int, rows: int,
           half: int) -> list[list[tuple[float, ...]]]:
    """The loops of a branch on one side, a row each; the fold is a point."""
    built = []
    for n in range(rows):
        s = (n / (rows - 1)) ** 2
        saddle = tuple(map(float, branch.place(s)))
        saddle = settled(pot, saddle) if n else saddle
        result = loop_end(pot, r.sense, saddle, side)
        if result and not (result[2] and side > 0):
            built.append(_loop(r, pot, saddle, side * result[0], half))
        elif n == 0:
            built.append([_state(r, pot, saddle, 0.0)] * (2 * half - 1))
    return built


def _loop(r: Reduction, pot: Circle, saddle: Sequence[float], end: float, half: int):
    """The places of one loop: out above the saddle's rate, and back mirrored below."""
    out, back = [], []
    for n in range(half):
        y = end * (1 - math.cos(math.pi * n / (half - 1))) / 2
        w = math.sqrt(2 * max(-pot.rise(y, saddle), 0.0)) if 0 < n < half - 1 else 0.0
        location = pot.move(saddle, y)
        out.append(_state(r, pot, location, w))
        back.append(_state(r, pot, location, -w))
    return out + back[-2::-1]


def _state(r: Reduction, pot: Circle, location: Sequence[float], w: float):
    x, z = pot.xz(location)
    state = [0.0] * 3
    state[r.j], state[r.k], state[r.axis] = float(r.component_j(x)), float(r.component_k(z)), float(
        r.component_i(w))
    return tuple(state)
