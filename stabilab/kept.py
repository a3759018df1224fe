"""What takes long to derive, kept on disk from run to run: in the user's cache folder, by its content and the versions that made it.

STABILAB_CACHE names another folder; "off" keeps nothing. A file that is broken, or that some other program wrote, is no answer: what was asked for is
derived again. A folder that cannot be written stays as it is. Files appear whole, so any number of processes may share the folder.
"""
from __future__ import annotations

import os
import pickle
import sys
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from hashlib import sha256
from io import BytesIO
from pathlib import Path
from typing import Any, TypeVar

from .version import __version__

T = TypeVar("T")
MOST = 256  # files of a kind: beyond, the older half goes


def cache_folder() -> Path | None:
    """The folder for what is kept: STABILAB_CACHE where it is set (None where it is "off"), else under XDG_CACHE_HOME, else the platform's place."""
    named, given = os.environ.get("STABILAB_CACHE"), os.environ.get("XDG_CACHE_HOME")
    if named:
        return None if named == "off" else Path(named)
    if given and Path(given).is_absolute():  # the XDG rule: relative paths are to be ignored
        return Path(given) / "stabilab"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Caches" / "stabilab"
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local") / "stabilab" / "Cache"
    return Path.home() / ".cache" / "stabilab"


def kept(kind: str, content: str, sources: Path, versions: tuple[str, ...], make: Callable[[], T], made_of: tuple[str, ...]) -> T:
    """What `make` returns, from the disk where it was made before from the same content.

    kind: the folder; content: everything that the result depends on, in words; sources: the folder of the code that makes it, of which any change
    counts; versions: of the packages that make it; made_of: the beginnings of the modules whose classes the result may hold.
    """
    path = _path(kind, content, sources, versions)
    if path is None:
        return make()
    found = _read(path, made_of)
    if found is None:
        found = make()
        _write(path, found)
    return found  # type: ignore[return-value]  # of the same content, versions and code


def in_words(thing: Any) -> str:
    """All that makes a dataclass equal to another, as a text: a repr may leave out the unrounded numbers beside the doubles."""
    if isinstance(thing, tuple):
        return f"({', '.join(map(in_words, thing))})"
    if not is_dataclass(thing):
        return repr(thing)
    shown = (f"{field.name}={in_words(getattr(thing, field.name))}" for field in fields(thing) if field.compare)
    return f"{type(thing).__module__}.{type(thing).__qualname__}({', '.join(shown)})"


def _path(kind: str, content: str, sources: Path, versions: tuple[str, ...]) -> Path | None:
    try:
        folder = cache_folder()
        if folder is None:
            return None
        files = sorted((file.name, stat.st_size, stat.st_mtime_ns) for file in sources.rglob("*.py") for stat in (file.stat(),))
        made_by = __version__, sys.version_info[:3], versions, files
    except (OSError, RuntimeError):  # no home, or a package that is no folder of files
        return None
    return folder / kind / f"{sha256(repr((content, made_by)).encode()).hexdigest()[:32]}.pickle"


class _Reader(pickle.Unpickler):
    """Loads classes of some packages, and nothing else: no function that a stranger's file might call."""

    def __init__(self, data: bytes, made_of: tuple[str, ...]) -> None:
        super().__init__(BytesIO(data))
        self.made_of = made_of

    def find_class(self, module: str, name: str) -> Any:
        if not f"{module}.".startswith(self.made_of):
            raise pickle.UnpicklingError(f"{module}.{name} is not of what is kept here")
        found = super().find_class(module, name)
        if not isinstance(found, type):
            raise pickle.UnpicklingError(f"{module}.{name} is no class")
        return found


def _read(path: Path, made_of: tuple[str, ...]) -> object | None:
    try:
        data = path.read_bytes()
        if data[:32] != sha256(data[32:]).digest():
            return None
        return _Reader(data[32:], made_of).load()
    except Exception:  # whatever a strange file makes of the loader: it is no answer
        return None


def _write(path: Path, made: object) -> None:
    try:
        data = pickle.dumps(made, 5)
        path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        waiting = path.with_name(f".{path.name}.{os.getpid()}")
        try:
            waiting.write_bytes(sha256(data).digest() + data)
            waiting.replace(path)
        finally:
            waiting.unlink(missing_ok=True)
        files = sorted(path.parent.glob("*.pickle"), key=lambda file: file.stat().st_mtime)
        for file in files[:len(files) - MOST // 2] if len(files) > MOST else ():
            file.unlink(missing_ok=True)
    except (OSError, pickle.PicklingError, AttributeError, TypeError, RecursionError):  # it is derived again next time
        return
