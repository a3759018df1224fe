"""What each thruster does when it sticks, and which wheel momentum or other thrusters help: alone or in
pairs, fired together with the stuck ones, they keep the motion bounded, or delay its limit.

What leaves less torque need not come to the limit later: what is left may lie nearer to an axis about which
the body spins up. So times are compared with the time without help, and what brings the limit sooner is said
not to help. A thruster that fires for a share of the time is taken as its mean torque: that is right where
its pulses are short beside the motion.
"""
from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, TypeAlias, TypeGuard

import numpy as np

from ...case.given import Amount, Given, Span, Start, as_case
from ...case.limit_options import angle_of
from ...case.read import Case
from ...case.uncertain import Uncertain
from ...errors import Caveat, InputError, Kind, without
from ...numbers.exact import floats
from ...numbers.principal import NOTHING, without_trace
from ...numbers.vectors import CYCLE, Exact3, Number, dot
from ...orbit.result import Fate
from ...physics.scene import Scene, torque_axis
from ...reasons import Sentence, as_reason
from ...tasks import Task, done
from ..at_equilibrium import of_gyrostat
from ..caveats import STEADY, caveats_of
from ..tilt import Spread, Tilt
from ..uncertain.fate import Uncertainty, uncertain
from ..when import limit_of, of_tilt
from .fate import (
    NEVER_AFTER,
    Outcome,
    Scenario,
    delayed,
    fate_under,
    first_time,
    in_steps,
    intervals,
    outcome_of,
    scenario_of,
    time_under,
)
from .line import Family
from .margins import Helper, Principal, Row, Stuck, WheelAnswer, margins

NOT_SEEN = Sentence("tolerance-not-looked-at-here",
                    "the tolerance of the force of {thrusters} is not looked at here")
NO_TORQUE = Fraction(1, 10**9)  # of the torque: what is left of it counts as none
NO_TORQUE_SQUARED = NO_TORQUE**2
WORTH = Fraction(999, 1000)  # of the torque: a helper that leaves more is none
Duty: TypeAlias = tuple[Number, ...]  # the share of the time that each fires
Chosen: TypeAlias = tuple[tuple[str, Exact3], ...]  # thrusters by name, and the torque of each
MAX_HELPERS = 12  # helpers that are listed
MANY_ROWS = 10  # so many repay the start of another process
ROUGH = 1e-6  # of the arms, and of shares: far more than what rounding does to a pair in doubles
TRIED = 6  # thrusters, and pairs, whose times are compared: those that leave the least torque
SHARES = (Fraction(1), Fraction(3, 4), Fraction(1, 2), Fraction(1, 4))  # of the duty that leaves the least


def helpers(scenario: Scenario, torque: Exact3, others: Sequence[Any],
            visited: Outcome) -> tuple[Helper, ...]:
    """The helpers among `others` (thrusters that do not fire) against a torque (exact, scene's axes), the
    best first.

    visited: what becomes of the motion without them.
    """
    if not any(torque):
        return ()
    alone = [(t.name, arm) for t, arm in ((t, scenario.arm(t)) for t in others) if any(arm)]
    printed = _stopping(scenario, torque, Sets(alone, 1))
    done = {name for helper, _ in printed for name in helper.thrusters}
    printed += _best_pairs(scenario, torque, Sets([item for item in alone if item[0] not in done], 2))
    printed.sort(key=lambda entry: (entry[0].effect != "zero", len(entry[0].thrusters), entry[0].torque_left))
    tried = [_timed(scenario, helper, left, visited) for helper, left in printed[:MAX_HELPERS]]
    if all(helper.effect == "none" for helper in tried):
        tried += _slowest(scenario, torque, (Sets(alone, 1), Sets(alone, 2)), visited)
    tried.sort(key=_rank)
    return tuple([helper for helper in tried if helper.effect != "none"] or tried[:1])


def _rank(helper: Helper) -> tuple[bool, bool, float]:
    """In front: what helps, what never comes to the limit as far as is known, then what comes to it late."""
    time = helper.time_to_limit
    return helper.effect == "none", time is not None, 0.0 if time is None else -time[0]


def _later(time: tuple[float, float] | None, visited: Outcome) -> bool:
    """Whether a limit that is reached at `time`, if at all, is reached later than without help."""
    return time is None or (visited.when.time is not None and time[0] > visited.when.time[1])


