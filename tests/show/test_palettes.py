"""Outcomes and axes have palettes that share no colour: on each screen (the page of a case, a picture, the
explorer, a map) no colour means two things, and colour-blind readers tell any two of them apart."""
import itertools
import re
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from stabilab.case.read import load
from stabilab.maps.basins import BOUNDED, NO_AXIS, UNDECIDED
from stabilab.orbit.result import Fate
from stabilab.show import picture_kinds, style
from stabilab.show.maps import shades
from stabilab.show.maps.picture import BEHIND
from stabilab.show.plot import basins, over_time, turning
from stabilab.show.plot import subject as subjects
from stabilab.show.plot.subject import subject
from stabilab.show.space.drawing import look
from stabilab.show.text import cost

ROOT = Path(__file__).parents[2]
APART = 12.0  # of CIEDE2000: 2.3 of CIELAB is just noticeable, an unlike hue at a glance some ten
# Machado, Oliveira and Fernandes 2009 (IEEE Trans. Vis. Comput. Graph. 15, 1291), table 1: linear RGB, severity 1
EYES = {"normal": np.eye(3),
        "protanopia": np.array([[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216],
                                [-0.003882, -0.048116, 1.051998]]),
        "deuteranopia": np.array([[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413],
                                  [-0.011820, 0.042940, 0.968881]]),
        "tritanopia": np.array([[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602],
                                [0.004733, 0.691367, 0.303900]])}
XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])


def rgb(colour) -> np.ndarray:
    return (np.array([int(colour[n:n + 2], 16) for n in (1, 3, 5)]) / 255 if isinstance(colour, str)
            else np.array(colour[:3]))


