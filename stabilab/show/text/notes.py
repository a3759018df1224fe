"""What limits an answer, in lines below a picture."""
from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from .. import limiting, style
from ..axes import axes_of
from ..units import units_of

if TYPE_CHECKING:
    from ...case.read import Case
    from ...errors import Caveat
    from ..limiting import Note

NOTE_LINES, SMALL_LINES = 3, (1, 2)  # of notes below a picture; below a small one, in few words if need be
COMMAND = "stabilab fate"  # which prints all notes


def below(figure: Any, case: Case, caveats: Collection[Caveat], line: str = "",
          before: Iterable[str] = ()) -> str:
    """What limits the answers of a map and does not stand in a line of its title, for a figure's legend.
    before: lines that the title has no room for."""
    units = replace(units_of(case), axes=axes_of(case))
    return fitted([*map(as_note, before), *limiting.notes(caveats, line, units)], figure.get_figwidth())


def as_note(line: str) -> Note:
    """A line that has no shorter form."""
    return limiting.Note(line, line)


def fitted(notes: Sequence[Note], inches: float) -> str:
    """Notes in lines that fit a figure of this width: in full, from the last on in few words where that takes
    too many lines; of the last that have no room even so it says how many these are, never of the first."""
    size = style.RC["legend.fontsize"] * style.share()

    def lines(parts: Sequence[str]) -> list[str]:
        return style.clauses("; ".join(parts), inches, size).split("\n") if parts else []
    brief = [note.brief for note in notes]
    forms = [[*(note.full for note in notes[:full]), *brief[full:]] for full in range(len(notes), -1, -1)]
    forms += [[*brief[:shown], f"{len(notes) - shown} more: {COMMAND}"]
              for shown in range(len(notes) - 1, 0, -1)]
    for most in (NOTE_LINES,) if style.share() == 1 else SMALL_LINES:
        for form in forms if most > 1 else forms[:len(notes) + 1]:
            if len(found := lines(form)) <= most:
                return "\n".join(map(style.literal, found))
    return "\n".join(map(style.literal, found[:NOTE_LINES]))
