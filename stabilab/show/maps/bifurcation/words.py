"""A diagram over one number: the answer in a line, a table of pieces and events, JSON, CSV."""
from __future__ import annotations

from typing import Any

from ....caveat import cell, key
from ....maps.axes import Span
from ....maps.bifurcation.diagram import branches
from ....maps.bifurcation.equations import BORDERS
from ....maps.bifurcation.family import CURVES, ENDLESS, Diagram, Event, Piece, State
from ... import limiting
from ...files import comma
from ...terminal.letters import greek
from ...text import frame
from ...text.answers import as_json
from ...units import Units, units_of

SCHEMA = "stabilab.bifurcation/1"
DIGITS = 10  # of a value, unless more are needed to tell two apart
NAMES = {"fold": "fold", "pitchfork": "pitchfork", "crossing": "crossing", "touch": "touch",
         "infinity": "gone to infinity", "axis": "on a principal axis",
         "connection": "connection", "curve": "curve of equilibria"}


def text(found: Diagram) -> str:
    """The answer first, then what is counted, the table, notes."""
    units = units_of(found.family.case)
    lines = [f"{found.family.case.name}: {answer(found).replace('<=', '≤')}",
             f"  {units.axes.sentence(found.what)}"]
    lines += ([f"  {units.axes.sentence(note)}" for note in found.notes]
              + limiting.lines(found.family.case.caveats, units))
    return "\n".join([*lines, *_table(found), *frame.note(found.family.case)])


def number(value: float, digits: int = DIGITS) -> str:
    """A value of what varies, with the digits that a reader compares."""
    return f"{value + 0.0:.{digits}g}"


def _digits(found: Diagram) -> int:
    """As many as tell all values of a diagram apart."""
    values = {value + 0.0 for piece in found.pieces for value in (piece.low, piece.high)}
    values |= {event.value + 0.0 for event in (*found.events, *found.connections)}
    return next((digits for digits in range(DIGITS, 17)
                 if len({number(value, digits) for value in values}) == len(values)), 17)


def _things(found: Diagram, count: int) -> str:
    if count == ENDLESS:
        return "curves of equilibria"
    if found.kind == BORDERS:
        return "1 change of stability" if count == 1 else f"{count or 'no'} changes of stability"
    return f"{count or 'no'} equilibri{'a' if count > 1 else 'um'}"


def answer(found: Diagram) -> str:
    """"4 equilibria for 0 <= torque[3] < 0.82 N m, none above: fold at 0.8213 N m"."""
    span, pieces = found.family.spans[0], found.pieces
    if len({piece.count for piece in pieces}) == 1:
        return _uniform(found, pieces[0].count)
    first = next((n for n, piece in enumerate(pieces) if piece.count), 0)
    parts = [
        f"{_things(found, pieces[first].count)} for {_range(found, pieces[first], span.label)}{unit(span)}"]
    for n, piece in enumerate(pieces):
        if n != first:
            where = ("above" if n == len(pieces) - 1 and n > 0 else "below" if n == 0
                     else f"for {_range(found, piece, span.label)}")
            parts.append(f"{piece.count or 'none'} {where}")
    told = _events_told(found)
    return ", ".join(parts) + (f": {told}" if told else "")


def _uniform(found: Diagram, count: int) -> str:
    """The answer where the number is the same in all pieces."""
    span, digits = found.family.spans[0], _digits(found)
    told = (
        f"{_things(found, count)} for {number(float(span.low), digits)} <= {span.label} <= "
        f"{number(float(span.high), digits)}{unit(span)}")
    other = [f"{_things(found, event.count)} at {number(event.value, digits)}{unit(span)}"
             for event in found.events if event.count != count]
    events = "" if other and found.kind == CURVES else _events_told(found)
    return told + (f", but {_and(other)}" if other else "") + (f": {events}" if events else "")


def unit(span: Span) -> str:
    """The unit after a number, with a blank before it; nothing where there is none."""
    return "" if span.shown_unit == "1" else f" {span.shown_unit}"


def _range(found: Diagram, piece: Piece, name: str) -> str:
    at, digits = {event.value: event.count for event in found.events}, _digits(found)
    low, high = ("<=" if at.get(end, piece.count) == piece.count else "<" for end in (piece.low, piece.high))
    return f"{number(piece.low, digits)} {low} {name} {high} {number(piece.high, digits)}"


def _events_told(found: Diagram) -> str:
    by_kind: dict[str, list[str]] = {}
    digits, of = _digits(found), unit(found.family.spans[0])
    for event in (*found.events, *found.connections):
        by_kind.setdefault(event.kinds[0], []).append(number(event.value, digits))
    names = NAMES | ({"curve": "other curves"} if found.kind == CURVES else {})
    alone = "infinity", "axis", "curve"
    return ", ".join(f"{names[kind]}{'s' * (len(values) > 1 and kind not in alone)} at {_and(values)}{of}"
                     for kind, values in by_kind.items())


