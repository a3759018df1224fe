"""Pictures for a telephone, names at the ends of curves, and pictures of cards."""
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.text import Text
from PIL import Image

from stabilab.case.read import load as load_file
from stabilab.show import narrow, precision_overview, style
from stabilab.show.picture_kinds import KINDS
from stabilab.show.plot import thumbnail, to_file
from stabilab.show.plot.subject import subject
from stabilab.show.text.headline import look
from tests.shared import CASES

PHONE = 400 - 2 * 0.8 * 16  # pixels: a telephone less the margins of a page (main in head.html)
PAIRS = [("minor-axis-100", "phase"), ("geostationary-22n", "body"), ("minor-axis-100", "potential"),
         ("charged-body", "state"), ("minor-axis-100", "time"), ("minor-axis-100", "sphere"),
         ("minor-axis-100", "equilibria"), ("minor-axis-100", "body"), ("geostationary-22n", "time"),
         ("geostationary-22n", "tilt"), ("geostationary-22n", "wheel"), ("liquid-sensible", "time"), ("dual-spin-damper", "nutation"),
         ("top-fast", "state"), ("torque-free-gyrostat", "equilibria"), ("uncertain-minor-axis", "time")]


def load(name):
    return load_file(CASES / f"{name}.toml")


def small_letters(figure):
    """Words with letters below 9 px where the picture is as wide as a telephone."""
    share = PHONE / (figure.get_figwidth() * 72)  # pixels a point
    return [text.get_text() for text in figure.findobj(Text)
            if text.get_text().strip() and text.get_visible() and text.get_fontsize() * share < 9.0]


def edges_are_free(path):
    grey = np.asarray(Image.open(path).convert("L"))
    return min(grey[:, :2].min(), grey[:, -2:].min(), grey[:2].min(), grey[-2:].min()) > 200


@pytest.mark.first(2, 12)
@pytest.mark.parametrize("name, kind", PAIRS)
def test_no_letter_of_a_narrow_picture_is_below_nine_pixels_and_nothing_is_cut_off(name, kind, tmp_path,
                                                                                  monkeypatch):
    drawn, save = [], narrow.save
    monkeypatch.setattr(narrow, "save", lambda figure, *rest: (drawn.append(figure), save(figure, *rest))[1])
    to_file.write_all(load(name), tmp_path / "wide.png", kind, KINDS[kind].page.size,
                      narrow=tmp_path / "narrow.png", titled=KINDS[kind].page.titled)
    assert len(drawn[0].axes[0].get_title().splitlines()) <= 2
    assert small_letters(drawn[0]) == [] and edges_are_free(tmp_path / "narrow.png")
    assert Image.open(tmp_path / "narrow.png").width == int(narrow.WIDTH * narrow.DPI)


def test_panels_stand_below_each_other_and_each_has_what_it_shared():
    with style.drawing() as plt:
        figure, axes = plt.subplots(2, 2, layout="constrained", sharex="col", sharey="row")
        for ax in axes.flat:
            ax.label_outer()
        for ax, title in zip(axes[0], ("first", "second")):
            ax.set_title(title)
        for ax, label in zip(axes[:, 0], ("height", "rate")):
            ax.set_ylabel(label)
        for ax, label in zip(axes[1], ("time", "angle")):
            ax.set_xlabel(label, fontsize=5)
        figure.suptitle("said by the page")
        style.legend(figure, [("a name so long that it takes more than one line " * 2, {"color": "k"})])
        narrow.narrowed(figure)
        figure.draw_without_rendering()
        boxes = [ax.get_position() for ax in axes.flat]
        assert all(below.y1 < above.y0 for above, below in zip(boxes, boxes[1:]))
        assert [(ax.get_title(), ax.get_ylabel(), ax.get_xlabel()) for ax in axes.flat] == [
            ("first", "height", "time"), ("second", "height", "angle"),
            ("first", "rate", "time"), ("second", "rate", "angle")]
        assert all(label.get_visible() for ax in axes.flat
                   for label in ax.get_xticklabels() + ax.get_yticklabels())
        assert figure.get_suptitle() == "" and small_letters(figure) == []
        assert figure.legends[0].get_window_extent().width <= figure.bbox.width


def test_areas_of_a_picture_of_few_colours_have_their_own(tmp_path):
    """By hand: forty greys beside each other, each six levels from the next and 1/40 of the picture."""
    greys = np.repeat(np.arange(40) * 6 + 10, 10).astype(np.uint8)
    with style.drawing() as plt:
        figure = plt.figure(figsize=(4, 1), dpi=100)
        figure.figimage(np.repeat(np.tile(greys, (100, 1))[..., None], 3, axis=2))
        path = style.save(figure, tmp_path / "a.png", 100, 32)
    drawn = np.asarray(Image.open(path).convert("RGB")).astype(int)
    assert np.abs(drawn - greys[None, :, None]).max() <= style.APART


