"""Whether a motion is regular or chaotic, in words, JSON and CSV: the label, how it is known, MEGNO over time."""
from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from ....answers.caveats import caveats_of
from ....answers.chaos import FLAT, Chaos, Order
from ....errors import printable
from ...files import comma
from ...limiting import cell
from ...text import law
from ...text.answers import as_json

SCHEMA = "stabilab.chaos/1"
FIRST = {Order.REGULAR: "REGULAR as far as it was followed", Order.CHAOTIC: "CHAOTIC", Order.SPIN_UP: "SPIN-UP", Order.UNDECIDED: "UNDECIDED"}


def text(rows: list[tuple[Any, Chaos]]) -> str:
    """A paragraph a case."""
    return "\n".join(_of_one(*row) for row in rows)


def _of_one(case: Any, found: Chaos) -> str:
    """The answer first; then what it means for a small change, and MEGNO at each doubling of the time."""
    label, unit = Order(int(found.labels)), _unit(case)
    resting = label == Order.REGULAR and not found.megno < FLAT
    lines = [f"{printable(case.name)}: {'REGULAR' if resting else FIRST[label]}: {found.because}"]
    if label == Order.CHAOTIC:
        rate, error = float(found.lyapunov), float(found.lyapunov_error)
        lines.append(f"  neighbours part at {rate:.3g} ± {error:.1g} 1/{unit}: a small change doubles in {math.log(2) / rate:.3g} {unit}")
    if label != Order.SPIN_UP:
        lines.append("  an indicator of a finite time, no proof; time and MEGNO:")
        lines += [f"  {time:12.6g} {unit}  {0.0 if abs(value) < 5e-5 else value:9.4f}" for time, value in zip(found.times.tolist(), found.history.tolist())]
    return "\n".join(lines)


def swept(rows: list[tuple[Any, Chaos]]) -> tuple[str, list[tuple[str, str]], list[list[str]]]:
    """(the answer in a line, columns, rows) of a sweep: how many motions are what, and of each MEGNO at the last time; where one
    is chaotic, also how soon neighbours part."""
    labels = [Order(int(found.labels)) for _, found in rows]
    told = ", ".join(f"{labels.count(one)} {FIRST[one]}" for one in Order if one in labels)
    cells = [[FIRST[label].split()[0], f"{found.times[-1] / found.turn:,.0f}", _number(float(found.megno), ".4f"),
              _number(math.log(2) / float(found.lyapunov) if label == Order.CHAOTIC else math.nan, ".3g")] for label, (_, found) in zip(labels, rows)]
    columns = [("motion", ""), ("turns", ""), ("MEGNO", ""), ("doubles in", _unit(rows[0][0]))]
    shown = len(columns) if Order.CHAOTIC in labels else -1
    return told, columns[:shown], [row[:shown] for row in cells]


def _number(value: float, form: str) -> str:
    """Nothing where it is not known, and no sign where it rounds to zero."""
    return "" if math.isnan(value) else format(0.0 if abs(value) < 5e-5 else value, form)


def _unit(case: Any) -> str:
    return str(case.scene.time_unit)


def as_dict(case: Any, found: Chaos) -> dict[str, Any]:
    """One object of `stabilab chaos --json`."""
    return {"schema": SCHEMA, "case": case.name, "variables": case.variables, "answer": Order(int(found.labels)).word, "because": found.because,
            "megno": float(found.megno), "lyapunov": float(found.lyapunov), "lyapunov_uncertainty": float(found.lyapunov_error),
            "turn": found.turn, "times": found.times.tolist(), "history": found.history.tolist()}


def json(rows: list[tuple[Any, Chaos]], laws: Sequence[Any]) -> str:
    """One object a case, a list of them for several. laws: how far the approximate laws of each hold, or None."""
    told = [as_dict(*row) | law.key(held, row[0]) for row, held in zip(rows, laws)]
    return as_json(told if len(told) > 1 else told[0])


def csv(rows: list[tuple[Any, Chaos]], laws: Sequence[Any]) -> str:
    """A line for each case and time. laws: as of `json`."""
    told = [cell(case, caveats_of(case.scene, validity=held, file=case.caveats)) for (case, _), held in zip(rows, laws)]
    return comma.lines([["case", "answer", "time", "megno", "caveats"],
                        *([case.name, Order(int(found.labels)).word, time, None if math.isnan(value) else value, caveats]
                          for (case, found), caveats in zip(rows, told) for time, value in zip(found.times.tolist(), found.history.tolist()))])
