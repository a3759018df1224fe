"""How the time to a limit, or the fate, varies over the torques that a misalignment allows: of motions that no torque on an axis keeps bounded."""
from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ...numbers.vectors import Exact3
from ...orbit.result import Fate
from ...physics.scene import Scene
from ..fate import fate
from ..time_to import time_to
from .cone import Cone, tilted
from .limit import asked
from .run import run_once

AZIMUTHS, REFINED = 12, 4  # looked at round the edge of the cone; halvings of the interval about the least and the greatest time
STEPS = 60_000  # of a run in one direction
WORK = 8_000_000  # multiplications for the proof of a time
VERBS = {Fate.BOUNDED: "stays bounded", Fate.SPIN_UP: "spins up", Fate.SEPARATRIX: "lies on a separatrix", Fate.EQUILIBRIUM: "stays at rest",
         Fate.UNDECIDED: "is undecided"}


@dataclass(frozen=True)
class Spread:
    """angle: half-angle of the cone, rad; of: what is tilted; directions: of the torque that were looked at, its own and those round the edge of the cone.
    limit: rad/s as of `Limit.least_rate`, None where no limit is asked: then fates says in how many directions the motion has which fate.
    earliest, latest: (low, high) of the least and the greatest time found, s, None where the limit was not reached in any direction, or not in all of
    them within `followed`, s; level: of both, as of `TimeTo`. because: why none was looked at."""

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
    because: str = ""

    @property
    def words(self) -> str:
        """What is found, in SI units."""
        if self.because:
            return f"a tilt of the torque is not looked at {self.because}"
        by, many = f"tilted by {self.angle:.6g} rad it", f"of {self.directions} directions of the torque"
        if self.limit is None:
            return f"{by} " + ", ".join(f"{word} in {count}" for word, count in self.fates) + f" {many}"
        reaches = f"reaches {self.limit:.6g} rad/s"
        if self.earliest is None:
            return f"{by} was not found to reach {self.limit:.6g} rad/s within {self.followed:.6g} s in any {many}"
        first = f"{by} {reaches} after {self.earliest[0]:.6g} s at the earliest"
        if self.latest is None:
            return f"{first} {many} ({self.level}), in some of them not within {self.followed:.6g} s"
        return f"{first} and after {self.latest[1]:.6g} s at the latest {many} ({self.level})"


def spread(scene: Scene, state: Any, cone: Cone, ask: dict[str, Any] | None, exact: Exact3 | None = None) -> Spread:
    """The range over the torque itself and those at the edge of its cone. ask: the limit, by its name as of `time_to`; None: the fates."""
    azimuths = [2 * math.pi * n / AZIMUTHS for n in range(AZIMUTHS)]
    torques = [cone.torque, *map(cone.at, azimuths)]
    if ask is None:
        found = Counter(VERBS[Fate(int(fate(tilted(scene, torque), state).labels))] for torque in torques)
        return Spread(cone.angle, cone.words, len(torques), fates=tuple(found.most_common()))
    limit = asked(scene, **ask)

    def time(torque: np.ndarray) -> tuple[float, float]:
        found, unit = run_once(tilted(scene, torque), state, limit, math.inf, STEPS)
        return (math.inf, found.until / unit) if found.t is None else (found.t / unit, math.inf)
    times, ends = map(list, zip(*map(time, torques)))
    most = []
    for sign in (1, -1) if np.isfinite(times).any() else ():
        at, best = _closest(lambda azimuth, sign=sign: sign * time(cone.at(azimuth))[0], azimuths, [sign * t for t in times[1:]])
        most.append(cone.torque if sign * times[0] <= best else cone.at(at))
    if not most:
        return Spread(cone.angle, cone.words, len(torques), limit.least_rate(), followed=min(ends))
    exactly = [time_to(tilted(scene, torque), state, **ask, exact=exact, work=WORK) for torque in most]
    (first, last), all_of_them = [(float(one.low), float(one.high)) for one in exactly], bool(np.isfinite(times).all())
    levels = {str(one.level) for one in exactly[:1 + all_of_them]}
    return Spread(cone.angle, cone.words, len(torques) + 4 * REFINED, limit.least_rate(), first, last if all_of_them and math.isfinite(last[1]) else None,
                  levels.pop() if len(levels) == 1 else "run", min(ends))


def _closest(value: Any, azimuths: list[float], values: list[float]) -> tuple[float, float]:
    """(azimuth, value) of the least of a function whose values at these azimuths are given, looked for more closely about the best of them."""
    best, step = min(zip(values, azimuths)), math.pi / AZIMUTHS
    for _ in range(REFINED):
        best = min(best, *((value(azimuth), azimuth) for azimuth in (best[1] - step, best[1] + step)))
        step /= 2
    return best[1], best[0]
