"""All comparisons: each topic is a module with `rows(small=False)`; small ones only show that they run."""
from __future__ import annotations

import time
from importlib import import_module

from .rows import Row

TOPICS = ("fates", "memory", "orbit_extremes", "periods", "surfaces", "trajectories", "closed_forms",
          "startup", "late_times", "explorer", "waits", "sweeps",
          "scenes")


def topic_rows(topic, small=False) -> list[Row]:
    return import_module(f"benchmarks.{topic}").rows(small)


def machine() -> str:
    """Machine and versions in one line."""
    import os
    import platform
    from importlib.metadata import version
    packages = ", ".join(f"{p} {version(p)}" for p in ("numpy", "scipy", "heyoka", "vtk"))
    return f"{os.cpu_count()} cores, {platform.machine()}, Python {platform.python_version()}, {packages}"


def run_all(small=False) -> tuple[list[Row], float]:
    """All rows, and how long they took."""
    start = time.perf_counter()
    rows = [row for topic in TOPICS for row in topic_rows(topic, small)]
    return rows, time.perf_counter() - start
