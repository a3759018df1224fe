"""Commands that compute many motions or equilibria, from the shell: the processor time of all their
processes, start included; atlas and chaos in this process."""
from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from functools import partial
from pathlib import Path

from .rows import Row

ROOT = Path(__file__).parents[1]
START = "the start of the command is in it"
PAGES = {"island.toml": "docs/basins.md", "tug.toml": "docs/bifurcation.md"}
BASIN = ("basin", "cases/minor-axis-100.toml", "--vary", "x[1]=-4:4", "--vary", "x[3]=-3:3", "--depth")
ISLAND = ("basin", "island.toml", "--vary", "angular_velocity[1]=-230:60 deg/s", "--vary",
          "angular_velocity[3]=-90:200 deg/s", "--follow", "500 s", "--depth")
COMMANDS = {  # key -> (words, command)
    "basin-plane": ("basins under a torque on an axis, depth 6", (*BASIN, "6")),
    "basin-island": ("basins with an island under a torque off the axes, depth 5", (*ISLAND, "5")),
    "chaos": ("MEGNO over a thousand turns", ("chaos", "island.toml")),
    "diagram": ("bifurcation diagram over one number",
                ("bifurcation", "tug.toml", "--vary", "torque[3]=0:0.5")),
    "diagram-plane": ("bifurcation diagram over two numbers",
                      ("bifurcation", "tug.toml", "--vary", "torque[3]=0:0.5", "--vary", "momentum[1]=-2:2")),
    "stuck-all": ("stuck --all-thrusters, six thrusters",
                  ("stuck", "cases/cubesat-3u.toml", "--all-thrusters")),
}


def measurements(small=False):
    if small:
        return [partial(shell, "basin-plane", (*BASIN, "2"), "small")]
    return [*(partial(shell, key, command, words) for key, (words, command) in COMMANDS.items()),
            partial(atlas, "atlas", "off-axis-two", False), partial(atlas, "atlas-timed", "cubesat-3u", True),
            megno, damped]


def shell(key: str, command: tuple[str, ...], words: str) -> Row:
    """A command of the pages, in a folder with the cases that they write."""
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(ROOT / "cases", Path(folder) / "cases")
        for name, page in PAGES.items():
            (Path(folder) / name).write_text(_of_a_page(name, page), encoding="utf-8")
        before = _spent()
        subprocess.run([sys.executable, "-m", "stabilab", *command], cwd=folder, check=True,
                       capture_output=True, env=os.environ | {"PYTHONPATH": str(ROOT)})
        return Row(f"maps-{key}", f"{words}: `stabilab {' '.join(command[:2])} ...`", _spent() - before, "s",
                   note=START)


def _of_a_page(name: str, page: str) -> str:
    text = (ROOT / page).read_text(encoding="utf-8")
    return text.split(f"```toml\n# {name}\n", 1)[1].split("```", 1)[0]


def _spent() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def atlas(key: str, case: str, timed: bool) -> Row:
    """Processor time of a cell, of an atlas without refinement, in a process that has made a small one."""
    import stabilab
    path = ROOT / "cases" / f"{case}.toml"
    stabilab.atlas(path, level=0, refine=0, timed=timed)
    at = time.process_time()
    made = stabilab.atlas(path, level=2, refine=0, timed=timed)
    spent = time.process_time() - at
    cells = int(made.sizes["cell"])
    return Row(f"maps-{key}", f"atlas of {case}, {cells} cells{', with times to the limit, proved' * timed}",
               spent / cells)


def megno(count: int = 64) -> Row:
    """MEGNO of motions that stay bounded, many at a time, in a process that has compiled the equations."""
    import numpy as np

    from stabilab import load
    from stabilab.answers.chaos import chaos
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "island.toml"
        path.write_text(_of_a_page("island.toml", "docs/basins.md"), encoding="utf-8")
        case = load(path)
    states = np.array([float(v) for v in case.state]) * (1 + 0.001 * np.arange(count)[:, None] / count)
    chaos(case.scene, states[:8])
    at = time.process_time()
    found = chaos(case.scene, states)
    assert np.isfinite(found.megno).all()
    return Row("maps-megno", f"MEGNO of {count} motions over a thousand turns",
               (time.process_time() - at) / count,
               note="the equations were compiled before")


def damped() -> Row:
    """A step of a run of a body with a damper, whose steps are counted."""
    from stabilab import flat_spin, load
    case = load(ROOT / "cases" / "explorer-1-damped.toml")
    flat_spin(case)
    at = time.process_time()
    found = flat_spin(case)
    spent = time.process_time() - at
    return Row("maps-damped-step", f"a step, flat-spin of explorer-1-damped, {found.steps} steps",
               spent / found.steps)


