"""What accuracy costs in one picture: time against correct digits of at most five methods, of a first run and
of one that is repeated."""
from __future__ import annotations

import math
from pathlib import Path

from ..cost.accuracy import Precision
from ..errors import InputError
from . import style
from .terminal import printed
from .text.cost import by_digits, duration

CURVES = {  # method -> colour and what stands at its end; the first five that answered are drawn
    "taylor": (style.BLUE, "Taylor series"), "reduced": (style.GREEN, "closed form"),
    "reference": (style.BLACK, "many digits,\nrun twice"), "DOP853": (style.VERMILION, "DOP853"),
    "RK45": (style.ORANGE, "RK45"), "LSODA": (style.GREY, "LSODA"), "linear": (style.PURPLE, "linear model")}
MANY = 5
RULES = ((1e-3, "1 ms"), (1.0, "1 s"))  # across the picture
SIZE = (8.2, 5.0)  # inches
APART, WIDE = 0.06, 4.0  # height of a label, as a part of the picture's, and its width in digits
PAPER = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.5}  # behind a label
MARGIN = 3.0  # times what is drawn, above and below


def picture(plt, result: Precision, size=None):
    """Solid: a run that is repeated, dashed: the first one of a process, with the import of the integrator
    and the compiling of its setting. size: (width, height) in inches."""
    curves = drawn(result)
    if not curves:
        raise InputError(f"{result.case.name}: nothing to draw: {result.reference.reason}")
    figure, ax = plt.subplots(figsize=size or SIZE, layout="constrained")
    ends = []
    for method, rows in curves.items():
        colour, label = CURVES[method]
        digits, again, once = zip(*rows)
        ax.plot(digits, again, color=colour, linewidth=2.0, marker="o", markersize=4.5, zorder=3)
        if method != "reference":
            ax.plot(digits, once, color=colour, linewidth=1.3, linestyle=(0, (4, 2)), zorder=2)
        ends.append((digits[-1], again[-1], label, colour))
    times = [time for rows in curves.values() for row in rows for time in row[1:]]
    times += [time for time, _ in RULES]
    low, high = min(times) / MARGIN, max(times) * MARGIN
    last = max(row[0] for rows in curves.values() for row in rows)
    ax.set(yscale="log", ylim=(low, high), xlim=(0, last + 0.2 * max(last, 15)), ylabel="processor time (s)",
           xlabel="correct digits of the states over the span")
    for time, label in RULES:
        ax.axhline(time, color=style.GREY, linewidth=0.9, zorder=1)
        ax.annotate(label, (0.995, time), (0, 2), xycoords=("axes fraction", "data"),
                    textcoords="offset points", color=style.GREY, fontsize=9 * style.share(), va="bottom",
                    ha="right")
    _label(ax, ends, low, high)
    solid, dashed = {"color": style.BLACK, "linewidth": 2.0}, {"color": style.BLACK, "linewidth": 1.3,
                                                              "linestyle": (0, (4, 2))}
    style.legend(figure, [("again, in the same process", solid),
                          ("first run: with import and compiling", dashed)], columns=2)
    figure.suptitle(printed(headline(result)), fontsize=12 * style.share(), parse_math=False)
    return figure


def drawn(result: Precision) -> dict[str, list[tuple[float, float, float]]]:
    """method -> rows (digits, seconds again, seconds of a first run) of the states over the span, fewest
    digits first: the cheapest settings of at most `MANY` methods, and the reference by its own runs."""
    rows: dict[str, list[tuple[float, float, float]]] = {}
    for method in CURVES:
        points = [(p.digits, p.seconds, p.first) for p in result.of("span", method)
                  if p.lanes == 1 and not p.parts and 0 < p.digits < math.inf]
        if method == "reference" and len(result.reference.t):
            points = [(float(result.reference.digits[0]), result.reference_seconds, result.reference_seconds)]
        if points and len(rows) < MANY:
            rows[method] = sorted(_worth(points))
    return rows


def _worth(points: list[tuple[float, float, float]]) -> list[tuple[float, float, float]]:
    """Without settings that have no more digits than a coarser one: steps that rounding has ended."""
    result: list[tuple[float, float, float]] = []
    for point in points:
        if not result or point[0] > result[-1][0]:
            result.append(point)
    return result


def _label(ax, ends, low: float, high: float) -> None:
    """The names at the ends of the curves, moved apart where they would meet."""
    height, taken = math.log(high / low), []
    for x, time, label, colour in sorted(ends, key=lambda end: end[1]):
        share = math.log(time / low) / height
        share = max([share, *(beside + APART for other, beside in taken
                              if abs(other - x) < WIDE and abs(beside - share) < APART)])
        taken.append((x, share))
        ax.annotate(label, (x, time), (x + 0.4, low * (high / low) ** share), color=colour, va="center",
                    bbox=PAPER, fontsize=10 * style.share(), annotation_clip=False)


def headline(result: Precision) -> str:
    """What the most digits in doubles and the most of all cost, in one line; first runs in the next."""
    rows = by_digits(result)
    doubles = [row for row in rows if row["method"] != "reference"][-1:]
    chosen = [*doubles, *(row for row in rows[-1:] if row not in doubles)]
    again = ", ".join(f"{row['digits']} digits {duration(row['seconds'])}" for row in chosen)
    once = ", ".join(f"{row['digits']} digits {duration(row['once']['first_seconds'])}" for row in chosen)
    return f"{result.case.name}: {again}\nfirst run: {once}"


def write(result: Precision, path: Path, size=None) -> Path:
    """The picture as a file (.png, .svg, .pdf)."""
    with style.drawing() as plt:
        return style.save(picture(plt, result, size), path)
