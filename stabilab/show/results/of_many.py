"""Results of many cases, states or forces: the line and the numbers of each."""
from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from ...reasons import number
from ...representation import values_of
from ..names import spare
from ..terminal import some
from .variables import (
    Variables,
    dimensions,
    numbers,
    shares,
    texts,
    where_known,
)

if TYPE_CHECKING:
    pass


def _rotation_diagram_words(result):
    counts = ", ".join(str(piece.stable) for piece in result.pieces)
    return f"{some(len(result.pieces), 'piece')} over {result.span.key.name}; that attract: {counts}"


def _rotation_diagram(result):
    dims, rows = ("piece",), result.pieces
    values = {name: numbers(dims, (getattr(row, name) for row in rows)) for name in ("low", "high")}
    values |= {name: numbers(dims, (row.natures.get(name, 0) for row in rows))
               for name in ("minimum", "saddle", "maximum")}
    return Variables(dims, values, {}, where_known({
        "key": result.span.key.name, "size": result.momentum, "rate": result.rate,
        "changes": [float(value) for value in result.changes], "because": result.because}))


def _top_diagram_words(result):
    phrases = ", ".join("stable" if piece.stable("upright") else "unstable" for piece in result.pieces)
    return f"{some(len(result.pieces), 'piece')} over {result.span.key.name}; upright {phrases}"


def _top_diagram(result):
    dims, rows = ("piece",), result.pieces
    values = {name: numbers(dims, (getattr(row, name) for row in rows)) for name in ("low", "high")}
    values |= {family: numbers(dims, (float(row.stable(family)) for row in rows))
               for family in ("upright", "hanging")}
    values |= {name: numbers(dims, (sum(state.leaning and state.stable is stable for state in row.states)
                                     for row in rows))
               for name, stable in (("leaning_stable", True), ("leaning_unstable", False))}
    return Variables(dims, values, {}, where_known({
        "key": result.span.key.name, "changes": [float(value) for value in result.changes],
        "because": result.because}))


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
              numbers(dims, (d.first[level] for d in rows),
                       long_name=f"time of the first error of {100 * level:g} % of the scale; NaN: none")
              for level in (rows[0].first if rows else ())}
    values = {"model": texts(dims, (d.model for d in rows)), "part": texts(dims, (d.part
              for d in rows)), "largest": numbers(dims, (d.largest for d in rows),
                                  long_name="largest error while the model runs"),
              "scale": numbers(dims, (d.scale for d in rows),
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
            else f"{some(len(result.rows), 'row')} ({shares(row.fate for row in result.rows)}), the first "
                 f"{first}")


def _stuck(result):
    dims, rows = ("row",), result.rows
    ends = [row.time_to_limit or (None, None) for row in rows]
    margins = {f"margin_{name}": numbers(dims, (row.margins[name].size if name in row.margins else None
                                                 for row in rows), units=unit)
               for name, unit in (("rate", "rad/s"), ("wheel", "N m s"), ("torque", "N m"))}
    values = {"thrusters": texts(dims, ("+".join(row.thrusters)
              for row in rows)), "fate": texts(dims, (row.fate for row in rows)),
              "level": texts(dims, (row.level
              for row in rows)), "spin_axis": numbers(dims, (row.axis or 0 for row in rows), units="1"),
              "limit_low": numbers(dims, (low for low, _ in ends), units="s"),
              "limit_high": numbers(dims, (high for _, high in ends), units="s"),
              "largest_rate": numbers(dims, (row.largest_rate for row in rows), units="rad/s"), **margins,
              "torque": (("row", "axis"), np.array([row.torque for row in rows], float),
                         {"units": "N m", "long_name": "in the frame of the file"}),
              "because": texts(dims, (row.because for row in rows))}
    return Variables(dims, values, {"axis": ([1, 2, 3], {"long_name": "axis of the file"})},
                     {"case": result.case})


def _chaos_words(out):
    text = out.orders
    item = f", MEGNO {float(out.megno):.4g}" if np.ndim(out.megno) == 0 else ""
    if not len(out.times):
        return shares(text)
    return f"{some(len(text), 'state')}: {shares(text)}{item}; followed to {number(out.times[-1], 6, -1)}"


def _chaos(result):
    labels = np.asarray(result.labels)
    text = {"megno": "MEGNO at the last time", "lyapunov": "rate at which neighbours part",
             "lyapunov_error": "how far it moved last"}
    dims = dimensions(labels)
    values = {"order": (dims, np.array(result.orders, dtype=object).reshape(labels.shape), {})} | {
        name: (dims, np.asarray(getattr(result, name), float), {"long_name": word})
        for name, word in text.items()}
    return Variables(dimensions(labels), values)


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
    values = {"low": number("low"), "high": number("high"), "equilibria": texts(("strip",), counts)}
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


Kind = tuple[Callable[[Any], str], Callable[[Any], Variables]]
KINDS: dict[str, Kind] = {
    "Chaos": (_chaos_words, _chaos), "Ensemble": (_ensemble_words, _ensemble),
    "Diagram": (_diagram_words, _diagram), "Plane": (_plane_words, _plane),
    "Comparison": (_comparison_words, _comparison), "Stuck": (_stuck_words, _stuck),
    "RotationDiagram": (_rotation_diagram_words, _rotation_diagram),
    "TopDiagram": (_top_diagram_words, _top_diagram), "Percentiles": (_percentiles_words, _percentiles)}
