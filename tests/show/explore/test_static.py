"""The page as a folder: what is in it, what it says it needs, and that its core runs with python-flint alone.
"""
import io
import json
import subprocess
import sys
import zipfile
from importlib.util import find_spec
from pathlib import Path

import pytest

from stabilab import load
from stabilab.errors import InputError
from stabilab.show.explore import serve

CASE = "cases/thruster-stuck-major-axis.toml"
LOCK = {"info": {"abi_version": "2026_0", "python": "3.14.2"}}
WHEEL = "python_flint-0.9.0-cp314-cp314-pyemscripten_2026_0_wasm32.whl"


@pytest.fixture
def pyodide(tmp_path):
    """A folder with the names of Pyodide's files."""
    folder = tmp_path / "pyodide"
    folder.mkdir()
    for name in (*serve.NEEDED, WHEEL):
        (folder / name).write_bytes(name.encode())
    (folder / "pyodide-lock.json").write_text(json.dumps(LOCK))
    return folder


def test_the_archive_is_the_same_every_time_and_holds_no_papers():
    once = serve.archive()
    names = zipfile.ZipFile(io.BytesIO(once)).namelist()
    assert once == serve.archive() and "stabilab/show/explore/session.py" in names
    assert "stabilab/verify/__init__.py" in names
    assert not [name for name in names if name.startswith("stabilab/papers") or not name.endswith(".py")]


def test_the_archive_answers_and_checks_with_python_flint_alone(tmp_path):
    """In an interpreter that sees the archive and python-flint, and no other package."""
    with zipfile.ZipFile(io.BytesIO(serve.archive())) as packed:
        packed.extractall(tmp_path)
    flint = Path(find_spec("flint").origin).parent
    (tmp_path / "flint").symlink_to(flint)
    for beside in flint.parent.glob("python_flint*.libs"):
        (tmp_path / beside.name).symlink_to(beside)
    code = ("import sys\nfrom pathlib import Path\nfrom stabilab.case.read import read_text\nfrom "
            "stabilab.show.explore.session import Session\n"
            "from stabilab.show.explore.session import checked\nfrom stabilab.show.explore.pictures import "
            "unframed\n"
            "from stabilab.answers.certificate import certificate\n"
            "import json\nname, text = 'c.toml', Path(sys.argv[1]).read_text()\ncase = read_text(name, "
            "text)\n"
            "print(unframed(Session(case).answer({}))[0]['headline'])\n"
            "print(unframed(checked({'text': json.dumps(certificate(case.scene, "
            "case.exact_state))}))[0]['status'])\n"
            "print(sorted(m for m in ('numpy', 'sympy', 'mpmath', 'jinja2', 'typer') if m in sys.modules))")
    run = subprocess.run([sys.executable, "-I", "-S", "-c",
                          f"import sys; sys.path.insert(0, {str(tmp_path)!r})\n{code}",
                          str(Path(CASE).resolve())],
                         capture_output=True, text=True, cwd=tmp_path)
    assert run.returncode == 0, run.stderr
    headline, status, loaded = run.stdout.splitlines()
    assert headline.startswith(
        "BOUNDED only while the torque is exactly along x (major axis)") and "74.4 deg/s from the separatrix" in headline
    assert (status, loaded) == ("proved", "[]")


def test_the_archive_holds_all_that_a_motion_and_a_film_need(tmp_path):
    """With NumPy, from the archive alone: what draws the body, and what follows a motion that floats lose."""
    with zipfile.ZipFile(io.BytesIO(serve.archive())) as packed:
        packed.extractall(tmp_path)
    code = "import stabilab.show.plot.turning, stabilab.show.plot.path; print(stabilab.__file__)"
    run = subprocess.run([sys.executable, "-c", f"import sys; sys.path.insert(0, {str(tmp_path)!r})\n{code}"],
                         capture_output=True, text=True, cwd=tmp_path)
    assert run.stdout.startswith(str(tmp_path)), run.stderr


def test_the_folder_says_from_where_python_comes(tmp_path):
    index = serve.write(load(CASE), tmp_path / "site")
    assert sorted(path.name for path in index.parent.iterdir()) == ["index.html", "stabilab.zip", "worker.js"]
    text = index.read_text(encoding="utf-8")
    assert serve.ADDRESS in text and f"Pyodide {serve.PYODIDE} from {serve.ADDRESS}" in text
    assert "worker-src" in text


def test_with_a_folder_of_pyodide_nothing_comes_from_elsewhere(tmp_path, pyodide):
    index = serve.write(load(CASE), tmp_path / "site", pyodide)
    assert {path.name for path in (index.parent / "pyodide").iterdir()} == {*serve.NEEDED, WHEEL}
    text = index.read_text(encoding="utf-8")
    assert serve.ADDRESS not in text and "https://" not in text
    assert f"from the folder of this page, {WHEEL} too" in text


@pytest.mark.parametrize("without", [*serve.NEEDED, WHEEL])
def test_what_is_missing_of_pyodide_is_named_with_the_cure(tmp_path, pyodide, without):
    (pyodide / without).unlink()
    with pytest.raises(InputError, match="npm pack pyodide") as refused:
        serve.write(load(CASE), tmp_path / "site", pyodide)
    assert ("python_flint" if without == WHEEL
            else without) in str(refused.value) and not (tmp_path / "site").exists()


@pytest.mark.parametrize("lock", ["{", "[]", '{"info": {}}', '{"info": {"python": 3, "abi_version": 1}}'])
def test_a_lock_that_is_none_is_refused(tmp_path, pyodide, lock):
    (pyodide / "pyodide-lock.json").write_text(lock)
    with pytest.raises(InputError, match="is not Pyodide's"):
        serve.write(load(CASE), tmp_path / "site", pyodide)


def test_the_wheel_must_be_of_this_python(tmp_path, pyodide):
    (pyodide / "pyodide-lock.json").write_text(
        json.dumps({"info": {"abi_version": "2027_0", "python": "3.15.0"}}))
    with pytest.raises(InputError, match="no wheel python_flint"):
        serve.write(load(CASE), tmp_path / "site", pyodide)
