"""A file with [sweep] as one page: a row a combination, a column a swept key, one picture of all motions."""
from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from ....answers.equilibria import equilibria
from ....answers.motion import motion
from ....errors import StabilabError
from ... import limiting, style
from ...plot.path import along
from ...plot.subject import subject
from ...terminal.letters import printed, some
from ...text.headline import look
from ...text.law import judged, lines_of
from ...text.sweep import fates, key_columns, of_motions
from ...units import units_of, with_unit
from .. import html
from .page import equations

STYLES = ("-", "--", ":", "-.")
WIDTHS = (1.0, 1.8, 2.6)
POINTS = 801


def sections(cases, folder: Path, stem: str) -> dict:
    """What the template says of the combinations of one file; the picture goes into the folder."""
    units, first = units_of(cases[0]), cases[0]
    keys = [key_columns(cases, place) for place in range(len(first.swept))]
    answered = [(case, *_answer(case)) for case in cases]
    moved = [(case, found) for case, found, _ in answered if found is not None]
    motions = [motion for _, motion in moved]
    heads, table = of_motions(motions, units) if motions else ([], [])
    told = iter(table)
    cells = [[why] if found is None else next(told) for _, found, why in answered]
    rows = [{"name": case.name, "values": [column[n] for key in keys for _, _, column in key],
             "told": list(map(printed, cells[n])), "fate": "" if found is None else found.fate.word}
            for n, (case, found, _) in enumerate(answered)]
    caveats = dict.fromkeys(one for case in cases for one in case.caveats)
    without = len(cases) - len(motions)
    answers, seen = [fates(motions, units)] if motions else [], set(map(look, motions))
    answers += [f"without a motion: {without}"] if without else []
    laws = [(case, found and found.validity) for case, found, _ in answered]
    beyond = [(case, None if law is None or law.held else law) for case, law in laws]
    return {"name": stem, "title": first.title or stem,
            "caveats": [printed(line) for line in limiting.beside(caveats, units)],
            "heads": [with_unit(head, unit) for head, unit in heads],
            "source": first.source, "path": first.path, "text": first.text, "rows": rows,
            "keys": [with_unit(label.replace("_", " "), unit) for key in keys for label, unit, _ in key],
            "equations": _equations(first),
            "picture": _picture(moved, keys, cases, units, folder / f"{stem}-sweep.png") if moved else None,
            "headline": f"{some(len(rows), 'combination')}: {'; '.join(answers)}",
            "look": seen.pop() if len(seen) == 1 else "",
            "law": "; ".join(lines_of(beyond, units))}


def _answer(case):
    """(the motion or None, why there is none)."""
    if case.state is None:
        return None, "no motion is given"
    try:
        return judged(case, motion(case.scene, case.start, case.span, True, case.exact_state)), ""
    except StabilabError as error:
        return None, str(error)


def _places(case):
    """Which value of each key a combination has."""
    return [int(word) - 1 for word in case.variant.split("-")[1:]]


def _equations(case):
    try:
        return equations(case) | {"kind": equilibria(case.scene).kind}
    except StabilabError:
        return None


def _picture(moved, keys, cases, units, path):
    """The rates' size over time of all combinations: colour, dashes, width by the first three keys."""
    followed = [replace(subject(case), known=found) for case, found in moved]
    until = max(max(one.seen) for one in followed)
    (unit, one), (clock, per) = units.rates, units.times(until)
    letter = "ω" if unit else "x"
    with style.drawing() as plt:
        figure, ax = plt.subplots(figsize=(9.0, 4.8), layout="constrained")
        for each in followed:
            t, states = along(each, np.linspace(0.0, until, POINTS))
            ax.plot(t * per, np.linalg.norm(states, axis=1) * one, **_look(_places(each.case)))
        ax.set(xlim=(0.0, until * per), xlabel=f"time ({clock})" if unit else "τ",
               ylabel=with_unit(f"|{letter}|", unit))
        style.legend(figure, list(_legend(keys, cases)), columns=3)
        return html.picture(style.save(figure, path),
                            caption=f"The size of the rates, |{letter}|, of every combination.")


def _look(places):
    first, second, third = (*places, 0, 0, 0)[:3]
    return {"color": style.SERIES[first % len(style.SERIES)], "linestyle": STYLES[second % len(STYLES)],
            "linewidth": WIDTHS[third % len(WIDTHS)]}


def _legend(keys, cases):
    """A row a value of each of the first three keys."""
    for number, columns in enumerate(keys[:3]):
        # value -> the first combination that has it
        first = {_places(case)[number]: n for n, case in reversed(list(enumerate(cases)))}
        for at, n in sorted(first.items()):
            look = _look([at if m == number else 0 for m in range(3)])
            words = ", ".join(f"{label.replace('_', ' ')} = {cells[n]} {unit}".rstrip() for label, unit,
                              cells in columns)
            yield words, look if number == 0 else look | {"color": style.GREY}