def _timed(scenario: Scenario, helper: Helper, left: Exact3, noted: Outcome,
           run: tuple[float, float] | None = None) -> Helper:
    """With the time of its limit: a bounded motion may come to it all the same. run: bracket by a plain run,
    which counts where none is enclosed."""
    if scenario.limit is None:
        return helper
    time = time_under(scenario, left, scenario.wheel)
    return replace(helper, time_to_limit=time, effect=helper.effect if _later(time or run, noted) else "none")


def _stops(scenario: Scenario, torque: Exact3, chosen: Chosen) -> tuple[Helper, Exact3] | None:
    """The helper that these make, and the torque, where they leave none or a bounded motion."""
    names, arms = zip(*chosen)
    duty = _least_squares(torque, arms)
    if _possible(duty):
        left = _left(torque, arms, duty)
        if dot(left, left) <= NO_TORQUE_SQUARED * dot(torque, torque):
            helper = Helper(names, tuple(map(float, duty)), "zero", math.sqrt(float(dot(left, left))),
                            "bounded", None)
            return helper, (Fraction(0),) * 3
    onto = [(i, duty) for i in scenario.held if _possible(duty := _onto_axis(torque, arms, i))]
    for size, i, duty in sorted(((_left(torque, arms, duty)[i], i, duty) for i, duty in onto),
                                key=lambda item: abs(item[0])):
        fate = Family(scenario.body, i, size, scenario.wheel, scenario.state).fate() if size else None
        if fate in STEADY:
            helper = Helper(names, tuple(map(float, duty)), "bounded", abs(float(size)), fate.word, None)
            return helper, tuple(size * (n == i) for n in range(3))
    return None


class Sets:
    """Every thruster, or every pair, of those that may help: their names and torques. indices: (n, size) into
    `alone`; arms: (n, size, 3) torques in doubles."""

    def __init__(self, alone: Sequence[tuple[str, Exact3]], size: int) -> None:
        self.alone = alone
        self.indices = (np.arange(len(alone))[:, None] if size == 1
                        else np.stack(np.triu_indices(len(alone), 1), axis=1))
        self.arms = np.array([floats(arm) for _, arm in alone]).reshape(-1, 3)[self.indices]

    def chosen(self, number: int) -> Chosen:
        """One of them."""
        return tuple(self.alone[i] for i in self.indices[number].tolist())


def _stopping(scenario: Scenario, torque: Exact3, sets: Sets) -> list[tuple[Helper, Exact3]]:
    """`_stops` of each thruster, of those whose torque lies, in doubles, along what is left, or along it
    across an axis that is held."""
    arms, full = sets.arms[:, 0], np.array(floats(torque))
    across = np.abs(np.cross(arms, full))
    size = np.linalg.norm(arms, axis=1)
    room = ROUGH * (size + math.hypot(*full))
    along = np.linalg.norm(across, axis=1) <= room * size
    for i in scenario.held:
        along |= across[:, i] <= room * np.abs(arms[:, CYCLE[i]]).max(axis=1)
    return [item for number in np.flatnonzero(along).tolist()
            if (item := _stops(scenario, torque, sets.chosen(number)))]


def _best_pairs(scenario: Scenario, torque: Exact3, sets: Sets) -> list[tuple[Helper, Exact3]]:
    """As many helpers as are listed, of the pairs that leave the least torque: `_stops` of each."""
    out: list[tuple[Helper, Exact3]] = []
    for bound, chosen in _by_doubles(torque, sets, partial(_left_by_pairs, scenario.held)):
        if sum(item.effect == "zero" or item.torque_left < bound for item, _ in out) >= MAX_HELPERS:
            break
        if item := _stops(scenario, torque, chosen):
            out.append(item)
    return out


