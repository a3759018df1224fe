"""Broken surroundings: full disks, folders that cannot be written, runs that are killed, two runs at once.

What was written before stays as it was, no half file bears its final name, and a run after it completes.
"""
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from stabilab import files
from stabilab.errors import BAD_INPUT, INTERRUPTED, InputError
from stabilab.show import manifest

ROOT = Path(__file__).parent.parent
MINOR, CHARGED, CAPTURED = (ROOT / "cases" / f"{name}.toml" for name in ("minor-axis-100", "charged-body", "major-axis-captured"))
posix = pytest.mark.skipif(os.name != "posix", reason="limits, locks and signals of POSIX")
pytestmark = posix

# Every way to write a file: arguments, and the option that says where
WRITERS = {
    "simulate csv": (("simulate", MINOR), "--out", "run.csv"), "simulate nc": (("simulate", MINOR), "--out", "run.nc"),
    "compare": (("compare", CHARGED), "--out", "errors.csv"),
    "precision csv": (("precision", MINOR, "--quick", "--until", "1"), "--out", "points.csv"),
    "precision png": (("precision", MINOR, "--quick", "--until", "1"), "--out", "points.png"),
    "plot": (("plot", MINOR), "--out", "plane.png"), "tables": (("tables",), "--out", "tables"),
    "figures": (("figures", "9"), "--out", "figures"), "surface": (("surface", MINOR), "--out", "surface"),
}
ONE_FILE = {name for name, (_, _, target) in WRITERS.items() if "." in target}


def command(name, folder):
    arguments, option, target = WRITERS[name]
    return [sys.executable, "-m", "stabilab", *map(str, arguments), option, str(Path(folder) / target)]


def environment(folder):
    """The measured fronts of `precision` go to a folder of the test's own."""
    return os.environ | {"XDG_CACHE_HOME": str(Path(folder) / "cache"), "PYTHONPATH": str(ROOT)}


def written(folder):
    """Path from `folder` -> bytes of everything in it but the cache."""
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in Path(folder).rglob("*")
            if p.is_file() and "cache" not in p.relative_to(folder).parts}


def limited(size):
    """For a child: no file may grow beyond `size` bytes, which fails as a full disk does, in the middle of a write."""
    def limit():
        import resource
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
    return limit


@pytest.mark.slow
@pytest.mark.parametrize("name", WRITERS)
def test_a_disk_that_fills_up_ends_with_2_and_leaves_what_was_there(tmp_path, name):
    target = tmp_path / WRITERS[name][2]
    if name in ONE_FILE:
        target.write_text("of yesterday")
    else:
        target.mkdir()
        (target / manifest.NAME).write_text("of yesterday")
    before = written(tmp_path)
    run = subprocess.run(command(name, tmp_path), capture_output=True, text=True, cwd=tmp_path, preexec_fn=limited(200),
                         env=environment(tmp_path))
    assert run.returncode == BAD_INPUT, run.stderr
    assert "cannot be written" in run.stderr and WRITERS[name][2] in run.stderr and "Traceback" not in run.stderr
    assert written(tmp_path) == before


@pytest.mark.parametrize("name", ["simulate csv", "tables", *(pytest.param(n, marks=pytest.mark.slow) for n in ("simulate nc", "plot", "figures"))])
def test_a_target_below_a_file_or_in_a_special_folder_ends_with_2(tmp_path, name):
    (tmp_path / "file").write_text("x")
    for folder in (tmp_path / "file", Path("/proc/self/fd")):
        run = subprocess.run(command(name, folder), capture_output=True, text=True, cwd=tmp_path, env=environment(tmp_path))
        assert run.returncode == BAD_INPUT and "cannot be written" in run.stderr and "Traceback" not in run.stderr, run.stderr
    assert written(tmp_path) == {"file": b"x"}


# -- ended in the middle -----------------------------------------------------------------------------------------------

