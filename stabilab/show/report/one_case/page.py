"""One case as a page: every section with what applies to it, and in words what does not."""
from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

from ....answers.certificate import certificate
from ....answers.equilibria import equilibria
from ....answers.uncertain.fate import uncertain
from ....answers.when import with_tilt
from ....errors import StabilabError
from ....physics.equations import derive, invariants
from ....verify import verify_file
from ... import certification, frame, limiting
from ...axes import axes_of
from ...plot import subject as which
from ...plot.subject import subject
from ...terminal.letters import greek, printed
from ...text import uncertain as boxes
from ...text.headline import headline, look
from ...text.motion import constants, margins, shown, state
from ...text.scene import latex
from ...units import DIGITS, but_for_rounding, number, parameter_unit, units_of
from .. import typeset
from .pictures import SHOWN, pictures
from .space import space
from .tables import equilibrium_table, sensitivity
from .tiles import tiles

EXPLAINED = {"margin, rate": ": the smallest change of the rates that reaches the separatrix",
             "margin, energy": ", the barrier ahead less the energy"}


def sections(case, folder: Path, stem: str, deep: bool = True, certify: bool = False) -> dict:
    """Everything that the template says of a case; pictures go into the folder, their names begin with the
    stem.

    deep: also what takes seconds (a tilt of the torque). certify: write a certificate and check it. What the
    analysis cannot answer stands under "absent" with its reason; nothing of it raises.
    """
    units, absent, one = units_of(case), [], subject(case)
    found = _tried(absent, "Equilibria", lambda: equilibria(case.scene))
    moved = None if case.state is None else _tried(absent, "Motion", lambda: one.motion)
    if deep and moved is not None:
        moved = _tried(absent, "Tilt of the torque", lambda: with_tilt(case, moved)) or moved
        one = replace(one, known=moved)
    if case.state is None:
        absent.append(("Motion", "the case states none: no fate, margins and pictures of it"))
    asked = ("equilibria", "fate") if case.state else ("equilibria",)
    box = _tried(absent, "Uncertain numbers", lambda: uncertain(case, asked)) if case.uncertain else None
    answer = f"No motion is given. Equilibria: {found.kind if found else 'not known'}"
    answer = headline(case, moved, units) if moved else answer
    beyond = "" if moved is None or moved.validity is None or moved.validity.held else moved.validity.words
    caveats = limiting.beside((one for one in case.caveats if one.kind != "uncertain"), units)
    page = {"name": case.name, "title": case.heading, "source": case.source,
            "path": case.path, "text": case.text,
            "headline": printed("; ".join(filter(None, (answer, boxes.what_changes(box, units))))),
            "law": printed(units.words(beyond)), "caveats": list(map(printed, caveats)),
            "fate": "" if moved is None else "undecided" if boxes.open_fate(box) else moved.fate.word,
            "look": "" if moved is None else "conditional" if boxes.open_fate(box) else look(moved),
            "tiles": [], "facts": [], "extremes": [], "over": "", "pictures": [], "sensitivity": None,
            "certificate": None,
            "equilibria": found and equilibrium_table(found, units),
            "equations": _tried(absent, "Equations", lambda: equations(case))}
    if moved is not None:
        page |= {"tiles": tiles(moved, units), "facts": facts(case, moved, units),
                 "extremes": extremes(case, moved, units), "over": _over(units.words(moved.extremes_over))}
        page["pictures"] = (_tried(absent, "Pictures",
                                   lambda: pictures(one, folder, stem, deep,
                                                    "deg" if units.scaled else units.name, found)) or [])
        missing: dict[str, list[str]] = {}  # titles by their reason
        for kind, (title, _) in SHOWN.items():
            missing.setdefault(which.why_not(kind, one), []).append(title)
        absent += [(", ".join(titles), why) for why, titles in missing.items() if why]
        page["sensitivity"] = _tried(absent, "Sensitivity", lambda: sensitivity(one, units))
    page["space"] = _tried(absent, "Space of the rates", lambda: space(one, found, units))
    page["uncertain"] = greek(boxes.text(box, units))
    if certify:
        page["certificate"] = _tried(absent, "Certificate", lambda: _certificate(case, folder, stem))
    return page | {"absent": [(what, printed(units.words(why))) for what, why in absent]}


def _over(words) -> str:
    """Over which times extremes are known, as the end of a heading."""
    if words == "all time":
        return "for all times"
    if not words.startswith(("finite", "the ")):
        words = f"over {words}"
    return printed(words.replace("finite entries over", "the finite ones over"))


def _tried(absent, what, made):
    """What a function makes; None where the analysis cannot answer, with the reason among the absent."""
    try:
        return made()
    except StabilabError as error:
        absent.append((what, str(error)))
        return None


def facts(case, motion, units) -> list[tuple[str, str]]:
    """(what, its value) of everything known of the motion, in the order in which one asks."""
    validity, axes, words = motion.validity, frame.rows_of_axes(case), units.words
    found = [("law", words(validity.words))] if validity is not None and validity.held else []
    at = state(motion.at, units, case.scene.blocks)
    found += [("start", f"{at} at {'tau' if units.scaled else 't'} = 0")]
    found += [("because", words(motion.because.removeprefix("undecided: ")))]
    explained = EXPLAINED | ({"margin, rate": ""} if motion.velocity_because else {})
    found += [(name, told + explained.get(name, "")) for name, told in margins(motion, units)]
    found += [("margin, rate", words(motion.velocity_because))] if motion.velocity_because else []
    found += [("frame", frame.lines(case)[0].removeprefix("frame: "))] if axes else []
    found += [(f"axis {name}", told) for name, told in axes]
    return [(name, printed(told)) for name, told in (*found, *constants(motion, units))]


def extremes(case, motion, units) -> list[dict]:
    """A row a component: least and greatest rate, and the bounds for all times where these are others."""
    if motion.extremes is None:
        return []
    name, one = units.rates

    def told(value):
        if value in (math.inf, -math.inf):
            return "no end" if value > 0 else "no end downwards"
        return printed(f"{shown(value, one)} {name}".rstrip())
    bounds = motion.bounds if motion.bounds is not None and motion.bounds != motion.extremes else [None] * 3
    pairs = but_for_rounding(motion.extremes, motion.tolerance)
    return [{"name": printed(component), "least": told(low), "greatest": told(high),
             "within": "" if bound is None else " to ".join(map(told, bound))}
            for component, (low, high), bound in zip(case.scene.components, pairs, bounds)]


def equations(case) -> dict:
    """Equations of motion, parameters and laws, typeset."""
    made, physical = derive(case.scene), case.variables == "physical"
    unit = lambda name: f" {parameter_unit(name)}".rstrip() if physical else ""
    return {"equations": typeset.equations_of_motion(made), "latex": latex(made),
            "parameters": [(typeset.symbol(name), printed(number(float(value), DIGITS) + unit(name)))
                           for name, value in made.parameters.items()],
            "laws": [(printed(axes_of(case).sentence(law.words)), typeset.law(law))
                     for law in invariants(case.scene)]}


def _certificate(case, folder: Path, stem: str) -> dict:
    """A certificate beside the page, checked by the code that shares nothing with the analysis."""
    made = certificate(case.scene, case.exact_state)
    path = certification.write(made, folder / f"{stem}-certificate.json")
    found = verify_file(path)
    return {"file": path.name, "summary": certification.summary(made).splitlines(), "status": found.status,
            "findings": certification.as_dict(found, {})["findings"]}
