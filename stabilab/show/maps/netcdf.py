"""A data set as NetCDF 3, its columns written in blocks: xarray and SciPy would hold each column once more,
and what they write of it again.

The format, with offsets of 64 bits ("CDF\\x02", the NetCDF classic format specification): a header with the
dimensions, the attributes of the file, and of each variable its dimensions, attributes, type, size and
place; then the values of the variables in the order of the header, in big-endian numbers, each filled up to
four bytes. Variables stand by their shapes, the largest first, as SciPy writes them.
"""
from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from struct import pack
from typing import TYPE_CHECKING, Any

import numpy as np

from ...maps.blocks import blocks, given_back

if TYPE_CHECKING:
    import xarray

DIMENSION, VARIABLE, ATTRIBUTE, ABSENT = b"\0\0\0\x0a", b"\0\0\0\x0b", b"\0\0\0\x0c", b"\0" * 8
CHARACTERS = 2
TYPES = {"i1": 1, "i2": 3, "i4": 4, "f4": 5, "f8": 6}  # of NumPy -> of the format
FILLS = {"i1": b"\x81", "i2": b"\x80\x01"}  # what SciPy fills up with; the others need none
BLOCK = 1 << 17  # numbers converted at a time


def fits(built: xarray.Dataset) -> bool:
    """Whether all of a data set is of the kinds that `write` writes: numbers, up to 2 GB of each, and
    coordinates along their own dimension."""
    return all(_kind(variable.dtype) in TYPES and (name not in built.coords or variable.dims == (name,))
               and variable.nbytes < 2**31 - 4
               and not (variable.dtype == np.int64
                        and any(np.any(np.abs(block) >= 2**31) for block in blocks(variable.values)))
               for name, variable in built.variables.items())


def write(built: xarray.Dataset, path: Path) -> None:
    """Write a data set that `fits`, with the bytes that xarray and SciPy would write."""
    sizes = {name: size for variable in built.variables.values() for name, size in variable.sizes.items()}
    variables = dict(sorted(built.variables.items(), key=lambda item: item[1].shape, reverse=True))
    with path.open("wb") as file:
        file.write(_header(built.attrs, sizes, variables))
        for variable in variables.values():
            count = 0
            for block in _blocks(variable.values):
                file.write(block)
                given_back(variable.values)
                count += len(block)
            fill = FILLS.get(_kind(variable.dtype), b"\0")
            file.write(fill * (-count % 4 // len(fill)))


def _header(attributes: Mapping[Any, Any], sizes: Mapping[Any, int], variables: Mapping[Any, Any]) -> bytes:
    numbers = {name: number for number, name in enumerate(sizes)}
    start = b"CDF\x02" + pack(">i", 0)  # no records
    start += DIMENSION + pack(">i", len(sizes)) if sizes else ABSENT
    start += b"".join(_name(name) + pack(">i", size) for name, size in sizes.items())
    start += _attributes(attributes)
    start += VARIABLE + pack(">i", len(variables)) if variables else ABSENT
    entries = []
    for name, variable in variables.items():
        kind = _kind(variable.dtype)
        size = int(np.prod(variable.shape)) * int(kind[1])
        entries.append((_name(name) + pack(f">i{variable.ndim}i", variable.ndim,
                                           *(numbers[dimension] for dimension in variable.dims))
                        + _attributes(variable.attrs) + pack(">ii", TYPES[kind], size + -size % 4),
                        size + -size % 4))
    place = len(start) + sum(len(entry) + 8 for entry, _ in entries)
    for entry, size in entries:
        start += entry + pack(">q", place)
        place += size
    return start


def _name(name: Any) -> bytes:
    raw = str(name).encode()
    return pack(">i", len(raw)) + raw + b"\0" * (-len(raw) % 4)


def _attributes(attributes: Mapping[Any, Any]) -> bytes:
    if not attributes:
        return ABSENT
    out = ATTRIBUTE + pack(">i", len(attributes))
    for name, value in attributes.items():
        if isinstance(value, str):
            raw = value.encode() or b"\0"
            kind, count = CHARACTERS, len(raw)
        else:
            array = np.atleast_1d(value)
            kind, count = TYPES[_kind(array.dtype)], array.size
            raw = b"".join(_blocks(array))
        out += _name(name) + pack(">ii", kind, count) + raw + b"\0" * (-len(raw) % 4)
    return out


def _kind(dtype: np.dtype[Any]) -> str:
    """Of the numbers in the file: there are none of 64 bits but doubles."""
    return "i4" if dtype.kind == "i" and dtype.itemsize == 8 else f"{dtype.kind}{dtype.itemsize}"


def _blocks(values: np.ndarray) -> Iterator[bytes]:
    """The numbers in a row, the last dimension fastest."""
    kind = f">{_kind(values.dtype)}"
    if values.ndim == 0 or values.size <= BLOCK:
        yield values.astype(kind).tobytes()
        return
    rows = max(1, BLOCK * len(values) // values.size)
    for first in range(0, len(values), rows):
        part = values[first:first + rows]
        if part.size <= 2 * BLOCK or part.ndim == 1:
            yield part.astype(kind).tobytes()
        else:
            for row in part:
                yield from _blocks(row)
