"""The diagram of equilibria over one number, and its certificate.

The critical values come from elimination; at each, and at one value between neighbours, there are the
equilibria, with their stability by the signs of m and n in balls.

Where equilibria form curves for every value of the range, these are given in words. Without a torque they
are lines along principal axes that carry no wheel, planes of equal moments, and the curve on which momentum
is along the rotation. Under a torque along equal moments of inertia they are a conic in the plane across
it. Which of these there are depends on differences of moments, on parts of wheel and torque that vanish, on
lambda . M, and on the determinant of the conic alone: polynomials in what varies.

Branches are numbered by one component, and two may pass one above the other: they keep their order in the
parts of a piece alone.

The certificate has the scene as polynomials in the number, every value at which equilibria change, and how
many there are between.

What is claimed is checked by other algebra (`verify.diagram`): trace forms and Sturm's sequences, where the
diagram comes from resultants and balls."""
from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial, reduce
from typing import TYPE_CHECKING, Any, NamedTuple

from flint import arb, fmpq_mpoly

from ...equilibrium.description import clauses
from ...equilibrium.gyrostat import WELL, gyrostat_equilibria
from ...equilibrium.result import Equilibria, Verdict
from ...equilibrium.stability import POSITIVE_EIGENVALUE, invariants, isolated_verdict, linear_word
from ...errors import InputError
from ...numbers.algebraic import Algebraic, Cut, between, cuts, gaps, univariate
from ...numbers.balls import Digits, Unclear, evaluated, rational, settled, sign
from ...numbers.vectors import CYCLE, Float3, dot, nearest_first
from ...physics.coefficients import effective
from ...physics.scene import QuadraticForm, euler_form
from ...reasons import Axis, Reason, Sentence
from ...version import __version__
from .eliminated import Eliminated, Leant, Root
from .equations import (
    BORDERS,
    CURVES,
    ENDLESS,
    ISOLATED,
    LEAF,
    Conics,
    Diagram,
    Event,
    Family,
    OnLine,
    Piece,
    State,
    chosen,
    fixed_axis,
)

if TYPE_CHECKING:
    from flint import fmpq_poly


# --- The diagram
BORDER = Verdict("border", Sentence(
    "stability-changes-here",
    "m = 0 on the curve of equilibria: stability changes here")())
SMALL = 1e-17  # radius of a ball over one plus its size
CROSSES = Verdict("undecided", Sentence(
    "curve-crosses-itself",
    "the curve that the motion stays on crosses itself here")())


def ball_form(family: Family, values: list) -> tuple[QuadraticForm, list[arb]]:
    """(the rates with balls for coefficients, u) at values of what varies."""
    unknowns = [arb(0)] * 2
    numbers: dict[str, Any] = {name: [evaluated(c, [*unknowns, *values]) for c in row]
                               for name, row in family.numbers.items()}
    if not family.scaled:
        return euler_form(tuple(numbers["D"]), tuple(numbers["lam"]), tuple(numbers["M"])), numbers["u"]
    half, l1 = numbers["u"][0] / 2, numbers["lam"][0]
    item: Any = arb(1)
    zero: Any = arb(0)
    return QuadraticForm((item, -item, item), (zero, zero, half + l1), (zero, l1 - half, zero),
                         tuple(numbers["M"]), "x"), numbers["u"]


def state_of(family: Family, y: tuple[arb, ...], u: list[arb]) -> tuple[arb, ...]:
    """The state in the case's variables."""
    return ((y[0] - u[0]) / 2, y[1], -y[2]) if family.scaled else tuple(y)


def doubles(x: tuple[arb, ...]) -> tuple[float, ...]:
    """The middles of balls that are narrow enough for doubles. Unclear where they are not."""
    if any(v.rad() > SMALL * (1 + abs(v.mid())) for v in x):
        raise Unclear
    return tuple(0.0 if v.contains(0) else float(v.mid()) for v in x)


