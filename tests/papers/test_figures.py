"""What the pictures of the papers show: spans that hold what captions claim, scales, letters, and curves that
end or are missing."""
import ast
import re
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import rgb_to_hsv, to_rgb

from stabilab.papers import table
from stabilab.papers.figures import catalogue, cavity, major_axis, middle_axis, minor_axis
from stabilab.papers.figures.catalogue import figure
from stabilab.show import style
from stabilab.show.terminal import written

# Names of letters spelt out; a list of its own, so that one left out of the table of letters is seen.
SPELT = re.compile(
    r"(?<![A-Za-z])(lambda|omega|psi|phi|theta|eta|zeta|gamma|Gamma|Lambda|Omega|eps|delta|sigma|pi|sqrt)(?![a-z])|\^\d")


@pytest.fixture
def plt():
    with style.drawing() as found:
        yield found


def test_figures_of_captured_motions_are_drawn_beyond_the_release_they_claim():
    """Oracle: the reversals of the turn about axis 1 counted along the run itself; none after the mark."""
    (_, printed), (_, longer) = major_axis._rows(table.START_CAPTURED)
    claimed = re.search(r"released at τ = ([\d.]+), ([\d.]+) and ([\d.]+)", figure(12).caption).groups()
    for (lam, (states, seen, release)), claim in zip(longer.items(), claimed):
        turn = np.unwrap(np.arctan2(states[:, 2], states[:, 1]))
        last = np.nonzero(np.diff(np.sign(np.diff(turn))))[0].max() / 400
        assert abs(last - float(claim)) < 0.06 and abs(release / 400
                                                       - last) < 0.01 and len(states) / 400 > last + 5
        assert np.array_equal(states[:seen], printed[lam][0])


def test_no_equilibrium_stands_at_an_edge_of_the_phase_planes():
    for lam in table.LAMBDAS:
        plane, start, span = minor_axis._plane(lam)
        for place in plane.repeated(plane.centres + plane.saddles, span[0] - 1, span[1] + 1):
            assert min(abs(start + 2 * place - edge) for edge in minor_axis.WINDOW) > 0.2


def test_figure_4_has_the_equilibria_of_each_wheel_on_its_own_circle():
    """By the balance on a circle of radius A: 1 + A cos(alpha/2) (A sin(alpha/2) + c) = 0, c = b - a."""
    for lam in table.FIG4:
        plane, start, span = minor_axis._plane(lam)
        A, c = np.hypot(2.5 + lam / 500, 4.0), lam / 500
        places = plane.repeated(plane.centres + plane.saddles, *span)
        half = (start + 2 * np.array(places)) / 2
        assert len(places) >= 4 and np.abs(1 + A * np.cos(half) * (A * np.sin(half) + c)).max() < 1e-9


def test_figure_17_has_every_value_of_the_paper_to_one_scale(plt):
    panels = middle_axis.projections(plt).axes
    assert [int(re.search(r"lambda_1=(\d+)", ax.get_title())[1]) for ax in panels[:3]] == list(table.LAMBDAS)
    assert len({(ax.get_xlim(), ax.get_ylim()) for ax in panels}) == 1


def test_separatrix_surfaces_are_named_as_in_the_phase_plane(plt):
    """The left loop lies about a centre with x1 + a < 0, where alpha = 2 atan2(x1 + a, x2) is negative."""
    sides = {table.side(branch): branch for branch in minor_axis.branches().branches}
    a = table.printed_scene("minor", 100).a
    for side, sign in (("left", -1), ("right", 1)):
        centre = np.asarray(sides[side].centre)[-1]
        assert np.sign(2 * np.arctan2(centre[0] + a, centre[1])) == sign
    names = [text.get_text() for text in minor_axis.surfaces(plt).legends[0].get_texts()]
    assert {"left separatrix surface", "right separatrix surface"} <= set(names)


def test_a_curve_that_ends_within_a_panel_is_marked_and_the_panel_says_why(plt):
    panels = [ax for part in figure(2, "cavity").draw(plt) for ax in part.axes]
    for ax, run in zip(panels, (runs["printed"] for runs in cavity.runs_of("small"))):
        ends = [line for line in ax.lines if line.get_marker() == "X"]
        words = " ".join(text.get_text() for text in ax.get_legend().get_texts()) if ax.get_legend() else ""
        assert [line.get_xdata()[0] for line in ends] == ([run.t[-1]] if run.t[-1] < cavity.SPAN.end else [])
        assert bool(ends) == ("no real value" in words.replace("\n", " "))


def test_the_words_below_a_figure_say_why_a_panel_lacks_a_model(plt):
    drawn = figure(11, "cavity").draw(plt)[0]
    *others, last = [ax.get_title() for ax in drawn.axes[:3]]
    words = drawn.legends[0].get_title().get_text().replace("\n", " ")
    assert words.startswith(f"{last}: no ") and "averaging needs small" in words
    assert "averaged, second order" in words and not any(heading in words for heading in others)


@pytest.mark.slow
def test_words_on_cut_curves_stand_side_by_side(plt):
    drawn = figure(5, "top").draw(plt)
    for part in drawn:
        part.draw_without_rendering()
    rows = [[text.get_window_extent() for text in ax.texts] for part in drawn for ax in part.axes]
    # rows whose printed and corrected curves both leave the panel
    assert sum(len(boxes) > 1 for boxes in rows) >= 5
    assert not [1 for boxes in rows for n,
                box in enumerate(boxes) for other in boxes[:n] if box.overlaps(other)]


