"""`stabilab flat-spin`: what internal dissipation makes of a spin."""
from __future__ import annotations

from dataclasses import replace

from ..answers.dissipation.ask import flat_spin as ask
from ..numbers.units import ANGLE, in_si
from ..show.text import flat_spin as shown
from .common.cases import answers_of, load_cases, tell_all, units_asked
from .common.output import hold_laws, leave_undecided, write_json


def flat_spin(case, within, units, json, strict):
    """Answer a case, every combination where it has a [sweep]."""
    loaded = load_cases([case], motion=True)
    systems = units_asked(loaded, units, within=within)
    angle = in_si(within.strip(), ANGLE, "--within")
    answered = answers_of(loaded, lambda one: ask(one, angle))
    if json:
        write_json(loaded, [shown.as_dict(*one) for one in answered])
    else:
        tell_all([(replace(one, caveats=found.caveats), found) for one, found in answered], systems,
                 shown.text)
    leave_undecided(strict, any(found.outcome == "undecided" for _, found in answered))
    hold_laws(strict, (), loaded)
