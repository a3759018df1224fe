"""A table on a terminal: aligned columns, in several tables below each other where they are wider than the screen."""
from __future__ import annotations

from collections.abc import Sequence

from .page import NARROW

GAP = 2


def table(rows: Sequence[Sequence[str]], keys: int = 1, width: int | None = None) -> list[str]:
    """Lines of right-aligned cells, two columns apart. width: of a terminal; where the columns do not fit, the others go on in a table below, with the
    first `keys` columns again, or with the first alone where these fill half a line."""
    sizes = [GAP + max(map(len, column)) for column in zip(*rows)]
    fits = max(width, NARROW) if width is not None else sum(sizes)
    again = range(keys if sum(sizes[:keys]) <= fits // 2 else 1)
    lines: list[str] = []
    left = list(range(len(sizes)))
    while left:
        chosen = [] if not lines else list(again)
        while left and (sum(sizes[n] for n in [*chosen, left[0]]) <= fits or len(chosen) == (len(again) if lines else 0)):
            chosen.append(left.pop(0))
        lines += [""] * bool(lines)
        lines += filter(None, ("".join(f"{row[n]:>{sizes[n]}}" for n in chosen).rstrip() for row in rows))
    return lines
