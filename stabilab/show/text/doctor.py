"""What this machine has: versions, whether pictures can be drawn, the processor."""
from __future__ import annotations

import os
import platform
import re
from importlib import metadata

from ...packages import EXTRAS
from ..surface.render_probe import probe


def text() -> str:
    """Versions of the program's packages, the renderer's state with its cure, the processor."""
    rows = [f"stabilab      {_version('stabilab')}", f"python        {platform.python_version()} ({platform.platform()})"]
    rows += [f"{name:<14}{_version(name)}{f' (extra {EXTRAS[name]})' if name in EXTRAS else ''}" for name in _needed()]
    return "\n".join(rows + [f"{'rendering':<14}{_rendering()}", f"{'processor':<14}{_processor()}"])


def _needed() -> list[str]:
    """The packages that the program asks for, those of its extras last."""
    try:
        asked = metadata.requires("stabilab") or []
    except metadata.PackageNotFoundError:
        asked = []
    names = [re.match(r"[A-Za-z0-9_.-]+", line)[0] for line in asked if "extra ==" not in line]
    return list(dict.fromkeys(names + list(EXTRAS)))


def _version(name: str) -> str:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return "not installed"


def _rendering() -> str:
    found = probe()
    return f"works ({found.words})" if found.available else f"does not work: {found.words}; cure: {found.cure}"


def _processor() -> str:
    try:
        with open("/proc/cpuinfo", encoding="utf-8", errors="replace") as stream:
            names = [line.split(":", 1)[1].strip() for line in stream if line.startswith("model name")]
    except OSError:
        names = []
    return f"{names[0] if names else platform.processor() or platform.machine()}, {os.cpu_count()} logical"
