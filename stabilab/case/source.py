"""Where a case comes from: a file, or text with a name; its table [sweep]."""
from __future__ import annotations

import codecs
import copy
import math
import os
import re
import stat
import tomllib
from collections.abc import Mapping
from itertools import product
from typing import TYPE_CHECKING, Any

from ..errors import CaseError, InputError, Problem, printable
from .aliases import LISTS
from .formats import BY_HAND, IMPORTERS, READ, seems
from .lines import KeyLines, key_lines
from .repairs import repair
from .table import Faults, Table, Written, described, did_you_mean, dotted

if TYPE_CHECKING:
    from pathlib import Path

# --- The text of a case file and its TOML data; whatever is no such file is refused with the line where it
# goes wrong
FOLDER = os.path.join(os.path.dirname(os.path.dirname(__file__)), "cases")
# cases to begin with, by what a thing is: name -> its file in FOLDER; those of a folder there are for one
# question, the only one that they answer
EXAMPLES = {"phone": "phone", "t-handle": "t-handle", "top": "toy-top", "cubesat": "cubesat-3u",
            "comsat": "geostationary-22n", "upper-stage": "upper-stage", "station": "space-station",
            "explorer-1": "explorer-1", "toutatis": "toutatis", "charged-body": "charged-body",
            "tank": "liquid-sensible", "detumbling": "cubesat-3u-detumbling", "dual-spin": "dual-spin-turn",
            "slug": "rahn-barba", "vanguard-1": "vanguard-1", "stage": "burns/stage", "boom": "orbits/boom"}
QUESTIONS = {"burns": "burn", "orbits": "orbit"}  # folder -> its command
LARGEST = 128 * 1024  # bytes; a case has one or two thousand, and a wrong file is refused before it is parsed
LARGEST_IMPORT = 32 * LARGEST  # of another program, such as a description of a humanoid with all its shapes
_DECLARED = re.compile(rb"\s*<\?xml[^>]*?encoding\s*=\s*[\"']([\w.:-]+)[\"']")


def source_text(path, largest: int = LARGEST) -> str:
    """The file's text; a directory, a pipe, a device, a file of more bytes than `largest`, or other bytes
    than UTF-8 are refused; an XML file may be in the encoding that it declares."""
    try:
        str(path).encode()
    except UnicodeEncodeError:  # it could not be named in any answer
        raise CaseError(path, [Problem("", "the name of this file is not UTF-8: rename it")]) from None
    try:
        mode = os.stat(path).st_mode
        raw = None
        if stat.S_ISREG(mode):  # a pipe without a writer would wait for ever
            with open(path, "rb") as stream:
                raw = stream.read(largest + 1)
    except FileNotFoundError:
        raise CaseError(path, [Problem("", f"no such file{_neighbour(path)}")]) from None
    except (OSError, ValueError) as error:
        raise CaseError(path,
                        [Problem("",
                                 f"cannot be read: {getattr(error, 'strerror', None) or error}")]) from None
    if raw is None:
        kind = "a directory" if stat.S_ISDIR(mode) else "a pipe or a device"
        raise CaseError(path, [Problem("", f"expected a TOML file, this is {kind}")])
    if len(raw) > largest:
        what = "no case file" if largest == LARGEST else "more than is read"
        raise CaseError(path, [Problem("", f"longer than {largest // 1024} KiB: this is {what}")])
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        declared = _DECLARED.match(raw)
        try:
            if raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
                return raw.decode("utf-16")
            if declared and declared[1].lower().replace(b"-", b"") != b"utf8":
                return raw.decode(declared[1].decode())
        except (LookupError, UnicodeDecodeError):
            pass
        line = raw.count(b"\n", 0, error.start) + 1
        raise CaseError(path,
                        [Problem("", f"byte 0x{raw[error.start]:02x} is not UTF-8; save the file as UTF-8",
                                       line)]) from None


