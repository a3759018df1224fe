"""The report as a reader meets it: whole, from disk, without a network."""
import base64
import re
import shutil
import subprocess
from contextlib import contextmanager
from dataclasses import replace
from html import unescape as html_text
from html.parser import HTMLParser
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import stabilab
from stabilab.papers import report
from stabilab.papers.audit import findings_of
from stabilab.papers.audit import page as audit_page
from stabilab.papers.figures import catalogue as figures
from stabilab.physics.law_limits import Validity
from stabilab.show import manifest, render_probe, style
from stabilab.show.report import html, own
from stabilab.show.text.headline import exceeded
from stabilab.show.units import SI
from tests.shared import CASES

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
HOSTILE = '<script>alert("title")</script> & "more"'
VOID = {"meta", "link", "img", "br", "hr", "input", "source"}
SWEEP = """
title = "two torques"
[body]
inertia = [3, 2, 1]
[effects.constant_torque]
torque = [0, 0, 0.1]
[motion]
angular_velocity = [0.1, 0.2, 0.3]
span = [0, 5]
[sweep]
"effects.constant_torque.torque" = [[0, 0, 0.1], [0, 0, 0.2], [0.1, 0, 0]]
"""


class Page(HTMLParser):
    """Collects tags, checks nesting, and lists what the page loads and where it leads."""

    def __init__(self, text):
        super().__init__()
        self.open, self.faults, self.links, self.loads, self.scripts, self.ids = [], [], [], [], 0, []
        self.feed(text)
        self.faults += [f"never closed: {tag}" for tag in self.open]

    def handle_starttag(self, tag, attrs):
        self.scripts += tag == "script" and ("type", "application/json") not in attrs
        self.links += [v for k, v in attrs if k in ("src", "srcset", "href")]
        self.loads += [v for k, v in attrs if k in ("src", "srcset", "data", "poster", "action") or k == "href"
                       and tag != "a"]
        self.ids += [v for k, v in attrs if k == "id"]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            self.faults.append(f"stray </{tag}> at {self.getpos()}")


def _small_page(cases, folder, **around):
    path = folder / "small.html"
    path.write_text(f"<!DOCTYPE html><title>{len(cases)}</title>", encoding="utf-8")
    return path


def _no_gl(patch):
    render_probe.probe.cache_clear()
    patch.setattr(render_probe, "_CHILD", "raise SystemExit(3)")
    patch.setattr(own, "SHAPE", (10, 21))


@pytest.fixture(scope="module")
def hostile(tmp_path_factory):
    """A case whose title would be a script."""
    text = (CASES / "minor-axis-100.toml").read_text(encoding="utf-8")
    path = tmp_path_factory.mktemp("hostile") / "hostile.toml"
    path.write_text(re.sub(r'(?m)^title = .*$', lambda m: f"title = '{HOSTILE}'", text), encoding="utf-8")
    return path


def _written(tmp_path_factory, name, *arguments, alike=False, **options):
    """alike: nothing is patched, because other processes that take part would not know of it."""
    patch = pytest.MonkeyPatch()
    if not alike:
        _no_gl(patch)
    try:
        return report.write(*arguments, out=tmp_path_factory.mktemp(name) / "report", **options)
    finally:
        patch.undo()
        render_probe.probe.cache_clear()


@pytest.fixture(scope="module")
def alone(tmp_path_factory, hostile):
    """A report on one hostile case, with its certificate, on a machine that cannot draw in 3-D."""
    return _written(tmp_path_factory, "alone", [hostile], certify=True, workers=1)


@pytest.fixture(scope="module")
def several(tmp_path_factory):
    """A report on a case and a sweep, by two processes."""
    sweep = tmp_path_factory.mktemp("sweep") / "torques.toml"
    sweep.write_text(SWEEP)
    cases = [CASES / "symmetric-body.toml", sweep]
    return _written(tmp_path_factory, "several", cases, workers=2, alike=True), cases


