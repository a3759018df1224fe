"""How far an approximate law holds along a motion: its dimensionless number, the largest value met, and the
limit.

An effect declares `approximate` and gives its `limits` (`effects.base`). A scene of exact laws has none, and
what stands here is then neither called nor imported.
"""
from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from typing import TYPE_CHECKING, Any, TypeAlias

from ..numbers.vectors import Number
from ..reasons import Quantity, Reason, Sentence, as_reason
from ..validation import checked_scene
from .effects.base import Limit, effect_words
from .scene import AnyScene, slices

if TYPE_CHECKING:
    import numpy as np

States: TypeAlias = Any  # an array (..., N), a sequence of floats, or a dict of blocks
Blocks: TypeAlias = dict[str, tuple[Number, ...]]
BEYOND, WITHIN, OPEN = "BEYOND THE LAW", "within the law", "law not judged"
JUDGED = Sentence("law-judged", "{status}: {effect}: ")
NOT_GIVEN = Sentence("law-needs", "{number}: it needs {needs}, which is not given, limit {limit}")
OVER_AT_MOST = Sentence("law-over-at-most", "over {over} at most")
MEASURED = Sentence("law-measured", "{number}, {value} {over}, limit {limit}")
ROWS = 4096  # of a run that are looked at together


@dataclass(frozen=True)
class Validity:
    """One number of one effect, the most exceeded of the scene (the first declared where none is); `also`:
    its other numbers, the same way.

    value: its largest value over the motion, a float; for several motions an array, one each; None where it
    hangs on a part of the state that was not given. limit: what it must not exceed. holds: whether no number
    of the scene exceeds its limit (an array likewise, which has True too where no known one does; None: no
    known one does, and not all are known). over: where the value was looked for. follows: what a number
    beyond the limit means; source: of the law; needs: what of the state it hangs on.
    """

    effect: str
    number: Reason
    value: float | np.ndarray | None
    limit: float
    holds: bool | np.ndarray | None
    over: Reason
    follows: Reason
    source: str
    needs: str = "a part of the state"
    also: tuple[Validity, ...] = ()

    @property
    def held(self) -> bool:
        """Whether it holds for every motion, as far as it could be judged."""
        return self.holds is None or bool(self.holds if isinstance(self.holds, bool) else self.holds.all())

    @property
    def status(self) -> str:
        """"within the law", "beyond the law" or "law not judged", for all motions together."""
        return self._head.lower()

    @property
    def _head(self) -> str:
        return BEYOND if not self.held else OPEN if self.holds is None else WITHIN

    @property
    def reason(self) -> Reason:
        """Status, effect, number, value, limit, and what follows."""
        result = self._judged(follows=True)
        for item in self.also:
            if not item.held or item.value is None:
                result = result.then(item._measured(True), "; also ")
        return result

    @property
    def brief(self) -> Reason:
        """Status, effect, number, value and limit of the most exceeded alone, without what follows."""
        return self._judged()

    @property
    def words(self) -> str:
        """`reason` in one line, in SI units."""
        return self.reason.text()

    @property
    def short(self) -> str:
        """Status, number, value and limit, without what follows."""
        return f"{self._head}: {self._measured()}"

    @property
    def excess(self) -> float:
        """Its largest value in units of the limit."""
        return _largest(self.value) / self.limit

    def as_dict(self) -> dict[str, Any]:
        """What JSON says of it."""
        named = {name: getattr(self, name) for name in ("status", "effect", "value", "limit", "holds",
                                                        "source")}
        text = {name: getattr(self, name).text() for name in ("number", "follows", "over")}
        return named | text | {"also": [v.as_dict() for v in self.also]}

    def _judged(self, follows: bool = False) -> Reason:
        return JUDGED(status=self._head, effect=effect_words(self.effect)).then(self._measured(follows), "")

    def _measured(self, follows: bool = False) -> Reason:
        """Number, value and limit; follows: also what it means that the limit is exceeded."""
        if self.value is None:
            return NOT_GIVEN(number=self.number, needs=self.needs, limit=Quantity(self.limit))
        largest = _largest(self.value)
        result = MEASURED(number=self.number, value="unbounded" if math.isinf(largest) else
                         Quantity(float(f"{largest:.3g}")), over=self.over, limit=Quantity(self.limit))
        return result.then(self.follows, ": ") if follows and self.excess > 1 else result