# A program that writes one file, or fills a folder, and stops in the middle of it, after it said so.
HALF_FILE = ("from stabilab.files import whole_file\nwith whole_file('wanted.txt') as waiting:\n"
             "    waiting.write_text('half')\n    stop()\n    waiting.write_text('whole')\n")
HALF_FOLDER = ("from stabilab.show import manifest\nwith manifest.written('out', ['tables']) as folder:\n"
               "    (folder / 'a.txt').write_text('new')\n    stop()\n    (folder / 'b.txt').write_text('new')\n")
# ... and one that stops between the renames: b.txt is in place, c.txt is not.
HALF_MOVED = ("import os\nfrom stabilab import files\nfrom stabilab.show import manifest\nreal = os.replace\n"
              "def replace(a, b):\n    if str(b).endswith('c.txt'): stop()\n    real(a, b)\n"
              "files.os.replace = replace\nwith manifest.written('out', ['tables']) as folder:\n"
              "    (folder / 'b.txt').write_text('new')\n    (folder / 'c.txt').write_text('new')\n")


def started(code, folder, stop="print('here', flush=True); time.sleep(1000)"):
    """The program, when it has come to its middle; stop: what it does there."""
    run = subprocess.Popen([sys.executable, "-c", f"import time\nfrom stabilab import interrupt\ninterrupt.arm()\ndef stop():\n    {stop}\n{code}"],
                           cwd=folder, env=environment(folder), stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                           preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
    assert run.stdout.readline() == "here\n"
    return run


def ended(run, with_signal):
    run.send_signal(with_signal)
    run.communicate(timeout=60)
    return run.returncode


def finished(code, folder):
    done = subprocess.run([sys.executable, "-c", f"def stop(): pass\n{code}"], cwd=folder, env=environment(folder), capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("how, code", [(signal.SIGINT, INTERRUPTED), (signal.SIGKILL, -signal.SIGKILL)], ids=["interrupt", "kill"])
def test_half_a_file_never_bears_its_name_and_a_rerun_completes(tmp_path, how, code):
    (tmp_path / "wanted.txt").write_text("of yesterday")
    assert ended(started(HALF_FILE, tmp_path), how) == code
    assert (tmp_path / "wanted.txt").read_text() == "of yesterday"
    assert (len(written(tmp_path)) == 1) == (how == signal.SIGINT)  # a killed run leaves its own file, under another name
    finished(HALF_FILE, tmp_path)
    assert written(tmp_path) == {"wanted.txt": b"whole"}


@pytest.mark.parametrize("how, code", [(signal.SIGINT, INTERRUPTED), (signal.SIGKILL, -signal.SIGKILL)], ids=["interrupt", "kill"])
def test_a_folder_stays_as_it_was_until_all_of_it_is_made(tmp_path, how, code):
    finished(HALF_FOLDER.replace("'new'", "'old'"), tmp_path)
    before = written(tmp_path)
    assert set(before) == {"out/a.txt", "out/b.txt", "out/manifest.json"}
    assert ended(started(HALF_FOLDER, tmp_path), how) == code
    assert before.items() <= written(tmp_path).items()
    finished(HALF_FOLDER, tmp_path)
    assert written(tmp_path)["out/a.txt"] == written(tmp_path)["out/b.txt"] == b"new" and set(written(tmp_path)) == set(before)


def test_a_folder_that_was_not_there_is_not_there_after_an_interrupt(tmp_path):
    assert ended(started(HALF_FOLDER, tmp_path), signal.SIGINT) == INTERRUPTED
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGKILL], ids=["interrupt", "kill"])
def test_a_manifest_speaks_of_complete_commands_only(tmp_path, how):
    """Ended between two renames: the command before it, whose b.txt was replaced, is gone from the manifest; a.txt is not."""
    finished(HALF_FOLDER, tmp_path)
    assert ended(started(HALF_MOVED, tmp_path), how)
    (left,) = manifest.read(tmp_path / "out")
    assert [row["path"] for row in left["outputs"]] == ["a.txt"]
    finished(HALF_MOVED, tmp_path)
    assert [[row["path"] for row in run["outputs"]] for run in manifest.read(tmp_path / "out")] == [["a.txt"], ["b.txt", "c.txt"]]
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


