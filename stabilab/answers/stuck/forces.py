"""A burn under every force that its thrusters may have: of the sizes within their tolerances, and of the
directions round the edge of their misalignment.

The latest closing time has to hold for all of them, the time at a limit has a range. Forces are looked at one
by one, no proof covers those between: a quick measure puts them in an order, and the first of them are
answered as the burn itself is."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from ...reasons import Reason
from ..caveats import varied
from ..limit import Limit, asked
from ..passage import Found, run_once
from ..tilt import Cone, Spread, cone_of_forces, nearest_round
from .chain import Chain, Piece, end_of

ANSWERED = 2  # of the forces, those that the quick measure puts in front
Place = tuple[float | None, tuple[float, ...]]  # (azimuth or None, size of every part) of a cone


@dataclass(frozen=True)
class Forces:
    """burning: the burn with forces as stated; cone: what they may be besides; loose: which thrusters of the
    case that are, in the order of its parts."""

    burning: Any
    cone: Cone
    loose: tuple[int, ...]

    @property
    def reason(self) -> Reason:
        """What is looked at."""
        return varied(self.cone.angle, self.cone.within)

    def places(self) -> list[Place]:
        """Those that are looked at, the forces as stated left out."""
        own, *corners = self.cone.corners
        edge = [(at, sizes) for sizes in self.cone.corners for at in self.cone.edge]
        return [*edge, *((None, sizes) for sizes in (*corners, *self.cone.between))]

    def at(self, place: Place) -> Any:
        """The burn with these forces."""
        azimuth, sizes = place
        craft = self.burning.craft
        thrusters = list(craft.thrusters)
        for n, part, size in zip(self.loose, self.cone.parts, sizes):
            item = thrusters[n]
            if azimuth is None:  # exactly
                larger = 1 + Fraction(size) * (item.force_tolerance or 0) / item.force
                torque = tuple(larger * m for m in item.torque)
            else:
                change = craft.frame.back(tuple(map(Fraction, part.change(azimuth, size).tolist())))
                torque = tuple(m + more for m, more in zip(item.torque, change))
            thrusters[n] = replace(item, torque=torque)
        return replace(self.burning, craft=replace(craft, thrusters=tuple(thrusters)))


def forces_of(burning: Any) -> Forces | None:
    """Of the thrusters of a burn that state a tolerance or a misalignment; None where none does."""
    craft = burning.craft
    loose = tuple(n for n, t in enumerate(craft.thrusters)
                  if t.burn and (t.misalignment or t.force_tolerance))
    if not loose:
        return None
    cone = cone_of_forces(craft, np.zeros(3), [craft.thrusters[n] for n in loose])
    return Forces(burning, cone, loose)


def in_front(forces: Forces, measure: Callable[[Any], float]) -> tuple[list[Any], int]:
    """(the burns with the greatest measure, how many were looked at): round the edge of the cone ever closer
    to the greatest."""
    places = forces.places()
    out = sorted(((-measure(forces.at(location)), n) for n, location in enumerate(places)))
    best, n = out[0]
    chosen = [places[n] for _, n in out[:ANSWERED]]
    azimuth, sizes = places[n]
    if azimuth is None:
        return [forces.at(location) for location in chosen], len(places)
    edge = [(value, places[m][0]) for value, m in out if places[m][0] is not None and places[m][1] == sizes]
    closer = nearest_round(lambda at: -measure(forces.at((at, sizes))), edge)  # type: ignore[arg-type]
    chosen = [(min(closer)[1], sizes), *chosen[1:]]
    return [forces.at(location) for location in chosen], len(places) + len(closer) - len(edge)


def quick_time(chain: Chain, limit: Limit, end: Fraction) -> float:
    """When a burn reaches a limit by one run, no word on its error; inf where it does not by `end`, s."""
    rest = [Piece(chain.closed, end - chain.closed, (), chain.base)] if end > chain.closed else []
    state: Sequence[float] | np.ndarray = np.array(chain.case.state, float)
    for begin, length, _, scene, _ in [*chain.pieces(), *rest]:
        if not limit.angular and begin < end:
            time, _ = run_once(scene, list(state), limit, float(min(length, end - begin)))
            if math.isfinite(time):
                return float(begin) + time
        state = end_of(scene, np.asarray(state), length)
    return math.inf


def over_forces(burning: Any, ask: dict[str, Any], end: Fraction,
                answer: Callable[[Chain], Found]) -> Spread | None:
    """The range of the time at a limit by `end`, s, over all forces; None where all are certain, or the limit
    is of an angle or one that |omega| falls to. answer: the time of one burn, as well as it is known."""
    forces, limit = forces_of(burning), asked(Chain(burning).base, **ask)
    if forces is None or limit.angular or limit.falls:
        return None
    time = lambda item: quick_time(Chain(item), limit, end)
    places = [burning, *(forces.at(location) for location in forces.places())]
    times = [time(item) for item in places]
    printed = Spread(forces.cone.angle, forces.cone.subject, len(places), limit.least_rate(),
                  followed=float(end), within=forces.cone.within)
    if not np.isfinite(times).any():
        return printed
    first, many = _end(forces, time, answer, -1)
    if first is None:
        return printed
    last, more = _end(forces, time, answer, 1) if np.isfinite(times).all() else (None, 0)
    return replace(printed, directions=1 + max(many, more), earliest=(first.low, first.high),
                   latest=None if last is None else (last.low, last.high),
                   level=first.level if last is None or first.level == last.level else "run")


def _end(forces: Forces, time: Callable[[Any], float], answer: Callable[[Chain], Found],
         sign: int) -> tuple[Found | None, int]:
    """(the least (sign -1) or greatest time that is found, None where none is known; of how many forces)."""
    first, many = in_front(forces, lambda item: sign * time(item))
    resolved = [item for item in (answer(Chain(item)) for item in (forces.burning, *first)) if item.time]
    return max(resolved, key=lambda item: sign * item.low, default=None), many
