"""The Poincaré section of a motion: the plane that it crosses most, its passages through it by roots of the
Taylor series, and a fan of neighbours.

A section is a plane on which one rate has a value and grows. It maps the plane to itself: a periodic motion
is a fixed point (or comes back after a few passages), a motion on a torus fills a closed curve, one that
leaves scatters.
"""
from __future__ import annotations

import math
from typing import Any

import numpy as np

from .periodic import Section, passage, sampled, sections

LEAST = 5         # passages, for a plane to show anything
ONE_PLACE = 1e-9  # relative size of a set of passages that is one place
ASIDE = 0.05      # of the size of a state: how far the farthest neighbour of a single place is


def crossed(scene: Any, state: Any, until: float = math.inf) -> Section | None:
    """The plane through the middle of a motion that it crosses most, of those that it crosses LEAST times
    before `until` (scene's time); None where there is no such plane."""
    states = sampled(scene, state, until=until)
    if states is None or len(states) < LEAST:
        return None
    return next((one for one in sections(states)
                 if len(returns(scene, state, one, LEAST, until)[0]) == LEAST), None)


def returns(scene: Any, state: Any, section: Section, count: int, until: float = math.inf,
            reach: float = math.inf) -> tuple[np.ndarray, np.ndarray]:
    """(times (n,), places (n, 3)) of the next passages of a section: `count` of them, fewer where the motion
    passes no more before `until` (scene's time), or where a place is farther than `reach` from the origin."""
    times: list[float] = []
    places: list[np.ndarray] = []
    now, x = 0.0, np.array(state, float)
    while len(times) < count and (found := passage(scene, x, section, linear=False)) is not None:
        now, x = now + found[0], found[1]
        if not now <= until or math.hypot(*x) > reach:
            break
        times.append(now)
        places.append(x)
    return np.array(times), np.array(places).reshape(-1, 3)


def neighbours_of(middle: np.ndarray, place: np.ndarray, section: Section, number: int) -> np.ndarray:
    """(number, 3) states on the section along the line from a middle through a place: half of them between
    the two, half up to as far beyond. Where the two are one place, all of them beside it along the first of
    the other rates."""
    way, size = place - middle, float(np.abs(middle).max())
    way[section.axis] = 0.0
    inside, reach = number // 2, 1.0
    if math.hypot(*way) <= ONE_PLACE * size:
        inside, reach = 0, 0.0
        way = ASIDE * size * np.eye(3)[section.across[0]]
    outside = number - inside
    shares = [*(n / (inside + 1) for n in range(1, inside + 1)),
              *(reach + n / outside for n in range(1, outside + 1))]
    return middle + np.array(shares).reshape(-1, 1) * way


def one_place(places: np.ndarray) -> bool:
    """Whether all passages (n, 3) are at the same place: the motion is periodic."""
    return float(np.ptp(places, axis=0).max()) <= ONE_PLACE * float(np.abs(places).max())
