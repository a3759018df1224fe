"""The rooms of the package: imports point one way, and light commands stay light."""
import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "stabilab"
# A room imports from rooms of a lower floor, or from itself.
FLOOR = {"__init__": 0, "errors": 0, "asked": 1, "exact": 1, "interrupt": 1, "streams": 1, "packages": 1, "files": 2, "blocks": 1, "verify": 1, "body": 2, "quadratic": 2, "effects": 3, "scene": 4, "law_limits": 5, "scaling": 5,
         "case": 6, "equations": 6, "attitude": 7, "compiled": 7, "analysis": 8, "audit": 9, "show": 10, "cli": 11, "__main__": 12}
HEAVY = {"sympy", "scipy", "matplotlib", "pyvista", "vtk", "vtkmodules", "heyoka", "xarray", "pandas", "mpmath", "flint",
         "rich", "jinja2", "pydantic", "numba", "trame", "h5netcdf", "hypothesis", "pytest"}
# The one door of each package that draws or writes: no other room than show may open it.
DRAWING = {"matplotlib", "pyvista", "vtk", "vtkmodules", "trame", "jinja2", "xarray", "rich"}
MODULES = sorted(PACKAGE.rglob("*.py"))


def room(parts) -> str:
    """The room of a module path inside the package; case_lines and its like belong to case."""
    name = parts[0] if parts else "__init__"
    return "case" if name.startswith("case_") else name


def imports(path):
    """(line, module as a dotted name) of every import of a file, inside functions too, relative ones made absolute."""
    package = ["stabilab", *path.relative_to(PACKAGE).parent.parts]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name, node.col_offset) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[:len(package) + 1 - node.level] if node.level else []
            stem = base + (node.module.split(".") if node.module else [])
            for alias in node.names:
                whole = stem + [alias.name]
                inside = stem[0] == "stabilab" and len(stem) == 1 and alias.name != "__version__"
                yield node.lineno, ".".join(whole if inside else stem), node.col_offset


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_imports_point_one_way(path):
    relative = path.relative_to(PACKAGE)
    own = room(relative.with_suffix("").parts)
    for line, name, _ in imports(path):
        parts = name.split(".")
        if parts[0] == "stabilab":
            other = room(parts[1:])
            assert other in FLOOR, f"{relative}:{line}: {other} has no floor in this test"
            assert other == own or FLOOR[other] < FLOOR[own], f"{relative}:{line}: {own} imports {name}"


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_nothing_rests_on_an_assert(path):
    # `python -O` leaves asserts out: a step of a proof would be gone
    found = [node.lineno for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(node, ast.Assert)]
    assert not found


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_heavy_packages_are_imported_inside_functions_only(path):
    at_top = [(line, name) for line, name, column in imports(path) if column == 0 and name.split(".")[0] in HEAVY]
    assert not at_top


@pytest.mark.parametrize("path", MODULES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_only_show_draws_and_writes_files_of_pictures(path):
    if path.relative_to(PACKAGE).parts[0] != "show":
        assert not [(line, name) for line, name, _ in imports(path) if name.split(".")[0] in DRAWING]


def test_import_walk_sees_a_wrong_import(tmp_path):
    # The walk itself: a relative import inside a function of an analysis module.
    path = PACKAGE / "analysis" / "results.py"
    source = "def f():\n    from ..show.plane import plot\n    from .. import cli\n"
    found = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.ImportFrom):
            found.append(node.level)
    assert found == [2, 2]
    real, Path.read_text = Path.read_text, lambda self, **_: source
    try:
        assert [name for _, name, _ in imports(path)] == ["stabilab.show.plane", "stabilab.cli"]
    finally:
        Path.read_text = real


def loaded_by(*arguments) -> set[str]:
    """Top-level packages in sys.modules after a command ran to its end, in a fresh interpreter."""
    code = ("import sys, atexit\nsys.argv = ['stabilab'] + sys.argv[1:]\n"
            "atexit.register(lambda: print('LOADED', *sorted({m.split('.')[0] for m in sys.modules}), file=sys.stderr))\n"
            "from stabilab.__main__ import main\nmain()\n")
    plain = {name: value for name, value in os.environ.items() if not name.startswith("COVERAGE")}  # which loads modules of its own
    run = subprocess.run([sys.executable, "-c", code, *map(str, arguments)], capture_output=True, text=True, cwd=ROOT, env=plain)
    assert run.returncode == 0, run.stderr
    return set(next(line for line in run.stderr.splitlines() if line.startswith("LOADED")).split()[1:])


def test_help_loads_neither_numpy_nor_anything_heavy():
    assert not loaded_by("--help") & (HEAVY | {"numpy", "tomllib", "fractions"})


@pytest.mark.parametrize("name", ["minor-axis-100", "middle-axis-300", "wheel-and-thruster", "thruster-negative-minor-axis",
                                  "thruster-stuck-major-axis", "torque-free-gyrostat", "symmetric-body"])
@pytest.mark.parametrize("command", ["classify", "extremes"])
def test_one_state_under_a_constant_torque_loads_neither_numpy_nor_anything_heavy(command, name):
    loaded = loaded_by(command, f"cases/{name}.toml", "--json")
    assert not loaded & (HEAVY | {"numpy"})
    assert {"stabilab", "fractions", "json"} <= loaded  # the probe sees what is loaded


def test_one_state_that_doubles_cannot_settle_loads_the_library_for_many_digits_alone():
    loaded = loaded_by("classify", "cases/middle-axis-double-well.toml")
    assert "flint" in loaded and not loaded & (HEAVY - {"flint"} | {"numpy"})


@pytest.mark.parametrize("arguments, needed", [
    (("show", "cases/minor-axis-100.toml"), {"sympy", "mpmath"}),  # sympy brings mpmath, and both look for gmpy2 and flint
    (("simulate", "cases/minor-axis-100.toml", "--at", "0,1"), {"heyoka", "sympy", "mpmath", "flint"}),
    (("doctor",), set())])
def test_a_command_loads_no_heavy_package_that_it_does_not_use(arguments, needed):
    allowed = needed | ({"flint"} if "sympy" in needed else set())
    assert not loaded_by(*arguments) & HEAVY - allowed


def test_loading_a_case_needs_no_numpy():
    code = "import sys, stabilab; stabilab.load(sys.argv[1]); sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code, "cases/minor-axis-100.toml"], cwd=ROOT).returncode == 0


def test_an_effect_that_no_case_names_is_not_imported():
    code = ("import sys, stabilab; stabilab.load(sys.argv[1]);"
            "print(sorted(m for m in sys.modules if m.startswith('stabilab.physics.effects.')))")
    run = subprocess.run([sys.executable, "-c", code, "cases/off-axis-two.toml"], cwd=ROOT, capture_output=True, text=True)
    assert "stabilab.physics.effects.constant_torque" in run.stdout
    # scaling needs the torque's class alone; the gyrostat is not named by this case
    assert "stabilab.physics.effects.gyrostat" not in run.stdout
