"""Errors of a user with the exit codes that announce them, and the caveats of an answer.

Caveats are what limits an answer: a tilt that it leaves out, a limit that comes first, a law that does not
hold, a tensor that no rigid body has, a size beyond all reason, what a file says of itself, samples in place
of a proof, numbers that are the middles of uncertain ones, what a burn or a motor takes for granted.

A caveat belongs to the answer: every view of it (text, JSON, CSV, sweep, map, page, explorer) shows its
words."""
from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from .reasons import Reason, as_reason


class Kind(StrEnum):
    """What a caveat is about."""

    TILT = "tilt"
    LIMIT = "limit"
    LAW = "law"
    UNPHYSICAL = "unphysical"
    SIZE = "size"
    STATED = "stated"
    SAMPLES = "samples"
    UNCERTAIN = "uncertain"
    BURN = "burn"
    MOTOR = "motor"
    THRUSTERS = "thrusters"
    UNSTABLE = "unstable"
    TOLERANCE = "tolerance"
    MISALIGNMENT = "misalignment"
    DISTRIBUTION = "distribution"


@dataclass(frozen=True)
class Caveat:
    """kind: what it is about; reason: a sentence on its own, without a full stop."""

    kind: Kind
    reason: Reason

    @property
    def words(self) -> str:
        """The sentence in SI units."""
        return self.reason.text()


def without(caveats: Iterable[Caveat], *kinds: Kind) -> tuple[Caveat, ...]:
    """The caveats of other kinds."""
    return tuple(caveat for caveat in caveats if caveat.kind not in kinds)


def key(caveats: Iterable[Caveat], fill: Callable[[Any], str] | None = None) -> dict[str, list[dict]]:
    """The key "caveats" of a JSON object: a list, empty where nothing limits the answer. fill: as of
    `Reason.text`."""
    return {"caveats": [{"kind": str(item.kind), "words": item.reason.text(fill)}
                        | {name: value for name, value in item.reason.as_dict(fill).items() if name != "text"}
                        for item in caveats]}


def cell(caveats: Iterable[Caveat], fill: Callable[[Any], str] | None = None) -> str:
    """The column "caveats" of a CSV: the words of all, empty where nothing limits the answer."""
    return "; ".join(caveat.reason.text(fill) for caveat in caveats)


OK, BUG, BAD_INPUT, UNDECIDED, NO_RENDERING, TOLERANCE_NOT_MET, INTERRUPTED = 0, 1, 2, 3, 4, 5, 130


class StabilabError(Exception):
    """A failure that is explained to the user in one message, without a traceback."""

    exit_code = BUG


class InputError(StabilabError, ValueError):
    """What the user gave cannot be used: the message says what came, what was expected and what to do."""

    exit_code = BAD_INPUT


class Refused(InputError):
    """What cannot be answered of what the user gave, as a reason with its quantities."""

    def __init__(self, reason: Reason):
        super().__init__(reason)
        self.reason = reason

    def __str__(self) -> str:
        return self.reason.text()


def refusal_of(error: Exception) -> Reason:
    """Why: with its quantities where it has them, else in words."""
    return error.reason if isinstance(error, Refused) else as_reason(str(error))


def printable(text: str) -> str:
    """The text in one line that a terminal shows as it is: what a file holds may neither move the cursor nor
    forge a line."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text)


def told(value: object) -> str:
    """What came instead of what was expected, as Python writes it: not more than 80 characters, and no
    address, which is another in every run."""
    text = repr(value)
    return (text if " at 0x" not in text else f"{type(value).__name__} that holds no numbers")[:80]


@dataclass(frozen=True)
class Problem:
    """One fault of a case file; `line` is 1-based, None where the file as a whole is meant."""

    key: str
    message: str
    line: int | None = None


class CaseError(InputError):
    """All faults of one case file at once; the message shows the first of them."""

    SHOWN = 50  # a file with more faults is another kind of file

    def __init__(self, path: str, problems: list[Problem]):
        self.path, self.problems = str(path), tuple(problems)
        more = len(self.problems) - self.SHOWN
        lines = [self._line(p) for p in self.problems[:self.SHOWN]]
        super().__init__("\n".join(lines
                                   + ([f"{printable(self.path)}: and {more} more"] if more > 0 else [])))

    def _line(self, problem: Problem) -> str:
        where = self.path if problem.line is None else f"{self.path}:{problem.line}"
        return printable(f"{where}: {problem.key}: {problem.message}" if problem.key
                         else f"{where}: {problem.message}")


class RenderingUnavailable(StabilabError):
    """Pictures cannot be drawn on this machine; meshes and data were still written, as `summaries` tells."""

    exit_code = NO_RENDERING
    summaries: list[dict]


class ToleranceNotMet(StabilabError):
    """The asked-for accuracy was not reached."""

    exit_code = TOLERANCE_NOT_MET
