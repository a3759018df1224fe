"""Limits that are never reached: a motion that rests, extremes or a bound over all time below the limit, or
one whole period below it.

A time before which no motion can reach a limit, whatever it does on the way: the torque feeds energy at a
bounded rate.

Let W = (omega . D omega)^(1/2), the root of twice the kinetic energy. The torque alone does work, so that W
W' = M . omega, and with M . omega <= |D^(-1/2) M| W

    W(t) <= W(0) + |D^(-1/2) M| t.

A quantity sum c (a . omega)^2 is at most q W^2, q the sum of the c a . D^(-1) a, or the greatest of them
where the a are different principal axes. It reaches its limit no earlier than q W^2 does.
"""
from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from ...numbers.exact import sqrt_fraction
from ...numbers.vectors import Exact3, Float3, Number
from ...orbit.result import Fate
from ...physics.scene import AnyScene, rests
from ..extremes import extremes, period
from ..fate import fate
from ..kinds import kind_of
from ..motion import motion
from .limit import Limit
from .result import Found

SLACK = 1e-9  # relative: extremes and periods are known to 1e-11
REDUCED = ("orbit", "aligned", "free")
LESS = 1 - Fraction(1, 1 << 60)  # the roots are known to 2^-240


def never(scene: AnyScene, state: Float3, exact: Exact3, limit: Limit) -> tuple[Found | None, float | None]:
    """(the answer where extremes over all time stay below the limit, a time by which it is reached if ever or
    None). exact: three rationals."""
    if limit.kind == "tilt":
        return None, None
    if rests(scene.quadratic(), exact):
        return Found(math.inf, math.inf, "exact", f"{limit.words}: never, the state is an equilibrium"), None
    kind = kind_of(scene)
    if kind not in REDUCED:
        return None, None
    row = np.array(state, float)
    if kind == "aligned" and not _repeats(scene, row):
        return None, None  # its extremes over all time are not known
    if limit.beyond(extremes(scene, row).tolist(), SLACK):
        return Found(math.inf, math.inf, "exact",
                     f"{limit.words}: never, the extremes over all time stay below it"), None
    if fate(scene, row).labels != Fate.BOUNDED:
        return None, None
    repeats = float(period(scene, row)) if kind == "orbit" else math.inf
    return None, repeats * (1 + SLACK) if 0 < repeats < math.inf else None


def _repeats(scene: AnyScene, row: np.ndarray) -> bool:
    return bool(fate(scene, row).labels == Fate.BOUNDED) and math.isfinite(float(period(scene, row)))


def after_a_period(limit: Limit) -> Found:
    """The answer where a whole period, enclosed, stays below the limit."""
    return Found(math.inf, math.inf, "proved",
                 f"{limit.words}: never, the motion repeats and a whole period stays below it")


def never_bounded(scene: AnyScene, state: Any, limit: Limit) -> Found | None:
    """The answer for a scene of other effects, where energy or momentum bound the rate below the limit; None
    where they do not."""
    if limit.kind == "tilt":
        return None
    found = motion(scene, state, brief=True)
    bound = found.invariants.get("rate_bound", math.inf)
    if found.fate == Fate.EQUILIBRIUM or (found.fate == Fate.BOUNDED
                                          and limit.beyond_rate(bound * (1 + SLACK))):
        why = ("the state is an equilibrium" if found.fate == Fate.EQUILIBRIUM
               else f"|omega| <= {bound:.6g} rad/s always")
        return Found(math.inf, math.inf, "exact", f"{limit.words}: never, {why}")
    return None


def earliest(scene: AnyScene, start: Sequence[Number], limit: Limit) -> Fraction:
    """The time in the scene's unit, exact; 0 where nothing is known (scaled variables, tilts). scene: wheel
    and torque; start: three exact rates."""
    if scene.variables == "scaled" or limit.kind == "tilt":
        return Fraction(0)
    D = scene.body.exact
    torque = scene.vector("constant_torque")
    push = sqrt_fraction(sum((Fraction(m) ** 2 / d for m, d in zip(torque, D)), Fraction(0)))
    if not push:
        return Fraction(0)
    begun = sqrt_fraction(sum((d * Fraction(w) ** 2 for d, w in zip(D, start)), Fraction(0)))
    least = min(most / _share(terms, D) for terms, most in limit.parts)
    return max(Fraction(0), (sqrt_fraction(least) * LESS - begun) / push * LESS)


def _share(terms: Sequence[Any], D: Sequence[Fraction]) -> Fraction:
    """q of a sum of squares."""
    shares = [c * sum(Fraction(v) ** 2 / d for v, d in zip(vector, D)) for c, vector in terms]
    axes = [[n for n, v in enumerate(vector) if v] for _, vector in terms]
    apart = all(len(one) == 1 for one in axes) and len({one[0] for one in axes}) == len(axes)
    return max(shares) if apart else sum(shares, Fraction(0))