def test_a_run_waits_while_another_puts_its_files_in_place(tmp_path):
    (tmp_path / "out").mkdir()
    holding = started("from stabilab.files import alone_in\nwith alone_in('out'): stop()", tmp_path, "print('here', flush=True); input()")
    waiting = subprocess.Popen([sys.executable, "-c", f"def stop(): pass\n{HALF_FOLDER}"], cwd=tmp_path, env=environment(tmp_path))
    with pytest.raises(subprocess.TimeoutExpired):
        waiting.wait(3)
    assert not (tmp_path / "out" / "manifest.json").exists()
    holding.communicate("\n", timeout=60)
    assert waiting.wait(60) == 0 and (tmp_path / "out" / "manifest.json").exists()


def test_an_error_that_is_not_about_writing_keeps_its_own_words(tmp_path):
    with pytest.raises(FileNotFoundError), files.whole_file(tmp_path / "a.txt"):
        open("/nowhere/at/all")
    with pytest.raises(InputError, match="a.txt: cannot be written: Is a directory"), files.whole_file(tmp_path / "a.txt") as waiting:
        waiting.unlink()
        waiting.mkdir()
        waiting.write_text("")
    with pytest.raises(ZeroDivisionError), files.new_folder(tmp_path / "out"):
        1 / 0
    assert not (tmp_path / "out").exists()


def test_a_name_may_be_as_long_as_the_system_allows_and_hold_what_patterns_mean(tmp_path):
    for name in ("x" * 255, "[a]*?.txt"):
        with files.whole_file(tmp_path / name) as waiting:
            waiting.write_text(name)
        assert (tmp_path / name).read_text() == name


# -- the report --------------------------------------------------------------------------------------------------------


def report(folder):
    return subprocess.Popen([sys.executable, "-m", "stabilab", "report", str(MINOR), "--out", "report"], cwd=folder, env=environment(folder),
                            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True,
                            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))


def processes_in(folder):
    """Ids of the processes that work on a report in the folder."""
    found = []
    for entry in Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and str(folder) in os.readlink(entry / "cwd"):
                found.append(int(entry.name))
        except OSError:
            pass
    return found


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/cwd").exists(), reason="looks for processes in /proc")
def test_a_report_that_is_interrupted_or_killed_damages_nothing_and_a_rerun_completes(tmp_path):
    (tmp_path / "report").mkdir()
    (tmp_path / "report" / "index.html").write_text("of yesterday")
    for how, delay in ((signal.SIGINT, 4), (signal.SIGKILL, 4), (signal.SIGINT, 12), (signal.SIGKILL, 12)):
        run = report(tmp_path)
        time.sleep(delay)
        run.send_signal(how)
        _, words = run.communicate(timeout=60)
        assert run.returncode == (INTERRUPTED if how == signal.SIGINT else -how) and words == ""
        assert (tmp_path / "report" / "index.html").read_text() == "of yesterday"
        visible = [p for p in written(tmp_path) if "/.new-" not in p]
        assert visible == ["report/index.html"]
        deadline = time.time() + 10
        while processes_in(tmp_path) and time.time() < deadline:
            time.sleep(0.1)
        assert processes_in(tmp_path) == []  # the second process ended too
    run = report(tmp_path)
    assert run.wait(timeout=580) == 0
    (made,) = manifest.read(tmp_path / "report")
    rows = {row["path"]: row["sha256"] for row in made["outputs"]}
    assert set(rows) == set(p.removeprefix("report/") for p in written(tmp_path)) - {manifest.NAME}
    assert all(manifest.sha256(tmp_path / "report" / path) == value for path, value in rows.items())
