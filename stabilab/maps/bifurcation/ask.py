"""A bifurcation diagram from a case and one or two ranges; where separatrices connect in it.

A connection: two saddles of a motion's circle come to one height, so that the separatrix of each ends at
the other, and its type changes.

On a circle about its centre, X' = p Y and Y' = q X with p q < 0 per angle alpha of the turn, the force is k X
Y + c Y + d X + F0, so the potential is

    U = -k X^2/(2 p) - c X/p - d Y/q - F0 alpha,   alpha = atan2(-p Y/n, X)/n,   n = sqrt(-p q).

Between two critical values there are two saddles at the most (four equilibria). In both directions, the
rise of U from one to the next is a function of the number that varies, enclosed with its slope over whole
intervals; an interval is dropped where the rise keeps away from zero, settled where the slope does, and
halved otherwise. Hyperbolas and parabolas have one saddle a branch."""
from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import Any

from flint import arb, arb_poly, arb_series

from ...case.given import Amount, Given, Span, Start, written
from ...case.read import Case, read_text
from ...case.source import parsed
from ...errors import InputError
from ...numbers.algebraic import between, coefficients, univariate
from ...numbers.balls import Digits, Unclear, evaluated, rational, real_roots_of, settled, working
from ...numbers.bracket import Bracket, narrowed
from ...numbers.units import MOMENTUM, RATE, in_si
from ...numbers.vectors import Float3
from ...physics.coefficients import effective
from ...reasons import Sentence
from ..axes import spans_of
from ..plan import place_and_text
from .diagram import ball_form, diagram, followed, general_states, parts
from .eliminated import Eliminated, at_rational
from .equations import LEAF, Conics, Diagram, Event, Family, OnLine, Piece, State, chosen
from .plane import Plane, plane
from .rotations import RotationDiagram, rotation_diagram
from .tops import TopDiagram, is_top, top_diagram

# --- Where separatrices connect
BITS = 160
# of a piece: so near to its ends, where a saddle is lost, nothing is looked for
END_WIDTH = Fraction(1, 10**9)
DEPTH = 48  # halvings of an interval
MAX_ENCLOSURES = 5000  # enclosures of a rise in one diagram: some ten seconds
PARTS = (Fraction(1, 2), Fraction(5, 11), Fraction(6, 11))  # places where an interval may be divided
CONNECTED = Sentence("saddles-connected",
                     "two saddles are at one height: the separatrix of each ends at the other")()
NOT_SETTLED = Sentence("connections-not-settled",
                       "undecided: whether two saddles come to one height somewhere; enclosures did not "
                       "settle it")()


class Spent(Exception):
    """The enclosures that one diagram may take are used up: no bisection may go on, whatever it makes of an
    open sign."""


def with_connections(result: Diagram) -> Diagram:
    """The diagram with the connections in it; where they are not settled a note says so."""
    if result.kind != LEAF:
        return result
    system = chosen(result.family, False)[2]
    try:
        return replace(result, connections=tuple(connections(result.family, system, result.pieces)))
    except (Unclear, Spent):
        return replace(result, remarks=(*result.remarks, NOT_SETTLED))


def connections(family: Family, system: Conics | OnLine, pieces: tuple[Piece, ...]) -> list[Event]:
    """All of them in the range of one number, rising; none where the motion is on no circle."""
    if not isinstance(system, Conics):
        return []
    eliminated, result, budget = Eliminated(family, system), [], [MAX_ENCLOSURES]
    for piece in pieces:
        if sum(state.linear == "unstable" for state in piece.states) == 2:
            result += _of_piece(family, eliminated, system.axis, piece, budget)
    # each value once: where the torque about the centre vanishes both ways round come to one height together
    return list({event.value: event for event in sorted(result, key=lambda event: event.value)}.values())


