"""The fate of every state of an array, whatever the scene: bounded, spin-up, on the separatrix, at rest, or
undecided."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..asked import scene_and_state
from ..orbit.fate.result import FateResult
from ..physics.coefficients import effective
from ..physics.states import checked_states
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
