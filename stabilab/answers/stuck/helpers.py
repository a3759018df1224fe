"""Other thrusters, alone or in pairs, that fired together with the stuck ones keep the motion bounded, or
delay its limit.

What leaves less torque need not come to the limit later: what is left may lie nearer to an axis about which
the body spins up. So times are compared with the time without help, and what brings the limit sooner is said
not to help. A thruster that fires for a share of the time is taken as its mean torque: that is right where
its pulses are short beside the motion.
"""
from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import combinations
from typing import Any, TypeAlias, TypeGuard

from ...numbers.vectors import CYCLE, Exact3, dot
from ..caveats import STEADY
from .fate import PATIENCE, Found, first_time, found, limit_in, time_under
from .line import Family
from .result import Helper
from .scenario import Scenario

NOTHING = Fraction(1, 10**9)  # of the torque: what is left of it counts as none
WORTH = Fraction(999, 1000)  # of the torque: a helper that leaves more is none
Duty: TypeAlias = tuple[Fraction, ...]  # the share of the time that each fires
MOST = 12  # helpers that are told
TRIED = 6  # thrusters, and pairs, whose times are compared: those that leave the least torque
SHARES = (Fraction(1), Fraction(3, 4), Fraction(1, 2), Fraction(1, 4))  # of the duty that leaves the least


def helpers(scenario: Scenario, torque: Sequence[Fraction], others: Sequence[Any],
            seen: Found) -> tuple[Helper, ...]:
    """The helpers among `others` (thrusters that do not fire) against a torque (exact, scene's axes), the
    best first.

    seen: what becomes of the motion without them.
    """
    if not any(torque):
        return ()
    turned = [(t.name, scenario.axes.turned(t.torque)) for t in others]
    turned = [(name, arm) for name, arm in turned if any(arm)]
    sets = [(one,) for one in turned] + list(combinations(turned, 2))
    told: list[tuple[Helper, Exact3]] = []
    done: set[str] = set()
    for chosen in sets:
        names = tuple(name for name, _ in chosen)
        if not done & set(names) and (one := _stops(scenario, torque, names, [arm for _, arm in chosen])):
            told.append(one)
            if len(names) == 1:
                done.add(names[0])
    told.sort(key=lambda one: (one[0].effect != "zero", len(one[0].thrusters), one[0].torque_left))
    tried = [_timed(scenario, helper, left, seen) for helper, left in told[:MOST]]
    if all(helper.effect == "none" for helper in tried):
        tried += _slowest(scenario, torque, sets, seen)
    tried.sort(key=_rank)
    return tuple([helper for helper in tried if helper.effect != "none"] or tried[:1])


def _rank(helper: Helper) -> tuple[bool, bool, float]:
    """In front: what helps, what never comes to the limit as far as is known, then what comes to it late."""
    time = helper.time_to_limit
    return helper.effect == "none", time is not None, 0.0 if time is None else -time[0]


def _later(time: tuple[float, float] | None, seen: Found) -> bool:
    """Whether a limit that is reached at `time`, if at all, is reached later than without help."""
    return time is None or (seen.time is not None and time[0] > seen.time[1])


def _timed(scenario: Scenario, helper: Helper, left: Exact3, seen: Found) -> Helper:
    """With the time of its limit: a bounded motion may come to it all the same."""
    time = None if scenario.limit is None else time_under(scenario, left, scenario.wheel)
    return replace(helper, time_to_limit=time, effect=helper.effect if _later(time, seen) else "none")


def _stops(scenario: Scenario, torque: Sequence[Fraction], names: tuple[str, ...],
           arms: Sequence[Sequence[Fraction]]
           ) -> tuple[Helper, Exact3] | None:
    """The helper that these make, and the torque, where they leave none or a bounded motion."""
    duty = _least_squares(torque, arms)
    if _possible(duty):
        left = _left(torque, arms, duty)
        if dot(left, left) <= NOTHING**2 * dot(torque, torque):
            helper = Helper(names, tuple(map(float, duty)), "zero", math.sqrt(float(dot(left, left))),
                            "bounded", None)
            return helper, (Fraction(0),) * 3
    best, axis = None, 0
    for i in range(3):
        duty = _onto_axis(torque, arms, i)
        if not _possible(duty):
            continue
        size = _left(torque, arms, duty)[i]
        if size and (best is None or abs(size) < abs(best[1])):
            fate = Family(scenario.body, i, size, scenario.wheel, tuple(map(Fraction, scenario.state))).fate()
            best, axis = ((duty, size, fate), i) if fate in STEADY else (best, axis)
    if best is None:
        return None
    duty, size, fate = best
    helper = Helper(names, tuple(map(float, duty)), "bounded", abs(float(size)), fate.word, None)
    return helper, tuple(size * (n == axis) for n in range(3))


def _possible(duty: Duty | None) -> TypeGuard[Duty]:
    return duty is not None and all(0 < u <= 1 for u in duty)