def _left_by_pairs(held: Sequence[int], torque: Any, arms: np.ndarray) -> np.ndarray:
    """(n,) the least torque that pairs leave by the shares of `_stops`, in doubles; infinite where rounding
    cannot make shares of the time of them. torque: (3,); arms: (n, 2, 3)."""
    a, b = np.moveaxis(arms, (1, 2), (0, 1))
    room = ROUGH * np.linalg.norm(arms, axis=-1).sum(axis=-1)

    def left(*system: np.ndarray) -> np.ndarray:
        p, q, r, s, x, y = system
        det = p * s - q * r
        alike = det * det <= float(NO_TORQUE_SQUARED) * (p * p + q * q) * (r * r + s * s)
        u, v = (x * s - q * y) / det, (p * y - r * x) / det
        shares = ~alike & (-ROUGH < u) & (u < 1 + ROUGH) & (-ROUGH < v) & (v < 1 + ROUGH)
        return np.where(shares, torque[:, None] + (u * a + v * b), math.inf)

    with np.errstate(all="ignore"):
        none = left(dot(a, a), dot(a, b), dot(a, b), dot(b, b), -dot(a, torque), -dot(b, torque))
        onto = [np.abs(left(a[j], b[j], a[k], b[k], *np.broadcast_arrays(-torque[j], -torque[k]))[i])
                for i in held for j, k in [CYCLE[i]]]
        return np.where(np.linalg.norm(none, axis=0) < room, 0.0,
                        np.min(onto, axis=0, initial=math.inf) if onto else math.inf)


def _by_doubles(torque: Exact3, sets: Sets, least: Callable[[np.ndarray, np.ndarray], np.ndarray]
                ) -> Iterator[tuple[float, Chosen]]:
    """(a bound that the torque left by a set does not fall below, the set), rising; without those that leave
    an infinite one. least(torque (3,), arms (n, size, 3)): (n,) the least torque left, in doubles."""
    if not len(sets.arms):
        return
    bounds = (least(np.array(torque, float), sets.arms)
              - ROUGH * np.linalg.norm(sets.arms, axis=-1).sum(axis=-1))
    for number in np.argsort(bounds, kind="stable").tolist():
        if bounds[number] == math.inf:
            return
        yield float(bounds[number]), sets.chosen(number)


def _left_in_the_box(torque: np.ndarray, arms: np.ndarray) -> np.ndarray:
    """(n,) the least torque that one or two thrusters leave by shares in 0 to 1, in doubles, where
    `_in_the_box` has the shares. torque: (3,); arms: (n, 1 or 2, 3)."""
    def on_an_edge(rest: np.ndarray, arm: np.ndarray) -> np.ndarray:
        share = np.clip(-(rest * arm).sum(axis=-1) / (arm * arm).sum(axis=-1), 0, 1)
        return np.linalg.norm(rest + share[:, None] * arm, axis=-1)

    if arms.shape[1] == 1:
        return on_an_edge(torque, arms[:, 0])
    a, b = arms[:, 0], arms[:, 1]
    edges = [on_an_edge(torque + full * arms[:, n], arms[:, 1 - n]) for n in (0, 1) for full in (0, 1)]
    p, q, r, x, y = ((v * w).sum(axis=-1) for v, w in ((a, a), (a, b), (b, b), (a, -torque), (b, -torque)))
    with np.errstate(all="ignore"):  # of parallel arms an edge is no worse
        u, v = (x * r - q * y) / (p * r - q * q), (p * y - q * x) / (p * r - q * q)
    inside = (u >= 0) & (u <= 1) & (v >= 0) & (v <= 1)
    left = np.linalg.norm(torque + np.where(inside, u, 0)[:, None] * a + np.where(inside, v, 0)[:, None] * b,
                          axis=-1)
    return np.min([left, *edges], axis=0)


def _possible(duty: Duty | None) -> TypeGuard[Duty]:
    return duty is not None and all(0 < u <= 1 for u in duty)


def _left(torque: Sequence[Number], arms: Sequence[Sequence[Number]], duty: Sequence[Number]) -> Exact3:
    return tuple(m + sum(u * arm[n] for u, arm in zip(duty, arms)) for n, m in enumerate(torque))


def _least_squares(torque: Sequence[Number], arms: Sequence[Sequence[Number]]) -> Duty | None:
    """The shares, of any sign and size, that leave the least torque; None where two arms are parallel."""
    if len(arms) == 1:
        return (-dot(arms[0], torque) / dot(arms[0], arms[0]),)
    a, b = arms
    return _solved(dot(a, a), dot(a, b), dot(a, b), dot(b, b), -dot(a, torque), -dot(b, torque))


