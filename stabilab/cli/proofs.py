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
            "CASE.toml", "The case it must be of: exit with 5 where scene or state differ.")] = None,
        json: Json = False,
        strict: Annotated[bool, flag("--strict", "Exit with 3 where a claim could not be checked.")] = False):
    """Check a certificate with separate code.

    Shares only python-flint with the analysis. Exits with 5 where a claim is wrong.

    Example: stabilab verify certificate.json --case cases/minor-axis-100.toml
    """


@commands.command()
@opens("simulate.reference")
def reference(
        case: CaseFile,
        at: Annotated[list[str] | None, option("T1,T2,...",
            "Times from 0 on, with a unit or in that of the case. Default: 201 times over the span.")] = None,
        digits: Annotated[int, option("N", "Digits (1 to 50) of every state.")] = 30,
        out: Annotated[Path | None, option("FILE.csv|.json", "Write to a file.")] = None,
        json: Json = False):
    """Write a motion with guaranteed digits, to test integrators.

    States, zeros and extremes, period, with versions, case and command: CSV, or JSON. Exits with 5 where
    digits are not reached.

    Example: stabilab reference cases/minor-axis-100.toml --digits 30 --out minor-axis-100.csv
    """


@commands.command()
@opens("papers.audit")
def audit(
        paper: Annotated[str | None, argument("[PAPER]",
            "A paper on record or a file of claims, .toml; default: all papers.",
            autocompletion=command_groups.audited)] = None,
        equation: Annotated[str | None, option("N", "One equation or claim, as 17 or text-8a.")] = None,
        json: Json = False,
        out: Annotated[Path | None, option(
            "FILE.html", "Write a page with the formulas typeset.", "--html")] = None):
    """Check published formulas against the equations of motion.

    Each row: holds, holds only under a condition, wrong (with what is right), definition, or not checkable.

    Example: stabilab audit constant-torque-gyrostat --equation 17
    """


@commands.command()
@opens("papers.validate")
def validate(
        source: Annotated[str | None, argument("[SOURCE]",
            "nesc, basilisk, orekit or 42; default: all.", autocompletion=command_groups.sources)] = None,
        json: Json = False,
        out: Annotated[Path | None, option("FILE.html", "Write a page with the table.", "--html")] = None):
    """Compare other tools' published numbers with ours.

    Ours with proved digits, theirs, the difference, and its cause. Exits with 5 where a difference is not
    explained.

    Example: stabilab validate nesc
    """


@commands.command()
@opens("papers.rerun")
def rerun(
        manifest: Annotated[Path, argument("MANIFEST",
            "A manifest.json, or the folder that holds it.", autocompletion=command_groups.certificates)],
        out: Annotated[Path | None, option("DIR", "Keep the new files in an empty folder.")] = None):
    """Repeat what made a folder and compare every byte.

    Exits with 2 where inputs are missing or changed, with 5 where a file differs.

    Example: stabilab rerun report/manifest.json
    """


@commands.command()
@opens("papers.papers")
def papers(
        paper: Annotated[str | None, argument(
            "[PAPER]", "A paper of `stabilab audit`; none: all.",
            autocompletion=command_groups.audited)] = None,
        json: Json = False):
    """List equations, figures, tables, claims with verdicts.

    Example: stabilab papers constant-torque-gyrostat
    """


@commands.command()
@opens("papers.tables")
def tables(out: Folder = ...):  # type: ignore[assignment]  # typer: must be given
    """Write Tables 1-4 of the constant-torque paper.

    Formats: text, CSV, Markdown, LaTeX, HTML.

    Example: stabilab tables --out tables
    """


@commands.command()
@opens("papers.figures")
def figures(
        numbers: Annotated[list[int] | None, argument(
            "[N...]", "Figure numbers of one paper; none: all.")] = None,
        paper: Annotated[str | None, option("NAME",
            "constant-torque, charged, cavity or top. Default: constant-torque where numbers are given, "
            "else all.", autocompletion=command_groups.papers)] = None,
        out: Annotated[Path, option("DIR", "Folder for the pictures.")] = Path("figures")):
    """Draw the figures of the papers.

    Each picture gets a text file: caption, command, version, tolerance.

    Example: stabilab figures --paper charged 2 8 --out figures
    """