def judged_state(family: Family, kind: str, values: list, root: Root, after: int = 0,
                 flat: bool = False) -> State:
    """An equilibrium with its verdict. after: where branches meet in it on a motion's curve, the sign of m on
    the branch that goes on; flat: m is known to be zero there, which no ball tells. Unclear where the balls
    leave a sign open."""
    form, u = ball_form(family, values)
    x = state_of(family, root.y, u)
    at = doubles(x)
    if kind == BORDERS:
        return State(at, root.times, "degenerate", BORDER.word, reason=BORDER.reason)
    m, n = invariants(form, x)
    if kind == ISOLATED:
        n_sign = sign(n) if root.times == 1 else 0
        m_sign = 0 if flat or (n_sign and m.contains(0)) else sign(m)
        verdict = isolated_verdict(m_sign, n_sign)
        return State(at, root.times, linear_word(m_sign, n_sign), verdict.word, reason=verdict.reason)
    if root.times == 1:
        m_sign = sign(m)
        verdict = WELL.positive if m_sign > 0 else POSITIVE_EIGENVALUE
        return State(at, 1, linear_word(m_sign, 0), verdict.word, reason=verdict.reason)
    verdict = (WELL.odd if root.times % 2 == 0 else WELL.minimum if after > 0 else WELL.maximum if after < 0
               else CROSSES)
    return State(at, root.times, "degenerate", verdict.word, reason=verdict.reason)


def general_states(family: Family, kind: str, eliminated: Eliminated, value: Fraction, digits: Digits,
                   view: Leant | None = None) -> tuple[State, ...]:
    """The equilibria at a value where no branches meet, with their verdicts; asked by `settled`. view:
    another one than the main view."""
    return tuple(judged_state(family, kind, [rational(value)], root)
                 for root in eliminated.at_general((value,), view))


ALL_STATES = Sentence("every-state", "every state is an equilibrium")()
ALL_POINTS = Sentence("every-point-of-a-curve", "every point of a curve is an equilibrium")()
MOMENTS_EQUAL = Sentence("moments-become-equal", "moments of inertia {first} and {second} are equal")
WHEEL_VANISHES = Sentence("wheel-part-vanishes", "the wheel's part along {axis} vanishes")
TORQUE_VANISHES = Sentence("torque-part-vanishes", "the torque's part along {axis} vanishes")
WHEEL_ACROSS = Sentence("wheel-across-torque", "the wheel is across the torque")()
CONIC_SPLITS = Sentence("conic-splits", "the conic falls apart into lines")()
CURVE_ON_AXIS = Sentence("curve-on-axis",
                         "the torque falls on a principal axis: a curve of equilibria")()
NONE_ON_AXIS = Sentence("none-on-axis",
                        "the torque falls on a principal axis that carries a wheel: no equilibrium")()
NONE_BECAUSE = Sentence("no-equilibrium-because", "no equilibrium: {why}")
CONNECTIONS_BY_BALLS = Sentence(
    "connections-by-balls", "{connections} connections: the heights of saddles hold an angle and are "
    "isolated by balls alone")
CURVES_BECAUSE = Sentence("curves-because", "{curves}: {why}")


class There(NamedTuple):
    """What there is at one value: how many equilibria, and which curves, None where there are none."""

    number: int
    curves: Reason | None


def of_curves(family: Family, counted: Reason) -> Diagram:
    """The diagram over one number where equilibria form curves, which are named."""
    span, named = family.spans[0], list(_named(family))
    parts = [factor for f, _ in named if not f.is_constant() for factor, _ in f.factor()[1]]
    result = cuts((univariate(f, 2) for f in parts), span.low, span.high)
    pieces: list[Piece] = []
    events: list[Event] = []
    for n, gap in enumerate(gaps(result, span.low, span.high)):
        event = _change_of_curves(family, result[n - 1], named) if n else None
        if gap:
            there = _curves_at(family, gap.sample)
            same = event is None or (event.count, event.reason) == there
            if same and pieces and there == (pieces[-1].count, pieces[-1].reason):
                pieces[-1] = replace(pieces[-1], high=gap.high)
                continue
            pieces.append(Piece(*gap[:2], there.number, gap.sample, (), reason=there.curves))
        if event is not None:
            events.append(event)
    return Diagram(family, CURVES, counted, tuple(pieces), tuple(events))


def _curves_at(family: Family, value: Fraction) -> There:
    result = gyrostat_equilibria(effective(family.at((value,)).scene))
    if result.kind == "all":
        return There(ENDLESS, ALL_STATES)
    return There(ENDLESS if result.curves else len(result.points), _names(result))


def _names(result: Equilibria) -> Reason | None:
    """The curves by their names; None where there are none."""
    return clauses(curve.description.name for curve in result.curves) if result.curves else None


