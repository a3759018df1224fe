"""What is known of how a motion turns in space."""
from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from ...numbers.balls import START_BITS, Unclear, settled
from ...numbers.vectors import Float3, dot
from ...orbit.result import Fate
from ...physics.symmetric_top import TopRates
from ...reasons import Reasoned, Sentence
from ...representation import Answer

if TYPE_CHECKING:
    from flint import arb

LONG, SHORT, SEPARATRIX, STEADY, TOP = "long-axis", "short-axis", "separatrix", "steady", "heavy top"
FIELD_TOP = "top in a field"

CLOSED_ERROR = 1e-15  # relative, of numbers from balls


@dataclass(frozen=True, repr=False)
class Attitude(Answer, Reasoned):
    """How one motion turns in space; vectors along the principal axes of the scene.

    mode: "long-axis" or "short-axis" (which the angular momentum goes round, seen from the body; without a
    torque), "heavy top", "top in a field", "separatrix", "steady", or None. rotation_period: of the rates, s;
    of a steady rotation, of a turn. precession_period: mean, of that axis about the angular momentum, s.
    momentum: |H| at the start, N m s; momentum_direction: unit vector along it at the start. cone: (least,
    greatest) angle between the axis, in the direction that is nearer, and the angular momentum over all time,
    rad. Of a top precession_period is that of its axis about the vertical; lean: (least, greatest) angle
    between the upward vertical and the direction from its fixed point to its centre of mass, rad;
    nutation_period: from one least lean to the next, s; top: its rates of steady precession at the lean of
    the start, and the spins at which it stays upright.
    turn_angle (rad, 0 to pi), turn_axis: the rotation that takes the attitude at the start to that one
    rotation period later; the axis is the same in body and space. What the motion does not have is None,
    and `reason` says why. error: relative, of the periods and the turn.
    decimals: where digits were asked for, the periods by name, s, written out to them.
    caveats: all that limits the answer.
    """

    at: Float3
    fate: Fate
    mode: str | None
    momentum: float
    momentum_direction: Float3 | None
    rotation_period: float | None = None
    precession_period: float | None = None
    cone: tuple[float, float] | None = None
    lean: tuple[float, float] | None = None
    nutation_period: float | None = None
    turn_angle: float | None = None
    turn_axis: Float3 | None = None
    error: float | None = None
    decimals: Mapping[str, str] | None = None
    top: TopRates | None = None


BODY_AT_REST = Sentence("body-at-rest", "the body is at rest")()
TURNS_STEADILY = Sentence("turns-steadily", "the body turns steadily about one axis")()
ROUND_AXIS = Sentence(
    "momentum-round-axis", "no torque: the angular momentum goes round the {axis} axis in the body")


def narrow(ball: arb, digits: int | None = None) -> Any:
    """The ball; raises Unclear where it is too wide for a double, or for so many digits."""
    if not ball.is_finite() or ball.rel_accuracy_bits() < max(54, int(3.33 * ((digits or 0) + 2))):
        raise Unclear
    return ball


def bits_of(digits: int | None) -> int:
    """Bits in which a formula for so many digits is tried first."""
    return START_BITS + int(3.33 * (digits or 0))


def with_periods(result: Attitude, periods: Mapping[str, Any], digits: int | None) -> Attitude:
    """With these periods, balls (or None) by the names of their fields, written out where digits are asked
    for."""
    info = {name: ball for name, ball in periods.items() if ball is not None}
    values: dict[str, Any] = {name: float(ball.mid()) for name, ball in info.items()}
    if digits is not None:
        values["decimals"] = {name: ball.mid().str(digits + 1, radius=False) for name, ball in info.items()}
    return replace(result, **values, error=CLOSED_ERROR)


def steady(base: Attitude, omega: Sequence[Fraction], digits: int | None) -> Attitude:
    """Of rates that stay as they are."""
    if not any(omega):
        return replace(base, mode=STEADY, reason=BODY_AT_REST)
    turn = settled(lambda numbers: narrow(2 * numbers.pi() / numbers.ball(dot(omega, omega)).sqrt(), digits),
                   bits_of(digits))
    return with_periods(replace(base, mode=STEADY, reason=TURNS_STEADILY),
                        {"rotation_period": turn}, digits)


def turned(result: Attitude, turns: float) -> Attitude:
    """With the turn after one period about the angular momentum, whose whole turns do not count."""
    angle = 2 * math.pi * (turns - round(turns))
    h = result.momentum_direction or (0.0, 0.0, 0.0)
    return replace(result, turn_angle=abs(angle), turn_axis=tuple(math.copysign(1, angle) * v for v in h))
