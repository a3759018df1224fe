"""How axes and answers of a map are named and coloured."""
from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...answers.caveats import CONDITIONS, HOLDS, NO_SUCH_BODY, UNSTABLE_POINT, of_case, stated
from ...answers.motions.of_case import law_of
from ...case.lines import KeyLines
from ...case.table import Faults, Table
from ...errors import Caveat, Kind, without
from ...maps.axes import Key, Span, value_at
from ...maps.blocks import blocks, counted
from ...maps.columns import ENERGY, NO_CASE, PACE, RATE, TIME, Column
from ...maps.plan import Plan
from ...numbers.units import unit_of
from ...orbit.result import OUTCOMES
from ...reasons import Sentence
from .. import style
from ..units import with_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ...case.read import Case

OF_POINTS = Sentence("of-points", "({count} of {points} points)")
LIMIT_UNSEEN = Sentence("limit-not-looked-at", "the limit of the file, {limit}, is not looked at here")
LAW_OF_THE_CASE = Sentence("law-of-the-case-alone",
                           "laws are not judged at every point; of the case as it stands: {law}")


# --- What the dimensions and columns of a sweep are called, and their units
SAMPLE = "sample"
LETTERS = {"angular_velocity": "ω", "mu": "μ"}  # of keys that have one
DRAWN = ("ω", "μ", "x")  # those that have an index


def names(keys: Sequence[str]) -> list[str]:
    """A short name for each key, in letters, digits and underscores: its last word, or as many of its words
    as tell it from the others."""
    def plain(text: Sequence[str]) -> str:
        letters = (letter if letter.isascii() and letter.isalnum() else " " for letter in " ".join(text))
        name = "_".join("".join(letters).split()) or "key"
        return name if name[0].isalpha() else f"key_{name}"
    return (_told_apart([key.split(".") for key in keys], plain, {SAMPLE, "axis"})
            or [plain([f"{key}_{n}"]) for n, key in enumerate(keys, 1)])


def said(keys: Sequence[str]) -> list[str]:
    """The keys as people read them beside each other: torque[3], ω[1]; as few of their last words as tell
    each from the others."""
    parts = [[LETTERS.get(stem, stem) + bracket + index
              for stem, bracket, index in (word.partition("[") for word in key.split("."))] for key in keys]
    return _told_apart(parts, ".".join) or list(keys)


def _told_apart(parts: Sequence[Sequence[str]], name: Callable[[Sequence[str]], str],
                taken: Collection[str] = ()) -> list[str]:
    """Names of as few of the last words of each as tell it from the others, none of them taken; none where
    there are no such names."""
    for text in range(1, max(map(len, parts), default=0) + 1):
        rows = [name(part[-text:]) for part in parts]
        if len({*rows, *taken}) == len(rows) + len(taken):
            return rows
    return []


def drawn(name: str) -> str:
    """The same on an axis of a picture: a letter with its index set as in formulas, ω[1] as ω with 1 below
    it; other keys as they are."""
    letter, _, index = name.partition("[")
    return f"${letter}_{index[0]}$" if letter in DRAWN and index in ("1]", "2]", "3]") else name


def dimensions(plan: Plan) -> list[str]:
    """The names of the dimensions, in the user's order."""
    return names([axis.key.name for axis in plan.axes]) + ([SAMPLE] if plan.sampled else [])


def unit(plan: Plan, column: Column) -> str:
    """The unit of a column; "1" where it has none."""
    return ({RATE: "rad/s", ENERGY: "J", TIME: "s", PACE: "1/s"}.get(column.unit, "1")
            if plan.case.variables == "physical" else "1")


def of_every_point(case: Case, records: np.ndarray) -> list[Caveat]:
    """What limits the answer of every point of a map alike."""
    return [*without(of_case(case), Kind.UNPHYSICAL), *_of_the_case(case, records)]  # that is of a point


