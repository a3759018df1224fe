"""Fates, extremes and periods of arrays or grids of states, whatever the scene.

A fate is bounded, spin-up, on the separatrix, at rest, or undecided."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from ..orbit.fate_arrays import FateResult
from ..physics.coefficients import effective
from ..physics.scene import AnyScene
from ..physics.states import checked_states
from ..validation import checked_span, is_case, reach_of, scene_and_state
from .digits import ask_all
from .kinds import following, many

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

def fate(scene: Any, states: ArrayLike | None = None, fast: bool | None = None, digits: int | None = None,
         follow: float | None = None,
         tell: Callable[..., Any] | None = None, proof: bool = False) -> FateResult:
    """The fate of every state of an array (..., 3) in the scene's variables (rad/s, or x when scaled).

    scene: Scene or ScaledGyrostat, or a case, whose own start it is where no states are given.
    Returns a FateResult. Raises InputError for arrays of another shape, for
    non-finite numbers, and for scenes with effects that this analysis does not cover. fast: under a torque
    off the principal axes, whether motions are followed by compiled loops (None: where that is quicker; the
    numbers are the same); needed nowhere else. digits (1 to 50): give the margins so many,
    checked, as of `extremes` (the labels have no digits to lose); ToleranceNotMet otherwise. follow: how long
    motions are followed that only a run with a certificate decides (a torque off the principal axes), in the
    scene's time; None for 600,000 steps, some seconds (10,000 of SciPy without heyoka). tell(time, steps,
    motions left) is called on the way. proof: enclose the way of each of these motions, one after another,
    some milliseconds each: `levels` then says "proved" where that succeeds.

    Margins are good to 1e-12 of their terms, the kinetic energy and the barrier's height over the state
    (without a torque: both kinetic energies).
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


def fate_grid(scene: AnyScene, axes: Sequence[ArrayLike]) -> np.ndarray:
    """Labels (n1, n2, n3), int8 of `Fate`, of the states (axes[0][a], axes[1][b], axes[2][c]); the same as
    `fate` gives.

    scene: Scene or ScaledGyrostat. axes: three arrays of rates (rad/s, or x when scaled), in any order.
    Raises InputError for axes that are not three one-dimensional arrays of finite numbers, and as `fate`
    does.
    """
    scene, axes = effective(scene), _checked_axes(axes)
    labels = np.empty([len(a) for a in axes], np.int8)
    for index, first in enumerate(axes[0]):
        plane = np.empty(labels.shape[1:] + (3,))
        plane[..., 0], plane[..., 1], plane[..., 2] = first, axes[1][:, None], axes[2]
        labels[index] = fate(scene, plane).labels
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


def extremes(scene: Any, states: ArrayLike | None = None, span: Any = None, digits: int | None = None,
             fast: bool | None = None, follow: float | None = None) -> np.ndarray:
    """Smallest and largest value of each component over all t >= 0: array (..., 3, 2) in the scene's
    variables. A case stands for its scene, its own start and span.

    +-inf where a component grows without bound; at an equilibrium both are the state. Scenes without a
    reduction need `span`, a time, or two (from, to): their extremes hold from the start, at time 0, to its
    end. Without it they have bounds for all t >= 0 where spin-up is certified (follow: as of `fate`) and NaN
    elsewhere, InputError where no state has any. digits (1 to 50): reach so many and check them
    (ToleranceNotMet otherwise); without it eleven, by the formulas' own bound. fast: under a torque off the
    axes, as of `fate`; of no effect elsewhere. Raises InputError as `fate` does.
    """
    span = scene.span if span is None and states is None and is_case(scene) else span
    span, (scene, states) = reach_of(checked_span(span)), scene_and_state(scene, states)
    if digits is not None:
        return ask_all("extremes", scene, states, digits, extremes(scene, states, span, follow=follow),
                       span).required().values
    scene, array = effective(scene), checked_states(states)
    rows = np.ascontiguousarray(array.reshape(-1, 3))
    return many(scene).extremes(scene, rows, span, fast,
                                **following(scene, follow)).reshape(array.shape + (2,))


def period(scene: Any, states: ArrayLike | None = None, digits: int | None = None,
           fast: bool | None = None) -> np.ndarray:
    """Period of each motion, (...,) in the scene's time: inf where the motion does not repeat, 0 at an
    equilibrium, NaN where its fate is undecided or no return is found.

    scene, digits, fast: as of `extremes`. Raises InputError as `fate` does, and under a torque off the axes
    follows every motion as `fate` does.
    """
    scene, states = scene_and_state(scene, states)
    if digits is not None:
        return ask_all("period", scene, states, digits, period(scene, states)).required().values
    scene, array = effective(scene), checked_states(states)
    rows = np.ascontiguousarray(array.reshape(-1, 3))
    return many(scene).periods(scene, rows, fast).reshape(array.shape[:-1])
