"""Whether motions are chaotic, in words and as a picture."""
from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from ...answers.chaos import FLAT, Chaos, Order, chaos
from ...errors import printable
from ...orbit.result import OUTCOMES, Fate
from ...packages import demand
from .. import endings, style
from ..limiting import Line
from ..plot import canvas, phase_plane
from ..plot import subject as subjects
from ..plot.subject import Measures, Subject, measures, subject
from ..terminal import lettered, written
from ..text.notes import as_note, fitted
from ..units import SHORT, number
from .shades import scale as colours_of_numbers

# --- Chaos as a picture: the Poincare section of a motion, beside it MEGNO of all motions that start on its
# plane; or MEGNO over time
GRID = 41          # states of the map along each axis
NEIGHBOURS = 8     # of the section
SHORTER = 4        # of the map each motion is followed so much less long
SIZE = (13.0, 6.6)
TOP = 4.0          # of MEGNO's colours


def write(case: Any, result: Chaos, out: str | Path) -> Path | str:
    """Draw the motion of a case and write the picture; the same case gives the same bytes. A sentence, and no
    file, where there is nothing to see. Raises InputError for another ending."""
    demand(*style.PACKAGES)
    target, item = endings.file(out, endings.PICTURES), subject(case)
    why = subjects.why_not("section", item)
    if why and not np.isfinite(result.history).any():
        return f"no picture is written: {result.because}"
    word = Order(int(result.labels)).word
    with style.drawing() as plt:
        if why:
            figure, ax = plt.subplots(figsize=(7.6, 4.8), layout="constrained")
            _over_time(ax, case, result)
            style.over(figure, item.heading, word)
            return style.save(figure, target)
        if phase_plane.repeats(item):
            rings: Any = phase_plane.section(item).figure
            return style.save(rings, target)
        figure, (left, right) = plt.subplots(1, 2, figsize=SIZE, layout="constrained")
        rows, (plane, *passed) = phase_plane.scattered(item, left, measures(item), NEIGHBOURS)
        more, phrase = _map(figure, right, left, item, float(result.times[-1]) / SHORTER)
        plane = f"passages {written(plane)}"
        width = left.get_position().width * figure.get_figwidth()
        left.set_title(plane, fontsize=style.fitting(plane, width))
        style.over(figure, item.heading, f"this motion is {word}")
        full = [*canvas.notes(item, measures(item), answered=False),
                *(as_note(written(line)) for line in [*passed, phrase] if line)]
        style.legend(figure, [*rows, *more], notes=fitted(full, figure.get_figwidth()))
        return style.save(figure, target)


def _over_time(ax: Any, case: Any, result: Chaos) -> None:
    ax.plot(result.times, result.history, marker="o", color=style.VIOLET)
    ax.axhline(2, color=style.GREY, linewidth=0.8)
    ax.set_xscale("log")
    ax.set_xticks(result.times, [number(time, SHORT) for time in result.times.tolist()])
    ax.set_xticks([], minor=True)
    ax.set_xlabel(f"followed for ({case.scene.time_unit})")
    ax.set_ylabel("MEGNO (2 on tori)")


def _map(figure: Any, ax: Any, beside: Any, item: Subject,
         until: float) -> tuple[list[tuple[str, dict[str, Any]]], str]:
    """MEGNO of the motions from the window of the section; those that spin up in a colour of their own. Rows
    of the legend; and a sentence in place of a map of one colour, whose axes are taken away."""
    scale: Measures = measures(item)
    _, plane = phase_plane.plane_of(item, subjects.certain_from(item))
    limits = beside.get_xlim(), beside.get_ylim()
    x, y = (np.linspace(low, high, 2 * GRID + 1)[1::2] for low, high in limits)
    states = np.full((GRID, GRID, 3), plane.level)
    states[..., plane.across[0]], states[..., plane.across[1]] = x[:, None] / scale.rate[1], y / scale.rate[1]
    result = chaos(item.twin, states, until)
    if len(labels := set(result.labels.ravel().tolist())) == 1:
        _alone(figure, ax, beside)
        return [], (f"of {result.labels.size} motions from this plane, each followed for {number(until)} "
                    f"{item.scene.time_unit}, all are {Order(*labels).word}")
    extent = (*limits[0], *limits[1])
    leaving = np.where(result.labels == Order.SPIN_UP, 1.0, np.nan)
    ax.grid(False)
    look = {"origin": "lower", "extent": extent, "aspect": "auto", "interpolation": "nearest"}
    from matplotlib.colors import ListedColormap
    ax.imshow(leaving.T, cmap=ListedColormap([style.FILL["spin-up"]]), **look)
    shown = ax.imshow(result.megno.T, cmap=colours_of_numbers(), vmin=0, vmax=TOP, **look)
    figure.colorbar(shown, ax=ax, label="MEGNO (2 on tori, grows where chaotic)", extend="both")
    at = item.state
    if abs(at[plane.axis] - plane.level) < 1e-9 * max(map(abs, at)):
        ax.plot([at[plane.across[0]] * scale.rate[1]], [at[plane.across[1]] * scale.rate[1]],
                **style.MARKER["start"])
    ax.set_xlabel(beside.get_xlabel())
    ax.set_ylabel(beside.get_ylabel())
    ax.set_title(f"motions from this plane, each followed for {number(until)} {item.scene.time_unit}")
    spun = np.isfinite(leaving).any()
    return [(OUTCOMES[Fate.SPIN_UP].legend, {"facecolor": style.FILL["spin-up"]})] if spun else [], ""


