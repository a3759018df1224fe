"""The help of the program: its commands in groups, by what one wants to know."""
from __future__ import annotations

from typing import Any

from typer.core import TyperGroup

GROUPS = {
    "Answers about a motion": ("classify", "fate", "extremes", "period", "when", "stuck", "chaos"),
    "Runs and pictures": ("simulate", "plot", "surface", "report", "explore"),
    "Into a case": ("show", "compare", "precision", "import"),
    "Many cases at once": ("sweep", "atlas", "basin", "bifurcation"),
    "Proofs and checks": ("verify", "reference", "audit", "validate", "rerun"),
    "The papers": ("tables", "figures"),
}
REST = "Besides"


class Grouped(TyperGroup):
    """A program whose help tells its commands in groups; one that is in none of them stands in the last."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        commands = {name: self.get_command(ctx, name) for name in self.list_commands(ctx)}
        seen = {name: command for name, command in commands.items() if command is not None and not command.hidden}
        placed = {name for names in GROUPS.values() for name in names}
        limit = formatter.width - 6 - max(map(len, seen))
        wide = max(map(len, seen))
        for title, names in {**GROUPS, REST: [name for name in seen if name not in placed]}.items():
            rows = [(f"{name:<{wide}}", seen[name].get_short_help_str(limit)) for name in names if name in seen]
            if rows:
                with formatter.section(title):
                    formatter.write_dl(rows)