def _onto_axis(torque: Sequence[Number], arms: Sequence[Sequence[Number]], i: int) -> Duty | None:
    """The shares that leave no torque across axis i; None where there are none."""
    j, k = CYCLE[i]
    if len(arms) == 2:
        a, b = arms
        return _solved(a[j], b[j], a[k], b[k], -torque[j], -torque[k])
    (a,), size = arms, dot(torque, torque)
    n, other = (j, k) if abs(a[j]) >= abs(a[k]) else (k, j)
    if not a[n]:
        return None
    fraction = -torque[n] / a[n]
    return (fraction,) if (torque[other] + fraction * a[other]) ** 2 <= NO_TORQUE_SQUARED * size else None


def _solved(p: Number, q: Number, r: Number, s: Number, x: Number, y: Number) -> Duty | None:
    """(u, v) with p u + q v = x and r u + s v = y; None where the rows are alike."""
    det = p * s - q * r
    return (None if det * det <= NO_TORQUE_SQUARED * (p * p + q * q) * (r * r + s * s)
            else ((x * s - q * y) / det, (p * y - r * x) / det))


def _slowest(scenario: Scenario, torque: Exact3, sets: Sequence[Sets],
             visited: Outcome) -> list[Helper]:
    """The thruster and the pair with the latest limit; without a limit those that leave the least torque."""
    out: list[tuple[float, Helper]] = []
    for many in sets:
        tried = _least_left(torque, many)
        if not tried:
            continue
        if scenario.limit is None:
            square, chosen, duty = tried[0]
            best = math.sqrt(float(square)), chosen, duty
            better = not out or best[0] < WORTH * out[0][0]
        else:
            best = max(((_run(scenario, torque, chosen, scaled, visited), chosen, scaled)
                        for _, chosen, duty in tried
                        for fraction in SHARES for scaled in [tuple(fraction * u for u in duty)]),
                       key=lambda item: item[0])
            better = not out or out[0][0] < WORTH * best[0]
        if better:
            out.append((best[0], _slower(scenario, torque, visited, *best)))
    return [helper for _, helper in out]


def _least_left(torque: Exact3, sets: Sets) -> list[tuple[Fraction, Chosen, Duty]]:
    """(square of the torque that is left, thrusters, shares of time), the `TRIED` that leave the least."""
    out: list[tuple[Fraction, Chosen, Duty]] = []
    size = dot(torque, torque)
    for bound, chosen in _by_doubles(torque, sets, _left_in_the_box):
        if bound > 0 and sum(square < bound * bound for square, *_ in out) >= TRIED:
            break
        arms = [arm for _, arm in chosen]
        out += [(square, chosen, duty) for duty in _in_the_box(torque, arms) if all(duty)
                for left in [_left(torque, arms, duty)] if (square := dot(left, left)) < WORTH**2 * size]
    return sorted(out, key=lambda item: item[0])[:TRIED]


def _run(scenario: Scenario, torque: Sequence[Fraction], chosen: Any, duty: Duty, visited: Outcome) -> float:
    """The time of the limit by a plain run, inf where it is not reached for long."""
    left, alone = _left(torque, [arm for _, arm in chosen], duty), visited.when.time
    return first_time(scenario, left, None, NEVER_AFTER * (alone[0] if alone else visited.followed))


def _in_the_box(torque: Sequence[Number], arms: Sequence[Sequence[Number]]) -> list[Duty]:
    """The shares in 0 to 1 among which the one is that leaves the least torque: inside, or on the border."""
    duty = _least_squares(torque, arms)
    if duty is not None and all(0 <= u <= 1 for u in duty):
        return [duty]
    if duty is not None and len(arms) == 1:
        return [(min(max(duty[0], Fraction(0)), Fraction(1)),)]
    out: list[Duty] = []
    for fixed in (0, 1):
        for full in (Fraction(0), Fraction(1)):
            rest = _left(torque, [arms[fixed]], (full,))
            (fraction,) = _in_the_box(rest, [arms[1 - fixed]])[0]
            out.append((full, fraction) if fixed == 0 else (fraction, full))
    return out


