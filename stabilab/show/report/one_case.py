"""One case, or one sweep, as a page: every section with what applies to it, and in words what does not.

The pictures of a motion are the plots that a user can ask for, of each kind it has; the space of the three
rates is turned with the mouse, by a small script of the page. A file with [sweep] has a row a combination,
a column a swept key, and one picture of all motions."""
from __future__ import annotations

import math
from base64 import b64encode
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ...answers.caveats import of_case
from ...answers.certificate import certificate
from ...answers.dissipation.gyrostat import at_start
from ...answers.equilibria import equilibria
from ...answers.motion import Needs, motion
from ...answers.uncertain.fate import uncertain
from ...answers.when import with_tilt
from ...case.read import Burning, Orbiting
from ...errors import Kind, StabilabError, without
from ...physics.equations import derive, invariants
from ...theories.follow import models_of
from ...verify import verify_file
from .. import certification, frame, limiting, narrow, style
from ..picture_kinds import KINDS
from ..plot import subject as subjects
from ..plot import thumbnail, to_file
from ..plot.histogram import SEED, draws_of, is_known
from ..plot.in_space import space_of
from ..plot.over_time import file_axes
from ..plot.path import along
from ..plot.subject import subject
from ..space.drawing import data
from ..terminal import capital, printed, some
from ..text import percentiles
from ..text.badge import badge
from ..text.classification import open_fate, uncertain_text, what_changes
from ..text.headline import exceeded, headline, judged, lines_of, look, two_lines
from ..text.motion import Row, circular_orbit_rows, constants, margins, orbit_headline, shown, state
from ..text.rotations import rotation_rows
from ..text.scene import fates, key_columns, latex, of_all_combinations, of_motions
from ..text.stuck import burn_headline, burn_motion, burn_rows, burn_two_lines, burn_undecided
from ..units import DIGITS, but_for_rounding, number, parameter_unit, units_of, with_unit
from . import formulas, html
from .html import picture
from .tables import equilibrium_table, sensitivity, tiles

DRAWS = 200  # of the uncertain numbers of a page: a second or two


# --- Pictures
def space(item, at_rest, units) -> dict:
    """What the script draws of a subject, the legend, and words on the separatrix. at_rest: equilibria."""
    result = space_of(item, map(printed, item.scene.components), units.rates, at_rest, reaching=True)
    drawn = data(result, lambda places: b64encode(places).decode("ascii"))
    reason = "; ".join(filter(None, (result.caption, result.part)))
    return {"drawn": drawn, "legend": drawn["legend"], "reason": printed(units.axes.sentence(reason)),
            "shapes": {text: result.shape(text) for text in result.legend},
            "clipped": any(max(map(abs, result.box.share(at))) > 1 + 1e-9 for _, branch in result.branches
                           for at in branch.points)}


SHOWN = {kind: row.page for kind, row in KINDS.items() if row.page is not None}
ALONE = ("Every part of the state over time", "No approximate theory comes with these effects.")
OF_THE_FILE = "The rates along the axes of the file, about which its limits are."


def pictures(item, folder: Path, stem: str, deep: bool, units: str = "deg", at_rest=None) -> list[dict]:
    """Draw every plot of a subject (`plot.subject`) that a page shows; file, size in pixels, title and
    caption of each, in order. deep: all kinds, not only those of the motion itself. at_rest: its
    equilibria."""
    result, offered = [], [kind for kind in SHOWN if not subjects.why_not(kind, item)]
    # what another part of the page has: table and space the single points, the plane what is wrapped round a
    # surface
    case, bodily = item.case, subjects.bodily(item)
    # a sketch of the body shows more than its moments: effects, or axes that the file has not
    acted_on = (bodily and bodily.effects) or case.thrusters or case.frame and not case.frame.as_given
    spared = {"equilibria": at_rest is not None and not at_rest.curves, "body": not acted_on,
              "histogram": item.draws is None or not is_known(item.draws),
              "nutation": not subjects.nutates(item),
              "sphere": "phase" in offered and not subjects.free(item), "state": subjects.rates_alone(item)}
    exact_alone = models_of(item.scene) == ("exact",)
    for kind, page in SHOWN.items():
        if kind in offered and (deep or page.brief) and not spared.get(kind):
            title, caption = page.title, page.caption
            if kind == "state" and exact_alone:
                title, caption = ALONE
            if kind == "time" and file_axes(item) is not None:
                caption = OF_THE_FILE
            if kind == "time":
                caption += _later(item)
            path = folder / f"{stem}-{kind}.png"
            made, *more = to_file.write_all(item, path, kind, page.size, units=units,
                                            narrow=narrow.beside(path), titled=page.titled)
            result.append(picture(made, narrow.beside(path), caption=caption, kind=kind, title=title,
                                 place=page.place, more=[path.name for path in more],
                                 command=f"stabilab plot {item.path} --kind {kind}"))
    return result


