"""The space of the three rates, to be turned by hand, as numbers that a small script of the page draws."""
from __future__ import annotations

from base64 import b64encode

from ...plot.in_space import space_of
from ...space import data
from ...terminal.letters import printed


def space(one, at_rest, units) -> dict:
    """What the script draws of a subject, the legend, and words on the separatrix. at_rest: equilibria."""
    found = space_of(one, map(printed, one.scene.components), units.rates, at_rest, reaching=True)
    drawn = data(found, lambda places: b64encode(places).decode("ascii"))
    reason = "; ".join(filter(None, (found.words, found.part)))
    return {"drawn": drawn, "legend": drawn["legend"], "reason": printed(units.words(reason)),
            "clipped": any(max(map(abs, found.box.share(at))) > 1 + 1e-9 for _, branch in found.branches
                           for at in branch.points)}
