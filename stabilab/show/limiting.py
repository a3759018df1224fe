"""What limits an answer, in text: a limit that comes first, the condition beside a verdict, and a line for
all else."""
from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

from .. import errors
from ..answers.caveats import HOLDS, in_short
from ..errors import Caveat, Kind
from ..reasons import Reason, in_si
from . import ending
from .axes import axes_of
from .data import csv_lines
from .terminal import LINE, clauses_of
from .units import SHORT, Units

if TYPE_CHECKING:
    from ..case.read import Case

LAW_JUDGED = "law-judged"  # of `physics.law_limits`, which is not loaded where all laws are exact
AHEAD = {Kind.THRUSTERS: "no thruster fires"}  # what a first line says before the answer
# What limits an answer in few words, for a picture with no room for more, the kind that takes most first
IN_BRIEF = {Kind.LAW: "a law is left", Kind.UNPHYSICAL: "no body has this tensor",
            Kind.THRUSTERS: "no thruster fires", Kind.LIMIT: "reaches its limit",
            Kind.TILT: "a tilt of the torque counts",
            Kind.UNSTABLE: "not known to be stable", Kind.TOLERANCE: "tolerance left out",
            Kind.MISALIGNMENT: "misalignment left out", Kind.SAMPLES: "samples, no proof",
            Kind.UNCERTAIN: "of the middles of uncertain numbers", Kind.MOTOR: "a motor without an end",
            Kind.BURN: "burn as stated", Kind.SIZE: "size or mass beyond reason",
            Kind.DISTRIBUTION: "of a box of uncertain numbers", Kind.STATED: "a caveat of the file"}
# the same of single sentences, by their codes
BRIEFLY = {
    "law-judged": "law of {effect} left", "no-such-body": "no body has these moments",
    "reaches-limit": "{limit} after {time} ({level})", "limit-at-start": "{limit} at the start already",
    "tilted-reaches": "{varied}: {limit} after {time} ({level})",
    "tilted-not-before": "{varied}: not before {time}",
    "tilted-not-found": "{varied}: not found within {time}",
    "cone-none-found": "{varied}: not found within {time}",
    "cone-not-looked-at": "a tilt is not looked at", "cone-fates": "{varied} it {fates}",
    "cone-runs-end": "{varied}: {limit} earlier or later",
    "cone-all-reach": "{varied}: {limit} after {first}",
    "cone-some-reach": "{varied}: {limit} after {first}",
    "cone-some-runs-end": "{varied}: {limit} after {first}",
    "unstable-equilibrium": "unstable: factor e in {time}", "unstable-not-exponential": "unstable",
    "tolerance-not-looked-at": "tolerance of {thrusters} left out",
    "misalignment-not-looked-at": "misalignment of {thrusters} left out",
    "normal-numbers": "normal numbers: within {sigmas} sigma",
    "correlated-numbers": "correlations in samples alone",
    "stated-by-the-file": "{statement}"}
BRIEF = 44  # letters of these at most


def reached(caveats: Iterable[Caveat], units: Units) -> str:
    """The limit that is reached, empty where none is."""
    return "; ".join(words(caveat, units) for caveat in caveats if caveat.kind is Kind.LIMIT)


def condition(caveats: Iterable[Caveat], units: Units, alone: bool = False, short: bool = False) -> str:
    """" only while ...", empty where a verdict rests on no condition. alone: without what a tilt does; short:
    in fewer words."""
    rows = [item.reason for item in caveats if item.kind is Kind.TILT and item.reason.sentence is HOLDS]
    return "; ".join(" " + units.said(_unheld(reason.alone if alone else reason, short), SHORT,
                                      whole=None if short else True) for reason in rows)


def axis_of_condition(caveats: Iterable[Caveat]) -> int:
    """The axis that the torque of a verdict must lie along, 0 where a verdict rests on no such condition."""
    rows = [item.reason.quantities["condition"] for item in caveats
            if item.kind is Kind.TILT and item.reason.sentence is HOLDS]
    return next((row.quantities["axis"].number for row in rows if "axis" in row.quantities), 0)


