"""Small commands from the shell, each in a fresh interpreter, against `python -c "import typer"`; with
equations to step, against the packages it takes."""
from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from .rows import Row
from .timing import side_by_side

ROOT = Path(__file__).parent.parent
CASE = "cases/minor-axis-100.toml"
HELP = ("help of all commands, from typer alone", ("--help",))
COMMANDS = (HELP, ("classify one state", ("classify", CASE)), ("extremes of one state", ("extremes", CASE)),
            ("classify charged-body", ("classify", "cases/charged-body.toml")))
TYPER, SYMBOLS = "import typer", "import numpy, sympy"
STEPPED = tuple((f"{question} {name}", (question, f"cases/{name}.toml"))
                for question in ("classify", "simulate")
                for name in ("liquid-base", "top-fast", "charged-body")
                if (question, name) != ("classify", "charged-body"))
BY_SYMBOLS = ("equations of before are read from disk; `import heyoka` alone, which loads both packages too, "
              "takes 1.15 to 1.3 times as long, compiling the "
              "series and its events some 0.1 s, reading case and program 0.1 s, and classify of a top 0.3 s "
              "for its equilibria")
LIMIT = ("a command cannot be faster than the import of typer that it begins with. Beyond it: reading the "
         "case and its classes "
         "(fractions, tomllib, some thirty records at a sixth of a millisecond each), exact equilibria, and "
         "for classify the "
         "distance from the separatrix, whose search takes a quarter of it. Tried and left: NumPy (75 ms) "
         "and python-flint (40 ms) for one state; now balls of "
         "doubles answer it, and python-flint is loaded only where they are unclear")


def rows(small=False) -> list[Row]:
    """Time of `import typer` over ours: 0.5 is twice as long. Byte code is written before the clock starts,
    as an installation does; the contestants take turns."""
    with tempfile.TemporaryDirectory() as cache:
        environment = ({k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
                       | {"PYTHONPYCACHEPREFIX": cache})
        return [*(_row(name, arguments, environment, 1 if small else 11, TYPER) for name,
                  arguments in (COMMANDS[1:2] if small else COMMANDS)),
                *(_row(name, arguments, environment, 7, SYMBOLS) for name,
                  arguments in (() if small else STEPPED))]


def _row(name, arguments, environment, rounds, imports) -> Row:
    def run(*command) -> str:
        return subprocess.run([sys.executable, *command], env=environment, cwd=ROOT, check=True,
                              capture_output=True, text=True).stdout

    def ours():
        return run("-m", "stabilab", *arguments)
    said = ours()
    assert said == ours() and said
    timed = side_by_side(ours, lambda: run("-c", imports), 1, 1, rounds)
    wanted, limit, goal = (0.5, LIMIT,
                           "at most twice the import of typer") if imports == TYPER else (
                               1 / 1.3, BY_SYMBOLS, "at most 1.3 times both imports")
    return Row(f"start-up: stabilab {name}", f"{timed.ours * 1e3:.0f} ms",
               f"{timed.theirs * 1e3:.0f} ms python -c \"{imports}\"",
               timed.ratio, (timed.low, timed.high),
               "ours answers, to 12 digits; theirs does nothing" if arguments != HELP[1]
               else "none: text", wanted, limit if timed.ratio < wanted else goal)
