"""The page in a real browser: sliders, verdict, surface, clicks and files, and nothing on the console."""
import json
import threading
import time
from urllib.parse import urlsplit

import pytest

from stabilab import load, motion
from stabilab.answers.certificate import certificate
from stabilab.case.read import read_text
from stabilab.show.explore.serve import Explorer
from tests.browser import CHROMIUM, Browser

CASE = "cases/minor-axis-100.toml"
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed")
HEADLINE, ANSWERS = ("document.querySelector('#headline').textContent",
                     "Number(document.documentElement.dataset.answers || 0)")
RESTS = "document.documentElement.dataset.moving === 'false'"
MESH = "JSON.stringify(shown.space.branches.map(s => Array.from(s.at.slice(0, 3000))))"


@pytest.fixture(scope="module")
def server():
    with Explorer(load(CASE)) as one:
        threading.Thread(target=one.serve_forever, daemon=True).start()
        yield one
        one.shutdown()


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    with Browser(tmp_path_factory.mktemp("profile")) as one:
        yield one


@pytest.fixture
def page(server, browser):
    """As it was opened: the button "As in the case" brings it there, and where a test has gone to another
    address, opening it anew does."""
    browser.size(900, 800)
    if browser.run("location.href").split("#")[0] != server.address:
        browser.open(server.address)
        browser.until(f"{ANSWERS} > 0 && {RESTS}")
    elif browser.run("axisTouched || Object.keys(touched).length"):
        next_answer(browser, lambda: browser.run("$('again').click()"))
    yield browser
    assert browser.console == []
    assert {urlsplit(one).netloc for one in browser.requests
            if not one.startswith(("data:", "blob:"))} == {f"127.0.0.1:{server.server_port}"}


def next_answer(page, act):
    """What comes back once the page has rested after an act."""
    before = page.run(ANSWERS)
    act()
    page.until(f"{ANSWERS} > {before} && {RESTS}")
    return page.run(HEADLINE)


def test_a_wrong_token_shows_nothing(server, browser):
    browser.open(f"http://127.0.0.1:{server.server_port}/wrong/")
    assert "lacks the token" in browser.until("document.body.innerText")
    assert all("403" in line for line in browser.console)
    browser.console.clear()


def test_dragging_a_slider_moves_verdict_and_surface_on_the_way(page):
    said, mesh, seen = page.run(HEADLINE), page.run(MESH), set()
    answered = "Number(shown.toml.match(/mu = .*, (\\S+)]/)[1]) === Number(fields.size.field.value)"
    assert said.startswith("Bounded only with torque exactly along x3")
    for _ in page.drag("#size", (0.74, 0.8, 0.88, 0.95)):
        page.until(answered)
        seen.add(page.run(HEADLINE))
    page.until(f"{RESTS} && {answered}")
    assert len(seen) >= 4 and page.run(HEADLINE) not in (said, "") and page.run(MESH) != mesh
    case = read_text("saved.toml", page.run("shown.toml"))
    assert case.scene.mu[2] == page.run("Number(fields.size.field.value)") > 2
    assert motion(case.scene, case.state).fate.word == page.run("shown.fate")


def test_numbers_beside_the_pictures_have_the_minus_of_a_book(page):
    told = page.run(
        "document.querySelector('#facts').textContent + document.querySelector('#equilibria').textContent")
    assert "\u2212" in told and "(-" not in told and " -" not in told


    assert page.run("signed('(3.8619e-05, -1.4176e+12) deg/s')") == "(3.8619 × 10⁻⁵, −1.4176 × 10¹²) deg/s"
    assert " τ" in told and "tau" not in told


