"""All that limits an answer about a motion, in words that every view shows: what its file says itself, a
limit that comes first, a torque of which only one direction was asked, an approximate law that does not
hold."""
from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from ..errors import Caveat, Kind
from ..orbit.result import Fate, Motion, Stability
from ..physics.coefficients import effective
from ..physics.scene import AnyScene, aligned, torque_axis
from ..reasons import DIGITS, Angle, Axis, Quantity, Rate, Reason, Sentence, Time, old

STEADY = (Fate.BOUNDED, Fate.EQUILIBRIUM)
IN_PLANE, THIS = 4, 5
HOLDS = Sentence("holds-only", "holds {condition}")
ALONG = Sentence("torque-along-axis", "only while the torque is exactly along {axis}")
CONDITIONS = (None, *(ALONG(axis=Axis(n)) for n in (1, 2, 3)),
              Sentence("torque-in-plane",
                       "only while the torque is exactly in the plane of the equal moments")(),
              Sentence("torque-as-given", "only while the torque is exactly this one")())
NO_SUCH_BODY = Sentence("no-such-body", "no rigid body has these moments of inertia")()
UNSEEN = Sentence("tilt-not-looked-at",
                  "a tilt of the torque, by the misalignment of {thrusters}, is not looked at here")
UNSTABLE = Sentence("unstable-equilibrium", "unstable: a disturbance grows by the factor e in {time}")
UNSTABLE_SLOWLY = Sentence("unstable-not-exponential",
                           "unstable: a disturbance grows, though not exponentially at first")
UNSTABLE_POINT = Sentence("unstable-equilibrium-of-a-point",
                          "an equilibrium that is not known to be stable")()
STABILITY_OPEN = Sentence("stability-open", "whether this equilibrium is stable is not known")
REACHES = Sentence("reaches-limit", "reaches {limit} after {time} ({level})")
AT_START = Sentence("limit-at-start", "reaches {limit} at the start already")
IN_A_COMPONENT = Sentence("rate-of-a-component", "{rate} in a component")
TILTED_TO = Sentence("tilted-reaches", "tilted by {angle} it reaches {limit} after {time} ({level})")
TILTED_NOT_BEFORE = Sentence("tilted-not-before",
                             "tilted by {angle} it does not reach {limit} before {time} (proved)")
TILTED_NOT_FOUND = Sentence("tilted-not-found",
                            "tilted by {angle} it was not found to reach {limit} within {time}")


def caveats_of(scene: AnyScene, steady: bool = False, tilt: Any = None,
               first: tuple[Any, Any] | None = None, validity: Any = None, file: Iterable[Caveat] = (),
               stability: Stability | None = None) -> tuple[Caveat, ...]:
    """The caveats of one answer.

    steady: whether it says that the motion is bounded or an equilibrium, or that it never reaches a limit;
    tilt: a `Tilt` or a `Spread`, where that was asked;
    first: (limit of the case as `stated`, `TimeTo` of it), where that was asked; validity: of an approximate
    law; file: the caveats of the case; stability: of a state of equilibrium.
    """
    return (*file, *of_equilibrium(scene, stability), *_reached(scene, first), *_tilted(scene, steady, tilt),
            *of_law(validity))


def of_equilibrium(scene: AnyScene, stability: Stability | None) -> tuple[Caveat, ...]:
    """That a state of equilibrium is not known to be stable, where it is not."""
    if stability is None or stability.verdict.endswith("stable") and not stability.unstable:
        return ()
    if not stability.unstable:
        return (Caveat(Kind.UNSTABLE, STABILITY_OPEN()),)
    if stability.growth is None:
        return (Caveat(Kind.UNSTABLE, UNSTABLE_SLOWLY()),)
    return (Caveat(Kind.UNSTABLE, UNSTABLE(time=Quantity(1 / stability.growth, scene.time_unit))),)


def of_law(validity: Any) -> tuple[Caveat, ...]:
    """That an approximate law does not hold, where it does not."""
    return () if validity is None or validity.held else (Caveat(Kind.LAW, old(validity.words)),)


def limited(motion: Motion, scene: AnyScene, case: Any = None) -> Motion:
    """The motion with its caveats; case: whose motion it is."""
    file = () if case is None else (*case.caveats, *(unseen(case) if motion.tilt is None else ()))
    return replace(motion, caveats=caveats_of(scene, motion.fate in STEADY, motion.tilt, motion.first,
                                              motion.validity, file, motion.stability))


def misaligned(case: Any) -> tuple[str, ...]:
    """The thrusters that fire for ever and state by how much they may point elsewhere."""
    return tuple(thruster.name for thruster in case.thrusters if thruster.stuck and thruster.misalignment)


def unseen(case: Any) -> tuple[Caveat, ...]:
    """That a misalignment which the case states is left out of an answer."""
    names = misaligned(case)
    return (Caveat(Kind.TILT, UNSEEN(thrusters=names)),) if names else ()


def condition(scene: AnyScene) -> int:
    """On what a steady motion rests, a constant torque being one of many: an index of CONDITIONS; 0 without
    one, and where liquid, medium or field bound the motion."""
    twin = effective(scene)
    acting = sum(m != 0 for m in twin.quadratic().m) if twin.plain else 0
    return 0 if not acting else torque_axis(twin) if acting == 1 else IN_PLANE if aligned(twin) else THIS


def stated(limits: Any) -> Quantity | Reason:
    """The limit of a case."""
    if limits.rate is not None:
        return Rate(float(limits.rate), digits=DIGITS)
    rates = tuple(map(float, limits.rates))
    return IN_A_COMPONENT(rate=Rate(rates[0] if len(set(rates)) == 1 else rates, digits=DIGITS))


def _reached(scene: AnyScene, first: tuple[Any, Any] | None) -> list[Caveat]:
    """The time at which the limit of the case is reached, where it is."""
    if first is None or not math.isfinite(first[1].high):
        return []
    limit, found = first
    after = Quantity(0.5 * float(found.low + found.high), scene.time_unit)
    return [Caveat(Kind.LIMIT, REACHES(limit=limit, time=after, level=str(found.level)) if found.high > 0
                   else AT_START(limit=limit))]


def _tilted(scene: AnyScene, steady: bool, found: Any) -> list[Caveat]:
    """The condition of a steady motion, and what is known of a tilt."""
    known = CONDITIONS[condition(scene)] if steady else None
    holds = None if known is None else HOLDS(condition=known)
    if found is not None and found.ranges:
        return [Caveat(Kind.TILT, one) for one in (holds, found.reason) if one]
    if holds is None:
        return []
    if found is None or found.untilted:
        return [Caveat(Kind.TILT, holds)]
    limit = Rate(found.limit, digits=DIGITS) if found.stated else Rate(found.limit)
    by = {"angle": Angle(found.angle), "limit": limit}
    if found.ends:
        reached = TILTED_TO(**by, time=Time(found.low), level=found.level)
        return [Caveat(Kind.TILT, holds.then(reached, ": "))]
    if found.not_before >= found.followed:
        return [Caveat(Kind.TILT, holds.then(TILTED_NOT_BEFORE(**by, time=Time(found.not_before).lower)))]
    return [Caveat(Kind.TILT, holds.then(TILTED_NOT_FOUND(**by, time=Time(found.followed).lower)))]
