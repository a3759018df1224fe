"""Options and arguments that several commands share."""
from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any  # typer reads the annotations at run time

import typer

from .. import commands
from ..show.terminal import completion

CaseFile = Annotated[Path, typer.Argument(
    metavar="CASE", show_default=False, autocompletion=completion.cases, help="A case file (TOML).")]
CaseFiles = Annotated[list[Path], typer.Argument(
    metavar="CASE...", show_default=False, autocompletion=completion.cases, help="Case files (TOML).")]
Json = Annotated[bool, typer.Option("--json", help="JSON on stdout instead of text.")]
Csv = Annotated[bool, typer.Option("--csv", help="CSV on stdout instead of text.")]
Digits = Annotated[int | None, typer.Option(
    metavar="N",
    help="Reach N digits (1 to 50) the cheapest way and check them; exit 5 where they are not reached. "
         "Without it 10 are the aim.")]
Follow = Annotated[str | None, typer.Option(
    metavar="T",
    help="How long to follow a motion that only a run with a certificate decides (torque off the "
         "principal axes), with a unit or in the time of the case. Default: a second of work.")]
Prove = Annotated[bool, typer.Option(
    "--certify",
    help="Enclose a motion that has to be followed, so that its fate is proved; classify "
         "--certify writes the proof down.")]
Tilt = Annotated[str | None, typer.Option(
    metavar="ANGLE",
    help='What a tilt of the torque by up to so much, "1 deg", does to a motion that a torque on an '
         "axis keeps bounded. By itself where the case states a misalignment or [limits].")]
UnitsOption = Annotated[str | None, typer.Option(
    "--units", metavar="UNIT", autocompletion=completion.units,
    help="Of rates in text: deg (deg/s), deg/day, rpm, rev/s, or si (rad/s, and all times in s). Default: "
         "[output] units of the case, else deg; deg/day for a free body below 0.01 deg/s.")]
Si = Annotated[bool, typer.Option("--si", hidden=True, help="The same as --units si.")]
Why = Annotated[bool, typer.Option("--why", "-v", help="With proofs, derivations and algebra.")]
Strict = Annotated[bool, typer.Option(
    "--strict",
    help="Exit with 3 where a fate is undecided or an approximate law does not hold along the motion.")]
StrictFate = Annotated[bool, typer.Option("--strict", help="Exit with 3 where a fate is undecided.")]
Workers = Annotated[int | None, typer.Option(
    metavar="N", help="Processes that share the work; default: one a core where that pays.")]
Scheduler = Annotated[str | None, typer.Option(
    metavar="tcp://...", help="Let the workers of this Dask scheduler do it (extra cluster).")]
Component = Annotated[str | None, typer.Option(metavar="AXIS=RATE", hidden=True)]
Energy = Annotated[str | None, typer.Option(metavar="ENERGY", hidden=True)]
TiltBy = Annotated[str | None, typer.Option(metavar="AXIS=ANGLE", hidden=True)]
Until = Annotated[str | None, typer.Option(metavar="TIME", hidden=True)]
CsvOfCells = Annotated[bool, typer.Option("--csv", help="CSV on stdout: a line for each cell.")]
Folder = Annotated[Path, typer.Option(metavar="DIR", help="Folder for the files.")]
Order = Annotated[int | None, typer.Option(metavar="N", min=1, help="Order of the lindstedt expansion.")]


def opens(place: str, **fixed: str) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """The work of a command that declares its options: a function of `commands` ("maps.sweep"), which gets
    them all by name, and what is fixed. Its file is read when the command is given."""
    file, name = place.split(".")

    def answered_by(declared: Callable[..., None]) -> Callable[..., None]:
        @wraps(declared)
        def run(**options: Any) -> None:
            if options.get("json") and options.get("csv"):
                raise typer.BadParameter("choose one of --json and --csv")
            if options.pop("si", False):
                options["units"] = "si"
            getattr(import_module(f"{commands.__name__}.{file}"), name)(**options, **fixed)
        run.opens = place, fixed  # type: ignore[attr-defined]  # for the test that compares the names
        return run
    return answered_by
