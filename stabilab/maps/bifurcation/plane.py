"""The diagram over two numbers: curves in their plane at which equilibria change, the number between them, and cusps.

The plane is cut into strips: at the ends of a strip a curve turns back, two meet, or one leaves the range (roots of discriminants and resultants of the
curves' polynomials), inside it all curves run side by side. So one value inside a strip, with its diagram over the second number, tells the strip.
"""
from __future__ import annotations

import copy
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING, Any

from ...errors import InputError
from ...numbers.balls import Unclear, rational, real_roots_of, settled
from ...shown import Shown
from ..keys import put
from .choice import chosen
from .critical import Cut, between, cuts
from .cusps import Cusp, cusps
from .eliminated import Eliminated, at_rational, of_power, univariate
from .family import Family
from .line import diagram
from .result import Diagram, Event

if TYPE_CHECKING:
    from flint import fmpq_mpoly

MOST = 200  # strips


@dataclass(frozen=True)
class Arc:
    """A curve inside a strip. kinds: of its events; curve: which polynomial of `Plane.curves` it is on; root: which of the real roots in q."""

    kinds: tuple[str, ...]
    curve: int
    root: int


@dataclass(frozen=True)
class Strip:
    """Values low < p < high between which all curves run side by side. line: the diagram over the second number at `sample`; arcs: one for each event of
    it, rising."""

    low: float
    high: float
    sample: Fraction
    line: Diagram
    arcs: tuple[Arc, ...]


@dataclass(frozen=True)
class Wall:
    """A line p = value across the strips at which the number of equilibria changes, from q = low to q = high."""

    value: float
    low: float
    high: float
    kinds: tuple[str, ...]


@dataclass(frozen=True, repr=False)
class Plane(Shown):
    """All equilibria over two numbers. kind, what: as those of `Diagram`; curves: irreducible polynomials in p and q; strips: rising in p, without gaps;
    walls: lines of one p; cusps: where fold curves end in one another."""

    family: Family = field(repr=False)
    kind: str
    what: str
    curves: tuple[fmpq_mpoly, ...] = field(repr=False)
    strips: tuple[Strip, ...]
    walls: tuple[Wall, ...] = ()
    cusps: tuple[Cusp, ...] = ()
    notes: tuple[str, ...] = ()


def plane(family: Family, borders: bool = False) -> Plane:
    """All equilibria over the two ranges of a family."""
    kind, what, system, notes = chosen(family, borders)
    if system is None:
        raise InputError(f"{family.case.place}: {what}: vary one number, and the curves are told in words; over two there is nothing to draw")
    eliminated = Eliminated(family, system)
    curves = eliminated.critical
    found = cuts(_projected(family, curves), family.spans[0].low, family.spans[0].high)
    if len(found) > MOST:
        raise InputError(f"the curves of these ranges turn and meet at {len(found)} values; at most {MOST} are followed: narrow the ranges")
    strips = _strips(family, borders, curves, found)
    walls = [wall for cut in found for wall in _walls(family, borders, cut, curves, strips)]
    return Plane(family, kind, what, curves, tuple(strips), tuple(walls), tuple(cusps(family, eliminated, curves)), notes)


def _projected(family: Family, curves: Sequence[fmpq_mpoly]):
    """Polynomials in p that are zero wherever curves turn back, meet, go to infinity, or cross an end of the second range."""
    second = family.spans[1]
    parts = []
    for n, F in enumerate(curves):
        if F.degrees()[3] < 1:
            parts.append(F)
            continue
        parts += [F.subs({"q": rational(end)}) for end in (second.low, second.high)]
        parts.append(_lead(F))
        if F.degrees()[3] > 1:
            parts.append(F.resultant(F.derivative("q"), "q"))
        parts += [F.resultant(G, "q") for G in curves[:n] if G.degrees()[3] > 0]
    return [univariate(f, 2) for part in parts if not part.is_zero() and not part.is_constant() for f, _ in part.factor()[1]]


def _lead(F: fmpq_mpoly) -> fmpq_mpoly:
    return of_power(F, 3, F.degrees()[3])


def fixed(family: Family, which: int, value: Fraction) -> Family:
    """The family over the other number, with this one at a value."""
    data, span = copy.deepcopy(family.data), family.spans[which]
    for path in span.key.paths:
        put(data, path, span.written(value))
    return Family(family.at(tuple(value if n == which else other.low for n, other in enumerate(family.spans))), data, (family.spans[1 - which],))