def _neighbour(path: str | Path) -> str:
    """"; ..." with what may have been meant by a path without a file: an example, a file of a like name, a
    case of the package."""
    from difflib import get_close_matches

    if path in EXAMPLES:
        return f"; `stabilab example {path} > {path}.toml` writes one"
    folder, name = os.path.split(path)
    try:
        nearby = get_close_matches(name, [n for n in os.listdir(folder or ".") if n.endswith(".toml")], n=1)
    except OSError:
        nearby = []
    if nearby:
        return f"; did you mean {os.path.join(folder, nearby[0])}?"
    brought = os.path.realpath(os.path.join(FOLDER, name))
    return f"; stabilab brings one: {brought}" if name.endswith(".toml") and os.path.isfile(brought) else ""


def example(name: str) -> str:
    """The text of the case of this name. Raises InputError for a name that there is not."""
    if name not in EXAMPLES:
        raise InputError(
            f"example {printable(name)[:60]}: there is none of this name{did_you_mean(name, EXAMPLES)}")
    return source_text(os.path.join(FOLDER, f"{EXAMPLES[name]}.toml"))


def command_of(name: str) -> str:
    """The command that answers an example."""
    return QUESTIONS.get(EXAMPLES[name].rpartition("/")[0], "classify")


def parsed(path: str, text: str) -> tuple[dict, Faults]:
    """The TOML data and an empty list of faults that knows the lines. Raises CaseError where the text is not
    TOML."""
    text = text.removeprefix("\ufeff")
    lines = key_lines(text)
    try:
        if lines.too_deep:
            raise RecursionError
        return tomllib.loads(text, parse_float=Written), Faults(lines)
    except RecursionError:
        raise CaseError(path, [Problem("", "nested too deeply to be read", lines.too_deep)]) from None
    except ValueError as error:
        raise CaseError(path, _syntax_problems(str(error), text, lines)) from None


def _syntax_problems(message: str, text: str, lines: KeyLines) -> list[Problem]:
    """What the TOML reader said, with its line; a key written twice is named with both lines."""
    if message.startswith("Exceeds the limit"):
        result = re.search(r"\d(_?\d){4000}", text)
        line = text.count("\n", 0, result.start()) + 1 if result else None
        return [Problem("", "an integer of more than 4000 digits is no number for a case", line)]
    location = re.search(r" \(at (?:line (\d+), column \d+|end of document)\)$", message)
    line = int(location[1]) if location and location[1] else text.count("\n") + 1 if location else None
    message = message[:location.start() if location else None][:200]
    if message.startswith(("Cannot", "Duplicate")) and lines.again:
        return [Problem(dotted(key), f"written a second time; the first is in line {lines.line[key]}"
                                     f"{_double(key)}", again)
                for key, again in lines.again.items()]
    return [_not_toml(message, text, line)]


def _double(key: tuple) -> str:
    return f"; write [[{key[0]}]], in double brackets, above each of them" if key[0] in LISTS else ""


def _not_toml(message: str, text: str, line: int | None) -> Problem:
    """What a text that is no TOML seems to be, or how its line was meant."""
    format = seems(text)
    if format == "JSON" or format in (importer.name for importer in IMPORTERS):
        return Problem("", f"not TOML ({message}): this seems to be {format}; `stabilab import FILE --out "
                           "case.toml` writes it as a case", line)
    if format not in ("", "YAML"):
        return Problem("", f"not TOML ({message}): this seems to be {format}; a case is a text in TOML "
                           f"(`stabilab example phone` prints one): {BY_HAND}. {READ}", line)
    result = repair(text, line) if line else None
    of = f", this seems to be {format}" if format else ""
    if result is None:
        shown = text.split("\n")[line - 1].strip()[:80] if line and line <= text.count("\n") + 1 else ""
        return Problem("", f"not TOML{of}: {message}" + (f'; got: {shown}' if shown else ""), line)
    write_ = f"; write: {result.write}" if result.write else ""
    return Problem(result.key, f"not TOML{of} ({message}); got: {result.came}{write_} ({result.rule})",
                   result.line)


