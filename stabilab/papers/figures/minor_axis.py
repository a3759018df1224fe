"""Figures 2-7 of Amer et al. 2024: constant torque on the minor axis, drawn from the equations.

Figure 6 has the separatrix surfaces from above, with the equilibria and the curves between these."""
from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache

import numpy as np

from ...answers.simulate import trajectory
from ...orbit.phase_plane import motion_curve, phase_plane
from ...orbit.separatrix.branches import separatrix
from ...show import style
from ...show.plot.phase_plane import draw
from .. import table
from ..printed_integrals import height
from .figure import GRID_POINTS, PRINTED, farthest, level_curves, listed, within

# alpha = 2 theta: both wells and their saddles, no equilibrium at an edge; the plane repeats every 4 pi
WINDOW = (-7.0, 8.4)
REACH = 5.0           # largest circle drawn in Fig. 5, in radii of the outer fold circle
CIRCLES, FOLD_RADIUS = (2.0, 4.0, 6.0), np.sqrt(2)  # printed ones of Fig. 5, about the origin
FOLDS = np.array([(1.0, -1.0, 0.0), (-1.0, 1.0, 0.0)])  # where the text has saddle and centre merge
ENLARGED = 2.0            # largest circle of the enlargement of Fig. 5, in the same radii
REST = 1e-9  # of x^2: what rounding leaves where x ends
FINE = (400, 801)     # of the branches, to which distances are taken
LEFT, RIGHT = style.MEANING["separatrix 2"], style.MEANING["separatrix"]
COPY = RIGHT | {"linestyle": (0, (5, 2)), "linewidth": 1.1}
LOOPS = [("left separatrix", LEFT), ("right separatrix", RIGHT), ("right separatrix, a turn earlier", COPY)]
PRINTED_LINE = ("separatrices as printed: (26), (27)", PRINTED)
EQUILIBRIA = [("centre (stable)", style.MARKER["centre"]), ("saddle (unstable)", style.MARKER["saddle"])]


def _plane(lambda1):
    """(phase plane, alpha of the start, window of y) for the start of the paper."""
    plane = phase_plane(table.printed_scene("minor", lambda1), table.START_MINOR)
    start = 2 * float(np.arctan2(*plane.place))
    return plane, start, tuple((edge - start) / 2 for edge in WINDOW)


def _label(ax):
    ax.set_xlabel(r"$\alpha = 2\,\mathrm{atan2}(x_1+a,\ x_2)$")
    ax.set_ylabel(r"$x = 2\,x_3$")


def trajectories(plt):
    """Fig. 2."""
    figure, ax = plt.subplots(figsize=(7.4, 5.2), layout="constrained")
    plane, start, span = _plane(100)
    draw(ax, plane, scale=2, offset=start, rate_scale=2, span=span, levels=26, separatrices=False)
    _separatrices(ax, plane, start, span)
    _as_printed(ax)
    _label(ax)
    radius = np.sqrt(plane.Q)
    ax.set_title(rf"Torque on the minor axis, $\lambda_1=100$: the circle $A={radius:.4f}$ of the start")
    style.legend(figure,
                 [("this motion", style.MEANING["this motion"]), ("start", style.MARKER["start"]), *LOOPS,
                     PRINTED_LINE, ("other energies", style.MEANING["level"]), *EQUILIBRIA], columns=3)
    return figure


def _separatrices(ax, plane, start, span):
    """The separatrix through every saddle: that of the left saddle (alpha near 0), of the right one, and of
    this one a turn earlier."""
    saddles = plane.repeated(plane.saddles, *span)
    left = _left(saddles, start)
    for saddle in saddles:
        look = LEFT if saddle == left else RIGHT if saddle > left else COPY
        ys, Ws = plane.separatrix(saddle, *span)
        for sign in (1, -1):
            ax.plot(start + 2 * ys, 2 * sign * Ws, **look)


def _left(saddles, start):
    """The left saddle of the paper: the one with alpha nearest to 0."""
    return min(saddles, key=lambda y: abs(start + 2 * y))


def _heights():
    """(height by (25), as it is printed, true height) over alpha: x^2/2 + height is constant."""
    scene, (x1, x2, _) = table.printed_scene("minor", 100), table.START_MINOR
    return (height(np.hypot(x1, x2), scene.b),
            height(np.hypot(x1 + scene.a, x2), scene.b - scene.a))


