"""The diagram over two numbers: curves in their plane at which equilibria change, the number between them,
and cusps of fold curves, where three equilibria meet.

The plane is cut into strips: at the ends of a strip a curve turns back, two meet, or one leaves the range
(roots of discriminants and resultants of the curves' polynomials), inside it all curves run side by side. So
one value inside a strip, with its diagram over the second number, tells the strip.

A cusp is a triple root of R(x; p, q). R has degree four at the most. F = 0 (a double root, x = 0 say) with
the discriminant of R' zero is a triple root or, in degree four, R = x^2 (x^2 + c x + 9 c^2/32), R' = 4 x (x +
3 c/8)^2: there R'' = 0 at -c/8 and -3 c/8, which are no roots of R. So with the resultant of R and R'' zero
besides it is a triple root, and conversely. The p of such a place is a root of a resultant, the q then a
common root over the field of p.
"""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache, partial
from typing import Any, NamedTuple

from flint import arb, arb_poly, fmpq_mpoly, fmpq_poly

from ...errors import InputError
from ...numbers.algebraic import Algebraic, Cut, coefficients, cuts, gaps, real_balls, univariate
from ...numbers.balls import Digits, Unclear, evaluated, rational, real_roots_of, settled
from ...reasons import Reason
from ..axes import with_values
from .diagram import ball_form, diagram, doubles, spread, state_of
from .eliminated import Eliminated, at_rational, over_field
from .equations import Counted, Diagram, Event, Family, chosen, common_divisor

MOST_BITS = 2048  # beyond which a state is taken to have no number


class Cusp(NamedTuple):
    """A place where three equilibria meet. at: (p, q); state: in the case's variables, empty where a
    component is left open; polynomial, root: of p, as those of an event."""

    at: tuple[float, float]
    state: tuple[float, ...]
    polynomial: tuple[int, ...]
    root: int


def cusps(family: Family, eliminated: Eliminated, curves: Sequence[fmpq_mpoly]) -> list[Cusp]:
    """All of them in the range, on the curves F = 0 that hold double roots."""
    R = eliminated.reduced
    if R.degrees()[0] < 3:
        return []
    lead = coefficients(R, 0)[-1]
    conditions = _conditions(R)

    @cache
    def more() -> list[fmpq_mpoly]:
        """Along one more direction: points that the main view has in line by chance are apart there."""
        others = [view.R for view in eliminated.views[:2]
                  if view is not eliminated.main and not view.R.is_zero()]
        return [c for other in others[:1] for c in _conditions(eliminated.once(other))]
    result: dict[tuple[float, ...], Cusp] = {}
    for F in curves:
        others = [c for c in conditions if c.gcd(F).is_constant()]
        if others and F.degrees()[3] > 0 and lead.gcd(F).is_constant():
            for cusp in _on_curve(family, R, eliminated, F, others, lead, more):
                result.setdefault(tuple(round(v, 12) for v in cusp.at), cusp)
    return sorted(result.values())


def _conditions(R: fmpq_mpoly) -> tuple[fmpq_mpoly, fmpq_mpoly]:
    """Zero where R and R'', and where R' and R'' share a root."""
    slope = R.derivative("x")
    bend = slope.derivative("x")
    return R.resultant(bend, "x"), slope.resultant(bend, "x")


def _on_curve(family: Family, R: fmpq_mpoly, eliminated: Eliminated, F: fmpq_mpoly,
              others: Sequence[fmpq_mpoly],
              lead: fmpq_mpoly, more: Callable[[], Sequence[fmpq_mpoly]]) -> list[Cusp]:
    """The cusps on one curve F: p from resultants with the conditions, then q as a common root over the field
    of p. others: conditions that do not hold all along F; lead: the highest coefficient of R."""
    shadow = common_divisor(F.resultant(c, "q") for c in others)
    if shadow.is_constant():
        return []
    first, second = family.spans
    out = []
    for cut in cuts((univariate(f, 2) for f, _ in shadow.factor()[1]), first.low, first.high):
        number = cut.number
        common = number.trimmed(over_field(F, 3))
        for c in others:
            common = number.gcd(common, number.trimmed(over_field(c, 3))) if common else []
        # where R loses its highest power nothing is known of its other roots
        far = number.trimmed(over_field(lead, 3))
        common = number.divided(common, number.gcd(common, far)) if common and far else []
        common = _truly(number, common, eliminated, more)
        if len(common) > 1:
            places = settled(partial(_places, family, R, eliminated, number, common))
            out += [Cusp(at, state, number.whole, number.index) for at, state in places
                    if second.low <= Fraction(at[1]) <= second.high]
    return out


