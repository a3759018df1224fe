"""The nutation along a run: the angle of a body axis to the angular momentum, which counts that of wheels and
of what moves inside the body."""
from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...case.limit_options import along
from ...case.source import parsed
from ...errors import InputError
from ...numbers.exact import exact_vector, unit_vector
from ...numbers.vectors import Exact3
from ...physics.states import body_momentum
from ..limit import AXES

if TYPE_CHECKING:
    from ...case.read import Case
    from ...physics.scene import Scene

NAMES = tuple("xyz123")  # of body axes: those of the file, and the principal ones


class BodyAxis(NamedTuple):
    """name: as users have it, "z", "-z" or "3"; along: unit vector along the principal axes; number: 1 to 3
    of a principal axis, 0 of another; sense: +1 or -1 of its direction."""

    name: str
    along: Exact3
    number: int = 0
    sense: int = 1


def axis_named(case: Case | None, name: str) -> BodyAxis:
    """The axis of a name, "x", "y", "z" of the file or "1", "2", "3", the principal axes, with "-" before it
    for the opposite direction; case: None of a scene without a file. Raises InputError for another name."""
    letter = name.removeprefix("-") if isinstance(name, str) else ""
    if letter not in NAMES:
        raise InputError("axis: expected x, y, z of the file or 1, 2, 3, the principal axes, got "
                         f"{name!r:.40}")
    sense = -1 if name.startswith("-") else 1
    index = along(case, letter) if case is not None else (NAMES.index(letter) % 3 + 1)
    number, vector = (index, AXES[index - 1]) if isinstance(index, int) else (0, index)
    return BodyAxis(name, tuple(sense * v for v in vector), number, sense)


def axis_at_start(case: Case | None, momentum: np.ndarray) -> BodyAxis:
    """The axis whose nutation a motion is about: the one about which its file states the spin, else the
    principal axis, in its direction, that is nearest to the angular momentum (3,) at the start."""
    if case is not None and case.observed and (stated := _stated(case)) is not None:
        return stated
    n = int(np.argmax(np.abs(momentum)))
    sense = -1 if momentum[n] < 0 else 1
    vector = tuple(Fraction(sense * (i == n)) for i in range(3))
    return BodyAxis("-" * (sense < 0) + NAMES[n + 3], vector, n + 1, sense)


def _stated(case: Case) -> BodyAxis | None:
    """[motion] axis of a case; None where it has none."""
    motion = parsed(case.path, case.text)[0].get("motion", {})
    if "axis" not in motion:
        return None
    exact = exact_vector(motion["axis"], "axis")
    vector = unit_vector(exact if case.frame is None or case.frame.as_given else case.frame.turned(exact))
    place = [n for n, v in enumerate(vector) if v]
    if len(place) > 1:
        return BodyAxis("the axis of the spin", vector)
    sense = 1 if vector[place[0]] > 0 else -1
    return BodyAxis("-" * (sense < 0) + NAMES[place[0] + 3], vector, place[0] + 1, sense)


def between(vectors: np.ndarray, other: np.ndarray) -> np.ndarray:
    """(n,) angles of vectors (n, 3) to others (n, 3) or one (3,), without loss where these are small; NaN to
    a vector that is zero."""
    across, inside = np.linalg.norm(np.cross(vectors, other), axis=-1), np.sum(vectors * other, axis=-1)
    return np.where((across == 0) & (inside == 0), np.nan, np.arctan2(across, inside))


def nutation_of(scene: Scene, state: Mapping[str, np.ndarray], axis: Exact3) -> np.ndarray:
    """(n,) rad, the angle of an axis, a unit vector along the principal axes, to the angular momentum; state:
    the parts of a run by name, its rates and what moves inside the body. NaN where the momentum is zero."""
    return between(body_momentum(scene, state), np.array([float(v) for v in axis]))