def _of_piece(family: Family, eliminated: Eliminated, axis: int, piece: Piece,
              budget: list[int]) -> list[Event]:
    """Those of a piece: inside each part of it where the motion is on a circle, and at each seam between
    two such parts."""
    width = Fraction(piece.high) - Fraction(piece.low)
    # the ends are rounded to doubles
    off = max(END_WIDTH * width, max(abs(Fraction(piece.low)), abs(Fraction(piece.high))) / (1 << 50))
    result, before = [], None
    for part in parts(family, LEAF, eliminated, piece):
        low, high = Fraction(part.low) + off, Fraction(part.high) - off
        with working(BITS):
            kappa = ball_form(family, [rational(between(low, high))])[0].kappa if low < high else (0,) * 3
            circle = kappa[(axis + 1) % 3] * kappa[(axis + 2) % 3] < 0
        if not circle:
            before = None
            continue
        if eliminated.main.lean:
            raise Unclear
        saddles = [n for n, state in enumerate(part.states) if state.linear == "unstable"]
        rises = [_Rise(family, eliminated, saddles, route, budget) for route in (0, 1)]
        for rise in rises:
            result += [_event(family, eliminated, piece, value) for value in _zeros(rise, low, high)]
        if piece.seams and before is not None:
            retained = followed(before[1], _places(family, eliminated, saddles, low))
            # where both have changed places each goes the other's way
            if any(rise.sign(low) != before[0][route] for rise, route in zip(rises, retained)):
                result.append(_event(family, eliminated, piece, Fraction(part.low)))
        before = ([rise.sign(high) for rise in rises],
                  _places(family, eliminated, saddles,
                          high)) if piece.seams and part.high < piece.high else None
    return result


def _places(family: Family, eliminated: Eliminated, saddles: list[int], value: Fraction) -> list[Float3]:
    """The states of the saddles at a value, by their places in the order there."""
    states = settled(partial(general_states, family, LEAF, eliminated, value))
    return [states[n].at for n in saddles]


def _event(family: Family, eliminated: Eliminated, piece: Piece, value: Fraction) -> Event:
    value = Fraction(float(value))
    return Event(float(value), None, (), 0, ("connection",), piece.count,
                 _states_at(family, eliminated, piece, value), reason=CONNECTED)


def _states_at(family: Family, eliminated: Eliminated, piece: Piece, value: Fraction) -> tuple[State, ...]:
    """The equilibria at a value, at a seam by a view in which no two are in line."""
    for view in (eliminated.main, *eliminated.views):
        try:
            states = settled(partial(general_states, family, LEAF, eliminated, value, view=view), most=1024)
        except Unclear:
            continue
        if len(states) == piece.count:
            return states
    raise Unclear


