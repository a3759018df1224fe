"""The structure of the package: which room imports which, no circles, no private names, light commands stay
light."""
from __future__ import annotations

import ast
import inspect
import os
import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import stabilab
from stabilab import cli
from stabilab.orbit.result import OUTCOMES
from tests.house import geometry, rooms
from tests.house.rooms import (
    GROUND,
    MAY,
    PACKAGE,
    PAGE,
    ROOT,
    all_imports,
    circles,
    modules,
    room,
    statements,
    tree_of,
)

HEAVY = {"sympy", "scipy", "matplotlib", "pyvista", "vtk", "vtkmodules", "heyoka", "xarray", "pandas",
         "mpmath", "flint",
         "rich", "jinja2", "pydantic", "numba", "dask", "distributed", "trame", "h5netcdf", "hypothesis",
         "pytest"}
# What draws or writes: no other room than show and papers may open it.
DRAWING = {"matplotlib", "pyvista", "vtk", "vtkmodules", "trame", "jinja2", "xarray", "rich"}
MODULES = sorted(PACKAGE.rglob("*.py"))
FLINT_AT_HEAD = ("equilibrium/", "maps/bifurcation/", "verify/", "numbers/algebraic.py")
FILES_IN_A_FOLDER = 24  # a list that fits the eye, `__init__` counted
ON_TOP = ("cli", "__main__", "stabilab", "study")  # of all rooms: these load a question when it is asked
IMPORTS_INSIDE = 36  # of 237 once
SIGNS = 25  # tests of the sign of p q, of 139 once
# Imports inside functions: (importing module, imported module) -> why it waits
DOORS = {
    ("stabilab.case.motion", "stabilab.case.observed"): "loaded where a start is stated as it is observed",
    ("stabilab.physics.effects.wheel_motor",
     "stabilab.physics.effects.gyrostat"): "an effect is loaded where a scene names it, or a motor stops",
    ("stabilab.answers.attitude", "stabilab.answers.turning.followed"): "loads numpy",
    ("stabilab.commands.common", "stabilab.maps.percentiles"): "loads numpy, where draws are asked for",
    ("stabilab.answers.motion", "stabilab.answers.at_equilibrium"): "loaded for states of equilibrium alone",
    ("stabilab.answers.at_equilibrium", "stabilab.physics.to_numpy"): "loads numpy",
    ("stabilab.answers.motion", "stabilab.answers.dissipation.ending"): "loads numpy",
    ("stabilab.answers.motions.one", "stabilab.answers.motions.starts"): "loads numpy",
    ("stabilab.answers.motions.of_case", "stabilab.answers.simulate"): "loaded for approximate laws alone",
    ("stabilab.answers.motions.of_case", "stabilab.answers.when"): "loaded for limits and tilts alone",
    ("stabilab.answers.motions.of_case",
     "stabilab.integrate.limits_along"): "loaded for approximate laws alone",
    ("stabilab.answers.certificate", "stabilab.answers.certified_motion"): "loads numpy",
    ("stabilab.commands.classify", "stabilab.commands.certificates"): "loaded for --certify alone",
    ("stabilab.commands.runner",
     "stabilab.answers.uncertain.fate"): "loaded for uncertain numbers alone",
    ("stabilab.commands.common", "stabilab.answers.when"): "loads numpy",
    ("stabilab.commands.pictures", "stabilab.show.explore.serve"): "loads what serves or writes a page",
    ("stabilab.commands.classify", "stabilab.answers.digits"): "loads numpy",
    ("stabilab.commands.doctor", "stabilab.answers.motions.compiling"): "loads numpy and numba",
    ("stabilab.commands.classify", "stabilab.answers.motions.angles"): "loads numpy",
    ("stabilab.commands.stuck", "stabilab.show.plot.over_time"): "loads all kinds of plots",
    ("stabilab.equilibrium.liquid", "stabilab.numbers.krawczyk"): "loads numpy",
    ("stabilab.integrate.events", "stabilab.integrate.trajectory"): "loaded for effects that stop alone",
    ("stabilab.physics.coefficients", "stabilab.physics.law_limits"): "loaded for approximate laws alone",
    ("stabilab.physics.coefficients", "stabilab.physics.states"): "loads numpy",
    ("stabilab.show.explore.pictures", "stabilab.show.plot.long"): "loads numpy",
    ("stabilab.show.explore.pictures", "stabilab.show.plot.turning"): "loads numpy",
    ("stabilab.show.explore.session", "stabilab.answers.when"): "loads numpy",
    ("stabilab.show.space.reach", "stabilab.orbit.separatrix.branches"): "loads numpy",
    ("stabilab.unreduced.bounds", "stabilab.unreduced.evidence"): "loads numpy",
}


