"""Where a plot goes: onto axes that the caller gives, or into a figure of its own in the style of the house;
its title and its legend."""
from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ...errors import InputError, Kind, without
from ...packages import demand
from .. import limiting, style
from ..axes import axes_of
from ..limiting import Note
from ..terminal import written
from ..text import headline
from ..text.notes import fitted
from ..units import units_of
from .subject import Measures, Subject

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from mpl_toolkits.mplot3d import Axes3D

SIZE = (7.6, 4.8)  # inches
SQUARE = (7.0, 6.4)
AFTER_BURN = "the free motion after the last closing"
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
              *lines: str, notes: Sequence[Note] = ()) -> Any:
    """The axes, with a title as of `title`, with what the looks mean, rows of (name, look), and with notes.
    own: whether the figure is of this picture alone: its title has two lines then, and what it has no room
    for stands below; axes that were given have all in their title."""
    if own:
        rest = title(ax, heading, *lines, most=style.TITLE_LINES)
        legend(ax, rows, own, [*notes, *(Note(line, line) for line in rest)])
    else:
        title(ax, heading, *lines[:1], "; ".join(note.full for note in notes), *lines[1:])
        legend(ax, rows, own)
    return ax


def legend(ax: Axes | Axes3D, rows: list[tuple[str, dict[str, Any]]], own: bool,
           notes: Sequence[Note] = ()) -> None:
    """What the looks mean, rows of (name, look): below a figure of its own, with notes above them; inside
    axes that were given."""
    if own and (rows or notes):
        style.legend(ax.figure, rows, notes=fitted(notes, ax.figure.bbox.width / ax.figure.dpi))
    elif rows:
        ax.legend(*style.explained(rows), loc="best", fontsize="small")


def answer(item: Subject, scale: Measures) -> str:
    """What becomes of the motion of a case: the first of the two lines of its headline; empty without a case.
    """
    if item.case is None or item.state is None:
        return ""
    return headline.two_lines(item.case, item.motion, scale.system)[0]


def notes(item: Subject, scale: Measures, answered: bool = True, shown: Sequence[Kind] = ()) -> list[Note]:
    """What limits that answer and does not stand in it; of no case nothing. answered: False of a picture that
    shows no answer, but the motion or the body alone: what limits these. shown: kinds of what the picture
    itself looks at."""
    if item.case is None:
        return []
    units = replace(scale.system or units_of(item.case), axes=axes_of(item.case))
    caveats = without(item.case.caveats if item.state is None else item.motion.caveats, *shown)
    first = []
    if item.burning is not None:  # of the motion that follows it, whose start is as sure as the burn
        first = [Note(AFTER_BURN, AFTER_BURN)]
        own = without(caveats, Kind.TOLERANCE, Kind.MISALIGNMENT, Kind.THRUSTERS,
                      *(caveat.kind for caveat in item.caveats))
        caveats = (*item.caveats, *own)
    if answered:
        return first + limiting.notes(caveats, answer(item, scale), units)
    return first + limiting.notes(without(caveats, Kind.LIMIT, Kind.TILT, Kind.UNSTABLE, Kind.THRUSTERS), "",
                                  units)


def notes_of_case(item: Subject, scale: Measures) -> list[Note]:
    """What limits every answer about the case, for a picture of its body."""
    if item.case is None:
        return []
    return limiting.notes(item.caveats, "", replace(scale.system or units_of(item.case),
                                                    axes=axes_of(item.case)))


def title(ax: Any, heading: str, *lines: str, most: int | None = None) -> list[str]:
    """The heading of the case, as its user wrote it, and below it what the program says, names as letters
    (omega becomes ω); nothing for what is empty. most: lines at most; None: as many as these take. Returns
    the lines that there is no room for: the first of the program has one line, in smaller letters where it is
    long (in a small figure the whole title, where it needs that), and the heading is cut."""
    # beside others it has its own share alone, but the only one of a figure
    width = ax.get_position().width if most is None and len(ax.figure.axes) > 1 else 1.0
    inches = ax.figure.get_figwidth() * width
    said = [written(line) for line in lines if line]
    if most is None:
        shown = [style.clauses(line, inches) for line in filter(None, (heading, *said))]
        ax.set_title("\n".join(map(style.literal, shown)), wrap=True)
        return []
    text, size, rest, own = style.titled(heading, said, inches, most)
    drawn = ax.set_title(text, fontsize=size)
    drawn.set_label(own)  # which a narrow picture has alone
    if width == 1.0:  # over the figure, as axes with words on their left are not in its middle
        from matplotlib.transforms import blended_transform_factory
        drawn.set_transform(blended_transform_factory(ax.figure.transFigure, drawn.get_transform()))
    return rest
