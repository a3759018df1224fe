"""A diagram of equilibria over one number or over two: the answer in a line, a table, JSON, CSV."""
from __future__ import annotations

from typing import Any

from ...answers.caveats import of_case
from ...errors import cell, key
from ...maps.axes import Span
from ...maps.bifurcation.diagram import branches
from ...maps.bifurcation.equations import BORDERS, CURVES, ENDLESS, Diagram, Event, Piece, State
from ...maps.bifurcation.plane import Plane, rows
from .. import frame, limiting, terminal
from ..data import as_json, csv_lines
from ..terminal import lettered, listed
from ..units import Units, units_of, with_unit

BIFURCATION_SCHEMA = "stabilab.bifurcation/1"
DIGITS = 10  # of a value, unless more are needed to tell two apart
NAMES = {"fold": "fold", "pitchfork": "pitchfork", "crossing": "crossing", "touch": "touch",
         "infinity": "gone to infinity", "axis": "on a principal axis",
         "connection": "connection", "curve": "curve of equilibria"}


def text(result: Diagram | Plane) -> str:
    """The answer first, then what is counted, notes, and a table: of pieces and events over one number, over
    two an example for each number of equilibria, and the cusps."""
    case, units = result.family.case, units_of(result.family.case)
    return limiting.ahead(of_case(case), "\n".join([
        f"{case.name}: {answer(result).replace('<=', '≤')}",
        *(f"  {units.said(item)}" for item in (result.counted, *result.remarks)),
        *limiting.lines(of_case(case), units),
        *(_table(result) if isinstance(result, Diagram) else _examples(result)), *frame.note(case)]))


def answer(result: Diagram | Plane) -> str:
    """The first line: "4 equilibria for 0 <= torque[3] < 0.82 N m, none above: fold at 0.8213 N m"; "0, 2 or
    4 equilibria over torque[3] and momentum[1]; curves: fold; 1 cusp at (..., ...)"."""
    return _of_line(result) if isinstance(result, Diagram) else _of_plane(result)


def csv(result: Diagram | Plane) -> str:
    """Over one number a line for each point of each branch, the events among them: value, piece, branch,
    state, verdict; over two one for each point of each curve, then the cusps. Caveats stand in every line, in
    one of their own where there is no other."""
    head, rows = _line_rows(result) if isinstance(result, Diagram) else _plane_rows(result)
    caveats = cell(of_case(result.family.case))
    rows = list(rows) or [[None] * len(head)] * bool(caveats)
    return csv_lines([[*head, "caveats"], *([*row, caveats] for row in rows)])


def json(out: Diagram | Plane) -> str:
    """Everything that is known: pieces and events each with their equilibria; curves as polynomials, strips
    with their cells, cusps."""
    case = out.family.case
    return as_json({"schema": BIFURCATION_SCHEMA, "case": case.name, "variables": case.variables,
                    "answer": answer(out),
                    "kind": out.kind, "what": out.what,
                    "reason": out.counted.as_dict(),
                    "axes": [_axis(span) for span in out.family.spans]}
                   | (_line_parts(out) if isinstance(out, Diagram) else _plane_parts(out))
                   | {"notes": list(out.notes)} | key(of_case(case)) | frame.key(case))


# --- Over one number


def _number(value: float, digits: int = DIGITS) -> str:
    """A value of what varies, with the digits that a reader compares."""
    return f"{value + 0.0:.{digits}g}"


def _digits(result: Diagram) -> int:
    """As many as tell all values of a diagram apart."""
    values = {value + 0.0 for piece in result.pieces for value in (piece.low, piece.high)}
    values |= {event.value + 0.0 for event in (*result.events, *result.connections)}
    return next((digits for digits in range(DIGITS, 17)
                 if len({_number(value, digits) for value in values}) == len(values)), 17)


def _things(result: Diagram, count: int) -> str:
    if count == ENDLESS:
        return "curves of equilibria"
    if result.kind == BORDERS:
        return "1 change of stability" if count == 1 else f"{count or 'no'} changes of stability"
    return f"{count or 'no'} equilibri{'a' if count > 1 else 'um'}"


def _of_line(result: Diagram) -> str:
    span, pieces = result.family.spans[0], result.pieces
    if len({piece.count for piece in pieces}) == 1:
        return _uniform(result, pieces[0].count)
    first = next((n for n, piece in enumerate(pieces) if piece.count), 0)
    parts = [
        f"{_things(result, pieces[first].count)} for {_range(result, pieces[first], span.label)}{unit(span)}"]
    for n, piece in enumerate(pieces):
        if n != first:
            where = ("above" if n == len(pieces) - 1 and n > 0 else "below" if n == 0
                     else f"for {_range(result, piece, span.label)}")
            parts.append(f"{piece.count or 'none'} {where}")
    printed = _events_told(result)
    return "; ".join([*parts, *([printed] if printed else [])])


