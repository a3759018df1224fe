"""The space of rates: box, equilibria, separatrix and the motion."""
from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ...answers.equilibria import equilibria
from ...equilibrium.result import Equilibria, EquilibriumCurve
from ...orbit.reduction import reduce
from ...orbit.separatrix.sheets import separatrix
from .. import style
from ..sampling import spread
from ..surface.mesh import triangulate
from . import subject as canvas
from . import subject as which
from .path import path, turning
from .subject import Measures, Subject, measures, subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes


# --- Three-dimensional axes: a box about what is drawn, its labels, and what of curves and surfaces lies
# inside it
VIEW = (22, -55)  # degrees: elevation, azimuth
ZOOM = 0.98  # leaves room for the labels
PALE = 0.75  # share of its colour that a surface has
LIGHT = np.array([0.35, -0.55, 0.76])
DARKEST = 0.62  # share of its colour that a facet keeps which the light only grazes
ROOMY = 3.8  # inches: axes that are smaller have fewer ticks
# of an axis that is seen in at least this share of the longest side; of a shorter one fewer, lest they lie on
# each other
TICKS, SEEN = 5, 0.45
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
    return np.concatenate([triangles[number == 3], kept, np.stack([left, b, c], axis=1),
                           np.stack([left, c, right], axis=1)])


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
    """Surfaces, each of triangles (n, 3, 3) in one colour, lit from above, nearer ones before farther ones;
    pixels even in a vector picture, which would hold ten thousands of them."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection
    lit = [(triangles, _lit(triangles, pale(colour, pale_by))) for triangles,
           colour in surfaces if len(triangles)]
    if not lit:
        return
    triangles, colours = (np.concatenate(parts) for parts in zip(*lit))
    ax.add_collection3d(Poly3DCollection(triangles, facecolors=colours, edgecolors="none", linewidths=0,
                                         antialiaseds=False, rasterized=True, zorder=0))


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
    return np.array([math.hypot(math.sin(turn), math.sin(height) * math.cos(turn)),
                     math.hypot(math.cos(turn), math.sin(height) * math.sin(turn)),
                     math.cos(height)])


def furnish(ax: Any, box: Box, labels: tuple[str, ...], view: tuple[float, float] = VIEW) -> None:
    """Limits, labels, ticks and the point of view."""
    from matplotlib.ticker import MaxNLocator
    small = style.share()
    ax.computed_zorder = False  # lines before surfaces: what is behind one is to be seen, too
    for letter, low, high in zip("xyz", box.low, box.high):
        getattr(ax, f"set_{letter}lim")(low, high)
    for setter, words, near in zip((ax.set_xlabel, ax.set_ylabel, ax.set_zlabel), labels, (25, 25, 12)):
        # near the ticks where the figure is small, else below its edge
        setter(words, labelpad=6 - near * (1 - small))
    for axis, words in zip((ax.xaxis, ax.yaxis, ax.zaxis), labels):
        # a letter alone stands upright from every side; with its unit it goes along the axis
        if " " not in words:
            axis.set_rotate_label(False)
            axis.label.set_rotation(0)
        elif axis is ax.zaxis:  # upwards on either side of the box
            axis.set_rotate_label(False)
            axis.label.set_rotation(90)
    ax.tick_params(labelsize=8 * small, pad=3.5 * small)
    # letters have a least size, their number has none
    roomy = min(small, min(ax.bbox.width, ax.bbox.height) / ax.figure.dpi / ROOMY)
    lengths = box.high - box.low
    sides = np.maximum(lengths / lengths.max(), FLATTEST)
    for axis, seen in zip((ax.xaxis, ax.yaxis, ax.zaxis), sides / sides.max() * _seen(view)):
        axis.set_major_locator(MaxNLocator(max(2, min(TICKS, round(TICKS * roomy * seen / SEEN)))))
        axis.set_pane_color((1, 1, 1, 1))
    # the longest side as of a cube
    ax.set_box_aspect(sides, zoom=ZOOM * (1 - (1 - small) / 3) * float(np.linalg.norm(sides)) / math.sqrt(3))
    ax.view_init(*view)


def line(ax: Any, points: np.ndarray, look: dict[str, Any], **more: Any) -> None:
    """A line through points (n, 3)."""
    ax.plot(*np.asarray(points).T, **look | more)


THIN = {"color": style.GREY, "linewidth": 0.6}
SHADOW = {"color": "#BDBDBD", "linewidth": 0.9, "zorder": 0.5}
DROP = {"color": style.GREY, "linewidth": 0.7, "linestyle": (0, (2, 2)), "zorder": 0.6}


def depth(ax: Any, box: Box, path: np.ndarray, points: np.ndarray) -> None:
    """What shows where things are in depth: the shadows of a path (n, 3) on the three walls behind it, and a
    line from each of the points (m, 3) down to the floor."""
    for axis, wall in ((0, box.low[0]), (1, box.high[1]), (2, box.low[2])):
        shadow = np.array(path, float)
        shadow[:, axis] = wall + 0 * shadow[:, axis]  # gaps stay gaps
        line(ax, shadow, SHADOW)
    for point in points:
        line(ax, np.array([point, [*point[:2], box.low[2]]]), DROP)


def arrows(ax: Any, box: Box, path: np.ndarray, look: dict[str, Any], shares: tuple[float, ...]) -> None:
    """The direction of a motion (n, 3), at shares of the length of its path."""
    steps = np.diff(path, axis=0)
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(steps, axis=1))])
    if not np.isfinite(length[-1]) or length[-1] == 0:
        return
    for n in np.searchsorted(length, np.array(shares) * length[-1]).clip(1, len(steps)) - 1:
        ax.quiver(*path[n], *steps[n], length=0.11 * box.half, normalize=True, color=look["color"],
                  linewidth=look["linewidth"], arrow_length_ratio=0.95, pivot="middle", zorder=8)


# --- What a plot of a surface with motions on it is made of, and which of its lines lie in front
STEEP = 33  # degrees of elevation: from higher up the axes' labels run into each other
Look = dict[str, Any]


@dataclass
class SurfaceLines:
    """surface: triangles (n, 3, 3); box, view, labels: of the axes; words: for the title; lines: (points (n,
    3), look, whether in front); marks: (points, look); rows: of the legend. All in the units of the axes."""

    surface: np.ndarray
    box: Box
    view: tuple[float, float]
    labels: tuple[str, ...]
    words: str
    lines: list[tuple[np.ndarray, Look, bool]] = field(default_factory=list)
    marks: list[tuple[np.ndarray, Look]] = field(default_factory=list)
    rows: list[tuple[str, Look]] = field(default_factory=list)

    def add(self, points: np.ndarray, look: Look, outward: np.ndarray) -> None:
        """A line, in parts that lie in front of the surface and behind it; outward (n, 3): normals of the
        surface, zero where it hides nothing."""
        front = outward @ sight(self.view) >= 0
        for side in (True, False):
            near = front == side
            near[:-1] |= near[1:] if side else False  # the part in front takes the step across the edge
            if near.any():
                self.lines.append((np.where(near[:, None], points, np.nan), look, side))


def sight(view: tuple[float, float]) -> np.ndarray:
    """The direction from the centre to the eye."""
    up, round_ = np.radians(view)
    return np.array([np.cos(up) * np.cos(round_), np.cos(up) * np.sin(round_), np.sin(up)])


def facing(direction: np.ndarray, aside: float = 25.0) -> tuple[float, float]:
    """A view in which a direction points to the eye, somewhat aside."""
    size = float(np.linalg.norm(direction)) or 1.0
    up = float(np.degrees(np.arcsin(np.clip(direction[2] / size, -1, 1))))
    return float(np.clip(up + 12, -STEEP,
                         STEEP)), float(np.degrees(np.arctan2(direction[1], direction[0])) + aside)


def grid_triangles(points: np.ndarray) -> np.ndarray:
    """Triangles (n, 3, 3) of a grid of points (r, c, 3)."""
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[:-1, 1:], points[1:, 1:]
    return np.concatenate([np.stack([a, b, d], 2).reshape(-1, 3, 3),
                           np.stack([a, d, c], 2).reshape(-1, 3, 3)])


def levels(x: np.ndarray, y: np.ndarray, height: np.ndarray, values: Any) -> list[np.ndarray]:
    """The lines (n, 2) in (x, y) on which a function, height (y, x), has one of the values."""
    from contourpy import contour_generator
    contours: Any = contour_generator(x, y, height)
    return [line for value in values for line in contours.lines(float(value)) if len(line) > 1]


# --- Equilibria as curves and points to draw, and how each verdict looks
CURVES: dict[str, dict[str, Any]] = {
    "stable": {"color": style.BLUE, "linestyle": "-", "linewidth": 2.0},
    "unstable": {"color": style.VERMILION, "linestyle": "--", "linewidth": 1.8},
    "undecided": {"color": style.GREY, "linestyle": ":", "linewidth": 2.0}}
POINTS: dict[str, dict[str, Any]] = {
    "stable": {"marker": "o", "color": style.BLUE, "markersize": 7, "linestyle": "none"},
    "unstable": {"marker": "o", "markerfacecolor": "white", "markeredgecolor": style.VERMILION,
                 "markeredgewidth": 1.8, "markersize": 7.5,
                 "linestyle": "none"},
    "undecided": {"marker": "D", "markerfacecolor": "white", "markeredgecolor": style.GREY,
                  "markeredgewidth": 1.8, "markersize": 6.5,
                  "linestyle": "none"}}
FOLD: dict[str, Any] = {"marker": "D", "color": style.GREEN, "markersize": 6, "linestyle": "none"}
TURN = np.linspace(0, 2 * np.pi, 73)


class Rest(NamedTuple):
    """curves: (verdict, points (n, 3)); planes: (verdict, two unit vectors that span it (2, 3)) through the
    origin; points: (verdict, place (3,)); folds: (n, 3), where curves change their verdict. Rates in the
    scene's variables."""

    curves: list[tuple[str, np.ndarray]]
    planes: list[tuple[str, np.ndarray]]
    points: list[tuple[str, np.ndarray]]
    folds: np.ndarray


