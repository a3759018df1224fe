"""Histories and planes of several motions in one picture: a row per quantity, a column per value of a
parameter.

In every panel the exact motion and the models of it. Limits come from the exact motion: a model that runs out
of them is drawn to where it leaves the panel, which says how far it goes. Where a printed curve leaves a
panel, one of the last panels shows the printed curves alone and whole, as the paper's figure does. More
panels than six are divided among several pictures.
"""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np

from ...show import style
from ...show.text import cost
from ..families import Family, Span, compared

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ...answers.simulate import Simulation

TIME = "$t$ (s)"
# How each model is drawn: the pale ones are broad and lie under the exact motion, the others over it, so that
# two that agree are both seen.
LOOKS: dict[str, dict] = {
    "linear": {"color": "#A9D6F0", "linewidth": 4.6, "zorder": 1.6},
    "corrected": {"color": "#E3B5D0", "linewidth": 2.8, "zorder": 1.7},
    "lindstedt": {"color": style.SKY, "linewidth": 0.6, "antialiased": False, "zorder": 1.6},
    "exact": {"color": style.BLACK, "linewidth": 2.0, "zorder": 2.0},
    "averaged1": {"color": style.GREEN, "linewidth": 1.4, "linestyle": "-.", "zorder": 2.1},
    "averaged2": {"color": style.SKY, "linewidth": 1.4, "linestyle": "--", "zorder": 2.2},
    "printed": {"color": style.ORANGE, "linewidth": 1.6, "linestyle": ":", "zorder": 2.3}}
# Of words: darker, to be read
INK = ({name: look["color"] for name, look in LOOKS.items()}
       | {"linear": style.BLUE, "lindstedt": style.BLUE, "corrected": "#9C4A7B", "printed": "#946300"})
WIDE = 3.0  # a model may stretch the axis to this many times the exact motion's range; beyond that it is cut
TALL = 1.45  # a plane of one scale, against a history
MARGIN = 0.06
PANELS = 6  # of a picture at most
# Of the values of a parameter in a panel of printed curves alone: shades of the hue that stands for the
# model beside it, so that no colour means two
# things in a picture, and a dash each, the sparser over the fuller, so that curves that agree are all seen.
DASHES = ((":", 2.3), ("--", 2.2), ("-", 2.1))
ALONE = tuple({"color": c, "linewidth": 1.6, "linestyle": s, "zorder": z}
              for c, (s, z) in zip((style.ORANGE, "#9A5B00", "#4A2C00"), DASHES))
NEIGHBOUR_LOOKS = tuple({"color": c, "linewidth": 0.8, "linestyle": s, "zorder": z - 0.5}
               for c, (s, z) in zip((style.PURPLE, "#9C4A7B", "#4F2440"), DASHES))
# a point that printed formulas give
POINT = {"color": style.ORANGE, "marker": "+", "markersize": 11, "markeredgewidth": 2, "linestyle": "none"}
LINE = 13  # points from a line of words above a panel to the next
# in the legend, after the exact motion
ORDER = ("printed", "corrected", "averaged1", "linear", "averaged2", "lindstedt")
MODEL_LABELS = cost.MODEL_LABELS | {"corrected": "corrected integrals, frequency (8)"}


@dataclass(frozen=True)
class Row:
    """One quantity: pick(run) -> (x, y) arrays, or None where a model does not have it; equal: both axes to
    one scale; limits: ((x low, x high), (y low, y high)) where the motion itself runs off to infinity."""

    xlabel: str
    ylabel: str
    pick: Any
    equal: bool = False
    limits: tuple | None = None

    @property
    def over_time(self) -> bool:
        return self.xlabel == TIME


@dataclass(frozen=True)
class Column:
    """One value of the parameter: heading; runs: model -> run; mark: a time to draw a vertical line at, or
    None; refused: model -> why it has no curve; point: (x, y) to mark in a plane, or None."""

    heading: str
    runs: dict = field(repr=False)
    mark: float | None = None
    refused: dict = field(default_factory=dict, repr=False)
    point: tuple | None = None


def columns_of(family: Family, span: Span) -> list[Column]:
    """A column for each case of a family."""
    built = []
    for value, case in family.cases.items():
        runs, refused = compared(*case, span)
        built.append(Column(rf"${family.symbol}={value:g}$ {family.unit}", runs, refused=refused))
    return built


