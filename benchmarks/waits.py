"""What a person waits for: the first answer, the report of one's own case, the report of everything, an
answer about each of sixty thrusters. CPU time, against what is allowed."""
from __future__ import annotations

import os
import random
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
            partial(_waited, "wait-stuck-60",
                    "stabilab stuck --all-thrusters of sixty thrusters, a core's share of two",
                    ("stuck", "sixty.toml", "--all-thrusters"), CORES, 15.0, 3,
                    "for each the fate with its proof, the time to the limit, what a misalignment and other "
                    "forces do, and which of 59 others and of 1711 pairs help most"),
            compiling]


def compiling() -> Row:
    """All loops compiled into an empty cache."""
    with tempfile.TemporaryDirectory() as folder:
        before = _spent()
        subprocess.run([sys.executable, "-m", "stabilab", "doctor", "--compile"], cwd=folder, check=False,
                       capture_output=True,
                       env=os.environ | {"PYTHONPATH": str(ROOT), "NUMBA_CACHE_DIR": f"{folder}/cache"})
        assert any(Path(folder, "cache").rglob("*.nbi"))
        return Row("wait-compile", "stabilab doctor --compile, once per computer, a core's share of two",
                   (_spent() - before) / CORES, "s", note="processor time")


def _of_the_readme() -> str:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    return text.split("```toml\n", 1)[1].split("```", 1)[0]


def sixty_thrusters() -> str:
    """A case of a small satellite with thrusters at random places, in random directions."""
    rng = random.Random(60)
    text = '''[body]
inertia = [[0.0418, 0.0003, -0.0006], [0.0003, 0.0427, 0.0004], [-0.0006, 0.0004, 0.0089]]
mass = "4.6 kg"
centre_of_mass = ["3 mm", "-2 mm", "6 mm"]
[[wheels]]
name = "pitch"
axis = [0, 1, 0]
inertia = "3.2e-5 kg m^2"
speed = "3000 rpm"
[limits]
rate = "60 deg/s"
[motion]
angular_velocity = ["0.2 deg/s", "-0.1 deg/s", "0.5 deg/s"]
span = [0, "5 min"]
'''
    for n in range(60):
        position = [f"{rng.uniform(-reach, reach):.1f} cm" for reach in (5, 5, 17)]
        direction = [round(rng.gauss(0, 1), 2) for _ in range(3)]
        text += (f'[[thrusters]]\nname = "T{n}"\nposition = {position}\ndirection = {direction}\n'
                 'force = "30 mN"\nmisalignment = "1 deg"\nforce_tolerance = "5 %"\n')
    return text


def _waited(key, what, words, cores, limit, rounds, note) -> Row:
    times = []
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "my.toml").write_text(_of_the_readme(), encoding="utf-8")
        (Path(folder) / "sixty.toml").write_text(sixty_thrusters(), encoding="utf-8")
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
