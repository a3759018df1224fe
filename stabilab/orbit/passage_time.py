"""The time at which a motion with one degree of freedom passes a place, in balls.

Under a torque round circles and hyperbolas it is arb's integral (`period.time_between`, `time_from_turn`).
Without one, and on a parabola, W^2 is a quartic: of the offset on a parabola, else of t = tan(y/2) or
tanh(y/2), y from a place between, times (1 - e t^2)^2. The integral between two places is then

    2 R_F(U12^2, U13^2, U14^2),  U_ij = (X_i X_j Y_k Y_l + Y_i Y_j X_k X_l)/(x - y),

X_i and Y_i the roots of the linear factors at both ends (Carlson; DLMF 19.29.4).

A first crossing of a limit that a proof has put between two times (`crossing_time`): its place y is a root of
the quantity less the limit along the orbit, on the stretch between two turning points on which that time
lies. It is the crossing that was enclosed if its time lies within those two, and the quantity has one slope
all along them."""
from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from time import perf_counter
from typing import TYPE_CHECKING, Any

from ..numbers.balls import Unclear, sharpened, sign
from ..numbers.vectors import CYCLE
from ..physics.scene import QuadraticForm
from .extremes import solve, turning_point
from .one_orbit import BallConic, BallOrbit, Orbit
from .period import time_between, time_from_turn

if TYPE_CHECKING:
    from flint import acb, arb


MAX_TURNS = 1000  # of a circle that are climbed against the torque
PLACE_BITS = 192  # of the search for the place of the crossing
# when the time of an integral is said, from that of fewer bits
LONG_DIGITS, TRIAL_BITS, GROWTH = 300, 512, 2.2
TURNS = 2  # stretches between turning points after the first, within one period
STEPS, CLOSE = 100, 2.0**-70  # of the search for the place at a time, and where it ends
WIDER = 4, 64, 4096  # times a root's own width in which a change of sign is looked for
LOST_BITS = 16  # of the coefficients' accuracy, in the roots of a quartic


def heading(orbit: BallOrbit) -> int:
    """In which sense of the offset the motion sets out."""
    return sign(orbit.w) or (1 if orbit.force_here * orbit.flip > 0 else -1)


def squared_rate(orbit: BallOrbit, y: arb) -> arb:
    """W^2 at a place."""
    return 2 * (orbit.energy - orbit.height(y))


def time_at(orbit: BallOrbit, place: arb, turns: int) -> arb:
    """When the motion is at a place for the first time after so many turning points (0, 1 or 2)."""
    ends = [_end(orbit, n) for n in range(turns)]
    if isinstance(orbit, BallConic) and orbit.r.sense:
        before = time_of_turn(orbit, turns - 1) if turns else orbit.energy * 0
        if not turns and not orbit.w.is_zero():
            return time_between(orbit, place)
        return before + time_from_turn(orbit, ends[-1] if turns else before, place)
    stops = [orbit.energy * 0, *ends, place]
    return sum((_by_quartic(orbit, a, b) for a, b in zip(stops, stops[1:])), stops[0])


def turn_ahead(orbit: BallOrbit, turns: int) -> arb | None:
    """The turning point that is the next one after so many; None where the motion never turns."""
    side = heading(orbit) * (-1) ** turns
    end = turning_point(orbit, side)
    return end if end is not None or side > 0 or not orbit.closed or not orbit.r.sense else _uphill(orbit)


def _uphill(orbit: BallOrbit) -> arb:
    """On a circle against the torque, beyond the turn behind: each turn is higher than the one before."""
    turn = 2 * orbit.numbers.pi()
    inner, ahead = orbit.energy * 0, [spot.y for spot in orbit.spots[::-1]]
    for back in range(1, MAX_TURNS):
        for outer in [y - back * turn for y in ahead] or [orbit.energy * 0 - 2**back]:
            if not outer < 0:
                continue
            if sign(orbit.height(outer) - orbit.energy) > 0:
                return solve(orbit, inner, outer)
            inner = outer
    raise Unclear


def time_of_turn(orbit: BallOrbit, turns: int) -> arb:
    """When the motion comes to the turning point after so many before (0 or 1)."""
    zero, ends = orbit.energy * 0, [_end(orbit, n) for n in range(turns + 1)]
    if not (isinstance(orbit, BallConic) and orbit.r.sense):
        return time_at(orbit, ends[-1], turns)
    first = _whole(orbit, zero, ends[0]) if orbit.w.is_zero() else time_from_turn(orbit, ends[0], zero)
    return first + _whole(orbit, *ends) if turns else first


def _end(orbit: BallOrbit, turns: int) -> arb:
    end = turn_ahead(orbit, turns)
    if end is None:
        raise Unclear
    return end


def _whole(orbit: BallConic, one: arb, two: arb) -> arb:
    """From a turning point to the other one."""
    middle = ((one + two) / 2).mid()
    return time_from_turn(orbit, one, middle) + time_from_turn(orbit, two, middle)


