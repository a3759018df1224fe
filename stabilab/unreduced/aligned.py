"""A torque in the plane of two equal moments: the body turned so that the torque lies on an axis has an
orbit, or grows by law.

The twin's answers are those of the scene, given in the body's own axes; extremes of body components are roots
of their own rates.
"""
from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction

import numpy as np

from ..errors import InputError
from ..numbers.double_double import EPS
from ..orbit import extremes_arrays
from ..orbit.fate import Basis, OneFate, fate_of
from ..orbit.fate import at_rest as rest_of
from ..orbit.fate_arrays import FateResult, at_rest, in_chunks, write_row
from ..orbit.fate_arrays import fates as fates_on_orbit
from ..orbit.landscape import landscape
from ..orbit.one_orbit import Orbit
from ..orbit.one_state import apart_fields
from ..orbit.period import precise_period
from ..orbit.reduction import reduce
from ..orbit.result import NO_EXTREMES, Fate, Motion, Needs, finite, judged, pairs, repeats
from ..physics.coefficients import three_floats
from ..physics.scene import Scene, Turn, aligned, rests
from ..reasons import Sentence
from . import growth
from .evidence import extremes_over, seen_over
from .growth import captured_fate, unbounded
from .near_rest import beside_rest, small_loop

TURN_ROUNDINGS = 16  # units of rounding that turning a state costs: nine products and sums
NO_SPAN = Sentence(
    "span-needed-between-axes", "this motion does not repeat, and its torque acts between the axes: give "
    "span=T ({unit}), or a span in the case's [motion]")
PERIOD_TOO_LONG = Sentence("run-of-period-too-long", "none: a run of one period was too long")()
NOT_KNOWN = Sentence("distance-not-known", "not known: {why}")
TURN_SHARE = 1e-36  # of the energies: half the digits of a turn by irrational numbers


def motion(scene: Scene, state: np.ndarray | Sequence[float], span: Sequence[float] | None = None,
           exact: Sequence[Fraction] | None = None, needs: Needs = Needs.ALL) -> Motion:
    """See `answers.motion`; the extremes of a motion that does not repeat are over the span."""
    state = three_floats(state)
    supplied = exact or state
    orbit = twin_orbit(aligned(scene), supplied)
    decided = aligned_fate(scene, supplied, orbit)
    fields = {**judged(state, decided), "margin_energy": finite(decided.margin)}
    if not needs:
        return Motion(**fields)
    time = turned_period(orbit, decided.label)
    fields |= {"period": repeats(time), "returns": time}
    if decided.label == Fate.EQUILIBRIUM or repeats(time) is not None:
        box = turned_extremes(scene, supplied, decided.label, time, None)
        fields |= ({"extremes": pairs(box)} if np.isfinite(box).all()
                   else {"over": PERIOD_TOO_LONG})
    else:
        fields |= ({"over": NO_EXTREMES(why=NO_SPAN(unit=scene.time_unit))} if span is None
                   else seen_over(scene, state, span))
    return Motion(**fields, **(turned_apart(aligned(scene), orbit, state, decided)
                               if needs & Needs.DISTANCE else {}))


def twin_orbit(turn: Turn, state: Sequence[float | Fraction]) -> Orbit:
    """The orbit of the turned state; its reduction is None where the twin's motion grows by law."""
    return Orbit(reduce(turn.twin), turn(state))


def turned_apart(turn: Turn, orbit: Orbit, state: Sequence[float], decided: OneFate) -> dict:
    """The fields of a Motion that tell the distance from the separatrix: that of the twin, as a turn keeps
    distances."""
    if decided.label == Fate.UNDECIDED:
        return {"velocity_reason": NOT_KNOWN(why=decided.reason)}
    result = apart_fields(orbit, state, decided)
    witness = result.get("velocity_witness")
    if witness in (None, state):
        return result
    back = tuple(zip(*turn.rotation))  # the inverse of a rotation
    return (result
            | {"velocity_witness": tuple(float(sum(r * Fraction(v) for r, v in zip(row, witness)))
                                         for row in back)})


def aligned_fate(scene: Scene, state: Sequence[float | Fraction], orbit: Orbit) -> OneFate:
    """The fate of one state (floats or Fractions, taken exactly) with this orbit of its twin."""
    result = turned_fate(aligned(scene), state, orbit)
    return rest_of(scene, result) if rests(scene.quadratic(), state) else result


