"""What can go wrong, in words for the user, and the exit codes that announce it."""
from __future__ import annotations

from dataclasses import dataclass

OK, BUG, BAD_INPUT, UNDECIDED, NO_RENDERING, TOLERANCE_NOT_MET, INTERRUPTED = 0, 1, 2, 3, 4, 5, 130


class StabilabError(Exception):
    """A failure that is explained to the user in one message, without a traceback."""

    exit_code = BUG


class InputError(StabilabError, ValueError):
    """What the user gave cannot be used: the message says what came, what was expected and what to do."""

    exit_code = BAD_INPUT


@dataclass(frozen=True)
class Problem:
    """One fault of a case file; `line` is 1-based, None where the file as a whole is meant."""

    key: str
    message: str
    line: int | None = None


class CaseError(InputError):
    """All faults of one case file at once."""

    def __init__(self, path: str, problems: list[Problem]):
        self.path, self.problems = str(path), tuple(problems)
        super().__init__("\n".join(self._line(p) for p in problems))

    def _line(self, problem: Problem) -> str:
        where = self.path if problem.line is None else f"{self.path}:{problem.line}"
        return f"{where}: {problem.key}: {problem.message}" if problem.key else f"{where}: {problem.message}"


class RenderingUnavailable(StabilabError):
    """Pictures cannot be drawn on this machine; meshes and data were still written."""

    exit_code = NO_RENDERING


class ToleranceNotMet(StabilabError):
    """The asked-for accuracy was not reached."""

    exit_code = TOLERANCE_NOT_MET
