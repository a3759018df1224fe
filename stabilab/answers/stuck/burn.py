"""Burns: what is left when thrusters close, and by when they must close so that |omega| stays below a
limit for ever.

While it fires a thruster's torque is constant in the body, so that a burn is a chain of motions under
constant torques, each started where the one before ended, at switching times that are exact.

The latest closing time for a limit L:

After the last closing a body without wheels moves freely. With D1 <= D2 <= D3, on one polhode (constant
kinetic energy and angular momentum) omega1^2 and omega3^2 are linear in omega2^2, and so is

    |omega|^2 = g^2 - (D2 - D1)(D3 - D2)/(D1 D3) omega2^2,
    g^2 = omega1^2 + D2 (D1 + D3 - D2)/(D1 D3) omega2^2 + omega3^2,

whose factor is not negative. Every polhode passes omega2 = 0 but for a rest at the middle axis, so that g,
constant on it, is its largest |omega| over all time. Closed at t, the body never turns faster than g(t), and
|omega(t)| <= g(t): the latest closing time is the first root of g^2 = L^2 along the burn, one crossing of a
quadratic form (`answers.passage`). With two equal moments and the wheels along the third axis |omega| is
constant in a free motion, and g = |omega|.

With other wheels G, the largest |omega| of the free motion, is no such form: it is the most over one period,
by a run, and the latest closing time the first root of G = L between two times that are known better. As
(D_i - D1)(D_i - D3) <= 0 for each axis, and as 2T = omega . D omega and h = |D omega + lambda| are constant,

    |omega|^2 <= ((D1 + D3) 2T - |D omega|^2)/(D1 D3) <= ((D1 + D3) 2T - (h - |lambda|)^2)/(D1 D3) = U^2

and |omega|^2 <= 2T/D1: while 2T < D1 L^2 closing is early enough, and it is too late once |omega| itself has
reached L. Only where U >= L a run is looked at."""
from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import groupby
from operator import itemgetter
from typing import Any

import numpy as np

from ...case.given import Amount
from ...errors import Caveat, InputError, Kind, without
from ...numbers.units import RATE, TIME, Dimension, in_si
from ...numbers.vectors import Float3
from ...orbit.result import Motion
from ...physics.scene import Scene
from ...reasons import Mass, Quantity, Rate, Reason, Reasoned, Sentence, Time, chained
from ..attitude import of_motion
from ..caveats import Known, of_case, of_limit, stated
from ..limit import Limit, asked, starts_above
from ..motion import motion
from ..motions.rows import periods
from ..passage import ROUNDING, WIDER, Found, TimeTo, largest_rate, times_of
from ..simulate import trajectory
from ..time_to import AT_THE_START, NOT_WITHIN
from ..turning.result import Attitude
from ..when import limit_of
from .chain import (
    RUN_STEPS,
    Chain,
    Link,
    Piece,
    crossing_of,
    end_of,
    first_along,
    limit_after,
    links_of,
    weights_of_largest,
)
from .forces import forces_of, in_front, over_forces

PROPELLANT = Sentence("mass-stays", "mass, inertia and centre of mass stay as the file gives them while "
                      "{spent} leave the body")
PROPELLANT_OF = Sentence("mass-stays-of", "mass, inertia and centre of mass stay as the file gives them "
                         "while {spent} of {mass} leave the body")
AS_STATED = Sentence("thrust-as-stated",
                     "force and direction of {thrusters} count as stated, without misalignment and tolerance")
LEAST_OF = Sentence("closing-least-of", "the latest closing time is the least of {forces} forces looked at, "
                    "{within}, without a proof for those between; what is left at a closing is that of the "
                    "forces as stated")

REACHED_BEFORE = Sentence("reached-before-the-burn",
                          "the motion before the burn reaches it already")()
CLOSED_THEN = Sentence("closed-then", "{thrusters}: closed at {time}, then {fate}")
RATE_AT_MOST = Sentence("rate-at-most", "|ω| at most {rate}")
CLOSE_BY = Sentence("close-by", "{rate} needs closing by {time} ({level})")
WHENEVER = Sentence("never-whenever-closed", "never, whenever the thrusters close")()
NOTHING_FIRES = Sentence("never-nothing-fires", "never, as nothing fires")()
BY_ENERGY = Sentence("never-by-energy", "never, for 2T/D1 stays below its square")()
EARLY_ENOUGH = Sentence("closing-early-enough",
                        "early enough up to {early} (2T/D1 is below its square, {level})")
