"""A limit as a command line or [limits] states it: "30 deg/s", "z = 30 deg/s", "5 J", "3 = 20 deg"; exact
numbers in SI, along the scene's axes."""
from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from ..errors import InputError
from ..numbers.units import ANGLE, ENERGY, NONE, RATE, TIME, quantity
from ..numbers.vectors import Exact3

if TYPE_CHECKING:
    from .read import Case

FILE_AXES = "xyz"
OPTIONS = ("rate", "component", "energy", "tilt", "below", "nutation", "nutation_below")


@dataclass(frozen=True)
class StatedLimit:
    """ask: the one argument of `time_to`, by name; kind: that name; names: of
    the quantities, as many as limits, for the reader; limits: in SI; until: the time at which the search
    ends, or None."""

    ask: dict
    kind: str
    names: tuple[str, ...]
    limits: tuple[float, ...]
    until: Fraction | None = None


def stated_limit(case: Case, rate: str | None = None, component: str | None = None, energy: str | None = None,
                 tilt: str | None = None, until: str | None = None,
                 below: str | None = None, nutation: str | None = None,
                 nutation_below: str | None = None) -> StatedLimit:
    """The limit that one of the options states, or [limits] of the case where none is given. Raises
    InputError that names the option."""
    source = {name: text for name, text in zip(OPTIONS, (rate, component, energy, tilt, below, nutation,
                                                        nutation_below)) if text is not None}
    if len(source) > 1:
        raise InputError(
            f"expected one limit, got {' and '.join(map(_option, source))}: ask for each by itself")
    scaled = case.variables == "scaled"
    end = None if until is None else _number(until, NONE if scaled else TIME, "until")
    if not source:
        result = _of_case(case)
    else:
        (name, text), = source.items()
        result = {"rate": _rate, "component": _component, "energy": _energy, "tilt": _tilt, "below": _below,
                  "nutation": _nutation, "nutation_below": _nutation_below,
                  }[name](case, text, NONE if scaled else RATE)
    return StatedLimit(*result, until=end)  # type: ignore[misc]  # all but the last


def stated_tilt(text: str) -> float:
    """The half-angle of --tilt, rad: below a quarter turn. Raises InputError that names the option."""
    angle = float(_number(text, ANGLE, "tilt"))
    if not angle < math.pi / 2:
        raise InputError(f'--tilt: expected an angle below 90 deg, got "{text[:60]}"; a number alone is in '
                         "rad")
    return angle


def angle_of(tilt: object) -> float:
    """The same of what a function is given: text, or a number in rad."""
    return stated_tilt(tilt if isinstance(tilt, str) else str(tilt))


def _of_case(case: Case):
    """The fields of `StatedLimit` but `until` by [limits] of the case; those of an option below."""
    if case.limits is None:
        raise InputError(f'{case.place}: no limit: give --rate "30 deg/s", --component "z = 30 deg/s", '
                         f'--energy "5 J", --tilt or --nutation "z = 20 deg", --below "5 deg/s" or '
                         '--nutation-below "z = 5 deg", or write [limits] rate')
    if case.limits.rate is not None:
        return {"rate": case.limits.rate}, "rate", ("|omega|",), (float(case.limits.rate),)
    pairs = [(along(case, FILE_AXES[n]), rate) for n, rate in enumerate(case.limits.rates)]
    names = tuple(f"|omega {name}|" for name in FILE_AXES)
    return {"component": pairs}, "component", names, tuple(map(float, case.limits.rates))


def _rate(case: Case, text: str, dimension: Sequence[int], kind: str = "rate"):
    limit = _number(text, dimension, kind)
    return {kind: limit}, kind, ("|x|" if dimension is NONE else "|omega|",), (float(limit),)


def _below(case: Case, text: str, dimension: Sequence[int]):
    return _rate(case, text, dimension, "below")


def _component(case: Case, text: str, dimension: Sequence[int]):
    axis, largest = _pair(text, dimension, "component")
    name = f"|{'x' if dimension is NONE else 'omega'} {axis}|"
    return {"component": (along(case, axis), largest)}, "component", (name,), (float(largest),)


def _option(name: str) -> str:
    """As a command line has it."""
    return f"--{name.replace('_', '-')}"


def _nutation(case: Case, text: str, _: Sequence[int], kind: str = "nutation"):
    axis, angle = _pair(text, ANGLE, kind)
    return {kind: (along(case, axis), angle)}, kind, (f"the nutation of axis {axis}",), (float(angle),)


def _nutation_below(case: Case, text: str, _: Sequence[int]):
    return _nutation(case, text, _, "nutation_below")


def _energy(case, text, _):
    largest = _number(text, ENERGY, "energy")
    return {"energy": largest}, "energy", ("the kinetic energy",), (float(largest),)


def _tilt(case, text, _):
    axis, angle = _pair(text, ANGLE, "tilt")
    return {"tilt": (along(case, axis), angle)}, "tilt", (f"the tilt of axis {axis}",), (float(angle),)


def _pair(text: str, dimension: Sequence[int], option: str):
    """(axis, number) of "z = 30 deg/s"."""
    axis, equals, rest = text.partition("=")
    axis = axis.strip().lower()
    if not equals or axis not in (*FILE_AXES, "1", "2", "3"):
        example = "30 deg/s" if option == "component" else "20 deg"
        raise InputError(f'{_option(option)}: expected an axis and its limit, as in "z = {example}" (x, y, z '
                         f'of the file, or 1, 2, 3, the principal axes), '
                         f'got "{text[:60]}"{_meant(text)}')
    return axis, _number(rest, dimension, option, axis)


def _meant(text: str) -> str:
    """"; ..." with the pair that a text means by other words."""
    result = re.fullmatch(r"\W*(?:omega|rate|w|ω|axis)?[\W_]*(?:([xyz123])(?![\d.]))?\|?\s*[<>=:]*\s*"
                         r"(\d.*|\.\d.*)", text.strip(), re.I)
    if not result:
        return ""
    names = (result[1].lower(),) if result[1] else tuple(FILE_AXES)
    return "; write " + " or ".join(f'"{name} = {result[2]}"' for name in names)


def along(case: Case, axis: str) -> int | Exact3:
    """An axis as `time_to` takes it: the number of a principal axis, or three numbers along those."""
    if axis in "123":
        return int(axis)
    number = FILE_AXES.index(axis)
    if case.frame is None or case.frame.as_given:
        return number + 1
    return case.frame.turned([Fraction(int(n == number)) for n in range(3)])


def _no_limit(value: Fraction, text: str, option: str, axis: str) -> str:
    """"; ..." with what to ask in place of a limit that is no size."""
    if option not in OPTIONS:
        return ""
    if value:
        pair = f"{axis} = " if axis else ""
        return f'; a limit is that of a size, of either sign: write "{pair}{text.lstrip("-−")}"'
    if option != "component":
        return ": a size is zero where the motion rests alone"
    number = axis if axis in "123" else str(FILE_AXES.index(axis) + 1)
    return (f'; for the times at which it passes through zero ask from Python, stabilab.load(FILE).when('
            f'events=["omega{number}"], until="10 min"), the rate about principal axis {number}')


def _number(text, dimension, option, axis="") -> Fraction:
    try:
        value, _ = quantity(text.strip(), dimension)
    except InputError as error:
        raise InputError(f"{_option(option)}: {error}") from None
    if value <= 0:
        raise InputError(f"{_option(option)}: expected a positive number, got {text.strip()[:60]}"
                         f"{_no_limit(value, text.strip(), option, axis)}")
    return value
