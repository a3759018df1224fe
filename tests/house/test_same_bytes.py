"""The same case gives the same bytes: run after run, whatever the number of threads, the order of hashing and
the processor.

Answers about one state do not pass through NumPy's functions that differ from processor to processor, so
their bytes are the same on all of them. Surfaces, angles and formulas do (sines of whole arrays); there the
digits differ in the last places, and how far is stated and tested here.
"""
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from stabilab.errors import BAD_INPUT, NO_RENDERING, OK, TOLERANCE_NOT_MET
from stabilab.show import manifest, render_probe

ROOT = Path(__file__).parents[2]
CASES = {p.stem: str(p) for p in sorted((ROOT / "cases").glob("*.toml"))}
FEW = [CASES[name] for name in ("minor-axis-100", "middle-axis-300", "major-axis-100", "off-axis-two",
                                "torque-free-body")]

# Runs commands in one process; what they print goes to <number>.txt.
PROGRAM = """
import contextlib, io, json, os, sys
from pathlib import Path
commands = json.loads(sys.argv[1])
if os.environ.get("ONE_CPU"):
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
from stabilab import cli
for number, command in enumerate(commands):
    sys.argv = ["stabilab", *command]
    told = io.StringIO()
    with contextlib.redirect_stdout(told):
        try:
            cli.main()
        except SystemExit as left:
            print("exit", left.code)
    Path(f"{number}.txt").write_text(told.getvalue())
"""
# names of old and new NumPy; unknown ones are ignored
LEAST = "X86_V3 X86_V4 AVX512_ICL AVX512_SPR AVX2 FMA3 AVX512F AVX512_SKX"
AROUND = {"again": {}, "one thread": {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1",
                                      "NUMBA_NUM_THREADS": "1", "ONE_CPU": "1"},
          "other hashing": {"PYTHONHASHSEED": "12345"}}
PROCESSORS = {"without AVX-512": "X86_V4 AVX512_ICL AVX512_SPR AVX512F AVX512_SKX", "baseline": LEAST}


def outputs(folder, commands, **environment):
    """Path -> bytes of what the commands printed and wrote."""
    folder.mkdir()
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", PROGRAM, json.dumps(commands)], cwd=folder,
                          text=True,
                          capture_output=True,
                          env={**os.environ, "PYTHONPATH": str(ROOT), "PYTHONHASHSEED": "0", **environment})
    assert done.returncode == 0, done.stderr
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def differing(one, two):
    return sorted(path for path in {*one, *two} if one.get(path) != two.get(path))


ANSWERS = [["classify", *FEW, "--json"], ["extremes", *FEW, "--json"], ["extremes", *FEW, "--csv"],
           ["show", FEW[0]],
           ["simulate", FEW[0], "--at", "0,1,2", "--json"], ["simulate", FEW[3], "--out", "run.csv"]]
SECOND = list(CASES.values())[::2]
MORE = [["classify", *SECOND, "--json"], ["extremes", *SECOND, "--csv"],
        ["tables", "--out", "tables"],
        *(["simulate", path, "--out", f"{Path(path).stem}.csv"]
          for path in [*FEW, CASES["liquid-base"], CASES["top-fast"]])]
DRAWN = [["surface", FEW[0], "--out", "surface"], ["plot", FEW[0], "--out", "plane.png"],
         ["figures", "9", "--out", "figures"],
         ["compare", CASES["charged-body"], "--out", "errors.csv"], ["simulate", FEW[0], "--out", "run.nc"]]


@pytest.fixture(scope="module")
def answers(tmp_path_factory):
    return outputs(tmp_path_factory.mktemp("bytes") / "plain", ANSWERS)


@pytest.mark.slow
@pytest.mark.parametrize("around",
                         [{**AROUND["one thread"], **AROUND["other hashing"],
                           "NPY_DISABLE_CPU_FEATURES": LEAST}], ids=["all"])
def test_answers_are_the_same_bytes_whatever_surrounds_them(answers, tmp_path, around):
    assert set(answers) == {*(f"{n}.txt" for n in range(len(ANSWERS))), "run.csv"} and all(answers.values())
    assert all(answers[f"{n}.txt"].endswith(b"exit 0\n") for n in range(len(ANSWERS)))
    assert differing(answers, outputs(tmp_path / "other", ANSWERS, **around)) == []


@pytest.fixture(scope="module")
def everything(tmp_path_factory):
    return outputs(tmp_path_factory.mktemp("bytes") / "plain", DRAWN + MORE)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["again", *(pytest.param(name, marks=pytest.mark.long)
                                             for name in list(AROUND)[1:])])