TOO_LATE = Sentence("closing-too-late", "too late from {late} on (|ω| reaches it, {level})")
NO_LOOK = Sentence("closing-not-found", "not after any of some {looks} closing times, no proof")
BY_PERIODS = Sentence("closing-by-periods", "by runs over one period, each known to {share} of it, the first "
                      "among some {looks} closing times")
OF_CLOSING = Sentence("largest-after-closing", "largest |ω| after closing = {limit}: {known}")
EARLIEST = Sentence(
    "closing-earliest-of-forces", "{varied}: the earliest of {forces} forces, each by itself, which is no "
    "proof for those between")

TORQUE_STAYS = ("below: a torque stays after the last closing, so that there is no largest rate for ever; "
                "ask what one closing time leaves, with stop")
# --- The latest closing time
LOOKS = 2000  # closing times looked at after the first that is too late
WHEEL_LOOKS = 100  # with wheels, where each takes a run: before it
RATE_TOLERANCE = 1e-12  # of the limit, to which the largest rate of a run over one period is known
TURNS = 1000.0  # rad: how long a motion is followed that does not return, next to a separatrix


@dataclass(frozen=True)
class Latest(Reasoned):
    """The latest closing time that keeps |omega| below `limit`, rad/s, up to it and for ever after: between
    low and high, s. Both inf: no closing is too late. high NaN: not known, but any up to low is early enough.

    level: "exact", "proved" (the motion enclosed over all switches; low and high are neighbouring doubles but
    for the longest burns), "run" (roots along runs in machine precision, wider by what a second run shows) or
    "undecided"; reason: how it is known. again: (from, to), s, of later closing
    times after which the free motion stays below the limit again, though the burn has passed it or would
    have left such a motion in between; seen at 2,000 closing times, no proof. surely: (s, s), where wheels
    leave no closed form: closing is early enough up to the first and too late from the second on; None else.
    looked: where forces have a tolerance or a misalignment, what was looked at, within: in words; forces: of
    how many of them it is the least time; stated: the answer for the forces as stated, else None.
    """

    limit: float
    low: float
    high: float
    level: str
    again: tuple[tuple[float, float], ...] = ()
    surely: tuple[float, float] | None = None
    looked: Reason | None = None
    forces: int = 1
    stated: Latest | None = None

    @property
    def within(self) -> str:
        """Which forces were looked at, in words and SI units; empty where all are as stated."""
        return "" if self.looked is None else self.looked.text()


def _known(size: float, resolved: Reason) -> Reason:
    """How the closing time for a limit, rad/s, is known."""
    return OF_CLOSING(limit=Rate(size, digits=10), known=resolved)


def largest_after(scene: Scene, rates: Sequence[float]) -> float:
    """The largest |omega|, rad/s, over all time of the free motion through these rates of a body that
    has a closed form (`Chain.free`); of a rest at the middle axis, of the motions next to it."""
    return math.sqrt(sum(float(c) * w * w for c, w in zip(weights_of_largest(scene), rates)))


def largest_of_run(scene: Scene, rates: Sequence[float]) -> float:
    """The largest |omega|, rad/s, over all time of a motion without torque, with any wheels: over one period,
    to some 1e-13 of it; over a thousand radians of one that is not seen to return."""
    time = float(periods(scene, rates))
    if not time:
        return math.hypot(*rates)
    until = 1.001 * time if math.isfinite(time) else TURNS / math.hypot(*rates)
    return largest_rate(scene, list(rates), until, RUN_STEPS)[0]


def bound_of_largest(scene: Scene, states: np.ndarray) -> np.ndarray:
    """U of states (n, 3): what |omega| of the free motion through each never exceeds, rad/s, (n,)."""
    D, wheel = np.array(scene.body.inertia), np.array([float(v) for v in scene.vector("gyrostat")])
    smallest, greatest = D.min(), D.max()
    apart = np.linalg.norm(states * D + wheel, axis=1) - np.linalg.norm(wheel)
    square = ((smallest + greatest) * (states**2 @ D) - apart**2) / (smallest * greatest)
    return np.sqrt(np.minimum(square, states**2 @ D / smallest))


