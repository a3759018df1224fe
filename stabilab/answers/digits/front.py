"""The measured fronts, kept from run to run: per machine and version, in the user's cache folder."""
from __future__ import annotations

import json
import os
from dataclasses import asdict, dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

from ...kept import cache_folder, in_words
from ...machine import machine, versions

CACHE_SCHEMA = "stabilab.front/1"
SAFETY = 1.0  # digits that a setting must have had to spare when it was measured


@dataclass(frozen=True)
class FrontPoint:
    """A setting that no other beats: digits of the states over the span, cost in seconds. rtol: the setting's
    value (nodes for "reduced", order for an expansion)."""

    method: str
    rtol: float
    digits: float
    cost: float


def front(case: Any) -> tuple[FrontPoint, ...]:
    """The measured front of a case on this machine with this version, cheapest first; empty where none was
    measured (`stabilab precision CASE` measures it)."""
    try:
        data = json.loads(_file(case).read_text(encoding="utf-8"))
        if data["schema"] != CACHE_SCHEMA or data["machine"] != machine() | versions():
            return ()
        return tuple(FrontPoint(str(p["method"]), float(p["rtol"]), float(p["digits"]), float(p["cost"]))
                     for p in data["front"])
    except (OSError, ValueError, KeyError, TypeError):
        return ()


def keep(measured: Any) -> Path | None:
    """Keep the front of a measurement over the whole span, a quick one only where there is none yet; the
    file, or None where a part of the span was not judged or the folder cannot be written."""
    if measured.reference.status != "agrees":
        return None
    try:
        path = _file(measured.case)
    except OSError:
        return None
    if measured.quick and front(measured.case):
        return path
    points = [asdict(FrontPoint(p.method, p.value, round(p.digits, 3), p.seconds))
              for p in measured.front("span")]
    text = json.dumps({"schema": CACHE_SCHEMA, "case": measured.case.name, "machine": machine() | versions(),
                       "front": points},
                      indent=1, allow_nan=False)
    waiting = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        waiting.write_text(text, encoding="utf-8")
        waiting.replace(path)
    except OSError:
        return None
    return path


def _file(case: Any) -> Path:
    """One file per motion: the scene's numbers, the start and the span, whatever the case file is called.
    OSError where nothing is to be kept."""
    folder = cache_folder()
    if folder is None:
        raise FileNotFoundError("STABILAB_CACHE is off")
    key = in_words((case.scene, case.state, case.span, *sorted(case.blocks.items())))
    return folder / "precision" / f"{sha256(key.encode()).hexdigest()[:24]}.json"
