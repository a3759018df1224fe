"""An atlas as a picture: the map of fates and that of times, with axes and thrusters; a row of both for each wheel momentum."""
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ....errors import InputError, printable
from ....maps.atlas.cells import places_of
from ....maps.atlas.pointed import AXES
from ....maps.atlas.run import Atlas
from ....maps.columns import LEVELS
from ... import style
from ...axes import axes_of
from ...units import Units
from ..shades import light
from ..words import COUNTS
from . import flat
from .labels import kind_colour, kind_words, kinds, shown_name, wheel_words
from .words import limit_words

PIXELS = 1500  # across one map
ROWS = 5  # wheel momenta of a picture
LOG = 8  # times of more than this ratio are shown by their logarithm
KINDS = ("fate", "when", "equilibria", "level")
NEVER, UNKNOWN = light(style.GREY, 0.25), light(style.YELLOW, 0.6)
COUNTED = (light(style.GREY, 0.35), light(style.SKY, 0.7), light(style.ORANGE, 0.7), light(style.GREEN, 0.6), light(style.PURPLE, 0.7))


def write(atlas: Atlas, path: Path, units: Units, kind: str | None = None, size: tuple[float, float] | None = None, dpi: float | None = None) -> Path:
    """Draw the atlas and write the picture; returns its path. kind: one of KINDS; None: the fate, and beside it the time to the limit, or the number of
    equilibria where there is no limit."""
    return style.write(path, lambda plt: drawn(atlas, units, chosen(atlas, kind), size, plt), dpi)


def chosen(atlas: Atlas, kind: str | None) -> tuple[str, ...]:
    """The maps of a picture. Raises InputError for a kind that there is none of."""
    timed = atlas.asked.stated_limit is not None
    have = [name for name in KINDS if timed or name != "when"]
    if kind is not None and kind not in have:
        raise InputError(f"plot {printable(kind)[:40]}: this atlas has {', '.join(have)}")
    return (kind,) if kind else ("fate", "when" if timed else "equilibria")


def drawn(atlas: Atlas, units: Units, shown: tuple[str, ...], size: tuple[float, float] | None, plt: Any) -> Any:
    """The figure: maps below each other for one wheel, in rows for several."""
    wheels = _wheels(atlas)
    alone = len(wheels) == 1
    down, across = (len(shown), 1) if alone else (len(wheels), len(shown))
    figure, axes = plt.subplots(down, across, squeeze=False, layout="constrained",
                                figsize=size or ((7.8, 4.05 * down + 0.5) if alone else (5.4 * across + 0.4, 2.75 * down + 1.2)))
    times = _times(atlas, units)
    for n, wheel in enumerate(wheels):
        for m, kind in enumerate(shown):
            ax = axes[m, 0] if alone else axes[n, m]
            _map(ax, atlas, wheel, kind, times, plain=not alone)
            if not alone and not m:
                ax.set_title(f"wheel {wheel_words(atlas, wheel)}", fontsize=9.5)
    for m, kind in enumerate(shown):
        below = [axes[m, 0]] if alone else list(axes[:, m])
        _explained(figure, below, atlas, kind, times, units)
    figure.suptitle(f"{style.literal(atlas.asked.case.title or atlas.asked.case.name)}\ntorque of {units.torque(float(atlas.asked.torque))} in every direction",
                    fontsize=10.5, wrap=True)
    return figure


def _wheels(atlas: Atlas) -> list[int]:
    """The wheel momenta that are drawn, spread over all."""
    count = len(atlas.asked.wheels)
    return [int(n) for n in np.unique(np.linspace(0, count - 1, min(ROWS, count)).round())]