@contextmanager
def _of_little():
    """One figure of one paper, one equation in the audit, one page of costs."""
    patch = pytest.MonkeyPatch()
    patch.setattr(figures, "FIGURES", (figures.figure(9),))
    patch.setattr(figures, "NUMBERS", (9,))
    patch.setattr(report, "CHAPTERS", ())
    patch.setattr(report, "COSTS", (("What it costs <b>", "in time", _small_page),
                                   ("Nothing", "here", lambda cases, folder, **around: None)))
    patch.setattr(report, "audited_papers", lambda: ("constant-torque-gyrostat", "charged-axisymmetric-short"))
    patch.setattr("stabilab.papers.audit.findings_of", lambda name: findings_of(name, "13"))
    try:
        yield
    finally:
        patch.undo()


@pytest.fixture(scope="module")
def everything(tmp_path_factory, hostile):
    """The whole of little."""
    with _of_little():
        return _written(tmp_path_factory, "everything", [hostile], papers=True, precision=True, workers=1)


def test_a_list_of_cases_says_by_how_much_a_law_is_left_and_a_law_that_holds_is_not_told():
    law = Validity("charge", "change of cos σ, held constant, with the attitude", 1.86, 1e-5, False,
                   "along the run", "the z axis turns away", "a source")
    case = SimpleNamespace(path="a.toml", variant="")
    beyond = exceeded([(case, law)], SI)
    assert beyond == ("BEYOND THE LAW: charge: change of cos σ, held constant, with the attitude, "
                      "1.86 along the run, limit 1e-05")
    assert exceeded([(case, None), (case, replace(law, value=1e-6, holds=True))], SI) == ""
    made = {"case": {"title": "a <b>", "headline": "BOUNDED for ever", "look": "bounded", "badge": "bounded",
                     "thumbnail": None, "exceeded": "", "caveats": []}}
    assert own.listed("one", made)["beyond"] == ""
    rows = [own.listed("one", made), own.listed("two", {"case": made["case"] | {"exceeded": beyond}})]
    text = html.render("list.html", title="", groups=[{"title": "", "rows": rows}], extra=(), command="",
                       versions=())
    assert text.count('class="beyond"') == 1 and "limit 1e-05<" in text
    assert text.count('<b class="badge bounded">bounded</b>') == 2 and "<strong>a &lt;b&gt;</strong>" in text


@pytest.mark.parametrize("fate, strict, code",
                         [("undecided", True, 3), ("undecided", False, 0), ("bounded", True, 0)])
def test_a_strict_report_leaves_with_3_where_a_fate_is_undecided(fate, strict, code, monkeypatch, tmp_path,
                                                                 capsys):
    import typer

    from stabilab.commands import papers as command
    made = {"fate": fate, "path": "a.toml", "title": "", "headline": "", "law": ""}
    monkeypatch.setattr(own.one_case, "sections", lambda *_: made)
    monkeypatch.setattr(own, "surface_of", lambda *_: None)
    monkeypatch.setattr(own, "write", lambda made, place, prefix, **around: place.write_text("") and place)
    monkeypatch.setattr(command, "sys", type("_", (), {"argv": ["stabilab", "report"]}))
    try:
        command.report([CASES / "symmetric-body.toml"], tmp_path / "report", False, False, False, 1, strict)
        left = 0
    except typer.Exit as end:
        left = end.exit_code
    assert left == code and capsys.readouterr().out.strip().endswith("index.html")


def _pages(index):
    made = sorted(page for page in index.parent.rglob("*.html") if page.name != "small.html"
                  and page.parent.name != "tables")
    return {page: page.read_text(encoding="utf-8") for page in made}


@pytest.fixture(scope="module")
def pages(alone, several, everything):
    """Every page of all three."""
    return _pages(alone) | _pages(several[0]) | _pages(everything)


def test_every_page_is_well_formed_and_every_link_leads_to_a_file(pages):
    assert len(pages) >= 12
    for path, text in pages.items():
        page = Page(text)
        assert page.faults == [] and len(page.ids) == len(set(page.ids)), path
        for link in page.links:
            file, _, place = link.partition("#")
            if link.startswith("#"):
                assert link[1:] in page.ids, (path, link)
            elif not re.match(r"data:|https://(github\.com|doi\.org|smallsats\.org)/", link):
                assert (path.parent / file).is_file(), (path, link)
                assert not place or place in Page((path.parent
                                                   / file).read_text(encoding="utf-8")).ids, (path, link)


