"""Proofs over a whole box of bodies, by branch and bound.

Proved is that every motion of a box of bodies is bounded, or that every one spins up.

A part of the box is settled where one angle ahead stands above the energy all over it (bounded), or where no
angle of one turn does (spin-up; cells of angles, each settled on its own). What is not settled is halved
across the number that matters most to first order, until a middle contradicts the claim or the parts run out.
Bounds are those of `affine`, so a part's surplus is quadratic in its width.

Bodies are compared by the height of the potential over the energy ahead, of many bodies, or of many boxes of
bodies, at once: circles only (elliptic reduction). In the canonical variables of `reduction`, at the angle y
ahead in the torque's direction,

    excess(y) = V(theta_0 + y) - E = -mu y - dX (G (X + dX/2) + c) + d dZ - W^2/2,

with dX, dZ what X, Z change by. A motion is bounded iff excess > 0 somewhere ahead, and surely spins up where
excess < 0 all over one turn ahead, as the next turn is lower by 2 pi mu. Formulas serve floats, arrays and
`Affine` numbers."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from ...numbers.affine import EPS, Affine, lifted, root, sign_over, squared
from ...numbers.vectors import Number
from ...orbit.reduction import Reduction, reduction_about
from .boxes import Box, Point

# --- The height of the potential over the energy ahead
TURN = 2 * np.pi
# angles a turn on which the highest place ahead is looked for: the potential has two maxima a turn at most
GRID = 96
POLISH = 7  # Newton steps from there
BATCH = 2048
CELLS = 32
LEAN = 0.3  # how far, at most, the angle of a barrier leans over a part of the box
NARROW = 2.0**-40  # parts of the box as thin as this are rounding, not mechanics


class Orbit(NamedTuple):
    """X, Z, W at time 0 and the potential's coefficients, as in `reduction`."""

    x: Number
    z: Number
    w: Number
    G: Number
    c: Number
    d: Number
    mu: Number

    def turned(self, sense: int) -> Orbit:
        """Seen so that the torque of this sign points ahead (the reflection of theta)."""
        return self if sense > 0 else self._replace(x=-self.x, w=-self.w, c=-self.c, mu=-self.mu)

    def middle(self, n: int) -> Orbit:
        """The middle of every number, (n, 1)."""
        return Orbit(*(np.broadcast_to(np.reshape(lifted(v).c, (-1, 1)), (n, 1)) for v in self))


def orbit_of(r: Reduction, state: Sequence[Number], signs: Any) -> Orbit:
    """The orbit of a state (three numbers) of a reduction whose p, q have these signs all over the box."""
    sp, sq = signs
    ap, aq = sp * r.p, sq * r.q
    rp, rq = root(ap), root(aq)
    (sj, sk), (across_j, across_k) = r.centre, r.across
    # torque m: the three other terms of `Reduction.torque` cancel for a body and for the scaled system
    return Orbit(x=(state[r.j] + sj) / rp, z=(state[r.k] + sk) / (sp * rq), w=rp * rq * (state[r.axis] + r.s),
                 G=sp * r.kappa * ap * aq, c=sp * across_j * aq * rp, d=across_k * ap * rq, mu=rp * rq * r.m)


def _sin_cos(y: Number) -> tuple[Number, Number]:
    return y.sin_cos() if isinstance(y, Affine) else (np.sin(y), np.cos(y))


def excess(o: Orbit, y: Number) -> Number:
    """Height of the potential at the angle y ahead over the energy."""
    s, _ = _sin_cos(y)
    half, _ = _sin_cos(y * 0.5)
    b = -2 * squared(half)
    dx, dz = o.z * s + o.x * b, o.z * b - o.x * s
    return o.d * dz - o.mu * y - dx * (o.G * (o.x + dx * 0.5) + o.c) - squared(o.w) * 0.5


def force(o: Orbit, y: Number) -> Number:
    """The force ahead at the angle y: minus the slope of the excess."""
    x, z = _place(o, y)
    return o.mu + o.G * (x * z) + o.c * z + o.d * x


def stiffness(o: Orbit, y: Number) -> Number:
    """The slope of the force: positive at the top of a barrier."""
    x, z = _place(o, y)
    return o.G * ((z - x) * (z + x)) - o.c * x + o.d * z


def _place(o: Orbit, y: Number) -> tuple[Number, Number]:
    s, c = _sin_cos(y)
    return o.x * c + o.z * s, o.z * c - o.x * s


def highest_ahead(o: Orbit) -> tuple[np.ndarray, np.ndarray]:
    """(angle, excess) of the highest place within one turn ahead, (n,) each, for an orbit of floats (n, 1).
    """
    grid = np.arange(1, GRID + 1) * (TURN / GRID)
    heights = excess(o, grid[None])
    best = heights.argmax(1)[:, None]
    y, top = grid[best], np.take_along_axis(heights, best, 1)
    with np.errstate(all="ignore"):
        for _ in range(POLISH):
            step = -force(o, y) / stiffness(o, y)
            moved = np.clip(y + np.clip(step, -0.1, 0.1), TURN * 1e-12, TURN)
            higher = excess(o, moved)
            better = higher > top
            y, top = np.where(better, moved, y), np.where(better, higher, top)
    return y[:, 0], top[:, 0]


