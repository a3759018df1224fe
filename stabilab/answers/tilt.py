"""What a tilt of the torque does to a motion, and another size of it: no thruster points exactly along an
axis, or has exactly the force that is stated.

A verdict that rests on a torque exactly on an axis is lost with any tilt: the integrals of the axis drift,
and the motion leaves its well after a time like 1/tilt. Two answers stand beside it: the shortest time to
the rate limit that is found at the edge of the cone of torques, and a time before which no torque of the
cone reaches it (`passage.stays_below`). Any other motion has a range instead: of the time to its limit, or
of its fate, over the cone. Where forces have a tolerance, each is looked at with its least and its greatest
size too, and the range is over these as well."""
from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import pairwise, product
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, TypeAlias

import numpy as np

from ..errors import InputError
from ..numbers.polynomial import compass_search
from ..numbers.vectors import Exact3
from ..orbit.result import OUTCOMES, Motion, Needs
from ..physics.coefficients import effective, three_floats
from ..physics.scene import AnyScene, Scene, torque_axis
from ..reasons import Filling, Quantity, Rate, Reason, Sentence, Time
from ..validation import checked_scene
from .caveats import STEADY, known_between, varied
from .kinds import kind_of
from .limit import Limit, asked
from .motion import motion
from .passage import run_once, stays_below
from .time_to import of_one, time_to

if TYPE_CHECKING:
    from ..case.read import Case

DEGREE = math.pi / 180  # taken where nothing states an angle
AZIMUTHS, REFINED = 12, 4  # looked at round the edge of the cone; halvings of the interval about the nearest
EDGE = [2 * math.pi * n / AZIMUTHS for n in range(AZIMUTHS)]
AZIMUTH_STEPS = 60_000  # of a run at one azimuth
SIDES, FEW = 6, 20_000  # directions of a cone that is one of many, and steps of a run at one
HALVINGS, BEND = 3, 0.02  # of an interval of angles; relative: by so much a time is off a power of the angle
WORK = 8_000_000  # multiplications for a proof of the shortest time
MANY = 3  # thrusters with a tolerance, of which all combinations of sizes are looked at
BETWEEN = (-0.5, 0.5)  # of the tolerance: sizes of all forces together that are looked at too, without a tilt
TWICE = 2.0  # times the largest rate of the bounded motion: the limit where none is stated
UP = 1 + 1e-12  # more than the rounding of a few doubles
DIRECTIONS = Sentence("directions-of-the-torque", "{directions} directions of the torque tried")
TORQUES = Sentence("torques-looked-at", "{directions} torques tried")
NOT_LOOKED_AT = Sentence("cone-not-looked-at", "a tilt of the torque is not looked at {why}")
BY_FATES = Sentence("cone-fates", "{varied} it {fates} of {looked}")
NONE_REACHES = Sentence("cone-none-found", "{varied} it was not found to reach {limit} within "
                        "{time} in any of {looked}")
RUNS_END = Sentence("cone-runs-end", "{varied} it may reach {limit} earlier or later: runs end after {time} "
                    "with none of {looked} there yet, and untilted it is there after {untilted}")
SOME_LATER = Sentence("cone-some-runs-end",
                      "{varied} it reaches {limit} after {first} at the earliest of {looked} "
                      "(times: {level}), in some of them not within {time}, where runs end, before that of "
                      "the torque untilted")
SOME_REACH = Sentence("cone-some-reach", "{varied} it reaches {limit} after {first} at the earliest "
                      "of {looked} (times: {level}), in some of them not within {time}")
ALL_REACH = Sentence("cone-all-reach", "{varied} it reaches {limit} after {first} at the earliest "
                     "and after {last} at the latest of {looked} (times: {level})")
FORCE_WITHIN = Sentence("tolerance-of-a-force", "{thruster} within {percent} %")
FORCES_WITHIN = Sentence("tolerance-of-forces", "the force of {forces}")
PERCENT_DIGITS = 4
Tried: TypeAlias = list[tuple[float, float]]  # a value and its azimuth


class Part(NamedTuple):
    """What a force or torque adds that is tilted, or of another size: whole, first, second: (3,), N m; angle:
    half-angle, rad; share: of its size, by which that may be larger or smaller."""

    whole: np.ndarray
    first: np.ndarray
    second: np.ndarray
    angle: float
    share: float = 0.0

    def change(self, azimuth: float | None, size: float) -> np.ndarray:
        """(3,), N m, at an azimuth of its cone, None: without a tilt, and a size from -1 to 1."""
        full, first, second, a, fraction = self
        turned = (0.0 if azimuth is None else (math.cos(a) - 1) * full
                  + math.sin(a) * (math.cos(azimuth) * first + math.sin(azimuth) * second))
        return turned + size * fraction * (full + turned)


