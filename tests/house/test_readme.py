"""What README.md and docs/ say is so: their commands run, their output is what comes, their files and links
exist.

Conventions of those pages. A block ```toml or ```python whose first line is a comment with a path is that
file. A ```python block with >>> is a doctest. In a ```console block lines after "$ " are commands; what
follows is the whole output, where a line "..." stands for any lines and "..." inside a line for any text.
Every command must end with 0, unless "$ echo $?" follows it. Lines of a ```sh block are commands too.
"""
import contextlib
import doctest
import importlib.util
import io
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from unittest import mock

import pytest

from stabilab import cli, errors
from stabilab.show.render_probe import CURE, probe

ROOT = Path(__file__).parents[2]
README, GUIDE = ROOT / "README.md", ROOT / "docs/guide.md"
# by docs/conf.py, from what stands elsewhere
MADE = {"readme.md", "results.md", "api.md", "commands.md", "gallery.md", "contributing.md", "changelog.md"}
LISTS = {"index.md"}  # of pages alone, which the last test here looks through
CHAPTERS = [page for page in sorted((ROOT / "docs/mathematics").glob("*.md")) if page.name not in LISTS]
PAGES = [README, *(page for page in sorted((ROOT / "docs").glob("*.md")) if page.name not in MADE | LISTS),
         *CHAPTERS]
NAMES = [page.relative_to(ROOT).as_posix() for page in PAGES]
# a command that takes so long hangs: the report takes some four minutes on one core, more where others work
# beside it
SECONDS = 1800
SLOW = ("stabilab report", "stabilab precision", "python -m pytest")  # run by the slow tests
HEYOKA = importlib.util.find_spec("heyoka") is not None


def blocks(text):
    """(language, body) of every fenced block, in order."""
    return [(m[1], m[2]) for m in re.finditer(r"^```(\w*)\n(.*?)^```$", text, re.M | re.S)]


def commands(text):
    """[command, output or None where none is shown, exit code] of every shell block, in order."""
    found = []
    for language, body in blocks(text):
        if language == "sh":
            found += [[line, None, 0] for line in body.splitlines() if line.strip()]
        if language == "console":
            assert body.startswith("$ "), f"a console block begins with a command: {body[:60]!r}"
            for part in re.split(r"^\$ ", body, flags=re.M)[1:]:
                command, _, output = part.partition("\n")
                if command == "echo $?":
                    found[-1][2] = int(output)
                else:
                    found.append([command, output, 0])
    return found


def files(text):
    """path -> content of the blocks that are files."""
    named = ((re.match(r"# (\S+\.(?:toml|py))\n", body), body) for language, body in blocks(text))
    return {m[1]: body for m, body in named if m}


def as_pattern(shown):
    """The regular expression of an output shown, "..." standing for what is left out. Where that is in a
    line, its columns may stand wider apart: they are as wide as their longest number, and the last digits of
    a run hang on the machine."""
    lines = [r"(?:.*\n)*?" if line == "..."
             else "[^\n]*".join(map(re.escape, line.rstrip().split("..."))) + r"[ ]*\n"
             for line in shown.splitlines()]
    return re.compile("".join(re.sub(r"(?:\\ ){2,}", "[ ]{2,}", line) if "[^\n]*" in line else line
                              for line in lines))