def limits_of(case: Case, records: np.ndarray) -> list[Caveat]:
    """What limits the answers of a map: what the file says itself, on what its points rest, a limit that was
    not looked at."""
    rows = [*of_case(case)]
    counts: Counter[int] = Counter()
    unphysical = unstable = points = 0
    for number, count in (counted(blocks(records["caveats"])).items()
                          if "caveats" in records.dtype.names else ()):
        full, condition = divmod(number, len(CONDITIONS))
        counts[condition] += count
        unphysical += count * (full % 2)
        unstable += count * (full >= 2)
        points += count
    parts = [(Kind.TILT, HOLDS(condition=CONDITIONS[n]), count) for n, count in sorted(counts.items()) if n]
    if all(item.kind is not Kind.UNPHYSICAL for item in rows):
        parts += [(Kind.UNPHYSICAL, NO_SUCH_BODY, unphysical)]
    parts += [(Kind.UNSTABLE, UNSTABLE_POINT, unstable)]
    for kind, reason, count in parts:
        part = None if count == points else OF_POINTS(count=count, points=points)
        rows += [Caveat(kind, reason.then(part, " "))] if count else []
    return [*rows, *_of_the_case(case, records)]


def _of_the_case(case: Case, records: np.ndarray) -> list[Caveat]:
    """That the limit of the case was not looked at, where it has one and no times are asked; and how far an
    approximate law holds of the case as it stands, as that is not judged at every point."""
    rows, law = [], law_of(case)
    if case.limits is not None and "when_low" not in records.dtype.names:
        rows.append(Caveat(Kind.LIMIT, LIMIT_UNSEEN(limit=stated(case.limits))))
    return [*rows, *([] if law is None else [Caveat(Kind.LAW, LAW_OF_THE_CASE(law=law.reason))])]


# --- How fates and axes of a sweep look: colours by meaning, labels with units, straight or logarithmic
# scales
# fate -> (its name in a legend, the colour of its areas)
FATES = {fate: (outcome.legend, style.FILL[outcome.word]) for fate, outcome in OUTCOMES.items()} | {
    NO_CASE: ("no case", style.FILL["no case"])}
FLAGS = ("fate", "level", "reason", "chaos")  # columns of words
LIGHT = 0.45  # of a colour that fills an area
LETTERED = 0.05  # of a map: half the side of the least square that has room for a letter


def light(colour: str, fraction: float = LIGHT) -> tuple[float, float, float]:
    """The colour on white."""
    red, green, blue = (1 - fraction * (1 - int(colour[i:i + 2], 16) / 255) for i in (1, 3, 5))
    return red, green, blue


def scale() -> Any:
    """The colours of numbers on a map, from the least to the greatest: a hue that no outcome has."""
    from matplotlib.colors import LinearSegmentedColormap
    return LinearSegmentedColormap.from_list("numbers", style.SCALE)


def spinning(axis: int) -> str:
    """The colour of an area of spin-up, the lighter one against its axis; `hatched` says which axis."""
    return style.AGAINST if axis < 0 else style.FILL["spin-up"]


def look_of(axis: int) -> dict[str, Any]:
    """A legend's patch for an area of spin-up: its colour, and the hatch of its axis."""
    return {"facecolor": spinning(axis), "edgecolor": style.BLACK, "hatch": style.HATCH[abs(axis)],
            "linewidth": 0.5}


def hatched(ax: Axes, x: np.ndarray, y: np.ndarray, labels: np.ndarray,
            rows: Mapping[int, tuple[str, str]]) -> None:
    """Hatch the areas of a map, and write the name of each into the middle of its largest piece. labels:
    (m, n) of the points at y (m,) and x (n,); rows: a label -> (its hatch, its name; each may be empty)."""
    from matplotlib.patheffects import withStroke
    for label, (hatch, name) in rows.items():
        here = labels == label
        if not here.any():
            continue
        if hatch:
            ax.contourf(x, y, here.astype(float), levels=[0.5, 1.5], colors="none", hatches=[hatch])
        row, column, depth = _deepest(here)
        if name and depth > LETTERED * min(here.shape):
            ax.text(x[column], y[row], name, ha="center", va="center", fontsize=10 * style.share(), zorder=3,
                    fontweight="bold", path_effects=[withStroke(linewidth=3.5, foreground="white")])


def _deepest(here: np.ndarray) -> tuple[int, int, int]:
    """Row and column of the middle of the largest square of true points, and half its side."""
    sides = np.pad(here.astype(int), ((1, 0), (1, 0)))
    for row in range(1, sides.shape[0]):
        above = sides[row - 1]
        line = sides[row]
        for column in np.flatnonzero(line).tolist():
            line[column] = 1 + min(line[column - 1], above[column], above[column - 1])
    lowest, last = divmod(int(sides.argmax()), sides.shape[1])
    half = int(sides[lowest, last]) // 2
    return lowest - 1 - half, last - 1 - half, half