def _alone(figure: Any, ax: Any, beside: Any) -> None:
    """The section on a figure of its own."""
    from matplotlib.gridspec import GridSpec
    ax.remove()
    figure.set_size_inches(SIZE[0] * 0.6, SIZE[1])
    beside.set_subplotspec(GridSpec(1, 1, figure=figure)[0])


# --- Whether a motion is regular or chaotic, in words, JSON and CSV: the label, how it is known, MEGNO over
# time
CHAOS_SCHEMA = "stabilab.chaos/1"
FIRST = {Order.REGULAR: "REGULAR as far as it was followed", Order.CHAOTIC: "CHAOTIC",
         Order.SPIN_UP: "SPIN-UP", Order.UNDECIDED: "UNDECIDED"}


def text(case: Any, result: Chaos, _: Any = None) -> str:
    """The answer first; then what it means for a small change, and MEGNO at each doubling of the time."""
    label, unit = Order(int(result.labels)), _unit(case)
    resting = label == Order.REGULAR and not result.megno < FLAT
    lines = [f"{printable(case.name)}: {'REGULAR' if resting else FIRST[label]}; {result.because}"]
    if label == Order.CHAOTIC:
        rate, error = float(result.lyapunov), float(result.lyapunov_error)
        lines.append(f"  neighbours part at {rate:.3g} ± {error:.1g} 1/{unit}: a small change doubles in "
                     f"{math.log(2) / rate:.3g} {unit}")
    if np.isfinite(result.history).any():
        lines.append("  an indicator of a finite time, no proof; time and MEGNO:")
        lines += [f"  {time:12.6g} {unit}  {_number(value, '9.4f') or 'not followed'}"
                  for time, value in zip(result.times.tolist(), result.history.tolist())]
    return "\n".join(lines)


def swept(rows: list[tuple[Any, Chaos]], _: Any = None) -> tuple[str, list[tuple[str, str]], list[list[str]]]:
    """(the answer in a line, columns, rows) of a sweep: how many motions are what, and of each MEGNO at the
    last time; where one is chaotic, also how soon neighbours part."""
    labels = [Order(int(result.labels)) for _, result in rows]
    printed = ", ".join(f"{labels.count(item)} {FIRST[item]}" for item in Order if item in labels)
    cells = [[FIRST[label].split()[0], f"{result.times[-1] / result.turn:,.0f}",
              _number(float(result.megno), ".4f"),
              _number(math.log(2) / float(result.lyapunov) if label == Order.CHAOTIC else math.nan, ".3g")]
             for label, (_, result) in zip(labels, rows)]
    columns = [("motion", ""), ("turns", ""), ("MEGNO", ""), ("doubles in", _unit(rows[0][0]))]
    shown = len(columns) if Order.CHAOTIC in labels else -1
    return printed, columns[:shown], [row[:shown] for row in cells]


def _number(value: float, form: str) -> str:
    """Nothing where it is not known, and no sign where it rounds to zero."""
    return "" if math.isnan(value) else format(0.0 if abs(value) < 5e-5 else value, form)


def _unit(case: Any) -> str:
    return lettered(case.scene.time_unit)


def as_dict(case: Any, out: Chaos) -> dict[str, Any]:
    """One object of `stabilab chaos --json`."""
    return {"schema": CHAOS_SCHEMA, "case": case.name, "variables": case.variables,
            "answer": Order(int(out.labels)).word, "because": out.because,
            "reason": out.reason.as_dict(), "megno": float(out.megno), "lyapunov": float(out.lyapunov),
            "lyapunov_uncertainty": float(out.lyapunov_error),
            "turn": out.turn, "times": out.times.tolist(), "history": out.history.tolist()}


def lines(case: Any, result: Chaos) -> list[Line]:
    """A line of CSV for each time."""
    word = Order(int(result.labels)).word
    return [Line((case.name, word, time, None if math.isnan(value) else value))
            for time, value in zip(result.times.tolist(), result.history.tolist())]


CSV = ("case", "answer", "time", "megno"), lines
