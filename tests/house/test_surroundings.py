"""Broken surroundings: full disks, folders that cannot be written, runs that are killed, two runs at once.

What was written before stays as it was, no half file bears its final name, and a run after it completes.
"""
import io
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from stabilab import files, streams
from stabilab.errors import BAD_INPUT, INTERRUPTED, InputError
from stabilab.show import manifest

ROOT = Path(__file__).parents[2]
MINOR, CHARGED = (ROOT / "cases" / f"{name}.toml" for name in ("minor-axis-100", "charged-body"))
posix = pytest.mark.skipif(os.name != "posix", reason="limits, locks and signals of POSIX")
pytestmark = posix

# Every way to write a file: arguments, and the option that says where
WRITERS = {
    "simulate csv": (("simulate", MINOR), "--out", "run.csv"),
    "simulate nc": (("simulate", MINOR), "--out", "run.nc"),
    "compare": (("compare", CHARGED), "--out", "errors.csv"),
    "precision csv": (("precision", MINOR, "--quick", "--until", "1"), "--out", "points.csv"),
    "precision png": (("precision", MINOR, "--quick", "--until", "1"), "--out", "points.png"),
    "plot": (("plot", MINOR), "--out", "plane.png"), "tables": (("tables",), "--out", "tables"),
    "sweep": (("sweep", MINOR, "--vary", "x[1]=0:4:500"), "--out", "map.nc"),
    "atlas": (("atlas", ROOT / "cases" / "off-axis-two.toml", "--level", "1", "--refine", "0"), "--out",
              "sky.nc"),
    "figures": (("figures", "9"), "--out", "figures"), "surface": (("surface", MINOR), "--out", "surface"),
}
ONE_FILE = {name for name, (_, _, target) in WRITERS.items() if "." in target}


def command(name, folder):
    arguments, option, target = WRITERS[name]
    return [sys.executable, "-m", "stabilab", *map(str, arguments), option, str(Path(folder) / target)]


def environment(folder):
    """What libraries keep goes to a folder of the test's own."""
    return os.environ | {"XDG_CACHE_HOME": str(Path(folder) / "cache"), "PYTHONPATH": str(ROOT)}


# For a child with a limit of size: its bytecode would be cut off too, and end every later import of the module
NO_BYTECODE = {"PYTHONDONTWRITEBYTECODE": "1"}


def written(folder):
    """Path from `folder` -> bytes of everything in it but the cache."""
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in Path(folder).rglob("*")
            if p.is_file() and "cache" not in p.relative_to(folder).parts}


def limited(size):
    """For a child: no file may grow beyond `size` bytes, which fails as a full disk does, in the middle of a
    write."""
    def limit():
        import resource
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
    return limit


@pytest.mark.slow
@pytest.mark.parametrize("name", [pytest.param(name, marks=[pytest.mark.long] * (name == "precision png")) for name in WRITERS])
def test_a_disk_that_fills_up_ends_with_2_and_leaves_what_was_there(tmp_path, name):
    target = tmp_path / WRITERS[name][2]
    if name in ONE_FILE:
        target.write_text("of yesterday")
    else:
        target.mkdir()
        (target / manifest.NAME).write_text("of yesterday")
    before = written(tmp_path)
    run = subprocess.run(command(name, tmp_path), capture_output=True, text=True, cwd=tmp_path,
                         preexec_fn=limited(200),
                         env=environment(tmp_path) | NO_BYTECODE)
    assert run.returncode == BAD_INPUT, run.stderr
    assert "cannot be written" in run.stderr and WRITERS[name][
        2] in run.stderr and "Traceback" not in run.stderr
    assert written(tmp_path) == before


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name",
                         ["simulate csv", "tables",
                          *(pytest.param(n, marks=pytest.mark.slow)
                            for n in ("simulate nc", "plot", "figures"))])
