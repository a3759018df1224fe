"""The fate, the extremes, the period and all that is known of motions, of one start or of arrays of them.

One start is exact, as it was written; of an array the starts are doubles. A fate is bounded, spin-up, on the
separatrix, at rest, or undecided."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..case.given import Amount, Given, Span, Start, Starts, as_case, time_in
from ..case.limit_options import angle_of
from ..errors import InputError
from ..orbit.result import Needs, no_period
from ..validation import reach_of
from .digits import ask, ask_all
from .digits_asked import Told
from .motions import rows
from .motions.of_case import motion_of_case
from .motions.result import Motions, Values, period_of
from .motions.starts import asked_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

NONE = ((np.nan, np.nan),) * 3


def fate(scene: Given, state: Start | None = None, *, states: Starts | None = None,
         span: Span | None = None, tilt: Amount | None = None, digits: int | None = None,
         follow: Amount | None = None, proof: bool = False, fast: bool | None = None,
         tell: Callable[..., Any] | None = None,
         frame: str = "principal") -> Motions:
    """What becomes of the motion of a case, or from each of many starts.

    scene: a case in any form (see `stabilab.case.given`), or a scene. state: its start, where that is another
    or none: three rates in its variables, all components of its state, or blocks by name; its rates are
    exact where they are text, Fractions or Decimals. states: many starts instead, (..., 3) or rows of whole
    states, rounded to doubles. frame: in which the
    vectors of these are, "principal", along the principal axes as `case.state` and all results are, or
    "file", of a full tensor. span: of the case, in its time. tilt: of one start, the half-angle of a cone of
    torques ("1 deg", or rad); without it what the case states. digits (1 to 10,000, 50 of what is followed in
    time): give the margins so many, checked; ToleranceNotMet otherwise. follow: how long motions are followed
    that only a run with a certificate decides (a torque off the principal axes), in the scene's time; None
    for 600,000 steps, some seconds (10,000 of SciPy without heyoka). proof: enclose the way of each of these
    motions, one after another, some milliseconds each: `level` then says "proved" where that succeeds. fast:
    of many starts under such a torque, whether they are followed by compiled loops (None: where that is
    quicker; the numbers are the same). tell(time, steps, motions left) is called meanwhile. Raises InputError
    for what is no case and no start, and for scenes with effects that this analysis does not cover.
    """
    case, array = asked_of(scene, state, states, span, "fate", frame)
    long: Any = time_in(case.scene, follow, "follow")
    options = _options(array, follow=long, proof=proof, fast=fast)
    result = Motions(case, array, options, None if tilt is None else angle_of(tilt))
    if result.by_rows:
        vars(result)["rows"] = rows.fates(case.scene, array, **options, tell=tell)
    elif result.one:
        result.kept[Needs.FATE] = [motion_of_case(case, Needs.FATE, long, tell, proof)]
    margins = result.margins  # what is bad input is said now
    if digits is not None:
        printed = _with_digits("fate", result, digits, margins)
        if printed.values is not None:
            _put_margins(result, printed)
    return result


def _options(array: np.ndarray, **options: Any) -> dict[str, Any]:
    """Those that are given."""
    return {name: value for name, value in options.items() if value not in (None, False)
            or (name == "fast" and value is False)}


def _put_margins(result: Motions, printed: Told) -> None:
    if result.by_rows:
        vars(result)["rows"] = replace(result.rows, margins=np.asarray(printed.values))
    else:
        result.kept[Needs.FATE] = [replace(result.motions(Needs.FATE)[0], margin=float(printed.values))]


def fate_grid(scene: Given, axes: Sequence[ArrayLike]) -> np.ndarray:
    """Labels (n1, n2, n3), int8 of `Fate`, of the states (axes[0][a], axes[1][b], axes[2][c]); the same as
    `fate` gives.

    scene: a case in any form, or a scene. axes: three arrays of rates (rad/s, or x when scaled), in any
    order. Raises InputError for axes that are not three one-dimensional arrays of finite numbers, and as
    `fate` does.
    """
    twin, axes = as_case(scene).scene, _checked_axes(axes)
    labels = np.empty([len(a) for a in axes], np.int8)
    for index, first in enumerate(axes[0]):
        plane = np.empty(labels.shape[1:] + (3,))
        plane[..., 0], plane[..., 1], plane[..., 2] = first, axes[1][:, None], axes[2]
        labels[index] = rows.fates(twin, plane).labels
    return labels


def _checked_axes(axes: Sequence[ArrayLike]) -> list[np.ndarray]:
    try:
        arrays = [np.asarray(a, dtype=float) for a in axes]
    except (TypeError, ValueError, OverflowError):
        raise InputError("axes: expected three arrays of numbers") from None
    if len(arrays) != 3 or any(a.ndim != 1 for a in arrays):
        raise InputError(
            f"axes: expected three one-dimensional arrays, got shapes {[a.shape for a in arrays]}")
    if not all(np.isfinite(a).all() for a in arrays):
        raise InputError("axes: every number must be finite")
    return arrays


def extremes(scene: Given, state: Start | None = None, span: Span | None = None, *,
             states: Starts | None = None, digits: int | None = None, follow: Amount | None = None,
             fast: bool | None = None,
             frame: str = "principal") -> Values:
    """Smallest and largest value of each component over all t >= 0: (..., 3, 2) in the case's variables.

    scene, state, states, follow, fast, frame: as of `fate`; span: a time, or two (from, to). +-inf where a
    component grows without bound; at an equilibrium both are the state. Scenes without a reduction need
    `span`: their extremes hold from the start, at time 0, to its end. Without it they have bounds for all t
    >= 0 where spin-up is certified and NaN elsewhere, of which `reason` says why; of many starts InputError
    where none has any. digits (1 to 10,000, 50 of what is followed in time): reach so many and check them
    (ToleranceNotMet otherwise); without it eleven, by the formulas' own bound.
    """
    case, array = asked_of(scene, state, states, span, "extremes", frame)
    long: Any = time_in(case.scene, follow, "follow")
    result = Motions(case, array, _options(array, follow=long, fast=fast), tilted=False)
    over, why = "all time", ""
    if result.by_rows:
        values = rows.extremes(case.scene, array, reach_of(case.span), fast, long)
    else:
        resolved = result.motions(Needs.EXTREMES)
        pairs = [NONE if item.extremes is None else item.extremes for item in resolved]
        values = np.array(pairs).reshape(*result.shape, 3, 2)
        if result.one:
            over = resolved[0].extremes_over
            why = over if resolved[0].extremes is None else ""
    printed = None if digits is None else _with_digits("extremes", result, digits, values)
    if printed is not None and printed.values is not None:
        values = np.asarray(printed.values, float)
    return Values("extremes", values, result, printed and printed.decimals, over, why)


def period(scene: Given, state: Start | None = None, *, states: Starts | None = None,
           span: Span | None = None, digits: int | None = None, follow: Amount | None = None,
           fast: bool | None = None,
           frame: str = "principal") -> Values:
    """Period of each motion, (...,) in the case's time: inf where the motion does not repeat, 0 at an
    equilibrium, NaN where its fate is undecided or no return is known, as `reason` says.

    scene, state, states, follow, fast, frame: as of `fate`; digits: as of `extremes`. Raises InputError as
    `fate` does, and under a torque off the axes follows every motion as `fate` does.
    """
    case, array = asked_of(scene, state, states, span, "period", frame)
    long: Any = time_in(case.scene, follow, "follow")
    result, why = Motions(case, array, _options(array, follow=long, fast=fast), tilted=False), ""
    if result.by_rows:
        values = rows.periods(case.scene, array, fast)
    else:
        resolved = result.motions(Needs.PERIOD)
        values = np.array([period_of(item) for item in resolved]).reshape(result.shape)
        why = no_period(resolved[0].fate).text() if result.one and resolved[0].period is None else ""
    printed = None if digits is None else _with_digits("period", result, digits, values)
    if printed is not None and printed.values is not None:
        values = np.asarray(printed.values, float)
    return Values("period", values, result, printed and printed.decimals, "", why)


def _with_digits(question: str, result: Motions, digits: int, values: Any) -> Told:
    """The answer with so many digits."""
    case = result.case
    if not result.one:
        reach = reach_of(case.span) if question == "extremes" else None
        return ask_all(question, case.scene, result.states, digits, values, reach).required()
    resolved = result.motions(Needs.FATE if question == "fate" else Needs.RETURN)[0]
    return ask(question, case.scene, case.start, digits, case.span, resolved, case.exact_state).required()