def test_every_line_looks_as_the_legend_says(plt):
    for drawn in (*figure(2, "top").draw(plt), *figure(2, "charged").draw(plt)):
        legend = {(h.get_color(), h.get_linestyle(), h.get_linewidth())
                  for h in drawn.legends[0].legend_handles}
        assert {(line.get_color(), line.get_linestyle(), line.get_linewidth()) for ax in drawn.axes
                for line in ax.lines} <= legend


def _hue(colour):
    """Where a colour stands on the wheel, in degrees; None of black, white and grey."""
    hue, saturation, _ = rgb_to_hsv(to_rgb(colour))
    return 360 * hue if saturation > 0.2 else None


def _named(drawn):
    """[(name, colour)] of a legend."""
    return [(text.get_text(), handle.get_color()) for text,
            handle in zip(drawn.legends[0].get_texts(), drawn.legends[0].legend_handles)]


def _model(name):
    return ("corrected" if "corrected integrals" in name
            else "printed" if name.startswith(("alone", "as printed")) else name)


def test_no_colour_of_a_figure_means_two_things(plt):
    """In the panels of printed curves alone the shades are those of the model that they show beside it; no
    other line has their hue."""
    for row in (figure(3, "cavity"), figure(18, "charged"), figure(6, "top")):
        rows = {one for part in row.draw(plt) for one in _named(part)}
        named = [(_model(name), _hue(colour)) for name, colour in rows]
        assert sum(model == "printed" for model, _ in named) == 4
        for model, hue in named:
            assert [other for other, at in named if other != model and None not in (hue, at)
                    and model in ("printed", "corrected")
                    and abs((hue - at + 180) % 360 - 180) < 15] == []
    colours = dict(_named(middle_axis.projections(plt)))
    assert colours.pop("motion of Table 3") not in colours.values()


@pytest.mark.parametrize("name, number", [("cavity", n) for n in (2, 3, 11, 13)])
def test_a_caption_speaks_of_panels_of_printed_curves_only_where_these_may_stand(name, number, plt):
    row = figure(number, name)
    alone = any("alone" in ax.get_title() for part in row.draw(plt) for ax in part.axes)
    assert alone <= ("the last panels have them alone" in row.caption)
    assert (number not in (11, 13) or "panels" not in row.caption)


@pytest.mark.parametrize("plain, letters", [
    ("lambda3 = 0.1, l_x and r0^2", "λ3 = 0.1, lx and r0²"),
    ("pi/2, psi, 2 pi/r0; Gamma/eps", "π/2, ψ, 2 π/r0; Γ/ε"), ("sqrt(p^2 + q^2) m^7", "√(p² + q²) m⁷"),
    ("gamma'' and eta3", "γ'' and η3"),
    ("a phial, a pistachio, betas; theta-like", "a phial, a pistachio, betas; theta-like")])
def test_captions_are_set_in_letters(plain, letters):
    assert written(plain) == letters


# Numbers that stand in the sources of captions, of more than a digit, and why: all others are computed
TYPED = {"4.72 500 4.2 4.5 100 15 1000 10,000": "of the papers' texts", "0.1": "a wheel, a start and a time of theirs",
         "700 500 16 400": "settings of a picture: a grid, a tolerance, points", "0.6": "where motions are put"}
NUMBER = re.compile(r"(?<![\w.^(/{:,])(?:\d+,\d{3}|\d+\.\d+|\d{2,})\b")


def _captions(path):
    """(line, text) of all parts of sentences in a source, without docstrings and forms of numbers."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    left = {id(node.body[0].value) for node in ast.walk(tree) if hasattr(node, "body") and isinstance(node.body, list)
            and node.body and isinstance(node.body[0], ast.Expr)}
    left |= {id(part) for node in ast.walk(tree) if isinstance(node, ast.FormattedValue) and node.format_spec
             for part in ast.walk(node.format_spec)}
    return [(node.lineno, node.value) for node in ast.walk(tree) if isinstance(node, ast.Constant)
            and isinstance(node.value, str) and id(node) not in left]


@pytest.mark.parametrize("name", ["catalogue", "minor_axis", "major_axis", "middle_axis", "charged", "cavity", "top"])
def test_no_caption_has_a_typed_number_that_is_not_the_papers(name):
    """Sentences alone: a text with a blank that is no title with its data, colour or name."""
    known = set(" ".join(TYPED).split())
    for line, text in _captions(Path(catalogue.__file__).with_name(f"{name}.py")):
        if text.count(" ") > 1 and not re.search(r"Major axis from|20\d\d|\$|x\(0\)", text):
            assert set(NUMBER.findall(text)) <= known, (name, line, text)
    assert NUMBER.findall("up to 2.13 on 57 of 10,000") == ["2.13", "57", "10,000"]


@pytest.mark.slow
def test_no_caption_spells_a_letter():
    assert [row.file for row in catalogue.chosen()
            if SPELT.search(f"{row.title} {row.caption} {row.tolerance}")] == []
