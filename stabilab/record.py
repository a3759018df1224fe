"""Frozen data classes that cost a program less to start.

`dataclass(frozen=True)` writes six methods of every class as text and compiles them, half a millisecond a
class; a small command reads thirty classes. Here only `__init__` is made so. The others go through the fields
and are written once for all.
"""
from __future__ import annotations

from dataclasses import FrozenInstanceError, dataclass, field, fields
from operator import attrgetter
from reprlib import recursive_repr
from typing import Any, TypeVar, cast, dataclass_transform

Class = TypeVar("Class", bound=type)


@dataclass_transform(frozen_default=True, field_specifiers=(field,))
def record(cls: Class) -> Class:
    """The class as `dataclass(frozen=True)` makes it: `fields`, `replace` and `asdict` know it; words,
    equality, hash and refusals are the same.

    A method that the class, or one above it that is no record, writes itself stays. A frozen data class may
    stand above it or below it.
    """
    above = any(vars(one)["__dataclass_params__"].frozen for one in cls.__mro__[1:]
                if "__dataclass_params__" in vars(one))
    made: Any = dataclass(repr=False, eq=False, frozen=above)(cls)
    # what `dataclass` asks the classes above: a frozen one takes only its like
    made.__dataclass_params__.frozen = True
    for name, method in SHARED.items():
        if getattr(cls, name) is getattr(object, name):
            setattr(made, name, method)
    return cast(Class, made)


@recursive_repr()
def _repr(self: Any) -> str:
    return (
        f"{type(self).__qualname__}({', '.join(f'{f.name}={getattr(self, f.name)!r}' for f in fields(self) if f.repr)})")


def _eq(self: Any, other: object) -> Any:
    if other.__class__ is not self.__class__:
        return NotImplemented
    values = _reader(self.__class__)
    return values(self) == values(other)


def _hash(self: Any) -> int:
    kept: dict[str, Any] = self.__dict__
    # fractions, of which scenes are made, take long to hash, and every table of what is known of a scene asks
    if KEPT not in kept:
        kept[KEPT] = hash(_reader(self.__class__)(self))
    return kept[KEPT]  # type: ignore[no-any-return]


def _getstate(self: Any) -> dict[str, Any]:
    """What is copied or sent: all but the hash, which holds in this process alone."""
    return {name: value for name, value in self.__dict__.items() if name != KEPT}


def _setattr(self: Any, name: str, value: object) -> None:
    """Each field once, as `__init__` does."""
    if name in self.__dict__ or name not in self.__dataclass_fields__:
        raise FrozenInstanceError(f"cannot assign to field {name!r}")
    object.__setattr__(self, name, value)


def _delattr(self: Any, name: str) -> None:
    raise FrozenInstanceError(f"cannot delete field {name!r}")


def _reader(cls: type) -> Any:
    """The function that reads what objects of a class are compared by, made at its first use and kept with
    the class."""
    if "compared_by" not in cls.__dict__:
        names = tuple(f.name for f in fields(cls) if f.compare)  # type: ignore[arg-type]
        made = (attrgetter(*names) if len(names) > 1
                else lambda one: tuple(getattr(one, name) for name in names))
        cls.compared_by = staticmethod(made)  # type: ignore[attr-defined]
    return cls.compared_by  # type: ignore[attr-defined]


KEPT = "hash of the fields"  # no name that a class could give a field
SHARED = {"__repr__": _repr, "__eq__": _eq, "__hash__": _hash, "__getstate__": _getstate,
          "__setattr__": _setattr, "__delattr__": _delattr}
