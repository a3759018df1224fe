"""More about a case: its equations, its models and methods compared, a case from another program's file, and
for other programs; cases to begin with, and the state of the machine."""
from __future__ import annotations

from pathlib import Path
from typing import Annotated  # typer reads the annotations at run time

import typer

from .options import CaseFile, Csv, Json, Order, Strict, UnitsOption, argument, flag, opens, option

commands = typer.Typer()


@commands.command()
@opens("one_case.show")
def show(case: CaseFile):
    """Show the equations of motion and their first integrals.

    In text and LaTeX, for the effects of this case; also what was understood of the file.

    Example: stabilab show cases/minor-axis-100.toml
    """


@commands.command()
@opens("one_case.compare")
def compare(
        case: CaseFile, order: Order = None,
        out: Annotated[Path | None, option("FILE.csv", "Write the errors over time.")] = None,
        json: Json = False, strict: Strict = False, units: UnitsOption = None):
    """Compare the analytic models of a case with its exact motion.

    The error over time, and the times at which it first reaches 1 % and 10 %.

    Example: stabilab compare cases/charged-body.toml
    """


@commands.command()
@opens("one_case.precision")
def precision(
        case: CaseFile, json: Json = False, csv: Csv = False,
        out: Annotated[Path | None, option(
            "FILE.png|.svg|.pdf|.csv", "Write the picture or the points.")] = None,
        until: Annotated[str | None, option(
            "TIME", "End of the span: \"10 min\"; default: the case's own, or some periods.")] = None,
        quick: Annotated[bool, flag("--quick", "Try few settings: seconds instead of a minute.")] = False,
        all_settings: Annotated[bool, flag(
            "--all", "Print every setting of every method, and the findings in words.")] = False,
        overview: Annotated[bool, flag(
            "--overview", "Draw at most five methods into --out, a first run and again.")] = False,
        strict: Strict = False):
    """Measure what accuracy costs: error and time of each method.

    Errors are measured against a Taylor series in many digits, whose own error is known.

    Example: stabilab precision cases/minor-axis-100.toml --quick
    """


@commands.command(name="import")
@opens("one_case.import_")
def import_(
        file: Annotated[Path, argument(
            "FILE", "A NASA 42 spacecraft file, a CCSDS APM, URDF, SDFormat, MJCF, or JSON or a Python "
            "dictionary with Basilisk's names.")],
        out: Annotated[Path | None, option("FILE.toml", "Write the case to a file.")] = None,
        stuck: Annotated[list[str] | None, option(
            "NAME", "A thruster that is stuck open, or a maneuver of an APM that acts for ever; may be "
            "repeated.")] = None,
        body: Annotated[str | None, option(
            "N|NAME", "Take one body alone of several: its number in a NASA 42 file, the name of a link or "
            "body of a robot description.", show_default="all, joined")] = None):
    """Write another program's spacecraft as a case.

    Several bodies on joints become one rigid body, with the joints locked in the positions of the file. An
    angular velocity is read where the file has one.

    What has no counterpart in a case is listed on stderr. Exits with 2 where the case still has faults.

    Example: stabilab import SC_Simple.txt --out simple.toml
    """


@commands.command()
@opens("one_case.export")
def export(
        case: CaseFile, out: Annotated[Path | None, option(
            "FILE.urdf", "Write the description to a file; with [sweep] a file a combination.")] = None):
    """Write the body of a case as a robot description (URDF).

    One link, whose inertial has the mass, the centre of mass and the tensor of the file, to the last digit.
    What it has no place for, such as motion and thrusters, is listed on stderr.

    Example: stabilab export cases/cubesat-3u.toml --out cubesat.urdf
    """


@commands.command()
@opens("doctor.doctor")
def doctor(compiling: Annotated[bool, flag(
        "--compile", "Compile all loops now, once per computer: 40 s.")] = False):
    """Say what is installed and whether pictures can be drawn.

    Example: stabilab doctor
    """


@commands.command()
@opens("one_case.example")
def example(name: Annotated[str | None, argument("NAME", "Name of a case; default: list all.")] = None):
    """Write a case to begin with: a phone, a CubeSat, an asteroid.

    Example: stabilab example phone > phone.toml
    """
