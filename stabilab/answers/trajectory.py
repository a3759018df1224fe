"""The state at asked-for times: followed in steps, or by quadrature where the motion has an orbit."""
from __future__ import annotations

import difflib
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from ..integrate.trajectory import SCIPY_METHODS, Trajectory, departures, integrated, watcher
from ..orbit.flow.flow import axis_way, reduced_motion
from ..physics.equations import Equations
from ..physics.scene import AnyScene
from ..physics.states import checked_rtol, checked_times, equations_and_start
from ..physics.to_numpy import to_numpy

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

METHODS = ("taylor", *SCIPY_METHODS)
REDUCED = "reduced"  # follows nothing: see `orbit.flow`
KNOWN = {m.lower(): m for m in (*METHODS, REDUCED)}


def trajectory(scene: AnyScene, state: Any, times: ArrayLike, method: str = "taylor",
               rtol: float | None = None, steps: list[float] | None = None,
               laws: bool = True) -> Trajectory:
    """States of a scene at the given times, the motion being at `state` at t = 0.

    state: three numbers, the angular velocity (x when scaled); for scenes with more blocks of state all their
    components in order, or a dict of blocks {"omega": ..., "gamma": ..., "attitude": ...} as in `blocks` (a
    block beyond those that the scene needs is integrated too; a missing one starts at gamma = e3, the unit
    quaternion, rest).

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
    method = _method(method)
    if steps is not None and not isinstance(steps, list):
        raise InputError(f"steps: expected a list that takes the ends of the steps, got {steps!r:.80}")
    if method == REDUCED:
        times, rtol = checked_times(times), checked_rtol(rtol)
        return _by_quadrature(scene, *equations_and_start(scene, state), times, rtol)
    return integrated(scene, state, times, method, rtol, steps, laws)


def _method(name: str) -> str:
    if isinstance(name, str) and name.lower() in KNOWN:
        return KNOWN[name.lower()]
    close = difflib.get_close_matches(str(name).lower(), KNOWN, 1)
    hint = f'; did you mean "{KNOWN[close[0]]}"?' if close else ""
    raise InputError(f"method: there is no {name!r:.80}; choose one of {', '.join(KNOWN.values())}{hint}")


def _by_quadrature(scene: AnyScene, equations: Equations, state: np.ndarray, times: np.ndarray,
                   rtol: float | None) -> Trajectory:
    if equations.blocks != ("omega",):
        raise InputError(f"method reduced: it gives the rates alone, and the state has the blocks "
                         f"{', '.join(equations.blocks)}; take "
                         "method taylor")
    if rtol is not None:
        raise InputError(
            "method reduced: it takes as many nodes as doubles need and has no tolerance; leave rtol out")
    motion = reduced_motion(scene, state, backwards=bool((times < 0).any()))
    states, turned, axis = axis_way(motion, times)
    system = to_numpy(equations)
    unit = np.vstack([np.zeros(3), np.eye(3)[axis]])
    # affine in that rate
    integrals = [row[0] * times + (row[1] - row[0]) * turned for row in system.law_rates(unit).values()]
    drift = departures(system, state, np.column_stack([states, *integrals]))
    watch = watcher(scene, equations, state)
    for row in states if watch else ():
        watch.note(row)
    return Trajectory(times, states, REDUCED, None, drift, {"evaluations": motion.evaluations}, "reached",
                      "all times reached, without steps: time as an integral over the reduced coordinate, "
                      "inverted",
                      validity=watch and watch.result())
