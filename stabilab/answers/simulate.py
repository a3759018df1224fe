"""Trajectories of a scene: times and states, with the laws that hold along them.

The exact motion of a case is given block by block: its rates, the direction of the vertical, the angles of
the attitude, the momentum and the place.
"""
from __future__ import annotations

import difflib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ..case.given import Given, Start, as_case, no_start, renamed, started, time_in
from ..case.sections import attitude_of
from ..errors import InputError
from ..integrate.trajectory import ALL_REACHED, SCIPY_METHODS, Trajectory, departures, integrated, watcher
from ..numbers.principal import PrincipalAxes, oblique
from ..orbit.flow import axis_way, reduced_motion
from ..physics.equations import Equations, rotation
from ..physics.scene import ATTITUDES, AnyScene, Scene
from ..physics.states import (
    angles,
    as_quaternion,
    beyond,
    body_momentum,
    checked_rtol,
    checked_times,
    equations_and_start,
    quaternion,
    scalar_last,
    start_of,
    to_space,
    unwrapped,
)
from ..physics.to_numpy import to_numpy
from ..reasons import Moment, PerSecond, Quantity, Reason, Reasoned, Sentence, chained
from ..representation import Answer, Compared
from .caveats import answered
from .motions.nutation import axis_named, nutation_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ..case.read import Case
    from ..numbers.vectors import Exact3
    from ..physics.law_limits import Validity


BY_QUADRATURE = Sentence("by-quadrature", "all times reached, without steps: time as an integral over the "
                         "reduced coordinate, inverted")()
NO_DIGIT = Sentence("no-digit-known", "no digit of the state is known at {time}: after so many periods of "
                    "{period} a start in doubles leaves the phase open")
IS_STIFF = Sentence(
    "stiff", "stiff: the fastest decay, {decay}, runs down {times} times over the span, so the implicit "
    "method {method} was taken")
PASSES_SINGULAR = Sentence(
    "passes-singular-angle", "near {time} the attitude passes the singular angle cos ψ = 0; φ and θ take the "
    "short way there")


# --- The state at asked-for times: followed in steps, or by quadrature where the motion has an orbit
METHODS = ("taylor", *SCIPY_METHODS)
REDUCED = "reduced"  # follows nothing: see `orbit.flow`
KNOWN = {m.lower(): m for m in (*METHODS, REDUCED)}


def trajectory(scene: AnyScene, state: Any, times: ArrayLike, method: str = "taylor",
               rtol: float | None = None, steps: list[float] | None = None, laws: bool = True) -> Trajectory:
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
    supplied, method = method, KNOWN.get(method.lower() if isinstance(method, str) else "", "")
    if not method:
        close = difflib.get_close_matches(str(supplied).lower(), KNOWN, 1)
        hint = f'; did you mean "{KNOWN[close[0]]}"?' if close else ""
        resolved = ", ".join(KNOWN.values())
        raise InputError(f"method: there is no {supplied!r:.80}; choose one of {resolved}{hint}")
    if steps is not None and not isinstance(steps, list):
        raise InputError(f"steps: expected a list that takes the ends of the steps, got {steps!r:.80}")
    if method == REDUCED:
        times, rtol = checked_times(times), checked_rtol(rtol)
        return _by_quadrature(scene, *equations_and_start(scene, state), times, rtol)
    return integrated(scene, state, times, method, rtol, steps, laws)


def _by_quadrature(scene: AnyScene, equations: Equations, state: np.ndarray, times: np.ndarray,
                   rtol: float | None) -> Trajectory:
    if equations.blocks != ("omega",):
        raise InputError("method reduced: it gives the rates alone, and the state has the blocks "
                         f"{', '.join(equations.blocks)}; take method taylor")
    if rtol is not None:
        raise InputError(
            "method reduced: it takes as many nodes as doubles need and has no tolerance; leave rtol out")
    motion = reduced_motion(scene, state, backwards=bool((times < 0).any()))
    states, turned, axis = axis_way(motion, times)
    system = to_numpy(equations)
    unit = np.vstack([np.zeros(3), np.eye(3)[axis]])
    # affine in that rate
    integrals = [row[0] * times + (row[1] - row[0]) * turned for row in system.law_rates(unit).values()]
    begun = np.append(state, np.zeros(len(integrals)))
    drift = departures(system, np.vstack([begun, np.column_stack([states, *integrals])]))
    info = np.abs(times) * ROUNDING <= LOST * (motion.period or np.inf)
    watch = watcher(scene, equations, state)
    if watch:
        watch.at(states[info])
        watch.over = "at the times given"
    status, reason = "reached", BY_QUADRATURE
    if not info.all():
        status = "stopped"
        reason = NO_DIGIT(time=Moment(float(min(times[~info], key=abs))),
                          period=Quantity(motion.period, scene.time_unit))
    return Trajectory(times[info], states[info], REDUCED, None, drift, {"evaluations": motion.evaluations},
                      status, validity=watch and watch.result(), reason=reason)


