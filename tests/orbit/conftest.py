"""What tests of orbits share: the fast way without a compiler."""
from functools import lru_cache

import numpy as np
import pytest

from stabilab.numbers import numba_door
from stabilab.orbit.extremes import parabola_kernel, parabola_numba
from stabilab.orbit.fine import rows_numba


@pytest.fixture(params=["plain", pytest.param("compiled", marks=pytest.mark.slow)])  # compiling takes half a minute where no cache is
def kernels(request, monkeypatch):
    """What `fast=True` runs: the kernels as plain Python, or compiled."""
    if request.param == "compiled":
        pytest.importorskip("numba")
        yield
        return
    monkeypatch.setattr(numba_door, "installed", lambda: True)
    monkeypatch.setattr(parabola_numba, "kernel", lru_cache(lambda: parabola_kernel.orbits))
    monkeypatch.setattr(rows_numba, "kernel", lru_cache(rows_numba.plain))
    with np.errstate(all="ignore"):  # inf - inf and the like, of which compiled code says nothing
        yield
