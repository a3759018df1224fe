"""Where functions of the state vanish along a motion: the zeros of a component, or of any function that is
given, as `events` of SciPy's `solve_ivp`."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InputError
from ..integrate.trajectory import Trajectory
from ..numbers.constants import EPS
from ..physics.scene import BLOCKS, AnyScene, slices
from ..physics.states import equations_and_start, moved_row
from ..representation import Shown
from .passage.run import MOVED, WIDER
from .simulate import denser, trajectory

SAMPLES = 16     # of a step of the run: between them a function is looked at for a change of its sign
MOST = 400_000   # samples of a run


@dataclass(frozen=True, eq=False, repr=False)
class Crossings(Shown):
    """Zeros of events along a motion, for each event in its order.

    t: a row (k,) of times an event, in the scene's time; states: (k, N) there; error: (k,) of the times, from
    a second run whose start is moved in its last places, inf where that has not as many zeros; until: the
    time that was reached; status: "reached", "ended" by an event with `terminal`, or "stopped"; reason: how
    they are known, in words.
    """

    t: tuple[np.ndarray, ...]
    states: tuple[np.ndarray, ...]
    error: tuple[np.ndarray, ...]
    until: float
    status: str
    reason: str


def crossings(scene: AnyScene, start: Any, until: float, events: Any) -> Crossings:
    """The zeros of events for 0 < t <= until, of the motion that is at `start` at t = 0 (numbers or blocks,
    as `trajectory` takes them).

    events: the name of a component ("omega3", "gamma1", "x2"), a function of the time and the state (N,), or
    several of these. As for `solve_ivp` a function may have `direction` (above 0: from below only, below 0:
    from above only) and `terminal` (True, or after how many the search ends). Raises InputError for what is
    no event, or gives no finite number.
    """
    equations, state = equations_and_start(scene, start)
    names = (scene.components if equations.blocks == ("omega",) else
             [name for block in equations.blocks for name in BLOCKS[block].components])
    single = isinstance(events, str) or not hasattr(events, "__iter__")
    asked = [_event(one, list(names)) for one in ([events] if single else list(events))]
    if not asked:
        raise InputError(
            "events: expected the name of a component, a function, or several of these; got none")
    times, states, run = _zeros(scene, _blocks(equations, state), until, asked)
    second = _zeros(scene, _blocks(equations, moved_row(state, MOVED)), until, asked)
    error = [WIDER * np.abs(one - two) + 4 * EPS * one if len(one) == len(two)
             else np.full(len(one), math.inf) for one, two in zip(times, second[0])]
    end = float(run.t[-1]) if len(run.t) else 0.0
    ends = [float(row[int(count) - 1]) for event, row in zip(asked, times)
            if (count := getattr(event, "terminal", 0) or 0) and len(row) >= int(count)]
    end = min(ends, default=end)
    within = lambda rows: tuple(row[one <= end] for row, one in zip(rows, times))
    return Crossings(within(times), within(states), within(error), end,
                     "ended" if ends else "reached" if run.status == "reached" else "stopped",
                     f"changes of sign between {SAMPLES} samples of every step of a run ({run.method}), each "
                     "found to rounding; two zeros between neighbouring samples are not seen"
                     + ("" if run.status == "reached" else f"; {run.reason}"))


def _blocks(equations: Any, state: np.ndarray) -> dict[str, np.ndarray]:
    return {name: state[part] for name, part in slices(equations.blocks).items()}


def _event(given: Any, names: list[str]) -> Callable[[float, np.ndarray], Any]:
    if isinstance(given, str):
        if given not in names:
            raise InputError(f"events: there is no component {given!r:.60}; there are {', '.join(names)}")
        at = names.index(given)
        return lambda t, y: y[at]
    if not callable(given):
        raise InputError(
            f"events: expected the name of a component or a function of t and the state, got {given!r:.60}")
    return given


def _value(event: Callable[[float, np.ndarray], Any], t: float, y: np.ndarray) -> float:
    name = getattr(event, "__name__", type(event).__name__)
    try:
        value = float(event(t, y))
    except (TypeError, ValueError) as error:
        raise InputError(f"events: {name} gives no number at t = {t:.6g}: {error}") from None
    if not math.isfinite(value):
        raise InputError(f"events: {name} gives {value} at t = {t:.6g}; expected a finite number")
    return value


def _zeros(scene: AnyScene, start: Any, until: float, events: Sequence[Any]
           ) -> tuple[list[np.ndarray], list[np.ndarray], Trajectory]:
    """(times, states of each event, the run on whose samples they were looked for)."""
    ends: list[float] = []
    trajectory(scene, start, [0.0, until], steps=ends, laws=False)
    knots = np.unique([0.0, until, *(t for t in ends if 0 < t < until)])
    grid = np.unique([*denser(knots, SAMPLES, MOST), until])
    run = trajectory(scene, start, grid, laws=False)
    times, states = [], []
    for event in events:
        values = np.array([_value(event, t, y) for t, y in zip(run.t.tolist(), run.states)])
        found = [_root(scene, run, n, values, event) for n in _places(values, getattr(event, "direction", 0))]
        times.append(np.array([t for t, _ in found]))
        states.append(np.array([y for _, y in found]).reshape(len(found), run.states.shape[1]))
    return times, states, run


def _places(values: np.ndarray, direction: float) -> np.ndarray:
    """The samples before a zero, or before a change of sign; a zero of the start is none."""
    before, after = values[:-1], values[1:]
    hit = (before != 0) & (np.sign(before) != np.sign(after))
    return np.nonzero(hit & ((direction == 0) | (np.sign(before) == -np.sign(direction))))[0]


def _root(scene: AnyScene, run: Trajectory, n: int, values: np.ndarray,
          event: Any) -> tuple[float, np.ndarray]:
    """(time, state) of the zero between samples n and n + 1, by short runs from the first of them."""
    from scipy.optimize import brentq
    if values[n + 1] == 0:
        return float(run.t[n + 1]), run.states[n + 1]
    start = {name: run.states[n, part] for name, part in run.blocks.items()}

    def state(after: float) -> np.ndarray:
        return run.states[n] if after == 0 else trajectory(scene, start, [after], laws=False).states[0]
    step = float(run.t[n + 1] - run.t[n])
    value = lambda s: values[n + 1] if s == step else _value(event, float(run.t[n]) + s, state(s))
    after = float(brentq(value, 0.0, step, xtol=4 * EPS * step, rtol=4 * EPS))
    return float(run.t[n]) + after, state(after)
