"""What a process pays before its first run with an integrator: the import of its package and the start of its
compiler, measured in a process of its own that has loaded what every method needs."""
from __future__ import annotations

import subprocess
import sys
from functools import lru_cache

from ..integrate.trajectory import SCIPY_METHODS

# the first integrator of a process, of the smallest system, starts the compiler
TAYLOR = ("import heyoka\nx, v = heyoka.make_vars('x', 'v')\n"
          "heyoka.taylor_adaptive([(x, v), (v, -x)], [0.0, 1.0], tol=1e-9)")
# method -> what it needs besides; the others come with the program
STARTS = {"taylor": TAYLOR, "taylor-batch": TAYLOR, **dict.fromkeys(SCIPY_METHODS, "import scipy.integrate")}
CODE = ("import time, numpy, sympy, stabilab.cost.methods\nbegan = time.process_time()\n{}\n"
        "print(time.process_time() - began)\n")


def loading(method: str) -> float:
    """Processor time, s, that the first run with a method of `methods` pays in a new process; what it loads
    is loaded here, too, so that no later measurement has it in it."""
    return _started(STARTS[method]) if method in STARTS else 0.0


@lru_cache
def _started(code: str) -> float:
    exec(code, {})
    run = subprocess.run([sys.executable, "-c", CODE.format(code)], capture_output=True, text=True,
                         check=True)
    return float(run.stdout.split()[-1])
