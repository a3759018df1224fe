"""The compiled kernel of validated steps: the door of numba."""
from __future__ import annotations

from functools import lru_cache

from ...numbers.numba_door import compiled, installed
from . import kernel

INLINED = {"exact_sum", "high_part", "exact_product"}


@lru_cache(maxsize=1)
def functions() -> dict:
    """The kernel's functions by name, compiled where numba is installed, else as they are."""
    return compiled(kernel, INLINED) if installed() else vars(kernel)


def available() -> bool:
    """Whether there is a compiler for the kernel; it is not loaded."""
    return installed()


def loaded() -> bool:
    """Whether the kernel is at hand, without loading it."""
    return bool(functions.cache_info().currsize)


def advance():
    """`kernel.advance`, compiled; None without numba."""
    return functions()["advance"] if installed() else None


def helpers():
    """What the steps in many digits take from the kernel."""
    table = functions()
    return tuple(table[name] for name in ("judged", "taken_along", "turned", "end_of_variations", "longest"))
