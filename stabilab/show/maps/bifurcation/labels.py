"""Where labels above a panel stand: in as few rows as keep them apart."""
from __future__ import annotations

from collections.abc import Sequence

GLYPH = 0.64  # width of a digit of the house's font over the size of the font
GAP = 4.0  # points between two labels of a row


def rows_apart(places: Sequence[float], texts: Sequence[str], size: float, rows: int) -> list[int | None]:
    """The row (0 is the lowest) of each text, centred at a rising place and in a font of so many points, such
    that no two of a row meet.

    places: in points. None where no row has room.
    """
    ends = [-float("inf")] * rows
    out: list[int | None] = []
    for place, text in zip(places, texts):
        half = 0.5 * GLYPH * size * len(text)
        row = next((n for n, end in enumerate(ends) if place - half >= end + GAP), None)
        if row is not None:
            ends[row] = place + half
        out.append(row)
    return out
