"""Proofs and checks: certificates, reference motions, formulas and numbers held against ours, bytes made
again."""
from __future__ import annotations

from pathlib import Path
from typing import Annotated  # typer reads the annotations at run time

import typer

from ..show.terminal import completion
from .options import CaseFile, Json

commands = typer.Typer()


@commands.command()
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
    from ..commands.certificates import verify as answer
    answer(certificate, case, json, strict)


@commands.command()
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
    from ..commands.simulate import reference as answer
    answer(case, at, digits, out, json)


@commands.command()
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
    from ..commands.papers import audit as answer
    answer(paper, equation, json, out)


@commands.command()
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
    from ..commands.papers import validate as answer
    answer(source, json, out)


@commands.command()
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
    from ..commands.report import rerun as answer
    answer(manifest, out)
