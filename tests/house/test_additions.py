"""What a newcomer adds: a kind of scene and a question, each one file and one row, in a copy of the package.
"""
from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys

import pytest
from scipy.integrate import solve_ivp

from stabilab.physics.effects import REGISTRY, effect_class
from tests.house.rooms import PACKAGE
from tests.oracles.rigid import euler
from tests.shared import CASES

KIND = '''"""A sphere without wheel and torque: whatever its rates are, they stay."""
from __future__ import annotations

from ..orbit.fate_arrays import in_chunks, write_row
from ..orbit.fate import Basis
from ..orbit.result import Fate, Motion, Needs
from ..physics.coefficients import three_floats
from ..reasons import Sentence

KEEPS = Sentence("sphere-keeps-rates", "a sphere keeps its rates")


def holds(scene) -> bool:
    """Whether no rate depends on another, and no torque acts."""
    form = scene.quadratic()
    return scene.plain and not any((*form.kappa, *form.rho, *form.sigma, *form.m))


def motion(scene, state, span=None, exact=None, needs=Needs.ALL) -> Motion:
    """The motion is its start."""
    rates = three_floats(state)
    return Motion(rates, Fate.EQUILIBRIUM, reason=KEEPS(), extremes=tuple((v, v) for v in rates))


def fates(scene, states, fast=None):
    """Fates of states (n, 3)."""
    def label(rows, out):
        for n in range(len(rows)):
            write_row(out, n, Fate.EQUILIBRIUM, Basis.AT_REST, float("inf"))
        return 0
    return in_chunks(label, states)


def extremes(scene, states, span=None, fast=None):
    """(n, 3, 2)."""
    return states[:, :, None].repeat(2, axis=2)


def periods(scene, states, fast=None):
    """(n,)."""
    return 0 * states[:, 0]
'''
KIND_ROW = (
    "answers/kinds.py", "KINDS",
    '    "sphere": Kind(lambda scene: import_module("..unreduced.sphere", __package__).holds(scene), '
    '"unreduced.sphere", "unreduced.sphere"),\n')
QUESTION = '''"""How far each rate swings."""
from __future__ import annotations

from .motion import Needs, motion


def swing(scene, state, span=None) -> tuple:
    """Greatest minus least value of the three rates from one state on."""
    return tuple(high - low for low, high in motion(scene, state, span, needs=Needs.EXTREMES).extremes)
'''
QUESTION_ROW = ("__init__.py", "_HOME", '    "swing": "answers.swing",\n')
EFFECT = '''"""A torque against the angular velocity, in proportion to it."""
from dataclasses import dataclass, field
from fractions import Fraction
from typing import ClassVar

from ...numbers.exact import exact
from .base import Effect


@dataclass(frozen=True)
class Brake(Effect):
    """Torque -k omega, N m, k in N m s."""

    name: ClassVar[str] = "brake"
    article: ClassVar[str] = "a"
    takes: ClassVar[str] = "outside"
    agent: ClassVar[str] = "the brake"
    keys: ClassVar[tuple[str, ...]] = ("coefficient",)
    symbols: ClassVar[tuple[str, ...]] = ("kb",)
    isotropic: ClassVar[bool] = True
    keeps_volume: ClassVar[bool] = False
    coefficient: float
    exact: Fraction = field(init=False, repr=False)

    def __post_init__(self):
        object.__setattr__(self, "exact", exact(self.coefficient, "coefficient"))

    @classmethod
    def from_case(cls, table, context):
        value = table.number("coefficient") if table.required("coefficient") else None
        return None if value is None else cls(value)

    def terms(self):
        return {"C": tuple(tuple(self.exact * (i == j) for j in range(3)) for i in range(3))}

    def torque(self, omega, p):
        return tuple(-p["kb"] * w for w in omega)
'''
EFFECT_ROW = "physics/effects/__init__.py", "REGISTRY", '    "brake": ("brake", "Brake"),\n'
BRAKED = """
import json
import stabilab
from stabilab.answers.kinds import kind_of
from stabilab.show.explore.pictures import why
case = stabilab.load({"body": {"inertia": [12, 9, 5]}, "effects": {"brake": {"coefficient": 0.3}},
                      "motion": {"angular_velocity": [0.1, 0.05, 0.02], "span": [0, 10]}})
moved = stabilab.motion(case)
legend = stabilab.plot.body(case).figure.legends[0]
told = {"fate": moved.fate.word, "ending": moved.ending.kind, "why": why(case.scene),
        "omega": stabilab.simulate(case, times=[0.0, 10.0]).state["omega"][-1].tolist(),
        "legend": [text.get_text() for text in legend.get_texts()]}
print(json.dumps(told))
"""
COLUMN_ROW = ("maps/columns.py", "ANSWERS", """    "swing": Answer("motions", (1e-5, 2e-2), (
        Column("swing", "f8", RATE, "greatest less least rate about each principal axis",
               lambda rows: rows.extremes[..., 1] - rows.extremes[..., 0],
               lambda motion: motion.extremes and [b - a for a, b in motion.extremes], shape=(3,)),)),
""")
PICTURE = '''"""The energy of the motion over time."""
import numpy as np

from . import canvas
from .path import along
from .subject import check, subject


def energy(case, units=None, size=None, ax=None):
    """Draw the kinetic energy over the span of the case."""
    one = subject(case)
    check("energy", one)
    times = np.linspace(*one.seen, 50)
    with canvas.on(ax, size or (6, 4)) as target:
        t, rates = along(one, times)
        target.plot(t, (rates**2).sum(axis=1))
        target.set_ylabel("size")
    return target
'''
PICTURE_ROW = ("show/picture_kinds.py", "KINDS",
               '    "energy": Picture("the energy over time", "energy.energy", "range"),\n')