def _lacks_nothing(kind: str, item) -> bool:
    """Whether a picture belongs to cases of another kind alone: with uncertain numbers, or dampers."""
    return (kind == "nutation" and not subjects.nutates(item)
            or kind == "histogram" and not item.case.uncertain)


SMALL_BODY = (3.9, 2.9)  # inches: letters of 9.5 points have 9 px where it is shown 270 px wide


def small_body(item, folder: Path, stem: str, units: str) -> dict | None:
    """The body as a small drawing, with what acts on it; None without a body."""
    if subjects.why_not("body", item):
        return None
    path, *_ = to_file.write_all(item, folder / f"{stem}-small.png", "body", SMALL_BODY, units=units,
                                 titled=False)
    return picture(path)


def card_of(cases, folder: Path) -> dict:
    """What a card says of a case, or of all combinations of a file, its picture drawn into the folder: card
    (its file, or empty), badge, look and line."""
    answered = [(case, _answer(case)[0]) for case in cases]
    moved = [(case, result) for case, result in answered if result is not None]
    if not moved:
        return {"card": "", "badge": "", "look": "", "line": ""}
    looks, badges = {look(result) for _, result in moved}, {badge(result) for _, result in moved}
    made = _thumbnail([(replace(subject(case), known=result), look(result)) for case, result in moved],
                      folder, cases[0].name.removesuffix(cases[0].variant))
    units = units_of(cases[0])
    first = two_lines(*moved[0], units)[0] if len(cases) == 1 else fates([one for _, one in moved], units)
    return {"card": made["file"] if made else "", "look": looks.pop() if len(looks) == 1 else "",
            "badge": badges.pop() if len(badges) == 1 else some(len(cases), "combination"),
            "line": printed(first)}


def _thumbnail(items, folder: Path, stem: str) -> dict | None:
    """The picture of a card, of motions with their looks; None where one cannot be followed."""
    try:
        return picture(thumbnail.write(items, folder / f"{stem}-card.png"))
    except StabilabError:
        return None


def _later(item) -> str:
    """What a picture that ends before a spin-up begins has to say."""
    release = item.motion.evidence.get("release_time")
    if release is None or item.case is None or release <= max(item.seen):
        return ""
    units = units_of(item.case)
    text = printed(units.moment(release) if units.scaled else units.time(release))
    return f" The spin-up begins later: the turn reverses for the last time at {text}."


# --- A case
CHANGES = "What would change the fate"
EXPLAINED = {"margin, rate": ": the smallest change of the rates that reaches the separatrix",
             "margin, energy": ", the barrier ahead less the energy"}