def _strips(family: Family, borders: bool, curves: Sequence[fmpq_mpoly], found: Sequence[Cut]) -> list[Strip]:
    span = family.spans[0]
    ends = [(span.low, span.low), *((cut.low, cut.high) for cut in found), (span.high, span.high)]
    values = [float(span.low), *(float(cut.number) for cut in found), float(span.high)]
    out = []
    for n, ((_, low), (high, _)) in enumerate(zip(ends, ends[1:])):
        if low < high:
            sample = between(low, high)
            line = diagram(fixed(family, 0, sample), borders)
            out.append(Strip(values[n], values[n + 1], sample, line, tuple(_arc(curves, sample, event) for event in line.events)))
    return out


def _arc(curves: Sequence[fmpq_mpoly], sample: Fraction, event: Event) -> Arc:
    """Which root of which curve an event of a strip's diagram is."""
    from flint import fmpq_poly
    own = fmpq_poly(list(event.polynomial))
    for n, F in enumerate(curves):
        if F.degrees()[3] > 0:
            there = univariate(at_rational(F, (sample,)), 3)
            if there.gcd(own).degree() > 0:
                return Arc(event.kinds, n, settled(partial(_rank, there, own, event.index)))
    return Arc(event.kinds, -1, 0)


def _rank(there, own, index: int, digits: Any) -> int:
    """The place of a root of `own` among the real roots of `there`."""
    root = real_roots_of(own)[index][0]
    near = [k for k, (ball, _) in enumerate(real_roots_of(there)) if ball.overlaps(root)]
    if len(near) != 1:
        raise Unclear
    return near[0]


def _walls(family: Family, borders: bool, cut: Cut, curves: Sequence[fmpq_mpoly], strips: Sequence[Strip]) -> list[Wall]:
    """The pieces of the line of one p, a factor without q, at which something happens: asked across it, between the arcs of a strip beside it."""
    alone = [F for F in curves if F.degrees()[3] < 1 and cut.number.reduced(univariate(F, 2)) == 0]
    beside = next((s for s in strips if float(cut.number) in (s.low, s.high)), None)
    if not alone or beside is None:
        return []
    out = []
    for piece in beside.line.pieces:
        across = diagram(fixed(family, 1, piece.sample), borders)
        here = [event for event in across.events if event.value == float(cut.number)]
        out += [Wall(float(cut.number), piece.low, piece.high, event.kinds) for event in here]
    return out


def rows(found: Plane, strip: Strip, points: int = 40) -> tuple[list[float], list[list[float]]]:
    """(values of p, q along each arc at these) inside a strip: closer towards its ends, where curves turn back. Each q is a certified root."""
    low, high = Fraction(strip.low), Fraction(strip.high)
    shares = sorted({Fraction(1, 10**7), *(Fraction(0.5 - 0.5 * math.cos(math.pi * k / points)) for k in range(1, points)), 1 - Fraction(1, 10**7)})
    values: list[float] = []
    arcs: list[list[float]] = [[] for _ in strip.arcs]
    for share in shares:
        p = low + (high - low) * share
        try:
            q = [_q_of(found.curves[arc.curve], p, arc.root) for arc in strip.arcs]
        except Unclear:
            continue
        values.append(float(p))
        for row, value in zip(arcs, q):
            row.append(value)
    return values, arcs


def count_at(found: Plane, p: Fraction, q: Fraction) -> int:
    """How many equilibria there are at a place off every curve, by the curves below it alone. Raises InputError where no strip holds p."""
    strip = next((s for s in found.strips if s.low < p < s.high), None)
    if strip is None:
        raise InputError(f"p = {float(p)!r} lies outside the range, or at the end of a strip")
    low = float(found.family.spans[1].low)
    events = [(arc, event) for arc, event in zip(strip.arcs, strip.line.events) if event.value != low]
    below = sum(_q_of(found.curves[arc.curve], p, arc.root) < q for arc, _ in events)
    return strip.line.pieces[min(below, len(strip.line.pieces) - 1)].count


def _q_of(F: fmpq_mpoly, p: Fraction, index: int) -> float:
    return settled(lambda digits: _root(F, p, index), most=1024)


def _root(F: fmpq_mpoly, p: Fraction, index: int) -> float:
    found = real_roots_of(univariate(at_rational(F, (p,)), 3))
    if index >= len(found):
        raise Unclear
    return float(found[index][0].mid())