SEEN = """
import json
import sys
from pathlib import Path
from typing import get_type_hints
import numpy as np
import stabilab
from stabilab.cli import runs
from stabilab.show.plot.subject import offered, subject
case = stabilab.load(sys.argv[1])
found = stabilab.sweep(case, {"x[1]": "-4:4:3"}, answer="swing,extremes")
apart = found["greatest"].values - found["least"].values
alone = stabilab.sweep(case, {"x[1]": "-4:4:3"}, answer="swing")["swing"].values
stabilab.plot.write(case, "energy.png", "energy")
plan = stabilab.sweep(case, {"x[1]": "-4:4:3"}, answer="swing", out="swing.nc")
from stabilab.show.maps import picture
picture.write("swing.nc", "swing.png", "swing")
print(json.dumps({"swing": bool(np.array_equal(alone, apart) and np.array_equal(found["swing"].values, apart)),
                  "kinds": offered(subject(case)), "drawn": Path("energy.png").stat().st_size,
                  "help": str(get_type_hints(runs.plot, include_extras=True)["kind"].__metadata__[0].help)}))
"""
ASKED = """
import json
import stabilab
from stabilab import Body, ConstantTorque, Gyrostat, Scene
from stabilab.answers.kinds import kind_of
sphere = Scene(Body((2, 2, 2)))
satellite = Scene(Body((12, 9, 5)), Gyrostat(("0.8", 0, 0)), ConstantTorque((0, 0, "0.02")))
state = (0.1, 0.05, 0.02)
told = {"file": stabilab.__file__, "kinds": [kind_of(sphere), kind_of(satellite)], "because": stabilab.motion(sphere, state).because}
if "swing" in stabilab.__all__:
    told["swing"] = [stabilab.swing(sphere, state), stabilab.swing(satellite, state)]
told["many"] = [stabilab.fate(sphere, [state]).labels.tolist(), stabilab.extremes(sphere, [state]).tolist(), stabilab.period(sphere, [state]).tolist()]
told["satellite"] = repr(vars(stabilab.motion(satellite, state)))
print(json.dumps(told))
"""