def test_every_axis_has_a_scale_and_every_line_is_named(page):
    """A scale takes two numbers; of an axis whose labels have no room for more, the round ones it has are
    kept."""
    spans = [(-42, 42), (-50.1, 49.9), (0, 97), (-1000, 8600), (0, 1e-7), (3.9, 15)]
    told = page.run(
        f"{json.dumps(spans)}.map(([low, high]) => [3, 4, 5].map(n => ticks(low, high, n, () => true)))")
    for (low, high), rows in zip(spans, told):
        assert all(len(marks) >= 3 and min(marks) >= low - 1e-6 and max(marks) <= high + 1e-6
                   for marks in rows)
        assert all(len({round(b - a, 9) for a, b in zip(marks, marks[1:])}) == 1 for marks in rows)
    assert page.run("ticks(-42, 42, 4, () => false)") == [0]
    drawn = page.run("""(() => {
      const told = [], brush = CanvasRenderingContext2D.prototype, real = brush.fillText, made = $("time").cloneNode(); document.body.append(made);
      brush.fillText = function (text, x) { told.push([text, this.textAlign, x, this.measureText(text).width]); real.apply(this, arguments); };
      drawTime(made, {times: [0, 1], rates: [[8000, 34000], [0, 1], [0, 1]], size: [8000, 34000], limits: [], reached: null, x: "time", y: "rate"});
      brush.fillText = real; made.remove();
      return told; })()""")
    # right of the label, which stands upright at 12 and is 12 high
    assert min(x - wide for _, align, x, wide in drawn if align == "right") > 20
    assert "Grey: whole periods" in page.run("$('time-words').textContent")
    assert "black: separatrix" in page.run("$('plane-words').textContent") and "open: saddle" in page.run(
        "$('plane-words').textContent")


def test_a_click_in_the_phase_plane_starts_a_motion(page):
    said = page.run(HEADLINE)
    assert next_answer(page, lambda: page.click("#plane", 0.5, 0.12)) != said
    start = page.run("['start0', 'start1', 'start2'].map(name => Number(fields[name].field.value))")
    assert start != [2.5, 4, 0.1]
    assert read_text("saved.toml", page.run("shown.toml")).state == pytest.approx(start, rel=1e-6)


@pytest.mark.slow
def test_the_phase_plane_is_reached_by_the_keyboard(page):
    page.run("document.querySelector('#plane').focus()")
    for _ in range(3):
        page.key("ArrowUp")
    next_answer(page, lambda: page.key("Enter"))
    assert page.run("Number(fields.start2.field.value)") > 0.2


@pytest.mark.slow
def test_a_click_on_an_equilibrium_starts_there(page):
    place = page.run("""(() => { const best = shown.space.curves.find(c => c.kind.startsWith('stable')), all = Array.from(best.at);
      for (let i = 0; i < all.length; i += 3) { const p = all.slice(i, i + 3).map(v => v / 4095); if (p.every(v => Math.abs(v) < 0.9)) return p; } })()""")
    wanted = page.run(f"{json.dumps(place)}.map((v, k) => shown.space.middle[k] + v * shown.space.half[k])")
    next_answer(page, lambda: page.run(f"view.onpick({json.dumps(wanted)}, 'stable equilibria')"))
    assert page.run("Number(fields.start0.field.value)") == pytest.approx(wanted[0], rel=1e-5, abs=1e-5)
    said = page.run(HEADLINE)
    assert said.startswith(("Bounded", "Steady rotation"))  # beside a centre
    answers = page.run(ANSWERS)
    page.click("#space", 0.5, 0.45)  # a real click, on whatever is drawn in the middle
    time.sleep(0.5)
    assert page.run(ANSWERS) >= answers


def test_the_case_is_saved_as_it_is_seen(page, tmp_path):
    page.ask("Browser.setDownloadBehavior", session=None, behavior="allow", downloadPath=str(tmp_path))
    next_answer(page, lambda: page.run("fields.start1.field.value = '3.25'; fields.start1.field.oninput()"))
    page.click("#save")
    saved = tmp_path / "minor-axis-100-explored.toml"
    for _ in range(100):
        if saved.exists():
            break
        time.sleep(0.05)
    case = load(saved)
    assert case.state == (2.5, 3.25,
                          0.1) and motion(case.scene, case.state).fate.word == page.run("shown.fate")
    assert next_answer(page, lambda: page.click("#again")).startswith("Bounded")
    assert page.run("Object.keys(touched).length") == 0


def test_a_dropped_certificate_is_checked(page):
    case = load(CASE)
    text = json.dumps(certificate(case.scene, case.exact_state))
    page.run(f"void check(new File([{json.dumps(text)}], 'mine.json'))")
    assert page.until("document.querySelector('#checked p').textContent") == "mine.json: proved"