def test_a_target_below_a_file_or_in_a_special_folder_ends_with_2(tmp_path, name):
    (tmp_path / "file").write_text("x")
    for folder in (tmp_path / "file", Path("/proc/self/fd")):
        run = subprocess.run(command(name, folder), capture_output=True, text=True, cwd=tmp_path,
                             env=environment(tmp_path))
        assert run.returncode == BAD_INPUT and "cannot be written" in run.stderr, run.stderr
        assert "Traceback" not in run.stderr, run.stderr
    assert written(tmp_path) == {"file": b"x"}


# -- standard streams

# Every way that stdout is written to: through the program's own words, and through those of the command
# line's library; and every command.
ANSWERED = {"csv": ("extremes", MINOR, "--csv"), "help": ("--help",), "version": ("--version",)}
SLOWER = {"classify": ("classify", MINOR), "json": ("classify", MINOR, "--json"),
          "help of a command": ("simulate", "--help"),
          "simulate": ("simulate", MINOR, "--at", "0,1"), "show": ("show", MINOR), "fate": ("fate", MINOR),
          "period": ("period", MINOR), "doctor": ("doctor",), "example": ("example",), "compare": ("compare", CHARGED),
          "precision": ("precision", MINOR, "--quick", "--until", "1"),
          "surface": ("surface", MINOR, "--out", "s"),
          "plot": ("plot", MINOR), "tables": ("tables", "--out", "t"),
          "figures": ("figures", "9", "--out", "f")}
# those that write in a way of their own; the others, which share it, are long
OWN_WAY = ("classify", "json", "simulate", "doctor", "plot", "tables")
EVERY = [*ANSWERED,
         *(pytest.param(name, marks=[pytest.mark.slow, *[pytest.mark.long] * (name not in OWN_WAY)])
           for name in SLOWER)]


def in_shell(name, redirected, folder):
    """(exit code, stdout, stderr) of a command under a redirection of the shell."""
    words = " ".join(map(str, (ANSWERED | SLOWER)[name]))
    run = subprocess.run(["sh", "-c", f"exec {sys.executable} -m stabilab {words} {redirected}"],
                         capture_output=True, text=True,
                         cwd=folder, env=environment(folder))
    return run.returncode, run.stdout, run.stderr


@pytest.mark.one_in(2)
@pytest.mark.parametrize("name", EVERY)
@pytest.mark.parametrize("redirected, words",
                         [(">&-", "it is closed"), (">/dev/full", "No space left on device")],
                         ids=["closed", "full"])
def test_an_answer_that_cannot_be_written_ends_with_2_and_says_so(tmp_path, name, redirected, words):
    assert in_shell(name, redirected, tmp_path) == (BAD_INPUT, "", f"stdout: cannot be written: {words}\n")


@pytest.mark.parametrize("name", EVERY)
def test_an_answer_without_a_reader_ends_quietly_with_141(tmp_path, name):
    read, write = os.pipe()
    os.close(read)
    run = subprocess.run([sys.executable, "-m", "stabilab", *map(str, (ANSWERED | SLOWER)[name])],
                         stdout=write, stderr=subprocess.PIPE,
                         cwd=tmp_path, env=environment(tmp_path))
    os.close(write)
    assert (run.returncode, run.stderr) == (141, b"")


@pytest.mark.one_in(2)
@pytest.mark.parametrize("redirected", ["2>&-", "2>/dev/full", "<&- 2>&-"],
                         ids=["closed", "full", "closed with stdin"])
def test_messages_that_nobody_can_read_change_no_answer(tmp_path, redirected):
    assert in_shell("csv", redirected, tmp_path) == in_shell("csv", "", tmp_path)
    ANSWERED["nothing"] = ("classify", "nowhere.toml")
    try:
        # and no message goes to stdout instead
        assert in_shell("nothing", redirected, tmp_path) == (BAD_INPUT, "", "")
    finally:
        del ANSWERED["nothing"]


def test_what_is_printed_to_a_closed_stdout_goes_into_no_file(tmp_path):
    """The first file to be opened would get the number of a stream that is closed."""
    code = ("import os\nfrom stabilab import streams\nstreams.occupy()\nwith open('data.csv', 'w') as data:\n"
            "    os.write(1, b'a library speaks')\n    os.write(2, b'and warns')\n    data.write('1,2')\n")
    assert subprocess.run(["sh", "-c", f'exec {sys.executable} -c "$0" <&- >&- 2>&-', code], cwd=tmp_path,
                          env=environment(tmp_path)).returncode == 0
    assert (tmp_path / "data.csv").read_text() == "1,2"