def label(data: Any, name: str) -> str:
    """The name of a dimension or column with its unit; of a dimension as few of its last words as tell it
    from the others of the sweep."""
    attrs = data[name].attrs
    text = drawn(spoken_key(data, name)) if name in data.dims else str(attrs.get("long_name", name))
    return with_unit(text, attrs.get("units", "1"))


def spoken_key(data: Any, name: str) -> str:
    """The key of a dimension, as short as the other keys of the sweep allow."""
    keys = {coord: str(data[coord].attrs["long_name"]) for coord in data.coords if coord != SAMPLE
            and "long_name" in data[coord].attrs}
    return dict(zip(keys, said(list(keys.values())))).get(name, name)


def short_label(data: Any, name: str) -> str:
    """The same for a narrow place: a column by its own name."""
    return with_unit(name.replace("_", " "), data[name].attrs.get("units", "1"))


def is_log(values: np.ndarray) -> bool:
    """Whether values are spread in equal ratios rather than in equal steps."""
    if len(values) < 3 or not (values > 0).all():
        return False
    ratios, steps = values[1:] / values[:-1], np.diff(values)
    return bool(np.ptp(ratios) < 1e-6 * abs(ratios[0]) and np.ptp(steps) > 1e-6 * abs(steps).max())


def furnish(ax: Any, data: Any, across: str, up: str | None = None) -> None:
    """Labels of the axes along dimensions, and logarithmic scales where the values are."""
    ax.set_xlabel(label(data, across))
    if is_log(np.asarray(data[across])):
        ax.set_xscale("log")
    if up is not None:
        ax.set_ylabel(label(data, up))
        if is_log(np.asarray(data[up])):
            ax.set_yscale("log")


ITSELF = "the case itself"
OWN = {"color": style.BLACK, "linewidth": 1.0, "linestyle": (0, (1, 2))}


def mark_own(ax: Axes, at: Sequence[float | None]) -> dict[str, Any]:
    """Mark the case itself, at one value by an upright line, at two by a point, where it is within the limits
    of the axes; the row of the legend."""
    for value, limits in zip(at, (ax.get_xlim(), ax.get_ylim())):
        if value is None or not min(limits) <= value <= max(limits):
            return {}
    look: dict[str, Any] = OWN if len(at) == 1 else style.MARKER["start"] | {"markeredgecolor": "white"}
    if len(at) == 1:
        ax.axvline(at[0], zorder=3, label=ITSELF, **look)
    else:
        ax.plot(*[[value] for value in at], zorder=7, clip_on=False, label=ITSELF, **look)
    return {ITSELF: look}


def own_value(plan: Plan, dimension: int) -> float | None:
    """The value that the case itself has along a dimension, in the unit of the axis."""
    axis = plan.axes[dimension]
    return value_in(plan.data, axis.key, axis.unit)


def value_in(data: Mapping[str, dict[str, Any]], key: Key, unit: str) -> float | None:
    """The value that a case file's data have of a key, in a unit; None where they have none."""
    path = key.paths[0]
    table = Table(path[:-1], {path[-1]: value_at(data, path)}, Faults(KeyLines()))
    exact = table.number(path[-1])
    return None if exact is None else float(exact / unit_of(unit).size) if unit else float(exact)


def own_values(spans: Sequence[Span], data: Mapping[str, dict[str, Any]]) -> list[float | None]:
    """The same along ranges of the numbers of a case file with such data."""
    return [value_in(data, span.key, span.unit) for span in spans]


def looks(data: Any, kind: str) -> dict[int, tuple[str, str]]:
    """value -> (its word, the colour of its areas) of a column of flags: fates have colours of their own,
    others those of a list, as they occur."""
    if kind == "fate":
        return {int(value): FATES[value] for value in sorted(FATES)}
    text = str(data[kind].attrs["flag_meanings"]).split()
    present = np.unique(np.asarray(data[kind])).tolist()
    return {value: (text[value].replace("_", " ") if value >= 0 else "not known",
                    style.FILL["undecided"] if value < 0 else style.LISTED[n % len(style.LISTED)])
            for n, value in enumerate(present)}


def flag_legend(data: Any, kind: str) -> dict[str, dict[str, Any]]:
    """Words -> look of every flag of a column that occurs."""
    values = np.asarray(data[kind])
    return {text: {"facecolor": colour, "edgecolor": style.GREY}
            for value, (text, colour) in looks(data, kind).items() if (values == value).any()}
