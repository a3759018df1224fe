"""Proofs and checks: certificates, reference motions, formulas and numbers compared with ours, bytes made
again; the papers' tables and figures."""
from __future__ import annotations

from pathlib import Path
from typing import Annotated  # typer reads the annotations at run time

import typer

from ..show.terminal import completion
from .options import CaseFile, Folder, Json, opens

commands = typer.Typer()


@commands.command()
@opens("certificates.verify")
def verify(
        certificate: Annotated[Path, typer.Argument(
            metavar="CERTIFICATE", show_default=False, autocompletion=completion.certificates,
            help="A certificate.json of classify --certify or bifurcation --certify.")],
        case: Annotated[Path | None, typer.Option(
            metavar="CASE.toml",
            help="The case it must be of: exit with 5 where scene or state differ.")] = None,
        json: Json = False,
        strict: Annotated[bool, typer.Option(
            "--strict", help="Exit with 3 where a claim could not be checked.")] = False):
    """Check a certificate with separate code.

    Shares only python-flint with the analysis. Exits with 5 where a claim is wrong.

    Example: stabilab verify certificate.json --case cases/minor-axis-100.toml
    """


@commands.command()
@opens("simulate.reference")
def reference(
        case: CaseFile,
        at: Annotated[list[str] | None, typer.Option(
            metavar="T1,T2,...",
            help="Times from 0 on, with a unit or in that of the case. Default: 201 times over "
                 "the span.")] = None,
        digits: Annotated[int, typer.Option(metavar="N", help="Digits (1 to 50) of every state.")] = 30,
        out: Annotated[Path | None, typer.Option(metavar="FILE.csv|.json", help="Write to a file.")] = None,
        json: Json = False):
    """Write a motion with guaranteed digits, to test integrators.

    States, zeros and extremes, period, with versions, case and command: CSV, or JSON. Exits with 5 where
    digits are not reached.

    Example: stabilab reference cases/minor-axis-100.toml --digits 30 --out minor-axis-100.csv
    """


@commands.command()
@opens("papers.audit")
def audit(
        paper: Annotated[str | None, typer.Argument(
            metavar="[PAPER]", show_default=False, autocompletion=completion.audited,
            help="A paper on record or a file of claims, .toml; default: all papers.")] = None,
        equation: Annotated[str | None, typer.Option(
            metavar="N", help="One equation or claim, as 17 or text-8a.")] = None,
        json: Json = False,
        out: Annotated[Path | None, typer.Option(
            "--html", metavar="FILE.html", help="Write a page with the formulas typeset.")] = None):
    """Check published formulas against the equations of motion.

    Each row: holds, holds only under a condition, wrong (with what is right), definition, or not checkable.

    Example: stabilab audit constant-torque-gyrostat --equation 17
    """


@commands.command()
@opens("papers.validate")
def validate(
        source: Annotated[str | None, typer.Argument(
            metavar="[SOURCE]", show_default=False, autocompletion=completion.sources,
            help="nesc, basilisk, orekit or 42; default: all.")] = None,
        json: Json = False,
        out: Annotated[Path | None, typer.Option(
            "--html", metavar="FILE.html", help="Write a page with the table.")] = None):
    """Compare other tools' published numbers with ours.

    Ours with proved digits, theirs, the difference, and its cause. Exits with 5 where a difference is not
    explained.

    Example: stabilab validate nesc
    """


@commands.command()
@opens("report.rerun")
def rerun(
        manifest: Annotated[Path, typer.Argument(
            metavar="MANIFEST", show_default=False, autocompletion=completion.certificates,
            help="A manifest.json, or the folder that holds it.")],
        out: Annotated[Path | None, typer.Option(
            metavar="DIR", help="Keep the new files in an empty folder.")] = None):
    """Repeat what made a folder and compare every byte.

    Exits with 2 where inputs are missing or changed, with 5 where a file differs.

    Example: stabilab rerun report/manifest.json
    """


@commands.command()
@opens("papers.papers")
def papers(
        paper: Annotated[str | None, typer.Argument(
            metavar="[PAPER]", autocompletion=completion.audited, show_default=False,
            help="A paper of `stabilab audit`; none: all.")] = None,
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
        numbers: Annotated[list[int] | None, typer.Argument(
            metavar="[N...]", show_default=False, help="Figure numbers of one paper; none: all.")] = None,
        paper: Annotated[str | None, typer.Option(
            metavar="NAME", autocompletion=completion.papers,
            help="constant-torque, charged, cavity or top. Default: constant-torque where "
                 "numbers are given, else all.")] = None,
        out: Annotated[Path, typer.Option(metavar="DIR", help="Folder for the pictures.")] = Path("figures")):
    """Draw the figures of the papers.

    Each picture gets a text file: caption, command, version, tolerance.

    Example: stabilab figures --paper charged 2 8 --out figures
    """
