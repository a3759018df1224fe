"""The papers' own tables and figures."""
from __future__ import annotations

from pathlib import Path
from typing import Annotated  # typer reads the annotations at run time

import typer

from ..show.terminal import completion
from .options import Folder, Json

commands = typer.Typer()


@commands.command()
def papers(
        paper: Annotated[str | None, typer.Argument(
            metavar="[PAPER]", autocompletion=completion.audited, show_default=False,
            help="A paper of `stabilab audit`; none: all.")] = None,
        json: Json = False):
    """List equations, figures, tables, claims with verdicts.

    Example: stabilab papers constant-torque-gyrostat
    """
    from ..commands.papers import papers as answer
    answer(paper, json)


@commands.command()
def tables(out: Folder = ...):  # type: ignore[assignment]  # typer: must be given
    """Write Tables 1-4 of the constant-torque paper.

    Formats: text, CSV, Markdown, LaTeX, HTML.

    Example: stabilab tables --out tables
    """
    from ..commands.papers import tables as answer
    answer(out)


@commands.command()
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
    from ..commands.papers import figures as answer
    answer(numbers, paper, out)
