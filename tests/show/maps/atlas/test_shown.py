"""An atlas in words, files, pictures and on a page."""
from __future__ import annotations

import csv
import io
import json

import numpy as np
import pytest

import stabilab
from stabilab.case.read import read_text
from stabilab.errors import InputError
from stabilab.maps.atlas import asked, drawn
from stabilab.show.maps import atlas as atlas_words
from stabilab.show.maps import atlas_picture, to_file
from stabilab.show.units import DEG
from tests.browser import CHROMIUM, Browser
from tests.maps.atlas.test_atlas import case_of

xarray = pytest.importorskip("xarray")
REST = """[[thrusters]]
name = "A <1>"
position = [1, 0, 0]
direction = [0, 0, 1]
force = "0.5 N"
[limits]
rate = "90 deg/s"
"""
TITLE = 'title = "A body of three moments"\n'


@pytest.fixture(scope="module")
def found():
    case = case_of(wheel=(0.0, 0.2, 0.0), start=(0.3, -0.2, 0.5), rest=REST)
    case = read_text("body.toml", TITLE + case.text.replace("[body]", "[body]\ncentre_of_mass = [0, 0, 0]"))
    with drawn(asked(case, level=0, refine=1, wheel="0, 0.2"), workers=1) as atlas:
        return atlas


def test_the_first_line_has_shares_of_the_sphere_and_the_shortest_time(found):
    first, *rest = atlas_words.text(found, DEG).splitlines()
    shares = {}
    for axis, share in zip(found.records["spin_axis"].tolist(), found.share.tolist()):
        shares[abs(axis)] = shares.get(abs(axis), 0) + share / 2  # two wheels
    for axis, name in ((1, "x (major axis)"), (3, "z (minor axis)")):
        assert f"{100 * shares[axis]:.0f} %" in first and f"about {name}" in first
    assert f"shortest time to 90 deg/s: {found.records['when_low'].min():.4g} s at direction (" in first
    assert any(line.startswith("  wheel 0.2 N m s: ")
               for line in rest) and any("thruster A <1>, direction (0, -1, 0)" in line for line in rest)


def test_json_and_csv_hold_every_cell(found):
    told = json.loads(atlas_words.json(found, DEG))
    assert told["schema"] == "stabilab.atlas/1" and len(told["cells"]["share"]) == len(found.records) == len(
        told["cells"]["direction"])
    assert sum(told["cells"]["share"]) == pytest.approx(2)
    assert sum(one["share"] for one in told["shares"]) == pytest.approx(1)
    rows = list(csv.DictReader(io.StringIO(atlas_words.csv(found))))
    assert len(rows) == len(found.records) + len(found.named)
    assert float(rows[-1]["when_low (s)"]) == found.records["when_low"][-1] and rows[0]["name"] == "+x"


def test_a_file_holds_the_atlas_and_opens_as_a_data_set(found, tmp_path):
    path = to_file.write_atlas(found, tmp_path / "sky.nc", DEG)
    data = xarray.open_dataset(path).load()
    assert data.share.sum() == pytest.approx(2) and data.corners.shape == (len(found.records), 3, 3)
    assert data.when_low.units == "s"
    again = atlas_words.atlas_of(data, path)
    assert atlas_words.text(again, DEG) == atlas_words.text(found, DEG) and to_file.is_atlas(path)
    assert to_file.write_atlas(again, tmp_path / "two.nc", DEG).read_bytes() == path.read_bytes()
    with pytest.raises(InputError, match="was it changed"):
        atlas_words.atlas_of(data.isel(cell=slice(0, 5)), path)


def test_python_gives_the_data_set(tmp_path):
    made = stabilab.atlas(case_of(wheel=(0.0, 0.2, 0.0), start=(0.3, -0.2, 0.5)), level=0, refine=0,
                          out=tmp_path / "sky.nc")
    assert made.sizes["cell"] == 8 and list(made.point.values[:2]) == ["+x", "-x"]
    assert (tmp_path / "sky.nc").is_file() and "when_low" not in made


def test_the_map_keeps_areas_and_comes_back():
    turn, up = np.meshgrid(np.linspace(-3, 3, 41), np.linspace(-1.4, 1.4, 31))
    d = np.stack([np.cos(up) * np.cos(turn), np.cos(up) * np.sin(turn), np.sin(up)], axis=-1).reshape(-1, 3)
    at = atlas_picture.on_map(d)
    back, inside = atlas_picture.off_map(*at.T)
    assert inside.all() and back == pytest.approx(d, abs=1e-12)
    step = 1e-5  # quadrature of one small square: the area of its image is that of the square on the sphere
    for one in d[::97]:
        east = np.cross([0, 0, 1], one) / np.linalg.norm(np.cross([0, 0, 1], one))
        north = np.cross(one, east)
        ends = atlas_picture.on_map(np.stack([one + step * east, one - step * east, one + step * north,
                                       one - step * north]))
        a, b = (ends[0] - ends[1]) / (2 * step), (ends[2] - ends[3]) / (2 * step)
        assert abs(a[0] * b[1] - a[1] * b[0]) == pytest.approx(1, rel=1e-6)