# --- Branch and bound
class Proof(NamedTuple):
    """holds: True (proved), False (`point` contradicts it) or None (not settled within the parts allowed).
    parts: how many were looked at. point: in the box's coordinates."""

    holds: bool | None
    parts: int
    point: Point | None = None


class Parts(NamedTuple):
    """Sub-boxes (n, places) by middle and half-width, and for each a cell of angles (n,)."""

    centres: np.ndarray
    widths: np.ndarray
    angle: np.ndarray
    reach: np.ndarray

    def some(self, chosen: np.ndarray | slice) -> Parts:
        return Parts(*(v[chosen] for v in self))

    def joined(self, other: Parts) -> Parts:
        return Parts(*(np.concatenate(pair) for pair in zip(self, other)))


# (settled, contradicted, how much each number matters)
Judge: TypeAlias = Callable[[Parts], tuple[np.ndarray, np.ndarray, np.ndarray]]


class Family:
    """The reduced motions of a box: `orbit(parts)` over sub-boxes, `points` for single ones."""

    def __init__(self, box: Box, axis: int, signs: Any) -> None:
        self.box, self.axis, self.signs = box, axis, signs

    def orbit(self, centres: np.ndarray, widths: np.ndarray, stretch: float = 1.0,
              cells: Any = None) -> tuple[Orbit, np.ndarray]:
        """(the orbit over each part, True for each part that holds no body)."""
        with np.errstate(all="ignore"):
            numbers = self.box.numbers(centres, widths, stretch, cells)
            reduction: Any = reduction_about(self.box.rates(numbers), self.axis)
            return (orbit_of(reduction, numbers["state"], self.signs),
                    np.broadcast_to(self.box.impossible(numbers), len(centres)))

    def margins(self, points: np.ndarray, stretch: float = 1.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(margin, sense, possible) of each point (n, places), in floats: highest excess ahead; the torque's
        sign."""
        orbit, none = self.orbit(points, np.zeros_like(points), stretch)
        flat = orbit.middle(len(points))
        sense = np.where(flat.mu[:, 0] < 0, -1, 1)
        towards = sense[:, None]
        ahead = Orbit(flat.x * towards, flat.z, flat.w * towards, flat.G, flat.c * towards, flat.d,
                      flat.mu * towards)
        with np.errstate(all="ignore"):
            margin = highest_ahead(ahead)[1]
        return margin, sense, ~none & np.isfinite(margin)


def prove(family: Family, claim: str, senses: Any, stretch: float = 1.0, largest: int = 20_000) -> Proof:
    """Whether "bounded" or "spin-up" holds all over the box stretched by `stretch`, for torques of these
    senses."""
    looked = 0
    for sense in senses:
        result = (_bounded if claim == "bounded" else _spin_up)(family, sense, stretch, largest - looked)
        looked += result.parts
        if not result.holds:
            return result._replace(parts=looked)
    return Proof(True, looked)


def whole(box: Box, cells: int = 1) -> Parts:
    """The whole box, and one turn ahead in so many cells."""
    n = len(box.places)
    half = (TURN * (1 + 1e-9)) / (2 * cells)
    return Parts(np.zeros((cells, n)), np.ones((cells, n)), half * (2 * np.arange(cells) + 1),
                 np.full(cells, half))


def branch_and_bound(start: Parts, judge: Judge, largest: int) -> Proof:
    """Branch and bound: judge(parts) -> (settled, contradicted, across): how much each number, and last the
    angle, matters."""
    waiting, looked = start, 0
    while len(waiting.angle):
        batch, waiting = waiting.some(slice(-BATCH, None)), waiting.some(slice(None, -BATCH))
        looked += len(batch.angle)
        with np.errstate(all="ignore"):
            settled, against, weights = judge(batch)
        if against.any():
            return Proof(False, looked, tuple(batch.centres[np.flatnonzero(against)[0]].tolist()))
        left = batch.some(~settled)
        if looked > largest or (len(left.angle) and float(left.widths.max()) < NARROW):
            return Proof(None, looked)
        waiting = waiting.joined(_halved(left, weights[~settled]))
    return Proof(True, looked)


def _halved(parts: Parts, weights: np.ndarray) -> Parts:
    """Each part cut in two across the number, or the angle (last), that matters most."""
    n = parts.centres.shape[1]
    side = np.nan_to_num(weights, nan=0.0, posinf=1e299).argmax(1)
    rows = np.arange(len(side))
    step, turn = np.zeros_like(parts.widths), np.where(side == n, parts.reach / 2, 0.0)
    numbers = rows[side < n]
    step[numbers, side[numbers]] = parts.widths[numbers, side[numbers]] / 2
    halves = [Parts(parts.centres + s * step, parts.widths - step, parts.angle + s * turn, parts.reach - turn)
              for s in (-1, 1)]
    return halves[0].joined(halves[1])


def importance(slopes: np.ndarray, rest: np.ndarray, widths: np.ndarray) -> np.ndarray:
    """How much each number matters (n, places): its first-order share, and a like share of what is of higher
    order; where the bound is undefined, the width alone."""
    fraction = np.abs(slopes) + widths * (rest / widths.shape[1])[:, None]
    return np.where(np.isfinite(fraction).all(1, keepdims=True), fraction, widths)


def _slack(m: Orbit, angle: Number) -> np.ndarray:
    """What rounding may do to an excess of floats (n, 1)."""
    radius = np.abs(m.x) + np.abs(m.z)
    waves = (np.abs(m.G) * radius + np.abs(m.c) + np.abs(m.d)) * radius
    return (1e3 * EPS * (np.abs(m.mu) * angle[:, None] + waves + m.w * m.w))[:, 0]


def _bounded(family: Family, sense: int, stretch: float, largest: int) -> Proof:
    """A place ahead above the energy all over a part: the top of the middle's barrier, fixed, or moved with
    the numbers as the top moves to first order, which may cost more than it gives where the top is flat."""
    def judge(parts: Parts) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        orbit, none = family.orbit(parts.centres, parts.widths, stretch)
        orbit = orbit.turned(sense)
        middle = orbit.middle(len(none))
        angle, top = highest_ahead(middle)
        at_top = Affine(angle, np.zeros((1, 1)), np.zeros(1))
        push, stiff = lifted(force(orbit, at_top)), stiffness(middle, angle[:, None])
        lean = np.where(stiff > 0, -push.g / stiff, 0.0)
        room = np.minimum(LEAN, angle / 4)[:, None] / np.maximum(np.abs(lean).sum(1, keepdims=True), 1e-300)
        leaning = Affine(angle, np.nan_to_num(lean * np.minimum(1.0, room)), np.zeros(1))
        moved, fixed = lifted(excess(orbit, leaning)), lifted(excess(orbit, at_top))
        better = fixed.low > moved.low
        settled = (np.maximum(moved.low, fixed.low) > 0) | none
        against = ~none & (top < -_slack(middle, angle)) & (middle.mu[:, 0] > 0)
        slopes: np.ndarray = np.where(better[:, None], fixed.g, moved.g)
        rest: Any = np.where(better, fixed.e, moved.e)
        return settled, against, np.hstack([importance(slopes, rest, parts.widths),
                                            np.full((len(angle), 1), -1.0)])
    return branch_and_bound(whole(family.box, 1), judge, largest)


def _spin_up(family: Family, sense: int, stretch: float, largest: int) -> Proof:
    """No place of one turn ahead reaches the energy; next to the state a force ahead says so."""
    def judge(parts: Parts) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        orbit, none = family.orbit(parts.centres, parts.widths, stretch, cells=True)
        orbit = orbit.turned(sense)
        g = np.zeros((len(none), len(family.box.places) + 1))
        g[:, -1] = parts.reach
        angle = Affine(parts.angle, g, 8 * EPS * parts.angle)
        height, torque = lifted(excess(orbit, angle)), sign_over(orbit.mu)
        first = (parts.angle - parts.reach <= 1e-12 * parts.reach) & (lifted(force(orbit, angle)).low > 0)
        settled = none | ((torque > 0) & ((height.high < 0) | first))
        m = orbit.middle(len(none))
        against = ~none & (excess(m, parts.angle[:, None])[:, 0] > _slack(m, parts.angle))
        against |= ~none & (m.mu[:, 0] < 0)
        weights = np.hstack([importance(height.g[:, :-1], height.e, parts.widths), np.abs(height.g[:, -1:])])
        radius2 = m.x * m.x + m.z * m.z
        bend = np.abs(m.G) * radius2 + (np.abs(m.c) + np.abs(m.d)) * np.sqrt(radius2)
        by_angle = weights[:, -1] + (0.5 * parts.reach**2) * bend[:, 0]
        weights[:, -1] = np.where(by_angle >= np.abs(height.g[:, :-1]).sum(1), 1e300, -1.0)
        unsure = (torque == 0) & (height.high < 0)  # only the torque's sign is open
        if unsure.any():
            weights[unsure] = np.hstack([np.abs(lifted(orbit.mu).g)[unsure][:, :-1],
                                         np.full((int(unsure.sum()), 1), -1.0)])
        return settled, against, weights
    return branch_and_bound(whole(family.box, CELLS), judge, largest)
