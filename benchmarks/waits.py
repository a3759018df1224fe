"""What a person waits for: the first answer, the report of one's own case, the report of everything. CPU
time, against what is allowed."""
from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path

from .rows import Row, allowed

ROOT = Path(__file__).parents[1]
CASES = sorted(map(str, (ROOT / "cases").glob("*.toml")))
CORES = 2  # of the machine that the limits are for; what runs in one process alone counts whole


def measurements(small=False):
    """The case of the README, in a fresh interpreter each time. Small: the first answer alone."""
    first = partial(_waited, "wait-fate", "first answer of a newcomer, stabilab fate my.toml",
                    ("fate", "my.toml"), 1, 1.0, 1 if small else 9,
                    "most of it imports: typer, and the program's own modules")
    if small:
        return [first]
    return [first,
            partial(_waited, "wait-report", "stabilab report my.toml",
                    ("report", "my.toml", "--out", "one"), 1, 20.0, 3,
                    "the search for the worst tilt, and four pictures with Matplotlib: a third each"),
            partial(_waited, "wait-make-report", "make report, a core's share of two",
                    ("report", *CASES, "--papers", "--precision", "--out", "all"), CORES, 150.0, 1,
                    "a page with pictures for each case, what answers cost, chapters and audit of the "
                    "papers"),
            compiling]


def compiling() -> Row:
    """All loops compiled into an empty cache."""
    with tempfile.TemporaryDirectory() as folder:
        before = _spent()
        subprocess.run([sys.executable, "-m", "stabilab", "doctor", "--compile"], cwd=folder, check=False,
                       capture_output=True,
                       env=os.environ | {"PYTHONPATH": str(ROOT), "NUMBA_CACHE_DIR": f"{folder}/cache"})
        assert any(Path(folder, "cache").rglob("*.nbi"))
        return Row("wait-compile", "stabilab doctor --compile, once per computer", _spent() - before, "s")


def _of_the_readme() -> str:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    return text.split("```toml\n", 1)[1].split("```", 1)[0]


def _waited(key, what, words, cores, limit, rounds, note) -> Row:
    times = []
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "my.toml").write_text(_of_the_readme(), encoding="utf-8")
        for _ in range(rounds):
            before = _spent()
            subprocess.run([sys.executable, "-m", "stabilab", *words], cwd=folder, check=True,
                           capture_output=True, env=os.environ | {"PYTHONPATH": str(ROOT)})
            times.append((_spent() - before) / cores)
    return allowed(key, what, times, limit, "processor time; " + note)


def _spent() -> float:
    """Seconds of processor that ended child processes took, their children's too."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
