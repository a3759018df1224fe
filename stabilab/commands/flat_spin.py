"""`stabilab flat-spin`: what internal dissipation makes of a spin."""
from __future__ import annotations

from dataclasses import replace

from ..answers.dissipation.ask import flat_spin as ask
from ..case.read import blamed_on
from ..numbers.units import ANGLE, in_si
from ..show.text import flat_spin as shown
from .common.cases import load_cases, one_by_one, tell_all, tell_radians, units_asked
from .common.output import hold_laws, leave_undecided, write_json


def flat_spin(path, within, units, json, strict):
    """Answer a case, every combination where it has a [sweep]."""
    loaded, found = load_cases([path], motion=True), []
    systems = units_asked(loaded, units)
    tell_radians(systems[0], within=within)
    angle = in_si(within.strip(), ANGLE, "--within")
    for case in one_by_one(loaded):
        with blamed_on(case):
            found.append(ask(case, angle))
    if json:
        write_json(loaded, list(map(shown.as_dict, loaded, found)))
    else:
        told = [replace(case, caveats=one.caveats) for case, one in zip(loaded, found)]
        texts = [lambda n=n: shown.text(loaded[n], found[n], systems[n]) for n in range(len(loaded))]
        tell_all(told, texts, [None] * len(loaded), [""] * len(loaded), True, "\n\n", lambda of: [],
                 systems)
    leave_undecided(strict, any(one.outcome == "undecided" for one in found))
    hold_laws(strict, (), loaded)
