"""What accuracy costs in one picture: time against correct digits of at most five methods, of a first run and
of one that is repeated."""
from __future__ import annotations

import math
from functools import partial
from pathlib import Path

import numpy as np

from ..cost.accuracy import Precision
from ..errors import InputError
from . import narrow, style
from .terminal import printed
from .text.cost import by_digits, duration

CURVES = {  # method -> colour and what stands at its end; the first five that answered are drawn
    "taylor": (style.BLUE, "Taylor series"), "reduced": (style.GREEN, "closed form"),
    "reference": (style.BLACK, "many digits,\nrun twice"), "DOP853": (style.VERMILION, "DOP853"),
    "RK45": (style.ORANGE, "RK45"), "LSODA": (style.GREY, "LSODA"), "linear": (style.PURPLE, "linear model")}
MANY = 5
RULES = ((1e-3, "1 ms"), (1.0, "1 s"))  # across the picture
SIZE = (8.2, 5.0)  # inches
GAP, STEP, REACH = 6.0, 3.0, 90.0  # points from the end of a curve to its label, between the places that are
# tried, and the farthest of them
CLEAR = 2.0  # points that stay free about a label
LED = 14.0  # points from its curve's end from which on a label has a line to it
MARGIN = 3.0  # times what is drawn, above and below


def picture(plt, result: Precision, size=None):
    """Solid: a run that is repeated, dashed: the first one of a process, with the import of the integrator
    and the compiling of its setting. size: (width, height) in inches."""
    figure, label = _unlabelled(plt, result, size)
    label()
    return figure


def _unlabelled(plt, result: Precision, size=None):
    """The figure, and what puts the names at the ends of its curves, once its size is final."""
    curves = drawn(result)
    if not curves:
        raise InputError(f"{result.case.name}: nothing to draw: {result.reference.reason}")
    figure, ax = plt.subplots(figsize=size or SIZE, layout="constrained")
    ends, lines = [], []
    for method, rows in curves.items():
        colour, label = CURVES[method]
        digits, again, once = zip(*rows)
        ax.plot(digits, again, color=colour, linewidth=2.0, marker="o", markersize=4.5, zorder=3)
        if method != "reference":
            ax.plot(digits, once, color=colour, linewidth=1.3, linestyle=(0, (4, 2)), zorder=2)
        lines += [np.array([digits, times]).T for times in (again, *[once] * (method != "reference"))]
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
    solid, dashed = {"color": style.BLACK, "linewidth": 2.0}, {"color": style.BLACK, "linewidth": 1.3,
                                                              "linestyle": (0, (4, 2))}
    style.legend(figure, [("again, in the same process", solid),
                          ("first run: with import and compiling", dashed)], columns=2)
    ax.set_title(style.literal(printed(headline(result))), fontsize=11.5 * style.share())
    return figure, partial(_label, ax, ends, lines)


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


def _label(ax, ends, curves) -> None:
    """The names at the ends of the curves, rows (digits, seconds, name, colour): each at the nearest place
    where it covers no curve (arrays (n, 2) of points) and no other name."""
    figure = ax.figure
    figure.draw_without_rendering()  # the layout, which says where points are
    scale = figure.dpi / 72
    room = ax.get_window_extent().padded(-CLEAR * scale)
    drawn = np.concatenate([_dense(ax.transData.transform(curve), scale) for curve in curves])
    taken = [text.get_window_extent() for text in ax.texts]
    for digits, seconds, name, colour in ends:
        text = ax.annotate(name, (digits, seconds), (GAP, 0), textcoords="offset points", color=colour,
                           va="center", fontsize=10 * style.share(), annotation_clip=False)
        box, at = text.get_window_extent(), ax.transData.transform((digits, seconds))
        wide, high = box.width / scale, box.height / scale
        right, up = next((offset for offset in _offsets(wide, high)
                          if _free(_placed(at, offset, wide, high, scale), room, taken, drawn)), (GAP, 0.0))
        text.set_position((right, up))
        taken.append(_placed(at, (right, up), wide, high, scale))
        if math.hypot(max(right, -right - wide, 0.0), max(abs(up) - high / 2, 0.0)) > LED:
            near = right if right > 0 else right + wide if right + wide < 0 else 0.0
            ax.annotate("", (digits, seconds), (near, up - math.copysign(high / 2, up)),
                        textcoords="offset points", annotation_clip=False,
                        arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.7})


def _offsets(wide: float, high: float) -> list[tuple[float, float]]:
    """Places of a label's left side and middle, in points from the end of its curve, the nearest first: on
    the right, above and below, on the left."""
    heights = [sign * STEP * n for n in range(int(REACH / STEP)) for sign in (1, -1)]
    places = [(abs(up) + worse, right, up) for up in heights
              for right, worse in ((GAP, 0.0), (-wide / 2, 8.0), (-wide - GAP, 16.0))
              if not worse or abs(up) > high / 2 + GAP]
    return [(right, up) for _, right, up in sorted(places)]


def _placed(at, offset, wide, high, scale):
    """The box of a label of so many points at an offset from a point of the picture, in pixels."""
    from matplotlib.transforms import Bbox
    left, middle = at[0] + offset[0] * scale, at[1] + offset[1] * scale
    return Bbox.from_bounds(left, middle - high * scale / 2, wide * scale, high * scale)


def _free(box, room, taken, drawn) -> bool:
    """Whether a label lies in the panel, off all other labels and all points of the curves."""
    within = room.x0 <= box.x0 and box.x1 <= room.x1 and room.y0 <= box.y0 and box.y1 <= room.y1
    if not within or any(box.overlaps(other) for other in taken):
        return False
    low, high = np.array(box.min) - 2 * CLEAR, np.array(box.max) + 2 * CLEAR
    return not ((drawn > low) & (drawn < high)).all(axis=1).any()


def _dense(points: np.ndarray, scale: float) -> np.ndarray:
    """Points along a line through points (n, 2), in pixels, a point of type or less apart."""
    if len(points) < 2:
        return points
    far = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    at = np.arange(0.0, far[-1] + scale, scale)
    return np.stack([np.interp(at, far, values) for values in points.T], axis=-1)


def headline(result: Precision) -> str:
    """What the most digits in doubles and the most of all cost, in one line; first runs in the next."""
    rows = by_digits(result)
    doubles = [row for row in rows if row["method"] != "reference"][-1:]
    chosen = [*doubles, *(row for row in rows[-1:] if row not in doubles)]
    again = ", ".join(f"{row['digits']} digits {duration(row['seconds'])}" for row in chosen)
    once = ", ".join(f"{row['digits']} digits {duration(row['once']['first_seconds'])}" for row in chosen)
    return f"{result.case.name}: {again}\nfirst run: {once}"


def write_both(result: Precision, path: Path) -> tuple[Path, Path]:
    """The picture as a .png file, and beside it the narrow one, whose labels have places of their own."""
    with style.drawing() as plt:
        wide = style.save(picture(plt, result), path, colours=style.PAGE)
        figure, label = _unlabelled(plt, result)
        ax = figure.axes[0]
        ax.set_title(ax.get_title().partition(": ")[2])  # without the name of the case
        narrow.narrowed(figure)
        label()
        return wide, style.save(figure, narrow.beside(path), narrow.DPI, narrow.COLOURS)


def write(result: Precision, path: Path, size=None) -> Path:
    """The picture as a file (.png, .svg, .pdf)."""
    with style.drawing() as plt:
        return style.save(picture(plt, result, size), path)
