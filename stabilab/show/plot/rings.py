"""The closed orbits of an island: of a motion that repeats, those round the same equilibrium with the same
value of what is kept besides the energy (|H| without a torque, else the invariant of the reduced motion), out
to the separatrix. All are level lines of the energy on the surface on which these motions stay."""
from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from ...equilibrium.momentum_sphere import MAXIMUM, MINIMUM, SADDLE, MomentumSphere
from ...numbers.exact import floats, sqrt_fraction
from ...numbers.vectors import dot
from ...orbit.phase_plane import PhasePlane, phase_plane
from ...orbit.reduction import reduce
from .path import path
from .subject import Subject, free

RINGS = 10
RAYS, STEPS, HALVINGS = 1441, 400, 50  # of a chart: directions from its middle, places on each
NEXT = 1e-3  # of an island's energies: what places next to a saddle fall short of it
JUMP = 0.2  # rad from one ray to the next: places so far from each other are of two lines
SPHERE = "with the same |H|"
SAME = 1e-13  # of the energies: those of one saddle
OFF = 0.01  # of its chart: how near a level line is to a motion that lies on it
AT_SADDLE = 1e-6  # of an island's energies: its rim, so much below the saddle
OPPOSITE = 3.1  # rad from the middle of a map: farther off is the opposite point
EQUATOR = 1.5  # rad from the middle of an island without a rim: so far rings are drawn
PLACES = 2001  # of a well
ROUGH = 0.005  # of the places of a line that lie on the other side of one that it does not cross


@dataclass(frozen=True)
class Island:
    """Lines (n, 2) in two coordinates. own: of the motion, from its start; rings: from the middle outward;
    rim: of the separatrix, where one bounds the island; inner: of one inside it; middles: the equilibria in
    it, (2,) each; kept: what all these orbits have in common; axis: 0, 1, 2, the rate along which they are
    seen, so that the coordinates are the two others. None: they are angles (rad) of H from the middle, across
    and towards the axis number `about` of the body; under a torque the turn about its axis, of that number
    (rad, or scaled), and the rate about it."""

    own: np.ndarray
    rings: list[np.ndarray]
    rim: np.ndarray | None
    inner: list[np.ndarray]
    middles: list[np.ndarray]
    kept: str
    axis: int | None
    about: int = 0


def island(item: Subject, number: int = RINGS) -> Island | None:
    """That of a motion that repeats, with so many closed orbits; None where it goes round no equilibrium."""
    if item.motion.period is None:
        return None
    if item.physical and free(item):
        return _on_sphere(item, number)
    return None if reduce(item.twin) is None else _in_wells(phase_plane(item.twin, item.state), number)


def _seen_along(ring: np.ndarray) -> int:
    """The axis along which a closed line (n, 3) encloses most."""
    area = np.cross(ring[:-1], ring[1:]).sum(axis=0)
    return int(np.abs(area).argmax())


def nested(rings: list[np.ndarray]) -> int:
    """How many of closed lines (n, 2), from the first on, cross none of the others among them."""
    from matplotlib.path import Path
    areas = [Path(ring) for ring in rings]
    for n, ring in enumerate(rings):
        for area in areas[:n]:
            inside = Path(ring).contains_points(area.vertices).mean()
            if ROUGH < inside < 1 - ROUGH:
                return n
    return len(rings)


