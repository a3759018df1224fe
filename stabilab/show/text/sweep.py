"""All combinations of a [sweep] as one table: a column a key that varies, then the answer's numbers."""
from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from ...numbers.units import DIMENSIONS, NAMES
from .. import limiting
from ..terminal import page
from ..terminal.letters import greek, some
from ..units import SHORT, Units, but_for_rounding, number
from .headline import WORDS, known_as, rate_margin
from .motion import shown

LETTERS = {"angular_velocity": "ω", "mu": "μ"}  # keys with a shorter name
Column = tuple[str, str, Callable]  # its head, its unit, and what it says of a motion


def groups(cases: Sequence) -> list[list[int]]:
    """Indices of cases that belong together: all combinations of one file, or a case by itself."""
    found: list[list[int]] = []
    for n, case in enumerate(cases):
        if case.variant and found and cases[found[-1][-1]].path == case.path and cases[found[-1][-1]].variant:
            found[-1].append(n)
        else:
            found.append([n])
    return found


def text(cases: Sequence, answer: str, columns: Sequence[tuple[str, str]],
         rows: Sequence[Sequence[str]]) -> str:
    """The answer in a line, then the table. columns: (head, unit) after the swept keys; rows: one a case."""
    keys = swept_columns(cases)
    heads = [name for name, *_ in keys] + [head for head, _ in columns]
    units = [unit for _, unit, _ in keys] + [unit for _, unit in columns]
    cells = [[values[n] for *_, values in keys] + list(row) for n, row in enumerate(rows)]
    lines = page.table([heads, units, *cells], len(keys), page.width())
    name = cases[0].name.removesuffix(cases[0].variant)
    return "\n".join([f"{name}: {some(len(cases), 'combination')}: {answer}", *lines])


def swept_columns(cases: Sequence) -> list[tuple[str, str, list[str]]]:
    """(head, unit, a cell a case) of every swept key; of a vector the components that vary. A value with a
    unit of its own is told as written."""
    return [column for place in range(len(cases[0].swept)) for column in key_columns(cases, place)]


def key_columns(cases: Sequence, place: int) -> list[tuple[str, str, list[str]]]:
    """(head, unit, a cell a case) of one swept key, the number of which is `place`."""
    key, values = cases[0].swept[place][0], [case.swept[place][1] for case in cases]
    path = key.split(".")
    alone = sum(other.split(".")[-1] == path[-1] for other, _ in cases[0].swept) == 1
    label = ".".join(LETTERS.get(word, word) for word in path[-1 if alone else -2:])
    # a matrix: which of those in the file
    if any(isinstance(v, list) and any(isinstance(one, list) for one in v) for v in values):
        return [(label, "", [f"no. {case.variant.split('-')[1 + place]}" for case in cases])]
    if all(isinstance(v, list) and len(v) == len(values[0]) for v in values):
        moving = [i for i in range(len(values[0])) if len({repr(v[i]) for v in values}) > 1] or [0]
        return [(f"{label}[{i + 1}]", _unit(key, [v[i] for v in values]), [str(v[i]) for v in values])
                for i in moving]
    return [(label, _unit(key, values), [str(v) for v in values])]


def _unit(key: str, values) -> str:
    """The unit of plain numbers of a key; nothing where they bring their own."""
    path = key.split(".")
    of = DIMENSIONS.get(".".join([path[0], path[-1]]) if path[0] in ("thrusters", "wheels") else key)
    if of is None or not all(re.fullmatch(r"[-+.\d_eE/ ]+", str(value)) for value in values):
        return ""
    return greek(NAMES[of].partition("(")[2].rstrip(")"))


def counted(answers: Sequence[tuple], words: Mapping[str, str], units: Units, between: str) -> str:
    """How many of the (fate, caveats) have which fate, with the condition that these share."""
    counts, told = Counter(fate for fate, _ in answers), []
    for fate, count in counts.most_common():
        where = limiting.shared([caveats for one, caveats in answers if one == fate], units)
        name = (words[fate].removesuffix(" for ever") if where else words[fate]) + where
        told.append(f"{name}: {count}" if len(counts) > 1 else f"each {name}")
    return between.join(told)


def fates(motions: Sequence, units: Units) -> str:
    """How many motions have which fate, and the range of their largest rates."""
    words = counted([(motion.fate.word, motion.caveats) for motion in motions], WORDS, units, ", ")
    sizes = [size for size in map(_largest, motions) if size is not None]
    if not sizes:
        return words
    low, high = number(min(sizes) * units.rates[1]), units.rate(max(sizes), SHORT)
    return f"{words}; largest rate " + (high if high.split()[0] == low else f"{low} to {high}")


def _largest(motion):
    """|omega| at the most, or a bound of it."""
    pairs = motion.extremes if motion.bounds is None else motion.bounds
    if motion.largest is not None or pairs is None or any(None in pair for pair in pairs):
        return motion.largest
    bound = math.hypot(*(max(map(abs, pair)) for pair in pairs))
    return bound if bound < math.inf else None


def of_motions(motions: Sequence, units: Units) -> tuple[list[tuple[str, str]], list[list[str]]]:
    """Columns and rows of fate, axis, largest rate, margins and period, without those that say nothing."""
    name, one = units.rates
    longest = max((m.period for m in motions if m.period is not None), default=0.0)
    time, per_time = units.times(longest)
    columns = [("limit", "", lambda m: limiting.reached(m.caveats, units)),
               ("fate", "", lambda m: m.fate.word + known_as(m)),
             ("axis", "", lambda m: units.axes.signed(m.axis, m.sense)),
             ("largest rate", name, lambda m: "" if _largest(m) is None else number(_largest(m) * one, 6)),
             ("margin", name, lambda m: rate_margin(m, units, 6).removesuffix(f" {name}") if name
              else rate_margin(m, units, 6)),
             ("to barrier", units.of("J")[0],
              lambda m: "" if m.margin_energy is None else shown(m.margin_energy)),
             ("period", time, lambda m: "" if m.period is None else number(m.period * per_time, 6))]
    return filled(columns, motions)


def of_extremes(motions: Sequence, names: Sequence[str],
                units: Units) -> tuple[list[tuple[str, str]], list[list[str]]]:
    """Columns and rows of the fate, and of least and greatest of every component."""
    name, one = units.rates
    motions = [replace(m, extremes=but_for_rounding(m.extremes, m.tolerance)) for m in motions]
    columns: list[Column] = [("fate", "", lambda m: m.fate.word + known_as(m))]
    for i, component in enumerate(names):
        for end, word in enumerate(("least", "most")):
            columns.append((f"{greek(component)} {word}", name, lambda m, i=i,
                            end=end: "" if m.extremes is None else shown(m.extremes[i][end], one)))
    return filled(columns, motions)


def filled(columns: Sequence[Column], answers: Sequence) -> tuple[list[tuple[str, str]], list[list[str]]]:
    """(columns, rows) of those columns that say something of an answer."""
    rows = [[words(one) for _, _, words in columns] for one in answers]
    kept = [n for n in range(len(columns)) if any(row[n] for row in rows)]
    return [columns[n][:2] for n in kept], [[row[n] for n in kept] for row in rows]
