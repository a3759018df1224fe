"""Pictures of equilibria over one number, over two, and, on a circular orbit, over the wheels' momentum.

Above a panel over one number stands how many equilibria there are, and where that changes."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...answers.caveats import of_case
from ...answers.circular_orbit import CircularOrbit, followed
from ...case.read import Case
from ...equilibrium.circular_orbit import OrbitEquilibrium
from ...errors import InputError
from ...maps.bifurcation.diagram import Branch, branches
from ...maps.bifurcation.equations import BORDERS, CURVES, ENDLESS, Diagram
from ...maps.bifurcation.plane import Plane, Strip, Wall
from ...maps.bifurcation.plane import rows as arcs_of
from ...numbers.vectors import dot
from .. import style
from ..text import notes
from ..units import SHORT, Units, number, units_of, with_unit
from .shades import light, mark_own, own_values

if TYPE_CHECKING:
    from types import ModuleType

# of the values above the panel: points, rows at the most, inches of the figure beside the panel
SIZE, ROWS, MARGIN = 7.5, 3, 1.2
GLYPH = 0.64  # width of a digit of the house's font over the size of the font
GAP = 4.0  # points between two labels of a row


def counts_above(ax: Any, ends: tuple[float, float], pieces: Sequence[tuple[float, float, str]],
                 values: Sequence[float]) -> None:
    """How many there are in each piece (low, high, words), and the values between, above a panel whose axis
    goes from end to end."""
    full = ends[1] - ends[0]
    for low, high, text in pieces:
        if high - low > 0.03 * full:
            ax.annotate(text, (0.5 * (low + high), 1.0), xycoords=("data", "axes fraction"),
                        xytext=(0, 3), textcoords="offset points", ha="center", va="bottom", fontsize=9,
                        fontweight="bold")
    shown = sorted((value, f"{value + 0.0:.5g}") for value in values if value not in ends)
    wide = 72 * (ax.figure.get_figwidth() - MARGIN) / full
    places = [wide * (value - ends[0]) for value, _ in shown]
    for (value, printed), row in zip(shown, rows_apart(places, [told for _, told in shown], SIZE, ROWS)):
        if row is not None:
            ax.annotate(printed, (value, 1.0), xycoords=("data", "axes fraction"),
                        xytext=(0, 16 + 1.3 * SIZE * row), textcoords="offset points",
                        ha="center", va="bottom", fontsize=SIZE)


def rows_apart(places: Sequence[float], texts: Sequence[str], size: float, rows: int) -> list[int | None]:
    """The row (0 is the lowest) of each text, centred at a rising place and in a font of so many points, such
    that no two of a row meet.

    places: in points. None where no row has room.
    """
    ends = [-float("inf")] * rows
    out: list[int | None] = []
    for location, text in zip(places, texts):
        half = 0.5 * GLYPH * size * len(text)
        row = next((n for n, end in enumerate(ends) if location - half >= end + GAP), None)
        if row is not None:
            ends[row] = location + half
        out.append(row)
    return out


VERDICT_LABELS = {"stable": "stable (Lyapunov)", "unstable": "unstable",
         "undecided": "undecided by energy (gyroscopic)"}


def write_orbit(case: Case, result: CircularOrbit, out: str | Path, units: Units) -> Path:
    """Draw two angles of each equilibrium over the momentum: of the orbit normal to that momentum, and of the
    vertical to the body's minor axis. Raises InputError where there are no branches."""
    rows = followed(result)
    return style.write(out, lambda plt: _drawn(case, result, rows, units, plt))


