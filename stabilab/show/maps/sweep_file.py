"""A sweep's file read again: its data set, in what units, and the sweep that it is of."""
from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...errors import InputError, printable
from ...maps.columns import columns_of
from ...maps.plan import Plan, from_json
from ..terminal import written
from ..units import Units
from . import shades

if TYPE_CHECKING:
    import xarray


def opened(path: Path) -> tuple[xarray.Dataset, Plan]:
    """The data set of a file and the sweep that it is of. Raises InputError for what is no such file, is cut
    off, or was changed since."""
    data = loaded(path)
    return data, plan_of(data, path)


def loaded(path: Path) -> xarray.Dataset:
    """The data set of a file. Raises InputError for what is none."""
    text = _words(path)
    if path.is_dir():
        raise InputError(f"{text}, got a folder")
    if not path.is_file():
        raise InputError(f"{path}: no such file; stabilab sweep --out {path} makes one")
    return read(path, text)


def _words(path: Path) -> str:
    return f"{printable(str(path))}: expected a file of stabilab sweep (NetCDF)"


def plan_of(data: xarray.Dataset, path: Path) -> Plan:
    """The sweep that a data set is of."""
    text = _words(path)
    if "sweep" not in data.attrs:
        raise InputError(f"{text}: this one is of another kind: it does not say of which sweep it is")
    try:
        plan = from_json(data.attrs["sweep"])
        off = differing(data, plan)
    except Exception:  # of any kind: what stands there is no plan, or of another version
        raise InputError(
            f"{text}: what it says of its sweep cannot be read: was it changed, or made by another "
            f"version?") from None
    if off:
        raise InputError(
            f"{text}: its {off} is not that of the sweep that it says it is of: was it changed since?")
    return plan


def read(path: Path, text: str) -> xarray.Dataset:
    """The data set of a NetCDF file; text: what is expected, for the error where it is none."""
    import warnings

    import xarray
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of bytes that mean nothing a reader may say anything
            with xarray.open_dataset(path, engine="scipy") as result:
                return result.load()
    except OSError as error:
        if error.strerror:
            raise InputError(f"{printable(str(path))}: {error.strerror}") from None
    except Exception:  # and raise anything
        pass
    raise InputError(f"{text}: this one is of another format, or cut off")


def differing(data: xarray.Dataset, plan: Plan) -> str:
    """What of a data set is not as the sweep made it, "" where all is: a part of a sweep would have its
    boundary drawn elsewhere."""
    dims = shades.dimensions(plan)
    for name, axis in zip(dims, plan.axes):
        same = (name in data.coords and data[name].attrs.get("long_name") == axis.key.name
                and np.array_equal(data[name].values, np.array(axis.values)))
        if not same:
            return f"axis {name}"
    for column in columns_of(plan.answers)[1:]:
        expected = (*dims, *(["axis"] if column.shape else []))
        if column.name not in data or data[column.name].dims != expected or data[column.name].shape != (
            *plan.shape, *column.shape):
            return f"column {column.name}"
    return ""


def in_units(data: xarray.Dataset, units: Units) -> xarray.Dataset:
    """The same with the columns of rates and times in the units that people read."""
    of = {name: str(data[name].attrs.get("units", "1")) for name in map(str, data.data_vars)}
    printed = {name: units.of(unit) for name, unit in of.items()}
    for names in (("period",), ("when_low", "when_high")):
        resolved = [np.abs(values[np.isfinite(values)]).max(initial=0.0)
                 for values in (np.asarray(data[name]) for name in names if name in of)]
        printed |= {name: units.times(max(resolved)) for name in names if name in of}
    return data.assign({name: (data[name] * item).assign_attrs(data[name].attrs | {"units": written(unit)})
                        for name, (unit, item) in printed.items()
                        if unit != of[name]})


def dimensions_of(data: xarray.Dataset) -> list[str]:
    """The dimensions that vary, but for samples."""
    name = next(iter(data.data_vars))
    return [str(d) for d in data[name].dims if d not in (shades.SAMPLE, "axis")]
