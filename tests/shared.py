"""Scenes, states and answers that tests of several rooms share."""
from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import stabilab
from stabilab import Body, ScaledGyrostat
from stabilab.answers.certificate import certificate
from stabilab.physics.effects.liquid_cavity import LiquidCavity
from tests.oracles.pairs import PAPER_BODY, physical, scaled

CASES = Path(__file__).parents[1] / "cases"

# of README.md, alone and with its motion
SATELLITE = """[body]
inertia = [12, 9, 5]
[effects.gyrostat]
momentum = [0.8, 0, 0]
[effects.constant_torque]
torque = [0, 0, 0.02]
"""
MOVING = SATELLITE + "[motion]\nangular_velocity = [0.1, 0.05, 0.02]\n"


def case(name):
    return stabilab.load(CASES / f"{name}.toml")


def later(rows):
    """Parameters that the default suite leaves out: one in eight for the slow tests, the others for the long."""
    return [pytest.param(*(row if isinstance(row, tuple) else (row,)),
                         marks=[pytest.mark.slow, *[pytest.mark.long] * (n % 8 > 0)])
            for n, row in enumerate(rows)]


ROUND, LIQUID = Body(("9.5", "9.5", "9")), LiquidCavity(1250, 1000, "1.9")


def craft_file(inertia, thruster, wheels, start, centre=(0, 0, 0), **more):
    """A case file of a spacecraft with one thruster, stuck: (position, direction, force), and what else the
    file says of it; wheels: (axis, momentum)."""
    position, direction, force = thruster
    parts = [("body", {"inertia": inertia, "centre_of_mass": centre}),
             ("[thrusters]", {"name": "A", "position": position, "direction": direction, "force": force,
                              "stuck": True, **more}),
             *(("[wheels]", {"name": "WVU"[n], "axis": axis, "momentum": momentum}) for n,
               (axis, momentum) in enumerate(wheels)),
             ("motion", {"angular_velocity": start})]
    return "".join(f"[{name}]\n" + "".join(f"{key} = {json.dumps(value)}\n" for key, value in keys.items())
                   for name, keys in parts)


def written(scene, *state):
    """A certificate as it comes from its file."""
    return json.loads(json.dumps(certificate(scene, *state)))

TIE = """
title = "tie of decimals"
source = "3 omega1 = 4 omega3 is the separatrix: D1 (D1 - D2) = 9, D3 (D2 - D3) = 16"
[body]
inertia = [9, 8, 4]
[motion]
angular_velocity = [0.4, 0.7, 0.3]
span = [0, 20]
"""
# mpmath in 60 digits from x1' = x2 x3, x2' = -x3 (x1 + a), x3' = 1 + x2 (x1 + b) on the circle x1 + a = A
# sin, x2 = A cos:
# midpoint rule between the turning points, bisected; barrier by findroot. With the double nearest to 0.1 the
# 18th digit differs.
PERIOD, MARGIN = "1.804312247500545757485173072956", "1.632183021364656117174097282608"


def answer(command, folder, text, *options):
    """What a command says of a case file, as JSON."""
    path = folder / "case.toml"
    path.write_text(text)
    done = subprocess.run([sys.executable, "-m", "stabilab", command, str(path), "--json", *options],
                          capture_output=True, text=True, check=True)
    return json.loads(done.stdout)

# Every way the paper's two solvable cases and their generalisation come: name -> (scene, model).
FAMILIES = {
    "minor scaled +": scaled(0.2, 0.4, (0, 0, 1)),
    "minor scaled -": scaled(-0.7, 1.1, (0, 0, -0.6)),
    "minor scaled a=b": scaled(0.5, 0.5, (0, 0, 2.0)),
    "middle scaled +": scaled(0.2, 0.4, (0, 1, 0)),
    "middle scaled -, |c| above the cusp": scaled(0.5, 3.1, (0, -0.8, 0)),
    "middle scaled, |c| far above": scaled(-1.0, -5.0, (0, 1, 0)),
    "minor physical": physical(PAPER_BODY, (100, 50, 0), (0, 0, 204.1)),
    "minor physical, other sign": physical((3.0, 2.0, 1.5), (-0.4, 0.7, 0), (0, 0, -0.3)),
    "minor on axis 1": physical((1.0, 1.5, 2.0), (0, 0.3, -0.2), (0.25, 0, 0)),
    "middle physical": physical((3.0, 2.0, 1.5), (0.4, 0, -0.9), (0, 0.3, 0)),
    "middle physical, other sign": physical((1.4, 2.2, 3.1), (2.0, 0, 1.5), (0, -0.1, 0)),
    "major physical": physical((3.0, 2.0, 1.5), (0, 0.8, 0.6), (0.2, 0, 0)),
    "major physical, other sign": physical((1.3, 2.0, 2.9), (-1.8, 0.6, 0), (0, 0, -0.15)),
    "major without gyrostat": physical((3.0, 2.0, 1.5), (0, 0, 0), (-0.2, 0, 0)),
}
ELLIPTIC = [name for name in FAMILIES if not name.startswith("middle")]


def sample(name, count, spread=2.5):
    return np.random.default_rng(sorted(FAMILIES).index(name)).normal(size=(count, 3)) * spread


# Two equal moments, the torque on a transverse axis: the orbit's pair of rates runs along a parabola or a
# straight line.
PARABOLIC = {
    "first axis": physical((2, 2, 1), (0, 0.25, 0.5), (0.5, 0, 0)),
    "first axis, other sign": physical((2, 2, 1), (0, -1.5, 0.7), (-0.8, 0, 0)),
    "second axis": physical((2, 2, 3), (0.4, 0, -0.9), (0, 0.3, 0)),
    "third axis": physical((1.5, 2, 2), (0.6, -0.3, 0), (0, 0, -0.4)),
    "oblate": physical((3, 2, 2), (1.5, 0.8, 0), (0, 0, 0.2)),
    "no gyrostat": physical((2, 2, 1), (0, 0, 0), (1, 0, 0)),
    "wheel on the symmetry axis": physical((2, 2, 1), (0, 0, 0.5), (0.5, 0, 0)),
    "a sphere": physical((2, 2, 2), (0, 0.5, 1), (0.5, 0, 0))}
SCALED_MINOR = ScaledGyrostat("0.2", "0.4", (0, 0, 1))


def in_one_line(out):
    """An answer whose clauses stand below each other, in one line again."""
    return "; ".join(map(str.strip, out.splitlines()))
