"""The space of the three rates, to be turned by hand: separatrix, equilibria and the motion, as numbers that
a small script of the page draws.

The box is that of the motion with some room about it, so that a surface that reaches far shows the part that
matters. Places are whole numbers of
16 bits along each axis: a hundred thousandth of the box, and half the bytes.
"""
from __future__ import annotations

import math
from base64 import b64encode
from dataclasses import replace

import numpy as np

from ....errors import StabilabError
from ....orbit.result import Fate
from ....orbit.separatrix.sheets import separatrix
from ....validation import reach_of
from ... import style
from ...plot.path import along, angular, path, thinned
from ...plot.subject import subject
from ...surface.write import equilibrium_lines
from ...terminal.letters import printed

SHAPE = (48, 97)     # rows and columns of a sheet
ROOM = 1.9           # half of the box, of the farthest point of the motion from its middle
WHOLE = 2.5          # boxes that a surface may fill at most to be shown whole
BEYOND = 8.0         # boxes: what is farther off is moved in, outside what is drawn
STEPS = 900          # points of the motion, where these make no corners
# of the motion's size: how far a line with fewer points may be from it, at most; points of such a line
SEEN, COARSEST, MOST = 1e-3, 16e-3, 6000
LINES, FEWEST = 1600, 60  # points of all curves of equilibria, of each at least
LATEST = 3.0         # times its first size, up to which a motion that spins up is drawn
NARROW = 0.02        # halves of the box: a surface no wider than that is not seen in it


def space(case, motion, found_equilibria, units, shape=SHAPE) -> dict:
    """What the script draws: box, ticks, sheets, curves and points, and the rows of the legend; `reason`:
    what is to be said of the separatrix."""
    sheets, reason = _sheets(case.scene, shape)
    curve = None if motion is None or case.state is None else _curve(case, motion, bool(sheets))
    marks = _marks(motion, found_equilibria)
    box = _box(curve, sheets, marks)
    reaching = _reaching(case.scene, sheets, box, shape)
    sheets = [sheet for sheet in reaching if _wide(sheet.points, box)]
    unit, one = units.rates
    curves = found_equilibria.curves if found_equilibria is not None else ()
    drawn = {"names": [f"{printed(name)}{f' ({unit})' if unit else ''}" for name in case.scene.components],
             "middle": [v * one for v in box[0]], "half": box[1] * one,
             "sheets": [_sheet(sheet, style.BESIDE[n % len(style.BESIDE)], box) for n,
                        sheet in enumerate(sheets)],
             "curves": _curves(curves, curve, box),
             "points": [m | {"at": _share(m["at"], box)} for m in marks if _inside(m["at"], box)]}
    return {"drawn": drawn, "legend": _legend(drawn), "reason": printed(units.words(reason)),
            "clipped": any(_outside(s.points, box) for s in reaching)}


def _sheet(sheet, colour, box):
    rows, columns, _ = sheet.points.shape
    return {"name": f"{sheet.name[0].upper()}{sheet.name[1:]} of the separatrix", "colour": colour,
            "rows": rows, "columns": columns,
            "at": packed(sheet.points, box)}


def _sheets(scene, shape):
    try:
        found = separatrix(scene, shape=shape)
    except StabilabError as error:
        return (), f"no separatrix is drawn: {error}"
    return found.sheets, found.reason if found.sheets else f"no separatrix is drawn: {found.reason}"


def _reaching(scene, sheets, box, shape):
    """The sheets again, farther out where the box is greater than they."""
    far = max((float(np.abs(s.points).max()) for s in sheets), default=0.0)
    needed = float(np.abs(np.asarray(box[0])).max()) + box[1]
    if not far or far >= needed:
        return sheets
    return separatrix(scene, reach=min(4.0 * 1.5 * needed / far, 1e4), shape=shape).sheets


def _curve(case, motion, beside_sheets):
    """(n, 3) rates along the motion; beside a separatrix a spin-up only while it is near where it began,
    which else would make it a dot."""
    one = replace(subject(case), known=motion)
    until = 1.02 * motion.period if motion.period else abs(reach_of(one.seen))
    cut = beside_sheets and motion.fate is Fate.SPIN_UP
    t, rates = along(one, np.linspace(0.0, until, STEPS),
                     drawn=(lambda states: _near(states, motion)) if cut else len)
    size = float(np.ptp(rates, axis=0).max())
    if not size or not angular(rates, 3 * SEEN * size):
        return rates
    near, (_, every) = SEEN, path(one, 0.0, float(t[-1]))
    while len(rates := thinned(every, near * size)) > MOST and near < COARSEST:
        near *= 2
    return rates[:MOST]