def _separatrix_by(level, alpha):
    """x >= 0 on the separatrices through the saddles of a height near alpha = 0 and 2 pi, each from its own
    loop on; NaN where there is none."""
    rows = []
    for nearby in (0.0, 2 * np.pi):
        there, h = level(alpha[np.abs(alpha - nearby) < 1.5]).max(), level(alpha)
        own = (h <= there) & (alpha > nearby - 2 * np.pi)
        rows.append(np.sqrt(np.where(own, 2 * (there - h), np.nan)))
    return rows


def _as_printed(ax):
    """The separatrices by the printed (26) and (27)."""
    alpha = np.linspace(*WINDOW, 4001)
    for x in _separatrix_by(_heights()[0], alpha):
        for sign in (1, -1):
            ax.plot(alpha, sign * x, **PRINTED)


def departure() -> str:
    """How far x of a printed separatrix is from the true one at equal alpha, in words."""
    rows = []
    for name, nearby in (("left", 0.0), ("right", 2 * np.pi)):
        size, alpha = farthest_apart(*(_square_by(h, nearby) for h in _heights()),
                                     (max(WINDOW[0], nearby - 2 * np.pi), WINDOW[1]))
        rows.append(f"{size:.2f} at α = {alpha:.2f} on the {name} one")
    return "Printed separatrices, by (26) and (27): their x is off by up to " + " and ".join(rows) + "."


def _square_by(level, nearby):
    """alpha -> x^2 on the separatrix through the saddle near an angle, negative where there is none."""
    from scipy.optimize import minimize_scalar
    top = minimize_scalar(lambda alpha: -level(alpha), bounds=(nearby - 1.5, nearby + 1.5), method="bounded",
                          options={"xatol": 1e-13})
    return lambda alpha: 2 * (-top.fun - level(alpha))


def farthest_apart(first: Callable[[float], float], second: Callable[[float], float],
                   span: tuple[float, float], count: int = 4001) -> tuple[float, float]:
    """(largest distance of sqrt(first) and sqrt(second), its alpha) where both are real: at the ends of their
    parts, where a root has a vertical tangent, or where it is stationary."""
    from scipy.optimize import brentq, minimize_scalar
    alpha = np.linspace(span[0], span[1], count)
    ends = [brentq(square, low, high, xtol=1e-14) for square in (first, second)
            for low, high in zip(alpha, alpha[1:]) if square(low) * square(high) < 0]

    def apart(alpha):
        squares = first(alpha), second(alpha)
        one, other = (math.sqrt(max(square, 0)) for square in squares)
        return abs(one - other) if min(squares) > -REST else -1.0

    sizes = [apart(x) for x in alpha]
    tops = [minimize_scalar(lambda x: -apart(x), bounds=(alpha[n - 1], alpha[n + 1]), method="bounded",
                            options={"xatol": 1e-12}).x
            for n in range(1, count - 1) if sizes[n] >= max(sizes[n - 1], sizes[n + 1]) and sizes[n] >= 0]
    return max((apart(x), x) for x in (*ends, *tops, *span))


def _loops(ax, plane, start, span):
    """The separatrices, the equilibria, and the points where the loops cross the axis upright."""
    _separatrices(ax, plane, start, span)
    for saddle in plane.repeated(plane.saddles, *span):
        loop = plane.loop(saddle, *span)
        if loop:
            end = loop[0] if abs(loop[1] - saddle) < abs(loop[0] - saddle) else loop[1]
            ax.plot([start + 2 * end], [0], zorder=6, **style.MARKER["turning"])
    for kind, places in (("centre", plane.centres), ("saddle", plane.saddles)):
        shown = np.array(plane.repeated(places, *span))
        ax.plot(start + 2 * shown, 0 * shown, zorder=6, **style.MARKER[kind])