def test_rooms_import_only_what_they_may():
    wrong = [f"{one.source}:{one.line} imports {one.target}" for one in all_imports()
             if not _allowed(room(one.source), room(one.target))]
    assert not wrong


def _allowed(source: str, target: str) -> bool:
    if source == target or target == "stabilab":  # the package's own name holds its version
        return True
    if source in GROUND:
        return target in GROUND
    if source not in MAY:  # cli, __main__ and the public table stand above all rooms
        return True
    may = MAY[source]
    return may is not None and (target in GROUND or target in may.split())


def test_no_circle_of_files():
    assert circles((one.source, one.target) for one in all_imports()) == []


def test_a_circle_is_found():
    assert circles([("a", "b"), ("b", "c"), ("c", "a"), ("c", "d")]) == [["a", "b", "c"]]


def test_imports_inside_functions_are_doors():
    inside = {(one.source, one.target) for one in all_imports() if one.inside
              and room(one.source) not in ON_TOP}
    assert inside - set(DOORS) == set()
    assert set(DOORS) - inside == set(), "a door that nobody uses any more"


def named_imports(tree) -> list[int]:
    """The lines that import a module by a name written there, or in a constant of the same file: an arrow that
    no walk over imports sees."""
    constants = {target.id for node in tree.body if isinstance(node, ast.Assign)
                 and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
                 for target in node.targets if isinstance(target, ast.Name)}
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call) and node.args
             and getattr(node.func, "id", getattr(node.func, "attr", "")) in ("import_module", "__import__")]
    return [node.lineno for node in calls if isinstance(node.args[0], ast.Constant)
            or isinstance(node.args[0], ast.Name) and node.args[0].id in constants]


def test_no_module_is_imported_by_a_name_in_a_string():
    assert not [f"{path}:{line}" for path in MODULES for line in named_imports(tree_of(path))]


def test_a_name_in_a_string_is_found():
    text = ("A = 'stabilab.show'\nimport_module(A)\nimportlib.import_module('stabilab.x')\n"
            "import_module(f'..{kind}', __package__)\nimport_module(module)\n")
    assert named_imports(ast.parse(text)) == [2, 3]


def test_imports_inside_functions_are_few():
    inside = {(one.source, one.line) for one in all_imports() if one.inside
              and room(one.source) not in ("study", "stabilab")}
    assert len(inside) <= IMPORTS_INSIDE


@pytest.mark.parametrize("command", cli.whole().registered_commands, ids=lambda one: one.callback.__name__)
def test_a_command_names_a_function_that_takes_its_options(command):
    """By their names, but for `si`, which stands for units."""
    place, fixed = command.callback.opens
    file, name = place.split(".")
    function = getattr(import_module(f"stabilab.commands.{file}"), name)
    options = dict.fromkeys(inspect.signature(command.callback).parameters)
    options.pop("si", None)
    bound = inspect.signature(function).bind(**options, **fixed).arguments
    assert set(bound.get("limits", ())) <= {"rate", "component", "energy", "tilt", "below", "nutation", "nutation_below", "until"}


def test_no_private_name_crosses_a_module():
    crossing = [f"{one.source}:{one.line} {one.target}.{one.name}" for one in all_imports() if one.name
                and re.match(r"_(?!_)", one.name)]
    assert not crossing


def test_type_checkers_see_the_public_names_where_they_are_loaded_from():
    table = ast.parse((PACKAGE / "__init__.py").read_text(encoding="utf-8"))
    (block,) = (node for node in table.body if rooms.for_types(node))
    seen = {alias.asname: node.module for node in block.body for alias in node.names}
    assert seen == stabilab._HOME


def test_no_module_of_the_package_bears_a_public_name():
    assert not {name.split(".")[1] for name in modules() if name.count(".") == 1} & set(stabilab.__all__)


@pytest.mark.parametrize("folder", sorted({path.parent for path in MODULES}),
                         ids=lambda p: str(p.relative_to(ROOT)))
