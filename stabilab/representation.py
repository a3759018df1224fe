"""How results are compared, printed and exported. What typesets them stands above all results: the package's
own table hands it down, and it is loaded when a reader asks."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas
    import xarray

    from .errors import Caveat

_view: list[Callable[[], ModuleType]] = []


def seen_through(view: Callable[[], ModuleType]) -> None:
    """Have results typeset by the module that `view` loads: short, html, dataset and frame of a result."""
    _view[:] = [view]


def same(x: Any, other: Any) -> bool:
    """Whether two values hold the same: arrays with the same bytes, not a number as one that is none either.
    """
    if type(x) is not type(other):
        return False
    if hasattr(x, "tobytes") and hasattr(x, "dtype"):
        if x.shape != other.shape or x.dtype != other.dtype:
            return False
        return (x.tobytes() == other.tobytes() if not x.dtype.hasobject
                else same(x.tolist(), other.tolist()))
    if isinstance(x, dict):
        return x.keys() == other.keys() and all(same(value, other[key]) for key, value in x.items())
    if isinstance(x, (list, tuple)):
        return len(x) == len(other) and all(map(same, x, other))
    return x is other or bool(x == other) or (isinstance(x, float) and x != x and other != other)


def values_of(item: Any, names: str) -> dict[str, Any]:
    """{name: value} of these attributes, whose names are parted by blanks."""
    return {name: getattr(item, name) for name in names.split()}


class Compared:
    """A data class that holds arrays: one is equal to another by what its fields hold, and has no hash, as
    arrays have none."""

    def __eq__(self, other: object) -> Any:
        if other.__class__ is not self.__class__:
            return NotImplemented
        names = [field.name for field in fields(self) if field.compare]  # type: ignore[arg-type]
        return all(same(getattr(self, name), getattr(other, name)) for name in names)

    __hash__ = None  # type: ignore[assignment]


class Shown:
    """What every result brings: a short line, a table for notebooks, and its numbers with their names as
    xarray and pandas hold them."""

    def __repr__(self) -> str:
        return _view[0]().short(self)

    def _repr_html_(self) -> str:
        return _view[0]().html(self)

    def to_xarray(self, frame: str = "file") -> xarray.Dataset:
        """All numbers with their dimensions, units and words. frame: of a body with a full tensor, whose
        vectors are in the frame of the file, with the principal axes among the attributes; "principal" has
        them along the principal axes. Needs xarray; InputError names it where it is not installed."""
        return _view[0]().dataset(self, frame)

    def to_pandas(self, frame: str = "file") -> pandas.DataFrame:
        """All numbers as a table: a row a time, a state, an equilibrium or a component; frame: as of
        `to_xarray`. Needs pandas, as `to_xarray` needs xarray."""
        return _view[0]().table(self, frame)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Answer(Shown):
    """What a question of a case answers. caveats: all that limits it (`answers.caveats`), which its line, its
    table and its attributes show."""

    caveats: tuple[Caveat, ...] = ()
