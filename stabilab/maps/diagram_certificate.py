"""A certificate of a diagram over one number: the scene as polynomials in it, every value at which equilibria
change, and how many there are between.

What is claimed is checked by other algebra (`verify.diagram`): trace forms and Sturm's sequences, where the
diagram comes from resultants and balls.
"""
from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from ..errors import InputError
from ..numbers.algebraic import Algebraic, univariate
from ..numbers.balls import rational, settled
from ..version import __version__
from .bifurcation.equations import BORDERS, ISOLATED, LEAF, fixed_axis
from .bifurcation.family import CURVES, ENDLESS, Diagram, Event, Family, Piece

if TYPE_CHECKING:
    from flint import fmpq_poly

SCHEMA = "stabilab.diagram-certificate/1"
BITS = 128  # of the bounds about an irrational value
MOST = 64  # events that a certificate may hold


def certifiable(spans: Sequence[Any]) -> None:
    """Refuse ranges of which no certificate can be made, before any work."""
    if len(spans) > 1:
        raise InputError("--certify: a certificate is of a diagram over one number; over two, certify lines "
                         "of the plane one by one")


def diagram_certificate(found: Diagram) -> dict[str, Any]:
    """The object of `stabilab.diagram-certificate/1`. Raises InputError for a diagram of more events than it
    may hold."""
    if found.kind == CURVES:
        raise InputError(f"--certify: {found.what.partition(';')[0]}: stabilab classify --certify proves "
                         "them at one value")
    pieces, events = _changes(found)
    if len(events) > MOST:
        raise InputError(
            f"--certify: a certificate holds at most {MOST} events, this range has {len(events)}: divide it")
    family, span = found.family, found.family.spans[0]
    axis = fixed_axis(family)
    return {"schema": SCHEMA, "program": f"stabilab {__version__}",
            "number": span.key.name + (f" ({span.unit})" if span.unit else ""),
            "scene": _scene(family), "counted": found.kind,
            "axis": 0 if found.kind == ISOLATED or axis is None else axis + 1,
            "start": _start(family) if found.kind == LEAF else None, "range": [str(span.low), str(span.high)],
            "pieces": [{"equilibria": _count(piece.count), "stable": _stable(found, piece)}
                       for piece in pieces],
            "events": [{"t": _bounds(event), "equilibria": _count(event.count)} for event in events],
            "uncertified": [f"{len(found.connections)} connections: the heights of saddles hold an angle and "
                            "are isolated by balls alone"]
            if found.connections else []}


def _changes(found: Diagram) -> tuple[list[Piece], list[Event]]:
    """Pieces and events without those events at which the number stays what it is on both sides."""
    pieces, events = [found.pieces[0]], []
    rest = list(found.pieces[1:])
    low = found.family.spans[0].low
    if found.events and found.events[0].exact == low:
        events.append(found.events[0])
    for event in found.events[len(events):]:
        after = rest.pop(0) if rest else None
        if after is not None and pieces[-1].count == event.count == after.count:
            continue
        if after is None and pieces[-1].count == event.count:
            continue
        events.append(event)
        if after is not None:
            pieces.append(after)
    if events and events[0].exact == low and events[0].count == pieces[0].count:
        del events[0]
    return pieces, events


def _count(count: int) -> int | None:
    return None if count == ENDLESS else count


def _stable(found: Diagram, piece: Piece) -> int | None:
    return (None if found.kind == BORDERS or piece.count == ENDLESS
            else sum(state.verdict == "stable" for state in piece.states))


def _bounds(event: Event) -> list[str]:
    """Rational numbers about an event's value, which an exact one is itself."""
    from flint import fmpq_poly
    if event.exact is not None:
        return [str(event.exact)] * 2
    number = Algebraic(fmpq_poly(list(event.polynomial)), event.index)
    ball = settled(lambda digits: number.ball(max(BITS, digits.bits)))
    return [str(end.fmpq()) for end in (ball.lower(), ball.upper())]


def _scene(family: Family) -> dict[str, Any]:
    n = family.numbers
    if family.scaled:  # of the pencil: u1 = a + b, lam1 = (b - a)/2
        half = univariate(n["u"][0], 2) / 2
        lean = univariate(n["lam"][0], 2)
        return {"variables": "scaled", "a": [_written(half - lean)], "b": [_written(half + lean)],
                "mu": [_written(univariate(c, 2)) for c in n["M"]]}
    return {"variables": "physical"} | {name: [_written(univariate(c, 2)) for c in n[key]] for name, key in
                                        (("inertia", "D"), ("momentum", "lam"), ("torque", "M"))}


def _start(family: Family) -> list[list[str]]:
    """The state in the case's variables, x = (y - u)/A."""
    n = family.numbers
    scales = (2, 1, -1) if family.scaled else (1, 1, 1)
    return [_written((univariate(y, 2) - univariate(u, 2)) / rational(Fraction(a)))
            for y, u, a in zip(n["y"], n["u"], scales)]


def _written(f: fmpq_poly) -> list[str]:
    return [str(c) for c in f.coeffs()] or ["0"]
