"""What a run over a span shows of a motion, labelled so: extremes, size, energy, and the axis that holds a
growing spin. It proves nothing."""
from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from ..integrate.events import RateRoots, roots_of_rates
from ..integrate.trajectory import integrated
from ..orbit.result import OVER_SPAN, pairs
from ..physics.coefficients import limits_of
from ..physics.scene import Scene
from ..physics.states import equations_and_start, three_numbers
from ..physics.to_numpy import equations_of, to_numpy
from ..reasons import Quantity, Reason, Sentence, Span
from ..validation import reach_of

if TYPE_CHECKING:
    from fractions import Fraction

    from ..numbers.vectors import Float3

# A run that has not shown what is asked after this many steps (seconds of work) gives up and says so.
STEP_BUDGET = 1_000_000
# An axis is called the spin-up's when in this many doublings of the run in a row it keeps its sense and its
# least rate
# grows by this factor, and no other axis does (a spin like the square root of time gives 1.41, a steady
# spin-up 2); in the last
# it exceeds the whole spin of the beginning, which a temporary capture, however slowly its swing dies out,
# never does.
DOUBLINGS, GROWTH = 3, 1.2
# Or when it keeps its sense through the last doubling, ends ten times faster than the whole spin began, and
# holds this
# share of the squared spin throughout.
SHARE, FASTER = 0.9, 10.0


GROWS_ALONE = Sentence(
    "grows-alone", "it alone grows without a change of sign; least rate in the last half of the run {least}")
NO_AXIS_HOLDS = Sentence("no-axis-holds-spin", "no axis holds the spin")()
TOO_FAST = Sentence("extremes-too-fast",
                    "none: the rates change too fast for a search over the span")()
LAW_OVER = Sentence("law-over", "over {over}")
SIZES = Sentence("size-over-span", "over the span the size of its rates went from {first} to {last} (largest "
                 "{largest}), and its energy {trend}")


@dataclass(frozen=True)
class Growth:
    """Axis (1, 2, 3; 0 where unclear) and sense of the growing spin at the end of a run of length `span`."""

    axis: int
    sense: int
    span: float
    reason: Reason
    steps: int


def seen_over(scene, state, span) -> dict:
    """The fields of a Motion from `state` (three numbers) that a run over the span fills; it proves nothing
    beyond it.

    Extremes, ends included, as roots of the rates; |omega| (or |x|) at the start, at the end, and its largest
    value at those roots; kinetic energy at start and end, and whether it "rises", "falls" or "oscillates";
    the largest relative departure from the balance laws.
    """
    state = three_numbers(state)
    roots = _searched(scene, state, reach_of(span))
    run = integrated(scene, state, np.linspace(0, roots.t_reached, 65)[1:] if roots.t_reached else [0.0])
    points = np.vstack([state, run.states])
    energy = np.asarray(to_numpy(equations_of(scene)).invariants(points)["energy"])
    sizes = np.linalg.norm(np.vstack([points, roots.states]), axis=1)
    return {"extremes": pairs(roots.extremes()),
            "over": OVER_SPAN(span=Span(0.0, roots.t_reached, scene.time_unit)),
            "evidence": {"span": roots.t_reached, "size_start": float(sizes[0]),
                         "size_end": float(sizes[len(points) - 1]), "size_largest": float(sizes.max()),
                         "energy_start": float(energy[0]), "energy_end": float(energy[-1]),
                         "energy_trend": _trend(energy), "steps": roots.steps,
                         "invariant_drift": max(run.invariant_drift.values(), default=0.0)}}


def extremes_over(scene: Scene, state: Sequence[float | Fraction], length: float) -> np.ndarray:
    """(3, 2) extremes from `state` (three numbers) over a span of this length; NaN where the run ends before
    the span does."""
    roots = _searched(scene, three_numbers(state), length)
    return np.full((3, 2), np.nan) if roots.reason else roots.extremes()


def _searched(scene: Scene, state: np.ndarray | Sequence[float], length: float) -> RateRoots:
    if not math.isfinite(length) or length == 0:
        raise InputError(f"span: expected a finite length other than 0, got {length!r}")
    return roots_of_rates(scene, state, length)


