"""The rates at a start that is stated as it is observed: by the periods of a tumbling body, or by spin and
nutation.

A free body without wheels, D_c the moment farthest from D_a, that of the axis a which the angular momentum H
goes round (the long axis has the least moment, the short axis the greatest), D_b the intermediate one. Let
theta be the greatest angle between a and H, f = sin^2 theta. With |H| = 1

    2 T = 1/D_a + f (1/D_b - 1/D_a),
    omega_a^2 = (1 - 2T D_c)/(D_a (D_a - D_c)),  omega_c^2 = (1 - 2T D_a)/(D_c (D_c - D_a)),  omega_b = 0

at a start where a is nearest to H; the periods are those of Jacobi's solution (Landau & Lifshitz, Mechanics,
section 37; `answers.attitude` has it in these letters). The ratio of the rotation period to the precession
period grows with f, from

    r0 = ((D_b D_c)/((D_c - D_a)(D_b - D_a)))^(1/2) D_a/D_a -+ 1   (- long axis, + short axis)

of a small nutation to infinity at the separatrix; so two periods, or one and theta, say all but the phase.

Spin s about a unit vector e, and the angle nu from e to H = D omega + lambda, which leans towards a unit
vector b across e: H = h (cos nu e + sin nu b), and e . omega = s gives h."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from ..errors import InputError
from ..numbers.balls import Digits, working
from ..numbers.exact import precise, sqrt_fraction
from ..numbers.vectors import Exact3, dot

MODES = ("long-axis", "short-axis")
BITS = 320  # of what is formed of elliptic integrals
FOUND = Fraction(1, 1 << 180)  # of f, to which it is found
NEAREST = Fraction(1, 10**12)  # of 1 - f: nearer to the separatrix doubles tell nothing
STEPS = 400


class Tumbling(NamedTuple):
    """rates: exact, along the principal axes; mode: one of MODES."""

    rates: Exact3
    mode: str


def tumbling(D: Exact3, rotation: Fraction | None, precession: Fraction | None, amplitude: Fraction | None,
             mode: str | None = None) -> Tumbling:
    """The rates (rad/s) of a free body of moments D with two of these: its rotation period and its precession
    period, s, and the greatest angle between the axis that the angular momentum goes round and the angular
    momentum, rad. mode: None where the moments and the periods decide it.

    Raises InputError for what no motion has, with the range that the moments allow; its first word is the key
    that is at fault, where one is.
    """
    if D[0] == D[1] == D[2]:
        raise InputError("all moments are equal, so that the body turns steadily and has no precession: give "
                         "angular_velocity")
    bodies = [_Body(D, name) for name in ((mode,) if mode else MODES)]
    possible = [body for body in bodies if body.exists]
    if not possible:
        raise InputError(f"mode: the body has two equal moments, and no {mode} motion: give mode = "
                         f'"{MODES[1 - MODES.index(mode or MODES[0])]}"')
    if amplitude is None and rotation is not None and precession is not None:
        ratio = rotation / precession
        fitting = [body for body in possible if ratio > body.least]
        if not fitting:
            allowed = ", and ".join(f"less than {_seconds(rotation / body.least)} in {body.mode} mode"
                                    for body in possible)
            raise InputError("precession_period: no motion of this body has a precession period of "
                             f"{_seconds(precession)} beside a rotation period of {_seconds(rotation)}: the "
                             f"moments allow {allowed}")
        possible = fitting
    if len(possible) > 1:
        raise InputError('a long-axis and a short-axis motion have these numbers: add mode = "long-axis" or '
                         '"short-axis"')
    body, = possible
    part = body.share_of(rotation / precession) if amplitude is None and rotation and precession else (
        1 - precise("cos", amplitude or Fraction(0)) ** 2)
    if 1 - part < NEAREST:
        raise InputError("the motion would be within 1e-12 of the separatrix, where it takes for ever")
    unit = body.periods(part)  # with |H| = 1
    momentum = unit[0] / rotation if rotation is not None else unit[1] / (precession or Fraction(1))
    return Tumbling(tuple(momentum * v for v in body.rates(part)), body.mode)


def _seconds(value: Any) -> str:
    return f"{float(value):.10g} s"


class _Body:
    """The moments of a mode: a, b, c as in the module's text, and the axes they belong to."""

    def __init__(self, D: Exact3, mode: str) -> None:
        order = sorted(range(3), key=lambda i: D[i])
        self.mode, self.long = mode, mode == MODES[0]
        self.axes = order if self.long else order[::-1]
        self.a, self.b, self.c = (D[i] for i in self.axes)

    @property
    def exists(self) -> bool:
        """Whether there is such a motion: not of an axis that another shares its moment with."""
        return self.a != self.b

    @property
    def least(self) -> Fraction:
        """r0."""
        a, b, c = self.a, self.b, self.c
        return sqrt_fraction(b * c / ((c - a) * (b - a))) + (-1 if self.long else 1)

    def _twice(self, part: Fraction) -> Fraction:
        return 1 / self.a + part * (1 / self.b - 1 / self.a)

    def _squares(self, part: Fraction) -> tuple[Fraction, Fraction]:
        """omega_a^2 and omega_c^2 of |H| = 1."""
        a, c, T2 = self.a, self.c, self._twice(part)
        return (1 - T2 * c) / (a * (a - c)), (1 - T2 * a) / (c * (c - a))

    def rates(self, part: Fraction) -> Exact3:
        """Of |H| = 1, where a is nearest to H."""
        result = [Fraction(0)] * 3
        result[self.axes[0]], result[self.axes[2]] = map(sqrt_fraction, self._squares(part))
        return tuple(result)

    def periods(self, part: Fraction) -> tuple[Fraction, Fraction]:
        """(rotation, precession) of |H| = 1, to some 300 bits."""
        with working(BITS) as numbers:
            rotation, rate = self._in_balls(numbers, part)
            return tuple(Fraction(int(v.p), int(v.q))  # type: ignore[return-value]
                         for v in (item.mid().fmpq() for item in (rotation, 2 * numbers.pi() / rate)))

    def _in_balls(self, numbers: Digits, part: Fraction) -> tuple[Any, Any]:
        """(rotation period, mean precession rate) of |H| = 1."""
        a, b, c, T2 = self.a, self.b, self.c, self._twice(part)
        square, _ = self._squares(part)
        m = 1 - (1 - T2 * b) / (a * (a - b)) / square
        speed = square * (c - a) * (b - a) / (b * c)
        across = 1 - a * a * square
        ball = numbers.ball
        full, third = numbers.elliptic(ball(-m * a * a * square / across), ball(m))
        return (4 * full / ball(speed).sqrt(),
                (1 - ball((1 - T2 * a) / across) * third / full) / ball(a))

    def share_of(self, ratio: Fraction) -> Fraction:
        """f of a ratio of the periods above `least`; 1 where it is nearer to the separatrix than NEAREST."""
        def excess(part: Fraction) -> Fraction:
            with working(BITS) as numbers:
                rotation, rate = self._in_balls(numbers, part)
                value = (rotation * rate / (2 * numbers.pi()) - numbers.ball(ratio)).mid().fmpq()
            return Fraction(int(value.p), int(value.q))
        high = 1 - NEAREST
        if excess(high) < 0:
            return Fraction(1)
        return _root(excess, high)


