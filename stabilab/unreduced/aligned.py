"""Scenes without a reduction: what can still be said of the fate, extremes and period of their motions.

Three kinds: no torque and a gyrostatic moment with no zero component (closed orbits on the momentum sphere); a torque
along a principal axis with a gyrostatic component along it (unbounded by an exact law); a torque in the plane of two
equal moments (turned onto an axis); and a torque off the axes, where nothing is known and a run gives evidence.
"""
from __future__ import annotations

import math

import numpy as np

from ..errors import InputError
from ..physics.alignment import aligned
from ..orbit.far_states import in_range
from ..orbit.fate.arrays import at_rest, fate, nearly_flat, write_row
from ..physics.states import equilibrium_mask
from ..numbers.constants import EPS
from ..orbit.landscape import landscape
from .near_rest import beside_rest, small_loop
from ..orbit.fate.one_state import at_rest as rest_of, fate_of, free_fate, OneFate
from ..orbit.fate.reasons import Reason
from ..physics.quadratic import rests
from ..orbit.reduction import reduce
from ..orbit.result import Fate

TURN_ROUNDINGS = 16  # units of rounding that turning a state costs: nine products and sums
TURN_SHARE = 1e-36  # of the energies: half the digits of a turn by irrational numbers


def kind_of(scene) -> str:
    """"free", "law", "turned" or "off-axis" for a scene that has no reduction."""
    form = scene.quadratic()
    acting = [i for i in range(3) if form.m[i]]
    if not acting:
        return "free"
    if len(acting) == 1:
        return "law"
    return "turned" if aligned(scene) is not None else "off-axis"


def labeller(scene):
    """The chunk labeller of `fate` for such a scene with a torque; it returns how many states it decided in many digits."""
    kind = kind_of(scene)
    if kind == "turned":
        return lambda states, out: label_turned(scene, states, out)

    def label(states, out):
        with in_range():
            for index, state in enumerate(states):
                if kind == "law":
                    label_by_law(scene, state, out, index)
                else:
                    write_row(out, index, *one_fate(scene, state, kind))
        at_rest(scene, states, out)
        return 0
    return label


def one_fate(scene, state, kind) -> OneFate:
    """The fate of one state (floats or Fractions, taken exactly) of a scene of kind "free", "turned" or "off-axis"."""
    if kind == "off-axis":
        found = OneFate(Fate.UNDECIDED, Reason.OFF_AXIS, math.nan)
    elif kind == "turned":
        found = turned_fate(aligned(scene), state)
    else:
        found = free_fate(scene, state)
    return rest_of(scene, found) if rests(scene.quadratic(), state) else found


def turned_fate(turn, state) -> OneFate:
    """Of the twin's motion, whose numbers are exact or good to 240 bits."""
    reduction = reduce(turn.twin)
    if reduction is None:  # a gyrostatic component stands along the torque
        from .growth import captured_fate
        return _unbounded(captured_fate(turn.twin, tuple(map(float, turn(state)))))._replace(axis=0, sense=0)
    found = fate_of(turn.twin, reduction, turn(state))
    speed = sum(float(v) ** 2 for v in state)
    scale = max(map(float, turn.twin.body.exact)) * speed + max(abs(float(m)) for m in turn.twin.vector("constant_torque"))
    if not turn.exact and abs(found.margin) <= TURN_SHARE * scale:
        return OneFate(Fate.UNDECIDED, Reason.TURN_ROUNDS, math.nan)
    return found._replace(axis=0)  # the spin-up is about the torque's direction, not about a body axis


def label_turned(scene, states, out) -> int:
    """By the twin's formulas in doubles; in many digits where a change of the state in its last places, as the turn makes,
    could matter."""
    turn = aligned(scene)
    turned, land = states @ turn.matrix.T, landscape(turn.twin)
    result = fate(turn.twin, turned)
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
            change += np.abs(np.nan_to_num(fate(turn.twin, moved).margins - result.margins, nan=0.0, posinf=np.inf, neginf=np.inf))
    doubtful = (np.abs(result.margins) <= 2 * change) | nearly_flat(land, turned)
    for index in np.nonzero(doubtful)[0]:
        write_row(out, index, *turned_fate(turn, states[index].tolist()))
    at_rest(scene, states, out)
    return int(doubtful.sum())


