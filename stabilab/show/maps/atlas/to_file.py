"""The files that an atlas is written to, by their endings, and drawn anew from one of them."""
from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ....errors import InputError, printable
from ....maps.atlas.run import Atlas
from ....packages import demand
from ... import style
from ...files import endings
from ...units import Units, units_of
from .. import dataset as sweeps
from ..picture import read
from . import dataset, picture
from . import picture as page

PAGES = (".html",)


def checked(out: Sequence[Path]) -> list[Path]:
    """The paths, each with an ending that an atlas can be written to. Raises InputError for others, and for
    one that is named twice."""
    targets = [endings.file(path, (*sweeps.ENDING, *endings.PICTURES, *PAGES)) for path in out]
    if len(set(targets)) < len(targets):
        raise InputError("out: the same file twice: give each once")
    for path in targets:
        if endings.ending(path) in sweeps.ENDING:
            sweeps.checked(path)
        elif endings.ending(path) in endings.PICTURES:
            demand(*style.PACKAGES)
        else:
            demand("jinja2")
    return targets


def write(found: Atlas, path: Path, units: Units, kind: str | None = None,
          size: tuple[float, float] | None = None, dpi: float | None = None) -> Path:
    """Write the atlas in the format of the ending."""
    if endings.ending(path) in sweeps.ENDING:
        return sweeps.write(dataset.dataset(found), path)
    if endings.ending(path) in endings.PICTURES:
        return picture.write_picture(found, path, units, kind, size, dpi)
    return page.write_page(found, path, units)


def is_atlas(path: Path) -> bool:
    """Whether a NetCDF file is one of an atlas; a file that cannot be read is none."""
    if not path.is_file():
        return False
    demand("xarray", "scipy")
    try:
        return "atlas" in read(path, "").attrs
    except InputError:
        return False


def redrawn(path: Path, out: Path, kind: str | None, size: tuple[float, float] | None, dpi: float | None,
            units: str | None) -> Path:
    """Draw the atlas of a NetCDF file."""
    found = dataset.atlas_of(read(path, f"{printable(str(path))}: expected a file of stabilab atlas"), path)
    return write(found, endings.file(out, (*endings.PICTURES, *PAGES)), units_of(found.asked.case, units),
                 kind, size, dpi)