def _slower(scenario: Scenario, torque: Sequence[Fraction], visited: Outcome, run: float, chosen: Any,
            duty: Duty) -> Helper:
    """run: the time of the limit by a plain run."""
    left = _left(torque, [arm for _, arm in chosen], duty)
    helper = Helper(tuple(name for name, _ in chosen), tuple(map(float, duty)), "slower",
                    math.sqrt(float(dot(left, left))), fate_under(scenario, left).word, None)
    return _timed(scenario, helper, left, visited, (run, run))


# --- The question: a thruster is stuck open, what becomes of the spacecraft, how soon, and what helps?
def stuck(case: Given, all_thrusters: bool = False, progress: Callable[[str], Any] | None = None, *,
          state: Start | None = None, span: Span | None = None, tilt: Amount | None = None,
          frame: str = "principal", workers: int | None = None) -> Stuck:
    """What the stuck thrusters of a case do: fate, axis, time to the limit, margins, wheels and thrusters
    that help.

    case: in any form, with a motion, or a scene with `state`; state, span, frame: in place of the case's own,
    as of `fate`. The first row has all thrusters that the case marks as stuck firing together, with what else
    turns the body; where they are several, a row for each alone follows. all_thrusters: a row for each
    thruster alone instead, stuck or not, the one that reaches the limit first in front. progress: called with
    words before every row. tilt: half-angle of the cone of torques, rad or text with a unit; without it what
    the thrusters state. workers: processes that share the rows, None for one a core where they are many;
    the answer is the same. Raises InputError for a case without a motion or without a thruster that could be
    stuck, and for other effects than wheel and torque.
    """
    case = as_case(case, state, span, frame)
    if all_thrusters:
        case = each_firing(case)
    scenario, angle = scenario_of(case), None if tilt is None else angle_of(tilt)
    tasks = [Task(f"{case.name}: {' and '.join(t.name for t in chosen) or 'the torque of the case'}",
                  "answers.stuck.ask:row_of", (scenario, tuple(map(case.thrusters.index, chosen)), angle))
             for chosen in _chosen(case, scenario, all_thrusters)]
    if workers is None and len(tasks) < MANY_ROWS:
        workers = 1
    with TemporaryDirectory() as folder:
        rows = done(tasks, Path(folder), progress or (lambda label: None), workers)
    if all_thrusters:  # the limit is reached soon; what spins up later, or is not known; never
        rows.sort(key=lambda row: (row.time_to_limit[0] if row.time_to_limit else math.inf,
                                   {"spin-up": 0, "undecided": 1}.get(row.fate, 2)))
    principal = Principal(floats(scenario.axes.moments),
                          tuple(tuple(float(v) + 0.0 for v in axis) for axis in scenario.axes.axes))
    return Stuck(case.name, tuple(rows), principal, all_thrusters)


def row_of(scenario: Scenario, firing: Sequence[int], angle: float | None) -> Row:
    """The row of the thrusters of a case with these numbers; angle: as of `stuck`, rad."""
    return _row(scenario, tuple(scenario.case.thrusters[n] for n in firing), angle)


def each_firing(case: Case) -> Case:
    """The case as one whose thrusters fire, one at a time: without the caveat that none does."""
    return replace(case, caveats=without(case.caveats, Kind.THRUSTERS))


def _chosen(case: Case, scenario: Scenario, all_thrusters: bool) -> list[tuple[Any, ...]]:
    """The combinations of thrusters that are asked about, a tuple each."""
    if all_thrusters:
        if not case.thrusters:
            raise InputError("the case has no thruster: describe each in a table [[thrusters]]")
        return [(t,) for t in case.thrusters]
    marked = tuple(t for t in case.thrusters if t.stuck)
    if not marked and not any(scenario.base):
        if names := ", ".join(t.name for t in case.thrusters):
            raise InputError(f"no thruster is stuck and no torque acts: mark one of {names} with stuck = "
                             "true, or ask with --all-thrusters")
        raise InputError("no thruster is stuck and no torque acts: describe one in a table [[thrusters]] "
                         "with stuck = true, or give a torque")
    return [marked] + ([(t,) for t in marked] if len(marked) > 1 else [])


