"""The fates on a rectangular grid of states: one height per line parallel to the torque's axis, then
comparisons.

Along such a line the barrier ahead stays the same and the energy is W^2/2 above the place's, so a state is
bounded iff W^2/2 is less than the height. Lines on which some energy is within rounding of the height, or
near an equilibrium, a fold or an invariant plane, are answered state by state by `fate`.
"""
from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from ..orbit.fate.table import barrier_table, canonical, way_of
from ..orbit.fate.table_kernel import SIGN_BOUND
from ..orbit.result import Fate
from ..physics.coefficients import effective
from ..physics.scene import AnyScene
from .fate import fate

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

TOGETHER = 1024  # lines whose states are handed to `fate` at once
LINES = 8192  # lines worked on together: enough for NumPy, few enough for a core's cache


def fate_grid(scene: AnyScene, axes: Sequence[ArrayLike]) -> np.ndarray:
    """Labels (n1, n2, n3), int8 of `Fate`, of the states (axes[0][a], axes[1][b], axes[2][c]); the same as
    `fate` gives.

    scene: Scene or ScaledGyrostat. axes: three arrays of rates (rad/s, or x when scaled), in any order.
    Raises InputError for axes that are not three one-dimensional arrays of finite numbers, and as `fate`
    does.
    """
    scene, axes = effective(scene), _checked_axes(axes)
    labels = np.empty([len(a) for a in axes], np.int8)
    table = barrier_table(scene)
    if table is None or not labels.size:
        return _one_by_one(scene, axes, labels)
    i = table.axes[0]
    first, second = (n for n in range(3) if n != i)
    along = np.moveaxis(labels, i, -1)  # (first, second, i)
    energies = 0.5 * ((axes[i] + table.frame[4]) * table.frame[5]) ** 2
    ranked, rows, asked = np.sort(energies), max(1, LINES // len(axes[second])), []
    for start in range(0, len(axes[first]), rows):
        block = along[start:start + rows]
        lines = np.zeros(block.shape[:2] + (3,))
        lines[..., first], lines[..., second] = axes[first][start:start + rows, None], axes[second]
        doubtful, clear = _label_lines(table, lines.reshape(-1, 3), energies, ranked, block)
        found = np.nonzero((doubtful | ~clear).reshape(block.shape[:2]))
        asked.append(np.stack(found, axis=1) + (start, 0))
    _settle(scene, table, axes, along, np.concatenate(asked))
    return labels


def _checked_axes(axes: Sequence[ArrayLike]) -> list[np.ndarray]:
    try:
        arrays = [np.asarray(a, dtype=float) for a in axes]
    except (TypeError, ValueError, OverflowError):
        raise InputError("axes: expected three arrays of numbers") from None
    if len(arrays) != 3 or any(a.ndim != 1 for a in arrays):
        raise InputError(
            f"axes: expected three one-dimensional arrays, got shapes {[a.shape for a in arrays]}")
    if not all(np.isfinite(a).all() for a in arrays):
        raise InputError("axes: every number must be finite")
    return arrays


def _one_by_one(scene: AnyScene, axes: list[np.ndarray], labels: np.ndarray) -> np.ndarray:
    for index, first in enumerate(axes[0]):
        plane = np.empty(labels.shape[1:] + (3,))
        plane[..., 0], plane[..., 1], plane[..., 2] = first, axes[1][:, None], axes[2]
        labels[index] = fate(scene, plane).labels
    return labels


def _label_lines(table: Any, lines: np.ndarray, energies: np.ndarray, ranked: np.ndarray,
                 labels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Fill labels (rows, m, rates) of the lines through the states `lines` (rows m, 3) by comparison; returns
    (doubtful, clear) of (rows m,): an energy is too near to the height, and it is certain which height that
    is."""
    x, z, _ = canonical(table, lines)
    with np.errstate(all="ignore"):
        height, scale, clear = way_of(table).heights(table, x, z)
        # an energy further from the height than this is beyond the bound of rounding, which grows with it too
        doubt = np.where(np.isfinite(height), 1.5 * SIGN_BOUND * (scale + np.abs(height)), 0.0)
    if way_of(table).spins_up:
        np.greater_equal(energies, height.reshape(labels.shape[:2] + (1,)), out=labels.view(bool))
    else:
        labels[:] = Fate.BOUNDED
    following = np.append(ranked, np.inf)[np.searchsorted(ranked, height - doubt)]
    return (following <= height + doubt) & np.isfinite(height), clear


def _settle(scene: AnyScene, table: Any, axes: list[np.ndarray], along: np.ndarray,
            lines: np.ndarray) -> None:
    """Ask `fate` for every state of some lines ((a, b) pairs of indices across the torque's axis)."""
    i = table.axes[0]
    first, second = (n for n in range(3) if n != i)
    for start in range(0, len(lines), TOGETHER):
        a, b = lines[start:start + TOGETHER].T
        states = np.empty((len(a), len(axes[i]), 3))
        states[..., first], states[...,
                                   second], states[...,
                                                   i] = axes[first][a, None], axes[second][b, None], axes[i]
        along[a, b] = fate(scene, states).labels
