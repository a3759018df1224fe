"""Which frame an answer's vectors are in, where a case is written in another one than its principal axes."""
from __future__ import annotations

import math

from ...errors import printable


def key(case) -> dict:
    """The key "frame" of a JSON answer: moments (kg m^2) and axes (rows, in the frame of the file), how well they are known; nothing
    where the two frames are one."""
    frame = _turned(case)
    if frame is None:
        return {}
    return {"frame": {"moments": [float(m) for m in frame.moments], "axes": [[float(v) for v in axis] for axis in frame.axes],
                      "exact": frame.exact, "error": float(frame.error)}}


def back(case, vector) -> list | None:
    """A vector of an answer in the frame of the file; None where the two frames are one."""
    frame = _turned(case)
    return None if frame is None or vector is None else [float(v) for v in frame.back([_exact(v) for v in vector])]


def rows(case, run) -> dict:
    """The key "state_input" of a run: its angular velocities in the frame of the file, a row a time."""
    if _turned(case) is None or "omega" not in run.state:
        return {}
    import numpy as np
    axes = np.array([[float(v) for v in axis] for axis in case.frame.axes])
    return {"state_input": {"omega": np.asarray(run.state["omega"], float) @ axes}}


def lines(case) -> list[str]:
    """The principal axes in words."""
    frame = _turned(case)
    if frame is None:
        return []
    known = "exact" if frame.exact else f"known to {float(frame.error) or 1e-300:.1g}"
    told = [f"frame: principal axes 1, 2, 3 ({known}), along which every vector here is; in the frame of the file, x y z, they are"]
    for number, (moment, axis) in enumerate(zip(frame.moments, frame.axes), 1):
        nearest = max(range(3), key=lambda j: abs(axis[j]))
        angle = math.degrees(math.atan2(math.sqrt(sum(float(v) ** 2 for j, v in enumerate(axis) if j != nearest)), abs(float(axis[nearest]))))
        told.append(f"  axis {number}  ({', '.join(f'{float(v):.6g}' for v in axis)}), {angle:.6g} deg from {'+' if axis[nearest] > 0 else '-'}"
                    f"{'xyz'[nearest]}, moment {float(moment):.6g} kg m^2")
    return told


def note(case) -> list[str]:
    """A line where the axes need not be told in full, and one where a case has thrusters that do nothing."""
    return [*([] if _turned(case) is None else ["  along the principal axes of the tensor, which stabilab show tells"]), *silent(case)]


def silent(case) -> list[str]:
    """A line where there are thrusters and none of them acts: whoever described them asks what they do."""
    thrusters = getattr(case, "thrusters", ())
    if not thrusters or any(one.stuck for one in thrusters):
        return []
    return [f"  no thruster fires: stuck = true in a table [[thrusters]] makes one act for ever ({', '.join(printable(one.name) for one in thrusters)})"]


def _turned(case):
    frame = getattr(case, "frame", None)
    return None if frame is None or frame.as_given else frame


def _exact(value):
    from fractions import Fraction
    return Fraction(float(value))
