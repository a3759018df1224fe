"""Many motions of one scene under a torque of any direction: their spin-up as columns."""
from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from ...asked import checked_scene
from ...numbers.numba_door import wanted
from ...orbit.reduction import reduce
from ...orbit.result import Fate
from ...physics.coefficients import effective
from ...physics.scene import AnyScene
from ...physics.states import checked_states
from ..enclosure.proof import proved
from .chase import Chased, chase
from .fields import natural, tests_of
from .follow import BUDGET, FARTHEST, NATURAL_TIMES, answer_of, kept_by_law, spin_up
from .result import SpinUp
from .symmetric import exactly

COLD = 256  # states from which on numba is loaded unasked, where it is installed
LEVELS = ("undecided", "certified", "exact", "proved")


@dataclass(frozen=True)
class SpinUps:
    """Columns (n,) of what `follow.spin_up` says of each state.

    fate: int8 of `Fate`; axis: 1, 2, 3 or 0; sense: +1, -1 or 0; level: int8, index into LEVELS; t, steps, condition as of `SpinUp`, states (n, 3) at t;
    """

    fate: np.ndarray
    axis: np.ndarray
    sense: np.ndarray
    level: np.ndarray
    t: np.ndarray
    steps: np.ndarray
    condition: np.ndarray
    states: np.ndarray
    scene: AnyScene = field(repr=False)
    unit: float = field(repr=False)
    chased: Chased | None = field(repr=False)
    exact: tuple = field(repr=False)

    def row(self, number: int) -> SpinUp:
        """All that is known of one state: trap, cause, direction."""
        return self.exact[number] if self.chased is None else answer_of(self.scene, self.unit, self.chased, number)


def spin_up_many(scene, states, t_max: float | None = None, budget: int | None = None, tell=None, fast: bool | None = None,
                 proof: bool = False) -> SpinUps:
    """`follow.spin_up` for states (n, 3), in batches; every motion leaves its batch as soon as it is decided. Limits as there.
    fast: as there, None for numba from COLD states on. proof: enclose the way of each that is certified, one after another."""
    states, covered = checked_states(states).reshape(-1, 3), effective(checked_scene(scene))
    covered.quadratic()  # says which effect of the scene is not covered
    own, unit = natural(covered)
    tests = tests_of(own)
    closed = bool(len(states)) and exactly(covered, states[0].tolist()) is not None  # of all states of the scene or of none
    if closed or not tests or not (np.abs(states) / FARTHEST < unit).all():
        return _one_by_one(scene, states, t_max=t_max, budget=budget, fast=fast, proof=proof)
    loops = wanted(len(states), fast, False, COLD, COLD)
    found = chase(own, tests, states / unit, NATURAL_TIMES if t_max is None else t_max * unit, BUDGET if budget is None else budget,
                  tell=tell and (lambda t, steps, left: tell(t / unit, steps, left)), fast=loops)
    good = found.fired >= 0
    axes = np.array([0 if field.axis is None else field.axis + 1 for field, _ in tests.asked] + [0])
    senses = np.array([field.sense for field, _ in tests.asked] + [0])
    out = SpinUps(np.where(good, Fate.SPIN_UP, Fate.UNDECIDED).astype(np.int8), axes[found.fired].astype(np.int8), senses[found.fired].astype(np.int8),
                  good.astype(np.int8), found.t / unit, found.steps, found.condition, found.states * unit, scene, unit, found, ())
    if not good.all() and reduce(covered) is not None:
        return _with_rows(out, tuple(kept_by_law(covered, state, out.row(number)) for number, state in enumerate(states.tolist())))
    return _proved(scene, states, out, loops) if proof else out


def _with_rows(found: SpinUps, rows) -> SpinUps:
    """The answers with these rows in place of what a run found."""
    return replace(found, fate=np.array([row.fate for row in rows], np.int8), level=np.array([LEVELS.index(row.level) for row in rows], np.int8),
                   chased=None, exact=rows)


def _proved(scene, states, found: SpinUps, fast: bool) -> SpinUps:
    rows = tuple(proved(scene, state, found.row(number), fast=fast) for number, state in enumerate(states.tolist()))
    columns = {name: np.array([getattr(row, name) for row in rows]) for name in ("t", "state")}
    return replace(found, level=np.array([LEVELS.index(row.level) for row in rows], np.int8), t=columns["t"], states=columns["state"].reshape(-1, 3),
                   chased=None, exact=rows)


def _one_by_one(scene, states, **limits):
    rows = tuple(spin_up(scene, state, **limits) for state in states.tolist())
    columns = [np.array([getattr(row, name) for row in rows]) for name in ("fate", "axis", "sense")]
    return SpinUps(*(column.astype(np.int8) for column in columns), np.array([LEVELS.index(row.level) for row in rows], np.int8),
                   *(np.array([getattr(row, name) for row in rows]) for name in ("t", "steps", "condition", "state")), scene, 1.0, None, rows)
