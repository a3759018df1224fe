"""The first line of an answer has at most 100 letters, with the outcome and the condition that it rests on: over
random scenes of all effects, and the cases that come with the program."""
from __future__ import annotations

import pytest

from stabilab.show.terminal import LINE
from tests.recorded.answers import run
from tests.recorded.cases import ROOT
from tests.show.random_scenes import KINDS, written

COMMANDS = {"fate": (), "extremes": (), "period": (), "classify": (), "stuck": (), "attitude": (), "flat-spin": (),
            "when": ("--rate", "2000 deg/s"), "burn": (), "orbit": (), "compare": (), "simulate": ("--at", "0,1"),
            "chaos": ("--until", "5"), "bifurcation": ("--vary", "body.inertia[1]=1:3"),
            "sweep": ("--vary", "motion.angular_velocity[1]=0.1,0.2"), "atlas": ("--level", "0", "--refine", "0"),
            "basin": ("--vary", "angular_velocity[1]=0:1:3", "--vary", "angular_velocity[2]=0:1:3", "--depth", "0")}
QUICK = ("fate", "period", "stuck", "attitude", "when")
CONDITIONAL = ("fate", "period", "stuck", "attitude", "when")  # whose outcome is what rests on it
ALONE = ("no thruster fires", "BEYOND THE LAW")  # warnings, which are no outcome
SCENES = [f"{kind}-{n:02}" for n, kind in zip(range(108), [*KINDS] * 6)]
CASES = sorted((ROOT / "cases").glob("*.toml"))


@pytest.fixture(scope="module")
def scenes(tmp_path_factory):
    return written(tmp_path_factory.mktemp("scenes"), len(SCENES))


def faults(command: str, path, name: str) -> list[str]:
    """What is wrong with the first line of a command's answer; nothing where it refuses the case."""
    said = run(command, str(path), *COMMANDS[command])
    if said["exit"] not in (0, 3):
        return []
    first, result = said["answer"].partition("\n")[0], []
    if len(first) > LINE:
        result.append(f"{len(first)} letters: {first}")
    if first.removeprefix(f"{name}: ").endswith(ALONE):
        result.append(f"no outcome: {first}")
    if command in CONDITIONAL and " only w" in said["answer"] and " only w" not in first:
        result.append(f"no condition: {first}")
    return result


def rows():
    """A quick command of each kind of scene; half of all commands, slow; all of all scenes."""
    for n, name in enumerate(SCENES[:len(KINDS)]):
        for m, command in enumerate(COMMANDS):
            quick = command == QUICK[n % len(QUICK)]
            if quick or (n + m) % 2 == 0:
                yield pytest.param(command, [name], marks=[] if quick else [pytest.mark.slow], id=f"{command}-{name}")
    for command in COMMANDS:
        yield pytest.param(command, SCENES, marks=[pytest.mark.slow, pytest.mark.long], id=command)


@pytest.mark.parametrize("command, names", list(rows()))
def test_the_first_line_over_random_scenes(command, names, scenes):
    assert {name: out for name in names if (out := faults(command, scenes[name], name))} == {}


@pytest.mark.slow
@pytest.mark.parametrize("step", [4, pytest.param(1, marks=pytest.mark.long)])  # each fourth case; all
@pytest.mark.parametrize("command", ["fate", "extremes", "period", "stuck", "attitude", "flat-spin", "compare", "when"])
def test_the_first_line_over_all_cases(command, step, monkeypatch):
    monkeypatch.setitem(COMMANDS, "when", ("--rate", "30 deg/s"))
    assert {path.stem: out for path in CASES[::step] if (out := faults(command, path, path.stem))} == {}