STIFF = 1e6  # fastest decay times duration beyond which an explicit method would only shorten its steps
# decays per radian of turn below which an attitude or gamma, which turn on, cost Radau more (measured)
TURNING = 700
STIFF_METHOD, STIFF_RTOL = "Radau", 1e-10
SHORT_WAY = 1.5  # rad: a step of phi or theta below half a turn by this margin cannot hide a whole one
ROUNDS, POINTS = 12, 400_000  # of refining the times between the asked-for ones for unwrapping
ROUNDING = 2.0**-53
LOST = 0.1  # of a period, or of the size of a state: what is farther off has no digit
MOVED = 2.0**-26  # of a component, by which it is moved to see what its error does to an angle
INSIDE = 5  # points a step: a Taylor step to the last digit turns the body by up to three radians


@dataclass(frozen=True, repr=False, eq=False)
class Simulation(Answer, Compared, Reasoned):
    """States of one model at the asked-for times.

    t: (n,), s (tau when scaled); state: name -> (n, m): omega (x when scaled), gamma, angles (psi, phi,
    theta, continuous from the start, rad) or quaternion (x, y, z, w) or matrix (n, 3, 3), momentum (inertial,
    kg m^2/s), velocity, position (inertial), nutation (n,) rad, of the axis nutation_axis where one was
    given, and for averaged models amplitude, spin, phase (n,). model: "exact", "linear", ...; the rest as of
    Trajectory. validity: of the scene's laws; what a formula assumes
    beyond them stands in `reason`. error: name -> size, () or (m,), below which a component is not told from
    0: what a check of the digits showed, else the tolerance of the run; none where neither is known.
    Vectors in the body are along the principal axes; frame: where these lie in the frame of the file or the
    tensor, None where the two are one. `to_pandas`, `to_xarray` and files have them in the frame of the file.
    """

    t: np.ndarray
    state: dict[str, np.ndarray]
    model: str
    method: str
    rtol: float | None
    invariant_drift: dict[str, float] = field(default_factory=dict)
    counters: dict[str, int] = field(default_factory=dict)
    status: str = "reached"
    reason: Reason = field(default=ALL_REACHED, kw_only=True)
    validity: Validity | None = None
    error: dict[str, np.ndarray] = field(default_factory=dict)
    frame: PrincipalAxes | None = field(default=None, repr=False, compare=False)
    nutation_axis: str = ""


def errors_of(state: Mapping[str, np.ndarray], fraction: float) -> dict[str, np.ndarray]:
    """The error of each component of the parts of a state, a share of the part's largest size over the times.
    """
    return {name: np.full(values.shape[1:], fraction * np.abs(values).max(initial=0.0)) for name,
            values in state.items()}


