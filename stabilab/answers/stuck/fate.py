"""Fate of one motion under one torque, the time to its limit, and the largest rate before: whatever the torque's direction."""
from __future__ import annotations

import math
from dataclasses import dataclass

from ...orbit.result import Fate
from ...physics.quadratic import rests
from ...unreduced.spin_up.follow import spin_up
from ..kinds import kind_of, one
from .reach import Reached, reach

BUDGET = 300_000  # steps of a run to the limit
LONG = 1e5  # in natural units of time: how far a run goes that nothing else ends
TURN = 1.001  # of a period: a motion that repeats is followed for so long
EXACT = ("axis", "law")  # certificates of growth that are closed solutions


@dataclass(frozen=True)
class Found:
    """fate, level, axis (1, 2, 3 of the scene or 0), sense, direction (scene's axes) and because as in `SpinUp`.

    motion: of a scene with an orbit or a law, None elsewhere; kind: of the scene; time: (low, high) of the limit or None; never: the limit
    is known never to be reached; largest: |omega| up to then, rad/s, None where unbounded or unknown.
    """

    fate: Fate
    level: str
    axis: int
    sense: int
    direction: tuple | None
    because: str
    kind: str
    motion: object
    time: tuple[float, float] | None
    time_level: str
    never: bool
    largest: float | None
    followed: float


def found(scenario, torque, wheel=None) -> Found:
    """What becomes of the scenario's motion under a torque, with another wheel momentum where one is given."""
    scene = scenario.scene(torque, wheel)
    kind = kind_of(scene)
    if rests(scene.quadratic(), scenario.state):
        return _at_rest(scenario, kind)
    if kind == "off axis":
        return _off_axis(scenario, scene)
    return _by_law(scenario, scene, kind)


def _at_rest(scenario, kind):
    size = math.hypot(*scenario.start)
    return Found(Fate.EQUILIBRIUM, "exact", 0, 0, None, "every rate vanishes at the state, exactly", kind, None, None, "exact", True, size, math.inf)


def _off_axis(scenario, scene):
    state = scenario.start
    seen = spin_up(scene, state)
    trap, until = seen.trap, seen.t
    if seen.fate == Fate.SPIN_UP:
        until = _latest(scenario, trap) if trap else _long(scene)
    elif seen.fate == Fate.BOUNDED:
        until = _long(scene)
    run = _reach(scenario, scene, until)
    time, level, followed = run.time, "run", max(run.followed, seen.t)
    if time is None and seen.fate == Fate.SPIN_UP and trap and isinstance(scenario.limit, float):
        time, level = _by_trap(scenario.limit, trap), seen.level
    spins = seen.fate == Fate.SPIN_UP
    known = run.largest if run.time or not spins else None
    words = seen.cause + (f"; {run.unsure}" if run.unsure else "")
    about = (seen.axis, seen.sense, seen.direction) if spins else (0, 0, None)
    return Found(seen.fate, "run" if seen.level == "undecided" else seen.level, *about, words, "off axis", None, time, level, False, known, followed)


def _by_law(scenario, scene, kind):
    state = scenario.start
    motion = one(scene).motion(scene, state, None, scenario.state)
    spins = motion.fate == Fate.SPIN_UP
    repeats = not spins and motion.period is not None
    run = _reach(scenario, scene, TURN * motion.period if repeats else _long(scene))
    bound = _bound(motion)
    never = not spins and run.time is None and not run.unsure and (repeats or (isinstance(scenario.limit, float) and bound < scenario.limit))
    largest = run.largest if run.time or repeats else bound if math.isfinite(bound) else None
    if scenario.limit is None and spins:
        largest = None
    direction = _direction(scene, motion) if spins else None
    because = motion.because + (f"; {run.unsure}" if run.unsure else "")
    return Found(motion.fate, _level(kind, motion), motion.axis, motion.sense, direction, because, kind, motion, run.time, "run", never, largest,
                 math.inf if repeats else run.followed)


def _reach(scenario, scene, until) -> Reached:
    return reach(scene, scenario.start, scenario.limit, scenario.rows, until, BUDGET)


def _level(kind, motion) -> str:
    if kind != "growth" or motion.fate not in (Fate.SPIN_UP,):
        return "exact" if motion.fate != Fate.UNDECIDED else "run"
    certificate = motion.evidence.get("certificate")
    return "exact" if certificate in EXACT else "run" if certificate in ("evidence", "none") else "certified"


def _direction(scene, motion):
    """Along which the rate grows: an axis; or the torque, where it lies between two equal moments."""
    if motion.axis:
        return tuple(float(motion.sense * (n == motion.axis - 1)) for n in range(3))
    torque = scene.vector("constant_torque")
    if any(scene.vector("gyrostat")) and sum(a * b for a, b in zip(scene.vector("gyrostat"), torque)):
        return None
    size = math.hypot(*map(float, torque))
    return tuple(float(m) / size for m in torque)


def _bound(motion) -> float:
    """An upper bound of |omega| for ever, from those of its components."""
    if motion.extremes is None or motion.extremes_over != "all time":
        return math.inf
    return math.hypot(*(max(map(abs, pair)) for pair in motion.extremes))


def _long(scene) -> float:
    weight, torque = sum(scene.body.inertia) / 3, max(abs(float(m)) for m in scene.vector("constant_torque"))
    if not torque:
        wheel = max(abs(float(v)) for v in scene.vector("gyrostat"))
        return LONG if not wheel else LONG * weight / wheel
    return LONG * math.sqrt(weight / torque)


def _latest(scenario, trap) -> float:
    """A time by which a trapped motion has surely passed its limit."""
    limits = scenario.limit if isinstance(scenario.limit, tuple) else (scenario.limit,)
    if scenario.limit is None:
        return trap.t
    sides = [max(abs(v) for v in pair) for pair in trap.bounds()]
    across = math.hypot(*(v for v in sides if math.isfinite(v)))
    return 1.01 * trap.clock(2 * (max(limits) + across))[1]


def _by_trap(limit, trap) -> tuple[float, float] | None:
    """When |omega| reaches the limit, by the trap's clock: the other two rates are bounded for ever."""
    sides = [max(abs(v) for v in pair) for pair in trap.bounds()]
    across = math.hypot(*(v for v in sides if math.isfinite(v)))
    if sum(map(math.isinf, sides)) != 1 or not across < limit:
        return None
    low = trap.clock(math.sqrt(limit * limit - across * across))[0]
    return (low, trap.clock(limit)[1]) if low > trap.t else None
