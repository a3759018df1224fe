"""How far body axes lean: from the angular momentum (coning), and from where they pointed at the start.

Without a torque the angular momentum H stays in space. The angle theta of an axis to it lies between bounds
that the extremes of the rates give, over all time; and as the axis goes round H, it is nowhere farther from
its direction at the start, where theta = theta0, than the largest min(theta0 + theta, 2 pi - theta0 - theta).
It comes as near to that as one likes unless the periods of rotation and precession are commensurable. An axis
of the file that is no principal axis has its bounds by a run over one period of the rates.

Likewise where the rates repeat, or stay, under a torque: with each period the attitude turns by the same
rotation, whose axis stays in space, and a body axis keeps to its cone about that one, known by a run over
one period. Elsewhere both angles are followed along a run: they are largest at its ends, or where the rate of
their cosine vanishes."""
from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from ...case.given import Given, Span, Start, as_case, with_start
from ...case.limit_options import along
from ...errors import InputError
from ...integrate.events import zeros_passed
from ...integrate.own_units import in_units, scale_of, units_of
from ...numbers.vectors import Exact3, Float3
from ...orbit.result import ALL_TIME, OVER_SPAN, Fate, Needs
from ...physics.equations import Equations, rotation
from ...physics.scene import AnyScene, slices, stopped, time_left
from ...physics.states import equations_and_start, start_of, to_space
from ...physics.to_numpy import form, to_numpy
from ...reasons import Reason, Reasoned, Sentence, Time
from ...reasons import Span as Times
from ...representation import Answer, Compared
from ..caveats import answered
from ..kinds import kind_of
from ..limit import AXES, Momentum, asked, pointing_bound
from ..motion import motion
from ..simulate import simulated
from .nutation import between, nutation_of

STEPS = 300_000  # of a run, each of which is searched for roots
BY_CONE = Sentence("angles-by-cone", "no torque: the angular momentum stays, and each axis keeps to its cone "
                   "about it")()
BY_ROOTS = Sentence("angles-along-run", "roots of the rates of the angles along a run in machine precision")()
BY_TURN = Sentence(
    "angles-by-turn", "the rates repeat after {time}, with each of which the attitude turns by the same "
    "rotation: each axis keeps to its cone about the axis of that")
BY_STEADY_TURN = Sentence("angles-of-steady-turn", "the rates stay: each axis keeps its angle to them")()
NO_TURN = 1e-6  # of the sine of half a turn: a smaller one has no axis that a run shows
BROKE_OFF = Sentence("angles-run-stopped", "it broke off before: {why}")


@dataclass(frozen=True, eq=False, repr=False)
class Angles(Answer, Compared, Reasoned):
    """Angles of body axes, rad.

    axes: their names, x, y, z of the file or 1, 2, 3 of the principal axes; momentum: (axes, 2) least and
    greatest angle to the angular momentum; start: (axes,) the largest angle to the direction in space that
    the axis had at the start, an upper bound where `over` is all time; over: the time they hold for, with its
    words; level: "exact" or "run"; reason: how they are known.
    """

    axes: tuple[str, ...]
    momentum: np.ndarray
    start: np.ndarray
    over: Reason
    level: str

    @property
    def for_all_time(self) -> bool:
        """Whether they hold for all times."""
        return self.over == ALL_TIME


def angles(scene: Given, state: Start | None = None, axes: Sequence[str] = "xyz", *, span: Span | None = None,
           frame: str = "principal") -> Angles:
    """The angles of body axes to the angular momentum and to their own directions at the start: over all time
    where the momentum stays, over the span of the case elsewhere.

    scene: a case in any form, or a scene, of a body; state, span, frame: in place of its own, as of `fate`.
    axes: names, "x", "y", "z" of the file or "1", "2", "3", the principal axes. Raises InputError for scaled
    variables, which have no attitude, for a body without angular momentum, where a span is needed and not
    given, and as `fate` does.
    """
    case: Any = with_start(as_case(scene, state, span, frame), "angles")
    if case.variables == "scaled":
        raise InputError("angles: scaled variables have no attitude: give a body, and the motion as "
                         "angular_velocity, in rad/s")
    if wrong := [axis for axis in axes if axis not in tuple("xyz123")]:
        raise InputError(f"axes: expected x, y, z or 1, 2, 3, got {wrong[0]!r:.40}")
    vectors = [AXES[place - 1] if isinstance(place := along(case, axis), int) else place for axis in axes]
    start = start_of(case.scene, case.state, case.blocks)
    law, row = Momentum.made(case.scene), equations_and_start(case.scene, start)[1]
    if not any(law.of(row.tolist())):
        raise InputError("state: the angular momentum is zero, so that no axis has an angle to it")
    exact = case.exact_state or tuple(map(Fraction, case.state))
    result = for_all_time(case.scene, case.state, exact, vectors) if case.scene.plain else None
    momentum, apart, over, level, reason = result or _over_the_span(case, vectors, start)
    return answered(Angles(tuple(axes), momentum, apart, over, level, reason=reason), case)


