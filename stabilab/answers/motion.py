"""Everything about the motion from one state: fate, margins, period, extremes, invariants."""
from __future__ import annotations

import math
from dataclasses import replace

from ..asked import checked_scene, checked_span
from ..orbit.far_states import far_exponent, in_range, in_scene_unit, own
from ..orbit.extremes.one_state import extremes_of
from ..orbit.fate.one_state import fate_of
from ..orbit.invariants import invariants_of
from ..orbit.reduction import reduce
from ..orbit.result import Fate, Motion
from ..physics.state import three_floats


def motion(scene, state, span=None, brief=False, exact=None) -> Motion:
    """All that is known of the motion from `state` (three numbers in the scene's variables) at time 0.

    Where gamma is part of the state: six numbers (omega, gamma), or a dict of blocks. span: (from, to), the times over
    which extremes are searched where the motion is not integrable. brief: fate and extremes will do; what else costs
    time (period, margin_velocity, invariants) may be left out. exact: the three rates as they were given (Fractions), of
    which `state` is the rounding: where the motion has a reduction the answer is theirs. Raises InputError as `fate` does.
    """
    found = _found(checked_scene(scene), state, checked_span(span), brief, exact)
    if not scene.approximate or found.validity is not None:
        return found
    from ..physics.law_limits import of_motion
    return replace(found, validity=of_motion(scene, found))


def _found(scene, state, span, brief, exact) -> Motion:
    if not scene.plain:
        from ..unreduced.bounds import other_motion
        found = other_motion(scene, state, span, exact)
        if found is not None:
            return found
    state = three_floats(state)
    given = exact or state
    reduction = reduce(scene)
    if reduction is None:
        with in_range():
            return _irreducible(scene, state, span, exact)
    far = far_exponent(scene, given)
    if far is None:
        return _reduced(reduction, state, given, fate_of(scene, reduction, given), brief)
    near, small = own(reduction, given, far)
    return in_scene_unit(_reduced(near, tuple(map(float, small)), small, fate_of(scene, reduction, given, near, small), brief, far), far, state)


def _reduced(reduction, state, given, decided, brief, k=0) -> Motion:
    """All that is known of a motion with a reduction and this fate; the extremes in units 2^-k of the reduction's."""
    fields = _common(state, decided.label, decided.because, decided.axis, decided.sense)
    fields |= {"margin_energy": _finite(decided.margin), "tolerance": 1e-12,
               "extremes": extremes_of(reduction, given, decided.label, k)}
    return Motion(**fields, **({} if brief else _rest(reduction, state, given, decided)))


def _common(state, label, because, axis, sense) -> dict:
    if label == Fate.SPIN_UP and (axis or sense):
        because += f"; it spins up about axis {axis}" if axis else "; it spins up about the torque"
    return {"at": state, "fate": label, "because": because, "axis": axis, "sense": sense}


def _finite(value):
    return float(value) if math.isfinite(value) else None


def _rest(reduction, state, given, decided) -> dict:
    from ..orbit.period.one_state import period_of
    return {**_apart(reduction, state, given, decided), "period": _repeats(period_of(reduction, given, decided.label)),
            "invariants": invariants_of(reduction, given)}


def _apart(reduction, state, given, decided) -> dict:
    """The fields that tell the distance from the separatrix."""
    from ..orbit.separatrix.distance import distance_of
    if decided.label == Fate.SEPARATRIX or decided.margin == 0:
        return {"margin_velocity": 0.0, "velocity_bounds": (0.0, 0.0), "velocity_witness": state}
    found = distance_of(reduction, given)
    if not math.isfinite(found.upper):
        return {"velocity_because": found.because}
    return {"margin_velocity": found.value, "velocity_bounds": (found.lower, found.upper), "velocity_witness": found.witness,
            "velocity_because": found.because}


def _repeats(time):
    """The period, None where there is none (at rest, or a motion that does not repeat)."""
    return time if 0 < time < math.inf else None


def _pairs(array):
    return tuple((float(low), float(high)) for low, high in array)


def _irreducible(scene, state, span, exact) -> Motion:
    from ..unreduced.aligned import kind_of, one_fate
    kind = kind_of(scene)
    if kind == "law":
        return Motion(**_under_law(scene, state, span))
    decided = one_fate(scene, exact or state, kind)
    fields = _common(state, decided.label, decided.because, decided.axis, decided.sense)
    return Motion(**{**fields, **_other(scene, kind, state, exact or state, span, decided)})


def _other(scene, kind, state, given, span, decided) -> dict:
    """Fields for scenes without a reduction."""
    if kind == "turned":
        from ..unreduced.aligned import turned_extremes, turned_period
        time = turned_period(scene, given, decided.label)
        found = {"margin_energy": _finite(decided.margin), "period": _repeats(time)}
        if span is not None or decided.label == Fate.EQUILIBRIUM or _repeats(time) is not None:
            found["extremes"] = _pairs(turned_extremes(scene, given, decided.label, time, _length(span)))
        return found
    if decided.label == Fate.EQUILIBRIUM:
        return {"margin_energy": _finite(decided.margin), "extremes": tuple((v, v) for v in state)}
    if kind == "free":
        from ..unreduced.free_gyrostat import extremes_over_period
        closed = extremes_over_period(scene, given)
        return {"margin_energy": _finite(decided.margin), "extremes": _pairs(closed.extremes), "extremes_over": closed.over,
                "period": _repeats(closed.period)}
    found = _evidence(scene, state, span) if span is not None else {}
    if span is not None:
        found["because"] = decided.because + "; over the span its size went " + _size_words(found["evidence"])
    return found


def _length(span):
    return None if span is None else float(span[1])


def _evidence(scene, state, span) -> dict:
    from ..unreduced.off_axis import evidence
    seen = evidence(scene, state, (0.0, _length(span)))
    return {"extremes": _pairs(seen.extremes), "extremes_over": seen.extremes_over,
            "evidence": {"span": seen.span, "size_start": seen.size[0], "size_end": seen.size[1],
                         "size_largest": seen.size[2], "energy_start": seen.energy[0], "energy_end": seen.energy[1],
                         "energy_trend": seen.trend, "steps": seen.steps,
                         "invariant_drift": max(seen.drift.values(), default=0.0)}}


def _size_words(evidence) -> str:
    return (f"from {evidence['size_start']:.6g} to {evidence['size_end']:.6g} (largest {evidence['size_largest']:.6g}), "
            f"and its energy {evidence['energy_trend']}")


def _under_law(scene, state, span) -> dict:
    """All fields of a motion that an exact law keeps from being bounded."""
    from ..unreduced.growth import captured_fate
    found = captured_fate(scene, state)
    seen = _evidence(scene, state, span) if span is not None else {}
    known = {"certificate": found.certificate, "t_certificate": found.t_certificate, "release_time": found.release_time,
             "release_estimate": found.release_estimate, "steps": found.steps}
    return {**_common(state, found.fate, found.because, found.axis, found.sense), **seen, "because": found.because,
            "invariants": {"J": found.J0, "J_rate": found.J_rate}, "evidence": {**seen.get("evidence", {}), **known}}
