"""Everything about the motion from one state: fate, margins, period, extremes, invariants."""
from __future__ import annotations

import numpy as np

from .extremes import extremes, period
from .fate import checked_states, fate
from .landscape import landscape
from .results import Fate, Motion


def motion(scene, state, span=None) -> Motion:
    """All that is known of the motion from `state` (three numbers in the scene's variables) at time 0.

    Where gamma is part of the state: six numbers (omega, gamma), or a dict of blocks. span: (from, to), the times over
    which extremes are searched where the motion is not integrable. Raises InputError as `fate` does.
    """
    if not scene.plain:
        from .other_motion import other_motion
        found = other_motion(scene, state, span)
        if found is not None:
            return found
    state = checked_states(state).reshape(3)
    decided = fate(scene, state)
    label = Fate(int(decided.labels))
    fields = {"at": tuple(map(float, state)), "fate": label, "because": decided.because, "axis": int(decided.axis),
              "sense": int(decided.sense)}
    if label == Fate.SPIN_UP:
        fields["because"] += f"; it spins up about axis {fields['axis']}" if fields["axis"] else "; it spins up about the torque"
    land = landscape(scene)
    if land is not None:
        return Motion(**fields, **_reduced(scene, land, state, decided, label))
    from .irreducible import kind_of
    return Motion(**{**fields, **_other(scene, kind_of(scene), state, span, label, decided)})


def _finite(value):
    return float(value) if np.isfinite(value) else None


def _reduced(scene, land, state, decided, label) -> dict:
    margin = _finite(decided.margins)
    time = float(period(scene, state))
    return {"margin_energy": margin, "margin_velocity": _finite(decided.velocity_margins),
            "period": time if 0 < time < np.inf else None,
            "extremes": _pairs(extremes(scene, state)), "invariants": invariants_at(land, state),
            "tolerance": 1e-12}


def _pairs(array):
    return tuple((float(low), float(high)) for low, high in array)


def invariants_at(land, state) -> dict[str, float]:
    """Q (the squared radius of the circle, or Z^2 - X^2 on a hyperbola) in canonical units, and the energy
    W^2/2 + V in the scene's, with the turn angle counted from the direction X = 0."""
    place, w, _ = land.start(np.asarray(state, float)[None])
    if land.e == 0:
        return {}
    pot, unit = land.potential, land.reduction.energy_unit
    g = land.reduction.constants
    x, z = place if land.e < 0 else (0.5 * (place[0] + place[1]), 0.5 * (place[0] - place[1]))
    with np.errstate(all="ignore"):
        theta = np.arctan2(x, z) if land.e < 0 else 0.5 * np.log(np.abs(place[0] / place[1]))
        energy = 0.5 * w * w - pot.mu * theta - 0.5 * pot.G * x * x - g["c"] * x - land.e * g["d"] * z
    found = {"Q": float(land.invariant(place)[0])}
    if np.isfinite(energy[0]):
        found["energy"] = float(energy[0] * unit)
    return found


def _other(scene, kind, state, span, label, decided) -> dict:
    """Fields for scenes without a reduction."""
    if kind == "turned":
        time = float(period(scene, state))
        found = {"margin_energy": _finite(decided.margins), "period": time if 0 < time < np.inf else None}
        if label == Fate.BOUNDED or span is not None:
            found["extremes"] = _pairs(extremes(scene, state, _length(span)))
        return found
    if kind == "free":
        from .offaxis import extremes_over_period
        closed = extremes_over_period(scene, state)
        return {"margin_energy": _finite(decided.margins), "extremes": _pairs(closed.extremes), "extremes_over": closed.over,
                "period": closed.period if 0 < closed.period < np.inf else None}
    if label == Fate.EQUILIBRIUM:
        return {"extremes": tuple((float(v), float(v)) for v in state)}
    found = _evidence(scene, state, span) if span is not None else {}
    if kind == "law":
        law = _law(scene, state)
        law["evidence"] = {**found.get("evidence", {}), **law["evidence"]}
        found.update(law)
    elif span is not None:
        found["because"] = decided.because + "; over the span its size went " + _size_words(found["evidence"])
    return found


def _length(span):
    return None if span is None else float(span[1])


def _evidence(scene, state, span) -> dict:
    from .offaxis import evidence
    seen = evidence(scene, state, (0.0, _length(span)))
    return {"extremes": _pairs(seen.extremes), "extremes_over": seen.extremes_over,
            "evidence": {"span": seen.span, "size_start": seen.size[0], "size_end": seen.size[1],
                         "size_largest": seen.size[2], "energy_start": seen.energy[0], "energy_end": seen.energy[1],
                         "energy_trend": seen.trend, "steps": seen.steps,
                         "invariant_drift": max(seen.drift.values(), default=0.0)}}


def _size_words(evidence) -> str:
    return (f"from {evidence['size_start']:.6g} to {evidence['size_end']:.6g} (largest {evidence['size_largest']:.6g}), "
            f"and its energy {evidence['energy_trend']}")


def _law(scene, state) -> dict:
    from .captured import captured_fate
    found = captured_fate(scene, state)
    return {"because": found.because, "fate": found.fate, "axis": found.axis, "sense": found.sense,
            "invariants": {"J": found.J0, "J_rate": found.J_rate},
            "evidence": {"certificate": found.certificate, "t_certificate": found.t_certificate,
                         "release_time": found.release_time, "release_estimate": found.release_estimate,
                         "steps": found.steps}}