def exactness(runs) -> str:
    """How exact the exact motions among `runs` (model -> Simulation each) are: by their laws."""
    drift = max((d for each in runs for d in each["exact"].invariant_drift.values()), default=0.0)
    return (
        f"exact motion: Taylor integration, relative tolerance 1.1e-16; its laws drift by {drift:.1e} "
        f"at most")


def draw_lines(plt, title, lines, width=3.5, height=2.05, words=None, mark_words="", own=False,
               point_words="") -> list:
    """The figures of lines (Row, [Column, ...]), of at most PANELS panels each. A line shares its limits,
    unless each panel has its own; the last panels show printed curves alone that leave the limits shared.
    mark_words, point_words: what the legend says of the columns' marks and points."""
    words, count = MODEL_LABELS | (words or {}), len(lines[0][1])
    full = [(row, columns, None) for row, columns in lines if not own and _leaves(row, columns)]
    cells = [[(row, columns, c) for c in columns] for row, columns in lines]
    cells += [full[n:n + count] for n in range(0, len(full), count)]
    each = max(1, PANELS // count)
    parts = [cells[n:n + each] for n in range(0, len(cells), each)]
    numbers = [f" ({n} of {len(parts)})" for n in range(1, len(parts) + 1)] if len(parts) > 1 else [""]
    marked = mark_words, point_words
    return [_picture(plt, title + number, part, (width * count, height), words, marked, own)
            for number, part in zip(numbers, parts)]


def _picture(plt, title, lines, size, text, marked, own):
    """A figure of lines of cells (Row, all columns of its line, its own or None for printed curves alone)."""
    width, height = size
    heights, count = [height * (TALL if line[0][0].equal else 1) for line in lines], max(map(len, lines))
    printed = [[_cuts(row, c, _window(row, [c] if own else columns)) if c else [] for row, columns, c in line]
            for line in lines]
    stacked = [max(0, *(len(cuts) - 1 for cuts in line)) for line in printed]
    figure, axes = plt.subplots(len(lines), count, squeeze=False, layout="constrained", height_ratios=heights,
                                figsize=(width, 1 + sum(heights) + sum(stacked) * LINE / 72))
    headings = [[f"{text['printed']}, alone" if c is None else c.heading for *_, c in line]
                for line in lines]
    for i, (line, more) in enumerate(zip(lines, stacked)):
        for ax in axes[i, len(line):]:
            ax.remove()
        for j, (ax, (row, columns, column), cuts) in enumerate(zip(axes[i], line, printed[i])):
            if column is None:
                _printed_alone(ax, row, columns)
            else:
                _panel(ax, row, column, _window(row, [column] if own else columns))
                _tell_cuts(ax, cuts)
                ax.tick_params(labelleft=own or not j)
                if not i:
                    _ending(ax, column)
            if not i or headings[i] != headings[i - 1][:len(line)]:
                ax.set_title(headings[i][j], pad=14 + LINE * more)  # above the words on cuts
            if not row.over_time or i + 1 == len(lines) or not lines[i + 1][0][0].over_time:
                ax.set_xlabel(row.xlabel)
            if not j or column is None:
                ax.set_ylabel(row.ylabel)
    # numbers at the ends of axes, headings below labels
    figure.get_layout_engine().set(w_pad=0.09, h_pad=0.04 if len(set(map(tuple, headings))) < 2 else 0.12)
    figure.suptitle(title, fontsize=11)
    by_heading = {c.heading: c for line in lines for *_, c in line if c is not None}
    notes = [f"{heading}: {why}" for heading, c in by_heading.items() for why in _refused(c, text)]
    style.legend(figure, _entries(lines, text, *marked),
                 notes="\n".join(style.clauses(note, figure.get_figwidth()) for note in notes))
    return figure


def _entries(lines, text, mark_words, point_words) -> list:
    """The rows of the legend of `_picture`."""
    cells = [cell for line in lines for cell in line]
    shown = [(row, c) for row, _, c in cells if c is not None]
    rows = [(text[name], LOOKS[name]) for name in ("exact", *ORDER) if any(name in c.runs for _, c in shown)]
    if mark_words and any(c.mark is not None and row.over_time for row, c in shown):
        rows.append((mark_words, style.MEANING["crossing"]))
    if point_words and any(c.point is not None for _, c in shown):
        rows.append((point_words, POINT))
    alone = next((columns for _, columns, c in cells if c is None), ())
    rows += [(f"alone: {c.heading}", look) for c, look in zip(alone, ALONE)]
    thin = any("corrected" in c.runs for c in alone)
    return rows + [("alone, thin: corrected integrals", NEIGHBOUR_LOOKS[1])] * thin


def _refused(column: Column, text: Mapping[str, str]) -> list[str]:
    """Which models have no curve in a column, and why."""
    why = {reason.text().split(": ")[0]: [text[m] for m, other in column.refused.items() if other == reason]
           for reason in column.refused.values()}
    return [f"{', '.join(f'no “{model}”' for model in models)}: {reason}" for reason, models in why.items()]


def _ending(ax, column):
    """In the panel, where curves leave room: which model ends early, and why."""
    from matplotlib.lines import Line2D
    rows = [(f"ends at {run.t[-1]:.3g} s: {run.because.split(' at t = ')[0]}",
             cost.END | {"color": LOOKS[name]["color"]})
            for name, run in column.runs.items() if cost.stops(run)]
    if rows:
        ax.legend([Line2D([], [], **look) for _, look in rows], [fill(text, 34) for text, _ in rows],
                  fontsize=7.5, loc="best")


def _picked(row: Row, columns: Sequence[Column], model: str) -> list:
    """(heading, x, y) of every column's curve of a model."""
    picked = ((c.heading, row.pick(c.runs[model])) for c in columns if model in c.runs)
    return [(heading, *(np.asarray(v, float) for v in xy))
            for heading, xy in picked if xy is not None and len(xy[0])]


def _leaves(row: Row, columns: Sequence[Column]) -> bool:
    """Whether a printed curve leaves the limits that the columns share."""
    limits = _window(row, columns)
    return any(cost.beyond(v, *ends) for _, *xy in _picked(row, columns, "printed")
               for v, ends in zip(xy, limits))


def _printed_alone(ax, row, columns):
    """The printed curves of all columns in one panel, whole, in limits of their own: what a reader of the
    paper knows."""
    for model, looks in (("printed", ALONE), ("corrected", NEIGHBOUR_LOOKS)):
        for (_, x, y), look in zip(_picked(row, columns, model), looks):
            ax.plot(x, y, **look)
    if row.limits is not None:
        ax.set_xlim(*row.limits[0])
        ax.set_ylim(*row.limits[1])
    elif row.equal:
        ax.set_aspect("equal", adjustable="datalim")
    elif row.over_time:
        ax.set_xlim(*_window(row, columns)[0])


def _panel(ax, row, column, limits):
    for name in ("exact", *reversed(ORDER)):
        if (picked := _curve(row, column, name)) is None:
            continue
        x, y = picked
        ax.plot(x, y, **LOOKS[name])
        if cost.stops(column.runs[name]) and len(x):
            ax.plot(x[-1:], y[-1:], color=LOOKS[name]["color"], **cost.END)
    if column.mark is not None and row.over_time:
        ax.axvline(column.mark, **style.MEANING["crossing"])
    if column.point is not None and not row.over_time:
        ax.plot(*([value] for value in column.point), **POINT, zorder=2.4)
    ax.set_xlim(*limits[0])
    ax.set_ylim(*limits[1])
    if row.equal:
        ax.set_aspect("equal", adjustable="box")


def _curve(row: Row, column: Column, name: str):
    """(x, y) of a model's curve in a column, or None where it has none."""
    picked = row.pick(column.runs[name]) if name in column.runs else None
    return None if picked is None else tuple(np.asarray(v, float) for v in picked)


def _cuts(row: Row, column: Column, limits: Sequence[tuple[float, float]]) -> list[tuple[str, str]]:
    """(model, words how far it goes) of every curve of a panel that leaves its limits, upwards, downwards or
    sideways."""
    rows = []
    for name in ("exact", *reversed(ORDER)):
        picked = _curve(row, column, name)
        if picked is None or not len(picked[0]):
            continue
        labels = ("", "") if row.over_time else (f"{_bare(row.xlabel)} ", f"{_bare(row.ylabel)} ")
        spans = [cost.beyond(v, *ends) for v, ends in zip(picked, limits)]
        printed = [f"{label}{'from ' if len(span) > 1 else 'to '}{' to '.join(span)}"
                for label, span in zip(labels, spans) if span]
        rows += [(name, f"cut: {', '.join(printed)}")] * bool(printed)
    return rows


def _tell_cuts(ax: Axes, cuts: Sequence[tuple[str, str]]):
    """Above a panel, how far each curve goes that leaves it, in its colour."""
    for n, (name, text) in enumerate(cuts):
        ax.annotate(text, (1.0, 1.01), (0, LINE * n), xycoords="axes fraction", textcoords="offset points",
                    color=INK[name], ha="right", va="bottom", fontsize=8.6)


def _bare(label: str) -> str:
    """The label of an axis without its unit."""
    return label.split(" (")[0]


def _window(row: Row, columns: Sequence[Column]):
    """Limits of both axes; for a plane of one scale a square."""
    limits = [_limits(row, columns, axis) for axis in (0, 1)]
    if not row.equal:
        return limits
    side = max(high - low for low, high in limits)
    return [((low + high - side) / 2, (low + high + side) / 2) for low, high in limits]


def _limits(row: Row, columns: Sequence[Column], axis: int):
    """Limits of one axis for a whole row: the exact motion's, stretched for models that stay near it."""
    if row.limits is not None:
        return row.limits[axis]
    wide = WIDE * (2 if row.equal else 1)
    values = {}
    for column in columns:
        for name, run in column.runs.items():
            picked = row.pick(run)
            if picked is not None and len(picked[axis]):
                values.setdefault(name, []).append(np.asarray(picked[axis], float))
    exact = np.concatenate(values["exact"])
    low, high = float(np.nanmin(exact)), float(np.nanmax(exact))
    middle, half = (low + high) / 2, max((high - low) / 2, 1e-6 * max(abs(low), abs(high), 1e-300))
    edge = wide * half
    for part in (np.concatenate(parts) for parts in values.values()):
        part = part[np.isfinite(part)]
        low = min(low, part.min() if part.min() >= middle - edge else middle - 1.3 * half, key=float)
        high = max(high, part.max() if part.max() <= middle + edge else middle + 1.3 * half, key=float)
    pad = MARGIN * (high - low)
    return (low - pad, high + pad) if not (axis == 0 and row.over_time) else (low, high)


def history(part, component, label, unit):
    """A Row of one component of a part of the state over time; component None: of a part that is one number.
    """
    def pick(run: Simulation):
        if part not in run.state:
            return None
        values = np.asarray(run.state[part])
        return run.t, values if component is None else values[:, component]
    return Row(TIME, f"{label} ({unit})" if unit else label, pick)


def phase(part, component, label, unit):
    """A Row of one component against its own rate (differences over the times of the run)."""
    def pick(run: Simulation):
        if part not in run.state or len(run.t) < 3:
            return None
        y = np.asarray(run.state[part])[:, component]
        return y, np.gradient(y, run.t, edge_order=2)
    letter = label.strip("$")
    name = letter.rstrip("'").split("_")[0]
    dot = rf"$\dot{{{name}}}{letter[len(name):]}$"  # over the letter, not over its index and primes
    return Row(f"{label} ({unit})" if unit else label,
               f"{dot} ({unit + '/s' if unit else '1/s'})".replace("rad/s/s", r"rad/s$^2$"), pick)


def histories(part, labels, unit, row=history) -> tuple[Row, ...]:
    """A Row, of `history` or `phase`, for each of the first components of a part of the state."""
    return tuple(row(part, n, label, unit) for n, label in enumerate(labels))


# of p and q, in two papers: kind of figure -> (title, its rows)
RATES = {"rates": ("Angular velocities", histories("omega", ("$p$", "$q$"), "rad/s")),
         "planes": ("Phase planes", histories("omega", ("$p$", "$q$"), "rad/s", phase))}


def plane(part, first, second, labels, unit, equal=True):
    """A Row of one component of a part of the state against another."""
    def pick(run: Simulation):
        if part not in run.state:
            return None
        values = np.asarray(run.state[part])
        return values[:, first], values[:, second]
    return Row(f"{labels[0]} ({unit})", f"{labels[1]} ({unit})", pick, equal)