def _largest(value: float | np.ndarray | None) -> float:
    if value is None:
        return 0.0
    return value if isinstance(value, float) else float(value.max())


def validity(scene: AnyScene, states: States, over: Reason | str = "at the start") -> Validity | None:
    """How far the approximate laws of a scene hold at states (..., N): the blocks of the scene in order,
    omega alone, or a dict of blocks.

    None where all its laws are exact. States are in rad/s along the principal axes. For arrays `value` and
    `holds` are arrays (...,). over: where the states are, in words. Raises InputError for blocks that the
    scene does not have.
    """
    return _judged(checked_scene(scene), _blocks(scene, states), over, None)


def along(scene: AnyScene, states: States, over: Reason | str, close: bool = False) -> Validity | None:
    """The same over one motion, states (n, N) or a dict of them; over several motions, (k, n, N). close: the
    states of one motion are so close in time that a parabola through three of them has the largest value."""
    return of_values(scene, lambda limit: _value(limit, _blocks(scene, states), -1, close), over)


def of_motion(scene: AnyScene, motion: Any) -> Validity | None:
    """Of a motion that is known by its extremes alone: the corner of its box, which is at least what it
    reaches."""
    if motion.extremes is None:
        return validity(scene, motion.at)
    corner = (max(map(abs, pair)) for pair in motion.extremes)
    return validity(scene, (*corner, *motion.at[3:]), OVER_AT_MOST(over=motion.over))


def at_equilibria(scene: AnyScene, result: Any) -> Validity | None:
    """Of equilibria: at the isolated ones; where there are curves alone, which run to any rate, at rest."""
    if result.points:
        return worst(*(validity(scene, point.at, "at an equilibrium") for point in result.points))
    return validity(scene, (0.0,) * 3,
                    "at rest (it grows with the rate along a curve)" if result.curves else "at rest")


def worst(*result: Validity | None) -> Validity | None:
    """Of several the one that is furthest beyond its limit; None of none."""
    resolved = [v for v in result if v is not None]
    return max(resolved, key=lambda v: v.excess, default=None)


class Watch:
    """The validity of a run that is given its states step by step (`note`), without keeping them. over: where
    they are, in words."""

    def __init__(self, scene: AnyScene, blocks: Sequence[str], over: str = "along the run") -> None:
        self.scene, self.blocks, self.over = scene, blocks, over
        self.rows: list[np.ndarray] = []
        self.count = 0
        self.found: Validity | None = None

    def note(self, rows: np.ndarray) -> None:
        """States of the run (n, N), close to each other in time and to those before."""
        self.rows.append(rows)
        self.count += len(rows)
        if self.count >= ROWS:
            self._look()

    def at(self, rows: np.ndarray) -> None:
        """States of the run (n, N), wherever they are."""
        if len(rows):
            self._judge(rows, False)

    def _look(self) -> None:
        import numpy as np
        rows = np.concatenate(self.rows)
        self.rows, self.count = [rows[-2:]], 2  # neighbours of the next ones
        self._judge(rows, True)

    def _judge(self, rows: np.ndarray, close: bool) -> None:
        visited = {name: rows[:, part] for name, part in slices(self.blocks).items()}
        self.found = larger(self.found, along(self.scene, visited, self.over, close))

    def result(self) -> Validity | None:
        """The largest values of all that was noted."""
        if self.count:
            self._look()
        return self.found


