"""An atlas as a picture and as a page.

The sphere of directions is drawn by Hammer's map, which preserves areas, turned so that no principal axis
lies on its rim. Axis 3 points up. Axes 1 and 2 stand 45 degrees left and right of the middle, so all six
directions of the axes lie inside; the rim is half way from -1 to -2."""
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ...errors import InputError, printable
from ...maps.atlas import Atlas
from ...maps.columns import ISLANDS, LEVELS, LIMIT_LEVELS
from ...maps.pointed import AXES, DEEPEST, places_of
from ...orbit.result import Fate
from ...packages import demand
from .. import style
from ..axes import axes_of
from ..report import html
from ..text import notes
from ..units import SHORT, Units, number
from .atlas import (
    answer,
    does,
    in_time,
    kind_colour,
    kind_hatch,
    kind_words,
    kinds,
    limit_words,
    shown_name,
    wheel_words,
)
from .atlas import text as in_words
from .shades import hatched, light, limits_of, scale
from .sweep import COUNTS

# --- The map of the sphere
ACROSS, UP = 2 * np.sqrt(2), np.sqrt(2)  # half the width and half the height of the map
MIDDLE = np.pi / 4  # longitude, from axis 1 towards axis 2, of the map's middle


def on_map(directions: np.ndarray) -> np.ndarray:
    """(n, 2): where directions (n, 3) lie on the map."""
    directions = np.asarray(directions, float)
    size = np.linalg.norm(directions, axis=1)
    turn = np.arctan2(directions[:, 1], directions[:, 0]) - MIDDLE
    turn = (turn + np.pi) % (2 * np.pi) - np.pi
    sine = directions[:, 2] / size
    cosine = np.sqrt(np.maximum(1 - sine**2, 0.0))
    root = np.sqrt(1 + cosine * np.cos(turn / 2))
    return np.stack([ACROSS * cosine * np.sin(turn / 2) / root, UP * sine / root], axis=1)


