"""What becomes of a motion that a torque exactly on an axis keeps bounded, when the torque is a little off that axis.

No thruster points exactly along an axis, and such a verdict is lost with any tilt: the integrals of the axis drift, and the motion leaves its
well after a time like 1/tilt. Two answers stand beside the verdict: the shortest time to the rate limit that is found at the edge of the cone of torques,
and a time before which no torque of the cone reaches it (`passage.drift`).
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ..asked import checked_scene
from ..errors import InputError
from ..numbers.vectors import Exact3
from ..orbit.result import Fate
from ..physics.alignment import torque_axis
from ..physics.scene import AnyScene, Scene
from ..physics.state import three_floats
from .caveats import STEADY
from .extremes import extremes
from .fate import fate
from .kinds import kind_of
from .passage.cone import Cone, cone_of, tilted
from .passage.drift import stays_below
from .passage.limit import Limit, asked
from .passage.run import run_once
from .time_to import time_to

DEGREE = math.pi / 180  # taken where nothing states an angle
AZIMUTHS, REFINED = 12, 4  # looked at round the cone; halvings of the interval about the best
STEPS = 60_000  # of a run at one azimuth
WORK = 8_000_000  # multiplications for a proof of the shortest time
TWICE = 2.0  # times the largest rate of the bounded motion: the limit where none is stated


@dataclass(frozen=True)
class Tilt:
    """angle: half-angle of the cone, rad; of: what is tilted; limit: rad/s, of |omega|, or the least of three components; stated: whether the case
    gives it. not_before: no torque of the cone reaches the limit before (s, proved). low, high, level: of the shortest time found, as of `TimeTo`,
    at azimuth (rad) under torque (3,) N m, principal axes; None where none was found, and followed says how long. azimuths, times: (n,) of those that were
    looked at (one, where a run falls short of not_before), inf where the limit was not reached. untilted: (low, high) of the time at which the bounded
    motion itself reaches the limit, None where it never does."""

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

    @property
    def ends(self) -> bool:
        """Whether a tilt was found that reaches the limit."""
        return self.high is not None


def tilt(scene: AnyScene, state: Any, angle: float | None = None, rate: Any = None, case: Any = None, exact: Exact3 | None = None,
         ask: dict[str, Any] | None = None) -> Tilt:
    """What a tilt of the torque does to a bounded motion under a torque on a principal axis.

    scene: of a body; state: three rates; angle: rad, the half-angle of the cone of torques (None: what the stuck thrusters of `case` state as
    their misalignment, else one degree); rate: limit of |omega|, rad/s, or three of its components (None: that of the case, else twice the
    largest rate of the bounded motion). exact: three exact numbers that the state is the rounding of. ask: another limit, by its name as of `time_to`.
    Raises InputError where the torque is not on an axis, or the motion not bounded.
    """
    scene, state = checked_scene(scene), three_floats(state)
    if scene.variables == "scaled" or not torque_axis(scene) or kind_of(scene) != "orbit":
        raise InputError("tilt: expected a body under a torque along one of its principal axes, without wheel momentum along it")
    if Fate(int(fate(scene, state).labels)) not in STEADY:
        raise InputError("tilt: the motion is not bounded as it is: ask time_to of it")
    if angle is None and not (case is not None and any(t.stuck and t.misalignment for t in case.thrusters)):
        angle = DEGREE
    if angle is not None and not 0 < angle < math.pi / 2:
        raise InputError(f"tilt: expected an angle between 0 and a quarter turn (pi/2 rad), got {angle!r} rad")
    question, stated = (ask, True) if ask is not None else _question(scene, state, rate, case)
    limit = asked(scene, **question)
    cone = cone_of(scene, case, angle)
    least = limit.least_rate()
    exactly = time_to(scene, state, **question, exact=exact, work=WORK)
    not_before = stays_below(scene, state, least, *cone.reach())
    azimuths, times, followed = _search(scene, state, limit, cone, not_before)
    found: dict[str, Any] = {"low": None, "high": None, "level": "run", "azimuth": None, "torque": None}
    if np.isfinite(times).any():
        azimuth = float(azimuths[np.argmin(times)])
        torque = cone.at(azimuth)
        # by runs: the validated steps of a proof take a machine ten seconds to compile, which nobody who asks for the first time awaits
        first = time_to(tilted(scene, torque), state, **question, exact=exact, work=0)
        found = {"low": float(first.low), "high": float(first.high) if first.high == first.high else float(times.min()), "level": str(first.level),
                 "azimuth": azimuth, "torque": tuple(torque.tolist())}
    return Tilt(cone.angle, cone.words, least, stated, not_before, **found, followed=followed, azimuths=azimuths, times=times,
                untilted=(float(exactly.low), float(exactly.high)) if exactly.high < math.inf else None)


def _question(scene: AnyScene, state: Any, rate: Any, case: Any) -> Any:
    """(the limit as `time_to` takes it, whether it is stated)."""
    if rate is not None:
        return {"rate": rate}, True
    if case is not None and case.limits is not None:
        if case.limits.rate is not None:
            return {"rate": case.limits.rate}, True
        return {"component": case.limits.components(case.frame)}, True
    largest = np.abs(extremes(scene, state)).max(axis=-1)
    return {"rate": TWICE * float(np.linalg.norm(largest))}, False


def _search(scene: Scene, state: Any, limit: Limit, cone: Cone, not_before: float) -> Any:
    """Look for crossings round the cone, then more closely about the azimuth with the shortest time; at one azimuth alone where a run falls
    short of the time before which there is none.

    Return the azimuths, the times, and how long the shortest run without a crossing went on.
    """
    azimuths = [2 * math.pi * n / AZIMUTHS for n in range(AZIMUTHS)]
    times, followed = [], math.inf
    for azimuth in azimuths:
        t, until = _time(scene, state, limit, cone, azimuth)
        times.append(t)
        followed = min(followed, until)
        if until < not_before:  # so do runs of as many steps at the other azimuths, or nearly
            azimuths = azimuths[:len(times)]
            break
    step = math.pi / AZIMUTHS
    for _ in range(REFINED if np.isfinite(times).any() else 0):
        best = azimuths[int(np.argmin(times))]
        for azimuth in (best - step, best + step):
            azimuths.append(azimuth % (2 * math.pi))
            times.append(_time(scene, state, limit, cone, azimuth)[0])
        step /= 2
    order = np.argsort(azimuths)
    return np.array(azimuths)[order], np.array(times)[order], followed


def _time(scene: Scene, state: Any, limit: Limit, cone: Cone, azimuth: float) -> Any:
    found, unit = run_once(tilted(scene, cone.at(azimuth)), state, limit, math.inf, STEPS)
    return (math.inf, found.until / unit) if found.t is None else (found.t / unit, math.inf)
