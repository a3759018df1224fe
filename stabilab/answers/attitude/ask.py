"""How a body turns in space: rotation and precession periods, angular momentum, the turn after one period.

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

in exact fractions and balls. Motions with wheels and under a torque: `followed`; heavy tops: `top`.
"""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

from ...errors import InputError, ToleranceNotMet
from ...numbers.balls import Digits, settled
from ...numbers.vectors import dot
from ...orbit.result import Fate, Motion
from ...physics.scene import Scene
from ...validation import is_case, scene_and_state
from ..caveats import limited
from ..digits.checked import MOST_DECIMALS, checked_digits, digits_of
from ..motion import motion
from .result import LONG, SEPARATRIX, SHORT, Attitude, narrow, steady, turned, with_periods
from .top import axis_of_top, of_top


def attitude(scene: Any, state: Any = None, digits: int | None = None) -> Attitude:
    """How the motion from `state` (three rates, rad/s; of a top followed by the vertical) turns in space.

    scene: a Scene of a body, wheels and a constant torque, or of a heavy symmetric top, or a case, whose own
    start holds where none is given. digits: 1 to 50, of the periods, which are then written out too. Raises
    InputError for scaled variables, which have no attitude, for other effects, and as `motion` does;
    ToleranceNotMet where the periods of a motion that is followed have fewer digits.
    """
    digits = None if digits is None else checked_digits(digits, MOST_DECIMALS)
    exact, case = None, scene if is_case(scene) and state is None else None
    if case is not None:
        scene, state, exact = _physical(case)
    scene, state = scene_and_state(scene, state)
    if scene.variables == "scaled":
        raise InputError("attitude: scaled variables have no attitude: give body, wheel and torque, and the "
                         "motion as angular_velocity, in rad/s")
    axis = None if scene.plain else axis_of_top(scene)
    if not scene.plain and axis is None:
        others = ", ".join(sorted({effect.with_article for effect in scene.beyond}))
        raise InputError("attitude: it is known of a body with wheels and a torque constant in the body, and "
                         f"of a heavy symmetric top; this scene also has {others}")
    exact = exact or tuple(Fraction(v) for v in state[:3])
    found = motion(scene, state, brief=True, exact=exact)
    found = found if case is None else limited(found, scene, case)
    if axis is None:
        return of_motion(scene, exact, found, digits)
    start = (*exact, *map(Fraction, found.at[3:]))
    return of_top(scene, axis, start, _at_start(scene, exact, found), digits)


def of_motion(scene: Scene, omega: Sequence[float | Fraction], found: Motion, digits: int | None = None
              ) -> Attitude:
    """How a motion that is known turns in space; omega: its rates at the start, taken exactly; digits: as
    `attitude` has it."""
    exact = [Fraction(w) for w in omega]
    base = _at_start(scene, exact, found)
    if found.fate == Fate.EQUILIBRIUM:
        return steady(base, exact, digits)
    if found.fate == Fate.SEPARATRIX:
        return replace(base, mode=SEPARATRIX, because="the motion is on a separatrix and does not repeat")
    if found.period is None:
        return replace(base, because=f"the motion is not known to repeat: {found.because}")
    if in_closed_form(scene):
        return _of_free_body(scene.body.exact, exact, base, digits)
    from .followed import followed
    answer = followed(scene, base, found, found.period)
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


def in_closed_form(scene: Any) -> bool:
    """Whether it is a body alone, whose attitude takes no run."""
    return scene.variables == "physical" and scene.plain and not any(scene.vector("gyrostat")) and not any(
        scene.vector("constant_torque"))


def _at_start(scene: Scene, omega: Sequence[Fraction], found: Motion) -> Attitude:
    H = [d * w + l for d, w, l in zip(scene.body.exact, omega, scene.vector("gyrostat"))]
    size = math.hypot(*map(float, H))
    along = tuple(float(v) / size for v in H) if size else None
    return Attitude(found.at[:3], found.fate, None, size, along, "", caveats=found.caveats)


def _of_free_body(D: Sequence[Fraction], omega: Sequence[Fraction], base: Attitude,
                  digits: int | None) -> Attitude:
    """A body without wheels, by Jacobi's solution; see the module text."""
    least, b, greatest = sorted(range(3), key=lambda i: D[i])
    T2 = dot(D, [w * w for w in omega])
    H2 = dot([d * d for d in D], [w * w for w in omega])
    long = H2 < T2 * D[b]
    a, c = (least, greatest) if long else (greatest, least)
    A2 = (H2 - T2 * D[c]) / (D[a] * (D[a] - D[c]))
    m = 1 - (H2 - T2 * D[b]) / (D[a] * (D[a] - D[b])) / A2
    speed = A2 * (D[c] - D[a]) * (D[b] - D[a]) / (D[b] * D[c])
    across = H2 - D[a] ** 2 * A2  # least square of the momentum across the axis

    def periods(numbers: Digits) -> list[Any]:
        ball = numbers.ball
        whole, third = numbers.elliptic(ball(-m * D[a] ** 2 * A2 / across), ball(m))
        period = 4 * whole / ball(speed).sqrt()
        rate = ball(H2).sqrt() * (1 - ball((H2 - T2 * D[a]) / across) * third / whole) / ball(D[a])
        turns = rate * period / (2 * numbers.pi())
        return [narrow(one, digits) for one in (period, 2 * numbers.pi() / rate, turns - int(float(turns)))]

    period, precession, turn = settled(periods)
    shares = [D[a] ** 2 * square / H2 for square in (A2, A2 * (1 - m))]  # cos^2 of the angle, greatest first
    least_angle, greatest_angle = (math.atan2(math.sqrt(1 - share), math.sqrt(share)) for share in shares)
    words = f"no torque: the angular momentum goes round the {'long' if long else 'short'} axis in the body"
    found = replace(base, mode=LONG if long else SHORT, cone=(least_angle, greatest_angle), because=words)
    found = with_periods(found, {"rotation_period": period, "precession_period": precession}, digits)
    return turned(found, float(turn.mid()))
