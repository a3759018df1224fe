"""Amer et al. 2024: what follows from their printed integrals, extremes and the values of these.

Each pair of printed integrals puts the motion on a curve with one parameter s, along which the square of the
rate about the torque's axis is known; the motion stays on the piece around its start where that square is not
negative. Minor axis: (18) and (30). Middle axis: x1^2 - x3^2 = 2N and (71). Middle axis with x1 = x3: (79).
The integrals are not constant along the true motion unless the wheel is still: see the audit."""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

STEP, FAR = 2e-3, 40.0  # of the walk along the curve


class Printed(NamedTuple):
    """A curve: place(s) -> the two components off the torque's axis, square(s) of the third; stationary: the
    s at which one of the two may be extreme inside a piece. invariant, energy: the first and the second
    printed integral at the start (F and G1, N and G2 or G3)."""

    place: Callable[[float], tuple[float, float]]
    square: Callable[[float], float]
    start: float
    stationary: tuple[float, ...]
    invariant: float
    energy: float


def height(radius: float, wheel: float):
    """Function of alpha, x^2/2 plus which is constant by (25): printed with F and b, true with A and b -
    a."""
    return lambda alpha: radius**2 * np.cos(alpha) - 4 * radius * wheel * np.sin(alpha / 2) - 2 * alpha


def minor_axis(x: Sequence[float], a: float, b: float) -> Printed:
    """x1 = F sin s, x2 = F cos s by (18); 2 x3^2 by (30)."""
    F, start = math.hypot(x[0], x[1]), math.atan2(x[0], x[1])
    level = height(F, b)
    G = 2 * x[2] ** 2 + level(2 * start)
    return Printed(lambda s: (F * math.sin(s), F * math.cos(s)), lambda s: (G - level(2 * s)) / 2, start,
                   tuple(n * math.pi / 2 for n in range(-8, 9)), F, G)


def middle_axis(x: Sequence[float], a: float, b: float) -> Printed:
    """x1 = sqrt(2N) cosh s, x3 = sqrt(2N) sinh s; 2 x2^2 by (71), up to where its artanh ends."""
    root = math.sqrt(x[0] ** 2 - x[2] ** 2)
    start = math.atanh(x[2] / x[0])

    def potential(x1: float, x3: float) -> float:
        size = x1 * x1 + x3 * x3
        return size * (1 + 2 * (a + b) / root) - 2 * math.atanh(2 * x1 * x1 * x3 * x3 / size)

    def place(s: float) -> tuple[float, float]:
        return root * math.cosh(s), root * math.sinh(s)

    G = 2 * x[1] ** 2 + potential(x[0], x[2])
    return Printed(place, lambda s: (G - potential(*place(s))) / 2, start, (0.0,), root * root / 2, G)


def middle_axis_equal(x: Sequence[float], a: float, b: float) -> Printed:
    """x1 = x3 = exp(s); x2^2 by (79)."""
    def potential(s: float) -> float:
        return math.exp(2 * s) / 2 + (a + b) * math.exp(s) - s

    start = math.log(x[0])
    G = x[1] ** 2 / 2 + potential(start)
    return Printed(lambda s: (math.exp(s), math.exp(s)), lambda s: 2 * (G - potential(s)), start, (), 0.0, G)


# family of cases -> (its curve, the axis of the torque)
FAMILIES = {"minor-axis": (minor_axis, 2), "middle-axis": (middle_axis, 1),
            "middle-axis-equal": (middle_axis_equal, 1)}


def printed_integrals(family: str, x: Sequence[float], a: float, b: float) -> tuple[float, float]:
    """(F, G1), (N, G2) or (N, G3) by the printed formulas at a start x."""
    curve, _ = FAMILIES[family]
    printed = curve(x, a, b)
    return printed.invariant, printed.energy


def printed_extremes(family: str, x: Sequence[float], a: float,
                     b: float) -> list[tuple[float, float]] | None:
    """((least, greatest),) * 3 by the printed formulas from a start x; None where they leave the motion open
    or end on the way."""
    from scipy.optimize import minimize_scalar
    curve, axis = FAMILIES[family]
    result = curve(x, a, b)
    ends = [_end(result, side) for side in (-1, 1)]
    if None in ends:
        return None
    low, high = ends
    at = [result.place(s) for s in (low, high, *(s for s in result.stationary if low < s < high))]
    greatest = max(-minimize_scalar(lambda s: -result.square(s), bounds=(p, p + (high - low) / 50),
                                    method="bounded", options={"xatol": 1e-12}).fun
                   for p in (low + n * (high - low) / 50 for n in range(50)))
    pairs = [(min(values), max(values)) for values in zip(*at)]
    pairs.insert(axis, (-math.sqrt(greatest), math.sqrt(greatest)))
    return pairs


def _end(result: Printed, side: int) -> float | None:
    """Where the square first vanishes on one side of the start; None where it does not, or is not defined."""
    from scipy.optimize import brentq
    s = result.start
    try:
        while result.square(s + side * STEP) >= 0:
            s += side * STEP
            if abs(s - result.start) > FAR:
                return None
        return brentq(result.square, *sorted((s, s + side * STEP)), xtol=1e-14)
    except (ValueError, OverflowError):
        return None
