"""The help of the program: its commands in groups, by what one wants to know."""
from __future__ import annotations

from typing import Any

from typer.core import TyperGroup

# title of a group in the help -> the file of `cli` that declares its commands, and their names
GROUPS = {
    "Answers about a motion": ("motions",
                               ("classify", "fate", "extremes", "period", "attitude", "when", "stuck",
                                "burn", "flat-spin", "orbit", "chaos")),
    "Runs and pictures": ("runs", ("simulate", "plot", "surface", "report", "explore")),
    "More about a case": ("one_case", ("show", "compare", "precision", "import")),
    "Many cases at once": ("many_cases", ("sweep", "atlas", "basin", "bifurcation")),
    "Proofs and checks": ("proofs", ("verify", "reference", "audit", "validate", "rerun")),
    "The papers": ("papers", ("papers", "tables", "figures")),
    "Help to begin": ("besides", ("example", "doctor")),
}


class Grouped(TyperGroup):
    """A program whose help tells its commands in groups."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        commands = {name: self.get_command(ctx, name) for name in self.list_commands(ctx)}
        seen = {name: command for name,
                command in commands.items() if command is not None and not command.hidden}
        limit = formatter.width - 6 - max(map(len, seen))
        wide = max(map(len, seen))
        for title, (_, names) in GROUPS.items():
            rows = [(f"{name:<{wide}}", seen[name].get_short_help_str(limit)) for name in names
                    if name in seen]
            if rows:
                with formatter.section(title):
                    formatter.write_dl(rows)