def left_right(plt):
    """Fig. 3."""
    figure, ax = plt.subplots(figsize=(7.4, 5.2), layout="constrained")
    plane, start, span = _plane(100)
    _loops(ax, plane, start, span)
    scene = table.printed_scene("minor", 100)
    for centre in plane.repeated(plane.centres, *span):
        other = phase_plane(scene, plane.states(np.float64(centre), np.float64(2.2)))
        ys, Ws = motion_curve(other, -np.pi, np.pi)
        for sign in (1, -1):
            ax.plot(start + 2 * (centre + ys), 2 * sign * Ws, **style.MEANING["bounded"])
    spin = phase_plane(scene, plane.states(np.float64(span[1]), np.float64(-6.0)))
    ys, Ws = motion_curve(spin, span[0] - span[1], 0.0)
    for sign in (1, -1):
        ax.plot(start + 2 * (span[1] + ys), 2 * sign * Ws, **style.MEANING["spin-up"])
    _as_printed(ax)
    ax.set_xlim(*WINDOW)
    ax.set_ylim(-14, 14)
    _label(ax)
    ax.set_title(rf"Left and right separatrices, $\lambda_1=100$, $A={np.sqrt(plane.Q):.4f}$")
    style.legend(figure, [*LOOPS, ("periodic motions", style.MEANING["bounded"]),
                          ("spin-up", style.MEANING["spin-up"]),
                     ("upright crossing", style.MARKER["turning"]), PRINTED_LINE, *EQUILIBRIA], columns=3)
    return figure


def wheel_effect(plt):
    """Fig. 4."""
    figure, axes = plt.subplots(3, 1, figsize=(7.2, 9.2), sharex=True, layout="constrained")
    printed = {"marker": "|", "color": style.ORANGE, "markersize": 30, "markeredgewidth": 2.2,
               "linestyle": "none"}
    for ax, letter, (lambda1, (saddles, centres)) in zip(axes, "abc", table.FIG4.items()):
        plane, start, span = _plane(lambda1)
        _loops(ax, plane, start, span)
        # taller than the true points, and behind them
        ax.plot(saddles + centres, [0] * 4, zorder=3, **printed)
        ax.set_xlim(*WINDOW)
        ax.set_ylim(-15, 15)
        _label(ax)
        ax.set_xlabel("")
        ax.set_title(
            rf"({letter}) $\lambda_1={lambda1}$: $c=b-a={lambda1 / 500:g}$, $A={np.sqrt(plane.Q):.4f}$")
    axes[-1].set_xlabel(r"$\alpha = 2\,\mathrm{atan2}(x_1+a,\ x_2)$")
    style.legend(figure, [*LOOPS, *EQUILIBRIA, ("upright crossing", style.MARKER["turning"]),
                          ("printed position", printed | {"markersize": 14})], columns=3)
    return figure


def branches(lambda1=100, reach=REACH, shape=(60, 121), axis="minor"):
    """The separatrix of the paper's scene."""
    return separatrix(table.printed_scene(axis, lambda1), reach=reach, shape=shape)


def exactness(*arguments, **options) -> str:
    """How far vertices of the branches are from their surface; arguments as of `branches`."""
    off = max(float(np.max(branch.residual)) for branch in branches(*arguments, **options).branches)
    return f"vertices within {off:.1e} of the surface, relative to the size of the terms of the energy"


def circle() -> float:
    """Radius A of the circle of the paper's start, lambda1 = 100."""
    return float(np.sqrt(_plane(100)[0].Q))


def left_saddles() -> str:
    """alpha of the left saddle for each lambda1."""
    rows = []
    for lambda1 in table.FIG4:
        plane, start, span = _plane(lambda1)
        rows.append(start + 2 * _left(plane.repeated(plane.saddles, *span), start))
    return listed(rows, "{:.3f}").replace("-", "−")


def printed_loops() -> dict:
    """side -> loops by the printed (31), one for each of `CIRCLES`: states (n, 3). tan^-1(x1/x2) goes on
    as an angle from the saddle, at which the print has sin alpha = -2/F^2."""
    b = table.printed_scene("minor", 100).b
    return {side: [_printed_loop(radius, b, turn) for radius in CIRCLES]
            for side, turn in (("left", 0.0), ("right", 2 * np.pi))}


def _printed_loop(radius, b, turn):
    """The loop of alpha = turn - asin(2/F^2)."""
    from scipy.optimize import brentq
    level = height(radius, b)
    saddle = table.saddle(radius, turn)
    room = lambda alpha: level(saddle) - level(alpha)
    alpha = saddle + np.linspace(-2 * np.pi, 0.0, 4001)
    low = int(np.argmax(room(alpha)))
    ends = [float(brentq(room, alpha[low], edge)) for edge in
            (alpha[0], alpha[low + int(np.argmin(room(alpha[low:])))])]
    half = np.mean(ends) - np.ptp(ends) / 2 * np.cos(np.linspace(0, np.pi, 201))
    x3 = np.sqrt(np.maximum(room(half), 0) / 2)
    alpha, x3 = np.concatenate([half, half[::-1]]), np.concatenate([x3, -x3[::-1]])
    return np.stack([radius * np.sin(alpha / 2), radius * np.cos(alpha / 2), x3], axis=-1)