def _row(scenario: Scenario, thrusters: Sequence[Any], tilt: float | None = None) -> Row:
    torque = scenario.torque(thrusters)
    noted = outcome_of(scenario, torque)
    others = [t for t in scenario.case.thrusters if t not in thrusters]
    scene = scenario.scene(torque)
    off = _tilted(scenario, thrusters, scene, noted, tilt)
    stability = (of_gyrostat(scene, scenario.state) if noted.fate == Fate.EQUILIBRIUM and scene.plain
                 else None)
    box = _over_box(scenario, thrusters, scene)
    own = [*without(scenario.case.caveats, Kind.TOLERANCE, Kind.MISALIGNMENT)]
    if (loose := [t.name for t in thrusters if t.force_tolerance]) and not (off and off.within):
        own.append(Caveat(Kind.TOLERANCE, NOT_SEEN(thrusters=tuple(loose))))
    caveats = caveats_of(scene, noted.fate in STEADY or noted.when.never, off, file=own, stability=stability)
    return Row(
        tuple(t.name for t in thrusters), torque=scenario.torque_in_file(thrusters),
        torque_principal=tuple(float(v) + 0.0 for v in torque),
        fate=noted.fate.word, level=noted.level, axis=noted.axis or None, sense=noted.sense or None,
        direction=noted.direction and scenario.in_file(noted.direction), limit=scenario.limit,
        time_to_limit=noted.when.time, time_level=noted.when.level, never=noted.when.never,
        largest_rate=noted.largest, followed=noted.followed, reason=noted.reason,
        margins=margins(scenario, scene, noted),
        wheels=tuple(_wheel(scenario, torque, noted, wheel) for wheel in scenario.case.wheels),
        helpers=helpers(scenario, torque, others, noted) if noted.fate not in STEADY else (),
        tilt=off, caveats=(*caveats, *(box.caveats if box else ())), box=box)


def _over_box(scenario: Scenario, thrusters: Sequence[Any], scene: Scene) -> Uncertainty | None:
    """What the uncertain numbers of the case, and the forces of the thrusters that fire, do to the fate under
    a torque along an axis, where a proof is to be had."""
    case = scenario.case
    others = [item for item in case.uncertain if item.path[-1] != "force"]
    laws = {item.path: item for item in case.uncertain}
    forces = [laws.get((*t.path, "force")) or Uncertain((*t.path, "force"), t.force, t.force_tolerance,
                                                        f"thrusters.{t.name}.force")
              for t in thrusters if t.force_tolerance]
    if case.variables == "scaled" or not torque_axis(scene):
        return None
    firing = tuple(replace(t, stuck=t in thrusters) for t in case.thrusters)
    return uncertain(replace(case, thrusters=firing, scene=scene, physical=scene,
                             uncertain=(*others, *forces)), ("fate",))


def _tilted(scenario: Scenario, thrusters: Sequence[Any], scene: Scene,
            visited: Outcome, angle: float | None = None) -> Tilt | Spread | None:
    """What a tilt of the torque does, by an angle that is given; without one to a bounded motion under one on
    an axis by the misalignment of the thrusters that fire, else by one degree; else by that misalignment
    alone; and what their tolerances do."""
    loose = any(t.misalignment or t.force_tolerance for t in thrusters)
    firing = tuple(replace(t, stuck=t in thrusters) for t in scenario.case.thrusters)
    case = replace(scenario.case, thrusters=firing, scene=scene)
    return (of_tilt(case, angle, limit_of(case), visited.fate in STEADY, in_steps(scene))
            if loose or angle is not None or scenario.limit is not None else None)


def _wheel(scenario: Scenario, torque: Exact3, visited: Outcome, wheel: Any) -> WheelAnswer:
    """What one wheel of the case can do, the others left as they are."""
    axis = without_trace(scenario.axes.turned(wheel.axis), torque)
    smallest = NOTHING * max(map(abs, scenario.wheel))
    others = tuple(v if abs(v) > smallest else v * 0
                   for w, a in zip(scenario.wheel, axis) for v in [w - wheel.momentum * a])
    rest, reason = intervals(scenario.scene(torque, others), scenario.state, axis)
    later = (None if rest or visited.fate in STEADY
             else delayed(scenario, torque, axis, wheel.momentum, visited.when.time))
    return WheelAnswer(wheel.name, tuple(map(float, wheel.axis)), float(wheel.momentum), rest, *(later or ()),
                       reason=as_reason(reason))