def _truly(number: Algebraic, common: Any, eliminated: Eliminated,
           more: Callable[[], Sequence[fmpq_mpoly]]) -> Any:
    """Of common roots q those where three points meet, and are not in line by chance: where that may be,
    another direction is asked."""
    apart = eliminated.apart and number.trimmed(over_field(eliminated.apart, 3))
    line = number.gcd(common, apart) if apart and len(common) > 1 else common
    if len(line) < 2:
        return common
    sure = number.divided(common, line)
    for c in more():
        line = number.gcd(line, number.trimmed(over_field(c, 3))) if len(line) > 1 else line
    return number.trimmed([sum((sure[i] * line[n - i] for i in range(len(sure)) if 0 <= n - i < len(line)),
                               line[0] * 0)
                           for n in range(len(sure) + len(line) - 1)])


def _places(family: Family, R: fmpq_mpoly, eliminated: Eliminated, number: Algebraic, common, digits: Any):
    """[((p, q), state)] of the common roots q over the field of p, each with its triple root."""
    at = number.ball(digits.bits)
    return [((float(at.mid()), float(q.mid())),
             _state(family, eliminated, _triple_root(R, at, q), at, q, digits.bits))
            for q, _ in number.real_roots(number.powers(common), digits.bits)]


def _state(family: Family, eliminated: Eliminated, x: arb, p: arb, q: arb, bits: int) -> tuple[float, ...]:
    """The state there; none where the other component has no number of its own (a whole line lies above x).
    """
    try:
        y = eliminated.state(eliminated.main, x, [p, q])
        return doubles(state_of(family, y, ball_form(family, [p, q])[1]))
    except Unclear:
        if bits < MOST_BITS:
            raise
        return ()


def _triple_root(R: fmpq_mpoly, p: arb, q: arb) -> arb:
    """A simple root of the second derivative, or of the third where four roots meet, at which what stands
    before is zero within its balls."""
    zero = arb(0)
    rows = [arb_poly([evaluated(c, [zero, zero, p, q]) for c in coefficients(R, 0)])]
    while rows[-1].degree() > 1:
        rows.append(rows[-1].derivative())
    for n in range(2, len(rows)):
        try:
            real = real_balls(rows[n])
        except Unclear:
            continue
        fitting = [x for x in real if all(f(x).contains(0) for f in rows[:n])]
        if fitting:
            nearest = [(float(abs(arb_poly.evaluate(rows[1], [x])[0]).mid()), k)
                       for k, x in enumerate(fitting)]
            return fitting[min(nearest)[1]]
    raise Unclear


MAX_STRIPS = 200  # strips


@dataclass(frozen=True)
class Arc:
    """A curve inside a strip. kinds: of its events; curve: which polynomial of `Plane.curves` it is on; root:
    which of the real roots in q."""

    kinds: tuple[str, ...]
    curve: int
    root: int


@dataclass(frozen=True)
class Strip:
    """Values low < p < high between which all curves run side by side. line: the diagram over the second
    number at `sample`; arcs: one for each event of it, rising."""

    low: float
    high: float
    sample: Fraction
    line: Diagram
    arcs: tuple[Arc, ...]


@dataclass(frozen=True)
class Wall:
    """A line p = value across the strips at which the number of equilibria changes, from q = low to q = high.
    """

    value: float
    low: float
    high: float
    kinds: tuple[str, ...]


@dataclass(frozen=True, repr=False)
class Plane(Counted):
    """All equilibria over two numbers. kind, counted, what, remarks, notes: as those of `Diagram`; curves:
    irreducible polynomials in p and q; strips: rising in p, without gaps; walls: lines of one p; cusps: where
    fold curves end in one another."""

    family: Family = field(repr=False)
    kind: str
    counted: Reason
    curves: tuple[fmpq_mpoly, ...] = field(repr=False)
    strips: tuple[Strip, ...]
    walls: tuple[Wall, ...] = ()
    cusps: tuple[Cusp, ...] = ()
    remarks: tuple[Reason, ...] = ()


def plane(family: Family, borders: bool = False) -> Plane:
    """All equilibria over the two ranges of a family."""
    kind, counted, system, remarks = chosen(family, borders)
    if system is None:
        raise InputError(f"{family.case.place}: {counted}: vary one number, and the curves are described in "
                         "words; over two there is nothing to draw")
    eliminated = Eliminated(family, system)
    curves = eliminated.critical
    out = cuts(_projected(family, curves), family.spans[0].low, family.spans[0].high)
    if len(out) > MAX_STRIPS:
        raise InputError(f"the curves of these ranges turn and meet at {len(out)} values; "
                         f"at most {MAX_STRIPS} "
                         "are followed: narrow the ranges")
    strips = []
    for gap in gaps(out, family.spans[0].low, family.spans[0].high):
        if gap:
            line = diagram(fixed(family, 0, gap.sample), borders)
            strips.append(Strip(*gap, line, tuple(_arc(curves, gap.sample, event) for event in line.events)))
    walls = [wall for cut in out for wall in _walls(family, borders, cut, curves, strips)]
    return Plane(family, kind, counted, curves, tuple(strips), tuple(walls),
                 tuple(cusps(family, eliminated, curves)), remarks)