def surface_departure() -> str:
    """How far the printed loops and folds of Fig. 5 are from the true surface of their side, in words."""
    true = {table.side(branch): np.asarray(branch.points) for branch in branches(shape=FINE).branches}
    loops = printed_loops()
    phrases = [f"{listed([farthest([loop], [true[side]]) for loop in loops[side]], '{:.2f}')} on the {side}"
             for side in SIDES]
    folds = farthest([FOLDS], [points[:1, 0] for points in true.values()])
    return (f"Dashed: the printed (31) on the circles of radius F = {listed(CIRCLES)} about the origin; "
            f"these loops are up to {' and '.join(phrases)} away from the true surfaces. The printed folds, "
            f"(1, −1, 0) and (−1, 1, 0) on the dashed circle of radius √2, are up to {folds:.2f} off.")


def surfaces(plt):
    """Fig. 5: the surfaces, and their folds from another side, enlarged."""
    figure = plt.figure(figsize=(10.4, 5.4), layout="constrained")
    looks = (REACH, len(CIRCLES), (24, -60)), (ENLARGED, 1, (40, 35))
    for index, (reach, circles, view) in enumerate(looks):
        ax = figure.add_subplot(1, 2, index + 1, projection="3d")
        ax.computed_zorder = False  # lines over the surfaces that they are on or beside
        for branch in branches(reach=reach).branches:
            p = np.asarray(branch.points)
            ax.plot_surface(p[..., 0], p[..., 1], p[..., 2], color=SIDES[table.side(branch)], alpha=0.6,
                            rstride=2, cstride=3, linewidth=0.2, edgecolor="#333333", shade=False)
            ax.plot(*np.asarray(branch.saddle).T, zorder=4, **style.MEANING["unstable"])
            ax.plot(*np.asarray(branch.centre).T, zorder=4, **style.MEANING["stable"])
        for loops in printed_loops().values():
            for loop in loops[:circles]:
                ax.plot(*loop.T, zorder=5, **PRINTED)
        ax.plot(*table.circle(FOLD_RADIUS, count=181), 0.0, zorder=5, **PRINTED)
        ax.view_init(*view)
        table.name_space(ax, 1.05)
    figure.suptitle(r"Separatrix surfaces, torque on the minor axis, $\lambda_1=100$; "
                    "right: the folds, enlarged")
    sides = [(f"{side} separatrix surface", {"color": colour, "linewidth": 8, "solid_capstyle": "butt"})
             for side, colour in SIDES.items()]
    style.legend(figure, [*sides, ("centres (stable)", style.MEANING["stable"]),
                          ("saddles (unstable)", style.MEANING["unstable"]),
                          (r"as printed: (31), and radius $\sqrt{2}$", PRINTED)], columns=3)
    return figure


SIDES = dict(zip(("left", "right"), style.SURFACES))


# of the circles of Fig. 7; the fourth is that of the paper's start
RADII = (2.0, 3.0, 4.0, 4.825971404805462, 5.5)
# lighter inside: the hues have meanings
SHADES = ("#D9D9D9", "#B8B8B8", "#969696", "#6E6E6E", "#303030")


@lru_cache
def _stable_runs():
    """(radius, trajectory) of a periodic motion on each side of each circle, and (None, that of the paper's
    start)."""
    scene = table.printed_scene("minor", 100)
    return [(radius, trajectory(scene, state, np.linspace(0.0, 15.0, 3001)))
            for radius, state in [*_bounded_starts(scene), (None, table.START_MINOR)]]


def runs_exactness() -> str:
    """How exact the periodic motions of Fig. 7 are: by their laws."""
    drift = table.drift(run for _, run in _stable_runs())
    return ("Taylor integration, relative tolerance 1.1e-16; the laws of the motion drift by "
            f"{drift:.1e} at most")


def circle_departure() -> str:
    """How far the motion of Fig. 7 from the paper's start is from its printed circle (18), in words."""
    x1, x2 = np.asarray(_stable_runs()[-1][1].states)[:, :2].T
    radius = np.hypot(*table.START_MINOR[:2])
    return (f"Dashed: the printed circle (18) of the start, F = {radius:.2f} about the origin, from which "
            f"this motion is up to {np.abs(np.hypot(x1, x2) - radius).max():.3f} away, and the circle F = "
            f"√2, on which the text has it move: it stays {np.hypot(x1, x2).min():.2f} and more from the "
            f"origin.")


