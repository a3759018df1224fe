"""The space of rates by Matplotlib: three-dimensional axes, and the plot of a motion."""
from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from ...answers.equilibria import equilibria
from ...equilibrium.result import Equilibria, EquilibriumCurve
from ...errors import StabilabError
from ...reasons import number
from .. import style
from ..space.box import EVEN, FLAT, WHOLE, Box, box_of, numbers, shifted
from ..space.drawing import VIEWS, Space, across, beside_limit, limit_of, look, marks_of, near_part, nearest
from ..space.drawing import space as drawn_in
from ..space.reach import SHAPE, branches_of, curves_of
from ..turns.band import Long, often
from ..units import number as shortened
from . import canvas
from . import subject as subjects
from .long import Clock, long
from .path import path, thinned, turning
from .subject import Measures, Subject, measures, subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from mpl_toolkits.mplot3d import Axes3D


# --- Three-dimensional axes: their labels, and what of curves and surfaces lies inside of their box
VIEW = VIEWS[0]  # degrees: elevation, azimuth
ZOOM = 0.98  # leaves room for the labels
PALE = 0.75  # share of its colour that a surface has
# what a surface hides that is seen through: the band of a motion, the sphere of its limit
SHEER = {style.VIOLET: 0.4, style.VERMILION: 0.22}
LIGHT = np.array([0.35, -0.55, 0.76])
DARKEST = 0.62  # share of its colour that a facet keeps which the light only grazes
ROOMY = 3.8  # inches: axes that are smaller have fewer ticks
CROWDED = 26  # letters at the ticks of an axis across: of more it has fewer ticks
SEEN = 0.36  # of the longest side: an axis that is seen shorter has fewer ticks, lest they lie on each other
USUAL = 6  # letters of a number at a tick: longer ones stand farther off
FLATTEST = 0.75  # of the longest side of a box whose sides are in different scales


def between(low: np.ndarray, high: np.ndarray) -> Box:
    """The box between two corners."""
    return Box(tuple((low + high) / 2), tuple((high - low) / 2))


def holds(box: Box, points: np.ndarray) -> np.ndarray:
    """(...,) whether points (..., 3) lie inside."""
    return np.asarray((np.abs(points - box.middle) <= box.half).all(axis=-1))


def inside(box: Box, line: np.ndarray) -> np.ndarray:
    """The line (n, 3) with gaps where it leaves."""
    return np.where(holds(box, np.asarray(line))[:, None], line, np.nan)


def clipped(box: Box, triangles: np.ndarray) -> np.ndarray:
    """The parts of triangles (n, 3, 3) that lie inside, as triangles."""
    full = holds(box, triangles).all(axis=1)
    outside = np.any((triangles < box.low).all(axis=1) | (triangles > box.high).all(axis=1), axis=1)
    parts = [triangles[full]]
    for corners in triangles[~full & ~outside]:
        for axis, sign in product(range(3), (1, -1)):
            corners = _above(corners, sign * (corners[:, axis] - box.middle[axis]) + box.half[axis])
        if len(corners) > 2:  # a polygon without hollows
            first = np.tile(corners[0], (len(corners) - 2, 1))
            parts.append(np.stack([first, corners[1:-1], corners[2:]], axis=1))
    return np.concatenate(parts)


def _above(corners: np.ndarray, height: np.ndarray) -> np.ndarray:
    """The polygon (n, 3) cut off where a height (n,), which is linear on it, is below 0."""
    after, above = np.roll(height, -1), height >= 0
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = corners + (height / (height - after))[:, None] * (np.roll(corners, -1, axis=0) - corners)
    retained = np.stack([above, above != (after >= 0)], axis=1).ravel()
    return np.stack([corners, crossing], axis=1).reshape(-1, 3)[retained]


def pale(colour: str, fraction: float = PALE) -> tuple[float, ...]:
    """The colour of a surface, on which lines are to be seen."""
    from matplotlib.colors import to_rgb
    return tuple(1 - fraction * (1 - part) for part in to_rgb(colour))


def facets(ax: Axes3D, surfaces: list[tuple[np.ndarray, str]], pale_by: float = PALE) -> None:
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


