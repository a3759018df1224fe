"""How many threads the libraries below this program may have: one in each process.

NumPy's linear algebra starts a thread a core, which wait for work without sleeping. The matrices here are
small, so that nothing is won by them, and with a process a core they take the time of the other processes.
The libraries read their environment when they are loaded: no other package is needed to say so, but it has to
be said before. Sums in one thread have one order, so that no byte depends on the number of cores.
"""
from __future__ import annotations

import os

# of OpenBLAS, OpenMP, MKL, BLIS and Apple's Accelerate
VARIABLES = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "BLIS_NUM_THREADS",
             "VECLIB_MAXIMUM_THREADS")


def limit() -> None:
    """One thread in this process, and in those that it starts, unless the user has said otherwise."""
    for name in VARIABLES:
        os.environ.setdefault(name, "1")


def of_worker() -> dict[str, str]:
    """The environment of a process that works for this one, on a core of its own."""
    return {**os.environ, **dict.fromkeys(VARIABLES, "1")}


def limit_worker() -> None:
    """One thread in a worker, called in it before it loads anything."""
    os.environ.update(dict.fromkeys(VARIABLES, "1"))
