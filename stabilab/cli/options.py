"""Options and arguments that several commands share."""
from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any  # typer reads the annotations at run time

import typer

from .. import commands
from ..show import command_groups


def option(metavar: str, text: str | None = None, *names: str, **more: Any) -> Any:
    """An option that takes a value: what that is called in the help, and what is said of it."""
    return typer.Option(*names, metavar=metavar, help=text, **more)


def flag(name: str, text: str, *names: str, **more: Any) -> Any:
    """An option that is given or not, and has no negative."""
    return typer.Option(name, *names, help=text, **more)


def argument(metavar: str, text: str, **more: Any) -> Any:
    """An argument, by its place in the line."""
    return typer.Argument(metavar=metavar, help=text, show_default=False, **more)


CaseFile = Annotated[Path, argument("CASE", "A case file (TOML).", autocompletion=command_groups.cases)]
CaseFiles = Annotated[list[Path], argument("CASE...", "Case files (TOML).",
                                           autocompletion=command_groups.cases)]
Json = Annotated[bool, flag("--json", "JSON on stdout instead of text.")]
Csv = Annotated[bool, flag("--csv", "CSV on stdout instead of text.")]
Digits = Annotated[int | None, option("N",
    "Reach N digits (1 to 10000; to 50 where no formula gives them) by the cheapest method and check them; "
    "exit with 5 where they are not reached. "
    "Default: 10 where possible.")]
Follow = Annotated[str | None, option("T",
    "How long to follow a motion in time where no first integral decides its outcome (torque off the "
    'principal axes): "10 min", or a number in the time of the case. Default: about a second of work.')]
Prove = Annotated[bool, flag("--certify",
    "Prove the outcome of a motion that has to be followed in time, by bounds of every step; classify "
    "--certify writes the proof to a file.")]
Tilt = Annotated[str | None, option("ANGLE",
    'Also say what a tilt of the torque by up to this angle does, "1 deg", where the motion is bounded '
    "under a torque on a principal axis. Without it: by the misalignment that the case states, or by 1 deg "
    "where the case has [limits].")]
UnitsOption = Annotated[str | None, option("UNIT",
    "Unit of rates in text: deg (deg/s), deg/day, rpm, rev/s, or si (rad/s, and all times in s). Default: "
    "[output] units of the case, else deg; deg/day for a free body below 0.01 deg/s.",
    autocompletion=command_groups.units)]
Si = Annotated[bool, flag("--si", "The same as --units si.", hidden=True)]
Why = Annotated[bool, flag("--why", "Also print proofs, derivations and algebra.", "-v")]
Strict = Annotated[bool, flag("--strict",
    "Exit with 3 where an outcome is undecided or an approximate law does not hold along the motion.")]
StrictFate = Annotated[bool, flag("--strict", "Exit with 3 where an outcome is undecided.")]
Workers = Annotated[int | None, option(
    "N", "Processes that share the work; default: one for each core where that is faster.")]
Draws = Annotated[int | None, option(
    "N", "Also give percentiles over so many draws of the uncertain numbers of the case, with their sampling "
    "error.")]
Seed = Annotated[int, option("S", "Seed of the draws.")]
Scheduler = Annotated[str | None, option(
    "tcp://...", "Let the workers of this Dask scheduler do the work (needs stabilab[cluster]).")]
Component = Annotated[str | None, option("AXIS=RATE", hidden=True)]
Energy = Annotated[str | None, option("ENERGY", hidden=True)]
TiltBy = Annotated[str | None, option("AXIS=ANGLE", hidden=True)]
Below = Annotated[str | None, option("RATE", hidden=True)]
NutationBy = Annotated[str | None, option("AXIS=ANGLE", hidden=True)]
Until = Annotated[str | None, option("TIME", hidden=True)]
CsvOfCells = Annotated[bool, flag("--csv", "CSV on stdout: a line for each cell.")]
Folder = Annotated[Path, option("DIR", "Folder for the files.")]
Order = Annotated[int | None, option("N", "Order of the lindstedt expansion.", min=1)]


def opens(location: str, **fixed: str) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """The work of a command that declares its options: a function of `commands` ("sweep.sweep"), which
    gets them all by name, and what is fixed. Its file is read when the command is given."""
    file, name = location.split(".")

    def answered_by(declared: Callable[..., None]) -> Callable[..., None]:
        @wraps(declared)
        def run(**options: Any) -> None:
            if options.get("json") and options.get("csv"):
                raise typer.BadParameter("choose one of --json and --csv")
            if options.pop("si", False):
                options["units"] = "si"
            getattr(import_module(f"{commands.__name__}.{file}"), name)(**options, **fixed)
        run.opens = location, fixed  # type: ignore[attr-defined]  # for the test that compares the names
        return run
    return answered_by
