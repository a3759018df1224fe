"""What a person waits for: the first answer, the report of one's own case, the report of everything. CPU
time, against what is allowed."""
from __future__ import annotations

import resource
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

from .rows import Row

ROOT = Path(__file__).parents[1]
CASES = sorted(map(str, (ROOT / "cases").glob("*.toml")))
CORES = 2  # of the machine that the limits are for; what runs in one process alone counts whole


def rows(small=False) -> list[Row]:
    """The case of the README, in a fresh interpreter each time. Small: the first answer alone."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "my.toml").write_text(_of_the_readme(), encoding="utf-8")
        found = [_row("first answer of a newcomer, stabilab fate my.toml", ("fate", "my.toml"), folder, 1,
                      1.0, 1 if small else 9,
                      "most of it imports: typer, and the program's own modules")]
        if small:
            return found
        found.append(_row("stabilab report my.toml", ("report", "my.toml", "--out", "one"), folder, 1, 20.0,
                          3,
                          "the search for the worst tilt, and four pictures with Matplotlib: a third each"))
        found.append(_row("make report, a core's share of two",
                          ("report", *CASES, "--papers", "--precision", "--out", "all"), folder, CORES, 150.0,
                          1,
                          "a page with pictures for each case, and what answers cost: three tenths each; "
                          "chapters and audit of the papers: a sixth each"))
        return found


def _of_the_readme() -> str:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    return text.split("```toml\n", 1)[1].split("```", 1)[0]


def _row(name, words, folder, cores, allowed, rounds, note) -> Row:
    times = []
    for _ in range(rounds):
        before = _spent()
        subprocess.run([sys.executable, "-m", "stabilab", *words], cwd=folder, check=True,
                       capture_output=True)
        times.append((_spent() - before) / cores)
    ratios = sorted(allowed / t for t in times)
    return Row(name, f"{median(times):.3g} s of CPU", f"{allowed:g} s allowed", median(ratios),
               (ratios[0], ratios[-1]), "none: the same answers", 1.0, note)


def _spent() -> float:
    """Seconds of processor that ended child processes took, their children's too."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