def lab(colour, eye: str) -> np.ndarray:
    """CIELAB of a colour as an eye sees it, white of the screen."""
    values = rgb(colour)
    linear = np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055)**2.4)
    shares = XYZ @ np.clip(EYES[eye] @ linear, 0, 1) / XYZ.sum(axis=1)
    f = np.where(shares > 0.008856, np.cbrt(shares), 7.787 * shares + 16 / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def difference(first, second) -> float:
    """CIEDE2000, as Sharma, Wu and Dalal 2005 (Color Res. Appl. 30, 21) write it."""
    (L1, a1, b1), (L2, a2, b2) = first, second
    c = (np.hypot(a1, b1) + np.hypot(a2, b2)) / 2
    stretch = 1.5 - 0.5 * np.sqrt(c**7 / (c**7 + 25.0**7))
    (C1, h1), (C2, h2) = ((np.hypot(stretch * a, b), np.degrees(np.arctan2(b, stretch * a)) % 360)
                          for a, b in ((a1, b1), (a2, b2)))
    turn = (h2 - h1 + 180) % 360 - 180 if C1 * C2 else 0.0
    mean = (h1 + turn / 2) % 360 if C1 * C2 else h1 + h2
    L, C, H = (L1 + L2) / 2, (C1 + C2) / 2, 2 * np.sqrt(C1 * C2) * np.sin(np.radians(turn / 2))
    cosine = lambda times, shift: np.cos(np.radians(times * mean + shift))
    T = 1 - 0.17 * cosine(1, -30) + 0.24 * cosine(2, 0) + 0.32 * cosine(3, 6) - 0.2 * cosine(4, -63)
    light = (L2 - L1) / (1 + 0.015 * (L - 50)**2 / np.sqrt(20 + (L - 50)**2))
    chroma, hue = (C2 - C1) / (1 + 0.045 * C), H / (1 + 0.015 * C * T)
    mixed = -2 * np.sqrt(C**7 / (C**7 + 25.0**7)) * np.sin(np.radians(60 * np.exp(-((mean - 275) / 25)**2)))
    return float(np.sqrt(light**2 + chroma**2 + hue**2 + mixed * chroma * hue))


@pytest.mark.parametrize(("first", "second", "value"), [  # table 1 of Sharma, Wu and Dalal 2005: rows 1, 17, 25, 34
    ((50, 2.6772, -79.7751), (50, 0, -82.7485), 2.0425), ((50, 2.5, 0), (73, 25, -18), 27.1492),
    ((60.2574, -34.0099, 36.2677), (60.4626, -34.1751, 39.4387), 1.2644),
    ((2.0776, 0.0795, -1.1350), (0.9033, -0.0636, -0.5514), 0.9082)])
def test_the_difference_of_colours_is_that_of_its_authors(first, second, value):
    assert difference(first, second) == pytest.approx(value, abs=1e-4)


LINES = (style.BLACK, style.GREY, style.BLUE, style.AMBER, style.VERMILION, *style.AXES, style.VIOLET,
         style.SAGE, style.WINE)
SETS = {"lines": LINES, "areas of outcomes": (*style.FILL.values(), style.AGAINST),
        "areas behind curves": [shades.light(colour, BEHIND) for colour in style.FILL.values()],
        "areas of other words": style.LISTED, "surfaces": style.SURFACES}


@pytest.mark.parametrize("eye", EYES)
@pytest.mark.parametrize("name", SETS)
def test_colours_of_one_screen_are_told_apart_by_every_reader(name, eye):
    seen = {str(colour): lab(colour, eye) for colour in SETS[name]}
    nearest = min((difference(seen[a], seen[b]), a, b) for a, b in itertools.combinations(seen, 2))
    assert nearest[0] >= APART, nearest


# colour -> what a legend, a label or an arrow of that colour may say; black and greys say nothing by themselves
MEANS = {style.BLUE: "(?<!un)stable|bounded|stays|steady|centre|least energy|neighbours|not yet, proved|in the middle",
         style.AMBER: "undecided|only while|if ",
         style.VERMILION: "unstable|saddle|barrier|most energy|spin|limit|reached|leave|earliest|latest|later than",
         style.VIOLET: "this motion|least to greatest|where it is|rates at the start|energy of this motion|draws|^ω$|MEGNO",
         style.SAGE: "^cut|printed|other states|wheel", style.WINE: "^cut|corrected|averaged|expansion|wheel"}
MEANS |= {colour: rf"[ωx]\D*{n}|{n}$|^{'xyz'[n - 1]}\b|\b{'xyz'[n - 1]}$|ω_{'xyz'[n - 1]}|limits|{rank}"
          for n, (colour, rank) in enumerate(zip(style.AXES, ("major|minor|intermediate",) * 3), 1)}
TINTS = {style.FILL[word]: style.MEANING[word]["color"] for word in ("bounded", "spin-up", "undecided")}
TINTS |= {colour: cost.LOOKS[name]["color"] for name, colour in cost.DARK.items()}  # of words
GREY = 0.07  # of a channel: what has less colour is a grey


def coloured(colour) -> str:
    """The colour as hexadecimal digits; empty for a grey, a white or none."""
    from matplotlib.colors import to_hex, to_rgba
    if colour is None or isinstance(colour, str) and colour == "none":
        return ""
    *channels, alpha = to_rgba(colour)
    return "" if not alpha or max(channels) - min(channels) <= GREY else to_hex(channels).upper()


def of(artist) -> list[str]:
    """The colours of a line, a marker, an area or letters, as far as they are drawn."""
    from matplotlib.collections import Collection
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch
    from matplotlib.text import Text
    shown: list = []
    if isinstance(artist, Line2D):
        shown += [artist.get_color()] if artist.get_linestyle() not in ("None", "none", "") else []
        if artist.get_marker() not in ("None", "none", "", None):
            shown += [artist.get_markeredgecolor(), artist.get_markerfacecolor()]
    elif artist.get_gid() in MEANS:  # shades of what is lit and seen through
        shown.append(artist.get_gid())
    elif isinstance(artist, Collection):
        shown += [*artist.get_facecolor()] + ([*artist.get_edgecolor()] if max(artist.get_linewidth()) else [])
    elif isinstance(artist, Patch):
        shown += [artist.get_facecolor()] + ([artist.get_edgecolor()] if artist.get_linewidth() else [])
    elif isinstance(artist, Text) and artist.get_text().strip():
        shown.append(artist.get_color())
    return [colour for colour in map(coloured, shown) if colour]


def drawn(figure) -> set[str]:
    """The colours of all that a figure shows."""
    return {colour for artist in figure.findobj(lambda each: each.get_visible()) for colour in of(artist)}


def explained(figure) -> list[tuple[str, str]]:
    """(words, colour) of the legends of a figure, and of what is written in a colour."""
    from matplotlib.legend import Legend
    from matplotlib.text import Text
    rows = [(text.get_text(), colour) for legend in figure.findobj(Legend)
            for handle, text in zip(legend.legend_handles, legend.get_texts()) for colour in of(handle)]
    rows += [(text.get_text(), colour) for text in figure.findobj(Text) for colour in of(text)]
    return [(words.replace(r"\omega", "ω").replace("$", "").replace("_", "").strip(), colour)
            for words, colour in rows]


def pictures(case):
    """The figures of all kinds that a page shows of a case, but for those that follow many motions."""
    item = subject(case)
    for kind, row in picture_kinds.KINDS.items():
        if kind in ("attitude", "budget", "section", "tilt", "wheel", "histogram") or subjects.why_not(kind, item):
            continue
        module, _, name = row.draws.partition(".")
        made = getattr(import_module(f"stabilab.show.plot.{module}"), name)(item)
        yield from ((kind, figure) for figure in (made if isinstance(made, list) else [made.figure]))


@pytest.mark.first(1, 4)
@pytest.mark.parametrize("name", ["wheel-and-thruster", "dual-spin-damper", "top-lx30-lz30", "charged-body",
                                  "thruster-stuck-major-axis", "t-handle", "upper-stage"])
def test_no_colour_of_a_page_means_two_things(name):
    """All its pictures together: each colour is of one palette, and whatever is written of it has its meaning."""
    with style.drawing():
        for kind, figure in pictures(load(ROOT / "cases" / f"{name}.toml")):
            own = {colour for colour in drawn(figure)
                   if colour not in MEANS and colour not in TINTS}
            assert not own, (kind, own)
            for words, colour in explained(figure):
                assert re.search(MEANS[TINTS.get(colour, colour)], words), (kind, words, colour)


def test_what_scripts_draw_is_of_the_same_palettes():
    """The explorer's curves, the space of the rates, the film, the look of a headline."""
    ink = {"motion": style.VIOLET, "stable": style.BLUE, "unstable": style.VERMILION, "limit": style.VERMILION}
    source = (ROOT / "stabilab/show/templates/explore-plots.js").read_text(encoding="utf-8")
    named = dict(re.findall(r'(\w+): "\{\{ style\.(\w+) \}\}"', source))
    assert {what: getattr(style, named[what]) for what in ink} == ink
    assert "components: {{ style.AXES|list|tojson }}" in source
    assert tuple(turning.COLOURS) == style.AXES == tuple(each["color"] for each in over_time.COMPONENTS)
    assert all(re.search(MEANS[colour], words) for words in style.SPACE
               if (colour := look(words)["color"]) in MEANS)
    assert set(style.LOOK.values()) == {style.BLUE, style.AMBER, style.VERMILION}


def test_the_palettes_share_no_colour():
    outcomes, axes = set(style.LOOK.values()), set(style.AXES)
    models = {one["color"] for one in cost.LOOKS.values()}
    assert len(outcomes) == len(axes) == 3 and not outcomes & axes
    assert not models & (outcomes | axes | {style.VIOLET}) and not set(style.SERIES) & (outcomes | axes)


def test_maps_say_outcomes_by_colour_and_axes_by_hatch_and_letter():
    """Basins, atlas and sweep: one hue for what spins up, a hatch for each axis."""
    fills = {BOUNDED: "bounded", UNDECIDED: "undecided", NO_AXIS: "spin-up", 1: "spin-up", 2: "spin-up", 3: "spin-up"}
    assert all(basins.AREAS[label] == style.FILL[word] for label, word in fills.items())
    assert {basins.AREAS[-axis] for axis in (1, 2, 3)} == {style.AGAINST}
    assert len(set(style.HATCH.values())) == 4
    assert all(shades.FATES[fate][1] == style.FILL[word] for fate, word in (
        (Fate.BOUNDED, "bounded"), (Fate.SPIN_UP, "spin-up"), (Fate.UNDECIDED, "undecided")))
