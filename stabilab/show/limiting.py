"""What limits an answer, in text: a limit that comes first, the condition beside a verdict, and a line for
all else."""
from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

from .. import errors
from ..errors import Caveat, printable
from .axes import axes_of
from .terminal import lettered
from .units import SHORT, Units

INSIDE = ("tilt", "limit", "law")  # stated in the first line of an answer itself


def reached(caveats: Iterable[Caveat], units: Units) -> str:
    """The limit that is reached, empty where none is."""
    return _of("limit", caveats, units)


def condition(caveats: Iterable[Caveat], units: Units) -> str:
    """" only while ...", empty where a verdict rests on no condition."""
    whole = [replace(one, words=units.axes.sentence(one.words, units.axes.whole)) for one in caveats]
    return " " * bool(words := _of("tilt", whole, units, "holds ")) + words.removeprefix("holds ")


def tilted(caveats: Iterable[Caveat], units: Units) -> str:
    """What the torques of a cone do, where no verdict rests on the torque's direction."""
    return _of("tilt", caveats, units, "tilted by ") or _of("tilt", caveats, units, "a tilt ")


def shared(answers: Sequence[Iterable[Caveat]], units: Units) -> str:
    """" only while ...", or of how many it is said, for several answers in one line, without tilts."""
    told = Counter(re.split("[:;]", condition(caveats, units))[0] for caveats in answers)
    return "".join(f"{words}" if count == len(answers) else f" ({count} of them{words})"
                   for words, count in told.items() if words)


def noted(caveats: Iterable[Caveat], text: str, units: Units) -> str:
    """The text with a line below its first for every caveat that no first line has room for."""
    first, *rest = text.split("\n")
    return "\n".join([first, *lines([one for one in caveats if one.kind not in INSIDE], units), *rest])


def beside(caveats: Iterable[Caveat], units: Units) -> list[str]:
    """A sentence for every caveat that no first line has room for."""
    return [f"{words(one, units)}." for one in caveats if one.kind not in INSIDE]


def lines(caveats: Iterable[Caveat], units: Units) -> list[str]:
    """A line each."""
    return [f"  caveat: {words(one, units)}" for one in caveats]


def words(one: Caveat, units: Units) -> str:
    """The words in the units and letters of a text."""
    return lettered(units.words(printable(one.words), SHORT))


def key(case: Any, caveats: Iterable[Caveat]) -> dict[str, list[dict[str, str]]]:
    """The key "caveats" of a JSON object, with the names of the axes of a case."""
    return errors.key(_named(case, caveats))


def cell(case: Any, caveats: Iterable[Caveat]) -> str:
    """The column "caveats" of a CSV, with the names of the axes of a case."""
    return errors.cell(_named(case, caveats))


def _named(case: Any, caveats: Iterable[Caveat]) -> list[Caveat]:
    axes = axes_of(case)
    return [replace(one, words=axes.sentence(one.words, axes.whole)) for one in caveats]


def _of(kind: str, caveats: Iterable[Caveat], units: Units, begins: str = "") -> str:
    return "; ".join(words(one, units) for one in caveats if one.kind == kind
                     and one.words.startswith(begins))