def test_picture_and_sliders_stand_together_on_a_telephone(page):
    page.size(400, 800)
    page.run("scrollTo(0, 0)")
    assert page.run("document.documentElement.scrollWidth") <= 400
    assert page.run(
        "[...document.querySelectorAll('input, select')].every(one => one.labels.length || "
        "one.getAttribute('aria-label'))")
    for tab in ("Rates", "Space", "Phase plane"):
        page.run(f"[...document.querySelectorAll('.tabs button')].find(one => one.textContent === {tab!r}).click()")
        page.run("$('start2').scrollIntoView({block: 'end'})")
        (top, bottom), (_, slider) = page.run(
            "['.picked canvas', '#start2'].map(one => { const box = "
            "document.querySelector(one).getBoundingClientRect(); return [box.top, box.bottom]; })")
        assert 0 < top < bottom < slider <= 800 and page.run("document.querySelectorAll('.picked').length") == 1


def test_a_link_holds_the_state(page, server):
    next_answer(page, lambda: page.run("fields.start0.field.value = '2.25'; fields.start0.field.oninput()"))
    said, link = page.run(HEADLINE), page.run("location.href")
    assert link == f"{server.address}#start0=2.25" and said != page.run("setup.title")
    next_answer(page, lambda: page.click("#again"))
    assert page.run("location.href") == server.address and page.run(HEADLINE) != said
    page.open("about:blank")
    page.open(link)
    page.until(f"{ANSWERS} > 0 && {RESTS}")
    assert page.run(HEADLINE) == said and page.run("touched.start0") == "2.25"


def test_a_link_with_bad_values_is_answered_in_one_message(page, server):
    next_answer(page, lambda: page.run("location.hash = 'start0=x&axis=4&toString=1&mass&start1=3'"))
    words = page.run("$('note').textContent")
    assert words.startswith("Left out of the link: start0=x, axis=4, toString=1, mass; expected a number for any of ")
    assert page.run("[touched.start1, Object.keys(touched).length]") == ["3", 1]
    page.run("location.hash = 'start0=1e200'")  # a number, of no body: the program refuses it
    page.until("$('note').textContent.includes('which can still be drawn, got 1e200')")
    assert page.run("$('headline').classList.contains('stale')")
    next_answer(page, lambda: page.run("location.hash = ''"))
    assert page.run("$('note').hidden")


def test_every_slider_is_reached_by_the_keyboard(page):
    page.run("document.querySelector('.skip').click()")
    assert page.run("document.activeElement.id") == "controls" and page.run("location.hash") == ""
    page.run("document.querySelector('.skip').focus()")
    names = []
    for _ in range(60):
        page.key("Tab")
        names.append(page.run("document.activeElement.id || document.activeElement.tagName"))
        outlined = page.run("getComputedStyle(document.activeElement).outlineStyle !== 'none'")
        assert outlined or names[-1] == "BODY", names[-1]  # the focus is seen
        if names[-1] == "certificate":
            break
    assert set(page.run("Object.keys(fields)")) | {"axis", "save", "again", "copy", "space", "plane"} <= set(names)


def test_the_body_turns_beside_the_curves_and_its_moments_are_on_sliders(tmp_path_factory):
    """A body with a limit: the pointer on the curve stands at the time of the body's picture."""
    with Explorer(load("cases/cubesat-3u.toml")) as server, Browser(tmp_path_factory.mktemp("body")) as page:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        page.open(server.address)
        page.until(f"{ANSWERS} > 0 && {RESTS}")
        page.run("$('at').value = 200; $('at').oninput()")
        t, left = page.run("[shown.film.t[200], parseFloat($('cursor').style.left)]")
        assert left == pytest.approx(page.run(f"timeArt.x({t})") + 1, abs=0.01) and page.run("$('play').textContent") == "Play"
        inked = "stage.getContext('2d').getImageData(0, 0, stage.width, stage.height).data.some(v => v)"
        assert page.run(f"(() => {{ const stage = $('stage'); return {inked}; }})()")
        before = page.run(ANSWERS)
        page.run("fields.inertia2.field.value = '0.2'; fields.inertia2.field.oninput()")
        page.until(f"{ANSWERS} > {before} + 1 && {RESTS}")
        assert "no rigid body has this tensor".capitalize() in page.run("$('note').textContent")
        assert page.run("$('axis')") is None and page.run("'torque3' in fields")  # it is off the axes: x, y, z
        assert page.console == []
        server.shutdown()
