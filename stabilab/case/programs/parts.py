"""Rigid parts of a body in exact numbers: where each is placed, and all of them as one rigid body.

A turn is the matrix C that takes components in one frame to those in another, C = R^T of the rotation R that
takes the axes of the first to those of the second."""
from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from decimal import Decimal, Inexact, localcontext
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from ...numbers.exact import half_unit, precise

# Matrices (3, 3) and vectors (3,) are arrays of Fractions: products of these are exact.
ONE = np.array([[Fraction(i == j) for j in range(3)] for i in range(3)])
# of the largest number of a vector or a tensor: products of decimals and cosines do not end
TENSOR_DIGITS = 12
LONGEST = 40  # digits of a decimal that is written whole


class Part(NamedTuple):
    """A body in its own frame. mass, kg; tensor about its mass centre, kg m^2; centre, m, from its origin;
    momentum of its wheels, N m s."""

    mass: Fraction
    tensor: np.ndarray
    centre: np.ndarray
    momentum: np.ndarray


class Joint(NamedTuple):
    """From body `inner` to `outer`. turn: components of the inner frame to those of the outer; origin: of the
    outer body in the inner frame, m."""

    inner: int
    outer: int
    turn: np.ndarray
    origin: np.ndarray


Places = dict[int, tuple[np.ndarray, np.ndarray]]


def turn(angles: Iterable[Fraction], sequence: str) -> np.ndarray:
    """What turns components by angles in deg about the axes of a sequence such as "312", the first first."""
    result = ONE
    for angle, axis in zip(angles, sequence):
        result = _about(int(axis) - 1, angle) @ result
    return result


def _about(axis: int, angle: Fraction) -> np.ndarray:
    return _of(axis, cosine(angle), cosine(angle - 90))


def _of(axis: int, c: Fraction, s: Fraction) -> np.ndarray:
    j, k = (axis + 1) % 3, (axis + 2) % 3
    result = ONE.copy()
    result[j, j], result[j, k], result[k, j], result[k, k] = c, s, -s, c
    return result


def cosine(angle: Fraction) -> Fraction:
    """Of an angle in deg, exact at quarters of a turn."""
    quarters = {0: 1, 90: 0, 180: -1, 270: 0}
    angle %= 360
    return (Fraction(quarters[int(angle)]) if angle in quarters
            else precise("cos", angle * precise("pi") / 180))


def parallel(mass: Fraction, arm: np.ndarray) -> np.ndarray:
    """mass (|arm|^2 I - arm arm^T): what parallel axes add to a tensor, kg m^2."""
    return mass * (arm @ arm * ONE - np.outer(arm, arm))


def places(joints: Sequence[Joint], count: int) -> Places:
    """Of every body that joints tie to body 0: (what turns components of body 0 to its own, its origin in the
    frame of body 0)."""
    result: Places = {0: (ONE, 0 * ONE[0])}
    for _ in range(count):  # 42 wants inner bodies first; a tree in any other order is read too
        for joint in joints:
            if joint.inner in result and joint.outer not in result:
                to_inner, at = result[joint.inner]
                result[joint.outer] = joint.turn @ to_inner, at + to_inner.T @ joint.origin
    return result


def joined(parts: Sequence[Part], where: Places) -> Part:
    """The parts as one body in the frame of body 0, by parallel axes about their common mass centre. Their
    masses are positive together."""
    turns, origins = zip(*(where[index] for index in range(len(parts))))
    centres = [at + turn.T @ part.centre for part, turn, at in zip(parts, turns, origins)]
    mass = sum((part.mass for part in parts), Fraction(0))
    centre = sum(part.mass * own for part, own in zip(parts, centres)) / mass
    tensor = sum(turn.T @ part.tensor @ turn + parallel(part.mass, own - centre)
                 for part, turn, own in zip(parts, turns, centres))
    return Part(mass, tensor, centre, sum(turn.T @ part.momentum for part, turn in zip(parts, turns)))


