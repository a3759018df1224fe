"""Three-dimensional axes: a box about what is drawn, its labels, and what of curves and surfaces lies inside it."""
from __future__ import annotations

import math
from typing import Any

import numpy as np

from ... import style

VIEW = (22, -55)  # degrees: elevation, azimuth
ZOOM = 0.98  # leaves room for the labels
PALE = 0.75  # share of its colour that a surface has
LIGHT = np.array([0.35, -0.55, 0.76])
DARKEST = 0.62  # share of its colour that a facet keeps which the light only grazes
ROOMY = 3.8  # inches: axes that are smaller have fewer ticks
TICKS, SEEN = 5, 0.45  # of an axis that is seen in at least this share of the longest side; of a shorter one fewer, lest they lie on each other
FLATTEST = 0.75  # of the longest side of a box whose sides are in different scales
MARGIN = 1.08  # of a box about the things in it


class Box:
    """A cube about points (n, 3), somewhat larger: low, high (3,)."""

    def __init__(self, points: np.ndarray, margin: float = MARGIN):
        low, high = points.min(axis=0), points.max(axis=0)
        half = margin * float((high - low).max()) / 2 or 0.1 * float(np.abs(points).max()) or 1.0
        self.low, self.high = (low + high) / 2 - half, (low + high) / 2 + half

    @classmethod
    def of(cls, low: np.ndarray, high: np.ndarray) -> Box:
        """The box between two corners, not a cube."""
        box = cls.__new__(cls)
        box.low, box.high = np.asarray(low, float), np.asarray(high, float)
        return box

    @property
    def centre(self) -> np.ndarray:
        return (self.low + self.high) / 2

    @property
    def half(self) -> float:
        return float((self.high - self.low).max()) / 2

    def holds(self, points: np.ndarray) -> np.ndarray:
        """(...,) whether points (..., 3) lie inside."""
        return ((points >= self.low) & (points <= self.high)).all(axis=-1)

    def inside(self, line: np.ndarray) -> np.ndarray:
        """The line (n, 3) with gaps where it leaves."""
        return np.where(self.holds(line)[:, None], line, np.nan)

    def clipped(self, triangles: np.ndarray) -> np.ndarray:
        """The parts of triangles (n, 3, 3) that lie inside, as triangles."""
        for axis in range(3):
            triangles = _cut(triangles, triangles[..., axis] - self.low[axis])
            triangles = _cut(triangles, self.high[axis] - triangles[..., axis])
        return triangles


def _cut(triangles, height):
    """What of the triangles has height >= 0, which is linear on each; heights (n, 3) at the corners."""
    above = height >= 0
    number = above.sum(axis=1)
    one, two = _turned(triangles, height, number == 1, above), _turned(triangles, height, number == 2, ~above)
    corner, left, right = _crossings(*one)
    kept = np.stack([corner, left, right], axis=1)
    lost, left, right = _crossings(*two)
    b, c = two[0][:, 1], two[0][:, 2]
    return np.concatenate([triangles[number == 3], kept, np.stack([left, b, c], axis=1), np.stack([left, c, right], axis=1)])


def _turned(triangles, height, chosen, first):
    """The chosen triangles and their heights, the corner that is alone in front."""
    at = np.argmax(first[chosen], axis=1)
    order = (at[:, None] + np.arange(3)) % 3
    rows = np.arange(len(at))[:, None]
    return triangles[chosen][rows, order], height[chosen][rows, order]


def _crossings(corners, heights):
    """(first corner, where the edges from it to the second and to the third cross height 0)."""
    a = corners[:, 0]
    shares = [heights[:, :1] / (heights[:, :1] - heights[:, n:n + 1]) for n in (1, 2)]
    return a, *(a + share * (corners[:, n] - a) for n, share in zip((1, 2), shares))


def pale(colour: str, share: float = PALE) -> tuple[float, ...]:
    """The colour of a surface, on which lines are to be seen."""
    from matplotlib.colors import to_rgb
    return tuple(1 - share * (1 - part) for part in to_rgb(colour))


