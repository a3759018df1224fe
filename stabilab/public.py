"""How the public functions are called: each takes a case, the path, text or dict of one, or a scene with
states, and text with a unit ("3 deg/s") wherever it takes a rate or a time."""
from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import wraps
from inspect import BoundArguments, signature
from typing import Any

from .case.read import Case, load
from .errors import InputError
from .numbers.units import ANGLE, LENGTH, MOMENTUM, NONE, RATE, TIME, VELOCITY, Dimension, in_si, split

STARTS = ("state", "states", "omega")  # arguments that are states at time 0
TIMES = ("times", "span", "until", "t_max", "follow", "end")
BLOCKS = {"omega": RATE, "attitude": ANGLE, "velocity": VELOCITY, "position": LENGTH,
          "damper": RATE, "wheel": MOMENTUM}  # of a state in blocks
THEMSELVES = ("equilibria", "fate", "motion", "attitude", "extremes", "period", "simulate")  # take a case
TEXTS = ("when", "sweep", "atlas", "basin", "bifurcation")  # read text with units themselves


def of_any(question: Callable[..., Any]) -> Callable[..., Any]:
    """The function, for whatever a case can be made of. One whose first argument is a case takes a scene with
    `state` and `span` by name; one that takes a scene alone takes the start and the span of a case."""
    takes = signature(question)
    if next(iter(takes.parameters), "") not in ("scene", "case"):
        return question

    @wraps(question)
    def asked(*given: Any, **named: Any) -> Any:
        motion: dict[str, Any] = ({name: named.pop(name) for name in ("state", "span") if name in named}
                  if "case" in takes.parameters else {})
        try:
            bound = takes.bind_partial(*given, **named)
        except TypeError as error:
            raise TypeError(f"{question.__name__}: {error}") from None
        first = next(iter(takes.parameters))
        if first in bound.arguments:
            _resolved(bound, first, motion, question.__name__)
        return question(*bound.args, **bound.kwargs)
    asked.__module__, asked.__qualname__ = __package__, question.__name__  # by which it is pickled
    return asked


def _resolved(bound: BoundArguments, first: str, motion: dict[str, Any], name: str) -> None:
    """Put what the question takes in place of what was given."""
    values, given = bound.arguments, bound.arguments[first]
    scaled = getattr(getattr(given, "scene", given), "variables", "") == "scaled"
    if name not in TEXTS:
        values |= {one: in_numbers(one, value, scaled) for one, value in values.items()}
    if first == "case":
        values[first] = load(given, **{one: in_numbers(one, value, scaled) for one, value in motion.items()})
        return
    if not hasattr(given, "quadratic"):
        values[first] = given = load(given)
    if isinstance(given, Case) and name not in THEMSELVES:
        values[first] = given.scene
        _with_motion(bound, given, name)


def _with_motion(bound: BoundArguments, case: Case, name: str) -> None:
    """The start and the span of a case, for a question that is given neither."""
    start = next((one for one in STARTS if one in bound.signature.parameters), None)
    if start and start not in bound.arguments:
        if case.state is None:
            raise InputError(f"{case.place}: motion: no angular_velocity or x; {name} needs a start")
        bound.arguments[start] = _start(case, name)
    if "times" in bound.signature.parameters and "times" not in bound.arguments and case.span:
        bound.arguments["times"] = case.span


def _start(case: Case, name: str) -> Any:
    """The start of a case in the form that the function of this name takes."""
    from .answers.chaos import row_of
    from .physics.states import start_of
    if name == "spin_up":
        return case.exact_state
    if name == "trajectory" and case.variables == "physical":
        return start_of(case.scene, case.state or (), case.blocks)
    row = row_of(case.scene, case.state or (), case.blocks)
    return [row] if name == "ensemble" else row


def in_numbers(name: str, value: Any, scaled: bool = False) -> Any:
    """The value of the argument `name` with text that has a unit in SI units; all else as it is."""
    if name in TIMES:
        return _numbers(value, NONE if scaled else TIME, name)
    if name not in (*STARTS, "blocks"):
        return value
    if isinstance(value, Mapping):
        return {block: _numbers(one, BLOCKS.get(block, NONE), f"{name}: {block}")
                for block, one in value.items()}
    return _numbers(value, NONE if scaled else RATE, name)


def _numbers(value: Any, wanted: Dimension, name: str) -> Any:
    if isinstance(value, str):
        return float(in_si(value, wanted, name)) if (split(value) or ("", ""))[1] else value
    if hasattr(value, "dtype") and value.dtype.kind == "U":
        value = value.tolist()
    if not isinstance(value, (list, tuple)) or not any(isinstance(one, (str, list, tuple)) for one in value):
        return value
    return [_numbers(one, wanted, name) for one in value]
