"""What uncertain numbers do to the verdicts, as JSON and text."""
from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

from ...numbers.units import unit_of_key
from ...representation import values_of
from ..terminal.letters import lettered
from ..units import DIGITS, SI, Units
from ..units import number as told

SUBJECTS = {"equilibria": ("hold", "depend"), "fate": ("holds", "depends")}
LONG = 8  # letters of a number in a line
# of the numbers of a witness
UNITS = {"inertia": "kg m^2", "products": "kg m^2", "momentum": "N m s", "torque": "N m"}


def as_dict(found) -> dict:
    """{"uncertain": ...} to be joined to a command's object; nothing where no number is uncertain. Numbers of
    witnesses are texts, to be written into a case file as they stand."""
    if found is None:
        return {}
    numbers = [{"key": key(u), "middle": number(u.middle), "half_width": number(u.half)}
               for u in found.numbers]
    return {"uncertain": {"numbers": numbers, "equilibria": _over(found.equilibria),
                          "fate": _over(found.fate)}}


def _over(over) -> dict | None:
    if over is None:
        return None
    samples = over.samples and (values_of(over.samples, "number seed counts")
                                | {"margin_quantiles": over.samples.margins})
    return values_of(over, "answer verdict because") | {
        "except": over.but or None, "proved_up_to": over.proved,
        **values_of(over, "changes_at parts"), "samples": samples,
        # a state is rounded to doubles as it is read
        "witnesses": [{"verdict": w.verdict} | {
            name: [repr(float(v)).removesuffix(".0") if name == "state" else number(v) for v in values]
            for name, values in w.values.items()} for w in over.witnesses]}


def key(uncertain) -> str:
    """The key of a case file, with the place in its list counted from one."""
    *path, last = uncertain.path
    return ".".join(path) + f"[{last + 1}]" if isinstance(last, int) else ".".join(uncertain.path)


def number(value: Fraction) -> str:
    """An exact number as a case file can state it: the shortest decimal where that is exact, else a ratio."""
    shown = repr(float(value)).removesuffix(".0")
    return shown if Fraction(shown) == value else str(value)


def rounded(value: Fraction) -> str:
    """The same for a reader: rounded where the ratio is long (degrees bring digits of pi)."""
    exact = number(value)
    return exact if len(exact) <= LONG else told(float(value), DIGITS)


def in_si(found, units: Units) -> str:
    """Lines that follow what a command says of a case, with rates and angles as a file can state them."""
    return text(found, replace(SI, axes=units.axes))


def text(found, units: Units) -> str:
    """The same in the units of the case; nothing where no number is uncertain."""
    if found is None:
        return ""
    numbers = []
    for u in found.numbers:  # the middle and half the width, with the unit
        unit, one = units.of(unit_of_key(u.path))
        in_unit = rounded if one == 1.0 else lambda v, one=one: told(float(v) * one, DIGITS)
        numbers.append(f"{key(u)} = {in_unit(u.middle)} ± {in_unit(u.half)} {unit}".rstrip())
    lines = [f"uncertain: {', '.join(numbers)}"]
    for name in SUBJECTS:
        over = getattr(found, name)
        lines += [] if over is None else _lines(name, over, units)
    return "\n" + "\n".join(lines)


def first(found, told: str, units: Units) -> str:
    """The text with what the box does to its answer at the end of the first line."""
    words = what_changes(found, units)
    answer, *rest = told.split("\n")
    return "\n".join([f"{answer}; {words}", *rest]) if words else told


def what_changes(found, units: Units) -> str:
    """Whether the answer holds for all uncertain numbers, as a clause; nothing where all are certain."""
    over = found and (found.fate or found.equilibria)
    if not over:
        return ""
    others = (list(dict.fromkeys(w.verdict for w in over.witnesses[1:]
                                 if w.verdict != over.witnesses[0].verdict)) if over is found.fate else [])
    subject = "the fate is" if over is found.fate else "they are"
    return {"holds": f"{subject} the same for all that the uncertain numbers may be"
            + (", but for a set of measure zero" if over.but else ""),
             "depends": f"BUT within the uncertainties also "
                        f"{' or '.join(map(units.axes.sentence, others)) or 'another answer'}",
             "sampled": f"{subject} the same at {over.samples and over.samples.number} sampled points within "
                        f"the uncertainties, without a proof",
             "undecided": f"{subject} undecided within the uncertainties"}[over.answer]


def _lines(subject, over, units) -> list[str]:
    holds, depends = SUBJECTS[subject]
    lead = {"holds": f"{holds} all over the box", "depends": f"{depends} on them",
            "sampled": "the same at all sampled points of the box, without a proof",
            "undecided": "undecided over the box"}
    lines = [f"  {subject}: {lead[over.answer]}"
             + (f": {units.axes.sentence(over.verdict)}" if over.answer in ("holds", "sampled") else ""),
             f"    {lettered(units.words(over.because))}"]
    if over.but:
        lines.append(f"    but for a set of measure zero: {units.words(over.but)}")
    if over.proved and math.isfinite(over.proved):
        lines.append(f"    proved to stay for every change below {over.proved:.6g} times the uncertainties")
    if over.changes_at is not None:
        lines.append(
            f"    flips at {over.changes_at:.6g} times the uncertainties (found by search, checked exactly)")
    elif over.answer == "holds" and over.proved < math.inf:
        lines.append("    no change was found up to 100 times the uncertainties")
    for w in over.witnesses:  # to six digits: JSON has them all
        known, numbers = UNITS | ({"state": "rad/s"} if "torque" in w.values else {}), []
        for name, values in w.values.items():
            unit, one = units.of(known.get(name, ""))
            row = ", ".join(told(float(v) * one, DIGITS) for v in values)
            numbers.append(f"{name} = {row} {unit}".rstrip())
        lines.append(f"    {units.axes.sentence(w.verdict)} at {'; '.join(numbers)}")
    return lines


def open_fate(found) -> bool:
    """Whether the fate is not the same all over the box."""
    return found is not None and found.fate is not None and found.fate.answer != "holds"


def undecided(found) -> bool:
    """Whether a verdict stays without a proof over the box."""
    return (found is not None and any(over is not None and over.answer in ("undecided", "sampled")
                                      for over in (found.equilibria, found.fate)))
