"""The numbers of a result with their dimensions, units and words: what data sets, tables and pages are made of."""
from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...orbit.result import Fate
from ...physics.blocks import PARTS


@dataclass(frozen=True)
class Variables:
    """index: names of the dimensions that count times, states, equilibria; values: name -> (dimensions, array, attributes); coordinates:
    dimension -> (labels, attributes); attributes: of the whole."""

    index: tuple[str, ...]
    values: Mapping[str, tuple[tuple[str, ...], Any, dict[str, str]]]
    coordinates: Mapping[str, tuple[Any, dict[str, str]]] = field(default_factory=dict)
    attributes: Mapping[str, Any] = field(default_factory=dict)


def variables(result: Any) -> Variables:
    """Those of a result."""
    return OF[type(result).__name__](result)


def of_parts(parts: Mapping[str, Any], time: str = "time") -> dict[str, tuple[tuple[str, ...], Any, dict[str, str]]]:
    """Parts of the state over time, with units and words; time: the name of their first dimension."""
    return {name: ((time, _across(name, np.asarray(values)))[:np.ndim(values)], np.asarray(values),
                   {"units": PARTS[name].unit or "1", "long_name": PARTS[name].words}) for name, values in parts.items()}


def _across(name, values):
    return "axis" if values.ndim < 2 or values.shape[-1] == 3 else f"{name}_component"


def _simulation(run):
    scaled = "x" in run.state
    notes = {f"departure_from_{name}": value for name, value in run.invariant_drift.items()}
    return Variables(("time",), of_parts(run.state), {"time": (run.t, {"units": "1" if scaled else "s"}), **AXIS},
                     {"model": run.model, "method": run.method, "status": run.status, "reason": run.reason} | notes)


def _trajectory(run):
    """Of scaled scenes, too: a trajectory does not know its unit of time."""
    parts = of_parts({name: run.block(name) for name in run.blocks})
    plain = {name: (dims, values, {"long_name": words["long_name"]}) for name, (dims, values, words) in parts.items()}
    return Variables(("time",), plain, {"time": (run.t, {}), **AXIS}, {"method": run.method, "status": run.status, "reason": run.reason})


AXIS: dict[str, tuple[Any, dict[str, str]]] = {"axis": ([1, 2, 3], {"long_name": "principal axis"})}


def _dims(array) -> tuple[str, ...]:
    return ("state",) if array.ndim == 1 else tuple(f"state_{n + 1}" for n in range(array.ndim))


def _fates(found):
    dims, labels = _dims(found.labels), np.asarray(found.labels)
    rate, energy = ({"units": "1"}, {"units": "1"}) if found.scene.variables == "scaled" else ({"units": "rad/s"}, {"units": "J"})
    words = np.array([Fate(int(label)).word for label in labels.reshape(-1)], dtype=object).reshape(labels.shape)
    values = {"start": ((*dims, "axis"), found.states, rate | {"long_name": "rates at t = 0"}),
              "fate": (dims, words, {}), "margin": (dims, found.margins, energy | {"long_name": "height of the barrier ahead less the energy"}),
              "spin_axis": (dims, found.axis, {"long_name": "axis of a spin-up, else 0"}), "sense": (dims, found.sense, {}),
              "level": (dims, np.asarray(found.levels, dtype=object), {"long_name": "how well the fate is known"}),
              "because": (dims, np.asarray(found.because, dtype=object), {})}
    return Variables(dims, values, AXIS)


def _times(found):
    low = np.asarray(found.low)
    dims, states = _dims(low), np.asarray(found.states)
    unit = {"units": "1" if found.scene.variables == "scaled" else "s"}
    values = {"start": ((*dims, "axis" if states.shape[-1] == 3 else "component"), states, {}), "low": (dims, low, unit),
              "high": (dims, np.asarray(found.high), unit), "level": (dims, np.asarray(found.level, dtype=object), {}),
              "words": (dims, np.asarray(found.words, dtype=object), {})}
    return Variables(dims, values, AXIS if states.shape[-1] == 3 else {}, {"quantity": found.quantity})


def _equilibria(found):
    rows = [("", p) for p in found.points] + [(curve.name, p) for curve in found.curves for p in curve.samples]
    at = np.array([p.at for _, p in rows], float).reshape(len(rows), -1)
    across = "axis" if at.shape[1] == 3 else "component"
    text = lambda values: (("point",), np.array(list(values), dtype=object), {})
    values = {"at": (("point", across), at, {"long_name": "the equilibrium; of a curve, samples spread over every piece"}),
              "verdict": text(p.verdict for _, p in rows), "linear": text(p.linear for _, p in rows), "curve": text(name for name, _ in rows),
              "because": text(p.because for _, p in rows)}
    return Variables(("point",), values, AXIS if across == "axis" else {}, {"kind": found.kind, "reason": found.reason})


def _motion(m):
    pairs = m.extremes or ((None, None),) * 3
    ends = np.array([[np.nan if v is None else v for v in pair] for pair in pairs], float)
    values = {"start": (("axis",), np.array(m.at[:3], float), {}), "least": (("axis",), ends[:, 0], {"long_name": f"over {m.extremes_over}"}),
              "greatest": (("axis",), ends[:, 1], {"long_name": f"over {m.extremes_over}"})}
    notes = {"fate": m.fate.word, "level": m.level, "because": m.because, "spin_axis": m.axis, "sense": m.sense, "margin_energy": m.margin_energy,
             "margin_rate": m.margin_velocity, "period": m.period, **m.invariants}
    return Variables(("axis",), values, AXIS, {name: value for name, value in notes.items() if value is not None})


def _separatrix(found):
    rows = np.concatenate([np.full(s.points.shape[:2], n).reshape(-1) for n, s in enumerate(found.sheets, 1)] or [np.zeros(0, int)])
    points = np.concatenate([s.points.reshape(-1, 3) for s in found.sheets] or [np.zeros((0, 3))])
    residual = np.concatenate([s.residual.reshape(-1) for s in found.sheets] or [np.zeros(0)])
    values = {"at": (("point", "axis"), points, {"long_name": "a point of the separatrix, sheet by sheet and row by row"}),
              "sheet": (("point",), rows, {}), "residual": (("point",), residual, {"long_name": "distance from the surface in energy, relative"})}
    shapes = "; ".join(f"{s.name}: {s.points.shape[0]} x {s.points.shape[1]}" for s in found.sheets)
    return Variables(("point",), values, AXIS, {"reason": found.reason, "grids": shapes})


OF: dict[str, Callable[[Any], Variables]] = {
    "Simulation": _simulation, "Trajectory": _trajectory, "FateResult": _fates, "TimeTo": _times, "Equilibria": _equilibria, "Motion": _motion,
    "Separatrix": _separatrix}
