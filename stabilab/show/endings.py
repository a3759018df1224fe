"""What the name of an output ends in: for a file the ending is the format, and nothing else is ever in it."""
from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import InputError
from .terminal import listed

if TYPE_CHECKING:
    from os import PathLike

    from ..case.read import Case

PICTURES = (".png", ".svg", ".pdf")
OF_FILES = (*PICTURES, ".jpg", ".jpeg", ".gif", ".csv", ".json", ".nc", ".txt", ".md", ".tex", ".html",
            ".htm", ".toml",
            # no one names a folder so
            ".vtp", ".vtk", ".vtu", ".glb", ".gltf", ".stl", ".obj", ".ply", ".zip")


def file(path: str | PathLike[str], resolved: Sequence[str]) -> Path:
    """The path of a file that is to be written, if its ending is one of `resolved`; InputError otherwise."""
    path = Path(path)
    if ending(path) not in resolved:
        raise InputError(f"{path}: expected a name that ends in {listed(resolved, 'or')}, "
                         f"got {path.suffix or 'no ending'}")
    if path.is_dir():
        raise InputError(f"{path}: expected a file, this is a folder")
    return path


def folder(path: Path) -> Path:
    """The path of a folder that is to be filled; InputError where it is named as a file is."""
    path = Path(path)
    if ending(path) in OF_FILES and not path.is_dir():
        raise InputError(
            f"{path}: expected the name of a folder, for several files are written; got one that ends in "
            f"{path.suffix}")
    return path


def ending(path: str | PathLike[str]) -> str:
    """The ending in small letters."""
    return Path(path).suffix.lower()


def labelled(path: Path, case: Case) -> Path:
    """Where the output of one case goes: the path itself, or, for a combination of [sweep], with its label
    before the ending ("run.csv" becomes "run-2-1.csv")."""
    path = Path(path)
    return path.with_name(f"{path.stem}{case.variant}{path.suffix}")


def numbered(path: str | Path, n: int) -> Path:
    """Where the n-th picture of one output goes: the first to the path itself ("run.png"), the second beside
    it ("run-2.png")."""
    path = Path(path)
    return path if n == 1 else path.with_name(f"{path.stem}-{n}{path.suffix}")
