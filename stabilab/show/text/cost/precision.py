"""What accuracy costs, shown: as a table, in words, as CSV, JSON and the work-precision picture."""
from __future__ import annotations

import math
from pathlib import Path

from ....answers.caveats import caveats_of
from ....cost.accuracy import digit_price
from ....files import write_text
from ....packages import demand
from ....processes import machine, versions
from ... import limiting, style
from ...data import csv_lines
from ...files import endings
from ...report.precision_picture import picture
from ...terminal.letters import written
from .words import NAMES, by_digits, caption, duration, flat, methods, setting, title, words

COLUMNS = ("case", "question", "method", "setting", "value", "error", "digits", "steps", "evaluations",
           "seconds", "slowest", "repeats", "compile_seconds", "lanes", "parts", "on_front")


def text(found, all_settings: bool = False) -> str:
    """The cheapest method for each number of digits; with all settings their table, too, * marking the front,
    and the words. rates: how often the rates were evaluated; the slowest run is in CSV and JSON."""
    told = words(found)
    answer = next((line for line in told if "six digits cost" in line), told[0])
    lines = [f"{found.case.name}: {answer}", *([written(found.case.title)] if found.case.title else []),
             *(["", *_by_digits(found)] if by_digits(found) else [])]
    if not all_settings:
        return "\n".join([*lines, "", "--all prints every setting of every method."])
    for question in found.questions:
        front = set(map(id, found.front(question)))
        lines += ["", title(found, question),
                  f"  {'method':<13}{'setting':<13}{'error':>8}{'digits':>8}{'steps':>8}{'rates':>8}"
                  f"{'time':>10}{'compile':>9}"]
        lines += [_line(p, id(p) in front) for p in found.of(question)]
    left_out: dict = {}  # reason -> the methods that it holds for, each from its coarsest setting on
    for name, value, why in found.left_out:
        left_out.setdefault(why, {}).setdefault(name, []).append(value)
    for why, settings in left_out.items():
        coarsest = [f"{name}, {values[0]:g}{' and finer' if len(values) > 1 else ''}"
                    for name, values in settings.items()]
        lines.append(f"  left out: {'; '.join(coarsest)}: {why}")
    return "\n".join([*lines, "", *told, "", caption()])


def _by_digits(found):
    """The table by digits wanted: the cheapest method, its time, that of fewest digits as one, the second."""
    lines = [f"{'digits':>6}  {'cheapest':<40}{'time':>10}{'times 3 digits':>16}  second best"]
    for row in by_digits(found):
        second = row["second"]
        other = "" if second is None else f"{NAMES.get(second['method'], second['method'])}: " + duration(
            second["seconds"])
        lines.append(f"{row['digits']:>6}  {NAMES.get(row['method'], row['method']):<40}"
                     f"{duration(row['seconds']):>10}{row['relative']:>16.3g}  {other}".rstrip())
    return [*lines, *filter(None, [flat(found)])]


def _line(p, best) -> str:
    error = "none" if math.isinf(p.error) else f"{p.error:.1e}"
    counts = "".join(f"{'' if n is None else n:>{width}}" for n, width in ((p.steps, 8), (p.evaluations, 8)))
    times = f"{duration(p.seconds):>10}{duration(p.compile) if p.compile > 1e-4 else '':>9}"
    return (f"{'*' if best else ' '} "
            f"{p.method:<13}{setting(p)[2:]:<13}{error:>8}{p.digits:>8.1f}{counts}{times}".rstrip())


def as_dict(found) -> dict:
    """The object of `stabilab precision --json`. Errors are null where no answer came."""
    r = found.reference
    return {"schema": "stabilab.precision/1", "case": found.case.name, "time": found.case.scene.time_unit,
            "quick": found.quick,
            "times": r.t, "machine": machine(), "versions": versions(),
            "reference": {"digits": r.digits, "error": float(r.error.max()) if len(r.t) else None,
                          "status": r.status,
                          "reason": r.reason, "multiplications": r.work, "period": r.period and r.period[0],
                          "period_error": r.period and r.period[2], "extremes_error": r.extremes_error},
            "sensitivity": found.sensitivity, "points": [_row(found, p) for p in found.points],
            "digit_price": {q: {m: digit_price(found.of(q, m)) for m in methods(found, q)}
                            for q in found.questions},
            "by_digits": by_digits(found),
            "fates": [vars(f) for f in found.fates],
            "left_out": [{"method": m, "value": v, "reason": why} for m, v, why in found.left_out],
            "words": words(found)}


def _row(found, p) -> dict:
    values = (found.case.name, p.question, p.method, p.setting, p.value, p.error, min(p.digits, 99.0),
              p.steps, p.evaluations, p.seconds,
              p.slowest, p.repeats, p.compile, p.lanes, p.parts, any(p is q for q in found.front(p.question)))
    return dict(zip(COLUMNS, values))


def csv(*measured) -> str:
    """One line per point of every case; empty where a count does not exist, inf where no answer came."""
    lines: list = [(*COLUMNS, "caveats")]
    for found in measured:
        case = found.case
        caveats = caveats_of(case.scene, validity=found.validity, file=case.caveats)
        lines += [(*_row(found, p).values(), limiting.cell(case, caveats)) for p in found.points]
    return csv_lines(lines)[:-1]


def write(found, path, size=None, most=None) -> Path:
    """The picture (.png, .svg, .pdf) or the points (.csv). size, most: as of `picture`."""
    path = checked(path)
    if endings.ending(path) == ".csv":
        return write_text(path, csv(found) + "\n")
    with style.drawing() as plt:
        return style.save(picture(plt, found, size, most), path)


def checked(path) -> Path:
    """The path, if its ending is one that can be written."""
    path = endings.file(path, (*endings.PICTURES, ".csv"))
    if endings.ending(path) != ".csv":
        demand(*style.PACKAGES)
    return path