@dataclass(frozen=True)
class Cone:
    """torque: as stated, N m, principal axes; parts: of what may be other: at azimuth phi the change is
    (cos - 1) whole + sin (cos phi first + sin phi second), and at a size s, from -1 to 1, s share times the
    whole and that besides. subject: what is tilted; angle: the largest half-angle; within: which forces have
    which tolerance, None where none has."""

    torque: np.ndarray
    parts: tuple[Part, ...]
    subject: str
    angle: float
    within: Reason | None = None

    def at(self, azimuth: float | None, sizes: Sequence[float] = ()) -> np.ndarray:
        """The torque (3,) at the edge of the cone, None: without a tilt; sizes: of every part, as stated
        where there are none."""
        return self.torque + sum(part.change(azimuth, size) for part, size in
                                 zip(self.parts, sizes or (0.0,) * len(self.parts)))

    @cached_property
    def corners(self) -> tuple[tuple[float, ...], ...]:
        """Sizes of the parts: as stated, and at the ends of their tolerances, in all combinations where these
        are few, else all alike and each by itself."""
        loose = [n for n, part in enumerate(self.parts) if part.share]
        if len(loose) <= MANY:
            ends = list(product((-1.0, 1.0), repeat=len(loose)))
        else:
            ends = [(s,) * len(loose) for s in (-1.0, 1.0)]
            ends += [tuple(s * (n == m) for m in loose) for n in loose for s in (-1.0, 1.0)]
        rows = [dict(zip(loose, row)) for row in ends if row]
        return ((0.0,) * len(self.parts),
                *(tuple(row.get(n, 0.0) for n in range(len(self.parts))) for row in rows))

    @property
    def between(self) -> list[tuple[float, ...]]:
        """Sizes inside the tolerances, of all parts alike."""
        return [tuple(s * bool(part.share) for part in self.parts) for s in BETWEEN] if self.within else []

    @property
    def edge(self) -> list[float]:
        """The azimuths that are looked at: none of a cone that only has sizes."""
        return EDGE if self.angle or not self.within else []

    def sizes_alone(self) -> Cone:
        """The same forces without a tilt."""
        return replace(self, angle=0.0, parts=tuple(part._replace(angle=0.0) for part in self.parts))

    def reach(self) -> tuple[float, tuple[float, float]]:
        """(most of the part across the axis, (least, most) of the component along it) of every torque in the
        cone."""
        axis = int(np.argmax(np.abs(self.torque)))
        across = [n for n in range(3) if n != axis]
        side = sum((1 + r) * ((1 - math.cos(a)) * math.hypot(*full[across])
                              + math.sin(a) * np.linalg.norm(np.stack([first, second])[:, across], 2))
                   + r * math.hypot(*full[across]) for full, first, second, a, r in self.parts)
        along = sum((1 + r) * ((1 - math.cos(a)) * abs(full[axis])
                               + math.sin(a) * math.hypot(first[axis], second[axis])) + r * abs(full[axis])
                    for full, first, second, a, r in self.parts)
        along += math.sin(self.angle) * sum(part.share * math.hypot(*part.whole[across])
                                            for part in self.parts)  # across by its size, along by the tilt
        blur = (UP - 1) * (float(np.abs(self.torque).max()) + side + along)
        return float(side) + blur, (float(self.torque[axis] - along) - blur,
                                    float(self.torque[axis] + along) + blur)