# --- Without a torque: level lines of the energy on the sphere of H, on rays from an equilibrium
def _on_sphere(item: Subject, number: int) -> Island | None:
    scene: Any = item.twin
    _, own = path(item, 0.0, float(item.motion.period))
    omega = item.exact_state or item.state
    H = tuple(d * Fraction(w) + l for d, w, l in zip(scene.body.exact, omega, scene.vector("gyrostat")))
    sphere = MomentumSphere(scene.body.exact, scene.vector("gyrostat"), dot(H, H))
    D, wheel = (np.array(floats(v)) for v in (sphere.D, sphere.wheel))
    size = float(sqrt_fraction(sphere.square))
    energy = lambda H: (((H - wheel) ** 2) / (2 * D)).sum(axis=-1)
    saddles = [float(rotation.energy) for rotation in sphere.rotations if rotation.nature == SADDLE]
    for rotation in sphere.rotations:
        if rotation.nature not in (MINIMUM, MAXIMUM) or rotation.axis or rotation.everywhere:
            continue
        middle = np.array(floats(rotation.momentum))
        chart = _Chart(middle / np.linalg.norm(middle), size, energy)
        level, lowest = float(energy(own[0] * D + wheel)), float(energy(middle))
        ring = chart.round_it(level, True)
        if ring is None or chart.off(ring, own[0] * D + wheel) > OFF:
            continue
        beyond = [(value - lowest) for value in saddles
                  if (value - level) * (level - lowest) > 0 and abs(value - level) > SAME * abs(level)]
        rise = min(beyond, key=abs) if beyond else chart.farthest(level - lowest) - lowest
        rim = chart.round_it(lowest + (1 - AT_SADDLE) * rise, True) if beyond else None
        edge = rim if rim is not None else chart.round_it(lowest + (1 - 1e-2) * rise)
        if edge is None:
            continue
        far = edge[int(np.hypot(*edge.T).argmin())]
        if rim is None:  # up to where they begin to be seen from behind
            far = far * min(1.0, EQUATOR / float(np.hypot(*far)))
        rings = [chart.round_it(float(energy(chart.at(far[None] * n / (number + 1))[0])))
                 for n in range(1, number + 1)]
        built = [(chart.at(line) - wheel) / D for line in rings if line is not None]
        axis = _seen_along(built[-1] if built else own)
        every = [np.delete(line, axis, axis=-1) for line in built]
        outline = [] if rim is None else [np.delete((chart.at(rim) - wheel) / D, axis, axis=-1)]
        if nested(every) == len(every) and nested([*every, *outline]) == len(every) + len(outline):
            own, middle = (np.delete(line, axis, axis=-1) for line in (own, (middle - wheel) / D))
            return Island(own, every, outline[0] if outline else None, [], [middle], SPHERE, axis)
        # round behind, some would lie on others: as a map of the sphere
        every = [line for line in rings if line is not None]
        if rim is not None:  # the opposite point, which a map has all round
            rim = np.where((np.hypot(*rim.T) > OPPOSITE)[:, None], np.nan, rim)
        return Island(chart.places(own * D + wheel), every, rim, [], [np.zeros(2)], SPHERE, None, chart.upper)
    return None


class _Chart:
    """A sphere unrolled about a point: distance and direction from it, up to its opposite."""

    def __init__(self, pole: np.ndarray, size: float, energy: Any) -> None:
        self.pole, self.size, self.energy = pole, size, energy
        self.upper = int(np.abs(pole).argmin())  # the axis of the body that is upward in a map
        first = np.eye(3)[self.upper]
        self.across = np.cross(pole, first) / np.linalg.norm(np.cross(pole, first))
        self.upward = np.cross(self.across, pole)
        turn = np.linspace(0, 2 * np.pi, RAYS)
        self.rays = np.column_stack([np.cos(turn), np.sin(turn)])
        self.far = np.linspace(0.0, np.pi, STEPS)
        self.heights = energy(self.at(self.far[:, None, None] * self.rays))

    def at(self, places: np.ndarray) -> np.ndarray:
        """(..., 3) the points of places (..., 2)."""
        far = np.hypot(places[..., 0], places[..., 1])
        part = np.sinc(far / np.pi)[..., None] * places
        return self.size * (np.cos(far)[..., None] * self.pole + part[..., :1] * self.across
                            + part[..., 1:] * self.upward)

    def places(self, points: np.ndarray) -> np.ndarray:
        """(n, 2) the places of points (n, 3)."""
        parts = points / np.linalg.norm(points, axis=-1, keepdims=True)
        aside = np.column_stack([parts @ self.across, parts @ self.upward])
        sine = np.linalg.norm(aside, axis=-1, keepdims=True)
        far = np.arctan2(sine[:, 0], parts @ self.pole)[:, None]
        return np.divide(aside * far, sine, out=np.zeros_like(aside), where=sine > 0)

    def round_it(self, value: float, rim: bool = False) -> np.ndarray | None:
        """The closed level line (n, 2) of a value round the middle: on each ray the first place that has it;
        None where one has none, or these places do not hang together. rim: the value is that of a saddle, all
        but: a ray that passes it so near that its places miss it ends at the one next to it."""
        upward = value > self.heights[0, 0]
        rise = np.abs(self.heights[1:] - self.heights[0, 0])
        beyond = (self.heights[1:] >= value) == upward
        missed = ~beyond.any(axis=0)
        if missed.any():
            nearest = rise.argmax(axis=0)
            if not rim or (rise[nearest, np.arange(RAYS)][missed] < (1 - NEXT) * abs(
                    value - self.heights[0, 0])).any():
                return None
            beyond[nearest[missed], np.flatnonzero(missed)] = True
        first = beyond.argmax(axis=0)
        low, high = self.far[first], self.far[first + 1]
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            past = (self.energy(self.at(middle[:, None] * self.rays)) >= value) == upward
            low, high = np.where(past, low, middle), np.where(past, middle, high)
        jumps = np.abs(np.diff(high)) > JUMP
        return None if jumps.any() else high[:, None] * self.rays

    def off(self, line: np.ndarray, point: np.ndarray) -> float:
        """How far a point is from the places of a line, in parts of the sphere's size."""
        return float(np.linalg.norm(self.at(line) - point, axis=1).min() / self.size)

    def farthest(self, toward: float) -> float:
        """The other extremum of the energy."""
        return float(self.heights.max() if toward > 0 else self.heights.min())