def rest_states(found: Equilibria, number: int = 600) -> Rest:
    """All equilibria of a scene, so many on every piece of their curves."""
    curves, planes, folds = [], [], []
    for curve in found.curves:
        if curve.name.startswith("plane"):
            verdicts = [segment.verdict for segment in curve.segments]
            planes.append((simple(max(verdicts, key=verdicts.count)), plane_of(curve)))
            continue
        folds += [fold[:3] for fold in curve.folds]
        for segment in curve.segments:
            points = np.array([curve.point(float(t))[:3] for t in spread(*segment.t, number)], float)
            curves.append((simple(segment.verdict), points[np.isfinite(points).all(axis=1)]))
    return Rest(curves, planes, [(simple(p.verdict), np.array(p.at[:3], float)) for p in found.points],
                np.array(folds, float).reshape(-1, 3))


def simple(verdict: str) -> str:
    """"stable", "unstable" or "undecided" of the verdicts in words."""
    return "undecided" if verdict == "undecided" else "unstable" if "unstable" in verdict else "stable"


def plane_of(curve: EquilibriumCurve) -> np.ndarray:
    """Two unit vectors that span a plane of equilibria."""
    return np.linalg.svd(np.array([sample.at[:3] for sample in curve.samples], float),
                         full_matrices=False)[2][:2]