def cone_of(scene: Scene, case: Any = None, angle: float | None = None) -> Cone:
    """The cone of a scene's torque: tilted as a whole by `angle`, or, without it, as the stuck thrusters of
    the case state; their forces have the sizes of their tolerances in both.

    Azimuth 0 of a torque along an axis lies towards the axis that follows it, cyclically; of another across
    the axis that is farthest from it; of a thruster, across the structural axis that is farthest from its
    force.
    """
    torque = np.array([float(v) for v in scene.vector("constant_torque")])
    axis = int(np.argmax(np.abs(torque)))
    firing = [] if case is None else [t for t in case.thrusters if t.stuck]
    full = cone_of_forces(case, torque, firing, angle is None)
    forces, within = full.parts, full.within
    if full.angle or angle is None:
        return full
    first, second = (abs(torque[axis]) * np.eye(3)[(axis + n) % 3] for n in (1, 2))
    if np.count_nonzero(torque) > 1:
        first = np.cross(np.eye(3)[int(np.argmin(np.abs(torque)))], torque)
        first *= np.linalg.norm(torque) / np.linalg.norm(first)
        second = np.cross(torque, first) / np.linalg.norm(torque)
    if len(forces) == 1 and np.array_equal(forces[0].whole, torque):  # the whole torque is that force's
        part = Part(torque, first, second, angle, forces[0].share)
        return Cone(torque, (part,), "the torque", angle, within)
    # what is tilted is the torque as stated, larger by what the forces may add
    more = 1 + sum(part.share * np.linalg.norm(part.whole) for part in forces) / np.linalg.norm(torque)
    return Cone(torque, (Part(more * torque, more * first, more * second, angle), *forces), "the torque",
                angle, within)


def cone_of_forces(case: Case, torque: np.ndarray, firing: Sequence[Any], tilts: bool = True) -> Cone:
    """What the thrusters that fire may add to a torque (3,) within what they state: sizes, and directions
    where `tilts`; a part for each that states any, in their order."""
    sized = [t for t in firing if t.force_tolerance]
    named = [t.name for t in firing if tilts and t.misalignment] or [t.name for t in sized]
    within = tuple(FORCE_WITHIN(thruster=t.name, percent=Quantity(float(100 * t.force_tolerance / t.force),
                                                                  digits=PERCENT_DIGITS)) for t in sized)
    parts = tuple(_of_force(case, t, tilts and bool(t.misalignment)) for t in firing
                  if t.force_tolerance or (tilts and t.misalignment))
    return Cone(torque, parts, "the force of " + " and ".join(named),
                max((part.angle for part in parts), default=0.0),
                FORCES_WITHIN(forces=within) if sized else None)


def _of_force(case: Any, thruster: Any, tilts: bool) -> Part:
    """The torque of a thruster whose force points anywhere in its cone, along principal axes; tilts: whether
    it does."""
    force = np.array([float(v) for v in thruster.direction])
    arm = np.array([float(v) for v in thruster.arm])
    aside = np.eye(3)[int(np.argmin(np.abs(force)))]
    first = np.cross(aside, force)
    first /= np.linalg.norm(first)
    frame = np.array([[float(v) for v in axis] for axis in case.frame.axes])
    turned = [frame @ np.cross(arm, float(thruster.force) * v)
              for v in (force, first, np.cross(force, first))]
    fraction = float(thruster.force_tolerance / thruster.force) if thruster.force_tolerance else 0.0
    return Part(turned[0], turned[1], turned[2], float(thruster.misalignment) if tilts else 0.0, fraction)


def tilted(scene: Scene, torque: np.ndarray) -> Scene:
    """The scene under another torque (3,), its doubles taken at their word."""
    others = [effect for effect in scene.effects if effect.name != "constant_torque"]
    kind = type(scene.effect("constant_torque"))
    return Scene(scene.body, *others, kind(tuple(Fraction(float(v)) for v in torque)))


@dataclass(frozen=True)
class Tilt:
    """angle: half-angle of the cone, rad; of: what is tilted; limit: rad/s, of |omega|, or the least of three
    components; stated: whether the case gives it. not_before: no torque of the cone reaches the limit before
    (s, proved). low, high, level: of the shortest time found, as of `TimeTo`, at azimuth (rad) under torque
    (3,) N m, principal axes; None where none was found, and followed says how long. azimuths, times: (n,) of
    those that were looked at (one, where a run falls short of not_before), inf where the limit was not
    reached. untilted: (low, high) of the time at which the bounded motion itself reaches the limit, None
    where it never does. within: which forces have which tolerance, all of which not_before and times include;
    forces: what these alone do, without a tilt, None where none has any."""

    ranges: ClassVar[bool] = False

    angle: float
    of: str
    limit: float
    stated: bool
    not_before: float
    low: float | None
    high: float | None
    level: str
    azimuth: float | None
    torque: tuple[float, ...] | None
    followed: float
    azimuths: np.ndarray
    times: np.ndarray
    untilted: tuple[float, float] | None = None
    within: Reason | None = None
    forces: Spread | None = None

    @property
    def ends(self) -> bool:
        """Whether a tilt was found that reaches the limit."""
        return self.high is not None

    @property
    def varies(self) -> bool:
        """Whether the answer is another for some force within its tolerance."""
        return self.forces is not None and self.forces.varies


