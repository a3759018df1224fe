"""How a quantity of a family of motions goes as a number grows, and on which side of zero it is: what texts
of papers say of their figures."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np

from ...theories.cavity import polar
from ...theories.follow import follow
from ..families import FAMILIES, SPANS, sweep, with_wheel

GOES = {"rises": lambda change, size: change > size, "falls": lambda change, size: change < -size,
        "stays": lambda change, size: abs(change) <= size}
ROUNDING = 1e-9  # a smaller relative change is none
# paper -> the model that its texts speak of, whose motions are measured
MODELS = {"constant-torque": "exact", "charged": "linear", "cavity": "averaged1", "top": "printed"}


def _slope(t, x):
    return np.polyfit(t, x, 1)


MEASURES = {"amplitude": lambda t, x: np.ptp(x) / 2, "end": lambda t, x: x[-1],
            "size at the end": lambda t, x: abs(x[-1]), "least": lambda t, x: x.min(),
            "growth": lambda t, x: _slope(t, x)[0],
            "amplitude about its growth": lambda t, x: np.ptp(x - np.polyval(_slope(t, x), t)) / 2,
            "turns": lambda t, x: (np.diff(np.sign(np.diff(x))) != 0).sum(),
            "sign changes": lambda t, x: (np.diff(np.sign(x)) != 0).sum(),
            "fall at the end": lambda t, x: x.max() - x[-1]}


def missed(values: Sequence[float], goes: str, within: float = ROUNDING) -> int:
    """How many steps between neighbouring values do not go as the word says; within: of a value, a smaller
    change is none."""
    return sum(not GOES[goes](after - before, within * max(abs(before), abs(after)))
               for before, after in zip(values, values[1:]))


@lru_cache(maxsize=128)
def followed(paper_name, file, variant, model, wheel):
    """The run of a case over the time of its paper's figures; wheel: in place of its own, or None."""
    case, times = sweep(file)[variant], SPANS[paper_name].times
    if wheel is not None:
        case = with_wheel(case, wheel)
    run = follow(case, times, model)
    if paper_name != "cavity" or model != "exact":
        return run
    return replace(run, state=run.state | polar(case.scene, case.state, run.t))


def measured(family: str, part: str, measure: str, axis: int | None = None, only=(), model: str | None = None,
             wheel: float | None = None) -> list[float]:
    """A measure of a part of the state, or of one component of it, for each motion of a family ("charged e")
    over the time of the paper's figures; only: the values that are taken; model: of `theories.follow`, else
    that of MODELS; wheel: gyrostatic moment about axis 3 in place of the cases' own, N m s."""
    paper_name, name = family.split(" ", 1)
    runs = [followed(paper_name, *case, model or MODELS[paper_name], wheel)
            for value, case in FAMILIES[paper_name][name].cases.items() if not only or value in only]
    parts = [np.asarray(run.state[part]) for run in runs]
    return [float(MEASURES[measure](run.t, x[:, axis - 1] if axis else x))
            for run, x in zip(runs, parts)]


def several(value: Any) -> list:
    """What a claim names, as families or components: one or several, or, with None, the part as a whole."""
    return value if isinstance(value, list) else [value]


def of_all(family, part, measure, axis=None, only=(), model=None, wheels=(None,)) -> list[list[float]]:
    """`measured` of each family and component that is named, with each wheel that the text leaves open."""
    return [measured(name, part, measure, item, only, model, wheel)
            for name in several(family) for item in several(axis) for wheel in wheels]


def trend(family, part, measure, goes, axis=None, truth="", only=(), model=None, wheels=(None,),
          within=ROUNDING):
    """Steps of a family, or of several, at which a measure does not go as a claim says; as it goes in truth.
    axis, wheels: as of `of_all`."""
    rows = of_all(family, part, measure, axis, only, model, wheels)
    return tuple(sum(missed(values, word, within) for values in rows) for word in (goes, truth or goes))


def side(family, part, axis, lies, only=(), model=None):
    """How far the least of a component lies on the other side of zero than the word says; than its
    opposite."""
    value = min(measured(family, part, "least", axis, only, model))
    below, above = max(0.0, -value), max(0.0, value)
    return (below, above) if lies == "above" else (above, below)
