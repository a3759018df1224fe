"""A motion in the space of rates, beside the separatrix."""
from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ....answers.equilibria import equilibria
from ....orbit.reduction import reduce
from ....orbit.separatrix.sheets import separatrix
from ... import style
from ...surface.mesh import triangulate
from .. import canvas, which
from ..measures import Measures, measures
from ..path import path, turning
from ..solid import in_space
from ..solid.in_space import Box
from ..subject import DEFAULT_SPAN, Subject, subject
from .rest_states import CURVES, FOLD, POINTS, Rest, meanings, rest_states

if TYPE_CHECKING:
    from matplotlib.axes import Axes

NEAR = 3.0  # times the motion's own size: a separatrix so near is in the picture
AWAY = 2.5  # times the largest rate beside the separatrix: a spin-up is followed so far
TURNS = 60  # of a component: more would fill the picture
REACH, FARTHEST, BEYOND = 4.0, 400.0, 2.5  # of the sheets, as of `separatrix`; beyond the box, so that none ends inside
COARSE, FINEST, FACETS = (40, 57), 10.0, 12_000  # the first shape, how much finer the second may be, triangles to aim at
COLOURS = (style.SKY, style.GREEN, style.PURPLE, style.YELLOW)  # of sheets; orange is the motion's
ROUND = 0.06  # of the motion's size, about a motion that is a point


def space(case: Any, state: Any = None, ax: Axes | None = None, span: Any = None, units: str | None = None, size: tuple[float, float] | None = None,
          legend: bool = True) -> Axes:
    """Draw a motion in the space of rates, and return the (three-dimensional) axes.

    The box is that of the motion, widened to the nearest point of the separatrix where that is no farther than some times the motion's own size;
    otherwise the title says how far away it is. Sheets of the separatrix and curves of equilibria are drawn as far as they lie in the box; a
    spin-up is followed until it has left the separatrix behind. Scenes without a separatrix show the motion and the equilibria. span: as of
    `time`.
    """
    one = subject(case, state, span)
    which.check("space", one)
    scale, omega = measures(one, units), _path(one)
    box, words = _box(one, omega, scale)
    rest = rest_states(equilibria(one.scene)) if one.twin.plain else Rest([], [], [], np.zeros((0, 3)))
    sheets = _sheets(one, box)
    in_units = Box(np.stack([box.low, box.high]) * scale.rate[1], 1.0)
    with canvas.on(ax, size, space=True) as target:
        rows: list[tuple[str, dict]] = [("this motion", style.MEANING["this motion"]), ("start", style.MARKER["start"])]
        colours = [COLOURS[number % len(COLOURS)] for number in range(len(sheets))]
        in_space.facets(target, [(triangles * scale.rate[1], colour) for (_, triangles), colour in zip(sheets, colours)])
        rows += [(f"separatrix, {name}" if len(sheets) > 1 else "separatrix", {"facecolor": in_space.pale(colour)})
                 for (name, _), colour in zip(sheets, colours)]
        rows += _rest(target, rest, box, scale.rate[1])
        in_space.line(target, box.inside(omega) * scale.rate[1], style.MEANING["this motion"], zorder=8)
        in_space.line(target, omega[:1] * scale.rate[1], style.MARKER["start"], zorder=9)
        in_space.furnish(target, in_units, tuple(scale.label(name, scale.rate[0]) for name in scale.names))
        canvas.title(target, one.heading, words)
        if legend:
            canvas.legend(target, rows, ax is None)
    return target


def _path(one: Subject) -> np.ndarray:
    """The motion (n, 3): one period, or the span as far as a picture can show it; a spin-up until it has left the separatrix behind."""
    period = one.motion.period
    low, high = (0.0, period) if period and one.case is None and one.span is None else one.span or DEFAULT_SPAN
    if period:
        high = min(high, low + period) if high > low else low + period
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
    own = Box(np.concatenate([omega, omega[:1] + size / 2, omega[:1] - size / 2]) if np.ptp(omega) == 0 else omega)
    witness = one.motion.velocity_witness
    if witness is None or one.motion.margin_velocity is None:
        return own, ""
    away = float(np.abs(np.array(witness) - own.centre).max())
    if away > NEAR * own.half:
        return own, f"the separatrix is {one.motion.margin_velocity * scale.rate[1]:.4g} {scale.rate[0]} away, outside of this picture".replace("  ", " ")
    around = np.array(witness) + np.array([[-0.5], [0.5]]) * own.half
    return Box(np.concatenate([omega, around])), ""


def _sheets(one: Subject, box: Box) -> list[tuple[str, np.ndarray]]:
    """(name, triangles (n, 3, 3)) of the sheets of the separatrix inside the box; as fine as the box asks for."""
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
    meshes = [(sheet.name, triangulate(sheet)) for sheet in separatrix(one.twin, reach=reach, shape=shape).sheets]
    pieces = [(name, box.clipped(mesh.points[mesh.triangles])) for name, mesh in meshes]
    return [(name, triangles) for name, triangles in pieces if len(triangles)]


def _rest(ax, rest: Rest, box: Box, per_rate: float):
    """The equilibria inside the box; rows of the legend for those."""
    curves = [(kind, points) for kind, points in rest.curves if box.holds(points).any()]
    points = [(kind, at) for kind, at in rest.points if box.holds(at)]
    folds = rest.folds[box.holds(rest.folds)]
    for kind, line in curves:
        in_space.line(ax, box.inside(line) * per_rate, CURVES[kind], zorder=6)
    for kind, at in points:
        in_space.line(ax, at[None] * per_rate, POINTS[kind], zorder=7)
    if len(folds):
        in_space.line(ax, folds * per_rate, FOLD, zorder=7)
    return meanings(Rest(curves, [], points, folds))