def make_knows(target):
    """A dry run of make gives the target's commands."""
    run = subprocess.run(["make", "-n", "-B", target], cwd=ROOT, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    return run.stdout


def serves(*arguments):
    """A command that serves until it is interrupted tells its address."""
    run = subprocess.Popen([sys.executable, "-m", "stabilab", *arguments], cwd=ROOT, stdout=subprocess.PIPE,
                           stderr=subprocess.DEVNULL, text=True)
    try:
        return run.stdout.readline().startswith("http://127.0.0.1:")
    finally:
        run.kill()
        run.communicate()


# Commands that are not run here, for they install or take minutes, and how each is checked instead.
NOT_RUN = {
    "make report": lambda: "-m venv .venv" in make_knows("report")
    and "stabilab report cases/*.toml --papers --precision --out report" in make_knows("report"),
    "make test": lambda: "-m venv .venv" in make_knows("test") and "-m pytest" in make_knows("test"),
    'pip install -e ".[all]"': lambda: 'readme = "README.md"' in (ROOT / "pyproject.toml").read_text()
    and README.exists(),
    "apt install libegl1 libgl1-mesa-dri": lambda: CURE == "apt install libegl1 libgl1-mesa-dri",
    "make coverage": lambda: "--cov" in make_knows("coverage")
    and "fail_under = 95" in (ROOT / "pyproject.toml").read_text(),
    "make mutate": lambda: "-m tests.mutate" in make_knows("mutate"),
    "stabilab explore cases/thruster-stuck-major-axis.toml": lambda: serves("explore",
                                                                            "cases/thruster-stuck-major-axis.toml", "--no-browser"),
    "make docs": lambda: "-m sphinx" in make_knows("docs"),
    "python -m benchmarks": lambda: importlib.util.find_spec("benchmarks.__main__")
    and "-m benchmarks" in make_knows("bench"),
}


def run(command, folder):
    """(what the terminal shows, exit code), with the stabilab of this interpreter on the path, or that of a
    copy in the folder."""
    own = folder if (folder / "stabilab").is_dir() else ROOT
    env = {name: value for name, value in os.environ.items() if name != "PYTEST_ADDOPTS"} | {
        "PATH": os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]]),
        "PYTHONPATH": str(own),
        "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(command, shell=True, cwd=folder, env=env, stdin=subprocess.DEVNULL, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=SECONDS)
    return done.stdout, done.returncode


def run_here(command, folder):
    """The same in this process, which has imported what a process of its own imports first."""
    screen = io.TextIOWrapper(io.BytesIO(), encoding="utf-8", write_through=True)
    with (contextlib.chdir(folder), mock.patch.object(sys, "argv", shlex.split(command)),
          contextlib.redirect_stdout(screen),
          contextlib.redirect_stderr(screen), pytest.raises(SystemExit) as left):
        cli.main()
    return screen.buffer.getvalue().decode("utf-8"), left.value.code or errors.OK


def follow(text, folder, wanted, by_shell=1):
    """Run the commands of a page that `wanted` picks, in order; assert exit codes and outputs; the commands
    run. The first `by_shell` are run by a shell, as a reader does, and all of a page that changes the program."""
    followed = [item for item in commands(text) if item[0] not in NOT_RUN and wanted(item[0])]
    for n, (command, shown, stated) in enumerate(followed):
        outside = (n < by_shell or " > " in command or (folder / "stabilab").is_dir()
                   or not command.startswith("stabilab "))
        output, code = (run if outside else run_here)(command, folder)
        if command.startswith("stabilab surface") and not probe().available:
            assert code == errors.NO_RENDERING and CURE in output, output
        else:
            assert code == stated, f"$ {command}\nended with {code}\n{output}"
        if shown is not None and (HEYOKA or not command.startswith("stabilab simulate")):
            assert as_pattern(shown).fullmatch(
                output), f"$ {command}\nprinted\n{output}\nbut the page shows\n{shown}"
    return [command for command, _, _ in followed]


def prepared(text, folder):
    """The page's files in the folder, beside the cases and `my.toml` of the README."""
    shutil.copytree(ROOT / "cases", folder / "cases", dirs_exist_ok=True)
    for path, content in (files(README.read_text(encoding="utf-8")) | files(text)).items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(content)
    return text, folder


def in_python(text):
    """Run the sessions of a page one after another, each with the names of those before."""
    sessions = [body for language, body in blocks(text) if language == "python" and ">>>" in body]
    assert sessions
    names: dict = {}
    for body in sessions:
        test = doctest.DocTestParser().get_doctest(body, names, "page", "page", 0)
        report = []
        result = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS,
                                       verbose=False).run(test, out=report.append, clear_globs=False)
        names.update(test.globs)
        assert test.examples and result.failed == 0, "".join(report)


@pytest.fixture(scope="module")
def readme(tmp_path_factory):
    return prepared(README.read_text(), tmp_path_factory.mktemp("readme"))


@pytest.fixture(scope="module")
def guide(tmp_path_factory):
    return prepared(GUIDE.read_text(), tmp_path_factory.mktemp("guide"))


