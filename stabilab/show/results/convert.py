"""Results as data sets of xarray and tables of pandas."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...packages import demand
from ...physics.blocks import PARTS
from .variables import Variables, variables

if TYPE_CHECKING:
    import pandas
    import xarray


def dataset(result: Any) -> xarray.Dataset:
    """The numbers of a result with their dimensions, units and words."""
    demand("xarray")
    import xarray
    found = variables(result)
    return xarray.Dataset(dict(found.values), {name: ((name,), *one) for name, one in found.coordinates.items()}, dict(found.attributes))


def frame(result: Any) -> pandas.DataFrame:
    """The numbers of a result as a table; a column for every component, what belongs to the whole in `attrs`."""
    demand("pandas")
    import pandas
    found = variables(result)
    made = pandas.DataFrame({name: values for name, values in columns(found)}, index=_index(found))
    made.attrs = dict(found.attributes)
    return made


def columns(found: Variables) -> list[tuple[str, np.ndarray]]:
    """(name, values in one row of cells) of every component: "omega1", "omega2", ..."""
    rows = []
    for name, (dims, values, _) in found.values.items():
        array, own = np.asarray(values), dims[len(found.index):]
        if not own:
            rows.append((name, array.reshape(-1)))
            continue
        flat = array.reshape(-1, array.shape[-1])
        known = PARTS[name].components if name in PARTS else ()
        names = known if len(known) == flat.shape[1] else [f"{name}{n + 1}" for n in range(flat.shape[1])]
        rows += [(one, flat[:, n]) for n, one in enumerate(names)]
    return rows


def _index(found: Variables) -> Any:
    """Times or axes where they are known, else numbers; several dimensions of states as pandas counts them."""
    import pandas
    shape = next(iter(found.values.values()))[1].shape[:len(found.index)]
    if not found.index:
        return pandas.RangeIndex(1)
    if len(found.index) > 1:
        return pandas.MultiIndex.from_product([range(size) for size in shape], names=list(found.index))
    name, = found.index
    return pandas.Index(found.coordinates[name][0] if name in found.coordinates else range(shape[0]), name=name)
