"""All equilibria of a scene in the space of rates."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...answers.equilibria import STOPPED
from ...answers.equilibria import equilibria as all_of
from ...errors import InputError
from .. import style
from ..space import Box
from ..units import with_unit
from . import canvas, in_space
from .in_space import CURVES, FOLD, POINTS, Rest, disc, holds, inside, meanings, rest_states
from .subject import Subject, measures, subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes


MANY, FEW = 600, 90  # points on a piece of a curve: a formula, or a search each
FLAT = 1e-9  # of the picture: equilibria nearer than this to a plane across an axis are drawn in it
BEYOND = 2.4  # times the farthest fold, or the nearest point of a curve without one: how far a curve is shown


def equilibria(case: Any, state: Any = None, ax: Axes | None = None, units: str | None = None,
               size: tuple[float, float] | None = None,
               legend: bool = True) -> Axes:
    """Draw all equilibria of a scene, and return the axes.

    Stable ones are full lines and dots, unstable ones dashed lines and circles, undecided ones dotted lines
    and diamonds; green diamonds mark where a curve changes its stability. Where all lie in a plane across an
    axis (a torque on an axis) that plane is drawn, else the space of rates; axes that are given decide it
    themselves. A state, given or of the case, is marked. Of scenes with a direction of space (top) the rates
    of the permanent rotations are drawn. Raises InputError where there is none.
    """
    one = subject(case, state)
    found = all_of(one.scene)
    if not found.points and not found.curves:
        raise InputError(f"plot equilibria: there is nothing to draw: {found.reason}")
    rest, scale = rest_states(found, MANY if one.twin.plain else FEW), measures(one, units)
    box = _box(rest, one)
    flat = _flat_axis(rest, box) if ax is None or getattr(ax, "name", "") != "3d" else None
    with canvas.on(ax, size, space=flat is None) as target:
        labels = tuple(with_unit(name, scale.rate[0]) for name in scale.names)
        if flat is None:
            _in_space(target, rest, box, scale.rate[1], labels, [] if one.state is None else [one.state])
        else:
            _in_plane(target, rest, box, scale.rate[1], labels, flat)
        rows = meanings(rest)
        if one.state is not None:
            kept = [n for n in range(3) if n != flat]
            target.plot(*[[one.state[n] * scale.rate[1]] for n in kept], zorder=6, **style.MARKER["start"])
            rows.append(("start of the motion" if flat is None
                         else "start of the motion, seen along the axis", style.MARKER["start"]))
        plane = ("" if flat is None
                 else f"all have {scale.plain(flat)} = {_constant(rest, flat) * scale.rate[1] + 0.0:.4g} "
                      f"{scale.rate[0]}".rstrip())
        after = STOPPED if found.reason.endswith(STOPPED) else ""
        words = "; ".join(filter(None, (plane, after)))
        return canvas.explained(target, rows if legend else [], ax is None, one.heading, words)


def _box(rest: Rest, one: Subject) -> Box:
    """What to show: all points and folds, the start, and of curves as much again."""
    marks = [np.zeros(3), *(at for _, at in rest.points), *rest.folds,
             *([np.array(one.state)] if one.state is not None else [])]
    near = [np.linalg.norm(points, axis=1).min() for _, points in rest.curves if len(points)]
    size = max([*(float(np.abs(mark).max()) for mark in marks), *near], default=0.0) or 1.0
    reach = size * (BEYOND if rest.curves or rest.planes else 1.1)
    return Box((0.0,) * 3, (reach,) * 3)


def _flat_axis(rest: Rest, box) -> int | None:
    """The axis across which all equilibria lie in one plane; None where they do not, or lie on one line."""
    if rest.planes:
        return None
    places = np.concatenate([*(points[holds(box, points)] for _, points in rest.curves),
                             *(at[None] for _, at in rest.points)])
    if len(places) < 3:
        return None
    flat = [axis for axis in range(3) if np.ptp(places[:, axis]) < FLAT * box.half[0]]
    return flat[0] if len(flat) == 1 else None


def _constant(rest: Rest, axis: int) -> float:
    return float(next(points[0, axis] for _, points in rest.curves if len(points)))


def _in_space(ax, rest, box, per_rate, labels, start):
    in_units = box.scaled(per_rate)
    for kind, spanning in rest.planes:
        in_space.polygon(ax, disc(spanning, box.half[0] * per_rate), CURVES[kind]["color"], 0.3)
    for kind, points in rest.curves:
        in_space.line(ax, inside(box, points) * per_rate, CURVES[kind])
    in_space.depth(ax, in_units, np.empty((0, 3)),
                   [np.array(at) * per_rate for at in (*start, *(at for _, at in rest.points))])
    for kind, at in rest.points:
        in_space.line(ax, at[None] * per_rate, POINTS[kind])
    in_space.line(ax, rest.folds[holds(box, rest.folds)] * per_rate, FOLD)
    for axis in range(3):
        ends = np.zeros((2, 3))
        ends[:, axis] = in_units.low[axis], in_units.high[axis]
        in_space.line(ax, ends, in_space.THIN)
    in_space.furnish(ax, in_units, labels)


def _in_plane(ax, rest, box, per_rate, labels, flat):
    first, second = (n for n in range(3) if n != flat)
    for kind, points in rest.curves:
        shown = inside(box, points)[:, [first, second]] * per_rate
        ax.plot(*shown.T, **CURVES[kind])
    for kind, at in rest.points:
        ax.plot(at[first] * per_rate, at[second] * per_rate, zorder=5, **POINTS[kind])
    ax.plot(rest.folds[:, first] * per_rate, rest.folds[:, second] * per_rate, zorder=5, **FOLD)
    ax.axhline(0, color=style.GREY, linewidth=0.6, zorder=1)
    ax.axvline(0, color=style.GREY, linewidth=0.6, zorder=1)
    ax.set(xlabel=labels[first], ylabel=labels[second],
           xlim=(box.low[first] * per_rate, box.high[first] * per_rate),
           ylim=(box.low[second] * per_rate, box.high[second] * per_rate))
    ax.set_aspect("equal", adjustable="box")