def _change_of_curves(family: Family, cut: Cut, named: list[tuple[fmpq_mpoly, Reason]]) -> Event:
    number, exact = cut.number, cut.number.rational
    here = _curves_at(family, exact) if exact is not None else There(ENDLESS, None)
    first, *others = dict.fromkeys(why for f, why in named if number.reduced(univariate(f, 2)) == 0)
    reason = here.curves or reduce(Reason.then, others, first)
    return Event(float(number), exact, number.whole, number.index, ("curve",), here.number, (),
                 reason=reason)


def _named(family: Family) -> Iterator[tuple[fmpq_mpoly, Reason]]:
    """(polynomial, what is so where it vanishes) of all that may change the curves; those that vanish all
    over the range are left out."""
    n = family.numbers
    D, lam, M = n["D"], n["lam"], n["M"]
    load = dot(lam, M)
    rows = [(D[i] - D[j], MOMENTS_EQUAL(first=i + 1, second=j + 1)) for i in range(3) for j in range(i)]
    rows += [(lam[i], WHEEL_VANISHES(axis=Axis(i + 1))) for i in range(3)]
    rows += [(M[i], TORQUE_VANISHES(axis=Axis(i + 1))) for i in range(3)]
    rows += [(load, WHEEL_ACROSS)]
    rows += [((D[i] - D[c]) * dot(M, M) + lam[c] * (lam[j] * M[i] - lam[i] * M[j]), CONIC_SPLITS)
             for c, (i, j) in enumerate(CYCLE)]
    return ((f, why) for f, why in rows if not f.is_zero())


EVENTS = {"fold": Sentence("event-fold", "two {things} meet and vanish"),
          "pitchfork": Sentence("event-pitchfork", "three {things} meet in one"),
          "crossing": Sentence("event-crossing", "two branches of {things} cross"),
          "touch": Sentence("event-touch", "two {things} that are there at this value alone"),
          "infinity": Sentence("event-infinity", "{things} go to infinity")}


def diagram(family: Family, borders: bool = False) -> Diagram:
    """All equilibria over the one range of a family."""
    kind, counted, system, remarks = chosen(family, borders)
    span = family.spans[0]
    if system is None:
        return of_curves(family, counted)
    eliminated = Eliminated(family, system)
    result = cuts((univariate(c, 2) for c in eliminated.critical), span.low, span.high)
    pieces: list[Piece | None] = []
    for gap in gaps(result, span.low, span.high):
        states = settled(partial(general_states, family, kind, eliminated, gap.sample)) if gap else ()
        pieces.append(Piece(*gap[:2], len(states), gap.sample, states) if gap else None)
    events = [_event(family, kind, eliminated, cut, pieces[n:n + 2]) for n, cut in enumerate(result)]
    retained = [piece for piece in pieces if piece is not None]
    return Diagram(family, kind, counted, *_joined(retained, events, result), remarks=remarks)


def _event(family: Family, kind: str, eliminated: Eliminated, cut: Cut,
           sides: Sequence[Piece | None]) -> Event | None:
    """What happens at a cut; None where nothing does."""
    system, number = eliminated.system, cut.number
    make = partial(Event, float(number), number.rational, number.whole, number.index)
    if number.reduced(univariate(system.special, 2)) == 0:
        count, states, reason = _on_an_axis(family, system, cut)
        return make(("axis",), count, states, reason=reason)
    roots = settled(lambda digits: [eliminated.at_algebraic(number, digits.bits)])[0]
    if roots is None:
        return make(("curve",), ENDLESS, (), reason=ALL_POINTS)
    kinds = _kinds(roots, sides)
    if not kinds:
        return None
    states = settled(lambda digits: _states_at(family, kind, eliminated, cut, digits.bits, sides))
    things = "points" if kind == BORDERS else "equilibria"
    first, *others = (EVENTS[item](things=things) for item in kinds)
    return make(kinds, len(roots), states, reason=reduce(Reason.then, others, first))


def _kinds(roots: Sequence[Root], sides: Sequence[Piece | None]) -> tuple[str, ...]:
    """What happens, by how many branches meet in a root, and whether their number changes."""
    counts = [piece.count for piece in sides if piece is not None]
    many = max((root.times for root in roots), default=1)
    if many > 2:
        return ("pitchfork",)
    if many > 1:
        fold = len(counts) == 1 or counts[0] != counts[-1]
        return ("fold" if fold else "touch" if len(roots) > counts[0] else "crossing",)
    return ("infinity",) if any(count != len(roots) for count in counts) else ()


