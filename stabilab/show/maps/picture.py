"""Pictures of sweeps: lines over one number, fields over two, clouds of samples."""
from __future__ import annotations

import math
from collections.abc import Callable
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ...errors import InputError, printable
from ...maps.columns import ANSWERS
from ...maps.plan import Plan
from ...maps.run import changes, known_exactly
from ...orbit.result import OUTCOMES, Fate
from ...packages import demand
from .. import endings, style
from ..limiting import Note
from ..plot import basins as basin_picture
from ..plot.to_file import check_size
from ..terminal import written
from ..text import notes
from ..units import number, units_of, with_unit
from . import basins as basin_data
from . import shades
from .sweep import CELLS
from .sweep_file import dimensions_of, in_units, loaded, plan_of

if TYPE_CHECKING:
    from types import ModuleType

    import xarray


# --- A sweep along one axis: a curve for every number, the fate (or how it is known) as the colour behind
# it
COUNTS = tuple(column.name for answer in ANSWERS.values() for column in answer.columns if column.kind == "i4")
# numbers in one panel: those of an answer that have a unit in common, and all counts
TOGETHER = (*(tuple(column.name for column in answer.columns if column.kind == "f8" and column.unit == unit)
              for answer in ANSWERS.values()
              for unit in dict.fromkeys(item.unit for item in answer.columns if item.kind == "f8")), COUNTS)
BEHIND = 0.85  # of the colour of an area behind curves
NUMBERS = tuple(item.name for answer in ANSWERS.values() for item in answer.columns if item.kind != "i1")


def curves(data: Any, plan: Any, kind: str, along: str, size: Any, plt: Any) -> Any:
    """The figure: a panel for each question; of a column other than the fate, the panel that it is in alone.
    """
    panels = [[name for name in names if name in data] for names in TOGETHER
              if kind in (*shades.FLAGS, *names)]
    panels = ([names for names in panels if names and np.isfinite(np.asarray(data[names[0]], float)).any()]
              or [[]])
    figure, axes = plt.subplots(len(panels), 1, sharex=True, squeeze=False, layout="constrained",
                                figsize=size or (8, 1.4 + 2.2 * len(panels)))
    x, behind = np.asarray(data[along]), kind if kind in shades.FLAGS else "fate"
    order, rows = np.argsort(x), {}
    shades.furnish(axes[-1, 0], data, along)
    style.above(axes[0, 0], _title(data))
    for ax, names in zip(axes[:, 0], panels):
        if behind in data:
            _bands(ax, x[order], np.asarray(data[behind])[order], shades.looks(data, behind))
            rows |= {text: patch | {"facecolor": shades.light(patch["facecolor"], BEHIND)}
                     for text, patch in shades.flag_legend(data, behind).items()}
        _lines(ax, data, x, order, names)
        if len(ax.lines) > 1:  # beside the panel, whose curves it would cover
            ax.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
        ax.set_xlim(x.min(), x.max())
        rows |= shades.mark_own(ax, [shades.own_value(plan, _dimension(data, plan, along))])
    style.legend(figure, rows, notes=_notes(figure, data))
    return figure


def _title(data: Any) -> str:
    return str(data.attrs.get("title", ""))


def _dimension(data: Any, plan: Any, name: str) -> int:
    """The place of a dimension of the data in the order of the sweep."""
    return [axis.key.name for axis in plan.axes].index(data[name].attrs["long_name"])


def _bands(ax, x, flags, look):
    """Areas of one flag, each from half way before its first point to half way after its last."""
    edges = np.concatenate([[x[0]], 0.5 * (x[1:] + x[:-1]), [x[-1]]])
    cuts = [0, *(np.flatnonzero(np.diff(flags)) + 1), len(flags)]
    for first, last in zip(cuts, cuts[1:]):
        ax.axvspan(edges[first], edges[last], facecolor=shades.light(look[int(flags[first])][1], BEHIND),
                   linewidth=0, zorder=0)