def closing_time(chain: Chain, links: Sequence[Link], below: Fraction) -> Latest:
    """The first closing time after which |omega| does not stay below, rad/s."""
    if not chain.free:
        return _by_runs(chain, links, below)
    base, size = chain.base, float(below)
    limit = limit_after(base, below)
    if links and limit.reached_by(links[0].exact or links[0].start.tolist()):
        return Latest(size, 0.0, 0.0, "exact", reason=_known(size, REACHED_BEFORE))
    result = _first(chain, links, limit)
    if result.never:
        return Latest(size, math.inf, math.inf, result.level, reason=_known(size, WHENEVER))
    again = _again(base, links, result.high, size) if result.time else ()
    return Latest(size, result.low, result.high, result.level, again, reason=_known(size, result.reason))


def _of_all_forces(chain: Chain, result: Latest, below: Fraction) -> Latest:
    """The answer that holds for all forces that are looked at within what the thrusters state; result: that
    for the forces as stated."""
    forces = forces_of(chain.burning)
    if forces is None or result.high == 0:
        return result
    when = Fraction(result.low) if 0 < result.low < math.inf else chain.closed

    def left(burning: Any) -> float:
        """The largest |omega| after closing at that time."""
        item = Chain(burning, when)
        state = list(links_of(item))[-1].end.tolist()
        return largest_after(item.base, state) if item.free else largest_of_run(item.base, state)
    first, many = in_front(forces, left)
    chains = [Chain(item, chain.until) for item in first]
    all_of = [result, *(closing_time(item, list(links_of(item)), below) for item in chains)]
    worst = min(all_of, key=lambda item: item.low)
    return replace(worst, level="run" if worst.level in ("exact", "proved") else worst.level,
                   reason=worst.reason.then(EARLIEST(varied=forces.reason, forces=many + 1)),
                   looked=forces.reason, forces=many + 1, stated=result)


def _first(chain: Chain, links: Sequence[Link], limit: Limit, every: bool = False) -> Found:
    return (crossing_of(chain, limit) if len(links) > 1 else None) or first_along(links, limit, every)


def _by_runs(chain: Chain, links: Sequence[Link], below: Fraction) -> Latest:
    """The first root of G = below, with the two times that bound it."""
    base, size = chain.base, float(below)
    if largest_of_run(base, list(chain.case.state)) >= size:
        return Latest(size, 0.0, 0.0, "run", reason=_known(size, REACHED_BEFORE))
    if not links:
        return Latest(size, math.inf, math.inf, "run", reason=_known(size, NOTHING_FIRES))
    energy = asked(base, energy=min(base.body.exact) * below**2 / 2)
    started = energy.reached_by(links[0].exact or links[0].start.tolist())
    early = (Found(0.0, 0.0, "exact", reason=AT_THE_START) if started
             else _first(chain, links, energy, every=True))
    if early.never:
        return Latest(size, math.inf, math.inf, early.level, reason=_known(size, BY_ENERGY))
    late = _first(chain, links, asked(base, rate=below), every=True)
    end = late.high if late.time else math.inf
    resolved = EARLY_ENOUGH(early=Time(early.low, digits=10).lower, level=early.level)
    if end < math.inf:
        resolved = resolved.then(TOO_LATE(late=Time(end, digits=10).upper, level=late.level), ", ")
    bracket = _bracket(base, links, (early.low, end), size)
    if bracket is None:
        return Latest(size, early.low if late.time else math.inf, end, "run",
                      reason=_known(size, NO_LOOK(looks=WHEEL_LOOKS).then(resolved)), surely=(early.low, end))
    item, times = bracket
    slack = max(RATE_TOLERANCE, *(np.abs(item.end - item.second_end) / size))
    low, high = (_root(base, item, times, size * (1 + sign * slack)) for sign in (-1, 1))
    begin = float(item.begin)
    low, high = math.nextafter(begin + low, -math.inf), math.nextafter(begin + high, math.inf)
    low = max(low, early.low)  # which is proved
    return Latest(size, low, max(min(high, end), low), "run",
                  reason=_known(size, BY_PERIODS(share=Quantity(slack, digits=1).upper,
                                                 looks=WHEEL_LOOKS).then(resolved)), surely=(early.low, end))


def _bracket(base: Scene, links: Sequence[Link], span: tuple[float, float],
             size: float) -> tuple[Link, tuple[float, float]] | None:
    """The first link and the two times after its begin, s, between which G reaches the limit; None where no
    look shows it."""
    for item, times in _looks(links, span, WHEEL_LOOKS):
        states = np.asarray(trajectory(item.scene, item.start, times, laws=False).states)
        for n in np.flatnonzero(bound_of_largest(base, states) >= size * (1 - RATE_TOLERANCE)).tolist():
            if largest_of_run(base, states[n].tolist()) >= size * (1 - RATE_TOLERANCE):
                return item, (float(times[max(n - 1, 0)]), float(times[n]))
    return None


