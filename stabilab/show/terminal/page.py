"""Text for people on stdout: wrapped to a terminal and coloured there, and the plain lines anywhere else."""
from __future__ import annotations

import os
import re
import sys

from .letters import for_people

NARROW = 40  # columns below which nothing is wrapped any narrower
COLOURS = {r"\bBOUNDED\b|\bNEVER\b|\bAT REST\b|\bPROVED\b": "bold green", r"\bSPINS UP\b|BEYOND THE LAW|\bREFUTED\b": "bold red",
           r"\bUNDECIDED\b|ON THE SEPARATRIX|NOT KNOWN": "bold yellow"}
STABLE = {r"\bunstable\b": "red", r"(?<!un)\b(?:asymptotically )?stable\b": "green", r"\bundecided\b": "yellow"}


def tell(text: str) -> None:
    """Write text for people to stdout."""
    out = sys.stdout
    text = for_people(text, getattr(out, "encoding", None)).rstrip("\n") + "\n"
    columns = width()
    if columns is not None:
        text = wrapped(text, columns)
        if _coloured():
            return _in_colours(text)
    out.write(text)
    out.flush()


def wrapped(text: str, columns: int) -> str:
    """The text with every line at most so wide; what is continued stands two columns further in."""
    import textwrap
    columns = max(columns, NARROW)
    lines = []
    for line in text.split("\n"):
        if len(line) <= columns:
            lines.append(line)
            continue
        indent = " " * _hang(line, columns)
        lines += textwrap.wrap(line, columns, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False) or [""]
    return "\n".join(lines)


def _hang(line, columns):
    """Where what does not fit goes on: below the words after a column of names, else two columns further in."""
    named = re.match(r"( +\S.*? {2,})\S", line)
    if named and len(named[1]) <= columns // 2:
        return len(named[1])
    return len(line) - len(line.lstrip()) + 2


def width() -> int | None:
    """Columns of the terminal that stdout is; None where it is a pipe or a file, whose lines are never broken."""
    import shutil
    return shutil.get_terminal_size().columns if sys.stdout.isatty() else None


def _coloured() -> bool:
    return not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"


def _in_colours(text):
    from rich.console import Console
    from rich.text import Text
    shown = Text(text, end="")
    for table in (STABLE, COLOURS):
        for words, style in table.items():
            shown.highlight_regex(words, style)
    Console(file=sys.stdout, highlight=False, soft_wrap=True, width=10_000).print(shown, end="")
    sys.stdout.flush()
