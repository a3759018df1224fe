"""How far approximate laws hold along a motion of a gyrostat whose attitude is given: its rates, and axis 3
of space in its body, by power series in plain floats. A small command asks for no more of the run, and would
spend its time on loading what compiles a step.
"""
from __future__ import annotations

import math
from collections.abc import Sequence
from operator import mul

from ..numbers.polynomial import golden_section
from ..numbers.vectors import CYCLE
from ..physics.coefficients import content, gyrostat_scene
from ..physics.law_limits import Validity, of_values
from ..physics.scene import AnyScene, QuadraticForm
from .quadratic_series import coefficients, length, summed

ORDER = 20
SHARE = 1e-12  # of the size of the state: the last term of a step
STEPS = 300  # at most, some hundred revolutions: beyond, compiling a step is sooner done
INSIDE = 6  # points a step at which the limits are looked at
NEAR = 0.9  # of the largest value yet: a point so high may stand beside a greater one, which is looked for
FINER = 20  # of the golden section: 7e-5 of the way between two points, and the square of that of the value


def law_along(scene: AnyScene, omega: Sequence[float], gamma: Sequence[float],
              span: tuple[float, float]) -> Validity | None:
    """The validity of a scene along its motion from time 0 to both ends of `span` (s): rates at time 0 in
    rad/s and axis 3 of space, a unit vector, in the frame of the body. None where another way must be taken:
    effects that turn the body otherwise than a wheel and a constant torque do, a motion longer than STEPS or
    too fast for doubles.
    """
    parts = content(scene)
    if parts is None or parts.kind != "gyrostat":
        return None
    form, pieces = gyrostat_scene(parts).quadratic(), []
    for end in (min(span[0], 0.0), max(span[1], 0.0)):
        result = _pieces(form, (*map(float, omega), *gamma), end)
        if result is None:
            return None
        pieces += result
    return of_values(scene, lambda limit: _largest(limit.value, pieces), "along the run")


def _pieces(form: QuadraticForm, x: Sequence[float], end: float) -> list | None:
    """(length, series of the six components) of each step from time 0 to `end`, which may lie before it; None
    where these are too many."""
    t, pieces = 0.0, []
    while t != end:
        series = _series(form, x)
        if len(pieces) == STEPS or not all(math.isfinite(v) for term in series for v in term):
            return None
        step = _length(series)
        h = end - t if step >= abs(end - t) else math.copysign(step, end)
        x, t = [summed(term, h) for term in series], end if h == end - t else t + h
        pieces.append((h, series))
    return pieces


def _series(form: QuadraticForm, x: Sequence[float]) -> list[list[float]]:
    """The coefficients of the powers of time from 0 to ORDER: of three rates, and of a direction n at rest in
    space, n' = n x omega."""
    rates, n = coefficients(form, tuple(x[:3]), ORDER), [[v] for v in x[3:]]
    for power in range(ORDER):
        back = [rate[power::-1] for rate in rates]
        new = [sum(map(mul, n[j], back[k])) - sum(map(mul, n[k], back[j])) for j, k in CYCLE]
        for item, value in zip(n, new):
            item.append(value / (power + 1))
    return rates + n


def _length(series: list[list[float]]) -> float:
    """A length over which the last two terms stay below SHARE of the rates' size and of the direction's."""
    return min(length(part, SHARE * (max(abs(item[0]) for item in part) or max(abs(x[1]) for x in part)))
               for part in (series[:3], series[3:]))


class _State:
    """The blocks of the state at a time within a step, by name; each is formed when it is asked for."""

    def __init__(self, series: list[list[float]], t: float) -> None:
        self.parts, self.t = {"omega": series[:3], "gamma": series[3:]}, t

    def __contains__(self, name: str) -> bool:
        return name in self.parts

    def __getitem__(self, name: str) -> list[float]:
        return [summed(item, self.t) for item in self.parts[name]]


def _largest(value_at, pieces) -> float | None:
    """The largest value of a limit along the pieces; None where it needs a part of the state beside rates
    and direction."""
    best = -math.inf
    for h, series in pieces:
        def at(t, series=series):
            return value_at(_State(series, t))
        values = [at(h * n / INSIDE) for n in range(INSIDE + 1)]
        if None in values:
            return None
        best = max(best, *values)
        for n, value in enumerate(values):
            first, last = max(n - 1, 0), min(n + 1, INSIDE)
            if value >= NEAR * best and value >= max(values[first], values[last]):
                sections = golden_section(lambda t: -at(t), h * first / INSIDE, h * last / INSIDE, FINER)
                best = max(best, *(-size for _, size in sections))
    return best if pieces else None
