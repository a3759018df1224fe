"""Each analytic model of a case beside its exact motion: how far off it is, and from when on."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..errors import InputError
from ..physics.states import checked_times
from ..representation import Compared, Shown
from ..validation import checked_case
from .follow import follow, models_of
from .theory import theory

GRID = 801  # times over the span on which the error is looked at
ZOOM = 65  # times between two of them, and again between two of those, to place a first error
LEVELS = (0.01, 0.1)
SHARED = ("omega", "gamma", "angles", "momentum", "velocity", "position")


@dataclass(frozen=True, eq=False)
class Departure(Compared):
    """Error of one part of the state under one model.

    error: (n,) largest component's distance from the exact motion, inf where the model has stopped; scale:
    the largest exact component over the span, against which `first` is measured: {0.01: time of the first 1 %
    error or None, 0.1: ...}, a stop being an error of any size; largest: while the model runs.
    """

    model: str
    part: str
    error: np.ndarray
    scale: float
    largest: float
    first: dict


@dataclass(frozen=True, repr=False, eq=False)
class Comparison(Shown, Compared):
    """t: (n,) times; runs: model -> Simulation, the exact one first; departures: one per model and part of
    the state; refused: model -> why it has no answer for this motion; theory: what else the theory says
    (`theory.theory`)."""

    t: np.ndarray
    runs: dict
    departures: tuple[Departure, ...]
    refused: dict
    theory: tuple = ()

    @property
    def validity(self):
        """Of the scene's laws along the exact motion; None where all are exact."""
        return self.runs["exact"].validity


def compare(case: Any, times: ArrayLike | None = None, order: int | None = None) -> Comparison:
    """All models of a case over its span (or at `times` (n,), s, increasing from 0) against the exact motion.

    case: as `stabilab.load` gives it, with a motion; order: of the fast top's expansion.

    The first times of 1 % and 10 % error are bracketed on the grid and refined by evaluating both models in
    between. Raises InputError as `follow` does.
    """
    if order is not None and "lindstedt" not in models_of(checked_case(case).scene):
        raise InputError(
            f"order: belongs to the model \"lindstedt\"; this scene has {', '.join(models_of(case.scene))}")
    if checked_case(case).span is None and times is None:
        raise InputError("compare: the case states no span: give it times")
    times = np.linspace(case.span[0], case.span[1], GRID) if times is None else checked_times(times)
    runs, refused = side_by_side(case, times, order)
    exact, found = runs["exact"], []
    for name, run in list(runs.items())[1:]:
        for part in (p for p in SHARED if p in run.state and p in exact.state):
            found.append(_departure(case, name, part, run, exact, order))
    return Comparison(times, runs, tuple(found), refused, tuple(theory(case, order, end=float(times[-1]))))


def side_by_side(case, times, order: int | None = None) -> tuple[dict, dict]:
    """(model -> Simulation at the times, the exact one first; model -> why it refuses this motion)."""
    runs, refused = {}, {}
    for name in models_of(case.scene):
        try:
            runs[name] = follow(case, times, name, order=order if name == "lindstedt" else None)
        except InputError as error:
            if name == "exact":
                raise
            refused[name] = str(error)
    return runs, refused


def _gap(run, exact, part):
    shown = min(len(run.t), len(exact.t))
    gap = np.full(len(exact.t), np.inf)
    gap[:shown] = np.abs(np.asarray(run.state[part])[:shown]
                         - np.asarray(exact.state[part])[:shown]).max(axis=1)
    return gap


def _departure(case, name, part, run, exact, order):
    error = _gap(run, exact, part)
    scale = float(np.abs(exact.state[part]).max())
    first = {level: _first(case, name, part, exact.t, error, level * scale, order) for level in LEVELS}
    return Departure(name, part, error, scale, float(error[np.isfinite(error)].max(initial=0.0)), first)


def _first(case, name, part, times, error, level, order):
    """The first time at which the error exceeds `level`, or None."""
    over = np.nonzero(~(error <= level))[0]
    if not len(over):
        return None
    for _ in range(2):
        if over[0] == 0:
            break
        times = np.linspace(times[over[0] - 1], times[over[0]], ZOOM)
        run = follow(case, times, name, order=order if name == "lindstedt" else None)
        error = _gap(run, follow(case, times, "exact"), part)
        over = np.nonzero(~(error <= level))[0]
        over = over if len(over) else [ZOOM - 1]  # the model's own rounding at the end of the bracket
    return float(times[over[0]])
