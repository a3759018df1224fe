"""What belongs to no group: the state of the machine."""
from __future__ import annotations

import typer

commands = typer.Typer()


@commands.command()
def doctor():
    """Say what is installed and whether pictures can be drawn.

    Example: stabilab doctor
    """
    from ..commands.doctor import doctor as answer
    answer()
