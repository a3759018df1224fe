"""Effects that stop acting some time: when, and the scene that is left."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ..errors import InputError
from .scene import AnyScene, Scene, slices


def time_left(scene: AnyScene, state: Mapping[str, Any]) -> float | None:
    """For how long all effects of a scene still act, s, from a state in blocks on; None where they do for
    ever."""
    found = [effect.stops_after(state) for effect in scene.ending]
    return min((max(left, 0.0) for left in found if left is not None), default=None)


def stops_before(scene: AnyScene, blocks: Sequence[str], rows: Any, end: float) -> float | None:
    """The time after which an effect stops acting on one of the motions from rows of these blocks, where
    that is before `end`; None where there is none."""
    parts = slices(blocks)
    found = [time_left(scene, {name: row[part] for name, part in parts.items()})
             for row in (rows if scene.ending else ())]
    return min((left for left in found if left is not None and left < end), default=None)


def hold_on(scene: AnyScene, blocks: Sequence[str], rows: Any, end: float, question: str) -> None:
    """Raise InputError where an effect stops acting on one of these motions before `end`: the question takes
    one that acts all the time."""
    if (left := stops_before(scene, blocks, rows, end)) is not None:
        raise InputError(f"{question}: an effect stops acting after {left:.10g} s: ask up to then, and "
                         "beyond from the state there, of the scene that is left")


def stopped(scene: AnyScene, state: Mapping[str, Any]) -> tuple[Scene, dict[str, tuple[float, ...]]]:
    """(the scene without the effect that stops acting first, its blocks), from the state where it stops on.
    """
    ends = [(left, one) for one in scene.ending if (left := one.stops_after(state)) is not None]
    effect = min(ends, key=lambda end: end[0])[1]
    kept = {name: tuple(map(float, row)) for name, row in state.items() if name not in effect.needs}
    return effect.stopped(scene, state), kept