def off_map(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """((n, 3) directions of places on the map, (n,) whether they lie on it)."""
    inside = (x / ACROSS) ** 2 + (y / UP) ** 2 <= 1
    root = np.sqrt(np.maximum(1 - (x / 4) ** 2 - (y / 2) ** 2, 0.5))
    turn = 2 * np.arctan2(root * x, 2 * (2 * root**2 - 1)) + MIDDLE
    sine = np.clip(root * y, -1, 1)
    cosine = np.sqrt(1 - sine**2)
    return np.stack([cosine * np.cos(turn), cosine * np.sin(turn), sine], axis=-1), inside


def pieces(directions: np.ndarray) -> list[np.ndarray]:
    """A line of directions on the map, cut where it leaves over the rim."""
    at = on_map(directions)
    breaks = np.flatnonzero(np.abs(np.diff(at[:, 0])) > ACROSS) + 1
    return np.split(at, breaks)


def circle(axis: int) -> np.ndarray:
    """(n, 3): the principal plane across an axis, 0 to 2."""
    turn = np.linspace(0, 2 * np.pi, 721)
    out = np.zeros((len(turn), 3))
    out[:, (axis + 1) % 3], out[:, (axis + 2) % 3] = np.cos(turn), np.sin(turn)
    return out


def rim() -> np.ndarray:
    """(n, 2): the outline of the map."""
    turn = np.linspace(0, 2 * np.pi, 361)
    return np.stack([ACROSS * np.cos(turn), UP * np.sin(turn)], axis=1)


# --- An atlas as a picture: the map of fates and that of times, with axes and thrusters; a row of both for
# each wheel momentum
PIXELS = 1500  # across one map
MAPS = 6  # of a picture
LOG = 8  # times of more than this ratio are shown by their logarithm
COLOURED_BY = ("fate", "when", "equilibria", "level")
NEVER, UNKNOWN = light(style.FILL["bounded"], 1.0), light(style.FILL["undecided"], 1.0)
COUNTED = tuple(light(style.BLACK, 0.08 + 0.1 * n) for n in range(5))  # greys: the words have the numbers
COARSE = 5  # pixels of a map to a point of its hatches


def write_picture(atlas: Atlas, path: Path, units: Units, kind: str | None = None,
                  size: tuple[float, float] | None = None, dpi: float | None = None) -> Path:
    """Draw the atlas and write the picture; returns its path. kind: one of COLOURED_BY; None: the fate, and
    beside it the time to the limit, or the number of equilibria where there is no limit."""
    return style.write(path, lambda plt: drawn(atlas, units, chosen(atlas, kind), size, plt), dpi)


def chosen(atlas: Atlas, kind: str | None) -> tuple[str, ...]:
    """The maps of a picture. Raises InputError for a kind that there is none of."""
    timed = atlas.asked.stated_limit is not None
    have = [name for name in COLOURED_BY if timed or name != "when"]
    if kind is not None and kind not in have:
        raise InputError(f"plot {printable(kind)[:40]}: this atlas has {', '.join(have)}")
    return (kind,) if kind else ("fate", "when" if timed else "equilibria")


def drawn(atlas: Atlas, units: Units, shown: tuple[str, ...], size: tuple[float, float] | None,
          plt: Any) -> Any:
    """The figure: maps below each other for one wheel, in rows for several."""
    wheels = _wheels(atlas, MAPS // len(shown))
    alone = len(wheels) == 1
    down, across = (len(shown), 1) if alone else (len(wheels), len(shown))
    figure, axes = plt.subplots(down, across, squeeze=False, layout="constrained",
                                figsize=size
                                or ((7.8, 4.05 * down + 0.8) if alone
                                    else (5.4 * across + 0.4, 2.75 * down + 1.5)))
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
    case = atlas.asked.case
    rest = style.over(figure, case.title or case.name,
                      f"torque of {units.torque(float(atlas.asked.torque))} in every direction")
    records = np.concatenate([atlas.records, atlas.named_records])
    style.legend(figure, [], notes=notes.below(figure, case, limits_of(case, records), before=rest))
    return figure


def _wheels(atlas: Atlas, largest: int) -> list[int]:
    """So many wheel momenta at most, spread over all."""
    count = len(atlas.asked.wheels)
    return [int(n) for n in np.unique(np.linspace(0, count - 1, min(largest, count)).round())]


def _map(ax: Any, atlas: Atlas, wheel: int, kind: str, times: Any, plain: bool) -> None:
    """One map on its axes: colours by kind, principal planes, rim, and the marked directions."""
    x, y = np.meshgrid((np.arange(PIXELS) + 0.5) / PIXELS * 2 - 1,
                       (np.arange(PIXELS // 2) + 0.5) / (PIXELS // 2) * 2 - 1)
    directions, inside = off_map(x.ravel() * ACROSS, y.ravel() * UP)
    image = np.ones((len(inside), 4))
    image[~inside, 3] = 0
    cells = atlas.leaves.holding(wheel, places_of(directions[inside]))
    image[inside, :3] = colours(atlas, kind, times)[cells]
    ends = (-ACROSS, ACROSS, -UP, UP)
    ax.imshow(image.reshape(PIXELS // 2, PIXELS, 4), origin="lower", extent=ends, interpolation="antialiased",
              interpolation_stage="rgba")
    ax.set_aspect("equal")
    ax.axis("off")
    ax.set_xlim(-ACROSS * 1.04, ACROSS * 1.04)
    ax.set_ylim(-UP * 1.1, UP * 1.1)
    for axis in range(3):
        for piece in pieces(circle(axis)):
            ax.plot(*piece.T, color=style.BLACK, linewidth=0.5, alpha=0.5)
    if kind == "fate":
        labels = np.full(len(inside), -1)
        labels[inside] = classes(atlas, kind)[0][cells]
        coarse = (slice(COARSE // 2, None, COARSE),) * 2
        on = lambda values: values.reshape(PIXELS // 2, PIXELS)[coarse]
        hatched(ax, on(x)[0] * ACROSS, on(y)[:, 0] * UP, on(labels),
                {n: (kind_hatch(*key), _letter(atlas, *key)) for n, (key, _, _) in enumerate(kinds(atlas))})
    ax.plot(*rim().T, color=style.BLACK, linewidth=0.9)
    _points(ax, atlas, wheel, plain, list(ax.texts))


def _letter(atlas: Atlas, fate: int, axis: int, island: int) -> str:
    """The name of the axis of a spin-up, as it stands in its area."""
    if fate != Fate.SPIN_UP or not axis:
        return ""
    return axes_of(atlas.asked.case).signed(abs(axis), axis).partition(" ")[0].replace("-", "\u2212")


def _points(ax: Any, atlas: Atlas, wheel: int, plain: bool, names: list[Any]) -> None:
    """Axes and thrusters with their names, on light ground that lets them be read, beside the names of areas.
    """
    from matplotlib.patheffects import withStroke
    halo = [withStroke(linewidth=2.4, foreground="white")]
    here = [n for n, point in enumerate(atlas.named) if point.wheel == wheel]
    size, taken = 8 if plain else 9, []
    # points of a unit of the map, roughly
    scale = (ax.figure.get_figwidth() * 72 * 0.9
             / (ax.get_subplotspec().get_gridspec().ncols * 2.08 * ACROSS))
    for name in names:
        at, half = np.array(name.get_position()) * scale, 0.31 * name.get_fontsize() * len(name.get_text())
        tall = 0.6 * name.get_fontsize()
        taken.append((at[0] - half, at[0] + half, at[1] - tall, at[1] + tall))
    for n, location in zip(here, on_map(atlas.named_directions[here])):
        point = atlas.named[n]
        on_axis = point.level == AXES
        record = atlas.named_records[n]
        ax.plot(*location, marker="o" if on_axis else "*", markersize=5 if on_axis else 10,
                color=kind_colour(int(record["fate"]), int(record["spin_axis"])),
                markeredgecolor=style.BLACK, markeredgewidth=0.9,
                linestyle="none", clip_on=False, zorder=3)
        pole = on_axis and point.number >= 4  # its name stands left of it: thrusters have theirs on the right
        right = location[0] <= ACROSS * 0.75 and not pole
        label = _label(atlas, n, plain)
        at, wide = location * scale, 0.62 * size * len(label)
        for side, up in ((right, 3 if location[1] > -UP * 0.98 else -9), (right, -11), (not right, 3),
                         (not right, -11), (right, 14), (right, -22)):
            left = at[0] + (5 if side else -5 - wide)
            box = (left, left + wide, at[1] + up, at[1] + up + size)
            if not any(box[0] < b and a < box[1] and box[2] < d and c < box[3] for a, b, c, d in taken):
                break
        taken.append(box)
        ax.annotate(label, location, (5 if side else -5, up), textcoords="offset points", fontsize=size,
                    path_effects=halo, zorder=4,
                    ha="left" if side else "right", fontweight="normal" if on_axis else "bold")


def _label(atlas: Atlas, n: int, plain: bool) -> str:
    """The name of the n-th direction that has one; of an axis with its place among the moments, where there
    is room; of another with what the motion does there, which on a border no colour says."""
    point = atlas.named[n]
    if point.level != AXES:
        return f"{shown_name(atlas, point)}: {does(atlas, n).replace('-', '−')}"
    if plain:
        return shown_name(atlas, point)
    axes, number = axes_of(atlas.asked.case), point.number // 2 + 1
    return " ".join(filter(None,
                           [shown_name(atlas, point), axes.letters[number - 1] and axes.ranks[number - 1]]))


def _times(atlas: Atlas, units: Units) -> Any:
    """(scale of colours, unit of time) of the map of times; None without a limit."""
    if atlas.asked.stated_limit is None:
        return None
    from matplotlib.colors import LogNorm, Normalize
    resolved = _known(atlas)
    values = atlas.records["when_low"][resolved]
    low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 1.0)
    name, item = units.times(float(np.median(values)) if len(values) else high)
    scale = LogNorm if low > 0 and high > LOG * low else Normalize
    return scale(low * item, high * item if high > low else low * item + 1e-9), name, item


def _known(atlas: Atlas) -> np.ndarray:
    return np.isfinite(atlas.records["when_low"]) & np.isfinite(atlas.records["when_high"])


def colours(atlas: Atlas, kind: str, times: Any) -> np.ndarray:
    """(n, 3): red, green and blue of every cell, 0 to 1."""
    if kind != "when":
        from matplotlib.colors import to_rgb
        which, _, looks, _ = classes(atlas, kind)
        return np.array([to_rgb(look["facecolor"]) for look in looks])[which]
    spread, _, item = times
    resolved, low = _known(atlas), atlas.records["when_low"]
    out = np.where(np.isinf(low)[:, None], NEVER, UNKNOWN)
    out[resolved] = scale().reversed()(spread(low[resolved] * item))[:, :3]
    return out


# of values that are counted or have a word each
SAID = {"level": lambda v: f"the fate is {LEVELS[v]}" if v else "the fate is undecided",
        "equilibria": lambda v: COUNTS.get(v) or f"{v} equilibri{'um' if v == 1 else 'a'}",
        "island": lambda v: ("no island is suspected", "a bounded island may exist",
                             "a bounded island is seen")[v]}


def classes(atlas: Atlas, kind: str) -> tuple[np.ndarray, list[str], list[Any], list[str]]:
    """((n,) of which class each cell is; of each class its words, its look, and how a legend tells it)."""
    if kind == "fate":
        result, which = kinds(atlas), np.zeros(len(atlas.records), int)
        for n, (_, rows, _) in enumerate(result):
            which[rows] = n
        phrases = [kind_words(atlas, *key) for key, _, _ in result]
        looks = [{"facecolor": kind_colour(*key[:2]), "edgecolor": style.BLACK, "linewidth": 0.5,
                  "hatch": kind_hatch(*key)} for key, _, _ in result]
        return which, phrases, looks, [
            f"{word}: {100 * fraction:.3g} %" for word, (_, _, fraction) in zip(phrases, result)]
    present, which = np.unique(atlas.records[kind], return_inverse=True)
    phrases = [SAID[kind](int(value)) for value in present]
    looks = [{"facecolor": COUNTED[(int(value) if value >= 0 else n) % len(COUNTED)], "edgecolor": style.GREY}
             for n, value in enumerate(present)]
    return which.ravel(), phrases, looks, phrases


def _explained(figure: Any, axes: list[Any], atlas: Atlas, kind: str, times: Any, units: Units) -> None:
    """The legend of a column of maps, or its scale."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.ticker import LogLocator, NullFormatter
    if kind == "when":
        spread, name, _ = times
        bar = figure.colorbar(ScalarMappable(spread, scale().reversed()), ax=axes, location="bottom",
                              shrink=0.7, aspect=40, pad=0.02,
                              label=f"time to {limit_words(atlas, units)} ({name})")
        if spread.vmax > LOG * spread.vmin > 0:
            bar.ax.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        bar.ax.xaxis.set_major_formatter(lambda value, _: number(value))
        bar.ax.xaxis.set_minor_formatter(NullFormatter())
        resolved, low = _known(atlas), atlas.records["when_low"]
        printed = [(NEVER, "never", np.isinf(low)), (UNKNOWN, "time not known", ~resolved & ~np.isinf(low))]
        rows = [(phrase, {"facecolor": colour, "edgecolor": style.GREY})
                for colour, phrase, cells in printed if cells.any()]
    else:
        _, _, of, text = classes(atlas, kind)
        rows = [*zip(text, of), *(_single(atlas) if kind == "fate" else ())]
    if rows:
        axes[-1].legend(*style.explained(rows), loc="upper center", bbox_to_anchor=(0.5, 0.0),
                        ncols=min(2, len(rows)), borderaxespad=0.2)


def _single(atlas: Atlas) -> list[tuple[str, dict[str, Any]]]:
    """Rows of the fates that no cell has, but single directions: a motion may stay bounded exactly on an axis
    and nowhere beside it."""
    cells = set(atlas.records["fate"].tolist())
    return [(f"{kind_words(atlas, fate, 0)}: on single directions", POINT | {
        "markerfacecolor": kind_colour(fate, 0)})
        for fate in dict.fromkeys(atlas.named_records["fate"].tolist()) if fate not in cells]


# --- An atlas as one page that needs no network: the map or a globe, and what the pointer is on in words
POINT = {"marker": "o", "markersize": 5, "markeredgecolor": style.BLACK, "linestyle": "none"}
SHADES = 60  # colours of the map of times
TITLES = {"fate": "the fate", "when": "the time to the limit", "level": "how well the fate is known",
          "equilibria": "the number of equilibria",
          "island": "where bounded islands are suspected"}


def write_page(atlas: Atlas, path: Path, units: Units) -> Path:
    """Write the page; returns its path."""
    demand("jinja2", "matplotlib")
    of = atlas.asked
    momenta = [wheel_words(atlas, n) for n in range(len(of.momenta))]
    lead = f"Torque of {units.torque(float(of.torque), SHORT)} in every direction: {answer(atlas, units)}."
    return html.write(path, "atlas.html", title=of.case.title or of.case.name, lead=html.signed(lead),
                      momenta=momenta,
                      words=in_words(atlas, units), command=of.command, drawn=_drawn(atlas, units, momenta))


def _drawn(atlas: Atlas, units: Units, momenta: list[str]) -> dict[str, Any]:
    """All that the page's script needs."""
    frame = atlas.asked.case.frame
    tables = _tables(atlas, units)
    deepest = int(atlas.leaves.level.max())
    printed = _times_on_page(atlas, units)
    wheels = []
    for wheel in range(len(atlas.asked.wheels)):
        rows = np.flatnonzero(atlas.leaves.wheel == wheel)
        wheels.append({"begin": (atlas.leaves.begin[rows] >> 2 * (DEEPEST - deepest)).tolist(),
                       "depth": atlas.leaves.level[rows].tolist(),
                       "columns": {name: which[rows].tolist() for name, (which, _) in tables.items()},
                       "times": [printed[n] for n in rows] if printed else None})
    return {"deepest": deepest, "wheels": wheels,
            "kinds": {name: table | {"title": TITLES[name]} for name, (_, table) in tables.items()},
            "order": list(tables), "named": _named(atlas, units), "momenta": momenta,
            "axes": None if frame is None or frame.as_given
            else [[float(v) for v in row] for row in frame.axes]}


def _tables(atlas: Atlas, units: Units) -> dict[str, tuple[np.ndarray, dict[str, Any]]]:
    """name -> ((n,) which entry each cell has, the entries: words, colours, what the legend tells)."""
    printed = {}
    for kind in TITLES:
        if kind != "when":
            which, text, looks, legend = classes(atlas, kind)
            shades = [_bytes(look["facecolor"]) for look in looks]
            hatches = [look.get("hatch", "")[:1] for look in looks]
            printed[kind] = which, {"words": text, "colours": shades, "hatches": hatches,
                                    "legend": [list(row) for row in zip(legend, shades, hatches)]}
        elif atlas.asked.stated_limit is not None:
            printed[kind] = _shaded(atlas, units)
    return printed


def _shaded(atlas: Atlas, units: Units) -> tuple[np.ndarray, dict[str, Any]]:
    """Times in shades by their logarithm; what is never reached and what is not known beside them."""
    style.quiet_matplotlib()
    low, high = atlas.records["when_low"], atlas.records["when_high"]
    resolved = np.isfinite(low) & np.isfinite(high)
    heights = np.log(np.maximum(low[resolved], 1e-300))
    smallest, largest = (float(heights.min()), float(heights.max())) if len(heights) else (0.0, 0.0)
    step = (largest - smallest) / (SHADES - 1) or 1.0
    which = np.where(np.isinf(low), SHADES, SHADES + 1)
    which[resolved] = np.round((heights - smallest) / step).astype(int)
    colours = [*(_bytes(scale().reversed()(n / (SHADES - 1))) for n in range(SHADES)),
               _bytes(NEVER), _bytes(UNKNOWN)]
    name, item = units.times(float(np.exp(np.median(heights))) if len(heights) else 1.0)
    marks = _marks(np.exp(smallest) * item, np.exp(largest) * item) if len(heights) else []
    legend = [[f"{mark:g} {name}",
               colours[int(np.clip(round((np.log(mark / item) - smallest) / step), 0, SHADES - 1))]]
              for mark in marks]
    legend += [[text, colours[n]] for n,
               text in ((SHADES, "never"), (SHADES + 1, "not known")) if (which == n).any()]
    return which, {"words": [""] * len(colours), "colours": colours,
                   "legend": [[f"{limit_words(atlas, units)} in", None], *legend]}


def _marks(lower: float, upper: float) -> list[float]:
    """Round numbers between two, 1, 2 and 5 of each ten; nearer ones where there are fewer than three."""
    tens = (range(int(np.floor(np.log10(lower))) - 1, int(np.ceil(np.log10(upper))) + 1) if 0 < lower <= upper
            else ())
    within = [[item for item in (float(f"{part}e{ten}") for ten in tens for part in parts)
               if lower <= item <= upper]
              for parts in ((1, 2, 5), range(1, 10), np.arange(1, 10, 0.1).round(1).tolist())]
    chosen = next((marks for marks in within if len(marks) >= 3), within[-1]) or [float(f"{lower:.3g}")]
    return chosen[::max(1, -(-len(chosen) // 8))]


def _times_on_page(atlas: Atlas, units: Units) -> list[str]:
    """What is said of the time of each cell."""
    limit = atlas.asked.stated_limit
    if limit is None:
        return []
    name = limit_words(atlas, units)
    printed = []
    for low, high, level in zip(*(atlas.records[column].tolist()
                                  for column in ("when_low", "when_high", "when_level"))):
        if low == float("inf"):
            printed.append(f"never reaches {name}")
        elif high == high and high < float("inf"):
            printed.append(f"reaches {name} in {units.time(low)} ({LIMIT_LEVELS[level]})")
        else:
            printed.append(f"when {name} is reached is not known: not before {units.time(low, side=-1)}")
    return printed


def _named(atlas: Atlas, units: Units) -> list[dict[str, Any]]:
    rows = []
    for n, (point, direction) in enumerate(zip(atlas.named, atlas.named_directions.tolist())):
        record = atlas.named_records[n]
        phrases = [html.signed(does(atlas, n) + in_time(atlas, n, units)),
                 f"the fate is {LEVELS[record['level']]}",
                 f"islands: {ISLANDS[record['island']].replace('_', ' ')}"]
        rows.append({"name": printable(shown_name(atlas, point)), "axis": point.level == AXES,
                     "wheel": point.wheel, "direction": direction,
                     "words": phrases[:2] if not record["island"] else phrases})
    return rows


def _bytes(colour: Any) -> list[int]:
    if isinstance(colour, str):
        return [int(colour[n:n + 2], 16) for n in (1, 3, 5)]
    return [round(255 * float(part)) for part in colour[:3]]