def veil(ax: Axes3D, triangles: np.ndarray, colour: str) -> None:
    """A surface of triangles (n, 3, 3) that is seen through, lit from above."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection
    if not len(triangles):
        return
    drawn = Poly3DCollection(triangles, facecolors=_lit(triangles, pale(colour, 1.0)), edgecolors="none",
                             linewidths=0, antialiaseds=False, rasterized=True, zorder=4)
    # as a whole: facets that are each seen through would be seen twice where they meet
    drawn.set_agg_filter(lambda image, dpi: (image * (1.0, 1.0, 1.0, SHEER[colour]), 0, 0))
    drawn.set_gid(colour)
    ax.add_collection3d(drawn)


def _lit(triangles: np.ndarray, colour: Sequence[float]):
    """(n, 3) colours of facets: darker where the light only grazes."""
    across = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    size = np.linalg.norm(across, axis=1, keepdims=True)
    across = np.divide(across, size, out=np.tile(LIGHT, (len(across), 1)), where=size > 0)
    return np.minimum((DARKEST + (1 - DARKEST) * np.abs(across @ LIGHT))[:, None] * np.array(colour), 1.0)


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


def furnish(ax: Axes3D, box: Box, labels: tuple[str, ...], view: tuple[float, float] = VIEW) -> None:
    """Limits, labels, ticks and the point of view."""
    small = style.share()
    lengths = np.array(box.half)
    sides = np.maximum(lengths / lengths.max(), FLATTEST)
    # letters have a least size, their number has none
    roomy = min(small, min(ax.bbox.width, ax.bbox.height) / ax.figure.dpi / ROOMY)
    parts = sides / sides.max() * _seen(view)
    ticks = [box.ticks(n, 3 if roomy * part > SEEN else 2) for n, part in enumerate(parts)]
    ticks = [box.ticks(n, 2) if n < 2 and sum(map(len, numbers(shifted(row, "")[0]))) > CROWDED else row
             for n, row in enumerate(ticks)]
    values, labels = zip(*map(shifted, ticks, labels))
    power = math.floor(math.log10(max(abs(v) for row in values for v in row)))
    power = power if not -3 < power < 5 else 0
    if power:
        labels = tuple(text.replace("(", rf"($10^{{{power}}}$ ") for text in labels)
    ax.computed_zorder = False  # lines before surfaces: what is behind one is to be seen, too
    for letter, low, high in zip("xyz", box.low, box.high):
        getattr(ax, f"set_{letter}lim")(low, high)
    for setter, label, nearby in zip((ax.set_xlabel, ax.set_ylabel, ax.set_zlabel), labels, (25, 25, 12)):
        # near the ticks where the figure is small, else below its edge
        setter(label, labelpad=6 - nearby * (1 - small))
    for axis, label in zip((ax.xaxis, ax.yaxis, ax.zaxis), labels):
        # a letter alone stands upright from every side; with its unit it goes along the axis
        if " " not in label:
            axis.set_rotate_label(False)
            axis.label.set_rotation(0)
        elif axis is ax.zaxis:  # upwards on either side of the box
            axis.set_rotate_label(False)
            axis.label.set_rotation(90)
    ax.tick_params(labelsize=8 * small, pad=3.5 * small)
    for axis, places, shown_values in zip((ax.xaxis, ax.yaxis, ax.zaxis), ticks, values):
        shown = numbers([v / 10.0**power for v in shown_values])
        axis.set_ticks(places, labels=shown)
        if (longer := max(map(len, shown)) - USUAL) > 0:
            axis.set_tick_params(pad=(3.5 + 2.5 * longer) * small)
            axis.labelpad += 4 * longer
        axis.set_pane_color((1, 1, 1, 1))
    # the longest side as of a cube
    ax.set_box_aspect(sides, zoom=ZOOM * (1 - (1 - small) / 3) * float(np.linalg.norm(sides)) / math.sqrt(3))
    ax.view_init(*view)


def line(ax: Axes3D, points: np.ndarray, look: dict[str, Any], **more: Any) -> None:
    """A line through points (n, 3)."""
    ax.plot(*np.asarray(points).T, **look | more)


THIN = {"color": style.GREY, "linewidth": 0.6}
PALEST = "#BDBDBD"
SHADOW = {"color": PALEST, "linewidth": 0.9, "zorder": 0.5}
DROP = {"color": style.GREY, "linewidth": 0.7, "linestyle": (0, (2, 2)), "zorder": 0.6}


def depth(ax: Axes3D, box: Box, path: np.ndarray, points: Iterable[Any],
          view: tuple[float, float] = VIEW) -> None:
    """What shows where things are in depth: the shadows of a path (n, 3) on the three walls behind it, and a
    line from each of the points down to the floor."""
    for axis, toward in enumerate(sight(view)):
        shadow = np.array(path, float)
        wall = (box.low if toward > 0 else box.high)[axis]
        shadow[:, axis] = wall + 0 * shadow[:, axis]  # gaps stay gaps
        line(ax, shadow, SHADOW)
    for point in points:
        line(ax, np.array([point, [*point[:2], box.low[2]]]), DROP)


# --- What a plot of a surface with motions on it is made of, and which of its lines lie in front
# degrees: from higher up the axes' labels run into each other; from as low as the floor, or along an axis,
# those of one stand on another's
STEEP, LOW, OBLIQUE = 33, 8, 15
Look = dict[str, Any]


@dataclass
class SurfaceLines:
    """surface: triangles (n, 3, 3); box, view, labels: of the axes; title; lines: (points (n,
    3), look, whether in front); marks: (points, look); rows: of the legend; swept: triangles (n, 3, 3) of
    what many turns fill. All in the units of the axes."""

    surface: np.ndarray
    box: Box
    view: tuple[float, float]
    labels: tuple[str, ...]
    title: str
    lines: list[tuple[np.ndarray, Look, bool]] = field(default_factory=list)
    marks: list[tuple[np.ndarray, Look]] = field(default_factory=list)
    rows: list[tuple[str, Look]] = field(default_factory=list)
    swept: np.ndarray = field(default_factory=lambda: np.empty((0, 3, 3)))

    def add(self, points: np.ndarray, look: Look, outward: np.ndarray) -> None:
        """A line, in parts that lie in front of the surface and behind it; outward (n, 3): normals of the
        surface, zero where it hides nothing."""
        front = outward @ sight(self.view) >= 0
        for side in (True, False):
            nearby = front == side
            nearby[:-1] |= nearby[1:] if side else False  # the part in front takes the step across the edge
            if nearby.any():
                self.lines.append((np.where(nearby[:, None], points, np.nan), look, side))


def sight(view: tuple[float, float]) -> np.ndarray:
    """The direction from the centre to the eye."""
    up, round_ = np.radians(view)
    return np.array([np.cos(up) * np.cos(round_), np.cos(up) * np.sin(round_), np.sin(up)])


def facing(direction: np.ndarray, aside: float = 25.0) -> tuple[float, float]:
    """A view in which a direction points to the eye, somewhat aside."""
    size = float(np.linalg.norm(direction)) or 1.0
    up = float(np.degrees(np.arcsin(np.clip(direction[2] / size, -1, 1)))) + 12
    round_ = float(np.degrees(np.arctan2(direction[1], direction[0]))) + aside
    off = (round_ + 45) % 90 - 45
    return (math.copysign(min(max(abs(up), LOW), STEEP), up),
            round_ + math.copysign(max(OBLIQUE - abs(off), 0.0), off))


def grid_triangles(points: np.ndarray) -> np.ndarray:
    """Triangles (n, 3, 3) of a grid of points (r, c, 3)."""
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[:-1, 1:], points[1:, 1:]
    return np.concatenate([np.stack([a, b, d], 2).reshape(-1, 3, 3),
                           np.stack([a, d, c], 2).reshape(-1, 3, 3)])


def levels(x: np.ndarray, y: np.ndarray, height: np.ndarray,
           values: np.ndarray | Sequence[float]) -> list[np.ndarray]:
    """The lines (n, 2) in (x, y) on which a function, height (y, x), has one of the values."""
    from contourpy import contour_generator
    contours: Any = contour_generator(x, y, height)
    return [line for value in values for line in contours.lines(float(value)) if len(line) > 1]


# --- Equilibria as curves and points to draw, and how each verdict looks
CURVES: dict[str, Look] = {kind: style.MEANING[kind] for kind in style.EQUILIBRIA}
EQUILIBRIUM_LOOKS: dict[str, Look] = {kind: style.MARKER[mark] for kind, mark in zip(
    style.EQUILIBRIA, ("centre", "saddle", "undecided"))}
TURN = np.linspace(0, 2 * np.pi, 73)


def plane_of(curve: EquilibriumCurve) -> np.ndarray:
    """Two unit vectors that span a plane of equilibria."""
    return np.linalg.svd(np.array([sample.at[:3] for sample in curve.samples], float),
                         full_matrices=False)[2][:2]


def disc(spanning: np.ndarray, radius: float) -> np.ndarray:
    """The rim (n, 3) of a disc about the origin in the plane of two vectors."""
    return radius * (np.cos(TURN)[:, None] * spanning[0] + np.sin(TURN)[:, None] * spanning[1])


# --- A motion in the space of rates, beside the separatrix
FINE, MOST = 1e-3, 6000  # of the picture: how near a line with fewer points stays to it; points
# turns of a rate: a line with more of them is drawn thin; of one to which MOST leaves no ten points a round,
# the first
CLOSE, SOLID, FIRST = 60, MOST // 5, 48
SLIM = {"linewidth": 0.9}
FACETS = (96, 129)  # rows and columns of a branch: those that are in front are found by their middles


def space(case: Any, state: Any = None, ax: Axes | None = None, span: Any = None, units: str | None = None,
          size: tuple[float, float] | None = None,
          legend: bool = True) -> Axes:
    """Draw a motion in the space of rates, and return the (three-dimensional) axes.

    The box is that of the motion, widened to the nearest point of the separatrix and to equilibria where
    these are no farther than some times the motion's own size; otherwise the title says how far away the
    separatrix is. Where the motion hardly goes along an axis, that has a scale of its own. Branches of the
    separatrix and curves of equilibria are drawn as far as they lie in the box; a spin-up is followed until
    it has left the separatrix behind. Scenes without a separatrix show the motion and the equilibria. span:
    as of `time`.
    """
    x = subject(case, state, span)
    subjects.check("space", x)
    scale = measures(x, units)
    result = space_of(x, scale.names, scale.rate, shape=FACETS, clock=scale.time)
    with canvas.on(ax, size, space=True) as target:
        draw(target, result)
        return canvas.explained(target, rows(result) if legend else [], ax is None,
                                x.heading, canvas.answer(x, scale), away(x, result, scale),
                                result.part, notes=canvas.notes(x, scale))


def space_of(item: Subject, names: Iterable[str], rate: tuple[str, float], resolved: Equilibria | None = None,
             shape: tuple[int, int] = SHAPE, most: float = WHOLE, reaching: bool = False,
             clock: Clock | None = None) -> Space:
    """What is drawn of a subject. names, rate: as of `space`; resolved: its equilibria, where these are
    worked out already; shape: of the branches; most, reaching: as of `box_of`; clock: the unit of times so
    long, None for that of the subject."""
    moved = item.motion if item.state is not None else None
    if resolved is None:
        try:
            resolved = equilibria(item.scene)
        except StabilabError:
            resolved = None
    line, part, turns = (([], "", None) if moved is None else _path(item, clock or measures(item).time))
    marks = marks_of(item.state, moved, resolved)
    limit = limit_of(item.case, item.assumed)
    nearby = [*nearest(resolved, line), *beside_limit(limit, line)] if line else []
    box = box_of(line, marks + nearby, branches_of(item.twin)[0], most, reaching)
    surface, text, _ = branches_of(item.twin, box, shape)
    result = drawn_in(names, rate, box, surface, line, marks, curves_of(resolved, box), text, limit=limit,
                      long=turns)
    return replace(result, part=part)


def draw(ax: Axes3D, result: Space) -> None:
    """Draw a space on three-dimensional axes, in the unit of its labels."""
    per, box = result.rate, result.box.scaled(result.rate)
    grids = [(colour, np.reshape(x.points, (x.rows, x.columns, 3))) for colour, x in result.branches]
    facets(ax, [(clipped(box, per * grid_triangles(points)), colour) for colour, points in grids])
    for text, places in result.curves:
        line(ax, inside(box, per * np.array(places)), look(text), zorder=6)
    gap = np.full((1, 3), np.nan)
    lines = [part for points in result.lines for part in (inside(box, per * np.array(points)), gap)]
    path = np.concatenate(lines[:-1]) if lines else np.empty((0, 3))
    for colour in dict.fromkeys(colour for _, colour, _ in result.veils):
        parts = [grid_triangles(np.reshape(x.points, (x.rows, x.columns, 3)))
                 for _, of, x in result.veils if of == colour]
        veil(ax, clipped(box, per * np.concatenate(parts)), colour)
    depth(ax, box, path, [per * np.array(at) for _, at in result.marks], result.view)
    slim = SLIM if not result.times and often(result.path) > CLOSE / 2 else {}
    line(ax, path, style.MEANING["this motion"] | slim, zorder=8)
    for at, text in result.times:
        _time_beside(ax, per * np.array(at), text, box, result.view)
    for at, step in result.arrows:
        line(ax, per * _head(np.array(at), np.array(step), result), style.MEANING["this motion"], zorder=8)
    for text, at in reversed(result.marks):  # the start above all
        line(ax, per * np.array([at]), marker(text), zorder=9)
    furnish(ax, box, result.names, result.view)


def _time_beside(ax: Axes3D, at: np.ndarray, text: str, box: Box, view: tuple[float, float]) -> None:
    """A time at a place, on the side of it that is away from the middle of the picture."""
    from matplotlib.patheffects import withStroke
    aside = across(box.share(at.tolist()), view)[0]
    ax.text(*at, f" {text} ", ha="left" if aside >= 0 else "right", va="center", fontsize=8.5 * style.share(),
            zorder=10, path_effects=[withStroke(linewidth=2.5, foreground="white")])


def _head(at: np.ndarray, step: np.ndarray, result: Space) -> np.ndarray:
    """(3, 3) the head of an arrow, flat to the eye, whatever the scales of the axes."""
    half = np.array(result.box.half)
    along = step / half
    aside = np.cross(along, sight(result.view))
    return at + half * np.array([-along / 2 + 0.4 * aside, along / 2, -along / 2 - 0.4 * aside])


def marker(text: str) -> Look:
    """How a point is drawn, by its words in a legend."""
    return next((EQUILIBRIUM_LOOKS[kind] for kind, name in style.EQUILIBRIA.items() if name == text),
                look(text))


def rows(result: Space) -> list[tuple[str, Look]]:
    """Rows of a legend: words and look."""
    surfaces = {branch.name for _, branch in result.branches}
    veils = {name for name, *_ in result.veils}
    curves = {text for text, _ in result.curves} | {"this motion"}
    return [(key, {"facecolor": pale(colour)} if key in surfaces
             else {"facecolor": colour, "alpha": SHEER[colour]} if key in veils
             else look(key) if key in curves else marker(key))
            for key, colour in result.legend.items()]


def away(item: Subject, result: Space, scale: Measures) -> str:
    """Where the separatrix is if it is not in the picture."""
    if (item.state is None or item.motion.velocity_witness is None or item.motion.margin_velocity is None
            or result.box.holds(item.motion.velocity_witness)):
        return ""
    size = number(item.motion.margin_velocity * scale.rate[1], 4, -bool(item.motion.velocity_reason))
    return (f"the separatrix is {size} {scale.rate[0]} away, "
            f"outside of this picture".replace("  ", " "))


def _path(item: Subject, clock: Clock) -> tuple[list[Any], str, Long | None]:
    """The motion: one period, or the span as far as a picture can show it; what is to be said where that is a
    part of it; what is drawn of it where it turns often."""
    period = item.motion.period
    low, high = item.seen
    t, omega = path(item, low, low + period if period else high)
    near = len(near_part(t.tolist(), omega.tolist(), item.motion, item.assumed_time))
    t, omega = t[:near], omega[:near]
    resolved = long(item, t, omega, clock)
    if resolved is not None and resolved[0].skins:
        return resolved[1].tolist(), "", resolved[0]
    part = ""
    if (end := min(map(_end_of_the_first_turns, omega.T))) < len(omega):
        unit, per = measures(item).time(abs(high - low))
        shown, full = (f"{shortened(abs(time - low) * per, 3)} {unit}" for time in (t[end], high))
        part = f"the first {shown} of {full} are drawn"
        _, omega = path(item, low, t[end])
    spans = np.ptp(omega, axis=0)
    size = np.where((spans < FLAT * spans.max()) & (spans > EVEN * spans.max()), spans, spans.max() or 1.0)
    nearby = FINE  # of what an axis shows
    while len(line := thinned(omega / size, nearby)) > MOST:
        nearby *= 2
    return (line * size).tolist(), part, None


def _end_of_the_first_turns(rate: np.ndarray) -> int:
    """How many of the values of a rate are drawn, as far as its turns decide."""
    if turning(rate) <= SOLID or np.ptp(rate) <= EVEN * np.abs(rate).max():
        return len(rate)
    steps = np.sign(np.diff(rate))
    return int(np.flatnonzero(steps[1:] != steps[:-1])[FIRST]) + 1
