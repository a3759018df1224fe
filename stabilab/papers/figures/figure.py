"""One figure of a paper: its number, what it shows, what the paper printed, and how to draw it; figure 1 of
each paper, its model; and how far printed curves are from true ones: level curves in a plane, lines beside
the exact motion."""
from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Any

import numpy as np

from ...case.read import Case
from ...show import style
from ...show.plot.body import BOX, PARTS, body
from ...show.plot.in_space import levels
from ...show.terminal import written
from ...show.text.cost import share, short
from ..families import FAMILIES, SPANS, WAVES, Family, sweep
from . import panels


@dataclass(frozen=True)
class Figure:
    """One figure: draw(plt) -> matplotlib figure, or a list of those over which it is divided; text: the
    caption, exact: how exact the curves are, each a text or a function that forms it from what is drawn;
    paper: the short name under which the command knows it, "" for the constant-torque paper; lines: a
    function that gives the figure's lines (panels.Row, columns) where it sets printed curves beside the exact
    motion (see `differences`); added: the paper has no such figure, and its number comes after the paper's
    last; cases: (case file, variant of its sweep) of each motion that it draws -> what a link to it says."""

    number: int
    title: str
    text: str | Callable[[], str]
    draw: Callable
    exact: str | Callable[[], str]
    paper: str = ""
    lines: Callable | None = None
    added: bool = False
    cases: Mapping[tuple[str, str], str] = field(default_factory=dict)

    @cached_property
    def caption(self) -> str:
        return written(self.text() if callable(self.text) else self.text)

    @cached_property
    def tolerance(self) -> str:
        return self.exact() if callable(self.exact) else self.exact

    @property
    def file(self) -> str:
        return f"{self.paper or 'figure'}-{self.number:02d}.png"

    def pictures(self, plt) -> dict:
        """File name -> matplotlib figure: figure-NN.png, and figure-NN-2.png, ... where it is divided."""
        drawn = self.draw(plt)
        parts = drawn if isinstance(drawn, list) else [drawn]
        return {self.file.replace(".", f"-{n}." if n > 1 else "."): part for n, part in enumerate(parts, 1)}

    @property
    def command(self) -> str:
        return f"stabilab figures{f' --paper {self.paper}' if self.paper else ''} {self.number} --out figures"


def listed(values: Sequence[float] | Mapping[str, Any], form: str = "{:.3g}") -> str:
    """Numbers in words: "1.2, 3.4 and 5.6"."""
    phrases = [form.format(v) for v in values]
    return f"{', '.join(phrases[:-1])} and {phrases[-1]}" if len(phrases) > 1 else "".join(phrases)


SKETCH = ("a sketch: directions and the proportions of the box are those of the case, lengths of arrows are "
          "not")


def model_figure(name: str, paper: str = "") -> Figure:
    """Figure 1 of a paper, from a case file of the repository: the body with every effect of its scene."""
    return Figure(1, "The model", lambda: _of_model(sweep(name)[""]),
                  lambda plt: body(sweep(name)[""], size=(7.2, 6.6), bare=True).figure, SKETCH, paper,
                  cases={(name, ""): name})


def _of_model(case: Case) -> str:
    """The caption: the case, and what is drawn of it."""
    parts = ", ".join([BOX, *(PARTS[effect.name][0] for effect in case.physical.effects)])
    return f"Drawn from the case {case.name} by what its scene contains: {parts}."


def family_figures(paper: str, kinds: dict, lines: Callable, models: str, rows: Sequence,
                   looks: Callable[[int, str], dict] = lambda number, kind: {}) -> list[Figure]:
    """The figures of families of motions, a row each: number, name of the family, kind, caption, more of it.

    kinds: kind -> (title, rows of panels); lines(name, kind): the figure's lines (panels.Row, columns);
    caption: a text, or a function of the family's name and of what more the row has; models: how exact the
    models beside the exact motion are; looks(number, kind): of `panels.draw_lines`."""
    return [_of_family(FAMILIES[paper][name], paper, number, kinds[kind][0],
                       partial(caption, name, *more) if callable(caption) else caption,
                       partial(lines, name, kind), models, looks(number, kind))
            for number, name, kind, caption, *more in rows]


def _of_family(family: Family, paper, number, title, caption, lines, models, looks) -> Figure:
    span, more = SPANS[paper], "; rates by central differences" if title == "Phase planes" else ""

    def exact() -> str:
        return f"{panels.exactness(family.runs(span))}; {models}; {span.count} points{more}"
    return Figure(number, f"{title}: {family.name}", caption,
                  lambda plt: panels.draw_lines(plt, title + family.rest, lines(), **looks), exact, paper,
                  lines, cases=links(family))


