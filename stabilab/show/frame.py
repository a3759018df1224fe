"""Which frame an answer's vectors are in, where a case is written in another one than its principal axes."""
from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from ..reasons import number as in_digits
from .axes import IN_FILE, axes_of

if TYPE_CHECKING:
    from ..answers.simulate import Simulation
    from ..case.read import Case


def key(case: Case) -> dict:
    """The key "frame" of a JSON answer: moments (kg m^2) and axes (rows, in the frame of the file), their
    angles (rad) from the nearest axes of the file, how well they are known; nothing where the two frames are
    one."""
    frame = _turned(case)
    if frame is None:
        return {}
    return {"frame": {"moments": [float(m) for m in frame.moments],
                      "axes": [[float(v) for v in axis] for axis in frame.axes],
                      "angles": [_nearest(axis)[1] for axis in frame.axes],
                      "exact": frame.exact, "error": float(frame.error)}}


def back(case: Case, vector: Sequence[float] | None) -> list | None:
    """A vector of an answer in the frame of the file; None where the two frames are one."""
    frame = _turned(case)
    return (None if frame is None or vector is None
            else [float(v) for v in frame.back([Fraction(float(v)) for v in vector])])


def rows(case: Case, run: Simulation) -> dict:
    """The key "state_input" of a run: its angular velocities in the frame of the file, a row a time."""
    if _turned(case) is None or "omega" not in run.state:
        return {}
    import numpy as np
    axes = np.array([[float(v) for v in axis] for axis in case.frame.axes])
    return {"state_input": {"omega": np.asarray(run.state["omega"], float) @ axes}}


def lines(case: Case) -> list[str]:
    """The principal axes in words."""
    result = rows_of_axes(case)
    if not result:
        return []
    info = "exact" if case.frame.exact else f"known to {in_digits(float(case.frame.error) or 1e-300, 1, 1)}"
    return [f"frame: principal axes 1, 2, 3 ({info}), along which every vector here is; in the frame of the "
            f"file, x y z, they are",
            *(f"  {name:<16}{text}" for name, text in result)]


def rows_of_axes(case: Case) -> list[tuple[str, str]]:
    """(its name, where it is in the frame of the file) of each principal axis; nothing where the two frames
    are one."""
    frame = _turned(case)
    names, result = axes_of(case), []
    for number, (moment, axis) in enumerate(zip(frame.moments, frame.axes) if frame else (), 1):
        nearest, angle = _nearest(axis)
        result.append((f"{number}, {names.name(number)}",
                      f"({', '.join(f'{float(v):.6g}' for v in axis)}), {math.degrees(angle):.6g} deg from "
                      f"{'+' if axis[nearest] > 0 else '-'}{'xyz'[nearest]}, moment {float(moment):.6g} "
                      f"kg m²"))
    return result


def _nearest(axis: Sequence[Fraction]) -> tuple[int, float]:
    """(the axis of the file that is nearest to a direction, the angle between them, rad)."""
    nearest = max(range(3), key=lambda j: abs(axis[j]))
    across = math.sqrt(sum(float(v) ** 2 for j, v in enumerate(axis) if j != nearest))
    return nearest, math.atan2(across, abs(float(axis[nearest])))


def components(case, names=None) -> str:
    """About which axes the components of a rate are, where these are not the axes of the file; else nothing.
    names: of the axes, where other than those of the case."""
    if _turned(case) is None:
        return ""
    names = names or axes_of(case)
    return "; ".join(f"ω{n} about {names.whole(n).removesuffix(IN_FILE)}" for n in (1, 2, 3)) + IN_FILE


def note(case: Case) -> list[str]:
    """A line on which axes 1, 2, 3 are, where these are not those of the file."""
    text = components(case)
    return [f"  {text}"] if text else []


def _turned(case):
    frame = getattr(case, "frame", None)
    return None if frame is None or frame.as_given else frame
