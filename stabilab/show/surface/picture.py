"""The separatrix by VTK, in the space of rates that every view draws, with title and legend by Matplotlib."""
from __future__ import annotations

from itertools import groupby, product
from pathlib import Path
from typing import Any

import numpy as np

from .. import style
from ..axes import PLAIN
from ..plot import canvas
from ..plot.in_space import FACETS, PALEST, away, rows, sight, space_of
from ..plot.subject import measures, subject
from ..space import Space, across, look, numbers
from .render_probe import use

SIDE = 1000  # dots
SIZE = (7.6, 8.0)  # inches of the whole picture
AWAY, ANGLE = 9.0, 25.0  # of the eye, in halves of the box; deg of what it sees
GLASS = 0.75  # of a surface: what is behind it is seen
LINE, THIN, GRID, BALL = 0.014, 0.005, 0.002, 0.034  # radii, of half of the box


def draw(case: Any, path: Path) -> Path:
    """The still picture (PNG) of a case; needs a renderer that the probe approved."""
    one = subject(case)
    scale = measures(one)
    found = of(one)
    stage = plotter(found)
    try:
        pixels = stage.screenshot(return_img=True)
    finally:
        stage.close()
    with style.drawing() as plt:
        figure = plt.figure(figsize=SIZE, layout="constrained")
        ax = figure.add_subplot()
        ax.imshow(pixels)
        ax.set_axis_off()
        _label(ax, found)
        canvas.title(ax, one.heading, canvas.answer(one, scale), away(one, found, scale))
        canvas.legend(ax, rows(found), True)
        return style.save(figure, path)


def of(one: Any) -> Space:
    """What is drawn of a subject: the axes have the names of the case."""
    scale = measures(one)
    named = [scale.plain(n) + (f", {one.axes.name(n + 1)}" if one.physical and one.axes != PLAIN else "")
             for n in range(3)]
    return space_of(one, named, scale.rate, shape=FACETS, most=np.inf)


def plotter(found: Space) -> Any:
    """A pyvista plotter with all that is drawn, in halves of the edges of the box; the caller closes it."""
    use()
    style.quiet_matplotlib()  # pyvista loads it
    import pyvista
    stage: Any = pyvista.Plotter(off_screen=True, window_size=[SIDE, SIDE])
    stage.set_background("white")
    share = lambda points: (np.asarray(points, float) - found.box.middle) / found.box.half

    def tube(points, radius, colour):
        for inside, run in groupby(points, lambda at: bool(np.abs(at).max() <= 1)):
            if inside and len(places := np.array(list(run))) > 1:
                stage.add_mesh(pyvista.lines_from_points(places).tube(radius=radius), color=colour)
    for n, (colour, branch) in enumerate(found.branches):
        grid = np.moveaxis(share(branch.points).reshape(branch.rows, branch.columns, 3), 2, 0)
        surface = pyvista.StructuredGrid(*(part[..., None] for part in grid)).extract_surface(
            algorithm="dataset_surface")
        stage.add_mesh(surface.clip_box((-1, 1) * 3, invert=False), color=colour, ambient=0.35, diffuse=0.7,
                       specular=0.1, opacity=GLASS, name=f"branch {n}")
    for words, places in found.curves:
        tube(share(places), LINE if words in style.SPACE else THIN, look(words)["color"])
    path, toward = share(found.path or np.empty((0, 3))), sight(found.view)
    tube(path, LINE, style.ORANGE)
    for axis in range(3):
        wall = np.where(np.arange(3) == axis, -np.sign(toward[axis]), path)
        tube(wall, THIN, PALEST)
    for at, step in found.arrows:
        stage.add_mesh(pyvista.Cone(center=share(at), direction=np.divide(step, found.box.half), height=0.11,
                                    radius=0.04),
                       color=style.ORANGE)
    for words, at in found.marks:
        place = share(at)
        stage.add_mesh(pyvista.Sphere(radius=BALL, center=place), color=look(words)["color"])
        tube([place, np.array([*place[:2], -1.0])], THIN, style.GREY)
    for axis, ticks in enumerate(_ticks(found)):  # a grid on the walls behind
        for other in (n for n in range(3) if n != axis):
            for mark in (*(tick for tick, _ in ticks), -1.0, 1.0):
                ends = np.tile(-np.sign(toward), (2, 1))
                ends[:, axis], ends[:, other] = mark, (-1, 1)
                tube(ends, GRID, PALEST)
    stage.camera_position = [tuple(AWAY * toward), (0, 0, 0), (0, 0, 1)]
    stage.camera.view_angle = ANGLE
    return stage


def _ticks(found: Space) -> list[list[tuple[float, str]]]:
    """Of each axis (place in halves of the box, number) of round numbers."""
    box = found.box.scaled(found.rate)
    return [[((v - box.middle[n]) / box.half[n], words) for v, words in zip(ticks, numbers(ticks))]
            for n, ticks in enumerate(map(box.ticks, range(3)))]


def _label(ax: Any, found: Space) -> None:
    """Numbers and names along the outer edges of the box."""
    toward = sight(found.view)
    per = SIDE / 2 / np.tan(np.radians(ANGLE / 2))
    place = lambda p: SIDE / 2 + per * np.array([1, -1]) * across(p, found.view) / (AWAY - toward @ p)
    for axis, (name, ticks) in enumerate(zip(found.names, _ticks(found))):
        edges = [np.insert(np.array(corner, float), axis, 0) for corner in product((-1, 1), repeat=2)]
        outer = max(edges, key=lambda at: -place(at)[0] if axis == 2
                    else place(at)[1] + 0.25 * abs(place(at)[0] - SIDE / 2))
        unit = np.eye(3)[axis]
        along = place(outer + unit) - place(outer - unit)
        across_it = np.array([-along[1], along[0]]) / np.hypot(*along)
        out = across_it * np.sign(across_it @ (place(outer) - SIDE / 2))
        for share, words in ticks:
            ax.text(*(place(outer + share * unit) + 22 * out), words, ha="center", va="center", fontsize=9)
        turn = np.degrees(np.arctan2(-along[1], along[0]))
        ax.text(*(place(outer) + (90 if axis == 2 else 62) * out), name, ha="center", va="center",
                rotation=(turn + 90) % 180 - 90 if axis < 2 else 90)