def _projected(family: Family, curves: Sequence[fmpq_mpoly]):
    """Polynomials in p that are zero wherever curves turn back, meet, go to infinity, or cross an end of the
    second range."""
    second = family.spans[1]
    parts = []
    for n, F in enumerate(curves):
        if F.degrees()[3] < 1:
            parts.append(F)
            continue
        parts += [F.subs({"q": rational(end)}) for end in (second.low, second.high)]
        parts.append(coefficients(F, 3)[-1])
        if F.degrees()[3] > 1:
            parts.append(F.resultant(F.derivative("q"), "q"))
        parts += [F.resultant(G, "q") for G in curves[:n] if G.degrees()[3] > 0]
    return [univariate(f, 2) for part in parts if not part.is_zero() and not part.is_constant()
            for f, _ in part.factor()[1]]


def fixed(family: Family, which: int, value: Fraction) -> Family:
    """The family over the other number, with this one at a value."""
    span = family.spans[which]
    values = tuple(value if n == which else other.low for n, other in enumerate(family.spans))
    return Family(family.at(values), with_values(family.data, [(span.key, span.written(value))]),
                  (family.spans[1 - which],))


def _arc(curves: Sequence[fmpq_mpoly], sample: Fraction, event: Event) -> Arc:
    """Which root of which curve an event of a strip's diagram is."""
    own = fmpq_poly(list(event.polynomial))
    for n, F in enumerate(curves):
        if F.degrees()[3] > 0:
            there = univariate(at_rational(F, (sample,)), 3)
            if there.gcd(own).degree() > 0:
                return Arc(event.kinds, n, settled(partial(_rank, there, own, event.index)))
    return Arc(event.kinds, -1, 0)


def _rank(there: fmpq_poly, own: fmpq_poly, index: int, digits: Digits) -> int:
    """The place of a root of `own` among the real roots of `there`."""
    root = real_roots_of(own)[index][0]
    nearby = [k for k, (ball, _) in enumerate(real_roots_of(there)) if ball.overlaps(root)]
    if len(nearby) != 1:
        raise Unclear
    return nearby[0]


def _walls(family: Family, borders: bool, cut: Cut, curves: Sequence[fmpq_mpoly],
           strips: Sequence[Strip]) -> list[Wall]:
    """The pieces of the line of one p, a factor without q, at which something happens: asked across it,
    between the arcs of a strip beside it."""
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


def rows(result: Plane, strip: Strip, points: int = 40) -> tuple[list[float], list[list[float]]]:
    """(values of p, q along each arc at these) inside a strip: closer towards its ends, where curves turn
    back. Each q is a certified root."""
    values: list[float] = []
    arcs: list[list[float]] = [[] for _ in strip.arcs]
    for p in spread(Fraction(strip.low), Fraction(strip.high), points, 10**7):
        try:
            q = [_q_of(result.curves[arc.curve], p, arc.root) for arc in strip.arcs]
        except Unclear:
            continue
        values.append(float(p))
        for row, value in zip(arcs, q):
            row.append(value)
    return values, arcs


def count_at(result: Plane, p: Fraction, q: Fraction) -> int:
    """How many equilibria there are at a place off every curve, by the curves below it alone. Raises
    InputError where no strip holds p."""
    strip = next((s for s in result.strips if s.low < p < s.high), None)
    if strip is None:
        raise InputError(f"p = {float(p)!r} lies outside the range, or at the end of a strip")
    low = float(result.family.spans[1].low)
    events = [(arc, event) for arc, event in zip(strip.arcs, strip.line.events) if event.value != low]
    below = sum(_q_of(result.curves[arc.curve], p, arc.root) < q for arc, _ in events)
    return strip.line.pieces[min(below, len(strip.line.pieces) - 1)].count


def _q_of(F: fmpq_mpoly, p: Fraction, index: int) -> float:
    def root(digits: Digits) -> float:
        result = real_roots_of(univariate(at_rational(F, (p,)), 3))
        if index >= len(result):
            raise Unclear
        return float(result[index][0].mid())
    return settled(root, most=1024)
