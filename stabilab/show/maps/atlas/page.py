"""An atlas as one page that needs no network: the map or a globe, and what the pointer is on in words."""
from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ....errors import printable
from ....maps.atlas.cells import DEEPEST
from ....maps.atlas.pointed import AXES
from ....maps.atlas.run import Atlas
from ....maps.columns import ISLANDS, LEVELS, LIMIT_LEVELS
from ....packages import demand
from ... import style
from ...report import html
from ...units import SHORT, Units
from ..words import COUNTS
from .labels import kind_colour, kind_words, kinds, shown_name, wheel_words
from .picture import COUNTED, NEVER, UNKNOWN
from .words import answer, does, in_time, limit_words
from .words import text as in_words

SHADES = 60  # colours of the map of times
TITLES = {"fate": "the fate", "when": "the time to the limit", "level": "how well the fate is known", "equilibria": "the number of equilibria",
          "island": "where bounded islands are suspected"}


def write(atlas: Atlas, path: Path, units: Units) -> Path:
    """Write the page; returns its path."""
    demand("jinja2", "matplotlib")
    of = atlas.asked
    momenta = [wheel_words(atlas, n) for n in range(len(of.momenta))]
    lead = f"Torque of {units.torque(float(of.torque), SHORT)} in every direction: {answer(atlas, units)}."
    return html.write(path, "atlas.html", title=of.case.title or of.case.name, lead=html.signed(lead), momenta=momenta,
                      words=in_words(atlas, units), command=of.command, drawn=_drawn(atlas, units, momenta))


def _drawn(atlas: Atlas, units: Units, momenta: list[str]) -> dict[str, Any]:
    """All that the page's script needs."""
    frame = atlas.asked.case.frame
    tables = _tables(atlas, units)
    deepest = int(atlas.leaves.level.max())
    told = _times(atlas, units)
    wheels = []
    for wheel in range(len(atlas.asked.wheels)):
        rows = np.flatnonzero(atlas.leaves.wheel == wheel)
        wheels.append({"begin": (atlas.leaves.begin[rows] >> 2 * (DEEPEST - deepest)).tolist(), "depth": atlas.leaves.level[rows].tolist(),
                       "columns": {name: which[rows].tolist() for name, (which, _) in tables.items()},
                       "times": [told[n] for n in rows] if told else None})
    return {"deepest": deepest, "wheels": wheels, "kinds": {name: table | {"title": TITLES[name]} for name, (_, table) in tables.items()},
            "order": list(tables), "named": _named(atlas, units), "momenta": momenta,
            "axes": None if frame is None or frame.as_given else [[float(v) for v in row] for row in frame.axes]}


def _tables(atlas: Atlas, units: Units) -> dict[str, tuple[np.ndarray, dict[str, Any]]]:
    """name -> ((n,) which entry each cell has, the entries: words, colours, what the legend tells)."""
    records = atlas.records
    fates, which = kinds(atlas), np.zeros(len(records), int)
    for n, (_, rows, _) in enumerate(fates):
        which[rows] = n
    words = [kind_words(atlas, *key) for key, _, _ in fates]
    colours = [_bytes(kind_colour(*key)) for key, _, _ in fates]
    told = {"fate": (which, {"words": words, "colours": colours, "legend": [[f"{word}: {100 * share:.3g} %", colour] for word, colour, (_, _, share)
                                                                               in zip(words, colours, fates)]})}
    if atlas.asked.stated_limit is not None:
        told["when"] = _shaded(atlas, units)
    told["level"] = _flags(records["level"], lambda v: f"the fate is {LEVELS[v]}" if v else "the fate is undecided")
    told["equilibria"] = _flags(records["equilibria"], lambda v: COUNTS.get(v) or f"{v} equilibri{'um' if v == 1 else 'a'}")
    told["island"] = _flags(records["island"], lambda v: ("no island is suspected", "a bounded island may exist", "a bounded island is seen")[v])
    return told


