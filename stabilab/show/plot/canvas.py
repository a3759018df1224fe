"""Where a plot goes: onto axes that the caller gives, or into a figure of its own in the style of the house."""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from ...errors import InputError
from ...packages import demand
from .. import style

SIZE = (7.6, 4.8)  # inches
SQUARE = (7.0, 6.4)


@contextmanager
def on(ax: Any, size: tuple[float, float] | None = None, space: bool = False) -> Iterator[Any]:
    """The axes to draw on: `ax` itself, checked, or those of a new figure of so many inches. space: three-dimensional ones."""
    demand(*style.PACKAGES)
    if ax is not None:
        yield _checked(ax, space)
        return
    import matplotlib
    import matplotlib.pyplot as plt
    with matplotlib.rc_context(style.RC | style.letters(size)):
        figure = plt.figure(figsize=size or (SQUARE if space else SIZE), layout="constrained")
        yield figure.add_subplot(projection="3d" if space else None)


def _checked(ax: Any, space: bool) -> Any:
    if not hasattr(ax, "plot") or not hasattr(ax, "figure"):
        raise InputError(f"ax: expected Matplotlib axes, got {ax!r:.80}")
    if space != (getattr(ax, "name", "") == "3d"):
        wanted = 'three-dimensional axes: plt.subplots(subplot_kw={"projection": "3d"})' if space else "plane axes: plt.subplots()"
        raise InputError(f"ax: expected {wanted}")
    return ax


def legend(ax: Any, rows: list[tuple[str, dict[str, Any]]], own: bool) -> None:
    """What the looks mean, rows of (name, look): below a figure of its own, inside axes that were given."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch
    if not rows:
        return
    handles = [Patch(**look) if "facecolor" in look else Line2D([], [], **look) for _, look in rows]
    names = [name for name, _ in rows]
    if not own:
        ax.legend(handles, names, loc="best", fontsize="small")
        return
    ax.figure.legend(handles, names, loc="outside lower center", ncols=style.fitting(names, ax.figure.get_figwidth()))


def title(ax: Any, *lines: str) -> None:
    """The lines that are not empty, above the axes; the first is the title of the case."""
    width = ax.get_position().width if len(ax.figure.axes) > 1 else 1.0  # beside others it has its own share alone
    told = (style.clauses(line, ax.figure.get_figwidth() * width) for line in lines if line)
    ax.set_title("\n".join(map(style.literal, told)), wrap=True)