def larger(item: Validity | None, two: Validity | None) -> Validity | None:
    """Number by number the larger of two validities of one scene."""
    if item is None or two is None:
        return item or two
    pairs = {(v.effect, v.number): v for v in (replace(two, also=()), *two.also)}
    best = [max(v, pairs[v.effect, v.number], key=lambda v: -1.0 if v.value is None else v.value)
            for v in (replace(item, also=()), *item.also)]
    return _together(best)


def _blocks(scene: AnyScene, states: States) -> Blocks:
    """Block of the state -> its components, each of the shape of the states without their last axis."""
    if isinstance(states, dict):
        return {name: _components(values) for name, values in states.items()}
    row = _components(states)
    return {name: row[part] for name, part in slices(scene.blocks).items() if part.stop <= len(row)}


def _components(values: np.ndarray | Sequence[float]) -> tuple[Number, ...]:
    """Floats of one state; arrays of several."""
    if not any(hasattr(item, "__len__") for item in values[:1]):  # not by float(), which takes rows of one
        return tuple(map(float, values))
    import numpy as np
    array = np.asarray(values, float)
    return tuple(array[..., i] for i in range(array.shape[-1]))


def _judged(scene: AnyScene, blocks: Blocks, over: Reason | str, axis: int | None) -> Validity | None:
    return of_values(scene, lambda limit: _value(limit, blocks, axis), over)


def of_values(scene: AnyScene, value_of: Callable[[Limit], float | np.ndarray | None],
              over: Reason | str) -> Validity | None:
    """The validity of a scene whose limits have the values that `value_of` tells of each, found over what
    `over` says in words."""
    result, index = [], as_reason(over)
    for effect in scene.approximate:
        for limit in effect.limits(scene):
            value = value_of(limit)
            holds = None if value is None else value <= limit.limit
            result.append(Validity(effect.name, as_reason(limit.number), value, limit.limit, holds, index,
                                   as_reason(limit.follows), limit.source, limit.needs))
    return _together(result)


def _value(limit: Limit, blocks: Blocks, axis: int | None, close: bool = False) -> float | np.ndarray | None:
    """A float, or an array without its axis of times. close: as of `along`."""
    shape = next(iter(blocks.values()))[0]
    if isinstance(shape, float):
        result = limit.value(blocks)
        return None if result is None else math.inf if math.isnan(result) else float(result)
    import numpy as np
    with np.errstate(all="ignore"):  # what overflows is beyond any limit
        result = limit.value(blocks)
        if result is None:
            return None
        values = np.broadcast_to(np.where(np.isnan(result), np.inf, result), shape.shape)
        if axis is not None:
            values = _peak(values) if close else values.max(axis=axis)
    return float(values) if values.ndim == 0 else np.array(values)


def _peak(values: np.ndarray) -> Any:
    """The largest of values (n,) at close times, with what a parabola through the largest and both beside it
    has above: no more than an eighth of the drop to the lower of these."""
    n = int(values.argmax())
    top = values[n]
    if not 0 < n < len(values) - 1:
        return top
    before, after = values[n - 1], values[n + 1]
    bend = 2 * top - before - after
    return top + (after - before)**2 / (8 * bend) if bend > 0 and bend - bend == 0 else top


def _together(result: Sequence[Validity]) -> Validity | None:
    """The most exceeded number first, or, where none is, the first declared; the others beside it."""
    if not result:
        return None
    first = max(result, key=lambda v: (max(v.excess, 1.0), v.value is not None))
    holds = reduce(_both, (v.holds for v in result))
    return replace(first, holds=holds, also=tuple(v for v in result if v is not first))


def _both(item: bool | np.ndarray | None, two: bool | np.ndarray | None) -> bool | np.ndarray | None:
    """Whether both hold; of one that is not known the other decides only where it does not hold."""
    if item is None or two is None:
        info = two if item is None else item
        return (info if info is not None and not (info if isinstance(info, bool) else info.all())
                else None)
    return item & two