def disc(spanning: np.ndarray, radius: float) -> np.ndarray:
    """The rim (n, 3) of a disc about the origin in the plane of two vectors."""
    return radius * (np.cos(TURN)[:, None] * spanning[0] + np.sin(TURN)[:, None] * spanning[1])


def meanings(rest: Rest, words: str = "equilibria") -> list[tuple[str, dict[str, Any]]]:
    """Rows of a legend for what there is."""
    rows = [(f"{kind} {words}", CURVES[kind]) for kind in CURVES
            if any(kind == one for one, *_ in rest.curves)]
    rows += [(f"plane of {kind} {words}", {"facecolor": CURVES[kind]["color"], "alpha": 0.35})
             for kind in CURVES if any(kind == p for p, _ in rest.planes)]
    rows += [(f"{kind} equilibrium", POINTS[kind]) for kind in POINTS
             if any(kind == p for p, _ in rest.points)]
    return rows + ([("change of stability", FOLD)] if len(rest.folds) else [])


# --- A motion in the space of rates, beside the separatrix
NEAR = 3.0  # times the motion's own size: a separatrix so near is in the picture
AWAY = 2.5  # times the largest rate beside the separatrix: a spin-up is followed so far
TURNS = 60  # of a component: more would fill the picture
# of the sheets, as of `separatrix`; beyond the box, so that none ends inside
REACH, FARTHEST, BEYOND = 4.0, 400.0, 2.5
# the first shape, how much finer the second may be, triangles to aim at
COARSE, FINEST, FACETS = (40, 57), 10.0, 12_000
COLOURS = (style.SKY, style.GREEN, style.PURPLE, style.YELLOW)  # of sheets; orange is the motion's
ROUND = 0.06  # of the motion's size, about a motion that is a point
ARROWS = (0.12, 0.45, 0.8)  # where the path has them, shares of its length


