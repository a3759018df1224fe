"""Burns: what is left when thrusters close, and by when they must close.

While it fires a thruster's torque is constant in the body, so that a burn is a chain of motions under
constant torques, each started where the one before ended, at switching times that are exact.
"""
from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any

import numpy as np

from ...caveat import Caveat
from ...errors import InputError
from ...numbers.units import RATE, TIME, Dimension, in_si
from ...numbers.vectors import Float3
from ...orbit.result import Motion
from ..attitude.ask import of_motion
from ..attitude.result import Attitude
from ..motion import motion
from ..passage.limit import Limit, asked
from ..passage.run import ROUNDING, WIDER, Found, TimeTo, largest_rate, times_of
from .chain import Chain, Piece, limit_after
from .closing import Latest, largest_after, largest_of_run, latest
from .crossing import RUN_STEPS, Link, crossing_of, first_along, links_of


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
        raise InputError("below: a torque stays after the last closing, so that there is no largest rate for "
                         "ever; ask what one closing time leaves, with stop")
    links, craft = list(links_of(chain)), chain.case
    switches = tuple(Switch(float(one.begin), one.firing, one.torque, tuple(one.start.tolist()))
                     for one in links)
    closed = _closed(chain, links)
    result = Burned(tuple(t.name for t in craft.thrusters), switches, closed,
                    caveats=(*craft.caveats, *_granted(craft, closed)))
    if limit is None:
        return result
    found = latest(chain, links, limit)
    if not 0 < found.low < math.inf:
        return replace(result, latest=found)
    early = Chain(burning, Fraction(found.low))
    return replace(result, latest=found, closed_latest=_closed(early, list(links_of(early))))


def _closed(chain: Chain, links: Sequence[Link]) -> Closed:
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
    stop = chain.until
    fired = [t.burn and sum((b - a for a, b in t.burn.windows(stop)), Fraction(0))
             for t in chain.case.thrusters]
    largest = found.largest
    if chain.free:
        largest = largest_after(chain.base, rates)
    elif chain.quiet and largest is not None:
        largest = largest_of_run(chain.base, rates)
    used = [None if t.burn is None or t.burn.mass_flow is None else float(t.burn.mass_flow * time)
            for t, time in zip(chain.case.thrusters, fired)]
    return Closed(float(chain.closed), rates, error,
                  tuple(d * w + l for d, w, l in zip(body.inertia, rates, wheel)),
                  sum(d * w * w for d, w in zip(body.inertia, rates)) / 2,
                  largest, before, found,
                  of_motion(chain.base, rates, found) if chain.quiet else None,
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


def time_of_burn(burning: Any, ask: dict[str, Any], until: Fraction | None = None) -> TimeTo:
    """The first time at which the motion of a burn reaches a limit, over all switches and after them.

    ask: the one limit, by its name as of `time_to`; until: s, the time at which the search ends; None: the
    end of the span of the case, or the last closing, whichever is later, unless the free motion after the
    burn surely stays below the limit for ever. Proved as far as the work reaches, by roots along runs beyond
    (but for the angle of an axis).
    """
    chain = Chain(burning)
    limit = asked(chain.base, **ask)
    found = _first(chain, limit, ask, until)
    return times_of([found], (), limit.words, chain.base, np.array(chain.case.state), chain.case.caveats)


def _first(chain: Chain, limit: Limit, ask: dict[str, Any], until: Fraction | None) -> Found:
    case, closed = chain.case, chain.closed
    if limit.reached_by(case.exact_state or case.state):
        return Found(0.0, 0.0, "exact", f"{limit.words}: reached already at the start")
    if until is None and limit.kind == "rate" and chain.free:
        largest = limit_after(chain.base, in_si(ask["rate"], RATE, "rate"))
        after = crossing_of(chain, largest) or first_along(list(links_of(chain)), largest)
        if after.never:
            return replace(after, words=f"{limit.words}: never, neither while thrusters fire nor after")
    end = until if until is not None else max(closed, Fraction(case.span[1]) if case.span else closed)
    found = crossing_of(chain, limit, end)
    if found is None and limit.kind != "tilt":
        rest = [Piece(closed, end - closed, (), chain.base)] if end > closed else []
        found = first_along(list(links_of(chain, [*chain.pieces(), *rest])), limit, every=True)
    if found is not None and found.low <= end:
        return found
    known = 0.0 if found is None else float(end)
    return Found(known, math.nan, "undecided" if found is None else found.level,
                 f"{limit.words}: not reached before {known:.10g} s")


def _positive(value: Any, unit: Dimension, name: str) -> Fraction:
    number = in_si(value, unit, name)
    if number <= 0:
        raise InputError(f"{name}: expected a positive number, got {float(number):.10g}")
    return number