@pytest.mark.parametrize("scale, power", [(1.0, ""), (1e-7, "10^{−7}")])
def test_numbers_at_ticks_are_text_and_a_power_of_ten_is_a_formula(scale, power, tmp_path):
    with style.drawing() as plt:
        figure, ax = plt.subplots()
        ax.plot([0.0, 1.0], [0.0, 3 * scale])
        style.save(figure, tmp_path / "a.png")
        assert [text.get_text() for text in ax.get_yticklabels()][:3] == ["−0.5", "0.0", "0.5"]
        assert power in ax.yaxis.get_offset_text().get_text()


@pytest.mark.parametrize("offset", [True, False])
def test_numbers_at_ticks_have_an_offset_only_where_the_picture_allows_one(offset, tmp_path):
    with style.drawing() as plt:
        figure, ax = plt.subplots()
        ax.plot([0.0, 1.0], [178.8493, 178.8513])
        ax.ticklabel_format(axis="y", useOffset=offset)
        style.save(figure, tmp_path / "a.png")
        labels = [float(text.get_text()) for text in ax.get_yticklabels()]
        assert (ax.yaxis.get_offset_text().get_text() != "") == offset
        assert all((label > 178) != offset for label in labels)


CURVES = {  # one ends on another, two end at one point, one is a single point
    "taylor": [(3.0, 1e-5, 0.3), (14.0, 1e-4, 0.3)], "RK45": [(0.5, 2e-3, 0.3), (4.0, 1e-2, 0.3)],
    "DOP853": [(1.0, 3e-3, 0.3), (8.0, 2e-2, 0.31)], "reduced": [(1.0, 3e-3, 4e-3), (8.0, 2e-2, 4e-3)],
    "reference": [(30.0, 0.9, 0.9)]}


@pytest.mark.parametrize("narrowed", [False, True])
def test_names_at_the_ends_of_curves_cover_no_curve_and_no_other_name(narrowed, tmp_path, monkeypatch):
    monkeypatch.setattr(precision_overview, "drawn", lambda result: CURVES)
    monkeypatch.setattr(precision_overview, "headline", lambda result: "case: 12 digits\nfirst run: 12 digits")
    figures = []
    monkeypatch.setattr(style, "save", lambda figure, path, *rest, **more: (figures.append(figure), path)[1])
    result = SimpleNamespace(case=SimpleNamespace(name="case"))
    with style.drawing():
        precision_overview.write_both(result, tmp_path / "x.png")
        ax = figures[narrowed].axes[0]
        figures[narrowed].draw_without_rendering()
        names = [text for text in ax.texts if text.get_text()]
        boxes = [text.get_window_extent() for text in names]
        assert len(names) == len(CURVES) + 2
        assert not any(box.overlaps(other) for n, box in enumerate(boxes) for other in boxes[:n])
        curves = [line for line in ax.get_lines() if len(line.get_xydata()) > 1 and line.get_zorder() > 1]
        assert len(curves) == 8
        for line in curves:  # its points on the screen, 2000 of each curve
            points = ax.transData.transform(line.get_xydata())
            fine = np.linspace(points[0], points[1], 2000)
            inside = [((fine > box.min) & (fine < box.max)).all(axis=1).any() for box in boxes]
            assert not any(inside), line
        assert all(ax.bbox.x0 <= box.x0 and box.x1 <= ax.bbox.x1 for box in boxes)


@pytest.mark.parametrize("name, limit", [("geostationary-22n", True), ("torque-free-body", False)])
def test_a_card_has_curve_and_limit_no_title_and_letters_that_are_read(name, limit, tmp_path, monkeypatch):
    figures, save = [], style.save
    monkeypatch.setattr(style, "save", lambda figure, *rest: (figures.append(figure), save(figure, *rest))[1])
    item = subject(load(name))
    path = thumbnail.write([(item, look(item.motion))], tmp_path / "card.png")
    (ax,) = figures[0].axes
    assert Image.open(path).size == (480, 270) and path.stat().st_size < 10_000 and ax.get_title() == ""
    lines = ax.get_lines()
    assert len(lines) == 1 + limit and lines[0].get_color() == style.LOOK[look(item.motion)]
    low, high = ax.get_ylim()
    assert all(low <= min(line.get_ydata()) and max(line.get_ydata()) < high for line in lines)
    sizes = [text.get_fontsize() for text in figures[0].findobj(Text) if text.get_text()]
    assert min(sizes) * 240 / (thumbnail.SIZE[0] * 72) >= 9  # pixels, of a card 240 wide