def sections(case, folder: Path, stem: str, deep: bool = True, certify: bool = False) -> dict:
    """Everything that the template says of a case; pictures go into the folder, their names begin with the
    stem.

    deep: also the pictures that a page among many leaves out. certify: write a certificate and check it. What
    the analysis cannot answer stands under "absent" with its reason; nothing of it raises.
    """
    units, absent, item = units_of(case), [], subject(case)
    result = _tried(absent, "Equilibria", lambda: equilibria(case))
    moved = None if case.state is None else _tried(absent, "Motion", lambda: item.motion)
    if moved is not None:
        moved = _tried(absent, "Tilt of the torque", lambda: with_tilt(case, moved)) or moved
        item = replace(item, known=moved)
        if deep and case.uncertain:
            item = replace(item, draws=_tried(absent, "Percentiles",
                                              lambda: draws_of(item, DRAWS, SEED, 1, True)))
    if case.state is None:
        absent.append(("Motion", "the case states none: no fate, margins and pictures of it"))
    request = ("equilibria", "fate") if case.state else ("equilibria",)
    box = _tried(absent, "Uncertain numbers", lambda: uncertain(case, request)) if case.uncertain else None
    answer = f"No motion is given. Equilibria: {result.kind if result else 'not known'}"
    first, small = two_lines(case, moved, units) if moved else (answer, "")
    answer = headline(case, moved, units) if moved else answer
    changes = what_changes(box, units)
    held = moved is None or moved.validity is None or moved.validity.held
    law = "" if held else printed(units.said(moved.validity.reason))
    over = (Kind.UNCERTAIN, Kind.TOLERANCE) if box else (Kind.UNCERTAIN,) if case.uncertain else ()
    caveats = limiting.beside(without(of_case(case) if moved is None else moved.caveats, *over), units,
                              answer)
    page = {"name": case.name, "title": case.heading, "source": case.source,
            "path": case.path, "text": case.text,
            "headline": printed("; ".join(filter(None, (answer, changes)))),
            "first": printed(first), "small": printed("; ".join(filter(None, (small, changes)))),
            "law": law, "exceeded": "" if held else printed(exceeded([(case, moved.validity)], units)),
            "caveats": list(map(printed, caveats)),
            "fate": "" if moved is None else "undecided" if open_fate(box) else moved.fate.word,
            "look": "" if moved is None else "conditional" if open_fate(box) else look(moved),
            "badge": badge(moved, open_fate(box)), "thumbnail": None,
            "tiles": [], "facts": [], "extremes": [], "over": "", "pictures": [], "sensitivity": None,
            "certificate": None,
            "equilibria": result and equilibrium_table(result, units),
            "equations": _tried(absent, "Equations", lambda: equations(case))}
    page["body"] = _tried(absent, "Body", lambda: small_body(item, folder, stem,
                                                             "deg" if units.scaled else units.name))
    if moved is not None:
        page |= {"tiles": tiles(moved, units), "facts": facts(item, moved, units),
                 "extremes": extremes(case, moved, units), "over": _over(units.said(moved.over))}
        page["pictures"] = (_tried(absent, "Pictures",
                                   lambda: pictures(item, folder, stem, deep,
                                                    "deg" if units.scaled else units.name, result)) or [])
        page["thumbnail"] = _thumbnail([(item, page["look"])], folder, stem)
        missing: dict[str, list[str]] = {}  # titles by their reason
        for kind, about in SHOWN.items():
            if not _lacks_nothing(kind, item):
                missing.setdefault(subjects.why_not(kind, item), []).append(about.title)
        absent += [(", ".join(titles), why) for why, titles in missing.items() if why]
        changing = _tried(absent, "Sensitivity", lambda: sensitivity(item, units))
        if changing is None or changing["rows"] or changing["words"]:
            page["sensitivity"] = changing
        else:  # a reason alone makes no section
            absent.append((CHANGES, changing["reason"]))
    page["space"] = _tried(absent, "Space of the rates", lambda: space(item, result, units))
    page["uncertain"] = uncertain_text(box, units)
    page["percentiles"] = "" if item.draws is None else percentiles.text(item.draws, units)
    if certify:
        page["certificate"] = _tried(absent, "Certificate", lambda: _certificate(case, folder, stem))
    return page | {"absent": [(what, printed(units.axes.sentence(why))) for what, why in absent]}


# kind -> title and caption, where they are others of a burn or a satellite on a circular orbit
SPECIAL = {
    "burn": {"time": ("Rates across the switches",
                      "Grey: while a thruster fires; then the free motion after the last closing.")},
    "orbit": {"equilibria": ("The attitudes at rest in the orbital frame",
                             "Blue: stable; vermilion: unstable; amber: undecided. A half turn about the "
                             "orbit normal leads to the other of each pair.")}}
