"""Burns: what is left when thrusters close, and by when they must close.

While it fires a thruster's torque is constant in the body, so that a burn is a chain of motions under
constant torques, each started where the one before ended, at switching times that are exact.

After the last closing a body without wheels moves freely. With D1 <= D2 <= D3, on one polhode (constant
kinetic energy and angular momentum) omega1^2 and omega3^2 are linear in omega2^2, and so is

    |omega|^2 = g^2 - (D2 - D1)(D3 - D2)/(D1 D3) omega2^2,
    g^2 = omega1^2 + D2 (D1 + D3 - D2)/(D1 D3) omega2^2 + omega3^2,

whose factor is not negative. Every polhode passes omega2 = 0 but for a rest at the middle axis, so that g,
constant on it, is its largest |omega| over all time. Closed at t, the body never turns faster than g(t), and
|omega(t)| <= g(t): the latest closing time for a limit L is the first root of g^2 = L^2 along the burn, one
crossing of a quadratic form (`answers.passage`).
"""
from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import groupby
from operator import itemgetter
from typing import Any

import numpy as np

from ...caveat import Caveat
from ...errors import InputError
from ...numbers.units import RATE, TIME, Dimension, in_si
from ...numbers.vectors import Exact3, Float3
from ...orbit.result import Motion
from ...physics.scene import Scene
from ...physics.states import moved_row
from ..attitude.ask import of_motion
from ..attitude.result import Attitude
from ..motion import motion
from ..passage.limit import Limit, asked
from ..passage.run import ROUNDING, WIDER, Found, TimeTo, by_run, largest_rate
from ..simulate import trajectory
from ..time_to import down, of_one, up
from .chain import Chain, Piece, limit_after, weights_of_largest

RUN_STEPS = 1_000_000  # of one segment
LOOKS = 2000  # closing times looked at after the first that is too late
MOVED = 2.0  # places by which the start of the second run is moved


@dataclass(frozen=True)
class Switch:
    """time: s; firing: names of the thrusters that fire from then on; torque: theirs, N m; rates: rad/s;
    vectors along the principal axes."""

    time: float
    firing: tuple[str, ...]
    torque: Float3
    rates: Float3


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


@dataclass(frozen=True)
class Latest:
    """The latest closing time that keeps |omega| below `limit`, rad/s, up to it and for ever after: between
    low and high, s. Both inf: no closing is too late. high NaN: not known, but any up to low is early enough.

    level: "exact", "proved" (the motion enclosed over all switches; low and high are neighbouring doubles but
    for the longest burns), "run" (roots along runs in machine precision, wider by what a second run shows) or
    "undecided"; because: how it is known. again: (from, to), s, of later closing
    times after which the free motion stays below the limit again, though the burn has passed it or would
    have left such a motion in between; seen at 2,000 closing times, no proof.
    """

    limit: float
    low: float
    high: float
    level: str
    because: str
    again: tuple[tuple[float, float], ...] = ()


@dataclass(frozen=True)
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


def burn(burning: Any, stop: Any = None, below: Any = None) -> Burned:
    """What thrusters that fire on a schedule leave behind.

    burning: the path or the text of a case file, or what `stabilab.load_burning` gives. stop: s, all close
    then, if not before; below: rad/s, asks for the latest closing time that keeps |omega| below it for ever.
    Numbers, or text with a unit ("12 s", "30 deg/s"). Raises InputError for times and limits that are none,
    for scenes with other effects than wheels and a constant torque, and for `below` where a wheel or a
    constant torque stays.
    """
    last = None if stop is None else _positive(stop, TIME, "stop")
    limit = None if below is None else _positive(below, RATE, "below")
    chain = Chain(burning, last)
    if limit is not None and not chain.free:
        raise InputError("below: the largest rate after closing is known in closed form for a body without "
                         "wheels on which no torque stays; ask what one closing time leaves, with stop")
    links, craft = list(_links(chain)), chain.case
    switches = tuple(Switch(float(one.begin), one.firing, one.torque, tuple(one.start.tolist()))
                     for one in links)
    closed = _closed(chain, links)
    result = Burned(tuple(t.name for t in craft.thrusters), switches, closed,
                    caveats=(*craft.caveats, *_granted(craft, closed)))
    if limit is None:
        return result
    latest = _latest(chain, links, limit)
    if not 0 < latest.low < math.inf:
        return replace(result, latest=latest)
    early = Chain(burning, Fraction(latest.low))
    return replace(result, latest=latest, closed_latest=_closed(early, list(_links(early))))


@dataclass(frozen=True)
class _Link:
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