@dataclass(frozen=True)
class Spread:
    """angle: half-angle of the cone, rad; of: what is tilted; directions: of the torque that were looked at,
    its own and those round the edge of the cone. limit: rad/s as of `Limit.least_rate`, None where no limit
    is asked: then fates says in how many directions the motion has which fate. earliest, latest: (low, high)
    of the least and the greatest time found, s, None where the limit was not reached in any direction, or not
    in all of them within `followed`, s; level: of both, as of `TimeTo`. omitted: why none was looked at.
    untilted: (low, high) of the time of the torque itself, s, where runs end before it; else None.
    within: which forces have which tolerance: the torques looked at have their sizes too."""

    ranges: ClassVar[bool] = True

    angle: float
    of: str
    directions: int
    limit: float | None = None
    earliest: tuple[float, float] | None = None
    latest: tuple[float, float] | None = None
    level: str = "run"
    followed: float = math.inf
    fates: tuple[tuple[str, int], ...] = ()
    omitted: str = ""
    untilted: tuple[float, float] | None = None
    within: Reason | None = None

    @property
    def varies(self) -> bool:
        """Whether forces have a tolerance and not all torques looked at do the same: reach the limit or not,
        or have one fate."""
        return bool(self.within) and (len(self.fates) > 1
                                      or (self.earliest is not None and self.latest is None))

    @property
    def because(self) -> str:
        """Why none was looked at."""
        return self.omitted

    @property
    def reason(self) -> Reason:
        """What is found."""
        if self.omitted:
            return NOT_LOOKED_AT(why=self.omitted)
        resolved: dict[str, Filling] = {
            "varied": varied(self.angle, self.within),
            "looked": (TORQUES if self.within else DIRECTIONS)(directions=self.directions)}
        if self.limit is None:
            fates = ", ".join(f"{word} in {count}" for word, count in self.fates)
            return BY_FATES(**resolved, fates=fates)
        resolved |= {"limit": Rate(self.limit)}
        if self.earliest is None and self.untilted:
            return RUNS_END(**resolved, time=Time(self.followed).lower,
                            untilted=known_between(*self.untilted))
        if self.earliest is None:
            return NONE_REACHES(**resolved, time=Time(self.followed).lower)
        resolved |= {"first": Time(self.earliest[0]).lower, "level": self.level}
        if self.latest is None:
            return (SOME_LATER if self.untilted else SOME_REACH)(**resolved, time=Time(self.followed).lower)
        return ALL_REACH(**resolved, last=Time(self.latest[1]).upper)


