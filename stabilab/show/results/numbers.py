"""The numbers of a result with dimensions, units and words: for xarray, pandas and notebooks."""
from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from ...orbit.result import Fate
from ...packages import demand
from ...physics.scene import PARTS
from ..terminal.letters import MINUS
from .words import short

if TYPE_CHECKING:
    import pandas
    import xarray

MOST = 10  # rows of a page
EXPONENT = re.compile(r"(?<=\de)-(?=\d)")


@dataclass(frozen=True)
class Variables:
    """index: names of the dimensions that count times, states, equilibria; values: name -> (dimensions,
    array, attributes); coordinates: dimension -> (labels, attributes); attributes: of the whole."""

    index: tuple[str, ...]
    values: Mapping[str, tuple[tuple[str, ...], Any, dict[str, str]]]
    coordinates: Mapping[str, tuple[Any, dict[str, str]]] = field(default_factory=dict)
    attributes: Mapping[str, Any] = field(default_factory=dict)


def variables(result: Any) -> Variables:
    """Those of a result."""
    return OF[type(result).__name__](result)


def of_parts(parts: Mapping[str, Any], time: str = "time",
             errors: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Parts of the state over time, with units and words; time: the name of their first dimension; errors: of
    their components, where known."""
    known = errors or {}
    return {name: ((time, *_across(name, np.asarray(values))), np.asarray(values),
                   {"units": PARTS[name].unit or "1", "long_name": PARTS[name].words}
                   | ({"error": _in_a_row(known[name])} if name in known else {}))
            for name, values in parts.items()}


def _in_a_row(error: Any) -> Any:
    """As files take it: of a matrix row by row."""
    return np.ravel(error) if np.ndim(error) > 1 else error


def _across(name, values) -> tuple[str, ...]:
    if values.ndim == 3:
        return "inertial_axis", "axis"
    return () if values.ndim < 2 else ("axis",) if values.shape[-1] == 3 else (f"{name}_component",)


def _simulation(run):
    scaled = "x" in run.state
    notes = {f"departure_from_{name}": value for name, value in run.invariant_drift.items()}
    return Variables(("time",), of_parts(run.state, errors=run.error),
                     {"time": (run.t, {"units": "1" if scaled else "s"}), **AXIS},
                     {"model": run.model, "method": run.method, "status": run.status, "reason": run.reason}
                     | notes)


def _trajectory(run):
    """Of scaled scenes, too: a trajectory does not know its unit of time."""
    parts = of_parts({name: run.block(name) for name in run.blocks})
    plain = {name: (dims, values, {"long_name": words["long_name"]}) for name,
             (dims, values, words) in parts.items()}
    return Variables(("time",), plain, {"time": (run.t, {}), **AXIS},
                     {"method": run.method, "status": run.status, "reason": run.reason})


AXIS: dict[str, tuple[Any, dict[str, str]]] = {"axis": ([1, 2, 3], {"long_name": "principal axis"})}


def _dims(array) -> tuple[str, ...]:
    return ("state",) if array.ndim == 1 else tuple(f"state_{n + 1}" for n in range(array.ndim))


def _fates(found):
    dims, labels = _dims(found.labels), np.asarray(found.labels)
    rate, energy = ("1", "1") if found.scene.variables == "scaled" else ("rad/s", "J")
    rate, energy = {"units": rate}, {"units": energy}
    words = np.array([Fate(int(label)).word for label in labels.reshape(-1)],
                     dtype=object).reshape(labels.shape)
    values = {"start": ((*dims, "axis"), found.states, rate | {"long_name": "rates at t = 0"}),
              "fate": (dims, words, {}),
              "margin": (dims, found.margins,
                         energy | {"long_name": "height of the barrier ahead less the energy"}),
              "spin_axis": (dims, found.axis, {"long_name": "axis of a spin-up, else 0"}),
              "spin_direction": (dims, found.sense, {}),
              "level": (dims, np.asarray(found.levels, dtype=object),
                        {"long_name": "how well the fate is known"}),
              "because": (dims, np.asarray(found.because, dtype=object), {})}
    return Variables(dims, values, AXIS)


def _times(found):
    low = np.asarray(found.low)
    dims, states = _dims(low), np.asarray(found.states)
    unit = {"units": "1" if found.scene.variables == "scaled" else "s"}
    values = {"start": ((*dims, "axis" if states.shape[-1] == 3 else "component"), states, {}),
              "low": (dims, low, unit),
              "high": (dims, np.asarray(found.high), unit),
              "level": (dims, np.asarray(found.level, dtype=object), {}),
              "words": (dims, np.asarray(found.words, dtype=object), {})}
    return Variables(dims, values, AXIS if states.shape[-1] == 3 else {}, {"quantity": found.quantity})


def _equilibria(found):
    rows = ([("", p) for p in found.points]
            + [(curve.name, p) for curve in found.curves for p in curve.samples])
    at = np.array([p.at for _, p in rows], float).reshape(len(rows), -1)
    across = "axis" if at.shape[1] == 3 else "component"
    text = lambda values: (("point",), np.array(list(values), dtype=object), {})
    values = {"at": (("point", across), at,
                     {"long_name": "the equilibrium; of a curve, samples spread over every piece"}),
              "verdict": text(p.verdict for _, p in rows), "linear": text(p.linear for _, p in rows),
              "curve": text(name for name, _ in rows),
              "because": text(p.because for _, p in rows)}
    return Variables(("point",), values, AXIS if across == "axis" else {},
                     {"kind": found.kind, "reason": found.reason})


def _motion(m):
    pairs = m.extremes or ((None, None),) * 3
    ends = np.array([[np.nan if v is None else v for v in pair] for pair in pairs], float)
    values = {"start": (("axis",), np.array(m.at[:3], float), {}),
              "least": (("axis",), ends[:, 0], {"long_name": f"over {m.extremes_over}"}),
              "greatest": (("axis",), ends[:, 1], {"long_name": f"over {m.extremes_over}"})}
    notes = {"fate": m.fate.word, "level": m.level, "because": m.because, "spin_axis": m.axis,
             "spin_direction": m.sense, "margin_energy": m.margin_energy,
             "margin_rate": m.margin_velocity, "period": m.period, **m.invariants}
    if m.energy_integral is not None:
        notes |= {m.energy_integral.name: m.energy_integral.value,
                  f"{m.energy_integral.name}s": m.energy_integral.on_separatrix}
    return Variables(("axis",), values, AXIS,
                     {name: value for name, value in notes.items() if value is not None})


def _separatrix(found):
    rows = np.concatenate([np.full(s.points.shape[:2], n).reshape(-1)
                           for n, s in enumerate(found.branches, 1)]
                          or [np.zeros(0, int)])
    points = np.concatenate([s.points.reshape(-1, 3) for s in found.branches] or [np.zeros((0, 3))])
    residual = np.concatenate([s.residual.reshape(-1) for s in found.branches] or [np.zeros(0)])
    values = {"at": (("point", "axis"), points,
                     {"long_name": "a point of the separatrix, branch by branch and row by row"}),
              "branch": (("point",), rows, {}),
              "residual": (("point",), residual,
                           {"long_name": "distance from the surface in energy, relative"})}
    shapes = "; ".join(f"{s.name}: {s.points.shape[0]} x {s.points.shape[1]}" for s in found.branches)
    return Variables(("point",), values, AXIS, {"reason": found.reason, "grids": shapes})


def _comparison(found):
    text = lambda values: (("departure",), np.array(list(values), dtype=object), {})
    number = lambda values, words: (("departure",),
                                    np.array([np.nan if v is None else v for v in values], float),
                                    {"long_name": words})
    rows = found.departures
    firsts = {f"first_{100 * level:g}_percent": number([d.first[level] for d in rows],
                                                       f"time of the first error of {100 * level:g} % of the "
                                                       f"scale; NaN: none")
              for level in (rows[0].first if rows else ())}
    return Variables(("departure",),
                     {"model": text(d.model for d in rows), "part": text(d.part for d in rows),
                                      "largest": number([d.largest for d in rows],
                                                        "largest error while the model runs"),
                                      "scale": number([d.scale for d in rows],
                                                      "largest exact component over the span"), **firsts},
                     {}, {f"refused_{model}": why for model, why in found.refused.items()})


def _stuck(found):
    rows = found.rows
    text = lambda values: (("row",), np.array(list(values), dtype=object), {})
    number = lambda values, unit: (("row",), np.array([np.nan if v is None else v for v in values], float),
                                   {"units": unit})
    ends = [row.time_to_limit or (None, None) for row in rows]
    margins = {f"margin_{name}": number([row.margins[name].size if name in row.margins else None
                                         for row in rows], unit)
               for name, unit in (("rate", "rad/s"), ("wheel", "N m s"), ("torque", "N m"))}
    values = {"thrusters": text("+".join(row.thrusters) for row in rows),
              "fate": text(row.fate for row in rows), "level": text(row.level for row in rows),
              "spin_axis": number([row.axis or 0 for row in rows], "1"),
              "limit_low": number([low for low, _ in ends], "s"),
              "limit_high": number([high for _, high in ends], "s"),
              "largest_rate": number([row.largest_rate for row in rows], "rad/s"), **margins,
              "torque": (("row", "axis"), np.array([row.torque for row in rows], float),
                         {"units": "N m", "long_name": "in the frame of the file"}),
              "because": text(row.because for row in rows)}
    return Variables(("row",), values, {"axis": ([1, 2, 3], {"long_name": "axis of the file"})},
                     {"case": found.case})


def _spin_up(found):
    along = found.direction or (math.nan,) * 3
    values = {"state": (("axis",), np.array(found.state, float), {"long_name": "rates at time t"}),
              "direction": (("axis",), np.array(along, float),
                            {"long_name": "along which the rate grows; NaN: undecided"})}
    notes = {"fate": found.fate.word, "level": found.level, "spin_axis": found.axis,
             "spin_direction": found.sense, "t": found.t, "steps": found.steps,
             "cause": found.cause, "condition": found.condition}
    return Variables(("axis",), values, AXIS, notes)


def _attitude(found):
    values = {"start": (("axis",), np.array(found.at[:3], float), {"units": "rad/s"}),
              "momentum_direction": (("axis",), np.array(found.momentum_direction or (math.nan,) * 3, float),
                                     {"long_name": "unit vector along the angular momentum at the start"}),
              "turn_axis": (("axis",), np.array(found.turn_axis or (math.nan,) * 3, float),
                            {"long_name": "about which one rotation period turns the body"})}
    notes = {"fate": found.fate.word, "mode": found.mode, "momentum": found.momentum,
             "rotation_period": found.rotation_period, "precession_period": found.precession_period,
             "nutation_period": found.nutation_period, "lean": found.lean,
             "cone": found.cone, "turn_angle": found.turn_angle, "error": found.error,
             "because": found.because}
    return Variables(("axis",), values, AXIS,
                     {name: value for name, value in notes.items() if value is not None})


def _crossings(found):
    events = np.concatenate([np.full(len(row), n) for n, row in enumerate(found.t, 1)])
    values = {"event": (("zero",), events, {"long_name": "number of the event, in their order"}),
              "t": (("zero",), np.concatenate(found.t), {}),
              "error": (("zero",), np.concatenate(found.error), {"long_name": "of the time"}),
              "state": (("zero", "component"), np.concatenate(found.states), {})}
    return Variables(("zero",), values, {}, {"until": found.until, "status": found.status,
                                             "reason": found.reason})


def _chaos(found):
    labels = np.asarray(found.labels)
    dims, number = _dims(labels), lambda values, words: (_dims(labels), np.asarray(values, float),
                                                         {"long_name": words})
    words = np.array(found.orders, dtype=object).reshape(labels.shape)
    values = {"order": (dims, words, {}), "megno": number(found.megno, "MEGNO at the last time"),
              "lyapunov": number(found.lyapunov, "rate at which neighbours part"),
              "lyapunov_error": number(found.lyapunov_error, "how far it moved last")}
    return Variables(dims, values)


def _ensemble(found):
    last = found.states[:, -1]
    values = {"last": (("motion", "component"), last, {"long_name": "state at the last time"}),
              "reached": (("motion",), found.reached[:, -1],
                          {"long_name": "whether the motion went on so far"})}
    return Variables(("motion",), values, {}, {"method": found.method, "rtol": found.rtol})


def _diagram(found):
    number = lambda name: (("piece",), np.array([getattr(piece, name) for piece in found.pieces]), {})
    stable = [sum(state.verdict == "stable" for state in piece.states) for piece in found.pieces]
    values = {"low": number("low"), "high": number("high"), "equilibria": number("count"),
              "stable": (("piece",), np.array(stable), {})}
    return Variables(("piece",), values, {},
                     {"what": found.what,
                      "events": [event.value for event in (*found.events, *found.connections)]})


def _plane(found):
    number = lambda name: (("strip",), np.array([getattr(strip, name) for strip in found.strips]), {})
    counts = [", ".join(str(piece.count) for piece in strip.line.pieces) for strip in found.strips]
    values = {"low": number("low"), "high": number("high"),
              "equilibria": (("strip",), np.array(counts, dtype=object), {})}
    return Variables(("strip",), values, {},
                     {"what": found.what, "walls": [wall.value for wall in found.walls],
                      "cusps": len(found.cusps)})


OF: dict[str, Callable[[Any], Variables]] = {
    "Simulation": _simulation, "Trajectory": _trajectory, "FateResult": _fates, "TimeTo": _times,
    "Equilibria": _equilibria, "Motion": _motion, "Attitude": _attitude, "Crossings": _crossings,
    "Chaos": _chaos, "Diagram": _diagram, "Ensemble": _ensemble, "Plane": _plane,
    "Separatrix": _separatrix, "Comparison": _comparison, "Stuck": _stuck, "SpinUp": _spin_up}


def dataset(result: Any) -> xarray.Dataset:
    """The numbers of a result with their dimensions, units and words."""
    demand("xarray")
    import xarray
    found = variables(result)
    return xarray.Dataset(dict(found.values),
                          {name: ((name,), *one) for name, one in found.coordinates.items()},
                          dict(found.attributes))


def frame(result: Any) -> pandas.DataFrame:
    """The numbers of a result as a table; a column for every component, what belongs to the whole in `attrs`.
    """
    demand("pandas")
    import pandas
    found = variables(result)
    made = pandas.DataFrame({name: values for name, values in columns(found)}, index=_index(found))
    made.attrs = dict(found.attributes)
    return made


def columns(found: Variables) -> list[tuple[str, np.ndarray]]:
    """(name, values in one row of cells) of every component: "omega1", "omega2", ..."""
    rows = []
    for name, (dims, values, _) in found.values.items():
        array, own = np.asarray(values), dims[len(found.index):]
        if not own:
            rows.append((name, array.reshape(-1)))
            continue
        flat = array.reshape(-1, array.shape[-1] if name != "matrix" else 9)
        known = PARTS[name].components if name in PARTS else ()
        names = known if len(known) == flat.shape[1] else [f"{name}{n + 1}" for n in range(flat.shape[1])]
        rows += [(one, flat[:, n]) for n, one in enumerate(names)]
    return rows


def _index(found: Variables) -> Any:
    """Times or axes where they are known, else numbers; several dimensions of states as pandas counts them.
    """
    import pandas
    shape = next(iter(found.values.values()))[1].shape[:len(found.index)]
    if not found.index:
        return pandas.RangeIndex(1)
    if len(found.index) > 1:
        return pandas.MultiIndex.from_product([range(size) for size in shape], names=list(found.index))
    name, = found.index
    return pandas.Index(found.coordinates[name][0] if name in found.coordinates else range(shape[0]),
                        name=name)


def html(result: Any) -> str:
    """The line of a result, and its first rows; what is in it is text and never a tag."""
    found = variables(result)
    rows = columns(found)
    index = found.index[0] if len(found.index) == 1 else ""
    labels = found.coordinates[index][0] if index in found.coordinates else range(len(rows[0][1]))
    head = "".join(f"<th>{escape(name)}</th>" for name in (index, *(name for name, _ in rows)))
    number = len(rows[0][1])
    body = "".join(
        f"<tr><th>{_cell(labels[n])}</th>{''.join(f'<td>{_cell(values[n])}</td>' for _, values in rows)}</tr>"
        for n in range(min(MOST, number)))
    more = f"<p>and {number - MOST} more</p>" if number > MOST else ""
    return (
        f"<div><p><b>{_text(short(result))}</b></p><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{more}</div>")


def _cell(value: Any) -> str:
    return (f"{float(value) + 0.0:.6g}".replace("-", "−") if isinstance(value, (float, np.floating))
            else _text(str(value)))


def _text(words: str) -> str:
    """Words as text; the minus of a number as print has it, the hyphens of words as they are."""
    return escape(EXPONENT.sub("−", MINUS.sub("−", words)))
