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

in exact fractions and balls. Motions with wheels and under a torque: `attitude_followed`.

A heavy symmetric top, by Lagrange's cubic.

A body with D_j = D_k = A turns about a fixed point under its weight, which acts on axis i at the moment P = M
g c; a wheel may turn about that axis. Constant are the momentum about it, L = D_i omega_i + lambda_i, the
momentum about the vertical and the energy. With u the cosine of the lean, between the upward vertical and the
direction from the fixed point to the centre of mass (Landau & Lifshitz, Mechanics, section 35),

    u'^2 = F(u) = (1 - u^2)(eps - beta u) - (kappa - a u)^2,    beta = 2 |P|/A,  a = L/A,
    eps = omega_j^2 + omega_k^2 + beta u,    kappa = (D omega + lambda) . gamma/A, up to its sign.

u goes to and fro between the lower two roots of F, u_1 <= u <= u_2 <= 1 <= u_3: with m = (u_2 - u_1)/(u_3 -
u_1)

    nutation period = 4 K(m) / (beta (u_3 - u_1))^(1/2),

and the axis precesses at the rate (kappa - a u)/(1 - u^2), half the sum of (kappa - a)/(1 - u) and (kappa +
a)/(1 + u), whose means over that period are integrals of the third kind. Where |gamma| = g is not quite one,
u is between -g and g. Exact fractions and balls."""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

from ..case.given import Given, Span, Start, as_case, with_start
from ..errors import InputError, ToleranceNotMet
from ..numbers.balls import Digits, Unclear, settled
from ..numbers.vectors import CYCLE, dot
from ..orbit.one_orbit import Orbit
from ..orbit.period import period_ball
from ..orbit.reduction import reduce
from ..orbit.result import Fate, Motion, Needs
from ..physics.scene import AnyScene, Scene
from ..physics.symmetric_top import top_rates
from ..reasons import Sentence, as_reason
from .attitude_result import (
    LONG,
    ROUND_AXIS,
    SEPARATRIX,
    SHORT,
    TOP,
    Attitude,
    bits_of,
    narrow,
    steady,
    turned,
    with_periods,
)
from .caveats import limited
from .digits_asked import MOST_DIGITS, checked_digits, digits_of
from .motion import motion

# --- A heavy symmetric top
UPRIGHT = Sentence(
    "top-through-vertical", "the axis passes through the vertical, where it has no precession")()
ON_VERTICAL = Sentence("top-on-vertical", "the axis stands on the vertical")()
TO_AND_FRO = Sentence(
    "top-nutates", "the lean goes to and fro between two roots of Lagrange's cubic")()
STEADY_LEAN = Sentence("top-precesses-steadily", "the axis keeps its lean and precesses about the vertical")()
NEARLY_STEADY = Sentence(
    "top-precesses-steadily-nearly", "the axis keeps its lean, but for what the rounding of its start to "
    "doubles adds, and precesses about the vertical")()
TO_VERTICAL = Sentence(
    "top-tends-to-vertical", "the axis comes ever closer to the vertical and does not come back")()

ROUNDED = 1e-13  # rad, of a lean: less comes of rounding


def axis_of_top(scene: Any) -> int | None:
    """The axis of a heavy symmetric top, which its weight and its wheels act on alone; None of other scenes.
    """
    if {effect.name for effect in scene.effects} - {"gyrostat"} != {"gravity"}:
        return None
    D, wheel = scene.body.exact, scene.vector("gyrostat")
    along = [i for i, weight in enumerate(scene.vector("gravity")) if weight]
    if len(along) != 1:
        return None
    j, k = CYCLE[along[0]]
    return along[0] if D[j] == D[k] and not wheel[j] and not wheel[k] else None


def of_top(scene: Scene, axis: int, start: Sequence[Fraction], base: Attitude, digits: int | None = None
           ) -> Attitude:
    """base: what is known at the start, three rates and the vertical; digits: of the periods."""
    top = _Top(scene, axis, start)
    base = replace(base, top=top_rates(scene, start))
    if top.vertical:
        return replace(steady(base, start[:3], digits), reason=ON_VERTICAL)
    balls: list[Any] = settled(
        lambda numbers: [None if item is None else narrow(item, digits) for item in top.answer(numbers)],
        bits_of(digits))
    smallest, greatest, nutation, precession = balls
    if smallest is None and not top.steady:
        return replace(base, mode=SEPARATRIX, reason=TO_VERTICAL)
    nearly = nutation is not None and float(greatest - smallest) < ROUNDED
    steadily = STEADY_LEAN if top.steady else NEARLY_STEADY if nearly else TO_AND_FRO
    reason = steadily.then(UPRIGHT if precession is None else None)
    nutation = None if nearly else nutation
    result = replace(base, mode=TOP, lean=(float(smallest.mid()), float(greatest.mid())),
                    reason=reason)
    return with_periods(result, {"nutation_period": nutation, "precession_period": precession}, digits)


class _Top:
    """The constants of the cubic, of u = +-gamma_i."""

    def __init__(self, scene: Scene, axis: int, start: Sequence[Fraction]) -> None:
        j, k = CYCLE[axis]
        D, wheel = scene.body.exact, scene.vector("gyrostat")
        omega, gamma = start[:3], start[3:]
        arm = scene.vector("gravity")[axis]  # times the weight, N m
        momentum = [d * w + l for d, w, l in zip(D, omega, wheel)]
        up = -1 if arm > 0 else 1  # gamma is the direction of the weight
        u, self.square = up * gamma[axis], dot(gamma, gamma)
        beta, self.a = 2 * abs(arm) / D[j], momentum[axis] / D[j]
        self.kappa = up * dot(momentum, gamma) / D[j]
        eps = omega[j] ** 2 + omega[k] ** 2 + beta * u
        self.u, self.beta = u, beta
        self.cubic = (self.square * eps - self.kappa**2, 2 * self.kappa * self.a - self.square * beta,
                      -eps - self.a**2, beta)
        slope = self.cubic[1] + 2 * self.cubic[2] * u + 3 * beta * u * u
        self.steady = not slope and not sum(c * u**n for n, c in enumerate(self.cubic))
        self.vertical = self.steady and u * u == self.square
        # at u = g and u = -g the cubic is -(kappa -+ a g)^2
        tie, sign = self.kappa**2 == self.a**2 * self.square, self.kappa * self.a
        self.down = tie and sign <= 0
        self.up = tie and sign >= 0 and eps > 0 and eps**2 > beta**2 * self.square

    def answer(self, numbers: Digits) -> tuple[Any, Any, Any, Any]:
        """(least, greatest lean, nutation period, precession period) in balls; None what it does not have."""
        g, a, kappa = numbers.ball(self.square).sqrt(), numbers.ball(self.a), numbers.ball(self.kappa)
        if self.steady:
            u, turns = numbers.ball(self.u), self.kappa != self.a * self.u
            rate = g * (kappa - a * u) / (g * g - u * u)
            return _lean(u / g), _lean(u / g), None, _period(numbers, rate) if turns else None
        roots = [(root, many) for root, many in numbers.real_roots(self.cubic) for _ in range(many)]
        if len(roots) < 3:
            raise Unclear
        (low, _), (high, many), (far, _) = roots
        if many > 1:
            return None, None, None, None
        low, high = -g if self.down else low, g if self.up else high
        swing, m = high - low, (high - low) / (far - low)
        ends = (numbers.ball(0) if self.up else _lean(high / g),
                numbers.pi() if self.down else _lean(low / g))
        full, _ = numbers.elliptic(numbers.ball(0), m)
        nutation = 4 * full / (numbers.ball(self.beta) * (far - low)).sqrt()
        if self.up or self.down:
            return *ends, nutation, None
        ahead = numbers.elliptic(swing / (g - low), m)[1] / (full * (g - low))
        behind = numbers.elliptic(-swing / (g + low), m)[1] / (full * (g + low))
        return *ends, nutation, _period(numbers, ((kappa - a * g) * ahead + (kappa + a * g) * behind) / 2)


def _period(numbers: Digits, rate: Any) -> Any:
    return 2 * numbers.pi() / abs(rate)


def _lean(cosine: Any) -> Any:
    """Its angle, without loss where it is near one."""
    return 2 * ((1 - cosine) / 2).sqrt().asin()


# --- How a body turns
def attitude(scene: Given, state: Start | None = None, digits: int | None = None, *,
             span: Span | None = None,
             frame: str = "principal") -> Attitude:
    """How the motion of a case turns in space.

    scene: a case in any form, or a scene, of a body with wheels and a constant torque, or of a heavy
    symmetric top; state, span, frame: in place of its own, as of `fate`. digits: 1 to 10,000, of the periods,
    which are then written out too. Raises InputError for scaled variables, which have no attitude, for other
    effects, and as `motion` does; ToleranceNotMet where the periods of a motion that is followed have fewer
    digits.
    """
    digits = None if digits is None else checked_digits(digits, MOST_DIGITS)
    case = with_start(as_case(scene, state, span, frame), "attitude")
    of, start, exact = _physical(case)
    if of.variables == "scaled":
        raise InputError("attitude: scaled variables have no attitude: give body, wheel and torque, and the "
                         "motion as angular_velocity, in rad/s")
    axis = None if of.plain else axis_of_top(of)
    if not of.plain and axis is None:
        others = ", ".join(sorted({effect.with_article for effect in of.beyond}))
        raise InputError("attitude: it is known of a body with wheels and a torque constant in the body, and "
                         f"of a heavy symmetric top; this scene also has {others}")
    result = limited(motion(of, start, needs=Needs.RETURN, exact=exact), of, case)
    if axis is None:
        return of_motion(of, exact, result, digits)
    return of_top(of, axis, (*exact, *map(Fraction, result.at[3:])), _at_start(of, exact, result), digits)


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
    from .attitude_followed import followed
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
