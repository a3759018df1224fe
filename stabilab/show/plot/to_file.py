"""A plot of a case as a file: which kind, how large, in the format of its ending."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any

from ...errors import InputError
from ...packages import demand
from .. import endings, style
from .. import narrow as narrow_pictures
from ..picture_kinds import KINDS
from . import subject as subjects
from .subject import Subject, subject
from .turning import ENDINGS

LEAST, MOST, SHARP = 1.0, 60.0, 1200  # inches of a side, dots an inch
PIXELS = 20_000  # of a side: what Matplotlib draws


def _drawing(kind: str) -> Callable[..., Any]:
    """What draws a kind of picture: its file is loaded where it is drawn."""
    module, _, name = KINDS[kind].draws.partition(".")
    drawn: Callable[..., Any] = getattr(import_module(f".{module}", __package__), name)
    return drawn


def write(case: Any, path: str | Path, kind: str | None = None, size: tuple[float, float] | None = None,
          dpi: float | None = None, units: str | None = None,
          span: Any = None, neighbours: int | None = None, narrow: str | Path | None = None,
          axis: str | None = None) -> Path:
    """As `write_all`; returns the path of the first picture."""
    return write_all(case, path, kind, size, dpi, units, span, neighbours, narrow, axis=axis)[0]


def write_all(case: Any, path: str | Path, kind: str | None = None, size: tuple[float, float] | None = None,
              dpi: float | None = None, units: str | None = None, span: Any = None,
              neighbours: int | None = None, narrow: str | Path | None = None,
              titled: bool = True, axis: str | None = None) -> list[Path]:
    """Draw a case (or a Subject) and write the picture to `path` (.png, .svg, .pdf; of an attitude .html,
    .gif, .mp4), whole or not at all; returns the path, and those of more pictures beside it
    (NAME-2.png, ...) where a state has more parts than one takes.

    kind: one of `KINDS`; None: the one that says most of the case. size: (width, height) in inches;
    dpi: dots an inch of a .png. units: "deg" or "si", None for those of the case. span: in place of the
    case's own. neighbours: of a section, how many motions are shown beside it, None for six. narrow: a file
    for the first picture as a telephone shows it (`show.narrow`).
    axis: of a nutation, "x", "y", "z" or "1", "2", "3".
    titled: False leaves the title of a plot to the page. The same input gives the
    same bytes (but for "budget", whose times are measured). Raises InputError for another ending, and where
    the case has no such plot: it names those that there are.
    """
    item = subject(case, span=span)
    if neighbours is not None:
        item = replace(item, neighbours=neighbours)
    chosen = checked(path, item, kind)
    if neighbours and chosen != "section":
        raise InputError(f"neighbours: a section alone shows them (kind section), got kind {chosen}")
    if axis is not None:
        item = replace(item, axis=axis)
        if chosen != "nutation":
            raise InputError(f"axis: a nutation alone is that of an axis (kind nutation), got kind {chosen}")
    demand(*style.PACKAGES)
    check_size(size, dpi)
    with style.drawing():
        if chosen == "attitude":
            return [_drawing(chosen)(item, Path(path), units, size, dpi)]
        built = _drawing(chosen)(item, units=units, size=size)
        figures = built if isinstance(built, list) else [built.figure]
        for figure in figures:
            if size is not None:
                figure.set_size_inches(*size)
            if not titled and figure.get_suptitle():
                figure.suptitle("")
            elif not titled:
                figure.axes[0].set_title("")
        colours = 256 if narrow is None else style.PAGE
        files = [style.save(figure, endings.numbered(path, n), dpi, colours)
                 for n, figure in enumerate(figures, 1)]
        if narrow is not None:
            ax = figures[0].axes[0]
            if titled and not figures[0].get_suptitle():  # without the heading of the case: a page has it
                ax.set_title(ax.title.get_label())
            narrow_pictures.save(figures[0], Path(narrow))
        return files


def checked(path: str | Path, item: Subject, kind: str | None) -> str:
    """The kind of a plot, if it can be drawn and written to such a path: before anything is computed."""
    moving = endings.ending(path) in ENDINGS
    chosen = kind or ("attitude" if moving else subjects.default(item))
    subjects.check(chosen, item)
    endings.file(path, ENDINGS if chosen == "attitude" else endings.PICTURES)
    return chosen


def check_size(size: tuple[float, float] | None, dpi: float | None) -> None:
    """Raise InputError for inches or dots of which no picture can be made, with what is possible."""
    if size is not None and not (len(size) == 2 and all(LEAST <= side <= MOST for side in size)):
        got = " x ".join(f"{side:g}" if isinstance(side, (int, float)) else f"{side!r:.40}" for side in size)
        raise InputError(
            f"size: expected a width and a height of {LEAST:g} to {MOST:g} inches, got {got}; dpi makes a "
            f"picture finer")
    if dpi is not None and not 10 <= dpi <= SHARP:
        raise InputError(f"dpi: expected 10 to {SHARP} dots an inch, got {dpi!r:.40}")
    if dpi is not None and max(size or (0,)) * dpi > PIXELS:
        raise InputError(f"size, dpi: expected at most {PIXELS} dots a side, got {max(size) * dpi:.0f}")


def inches(text: str | None) -> tuple[float, float] | None:
    """Width and height of a command line, "8x5"."""
    if text is None:
        return None
    try:
        width, height = (float(side) for side in text.lower().split("x"))
    except ValueError:
        raise InputError(
            f'--size: expected a width and a height in inches, as in "8x5", got "{text[:40]}"') from None
    return width, height


def default_name(stem: str, kind: str | None) -> str:
    """The name of the file where none is given."""
    return f"{stem}{'.html' if kind == 'attitude' else '.png'}"
