"""The chain of motions of a burn, and when it first reaches a limit.

While thrusters fire their torque is constant in the body, and each motion starts where the one before
ended, at switching times that are exact. The first crossing of a limit is proved where the motion can be
enclosed; else it comes from roots along runs, one motion after another."""
from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from os import PathLike
from typing import Any, NamedTuple

import numpy as np

from ...case.read import Case, load_burning
from ...errors import InputError
from ...integrate.crossing import Crossing
from ...numbers.vectors import CYCLE, Exact3, Float3
from ...physics.effects import effect_class
from ...physics.scene import Scene
from ...physics.states import checked_times, moved_row
from ...reasons import Rate, Sentence
from ...validation import came
from ..limit import AXES, Limit, enclosed
from ..passage import MOVED, ROUNDING, Found, by_run
from ..simulate import Simulation, in_matrices, quaternion_blocks, simulated, trajectory
from ..time_to import down, of_one, up

CLOSING_LIMIT = Sentence("limit-after-closing", "largest |ω| after closing = {rate}")
SWITCHES = Sentence("switches-at-exact-times", "thrusters switch at exact times")()


# --- The chain of motions
class Piece(NamedTuple):
    """begin, length: s, exact; firing: names of the thrusters that fire; scene: with their torque; levels:
    shares of their forces."""

    begin: Fraction
    length: Fraction
    firing: tuple[str, ...]
    scene: Scene
    levels: tuple[Fraction, ...] = ()


class Chain:
    """The scenes of a burn, one after the other, up to its last closing, at `stop` (s) at the latest. base:
    the scene without the thrusters, which holds from then on; burning: what it was made of; closed: s, the
    last closing; quiet: whether no torque acts from then on; free: whether moreover the largest |omega| has a
    closed form (`burn`): without wheels, or with these along the axis of a body whose other two moments are
    equal."""

    def __init__(self, burning: Any, stop: Fraction | None = None) -> None:
        if isinstance(burning, (str, PathLike, Mapping, Case)):
            burning = load_burning(burning)
        if not hasattr(burning, "segments"):
            raise InputError("burn: expected a case whose thrusters fire on a schedule or are stuck, its "
                             f"path, its text, a dict, or what stabilab.load_burning gives; got "
                             f"{came(burning)}")
        self.burning, case = burning, burning.craft
        if case.physical is None or case.state is None or case.variables != "physical":
            raise InputError("a burn is followed from a start in rad/s: give [motion] angular_velocity")
        if not case.physical.plain:
            raise InputError("a burn is known of a body with wheels and torques constant in the body; this "
                             "scene has other effects")
        self.case, self.base = case, case.physical
        self.until = stop if stop is not None else self._end(case)
        self.segments = burning.segments(self.until)
        self.closed = self.segments[-1][1] if self.segments else Fraction(0)
        self.torques = [case.frame.turned(t.torque) for t in case.thrusters]
        self.quiet = not any(self.base.vector("constant_torque"))
        D, wheel = self.base.body.exact, self.base.vector("gyrostat")
        self.free = self.quiet and (not any(wheel) or any(D[j] == D[k] and not (wheel[j] or wheel[k])
                                                          for j, k in CYCLE))

    @staticmethod
    def _end(case: Case) -> Fraction | None:
        """Where burns without an end are closed: at the end of the motion's span."""
        if not any(t.burn is not None and t.burn.endless for t in case.thrusters):
            return None
        if case.span is None:
            raise InputError('a thruster has neither stop nor propellant: give one, or --stop "12 s", or a '
                             'span in [motion], such as span = [0, "10 min"]')
        return Fraction(case.span[1])

    def pieces(self) -> Iterator[Piece]:
        """In order of time; none where nothing ever fires."""
        for begin, end, firing, levels in self.segments:
            names = tuple(self.case.thrusters[n].name for n in firing)
            yield Piece(begin, end - begin, names, self._scene(firing, levels), levels)

    def enclosed(self, limit: Limit, end: Fraction | None = None) -> Crossing:
        """The first crossing of a limit by `end` (s; None: by the last closing), proved over all switches, or
        until when there is none."""
        scenes = [*((piece.begin, piece.scene) for piece in self.pieces()), (self.closed, self.base)]
        start = self.case.exact_state or tuple(map(Fraction, self.case.state))
        return enclosed(scenes[0][1], start, limit, self.closed if end is None else end, later=scenes[1:])

    def _scene(self, firing: Sequence[int], levels: Sequence[Fraction]) -> Scene:
        """With these shares of the torques of these thrusters added to what acts anyway."""
        own = [tuple(level * m for m in self.torques[n]) for n, level in zip(firing, levels)]
        torque = [sum(parts, Fraction(0)) for parts in zip(self.base.vector("constant_torque"), *own)]
        effects = [effect for effect in self.base.effects if effect.name != "constant_torque"]
        effects += [effect_class("constant_torque")(tuple(torque))] if any(torque) else []
        return Scene(self.base.body, *effects)


