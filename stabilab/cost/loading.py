"""What a process pays before its first run with an integrator: the import of its package and the start of its
compiler, measured in a process of its own that has loaded what every method needs."""
from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from functools import lru_cache

from ..integrate.trajectory import SCIPY_METHODS

CODE = ("import time, numpy, sympy, stabilab.cost.methods\nfrom stabilab.cost.loading import {0}\n"
        "began = time.process_time()\n{0}()\nprint(time.process_time() - began)\n")


def taylor() -> None:
    """The first integrator of a process, of the smallest system, starts the compiler."""
    import heyoka
    x, v = heyoka.make_vars("x", "v")
    heyoka.taylor_adaptive([(x, v), (v, -x)], [0.0, 1.0], tol=1e-9)


def scipy() -> None:
    """SciPy's integrators."""
    import scipy.integrate  # noqa: F401  # the import is what is measured


# method -> what it needs besides; the others come with the program
STARTS = {"taylor": taylor, "taylor-batch": taylor, **dict.fromkeys(SCIPY_METHODS, scipy)}


def loading(method: str) -> float:
    """Processor time, s, that the first run with a method of `methods` pays in a new process; what it loads
    is loaded here, too, so that no later measurement has it in it."""
    return _started(STARTS[method]) if method in STARTS else 0.0


@lru_cache
def _started(start: Callable[[], None]) -> float:
    start()
    run = subprocess.run([sys.executable, "-c", CODE.format(start.__name__)], capture_output=True, text=True,
                         check=True)
    return float(run.stdout.split()[-1])
