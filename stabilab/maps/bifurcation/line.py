"""The diagram over one number: critical values by elimination, the equilibria at each and at one value between neighbours."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from ...equilibrium.gyrostat import gyrostat_equilibria
from ...numbers.balls import settled
from ...physics.coefficients import effective
from .choice import chosen
from .critical import Cut, between, cuts
from .eliminated import Eliminated, Root, univariate
from .family import Family
from .result import ENDLESS, Diagram, Event, Piece, State
from .system import BORDERS, ISOLATED, LEAF, Conics, OnLine
from .told import told
from .verdicts import general_states, judged_state

WORDS = {"fold": "two {} meet and vanish", "pitchfork": "three {} meet in one", "crossing": "two branches of {} cross",
         "touch": "two {} that are there at this value alone", "infinity": "{} go to infinity"}


def diagram(family: Family, borders: bool = False) -> Diagram:
    """All equilibria over the one range of a family."""
    kind, what, system, notes = chosen(family, borders)
    span = family.spans[0]
    if system is None:
        return told(family, what)
    eliminated = Eliminated(family, system)
    found = cuts((univariate(c, 2) for c in eliminated.critical), span.low, span.high)
    pieces = _pieces(family, kind, eliminated, found)
    events: list[Event | None] = []
    for n, cut in enumerate(found):
        sides = [pieces[n] if cut.number.rational != span.low else None, pieces[n + 1] if cut.number.rational != span.high else None]
        events.append(_event(family, kind, eliminated, cut, sides))
    kept = [piece for piece in pieces if piece is not None]
    return Diagram(family, kind, what, *_joined(kept, events, found), notes=notes)


def _pieces(family: Family, kind: str, eliminated: Eliminated, found: Sequence[Cut]) -> list[Any]:
    """The pieces before, between and after the cuts; None where a cut stands at the end of the range."""
    span = family.spans[0]
    ends = [(span.low, span.low), *((cut.low, cut.high) for cut in found), (span.high, span.high)]
    values = [float(span.low), *(float(cut.number) for cut in found), float(span.high)]
    out = []
    for n, ((_, low), (high, _)) in enumerate(zip(ends, ends[1:])):
        if low >= high:
            out.append(None)
            continue
        sample = between(low, high)
        states = settled(partial(general_states, family, kind, eliminated, sample))
        out.append(Piece(values[n], values[n + 1], len(states), sample, states))
    return out


def _event(family: Family, kind: str, eliminated: Eliminated, cut: Cut, sides: Sequence[Piece | None]) -> Event | None:
    """What happens at a cut; None where nothing does."""
    system, number = eliminated.system, cut.number
    make = lambda kinds, count, states, words: Event(float(number), number.rational, _whole(number.polynomial), number.index, kinds, count, states, words)
    if number.reduced(univariate(system.special, 2)) == 0:
        return make(("axis",), *_on_an_axis(family, system, cut))
    roots = settled(lambda digits: [eliminated.at_algebraic(number, digits.bits)])[0]
    if roots is None:
        return make(("curve",), ENDLESS, (), "every point of a curve is an equilibrium")
    kinds = _kinds(eliminated, cut, roots, sides)
    if not kinds:
        return None
    states = settled(lambda digits: _states_at(family, kind, eliminated, cut, digits.bits, sides))
    things = "points" if kind == BORDERS else "equilibria"
    return make(kinds, len(roots), states, "; ".join(WORDS[word].format(things) for word in kinds))


def _kinds(eliminated: Eliminated, cut: Cut, roots: Sequence[Root], sides: Sequence[Piece | None]) -> tuple[str, ...]:
    counts = [piece.count for piece in sides if piece is not None]
    many = max((root.times for root in roots), default=1)
    kinds = []
    if many > 1:
        if many > 2:
            kinds.append("pitchfork")
        elif len(counts) == 1 or counts[0] != counts[-1]:
            kinds.append("fold")
        else:
            kinds.append("touch" if len(roots) > counts[0] else "crossing")
    elif any(count != len(roots) for count in counts):
        kinds.append("infinity")
    return tuple(kinds)


def _states_at(family: Family, kind: str, eliminated: Eliminated, cut: Cut, bits: int, sides: Sequence[Piece | None]) -> tuple[State, ...]:
    values = [cut.number.ball(bits)]
    roots = eliminated.at_algebraic(cut.number, bits) or []
    flat = kind == ISOLATED and any(root.times > 1 for root in roots) and eliminated.flat(cut.number)
    return tuple(judged_state(family, kind, values, root, _going_on(root, sides) if kind == LEAF else 0, flat) for root in roots)


def _going_on(root: Root, sides: Sequence[Piece | None]) -> int:
    """The sign of m on a branch that goes on through a meeting of an odd number: that of the side where one branch alone arrives."""
    alone = [piece for piece in sides if piece is not None and piece.count == 1]
    return 0 if not alone or root.times % 2 == 0 else 1 if alone[0].states[0].linear == "stable" else -1


def _on_an_axis(family: Family, system: OnLine | Conics, cut: Cut) -> tuple[int, tuple[State, ...], str]:
    """(count, states, words) where the torque of an isolated family falls on a principal axis."""
    value = cut.number.rational
    if value is None:
        load = cut.number.reduced(univariate(system.load, 2)) == 0
        return (ENDLESS, (), "the torque falls on a principal axis: a curve of equilibria") if load else \
            (0, (), "the torque falls on a principal axis that carries a wheel: no equilibrium")
    found = gyrostat_equilibria(effective(family.at((value,)).scene))
    states = tuple(State(point.at, 1, point.linear, point.verdict, point.because) for point in found.points)
    told = "no equilibrium" if found.kind == "none" else f"{', '.join(curve.name for curve in found.curves)}" if found.curves else ""
    return ENDLESS if found.curves or found.kind == "all" else len(states), states, f"{told}: {found.reason}" if told else found.reason


def _whole(polynomial) -> tuple[int, ...]:
    return tuple(int(c) for c in polynomial.numer().coeffs())


def _joined(pieces: list[Piece], events: list[Event | None], found: Sequence[Cut]) -> tuple[tuple[Piece, ...], tuple[Event, ...]]:
    """Pieces without the cuts at which nothing happens but that branches may change their order: their seams."""
    gone = {float(cut.number) for cut, event in zip(found, events) if event is None}
    out: list[Piece] = []
    for piece in pieces:
        if out and piece.low in gone and out[-1].high == piece.low:
            out[-1] = replace(out[-1], high=piece.high, seams=(*out[-1].seams, piece.low))
        else:
            out.append(piece)
    return tuple(out), tuple(event for event in events if event is not None)