def test_no_page_loads_anything_from_a_network(pages):
    """What a page loads is a file beside it; its scripts hold no address at all."""
    for path, text in pages.items():
        assert not [one for one in Page(text).loads if re.match(r"(https?:|wss?:)?//", one)], path
        scripts = "".join(re.findall(r"(?s)<script.*?</script>|<style.*?</style>", text))
        assert not re.search(r"https?:|wss?:|url\(|@import|fetch\(|XMLHttpRequest", scripts), path


def test_numbers_and_names_have_the_minus_of_a_book(pages):
    """Outside of commands and files as they are typed."""
    plain = set()
    for path, text in pages.items():
        shown = re.sub(r"(?s)<(script|style|code|pre)\b.*?</\1>", "", text)
        words = html_text(re.sub(r"<[^>]*>", "\n", shown))
        plain |= {(path.name, one)
                  for one in re.findall(
                      r".{0,30}(?:(?:^|[\s(\[=,])-[\w(]|\de-\d|(?<= \w) - \w\b|\([a-z]-[a-z]\)).{0,20}",
                      words)}
    assert not plain


def test_a_page_is_small(pages):
    """A page opens in a second: half a megabyte at most, pictures come as they are scrolled to."""
    assert all(len(text) < 500_000 for text in pages.values())


def test_a_hostile_title_is_text(pages):
    for path, text in pages.items():
        assert "<script>alert" not in text, path
        assert Page(text).scripts == ("space-data" in text), path  # that which draws the space of the rates
    assert any("&lt;script&gt;alert(" in text for text in pages.values())


def test_a_page_has_four_tiles_one_picture_and_what_would_change_it_and_the_rest_is_folded(alone):
    text = alone.read_text(encoding="utf-8")
    places = [text.index(words) for words in ('class="verdict-line', 'class="tiles"', "<figure>",
                                              'id="sensitivity"', '<details class="section"')]
    assert places == sorted(places) and text[places[1]:places[2]].count("<li>") == 4
    assert text[places[2]:places[4]].count("<figure>") == 1


def test_the_page_of_a_case_has_all_that_applies_to_it(alone):
    text = alone.read_text(encoding="utf-8")
    for words in ("Rates over time", "Phase plane", "Separatrix, equilibria and motion in space",
                  "Equilibria and their stability",
                  "What would change the fate", "Equations of motion", "<math display", "Certificate",
                  "How it was made", stabilab.__version__):
        assert words in text, words
    assert "in scaled variables; for a stuck thruster give the body" in text  # and what does not


def test_the_certificate_of_a_page_is_proved_by_the_other_code(alone):
    from stabilab.verify import verify_file
    assert verify_file(alone.parent / "cases/hostile-certificate.json").status == "proved"
    assert "<b>proved</b>" in alone.read_text(encoding="utf-8")


def test_a_report_on_cases_alone_reads_none_of_the_papers(alone, several, hostile):
    (run,) = manifest.read(alone.parent)
    assert [row["path"] for row in run["inputs"]] == [str(hostile)]
    assert not any(page.name in ("audit.html", "constant-torque.html")
                   for page in several[0].parent.iterdir())


def test_a_sweep_is_one_table_with_a_column_for_its_key(several):
    text = (several[0].parent / "cases/torques.html").read_text(encoding="utf-8")
    rows = re.findall(r"(?s)<tr[^>]*>(.*?)</tr>", text)
    assert 'id="torques-' in text  # of a row, to which figures lead
    assert "<th>torque[1] (N m)</th><th>torque[3] (N m)</th><th>fate</th>" in rows[0] and len(rows) == 4
    assert "each of 3 " in text and text.count("<img") == 1
    shown = [re.findall(r'<td class="nowrap">(.*?)</td>', row) for row in rows[1:]]
    # the components that the file varies, of its three torques
    assert shown == [["0", "0.1"], ["0", "0.2"], ["0.1", "0"]]