def weights_of_largest(scene: Scene) -> Exact3:
    """Of the squares of the rates in g^2, that of the largest |omega| of a free motion: see `burn`."""
    D = scene.body.exact
    smallest, middle, greatest = sorted(range(3), key=lambda i: D[i])
    result = [Fraction(1)] * 3
    result[middle] = D[middle] * (D[smallest] + D[greatest] - D[middle]) / (D[smallest] * D[greatest])
    return tuple(result)


def limit_after(scene: Scene, below: Fraction) -> Limit:
    """g = below, rad/s: closed then, |omega| reaches this limit in the free motion that follows."""
    return Limit("rate", ((tuple(zip(weights_of_largest(scene), AXES)), below**2),),
                 CLOSING_LIMIT(rate=Rate(float(below), digits=10)).text())


def simulate_burn(burning: Any, times: Any = None, attitude: str | None = None) -> Simulation:
    """The motion at the given times, from 0 on, while thrusters fire on their schedule and after it.

    burning: as of `burn`; times: (n,), increasing, s; None: the two ends of the span of the case; attitude:
    as of `simulate`. Each piece between two switches is followed from where the one before ended. Raises
    InputError as `burn` and `simulate` do, for times before 0, and where no times are known.
    """
    chain = Chain(burning)
    case = chain.case
    if times is None and case.span is None:
        raise InputError("times: expected times for a burn whose case has no span")
    times = checked_times(case.span if times is None else times)
    if times[0] < 0 or times[0] > times[-1]:
        raise InputError("times: a burn is followed from 0 on: give increasing times that are not negative")
    after = Piece(chain.closed, max(Fraction(times[-1]) - chain.closed, Fraction(0)), (), chain.base)
    omega, result = case.state, []
    blocks = {} if attitude is None else quaternion_blocks(case.blocks)
    for piece in [*chain.pieces(), after]:
        end = piece.begin + piece.length
        inside = [t for t in times.tolist() if piece.begin <= t and (t < end or piece is after)]
        local = [float(Fraction(t) - piece.begin) for t in inside]
        run = simulated(piece.scene, omega, np.unique([0.0, *local, float(piece.length)]), blocks)
        if run.status != "reached":
            raise InputError(f"state: the burn cannot be followed: {run.reason}")
        keep = np.searchsorted(run.t, local)
        result.append(replace(run, t=np.array(inside), state={n: v[keep] for n, v in run.state.items()}))
        if times[-1] < end:
            break
        omega = tuple(run.state["omega"][-1])
        blocks = {"attitude": tuple(run.state["quaternion"][-1])} if "quaternion" in run.state else {}
    full = _joined(result)
    return in_matrices(full) if attitude == "matrix" else full


def _joined(runs: Sequence[Simulation]) -> Simulation:
    """The pieces as one run: laws and errors are those of the worst, work is the sum."""
    first, last = runs[0], runs[-1]
    upper = lambda rows: {name: np.maximum.reduce([row[name] for row in rows if name in row])
                         for name in {name: None for row in rows for name in row}}
    return replace(
        last, t=np.concatenate([run.t for run in runs]),
        state={name: np.concatenate([run.state[name] for run in runs]) for name in first.state},
        invariant_drift={name: float(v) for name, v in upper([run.invariant_drift for run in runs]).items()},
        counters={name: sum(run.counters.get(name, 0) for run in runs) for name in first.counters},
        error=upper([run.error for run in runs]), reason=last.reason.then(SWITCHES))


