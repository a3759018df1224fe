"""Notes of a picture: what limits its answer, in full or in few words, the most important first and never lost."""
from __future__ import annotations

import matplotlib
import numpy as np
import pytest

from stabilab import load, plot
from stabilab.errors import Caveat, Kind
from stabilab.reasons import Level, Rate, Sentence, Time
from stabilab.show import limiting, style
from stabilab.show.limiting import Note
from stabilab.show.text.notes import fitted
from stabilab.show.units import SI
from tests.house.sentences import sentences

SMALL = (3.4, 2.6)
LIMIT = Sentence("reaches-limit", "reaches {limit} after {time} ({level})")


def test_every_kind_and_code_has_few_words():
    known = {one.code: one for _, one in sentences()}
    assert set(limiting.IN_BRIEF) == set(Kind)
    for code, words in limiting.BRIEFLY.items():
        holes = Sentence("", words).holes
        assert set(holes) <= set(known[code].holes), code
    assert all(len(words) <= limiting.BRIEF for words in limiting.IN_BRIEF.values())


def test_a_note_says_what_a_line_leaves_out_the_most_important_first():
    """By hand: a limit takes more from an answer than a statement of the file; what the line has is no note."""
    stated = Caveat(Kind.STATED, Sentence("probe", "a long statement of the file on its tensor")())
    limit = Caveat(Kind.LIMIT, LIMIT(limit=Rate(1.0), time=Time(2.0), level=Level.PROVED))
    found = limiting.notes([stated, limit], "Bounded for ever", SI)
    assert found == [Note("reaches 1 rad/s after 2 s (proved)", "1 rad/s after 2 s (proved)"),
                     Note("a long statement of the file on its tensor", "a caveat of the file")]
    assert limiting.notes([limit], "Spins up; 1 rad/s after 2 s (proved)", SI) == []


@pytest.mark.parametrize("size, most", [(SMALL, 2), ((7.6, 4.8), 3)])
def test_notes_take_few_lines_and_the_first_is_never_lost(size, most):
    """Over random notes: each stands there in full or in few words, or is counted."""
    random = np.random.default_rng(7)
    with matplotlib.rc_context(style.RC | style.letters(size)):
        for _ in range(150):
            brief = [f"brief {n} {'x' * int(random.integers(3, 36))}" for n in range(int(random.integers(1, 9)))]
            notes = [Note(f"{text} {'full ' * int(random.integers(0, 25))}end", text) for text in brief]
            lines = fitted(notes, size[0]).split("\n")
            said = " ".join(lines)
            assert len(lines) <= most and brief[0] in said
            assert max(map(len, lines)) <= 1 + (size[0] - 0.3) / (0.008 * style.share() * 8.5)
            counted = next((int(part.split(" more")[0]) for part in said.split("; ") if " more: " in part), 0)
            assert sum(text in said for text in brief) + counted == len(brief)


@pytest.mark.parametrize("name", ["cubesat-3u", "charged-body"])
def test_a_small_picture_has_two_lines_of_title_and_most_of_its_room_for_the_axes(name):
    """Half of its height between title and legend, by the boxes that Matplotlib draws; it was a quarter."""
    case = load(f"cases/{name}.toml")
    ax = plot.time(case, size=SMALL)
    figure = ax.figure
    figure.draw_without_rendering()
    box = ax.get_tightbbox(for_layout_only=True)
    title, whole = ax.title.get_window_extent(), figure.bbox
    assert (box.height - title.height) / whole.height > 0.5
    assert 2 >= len(ax.get_title().split("\n")) and title.x0 >= 0 and title.x1 <= whole.width
    (legend,) = figure.legends
    notes = legend.get_title().get_text()
    assert 1 <= len(notes.split("\n")) <= 2 and "left" in notes  # out, or a law
    matplotlib.pyplot.close(figure)