def _states_at(family: Family, kind: str, eliminated: Eliminated, cut: Cut, bits: int,
               sides: Sequence[Piece | None]) -> tuple[State, ...]:
    values = [cut.number.ball(bits)]
    roots = eliminated.at_algebraic(cut.number, bits) or []
    flat = kind == ISOLATED and any(root.times > 1 for root in roots) and eliminated.flat(cut.number)
    # the sign of m on a branch that goes on through a meeting of an odd number: that of the side where one
    # branch alone arrives
    alone = [1 if piece.states[0].linear == "stable" else -1 for piece in sides
             if kind == LEAF and piece is not None and piece.count == 1]
    return tuple(judged_state(family, kind, values, root, alone[0] if alone and root.times % 2 else 0, flat)
                 for root in roots)


def _on_an_axis(family: Family, system: OnLine | Conics, cut: Cut) -> tuple[int, tuple[State, ...], Reason]:
    """(count, states, what happens) where the torque of an isolated family falls on a principal axis."""
    value = cut.number.rational
    if value is None:
        load = cut.number.reduced(univariate(system.load, 2)) == 0
        return (ENDLESS, (), CURVE_ON_AXIS) if load else (0, (), NONE_ON_AXIS)
    result = gyrostat_equilibria(effective(family.at((value,)).scene))
    states = tuple(State(point.at, 1, point.linear, point.verdict, reason=point.reason)
                   for point in result.points)
    why, names = result.reason, _names(result)
    reason = (NONE_BECAUSE(why=why) if result.kind == "none" else why if names is None
              else CURVES_BECAUSE(curves=names, why=why))
    count = ENDLESS if result.curves or result.kind == "all" else len(states)
    return count, states, reason


def _joined(pieces: list[Piece], events: list[Event | None],
            result: Sequence[Cut]) -> tuple[tuple[Piece, ...], tuple[Event, ...]]:
    """Pieces without the cuts at which nothing happens but that branches may change their order: their seams.
    """
    gone = {float(cut.number) for cut, event in zip(result, events) if event is None}
    out: list[Piece] = []
    for piece in pieces:
        if out and piece.low in gone and out[-1].high == piece.low:
            out[-1] = replace(out[-1], high=piece.high, seams=(*out[-1].seams, piece.low))
        else:
            out.append(piece)
    return tuple(out), tuple(event for event in events if event is not None)


@dataclass(frozen=True)
class Part:
    """low, high: its ends, an end of the piece or a seam; states: the equilibria at a value inside, in the
    order of this part."""

    low: float
    high: float
    states: tuple[State, ...]


def parts(family: Family, kind: str, eliminated: Eliminated, piece: Piece) -> list[Part]:
    """The parts between the seams of a piece, rising."""
    ends = (piece.low, *piece.seams, piece.high)
    out = []
    for low, high in zip(ends, ends[1:]):
        inside = low < piece.sample < high
        states = (piece.states if inside
                  else settled(partial(general_states, family, kind, eliminated,
                                       between(Fraction(low), Fraction(high)))))
        out.append(Part(low, high, states))
    return out


def followed(before: Sequence[Float3], after: Sequence[Float3]) -> list[int]:
    """For each state after a seam the place of the one before it that it goes on from: the nearest."""
    result = nearest_first((sum((u - v) ** 2 for u, v in zip(a, b)), n, k) for n, a in enumerate(after)
                          for k, b in enumerate(before))
    return [result[n] for n in range(len(after))]


BRANCH_POINTS = 64  # of a branch, closer towards both ends as a fold's parabola needs it


@dataclass(frozen=True)
class Branch:
    """A branch of one piece, or of a part of it between seams: rows (value, state in the case's variables),
    the verdict that all of it has, and which branch of which piece it is."""

    piece: int
    number: int
    verdict: str
    values: tuple[float, ...]
    states: tuple[Float3, ...]


def branches(diagram: Diagram, points: int = BRANCH_POINTS) -> list[Branch]:
    """Every branch of every piece."""
    system = chosen(diagram.family, diagram.kind == "borders")[2]
    if system is None:
        return []
    eliminated = Eliminated(diagram.family, system)
    return [branch for n, piece in enumerate(diagram.pieces) if piece.count
            for branch in _of_piece(diagram, eliminated, n, piece, points)]


