"""An answer as bytes for a page: a header in JSON, and behind it the numbers of all curves and surfaces.

    4 bytes: length of the header, little-endian | header | zeros up to a multiple of 4 | numbers

In the header a row of numbers is {"type": "int16" or "float32", "from": byte in the numbers, "count": how many}.
"""
from __future__ import annotations

import json
import math
import struct
import sys
from array import array
from collections.abc import Iterable
from typing import Any

TYPES = {"int16": "h", "float32": "f"}


class Bag:
    """Rows of numbers, one behind the other."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []
        self._length = 0

    def add(self, kind: str, values: Iterable[float] | bytes) -> dict[str, Any]:
        """Keep a row; what the header says of it. values: numbers, or bytes that are numbers of this kind, little-endian."""
        raw = values if isinstance(values, bytes) else _packed(kind, values)
        row = {"type": kind, "from": self._length, "count": len(raw) // array(TYPES[kind]).itemsize}
        padded = raw + b"\0" * (-len(raw) % 4)
        self._parts.append(padded)
        self._length += len(padded)
        return row

    def framed(self, header: dict[str, Any]) -> bytes:
        """Header and numbers as the page reads them. Numbers that are not finite become null."""
        text = json.dumps(finite(header), ensure_ascii=False, separators=(",", ":"), allow_nan=False).encode()
        return b"".join([struct.pack("<I", len(text)), text, b"\0" * (-(4 + len(text)) % 4), *self._parts])


def unframed(message: bytes) -> tuple[dict[str, Any], bytes]:
    """(header, numbers) of `Bag.framed`."""
    (length,) = struct.unpack_from("<I", message)
    return json.loads(message[4:4 + length]), message[4 + length + (-(4 + length) % 4):]


def _packed(kind: str, values: Iterable[float]) -> bytes:
    made = array(TYPES[kind], values)
    if sys.byteorder == "big":
        made.byteswap()
    return made.tobytes()


def finite(value: Any) -> Any:
    """The same with null for what JSON has no number for."""
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: finite(one) for key, one in value.items()}
    return [finite(one) for one in value] if isinstance(value, (list, tuple)) else value