def decimals(numbers: Iterable[Fraction]) -> list[str]:
    """The numbers to so many digits of the largest of them, as a case file writes them."""
    numbers = list(numbers)
    largest = max(map(abs, numbers))
    places = TENSOR_DIGITS - 1 - math.floor(math.log10(largest)) if largest else 0
    return [f"{float(round(v, places)) + 0.0:.{TENSOR_DIGITS}g}" for v in numbers]


def as_given(numbers: Iterable[Fraction]) -> list[str]:
    """Decimals of a file as they stand there; those of more digits as `decimals` has them."""
    return [ending_decimal(number) or decimals([number])[0] for number in numbers]


def ending_decimal(value: Fraction) -> str | None:
    """A number as the decimal that it is, None where it ends after more than `LONGEST` digits or never."""
    with localcontext() as context:
        context.prec = LONGEST
        context.traps[Inexact] = True
        try:
            number = (Decimal(value.numerator) / Decimal(value.denominator)).normalize()
        except Inexact:
            return None
    return f"{number:f}" if -6 <= number.adjusted() <= 15 else f"{number:e}".replace("e+", "e")


def rows_of(part: Part, write: Callable[[Iterable[Fraction]], list[str]] = decimals) -> list:
    """The tensor of a part as a case writes it, or its moments where it is diagonal."""
    flat = write(part.tensor.ravel())
    return flat[::4] if not any(float(flat[i]) for i in (1, 2, 5)) else [flat[i:i + 3] for i in (0, 3, 6)]


def turn_of_radians(angles: Iterable[str], sequence: str) -> np.ndarray:
    """The same as `turn` of angles in rad, as they are written. An angle that is a quarter turn to the three
    digits or more that it shows, rounded or cut off, is one, as 1.5708 and 1.57079 are."""
    result = ONE
    for angle, axis in zip(angles, sequence):
        result = _of(int(axis) - 1, *_quarter(angle)) @ result
    return result


def _quarter(text: str) -> tuple[Fraction, Fraction]:
    """(cosine, sine) of an angle in rad."""
    angle, half = Fraction(text), precise("pi") / 2
    count = round(angle / half)
    digits = len(text.lower().partition("e")[0].lstrip("+-0.").replace(".", ""))
    unit = half_unit(text)
    if count and digits >= 3 and unit and -1 <= (abs(count) * half - abs(angle)) / unit < 2:
        cosine = (1, 0, -1, 0)[count % 4]
        return Fraction(cosine), Fraction((0, 1, 0, -1)[count % 4])
    if not angle:
        return Fraction(1), Fraction(0)
    return precise("cos", angle), precise("cos", angle - half)


def of_quaternion(scalar: Fraction, vector: Sequence[Fraction]) -> np.ndarray:
    """What turns components to the frame whose axes a quaternion turns those of the first to; exact, of any
    length but zero."""
    w, (x, y, z) = scalar, vector
    length = x * x + y * y + z * z + w * w
    return np.array([[x*x - y*y - z*z + w*w, 2 * (x*y + z*w), 2 * (x*z - y*w)],
                     [2 * (x*y - z*w), y*y - x*x - z*z + w*w, 2 * (y*z + x*w)],
                     [2 * (x*z + y*w), 2 * (y*z - x*w), z*z - x*x - y*y + w*w]]) / length


def full(xx: Fraction, yy: Fraction, zz: Fraction, xy: Fraction, xz: Fraction, yz: Fraction) -> np.ndarray:
    """The symmetric tensor with these entries."""
    return np.array([(xx, xy, xz), (xy, yy, yz), (xz, yz, zz)])


def is_positive(tensor: np.ndarray) -> bool:
    """Whether all its principal moments are positive, by its leading minors."""
    (a, d, e), (_, b, f), (_, _, c) = tensor
    determinant = a * (b * c - f * f) - d * (d * c - e * f) + e * (d * f - e * b)
    return bool(a > 0 and a * b > d * d and determinant > 0)


def solved(tensor: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """The x of tensor @ x = vector, exactly."""
    across = [np.cross(tensor[(i + 1) % 3], tensor[(i + 2) % 3]) for i in range(3)]
    return sum(vector[i] * across[i] for i in range(3)) / (tensor[0] @ across[0])