def _lines(ax, data, x, order, names):
    for n, name in enumerate(names):
        values = np.asarray(data[name], float)[order]
        values = np.where(np.isfinite(values), values, np.nan)
        if name != "margin":
            values = _broken(data, order, values)
        if name in COUNTS:
            ax.step(x[order], np.where(values < 0, np.nan, values), where="mid", color=style.SERIES[n],
                    linestyle=("-", "--", ":", "-.")[n], label=name)
            ax.yaxis.get_major_locator().set_params(integer=True)
        elif values.ndim == 1:
            # two may be one line
            ax.plot(x[order], values, color=style.SERIES[n], linestyle=(0, (6, 6)) if n else "-",
                    label=shades.short_label(data, name))
        else:
            for i, axis in enumerate(data["axis"].attrs.get("names", "axis 1; axis 2; axis 3").split("; ")):
                ax.plot(x[order], values[:, i], color=style.AXES[i], linestyle="--" if n else "-",
                        label=f"{name}, {axis}")
    if names:
        of = data[names[0]].attrs.get("units", "1")
        printed = {"least": "extremes", "when_low": "time to the limit",
                "equilibria": "number"}.get(names[0], names[0])
        ax.set_ylabel(printed if of == "1" else f"{printed} ({of})")
    else:
        ax.set_yticks([])


def _broken(data, order, values):
    """The values with a gap where the fate changes: what lies on both sides is no one curve."""
    if "fate" not in data:
        return values
    at = np.flatnonzero(np.diff(np.asarray(data["fate"])[order]))
    ends = np.array(values)
    ends[at[np.isfinite(values.reshape(len(values), -1)[at]).all(axis=1)]] = np.nan
    return ends


# --- A sweep along two axes: a map of the fate with the boundary and lines of equal margin, or of any
# number; several side by side
# what an infinite value means
ENDS = {"period": "never repeats", "least": "unbounded", "greatest": "unbounded", "when_low": "never",
        "when_high": "never"}


