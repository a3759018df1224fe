"""The commands of the program in groups, by what one wants to know, for the help; and what the shell
completes: case files, and the names that an option takes."""
from __future__ import annotations

import os
from typing import Any

from typer.core import TyperGroup

from .picture_kinds import KINDS

# title of a group in the help -> the file of `cli` that declares its commands, and the question of each
GROUPS = {
    "Answers about a motion": ("motions", {
        "classify": "Where are the equilibria, which are stable, and what is the outcome of the motion?",
        "fate": "Does the motion stay bounded or spin up, and how far is it from the other outcome?",
        "extremes": "How large do the rates get?",
        "period": "After which time do the rates repeat?",
        "attitude": "How does the body turn in space?",
        "when": "When is a limit first reached?",
        "stuck": "My thruster is stuck open: what happens, how soon, what helps?",
        "burn": "How does the body move after a burn, and by when must a thruster be closed?",
        "flat-spin": "When does a spin that loses energy tumble, and how does it end?",
        "orbit": "Which equilibrium attitudes does a satellite have on a circular orbit?",
        "chaos": "Is the motion regular or chaotic?"}),
    "Runs and pictures": ("runs", {
        "simulate": "What are the rates at a given time?",
        "plot": "What does the motion look like?",
        "surface": "Which surface divides the outcomes, as a mesh?",
        "report": "What is known of my cases, as web pages?",
        "explore": "How does the outcome change as I change the numbers?"}),
    "More about a case": ("one_case", {
        "show": "Which equations of motion and first integrals does my case have?",
        "compare": "For how long is an analytic theory close to the exact motion?",
        "precision": "What does accuracy cost?",
        "import": "How do I import a spacecraft of another program?",
        "export": "How do I give the body of my case to another program?"}),
    "Many cases at once": ("many_cases", {
        "sweep": "What are the answers over ranges of my numbers?",
        "atlas": "What does a torque do in each direction?",
        "basin": "Which initial states spin up, and how rough is the boundary of their set?",
        "bifurcation": "At which numbers do equilibria appear and vanish?"}),
    "Proofs and checks": ("proofs", {
        "verify": "Is what a certificate claims proved?",
        "reference": "Which motion with guaranteed digits tests my integrator?",
        "audit": "Are published formulas right?",
        "validate": "Do published results of other programs agree?",
        "rerun": "Does the same command give the same bytes?"}),
    "The papers": ("proofs", {
        "papers": "Which equations, figures and claims do the papers have, and which are right?",
        "tables": "Where are the tables of the constant-torque paper?",
        "figures": "Where are the figures of the papers?"}),
    "Help to begin": ("one_case", {
        "example": "With which case do I begin?",
        "doctor": "Is everything installed that pictures need?"}),
}


class Grouped(TyperGroup):
    """A program whose help has its commands in groups."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        commands = {name: self.get_command(ctx, name) for name in self.list_commands(ctx)}
        visited = {name: command
                for name, command in commands.items() if command is not None and not command.hidden}
        limit = formatter.width - 6 - max(map(len, visited))
        wide = max(map(len, visited))
        for title, (_, names) in GROUPS.items():
            rows = [(f"{name:<{wide}}", visited[name].get_short_help_str(limit)) for name in names
                    if name in visited]
            if rows:
                with formatter.section(title):
                    formatter.write_dl(rows)


def cases(incomplete: str) -> list[str]:
    """Case files and folders whose path begins so."""
    return _paths(incomplete, (".toml",))


def certificates(incomplete: str) -> list[str]:
    """Certificates, manifests and other JSON files."""
    return _paths(incomplete, (".json",))


def _paths(begun: str, endings) -> list[str]:
    """Folders, and files with these endings, whose paths begin so; hidden ones where a dot was typed."""
    folder, name = os.path.split(begun)
    try:
        with os.scandir(folder or ".") as result:
            rows = sorted((entry.name, entry.is_dir()) for entry in result)
    except OSError:
        return []
    return [os.path.join(folder, item) + ("/" if is_folder else "") for item, is_folder in rows
            if item.startswith(name) and (name.startswith(".") or not item.startswith("."))
            and (is_folder or item.endswith(endings))]


def _among(*text: str):
    def offered(incomplete: str) -> list[str]:
        return [word for word in text if word.startswith(incomplete)]
    return offered


units = _among("deg", "deg/day", "rpm", "rev/s", "si")
models = _among("exact", "linear", "corrected", "printed", "averaged1", "averaged2", "lindstedt")
methods = _among("taylor", "reduced", "DOP853", "RK45", "RK23", "Radau", "BDF", "LSODA")
papers = _among("constant-torque", "charged", "cavity", "top")
sources = _among("nesc", "basilisk", "orekit", "jeod", "apophis", "tc3", "moon", "shell", "dual-spin", "42")


def kinds(incomplete: str) -> list[str]:
    """Kinds of plots."""
    return [kind for kind in KINDS if kind.startswith(incomplete)]


def audited(incomplete: str) -> list[str]:
    """Papers on record, and files of claims."""
    folder = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "theories", "printed",
                          "papers")
    names = sorted(name.removesuffix(".toml") for name in os.listdir(folder) if name.endswith(".toml"))
    return [name for name in names if name.startswith(incomplete)] + _paths(incomplete, (".toml",))
