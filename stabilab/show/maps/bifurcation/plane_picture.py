"""A diagram over two numbers as a picture: the curves at which equilibria change, the number in each region,
cusps."""
from __future__ import annotations

from pathlib import Path
from typing import Any

from ....maps.bifurcation.family import ENDLESS
from ....maps.bifurcation.plane import Plane, rows
from ... import style
from ..shades import light, own_place

LOOKS = {"fold": "fold", "pitchfork": "crossing", "crossing": "crossing", "touch": "crossing",
         "infinity": "dividing", "axis": "separatrix",
         "curve": "separatrix"}
TOLD = {"fold": "fold", "pitchfork": "pitchfork", "crossing": "branches cross", "touch": "branches touch",
        "infinity": "an equilibrium at infinity",
        "axis": "torque on a principal axis", "curve": "curve of equilibria"}
FILLS = {0: "#FFFFFF", 1: light(style.YELLOW, 0.25), 2: light(style.SKY, 0.28), 3: light(style.PURPLE, 0.3),
         4: light(style.BLUE, 0.38),
         ENDLESS: light(style.GREY, 0.3)}
OTHER = light(style.ORANGE, 0.35)
SMALL = 0.004  # of the whole: regions below bear no number


def write(found: Plane, out: str | Path, size: tuple[float, float] | None = None,
          dpi: float | None = None) -> Path:
    """Draw the diagram and write the picture; returns its path."""
    return style.write(out, lambda plt: drawn(found, size, plt), dpi)


def drawn(found: Plane, size: tuple[float, float] | None, plt: Any) -> Any:
    """The figure."""
    first, second = found.family.spans
    figure, ax = plt.subplots(layout="constrained", figsize=size or (8, 6))
    bands = [band for strip in found.strips for band in _bands(found, strip) if band["p"]]
    for band in bands:
        ax.fill_between(band["p"], band["low"], band["high"], facecolor=FILLS.get(band["count"], OTHER),
                        linewidth=0, zorder=0)
    for strip in found.strips:
        values, arcs = rows(found, strip)
        for arc, row in zip(strip.arcs, arcs):
            ax.plot(values, row, label=TOLD[arc.kinds[0]], **style.MEANING[LOOKS[arc.kinds[0]]])
    for wall in found.walls:
        ax.plot([wall.value] * 2, [wall.low, wall.high], label=TOLD[wall.kinds[0]],
                **style.MEANING[LOOKS[wall.kinds[0]]])
    for cusp in found.cusps:
        ax.plot(*cusp.at, label="cusp", zorder=5, clip_on=False, **style.MARKER["degenerate"])
    if own := own_place(found.family.spans, found.family.data):
        ax.plot(*[[value] for value in own], label="the case itself", zorder=7, clip_on=False,
                **style.MARKER["start"] | {"markeredgecolor": "white"})
    whole = float((first.high - first.low) * (second.high - second.low))
    for region in _regions(bands, float(second.high - second.low)):
        if sum(band["area"] for band in region) > SMALL * whole:
            best = max(region, key=lambda band: band["area"])
            n = max(range(len(best["p"])),
                    key=lambda n: (best["high"][n] - best["low"][n])
                    * min(best["p"][n] - best["p"][0], best["p"][-1] - best["p"][n]))
            ax.text(best["p"][n], 0.5 * (best["low"][n] + best["high"][n]),
                    "curves" if best["count"] == ENDLESS else str(best["count"]), ha="center",
                    va="center", fontsize=13, fontweight="bold", zorder=6)
    ax.set_xlim(float(first.low), float(first.high))
    ax.set_ylim(float(second.low), float(second.high))
    for told, span in ((ax.set_xlabel, first), (ax.set_ylabel, second)):
        told(f"{span.label}{'' if span.shown_unit == '1' else f' ({span.shown_unit})'}")
    case = found.family.case
    shown = "changes of stability" if found.kind == "borders" else "number of equilibria"
    ax.set_title(f"{style.literal(case.title or case.name)}\n{shown}", loc="left", wrap=True)
    handles, words = ax.get_legend_handles_labels()
    kept = dict(zip(words, handles))
    if kept:
        figure.legend(kept.values(), kept.keys(), loc="outside lower center", ncols=4)
    return figure


def _bands(found: Plane, strip: Any) -> list[dict[str, Any]]:
    """The cells of a strip between neighbouring arcs, along it; a curve on an end of the range has no cell
    beyond it."""
    second = found.family.spans[1]
    values, arcs = rows(found, strip)
    ends = (float(second.low), float(second.high))
    inner = [row for row, event in zip(arcs, strip.line.events) if event.value not in ends]
    edges = [[ends[0]] * len(values), *inner, [ends[1]] * len(values)]
    out = []
    for low, high, piece in zip(edges, edges[1:], strip.line.pieces):
        area = sum(0.5 * (high[n] - low[n] + high[n + 1] - low[n + 1]) * (values[n + 1] - values[n])
                   for n in range(len(values) - 1))
        out.append({"p": values, "low": low, "high": high, "count": piece.count, "area": area})
    return out


def _regions(bands: list[dict[str, Any]], height: float) -> list[list[dict[str, Any]]]:
    """Cells that touch across the end of a strip and have one number, together."""
    groups: list[list[dict[str, Any]]] = [[band] for band in bands]
    for a in bands:
        for b in bands:
            meet = (a["p"] is not b["p"] and abs(a["p"][-1] - b["p"][0]) <= 1e-6
                    * (a["p"][-1] - a["p"][0] + b["p"][-1] - b["p"][0]))
            overlap = min(a["high"][-1], b["high"][0]) - max(a["low"][-1], b["low"][0])
            if meet and a["count"] == b["count"] and overlap > 1e-3 * height:
                one, other = (next(g for g in groups if any(band is x for x in g)) for band in (a, b))
                if one is not other:
                    one.extend(other)
                    groups.remove(other)
    return groups
