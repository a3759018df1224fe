"""One runner for every command about cases: it answers each case, prints the answers as text, JSON or CSV
with all that limits them, names the files that were drawn, and ends with the exit code. A command is a
question and a `View`, which says how one answer is printed. Caveats are added here, so that no view can be
without them."""
from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from ..answers.caveats import caveats_of, of_case, seen
from ..case.read import Case
from ..errors import Caveat, Kind
from ..show import endings, frame, limiting
from ..show.data import as_json
from ..show.terminal import clauses_of, tell
from ..show.text import classification, headline, percentiles, scene
from ..show.units import Units
from .common import answers_of, units_asked
from .writing import all_reached, hold_laws, leave_undecided, say_written, write, written


@dataclass(frozen=True, kw_only=True)
class View:
    """How the answers of a command are printed. What is found of a case is `found`, one object or several.

    text(case, *found, units): its lines; data(case, *found): its object of JSON, in SI units; csv: (names of
    the columns, lines(case, *found)); each without caveats, but where a line or, if `parts`, an object inside
    has some of its own; swept(rows, units): (answer in a line, columns, rows) of the combinations of a
    [sweep], a row being (case, *found); between: two texts. law(case, *found): how far the approximate laws
    of an answer hold, None where all are exact; steady: the answer is about bounded motions; axes: JSON has
    the principal axes of a full tensor; boxes: which verdicts hold all over the box of uncertain numbers;
    packed: the objects of JSON as one value. open(*found): whether something is undecided; short(*found): in
    words what falls short of the digits asked for. drawn(case, *found, units, path): a picture; files:
    its endings.
    """

    text: Callable[..., str]
    data: Callable[..., dict[str, Any]]
    csv: Any = None
    swept: Any = None
    between: str = "\n\n"
    law: Callable[..., Any] | None = None
    steady: bool = False
    parts: bool = False
    axes: bool = False
    boxes: tuple[str, ...] = ()
    packed: Callable[[list[dict[str, Any]]], Any] | None = None
    open: Callable[..., bool] = lambda *result: False
    short: Callable[..., Iterable[str]] = lambda *result: ()
    drawn: Callable[..., Any] | None = None
    files: tuple[str, ...] = endings.PICTURES


@dataclass(frozen=True)
class Answered:
    """A case, what was found of it, and what limits that; draws: `Percentiles` over its uncertain numbers,
    where these were asked for, of each thruster where each was."""

    case: Case
    found: tuple[Any, ...]
    units: Units
    law: Any
    caveats: tuple[Caveat, ...]
    box: Any = None
    draws: tuple[Any, ...] = ()


def every(objects: list[dict[str, Any]]) -> Any:
    """A list, of one case as well."""
    return objects


def run(view: View, cases: Sequence[Case], ask: Callable[[Case], Any], *, units: str | None = None,
        systems: Sequence[Units] | None = None, out: Any = None, json: bool = False, csv: bool = False,
        strict: bool = False, drawn: Callable[[Case], Any] | None = None, **typed: str | None) -> None:
    """Answer every case. drawn: gives percentiles over the uncertain numbers of one; units, out, json, csv,
    strict: as options of a command; systems: the units of each, where they are known; typed: angles and
    rates, as of `units_asked`."""
    systems = units_asked(cases, units, **typed) if systems is None else systems
    if out:
        endings.file(out, view.files)
    result = [item if isinstance(item, tuple) else (item,) for _, item in answers_of(cases, ask)]
    rows = with_draws(collected(view, cases, systems, result), drawn)
    show(view, rows, json, csv, out)
    judge(view, rows, strict)


def with_draws(rows: list[Answered], drawn: Callable[[Case], Any] | None) -> list[Answered]:
    """With the percentiles of each case, where they are asked for."""
    if drawn is None:
        return rows
    return [replace(row, draws=result if isinstance(result, tuple) else (result,))
            for row, (_, result) in zip(rows, answers_of([row.case for row in rows], drawn))]


def collected(view: View, cases: Sequence[Case], systems: Sequence[Units], result: Sequence[tuple[Any, ...]],
             boxes: Sequence[Any] | None = None) -> list[Answered]:
    """What was found with all that limits it: the one place where the caveats of an answer are collected."""
    rows = []
    for case, units, item, box in zip(cases, systems, result, boxes or [None] * len(cases)):
        law = view.law(case, *item) if view.law else None
        # a motion, which stands last, says more than the equilibria
        own = next((part.caveats for part in reversed(item) if getattr(part, "caveats", None) is not None),
                   None)
        caveats = of_case(case, law, view.steady) if own is None else tuple(own)
        if not any(caveat.kind is Kind.LAW for caveat in caveats):
            caveats = tuple(dict.fromkeys((*caveats, *caveats_of(case.scene, validity=law))))
        rows.append(Answered(case, item, units, law, caveats, box))
    return rows


