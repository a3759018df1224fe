"""States of a scene as arrays, checked, and the attitude as a rotation: quaternions inside, the 3-1-2
angles psi, phi, theta in and out.

The rotation from body to space is R = Rz(theta) Rx(psi) Ry(phi) (Galal et al., charged body: eq. (30); its
R23 is misprinted). The angles are singular where cos psi = 0: there phi and theta are not determined one by
one."""
from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError, told
from ..numbers.double_double import EPS
from ..validation import real
from .equations import Equations, derive, rotation
from .scene import (
    BLOCKS,
    INSIDE,
    NO_MOTION,
    ORDER,
    AnyScene,
    Scene,
    judge_start,
    judge_starts,
    ordered,
    rests,
)
from .to_numpy import equations_of

if TYPE_CHECKING:
    from fractions import Fraction

    from numpy.typing import ArrayLike


def quaternion(psi: float, phi: float, theta: float) -> np.ndarray:
    """Unit quaternion (4,) from body to space of 3-1-2 angles, rad."""
    (cz, sz), (cx, sx), (cy, sy) = ((np.cos(a / 2), np.sin(a / 2)) for a in (theta, psi, phi))
    a, b, c, d = cz * cx, cz * sx, sz * sx, sz * cx  # Rz Rx
    return np.array([a * cy - c * sy, b * cy - d * sy, a * sy + c * cy, d * cy + b * sy])


def scalar_last(q: ArrayLike) -> np.ndarray:
    """(x, y, z, w) of quaternions (w, x, y, z): (..., 4)."""
    return np.roll(np.asarray(q, float), -1, axis=-1)


def angles(q: ArrayLike) -> np.ndarray:
    """(psi, phi, theta) in (-pi, pi], psi in [-pi/2, pi/2], of quaternions (..., 4): array (..., 3)."""
    r = rotation(np.moveaxis(np.asarray(q, float), -1, 0))
    across = np.hypot(r[2][0], r[2][2])
    return np.stack([np.arctan2(r[2][1], across), np.arctan2(-r[2][0], r[2][2]),
                     np.arctan2(-r[0][1], r[1][1])], axis=-1)


def vertical(result: ArrayLike) -> np.ndarray:
    """Inertial axis 3 in the body (..., 3) at 3-1-2 angles (..., 3), rad: the third row of Rz Rx Ry."""
    psi, phi, _ = np.moveaxis(np.asarray(result, float), -1, 0)
    return np.stack([-np.cos(psi) * np.sin(phi), np.sin(psi), np.cos(psi) * np.cos(phi)], axis=-1)


def beyond(result: ArrayLike) -> np.ndarray:
    """The other 3-1-2 angles (..., 3) of the same attitudes, with cos psi < 0 where `result` has cos psi > 0.
    """
    psi, phi, theta = np.moveaxis(np.asarray(result, float), -1, 0)
    return np.stack([np.pi - psi, phi + np.pi, theta + np.pi], axis=-1)


def to_space(q: ArrayLike, vectors: ArrayLike) -> np.ndarray:
    """Inertial components of body vectors (..., 3) at quaternions (..., 4)."""
    r = rotation(np.moveaxis(np.asarray(q, float), -1, 0))
    v = np.moveaxis(np.asarray(vectors, float), -1, 0)
    return np.stack([sum(a * b for a, b in zip(row, v)) for row in r], axis=-1)


def unwrapped(wrapped: np.ndarray, start: np.ndarray) -> np.ndarray:
    """Angles (n, 3) made continuous from `start` (3,), each step taken the short way round."""
    turns = np.round(np.diff(np.vstack([start, wrapped]), axis=0) / (2 * np.pi))
    return wrapped - 2 * np.pi * np.cumsum(turns, axis=0)


def body_momentum(scene: Scene, state: Mapping[str, np.ndarray]) -> np.ndarray:
    """D omega + momenta carried inside, body frame: (..., 3). state: the blocks (..., 3) by name."""
    omega, motion = state["omega"], SimpleNamespace(**{k: np.moveaxis(v, -1, 0) for k, v in state.items()})
    total = np.asarray(scene.body.inertia) * omega
    for effect in scene.effects:
        values = {name: float(v) for name, v in effect.parameters().items()}
        carried = effect.momentum(values)
        total = total if carried is None else total + np.array(carried)
        part = effect.part(motion, values) if set(effect.needs) <= set(state) else None
        total = total if part is None else total + np.stack(part.momentum, axis=-1)
    return total


# --- States, starts and times as the program takes them, checked once: arrays
def float_array(values: Any, name: str, expected: str = "numbers") -> np.ndarray:
    """The values as an array of doubles; InputError "name: expected ..., got ..." for what has none: no
    numbers, rows of unlike length, larger than any double. What came is written out only then, which takes
    long of a thousand times."""
    try:
        return np.asarray(real(np.asarray(values), name), float)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{name}: expected {expected}, got {told(values)}") from None


FEW = 20


def numbers_in_a_row(values: np.ndarray | Sequence[float | Fraction] | Mapping[str, Any] | None,
                     name: str) -> np.ndarray:
    array = float_array(values, name)
    array = array if array.ndim else array.reshape(1)
    # of a few numbers NumPy's calls take longer than what they do
    if array.ndim != 1 or not array.size or not (
            all(map(math.isfinite, array.tolist())) if array.size < FEW else np.isfinite(array).all()):
        raise InputError(f"{name}: expected finite numbers in one row, got {told(values)}")
    return array


def three_numbers(state: np.ndarray | Sequence[float | Fraction], name: str = "state") -> np.ndarray:
    array = numbers_in_a_row(state, name)
    if array.size != 3:
        raise InputError(f"{name}: expected three numbers, got {array.size} of them")
    return array

