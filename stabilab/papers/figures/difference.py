"""How far the printed curves of a figure are from the exact motion: the size of what its wrong formulas
change."""
from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from ...show.text.comparison import short
from ...show.text.cost.words import share
from . import panels
from .figure import Figure


@dataclass(frozen=True)
class Difference:
    """One panel of a figure. quantity: what is drawn upwards, with its unit; column: the panel's heading;
    largest: distance of the printed curve from the exact motion at equal times, the largest over the time
    that both have, in the quantity's unit; reach: range of the exact motion (of a plane its diagonal), in the
    same unit; at: s; status: "compared", or "no curve" with the reason in words."""

    quantity: str
    column: str
    largest: float | None
    reach: float | None
    at: float | None
    status: str
    reason: str = ""

    @property
    def share(self) -> float | None:
        """Largest difference over the range of the exact motion; None where it has no range."""
        return self.largest / self.reach if self.largest is not None and self.reach else None


def differences(figure: Figure) -> tuple[Difference, ...]:
    """A difference for every panel with a printed curve, row by row; none for a figure without."""
    if figure.lines is None:
        return ()
    return tuple(_difference(row, column) for row,
                 columns in figure.lines() for column in columns if "printed" in column.runs)


def _difference(row: panels.Row, column: panels.Column) -> Difference:
    exact, printed = column.runs["exact"], column.runs["printed"]
    curves = [row.pick(run) for run in (exact, printed)]
    names = row.ylabel, column.heading
    if curves[0] is None or curves[1] is None:
        return Difference(*names, None, None, None, "no curve",
                          "the printed formulas do not give this quantity")
    (tx, true), (px, wrong) = ([np.asarray(v, float) for v in curve] for curve in curves)
    n = min(len(true), len(wrong))  # a run that stops early has fewer of the same times
    apart = np.abs(wrong[:n] - true[:n]) if row.over_time else np.hypot(wrong[:n] - true[:n], px[:n] - tx[:n])
    seen = np.isfinite(apart)
    if not seen.any():
        return Difference(*names, None, None, None, "no curve", "the two have no time in common")
    at, times = int(np.argmax(np.where(seen, apart, -1.0))), np.asarray(exact.t)[len(exact.t) - len(true):]
    spans = [float(np.ptp(v[np.isfinite(v)])) for v in ((true,) if row.over_time else (tx, true))]
    return Difference(*names, float(apart[at]), float(np.hypot.reduce(spans)), float(times[at]), "compared")


LETTERS = {r"\\lambda": "λ", r"\\zeta": "ζ", r"\\psi": "ψ", r"\\phi": "φ", r"\\varphi": "φ", r"\\theta": "θ",
           r"\\omega": "ω", r"\\eta": "η", r"\\gamma": "γ",
           r"\\ell": "l", r"\^\{-1\}": "⁻¹", r"\^2": "²", r"\^3": "³", r"\\,": ""}


def words(figure: Figure) -> list[str]:
    """A line per panel with a printed curve: how far it is from the exact motion, and when."""
    return [_words(d) for d in differences(figure)]


def _words(d: Difference) -> str:
    quantity, _, unit = plain(d.quantity).rpartition(" (")
    quantity, unit = (quantity, " " + unit.rstrip(")")) if quantity else (unit, "")
    head = f"{quantity}, {plain(d.column)}: "
    if d.status != "compared":
        return head + d.reason
    part = f" ({share(d.share)} the exact motion's range)" if d.share is not None else ""
    return f"{head}{short(d.largest)}{unit}{part} at t = {d.at:.3g} s"


def plain(label: str) -> str:
    """A label of Matplotlib as text: its letters in Unicode, without dollars and braces; a dot over a letter
    as d/dt, as primes belong to names; a hyphen as a minus."""
    label = re.sub(r"\\dot\{(.*?)\}((?:_\w)?'*)", r"d\1\2/dt", label)
    for pattern, letter in LETTERS.items():
        label = re.sub(pattern, letter, label)
    return re.sub(r"[${}]|_(?=\w)", "", label).replace("-", "−")
