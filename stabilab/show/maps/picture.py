"""A sweep's file as a picture: curves along one axis, a map along two, small maps side by side along more."""
from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import InputError, printable
from ...maps.columns import columns_of
from ...maps.plan import Plan, from_json
from ...packages import demand
from .. import style
from ..files import endings
from ..plot import basins as basin_picture
from ..plot.to_file import check_size
from ..terminal.letters import written
from ..units import Units, units_of
from .basins import dataset as basin_data
from .curves import curves
from .field import fields, values_of
from .labels import SAMPLE, dimensions
from .spread import spread

if TYPE_CHECKING:
    import xarray

PANELS = 12  # small maps of a picture
NUMBERS = ("margin", "distance", "least", "greatest", "period", "when_low", "when_high", "equilibria", "stable", "unstable", "open", "megno", "lyapunov")


def write(path: str | Path, out: str | Path, kind: str | None = None, size: tuple[float, float] | None = None, dpi: float | None = None,
          units: str | None = None) -> Path:
    """Draw a file of `stabilab sweep` and write the picture; returns its path. kind: the name of a column; None: the fate, with the margin, or the
    first number that there is. units: of rates and times that were answered, "deg" or "si"; None for those of the case; an axis keeps the unit in which it was
    varied. Raises InputError for a file that is none, and for a column that it has not."""
    demand("xarray", "scipy", *style.PACKAGES)
    target = endings.file(out, endings.PICTURES)
    check_size(size, dpi)
    data = loaded(Path(path))
    if "basin" in data.attrs:
        return _basin(data, Path(path), target, kind, size, dpi)
    plan = _plan(data, Path(path))
    data = in_units(data, units_of(plan.case, units))
    with style.drawing() as plt:
        figure = drawn(data, plan, chosen(data, kind), size, plt)
        return style.save(figure, target, dpi)


def in_units(data: xarray.Dataset, units: Units) -> xarray.Dataset:
    """The same with the columns of rates and times in what people are told."""
    of = {name: str(data[name].attrs.get("units", "1")) for name in map(str, data.data_vars)}
    told = {name: units.of(unit) for name, unit in of.items()}
    for names in (("period",), ("when_low", "when_high")):
        known = [np.abs(values[np.isfinite(values)]).max(initial=0.0) for values in (np.asarray(data[name]) for name in names if name in of)]
        told |= {name: units.times(max(known)) for name in names if name in of}
    return data.assign({name: (data[name] * one).assign_attrs(data[name].attrs | {"units": written(unit)}) for name, (unit, one) in told.items()
                        if unit != of[name]})


def _basin(data, path, target, kind, size, dpi) -> Path:
    """The same of a file of `stabilab basin`."""
    if kind is not None:
        raise InputError(f"plot {printable(kind)[:40]}: a file of stabilab basin has one picture: leave --kind away")
    try:
        found = basin_data.opened(data)
    except Exception:  # of any kind: what stands there is not of this program, or of another version
        raise InputError(f"{printable(str(path))}: what it says of its basins cannot be read: was it changed, or made by another version?") from None
    return basin_picture.write(found, target, size, dpi)


def opened(path: Path) -> tuple[xarray.Dataset, Plan]:
    """The data set of a file and the sweep that it is of. Raises InputError for what is no such file, is cut off, or was changed since."""
    data = loaded(path)
    return data, _plan(data, path)


def loaded(path: Path) -> xarray.Dataset:
    """The data set of a file. Raises InputError for what is none."""
    words = _words(path)
    if path.is_dir():
        raise InputError(f"{words}, got a folder")
    if not path.is_file():
        raise InputError(f"{path}: no such file; stabilab sweep --out {path} makes one")
    return read(path, words)


def _words(path: Path) -> str:
    return f"{printable(str(path))}: expected a file of stabilab sweep (NetCDF)"


def _plan(data: xarray.Dataset, path: Path) -> Plan:
    """The sweep that a data set is of."""
    words = _words(path)
    if "sweep" not in data.attrs:
        raise InputError(f"{words}: this one is of another kind: it does not say of which sweep it is")
    try:
        plan = from_json(data.attrs["sweep"])
        off = differing(data, plan)
    except Exception:  # of any kind: what stands there is no plan, or of another version
        raise InputError(f"{words}: what it says of its sweep cannot be read: was it changed, or made by another version?") from None
    if off:
        raise InputError(f"{words}: its {off} is not that of the sweep that it says it is of: was it changed since?")
    return plan


def read(path: Path, words: str) -> xarray.Dataset:
    """The data set of a NetCDF file; words: what is expected, for the error where it is none."""
    import warnings

    import xarray
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of bytes that mean nothing a reader may say anything
            with xarray.open_dataset(path, engine="scipy") as found:
                return found.load()
    except OSError as error:
        if error.strerror:
            raise InputError(f"{printable(str(path))}: {error.strerror}") from None
    except Exception:  # and raise anything
        pass
    raise InputError(f"{words}: this one is of another format, or cut off")


def differing(data: xarray.Dataset, plan: Plan) -> str:
    """What of a data set is not as the sweep made it, "" where all is: a part of a sweep would have its boundary drawn elsewhere."""
    dims = dimensions(plan)
    for name, axis in zip(dims, plan.axes):
        same = name in data.coords and data[name].attrs.get("long_name") == axis.key.name and np.array_equal(data[name].values, np.array(axis.values))
        if not same:
            return f"axis {name}"
    for column in columns_of(plan.answers)[1:]:
        expected = (*dims, *(["axis"] if column.shape else []))
        if column.name not in data or data[column.name].dims != expected or data[column.name].shape != (*plan.shape, *column.shape):
            return f"column {column.name}"
    return ""


def chosen(data: xarray.Dataset, kind: str | None) -> str:
    """The column that is drawn. Raises InputError where the file lacks it, or no number of it could be drawn."""
    have = [name for name in ("fate", *NUMBERS, "chaos", "level", "reason") if name in data]
    if kind is not None and kind not in have:
        raise InputError(f"plot {printable(kind)[:40]}: this file has {', '.join(have)}")
    asked = have if kind is None else [kind]
    found = next((name for name in asked if np.isfinite(data[name]).any()), None)
    if found is None:
        raise InputError(f"plot: nothing to draw: no point has a finite value of {' or '.join(asked)}")
    return found


def dimensions_of(data: xarray.Dataset) -> list[str]:
    """The dimensions that vary, but for samples."""
    name = next(iter(data.data_vars))
    return [str(d) for d in data[name].dims if d not in (SAMPLE, "axis")]


def drawn(data: xarray.Dataset, plan: Plan, kind: str, size: tuple[float, float] | None, plt: Any) -> Any:
    """The figure of a column: curves, a map, small maps, or how samples spread."""
    moving = [name for name in dimensions_of(data) if data.sizes[name] > 1]
    data = data.isel({name: 0 for name in dimensions_of(data) if name not in moving})
    if SAMPLE in data.sizes:
        return spread(data, plan, kind, moving, size, plt)
    if len(moving) < 2:
        if not moving:
            raise InputError("a sweep of one point has no picture: stabilab plot draws its case")
        return curves(data, plan, kind, moving[0], size, plt)
    if not np.isfinite(values_of(data, kind)).any():  # of three axes one may be finite where the greatest is not
        raise InputError(f"plot: nothing to draw: no point has a finite value of {kind}")
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
