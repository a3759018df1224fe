"""Figures 16-17 of Amer et al. 2024: torque on the middle axis, where its data have no separatrix at all."""
from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...orbit.phase_plane import motion_curve, phase_plane
from ...show import style
from .. import table
from .figure import PRINTED, farthest, level_curves, listed, within
from .minor_axis import branches
from .minor_axis import exactness as of_branches

if TYPE_CHECKING:
    from types import ModuleType

    from ...physics.scene import ScaledGyrostat

LAMBDA_BEYOND = 1250  # c = b - a = 2.5, beyond the cusp 1.7548: there a figure-eight separatrix does exist
LEVEL = 3.93          # printed for Fig. 17
HIGH = 1.6            # |x2| of the printed path of Fig. 16
CUSP = 4 * 3**-0.75
# the branches of Fig. 16
EIGHT = {"lambda1": LAMBDA_BEYOND, "reach": None, "shape": (60, 121), "axis": "middle"}


def exactness() -> str:
    """How far the vertices of Fig. 16 are from their surface."""
    return of_branches(**EIGHT)


def printed_energy(scene, x1, x3):
    """The printed (71) without its 2 x2^2; NaN where it has no real value."""
    with np.errstate(invalid="ignore", divide="ignore"):
        return ((x1**2 + x3**2) * (1 + 2 * (scene.a + scene.b) / np.sqrt(x1**2 - x3**2))
                - 2 * np.arctanh(2 * x1**2 * x3**2 / (x1**2 + x3**2)))


def printed_level(scene: ScaledGyrostat) -> list:
    """Where the printed (71) is `LEVEL` for x2 = 0: curves (n, 2) of x1 and x3, traced in u and sigma, in
    which they are smooth: x1 = +-R cosh u, x3 = +-R sinh u, R^2 = 2 tanh sigma cosh 2u/sinh^2 2u, where tanh
    sigma is what the print has under its tanh^-1."""
    def place(log_u: np.ndarray, log_sigma: np.ndarray):
        u = np.exp(log_u)
        R = np.sqrt(2 * np.tanh(np.exp(log_sigma)) * np.cosh(2 * u)) / np.sinh(2 * u)
        return R, u

    def energy(log_u: np.ndarray, log_sigma: np.ndarray):
        R, u = place(log_u, log_sigma)
        return (R**2 + 2 * (scene.a + scene.b) * R) * np.cosh(2 * u) - 2 * np.exp(log_sigma)

    curves = []
    for curve in level_curves(energy, LEVEL, (-9.0, 3.0), (-18.0, 5.0)):
        R, u = place(*curve.T)
        quarter = np.stack([R * np.cosh(u), R * np.sinh(u)], axis=-1)
        curves += [quarter * [i, j] for i in (1, -1) for j in (1, -1)]
    return curves


def true_level(scene: ScaledGyrostat) -> list:
    """Where the true integral 2 x2^2 + (x1+b)^2 + x3^2 - 4c (x1+b) - 4 atanh(x3/(x1+b)) is `LEVEL` for x2 =
    0: the roots R of a quadratic at x1 + b = +-R cosh u, x3 = R sinh u."""
    c, curves = scene.b - scene.a, []
    u = np.sinh(np.linspace(-5.0, 5.0, 40001))
    for side in (1, -1):
        room = (2 * c * np.cosh(u))**2 + np.cosh(2 * u) * (LEVEL + 4 * side * u)
        root = np.sqrt(np.where(room >= 0, room, np.nan))
        for sign in (1, -1):
            R = (2 * c * side * np.cosh(u) + sign * root) / np.cosh(2 * u)
            R = np.where(R > 0, R, np.nan)
            curves.append(np.stack([side * R * np.cosh(u) - scene.b, R * np.sinh(u)], axis=-1))
    return curves


def level_departure() -> str:
    """How far the printed fourth surface of Fig. 17 is from the true one, in words."""
    apart = []
    for lam in table.LAMBDAS:
        scene = table.printed_scene("middle", lam)
        shown = [within(curve, *VIEW) for curve in printed_level(scene)]
        apart.append(farthest(shown, true_level(scene)))
    x1, x2, x3 = table.START_MIDDLE
    start = 2 * x2**2 + printed_energy(table.printed_scene("middle", 100), x1, x3)
    return (f"The fourth surface of the paper's list, (71) for x2 = 0 and G2 = {LEVEL}, is drawn in truth "
            f"and, dashed, as printed: within a panel up to {listed(apart, '{:.2f}')} off for λ1 = "
            f"{listed(table.LAMBDAS, '{}')}. The start has G2 = {start:.2f} by the printed (71), "
            f"not {LEVEL}.")