# --- Over time
@dataclass(frozen=True)
class Leaning:
    """t: (n,) s; angle: (n,) rad of a body axis to the angular momentum, or to the upward vertical; apart:
    (n,) rad to the direction of the axis in space at t = 0, None where the angular momentum stays and for the
    vertical."""

    t: np.ndarray
    angle: np.ndarray
    apart: np.ndarray | None = None


def leaning(scene: Any, state: Float3, blocks: Mapping[str, Any], times: np.ndarray, axis: Exact3,
            vertical: bool = False) -> Leaning:
    """The angles of an axis, a unit vector along the principal axes, along a run from three rates and other
    blocks, at the times (n,) that it reaches; vertical: to the upward vertical, of a scene that has one."""
    v = np.array([float(a) for a in axis])
    if vertical or Momentum.made(scene).stays:
        run = simulated(scene, state, times, blocks)
        return Leaning(run.t, between(-run.state["gamma"], v) if vertical
                       else nutation_of(scene, run.state, axis))
    run = simulated(scene, state, times, blocks, attitude="quaternion")
    now = to_space(np.roll(run.state["quaternion"], 1, axis=-1), v)
    apart = between(now, now[int(np.argmin(np.abs(run.t)))]) if len(now) else None
    return Leaning(run.t, nutation_of(scene, run.state, axis), apart)


# --- For all times
def for_all_time(scene: AnyScene, state: Float3, exact: Exact3, vectors: Sequence[Exact3]
                 ) -> tuple[Any, ...] | None:
    """(angles to the momentum, to the start, over, level, reason) of a plain scene, as of `Angles`; None
    where no law has them over all time. exact: the state; vectors: unit vectors along the axes."""
    resolved = motion(scene, state, needs=Needs.RETURN, exact=exact)
    if any(scene.quadratic().m):
        return _under_a_torque(scene, state, vectors, resolved)
    if resolved.extremes is None or not resolved.for_all_time:
        return None
    rows, apart, level = [], [], "exact"
    for vector in vectors:
        cone = asked(scene, nutation=(vector, Fraction(1)))
        ends = _ends(cone, resolved.extremes, exact)
        if sum(map(bool, vector)) > 1 and resolved.period:
            seen, level = _along(scene, {"omega": state}, [vector], resolved.period), "run"
            ends = tuple(seen[0][0].tolist())
        begun = math.acos(max(-1.0, min(1.0, cone.cosine(exact))))
        rows.append(ends)
        apart.append(pointing_bound(begun, *ends))
    return np.array(rows), np.array(apart), ALL_TIME, level, BY_CONE


def _under_a_torque(scene: AnyScene, state: Float3, vectors: Sequence[Exact3], resolved: Any
                    ) -> tuple[Any, ...] | None:
    """The same of rates that stay or repeat."""
    start = {"omega": state}
    if resolved.fate == Fate.EQUILIBRIUM:
        if not any(state):
            return None
        momentum, *_ = _along(scene, start, vectors, 0.0)
        (ends, *_) = _along(scene, start, vectors, 0.0, pole=np.array(state) / math.hypot(*state))
        apart = [pointing_bound(angle, angle, angle) for angle in ends[:, 0].tolist()]
        return momentum, np.array(apart), ALL_TIME, "exact", BY_STEADY_TURN
    if resolved.fate != Fate.BOUNDED or not resolved.period or kind_of(scene) != "orbit":
        return None
    momentum, apart, _, why, blocks = _along(scene, start, vectors, resolved.period)
    turn = np.array(blocks["attitude"][1:])
    if why is not None or np.linalg.norm(turn) < NO_TURN:
        return None
    pole = turn / np.linalg.norm(turn)
    ends, _, _, why, _ = _along(scene, start, vectors, resolved.period, pole=pole)
    begun = [math.acos(max(-1.0, min(1.0, float(sum(float(v) * p for v, p in zip(vector, pole))))))
             for vector in vectors]
    bounds = [pointing_bound(angle, *pair) for angle, pair in zip(begun, ends.tolist())]
    return (momentum, np.maximum(apart, bounds), ALL_TIME, "run", BY_TURN(time=Time(resolved.period))
            ) if why is None else None


def _ends(cone: Any, pairs: Any, exact: Exact3) -> tuple[float, float]:
    low, high = cone.cosines(pairs, exact)
    return math.acos(max(-1.0, min(1.0, high))), math.acos(max(-1.0, min(1.0, low)))


