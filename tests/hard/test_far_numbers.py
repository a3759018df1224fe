"""Commands on scenes of which a number is wild: a mistyped exponent, a unit too many. They end with an answer, or
with what is wrong, and neither fill the memory nor break off.

The memory is that of a process of its own, which the system limits; no answer here is compared with another."""
import random
import re
import subprocess
import sys

import pytest

from tests.shared import CASES

ROOM = 3 * 2**30  # bytes of addresses, of which compiled code and libraries map most
HELD = 500 * 2**10  # kB of memory held; a plain answer holds 150 to 250
ENDS = {0, 2, 3, 5}  # an answer, bad input, undecided, digits not reached
FAR = ("1e-300", "1e-150", "1e-20", "1e12", "1e20", "1e110", "1e150", "1e300", "-1e300")
SCENES = ("middle-axis-500", "minor-axis-100", "off-axis-two", "charged-body", "charged-body-attitude",
          "liquid-base",
          "explorer-1-damped", "rahn-barba", "top-fast", "torque-free-gyrostat", "sphere-wheel",
          "cubesat-3u-detumbling", "geostationary-22n", "wheel-and-thruster", "uncertain-minor-axis")
COMMANDS = ("fate", "fate --certify", "classify", "extremes", "period", "attitude", "when --rate 1",
            "when --energy 5", "flat-spin", "simulate", "simulate --at 1e30", "compare",
            "reference --digits 15 --at 1")
LIMITED = """
import resource, sys
resource.setrlimit(resource.RLIMIT_AS, ({room},) * 2)
from stabilab.__main__ import main
sys.argv = ["stabilab", *{words}]
try:
    main()
finally:
    # of this program alone: getrusage counts what the process that started it held, too
    held = next(line.split()[1] for line in open("/proc/self/status") if line.startswith("VmHWM"))
    print("held", held, file=sys.stderr, flush=True)
"""


def numbers_of(text):
    """Where the numbers of a case file stand that are part of its scene or motion."""
    found, place, section = [], 0, ""
    for line in text.splitlines(keepends=True):
        section = line.strip() if line.startswith("[") else section
        if not re.match(r"title|source|kind|fate|axis|\[|#", line.strip()) and section not in ("[expect]", "[limits]"):
            found += [(place + one.start(), place + one.end())
                      for one in re.finditer(r"(?<![\w.])-?\d+\.?\d*([eE][-+]?\d+)?", line.split("#")[0])]
        place += len(line)
    return found


def wild(seed):
    """(a case with one to three wild numbers, a command)."""
    draw = random.Random(seed)
    text = (CASES / f"{draw.choice(SCENES)}.toml").read_text(encoding="utf-8")
    places = numbers_of(text)
    for first, last in sorted(draw.sample(places, min(len(places), draw.choice((1, 1, 2, 3)))), reverse=True):
        text = text[:first] + draw.choice(FAR) + text[last:]
    return text, COMMANDS[seed % len(COMMANDS)]


def ended(folder, text, command):
    """(exit code, what it said last, kB that it held)."""
    (folder / "wild.toml").write_text(text, encoding="utf-8")
    name, *options = command.split()
    words = [name, str(folder / "wild.toml"), *options]
    run = subprocess.run([sys.executable, "-c", LIMITED.format(room=ROOM, words=words)], capture_output=True, text=True)
    said, _, held = run.stderr.rpartition("held ")
    return run.returncode, said or run.stdout, int(held)


# that filled gigabytes or broke off
WORST = {
    "fate --certify": ("middle-axis-500", "mu = [0, 1, 0]", "mu = [1e300, 1, 0]"),
    "fate": ("middle-axis-500", "[1.7, 1.1, -0.2]\n", "[1e110, 1.1, -0.2]\n"),
    "when --energy 5": ("charged-body", "field = 100", "field = 1e300"),
    "reference --digits 15 --at 1": ("charged-body", "charge = 0.003", "charge = 1e300"),
    "extremes": ("explorer-1-damped", "750 rpm", "750000 rpm"),
    "compare": ("top-fast", "150.0]", "150e6]"),
    "simulate --at 1e30": ("charged-body", "field = 100", "field = 100.0"),
}


@pytest.mark.parametrize("command", [pytest.param(one, marks=[pytest.mark.slow] * (n > 1))
                                     for n, one in enumerate(WORST)])
def test_commands_that_had_no_bound_have_one(command, tmp_path):
    scene, old, new = WORST[command]
    text = (CASES / f"{scene}.toml").read_text(encoding="utf-8")
    assert old in text
    code, said, held = ended(tmp_path, text.replace(old, new), command)
    assert code in ENDS and held < HELD, f"exit {code}, {held} kB: {said}"


@pytest.mark.slow
@pytest.mark.long  # minutes of processor time a few of them
@pytest.mark.parametrize("seed", range(len(COMMANDS) * 6))
def test_a_wild_number_fills_no_memory_and_breaks_nothing_off(seed, tmp_path):
    text, command = wild(seed)
    code, said, held = ended(tmp_path, text, command)
    assert code in ENDS and held < HELD, f"{command}: exit {code}, {held} kB: {said}\n{text}"