def _of_piece(diagram: Diagram, eliminated: Eliminated, n: int, piece: Piece,
              points: int) -> Iterator[Branch]:
    """The branches of a piece, each part of it by itself; a branch keeps its number across a seam."""
    numbers, last = list(range(piece.count)), None
    for part in parts(diagram.family, diagram.kind, eliminated, piece):
        values = spread(Fraction(part.low), Fraction(part.high), points, 10**6)
        solved = [(float(value), _solved(diagram, eliminated, value, piece.count)) for value in values]
        rows = [(value, states) for value, states in solved if states is not None]
        if rows and last is not None:
            numbers = [numbers[k] for k in followed(last, rows[0][1])]
        for location, number in enumerate(numbers):
            yield Branch(n, number, part.states[location].verdict, tuple(value for value, _ in rows),
                         tuple(states[location] for _, states in rows))
        last = rows[-1][1] if rows else last


def spread(low: Fraction, high: Fraction, points: int, near: int) -> list[Fraction]:
    """Values inside an interval, closer towards its ends, the outermost at 1/near of its width from these."""
    shares = [Fraction(0.5 - 0.5 * math.cos(math.pi * k / points)) for k in range(1, points)]
    return sorted(low + (high - low) * part for part in {*shares, Fraction(1, near), 1 - Fraction(1, near)})


def _solved(diagram: Diagram, eliminated: Eliminated, value: Fraction, count: int) -> list[Float3] | None:
    try:
        states = settled(partial(general_states, diagram.family, diagram.kind, eliminated, value), most=1024)
    except Unclear:
        return None
    return [state.at for state in states] if len(states) == count else None


# --- Its certificate
SCHEMA = "stabilab.diagram-certificate/1"
BOUND_BITS = 128  # of the bounds about an irrational value
MAX_EVENTS = 64  # events that a certificate may hold


def certifiable(spans: Sequence[Any]) -> None:
    """Refuse ranges of which no certificate can be made, before any work."""
    if len(spans) > 1:
        raise InputError("--certify: a certificate is of a diagram over one number; over two, certify lines "
                         "of the plane one by one")


def diagram_certificate(out: Diagram) -> dict[str, Any]:
    """The object of `stabilab.diagram-certificate/1`. Raises InputError for a diagram of more events than it
    may hold."""
    if out.kind == CURVES:
        raise InputError(f"--certify: {out.counted.alone}: stabilab classify --certify proves "
                         "them at one value")
    pieces, events = _changes(out)
    if len(events) > MAX_EVENTS:
        raise InputError(
            f"--certify: a certificate holds at most {MAX_EVENTS} events, "
            f"this range has {len(events)}: divide it")
    family, span = out.family, out.family.spans[0]
    axis = fixed_axis(family)
    return {"schema": SCHEMA, "program": f"stabilab {__version__}",
            "number": span.key.name + (f" ({span.unit})" if span.unit else ""),
            "scene": _scene(family), "counted": out.kind,
            "axis": 0 if out.kind == ISOLATED or axis is None else axis + 1,
            "start": _start(family) if out.kind == LEAF else None, "range": [str(span.low), str(span.high)],
            "pieces": [{"equilibria": _count(piece.count), "stable": _stable(out, piece)}
                       for piece in pieces],
            "events": [{"t": _bounds(event), "equilibria": _count(event.count)} for event in events],
            "uncertified": [CONNECTIONS_BY_BALLS(connections=len(out.connections)).text()]
            if out.connections else []}


def _changes(result: Diagram) -> tuple[list[Piece], list[Event]]:
    """Pieces and events without those events at which the number stays what it is on both sides."""
    pieces, events = [result.pieces[0]], []
    rest = list(result.pieces[1:])
    low = result.family.spans[0].low
    if result.events and result.events[0].exact == low:
        events.append(result.events[0])
    for event in result.events[len(events):]:
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


def _stable(result: Diagram, piece: Piece) -> int | None:
    return (None if result.kind == BORDERS or piece.count == ENDLESS
            else sum(state.verdict == "stable" for state in piece.states))


def _bounds(event: Event) -> list[str]:
    """Rational numbers about an event's value, which an exact one is itself."""
    from flint import fmpq_poly
    if event.exact is not None:
        return [str(event.exact)] * 2
    number = Algebraic(fmpq_poly(list(event.polynomial)), event.index)
    ball = settled(lambda digits: number.ball(max(BOUND_BITS, digits.bits)))
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
