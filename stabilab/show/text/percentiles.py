"""Percentiles over the uncertain numbers of a case in words, JSON and CSV."""
from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from ...errors import printable
from ...representation import values_of
from .. import limiting
from ..data import Endless, endless
from ..units import SHORT, Unit, Units, number
from . import questions

if TYPE_CHECKING:
    from ...case.read import Case
    from ...maps.percentiles import Distribution, Fraction95, Percentiles, Quantile

COLUMNS = ("case", "quantity", "of", "low", "high", "least", "greatest")
HEADS = {"reached": "reached by", "never": "never by", "unknown": "not known of"}
NO_END = {"time": "never", "largest": "without end", "closing": "whenever"}


def text(result: Percentiles, units: Units) -> str:
    """Lines below an answer: shares of the draws, then quantiles, each with its bounds, and what limits them.
    """
    lines = [f"{printable(result.name)}, {drawn(result.number)} of the uncertain numbers (seed "
             f"{result.seed}), in brackets 95 % bounds:"]
    if result.outcomes:
        lines.append("  " + ", ".join(f"{word} {_share(of)}" for word, of in result.outcomes.items()))
    if result.limit is not None and result.reached:
        aim = questions.asked(result.limit, units)
        lines.append(f"  {aim}: " + ", ".join(f"{HEADS[name]} {_share(of)}"
                                              for name, of in result.reached.items()))
    closing = "" if result.below is None else f"latest closing for |ω| < {units.rate(result.below, SHORT)}"
    for name, label, item in (("time", "time", result.time), ("largest", "largest |ω|", result.largest),
                              ("closing", closing, result.closing)):
        if item is not None:
            lines.append(f"  {label}: {_quantiles(item, name, units)}")
    return "\n".join([*lines, *limiting.lines(result.caveats, units)])


def drawn(number: int) -> str:
    """So many draws in words."""
    return f"{number:,} draw{'s' * (number != 1)}"


def _share(of: Fraction95) -> str:
    low, high = (number(100 * v, 3) for v in (of.low, of.high))
    return f"{number(100 * of.fraction, SHORT)} % [{low}, {high}]"


def _quantiles(item: Distribution, name: str, units: Units) -> str:
    sizes = [v for q in item.quantiles for v in (q.low, q.high, q.least, q.greatest)
             if v is not None and math.isfinite(v)]
    if not sizes:
        return NO_END[name]
    unit = units.of("rad/s") if name == "largest" else units.times(max(sizes, default=0.0))
    parts = [f"{'median' if q.percent == 50 else f'{q.percent} %'} {_of(q, name, unit)}"
             for q in item.quantiles]
    return f"{', '.join(parts)} {unit[0]}".rstrip()


def _of(q: Quantile, name: str, unit: Unit) -> str:
    """"145.2 [144.6, 145.7]"."""
    def shown(value: float | None, digits: int = SHORT) -> str:
        return ("?" if value is None else NO_END[name] if math.isinf(value)
                else number(value * unit[1], digits))
    near = q.low == q.high or math.isclose(q.low, q.high, rel_tol=1e-6)
    value = shown(q.high) if near else f"{shown(q.low)} to {shown(q.high)}"
    return f"{value} [{shown(q.least)}, {shown(q.greatest)}]"


def as_dict(case: Case, results: Sequence[Percentiles]) -> dict[str, Any]:
    """{"percentiles": ...} to be joined to a command's object, a list of those of each thruster alone; empty
    where there are none."""
    if not results:
        return {}
    found = [_as_dict(case, item) for item in results]
    return {"percentiles": found if any(item.thruster for item in results) else found[0]}


def _as_dict(case: Case, result: Percentiles) -> dict[str, Any]:
    """In SI units. 1e999: never, or without end; null: too few draws for a bound."""
    shares = lambda of: {name: values_of(item, "count fraction low high") for name, item in of.items()}
    limit = result.limit
    return {
        **({"thruster": result.thruster} if result.thruster else {}),
        **values_of(result, "number draws seed confidence"),
        "limit": limit and {"kind": limit.kind, "quantities": limit.names, "limits": limit.limits},
        "reached": shares(result.reached), "outcomes": shares(result.outcomes),
        "time": _distribution(result.time), "largest": _distribution(result.largest),
        "below": result.below, "closing": _distribution(result.closing),
        **limiting.key(case, result.caveats)}


def _distribution(item: Distribution | None) -> dict[str, Any] | None:
    if item is None:
        return None
    edges, counts, beyond = item.histogram()
    ends = lambda q: {name: value if value is None else Endless(value)
                      for name, value in values_of(q, "low high least greatest").items()}
    return {"unit": item.unit, "quantiles": [{"percent": q.percent} | ends(q) for q in item.quantiles],
            "histogram": {"edges": edges, "counts": counts, "beyond": beyond}}


def lines(result: Percentiles) -> list[limiting.Line]:
    """Lines of CSV: a share or a quantile each."""
    rows = [(kind, name, of.fraction, of.fraction, of.low, of.high)
            for kind, shares in (("outcome", result.outcomes), ("limit", result.reached))
            for name, of in shares.items()]
    rows += [(name, f"{q.percent} %", *endless([q.low, q.high, q.least, q.greatest]))
             for name, item in (("time", result.time), ("largest", result.largest),
                                ("closing", result.closing)) if item is not None
             for q in item.quantiles]
    return [limiting.Line((result.name, *row), caveats=result.caveats) for row in rows]
