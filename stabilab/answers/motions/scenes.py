"""Questions of a scene, asked of a case in any form: what lies below cases takes scenes and rows of states
alone."""
from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from ...case.given import (
    Amount,
    Given,
    Start,
    Starts,
    as_case,
    in_numbers,
    is_one,
    scene_of,
    time_in,
    with_start,
)
from ...case.limit_options import along
from ...case.read import Case
from ...errors import InputError
from ...integrate import ensemble as ensembles
from ...integrate.trajectory import Trajectory
from ...numbers.units import ANGLE, ENERGY, NONE, RATE, Dimension, in_si, split
from ...orbit.separatrix import branches
from ...orbit.separatrix.branches import Separatrix
from ...physics import equations, law_limits
from ...physics.states import float_array, row_of, start_of
from ...unreduced.spin_up import follow as spin_ups
from ...unreduced.spin_up.follow import SpinUp
from .. import chaos as orders
from .. import simulate as runs
from .. import time_to as times
from ..caveats import answered
from ..chaos import Chaos
from ..limit import WORK
from ..passage import TimeTo
from .starts import asked_of, whole_rows

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ...integrate.ensemble import Ensemble
    from ...physics.equations import Equations
    from ...physics.law_limits import Validity


def time_to(scene: Given, state: Start | None = None, rate: Any = None, component: Any = None,
            energy: Amount | None = None, tilt: Any = None, t_max: Amount | None = None,
            exact: Sequence[Fraction] | None = None, work: int = WORK, *,
            below: Amount | None = None, nutation: Any = None, nutation_below: Any = None,
            states: Starts | None = None,
            frame: str = "principal") -> TimeTo:
    """The first time t >= 0 at which each motion reaches a limit, between a lower and an upper bound.

    scene: a case in any form, or a scene; state, states, frame: as of `fate`. One limit is given, positive,
    in SI or as text with a unit ("10 deg/s"), exact where it is text: rate, of |omega|, or three of them, of
    the size of each component, whichever comes first; component=(axis, limit), of the size of the rate about
    an axis: 1, 2, 3 or three numbers along it, or a list of such pairs, whichever comes first; energy,
    kinetic, of the body; tilt=(axis, angle), below pi, of the angle between a body axis and its own direction
    in space at t = 0; nutation=(axis, angle), likewise, of that between a body axis and the angular momentum;
    below, of |omega|, and nutation_below, the first time at which it is no larger. t_max: the time at which
    the search ends; None: when its work is done. exact: a former argument; a start is exact where it is text
    or rational. work: multiplications that the proof for a motion may take; 0: no proof.

    Torque and wheel: the motion is enclosed and its crossing proved where the work reaches; beyond that by
    compiled steps (with numba), roots along a run, the clock of the spin-up. Other effects: roots along a
    run. Raises InputError for cases, states and limits that are none.
    """
    case, array = asked_of(scene, state if exact is None else exact, states, None, "time_to", frame)
    plain = NONE if case.variables == "scaled" else RATE
    ask = {"rate": _of(rate, plain, "rate"), "energy": _of(energy, ENERGY, "energy"),
           "below": _of(below, plain, "below"), "component": _pairs(case, component, plain, "component"),
           "tilt": _pairs(case, tilt, ANGLE, "tilt"), "nutation": _pairs(case, nutation, ANGLE, "nutation"),
           "nutation_below": _pairs(case, nutation_below, ANGLE, "nutation_below")}
    end = time_in(case.scene, t_max, "t_max")
    if array.ndim == 1:
        result = times.time_of_case(case, ask, end, work)
    else:
        result = times.time_to(case.scene, whole_rows(case, array), **ask, t_max=end, work=work)
    return replace(result, caveats=(*case.caveats, *result.caveats))


def _of(value: Any, unit: Dimension, name: str) -> Any:
    """A number, or several; text with a unit as the exact number in SI, all else as it is."""
    if isinstance(value, str):
        return in_si(value, unit, name) if (split(value) or ("", ""))[1] else value
    return [_of(item, unit, name) for item in value] if isinstance(value, (list, tuple)) else value


def _pairs(case: Case, raw: Any, unit: Dimension, name: str) -> Any:
    """(axis, limit), or a list of such; x, y, z are axes of the file."""
    if isinstance(raw, (list, tuple)) and len(raw) == 2 and isinstance(raw[0], (str, int, list, tuple)):
        axis, limit = raw
        if not isinstance(axis, (list, tuple)) or len(axis) == 3:
            axis = along(case, axis) if isinstance(axis, str) and axis in "xyz123" and axis else axis
            return axis, _of(limit, unit, name)
    return [_pairs(case, item, unit, name) for item in raw] if isinstance(raw, (list, tuple)) else raw


