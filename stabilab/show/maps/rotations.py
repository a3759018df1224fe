"""The rotations of a free body over the speed of a wheel: the answer in a line, a table, JSON, CSV, a
picture."""
from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Any

from ...answers.caveats import of_case
from ...errors import cell, key
from ...maps.bifurcation.rotations import RotationDiagram, RotationPiece, sampled
from .. import frame, limiting, style
from ..data import as_json, csv_lines
from ..text import notes
from ..text.motion import in_file
from ..units import SHORT, Units, number, units_of, with_unit
from .bifurcation_picture import counts_above

DIGITS = 10  # of a value
HEADS = {"minimum": "least energy", "saddle": "saddles", "maximum": "most energy",
         "inflection": "inflections"}
# of one colour with saddles
DOTS: dict[str, dict[str, Any]] = {"maximum": {"marker": "^", "markersize": 2.5, "markevery": 2}}
LOOKS = {"minimum": style.MEANING["stable"], "saddle": style.MEANING["unstable"],
         "maximum": style.MEANING["unstable"] | {"linestyle": "-."}, "inflection": style.MEANING["undecided"]}


def text(result: RotationDiagram) -> str:
    """The answer first, then a table of pieces and values, and why these are all; with its caveats."""
    case, units = result.case, units_of(result.case)
    return limiting.ahead(of_case(case), "\n".join([
        f"{case.name}: {answer(result)}", *limiting.lines(of_case(case), units), *_table(result, units),
        f"why: {units.said(result.reason)}", *frame.note(case)]))


def answer(result: RotationDiagram) -> str:
    """The first line: "rotations that attract: 2 for speed < 310.4 rpm, 1 above"; at one rate "attracts for
    300 < speed < 500 rpm"."""
    label, unit = result.span.label, result.span.shown_unit
    unit = "" if unit == "1" else f" {unit}"
    if result.rate is not None:
        where = " and ".join(f"{_value(piece.low)} < {label} < {_value(piece.high)}{unit}"
                             for piece in result.pieces if piece.stable)
        return f"attracts for {where}" if where else "attracts nowhere in the range"
    groups: list[tuple[int, float]] = []
    for piece in result.pieces:
        if groups and groups[-1][0] == piece.stable:
            groups.pop()
        groups.append((piece.stable, piece.high))
    (count, end), *others = groups
    if not others:
        return f"rotations that attract: {count} all over the range"
    parts = [f"{count} for {label} < {_value(end)}{unit}",
             *(f"{count} up to {_value(end)}" for count, end in others[:-1]), f"{others[-1][0]} above"]
    return f"rotations that attract: {', '.join(parts)}"


def _value(value: Fraction | float) -> str:
    return f"{float(value) + 0.0:.{DIGITS}g}"


def _table(result: RotationDiagram, units: Units) -> list[str]:
    name = with_unit(result.span.label, result.span.shown_unit)
    kinds = [kind for kind in HEADS if any(kind in piece.natures for piece in result.pieces)]
    spans = [f"{_value(piece.low)} to {_value(piece.high)}" for piece in result.pieces]
    rows: list[tuple[str, ...]]
    if result.rate is not None:
        rows = [(name, "energy", "with losses", "without")]
        rows += [(span, HEADS[piece.rotations[0].nature].rstrip("s"), piece.rotations[0].with_losses,
                  piece.rotations[0].without_losses) for span, piece in zip(spans, result.pieces)]
    else:
        rows = [(name, *(HEADS[kind] for kind in kinds))]
        rows += [(span, *(str(piece.natures.get(kind, 0)) for kind in kinds))
                 for span, piece in zip(spans, result.pieces)]
    widths = [max(map(len, column)) for column in zip(*rows)]
    lines = ["  " + "  ".join(f"{cell:>{width}}" for cell, width in zip(row, widths)) for row in rows]
    if result.rate is None:
        lines += [f"  at {_value(piece.value)}, what attracts: {_attracting(result, piece, units)}"
                  for piece in result.pieces]
    return lines


def _attracting(result: RotationDiagram, piece: RotationPiece, units: Units) -> str:
    rows = [units.vector(in_file(result.case, item.rates), units.rates, SHORT) for item in piece.rotations
            if item.with_losses == "stable"]
    return ", ".join(rows)


def json(result: RotationDiagram) -> str:
    """Everything that is known, in SI units but for the values, which are in the unit of the range."""
    case = result.case
    return as_json({
        "schema": "stabilab.rotations_over/1", "case": case.name, "answer": answer(result),
        "momentum": result.momentum, "rate": result.rate,
        "axis": {"key": result.span.key.name, "unit": result.span.shown_unit, "low": float(result.span.low),
                 "high": float(result.span.high)},
        "changes": [float(value) for value in result.changes],
        "pieces": [{"low": piece.low, "high": piece.high, "natures": piece.natures, "value": piece.value,
                    "rotations": [{"nature": item.nature, "rates": in_file(case, item.rates),
                                   "energy": item.energy, "with_losses": item.with_losses,
                                   "without_losses": item.without_losses, "circle_about": item.axis or None,
                                   "growth_time": item.growth, "decay_time": item.decay}
                                  for item in piece.rotations]} for piece in result.pieces],
        "because": result.because, "reason": result.reason.as_dict()} | key(of_case(case)) | frame.key(case))


def csv(result: RotationDiagram) -> str:
    """A line for each rotation at values over the range, those of the table's pieces in it."""
    caveats = cell(of_case(result.case))
    head = ["value", "nature", "with_losses", "without_losses", "energy", "omega1", "omega2", "omega3",
            "caveats"]
    return csv_lines([head, *([value, item.nature, item.with_losses, item.without_losses, item.energy,
                               *in_file(result.case, item.rates), caveats]
                              for value, rows in sampled(result) for item in rows)])


def write(result: RotationDiagram, out: str | Path) -> Path:
    """Draw the energies of all rotations over what varies."""
    return style.write(out, lambda plt: _drawn(result, plt))


def _drawn(result: RotationDiagram, plt: Any) -> Any:
    figure, ax = plt.subplots(layout="constrained", figsize=(8, 5))
    points: dict[str, tuple[list[float], list[float]]] = {}
    for value, rows in sampled(result):
        for item in rows:
            x, y = points.setdefault(item.nature, ([], []))
            x.append(value)
            y.append(item.energy)
    dots = {"linestyle": "none", "marker": ".", "markersize": 3}
    looks = {nature: LOOKS[nature] | dots | DOTS.get(nature, {}) for nature in points}
    for nature, (x, y) in points.items():
        ax.plot(x, y, **looks[nature])
    for change in result.changes:
        ax.axvline(float(change), color=style.GREY, linewidth=0.7, linestyle=":", zorder=0)
    ends = float(result.span.low), float(result.span.high)
    ax.set_xlim(*ends)
    ax.set_xlabel(with_unit(result.span.label, result.span.shown_unit))
    ax.set_ylabel("energy (J)")
    counts_above(ax, ends, [(piece.low, piece.high, str(piece.stable)) for piece in result.pieces],
                 [float(value) for value in result.changes])
    held = (f"|H| = {number(result.momentum or 0.0, 6)} N m s" if result.rate is None
            else f"{units_of(result.case).rate(result.rate, 6)} about the wheels' axis")
    rest = style.over(figure, result.case.title or result.case.name,
                      f"{held}; in bold: how many attract with losses", left=True)
    style.legend(figure, [(HEADS[nature], looks[nature]) for nature in HEADS if nature in points],
                 notes=notes.below(figure, result.case, of_case(result.case), before=rest))
    return figure
