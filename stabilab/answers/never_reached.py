"""That a limit is never reached, and a time before which it is not.

The torque feeds energy at a bounded rate. Let W = (omega . D omega)^(1/2), the root of twice the kinetic
energy. The torque alone does work, so that W W' = M . omega, and with M . omega <= |D^(-1/2) M| W

    W(t) <= W(0) + |D^(-1/2) M| t.

A quantity sum c (a . omega)^2 is at most q W^2, q the sum of the c a . D^(-1) a, or the greatest of them
where the a are different principal axes. It reaches its limit no earlier than q W^2 does. Likewise |omega|^2
>= W^2/max(D) falls to a limit no earlier than W(t) >= W(0) - |D^(-1/2) M| t does. What keeps |omega| above a
limit for ever stands in `unreduced.slowest`; a certified spin-up does so from some time on."""
from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from ..equilibrium.dissipative import decay, drawn_to
from ..integrate.trajectory import integrated
from ..numbers.exact import sqrt_fraction
from ..numbers.vectors import Exact3, Float3, Number
from ..orbit.result import Fate, Needs
from ..physics.coefficients import content
from ..physics.scene import AnyScene, rests
from ..reasons import Angle, Axis, Level, Quantity, Rate, Reason, Sentence, Time
from ..unreduced.slowest import least_rate
from ..unreduced.spin_up.follow import spin_up
from .kinds import kind_of
from .limit import Limit, asked, pointing_bound
from .motion import motion
from .motions.rows import extremes, fates, periods
from .passage import Found

NEVER_AT_REST = Sentence("never-at-equilibrium", "never, the state is an equilibrium")()
NEVER_BY_EXTREMES = Sentence("never-by-extremes", "never, the extremes over all time stay below it")()
NEVER_BY_PERIOD = Sentence("never-by-period", "never, the motion repeats and a whole period stays below it")()
NEVER_BY_BOUND = Sentence("never-by-bound", "never, |ω| ≤ {bound} always")
NEVER_SO_SLOW_BY_EXTREMES = Sentence(
    "never-below-by-extremes", "never, the extremes over all time stay above it")()
NEVER_SO_SLOW_BY_PERIOD = Sentence(
    "never-below-by-period", "never, the motion repeats and a whole period stays above it")()
NEVER_SO_SLOW_BY_SPIN = Sentence(
    "never-so-slow-by-spin", "never: above it until {time}, and from then on by the bounds of the growing "
    "spin about {axis}, {level}")
NEVER_SO_SLOW_BY_END = Sentence(
    "never-so-slow-by-end", "never: above it along a run of {time}, and from then on too near the "
    "equilibrium that draws every motion, which turns at {rate}")
NEVER_BY_CONE = Sentence(
    "never-by-cone", "never: the angular momentum stays, and by its cone about it the axis is never farther "
    "than {angle} from its direction at the start")
NEVER_BY_TURN = Sentence(
    "never-by-turn", "never, the axis is never farther than {angle} from its direction at the start: {law}")
NEVER_SO_SLOW_BY_LAW = Sentence("never-so-slow-by-law", "never: {law}")
SLACK = 1e-9  # relative: extremes and periods are known to 1e-11
REDUCED = ("orbit", "aligned", "free")
LESS = 1 - Fraction(1, 1 << 60)  # the roots are known to 2^-240
QUICK = 20_000  # steps of a run that looks for the crossing before a spin-up is looked for
SETTLING = 1 + SLACK  # of the time from which bounds of a spin-up keep it above a limit


class Beyond(NamedTuple):
    """A time, in the scene's, after which a limit is not reached for the first time; the answer where it is
    not reached before."""

    time: float
    never: Found