def _drawn(case: Case, result: CircularOrbit, rows: Any, units: Units, plt: Any) -> Any:
    name, item = units.angles
    wheel, minor = _unit(result.momentum), min(range(3), key=lambda i: result.moments[i])
    panels: list[tuple[str, float, Callable[[OrbitEquilibrium], float]]] = [
        ("orbit normal to momentum", math.pi, lambda at: math.acos(_within(dot(at.normal, wheel)))),
        ("vertical to minor axis", math.pi / 2, lambda at: math.acos(_within(abs(at.vertical[minor]))))]
    figure, axes = plt.subplots(2, 1, sharex=True, layout="constrained", figsize=(8, 7))
    ends = 0.0, result.spans[-1].high  # type: ignore[index]
    for ax, (text, largest, angle) in zip(axes, panels):
        for branch in rows:
            ax.plot(branch.momenta, [angle(at) * item for at in branch.points],
                    **style.MEANING[branch.verdict])
        for span in result.spans:  # type: ignore[union-attr]
            ax.axvline(span.high, color=style.GREY, linewidth=0.7, linestyle=":", zorder=0)
        ax.set_ylim(-0.03 * largest * item, 1.03 * largest * item)
        ax.set_ylabel(f"{text} ({name})")
    axes[-1].set_xlim(*ends)
    own = [mark_own(ax, [math.hypot(*result.momentum)]) for ax in axes]
    axes[-1].set_xlabel("momentum of the wheels (N m s)")
    counts_above(axes[0], ends, [(span.low, span.high, str(span.count)) for span in result.spans],
                 [span.low for span in result.spans])
    rest = style.over(figure, case.title or case.name,
                      "in bold: the number of equilibria, two or more a line", left=True)
    kinds = dict.fromkeys(branch.verdict for branch in rows)
    style.legend(figure, {VERDICT_LABELS[kind]: style.MEANING[kind] for kind in kinds} | own[0],
                 notes=notes.below(figure, case, of_case(case), before=rest))
    return figure


def _within(cosine: float) -> float:
    return min(1.0, max(-1.0, cosine))


def _unit(vector: Any) -> tuple[float, ...]:
    return tuple(v / math.hypot(*vector) for v in vector)


CROWD = 6.0  # a component that goes to infinity is cut at so many times what nine tenths of the points reach
LOOKS = {"stable": ("stable", "stable"), "unstable": ("unstable", "unstable"),
         "border": ("fold", "stability changes"),
         "undecided": ("dividing", "undecided")}


def write(result: Diagram | Plane, out: str | Path, size: tuple[float, float] | None = None,
          dpi: float | None = None) -> Path:
    """Draw the diagram and write the picture; returns its path. Raises InputError where equilibria form
    curves for every value."""
    if isinstance(result, Diagram) and result.kind == CURVES:
        what = units_of(result.family.case).said(result.counted.alone)
        raise InputError(
            f"{result.family.case.place}: {what}: these are described in words, and there are no branches to "
            f"draw: leave out --out")
    return style.write(out, lambda plt: drawn(result, size, plt), dpi)


def drawn(result: Diagram | Plane, size: tuple[float, float] | None, plt: ModuleType) -> Any:
    """The figure."""
    figure, rest = _line(result, size, plt) if isinstance(result, Diagram) else _plane(result, size, plt)
    handles, text = figure.axes[0].get_legend_handles_labels()
    retained = dict(zip(text, handles))
    case = result.family.case
    style.below(figure, list(retained.values()), list(retained),
                notes=notes.below(figure, case, of_case(case), before=rest))
    return figure


def _line(out: Diagram, size: tuple[float, float] | None, plt: ModuleType) -> tuple[Any, list[str]]:
    """The figure over one number: a panel for each component that moves, branches stable or not, events
    marked; and the lines that its title has no room for."""
    rows = branches(out)
    moving = ([i for i in range(3) if any(abs(state[i]) > 0 for branch in rows for state in branch.states)]
              or [0])
    figure, axes = plt.subplots(len(moving), 1, sharex=True, squeeze=False, layout="constrained",
                                figsize=size or (8, 1.4 + 2.6 * len(moving)))
    units = units_of(out.family.case)
    for ax, i in zip(axes[:, 0], moving):
        _panel(ax, out, rows, i, units.rates[1])
        ax.set_ylabel(f"$x_{i + 1}$" if units.scaled else rf"$\omega_{i + 1}$ ({units.rates[0]})")
    span = out.family.spans[0]
    axes[-1, 0].set_xlabel(with_unit(span.label, span.shown_unit))
    counts_above(axes[0, 0], (float(span.low), float(span.high)),
                 [(piece.low, piece.high, str(piece.count) if piece.count >= 0 else "curves")
                  for piece in out.pieces], [event.value for event in (*out.events, *out.connections)])
    case = out.family.case
    counted = "changes of stability" if out.kind == BORDERS else "equilibria"
    return figure, style.over(figure, case.title or case.name, f"in bold: the number of {counted}", left=True)


