"""What this machine is: processor, versions of the program and of its libraries."""
from __future__ import annotations

import os
import platform
from pathlib import Path

from .version import __version__


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

    found = {"stabilab": __version__, "Python": platform.python_version()}
    for name in ("numpy", "scipy", "heyoka", "python-flint"):
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "not installed"
    return found
