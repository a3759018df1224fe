"""Whether a motion is regular or chaotic, in words, JSON and CSV: the label, how it is known, MEGNO over time."""
from __future__ import annotations

import math
from typing import Any

from ....answers.chaos import Chaos, Order
from ....errors import printable
from ...files import comma
from ...text.answers import as_json

SCHEMA = "stabilab.chaos/1"
FIRST = {Order.REGULAR: "REGULAR as far as it was followed", Order.CHAOTIC: "CHAOTIC", Order.SPIN_UP: "SPIN-UP", Order.UNDECIDED: "UNDECIDED"}


def text(rows: list[tuple[Any, Chaos]]) -> str:
    """A paragraph a case."""
    return "\n".join(_of_one(*row) for row in rows)


def _of_one(case: Any, found: Chaos) -> str:
    """The answer first; then what it means for a small change, and MEGNO at each doubling of the time."""
    label, unit = Order(int(found.labels)), _unit(case)
    lines = [f"{printable(case.name)}: {FIRST[label]}: {found.because}"]
    if label == Order.CHAOTIC:
        rate, error = float(found.lyapunov), float(found.lyapunov_error)
        lines.append(f"  neighbours part at {rate:.3g} ± {error:.1g} per {unit}: a small change doubles in {math.log(2) / rate:.3g} {unit}")
    if label != Order.SPIN_UP:
        lines.append("  an indicator of a finite time, no proof; time and MEGNO:")
        lines += [f"  {time:12.6g} {unit}  {0.0 if abs(value) < 5e-5 else value:9.4f}" for time, value in zip(found.times.tolist(), found.history.tolist())]
    return "\n".join(lines)


def _unit(case: Any) -> str:
    return str(case.scene.time_unit)


def as_dict(case: Any, found: Chaos) -> dict[str, Any]:
    """One object of `stabilab chaos --json`."""
    return {"schema": SCHEMA, "case": case.name, "variables": case.variables, "answer": Order(int(found.labels)).word, "because": found.because,
            "megno": float(found.megno), "lyapunov": float(found.lyapunov), "lyapunov_uncertainty": float(found.lyapunov_error),
            "turn": found.turn, "times": found.times.tolist(), "history": found.history.tolist()}


def json(rows: list[tuple[Any, Chaos]]) -> str:
    """One object a case, a list of them for several."""
    told = [as_dict(*row) for row in rows]
    return as_json(told if len(told) > 1 else told[0])


def csv(rows: list[tuple[Any, Chaos]]) -> str:
    """A line for each case and time."""
    return comma.lines([["case", "answer", "time", "megno"],
                        *([case.name, Order(int(found.labels)).word, time, None if math.isnan(value) else value]
                          for case, found in rows for time, value in zip(found.times.tolist(), found.history.tolist()))])
