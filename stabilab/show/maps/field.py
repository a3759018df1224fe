"""A sweep along two axes: a map of the fate with the boundary and lines of equal margin, or of any number; several side by side."""
from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...maps.boundary import changes, known_exactly
from ...maps.columns import ENDLESS, NONE, OPEN
from ...orbit.result import Fate
from .. import style
from .shades import FLAGS, flag_legend, label, light, looks, own_value, scale_axes, spoken_key

COUNTS = ("equilibria", "stable", "unstable", "open")
ENDS = {"period": "never repeats", "least": "unbounded", "greatest": "unbounded", "when_low": "never", "when_high": "never"}  # what an infinite value means
WITHOUT = {ENDLESS: "curves", OPEN: "open", NONE: "no case"}


def fields(data: Any, plan: Any, kind: str, moving: list[str], panels: list[dict[str, int]], size: Any, plt: Any) -> Any:
    """The figure: a map for each panel, the first two of `moving` across and up."""
    across = min(4, math.isqrt(len(panels) - 1) + 1)
    down = -(-len(panels) // across)
    figure, axes = plt.subplots(down, across, squeeze=False, sharex=True, sharey=True, layout="constrained",
                                figsize=size or ((7.2, 6.0) if len(panels) == 1 else (3.0 * across + 0.8, 2.8 * down + 1.2)))
    rows: dict[str, Any] = {}
    shown = None
    limits = _limits(data, kind)
    for ax, place in zip(axes.flat, panels):
        here = data.isel(place)
        shown = _map(ax, here, data, kind, moving, limits)
        if kind == "fate":
            rows |= _boundary(ax, here, plan, moving, _index(data, plan, place))
            if "margin" in here and len(panels) == 1:
                rows |= _levels(ax, here, moving)
        scale_axes(ax, np.asarray(here[moving[0]]), np.asarray(here[moving[1]]))
        rows |= _own(ax, here, plan, moving) if not place else {}
        if place:
            ax.set_title(",\n".join(f"{spoken_key(data, name)} = {float(data[name][n]):.4g} {_unit(data, name)}".strip() for name, n in place.items()))
    for ax in axes.flat[len(panels):]:
        ax.set_visible(False)
    for ax in (axes.flat[n] for n in range(len(panels)) if n + across >= len(panels)):
        ax.set_xlabel(label(data, moving[0]))
        ax.xaxis.set_tick_params(labelbottom=True)
    for ax in axes[:, 0]:
        ax.set_ylabel(label(data, moving[1]))
    figure.suptitle(style.literal(str(data.attrs.get("title", ""))) + _of_all(data, panels), fontsize=10.5, wrap=True)
    if kind not in FLAGS:
        rows |= _blank(data, kind)
        of_axes = f", {'least' if kind == 'least' else 'greatest'} of the three axes" if "axis" in data[kind].dims else ""
        bar = figure.colorbar(shown, ax=axes, label=label(data, kind) + of_axes)
        if kind in COUNTS:
            numbers = [n for n in range(int(limits[0]), int(limits[1]) + 1) if n >= 0 or (np.asarray(data[kind]) == n).any()]
            bar.set_ticks(numbers, labels=[WITHOUT.get(n, str(n)) for n in numbers])
            bar.ax.tick_params(length=0)
    handles = [*(flag_legend(data, kind) if kind in FLAGS else []), *((h, w) for w, h in rows.items())]
    if handles:
        figure.legend(*zip(*handles), loc="outside lower center", ncols=min(4, len(handles)))
    return figure


def _unit(data, name) -> str:
    unit = data[name].attrs.get("units", "1")
    return "" if unit == "1" else unit


def _of_all(data, panels) -> str:
    """What share of the maps is shown, where not all are."""
    number = math.prod(data.sizes[name] for name in panels[0])
    return f" ({len(panels)} of {number} maps)" if len(panels) < number else ""


def _index(data, plan, place) -> tuple[int, ...]:
    """The place along every dimension of the sweep; 0 where the map varies."""
    by_key = {data[name].attrs["long_name"]: n for name, n in place.items()}
    return tuple(by_key.get(axis.key.name, 0) for axis in plan.axes)


def values_of(data, kind) -> np.ndarray:
    """A number for each point: of three axes the least of what is least, the greatest of what is greatest."""
    array = data[kind]
    if "axis" in array.dims:
        array = array.min("axis") if kind == "least" else array.max("axis")
    return np.asarray(array)


def _blank(data, kind) -> dict[str, Any]:
    """What the cells mean that are left white."""
    from matplotlib.patches import Patch
    values = values_of(data, kind)
    told = [words for words, there in ((ENDS.get(kind, "without end"), np.isinf(values)), ("not known", np.isnan(values))) if there.any()]
    return {f"white: {' or '.join(told)}": Patch(facecolor="white", edgecolor=style.GREY)} if told else {}


def _own(ax, data, plan, moving) -> dict[str, Any]:
    """The case's own place on the map, where it is on it."""
    from matplotlib.lines import Line2D
    keys = [axis.key.name for axis in plan.axes]
    at = [own_value(plan, keys.index(data[name].attrs["long_name"])) for name in moving[:2]]
    ends = [(float(data[name].min()), float(data[name].max())) for name in moving[:2]]
    if any(value is None or not low <= value <= high for value, (low, high) in zip(at, ends)):
        return {}
    look: dict[str, Any] = style.MARKER["start"] | {"markeredgecolor": "white"}
    ax.plot(*[[value] for value in at], **look)
    return {"the case itself": Line2D([], [], **look)}


def _limits(data, kind) -> tuple[float, float]:
    values = np.asarray(values_of(data, kind), float)
    values = values[np.isfinite(values)]
    return (float(values.min()), float(values.max())) if values.size else (0.0, 1.0)


def _map(ax, data, whole, kind, moving, limits) -> Any:
    from matplotlib.colors import BoundaryNorm, ListedColormap
    x, y = (np.asarray(data[name]) for name in moving[:2])
    dims = [d for d in data[kind].dims if d != "axis"]
    values = values_of(data, kind) if dims == moving[:2] else values_of(data, kind).T
    options: dict[str, Any] = {"shading": "nearest", "rasterized": True}
    if kind in FLAGS:
        look = looks(whole, kind)
        options |= {"cmap": ListedColormap([light(colour) for _, colour in look.values()]), "vmin": -0.5, "vmax": len(look) - 0.5}
        values = np.searchsorted(list(look), values)
    elif kind in COUNTS:
        levels = np.arange(limits[0], limits[1] + 2) - 0.5
        colours = ListedColormap([light(colour, 0.6) for colour in (style.GREY, *style.SHEETS)][:max(2, len(levels) - 1)])
        options |= {"cmap": colours, "norm": BoundaryNorm(levels if len(levels) > 2 else [*levels, levels[-1] + 1], colours.N)}
    else:
        options |= {"cmap": "cividis", "vmin": limits[0], "vmax": limits[1]}
        values = np.where(np.isfinite(values), values, np.nan)
    ax.grid(False)
    return ax.pcolormesh(x, y, values.T, **options)


def _levels(ax, data, moving) -> dict[str, Any]:
    """Lines of equal margin within what stays bounded, at round numbers."""
    from matplotlib.ticker import MaxNLocator
    x, y = (np.asarray(data[name]) for name in moving[:2])
    margin = np.where((np.asarray(data["fate"]) == Fate.BOUNDED) & np.isfinite(np.asarray(data["margin"])), np.asarray(data["margin"]), np.nan)
    if np.isfinite(margin).sum() < 9 or min(margin.shape) < 5 or not np.nanmax(margin) > 0:
        return {}
    round_ones = MaxNLocator(6, steps=(1, 2, 2.5, 5, 10)).tick_values(0, np.nanmax(margin))
    drawn = ax.contour(x, y, margin.T, levels=[level for level in round_ones if 0 < level < np.nanmax(margin)], colors=style.GREY, linewidths=0.6)
    if not any(len(line) for level in drawn.allsegs for line in level):  # finite margins here and there make no line
        return {}
    ax.clabel(drawn, fontsize=7, fmt="%.3g")
    unit = _unit(data, "margin")
    return {f"equal margin{f' ({unit})' if unit else ''}": _line("level", 0.6)}


def _line(meaning: str, width: float) -> Any:
    """A line of a legend."""
    from matplotlib.lines import Line2D
    look: dict[str, Any] = style.MEANING[meaning] | {"linewidth": width}
    return Line2D([], [], **look)


def _boundary(ax, data, plan, moving, index) -> dict[str, Any]:
    from matplotlib.collections import LineCollection
    dims = [next(n for n, axis in enumerate(plan.axes) if axis.key.name == data[name].attrs["long_name"]) for name in moving[:2]]
    exact = known_exactly(plan, *dims)
    fates = np.asarray(data["fate"].transpose(*moving[:2]))
    margin = np.asarray(data["margin"].transpose(*moving[:2])) if "margin" in data else None
    if not exact and margin is None:
        return {}
    way = (lambda at, along: _exact(plan, index, dims, at, along, fates)) if exact else (lambda at, along: _zero(margin, at, along))
    x, y = (np.asarray(data[name]) for name in moving[:2])
    segments = segments_of(fates, x, y, way)
    ax.add_collection(LineCollection(list(segments), color=style.BLACK, linewidth=1.4))
    words = "separatrix (exact)" if exact else "margin zero"
    return {words: _line("separatrix", 1.4)} if len(segments) else {}


def _exact(plan, index, dims, at, along, fates):
    rows = np.tile(np.array(index), (len(at), 1))
    rows[:, dims[0]], rows[:, dims[1]] = at[:, 0], at[:, 1]
    return changes(plan, index, dims[along], rows, fates[at[:, 0], at[:, 1]] == Fate.SPIN_UP)


def _zero(margin, at, along):
    """Where the straight line between two margins is zero; half way where one of them is not finite."""
    here, there = margin[at[:, 0], at[:, 1]], margin[at[:, 0] + (along == 0), at[:, 1] + (along == 1)]
    with np.errstate(invalid="ignore", divide="ignore"):
        share = here / (here - there)
    return np.where(np.isfinite(share) & (share >= 0) & (share <= 1), share, 0.5)


def segments_of(fates: np.ndarray, x: np.ndarray, y: np.ndarray, way: Any) -> np.ndarray:
    """(n, 2, 2): pieces of the line between what spins up and what does not, one or two in each cell of the map that it crosses. way(at, along): the
    share of the way from points (n, 2) to their neighbours along an axis at which the fate changes."""
    spun, known = fates == Fate.SPIN_UP, fates < Fate.UNDECIDED
    crossing = []
    for along, values in enumerate((x, y)):
        low, high = (slice(None, -1), slice(None)), (slice(1, None), slice(None))
        low, high = (low, high) if along == 0 else (low[::-1], high[::-1])
        differs = (spun[low] != spun[high]) & known[low] & known[high]
        at = np.argwhere(differs)
        points = np.full((*differs.shape, 2), np.nan)
        if len(at):
            share, place = way(at, along), at[:, along]
            moved = values[place] + (values[place + 1] - values[place]) * share
            other = (y[at[:, 1]], x[at[:, 0]])[along]
            points[at[:, 0], at[:, 1]] = np.stack([moved, other] if along == 0 else [other, moved], axis=1)
        crossing.append(points)
    level, upright = crossing  # between neighbours along x, along y
    sides = np.stack([level[:, :-1], upright[1:], level[:, 1:], upright[:-1]], axis=2)  # below, right, above, left of each cell
    met = np.isfinite(sides[..., 0])
    pairs = [sides[cell][met[cell]].reshape(-1, 2, 2) for cell in map(tuple, np.argwhere(met.sum(-1) >= 2)) if met[cell].sum() in (2, 4)]
    return np.concatenate(pairs) if pairs else np.empty((0, 2, 2))