AFTERWARDS = " Of the free motion after the last closing."
WHOLE = ("body", "histogram")  # pictures that are not of what follows a burn alone


def sections_of_special(full: Burning | Orbiting, folder: Path, stem: str, deep: bool = True) -> dict:
    """Everything that the template says of a burn, or of a satellite on a circular orbit: the answer of its
    command, and its pictures."""
    case, item, absent = full.craft, subject(full), []
    units, answer = units_of(case), item.burned
    burning = answer is not None
    if burning:
        line, rows = burn_headline(answer, units), burn_rows(case, answer, units)
        first, small = burn_two_lines(answer, units)
        fate = "undecided" if burn_undecided(answer) else answer.closed.motion.fate.word
        looks = "conditional" if burn_undecided(answer) else look(burn_motion(answer))
    else:
        around = item.orbit
        line, rows = orbit_headline(around.equilibria), circular_orbit_rows(case, around, units)
        first, small = line, ""
        fate = looks = ""
    marked = fate and (fate if fate == "undecided" else badge(burn_motion(answer)))
    every = deep or not burning
    if deep and burning and case.uncertain:
        item = replace(item, draws=_tried(absent, "Percentiles",
                                          lambda: draws_of(subject(full), DRAWS, SEED, 1, True)))
    drawn = _tried(absent, "Pictures", lambda: pictures(item, folder, stem, every, units.name)) or []
    own = SPECIAL["burn" if burning else "orbit"]
    for row in drawn:
        row["title"], row["caption"] = own.get(
            row["kind"], (row["title"], row["caption"] + AFTERWARDS * (burning and row["kind"] not in WHOLE)))
        row["place"] = "motion" if row["place"] == "equilibria" else row["place"]
    missing: dict[str, list[str]] = {}
    for kind, about in SHOWN.items():
        if not _lacks_nothing(kind, item):
            missing.setdefault(subjects.why_not(kind, item), []).append(about.title)
    absent += [(", ".join(titles), why) for why, titles in missing.items() if why]
    caveats = limiting.beside(item.caveats, units, line)
    draws = "" if item.draws is None else percentiles.text(item.draws, units)
    return dict.fromkeys(("law", "exceeded", "over", "uncertain", "sensitivity", "certificate", "equilibria",
                          "equations", "space"), "") | {"percentiles": draws} | {
        "name": case.name, "title": case.heading, "source": case.source, "path": case.path,
        "text": case.text, "headline": printed(line), "first": printed(first),
        "small": capital(printed(small)),
        "caveats": list(map(printed, caveats)), "fate": fate, "look": looks, "badge": marked,
        "thumbnail": _thumbnail([(item, looks)], folder, stem), "tiles": [], "facts": [],
        "extremes": [], "pictures": drawn, "answer": _grouped(rows),
        "absent": [(what, printed(units.axes.sentence(why))) for what, why in absent]}


def _grouped(rows: list[str | Row]) -> list[dict[str, Any]]:
    """Rows of an answer as a page has them: each group is a sentence, or rows that follow each other."""
    groups: list[dict[str, Any]] = []
    for item in rows:
        if isinstance(item, str):
            groups.append({"rows": [], "text": printed(item.strip())})
        else:
            if not groups or groups[-1]["text"]:
                groups.append({"rows": [], "text": ""})
            groups[-1]["rows"].append(tuple(map(printed, item)))
    return groups


def _over(text) -> str:
    """Over which times extremes are known, as the end of a heading."""
    if text == "all time":
        return "for all times"
    if not text.startswith(("finite", "the ")):
        text = f"over {text}"
    return printed(text.replace("finite entries over", "the finite ones over"))


def _tried(absent, what, built):
    """What a function makes; None where the analysis cannot answer, with the reason among the absent."""
    try:
        return built()
    except StabilabError as error:
        absent.append((what, str(error)))
        return None


