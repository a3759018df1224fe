"""How a body turns in space: rotation and precession periods, angular momentum, the turn after one period;
the nutation and mean precession of a heavy symmetric top.

Without a torque the angular momentum H = D omega + lambda is fixed in space. Seen from the body it goes round
the long axis (least moment) or the short axis (greatest moment) once in a rotation period, the period of the
rates, while that axis precesses about H at the mean rate

    < (omega.h - (omega.e)(e.h))/(1 - (e.h)^2) >,    h = H/|H|, e the axis.

Of a body without wheels that is Jacobi's solution (Landau & Lifshitz, Mechanics, section 37): with a the axis
that H goes round, c the other one with an extreme moment, b the intermediate axis, u = lambda t,

    omega_a = A dn(u, m),  A^2 = (H^2 - 2T D_c)/(D_a (D_a - D_c))
    lambda^2 = A^2 (D_c - D_a)(D_b - D_a)/(D_b D_c),  rotation period = 4 K(m)/lambda
    mean rate = (H/D_a) [1 - (H^2 - 2T D_a)/(H^2 - D_a^2 A^2) Pi(n, m)/K(m)]
    n = -m D_a^2 A^2/(H^2 - D_a^2 A^2)

in exact fractions and balls. Motions with wheels and under a torque: `turning.followed`.

Symmetric tops, under their weight and in a field: `turning.of_top`."""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

from ..case.given import Given, Span, Start, as_case, with_start
from ..errors import InputError, ToleranceNotMet
from ..numbers.balls import Digits, settled
from ..numbers.vectors import dot
from ..orbit.one_orbit import Orbit
from ..orbit.period import period_ball
from ..orbit.reduction import reduce
from ..orbit.result import Fate, Motion, Needs
from ..physics.scene import AnyScene, Scene
from ..physics.symmetric_top import SymmetricTop
from ..reasons import Sentence, as_reason
from .caveats import limited
from .digits_asked import MOST_DIGITS, checked_digits, digits_of
from .motion import motion
from .turning.of_top import of_top
from .turning.result import (
    LONG,
    ROUND_AXIS,
    SEPARATRIX,
    SHORT,
    Attitude,
    bits_of,
    narrow,
    steady,
    turned,
    with_periods,
)


# --- How a body turns
def attitude(scene: Given, state: Start | None = None, digits: int | None = None, *,
             span: Span | None = None,
             frame: str = "principal") -> Attitude:
    """How the motion of a case turns in space.

    scene: a case in any form, or a scene, of a body with wheels and a constant torque, or of a symmetric top
    under its weight, in a Newtonian field or with a charge; state, span, frame: in place of its own, as of
    `fate`. digits: 1 to 10,000, of the periods, which are then written out too. Raises InputError for scaled
    variables, which have no attitude, for other effects, and as `motion` does; ToleranceNotMet where the
    periods of a motion that is followed have fewer digits.
    """
    digits = None if digits is None else checked_digits(digits, MOST_DIGITS)
    case = with_start(as_case(scene, state, span, frame), "attitude")
    of, start, exact = _physical(case)
    if of.variables == "scaled":
        raise InputError("attitude: scaled variables have no attitude: give body, wheel and torque, and the "
                         "motion as angular_velocity, in rad/s")
    top = None if of.plain else SymmetricTop.of(of)
    if not of.plain and top is None:
        others = ", ".join(sorted({effect.with_article for effect in of.beyond}))
        angles = "--angles gives Euler angles of the vertical over time, " * ("gamma" in of.blocks)
        raise InputError("attitude: it is known of a body with wheels and a torque constant in the body, and "
                         "of a symmetric top under its weight or in a field, with wheels along its axis; "
                         f"this scene also has {others}. simulate {angles}--attitude gives the turn in space")
    result = limited(motion(of, start, needs=Needs.RETURN, exact=exact), of, case)
    if top is None:
        return of_motion(of, exact, result, digits)
    return of_top(of, top, (*exact, *map(Fraction, result.at[3:])), _at_start(of, exact, result), digits)


ON_A_SEPARATRIX = Sentence(
    "separatrix-does-not-repeat", "the motion is on a separatrix and does not repeat")()
NOT_KNOWN_TO_REPEAT = Sentence("not-known-to-repeat", "the motion is not known to repeat")()


