"""Text for people on stdout and stderr: width, colour, columns, and letters such as ω.

It is wrapped to a terminal and coloured there, with tables in columns, and plain lines anywhere else. Letters
are written out where an encoding has none of them."""
from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Sequence

from ..orbit.result import OUTCOMES, Fate
from ..reasons import ASCII
from .names import around

# What papers write in captions and formulas, where no key, path or option can stand
ALPHABET = {name: letter for letter, name in ASCII.items() if letter.isalpha() and name[:2].isalpha()
            and name[1:]}
# A formula as it is typed: a Greek letter with or without its number, an index, a power, a root
NOTATION = re.compile(
    r"(?<![A-Za-z_])(?P<letter>" + "|".join(sorted(ALPHABET, key=len, reverse=True)) + r")"
    r"(?:_?(?=\d)|(?=_[ijk]\b)|(?![\w-]))|(?<![A-Za-z])(?P<latin>l)_(?=[xyz]\b)"
    r"|(?<=[^\W\d_])_(?P<index>[ijk])\b|\^(?P<power>\d)(?!\d)|(?P<root>sqrt)(?=\()")
# What of a number or a formula is a minus and no hyphen: of an exponent, a sign, a difference; and the plus
# and the zeros of an exponent, which a book leaves out
MINUS = re.compile(r"(?<=\de)[+-]?0*(?=[1-9])|(?<![\w)\]./-])-(?=[\d.∞])|(?:(?<=[ (\[=])|^)-(?=[\w(])"
                   r"|(?<=[(\[])-(?= \w)|(?<=[\w)²³*;]) - (?=[\w(])|(?<=\b[a-z])-(?=[a-z]\))")
LONG = re.compile(r"(?<![\w.])\d+\.\d{6,}(?:e[+-]?\d+)?")  # in notes of theories
INDICES = str.maketrans("ijk", "ᵢⱼₖ")
SIGNS = {"+-": "±", "-+": "∓", "<=": "≤", ">=": "≥", "-inf ": "-∞ ", " inf ": " ∞ "}
# what a book sets otherwise than a terminal: infinity, a transpose, the products of vectors
PRINTED = re.compile(r"\binf\b|\^T\b|(?<=\s)x(?=\s[\w(]+\s=)|(?<=[\w)]) \. (?=[\w(])"
                     r"|(?<=\b[MHωλγ])\.(?=[(MHDωλγ])")
PRINTED_AS = {"inf": "∞", "^T": "ᵀ", "x": "×", " . ": " · ", ".": "·"}
RAISED = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


@around
def written(text: str) -> str:
    """A caption or a claim as a paper sets it: lambda3 becomes λ3, r0^2 becomes r0², sqrt(x) becomes √(x),
    l_x becomes lx, +- becomes ±."""
    return _in_letters(minus(text.replace("+-", "±").replace("-+", "∓")))


@around
def in_letters(text: str) -> str:
    """Words with numbers of all digits at a terminal: names as letters alone."""
    return _in_letters(text)


@around
def lettered(text: str) -> str:
    """Words of the analysis at a terminal: letters as `written`, numbers with six digits."""
    return _in_letters(LONG.sub(lambda match: f"{float(match[0]):.6g}", text))


@around
def printed(text: str) -> str:
    """Words of the analysis for a page: letters as `lettered`, minus, products and powers of ten as a book
    sets them. What stands between backquotes is a command and stays as it is."""
    return but_for_commands(text, lambda part: minus(
        PRINTED.sub(lambda sign: PRINTED_AS[sign[0]], lettered(part))))


def but_for_commands(text: str, change: Callable[[str], str]) -> str:
    """The text changed but for the commands in it, which stand between backquotes."""
    parts = text.split("`")
    return "`".join(part if n % 2 and n < len(parts) - 1 else change(part) for n, part in enumerate(parts))


@around
def minus(text: str) -> str:
    """The text with the minus of a book, 1e-08 as 1e−8; the hyphens of words as they are."""
    return MINUS.sub(lambda match: match[0].rstrip("0").lstrip("+").replace("-", "−"), text)


def _in_letters(text: str):
    for plain, sign in SIGNS.items():
        text = text.replace(plain, sign)
    return NOTATION.sub(_letter, text)


def _letter(result):
    match result.lastgroup:
        case "index":
            return result["index"].translate(INDICES)
        case "power":
            return result["power"].translate(RAISED)
        case "root":
            return "√"
    return ALPHABET.get(result[result.lastgroup], "l")


@around
def capital(text: str) -> str:
    """A sentence with a capital at its head, where a word stands there and no formula, symbol or file."""
    first = text.partition(" ")[0]
    word = (len(first) > 1 or first == "a") and first.isascii() and first.isalpha() and first.islower()
    return text[:1].upper() + text[1:] if word else text


def some(count: int, noun: str) -> str:
    """A number with its noun: "1 curve", "2 curves"."""
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def listed(text: Sequence[str], last: str = "and") -> str:
    """Words one after the other: "a", "a and b", "a, b and c"."""
    return f" {last} ".join(filter(None, (", ".join(text[:-1]), text[-1])))


