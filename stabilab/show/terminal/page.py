"""Text for people on stdout and stderr: wrapped to a terminal and coloured there, tables in columns, and the
plain lines anywhere else."""
from __future__ import annotations

import os
import re
import sys
from collections.abc import Sequence

from .letters import encodable, greek

USUAL = 80   # columns of a terminal that does not say how wide it is
GAP = 2      # columns between those of a table
NARROW = 40  # columns below which nothing is wrapped any narrower
COLOURS = {r"\bBOUNDED\b|\bNEVER\b|\bAT REST\b|\bSTEADY ROTATION\b|\bPROVED\b": "bold green",
           r"\bSPINS UP\b|BEYOND THE LAW|\bREFUTED\b": "bold red",
           r"\bUNDECIDED\b|ON THE SEPARATRIX|NOT KNOWN": "bold yellow"}
# a file, with a line of it: one word, whatever blanks its name holds
PLACE = re.compile(r"(?:written: .*|[^:\n]*\.\w+(?::\d+)*:)")
BLANK = "\0"  # stands for a blank that no line is broken at
STABLE = {r"\bunstable\b": "red", r"(?<!un)\b(?:asymptotically )?stable\b": "green",
          r"\bundecided\b": "yellow"}


def tell(text: str) -> None:
    """Write text for people to stdout."""
    out = sys.stdout
    text = encodable(greek(text), getattr(out, "encoding", None)).rstrip("\n") + "\n"
    columns = width()
    if columns is not None:
        text = wrapped(text, columns)
        if not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb":
            return _in_colours(text)
    out.write(text)
    out.flush()


def say(text: str) -> None:
    """Write a message for people to stderr. What a file calls its keys stays as it is, for the reader looks
    for it there."""
    err = sys.stderr
    columns = width(err)
    text = encodable(text.rstrip("\n"), getattr(err, "encoding", None))
    print(text if columns is None else wrapped(text, columns), file=err)


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
        line = (PLACE.sub(lambda found: found[0].replace(" ", BLANK), line, count=1) if PLACE.match(line)
                else line)
        lines += (textwrap.wrap(line, columns, subsequent_indent=indent, break_long_words=False,
                                break_on_hyphens=False) or [""])
    return "\n".join(lines).replace(BLANK, " ")


def _hang(line, columns):
    """Where what does not fit goes on: below the words after a column of names, else two columns in."""
    named = re.match(r"( +\S.*? {2,})\S", line)
    if named and len(named[1]) <= columns // 2:
        return len(named[1])
    return len(line) - len(line.lstrip()) + 2


def table(rows: Sequence[Sequence[str]], keys: int = 1, width: int | None = None) -> list[str]:
    """Lines of right-aligned cells, two columns apart. width: of a terminal; where the columns do not fit,
    the others go on in a table below, with the first `keys` columns again, or with the first alone where
    these fill half a line."""
    sizes = [GAP + max(map(len, column)) for column in zip(*rows)]
    fits = max(width, NARROW) if width is not None else sum(sizes)
    again = range(keys if sum(sizes[:keys]) <= fits // 2 else 1)
    lines: list[str] = []
    left = list(range(len(sizes)))
    while left:
        chosen = [] if not lines else list(again)
        while left and (sum(sizes[n] for n in [*chosen, left[0]]) <= fits
                        or len(chosen) == (len(again) if lines else 0)):
            chosen.append(left.pop(0))
        lines += [""] * bool(lines)
        lines += filter(None, ("".join(f"{row[n]:>{sizes[n]}}" for n in chosen).rstrip() for row in rows))
    return lines


def width(stream=None) -> int | None:
    """Columns of the terminal that the stream (None: stdout) is; None of a pipe or file."""
    stream = stream or sys.stdout
    if not stream.isatty():
        return None
    asked = os.environ.get("COLUMNS", "")
    if asked.isdecimal() and int(asked):
        return int(asked)
    try:
        return os.get_terminal_size(stream.fileno()).columns or USUAL
    except OSError:  # it has no descriptor of its own
        return USUAL


def _in_colours(text):
    from rich.console import Console
    from rich.text import Text
    shown = Text(text, end="")
    for table in (STABLE, COLOURS):
        for words, style in table.items():
            shown.highlight_regex(words, style)
    Console(file=sys.stdout, highlight=False, soft_wrap=True, width=10_000).print(shown, end="")
    sys.stdout.flush()