def _unheld(reason: Reason, short: bool = False) -> Reason:
    """What follows "holds", with its clauses. short: as of `condition`."""
    held = reason.quantities["condition"]
    held = in_short(held) if short else held
    for joint, clause in reason.rest:
        held = held.then(clause, joint)
    return held


def tilts(caveats: Iterable[Caveat], units: Units) -> list[str]:
    """What a tilt does to a verdict that rests on a condition: the clauses behind that."""
    rows = [item.reason for item in caveats if item.kind is Kind.TILT and item.reason.sentence is HOLDS]
    return [units.said(clause, SHORT) for reason in rows for _, clause in reason.rest]


def fitted(build: Callable[[bool], str], before: int = 0, together: int = 1) -> str:
    """A line with its condition in full, or in fewer words where there is no room for that. build: the line,
    in short or not; before: letters that stand before it; together: how many of its clauses belong into the
    first line."""
    lines = build(False), build(True)
    for many in range(together, 0, -1):
        for line in lines:
            if before + len("; ".join(clauses_of(line)[:many])) <= LINE:
                return line
    return lines[-1]


def tilted(caveats: Iterable[Caveat], units: Units) -> str:
    """What the torques of a cone do, where no verdict rests on the torque's direction."""
    return "; ".join(words(caveat, units) for caveat in caveats
                     if caveat.kind is Kind.TILT and caveat.reason.sentence is not HOLDS)


def shared(answers: Sequence[Iterable[Caveat]], units: Units) -> str:
    """" only while ...", or of how many it is said, for several answers in one line, without tilts."""
    result = Counter(condition(caveats, units, alone=True, short=True) for caveats in answers)
    return "".join(f"{item}" if count == len(answers) else f" ({count} of them{item})"
                   for item, count in result.items() if item)


def ahead(caveats: Iterable[Caveat], text: str, named: bool = True) -> str:
    """A text with what its first line must not lack, before the answer and behind the name of the case.
    named: whether that stands there."""
    phrase = "; ".join(dict.fromkeys(AHEAD[caveat.kind] for caveat in caveats if caveat.kind in AHEAD))
    if not phrase or phrase in text.partition("\n")[0]:
        return text
    name, colon, answer = text.partition(": ")
    return f"{name}: {phrase}; {answer}" if named and colon and "\n" not in name else f"{phrase}; {text}"


def noted(caveats: Iterable[Caveat], text: str, units: Units, law: bool = False) -> str:
    """The text with a line below its first for every caveat that the text itself does not state. law: that on
    an approximate law, too, which else has a line of its own."""
    caveats = list(caveats)
    first, *rest = ahead(caveats, text).split("\n")
    laws = [caveat for caveat in caveats if law and _of_law(caveat)]
    return "\n".join([first, *lines([*unsaid(caveats, text, units), *laws], units), *rest])


def beside(caveats: Iterable[Caveat], units: Units, text: str = "") -> list[str]:
    """A sentence for every caveat that a text does not state."""
    return [f"{words(item, units)}." for item in unsaid(caveats, text, units)]


def unsaid(caveats: Iterable[Caveat], text: str, units: Units) -> list[Caveat]:
    """The caveats that a text does not state; that on an approximate law has a line of its own."""
    return [caveat for caveat in dict.fromkeys(caveats) if not _of_law(caveat)
            and not any(form.removeprefix("holds ").removeprefix("unstable: ").lower() in text.lower()
                        for form in _forms(caveat, units))]


class Note(NamedTuple):
    """What limits an answer, in full and in few words."""

    full: str
    brief: str


