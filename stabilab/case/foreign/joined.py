"""Several bodies on joints, as NASA's simulator 42 places them, as one rigid body: the joints locked where they are.

Of a joint from body i to body o, 42 (InitSpacecraft in 42init.c, MapStateVectorToBodyStates in 42dynamics.c) turns components by
C_oi = C(Go to Bo) C(angles) C(Bi to Gi), each from angles and a sequence, "312" first about axis 3; the origin of o is at
(position wrt inner) + C(Bi to Gi)^T (displacements) - C_oi^T (position wrt outer) from that of i. Angles and displacements beyond
the joint's degrees of freedom count as zero. A body's moments are about its mass centre, or about its origin (REFPT_JOINT).
"""
from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

from ...numbers.exact import precise
from ...numbers.vectors import Exact3, dot

Matrix = tuple[Exact3, ...]
ONE: Matrix = tuple(tuple(Fraction(i == j) for j in range(3)) for i in range(3))
DIGITS = 12  # of the largest number of a vector or a tensor: products of decimals and cosines do not end


class Part(NamedTuple):
    """A body in its own frame. mass, kg; tensor about its mass centre, kg m^2; centre, m, from its origin; momentum of its wheels, N m s."""

    mass: Fraction
    tensor: Matrix
    centre: Exact3
    momentum: Exact3


class Joint(NamedTuple):
    """From body `inner` to `outer`. turn: components of the inner frame to those of the outer; origin: of the outer body in the inner frame, m."""

    inner: int
    outer: int
    turn: Matrix
    origin: Exact3


def turn(angles: Sequence[Fraction], sequence: str) -> Matrix:
    """What turns components by angles in deg about the axes of a sequence such as "312", the first first."""
    found = ONE
    for angle, axis in zip(angles, sequence):
        found = product(_about(int(axis) - 1, angle), found)
    return found


def _about(axis: int, angle: Fraction) -> Matrix:
    j, k, c, s = (axis + 1) % 3, (axis + 2) % 3, _cosine(angle), _cosine(angle - 90)
    rows = [list(row) for row in ONE]
    rows[j][j], rows[j][k], rows[k][j], rows[k][k] = c, s, -s, c
    return tuple(map(tuple, rows))


def _cosine(angle: Fraction) -> Fraction:
    """Of an angle in deg, exact at quarters of a turn."""
    quarters = {0: 1, 90: 0, 180: -1, 270: 0}
    angle %= 360
    return Fraction(quarters[int(angle)]) if angle in quarters else precise("cos", angle * precise("pi") / 180)


def product(a: Matrix, b: Matrix) -> Matrix:
    """a b."""
    return tuple(tuple(dot(row, column) for column in zip(*b)) for row in a)


def times(a: Matrix, v: Sequence[Fraction]) -> Exact3:
    """a v."""
    return tuple(dot(row, v) for row in a)


def turned_back(a: Matrix) -> Matrix:
    """The transpose."""
    return tuple(zip(*a))


def about(mass: Fraction, arm: Exact3) -> Matrix:
    """mass (|arm|^2 I - arm arm^T): what parallel axes add, kg m^2."""
    return tuple(tuple(mass * (dot(arm, arm) * (i == j) - arm[i] * arm[j]) for j in range(3)) for i in range(3))


def added(a: Matrix, b: Matrix, sign: int = 1) -> Matrix:
    """a + sign b."""
    return tuple(tuple(x + sign * y for x, y in zip(p, q)) for p, q in zip(a, b))


def places(joints: Sequence[Joint], count: int) -> dict[int, tuple[Matrix, Exact3]]:
    """Of every body that joints tie to body 0: (what turns components of body 0 to its own, its origin in the frame of body 0)."""
    found: dict[int, tuple[Matrix, Exact3]] = {0: (ONE, (Fraction(0),) * 3)}
    for _ in range(count):  # 42 wants inner bodies first; a tree in any other order is read too
        for joint in joints:
            if joint.inner in found and joint.outer not in found:
                to_inner, at = found[joint.inner]
                arm = times(turned_back(to_inner), joint.origin)
                found[joint.outer] = product(joint.turn, to_inner), tuple(a + b for a, b in zip(at, arm))
    return found


def joined(parts: Sequence[Part], where: dict[int, tuple[Matrix, Exact3]]) -> Part:
    """The parts as one body in the frame of body 0, by parallel axes about their common mass centre. Their masses are positive together."""
    mass, centres = Fraction(sum(part.mass for part in parts)), []
    for index, part in enumerate(parts):
        back, at = turned_back(where[index][0]), where[index][1]
        centres.append(tuple(a + b for a, b in zip(at, times(back, part.centre))))
    centre = tuple(sum(part.mass * c[i] for part, c in zip(parts, centres)) / mass for i in range(3))
    tensor: Matrix = ((Fraction(0),) * 3,) * 3
    momentum: Exact3 = (Fraction(0),) * 3
    for index, part in enumerate(parts):
        to_part = where[index][0]
        own = product(product(turned_back(to_part), part.tensor), to_part)
        tensor = added(tensor, added(own, about(part.mass, tuple(c - o for c, o in zip(centres[index], centre)))))
        momentum = tuple(Fraction(a + b) for a, b in zip(momentum, times(turned_back(to_part), part.momentum)))
    return Part(mass, tensor, centre, momentum)


def decimals(numbers: Sequence[Fraction]) -> list[str]:
    """The numbers to so many digits of the largest of them, as a case file writes them."""
    most = max(map(abs, numbers))
    places = DIGITS - 1 - math.floor(math.log10(most)) if most else 0
    return [f"{float(round(v, places)) + 0.0:.{DIGITS}g}" for v in numbers]
