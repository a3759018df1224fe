"""A result in one line."""
from __future__ import annotations

import math
from collections import Counter
from typing import Any

import numpy as np

from ...orbit.result import Fate
from ..axes import direction


def short(result: Any) -> str:
    """The line of a result: its kind, and what it answers in a few words."""
    name = type(result).__name__
    return f"{name}({SHORT[name](result)})"


def _motion(m):
    spin = f" about axis {m.axis}, {direction(m.sense)}" if m.axis else ""
    parts = [m.fate.word + spin + ("" if m.level in ("exact", "undecided") else f", {m.level}"),
             _named("margin in energy", m.margin_energy),
             _named("in rate", m.margin_velocity), _named("period", m.period),
             "" if m.extremes is None else f"extremes over {m.extremes_over}"]
    return "; ".join(filter(None, parts))


def _named(words, value):
    return "" if value is None else f"{words} {value:.6g}"


def _equilibria(found):
    pieces = [segment.verdict for curve in found.curves for segment in curve.segments]
    told = [f"{_counted(len(found.points), 'point')} ({_shares(p.verdict for p in found.points)})"
            if found.points else "",
            f"{_counted(len(found.curves), 'curve')}, their pieces: {_shares(pieces)}" if found.curves
            else ""]
    return "; ".join([found.kind, *filter(None, told)])


def _counted(number, word):
    return f"{number} {word}" + ("" if number == 1 else "s")


def _shares(words):
    return ", ".join(f"{number} {word}" for word, number in Counter(words).items())


def _fates(found):
    words = [Fate(int(label)).word for label in found.labels.reshape(-1)]
    return (f"{words[0]}: {found.because}" if found.labels.ndim == 0
            else f"{_counted(len(words), 'state')}: {_shares(words)}")


def _run(t, parts, method, status, reason):
    span = f", {t[0]:.6g} to {t[-1]:.6g}" if len(t) else ""
    return (
        f"{_counted(len(t), 'time')}{span}; {', '.join(parts)}; {method}, "
        f"{status if status == 'reached' else reason}")


def _time_to(found):
    low, high = found.low, found.high
    if getattr(low, "ndim", 0):
        return (
            f"{found.quantity}: {_counted(low.size, 'state')}, {_shares(map(str, found.level.reshape(-1)))}")
    when = ("never" if low == math.inf else f"not before {low:.6g}" if math.isnan(high)
            else f"{low:.9g} to {high:.9g}")
    return f"{found.quantity}: {when}, {found.level}"


def _separatrix(found):
    return ("; ".join(f"{s.name}, {s.points.shape[0]} x {s.points.shape[1]} points" for s in found.branches)
            or f"no branches: {found.reason}")


def _comparison(found):
    worst = {}
    for d in found.departures:
        share = d.largest / d.scale if d.scale else math.inf if d.largest else 0.0
        worst[d.model] = max(worst.get(d.model, 0.0), share)
    models = ([f"{model} {share:.2g}" for model, share in worst.items()]
              + [f"{model} refused" for model in found.refused])
    return (
        f"{_counted(len(found.t), 'time')}; largest error of a part's size: "
        f"{', '.join(models) or 'no model'}")


def _stuck(found):
    head = found.rows[0]
    low, high = head.time_to_limit or (None, None)
    when = ("" if low is None else f", limit in {low:.6g} s" if f"{low:.6g}" == f"{high:.6g}"
            else f", limit in {low:.6g} to {high:.6g} s")
    first = (
        f"{' and '.join(head.thrusters) or 'torque'}: "
        f"{head.fate}{f' about axis {head.axis}' if head.axis else ''}{when}")
    return (first if len(found.rows) == 1
            else f"{_counted(len(found.rows), 'row')} ({_shares(row.fate for row in found.rows)}), the first "
                 f"{first}")


def _spin_up(found):
    about = f" about axis {found.axis}, {direction(found.sense)}" if found.axis else ""
    return f"{found.fate.word}{about}, {found.level}; t = {found.t:.6g}, {_counted(found.steps, 'step')}"


def _attitude(found):
    parts = [found.mode or found.fate.word, _named("rotation period", found.rotation_period),
             _named("nutation period", found.nutation_period),
             _named("precession period", found.precession_period)]
    return "; ".join(filter(None, parts))


def _crossings(found):
    zeros = ", ".join(_counted(len(row), "zero") for row in found.t)
    return f"{zeros} up to t = {found.until:.6g}, {found.status}; by changes of sign along a run"


def _chaos(found):
    words = found.orders
    one = f", MEGNO {float(found.megno):.4g}" if np.ndim(found.megno) == 0 else ""
    return (
        f"{_counted(len(words), 'state')}: {_shares(words)}{one}; followed to {float(found.times[-1]):.6g}"
        if len(found.times) else _shares(words))


def _ensemble(found):
    ended = f"; {len(found.stopped)} stopped" if found.stopped else ""
    return (
        f"{_counted(len(found.states), 'motion')} at {_counted(len(found.t), 'time')}; {found.method}{ended}")


def _diagram(found):
    counts = ", ".join(str(piece.count) for piece in found.pieces)
    return f"{found.what}: {counts}; {len(found.events)} events, {len(found.connections)} connections"


def _plane(found):
    return (
        f"{found.what}: {_counted(len(found.strips), 'strip')}, {_counted(len(found.walls), 'wall')}, "
        f"{_counted(len(found.cusps), 'cusp')}")


SHORT = {
    "Attitude": _attitude, "Crossings": _crossings, "Diagram": _diagram, "Plane": _plane,
    "Chaos": _chaos, "Ensemble": _ensemble,
    "Motion": _motion, "Equilibria": _equilibria, "FateResult": _fates, "TimeTo": _time_to,
    "Separatrix": _separatrix,
    "Comparison": _comparison, "Stuck": _stuck, "SpinUp": _spin_up,
    "Trajectory": lambda run: _run(run.t, run.blocks, run.method, run.status, run.reason),
    "Simulation": lambda run: _run(run.t, run.state, f"{run.model}, {run.method}" if run.model != "exact"
                                   else run.method, run.status, run.reason)}