# --- Under a torque: level lines of the energy in the wells of the reduced potential
def _in_wells(plane: PhasePlane, number: int) -> Island | None:
    energy = plane.W0**2 / 2
    turn = float(plane.land.turn)
    reach = turn if np.isfinite(turn) else max(map(abs, [*plane.saddles, *plane.centres, 1.0])) + 3.0
    barriers = [(y, float(plane.height(y))) for y in plane.repeated(plane.saddles, -reach, reach)]
    sides = [min((row for row in barriers if row[0] * side > 0 and row[1] >= energy),
                 key=lambda row: abs(row[0]), default=None) for side in (-1, 1)]
    bounds = [row[1] for row in sides if row is not None]
    centres = [y for y in plane.repeated(plane.centres, -reach, reach)
               if (sides[0] is None or y > sides[0][0]) and (sides[1] is None or y < sides[1][0])]
    if not centres:
        return None
    lowest = min(float(plane.height(y)) for y in centres)
    top = min(bounds) if bounds else lowest + 2.5 * max(energy - lowest, 1e-300)
    low, high = (_end(plane, row, top, side) for row, side in zip(sides, (-1, 1)))
    if low is None or high is None:
        return None
    closed = lambda value: list(_closed(plane, value, low, high))
    # even steps of the size, which grows as the root of the energy
    rings = [ring for n in range(1, number + 1)
             for ring in closed(lowest + (top - lowest) * (n / (number + 1)) ** 2)]
    rims = closed(top - AT_SADDLE * (top - lowest)) if bounds else []
    inner = [ring for y, v in barriers if low < y < high and v < top for ring in closed(v)]
    own = next((ring for ring in closed(energy) if ring[0].min() <= 0 <= ring[0].max()), None)
    if own is None or not (rings or rims):
        return None
    n = int(np.hypot(own[0], own[1] - plane.W0).argmin())  # from the start on
    start = np.array([[0.0], [plane.W0]])
    own = np.concatenate([start, own[:, n + 1:], own[:, 1:n], start], axis=1)
    middles = [np.array([[y], [0.0]]) for y in centres if low < y < high]
    rates = lambda ring: plane.states(*ring)
    axis: int | None = _seen_along(rates(max((*rings, *rims, own), key=lambda ring: float(np.ptp(ring[0])))))
    seen = lambda ring: np.delete(rates(ring), axis, axis=-1)
    every = [seen(ring) for ring in (*rings, *rims[:1])]
    if nested(every) < len(every):  # seen along any axis some lie on others
        axis = None
        seen = lambda ring: np.column_stack([plane.unit * ring[0], plane.rate(ring[1])])
    return Island(seen(own), [seen(ring) for ring in rings], seen(rims[0]) if rims else None,
                  [seen(ring) for ring in inner], [seen(at)[0] for at in middles],
                  "with the same value of the other integral", axis, plane.reduction.axis)


def _end(plane: PhasePlane, barrier: tuple[float, float] | None, top: float, side: int) -> float | None:
    """Where the potential reaches the top of an island on a side; None where it does not within its range."""
    if barrier is not None and barrier[1] <= top:
        return barrier[0]
    step = 1e-3
    while abs(step) < 12 and float(plane.height(side * step)) < top:
        step *= 1.05
    return side * step if abs(step) < 12 else None


def _closed(plane: PhasePlane, value: float, low: float, high: float) -> Iterator[np.ndarray]:
    """The orbits, (2, n) places and rates of the reduced motion, of an energy between two places, each
    closed."""
    y = np.linspace(low, high, PLACES)
    inside = np.array(plane.height(y)) < value
    edges = np.flatnonzero(inside[1:] != inside[:-1])
    starts = [0, *(edges + 1)] if inside[0] else list(edges + 1)
    for first in starts[::2]:
        after = np.flatnonzero(~inside[first:])
        last = first + int(after[0]) - 1 if len(after) else len(y) - 1
        if last - first < 3:
            continue
        left = _turn(plane, value, y[max(first - 1, 0)], y[first])
        right = _turn(plane, value, y[min(last + 1, len(y) - 1)], y[last])
        phase = np.linspace(0, 2 * np.pi, 721)
        places = (left + right) / 2 - (right - left) / 2 * np.cos(phase)
        W = np.sqrt(2 * np.maximum(value - plane.height(places), 0.0)) * np.sign(np.sin(phase))
        yield np.stack([places, W])


def _turn(plane: PhasePlane, value: float, outside: float, inside: float) -> float:
    """Where the potential has a value between a place where it is higher and one where it is lower."""
    for _ in range(60):
        middle = (outside + inside) / 2
        if float(plane.height(middle)) < value:
            inside = middle
        else:
            outside = middle
    return inside