def _by_quartic(orbit: BallOrbit, a: arb, b: arb) -> arb:
    """Time between two places, W not zero between them."""
    from flint import acb_poly, arb
    low, high = sorted((a, b), key=lambda y: y.mid())
    if isinstance(orbit, BallConic):
        middle = ((low + high) / 2).mid()
        coefficients, factor = _about(orbit, middle), 2
        tangent = ((lambda y: (y / 2).tan()) if orbit.r.e < 0 else (lambda y: (y / 2).tanh()))
        low, high = tangent(low - middle), tangent(high - middle)
    else:
        f0, f1, f2, f3 = orbit.coefficients
        coefficients, factor = [2 * orbit.energy, 2 * f0, f1, 2 * f2 / 3, f3 / 2], 1
    while coefficients[-1].is_zero():
        coefficients.pop()
    if coefficients[-1].contains(0):
        raise Unclear
    try:
        accuracy = min(c.rel_accuracy_bits() for c in coefficients if not c.is_zero())
        roots = acb_poly(coefficients).roots(tol=arb(2) ** (LOST_BITS - accuracy))
    except ValueError:
        raise Unclear from None
    return factor * carlson(roots, abs(coefficients[-1]), low, high)


def _about(orbit: BallConic, middle: arb) -> list[arb]:
    """Coefficients of W^2 (1 - e t^2)^2, lowest power first."""
    from flint import arb, arb_poly
    (x, z), e = orbit.place(middle), orbit.r.e
    below = arb_poly([1, 0, -e])
    first, second = arb_poly([0, 2 * z, 2 * e * x]), arb_poly([0, 2 * e * x, 2 * e * z])
    result = squared_rate(orbit, middle) * below * below + 2 * (
        first * (orbit.G * arb_poly([x, z]) + orbit.c * below) + e * orbit.d * second * below)
    return [arb(result[n]) for n in range(5)]


def carlson(roots: Sequence[acb], leading: arb, low: arb, high: arb) -> arb:
    """Integral of dt/sqrt of a polynomial of degree four or less that is positive between two places, from
    its roots and the size of its leading coefficient."""
    from flint import acb
    pairs: list[tuple[Any, Any]] = []  # square roots of a factor at both ends
    for root in _conjugate_next(roots):
        if root.imag.is_zero():
            side = _side(root.real, low, high)
            pairs.append(tuple(acb((side * (end - root.real)).nonnegative_part()).sqrt()
                               for end in (high, low)))
        else:
            pairs.append(tuple((acb(end) - root).sqrt() for end in (high, low)))
    pairs += [(acb(1), acb(1))] * (4 - len(pairs))
    (a, p), (b, q), (c, r), (d, s) = pairs
    across = high - low
    u12, u13, u14 = ((i * j * n * o + l * m * k * t) / across for i, l, j, m, k, n, t, o in (
        (a, p, b, q, c, r, d, s), (a, p, c, r, b, q, d, s), (a, p, d, s, b, q, c, r)))
    value = 2 * acb.elliptic_rf(u12 * u12, u13 * u13, u14 * u14).real / leading.sqrt()
    if not value.is_finite():
        raise Unclear
    return value


def _side(root: arb, low: arb, high: arb) -> int:
    """1 where the root lies below both ends, -1 where above; one of them may be the root."""
    middle = (low + high) / 2
    return sign(middle - root)


def _conjugate_next(roots: Sequence[acb]) -> list[acb]:
    """The real ones, each exactly real, then pairs of conjugates."""
    from flint import acb
    real = [acb(root.real) for root in roots if root.imag.contains(0)]
    upper = [root for root in roots if root.imag > 0]
    if len(real) + 2 * len(upper) != len(roots):
        raise Unclear
    return [*(v for root in upper for v in (root, root.conjugate())), *real]


# --- The first crossing of a limit
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


def crossing_time(orbit: Orbit, form: QuadraticForm, parts: Iterable[tuple[Any, Fraction]], low: float,
                  high: float, digits: int, tell: Callable[[float], None] | None = None) -> arb | None:
    """The time of the first crossing, which lies between low and high by a proof, as a ball 10^-digits of it
    wide at most; None where its place is not told from others: where the motion turns, or touches the limit.

    form: of the orbit's scene; parts: (((weight, vector), ...), limit), as of `answers.limit`; tell: is given
    the seconds that a long answer will take.
    """
    wanted = [Along(form, terms, largest) for terms, largest in parts]
    try:
        index = orbit.settled(lambda item: _place(item, wanted, low, high), PLACE_BITS, 16 * PLACE_BITS)
    except Unclear:
        return None
    if index is None:
        return None
    part, rough, turns = index

    def question(item: BallOrbit) -> Any:
        sense = heading(item) * (-1) ** turns
        return time_at(item, _root(item, part, rough, sense), turns)
    if tell is not None and digits > LONG_DIGITS and orbit.reduction.sense:
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
