"""One visual style for every picture: colours, markers and line styles by meaning, and bytes that do not
change."""
from __future__ import annotations

import math
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..files import whole_file
from ..packages import demand
from . import endings

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..equilibrium.result import CurveSegment, EquilibriumPoint

# Three palettes that share no colour, so that none means two things on a page, a picture or in the explorer:
# outcomes, axes, and what is drawn of neither. Black and greys have no meaning of their own: letters, dashes
# and markers tell torque, momentum and separatrix apart. Any two of the colours that stand on one screen
# differ by at least 12 of CIEDE2000, for readers without one of the three pigments too
# (tests/show/test_palettes.py); lines have a contrast of at least 3 on white.
BLACK, GREY, PALE = "#000000", "#757575", "#DDDDDD"
BLUE, AMBER, VERMILION = "#0057B8", "#C88700", "#BE3200"  # stays; not decided; does not stay
PLUM, TEAL, PINE = "#6E1060", "#0094A8", "#0E4636"        # axes 1, 2, 3
VIOLET, SAGE, WINE = "#AA66FF", "#668855", "#880000"      # the motion itself; the first two of other series
# the same hues for methods and printed curves, on pages that have neither outcomes nor axes
ORANGE, SKY, GREEN, PURPLE = AMBER, TEAL, PINE, PLUM

LOOK = {"bounded": BLUE, "changes": VERMILION, "conditional": AMBER}  # of a headline
AXES = (PLUM, TEAL, PINE)
# areas: tints that are told apart as lines are; the axis of a spin-up is said by its hatch and a letter
FILL = {"bounded": "#7FA9DB", "spin-up": "#C96845", "separatrix": "#4A4A4A", "equilibrium": "#969696",
        "undecided": "#F8E878", "no case": "#D0D0D0"}
AGAINST = "#E3A890"  # a spin-up against its axis
HATCH = {1: "//", 2: "||", 3: "\\\\", 0: ".."}  # axis of a spin-up, 0: none of the principal ones
LISTED = ("#99BB88", "#CCAAFF", "#555555", "#E2E2E2", "#858585")  # areas of other words, in order

MEANING = {  # what a line or a point stands for -> how it is drawn
    "stable": {"color": BLUE, "linestyle": "-", "linewidth": 2.0},
    "unstable": {"color": VERMILION, "linestyle": "--", "linewidth": 1.8},
    "undecided": {"color": AMBER, "linestyle": ":", "linewidth": 2.0},
    "separatrix": {"color": BLACK, "linestyle": "-", "linewidth": 1.2},
    "separatrix 2": {"color": GREY, "linestyle": "-", "linewidth": 1.6},
    "bounded": {"color": BLUE, "linestyle": "-", "linewidth": 1.4},
    "spin-up": {"color": VERMILION, "linestyle": "-", "linewidth": 1.4},
    "crossing": {"color": GREY, "linestyle": "-.", "linewidth": 1.6},
    "level": {"color": GREY, "linestyle": "-", "linewidth": 0.6},
    "fold": {"color": BLACK, "linestyle": (0, (1, 1)), "linewidth": 1.6},
    "printed": {"color": SAGE, "linestyle": ":", "linewidth": 2.0},
    "dividing": {"color": BLACK, "linestyle": "-.", "linewidth": 1.3},
    "this motion": {"color": VIOLET, "linestyle": "-", "linewidth": 2.2},
}
MARKER = {
    "centre": {"marker": "o", "color": BLUE, "markersize": 6, "linestyle": "none"},
    "saddle": {"marker": "o", "markerfacecolor": "white", "markeredgecolor": VERMILION,
               "markeredgewidth": 1.6,
               "markersize": 6.5, "linestyle": "none"},
    "degenerate": {"marker": "D", "markerfacecolor": "white", "markeredgecolor": BLACK, "color": BLACK,
                   "markeredgewidth": 1.4, "markersize": 6, "linestyle": "none"},
    "undecided": {"marker": "D", "markerfacecolor": "white", "markeredgecolor": AMBER,
                  "markeredgewidth": 1.8, "color": AMBER, "markersize": 6, "linestyle": "none"},
    "start": {"marker": "s", "color": BLACK, "markersize": 5, "linestyle": "none"},
    "turning": {"marker": "^", "color": BLACK, "markersize": 6, "linestyle": "none"},
}
EQUILIBRIA = {"stable": "stable equilibria", "unstable": "unstable equilibria",
              "undecided": "equilibria of undecided stability"}  # kind -> its words in a legend