def test_every_file_is_the_same_in_two_runs(everything, tmp_path, name):
    """Pictures, meshes and manifests too; answers and tables again on other processors, below."""
    assert {Path(path).suffix for path in everything} == {".txt", ".csv", ".md", ".tex", ".html", ".json",
                                                          ".vtp", ".glb", ".stl", ".png", ".nc"}
    commands = DRAWN if name == "again" else DRAWN + MORE
    other = outputs(tmp_path / "other", commands, **AROUND[name])
    assert len(other) > len(commands)
    assert differing({path: everything[path] for path in other}, other) == []


@pytest.mark.slow
@pytest.mark.parametrize("name", ["baseline", pytest.param("without AVX-512", marks=pytest.mark.long)])
def test_all_answers_and_tables_are_the_same_on_every_processor(everything, tmp_path, name):
    other = outputs(tmp_path / "other", MORE, NPY_DISABLE_CPU_FEATURES=PROCESSORS[name])
    kept = dict(everything)
    for n in range(len(MORE)):  # what the same commands printed after those that draw
        kept[f"{n}.txt"] = kept.pop(f"{n + len(DRAWN)}.txt")
    kept = {path: data for path, data in kept.items() if path in other}
    assert set(kept) == set(other)
    assert set(differing(kept, other)) <= {"tables/manifest.json"}  # it names the processor's features


# of the size of the surface: a vertex is a root of a function with its own sines; largest seen 3.3e-14
POINTS_APART = 1e-13
MODELS_APART = 1e-15  # of the largest value: one unit in the last place of sines; largest seen 1.8e-16


@pytest.mark.slow
@pytest.mark.parametrize("name", ["baseline", pytest.param("without AVX-512", marks=pytest.mark.long)])
def test_surfaces_and_formulas_differ_in_their_last_places_only(tmp_path, name):
    from stabilab.show.render_probe import use
    use()
    import pyvista
    wanted = [["surface", CASES["minor-axis-100"], "--out", "s"],
              ["surface", CASES["middle-axis-double-well"], "--out", "s"],
              ["simulate", CASES["charged-body"], "--out", "run.csv"],
              ["compare", CASES["charged-body"], "--out", "errors.csv"]]
    outputs(tmp_path / "one", wanted)
    outputs(tmp_path / "two", wanted, NPY_DISABLE_CPU_FEATURES=PROCESSORS[name])
    for case in ("minor-axis-100", "middle-axis-double-well"):
        one, two = (pyvista.read(tmp_path / side / "s" / f"{case}.vtp") for side in ("one", "two"))
        assert one.n_points > 1000 and np.array_equal(one.faces, two.faces)
        assert np.array_equal(one["sheet"], two["sheet"])
        assert np.abs(one.points - two.points).max() <= POINTS_APART * np.abs(one.points).max()
    for file in ("run.csv", "errors.csv"):
        one, two = (np.genfromtxt(tmp_path / side / file, delimiter=",", skip_header=1)
                    for side in ("one", "two"))
        assert one.shape == two.shape and (np.abs(one - two).max(0) <= MODELS_APART
                                           * np.abs(one).max(0)).all()


# -- manifest and rerun


@pytest.fixture
def made(tmp_path, monkeypatch, stabilab):
    """A folder with the meshes of a case of one's own, as a machine without a renderer makes them."""
    render_probe.probe.cache_clear()
    monkeypatch.setattr(render_probe, "_CHILD", "raise SystemExit(3)")
    (tmp_path / "my.toml").write_bytes((ROOT / "cases/minor-axis-100.toml").read_bytes())
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    assert stabilab("surface", "my.toml", "--out", "made")[0] == NO_RENDERING
    render_probe.probe.cache_clear()
    return tmp_path / "made"


def test_a_manifest_names_inputs_versions_command_processor_and_every_file(made):
    data = json.loads((made / "manifest.json").read_text())
    assert data["schema"] == "stabilab.manifest/1" and data[
        "command"] == "stabilab surface my.toml --out made"
    assert data["inputs"] == [{"path": "my.toml", "sha256": manifest.sha256("my.toml"),
                               "bytes": Path("my.toml").stat().st_size}]
    assert data["versions"]["numpy"] == np.__version__ and data["machine"]["cpu_features"] and data[
        "tolerances"] and data["seeds"]
    assert {row["path"]: row["sha256"] for row in data["outputs"]} == {
        p.name: manifest.sha256(p) for p in made.iterdir() if p.name != "manifest.json"}