# --- Along a run
def _over_the_span(case: Any, vectors: Sequence[Exact3], start: Any) -> tuple[Any, ...]:
    if case.span is None or not case.span[1] > 0:
        raise InputError('angles: without a law for all times they hold for a span: give [motion] span, such '
                         'as span = [0, "10 min"]')
    until, scene = float(case.span[1]), case.scene
    left = time_left(scene)
    if left is None or left >= until:
        momentum, apart, reached, why, _ = _along(scene, start, vectors, until)
    else:  # to the end of an effect, and on from there
        momentum, apart, reached, why, blocks = _along(scene, start, vectors, left)
        if why is None:
            after, there = stopped(scene, {name: value for name, value in blocks.items()
                                           if name in scene.blocks})
            equations, row = equations_and_start(scene, _turning(start))
            later = _along(after, {**there, "attitude": blocks["attitude"]}, vectors, until - left,
                           row[slices(equations.blocks)["attitude"]])
            momentum = np.stack([np.minimum(momentum[:, 0], later[0][:, 0]),
                                 np.maximum(momentum[:, 1], later[0][:, 1])], axis=1)
            apart, reached, why = np.maximum(apart, later[1]), left + later[2], later[3]
    reason = BY_ROOTS.then(None if why is None else BROKE_OFF(why=why), ": ")
    return momentum, apart, OVER_SPAN(span=Times(0.0, reached)), "run", reason


def _turning(start: Any) -> dict[str, Any]:
    """The blocks of a start with an attitude."""
    return {"attitude": (1.0, 0.0, 0.0, 0.0), **start}


def _along(scene: AnyScene, start: Any, vectors: Sequence[Exact3], until: float, origin: Any = None,
           pole: np.ndarray | None = None) -> tuple[Any, ...]:
    """((axes, 2) angles to the momentum, (axes,) to the start, the time that was reached, why no farther or
    None, the blocks of the state there) along a run. origin: the attitude that the second are from; None:
    that of the start. pole: a direction in space in place of the momentum."""
    equations, state = equations_and_start(scene, _turning(start))
    at = slices(equations.blocks)
    origin = state[at["attitude"]] if origin is None else origin
    with np.errstate(all="ignore"):
        rates = to_numpy(equations)(state)
    units = units_of(equations, state)
    scale, scaled = scale_of(equations, units), in_units(equations, units)
    forms = form(scaled, (*scaled.rhs, *_slopes(scene, equations, scaled, scale, origin, vectors, pole)))
    begun = state / scale
    passed = zeros_passed(forms, begun, rates / scale / units.pace, float(units.times(until)), STEPS)
    states = np.concatenate([state[None], np.reshape(passed.states, (-1, len(state))) * scale,
                             np.asarray(passed.state)[None] * scale])
    momentum, apart = _angles(scene, equations, origin, states, vectors, pole)
    ends = np.stack([momentum.min(axis=0), momentum.max(axis=0)], axis=1)
    blocks = {name: states[-1][part] for name, part in at.items()}
    return ends, apart.max(axis=0), float(passed.t / units.pace), passed.reason, blocks


def _slopes(scene: AnyScene, equations: Equations, scaled: Equations, scale: np.ndarray, origin: np.ndarray,
            vectors: Sequence[Exact3], pole: np.ndarray | None) -> list[Any]:
    """Rates of the cosines of all angles, in the units of the scaled equations."""
    from sympy import Float, Rational, sqrt
    rational = lambda v: Rational(v.numerator, v.denominator)
    own = {x: Float(float(s)) * x
           for x, s in zip(equations.state, np.broadcast_to(scale, (len(equations.state),)))}
    law, at = Momentum.made(scene), slices(equations.blocks)
    H = law.components(equations.state[:3], {name: equations.state[part] for name, part in at.items()
                                             if name != "omega"}, rational)
    rows, size = rotation(equations.state[at["attitude"]]), sqrt(sum(v * v for v in H))
    first = to_space(origin, [[float(v) for v in vector] for vector in vectors])
    cosines = []
    for vector, begun in zip(vectors, first):
        axis = [rational(v) for v in vector]
        along_of = lambda direction, axis=axis: sum(
            Float(float(f)) * a * entry for f, row in zip(direction, rows) for a, entry in zip(axis, row))
        to_momentum = sum(a * v for a, v in zip(axis, H)) / size
        cosines += [to_momentum if pole is None else along_of(pole), along_of(begun)]
    return [scaled.derivative(cosine.xreplace(own)) for cosine in cosines]


def _angles(scene: AnyScene, equations: Equations, origin: np.ndarray, states: np.ndarray,
            vectors: Sequence[Exact3], pole: np.ndarray | None) -> tuple[np.ndarray, np.ndarray]:
    """(n, axes) angles of states (n, N) to the momentum, or a pole, and to the directions at an attitude."""
    law, at = Momentum.made(scene), slices(equations.blocks)
    columns = {name: states[:, part].T for name, part in at.items()}
    H = np.stack(law.components(columns.pop("omega"), columns, float), axis=1)
    momentum, apart = [], []
    for vector in vectors:
        axis = np.array([float(v) for v in vector])
        now, begun = to_space(states[:, at["attitude"]], axis), to_space(origin, axis)
        momentum.append(between(H, axis) if pole is None else between(now, pole))
        apart.append(between(now, begun))
    return np.stack(momentum, axis=1), np.stack(apart, axis=1)
