"""A diagram over one number as a picture: a panel for each component that moves, branches stable or not,
events marked."""
from __future__ import annotations

from pathlib import Path
from typing import Any

from ....errors import InputError
from ....maps.bifurcation.diagram import Branch, branches
from ....maps.bifurcation.equations import BORDERS
from ....maps.bifurcation.family import CURVES, Diagram
from ... import style
from ...axes import axes_of
from ...units import units_of
from ..shades import own_place
from .labels import rows_apart
from .words import unit

CROWD = 6.0  # a component that goes to infinity is cut at so many times what nine tenths of the points reach
# of the values above the panel: points, rows at the most, inches of the figure beside the panel
SIZE, ROWS, MARGIN = 7.5, 3, 1.2
OWN = {"color": style.BLACK, "linewidth": 1.0, "linestyle": (0, (1, 2))}
LOOKS = {"stable": ("stable", "stable"), "unstable": ("unstable", "unstable"),
         "border": ("fold", "stability changes"),
         "undecided": ("dividing", "undecided")}


def write(found: Diagram, out: str | Path, size: tuple[float, float] | None = None,
          dpi: float | None = None) -> Path:
    """Draw the diagram and write the picture; returns its path. Raises InputError where equilibria form
    curves for every value."""
    if found.kind == CURVES:
        what = axes_of(found.family.case).sentence(found.what).partition(";")[0]
        raise InputError(
            f"{found.family.case.place}: {what}: these are described in words, and there are no branches to "
            f"draw: leave out --out")
    return style.write(out, lambda plt: drawn(found, size, plt), dpi)


def drawn(found: Diagram, size: tuple[float, float] | None, plt: Any) -> Any:
    """The figure."""
    rows = branches(found)
    moving = ([i for i in range(3) if any(abs(state[i]) > 0 for branch in rows for state in branch.states)]
              or [0])
    figure, axes = plt.subplots(len(moving), 1, sharex=True, squeeze=False, layout="constrained",
                                figsize=size or (8, 1.4 + 2.6 * len(moving)))
    units = units_of(found.family.case)
    for ax, i in zip(axes[:, 0], moving):
        _panel(ax, found, rows, i, units.rates[1])
        ax.set_ylabel(f"$x_{i + 1}$" if units.scaled else rf"$\omega_{i + 1}$ ({units.rates[0]})")
    span = found.family.spans[0]
    axes[-1, 0].set_xlabel(f"{span.label}{f' ({span.shown_unit})' if unit(span) else ''}")
    _counts(axes[0, 0], found)
    case = found.family.case
    counted = "changes of stability" if found.kind == BORDERS else "equilibria"
    figure.suptitle(f"{style.literal(case.title or case.name)}\nin bold: the number of {counted}", x=0.02,
                    ha="left", fontsize=10.5, wrap=True)
    handles, words = axes[0, 0].get_legend_handles_labels()
    kept = dict(zip(words, handles))
    if kept:
        figure.legend(kept.values(), kept.keys(), loc="outside lower center", ncols=5)
    return figure


def _panel(ax: Any, found: Diagram, rows: list[Branch], i: int, one: float) -> None:
    """The component i over the range; one: how many of the axis' unit make one of the case's variables."""
    for branch in rows:
        look, word = LOOKS[branch.verdict]
        ax.plot(branch.values, [state[i] * one for state in branch.states], label=word, **style.MEANING[look])
    for event in found.connections:
        ax.axvline(event.value, label="connection: two saddles at one height", zorder=1,
                   **style.MEANING["separatrix"] | {"linewidth": 1.2})
    for event in found.events:
        ax.axvline(event.value, color=style.GREY, linewidth=0.7, linestyle=":", zorder=0)
        met = [state.at[i] * one for state in event.states if state.times > 1]
        if met:
            word = "changes meet" if found.kind == BORDERS else " and ".join(event.kinds)
            ax.plot([event.value] * len(met), met, label=word, zorder=4, **style.MARKER["degenerate"])
    span = found.family.spans[0]
    for own in own_place(found.family.spans, found.family.data) or ():
        ax.axvline(own, label="the case itself", zorder=3, **OWN)
    ax.set_xlim(float(span.low), float(span.high))
    heights = sorted(abs(state[i] * one) for branch in rows for state in branch.states)
    if heights and heights[-1] > CROWD * (usual := heights[int(0.9 * (len(heights) - 1))]) > 0:
        ax.set_ylim(-1.5 * usual, 1.5 * usual)


def _counts(ax: Any, found: Diagram) -> None:
    """How many there are in each piece, and the values between, above the first panel."""
    span = found.family.spans[0]
    whole = float(span.high) - float(span.low)
    for piece in found.pieces:
        if piece.high - piece.low > 0.03 * whole:
            ax.annotate(str(piece.count) if piece.count >= 0 else "curves",
                        (0.5 * (piece.low + piece.high), 1.0), xycoords=("data", "axes fraction"),
                        xytext=(0, 3), textcoords="offset points", ha="center", va="bottom", fontsize=9,
                        fontweight="bold")
    shown = sorted((event.value, f"{event.value + 0.0:.5g}") for event in (*found.events, *found.connections)
                   if event.value not in (float(span.low), float(span.high)))
    wide = 72 * (ax.figure.get_figwidth() - MARGIN) / whole
    places = [wide * (value - float(span.low)) for value, _ in shown]
    for (value, told), row in zip(shown, rows_apart(places, [told for _, told in shown], SIZE, ROWS)):
        if row is not None:
            ax.annotate(told, (value, 1.0), xycoords=("data", "axes fraction"),
                        xytext=(0, 16 + 1.3 * SIZE * row), textcoords="offset points",
                        ha="center", va="bottom", fontsize=SIZE)


__all__ = ["drawn", "write"]
