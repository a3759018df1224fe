"""A page of the report: what accuracy costs, for every case with a motion."""
from __future__ import annotations

from pathlib import Path

from ...cost import accuracy as measuring
from ...errors import InputError
from ...physics.equations import derive
from ..text.cost.precision import write
from ..text.cost.words import caption, duration, setting, words
from . import html

PRICED = (3, 6, 9, 12)  # digits of the table over all cases


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
    return html.write(folder / "precision.html", "precision.html", cases=sections, passed=passed,
                      machine=caption(), priced=PRICED, **around)


def kind(case) -> tuple:
    """What cases have in common that are measured alike: cases of one kind obey the same equations with other
    numbers, the torque along the same axes."""
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
        picture = f"precision/{write(found, folder / 'precision' / f'{case.name}.png').name}"
    write(found, folder / "precision" / f"{case.name}.csv")
    front = found.front("span")
    return {"name": case.name, "title": case.title or case.name, "words": words(found), "picture": picture,
            "csv": f"precision/{case.name}.csv",
            "command": f"stabilab precision {case.path}", "error": f"{found.reference.error.max():.0e}",
            "prices": [next((f"{duration(p.seconds)}, {p.method}" for p in front if p.digits >= n), "–")
                       for n in PRICED],
            "front": [{"digits": f"{p.digits:.1f}", "method": p.method, "setting": setting(p)[2:],
                       "time": duration(p.seconds)} for p in front]}, None