class Screen(io.StringIO):
    """What is written to a terminal."""

    def isatty(self):
        return True


@pytest.mark.parametrize("stream, during",
                         [(io.StringIO(), "stabilab: working ...\n"), (Screen(), "stabilab: working ...")])
def test_a_silence_ends_in_one_line_which_a_terminal_loses_with_what_comes_next(stream, during):
    sign = streams.Sign(stream)
    sign.wait(0)
    assert stream.getvalue() == during
    for _ in range(2):
        sign.end()
    assert stream.getvalue() == during + ("\r\x1b[K" if stream.isatty() else "")


def test_what_is_written_first_leaves_no_sign_of_a_silence(monkeypatch):
    monkeypatch.setattr(sys, "stderr", stream := Screen())
    with streams.guarded(3600):  # whose thread ends with the first word, not in an hour
        print("an answer", file=sys.stderr)
    assert stream.getvalue() == "an answer\n"


@pytest.mark.parametrize("quiet, words", [("", "stabilab: working ...\n"), ("1", "")])
def test_a_command_says_on_stderr_that_it_works(tmp_path, quiet, words):
    code = "from stabilab import __main__, streams\nstreams.SILENCE = 0\n__main__.main()"
    run = subprocess.run([sys.executable, "-c", code, "show", MINOR], capture_output=True, text=True,
                         cwd=tmp_path,
                         env=environment(tmp_path) | {"STABILAB_QUIET": quiet})
    assert run.returncode == 0 and run.stderr == words and run.stdout.startswith("minor-axis-100: ")


# -- packages that are not there

# module -> package to install, exit code, a command that needs it; with a dot, another door of the same
# package
LACKING = {"matplotlib": ("matplotlib", 4, ("plot", MINOR)), "PIL": ("pillow", 4, ("plot", MINOR)),
           "matplotlib.": ("matplotlib", 4, ("figures", "9")),
           "matplotlib..": ("matplotlib", 4, ("precision", MINOR, "--out", "p.svg")),
           "pyvista": ("pyvista", 4, ("surface", MINOR, "--out", "s")),
           "vtkmodules": ("vtk", 4, ("surface", MINOR, "--out", "s")),
           "numpy": ("numpy", 2, ("simulate", MINOR, "--at", "0,1")), "sympy": ("sympy", 2, ("show", MINOR)),
           "mpmath": ("mpmath", 2, ("show", MINOR)),  # SymPy says in its own words that it is missing
           "scipy": ("scipy", 2, ("simulate", MINOR, "--at", "0,1", "--method", "RK45")),
           "scipy.": ("scipy", 2, ("simulate", MINOR, "--out", "r.nc")),
           "flint": ("python-flint", 2, ("period", MINOR, "--digits", "30")),
           "xarray": ("xarray", 2, ("simulate", MINOR, "--out", "r.nc")),
           "jinja2": ("jinja2", 2, ("report", MINOR)), "typer": ("typer", 2, ("--help",))}


def without(module, folder, *arguments):
    """The command where a module and all below it cannot be imported, in its child processes too."""
    site = Path(folder) / "site"
    site.mkdir(exist_ok=True)
    (site / "sitecustomize.py").write_text(f"import sys\nsys.modules[{module!r}] = None\n")
    around = environment(folder)
    around["PYTHONPATH"] = os.pathsep.join([str(site), around["PYTHONPATH"]])
    return subprocess.run([sys.executable, "-m", "stabilab", *map(str, arguments)], capture_output=True,
                          text=True, cwd=folder, env=around)


@pytest.mark.one_in(4)
@pytest.mark.parametrize("module",
                         [pytest.param(name, marks=pytest.mark.slow) if name.endswith(".") else name
                          for name in LACKING])
