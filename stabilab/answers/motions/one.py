"""All that is known of the motion of a case, from one start or one after another from many; no arrays."""
from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ...case.given import (
    Amount,
    Given,
    Span,
    Start,
    Starts,
    as_case,
    is_one,
    renamed,
    started,
    time_in,
    with_start,
)
from ...case.limit_options import angle_of
from ...case.read import Case
from ...errors import InputError
from ...orbit.result import Motion, Needs
from .of_case import judged, motion_of_case, with_its_tilt

if TYPE_CHECKING:
    import numpy as np


def motion(scene: Given, state: Start | None = None, span: Span | None = None, *,
           states: Starts | None = None, tilt: Amount | None = None, follow: Amount | None = None,
           proof: bool = False, tell: Callable[..., Any] | None = None, brief: bool | None = None,
           exact: Start | None = None,
           frame: str = "principal") -> Motion | list[Motion]:
    """All that is known of the motion of a case: a `Motion`; of many starts (`states`) a list of them.

    scene, state, states, tilt, follow, proof, tell, frame: as of `fate`. span: (from, to), in whose times,
    and from the start to them, extremes are searched where the motion is not integrable. Of a list of starts
    each is exact, as one is. brief, exact: former arguments. Raises InputError as `fate` does.
    """
    if exact is not None:
        state = renamed("motion", "exact", "state", exact, None)
    if brief is not None:
        renamed("motion", "brief", "fate, extremes or period", brief, None)
    many: Any = state if states is None and state is not None and not is_one(state) else states
    if many is None:
        cases = [with_start(as_case(scene, state, span, frame), "motion")]
    elif state is not None and many is not state:
        raise InputError("motion: state is one start and states are many: give one of them")
    else:
        from .starts import asked_of
        case, array = asked_of(scene, None, many, span, "motion", frame)
        many = None if array.ndim == 1 else many
        cases = [case] if many is None else _each(case, many, array, frame)
    angle = None if tilt is None else angle_of(tilt)
    needs = Needs.QUICK if brief else Needs.ALL
    rows = [_whole(item, needs, angle, time_in(item.scene, follow, "follow"), tell, proof) for item in cases]
    return rows[0] if many is None else rows


def _each(case: Case, many: Any, array: np.ndarray, frame: str) -> list[Case]:
    """The case from each of many starts, exact where each is one of a list; array: of the same, doubles."""
    if isinstance(many, (list, tuple)) and all(map(is_one, many)):
        return [with_start(started(case, item, frame), "motion") for item in many]
    return [started(case, row) for row in array.reshape(-1, array.shape[-1])]


def _whole(case: Case, needs: Needs, tilt: float | None, follow: float | None,
           tell: Callable[..., Any] | None, proof: bool) -> Motion:
    result = motion_of_case(case, needs, follow, tell, proof)
    result = judged(case, result) or result
    return with_its_tilt(case, result, tilt)