def links(*all_families: Family) -> dict[tuple[str, str], str]:
    """Each case of the families -> its number that is varied, of a combination of a sweep also the others,
    and its name; of a motion with the wheel that waves need, that its file has another."""
    result: dict[tuple[str, str], str] = {}
    for family in all_families:
        for value, (file, variant) in family.cases.items():
            rest = family.rest if variant not in ("", WAVES) else ""
            name = f"{file}, there with another wheel" if variant == WAVES else file + variant
            numbers = plain(f"{family.symbol} = {value:g} {family.unit}{rest}".replace("=", " = "))
            result.setdefault((file, variant), f"{' '.join(numbers.split())} ({name})")
    return result


# --- Level curves of an integral in a plane
PRINTED = style.MEANING["printed"] | {"linestyle": "--", "linewidth": 1.6}
GRID_POINTS = 1201  # of the grid on which a level curve is traced, along each axis
PIECES = 16    # of a piece of a curve, where it is cut off at an edge


def level_curves(integral: Callable, level: float, x_range: Sequence, y_range: Sequence) -> list[np.ndarray]:
    """The curves integral(x, y) = level in a rectangle, arrays (n, 2) each, traced on a grid; where the
    integral has no real value there is no curve."""
    x, y = (np.linspace(low, high, GRID_POINTS) for low, high in (x_range, y_range))
    with np.errstate(invalid="ignore", divide="ignore"):
        values = integral(*np.meshgrid(x, y))
    return levels(x, y, np.ma.masked_invalid(values), [level])


def within(curve: np.ndarray, x_range: Sequence, y_range: Sequence) -> np.ndarray:
    """The curve (n, 2), each of its pieces divided, with NaN for what lies outside of a rectangle."""
    low, high = np.transpose([x_range, y_range])
    location = np.arange(len(curve) * PIECES - PIECES + 1) / PIECES
    curve = np.stack([np.interp(location, np.arange(len(curve)), values) for values in curve.T], axis=-1)
    return np.where(((curve >= low) & (curve <= high)).all(axis=1, keepdims=True), curve, np.nan)


def farthest(printed: Sequence, true: Sequence) -> float:
    """Largest distance from a point of the printed curves to the nearest point of the true ones; arrays
    (..., 2) or (..., 3) of points each, the true ones close together; NaN is no point."""
    from scipy.spatial import cKDTree
    points, others = (np.concatenate([np.reshape(part, (-1, np.shape(part)[-1])) for part in curves])
                      for curves in (printed, true))
    points, others = (result[np.isfinite(result).all(axis=1)] for result in (points, others))
    tree, tried = cKDTree(others), points[::PIECES]
    nearest = tree.query(tried)[0]
    # no distance grows by more than the step to a point: few of those between can be farther
    step = np.linalg.norm(points - np.repeat(tried, PIECES, axis=0)[:len(points)], axis=1)
    left = points[np.repeat(nearest, PIECES)[:len(points)] + step >= nearest.max()]
    return float(tree.query(left)[0].max())


@dataclass(frozen=True)
class Difference:
    """One panel of a figure. quantity: what is drawn upwards, with its unit; column: the panel's heading;
    largest: distance of the printed curve from the exact motion at equal times, the largest over the time
    that both have, in the quantity's unit; reach: range of the exact motion (of a plane its diagonal), in the
    same unit; at: s; status: "compared", or "no curve", which `note` explains."""

    quantity: str
    column: str
    largest: float | None
    reach: float | None
    at: float | None
    status: str
    note: str = ""

    @property
    def share(self) -> float | None:
        """Largest difference over the range of the exact motion; None where it has no range."""
        return self.largest / self.reach if self.largest is not None and self.reach else None


def differences(figure: Figure) -> tuple[Difference, ...]:
    """A difference for every panel with a printed curve, row by row; none for a figure without."""
    if figure.lines is None:
        return ()
    return tuple(_difference(row, column)
                 for row, columns in figure.lines() for column in columns if "printed" in column.runs)


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
    visited = np.isfinite(apart)
    if not visited.any():
        return Difference(*names, None, None, None, "no curve", "the two have no time in common")
    at, times = int(np.argmax(np.where(visited, apart, -1.0))), np.asarray(exact.t)[len(exact.t) - len(true):]
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
        return head + d.note
    part = f" ({share(d.share)} the exact motion's range)" if d.share is not None else ""
    return f"{head}{short(d.largest)}{unit}{part} at t = {d.at:.3g} s"


def plain(label: str) -> str:
    """A label of Matplotlib as text: its letters in Unicode, without dollars and braces; a dot over a letter
    as d/dt, as primes belong to names; a hyphen as a minus."""
    label = re.sub(r"\\dot\{(.*?)\}((?:_\w)?'*)", r"d\1\2/dt", label)
    for pattern, letter in LETTERS.items():
        label = re.sub(pattern, letter, label)
    return re.sub(r"[${}]|_(?=\w)", "", label).replace("-", "−")