SPACE: dict[str, dict[str, Any]] = {  # words of a legend -> how that is drawn in the space of rates
    "this motion": MEANING["this motion"], "start": MARKER["start"],
    "nearest point of the separatrix": {"marker": "o", "color": PALE, "markeredgecolor": BLACK,
                                        "markersize": 6, "linestyle": "none"},
    "limit of |ω|": {"color": VERMILION}, "assumed limit of |ω|": {"color": VERMILION},
    "least to greatest": {"color": VIOLET},
    **{equilibrium: MEANING[kind] for kind, equilibrium in EQUILIBRIA.items()}}
SURFACES = ("#B4BABE", "#5F6467", "#EFEDE9", "#868B8F")  # of the separatrix, in order: greys
SERIES = (BLACK, VIOLET, SAGE, WINE, GREY)               # one curve each for a list of parameters
SCALE = ("#DCC8FF", VIOLET, "#2A0055")                   # of numbers on a map, from the least to the greatest

PACKAGES = ("matplotlib", "PIL")  # of every picture
DPI = 110
PAGE = 64  # colours of a picture on a page
AREA, LINE = 0.002, 2e-4  # parts of a picture in one colour: from which on it is drawn in no other
APART = 24  # of 255: but for so much
SMALL = 8  # how hard zlib tries: the last step takes thrice as long for two parts in a hundred
TITLE_LINES = 2  # of a picture of its own; more stand below it
MARGIN = 0.3  # inches beside a line of a title
TITLE = 0.008  # inches that a letter of a title takes, a point of its size
# inches from which on letters have their full size; the least share of it in smaller figures: 7 points
ROOMY, SMALLEST = (5.6, 3.8), 0.7
RC: dict[Any, Any] = {  # of Matplotlib
    "figure.dpi": DPI, "savefig.dpi": DPI, "figure.facecolor": "white", "axes.facecolor": "white",
    "font.family": "DejaVu Sans", "font.size": 10, "axes.titlesize": 10.5, "axes.labelsize": 10.5,
    "legend.fontsize": 8.5, "xtick.labelsize": 9, "ytick.labelsize": 9, "axes.linewidth": 0.8,
    "axes.grid": True, "grid.color": "#DDDDDD", "grid.linewidth": 0.5, "axes.axisbelow": True,
    "legend.frameon": True, "legend.framealpha": 0.92, "legend.edgecolor": "#BBBBBB",
    "lines.solid_capstyle": "round", "hatch.linewidth": 0.5,
    "mathtext.fontset": "dejavusans", "axes.formatter.use_mathtext": True, "svg.hashsalt": "stabilab",
}

# of legends in small figures, in letters
DENSE = {"legend.handlelength": 1.3, "legend.handletextpad": 0.5, "legend.columnspacing": 1.0,
         "legend.labelspacing": 0.2, "legend.borderpad": 0.3}


def kind_of(part: CurveSegment | EquilibriumPoint) -> str:
    """Which of EQUILIBRIA an equilibrium or a piece of a curve of them is: as its verdict has it."""
    return next(kind for kind in ("undecided", "unstable", "stable") if kind in part.verdict)


def quiet_matplotlib() -> None:
    """Leave Matplotlib no message below an error: without a home that can be written it warns at length, and
    draws all the same."""
    import logging
    logging.getLogger("matplotlib").setLevel(logging.ERROR)


@contextmanager
def drawing():
    """matplotlib.pyplot with this style and the file back end; figures opened inside are closed at the end.
    """
    quiet_matplotlib()
    import matplotlib
    matplotlib.use("Agg", force=False)
    import matplotlib.pyplot as plt
    before = set(plt.get_fignums())
    with matplotlib.rc_context(RC):
        try:
            yield plt
        finally:
            for number in set(plt.get_fignums()) - before:
                plt.close(number)


# what each format would note of the day and the version
_UNDATED = {".svg": {"Date": None, "Creator": None},
            ".pdf": {"CreationDate": None, "Creator": None, "Producer": None}}


def save(figure: Figure, path: Path | str, dpi: float | None = None, colours: int = 256) -> Path:
    """Write a picture in the format of its ending (.png, .svg, .pdf), whole or not at all, with no date or
    version inside: the same picture gives the same bytes. A .png has few colours, 256 unless fewer are
    asked for and an eye sees no difference, which keeps a drawing well under 200 kB. dpi: dots an inch, None
    for those of the house. Raises InputError for other endings."""
    path = endings.file(path, endings.PICTURES)
    kind = endings.ending(path)
    _plain_numbers(figure)
    with whole_file(path) as waiting:
        if kind == ".png":
            small = _of_few_colours(_drawn(figure, dpi or DPI), colours)
            small.save(waiting, format="png", compress_level=SMALL)
        else:
            figure.savefig(waiting, format=kind[1:], dpi=dpi or DPI, metadata=_UNDATED[kind])
    return path


