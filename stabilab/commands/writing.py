"""How commands write their answers: data and answers to stdout, messages to stderr; an exit code says where
an answer falls short."""
from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import typer

from ..errors import UNDECIDED, Kind, ToleranceNotMet
from ..show.data import as_json
from ..show.endings import labelled
from ..show.terminal import say, tell
from ..show.text import headline

if TYPE_CHECKING:
    from pathlib import Path

    from ..case.read import Case


def write(text: str):
    """Text to stdout as it is: data, or names of files."""
    sys.stdout.write(text.rstrip("\n") + "\n")
    sys.stdout.flush()


def either(json: bool, data, text):
    """JSON to stdout, or text for people; both are functions, and one of them is called."""
    if json:
        write(as_json(data()))
    else:
        tell(text())


def of_map(shown, result, case, files, json: bool, csv: bool, strict: bool, *more):
    """Print a map of a case by json, csv or text of `shown`, and name its files; exit with 3 where strict and
    something is undecided. more: for all but csv."""
    write_answer(shown, result, json, csv, *more)
    say_written(files)
    leave_undecided(strict, strict and (shown.undecided(result) or unphysical([case])))


def write_answer(shown, result, json: bool, csv: bool, *more):
    """What was found by json, csv or text of `shown`; `more`: for all but csv."""
    if csv and not json and hasattr(shown, "csv_pieces"):
        sys.stdout.writelines(shown.csv_pieces(result))
        sys.stdout.flush()
    elif json or csv:
        write(shown.json(result, *more) if json else shown.csv(result))
    else:
        tell(shown.text(result, *more))


def write_each(out, writers):
    """Let write(path) of every (case, write) make its file; each is named."""
    say_written(written(out, writers))


def written(out: Path, writers: Sequence[tuple[Case, Callable[..., Any]]]) -> list:
    """Let write(path) of every (case, write) make its file where `out` is a name: the files."""
    return [writer(labelled(out, case)) for case, writer in writers] if out else []


def say_written(files: Sequence[Path | str]):
    """Name files that were written, a line each; of what has no file, say why."""
    for file in files:
        say(file if isinstance(file, str) else f"written: {file}")


def leave_undecided(strict: bool, open_: bool):
    """Exit with 3 where strict and something is open."""
    if strict and open_:
        raise typer.Exit(UNDECIDED)


def hold_laws(strict: bool, validities, cases=()):
    """Exit with 3 where strict and a law does not hold, or no rigid body has the tensor of a case."""
    leave_undecided(strict, strict and (headline.beyond(*validities) or unphysical(cases)))


def unphysical(cases: Sequence[Case]) -> bool:
    """Whether no rigid body has the tensor of one of the cases."""
    return any(caveat.kind is Kind.UNPHYSICAL for case in cases for caveat in case.caveats)


def all_reached(short):
    """Exit with 5 where (case, why) says that an answer falls short."""
    lines = [f"{case.place}: {why}" for case, why in short]
    if lines:
        raise ToleranceNotMet("\n".join(lines))