def space(case: Any, state: Any = None, ax: Axes | None = None, span: Any = None, units: str | None = None,
          size: tuple[float, float] | None = None,
          legend: bool = True) -> Axes:
    """Draw a motion in the space of rates, and return the (three-dimensional) axes.

    The box is that of the motion, widened to the nearest point of the separatrix where that is no farther
    than some times the motion's own size; otherwise the title says how far away it is. Sheets of the
    separatrix and curves of equilibria are drawn as far as they lie in the box; a spin-up is followed until
    it has left the separatrix behind. Scenes without a separatrix show the motion and the equilibria. span:
    as of `time`.
    """
    one = subject(case, state, span)
    which.check("space", one)
    scale, omega = measures(one, units), _path(one)
    box, words = _box(one, omega, scale)
    rest = rest_states(equilibria(one.scene)) if one.twin.plain else Rest([], [], [], np.zeros((0, 3)))
    sheets = _sheets(one, box)
    in_units = Box(np.stack([box.low, box.high]) * scale.rate[1], 1.0)
    with canvas.on(ax, size, space=True) as target:
        rows: list[tuple[str, dict]] = [("this motion", style.MEANING["this motion"]),
                                        ("start", style.MARKER["start"])]
        colours = [COLOURS[number % len(COLOURS)] for number in range(len(sheets))]
        facets(target,
               [(triangles * scale.rate[1], colour) for (_, triangles), colour in zip(sheets, colours)])
        rows += [(f"separatrix, {name}" if len(sheets) > 1 else "separatrix", {"facecolor": pale(colour)})
                 for (name, _), colour in zip(sheets, colours)]
        rows += _rest(target, rest, box, scale.rate[1])
        drawn = box.inside(omega) * scale.rate[1]
        spots = [at for _, at in rest.points if box.holds(at)]
        depth(target, in_units, drawn, np.array([omega[0], *spots]) * scale.rate[1])
        line(target, drawn, style.MEANING["this motion"], zorder=8)
        arrows(target, in_units, drawn, style.MEANING["this motion"], ARROWS)
        line(target, omega[:1] * scale.rate[1], style.MARKER["start"], zorder=9)
        furnish(target, in_units, tuple(scale.label(name, scale.rate[0]) for name in scale.names))
        canvas.title(target, one.heading, canvas.answer(one, scale), words)
        if legend:
            canvas.legend(target, rows, ax is None)
    return target