def _plain_numbers(figure: Figure) -> None:
    """Draw the numbers at ticks as text: Matplotlib typesets each as a formula, and finding its size again
    and again takes a quarter of the time of a picture. A power of ten beside the axis stays a formula."""
    from matplotlib.ticker import ScalarFormatter

    class Plain(ScalarFormatter):
        def __call__(self, x, pos=None):
            return super().__call__(x, pos).removeprefix(r"$\mathdefault{").removesuffix("}$")

    for ax in figure.axes:
        for axis in filter(None, (ax.xaxis, ax.yaxis, getattr(ax, "zaxis", None))):
            usual = axis.get_major_formatter()
            if type(usual) is ScalarFormatter:
                axis.set_major_formatter(Plain(usual.get_useOffset(), usual.get_useMathText()))


def _drawn(figure: Figure, dpi: float):
    """The figure as a Pillow image. A canvas lays it out and draws it once; savefig would draw it twice. Its
    own canvas, where that can, knows the sizes of words that were measured while the figure was built."""
    import numpy as np
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from PIL import Image
    before = figure.dpi, figure.canvas
    try:
        figure.dpi = dpi
        canvas = before[1] if type(before[1]) is FigureCanvasAgg else FigureCanvasAgg(figure)
        canvas.draw()
        return Image.fromarray(np.asarray(canvas.buffer_rgba())).convert("RGB")
    finally:
        figure.dpi = before[0]
        figure.set_canvas(before[1])


def _of_few_colours(image, colours):
    """A Pillow image in so many colours, those of the house and of its areas among them: stripes below it
    make them common, and are cut off again. In twice as many colours where an area would have another."""
    from PIL import Image
    ours = dict.fromkeys(map(_levels, (BLACK, "#FFFFFF", GREY, BLUE, AMBER, VERMILION, *AXES, VIOLET, SAGE,
                                       WINE, *SURFACES, *FILL.values(), AGAINST)))
    pixels = image.width * image.height
    areas = [colour for count, colour in image.getcolors(pixels)
             if count > (LINE if colour in ours else AREA) * pixels and colours < 256]
    stripes = {colour: image.height + 4 * n for n, colour in enumerate(dict.fromkeys([*ours, *areas]))}
    tall = Image.new("RGB", (image.width, image.height + 4 * len(stripes)))
    tall.paste(image)
    for colour, top in stripes.items():
        tall.paste(colour, (0, top, image.width, top + 4))
    while True:
        few = tall.quantize(colours, dither=Image.Dither.NONE)
        palette = few.getpalette()
        shown = {area: palette[3 * few.getpixel((0, stripes[area])):][:3] for area in areas}
        if colours == 256 or all(abs(a - b) <= APART for area in areas for a, b in zip(area, shown[area])):
            return few.crop((0, 0, *image.size))
        colours = min(2 * colours, 256)


def _levels(colour: str) -> tuple[int, ...]:
    """Red, green and blue of "#RRGGBB", of 255."""
    return tuple(bytes.fromhex(colour[1:]))


def write(out, draw, dpi: float | None = None) -> Path:
    """Write the figure that draw(plt) makes and return its path. Raises InputError for another ending, before
    anything is drawn."""
    demand(*PACKAGES)
    target = endings.file(out, endings.PICTURES)
    with drawing() as plt:
        return save(draw(plt), target, dpi)


