"""By how much a start, or what takes energy, may change before a spin ends in the other direction."""
from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import partial

import numpy as np

from ...physics.scene import Scene, slices
from .result import FlatSpin, Span
from .spinner import Run, Spinner

SPAN_STEPS = 6_000_000  # of all runs that look for changes of the outcome
HALVINGS = 7  # of an interval with one change of the outcome: it is known to 1 %
RUNS = 12  # for one change, about
WEAKER = 0.5  # of nutation or damping: the least that is tried
FINEST = 2.0**-30  # of the first change tried: a closer one is the second run's


def spans_of(spinner: Spinner, direction: int, found: FlatSpin) -> tuple[Span, ...]:
    """The bands of one outcome about the start, where the motion begins about the minor axis."""
    one, two, three = spinner.inverses
    parts = slices(spinner.scene.blocks)
    omega = spinner.start[parts["omega"]]
    D = np.array(spinner.scene.body.inertia)
    L = D * omega
    i, j, k = spinner.order
    weight = np.sqrt([three - one, three - two])
    across = weight * L[[i, j]]
    room = float(np.sqrt(weight[1] ** 2 * (L @ L) / max(across @ across, 1e-300)))  # times nutation
    if found.crosses is None or room <= 1 or not L[k]:
        return ()
    until = found.crosses.at
    # a stronger sphere must still fit into the body
    stronger = min(1.0, 0.99 * float(spinner.moments[2] / spinner.inside - 1)) if spinner.inside else 1.0

    def moved(angle: float = 0.0, share: float = 0.0) -> np.ndarray:
        """The start turned along its polhode by an angle, its nutation greater by a share."""
        c, s = math.cos(angle), math.sin(angle)
        turn = np.array([[c, -s], [s, c]])
        new, state = L.copy(), spinner.start.copy()
        new[[i, j]] = (1 + share) * (turn @ across) / weight
        new[k] = math.copysign(math.sqrt(max(0.0, L @ L - new[i] ** 2 - new[j] ** 2)), L[k])
        state[parts["omega"]] = new / D
        if "damper" in parts:
            sigma = spinner.start[parts["damper"]].copy()
            sigma[[i, j]] = turn @ sigma[[i, j]]
            state[parts["damper"]] = sigma
        return state

    def flips(state: np.ndarray, scene: Scene | None = None) -> bool:
        other = spinner if scene is None else replace(spinner, scene=scene)
        return side_of(other, state, until) != direction

    steps = found.steps
    tried: list[tuple[str, Callable[[float], bool], float, float]] = [
        ("phase", lambda s: flips(moved(angle=s)), math.pi / 16, math.pi),
        ("nutation", lambda s: flips(moved(share=s)), 0.0, 0.99 * (room - 1)),
        ("damping", lambda s: flips(spinner.start, _stronger(spinner.scene, s)), 0.0, stronger)]
    turns = max(1.0, until * float(np.linalg.norm(omega)) / math.pi)
    spans: list[Span] = []
    for name, flipped, first, most in tried:
        if steps * RUNS * (1 if name == "phase" else 2) > SPAN_STEPS:
            continue
        first = first or min(most, 1.0) / turns
        up = _edge(flipped, first, most)
        down = (math.pi - up if name == "phase"
                else _edge(partial(_reversed, flipped), first, min(most, WEAKER)))
        spans.append(Span(name, down, up))
    return tuple(spans)


def _reversed(flips: Callable[[float], bool], s: float) -> bool:
    return flips(-s)


def _stronger(scene: Scene, share: float) -> Scene:
    """The scene whose damper, inertia and coefficient, or liquid is stronger by a share."""
    more = 1 + Fraction(share)
    damper, liquid, changed = scene.effect("viscous_damper"), scene.effect("liquid_cavity"), []
    if damper is not None:
        changed.append(type(damper)(*(value * more for value in damper.exact)))
    if liquid is not None:
        changed.append(replace(liquid, P0=Fraction(liquid.P0) * more))
    return Scene(scene.body, *changed)


def side_of(spinner: Spinner, state: np.ndarray, until: float) -> int:
    """The side on which a motion is past the separatrix."""
    run, times = Run(spinner, state, None), np.array([1.02 * until])
    for _ in range(60):
        state = run.over(state, times).states[-1]
        if float(spinner.ratios(state)) < spinner.inverses[1]:
            return spinner.direction(state)
        times = times * 0.05 if times[0] > until else times * 1.5
    return 0


def _edge(flips: Callable[[float], bool], first: float, most: float) -> float:
    """The smallest change of which the outcome is another, to 1 %; inf where there is none up to `most`.
    Bands of one outcome are about equally wide, so that doubling the change passes over none."""
    low = high = min(first, most)
    if flips(high):
        while flips(low := high / 2):
            high = low
            if high < FINEST * first:
                return high
    else:
        while not flips(high := min(2 * low, most)):
            if high >= most:
                return math.inf
            low = high
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        low, high = (low, middle) if flips(middle) else (middle, high)
    return (low + high) / 2