def show(view: View, rows: list[Answered], json: bool, csv: bool = False, out: Any = None) -> None:
    """Print the answers, and name what was drawn of them."""
    drawn = written(out, [(row.case, _drawing(view, row)) for row in rows])
    if json:
        write(as_json(_packed(view, rows)))
    elif csv:
        write(_csv(view, rows))
    else:
        tell(text(view, rows))
    say_written(drawn)


def judge(view: View, rows: list[Answered], strict: bool, certified: bool = True) -> None:
    """Exit with 5 where digits were asked for and not reached; where strict with 3 where something is
    undecided, or a law does not hold. certified: whether all is that was to be."""
    all_reached((row.case, why) for row in rows for why in view.short(*row.found))
    leave_undecided(strict, not certified or any(view.open(*row.found) or classification.open_in_box(row.box)
                                                 for row in rows))
    hold_laws(strict, (row.law for row in rows), [row.case for row in rows])


def _drawing(view: View, row: Answered) -> Callable[[Any], Any]:
    return lambda path: view.drawn(row.case, *row.found, row.units, path)


# --- As JSON and CSV
def _packed(view: View, rows: list[Answered]) -> Any:
    objects = [_object(view, row) for row in rows]
    if view.packed is not None:
        return view.packed(objects)
    return objects if len(objects) > 1 or rows[0].case.variant else objects[0]


def _object(view: View, row: Answered) -> dict[str, Any]:
    built = view.data(row.case, *row.found)
    return (built | ({} if view.parts else limiting.key(row.case, row.caveats))
            | (frame.key(row.case) if view.axes else {})
            | (headline.key(row.law) if view.law else {})
            | (classification.uncertain_dict(row.box) if view.boxes else {})
            | percentiles.as_dict(row.case, row.draws))


def _csv(view: View, rows: list[Answered]) -> str:
    if any(row.draws for row in rows):
        return limiting.table(percentiles.COLUMNS, [
            (row.case, row.caveats, [line for item in row.draws for line in percentiles.lines(item)])
            for row in rows])
    head, lines = view.csv
    return limiting.table(head, [(row.case, row.caveats, lines(row.case, *row.found)) for row in rows])


# --- As text: one after the other, or the combinations of a [sweep] as one table
def text(view: View, rows: list[Answered]) -> str:
    """The answers as text, each with its caveats and its law."""
    tabled = view.swept is not None and any(row.case.variant for row in rows)
    groups = scene.groups([row.case for row in rows]) if tabled else [[n] for n in range(len(rows))]
    parts = [_part(view, [rows[n] for n in of], tabled) for of in groups]
    return ("\n\n" if tabled else view.between).join(parts)


def _part(view: View, rows: list[Answered], tabled: bool) -> str:
    """The text of an answer, or of the combinations of a file."""
    first = rows[0]
    below = [classification.in_si(row.box, row.units) for row in rows]
    full = tabled and bool(first.case.variant)
    if full:
        table = view.swept([(row.case, *row.found) for row in rows], first.units)
        label = scene.text([row.case for row in rows], *table)
    else:
        label = classification.first(first.box, view.text(first.case, *first.found, first.units), first.units)
    outcome = clauses_of(label.partition("\n")[0])[0].removeprefix(f"{first.case.name}: ")
    answer = headline.first(headline.worst(*(row.law for row in rows)), label, first.units,
                            list(dict.fromkeys(_shown(view, rows, full, below))))
    return (classification.in_short(None if full else first.box, answer, outcome)
            + "".join(dict.fromkeys(below))
            + "".join("\n" + percentiles.text(item, row.units) for row in rows for item in row.draws))


def _shown(view: View, rows: list[Answered], full: bool, below: list[str]) -> Iterator[Caveat]:
    """Of a table those of the file; without those on uncertain numbers where words on their box follow."""
    for row, phrase in zip(rows, below):
        for caveat in row.case.caveats if full else row.caveats:
            if not phrase or caveat.kind not in (Kind.UNCERTAIN, Kind.SAMPLES):
                yield caveat


# --- Uncertain numbers
def over_boxes(view: View, cases: Sequence[Case], motions: list[Any]) -> tuple[list[Any], list[Any]]:
    """(what uncertain numbers do to the verdicts of each case, None where it has none; the motions, with what
    samples show of that and no proof as a caveat)."""
    if not view.boxes or not any(case.uncertain for case in cases):
        return [None] * len(cases), motions
    from ..answers.uncertain.fate import uncertain
    boxes = [uncertain(case, view.boxes) for case in cases]
    return boxes, [motion if motion is None or box is None
                   else replace(motion, caveats=(*seen(motion.caveats, box=box.fate), *box.caveats))
                   for motion, box in zip(motions, boxes)]
