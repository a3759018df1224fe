"""Fates and margins of arrays as data."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from ...physics.coefficients import limits_of
from ...physics.scene import AnyScene
from ...representation import Compared, Shown
from ..far_states import BEYOND
from ..result import Fate
from ..separatrix.distance import separatrix_distance
from .one_state import REASONS, Reason

CHUNK = 32768  # states at a time: some thirty arrays of so many doubles stay in the processor's caches


@dataclass(frozen=True, repr=False, eq=False)
class FateResult(Shown, Compared):
    """Labels and margins of states (..., 3).

    labels: (...,) int8 of `Fate`. margins: (...,) barrier minus energy in the scene's energy (J; or x_i^2/2 +
    U when scaled): positive below the barrier; -inf where there is no barrier ahead, +inf where no separatrix
    bounds the motion, NaN where nothing is known of any (undecided, and no law keeps the motion from being
    bounded); at an equilibrium on the separatrix 0, and NaN where it is no double (`because` says so).
    Without a torque all motions are bounded, and the barrier is the kinetic energy of a permanent rotation of
    the same momentum that is a saddle, of two the nearer in energy: 0 on a separatrix, > 0 with less energy
    than that (a body turning about its major axis), < 0 with more, whatever the axes are called
    (`free_gyrostat`; in scaled variables, which know no momentum, the reduction about axis 3 has the
    barrier). axis: 1, 2, 3 of a spin-up, else 0; sense: its sign, else 0. reasons: (...,) `Reason` codes.
    precise: how many states had to be decided in many digits. Iterating gives labels, margins.
    """

    labels: np.ndarray
    margins: np.ndarray
    axis: np.ndarray
    sense: np.ndarray
    reasons: np.ndarray
    precise: int = 0
    # of motions that were followed: `row(n)` has all that is known of state n, or None
    followed: Any = field(default=None, repr=False, compare=False)
    scene: AnyScene | None = field(default=None, repr=False, compare=False)
    states: np.ndarray = field(default=None, repr=False, compare=False)
    # the scene asked for, of which `scene` is the twin
    given: AnyScene | None = field(default=None, repr=False, compare=False)

    def __iter__(self):
        return iter((self.labels, self.margins))

    @property
    def outcome(self):
        """The labels in words, "bounded" or "spin-up": a string for one state, an object array otherwise."""
        return np.array([fate.word for fate in Fate], dtype=object)[self.labels]

    @property
    def because(self):
        """The reason in words: a string for one state, an object array otherwise."""
        words = np.array([_told(*one)
                          for one in zip(*map(np.ravel, (self.reasons, self.labels, self.margins)))],
                         dtype=object)
        if self.followed is not None:
            words = np.array([one + _cause(self.followed.row(n)) for n, one in enumerate(words)],
                             dtype=object)
        return words[0] if self.reasons.ndim == 0 else words.reshape(self.reasons.shape)

    @cached_property
    def velocity_margins(self) -> np.ndarray:
        """(...,) smallest change of the state that reaches the separatrix, in the state's unit; inf without
        one, 0 on it; NaN, not known, where the label is undecided, for free gyrostats whose moment has no
        zero component, and for torques off the axes."""
        known = np.where(self.labels == Fate.SEPARATRIX, 0.0, separatrix_distance(self.scene, self.states))
        return np.where(self.labels == Fate.UNDECIDED, np.nan, known)[()]

    @property
    def levels(self):
        """How well each label is known: "exact" (by a law or a closed solution), "certified" (an inequality
        met by a run of machine precision), "proved" (where `fate` was asked for it: the way to the inequality
        enclosed) or "undecided": a string for one state, an object array otherwise."""
        words = ("undecided", "certified", "exact", "proved")
        return np.array(words, dtype=object)[self.level_numbers(words)]

    def level_numbers(self, words: Sequence[str]) -> np.ndarray:
        """The same as the places of these words in a row of them."""
        undecided, certified, exact, proved = map(words.index, ("undecided", "certified", "exact", "proved"))
        found = np.where(self.labels == Fate.UNDECIDED, np.int8(undecided),
                         np.where(self.reasons == Reason.CERTIFIED, np.int8(certified), np.int8(exact)))
        if self.followed is not None:
            found[self.followed.proved.reshape(found.shape)] = proved
        return found

    @cached_property
    def validity(self):
        """Of an approximate law (`stabilab.physics.law_limits`), value and holds (...,): without bound in a
        spin-up, else at the start; None where all laws are exact."""
        limits = limits_of(self.given)
        if limits is None:
            return None
        rows = np.where((self.labels == Fate.SPIN_UP)[..., None], np.inf, self.states)
        return limits.validity(self.given, rows, "along a spin-up, or at the start")


def _cause(row) -> str:
    return "" if row is None else f"; {row.cause}"


def _told(reason, label, margin) -> str:
    known = (margin == margin or reason in (Reason.OFF_AXIS, Reason.TURN_ROUNDS, Reason.CERTIFIED,
                                            Reason.CLOSED_FORM) or label == Fate.EQUILIBRIUM)
    return REASONS[Reason(reason)] + ("" if known else f"; the margin in energy is {BEYOND}")


def empty_columns(n) -> dict[str, np.ndarray]:
    """Columns of a FateResult for n states, to be filled."""
    return {"labels": np.empty(n, np.int8), "margins": np.empty(n), "axis": np.zeros(n, np.int8),
            "sense": np.zeros(n, np.int8), "reasons": np.empty(n, np.int8)}


def chunks(count) -> list[slice]:
    """Slices of so many states, `CHUNK` at a time."""
    return [slice(start, start + CHUNK) for start in range(0, count, CHUNK)]


def in_chunks(label, states) -> FateResult:
    """The fates of states (n, 3) by a labeller: it fills the columns of a chunk and returns how many needed
    many digits."""
    out, precise = empty_columns(len(states)), 0
    for part in chunks(len(states)):
        precise += label(states[part], {name: column[part] for name, column in out.items()})
    return FateResult(**out, precise=precise)  # type: ignore[arg-type]  # the columns alone


def write_row(out, index, label, reason, margin, axis=0, sense=0) -> None:
    """Put the fate of one state into the columns."""
    spin = label == Fate.SPIN_UP
    out["labels"][index], out["reasons"][index], out["margins"][index] = label, reason, margin
    out["axis"][index], out["sense"][index] = axis * spin, sense * spin
