"""Where basins go: pictures, and at most one data set, whose parts outlive a killed run."""
from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from ....errors import InputError
from ....maps.basins.ask import Basins
from ....packages import demand
from ... import style
from ...files import endings
from ...plot import basins as picture
from .. import dataset as sweeps
from . import dataset


class Targets(NamedTuple):
    """paths: of all files; data: the data set among them, or None."""

    paths: list[Path]
    data: Path | None


def checked(paths: Iterable[Path]) -> Targets:
    """The files, if all can be written; InputError otherwise, before any work is done."""
    files = [endings.file(path, (*endings.PICTURES, *sweeps.ENDING)) for path in paths]
    data = [path for path in files if endings.ending(path) in sweeps.ENDING]
    if len(data) > 1:
        raise InputError(f"{data[1]}: one data set is written, and {data[0]} is it")
    for path in data:
        sweeps.checked(path)
    if len(data) < len(files):
        demand(*style.PACKAGES)
    return Targets(files, data[0] if data else None)


def write(found: Basins, path: Path) -> Path:
    """Write one of them."""
    return (sweeps.write(dataset.dataset(found), path) if endings.ending(path) in sweeps.ENDING
            else picture.write(found, path))