def facts(item, motion, units) -> list[tuple[str, str]]:
    """(what, its value) of everything known of the motion, in the order in which one asks."""
    case = item.case
    validity, axes = motion.validity, frame.rows_of_axes(case)
    result = [("law", units.said(validity.reason))] if validity is not None and validity.held else []
    at = state(motion.at, units, case.scene.blocks)
    result += [("start", f"{at} at {'τ' if units.scaled else 't'} = 0")]
    result += [] if item.assumed is None else [("limit", item.assumed.words(units))]
    result += [("because", units.said(motion.reason).removeprefix("undecided: "))]
    result += [] if motion.ending is None else [("its end", units.said(motion.ending.reason))]
    explained = EXPLAINED | ({"margin, rate": ""} if motion.velocity_reason else {})
    result += [(name, text + explained.get(name, "")) for name, text in margins(motion, units)]
    result += [("margin, rate", units.said(motion.velocity_reason))] if motion.velocity_reason else []
    if motion.ending is not None and motion.ending.angular and any(case.scene.vector("gyrostat")):
        rows = rotation_rows(case, at_start(case), units)
        result += [(name or rows[n - 1][0], text) for n, (name, text) in enumerate(rows)]
    result += [("frame", frame.lines(case)[0].removeprefix("frame: "))] if axes else []
    result += [(f"axis {name}", text) for name, text in axes]
    return [(name, printed(text)) for name, text in (*result, *constants(motion, units))]


def extremes(case, motion, units) -> list[dict]:
    """A row a component: least and greatest rate, and the bounds for all times where these are others."""
    if motion.extremes is None:
        return []
    name, item = units.rates

    def told(value, side):
        if value in (math.inf, -math.inf):
            return "no end" if value > 0 else "no end downwards"
        return printed(f"{shown(value, item, side=side)} {name}".rstrip())
    side = motion.extremes_side
    bounds = motion.bounds if motion.bounds is not None and motion.bounds != motion.extremes else [None] * 3
    pairs = but_for_rounding(motion.extremes, motion.tolerance)
    return [{"name": printed(component), "least": told(low, -side), "greatest": told(high, side),
             "within": "" if bound is None else " to ".join(map(told, bound, (-1, 1)))}
            for component, (low, high), bound in zip(case.scene.components, pairs, bounds)]


def equations(case) -> dict:
    """Equations of motion, parameters and laws, typeset."""
    built, physical = derive(case.scene), case.variables == "physical"
    unit = lambda name: f" {parameter_unit(name)}".rstrip() if physical else ""
    return {"equations": formulas.equations_of_motion(built), "latex": latex(built),
            "parameters": [(formulas.symbol(name), printed(number(float(value), DIGITS) + unit(name)))
                           for name, value in built.parameters.items()],
            "laws": [(printed(units_of(case).said(law.reason)), formulas.law(law))
                     for law in invariants(case.scene)]}


def _certificate(case, folder: Path, stem: str) -> dict:
    """A certificate beside the page, checked by the code that shares nothing with the analysis."""
    built = certificate(case.scene, case.exact_state)
    path = certification.write(built, folder / f"{stem}-certificate.json")
    result = verify_file(path)
    return {"file": path.name, "summary": certification.summary(built).splitlines(), "status": result.status,
            "findings": certification.as_dict(result, {})["findings"]}


# --- A sweep
STYLES = ("-", "--", ":", "-.")
WIDTHS = (1.0, 1.8, 2.6)
POINTS = 801


