"""A motion at given times, with its zeros and extremes, to so many digits: enclosed where a wheel and a
torque are all there is, else by Taylor series in two precisions.

Along an enclosed motion each zero and extreme of the rates is proved to be one, and none is passed over. On
an interval where a function's enclosure leaves out zero it has none; where its derivative's does, it has one
at most, and the signs at the ends decide. Any other interval is divided. The rates' own equations give the
derivatives, so that no error is differentiated."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from ..errors import InputError
from ..integrate.guard import too_far
from ..integrate.reference import GUARD, Recursion, one_run
from ..numbers.balls import narrowed, working
from ..numbers.vectors import dot
from ..physics.coefficients import effective
from ..physics.own_unit import exact_unit
from ..physics.scene import AnyScene, QuadraticForm, hold_on
from ..physics.states import equations_and_start
from ..reasons import Quantity, Reason, Reasoned, Sentence, chained
from .digits_asked import MOST_DECIMALS, checked_digits
from .limit import flow_of

ZEROS_ENCLOSED = Sentence(
    "zeros-enclosed", "zeros and extremes of each rate after the start, by roots along the enclosed motion: "
    "none is passed over (below {least} counts as zero)")
OPEN_ZEROS = Sentence("zeros-open", "but where the digits leave open whether there is one ({places})")
OPEN_ZERO = Sentence("open-zero", "{component}, {what}, about {time}")
AND_SO_ON = Sentence("and-so-on", "and so on")()
NOT_LOOKED_FOR = Sentence("events-not-looked-for", "not asked for")()
EVENTS_NEED = Sentence(
    "events-need-enclosure", "events are found where a wheel and a constant torque are all that acts, as "
    "their enclosure needs")()
SERIES_ENCLOSED = Sentence("series-enclosed",
                           "Taylor series in integers with a proved bound of their error")()
PROVED_UP_TO = Sentence("proved-up-to", "proved up to {time}: {beyond}")
BITS_SPENT = Sentence("bits-spent", "beyond, the motion is too sensitive for {bits} bits")
WORK_SPENT = Sentence("work-spent", "the work allowed goes no further")()
BEYOND = Sentence("enclosure-ends", "beyond, {why}")
SERIES_AGREE = Sentence("series-agree",
                        "Taylor series in {fewer} and {more} digits agree; no bound is proved")
ONLY_UP_TO = Sentence("only-up-to", "only up to {time}")


# --- A motion in many digits and how well each of them is known
PROVED, TWICE = "proved", "two precisions agree"


@dataclass(frozen=True)
class Event:
    """A zero, a least or a greatest value of a rate: kind "zero", "least" or "greatest", of which component
    (0 to 2), time and value as balls."""

    kind: str
    component: int
    t: Any
    value: Any


@dataclass(frozen=True)
class Tabulated(Reasoned):
    """States (balls) at times, each within 10^-digits of the largest rate (or of the largest number of its
    kind), as `level` says: PROVED or TWICE.

    t: the times that were reached, of all that were asked for where `reached`; reason: how, or why the run
    ended. events: in order of time, those after the start; events_reason: how they were found, or what is
    left out.
    """

    t: tuple[Fraction, ...]
    states: tuple[tuple[Any, ...], ...]
    components: tuple[str, ...]
    digits: int
    level: str
    reached: bool
    events: tuple[Event, ...]
    events_reason: Reason

    @property
    def events_because(self) -> str:
        """How the events were found, in words and SI units."""
        return self.events_reason.text()


MOST_BOXES = 500  # of a piece and a function
UNEVEN = Fraction(4871, 10000)  # where intervals are divided, lest a symmetric motion's root be met
# digits below the motion's own size: a rate, or its derivative, that stays so small over a piece counts as
# zero there
NOTHING = 25
# bits beyond the digits; most of a run, for its bound of the error is formed in doubles
SPARE, MOST_BITS = 12, 900
WORK = 40_000_000  # multiplications of a run
SETTLED = 20  # the share of it that shows a motion's pace
MORE_DIGITS = 14  # of the second run of two


def events_of(scene: AnyScene, pieces: Sequence[Any], until: Fraction
              ) -> tuple[tuple[Event, ...], Reason]:
    """(events after the start in order of time, how they were found). To be called with more than
    enough bits at work."""
    rows, open_at, form = [], [], scene.quadratic()
    names = scene.components
    for number, piece in enumerate(pieces):
        curve = _Curve(piece, form)
        for i in range(3):
            for order, kind in enumerate(("zero", "extreme")):
                roots, clear = _roots(curve, i, order, number == 0)
                if not clear:
                    open_at.append(OPEN_ZERO(component=names[i], what=kind,
                                             time=Quantity(float(piece.start), scene.time_unit, 4)))
                rows += [_event(curve, i, kind, s) for s in roots]
    rows = [item for item in rows if item.t <= _ball(until)]
    reason = ZEROS_ENCLOSED(least=Quantity(10.0**-NOTHING))
    if places := chained(*open_at[:3]):
        places = places.then(AND_SO_ON if len(open_at) > 3 else None, " ")
        reason = reason.then(OPEN_ZEROS(places=places), ", ")
    return tuple(sorted(rows, key=lambda item: item.t.mid())), reason


def _event(curve: _Curve, i: int, kind: str, s: Any) -> Event:
    from flint import arb
    value, bend = curve.derivative(i, 0, s), curve.derivative(i, 2, s)
    if kind == "extreme":
        kind = "least" if bend > 0 else "greatest" if bend < 0 else "extreme"
    return Event(kind, i, _ball(curve.piece.start) + s * _ball(curve.piece.length),
                 arb(0) if kind == "zero" else value)


def _ball(value: Any) -> Any:
    from flint import arb, fmpq
    return arb(fmpq(value.numerator, value.denominator))


class _Curve:
    """Rates over a piece and their derivatives in time, by the equations in balls."""

    def __init__(self, piece: Any, form: QuadraticForm) -> None:
        self.piece, self.size = piece, _ball(Fraction(piece.unit))
        balls = lambda row: tuple(_ball(Fraction(v)) for v in row)
        self.form = QuadraticForm(balls(form.kappa), balls(form.rho), balls(form.sigma), balls(form.m))

    def derivative(self, i: int, order: int, s: Any) -> Any:
        """The `order`-th derivative (0 to 2) of component i at s, a ball."""
        x = self.piece.at(s)
        if order == 0:
            return x[i]
        rate = self.form.rate(x)
        return rate[i] if order == 1 else dot(self.form.jacobian(x)[i], rate)


def _roots(curve: _Curve, i: int, order: int, first: bool) -> tuple[list[Any], bool]:
    """(balls of s, whether all of the piece is clear) of the zeros of a derivative. first: the piece begins
    at the start, whose own zero does not count."""
    from flint import arb
    full = lambda n: curve.derivative(i, n, arb(0.5, 0.5))
    if full(order).abs_upper() < curve.size ** (order + 1) * arb(10) ** -NOTHING:
        return [], True  # a rate that is zero, or constant, throughout
    left, boxes = [(Fraction(0), Fraction(1))], 0
    result: list[Any] = []
    while left:
        a, b = left.pop()
        boxes += 1
        box = _ball(a).union(_ball(b))
        if 0 not in curve.derivative(i, order, box):
            continue
        if 0 not in curve.derivative(i, order + 1, box):
            low, high = (curve.derivative(i, order, _ball(end)) for end in (a, b))
            if first and a == 0 and 0 in low:
                continue
            if 0 in low or 0 in high:
                return result, False
            if (low > 0) != (high > 0):
                slope = lambda s: curve.derivative(i, order + 1, s) * _ball(curve.piece.length)
                result.append(narrowed(lambda s: curve.derivative(i, order, s), slope, box))
        elif boxes > MOST_BOXES:
            return result, False
        else:
            middle = a + (b - a) * UNEVEN
            left += [(a, middle), (middle, b)]
    return result, True


def tabulated(scene: AnyScene, start: Sequence[Any], exact: Sequence[Fraction], times: Sequence[Fraction],
              digits: int = 30, work: int | None = None, events: bool = True) -> Tabulated:
    """The motion at increasing times from 0 on. start: all of the state; exact: its first three components,
    as they are meant; work: multiplications of a run at most; events: look for them."""
    work = work or WORK
    checked_digits(digits, MOST_DECIMALS)
    if not times or times[0] < 0:
        raise InputError("times: expected times from 0 on, at least one")
    twin = effective(scene)
    if not twin.plain:
        return _twice(scene, start, exact, times, digits, work)
    result = _enclosed(twin, list(map(Fraction, exact)), times, digits, work, events)
    if result.t:
        return result
    again = _twice(twin, list(map(float, exact)), exact, times, digits, work)
    return again if again.t else result


def _enclosed(scene: AnyScene, start: Sequence[Fraction], times: Sequence[Fraction], digits: int, work: int,
              request: bool) -> Tabulated:
    """By as many bits as the digits take, while the motion lets that many be enough."""
    need = int(digits * 3.33) + SPARE
    bits, best = need + 40, None
    while True:
        now = _attempt(scene, start, times, digits, bits, work)
        best = now if best is None or now[0] >= best[0] else best
        if now[0] == len(times) or bits >= MOST_BITS or now[3] not in ("", "bits"):
            break
        bits = min(MOST_BITS, max(bits + 60, now[4] + need))
    count, states, pieces, why, _ = best
    reached = count == len(times)
    with working(MOST_BITS):
        events, how = (events_of(scene, pieces, times[count - 1] if count else Fraction(0)) if request
                       else ((), NOT_LOOKED_FOR))
    last = Quantity(float(times[count - 1]) if count else 0.0, scene.time_unit).lower
    reason = SERIES_ENCLOSED if reached else PROVED_UP_TO(time=last, beyond=(
        BITS_SPENT(bits=MOST_BITS) if why == "bits" else WORK_SPENT if why == "work" else BEYOND(why=why)))
    return Tabulated(tuple(times[:count]), tuple(states[:count]), tuple(scene.components), digits, PROVED,
                     reached, events, how, reason=reason)


def _attempt(scene: AnyScene, start: Sequence[Fraction], times: Sequence[Fraction], digits: int, bits: int,
             work: int) -> Any:
    """(how many times were reached to the digits, states, pieces with their unit, why it ended, bits that the
    error grew by)."""
    from flint import arb
    unit = exact_unit(scene, start)
    flow = flow_of(scene, start, bits, unit)
    states: list[tuple[Any, ...]] = []
    pieces: list[Polynomials] = []
    why = ""
    with working(bits + 64) as numbers:
        small = arb(10) ** -digits
        while len(states) < len(times) and not why:
            try:
                piece = flow.step()
            except OverflowError as error:
                why = str(error)
                break
            row = Polynomials(piece, unit, numbers)
            pieces.append(row)
            while len(states) < len(times) and times[len(states)] * unit <= flow.now:
                values = row.at(numbers.ball((times[len(states)] * unit - piece.start) / piece.length))
                if any(numbers.ball(0) + v.rad() > small * max(map(abs, values), key=lambda v: v.mid())
                       for v in values):
                    why = "bits"
                    break
                states.append(tuple(values))
            ahead = times[len(states)] * unit - flow.now if len(states) < len(times) else Fraction(0)
            done = flow.work > work or _too_far(flow.work, work, len(pieces), ahead / piece.length)
            why = why or ("work" if done else "bits" if flow.error.bit_length() > bits - 8 else "")
    return len(states), states, pieces, why, flow.error.bit_length()


def _too_far(done: int, work: int, steps: int, left: Fraction) -> bool:
    """Whether the next time, so many steps ahead, is farther than the work allowed comes by far."""
    allowed = work * steps / done
    return too_far(steps, float(min(left, Fraction(10) ** 30)), allowed, allowed / SETTLED)


class Polynomials:
    """A piece as polynomials in s from 0 to 1, in the scene's own variables: start and length in the scene's
    time, exact; rows with their radii; unit: the size of the motion's rates."""

    def __init__(self, piece: Any, unit: Fraction, numbers: Any) -> None:
        from flint import arb, arb_poly
        scale = numbers.ball(unit) * arb(2) ** -piece.bits
        self.start, self.length, self.unit = piece.start / unit, piece.length / unit, unit
        self.rows = [arb_poly([arb(c) * scale for c in row]) for row in piece.rows]
        self.radii = [arb(0, radius) * scale for radius in piece.radii]

    def at(self, s: Any) -> list[Any]:
        """The components at s, a ball of numbers from 0 to 1."""
        return [row(s) + radius for row, radius in zip(self.rows, self.radii)]


