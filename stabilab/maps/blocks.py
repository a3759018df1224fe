"""Arrays that lie in a file, and what is counted of them block by block: memory for one block, however many
points there are.

The file is mapped, so that whoever takes an array takes it as any other. Pages that were looked at count as
memory of the process until they are given back, which `given_back` does; what they hold stays in the file.
"""
from __future__ import annotations

import mmap
import os
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

BLOCK = 1 << 18  # points looked at together
LARGE = 2_000_000  # points from which on records lie in a file: below that they take some 30 MB


def mapped(path: Path, count: int, dtype: np.dtype[Any]) -> np.ndarray:
    """(count,) of a new file, zeros at first. The array outlives the name of the file."""
    return np.memmap(path, dtype, "w+", shape=(count,))


def can_map() -> bool:
    """Whether this system removes the name of a file that is mapped, and takes pages back."""
    return os.name == "posix" and hasattr(mmap, "MADV_DONTNEED")


def given_back(array: Any) -> None:
    """Give the pages of an array that lies in a file back; nothing of any other array."""
    while array is not None and not isinstance(array, mmap.mmap):
        array = getattr(array, "base", None)
    if array is not None:
        array.madvise(mmap.MADV_DONTNEED)


def blocks(array: np.ndarray) -> Iterator[np.ndarray]:
    """An array in pieces of at most `BLOCK` elements, in one row, as they lie in memory."""
    order = np.argsort([-stride for stride in array.strides], kind="stable")
    row = array.transpose(order).reshape(-1)  # no copy of what lies in a row
    for low in range(0, len(row), BLOCK):
        yield row[low:low + BLOCK]
        given_back(array)


def counted(pieces: Iterable[np.ndarray]) -> Mapping[int, int]:
    """How often each whole number occurs, the smallest first."""
    total: Counter[int] = Counter()
    for piece in pieces:
        kinds, counts = np.unique(piece, return_counts=True)
        total.update(dict(zip(map(int, kinds), map(int, counts))))
    return dict(sorted(total.items()))