# --- [sweep] of a case file: keys that take several values, every combination of them one case
TOGETHER = "together"  # the key of [sweep] by which the others vary together
MAX_COMBINATIONS = 10_000  # combinations; a sweep beyond that is a program's work, not a file's
SWEPT = ("body", "effects", "scaled", "motion", "thrusters", "wheels", "limits")


def combinations(top: Table) -> list[tuple[str, dict]]:
    """(suffix, data) of every combination, the last key running fastest; empty without [sweep]. Suffix
    "-2-1": the second value of the first key, the first of the second. Faults are kept by the table."""
    paths, choices = swept(top)
    plain = {key: value for key, value in top.data.items() if key not in ("sweep", "expect")}
    if not paths:
        return []
    picks = zip(*choices) if is_together(top.data) else product(*choices)
    return [(variant_of([i for i, _ in pick], is_together(top.data)), _with(plain, paths, pick))
            for pick in picks]


def is_together(data: Mapping[str, Any]) -> bool:
    """Whether the keys of [sweep] vary together, one case for each value, not for each combination."""
    table = data.get("sweep")
    return isinstance(table, dict) and table.get(TOGETHER) is True


def variant_of(numbers: list[int], together: bool) -> str:
    """The suffix of a combination: the number of the value of each key, once where they vary together."""
    return "".join(f"-{i}" for i in (numbers[:1] if together else numbers))


def swept(top: Table) -> tuple[list[tuple], list[list]]:
    """The paths that [sweep] replaces and the numbered values of each, both empty where it cannot be run;
    keeps the faults."""
    table = top.table("sweep")
    if table is None:
        return [], []
    paths, choices = [], []
    for key, values in table.data.items():
        if key == TOGETHER:
            if not isinstance(values, bool):
                table.fault(f"expected true or false, got {described(values)}", key)
            continue
        path = place(top.data, key)
        if not isinstance(values, list) or not values:
            table.fault(f"expected a list of the values that {key} takes, got {described(values)}", key)
        elif _holder(top.data, path) is None:
            table.fault(f"this file has no key {key}; write it as \"effects.gyrostat.momentum\" or "
                        "\"thrusters.NAME.force\", with a value in its place", key)
        else:
            paths.append(path)
            choices.append(list(enumerate(values, 1)))
    counts = {len(values) for values in choices}
    if is_together(top.data) and len(counts) > 1:
        table.fault(f"expected as many values of each key, got {', '.join(map(str, sorted(counts)))}: with "
                    f"together "
                    "= true the first value of each key is one case, the second the next", TOGETHER)
        return [], []
    count = max(counts, default=1) if is_together(top.data) else math.prod(map(len, choices))
    if count > MAX_COMBINATIONS:
        table.fault(f"{count} combinations; at most {MAX_COMBINATIONS} are run from one file")
        return [], []
    return paths, choices


def place(data: Mapping[str, Any], key: str) -> tuple:
    """The path of a key of [sweep]; a thruster or wheel is named, and stands at its index."""
    path = tuple(key.split("."))
    if len(path) == 3 and isinstance(data.get(path[0]), list):
        at = [i for i, item in enumerate(data[path[0]]) if isinstance(item, dict)
              and item.get("name") == path[1]]
        return (path[0], at[0], path[2]) if at else path
    return path


def _holder(data, path):
    """The table that holds the key of this path, or None."""
    if len(path) < 2 or path[0] not in SWEPT:
        return None
    for part in path[:-1]:
        if isinstance(data, list):
            data = data[part] if isinstance(part, int) else None
        else:
            data = data.get(part) if isinstance(data, dict) else None
    return data if isinstance(data, dict) and path[-1] in data else None


def _with(plain, paths, pick):
    data = copy.deepcopy(plain)
    for path, (_, value) in zip(paths, pick):
        _holder(data, path)[path[-1]] = value
    return data
