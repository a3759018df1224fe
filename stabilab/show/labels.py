"""Words in axes in space, moved so that none stands on another."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from matplotlib.transforms import Bbox
    from mpl_toolkits.mplot3d import Axes3D

Words: TypeAlias = Any  # a Text3D, which the types of Matplotlib's axes do not know
# (whether on the other side of their place, by how many of their heights farther up), the first that fits
PLACES = tuple((other, up) for ups in ((0.0, 1.0, -1.0), (2.0, -2.0, 3.0, -3.0)) for other in (False, True)
               for up in ups)
OUTSIDE = 4.0  # an area out of the figure counts as so much on other words
OTHER_SIDE = {"left": "right", "right": "left", "center": "center"}


def apart(*panels: Axes3D) -> None:
    """Move each of the words in axes in space that would stand on earlier ones, or out of the figure, up or
    down, or to the other side of their place, as little as need be. The figure is laid out for this, so its
    other parts have to be in it; when the axes are turned afterwards, words stay as far from their places."""
    figure = panels[0].figure
    figure.draw_without_rendering()
    placed: list[Bbox] = []
    for ax in panels:
        for text in ax.texts:
            if not text.get_text().strip():
                continue
            own = text.get_horizontalalignment()
            options = [(side, up, _box(ax, text, side, up))
                       for side, up in ((OTHER_SIDE[own] if other else own, up) for other, up in PLACES)]
            side, up, box = min(options, key=lambda one: _covered(one[2], placed, figure.bbox))
            _put(ax, text, side, up)
            placed.append(box)


def boxes(ax: Axes3D) -> list[Bbox]:
    """Where the words of axes in space stand, in dots of the figure."""
    ax.figure.draw_without_rendering()
    return [_box(ax, text, text.get_horizontalalignment(), 0.0)
            for text in ax.texts if text.get_text().strip()]


def _box(ax: Axes3D, text: Words, side: str, up: float) -> Bbox:
    """Where words would stand on that side of their place, so many of their heights farther up."""
    from matplotlib.text import Text as Flat
    from matplotlib.transforms import Bbox
    from mpl_toolkits.mplot3d import proj3d
    words = Flat(0, 0, _padded(text.get_text(), side), fontproperties=text.get_fontproperties())
    words.set_figure(ax.figure)
    size = words.get_window_extent()
    x, y, _ = proj3d.proj_transform(*text.get_position_3d(), ax.get_proj())
    x, y = text.get_transform().transform((x, y))
    left = x - size.width * {"left": 0.0, "center": 0.5, "right": 1.0}[side]
    below = {"bottom": 0.0, "center": 0.5, "top": 1.0}.get(text.get_verticalalignment(), 0.0)
    low = y + size.height * (up - below)
    return Bbox.from_bounds(left, low, size.width, size.height)


def _covered(box: Bbox, placed: list[Bbox], page: Bbox) -> float:
    """How much of a box, in dots squared, is on others or out of the page."""
    from matplotlib.transforms import Bbox
    area = box.width * box.height
    return (sum(_area(Bbox.intersection(box, other)) for other in placed)
            + OUTSIDE * (area - _area(Bbox.intersection(box, page))))


def _area(box: Bbox | None) -> float:
    return 0.0 if box is None else box.width * box.height


def _padded(words: str, side: str) -> str:
    """Words with the blanks that part them from their place on the side of it."""
    bare = words.strip()
    blanks = " " * max(len(words) - len(words.lstrip()), len(words) - len(words.rstrip()))
    return {"left": blanks + bare, "right": bare + blanks, "center": bare}[side]


def _put(ax: Axes3D, text: Words, side: str, up: float) -> None:
    from matplotlib.transforms import ScaledTranslation
    text.set_text(_padded(text.get_text(), side))
    text.set_horizontalalignment(side)
    if up:
        height = _box(ax, text, side, 0.0).height / ax.figure.dpi
        text.set_transform(text.get_transform() + ScaledTranslation(0.0, up * height,
                                                                    ax.figure.dpi_scale_trans))