def tilt(scene: AnyScene, state: Any, angle: float | None = None, rate: Any = None, case: Any = None,
         exact: Exact3 | None = None, ask: dict[str, Any] | None = None) -> Tilt:
    """What a tilt of the torque does to a motion under a torque on a principal axis that is bounded, or never
    reaches a limit.

    scene: of a body; state: three rates; angle: rad, the half-angle of the cone of torques (None: what the
    stuck thrusters of `case` state as their misalignment, else one degree); rate: limit of |omega|, rad/s, or
    three of its components; ask: or any limit by its name as of `time_to` (neither: twice the largest rate of
    the bounded motion). exact: three exact numbers that the state is the rounding of. Raises InputError where
    the torque is not on an axis, or no limit stated and the motion not bounded.
    """
    scene, state = checked_scene(scene), three_floats(state)
    if scene.variables == "scaled" or not torque_axis(scene) or kind_of(scene) != "orbit":
        raise InputError("tilt: expected a body under a torque along one of its principal axes, without "
                         "wheel momentum along it")
    declared = ask if rate is None else {"rate": rate}
    resolved = motion(scene, state, needs=Needs.FATE if declared else Needs.EXTREMES, exact=exact)
    if resolved.fate not in STEADY and not declared:
        raise InputError("tilt: the motion is not bounded as it is: ask time_to of it")
    if angle is None and not (case is not None and any(t.stuck and t.misalignment for t in case.thrusters)):
        angle = DEGREE
    if angle is not None and not 0 < angle < math.pi / 2:
        raise InputError(
            f"tilt: expected an angle between 0 and a quarter turn (pi/2 rad), got {angle!r} rad")
    question = declared or _twice_the_largest(resolved)
    limit = asked(scene, **question)
    cone = cone_of(scene, case, angle)
    lower = limit.least_rate()
    exactly = time_to(scene, state, **question, exact=exact, work=WORK)
    not_before = stays_below(scene, state, lower, *cone.reach())

    def time(azimuth: float) -> tuple[float, float]:
        """The earliest of the torques there, and until when none of them was followed."""
        rows = [run_once(scene, state, limit, steps=AZIMUTH_STEPS, torque=cone.at(azimuth, sizes).tolist())
                 for sizes in cone.corners]
        return min(t for t, _ in rows), min(until for _, until in rows)
    tried: Tried = []
    followed = math.inf
    for azimuth in EDGE:
        t, until = time(azimuth)
        tried, followed = [*tried, (t, azimuth)], min(followed, until)
        if until < not_before:  # so do runs of as many steps at the other azimuths, or nearly
            break
    if math.isfinite(min(tried)[0]):
        tried = nearest_round(lambda azimuth: time(azimuth)[0], tried)
    azimuths, times = np.array(sorted((azimuth, t) for t, azimuth in tried)).T
    out: dict[str, Any] = {"low": None, "high": None, "level": "run", "azimuth": None, "torque": None}
    if np.isfinite(times).any():
        azimuth = float(azimuths[np.argmin(times)])
        torque = min((cone.at(azimuth, sizes) for sizes in cone.corners), key=lambda item: run_once(
            scene, state, limit, steps=AZIMUTH_STEPS, torque=item.tolist())[0])
        # by runs: the validated steps of a proof take a machine ten seconds to compile, which nobody who asks
        # for the first time awaits
        first = time_to(tilted(scene, torque), state, **question, exact=exact, work=0)
        out = {"low": float(first.low), "high": float(first.high) if first.high == first.high
                 else float(times.min()), "level": str(first.level),
                 "azimuth": azimuth, "torque": tuple(torque.tolist())}
    forces = spread(scene, state, cone.sizes_alone(), question, exact) if cone.within else None
    return Tilt(cone.angle, cone.subject, lower, declared is not None, not_before, **out, followed=followed,
                azimuths=azimuths, times=times,
                untilted=(float(exactly.low), float(exactly.high)) if exactly.high < math.inf else None,
                within=cone.within, forces=forces)


def _twice_the_largest(resolved: Motion) -> dict[str, Any]:
    """The limit that is asked for where none is stated, of a motion whose extremes are known."""
    return {"rate": TWICE * math.hypot(*(max(map(abs, pair)) for pair in resolved.extremes or ()))}


def spread(scene: Scene, state: Sequence[float], cone: Cone, ask: dict[str, Any] | None,
           exact: Exact3 | None = None, steps_first: bool = False) -> Spread:
    """The range over the torque itself and those at the edge of its cone, with forces of every size in
    `Cone.corners`. ask: the limit, by its name as of `time_to`; None: the fates.
    steps_first: as of `time_to.of_one`."""
    places = [(None, cone.corners[0]), *((at, sizes) for sizes in cone.corners for at in cone.edge),
              *((None, sizes) for sizes in (*cone.corners[1:], *cone.between))]
    torques = [cone.at(*index) for index in places]
    if ask is None:
        fate = lambda torque: motion(tilted(scene, torque), state, needs=Needs.FATE, exact=exact).fate
        result = Counter(OUTCOMES[fate(torque)].does for torque in torques)
        return Spread(cone.angle, cone.subject, len(torques), fates=tuple(result.most_common()),
                      within=cone.within)
    limit = asked(scene, **ask)
    time = lambda torque: run_once(scene, state, limit, steps=AZIMUTH_STEPS, torque=torque.tolist())
    times, ends = map(list, zip(*map(time, torques)))
    followed, untilted = min(ends), None
    if followed < math.inf:  # a run ended early: as long as the torque itself takes, or not
        alone = time_to(scene, state, **ask, exact=exact, work=0)
        if followed < alone.high < math.inf:
            untilted = float(alone.low), float(alone.high)
    if not np.isfinite(times).any():
        return Spread(cone.angle, cone.subject, len(torques), limit.least_rate(), followed=followed,
                      untilted=untilted, within=cone.within)
    largest, more = [], 0
    for sign in (1, -1):
        best, location = min(((sign * t, index) for t, index in zip(times, places)), key=lambda item: item[0])
        sizes = location[1] if location[1] in cone.corners else cone.corners[0]
        edge = [(sign * t, at) for t, (at, of) in zip(times, places) if at is not None and of == sizes]
        if edge:
            signed = lambda azimuth, sign=sign, sizes=sizes: sign * time(cone.at(azimuth, sizes))[0]
            nearer, azimuth = min(nearest_round(signed, edge))
            location, more = (azimuth, sizes) if nearer < best else location, more + 2 * REFINED
        largest.append(cone.at(*location))
    start = tuple(map(Fraction, state)) if exact is None else exact
    exactly = [of_one(effective(tilted(scene, torque)), state, start, limit, None, WORK,
                      steps_first=steps_first)
               for torque in largest]
    first, last = [(float(item.low), float(item.high)) for item in exactly]
    all_of_them = bool(np.isfinite(times).all())
    levels = {str(item.level) for item in exactly[:1 + all_of_them]}
    return Spread(cone.angle, cone.subject, len(torques) + more, limit.least_rate(), first,
                  last if all_of_them and math.isfinite(last[1]) else None,
                  levels.pop() if len(levels) == 1 else "run", followed, untilted=untilted,
                  within=cone.within)


