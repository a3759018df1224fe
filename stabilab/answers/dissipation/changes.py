"""By how much the start of a damped spin, or what takes its energy, may change before it ends in the other
direction of its major axis.

Every end is found by runs. A change of the phase turns the transverse angular momentum about the positive
direction of the minor axis, along the polhode of an undamped body. Half a turn of it exchanges the two
directions, so that each has half of all phases, and the two ends about a start are found apart. A change of
any other number shifts the phase at which the separatrix is crossed; how often the angular momentum changed
sides before tells of every such shift, also where two follow closely and the direction is the first again."""
from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from ...numbers.bracket import Bracket, first_bracket, narrowed, side
from ...physics.scene import Scene, slices
from .spinner import Spinner, after_the_separatrix

HALVINGS = 10  # of an interval with one change of the outcome: three digits of its end
RUNS = 24  # for one end, about
WEAKER = 0.5  # of nutation or damping: the least that is tried
FINEST = 2.0**-30  # of the first change tried: a closer one is the second run's
BETWEEN = 6  # places before an end at which the outcome is looked at again


@dataclass(frozen=True)
class Span:
    """How far one number of the start, or of the damper, may go down and up before the outcome is another,
    the others staying; inf: no such change was found.

    name: "phase" (rad: the transverse angular momentum turned about the positive direction of the minor axis,
    along the polhode; the two ends are half a turn apart), "nutation" (relative, of the sine of the nutation
    angle), of a damper "coefficient" (relative, of its coefficient alone), "inertia" (relative, of the moment
    of inertia of its sphere alone, the moments of the whole staying) and "damping" (relative, of both
    together), of a liquid "liquid" (relative, of density P0/viscosity)."""

    name: str
    down: float
    up: float


def spans_of(spinner: Spinner, until: float, steps: int, largest: int) -> tuple[Span, ...]:
    """The bands of one outcome about the start, where the motion begins about the minor axis. until: when it
    crosses the separatrix, s; steps: of a run until then; largest: of all runs for one number."""
    room = _room(spinner)
    if room <= 1 or not spinner.start[spinner.order[2]] or 2 * steps * RUNS > largest:
        return ()
    out = after_the_separatrix(spinner, spinner.start, until)
    turns = max(1.0, until * float(np.linalg.norm(spinner.start[:3])) / math.pi)

    def of_scene(change: Callable[[Scene, Fraction], Scene]) -> Callable[[float], bool]:
        return lambda part: after_the_separatrix(
            replace(spinner, scene=change(spinner.scene, 1 + Fraction(part))), spinner.start, until) != out

    nutation = lambda fraction: after_the_separatrix(spinner, _moved(spinner, 0.0, fraction), until) != out
    tried = [("nutation", nutation, 0.99 * (room - 1))]
    if spinner.inside:
        # a sphere of more inertia must still fit into the body
        fits = min(1.0, 0.99 * float(spinner.moments[2] / spinner.inside - 1))
        tried += [("coefficient", of_scene(lambda scene, times: _damped(scene, 1, times)), 1.0),
                  ("inertia", of_scene(lambda scene, times: _damped(scene, times, 1)), fits),
                  ("damping", of_scene(lambda scene, times: _damped(scene, times, times)), fits)]
    if spinner.scene.effect("liquid_cavity") is not None:
        tried.append(("liquid", of_scene(_filled), 1.0))
    spans = [phase_span(spinner, until)]
    for name, flipped, stronger in tried:
        first = min(stronger, 1.0) / turns
        down, up = _edge(flipped, -first, min(stronger, WEAKER)), _edge(flipped, first, stronger)
        spans.append(Span(name, down, up))
    return tuple(spans)


def phase_span(spinner: Spinner, until: float) -> Span:
    """The band of phases about the start. until: as of `spans_of`."""
    side = after_the_separatrix(spinner, spinner.start, until)[0]
    flips = lambda angle: after_the_separatrix(spinner, _moved(spinner, angle, 0.0), until)[0] != side
    return Span("phase", *(_edge(flips, sign * math.pi / 16, math.pi) for sign in (-1, 1)))


def _across(spinner: Spinner) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(the angular momentum of all that turns with the body (3,), weights (2,) that make circles of polhodes
    about the minor axis, its components along the major and the intermediate axis with these (2,))."""
    item, two, three = spinner.inverses
    L = np.array(spinner.scene.body.inertia) * spinner.start[:3]
    weights = np.sqrt([three - item, three - two])
    return L, weights, weights * L[list(spinner.order[:2])]


def _room(spinner: Spinner) -> float:
    """How many times greater the nutation may be before the separatrix is met, about."""
    L, weights, across = _across(spinner)
    return float(np.sqrt(weights[1] ** 2 * (L @ L) / max(across @ across, 1e-300)))


def _moved(spinner: Spinner, angle: float, fraction: float) -> np.ndarray:
    """The start turned along its polhode by an angle about the minor axis, its nutation greater by a share.
    """
    i, j, k = spinner.order
    L, weights, across = _across(spinner)
    c, s = math.cos(angle), math.sin(angle) * (1 if spinner.right_handed else -1)
    turn = np.array([[c, -s], [s, c]])  # positive from the axis i to j
    new, state, parts = L.copy(), spinner.start.copy(), slices(spinner.scene.blocks)
    new[[i, j]] = (1 + fraction) * (turn @ across) / weights
    new[k] = math.copysign(math.sqrt(max(0.0, L @ L - new[i] ** 2 - new[j] ** 2)), L[k])
    state[:3] = new / spinner.scene.body.inertia
    if "damper" in parts:
        sigma = spinner.start[parts["damper"]].copy()
        sigma[[i, j]] = turn @ sigma[[i, j]]
        state[parts["damper"]] = sigma
    return state


def _damped(scene: Scene, inertia: Fraction | int, coefficient: Fraction | int) -> Scene:
    """The scene with the numbers of its damper multiplied by these."""
    damper: Any = scene.effect("viscous_damper")
    k, c = damper.exact
    changed = type(damper)(k * inertia, c * coefficient)
    return Scene(scene.body, *(changed if item.name == "viscous_damper" else item for item in scene.effects))


def _filled(scene: Scene, times: Fraction) -> Scene:
    """The scene with the torque of its liquid multiplied by this."""
    liquid: Any = scene.effect("liquid_cavity")
    changed = replace(liquid, P0=Fraction(liquid.P0) * times)
    return Scene(scene.body, *(changed if item.name == "liquid_cavity" else item for item in scene.effects))


def _edge(flips: Callable[[float], bool], first: float, largest: float) -> float:
    """The size of the smallest change, of the sign of `first`, of which the outcome is another, to three
    digits; inf where there is none up to `largest`."""
    judge = lambda size: side(not flips(math.copysign(size, first)))
    size = abs(first)
    result = first_bracket(judge, min(size, largest), largest, FINEST * size)
    if result is None or not result.same:
        return math.inf if result is None else float(result.other)
    for n in range(1, BETWEEN):  # a shift to and fro before is none of the two places above
        if judge(location := result.same * n / BETWEEN) < 0:
            result = Bracket(result.same * (n - 1) / BETWEEN, location)
            break
    result = narrowed(judge, result, Fraction(0), steps=HALVINGS)
    return float(result.same + result.other) / 2