def never(scene: AnyScene, state: Float3, exact: Exact3, limit: Limit) -> tuple[Found | None, Beyond | None]:
    """(the answer where extremes over all time stay on this side of the limit, a time by which it is reached
    if ever or None). exact: three rationals."""
    if limit.kind == "tilt":
        return never_tilts(scene, state, exact, limit), None
    if rests(scene.quadratic(), exact):
        return Found(math.inf, math.inf, "exact", reason=NEVER_AT_REST), None
    kind = kind_of(scene)
    if kind not in REDUCED:
        return None, None
    if tuple(map(Fraction, state)) != tuple(exact):
        return _never_of_rationals(scene, state, exact, limit)
    row = np.array(state, float)
    bounded = lambda: fates(scene, row).labels == Fate.BOUNDED
    if kind == "aligned" and not (bounded() and math.isfinite(float(periods(scene, row)))):
        return None, None  # its extremes over all time are not known
    if limit.momentum is not None and not limit.momentum.stays:
        return None, after_a_period(limit, float(periods(scene, row)) if bounded() else math.inf)
    if _beyond(limit, extremes(scene, row).tolist(), exact):
        return Found(math.inf, math.inf, "exact", reason=_by_extremes(limit)), None
    free = kind == "free" and (limit.falls or limit.momentum is not None)
    repeats = float(periods(scene, row)) if free or kind == "orbit" and bounded() else math.inf
    return None, after_a_period(limit, repeats)


def _never_of_rationals(scene: AnyScene, state: Float3, exact: Exact3, limit: Limit
                        ) -> tuple[Found | None, Beyond | None]:
    """`never` of a start that is no double: next to a separatrix its rounding is another motion."""
    resolved = motion(scene, state, needs=Needs.RETURN, exact=exact)
    pairs = resolved.extremes if resolved.for_all_time else None
    stays = limit.momentum is None or limit.momentum.stays
    if pairs is not None and stays and _beyond(limit, pairs, exact):
        return Found(math.inf, math.inf, "exact", reason=_by_extremes(limit)), None
    closed = ("orbit", "free") if limit.falls or limit.momentum else ("orbit",)
    repeats = resolved.period if kind_of(scene) in closed and resolved.fate == Fate.BOUNDED else None
    return None, after_a_period(limit, repeats or math.inf)


def never_tilts(scene: AnyScene, state: Float3, exact: Exact3, limit: Limit) -> Found | None:
    """The answer where a body axis keeps to a cone about an angular momentum that stays, within the limit of
    its tilt; None where that does not show it."""
    if scene.variables == "scaled" or any(scene.quadratic().m):
        return None
    ((_, vector),), angle = limit.parts[0]
    cone = asked(scene, nutation=(vector, angle))
    if rests(scene.quadratic(), exact):
        pairs: Any = [(w, w) for w in map(float, exact)]
    elif tuple(map(Fraction, state)) == tuple(exact):
        pairs = extremes(scene, np.array(state, float)).tolist()
    else:
        resolved = motion(scene, state, needs=Needs.RETURN, exact=exact)
        pairs = resolved.extremes if resolved.for_all_time else None
    law: Any = cone.momentum
    if pairs is None or not any(law.of(exact)):
        return Found(math.inf, math.inf, "exact", reason=NEVER_AT_REST) if not any(exact) else None
    low, high = (math.acos(max(-1.0, min(1.0, cosine))) for cosine in cone.cosines(pairs, exact))
    bound = pointing_bound(math.acos(max(-1.0, min(1.0, cone.cosine(exact)))), high, low)
    if not bound + SLACK < float(angle):
        return None
    return Found(math.inf, math.inf, "exact", reason=NEVER_BY_CONE(angle=Angle(bound).upper))


def _beyond(limit: Limit, pairs: Any, start: Exact3) -> bool:
    """Whether extremes over all time stay on this side of the limit."""
    return (limit.beyond(pairs, SLACK) if limit.momentum is None
            else limit.nutates_beyond(pairs, start, SLACK))


def _by_extremes(limit: Limit) -> Reason:
    return NEVER_SO_SLOW_BY_EXTREMES if limit.falls else NEVER_BY_EXTREMES


def after_a_period(limit: Limit, period: float) -> Beyond | None:
    """What is known where a whole period, enclosed, stays on this side of the limit; None without one."""
    if not 0 < period < math.inf:
        return None
    reason = NEVER_SO_SLOW_BY_PERIOD if limit.falls else NEVER_BY_PERIOD
    return Beyond(period * (1 + SLACK), Found(math.inf, math.inf, "proved", reason=reason))


