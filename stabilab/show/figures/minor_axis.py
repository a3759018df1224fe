"""Figures 2-7 of Amer et al. 2024: constant torque on the minor axis, drawn from the equations."""
from __future__ import annotations

from functools import lru_cache

import numpy as np

from ...answers.trajectory import trajectory
from ...orbit.phase_plane import motion_curve, phase_plane
from ...orbit.separatrix.sheets import separatrix
from .. import style
from ..plot.phase_plane import draw
from . import paper
from .figure import listed

WINDOW = (-6.9, 9.6)  # alpha = 2 theta: both wells and their saddles; the plane repeats every 4 pi
PRINTED_FIG4 = {100: ((0.0, 6.2), (-3.0, 3.3)), 300: ((0.19, 6.15), (-3.1, 3.29)), 500: ((0.32, 5.8), (-3.13, 3.28))}
MAP_SHAPE = (240, 241)
MAP_REACH = 5.0       # largest circle drawn in Figs 5 and 6, in radii of the outer fold circle


def _plane(lambda1):
    """(phase plane, alpha of the start, window of y) for the start of the paper."""
    plane = phase_plane(paper.scene("minor", lambda1), paper.START_MINOR)
    start = 2 * float(np.arctan2(*plane.place))
    return plane, start, tuple((edge - start) / 2 for edge in WINDOW)


def _label(ax):
    ax.set_xlabel(r"$\alpha = 2\,\mathrm{atan2}(x_1+a,\ x_2)$")
    ax.set_ylabel(r"$x = 2\,x_3$")


def trajectories(plt):
    """Fig. 2."""
    figure, ax = plt.subplots(figsize=(7.4, 5.0), layout="constrained")
    plane, start, span = _plane(100)
    draw(ax, plane, scale=2, offset=start, rate_scale=2, span=span, levels=26)
    _label(ax)
    radius = np.sqrt(plane.Q)
    ax.set_title(rf"Torque on the minor axis, $\lambda_1=100$: the circle $A={radius:.4f}$ of the start")
    style.legend(figure, [("this motion", style.MEANING["this motion"]), ("separatrices", style.MEANING["separatrix"]),
                     ("other energies", style.MEANING["level"]), ("start", style.MARKER["start"]),
                     ("centre (stable)", style.MARKER["centre"]), ("saddle (unstable)", style.MARKER["saddle"])])
    return figure


def _loops(ax, plane, start, span):
    """Both separatrices, their motions inside, and the points where they cross the axis upright."""
    for index, saddle in enumerate(plane.repeated(plane.saddles, *span)):
        ys, Ws = plane.separatrix(saddle, *span)
        look = style.MEANING["separatrix" if index % 2 == 0 else "separatrix 2"]
        for sign in (1, -1):
            ax.plot(start + 2 * ys, 2 * sign * Ws, **look)
        loop = plane.loop(saddle, *span)
        if loop:
            end = loop[0] if abs(loop[1] - saddle) < abs(loop[0] - saddle) else loop[1]
            ax.plot([start + 2 * end], [0], zorder=6, **style.MARKER["turning"])
    for kind, places in (("centre", plane.centres), ("saddle", plane.saddles)):
        shown = np.array(plane.repeated(places, *span))
        ax.plot(start + 2 * shown, 0 * shown, zorder=6, **style.MARKER[kind])


