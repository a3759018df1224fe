"""What becomes of motions, of one start and of many: the result of `fate`, of which those of `period` and
`extremes` show one column.

One start is answered as it was written, by `answers.motion`; of many the starts are doubles, answered by the
kernels of `answers.rows` where the kind of scene has them, else one after another, some 3 to 24 ms each."""
from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from ...case.given import started
from ...case.read import Case
from ...errors import Caveat
from ...orbit.fate_arrays import FateResult
from ...orbit.result import Fate, Motion, Needs, without_return
from ...physics.coefficients import effective
from ...representation import Shown, same
from ..caveats import STEADY, caveats_of
from ..motion import with_ending
from . import rows
from .of_case import judged, motion_of_case, with_its_tilt


def margin_of(item: Motion) -> float:
    """The margin in energy as arrays have it."""
    return item.margin if item.margin_energy is None or item.margin == item.margin else item.margin_energy


def period_of(item: Motion) -> float:
    """The period as arrays have it."""
    if item.returns == item.returns:
        return item.returns
    return (item.period if item.period is not None else
            math.nan if item.fate == Fate.BOUNDED else without_return(item.fate))


COLUMNS = ("labels", "margins", "axis", "sense", "reasons")


@dataclass(frozen=True, eq=False, repr=False)
class Motions(Shown):
    """What becomes of the motions from `states` (..., N), all in the case's variables.

    labels: (...,) int8 of `Fate`. margins: (...,) barrier minus energy in the scene's energy (J; or x_i^2/2 +
    U when scaled): positive below the barrier; -inf where there is no barrier ahead, +inf where no separatrix
    bounds the motion, NaN where nothing is known of any (`orbit.fate_arrays.FateResult` has the details).
    axis: 1, 2, 3 of a spin-up, else 0; sense: its sign, else 0. reasons: codes of `orbit.fate.Basis`, -1
    where there is none. level, reason, outcome: in words, a string of one start, an object array of many.
    precise: how many states had to be decided in many digits. caveats: all that limits the answer. fate: of
    one start its `Fate`. case: whose motion it is, of one start with that start. Iterating gives labels,
    margins.
    """

    case: Case
    states: np.ndarray
    options: Mapping[str, Any] = field(default_factory=dict)
    tilt: float | None = None
    tilted: bool = True

    @property
    def shape(self) -> tuple[int, ...]:
        """() of one start."""
        return self.states.shape[:-1]

    @property
    def one(self) -> bool:
        """Whether it is of one start."""
        return self.states.ndim == 1

    def __iter__(self) -> Iterator[np.ndarray]:
        return iter((self.labels, self.margins))

    def __eq__(self, other: object) -> Any:
        if not isinstance(other, Motions):
            return NotImplemented
        names = ("states", *COLUMNS, "level", "reason")
        return all(same(getattr(self, name), getattr(other, name)) for name in names)

    __hash__ = None  # type: ignore[assignment]

    # --- What is worked out, once and when it is needed
    @cached_property
    def kept(self) -> dict[Needs, list[Motion]]:
        """The motions that were worked out, by what was needed of them."""
        return {}

    def motions(self, needs: Needs = Needs.ALL) -> list[Motion]:
        """The motion from each start, one after another; needs: as of `answers.motion`."""
        resolved = next((value for of, value in self.kept.items() if of & needs == needs), None)
        if resolved is None:
            cases = [self.case] if self.one else [
                started(self.case, row) for row in self.states.reshape(-1, self.states.shape[-1])]
            options = {name: value for name, value in self.options.items() if name != "fast"}
            resolved = self.kept[needs] = [motion_of_case(case, needs, **options) for case in cases]
        return resolved

    @cached_property
    def ended(self) -> list[Motion]:
        """The motions, of one start with how it ends where something takes energy from it: a run."""
        resolved = self.motions(Needs.FATE)
        return [with_ending(self.case, resolved[0])] if self.one else resolved

    @property
    def by_rows(self) -> bool:
        """Whether kernels of many starts answer."""
        return not self.one and effective(self.case.scene).plain

    @cached_property
    def rows(self) -> FateResult:
        """The table of the kernels."""
        return rows.fates(self.case.scene, self.states, **self.options)

    def column(self, of: str, one: Callable[[Motion], Any], kind: Any) -> np.ndarray:
        """A column: by rows, or of each motion."""
        if self.by_rows:
            return getattr(self.rows, of)
        return np.array([one(motion) for motion in self.motions(Needs.FATE)], kind).reshape(self.shape)

    # --- Columns
    @property
    def labels(self) -> np.ndarray:
        return self.column("labels", lambda item: item.fate, np.int8)

    @property
    def margins(self) -> np.ndarray:
        return self.column("margins", margin_of, float)

    @property
    def axis(self) -> np.ndarray:
        return self.column("axis", lambda item: item.axis, np.int8)

    @property
    def sense(self) -> np.ndarray:
        return self.column("sense", lambda item: item.sense, np.int8)

    @property
    def reasons(self) -> np.ndarray:
        return self.column("reasons", lambda item: item.code, np.int8)

    @property
    def fate(self) -> Any:
        """`Fate` of one start, an object array of them of many."""
        return self._words([Fate(int(label)) for label in self.labels.reshape(-1)])

    @property
    def outcome(self) -> Any:
        return self._words([Fate(int(label)).word for label in self.labels.reshape(-1)])

    @property
    def level(self) -> Any:
        """How well each fate is known: "exact" (by a law or a closed solution), "certified" (an inequality
        met by a run of machine precision), "proved" (the motion up to it enclosed) or "undecided"."""
        return (self.rows.levels if self.by_rows
                else self._words([item.level for item in self.ended]))

    @property
    def reason(self) -> Any:
        """How it is known, in words."""
        return (self.rows.because if self.by_rows
                else self._words([item.because for item in self.ended]))

    levels, because = level, reason

    def _words(self, text: list[Any]) -> Any:
        if self.one:
            return text[0]
        array = np.empty(len(text), object)
        array[:] = text
        return array.reshape(self.shape)

    @property
    def precise(self) -> int:
        return self.rows.precise if self.by_rows else 0

    @property
    def scene(self) -> Any:
        """The scene, or the gyrostat that turns alike."""
        return effective(self.case.scene)

    @cached_property
    def velocity_margins(self) -> np.ndarray:
        """(...,) smallest change of the state that reaches the separatrix, in the state's unit; inf without
        one, 0 on it, NaN where it is not known."""
        if self.by_rows:
            return self.rows.velocity_margins
        settled = [motion.margin_velocity for motion in self.motions()]
        if self.one and settled[0] is None and self.scene.plain:  # without one, or not known: as rows have it
            return rows.fates(self.case.scene, self.states).velocity_margins
        return np.array([np.nan if item is None else item for item in settled]).reshape(self.shape)[()]

    @property
    def validity(self) -> Any:
        """Of an approximate law (`stabilab.physics.law_limits`); None where all laws are exact."""
        if self.by_rows:
            return self.rows.validity
        return self.judged.validity if self.one else max(
            (motion.validity for motion in self.motions(Needs.FATE) if motion.validity is not None),
            key=lambda item: item.excess, default=None)

    # --- What limits the answer
    @cached_property
    def judged(self) -> Motion:
        """Of one start: the motion with all that limits it; a limit of the case and a tilt of its torque cost
        a tenth of a second."""
        (motion,), case = self.ended, self.case
        result = judged(case, motion) or motion
        return with_its_tilt(case, result, self.tilt) if self.tilted else result

    @cached_property
    def caveats(self) -> tuple[Caveat, ...]:
        """All that limits the answer, as its command says it."""
        if self.one:
            return self.judged.caveats
        steady = bool(np.isin(self.labels, STEADY).any())
        validity = None if self.by_rows else self.validity
        return caveats_of(self.case.scene, steady, validity=validity, file=self.case.caveats)

    def __getitem__(self, location: Any) -> Motions:
        """Those of some of the starts."""
        states = self.states[location]
        case = started(self.case, states) if states.ndim == 1 else self.case
        return replace(self, case=case, states=states)


