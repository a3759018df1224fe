"""The time at which a limit is reached, to many digits: where a motion has one degree of freedom, from the
place of the crossing that a proof has enclosed.

The crossing that is first is known between two times by a proof in integers (`limit.enclosed`). Its place y
is a root of the quantity less the limit along the orbit, on the stretch between two turning points on which
that time lies; the time of the place is a formula (`orbit.passage_time`). It is the crossing that was
enclosed if it lies within those times and the quantity has one slope all along them."""
from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from time import perf_counter
from typing import TYPE_CHECKING, Any

from ..errors import InputError, ToleranceNotMet
from ..numbers.balls import Unclear, sharpened
from ..numbers.vectors import CYCLE, Exact3
from ..orbit.landscape import landscape
from ..orbit.one_orbit import BallOrbit, Orbit
from ..orbit.passage_time import heading, squared_rate, time_at, time_of_turn, turn_ahead
from ..physics.coefficients import effective
from ..physics.scene import AnyScene, QuadraticForm
from .digits_asked import MOST_DIGITS, checked_digits
from .limit import Limit, asked
from .passage import TimeTo

if TYPE_CHECKING:
    from flint import arb

    from ..case.read import Case

PLACE_BITS = 192  # of the search for the place of the crossing
# when the time of an integral is said, from that of fewer bits
LONG_DIGITS, TRIAL_BITS, GROWTH = 300, 512, 2.2
TURNS = 2  # stretches between turning points after the first, within one period
STEPS, CLOSE = 100, 2.0**-70  # of the search for the place at a time, and where it ends
WIDER = 4, 64, 4096  # times a root's own width in which a change of sign is looked for


@dataclass(frozen=True)
class Along:
    """A quantity less its limit along the orbit of one motion: sum c (a . omega)^2 - most."""

    form: QuadraticForm
    terms: Any
    largest: Fraction

    def value(self, orbit: BallOrbit, y: arb, sense: int) -> tuple[arb, arb]:
        """(it, its rate) at a place passed in this sense."""
        ball, r = orbit.numbers.ball, orbit.r
        omega: list[Any] = [None] * 3
        omega[r.j], omega[r.k] = orbit.components(y)
        omega[r.axis] = orbit.component_i(sense * squared_rate(orbit, y).nonnegative_part().sqrt())
        f = self.form
        rates = [ball(f.kappa[i]) * omega[j] * omega[k] + ball(f.rho[i]) * omega[k]
                 + ball(f.sigma[i]) * omega[j] + ball(f.m[i]) for i, (j, k) in enumerate(CYCLE)]
        total, slope = -ball(self.largest), ball(0)
        for c, vector in self.terms:
            along = sum((ball(a) * w for a, w in zip(vector, omega)), ball(0))
            change = sum((ball(a) * w for a, w in zip(vector, rates)), ball(0))
            total, slope = total + ball(c) * along * along, slope + 2 * ball(c) * along * change
        return total, slope


def with_digits(case: Case, result: TimeTo, ask: dict[str, Any], digits: int,
                tell: Callable[[float], None] | None = None) -> TimeTo:
    """The answer for one motion of a case with its time to 1 to 10,000 digits, every one proved, as
    `decimals`; as it is where the limit is not known to be reached, or is at the start. tell: is given the
    seconds that a long answer will take. InputError where no formula gives the time, ToleranceNotMet where
    the first crossing is known by a run alone."""
    checked_digits(digits, MOST_DIGITS)
    low, high = float(result.low), float(result.high)
    if not 0 < high < math.inf:
        return result
    if result.level != "proved":
        raise ToleranceNotMet(f"when: {digits} digits asked for, and which crossing is the first is not "
                              f"proved ({result.reason}); leave the digits out")
    ball = crossing_time(case.scene, tuple(case.exact_state or map(Fraction, case.state)),
                         asked(case.scene, **ask), low, high, digits, tell)
    return replace(result, decimals=ball.mid().str(digits + 1, radius=False))