def _links(chain: Chain, pieces: Sequence[Piece] | None = None) -> Iterator[_Link]:
    given = chain.case.exact_state
    state = np.array(chain.case.state, float)
    second = moved_row(state, MOVED) if state.any() else state
    for begin, length, firing, scene in chain.pieces() if pieces is None else pieces:
        after, after_second = (_end_of(scene, one, length) for one in (state, second))
        yield _Link(begin, length, firing, tuple(float(m) for m in scene.vector("constant_torque")), scene,
                    state, second, after, after_second, given if not begin else None)
        state, second = after, after_second


def _closed(chain: Chain, links: Sequence[_Link]) -> Closed:
    """What is left after the last of them."""
    body, wheel = chain.base.body, [float(v) for v in chain.base.vector("gyrostat")]
    state = links[-1].end if links else np.array(chain.case.state, float)
    error = WIDER * float(np.abs(state - links[-1].second_end).max()) if links else 0.0
    error = max(error, ROUNDING * float(np.abs(state).max()))
    rates = tuple(state.tolist())
    found = motion(chain.base, rates)
    runs = [(one, *largest_rate(one.scene, one.start.tolist(), float(one.length), RUN_STEPS))
            for one in links]
    whole = all(reached >= float(one.length) * (1 - ROUNDING) for one, _, reached in runs)
    before = max((size for _, size, _ in runs), default=math.hypot(*rates)) if whole else None
    quiet = not any(chain.base.vector("constant_torque"))
    stop = chain.until
    fired = [t.burn and sum((b - a for a, b in t.burn.windows(stop)), Fraction(0))
             for t in chain.case.thrusters]
    used = [None if t.burn is None or t.burn.mass_flow is None else float(t.burn.mass_flow * time)
            for t, time in zip(chain.case.thrusters, fired)]
    return Closed(float(chain.closed), rates, error,
                  tuple(d * w + l for d, w, l in zip(body.inertia, rates, wheel)),
                  sum(d * w * w for d, w in zip(body.inertia, rates)) / 2,
                  largest_after(chain.base, rates) if chain.free else found.largest, before, found,
                  of_motion(chain.base, rates, found) if quiet else None,
                  tuple(None if v is None else float(v) for v in fired), tuple(used))


def _granted(craft: Any, closed: Closed) -> Iterator[Caveat]:
    """What the answer takes for granted of the thrusters."""
    if spent := sum(used or 0.0 for used in closed.used):
        mass = craft.physical.body.mass
        share = f" of {float(mass):.6g} kg" if mass else ""
        yield Caveat("burn", f"mass, inertia and centre of mass stay as the file gives them while "
                             f"{spent:.4g} kg{share} leave the body")
    loose = [t.name for t in craft.thrusters if t.burn and (t.misalignment or t.force_tolerance)]
    if loose:
        yield Caveat("burn", f"force and direction of {', '.join(loose)} count as stated, without "
                             "misalignment and tolerance")
    for note in craft.notes:
        yield Caveat("burn", note)


def _end_of(scene: Scene, state: np.ndarray, length: Fraction) -> np.ndarray:
    run = trajectory(scene, state, (0.0, float(length)), laws=False)
    if run.status == "stopped":
        raise InputError(f"state: the burn cannot be followed: {run.reason}")
    return np.asarray(run.states[-1], float)


def largest_after(scene: Scene, rates: Sequence[float]) -> float:
    """The largest |omega|, rad/s, over all time of the free motion of a body without wheels through these
    rates; of a rest at the middle axis, of the motions next to it."""
    return math.sqrt(sum(float(c) * w * w for c, w in zip(weights_of_largest(scene), rates)))


def _latest(chain: Chain, links: Sequence[_Link], below: Fraction) -> Latest:
    """The first root of g = below along the chain."""
    base, size = chain.base, float(below)
    limit = limit_after(base, below)
    words = limit.words
    if links and limit.reached_by(links[0].exact or links[0].start.tolist()):
        return Latest(size, 0.0, 0.0, "exact", f"{words}: the motion before the burn reaches it already")
    found = (_enclosed(chain, limit) if len(links) > 1 else None) or _along(links, limit)
    if math.isinf(found.low):
        return Latest(size, math.inf, math.inf, found.level, f"{words}: never, whenever the thrusters close")
    again = _again(base, links, found.high, size) if math.isfinite(found.high) else ()
    return Latest(size, found.low, found.high, found.level, found.words, again)


