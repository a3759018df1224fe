"""Where a plot goes: onto axes that the caller gives, or into a figure of its own in the style of the house;
its title and its legend."""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ...errors import InputError, Kind
from ...packages import demand
from .. import limiting, style
from ..axes import axes_of
from ..terminal import written
from ..text import headline
from ..text.headline import outcome
from ..units import units_of
from .subject import Measures, Subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from mpl_toolkits.mplot3d import Axes3D

SIZE = (7.6, 4.8)  # inches
SQUARE = (7.0, 6.4)
BELOW = 0.14  # inches between axes in space and their legend, in a figure with room for it


@contextmanager
def on(ax: Axes3D | Axes | None, size: tuple[float, float] | None = None,
       space: bool = False) -> Iterator[Any]:
    """The axes to draw on: `ax` itself, checked, or those of a new figure of so many inches. space:
    three-dimensional ones."""
    demand(*style.PACKAGES)
    if ax is not None:
        yield _checked(ax, space)
        return
    import matplotlib
    import matplotlib.pyplot as plt
    with matplotlib.rc_context(style.RC | style.letters(size)):
        figure = plt.figure(figsize=size or (SQUARE if space else SIZE), layout="constrained")
        if space and style.share() == 1:  # no layout knows how far labels in space reach
            figure.get_layout_engine().set(h_pad=BELOW)
        yield figure.add_subplot(projection="3d" if space else None)


def _checked(ax: Any, space: bool) -> Any:
    if not hasattr(ax, "plot") or not hasattr(ax, "figure"):
        raise InputError(f"ax: expected Matplotlib axes, got {ax!r:.80}")
    if space != (getattr(ax, "name", "") == "3d"):
        wanted = ('three-dimensional axes: plt.subplots(subplot_kw={"projection": "3d"})' if space
                  else "plane axes: plt.subplots()")
        raise InputError(f"ax: expected {wanted}")
    return ax


def explained(ax: Axes | Axes3D, rows: list[tuple[str, dict[str, Any]]], own: bool, heading: str,
              *lines: str) -> Any:
    """The axes, with a title as of `title` and with what the looks mean, rows of (name, look)."""
    title(ax, heading, *lines)
    legend(ax, rows, own)
    return ax


def legend(ax: Axes | Axes3D, rows: list[tuple[str, dict[str, Any]]], own: bool) -> None:
    """What the looks mean, rows of (name, look): below a figure of its own, inside axes that were given."""
    if rows and own:
        style.legend(ax.figure, rows)
    elif rows:
        ax.legend(*style.explained(rows), loc="best", fontsize="small")


def answer(item: Subject, scale: Measures) -> str:
    """What becomes of the motion of a case, and when it reaches its limit, as its headline begins; empty
    without a case."""
    if item.case is None or item.state is None:
        return ""
    units = replace(scale.system or units_of(item.case), axes=axes_of(item.case))
    became, limit, _ = outcome(item.motion, units)
    left_out = [limiting.words(of, units).split("; ")[0] for of in item.motion.caveats
                if of.kind in (Kind.TOLERANCE, Kind.MISALIGNMENT, Kind.UNCERTAIN)]
    text = "; ".join(filter(None, (became, limit, *left_out)))
    return headline.warned(item.motion.validity, limiting.ahead(item.motion.caveats, text, named=False))


def title(ax: Any, heading: str, *lines: str) -> None:
    """The heading of the case, as its user wrote it, and below it what the program says, names as letters
    (omega becomes ω); nothing for what is empty."""
    # beside others it has its own share alone
    width = ax.get_position().width if len(ax.figure.axes) > 1 else 1.0
    printed = (style.clauses(line, ax.figure.get_figwidth() * width)
            for line in (heading, *map(written, lines)) if line)
    ax.set_title("\n".join(map(style.literal, printed)), wrap=True)