def label_by_law(scene, state, out, index):
    from .growth import captured_fate
    write_row(out, index, *_unbounded(captured_fate(scene, state)))


def _unbounded(found) -> OneFate:
    """The fate that `captured` found under the law: unbounded, about an axis that may be undecided."""
    return OneFate(found.fate, Reason.UNBOUNDED_LAW, -math.inf, found.axis, found.sense)


def extremes_one_by_one(scene, states, span):
    """(n, 3, 2) extremes for scenes without a reduction; see `extremes.extremes`."""
    kind = kind_of(scene)
    if kind == "turned":
        labels = fate(scene, states).labels
        times = turned_periods(scene, states, labels)
        return np.array([turned_extremes(scene, *one, span) for one in zip(states, labels, times)]).reshape(-1, 3, 2)
    from .off_axis import evidence
    from .free_gyrostat import extremes_over_period
    rest = equilibrium_mask(scene, states)
    if span is None and kind != "free" and not rest.all():
        raise InputError("this scene has no reduction, so its extremes are searched over a time span: give span=T "
                         f"({scene.time_unit}), or a span in the case's [motion]")
    moving = (lambda s: extremes_over_period(scene, s)) if kind == "free" else lambda s: evidence(scene, s, span)
    return np.array([np.stack([s, s], axis=1) if still else moving(s).extremes for s, still in zip(states, rest)]).reshape(-1, 3, 2)


def turned_extremes(scene, state, label, time, span):
    """(3, 2) extremes in a plane of equal moments of a motion with this label and period: roots of the body components' own rates
    over one period, or over the span."""
    from .off_axis import evidence
    if label == Fate.EQUILIBRIUM:
        return np.array([[float(v)] * 2 for v in state])
    form = scene.quadratic()
    if label == Fate.BOUNDED and beside_rest(form, state) and (loop := small_loop(form, state)):
        return np.array([[float(v) for v in pair] for pair in loop[1]])
    state = [float(v) for v in state]
    if label == Fate.BOUNDED and np.isfinite(time):
        return evidence(scene, state, 1.02 * time).extremes
    if span is None:
        raise InputError("this motion does not repeat, and its torque acts between the axes: give span=T for its extremes")
    return evidence(scene, state, span).extremes


def turned_period(scene, state, label) -> float:
    """The period of one state (floats or Fractions); inf where the motion does not repeat."""
    from ..orbit.period.one_state import period_of
    turn = aligned(scene)
    return period_of(reduce(turn.twin), turn(state), label) if label == Fate.BOUNDED else 0.0 if label == Fate.EQUILIBRIUM else math.inf


def turned_periods(scene, states, labels):
    """(n,) the same of states with these labels."""
    from ..orbit.period.arrays import periods
    turn = aligned(scene)
    found = periods(turn.twin, states @ turn.matrix.T)  # turned in doubles: what is at rest hardly moves there
    return np.where(labels == Fate.EQUILIBRIUM, 0.0, np.where(labels == Fate.BOUNDED, found, np.inf))


def periods_one_by_one(scene, states):
    """(n,) periods for scenes without a reduction: from one return of a free motion; inf for unbounded ones."""
    kind = kind_of(scene)
    if kind == "turned":
        return turned_periods(scene, states, fate(scene, states).labels)
    rest = equilibrium_mask(scene, states)
    if kind == "free":
        from .free_gyrostat import extremes_over_period
        return np.array([0.0 if still else extremes_over_period(scene, s).period for s, still in zip(states, rest)])
    return np.where(rest, 0.0, np.inf)