def test_pictures_show_what_is_asked_and_refuse_others(found, tmp_path, monkeypatch):
    monkeypatch.setattr(atlas_picture, "PIXELS", 200)
    sizes = [atlas_picture.write_picture(found, tmp_path / f"{kind}.png", DEG, kind, dpi=50).stat().st_size
             for kind in (None, "equilibria")]
    assert sizes[0] > 1.5 * sizes[1] > 5_000  # two maps for each wheel, and one
    with pytest.raises(InputError, match="plot margin: this atlas has fate, when, equilibria, level"):
        atlas_picture.write_picture(found, tmp_path / "no.png", DEG, "margin")
    with pytest.raises(InputError, match="expected a name that ends in"):
        to_file.checked([tmp_path / "sky.txt"])


def test_the_page_needs_no_network_and_escapes_names(found, tmp_path):
    text = atlas_picture.write_page(found, tmp_path / "sky.html", DEG).read_text(encoding="utf-8")
    assert "http" not in text.replace("http://www.w3.org", "") and "A <1>" not in text.partition("</pre>")[0]


@pytest.mark.parametrize(("least", "most", "marks"), [
    (0.58, 114, [1, 2, 5, 10, 20, 50, 100]), (5.9, 74, [10, 20, 50]), (4.2, 9.1, [5, 6, 7, 8, 9]),
    (3.0, 3.4, [3.0, 3.1, 3.2, 3.3, 3.4]),
    (3.011, 3.012, [3.01]), (1, 1e6, None)])
def test_marks_are_round_and_few(least, most, marks):
    found = atlas_picture._marks(least, most)
    assert found == marks if marks else 4 <= len(found) <= 8 and all(np.log10(found) % 1 == 0)


@pytest.mark.slow
@pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed")
def test_a_narrow_page_has_names_to_be_read_and_a_tap_is_answered(found, tmp_path):
    path = atlas_picture.write_page(found, tmp_path / "sky.html", DEG)
    with Browser(tmp_path / "profile", width=400, flags=["--host-resolver-rules=MAP * ~NOTFOUND"]) as browser:
        browser.open(path.as_uri())
        browser.until("window.atlas")
        shown = browser.run("(() => { const c = document.querySelector('canvas'); "
                            "return c.getContext('2d').font.match(/([\\d.]+)px/)[1] * c.clientWidth / "
                            "c.width; })()")
        assert 11 < shown < 16  # pixels of the page
        browser.run("(() => { const c = document.querySelector('canvas'), r = c.getBoundingClientRect(); "
                    "c.dispatchEvent(new PointerEvent('pointerdown', "
                    "{pointerType: 'touch', pointerId: 1, clientX: r.x + 0.4 * r.width, clientY: r.y + 0.4 * "
                    "r.height})); })()")
        assert "spins up about" in browser.run(
            "document.getElementById('told').innerText") and browser.console == []


@pytest.mark.slow
@pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed")
def test_the_pages_pointer_tells_the_cell_that_python_finds(found, tmp_path):
    from stabilab.maps.pointed import places_of
    path = atlas_picture.write_page(found, tmp_path / "sky.html", DEG)
    directions = np.random.default_rng(3).normal(size=(300, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    own = np.flatnonzero(found.leaves.wheel == 1)
    expected = np.searchsorted(own, found.leaves.holding(1, places_of(directions)))
    with Browser(tmp_path / "profile", flags=["--host-resolver-rules=MAP * ~NOTFOUND"]) as browser:
        browser.open(path.as_uri())
        browser.until("window.atlas")
        assert browser.run(
            f"{json.dumps(directions.tolist())}.map(d => atlas.cellOf(d, 1))") == expected.tolist()
        for globe in ("false", "true"):  # what lies under a pixel is drawn there
            browser.run(f"atlas.set({{globe: {globe}}})")
            seen = browser.run(f"{json.dumps(directions.tolist())}.map(d => [d, "
                               f"atlas.pixelOf(d)]).filter(one => one[1])"
                               ".map(([d, at]) => { const e = atlas.directionAt(...at); return "
                               "Math.hypot(...d.map((v, n) => v - e[n])); })")
            assert len(seen) > 50 and max(seen) < 1e-6
        browser.run("atlas.set({globe: false, wheel: 0})")
        browser.run(
            "document.querySelector('canvas').dispatchEvent(new PointerEvent('pointermove', {clientX: 500, "
            "clientY: 400}))")
        told = browser.run("document.getElementById('told').innerText")
        assert "direction (" in told and "spins up about" in told and "90 deg/s" in told
        assert browser.console == [] and all(address.startswith(("file:", "data:"))
                                             for address in browser.requests)
