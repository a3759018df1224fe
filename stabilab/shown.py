"""How results show themselves: the room that typesets them is asked by name, when a reader asks; no result knows it."""
from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas
    import xarray

ROOM = "stabilab.show.results"


class Shown:
    """What every result brings: a short line, a table for notebooks, and its numbers with their names as xarray and pandas hold them."""

    def __repr__(self) -> str:
        return _room("words").short(self)

    def _repr_html_(self) -> str:
        return _room("page").html(self)

    def to_xarray(self) -> xarray.Dataset:
        """All numbers with their dimensions, units and words. Needs xarray; InputError names it where it is not installed."""
        return _room("convert").dataset(self)

    def to_pandas(self) -> pandas.DataFrame:
        """All numbers as a table: a row a time, a state, an equilibrium or a component. Needs pandas, as `to_xarray` needs xarray."""
        return _room("convert").frame(self)


def _room(part: str) -> Any:
    return import_module(f"{ROOM}.{part}")
