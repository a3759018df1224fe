"""The limit that pictures are drawn to where a case states none: twice the largest rate.

Of a bounded motion whose extremes are known twice the largest rate that it reaches, as a tilt of its torque
takes it, so that the motion itself stays below; of any other twice the rate at its start. It is a scale, no
answer: pictures call it assumed, and no headline has it."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from ..errors import StabilabError
from ..orbit.result import Fate, Motion
from ..physics.scene import AnyScene
from .units import SHORT, Units

TWICE = 2.0  # as of a tilt
LARGEST, AT_START, OWN = "the largest rate", "the rate at the start", "the rate that the torque gives"
SLOW = 0.01  # of the rate that a torque gives in its own time: a start no faster is one at rest


@dataclass(frozen=True)
class Assumed:
    """rate: of |omega|, in the scene's variables; time: when it is reached, None where it is not, or not
    known to be; basis: of which rate it is twice, in words."""

    rate: float
    time: float | None = None
    basis: str = field(default="", compare=False)

    def words(self, units: Units) -> str:
        """A row of a table."""
        when = "" if self.time is None else f", reached after {units.time(self.time, SHORT)} (by a run)"
        return f"none in the file; pictures assume {units.rate(self.rate, SHORT)}, twice {self.basis}{when}"


def assumed(case: Any, scene: AnyScene, state: Sequence[float] | None, motion: Motion | None,
            time_to: Callable[[float, float | None], Any] | None = None,
            until: float | None = None) -> Assumed | None:
    """The limit assumed of a motion; None where the case states one, and where nothing turns. time_to: gives
    the time to a rate by a run that ends at a time, or where its work is done (None); without it no time is
    known. until: where the run of a motion ends that is not known to spin up; None: it is not followed."""
    if state is None or case is not None and case.limits is not None:
        return None
    largest, basis = _largest(scene, state, motion)
    rate = TWICE * largest
    if not (rate > 0 and math.isfinite(rate)):
        return None
    alone = Assumed(rate, basis=basis)
    if time_to is None or motion is None or basis == LARGEST:
        return alone
    last = None if motion.fate is Fate.SPIN_UP else until
    if motion.fate is not Fate.SPIN_UP and not (last and last > 0):
        return alone
    try:
        found = time_to(rate, last)
    except StabilabError:
        return alone
    reached = float(found.high)
    return Assumed(rate, reached if math.isfinite(reached) and reached > 0 else None, basis)


def _largest(scene: AnyScene, state: Sequence[float], motion: Motion | None) -> tuple[float, str]:
    """The rate that is doubled, and its words."""
    if motion is not None and motion.fate is Fate.BOUNDED and motion.for_all_time and motion.extremes:
        sizes = [max(map(abs, pair)) for pair in motion.extremes if None not in pair]
        if len(sizes) == 3 and all(map(math.isfinite, sizes)):
            return math.hypot(*sizes), LARGEST
    start = math.hypot(*map(float, state[:3]))
    return (own, OWN) if start < SLOW * (own := _own_rate(scene)) else (start, AT_START)


def _own_rate(scene: AnyScene) -> float:
    """The rate that a torque gives a body in the time in which it turns it; 0 without a torque."""
    if scene.variables == "scaled":
        return math.sqrt(math.hypot(*(float(v) for v in scene.exact_mu)))
    if not scene.plain:
        return 0.0
    torque = math.hypot(*(float(v) for v in scene.vector("constant_torque")))
    return math.sqrt(torque / (sum(map(float, scene.body.inertia)) / 3))