def fields(data: Any, plan: Any, kind: str, moving: list[str], panels: list[dict[str, int]], size: Any,
           plt: Any) -> Any:
    """The figure: a map for each panel, the first two of `moving` across and up."""
    across = min(4, math.isqrt(len(panels) - 1) + 1)
    down = -(-len(panels) // across)
    figure, axes = plt.subplots(down, across, squeeze=False, sharex=True, sharey=True, layout="constrained",
                                figsize=size
                                or ((7.2, 6.0) if len(panels) == 1
                                    else (3.0 * across + 0.8, 2.8 * down + 1.2)))
    rows = shades.flag_legend(data, kind) if kind in shades.FLAGS else _blank(data, kind)
    limits = _limits(data, kind)
    for n, (ax, panel) in enumerate(zip(axes.flat, panels)):
        here = data.isel(panel)
        shown = _map(ax, here, data, kind, moving, limits)
        if kind == "fate":
            rows |= _boundary(ax, here, plan, moving, _index(data, plan, panel))
            if "margin" in here and len(panels) == 1:
                rows |= _levels(ax, here, moving)
        if kind == SHARE_COLUMN:
            x, y = (np.asarray(here[name]) for name in moving[:2])
            ax.contour(x, y, np.asarray(here[kind].transpose(*moving[:2])).T, levels=[5, 50, 95],
                       colors=style.BLACK, linewidths=(0.6, 1.2, 0.6))
        shades.furnish(ax, data, *moving[:2])
        ax.label_outer()
        if n + across >= len(panels):  # the last of its column
            ax.xaxis.set_tick_params(labelbottom=True)
            ax.set_xlabel(shades.label(data, moving[0]))
        rows |= {} if panel else shades.mark_own(
            ax, [shades.own_value(plan, _dimension(data, plan, name)) for name in moving[:2]])
        ax.set_title(*_panel_title(data, panel, figure.get_figwidth() / across))
    for ax in axes.flat[len(panels):]:
        ax.set_visible(False)
    full = math.prod(data.sizes[name] for name in panels[0])
    style.over(figure, _title(data), f"{len(panels)} of {full} maps" if len(panels) < full else "")
    if kind not in shades.FLAGS:
        of_axes = (f", {'least' if kind == 'least' else 'greatest'} of the three axes"
                   if "axis" in data[kind].dims else "")
        bar = figure.colorbar(shown, ax=axes, label=shades.label(data, kind) + of_axes)
        if kind in COUNTS:
            numbers = [n for n in range(int(limits[0]), int(limits[1]) + 1) if n >= 0
                       or (np.asarray(data[kind]) == n).any()]
            bar.set_ticks(numbers, labels=[CELLS.get(n, str(n)) for n in numbers])
            bar.ax.tick_params(length=0)
    style.legend(figure, rows, notes=_notes(figure, data))
    return figure


def _panel_title(data: xarray.Dataset, panel: dict[str, int], inches: float) -> tuple[str, dict[str, float]]:
    """The values at which a map of several is, in two lines at most, and the size of their letters."""
    parts = [f"{shades.spoken_key(data, name)} = {number(float(data[name][n]))} {_unit(data, name)}".strip()
             for name, n in panel.items()]
    half = -(-len(parts) // style.TITLE_LINES)
    lines = [", ".join(part) for part in (parts[:half], parts[half:]) if part]
    return ",\n".join(lines), {"fontsize": style.fitting(max(lines, key=len, default=""), inches)}


def _notes(figure: Any, data: xarray.Dataset) -> str:
    """What limits the answers of a file, as it stands there, for its legend."""
    text = written(str(data.attrs.get("caveats", "")))
    return notes.fitted([Note(text, "the file has caveats")] if text else [], figure.get_figwidth())


def _unit(data, name) -> str:
    unit = data[name].attrs.get("units", "1")
    return "" if unit == "1" else unit


def _index(data, plan, location) -> tuple[int, ...]:
    """The place along every dimension of the sweep; 0 where the map varies."""
    places = {_dimension(data, plan, name): n for name, n in location.items()}
    return tuple(places.get(n, 0) for n in range(len(plan.axes)))


def values_of(data, kind) -> np.ndarray:
    """A number for each point: of three axes the least of what is least, the greatest of what is greatest."""
    array = data[kind]
    if "axis" in array.dims:
        array = array.min("axis") if kind == "least" else array.max("axis")
    return np.asarray(array)


def _blank(data, kind) -> dict[str, Any]:
    """What the cells mean that are left white."""
    values = values_of(data, kind)
    text = [phrase for phrase, there in ((ENDS.get(kind, "without end"), np.isinf(values)),
                                       ("not known", np.isnan(values))) if there.any()]
    return {f"white: {' or '.join(text)}": {"facecolor": "white", "edgecolor": style.GREY}} if text else {}


def _limits(data, kind) -> tuple[float, float]:
    if kind == SHARE_COLUMN:
        return 0.0, 100.0
    values = np.asarray(values_of(data, kind), float)
    values = values[np.isfinite(values)]
    return (float(values.min()), float(values.max())) if values.size else (0.0, 1.0)


def _map(ax, data, full, kind, moving, limits) -> Any:
    from matplotlib.colors import BoundaryNorm, ListedColormap
    x, y = (np.asarray(data[name]) for name in moving[:2])
    dims = [d for d in data[kind].dims if d != "axis"]
    values = values_of(data, kind) if dims == moving[:2] else values_of(data, kind).T
    options: dict[str, Any] = {"shading": "nearest", "rasterized": True}
    if kind in shades.FLAGS:
        look = shades.looks(full, kind)
        options |= {"cmap": ListedColormap([colour for _, colour in look.values()]),
                    "vmin": -0.5, "vmax": len(look) - 0.5}
        values = np.searchsorted(list(look), values)
    elif kind in COUNTS:
        levels = np.arange(limits[0], limits[1] + 2) - 0.5
        count = max(2, len(levels) - 1)
        colours = ListedColormap([shades.light(style.BLACK, 0.1 + 0.6 * n / count) for n in range(count)])
        options |= {"cmap": colours,
                    "norm": BoundaryNorm(levels if len(levels) > 2 else [*levels, levels[-1] + 1], colours.N)}
    else:
        options |= {"cmap": shades.scale(), "vmin": limits[0], "vmax": limits[1]}
        values = np.where(np.isfinite(values), values, np.nan)
    ax.grid(False)
    return ax.pcolormesh(x, y, values.T, **options)


def _levels(ax, data, moving) -> dict[str, Any]:
    """Lines of equal margin within what stays bounded, at round numbers."""
    from matplotlib.ticker import MaxNLocator
    x, y = (np.asarray(data[name]) for name in moving[:2])
    margin = np.where((np.asarray(data["fate"]) == Fate.BOUNDED) & np.isfinite(np.asarray(data["margin"])),
                      np.asarray(data["margin"]), np.nan)
    if np.isfinite(margin).sum() < 9 or min(margin.shape) < 5 or not np.nanmax(margin) > 0:
        return {}
    round_ones = MaxNLocator(6, steps=(1, 2, 2.5, 5, 10)).tick_values(0, np.nanmax(margin))
    drawn = ax.contour(x, y, margin.T,
                       levels=[level for level in round_ones if 0 < level < np.nanmax(margin)],
                       colors=style.GREY, linewidths=0.6)
    # finite margins here and there make no line
    if not any(len(line) for level in drawn.allsegs for line in level):
        return {}
    ax.clabel(drawn, fontsize=7, fmt="%.3g")
    return {with_unit("equal margin", data["margin"].attrs["units"]): style.MEANING["level"]}


def _boundary(ax, data, plan, moving, index) -> dict[str, Any]:
    from matplotlib.collections import LineCollection
    dims = [_dimension(data, plan, name) for name in moving[:2]]
    exact = known_exactly(plan, *dims)
    fates = np.asarray(data["fate"].transpose(*moving[:2]))
    margin = np.asarray(data["margin"].transpose(*moving[:2])) if "margin" in data else None
    if not exact and margin is None:
        return {}
    route = (lambda at, along: _exact(plan, index, dims, at, along,
                                    fates)) if exact else (lambda at, along: zero_between(margin, at, along))
    x, y = (np.asarray(data[name]) for name in moving[:2])
    segments = segments_of(fates, x, y, route)
    look = style.MEANING["separatrix"] | {"linewidth": 1.4}
    ax.add_collection(LineCollection(list(segments), color=look["color"], linewidth=look["linewidth"]))
    return {"separatrix (exact)" if exact else "margin zero": look} if len(segments) else {}


def _exact(plan, index, dims, at, along, fates):
    rows = np.tile(np.array(index), (len(at), 1))
    rows[:, dims[0]], rows[:, dims[1]] = at[:, 0], at[:, 1]
    return changes(plan, index, dims[along], rows, fates[at[:, 0], at[:, 1]] == Fate.SPIN_UP)


def zero_between(margin: np.ndarray, at: np.ndarray, along: int) -> np.ndarray:
    """Where the straight line between two margins is zero. Where a motion has none, as no barrier is ahead,
    the line through the two on the other side goes on, to the next point at most; half way without these."""
    step = np.array([along == 0, along == 1], int)

    def value(steps: int) -> np.ndarray:
        place = at + steps * step
        inside = (place >= 0).all(axis=1) & (place < margin.shape).all(axis=1)
        found = margin[tuple(np.where(inside[:, None], place, 0).T)]
        return np.where(inside & np.isfinite(found), found, np.nan)
    before, here, there, after = map(value, (-1, 0, 1, 2))
    with np.errstate(invalid="ignore", divide="ignore"):
        tries = (here / (here - there), here / (before - here), 1 - there / (after - there))
    fraction = np.full(len(at), 0.5)
    for tried in reversed(tries):
        fraction = np.where(np.isfinite(tried), np.clip(tried, 0, 1), fraction)
    crossed = np.isnan(here) | np.isnan(there) | (here * there <= 0)  # else no line between them has a zero
    return np.where(crossed, fraction, 0.5)


def segments_of(fates: np.ndarray, x: np.ndarray, y: np.ndarray,
                route: Callable[[np.ndarray, int], np.ndarray]) -> np.ndarray:
    """(n, 2, 2): pieces of the line between what spins up and what does not, one or two in each cell of the
    map that it crosses. route(at, along): the share of the way from points (n, 2) to their neighbours along
    an axis at which the fate changes."""
    spun, resolved = fates == Fate.SPIN_UP, fates < Fate.UNDECIDED
    crossing = []
    for along, values in enumerate((x, y)):
        low, high = (slice(None, -1), slice(None)), (slice(1, None), slice(None))
        low, high = (low, high) if along == 0 else (low[::-1], high[::-1])
        differs = (spun[low] != spun[high]) & resolved[low] & resolved[high]
        at = np.argwhere(differs)
        points = np.full((*differs.shape, 2), np.nan)
        if len(at):
            fraction, location = route(at, along), at[:, along]
            moved = values[location] + (values[location + 1] - values[location]) * fraction
            other = (y[at[:, 1]], x[at[:, 0]])[along]
            points[at[:, 0], at[:, 1]] = np.stack([moved, other] if along == 0 else [other, moved], axis=1)
        crossing.append(points)
    level, upright = crossing  # between neighbours along x, along y
    # below, right, above, left of each cell
    sides = np.stack([level[:, :-1], upright[1:], level[:, 1:], upright[:-1]], axis=2)
    met = np.isfinite(sides[..., 0])
    pairs = [sides[cell][met[cell]].reshape(-1, 2, 2) for cell in map(tuple, np.argwhere(met.sum(-1) >= 2))
             if met[cell].sum() in (2, 4)]
    return np.concatenate(pairs) if pairs else np.empty((0, 2, 2))


# --- A sweep over random samples: how the numbers spread, or, beside other axes, what share of the samples
# spins up
BINS = 60
SHARE_COLUMN = "share"  # a column of the share of the samples that spins up


def spread(data: Any, plan: Any, kind: str, moving: list[str], size: Any, plt: Any) -> Any:
    """The figure: histograms of samples alone, shares of fates along one axis, the share that spins up along
    two or more."""
    if not moving:
        return _histograms(data, kind, size, plt)
    if "fate" not in data:
        raise InputError("plot: shares of samples need the fate: ask for it with --answer fate")
    if len(moving) == 1:
        return _shares(data, moving, size, plt)
    part = 100 * (data["fate"] == Fate.SPIN_UP).mean(shades.SAMPLE)
    text = (f"share of {data.sizes[shades.SAMPLE]:,} samples that {OUTCOMES[Fate.SPIN_UP].does}, lines at "
             "5, 50 and 95")
    shares = part.assign_attrs(long_name=text, units="%")
    return fields(data.assign({SHARE_COLUMN: shares}), plan, SHARE_COLUMN, moving,
                  _panels(data, moving), size, plt)


def _histograms(data, kind, size, plt):
    names = [name for name in ("margin", "distance", "period", "when_low") if name in data
             and np.isfinite(data[name]).any()]
    names = [kind] if kind in names else names
    if not names:
        raise InputError(
            "plot: these samples have no finite number to draw: ask for --answer margin, distance, period "
            "or when")
    figure, axes = plt.subplots(len(names), 1, squeeze=False, layout="constrained",
                                figsize=size or (8, 1.2 + 2.6 * len(names)))
    for ax, name in zip(axes[:, 0], names):
        values = np.asarray(data[name])
        finite = np.isfinite(values)
        edges = np.histogram_bin_edges(values[finite], BINS)
        for fate, (text, colour) in shades.FATES.items():
            of = finite & (np.asarray(data["fate"]) == fate) if "fate" in data else finite
            if of.any():
                printed = f"{text}: {of.sum():,}" if "fate" in data else None
                ax.hist(values[of], edges, facecolor=colour, edgecolor=style.GREY, linewidth=0.6,
                        label=printed)
            if "fate" not in data:
                break
        ax.set_xlabel(shades.short_label(data, name))
        ax.set_ylabel("samples")
        if "fate" in data:
            ax.legend(loc="best")
    style.above(axes[0, 0], _title(data), f"{data.sizes[shades.SAMPLE]:,} samples")
    style.legend(figure, [], notes=_notes(figure, data))
    return figure


def _shares(data, moving, size, plt):
    figure, ax = plt.subplots(layout="constrained", figsize=size or (8, 4.5))
    x, fates = np.asarray(data[moving[0]]), np.asarray(data["fate"].transpose(moving[0], shades.SAMPLE))
    base, rows = np.zeros(len(x)), shades.flag_legend(data, "fate")
    for fate, (text, _) in shades.FATES.items():
        if text in rows:
            fraction = 100 * (fates == fate).mean(axis=1)
            ax.fill_between(x, base, base + fraction, linewidth=0.6, **rows[text])
            base = base + fraction
    ax.set_xlim(x.min(), x.max())
    ax.set_ylim(0, 100)
    shades.furnish(ax, data, moving[0])
    ax.set_ylabel(f"share of {data.sizes[shades.SAMPLE]:,} samples (%)")
    style.above(ax, _title(data))
    style.legend(figure, rows, notes=_notes(figure, data))
    return figure


# --- A sweep's file as a picture: curves along one axis, a map along two, small maps side by side along
# more
PANELS = 6  # small maps of a picture


def write(path: str | Path, out: str | Path, kind: str | None = None, size: tuple[float, float] | None = None,
          dpi: float | None = None,
          units: str | None = None) -> Path:
    """Draw a file of `stabilab sweep` and write the picture; returns its path. kind: the name of a column;
    None: the fate, with the margin, or the first number that there is. units: of rates and times that were
    answered, "deg" or "si"; None for those of the case; an axis keeps the unit in which it was varied. Raises
    InputError for a file that is none, and for a column that it has not."""
    demand("xarray", "scipy", *style.PACKAGES)
    target = endings.file(out, endings.PICTURES)
    check_size(size, dpi)
    data = loaded(Path(path))
    if "basin" in data.attrs:
        return _basin(data, Path(path), target, kind, size, dpi)
    plan = plan_of(data, Path(path))
    data = in_units(data, units_of(plan.case, units))
    with style.drawing() as plt:
        figure = drawn(data, plan, chosen(data, kind), size, plt)
        return style.save(figure, target, dpi)


def _basin(data, path, target, kind, size, dpi) -> Path:
    """The same of a file of `stabilab basin`."""
    if kind is not None:
        raise InputError(
            f"plot {printable(kind)[:40]}: a file of stabilab basin has one picture: leave --kind away")
    try:
        result = basin_data.opened(data)
    except Exception:  # of any kind: what stands there is not of this program, or of another version
        raise InputError(
            f"{printable(str(path))}: what it says of its basins cannot be read: was it changed, or made by "
            f"another version?") from None
    return basin_picture.write(result, target, size, dpi)


def chosen(data: xarray.Dataset, kind: str | None) -> str:
    """The column that is drawn. Raises InputError where the file lacks it, or no number of it could be drawn.
    """
    have = [name for name in ("fate", *NUMBERS, "chaos", "level", "reason") if name in data]
    if kind is not None and kind not in have:
        raise InputError(f"plot {printable(kind)[:40]}: this file has {', '.join(have)}")
    request = have if kind is None else [kind]
    result = next((name for name in request if np.isfinite(data[name]).any()), None)
    if result is None:
        raise InputError(f"plot: nothing to draw: no point has a finite value of {' or '.join(request)}")
    return result


def drawn(data: xarray.Dataset, plan: Plan, kind: str, size: tuple[float, float] | None,
          plt: ModuleType) -> Any:
    """The figure of a column: curves, a map, small maps, or how samples spread."""
    moving = [name for name in dimensions_of(data) if data.sizes[name] > 1]
    data = data.isel({name: 0 for name in dimensions_of(data) if name not in moving})
    if shades.SAMPLE in data.sizes:
        return spread(data, plan, kind, moving, size, plt)
    if len(moving) < 2:
        if not moving:
            raise InputError("a sweep of one point has no picture: stabilab plot draws its case")
        return curves(data, plan, kind, moving[0], size, plt)
    # of three axes one may be finite where the greatest is not
    if not np.isfinite(values_of(data, kind)).any():
        raise InputError(f"plot: nothing to draw: no point has a finite value of {kind}")
    return fields(data, plan, kind, moving, _panels(data, moving), size, plt)


def _panels(data, moving: list[str]) -> list[dict[str, int]]:
    """Places along the dimensions beyond the two that have most points, spread over each, as many as a
    picture takes."""
    rest = moving[2:]
    if not rest:
        return [{}]
    # six along one, three and two along the first two, one along any other
    largest = [PANELS] if len(rest) == 1 else [3, 2] + [1] * (len(rest) - 2)
    choices = [np.unique(np.linspace(0, data.sizes[name] - 1, min(count, data.sizes[name]))
                         .round().astype(int)).tolist() for name, count in zip(rest, largest)]
    return [dict(zip(rest, location)) for location in product(*choices)]
