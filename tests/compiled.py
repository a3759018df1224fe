"""python -m tests.compiled: what two workers of the default tests would each do at the same time is done
once, on two cores.

The loops that the tests run compiled come into numba's cache beside the sources, and the tests into Python's,
their asserts rewritten by pytest.
"""
from __future__ import annotations

import contextlib
import io
from concurrent.futures import ProcessPoolExecutor

import pytest

from stabilab.answers.motions.compiling import TASKS
from stabilab.numbers.numba_door import installed


def rewritten():
    """Every test is read; none is run."""
    with contextlib.redirect_stdout(io.StringIO()):
        pytest.main(["--collect-only", "-qq"])


if __name__ == "__main__":
    with ProcessPoolExecutor(2) as pool:
        for done in [pool.submit(task) for task in (*(TASKS if installed() else ()), rewritten)]:
            done.result()