def explained(rows) -> tuple[list, list[str]]:
    """(handles, names) for a legend of rows (name, look), each name once; a look with a colour of its face is
    an area."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch
    looks = dict(rows)
    handles = [Patch(**look) if "facecolor" in look else Line2D([], [], **look) for look in looks.values()]
    return handles, list(looks)


def legend(figure, rows, columns: int | None = None, notes: str = ""):
    """One legend below the picture, if there is anything to tell: rows of (name, look). columns: at most;
    None for as many as fit. notes: lines above the rows."""
    below(figure, *explained(rows), columns, notes)


def below(figure, handles, names, columns: int | None = None, notes: str = ""):
    """A legend below a figure, if there are any names or notes, of as few rows of about the same length as
    fit."""
    for rows in range(1, max(len(names), bool(notes)) + 1):
        across = max(1, min(-(-len(names) // rows), columns or len(names)))
        built = figure.legend(handles, names, loc="outside lower center", ncols=across, title=notes or None,
                              title_fontsize=RC["legend.fontsize"] * share())
        if columns or rows >= len(names) or built.get_window_extent().width <= 0.97 * figure.bbox.width:
            return
        built.remove()


def letters(size: tuple[float, float] | None) -> dict[str, float]:
    """The sizes of letters in a figure of so many inches: smaller, and with less room between the names of a
    legend, in a small one, of which words would leave nothing else."""
    fraction = (1.0 if size is None
             else max(SMALLEST, min(1.0, *(supplied / roomy for supplied, roomy in zip(size, ROOMY)))))
    dense = {} if fraction == 1 else DENSE
    return {key: fraction * value for key, value in RC.items() if key.endswith("size")} | dense


def share() -> float:
    """The size of letters now, as a share of that of the house; 1 where a caller has larger ones."""
    import matplotlib
    return min(1.0, float(matplotlib.rcParams["font.size"]) / float(RC["font.size"]))


def fitting(text: str, width: float) -> float:
    """The size of letters, in points, at which a line fits a figure of so many inches: that of titles, or a
    smaller one, of notes at least."""
    import matplotlib
    from matplotlib.font_manager import FontProperties
    usual = FontProperties(size=matplotlib.rcParams["axes.titlesize"]).get_size_in_points()
    least = RC["legend.fontsize"] * share()
    return max(min(usual, least), min(usual, (width - MARGIN) / (TITLE * max(1, len(text)))))


def titled(heading: str, said: list[str], width: float,
           most: int = TITLE_LINES) -> tuple[str, float, list[str], str]:
    """(the text of a title of so many lines, the size of its letters, lines without room in it, what of the
    text is not the heading), for a heading as its user wrote it and lines of the program, over so many
    inches."""
    size = fitting(said[0] if said else "", width)
    first = clauses(said[0], width, size).split("\n") if said else []
    if len(first) > 1 and (share() == 1 or len(first) > most):
        first, said = [], ["", *said]
    room = most - len(first)
    own = clauses(heading, width, size).split("\n") if heading else []
    if len(own) > room > 0:
        own[room - 1:] = [f"{own[room - 1].rstrip(',;:')} ..."]
    own, first = list(map(literal, own[:room])), list(map(literal, first))
    return "\n".join([*own, *first]), size, said[1:], "\n".join(first)


def over(figure, heading: str, line: str = "", left: bool = False) -> list[str]:
    """Give a figure a title as of `titled`, of a line at most beside the heading; returns that line where it
    has no room. left: at its left edge, not in the middle."""
    text, size, rest, _ = titled(heading, [line] if line else [], figure.get_figwidth())
    figure.suptitle(text, fontsize=size, **({"x": 0.02, "ha": "left"} if left else {}))
    return rest


def above(ax, heading: str, line: str = "") -> list[str]:
    """As `over`, at the left of axes that are as wide as their figure."""
    text, size, rest, _ = titled(heading, [line] if line else [], ax.figure.get_figwidth())
    ax.set_title(text, fontsize=size, loc="left")
    return rest


def clauses(text: str, width: float, size: float | None = None) -> str:
    """Clauses in lines that fit a figure of so many inches: each ends with a clause where one alone is no
    longer than a line; a longer one is parted into lines of about one length. size: of letters, in points;
    None: of a title."""
    import textwrap

    largest = math.floor((width - MARGIN) / (TITLE * (fitting("", width) if size is None else size)) + 1e-6)
    lines = [""]
    for clause in text.replace("; ", "; \n").split("\n"):
        if lines[-1] and len(lines[-1]) + len(clause.rstrip()) > largest:
            lines.append("")
        lines[-1] += clause
        count = math.ceil(len(lines[-1].rstrip()) / largest)
        if count > 1:
            full = _measured_together(lines[-1])  # textwrap ends no line there
            fits = (textwrap.wrap(full, wide, break_on_hyphens=False)
                    for wide in range(len(lines[-1]) // count, len(lines[-1])))
            *before, last = next((parts for parts in fits if len(parts) <= count), [full])
            lines[-1:] = [*before, f"{last} "]
    return "\n".join(line.rstrip() for line in lines).replace("\u00a0", " ")


def _measured_together(text: str) -> str:
    """The text with no-break spaces within measured values: lambda3 = 0.1 N m s."""
    first, *others = text.split(" ")
    built = first
    for before, after in pairwise((first, *others)):
        held = (before == "=" or after.startswith("=") or (before[-1:].isdecimal() and after[:1].isalpha())
                or (before, after.rstrip(",;:.)^23²³")) in (("N", "m"), ("m", "s"), ("kg", "m")))
        built += ("\u00a0" if held else " ") + after
    return built


def literal(text: str) -> str:
    """A title of the user's as it is drawn: as written, where a dollar begins no formula. (Matplotlib's
    parse_math=False does not reach the lines that it wraps.)"""
    return text.replace("$", r"\$")