def turned_fate(turn: Turn, state: Sequence[float | Fraction], orbit: Orbit) -> OneFate:
    """Of the twin's motion, whose numbers are exact or good to 240 bits."""
    if orbit.reduction is None:  # a gyrostatic component stands along the torque
        return unbounded(captured_fate(turn.twin, tuple(map(float, orbit.state))))._replace(axis=0, sense=0)
    result = fate_of(turn.twin, orbit)
    speed = sum(float(v) ** 2 for v in state)
    scale = (max(map(float, turn.twin.body.exact)) * speed
             + max(abs(float(m)) for m in turn.twin.vector("constant_torque")))
    if not turn.exact and abs(result.margin) <= TURN_SHARE * scale:
        return OneFate(Fate.UNDECIDED, Basis.TURN_ROUNDS, math.nan)
    return result._replace(axis=0)  # the spin-up is about the torque's direction, not about a body axis


def fates(scene: Scene, states: np.ndarray, fast: bool | None = None) -> FateResult:
    """Fates of states (n, 3)."""
    return in_chunks(lambda rows, out: _label(scene, rows, out), states)


def _label(scene: Scene, states: np.ndarray, out: Mapping[str, np.ndarray]) -> int:
    """By the twin's formulas in doubles; in many digits where a change of the state in its last places, as
    the turn makes, could matter."""
    turn = aligned(scene)
    turned, land = states @ turn.matrix.T, landscape(turn.twin)
    result = _twin_fates(turn.twin, turned)
    for name in ("labels", "margins", "reasons", "sense"):
        out[name][:] = getattr(result, name)
    out["axis"][:] = 0
    if land is None:  # an exact law alone decides: there is no barrier to be near to
        out["sense"][:] = 0
        return 0
    step = TURN_ROUNDINGS * EPS * np.linalg.norm(states, axis=1)
    change = np.zeros(len(states))
    with np.errstate(invalid="ignore"):
        for i in range(3):
            moved = turned.copy()
            moved[:, i] += step
            change += np.abs(np.nan_to_num(_twin_fates(turn.twin, moved).margins - result.margins, nan=0.0,
                                           posinf=np.inf, neginf=np.inf))
    doubtful = (np.abs(result.margins) <= 2 * change) | land.nearly_flat(turned)
    for index in np.nonzero(doubtful)[0]:
        state = states[index].tolist()
        write_row(out, index, *turned_fate(turn, state, twin_orbit(turn, state)))
    at_rest(scene, states, out)
    return int(doubtful.sum())


def _twin_fates(twin: Scene, states: np.ndarray) -> FateResult:
    return growth.fates(twin, states) if landscape(twin) is None else fates_on_orbit(twin, states)


def extremes(scene: Scene, states: np.ndarray, span: Sequence[float] | None = None, fast: bool | None = None):
    """(n, 3, 2) over all time where the motion repeats, else over the span."""
    labels = fates(scene, states).labels
    times = turned_periods(scene, states, labels)
    return np.array([turned_extremes(scene, *item, span)
                     for item in zip(states, labels, times)]).reshape(-1, 3, 2)


def turned_extremes(scene, state, label, time, span):
    """(3, 2) extremes in a plane of equal moments of a motion with this label and period: roots of the body
    components' own rates over one period, or over the span."""
    if label == Fate.EQUILIBRIUM:
        return np.array([[float(v)] * 2 for v in state])
    form = scene.quadratic()
    if label == Fate.BOUNDED and beside_rest(form, state) and (loop := small_loop(form, state)):
        return np.array([[float(v) for v in pair] for pair in loop[1]])
    state = [float(v) for v in state]
    if label == Fate.BOUNDED and np.isfinite(time):
        return extremes_over(scene, state, 1.02 * time)
    if span is None:
        raise InputError(f"extremes: {NO_SPAN(unit=scene.time_unit)}")
    return extremes_over(scene, state, span)


def periods(scene: Scene, states: np.ndarray, fast: bool | None = None):
    """(n,); inf where the motion does not repeat, 0 at an equilibrium, NaN where it is undecided."""
    return turned_periods(scene, states, fates(scene, states).labels)


def turned_period(orbit: Orbit, label: Fate) -> float:
    """The period of one motion with this orbit of its twin; inf where it does not repeat, NaN where it is
    undecided."""
    if orbit.reduction is None:  # its momentum grows by law
        return 0.0 if label == Fate.EQUILIBRIUM else math.inf
    return precise_period(orbit, label)


def turned_periods(scene: Scene, states: np.ndarray, labels: np.ndarray):
    """(n,) the same of states with these labels."""
    turn = aligned(scene)
    if reduce(turn.twin) is None:
        return np.where(labels == Fate.EQUILIBRIUM, 0.0, np.inf)
    out, bounded = np.where(labels == Fate.EQUILIBRIUM, 0.0, np.inf), labels == Fate.BOUNDED
    # a state at rest, turned in doubles, hardly moves: a period that no number of bits finds
    if bounded.any():
        out[bounded] = extremes_arrays.periods(turn.twin, states[bounded] @ turn.matrix.T)
    return out