def _looks(links: Sequence[Link], span: tuple[float, float], upper: int) -> Iterator[tuple[Link, np.ndarray]]:
    """Each link that fires within a span, with times after its begin, from 0 on; some `upper` in all."""
    last = links[-1]
    end = min(span[1], float(last.begin + last.length))
    for link in links:
        begin, length = float(link.begin), float(link.length)
        low, high = max(span[0] - begin, 0.0), min(end - begin, length)
        if link.firing and low < high:
            count = max(3, math.ceil(upper * (high - low) / (end - span[0])))
            yield link, np.unique([0.0, *np.linspace(low, high, count)])


def _root(base: Scene, item: Link, times: tuple[float, float], size: float) -> float:
    """Where G = size between two times after the begin of a link; the nearer of them where it is beyond."""
    from scipy.optimize import brentq

    def over(time: float) -> float:
        return largest_of_run(base, end_of(item.scene, item.start, Fraction(time)).tolist()) - size
    low, high = times
    if over(low) >= 0:
        return low
    return high if over(high) <= 0 else float(brentq(over, low, high, xtol=1e-300, rtol=1e-15))


def _again(base: Scene, links: Sequence[Link], after: float, size: float) -> tuple[tuple[float, float], ...]:
    """Intervals of closing times after `after` at which g is below the limit again."""
    weights = np.array([float(c) for c in weights_of_largest(base)])
    last = links[-1]
    end = float(last.begin + last.length)
    times, sizes = [], []
    for link in links:
        length, begin = float(link.length), float(link.begin)
        if begin + length <= after:
            continue
        count = max(3, math.ceil(LOOKS * length / max(end - after, length)))
        steps = np.linspace(0.0, length, count)
        run = trajectory(link.scene, link.start, steps, laws=False)
        times += (begin + np.asarray(run.t)).tolist()
        sizes += np.sqrt(np.asarray(run.states) ** 2 @ weights).tolist()
    looks = [(time, value < size) for time, value in zip(times, sizes) if time > after]
    inside = [[time for time, _ in group] for below, group in groupby(looks, key=itemgetter(1)) if below]
    return tuple((group[0], group[-1]) for group in inside)


# --- The burn
@dataclass(frozen=True)
class Switch:
    """time: s; firing: names of the thrusters that fire from then on; torque: theirs, N m; rates: rad/s;
    vectors along the principal axes; levels: shares of their forces, by their profiles."""

    time: float
    firing: tuple[str, ...]
    torque: Float3
    rates: Float3
    levels: tuple[float, ...] = ()


@dataclass(frozen=True)
class Closed:
    """What is left when the last thruster closes at `time`, s; vectors along the principal axes.

    rates: rad/s, known to `error` (rad/s, by a second run from a start moved in its last places); momentum: N
    m s, with the wheels'; energy: J, kinetic, of the body; largest_rate: of the motion that follows, over all
    time, rad/s, None where it is not known; largest_before: |omega| at the most up to then, likewise; motion,
    attitude: of what follows (attitude None where a torque is left); fired: s, and used: kg (None without a
    mass flow), of every thruster in the order of the file; None of one without a schedule.
    """

    time: float
    rates: Float3
    error: float
    momentum: Float3
    energy: float
    largest_rate: float | None
    largest_before: float | None
    motion: Motion = field(repr=False)
    attitude: Attitude | None = field(repr=False)
    fired: tuple[float | None, ...]
    used: tuple[float | None, ...]


@dataclass(frozen=True, repr=False)
class Burned:
    """thrusters: names, in the order of the file; switches: in order of time; closed: what is left after the
    last closing; latest: where a limit was asked for, else None; closed_latest: what is left where they close
    at its lower end, else None."""

    thrusters: tuple[str, ...]
    switches: tuple[Switch, ...]
    closed: Closed
    latest: Latest | None = None
    closed_latest: Closed | None = None
    caveats: tuple[Caveat, ...] = ()

    def __repr__(self) -> str:
        left, largest = self.closed, self.closed.largest_rate
        needed = self.latest
        parts = chained(
            CLOSED_THEN(thrusters=self.thrusters, time=Time(left.time), fate=left.motion.fate.word),
            None if largest is None else RATE_AT_MOST(rate=Rate(largest).upper),
            None if needed is None else CLOSE_BY(rate=Rate(needed.limit), time=Time(needed.low).lower,
                                                 level=str(needed.level)),
            *(caveat.reason for caveat in self.caveats))
        return f"Burned({parts})"


