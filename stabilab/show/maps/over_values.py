"""What stands above a panel over one number: how many equilibria there are, and where that changes."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

# of the values above the panel: points, rows at the most, inches of the figure beside the panel
SIZE, ROWS, MARGIN = 7.5, 3, 1.2
GLYPH = 0.64  # width of a digit of the house's font over the size of the font
GAP = 4.0  # points between two labels of a row


def counts_above(ax: Any, ends: tuple[float, float], pieces: Sequence[tuple[float, float, str]],
                 values: Sequence[float]) -> None:
    """How many there are in each piece (low, high, words), and the values between, above a panel whose axis
    goes from end to end."""
    whole = ends[1] - ends[0]
    for low, high, words in pieces:
        if high - low > 0.03 * whole:
            ax.annotate(words, (0.5 * (low + high), 1.0), xycoords=("data", "axes fraction"),
                        xytext=(0, 3), textcoords="offset points", ha="center", va="bottom", fontsize=9,
                        fontweight="bold")
    shown = sorted((value, f"{value + 0.0:.5g}") for value in values if value not in ends)
    wide = 72 * (ax.figure.get_figwidth() - MARGIN) / whole
    places = [wide * (value - ends[0]) for value, _ in shown]
    for (value, told), row in zip(shown, rows_apart(places, [told for _, told in shown], SIZE, ROWS)):
        if row is not None:
            ax.annotate(told, (value, 1.0), xycoords=("data", "axes fraction"),
                        xytext=(0, 16 + 1.3 * SIZE * row), textcoords="offset points",
                        ha="center", va="bottom", fontsize=SIZE)


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
