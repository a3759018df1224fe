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
from ..units import units_of
from .subject import Measures, Subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from mpl_toolkits.mplot3d import Axes3D

SIZE = (7.6, 4.8)  # inches
SQUARE = (7.0, 6.4)
TITLE_LINES = 2  # of a picture of its own; more stand below it
SMALL_NOTE = "what limits this: stabilab fate"
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
    notes = title(ax, heading, *lines, most=TITLE_LINES if own else None)
    legend(ax, rows, own, notes)
    return ax


def legend(ax: Axes | Axes3D, rows: list[tuple[str, dict[str, Any]]], own: bool, notes: str = "") -> None:
    """What the looks mean, rows of (name, look): below a figure of its own, with what its title has no room
    for; inside axes that were given."""
    if own and (rows or notes):
        style.legend(ax.figure, rows, notes=notes)
    elif rows:
        ax.legend(*style.explained(rows), loc="best", fontsize="small")


def answer(item: Subject, scale: Measures) -> str:
    """What becomes of the motion of a case: the first of the two lines of its headline; empty without a case.
    """
    if item.case is None or item.state is None:
        return ""
    return headline.two_lines(item.case, item.motion, scale.system)[0]


def unsaid(item: Subject, scale: Measures) -> str:
    """What limits that answer and does not stand in it: how far numbers of the case, forces and axes may be
    others."""
    if item.case is None or item.state is None:
        return ""
    units = replace(scale.system or units_of(item.case), axes=axes_of(item.case))
    return "; ".join(limiting.words(of, units).split("; ")[0] for of in item.motion.caveats
                     if of.kind in (Kind.TOLERANCE, Kind.MISALIGNMENT, Kind.UNCERTAIN))


def title(ax: Any, heading: str, *lines: str, most: int | None = None) -> str:
    """The heading of the case, as its user wrote it, and below it what the program says, names as letters
    (omega becomes ω); nothing for what is empty. most: lines at most; None: as many as these take. Returns
    what there is no room for, in lines that fit the figure: a heading is cut, and gives its line to what the
    program says."""
    # beside others it has its own share alone
    width = ax.get_position().width if len(ax.figure.axes) > 1 else 1.0
    inches = ax.figure.get_figwidth() * width
    own = style.clauses(heading, inches).split("\n") if heading else []
    said = [style.clauses(line, inches).split("\n") for line in map(written, lines) if line]
    below: list[str] = []
    if most is not None:
        first, rest = (said[0], said[1:]) if said else ([], [])
        if len(own) > max(1, most - len(first)):
            own = [f"{own[0].rstrip(',;:')} ..."]
        shown = [*(own if len(first) < most else ()), *first][:most]
        below = [*first[most:], *(line for part in rest for line in part)]
    else:
        shown = [*own, *(line for part in said for line in part)]
    ax.set_title("\n".join(map(style.literal, shown)), wrap=True)
    if below and style.share() < 1:  # of a small figure these lines would leave nothing
        return SMALL_NOTE
    return "\n".join(map(style.literal, below))