def printed_path() -> np.ndarray:
    """The motion of Table 3 by the printed (53) and (71), as far as |x2| <= `HIGH`: states (n, 3)."""
    scene, (x1, x2, x3) = table.printed_scene("middle", 100), table.START_MIDDLE
    size, total = np.sqrt(x1**2 - x3**2), 2 * x2**2 + printed_energy(scene, x1, x3)
    u = np.linspace(-1.0, 1.0, 20001)
    first, third = size * np.cosh(u), size * np.sinh(u)
    height = np.sqrt((total - printed_energy(scene, first, third)) / 2)
    shown = height <= HIGH
    half = np.stack([first[shown], height[shown], third[shown]], axis=-1)
    return np.stack([half, half * [1, -1, 1]])


def path_departure() -> str:
    """How far the printed path of Fig. 16 is from the true motion, in words."""
    true = _tube(table.printed_scene("middle", 100), table.START_MIDDLE)
    return (f"Dashed: the surface (71) with the printed G2 = {LEVEL} where it cuts the plane x2 = 0, and the "
            f"motion of Table 3 by (53) and (71): this does not close, its x2 grows beyond bounds, and as "
            f"far as |x2| = {HIGH:g} it is up to {farthest([printed_path()], [true]):.2f} away from the true "
            f"motion.")


HEIGHTS = np.geomspace(0.05, 20, 4000)  # of x3 on the equilibria that are drawn


def _tube(scene: ScaledGyrostat, state: Sequence[float]):
    """The closed curve of the motion through a state: states (n, 3)."""
    plane = phase_plane(scene, state)
    ys, Ws = motion_curve(plane, -8.0, 8.0)
    return np.concatenate([plane.states(ys, Ws), plane.states(ys[::-1], -Ws[::-1])])


def surfaces(plt: ModuleType):
    """Fig. 16."""
    figure = plt.figure(figsize=(11.4, 6.0), layout="constrained")
    left = figure.add_subplot(1, 2, 1, projection="3d")
    scene = table.printed_scene("middle", 100)
    _nested(left, scene)
    left.set_title(rf"$\lambda_1=100$, $c={scene.b - scene.a:g}$: nested closed motions, no separatrix",
                   fontsize=9.5)
    right = figure.add_subplot(1, 2, 2, projection="3d")
    names = _figure_eight(right)
    right.set_title(rf"$\lambda_1={LAMBDA_BEYOND}$, $c=2.5>{CUSP:.4f}$: figure-eight separatrix",
                    fontsize=9.5)
    style.legend(figure, [("centres (stable)", style.MEANING["stable"]),
                          ("saddles (unstable)", style.MEANING["unstable"]),
                     ("motion of Table 3", style.MEANING["this motion"]), ("start", style.MARKER["start"]),
                     ("periodic motions", {"color": style.BLUE, "linewidth": 1.0}),
                          ("one figure-eight", EIGHT_LINE),
                          ("as printed: (71)", PRINTED),
                     *((f"separatrix, {name}", {"color": colour, "linewidth": 8, "solid_capstyle": "butt"})
                       for name, colour in zip(names, LOOPS))], columns=4)
    return figure


EIGHT_LINE = {"color": style.BLACK, "linewidth": 2.2}  # of the two loops of one saddle
LOOPS = style.SURFACES  # of the parts of the figure-eight
# of each part, and the width of its mesh: the small loop of branch 1 stands within that of branch 2
OPAQUE, THIN = (1.0, 0.6, 0.45, 0.6), (0.1, 0.3, 0.1, 0.3)


FROM_BEHIND = (1.4, 1.2, 1.3, 1.1)  # of each part, seen from the side from which both loops are


UPRIGHT = (1, 3, 2)  # the torque's axis stands upright in the 3-D panels


def _upright(points):
    """(n, 3) or (n, m, 3) as three arrays in the order of the panels' axes."""
    points = np.asarray(points)
    return tuple(points[..., i - 1] for i in UPRIGHT)


def _nested(ax, scene):
    for x1, x3, stable in table.equilibria("middle", scene, HEIGHTS):
        shown = (np.abs(x1) < 3) & (np.abs(x3) < 3) & stable
        ax.plot(np.where(shown, x1, np.nan), np.where(shown, x3, np.nan), 0 * x1, **style.MEANING["stable"])
    for g in (-1.8, -1.0, -0.5, 0.5, 1.0, 1.8):
        for height in (0.4, 0.8):
            ax.plot(*_upright(_tube(scene, (1 / g - scene.a, height, g))), color=style.BLUE, linewidth=1.0)
    ax.plot(*_upright(_tube(scene, table.START_MIDDLE)), **style.MEANING["this motion"])
    ax.plot(*_upright(np.array([table.START_MIDDLE])), **style.MARKER["start"])
    for curve in printed_level(scene):
        ax.plot(*within(curve, (-3, 3), (-3, 3)).T, 0.0, **PRINTED)
    for half in printed_path():
        ax.plot(*_upright(half), **PRINTED)
    table.name_space(ax, order=UPRIGHT)
    ax.view_init(32, -118)


