"""The kernels of spin-up, compiled by numba or as they are written."""
from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import Any

from ...numbers.numba_door import compiled


def functions(kernel: ModuleType, fast: bool) -> dict[str, Any]:
    """A kernel's functions by name: compiled, or as they are written."""
    return compiled_functions(kernel) if fast else vars(kernel)


@lru_cache(maxsize=4)
def compiled_functions(kernel: ModuleType) -> dict[str, Any]:
    """A kernel's functions by name, compiled; stored on disk where there is a place for it."""
    return compiled(kernel)


def loaded() -> bool:
    """Whether compiled functions are at hand, without loading them."""
    return bool(compiled_functions.cache_info().currsize)


def stored() -> bool:
    """Whether an earlier process left compiled steps beside the sources, where numba puts them unless told
    otherwise."""
    return any(Path(__file__).with_name("__pycache__").glob("steps.advance*.nbi"))
