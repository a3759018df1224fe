"""Each kind of result: its line, its numbers."""
from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ...orbit.result import Fate, Motion
from ...reasons import number
from ...representation import values_of
from ..terminal import some
from . import of_many
from .of_many import Kind
from .variables import (
    AXIS,
    Variables,
    about_axis,
    along_axes,
    dimensions,
    named,
    numbers,
    of_parts,
    shares,
    texts,
    where_known,
)

if TYPE_CHECKING:
    from ...equilibrium.result import Equilibria


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
            else f"{some(len(phrases), 'state')}: {shares(phrases)}")


def _fates(result):
    dims, labels = dimensions(result.labels), np.asarray(result.labels)
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
    if motion.level == "undecided":
        return motion.because
    return f"{motion.fate.word}{about_axis(motion)}, {motion.level}: {motion.because}"


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
    dims, unit = dimensions(result.states[..., 0]), {"units": result.unit or "1"}
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
    return where_known({"level": item, "reason": result.reason if item else None})


def _time_to_words(result):
    low, high = result.low, result.high
    if getattr(low, "ndim", 0):
        levels = shares(map(str, result.level.reshape(-1)))
        return f"{result.quantity}: {some(low.size, 'state')}, {levels}"
    when = ("never" if low == math.inf else f"not before {number(low, 6, -1)}" if math.isnan(high)
            else f"{number(low, 9, -1)} to {number(high, 9, 1)}")
    return f"{result.quantity}: {when}, {result.level}"


def _time_to(result):
    low = np.asarray(result.low)
    dims, states = dimensions(low), np.asarray(result.states)
    unit = {"units": "1" if result.scene.variables == "scaled" else "s"}
    values = {"start": ((*dims, "axis" if states.shape[-1] == 3 else "component"), states, {}),
              "low": (dims, low, unit),
              "high": (dims, np.asarray(result.high), unit),
              "level": (dims, np.asarray(result.level, dtype=object), {}),
              "words": (dims, np.asarray(result.words, dtype=object), {})}
    return Variables(dims, values, AXIS if states.shape[-1] == 3 else {}, {"quantity": result.quantity})


def _equilibria_words(result: Equilibria):
    pieces = [segment.verdict for curve in result.curves for segment in curve.segments]
    printed = [f"{some(len(result.points), 'point')} ({shares(p.verdict for p in result.points)})"
            if result.points else "",
            f"{some(len(result.curves), 'curve')}, their pieces: {shares(pieces)}" if result.curves
            else ""]
    return "; ".join([result.kind, *filter(None, printed)])


def _equilibria(result: Equilibria):
    rows = ([("", p) for p in result.points]
            + [(curve.name, p) for curve in result.curves for p in curve.samples])
    at = np.array([p.at for _, p in rows], float).reshape(len(rows), len(rows[0][1].at) if rows else 3)
    across = "axis" if at.shape[1] == 3 else "component"
    of = {name: texts(("point",), (getattr(p, name) for _, p in rows))
          for name in ("verdict", "linear", "because")}
    values = {"at": (("point", across), at,
                     {"long_name": "the equilibrium; of a curve, samples spread over every piece"}),
              "verdict": of["verdict"], "linear": of["linear"],
              "curve": texts(("point",), (name for name, _ in rows)), "because": of["because"]}
    return Variables(("point",), values, AXIS if across == "axis" else {},
                     {"kind": result.kind, "reason": result.because})


def _motion_words(m: Motion):
    parts = [m.fate.word + about_axis(m) + ("" if m.level in ("exact", "undecided") else f", {m.level}"),
             named("margin in energy", m.margin_energy),
             named("in rate", m.margin_velocity, -bool(m.velocity_reason)), named("period", m.period),
             "" if m.extremes is None else f"extremes over {m.extremes_over}"]
    return "; ".join(filter(None, parts))


def _motion(m: Motion):
    over = {"long_name": f"over {m.extremes_over}"}
    values = {"start": along_axes(m.at[:3])} | {
        name: numbers(("axis",), (pair[end] for pair in m.extremes or ((None, None),) * 3), **over)
        for end, name in enumerate(("least", "greatest"))}
    notes = {"fate": m.fate.word, "spin_axis": m.axis, "margin_rate": m.margin_velocity, **m.invariants
             } | values_of(m, "level because sense margin_energy period")
    if m.energy_integral is not None:
        notes |= {m.energy_integral.name: m.energy_integral.value,
                  f"{m.energy_integral.name}s": m.energy_integral.on_separatrix,
                  "turned_about": m.energy_integral.turned_about}
    return Variables(("axis",), values, AXIS, where_known(notes))


