"""Other thrusters, alone or in pairs, that fired together with the stuck ones leave no torque, or one that keeps the motion bounded, or the least.

A thruster that fires for a share of the time is taken as its mean torque: that is right where its pulses are short beside the motion.
"""
from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations
from typing import Any, TypeAlias, TypeGuard

from ...numbers.vectors import CYCLE, Exact3, dot
from .family import STEADY, Family
from .fate import found
from .result import Helper
from .scenario import Scenario

NOTHING = Fraction(1, 10**9)  # of the torque: what is left of it counts as none
WORTH = Fraction(999, 1000)  # of the torque: a helper that leaves more is none
Duty: TypeAlias = tuple[Fraction, ...]  # the share of the time that each fires
MOST = 12  # helpers that are told


def helpers(scenario: Scenario, torque: Sequence[Fraction], others: Sequence[Any]) -> tuple[Helper, ...]:
    """The helpers among `others` (thrusters that do not fire) against a torque (exact, scene's axes), the best first."""
    if not any(torque):
        return ()
    turned = [(t.name, scenario.axes.turned(t.torque)) for t in others]
    turned = [(name, arm) for name, arm in turned if any(arm)]
    sets = [(one,) for one in turned] + list(combinations(turned, 2))
    told: list[Helper] = []
    done: set[str] = set()
    for chosen in sets:
        names = tuple(name for name, _ in chosen)
        if not done & set(names) and (helper := _stops(scenario, torque, names, [arm for _, arm in chosen])):
            told.append(helper)
            if len(names) == 1:
                done.add(names[0])
    told.sort(key=lambda h: (h.effect != "zero", len(h.thrusters), h.torque_left))
    return tuple(told[:MOST] or _least(scenario, torque, sets))


def _stops(scenario: Scenario, torque: Sequence[Fraction], names: tuple[str, ...], arms: Sequence[Sequence[Fraction]]) -> Helper | None:
    """The helper that these make, where they leave no torque or a bounded motion."""
    duty = _least_squares(torque, arms)
    if _possible(duty):
        left = _left(torque, arms, duty)
        if dot(left, left) <= NOTHING**2 * dot(torque, torque):
            return Helper(names, tuple(map(float, duty)), "zero", math.sqrt(float(dot(left, left))), "bounded", None)
    best = None
    for i in range(3):
        duty = _onto_axis(torque, arms, i)
        if not _possible(duty):
            continue
        size = _left(torque, arms, duty)[i]
        if size and (best is None or abs(size) < abs(best[1])):
            fate = Family(scenario.body, i, size, scenario.wheel, tuple(map(Fraction, scenario.state))).fate()
            best = (duty, size, fate) if fate in STEADY else best
    return None if best is None else Helper(names, tuple(map(float, best[0])), "bounded", abs(float(best[1])), best[2].word, None)


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
    return None if det * det <= NOTHING**2 * (p * p + q * q) * (r * r + s * s) else ((x * s - q * y) / det, (p * y - r * x) / det)


def _least(scenario: Scenario, torque: Sequence[Fraction], sets: Any) -> list[Helper]:
    """The thruster and the pair that leave the least torque."""
    out: list[tuple[Fraction, Any, Duty]] = []
    size = dot(torque, torque)
    for many in (1, 2):
        tried = [(dot(left, left), chosen, duty) for chosen in sets if len(chosen) == many
                 for duty in _in_the_box(torque, [arm for _, arm in chosen]) for left in [_left(torque, [arm for _, arm in chosen], duty)]]
        if not tried:
            continue
        square, chosen, duty = min(tried, key=lambda one: one[0])
        if square < WORTH**2 * size and all(duty) and (not out or square < WORTH * out[0][0]):
            out.append((square, chosen, duty))
    return [_slower(scenario, torque, *one) for one in out]


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


def _slower(scenario: Scenario, torque: Sequence[Fraction], square: Fraction, chosen: Any, duty: Duty) -> Helper:
    seen = found(scenario, _left(torque, [arm for _, arm in chosen], duty))
    return Helper(tuple(name for name, _ in chosen), tuple(map(float, duty)), "slower", math.sqrt(float(square)), seen.fate.word, seen.time)
