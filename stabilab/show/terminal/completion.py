"""What the shell offers while a command is typed: case files, and the names that an option takes."""
from __future__ import annotations

import os


def cases(incomplete: str) -> list[str]:
    """Case files and folders whose path begins so."""
    return _paths(incomplete, (".toml",))


def certificates(incomplete: str) -> list[str]:
    """Certificates, manifests and other JSON files."""
    return _paths(incomplete, (".json",))


def _paths(begun: str, endings) -> list[str]:
    folder, name = os.path.split(begun)
    try:
        with os.scandir(folder or ".") as found:
            rows = sorted((entry.name, entry.is_dir()) for entry in found)
    except OSError:
        return []
    return [os.path.join(folder, one) + ("/" if is_folder else "") for one, is_folder in rows
            if one.startswith(name) and (name.startswith(".") or not one.startswith("."))
            and (is_folder or one.endswith(endings))]


def _among(*words: str):
    def offered(incomplete: str) -> list[str]:
        return [word for word in words if word.startswith(incomplete)]
    return offered


units = _among("deg", "deg/day", "rpm", "rev/s", "si")
models = _among("exact", "linear", "corrected", "printed", "averaged1", "averaged2", "lindstedt")
methods = _among("taylor", "reduced", "DOP853", "RK45", "RK23", "Radau", "BDF", "LSODA")
papers = _among("constant-torque", "charged", "cavity", "top")
sources = _among("nesc", "basilisk", "orekit", "42")


def kinds(incomplete: str) -> list[str]:
    """Kinds of plots."""
    from ..plot.subject import KINDS
    return [kind for kind in KINDS if kind.startswith(incomplete)]


def audited(incomplete: str) -> list[str]:
    """Papers on record, and files of claims."""
    folder = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "theories", "printed",
                          "papers")
    names = sorted(name.removesuffix(".toml") for name in os.listdir(folder) if name.endswith(".toml"))
    return [name for name in names if name.startswith(incomplete)] + _paths(incomplete, (".toml",))
