"""Pictures for a telephone: the same figure again, narrower, with panels below each other and large letters.

A page shows the narrow file where it is narrow itself. Titles that the page says are left to it."""
from __future__ import annotations

import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import labels, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH, PIXELS = 4.6, 368  # inches of a figure, and the pixels that it has on a telephone 400 wide
SMALLEST = 9 * WIDTH * 72 / PIXELS  # points of a letter of 9 pixels
COLOURS, DPI = 32, 96  # of a file, which stays small: 441 pixels wide
ALONE, PANEL, SPACE = 3.6, 2.1, 4.0  # inches of height: of the only panel, of one of several, of one in space
BETWEEN = 0.2  # inches by which a title may reach into the room between two panels
PAIRED = 2.7  # of one in space of several, two of which stand beside each other
EQUAL = 3.4  # of a panel with one scale for both axes
HEADING, NOTE = 10, 8.5  # points of a title, and of notes in a legend
GLYPH, LEFT = 0.75, 0.9  # of the size of letters: a digit with its part of the room; inches left of a panel
HALF = 0.55  # of a panel's width: words at a point beyond stand on its left
ENTRY = 46  # letters of a line of a legend


def beside(path: Path) -> Path:
    """The narrow file of a picture."""
    return path.with_name(f"{path.stem}-narrow{path.suffix}")


def save_both(figure: Figure, path: Path) -> tuple[Path, Path]:
    """Write a picture, and beside it the narrow one; the paths of both."""
    wide = style.save(figure, path, colours=style.PAGE)
    return wide, save(figure, beside(path))


def save(figure: Figure, path: Path) -> Path:
    """Write the narrow picture of a figure, which is changed."""
    return style.save(narrowed(figure), path, DPI, COLOURS)