def notes(caveats: Iterable[Caveat], line: str, units: Units) -> list[Note]:
    """A note on every caveat that a line leaves out, for a picture, the most important first: of a law by how
    much it is left, of a condition that the line has what a tilt does to it."""
    found = []
    ranks = list(IN_BRIEF)
    for item in sorted(dict.fromkeys(caveats), key=lambda item: ranks.index(item.kind)):
        if not any(form.removeprefix("reaches ").removeprefix("holds ").lower() in line.lower()
                   for form in _forms(item, units)):
            found.append(Note(_for_a_picture(item, units), _briefly(item, item.reason, units)))
        elif item.reason.sentence is HOLDS:
            found += [Note(units.said(clause, SHORT), _briefly(item, clause, units))
                      for _, clause in item.reason.rest]
    return found


def _for_a_picture(item: Caveat, units: Units) -> str:
    """In full, but for what stands in the answer of a command."""
    if _of_law(item):
        (joint, measured), *_ = item.reason.rest
        return units.said(item.reason.alone.then(measured.alone, joint), SHORT)
    if item.kind in (Kind.TOLERANCE, Kind.MISALIGNMENT, Kind.UNCERTAIN):
        return words(item, units).split("; ")[0]
    return words(item, units)


def _briefly(item: Caveat, reason: Reason, units: Units) -> str:
    """In few words, by the code of the sentence, else by its kind."""
    if reason.sentence is HOLDS:
        return units.said(_unheld(reason.alone, True), SHORT, None)
    if reason.code not in BRIEFLY:
        return IN_BRIEF[item.kind]
    filled = {name: units.filled(value, SHORT, None) for name, value in reason.filled}
    text = BRIEFLY[reason.code].format_map(filled)
    return text if len(text) <= BRIEF else text[:BRIEF - 3].rsplit(" ", 1)[0].rstrip(",;:") + " ..."


def _of_law(caveat: Caveat) -> bool:
    """Whether it is the judgement of an approximate law, which a view has in a line of its own."""
    return caveat.kind is Kind.LAW and caveat.reason.code == LAW_JUDGED


def _forms(item: Caveat, units: Units) -> list[str]:
    """How a first line may have it: with long or short names of axes, with what a tilt does or without."""
    short = [_unheld(reason, True) for reason in (item.reason, item.reason.alone)
             if item.reason.sentence is HOLDS]
    return [units.said(reason, SHORT, full) for full in (True, False, None)
            for reason in (item.reason, item.reason.alone, *short)]


def lines(caveats: Iterable[Caveat], units: Units) -> list[str]:
    """A line each."""
    return [f"  caveat: {words(caveat, units)}" for caveat in caveats]


def words(item: Caveat, units: Units) -> str:
    """The words in the units and letters of a text."""
    return units.said(item.reason, SHORT)


def unstable(caveats: Iterable[Caveat], units: Units) -> str:
    """How an equilibrium is unstable, or that its stability is open; empty where it is neither."""
    return "; ".join(words(caveat, units) for caveat in caveats if caveat.kind is Kind.UNSTABLE)


def key(case: Case, caveats: Iterable[Caveat]) -> dict[str, list[dict]]:
    """The key "caveats" of a JSON object, with the names of the axes of a case."""
    return errors.key(caveats, _filled(case))


def cell(case: Any, caveats: Iterable[Caveat]) -> str:
    """The column "caveats" of a CSV, with the names of the axes of a case."""
    return errors.cell(caveats, _filled(case))


class Line(NamedTuple):
    """A line of CSV. caveats: where it has others than its answer; ending: how a motion ends that loses
    energy."""

    cells: Sequence[Any]
    caveats: Iterable[Caveat] | None = None
    ending: Any = None


def table(head: Sequence[str], rows: Iterable[tuple[Any, Iterable[Caveat], Iterable[Line]]]) -> str:
    """The CSV of (case, caveats of its answer, lines): with a column of caveats, and with those of
    `ending.beside`."""
    lines = [(case, caveats, line) for case, caveats, of in rows for line in of]
    cells = [(*line.cells, cell(case, caveats if line.caveats is None else line.caveats))
             for case, caveats, line in lines]
    return csv_lines(ending.beside([(*head, "caveats"), *cells], [line.ending for *_, line in lines]))[:-1]


def _filled(case: Any) -> Callable[[Any], str]:
    return partial(in_si, axis=axes_of(case).whole)
