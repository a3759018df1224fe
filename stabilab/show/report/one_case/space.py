"""The space of the three rates, to be turned by hand, as numbers that a small script of the page draws."""
from __future__ import annotations

from base64 import b64encode
from dataclasses import replace

from ...plot.in_space import space_of
from ...plot.subject import subject
from ...space import data
from ...terminal.letters import printed


def space(case, motion, found_equilibria, units) -> dict:
    """What the script draws, and the rows of the legend; `reason`: what is to be said of the separatrix."""
    found = space_of(replace(subject(case), known=motion), map(printed, case.scene.components), units.rates,
                     found_equilibria, reaching=True)
    drawn = data(found, lambda places: b64encode(places).decode("ascii"))
    reason = "; ".join(filter(None, (found.words, found.part)))
    return {"drawn": drawn, "legend": drawn["legend"], "reason": printed(units.words(reason)),
            "clipped": any(max(map(abs, found.box.share(at))) > 1 + 1e-9 for _, branch in found.branches
                           for at in branch.points)}