def crossing_time(scene: AnyScene, state: Exact3, limit: Limit, low: float, high: float, digits: int,
                  tell: Callable[[float], None] | None = None) -> arb:
    """The time of the first crossing, which lies between low and high by a proof, as a ball 10^-digits of it
    wide at most. tell: as of `with_digits`."""
    twin = effective(scene)
    land = landscape(twin) if twin.plain else None
    if land is None or limit.kind == "tilt":
        raise InputError("digits: the time to this limit has no formula, the motion is followed (a formula "
                         "gives that to a rate or an energy, without a torque or with one on a principal "
                         "axis); leave the digits out: the two times of the answer have up to 15")
    orbit, form = Orbit(land.reduction, state), twin.quadratic()
    parts = [Along(form, terms, largest) for terms, largest in limit.parts]
    try:
        places = orbit.settled(lambda item: _place(item, parts, low, high), PLACE_BITS, 16 * PLACE_BITS)
    except Unclear:
        places = None
    if places is None:
        raise ToleranceNotMet(f"when: {digits} digits asked for: the crossing lies where the motion turns, "
                              "or touches the limit, or beyond a period; leave the digits out")
    part, rough, turns = places

    def question(item: BallOrbit) -> Any:
        sense = heading(item) * (-1) ** turns
        return time_at(item, _root(item, part, rough, sense), turns)
    if tell is not None and digits > LONG_DIGITS and land.sense:
        begun = perf_counter()
        orbit.settled(question, TRIAL_BITS)
        tell((perf_counter() - begun) * (3.33 * digits / TRIAL_BITS) ** GROWTH)
    return sharpened(orbit.settled, question, digits)


def _place(orbit: BallOrbit, parts: list[Along], low: float, high: float) -> tuple[Along, Any, int] | None:
    """(the part that reaches its limit, its place, turning points before) of the crossing between two times;
    None where it is not told from others."""
    from flint import arb
    for turns in range(TURNS + 1):
        end = turn_ahead(orbit, turns)
        if end is not None and turns < TURNS and time_of_turn(orbit, turns).upper() < arb(low):
            continue
        sense = heading(orbit) * (-1) ** turns
        rough = _at_time(orbit, arb(low) / 2 + arb(high) / 2, turns, end, sense)
        rate = squared_rate(orbit, rough).nonnegative_part().sqrt()
        near = arb(0, (2 * rate * (arb(high) - arb(low))).abs_upper())
        for part in parts:
            if not part.value(orbit, rough + near, sense)[0].contains(0):
                continue
            place = _root(orbit, part, rough, sense)
            time = time_at(orbit, place, turns)
            within = time.upper() >= arb(low) and time.lower() <= arb(high)
            rises = part.value(orbit, place + near, sense)[1] > 0
            return (part, place.mid(), turns) if within and rises else None
        return None
    return None


def _at_time(orbit: BallOrbit, time: Any, turns: int, end: Any, sense: int) -> Any:
    """The place at a time, to doubles, on the stretch after so many turning points: Newton's method in a
    bracket."""
    start = turn_ahead(orbit, turns - 1).mid() if turns else orbit.energy.mid() * 0
    far = end.mid() if end is not None else start + sense
    while end is None and time_at(orbit, far, turns) < time:
        far = (start + 2 * (far - start)).mid()
    a, b, y = start, far, ((start + far) / 2).mid()
    for _ in range(STEPS):
        late = time_at(orbit, y, turns) - time
        if late.contains(0):
            break
        a, b = (a, y) if late > 0 else (y, b)
        new = (y - sense * late * squared_rate(orbit, y).nonnegative_part().sqrt()).mid()
        if not min(a, b) < new < max(a, b):
            new = ((a + b) / 2).mid()
        done, y = abs(new - y) <= abs(b - a) * CLOSE or abs(new - y) <= abs(y) * CLOSE, new
        if done:
            break
    return y


def _root(orbit: BallOrbit, part: Along, rough: Any, sense: int) -> arb:
    """The place of the crossing by Newton's method in the rate, as a ball with a change of sign."""
    from flint import arb, ctx
    y = arb(rough).mid()
    for _ in range(64):
        value, slope = part.value(orbit, y, sense)
        rate = sense * squared_rate(orbit, y).sqrt()
        if value.contains(0) or not abs(slope) > 0 or not abs(rate) > 0:
            break
        new = (y - value * rate / slope).mid()
        if new == y or abs(new - y) < abs(y) * arb(2) ** (2 - ctx.prec):
            break
        y = new
    value, slope = part.value(orbit, y, sense)
    if not slope > 0 or not squared_rate(orbit, y) > 0:
        raise Unclear
    reach = (abs(value) + arb(value.rad())) * squared_rate(orbit, y).sqrt() / slope
    for times in WIDER:
        width = arb((times * reach).abs_upper())
        before, after = (part.value(orbit, y + side * width, sense)[0] for side in (-sense, sense))
        if before < 0 < after:
            return arb(y, width)
    raise Unclear