def stable_motions(plt):
    """Fig. 7: the motions in space, and from above."""
    figure = plt.figure(figsize=(11.4, 6.2), layout="constrained")
    ax, above = figure.add_subplot(1, 2, 1, projection="3d"), figure.add_subplot(1, 2, 2)
    looks = {radius: {"color": shade, "linewidth": 1.3} for radius, shade in zip(RADII, SHADES)}
    for radius, run in _stable_runs():
        states = np.asarray(run.states)
        ax.plot(*states.T, **looks[radius] if radius else style.MEANING["this motion"])
        above.plot(*states[:, :2].T, **looks[radius] if radius else style.MEANING["this motion"])
    ax.plot(*np.array([table.START_MINOR]).T, **style.MARKER["start"])
    above.plot(*table.START_MINOR[:2], zorder=6, **style.MARKER["start"])
    for radius in (FOLD_RADIUS, np.hypot(*table.START_MINOR[:2])):
        ax.plot(*table.circle(radius), 0.0, **PRINTED)
        above.plot(*table.circle(radius), **PRINTED)
    for branch in table.equilibria("minor", table.printed_scene("minor", 100), np.geomspace(0.17, 5.0, 800)):
        for panel in (ax, above):
            table.draw_equilibria(panel, *branch)
    ax.view_init(28, -58)
    table.name_space(ax, 1.0)
    above.set(aspect="equal", xlabel="$x_1$", ylabel="$x_2$", title="from above")
    figure.suptitle(r"Periodic motions on their circles of radius $A$ about $(-a, 0)$, $\lambda_1=100$")
    style.legend(figure, [("centres (stable)", style.MEANING["stable"]),
                          ("saddles (unstable)", style.MEANING["unstable"]),
                     ("motion from x(0) = (2.5, 4, 0.1)", style.MEANING["this motion"]),
                          ("start", style.MARKER["start"]),
                          (r"printed circles: (18), radius $\sqrt{2}$", PRINTED),
                     *((f"circle $A={radius:.4g}$", look) for radius, look in looks.items())], columns=4)
    return figure


def _bounded_starts(scene):
    """(radius, state) of a motion a loop, on circles of growing radius: 0.6 of the way up from the centre to
    the separatrix in energy."""
    starts = []
    for radius in RADII:
        plane = phase_plane(scene, (radius - scene.a, 0.0, 0.0))
        for saddle in plane.saddles:
            loop = plane.loop(saddle, -12.0, 12.0)
            for centre in plane.repeated(plane.centres, *loop) if loop else ():
                depth = float(plane.height(saddle, centre))
                starts.append((radius,
                               plane.states(np.float64(centre), np.float64(np.sqrt(2 * 0.6 * depth)))))
    return starts


SHAPE = (240, 241)
MAP_REACH = 6.3           # radii of the outer fold circle: beyond the corners of the map
LEVELS = np.linspace(0, 7.5, 16)
SIZE, MAP_NEAR = 6.0, 2.1  # half a side of the map, and of the enlargement about the folds
BEYOND = 8.0           # half a side of the square in which the fourth surface is traced


def contour_map(plt):
    """Fig. 6: the map, and its middle enlarged."""
    figure, axes = plt.subplots(1, 2, figsize=(11.4, 6.2), layout="constrained")
    scene, result = table.printed_scene("minor", 100), _branches()
    for ax, size in zip(axes, (SIZE, MAP_NEAR)):
        heights = _map(ax, scene, result, size)
    axes[0].set_title(r"Height $x_3>0$ of the separatrix surfaces, $\lambda_1=100$")
    axes[1].set_title("the middle, enlarged")
    box = axes[0].add_patch(plt.Rectangle((-MAP_NEAR, -MAP_NEAR), 2 * MAP_NEAR, 2 * MAP_NEAR, fill=False,
                                        linewidth=0.9,
                                          edgecolor=style.BLACK))
    box.set_zorder(6)
    figure.colorbar(heights, ax=axes, label="$x_3$ on the surface", shrink=0.7, pad=0.02)
    style.legend(figure, [("stable equilibria", style.MEANING["stable"]),
                          ("unstable equilibria", style.MEANING["unstable"]),
                     ("fold circles", style.MEANING["fold"]),
                          (r"$(x_1+a)(x_1+b)=x_2^2$", style.MEANING["dividing"]),
                     ("edge of the stable regions", EDGE),
                          (r"printed: $x_1+x_2=0$, radius $\sqrt{2}$", style.MEANING["printed"]),
                          ("fourth surface: (30), $x_3=0$, $G_1=0$", FOURTH),
                          ("fourth surface as printed", PRINTED_FOURTH)], columns=3)
    return figure