def burn(burning: Any, stop: Amount | None = None, below: Amount | None = None) -> Burned:
    """What thrusters that fire on a schedule leave behind.

    burning: a case, the path or the text of a case file, a dict with its tables, or what
    `stabilab.load_burning` gives; where no thruster has a schedule, the stuck ones fire from 0 on. stop: s,
    all close then, if not before; below: rad/s, asks for the latest closing time that keeps |omega| below it
    for ever. Numbers, or text with a unit ("12 s", "30 deg/s"). Raises InputError for times and limits that
    are none, for scenes with other effects than wheels and a constant torque, and for `below` where a
    constant torque stays.
    """
    last = None if stop is None else _positive(stop, TIME, "stop")
    limit = None if below is None else _positive(below, RATE, "below")
    chain = Chain(burning, last)
    if limit is not None and not chain.quiet:
        raise InputError(TORQUE_STAYS)
    links, craft = list(links_of(chain)), chain.case
    switches = tuple(Switch(float(link.begin), link.firing, link.torque, tuple(link.start.tolist()),
                            tuple(map(float, link.levels)))
                     for link in links)
    closed = what_is_left(chain, links)
    result = Burned(tuple(t.name for t in craft.thrusters), switches, closed,
                    caveats=(*craft_caveats(craft), *_granted(craft, closed), *_limit_reached(chain)))
    return result if limit is None else _with_latest(result, chain, links, limit)


def with_latest(result: Burned, burning: Any, below: Fraction) -> Burned:
    """What `burn(burning, below=below)` gives, of which `burn(burning)` gave the result; below: rad/s. Raises
    InputError where a constant torque stays."""
    chain = Chain(burning)
    if not chain.quiet:
        raise InputError(TORQUE_STAYS)
    return _with_latest(result, chain, list(links_of(chain)), below)


def _with_latest(result: Burned, chain: Chain, links: list[Link], limit: Fraction) -> Burned:
    """The answer with the latest closing time that keeps |omega| below the limit."""
    craft = chain.case
    out = _of_all_forces(chain, closing_time(chain, links, limit), limit)
    first = (caveat for caveat in result.caveats if caveat.kind is Kind.LIMIT)
    result = replace(result, caveats=(*craft_caveats(craft), *_granted(craft, result.closed, out), *first))
    if not 0 < out.low < math.inf:
        return replace(result, latest=out)
    early = Chain(chain.burning, Fraction(out.low))
    return replace(result, latest=out, closed_latest=what_is_left(early, list(links_of(early))))


def what_is_left(chain: Chain, links: Sequence[Link]) -> Closed:
    """What is left after the last link of a burn."""
    body, wheel = chain.base.body, [float(v) for v in chain.base.vector("gyrostat")]
    state = links[-1].end if links else np.array(chain.case.state, float)
    error = WIDER * float(np.abs(state - links[-1].second_end).max()) if links else 0.0
    error = max(error, ROUNDING * float(np.abs(state).max()))
    rates = tuple(state.tolist())
    result = motion(chain.base, rates)
    runs = [(link, *largest_rate(link.scene, link.start.tolist(), float(link.length), RUN_STEPS))
            for link in links]
    full = all(reached >= float(item.length) * (1 - ROUNDING) for item, _, reached in runs)
    before = max((size for _, size, _ in runs), default=math.hypot(*rates)) if full else None
    stop = chain.until
    steps = [t.burn and tuple(t.burn.steps(stop)) for t in chain.case.thrusters]
    fired = [of if of is None else sum((b - a for a, b, _ in of), Fraction(0)) for of in steps]
    at_full = [of if of is None else sum((level * (b - a) for a, b, level in of), Fraction(0))
               for of in steps]
    largest = result.largest
    if chain.free:
        largest = largest_after(chain.base, rates)
    elif chain.quiet and largest is not None:
        largest = largest_of_run(chain.base, rates)
    used = [None if t.burn is None or t.burn.mass_flow is None or time is None
            else float(t.burn.mass_flow * time) for t, time in zip(chain.case.thrusters, at_full)]
    return Closed(float(chain.closed), rates, error,
                  tuple(d * w + l for d, w, l in zip(body.inertia, rates, wheel)),
                  sum(d * w * w for d, w in zip(body.inertia, rates)) / 2,
                  largest, before, result,
                  of_motion(chain.base, rates, result) if chain.quiet else None,
                  tuple(None if v is None else float(v) for v in fired), tuple(used))