def after_spin_up(scene: AnyScene, state: Float3, limit: Limit, spun: Any = None) -> Beyond | None:
    """What is known where a spin that grows, certified, exceeds from some time on a limit that |omega| falls
    to; None where none is."""
    result = spun or spin_up(scene, state)
    if result.fate != Fate.SPIN_UP or not result.axis or result.trap is None:
        return None
    time = max(result.t, result.trap.clock(limit.least_rate() * (1 + SLACK))[1]) * SETTLING
    level = "proved" if result.level in ("exact", "proved") else "certified"
    reason = NEVER_SO_SLOW_BY_SPIN(time=Quantity(time, scene.time_unit), axis=Axis(result.axis),
                                   level=Level(result.level))
    return Beyond(time, Found(math.inf, math.inf, level, reason=reason))


def never_bounded(scene: Any, state: Any, limit: Limit) -> Found | None:
    """The answer for a scene of other effects, where energy or momentum bound the rate below the limit, or
    above one that it falls to; None where they do not."""
    if limit.angular:
        return None
    result = motion(scene, state, needs=Needs.FATE)
    bound = result.invariants.get("rate_bound", math.inf)
    if result.fate == Fate.EQUILIBRIUM:
        reason = NEVER_AT_REST
    elif limit.falls:
        least = least_rate(scene, state)
        if least is None or not least.rate * (1 - SLACK) > limit.least_rate():
            return None
        reason = NEVER_SO_SLOW_BY_LAW(law=least.reason)
    elif result.fate == Fate.BOUNDED and bound * (1 + SLACK) < limit.least_rate():
        reason = NEVER_BY_BOUND(bound=Rate(bound).upper)
    else:
        return None
    return Found(math.inf, math.inf, "exact", reason=reason)


DOUBLINGS = 12  # of the time in which a departure falls to 1/e, up to which a run follows it


def after_settling(scene: AnyScene, state: Any, limit: Limit) -> Beyond | None:
    """What is known where one equilibrium draws every motion and turns faster than a rate to fall to: V =
    delta . D delta/2 falls, delta the departure from it, so that |omega| stays above once V is small; None
    where there is none, or a run does not come so near."""
    parts = content(scene)
    end = None if parts is None else drawn_to(parts)
    if end is None or parts is None or not math.hypot(*end) * (1 - SLACK) > limit.least_rate():
        return None
    D, rate = np.array([float(d) for d in parts.D]), math.hypot(*end)
    small = D.min() * (rate * (1 - SLACK) - limit.least_rate()) ** 2 / 2
    for n in range(DOUBLINGS):
        time = 2.0**n / float(decay(parts))
        run = integrated(scene, state, [time], laws=False)
        if run.status != "reached":
            return None
        if D @ (np.asarray(run.states[-1])[:3] - end) ** 2 / 2 < small:
            reason = NEVER_SO_SLOW_BY_END(time=Time(time), rate=Rate(rate))
            return Beyond(time, Found(math.inf, math.inf, "run", reason=reason))
    return None


def earliest(scene: AnyScene, start: Sequence[Number], limit: Limit) -> Fraction:
    """The time in the scene's unit, exact; 0 where nothing is known (scaled variables, tilts). scene: wheel
    and torque; start: three exact rates."""
    if scene.variables == "scaled" or limit.angular:
        return Fraction(0)
    D = scene.body.exact
    torque = scene.vector("constant_torque")
    push = sqrt_fraction(sum((Fraction(m) ** 2 / d for m, d in zip(torque, D)), Fraction(0)))
    if not push:
        return Fraction(0)
    begun = sqrt_fraction(sum((d * Fraction(w) ** 2 for d, w in zip(D, start)), Fraction(0)))
    if limit.falls:
        greatest = max(largest for _, largest in limit.parts)
        return max(Fraction(0), (begun * LESS - sqrt_fraction(max(D) * greatest) / LESS) / push * LESS)
    smallest = min(largest / _share(terms, D) for terms, largest in limit.parts)
    return max(Fraction(0), (sqrt_fraction(smallest) * LESS - begun) / push * LESS)


def _share(terms: Sequence[Any], D: Sequence[Fraction]) -> Fraction:
    """q of a sum of squares."""
    shares = [c * sum(Fraction(v) ** 2 / d for v, d in zip(vector, D)) for c, vector in terms]
    axes = [[n for n, v in enumerate(vector) if v] for _, vector in terms]
    apart = all(len(axis) == 1 for axis in axes) and len({axis[0] for axis in axes}) == len(axes)
    return max(shares) if apart else sum(shares, Fraction(0))
