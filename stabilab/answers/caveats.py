"""All that limits an answer about a motion, in words that every view shows: what its file says itself, a
limit that comes first, a torque of which only one direction was asked, an approximate law that does not
hold."""
from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, TypeVar

from ..errors import Caveat, Kind, without
from ..orbit.result import Fate, Motion, Stability
from ..physics.coefficients import effective
from ..physics.scene import AnyScene, aligned, torque_axis
from ..reasons import DIGITS, Angle, Axis, Filling, Quantity, Rate, Reason, Sentence, Time, broad
from ..representation import Answer

if TYPE_CHECKING:
    from ..case.read import Case
    from ..physics.law_limits import Validity

Limited = TypeVar("Limited", bound=Answer)
STEADY = (Fate.BOUNDED, Fate.EQUILIBRIUM)
IN_PLANE, THIS = 4, 5
HOLDS = Sentence("holds-only", "holds {condition}")
ALONG = Sentence("torque-along-axis", "only while the torque is exactly along {axis}")
IN_THE_PLANE = Sentence("torque-in-plane",
                        "only while the torque is exactly in the plane of the equal moments")
AS_GIVEN = Sentence("torque-as-given", "only while the torque is exactly this one")
CONDITIONS = (None, *(ALONG(axis=Axis(n)) for n in (1, 2, 3)), IN_THE_PLANE(), AS_GIVEN())
# the same where a line has no room for it
IN_SHORT = {ALONG.code: Sentence("only-along-axis", "only with torque exactly along {axis}"),
            IN_THE_PLANE.code: Sentence("only-in-plane", "only with torque in the plane of equal moments"),
            AS_GIVEN.code: Sentence("only-this-torque", "only with exactly this torque")}
NO_SUCH_BODY = Sentence("no-such-body", "no rigid body has these moments of inertia")()
UNSTABLE = Sentence("unstable-equilibrium", "unstable: a disturbance grows by the factor e in {time}")
UNSTABLE_SLOWLY = Sentence("unstable-not-exponential",
                           "unstable: a disturbance grows, though not exponentially at first")
UNSTABLE_POINT = Sentence("unstable-equilibrium-of-a-point",
                          "an equilibrium that is not known to be stable")()
STABILITY_OPEN = Sentence("stability-open", "whether this equilibrium is stable is not known")
BETWEEN = Sentence("between-times", "{low} to {high}")
REACHES = Sentence("reaches-limit", "reaches {limit} after {time} ({level})")
AT_START = Sentence("limit-at-start", "reaches {limit} at the start already")
IN_A_COMPONENT = Sentence("rate-of-a-component", "{rate} in a component")
TILTED = Sentence("tilted-by", "tilted by {angle}")
WITHIN = Sentence("force-within", "with {within}")
TILTED_AND_WITHIN = Sentence("tilted-and-within", "tilted by {angle} and with {within}")
TILTED_TO = Sentence("tilted-reaches", "{varied} it reaches {limit} after {time} ({level})")
TILTED_NOT_BEFORE = Sentence("tilted-not-before", "{varied} it does not reach {limit} before {time} (proved)")
TILTED_NOT_FOUND = Sentence("tilted-not-found", "{varied} it was not found to reach {limit} within {time}")


@dataclass(frozen=True, kw_only=True)
class Known:
    """What is known of a question where its caveats are collected.

    scene: what moves; steady: whether the answer says that the motion is bounded or an equilibrium, or that
    it never reaches a limit; tilt: a `Tilt` or a `Spread`, where that was asked; first: (limit of the case as
    `stated`, `TimeTo` of it), where that was asked; validity: of an approximate law; file: the caveats of the
    case; stability: of a state of equilibrium.
    """

    scene: AnyScene
    steady: bool = False
    tilt: Any = None
    first: tuple[Any, Any] | None = None
    validity: Any = None
    file: tuple[Caveat, ...] = ()
    stability: Stability | None = None


def caveats_of(scene: AnyScene, steady: bool = False, tilt: Any = None,
               first: tuple[Any, Any] | None = None, validity: Any = None, file: Iterable[Caveat] = (),
               stability: Stability | None = None) -> tuple[Caveat, ...]:
    """The caveats of one answer, by every function of CAVEATS; arguments as of `Known`."""
    resolved = Known(scene=scene, steady=steady, tilt=tilt, first=first, validity=validity, file=tuple(file),
                  stability=stability)
    return tuple(dict.fromkeys(item for make in CAVEATS for item in make(resolved)))


def of_case(case: Case, validity: Validity | None = None, steady: bool = False) -> tuple[Caveat, ...]:
    """The caveats of an answer about a case that is no motion's. validity: of its approximate laws; steady:
    as of `Known`."""
    return caveats_of(case.scene, steady, validity=validity, file=case.caveats)


def answered(result: Limited, case: Case, validity: Validity | None = None) -> Limited:
    """What was found of a case, and is no motion, with all that limits it. validity: of its approximate laws.
    """
    caveats = of_case(case, validity)
    return result if caveats == result.caveats else replace(result, caveats=caveats)


def of_file(resolved: Known) -> tuple[Caveat, ...]:
    """What the file says itself, and what it states that an answer leaves out."""
    return resolved.file


def of_equilibrium(resolved: Known) -> tuple[Caveat, ...]:
    """That a state of equilibrium is not known to be stable, where it is not."""
    stability = resolved.stability
    if stability is None or stability.stable:
        return ()
    if not stability.unstable:
        return (Caveat(Kind.UNSTABLE, STABILITY_OPEN()),)
    if stability.growth is None:
        return (Caveat(Kind.UNSTABLE, UNSTABLE_SLOWLY()),)
    return (Caveat(Kind.UNSTABLE, UNSTABLE(time=Quantity(1 / stability.growth, resolved.scene.time_unit))),)