def time_of_burn(burning: Any, ask: dict[str, Any], until: Fraction | None = None) -> TimeTo:
    """The first time at which the motion of a burn reaches a limit, over all switches and after them.

    ask: the one limit, by its name as of `time_to`; until: s, the time at which the search ends; None: the
    end of the span of the case, or the last closing, whichever is later, unless the free motion after the
    burn surely stays below the limit for ever. Proved as far as the work reaches, by roots along runs beyond
    (but for the angle of an axis).
    """
    chain = Chain(burning)
    case, limit = chain.case, asked(chain.base, **ask)
    if limit.reached_by(case.exact_state or case.state):
        return _time(chain, limit, Found(0.0, 0.0, "exact", f"{limit.words}: reached already at the start"))
    if until is None and limit.kind == "rate" and chain.free:
        largest = limit_after(chain.base, in_si(ask["rate"], RATE, "rate"))
        after = _enclosed(chain, largest) or _along(list(_links(chain)), largest)
        if math.isinf(after.low):
            return _time(chain, limit, replace(after, words=f"{limit.words}: never, neither while thrusters "
                                                            "fire nor after"))
    closed = chain.closed
    end = until if until is not None else max(closed, Fraction(case.span[1]) if case.span else closed)
    found = _enclosed(chain, limit, end)
    if found is None and limit.kind != "tilt":
        rest = [Piece(closed, end - closed, (), chain.base)] if end > closed else []
        found = _along(list(_links(chain, [*chain.pieces(), *rest])), limit, every=True)
    if found is None or not found.low <= end:
        known = 0.0 if found is None else float(end)
        found = Found(known, math.nan, "undecided" if found is None else found.level,
                      f"{limit.words}: not reached before {known:.10g} s")
    return _time(chain, limit, found)


def _time(chain: Chain, limit: Limit, found: Found) -> TimeTo:
    scalar = lambda value, kind: np.array(value, kind)[()]  # as `time_to` has it
    return TimeTo(scalar(found.low, float), scalar(found.high, float), scalar(found.level, object),
                  scalar(found.words, object), limit.words, chain.base, np.array(chain.case.state),
                  caveats=chain.case.caveats)


def _enclosed(chain: Chain, limit: Limit, end: Fraction | None = None) -> Found | None:
    """The first crossing along the chain, by `end` (None: the last closing), proved; None where the work does
    not reach it."""
    proof = chain.enclosed(limit, end)
    words = f"{limit.words}: the chain of motions enclosed, its first crossing by roots"
    if proof.high is not None and proof.low is not None:
        return Found(down(proof.low), up(proof.high), "proved", words)
    return Found(math.inf, math.inf, "proved", words) if proof.done and proof.low is None else None


def _along(links: Sequence[_Link], limit: Limit, every: bool = False) -> Found:
    """The first crossing link by link, the first of them enclosed; inf where there is none. every: in those
    too where nothing fires, and g is constant."""
    for one in links:
        if not one.firing and not every:
            continue
        found = _first(one, limit)
        if found is not None:
            low, high = _outward(one.begin, found.low, found.high)
            return replace(found, low=low, high=high)
    burns = [one for one in links if one.firing or every]
    level = "proved" if len(burns) <= 1 and all(one.exact for one in burns) else "run"
    return Found(math.inf, math.inf, level, limit.words)


def _outward(begin: Fraction, low: float, high: float) -> tuple[float, float]:
    """Two times of a link as times of the chain, rounded outward."""
    first = float(begin + Fraction(low))
    last = float(begin + Fraction(high)) if math.isfinite(high) else math.nan
    if not begin:
        return first, last
    return math.nextafter(first, -math.inf), math.nextafter(last, math.inf)


def _first(link: _Link, limit: Limit) -> Found | None:
    """The first crossing within a link, None where there is none: proved from an exact start, else by runs
    from the ends of those before."""
    start = link.start.tolist()
    found = (of_one(link.scene, start, link.exact, limit, link.length) if link.exact
             else by_run(link.scene, start, limit, float(link.length), RUN_STEPS, link.second))
    if math.isfinite(found.high):
        return found
    whole = found.low >= float(link.length) * (1 - 2 * ROUNDING)
    return None if whole else replace(found, level="undecided")


def _again(base: Scene, links: Sequence[_Link], after: float, size: float) -> tuple[tuple[float, float], ...]:
    """Intervals of closing times after `after` at which g is below the limit again."""
    weights = np.array([float(c) for c in weights_of_largest(base)])
    last = links[-1]
    end = float(last.begin + last.length)
    times, sizes = [], []
    for one in links:
        length, begin = float(one.length), float(one.begin)
        if begin + length <= after:
            continue
        count = max(3, math.ceil(LOOKS * length / max(end - after, length)))
        steps = np.linspace(0.0, length, count)
        run = trajectory(one.scene, one.start, steps, laws=False)
        times += (begin + np.asarray(run.t)).tolist()
        sizes += np.sqrt(np.asarray(run.states) ** 2 @ weights).tolist()
    looks = [(time, value < size) for time, value in zip(times, sizes) if time > after]
    inside = [[time for time, _ in group] for below, group in groupby(looks, key=itemgetter(1)) if below]
    return tuple((group[0], group[-1]) for group in inside)


def _positive(value: Any, unit: Dimension, name: str) -> Fraction:
    number = in_si(value, unit, name)
    if number <= 0:
        raise InputError(f"{name}: expected a positive number, got {float(number):.10g}")
    return number
