"""One headline in every view, one table of colours: lines that are seen on white, also by colour-blind
readers."""
import itertools
import re
from pathlib import Path

import numpy as np
import pytest

from stabilab import load
from stabilab.show import style
from stabilab.show.explore.session import Session
from stabilab.show.plot import over_time
from stabilab.show.plot.subject import subject
from stabilab.show.report.one_case import page
from stabilab.show.terminal.letters import greek, printed
from stabilab.show.text.cost import comparison
from stabilab.show.text.headline import headline, look

from .explore.test_session import ask

ROOT = Path(__file__).parents[2]
CASES = ("minor-axis-100", "minor-axis-500", "middle-axis-100", "middle-axis-plane-300",
         "middle-axis-double-well", "middle-axis-spin-up", "major-axis-100", "major-axis-captured", "off-axis-two",
         "off-axis-fold", "torque-free-body", "torque-free-gyrostat", "sphere-wheel", "symmetric-spin-up",
         "thruster-stuck-major-axis", "wheel-and-thruster", "cubesat-3u", "upper-stage", "liquid-base",
         "charged-body")
TILTED = re.compile(r"(?:: |; )(?:tilted by |a tilt )[^;]*")  # looked at where that is asked for, or quick


@pytest.fixture
def bare(monkeypatch):
    """Pages without what takes long to draw."""
    for name in ("pictures", "space", "sensitivity", "equilibrium_table", "equations"):
        monkeypatch.setattr(page, name, lambda *given, **options: None)


@pytest.mark.one_in(8)
@pytest.mark.parametrize("name", [name for name in CASES if name != "middle-axis-spin-up"]
                         + [pytest.param("middle-axis-spin-up", marks=pytest.mark.slow)])  # takes half a minute
def test_every_view_has_the_same_headline(stabilab, bare, tmp_path, name):
    case = load(ROOT / "cases" / f"{name}.toml")
    found = subject(case).motion
    line = plain(greek(headline(case, found)))
    first = stabilab("classify", case.path)[1].split("\n")[0]
    if first.startswith("BEYOND THE LAW"):
        warning, answer = first.split(f"{name}: ")
        assert plain(warning + answer) == line
    else:
        # where the law of an effect holds, the terminal's line also says so
        assert plain(first.removeprefix(f"{name}: ").split("; within the law")[0]) == line
    made = page.sections(case, tmp_path, name, deep=False)
    assert plain(made["headline"]) == plain(printed(line)) and made["look"] == look(found)
    shown = ask(Session(case), moving=False)[0]
    assert plain(shown["headline"]) == line and shown["look"] == look(found)
    title = over_time.time(case).get_title()
    assert plain(title.split("\n", 1)[1]).endswith(plain(style.literal(line)))


def plain(text: str) -> str:
    """Without the tilt, the ends of lines and the minus of a book."""
    return TILTED.sub("", " ".join(text.split())).replace("−", "-").replace("\u00a0", " ")


def test_the_look_of_a_headline_follows_from_what_it_says():
    """By their words: of a law that does not hold, of a condition, of a change."""
    seen = {}
    for name in CASES:
        case = load(ROOT / "cases" / f"{name}.toml")
        found = subject(case).motion
        words = headline(case, found)
        seen.setdefault(look(found), []).append(name)
        assert (look(found) == "conditional") == (
            words.startswith(("BEYOND", "UNDECIDED")) or (" only while " in words and "; reaches" not in words))
        assert look(found) != "bounded" or words.startswith("BOUNDED for ever")
    assert all(len(seen[kind]) > 2 for kind in style.LOOK), seen


def linear(colour: str) -> np.ndarray:
    values = np.array([int(colour[n:n + 2], 16) / 255 for n in (1, 3, 5)])
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055)**2.4)


def lines() -> set[str]:
    """The colours of all lines and markers."""
    looks = [*style.MEANING.values(), *style.MARKER.values(), *over_time.COMPONENTS, over_time.LIMIT,
             *comparison.LOOKS.values(), over_time.SIZE_LOOK]
    shown = [one.get("markeredgecolor", one.get("color")) for one in looks]
    return {*shown, *style.SERIES, *style.LOOK.values(), *style.SPIN.values()}


@pytest.mark.parametrize("colour", sorted(lines()))
def test_lines_have_a_contrast_of_three_on_white(colour):
    """WCAG 2.1, success criterion 1.4.11, with its relative luminance."""
    assert 1.05 / (linear(colour) @ [0.2126, 0.7152, 0.0722] + 0.05) >= 3


EYES = {"normal": np.eye(3),  # Machado, Oliveira and Fernandes 2009, table 1: linear RGB, severity 1
        "without red": np.array([[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216],
                                 [-0.003882, -0.048116, 1.051998]]),
        "without green": np.array([[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413],
                                   [-0.011820, 0.042940, 0.968881]])}
XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])


def lab(colour: str, eye: str) -> np.ndarray:
    """CIELAB, white of the screen."""
    shares = XYZ @ np.clip(EYES[eye] @ linear(colour), 0, 1) / XYZ.sum(axis=1)
    f = np.where(shares > 0.008856, np.cbrt(shares), 7.787 * shares + 16 / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


@pytest.mark.parametrize("eye", EYES)
def test_hues_are_told_apart_by_every_reader(eye):
    """17 is what the nearest two of Okabe and Ito's hues have; 2.3 is just noticeable."""
    hues = (style.BLACK, style.BLUE, style.SKY, style.GREEN, style.ORANGE, style.VERMILION, style.PURPLE)
    assert min(np.linalg.norm(lab(a, eye) - lab(b, eye)) for a, b in itertools.combinations(hues, 2)) > 17


def test_no_view_has_outcomes_in_colours_of_its_own():
    """Every saturated colour of a page or picture of answers is named in style; what is left are greys and
    tints of these."""
    own = re.compile(r"#[0-9A-Fa-f]{6}\b")
    room = ROOT / "stabilab" / "show"
    for file in [*room.rglob("*.py"), *room.rglob("*.js")]:
        if file.name in ("style.py", "comparison.py"):  # the table; darker words beside its lines
            continue
        for colour in own.findall(file.read_text(encoding="utf-8")):
            values = [int(colour[n:n + 2], 16) for n in (1, 3, 5)]
            assert max(values) - min(values) < 16, (file, colour)