def test_a_folder_holds_a_list_that_fits_the_eye(folder):
    assert len(list(folder.glob("*.py"))) <= FILES_IN_A_FOLDER


def test_no_file_stands_beside_a_folder_of_its_name():
    """Python would import the folder, and nobody would read the file."""
    assert not [path for path in PACKAGE.rglob("*.py") if path.with_suffix("").is_dir()]


def test_the_words_of_an_outcome_stand_in_one_table():
    """`orbit.result.OUTCOMES`, which every view reads; the short words, which name other things too, left out."""
    phrases = {text for one in OUTCOMES.values() for text in map(str, one) if " " in text}
    heads = tuple(one.head for one in OUTCOMES.values() if " " in one.head)
    found = {(str(path.relative_to(PACKAGE)), node.value) for path in MODULES for node in ast.walk(tree_of(path))
             if isinstance(node, ast.Constant) and isinstance(node.value, str)
             and (node.value in phrases or node.value.startswith(heads))}
    assert {place for place, _ in found} == {"orbit/result.py"}, found
    assert len(phrases) >= 14


def test_few_places_ask_for_the_sign_of_the_geometry():
    """Circle, hyperbola and parabola are classes in `orbit`; a wing opens one table of them."""
    found = geometry.places()
    assert len(found) <= SIGNS, found
    assert all(place.startswith("orbit/") for place in found)


def test_a_test_of_the_sign_is_found():
    asked = (
        "if r.e < 0: pass\nx = 1 if not land.e else 2\ntable[land.e]\nif e == 0: pass\nif e > most: pass\ny "
        "= r.e * 2\n")
    assert sorted(geometry.asks(ast.parse(asked))) == [1, 2, 3, 4]


def test_the_drawing_of_the_rooms_is_that_of_the_imports():
    """`python -m tests.house.rooms` makes it anew."""
    assert rooms.drawing() in PAGE.read_text(encoding="utf-8")


def imports(path):
    """(line, module as a dotted name) of every import of a file, inside functions too, relative ones made
    absolute; but for those that type checkers alone read, which load nothing."""
    package = ["stabilab", *path.relative_to(PACKAGE).parent.parts]
    for node, _ in statements(tree_of(path), left_out=rooms.for_types):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name, node.col_offset) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[:len(package) + 1 - node.level] if node.level else []
            stem = base + (node.module.split(".") if node.module else [])
            for alias in node.names:
                whole = stem + [alias.name]
                inside = stem[0] == "stabilab" and len(stem) == 1 and alias.name != "__version__"
                yield node.lineno, ".".join(whole if inside else stem), node.col_offset


def test_nothing_rests_on_an_assert():
    # `python -O` leaves asserts out: a step of a proof would be gone
    assert not [f"{path}:{node.lineno}" for path in MODULES for node,
                _ in statements(tree_of(path)) if isinstance(node, ast.Assert)]


def test_heavy_packages_are_imported_inside_functions_only():
    """But for python-flint where every function computes with it; what a command loads is counted below."""
    heavy = {(str(path.relative_to(PACKAGE)), name) for path in MODULES for _, whole, column in imports(path)
             if column == 0 and (name := whole.split(".")[0]) in HEAVY}
    assert not {(path, name) for path, name in heavy if name != "flint" or not path.startswith(FLINT_AT_HEAD)}


def test_only_show_and_papers_draw_and_write_files_of_pictures():
    assert not [f"{path}:{line} {name}" for path in MODULES
                if path.relative_to(PACKAGE).parts[0] not in ("show", "papers")
                for line, name, _ in imports(path) if name.split(".")[0] in DRAWING]


def loaded_by(*arguments) -> set[str]:
    """Top-level packages in sys.modules after a command ran to its end, in a fresh interpreter."""
    code = ("import sys, atexit\nsys.argv = ['stabilab'] + sys.argv[1:]\n"
            "atexit.register(lambda: print('LOADED', *sorted({m.split('.')[0] for m in sys.modules}), "
            "file=sys.stderr))\n"
            "from stabilab.__main__ import main\nmain()\n")
    # which loads modules of its own
    plain = {name: value for name, value in os.environ.items() if not name.startswith("COVERAGE")}
    run = subprocess.run([sys.executable, "-c", code, *map(str, arguments)], capture_output=True, text=True,
                         cwd=ROOT, env=plain)
    assert run.returncode == 0, run.stderr
    return set(next(line for line in run.stderr.splitlines() if line.startswith("LOADED")).split()[1:])