def simulate(scene: Given, state: Start | None = None, times: ArrayLike | None = None,
             blocks: Mapping[str, Any] | None = None, method: str | None = None, rtol: float | None = None,
             attitude: str | None = None, *, omega: Start | None = None,
             frame: str = "principal", nutation: str | None = None) -> Simulation:
    """The exact motion of a case from its start at the given times.

    scene: a case in any form, or a scene; state: its start, where that is another or none: rates, all
    components of the state, or blocks by name; times: (n,) in the case's time, the two ends of its span where
    none are given; frame: of the start, as of `fate`. blocks, method, rtol, attitude: as of `simulated`,
    blocks in place of those of the case. nutation: an axis, "x", "y", "z" of the file or "1", "2", "3": also
    its angle to the angular momentum. omega: the former name of `state`. Raises InputError as `trajectory`
    does.
    """
    if omega is not None:
        state = renamed("simulate", "omega", "state", omega, state)
    case = as_case(scene, state, None, frame)
    if case.state is None:
        raise no_start(case, "simulate")
    if blocks is not None:
        if not isinstance(blocks, Mapping):
            raise InputError(
                f"blocks: expected blocks of the state by name, such as {{'gamma': (0, 0, 1)}}, got "
                f"{blocks!r:.80}")
        case = started(case, {"omega": case.exact_state, **blocks})
    wanted = case.span if times is None else time_in(case.scene, times, "times")
    if wanted is None:
        raise InputError("times: expected times for a scene; a case without a span needs them too")
    if nutation is not None:
        axis_of_nutation(case, nutation)  # refused before the run, not after it
    result = simulated(case.scene, case.state, wanted, case.blocks, method, rtol, attitude)
    result = result if nutation is None else with_nutation(case, result, nutation)
    return answered(replace(result, frame=oblique(case.frame)), case, result.validity)


def simulated(scene: AnyScene, omega: Any, times: ArrayLike,
              blocks: Mapping[str, Sequence[float]] | None = None,
              method: str | None = None, rtol: float | None = None, attitude: str | None = None
              ) -> Simulation:
    """The exact motion of a scene from angular velocity `omega` at the given times.

    blocks: the rest of the state at time 0 ("gamma", "velocity", "position": three numbers, "attitude": psi,
    phi, theta, rad, or a quaternion from body to space, scalar last, which then stands in place of angles);
    those that the scene needs and blocks leaves out start at gamma = e3, zero angles, rest. attitude:
    "quaternion" or "matrix" has the attitude of any body beside the rates, from where `blocks` say (or their
    vertical, or no turn at all). method: None
    is "taylor", or Radau where the decay is so fast that an explicit method would crawl (the reason says so).
    Raises InputError as `trajectory` does.
    """
    times = checked_times(times)
    if attitude is not None:
        if attitude not in ATTITUDES:
            raise InputError(f'attitude: expected "quaternion" or "matrix", got {attitude!r:.60}')
        if scene.variables == "scaled":
            raise InputError("attitude: scaled variables have no attitude: give a body and rates in rad/s")
        turning = simulated(scene, omega, times, quaternion_blocks(blocks or {}), method, rtol)
        return turning if attitude == "quaternion" else in_matrices(turning)
    if scene.variables == "scaled":
        run = trajectory(scene, omega, times, "taylor" if method is None else method, rtol)
        return _simulation(run, {"x": run.states})
    blocks = {} if blocks is None else blocks
    start = start_of(scene, omega, blocks)
    method, rtol, why = _chosen(scene, start, times, method, rtol)
    first = blocks.get("attitude", (0.0, 0.0, 0.0))
    if "attitude" in start and not as_quaternion(first):
        return _with_attitude(scene, start, first, times, method, rtol, why)
    alone = len(start) == 1 and scene.blocks == ("omega",)
    run = trajectory(scene, omega if alone else start, times, method, rtol)
    parts = {name: run.block(name) for name in run.blocks}
    return _simulation(run, in_quaternions(scene, parts) if "attitude" in parts else parts, why)


def with_quaternion(case: Case) -> Any:
    """The case with its own attitude, that of its vertical with theta = 0, or identity, as a unit quaternion
    with its scalar last.

    Raises InputError where the variables are scaled: a system without moments has no attitude.
    """
    if case.variables == "scaled":
        raise InputError(f"{case.place}: --attitude: scaled variables have no attitude: give the motion as "
                         "angular_velocity, in rad/s")
    return replace(case, blocks=quaternion_blocks(case.blocks))


def quaternion_blocks(blocks: Mapping[str, Sequence[float]]) -> dict[str, Sequence[float]]:
    """The blocks of a state with their attitude, that of their vertical with theta = 0, or identity, as a
    unit quaternion with its scalar last; one that is given so stays."""
    supplied, vertical = blocks.get("attitude"), blocks.get("gamma")
    if supplied is not None and as_quaternion(supplied):
        return dict(blocks)
    turned = supplied or (attitude_of(vertical) if vertical else (0.0, 0.0, 0.0))
    return {**blocks, "attitude": tuple(scalar_last(quaternion(*turned)).tolist())}


