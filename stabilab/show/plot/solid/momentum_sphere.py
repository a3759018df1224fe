"""The sphere of the angular momentum of a body that no torque acts on, its polhodes and separatrices."""
from __future__ import annotations

from typing import Any

import numpy as np

from ....answers.equilibria import equilibria
from ... import style
from ...sampling import spread
from ..in_rates.rest_states import CURVES, POINTS, disc, plane_of, simple
from ..path import path
from ..subject import Subject
from .in_space import Box
from .surface_lines import SurfaceLines, facing, grid_triangles, levels, sight

POLHODES = 13  # lines of other energies
GRID = (361, 721)  # latitudes, longitudes
LIFT = 1.002  # of a line off the sphere
EXTREME = 1e-6  # of the range of energies: so near to its end a value is no saddle's
SAME = 1e-9  # of the energies: those of one saddle, found twice


def momentum_sphere(one: Subject) -> SurfaceLines:
    """All that a plot shows, in kg m^2/s; H = D omega + wheel, |H| constant, and the energy sum((H - wheel)^2 / 2 D) tells the polhodes apart."""
    scene: Any = one.twin  # physical: `which` refuses the others
    D = np.array([float(v) for v in scene.body.exact])
    wheel = np.array([float(v) for v in scene.vector("gyrostat")])
    period = one.motion.period
    _, omega = path(one, 0.0, period or (max(one.span, key=abs) if one.span else 15.0))
    way = omega * D + wheel
    size = float(np.linalg.norm(way[0]))
    energy = lambda H: (((H - wheel) ** 2) / (2 * D)).sum(axis=-1)
    up, round_ = np.linspace(-np.pi / 2, np.pi / 2, GRID[0]), np.linspace(-np.pi, np.pi, GRID[1])
    at = lambda round_, up: size * np.stack([np.cos(up) * np.cos(round_), np.cos(up) * np.sin(round_), np.sin(up)], axis=-1)
    ball = at(*np.meshgrid(round_, up))
    height = energy(ball)
    rest, circles = _rest(one, D, wheel, size)
    view = facing(way.mean(axis=0) if np.linalg.norm(way.mean(axis=0)) > 0.05 * size else way[0])
    found = SurfaceLines(grid_triangles(ball[::6, ::8]), Box(np.array([[-size] * 3, [size] * 3])), view,
                         tuple(rf"$H_{n}$ (kg m$^2$/s)" for n in (1, 2, 3)), f"sphere of the angular momentum, |H| = {size:.5g} kg m²/s")
    flat = float(np.ptp(height)) <= SAME * float(np.abs(height).max())
    saddles = [] if flat else _saddles(height, [float(energy(H)) for kind, H in rest if kind == "unstable"])
    for values, look in ((_others(height, saddles), style.MEANING["level"]), (saddles, style.MEANING["separatrix"])):
        for line in levels(round_, up, height, values):
            points = at(*line.T)
            found.add(LIFT * points, look, points)
    for kind, points in circles:
        found.add(LIFT * points, CURVES[kind], points)
    found.add(LIFT * way, style.MEANING["this motion"], way)
    found.marks = [(LIFT * H[None], POINTS[kind]) for kind, H in rest if H @ sight(view) >= 0] + [(LIFT * way[:1], style.MARKER["start"])]
    found.rows = [("this motion", style.MEANING["this motion"]), ("start", style.MARKER["start"]),
                  *([("separatrix", style.MEANING["separatrix"])] if saddles else []), *([] if flat else [("other energies", style.MEANING["level"])]),
                  *((f"{kind} equilibrium", POINTS[kind]) for kind in POINTS if any(kind == k for k, _ in rest)),
                  *((f"{kind} equilibria", CURVES[kind]) for kind in CURVES if any(kind == k for k, _ in circles))]
    return found


def _saddles(height, energies):
    """The energies of saddles, each once; an extremum is none."""
    low, high = float(height.min()), float(height.max())
    apart = EXTREME * (high - low)
    inner = sorted(value for value in energies if low + apart < value < high - apart)
    return [value for n, value in enumerate(inner) if not n or value - inner[n - 1] > SAME * abs(high)]


def _others(height, saddles):
    """Energies of the polhodes: as many shares of the sphere, none beside a separatrix."""
    area = np.cos(np.linspace(-np.pi / 2, np.pi / 2, height.shape[0]))[:, None] * np.ones(height.shape)
    order = np.argsort(height.ravel())
    shares = np.cumsum(area.ravel()[order])
    values = height.ravel()[order][np.searchsorted(shares, shares[-1] * (np.arange(POLHODES) + 0.5) / POLHODES)]
    apart = 0.02 * float(np.ptp(height))
    return [value for value in values if all(abs(value - s) > apart for s in saddles)]


def _rest(one, D, wheel, size):
    """([(verdict, H)] of the single equilibria whose momentum is of this size, [(verdict, points (n, 3))] of circles of them)."""
    found, circles = [], []
    excess = lambda curve: lambda t: float(np.linalg.norm(np.array(curve.point(float(t)), float) * D + wheel)) - size
    for curve in equilibria(one.twin).curves:
        if curve.name.startswith("plane"):
            if not wheel.any():
                circles.append((simple(curve.segments[0].verdict), disc(plane_of(curve), size)))
            continue
        for segment in curve.segments:
            found += [(simple(segment.verdict), np.array(curve.point(t), float) * D + wheel) for t in _roots(excess(curve), *segment.t)]
    return found, circles


def _roots(function, low, high):
    from scipy.optimize import brentq
    t = spread(low, high, 4001)
    values = np.array([function(v) for v in t])
    with np.errstate(all="ignore"):
        change = np.nonzero(np.isfinite(values[:-1]) & np.isfinite(values[1:]) & (values[:-1] * values[1:] <= 0) & (values[:-1] != 0))[0]
    return [brentq(function, t[n], t[n + 1], xtol=1e-15, rtol=1e-14) for n in change]
