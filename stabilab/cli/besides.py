"""What belongs to no group: the state of the machine, and cases to begin with."""
from __future__ import annotations

from typing import Annotated  # typer reads the annotations at run time

import typer

commands = typer.Typer()


@commands.command()
def doctor():
    """Say what is installed and whether pictures can be drawn.

    Example: stabilab doctor
    """
    from ..commands.doctor import doctor as answer
    answer()


@commands.command()
def example(name: Annotated[str | None, typer.Argument(
        metavar="NAME", help="Of a case; without one all are listed.")] = None):
    """Write a case to begin with: a phone, a CubeSat, an asteroid.

    Example: stabilab example phone > phone.toml
    """
    from ..commands.one_case import examples as answer
    answer(name)
