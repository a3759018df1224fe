"""A page of the report: what accuracy costs, for every case with a motion."""
from __future__ import annotations

from pathlib import Path

from ...cost import accuracy as measuring
from ...errors import InputError
from ...physics.equations import derive
from ..text.cost.precision import write
from ..text.cost.words import DOUBLES, NAMES, by_digits, caption, duration, flat, so_many, words
from . import html

SHORT = {"reduced": "closed form", "reference": "many digits"}
STATES = "precision/states.png"
ONE = (7.0, 5.8)  # inches of a picture of the states alone
FIRST = "minor-axis-100"  # the motion that the page begins with, where it was measured


def page(cases, folder, tell=None, passed=(), **around) -> Path:
    """Measure every case that has a motion and a span and write precision.html with its pictures and points
    (in precision/) into the folder; returns its path. The first case of every kind (the same equations, the
    same axis of the torque) is measured with every method and drawn; the others, with the methods that are
    likely to be best, are told in words. passed: lines on cases that are left out; around: of the pages
    beside it (`html.render`)."""
    folder, tell, sections, passed, seen = Path(folder), tell or (lambda words: None), [], list(passed), set()
    for case in cases:
        if case.state is None or case.span is None:
            passed.append(f"{case.name}: no motion with a span")
            continue
        tell(f"precision of {case.name}")
        of = kind(case)
        section, why = _section(case, folder, "glance" if of in seen else "brief")
        if section is None:
            passed.append(f"{case.name}: {why}")
            continue
        seen.add(of)
        sections.append(section)
    drawn = [section for section in sections if section["picture"]]
    first = next((section for section in drawn if section["name"] == FIRST), drawn[0] if drawn else None)
    opening = first and (STATES if first["name"] == FIRST else first["picture"])
    return html.write(folder / "precision.html", "precision.html", cases=sections, passed=passed, first=first,
                      opening=opening, machine=caption(), priced=DOUBLES, **around)


def kind(case) -> tuple:
    """What cases have in common that are measured alike: equations but for numbers, axes of the torque."""
    equations = derive(case.scene, case.blocks)
    acting = tuple(m != 0 for m in case.scene.quadratic().m) if case.scene.plain else ()
    return equations.blocks, tuple(map(str, equations.rhs)), acting


def _section(case, folder, effort):
    """(what the template says of a case, None), or (None, why nothing could be measured)."""
    try:
        found = measuring.precision(case, effort)
    except InputError as error:
        return None, str(error)
    if not found.questions:
        return None, found.reference.reason
    picture = None
    if effort == "brief":
        if case.name == FIRST:
            write(found, folder / STATES, ONE, most=1)
        picture = f"precision/{write(found, folder / 'precision' / f'{case.name}.png').name}"
    write(found, folder / "precision" / f"{case.name}.csv")
    rows = {row["digits"]: row for row in by_digits(found)}
    return {"name": case.name, "title": case.title or case.name, "words": words(found), "picture": picture,
            "csv": f"precision/{case.name}.csv", "flat": flat(found), "times": len(found.reference.t),
            "command": f"stabilab precision {case.path}", "error": f"{found.reference.error.max():.0e}",
            "prices": [_price(rows.get(digits)) for digits in DOUBLES],
            "rows": [{"digits": row["digits"], "relative": so_many(row["relative"], 3),
                      "method": NAMES.get(row["method"], row["method"]), "time": duration(row["seconds"]),
                      "second": second and NAMES.get(second["method"], second["method"]),
                      "its": second and duration(second["seconds"])}
                     for row in rows.values() for second in [row["second"] or ""]]}, None


def _price(row) -> str:
    """The cheapest time for some digits, with the method where that is no Taylor series."""
    if row is None:
        return "–"
    named = "" if row["method"] == "taylor" else f", {SHORT.get(row['method'], row['method'])}"
    return duration(row["seconds"]) + named