def left_right(plt):
    """Fig. 3."""
    figure, ax = plt.subplots(figsize=(7.4, 5.0), layout="constrained")
    plane, start, span = _plane(100)
    _loops(ax, plane, start, span)
    scene = paper.scene("minor", 100)
    for centre in plane.repeated(plane.centres, *span):
        other = phase_plane(scene, plane.states(np.float64(centre), np.float64(2.2)))
        ys, Ws = motion_curve(other, -np.pi, np.pi)
        for sign in (1, -1):
            ax.plot(start + 2 * (centre + ys), 2 * sign * Ws, **style.MEANING["bounded"])
    spin = phase_plane(scene, plane.states(np.float64(span[1]), np.float64(-6.0)))
    ys, Ws = motion_curve(spin, span[0] - span[1], 0.0)
    for sign in (1, -1):
        ax.plot(start + 2 * (span[1] + ys), 2 * sign * Ws, **style.MEANING["spin-up"])
    ax.set_xlim(*WINDOW)
    ax.set_ylim(-14, 14)
    _label(ax)
    ax.set_title(rf"Left and right separatrices, $\lambda_1=100$, $A={np.sqrt(plane.Q):.4f}$")
    style.legend(figure, [("left separatrix", style.MEANING["separatrix 2"]), ("right separatrix", style.MEANING["separatrix"]),
                     ("periodic motions", style.MEANING["bounded"]), ("spin-up", style.MEANING["spin-up"]),
                     ("upright crossing", style.MARKER["turning"]), ("centre", style.MARKER["centre"]),
                     ("saddle", style.MARKER["saddle"])])
    return figure


def wheel_effect(plt):
    """Fig. 4."""
    figure, axes = plt.subplots(3, 1, figsize=(7.2, 9.0), sharex=True, layout="constrained")
    printed = {"marker": "x", "color": style.ORANGE, "markersize": 8, "markeredgewidth": 2.2, "linestyle": "none"}
    for ax, (lambda1, (saddles, centres)) in zip(axes, PRINTED_FIG4.items()):
        plane, start, span = _plane(lambda1)
        _loops(ax, plane, start, span)
        ax.plot(saddles + centres, [0] * 4, zorder=7, **printed)
        ax.set_xlim(*WINDOW)
        ax.set_ylim(-15, 15)
        _label(ax)
        ax.set_xlabel("")
        ax.set_title(rf"$\lambda_1={lambda1}$: $c=b-a={lambda1 / 500:g}$, $A={np.sqrt(plane.Q):.4f}$")
    axes[-1].set_xlabel(r"$\alpha = 2\,\mathrm{atan2}(x_1+a,\ x_2)$")
    style.legend(figure, [("left separatrix", style.MEANING["separatrix 2"]), ("right separatrix", style.MEANING["separatrix"]),
                     ("centre", style.MARKER["centre"]), ("saddle", style.MARKER["saddle"]),
                     ("upright crossing", style.MARKER["turning"]), ("printed position", printed)])
    return figure


def sheets(lambda1=100, reach=MAP_REACH, shape=(60, 121), axis="minor"):
    """The separatrix of the paper's scene."""
    return separatrix(paper.scene(axis, lambda1), reach=reach, shape=shape)


def exactness(*arguments, **options) -> str:
    """How far vertices of the sheets are from their surface; arguments as of `sheets`."""
    off = max(float(np.max(sheet.residual)) for sheet in sheets(*arguments, **options).sheets)
    return f"vertices within {off:.1e} of the surface, relative to the size of the terms of the energy"


def circle() -> float:
    """Radius A of the circle of the paper's start, lambda1 = 100."""
    return float(np.sqrt(_plane(100)[0].Q))


def left_saddles() -> str:
    """alpha of the left saddle for each lambda1."""
    found = []
    for lambda1 in PRINTED_FIG4:
        plane, start, span = _plane(lambda1)
        found.append(start + 2 * min(plane.repeated(plane.saddles, *span), key=lambda y: abs(start + 2 * y)))
    return listed(found, "{:.3f}").replace("-", "−")