def _near(states, motion):
    """How many of the first rates are near where they began."""
    size = np.linalg.norm(states, axis=1)
    late = np.nonzero(size > LATEST * max(size[: STEPS // 20].max(initial=0.0), _least(motion)))[0]
    return late[0] + 1 if len(late) and late[0] > 20 else len(states)


def _least(motion):
    """A size below which a motion is shown on to: the distance from the separatrix."""
    return (motion.margin_velocity if motion.margin_velocity is not None
            and math.isfinite(motion.margin_velocity) else 0.0)


def _marks(motion, found):
    """Start, nearest point of the separatrix, isolated equilibria."""
    marks = [] if motion is None else [{"kind": "start", "colour": style.BLACK, "at": motion.at[:3]}]
    if motion is not None and motion.velocity_witness is not None:
        marks.append({"kind": "nearest point of the separatrix", "colour": style.YELLOW,
                      "at": motion.velocity_witness})
    for point in found.points if found is not None else ():
        kind = style.kind_of(point)
        marks.append({"kind": style.EQUILIBRIA[kind], "colour": style.colour_of(kind), "at": point.at[:3]})
    return marks


def _box(curve, sheets, marks):
    """(middle, half of the length): of the motion, its start and the nearest separatrix, or of the surface
    where that is not much larger."""
    near = [m["at"] for m in marks if m["kind"] in ("start", "nearest point of the separatrix")]
    whole = np.concatenate([s.points.reshape(-1, 3) for s in sheets]) if sheets else np.zeros((0, 3))
    shown = np.concatenate([part for part in (curve, np.array(near or np.zeros((0, 3)))) if part is not None])
    if not len(shown):
        shown = (whole if len(whole)
                 else np.array([m["at"] for m in marks] or [(1.0, 1.0, 1.0), (-1.0, -1.0, -1.0)]))
        return _about(shown, 1.05)
    middle, half = _about(shown, ROOM)
    if len(whole) and _about(np.concatenate([whole, shown]), 1.05)[1] < WHOLE * half:
        return _about(np.concatenate([whole, shown]), 1.05)
    return middle, half


def _about(points, room):
    low, high = points.min(axis=0), points.max(axis=0)
    half = float((high - low).max()) / 2 * room
    return ((low + high) / 2).tolist(), half or float(np.abs(high).max()) or 1.0


def _curves(curves, curve, box):
    size = float(np.abs(np.asarray(box[0])).max()) + 2 * box[1]
    lines = equilibrium_lines(curves, size,
                              max(FEWEST, LINES // (1 + sum(len(one.segments) for one in curves))))
    lines = [(kind, points) for kind, points in lines if _seen(points[:, :3], box)]
    # a field adds the vertical
    rows = [{"kind": style.EQUILIBRIA[kind], "colour": style.colour_of(kind),
             "at": packed(points[:, :3], box)}
            for kind, points in lines]
    return (rows
            + ([] if curve is None
               else [{"kind": "this motion", "colour": style.MEANING["this motion"]["color"],
                      "at": packed(curve, box)}]))


def _legend(drawn):
    """(words, colour) of all that is drawn, each once."""
    rows = {row["name"]: row["colour"] for row in drawn["sheets"]}
    return list((rows | {row["kind"]: row["colour"] for row in (*drawn["curves"], *drawn["points"])}).items())


def packed(points, box) -> str:
    """Points (..., 3) as 16-bit numbers, base64: 4095 is half of the box."""
    middle, half = box
    share = np.clip((np.asarray(points, float) - middle) / half, -BEYOND, BEYOND)
    return b64encode(np.round(share * 4095).astype("<i2").tobytes()).decode("ascii")


def _share(at, box):
    return [round((float(v) - m) / box[1], 5) for v, m in zip(at, box[0])]


def _inside(at, box):
    return all(abs(v) <= 1 for v in _share(at, box))


def _seen(points, box):
    return bool((np.abs(points - np.asarray(box[0])) <= box[1]).all(axis=-1).any())


def _wide(points, box):
    """Whether a surface has more than a line in the box: the crest along which a loop meets its neighbour is
    the neighbour's too."""
    inside = ((points - np.asarray(box[0]))
              / box[1])[(np.abs(points - np.asarray(box[0])) <= box[1]).all(axis=-1)]
    if not len(inside):
        return False
    _, _, directions = np.linalg.svd(inside - inside.mean(axis=0), full_matrices=False)
    return len(directions) > 1 and float(np.ptp(inside @ directions[1])) > NARROW


def _outside(points, box):
    return bool((np.abs(points - np.asarray(box[0])) > box[1] * (1 + 1e-9)).any())
