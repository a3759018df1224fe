"""The files that an atlas and basins are written to, by their endings, and an atlas drawn anew from one."""
from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ...errors import InputError, printable
from ...maps.atlas import Atlas
from ...maps.basins import Basins
from ...packages import demand
from .. import endings, style
from ..plot import basins as basin_picture
from ..units import Units, units_of
from . import atlas, atlas_picture, basins, sweep
from .sweep_file import read

PAGES = (".html",)


def checked(out: Iterable[Path], pages: tuple[str, ...] = ()) -> list[Path]:
    """The paths, each with the ending of a data set, a picture or one of `pages`. Raises InputError for
    others, and for one that is named twice, before any work is done."""
    targets = [endings.file(path, (*sweep.ENDING, *endings.PICTURES, *pages)) for path in out]
    if len(set(targets)) < len(targets):
        raise InputError("out: the same file twice: give each once")
    for path in targets:
        if endings.ending(path) in sweep.ENDING:
            sweep.checked(path)
        elif endings.ending(path) in endings.PICTURES:
            demand(*style.PACKAGES)
        else:
            demand("jinja2")
    return targets


def data_of(targets: Iterable[Path]) -> Path | None:
    """The data set among them, whose parts outlive a killed run; InputError where there are several."""
    data = [path for path in targets if endings.ending(path) in sweep.ENDING]
    if len(data) > 1:
        raise InputError(f"{data[1]}: one data set is written, and {data[0]} is it")
    return data[0] if data else None


def write_basins(result: Basins, path: Path) -> Path:
    """Write basins in the format of the ending."""
    return (sweep.write(basins.dataset(result), path) if endings.ending(path) in sweep.ENDING
            else basin_picture.write(result, path))


def write_atlas(result: Atlas, path: Path, units: Units, kind: str | None = None,
                size: tuple[float, float] | None = None, dpi: float | None = None) -> Path:
    """Write the atlas in the format of the ending."""
    if endings.ending(path) in sweep.ENDING:
        return sweep.write(atlas.dataset(result), path)
    if endings.ending(path) in endings.PICTURES:
        return atlas_picture.write_picture(result, path, units, kind, size, dpi)
    return atlas_picture.write_page(result, path, units)


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
    result = atlas.atlas_of(read(path, f"{printable(str(path))}: expected a file of stabilab atlas"), path)
    return write_atlas(result, endings.file(out, (*endings.PICTURES, *PAGES)),
                       units_of(result.asked.case, units), kind, size, dpi)
