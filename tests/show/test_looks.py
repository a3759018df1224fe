"""One headline in every view, one table of colours: lines that are seen on white."""
import re
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from stabilab.show import style
from stabilab.show.plot import over_time
from stabilab.show.text import cost
from stabilab.show.text.classification import IN_SHORT
from tests.recorded.answers import recorded
from tests.shared import in_one_line

ROOT = Path(__file__).parents[2]
PAGE, EXPLORER, TEXT, PICTURES, DATA = map(recorded, ("page", "explorer", "classify-text", "pictures", "fate"))
# by hand: how a first line begins, by the word of JSON; of a motion that loses energy, by its end
BEGINS = {"bounded": "bounded", "spin-up": "spins up", "separatrix": "on the separatrix", "undecided": "undecided",
          "equilibrium": ("steady rotation", "at rest"), "flat spin": "flat spin", "rest": "comes to rest",
          "steady rotation": "tends to steady rotation", "rotation about the field": "tends to rotation about the field"}
TILTED = re.compile(r"(?:: |; )(?:tilted by |a tilt )[^;]*")  # looked at where that is asked for, or quick


SHORT = re.compile("|".join(form for forms in IN_SHORT.values() for form in forms if form))


def plain(text: str) -> str:
    """Without the tilt, the ends of lines and the signs of a book."""
    text = TILTED.sub("", " ".join(text.replace(r"\$", "$").split())).replace("−", "-").replace("\u00a0", " ")
    return re.sub(r"e-0(?=\d)", "e-", text)


def in_full(line):
    """A condition that a first line of 100 letters has in short, and a place that it has as a clause of its own."""
    line = re.sub(r"only while the torque is exactly along ([xyz])( \([a-z]+ axis\))?",
                  r"only with torque exactly along \1", line)
    return re.sub(r"STEADY ROTATION \((by a run)\); at (\([^)]*\) [^;]*)", r"STEADY ROTATION at \2 (\1)", line)


@pytest.mark.parametrize("name", sorted(set(EXPLORER) - {"charged-sweep"}))  # the explorer takes its first values
def test_every_view_has_the_same_headline(name):
    """As recorded: the explorer's line in the others, which add over which time or what uncertain numbers change.
    Pictures have the first of its two lines."""
    line = plain(EXPLORER[name]["headline"])
    text = SHORT.sub("", in_one_line(TEXT[name]["answer"])).replace(f"{name}: ", "")
    assert line in plain(PAGE[name]["headline"]) and in_full(line) in in_full(plain(text))
    first = plain(PAGE[name]["first"])
    assert plain(EXPLORER[name]["first"]) == first and len(first) <= 60
    assert PICTURES[name]["time"][0]["title"].split("\n")[-1].replace("−", "-") == first
    (data,) = DATA[name]["answer"]
    ending = data.get("ending") or {}
    named = ending.get("kind", "undecided")
    begins = BEGINS[data["fate"] if named == "undecided" else named]
    assert first.lower().removeprefix("beyond the law: ").startswith(begins), (first, named)
    for caveat in data["caveats"]:
        if caveat["code"] == "reaches-limit":
            notes = " ".join(text for text in PICTURES[name]["time"][-1])
            assert caveat["level"] in f"{first} {notes}" and not first.startswith("Bounded for ever")
    # a fate that a part of the box has not, or samples alone show, is one on a condition; the explorer has no box
    assert EXPLORER[name]["look"] == PAGE[name]["look"] or PAGE[name]["look"] == "conditional" and (
        "BUT within the uncertainties" in PAGE[name]["headline"] or PAGE[name]["headline"].endswith("without a proof"))


def test_the_look_of_a_headline_follows_from_what_it_says():
    """By their words: of a law that does not hold, of a condition, of a change."""
    seen = Counter(one["look"] for one in EXPLORER.values())
    for one in EXPLORER.values():
        words = one["headline"]
        assert (one["look"] == "conditional") == (
            words.startswith(("BEYOND", "UNDECIDED"))
            or " only while " in words and not re.search("; reaches|, UNSTABLE", words)), words  # a change says more
        # a motion that loses energy is said by its end, which holds for ever too
        assert one["look"] != "bounded" or words.startswith(("BOUNDED for ever", "TENDS TO "))
    assert all(seen[kind] > 2 for kind in style.LOOK), seen


def linear(colour: str) -> np.ndarray:
    values = np.array([int(colour[n:n + 2], 16) / 255 for n in (1, 3, 5)])
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055)**2.4)


def lines() -> set[str]:
    """The colours of all lines and markers."""
    looks = [*style.MEANING.values(), *style.MARKER.values(), *over_time.COMPONENTS, over_time.LIMIT,
             *cost.LOOKS.values(), over_time.SIZE_LOOK]
    shown = [one.get("markeredgecolor", one.get("color")) for one in looks]
    return {*shown, *style.SERIES, *style.LOOK.values(), *style.AXES}


@pytest.mark.parametrize("colour", sorted(lines()))
def test_lines_have_a_contrast_of_three_on_white(colour):
    """WCAG 2.1, success criterion 1.4.11, with its relative luminance."""
    assert 1.05 / (linear(colour) @ [0.2126, 0.7152, 0.0722] + 0.05) >= 3


def test_no_view_has_outcomes_in_colours_of_its_own():
    """Every saturated colour of a page or picture of answers is named in style; what is left are greys and
    tints of these."""
    own = re.compile(r"#[0-9A-Fa-f]{6}\b")
    room = ROOT / "stabilab" / "show"
    for file in [*room.rglob("*.py"), *room.rglob("*.js")]:
        if file.name in ("style.py", "cost.py"):  # the table; darker words beside its lines
            continue
        for colour in own.findall(file.read_text(encoding="utf-8")):
            values = [int(colour[n:n + 2], 16) for n in (1, 3, 5)]
            assert max(values) - min(values) < 16, (file, colour)