REST = {"gamma": (0.0, 0.0, 1.0), "attitude": (1.0, 0.0, 0.0, 0.0), "velocity": (0.0,) * 3,
        "position": (0.0,) * 3} | NO_MOTION


def equations_and_start(
        scene: AnyScene,
        state: np.ndarray | Sequence[float] | Mapping[str, Any]) -> tuple[Equations, np.ndarray]:
    """(equations, state as one row) of a start given as numbers or block by block."""
    if not isinstance(state, dict):
        equations, array = equations_of(scene), numbers_in_a_row(state, "state")
        wanted = len(equations.state)
        if array.size != wanted:
            text = ("three numbers" if wanted == 3
                     else f"{wanted} numbers ({', '.join(map(str, equations.state))})")
            raise InputError(f"state: expected {text}, got {array.size} of them")
        judge_starts(scene, equations.blocks, [array])
        return equations, array
    unknown = [name for name in state if name not in BLOCKS]
    if unknown or "omega" not in state:
        raise InputError(
            f"state: expected the block omega and any of {', '.join(ORDER[1:])}; got "
            f"{', '.join(state) or 'none'}")
    equations = derive(scene, state)
    rows = []
    for name in equations.blocks:
        row = numbers_in_a_row(state.get(name, REST.get(name)), f"state: {name}")
        if row.size != len(BLOCKS[name].components):
            raise InputError(f"state: {name} has {len(BLOCKS[name].components)} components, got {row.size}")
        rows.append(row)
    judge_start(scene, dict(zip(equations.blocks, rows)))
    return equations, np.concatenate(rows)


def checked_times(times: Any) -> np.ndarray:
    array = float_array(times, "times")
    # in a row that rises only the ends may be infinite
    if array.ndim == 1 and array.size and (array[:-1] < array[1:]).all() and (
            math.isfinite(array[0]) and math.isfinite(array[-1])):
        return array
    array = numbers_in_a_row(times, "times")
    item, following = array[:-1], array[1:]
    if not ((item < following).all() or (item > following).all()):
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
    """(n,) True where every rate of the state vanishes: in doubles to their rounding, then, for the few that
    pass, exactly."""
    form = scene.quadratic()
    kappa, rho, sigma, m = form.coefficients
    result, rows, left = np.zeros(len(states), bool), np.arange(len(states)), states
    with np.errstate(all="ignore"):
        # the rate of most terms leaves the fewest for the others
        for i in sorted(range(3), key=lambda i: -sum(map(bool, (kappa[i], rho[i], sigma[i], m[i])))):
            u, v = left[:, i - 2], left[:, i - 1]
            terms = kappa[i] * u * v, rho[i] * v, sigma[i] * u
            rate = terms[0] + terms[1] + terms[2] + m[i]
            size = np.abs(terms[0]) + np.abs(terms[1]) + np.abs(terms[2]) + abs(m[i])
            some = np.nonzero(~(np.abs(rate) > 16 * EPS * size + UNDERFLOW))[0]
            rows, left = rows[some], left[some]  # what overflows is a candidate, too
    for index in rows:
        result[index] = rests(form, states[index])
    return result


def checked_starts(equations: Equations, states: Any) -> np.ndarray:
    """Rows of whole states as an array (n, m); InputError where they are not finite rows of m numbers."""
    wanted = len(equations.state)
    array = float_array(states, "states", f"rows of {wanted} numbers")
    if array.ndim != 2 or array.shape[1] != wanted or not len(array):
        raise InputError(
            f"states: expected rows of {wanted} numbers ({', '.join(map(str, equations.state))}), got the "
            f"shape {array.shape}")
    if not np.isfinite(array).all():
        raise InputError(f"states: row {int(np.argmin(np.isfinite(array).all(axis=1)))} is not finite")
    return array


def start_of(scene: AnyScene, omega: Sequence[float],
             blocks: Mapping[str, Sequence[float]]) -> dict[str, Sequence[float]]:
    """The blocks of the state at time 0 as `trajectory` takes them; attitude from its 3-1-2 angles, or a
    quaternion with its scalar last."""
    if not isinstance(blocks, Mapping):
        raise InputError(
            f"blocks: expected blocks of the state by name, such as {{'gamma': (0, 0, 1)}}, got "
            f"{blocks!r:.80}")
    start = {"omega": omega, **blocks}
    for name in ordered((*scene.blocks, *blocks)):
        if name == "attitude":
            start[name] = _attitude(blocks.get("attitude", (0.0, 0.0, 0.0)))
        elif name in INSIDE:
            start.setdefault(name, REST[name])
    return start


def row_of(scene: AnyScene, state: Sequence[float], blocks: Mapping[str, Sequence[float]]) -> list[float]:
    """All of a state in one row: its three rates, then the other blocks that the scene needs."""
    if scene.variables == "scaled":
        return list(state)
    parts = REST | start_of(scene, state, blocks)
    return [float(value) for name in scene.blocks for value in parts[name]]


def _attitude(supplied: Sequence[float]) -> tuple[float, ...]:
    """The unit quaternion, scalar first, of three angles, or of four numbers: a quaternion with its scalar
    last."""
    if not as_quaternion(supplied):
        return tuple(quaternion(*three_numbers(supplied, "state: attitude").tolist()))
    x, y, z, w = float_array(supplied, "state: attitude", "four numbers").tolist()
    length = math.hypot(x, y, z, w)
    if not 0 < length < math.inf:
        raise InputError(f"state: attitude: expected a quaternion that is not zero, got {supplied!r:.80}")
    return w / length, x / length, y / length, z / length


def as_quaternion(attitude: Sequence[float]) -> bool:
    """Whether an attitude is given, and shown, as a quaternion, not in angles."""
    return hasattr(attitude, "__len__") and len(attitude) == 4