def _figure_eight(ax):
    """The four parts of the separatrix; their names."""
    result = branches(**EIGHT)
    ax.computed_zorder = False  # short lines of equilibria over the branches that would hide them
    for branch, colour, opaque, thin, order in zip(result.branches, LOOPS, OPAQUE, THIN, FROM_BEHIND):
        ax.plot_surface(*_upright(branch.points), color=colour, alpha=opaque, rstride=4, cstride=6,
                        linewidth=thin, edgecolor="#333333", shade=False,
                        zorder=order)
        ax.plot(*_upright(branch.saddle), zorder=6, **style.MEANING["unstable"])
        ax.plot(*_upright(branch.centre), zorder=6, **style.MEANING["stable"])
    _one_eight(ax, *result.branches[:2])
    table.name_space(ax, 0.98, order=UPRIGHT)
    ax.view_init(26, -20)  # onto both loops: from other sides one hides the other
    return [branch.name for branch in result.branches]


def _one_eight(ax, left, right):
    """The two loops of one saddle, in the middle of a branch: the surfaces are made of such eights."""
    row = len(left.saddle) // 2
    other = int(np.abs(right.saddle - left.saddle[row]).sum(axis=1).argmin())
    for points in (left.points[row], right.points[other]):
        ax.plot(*_upright(points), zorder=5, **EIGHT_LINE)


def projections(plt: ModuleType):
    """Fig. 17: four values of lambda1 to one scale."""
    figure, axes = plt.subplots(1, 4, figsize=(14.0, 4.7), layout="constrained", sharey=True)
    for ax, lam in zip(axes, (*table.LAMBDAS, LAMBDA_BEYOND)):
        scene = table.printed_scene("middle", lam)
        _projection(ax, scene, draw_motion=lam != LAMBDA_BEYOND)
        ax.set_title(rf"$\lambda_1={lam}$, $c={scene.b - scene.a:g}$")
    axes[0].set_ylabel("$x_3$")
    style.legend(figure, [("stable equilibria", style.MEANING["stable"]),
                          ("unstable equilibria", style.MEANING["unstable"]),
                     (r"plane $x_1+b=x_3$ (periodic)", style.MEANING["dividing"]),
                     (r"plane $x_1+b=-x_3$ (spin-up)", style.MEANING["spin-up"]),
                     ("motion of Table 3", style.MEANING["this motion"]), ("start", style.MARKER["start"]),
                     ("folds", style.MARKER["degenerate"]), (r"printed: $x_1=x_3$", LINE),
                     (f"fourth surface: (71), $x_2=0$, $G_2={LEVEL}$", FOURTH),
                          ("fourth surface as printed", PRINTED)], columns=5)
    return figure


LINE = style.MEANING["printed"]
FOURTH = {"color": style.WINE, "linewidth": 1.8, "zorder": 1.5}  # below the plane that its ends tend to
VIEW = ((-8.0, 4.5), (-6.25, 6.25))  # of x1 and x3, in every panel of Fig. 17


def _projection(ax, scene, draw_motion):
    b = scene.b
    for x1, x3, stable in table.equilibria("middle", scene, HEIGHTS):
        table.draw_equilibria(ax, x1, x3, stable)
        folds = np.nonzero(np.diff(stable))[0]
        ax.plot(x1[folds], x3[folds], zorder=5, **style.MARKER["degenerate"])
    ends = np.array([-20.0, 20.0])
    ax.plot(ends, ends + b, **style.MEANING["dividing"])
    ax.plot(ends, -ends - b, **style.MEANING["spin-up"])
    ax.plot(ends, ends, **LINE)
    for curves, look in ((true_level(scene), FOURTH), (printed_level(scene), PRINTED)):
        for curve in curves:
            ax.plot(*curve.T, **look)
    if draw_motion:
        states = _tube(scene, table.START_MIDDLE)
        ax.plot(states[:, 0], states[:, 2], **style.MEANING["this motion"])
        ax.plot(table.START_MIDDLE[0], table.START_MIDDLE[2], zorder=6, **style.MARKER["start"])
    ax.set(xlim=VIEW[0], ylim=VIEW[1], aspect="equal", xlabel="$x_1$")