@dataclass(frozen=True, eq=False, repr=False)
class Values(NDArrayOperatorsMixin, Shown):
    """Numbers of motions, an array (...,) of periods or (..., 3, 2) of extremes, that say how well they are
    known.

    It takes part in arithmetic and indexing as the array `values` of doubles does. name: "period" or
    "extremes"; unit: "s", "rad/s", or "" in scaled variables; decimals: the numbers written out, nested as
    `values`, where more digits were asked for than doubles hold; over: of extremes, over what they were
    searched; answer: the fates of the same motions, whose level, reason and caveats these are; missing: why
    there is no number, where there is none. `str` writes out the decimals.
    """

    name: str
    values: np.ndarray
    answer: Motions
    decimals: Any = None
    over: str = ""
    missing: str = ""

    @property
    def unit(self) -> str:
        if self.answer.case.variables == "scaled":
            return ""
        return "s" if self.name == "period" else "rad/s"

    @property
    def case(self) -> Case:
        return self.answer.case

    @property
    def states(self) -> np.ndarray:
        return self.answer.states

    @property
    def level(self) -> Any:
        return self.answer.level

    @property
    def reason(self) -> Any:
        """Why there is no number, where there is none; else how the fate is known."""
        return self.missing or self.answer.reason

    @property
    def caveats(self) -> tuple[Caveat, ...]:
        return self.answer.caveats

    # --- As an array
    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        if dtype is not None and np.dtype(dtype) != self.values.dtype:
            return self.values.astype(dtype)
        return self.values.copy() if copy else self.values

    def __array_ufunc__(self, ufunc: Callable[..., Any], method: str, *inputs: Any, **options: Any) -> Any:
        plain = [item.values if isinstance(item, Values) else item for item in inputs]
        if "out" in options:
            options["out"] = tuple(x.values if isinstance(x, Values) else x for x in options["out"])
        return getattr(ufunc, method)(*plain, **options)

    @property
    def shape(self) -> tuple[int, ...]:
        return self.values.shape

    @property
    def ndim(self) -> int:
        return self.values.ndim

    @property
    def size(self) -> int:
        return self.values.size

    @property
    def dtype(self) -> Any:
        return self.values.dtype

    @property
    def T(self) -> np.ndarray:
        return self.values.T

    def __len__(self) -> int:
        return len(self.values)

    def __getitem__(self, location: Any) -> Any:
        return self.values[location]

    def __float__(self) -> float:
        return float(self.values)

    def __bool__(self) -> bool:
        return bool(self.values)

    __hash__ = None  # type: ignore[assignment]

    def __format__(self, spec: str) -> str:
        return format(self.values[()], spec) if spec else str(self)

    def __str__(self) -> str:
        if self.decimals is None:
            return str(self.values)
        return self.decimals if isinstance(self.decimals, str) else str(self.decimals)

    def tolist(self) -> Any:
        return self.values.tolist()

    def tobytes(self) -> bytes:
        return self.values.tobytes()

    def reshape(self, *shape: Any) -> np.ndarray:
        return self.values.reshape(*shape)

    def astype(self, kind: Any) -> np.ndarray:
        return self.values.astype(kind)

    def copy(self) -> np.ndarray:
        return self.values.copy()

    def min(self, axis: Any = None) -> Any:
        return self.values.min(axis=axis)

    def max(self, axis: Any = None) -> Any:
        return self.values.max(axis=axis)

    def sum(self, axis: Any = None) -> Any:
        return self.values.sum(axis=axis)