def of_motion(scene: Scene, omega: Sequence[float | Fraction], result: Motion, digits: int | None = None
              ) -> Attitude:
    """How a motion that is known turns in space; omega: its rates at the start, taken exactly; digits: as
    `attitude` has it."""
    exact = [Fraction(w) for w in omega]
    base = _at_start(scene, exact, result)
    if result.fate == Fate.EQUILIBRIUM:
        return steady(base, exact, digits)
    if result.fate == Fate.SEPARATRIX:
        return replace(base, mode=SEPARATRIX, reason=ON_A_SEPARATRIX)
    if result.period is None:
        return replace(base, reason=NOT_KNOWN_TO_REPEAT.then(result.reason, ": "))
    if in_closed_form(scene):
        return _of_free_body(scene.body.exact, exact, base, digits)
    from .turning.followed import followed
    answer = followed(scene, base, result, result.period)
    if digits is not None and any(scene.vector("constant_torque")) and (reduction := reduce(scene)):
        ball = period_ball(Orbit(reduction, exact), digits + 1)
        return replace(answer, decimals={"rotation_period": ball.mid().str(digits + 1, radius=False)})
    if digits is not None and answer.error is not None and answer.error > 0.1**digits:
        raise ToleranceNotMet(f"attitude: {digits} digits asked for, {digits_of(answer.error):.1f} reached "
                              "(with wheels or a torque the motion is followed); ask for fewer")
    return answer


def _physical(case: Any) -> tuple[Any, Any, Any]:
    """(scene, state, exact state) of a case; of one in scaled variables that states its body, in SI."""
    if case.variables != "scaled" or not case.physical or not case.scaling or case.state is None:
        return case.scene, case.start, case.exact_state
    rates = [r * Fraction(x) for r, x in zip(case.scaling.rate, case.exact_state or case.state)]
    return case.physical, tuple(map(float, rates)), rates


def in_closed_form(scene: AnyScene) -> bool:
    """Whether it is a body alone, whose attitude takes no run."""
    return scene.variables == "physical" and scene.plain and not any(scene.vector("gyrostat")) and not any(
        scene.vector("constant_torque"))


def _at_start(scene: Scene, omega: Sequence[Fraction], result: Motion) -> Attitude:
    H = [d * w + l for d, w, l in zip(scene.body.exact, omega, scene.vector("gyrostat"))]
    size = math.hypot(*map(float, H))
    along = tuple(float(v) / size for v in H) if size else None
    return Attitude(result.at[:3], result.fate, None, size, along, reason=as_reason(None),
                    caveats=result.caveats)


def _of_free_body(D: Sequence[Fraction], omega: Sequence[Fraction], base: Attitude,
                  digits: int | None) -> Attitude:
    """A body without wheels, by Jacobi's solution; see the module text."""
    smallest, b, greatest = sorted(range(3), key=lambda i: D[i])
    T2 = dot(D, [w * w for w in omega])
    H2 = dot([d * d for d in D], [w * w for w in omega])
    long = H2 < T2 * D[b]
    a, c = (smallest, greatest) if long else (greatest, smallest)
    A2 = (H2 - T2 * D[c]) / (D[a] * (D[a] - D[c]))
    m = 1 - (H2 - T2 * D[b]) / (D[a] * (D[a] - D[b])) / A2
    speed = A2 * (D[c] - D[a]) * (D[b] - D[a]) / (D[b] * D[c])
    across = H2 - D[a] ** 2 * A2  # least square of the momentum across the axis

    def periods(numbers: Digits) -> list[Any]:
        ball = numbers.ball
        full, third = numbers.elliptic(ball(-m * D[a] ** 2 * A2 / across), ball(m))
        period = 4 * full / ball(speed).sqrt()
        rate = ball(H2).sqrt() * (1 - ball((H2 - T2 * D[a]) / across) * third / full) / ball(D[a])
        turns = rate * period / (2 * numbers.pi())
        return [narrow(item, digits) for item in (period, 2 * numbers.pi() / rate, turns - int(float(turns)))]

    period, precession, turn = settled(periods, bits_of(digits))
    shares = [D[a] ** 2 * square / H2 for square in (A2, A2 * (1 - m))]  # cos^2 of the angle, greatest first
    least_angle, greatest_angle = (math.atan2(math.sqrt(1 - part), math.sqrt(part)) for part in shares)
    result = replace(base, mode=LONG if long else SHORT, cone=(least_angle, greatest_angle),
                    reason=ROUND_AXIS(axis="long" if long else "short"))
    result = with_periods(result, {"rotation_period": period, "precession_period": precession}, digits)
    return turned(result, float(turn.mid()))
