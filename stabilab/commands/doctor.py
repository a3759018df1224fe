"""`stabilab doctor`: versions, whether pictures can be drawn, the processor."""
from __future__ import annotations

import os
import platform
import re
from importlib import metadata

from ..packages import EXTRAS
from ..processes import machine
from ..show.render_probe import probe
from ..show.terminal import tell


def doctor(compiling=False):
    """Print it, and load no more than that: the program may be asked because something is missing.

    compiling: compile all loops first."""
    if compiling:
        from ..answers.motions.compiling import compile_all

        tell(f"all loops are compiled, in {compile_all()}")
        return
    tell(text())


def text() -> str:
    """Whether something is missing, versions of packages, the renderer's state or cure, the processor."""
    result = probe()
    rows = [_answer(result), f"stabilab      {_version('stabilab')}",
            f"python        {platform.python_version()} ({platform.platform()})"]
    rows += [f"{name:<14}{_version(name)}{f' (extra {EXTRAS[name]})' if name in EXTRAS else ''}"
             for name in _needed()]
    rendering = (f"works ({result.description})" if result.available
                 else f"does not work: {result.description}; cure: {result.cure}")
    processor = f"{machine()['processor']}, {os.cpu_count()} logical"
    return "\n".join(rows + [f"{'rendering':<14}{rendering}", f"{'processor':<14}{processor}"])


def _needed() -> list[str]:
    """The packages that the program asks for, those of its extras last."""
    try:
        request = metadata.requires("stabilab") or []
    except metadata.PackageNotFoundError:
        request = []
    names = [re.match(r"[A-Za-z0-9_.-]+", line)[0] for line in request if _meant_for_this_machine(line)]
    return list(dict.fromkeys(names + list(EXTRAS)))


def _meant_for_this_machine(requirement: str) -> bool:
    """Whether a package is asked for here, and by no extra: heyoka is on some machines alone."""
    if "extra ==" in requirement or ";" not in requirement:
        return ";" not in requirement
    try:
        from packaging.requirements import Requirement
    except ImportError:  # Matplotlib brings it
        return True
    return Requirement(requirement).marker.evaluate()


def _version(name: str) -> str:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return "not installed"


def _answer(result) -> str:
    """In a line: what is missing, and whether surfaces can be drawn; all other pictures need no renderer."""
    missing = {name: EXTRAS.get(name) for name in _needed() if _version(name) == "not installed"}
    broken = [name for name, extra in missing.items() if not extra]
    extras = list(dict.fromkeys(filter(None, missing.values())))
    parts = [f"NOT INSTALLED: {', '.join(broken)}"] if broken else ["all that stabilab needs is installed"]
    parts += [f"not the extra{'s' * (len(extras) > 1)} {', '.join(extras)}"] if extras else []
    return f"{', but '.join(parts)}; pictures of surfaces {'can' if result.available else 'CANNOT'} be drawn"