def _trend(energy: np.ndarray):
    """Whether the energy of the last quarter of the run lies wholly above or below that of the first."""
    quarter = max(1, len(energy) // 4)
    first, last = energy[:quarter], energy[-quarter:]
    return "rises" if last.min() > first.max() else "falls" if last.max() < first.min() else "oscillates"


def growth(scene, state, t_max: float) -> Growth:
    """Run in doubling spans, up to t_max or the step budget, until one axis clearly holds the growing spin.
    """
    here, t, steps, stages = three_numbers(state), 0.0, 0, []
    begin = np.linalg.norm(here) + math.sqrt(max(abs(float(v)) for v in scene.quadratic().m))
    span = min(10 / math.sqrt(max(abs(float(v)) for v in scene.quadratic().m)), t_max)
    while t < t_max and steps < STEP_BUDGET:
        run = integrated(scene, here, np.linspace(0, span, 257)[1:])
        if run.status == "stopped":
            return Growth(0, 0, t, run.reason, steps)
        t, here, steps = t + span, run.states[-1], steps + run.counters["steps"]
        squares = run.states**2
        fraction = (squares / squares.sum(axis=1, keepdims=True)).min(axis=0)
        stages.append((np.sign(run.states).sum(axis=0) / len(run.states), np.abs(run.states).min(axis=0)))
        i = _holder(stages[-DOUBLINGS - 1:], begin) if len(stages) > DOUBLINGS else None
        if i is None and fraction.max() > SHARE and np.abs(here).max() > FASTER * begin:
            i = int(fraction.argmax())
        if i is not None and abs(stages[-1][0][i]) == 1:
            smallest = Quantity(float(stages[-1][1][i]), "" if scene.variables == "scaled" else "rad/s", 4)
            return Growth(i + 1, int(stages[-1][0][i]), t, GROWS_ALONE(least=smallest), steps)
        span = min(t, t_max - t)
    return Growth(0, 0, t, NO_AXIS_HOLDS, steps)


def _holder(stages, begin):
    """The one axis that keeps its sense through the stages while its least rate grows, past `begin`; None
    where it is not one."""
    senses, lower = (np.array(column) for column in zip(*stages))
    held = (np.abs(senses.sum(axis=0)) == len(stages)) & (lower[1:] > GROWTH
                                                          * lower[:-1]).all(axis=0) & (lower[-1] > begin)
    return int(held.argmax()) if held.sum() == 1 else None


def span_needed(scene: Scene) -> InputError:
    """What is said to whoever asks for extremes that are not known for all time, and names no span."""
    return InputError("this scene has no reduction, so its extremes are searched over a time span: give "
                      "span=T "
                      f"({scene.time_unit}), or a span in the case's [motion]")


def sizes(evidence: dict[str, Any], scaled: bool) -> Reason:
    """How the size of the rates and the energy went over the span."""
    first, last, largest = (Quantity(evidence[f"size_{name}"], "" if scaled else "rad/s")
                            for name in ("start", "end", "largest"))
    return SIZES(first=first, last=last, largest=largest, trend=evidence["energy_trend"])


STIFF = 1e5  # fastest decay times span beyond which a search for extremes would take minutes
LONG = 1e7  # fastest turn times span, rad, beyond which it would


def seen_of_blocks(scene: Scene, start: Mapping[str, Float3], span: Sequence[float]) -> dict:
    """Of a motion whose bounds alone are proved: extremes as roots of the rates from the start to the end of
    the span, and how the energy went; empty where the rates change too fast. start: its blocks by name."""
    turning = Scene(scene.body, *(e for e in scene.effects if e.name != "body_force"))
    equations, state = equations_and_start(turning, start)
    system, length = to_numpy(equations), reach_of(span)
    J = system.jacobian(state)
    roots = np.linalg.eigvals(J) * length if np.isfinite(J).all() else np.array([np.inf])
    if abs(roots.real).max() > STIFF or abs(roots).max() > LONG:
        return {"over": TOO_FAST}
    result = roots_of_rates(turning, start, length)
    over = OVER_SPAN(span=Span(0.0, result.t_reached))
    ends = system.invariants(np.vstack([result.start, result.end]))["energy"]
    return {"extremes": tuple((float(a), float(b)) for a, b in result.extremes()),
            "over": over,
            **_validity(turning, result, over),
            "evidence": {"span": result.t_reached, "energy_change": float(ends[1] - ends[0]),
                         "rate_end": [float(v) for v in result.end[:3]], "steps": result.steps,
                         **({"vertical_end": [float(v) for v in result.end[3:6]]}
                            if "gamma" in equations.blocks else {})}}


def _validity(scene: Scene, result: RateRoots, over: Reason) -> dict:
    """Of approximate laws, at every state that the search met: where a rate vanishes, and at both ends."""
    limits = limits_of(scene)
    if limits is None:
        return {}
    return {"validity": limits.along(scene, np.vstack([result.start, result.states, result.end]),
                                     LAW_OVER(over=over))}
