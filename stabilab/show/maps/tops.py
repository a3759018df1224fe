"""The steady motions of a top over its spin: the answer in a line, a table, JSON, CSV, a picture."""
from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ...answers.caveats import of_case
from ...errors import cell, key
from ...maps.bifurcation.tops import HANGING, UPRIGHT, TopDiagram, TopPiece, TopState, sampled
from .. import frame, limiting, style
from ..data import as_json, csv_lines
from ..text import notes
from ..units import SHORT, Units, number, units_of, with_unit
from .bifurcation_picture import counts_above

DIGITS = 8  # of a value
STABLE, UNSTABLE = "stable", "unstable"
HEADS = (UPRIGHT, HANGING, "leaning, stable", "leaning, unstable")


def text(result: TopDiagram) -> str:
    """The answer first, then a table of pieces, the leaning states in each, and why these are all."""
    case, units = result.case, units_of(result.case)
    return limiting.ahead(of_case(case), "\n".join([
        f"{case.name}: {answer(result)}", *limiting.lines(of_case(case), units), *_table(result),
        *(line for piece in result.pieces if (line := _leaning(result, piece, units))),
        f"why: {units.said(result.reason)}", *frame.note(case)]))


def answer(result: TopDiagram) -> str:
    """The first line: "upright stable for spin from 16.7777 to 40 rev/s"."""
    label, unit = result.span.label, result.span.shown_unit
    unit = "" if unit == "1" else f" {unit}"
    joined: list[list[float]] = []
    for piece in result.pieces:
        if piece.stable(UPRIGHT):
            if joined and joined[-1][1] == piece.low:
                joined[-1][1] = piece.high
            else:
                joined.append([piece.low, piece.high])
    where = " and ".join(f"from {_value(low)} to {_value(high)}" for low, high in joined)
    return f"upright stable for {label} {where}{unit}" if where else "upright stable nowhere in the range"


def _value(value: float) -> str:
    return number(value + 0.0, DIGITS)


def _word(stable: bool) -> str:
    return STABLE if stable else UNSTABLE


def _leans(piece: TopPiece, stable: bool) -> list[TopState]:
    return [state for state in piece.states if state.leaning and state.stable == stable]


def _table(result: TopDiagram) -> list[str]:
    rows: list[Sequence[str]] = [(with_unit(result.span.label, result.span.shown_unit), *HEADS)]
    for piece in result.pieces:
        counts = (str(len(_leans(piece, stable))) for stable in (True, False))
        rows.append((f"{_value(piece.low)} to {_value(piece.high)}", _word(piece.stable(UPRIGHT)),
                     _word(piece.stable(HANGING)), *counts))
    widths = [max(map(len, column)) for column in zip(*rows)]
    return ["  " + "  ".join(f"{item:>{width}}" for item, width in zip(row, widths)) for row in rows]


def _leaning(result: TopDiagram, piece: TopPiece, units: Units) -> str:
    """What leans in the middle of a piece, and how fast it precesses; empty where nothing does."""
    parts = [f"{_word(state.stable)} at {units.angle(state.lean, SHORT)}, precessing at "
             f"{units.rate(state.rate, SHORT)}" for state in piece.states if state.leaning]
    return f"  at {_value(piece.value)}: {'; '.join(parts)}" if parts else ""


def json(result: TopDiagram) -> str:
    """Everything that is known, in SI units but for the values, which are in the unit of the range."""
    case, span = result.case, result.span
    return as_json({
        "schema": "stabilab.top_over/1", "case": case.name, "answer": answer(result),
        "axis": {"key": span.key.name, "unit": span.shown_unit, "low": float(span.low),
                 "high": float(span.high)},
        "changes": [float(value) for value in result.changes],
        "pieces": [{"low": piece.low, "high": piece.high, "value": piece.value,
                    "upright": _word(piece.stable(UPRIGHT)), "hanging": _word(piece.stable(HANGING)),
                    "states": [{"family": state.family, "lean": state.lean, "rate": state.rate,
                                "verdict": _word(state.stable)} for state in piece.states]}
                   for piece in result.pieces],
        "because": result.because, "reason": result.reason.as_dict()} | key(of_case(case)) | frame.key(case))


def csv(result: TopDiagram) -> str:
    """A line for each state at values over the range: lean in rad, rate of precession in rad/s."""
    caveats = cell(of_case(result.case))
    rows: list[list[float | str]] = [
        [value, state.family, _word(state.stable), state.lean, state.rate, caveats]
        for value, states in sampled(result) for state in states]
    return csv_lines([["value", "family", "verdict", "lean", "rate", "caveats"], *rows])


def write(result: TopDiagram, out: str | Path) -> Path:
    """Draw the leans of all steady motions over what varies."""
    return style.write(out, lambda plt: _drawn(result, plt))


def _drawn(result: TopDiagram, plt: Any) -> Any:
    figure, ax = plt.subplots(layout="constrained", figsize=(8, 5))
    lines: dict[tuple[str, int, bool], tuple[list[float], list[float]]] = {}
    for value, states in sampled(result):
        counted: dict[str, int] = {}
        for state in states:
            n = counted[state.family] = counted.get(state.family, -1) + 1
            x, y = lines.setdefault((state.family, n, state.stable), ([], []))
            x.append(value)
            y.append(math.degrees(state.lean))
    gap = 2 * float(result.span.high - result.span.low) / 100
    for (_, _, stable), (x, y) in lines.items():
        ax.plot(*_broken(x, y, gap), **style.MEANING[_word(stable)])
    for change in result.changes:
        ax.axvline(float(change), color=style.GREY, linewidth=0.7, linestyle=":", zorder=0)
    ends = float(result.span.low), float(result.span.high)
    ax.set_xlim(*ends)
    ax.set_ylim(-6, 186)
    ax.set_yticks(range(0, 181, 30))
    ax.set_xlabel(with_unit(result.span.label, result.span.shown_unit))
    ax.set_ylabel("lean of the axis from the upward vertical (deg)")
    counts_above(ax, ends, [(piece.low, piece.high, _word(piece.stable(UPRIGHT))) for piece in result.pieces],
                 [float(value) for value in result.changes])
    rest = style.over(figure, result.case.title or result.case.name, "steady motions at the area integral of "
                      "the upright or the hanging top; in bold: upright", left=True)
    shown = [word for word in (STABLE, UNSTABLE) if any(_word(stable) == word for _, _, stable in lines)]
    style.legend(figure, [(word, style.MEANING[word]) for word in shown],
                 notes=notes.below(figure, result.case, of_case(result.case), before=rest))
    return figure


def _broken(x: list[float], y: list[float], gap: float) -> tuple[list[float], list[float]]:
    """The points of a line, with a hole where the next one is farther than a step of the values."""
    xs, ys = [], []
    for n, (a, b) in enumerate(zip(x, y)):
        if n and a - x[n - 1] > gap:
            xs.append(math.nan)
            ys.append(math.nan)
        xs.append(a)
        ys.append(b)
    return xs, ys