def _path(one: Subject) -> np.ndarray:
    """The motion (n, 3): one period, or the span as far as a picture can show it; a spin-up until it has left
    the separatrix behind."""
    period = one.motion.period
    low, high = one.seen
    if period:
        high = low + period
    _, omega = path(one, low, high)
    size = np.linalg.norm(omega, axis=1)
    if one.motion.velocity_witness is not None and one.motion.fate.word == "spin-up":
        far = np.nonzero(size > AWAY * max(size[0], float(np.linalg.norm(one.motion.velocity_witness))))[0]
        omega = omega[:far[0] + 1] if len(far) else omega
    turns = max(range(3), key=lambda n: turning(omega[:, n]))
    at = _turns(omega[:, turns])
    return omega[:at[TURNS]] if len(at) > TURNS else omega


def _turns(values) -> np.ndarray:
    """Where a curve turns."""
    steps = np.sign(np.diff(values))
    return np.nonzero(steps[1:] * steps[:-1] < 0)[0] + 1


def _box(one: Subject, omega: np.ndarray, scale: Measures) -> tuple[Box, str]:
    """The box of the picture, and where the separatrix is if it is not in it."""
    size = float(np.ptp(omega, axis=0).max()) or ROUND * float(np.abs(omega).max()) or 1.0
    own = Box(np.concatenate([omega, omega[:1] + size / 2, omega[:1] - size / 2]) if np.ptp(omega) == 0
              else omega)
    witness = one.motion.velocity_witness
    if witness is None or one.motion.margin_velocity is None:
        return own, ""
    away = float(np.abs(np.array(witness) - own.centre).max())
    if away > NEAR * own.half:
        return (own,
                f"the separatrix is {one.motion.margin_velocity * scale.rate[1]:.4g} {scale.rate[0]} away, "
                f"outside of this picture".replace("  ", " "))
    around = np.array(witness) + np.array([[-0.5], [0.5]]) * own.half
    return Box(np.concatenate([omega, around])), ""


def _sheets(one: Subject, box: Box) -> list[tuple[str, np.ndarray]]:
    """(name, triangles (n, 3, 3)) of the sheets of the separatrix inside the box; as fine as the box asks
    for."""
    if not one.twin.plain or reduce(one.twin) is None:
        return []
    first = separatrix(one.twin, reach=REACH, shape=COARSE)
    if not first.sheets:
        return []
    least = min(float(np.abs(sheet.points).max()) for sheet in first.sheets)
    reach = min(FARTHEST, max(REACH, BEYOND * REACH * float(np.abs([box.low, box.high]).max()) / least))
    made = _inside(one, box, reach, COARSE)
    number = sum(len(triangles) for _, triangles in made)
    finer = min(FINEST, math.sqrt(FACETS / max(number, 1)))
    return made if finer <= 1 else _inside(one, box, reach, tuple(int(finer * n) for n in COARSE))


def _inside(one, box, reach, shape):
    meshes = [(sheet.name, triangulate(sheet))
              for sheet in separatrix(one.twin, reach=reach, shape=shape).sheets]
    pieces = [(name, box.clipped(mesh.points[mesh.triangles])) for name, mesh in meshes]
    return [(name, triangles) for name, triangles in pieces if len(triangles)]


def _rest(ax, rest: Rest, box: Box, per_rate: float):
    """The equilibria inside the box; rows of the legend for those."""
    curves = [(kind, points) for kind, points in rest.curves if box.holds(points).any()]
    points = [(kind, at) for kind, at in rest.points if box.holds(at)]
    folds = rest.folds[box.holds(rest.folds)]
    for kind, curve in curves:
        line(ax, box.inside(curve) * per_rate, CURVES[kind], zorder=6)
    for kind, at in points:
        line(ax, at[None] * per_rate, POINTS[kind], zorder=7)
    if len(folds):
        line(ax, folds * per_rate, FOLD, zorder=7)
    return meanings(Rest(curves, [], points, folds))