@dataclass(frozen=True)
class ByAngle:
    """Of cones of torques of half-angles (n,), rad: earliest, latest: (n,) s, of the times at which runs at
    their edges reach the limit, inf where one does not within its steps; not_before: (n,) s, before which no
    torque of the cone reaches it (proved), 0 where nothing is. limit: what is reached; of: what is tilted;
    within: which forces have which tolerance, over which the times are as well."""

    angles: np.ndarray
    earliest: np.ndarray
    latest: np.ndarray
    not_before: np.ndarray
    limit: Limit
    of: str
    within: Reason | None = None


def by_angle(scene: Scene, state: Any, angles: np.ndarray, case: Any = None,
             ask: dict[str, Any] | None = None, closer: bool = False) -> ByAngle:
    """The time to a limit against the tilt of the torque, by runs at SIDES directions round each cone.

    scene: a body with wheels under a constant torque; angles: (n,) rad, rising; case: whose stuck thrusters
    are tilted, where they state a misalignment; ask: the limit, by its name as of `time_to`, None for twice
    the largest rate of a bounded motion. closer: more angles between these where a time is no power of the
    angle.
    """
    ask = ask or _twice_the_largest(motion(scene, state, needs=Needs.EXTREMES))
    limit, cone = asked(scene, **ask), cone_of(scene, case, DEGREE)
    if case is not None and any(t.stuck and t.misalignment for t in case.thrusters):
        cone = cone_of(scene, case)

    def row(angle: float) -> tuple[float, float, float]:
        wider = replace(cone, angle=angle, parts=tuple(
            part._replace(angle=angle) if part.angle else part for part in cone.parts))
        times = [run_once(scene, state, limit, steps=FEW, torque=wider.at(azimuth, sizes).tolist())[0]
                 for sizes in cone.corners for azimuth in EDGE[::len(EDGE) // SIDES]]
        sure = stays_below(scene, state, limit.least_rate(), *wider.reach()) if torque_axis(scene) else 0.0
        return min(times), max(times), sure
    rows = {angle: row(angle) for angle in angles.tolist()}
    parts = list(pairwise(rows))
    for _ in range(HALVINGS if closer else 0):
        halves: list[tuple[float, float]] = []
        for low, high in parts:
            middle = math.sqrt(low * high)
            rows[middle] = row(middle)
            if _bends(rows[low][:2], rows[middle][:2], rows[high][:2]):
                halves += [(low, middle), (middle, high)]
        parts = halves
    earliest, latest, not_before = np.array([rows[angle] for angle in sorted(rows)]).T
    return ByAngle(np.array(sorted(rows)), earliest, latest, not_before, limit, cone.subject,
                   cone.within)


def _bends(*times: tuple[float, ...]) -> bool:
    """Whether times at three angles, each the mean of its neighbours in logarithms, are not so; one that no
    run reaches bends nothing."""
    with np.errstate(all="ignore"):
        before, between, after = np.log(times)
        return bool((np.abs(between - (before + after) / 2) > BEND)[np.isfinite(before + after)].any())


def nearest_round(value: Callable[[float], float], tried: Tried) -> Tried:
    """The (value, azimuth) of a function round the edge of a cone that were tried, and more of them, closer
    and closer to the least."""
    once_round = lambda azimuth: azimuth % (2 * math.pi)
    return compass_search(value, tried, math.pi / AZIMUTHS, REFINED, once_round)
