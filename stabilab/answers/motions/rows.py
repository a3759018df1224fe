"""Fates, extremes and periods of arrays of starts: the compiled and vectorised way to what `motion` finds of
one start.

Starts are doubles, taken at their word; a scene of other effects than wheel and torque is refused by its kind
(`kinds`)."""
from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ...orbit.fate_arrays import FateResult
from ...physics.coefficients import effective
from ...physics.scene import AnyScene
from ...physics.states import checked_states
from ..kinds import following, many


def fates(scene: AnyScene, states: Any, fast: bool | None = None, follow: float | None = None,
          tell: Any = None, proof: bool = False) -> FateResult:
    """The fate of every state of an array (..., 3) in the scene's variables; options: as of `answers.fate`.

    Margins are good to 1e-12 of their terms, the kinetic energy and the barrier's height over the state
    (without a torque: both kinetic energies). Raises InputError for arrays of another shape, for non-finite
    numbers, and for scenes with effects that rows do not have.
    """
    supplied, scene, array = scene, effective(scene), checked_states(states)
    result = many(scene).fates(scene, np.ascontiguousarray(array.reshape(-1, 3)), fast,
                              **following(scene, follow, tell, proof))
    columns = {name: getattr(result, name).reshape(array.shape[:-1])
               for name in ("labels", "margins", "axis", "sense", "reasons")}
    return replace(result, **columns, scene=scene, states=array, given=supplied)


def extremes(scene: AnyScene, states: Any, reach: float | None = None, fast: bool | None = None,
             follow: float | None = None) -> np.ndarray:
    """(..., 3, 2): the least and greatest value of each component over all t >= 0, or until `reach`, a time,
    where the scene has no reduction; InputError where that is needed and not given."""
    scene, array = effective(scene), checked_states(states)
    rows = np.ascontiguousarray(array.reshape(-1, 3))
    return many(scene).extremes(scene, rows, reach, fast,
                                **following(scene, follow)).reshape(array.shape + (2,))


def periods(scene: AnyScene, states: Any, fast: bool | None = None) -> np.ndarray:
    """(...,): inf where a motion does not repeat, 0 at an equilibrium, NaN where its fate is undecided or no
    return is found."""
    scene, array = effective(scene), checked_states(states)
    rows = np.ascontiguousarray(array.reshape(-1, 3))
    return many(scene).periods(scene, rows, fast).reshape(array.shape[:-1])
