"""The cylinder on which a motion under a torque on a principal axis stays: its phase plane, wrapped round the curve of the other two rates."""
from __future__ import annotations

import numpy as np

from ....orbit.phase_plane import PhasePlane, motion_curve, phase_plane, window
from ... import style
from ..measures import measures
from ..phase_plane import SMALL, highest, ways
from ..subject import Subject
from .in_space import Box
from .surface_lines import SurfaceLines, facing, grid_triangles, levels, sight

GRID = (97, 161)  # of the surface: rates, places
FINE = (241, 361)
LEVELS = 16
AROUND = 2.2  # a small motion is shown in so many times its own size
ASIDE = 0.6  # of the way over this motion and all equilibria: how far a hyperbola or parabola is shown beyond


def cylinder(one: Subject, units: str | None) -> SurfaceLines:
    """All that a plot shows, in the units of the rates."""
    plane, scale = phase_plane(one.twin, one.state), measures(one, units)
    ys, Ws = motion_curve(plane, *window(plane))
    low, high, top = _range(plane, ys, Ws)
    at = lambda y, W: plane.states(np.asarray(y, float), np.asarray(W, float)) * scale.rate[1]
    y, W = np.linspace(low, high, GRID[1]), np.linspace(-top, top, GRID[0])
    surface = at(*np.broadcast_arrays(y[None, :], W[:, None]))
    axis = plane.reduction.axis
    view = facing(_broadside(plane, (low + high) / 2, axis) + 0.35 * np.eye(3)[axis])
    spread = np.ptp(surface.reshape(-1, 3), axis=0)
    pad = 0.04 * spread.max() if spread.min() > 0.04 * spread.max() else np.maximum(0.04 * spread, 0.1 * spread.max())
    box = Box.of(surface.min(axis=(0, 1)) - pad, surface.max(axis=(0, 1)) + pad)
    words = f"the rates across {one.axes.short(axis + 1)} stay on a {plane.land.base}"
    found = SurfaceLines(grid_triangles(surface), box, view, tuple(scale.label(name, scale.rate[0]) for name in scale.names), words)
    _wrap(found, plane, at, axis, low, high, top)
    for sign in ways(plane, Ws):
        inside = (np.abs(Ws) <= top) & (ys >= low - 1e-9) & (ys <= high + 1e-9) | np.isfinite(plane.land.turn)
        points = np.where(inside[:, None], at(ys, sign * Ws), np.nan)
        found.add(points, style.MEANING["this motion"], _outward(plane, ys, axis))
    for kind, places in (("centre", plane.centres), ("saddle", plane.saddles)):
        for place in plane.repeated(places, low, high):
            front = float(_outward(plane, [place], axis)[0] @ sight(view)) >= 0
            found.marks.append((at([place], [0.0]), style.MARKER[kind] | ({} if front else {"alpha": 0.35})))
    found.marks.append((at([0.0], [plane.W0]), style.MARKER["start"]))
    found.rows = [("this motion", style.MEANING["this motion"]), ("start", style.MARKER["start"]),
                  *([("separatrix", style.MEANING["separatrix"])] if plane.repeated(plane.saddles, low, high) else []),
                  ("other energies", style.MEANING["level"]),
                  *((name, style.MARKER[kind]) for name, kind, places in (("centre (stable)", "centre", plane.centres),
                    ("saddle (unstable)", "saddle", plane.saddles)) if plane.repeated(places, low, high))]
    return found


def _range(plane: PhasePlane, ys, Ws):
    """(from, to, largest W): one turn of a circle about the motion, the window of another base; of a small motion its surroundings."""
    low, high = window(plane)
    closed = Ws[[0, -1]].max() < 1e-6 * Ws.max()
    middle, half, top = (ys[0] + ys[-1]) / 2 if closed else 0.0, (ys[-1] - ys[0]) / 2, highest(plane, low, high)
    if 0 < Ws.max() < SMALL * top and closed:
        return middle - AROUND * half, middle + AROUND * half, AROUND * float(Ws.max())
    if np.isfinite(plane.land.turn):
        return middle - np.pi, middle + np.pi, highest(plane, middle - np.pi, middle + np.pi)
    marks = np.clip([ys[0], ys[-1], *plane.saddles, *plane.centres], low, high)
    near = ASIDE * max(float(np.ptp(marks)), 0.1)
    return max(low, marks.min() - near), min(high, marks.max() + near), top


def _wrap(found, plane, at, axis, low, high, top):
    """The lines of other energies and the separatrices."""
    y, W = np.linspace(low, high, FINE[1]), np.linspace(-top, top, FINE[0])
    energy = W[:, None] ** 2 / 2 + plane.height(y)[None, :]
    values = np.linspace(energy.min(), np.quantile(energy, 0.93), LEVELS + 1)[1:]
    for line in levels(y, W, energy, values):
        found.add(at(*line.T), style.MEANING["level"], _outward(plane, line[:, 0], axis))
    for saddle in plane.repeated(plane.saddles, low, high):
        ys, Ws = plane.separatrix(saddle, low, high)
        for sign in (1, -1):
            points = np.where((Ws <= top)[:, None], at(ys, sign * Ws), np.nan)
            found.add(points, style.MEANING["separatrix"], _outward(plane, ys, axis))


def _outward(plane, ys, axis):
    """(n, 3) the outward normal of a circular cylinder at places; zero of the others, which hide little."""
    ys = np.asarray(ys, float)
    if not np.isfinite(plane.land.turn):
        return np.zeros((len(ys), 3))
    points = plane.states(ys, np.zeros(ys.shape))
    turn = plane.states(np.linspace(0, 2 * np.pi, 64, endpoint=False), np.zeros(64)).mean(axis=0)
    out = points - turn
    out[:, axis] = 0.0
    return out / np.linalg.norm(out, axis=1, keepdims=True)


def _broadside(plane, y, axis):
    """A unit vector across the surface at a place: outward from a circle, to the upper side of the others."""
    out = _outward(plane, [y], axis)[0]
    if out.any():
        return out
    tangent = np.diff(plane.states(np.array([y - 1e-3, y + 1e-3]), np.zeros(2)), axis=0)[0]
    normal = np.cross(tangent, np.eye(3)[axis])
    return normal / (np.linalg.norm(normal) or 1.0) * (1 if normal[2] >= 0 else -1)