def surfaces(plt):
    """Fig. 5."""
    figure = plt.figure(figsize=(9.6, 5.0), layout="constrained")
    found = sheets()
    for index, (elevation, azimuth) in enumerate(((24, -60), (40, 35))):
        ax = figure.add_subplot(1, 2, index + 1, projection="3d")
        for number, sheet in enumerate(found.sheets):
            p = np.asarray(sheet.points)
            ax.plot_surface(p[..., 0], p[..., 1], p[..., 2], color=style.SHEETS[number % len(style.SHEETS)], alpha=0.75,
                            rstride=2, cstride=3, linewidth=0.15, edgecolor="#333333", shade=True)
            ax.plot(*np.asarray(sheet.saddle).T, **style.MEANING["unstable"])
            ax.plot(*np.asarray(sheet.centre).T, **style.MEANING["stable"])
        ax.view_init(elevation, azimuth)
        style.name_space(ax)
    figure.suptitle(r"Separatrix surfaces, torque on the minor axis, $\lambda_1=100$")
    style.legend(figure, [("centres (stable)", style.MEANING["stable"]), ("saddles (unstable)", style.MEANING["unstable"])])
    return figure


def contour_map(plt):
    """Fig. 6."""
    figure, ax = plt.subplots(figsize=(7.2, 6.6), layout="constrained")
    scene, found = paper.scene("minor", 100), sheets(shape=MAP_SHAPE)
    a, b = scene.a, scene.b
    levels = np.linspace(0, 7.5, 16)
    mesh = None
    for sheet in found.sheets:
        upper, triangles = _upper(np.asarray(sheet.points))
        mesh = ax.tricontourf(upper[:, 0], upper[:, 1], triangles, upper[:, 2], levels=levels, cmap="Greys", alpha=0.9,
                              extend="max")
        ax.plot(*np.asarray(_outline(np.asarray(sheet.points)))[:, :2].T, color=style.PURPLE, linewidth=1.4)
    _hyperbola(ax, a, b)
    _dividing(ax, a, b)
    turn = np.linspace(0, 2 * np.pi, 361)
    for radius in _fold_radii(b - a):
        ax.plot(radius * np.sin(turn) - a, radius * np.cos(turn), **style.MEANING["fold"])
    ax.plot(np.sqrt(2) * np.sin(turn), np.sqrt(2) * np.cos(turn), **style.MEANING["printed"])
    ax.set_xlim(-6, 6)
    ax.set_ylim(-6, 6)
    ax.set_aspect("equal")
    ax.set_xlabel("$x_1$")
    ax.set_ylabel("$x_2$")
    ax.set_title(r"Height $x_3>0$ of the separatrix surfaces, $\lambda_1=100$")
    figure.colorbar(mesh, ax=ax, label="$x_3$ on the surface", shrink=0.8)
    style.legend(figure, [("stable equilibria", style.MEANING["stable"]), ("unstable equilibria", style.MEANING["unstable"]),
                     ("fold circles", style.MEANING["fold"]), (r"$(x_1+a)(x_1+b)=x_2^2$", style.MEANING["dividing"]),
                     ("edge of the stable regions", {"color": style.PURPLE, "linewidth": 1.4}),
                     (r"printed: $x_1+x_2=0$, radius $\sqrt{2}$", style.MEANING["printed"])], columns=3)
    return figure


def _upper(points):
    """Upper half (x3 >= 0) of a sheet as vertices and triangles of its grid."""
    n, m, _ = points.shape
    columns = [j for j in range(m) if np.all(points[:, j, 2] >= -1e-12)]
    part = points[:, columns]
    rows, width = part.shape[:2]
    index = np.arange(rows * width).reshape(rows, width)
    lower = np.stack([index[:-1, :-1], index[1:, :-1], index[:-1, 1:]], -1).reshape(-1, 3)
    upper = np.stack([index[1:, :-1], index[1:, 1:], index[:-1, 1:]], -1).reshape(-1, 3)
    flat, triangles = part.reshape(-1, 3), np.concatenate([lower, upper])
    corner = flat[triangles][..., :2]
    (u1, u2), (v1, v2) = (corner[:, 1] - corner[:, 0]).T, (corner[:, 2] - corner[:, 0]).T
    return flat, triangles[np.abs(u1 * v2 - u2 * v1) > 1e-12]  # folded flat in the projection: nothing to shade