def _panel(ax: Any, result: Diagram, rows: list[Branch], i: int, x: float) -> None:
    """The component i over the range; x: how many of the axis' unit make one of the case's variables."""
    for branch in rows:
        look, word = LOOKS[branch.verdict]
        ax.plot(branch.values, [state[i] * x for state in branch.states], label=word, **style.MEANING[look])
    for event in result.connections:
        ax.axvline(event.value, label="connection: two saddles at one height", zorder=1,
                   **style.MEANING["separatrix"] | {"linewidth": 1.2})
    for event in result.events:
        ax.axvline(event.value, color=style.GREY, linewidth=0.7, linestyle=":", zorder=0)
        met = [state.at[i] * x for state in event.states if state.times > 1]
        if met:
            word = "changes meet" if result.kind == BORDERS else " and ".join(event.kinds)
            ax.plot([event.value] * len(met), met, label=word, zorder=4, **style.MARKER["degenerate"])
    span = result.family.spans[0]
    ax.set_xlim(float(span.low), float(span.high))
    mark_own(ax, own_values(result.family.spans, result.family.data))
    heights = sorted(abs(state[i] * x) for branch in rows for state in branch.states)
    if heights and heights[-1] > CROWD * (usual := heights[int(0.9 * (len(heights) - 1))]) > 0:
        ax.set_ylim(-1.5 * usual, 1.5 * usual)


# --- Over two numbers

CURVE_LOOKS = {"fold": "fold", "pitchfork": "crossing", "crossing": "crossing", "touch": "crossing",
         "infinity": "dividing", "axis": "separatrix",
         "curve": "separatrix"}
TOLD = {"fold": "fold", "pitchfork": "pitchfork", "crossing": "branches cross", "touch": "branches touch",
        "infinity": "an equilibrium at infinity",
        "axis": "torque on a principal axis", "curve": "curve of equilibria"}
# number of equilibria -> its region: greys, as the numbers stand on them
FILLS = {0: "#FFFFFF", 1: light(style.BLACK, 0.07), 2: light(style.BLACK, 0.14), 3: light(style.BLACK, 0.21),
         4: light(style.BLACK, 0.28), ENDLESS: light(style.VIOLET, 0.25)}
OTHER = light(style.BLACK, 0.35)
SMALL = 0.004  # of the whole: regions below have their number beside them
ROOMY = 0.8  # of a figure: its axes, of which only about the place of a number beside a region is asked
AWAY, APART = (24.0, 40.0, 60.0), 14.0  # points: of such a number from its region; from others and the edges


def _plane(result: Plane, size: tuple[float, float] | None, plt: ModuleType) -> tuple[Any, list[str]]:
    """The figure over two numbers: the curves at which equilibria change, the number in each region, cusps;
    and the lines that its title has no room for."""
    first, second = result.family.spans
    figure, ax = plt.subplots(layout="constrained", figsize=size or (8, 6))
    bands = [band for strip in result.strips for band in _bands(result, strip) if band["p"]]
    for band in bands:
        ax.fill_between(band["p"], band["low"], band["high"], facecolor=FILLS.get(band["count"], OTHER),
                        edgecolor=FILLS.get(band["count"], OTHER), linewidth=0.5, zorder=0)
    for strip in result.strips:
        values, arcs = arcs_of(result, strip)
        for arc, row in zip(strip.arcs, arcs):
            ax.plot(values, row, label=TOLD[arc.kinds[0]], **style.MEANING[CURVE_LOOKS[arc.kinds[0]]])
    for wall in result.walls:
        ax.plot([wall.value] * 2, [wall.low, wall.high], label=TOLD[wall.kinds[0]],
                **style.MEANING[CURVE_LOOKS[wall.kinds[0]]])
    for cusp in result.cusps:
        ax.plot(*cusp.at, label="cusp", zorder=5, clip_on=False, **style.MARKER["degenerate"])
    ax.set_xlim(float(first.low), float(first.high))
    ax.set_ylim(float(second.low), float(second.high))
    left_out = numbered(ax, regions_of(bands, float(second.high - second.low), result.walls))
    mark_own(ax, own_values(result.family.spans, result.family.data))
    for printed, span in ((ax.set_xlabel, first), (ax.set_ylabel, second)):
        printed(with_unit(span.label, span.shown_unit))
    case = result.family.case
    shown = "changes of stability" if result.kind == "borders" else "number of equilibria"
    return figure, [*style.above(ax, case.title or case.name, shown), *left_out]


