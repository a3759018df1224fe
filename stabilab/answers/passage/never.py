"""What is known of a limit without a run: that it is never reached, as rest, extremes, a bound or one whole
period tell; when a certified spin-up reaches it, by its clock; a time before which the torque cannot.

The torque feeds energy at a bounded rate. Let W = (omega . D omega)^(1/2), the root of twice the kinetic
energy. The torque alone does work, so that W W' = M . omega, and with M . omega <= |D^(-1/2) M| W

    W(t) <= W(0) + |D^(-1/2) M| t.

A quantity sum c (a . omega)^2 is at most q W^2, q the sum of the c a . D^(-1) a, or the greatest of them
where the a are different principal axes. It reaches its limit no earlier than q W^2 does.
"""
from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any, cast

import numpy as np

from ...numbers.exact import sqrt_fraction
from ...numbers.vectors import Exact3, Float3, Number
from ...orbit.result import Fate
from ...physics.scene import AnyScene, rests
from ...unreduced.spin_up.follow import spin_up
from ..extremes import extremes, period
from ..fate import fate
from ..kinds import kind_of
from ..motion import motion
from .limit import Limit, along_axes
from .run import Found

# the certificate is asked for again at these shares of the earliest time, where it is narrower
LATER = (0.5, 0.97)
LITTLE = 100_000  # steps that this may take: slow drifts pass many turns in few


def by_clock(scene: AnyScene, state: Float3, limit: Limit, followed: float, reached: float,
             found: Any = None) -> Found | None:
    """Bounds of the first crossing of a motion whose spin-up is certified; None where none is, or where the
    limit is not of a rate along it.

    followed: a time before which the limit is known not to be reached. The bounds of the trap hold from its
    own time on; where that is later than `followed` the lower end stays there. reached: how far a run came.
    found: what `spin_up` says of the motion, where it was asked already.
    """
    if limit.kind == "tilt" or None in [along_axes(terms) for terms, _ in limit.parts]:
        return None
    found = found or spin_up(scene, state)
    if found.fate != Fate.SPIN_UP or not found.axis or found.trap is None:
        return None
    times = _times(found, limit)
    if times is None:
        return None
    sure = found.t <= followed or found.level == "exact"
    if found.level == "certified" and times[0] > found.t:
        found, times = _narrower(scene, state, limit, found, times, reached)
    low = max(followed, times[0]) if sure else followed
    words = (f"{limit.words}: by the clock of the spin-up about axis {found.axis}, {found.level} from t = "
             f"{found.t:.6g} {scene.time_unit} on")
    return Found(low, max(times[1], low), found.level, words)


def _narrower(scene: AnyScene, state: Float3, limit: Limit, found: Any, times: Any, reached: float) -> Any:
    """(what is found, times) by certificates later on the way: as late as little work reaches, else as far as
    a run came. Each is met before the earliest time that the one before it gives."""
    for share in LATER:
        again = spin_up(scene, state, after=share * times[0], budget=LITTLE)
        if again.fate != Fate.SPIN_UP and share == LATER[0]:
            again = spin_up(scene, state, after=min(share * times[0], max(reached, found.t)))
        if again.fate != Fate.SPIN_UP or again.t > times[0] or not (narrower := _times(again, limit)):
            # bounds that hold from a time on at which the limit may have been reached say nothing of the
            # first
            break
        found, times = again, (max(times[0], narrower[0]), min(times[1], narrower[1]))
    return found, times


def _times(found: Any, limit: Limit) -> Any:
    """(earliest, latest) of all parts, or None where none of them grows with the spin."""
    bounds, spin, times = found.trap.bounds(), found.axis - 1, []
    for terms, most in limit.parts:
        weights = cast(list[float], along_axes(terms))  # asked above
        across = sum(c * max(abs(low), abs(high)) ** 2
                     for n, (c, (low, high)) in enumerate(zip(weights, bounds)) if n != spin and c)
        if not weights[spin]:
            if across >= float(most):
                return None  # a rate across the spin may reach it at any time
            continue
        late = found.trap.clock(math.sqrt(float(most) / weights[spin]))[1]
        rest = float(most) - across
        early = found.trap.clock(math.sqrt(rest / weights[spin]))[0] if rest > 0 else 0.0
        times.append((early, late))
    return (min(t for t, _ in times), min(t for _, t in times)) if times else None


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
    bounded = lambda: fate(scene, row).labels == Fate.BOUNDED
    if kind == "aligned" and not (bounded() and math.isfinite(float(period(scene, row)))):
        return None, None  # its extremes over all time are not known
    if limit.beyond(extremes(scene, row).tolist(), SLACK):
        return Found(math.inf, math.inf, "exact",
                     f"{limit.words}: never, the extremes over all time stay below it"), None
    repeats = float(period(scene, row)) if kind == "orbit" and bounded() else math.inf
    return None, repeats * (1 + SLACK) if 0 < repeats < math.inf else None


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
    if found.fate == Fate.EQUILIBRIUM:
        why = "the state is an equilibrium"
    elif found.fate == Fate.BOUNDED and bound * (1 + SLACK) < limit.least_rate():
        why = f"|omega| <= {bound:.6g} rad/s always"
    else:
        return None
    return Found(math.inf, math.inf, "exact", f"{limit.words}: never, {why}")


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
