"""The first crossing of a limit along the chain of motions of a burn: proved where it can be enclosed, else
by roots along runs, link by link."""
from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from ...errors import InputError
from ...numbers.vectors import Exact3, Float3
from ...physics.scene import Scene
from ...physics.states import moved_row
from ..passage.limit import Limit
from ..passage.run import MOVED, ROUNDING, Found, by_run
from ..simulate import trajectory
from ..time_to import down, of_one, up
from .chain import Chain, Piece

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


def links_of(chain: Chain, pieces: Sequence[Piece] | None = None) -> Iterator[Link]:
    given = chain.case.exact_state
    state = np.array(chain.case.state, float)
    second = moved_row(state, MOVED) if state.any() else state
    for begin, length, firing, scene in chain.pieces() if pieces is None else pieces:
        after, after_second = (end_of(scene, one, length) for one in (state, second))
        yield Link(begin, length, firing, tuple(float(m) for m in scene.vector("constant_torque")), scene,
                   state, second, after, after_second, given if not begin else None)
        state, second = after, after_second


def end_of(scene: Scene, state: np.ndarray, length: Fraction) -> np.ndarray:
    if not length:
        return np.asarray(state, float)
    run = trajectory(scene, state, (0.0, float(length)), laws=False)
    if run.status == "stopped":
        raise InputError(f"state: the burn cannot be followed: {run.reason}")
    return np.asarray(run.states[-1], float)


def crossing_of(chain: Chain, limit: Limit, end: Fraction | None = None) -> Found | None:
    """The first crossing along the chain, by `end` (None: the last closing), proved; None where the work does
    not reach it."""
    proof = chain.enclosed(limit, end)
    words = f"{limit.words}: the chain of motions enclosed, its first crossing by roots"
    if proof.high is not None and proof.low is not None:
        return Found(down(proof.low), up(proof.high), "proved", words)
    return Found(math.inf, math.inf, "proved", words) if proof.done and proof.low is None else None


def first_along(links: Sequence[Link], limit: Limit, every: bool = False) -> Found:
    """The first crossing link by link, the first of them enclosed; inf where there is none. every: in those
    too where nothing fires, and g is constant."""
    for one in links:
        if not one.firing and not every:
            continue
        found = _first(one, limit)
        if found is not None:
            low = float(one.begin + Fraction(found.low))
            high = float(one.begin + Fraction(found.high)) if found.time else math.nan
            if one.begin:  # times of the chain, rounded outward
                low, high = math.nextafter(low, -math.inf), math.nextafter(high, math.inf)
            return replace(found, low=low, high=high)
    burns = [one for one in links if one.firing or every]
    level = "proved" if len(burns) <= 1 and all(one.exact for one in burns) else "run"
    return Found(math.inf, math.inf, level, limit.words)


def _first(link: Link, limit: Limit) -> Found | None:
    """The first crossing within a link, None where there is none: proved from an exact start, else by runs
    from the ends of those before."""
    start = link.start.tolist()
    found = (of_one(link.scene, start, link.exact, limit, link.length) if link.exact
             else by_run(link.scene, start, limit, float(link.length), RUN_STEPS, link.second))
    if found.time:
        return found
    whole = found.low >= float(link.length) * (1 - 2 * ROUNDING)
    return None if whole else replace(found, level="undecided")
