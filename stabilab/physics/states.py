"""States, starts and times as the program takes them, checked once: arrays."""
from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..asked import real
from ..errors import InputError, told
from ..numbers.constants import EPS
from .attitude import quaternion
from .blocks import BLOCKS, ORDER, ordered
from .equations import Equations, derive
from .quadratic import rests
from .scene import AnyScene
from .to_numpy import equations_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


def float_array(values: Any, name: str, expected: str = "numbers") -> np.ndarray:
    """The values as an array of doubles; InputError "name: expected ..., got ..." for what has none: no numbers, rows of
    unlike length, larger than any double. What came is written out only then, which takes long of a thousand times."""
    try:
        return np.asarray(real(np.asarray(values), name), float)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{name}: expected {expected}, got {told(values)}") from None


def numbers_in_a_row(values: Any, name: str) -> np.ndarray:
    array = float_array(values, name)
    array = array if array.ndim else array.reshape(1)
    if array.ndim != 1 or not array.size or not np.isfinite(array).all():
        raise InputError(f"{name}: expected finite numbers in one row, got {told(values)}")
    return array


def three_numbers(state: Any, name: str = "state") -> np.ndarray:
    array = numbers_in_a_row(state, name)
    if array.size != 3:
        raise InputError(f"{name}: expected three numbers, got {array.size} of them")
    return array

REST = {"gamma": (0.0, 0.0, 1.0), "attitude": (1.0, 0.0, 0.0, 0.0), "velocity": (0.0,) * 3, "position": (0.0,) * 3}


def equations_and_start(scene: AnyScene, state: Any) -> tuple[Equations, np.ndarray]:
    """(equations, state as one row) of a start given as numbers or block by block."""
    if not isinstance(state, dict):
        equations, array = equations_of(scene), numbers_in_a_row(state, "state")
        wanted = len(equations.state)
        if array.size != wanted:
            words = "three numbers" if wanted == 3 else f"{wanted} numbers ({', '.join(map(str, equations.state))})"
            raise InputError(f"state: expected {words}, got {array.size} of them")
        return equations, array
    unknown = [name for name in state if name not in BLOCKS]
    if unknown or "omega" not in state:
        raise InputError(f"state: expected the block omega and any of {', '.join(ORDER[1:])}; got {', '.join(state) or 'none'}")
    equations = derive(scene, state)
    rows = []
    for name in equations.blocks:
        row = numbers_in_a_row(state.get(name, REST.get(name)), f"state: {name}")
        if row.size != len(BLOCKS[name].components):
            raise InputError(f"state: {name} has {len(BLOCKS[name].components)} components, got {row.size}")
        rows.append(row)
    return equations, np.concatenate(rows)


def checked_times(times: Any) -> np.ndarray:
    array = numbers_in_a_row(times, "times")
    one, following = array[:-1], array[1:]
    if not ((one < following).all() or (one > following).all()):
        raise InputError("times: expected strictly increasing or strictly decreasing times")
    return array


def checked_rtol(rtol: float | None) -> float | None:
    if rtol is not None and not (isinstance(rtol, (int, float)) and 0 < rtol < 1):
        raise InputError(f"rtol: expected a number between 0 and 1, got {rtol!r:.80}")
    return rtol

LAST_PLACE = 2.0**-52


def moved_row(row: ArrayLike, places: float = 1.0) -> np.ndarray:
    """Numbers each moved by about so many units in its last place; a zero by half as many of the largest."""
    row = np.asarray(row, float)
    signs = np.random.default_rng(1).choice([-1.0, 1.0], row.size)
    return row + places * signs * LAST_PLACE * np.where(row == 0, 0.5 * np.abs(row).max(), np.abs(row))

UNDERFLOW = 2.0**-1060  # what four terms may lose that are no normal doubles


def checked_states(states: Any) -> np.ndarray:
    """States as a float array (..., 3); InputError otherwise."""
    array = float_array(states, "states", "numbers in an array of shape (..., 3)")
    if array.ndim < 1 or array.shape[-1] != 3:
        raise InputError(f"states: expected an array of shape (..., 3), got shape {array.shape}")
    if not np.isfinite(array).all():
        raise InputError("states: every component must be finite; at least one is NaN or infinite")
    return array


def equilibrium_mask(scene: AnyScene, states: np.ndarray) -> np.ndarray:
    """(n,) True where every rate of the state vanishes: in doubles to their rounding, then, for the few that pass, exactly."""
    form = scene.quadratic()
    kappa, rho, sigma, m = form.coefficients
    candidate = np.ones(len(states), bool)
    with np.errstate(all="ignore"):
        for i, (j, k) in enumerate(((1, 2), (2, 0), (0, 1))):
            u, v = states[:, j], states[:, k]
            terms = kappa[i] * u * v, rho[i] * v, sigma[i] * u
            rate = terms[0] + terms[1] + terms[2] + m[i]
            size = np.abs(terms[0]) + np.abs(terms[1]) + np.abs(terms[2]) + abs(m[i])
            candidate &= ~(np.abs(rate) > 16 * EPS * size + UNDERFLOW)  # what overflows is a candidate, too
    for index in np.nonzero(candidate)[0]:
        candidate[index] = rests(form, states[index])
    return candidate


def checked_starts(equations: Equations, states: Any) -> np.ndarray:
    wanted = len(equations.state)
    array = float_array(states, "states", f"rows of {wanted} numbers")
    if array.ndim != 2 or array.shape[1] != wanted or not len(array):
        raise InputError(f"states: expected rows of {wanted} numbers ({', '.join(map(str, equations.state))}), got the shape {array.shape}")
    if not np.isfinite(array).all():
        raise InputError(f"states: row {int(np.argmin(np.isfinite(array).all(axis=1)))} is not finite")
    return array


def start_of(scene: AnyScene, omega: Sequence[float], blocks: Mapping[str, Sequence[float]]) -> dict[str, Sequence[float]]:
    """The blocks of the state at time 0 as `trajectory` takes them; attitude from its 3-1-2 angles, or a quaternion with its scalar last."""
    if not isinstance(blocks, Mapping):
        raise InputError(f"blocks: expected blocks of the state by name, such as {{'gamma': (0, 0, 1)}}, got {blocks!r:.80}")
    start = {"omega": omega, **blocks}
    for name in ordered((*scene.blocks, *blocks)):
        if name == "attitude":
            start[name] = _attitude(blocks.get("attitude", (0.0, 0.0, 0.0)))
    return start


def _attitude(given: Sequence[float]) -> tuple[float, ...]:
    """The unit quaternion, scalar first, of three angles, or of four numbers: a quaternion with its scalar last."""
    if not as_quaternion(given):
        return tuple(quaternion(*three_numbers(given, "state: attitude").tolist()))
    x, y, z, w = float_array(given, "state: attitude", "four numbers").tolist()
    length = math.hypot(x, y, z, w)
    if not 0 < length < math.inf:
        raise InputError(f"state: attitude: expected a quaternion that is not zero, got {given!r:.80}")
    return w / length, x / length, y / length, z / length


def as_quaternion(attitude: Sequence[float]) -> bool:
    """Whether an attitude is given, and shown, as a quaternion, not in angles."""
    return hasattr(attitude, "__len__") and len(attitude) == 4