def sections_of_sweep(cases, folder: Path, stem: str) -> dict:
    """What the template says of the combinations of one file; the picture goes into the folder."""
    units, first = units_of(cases[0]), cases[0]
    keys = [key_columns(cases, location) for location in range(len(first.swept))]
    answered = [(case, *_answer(case)) for case in cases]
    moved = [(case, result) for case, result, _ in answered if result is not None]
    motions = [motion for _, motion in moved]
    heads, table = of_motions(motions, units) if motions else ([], [])
    text = iter(table)
    cells = [[why] if result is None else next(text) for _, result, why in answered]
    rows = [{"name": case.name, "values": [column[n] for key in keys for _, _, column in key],
             "told": list(map(printed, cells[n])), "fate": "" if result is None else result.fate.word}
            for n, (case, result, _) in enumerate(answered)]
    caveats = dict.fromkeys(item for case in cases for item in of_case(case))
    without = len(cases) - len(motions)
    answers, visited = [fates(motions, units)] if motions else [], set(map(look, motions))
    answers += [f"without a motion: {without}"] if without else []
    laws = [(case, result and result.validity) for case, result, _ in answered]
    beyond = [(case, None if law is None or law.held else law) for case, law in laws]
    return {"name": stem, "title": first.title or stem,
            "caveats": [printed(line) for line in limiting.beside(caveats, units)],
            "heads": [with_unit(head, unit) for head, unit in heads],
            "source": first.source, "path": first.path, "text": first.text, "rows": rows,
            "keys": [with_unit(label.replace("_", " "), unit) for key in keys for label, unit, _ in key],
            "equations": _equations(first),
            "picture": _picture(moved, keys, cases, units, folder / f"{stem}-sweep.png") if moved else None,
            "thumbnail": _thumbnail([(replace(subject(case), known=result), look(result))
                                     for case, result in moved], folder, stem) if moved else None,
            "badge": badge(motions[0]) if len({badge(of) for of in motions}) == 1
            else some(len(rows), "combination"),
            "headline": of_all_combinations(len(motions), answers[0]) if motions and not without
            else f"{some(len(rows), 'combination')}: {'; '.join(answers)}",
            "look": visited.pop() if len(visited) == 1 else "",
            "law": "; ".join(lines_of(beyond, units)), "exceeded": exceeded(beyond, units)}


def _answer(case):
    """(the motion or None, why there is none)."""
    if case.state is None:
        return None, "no motion is given"
    try:
        return judged(case, motion(case.scene, case.start, case.span, Needs.QUICK, case.exact_state)), ""
    except StabilabError as error:
        return None, str(error)


def _places(case):
    """Which value of each key a combination has."""
    return [int(word) - 1 for word in case.variant.split("-")[1:]]


def _equations(case):
    try:
        return equations(case) | {"kind": equilibria(case).kind}
    except StabilabError:
        return None


def _picture(moved, keys, cases, units, path):
    """The rates' size over time of all combinations: colour, dashes, width by the first three keys."""
    followed = [replace(subject(case), known=result) for case, result in moved]
    until = max(max(entry.seen) for entry in followed)
    (unit, item), (clock, per) = units.rates, units.times(until)
    letter = "ω" if unit else "x"
    with style.drawing() as plt:
        figure, ax = plt.subplots(figsize=(9.0, 4.8), layout="constrained")
        for each in followed:
            t, states = along(each, np.linspace(0.0, until, POINTS))
            ax.plot(t * per, np.linalg.norm(states, axis=1) * item, **_look(_places(each.case)))
        ax.set(xlim=(0.0, until * per), xlabel=f"time ({clock})" if unit else "τ",
               ylabel=with_unit(f"|{letter}|", unit))
        style.legend(figure, list(_legend(keys, cases)), columns=3)
        return html.picture(*narrow.save_both(figure, path),
                            caption=f"The size of the rates, |{letter}|, of every combination.")


def _look(places):
    first, second, third = (*places, 0, 0, 0)[:3]
    return {"color": style.SERIES[first % len(style.SERIES)], "linestyle": STYLES[second % len(STYLES)],
            "linewidth": WIDTHS[third % len(WIDTHS)]}


def _legend(keys, cases):
    """A row a value of each of the first three keys."""
    for location, columns in enumerate(keys[:3]):
        # value -> the first combination that has it
        first = {_places(case)[location]: n for n, case in reversed(list(enumerate(cases)))}
        for at, n in sorted(first.items()):
            look = _look([at if m == location else 0 for m in range(3)])
            text = ", ".join(f"{label.replace('_', ' ')} = {cells[n]} {unit}".rstrip() for label, unit,
                              cells in columns)
            yield text, look if location == 0 else look | {"color": style.GREY}
