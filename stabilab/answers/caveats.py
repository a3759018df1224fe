"""All that limits an answer about a motion, in words that every view shows: what its file says itself, a
limit that comes first, a torque of which only one direction was asked, an approximate law that does not
hold."""
from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from ..errors import Caveat
from ..orbit.result import Fate, Motion
from ..physics.coefficients import effective
from ..physics.scene import AnyScene, aligned, torque_axis

STEADY = (Fate.BOUNDED, Fate.EQUILIBRIUM)
IN_PLANE, THIS = 4, 5
ONLY = "holds only while the torque is exactly"
HOLDS = ("", f"{ONLY} along axis 1", f"{ONLY} along axis 2", f"{ONLY} along axis 3",
         f"{ONLY} in the plane of the equal moments", f"{ONLY} this one")
UNPHYSICAL = "no rigid body has these moments of inertia"


def caveats_of(scene: AnyScene, steady: bool = False, tilt: Any = None, first: tuple[str, Any] | None = None,
               validity: Any = None, file: Iterable[Caveat] = ()) -> tuple[Caveat, ...]:
    """The caveats of one answer.

    steady: whether it says that the motion is bounded or an equilibrium, or that it never reaches a limit;
    tilt: a `Tilt` or a `Spread`, where that was asked;
    first: (limit of the case in words, `TimeTo` of it), where that was asked; validity: of an approximate
    law; file: the caveats of the case.
    """
    return (*file, *_reached(scene, first), *_tilted(scene, steady, tilt), *of_law(validity))


def of_law(validity: Any) -> tuple[Caveat, ...]:
    """That an approximate law does not hold, where it does not."""
    return () if validity is None or validity.held else (Caveat("law", validity.words),)


def limited(motion: Motion, scene: AnyScene, case: Any = None) -> Motion:
    """The motion with its caveats; case: whose motion it is."""
    file = () if case is None else (*case.caveats, *(unseen(case) if motion.tilt is None else ()))
    return replace(motion, caveats=caveats_of(scene, motion.fate in STEADY, motion.tilt, motion.first,
                                              motion.validity, file))


def misaligned(case: Any) -> tuple[str, ...]:
    """The thrusters that fire for ever and state by how much they may point elsewhere."""
    return tuple(thruster.name for thruster in case.thrusters if thruster.stuck and thruster.misalignment)


def unseen(case: Any) -> tuple[Caveat, ...]:
    """That a misalignment which the case states is left out of an answer."""
    names = misaligned(case)
    return (Caveat("tilt",
                   f"a tilt of the torque, by the misalignment of {' and '.join(names)}, is not looked at "
                   "here"),) if names else ()


def condition(scene: AnyScene) -> int:
    """On what a steady motion rests, a constant torque being one of many: an index of HOLDS; 0 without one,
    and where liquid, medium or field bound the motion."""
    twin = effective(scene)
    acting = sum(m != 0 for m in twin.quadratic().m) if twin.plain else 0
    return 0 if not acting else torque_axis(twin) if acting == 1 else IN_PLANE if aligned(twin) else THIS


def stated(limits: Any) -> str:
    """The limit of a case in words."""
    if limits.rate is not None:
        return f"{float(limits.rate):.6g} rad/s"
    if len(set(limits.rates)) == 1:
        return f"{float(limits.rates[0]):.6g} rad/s in a component"
    return f"({', '.join(f'{float(rate):.6g}' for rate in limits.rates)}) rad/s in a component"


def _reached(scene: AnyScene, first: tuple[str, Any] | None) -> list[Caveat]:
    """The time at which the limit of the case is reached, where it is."""
    if first is None or not math.isfinite(first[1].high):
        return []
    limit, found = first
    when = (f"after {0.5 * float(found.low + found.high):.6g} {scene.time_unit} ({found.level})"
            if found.high > 0 else "at the start already")
    return [Caveat("limit", f"reaches {limit} {when}")]


def _tilted(scene: AnyScene, steady: bool, found: Any) -> list[Caveat]:
    """The condition of a steady motion, and what is known of a tilt."""
    number = condition(scene) if steady else 0
    words = HOLDS[number]
    if found is not None and found.ranges:
        return [Caveat("tilt", one) for one in (words, found.words) if one]
    if not number:
        return []
    if found is None or found.untilted:
        return [Caveat("tilt", words)]
    limit, by = f"{found.limit:.6g} rad/s", f"tilted by {found.angle:.6g} rad it"
    if found.ends:
        return [Caveat("tilt", f"{words}: {by} reaches {limit} after {found.low:.6g} s ({found.level})")]
    if found.not_before >= found.followed:
        return [Caveat("tilt",
                       f"{words}; {by} does not reach {limit} before {found.not_before:.6g} s (proved)")]
    return [Caveat("tilt", f"{words}; {by} was not found to reach {limit} within {found.followed:.6g} s")]