def _root(height: Callable[[Fraction], Fraction], high: Fraction) -> Fraction:
    """The root in (0, high] of a function that rises from below zero: false position with halved ends, and a
    middle where that is slow."""
    low, below, above = Fraction(0), None, height(high)
    step = Fraction(1, 2)
    while below is None:  # at 0 itself the nutation is none
        at = high * step
        value = height(at)
        if value < 0:
            low, below = at, value
        else:
            high, above, step = at, value, step * step
        if high < FOUND:
            return high
    for n in range(STEPS):
        at = (low + high) / 2 if n % 3 == 2 else (low * above - high * below) / (above - below)
        at = Fraction(round(at * (1 << 256)), 1 << 256)
        value = height(at)
        if not value or high - low < FOUND * high:
            return at
        if value < 0:
            above = above / 2 if low != at and n % 3 == 1 else above
            low, below = at, value
        else:
            below = below / 2 if n % 3 == 1 else below
            high, above = at, value
    return (low + high) / 2


def spinning(D: Exact3, wheel: Exact3, axis: Sequence[Fraction], spin: Fraction, nutation: Fraction,
             towards: Sequence[Fraction]) -> Exact3:
    """The rates (rad/s) whose component along a unit vector is `spin`, and whose angular momentum is at the
    angle `nutation`, rad, from it, leaning towards another vector; all along the principal axes.

    Raises InputError where there is none.
    """
    along = dot(towards, axis)
    across = tuple(t - along * a for t, a in zip(towards, axis))
    size = sqrt_fraction(dot(across, across))
    if not size:
        raise InputError("towards: it lies along the axis; give a direction across it")
    cosine = precise("cos", nutation)
    sine = sqrt_fraction(max(Fraction(0), 1 - cosine * cosine))
    direction = tuple(cosine * a + sine * b / size for a, b in zip(axis, across))
    gained = dot(axis, tuple(h / d for h, d in zip(direction, D)))
    wanted = spin + dot(axis, tuple(l / d for l, d in zip(wheel, D)))
    if not gained or wanted / gained <= 0:
        return _no_such_spin(D, wheel, axis, across, size, wanted)
    momentum = wanted / gained
    return tuple((momentum * h - l) / d for h, l, d in zip(direction, wheel, D))


def _no_such_spin(D: Exact3, wheel: Exact3, axis: Sequence[Fraction], across: Sequence[Fraction],
                  size: Fraction, wanted: Fraction) -> Exact3:
    """Raises InputError with the nutation angles that there are."""
    from math import atan2, degrees
    if not wanted:
        raise InputError("spin: with this spin and these wheels there is no angular momentum along the axis: "
                         "give angular_velocity")
    # e . D^-1 (cos nu e + sin nu b), of the sign of the momentum wanted, vanishes at the end of the range
    one = float(dot(axis, tuple(a / d for a, d in zip(axis, D))))
    other = float(dot(axis, tuple(b / d for b, d in zip(across, D))) / size)
    edge = degrees(atan2(one, -other))
    allowed = f"from 0 to {edge:.6g} deg" if wanted > 0 else f"from {edge:.6g} to 180 deg"
    raise InputError(f"nutation: with this spin the angular momentum is at an angle {allowed} from the axis")