def _flags(values: np.ndarray, words: Any) -> tuple[np.ndarray, dict[str, Any]]:
    present, which = np.unique(values, return_inverse=True)
    told = [words(int(value)) for value in present]
    colours = [_bytes(COUNTED[(int(value) if value >= 0 else n) % len(COUNTED)]) for n, value in enumerate(present)]
    return which.ravel(), {"words": told, "colours": colours, "legend": [list(pair) for pair in zip(told, colours)]}


def _shaded(atlas: Atlas, units: Units) -> tuple[np.ndarray, dict[str, Any]]:
    """Times in shades by their logarithm; what is never reached and what is not known beside them."""
    style.quiet_matplotlib()
    import matplotlib
    low, high = atlas.records["when_low"], atlas.records["when_high"]
    known = np.isfinite(low) & np.isfinite(high)
    heights = np.log(np.maximum(low[known], 1e-300))
    least, most = (float(heights.min()), float(heights.max())) if len(heights) else (0.0, 0.0)
    step = (most - least) / (SHADES - 1) or 1.0
    which = np.where(np.isinf(low), SHADES, SHADES + 1)
    which[known] = np.round((heights - least) / step).astype(int)
    colours = [*(_bytes(matplotlib.colormaps["cividis_r"](n / (SHADES - 1))) for n in range(SHADES)), _bytes(NEVER), _bytes(UNKNOWN)]
    name, one = units.times(float(np.exp(np.median(heights))) if len(heights) else 1.0)
    marks = _marks(np.exp(least) * one, np.exp(most) * one) if len(heights) else []
    legend = [[f"{mark:g} {name}", colours[int(np.clip(round((np.log(mark / one) - least) / step), 0, SHADES - 1))]] for mark in marks]
    legend += [[words, colours[n]] for n, words in ((SHADES, "never"), (SHADES + 1, "not known")) if (which == n).any()]
    return which, {"words": [""] * len(colours), "colours": colours, "legend": [[f"{limit_words(atlas, units)} in", None], *legend]}


def _marks(least: float, most: float) -> list[float]:
    """Round numbers between two, 1, 2 and 5 of each ten; nearer ones where there are fewer than three."""
    tens = range(int(np.floor(np.log10(least))) - 1, int(np.ceil(np.log10(most))) + 1) if 0 < least <= most else ()
    within = [[one for one in (float(f"{part}e{ten}") for ten in tens for part in parts) if least <= one <= most]
              for parts in ((1, 2, 5), range(1, 10), np.arange(1, 10, 0.1).round(1).tolist())]
    chosen = next((marks for marks in within if len(marks) >= 3), within[-1]) or [float(f"{least:.3g}")]
    return chosen[::max(1, -(-len(chosen) // 8))]


def _times(atlas: Atlas, units: Units) -> list[str]:
    """What is said of the time of each cell."""
    limit = atlas.asked.stated_limit
    if limit is None:
        return []
    name = limit_words(atlas, units)
    told = []
    for low, high, level in zip(*(atlas.records[column].tolist() for column in ("when_low", "when_high", "when_level"))):
        if low == float("inf"):
            told.append(f"never reaches {name}")
        elif high == high and high < float("inf"):
            told.append(f"reaches {name} in {units.time(low)} ({LIMIT_LEVELS[level]})")
        else:
            told.append(f"when {name} is reached is not known: not before {units.time(low)}")
    return told


def _named(atlas: Atlas, units: Units) -> list[dict[str, Any]]:
    rows = []
    for n, (point, direction) in enumerate(zip(atlas.named, atlas.named_directions.tolist())):
        record = atlas.named_records[n]
        words = [html.signed(does(atlas, n) + in_time(atlas, n, units)), f"the fate is {LEVELS[record['level']]}",
                 f"islands: {ISLANDS[record['island']].replace('_', ' ')}"]
        rows.append({"name": printable(shown_name(atlas, point)), "axis": point.level == AXES, "wheel": point.wheel, "direction": direction,
                     "words": words[:2] if not record["island"] else words})
    return rows


def _bytes(colour: Any) -> list[int]:
    return [round(255 * float(part)) for part in colour[:3]]