class _Rise:
    """The rise of U from one saddle to the next, and its slope, over an interval of the number that varies.

    A saddle's angle may be held while the number varies: U is stationary in it. budget: how many enclosures
    are left, a list of one count, which all rises of a diagram share; Spent where it is used up.
    """

    def __init__(self, family: Family, eliminated: Eliminated, saddles: list[int], way: int,
                 budget: list[int]) -> None:
        self.family, self.eliminated, self.saddles = family, eliminated, saddles
        self.way, self.budget = way, budget
        self.known: dict[Fraction, arb] = {}
        f = eliminated.main.f
        self.top, self.bottom = coefficients(f, 1, 2)[:2]  # y = -top/bottom, with its slopes' numerators
        self.slopes = [self.top * self.bottom.derivative(name) - self.top.derivative(name) * self.bottom
                       for name in ("x", "p")]

    def sign(self, value: Fraction) -> int:
        """At one value; Unclear where so many bits leave it open."""
        rise = self._at(value)
        if rise > 0 or rise < 0:
            return 1 if rise > 0 else -1
        raise Unclear

    def size(self, value: Fraction) -> float:
        """Its size at one value, about; infinite where no double has it."""
        return abs(float(self._at(value).mid())) or math.inf

    def over(self, low: Fraction, high: Fraction) -> tuple[arb, arb]:
        """(rise, slope) as balls that hold those of every value of the interval; the rise by the slope from
        its middle on."""
        middle = (low + high) / 2
        rise, slope = self._of(low, high)
        with working(BITS):
            centred = self._at(middle) + slope * arb(0, rational((high - low) / 2))
            return centred if centred.rad() < rise.rad() else rise, slope

    def _at(self, value: Fraction) -> arb:
        """At one value, where an interval is centred before it is divided there."""
        if value not in self.known:
            self.known[value], _ = self._of(value, value)
        return self.known[value]

    def _of(self, low: Fraction, high: Fraction) -> tuple[arb, arb]:
        """(rise, slope) over an interval of p: each saddle is enclosed over it, then U as a series p + s to
        first order in s."""
        self.budget[0] -= 1
        if self.budget[0] < 0:
            raise Spent
        middle = (low + high) / 2
        with working(BITS, terms=2):
            off = arb(0, rational((high - low) / 2))
            p = off + arb(rational(middle))
            roots = real_roots_of(univariate(at_rational(self.eliminated.main.R, (middle,))))
            if len(roots) <= max(self.saddles):
                raise Unclear
            ends = [self._saddle(roots[n][0], middle, off, p) for n in self.saddles]
            return self._rise(arb_series([p, 1]), ends[:: -1 if self.way else 1])

    def _saddle(self, x: arb, middle: Fraction, off: arb, p: arb) -> tuple[arb, arb]:
        """(x, y) of a saddle. R is moved to its place at the middle of the interval first, where small balls
        stay small."""
        R, ring = self.eliminated.reduced, self.family.ring
        first, second, third, fourth = ring.gens()
        at = rational(Fraction(float(x.mid())))  # near its middle
        moved = R.compose(first + at, second, third + rational(middle), fourth, ctx=ring)
        powers, coefficients = [arb(1)], [arb(0)] * (R.degrees()[0] + 1)
        for _ in range(R.degrees()[2]):
            powers.append(powers[-1] * off)  # arb's own power of a ball about zero is NaN
        for (n, _, m, _), c in moved.to_dict().items():
            coefficients[n] += powers[m] * c
        location = arb(at) + _enclosed(coefficients, arb(0))
        here, inside = [arb(at), arb(0), arb(rational(middle))], [location.union(arb(at)), arb(0), p]
        bottom, bottom_here = evaluated(self.bottom, inside), evaluated(self.bottom, here)
        if bottom.contains(0):
            raise Unclear
        # By its slopes from the middle on: far out on the conic y hardly moves, while x does.
        along_x, along_p = (evaluated(slope, inside) / (bottom * bottom) for slope in self.slopes)
        return location, along_x * (location - at) + along_p * off - evaluated(self.top, here) / bottom_here

    def _rise(self, at: arb_series, ends: list[tuple[arb, arb]]) -> tuple[arb, arb]:
        """U at the second end less U at the first, and its slope, by series of first order in the number that
        varies. at: that number; ends: (y_j, y_k) of the two saddles."""
        i = self.eliminated.system.axis  # type: ignore[union-attr]  # a circle is of two conics
        j, k = (i + 1) % 3, (i + 2) % 3
        form: Any
        form, u = ball_form(self.family, [at])
        start = [evaluated(c, [arb(0), arb(0), at]) for c in self.family.numbers["y"]]
        p, q = form.kappa[j], form.kappa[k]
        if not head(p) * head(q) < 0:
            raise Unclear
        x0, y0 = -form.sigma[k] / q, -form.rho[j] / p
        kappa, rho, sigma = form.kappa[i], form.rho[i], form.sigma[i]
        c, d = kappa * x0 + rho, kappa * y0 + sigma
        force = kappa * x0 * y0 + rho * y0 + sigma * x0 + form.m[i]
        n = (-p * q).sqrt()
        X, Y = self._from_centre(j, k, start[j], start[k], u, x0, y0)
        size = (X * X + (p * Y / n) * (p * Y / n)).sqrt()
        heights, angles = [], []
        for end in ends:
            X, Y = (head(v) for v in self._from_centre(j, k, *end, u, x0, y0))
            Z = -head(p) * Y / head(n)
            angles.append(Digits.angle(Z, X))
            X, Y = size * (X / head(size)), size * (Z / head(size)) * -n / p
            # On a circle q X^2 - p Y^2 is constant: of the two squares the one that stays small where the
            # circle becomes a parabola.
            square = X * X / p if abs(head(p).mid()) <= abs(head(q).mid()) else Y * Y / q
            heights.append(-kappa * square / 2 - c * X / p - d * Y / q)
        rise = heights[1] - heights[0] - force * _once_round(angles[1] - angles[0]) / n
        return head(rise), tail(rise)

    def _from_centre(self, j: int, k: int, x: Any, y: Any, u: Any, x0: Any, y0: Any) -> tuple[Any, Any]:
        """The components of the state about the circle's centre, from those of the balance."""
        if self.family.scaled:
            back = (lambda v: (v - u[0]) / 2, lambda v: v, lambda v: -v)
            x, y = back[j](x), back[k](y)
        return x - x0, y - y0


