"""The report's chapters on the other papers, their figures and what these say."""
import math
import re
from pathlib import Path

import numpy as np
import pytest

from stabilab.errors import InputError
from stabilab.papers import chapter
from stabilab.papers.families import FAMILIES, sweep
from stabilab.papers.figures import catalogue as figures
from stabilab.papers.figures import charged as figures_charged
from stabilab.papers.figures import panels
from stabilab.papers.figures import top as figures_top
from stabilab.show.report import html

FOLDER = Path(__file__).parents[2] / "figures"
SMALL = 125_000  # bytes: eighteen phase planes with words on cuts above each take 122 kB
OTHERS = [row for name in ("charged", "cavity", "top") for row in figures.of_paper(name)]


def test_every_figure_of_the_other_papers_is_on_record():
    """Galal et al. charged body: Figs 1-24; liquid cavity: 1-13; Amer et al. 2023: 1-7 (Fig. 1 of each is a
    sketch)."""
    for name, last in (("charged", 24), ("cavity", 13), ("top", 7)):
        assert [row.number for row in figures.of_paper(name)] == list(range(1, last + 1))


def test_the_repository_keeps_a_small_picture_and_a_note_of_each():
    for row in OTHERS:
        note = (FOLDER / row.file).with_suffix(".txt").read_text(encoding="utf-8")
        assert (FOLDER / row.file).stat().st_size < SMALL, row.file
        assert row.title in note and row.command in note and "tolerance:" in note
        if row.paper != "cavity":  # whose runs take long: the slow test below draws them
            assert row.caption in note


def test_a_figure_number_without_a_paper_belongs_to_the_constant_torque_paper():
    assert figures.figure(3).paper == "" and figures.figure(3, "top").file == "top-03.png"
    with pytest.raises(InputError, match="figure 8: expected one of 1 to 7"):
        figures.figure(8, "top")
    with pytest.raises(InputError, match="there is none of this name; known are 1 constant-torque-gyrostat or constant-torque; 2 "):
        figures.of_paper("tops")


def test_the_families_are_those_of_the_papers():
    """Values from the captions of the papers' figures, read back from the scenes that are drawn."""
    read = {"charged": {"lambda3": lambda s: s.vector("gyrostat")[2], "e": lambda s: s.effect("charge").charge,
                        "M1": lambda s: s.vector("constant_torque")[0]},
            "cavity": {"small": lambda s: s.vector("gyrostat")[2], "large": lambda s: s.vector("gyrostat")[2],
                       "zeta": lambda s: s.effect("resistance").exact * 100,
                       "M3": lambda s: s.vector("constant_torque")[2] * 100,
                       "e": lambda s: s.effect("charge").charge},
            "top": {"lx": lambda s: s.vector("gyrostat")[0], "lz": lambda s: s.vector("gyrostat")[2]},
            "constant-torque": dict.fromkeys(("figure 8", "figure 12"), lambda s: s.exact_ab[0] * 500)}
    for name in ("zeta", "M3", "e"):  # with the wheel of Fig. 3 that the text's waves need
        read["cavity"][f"{name} waves"] = read["cavity"][name]
        assert {case.scene.vector("gyrostat")[2] for case in FAMILIES["cavity"][f"{name} waves"].members} == {20}
    assert {paper: set(found) for paper, found in FAMILIES.items()} == {
        paper: set(found) for paper, found in read.items()}
    for paper, found in FAMILIES.items():
        for name, family in found.items():
            assert [float(read[paper][name](case.scene)) for case in family.members] == pytest.approx(
                list(family.cases)), (paper, name)


def _column(exact, printed):
    t = np.linspace(0, 10, 101)
    return panels.Column("", {"exact": (t, exact(t)), "printed": (t, printed(t))})


ROW = panels.Row(panels.TIME, "x", lambda run: run)


def test_a_model_that_runs_away_is_cut_and_does_not_flatten_the_exact_motion():
    (_, across), (low, high) = ((0, 10), panels._limits(ROW, [_column(np.sin, np.exp)], 1))
    assert across == 10 and -2 < low < -0.99 and 0.99 < high < 2


@pytest.mark.parametrize("over_time, told",
                         [(True, "cut: from −20 to 22"), (False, "cut: x from −20 to 22, y to 9")])
def test_a_curve_that_leaves_a_panel_on_both_sides_tells_both_ends(over_time, told):
    from stabilab.show import style
    sideways = panels.Row("x", "y", lambda run: (run[1], run[1] * 0 + np.clip(run[1], -0.5, 9)))
    with style.drawing() as plt:
        (figure,) = panels.draw_lines(plt, "",
                                   [(ROW if over_time else sideways,
                                     [_column(np.sin, lambda t: 1 + 21 * np.cos(np.pi * t))])])
        words = [text.get_text() for ax in figure.axes for text in ax.texts]
    assert words == [told]