def chaos(scene: Given, state: Start | None = None, until: Amount | None = None,
          tell: Callable[[int], Any] | None = None, *, states: Starts | None = None) -> Chaos:
    """Whether motions are regular or chaotic, by MEGNO, from variational equations derived from the scene's
    own (see `unreduced.chaos`).

    scene: a case in any form, or a scene; state, states: as of `fate`, rounded to doubles. until: the time up
    to which they are followed (None: a thousand turns of a motion of middling pace). Motions whose fate is
    spin-up are not followed; a state at rest is regular, however fast its neighbours part. Works for every
    effect. A label is what was seen up to that time: "regular" is no proof, the slowest chaos takes longer.
    tell(motions done) is called meanwhile. Raises InputError for other shapes and numbers.
    """
    case = as_case(scene)
    source: Any = state if states is None else states
    texts = is_one(source) and not isinstance(source, Mapping) and any(isinstance(v, str) for v in source)
    if source is None or isinstance(source, Mapping) or texts:
        rows: Any = _row(with_start(as_case(case, source), "chaos"))
    else:  # rows of whole states, or of rates beside the other blocks of the case
        rows = in_numbers(source, NONE if case.variables == "scaled" else RATE, "states")
        short = case.state is not None and case.scene.blocks != ("omega",) and float_array(
            rows, "states", "numbers in rows").shape[-1:] == (3,)
        if short:
            case, array = asked_of(case, state, states, None, "chaos")
            rows = _row(case) if array.ndim == 1 else whole_rows(case, array)
    return answered(orders.chaos(case.scene, rows, time_in(case.scene, until, "until"), tell), case)


def _row(case: Case) -> np.ndarray:
    """The start of a case with all blocks of the state."""
    return np.array(row_of(case.scene, case.state or (), case.blocks))


def spin_up(scene: Given, state: Start | None = None, t_max: Amount | None = None, budget: int | None = None,
            after: Amount = 0.0, proof: bool = False, tell: Callable[..., Any] | None = None,
            fast: bool | None = None) -> SpinUp:
    """Whether and how the motion of a case spins up, decided by a certificate or not at all.

    scene: a case in any form, or a scene, of a gyrostat under a constant torque; state: as of `fate`. t_max:
    how long the motion is followed, in the scene's time (None: 1e9 natural units, of the root of mean moment
    over torque); budget: in how many steps (None: 600,000). Slow drifts are run over many revolutions at
    once. after: the inequality is to hold for a state at this time or later: bounds and clocks of a later
    trap are narrower. proof: enclose the motion up to the inequality, so that nothing rests on a run in
    machine precision: level "proved" where that succeeds; without it the start of a run is rounded.
    tell(time, steps, motions left): called meanwhile. fast: True for loops compiled by numba, False for the
    same loops as they are written, None for whichever is sooner; the motions are the same to the last bit.
    Raises InputError for scenes with other effects than turn the body as wheel and torque do, and for states
    that are none.
    """
    case = with_start(as_case(scene, state), "spin_up")
    end, late = (time_in(case.scene, item, name) for item, name in ((t_max, "t_max"), (after, "after")))
    return answered(spin_ups.spin_up(case.scene, case.exact_state, end, budget, late, proof, tell, fast),
                    case)


def separatrix(scene: Given, reach: float | None = None, shape: tuple[int, int] | None = None,
               accuracy: float | None = None, fast: bool = False) -> Separatrix:
    """Every branch of the separatrix of a scene with an elliptic or hyperbolic reduction.

    scene: a case in any form, or a scene. reach: how far out the branches go, as a multiple of the radius
    sqrt|Q| of the outermost fold (default 4; where there is no fold, of the smallest saddle's); must exceed
    1. shape: (rows, columns) of each grid, at least (3, 5), an even number of columns becomes the next odd
    one (default (96, 129)). accuracy: in place of a shape, the largest distance allowed between the branches
    and the flat facets of their meshes, in the unit of the points: each grid gets as few rows and columns as
    that needs (of a branch, its rim where `reach` cuts it off may stray by ten times as much), a branch whose
    loops reach a second saddle as high comes in two parts that meet there, and every branch has as `error`
    what its facets were found to reach (more than that only where the largest grids, of 1025 rows, still bend
    as much). fast: accepted for one version more, without effect. Points are in the scene's variables. A
    scene without saddles gives no branches and the reason. Raises InputError for a shape, reach or accuracy
    out of range.
    """
    case = as_case(scene)
    return answered(branches.separatrix(case.scene, reach, shape, accuracy, fast), case)


