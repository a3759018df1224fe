"""The phase plane of the motion from one state, in plain floats: heights of the reduced potential from which a page draws every level curve.

`orbit.phase_plane` has the same plane in arrays, to the last digit; this one serves a hand that moves, and a browser without NumPy.
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ...orbit.potential import potential
from ...orbit.reduction import Reduction, reduce
from ...physics.scene import AnyScene

POINTS = 361  # of the potential across the picture
CIRCLE = 1.35 * math.pi  # half of what is shown of a circle
LIFT, CELLAR, FARTHEST = 2.5, 6.0, 12.0  # of walls: heights above and below the motion's that are worth drawing, and how far to look for them
HALVINGS = 48
NEAREST, GROWTH = 1e-4, 1.1  # of the steps outward


@dataclass(frozen=True)
class Plane:
    """turn: of the body about the axis of the torque since the start (rad, or scaled), at `low` to `high` of the canonical angle in even steps;
    heights: V there, 0 at the start; W0: the canonical rate at the start. unit: turn per canonical angle."""

    reduction: Reduction
    potential: Any
    place: tuple[float, float]
    W0: float
    unit: float
    y: list[float]
    heights: list[float]
    rests: list[tuple[float, float, bool]]  # canonical angle, V, whether it is a saddle

    def rate(self, W: float) -> float:
        """omega_i of canonical W."""
        if not self.reduction.geometry.centred:
            return W - float(self.reduction.s)
        return float(self.reduction.component_i(W))

    def canonical(self, rate: float) -> float:
        """W of omega_i."""
        w = rate + float(self.reduction.s)
        return w * self.reduction.constants["flip"] * self.reduction.constants["n"] if self.reduction.geometry.centred else w

    def state(self, turn: float, rate: float) -> tuple[float, ...]:
        """The three rates of a point of the plane."""
        r, out = self.reduction, [0.0] * 3
        place = self.potential.move(self.place, turn / self.unit)
        if r.geometry.centred:
            x, z = self.potential.xz(place)
            place = r.component_j(x), r.component_k(z)
        out[r.j], out[r.k] = place
        out[r.axis] = rate
        return tuple(map(float, out))


def plane_of(scene: AnyScene, state: tuple[float, ...]) -> Plane | None:
    """The plane of the motion from a state; None where the scene does not reduce."""
    r = reduce(scene)
    if r is None:
        return None
    pot, place, W0, unit = potential(r), *_start(r, state)
    force = pot.force(place)
    height = lambda y: pot.rise(float(y), place, force)
    low, high = _walls(pot, place, height, W0) if r.geometry.walled else _round(pot, place)
    y = [low + (high - low) * n / (POINTS - 1) for n in range(POINTS)]
    rests = [(at, height(at), pot.slope(pot.move(place, at)) > 0) for at in _rests(pot, place, y)]
    return Plane(r, pot, place, W0, unit, y, [height(v) for v in y], rests)


def _start(r: Reduction, state: tuple[float, ...]) -> tuple[tuple[float, float], float, float]:
    """(place, W, turn per canonical angle)."""
    if not r.geometry.centred:
        return (float(state[r.j]), float(state[r.k])), float(state[r.axis]) + float(r.s), 1.0
    x, z, w = r.canonical_exact(state)
    first, second = r.geometry.place(x, z)
    return (float(first), float(second)), float(w), r.constants["flip"] / r.constants["n"]


def _round(pot, place):
    """What is shown of a circle: about the middle of the equilibria within half a turn."""
    found = list(_rests(pot, place, [-math.pi + 2 * math.pi * n / POINTS for n in range(POINTS + 1)]))
    middle = sum(found) / len(found) if found else 0.0
    return middle - CIRCLE, middle + CIRCLE


def _rests(pot, place, y):
    """Where the force vanishes: between places of opposite signs, halved; nothing where it vanishes everywhere."""
    force = lambda v: pot.force(pot.move(place, v))
    values = [force(v) for v in y]
    for n in range(len(y) - 1 if any(values) else 0):
        if values[n] * values[n + 1] < 0 or values[n] == 0:
            low, high, below = y[n], y[n + 1], values[n] < 0
            for _ in range(HALVINGS if values[n] else 0):
                middle = 0.5 * (low + high)
                low, high = (middle, high) if (force(middle) < 0) == below else (low, middle)
            yield low


def _walls(pot, place, height, W0):
    """How far on each side the potential of a hyperbola or parabola is worth drawing."""
    out = [NEAREST * GROWTH**n for n in range(math.ceil(math.log(FARTHEST / NEAREST, GROWTH)) + 1)]
    marks = [0.0, *_rests(pot, place, [*(-y for y in reversed(out)), 0.0, *out])]
    heights = [height(y) for y in marks]
    least = min(heights)
    lift = max(W0 * W0 / 2 - least, max(heights) - least) or 1.0
    return tuple(_side(height, edge, sense, least + LIFT * lift, least - CELLAR * lift) for edge, sense in ((min(marks), -1), (max(marks), 1)))


def _side(height, edge, sense, ceiling, cellar):
    step = NEAREST
    while step < FARTHEST and cellar < height(edge + sense * step) < ceiling:
        step *= GROWTH
    return edge + sense * step