@pytest.mark.slow
def test_any_number_of_workers_gives_the_same_bytes(several, tmp_path_factory):
    made, cases = several
    again = _written(tmp_path_factory, "again", cases, workers=1, alike=True)
    first, second = ({row["path"]: row["sha256"] for row in manifest.read(index.parent)[0]["outputs"]}
                     for index in (made, again))
    assert first == second and len(first) > 10


def test_cases_of_one_name_have_pages_of_their_own(tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    for folder in "ab":
        shutil.copy(CASES / "symmetric-body.toml", tmp_path / folder / "one.toml")
    cases = report.of_all([tmp_path / "a/one.toml", tmp_path / "b/one.toml"])
    assert [stem for stem, _ in own.entries(cases)] == ["one", "one_2"]


@pytest.mark.parametrize("name, title", [
    ("minor-axis-100", "Constant torque along a principal axis"),
    ("off-axis-two", "Constant torque in another direction"), ("torque-free-body", "No torque"),
    ("upper-stage", "Spacecraft with thrusters"), ("charged-body", "A charge in a magnetic field"),
    ("liquid-base", "A cavity of viscous liquid"),
    ("top-fast", "Weight and field: tops")])
def test_cases_stand_in_groups_by_their_effects(name, title):
    assert report.group(stabilab.load(CASES / f"{name}.toml")) == title


def test_a_report_needs_no_renderer_and_brings_the_meshes(alone):
    """The fixtures are made where nothing can be drawn in 3-D: the page draws its space by itself, in the
    reader's browser."""
    assert "space-data" in alone.read_text(encoding="utf-8")
    assert {p.suffix for p in (alone.parent / "cases").iterdir()} == {".vtp", ".glb", ".png", ".json"}


def test_nothing_is_left_beside_the_report(alone):
    assert {p.name for p in alone.parent.parent.iterdir()} == {"report"}
    assert {p.name for p in alone.parent.iterdir()} == {"cases", "index.html", "manifest.json"}


def test_a_fault_in_a_case_writes_nothing(tmp_path, case_file):
    bad = case_file("[body]\ninertia = [1, 2, -3]\n", "bad")
    with pytest.raises(stabilab.errors.CaseError):
        report.write([bad], tmp_path / "report")
    assert {p.name for p in tmp_path.iterdir()} == {"bad.toml"}


def _visit(page: Path, shot: Path, width=900, place=""):
    """Open a page at an anchor in headless Chromium with its software renderer; returns the console's lines."""
    run = subprocess.run(
        [CHROMIUM, "--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
         "--enable-unsafe-swiftshader",
         "--allow-file-access-from-files", f"--window-size={width},5000", "--virtual-time-budget=20000",
         "--enable-logging=stderr",
         f"--user-data-dir={shot.parent / 'profile'}", f"--screenshot={shot}", page.as_uri() + place],
        capture_output=True, text=True, timeout=240)
    return [line for line in run.stderr.splitlines() if "CONSOLE" in line]


@pytest.mark.slow
@pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed")
def test_the_space_of_the_rates_draws_in_a_browser(tmp_path):
    from PIL import Image
    index = report.write([CASES / "minor-axis-100.toml"], tmp_path / "report")
    assert _visit(index, tmp_path / "page.png", place="#space") == []  # which unfolds its section
    pixels = np.asarray(Image.open(tmp_path / "page.png").convert("RGB")).reshape(-1, 3).astype(int)
    # of the motion, in some light, and let through by the white behind it: neither changes the hue
    violet = np.array([int(style.VIOLET[n:n + 2], 16) for n in (1, 3, 5)])
    hues, hue = pixels - pixels.min(axis=1, keepdims=True), violet - violet.min()
    share = hues @ hue / (np.linalg.norm(hues, axis=1) * np.linalg.norm(hue) + 1e-9)
    coloured = (share > 0.997) & (np.ptp(pixels, axis=1) > 40) & (pixels.min(axis=1) > 40)
    assert coloured.sum() > 1500  # its line has twice as many, the one in the legend a hundred


@pytest.mark.slow
def test_the_start_page_has_the_two_lines_of_the_page_of_its_case(tmp_path):
    """That of the spacecraft whose thruster is stuck."""
    with _of_little():
        index = report.write([CASES / "minor-axis-100.toml", CASES / "cubesat-3u.toml"], tmp_path / "report",
                             papers=True, workers=1)
    (lines,) = re.findall(r'<p class="verdict-line.*?</p>', index.read_text(encoding="utf-8"), re.DOTALL)
    assert '<span class="below">' in lines
    assert lines in (index.parent / "cases/cubesat-3u.html").read_text(encoding="utf-8")


def test_cases_are_cards_with_a_picture_a_badge_and_one_line(several, everything):
    from PIL import Image
    for index, number in ((several[0], 2), (everything.parent / "cases.html", 1), (everything, 1)):
        text = index.read_text(encoding="utf-8")
        cards = re.findall(r'<li><a href="(cases/.*?)"><img src="(.*?)" width="240" height="135" .*?'
                           r'<b class="badge (.*?)">(.*?)</b>.*?<span class="line">(.+?)</span>', text)
        assert len(cards) == number, index
        for page, picture, look, badge, line in cards:
            assert (index.parent / page).exists() and badge and len(html_text(line)) <= 110
            assert look in (*style.LOOK, "") and Image.open(index.parent / picture).size == (480, 270)


def test_every_picture_of_a_page_has_a_narrow_one_for_telephones(several, alone):
    from PIL import Image
    for page in [*_pages(several[0]), alone]:
        text = page.read_text(encoding="utf-8")
        narrow = re.findall(r'<source media="\(max-width: 36rem\)" srcset="(.*?)" width="(\d+)" height="(\d+)">', text)
        assert len(narrow) == text.count('<img class="drawn"') == text.count("</picture>")
        for file, width, height in narrow:
            assert Image.open(page.parent / file).size == (int(width), int(height)) and int(width) == 441


@pytest.mark.slow
@pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed")
@pytest.mark.parametrize("name", ["minor-axis-100", pytest.param("geostationary-22n", marks=pytest.mark.long)])
def test_a_case_prints_on_at_most_five_pages_with_its_first_picture_on_the_first(name, tmp_path):
    """Of a page with everything that a page alone has; Chromium sets it on sheets of A4."""
    from tests.browser import Browser
    index = report.write([CASES / f"{name}.toml"], tmp_path / "report")
    with Browser(tmp_path / "profile", 1000, 900) as browser:
        browser.open(index.as_uri())
        browser.until("document.readyState == 'complete'")
        printed = base64.b64decode(browser.ask("Page.printToPDF", paperWidth=8.27, paperHeight=11.69)["data"])
        assert 2 <= len(re.findall(rb"/Type\s*/Page\b", printed)) <= 5
        browser.ask("Emulation.setEmulatedMedia", media="print")
        browser.size(718, 1000)  # pixels of a sheet's width between margins of 12 mm
        bottom, turns = browser.run("[document.querySelector('figure img').getBoundingClientRect().bottom, "
                                    "document.body.innerText.includes('Drag to turn')]")
        assert bottom < 1030 and not turns  # of 1031 of a sheet's height
        cut = browser.run("[...document.querySelectorAll('math[display=block]')].filter(one => "
                          "one.getBoundingClientRect().width && one.scrollWidth > one.clientWidth + 1).length")
        assert cut == 0


@pytest.mark.slow
@pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed")
def test_no_page_is_wider_than_a_telephone(several, everything, tmp_path):
    """The browser tells, after its layout, how wide each page is: a frame of 400 pixels that does not scroll
    sideways."""
    for number, page in enumerate([*_pages(several[0]), *_pages(everything)]):
        frame = tmp_path / f"frame-{number}.html"
        frame.write_text(f'<iframe src="{page.as_uri()}" style="width:400px;height:800px;border:0" '
                         f'onload="const d = this.contentDocument.documentElement; '
                         f'console.log(`wide ${{d.scrollWidth}} ${{d.clientWidth}} '
                         f'${{this.contentWindow.innerWidth}}`)"></iframe>', encoding="utf-8")
        (line,) = [line for line in _visit(frame, tmp_path / "shot.png") if "wide " in line]
        scroll, client, frame_itself = map(int, re.search(r"wide (\d+) (\d+) (\d+)", line).groups())
        # a bar to scroll down takes its 15 pixels of the frame, so there is less room, not more
        assert scroll <= client <= frame_itself == 400, page


def test_formulas_of_the_audit_keep_rates_bars_and_squares():
    """A rate as a factor cancels, browsers draw no menclose, and the top's (10) writes the squares of two
    frequencies by one name."""
    from sympy import Function, Symbol, conjugate
    a, b, rate = Symbol("x1"), Symbol("x2"), Function("rate")
    shown = html_text(str(audit_page.mathml(rate(a) / rate(b),
                                            conjugate(Symbol("P1")) + Symbol("ep") + Symbol("Om"), ("Om",))))
    assert shown.count("<mi>d\u209c</mi>") == 2 and "<mover" in shown and "menclose" not in shown
    assert "<mi>\u03b5</mi>" in shown
    assert "<msup><mi>\u03a9</mi><mn>2</mn></msup>" in shown and "<msup>" not in str(
        audit_page.mathml(a, Symbol("Om")))
    assert html_text(str(audit_page.mathml(rate(a, 2), b))).count("<mi>d\u209c</mi>") == 2


def test_letters_of_printed_formulas_are_typeset_whole():
    """A name is a Greek letter, whole or short, or a stem with its index; zeta is no zet with the index a."""
    from html import unescape

    from sympy import Symbol

    for name, letter in {"th": "θ", "ps": "ψ", "ph": "φ", "zeta": "ζ", "Lam": "Λ", "lam3": "λ",
                         "eta": "η"}.items():
        shown = unescape(str(audit_page.mathml(Symbol(name), Symbol("kc"))))
        assert f"<mi>{letter}</mi>" in shown.replace("ϕ",
                                                     "φ") and ("<msub>" in shown.split("<mo>")[0]) == name[
                                                         -1].isdigit(), name
    assert "<mi>k</mi><mi>c</mi>" in shown


@pytest.mark.parametrize("plain, page", [
    ("defines I_omega and mu_j", "defines I<sub>ω</sub> and μ<sub>j</sub>"),
    ("e^(-i r0 t) <b>", "e<sup>−i r0 t</sup> &lt;b&gt;"),
    ("kg m^2 s^-1", "kg m² s<sup>−1</sup>"), ("|H|^2/2 - D_M T", "|H|²/2 − D<sub>M</sub> T"),
    ("(-M2, M1), x = -y >= 0, 3-1-2", "(−M2, M1), x = −y ≥ 0, 3-1-2"),
    ("liquid_cavity in a/x_y.toml", "liquid_cavity in a/x_y.toml")])
def test_indices_and_powers_are_set_as_in_a_book(plain, page):
    assert str(html.book(plain)) == page


@pytest.mark.slow
def test_the_page_of_a_case_is_the_same_alone_and_in_the_report_on_everything(tmp_path, monkeypatch):
    """As text: all between <main> and </main>, but for the folder of its pictures. `_cases` writes those of the
    whole report."""
    case = stabilab.load(CASES / "minor-axis-100.toml")
    around = {"command": f"stabilab report {case.path}", "versions": [("stabilab", "1")], "extra": ()}
    monkeypatch.setattr(own, "done", lambda tasks, *given: [own.section(*task.arguments) for task in tasks])
    (tmp_path / "one").mkdir()
    own.pages([case], tmp_path / "one", None, own.Wanted(deep=False), **around)
    built = own.section("minor-axis-100", [case], tmp_path / "one" / own.FOLDER, own.Wanted(deep=False))
    (tmp_path / "all" / own.FOLDER).mkdir(parents=True)
    report._cases([case], tmp_path / "all", {"case minor-axis-100": built}, [], around | {"command": "make report"})
    main = [re.search("<main.*</main>", path.read_text(encoding="utf-8"), re.S)[0].replace(f"{own.FOLDER}/", "")
            for path in (tmp_path / "one" / "index.html", tmp_path / "all" / own.FOLDER / "minor-axis-100.html")]
    assert main[0] == main[1] and len(main[0]) > 10_000
