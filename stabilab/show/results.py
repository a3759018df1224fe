"""Results as they show themselves: in a line, in a notebook, and as numbers for xarray and pandas."""
from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import InputError
from ..numbers.principal import PrincipalAxes, oblique
from ..orbit.result import Fate, Motion
from ..packages import demand
from ..physics.scene import PARTS
from ..reasons import number
from ..representation import values_of
from .axes import direction
from .names import spare
from .terminal import minus, some

if TYPE_CHECKING:
    import pandas
    import xarray

    from ..equilibrium.result import Equilibria

MAX_ROWS = 10  # rows of a page


@dataclass(frozen=True)
class Variables:
    """index: names of the dimensions that count times, states, equilibria; values: name -> (dimensions,
    array, attributes); coordinates: dimension -> (labels, attributes); attributes: of the whole."""

    index: tuple[str, ...]
    values: Mapping[str, tuple[tuple[str, ...], Any, dict[str, str]]]
    coordinates: Mapping[str, tuple[Any, dict[str, str]]] = field(default_factory=dict)
    attributes: Mapping[str, Any] = field(default_factory=dict)


AXIS: dict[str, tuple[Any, dict[str, str]]] = {"axis": ([1, 2, 3], {"long_name": "principal axis"})}


def variables(result: Equilibria | Motion, frame: str = "file") -> Variables:
    """Those of a result, with what limits the whole answer, and of a full tensor the principal axes, among
    the attributes. frame: as of `Shown.to_xarray`."""
    if frame not in FRAMES:
        raise InputError(f'frame: expected "file" or "principal", got {frame!r:.40}')
    out = KINDS[type(result).__name__][1](result)
    caveats = "; ".join(item.words for item in getattr(result, "caveats", ()))
    attributes = {**out.attributes, **({"caveats": caveats} if caveats else {})}
    axes = oblique(getattr(getattr(result, "case", result), "frame", None))
    if axes is None:
        return replace(out, attributes=attributes)
    turning = frame == "file" and type(result).__name__ in IN_FILE
    return replace(in_file(out, axes) if turning else out,
                   attributes=attributes | frame_attributes(axes, turning))


def short(result: Equilibria | Motion) -> str:
    """The line of a result: its kind, what it answers in a few words, and all that limits the answer."""
    name = type(result).__name__
    limits = (item.words for item in getattr(result, "caveats", ()))
    return f"{name}({'; '.join([KINDS[name][0](result), *limits])})"


# --- In the frame of the file
FRAMES = ("file", "principal")
IN_FILE = ("Simulation", "Equilibria", "Motions")  # whose vectors turn; boxes of extremes do not
FILE_AXES = {"axis": (["x", "y", "z"], {"long_name": "axis of the file"})}
BODILY = ("omega", "gamma", "damper", "wheel", "start", "at")  # vectors, or several in a row
INERTIAL = ("momentum", "velocity", "position")


def frame_attributes(axes: PrincipalAxes, turned: bool) -> dict[str, Any]:
    """Which frame vectors are in, and where the principal axes lie in that of the file, row by row."""
    return {"frame": "file" if turned else "principal",
            "principal_axes": [float(v) for axis in axes.axes for v in axis],
            "principal_axes_of": "rows: principal axes 1, 2, 3 in the frame x, y, z of the file"}


def in_file(result: Variables, axes: PrincipalAxes) -> Variables:
    """The vectors of the body in the frame of the file; axes: the principal axes there."""
    matrix = matrix_of(axes)
    values = {name: (tuple("inertial_axis" if name in INERTIAL and dim == "axis" else dim for dim in dims),
                     turned_to_file(name, np.asarray(item), matrix), text)
              for name, (dims, item, text) in result.values.items()}
    coordinates = {name: coordinate for name, coordinate in result.coordinates.items() if name != "axis"}
    return replace(result, values=values, coordinates=coordinates | FILE_AXES)


def matrix_of(axes: PrincipalAxes) -> np.ndarray:
    """(3, 3): the principal axes in the frame of the file, a row each."""
    return np.array([[float(v) for v in axis] for axis in axes.axes])