def _uniform(result: Diagram, count: int) -> str:
    """The answer where the number is the same in all pieces."""
    span, digits = result.family.spans[0], _digits(result)
    printed = (f"{_things(result, count)} for {_number(float(span.low), digits)} <= {span.label} <= "
            f"{_number(float(span.high), digits)}{unit(span)}")
    other = [f"{_things(result, event.count)} at {_number(event.value, digits)}{unit(span)}"
             for event in result.events if event.count != count]
    events = "" if other and result.kind == CURVES else _events_told(result)
    return "; ".join(filter(None, [printed, other and f"but {listed(other)}", events]))


def unit(span: Span) -> str:
    """The unit after a number, with a blank before it; nothing where there is none."""
    return "" if span.shown_unit == "1" else f" {lettered(span.shown_unit)}"


def _range(result: Diagram, piece: Piece, name: str) -> str:
    at, digits = {event.value: event.count for event in result.events}, _digits(result)
    low, high = ("<=" if at.get(end, piece.count) == piece.count else "<" for end in (piece.low, piece.high))
    return f"{_number(piece.low, digits)} {low} {name} {high} {_number(piece.high, digits)}"


def _events_told(result: Diagram) -> str:
    by_kind: dict[str, list[str]] = {}
    digits, of = _digits(result), unit(result.family.spans[0])
    for event in (*result.events, *result.connections):
        by_kind.setdefault(event.kinds[0], []).append(_number(event.value, digits))
    names = NAMES | ({"curve": "other curves"} if result.kind == CURVES else {})
    alone = "infinity", "axis", "curve"
    return ", ".join(f"{names[kind]}{'s' * (len(values) > 1 and kind not in alone)} at {listed(values)}{of}"
                     for kind, values in by_kind.items())


def _table(result: Diagram) -> list[str]:
    span = result.family.spans[0]
    units, digits = units_of(result.family.case), _digits(result)
    name = with_unit(span.label, lettered(span.shown_unit))
    rows = [[name, "changes" if result.kind == BORDERS else "equilibria",
             *([] if result.kind == BORDERS else ["stable"]), "what"]]
    for _, item in _in_order(result):
        if isinstance(item, Piece):
            rows.append([f"{_number(item.low, digits)} to {_number(item.high, digits)}",
                         *_counts(result, item.count, item.states),
                         units.said(item.reason) if item.reason else ""])
        else:
            rows.append([f"at {_number(item.value, digits)}", *_counts(result, item.count, item.states),
                         units.said(item.reason) + _meeting(item, units)])
    wide = [max(len(row[n]) for row in rows) for n in range(len(rows[0]) - 1)]
    return [("  " + "  ".join(f"{cell:>{size}}" for cell, size in zip(row, wide)) + "  " + row[-1]).rstrip()
            for row in rows]


def _counts(result: Diagram, count: int, states: tuple[State, ...]) -> list[str]:
    printed = "curves" if count == ENDLESS else str(count)
    return ([printed] if result.kind == BORDERS
            else [printed, "" if count == ENDLESS else str(sum(s.verdict == "stable" for s in states))])


def _meeting(event: Event, units: Units) -> str:
    places = [units.vector(s.at, units.rates) for s in event.states if s.times > 1]
    return f", at {' and '.join(places)}" if places else ""


def _in_order(result: Diagram) -> list[tuple[float, Piece | Event]]:
    rows: list[tuple[float, int, Any]] = [(piece.low, 1, piece) for piece in result.pieces]
    rows += [(event.value, 0, event) for event in (*result.events, *result.connections)]
    rows.sort(key=lambda row: (row[0], row[1]))
    return [(value, item) for value, _, item in rows]


def _line_rows(result: Diagram) -> tuple[list[str], list[list[Any]]]:
    span, case = result.family.spans[0], result.family.case
    of = "rad/s" if case.variables == "physical" else "1"
    head = [with_unit(span.key.name, span.shown_unit), "piece", "branch",
            *(with_unit(name, of) for name in case.scene.components), "verdict", "event"]
    rows: list[list[Any]] = [[value, branch.piece + 1, branch.number + 1, *state, branch.verdict, None]
                             for branch in branches(result)
                             for value, state in zip(branch.values, branch.states)]
    for event in (*result.events, *result.connections):
        rows += [[event.value, None, None, *state.at, state.verdict,
                  event.kinds[0] if state.times > 1 else None] for state in event.states] or \
            [[event.value, None, None, None, None, None, None, event.kinds[0]]]
    return head, rows


def _line_parts(result: Diagram) -> dict[str, Any]:
    return {"pieces": [{"low": piece.low, "high": piece.high, "sample": str(piece.sample)}
                       | _states(piece.count, piece.states)
                       | ({"words": piece.words} if piece.words else {}) for piece in result.pieces],
            "events": [_event_row(event) for event in (*result.events, *result.connections)]}


def _axis(span: Span) -> dict[str, Any]:
    return {"key": span.key.name, "unit": span.shown_unit, "low": float(span.low), "high": float(span.high),
            "exact": [str(span.low), str(span.high)]}