def narrowed(figure: Figure) -> Figure:
    """The figure, changed: as wide as a telephone shows it with letters of 9 pixels, a panel below the other.
    The title of a whole figure is dropped."""
    from matplotlib.text import Text
    if figure.get_suptitle():
        figure.suptitle("")
    cells = _cells(figure)
    _name_all(cells)
    across = 2 if len(cells) > 2 and all(getattr(ax, "name", "") == "3d" for ax, _, _ in cells) else 1
    heights = [_height(ax, len(cells)) if across == 1 else PAIRED for ax, _, _ in cells[::across]]
    if len(cells) > 1:
        grid = figure.add_gridspec(len(heights), across, height_ratios=heights)
        engine: Any = figure.get_layout_engine()
        engine.set(w_pad=0.09)  # inches: numbers at the ends of axes
        for n, (first, _, _) in enumerate(cells):
            spec = first.get_subplotspec()
            for ax in [ax for ax in figure.axes if ax.get_subplotspec() == spec]:
                ax.set_subplotspec(grid[divmod(n, across)])
    figure.set_size_inches(WIDTH, sum(heights))
    for text in figure.findobj(Text):
        text.set_fontsize(max(text.get_fontsize(), SMALLEST))
    for n, (ax, _, _) in enumerate(cells):
        _readable(ax, heights[n // across], WIDTH if across == 1 else WIDTH / across + BETWEEN)
    for legend in list(figure.legends):
        _below(figure, legend)
    below = sum(legend.get_window_extent().height for legend in figure.legends) / figure.dpi
    figure.set_size_inches(WIDTH, sum(heights) + below)
    _thinned(figure, [ax for ax, _, _ in cells])
    if spatial := [ax for ax, _, _ in cells if getattr(ax, "name", "") == "3d" and len(ax.texts) > 1]:
        labels.apart(*spatial)
    return figure


def _cells(figure: Figure) -> list[tuple[Any, int, int]]:
    """(axes, row, column) of the panels, row by row; of axes in one place the first."""
    cells: dict = {}
    for ax in figure.axes:
        spec = ax.get_subplotspec()
        if spec is not None and ax.get_visible():
            cells.setdefault((spec.rowspan.start, spec.colspan.start), ax)
    return [(ax, *at) for at, ax in sorted(cells.items(), key=lambda item: item[0])]


def _name_all(cells: list[tuple[Any, int, int]]) -> None:
    """Give each panel the heading, label and numbers that it shared with those beside, above or below."""
    if len(cells) == 1:
        return
    for ax, row, column in cells:
        if not ax.get_title():
            above = [other for other, r, c in cells if c == column and r < row and other.get_title()]
            if above:  # as far from the panel, which may have more lines of words there
                offset = above[-1].titleOffsetTrans.to_values()[-1] * 72 / ax.figure.dpi
                ax.set_title(above[-1].get_title(), pad=offset)
        if not ax.get_ylabel():
            before = (other.get_ylabel() for other, r, c in cells if r == row and c < column)
            ax.set_ylabel(next(filter(None, before), ""))
    labels = [ax.get_xlabel() or next((other.get_xlabel() for other, r, c in cells
                                       if c == column and r > row and other.get_xlabel()), "")
              for ax, row, column in cells]
    for n, (ax, _, _) in enumerate(cells):
        ax.set_xlabel(labels[n] if len(set(labels)) > 1 or n == len(cells) - 1 else "")
        if getattr(ax, "name", "") != "3d":
            ax.tick_params(labelleft=True, labelbottom=True)


def _height(ax: Any, count: int) -> float:
    """Inches of a panel among so many."""
    if getattr(ax, "name", "") == "3d":
        return SPACE
    if ax.get_aspect() != "auto":
        (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
        shape = abs((high - low) / (right - left)) * float(ax.get_aspect())
        return min(1.6 * WIDTH, max(PANEL, EQUAL * shape + 0.8))
    return ALONE if count == 1 else PANEL


def _readable(ax: Axes, height: float, width: float) -> None:
    """Labels within the panel, inches, and numbers at its edges as large as the other letters."""
    for axis in filter(None, (ax.xaxis, ax.yaxis, getattr(ax, "zaxis", None))):
        ticks = axis.get_major_ticks()
        if ticks and ticks[0].label1.get_fontsize() < SMALLEST:
            axis.set_tick_params(labelsize=SMALLEST)
    if getattr(ax, "name", "") != "3d":
        _fewer_ticks(ax, width)
    dpi, label = ax.figure.dpi, ax.yaxis.label
    if getattr(ax, "name", "") != "3d" and label.get_window_extent().height > 0.9 * height * dpi:
        label.set_text(label.get_text().replace(" (", "\n("))
        label.set_fontsize(SMALLEST)
    texts: list[Any] = list(ax.texts)
    for text in texts:
        if getattr(text, "anncoords", "") == "offset points" and text.xycoords == "data" and text.get_text():
            across, _ = ax.transAxes.inverted().transform(ax.transData.transform(text.xy))
            right, up = text.xyann
            if across > HALF and right > 0 and text.get_ha() == "left":  # it would widen the picture
                text.set(ha="right")
                text.xyann = -right, up
    size = min(float(ax.title.get_fontsize()), HEADING)
    ax.title.set_fontsize(size)
    ax.title.set_text("\n".join(style.clauses(line, width, HEADING if width == WIDTH else size)
                                for line in ax.get_title().split("\n")))


def _fewer_ticks(ax: Any, width: float) -> None:
    """Numbers below a panel of so many inches that would meet become fewer, where its scale is linear."""
    from matplotlib.ticker import AutoLocator, MaxNLocator
    low, high = sorted(ax.get_xlim())
    ticks = [tick for tick in ax.get_xticks() if low <= tick <= high]
    if ax.get_xscale() != "linear" or not isinstance(ax.xaxis.get_major_locator(), AutoLocator) or not ticks:
        return
    printed = ax.xaxis.get_major_formatter().format_ticks(ticks)
    wide = GLYPH * max(map(len, printed)) * SMALLEST  # points
    room = 72 * (width - LEFT)
    if len(ticks) * wide > room:
        ax.xaxis.set_major_locator(MaxNLocator(max(2, int(room / wide) - 1)))


def _thinned(figure: Figure, panels: list[Any]) -> None:
    """Words at points of a panel that would lie on earlier ones are left out: they stand in the wide picture.
    The figure is laid out for this, and once more only where words that made it narrower are gone."""
    crowded = [ax for ax in panels if len(ax.texts) > 1 and getattr(ax, "name", "") != "3d"]
    if not crowded:
        return
    before, figure.dpi = figure.dpi, DPI
    if (engine := figure.get_layout_engine()) is not None:
        engine.execute(figure)
    outside = False
    for ax in crowded:
        taken: list[Any] = []
        panel = ax.get_window_extent()
        for text in ax.texts:
            box = text.get_window_extent()
            text.set_visible(not any(box.overlaps(other) for other in taken))
            taken += [box] if text.get_visible() else []
            outside |= not text.get_visible() and not (panel.contains(*box.min) and panel.contains(*box.max))
    if engine is not None and not outside:
        figure.set_layout_engine("none")
    figure.dpi = before


def _below(figure: Figure, legend: Any) -> None:
    """A legend again, of as many columns as fit, long entries and its notes in lines."""
    names = [text.get_text() if "$" in text.get_text() else textwrap.fill(text.get_text(), ENTRY)
             for text in legend.get_texts()]
    heading, handles = legend.get_title(), legend.legend_handles
    notes = "" if heading.get_text() == "None" else " ".join(heading.get_text().split())
    legend.remove()
    style.below(figure, handles, names, notes=notes and style.clauses(notes, WIDTH, NOTE))
    for built in figure.legends[-1:]:
        built.get_title().set(color=heading.get_color(), parse_math=heading.get_parse_math(), fontsize=NOTE)