def _limit_reached(chain: Chain) -> list[Caveat]:
    """When the motion first reaches the limit of its case, over all switches and after them, where it does.
    """
    ask = limit_of(chain.case)
    if ask is None:
        return []
    found = crossing_time(chain, ask, None)
    return of_limit(Known(scene=chain.base, first=(stated(chain.case.limits), found)))


def craft_caveats(craft: Any) -> tuple[Caveat, ...]:
    """The caveats of a case but for what its thrusters leave open, of which a burn speaks itself."""
    return without(of_case(craft), Kind.TOLERANCE, Kind.MISALIGNMENT)


def _granted(craft: Any, closed: Closed, result: Latest | None = None) -> Iterator[Caveat]:
    """What the answer takes for granted of the thrusters; result: by when they must close, if asked."""
    if spent := sum(used or 0.0 for used in closed.used):
        mass = craft.physical.body.mass
        left = Mass(spent, digits=4)
        yield Caveat(Kind.BURN, PROPELLANT_OF(spent=left, mass=Mass(mass)) if mass
                     else PROPELLANT(spent=left))
    loose = [t.name for t in craft.thrusters if t.burn and (t.misalignment or t.force_tolerance)]
    if result is not None and result.stated is not None and result.looked is not None:
        yield Caveat(Kind.BURN, LEAST_OF(forces=result.forces, within=result.looked))
    elif loose:
        yield Caveat(Kind.BURN, AS_STATED(thrusters=tuple(loose)))
    for item in craft.assumed:
        yield Caveat(Kind.BURN, item)


def time_of_burn(burning: Any, ask: dict[str, Any], until: Fraction | None = None) -> TimeTo:
    """The first time at which the motion of a burn reaches a limit, over all switches and after them.

    ask: the one limit, by its name as of `time_to`; until: s, the time at which the search ends; None: the
    end of the span of the case, or the last closing, whichever is later, unless the free motion after the
    burn surely stays below the limit for ever. Proved as far as the work reaches, by roots along runs beyond
    (but for the angle of an axis).
    """
    chain = Chain(burning)
    limit = asked(chain.base, **ask)
    starts_above(limit, chain.case)
    result = crossing_time(chain, ask, until)
    case = chain.case
    end = until if until is not None else max(chain.closed, Fraction(case.span[1]) if case.span else 0)
    over = over_forces(chain.burning, ask, Fraction(end), lambda x: crossing_time(x, ask, until))
    caveats = of_case(case) if over is None else (*craft_caveats(case), Caveat(Kind.TILT, over.reason))
    return replace(times_of([result], (), limit.label, chain.base, np.array(case.state), caveats), tilt=over)


NEVER_WITH_THRUSTERS = Sentence(
    "never-with-thrusters", "never, neither while thrusters fire nor after")()


def crossing_time(chain: Chain, ask: dict[str, Any], until: Fraction | None) -> Found:
    """When a burn first reaches a limit; arguments as of `time_of_burn`. Forces count as stated."""
    case, closed, limit = chain.case, chain.closed, asked(chain.base, **ask)
    if limit.reached_by(case.exact_state or case.state):
        return Found(0.0, 0.0, "exact", reason=AT_THE_START)
    kept = (limit_after(chain.base, in_si(ask["rate"], RATE, "rate")) if limit.kind == "rate" and chain.free
            else limit if limit.kind == "energy" and chain.quiet else None)
    if until is None and kept is not None:  # g, or the energy, stays after the last closing
        after = crossing_of(chain, kept) or first_along(list(links_of(chain)), kept)
        if after.never:
            return replace(after, reason=NEVER_WITH_THRUSTERS)
    end = until if until is not None else max(closed, Fraction(case.span[1]) if case.span else closed)
    result = crossing_of(chain, limit, end) if limit.momentum is None else None
    if result is None and limit.kind != "tilt":
        rest = [Piece(closed, end - closed, (), chain.base)] if end > closed else []
        result = first_along(list(links_of(chain, [*chain.pieces(), *rest])), limit, every=True)
    if result is not None and result.low <= end:
        return result
    resolved = 0.0 if result is None else float(end)
    return Found(resolved, math.nan, "undecided" if result is None else result.level,
                 reason=NOT_WITHIN(time=Time(resolved).lower))


def _positive(value: Any, unit: Dimension, name: str) -> Fraction:
    result = in_si(value, unit, name)
    if result <= 0:
        raise InputError(f"{name}: expected a positive number, got {float(result):.10g}")
    return result
