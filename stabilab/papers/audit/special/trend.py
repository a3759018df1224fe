"""Claims that compare: how a quantity goes as a parameter grows, or on which side of zero it is."""
from __future__ import annotations

GOES = {"rises": lambda change, size: change > size, "falls": lambda change, size: change < -size,
        "stays": lambda change, size: abs(change) <= size}
ROUNDING = 1e-9  # a smaller relative change is none


def missed(values, goes: str) -> int:
    """How many steps between neighbouring values do not go as the word says."""
    return sum(not GOES[goes](after - before, ROUNDING * max(abs(before), abs(after)))
               for before, after in zip(values, values[1:]))


def trend(values, goes: str, truth: str = "") -> tuple[int, int]:
    """The two residuals of a claim that values go as `goes`, while they go as `truth`."""
    return missed(values, goes), missed(values, truth or goes)


def side(value: float, lies: str) -> tuple[float, float]:
    """The two residuals of a claim that a value is "above" or "below" zero; the second of its opposite."""
    below, above = max(0.0, -value), max(0.0, value)
    return (below, above) if lies == "above" else (above, below)