def _ending_words(out):
    turn = f" about {'+' if out.sense > 0 else '-'}axis {out.axis}" if out.sense else ""
    return "; ".join(filter(None, (out.kind + turn, named("rate", out.rate),
                                   *(f"{name} at {time.at:.6g}" for name, time in out.times), out.level)))


def _ending(result):
    values = {"rates": along_axes(result.rates, units="rad/s", long_name="rates in the end")}
    notes = {name: time.at for name, time in result.times}
    return Variables(("axis",), values, AXIS, where_known(notes | values_of(
        result, "kind level because sense rate within nutation growth decay at_the_latest estimate")
        | {"spin_axis": result.axis}))


def _flat_spin_words(result):
    times = ((name, getattr(result, name)) for name in ("leaves", "crosses", "settles", "tenth"))
    printed = [f"{name} at {time.at:.6g}" for name, time in times if time]
    return "; ".join([result.outcome, *printed, result.level])


def _flat_spin(result):
    values = {"down": numbers(("span",), (span.down for span in result.spans)),
              "up": numbers(("span",), (span.up for span in result.spans)),
              "name": texts(("span",), (span.name for span in result.spans))}
    notes = {name: time.at for name in ("leaves", "crosses", "settles", "tenth")
             if (time := getattr(result, name)) is not None}
    return Variables(("span",), values, {}, where_known(notes | values_of(
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
              "energy": numbers(dims, (row.energy for row in rows), units="J"),
              **{name: texts(dims, (getattr(row, name) for row in rows))
                 for name in ("nature", "with_losses", "without_losses")},
              **{name: numbers(dims, (getattr(row, name) for row in rows), units="s")
                 for name in ("growth", "decay")}}
    notes = {"size": result.momentum, "because": result.because}
    if result.threshold is not None:
        notes |= {f"threshold_{name}": value
                  for name, value in values_of(result.threshold, "factor moment").items()}
    if hasattr(result, "outcome"):
        notes |= values_of(result, "outcome level end energy final_energy barrier within steps")
        notes |= {name: time.at for name in ("crosses", "settles", "tenth")
                  if (time := getattr(result, name)) is not None}
    return Variables(dims, values, AXIS, where_known(notes))


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


def _spin_up_words(result):
    return (f"{result.fate.word}{about_axis(result)}, {result.level}; t = {result.t:.6g}, "
            f"{some(result.steps, 'step')}")


def _spin_up(result):
    values = {"state": along_axes(result.state, long_name="rates at time t"),
              "direction": along_axes(result.direction,
                                       long_name="along which the rate grows; NaN: undecided")}
    notes = {"fate": result.fate.word, "spin_axis": result.axis}
    return Variables(("axis",), values, AXIS,
                     notes | values_of(result, "level sense t steps cause condition"))


def _attitude_words(result):
    parts = [result.mode or result.fate.word, named("rotation period", result.rotation_period),
             named("nutation period", result.nutation_period),
             named("precession period", result.precession_period)]
    return "; ".join(filter(None, parts))


def _attitude(result):
    values = {"start": along_axes(result.at[:3], units="rad/s"),
              "momentum_direction": along_axes(
                  result.momentum_direction, long_name="unit vector along the angular momentum at the start"),
              "turn_axis": along_axes(
                  result.turn_axis, long_name="about which one rotation period turns the body")}
    notes = {"fate": result.fate.word} | values_of(
        result, "mode momentum rotation_period precession_period nutation_period lean cone turn_angle error "
               "because")
    notes |= {f"{name} written out": text for name, text in (result.decimals or {}).items()}
    return Variables(("axis",), values, AXIS, where_known(notes))


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


KINDS: dict[str, Kind] = {
    **of_many.KINDS,
    "Simulation": (_simulation_words, _simulation), "Trajectory": (_trajectory_words, _trajectory),
    "FateResult": (_fates_words, _fates), "Motions": (_motions_words, _fates),
    "Values": (_values_words, _values), "TimeTo": (_time_to_words, _time_to),
    "Equilibria": (_equilibria_words, _equilibria), "Motion": (_motion_words, _motion),
    "Attitude": (_attitude_words, _attitude), "Angles": (_angles_words, _angles),
    "Crossings": (_crossings_words, _crossings), "Separatrix": (_separatrix_words, _separatrix),
    "SpinUp": (_spin_up_words, _spin_up), "FlatSpin": (_flat_spin_words, _flat_spin),
    "Ending": (_ending_words, _ending), "Rotations": (_rotations_words, _rotations),
    "GyrostatSpin": (_gyrostat_spin_words, _rotations)}
