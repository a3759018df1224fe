"""The body's box as it turns, as one page of HTML that needs nothing else."""
from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from ....errors import printable
from ... import style
from ...report import html
from .turn import CORNERS, FACES, Turn

SMOOTH = 600  # frames of a page, which are numbers and no pictures


def page(one, found: Turn, scale, path) -> Path:
    """Write the page."""
    unit, per = scale.time(float(np.abs(found.t).max()))
    data = {"t": [float(f"{v * per:.6g}") for v in found.t], "unit": unit, "rate": scale.rate[0],
            "size": [float(f"{v:.5g}") for v in np.linalg.norm(found.omega, axis=1) * scale.rate[1]],
            "rotations": [[round(float(v), 5) + 0.0 for v in rotation.ravel()] for rotation in found.rotations],
            "corners": (CORNERS * found.edges).round(5).tolist(), "edges": found.edges.round(5).tolist(), "faces": FACES,
            "colours": [style.VERMILION, style.GREEN, style.BLUE],
            "names": [one.axes.label(n) for n in (1, 2, 3)], "tip": int(np.argmax(np.abs(found.omega[0]))), "real": float(abs(found.t[-1] - found.t[0]))}
    text = json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")  # nothing of it ends the script
    return html.write(path, "attitude.html", title=printable(one.heading or "Attitude"), data=text, part=found.part(scale.system))
