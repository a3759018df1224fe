"""One case as a page: every section with what applies to it, and in words what does not."""
from __future__ import annotations

from pathlib import Path

from ....answers.equilibria import equilibria
from ....answers.passage.of_case import with_tilt
from ....answers.uncertain.verdicts import uncertain
from ....errors import StabilabError
from ... import limiting
from ...plot import which
from ...plot.subject import subject
from ...terminal.letters import greek
from ...text import uncertain as shown
from ...units import units_of
from . import certified, verdict
from .equations import equations
from .equilibria import table
from .measures import Measures, spoken
from .pictures import SHOWN, pictures
from .sensitivity import sensitivity
from .space import space


def sections(case, folder: Path, stem: str, deep: bool = True, certify: bool = False) -> dict:
    """Everything that the template says of a case; pictures go into the folder, their names begin with the stem.

    deep: also what takes seconds (a tilt of the torque). certify: write a certificate and check it. What the analysis cannot answer stands
    under "absent" with its reason; nothing of it raises.
    """
    units = units_of(case)
    measures, absent, one = Measures(units), [], subject(case)
    found = _tried(absent, "Equilibria", lambda: equilibria(case.scene))
    moved = None if case.state is None else _tried(absent, "Motion", lambda: one.motion)
    if deep and moved is not None:
        moved = _tried(absent, "Tilt of the torque", lambda: with_tilt(case, moved)) or moved
    if case.state is None:
        absent.append(("Motion", "the case states none: no fate, margins and pictures of it"))
    asked = ("equilibria", "fate") if case.state else ("equilibria",)
    box = _tried(absent, "Uncertain numbers", lambda: uncertain(case, asked)) if case.uncertain else None
    answer = "; ".join(filter(None, (verdict.headline(case, moved, found, measures), shown.what_changes(box, units))))
    page = {"name": case.name, "title": case.heading, "source": case.source, "path": case.path, "text": case.text, "headline": answer,
            "law": verdict.law(moved, measures),
            "caveats": [spoken(line) for line in limiting.beside((one for one in case.caveats if one.kind != "uncertain"), units)],
            "fate": "" if moved is None else "undecided" if shown.open_fate(box) else moved.fate.word,
            "facts": [], "extremes": [], "invariants": [], "over": "", "pictures": [], "sensitivity": None, "certificate": None,
            "equilibria": found and table(found, measures), "equations": _tried(absent, "Equations", lambda: equations(case))}
    if moved is not None:
        over = _over((measures.reason if measures.physical else spoken)(moved.extremes_over))
        page |= {"facts": verdict.rows(case, moved, measures), "extremes": verdict.extremes(case, moved, measures), "over": over,
                 "invariants": verdict.invariants(moved, measures)}
        page["pictures"] = _tried(absent, "Pictures", lambda: pictures(one, folder, stem, deep, "deg" if units.scaled else units.name)) or []
        absent += [(title, why) for kind, (title, _) in SHOWN.items() if (why := which.why_not(kind, one))]
        page["sensitivity"] = _tried(absent, "Sensitivity", lambda: sensitivity(case, moved, measures))
    page["space"] = _tried(absent, "Space of the rates", lambda: space(case, moved, found, measures))
    page["uncertain"] = greek(shown.text(box, units))
    if certify:
        page["certificate"] = _tried(absent, "Certificate", lambda: certified.certificate_of(case, folder, stem))
    return page | {"absent": [(what, measures.reason(why)) for what, why in absent]}


def _over(words) -> str:
    """Over which times extremes are known, as the end of a heading."""
    if words == "all time":
        return "for all times"
    return words.replace("finite entries over", "the finite ones over") if words.startswith(("finite", "the ")) else f"over {words}"


def _tried(absent, what, made):
    """What a function makes; None where the analysis cannot answer, with the reason among the absent."""
    try:
        return made()
    except StabilabError as error:
        absent.append((what, str(error)))
        return None