@pytest.fixture
def tables(tmp_path, monkeypatch, stabilab):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    assert stabilab("tables", "--out", "made")[0] == OK
    return tmp_path / "made"


@pytest.mark.slow
def test_rerun_finds_the_same_bytes_from_another_folder(tables, stabilab, monkeypatch):
    """Of two commands in one folder both are repeated."""
    assert stabilab("figures", "9", "--out", "made")[0] == OK
    data = json.loads((tables / "manifest.json").read_text())
    assert [row["path"] for row in data["outputs"]] == ["figure-09.png",
                                                        "figure-09.txt"] and len(data["earlier"]) == 1
    monkeypatch.chdir("/")
    code, out, err = stabilab("rerun", tables / "manifest.json")
    assert code == OK and out.count(": identical") == len(
        list(tables.iterdir())) - 1 and "none differs" in out, out + err


@pytest.mark.slow
def test_rerun_sees_a_file_that_differs_and_keeps_the_new_ones_where_asked(tables, stabilab):
    data = json.loads((tables / "manifest.json").read_text())
    data["outputs"][1]["sha256"] = "0" * 64
    (tables / "manifest.json").write_text(json.dumps(data))
    again = tables.parent / "again"
    code, out, err = stabilab("rerun", tables, "--out", again)
    assert code == TOLERANCE_NOT_MET and "table-1.html: differs" in err and "table-1.csv: identical" in err
    assert err.startswith("1 of 25 files differs\n")
    assert err.splitlines()[2] == "  table-1.html: differs"
    assert (again / "table-2.csv").read_bytes() == (tables / "table-2.csv").read_bytes()
    code, out, err = stabilab("rerun", tables, "--out", again)
    assert code == BAD_INPUT and "name an empty folder" in err


@pytest.mark.parametrize("change, words",
                         [(lambda case: case.write_text("title = 'x'\n"), "my.toml: changed: SHA-256 was"),
                                           (lambda case: case.unlink(),
                                            "my.toml: cannot be read: No such file")])
def test_rerun_says_which_input_is_missing_or_changed(tmp_path, monkeypatch, stabilab, change, words):
    (tmp_path / "my.toml").write_text("x")
    monkeypatch.chdir(tmp_path)
    with manifest.written("made", ["surface", "my.toml", "--out", "made"], ["my.toml"]) as folder:
        (folder / "a.txt").write_text("a")
    change(tmp_path / "my.toml")
    code, out, err = stabilab("rerun", "made")
    assert code == BAD_INPUT and words in err and out == ""


@pytest.mark.parametrize("text, words", [("", "expected a manifest.json"), ("{}", "expected a manifest.json"),
                                         ("[1]", "expected a manifest.json"),
                                         ('{"schema": "stabilab.manifest/1", "earlier": [], "arguments": '
                                          '["tables"], "started_in": ".", '
                                          '"command": "", "inputs": [], "outputs": []}',
                                          "expected a manifest.json"),
                                         ("[" * 100_000, "expected a manifest.json"),
                                         (b"\xff", "expected a manifest.json"), (None, "cannot be read")])
def test_what_is_no_manifest_is_refused(tmp_path, stabilab, text, words):
    if text is not None:
        (tmp_path / "manifest.json").write_bytes(text if isinstance(text, bytes) else text.encode())
    code, _, err = stabilab("rerun", tmp_path)
    assert code == BAD_INPUT and words in err and "Traceback" not in err


@pytest.mark.parametrize("arguments, words",
                         [(["rerun", "."], "expected a command that fills a folder"),
                          (None, "made by a call from Python")])
def test_only_commands_that_fill_a_folder_are_repeated(tmp_path, monkeypatch, stabilab, arguments, words):
    """A manifest from elsewhere cannot make the program write where the user did not say."""
    monkeypatch.chdir(tmp_path)
    with manifest.written("made", arguments) as folder:
        (folder / "a.txt").write_text("a")
    code, _, err = stabilab("rerun", "made")
    assert code == BAD_INPUT and words in err


def test_files_that_show_times_are_marked_and_not_compared(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with manifest.written("made", ["report"]) as folder:
        for name in ("precision.html", "index.html"):
            (folder / name).write_text("a")
    rows = {row["path"]: row for row in manifest.read("made")[0]["outputs"]}
    assert rows["precision.html"]["timed"] and "timed" not in rows["index.html"]
    assert [manifest._compared(rows[name], {name: "0"}) for name in rows] == ["differs", manifest.TIMED]