def test_a_package_that_is_missing_is_named_with_what_to_install(tmp_path, module):
    package, code, arguments = LACKING[module]
    run = without(module.rstrip("."), tmp_path, *arguments)
    assert run.returncode == code and len(
        run.stderr.splitlines()) == 1 and "Traceback" not in run.stderr, run.stderr
    assert f"{package} is not installed" in run.stderr and f"pip install {package}" in run.stderr
    assert "fault of the program" not in run.stderr
    assert not [name for name in written(tmp_path) if name.endswith((".png", ".svg", ".nc", ".html"))]


@pytest.mark.parametrize("module, kinds",
                         [("pyvista", {"vtp", "glb", "stl", "json"}),
                          pytest.param("vtkmodules", {"glb", "stl", "json"}, marks=pytest.mark.slow)])
def test_without_a_package_that_draws_the_meshes_are_written_all_the_same(tmp_path, module, kinds):
    assert without(module, tmp_path, "surface", MINOR, "--out", "s").returncode == 4
    assert {p.name for p in (tmp_path / "s").iterdir()} == {f"{MINOR.stem}.{kind}"
                                                            for kind in kinds} | {manifest.NAME}


@pytest.mark.one_in(2)
@pytest.mark.parametrize("module", ["heyoka", "numba"])
def test_a_package_that_only_makes_it_faster_may_be_missing(tmp_path, module):
    run = without(module, tmp_path, "simulate", MINOR, "--at", "0,1")
    assert run.returncode == 0 and run.stderr == ""


def test_a_package_that_cannot_be_loaded_is_no_fault_of_the_program():
    """Its library of the system is missing, or it is of another version; a name that stabilab itself lacks is
    a fault."""
    from stabilab.packages import explained
    for error, code, words in ((ImportError("libGL.so.1: cannot open shared object file",
                                            name="vtkmodules.vtkRenderingOpenGL2"), 4, "libGL.so.1"),
                               (ImportError("cannot import name 'trapezoid' from 'numpy'", name="numpy"), 2,
                                "numpy cannot be loaded"),
                               (ImportError("numpy: broken"), 2,
                                "a package cannot be loaded (numpy: broken)")):
        assert explained(error).exit_code == code and words in str(explained(error))
    assert explained(ImportError("cannot import name 'x' from 'stabilab.case.read'",
                                 name="stabilab.case.read")) is None
    assert explained(ModuleNotFoundError("No module named 'json.nothing'", name="json.nothing")) is None


# -- versions


def test_every_package_states_a_lowest_version_and_the_pinned_one_is_not_below_it():
    """`make floors` runs tests on the lowest ones, `make test` on the pinned ones."""
    from tests.house.floors import floors
    number = lambda text: [int(part) for part in text.split(".")]
    plain = lambda name: name.lower().replace("_", "-")
    pinned = dict(line.split("==") for line in (ROOT / "constraints.txt").read_text().splitlines())
    pinned = {plain(name): version for name, version in pinned.items()}
    lowest = floors()
    assert {"numpy", "python-flint", "typer", "pyvista", "heyoka", "pytest"} <= set(lowest)
    for name, version in lowest.items():
        assert number(pinned[plain(name)]) >= number(version), name


def test_every_package_of_an_extra_is_named_with_its_extra():
    from stabilab.packages import EXTRAS, cure
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"][
        "optional-dependencies"]
    brought = {re.match(r"[\w-]+", line)[0]: extra for extra in ("data", "cluster") for line in extras[extra]}
    assert extras["all"] == ["stabilab[data]"] and EXTRAS == brought and extras["fast"] == []
    assert cure(
        "xarray") == 'pip install xarray (part of stabilab\'s extra data: pip install "stabilab[data]")'


def test_ci_runs_the_lowest_versions():
    make = subprocess.run(["make", "-n", "floors"], cwd=ROOT, capture_output=True, text=True)
    assert "make floors" in (ROOT / ".ci/run").read_text() and "-m tests.house.floors" in make.stdout
    assert all((ROOT / path).is_file() for path in make.stdout.split() if path.startswith("tests/")
               and path.endswith(".py"))


# -- installed, away from the repository