def axis_of_nutation(case: Case, axis: str, model: str = "exact") -> Exact3:
    """The axis whose nutation is asked for by its name, as of `axis_named`, a unit vector along the principal
    axes. model: of the run. Raises InputError for another name, for scaled variables, which have no body, and
    for the averages of a model: ask before the run."""
    if case.variables == "scaled":
        raise InputError("nutation: scaled variables have no body: give the motion as angular_velocity, in "
                         "rad/s")
    if model != "exact":
        raise InputError(f"nutation: it is that of the exact motion, and this run is of the model {model}")
    return axis_named(case, axis).along


def with_nutation(case: Case, run: Simulation, axis: str) -> Simulation:
    """The run with the part "nutation", (n,) rad, of an axis by its name. Raises InputError as
    `axis_of_nutation` does."""
    scene: Any = case.scene  # that of a body, as the next line sees to
    vector = axis_of_nutation(case, axis, run.model)
    angle = nutation_of(scene, run.state, vector)
    error = _error_of_nutation(scene, run, vector, angle) if run.error else None
    return replace(run, state=run.state | {"nutation": angle}, nutation_axis=axis,
                   error=run.error if error is None else run.error | {"nutation": error})


def _error_of_nutation(scene: Any, run: Simulation, axis: Exact3, angle: np.ndarray) -> np.ndarray | None:
    """What errors of the parts of a run do to the angle, to first order, the largest over the times; None
    where one of them has none."""
    total = 0.0
    for name, values in run.state.items():
        if name in ("gamma", "quaternion", "matrix", "angles", "momentum", "velocity", "position"):
            continue
        if name not in run.error:
            return None
        for n, own in enumerate(np.broadcast_to(run.error[name], values.shape[1:]).tolist()):
            size = float(np.abs(values[:, n]).max(initial=0.0)) or 1.0
            moved = np.array(values)
            moved[:, n] += MOVED * size
            apart = np.abs(nutation_of(scene, run.state | {name: moved}, axis) - angle)
            total += own / (MOVED * size) * float(np.nanmax(apart, initial=0.0))
    return np.array(total if np.isfinite(total) else np.nan)


def in_matrices(run: Simulation) -> Simulation:
    """The run with its attitude as rotation matrices (n, 3, 3) in place of quaternions."""
    q = np.roll(run.state["quaternion"], 1, axis=-1)
    matrix: np.ndarray = np.moveaxis(np.array(rotation(np.moveaxis(q, -1, 0))), -1, 0)
    # an entry is a quadratic form of the quaternion with the eigenvalues 1, -1: its slope is at most 2
    error = {} if "quaternion" not in run.error else {
        "matrix": np.full((3, 3), 2 * float(np.linalg.norm(run.error["quaternion"])))}
    swapped = {("matrix" if name == "quaternion" else name): (matrix if name == "quaternion" else values)
               for name, values in run.state.items()}
    return replace(run, state=swapped,
                   error={name: run.error[name] for name in swapped if name in run.error} | error)


