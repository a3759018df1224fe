"""Figure 6 of Amer et al. 2024: the separatrix surfaces of the minor axis from above, with the equilibria and
what parts these."""
from __future__ import annotations

from functools import lru_cache

import numpy as np

from ...show import style
from . import paper
from .figure import POINTS, farthest, level_curves, within
from .minor_axis import branches
from .minor_axis import exactness as of_branches

SHAPE = (240, 241)
REACH = 6.3           # radii of the outer fold circle: beyond the corners of the map
LEVELS = np.linspace(0, 7.5, 16)
SIZE, NEAR = 6.0, 2.1  # half a side of the map, and of the enlargement about the folds
BEYOND = 8.0           # half a side of the square in which the fourth surface is traced


def contour_map(plt):
    """Fig. 6: the map, and its middle enlarged."""
    figure, axes = plt.subplots(1, 2, figsize=(11.4, 6.2), layout="constrained")
    scene, found = paper.scene("minor", 100), _branches()
    for ax, size in zip(axes, (SIZE, NEAR)):
        heights = _map(ax, scene, found, size)
    axes[0].set_title(r"Height $x_3>0$ of the separatrix surfaces, $\lambda_1=100$")
    axes[1].set_title("the middle, enlarged")
    box = axes[0].add_patch(plt.Rectangle((-NEAR, -NEAR), 2 * NEAR, 2 * NEAR, fill=False, linewidth=0.9,
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


EDGE = {"color": style.PURPLE, "linewidth": 1.4}
FOURTH = {"color": style.SKY, "linewidth": 1.8}
PRINTED_FOURTH = style.MEANING["printed"] | {"linestyle": "--", "linewidth": 1.6}


@lru_cache(maxsize=1)
def fourth_surface() -> dict:
    """The fourth of the paper's surfaces, (30) for x3 = 0 and G1 = 0, as "printed" and "true": curves (n, 2).
    tan^-1 is the principal value, which jumps at x2 = 0: there the curves end."""
    a, b, found = paper.scene("minor", 100).a, paper.scene("minor", 100).b, {}
    for name, shift, wheel in (("printed", 0.0, b), ("true", a, b - a)):
        def energy(x1, x2, shift=shift, wheel=wheel):
            X = x1 + shift
            return x2**2 - X**2 - 4 * wheel * X - 4 * np.arctan(X / x2)
        found[name] = [curve for half in ((0.0, BEYOND), (-BEYOND, -0.0))
                       for curve in level_curves(energy, 0.0, (-BEYOND, BEYOND), half)]
    return found


def fourth_departure() -> str:
    """How far the printed fourth surface is from the true one within the map, in words."""
    found = fourth_surface()
    shown = [within(curve, (-SIZE, SIZE), (-SIZE, SIZE)) for curve in found["printed"]]
    return (f"The fourth surface of the paper's list, (30) for x3 = 0 and G1 = 0, is drawn in truth and, "
            f"dashed, as printed: up to {farthest(shown, found['true']):.2f} off.")


def _branches():
    return branches(reach=REACH, shape=SHAPE)


def exactness() -> str:
    """How far the vertices of the map are from the surface; how the fourth surface is traced."""
    return f"{of_branches(reach=REACH, shape=SHAPE)}; fourth surface: traced on grids of {POINTS} x {POINTS}"


def _map(ax, scene, found, size):
    """One panel, `size` to all sides of the origin; the filled contours are returned."""
    a, b = scene.a, scene.b
    for branch in found.branches:
        upper, triangles = _upper(np.asarray(branch.points))
        filled = ax.tricontourf(upper[:, 0], upper[:, 1], triangles, upper[:, 2], levels=LEVELS, cmap="Greys",
                                antialiased=True, extend="max")
        ax.plot(*np.asarray(outline(np.asarray(branch.points)))[:, :2].T, **EDGE)
    for branch in paper.equilibria("minor", scene, np.geomspace(0.05, 20, 4000)):
        paper.draw_equilibria(ax, *branch)
    _dividing(ax, a, b)
    for radius in paper.fold_radii(b - a):
        ax.plot(*paper.circle(radius, -a), **style.MEANING["fold"])
    ax.plot(*paper.circle(np.sqrt(2)), **style.MEANING["printed"])
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