def _and(values: list[str]) -> str:
    return values[0] if len(values) == 1 else f"{', '.join(values[:-1])} and {values[-1]}"


def _table(found: Diagram) -> list[str]:
    span = found.family.spans[0]
    units, digits = units_of(found.family.case), _digits(found)
    name = span.label + ("" if span.shown_unit == "1" else f" ({greek(span.shown_unit)})")
    rows = [[name, "changes" if found.kind == BORDERS else "equilibria",
             *([] if found.kind == BORDERS else ["stable"]), "what"]]
    for _, one in _in_order(found):
        if isinstance(one, Piece):
            rows.append([f"{number(one.low, digits)} to {number(one.high, digits)}",
                         *_counts(found, one.count, one.states), units.axes.sentence(one.words)])
        else:
            rows.append([f"at {number(one.value, digits)}", *_counts(found, one.count, one.states),
                         units.axes.sentence(one.words) + _meeting(one, units)])
    wide = [max(len(row[n]) for row in rows) for n in range(len(rows[0]) - 1)]
    return [("  " + "  ".join(f"{cell:>{size}}" for cell, size in zip(row, wide)) + "  " + row[-1]).rstrip()
            for row in rows]


def _counts(found: Diagram, count: int, states: tuple[State, ...]) -> list[str]:
    told = "curves" if count == ENDLESS else str(count)
    return ([told] if found.kind == BORDERS
            else [told, "" if count == ENDLESS else str(sum(s.verdict == "stable" for s in states))])


def _meeting(event: Event, units: Units) -> str:
    places = [units.vector(s.at, units.rates) for s in event.states if s.times > 1]
    return f", at {' and '.join(places)}" if places else ""


def _in_order(found: Diagram) -> list[tuple[float, Piece | Event]]:
    rows: list[tuple[float, int, Any]] = [(piece.low, 1, piece) for piece in found.pieces]
    rows += [(event.value, 0, event) for event in (*found.events, *found.connections)]
    rows.sort(key=lambda row: (row[0], row[1]))
    return [(value, one) for value, _, one in rows]


def csv(found: Diagram) -> str:
    """A line for each point of each branch, the events among them: value, piece, branch, state, verdict."""
    span, case = found.family.spans[0], found.family.case
    of = "rad/s" if case.variables == "physical" else ""
    head = [span.key.name + ("" if span.shown_unit == "1" else f" ({span.shown_unit})"), "piece", "branch",
            *(f"{name} ({of})" if of else name for name in case.scene.components), "verdict", "event",
            "caveats"]
    rows: list[list[Any]] = [[value, branch.piece + 1, branch.number + 1, *state, branch.verdict, None]
                             for branch in branches(found) for value,
                             state in zip(branch.values, branch.states)]
    for event in (*found.events, *found.connections):
        rows += [[event.value, None, None, *state.at, state.verdict,
                  event.kinds[0] if state.times > 1 else None] for state in event.states] or \
            [[event.value, None, None, None, None, None, None, event.kinds[0]]]
    return comma.lines([head, *([*row, cell(case.caveats)] for row in rows)])


def json(found: Diagram) -> str:
    """Everything that is known, pieces and events each with their equilibria."""
    case = found.family.case
    return as_json({"schema": SCHEMA, "case": case.name, "variables": case.variables, "answer": answer(found),
                    "kind": found.kind, "what": found.what,
                    "axes": [axis(span) for span in found.family.spans],
                    "pieces": [{"low": piece.low, "high": piece.high, "sample": str(piece.sample)}
                               | _states(piece.count, piece.states)
                               | ({"words": piece.words} if piece.words else {})
                               for piece in found.pieces],
                    "events": [event_row(event) for event in (*found.events, *found.connections)],
                    "notes": list(found.notes)
                    } | key(case.caveats) | frame.key(case))


def axis(span: Span) -> dict[str, Any]:
    """A range as an object."""
    return {"key": span.key.name, "unit": span.shown_unit, "low": float(span.low), "high": float(span.high),
            "exact": [str(span.low), str(span.high)]}


def event_row(event: Event) -> dict[str, Any]:
    """An event as an object; whole numbers beyond what other readers hold are strings."""
    return {"value": event.value, "exact": None if event.exact is None else str(event.exact),
            "kinds": list(event.kinds), "words": event.words,
            "polynomial": [str(c) for c in event.polynomial],
            "root": event.index} | _states(event.count, event.states)


def _states(count: int, states: tuple[State, ...]) -> dict[str, Any]:
    return {"equilibria": None if count == ENDLESS else count, "curves": count == ENDLESS,
            "stable": sum(s.verdict == "stable" for s in states),
            "states": [{"at": list(s.at), "branches": s.times, "linear": s.linear, "verdict": s.verdict,
                        "because": s.because} for s in states]}
