"""The page of all commands, by the question that each answers: from the table of `stabilab --help`."""
from __future__ import annotations

import inspect
import re
from importlib import import_module

HEAD = """# Commands

Every command by the question it answers, with an example; `--help` after a command lists its options with
their units.
"""


def text() -> str:
    """A table a group of the help: question, example."""
    from stabilab.show.command_groups import GROUPS
    parts = [HEAD]
    for title, (file, questions) in GROUPS.items():
        examples = examples_of(file)
        parts += [f"## {title}\n", "| question | example |", "|---|---|",
                  *(f"| {question} | `{examples[name]}` |" for name, question in questions.items()), ""]
    return "\n".join(parts)


def examples_of(file: str) -> dict[str, str]:
    """{name: the example of its help} of the commands that a file of `cli` declares."""
    found = {}
    for one in import_module(f"stabilab.cli.{file}").commands.registered_commands:
        example = re.search(r"Example: (.*)", inspect.getdoc(one.callback), re.S)[1]
        found[one.name or one.callback.__name__] = " ".join(example.split())
    return found
