"""The extremes and the period of every state of an array are told here, whatever the scene."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..physics.coefficients import effective
from ..physics.states import checked_states
from ..validation import checked_span, is_case, reach_of, scene_and_state
from .digits.ask import ask_all
from .kinds import following, many

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


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
