"""Fates of states, and of a grid of states.

The fate of every state of an array, whatever the scene: bounded, spin-up, on the separatrix, at rest, or
undecided.

The fates on a rectangular grid of states: one height per line parallel to the torque's axis, then
comparisons.

Along such a line the barrier ahead stays the same and the energy is W^2/2 above the place's, so a state is
bounded iff W^2/2 is less than the height. Lines on which some energy is within rounding of the height, or
near an equilibrium, a fold or an invariant plane, are answered state by state by `fate`.
"""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from ..orbit.fate.result import FateResult
from ..orbit.fate.table import barrier_table, canonical, way_of
from ..orbit.fate.table_kernel import SIGN_BOUND
from ..orbit.result import Fate
from ..physics.coefficients import effective
from ..physics.scene import AnyScene
from ..physics.states import checked_states
from ..validation import scene_and_state
from .digits.ask import ask_all
from .kinds import following, many

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


def fate(scene: Any, states: ArrayLike | None = None, fast: bool | None = None, digits: int | None = None,
         follow: float | None = None,
         tell: Callable[..., Any] | None = None, proof: bool = False) -> FateResult:
    """The fate of every state of an array (..., 3) in the scene's variables (rad/s, or x when scaled).

    scene: Scene or ScaledGyrostat, or a case, whose own start it is where no states are given.
    fast: True for numba's compiled loops, False for NumPy alone, None
    for numba where it is installed and the array is large; the two give the same bytes. Returns a FateResult.
    Raises InputError for arrays of another shape, for non-finite numbers, for scenes with effects that this
    analysis does not cover, and for fast=True without numba. digits (1 to 50): give the margins so many,
    checked, as of `extremes` (the labels have no digits to lose); ToleranceNotMet otherwise. follow: how long
    motions are followed that only a run with a certificate decides (a torque off the principal axes), in the
    scene's time; None for 600,000 steps, some seconds (10,000 of SciPy without heyoka). tell(time, steps,
    motions left) is called on the way. proof: enclose the way of each of these motions, one after another,
    some milliseconds each: `levels` then says "proved" where that succeeds.

    Arrays of `TABLE_FROM` states or more look the barrier up in a table of the scene; smaller ones, and any
    state that is near a tie, a fold or an equilibrium, solve for it. Labels are the same either way; margins
    may differ by 1e-12 of their terms, the kinetic energy and the barrier's height over the state (without a
    torque: both kinetic energies).
    """
    scene, states = scene_and_state(scene, states)
    if digits is not None:
        found = fate(scene, states, fast, follow=follow, tell=tell, proof=proof)
        return replace(found, margins=ask_all("fate", scene, states, digits, found.margins).required().values)
    given, scene, array = scene, effective(scene), checked_states(states)
    found = many(scene).fates(scene, np.ascontiguousarray(array.reshape(-1, 3)), fast,
                              **following(scene, follow, tell, proof))
    columns = {name: getattr(found, name).reshape(array.shape[:-1])
               for name in ("labels", "margins", "axis", "sense", "reasons")}
    return replace(found, **columns, scene=scene, states=array, given=given)


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
