"""Proofs and checks: certificates, reference motions, formulas and numbers compared with ours, bytes made
again; the papers' tables and figures."""
from __future__ import annotations

from pathlib import Path
from typing import Annotated  # typer reads the annotations at run time

import typer

from ..show import command_groups
from .options import CaseFile, Folder, Json, argument, flag, opens, option

commands = typer.Typer()


@commands.command()
@opens("certificates.verify")
def verify(
        certificate: Annotated[Path, argument("CERTIFICATE",
            "A certificate.json of classify --certify or bifurcation --certify.",
            autocompletion=command_groups.certificates)],
        case: Annotated[Path | None, option(
            "CASE.toml", "The case that it must be about: exit with 5 where scene or state differ.")] = None,
        json: Json = False,
        strict: Annotated[bool, flag("--strict", "Exit with 3 where a claim could not be checked.")] = False):
    """Check a certificate with separate code.

    The code shares only the library python-flint with the analysis. Exits with 5 where a claim is wrong.

    Example: stabilab verify certificate.json --case cases/minor-axis-100.toml
    """


@commands.command()
@opens("simulate.reference")
def reference(
        case: CaseFile,
        at: Annotated[list[str] | None, option("T1,T2,...",
            'Times from 0 on, with a unit ("2 min") or in that of the case. Default: 201 times over the '
            "span.")] = None,
        digits: Annotated[int, option("N", "Digits (1 to 50) of every state.")] = 30,
        out: Annotated[Path | None, option("FILE.csv|.json", "Write to a file.")] = None,
        json: Json = False):
    """Write a motion with guaranteed digits, to test integrators.

    States, zeros and extremes of the rates, and the period, with version, case and command, as CSV or JSON.
    Exits with 5 where the digits are not reached.

    Example: stabilab reference cases/minor-axis-100.toml --digits 30 --out minor-axis-100.csv
    """


@commands.command()
@opens("papers.audit")
def audit(
        paper: Annotated[str | None, argument("[PAPER]",
            "A paper that comes with the program, or a file of claims (.toml); default: all papers.",
            autocompletion=command_groups.audited)] = None,
        equation: Annotated[str | None, option("N", "One equation or claim, such as 17 or text-8a.")] = None,
        json: Json = False,
        out: Annotated[Path | None, option(
            "FILE.html", "Write a page with the formulas typeset.", "--html")] = None):
    """Check published formulas against the equations of motion.

    Each one holds, holds only under a condition, is wrong (the correct one is given), is a definition, or
    cannot be checked.

    Example: stabilab audit constant-torque-gyrostat --equation 17
    """


@commands.command()
@opens("papers.validate")
def validate(
        source: Annotated[str | None, argument("[SOURCE]",
            "nesc, basilisk, orekit or 42; default: all.", autocompletion=command_groups.sources)] = None,
        json: Json = False,
        out: Annotated[Path | None, option("FILE.html", "Write a page with the table.", "--html")] = None):
    """Compare published results of others with the exact ones.

    The result with proved digits, the published one, the difference, and its cause. Exits with 5 where a
    difference is not explained.

    Example: stabilab validate nesc
    """


@commands.command()
@opens("papers.rerun")
def rerun(
        manifest: Annotated[Path, argument("MANIFEST",
            "A manifest.json, or the folder that contains it.", autocompletion=command_groups.certificates)],
        out: Annotated[Path | None, option("DIR", "Keep the new files in an empty folder.")] = None):
    """Repeat what wrote a folder, and compare every byte.

    Exits with 2 where inputs are missing or changed, with 5 where a file differs.

    Example: stabilab rerun report/manifest.json
    """


@commands.command()
@opens("papers.papers")
def papers(
        paper: Annotated[str | None, argument(
            "[PAPER]", "A paper of `stabilab audit`; default: all.",
            autocompletion=command_groups.audited)] = None,
        json: Json = False):
    """List equations, figures, tables and claims: right or wrong.

    Example: stabilab papers constant-torque-gyrostat
    """


@commands.command()
@opens("papers.tables")
def tables(out: Folder = ...):  # type: ignore[assignment]  # typer: must be given
    """Write the tables of the constant-torque paper.

    Formats: text, CSV, Markdown, LaTeX, HTML.

    Example: stabilab tables --out tables
    """


@commands.command()
@opens("papers.figures")
def figures(
        numbers: Annotated[list[int] | None, argument(
            "[N...]", "Numbers of figures of one paper; default: all.")] = None,
        paper: Annotated[str | None, option("NAME",
            "constant-torque, charged, cavity or top. Default: constant-torque where numbers are given, "
            "else all.", autocompletion=command_groups.papers)] = None,
        out: Annotated[Path, option("DIR", "Folder for the pictures.")] = Path("figures")):
    """Draw the figures of the papers.

    Each picture gets a text file: caption, command, version, tolerance.

    Example: stabilab figures --paper charged 2 8 --out figures
    """