def in_quaternions(scene: Scene, state: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The blocks with the quaternion scalar last, and the angular momentum in space."""
    q = state.pop("attitude")
    first = {name: state.pop(name) for name in ("omega", "gamma") if name in state}
    return (first | {"quaternion": scalar_last(q),
                     "momentum": to_space(q, body_momentum(scene, first | state))} | state)


def _simulation(run: Trajectory, state: dict[str, np.ndarray], *why: Reason | None) -> Simulation:
    """why: what is to be said of its method, in place of that all times were reached."""
    reason = chained(run.reason if run.status != "reached" else None, *why) or run.reason
    return Simulation(run.t, state, "exact", run.method, run.rtol, run.invariant_drift, run.counters,
                      run.status, run.validity, errors_of(state, max(run.rtol or 0.0, ROUNDING)),
                      reason=reason)


def _chosen(scene: AnyScene, start: Mapping[str, Sequence[float]], times: np.ndarray, method: str | None,
            rtol: float | None) -> tuple[str, float | None, Reason | None]:
    """(method, rtol, why) with the stiff method where nothing was asked for and the decay is too fast."""
    if method is not None or not any(not e.keeps_volume for e in scene.effects):
        return "taylor" if method is None else method, rtol, None
    equations, state = equations_and_start(scene, start)
    with np.errstate(all="ignore"):
        slopes = to_numpy(equations).jacobian(state)
    if not np.isfinite(slopes).all():
        return "taylor", rtol, None
    # Euler's own terms keep volume: a pair of rates that they part and bring together is no decay
    fastest = min(float(np.max(-np.linalg.eigvals(slopes).real, initial=0.0)),
                  max(-float(np.trace(slopes)), 0.0))
    stiffness = fastest * float(np.abs(times).max(initial=0.0))
    turn = float(np.linalg.norm(start["omega"])) if len(equations.blocks) > 1 else 0.0
    if stiffness <= STIFF or fastest < TURNING * turn:
        return "taylor", rtol, None
    return STIFF_METHOD, STIFF_RTOL if rtol is None else rtol, IS_STIFF(
        decay=PerSecond(fastest, digits=3), times=Quantity(stiffness, digits=2), method=STIFF_METHOD)


def _with_attitude(scene: Scene, start: Any, first: Any, times: np.ndarray, method: str, rtol: float | None,
                   why: Reason | None) -> Simulation:
    """The run with angles unwrapped over a grid fine enough that no turn is missed."""
    inner, first, doubtful = _grid(scene, start, times, method, rtol), np.asarray(first, float), None
    for _ in range(ROUNDS):
        run = trajectory(scene, start, inner, method, rtol)
        q = run.block("attitude")
        wrapped = angles(q) if np.cos(first[0]) >= 0 else beyond(angles(q))
        middle = int(np.argmin(np.abs(run.t)))
        path = np.empty_like(wrapped)
        path[middle:] = unwrapped(wrapped[middle:], first)
        path[:middle + 1] = unwrapped(wrapped[middle::-1], first)[::-1]
        wide = np.nonzero(np.abs(np.diff(path[:, 1:], axis=0)).max(axis=1, initial=0.0) > np.pi
                          - SHORT_WAY)[0]
        if not len(wide) or len(inner) + len(wide) > POINTS or run.status != "reached":
            break
        inner = np.unique(np.concatenate([inner, *(0.5 * (run.t[wide] + run.t[wide + 1]),)]))
    if len(wide) and run.status == "reached":
        doubtful = PASSES_SINGULAR(time=Moment(float(run.t[wide[0]])))
    ordered_times = np.sort(times)
    at = np.searchsorted(run.t, ordered_times if run.status == "reached"
                         else ordered_times[np.isin(ordered_times, run.t)])
    at = at if len(times) < 2 or times[0] < times[-1] else at[::-1]
    state = {name: run.block(name)[at] for name in run.blocks if name != "attitude"}
    momentum = to_space(q[at], body_momentum(scene, state))
    state = {"omega": state.pop("omega"), **({"gamma": state.pop("gamma")} if "gamma" in state else {}),
             "angles": path[at], "momentum": momentum, **state}
    return _simulation(replace(run, t=run.t[at]), state, why, doubtful)


def _grid(scene: Scene, start: Mapping[str, tuple[float, ...]], times: np.ndarray, method: str,
          rtol: float | None) -> np.ndarray:
    """The asked-for times, zero, and the method's own steps with points inside each: between the points of a
    step the body turns by less than a radian or so, however it hurries between the asked-for times."""
    base = np.unique(np.concatenate([[0.0], times]))
    steps: list[float] = []
    trajectory(scene, start, base, method, rtol, steps)
    return np.unique(np.concatenate([base, denser(np.unique(np.concatenate([base, steps])), INSIDE, POINTS)]))


def denser(ends: np.ndarray, inside: int, largest: int) -> np.ndarray:
    """Times from the first end on up to the last, itself left out, with so many in each step;
    `largest` in all."""
    inside = max(1, min(inside, largest // len(ends)))
    return (ends[:-1, None] + np.diff(ends)[:, None] * (np.arange(inside) / inside)).ravel()