def test_readme_commands_print_what_it_shows(readme):
    text, folder = readme
    done = follow(text, folder, lambda command: not command.startswith(SLOW))
    assert len(done) >= 4 and (folder / "my.png").stat().st_size > 0


@pytest.mark.slow
def test_the_three_doors_print_what_they_show(tmp_path, monkeypatch):
    text, folder = prepared((ROOT / "docs/start.md").read_text(), tmp_path)
    assert len(follow(text, folder, lambda command: True)) == len(commands(text))
    monkeypatch.chdir(folder)
    in_python(text)


def test_readme_is_not_longer_than_three_screens():
    assert len(README.read_text().splitlines()) <= 150


@pytest.mark.slow
def test_commands_of_the_guide_print_what_it_shows(guide):
    text, folder = guide
    done = follow(text, folder, lambda command: not command.startswith(SLOW))
    needed = ("show", "classify", "extremes", "surface", "simulate", "plot", "tables")
    assert all(any(command.startswith(f"stabilab {name} ") for command in done) for name in needed)
    for name in ("my.csv", "my.png", "surfaces/my.vtp", "surfaces/my.glb", "surfaces/my.stl",
                 "tables/table-4.tex"):
        assert (folder / name).stat().st_size > 0


@pytest.mark.slow
def test_the_precision_of_the_guide_is_what_it_shows(guide):
    assert follow(*guide, lambda command: command.startswith("stabilab precision"))


@pytest.mark.parametrize("wanted", ["stuck bias", pytest.param("stuck", marks=pytest.mark.slow)])
def test_the_page_of_stuck_thrusters_prints_what_it_shows(tmp_path, wanted):
    text, folder = prepared((ROOT / "docs/stuck.md").read_text(), tmp_path)
    assert follow(text, folder, lambda command: command.startswith(f"stabilab {wanted}"))


# by the tests beside this one
FOLLOWED = {"README.md", "docs/guide.md", "docs/start.md", "docs/stuck.md", "docs/adding-an-effect.md"}
OTHERS = [page for page, name in zip(PAGES, NAMES) if name not in FOLLOWED
          and ("```console" in page.read_text() or "```sh" in page.read_text())]


@pytest.mark.slow
@pytest.mark.parametrize("page", OTHERS, ids=[page.stem for page in OTHERS])
def test_the_other_pages_print_what_they_show(page, tmp_path, monkeypatch):
    text, folder = prepared(page.read_text(encoding="utf-8"), tmp_path)
    follow(text, folder, lambda command: True, by_shell=0)
    monkeypatch.chdir(folder)
    if ">>>" in text:
        in_python(text)


@pytest.mark.parametrize("page", ["readme", "guide"])
def test_sessions_in_python_give_what_they_show(page, request, monkeypatch):
    text, folder = request.getfixturevalue(page)
    monkeypatch.chdir(folder)
    in_python(text)


@pytest.mark.one_in(4)
@pytest.mark.parametrize("chapter", CHAPTERS, ids=[page.stem for page in CHAPTERS])
def test_formulas_of_a_chapter_of_mathematics_are_those_of_the_program(chapter, monkeypatch):
    """Its sessions compare the formulas with the program, in fractions or by derivatives along the motion."""
    monkeypatch.chdir(ROOT)
    in_python(chapter.read_text(encoding="utf-8"))


@pytest.mark.one_in(2)
@pytest.mark.parametrize("page", PAGES, ids=NAMES)
def test_commands_that_are_not_run_are_listed_and_checked(page):
    """Every command is one of the program's or of its tests, or stands in the list above."""
    for command, _, _ in commands(page.read_text()):
        if command in NOT_RUN:
            assert NOT_RUN[command](), command
        else:
            assert command.startswith(("stabilab ", "python -m pytest tests/")), f"unknown command: {command}"


@pytest.mark.parametrize("page", PAGES, ids=NAMES)
def test_blocks_are_of_a_kind_that_is_checked(page):
    text = page.read_text()
    assert text.count("\n```") == 2 * len(blocks(text))
    for language, body in blocks(text):
        checked = language in ("sh", "console") or ">>>" in body or re.match(r"# \S+\.(toml|py|csv)\n", body)
        assert checked or body.strip() == LORENTZ_ROW, body


