"""Four walks through the package, traced: how many files and functions answer a question, and how often a
call crosses from file to file.

`python -m tests.house.walks` walks through this checkout, `python -m tests.house.walks FOLDER` through
another one. What numba compiles is not seen, and what a first question leaves behind (compiled code, measured
fronts) is made before the walk by another scene of its kind.
"""
from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
WALKS = {
    "classify of one state": (None, "classify('minor-axis-100')"),
    "fate of a million states": ("million('1/3')", "million('1/5')"),
    "classify of a top in a field": (None, "classify('top-fast')"),
    "simulate --digits 9": ("simulate('minor-axis-300')", "simulate('minor-axis-100')"),
}
PROGRAM = """
import contextlib, io, json, sys, threading
cases, before, walk = sys.argv[1:4]

def command(*words):
    from stabilab.__main__ import main
    sys.argv = ["stabilab", *words]
    with contextlib.redirect_stdout(io.StringIO()), contextlib.suppress(SystemExit):
        main()

def classify(case):
    command("classify", f"{cases}/{case}.toml", "--json")

def simulate(case):
    command("simulate", f"{cases}/{case}.toml", "--at", "0,1,2", "--digits", "9")

def million(a):
    import numpy as np
    import stabilab
    stabilab.fate(stabilab.ScaledGyrostat(a, "0.4", (0, 0, 1)), np.random.default_rng(1).normal(size=(10**6, 3)))

if before:
    eval(before)
import stabilab
home, seen, files, functions, crossing, orbits = stabilab.__path__[0], {}, set(), set(), 0, 0

def inside(code):
    if code not in seen:
        seen[code] = code.co_filename.startswith(home)
    return seen[code]

def trace(frame, event, argument):
    global crossing, orbits
    code = frame.f_code
    if event != "call" or not inside(code) or code.co_name == "<module>":
        return
    files.add(code.co_filename)
    functions.add(code)
    orbits += code.co_qualname in ("BallOrbit.__init__", "PreciseOrbit.__init__")
    caller = frame.f_back
    while caller is not None and not inside(caller.f_code):
        caller = caller.f_back
    crossing += caller is not None and caller.f_code.co_filename != code.co_filename

threading.setprofile(trace)
sys.setprofile(trace)
eval(walk)
sys.setprofile(None)
loaded = sum(name.split(".")[0] == "stabilab" for name in sys.modules)
print(json.dumps([loaded, len(files), len(functions), crossing, orbits]))
"""
HEAD = ("walk", "modules loaded", "files", "functions", "calls across files", "orbits in balls")


def walked(name: str, root: Path = ROOT) -> list[int]:
    """Modules loaded, files and functions that ran, calls from one file into another, and orbits built, of
    one walk through a checkout."""
    before, walk = WALKS[name]
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", PROGRAM, str(root / "cases"), before or "",
                           walk], cwd=root, text=True,
                          capture_output=True, env={**os.environ, "PYTHONPATH": str(root)})
    if done.returncode:
        raise RuntimeError(done.stderr)
    return json.loads(done.stdout)


def table(root: Path) -> str:
    """The walks as rows of a table in Markdown."""
    rows = [HEAD, ["---"] * len(HEAD), *([name, *map(str, walked(name, root))] for name in WALKS)]
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


if __name__ == "__main__":
    print(table(Path(sys.argv[1]).resolve() if sys.argv[1:] else ROOT))