def plain(text: str) -> str:
    """The text in ASCII as far as its letters have names: ω1 becomes omega1."""
    return "".join(ASCII.get(letter, letter) for letter in text)


def encodable(text: str, encoding: str | None) -> str:
    """The text as it is, or in names of letters where the encoding (None: any letter) cannot write them."""
    try:
        text.encode(encoding or "utf-8")
    except (UnicodeEncodeError, LookupError):
        return plain(text)
    return text


LINE = 100   # letters of a line that holds several clauses
USUAL = 80   # columns of a terminal that does not say how wide it is
GAP = 2      # columns between those of a table
NARROW = 40  # columns below which nothing is wrapped any narrower
# how the line of an outcome begins
HEADED = {fate: re.findall(r"^[A-Z ]*[A-Z]", outcome.head) for fate, outcome in OUTCOMES.items()}
COLOURS = {"bold green": (*HEADED[Fate.BOUNDED], *HEADED[Fate.EQUILIBRIUM], "NEVER", "AT REST", "PROVED"),
           "bold red": (*HEADED[Fate.SPIN_UP], "BEYOND THE LAW", "REFUTED"),
           "bold yellow": (*HEADED[Fate.UNDECIDED], *HEADED[Fate.SEPARATRIX], "NOT KNOWN")}
COLOURED = {rf"\b(?:{'|'.join(map(re.escape, text))})\b": colour for colour, text in COLOURS.items()}
BLANK = "\0"  # stands for a blank that no line is broken at
PART = "\1"   # stands between two clauses
STABLE = {r"\bunstable\b": "red", r"(?<!un)\b(?:asymptotically )?stable\b": "green",
          r"\bundecided\b": "yellow"}


def tell(text: str) -> None:
    """Write text for people to stdout."""
    out = sys.stdout
    text = encodable(text, getattr(out, "encoding", None)).rstrip("\n") + "\n"
    columns = width()
    text = by_clauses(text)
    if columns is not None:
        text = wrapped(text, columns)
        if not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb":
            return _in_colours(text)
    out.write(text)
    out.flush()


def by_clauses(text: str) -> str:
    """The text with every line that is longer than `LINE` broken between its clauses: as many as fit stay on
    the first line, each other has a line of its own, two columns further in."""
    lines = []
    for line in text.split("\n"):
        first, *rest = clauses_of(line) if len(line) > LINE else [line]
        while rest and len(first) + len(rest[0]) + 2 <= LINE:
            first = f"{first}; {rest.pop(0)}"
        # a remark of a table stays one
        indent = "#   " if line.startswith("# ") else " " * (len(line) - len(line.lstrip()) + GAP)
        lines += [first, *(indent + clause for clause in rest)]
    return "\n".join(lines)


def clauses_of(line: str) -> list[str]:
    """What stands between the semicolons of a line outside its brackets, its quotes and what users named."""
    return _parted(line).split(PART)


@around
def _parted(line: str) -> str:
    parts, depth, quoted, begin = [], 0, False, 0
    for n, letter in enumerate(line):
        depth += (letter in "([{") - (letter in ")]}")
        quoted ^= letter == '"'
        if line.startswith("; ", n) and depth <= 0 and not quoted:
            parts.append(line[begin:n])
            begin = n + 2
    return PART.join([*parts, line[begin:]])


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
        lines += (textwrap.wrap(_place_together(line), columns, subsequent_indent=indent,
                                break_long_words=False, break_on_hyphens=False) or [""])
    return "\n".join(lines).replace(BLANK, " ")


def _place_together(line: str):
    """The line with a file at its head as one word, whatever blanks its name holds."""
    if line.startswith("written: "):
        return line.replace(" ", BLANK)
    location, colon, rest = line.partition(":")
    _, point, ending = location.rpartition(".")
    named = colon and point and ending.replace("_", "").isalnum()
    return f"{location.replace(' ', BLANK)}:{rest}" if named else line


def _hang(line, columns):
    """Where what does not fit goes on: below the words after a column of names, else two columns in."""
    text = line.lstrip(" ")
    indent = len(line) - len(text)
    _, gap, beside = text.partition("  ")
    named = len(line) - len(beside.lstrip(" "))
    return named if indent and gap and beside.strip(" ") and named <= columns // 2 else indent + 2


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
    request = os.environ.get("COLUMNS", "")
    if request.isdecimal() and int(request):
        return int(request)
    try:
        return os.get_terminal_size(stream.fileno()).columns or USUAL
    except OSError:  # it has no descriptor of its own
        return USUAL


def _in_colours(text: str):
    from rich.console import Console
    from rich.text import Text
    shown = Text(text, end="")
    for table in (STABLE, COLOURED):
        for key, style in table.items():
            shown.highlight_regex(key, style)
    Console(file=sys.stdout, highlight=False, soft_wrap=True, width=10_000).print(shown, end="")
    sys.stdout.flush()