# --- The first crossing of a limit along it
RUN_STEPS = 1_000_000  # of one segment


@dataclass(frozen=True)
class Link:
    """One motion of the chain; start, end: states of the run and of the second one, (3,) each."""

    begin: Fraction
    length: Fraction
    firing: tuple[str, ...]
    torque: Float3
    scene: Scene
    start: np.ndarray
    second: np.ndarray
    end: np.ndarray
    second_end: np.ndarray
    exact: Exact3 | None
    levels: tuple[Fraction, ...] = ()


def links_of(chain: Chain, pieces: Sequence[Piece] | None = None) -> Iterator[Link]:
    """The motions of the chain in turn, each with a second run from a start moved in its last place."""
    supplied = chain.case.exact_state
    state = np.array(chain.case.state, float)
    second = moved_row(state, MOVED) if state.any() else state
    for begin, length, firing, scene, levels in chain.pieces() if pieces is None else pieces:
        after, after_second = (end_of(scene, item, length) for item in (state, second))
        yield Link(begin, length, firing, tuple(float(m) for m in scene.vector("constant_torque")), scene,
                   state, second, after, after_second, supplied if not begin else None, levels)
        state, second = after, after_second


def end_of(scene: Scene, state: np.ndarray, length: Fraction) -> np.ndarray:
    """The state after a time; InputError where no run gets there."""
    if not length:
        return np.asarray(state, float)
    run = trajectory(scene, state, (0.0, float(length)), laws=False)
    if run.status == "stopped":
        raise InputError(f"state: the burn cannot be followed: {run.reason}")
    return np.asarray(run.states[-1], float)


CHAIN_ENCLOSED = Sentence(
    "chain-enclosed", "the chain of motions enclosed, its first crossing by roots")()
NOT_IN_ANY_LINK = Sentence("not-in-any-interval", "not reached between any two switches of the thrusters")()


def crossing_of(chain: Chain, limit: Limit, end: Fraction | None = None) -> Found | None:
    """The first crossing along the chain, by `end` (None: the last closing), proved; None where the work does
    not reach it."""
    proof = chain.enclosed(limit, end)
    if proof.high is not None and proof.low is not None:
        return Found(down(proof.low), up(proof.high), "proved", reason=CHAIN_ENCLOSED)
    if proof.done and proof.low is None:
        return Found(math.inf, math.inf, "proved", reason=CHAIN_ENCLOSED)
    return None


def first_along(links: Sequence[Link], limit: Limit, every: bool = False) -> Found:
    """The first crossing link by link, the first of them enclosed; inf where there is none. every: in those
    too where nothing fires, and g is constant."""
    for link in links:
        if not link.firing and not every:
            continue
        result = _first(link, limit)
        if result is not None:
            low = float(link.begin + Fraction(result.low))
            high = float(link.begin + Fraction(result.high)) if result.time else math.nan
            if link.begin:  # times of the chain, rounded outward
                low, high = math.nextafter(low, -math.inf), math.nextafter(high, math.inf)
            return replace(result, low=low, high=high)
    burns = [item for item in links if item.firing or every]
    level = "proved" if len(burns) <= 1 and all(burn.exact for burn in burns) else "run"
    return Found(math.inf, math.inf, level, reason=NOT_IN_ANY_LINK)


def _first(link: Link, limit: Limit) -> Found | None:
    """The first crossing within a link, None where there is none: proved from an exact start, else by runs
    from the ends of those before."""
    start = link.start.tolist()
    result = (of_one(link.scene, start, link.exact, limit, link.length) if link.exact
             else by_run(link.scene, start, limit, float(link.length), RUN_STEPS, link.second))
    if result.time:
        return result
    full = result.low >= float(link.length) * (1 - 2 * ROUNDING)
    return None if full else replace(result, level="undecided")