def test_the_package_brings_the_cases_of_its_tables_and_figures(tmp_path):
    """What setuptools puts into a wheel, without making one."""
    pytest.importorskip("setuptools", minversion="65")
    subprocess.run([sys.executable, "-W", "ignore", "-c", "from setuptools import setup; setup()", "-q",
                    "egg_info", "--egg-base", tmp_path,
                    "build_py", "--build-lib", tmp_path / "made"], cwd=ROOT, check=True, capture_output=True)
    made = tmp_path / "made/stabilab/cases"
    files = lambda folder: {p.relative_to(folder): p.read_bytes() for p in folder.rglob("*.toml")}
    assert files(made) == files(ROOT / "cases")


ONE_STATE = ("import stabilab, sys\ncase = stabilab.load(sys.argv[1])\nprint(stabilab.motion(case.scene, "
             "case.state).fate.word)\n"
             "print(stabilab.equilibria(case.scene).kind)")


@pytest.mark.slow
def test_wheel_and_sdist_install_from_files_alone_in_a_bare_environment_and_answer(tmp_path):
    """Packages are fetched first; then pip may ask nobody. With python-flint alone one state is answered, and
    with the base installation plots and meshes; what it lacks the extras bring, and a command that needs one
    names it. Tables, figures and reports are made of what the package brings."""
    copy, bin_, house = tmp_path / "source", tmp_path / "bare/bin", tmp_path / "house"
    unpacked = lambda folder, names: [n for n in names if n.startswith(".") or Path(folder) == ROOT
                                      and n in ("build", "report", "figures")]
    shutil.copytree(ROOT, copy, symlinks=True, ignore=unpacked)
    subprocess.run([sys.executable, "-m", "venv", tmp_path / "bare"], check=True)
    pip = [bin_ / "python", "-m", "pip", "-q", "--disable-pip-version-check"]
    needed = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    needed = [*needed["build-system"]["requires"], "wheel", "build", *needed["project"]["dependencies"]]
    if subprocess.run([*pip, "download", "-d", house, "-c", ROOT / "constraints.txt", *needed],
                      capture_output=True).returncode:
        pytest.skip("no package index can be reached from here")
    closed = {name: value for name, value in os.environ.items() if not name.startswith("PIP_")} | {
        "PIP_NO_INDEX": "1", "PIP_FIND_LINKS": str(house), "PIP_CONFIG_FILE": os.devnull}
    install = lambda *what: subprocess.run([*pip, "install", *what], check=True, env=closed)
    install("build")
    subprocess.run([bin_ / "python", "-m", "build", "--outdir", tmp_path / "made", copy], check=True,
                   capture_output=True, env=closed)
    shutil.rmtree(copy)
    made = {path.suffix: path for path in (tmp_path / "made").iterdir()}
    install("--no-deps", made[".whl"], "python-flint")
    alone = subprocess.run([bin_ / "python", "-c", ONE_STATE, MINOR], capture_output=True, text=True,
                           cwd=tmp_path)
    assert alone.stdout.split() == ["bounded", "curves"], alone.stderr
    (tmp_path / "own.toml").write_bytes(MINOR.read_bytes())
    for built in (made[".whl"], made[".gz"]):
        install("--force-reinstall" if built == made[".gz"] else "--upgrade",
                *(["--no-deps"] if built == made[".gz"] else []), built)
        run = lambda *words: subprocess.run([bin_ / "stabilab", *map(str, words)], capture_output=True,
                                            text=True, cwd=tmp_path)
        answer = run("classify", MINOR, "--json")
        assert answer.returncode == 0 and json.loads(answer.stdout)[0]["motion"][
            "fate"] == "bounded", answer.stderr
        assert run("plot", MINOR, "--out",
                   "p.svg").returncode == 0 and run("surface", MINOR, "--out", "s").returncode in (0, 4)
        lacking = run("simulate", MINOR, "--out", "r.nc")
        assert lacking.returncode == 2 and "stabilab[data]" in lacking.stderr and lacking.stderr.count(
            "\n") == 1
        assert run("simulate", MINOR, "--at", "0,1").returncode == 0
        assert run("report", "own.toml", "--out", "mine").returncode == 0
        for words in (("tables",), ("figures", "9")):
            assert run(*words, "--out", words[0]).returncode == 0
            (*_, last) = manifest.read(tmp_path / words[0])
            assert last["inputs"] and not any(row["path"].startswith(str(ROOT)) for row in last["inputs"])
        listed = subprocess.run([bin_ / "python", "-m", "pip", "list"], check=True, capture_output=True,
                                text=True).stdout.lower()
        assert not any(package in listed for package in ("xarray", "pandas", "trame")) and "numba" in listed