def numbered(ax: Any, regions: list[list[dict[str, Any]]]) -> list[str]:
    """Write the number into each region, beside a small one at the end of a line; a line on those that there
    is no room for."""
    (left, right), (below, above) = ax.get_xlim(), ax.get_ylim()
    small, bold = [], {"ha": "center", "va": "center", "fontweight": "bold", "zorder": 6}
    taken: list[tuple[float, float]] = []  # points
    for region in regions:
        best = max(region, key=lambda band: band["area"])
        p, low, high = best["p"], best["low"], best["high"]
        n = max(range(len(p)), key=lambda n: (high[n] - low[n]) * min(p[n] - p[0], p[-1] - p[n]))
        at = p[n], 0.5 * (low[n] + high[n])
        text = "curves" if best["count"] == ENDLESS else str(best["count"])
        area = sum(band["area"] for band in region)
        if area > SMALL * (right - left) * (above - below):
            ax.text(*at, text, fontsize=13, **bold)
            taken.append(_points(ax, at))
        elif area > 0:
            small.append((at, text))
    rest = []
    for at, text in small:
        x, y = _points(ax, at)
        ends = [(x + away * math.cos(turn), y + away * math.sin(turn)) for away in AWAY
                for turn in (math.pi * (0.25 + 0.25 * k) for k in range(8))]
        wide, tall = (ax.figure.get_figwidth() * 72 * ROOMY, ax.figure.get_figheight() * 72 * ROOMY)
        end = next((end for end in ends if APART < end[0] < wide - APART and APART < end[1] < tall - APART
                    and all(math.dist(end, other) > APART for other in taken)), None)
        if end is None:
            rest.append(f"{text} at ({number(at[0], SHORT)}, {number(at[1], SHORT)})")
            continue
        taken += [end, (x, y)]
        ax.annotate(text, at, (end[0] - x, end[1] - y), textcoords="offset points", fontsize=10, **bold,
                    bbox={"facecolor": "white", "edgecolor": style.GREY, "linewidth": 0.5, "pad": 1.5},
                    arrowprops={"arrowstyle": "-", "color": style.BLACK, "linewidth": 0.7, "shrinkA": 1,
                                "shrinkB": 0})
    return [f"too small for a number: {'; '.join(rest)}"] if rest else []


def _points(ax: Any, at: tuple[float, float]) -> tuple[float, float]:
    """About where a place is in axes that fill their figure, in points from their lower left corner."""
    (left, right), (below, above) = ax.get_xlim(), ax.get_ylim()
    width, height = ax.figure.get_figwidth() * 72 * ROOMY, ax.figure.get_figheight() * 72 * ROOMY
    return width * (at[0] - left) / (right - left), height * (at[1] - below) / (above - below)


def _bands(result: Plane, strip: Strip) -> list[dict[str, Any]]:
    """The cells of a strip between neighbouring arcs, along it; a curve on an end of the range has no cell
    beyond it."""
    second = result.family.spans[1]
    values, arcs = arcs_of(result, strip)
    ends = (float(second.low), float(second.high))
    inner = [row for row, event in zip(arcs, strip.line.events) if event.value not in ends]
    edges = [[ends[0]] * len(values), *inner, [ends[1]] * len(values)]
    out = []
    for low, high, piece in zip(edges, edges[1:], strip.line.pieces):
        area = sum(0.5 * (high[n] - low[n] + high[n + 1] - low[n + 1]) * (values[n + 1] - values[n])
                   for n in range(len(values) - 1))
        out.append({"p": values, "low": low, "high": high, "count": piece.count, "area": area})
    return out


def regions_of(bands: list[dict[str, Any]], height: float,
             walls: Sequence[Wall] = ()) -> list[list[dict[str, Any]]]:
    """Cells that touch across the end of a strip and have one number, together, where no curve along that end
    parts them."""
    groups: list[list[dict[str, Any]]] = [[band] for band in bands]
    for a in bands:
        for b in bands:
            meet = (a["p"] is not b["p"] and abs(a["p"][-1] - b["p"][0]) <= 1e-6
                    * (a["p"][-1] - a["p"][0] + b["p"][-1] - b["p"][0]))
            low, high = max(a["low"][-1], b["low"][0]), min(a["high"][-1], b["high"][0])
            overlap = high - low - (sum(max(0.0, min(high, wall.high) - max(low, wall.low)) for wall in walls
                                        if abs(wall.value - b["p"][0]) <= 1e-6 * (b["p"][-1] - b["p"][0]))
                                    if meet else 0.0)
            if meet and a["count"] == b["count"] and overlap > 1e-3 * height:
                item, other = (next(g for g in groups if any(band is x for x in g)) for band in (a, b))
                if item is not other:
                    item.extend(other)
                    groups.remove(other)
    return groups