def _outline(points):
    """The line of saddles inward, then the far ends of the loops outward: where a sheet meets the plane x3 = 0."""
    return np.concatenate([points[::-1, 0], points[:, points.shape[1] // 2]])


def _fold_radii(c):
    heights = [h.real for h in np.roots([1, 0, 0, -c, -1]) if abs(h.imag) < 1e-12]
    return sorted(float(np.sqrt(h * h + h**6)) for h in heights)


def _hyperbola(ax, a, b):
    """Equilibria x2 = h, x1 = -b - 1/h: stable where (x1+a)(x1+b) > x2^2."""
    for sign in (1, -1):
        h = sign * np.geomspace(0.05, 20, 4000)
        x1 = -b - 1 / h
        stable = (x1 + a) * (x1 + b) > h * h
        for kind, mask in (("stable", stable), ("unstable", ~stable)):
            ax.plot(np.where(mask, x1, np.nan), np.where(mask, h, np.nan), **style.MEANING[kind])


def _dividing(ax, a, b):
    x1 = np.concatenate([np.linspace(-6, -b, 400), [np.nan], np.linspace(-a, 6, 400)])
    height = np.sqrt(np.maximum((x1 + a) * (x1 + b), 0))
    for sign in (1, -1):
        ax.plot(x1, sign * height, **style.MEANING["dividing"])
    ax.plot([-6, 6], [6, -6], **style.MEANING["printed"])


@lru_cache
def _stable_runs():
    scene = paper.scene("minor", 100)
    return [trajectory(scene, state, np.linspace(0.0, 15.0, 3001)) for state in _bounded_starts(scene)]


def runs_exactness() -> str:
    """How exact the periodic motions of Fig. 7 are: by their laws."""
    drift = max(d for run in _stable_runs() for d in run.invariant_drift.values())
    return f"Taylor integration, relative tolerance 1.1e-16; the laws of the motion drift by {drift:.1e} at most"


def stable_motions(plt):
    """Fig. 7."""
    figure = plt.figure(figsize=(7.2, 5.6), layout="constrained")
    ax = figure.add_subplot(projection="3d")
    scene = paper.scene("minor", 100)
    for index, run in enumerate(_stable_runs()):
        ax.plot(*np.asarray(run.states).T, color=style.SERIES[index % len(style.SERIES)], linewidth=1.1)
    for sign in (1, -1):
        h = sign * np.geomspace(0.17, 5.0, 800)
        x1 = -scene.b - 1 / h
        stable = (x1 + scene.a) * (x1 + scene.b) > h * h
        for kind, mask in (("stable", stable), ("unstable", ~stable)):
            ax.plot(np.where(mask, x1, np.nan), np.where(mask, h, np.nan), 0 * h, **style.MEANING[kind])
    ax.view_init(28, -58)
    style.name_space(ax)
    ax.set_title(r"Periodic motions on their circles, $\lambda_1=100$")
    style.legend(figure, [("centres (stable)", style.MEANING["stable"]), ("saddles (unstable)", style.MEANING["unstable"])])
    return figure


def _bounded_starts(scene):
    """One state a loop, on circles of growing radius: 0.6 of the way up from the centre to the separatrix in energy."""
    starts = []
    for radius in (2.0, 3.0, 4.0, 4.825971404805462, 5.5):
        plane = phase_plane(scene, (radius - scene.a, 0.0, 0.0))
        for saddle in plane.saddles:
            loop = plane.loop(saddle, -12.0, 12.0)
            for centre in plane.repeated(plane.centres, *loop) if loop else ():
                depth = float(plane.height(saddle, centre))
                starts.append(plane.states(np.float64(centre), np.float64(np.sqrt(2 * 0.6 * depth))))
    return starts