def _map(ax: Any, atlas: Atlas, wheel: int, kind: str, times: Any, plain: bool) -> None:
    x, y = np.meshgrid((np.arange(PIXELS) + 0.5) / PIXELS * 2 - 1, (np.arange(PIXELS // 2) + 0.5) / (PIXELS // 2) * 2 - 1)
    directions, inside = flat.off_sheet(x.ravel() * flat.ACROSS, y.ravel() * flat.UP)
    image = np.ones((len(inside), 4))
    image[~inside, 3] = 0
    image[inside, :3] = colours(atlas, kind, times)[atlas.leaves.holding(wheel, places_of(directions[inside]))]
    ends = (-flat.ACROSS, flat.ACROSS, -flat.UP, flat.UP)
    ax.imshow(image.reshape(PIXELS // 2, PIXELS, 4), origin="lower", extent=ends, interpolation="antialiased", interpolation_stage="rgba")
    ax.set_aspect("equal")
    ax.axis("off")
    ax.set_xlim(-flat.ACROSS * 1.04, flat.ACROSS * 1.04)
    ax.set_ylim(-flat.UP * 1.1, flat.UP * 1.1)
    for axis in range(3):
        for piece in flat.pieces(flat.circle(axis)):
            ax.plot(*piece.T, color=style.BLACK, linewidth=0.5, alpha=0.5)
    ax.plot(*flat.rim().T, color=style.BLACK, linewidth=0.9)
    _points(ax, atlas, wheel, plain)


def _points(ax: Any, atlas: Atlas, wheel: int, plain: bool) -> None:
    """Axes and thrusters with their names, on light ground that lets them be read."""
    from matplotlib.patheffects import withStroke
    halo = [withStroke(linewidth=2.4, foreground="white")]
    here = [n for n, point in enumerate(atlas.named) if point.wheel == wheel]
    size, taken = 8 if plain else 9, []
    scale = ax.figure.get_figwidth() * 72 * 0.9 / (ax.get_subplotspec().get_gridspec().ncols * 2.08 * flat.ACROSS)  # points of a unit of the sheet, roughly
    for n, place in zip(here, flat.on_sheet(atlas.named_directions[here])):
        point = atlas.named[n]
        on_axis = point.level == AXES
        ax.plot(*place, marker="o" if on_axis else "*", markersize=4 if on_axis else 10, color="white", markeredgecolor=style.BLACK, markeredgewidth=0.9,
                linestyle="none", clip_on=False, zorder=3)
        pole = on_axis and point.number >= 4  # its name stands left of it: thrusters have theirs on the right
        right = place[0] <= flat.ACROSS * 0.75 and not pole
        label = _label(atlas, point, plain)
        at, wide = place * scale, 0.62 * size * len(label)
        for side, up in ((right, 3 if place[1] > -flat.UP * 0.98 else -9), (right, -11), (not right, 3), (not right, -11)):
            left = at[0] + (5 if side else -5 - wide)
            box = (left, left + wide, at[1] + up, at[1] + up + size)
            if not any(box[0] < b and a < box[1] and box[2] < d and c < box[3] for a, b, c, d in taken):
                break
        taken.append(box)
        ax.annotate(label, place, (5 if side else -5, up), textcoords="offset points", fontsize=size, path_effects=halo, zorder=4,
                    ha="left" if side else "right", fontweight="normal" if on_axis else "bold")


def _label(atlas: Atlas, point: Any, plain: bool) -> str:
    """The name of a direction; of an axis with its place among the moments, where there is room."""
    if point.level != AXES or plain:
        return shown_name(atlas, point)
    axes, number = axes_of(atlas.asked.case), point.number // 2 + 1
    return " ".join(filter(None, [shown_name(atlas, point), axes.letters[number - 1] and axes.words[number - 1]]))


def _times(atlas: Atlas, units: Units) -> Any:
    """(scale of colours, unit of time) of the map of times; None without a limit."""
    if atlas.asked.stated_limit is None:
        return None
    from matplotlib.colors import LogNorm, Normalize
    known = _known(atlas)
    values = atlas.records["when_low"][known]
    low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 1.0)
    name, one = units.times(float(np.median(values)) if len(values) else high)
    scale = LogNorm if low > 0 and high > LOG * low else Normalize
    return scale(low * one, high * one if high > low else low * one + 1e-9), name, one


def _known(atlas: Atlas) -> np.ndarray:
    return np.isfinite(atlas.records["when_low"]) & np.isfinite(atlas.records["when_high"])


def colours(atlas: Atlas, kind: str, times: Any) -> np.ndarray:
    """(n, 3): red, green and blue of every cell, 0 to 1."""
    records = atlas.records
    out = np.empty((len(records), 3))
    if kind == "fate":
        for (fate, axis, island), rows, _ in kinds(atlas):
            out[rows] = kind_colour(fate, axis, island)
    elif kind == "when":
        import matplotlib
        scale, _, one = times
        known = _known(atlas)
        out[:] = np.where(np.isinf(records["when_low"])[:, None], NEVER, UNKNOWN)
        out[known] = matplotlib.colormaps["cividis_r"](scale(records["when_low"][known] * one))[:, :3]
    else:
        values = records[kind]
        for n, value in enumerate(np.unique(values)):
            out[values == value] = COUNTED[(int(value) if value >= 0 else n) % len(COUNTED)]
    return out


def _explained(figure: Any, axes: list[Any], atlas: Atlas, kind: str, times: Any, units: Units) -> None:
    """The legend of a column of maps, or its scale."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.patches import Patch
    from matplotlib.ticker import LogLocator, NullFormatter
    if kind == "when":
        scale, name, _ = times
        bar = figure.colorbar(ScalarMappable(scale, "cividis_r"), ax=axes, location="bottom", shrink=0.7, aspect=40, pad=0.02,
                              label=f"time to {limit_words(atlas, units)} ({name})")
        if scale.vmax > LOG * scale.vmin > 0:
            bar.ax.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        bar.ax.xaxis.set_major_formatter(lambda value, _: f"{value:.4g}")
        bar.ax.xaxis.set_minor_formatter(NullFormatter())
        known, low = _known(atlas), atlas.records["when_low"]
        rows = [(NEVER, "never", np.isinf(low)), (UNKNOWN, "time not known", ~known & ~np.isinf(low))]
        handles = [(Patch(facecolor=colour, edgecolor=style.GREY), words) for colour, words, cells in rows if cells.any()]
    elif kind == "fate":
        handles = [(Patch(facecolor=kind_colour(*key), edgecolor=style.GREY), f"{kind_words(atlas, *key)}: {100 * share:.3g} %")
                   for key, _, share in kinds(atlas)]
    else:
        values = atlas.records[kind]
        words = {"equilibria": lambda v: COUNTS.get(v) or f"{v} equilibri{'um' if v == 1 else 'a'}", "level": lambda v: LEVELS[v]}[kind]
        handles = [(Patch(facecolor=COUNTED[(int(value) if value >= 0 else n) % len(COUNTED)], edgecolor=style.GREY), words(int(value)))
                   for n, value in enumerate(np.unique(values))]
    if handles:
        axes[-1].legend(*zip(*handles), loc="upper center", bbox_to_anchor=(0.5, 0.0), ncols=min(2, len(handles)), borderaxespad=0.2)