def _once_round(turn: arb) -> arb:
    """The angle in (0, 2 pi)."""
    full = 2 * arb.pi()
    while turn < 0:
        turn = turn + full
    while turn > full:
        turn = turn - full
    if not (turn > 0 and turn < full):
        raise Unclear
    return turn


def _enclosed(coefficients: list[arb], middle: arb) -> arb:
    """A ball that holds the one root near `middle` for all coefficients in their balls: Newton's step over it
    falls inside."""
    f = arb_poly(coefficients)
    slope, at_middle, ball = f.derivative(), f(middle), middle
    for _ in range(8):
        rate = slope(ball)
        if rate.contains(0):
            raise Unclear
        step = middle - at_middle / rate
        if ball.contains(step):
            return step
        ball = arb(middle, 1.2 * float((step - middle).abs_upper()) + 1e-45)
    raise Unclear


def head(series: Any) -> arb:
    """The value of a series, or of a constant."""
    return series[0] if isinstance(series, arb_series) else arb(series)


def tail(series: Any) -> arb:
    """Its slope."""
    return series[1] if isinstance(series, arb_series) else arb(0)


def _zeros(rise: _Rise, low: Fraction, high: Fraction) -> list[Fraction]:
    """All zeros of the rise in the interval. Raises Unclear where halving does not settle."""
    out: list[Fraction] = []
    stack = [(low, high, 0)]
    while stack:
        a, b, depth = stack.pop()
        try:
            value, slope = rise.over(a, b)
            if not value.contains(0):
                continue
            if not slope.contains(0):
                if rise.sign(a) != rise.sign(b):
                    out.append(_zero(rise, a, b))
                continue
            middle = _divided(rise, a, b)
        except (Unclear, ZeroDivisionError):
            middle = a + (b - a) * PARTS[1]
        if depth == DEPTH:
            raise Unclear
        stack += [(a, middle, depth + 1), (middle, b, depth + 1)]
    return out


def _divided(rise: _Rise, low: Fraction, high: Fraction) -> Fraction:
    """A value near the middle at which the rise has a sign: no interval ends at a zero, which it would never
    be rid of. A scene with a mirror has its zero in the very middle."""
    for part in PARTS:
        value = low + (high - low) * part
        try:
            rise.sign(value)
        except (Unclear, ZeroDivisionError):
            continue
        return value
    return (low + high) / 2


def _zero(rise: _Rise, low: Fraction, high: Fraction) -> Fraction:
    """The zero of a rise between two values at which it has different signs, to the last bit of a double; a
    short number that cannot be distinguished from it is taken for it."""
    first = rise.sign(low)

    def judge(value: Fraction) -> float:
        try:
            return rise.sign(value) * first * rise.size(value)
        except Unclear:
            return math.nan
    result = narrowed(judge, Bracket(low, high, (judge(low), judge(high))), near=Fraction(0))
    return (result.same + result.other) / 2


