"""Processes of this machine that work for this one: how many it may use, and an end with the one that
started them, whatever ends it."""
from __future__ import annotations

import os
import platform
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from .interrupt import undoing
from .threads import of_worker
from .version import __version__


# --- What this machine is: processor, versions of the program and of its libraries
def machine() -> dict[str, str]:
    """What the times depend on besides the program."""
    return {"processor": _processor(), "cores": str(os.cpu_count()),
            "system": f"{platform.system()} {platform.machine()}"}


def _processor() -> str:
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


def versions() -> dict[str, str]:
    """The program's version and those of the libraries that do the work."""
    from importlib.metadata import PackageNotFoundError, version

    entries = {"stabilab": __version__, "Python": platform.python_version()}
    for name in ("numpy", "scipy", "heyoka", "python-flint"):
        try:
            entries[name] = version(name)
        except PackageNotFoundError:
            entries[name] = "not installed"
    return entries


def cores() -> int:
    """How many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def helpers(module: str, index: Path, number: int, **streams: Any) -> Iterator[list[subprocess.Popen]]:
    """While the block runs: `number` fresh interpreters that run a module, given the place where they work.
    They are killed at its end, however it ends.

    A fresh interpreter each, so that neither threads nor the caller's own script are copied into it. Each has
    a pipe as its standard input: by its end it learns that the one who started it was killed. Each has one
    thread (`threads`). streams: what `subprocess.Popen` shall do with the others.
    """
    started = [subprocess.Popen([sys.executable, "-m", module, str(index)], stdin=subprocess.PIPE,
                                env=of_worker(), **streams) for _ in range(number)]

    def stop_all() -> None:
        for item in started:
            item.kill()
            item.wait()

    with undoing(stop_all):
        try:
            yield started
        finally:
            stop_all()
