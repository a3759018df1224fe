"""The folder in a real browser: Python, python-flint and the exact core run there, and nothing comes from
elsewhere."""
import functools
import http.server
import json
import shutil
import subprocess
import sys
import tarfile
import threading

import pytest

from stabilab import load, motion
from stabilab.answers.certificate import certificate
from stabilab.case.read import read_text
from stabilab.show.explore import serve
from stabilab.show.text.headline import two_lines
from tests.browser import CHROMIUM, Browser

CASE = "cases/thruster-stuck-major-axis.toml"
HEADLINE = "document.querySelector('#headline').textContent"
ANSWERED = "Number(shown.toml.match(/torque = .([^,]+),/)[1]) === Number(fields.size.field.value)"
RESTS = "document.documentElement.dataset.moving === 'false'"
pytestmark = [pytest.mark.slow, pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed")]


@pytest.fixture(scope="module")
def pyodide(tmp_path_factory):
    """Pyodide and the wheel of python-flint, as their registries have them."""
    folder = tmp_path_factory.mktemp("pyodide")
    if shutil.which("npm") is None:
        pytest.skip("npm is not installed")
    try:
        packed = subprocess.run(["npm", "pack", "--silent", f"pyodide@{serve.PYODIDE}"], cwd=folder,
                                capture_output=True, text=True, timeout=300)
        wheel = subprocess.run([sys.executable, "-m", "pip", "download", "--quiet", "--no-deps",
                                "--only-binary=:all:", "--python-version", "3.14",
                                "--platform", "pyemscripten_2026_0_wasm32", "--dest", str(folder / "package"),
                                f"python-flint=={serve.FLINT}"],
                               capture_output=True, text=True, timeout=300)
    except subprocess.TimeoutExpired as error:
        pytest.skip(f"a registry does not answer: {error}")
    if packed.returncode or wheel.returncode:
        pytest.skip(f"a registry is not reached: {(packed.stderr + wheel.stderr)[-300:]}")
    with tarfile.open(next(folder.glob("pyodide-*.tgz"))) as archive:
        archive.extractall(folder, filter="data")
    return folder / "package"


@pytest.fixture(scope="module")
def page(pyodide, tmp_path_factory):
    """The page of a static server, in a browser that finds no other host."""
    index = serve.write(load(CASE), tmp_path_factory.mktemp("site"), pyodide)

    class Quiet(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_):
            pass
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0),
                                         functools.partial(Quiet, directory=index.parent)) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        with Browser(tmp_path_factory.mktemp("profile"),
                     flags=["--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1"]) as browser:
            browser.open(f"http://127.0.0.1:{server.server_port}/")
            browser.until(f"document.documentElement.dataset.answers && {RESTS}", 240)
            yield browser
            assert browser.console == []
        server.shutdown()


def test_the_verdict_in_the_browser_is_that_of_the_program(page):
    case = load(CASE)
    assert page.run(HEADLINE) == " ".join(two_lines(case, motion(case.scene, case.exact_state)))


def test_sliders_move_verdict_and_surface(page):
    mesh = "JSON.stringify(shown.space.branches.map(s => Array.from(s.at)))"
    said, drawn = page.run(HEADLINE), page.run(mesh)
    for _ in page.drag("#size", (0.75, 0.9)):
        page.until(ANSWERED)
    page.until(f"{RESTS} && {ANSWERED}", 60)
    case = read_text("saved.toml", page.run("shown.toml"))
    assert page.run(HEADLINE) == " ".join(
        two_lines(case, motion(case.scene, case.exact_state))) != said
    assert page.run(mesh) != drawn


def test_a_tilt_is_undecided_and_says_why(page):
    page.run("fields.tilt.field.value = '3'; fields.tilt.field.oninput()")
    page.until(
        f"{RESTS} && /^Undecided\\W+this motion has to be followed, which needs NumPy/i.test({HEADLINE})", 60)
    page.run("document.querySelector('#again').click()")
    page.until(f"{RESTS} && {HEADLINE}.startsWith('Bounded')", 60)


def test_a_dropped_certificate_is_checked_in_the_browser(page):
    case = load(CASE)
    made = certificate(case.scene, case.exact_state)
    for fate, status in (("bounded", "proved"), ("spin-up", "refuted")):
        made["motion"]["fate"] = fate
        page.run(f"void check(new File([{json.dumps(json.dumps(made))}], '{status}.json'))")
        page.until(f"document.querySelector('#checked p')?.textContent === '{status}.json: {status}'", 120)