# --- The question
def bifurcation(case: Given, vary: Mapping[str, Any] | Sequence[tuple[str, Any]],
                curve: bool = False, *, momentum: Amount | None = None, spin: Amount | None = None,
                state: Start | None = None, span: Span | None = None
                ) -> Diagram | Plane | RotationDiagram | TopDiagram:
    """All equilibria of a case over the range of one number or of two, exactly: where they appear, vanish or
    go to infinity, and which are stable.

    case: in any form, or a scene with `state` and `span`. vary: name of a number -> its range, "0:0.5 N m" or
    two numbers in SI units; names are those of `stabilab.sweep`. Off the principal axes isolated equilibria
    are counted; of a torque on one, those on the curve that the motion of the case keeps to, or, with `curve`
    or without a motion, the points of the curve of equilibria where stability changes. Critical values are
    roots of discriminants and resultants with rational coefficients, isolated by balls: no step size, and
    none is missed. Over two numbers these are curves, with their cusps.

    momentum: |H|, N m s or text with a unit: instead all rotations of a free body at it, with losses inside
    or without, over the speed or momentum of a wheel; spin: rad/s or text with a unit: the rotation at this
    rate about the wheels' own principal axis. Of a symmetric top in a field: its steady motions over the
    range of its spin, its weight or the momentum of a wheel along its axis. Raises InputError for what cannot
    be eliminated.
    """
    case = written(case, state, span)
    if momentum is not None or spin is not None:
        if curve or (momentum is not None and spin is not None):
            raise InputError("bifurcation: momentum, spin and curve are different questions: give one of "
                             "them")
        return rotation_diagram(case, _pairs(vary), *(
            None if value is None else in_si(value, dimension, name)
            for value, dimension, name in ((momentum, MOMENTUM, "momentum"), (spin, RATE, "spin"))))
    if (top := _of_top(case, vary, curve)) is not None:
        return top
    family = family_of(case, vary)
    try:
        return with_connections(diagram(family, curve)) if len(family.spans) == 1 else plane(family, curve)
    except Unclear:
        raise InputError(f"{family.case.place}: undecided: what happens at one value of this range is open "
                         "at any number of bits, where the equations degenerate: divide the range, or move "
                         "its ends") from None


def _of_top(case: Case | str | os.PathLike[str], vary: Mapping[str, Any] | Sequence[tuple[str, Any]],
            curve: bool) -> TopDiagram | None:
    """The diagram of a symmetric top; None of another scene."""
    path, text = place_and_text("bifurcation", case)
    read = read_text(path, text)
    if not is_top(read.scene):
        return None
    if curve:
        raise InputError(f"{read.place}: curve: a top has no curve of equilibria in its rates: take curve "
                         "away")
    return top_diagram(read, _certain(parsed(path, text)[0]), _pairs(vary))


def _certain(data: dict[str, Any]) -> dict[str, Any]:
    """The data of a file without what speaks of its own values."""
    return {key: value for key, value in data.items() if key not in ("sweep", "expect")}


def family_of(case: Case | str | os.PathLike[str],
              vary: Mapping[str, Any] | Sequence[tuple[str, Any]]) -> Family:
    """The scenes over the ranges. Raises InputError for what cannot vary, and for effects that no diagram
    covers."""
    path, text = place_and_text("bifurcation", case)
    read = read_text(path, text)
    data = _certain(parsed(path, text)[0])
    family = Family(read, data, spans_of(data, _pairs(vary)))
    scene = effective(read.scene)
    if not scene.plain:
        others = ", ".join(item.with_article for item in scene.beyond)
        raise InputError(f"{read.place}: a diagram is exact for a body with wheels under a constant torque; "
                         f"this case also has {others}: stabilab sweep --answer equilibria,verdict counts "
                         "there")
    return family


def _pairs(vary: Mapping[str, Any] | Sequence[tuple[str, Any]]) -> list[tuple[str, Any]]:
    try:
        return [(str(name), query) for name, query in (vary.items() if isinstance(vary, Mapping) else vary)]
    except (TypeError, ValueError):
        raise InputError(
            f'vary: expected names and ranges such as {{"torque[3]": "0:0.5"}}, got {vary!r:.80}') from None
