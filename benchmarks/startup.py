"""Small commands from the shell, each in a fresh interpreter, against `python -c "import typer"`; with
equations to step, against the packages it takes."""
from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from functools import cache, partial
from pathlib import Path

from .rows import Row, against
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
BY_SYMBOLS = ("wanted: at most 1.3 times both imports. Equations of before are read from disk; `import "
              "heyoka` alone takes longer than both packages, which it loads as well; compiling the series "
              "and its events, reading case and program, and the equilibria of a top take the rest")
LIMIT = ("wanted: at most twice the import of typer, with which every command begins. Beyond it: reading the "
         "case and its classes (fractions, tomllib, some thirty records), exact equilibria, and for classify "
         "the distance from the separatrix, whose search takes a quarter of it")



@cache
def _byte_code():
    """A folder for the byte code of all rows, which goes when the process ends."""
    return tempfile.TemporaryDirectory()


def measurements(small=False):
    return ([partial(_started, name, arguments, 1 if small else 11, TYPER)
             for name, arguments in (COMMANDS[1:2] if small else COMMANDS)]
            + [partial(_started, name, arguments, 7, SYMBOLS) for name, arguments in STEPPED if not small])


def _started(name, arguments, rounds, imports) -> Row:
    """Time of `import typer` over ours: 0.5 is twice as long. Byte code is written before the clock starts,
    as an installation does; the contestants take turns."""
    environment = ({k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
                   | {"PYTHONPYCACHEPREFIX": _byte_code().name})

    def run(*command) -> str:
        return subprocess.run([sys.executable, *command], env=environment, cwd=ROOT, check=True,
                              capture_output=True, text=True).stdout

    def ours():
        return run("-m", "stabilab", *arguments)
    said = ours()
    assert said == ours() and said
    timed = side_by_side(ours, lambda: run("-c", imports), 1, 1, rounds)
    wanted, note = (0.5, LIMIT) if imports == TYPER else (1 / 1.3, BY_SYMBOLS)
    key = "start-" + ("help" if arguments == HELP[1] else name.replace(" of one state", "").replace(
        " one state", "").replace(" ", "-"))
    return against(key, f"start-up: stabilab {name}", timed, f'python -c "{imports}"',
                   "none: text" if arguments == HELP[1] else
                   "ours answers, to 12 digits; theirs does nothing",
                   wanted, note, "s")