def _event_row(event: Event) -> dict[str, Any]:
    """An event as an object; whole numbers beyond what other readers hold are strings."""
    return {"value": event.value, "exact": None if event.exact is None else str(event.exact),
            "kinds": list(event.kinds), "words": event.words, "reason": event.reason.as_dict(),
            "polynomial": [str(c) for c in event.polynomial],
            "root": event.index} | _states(event.count, event.states)


def _states(count: int, states: tuple[State, ...]) -> dict[str, Any]:
    return {"equilibria": None if count == ENDLESS else count, "curves": count == ENDLESS,
            "stable": sum(s.verdict == "stable" for s in states),
            "states": [{"at": list(s.at), "branches": s.times, "linear": s.linear, "verdict": s.verdict,
                        "because": s.because, "reason": s.reason.as_dict()} for s in states]}


# --- Over two numbers


def _of_plane(result: Plane) -> str:
    first, second = result.family.spans
    counts = sorted({piece.count for strip in result.strips for piece in strip.line.pieces})
    things = ("changes of stability" if result.kind == BORDERS else "equilibria" if counts != [1]
              else "equilibrium")
    some = listed(["no" if c == 0 and len(counts) == 1 else "curves of" if c == ENDLESS else str(c)
                   for c in counts], "or")
    printed = [f"{some} {things} over {first.label} and {second.label}"]
    kinds = sorted({kind for strip in result.strips for arc in strip.arcs for kind in arc.kinds}
                   | {kind for wall in result.walls for kind in wall.kinds})
    if kinds:
        printed.append("curves: " + ", ".join(NAMES[kind] for kind in kinds))
    if result.cusps:
        places = " and ".join(f"({_number(cusp.at[0])}, {_number(cusp.at[1])})" for cusp in result.cusps)
        printed.append(f"{'cusp' if len(result.cusps) == 1 else f'{len(result.cusps)} cusps'} at {places}")
    return "; ".join(printed)


def _examples(result: Plane) -> list[str]:
    """A row for each number of equilibria, where it has most room, and one for each cusp."""
    units, border = units_of(result.family.case), result.kind == BORDERS
    table = [["changes" if border else "equilibria", *([] if border else ["stable"]), "such as at",
              *(with_unit(span.label, span.shown_unit) for span in result.family.spans)]]
    largest: dict[int, tuple[float, float, Piece]] = {}
    for strip in result.strips:
        for piece in strip.line.pieces:
            size = (strip.high - strip.low) * (piece.high - piece.low)
            if size > largest.get(piece.count, (-1.0,))[0]:
                largest[piece.count] = (size, float(strip.sample), piece)
    for count, (_, p, piece) in sorted(largest.items()):
        stable = sum(state.verdict == "stable" for state in piece.states)
        table.append([str(count), *([] if border else [str(stable)]), "", _number(p),
                      _number(float(piece.sample))])
    for cusp in result.cusps:
        where = units.vector(cusp.state, units.rates) if cusp.state else "no one state"
        table.append(["cusp", *([] if border else [""]), where, _number(cusp.at[0]), _number(cusp.at[1])])
    return terminal.table(table)


def _plane_rows(result: Plane) -> tuple[list[str], list[list[Any]]]:
    """(kind, strip, arc, p, q) of points of all curves, of walls their two ends, and of cusps."""
    out: list[list[Any]] = []
    for n, strip in enumerate(result.strips):
        values, arcs = rows(result, strip)
        for k, (arc, row) in enumerate(zip(strip.arcs, arcs)):
            out += [[arc.kinds[0], n + 1, k + 1, p, q] for p, q in zip(values, row)]
    for k, wall in enumerate(result.walls):
        out += [[wall.kinds[0], 0, k + 1, wall.value, q] for q in (wall.low, wall.high)]
    names = [with_unit(span.key.name, span.shown_unit) for span in result.family.spans]
    return ["kind", "strip", "arc", *names], out + [["cusp", None, None, *cusp.at] for cusp in result.cusps]


def _plane_parts(result: Plane) -> dict[str, Any]:
    return {"curves": [[{"powers": [int(n) for n in powers[2:]], "coefficient": str(c)}
                        for powers, c in sorted(F.to_dict().items())] for F in result.curves],
            "strips": [{"low": strip.low, "high": strip.high, "sample": str(strip.sample),
                        "cells": [{"low": piece.low, "high": piece.high,
                                   "equilibria": None if piece.count == ENDLESS else piece.count,
                                   "stable": sum(s.verdict == "stable" for s in piece.states)}
                                  for piece in strip.line.pieces],
                        "arcs": [{"kinds": list(arc.kinds), "curve": arc.curve, "root": arc.root,
                                  "value": event.value}
                                 for arc, event in zip(strip.arcs, strip.line.events)]}
                       for strip in result.strips],
            "walls": [{"value": wall.value, "low": wall.low, "high": wall.high, "kinds": list(wall.kinds)}
                      for wall in result.walls],
            "cusps": [{"at": list(cusp.at), "state": list(cusp.state),
                       "polynomial": [str(c) for c in cusp.polynomial], "root": cusp.root}
                      for cusp in result.cusps]}