def test_help_loads_neither_numpy_nor_anything_heavy():
    assert not loaded_by("--help") & (HEAVY | {"numpy", "tomllib", "fractions"})


@pytest.mark.parametrize("command", ["classify", "extremes"])
def test_one_state_under_a_constant_torque_loads_neither_numpy_nor_anything_heavy(command):
    names = ("minor-axis-100", "middle-axis-300", "wheel-and-thruster", "thruster-negative-minor-axis",
             "thruster-stuck-major-axis",
             # of one process: what any of them loads stays loaded
             "torque-free-gyrostat", "symmetric-body", "charged-body")
    loaded = loaded_by(command, *(f"cases/{name}.toml" for name in names), "--json")
    assert not loaded & (HEAVY | {"numpy"}) - {"flint"}  # balls are python-flint's
    assert {"stabilab", "fractions", "json", "flint"} <= loaded  # the probe sees what is loaded


def test_one_state_reads_no_more_than_its_answer_needs():
    """A first answer of a light command takes at most half a second of processor time; some fifth of a
    millisecond is a module's, and modules can be counted where time cannot. What a question does not need is
    not loaded: these two take
    142 and 148."""
    code = ("import sys, atexit\nsys.argv = ['stabilab', 'classify', sys.argv[1]]\n"
            "atexit.register(lambda: print('LOADED', sum(m.split('.')[0] == 'stabilab' for m in "
            "sys.modules), file=sys.stderr))\n"
            "from stabilab.__main__ import main\nmain()\n")
    for name, most in (("minor-axis-100", 160), ("charged-body", 165)):
        run = subprocess.run([sys.executable, "-c", code, f"cases/{name}.toml"], capture_output=True,
                             text=True, cwd=ROOT)
        assert int(run.stderr.split("LOADED ")[1]) <= most, name


def test_a_sweep_loads_few_modules_before_its_first_point():
    """No other map, no picture, and no answer that is not asked for: a quarter of the package, counted in lines, so that
    parting a module by subject counts for nothing. The time that it takes to begin is a third of a second of
    processor time, most of it theirs and NumPy's."""
    code = ("import sys\nfrom stabilab.maps import run\nanswer = run.answered\n"
            "def first(*given):\n"
            "    loaded = {m: sys.modules[m].__file__ for m in sys.modules if m.split('.')[0] == 'stabilab'}\n"
            "    print('LOADED', *(f'{m}={file}' for m, file in loaded.items()), file=sys.stderr)\n"
            "    return answer(*given)\n"
            "run.answered = first\nsys.argv = ['stabilab', *sys.argv[1:]]\n"
            "from stabilab.__main__ import main\nmain()\n")
    asked = ["sweep", "cases/minor-axis-100.toml", "--vary", "x[1]=0:1:2"]
    run = subprocess.run([sys.executable, "-c", code, *asked], capture_output=True, text=True, cwd=ROOT)
    line = next(line for line in run.stderr.splitlines() if line.startswith("LOADED"))
    loaded = dict(entry.split("=", 1) for entry in line.split()[1:])
    lines = sum(len(Path(file).read_text(encoding="utf-8").splitlines()) for file in loaded.values())
    assert lines <= 25000 and {"stabilab.maps.parts", "stabilab.show.maps.sweep"} <= set(loaded)
    assert not {"stabilab.answers.chaos", "stabilab.answers.time_to", "stabilab.answers.equilibria",
                "stabilab.show.plot"} & set(loaded)


@pytest.mark.one_in(2)
@pytest.mark.parametrize("arguments, needed", [
    # sympy brings mpmath, and both look for gmpy2 and flint
    (("show", "cases/minor-axis-100.toml"), {"sympy", "mpmath"}),
    (("simulate", "cases/minor-axis-100.toml", "--at", "0,1"), {"heyoka", "sympy", "mpmath", "flint"}),
    (("doctor",), set())])
def test_a_command_loads_no_heavy_package_that_it_does_not_use(arguments, needed):
    allowed = needed | ({"flint"} if "sympy" in needed else set())
    assert not loaded_by(*arguments) & HEAVY - allowed