def turned_to_file(name: str, values: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """A part of the state along the principal axes, the rows of `matrix`, in the frame of the file: of a
    vector w matrix^T w, of an attitude R (from the body to space) R matrix."""
    if name in BODILY:
        return np.concatenate([values[..., n:n + 3] @ matrix for n in range(0, values.shape[-1], 3)], axis=-1)
    if name == "matrix":
        return values @ matrix
    return _times(values, _quaternion(matrix)) if name == "quaternion" else values


def _times(values: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Products of quaternions (n, 4) with another, scalar last."""
    x, y, z, w = np.moveaxis(values, -1, 0)
    a, b, c, d = other
    return np.stack([w * a + x * d + y * c - z * b, w * b - x * c + y * d + z * a,
                     w * c + x * b - y * a + z * d, w * d - x * a - y * b - z * c], axis=-1)


def _quaternion(m: np.ndarray) -> np.ndarray:
    """Scalar last, of a rotation matrix: the last eigenvector of Bar-Itzhack's matrix."""
    sides = m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]
    k = np.zeros((4, 4))
    k[:3, :3], k[:3, 3], k[3, :3] = m + m.T - np.trace(m) * np.eye(3), sides, sides
    k[3, 3] = np.trace(m)
    result = np.linalg.eigh(k)[1][:, -1]
    return result if result[3] >= 0 else -result


# --- Cells and words that the kinds below have in common
def _texts(dims: tuple[str, ...], values: Iterable[Any], **text: str):
    return dims, np.array(list(values), dtype=object), text


def _numbers(dims: tuple[str, ...], values: Iterable[Any], **text: str):
    """Numbers, NaN for None."""
    return dims, np.array([np.nan if v is None else v for v in values], float), text


def _along_axes(values: Sequence[float], **text: str):
    """A vector along the principal axes, NaN where there is none."""
    return ("axis",), np.array(values or (math.nan,) * 3, float), text


def _known(notes: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in notes.items() if value is not None}


def _dims(array) -> tuple[str, ...]:
    return ("state",) if array.ndim == 1 else tuple(f"state_{n + 1}" for n in range(array.ndim))


def _named(text: str, value: float | None, side: int = 0):
    return "" if value is None else f"{text} {number(value, 6, side)}"


def _shares(text):
    return ", ".join(f"{number} {word}" for word, number in Counter(text).items())


def _about(result: Motion) -> str:
    return f" about axis {result.axis}, {direction(result.sense)}" if result.axis else ""


# --- Each kind of result: its line, its numbers
def of_parts(parts: Mapping[str, Any], time: str = "time",
             errors: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Parts of the state over time, with units and words; time: the name of their first dimension; errors: of
    their components, where known, of a matrix row by row as files take it."""
    resolved = errors or {}
    return {name: ((time, *_across(name, np.asarray(values))), np.asarray(values),
                   {"units": PARTS[name].unit or "1", "long_name": PARTS[name].description}
                   | ({"error": np.ravel(resolved[name]) if np.ndim(resolved[name]) > 1 else resolved[name]}
                      if name in resolved else {}))
            for name, values in parts.items()}


def _across(name: str, values: np.ndarray) -> tuple[str, ...]:
    if values.ndim == 3:
        return "inertial_axis", "axis"
    return () if values.ndim < 2 else ("axis",) if values.shape[-1] == 3 else (f"{name}_component",)


def _run_words(run, parts, method):
    span = f", {run.t[0]:.6g} to {run.t[-1]:.6g}" if len(run.t) else ""
    return (f"{some(len(run.t), 'time')}{span}; {', '.join(parts)}; {method}, "
            f"{run.status if run.status == 'reached' else run.because}")


def _simulation_words(run):
    return _run_words(run, run.state, f"{run.model}, {run.method}" if run.model != "exact" else run.method)


def _simulation(run):
    notes = {f"departure_from_{name}": value for name, value in run.invariant_drift.items()}
    return Variables(("time",), of_parts(run.state, errors=run.error),
                     {"time": (run.t, {"units": "1" if "x" in run.state else "s"}), **AXIS},
                     values_of(run, "model method status") | {"reason": run.because} | notes)


def _trajectory_words(run):
    return _run_words(run, run.blocks, run.method)


def _trajectory(run):
    """Of scaled scenes, too: a trajectory does not know its unit of time."""
    parts = of_parts({name: run.block(name) for name in run.blocks})
    plain = {name: (dims, values, {"long_name": text["long_name"]})
             for name, (dims, values, text) in parts.items()}
    return Variables(("time",), plain, {"time": (run.t, {}), **AXIS},
                     values_of(run, "method status") | {"reason": run.because})


def _fates_words(result):
    phrases = [Fate(int(label)).word for label in result.labels.reshape(-1)]
    return (f"{phrases[0]}: {result.because}" if result.labels.ndim == 0
            else f"{some(len(phrases), 'state')}: {_shares(phrases)}")


def _fates(result):
    dims, labels = _dims(result.labels), np.asarray(result.labels)
    rate, energy = ("1", "1") if result.scene.variables == "scaled" else ("rad/s", "J")
    text = np.array([Fate(int(label)).word for label in labels.reshape(-1)],
                     dtype=object).reshape(labels.shape)
    rates = result.states.shape[-1] == 3
    start = ("axis", {"units": rate, "long_name": "rates at t = 0"}) if rates else (
        "component", {"long_name": "state at t = 0, its parts in a row"})
    values = {"start": ((*dims, start[0]), result.states, start[1]),
              "fate": (dims, text, {}),
              "margin": (dims, result.margins,
                         {"units": energy, "long_name": "height of the barrier ahead less the energy"}),
              "spin_axis": (dims, result.axis, {"long_name": "axis of a spin-up, else 0"}),
              "sense": (dims, result.sense, {}),
              "level": (dims, np.asarray(result.levels, dtype=object),
                        {"long_name": "how well the fate is known"}),
              "because": (dims, np.asarray(result.because, dtype=object), {})}
    return Variables(dims, values, AXIS if rates else {})


def _motions_words(result):
    if not result.one:
        return _fates_words(result)
    motion = result.judged
    resolved = "" if motion.level == "undecided" else f"{motion.fate.word}{_about(motion)}, {motion.level}: "
    return resolved + motion.because


def _values_words(result):
    printed = f" {result.unit}".rstrip()
    if not result.answer.one:
        return f"{result.name}{printed and ','}{printed}: {result.values}"
    if result.missing:
        return f"{result.name}: {result.missing}"
    over = f" over {result.over}" if result.over else ""
    numbers = f"{result.values:.9g}" if result.decimals is None and result.values.ndim == 0 else str(result)
    return f"{result.name}{over}: {numbers}{printed}"


def _values(result):
    dims, unit = _dims(result.states[..., 0]), {"units": result.unit or "1"}
    start = {"start": ((*dims, "axis" if result.states.shape[-1] == 3 else "component"), result.states, {})}
    axes = AXIS if result.states.shape[-1] == 3 or result.name == "extremes" else {}
    if result.name == "period":
        return Variables(dims, start | {"period": (dims, result.values, unit)}, axes, _of_answer(result))
    ends = {name: ((*dims, "axis"), result.values[..., n], unit | {"long_name": f"over {result.over}"})
            for n, name in enumerate(("least", "greatest"))}
    return Variables(dims, start | ends, AXIS, _of_answer(result))


def _of_answer(result) -> dict[str, Any]:
    """What belongs to a whole answer."""
    item = result.level if isinstance(result.level, str) else None
    return _known({"level": item, "reason": result.reason if item else None})


def _time_to_words(result):
    low, high = result.low, result.high
    if getattr(low, "ndim", 0):
        levels = _shares(map(str, result.level.reshape(-1)))
        return f"{result.quantity}: {some(low.size, 'state')}, {levels}"
    when = ("never" if low == math.inf else f"not before {number(low, 6, -1)}" if math.isnan(high)
            else f"{number(low, 9, -1)} to {number(high, 9, 1)}")
    return f"{result.quantity}: {when}, {result.level}"


def _time_to(result):
    low = np.asarray(result.low)
    dims, states = _dims(low), np.asarray(result.states)
    unit = {"units": "1" if result.scene.variables == "scaled" else "s"}
    values = {"start": ((*dims, "axis" if states.shape[-1] == 3 else "component"), states, {}),
              "low": (dims, low, unit),
              "high": (dims, np.asarray(result.high), unit),
              "level": (dims, np.asarray(result.level, dtype=object), {}),
              "words": (dims, np.asarray(result.words, dtype=object), {})}
    return Variables(dims, values, AXIS if states.shape[-1] == 3 else {}, {"quantity": result.quantity})


def _equilibria_words(result: Equilibria):
    pieces = [segment.verdict for curve in result.curves for segment in curve.segments]
    printed = [f"{some(len(result.points), 'point')} ({_shares(p.verdict for p in result.points)})"
            if result.points else "",
            f"{some(len(result.curves), 'curve')}, their pieces: {_shares(pieces)}" if result.curves
            else ""]
    return "; ".join([result.kind, *filter(None, printed)])


def _equilibria(result: Equilibria):
    rows = ([("", p) for p in result.points]
            + [(curve.name, p) for curve in result.curves for p in curve.samples])
    at = np.array([p.at for _, p in rows], float).reshape(len(rows), len(rows[0][1].at) if rows else 3)
    across = "axis" if at.shape[1] == 3 else "component"
    of = {name: _texts(("point",), (getattr(p, name) for _, p in rows))
          for name in ("verdict", "linear", "because")}
    values = {"at": (("point", across), at,
                     {"long_name": "the equilibrium; of a curve, samples spread over every piece"}),
              "verdict": of["verdict"], "linear": of["linear"],
              "curve": _texts(("point",), (name for name, _ in rows)), "because": of["because"]}
    return Variables(("point",), values, AXIS if across == "axis" else {},
                     {"kind": result.kind, "reason": result.because})


def _motion_words(m: Motion):
    parts = [m.fate.word + _about(m) + ("" if m.level in ("exact", "undecided") else f", {m.level}"),
             _named("margin in energy", m.margin_energy),
             _named("in rate", m.margin_velocity, -bool(m.velocity_reason)), _named("period", m.period),
             "" if m.extremes is None else f"extremes over {m.extremes_over}"]
    return "; ".join(filter(None, parts))


def _motion(m: Motion):
    over = {"long_name": f"over {m.extremes_over}"}
    values = {"start": _along_axes(m.at[:3])} | {
        name: _numbers(("axis",), (pair[end] for pair in m.extremes or ((None, None),) * 3), **over)
        for end, name in enumerate(("least", "greatest"))}
    notes = {"fate": m.fate.word, "spin_axis": m.axis, "margin_rate": m.margin_velocity, **m.invariants
             } | values_of(m, "level because sense margin_energy period")
    if m.energy_integral is not None:
        notes |= {m.energy_integral.name: m.energy_integral.value,
                  f"{m.energy_integral.name}s": m.energy_integral.on_separatrix,
                  "turned_about": m.energy_integral.turned_about}
    return Variables(("axis",), values, AXIS, _known(notes))


def _ending_words(out):
    turn = f" about {'+' if out.sense > 0 else '-'}axis {out.axis}" if out.sense else ""
    return "; ".join(filter(None, (out.kind + turn, _named("rate", out.rate),
                                   *(f"{name} at {time.at:.6g}" for name, time in out.times), out.level)))


def _ending(result):
    values = {"rates": _along_axes(result.rates, units="rad/s", long_name="rates in the end")}
    notes = {name: time.at for name, time in result.times}
    return Variables(("axis",), values, AXIS, _known(notes | values_of(
        result, "kind level because sense rate within nutation growth decay at_the_latest estimate")
        | {"spin_axis": result.axis}))


def _flat_spin_words(result):
    times = ((name, getattr(result, name)) for name in ("leaves", "crosses", "settles", "tenth"))
    printed = [f"{name} at {time.at:.6g}" for name, time in times if time]
    return "; ".join([result.outcome, *printed, result.level])


def _flat_spin(result):
    values = {"down": _numbers(("span",), (span.down for span in result.spans)),
              "up": _numbers(("span",), (span.up for span in result.spans)),
              "name": _texts(("span",), (span.name for span in result.spans))}
    notes = {name: time.at for name in ("leaves", "crosses", "settles", "tenth")
             if (time := getattr(result, name)) is not None}
    return Variables(("span",), values, {}, _known(notes | values_of(
        result, "outcome level because axis minor momentum final_rate energy final_energy within nutation "
               "growth decay steps")))


def _rotations_words(result):
    count = some(len(result.rotations), "rotation")
    return f"{count} at |H| = {result.momentum:.6g}; {result.stable} stable with losses"


def _gyrostat_spin_words(result):
    times = ((name, getattr(result, name)) for name in ("crosses", "settles", "tenth"))
    printed = [f"{name} at {time.at:.6g}" for name, time in times if time]
    rates = [] if result.rates is None else [f"at ({', '.join(f'{v:.6g}' for v in result.rates)})"]
    return "; ".join([" ".join([result.outcome, *rates]), *printed, result.level])


def _rotations(result):
    dims, rows = ("rotation",), result.rotations
    along = lambda name, **notes: (
        ("rotation", "axis"), np.array([getattr(row, name) for row in rows]), notes)
    values = {"rates": along("rates", units="rad/s", long_name="rates of a rotation"),
              "momentum": along("momentum", units="N m s", long_name="angular momentum in the body"),
              "energy": _numbers(dims, (row.energy for row in rows), units="J"),
              **{name: _texts(dims, (getattr(row, name) for row in rows))
                 for name in ("nature", "with_losses", "without_losses")},
              **{name: _numbers(dims, (getattr(row, name) for row in rows), units="s")
                 for name in ("growth", "decay")}}
    notes = {"size": result.momentum, "because": result.because}
    if result.threshold is not None:
        notes |= {f"threshold_{name}": value
                  for name, value in values_of(result.threshold, "factor moment").items()}
    if hasattr(result, "outcome"):
        notes |= values_of(result, "outcome level end energy final_energy barrier within steps")
        notes |= {name: time.at for name in ("crosses", "settles", "tenth")
                  if (time := getattr(result, name)) is not None}
    return Variables(dims, values, AXIS, _known(notes))


def _rotation_diagram_words(result):
    counts = ", ".join(str(piece.stable) for piece in result.pieces)
    return f"{some(len(result.pieces), 'piece')} over {result.span.key.name}; that attract: {counts}"


def _rotation_diagram(result):
    dims, rows = ("piece",), result.pieces
    values = {name: _numbers(dims, (getattr(row, name) for row in rows)) for name in ("low", "high")}
    values |= {name: _numbers(dims, (row.natures.get(name, 0) for row in rows))
               for name in ("minimum", "saddle", "maximum")}
    return Variables(dims, values, {}, _known({
        "key": result.span.key.name, "size": result.momentum, "rate": result.rate,
        "changes": [float(value) for value in result.changes], "because": result.because}))


def _top_diagram_words(result):
    phrases = ", ".join("stable" if piece.stable("upright") else "unstable" for piece in result.pieces)
    return f"{some(len(result.pieces), 'piece')} over {result.span.key.name}; upright {phrases}"


def _top_diagram(result):
    dims, rows = ("piece",), result.pieces
    values = {name: _numbers(dims, (getattr(row, name) for row in rows)) for name in ("low", "high")}
    values |= {family: _numbers(dims, (float(row.stable(family)) for row in rows))
               for family in ("upright", "hanging")}
    values |= {name: _numbers(dims, (sum(state.leaning and state.stable is stable for state in row.states)
                                     for row in rows))
               for name, stable in (("leaning_stable", True), ("leaning_unstable", False))}
    return Variables(dims, values, {}, _known({
        "key": result.span.key.name, "changes": [float(value) for value in result.changes],
        "because": result.because}))


def _separatrix_words(result):
    return ("; ".join(f"{s.name}, {s.points.shape[0]} x {s.points.shape[1]} points" for s in result.branches)
            or f"no branches: {result.because}")


def _separatrix(result):
    rows = np.concatenate([np.full(s.points.shape[:2], n).reshape(-1)
                           for n, s in enumerate(result.branches, 1)]
                          or [np.zeros(0, int)])
    points = np.concatenate([s.points.reshape(-1, 3) for s in result.branches] or [np.zeros((0, 3))])
    residual = np.concatenate([s.residual.reshape(-1) for s in result.branches] or [np.zeros(0)])
    values = {"at": (("point", "axis"), points,
                     {"long_name": "a point of the separatrix, branch by branch and row by row"}),
              "sheet": (("point",), rows, {}),
              "residual": (("point",), residual,
                           {"long_name": "distance from the surface in energy, relative"})}
    shapes = "; ".join(f"{s.name}: {s.points.shape[0]} x {s.points.shape[1]}" for s in result.branches)
    return Variables(("point",), values, AXIS, {"reason": result.because, "grids": shapes})


def _comparison_words(result):
    worst = {}
    for d in result.departures:
        fraction = d.largest / d.scale if d.scale else math.inf if d.largest else 0.0
        worst[d.model] = max(worst.get(d.model, 0.0), fraction)
    models = ([f"{model} {value:.2g}" for model, value in worst.items()]
              + [f"{model} refused" for model in result.refused])
    return (f"{some(len(result.t), 'time')}; largest error of a part's size: "
            f"{', '.join(models) or 'no model'}")


def _comparison(result):
    dims, rows = ("departure",), result.departures
    firsts = {f"first_{100 * level:g}_percent":
              _numbers(dims, (d.first[level] for d in rows),
                       long_name=f"time of the first error of {100 * level:g} % of the scale; NaN: none")
              for level in (rows[0].first if rows else ())}
    values = {"model": _texts(dims, (d.model for d in rows)), "part": _texts(dims, (d.part
              for d in rows)), "largest": _numbers(dims, (d.largest for d in rows),
                                  long_name="largest error while the model runs"),
              "scale": _numbers(dims, (d.scale for d in rows),
                                long_name="largest exact component over the span"), **firsts}
    return Variables(dims, values, {}, {f"refused_{model}": why for model, why in result.refused.items()})


def _stuck_words(result):
    spare([result.case, *(name for row in result.rows for name in row.thrusters)])
    head = result.rows[0]
    low, high = head.time_to_limit or (None, None)
    when = ("" if low is None else f", limit in {low:.6g} s" if f"{low:.6g}" == f"{high:.6g}"
            else f", limit in {number(low, 6, -1)} to {number(high, 6, 1)} s")
    first = (f"{' and '.join(head.thrusters) or 'torque'}: "
             f"{head.fate}{f' about axis {head.axis}' if head.axis else ''}{when}")
    return (first if len(result.rows) == 1
            else f"{some(len(result.rows), 'row')} ({_shares(row.fate for row in result.rows)}), the first "
                 f"{first}")


def _stuck(result):
    dims, rows = ("row",), result.rows
    ends = [row.time_to_limit or (None, None) for row in rows]
    margins = {f"margin_{name}": _numbers(dims, (row.margins[name].size if name in row.margins else None
                                                 for row in rows), units=unit)
               for name, unit in (("rate", "rad/s"), ("wheel", "N m s"), ("torque", "N m"))}
    values = {"thrusters": _texts(dims, ("+".join(row.thrusters)
              for row in rows)), "fate": _texts(dims, (row.fate for row in rows)),
              "level": _texts(dims, (row.level
              for row in rows)), "spin_axis": _numbers(dims, (row.axis or 0 for row in rows), units="1"),
              "limit_low": _numbers(dims, (low for low, _ in ends), units="s"),
              "limit_high": _numbers(dims, (high for _, high in ends), units="s"),
              "largest_rate": _numbers(dims, (row.largest_rate for row in rows), units="rad/s"), **margins,
              "torque": (("row", "axis"), np.array([row.torque for row in rows], float),
                         {"units": "N m", "long_name": "in the frame of the file"}),
              "because": _texts(dims, (row.because for row in rows))}
    return Variables(dims, values, {"axis": ([1, 2, 3], {"long_name": "axis of the file"})},
                     {"case": result.case})


def _spin_up_words(result):
    return (f"{result.fate.word}{_about(result)}, {result.level}; t = {result.t:.6g}, "
            f"{some(result.steps, 'step')}")


def _spin_up(result):
    values = {"state": _along_axes(result.state, long_name="rates at time t"),
              "direction": _along_axes(result.direction,
                                       long_name="along which the rate grows; NaN: undecided")}
    notes = {"fate": result.fate.word, "spin_axis": result.axis}
    return Variables(("axis",), values, AXIS,
                     notes | values_of(result, "level sense t steps cause condition"))


def _attitude_words(result):
    parts = [result.mode or result.fate.word, _named("rotation period", result.rotation_period),
             _named("nutation period", result.nutation_period),
             _named("precession period", result.precession_period)]
    return "; ".join(filter(None, parts))


def _attitude(result):
    values = {"start": _along_axes(result.at[:3], units="rad/s"),
              "momentum_direction": _along_axes(
                  result.momentum_direction, long_name="unit vector along the angular momentum at the start"),
              "turn_axis": _along_axes(
                  result.turn_axis, long_name="about which one rotation period turns the body")}
    notes = {"fate": result.fate.word} | values_of(
        result, "mode momentum rotation_period precession_period nutation_period lean cone turn_angle error "
               "because")
    notes |= {f"{name} written out": text for name, text in (result.decimals or {}).items()}
    return Variables(("axis",), values, AXIS, _known(notes))


def _angles_words(result):
    largest = ", ".join(f"{axis} {number(np.degrees(value), 6)} deg" for axis, value in zip(
        result.axes, result.momentum[:, 1]))
    return f"greatest to the angular momentum: {largest}; over {result.over}, {result.level}"


def _angles(result):
    ends = {"units": "rad", "long_name": "angle to the angular momentum"}
    values = {"least": (("axis",), result.momentum[:, 0], ends),
              "greatest": (("axis",), result.momentum[:, 1], ends),
              "start": (("axis",), result.start, {"units": "rad", "long_name":
                                                  "largest angle to the direction at the start"})}
    return Variables(("axis",), values, {"axis": (list(result.axes), {"long_name": "axis of the body"})},
                     {"over": str(result.over), "level": result.level, "reason": result.because})


def _crossings_words(result):
    zeros = ", ".join(some(len(row), "zero") for row in result.t)
    return f"{zeros} up to t = {number(result.until, 6, -1)}, {result.status}; by changes of sign along a run"


def _crossings(result):
    events = np.concatenate([np.full(len(row), n) for n, row in enumerate(result.t, 1)])
    values = {"event": (("zero",), events, {"long_name": "number of the event, in their order"}),
              "t": (("zero",), np.concatenate(result.t), {}),
              "error": (("zero",), np.concatenate(result.error), {"long_name": "of the time"}),
              "state": (("zero", "component"), np.concatenate(result.states), {})}
    return Variables(("zero",), values, {}, values_of(result, "until status") | {"reason": result.because})


def _chaos_words(out):
    text = out.orders
    item = f", MEGNO {float(out.megno):.4g}" if np.ndim(out.megno) == 0 else ""
    if not len(out.times):
        return _shares(text)
    return f"{some(len(text), 'state')}: {_shares(text)}{item}; followed to {number(out.times[-1], 6, -1)}"


def _chaos(result):
    labels = np.asarray(result.labels)
    text = {"megno": "MEGNO at the last time", "lyapunov": "rate at which neighbours part",
             "lyapunov_error": "how far it moved last"}
    values = {"order": (_dims(labels), np.array(result.orders, dtype=object).reshape(labels.shape), {})} | {
        name: (_dims(labels), np.asarray(getattr(result, name), float), {"long_name": word})
        for name, word in text.items()}
    return Variables(_dims(labels), values)


def _ensemble_words(result):
    ended = f"; {len(result.stopped)} stopped" if result.stopped else ""
    return (f"{some(len(result.states), 'motion')} at {some(len(result.t), 'time')}; "
            f"{result.method}{ended}")


def _ensemble(out):
    values = {"last": (("motion", "component"), out.states[:, -1], {"long_name": "state at the last time"}),
              "reached": (("motion",), out.reached[:, -1],
                          {"long_name": "whether the motion went on so far"})}
    return Variables(("motion",), values, {}, values_of(out, "method rtol"))


def _diagram_words(result):
    counts = ", ".join(str(piece.count) for piece in result.pieces)
    return f"{result.what}: {counts}; {len(result.events)} events, {len(result.connections)} connections"


def _diagram(result):
    number = lambda name: (("piece",), np.array([getattr(piece, name) for piece in result.pieces]), {})
    stable = [sum(state.verdict == "stable" for state in piece.states) for piece in result.pieces]
    values = {"low": number("low"), "high": number("high"), "equilibria": number("count"),
              "stable": (("piece",), np.array(stable), {})}
    return Variables(("piece",), values, {},
                     {"what": result.what,
                      "events": [event.value for event in (*result.events, *result.connections)]})


def _plane_words(result):
    counts = ((result.strips, "strip"), (result.walls, "wall"), (result.cusps, "cusp"))
    return f"{result.what}: {', '.join(some(len(rows), word) for rows, word in counts)}"


def _plane(result):
    number = lambda name: (("strip",), np.array([getattr(strip, name) for strip in result.strips]), {})
    counts = (", ".join(str(piece.count) for piece in strip.line.pieces) for strip in result.strips)
    values = {"low": number("low"), "high": number("high"), "equilibria": _texts(("strip",), counts)}
    return Variables(("strip",), values, {},
                     {"what": result.what, "walls": [wall.value for wall in result.walls],
                      "cusps": len(result.cusps)})


# class of a result -> (its line, its numbers)
def _percentiles_words(result):
    parts = [f"{word} {100 * of.fraction:.4g} %" for shares in (result.outcomes, result.reached)
             for word, of in shares.items()]
    parts += [f"{name} " + ", ".join(f"{q.percent} % {number(q.high, 6)}" for q in item.quantiles)
              for name, item in (("time", result.time), ("largest", result.largest),
                                 ("closing", result.closing)) if item is not None]
    return f"{result.name}, {some(result.number, 'draw')}: {'; '.join(parts)}"


def _percentiles(result):
    values, percents = {}, None
    for name, item in (("time", result.time), ("largest", result.largest), ("closing", result.closing)):
        if item is None:
            continue
        percents = [q.percent for q in item.quantiles]
        unit = {"units": item.unit or "1"}
        for end in ("low", "high", "least", "greatest"):
            values[f"{name}_{end}"] = (("percent",), np.array(
                [np.nan if (value := getattr(q, end)) is None else value for q in item.quantiles]), unit)
    shares = {f"{name}_share": of.fraction for rows in (result.outcomes, result.reached)
              for name, of in rows.items()}
    return Variables(("percent",), values, {"percent": (percents, {"units": "%"})},
                     {"case": result.name, "draws": result.draws, "number": result.number,
                      "seed": result.seed, **shares})


KINDS: dict[str, tuple[Callable[[Any], str], Callable[[Any], Variables]]] = {
    "Simulation": (_simulation_words, _simulation), "Trajectory": (_trajectory_words, _trajectory),
    "FateResult": (_fates_words, _fates), "Motions": (_motions_words, _fates),
    "Values": (_values_words, _values), "TimeTo": (_time_to_words, _time_to),
    "Equilibria": (_equilibria_words, _equilibria), "Motion": (_motion_words, _motion),
    "Attitude": (_attitude_words, _attitude), "Angles": (_angles_words, _angles),
    "Crossings": (_crossings_words, _crossings),
    "Chaos": (_chaos_words, _chaos), "Ensemble": (_ensemble_words, _ensemble),
    "Diagram": (_diagram_words, _diagram), "Plane": (_plane_words, _plane),
    "Separatrix": (_separatrix_words, _separatrix), "Comparison": (_comparison_words, _comparison),
    "Stuck": (_stuck_words, _stuck), "SpinUp": (_spin_up_words, _spin_up),
    "FlatSpin": (_flat_spin_words, _flat_spin), "Ending": (_ending_words, _ending),
    "Rotations": (_rotations_words, _rotations), "GyrostatSpin": (_gyrostat_spin_words, _rotations),
    "RotationDiagram": (_rotation_diagram_words, _rotation_diagram),
    "TopDiagram": (_top_diagram_words, _top_diagram),
    "Percentiles": (_percentiles_words, _percentiles)}


# --- Any kind: as a data set, a table, a page
def dataset(result: Equilibria | Motion, frame: str = "file") -> xarray.Dataset:
    """The numbers of a result with their dimensions, units and words."""
    demand("xarray")
    import xarray
    out = variables(result, frame)
    return xarray.Dataset(dict(out.values),
                          {name: ((name,), *coordinate) for name, coordinate in out.coordinates.items()},
                          dict(out.attributes))


def table(result: Equilibria | Motion, frame: str = "file") -> pandas.DataFrame:
    """The numbers of a result as a table; a column a component, what belongs to the whole in `attrs`."""
    demand("pandas")
    import pandas
    out = variables(result, frame)
    built = pandas.DataFrame({name: values for name, values in columns(out)}, index=_index(out))
    built.attrs = dict(out.attributes)
    return built


def columns(result: Variables) -> list[tuple[str, np.ndarray]]:
    """(name, values in one row of cells) of every component: "omega1", "omega2", ..."""
    rows = []
    for name, (dims, values, _) in result.values.items():
        array, own = np.asarray(values), dims[len(result.index):]
        if not own:
            rows.append((name, array.reshape(-1)))
            continue
        flat = array.reshape(-1, array.shape[-1] if name != "matrix" else 9)
        resolved = PARTS[name].components if name in PARTS else ()
        axes = own == ("axis",) and "axis" in result.coordinates
        letters: Any = result.coordinates["axis"][0] if axes else ()
        if len(letters) and isinstance(letters[0], str):
            names = [f"{name}_{letter}" for letter in letters]
        else:
            names = (list(resolved) if len(resolved) == flat.shape[1]
                     else [f"{name}{n + 1}" for n in range(flat.shape[1])])
        rows += [(item, flat[:, n]) for n, item in enumerate(names)]
    return rows


def _index(result: Variables) -> Any:
    """Times or axes where they are known, else numbers; several dimensions as pandas counts them."""
    import pandas
    shape = next(iter(result.values.values()))[1].shape[:len(result.index)]
    if not result.index:
        return pandas.RangeIndex(1)
    if len(result.index) > 1:
        return pandas.MultiIndex.from_product([range(size) for size in shape], names=list(result.index))
    name, = result.index
    return pandas.Index(result.coordinates[name][0] if name in result.coordinates else range(shape[0]),
                        name=name)


def html(result: Equilibria | Motion) -> str:
    """The line of a result, and its first rows; what is in it is text and never a tag."""
    out = variables(result)
    rows = columns(out)
    index = out.index[0] if len(out.index) == 1 else ""
    labels = out.coordinates[index][0] if index in out.coordinates else range(len(rows[0][1]))
    head = "".join(f"<th>{escape(name)}</th>" for name in (index, *(name for name, _ in rows)))
    number = len(rows[0][1])
    body = "".join(
        f"<tr><th>{_cell(labels[n])}</th>{''.join(f'<td>{_cell(values[n])}</td>' for _, values in rows)}</tr>"
        for n in range(min(MAX_ROWS, number)))
    more = f"<p>and {number - MAX_ROWS} more</p>" if number > MAX_ROWS else ""
    return (f"<div><p><b>{_text(short(result))}</b></p><table><thead><tr>{head}</tr></thead>"
            f"<tbody>{body}</tbody></table>{more}</div>")


def _cell(value: Any) -> str:
    return (f"{float(value) + 0.0:.6g}".replace("-", "−") if isinstance(value, (float, np.floating))
            else _text(str(value)))


def _text(text: str) -> str:
    """Words as text; the minus of a number as print has it, the hyphens of words as they are."""
    return escape(minus(text))
