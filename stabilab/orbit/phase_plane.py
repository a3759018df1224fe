"""The geometry of the phase plane of a reduced motion: heights, saddles, centres, separatrices, the motion's
own curve."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ..numbers.polynomial import halved
from .landscape import Landscape, landscape_in_doubles
from .one_orbit import Orbit
from .one_state import in_range

if TYPE_CHECKING:
    from ..physics.scene import AnyScene

FARTHEST = 30.0  # along an orbit: beyond, where places are e^30 as far, rounding decides on which it lies


@dataclass(frozen=True)
class PhasePlane:
    """The orbit of one state, unrolled: y is the canonical angle from the state on, W = dy/ds, V(0) = 0.

    place: where the state lies on its circle, hyperbola or parabola; W0: rate of the state.
    """

    land: Landscape
    state: tuple[float, ...]
    place: tuple
    W0: float

    @property
    def potential(self):
        return self.land.potential

    @property
    def reduction(self):
        return self.land.reduction

    @property
    def Q(self) -> float:
        """The invariant of a circle or hyperbola."""
        return float(self.land.invariant(self.place))

    @property
    def unit(self) -> float:
        """Turn angle about the axis (rad for a body) per canonical angle; its sign is that of the reflection.
        """
        return self.land.unit

    def height(self, y: float | np.ndarray, origin: float = 0.0):
        """V(y) - V(origin), free of cancellation near an equilibrium at `origin`."""
        y = np.asarray(y, float)
        location = tuple(np.asarray(v) for v in self.potential.move(self.place, np.float64(origin)))
        force = 0.0 if origin in self.saddles or origin in self.centres else self.potential.force(location)
        return self.potential.rise(y - origin, location, force)

    def rate(self, W: np.ndarray | float):
        """omega_i (or x_i) of canonical W."""
        return self.land.rate(np.asarray(W))

    def components(self, y):
        """omega_j, omega_k along the orbit."""
        return self.land.pair(self.potential.move(self.place, np.asarray(y, float)))

    def states(self, y: np.ndarray, W: np.ndarray):
        """States (..., 3) at canonical (y, W)."""
        return self.land.components(self.potential.move(self.place, np.asarray(y, float)), W)

    @cached_property
    def _critical(self):
        """[(y, is a saddle)] on the orbit; for a circle within one turn of the state."""
        spots = Orbit(self.reduction, self.state).settled(
            lambda orbit: [(float(spot.y), spot.kind > 0) for spot in orbit.spots if spot.kind])
        half = 0.5 * self.land.turn
        return sorted((y - self.land.turn if y > half else y, saddle) for y, saddle in spots
                      if abs(y) < FARTHEST)

    @property
    def saddles(self) -> list[float]:
        return [y for y, saddle in self._critical if saddle]

    @property
    def centres(self) -> list[float]:
        return [y for y, saddle in self._critical if not saddle]

    def repeated(self, ys: Sequence[float], low: float, high: float) -> list[float]:
        """The places in [low, high]: a circle repeats them every turn."""
        turn = self.land.turn
        if np.isinf(turn):
            return [y for y in ys if low <= y <= high]
        return sorted(y + turn * n for y in ys
                      for n in range(int(np.floor((low - y) / turn)), int(np.ceil((high - y) / turn)) + 1)
                      if low <= y + turn * n <= high)

    def separatrix(self, saddle, low, high, points=2001):
        """(y, W >= 0) of the curve that runs through the saddle, as far as it hangs together; dense at its
        ends."""
        y = np.unique(np.concatenate([np.linspace(low, high, points),
                                      saddle + np.geomspace(1e-6, 1, 60) * (high - saddle),
                                      saddle - np.geomspace(1e-6, 1, 60) * (saddle - low), [saddle]]))
        drop = -self.height(y, saddle)
        drop[y == saddle] = 0.0
        edges = [self._edge(saddle, y[i], y[i + 1]) for i in range(len(y) - 1) if drop[i] * drop[i + 1] < 0]
        y = np.concatenate([y, edges])
        drop = np.concatenate([drop, np.zeros(len(edges))])
        order = np.argsort(y)
        y, drop = y[order], drop[order]
        walls = np.nonzero(drop < 0)[0]
        at = int(np.searchsorted(y, saddle))
        first = int(walls[walls < at].max(initial=-1)) + 1
        last = int(walls[walls > at].min(initial=len(y)))
        return y[first:last], np.sqrt(2 * np.maximum(drop[first:last], 0))

    def _edge(self, saddle: float, left: float, right: float):
        return halved(lambda y: float(self.height(y, saddle)), left, right)

    def loop(self, saddle, low, high):
        """(end, end) of the homoclinic loop through the saddle, None where it does not close in the window.
        """
        y, W = self.separatrix(saddle, low, high)
        for end, at_wall in ((y[0], W[0] == 0), (y[-1], W[-1] == 0)):
            if at_wall and abs(end - saddle) > 1e-4:
                return tuple(sorted((float(end), saddle)))
        return None


def phase_plane(scene: AnyScene, state: np.ndarray | Sequence[float]) -> PhasePlane | None:
    """The phase plane of the motion from `state`; None where the scene does not reduce. Raises InputError
    beyond doubles."""
    with in_range("phase plane"):
        land = landscape_in_doubles(scene)
    if land is None:
        return None
    array = np.asarray(state, float)
    location, w, _ = land.start(array)
    return PhasePlane(land, tuple(array.tolist()), tuple(float(v) for v in location), float(w))


# of what the potential rises in a unit of y: a motion with less is shown in the well that it rests in
RESTING = 1e-4


def window(plane: PhasePlane) -> tuple[float, float]:
    """The range of y worth drawing: a turn and a half of a circle; between high walls of a hyperbola or
    parabola."""
    if np.isfinite(plane.land.turn):
        marks = plane.saddles + plane.centres
        middle = float(np.mean(marks)) if marks else 0.0
        return _with_motion(plane, middle - 1.35 * np.pi, middle + 1.35 * np.pi)
    energy = plane.W0**2 / 2
    marks = [0.0, *plane.saddles, *plane.centres]
    heights = [float(plane.height(m)) for m in marks]
    steep = max(float(plane.height(m)) for m in (min(marks) - 1.0, max(marks) + 1.0)) - min(heights)
    lift = max(energy, *heights) - min(heights)
    lift = lift if lift > RESTING * steep else steep
    return tuple(_side(plane, edge, sense, min(heights) + 2.5 * lift, min(heights) - 6 * lift)
                 for edge, sense in ((min(marks), -1), (max(marks), 1)))


def _with_motion(plane: PhasePlane, low: float, high: float):
    """The range with the whole of a motion that turns back on both sides; any other leaves it anyway."""
    ys, Ws = motion_curve(plane, low - 2 * np.pi, high + 2 * np.pi)
    if Ws[[0, -1]].max() > 1e-6 * Ws.max():
        return low, high
    room = 0.05 * (ys[-1] - ys[0])
    return min(low, ys[0] - room), max(high, ys[-1] + room)


def _side(plane: PhasePlane, edge: float, sense: int, ceiling: float, cellar: float):
    """Where the potential, from `edge` on, leaves the range worth drawing; at most 12 away."""
    step = 1e-6
    while step < 12 and cellar < plane.height(edge + sense * step) < ceiling:
        step *= 1.1
    return edge + sense * step


def motion_curve(plane: PhasePlane, low: float, high: float, points: int = 4001):
    """(y, W >= 0) of the motion through the state: its connected piece of the level curve inside [low, high].
    """
    free = lambda v: plane.W0**2 / 2 - float(plane.height(v))
    ends = []
    for limit in (low, high):
        grid = np.linspace(0.0, limit, points)
        left = plane.W0**2 / 2 - plane.height(grid)
        outside = np.nonzero(left[1:] < 0)[0]
        if len(outside):
            nearby, far = grid[outside[0]:outside[0] + 2].tolist()
            limit = halved(free, *sorted((nearby, far))) if free(nearby) > 0 else nearby
        ends.append(float(limit))
    phase = np.linspace(-np.pi / 2, np.pi / 2, 801)
    y = (ends[0] + ends[1]) / 2 + (ends[1] - ends[0]) / 2 * np.sin(phase)
    return y, np.sqrt(2 * np.maximum(plane.W0**2 / 2 - plane.height(y), 0.0))