def test_a_case_that_is_not_here_but_comes_with_the_package_is_named(tmp_path, stabilab, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, _, err = stabilab("show", "cases/minor-axis-100.toml")
    named = Path(err.strip().rpartition(": ")[2])
    assert code == BAD_INPUT and "no such file; stabilab brings one: " in err
    assert named.read_bytes() == MINOR.read_bytes()


# -- ended in the middle

# A program that writes one file, or fills a folder, and stops in the middle of it, after it said so.
HALF_FILE = ("from stabilab.files import whole_file\nwith whole_file('wanted.txt') as waiting:\n"
             "    waiting.write_text('half')\n    stop()\n    waiting.write_text('whole')\n")
HALF_FOLDER = ("from stabilab.show import manifest\nwith manifest.written('out', ['tables']) as "
               "folder:\n"
               "    (folder / 'a.txt').write_text('new')\n    stop()\n    (folder / "
               "'b.txt').write_text('new')\n")
# ... and one that stops between the renames: b.txt is in place, c.txt is not.
HALF_MOVED = ("import os\nfrom stabilab import files\nfrom stabilab.show import manifest\nreal = "
              "os.replace\n"
              "def replace(a, b):\n    if str(b).endswith('c.txt'): stop()\n    real(a, b)\n"
              "files.os.replace = replace\nwith manifest.written('out', ['tables']) as folder:\n"
              "    (folder / 'b.txt').write_text('new')\n    (folder / 'c.txt').write_text('new')\n")


def started(code, folder, stop="print('here', flush=True); time.sleep(1000)"):
    """The program, when it has come to its middle; stop: what it does there."""
    run = subprocess.Popen([sys.executable, "-c",
                            f"import time\nfrom stabilab import interrupt\ninterrupt.arm()\ndef stop():\n    "
                            f"{stop}\n{code}"],
                           cwd=folder, env=environment(folder), stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                           text=True,
                           preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    assert run.stdout.readline() == "here\n"
    return run


def ended(run, with_signal):
    run.send_signal(with_signal)
    run.communicate(timeout=60)
    return run.returncode


def finished(code, folder):
    done = subprocess.run([sys.executable, "-c", f"def stop(): pass\n{code}"], cwd=folder,
                          env=environment(folder), capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.one_in(2)
@pytest.mark.parametrize("how, code", [(signal.SIGINT, INTERRUPTED), (signal.SIGKILL, -signal.SIGKILL)],
                         ids=["interrupt", "kill"])
def test_half_a_file_never_bears_its_name_and_a_rerun_completes(tmp_path, how, code):
    (tmp_path / "wanted.txt").write_text("of yesterday")
    assert ended(started(HALF_FILE, tmp_path), how) == code
    assert (tmp_path / "wanted.txt").read_text() == "of yesterday"
    # a killed run leaves its own file, under another name
    assert (len(written(tmp_path)) == 1) == (how == signal.SIGINT)
    finished(HALF_FILE, tmp_path)
    assert written(tmp_path) == {"wanted.txt": b"whole"}


@pytest.mark.one_in(2)
@pytest.mark.parametrize("how, code", [(signal.SIGINT, INTERRUPTED), (signal.SIGKILL, -signal.SIGKILL)],
                         ids=["interrupt", "kill"])
def test_a_folder_stays_as_it_was_until_all_of_it_is_made(tmp_path, how, code):
    finished(HALF_FOLDER.replace("'new'", "'old'"), tmp_path)
    before = written(tmp_path)
    assert set(before) == {"out/a.txt", "out/b.txt", "out/manifest.json"}
    assert ended(started(HALF_FOLDER, tmp_path), how) == code
    assert before.items() <= written(tmp_path).items()
    finished(HALF_FOLDER, tmp_path)
    assert written(tmp_path)["out/a.txt"] == written(tmp_path)["out/b.txt"] == b"new" and set(
        written(tmp_path)) == set(before)


def test_a_folder_that_was_not_there_is_not_there_after_an_interrupt(tmp_path):
    assert ended(started(HALF_FOLDER, tmp_path), signal.SIGINT) == INTERRUPTED
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGKILL], ids=["interrupt", "kill"])
def test_a_manifest_speaks_of_complete_commands_only(tmp_path, how):
    """Ended between two renames: the command before it, whose b.txt was replaced, is gone from the manifest;
    a.txt is not."""
    finished(HALF_FOLDER, tmp_path)
    assert ended(started(HALF_MOVED, tmp_path), how)
    (left,) = manifest.read(tmp_path / "out")
    assert [row["path"] for row in left["outputs"]] == ["a.txt"]
    finished(HALF_MOVED, tmp_path)
    assert [[row["path"] for row in run["outputs"]]
            for run in manifest.read(tmp_path / "out")] == [["a.txt"], ["b.txt", "c.txt"]]
    assert set(written(tmp_path)) == {f"out/{name}" for name in ("a.txt", "b.txt", "c.txt", "manifest.json")}


def test_the_files_of_a_run_that_is_alive_are_left_alone(tmp_path):
    """Two runs into one place: each makes its own, whole; the last to end gives the result."""
    stop = "print('here', flush=True); input()"
    for code, name in ((HALF_FILE, "wanted.txt"), (HALF_FOLDER, "out/a.txt")):
        first = started(code, tmp_path, stop)
        finished(code.replace("'whole'", "'other'").replace("'new'", "'other'"), tmp_path)
        assert (tmp_path / name).read_text() == "other"
        first.communicate("\n", timeout=60)
        assert first.returncode == 0 and (tmp_path / name).read_text() in ("whole", "new")
    assert [row["sha256"] for row in manifest.read(tmp_path / "out")[-1]["outputs"]] == \
        [manifest.sha256(tmp_path / "out" / name) for name in ("a.txt", "b.txt")]
    assert set(written(tmp_path)) == {"wanted.txt", "out/a.txt", "out/b.txt", "out/manifest.json"}


@pytest.mark.slow
def test_a_run_waits_while_another_puts_its_files_in_place(tmp_path):
    (tmp_path / "out").mkdir()
    holding = started("from stabilab.files import alone_in\nwith alone_in('out'): stop()", tmp_path,
                      "print('here', flush=True); input()")
    waiting = subprocess.Popen([sys.executable, "-c", f"def stop(): pass\n{HALF_FOLDER}"], cwd=tmp_path,
                               env=environment(tmp_path))
    with pytest.raises(subprocess.TimeoutExpired):
        waiting.wait(3)
    assert not (tmp_path / "out" / "manifest.json").exists()
    holding.communicate("\n", timeout=60)
    assert waiting.wait(60) == 0 and (tmp_path / "out" / "manifest.json").exists()


def test_an_error_that_is_not_about_writing_keeps_its_own_words(tmp_path):
    with pytest.raises(FileNotFoundError), files.whole_file(tmp_path / "a.txt"):
        open("/nowhere/at/all")
    with pytest.raises(InputError,
                       match="a.txt: cannot be written: Is a directory"), files.whole_file(
                           tmp_path / "a.txt") as waiting:
        waiting.unlink()
        waiting.mkdir()
        waiting.write_text("")
    with pytest.raises(ZeroDivisionError), files.new_folder(tmp_path / "out"):
        raise ZeroDivisionError
    assert not (tmp_path / "out").exists()


def test_a_name_may_be_as_long_as_the_system_allows_and_hold_what_patterns_mean(tmp_path):
    for name in ("x" * 255, "[a]*?.txt"):
        with files.whole_file(tmp_path / name) as waiting:
            waiting.write_text(name)
        assert (tmp_path / name).read_text() == name