def _twice(scene: AnyScene, start: Any, exact: Any, times: Sequence[Fraction], digits: int,
           work: int) -> Tabulated:
    """By two runs of different precision, as far as they agree."""
    equations, row = equations_and_start(scene, start)
    hold_on(scene, float(times[-1]), "reference")
    begin = [*exact, *map(float, row[3:])]
    recursion, budget = Recursion(equations), [work]
    runs = [one_run(recursion, begin, times, digits + more, budget)[0]
            for more in (GUARD, GUARD + MORE_DIGITS)]
    components = tuple(map(str, equations.state))
    with working(int((digits + GUARD + MORE_DIGITS) * 3.33)) as numbers:
        states: list[tuple[Any, ...]] = []
        for low, high in zip(*runs):
            size = max(map(abs, high), key=lambda v: v.mid())
            gap = max((abs(a - b) for a, b in zip(low, high)), key=lambda v: v.mid())
            if not gap < size * numbers.ball(10) ** -digits:
                break
            states.append(tuple(numbers.around(v, gap) for v in high))
    reached = len(states) == len(times)
    reason = SERIES_AGREE(fewer=digits + GUARD, more=digits + GUARD + MORE_DIGITS)
    if not reached:
        last = float(times[len(states) - 1]) if states else 0.0
        reason = reason.then(ONLY_UP_TO(time=Quantity(last, scene.time_unit).lower))
    return Tabulated(tuple(times[:len(states)]), tuple(states), components, digits, TWICE, reached, (),
                     EVENTS_NEED, reason=reason)
