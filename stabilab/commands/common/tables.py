"""The answers of several cases as text: one after the other, or the combinations of a [sweep] as one table.
"""
from __future__ import annotations

from ...show.terminal import page, sweep
from ...show.text import law


def tell_all(cases, texts, laws, boxes, full, between, swept, systems):
    """Text of every case to stdout; the combinations of a [sweep] as one table, unless all is asked for in
    full. texts: functions, a case each; swept(indices): (answer in a line, columns, rows) of a table;
    systems: the units of each."""
    if full or not any(case.variant for case in cases):
        page.tell(between.join(law.first(held, text(), units, _of(case, box)) + box
                               for case, text, held, box, units in zip(cases, texts, laws, boxes, systems)))
        return
    told = []
    for of in sweep.groups(cases):
        words = sweep.text([cases[n] for n in of], *swept(of)) if cases[of[0]].variant else texts[of[0]]()
        caveats = dict.fromkeys(one for n in of for one in _of(cases[n], boxes[n]))
        told.append(law.first(law.worst(*(laws[n] for n in of)), words, systems[of[0]], caveats)
                    + "".join(dict.fromkeys(boxes[n] for n in of)))
    page.tell("\n\n".join(told))


def _of(case, box):
    """The caveats of a case; without that on uncertain numbers where the words on their box follow."""
    return [one for one in case.caveats if not box or one.kind != "uncertain"]


def swept_motions(motions, systems):
    """How `tell_all` tells the motions of a sweep."""
    def table(of):
        chosen = [motions[n] for n in of]
        if None in chosen:
            return f"{sum(m is None for m in chosen)} of them state no motion", [], [[] for _ in of]
        return sweep.fates(chosen, systems[of[0]]), *sweep.of_motions(chosen, systems[of[0]])
    return table


def swept_extremes(cases, motions, systems):
    """How `tell_all` tells the extremes of a sweep."""
    def table(of):
        chosen = [motions[n] for n in of]
        return sweep.fates(chosen, systems[of[0]]), *sweep.of_extremes(chosen, cases[of[0]].scene.components,
                                                                       systems[of[0]])
    return table
