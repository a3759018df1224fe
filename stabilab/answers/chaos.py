"""Whether motions are regular or chaotic, as far as they are followed: an indicator with its history, not a
proof."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from ..orbit.result import Fate, Needs
from ..orbit.result import Order as Order
from ..physics.coefficients import effective
from ..physics.scene import AnyScene, hold_on, judge_starts, slices
from ..physics.states import checked_starts, float_array
from ..physics.states import row_of as row_of
from ..physics.to_numpy import equations_of
from ..reasons import Quantity, Reason, Sentence
from ..representation import Answer
from ..unreduced.chaos import TURNS, growth, turn_of
from ..validation import checked_scene
from .motion import motion
from .motions.rows import fates

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

FLAT = 2.5        # MEGNO of a regular motion stays below: it tends to 2, or to less, from either side
STEEP = 4.0       # of a chaotic one has come so far at least ...
DOUBLES = 1.5     # ... and goes on growing, by so much at least while the time doubles

NEVER_BACK = Sentence(
    "chaos-of-spin-up", "it does not come back; chaos is a property of motions that do")()
TOO_STIFF = Sentence(
    "chaos-too-stiff", "stopped, because the motion is too stiff: something in it changes so fast beside its "
    "turn that it would be followed in too short steps")()
OUT_OF_RANGE = Sentence("numbers-out-of-range", "its numbers exceed the range of doubles")()
BETWEEN = Sentence(
    "megno-between", "after {turns} turns MEGNO is {megno}, neither near 2 nor growing with time: follow it "
    "for longer")
GROWS = Sentence(
    "megno-grows", "after {turns} turns MEGNO is {megno} ({half} at half that time): it grows with time, "
    "neighbours part exponentially")
STAYS = Sentence(
    "megno-stays", "after {turns} turns MEGNO is {megno} ({half} at half that time); it tends to 2 on tori, "
    "to less where neighbours stay or come together")
AT_REST_STIFF = Sentence(
    "equilibrium-too-stiff", "it is an equilibrium (every rate stays as it is); its neighbours change too "
    "fast to be followed, so that MEGNO is not known")()
AT_REST = Sentence(
    "megno-of-equilibrium", "it is an equilibrium (every rate stays as it is); whatever becomes of its "
    "neighbours, which MEGNO measures: {megno} after {turns} turns")


@dataclass(frozen=True, eq=False, repr=False)
class Chaos(Answer):
    """labels (...): of `Order`; megno (...): at the last time, nan of motions that spin up or could not be
    followed; times (k,): in the scene's time, each twice the one before; history (..., k): MEGNO at them;
    lyapunov (...): the rate at which neighbours part, per time of the scene, 0 of regular motions and nan
    where it is not known; lyapunov_error (...): how far the last doubling of the time moved it; stiff (...):
    whether a motion was given up since its steps were too short."""

    labels: np.ndarray
    megno: np.ndarray
    times: np.ndarray
    history: np.ndarray
    lyapunov: np.ndarray
    lyapunov_error: np.ndarray
    turn: float
    scene: AnyScene = field(repr=False, compare=False)
    stiff: np.ndarray | bool = False

    @property
    def orders(self) -> list[str]:
        """The word of each label, one after another."""
        return [Order(int(label)).word for label in np.ravel(self.labels)]

    @property
    def reason(self) -> Reason:
        """Of one motion: how the label is known."""
        if np.shape(self.labels):
            raise InputError("because: expected one motion, got several: give one state")
        label, turns = int(self.labels), round(float(self.times[-1] / self.turn))
        if label == Order.SPIN_UP:
            return NEVER_BACK
        if label == Order.UNDECIDED and self.stiff:
            return TOO_STIFF
        megno, half = (Quantity(round(float(v), 3), digits=12) for v in (self.megno, self.history[-2]))
        if label == Order.UNDECIDED:
            return BETWEEN(turns=turns, megno=megno) if np.isfinite(self.megno) else OUT_OF_RANGE
        if label == Order.CHAOTIC:
            return GROWS(turns=turns, megno=megno, half=half)
        if self.megno < FLAT:
            return STAYS(turns=turns, megno=megno, half=half)
        return AT_REST(turns=turns, megno=megno) if np.isfinite(self.megno) else AT_REST_STIFF

    @property
    def because(self) -> str:
        """The same in words."""
        return self.reason.text()


def chaos(scene: AnyScene, states: ArrayLike, until: float | None = None,
          tell: Callable[[int], Any] | None = None) -> Chaos:
    """Whether the motions from states (..., N) of a scene are regular or chaotic: three rates, or all blocks
    of a longer state in order.

    By MEGNO, from variational equations derived from the scene's own (see `unreduced.chaos`), followed until
    a time of the scene (None: a thousand turns of a motion of middling pace). Motions whose fate is spin-up
    are not followed; a state at rest is regular, however fast its neighbours part. Works for every effect. A
    label is what was seen up to that time: "regular" is no proof, the slowest chaos takes longer.
    tell(motions done) is called on the way. Raises InputError for other shapes and numbers.
    """
    checked_scene(scene)
    equations = equations_of(scene)
    array = float_array(states, "states", f"rows of {len(equations.state)} numbers")
    rows = checked_starts(equations, array.reshape(-1, array.shape[-1]) if array.ndim and array.size
                          else array)
    if until is not None and not (isinstance(until, (int, float, np.number))
                                  and 0 < until <= float(np.finfo(float).max)):
        raise InputError(f"until: expected a time above zero, got {until!r:.40}")
    if effective(scene).plain:  # attitude and path follow from the rates, and say nothing of them
        scene, rows = effective(scene), rows[:, :3].copy()
    turn = turn_of(scene, rows)
    end = TURNS * turn if until is None else float(until)
    hold_on(scene, end, "chaos")
    judge_starts(scene, equations.blocks, rows)
    fates = _fates(scene, rows, end)
    leaving = fates == Fate.SPIN_UP
    result = growth(scene, rows[~leaving], end, turn, tell) if not leaving.all() else None
    times = end / 2.0 ** np.arange(5, -1, -1) if result is None else result.times
    history, stiff = np.full((len(rows), len(times)), np.nan), np.zeros(len(rows), bool)
    if result is not None:
        history[~leaving], stiff[~leaving] = result.megno, result.stiff
    before, last = history[:, -2:].T
    flat = (last < FLAT) & (before < FLAT)
    steep = (last > STEEP) & (last > DOUBLES * before)
    labels = np.select([leaving, (fates == Fate.EQUILIBRIUM) | flat, steep],
                       [Order.SPIN_UP, Order.REGULAR, Order.CHAOTIC], Order.UNDECIDED)
    # MEGNO is half the rate times the time, where neighbours part exponentially
    now, change = 2 * last / times[-1], np.abs(2 * last / times[-1] - 2 * before / times[-2])
    rate, error = (np.select([labels == Order.CHAOTIC, labels == Order.REGULAR], [resolved, 0.0], np.nan)
                   for resolved in (now, change))
    shaped = lambda values: values.reshape(array.shape[:-1] + values.shape[1:])[()]
    return Chaos(shaped(labels), shaped(history[:, -1]), times, shaped(history), shaped(rate), shaped(error),
                 turn, scene, shaped(stiff))


def long_enough(scene: AnyScene, state: ArrayLike) -> float:
    """The time that a motion is followed where none is given."""
    return TURNS * turn_of(scene, checked_starts(equations_of(scene), [state]))


def _fates(scene: AnyScene, rows: np.ndarray, end: float) -> np.ndarray:
    """(n,): what becomes of each motion."""
    if scene.plain:
        return np.asarray(fates(scene, rows, follow=end).labels)
    parts = slices(scene.blocks)
    return np.array([motion(scene, {name: row[part].tolist() for name, part in parts.items()},
                            needs=Needs.FATE).fate for row in rows], int)


