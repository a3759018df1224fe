"""A case in 240 pixels, for the card of a list: how large its rates grow and its limit, without a title; of a
satellite on a circular orbit its body."""
from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import style
from ..units import SHORT, number
from .body import body
from .over_time import LIMIT, file_axes
from .path import SOLID, band, path, turning
from .subject import Measures, Subject, measures
from .switches import whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SIZE, DPI = (2.4, 1.35), 200  # inches, a hundred pixels of a card each; dots an inch: sharp on fine screens
LETTERS = 6.8  # points: 9.4 pixels of a card
COLOURS = 32  # of the file
MANY = 0.8  # width of a line of several
PAPER = {"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 0.3}  # behind words
HEAD = 1.3  # of the largest value: room for what is written above it


def write(items: Sequence[tuple[Subject, str]], out: Path, units: str | None = None) -> Path:
    """Draw the motions, each with the look of its answer (a key of `style.LOOK`, else grey), and write the
    picture. units: as of `measures`. Raises InputError where a motion cannot be followed."""
    with style.drawing() as plt:
        return style.save(_picture(plt, items, units), out, DPI, COLOURS)


def _picture(plt: Any, items: Sequence[tuple[Subject, str]], units: str | None) -> Any:
    first, scale = items[0][0], measures(items[0][0], units)
    if first.orbiting is not None:
        return body(first, size=SIZE, legend=False, bare=True).figure
    ends = [(0.0, 0.0) if item.burning is not None else item.seen for item, _ in items]
    begin, end = (pick(values) for pick, values in zip((min, max), zip(*ends)))
    sizes = [_sizes(item, begin, end) for item, _ in items]
    end = max(end, *(float(t[-1]) for t, _ in sizes))
    limit = _limit(first, scale)
    figure = plt.figure(figsize=SIZE)
    ax = figure.add_axes((0.03, 0.17, 0.94, 0.8))
    largest = max(float(values.max()) for _, values in sizes)
    top = HEAD * max(largest, limit[0] if limit else 0.0) or 1.0
    for (_, look), (t, values) in zip(items, sizes):
        _curve(ax, t, values, style.LOOK.get(look, style.GREY), 1.6 if len(items) == 1 else MANY, top)
    ax.set(xlim=(begin, end), ylim=(0.0, top), xticks=[], yticks=[])
    ax.spines[["top", "right"]].set_visible(False)
    if limit:
        ax.axhline(limit[0], **LIMIT | {"linewidth": 1.2})
        _written(ax, begin, limit[0], limit[1], str(LIMIT["color"]))
    else:
        name, per = ("", 1.0) if file_axes(first) is not None else scale.rate
        _written(ax, begin, largest, f"{number(largest * per, SHORT)} {name}".rstrip(), style.BLACK)
    unit, per = scale.time(end - begin)
    ax.annotate(f"{number(end * per, SHORT)} {unit}", (1.0, 0.0), (0, -3), xycoords="axes fraction",
                textcoords="offset points", ha="right", va="top", fontsize=LETTERS)
    return figure


def _sizes(item: Subject, begin: float, end: float) -> tuple[np.ndarray, np.ndarray]:
    """Times, and |omega| or, of limits about axes, the component nearest to its limit, as a part of it. Of a
    burn across its switches."""
    t, omega = whole(item) if item.burning is not None else path(item, begin, end)
    limits = _of_components(item)
    if limits is None:
        return t, np.linalg.norm(omega, axis=1)
    turned = file_axes(item)
    return t, np.abs((omega if turned is None else omega @ turned.T) / limits).max(axis=1)


def _of_components(item: Subject) -> np.ndarray | None:
    """The limits of the three components, where the case has such."""
    declared = None if item.case is None else item.case.limits
    if declared is None or declared.rate is not None:
        return None
    return np.array([float(limit) for limit in declared.rates])


def _limit(item: Subject, scale: Measures) -> tuple[float, str] | None:
    """(height, words) of the limit, None where there is none."""
    components = _of_components(item)
    if components is not None:
        same = len(set(components)) == 1
        return 1.0, f"limit of each, {_rate(components[0], scale)}" if same else "limits"
    if item.case is None or item.case.limits is None:
        return None
    rate = float(item.case.limits.rate)
    return rate, f"limit {_rate(rate, scale)}"


def _rate(value: float, scale: Measures) -> str:
    name, per = scale.rate
    return f"{number(value * per, SHORT)} {name}".rstrip()


def _curve(ax: Axes, t: np.ndarray, values: np.ndarray, colour: str, width: float, top: float) -> None:
    """A curve; one of more turns than the picture has columns as a band."""
    if turning(values) > SOLID // 4:
        times, low, high = band(t, values)
        ax.fill_between(times, low, high, color=colour, alpha=0.6, linewidth=0.6)
    else:
        ax.plot(t, values, color=colour, linewidth=width)


def _written(ax: Axes, x: float, y: float, text: str, colour: str) -> None:
    ax.annotate(text, (x, y), (3, 2), textcoords="offset points", va="bottom", fontsize=LETTERS, color=colour,
                bbox=PAPER)