def of_law(resolved: Known) -> tuple[Caveat, ...]:
    """That an approximate law does not hold, where it does not."""
    held = resolved.validity is None or resolved.validity.held
    return () if held else (Caveat(Kind.LAW, resolved.validity.reason),)


def limited(motion: Motion, scene: AnyScene, case: Any = None) -> Motion:
    """The motion with its caveats; case: whose motion it is."""
    file = () if case is None else seen(case.caveats, motion.tilt)
    return replace(motion, caveats=caveats_of(scene, motion.fate in STEADY, motion.tilt, motion.first,
                                              motion.validity, file, motion.stability))


def misaligned(case: Case) -> tuple[str, ...]:
    """The thrusters that fire for ever and state by how much they may point elsewhere."""
    return tuple(thruster.name for thruster in case.thrusters if thruster.stuck and thruster.misalignment)


def loose_forces(case: Case) -> tuple[str, ...]:
    """The thrusters that fire for ever with a force of some tolerance."""
    return tuple(thruster.name for thruster in case.thrusters if thruster.stuck and thruster.force_tolerance)


def seen(caveats: Iterable[Caveat], result: Any = None, box: Any = None) -> tuple[Caveat, ...]:
    """The caveats of a case without those of tolerances and of misalignments, where these are looked at: by
    a `Tilt` or `Spread` found, tolerances also over a box."""
    sizes = [Kind.TOLERANCE] if box is not None or (result is not None and result.within) else []
    return without(caveats, *sizes, *([Kind.MISALIGNMENT] if result is not None else []))


def condition(scene: AnyScene) -> int:
    """On what a steady motion rests, a constant torque being one of many: an index of CONDITIONS; 0 without
    one, and where liquid, medium or field bound the motion."""
    twin = effective(scene)
    acting = sum(m != 0 for m in twin.quadratic().m) if twin.plain else 0
    return 0 if not acting else torque_axis(twin) if acting == 1 else IN_PLANE if aligned(twin) else THIS


def in_short(condition: Reason) -> Reason:
    """The condition of a steady motion in fewer words."""
    return replace(condition, sentence=IN_SHORT.get(condition.code, condition.sentence))


def stated(limits: Any) -> Quantity | Reason:
    """The limit of a case."""
    if limits.rate is not None:
        return Rate(float(limits.rate), digits=DIGITS)
    rates = tuple(map(float, limits.rates))
    return IN_A_COMPONENT(rate=Rate(rates[0] if len(set(rates)) == 1 else rates, digits=DIGITS))


def of_limit(resolved: Known) -> list[Caveat]:
    """The time at which the limit of the case is reached, where it is."""
    if resolved.first is None or not math.isfinite(resolved.first[1].high):
        return []
    limit, result = resolved.first
    after = known_between(float(result.low), float(result.high), resolved.scene.time_unit)
    return [Caveat(Kind.LIMIT, REACHES(limit=limit, time=after, level=str(result.level)) if result.high > 0
                   else AT_START(limit=limit))]


def known_between(low: float, high: float, unit: str = "s") -> Filling:
    """A time by its middle, or by both ends where these are far apart."""
    if broad(low, high):
        return BETWEEN(low=Quantity(low, unit).lower, high=Quantity(high, unit).upper)
    return Quantity(0.5 * (low + high), unit)


def of_direction(resolved: Known) -> list[Caveat]:
    """The condition of a steady motion, and what is known of a tilt."""
    only, result = CONDITIONS[condition(resolved.scene)] if resolved.steady else None, resolved.tilt
    holds = None if only is None else HOLDS(condition=only)
    if result is not None and result.ranges:
        return [Caveat(Kind.TILT, item) for item in (holds, result.reason) if item]
    if holds is None:
        return []
    sizes = [] if result is None or result.forces is None else [Caveat(Kind.TILT, result.forces.reason)]
    return [_off_axis(holds, result), *sizes]


def _off_axis(holds: Reason, result: Any) -> Caveat:
    """What a tilt does to a motion that rests on the torque's direction."""
    if result is None or result.untilted:
        return Caveat(Kind.TILT, holds)
    limit = Rate(result.limit, digits=DIGITS) if result.stated else Rate(result.limit)
    settled: dict[str, Any] = {"varied": varied(result.angle, result.within), "limit": limit}
    if result.ends:
        reached = TILTED_TO(**settled, time=Time(result.low), level=result.level)
        return Caveat(Kind.TILT, holds.then(reached))
    if result.not_before >= result.followed:
        return Caveat(Kind.TILT, holds.then(TILTED_NOT_BEFORE(**settled, time=Time(result.not_before).lower)))
    return Caveat(Kind.TILT, holds.then(TILTED_NOT_FOUND(**settled, time=Time(result.followed).lower)))


def varied(angle: float, within: Reason | None) -> Reason:
    """What a torque is varied by: a tilt, the tolerance of its forces (None without one), or both."""
    if within is None:
        return TILTED(angle=Angle(angle))
    return TILTED_AND_WITHIN(angle=Angle(angle), within=within) if angle else WITHIN(within=within)


# One function a kind of caveat: all that limits an answer is collected here, for every view of it
CAVEATS: tuple[Callable[[Known], Iterable[Caveat]], ...] = (of_file, of_equilibrium, of_limit, of_direction,
                                                            of_law)
