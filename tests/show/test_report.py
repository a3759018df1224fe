"""The report as a reader meets it: whole, from disk, without a network."""
import re
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

import stabilab
from stabilab.show.figures import catalogue as figures
from stabilab.show.report import chapters, report
from stabilab.show.surface import render_probe
from stabilab.theories.audit import audited

CASES = Path(__file__).parents[2] / "cases"
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
HOSTILE = '<script>alert("title")</script> & "more"'
VOID = {"meta", "link", "img", "br", "hr", "input"}


class Page(HTMLParser):
    """Collects tags, checks nesting, and lists what the page loads."""

    def __init__(self, text):
        super().__init__()
        self.open, self.faults, self.links, self.scripts, self.ids = [], [], [], 0, []
        self.feed(text)
        self.faults += [f"never closed: {tag}" for tag in self.open]

    def handle_starttag(self, tag, attrs):
        self.scripts += tag == "script"
        self.links += [v for k, v in attrs if k in ("src", "href", "data-scene")]
        self.ids += [v for k, v in attrs if k == "id"]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.faults.append(f"stray </{tag}> at {self.getpos()}")


def _small_page(cases, folder, tell):
    path = folder / "small.html"
    path.write_text(f"<!DOCTYPE html><title>{len(cases)}</title>", encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def light(tmp_path_factory):
    """A report on one hostile case with one figure, on a machine that cannot draw in 3-D."""
    patch = pytest.MonkeyPatch()
    render_probe.probe.cache_clear()
    patch.setattr(render_probe, "_CHILD", "raise SystemExit(3)")
    patch.setattr(figures, "FIGURES", (figures.figure(9),))
    patch.setattr(figures, "NUMBERS", (9,))
    patch.setattr(chapters, "CHAPTERS", ())
    patch.setattr(report, "PAGES", (("What it costs <b>", "in time", _small_page), ("Nothing", "here", lambda cases, folder, tell: None)))
    patch.setattr(report, "SURFACE_SHAPE", (10, 21))
    patch.setattr(report, "audited", lambda: audited("charged-axisymmetric", "13"))
    folder = tmp_path_factory.mktemp("light")
    text = (CASES / "minor-axis-100.toml").read_text(encoding="utf-8")
    hostile = folder / "hostile.toml"
    hostile.write_text(re.sub(r'(?m)^title = .*$', lambda m: f"title = '{HOSTILE}'", text), encoding="utf-8")
    try:
        return report.write([hostile], folder / "report")
    finally:
        patch.undo()
        render_probe.probe.cache_clear()


def test_the_report_is_well_formed_and_every_link_leads_to_a_file(light):
    page = Page(light.read_text(encoding="utf-8"))
    assert page.faults == [] and len(page.ids) == len(set(page.ids))
    for link in page.links:
        assert not re.match(r"(https?:)?//", link), link
        if link.startswith("#"):
            assert link[1:] in page.ids
        elif not link.startswith("data:"):
            file, _, place = link.partition("#")
            assert (light.parent / file).is_file(), link
            assert not place or place in Page((light.parent / file).read_text(encoding="utf-8")).ids, link


def test_a_hostile_title_is_text(light):
    text = light.read_text(encoding="utf-8")
    assert Page(text).scripts == 1 and "<script>alert" not in text and "&lt;script&gt;alert(" in text


def test_pages_that_were_made_are_linked_and_the_others_left_out(light):
    html = light.read_text(encoding="utf-8")
    assert '<a href="small.html">What it costs &lt;b&gt;</a>: in time.' in html and "Nothing" not in html
    assert (light.parent / "small.html").read_text(encoding="utf-8").endswith("<title>1</title>")
    assert [title for title, _, _ in report.PAGES] == ["What accuracy costs", "How cost grows", "What each effect costs"]


def test_without_gl_the_report_says_so_and_has_the_meshes(light):
    text = light.read_text(encoding="utf-8")
    assert "apt install libegl1 libgl1-mesa-dri" in text
    assert {p.suffix for p in (light.parent / "surfaces").iterdir()} == {".vtp", ".glb", ".stl"}


def test_the_report_names_fate_equations_audit_and_versions(light):
    text = light.read_text(encoding="utf-8")
    for words in ("bounded", "x1&#39; = ", "Printed formulas", stabilab.__version__, "Table 4", "stabilab classify"):
        assert words in text, words
    assert "(not confirmed)" not in text


def test_nothing_is_left_beside_the_report(light):
    assert {p.name for p in light.parent.parent.iterdir()} == {"report", "hostile.toml"}


def test_a_fault_in_a_case_writes_nothing(tmp_path):
    bad = tmp_path / "bad.toml"
    bad.write_text("[body]\ninertia = [1, 2, -3]\n")
    with pytest.raises(stabilab.errors.CaseError):
        report.write([bad], tmp_path / "report")
    assert {p.name for p in tmp_path.iterdir()} == {"bad.toml"}


def test_without_the_viewers_package_the_report_has_its_pictures_and_names_it(tmp_path, monkeypatch):
    from stabilab.show.surface import write as surface
    monkeypatch.setitem(sys.modules, "trame_vtk", None)
    monkeypatch.setattr(render_probe, "probe", lambda: render_probe.Renderer(True, "a renderer"))
    monkeypatch.setattr(surface, "draw", lambda scene, found, meshes, path: path)
    monkeypatch.setattr(report, "SURFACE_SHAPE", (10, 21))
    (entry,), note = report._surfaces([stabilab.load(CASES / "minor-axis-100.toml")], tmp_path, lambda words: None)
    assert entry["still"] and entry["scene"] is None and "pip install trame-pyvista" in note


def _visit(page: Path, shot: Path):
    """Open a page in headless Chromium with its software renderer; returns the console's lines."""
    run = subprocess.run(
        [CHROMIUM, "--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
         "--allow-file-access-from-files", "--window-size=900,700", "--virtual-time-budget=20000", "--enable-logging=stderr",
         f"--user-data-dir={shot.parent / 'profile'}", f"--screenshot={shot}", page.as_uri()],
        capture_output=True, text=True, timeout=240)
    return [line for line in run.stderr.splitlines() if "CONSOLE" in line]


def _troubles(console):
    return [line for line in console if re.search(r"error|exception|refused|failed|not found", line, re.I)]


@pytest.mark.slow
@pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed")
def test_the_report_opens_in_a_browser_and_its_scene_draws(tmp_path, monkeypatch):
    from PIL import Image
    if not render_probe.probe().available:
        pytest.skip("no renderer on this machine")

    monkeypatch.setattr(figures, "FIGURES", (figures.figure(9),))
    monkeypatch.setattr(figures, "NUMBERS", (9,))
    monkeypatch.setattr(chapters, "CHAPTERS", ())
    monkeypatch.setattr(report, "PAGES", ())
    def no_network(*_):
        raise AssertionError("the report reached for the network")
    for call in ("connect", "bind"):
        monkeypatch.setattr(f"socket.socket.{call}", no_network)
    index = report.write([CASES / "minor-axis-100.toml"], tmp_path / "report")
    assert _troubles(_visit(index, tmp_path / "index.png")) == []
    scene = index.parent / "surfaces" / "minor-axis-100.html"
    assert _troubles(_visit(scene, tmp_path / "scene.png")) == []
    text = scene.read_text(encoding="utf-8")
    assert "Content-Security-Policy" in text and not re.search(r"""["'`]https?://(?!www\.w3\.org/)[\w-]+\.""", text)
    pixels = np.asarray(Image.open(tmp_path / "scene.png").convert("RGB")).reshape(-1, 3)
    coloured = np.ptp(pixels.astype(int), axis=1) > 40  # the sheets are coloured, the ground is white
    assert 0.02 < coloured.mean() < 0.9


def test_a_top_has_its_fate_and_no_problem_in_the_report(tmp_path):
    """Its state has the vertical too: bounded by the energy (|gamma| = 1 bounds the potential)."""
    from stabilab.case.read import load
    from stabilab.show.report.report import _section
    section = _section(load(CASES / "top-fast.toml"), tmp_path, lambda words: None)
    assert section["fate"] == "bounded" and not section["problem"] and (tmp_path / section["picture"]["file"]).exists()