def test_every_effect_is_one_file_and_one_row_of_the_registry():
    """And nothing that derives, compiles or integrates equations of motion names the two that damp from outside."""
    files = {path.stem for path in (PACKAGE / "physics/effects").glob("*.py")} - {"__init__", "base"}
    assert files == {module for module, _ in REGISTRY.values()} and len(files) == len(REGISTRY)
    assert all(effect_class(name).name == name for name in REGISTRY)
    # what people write in place of the name of an effect, or of a value of it, for messages alone
    rooms = [*(PACKAGE / "integrate").rglob("*.py"),
             *(one for one in (PACKAGE / "case").rglob("*.py") if one.name not in ("aliases.py", "cures.py")),
             *(PACKAGE / f"physics/{name}.py" for name in ("equations", "to_numpy", "body", "scene", "states"))]
    naming = {path.name for path in rooms for name in ("rate_damper", "eddy_currents")
              if name in path.read_text(encoding="utf-8")}
    assert not naming


def added(package, file, text, row):
    """One file and one row beside what stands there."""
    (package / file).write_text(text, encoding="utf-8")
    path, table, line = row
    lines = (package / path).read_text(encoding="utf-8").splitlines(keepends=True)
    start, = (n for n, one in enumerate(lines) if one.startswith(table) and one.endswith("= {\n"))
    (package / path).write_text("".join([*lines[:start + 1], line, *lines[start + 1:]]), encoding="utf-8")


def told_by(folder, program=ASKED, *arguments):
    done = subprocess.run([sys.executable, "-c", program, *arguments], cwd=folder,
                          env={**os.environ, "PYTHONPATH": str(folder)}, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def copied(folder):
    """The folder, with a copy of the package; what Python compiled of it serves the copy as well."""
    shutil.copytree(PACKAGE, folder / "stabilab", ignore=shutil.ignore_patterns("*.nbi", "*.nbc"))
    return folder


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    return copied(tmp_path_factory.mktemp("copy"))


def test_a_seventh_kind_and_a_new_question_are_one_file_and_one_row_each(copy):
    before = told_by(copy)
    assert before["file"].startswith(str(copy)) and before["kinds"] == ["orbit", "orbit"]
    added(copy / "stabilab", "unreduced/sphere.py", KIND, KIND_ROW)
    added(copy / "stabilab", "answers/swing.py", QUESTION, QUESTION_ROW)
    after = told_by(copy)
    assert after["kinds"] == ["sphere", "orbit"] and after["because"] == "a sphere keeps its rates"
    assert after["swing"][0] == [0.0, 0.0, 0.0]
    # the README's own numbers of this satellite: greatest less least rate
    assert after["swing"][1] == pytest.approx([0.102485584364 - 0.0946418204942,
                                               0.0521865054855 + 0.0882677138107, 2 * 0.0806376591042],
                                              rel=1e-10)
    assert after["many"] == [[3], [[[v, v] for v in (0.1, 0.05, 0.02)]], [0.0]]
    assert after["satellite"] == before["satellite"], "the other kinds answer as before"


def test_a_new_effect_with_a_fate_is_one_file_and_one_row(tmp_path):
    """T' = -k |omega|^2 < 0 by hand: it comes to rest. The rates after 10 s: SciPy, from equations written here."""
    copied(tmp_path)
    added(tmp_path / "stabilab", "physics/effects/brake.py", EFFECT, EFFECT_ROW)
    told = told_by(tmp_path, BRAKED)
    assert (told["fate"], told["ending"]) == ("bounded", "rest") and "the brake takes energy away" in told["why"]
    run = solve_ivp(euler((12, 9, 5), damping=0.3), (0, 10), (0.1, 0.05, 0.02), "DOP853",
                    rtol=1e-12, atol=1e-14)
    assert told["omega"] == pytest.approx(run.y[:, -1].tolist(), rel=1e-9)
    assert "brake, not drawn" in told["legend"]


@pytest.mark.slow
def test_a_new_column_of_a_sweep_is_one_row_and_a_new_kind_of_picture_one_file_and_one_row(tmp_path):
    copied(tmp_path)
    added(tmp_path / "stabilab", "show/plot/energy.py", PICTURE, PICTURE_ROW)
    added(tmp_path / "stabilab", "show/plot/energy.py", PICTURE, COLUMN_ROW)
    told = told_by(tmp_path, SEEN, str(CASES / "minor-axis-100.toml"))
    assert told["swing"] and "energy" in told["kinds"] and told["drawn"] > 1000
    assert "energy, time" in told["help"]