def trajectory(scene: Given, state: Start | None = None, times: ArrayLike | None = None,
               method: str = "taylor", rtol: float | None = None, steps: list[float] | None = None,
               laws: bool = True) -> Trajectory:
    """States of a scene at the given times, the motion being at `state` at t = 0.

    scene: a case in any form, or a scene; without `state` and `times` a case's own start, and the two ends of
    its span. state: three numbers, the angular velocity (x when scaled); for scenes with more blocks of state
    all their components in order, or a dict of blocks {"omega": ..., "gamma": ..., "attitude": ...} as in
    `blocks`, the attitude as a quaternion, scalar first (a block beyond those that the scene needs is
    integrated too; a missing one starts at gamma = e3, the unit quaternion, rest). A run
    starts at the doubles nearest to what is given.

    times: (n,) strictly increasing or decreasing, of any sign, in s (tau when scaled). method: "taylor"
    (heyoka; where it is not installed SciPy's DOP853 at rtol 1e-13, and `method` and `reason` say so) or a
    method of scipy.integrate.solve_ivp by name, in any case; "reduced" (the quadrature of a scene with one
    degree of freedom, at a cost that does not grow with the times; InputError where the motion has none).
    rtol: relative tolerance; None is half an ulp for "taylor", 1e-10 for the others. steps: a list that takes
    the times at which the method ended its own steps. laws: check the balance laws (costs the Taylor series a
    fifth or so); without, `invariant_drift` is empty. Where the run cannot go on (overflow, a failing step)
    `status` is "stopped", `reason` says why, and t, states hold the times that were reached. Raises
    InputError for states and times that are no such numbers and for an unknown method.
    """
    case = as_case(scene)
    if state is None:
        case = with_start(case, "trajectory")
        state = (case.state if case.variables == "scaled"
                 else start_of(case.scene, case.state or (), case.blocks))
    unit = NONE if case.variables == "scaled" else RATE
    start = ({name: in_numbers(value, unit if name == "omega" else NONE, f"state: {name}")
              for name, value in state.items()} if isinstance(state, Mapping)
             else in_numbers(state, unit, "state"))
    run = runs.trajectory(case.scene, start, _times(case, times), method, rtol, steps, laws)
    return answered(run, case, run.validity)


def _times(case: Case, times: Any) -> Any:
    """The times that are given, or the ends of the span of a case."""
    if times is None and case.span is None:
        raise InputError("times: expected times for a scene; a case without a span needs them too")
    return case.span if times is None else time_in(case.scene, times, "times")


def ensemble(scene: Given, states: Starts | None = None, times: ArrayLike | None = None,
             rtol: float | None = None, workers: int = 1, *, state: Start | None = None) -> Ensemble:
    """The motions of a scene from many starts at t = 0, at the given times; the laws are not checked
    (`trajectory` does).

    scene: a case in any form, or a scene; without `states` and `times` the case's own start, and the ends of
    its span. states: (n, N), doubles, a row for each motion as `trajectory` takes it; state: one of them.
    times: (m,) as for `trajectory`. rtol: relative tolerance, None for half an ulp. workers: threads that
    share the rows out, 0 for all cores; the answer has the same bytes for any number. Where heyoka is not
    installed every motion is run by itself with SciPy's DOP853, and workers gain nothing. Raises InputError
    for states, times, rtol and workers that are none.
    """
    case = as_case(scene, state)
    unit = NONE if case.variables == "scaled" else RATE
    rows = (np.array([_row(with_start(case, "ensemble"))]) if states is None
            else in_numbers(states, unit, "states"))
    result = ensembles.ensemble(case.scene, rows, _times(case, times), rtol, workers)
    return answered(result, case, result.validity)


def derive(scene: Given, also: Iterable[str] = ()) -> Equations:
    """Equations of motion of a Scene (omega, rad/s, body frame) or of a ScaledGyrostat (x).

    scene: a case in any form, or a scene. The state has the blocks that the scene's effects need, and those
    named in `also` (physical scenes only). Right-hand sides, energy, Jacobian and balance laws are SymPy
    expressions. Raises InputError for what is no case and no scene, and for velocity or position of a body
    without a mass.
    """
    return equations.derive(scene_of(scene), also)


def validity(scene: Given, states: Any = None, over: str = "at the start", *, state: Start | None = None
             ) -> Validity | None:
    """How far the approximate laws of a scene hold at states (..., N): the blocks of the scene in order,
    omega alone, or a dict of blocks.

    scene: a case in any form, whose own start it is where no states are given, or a scene. None where all its
    laws are exact. States are in rad/s along the principal axes. For arrays `value` and `holds` are arrays
    (...,). over: where the states are, in words. Raises InputError for blocks that the scene does not have.
    """
    case = as_case(scene, state)
    rows = _row(with_start(case, "validity")) if states is None else states
    return law_limits.validity(case.scene, in_numbers(rows, RATE, "states"), over)