def test_where_a_printed_curve_leaves_its_panel_it_is_also_shown_whole():
    from stabilab.show import style
    with style.drawing() as plt:
        (cut,) = panels.draw_lines(plt, "", [(ROW, [_column(np.sin, np.exp)])])
        (near,) = panels.draw_lines(plt, "", [(ROW, [_column(np.sin, lambda t: 2 * np.sin(t))])])
        (curve,) = cut.axes[1].lines
        assert len(cut.axes) == 2 and len(near.axes) == 1 and "alone" in cut.axes[1].get_title()
        np.testing.assert_array_equal(curve.get_ydata(), np.exp(np.linspace(0, 10, 101)))
        assert cut.axes[1].get_ylim()[1] > math.exp(10)


def test_printed_curves_of_the_velocity_are_the_printed_formulas():
    from stabilab.theories.charged import body_of, printed
    column = figures_charged._columns("lambda3")[0]
    t, drawn = figures_charged.PANELS["velocity"][1][0].pick(column.runs["printed"])
    np.testing.assert_array_equal(drawn, printed(body_of(sweep("charged-sweep")["-1-2-1"]), t).velocity[:, 0])
    assert {"printed", "corrected", "linear", "exact"} == set(column.runs)


def test_the_small_angles_of_the_charged_body_end_after_two_thirds_of_a_second():
    """By hand: from rest the tilt is M1 t^2/(2 D1) at first, so 0.1 rad comes at sqrt(0.2 D1/M1)."""
    caption = figures.figure(8, "charged").caption
    assert float(re.search(r"0.1 rad is outgrown after ([\d.]+) s",
                           caption)[1]) == pytest.approx(math.sqrt(0.2 * 8.7 / 4), abs=0.006)


def test_the_captions_of_the_charged_body_agree_with_the_exact_motion():
    """The largest r, v and the last eta3 named in the captions, from the runs that are drawn."""
    for number, family, pick in ((2, "lambda3", lambda s: s["omega"][:, 2].max()),
                                 (4, "e", lambda s: s["omega"][:, 2].max()),
                                 (6, "M1", lambda s: s["omega"][:, 2].max()),
                                 (22, "lambda3", lambda s: s["position"][-1, 2]),
                                 (23, "e", lambda s: s["position"][-1, 2]),
                                 (24, "M1", lambda s: s["position"][-1, 2])):
        caption = figures.figure(number, "charged").caption
        for i in (1, 2, 3):
            value = float(pick(figures_charged.runs_of(family)[i - 1]["exact"].state))
            assert re.search(rf"(?<![\d.]){value:.2f}(?!\d)|(?<![\d.]){value:.0f}(?![\d.])",
                             caption), (number, value)


def test_every_number_of_a_chapters_data_has_its_unit():
    told = chapter._parameters(sweep("liquid-base")[""])
    assert told.startswith("D1 = 9.51 kg m², ") and "M3 = −0.06 N m; at t = 0: ω = (1, 0, 1) rad/s" in told
    assert all(re.search(r"= \S+ [A-Za-z1]", part) for part in told.split("; ")[0].split(", "))


def test_a_chapter_whose_case_is_missing_says_so_in_words(tmp_path, monkeypatch):
    monkeypatch.setattr(figures, "write", lambda *_: [])
    monkeypatch.setattr(figures, "of_paper", lambda *_: ())
    from dataclasses import replace
    broken = replace(chapter.CHAPTERS[2], compared=(("top-that-is-not-there", ""),))
    monkeypatch.setattr(chapter, "CHAPTERS", (broken,))
    section = chapter.section("top", tmp_path)
    assert "top-that-is-not-there.toml" in section["problem"] and section["sensible"] is None


@pytest.mark.slow
def test_a_chapter_stands_in_the_report_with_errors_and_variant(tmp_path, monkeypatch):
    row = figures_top.FIGURES[5]
    monkeypatch.setattr(figures_top, "FIGURES", (row,))
    section = chapter.section("top", tmp_path)
    assert section["problem"] == "" and (tmp_path / section["sensible"]["file"]).is_file()
    page = html.render("chapter.html", chapter=section, claims=(), title=section["title"])
    for words in ("A fast top in a Newtonian field", "10 % from", "top-sensible.png", "figures/top-06.png"):
        assert words in page, words


@pytest.mark.slow
@pytest.mark.one_in(6)
@pytest.mark.parametrize("row", OTHERS, ids=lambda row: row.file[:-4])
def test_every_figure_of_the_other_papers_can_be_drawn(row, tmp_path):
    path = figures.write([row.number], tmp_path, paper_name=row.paper)[0]
    assert 20_000 < path.stat().st_size < SMALL
    assert row.caption in (FOLDER / row.file).with_suffix(".txt").read_text(encoding="utf-8")
