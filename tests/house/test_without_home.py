"""Without a home (cron, systemd, containers), or with one that cannot be written, stdout holds the answer
alone, and stderr what stabilab itself says."""
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from stabilab.cli import whole

ROOT = Path(__file__).parents[2]
CASES = ROOT / "cases"
DAMPED = CASES / "rahn-barba.toml"
MINOR, OFF, CHARGED, STUCK = (CASES / f"{name}.toml" for name in (
    "minor-axis-100", "off-axis-two", "charged-body", "thruster-stuck-major-axis"))

BODY = '{"IHubPntBc_B": [12, 0, 0, 0, 9, 0, 0, 0, 5], "omega_BN_BInit": [0.1, 0, 0]}'
BURN = """body.inertia = [12, 9, 5]
body.mass = 10
motion.angular_velocity = [0.01, 0, 0]
thrusters = [{position = [1, 0, 0], direction = [0, 1, 0], force = 0.1, stop = "30 s"}]
"""
ORBIT = "body.inertia = [3, 2, 1]\ncircular_orbit.altitude = '700 km'\n"
MEASURED = {"precision": lambda answer: answer.splitlines()[-1]}  # times of this machine
# command -> a light line of it; in this order, as some read what others wrote
LINES = {
    "fate": ("fate", OFF, "--json"), "simulate": ("simulate", OFF, "--at", "1", "--json"),
    "extremes": ("extremes", OFF, "--csv"),
    "chaos": ("chaos", OFF), "plot": ("plot", MINOR, "--out", "o.png"),
    "classify": ("classify", MINOR, "--certify", "--out", "c.json"), "period": ("period", MINOR, "--json"),
    "when": ("when", OFF, "--rate", "3 rad/s"),
    "burn": ("burn", "burn.toml", "--below", "2 deg/s"),
    "orbit": ("orbit", "orbit.toml"),
    "attitude": ("attitude", OFF), "papers": ("papers", "liquid-cavity", "--json"),
    "flat-spin": ("flat-spin", DAMPED),
    "stuck": ("stuck", STUCK), "surface": ("surface", MINOR, "--out", "s"), "show": ("show", MINOR),
    "compare": ("compare", CHARGED),
    "precision": ("precision", MINOR, "--quick", "--until", "1", "--json"),
    "sweep": ("sweep", OFF, "--vary", "angular_velocity[1]=0.1:0.2:3", "--csv"),
    "atlas": ("atlas", OFF, "--level", "1", "--refine", "0"),
    "basin": ("basin", MINOR, "--vary", "x[1]=-4:4:3", "--vary", "x[3]=-3:3:3", "--depth", "1"),
    "bifurcation": ("bifurcation", MINOR, "--vary", "mu[3]=0:1"), "verify": ("verify", "c.json"),
    "reference": ("reference", MINOR),
    "audit": ("audit", "constant-torque-gyrostat", "--equation", "17"), "validate": ("validate", "nesc"),
    "tables": ("tables", "--out", "t"),
    "figures": ("figures", "9", "--out", "f"), "rerun": ("rerun", "s"), "doctor": ("doctor",),
    "example": ("example", "phone"),
    "import": ("import", "body.json"), "export": ("export", "burn.toml"), "explore": ("explore", MINOR, "--static", "x"),
    "report": ("report", MINOR, "--out", "r"),
}


# Runs command lines in turn in one process; what each prints through Python goes to NUMBER.txt, what a
# library prints below it to the process's stdout.
PROGRAM = """
import contextlib, io, json, sys
from pathlib import Path
from stabilab import cli, load, simulate
lines, file = map(json.loads, sys.argv[1:])
for number, line in enumerate(lines):
    sys.argv = ["stabilab", *line]
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        try:
            cli.main()
        except SystemExit as left:
            print("exit", left.code or 0)
    Path(f"{number}.txt").write_text(said.getvalue(), encoding="utf-8")
case = load(file)
simulate(case.scene, case.state, [0, 1])  # a function, not a command
"""


def said(folder, lines, **home):
    """(answers, stdout below Python, stderr) of command lines with no more of an environment than a path and
    this."""
    folder.mkdir()
    (folder / "body.json").write_text(BODY, encoding="utf-8")
    (folder / "burn.toml").write_text(BURN, encoding="utf-8")
    (folder / "orbit.toml").write_text(ORBIT, encoding="utf-8")
    done = subprocess.run([sys.executable, "-c", PROGRAM,
                           json.dumps([list(map(str, line)) for line in lines]), json.dumps(str(OFF))],
                          cwd=folder,
                          text=True, capture_output=True,
                          env={"PATH": os.environ["PATH"], "PYTHONPATH": str(ROOT), **home})
    assert done.returncode == 0, done.stderr
    return [(folder / f"{number}.txt").read_text(encoding="utf-8")
            for number in range(len(lines))], done.stdout, done.stderr


def test_without_a_home_stdout_is_the_answer_alone(tmp_path):
    (answer,), below, words = said(tmp_path / "none", [LINES["simulate"]])
    assert json.loads(answer.removesuffix("exit 0\n")) and (below, words) == ("", "")


@pytest.mark.slow
@pytest.mark.parametrize("home", [pytest.param({}, marks=pytest.mark.long), {"HOME": "/dev/null"}],
                         ids=["none", "unwritable"])
def test_without_a_home_no_command_lets_a_library_write(tmp_path, home):
    assert set(LINES) == {command.name or command.callback.__name__
                          for command in whole().registered_commands}
    answers, below, words = said(tmp_path / "home", LINES.values(), HOME=str(tmp_path))
    assert all(answer.endswith("exit 0\n") for answer in answers) and below == "", words
    found, under, warned = said(tmp_path / "other", LINES.values(), **home)
    differing = [name for name, one, other in zip(LINES, answers, found)
                 if MEASURED.get(name, str)(one) != MEASURED.get(name, str)(other)]
    assert (under, warned, differing) == ("", words, [])