@pytest.mark.parametrize("page", PAGES, ids=NAMES)
def test_links_and_pictures_exist(page):
    targets = re.findall(r"\]\(([^)\s]+)\)", page.read_text())
    for target in targets:
        assert "://" in target or (page.parent / target.split("#")[0]).exists(), target


def test_readme_has_a_picture():
    assert re.search(r"!\[[^]]+\]\(figures/[\w-]+\.png\)", README.read_text())


def test_outcomes_and_exit_codes_in_the_guide_are_those_of_the_program():
    from stabilab import Fate
    from stabilab.physics.effects import REGISTRY
    rows = [line.split("|")[1].strip() for line in GUIDE.read_text().splitlines() if line.startswith("|")]
    fates, effects = rows[rows.index("outcome"):], rows[rows.index("effect"):rows.index("outcome")]
    assert {row.strip("`") for row in fates if row.startswith("`")} == {fate.word for fate in Fate}
    assert [row[1:].split("`")[0] for row in effects if row.startswith("`")] == list(REGISTRY)
    codes = {errors.OK, errors.BUG, errors.BAD_INPUT, errors.UNDECIDED, errors.NO_RENDERING,
             errors.TOLERANCE_NOT_MET, errors.INTERRUPTED}
    assert {int(row) for row in rows if row.isdigit()} == codes


@pytest.mark.skipif(not HEYOKA, reason="counts heyoka's steps")
def test_cost_table_is_what_simulate_counts(guide):
    """Counters within a tenth (a processor's rounding moves a step), departures within a factor of three."""
    from stabilab import load, trajectory
    case = load(guide[1] / "my.toml")
    table = re.findall(r"^\| (\w+) \| (1e-\d+) \| (\d+) \| (?:order )?(\d+) \| (\S+) \|$",
                       (ROOT / "docs/cost.md").read_text(), re.M)
    assert len(table) >= 8
    for method, rtol, steps, other, departure in table:
        run = trajectory(case.scene, case.state, [300.0], method=method, rtol=float(rtol))
        count = run.counters["order" if method == "taylor" else "rate evaluations"]
        assert run.counters["steps"] == pytest.approx(int(steps), rel=0.1)
        assert count == pytest.approx(int(other), rel=0.1)
        least = 0 if float(departure) < 1e-14 else float(departure) / 3  # rounding alone may be smaller
        assert least <= max(run.invariant_drift.values()) <= 3 * float(departure), (method, rtol)


LORENTZ_ROW = '"lorentz": ("lorentz", "Lorentz"),'


@pytest.fixture
def with_new_effect(tmp_path):
    """A copy of the program with the effect of docs/adding-an-effect.md, made as that page says."""
    text = (ROOT / "docs/adding-an-effect.md").read_text()
    for name in ("stabilab", "tests"):
        shutil.copytree(ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    row = next(body for language, body in blocks(text) if body.strip() == LORENTZ_ROW)
    registry = tmp_path / "stabilab/physics/effects/__init__.py"
    before, bracket, after = registry.read_text().partition("\n}\n")
    registry.write_text(before + "\n" + row.rstrip("\n") + bracket + after)
    return prepared(text, tmp_path)


@pytest.mark.slow
def test_an_effect_added_as_documented_is_known_to_the_commands(with_new_effect):
    done = follow(*with_new_effect, lambda command: not command.startswith(SLOW))
    assert any(command.startswith("stabilab simulate") for command in done)


@pytest.mark.slow
@pytest.mark.long  # five minutes for one test: all laws of all pairs of effects, in a copy without compiled loops
def test_an_effect_added_as_documented_obeys_the_laws(with_new_effect):
    assert follow(*with_new_effect, lambda command: command.startswith("python -m pytest"))


def test_an_output_that_differs_is_seen():
    """The comparison itself: a wrong digit, a missing and an extra line, and what "..." may stand for."""
    assert as_pattern("a 1\n...\nb ...\n").fullmatch("a 1\nx\ny\nb 23\n")
    assert as_pattern("...\n").fullmatch("") and as_pattern("a\n...\nb\n").fullmatch("a\nb\n")
    for other in ("a 2\nb 23\n", "a 1\nx\n", "a 1\nb 23\nc\n"):
        assert not as_pattern("a 1\n...\nb ...\n").fullmatch(other)