def facets(ax: Any, surfaces: list[tuple[np.ndarray, str]], pale_by: float = PALE) -> None:
    """Surfaces, each of triangles (n, 3, 3) in one colour, lit from above, nearer ones before farther ones; pixels even in a vector picture,
    which would hold ten thousands of them."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection
    lit = [(triangles, _lit(triangles, pale(colour, pale_by))) for triangles, colour in surfaces if len(triangles)]
    if not lit:
        return
    triangles, colours = (np.concatenate(parts) for parts in zip(*lit))
    ax.add_collection3d(Poly3DCollection(triangles, facecolors=colours, edgecolors="none", linewidths=0, antialiaseds=False, rasterized=True, zorder=0))


def _lit(triangles, colour):
    """(n, 3) colours of facets: darker where the light only grazes."""
    across = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    size = np.linalg.norm(across, axis=1, keepdims=True)
    across = np.divide(across, size, out=np.tile(LIGHT, (len(across), 1)), where=size > 0)
    return (DARKEST + (1 - DARKEST) * np.abs(across @ LIGHT))[:, None] * np.array(colour)


def polygon(ax: Any, rim: np.ndarray, colour: str, alpha: float) -> None:
    """A flat piece with the rim (n, 3)."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection
    ax.add_collection3d(Poly3DCollection([rim], facecolors=colour, alpha=alpha, edgecolors="none"))


def _seen(view: tuple[float, float]) -> np.ndarray:
    """(3,) what is seen of the length of each axis from this side: 1 of one across the line of sight."""
    height, turn = map(math.radians, view)
    return np.array([math.hypot(math.sin(turn), math.sin(height) * math.cos(turn)), math.hypot(math.cos(turn), math.sin(height) * math.sin(turn)),
                     math.cos(height)])


def furnish(ax: Any, box: Box, labels: tuple[str, ...], view: tuple[float, float] = VIEW) -> None:
    """Limits, labels, ticks and the point of view."""
    from matplotlib.ticker import MaxNLocator
    small = style.share()
    ax.computed_zorder = False  # lines before surfaces: what is behind one is to be seen, too
    for letter, low, high in zip("xyz", box.low, box.high):
        getattr(ax, f"set_{letter}lim")(low, high)
    for setter, words, near in zip((ax.set_xlabel, ax.set_ylabel, ax.set_zlabel), labels, (25, 25, 12)):
        setter(words, labelpad=6 - near * (1 - small))  # near the ticks where the figure is small, else below its edge
    for axis, words in zip((ax.xaxis, ax.yaxis, ax.zaxis), labels):
        if " " not in words:  # a letter alone stands upright from every side; with its unit it goes along the axis
            axis.set_rotate_label(False)
            axis.label.set_rotation(0)
        elif axis is ax.zaxis:  # upwards on either side of the box
            axis.set_rotate_label(False)
            axis.label.set_rotation(90)
    ax.tick_params(labelsize=8 * small, pad=3.5 * small)
    roomy = min(small, min(ax.bbox.width, ax.bbox.height) / ax.figure.dpi / ROOMY)  # letters have a least size, their number has none
    lengths = box.high - box.low
    sides = np.maximum(lengths / lengths.max(), FLATTEST)
    for axis, seen in zip((ax.xaxis, ax.yaxis, ax.zaxis), sides / sides.max() * _seen(view)):
        axis.set_major_locator(MaxNLocator(max(2, min(TICKS, round(TICKS * roomy * seen / SEEN)))))
        axis.set_pane_color((1, 1, 1, 1))
    ax.set_box_aspect(sides, zoom=ZOOM * (1 - (1 - small) / 3) * float(np.linalg.norm(sides)) / math.sqrt(3))  # the longest side as of a cube
    ax.view_init(*view)


def line(ax: Any, points: np.ndarray, look: dict[str, Any], **more: Any) -> None:
    """A line through points (n, 3)."""
    ax.plot(*np.asarray(points).T, **look | more)


THIN = {"color": style.GREY, "linewidth": 0.6}
