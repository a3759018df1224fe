"""A sweep's file as a picture: curves along one axis, a map along two, small maps side by side along more."""
from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import InputError, printable
from ...maps.plan import Plan, from_json
from ...packages import demand
from .. import style
from ..files import endings
from .curves import curves
from .field import fields
from .labels import SAMPLE
from .spread import spread

if TYPE_CHECKING:
    import xarray

PANELS = 12  # small maps of a picture
NUMBERS = ("margin", "distance", "least", "greatest", "period", "when_low", "when_high", "equilibria", "stable", "unstable", "open")


def write(path: str | Path, out: str | Path, kind: str | None = None, size: tuple[float, float] | None = None, dpi: float | None = None) -> Path:
    """Draw a file of `stabilab sweep` and write the picture; returns its path. kind: the name of a column; None: the fate, with the margin, or the
    first number that there is. Raises InputError for a file that is none, and for a column that it has not."""
    demand("xarray", "scipy", *style.PACKAGES)
    target = endings.file(out, endings.PICTURES)
    data, plan = opened(Path(path))
    with style.drawing() as plt:
        figure = _drawn(data, plan, chosen(data, kind), size, plt)
        return style.save(figure, target, dpi)


def opened(path: Path) -> tuple[xarray.Dataset, Plan]:
    """The data set of a file and the sweep that it is of."""
    import xarray
    words = f"{path}: expected a file of stabilab sweep (NetCDF)"
    if not path.is_file():
        raise InputError(f"{path}: no such file; stabilab sweep --out {path} makes one")
    try:
        with xarray.open_dataset(path, engine="scipy") as found:
            data = found.load()
        return data, from_json(data.attrs["sweep"])
    except (TypeError, ValueError, KeyError, OSError, json.JSONDecodeError) as error:
        raise InputError(f"{words}: {printable(str(error)) or type(error).__name__}"[:300]) from None


def chosen(data: xarray.Dataset, kind: str | None) -> str:
    """The column that is drawn."""
    have = [name for name in ("fate", *NUMBERS, "level", "reason") if name in data]
    if kind is None:
        return have[0]
    if kind not in have:
        raise InputError(f"plot {printable(kind)[:40]}: this file has {', '.join(have)}")
    return kind


def dimensions_of(data: xarray.Dataset) -> list[str]:
    """The dimensions that vary, but for samples."""
    name = next(iter(data.data_vars))
    return [str(d) for d in data[name].dims if d not in (SAMPLE, "axis")]


def _drawn(data, plan, kind, size, plt) -> Any:
    moving = [name for name in dimensions_of(data) if data.sizes[name] > 1]
    data = data.isel({name: 0 for name in dimensions_of(data) if name not in moving})
    if SAMPLE in data.sizes:
        return spread(data, plan, kind, moving, size, plt)
    if len(moving) < 2:
        if not moving:
            raise InputError("a sweep of one point has no picture: stabilab plot draws its case")
        return curves(data, plan, moving[0], size, plt)
    panels = _panels(data, moving)
    return fields(data, plan, kind, moving, panels, size, plt)


def _panels(data, moving: list[str]) -> list[dict[str, int]]:
    """Places along the dimensions beyond the two that have most points, spread over each, as many as a picture takes."""
    rest = moving[2:]
    most = PANELS if len(rest) == 1 else 3
    choices = [np.unique(np.linspace(0, data.sizes[name] - 1, min(most, data.sizes[name])).round().astype(int)).tolist() for name in rest]
    if not rest:
        return [{}]
    return [dict(zip(rest, pick)) for pick in np.array(np.meshgrid(*choices, indexing="ij")).reshape(len(rest), -1).T.tolist()]
