"""What a command loads: of the effects only those that its scene names, and of approximate laws nothing where
all are exact."""
import json
import subprocess
import sys
from pathlib import Path

import pytest

from stabilab.physics.effects import REGISTRY

ROOT = Path(__file__).parents[2]
BODY = "[body]\ninertia = {inertia}\nmass = 5\n"
MOTION = "[motion]\nangular_velocity = [0.1, 0.05, 0.02]\nspan = [0, 1]\n"
EFFECTS = {
    "gyrostat": "momentum = [0.8, 0, 0.1]", "constant_torque": "torque = [0, 0, 0.02]",
    "charge": "charge = 0.1\nfield = 1\narm = 1\nangle = 0.3",
    "resistance": "coefficient = 0.1", "liquid_cavity": "density = 1\nviscosity = 1\nradius = 0.1",
    "newtonian_field": "strength = 0.5",
    "gravity": "weight = 1\ncentre_of_mass = [0.1, 0, 0]", "body_force": "force = [1, 0, 0]",
    "viscous_damper": "inertia = 0.1\ncoefficient = 0.5",
    "damper_mass": "mass = 0.1\nplace = [0.2, 0, 0]\nline = [0, 0, 1]\nstiffness = 1\ncoefficient = 0.1",
    "damper_wheel": "inertia = 0.1\ncoefficient = 0.5\naxis = [0, 1, 1]", "rate_damper": "coefficient = 0.1",
    "eddy_currents": "coefficient = 0.1\nfield = 1", "wheel_motor": "torque = [0.01, 0, 0.02]"}
GAMMA = ("newtonian_field", "gravity", "eddy_currents")
PAIRS = (("gyrostat", "constant_torque"), ("charge", "constant_torque"), ("liquid_cavity", "resistance"))
ROUND, SLOW_START = "[12, 5, 5]", MOTION.replace("0.1, 0.05, 0.02", "1e-9, 2e-9, 3e-9")
# (effects, inertia, motion); equal moments turn a torque onto an axis, a slow motion runs in its own unit of
# time: other code
FEW = (((), "[12, 9, 5]", MOTION), (("charge",), "[12, 9, 5]", MOTION),
       (("constant_torque",), ROUND, SLOW_START))
MANY = (*(((name,), "[12, 9, 5]", MOTION) for name in EFFECTS),
        *((pair, "[12, 9, 5]", MOTION) for pair in PAIRS), *FEW,
        (("gyrostat", "constant_torque"), ROUND, MOTION), ((), ROUND, SLOW_START),
        (("gyrostat",), ROUND, SLOW_START),
        (("resistance",), ROUND, SLOW_START))
COMMANDS = ("show {case}", "classify {case}", "fate {case}", "extremes {case}", "period {case}",
            "simulate {case} --at 1")
OTHERS = ("classify {case} --certify --out c.json", "fate {case} --digits 12", "extremes {case} --digits 12",
          "simulate {case} --at 1 --digits 6",
          "compare {case}")
DRAWING = "plot {case} --out p.png", "precision {case} --quick", "surface {case} --out s"

# Runs each command line in turn in one process, with the package loaded anew for each, and prints what of it
# was loaded.
RUNNER = """
import contextlib, io, json, sys
import numpy, sympy
found = []
for line in json.loads(sys.argv[1]):
    for name in [n for n in sys.modules if n.split(".")[0] == "stabilab"]:
        del sys.modules[name]
    sys.argv = ["stabilab", *line]
    from stabilab import cli
    said = io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        try:
            cli.main()
        except SystemExit as left:
            code = left.code
    found.append([code, [n for n in sys.modules if n.split(".")[0] == "stabilab"], said.getvalue()[-300:]])
print(json.dumps(found))
"""


def written(folder, names, inertia, motion):
    path = folder / f"{'-'.join(names) or 'bare'}-{len(list(folder.iterdir()))}.toml"
    effects = "".join(f"[effects.{name}]\n{EFFECTS[name]}\n" for name in names)
    vertical = "vertical = [0, 0.6, 0.8]\n" if set(names) & set(GAMMA) else ""
    path.write_text(BODY.format(inertia=inertia) + effects + motion + vertical, encoding="utf-8")
    return path


def check(folder, commands, scenes):
    tried = [(names, command, written(folder, names, *more)) for command in commands for names,
             *more in scenes]
    lines = [command.format(case=path).split() for _, command, path in tried]
    run = subprocess.run([sys.executable, "-c", RUNNER, json.dumps(lines)], capture_output=True, text=True,
                         cwd=folder)
    assert run.returncode == 0, run.stderr
    for (names, command, path), (code, modules, said) in zip(tried, json.loads(run.stdout)):
        assert code in (0, 2, 3, 4, 5), (command, path.name, said)
        loaded = {name for name, (module, _) in REGISTRY.items()
                  if f"stabilab.physics.effects.{module}" in modules}
        assert loaded <= set(names), (command, path.name, loaded)
        if "liquid_cavity" not in names and "charge" not in names:
            assert "stabilab.physics.law_limits" not in modules, (command, path.name)


# Refuses every package but python-flint, and answers and certifies one state of each case.
ALONE = """
import json, sys
class Alone:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] not in {*sys.stdlib_module_names, "stabilab", "flint"}:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
sys.meta_path.insert(0, Alone())
import stabilab
from stabilab.answers.certificate import certificate
for path in sys.argv[1:]:
    case = stabilab.load(path)
    found = stabilab.motion(case.scene, case.exact_state, case.span)
    rest = stabilab.equilibria(case.scene)
    proved = certificate(case.scene, case.exact_state)
    print(case.name, found.fate.word, found.extremes is not None, rest.kind, proved["motion"]["fate"])
"""


def test_one_state_is_answered_and_certified_with_python_flint_alone():
    """On circles, hyperbolas, without a torque, and where a separatrix is near enough for many digits."""
    cases = [f"cases/{name}.toml" for name in ("minor-axis-100", "middle-axis-double-well",
                                               "torque-free-body", "uncertain-separatrix")]
    run = subprocess.run([sys.executable, "-c", ALONE, *cases], capture_output=True, text=True, cwd=ROOT)
    assert run.returncode == 0, run.stderr
    assert [line.split()[1:] for line in run.stdout.splitlines()] == [["bounded", "True", "curves",
                                                                       "bounded"]] * 4


@pytest.mark.slow
@pytest.mark.parametrize("command, scenes", [
    *((command, MANY[n % 4::4]) for n, command in enumerate((*COMMANDS, *OTHERS))),  # each scene by two or three
    *(pytest.param(command, MANY, marks=pytest.mark.long) for command in (*COMMANDS, *OTHERS, *DRAWING))])
def test_command_loads_only_the_effects_that_any_scene_names(tmp_path, command, scenes):
    check(tmp_path, (command,), scenes)


@pytest.mark.parametrize("question", ["fate", "extremes", "period"])
def test_one_state_under_a_reduction_loads_no_numpy(question):
    """Counted by modules: NumPy alone takes longer than the answer."""
    code = ("import sys; sys.argv = ['stabilab', *sys.argv[1:]]\nfrom stabilab import cli\n"
            "try: cli.main()\nexcept SystemExit: pass\nprint('LOADED', 'numpy' in sys.modules, file=sys.stderr)")
    run = subprocess.run([sys.executable, "-c", code, question, "cases/minor-axis-100.toml"], capture_output=True,
                         text=True, cwd=ROOT)
    assert "LOADED False" in run.stderr and "minor-axis-100" in run.stdout