def _left(torque: Sequence[Fraction], arms: Sequence[Sequence[Fraction]], duty: Sequence[Fraction]) -> Exact3:
    return tuple(m + sum(u * arm[n] for u, arm in zip(duty, arms)) for n, m in enumerate(torque))


def _least_squares(torque: Sequence[Fraction], arms: Sequence[Sequence[Fraction]]) -> Duty | None:
    """The shares, of any sign and size, that leave the least torque; None where two arms are parallel."""
    if len(arms) == 1:
        return (-dot(arms[0], torque) / dot(arms[0], arms[0]),)
    a, b = arms
    return _solved(dot(a, a), dot(a, b), dot(a, b), dot(b, b), -dot(a, torque), -dot(b, torque))


def _onto_axis(torque: Sequence[Fraction], arms: Sequence[Sequence[Fraction]], i: int) -> Duty | None:
    """The shares that leave no torque across axis i; None where there are none."""
    j, k = CYCLE[i]
    if len(arms) == 2:
        a, b = arms
        return _solved(a[j], b[j], a[k], b[k], -torque[j], -torque[k])
    (a,), size = arms, dot(torque, torque)
    n, other = (j, k) if abs(a[j]) >= abs(a[k]) else (k, j)
    if not a[n]:
        return None
    share = -torque[n] / a[n]
    return (share,) if (torque[other] + share * a[other]) ** 2 <= NOTHING**2 * size else None


def _solved(p: Fraction, q: Fraction, r: Fraction, s: Fraction, x: Fraction, y: Fraction) -> Duty | None:
    """(u, v) with p u + q v = x and r u + s v = y; None where the rows are alike."""
    det = p * s - q * r
    return (None if det * det <= NOTHING**2 * (p * p + q * q) * (r * r + s * s)
            else ((x * s - q * y) / det, (p * y - r * x) / det))


def _slowest(scenario: Scenario, torque: Sequence[Fraction], sets: Any, seen: Found) -> list[Helper]:
    """The thruster and the pair with the latest limit; without a limit those that leave the least torque."""
    out: list[tuple[float, Helper]] = []
    size = dot(torque, torque)
    for many in (1, 2):
        tried = [(dot(left, left), chosen, duty) for chosen in sets if len(chosen) == many
                 for duty in _in_the_box(torque, [arm for _, arm in chosen]) if all(duty)
                 for left in [_left(torque, [arm for _, arm in chosen], duty)]]
        tried = sorted((one for one in tried if one[0] < WORTH**2 * size), key=lambda one: one[0])[:TRIED]
        if not tried:
            continue
        if scenario.limit is None:
            square, chosen, duty = tried[0]
            best = math.sqrt(float(square)), chosen, duty
            better = not out or best[0] < WORTH * out[0][0]
        else:
            best = max(((_run(scenario, torque, chosen, scaled, seen), chosen, scaled) for _, chosen,
                        duty in tried
                        for share in SHARES for scaled in [tuple(share * u for u in duty)]),
                       key=lambda one: one[0])
            better = not out or out[0][0] < WORTH * best[0]
        if better:
            out.append((best[0], _slower(scenario, torque, seen, *best)))
    return [helper for _, helper in out]


def _run(scenario: Scenario, torque: Sequence[Fraction], chosen: Any, duty: Duty, seen: Found) -> float:
    """The time of the limit by a plain run, inf where it is not reached for long."""
    left = _left(torque, [arm for _, arm in chosen], duty)
    t_max = PATIENCE * (seen.time[0] if seen.time else seen.followed)
    return first_time(scenario, limit_in(scenario), left, None, t_max)


def _in_the_box(torque: Sequence[Fraction], arms: Sequence[Sequence[Fraction]]) -> list[Duty]:
    """The shares in 0 to 1 among which the one is that leaves the least torque: inside, or on the border."""
    duty = _least_squares(torque, arms)
    if duty is not None and all(0 <= u <= 1 for u in duty):
        return [duty]
    if duty is not None and len(arms) == 1:
        return [(min(max(duty[0], Fraction(0)), Fraction(1)),)]
    out: list[Duty] = []
    for fixed in (0, 1):
        for whole in (Fraction(0), Fraction(1)):
            rest = _left(torque, [arms[fixed]], (whole,))
            (share,) = _in_the_box(rest, [arms[1 - fixed]])[0]
            out.append((whole, share) if fixed == 0 else (share, whole))
    return out


def _slower(scenario: Scenario, torque: Sequence[Fraction], seen: Found, run: float, chosen: Any,
            duty: Duty) -> Helper:
    """run: the time of the limit by a plain run, which counts where none is enclosed."""
    left, effect, time = _left(torque, [arm for _, arm in chosen], duty), "slower", None
    if scenario.limit is not None:
        time = time_under(scenario, left, scenario.wheel)
        effect = "slower" if _later(time or (run, run), seen) else "none"
    fate = found(replace(scenario, limit=None), left).fate.word
    return Helper(tuple(name for name, _ in chosen), tuple(map(float, duty)), effect,
                  math.sqrt(float(dot(left, left))), fate, time)