EDGE = {"color": style.GREY, "linewidth": 1.4}
FOURTH = {"color": style.WINE, "linewidth": 1.8}
PRINTED_FOURTH = style.MEANING["printed"] | {"linestyle": "--", "linewidth": 1.6}


@lru_cache(maxsize=1)
def fourth_surface() -> dict:
    """The fourth of the paper's surfaces, (30) for x3 = 0 and G1 = 0, as "printed" and "true": curves (n, 2).
    tan^-1 is the principal value, which jumps at x2 = 0: there the curves end."""
    a, b, result = table.printed_scene("minor", 100).a, table.printed_scene("minor", 100).b, {}
    for name, shift, wheel in (("printed", 0.0, b), ("true", a, b - a)):
        def energy(x1, x2, shift=shift, wheel=wheel):
            X = x1 + shift
            return x2**2 - X**2 - 4 * wheel * X - 4 * np.arctan(X / x2)
        result[name] = [curve for half in ((0.0, BEYOND), (-BEYOND, -0.0))
                       for curve in level_curves(energy, 0.0, (-BEYOND, BEYOND), half)]
    return result


def fourth_departure() -> str:
    """How far the printed fourth surface is from the true one within the map, in words."""
    result = fourth_surface()
    shown = [within(curve, (-SIZE, SIZE), (-SIZE, SIZE)) for curve in result["printed"]]
    return (f"The fourth surface of the paper's list, (30) for x3 = 0 and G1 = 0, is drawn in truth and, "
            f"dashed, as printed: up to {farthest(shown, result['true']):.2f} off.")


def _branches():
    return branches(reach=MAP_REACH, shape=SHAPE)


def map_exactness() -> str:
    """How far the vertices of the map are from the surface; how the fourth surface is traced."""
    return (f"{exactness(reach=MAP_REACH, shape=SHAPE)}; fourth surface: traced on grids of {GRID_POINTS} x "
            f"{GRID_POINTS}")


def _map(ax, scene, result, size):
    """One panel, `size` to all sides of the origin; the filled contours are returned."""
    a, b = scene.a, scene.b
    for branch in result.branches:
        upper, triangles = _upper(np.asarray(branch.points))
        filled = ax.tricontourf(upper[:, 0], upper[:, 1], triangles, upper[:, 2], levels=LEVELS, cmap="Greys",
                                antialiased=True, extend="max")
        ax.plot(*np.asarray(outline(np.asarray(branch.points)))[:, :2].T, **EDGE)
    for branch in table.equilibria("minor", scene, np.geomspace(0.05, 20, 4000)):
        table.draw_equilibria(ax, *branch)
    _dividing(ax, a, b)
    for radius in table.fold_radii(b - a):
        ax.plot(*table.circle(radius, -a), **style.MEANING["fold"])
    ax.plot(*table.circle(np.sqrt(2)), **style.MEANING["printed"])
    for name, look in (("true", FOURTH), ("printed", PRINTED_FOURTH)):
        for curve in fourth_surface()[name]:
            ax.plot(*curve.T, **look)
    ax.set(xlim=(-size, size), ylim=(-size, size), aspect="equal", xlabel="$x_1$", ylabel="$x_2$")
    return filled


def _upper(points):
    """Upper half (x3 >= 0) of a branch as vertices and triangles of its grid."""
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
    # folded flat in the projection: nothing to shade
    return flat, triangles[np.abs(u1 * v2 - u2 * v1) > 1e-12]


def outline(points):
    """The line of saddles inward, then the far ends of the loops outward: where a branch meets the plane x3 =
    0."""
    return np.concatenate([points[::-1, 0], points[:, points.shape[1] // 2]])


def _dividing(ax, a, b):
    x1 = np.concatenate([np.linspace(-6, -b, 400), [np.nan], np.linspace(-a, 6, 400)])
    height = np.sqrt(np.maximum((x1 + a) * (x1 + b), 0))
    for sign in (1, -1):
        ax.plot(x1, sign * height, **style.MEANING["dividing"])
    ax.plot([-6, 6], [6, -6], **style.MEANING["printed"])
